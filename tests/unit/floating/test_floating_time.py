"""The integrator against exact solutions of random systems, its order, its invariants, its manners."""

from __future__ import annotations

import math

import numpy as np
import pytest
from floating_samples import hydrodynamics_of, positive_definite, random_memory
from scipy.linalg import expm

from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping, QuadraticDamping
from moyai.floating.forcing import CalmWater, IrregularForcing, RegularForcing, cosine_ramp
from moyai.floating.frequency import solve_motions
from moyai.floating.irregular import linearised_in_sea
from moyai.floating.memory import ConvolutionMemory, StateSpaceMemory
from moyai.floating.sums import complex_sum, real_sum
from moyai.floating.time import CumminsModel, choose_time_step, exponential_weights, simulate
from moyai.series.harmonics import fit_last_periods

CALM = CalmWater(np.zeros(3))


def _random_model(seed: int) -> CumminsModel:
    rng = np.random.default_rng(seed)
    return CumminsModel(
        inertia=positive_definite(rng, 3, 2.0),
        stiffness=positive_definite(rng, 3, 4.0),
        linear_damping=positive_definite(rng, 3, 0.1),
        memory=random_memory(rng),
    )


def _exact(model: CumminsModel, position: np.ndarray, velocity: np.ndarray, time: float) -> np.ndarray:
    memory = model.memory
    assert isinstance(memory, StateSpaceMemory)
    m, n = 3, len(memory.poles)
    matrix = np.zeros((2 * m + 2 * n, 2 * m + 2 * n))
    inverse = np.linalg.inv(model.inertia)
    matrix[:m, m : 2 * m] = np.eye(m)
    matrix[m : 2 * m, :m] = -inverse @ model.stiffness
    matrix[m : 2 * m, m : 2 * m] = -inverse @ (model.linear_damping + memory.dashpot)
    matrix[m : 2 * m, 2 * m : 2 * m + n] = -inverse @ memory.outputs.real
    matrix[m : 2 * m, 2 * m + n :] = inverse @ memory.outputs.imag
    matrix[2 * m : 2 * m + n, m : 2 * m] = memory.inputs.real
    matrix[2 * m + n :, m : 2 * m] = memory.inputs.imag
    matrix[2 * m : 2 * m + n, 2 * m : 2 * m + n] = np.diag(memory.poles.real)
    matrix[2 * m : 2 * m + n, 2 * m + n :] = -np.diag(memory.poles.imag)
    matrix[2 * m + n :, 2 * m : 2 * m + n] = np.diag(memory.poles.imag)
    matrix[2 * m + n :, 2 * m + n :] = np.diag(memory.poles.real)
    return (expm(matrix * time) @ np.concatenate([position, velocity, np.zeros(2 * n)]))[:m]


def _error(model: CumminsModel, seed: int, step: float, same: CumminsModel | None = None) -> float:
    rng = np.random.default_rng(100 + seed)
    position, velocity = rng.normal(size=3), rng.normal(size=3)
    run = simulate(model, CALM, duration=8.0, time_step=step, initial_position=position, initial_velocity=velocity)
    # Root mean square over instants, so that no chance crossing of zero error feigns another order
    rows = np.linspace(0, len(run.time) - 1, 6).astype(int)[1:]
    exact = np.array([_exact(same or model, position, velocity, run.time[row]) for row in rows])
    return float(np.sqrt(np.mean((run.position[rows] - exact) ** 2)))


@pytest.mark.parametrize("seed", range(6))
def test_random_linear_systems_agree_with_the_matrix_exponential_and_converge_at_fourth_order(seed: int) -> None:
    model = _random_model(seed)
    errors = [_error(model, seed, step) for step in (0.025, 0.0125, 0.00625)]
    assert errors[0] < 1e-5
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 3.7), orders


