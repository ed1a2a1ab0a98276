"""Regular waves are run until their periods repeat; what has not settled is a bound, what never repeats a chance."""

import numpy as np
import pytest
import xarray as xr
from test_flexible_cages import at_sea

from moyai.core.headline import Criterion, judge
from moyai.structures.cage.bands import UNSETTLED, LevelState, reach
from moyai.structures.cage.flexible.checks import settling_notices
from moyai.structures.cage.flexible.problem import FlexibleSettings
from moyai.structures.cage.flexible.time import Settling, run_cage
from moyai.structures.cage.headlines import _anchor, _volume
from moyai.structures.cage.rigid.waves import wave_of
from moyai.structures.cage.settling import by_period, is_settled, limit_of, may_reach, scatters, still_to_come

PERIOD = 5.0


@pytest.mark.parametrize("slow", [3.0, 6.0, 12.0])
def test_what_is_still_to_come_of_an_exponential_approach_is_known(slow):
    number = np.arange(60.0)
    whole = 60.0 - 20.0 * np.exp(-number / slow)
    for count in (9, 15, 30):
        left = 60.0 - whole[count - 1]
        assert still_to_come(whole[:count]) == pytest.approx(left, rel=0.02)
    assert np.isnan(still_to_come(whole[:8])) and not is_settled(whole[:8], 60.0)
    assert still_to_come(-whole[:15]) == pytest.approx(-still_to_come(whole[:15]))


def test_blocks_tell_where_they_lead():
    blocks = np.array([[90.0, 50.0, 70.0, 10.0], [95.0, 51.0, 80.0, 30.0], [97.5, 51.0, 75.0, 50.0]])
    # the third turns about, the last leads nowhere near
    assert limit_of(blocks) == pytest.approx([100.0, 51.0, 75.0, 52.5])


def test_periods_are_distinguished():
    time = np.linspace(0.0, 40.0, 401)
    found = by_period(time, np.sin(2.0 * np.pi * time / PERIOD) + np.floor((time + 1e-9) / PERIOD), PERIOD, 10.0)
    assert found == pytest.approx([3.0, 4.0, 5.0, 6.0, 7.0, 8.0], abs=0.01)


def waves(periods, slow, chaos=0.0):
    """Return a run whose anchor rises to 60 kN and whose volume falls to 0.7 over some periods."""
    time = np.arange(0.0, PERIOD * periods, 0.25)
    grown = 1.0 - np.exp(-np.floor(time / PERIOD) / slow)
    grown += chaos * np.random.default_rng(3).normal(size=periods)[np.floor(time / PERIOD + 1e-9).astype(int)]
    pull = (60e3 * grown)[:, None]
    data = {
        "line_tension_peak_since_row": (("time", "line"), pull), "slack_share": ("line", [0.0]),
        "snap_count": ("line", [0]),
        "line_tension_maximum": ("line", pull.max(axis=0)), "utilisation": ("line", pull.max(axis=0) / 200e3),
        "anchor_tension_maximum": ("anchor", pull.max(axis=0)), "anchor_vertical_tension_maximum": ("anchor", [1e3]),
        "volume_share": (("time", "cage"), (1.0 - 0.3 * grown)[:, None]),
        "drag": (("drag_time", "part", "horizontal"), np.stack([pull, 0.0 * pull], axis=2)),
    }  # fmt: skip
    attrs = {"regular": 1, "ramp": 0.0, "period": PERIOD, "theory": "linear", "wave": "H 2 m, T 5 s"}
    coords = {"time": time, "drag_time": time, "line": ["anchor 1"], "anchor": ["anchor 1"]}
    run = xr.Dataset(data, coords=coords, attrs=attrs)
    return [(LevelState("SWL", 0.5, -1, xr.Dataset(), xr.Dataset(), None), "storm, SWL", run)]


