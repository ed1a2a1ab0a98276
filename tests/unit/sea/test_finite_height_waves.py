"""Waves of finite height: field equations, free surface, limits, agreement of theories and of solvers."""

import math

import numpy as np
import pytest

from moyai.core.errors import ConvergenceError, InputError
from moyai.sea import dispersion
from moyai.sea.breaking import highest_steady_wave
from moyai.sea.nonlinear import nonlinear_wave
from moyai.sea.permanent_wave import RESIDUAL
from moyai.sea.regular import RegularWave
from moyai.sea.water import Water

RNG = np.random.default_rng(71)


def random_wave(theory, share, **options):
    """A wave of a given share of the highest one, kh between 0.5 and infinity."""
    depth = float(RNG.choice([2.0, 10.0, 60.0, 1e5, math.inf]))
    length = float(min(depth, 80.0) * RNG.uniform(1.0, 11.0))
    return nonlinear_wave(
        theory,
        height=share * highest_steady_wave(length, depth),
        wavelength=length,
        water=Water(depth, 1025.0, 9.81),
        heading=float(RNG.uniform(-3.0, 3.0)),
        **options,
    )


@pytest.mark.parametrize("case", range(12))
def test_stream_function_fulfils_the_free_surface_between_its_nodes(case):
    wave = random_wave("stream_function", float(RNG.uniform(0.02, 0.85)))
    kinematic, dynamic = wave.surface_residuals(points=97)
    assert kinematic < 1e-5 and dynamic < 1e-5
    assert wave.crest - wave.trough == pytest.approx(wave.height, rel=1e-9)
    assert wave.crest > 0.5 * wave.height * (1.0 - 1e-9)
    x = np.arange(200) * wave.wavelength / 200.0
    along = wave.elevation(0.0, x * math.cos(wave.heading), x * math.sin(wave.heading))
    assert np.mean(along) == pytest.approx(0.0, abs=1e-10 * wave.height)
    assert wave.period == pytest.approx(wave.wavelength / wave.celerity, rel=1e-12)


@pytest.mark.parametrize("theory", ["airy", "stokes", "stream_function"])
def test_fields_are_without_divergence_and_rotation_and_accelerate_as_they_should(theory):
    wave = random_wave(theory, 0.3, current_along_wave=0.4)
    step = 1e-4 * wave.wavelength
    tick = 1e-4 * wave.period
    x, y, t = 0.13 * wave.wavelength, -0.21 * wave.wavelength, 0.3 * wave.period
    z = -0.1 * min(wave.water.depth, wave.wavelength)

    def slope(axis):
        move = np.eye(3)[axis] * step
        plus = wave.velocity(t, x + move[0], y + move[1], z + move[2])
        return (plus - wave.velocity(t, x - move[0], y - move[1], z - move[2])) / (2.0 * step)

    u_x, u_y, u_z = slope(0), slope(1), slope(2)
    scale = wave.height * wave.omega * wave.wave_number
    assert abs(u_x[0] + u_y[1] + u_z[2]) < 1e-6 * scale
    assert abs(u_z[0] - u_x[2]) < 1e-6 * scale
    assert abs(u_x[1] - u_y[0]) < 1e-6 * scale
    local = (wave.velocity(t + tick, x, y, z) - wave.velocity(t - tick, x, y, z)) / (2.0 * tick)
    np.testing.assert_allclose(
        wave.acceleration(t, x, y, z, convective=False), local, atol=1e-6 * scale * wave.celerity
    )
    u = wave.velocity(t, x, y, z)
    total = local + u[0] * u_x + u[1] * u_y + u[2] * u_z
    np.testing.assert_allclose(wave.acceleration(t, x, y, z), total, atol=1e-6 * scale * wave.celerity)