def _with_convolution(model: CumminsModel) -> CumminsModel:
    time = np.linspace(0.0, 8.0, 3201)
    kernel = model.memory.kernel(time)  # type: ignore[union-attr]
    memory = ConvolutionMemory(time, kernel, np.zeros((3, 3)))
    return CumminsModel(model.inertia, model.stiffness, model.linear_damping, memory)


@pytest.mark.parametrize("seed", range(6))
def test_the_chosen_step_is_as_accurate_with_a_convolution(seed: int) -> None:
    model = _random_model(seed)
    other = _with_convolution(model)
    step, notice = choose_time_step(other, CALM)
    assert "second order" in notice.remedy and notice.limit == pytest.approx(step)
    assert _error(other, seed, step, model) < 5e-4
    step, notice = choose_time_step(model, CALM)
    assert "fourth order" in notice.remedy
    assert _error(model, seed, step) < 5e-4


@pytest.mark.parametrize("seed", range(3))
def test_convolution_converges_at_second_order_to_the_same_motion(seed: int) -> None:
    model = _random_model(seed)
    time = np.linspace(0.0, 8.0, 1601)
    other = CumminsModel(
        model.inertia,
        model.stiffness,
        model.linear_damping,
        ConvolutionMemory(time, model.memory.kernel(time), np.zeros((3, 3))),  # type: ignore[union-attr]
    )
    errors = [_error(other, seed, step, model) for step in (0.1, 0.05, 0.025)]
    orders = np.log2(np.array(errors[:-1]) / errors[1:])
    assert np.all(orders > 1.8), orders
    assert errors[-1] < 5e-4


def test_a_fast_memory_pole_does_not_limit_the_step_nor_lose_its_steady_value() -> None:
    # K = s exp(-s t) with s h = 50 acts like a dashpot of 1: the motion is that of the damped oscillator
    fast = 500.0
    memory = StateSpaceMemory(np.array([-fast + 0j]), np.array([[1.0 + 0j]]), np.array([[fast + 0j]]), np.zeros((1, 1)))
    model = CumminsModel(np.eye(1), np.eye(1), np.zeros((1, 1)), memory, modes=("heave",))
    roots = np.roots([1.0 / fast, 1.0, 1.0 + 1.0 / fast, 1.0])
    start = np.linalg.solve(np.vander(roots, 3, increasing=True).T, np.array([1.0, 0.0, -1.0], dtype=complex))
    exact = np.real(np.exp(roots * 5.0) @ start)
    errors = []
    for step in (0.1, 0.05, 0.025):
        run = simulate(model, CalmWater(np.zeros(1)), duration=5.0, time_step=step, initial_position=[1.0])
        assert run.status == "converged"
        errors.append(abs(run.position[-1, 0] - exact))
    # h |pole| is 50, 25, 12.5: a stiff state costs order, as theory says, but neither stability nor convergence
    assert errors[0] < 5e-3 and errors[2] < 0.6 * errors[1] < 0.36 * errors[0]


def test_exponential_weights_are_the_closed_forms_and_their_limits() -> None:
    poles = np.array([-3.0 + 2.0j, -1e-9 + 0j, -40.0 + 0j])
    half, full, weight, f1, f2, f3 = exponential_weights(poles, 0.5)
    x = poles * 0.5
    assert np.allclose(half**2, full)
    assert np.allclose((f1 + 4 * f2 * 0 + 0 * f3)[1], 0.5 / 6.0, atol=1e-12)
    assert np.allclose((2 * f2)[1], 0.5 / 3.0 * 1.0, atol=1e-12)
    exact = 0.5 * (-4 - x + np.exp(x) * (4 - 3 * x + x**2)) / x**3
    assert np.allclose(f1[[0, 2]], exact[[0, 2]], rtol=1e-11)
    # A constant input must be integrated exactly: f1 + 4 f2 + f3 = (exp(x) - 1) / x
    assert np.allclose(f1 + 4 * f2 + f3, np.where(abs(x) > 1e-6, 0.5 * (np.exp(x) - 1) / x, 0.5), rtol=1e-10)
    assert np.allclose(weight[0], 0.5 * (np.exp(x[0] / 2) - 1) / x[0])


