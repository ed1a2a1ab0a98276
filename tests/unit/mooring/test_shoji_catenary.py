"""Shoji's modified catenary equals the exact solver wherever part of the line lies on the bed."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from moyai.core.errors import InputError
from moyai.mooring import kernels
from moyai.mooring.catenary import solve_catenary
from moyai.mooring.shoji import solve_shoji


def printed_height(tension: float, distance: float, length: float, axial_stiffness: float, weight: float) -> float:
    """Height of the fairlead [m] by Shoji's equation as printed."""
    scale = tension / weight
    angle = distance / scale - weight * length / axial_stiffness
    return scale * (math.cosh(angle) - 1.0) + tension * scale / (2.0 * axial_stiffness) * math.sinh(angle) ** 2


@pytest.mark.parametrize("seed", range(40))
def test_equals_the_exact_catenary_while_grounded(seed: int) -> None:
    rng = np.random.default_rng(seed)
    length, weight = rng.uniform(5.0, 500.0), 10.0 ** rng.uniform(-1, 4)
    axial = weight * length * 10.0 ** rng.uniform(0, 7)
    height = length * rng.uniform(0.02, 0.6)
    distance = length - height * rng.uniform(0.2, 0.98)
    exact = solve_catenary(distance, height, length, axial, weight)
    if exact.regime != kernels.GROUNDED:
        with pytest.raises(InputError):
            solve_shoji(distance, height, length, axial, weight)
        return
    shoji = solve_shoji(distance, height, length, axial, weight)
    assert shoji.horizontal_tension == pytest.approx(float(exact.horizontal_tension), rel=1e-9)
    assert shoji.vertical_tension == pytest.approx(float(exact.vertical_tension_fairlead), rel=1e-9)
    assert length - shoji.suspended_length == pytest.approx(float(exact.grounded_length), abs=1e-9 * length)
    printed = printed_height(shoji.horizontal_tension, shoji.reduced_distance, length, axial, weight)
    assert printed == pytest.approx(height, rel=1e-9)


def test_the_literal_reading_is_something_else() -> None:
    """Whole distance and whole length without the closure overrate the tension more than fourfold."""
    literal = brentq(lambda t: printed_height(t, 1.925, 1.975, 2.14e4, 1.122) - 0.267, 1.0, 100.0)
    assert literal == pytest.approx(7.83, abs=0.005)
    assert literal > 4.0 * solve_shoji(1.925, 0.267, 1.975, 2.14e4, 1.122).horizontal_tension


@pytest.mark.parametrize(
    "arguments", [(1.0, 0.267, 1.975, 2e4, 1.1), (1.97, 0.267, 1.975, 2e4, 1.1), (1.9, -0.2, 2.0, 1e4, 1.0)]
)
def test_outside_its_range_it_says_so(arguments: tuple[float, ...]) -> None:
    with pytest.raises(InputError):
        solve_shoji(*arguments)