def test_surface_moves_with_the_water_and_carries_no_pressure():
    wave = random_wave("stream_function", 0.6)
    t = np.linspace(0.0, wave.period, 23)
    eta = wave.elevation(t)
    tick, step = 1e-5 * wave.period, 1e-5 * wave.wavelength
    for time, height in zip(t, eta):
        velocity = wave.velocity(time, 0.0, 0.0, height)
        rise = (wave.elevation(time + tick) - wave.elevation(time - tick)) / (2.0 * tick)
        gradient = [
            float(wave.elevation(time, *(step * d)) - wave.elevation(time, *(-step * d))) / (2.0 * step)
            for d in np.eye(2)
        ]
        assert velocity[2] == pytest.approx(
            float(rise) + velocity[0] * gradient[0] + velocity[1] * gradient[1], abs=1e-3 * wave.height * wave.omega
        )
        pressure = float(wave.dynamic_pressure(time, 0.0, 0.0, height)) - 1025.0 * 9.81 * height
        assert abs(pressure) < 1e-4 * 1025.0 * 9.81 * wave.height
    if not math.isinf(wave.water.depth):
        assert wave.velocity(0.2, 0.3, 0.1, -wave.water.depth)[2] == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize("theory", ["stokes", "stream_function"])
@pytest.mark.parametrize("depth", [3.0, 20.0, 2000.0, math.inf])
def test_small_waves_are_linear(theory, depth):
    period = 2.0 * math.pi / math.sqrt(9.81 / min(depth, 50.0)) * 1.3
    water = Water(depth, 1025.0, 9.81)
    linear = RegularWave(1.0, period, 0.4, water)
    height = 1e-4 * linear.wavelength * min(1.0, linear.relative_depth**3)
    wave = nonlinear_wave(theory, height=height, period=period, water=water, heading=0.4)
    assert wave.wavelength == pytest.approx(linear.wavelength, rel=1e-6)
    sea = RegularWave(height, period, 0.4, water).components()
    t, x, z = np.linspace(0.0, period, 7), 0.2 * linear.wavelength, -0.05 * min(depth, 50.0)
    np.testing.assert_allclose(wave.elevation(t, x), sea.elevation(t, x), atol=2e-3 * height)
    scale = height * linear.omega / math.tanh(min(linear.relative_depth, 50.0))
    np.testing.assert_allclose(wave.velocity(t, x, 0.0, z), sea.velocity(t, x, 0.0, z), atol=2e-3 * scale)
    np.testing.assert_allclose(
        wave.acceleration(t, x, 0.0, z), sea.acceleration(t, x, 0.0, z), atol=2e-3 * scale * linear.omega
    )


def test_airy_theory_is_the_regular_wave():
    water = Water(12.0, 1025.0, 9.81)
    wave = nonlinear_wave("airy", height=1.0, period=6.0, water=water)
    linear = RegularWave(1.0, 6.0, 0.0, water)
    assert wave.wavelength == pytest.approx(linear.wavelength, rel=1e-12)
    np.testing.assert_allclose(
        wave.velocity(0.7, 1.0, 0.0, -3.0), linear.components().velocity(0.7, 1.0, 0.0, -3.0), rtol=1e-9, atol=1e-12
    )


@pytest.mark.parametrize("order", [1, 2, 3, 4, 5])
def test_error_of_a_stokes_wave_falls_with_its_order(order):
    """The residual of the free surface is of order epsilon^(order + 1): halving the height divides H times it so."""
    water = Water(10.0, 1025.0, 9.81)
    high, low = (
        max(nonlinear_wave("stokes", height=h, wavelength=25.0, water=water, order=order).surface_residuals())
        for h in (0.8, 0.4)
    )
    # relative to the height itself one power less
    assert math.log2(high / low) == pytest.approx(order, abs=0.35)


