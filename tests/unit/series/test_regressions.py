"""Regressions against scipy and numpy, planted relations, and coverage of the bounds."""

import math

import numpy as np
import pytest
from scipy import stats
from scipy.optimize import curve_fit

from moyai.core.errors import InputError
from moyai.series.regressions import (
    correlation,
    fit_by_direction,
    fit_cosine,
    fit_line,
    fit_power,
    resampled,
    type_ratio,
)


@pytest.mark.parametrize("seed", range(5))
def test_line_is_that_of_scipy(seed):
    rng = np.random.default_rng(seed)
    x = 10.0 ** rng.uniform(-3, 3) * rng.uniform(0.5, 2.0, 40)
    y = rng.normal() * 1e4 + rng.normal() * 1e3 * x + rng.standard_normal(40) * 100.0
    found, other = fit_line(x, y), stats.linregress(x, y)
    assert found["slope"].value == pytest.approx(other.slope, rel=1e-9)
    assert found["intercept"].value == pytest.approx(other.intercept, rel=1e-7)
    assert found["slope"].error == pytest.approx(other.stderr, rel=1e-7)
    assert found["intercept"].error == pytest.approx(other.intercept_stderr, rel=1e-7)
    assert found.determination == pytest.approx(other.rvalue**2, rel=1e-9)
    reach = stats.t.ppf(0.975, 38) * other.stderr
    assert (found["slope"].low, found["slope"].high) == pytest.approx(
        (other.slope - reach, other.slope + reach), rel=1e-7
    )
    gap = np.where(np.arange(40) == 3, np.nan, y)
    assert fit_line(x, gap)["slope"].value == pytest.approx(stats.linregress(np.delete(x, 3), np.delete(y, 3)).slope)
    zero = fit_line(x, y, through_origin=True)
    assert zero["slope"].value == pytest.approx(float(x @ y / (x @ x)), rel=1e-9)
    assert zero.predict(2.0) == pytest.approx(2.0 * zero["slope"].value)


@pytest.mark.parametrize("seed", range(5))
def test_power_and_cosine_are_those_of_curve_fit(seed):
    rng = np.random.default_rng([seed, 2])
    factor, exponent = 10.0 ** rng.uniform(-2, 5), rng.uniform(0.5, 3.0)
    x, angle = rng.uniform(0.3, 3.0, 60), rng.uniform(0.0, 1.3, 60)
    for fit, base, at in ((fit_power, x, x), (fit_cosine, np.cos(angle), angle)):
        y = factor * base**exponent * (1.0 + 0.1 * rng.standard_normal(60))
        found = fit(at, y)

        def relation(_x, c, n, base=base):
            return c * factor * base**n

        other, covariance = curve_fit(relation, at, y, p0=(1.0, exponent))
        assert found["factor"].value / factor == pytest.approx(other[0], rel=1e-5)
        assert found["exponent"].value == pytest.approx(other[1], rel=1e-5)
        assert found["exponent"].error == pytest.approx(math.sqrt(covariance[1, 1]), rel=1e-3)
        assert found["factor"].error / factor == pytest.approx(math.sqrt(covariance[0, 0]), rel=1e-3)
        assert found.predict(at) + found.residual == pytest.approx(y, rel=1e-9)


@pytest.mark.slow
def test_bounds_hold_the_truth_as_often_as_they_say():
    """Binomial: 95 % of 300 trials, below 91 % once in a thousand."""
    rng = np.random.default_rng(4)
    held = np.zeros(3)
    for _ in range(300):
        x = rng.uniform(0.5, 3.0, 30)
        angle = rng.uniform(0.0, 1.3, 30)
        noise = 0.1 * rng.standard_normal((3, 30))
        held += [
            fit_line(x, 2.0 * x + 1.0 + noise[0])["slope"].holds(2.0),
            fit_power(x, 2.0 * x**1.5 + noise[1])["exponent"].holds(1.5),
            fit_cosine(angle, np.cos(angle) ** 2 + noise[2])["exponent"].holds(2.0),
        ]
    assert np.all(held / 300.0 > 0.91)


