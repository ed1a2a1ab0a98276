"""Linear motions, linearisation, modes and statistics against independent solutions of random bodies."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from floating_samples import hydrodynamics_of, positive_definite, random_memory

from moyai.core.errors import InputError
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping, QuadraticDamping, critical_damping
from moyai.floating.decay import fit_decay
from moyai.floating.frequency import relative_elevation, solve_motions
from moyai.floating.irregular import (
    energy_transmission,
    integration_weights,
    linearised_in_sea,
    response_statistics,
)
from moyai.floating.modes import natural_modes
from moyai.floating.offset import LinearMooring, mean_offset
from moyai.series.harmonics import fit_last_periods


def _body(seed: int, headings: int = 1, size: int = 3) -> tuple[Hydrodynamics, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    memory, infinite = random_memory(rng, size), positive_definite(rng, size)
    hydro = hydrodynamics_of(memory, infinite, np.linspace(0.3, 4.0, 60), rng, headings)
    return hydro, positive_definite(rng, size, 2.0), positive_definite(rng, size, 4.0)


@pytest.mark.parametrize(("seed", "size"), [(0, 3), (1, 3), (2, 6), (3, 1), (4, 12)])
def test_motion_satisfies_the_real_equations_of_both_phases(seed: int, size: int) -> None:
    hydro, mass, stiffness = _body(seed, 2, size)
    damping = LinearDamping.of_modes(linear=np.full(size, 0.2), critical_fraction=np.full(size, 0.1))
    motions = solve_motions(hydro, mass, stiffness, damping=damping)
    for n in (0, 17, 59):
        w = hydro.omega[n]
        inertia = mass + hydro.added_mass[n]
        extra = damping.at(mass, hydro.added_mass[n], stiffness)
        # x = Re(X e^{-iwt}): quarter phases of inertia x'' + b x' + K x = Re(F e^{-iwt})
        for h in range(2):
            x = motions.displacement[n, h]
            for phase in (0.0, 0.7, 2.1):
                turn = np.exp(-1j * phase)
                position, velocity, acceleration = (x * turn).real, (-1j * w * x * turn).real, (-(w**2) * x * turn).real
                left = inertia @ acceleration + (hydro.radiation_damping[n] + extra) @ velocity + stiffness @ position
                assert np.allclose(left, (hydro.excitation_force[n, h] * turn).real, atol=1e-9)


def test_units_do_not_change_the_answer() -> None:
    hydro, mass, stiffness = _body(5)
    scale = np.array([1.0, 1.0, 1e6])
    square = np.outer(scale, scale)
    other = Hydrodynamics(
        hydro.omega,
        hydro.added_mass * square,
        hydro.radiation_damping * square,
        hydro.excitation_force * scale,
        hydro.heading,
        hydro.modes,
    )
    a = solve_motions(hydro, mass, stiffness).displacement
    b = solve_motions(other, mass * square, stiffness * square).displacement * scale
    assert np.allclose(a, b, rtol=1e-9)


def test_undamped_resonance_is_named_not_hidden() -> None:
    hydro = Hydrodynamics(
        np.array([0.5, 1.0, 2.0]),
        np.zeros((3, 1, 1)),
        np.zeros((3, 1, 1)),
        np.ones((3, 1, 1), complex),
        np.zeros(1),
        ("heave",),
    )
    motions = solve_motions(hydro, [[4.0]], [[4.0]])
    assert np.isnan(motions.displacement[1, 0, 0]) and np.isfinite(motions.displacement[[0, 2]]).all()
    assert [notice.code for notice in motions.notices] == ["motion-singular"]
    quadratic = QuadraticDamping.of_modes([2.0])
    tamed = solve_motions(hydro, [[4.0]], [[4.0]], quadratic=quadratic, wave_amplitude=0.3)
    # At resonance 8/(3 pi) b2 (w a)^2 = F a_wave
    velocity = 0.3 * abs(tamed.displacement[1, 0, 0])
    assert 8 / (3 * math.pi) * 2.0 * velocity**2 == pytest.approx(0.3, rel=1e-6)


def test_critical_damping_is_critical() -> None:
    mass, added, stiffness = np.diag([2.0, 3.0]), np.diag([1.0, 0.5]), np.diag([7.0, 0.0])
    critical = critical_damping(mass, added, stiffness)
    assert np.roots([3.0, critical[0], 7.0]) == pytest.approx([-math.sqrt(7 / 3)] * 2, rel=1e-6)
    assert critical[1] == 0.0
    with pytest.raises(InputError):
        LinearDamping.of_modes(critical_fraction=[-0.1, 0.0])


@pytest.mark.parametrize("seed", range(4))
def test_equal_work_and_least_squares_of_the_quadratic_force(seed: int) -> None:
    rng = np.random.default_rng(seed)
    quadratic = QuadraticDamping(rng.normal(size=(2, 3)), rng.uniform(0.2, 2.0, 2))
    # Work over a cycle, along a motion in one phase so that each measure is a plain sine
    direction, phase = rng.normal(size=3), np.linspace(0.0, 2 * np.pi, 4001)
    velocity = np.cos(phase)[:, None] * direction
    work = -np.trapezoid([quadratic.force(v) @ v for v in velocity], phase)
    linear = quadratic.equivalent_regular(np.abs(quadratic.directions @ direction))
    assert work == pytest.approx(np.trapezoid([v @ linear @ v for v in velocity], phase), rel=1e-6)
    # Gaussian: b = E[|s| s^2] / E[s^2] by quadrature
    sigma = rng.uniform(0.1, 3.0)
    s = np.linspace(-8, 8, 20001) * sigma
    density = np.exp(-0.5 * (s / sigma) ** 2)
    expected = np.trapezoid(np.abs(s) * s**2 * density, s) / np.trapezoid(s**2 * density, s)
    one = QuadraticDamping.of_modes([1.0])
    assert one.equivalent_irregular(np.array([sigma]))[0, 0] == pytest.approx(expected, rel=1e-6)


def test_linearisation_is_a_fixed_point_for_all_waves() -> None:
    hydro, mass, stiffness = _body(7, 2)
    quadratic = QuadraticDamping.of_modes([0.0, 0.5, 3.0])
    motions = solve_motions(hydro, mass, stiffness, quadratic=quadratic, wave_amplitude=0.8)
    velocity = 0.8 * np.abs(motions.velocity)
    expected = 8 / (3 * np.pi) * velocity * np.array([0.0, 0.5, 3.0])
    assert np.allclose(np.diagonal(motions.damping, axis1=-2, axis2=-1), expected, rtol=1e-6, atol=1e-9)
    assert motions.notices == ()
    hooked = solve_motions(
        hydro, mass, stiffness, wave_amplitude=0.8,
        line_damping=lambda v, w: quadratic.equivalent_regular(np.abs(quadratic.directions @ v)),
    )  # fmt: skip
    assert np.allclose(hooked.displacement, motions.displacement, rtol=1e-7)


@pytest.mark.parametrize("seed", range(5))
def test_natural_modes_solve_their_own_eigenproblem(seed: int) -> None:
    hydro, mass, stiffness = _body(20 + seed)
    found = natural_modes(hydro, mass, stiffness, damping=0.1 * np.eye(3))
    dense = hydro.at(np.sort(found.omega), hold=True)
    for j in range(3):
        assert hydro.omega[0] < found.omega[j] < hydro.omega[-1], "sample out of range"
        added = dense.added_mass[np.flatnonzero(dense.omega == found.omega[j])[0]]
        residual = (stiffness - found.omega[j] ** 2 * (mass + 0.5 * (added + added.T))) @ found.shape[j]
        assert np.max(np.abs(residual)) < 1e-8 * np.abs(stiffness).max()
        assert found.shape[j, j] == 1.0
        assert found.period[j] == pytest.approx(2 * np.pi / found.omega[j])


def test_modes_without_and_with_negative_restoring() -> None:
    hydro, mass, _ = _body(30)
    stiffness = np.diag([0.0, 2.0, 0.0])
    found = natural_modes(hydro, np.diag(np.diag(mass)), stiffness)
    assert np.isinf(found.period).sum() == 2 and np.isfinite(found.period).sum() == 1
    tipping = natural_modes(hydro, mass, np.diag([1.0, 2.0, -1.0]))
    assert np.isnan(tipping.period).sum() == 1


def test_response_statistics_of_known_spectra() -> None:
    omega = np.linspace(0.2, 3.0, 2801)
    density = np.exp(-0.5 * ((omega - 1.0) / 0.05) ** 2)
    statistics = response_statistics(omega, np.full(omega.size, 2.0 + 0j), density)
    variance = 4.0 * 0.05 * math.sqrt(2 * math.pi)
    assert statistics.significant == pytest.approx(4 * math.sqrt(variance), rel=1e-6)
    assert statistics.mean_zero_crossing_period == pytest.approx(2 * math.pi / math.sqrt(1 + 0.05**2), rel=1e-6)
    cycles = 3600 / float(statistics.mean_zero_crossing_period)
    assert statistics.most_probable_maximum(3600.0) == pytest.approx(math.sqrt(2 * variance * math.log(cycles)))
    assert statistics.most_probable_maximum(0.1) == 0.0
    # Two headings that share the energy
    split = response_statistics(omega, np.full((omega.size, 2), 2.0), np.column_stack([0.3 * density, 0.7 * density]))
    assert split.significant == pytest.approx(statistics.significant, rel=1e-12)


def test_energy_transmission_identities() -> None:
    rng = np.random.default_rng(0)
    omega = np.sort(rng.uniform(0.3, 3.0, 50))
    density = rng.uniform(0.0, 2.0, 50)
    assert energy_transmission(omega, np.full(50, 0.4 + 0.3j), density) == pytest.approx(0.5)
    reflection, transmission = rng.uniform(0, 1, 50), rng.uniform(0, 1, 50)
    loss = 1 - reflection**2 - transmission**2
    total = (
        energy_transmission(omega, reflection, density) ** 2 + energy_transmission(omega, transmission, density) ** 2
    )
    weights = integration_weights(omega) * density
    assert total + weights @ loss / weights.sum() == pytest.approx(1.0)
    with pytest.raises(InputError):
        energy_transmission(omega, transmission, np.zeros(50))


def test_stochastic_linearisation_is_a_fixed_point() -> None:
    hydro, mass, stiffness = _body(11)
    density = 0.5 * np.exp(-(((hydro.omega - 1.3) / 0.3) ** 2))
    quadratic = QuadraticDamping.of_modes([0.0, 0.0, 4.0])
    sea = linearised_in_sea(hydro, mass, stiffness, density, quadratic=quadratic)
    assert sea.converged
    again = response_statistics(hydro.omega, sea.motions.velocity[:, :, 2], density[:, None])
    assert sea.equivalent_damping[2, 2] == pytest.approx(
        math.sqrt(8 / math.pi) * 4.0 * float(again.standard_deviation), rel=1e-7
    )


def test_every_heading_is_linearised_with_its_own_radiation() -> None:
    """The order of the headings changes nothing, and a heading without energy has no say."""
    first, mass, stiffness = _body(11)
    second = replace(first, radiation_damping=3.0 * first.radiation_damping, added_mass=0.5 * first.added_mass)
    density = 0.5 * np.exp(-(((first.omega - 1.3) / 0.3) ** 2))
    quadratic = QuadraticDamping.of_modes([0.0, 0.0, 4.0])

    def found(parts: list[Hydrodynamics], shares: list[float]) -> float:
        spectrum = density[:, None] * np.array(shares)
        sea = linearised_in_sea(parts, mass, stiffness, spectrum, quadratic=quadratic)
        return float(sea.equivalent_damping[2, 2])

    assert found([first, second], [0.3, 0.7]) == pytest.approx(found([second, first], [0.7, 0.3]), rel=1e-9)
    assert found([second, first], [0.0, 1.0]) == pytest.approx(found([first], [1.0]), rel=1e-9)
    assert found([first, second], [0.0, 1.0]) != pytest.approx(found([first], [1.0]), rel=1e-2)


class HardeningLine:
    """A line along x whose force grows with the third power of the offset."""

    def force(self, position: np.ndarray) -> np.ndarray:
        return np.array([-(2.0 * position[0] + 50.0 * position[0] ** 3), 0.0, 0.0])

    def stiffness(self, position: np.ndarray) -> np.ndarray:
        return np.diag([2.0 + 150.0 * position[0] ** 2, 0.0, 0.0])


def test_mean_offset_of_springs_and_of_a_hardening_line() -> None:
    stiffness = np.array([[5.0, 0.0, -1.0], [0.0, 2.0, 0.0], [-1.0, 0.0, 3.0]])
    restoring = np.diag([0.0, 10.0, 4.0])
    load = np.array([1.0, -2.0, 0.5])
    found = mean_offset(LinearMooring(stiffness), restoring, load)
    assert np.allclose(found.position, np.linalg.solve(stiffness + restoring, load))
    found = mean_offset(HardeningLine(), restoring, np.array([40.0, 0.0, 0.0]))
    assert found.status == "converged"
    assert 2 * found.position[0] + 50 * found.position[0] ** 3 == pytest.approx(40.0)
    assert mean_offset(LinearMooring(np.zeros((3, 3))), restoring, load).status == "not_converged"


def test_harmonics_are_exact_at_any_step() -> None:
    rng = np.random.default_rng(1)
    omega, step = 1.7, 0.0613
    time = step * np.arange(3000)
    truth = rng.normal(size=3) + 1j * rng.normal(size=3)
    series = 0.4 + sum((truth[n] * np.exp(-1j * (n + 1) * omega * time)).real for n in range(3))
    found = fit_last_periods(time, series, omega, periods=12)
    assert np.allclose(found.amplitude, truth, atol=1e-12) and found.mean == pytest.approx(0.4)
    assert found.periods == 12 and found.residual < 1e-12
    with pytest.raises(InputError):
        fit_last_periods(time, series, omega, periods=10000)


@pytest.mark.parametrize(("ratio", "quadratic"), [(0.02, 0.0), (0.01, 0.15), (0.05, 0.05)])
def test_decay_gives_back_linear_and_quadratic_damping(ratio: float, quadratic: float) -> None:
    from scipy.integrate import solve_ivp

    def motion(_: float, y: np.ndarray) -> list[float]:
        return [y[1], -y[0] - 2 * ratio * y[1] - quadratic * abs(y[1]) * y[1]]

    time = np.linspace(0.0, 60.0, 6001)
    run = solve_ivp(motion, (0.0, 60.0), [0.4, 0.0], t_eval=time, rtol=1e-10, atol=1e-12)
    found = fit_decay(time, run.y[0] + 0.2, mean=0.2)
    assert found.period == pytest.approx(2 * math.pi / math.sqrt(1 - ratio**2), rel=2e-3)
    assert found.damping_ratio == pytest.approx(ratio, rel=0.03, abs=2e-4)
    assert found.quadratic_over_inertia == pytest.approx(quadratic, rel=0.04, abs=1e-3)


@pytest.mark.parametrize("rows", [9.2, 11.6])
def test_extremes_stand_between_the_rows_of_a_coarse_record(rows: float) -> None:
    """A few rows a period: the highest row alone lies up to 6 % below the extreme."""
    ratio = 0.02
    time = np.arange(0.0, 80.0, 2.0 * math.pi / rows)
    found = fit_decay(time, np.exp(-ratio * time) * np.cos(math.sqrt(1.0 - ratio**2) * time))
    assert found.period == pytest.approx(2.0 * math.pi / math.sqrt(1.0 - ratio**2), rel=5e-3)
    assert found.damping_ratio == pytest.approx(ratio, rel=0.05)
    assert abs(found.quadratic_over_inertia) < 2e-3


def test_points_move_with_the_body() -> None:
    hydro, mass, stiffness = _body(13)
    motions = solve_motions(hydro, mass, stiffness)
    centre, point = (0.1, -0.3), (2.0, 0.7)
    # Positive roll: a point on the +x side goes down
    vertical = motions.displacement[..., 1] - 1.9 * motions.displacement[..., 2]
    relative = relative_elevation(motions, point, centre, np.ones((60, 1), complex))
    assert np.allclose(relative, 1.0 - vertical)


def test_coefficients_interpolate_and_refuse() -> None:
    hydro, _, _ = _body(17, 2)
    middle = hydro.at([1.0, 2.0])
    rng = np.random.default_rng(17)
    memory, infinite = random_memory(rng), positive_definite(rng, 3)
    exact = hydrodynamics_of(memory, infinite, np.array([1.0, 2.0]), rng, 2)
    assert np.allclose(middle.added_mass, exact.added_mass, atol=2e-4)
    assert np.allclose(middle.radiation_damping, exact.radiation_damping, atol=2e-4)
    with pytest.raises(InputError, match="outside the computed range"):
        hydro.at([10.0])
    with pytest.raises(InputError, match="headings"):
        hydro.excitation_at([1.0], [2.0])
    between = hydro.excitation_at([1.0, 1.0, 1.0], [0.0, 0.25, 0.5])
    assert np.allclose(between[1], 0.5 * (between[0] + between[2]))
    assert np.allclose(hydro.scaled_to(3.0).excitation_force, 3.0 * hydro.excitation_force)
    with pytest.raises(InputError, match="not finite"):
        Hydrodynamics(
            hydro.omega,
            hydro.added_mass * np.nan,
            hydro.radiation_damping,
            hydro.excitation_force,
            hydro.heading,
            hydro.modes,
        )
