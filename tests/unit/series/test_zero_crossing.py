"""Zero crossing, detrending and fits of heights against known waves and an independent count."""

import itertools
import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.series.detrend import Detrend, detrended, slow_part, slow_response
from moyai.series.wave_statistics import fit_rayleigh, fit_weibull
from moyai.series.zero_crossing import WaveOptions, find_waves, share_of, split_waves


def sea(random, size=6000, step=0.5, height=2.0, period=7.0):
    time = np.arange(size) * step
    omega = 2.0 * np.pi / period * random.uniform(0.6, 1.8, 150)
    phase = random.uniform(0.0, 2.0 * np.pi, 150)
    return time, height / 4.0 * math.sqrt(2.0 / 150.0) * np.cos(np.outer(time, omega) + phase).sum(axis=1)


def plain_count(time, values, band):
    """The same rules, written as a search among crossings instead of a running state."""
    crossings = [i for i in range(1, len(values)) if values[i - 1] < 0.0 <= values[i]]
    kept, armed_from = [], 0
    for place, i in enumerate(crossings):
        until = crossings[place + 1] if place + 1 < len(crossings) else len(values)
        if min(values[armed_from:i]) < -band:
            after = values[i:until]
            above = np.flatnonzero(after >= band)
            below = np.flatnonzero(after < -band)
            if above.size and not (below.size and below[0] < above[0]):
                kept.append(i)
                armed_from = i
    instants = [time[i - 1] + (time[i] - time[i - 1]) * -values[i - 1] / (values[i] - values[i - 1]) for i in kept]
    heights = [max(values[a:b]) - min(values[a:b]) for a, b in itertools.pairwise(kept)]
    return np.array(instants), np.array(heights)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("band", [0.0, 0.1, 0.4])
