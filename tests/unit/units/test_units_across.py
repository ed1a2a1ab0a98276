"""Chains that act along one direction, and units that move across it; connectors with a breaking load are judged."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from moyai.case.reader import load_case
from moyai.structures.units.across import across_notices, stretch_across
from moyai.structures.units.connectors import UnitJoint
from moyai.structures.units.model import Connector

EXAMPLE = Path(__file__).parents[3] / "examples" / "units" / "two_pontoons.yaml"
ALONG = np.array([0.0, 1.0, 0.0])


def _joint(kind: str, in_space: bool) -> UnitJoint:
    connector = Connector(kind, kind, ((0, 1),), axis=(0.0, 1.0, 0.0), end_to_end=in_space)
    empty = np.zeros((0, 6))
    return UnitJoint(kind, connector, (0, 1), np.zeros(3), np.zeros((6, 12)), empty, 0.5, np.eye(3), ALONG)


JOINTS = (_joint("chain", True), _joint("chain", False), _joint("fender", False))


def _motion(across: float) -> np.ndarray:
    return np.tile([across, 0.1, 0.0], (3, 1))


def _sea(*stretch: float) -> xr.Dataset:
    return xr.Dataset({"stretch_across": ("connector", [*stretch])}, coords={"connector": ["chain", "guide"]})


def test_a_chain_of_half_a_metre_is_stretched_as_its_ends_move_apart() -> None:
    """Pythagoras: 0.5 m along and 1.2 m across are 1.3 m. In time a chain follows its ends; a fender is not drawn."""
    highest = np.full(3, 0.09)
    assert stretch_across(JOINTS, _motion(1.2), highest, in_time=False) == pytest.approx([0.8, 0.8, 0.0])
    assert stretch_across(JOINTS, _motion(1.2), highest, in_time=True) == pytest.approx([0.0, 0.8, 0.0])


def _spring(across: float) -> UnitJoint:
    stiffness = np.diag([across, 6e6, across, 0.0, 0.0, 0.0])
    spring = Connector("spring", "spring", ((0, 1),), stiffness=stiffness)
    return UnitJoint("s", spring, (0, 1), np.zeros(3), np.zeros((6, 12)), np.zeros((0, 6)), 0.5, np.eye(3), ALONG)


@pytest.mark.parametrize(("across", "stretch"), [(0.0, 0.8), (5e5, 0.8), (6e6, 0.0)])
def test_a_spring_that_gives_way_across_is_stretched_as_a_chain_is(across: float, stretch: float) -> None:
    found = stretch_across((_spring(across),), _motion(1.2)[:1], np.array([np.nan]), in_time=True)
    assert found == pytest.approx([stretch])


def test_little_motion_across_does_not_count() -> None:
    assert not stretch_across(JOINTS, _motion(0.05), np.full(3, 0.09), in_time=False).any()


def test_the_notice_names_level_sea_and_connector_and_how_to_mend_it() -> None:
    (notice,) = across_notices({"/LW/statics": xr.Dataset(), "/LW/time/storm": _sea(0.8, 0.0)})
    assert notice.message.startswith("LW, storm, chain") and "0.8 m" in notice.message
    assert "direction" in notice.remedy
    (notice,) = across_notices({"/LW/frequency/storm": _sea(0.8, 0.0)})
    assert "time" in notice.remedy


def test_the_frequency_domain_is_silent_where_time_governs() -> None:
    assert not list(across_notices({"/LW/frequency/storm": _sea(0.8, 0.0), "/LW/time/storm": _sea(0.0, 0.0)}))


def _judged(tmp_path: Path, *changes: tuple[str, str]) -> dict[str, float]:
    text = EXAMPLE.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    from moyai.case.builder import build

    return {item.headline: item.limit for item in build(load_case(tmp_path / "case.yaml")).criteria if item.assumed}


def test_connectors_with_a_breaking_load_and_gaps_are_judged_by_default(tmp_path: Path) -> None:
    found = _judged(tmp_path, ("  connector_safety_factor: 2\n", ""))
    assert found["connector_utilisation"] == 0.5
    assert found["gap_closing"] == 1.0
    found = _judged(tmp_path, ("  connector_safety_factor: 2\n", "  greatest_gap_closing: not_judged\n"))
    assert "gap_closing" not in found