def test_waves_that_have_not_settled_prove_no_limit_and_say_so():
    limits = [
        Criterion("greatest_anchor_load", "anchor_tension", 59e3, "at most", "case", unit="N"),
        Criterion("least_volume_left", "volume_left", 0.71, "at least", "case"),
    ]
    outcomes = []
    for periods in (8, 12, 40):
        runs = waves(periods, 6.0)
        found = judge([*_anchor([], runs), *_volume([], runs)], limits, computed=True)
        outcomes.append([item.outcome for item in found.judgements])
    assert outcomes == [["not judged"] * 2, ["not judged"] * 2, ["does not hold"] * 2]
    (notice,) = settling_notices("storm", waves(12, 6.0)[0][2])
    assert notice.severity == "warning" and "more periods" in notice.remedy
    assert "after 11.9 periods" in notice.message and "% a period" in notice.message
    assert settling_notices("storm", waves(40, 6.0)[0][2]) == ()


def test_what_a_number_has_still_to_come_is_in_its_band():
    ((_, _, run),) = waves(22, 6.0)
    series = run["line_tension_peak_since_row"].values[:, 0]
    value = float(series.max())
    low, high, words = reach(run, value, series)
    assert value == low < 58.5e3 and high == pytest.approx(60e3, rel=0.005) and words == "periods still to come 3.1 %"


def test_waves_that_never_repeat_are_a_chance_of_the_record():
    ((_, _, run),) = waves(60, 1.0, chaos=0.1)
    series = run["line_tension_peak_since_row"].values[:, 0]
    assert scatters(by_period(run["time"].values, series, PERIOD, 0.0), 60e3)
    low, high, words = reach(run, float(series.max()), series)
    assert low < high >= series.max() and "does not repeat" in words and not words.startswith(UNSETTLED)


def test_an_idle_line_that_never_repeats_does_not_keep_a_run_going():
    """Lines of one strength: what scatters counts where it may come up to the most loaded line."""
    periods = np.arange(12)
    chaos = np.random.default_rng(3).uniform(-1.0, 1.0, periods.size)
    for idle, ends in ((0.3, True), (0.9, False)):
        assert scatters(idle + 0.1 * chaos, 1.0) and may_reach(idle + 0.1 * chaos, 1.0) is not ends
        model, rest = at_sea(0.3)
        settled = Settling(rest, wave_of("linear", 2.0, 5.0, 0.0, model.water, 0.3, 2), FlexibleSettings(("time",)))
        broken = settled._broken
        lines = np.ones((periods.size, broken.size)) * broken
        idle_one = int(np.flatnonzero(~settled._anchors)[0])
        lines[:, idle_one] = (idle + 0.1 * chaos) * broken[idle_one]
        settled._highest = list(np.column_stack([-np.ones(12), np.ones(12), np.ones(12), lines]))
        assert settled._repeats() is ends


@pytest.mark.slow  # a small cage through thirty periods
def test_a_cage_is_run_until_its_periods_repeat():
    model, rest = at_sea(0.3)
    wave = wave_of("linear", 2.0, 5.0, 0.0, model.water, 0.3, 2)
    settings = FlexibleSettings(("time",), periods=2, ramp_periods=2.0, rows_per_period=20)
    found = run_cage(model, rest, wave, settings, enough=Settling(rest, wave, settings))
    number = found.wave.duration / 5.0
    assert 9 <= number < 40 and number == pytest.approx(round(number), abs=1e-6)
    assert found.history.status == "converged"
    longer = run_cage(model, rest, wave_of("linear", 2.0, 5.0, 0.0, model.water, 0.3, round(number) + 15), settings)
    cage, least, highest = rest.built.cages[0], [], []
    for run in (found, longer):
        late = run.history.time >= run.ramp
        least.append(float((cage.volume(run.history.position[late]) / cage.rest_volume).min()))
        highest.append(float(run.history.tension_peak[late].max()))
    # three hundredths is what may be left, five where its estimate errs
    assert least[0] == pytest.approx(least[1], rel=0.05) and highest[0] == pytest.approx(highest[1], rel=0.05)
    # what is still to come tells where the volume leads
    volume = cage.volume(found.history.position) / cage.rest_volume
    left = still_to_come(by_period(found.history.time, -volume, 5.0, found.ramp))
    assert least[0] - left == pytest.approx(least[1], abs=0.01)
    # rows that both have are the same
    rows = found.history.time.size
    assert np.array_equal(found.history.tension_peak, longer.history.tension_peak[:rows])
