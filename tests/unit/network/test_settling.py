"""The way of a float to its place in waves and current: where runs begin, what is left out, what is not judged."""

from __future__ import annotations

import math

import numpy as np
import pytest
import xarray as xr

import moyai
from moyai.core.results import Result
from moyai.structures.network.chance import chance_of, length_of, of_periods
from moyai.structures.network.headlines import _moved
from moyai.structures.network.settling import DRIFTED, Drift, drift_of, drift_of_all

CASE = """
moyai: 1
title: Buoy on a rope
site: {water_depth: 25 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
WAVEScurrent: {speed: SPEED, heading_deg: 0}
structure:
  kind: network
  line_types:
    rope: {diameter: 30 mm, mass: 0.725 kg/m, axial_stiffness: 100 kN, damping_ratio: 0.2, drag_normal: 1.2,
           drag_tangential: 0.02, added_mass_normal: 1.0, breaking_load: 100 kN}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    buoy: {kind: sphere, position: [PLACE, 0, 0], diameter: 1.8 m, mass: 500 kg, drag_coefficient: 0.5,
           added_mass_coefficient: 0.5}
  lines:
    rode: {start: anchor, end: buoy, type: rope, length: 40 m, segments: 8}
analyses: [statics, dynamic]
settings: {mesh_check: 'CHECK'MORE}
criteria: {line_safety_factor: 10, greatest_offset: 35 m, greatest_anchor_load: 10 kN}
"""
WAVES = "waves: {kind: regular, name: ripple, height: 0.6 m, period: 4.5 s, heading_deg: 0}\n"


def _run(speed: str, place: str, more: str = "", waves: str = "", check: str = "off") -> Result:
    text = CASE.replace("SPEED", speed).replace("PLACE", place).replace("MORE", more).replace("WAVES", waves)
    text = text.replace("CHECK", check)
    return moyai.run(text)


def _drift(place: np.ndarray, time: np.ndarray, *, period: float = 5.0, irregular: bool = False) -> Drift:
    """Return the drift of one point that begins at rest, 10 m next to another that stands still."""
    both = np.zeros((time.size, 2, 3))
    both[:, 0, 0], both[:, 1, 1] = place, 10.0
    return drift_of(
        time, both, np.array([[0.0, 0.0, 0.0], [0.0, 10.0, 0.0]]), np.zeros(2, dtype=bool), period=period, skip=0.0,
        irregular=irregular, names=["buoy", "anchor"],
    )  # fmt: skip


@pytest.mark.parametrize("irregular", [False, True])
@pytest.mark.parametrize(("lasts", "still"), [(5.0, False), (60.0, True)])
def test_an_exponential_way_ends_or_goes_on(lasts: float, still: bool, irregular: bool) -> None:
    """10 m of offset to within 2 % after four time constants; after 100 s of 60 s a fifth is still to come."""
    time = np.linspace(0.0, 100.0, 2001)
    waves = np.sin(2.0 * math.pi * time / 5.0)
    if irregular:
        waves *= 1.0 + 0.5 * np.sin(0.31 * time)
    found = _drift(10.0 * (1.0 - np.exp(-time / lasts)) + waves, time, irregular=irregular)
    assert (found.point == "buoy") is still
    if still:
        # its speed over the last parts: 10 m / 60 s exp(-t/60 s)
        assert found.moved / found.within == pytest.approx(10.0 / lasts * math.exp(-85.0 / lasts), rel=0.15)
    else:
        # the mean of a period of 5 s lies within 0.2 m after 18 to 25 s
        assert 15.0 <= found.until <= 30.0 and found.words() == ""


def test_an_even_motion_stands_from_the_start() -> None:
    time = np.linspace(0.0, 100.0, 2001)
    assert _drift(3.0 + np.sin(2.0 * math.pi * time / 5.0), time) == Drift()