@pytest.mark.parametrize("seed", range(3))
def test_energy_is_kept_without_damping_and_memory(seed: int) -> None:
    rng = np.random.default_rng(seed)
    inertia, stiffness = positive_definite(rng, 3, 2.0), positive_definite(rng, 3, 3.0)
    model = CumminsModel(inertia, stiffness, np.zeros((3, 3)), StateSpaceMemory.none(3))
    top = np.sqrt(np.max(np.linalg.eigvals(np.linalg.solve(inertia, stiffness)).real))
    run = simulate(
        model, CALM, duration=100.0, time_step=0.05 / top, initial_position=rng.normal(size=3), save_interval=1.0
    )
    kinetic = 0.5 * np.einsum("ni,ij,nj->n", run.velocity, inertia, run.velocity)
    potential = 0.5 * np.einsum("ni,ij,nj->n", run.position, stiffness, run.position)
    total = kinetic + potential
    assert np.max(np.abs(total / total[0] - 1.0)) < 1e-5


@pytest.mark.parametrize("seed", range(4))
def test_regular_waves_reproduce_the_frequency_domain(seed: int) -> None:
    rng = np.random.default_rng(seed)
    memory, infinite = random_memory(rng), positive_definite(rng, 3)
    omega = np.linspace(0.5, 3.0, 11)
    hydro = hydrodynamics_of(memory, infinite, omega, rng)
    mass, stiffness, damping = (
        positive_definite(rng, 3, 2.0),
        positive_definite(rng, 3, 4.0),
        positive_definite(rng, 3, 0.6),
    )
    motions = solve_motions(hydro, mass, stiffness, damping=LinearDamping(damping, np.zeros(3)))
    model = CumminsModel(mass + infinite, stiffness, damping, memory)
    for index in (2, 7):
        period = 2 * np.pi / omega[index]
        wave = RegularForcing(
            omega[index], 0.7, hydro.excitation_force[index, 0], np.zeros(3), np.zeros(3), ramp=4 * period
        )
        run = simulate(model, wave, duration=60 * period)
        fitted = fit_last_periods(run.time, run.position, omega[index], periods=10)
        expected = 0.7 * motions.displacement[index, 0]
        assert np.max(np.abs(fitted.first - expected)) < 1e-4 * np.max(np.abs(expected))
        assert np.max(fitted.residual) < 1e-3 * np.max(np.abs(expected))


def test_irregular_waves_have_the_linear_response_variance() -> None:
    rng = np.random.default_rng(5)
    memory, infinite = random_memory(rng), positive_definite(rng, 3)
    spacing = 2 * np.pi / 1200.0
    omega = spacing * np.arange(100, 500)
    hydro = hydrodynamics_of(memory, infinite, omega, rng)
    mass, stiffness = positive_definite(rng, 3, 2.0), positive_definite(rng, 3, 4.0)
    damping = positive_definite(rng, 3, 0.5)
    motions = solve_motions(hydro, mass, stiffness, damping=LinearDamping(damping, np.zeros(3)))
    amplitude = 0.02 * np.exp(-(((omega - 1.2) / 0.4) ** 2)) * np.exp(2j * np.pi * rng.uniform(size=omega.size))
    wave = IrregularForcing(
        omega, amplitude, hydro.excitation_at(omega), None, np.zeros(3), drift_law="none", ramp=20.0
    )
    run = simulate(CumminsModel(mass + infinite, stiffness, damping, memory), wave, duration=1500.0)
    # One whole repetition: the sum of the components' variances is exact
    last = run.time > run.time[-1] - 1200.0 + 1e-9
    expected = np.sqrt(0.5 * np.sum(np.abs(amplitude[:, None] * motions.displacement[:, 0]) ** 2, axis=0))
    assert np.allclose(np.std(run.position[last], axis=0), expected, rtol=1e-3)
    assert np.isclose(np.std(run.elevation[last]), np.sqrt(0.5 * np.sum(np.abs(amplitude) ** 2)), rtol=1e-6)