def test_against_an_independent_count(seed, band):
    random = np.random.default_rng(seed)
    time, values = sea(random)
    values -= values.mean()
    options = WaveOptions(dead_band=band, crest="sample", detrend=Detrend("none"))
    waves = find_waves(time, values, options)
    instants, heights = plain_count(time, values, band)
    np.testing.assert_allclose(waves.start, instants[:-1], atol=1e-9)
    np.testing.assert_allclose(waves.period, np.diff(instants), atol=1e-9)
    np.testing.assert_allclose(waves.height, heights, atol=1e-12)
    if band == 0.0:
        other = split_waves(time, values, mean_level=0.0)
        np.testing.assert_allclose(waves.height, other.height, atol=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_down_is_up_of_the_mirror(seed):
    random = np.random.default_rng(seed)
    time, values = sea(random)
    down = find_waves(time, values, WaveOptions(crossing="down"))
    up = find_waves(time, -values, WaveOptions(crossing="up"))
    np.testing.assert_array_equal(down.start, up.start)
    np.testing.assert_allclose(down.crest, -up.trough)
    np.testing.assert_allclose(down.height, up.height)


def test_regular_wave_has_its_height_period_and_dates_keep_their_digits():
    for origin in (0.0, 938_177_000.0):
        time = origin + np.arange(4000) * 0.21
        values = 3.0 + 0.75 * np.cos(2.0 * np.pi * time / 6.37)
        waves = find_waves(time, values, WaveOptions(detrend=Detrend("mean"), crest="parabola"))
        figures = waves.statistics()
        assert figures["count"] == pytest.approx(840.0 / 6.37 - 1.0, abs=1.0)
        assert figures["maximum_height"] == pytest.approx(1.5, rel=2e-4)
        assert figures["mean_period"] == pytest.approx(6.37, rel=1e-4)
        sampled = find_waves(time, values, WaveOptions(crest="sample")).statistics()["mean_height"]
        assert sampled < 1.4999


def test_a_hundred_waves_by_hand():
    """Whole cosine waves of height 1 to 100 cm: H1/10, H1/3 and the mean follow by hand, for each rounding."""
    heights = np.random.default_rng(0).permutation(np.arange(1, 101)) / 100.0
    cycle = np.arange(64) / 64.0
    values = np.concatenate([[-0.001], *[0.5 * h * np.sin(2.0 * np.pi * (cycle + 1e-6)) for h in heights], [0.001]])
    time = np.arange(values.size) / 8.0
    exact = {"nearest": 33, "down": 33, "up": 34}
    for rounding, number in exact.items():
        options = WaveOptions(share=rounding, detrend=Detrend("none"), crest="sample")
        figures = find_waves(time, values, options).statistics()
        assert figures["count"] == 100
        assert figures["third_height"] == pytest.approx(np.mean(np.arange(101 - number, 101)) / 100.0, rel=1e-4)
        assert figures["tenth_height"] == pytest.approx(0.955, rel=1e-4)
        assert figures["mean_height"] == pytest.approx(0.505, rel=1e-4)
        assert figures["maximum_height"] == pytest.approx(1.0, rel=1e-4)
    assert [share_of(100, 1 / 3, kind) for kind in ("nearest", "down", "up")] == [33, 33, 34]
    assert share_of(5, 0.1) == 1


@pytest.mark.parametrize("seed", range(4))
def test_waves_at_a_gap_are_left_out_and_no_other(seed):
    random = np.random.default_rng(seed)
    time, values = sea(random)
    options = WaveOptions(detrend=Detrend("none"))
    whole = find_waves(time, values, options)
    holes = random.choice(6000, 12, replace=False)
    dirty = values.copy()
    dirty[holes] = np.nan
    broken = find_waves(time, dirty, options)
    touched = [np.any((time[holes] >= a - 0.5) & (time[holes] <= b + 0.5)) for a, b in zip(whole.start, whole.end)]
    kept = whole.start[~np.array(touched)]
    assert np.isin(np.round(kept, 6), np.round(broken.start, 6)).all()
    assert np.isin(np.round(broken.start, 6), np.round(whole.start, 6)).all()
    for hole in time[holes]:
        assert not np.any((broken.start < hole) & (hole < broken.end))
    removed = np.delete(np.arange(6000), holes)
    as_gap = find_waves(time[removed], values[removed], options)
    np.testing.assert_allclose(as_gap.start, broken.start, atol=1e-9)
    assert broken.notices[0].code == "waves-broken"


def test_period_limits_and_few_waves():
    time, values = sea(np.random.default_rng(1))
    waves = find_waves(time, values, WaveOptions(shortest=4.0, longest=12.0))
    assert waves.period.min() >= 4.0 and waves.period.max() <= 12.0
    assert waves.notices[0].code == "waves-periods"
    single = find_waves(time[:40], np.sin(2.0 * np.pi * time[:40] / 12.0 - 0.5), WaveOptions(detrend=Detrend("none")))
    assert len(single) == 1 and single.notices[-1].code == "few-waves"
    assert single.statistics()["third_height"] == single.statistics()["maximum_height"]
    none = find_waves(time, time, WaveOptions(detrend=Detrend("none")))
    assert len(none) == 0 and math.isnan(none.statistics()["third_height"])
    assert math.isnan(none.highest(0.1)[0])


def test_no_record_of_waves():
    with pytest.raises(InputError, match="no record of waves"):
        find_waves(np.arange(10.0), np.full(10, np.nan), WaveOptions())
    with pytest.raises(InputError, match="increase"):
        find_waves([0.0, 2.0, 1.0], [0.0, 1.0, 2.0], WaveOptions())
    with pytest.raises(InputError, match="dead band"):
        WaveOptions(dead_band=-1.0)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.05, 0.2, 0.5, 1.0, 2.0, 8.0])
