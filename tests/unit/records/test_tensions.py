"""Steady and fluctuating tension, one maximum for each wave, blocks: planted series found again."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.survey.tension_blocks import analyse_blocks
from moyai.records.survey.tensions import find_delay, split_tension, tension_statistics, wave_maxima
from moyai.series.zero_crossing import split_waves


def pulses(seed, *, count=150, period=6.0, step=0.1, delay=0.0, width=0.15):
    """Waves of random heights with one pulse each, its height planted; steady tension on top."""
    rng = np.random.default_rng([seed, 41])
    time = np.arange(0.0, count * period, step)
    heights = rng.rayleigh(1.0, count)
    elevation, force = np.zeros(time.size), np.zeros(time.size)
    tops = rng.uniform(1e3, 2e4, count)
    for k in range(count):
        part = (time >= k * period) & (time < (k + 1) * period)
        elevation[part] = (0.2 + heights[k]) * np.sin(2 * math.pi * (time[part] - k * period) / period)
        force += tops[k] * np.exp(-0.5 * ((time - (k + 0.25) * period - delay) / (width * period / 2)) ** 2)
    return time, elevation, force, tops


@pytest.mark.parametrize("seed", [*range(2), *(pytest.param(s, marks=pytest.mark.slow) for s in range(2, 4))])
def test_median_is_hardly_moved_by_spikes_the_mean_is(seed):
    time, _, force, _ = pulses(seed)
    steady = np.random.default_rng(seed).uniform(5e3, 2e4)
    parts = {rule: split_tension(time, steady + force, rule) for rule in ("median", "mean", "low_pass")}
    for item in parts.values():
        assert item.steady + item.fluctuating == pytest.approx(steady + force, rel=1e-12)
    assert parts["mean"].level == pytest.approx(steady + force.mean(), rel=1e-12)
    assert abs(parts["median"].level - steady) < 0.2 * (parts["mean"].level - steady)
    # a slow filter keeps the mean of the spikes
    assert parts["low_pass"].level == pytest.approx(parts["mean"].level, rel=0.02)


def test_low_pass_follows_the_tide():
    time = np.arange(0.0, 1200.0, 0.2)
    slow = 8e3 + 2e3 * np.sin(2 * math.pi * time / 1200.0)
    fast = 3e3 * np.sin(2 * math.pi * time / 6.0)
    found = split_tension(time, slow + fast, "low_pass", cutoff=30.0)
    inside = (time > 60) & (time < 1140)
    assert found.steady[inside] == pytest.approx(slow[inside], rel=2e-3)
    assert found.fluctuating[inside] == pytest.approx(fast[inside], abs=30.0)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("delay", [0.0, 1.3, -0.9])
def test_every_wave_gets_its_own_maximum(seed, delay):
    time, elevation, force, tops = pulses(seed, delay=delay)
    waves = split_waves(time, elevation)
    found_delay = find_delay(time, elevation, force - np.median(force), longest=2.5)
    assert found_delay == pytest.approx(delay, abs=0.1)
    found = wave_maxima(time, force, waves.start, waves.period, delay=found_delay)
    # the first planted wave opens with the record, before a crossing is seen
    index = np.round(waves.start / 6.0).astype(int)
    known = np.isfinite(found.maximum)
    # neighbours of a large pulse reach into small ones
    assert found.maximum[known] == pytest.approx(tops[index[known]], rel=0.03)
    assert found.matched >= len(waves) - 2
    assert not found.double.any()


def test_double_peaks_are_reported():
    time = np.arange(0.0, 60.0, 0.05)
    force = np.zeros(time.size)
    for k in range(10):
        force += 100.0 * np.exp(-0.5 * ((time - 6 * k - 1.0) / 0.2) ** 2)
        force += (90.0 if k % 2 else 40.0) * np.exp(-0.5 * ((time - 6 * k - 3.0) / 0.2) ** 2)
    found = wave_maxima(time, force, 6.0 * np.arange(10), np.full(10, 6.0))
    np.testing.assert_array_equal(found.double[:9], np.arange(9) % 2 == 1)


def test_statistics_of_maxima():
    values = np.arange(1.0, 31.0)
    found = tension_statistics(np.append(values, np.nan))
    assert (found.maximum, found.tenth, found.third, found.mean, found.count) == (30.0, 29.0, 25.5, 15.5, 30)
    assert tension_statistics([np.nan]).count == 0
    assert math.isnan(tension_statistics([]).maximum)


def test_blocks_hold_waves_current_and_tensions():
    time, elevation, force, tops = pulses(1, count=600)
    rng = np.random.default_rng(8)
    lines = np.stack([1e4 + force, 2e4 + 0.5 * force])
    heading = np.radians(200.0)
    current = np.stack([0.1 + 0.01 * rng.standard_normal(time.size), np.full(time.size, 0.05)], axis=1)
    found = analyse_blocks(
        time, elevation, lines, block=1200.0, wave_heading=heading, current=current, normal_heading=np.radians(5.0)
    )
    assert len(found) == 3
    assert found.start == pytest.approx([0.0, 1200.0, 2400.0])
    # 195 degrees from the normal: from behind, 15 degrees off
    assert np.degrees(found.angle) == pytest.approx(15.0, abs=1e-9)
    expected = 0.1 * math.cos(math.radians(5)) + 0.05 * math.sin(math.radians(5))
    assert found.current_normal == pytest.approx(expected, abs=1e-3)
    assert found.steady[:, 1] - found.steady[:, 0] == pytest.approx(1e4, rel=0.02)
    assert found.maximum[:, 1] == pytest.approx(0.5 * found.maximum[:, 0], rel=0.02)
    for k in range(3):
        own = np.sort(tops[200 * k : 200 * (k + 1)])
        assert found.maximum[k, 0] == pytest.approx(own[-1], rel=0.03)
        assert found.third[k, 0] == pytest.approx(own[-66:].mean(), rel=0.03)
    assert found.averaged("steady") == pytest.approx(found.steady.mean(axis=1))
    assert found.significant_period == pytest.approx(6.0, rel=1e-3)
    assert not found.notices


def test_blocks_with_gaps_are_left_out_and_slow_loggers_are_reported():
    time, elevation, force, _ = pulses(2, count=400, step=0.5)
    force[10] = np.nan
    found = analyse_blocks(time, elevation, force, block=1200.0)
    assert len(found) == 1
    assert {item.code for item in found.notices} == {"tensions-lost", "tensions-sampling"}
    assert np.isnan(found.angle).all()
    assert np.isnan(found.current_normal).all()


def test_heading_of_blocks_is_averaged_round_the_circle():
    time, elevation, force, _ = pulses(3, count=200)
    heading = np.radians(np.where(np.arange(time.size) % 2 == 0, 350.0, 10.0))
    found = analyse_blocks(time, elevation, force, block=1200.0, wave_heading=heading)
    assert np.degrees(found.angle[0]) == pytest.approx(0.0, abs=0.01)
    one = analyse_blocks(time, elevation, force, block=1200.0, wave_heading=[math.radians(30.0)])
    assert np.degrees(one.angle[0]) == pytest.approx(30.0)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"block": 0.5}, "blocks"),
        ({"block": 20.0}, "no block"),
        ({"block": 1e6}, "blocks"),
        ({"rule": "mode"}, "median"),
        ({"wave_heading": [0.0, 1.0, 2.0, 3.0]}, "headings"),
        ({"current": np.zeros(3)}, "current"),
        ({"longest_delay": 1e4}, "longest"),
    ],
)
def test_bad_input_is_refused(change, word):
    time, elevation, force, _ = pulses(4, count=200)
    with pytest.raises(InputError, match=word):
        analyse_blocks(time, elevation, force, **({"block": 1200.0} | change))
    with pytest.raises(InputError, match="uniform"):
        analyse_blocks(time**1.1, elevation, force)
    with pytest.raises(InputError, match="elevations"):
        analyse_blocks(time, elevation[:-1], force)
    with pytest.raises(InputError, match="gaps"):
        split_tension(time, np.where(time > 3.0, np.nan, force))
    with pytest.raises(InputError, match="lengths"):
        wave_maxima(time, force[:-1], [0.0], [1.0])