def test_sum_of_components_by_transform_and_directly() -> None:
    rng = np.random.default_rng(2)
    step, length = 0.05, 4000
    omega = 2 * np.pi / (length * step) * rng.choice(np.arange(5, 300), 60)
    amplitude = rng.normal(size=(60, 2)) + 1j * rng.normal(size=(60, 2))
    time = step * np.arange(5000)
    exact = np.exp(-1j * np.outer(time, omega)) @ amplitude
    assert np.max(np.abs(complex_sum(omega, amplitude, step, 5000) - exact)) < 1e-8
    scattered = np.sort(rng.uniform(0.3, 3.0, 60))
    exact = np.exp(-1j * np.outer(time, scattered)) @ amplitude
    assert np.max(np.abs(complex_sum(scattered, amplitude, step, 5000) - exact)) < 1e-8


@pytest.mark.parametrize(("grid", "count"), [(4000, 5000), (4000, 3700), (400_000, 900), (610, 700), (None, 500)])
def test_real_sum_with_slow_products_is_that_of_the_components(grid: int | None, count: int) -> None:
    """By one transform, in a window, near the highest frequency of the grid, and directly."""
    rng = np.random.default_rng(5)
    step = 0.05
    omega = np.sort(rng.uniform(0.3, 3.0, 60))
    if grid is not None:
        # several components on a frequency, as in a sea of many headings
        omega = 2 * np.pi / (grid * step) * rng.choice(np.arange(5, 305), 60)
    drawn = rng.normal(size=(60, 5, 2)) @ [1.0, 1j]
    amplitude, first, second = drawn[:, :2], drawn[:, 2:4], drawn[:, 4:]
    waves = np.exp(-1j * np.outer(step * np.arange(count), omega))
    exact = (waves @ amplitude + (waves @ first) * (waves @ second).conj()).real
    found = real_sum(omega, amplitude, step, count, (first, second))
    assert np.max(np.abs(found - exact)) < 1e-9 * np.max(np.abs(exact))
    plain = real_sum(omega, amplitude, step, count)
    assert np.max(np.abs(plain - (waves @ amplitude).real)) < 1e-9 * np.max(np.abs(exact))


@pytest.mark.parametrize("law", ["newman", "newman_product"])
def test_newman_drift_equals_its_double_sum(law: str) -> None:
    rng = np.random.default_rng(8)
    omega = 2 * np.pi / 300.0 * np.arange(30, 60)
    amplitude = rng.normal(size=30) + 1j * rng.normal(size=30)
    drift = np.column_stack([rng.uniform(0.1, 2.0, 30), np.zeros(30), -rng.uniform(0.1, 1.0, 30)])
    if law == "newman":
        drift[:, 2] = rng.normal(size=30)
    forcing = IrregularForcing(omega, amplitude, np.zeros((30, 3)), drift, np.zeros(3), drift_law=law)  # type: ignore[arg-type]
    step = forcing.fitted_step(0.2)
    force, _ = forcing.sample(0.5 * step, 2000)
    time = 0.5 * step * np.arange(2000)
    waves = amplitude[:, None] * np.exp(-1j * np.outer(omega, time))
    for mode in range(3):
        if law == "newman":
            pairs = 0.5 * (drift[:, None, mode] + drift[None, :, mode])
        else:
            pairs = np.sign(drift[0, mode]) * np.sqrt(np.abs(drift[:, None, mode] * drift[None, :, mode]))
        expected = np.einsum("it,ij,jt->t", waves, pairs, waves.conj()).real
        assert np.allclose(force[:, mode], expected, atol=1e-9 * np.abs(expected).max() + 1e-12)
    assert np.allclose(forcing.mean_drift(), np.abs(amplitude) ** 2 @ drift)


