"""Extremes, conditional exceedance, contours and fatigue at random inputs, against identities that always hold."""

import math

import numpy as np
import pytest
from scipy import stats

from moyai.design.fatigue import EnduranceCurve, damage, equivalent_range, life
from moyai.design.long_term import YEAR, JointSea, environmental_contour, long_term_exceedance, return_level
from moyai.series.acer import acer_interval, exceedance_rates, fit_tail
from moyai.series.extremes import ExtremeFit, fit
from moyai.series.peaks import peaks_of
from moyai.series.rainflow import count_cycles

SEEDS = range(6)


def peaks_by(rng):
    count = int(rng.integers(300, 800))
    noise = rng.standard_normal(count + 1)
    mixed = noise[1:] + rng.uniform(0.0, 1.5) * noise[:-1]
    return [np.abs(part) for part in np.array_split(mixed, int(rng.integers(1, 12)))]


@pytest.mark.slow
@pytest.mark.parametrize("seed", SEEDS)
def test_conditional_exceedance_does_not_know_units_or_zero(seed):
    rng = np.random.default_rng(seed)
    rows, factor, shift = peaks_by(rng), float(rng.uniform(1e-3, 1e6)), float(rng.uniform(-5, 5))
    order, count = int(rng.integers(1, 4)), float(rng.uniform(1e3, 1e5))
    one = exceedance_rates(rows, order=order)
    other = exceedance_rates([factor * (row + shift) for row in rows], order=order)
    assert np.allclose(other.level, factor * (one.level + shift), rtol=1e-9)
    assert np.allclose(other.rate, one.rate, atol=2.0 / one.count)
    tail, moved = fit_tail(one), fit_tail(other)
    level = tail.maximum_level(count, 0.9)
    assert moved.maximum_level(count, 0.9) == pytest.approx(factor * (level + shift), rel=2e-3, abs=2e-3 * factor)
    # The level and the rate undo each other, and the interval holds the value
    assert float(tail.rate(level)) == pytest.approx(-math.log(0.9) / count, rel=1e-9)
    interval = acer_interval(tail, count, 0.9)
    assert interval.lower <= interval.value <= interval.upper


@pytest.mark.parametrize("seed", SEEDS)
def test_rates_of_first_order_are_the_share_of_peaks_above(seed):
    rng = np.random.default_rng(seed)
    peaks = np.concatenate(peaks_by(rng))
    rates = exceedance_rates([peaks], order=1)
    assert np.allclose(rates.rate, [(peaks > level).mean() for level in rates.level], rtol=1e-12)
    # A condition on the peaks before can only take exceedances away from the count
    second = exceedance_rates([peaks], order=2)
    assert (second.rate * peaks.size <= rates.rate * peaks.size + 1 + second.rate * peaks.size * rates.rate).all()


@pytest.mark.parametrize("seed", SEEDS)
def test_contours_lie_on_the_circle_of_their_return_period(seed):
    rng = np.random.default_rng(seed)
    height = ExtremeFit(
        "weibull", float(rng.uniform(0, 1)), float(rng.uniform(0.3, 3)), float(rng.uniform(0.9, 2.2)), 0, math.nan
    )
    sea = JointSea(
        height,
        tuple(map(float, rng.uniform([0.5, 0.1, 0.2], [1.5, 0.8, 0.8]))),
        tuple(map(float, rng.uniform([0.02, 0.01, -1.5], [0.1, 0.2, -0.1]))),
    )
    years, duration = float(rng.uniform(1, 200)), float(rng.uniform(600, 6 * 3600))
    significant, period = environmental_contour(sea, years, duration, int(rng.integers(8, 60)))
    first = stats.norm.isf(height.exceedance(significant))
    a, b = sea.mean_log, sea.deviation_log
    mean = a[0] + a[1] * significant ** a[2]
    second = (np.log(period) - mean) / (b[0] + b[1] * np.exp(b[2] * significant))
    beta = stats.norm.isf(duration / (years * YEAR))
    # Far below the lower end of the tail the height is so near its location that the angle is lost
    known = height.exceedance(significant) < 1.0 - 1e-9
    assert known.sum() > 3 and np.allclose(np.hypot(first, second)[known], beta, rtol=1e-4)
    assert significant[0] == pytest.approx(significant.max()) == pytest.approx(float(height.level(stats.norm.sf(beta))))