def test_stokes_and_stream_function_agree_on_moderate_waves():
    for depth, period, height in ((20.0, 7.0, 1.5), (math.inf, 8.0, 3.0), (200.0, 10.0, 5.0)):
        water = Water(depth, 1025.0, 9.81)
        stokes = nonlinear_wave("stokes", height=height, period=period, water=water)
        stream = nonlinear_wave("stream_function", height=height, period=period, water=water)
        assert stokes.wavelength == pytest.approx(stream.wavelength, rel=2e-6)
        assert stokes.crest == pytest.approx(stream.crest, rel=1e-4)
        np.testing.assert_allclose(
            stokes.velocity(0.0, 0.0, 0.0, stokes.crest),
            stream.velocity(0.0, 0.0, 0.0, stokes.crest),
            rtol=2e-4,
            atol=1e-12,
        )


@pytest.mark.parametrize("case", range(8))
def test_own_solver_agrees_with_raschii(case):
    depth = float(RNG.choice([4.0, 15.0, 400.0, math.inf]))
    length = float(min(depth, 60.0) * RNG.uniform(1.5, 8.0))
    height = float(RNG.uniform(0.1, 0.6)) * highest_steady_wave(length, depth)
    water = Water(depth, 1025.0, 9.81)
    own, other = (
        nonlinear_wave("stream_function", height=height, wavelength=length, water=water, order=14, solver=solver)
        for solver in ("newton", "raschii")
    )
    # raschii ends its iteration by a tolerance of its own: 2e-7 of the celerity was seen
    assert own.celerity == pytest.approx(other.celerity, rel=1e-6)
    np.testing.assert_allclose(own.elevation_harmonics, other.elevation_harmonics, atol=1e-6 * height)
    np.testing.assert_allclose(own.crest_velocities, other.crest_velocities, atol=1e-6 * own.crest_velocities[0])


def test_period_is_met_through_every_way():
    water = Water(10.0, 1025.0, 9.81)
    for theory, options in (
        ("stokes", {"order": 3}),
        ("stokes", {}),
        ("stream_function", {}),
        ("stream_function", {"solver": "raschii", "order": 12}),
    ):
        for current in (-0.8, 0.0, 1.1):
            wave = nonlinear_wave(theory, height=1.0, period=6.0, water=water, current_along_wave=current, **options)
            assert wave.celerity * 6.0 == pytest.approx(wave.wavelength, rel=1e-9)
            linear = 2.0 * math.pi / dispersion.wave_number_in_current(2.0 * math.pi / 6.0, 10.0, 9.81, current)
            assert 1.0 < wave.wavelength / linear < 1.03


def test_long_and_steep_waves_are_reached():
    for depth, period, height in ((1.0, 12.0, 0.3), (2.0, 20.0, 0.8), (10.0, 8.0, 6.0), (5.0, 12.0, 2.5)):
        wave = nonlinear_wave("stream_function", height=height, period=period, water=Water(depth, 1025.0, 9.81))
        assert max(wave.surface_residuals()) < 1e-3


@pytest.mark.slow
def test_nearly_all_random_waves_are_found_by_length_and_by_period():
    """Up to 97 % of the highest wave, kh from 0.12 to 32; what is refused is long and within 8 % of the highest."""
    rng = np.random.default_rng(99)
    refused = []
    for _ in range(250):
        depth, kh = 10.0 ** rng.uniform(-1.0, 3.0), 10.0 ** rng.uniform(math.log10(0.12), 1.5)
        length, share = 2.0 * math.pi * depth / kh, rng.uniform(0.02, 0.97)
        height, water = share * highest_steady_wave(length, depth), Water(depth, 1025.0, 9.81)
        try:
            wave = nonlinear_wave("stream_function", height=height, wavelength=length, water=water)
            again = nonlinear_wave("stream_function", height=height, period=wave.period, water=water)
        except ConvergenceError:
            refused.append((share, kh))
            continue
        worst = max(*wave.surface_residuals(), *again.surface_residuals())
        assert worst < 1e-3
        # a wave that misses its surface by more than is promised, of which it warns, is known within that residual
        assert again.wavelength == pytest.approx(length, rel=1e-6 if worst <= RESIDUAL else worst)
    assert len(refused) <= 4
    assert all(share > 0.9 and kh < 0.35 for share, kh in refused)


