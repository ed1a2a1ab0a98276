"""Extremes against distributions whose answers are known."""

import math

import numpy as np
import pytest
from scipy import stats
from scipy.signal import lfilter

from moyai.core.errors import InputError
from moyai.series.acer import acer_interval, exceedance_rates, fit_tail
from moyai.series.extremes import check_fit, fit, maximum_interval
from moyai.series.peaks import PeakKind, maximum_of_kinds, most_probable_of_kinds, peaks_of


@pytest.mark.parametrize("seed", range(4))
def test_fits_are_the_maxima_of_scipys_likelihoods(seed):
    rng = np.random.default_rng(seed)
    gumbel = stats.gumbel_r.rvs(rng.uniform(-5, 50), rng.uniform(0.1, 20), size=60, random_state=rng)
    found = fit(gumbel, "gumbel")
    mode, scale = stats.gumbel_r.fit(gumbel)
    assert found.log_likelihood >= stats.gumbel_r.logpdf(gumbel, mode, scale).sum() - 1e-6
    assert math.isclose(
        found.log_likelihood, stats.gumbel_r.logpdf(gumbel, found.location, found.scale).sum(), rel_tol=1e-10
    )
    shape = rng.uniform(0.6, 3.0)
    weibull = 2.0 + stats.weibull_min.rvs(shape, scale=rng.uniform(0.1, 9), size=80, random_state=rng)
    found = fit(weibull, "weibull", location=2.0)
    c, _, s = stats.weibull_min.fit(weibull, floc=2.0)
    assert found.shape == pytest.approx(c, rel=1e-3) and found.scale == pytest.approx(s, rel=1e-3)
    assert found.log_likelihood >= stats.weibull_min.logpdf(weibull, c, 2.0, s).sum() - 1e-6
    pareto = 1.0 + stats.genpareto.rvs(rng.uniform(-0.3, 0.4), scale=rng.uniform(0.1, 9), size=200, random_state=rng)
    found = fit(pareto, "generalised_pareto", location=1.0)
    c, _, s = stats.genpareto.fit(pareto, floc=1.0)
    assert found.log_likelihood >= stats.genpareto.logpdf(pareto, c, 1.0, s).sum() - 1e-5
    assert math.isclose(
        found.log_likelihood, stats.genpareto.logpdf(pareto, found.shape, 1.0, found.scale).sum(), rel_tol=1e-9
    )


@pytest.mark.parametrize("seed", range(4))
def test_the_tail_of_a_weibull_law_is_found_whatever_lies_below(seed):
    rng = np.random.default_rng(seed)
    location, scale, shape = rng.uniform(-3, 3), rng.uniform(0.5, 20), rng.uniform(0.8, 3)
    values = location + scale * rng.weibull(shape, 4000)
    threshold = float(np.quantile(values, rng.uniform(0.3, 0.7)))
    # What lies below follows another law, and does not matter
    values[values < threshold] = rng.uniform(location, threshold, np.sum(values < threshold))
    found = fit(values, "weibull", location=location, threshold=threshold)
    above = values[values > threshold]

    def likelihood(k, s):
        law = stats.weibull_min(k, location, s)
        return law.logpdf(above).sum() - above.size * law.logsf(threshold)

    best = likelihood(found.shape, found.scale)
    assert found.log_likelihood == pytest.approx(best, rel=1e-9)
    for k, s in ((1.01, 1.0), (0.99, 1.0), (1.0, 1.01), (1.0, 0.99)):
        assert likelihood(found.shape * k, found.scale * s) < best
    assert found.shape == pytest.approx(shape, rel=0.15)
    # Levels far in the tail, and exceedance as its inverse
    rare = location + scale * (((threshold - location) / scale) ** shape + math.log(1e5)) ** (1 / shape)
    assert float(found.level(1e-5)) == pytest.approx(rare, rel=0.08)
    assert float(found.exceedance(found.level(1e-7))) == pytest.approx(1e-7, rel=1e-6)
    assert float(found.exceedance(threshold)) == 1.0
    interval = maximum_interval(found, 2000, seed=1, repetitions=40)
    assert interval.lower < found.most_probable_maximum(2000) < interval.upper


