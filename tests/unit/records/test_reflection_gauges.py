"""Incident and reflected waves of synthetic records, for any number and place of gauges."""

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.survey.reflection import separate_waves


def goda_suzuki(positions, amplitudes, k):
    """Incident and reflected amplitudes at x = 0 of two gauges in closed form."""
    (x1, x2), (first, second) = positions, np.moveaxis(amplitudes, -1, 0)
    denominator = 2j * np.sin(k * (x2 - x1))
    incident = (second * np.exp(-1j * k * x1) - first * np.exp(-1j * k * x2)) / denominator
    return incident, (first * np.exp(1j * k * x2) - second * np.exp(1j * k * x1)) / denominator


def gauges(x, incident, reflected, k):
    phase = np.exp(1j * np.multiply.outer(k, x))
    return incident[:, None] * phase + reflected[:, None] / phase


@pytest.mark.parametrize("count", [2, 3, 4, 7])
@pytest.mark.parametrize("seed", range(4))
def test_two_waves_are_found_exactly(count, seed):
    rng = np.random.default_rng(10 * seed + count)
    k = rng.uniform(0.5, 8.0, 5)
    x = rng.uniform(-20.0, 20.0) + np.cumsum(rng.uniform(0.05, 0.2, count))
    incident, reflected = rng.normal(size=(2, 5)) + 1j * rng.normal(size=(2, 5))
    result = separate_waves(x, gauges(x, incident, reflected, k), k)
    limit = 1e-12 * np.max(result.condition)
    np.testing.assert_allclose(result.incident, incident, atol=10 * limit)
    np.testing.assert_allclose(result.reflected, reflected, atol=10 * limit)
    assert np.all(result.residual < 1e-12)


def test_least_squares_of_two_gauges_is_goda_suzuki():
    rng = np.random.default_rng(1)
    for _ in range(20):
        x, k = np.sort(rng.normal(size=2)) * 3.0, rng.uniform(0.3, 5.0, 4)
        values = rng.normal(size=(4, 2)) + 1j * rng.normal(size=(4, 2))
        result = separate_waves(x, values, k)
        incident, reflected = goda_suzuki(x, values, k)
        np.testing.assert_allclose(result.incident, incident, rtol=1e-9 * np.max(result.condition))
        np.testing.assert_allclose(result.reflected, reflected, rtol=1e-9 * np.max(result.condition))


def test_three_gauges_are_mansard_funke():
    """Their closed form (their section 4, equal weights) written with distances from the first gauge."""
    rng = np.random.default_rng(2)
    for _ in range(20):
        distance = np.r_[0.0, np.cumsum(rng.uniform(0.1, 0.5, 2))]
        k = rng.uniform(0.8, 3.0)
        values = rng.normal(size=3) + 1j * rng.normal(size=3)
        plus, minus = np.sum(np.exp(2j * k * distance)), np.sum(np.exp(-2j * k * distance))
        determinant = plus * minus - 9.0
        first, second = np.sum(values * np.exp(1j * k * distance)), np.sum(values * np.exp(-1j * k * distance))
        incident = (minus * first - 3.0 * second) / determinant
        reflected = (plus * second - 3.0 * first) / determinant
        result = separate_waves(distance, values, k)
        np.testing.assert_allclose(result.incident[0], incident, rtol=1e-8)
        np.testing.assert_allclose(result.reflected[0], reflected, rtol=1e-8)


def test_condition_is_that_of_the_matrix_and_bad_spacing_is_reported():
    rng = np.random.default_rng(3)
    x = np.array([0.0, 0.25, 0.6])
    for k in rng.uniform(0.2, 12.0, 20):
        design = np.column_stack([np.exp(1j * k * x), np.exp(-1j * k * x)])
        assert separate_waves(x, np.ones(3), k).condition[0] == pytest.approx(np.linalg.cond(design), rel=1e-8)
    half_wave = separate_waves([0.0, 0.51], [1.0, -1.0], np.pi / 0.5)
    assert [notice.code for notice in half_wave.notices] == ["gauge-spacing"]
    assert separate_waves([0.0, 0.25], [1.0, -1.0], np.pi / 0.5).notices == ()


def test_standard_error_is_that_of_repeated_noise():
    rng = np.random.default_rng(4)
    x, k = np.array([0.0, 0.3, 0.8, 1.1]), np.full(4000, 2.1)
    incident, reflected = np.full(4000, 1.0 + 0.2j), np.full(4000, 0.4 - 0.3j)
    noise = 0.01 * (rng.normal(size=(4000, 4)) + 1j * rng.normal(size=(4000, 4)))
    result = separate_waves(x, gauges(x, incident, reflected, k) + noise, k)
    scatter = np.sqrt(np.mean(np.abs(result.incident - incident) ** 2))
    reported = np.sqrt(np.mean(result.standard_error[:, 0] ** 2))
    assert reported == pytest.approx(scatter, rel=0.05)
    assert np.isnan(separate_waves(x[:2], [1.0, 1.0], 2.1).standard_error).all()


@pytest.mark.parametrize(
    ("positions", "amplitudes", "k"),
    [
        ([1.0], [1.0], 1.0),
        ([1.0, 1.0], [1.0, 1.0], 1.0),
        ([0.0, 1.0], [1.0, np.nan], 1.0),
        ([0.0, 1.0], [1.0, 1.0], 0.0),
    ],
)
def test_refusals(positions, amplitudes, k):
    with pytest.raises(InputError):
        separate_waves(positions, amplitudes, k)