def test_a_current_alone_begins_at_its_rest() -> None:
    """The load through time is that at rest: no way out, no overshoot where the rope comes taut."""
    result = _run("1.2 m/s", "25 m", ", duration: 20 s", check="auto")
    tension = float(result.tree["SWL/statics"]["line_tension_maximum"].sel(condition="current", line="rode"))
    found = {item.name: item for item in result.headlines if item.shown}
    assert found["line_tension"].value == pytest.approx(tension, rel=5e-3)
    assert found["point_load"].value == pytest.approx(tension, rel=0.03)
    assert result.verdict.outcome == "holds"


@pytest.mark.slow
def test_waves_on_a_current_count_at_the_place_of_the_current() -> None:
    """A buoy drawn 3 m from its anchor hangs at the end of its rope: sqrt(40^2 - 25^2) = 31 m, less what hangs."""
    result = _run("0.15 m/s", "3 m", ", duration: 60 s", WAVES)
    (offset,) = [item for item in result.headlines if item.name == "offset" and item.shown]
    assert 27.0 < offset.value < 31.5 and offset.bound == ""


@pytest.mark.slow
def test_a_run_that_ends_on_its_way_is_not_judged() -> None:
    result = _run("0.15 m/s", "3 m", ", duration: 60 s, start: rest", WAVES)
    (offset,) = [item for item in result.headlines if item.name == "offset" and item.shown]
    assert offset.bound == "at least" and offset.value < 25.0 and "'buoy' still moves" in offset.detail
    assert any(notice.code == "still-drifting" for notice in result.notices)
    assert result.verdict.outcome == "not judged"


def test_the_way_from_rest_is_left_out() -> None:
    """From still water the buoy comes taut with one and a half times the load of the current."""
    result = _run("1.2 m/s", "25 m", ", duration: 2 min, start: rest")
    tension = float(result.tree["SWL/statics"]["line_tension_maximum"].sel(condition="current", line="rode"))
    found = {item.name: item for item in result.headlines if item.shown}
    assert found["line_tension"].value == pytest.approx(tension, rel=0.03)
    assert found["start_up_tension"].value > 1.2 * tension and DRIFTED in found["start_up_tension"].detail


def test_periods_in_which_a_motion_grows_say_nothing_of_chance() -> None:
    """Ten periods of snaps, the first two of a motion that grows: the chance is that of the eight others."""
    time = np.linspace(0.0, 40.0, 4001)
    peaks = np.array([2.0, 8.0, 37.0, 39.0, 36.0, 40.0, 38.0, 35.0, 39.0, 37.0])
    values = peaks[np.minimum((time / 4.0).astype(int), 9)] * np.abs(np.sin(math.pi * time / 4.0))
    found, late = (
        of_periods(xr.Dataset(coords={"time": time}, attrs={"period": 4.0, "growth": growth}), time[kept], values[kept])
        for growth, kept in ((8.0, time >= 0.0), (0.0, time >= 8.0))
    )
    assert found is not None and late is not None and found.range == late.range and found.observed == values.max()
    whole = of_periods(xr.Dataset(coords={"time": time}, attrs={"period": 4.0}), time, values)
    assert whole is not None and whole.range[1] > 1.3 * found.range[1]


def test_what_swings_about_its_place_has_arrived() -> None:
    """Means of four parts of 10 s zigzag by a tenth of a metre and end up aside: no way to anywhere."""
    parts = np.array([[-0.02, 0.01], [0.16, -0.11], [-0.05, 0.17], [0.14, 0.15]])
    time = np.linspace(0.0, 40.0, 801)
    both = np.zeros((time.size, 2, 3))
    both[:, 0, :2] = parts[np.minimum((time / 10.0).astype(int), 3)]
    both[:, 0, 0] += np.sin(2.0 * math.pi * time / 5.0)
    found = [
        drift_of(
            time, both, np.zeros((2, 3)), np.zeros(2, dtype=bool), period=5.0, skip=0.0, irregular=irregular,
            names=["box", "anchor"],
        )
        for irregular in (False, True)
    ]  # fmt: skip
    assert [one.point for one in found] == ["", ""]


