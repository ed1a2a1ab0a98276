"""Fits of snap peaks against scipy's, numerical maxima of the densities, and coverage of the intervals."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy import stats
from scipy.optimize import minimize_scalar

from moyai.core.errors import InputError
from moyai.series.snap_statistics import dispersion, fit_snaps, poisson_rate


def sample(law, shape, count, rng, scale=50.0):
    family = stats.weibull_min if law == "weibull" else stats.genpareto
    return family.rvs(shape, scale=scale, size=count, random_state=rng)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("law", ["weibull", "pareto"])
def test_estimates_are_those_of_greatest_likelihood(law, seed):
    rng = np.random.default_rng([seed, 1])
    shape = rng.uniform(0.6, 2.5) if law == "weibull" else rng.uniform(-0.2, 0.4)
    scale, threshold = 10.0 ** rng.uniform(-2, 5), 10.0 ** rng.uniform(-2, 5)
    values = sample(law, shape, 150, rng, scale)
    found = fit_snaps(threshold + values, 3.0, threshold=threshold, law=law, resamples=50)
    family = stats.weibull_min if law == "weibull" else stats.genpareto
    other = family.fit(values / scale, floc=0.0)
    assert found.shape.value == pytest.approx(other[0], abs=2e-3)
    assert found.scale.value / scale == pytest.approx(other[2], rel=2e-3)
    likelihood = [
        np.sum(family.logpdf(values / scale, c, scale=a))
        for c, _, a in ((found.shape.value, 0, found.scale.value / scale), other)
    ]
    assert likelihood[0] >= likelihood[1] - 1e-4


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("law", ["weibull", "pareto"])
def test_most_probable_maximum_is_the_top_of_the_density(law, seed):
    rng = np.random.default_rng([seed, 2])
    values = sample(law, rng.uniform(0.8, 2.0) if law == "weibull" else rng.uniform(-0.2, 0.3), 200, rng)
    found = fit_snaps(values, 2.0, threshold=0.0, law=law, resamples=50)
    family = stats.weibull_min if law == "weibull" else stats.genpareto
    frozen = family(found.shape.value, scale=found.scale.value)
    hours = rng.uniform(0.5, 1000.0)
    number = found.rate.value * hours

    def density(y):
        return -(frozen.logpdf(y) - number * frozen.sf(y))

    start, end = frozen.isf(1.0 / number), frozen.support()[1]
    best = minimize_scalar(
        density, bounds=(0.3 * start, min(3.0 * start, end * (1.0 - 1e-12))), method="bounded", options={"xatol": 1e-8}
    ).x
    assert found.most_probable_maximum(hours).value == pytest.approx(best, rel=1e-5)
    assert found.exceedance(best) == pytest.approx(frozen.sf(best), rel=1e-9)


def test_a_pareto_law_whose_density_rises_to_its_end_is_most_probable_there():
    """With a shape of -1 or less, which short samples give, the largest of any number lies at the upper end."""
    found = fit_snaps(sample("pareto", -0.1, 40, np.random.default_rng(4)), 2.0, threshold=0.0, law="pareto")
    shape, scale = -1.25, 60.0
    frozen = stats.genpareto(shape, scale=scale)
    y = np.linspace(0.0, scale / 1.25, 1000)[:-1]
    assert np.all(np.diff(frozen.logpdf(y) - 40.0 * frozen.sf(y)) > 0.0)
    steep = replace(
        found,
        shape=replace(found.shape, value=shape),
        scale=replace(found.scale, value=scale),
        resampled=np.tile([shape, scale, 20.0], (50, 1)),
    )
    largest = steep.most_probable_maximum(10.0)
    assert (largest.lower, largest.value, largest.upper) == pytest.approx([scale / 1.25] * 3, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "shape", "least"),
    [
        ("weibull", 1.0, 88),
        pytest.param("weibull", 1.8, 88, marks=pytest.mark.slow),
        pytest.param("pareto", 0.2, 78, marks=pytest.mark.slow),
        pytest.param("pareto", 0.0, 78, marks=pytest.mark.slow),
    ],
)
def test_intervals_hold_the_truth(law, shape, least):
    """Of 100 samples of some 80 peaks; a binomial share of 0.95 falls below 88 once in 600 trials."""
    rng = np.random.default_rng(12)
    held = np.zeros(4)
    family = stats.weibull_min if law == "weibull" else stats.genpareto
    lots = np.geomspace(1.0, 1e4, 20001) * 50.0
    density = family.logpdf(lots, shape, scale=50.0) - 800.0 * family.sf(lots, shape, scale=50.0)
    truth = 100.0 + lots[np.argmax(density)]
    trials = 100 if law == "weibull" else 40
    for trial in range(trials):
        peaks = 100.0 + sample(law, shape, rng.poisson(80), rng)
        found = fit_snaps(peaks, 10.0, threshold=100.0, law=law, resamples=80, seed=trial)
        largest = found.most_probable_maximum(100.0)
        pairs = ((found.shape, shape), (found.scale, 50.0), (found.rate, 8.0), (largest, truth))
        held += [interval.lower <= value <= interval.upper for interval, value in pairs]
    assert np.all(100.0 * held / trials >= least)


def test_wider_confidence_and_fewer_peaks_widen_the_interval():
    rng = np.random.default_rng(3)
    peaks = sample("weibull", 1.3, 400, rng)

    def width(values, confidence):
        found = fit_snaps(values, 10.0, threshold=0.0, confidence=confidence).most_probable_maximum(50.0)
        return found.upper - found.lower

    assert width(peaks, 0.99) > width(peaks, 0.9)
    assert width(peaks[:60], 0.9) > 1.5 * width(peaks, 0.9)


@pytest.mark.parametrize("count", [0, 1, 7, 200])
def test_rate_has_the_exact_bounds_of_poisson(count):
    found = poisson_rate(count, 2.5, 0.9)
    assert found.value == count / 2.5
    if count:
        assert stats.poisson.sf(count - 1, found.lower * 2.5) == pytest.approx(0.05, rel=1e-6)
    else:
        assert found.lower == 0.0
    assert stats.poisson.cdf(count, found.upper * 2.5) == pytest.approx(0.05, rel=1e-6)


def test_dispersion_tells_clusters():
    rng = np.random.default_rng(4)
    even = rng.uniform(0.0, 3600.0, 400)
    clustered = np.repeat(rng.uniform(0.0, 3600.0, 40), 10) + rng.uniform(0.0, 1.0, 400)
    assert dispersion(even, 0.0, 3600.0, 30) == pytest.approx(1.0, abs=0.5)
    assert dispersion(clustered, 0.0, 3600.0, 30) > 4.0


def test_notices_on_thin_and_wrong_fits():
    rng = np.random.default_rng(5)
    few = fit_snaps(sample("weibull", 1.0, 12, rng), 1.0, threshold=0.0)
    assert "snap-few" in {item.code for item in few.notices}
    mixed = np.concatenate([rng.uniform(1.0, 2.0, 200), rng.uniform(50.0, 60.0, 200)])
    assert "snap-fit" in {item.code for item in fit_snaps(mixed, 1.0, threshold=0.0, resamples=50).notices}
    heavy = fit_snaps(sample("pareto", 0.8, 200, rng), 1.0, threshold=0.0, law="pareto", resamples=50)
    assert "snap-heavy" in {item.code for item in heavy.notices}
    assert heavy.peaks[0] == heavy.peaks.max()
    assert heavy.empirical[0] == pytest.approx(1.0 / 201.0)


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"threshold": 1e9}, "longer sea"),
        ({"peaks": np.ones(50)}, "not all equal"),
        ({"hours": 0.0}, "hours"),
        ({"law": "normal"}, "'weibull', 'pareto'"),
        ({"confidence": 1.0}, "confidence"),
        ({"resamples": 3}, "resamples"),
        ({"peaks": [1.0, math.nan]}, "number"),
    ],
)
def test_bad_fits_are_refused(change, word):
    given = {"peaks": np.arange(1.0, 40.0), "hours": 1.0, "threshold": 0.0} | change
    with pytest.raises(InputError, match=word):
        fit_snaps(given.pop("peaks"), given.pop("hours"), **given)


def test_too_short_a_time_is_refused():
    found = fit_snaps(np.arange(1.0, 40.0), 39.0, threshold=0.0)
    with pytest.raises(InputError, match="longer time"):
        found.most_probable_maximum(0.5)


def test_pareto_shapes_below_minus_a_half_are_found():
    """The upper end of such peaks lies near the largest; a bound of the search at -1/2 would lengthen their tail."""
    peaks = stats.genpareto.isf((np.arange(2000) + 0.5) / 2000, -0.7, scale=5e3)
    found = fit_snaps(peaks, 3.0, threshold=0.0, law="pareto", resamples=50)
    assert found.shape.value == pytest.approx(-0.7, abs=0.02)
