"""Planted faults are found where they were planted, clean seas are left alone, nothing is ever filled."""

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.reading import record as bits
from moyai.records.reading.clocks import interpolate, join
from moyai.records.reading.quality import (
    BlockMoments,
    QualityOptions,
    check_record,
    find_clipped,
    find_drift,
    find_flat,
    find_slips,
    find_spikes,
    moments_of,
)
from moyai.records.reading.record import Record


def sea(random, size=12000, step=0.1, height=2.0, period=6.0):
    """Narrow-banded sum of 200 cosines."""
    time = np.arange(size) * step
    omega = 2.0 * np.pi / period * np.sort(random.uniform(0.7, 1.6, 200))
    phase = random.uniform(0.0, 2.0 * np.pi, 200)
    amplitude = height / 4.0 * math.sqrt(2.0 / 200.0)
    return time, amplitude * np.cos(np.outer(time, omega) + phase).sum(axis=1)


def record_of(time, **channels):
    return Record(time, np.column_stack(list(channels.values())), tuple(channels), ("m",) * len(channels))


@pytest.mark.parametrize("seed", range(8))
def test_planted_spikes_and_nothing_else(seed):
    random = np.random.default_rng(seed)
    step = random.choice([0.1, 0.5, 0.78125])
    _time, clean = sea(random, 3000, step, random.uniform(0.2, 4.0), random.uniform(5.0, 12.0))
    options = QualityOptions()
    assert not find_spikes(clean, options).any()
    places = np.sort(random.choice(np.arange(10, 2990, 7), 15, replace=False))
    dirty = clean.copy()
    dirty[places] += random.choice([-1.0, 1.0], 15) * clean.std() * random.uniform(8.0, 40.0, 15)
    found = find_spikes(dirty, options)
    assert found[places].all()
    assert found.sum() == 15


def test_two_sample_spikes_and_switching_off():
    random = np.random.default_rng(11)
    _, values = sea(random)
    values[500:502] += 12.0
    assert np.flatnonzero(find_spikes(values, QualityOptions())).tolist() == [500, 501]
    assert not find_spikes(values, QualityOptions(spike_scale=math.inf)).any()
    assert not find_spikes(values, QualityOptions(spike_least=20.0)).any()


@pytest.mark.parametrize("seed", range(4))
def test_flat_lines_and_clipping(seed):
    random = np.random.default_rng(seed)
    _time, values = sea(random)
    options = QualityOptions(flat_seconds=5.0)
    assert not find_flat(values, 0.1, options).any()
    assert not find_clipped(values, options).any()
    begin = int(random.integers(100, 8000))
    flat = values.copy()
    flat[begin : begin + 80] = flat[begin]
    assert np.flatnonzero(find_flat(flat, 0.1, options)).tolist() == list(range(begin, begin + 80))
    level = np.quantile(values, 0.97)
    clipped = np.minimum(values, level)
    found = find_clipped(clipped, options)
    assert not (found & (clipped < level)).any()
    first, last = values >= level, found
    assert last.sum() >= 0.95 * first.sum()  # plateaus of one or two samples cannot be distinguished from crests


def test_flags_leave_the_values_and_gaps_are_counted():
    random = np.random.default_rng(5)
    time, values = sea(random, 2000)
    dirty = values.copy()
    dirty[100] = np.nan
    dirty[200] = 1e4
    kept = np.ones(2000, dtype=bool)
    kept[1000:1050] = False
    record = record_of(time[kept], level=dirty[kept])
    quality = check_record(record, QualityOptions(lowest=-50.0, highest=50.0))
    np.testing.assert_array_equal(quality.record["level"], dirty[kept])
    assert quality.record.flags[100, 0] == bits.MISSING
    assert quality.record.flags[200, 0] == bits.RANGE
    assert quality.missing_samples == 50
    assert quality.gaps[0] == pytest.approx((100.0, 5.0))
    assert quality.share("level") == pytest.approx((1950 - 2) / 2000)
    assert np.isnan(quality.record.sound("level")[[100, 200]]).all()
    assert {finding.kind for finding in quality.findings} == {"missing", "out of range"}


@pytest.mark.slow
@pytest.mark.parametrize(("factor", "seed"), [(9.80665, 0), (1000.0, 1), (10.0, 2), (100.0, 0), (57.29578, 1)])
def test_unit_slips_over_blocks(factor, seed):
    """Blocks 20 to 29 in the wrong unit; the sea itself grows and decays by a factor of four meanwhile."""
    random = np.random.default_rng(seed)
    moments = []
    for index in range(60):
        height = 1.0 + 3.0 * math.exp(-(((index - 30) / 12.0) ** 2))
        time, values = sea(random, 1200, 0.5, height)
        values = values * (factor if 20 <= index < 30 else 1.0)
        moments.append(moments_of(index, record_of(time + 600.0 * index, level=values), "level"))
    slips = find_slips(moments, "level")
    assert [(slip.first, slip.last) for slip in slips] == [(20, 29)]
    assert abs(math.log10(slips[0].unit_factor / factor)) < 0.15
    clean = [m if not 20 <= m.index < 30 else BlockMoments(m.index, m.middle, m.mean / factor, m.deviation / factor,
             m.scale / factor) for m in moments]  # fmt: skip
    assert find_slips(clean, "level") == ()