@pytest.mark.parametrize("seed", range(3))
def test_the_maximum_of_two_kinds_of_peaks_is_that_of_their_product(seed):
    rng = np.random.default_rng(seed)
    one = PeakKind(fit(5.0 + rng.weibull(1.5, 300), "weibull", location=5.0), float(rng.uniform(50, 500)))
    two = PeakKind(
        fit(6.0 + 2.0 * rng.exponential(1.0, 80), "generalised_pareto", location=6.0), float(rng.uniform(5, 60))
    )
    probability = float(rng.uniform(0.2, 0.99))
    level = maximum_of_kinds([one, two], probability)
    drawn = (1 - one.fitted.exceedance(level)) ** one.count * (1 - two.fitted.exceedance(level)) ** two.count
    assert float(drawn) == pytest.approx(probability, rel=1e-9)
    # Peaks of one kind alone: the closed form
    assert maximum_of_kinds([one], probability) == pytest.approx(
        one.fitted.maximum_level(one.count, probability), rel=1e-9
    )
    assert level > max(maximum_of_kinds([each], probability) for each in (one, two)) - 1e-9
    mode = most_probable_of_kinds([two])
    assert mode == pytest.approx(two.fitted.most_probable_maximum(two.count), rel=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_peaks_between_up_crossings_and_those_after_slack(seed):
    rng = np.random.default_rng(seed)
    heights = 10.0 + rng.uniform(1.0, 5.0, 40)
    troughs = np.where(rng.random(40) < 0.3, 0.0, 8.0)
    series = np.ravel(np.column_stack([troughs, np.full(40, 9.0), heights, np.full(40, 9.5)]))
    peaks, after_slack = peaks_of(series)
    # The first up-crossing opens the first peak, the last one closes the one before
    assert np.allclose(peaks, heights[:-1]) and np.array_equal(after_slack, troughs[:-1] == 0.0)
    wave = np.sin(2 * np.pi * np.arange(2000) / 50.0 + rng.uniform(0, 6))
    peaks, after_slack = peaks_of(20.0 + wave)
    assert peaks.size in (39, 38) and np.allclose(peaks, 21.0, atol=2e-3) and not after_slack.any()
    for nothing in ([], [1.0], np.ones(50), [1.0, 2.0, 3.0]):
        assert peaks_of(nothing)[0].size == 0


@pytest.mark.parametrize("family", ["gumbel", "weibull", "generalised_pareto"])
def test_levels_and_exceedances_undo_each_other_far_into_the_tail(family):
    rng = np.random.default_rng(3)
    location = None if family == "gumbel" else 0.0
    values = 3.0 + rng.gumbel(size=50) if family == "gumbel" else rng.weibull(1.5, 50)
    found = fit(values, family, location=location)
    for p in (0.5, 1e-3, 1e-9, 1e-14):
        level = float(found.level(p))
        if family != "generalised_pareto" or found.shape > 0:
            assert float(found.exceedance(level)) == pytest.approx(p, rel=1e-6)


def test_the_maximum_of_rayleigh_peaks_is_known():
    # Rayleigh peaks of deviation 1: mode of the maximum of n is sqrt(2 ln n), and P(max <= x) = (1 - exp(-x^2/2))^n
    found = fit(np.sqrt(-2.0 * np.log(1.0 - (np.arange(20000) + 0.5) / 20000)), "weibull", location=0.0)
    assert found.shape == pytest.approx(2.0, rel=2e-3)
    assert found.most_probable_maximum(1000) == pytest.approx(math.sqrt(2 * math.log(1000)), rel=2e-3)
    exact = math.sqrt(-2.0 * math.log(1.0 - 0.9 ** (1.0 / 1000.0)))
    assert found.maximum_level(1000, 0.9) == pytest.approx(exact, rel=2e-3)


@pytest.mark.slow
@pytest.mark.parametrize(("family", "confidence"), [("gumbel", 0.9), ("weibull", 0.9)])
def test_intervals_cover_as_often_as_they_say(family, confidence):
    rng = np.random.default_rng(11)
    covered = 0
    repetitions = 150
    for number in range(repetitions):
        if family == "gumbel":
            data, location = 10.0 + 2.0 * rng.gumbel(size=30), None
            truth, count, probability = 10.0 - 2.0 * math.log(-math.log(0.9)), 1.0, 0.9
        else:
            data, location = rng.weibull(1.4, 200), 0.0
            truth, count, probability = math.log(5000.0) ** (1 / 1.4), 5000.0, None
        interval = maximum_interval(
            fit(data, family, location=location), count, seed=number, probability=probability, confidence=confidence,
            repetitions=200,
        )  # fmt: skip
        covered += interval.lower <= truth <= interval.upper
    # Two and a half deviations of the binomial count, and 3 % for the bootstrap's own bias at these sizes
    slack = 2.5 * math.sqrt(confidence * (1 - confidence) / repetitions) + 0.03
    assert abs(covered / repetitions - confidence) < slack


@pytest.mark.parametrize(("shape", "count"), [(-0.2, 30), (0.1, 25), (0.3, 200)])
def test_the_bounds_of_a_pareto_level_are_those_of_its_likelihood(shape, count):
    """All pairs of shape and scale whose likelihood is near the largest, by scipy: the levels that they span."""
    rng = np.random.default_rng(count)
    values = 5.0 + stats.genpareto.rvs(shape, scale=2.0, size=count, random_state=rng)
    fitted = fit(values, "generalised_pareto", location=5.0)
    found = maximum_interval(fitted, 300.0, seed=1, probability=0.5, confidence=0.9, values=values)
    scales = fitted.scale * np.geomspace(0.2, 4.0, 300)[:, None]
    shapes = np.linspace(-1.0, fitted.shape + 1.6, 400)[None, :]
    likelihood = sum(stats.genpareto.logpdf(one - 5.0, shapes, scale=scales) for one in values)
    near = 2.0 * (fitted.log_likelihood - likelihood) <= stats.t.ppf(0.95, count - 2) ** 2
    level = 5.0 + stats.genpareto.isf(1.0 - 0.5 ** (1.0 / 300.0), shapes, scale=scales)[near]
    assert found.value == pytest.approx(fitted.maximum_level(300.0, 0.5), rel=1e-12)
    # the grid lies within the region: a little less than all of it
    assert found.lower == pytest.approx(level.min(), rel=0.02) and found.lower <= level.min() * 1.0001
    assert found.upper == pytest.approx(level.max(), rel=0.08) and found.upper >= level.max() * 0.9999


@pytest.mark.slow
@pytest.mark.parametrize(("count", "least"), [(20, 0.78), (100, 0.84)])
def test_intervals_of_few_pareto_values_cover_more_than_samples_of_the_fit(count, least):
    rng = np.random.default_rng(3)
    truth, held = 3.0 * (1000.0**0.05 - 1.0) / 0.05, np.zeros(2)
    for number in range(200):
        values = stats.genpareto.rvs(0.05, scale=3.0, size=count, random_state=rng)
        fitted = fit(values, "generalised_pareto", location=0.0)
        both = [maximum_interval(fitted, 1000.0, seed=number, repetitions=50, values=one) for one in (values, None)]
        held += [one.lower <= truth <= one.upper for one in both]
    assert held[0] / 200.0 >= least and held[0] > held[1]


@pytest.mark.slow
def test_average_conditional_exceedance_finds_the_maximum_of_correlated_peaks():
    """Gaussian sequences with correlation 0.7: the truth is the median of the maxima of very many of them."""
    rng = np.random.default_rng(2)

    def sequences(number):
        noise = math.sqrt(1.0 - 0.7**2) * rng.standard_normal((number, 1050))
        return lfilter([1.0], [1.0, -0.7], noise, axis=1)[:, 50:]

    truth = float(np.median(np.concatenate([sequences(1000).max(axis=1) for _ in range(20)])))
    found, firsts = [], []
    for _ in range(30):
        realisations = list(sequences(20))
        found.append(acer_interval(fit_tail(exceedance_rates(realisations, order=4)), 1000, 0.5, confidence=0.95))
        firsts.append(fit_tail(exceedance_rates(realisations, order=1)).maximum_level(1000, 0.5))
    values = np.array([one.value for one in found])
    assert sum(one.lower <= truth <= one.upper for one in found) >= 26
    # three standard errors of a mean of thirty whose deviation is 0.075
    assert abs(values.mean() - truth) < 3.0 * 0.075 / math.sqrt(30.0)
    # Counting every exceedance ignores the correlation: it can only be larger
    assert np.mean(firsts) > values.mean()


def test_the_error_of_exceedance_rates_is_that_of_a_mean_of_realisations():
    realisations = list(np.random.default_rng(3).normal(size=(6, 40)))
    found = exceedance_rates(realisations, order=1, levels=5)
    shares = np.array([[np.mean(one > level) for level in found.level] for one in realisations])
    assert found.rate == pytest.approx(shares.mean(axis=0), rel=1e-12)
    binomial = stats.binom(240, shares.mean(axis=0)).std() / 240.0
    between = stats.sem(shares, axis=0)
    assert np.any(between > binomial) and np.any(between < binomial)
    assert found.deviation == pytest.approx(np.maximum(between, binomial), rel=1e-12)
    # of the second order only peaks after one that did not exceed had a chance
    second = exceedance_rates(realisations[:1], order=2, levels=5)
    before, peak = realisations[0][:-1], realisations[0][1:]
    chances = np.array([np.sum(before <= level) for level in second.level])
    events = np.array([np.sum((before <= level) & (peak > level)) for level in second.level])
    assert second.deviation == pytest.approx(stats.binom(chances, events / chances).std() / chances, rel=1e-12)


def test_levels_at_which_all_realisations_count_alike_do_not_rule_the_tail():
    """Some of these five records have equal counts at a level; the median of the largest of 2000 is known."""
    exact = 100.0 * math.sqrt(2.0 * math.log(2000.0 / math.log(2.0)))
    found = []
    for seed in (49, 77, 133, 277):
        rng = np.random.default_rng([7, seed])
        found.append(fit_tail(exceedance_rates([rng.rayleigh(100.0, 400) for _ in range(5)], order=1)))
    levels = np.array([tail.maximum_level(2000.0, 0.5) for tail in found]) / exact
    assert np.all(np.abs(levels - 1.0) < 0.3)


def test_average_conditional_exceedance_of_independent_rayleigh_peaks_is_exact():
    rng = np.random.default_rng(8)
    peaks = [np.sqrt(-2.0 * np.log(rng.random(2000))) for _ in range(10)]
    tail = fit_tail(exceedance_rates(peaks, order=1))
    exact = math.sqrt(2.0 * math.log(1e5))
    assert tail.most_probable_maximum(1e5) == pytest.approx(exact, rel=0.06)


@pytest.mark.parametrize(
    ("values", "family", "location", "word"),
    [
        ([1.0, 2.0], "gumbel", None, "too few"),
        ([1.0] * 30, "gumbel", None, "equal"),
        ([1.0, math.nan] * 20, "gumbel", None, "NaN"),
        (list(range(30)), "weibull", None, "lower end"),
        (list(range(30)), "gumbel", 3.0, "leave it out"),
        (list(range(30)), "generalised_pareto", 28.0, "too few"),
    ],
)
def test_data_that_cannot_be_fitted_are_reported(values, family, location, word):
    with pytest.raises(InputError, match=word):
        fit(values, family, location=location)


def test_two_kinds_of_peaks_in_one_fit_are_noticed():
    rng = np.random.default_rng(1)
    mixed = np.concatenate([rng.weibull(2.0, 400), 6.0 + rng.weibull(1.0, 40)])
    assert any(notice.code == "extremes-distance" for notice in check_fit(fit(mixed, "weibull", location=0.0), mixed))
    clean = rng.weibull(2.0, 400)
    assert not check_fit(fit(clean, "weibull", location=0.0), clean)
