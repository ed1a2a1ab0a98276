"""Dispersion against forty-digit decimals, limits, identities and the concavity of the Doppler-shifted relation."""

import math
from decimal import Decimal, getcontext

import numpy as np
import pytest
from numba import njit

from moyai.core.errors import InputError
from moyai.sea import dispersion

getcontext().prec = 40
GRAVITY = 9.81
ROUNDING = 4.0 * np.finfo(float).eps


def decimal_tanh(y):
    e = (-2 * y).exp()
    return (1 - e) / (1 + e)


def decimal_sin_cos(x):
    """Taylor series, for arguments up to pi/2."""
    sine, cosine, term = Decimal(0), Decimal(0), Decimal(1)
    for n in range(60):
        if n % 2 == 0:
            cosine += term if n % 4 == 0 else -term
        else:
            sine += term if n % 4 == 1 else -term
        term *= x / (n + 1)
    return sine, cosine


DECIMAL_PI = Decimal("3.141592653589793238462643383279502884197")


def test_wave_number_is_exact_to_rounding_for_any_relative_depth():
    rng = np.random.default_rng(20260101)
    worst = 0.0
    for exponent in rng.uniform(-12.0, 4.0, 600):
        depth, gravity = float(rng.uniform(0.05, 500.0)), float(rng.uniform(1.0, 20.0))
        y0 = 10.0**exponent
        omega = math.sqrt(gravity / depth * y0 * math.tanh(y0))
        found = Decimal(dispersion.wave_number(omega, depth, gravity)) * Decimal(depth)
        x = Decimal(omega) ** 2 * Decimal(depth) / Decimal(gravity)
        # one Newton step in decimals measures the error of y
        t = decimal_tanh(found) if found > Decimal("1e-8") else found - found**3 / 3
        error = (found * t - x) / (t + found * (1 - t * t)) / found
        worst = max(worst, abs(float(error)))
    assert worst < ROUNDING


def test_frequency_and_wave_number_are_inverse():
    rng = np.random.default_rng(2)
    k = 10.0 ** rng.uniform(-10.0, 3.0, 2000)
    depth = 10.0 ** rng.uniform(-2.0, 4.0, 2000)
    omega = dispersion.angular_frequency(k, depth, 9.81)
    np.testing.assert_allclose(dispersion.wave_number(omega, depth, 9.81), k, rtol=3e-15)


def test_limits_of_depth():
    omega = np.array([0.0, 0.3, 2.0, 50.0])
    deep = dispersion.wave_number(omega, math.inf, 9.81)
    np.testing.assert_allclose(deep, omega**2 / 9.81, rtol=1e-15)
    assert dispersion.wave_number(100.0, 1000.0, 9.81) == pytest.approx(100.0**2 / 9.81, rel=1e-15)
    assert dispersion.wave_number(1e-6, 10.0, 9.81) == pytest.approx(1e-6 / math.sqrt(98.1), rel=1e-12)
    assert dispersion.wave_number(0.0, 10.0, 9.81) == 0.0


def test_scalars_give_floats_and_arrays_broadcast():
    assert isinstance(dispersion.wave_number(1.0, 10.0, 9.81), float)
    grid = dispersion.wave_number(np.array([[0.5], [1.0]]), np.array([5.0, 10.0, math.inf]), 9.81)
    assert grid.shape == (2, 3)
    assert grid[1, 1] == dispersion.wave_number(1.0, 10.0, 9.81)


def test_coastal_example():
    k = dispersion.wave_number(2.0 * math.pi / 7.0, 20.0, 9.81)
    assert k == pytest.approx(0.08729, abs=5e-6)
    assert 2.0 * math.pi / k == pytest.approx(71.98, abs=5e-3)


def test_kernel_can_be_called_from_compiled_code():
    @njit
    def total(omega, depth):
        return dispersion.wave_number_scalar(omega, depth, 9.81) + dispersion.wave_number_scalar(omega, math.inf, 9.81)

    assert total(1.0, 10.0) == dispersion.wave_number(1.0, 10.0, 9.81) + 1.0 / 9.81


