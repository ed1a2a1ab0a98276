"""Squared velocity by quadrature and in its limits; energy model and its calibration at random inputs."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.regular import RegularWave
from moyai.sea.water import Water
from moyai.structures.curtain.seas.anchor_energy import (
    FITTING_RULES,
    EnergyModel,
    calibrate,
    check_energy_model,
    error_against_product,
    product_needed,
)
from moyai.structures.curtain.seas.squared_velocity import (
    check_direction_rule,
    check_squared_velocity,
    effective_height,
    fit_proportional,
    mean_squared_velocity,
    squared_velocity,
    surface_speed,
)

GRAVITY = 9.81


def test_squared_velocity_is_the_depth_mean_under_the_crest() -> None:
    """Gauss-Legendre quadrature of cosh k(z+h)/sinh kh at random heights, depths and periods."""
    rng = np.random.default_rng(21)
    points, weights = np.polynomial.legendre.leggauss(200)
    for _ in range(300):
        water = Water(10.0 ** rng.uniform(-1, 2.5), 1025.0, GRAVITY)
        d = water.depth * rng.uniform(0.01, 1.0)
        height, period, current = rng.uniform(0.0, 3.0), 10.0 ** rng.uniform(0, 1.5), rng.uniform(-1, 1)
        wave = RegularWave(height, period, 0.0, water)
        k = wave.wave_number
        z = -0.5 * d * (1.0 + points)
        ratio = np.exp(k * z) * (1.0 + np.exp(-2.0 * k * (z + water.depth))) / -np.expm1(-2.0 * k * water.depth)
        crest = 0.5 * height * wave.omega * ratio
        found = float(squared_velocity(height, period, current, d, water))
        assert found == pytest.approx(0.5 * float(weights @ (crest + current) ** 2), rel=1e-10, abs=1e-14)
        phase = np.cos(2.0 * np.pi * np.arange(64) / 64)
        mean = np.mean([0.5 * weights @ (crest * c + current) ** 2 for c in phase])
        assert float(mean_squared_velocity(height, period, current, d, water)) == pytest.approx(mean, rel=1e-10)


def test_limits_of_the_squared_velocity() -> None:
    long = squared_velocity(1.0, 1e5, 0.0, 5.0, Water(10.0, 1025.0, GRAVITY))
    assert float(long) == pytest.approx(GRAVITY / 40.0, rel=1e-6)
    deep = Water(math.inf, 1025.0, GRAVITY)
    assert float(squared_velocity(2.0, 6.0, 0.0, 1e-7, deep)) == pytest.approx((math.pi * 2.0 / 6.0) ** 2, rel=1e-6)
    for d in (0.5, 5.0, 50.0):
        nearly = squared_velocity(2.0, 6.0, 0.3, d, Water(5e4, 1025.0, GRAVITY))
        assert float(nearly) == pytest.approx(float(squared_velocity(2.0, 6.0, 0.3, d, deep)), rel=1e-12)
    # kh of several thousand: nothing overflows
    assert np.isfinite(squared_velocity(0.01, 0.2, 0.1, 3.0, Water(500.0, 1025.0, GRAVITY)))
    assert float(surface_speed(2.0, 7.0, deep)) == pytest.approx(math.pi * 2.0 / 7.0, rel=1e-12)


def model(product: float = 1e8) -> EnergyModel:
    return EnergyModel(0.2, product / (0.2 * 890e3), 890e3, 2.0, 1.0, 1.0)


def test_energy_is_kept() -> None:
    rng = np.random.default_rng(31)
    speed, steady, product = rng.uniform(0, 5, 500), 10.0 ** rng.uniform(-3, 6, 500), 10.0 ** rng.uniform(3, 9, 500)
    for u, t, p in zip(speed, steady, product):
        rise = float(model(p).fluctuating_tension(u, t))
        assert rise * (rise + 2.0 * t) == pytest.approx(p * u * u, rel=1e-12)
        if u > 0.01:
            assert float(product_needed(rise, u, t)) == pytest.approx(p, rel=1e-12)
    assert float(model().fluctuating_tension(-1.0, 100.0)) == 0.0
    assert float(model().tension(0.0, 0.0)) == 0.0


def test_every_rule_recovers_exact_data() -> None:
    rng = np.random.default_rng(41)
    speed, steady = rng.uniform(0.5, 4, 40), rng.uniform(0, 2e4, 40)
    observed = 0.6 * model(3e8).fluctuating_tension(speed, steady)
    for rule in FITTING_RULES:
        fit = calibrate(observed, speed, steady, line_factor=0.6, rule=rule)
        assert fit.product == pytest.approx(3e8, rel=1e-12)
        assert np.max(np.abs(fit.residual)) < 1e-12
        assert fit.standard_error < 1e-6 * fit.product


def test_rules_have_the_properties_they_are_named_for() -> None:
    rng = np.random.default_rng(43)
    speed = rng.uniform(0.5, 4, 60)
    observed = model(3e8).fluctuating_tension(speed, 0.0) * np.exp(0.3 * rng.standard_normal(60))
    fits = {rule: calibrate(observed, speed, 0.0, line_factor=1.0, rule=rule) for rule in FITTING_RULES}
    assert abs(fits["mean_zero"].mean_error) < 1e-12
    least = fits["least_relative_error"]
    for factor in (0.98, 1.02):
        _, deviation = error_against_product(observed, speed, np.array([least.product * factor]))
        assert deviation[0] > least.error_deviation
    squares = fits["least_squares"]
    assert float(np.sum((squares.calculated - observed) * speed)) == pytest.approx(0.0, abs=1e-6 * np.sum(observed))
    variation = np.var(observed / speed) / np.mean(observed / speed) ** 2
    assert least.product / fits["mean_zero"].product == pytest.approx((1.0 + variation) ** 2, rel=1e-12)


def test_interval_holds_the_truth_as_often_as_it_says() -> None:
    """Of 1000 campaigns of 25 observations with scatter, 93 to 97 % hold the planted product."""
    rng = np.random.default_rng(44)
    held = 0
    for _ in range(1000):
        speed = rng.uniform(0.5, 4, 25)
        observed = np.sqrt(3e8) * speed * (1.0 + 0.2 * rng.standard_normal(25))
        low, high = calibrate(observed, speed, 0.0, line_factor=1.0).interval
        held += low <= 3e8 <= high
    assert 930 <= held <= 970


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: EnergyModel(0.2, 0.0, 1.0, 2.0, 1.0, 1.0), "no value follows"),
        (lambda: EnergyModel(0.2, math.nan, 1.0, 2.0, 1.0, 1.0), "float_mass"),
        (lambda: effective_height(1.0, 1.7, "paper", 1.8), "90 degrees"),
        (lambda: effective_height(1.0, 0.0, "cosine", 1.8), "not a known word"),
        (lambda: squared_velocity(1.0, 6.0, 0.0, 30.0, Water(20.0, 1025.0, GRAVITY)), "curtain depth"),
        (lambda: squared_velocity(1.0, 0.0, 0.0, 3.0, Water(20.0, 1025.0, GRAVITY)), "period"),
        (lambda: calibrate([1.0, 2.0], [1.0, 1.0], 0.0, line_factor=1.0), "at least 3"),
        (lambda: calibrate([1.0, -2.0, 3.0], [1.0, 1.0, 1.0], 0.0, line_factor=1.0), "row 2"),
        (lambda: model().fluctuating_tension(1.0, -5.0), "pretension"),
    ],
)
def test_refusals_of_the_energy_model(call, words) -> None:
    with pytest.raises(InputError, match=words):
        call()


def test_notices_of_the_energy_model() -> None:
    water = Water(20.0, 1025.0, GRAVITY)
    assert check_squared_velocity(2.0, 7.0, 0.2, water) == ()
    assert check_squared_velocity(9.0, 5.0, 0.2, water)[0].severity == "error"
    assert check_squared_velocity(0.2, 7.0, -1.0, water)[0].code == "curtain-opposing-current"
    assert check_energy_model(EnergyModel(0.2, 518.0, 890e3, 2.0, 1.0, 1.0), 7.0) == ()
    slow = check_energy_model(EnergyModel(1.5, 518.0, 1e3, 2.0, 1.0, 1.0), 7.0)
    assert {notice.code for notice in slow} == {"curtain-energy-response", "curtain-energy-factor"}


def test_proportional_fit() -> None:
    """Result 4 of the field paper: slope, its error and R^2 against numpy's least squares and planted scatter."""
    rng = np.random.default_rng(61)
    inside = 0
    for _ in range(400):
        x = rng.uniform(0.1, 5.0, 40)
        y = 2.5e3 * x + 600.0 * rng.standard_normal(40)
        fit = fit_proportional(x, y)
        inside += abs(fit.factor - 2.5e3) < 2.023 * fit.standard_error
    slope, left, *_ = np.linalg.lstsq(x[:, None], y, rcond=None)
    assert fit.factor == pytest.approx(slope[0], rel=1e-12)
    assert fit.determination == pytest.approx(1.0 - left[0] / np.sum((y - y.mean()) ** 2), rel=1e-12)
    # Student's 95 % for 39 degrees of freedom
    assert 365 <= inside <= 395
    assert fit_proportional(x, 3.0 * x).determination == pytest.approx(1.0, rel=1e-14)
    with pytest.raises(InputError, match="at least 3"):
        fit_proportional([1.0, 2.0], [1.0, 2.0])


def test_direction_rule_that_contradicts_the_paper_is_named() -> None:
    assert check_direction_rule("normal", "squared_velocity") == ()
    assert check_direction_rule("paper", "energy") == ()
    assert check_direction_rule("paper", "squared_velocity")[0].value == 4.0
    assert "'paper'" in check_direction_rule("none", "energy")[0].remedy


def test_squared_velocity_refuses_negative_heights() -> None:
    with pytest.raises(InputError, match="height is -1"):
        squared_velocity([1.0, -1.0], 5.0, 0.0, 3.0, Water(10.0, 1025.0, 9.81))
