"""Every anchor and line of a flexible cage is judged at its own band: chance of the seed, mesh of its kind."""

import numpy as np
import pytest
import xarray as xr

from moyai.core.headline import Criterion, judge, unfavourable
from moyai.structures.cage.flexible.sensitivity import tension_of
from moyai.structures.cage.headlines import _anchor, _tension

TIME = np.arange(0.0, 400.0, 0.5)


def sea(peaks, names, regular):
    most = peaks.max(axis=0)
    data = {
        "line_tension_peak_since_row": (("time", "line"), peaks),
        **dict.fromkeys(("line_tension_maximum", "line_tension_maximum_lower"), ("line", most)),
        **dict.fromkeys(("line_uplift_lower", "slack_share"), ("line", 0.0 * most)),
        "snaps": ("line", np.zeros(most.size, dtype=int)), "utilisation": ("line", most / 1e6),
    }  # fmt: skip
    attrs = {"regular": regular, "ramp": 0.0, "period": 5.0, "theory": "linear", "seed": 1, "wave": "H"}
    run = xr.Dataset(data, coords={"time": TIME, "line": names}, attrs=attrs)
    return [("SWL", "storm, SWL", run)]


def test_an_anchor_of_a_smaller_pull_and_a_wider_band_is_judged():
    """One bears 100 kN in every wave, the other now and then 96 kN: of other seeds it may bear far more."""
    steady, rare = np.full(TIME.size, 100e3), np.full(TIME.size, 30e3)
    rare[np.linspace(5, TIME.size - 5, 14).astype(int)] = np.linspace(35e3, 96e3, 14)
    for order in (slice(None), slice(None, None, -1)):
        peaks, names = np.stack([steady, rare], axis=1)[:, order], ["anchor 1", "anchor 2"][order]
        found = _anchor([], sea(peaks, names, 0))
        assert found[0].value == pytest.approx(100e3) and "anchor 1" in found[0].where
        worst = max(found, key=unfavourable)
        assert "anchor 2" in worst.where and unfavourable(worst) > 110e3
        limit = Criterion("limit", "anchor_load", 105e3, "at most", "case", unit="N")
        assert judge(found, [limit], computed=True).outcome == "does not hold"


def test_the_mesh_of_its_kind_of_line_is_counted_before_the_worst_is_chosen():
    """Anchor line 0.300 within 1 %, bridle 0.290 within 30 %: the bridle breaks a limit of a third."""
    peaks = np.stack([np.full(TIME.size, 300e3), np.full(TIME.size, 290e3)], axis=1)
    factors = {tension_of("anchor"): (0.99, 1.01), tension_of("bridle"): (0.7, 1.3)}
    limit = Criterion("limit", "line_utilisation", 1.0 / 3.0, "at most", "case")
    outcomes = []
    for given in ({}, factors):
        _, used = _tension([], sea(peaks, ["anchor 1", "bridle 1a"], 1), given)
        outcomes.append(judge(used, [limit], computed=True).outcome)
    assert outcomes == ["holds", "does not hold"]