def test_evanescent_deficits_are_exact_to_rounding():
    rng = np.random.default_rng(3)
    worst = 0.0
    for _ in range(150):
        depth = float(10.0 ** rng.uniform(-1.0, 3.0))
        x = float(10.0 ** rng.uniform(-12.0, 9.0))
        omega = math.sqrt(9.81 / depth * x)
        n = int(rng.integers(1, 5000))
        found = Decimal(float(dispersion.evanescent_deficits(omega, depth, GRAVITY, n)[-1]))
        exact_x = Decimal(omega) ** 2 / Decimal(GRAVITY) * Decimal(depth)
        sine, cosine = decimal_sin_cos(found)
        y = n * DECIMAL_PI - found
        # y tan(delta) = x, multiplied by the cosine
        residual = y * sine - exact_x * cosine
        slope = y * cosine - sine + exact_x * sine
        worst = max(worst, abs(float(residual / slope / found)))
    assert worst < 2.0 * ROUNDING


def test_evanescent_wave_numbers_lie_in_their_intervals_and_count_all_roots():
    rng = np.random.default_rng(4)
    for _ in range(20):
        depth = float(10.0 ** rng.uniform(-1.0, 3.0))
        omega = math.sqrt(9.81 / depth * 10.0 ** rng.uniform(-10.0, 8.0))
        y = dispersion.evanescent_wave_numbers(omega, depth, 9.81, 3000) * depth
        n = np.arange(1, 3001)
        assert (y > (n - 0.5) * math.pi * (1 - 1e-15)).all() and (y <= n * math.pi * (1 + 1e-15)).all()
        assert (np.diff(y) > 0.0).all()


def test_evanescent_limits_of_frequency():
    n = np.arange(1, 11)
    np.testing.assert_allclose(dispersion.evanescent_wave_numbers(0.0, 2.0, 9.81, 10), n * math.pi / 2.0, rtol=1e-15)
    fast = dispersion.evanescent_wave_numbers(1e9, 2.0, 9.81, 10)
    np.testing.assert_allclose(fast, (n - 0.5) * math.pi / 2.0, rtol=1e-15)
    assert dispersion.evanescent_wave_numbers(np.ones((2, 3)), 2.0, 9.81, 5).shape == (2, 3, 5)


def test_modes_with_the_propagating_wave_are_orthogonal():
    """cosh k(z+h) and cos k_n(z+h) form a Sturm-Liouville system; nothing but the right roots is orthogonal."""
    rng = np.random.default_rng(5)
    points, weights = np.polynomial.legendre.leggauss(200)
    for _ in range(10):
        depth, omega = float(rng.uniform(0.5, 30.0)), float(rng.uniform(0.2, 3.0))
        s = 0.5 * depth * (points + 1.0)
        k = dispersion.wave_number(omega, depth, 9.81)
        modes = [np.cosh(k * s) / math.cosh(k * depth)]
        modes += [np.cos(kn * s) for kn in dispersion.evanescent_wave_numbers(omega, depth, 9.81, 8)]
        gram = np.array([[np.sum(weights * a * b) for b in modes] for a in modes])
        norm = np.sqrt(np.diag(gram))
        off = gram / np.outer(norm, norm) - np.eye(9)
        assert np.abs(off).max() < 1e-12


def test_group_velocity_is_the_derivative_of_frequency():
    rng = np.random.default_rng(6)
    k = 10.0 ** rng.uniform(-4.0, 2.0, 500)
    depth = 10.0 ** rng.uniform(-1.0, 3.0, 500)
    step = 1e-5 * k
    slope = (
        dispersion.angular_frequency(k + step, depth, 9.81) - dispersion.angular_frequency(k - step, depth, 9.81)
    ) / (2.0 * step)
    omega = dispersion.angular_frequency(k, depth, 9.81)
    np.testing.assert_allclose(dispersion.group_velocity(omega, depth, 9.81), slope, rtol=2e-9)
    np.testing.assert_allclose(dispersion.phase_velocity(omega, depth, 9.81), omega / k, rtol=1e-14)