def blocks_of(scale, seed, mean=0.0):
    """Return blocks of given scales, each with the scatter of some hundred waves."""
    random = np.random.default_rng(seed)
    found = np.asarray(scale) * 10.0 ** (0.03 * random.normal(size=len(scale)))
    return [BlockMoments(i, 600.0 * i, mean, float(value), float(value)) for i, value in enumerate(found)]


def storm_of(factor, blocks=20):
    return np.where((np.arange(100) >= 40) & (np.arange(100) < 40 + blocks), factor, 1.0)


@pytest.mark.parametrize("factor", [4.5, 5.5, 6.5, 15.0, 17.0])
@pytest.mark.parametrize("seed", range(3))
def test_an_ordinary_storm_is_no_unit(factor, seed):
    """A sea that grows between two blocks by what lies between the factors of units."""
    assert find_slips(blocks_of(storm_of(factor), seed), "level") == ()


def test_what_lasts_one_block_is_an_event():
    assert find_slips(blocks_of(storm_of(10.0, 1), 1), "level") == ()
    assert len(find_slips(blocks_of(storm_of(10.0, 2), 1), "level")) == 1
    assert len(find_slips(blocks_of(storm_of(100.0, 1), 1), "level")) == 1


def test_a_tension_about_its_pretension_keeps_its_mean_in_a_storm():
    """A wrong unit multiplies mean and fluctuation alike, a storm the fluctuation alone."""
    moments = blocks_of(0.1 * storm_of(10.0), 2, mean=5.0)
    assert find_slips(moments, "tension") == ()
    slipped = [replace(m, mean=m.mean * (10.0 if 40 <= m.index < 60 else 1.0)) for m in moments]
    assert [(slip.first, slip.last) for slip in find_slips(slipped, "tension")] == [(40, 59)]


def test_what_all_channels_do_is_weather():
    level, speed = blocks_of(storm_of(10.0), 3), blocks_of(storm_of(7.0), 4)
    assert len(find_slips(level, "level")) == 1
    assert find_slips(level, "level", others=[speed]) == ()
    # no weather multiplies a sea by a hundred
    assert len(find_slips(blocks_of(storm_of(100.0), 3), "level", others=[speed])) == 1


@pytest.mark.parametrize("seed", range(5))
def test_drift_of_the_zero(seed):
    random = np.random.default_rng(seed)
    rate = random.uniform(-1.0, 1.0) * 1e-5
    plain, drifting = [], []
    for index in range(300):
        noise = 0.02 * random.normal()
        middle = 600.0 + 1200.0 * index
        plain.append(BlockMoments(index, middle, noise, 0.5, 0.5))
        drifting.append(BlockMoments(index, middle, noise + rate * middle, 0.5, 0.5))
    found = find_drift(drifting, "level")
    assert found.rate == pytest.approx(rate, abs=4.0 * found.error)
    assert found.error < 5e-8
    assert found.significant
    assert not find_drift(plain, "level").share > 0.1


def test_joining_draws_no_line_across_a_gap():
    random = np.random.default_rng(2)
    time = np.arange(1000) * 0.1
    kept = np.ones(1000, bool)
    kept[300:400] = False
    a = record_of(time[kept], a=np.sin(time[kept]))
    b = record_of(time + 0.033, b=random.normal(size=1000))
    joined = join([a, b], step=0.1)
    inside = (joined.time > time[299] + 1e-9) & (joined.time < time[400] - 1e-9)
    assert np.isnan(joined["a"][inside]).all()
    assert not np.isnan(joined["a"][~inside]).any()
    np.testing.assert_allclose(joined["a"][~inside], np.sin(joined.time[~inside]), atol=2e-3)
    assert "left so" in joined.notices[-1].message
    assert np.isnan(interpolate([0.0, 1.0], [0.0, 1.0], [-0.1, 0.5, 1.1], largest_gap=2.0)).tolist() == [
        True,
        False,
        True,
    ]
    with pytest.raises(InputError, match="channel 'a'"):
        join([a, a], step=0.1)
    with pytest.raises(InputError, match="share no time"):
        join([a, record_of(time + 1e6, c=time)], step=0.1)
