"""The largest value of storms alike against drawn peaks, and what one realisation proves."""

import math

import numpy as np
import pytest

from moyai.series.realisations import alone, seeds, storms


def test_storms_hold_nine_of_ten_drawn_maxima():
    """Amplitudes drawn by Rayleigh's law, the largest of 1000 in each of 4000 storms."""
    count, deviation, mean = 1000, 0.2, 0.5
    drawn = np.random.default_rng(2).rayleigh(deviation, size=(4000, count)).max(axis=1) + mean
    factor = math.sqrt(2.0 * math.log(count))
    band = storms(mean + factor * deviation, mean, factor)
    assert np.mean((drawn >= band.low) & (drawn <= band.high)) == pytest.approx(0.90, abs=0.015)
    assert np.mean(drawn < band.low) == pytest.approx(0.05, abs=0.012)
    assert not band.decides
    # the mean of the largest; drawn, its error is 0.2 % of the part that varies
    assert band.judged[1] - mean == pytest.approx(drawn.mean() - mean, rel=5e-3)


def test_a_mean_alone_has_no_band():
    assert storms(1.0, 1.0, math.nan) is None and storms(1.0, 1.0, 0.0) is None
    band = storms(1.0, 1.0, 3.0)
    assert band.low == band.high == 1.0


def test_one_realisation_is_a_bound_and_two_a_band():
    assert alone(np.array([3.0])) == "at least" and alone(np.array([3.0, 4.0])) == ""
    assert seeds(np.array([3.0])) is None
    band = seeds(np.array([3.0, 4.0]))
    # Student's quantile of one degree of freedom, and Johnson's term for the skewness of Gumbel's law
    quantile = math.tan(0.45 * math.pi)
    skewed = quantile + 1.1395 / (6.0 * math.sqrt(2.0)) * (1.0 + 2.0 * quantile**2)
    assert band.judged[1] == pytest.approx(3.5 + skewed * 0.5)
