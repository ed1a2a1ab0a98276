"""Long-term extremes, contours and joint distributions of sea states whose answers are known."""

import math

import numpy as np
import pytest
from scipy import stats

from moyai.core.errors import InputError
from moyai.design.long_term import (
    YEAR,
    JointSea,
    environmental_contour,
    fit_joint_sea,
    long_term_exceedance,
    reliability_index,
    return_level,
)
from moyai.series.extremes import fit


def test_the_long_term_of_one_sea_state_is_its_short_term():
    def exceeds(level):
        return 1.0 - np.exp(-1000.0 * np.exp(-(level**2) / 2.0))

    years = 100.0
    found = return_level(years, [1.0], [exceeds], 10800.0, (1.0, 20.0))
    states = years * YEAR / 10800.0
    exact = math.sqrt(2.0 * math.log(1000.0 * states))
    assert found == pytest.approx(exact, rel=1e-9)


def test_the_long_term_of_two_sea_states_is_governed_by_the_worse():
    def calm(level):
        return np.exp(-level)

    def storm(level):
        return np.exp(-level / 3.0)

    rate = long_term_exceedance([40.0], [0.99, 0.01], [calm, storm], 10800.0)[0]
    assert rate == pytest.approx(YEAR / 10800.0 * (0.99 * math.exp(-40.0) + 0.01 * math.exp(-40.0 / 3.0)), rel=1e-5)


def test_probabilities_that_do_not_sum_are_refused():
    with pytest.raises(InputError, match="sum to"):
        long_term_exceedance([1.0], [0.5, 0.4], [np.exp, np.exp], 10800.0)


def test_the_top_of_the_contour_is_the_marginal_return_value_and_its_inside_holds_the_right_share():
    rng = np.random.default_rng(6)
    sea = JointSea(fit(rng.weibull(1.4, 5000) * 1.2 + 0.1, "weibull", location=0.1), (0.7, 0.9, 0.3), (0.05, 0.2, -0.4))
    height, period = environmental_contour(sea, 50.0, 10800.0, count=720)
    assert height.max() == pytest.approx(float(sea.height.level(10800.0 / (50.0 * YEAR))), rel=1e-6)
    assert np.isfinite(period).all() and (period > 0).all()
    # A half plane that touches the contour is exceeded with the probability of the return period: one sea state in
    # N falls beyond the tangent at the top
    assert reliability_index(50.0, 10800.0) == pytest.approx(-stats.norm.ppf(10800.0 / (50 * YEAR)), rel=1e-9)


def test_the_joint_distribution_is_recovered_from_its_own_samples():
    rng = np.random.default_rng(12)
    n = 40000
    h = 0.2 + 1.5 * rng.weibull(1.5, n)
    t = np.exp(0.8 + 0.9 * h**0.35 + (0.06 + 0.25 * np.exp(-0.5 * h)) * rng.standard_normal(n))
    sea = fit_joint_sea(h, t, lower_end=0.2, classes=25)
    assert sea.height.shape == pytest.approx(1.5, rel=0.03) and sea.height.scale == pytest.approx(1.5, rel=0.03)
    for height in (0.6, 1.5, 3.0, 4.5):
        assert float(sea.period(height, 0.0)) == pytest.approx(math.exp(0.8 + 0.9 * height**0.35), rel=0.02)