def test_velocities_at_the_limits():
    assert dispersion.group_velocity(0.0, 10.0, 9.81) == pytest.approx(math.sqrt(98.1))
    assert dispersion.phase_velocity(0.0, 10.0, 9.81) == pytest.approx(math.sqrt(98.1))
    assert dispersion.group_velocity(2.0, math.inf, 9.81) == pytest.approx(9.81 / 4.0)
    assert dispersion.group_velocity(100.0, 1e6, 9.81) == pytest.approx(9.81 / 200.0)


@pytest.mark.slow
def test_current_shifts_the_wave_number():
    rng = np.random.default_rng(7)
    checked = 0
    for _ in range(2000):
        depth = float(10.0 ** rng.uniform(-1.0, 3.0)) if rng.random() < 0.9 else math.inf
        omega, current = float(10.0 ** rng.uniform(-2.0, 1.0)), float(rng.uniform(-3.0, 3.0))
        try:
            k = dispersion.wave_number_in_current(omega, depth, 9.81, current)
        except InputError:
            # blocked: no wave number at all fulfils the relation
            trial = np.geomspace(1e-8, 1e5, 40001)
            tanh = np.tanh(trial * depth)
            assert (np.sqrt(9.81 * trial * tanh) + trial * current < omega).all()
            continue
        sigma = omega - k * current
        assert sigma > 0.0
        assert sigma == pytest.approx(dispersion.angular_frequency(k, depth, 9.81), rel=1e-12)
        # the energy of this branch travels with the wave
        relative = dispersion.group_velocity(sigma, depth, 9.81)
        assert relative + current > -1e-6 * relative
        checked += 1
    assert checked > 1000


def test_infinite_depth_in_a_current_agrees_with_very_deep_water():
    omega = np.linspace(0.3, 2.0, 12)
    for current in (-0.9, 0.4, 2.0):
        closed = dispersion.wave_number_in_current(omega, math.inf, 9.81, current)
        np.testing.assert_allclose(dispersion.wave_number_in_current(omega, 5e3, 9.81, current), closed, rtol=1e-12)


def test_blocking_limit_is_sharp_and_named():
    depth, speed = 8.0, 1.2
    _, highest = dispersion.blocking_scalar(depth, 9.81, speed)
    dispersion.wave_number_in_current(highest * (1.0 - 1e-9), depth, 9.81, -speed)
    with pytest.raises(InputError, match=r"blocks waves of period .* longer than"):
        dispersion.wave_number_in_current(highest * (1.0 + 1e-9), depth, 9.81, -speed)
    with pytest.raises(InputError, match="outruns every wave"):
        dispersion.wave_number_in_current(0.5, 1.0, 9.81, -4.0)


@pytest.mark.parametrize(
    ("omega", "depth", "gravity", "name"),
    [
        (-1.0, 10.0, 9.81, "omega"),
        (math.nan, 10.0, 9.81, "omega"),
        (math.inf, 10.0, 9.81, "omega"),
        (1.0, 0.0, 9.81, "water_depth"),
        (1.0, math.nan, 9.81, "water_depth"),
        (1.0, 10.0, -9.81, "gravity"),
    ],
)
def test_bad_input_is_named(omega, depth, gravity, name):
    with pytest.raises(InputError, match=name):
        dispersion.wave_number(omega, depth, gravity)


def test_infinite_depth_has_no_discrete_evanescent_waves():
    with pytest.raises(InputError, match="infinite"):
        dispersion.evanescent_wave_numbers(1.0, math.inf, 9.81, 3)


@pytest.mark.parametrize("index", [1, 4])
def test_short_waves_leave_evanescent_ones_a_quarter_of_a_wave(index):
    """k_n h tends to (n - 1/2) pi; the way there falls with one over the relative depth."""
    limit = dispersion.evanescent_deficit_scalar(math.inf, index)
    assert limit == pytest.approx(0.5 * math.pi, rel=1e-15)
    near = dispersion.evanescent_deficit_scalar(1e6, index)
    assert limit - near == pytest.approx((index - 0.5) * math.pi / 1e6, rel=1e-5)