def test_solitary_limit_of_long_waves():
    """c^2 = g (h + H) to second order for a long wave that is nearly solitary (Boussinesq; Laitone)."""
    water = Water(1.0, 1000.0, 9.81)
    wave = nonlinear_wave("stream_function", height=0.1, wavelength=60.0, water=water)
    depth_under_trough = 1.0 + wave.trough
    ratio = 0.1 / depth_under_trough
    froude = 1.0 + ratio / 2.0 - 3.0 * ratio**2 / 20.0 + 3.0 * ratio**3 / 56.0
    # in the frame where the water at the trough rests
    along = wave.velocity(0.5 * wave.period, 0.0, 0.0, -0.5)[0]
    assert (wave.celerity - along) / math.sqrt(9.81 * depth_under_trough) == pytest.approx(froude, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("depth", "period", "height"), [(10.0, 8.0, 7.6), (10.0, 8.0, 20.0), (2.0, 10.0, 1.75), (math.inf, 6.0, 9.5)]
)
def test_waves_beyond_the_highest_are_refused(depth, period, height):
    with pytest.raises(ConvergenceError, match="no steady wave"):
        nonlinear_wave("stream_function", height=height, period=period, water=Water(depth, 1025.0, 9.81))


def test_flat_water():
    wave = nonlinear_wave("stream_function", height=0.0, period=7.0, water=Water(20.0, 1025.0, 9.81))
    assert wave.wavelength == pytest.approx(71.98, abs=5e-3)
    assert float(wave.elevation(0.3)) == 0.0
    assert wave.surface_residuals() == (0.0, 0.0)


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({"theory": "cnoidal"}, "theory"),
        ({"height": -1.0}, "height"),
        ({"period": None}, "period"),
        ({"wavelength": 50.0}, "period"),
        ({"period": -2.0}, "period"),
        ({"order": 6}, "order"),
        ({"theory": "stream_function", "order": 2}, "order"),
        ({"theory": "stream_function", "solver": "raschii"}, "order"),
        ({"solver": "bisection"}, "solver"),
        ({"current_along_wave": -4.0}, "blocks"),
        ({"current_along_wave": math.nan}, "current"),
        ({"period": None, "wavelength": 20.0, "current_along_wave": -9.0}, "faster than the wave"),
    ],
)
def test_bad_requests(options, name):
    request = {"theory": "stokes", "height": 1.0, "period": 7.0, "water": Water(20.0, 1025.0, 9.81), **options}
    with pytest.raises(InputError, match=name):
        nonlinear_wave(request.pop("theory"), **request)


DEEP = Water(math.inf, 1025.0, 9.81)


@pytest.mark.parametrize("order", [35, 45, 60])
def test_many_components_of_a_steep_deep_wave_give_the_wave_of_few(order):
    """H/L = 0.12: the 25-th component is 1e-7 of the first, so that more of them change nothing."""
    few, many = (
        nonlinear_wave("stream_function", height=12.0, water=DEEP, wavelength=100.0, order=count)
        for count in (25, order)
    )
    assert max(many.surface_residuals()) < 1e-7
    assert many.period == pytest.approx(few.period, rel=1e-9)


def test_the_residual_that_is_promised_is_kept_or_reported():
    kept = nonlinear_wave("stream_function", height=13.5, water=DEEP, wavelength=100.0)
    assert max(kept.surface_residuals()) < 1e-5 and not kept.notices()
    missed = nonlinear_wave("stream_function", height=13.7, water=DEEP, wavelength=100.0)
    (notice,) = missed.notices()
    assert notice.value == pytest.approx(max(missed.surface_residuals())) and 1e-5 < notice.value < 1e-3
    assert "misses the conditions of its surface" in notice.message
    few = nonlinear_wave("stream_function", height=12.0, water=DEEP, wavelength=100.0, order=9)
    assert few.notices()