def test_realisations_together_show_a_drift_that_one_hides():
    rng = np.random.default_rng(3)
    parts, count = np.arange(5.0), 20
    swing = rng.normal(0.0, 2.0, (count, 5, 1))
    out, excursion = np.abs(2.0 * parts[:, None] + swing), np.full((count, 1), 12.0)
    free, led = np.array([False]), np.array([True])
    found = drift_of_all(out, excursion, ["buoy"], free, 100.0)
    assert found.point == "buoy" and found.moved == pytest.approx(2.0, rel=0.3) and found.within == pytest.approx(20.0)
    assert "still moves" in found.words() and found.notices()
    still = np.abs(3.0 + swing)
    assert not drift_of_all(still, excursion, ["buoy"], free, 100.0).point
    assert not drift_of_all(out, excursion, ["buoy"], led, 100.0).point
    assert not drift_of_all(out[:1], excursion[:1], ["buoy"], free, 100.0).point


def _record(skip: float, growth: float, duration: float, **more: float) -> xr.Dataset:
    time = np.linspace(0.0, duration, int(20 * duration) + 1)
    attrs = {"skip": skip, "growth": growth, "period": 4.0, "irregular": 1, "wave_height": 1.0, "seed": 1} | more
    return xr.Dataset(coords={"time": time}, attrs=attrs)


def test_the_periods_of_a_record_are_counted_from_the_end_of_its_ramp() -> None:
    """110 s of Tp 4 s after a skip of 12 s are 24.5 periods; with a ramp of 80 s 7.5 of them are at full motion."""
    load = np.abs(np.random.default_rng(7).normal(5.0, 1.0, 2201))
    for growth, words, bound in (
        (4.0, "largest in 98 s", ""),
        (80.0, "largest in 30 s, less than 24 periods", "at least"),
    ):
        series = _record(12.0, growth, 110.0)
        said, proven = length_of({"/SWL/time/storm": series}, "SWL", "storm", np.zeros(0))
        assert said.startswith(words) and proven == bound
        assert (chance_of(series, load) is None) == bool(bound)
    # a long record: what the ramp holds back is no part of its chance
    series = _record(12.0, 80.0, 410.0)
    load = np.abs(np.random.default_rng(7).normal(5.0, 1.0, series["time"].size))
    load[series["time"].values < 80.0] *= 0.2
    found = chance_of(series, load)
    late = chance_of(series.assign_attrs(skip=80.0), load)
    assert found is not None and late is not None and found.range == late.range


def test_an_offset_has_the_chance_of_a_motion_whose_tension_never_repeats() -> None:
    """Snaps of 30 to 43 kN, offsets that differ by a fiftieth: the offset of another record is another one too."""
    series = _record(8.0, 4.0, 48.0, irregular=0)
    time = series["time"].values
    part = np.minimum((time / 4.0).astype(int), 11)
    swing = np.abs(np.sin(math.pi * time / 4.0))
    snaps = np.array([1.0, 20.0, 30.0, 34.0, 43.0, 31.0, 38.0, 36.0, 42.0, 33.0, 40.0, 35.0])[part] * swing
    away = (5.4 + 0.1 * np.array([0, 0, 0.3, 0.7, 0.1, 1.0, 0.4, 0.6, 0.2, 0.8, 0.5, 0.9])[part]) * swing
    snapping = series.assign(line_tension_peak_since_row=(("time", "line"), snaps[:, None]))
    steady = series.assign(line_tension_peak_since_row=(("time", "line"), (40.0 * swing)[:, None]))
    assert chance_of(series, away, as_tension=True) is None and chance_of(steady, away, as_tension=True) is None
    assert chance_of(snapping, away) is None
    found = chance_of(snapping, away, as_tension=True)
    assert found is not None and found.range[0] < 5.5 < found.range[1] < 5.7
    item = _moved("offset", 5.5, "top", "", {"/SWL/time/short": snapping}, "SWL", "short", away)
    assert item.band is not None and item.band.high == found.range[1] and "does not repeat" in item.band.of
    assert _moved("offset", 5.5, "top", "", {"/SWL/time/short": steady}, "SWL", "short", away).band is None
