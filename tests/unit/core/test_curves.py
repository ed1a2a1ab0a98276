"""Splines and crossings of the package against those of scipy."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.interpolate import CubicSpline, make_interp_spline
from scipy.optimize import brentq

from moyai.core.curves import Spline, crossing, in_pieces


def points(count: int) -> tuple[np.ndarray, np.ndarray]:
    """Return uneven places and complex values of shape (count, 2, 3)."""
    draw = np.random.default_rng(count)
    x = np.linspace(0.1, 3.0, count) + 0.3 / count * draw.uniform(-1.0, 1.0, count)
    return x, draw.normal(size=(count, 2, 3)) + 1j * draw.normal(size=(count, 2, 3))


@pytest.mark.parametrize("count", [6, 7, 8, 9, 40, 300])
@pytest.mark.parametrize("degree", [3, 5])
def test_values_and_derivatives_are_those_of_scipy(degree: int, count: int) -> None:
    x, y = points(count)
    at = np.linspace(x[0] - 0.01, x[-1] + 0.01, 57)
    spline, other = Spline(x, y, degree), make_interp_spline(x, y, k=degree)
    for order in range(degree + 1):
        expected = other(at, order)
        assert np.abs(spline(at, order) - expected).max() < 1e-12 * np.abs(expected).max()


@pytest.mark.parametrize("count", [2, 3, 4])
def test_few_points_give_their_polynomial(count: int) -> None:
    x, y = points(count)
    at = np.linspace(x[0], x[-1], 11)
    assert np.allclose(Spline(x, y)(at), CubicSpline(x, y)(at), rtol=0.0, atol=1e-13)
    assert Spline(x, y)(float(x[1])).shape == (2, 3)


@pytest.mark.parametrize(
    ("function", "low", "high"),
    [
        (lambda v: math.cos(v) - v, 0.0, 1.0),
        (lambda v: math.exp(-50.0 * v) - 0.5, 0.0, 8.0),
        (lambda v: math.tanh(400.0 * (v - 0.111)), 0.0, 1.0),
        (lambda v: 1.0 - v**3, -5.0, 90.0),
    ],
)
def test_crossings_are_those_of_scipy_in_as_many_steps(function: object, low: float, high: float) -> None:
    assert callable(function)
    calls = 0

    def counted(value: float) -> float:
        nonlocal calls
        calls += 1
        return float(function(value))

    found, own = crossing(counted, low, high, tolerance=1e-13), calls
    calls = 0
    assert found == pytest.approx(brentq(counted, low, high, xtol=1e-13, rtol=1e-13), abs=1e-12)
    assert own <= 2 * calls


def test_a_jump_is_a_crossing() -> None:
    assert crossing(lambda v: -1.0 if v < 0.7 else 1.0, 0.0, 1.0, tolerance=1e-12) == pytest.approx(0.7, abs=1e-12)


def test_a_root_at_an_end_is_that_end() -> None:
    assert crossing(lambda v: 1.0 - v, 0.0, 1.0, tolerance=1e-14) == 1.0
    assert crossing(lambda v: v, 0.0, 1.0, tolerance=1e-14) == 0.0


@pytest.mark.parametrize("function", [lambda v: math.nan, lambda v: 1e-200 * (v + 1.0)])
def test_no_crossing_is_refused_whatever_the_product_of_the_values(function: object) -> None:
    with pytest.raises(ValueError, match="same sign"):
        crossing(function, 0.0, 1.0, tolerance=1e-12)  # type: ignore[arg-type]


def test_a_single_place_gives_a_single_value() -> None:
    spline = Spline(np.array([0.0, 1.0, 2.0, 4.0]), np.array([0.0, 1.0, 4.0, 16.0]))
    assert float(spline(3.0)) == pytest.approx(9.0)
    assert in_pieces(np.array([0.0, 1.0]), np.array([[1.0], [2.0]]), 0.5).shape == ()


@pytest.mark.parametrize("places", [[1.0], [0.0, 1.0, 1.0], [2.0, 1.0]])
def test_places_that_do_not_increase_are_refused(places: list[float]) -> None:
    with pytest.raises(ValueError, match="increase"):
        Spline(np.array(places), np.ones(len(places)))
