"""One seed of an irregular sea in which a line snaps proves nothing of the others: it breaks a limit and keeps none.

Twenty seeds of a buoy on a chain that snaps: 16.2 to 48.5 kN, of which one, 23.4 kN, was held with a band to 29.4 kN.
"""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from moyai.structures.network.chance import MORE_SEEDS, SNAPS_OF_ONE_SEED
from moyai.structures.network.headlines import DYNAMIC, _band, _Peak, _unchecked
from moyai.structures.network.refinement import LANDING


@pytest.mark.parametrize(("irregular", "snaps", "doubt", "seeds", "scatter", "bound"), [
    (1, 3.0, "", 1, 0.5, "at least"), (1, 0.0, LANDING, 1, 0.5, "at least"), (1, 0.0, "", 1, 0.5, ""),
    (0, 3.0, "", 1, 0.5, ""), (1, 3.0, "", 6, 0.5, ""), (1, 0.0, "", 1, 1.2, "at least"), (0, 0.0, "", 1, 1.2, ""),
    (1, 0.0, "", 6, 1.2, ""),
])  # fmt: skip
def test_a_seed_with_snaps_is_at_least(
    irregular: int, snaps: float, doubt: str, seeds: int, scatter: float, bound: str
) -> None:
    time = np.linspace(0.0, 900.0, 9001)
    load = np.abs(np.random.default_rng(4).normal(5.0, scatter, time.size))
    series = xr.Dataset(
        {"line_tension_peak_since_row": (("time", "line"), load[:, None])}, coords={"time": time, "line": ["chain"]},
        attrs={"skip": 0.0, "period": 7.0, "irregular": irregular},
    )  # fmt: skip
    peak = float(load.max())
    summary = xr.Dataset(
        {
            "snap_count": (("run", "line"), [[snaps]]),
            "line_tension_of_check": (("run", "line", "check"), [[[peak, peak, peak, np.nan, np.nan]]]),
        },
        coords={"run": ["storm"], "line": ["chain"]},
        attrs={"governing storm": "chain", "doubt storm": doubt},
    )
    found = peak * np.linspace(0.95, 1.05, seeds) if seeds > 1 else np.zeros(0)
    groups = {"/SWL/dynamic": summary, "/SWL/time/storm": series}
    band, said, proves = _band(groups, _Peak(peak, "chain", "SWL", "storm", 12.0, DYNAMIC, found))
    assert band is not None and proves == bound
    assert (SNAPS_OF_ONE_SEED in said) is bool(bound) and (MORE_SEEDS in _unchecked(said)) is bool(bound)
