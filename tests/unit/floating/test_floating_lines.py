"""Lines seen from the rest position, the drift loop, and the sea as a forcing."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping, QuadraticDamping
from moyai.floating.drift import DriftProblem, solve_with_drift
from moyai.floating.far_field import drift_force_per_amplitude_squared, energy_check
from moyai.floating.forcing import IrregularForcing, RegularForcing
from moyai.floating.lines import PlanarMooring
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.offset import LinearMooring
from moyai.floating.time import CumminsModel, simulate
from moyai.mooring.catenary import solve_catenary
from moyai.mooring.lines import Line, LineType, Segment, SpringLine
from moyai.mooring.system import LineSystem
from moyai.potential.rectangle import solve_rectangle
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.series.harmonics import fit_last_periods


def _system(rng: np.random.Generator) -> LineSystem:
    chain = LineType("chain", submerged_weight=rng.uniform(300.0, 900.0), axial_stiffness=rng.uniform(1e7, 4e8))
    side = [
        Line(
            f"line {number}",
            anchor=(direction * rng.uniform(40.0, 50.0), rng.uniform(-8.0, 8.0), -12.0),
            fairlead=(direction * rng.uniform(3.0, 5.0), rng.uniform(-3.0, 3.0), rng.uniform(-1.0, 1.0)),
            segments=(Segment(chain, rng.uniform(48.0, 52.0)),),
            count=number + 1,
        )
        for number, direction in enumerate((-1.0, 1.0))
    ]
    spring = SpringLine("spring", (-30.0, 0.0, -2.0), (-4.0, 0.0, 0.5), stiffness=2e4, pretension=5e4)
    return LineSystem((*side, spring), 12.0)


@pytest.mark.parametrize("seed", [0, 2, 3, 4, pytest.param(1, marks=pytest.mark.slow)])
def test_exact_and_compiled_lines_agree_about_an_offset_heeled_body(seed: int) -> None:
    rng = np.random.default_rng(seed)
    system = _system(rng)
    rest, centre = (rng.uniform(-0.5, 0.5), rng.uniform(-2.0, -0.5), rng.uniform(-0.1, 0.1)), (0.3, 0.6)
    exact = PlanarMooring.of(system, rest=rest, centre=centre)
    tabulated = PlanarMooring.of(system, rest=rest, centre=centre, motion_range=(1.0, 1.0, 0.15), tolerance=1e-5)
    motion = rng.uniform(-1.0, 1.0, (40, 3)) * [0.9, 0.9, 0.14]
    force = exact.force(motion)
    scale = np.abs(force).max(axis=0)
    for mooring in (exact, tabulated):
        compiled, tension = mooring.force_and_tension(motion)
        assert np.allclose(compiled / scale, force / scale, atol=1e-4)
        states = mooring.states(motion)
        assert np.allclose(tension[:, 0], states["line 0"].tension_fairlead, rtol=1e-4)
    # The tangent of the exact force, one motion
    step = np.diag([1e-4, 1e-4, 1e-5])
    numeric = np.array([(exact.force(motion[0] + h) - exact.force(motion[0] - h)) / (2 * h.max()) for h in step]).T
    assert np.allclose(exact.stiffness(motion[0]), -numeric, rtol=1e-4, atol=1e-5 * np.abs(numeric).max())


def test_force_is_that_of_a_hand_made_catenary() -> None:
    chain = LineType("chain", submerged_weight=500.0, axial_stiffness=1e8)
    system = LineSystem((Line("one", (50.0, 0.0, -10.0), (4.0, 0.0, -1.0), (Segment(chain, 50.0),)),), 10.0)
    mooring = PlanarMooring.of(system, rest=(0.0, -0.5, 0.0), centre=(0.0, -0.5))
    sway, heave, roll = 0.7, -0.2, 0.1
    lever = np.array([4.0, -0.5])
    turned = np.array(
        [lever[0] * math.cos(roll) + lever[1] * math.sin(roll), -lever[0] * math.sin(roll) + lever[1] * math.cos(roll)]
    )
    point = np.array([sway, -0.5 + heave]) + turned
    line = solve_catenary(50.0 - point[0], point[1] + 10.0, 50.0, 1e8, 500.0)
    horizontal, vertical = float(line.horizontal_tension), -float(line.vertical_tension_fairlead)
    expected = [horizontal, vertical, horizontal * turned[1] - vertical * turned[0]]
    assert np.allclose(mooring.force([sway, heave, roll]), expected, rtol=1e-9)
    with pytest.raises(InputError):
        PlanarMooring.of(system, rest=(0.0, 0.0, 0.0), centre=(0.0, 0.0), motion_range=(1.0, 0.0, 0.1))


@pytest.fixture(scope="module")
def random_section() -> tuple[Hydrodynamics, np.ndarray, np.ndarray, Water]:
    """A rectangle of random size in water of random depth, fully coupled by an off-centre centre of gravity."""
    rng = np.random.default_rng(77)
    water = Water(depth=rng.uniform(8.0, 20.0), density=1025.0, gravity=9.81)
    beam, draught, length = rng.uniform(4.0, 9.0), rng.uniform(1.0, 3.0), rng.uniform(10.0, 30.0)
    centre = (0.3, -0.4 * draught)
    solution = solve_rectangle(beam, draught, water, np.linspace(0.4, 2.6, 40), centre=centre)
    hydro = Hydrodynamics.from_dataset(solution.dataset).scaled_to(length)
    mass = water.density * beam * draught * length
    inertia = np.diag([mass, mass, mass * (0.35 * beam) ** 2])
    weight = water.density * water.gravity * length
    restoring = weight * np.array(
        [[0, 0, 0], [0, beam, 0.3 * beam], [0, 0.3 * beam, beam**3 / 12 + 0.09 * beam - 0.1 * beam * draught**2]]
    )
    return hydro, inertia, restoring, water


@pytest.mark.slow
def test_energy_of_a_random_coupled_section(
    random_section: tuple[Hydrodynamics, np.ndarray, np.ndarray, Water],
) -> None:
    hydro, inertia, restoring, water = random_section
    mooring = LinearMooring(np.diag([2e4, 1e4, 1e5]))
    problem = DriftProblem(
        hydro,
        inertia,
        restoring,
        mooring,
        water,
        damping=LinearDamping(1e3 * np.array([[5, 1, 0], [1, 8, 2], [0, 2, 40.0]]), np.array([0.02, 0.0, 0.1])),
        quadratic=QuadraticDamping.of_modes([0.0, 0.0, 1e5]),
    )
    found = solve_with_drift(problem, 0.4)
    assert set(found.status) == {"converged"}
    assert energy_check(found.far, found.motions, water, hydro.length, tolerance=1e-8).passed
    force = 0.16 * drift_force_per_amplitude_squared(found.far, hydro.omega, hydro.heading, water, hydro.length)[:, 0]
    assert np.allclose(found.drift_force, force, rtol=1e-8)
    total = restoring + mooring.matrix
    expected = np.linalg.solve(total, np.stack([force, 0 * force, 0 * force]))
    assert np.allclose(found.offset, expected.T, rtol=1e-6, atol=1e-12)
    # every wave as if it came alone
    for number, frequency in enumerate(hydro.omega):
        alone = solve_with_drift(replace(problem, hydrodynamics=hydro.at(np.array([frequency]))), 0.4)
        assert np.allclose(alone.motions.displacement[0], found.motions.displacement[number], rtol=1e-8, atol=1e-12)
        assert alone.drift_force[0] == pytest.approx(found.drift_force[number], rel=1e-8)
        assert alone.iterations[0] == found.iterations[number]
    linear = solve_with_drift(replace(problem, quadratic=None), 0.4)
    assert (linear.motions.wave_amplitude == 0.4).all() and linear.motions.wave_amplitude.shape == (len(hydro.omega), 1)


def test_sea_as_forcing_has_the_surface_of_the_sea(
    random_section: tuple[Hydrodynamics, np.ndarray, np.ndarray, Water],
) -> None:
    hydro, _, _, water = random_section
    sea = synthesise(jonswap(1.0, 5.0, 3.3), water, duration=600.0, seed=3)
    forcing = IrregularForcing.of_sea(sea, hydro, drift_law="none")
    step = forcing.fitted_step(0.2)
    force, elevation = forcing.sample(0.5 * step, 500)
    time = 0.5 * step * np.arange(500)
    assert np.allclose(elevation, sea.elevation(time), atol=1e-9)
    exact = (hydro.excitation_at(sea.omega) * sea.complex_amplitude[:, None]).T @ np.exp(
        -1j * np.outer(sea.omega, time)
    )
    assert np.allclose(force, exact.real.T, atol=1e-9 * np.abs(exact).max())


def test_body_on_nonlinear_lines_rests_where_statics_says() -> None:
    rng = np.random.default_rng(3)
    system = _system(rng)
    mooring = PlanarMooring.of(system, rest=(0.0, -1.0, 0.0), centre=(0.0, 0.2), motion_range=(2.0, 1.0, 0.2))
    restoring = np.diag([0.0, 4e5, 3e6])
    model = CumminsModel(
        np.diag([2e5, 3e5, 2e6]), restoring, np.diag([8e4, 2e5, 2e6]), StateSpaceMemory.none(3), mooring=mooring
    )
    load = np.array([4e4, -1e4, 5e4])
    wave = RegularForcing(1.0, 0.0, np.zeros(3, complex), load, np.zeros(3), ramp=20.0)
    run = simulate(model, wave, duration=400.0, expected_motion=[1.0, 0.1, 0.05])
    end = run.position[-1]
    balance = mooring.force(end) - mooring.force(np.zeros(3)) - restoring @ end + load
    assert np.max(np.abs(balance)) < 2e-4 * np.max(np.abs(load))
    assert np.ptp(fit_last_periods(run.time, run.position, 1.0, periods=5).amplitude.real) < 1e-4