def test_forces_ramp_from_zero_and_the_ramp_is_smooth() -> None:
    time = np.linspace(0.0, 10.0, 1001)
    ramp = cosine_ramp(time, 5.0)
    assert ramp[0] == 0.0 and np.all(ramp[500:] == 1.0)
    assert np.max(np.abs(np.diff(ramp, 2))) < 1.1 * 0.5 * (np.pi / 5.0) ** 2 * 1e-4
    assert np.all(cosine_ramp(time, 0.0) == 1.0)


def test_a_diverging_run_returns_its_last_good_rows() -> None:
    model = CumminsModel(np.eye(1), -25.0 * np.eye(1), np.zeros((1, 1)), StateSpaceMemory.none(1), modes=("roll",))
    run = simulate(model, CalmWater(np.ones(1)), duration=100.0, time_step=0.05, motion_limit=[10.0])
    assert run.status == "diverged"
    assert "grew" in run.message
    assert np.all(np.abs(run.position) <= 10.0)
    assert 0.2 < run.time[-1] < 2.0 and len(run.time) == len(run.position) == len(run.elevation)


def test_an_interrupt_returns_what_is_there() -> None:
    def impatient(what: str, done: float, total: float) -> None:
        if done > 20.0:
            raise KeyboardInterrupt

    run = simulate(
        _random_model(0), CALM, duration=1e5, time_step=0.1, initial_position=[1.0, 0.0, 0.0], progress=impatient
    )
    assert run.status == "interrupted"
    assert 20.0 < run.time[-1] < 1e5
    assert np.all(np.isfinite(run.position))


def test_save_interval_keeps_the_same_rows() -> None:
    model = _random_model(1)
    every = simulate(model, CALM, duration=10.0, time_step=0.1, initial_position=[1.0, 0.0, 0.0])
    some = simulate(model, CALM, duration=10.0, time_step=0.1, initial_position=[1.0, 0.0, 0.0], save_interval=0.5)
    assert np.array_equal(every.position[::5], some.position)
    assert np.allclose(every.time[::5], some.time)


def test_time_step_says_what_decides_and_is_stable() -> None:
    slow = RegularForcing(0.01, 1.0, np.zeros(3, complex), np.zeros(3), np.zeros(3))
    stiff = CumminsModel(np.eye(3), np.diag([900.0, 1.0, 1.0]), 0.1 * np.eye(3), StateSpaceMemory.none(3))
    step, notice = choose_time_step(stiff, slow)
    assert "natural period" in notice.message and step == pytest.approx(2 * np.pi / 30.0 / 24.0, rel=1e-3)
    soft = CumminsModel(np.eye(3), 0.01 * np.eye(3), 20.0 * np.eye(3), StateSpaceMemory.none(3))
    assert "damping" in choose_time_step(soft, slow)[1].message
    rng = np.random.default_rng(4)
    remembering = CumminsModel(np.eye(3), 1e-3 * np.eye(3), np.zeros((3, 3)), random_memory(rng))
    assert "memory" in choose_time_step(remembering, slow)[1].message
    for model in (stiff, soft, remembering):
        run = simulate(model, CALM, duration=100.0, initial_position=[1.0, 1.0, 1.0])
        assert run.status == "converged" and np.max(np.abs(run.position)) < 1.5
    fast = RegularForcing(50.0, 1.0, np.zeros(3, complex), np.zeros(3), np.zeros(3))
    step, notice = choose_time_step(remembering, fast)
    assert "periods of the waves" in notice.message
    assert np.isclose(2 * np.pi / 50.0 / step, 40.0)