@pytest.mark.parametrize("seed", range(3))
def test_correlation_is_that_of_scipy(seed):
    rng = np.random.default_rng(seed)
    x = rng.standard_normal(50)
    y = rng.uniform(-1, 1) * x + rng.standard_normal(50)
    found, other = correlation(x, y), stats.pearsonr(x, y)
    assert found.value == pytest.approx(other.statistic, rel=1e-9)
    bounds = other.confidence_interval(0.95)
    assert (found.low, found.high) == pytest.approx((bounds.low, bounds.high), rel=1e-7)
    assert correlation(x, 3.0 * x + 1.0).value == pytest.approx(1.0)


def test_ratio_of_types_survives_scatter_on_both_sides():
    rng = np.random.default_rng(6)
    slopes, ratios, held = [], [], 0
    for _ in range(200):
        true = rng.uniform(2.0, 10.0, 60)
        reference = true * (1.0 + 0.3 * rng.standard_normal(60))
        other = 0.7 * true * (1.0 + 0.3 * rng.standard_normal(60))
        line, ratio = type_ratio(reference, other)
        slopes.append(line["slope"].value)
        ratios.append(ratio.value)
        held += ratio.holds(0.7)
    assert np.mean(ratios) == pytest.approx(0.7, rel=0.01)
    # the slope loses the share of the scatter in the squares of the reference
    assert np.mean(slopes) == pytest.approx(0.7 / 1.09, rel=0.02)
    assert held > 182


def test_classes_tell_which_directions_leave_the_line():
    rng = np.random.default_rng(7)
    x, angle = rng.uniform(0.5, 3.0, 120), rng.uniform(0.0, 1.5, 120)
    y = 2.0 * x * (1.0 + 0.05 * rng.standard_normal(120)) + np.where(angle < 0.5, 0.5 * x, 0.0)
    common, classes = fit_by_direction(x, y, angle, [0.0, 0.5, 1.0, 1.5])
    assert 2.0 < common["slope"].value < 2.5
    assert [item.count for item in classes] == [int(((angle >= a) & (angle < a + 0.5)).sum()) for a in (0.0, 0.5, 1.0)]
    assert classes[0].leaves_the_line and classes[0].departure.low > 0.0
    assert classes[1].departure.high < 0.0
    assert classes[0].fit["slope"].value == pytest.approx(2.5, rel=0.02)
    alone = fit_by_direction(x, 2.0 * x + 0.01 * rng.standard_normal(120), angle, [0.0, 0.75, 1.5])[1]
    assert not any(item.leaves_the_line for item in alone)
    few = fit_by_direction(x, y, angle, [0.0, 1e-9, 1.5])[1][0]
    assert few.fit is None and not few.leaves_the_line


def test_draws_give_the_error_of_the_mean():
    rng = np.random.default_rng(8)
    values = rng.standard_normal(400)
    found = resampled(np.mean, values, resamples=2000, seed=1)
    assert found.value == pytest.approx(values.mean())
    assert found.error == pytest.approx(values.std() / 20.0, rel=0.06)
    assert found.low < found.value < found.high


@pytest.mark.parametrize(
    ("call", "word"),
    [
        (lambda: fit_line([1.0, 2.0], [1.0, 2.0]), "at least 3"),
        (lambda: fit_line([1.0, 1.0, 1.0], [1.0, 2.0, 3.0]), "differ"),
        (lambda: fit_line([1.0, 2.0, 3.0], [1.0, 2.0]), "equal lists"),
        (lambda: fit_power([0.0, 1.0, 2.0], [1.0, 2.0, 3.0]), "greater than 0"),
        (lambda: fit_cosine([0.0, 1.0, 1.7], [1.0, 2.0, 3.0]), "90 degrees"),
        (lambda: fit_cosine([0.5, 0.5, 0.5], [1.0, 2.0, 3.0]), "vary"),
        (lambda: correlation([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]), "at least 4"),
        (lambda: correlation([1.0, 1.0, 1.0, 1.0], [1.0, 2.0, 3.0, 4.0]), "vary"),
        (lambda: fit_by_direction([1.0], [1.0], [1.0], [1.0, 0.0]), "increasing"),
        (lambda: fit_line([1.0, 2.0, 4.0], [1.0, 2.0, 3.0], confidence=1.5), "confidence"),
        (lambda: resampled(np.mean, [1.0, 2.0]), "3 or more"),
    ],
)
def test_bad_input_is_refused(call, word):
    with pytest.raises(InputError, match=word):
        call()
