"""Confidence intervals against scipy's distributions and by hand."""

import numpy as np
import pytest
from scipy import stats

from moyai.core.errors import ConvergenceError, InputError
from moyai.series.extremes import ExtremeFit, fit, kolmogorov_distance
from moyai.series.intervals import reach_of_mean, reflected_interval, scatter_of_end, student_quantile
from moyai.series.likelihood import pareto_likelihood, weibull_likelihood


@pytest.mark.parametrize("freedom", [1, 2, 7.5, 60])
def test_student_quantile_is_that_of_scipy(freedom):
    assert student_quantile(0.95, freedom) == pytest.approx(stats.t.ppf(0.975, freedom), rel=1e-12)
    # One-sided 95 % is the upper end of two-sided 90 %
    assert student_quantile(0.9, freedom) == pytest.approx(stats.t.isf(0.05, freedom), rel=1e-12)


def test_fewer_than_one_degree_of_freedom_counts_as_one():
    assert student_quantile(0.95, 0.3) == student_quantile(0.95, 1.0)
    with pytest.raises(InputError, match="confidence"):
        student_quantile(1.0, 5.0)


def test_draws_are_reflected_at_the_estimate():
    drawn = np.linspace(11.0, 15.0, 401)
    plain = reflected_interval(12.0, drawn, 0.5)
    assert (plain.lower, plain.upper) == pytest.approx((24.0 - 14.0, 24.0 - 12.0))
    # Distances 2 of the estimate, 2 to 8 of the draws in equal steps of their logarithm: middle half 2.83 to 5.66
    above = reflected_interval(12.0, 10.0 + np.geomspace(2.0, 8.0, 401), 0.5, base=10.0)
    assert (above.lower, above.upper) == pytest.approx((10.0 + 4.0 / 2.0**2.5, 10.0 + 4.0 / 2.0**1.5))
    # Draws at the lower end have no logarithmic distance
    end = reflected_interval(12.0, np.full(5, 10.0), 0.9, base=10.0)
    assert (end.lower, end.upper) == (14.0, 14.0)


@pytest.mark.parametrize("seed", range(3))
def test_kolmogorov_distance_is_that_of_scipy(seed):
    values = np.random.default_rng(seed).weibull(1.4, 60)
    fitted = ExtremeFit("weibull", 0.0, 1.1, 1.3, 60, 0.0)
    expected = stats.kstest(values, stats.weibull_min(1.3, scale=1.1).cdf).statistic
    assert kolmogorov_distance(fitted, values) == pytest.approx(expected, abs=1e-14)


@pytest.mark.parametrize("shape", [0.3, 1.0, 40.0])
def test_weibull_likelihood_has_no_slope_at_its_top(shape):
    values = np.random.default_rng(3).weibull(shape, 80) * 1e5
    found, scale = weibull_likelihood(values)
    power = (values / scale) ** found
    assert np.mean(power) == pytest.approx(1.0, rel=1e-10)
    assert np.mean((power - 1.0) * np.log(values / scale)) * found == pytest.approx(1.0, rel=1e-9)


def test_equal_values_have_no_likeliest_distribution():
    with pytest.raises(ConvergenceError):
        weibull_likelihood(np.full(10, 3.0))
    with pytest.raises(InputError):
        fit(np.full(10, 3.0), "weibull", location=0.0)


def test_excesses_over_many_decades_have_no_likeliest_pareto_distribution():
    with pytest.raises(ConvergenceError, match="no maximum"):
        pareto_likelihood(np.geomspace(1e-6, 1.0, 40))


@pytest.mark.parametrize("shape", [-0.6, 0.0, 0.3])
def test_pareto_likelihood_is_at_least_that_of_scipy(shape):
    values = stats.genpareto.rvs(shape, scale=2.0, size=200, random_state=4)
    found, scale = pareto_likelihood(values)
    other = stats.genpareto.fit(values, floc=0.0)
    assert (
        np.sum(stats.genpareto.logpdf(values, found, scale=scale))
        >= np.sum(stats.genpareto.logpdf(values, other[0], scale=other[2])) - 1e-6
    )


@pytest.mark.parametrize("count", [2, 3, 5, 8, 20])
def test_the_interval_of_a_mean_of_maxima_covers_what_it_says(count):
    """Drawn by Gumbel's law, whose mean is Euler's constant: 95 of 100, where Student's covers 90 to 92."""
    drawn = np.random.default_rng(count).gumbel(size=(4000, count))
    ends = np.array([row.mean() + reach_of_mean(row) for row in drawn])
    assert 0.94 < np.mean(ends >= np.euler_gamma) < 0.98
    error = drawn.std(axis=1, ddof=1) / np.sqrt(count)
    student = drawn.mean(axis=1) + student_quantile(0.9, count - 1) * error
    assert np.mean(student >= np.euler_gamma) < 0.93


def test_more_values_of_the_same_scatter_narrow_an_interval_that_still_covers():
    """Three values with five of another scale and the same relative scatter, most of them of the same seas."""
    rng = np.random.default_rng(8)
    seas, others = rng.random((4000, 5)), rng.random((4000, 5))
    again = np.where(rng.random((4000, 5)) < 0.9, seas, others)
    values, alike = (10.0 + 3.0 * -np.log(-np.log(drawn)) for drawn in (seas[:, :3], again))
    mean = 10.0 + 3.0 * np.euler_gamma
    alone = np.array([reach_of_mean(row) for row in values])
    more = np.array([reach_of_mean(row, alike=2.3 * others) for row, others in zip(values, alike, strict=True)])
    assert np.mean(values.mean(axis=1) + more >= mean) > 0.94
    assert more.mean() < 0.9 * alone.mean()
    # a smaller sample adds nothing
    assert reach_of_mean(values[0], alike=alike[0, :2]) == alone[0]


@pytest.mark.slow
@pytest.mark.parametrize("count", [3, 5, 8, 20])
def test_the_end_of_an_interval_scatters_as_is_said(count):
    """Drawn by Gumbel's law: the deviation of the ends of many sets, and the root mean square of what each set says."""
    drawn = np.random.default_rng(count).gumbel(size=(20000, count))
    ends = np.array([row.mean() + reach_of_mean(row) for row in drawn])
    said = np.array([scatter_of_end(row) for row in drawn])
    assert np.sqrt(np.mean(said**2)) == pytest.approx(ends.std(), rel=0.12 if count > 3 else 0.25)
    assert scatter_of_end([2.0]) == 0.0 and scatter_of_end([2.0, 2.0]) == 0.0
