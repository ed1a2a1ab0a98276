"""Offset and transmission of the first page: events with lines in motion, and limits that no further sea loosens."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from moyai.core.headline import Criterion, governing, judge
from moyai.structures.breakwater.headlines import _offset, _roll, _transmission
from moyai.structures.breakwater.largest_motion import LargestOfPeriods


def sea(moving: float, still: float, members: tuple[float, ...] = (1.0, 1.2, 1.4)) -> xr.Dataset:
    count = len(members)
    return xr.Dataset(
        {
            "mean_offset": ("dof", [0.3, 0.0, 0.0]),
            "largest_offset_by_dof": ("dof", [float(np.mean(members)), 0.5, 0.1]),
            "largest_offset_by_dof_of_realisation": (("member", "dof"), np.outer(members, [1.0, 0.4, 0.1])),
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


def rolling(moving: float, still: float) -> xr.Dataset:
    """A sea of three realisations in which the lines of some events were set in motion; roll in degrees."""
    ends = {name: ("dof", np.array([1.0, 0.5, np.radians(roll)]))
            for name, roll in {"event_offset": moving, "event_offset_lines_at_rest": still}.items()}  # fmt: skip
    return sea(1.0, 1.0).assign(significant_motion=("dof", [0.5, 0.3, 0.12]), **ends)


def test_roll_tells_what_lines_in_motion_make_of_it():
    (plain,) = _roll("time", rolling(4.8, 14.9), "HW", "storm", None)
    (further,) = _roll("time", rolling(9.0, 7.5), "HW", "storm", None)
    assert "with lines in motion 4.8\u00b0, with lines at rest 14.9\u00b0" in plain.detail
    assert further.value == plain.value and further.band.low == pytest.approx(plain.band.low)
    assert further.band.high == pytest.approx(1.2 * plain.band.high)
    assert further.band.judged[1] == pytest.approx(1.2 * plain.band.judged[1])


def passed(values: tuple[float, ...], high: float, periods: tuple[float, ...] = ()) -> xr.Dataset:
    """Transmission of a regular sea over its periods, or of an irregular one."""
    data = np.array(values if periods else values[0])
    dims = ("period",) if periods else ()
    ends = {"low": data, "high": np.maximum(data, high)}
    return xr.Dataset(
        {"transmission_coefficient": (dims, data)}
        | {f"transmission_coefficient_{end}": (dims, value) for end, value in ends.items()},
        coords={"period": list(periods)} if periods else {},
    )


def test_no_further_sea_makes_a_limit_on_transmission_hold():
    swell, chop, storm = passed((0.4, 0.97), 0.4, (3.0, 8.0)), passed((0.3,), 0.62), passed((0.35,), 0.4)
    limit = Criterion("greatest_transmission", "transmission", 0.6, "at most", "case file")
    level = {"/SWL": xr.Dataset(attrs={"water_depth": 10.0})}

    def judged(**seas: xr.Dataset) -> tuple[str, float]:
        groups = level | {f"/SWL/frequency/{name}": data for name, data in seas.items()}
        numbers = _transmission(groups, ["SWL"])
        assert sum(item.shown for item in numbers) == 1
        found = judge(numbers, [limit], computed=True)
        return found.outcome, max(item.value for item in found.judgements)

    assert judged(storm=storm) == ("holds", pytest.approx(0.4))
    # a smaller value with a wider band
    assert judged(storm=storm, chop=chop) == ("does not hold", pytest.approx(0.62))
    assert judged(swell=swell) == ("does not hold", pytest.approx(0.97))
    assert judged(swell=swell, storm=storm) == ("does not hold", pytest.approx(0.97))


def test_a_further_period_takes_no_wide_band_away():
    """Near its resonance the transmission hangs on damping; a stiff period next to it is larger and narrow."""
    limit = Criterion("greatest_transmission", "transmission", 0.43, "at most", "case file")
    level = {"/SWL": xr.Dataset(attrs={"water_depth": 10.0})}

    def outcome(data: xr.Dataset) -> str:
        return judge(_transmission(level | {"/SWL/frequency/daily": data}, ["SWL"]), [limit], computed=True).outcome

    wide = passed((0.389,), 0.484, (4.25,))
    both = passed((0.407, 0.389), 0.407, (3.2, 4.25))
    both["transmission_coefficient_high"].values[1] = 0.484
    assert outcome(wide) == outcome(both) == "does not hold"


def test_motions_of_regular_waves_carry_the_band_of_damping():
    """The period with the larger value is not the one whose upper end is the largest."""
    roll = np.array([[0.2, 0.1, 0.10], [0.1, 0.1, 0.09]])
    high = roll * np.array([[1.1], [1.5]])
    data = xr.Dataset(
        {
            "motion_amplitude": (("period", "dof"), roll),
            "motion_amplitude_low": (("period", "dof"), 0.8 * roll),
            "motion_amplitude_high": (("period", "dof"), high),
            "mean_offset": (("period", "dof"), np.array([[-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]])),
        },
        coords={"period": [3.0, 4.0], "dof": ["sway", "heave", "roll"]},
        attrs={"damping_band": "damping times 0.5 to 2"},
    )
    found = LargestOfPeriods("frequency", data, data, None, "SWL, daily")
    shown, judged = governing(found.roll())
    assert shown.value == 0.10 and shown.band.high == pytest.approx(0.11)
    assert judged.value == 0.09 and judged.band.high == pytest.approx(0.135) and not judged.shown
    # the mean offset is not attached to damping
    offset = governing(found.offset())[0]
    assert offset.value == pytest.approx(1.2) and offset.band.high == pytest.approx(1.22)
    assert offset.band.low == pytest.approx(1.16)