@pytest.mark.parametrize("seed", SEEDS)
def test_return_levels_are_exceeded_once_in_their_years(seed):
    rng = np.random.default_rng(seed)
    share = rng.dirichlet(np.ones(5))
    laws = [
        ExtremeFit("gumbel", float(m), float(s), 0.0, 9, math.nan)
        for m, s in zip(rng.uniform(1, 50, 5), rng.uniform(0.1, 5, 5))
    ]
    years, duration = float(rng.uniform(0.5, 500)), float(rng.uniform(1200, 20000))
    level = return_level(years, share, [law.exceedance for law in laws], duration, (1e-3, 1e4))
    rate = long_term_exceedance(level, share, [law.exceedance for law in laws], duration)[0]
    assert rate * years == pytest.approx(1.0, rel=1e-9)
    # Of Gumbel laws the logarithm of the survival is known: the sum by hand
    by_hand = sum(p * math.exp(-(level - law.location) / law.scale) for p, law in zip(share, laws)) * YEAR / duration
    assert by_hand * years == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("seed", SEEDS)
def test_rainflow_loses_none_of_the_way_of_a_record(seed):
    rng = np.random.default_rng(seed)
    record = np.cumsum(rng.standard_normal(int(rng.integers(50, 3000)))) * rng.uniform(0.1, 1e6)
    ranges, means, counts = count_cycles(record)
    # Every half cycle is walked once, so that twice the counted ranges are the whole way up and down
    assert 2.0 * np.sum(ranges * counts) == pytest.approx(np.abs(np.diff(record)).sum(), rel=1e-9)
    assert ranges.max() == pytest.approx(np.ptp(record)) and set(counts) <= {0.5, 1.0}
    assert (means - 0.5 * ranges >= record.min() - 1e-6 * np.ptp(record)).all()
    assert (means + 0.5 * ranges <= record.max() + 1e-6 * np.ptp(record)).all()
    # Upside down or backwards the record does the same damage
    exponent = float(rng.uniform(1, 6))
    curve = EnduranceCurve("x", exponent, float(rng.uniform(1, 1e12)), "1", True, "")
    done = damage(ranges, counts, curve)
    again, _, turned = count_cycles(-record)
    assert damage(again, turned, curve) == pytest.approx(done, rel=1e-9)
    factor = float(rng.uniform(0.1, 10))
    assert damage(factor * ranges, counts, curve) == pytest.approx(factor**exponent * done, rel=1e-9)
    cycles = float(rng.uniform(10, 1e7))
    same = equivalent_range(ranges, counts, exponent, cycles)
    assert damage([same], [cycles], curve) == pytest.approx(done, rel=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_life_is_that_of_the_mixture_of_states(seed):
    rng = np.random.default_rng(seed)
    share, done, duration = rng.dirichlet(np.ones(7)), rng.uniform(1e-9, 1e-5, 7), float(rng.uniform(60, 1e4))
    years = life(done, share, duration)
    assert years * YEAR / duration * float(share @ done) == pytest.approx(1.0, rel=1e-9)


@pytest.mark.parametrize("seed", SEEDS)
def test_peaks_do_not_know_units_and_hold_the_largest_value_of_the_inside(seed):
    rng = np.random.default_rng(seed)
    series = np.convolve(rng.standard_normal(4000), np.hanning(int(rng.integers(5, 60))), "same")
    peaks, _ = peaks_of(series)
    factor, shift = float(rng.uniform(1e-3, 1e6)), float(rng.uniform(-1e3, 1e3))
    moved, _ = peaks_of(factor * (series + shift))
    assert np.allclose(moved, factor * (peaks + shift), rtol=1e-9)
    mean = series.mean()
    assert (peaks > mean).all()
    crossings = np.flatnonzero((series[:-1] <= mean) & (series[1:] > mean)) + 1
    assert peaks.size == crossings.size - 1
    assert peaks.max() == series[crossings[0] : crossings[-1]].max()


@pytest.mark.parametrize("family", ["gumbel", "weibull", "generalised_pareto"])
@pytest.mark.parametrize("seed", SEEDS)
def test_fits_do_not_know_units_or_zero(family, seed):
    rng = np.random.default_rng(seed)
    data = rng.gumbel(size=60) if family == "gumbel" else rng.weibull(rng.uniform(0.8, 2.5), 200)
    location = None if family == "gumbel" else 0.0
    factor, shift = float(rng.uniform(1e-4, 1e7)), float(rng.uniform(-3, 3))
    one = fit(data, family, location=location)
    moved = None if location is None else factor * (location + shift)
    other = fit(factor * (data + shift), family, location=moved)
    for p in (0.5, 0.01, 1e-5):
        assert float(other.level(p)) == pytest.approx(
            factor * (float(one.level(p)) + shift), rel=2e-5, abs=2e-5 * factor
        )