def test_slow_part_has_the_response_it_states(ratio):
    """A single cosine through the filter, away from the ends, with random gaps."""
    random = np.random.default_rng(int(100 * ratio))
    cutoff = 900.0
    time = np.arange(0.0, 12 * cutoff * max(ratio, 1.0), 2.0)
    values = np.cos(2.0 * np.pi * time / (ratio * cutoff) + 0.7)
    slow = slow_part(time, values, cutoff)
    inner = (time > 1.5 * cutoff) & (time < time[-1] - 1.5 * cutoff)
    found = np.sum(slow[inner] * values[inner]) / np.sum(values[inner] ** 2)
    assert found == pytest.approx(slow_response(ratio)[0], abs=0.01)
    assert slow_response(1.0)[0] == pytest.approx(0.5, abs=1e-9)
    gappy = np.where(random.random(time.size) < 0.2, np.nan, values)
    assert np.nanmax(np.abs(slow_part(time, gappy, cutoff) - slow)[inner]) < 0.15


@pytest.mark.slow
def test_tide_and_surge_are_taken_off_and_waves_stay():
    random = np.random.default_rng(4)
    time, waves = sea(random, 43200, 0.5)
    tide = (
        1.2 * np.cos(2.0 * np.pi * time / 44712.0 + 0.3)
        + 0.4 * (time / time[-1]) ** 2
        + 0.1 * np.tanh((time - 9e3) / 3e3)
    )
    rest = detrended(time, waves + tide, Detrend("high_pass", 1800.0))
    assert np.std(rest - waves) < 0.01 * waves.std()
    options = WaveOptions(detrend=Detrend("high_pass", 1800.0))
    clean = find_waves(time, waves, WaveOptions(detrend=Detrend("none"))).statistics()
    found = find_waves(time, waves + tide, options).statistics()
    assert found["third_height"] == pytest.approx(clean["third_height"], rel=2e-3)
    with pytest.raises(InputError, match="cut-off"):
        detrended(time[:100], waves[:100], Detrend("high_pass", 1800.0))


@pytest.mark.parametrize("kind", ["mean", "linear", "quadratic"])
def test_polynomials_are_removed_exactly(kind):
    random = np.random.default_rng(9)
    time = 9e8 + np.sort(random.uniform(0.0, 5e4, 300))
    degree = {"mean": 0, "linear": 1, "quadratic": 2}[kind]
    values = np.polynomial.Polynomial(random.normal(size=degree + 1))((time - time[0]) / 1e4)
    values[5] = np.nan
    assert np.nanmax(np.abs(detrended(time, values, Detrend(kind)))) < 1e-9


@pytest.mark.parametrize("seed", range(5))
def test_weibull_and_rayleigh_recover_what_was_drawn(seed):
    random = np.random.default_rng(seed)
    scale, shape = random.uniform(0.1, 5.0), random.uniform(1.0, 3.5)
    heights = scale * random.weibull(shape, 4000)
    fit = fit_weibull(heights)
    assert abs(fit.scale - scale) < 4.0 * fit.scale_error
    assert abs(fit.shape - shape) < 4.0 * fit.shape_error
    assert fit.shape_error == pytest.approx(0.78 * shape / math.sqrt(4000), rel=0.1)  # Menon's asymptotic 0.78
    assert fit.distance < 1.63 / math.sqrt(4000)
    for name in ("scale", "shape"):  # the likelihood has its top there
        for change in (0.99, 1.01):
            s, k = (fit.scale * change, fit.shape) if name == "scale" else (fit.scale, fit.shape * change)
            r = heights / s
            assert np.sum(np.log(k / s) + (k - 1.0) * np.log(r) - r**k) < fit.fitted.log_likelihood
    rayleigh = fit_rayleigh(scale * np.sqrt(-np.log(random.random(4000))))
    assert rayleigh.shape == 2.0
    assert rayleigh.scale == pytest.approx(scale, rel=0.05)
    assert rayleigh.fitted.exceedance(rayleigh.fitted.level(0.013)) == pytest.approx(0.013)
    with pytest.raises(InputError):
        fit_weibull([1.0, 1.0])
