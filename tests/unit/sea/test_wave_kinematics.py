"""Linear kinematics against the field equations, the boundary conditions and closed integrals."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea import dispersion, kinematics
from moyai.sea.components import WaveComponents
from moyai.sea.regular import RegularWave
from moyai.sea.water import Water


def random_sea(rng, depth, count=7, current=(0.0, 0.0)):
    omega = rng.uniform(0.4, 2.5, count)
    heading = rng.uniform(-math.pi, math.pi, count)
    along = current[0] * np.cos(heading) + current[1] * np.sin(heading)
    k = dispersion.wave_number_in_current(omega, depth, 9.81, along)
    return WaveComponents(
        omega=omega,
        amplitude=rng.uniform(0.0, 0.5, count),
        phase=rng.uniform(0.0, 2.0 * math.pi, count),
        heading=heading,
        wave_number=k,
        water=Water(depth, 1025.0, 9.81),
        intrinsic_omega=omega - k * along,
    )


def derivative(function, step=1e-3):
    """Fourth-order central difference."""
    return (8.0 * (function(step) - function(-step)) - (function(2.0 * step) - function(-2.0 * step))) / (12.0 * step)


@pytest.mark.parametrize("depth", [1.5, 12.0, 300.0, math.inf])
def test_field_equations(depth):
    rng = np.random.default_rng(11)
    sea = random_sea(rng, depth)
    for _ in range(5):
        t, x, y = rng.uniform(-20.0, 20.0, 3)
        z = -rng.uniform(0.1, 0.9) * min(depth, 20.0)

        def velocity(dt=0.0, dx=0.0, dy=0.0, dz=0.0, t=t, x=x, y=y, z=z):
            return sea.velocity(t + dt, x + dx, y + dy, z + dz)

        def pressure(dx=0.0, dy=0.0, dz=0.0, t=t, x=x, y=y, z=z):
            return float(sea.dynamic_pressure(t, x + dx, y + dy, z + dz))

        u_x, u_y, u_z = (derivative(lambda d, a=a: velocity(**{a: d})) for a in ("dx", "dy", "dz"))
        assert u_x[0] + u_y[1] + u_z[2] == pytest.approx(0.0, abs=1e-9)
        assert u_z[0] == pytest.approx(u_x[2], abs=1e-9)
        assert u_z[1] == pytest.approx(u_y[2], abs=1e-9)
        local = derivative(lambda d: velocity(dt=d))
        np.testing.assert_allclose(sea.acceleration(t, x, y, z), local, atol=1e-9)
        slope = [derivative(lambda d, a=a: pressure(**{a: d})) for a in ("dx", "dy", "dz")]
        np.testing.assert_allclose(local, -np.array(slope) / 1025.0, atol=1e-8)


@pytest.mark.parametrize("depth", [2.0, 40.0])
def test_boundary_conditions(depth):
    rng = np.random.default_rng(12)
    sea = random_sea(rng, depth)
    t, x, y = 3.3, 1.7, -2.2
    rise = derivative(lambda d: float(sea.elevation(t + d, x, y)))
    assert sea.velocity(t, x, y, 0.0)[2] == pytest.approx(rise, abs=1e-9)
    assert sea.velocity(t, x, y, -depth)[2] == pytest.approx(0.0, abs=1e-12)
    assert sea.dynamic_pressure(t, x, y, 0.0) == pytest.approx(1025.0 * 9.81 * float(sea.elevation(t, x, y)), rel=1e-12)


def test_on_a_current_the_particles_are_followed():
    rng = np.random.default_rng(13)
    flow = np.array([0.6, -0.3])
    sea = random_sea(rng, 15.0, current=tuple(flow))
    t, x, y, z = 5.0, 2.0, 3.0, -4.0

    def moving(d):
        return sea.velocity(t + d, x + flow[0] * d, y + flow[1] * d, z)

    np.testing.assert_allclose(sea.acceleration(t, x, y, z), derivative(moving), atol=1e-9)
    rise = derivative(lambda d: float(sea.elevation(t + d, x + flow[0] * d, y + flow[1] * d)))
    assert sea.velocity(t, x, y, 0.0)[2] == pytest.approx(rise, abs=1e-9)


def test_depth_functions_never_overflow_and_keep_their_digits():
    z = np.array([0.0, -0.5, -1.0])
    for k in (1e-12, 1e-6, 1.0, 1e4):
        horizontal, vertical, pressure = kinematics.depth_functions(k, 1.0, z)
        assert np.isfinite([horizontal, vertical, pressure]).all()
        if k <= 1.0:
            np.testing.assert_allclose(horizontal, np.cosh(k * (z + 1.0)) / np.sinh(k), rtol=1e-14)
            np.testing.assert_allclose(vertical, np.sinh(k * (z + 1.0)) / np.sinh(k), rtol=1e-14)
            np.testing.assert_allclose(pressure, np.cosh(k * (z + 1.0)) / np.cosh(k), rtol=1e-14)
    deep = kinematics.depth_functions(2.0, math.inf, -1.0)
    np.testing.assert_allclose(deep, math.exp(-2.0))


def test_wheeler_maps_surface_and_bed():
    eta = np.array([-0.8, 0.0, 1.3])
    np.testing.assert_allclose(kinematics.wheeler_elevation(eta, eta, 5.0), 0.0, atol=1e-15)
    np.testing.assert_allclose(kinematics.wheeler_elevation(-5.0, eta, 5.0), -5.0)
    np.testing.assert_allclose(kinematics.wheeler_elevation(-1.0, eta, math.inf), -1.0 - eta)
    # deep water is the limit of finite depth
    np.testing.assert_allclose(kinematics.wheeler_elevation(-1.0, eta, 1e9), -1.0 - eta, atol=1e-8)


def test_wheeler_kinematics_are_linear_kinematics_at_the_mapped_height():
    rng = np.random.default_rng(14)
    for depth in (6.0, math.inf):
        sea = random_sea(rng, depth)
        x, z = np.linspace(-5.0, 5.0, 9), np.linspace(-4.0, 0.2, 9)
        eta, velocity, acceleration = sea.kinematics(2.5, x, 0.0, z, "wheeler")
        mapped = np.minimum(kinematics.wheeler_elevation(z, eta, depth), 0.0)
        _, straight, rate = sea.kinematics(2.5, x, 0.0, mapped, "constant")
        np.testing.assert_allclose(velocity, straight, rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(acceleration, rate, rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(sea.velocity(np.array([2.5, 3.0]), x, 0.0, z, "wheeler")[0], velocity)


def test_treatments_above_still_water():
    sea = random_sea(np.random.default_rng(15), 9.0)
    surface = sea.velocity(1.0, 0.5, 0.2, 0.0)
    np.testing.assert_array_equal(sea.velocity(1.0, 0.5, 0.2, 0.7), surface)
    slope = (surface - sea.velocity(1.0, 0.5, 0.2, -1e-6)) / 1e-6
    np.testing.assert_allclose(sea.velocity(1.0, 0.5, 0.2, 0.7, "linear"), surface + 0.7 * slope, rtol=1e-4, atol=1e-6)
    for stretching in ("constant", "linear"):
        node = sea.kinematics(1.0, 0.5, 0.2, 0.7, stretching)
        np.testing.assert_allclose(node[1], sea.velocity(1.0, 0.5, 0.2, 0.7, stretching), rtol=1e-12)
        np.testing.assert_allclose(node[2], sea.acceleration(1.0, 0.5, 0.2, 0.7, stretching), rtol=1e-12)
    with pytest.raises(InputError, match="stretching"):
        sea.velocity(1.0, 0.0, 0.0, 0.0, "vertical")
    with pytest.raises(InputError, match="Wheeler"):
        sea.transfer_functions(0.0, 0.0, 0.0, "wheeler")


def test_nodes_at_many_times_through_kernels_agree():
    sea = random_sea(np.random.default_rng(16), 25.0, count=40)
    x, y, z = np.array([0.0, 3.0, -8.0]), np.array([1.0, 0.0, 2.0]), np.array([-1.0, -5.0, -24.0])
    time = np.linspace(0.0, 60.0, 601)
    series = sea.velocity(time, x, y, z)
    rates = sea.acceleration(time, x, y, z)
    assert series.shape == (601, 3, 3)
    for n in (0, 77, 600):
        _, velocity, acceleration = sea.kinematics(time[n], x, y, z, "constant")
        np.testing.assert_allclose(series[n], velocity, atol=1e-12)
        np.testing.assert_allclose(rates[n], acceleration, atol=1e-12)
    transfer, _ = sea.transfer_functions(x, y, z)
    turned = sea.complex_amplitude * np.exp(-1j * sea.omega * time[77])
    np.testing.assert_allclose((transfer @ turned).real, series[77], atol=1e-12)


def test_stokes_drift_carries_energy_over_celerity():
    rng = np.random.default_rng(17)
    points, weights = np.polynomial.legendre.leggauss(120)
    for _ in range(10):
        wave = RegularWave(
            float(rng.uniform(0.1, 3.0)),
            float(rng.uniform(2.0, 15.0)),
            0.7,
            Water(float(rng.uniform(1.0, 40.0)), 1025.0, 9.81),
        )
        depth = wave.water.depth
        z = 0.5 * depth * (points - 1.0)
        drift = wave.components().stokes_drift(z)
        carried = 0.5 * depth * weights @ drift
        expected = wave.energy / (1025.0 * wave.phase_velocity)
        np.testing.assert_allclose(carried, expected * np.array([math.cos(0.7), math.sin(0.7)]), rtol=1e-10)


def test_depth_average_of_the_crest_velocity_squared_over_a_curtain():
    """Curtain of 5 m depth in 20 m: closed form by an independent prototype, here by quadrature of the kinematics."""
    points, weights = np.polynomial.legendre.leggauss(40)
    z = 2.5 * (points - 1.0)
    for height, current, expected, mean in ((5.508, 0.2, 5.6471736, 2.4109), (2.0, 0.0, 0.6251950, 0.3125975)):
        sea = RegularWave(height, 7.0, 0.0, Water(20.0, 1025.0, 9.81)).components()
        crest = sea.velocity(0.0, 0.0, 0.0, z)[:, 0] + current
        assert 0.5 * weights @ crest**2 == pytest.approx(expected, abs=6e-8)
        over_period = sea.velocity(np.arange(64) * 7.0 / 64.0, 0.0, 0.0, z)[..., 0] + current
        assert 0.5 * np.mean(over_period**2, axis=0) @ weights == pytest.approx(mean, abs=6e-5)


def test_regular_wave_numbers():
    water = Water(20.0, 1025.0, 9.81)
    wave = RegularWave(2.0, 7.0, math.pi / 3.0, water)
    assert wave.wavelength == pytest.approx(71.98, abs=5e-3)
    assert wave.steepness == pytest.approx(2.0 / wave.wavelength)
    assert wave.energy == pytest.approx(1025.0 * 9.81 * 0.5)
    assert wave.energy_flux == pytest.approx(wave.energy * dispersion.group_velocity(wave.omega, 20.0, 9.81))
    assert float(wave.elevation(0.0)) == pytest.approx(1.0)
    # half a wavelength along the heading is a trough
    half = 0.5 * wave.wavelength
    assert float(wave.elevation(0.0, half * 0.5, half * math.sin(math.pi / 3.0))) == pytest.approx(-1.0)
    assert wave.ursell_number == pytest.approx(2.0 * wave.wavelength**2 / 8000.0)


def test_energy_flux_is_the_work_of_the_dynamic_pressure():
    rng = np.random.default_rng(18)
    points, weights = np.polynomial.legendre.leggauss(80)
    for depth in (3.0, 30.0, 120.0):
        wave = RegularWave(1.4, float(rng.uniform(3.0, 12.0)), 0.0, Water(depth, 1025.0, 9.81))
        time = np.arange(32) * wave.period / 32.0
        z = 0.5 * depth * (points - 1.0)
        sea = wave.components()
        work = np.mean(sea.dynamic_pressure(time, 0.0, 0.0, z) * sea.velocity(time, 0.0, 0.0, z)[..., 0], axis=0)
        assert 0.5 * depth * weights @ work == pytest.approx(wave.energy_flux, rel=1e-10)


@pytest.mark.parametrize(
    ("height", "period", "name"), [(-1.0, 7.0, "height"), (1.0, 0.0, "period"), (math.nan, 7.0, "height")]
)
def test_bad_regular_waves(height, period, name):
    with pytest.raises(InputError, match=name):
        RegularWave(height, period, 0.0, Water(10.0, 1025.0, 9.81))
