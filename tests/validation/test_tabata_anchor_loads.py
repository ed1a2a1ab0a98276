"""Tabata et al. (about 2000): squared velocity and energy model of anchor loads, worked examples computed elsewhere."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.sea.water import Water
from moyai.structures.curtain.seas.anchor_energy import EnergyModel, calibrate, product_needed
from moyai.structures.curtain.seas.squared_velocity import (
    effective_height,
    mean_squared_velocity,
    squared_velocity,
    surface_speed,
)

WATER = Water(20.0, 1025.0, 9.81)
STIFFNESS = 890e3
# T, beta, H, u_max, U_max, M m_B for 14.7 kN, m_B at M = 0.2, Tu [kN] of 518 kg at M = 0.2
WORKED = [
    (6, 0, 5.508, 2.945, 6.089, 6.55, 32.7, 58.5),
    (7, 0, 5.508, 2.627, 5.455, 8.16, 40.8, 52.4),
    (8, 0, 5.508, 2.434, 5.068, 9.45, 47.3, 48.7),
    (7, 45, 2.754, 1.314, 2.827, 30.4, 152, 27.2),
    (6, 60, 1.377, 0.736, 1.672, 86.8, 434, 16.1),
    (7, 60, 1.377, 0.657, 1.514, 106.0, 530, 14.5),
    (8, 60, 1.377, 0.609, 1.417, 120.9, 605, 13.6),
    (7, 70, 0.644, 0.307, 0.815, 366, 1829, 7.8),
]


def test_squared_velocity_values() -> None:
    assert float(squared_velocity(5.508, 7.0, 0.2, 5.0, WATER)) == pytest.approx(5.6471736, abs=5e-8)
    assert float(mean_squared_velocity(5.508, 7.0, 0.2, 5.0, WATER)) == pytest.approx(2.4109, abs=5e-5)
    assert float(squared_velocity(2.0, 7.0, 0.0, 5.0, WATER)) == pytest.approx(0.6251950, abs=5e-8)
    assert float(mean_squared_velocity(2.0, 7.0, 0.0, 5.0, WATER)) == pytest.approx(0.3125975, abs=5e-8)


@pytest.mark.parametrize("row", WORKED, ids=str)
def test_worked_example(row: tuple[float, ...]) -> None:
    period, angle, height, u_max, speed_max, product, mass, tension = row
    model = EnergyModel(0.2, 518.0, STIFFNESS, 2.0, 1.0, 1.0)
    acting = effective_height(3.06, math.radians(angle), "paper", 1.8)
    speed = float(model.float_speed(acting, period, 0.2, WATER))
    needed = float(product_needed(14.7e3, speed, 0.0)) / STIFFNESS
    assert float(acting) == pytest.approx(height, abs=6e-4)
    assert float(surface_speed(acting, period, WATER)) == pytest.approx(u_max, abs=6e-4)
    assert speed == pytest.approx(speed_max, abs=6e-4)
    # three digits are printed
    assert needed == pytest.approx(product, rel=2e-3)
    assert needed / 0.2 == pytest.approx(mass, rel=2e-3)
    assert float(model.fluctuating_tension(speed, 0.0)) / 1e3 == pytest.approx(tension, abs=0.06)


def test_pretension_raises_the_factor() -> None:
    """Steady 13.7 kN and fluctuating 14.7 kN: 2.864 times the product, M = 0.2 becomes 0.573."""
    ratio = float(product_needed(14.7e3, 2.0, 13.7e3) / product_needed(14.7e3, 2.0, 0.0))
    assert ratio == pytest.approx(2.864, abs=5e-4)
    assert 0.2 * ratio == pytest.approx(0.573, abs=5e-4)


def test_larger_reading_of_the_tension() -> None:
    """If 14.7 kN is the mean of the highest tenth, the largest is 25.0 kN and the product 2.89 times larger."""
    assert float(product_needed(25.0e3, 1.5, 0.0) / product_needed(14.7e3, 1.5, 0.0)) == pytest.approx(2.89, abs=5e-3)


def test_tension_is_linear_in_height_and_follows_the_directions() -> None:
    """Result 1 (linear in H at fixed period without current) and 3 (cos^2) of the paper, from the energy model."""
    model = EnergyModel(0.2, 518.0, STIFFNESS, 2.0, 0.6, 1.0)
    heights = np.array([0.5, 1.0, 2.0, 3.0])
    tension = model.fluctuating_tension(model.float_speed(heights, 6.0, 0.0, WATER), 0.0)
    np.testing.assert_allclose(tension / heights, tension[0] / heights[0], rtol=1e-12)
    angle = np.radians([0.0, 30.0, 60.0, 80.0])
    acting = effective_height(3.0, angle, "paper", 1.8)
    turned = model.fluctuating_tension(model.float_speed(acting, 6.0, 0.0, WATER), 0.0)
    np.testing.assert_allclose(turned / turned[0], np.cos(angle) ** 2, rtol=1e-12)
    squared = squared_velocity(effective_height(3.0, angle, "normal", 1.8), 6.0, 0.0, 5.0, WATER)
    np.testing.assert_allclose(squared / squared[0], np.cos(angle) ** 2, rtol=1e-12)


@pytest.mark.parametrize("planted", [0.2, 0.5])
def test_planted_factor_is_recovered(planted: float) -> None:
    """Result 6: M = 0.2 of the field and 0.5 of the flume, from tensions with 15 % scatter, within 2 %."""
    rng = np.random.default_rng(int(planted * 100))
    model = EnergyModel(planted, 518.0, STIFFNESS, 2.0, 0.6, 1.0)
    heights, periods = rng.uniform(0.5, 5.0, 2000), rng.uniform(5.0, 8.0, 2000)
    speed = model.float_speed(heights, periods, rng.uniform(0, 0.2, 2000), WATER)
    observed = model.fluctuating_tension(speed, 0.0) * (1.0 + 0.15 * rng.standard_normal(2000))
    fit = calibrate(observed, speed, 0.0, line_factor=0.6)
    assert fit.energy_factor(518.0, STIFFNESS) == pytest.approx(planted, rel=0.02)


def test_wire_carries_six_tenths_of_the_rope() -> None:
    rope = EnergyModel(0.2, 518.0, STIFFNESS, 2.0, 1.0, 1.0)
    wire = EnergyModel(0.2, 518.0, STIFFNESS, 2.0, 0.6, 0.7)
    assert float(wire.tension(2.0, 0.0) / rope.tension(2.0, 0.0)) == pytest.approx(0.42, rel=1e-12)
