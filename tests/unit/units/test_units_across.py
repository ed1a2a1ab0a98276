"""Chains that act along the gap, and units that move across it; connectors with a breaking load are judged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from moyai.case.reader import load_case
from moyai.structures.units.across import across_notices, stretch_across

EXAMPLE = Path(__file__).parents[3] / "examples" / "units" / "two_pontoons.yaml"


def _sea(across: float, elongation: float) -> xr.Dataset:
    return xr.Dataset(
        {
            "relative_motion_largest": (("connector", "component"), [[across, 0.1, 0.0], [across, 0.1, 0.0]]),
            "elongation_highest": ("connector", [elongation, elongation]),
        },
        coords={"connector": ["chain", "guide"]},
    )


STATICS = xr.Dataset(
    {
        "connector_span": ("connector", [0.5, np.nan]),
        "connector_axis": (("connector", "component"), [[0.0, 1.0, 0.0], [0.0, 1.0, 0.0]]),
    }
)


def test_a_chain_of_half_a_metre_is_stretched_as_its_ends_move_apart() -> None:
    """Pythagoras: 0.5 m along and 1.2 m across are 1.3 m; a guide that is no chain is not drawn."""
    assert stretch_across(STATICS, _sea(1.2, 0.09)) == pytest.approx([0.8, 0.0])


def test_little_motion_across_does_not_count() -> None:
    assert not stretch_across(STATICS, _sea(0.05, 0.09)).any()


def test_the_notice_names_level_sea_and_connector() -> None:
    groups = {"/LW/statics": STATICS, "/LW/time/storm": _sea(1.2, 0.09), "/LW/time/storm/realisation": xr.Dataset()}
    (notice,) = across_notices(groups)
    assert notice.message.startswith("LW, storm, chain") and "0.8 m" in notice.message


def test_connectors_with_a_breaking_load_are_judged_by_default(tmp_path: Path) -> None:
    text = EXAMPLE.read_text(encoding="utf-8")
    (tmp_path / "case.yaml").write_text(text.replace("  connector_safety_factor: 2\n", ""), encoding="utf-8")
    from moyai.case.builder import build

    (found,) = [item for item in build(load_case(tmp_path / "case.yaml")).criteria if "connector" in item.headline]
    assert found.assumed and found.limit == 0.5