def test_quadratic_damping_in_time_takes_the_equal_work_of_its_linear_equivalent() -> None:
    # Single mode at resonance: b = 8/(3 pi) w a b2 balances the force, to the small third harmonic
    quadratic = QuadraticDamping.of_modes([0.8])
    model = CumminsModel(
        np.eye(1), np.eye(1), 1e-3 * np.eye(1), StateSpaceMemory.none(1), quadratic=quadratic, modes=("roll",)
    )
    wave = RegularForcing(1.0, 1.0, np.array([0.01 + 0j]), np.zeros(1), np.zeros(1), ramp=30.0)
    run = simulate(model, wave, duration=2000.0)
    amplitude = abs(fit_last_periods(run.time, run.position[:, 0], 1.0, periods=10).first)
    equivalent = 1e-3 + 8.0 / (3.0 * np.pi) * 0.8 * amplitude
    assert abs(equivalent * amplitude / 0.01 - 1.0) < 2e-3


def test_stochastic_linearisation_of_quadratic_damping_under_white_noise() -> None:
    """A light oscillator under white noise S of its force: sigma_v^2 = pi S / (2 B m), B = sqrt(8/pi) b sigma_v."""
    omega, quadratic = np.linspace(0.02, 12.0, 6000), 0.01
    ones = np.ones((6000, 1, 1))
    hydro = Hydrodynamics(omega, 0.0 * ones, 0.0 * ones, ones.astype(complex), np.zeros(1), ("roll",))
    density = 1e-4
    sea = linearised_in_sea(
        hydro, [[1.0]], [[1.0]], np.full(6000, density), quadratic=QuadraticDamping.of_modes([quadratic])
    )
    exact = (math.pi * density / (2.0 * math.sqrt(8.0 / math.pi) * quadratic)) ** (1.0 / 3.0)
    assert float(sea.measure_deviation[0]) == pytest.approx(exact, rel=1e-3)


@pytest.mark.slow
def test_stochastic_linearisation_against_a_long_simulation_with_its_known_bias() -> None:
    """Quadratic damping alone under white noise: the Fokker-Planck equation is solved exactly for light damping.

    Energy has the density exp(-k E^(3/2)); its mean is Gamma(4/3)/Gamma(2/3) k^(-2/3), against that of the equivalent
    linear damping the standard deviation is larger by 2.2 %.
    """
    rng = np.random.default_rng(12)
    repeat = 150000.0
    spacing = 2 * np.pi / repeat
    omega = spacing * np.arange(int(0.3 / spacing), int(2.5 / spacing))
    density = 0.004
    amplitude = math.sqrt(2 * density * spacing) * np.exp(2j * np.pi * rng.uniform(size=omega.size))
    quadratic = QuadraticDamping.of_modes([0.12])
    coarse = np.linspace(omega[0], omega[-1], 2000)
    hydro = Hydrodynamics(
        coarse,
        np.zeros((2000, 1, 1)),
        np.zeros((2000, 1, 1)),
        np.ones((2000, 1, 1), dtype=complex),
        np.zeros(1),
        ("roll",),
    )
    sea = linearised_in_sea(hydro, [[1.0]], [[1.0]], np.full(2000, density), quadratic=quadratic)
    model = CumminsModel(
        np.eye(1), np.eye(1), np.zeros((1, 1)), StateSpaceMemory.none(1), quadratic=quadratic, modes=("roll",)
    )
    wave = IrregularForcing(
        omega, amplitude, np.ones((omega.size, 1), complex), None, np.zeros(1), drift_law="none", ramp=50.0
    )
    run = simulate(model, wave, duration=repeat)
    simulated = float(np.std(run.velocity[run.time > 500.0]))
    mean_energy = math.gamma(4 / 3) / math.gamma(2 / 3) * (9 * math.pi / (8 * 2**1.5)) ** (2 / 3)
    bias = math.sqrt(mean_energy / (8 / math.pi) ** (-1 / 3))
    assert bias == pytest.approx(1.0221, abs=1e-3)
    # Sampling error of some 3000 independent swings: 1 %
    assert simulated / float(sea.measure_deviation[0]) == pytest.approx(bias, abs=0.015)
