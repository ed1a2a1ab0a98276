"""The offset of a sea: realisations with lines at rest, and what the events with lines in motion add."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from moyai.structures.breakwater.headlines import _offset


def sea(moving: float, still: float, members: tuple[float, ...] = (1.0, 1.2, 1.4)) -> xr.Dataset:
    count = len(members)
    return xr.Dataset(
        {
            "mean_offset": ("dof", [0.3, 0.0, 0.0]),
            "maximum_excursion": ("dof", [float(np.mean(members)), 0.5, 0.1]),
            "maximum_excursion_of_realisation": (("member", "dof"), np.outer(members, [1.0, 0.4, 0.1])),
            "event_offset": ("dof", [moving, 0.0, 0.0]),
            "event_offset_lines_at_rest": ("dof", [still, 0.0, 0.0]),
        },
        coords={"dof": ["sway", "heave", "roll"], "member": np.arange(count)},
        attrs={"duration": 10800.0},
    )


def test_lines_in_motion_that_go_further_raise_the_end_that_is_judged():
    (plain,) = _offset("time", sea(1.0, 1.25), "SWL", "storm", None)
    (further,) = _offset("time", sea(1.5, 1.25), "SWL", "storm", None)
    assert further.value == plain.value == pytest.approx(1.2)
    assert further.band.high == pytest.approx(1.2 * plain.band.high)
    assert further.band.judged[1] == pytest.approx(1.2 * plain.band.judged[1])
    assert "with lines in motion 1.5 m, with lines at rest 1.25 m" in further.detail


def test_one_realisation_has_a_band_where_lines_in_motion_go_further():
    (alone,) = _offset("time", sea(1.5, 1.25, (1.2,)), "SWL", "storm", None)
    assert (alone.band.low, alone.band.high) == (pytest.approx(1.2), pytest.approx(1.44))
    assert _offset("time", sea(1.0, 1.25, (1.2,)), "SWL", "storm", None)[0].band is None
