"""Floating bodies: the moored breakwater model of Nakamura, Ohmori and Ide, and exact motions.

Figures of the model were found by a prototype of other construction (matched eigenfunctions with 240 modes, elastic
catenary by its own root search, Newmark integration with a convolution); here the section is solved by the reference
solver of :mod:`moyai.potential.rectangle` and the lines by :mod:`moyai.mooring`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline
from scipy.linalg import expm

from moyai.core.validation import ValidationCase
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping, QuadraticDamping
from moyai.floating.drift import DriftedMotions, DriftProblem, solve_with_drift
from moyai.floating.far_field import dissipated_fraction
from moyai.floating.forcing import CalmWater, RegularForcing
from moyai.floating.frequency import Motions, solve_motions
from moyai.floating.lines import PlanarMooring
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.modes import natural_modes
from moyai.floating.statics import Hydrostatics, hydrostatics, inertia_matrix, righting_curve
from moyai.floating.time import CumminsModel, Simulation, simulate
from moyai.mooring.lines import Line, LineType, Segment
from moyai.mooring.system import LineSystem
from moyai.potential import shapes
from moyai.potential.damping_model import fit_damping
from moyai.potential.damping_tail import wall_sided_tails
from moyai.potential.memory import steady_damping
from moyai.potential.rectangle import solve_rectangle
from moyai.potential.state_space import fit_memory
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.series.harmonics import Harmonics, fit_last_periods

PROTOTYPE = "Nakamura, Ohmori and Ide, model, recomputed by an independent prototype"
WATER = Water(depth=0.38, density=1000.0, gravity=9.81)
BEAM, DRAUGHT, LENGTH, CENTRE_Z = 0.38, 0.113, 0.986, -0.027
MASS, GYRADIUS, WAVE_AMPLITUDE = 41.6, 0.101, 0.02
PERIODS = (0.60, 0.80, 0.85, 0.90, 0.95, 1.00, 1.10, 1.20, 1.40, 1.60)

WIDE = (0.001, *np.linspace(0.02, 0.08, 4), *np.linspace(0.1, 20.0, 100), *np.linspace(21.0, 60.0, 40))
"""Angular frequencies of the memory [rad/s]; beyond them the damping falls with the third power."""


@dataclass(frozen=True)
class PaperModel:
    """The moored model with a number of chains in total; totals of the 0.986 m long unit."""

    statics: Hydrostatics
    inertia: np.ndarray
    mooring: PlanarMooring

    @property
    def stiffness(self) -> np.ndarray:
        """Hydrostatic and mooring restoring at rest."""
        return self.statics.stiffness + self.mooring.stiffness(np.zeros(3))


@lru_cache(maxsize=8)
def paper_model(lines: int = 4) -> PaperModel:
    """Return the model moored by ``lines`` chains, half of them on each side."""
    section = shapes.rectangle(BEAM, 0.17).immersed(DRAUGHT)
    statics = hydrostatics(
        section, mass=MASS, centre_of_gravity=(0.0, CENTRE_Z), length=LENGTH, density=1000.0, gravity=9.81
    )
    chain = LineType("model chain", submerged_weight=0.1144 * 9.81, axial_stiffness=2.14e4)
    system = LineSystem(
        tuple(
            Line(
                name,
                anchor=(side * (0.5 * BEAM + 1.925), 0.0, -WATER.depth),
                fairlead=(side * 0.5 * BEAM, 0.0, 0.0),
                segments=(Segment(chain, 1.975),),
                count=lines // 2,
            )
            for name, side in (("offshore", -1.0), ("shore", 1.0))
        ),
        WATER.depth,
    )
    mooring = PlanarMooring.of(
        system,
        rest=(0.0, CENTRE_Z, 0.0),
        centre=(0.0, DRAUGHT + CENTRE_Z),
        motion_range=(0.06, 0.05, 0.3),
        tolerance=1e-4,
    )
    return PaperModel(statics, inertia_matrix(MASS, GYRADIUS), mooring)


@lru_cache(maxsize=16)
def paper_hydrodynamics(omega: tuple[float, ...]) -> Hydrodynamics:
    """Return the coefficients of the whole unit at the frequencies [rad/s]."""
    solution = solve_rectangle(BEAM, DRAUGHT, WATER, np.array(omega), centre=(0.0, CENTRE_Z))
    return Hydrodynamics.from_dataset(solution.dataset).scaled_to(LENGTH)


def period_grid(periods: tuple[float, ...] = PERIODS) -> tuple[float, ...]:
    """Return the angular frequencies of periods [s], increasing."""
    return tuple(sorted(2.0 * math.pi / period for period in periods))


@lru_cache(maxsize=1)
def paper_memory() -> StateSpaceMemory:
    """Return the memory of the section by the rational fit of its damping, with exact start and tails."""
    hydro = paper_hydrodynamics(WIDE)
    rates = LENGTH * steady_damping([0.0, BEAM, 0.0], WATER)
    tails = tuple(
        replace(tail, coefficients=tuple(LENGTH * item for item in tail.coefficients))
        for tail in wall_sided_tails(WATER, CENTRE_Z)
    )
    model = fit_damping(WIDE, hydro.radiation_damping, start="even", steady_damping=rates, tail_theory=tails)
    return StateSpaceMemory.of(fit_memory(model))


@lru_cache(maxsize=16)
def paper_drift(lines: int = 4, fraction: float = 0.15, with_drift: bool = True) -> DriftedMotions:
    """Return the motions with drift at :data:`PERIODS` (frequencies increasing), wave height 4 cm."""
    model = paper_model(lines)
    problem = DriftProblem(
        hydrodynamics=paper_hydrodynamics(period_grid()),
        inertia=model.inertia,
        hydrostatic_stiffness=model.statics.stiffness,
        mooring=model.mooring,
        water=WATER,
        damping=LinearDamping.of_modes(critical_fraction=[fraction] * 3),
    )
    return solve_with_drift(problem, WAVE_AMPLITUDE, with_drift=with_drift)


def row(period: float) -> int:
    """Return the row of a period of :data:`PERIODS` in the arrays of :func:`paper_drift`."""
    return int(np.argmin(np.abs(np.array(period_grid()) - 2.0 * math.pi / period)))


def motion_ratio(period: float, mode: int, lines: int = 4) -> float:
    """Return |x|/(H/2), |z|/(H/2) or |theta| B/H of the frequency domain with drift."""
    factor = (1.0, 1.0, 0.5 * BEAM)[mode]
    return float(factor * abs(paper_drift(lines).motions.displacement[row(period), 0, mode]))


@lru_cache(maxsize=32)
def paper_time(period: float, linear_mooring: bool = False, lines: int = 4) -> tuple[Simulation, Harmonics]:
    """Return the steady motion in time, mean drift from the frequency domain with the ramp of the wave."""
    model, hydro = paper_model(lines), paper_hydrodynamics(period_grid())
    index = row(period)
    damping = LinearDamping.of_modes(critical_fraction=[0.15] * 3)
    infinite = hydro.infinite_frequency_added_mass
    assert infinite is not None
    cummins = CumminsModel(
        inertia=model.inertia + infinite,
        stiffness=model.stiffness if linear_mooring else model.statics.stiffness,
        linear_damping=damping.at(model.inertia, hydro.added_mass[index], model.stiffness),
        memory=paper_memory(),
        mooring=None if linear_mooring else model.mooring,
    )
    drift = 0.0 if linear_mooring else float(paper_drift(lines).drift_force[index])
    wave = RegularForcing(
        omega=float(hydro.omega[index]),
        wave_amplitude=WAVE_AMPLITUDE,
        excitation_force=hydro.excitation_force[index, 0],
        mean_drift=np.array([drift, 0.0, 0.0]),
        steady=np.zeros(3),
        ramp=6.0 * period,
    )
    run = simulate(cummins, wave, duration=60.0 * period)
    return run, fit_last_periods(run.time, run.position, wave.omega, periods=10)


def time_ratio(period: float, mode: int) -> float:
    """Return the motion ratio of the time domain with nonlinear chains."""
    factor = (1.0, 1.0, 0.5 * BEAM)[mode]
    return float(factor * abs(paper_time(period)[1].first[mode]) / WAVE_AMPLITUDE)


def linear_time_error(period: float) -> float:
    """Return the largest difference of the time domain with linear mooring from the frequency domain, relative."""
    model, hydro = paper_model(), paper_hydrodynamics(period_grid())
    motions = solve_motions(
        hydro, model.inertia, model.stiffness, damping=LinearDamping.of_modes(critical_fraction=[0.15] * 3)
    )
    expected = WAVE_AMPLITUDE * motions.displacement[row(period), 0]
    found = paper_time(period, True)[1].first
    return float(np.max(np.abs(found - expected) / np.abs(expected)))


@lru_cache(maxsize=8)
def roll_peak(fraction: float, modes: tuple[int, int, int] = (1, 1, 1)) -> tuple[float, float, Motions]:
    """Return the peak of |theta| B/H, its L/B and the motions without drift."""
    omega = np.linspace(4.5, 10.5, 601)
    hydro = paper_hydrodynamics(tuple(np.linspace(4.0, 11.0, 60))).at(omega)
    model = paper_model()
    damping = LinearDamping.of_modes(critical_fraction=fraction * np.array(modes, dtype=float))
    motions = solve_motions(hydro, model.inertia, model.stiffness, damping=damping)
    ratio = 0.5 * BEAM * np.abs(motions.displacement[:, 0, 2])
    top = int(np.argmax(ratio))
    length = 2.0 * math.pi / float(wave_number(omega[top], WATER.depth, WATER.gravity))
    return float(ratio[top]), length / BEAM, motions


def energy_identity() -> float:
    """Return the largest |loss of the far field - work of the damping| of the model with drift."""
    found = paper_drift()
    work = dissipated_fraction(
        found.motions.omega, found.motions.heading, found.motions.velocity, found.motions.damping, WATER, LENGTH
    )
    return float(np.max(np.abs(found.far.loss - work)))


def free_decay_error(mode: int, softening: float = 1.0) -> float:
    """Return the largest difference of a free decay in time from its frequency integral, over the first position.

    The model heaves or rolls alone from rest, its hydrostatic restoring multiplied by ``softening``; the position is
    the Fourier integral of a rational function of added mass and damping, without memory functions or time steps. Slow
    heave lives on the damping of zero frequency, which the waves of a displaced volume leave in two dimensions.
    """
    omega = np.array(WIDE)
    hydro, model, memory = paper_hydrodynamics(WIDE), paper_model(), paper_memory()
    assert hydro.infinite_frequency_added_mass is not None
    infinite = float(hydro.infinite_frequency_added_mass[mode, mode])
    mass = float(model.inertia[mode, mode]) + infinite
    restoring = float(model.statics.stiffness[mode, mode]) * softening
    cummins = CumminsModel(
        np.array([[mass]]),
        np.array([[restoring]]),
        np.zeros((1, 1)),
        StateSpaceMemory(
            memory.poles, memory.inputs[:, [mode]].copy(), memory.outputs[[mode]].copy(), np.zeros((1, 1))
        ),
        modes=("alone",),
    )
    duration = min(6.0 * 2.0 * math.pi * math.sqrt(mass / restoring), 60.0)
    run = simulate(cummins, CalmWater(np.zeros(1)), duration=duration, initial_position=[1.0])
    fine = np.concatenate([np.linspace(1e-3, 2.0, 8001), np.linspace(2.0, 60.0, 16001)[1:]])
    added = CubicSpline(omega, hydro.added_mass[:, mode, mode])(fine)
    damping = CubicSpline(omega, hydro.radiation_damping[:, mode, mode])(fine)
    s = -1j * fine
    memory_transform = damping + s * (added - infinite)
    shape = ((mass * s + memory_transform) / (mass * s**2 + memory_transform * s + restoring)).real
    weight = np.zeros_like(fine)
    weight[:-1] += 0.5 * np.diff(fine)
    weight[1:] += 0.5 * np.diff(fine)
    weight[0] += fine[0]
    rows = np.linspace(0, len(run.time) - 1, 40).astype(int)[1:]
    exact = 2.0 / math.pi * np.cos(np.outer(run.time[rows], fine)) @ (weight * shape)
    return float(np.max(np.abs(run.position[rows, 0] - exact)))


def _natural_period(mode: int, lines: int, fixed: bool) -> float:
    model = paper_model(lines if lines else 4)
    stiffness = model.stiffness if lines else model.statics.stiffness
    omega = (2.0 * math.pi / 0.95,) if fixed else tuple(np.linspace(0.5, 12.0, 47))
    hydro = paper_hydrodynamics(omega)
    if not fixed:
        return float(natural_modes(hydro, model.inertia, stiffness).period[mode])
    # The prototype took each mode alone, with its added mass at T = 0.95 s
    mass = model.inertia[mode, mode] + hydro.added_mass[0, mode, mode]
    return 2.0 * math.pi * math.sqrt(mass / stiffness[mode, mode])


def _fixed_quantity(name: str, period: float) -> float:
    found, index = paper_drift(), row(period)
    values = {
        "reflection": abs(found.far.reflection_coefficient[index, 0]),
        "transmission": abs(found.far.transmission_coefficient[index, 0]),
        "loss": found.far.loss[index, 0],
        "drift coefficient": found.far.drift_coefficient[index, 0],
        "drift force": found.drift_force[index],
        "offset": 1e3 * found.offset[index, 0],
        "K11": found.mooring_stiffness[index, 0, 0],
    }
    return float(values[name])


def exact_linear_motion() -> float:
    """Return the error after 12 s of a coupled system with memory against the matrix exponential."""
    pole, size = -0.4 + 1.3j, 2
    inertia, stiffness = np.array([[2.0, 0.3], [0.3, 1.5]]), np.array([[3.0, -0.4], [-0.4, 5.0]])
    damping = np.array([[0.1, 0.02], [0.02, 0.2]])
    gain = np.array([0.8, -0.5])
    memory = StateSpaceMemory(
        np.array([pole]), gain[None, :].astype(complex), gain[:, None].astype(complex), np.zeros((2, 2))
    )
    matrix = np.zeros((2 * size + 2, 2 * size + 2))
    inverse = np.linalg.inv(inertia)
    matrix[:2, 2:4] = np.eye(2)
    matrix[2:4, :2], matrix[2:4, 2:4] = -inverse @ stiffness, -inverse @ damping
    matrix[2:4, 4] = -inverse @ gain
    matrix[4, 2:4] = gain
    matrix[4:, 4:] = [[pole.real, -pole.imag], [pole.imag, pole.real]]
    start = np.array([0.3, -0.2, 0.0, 0.5, 0.0, 0.0])
    exact = (expm(12.0 * matrix) @ start)[:2]
    model = CumminsModel(inertia, stiffness, damping, memory, modes=("a", "b"))
    run = simulate(
        model,
        CalmWater(np.zeros(2)),
        duration=12.0,
        time_step=0.02,
        initial_position=start[:2],
        initial_velocity=start[2:4],
    )
    return float(np.max(np.abs(run.position[-1] - exact)))


def _wall_sided_lever() -> float:
    heel = math.radians(12.0)
    curve = righting_curve(
        shapes.rectangle(6.0, 4.0),
        np.array([heel]),
        area=9.0,
        centre_of_gravity=(0.0, 1.2),
        draught_start=1.5,
    )
    return float(curve.lever[0])


def _quadratic_resonance() -> float:
    """Return 8/(3 pi) b2 (omega a)^2 over the exciting force at the resonance of an otherwise undamped mode."""
    hydro = Hydrodynamics(
        np.array([2.0]), np.zeros((1, 1, 1)), np.zeros((1, 1, 1)), np.ones((1, 1, 1), complex), np.zeros(1), ("roll",)
    )
    motions = solve_motions(hydro, [[1.0]], [[4.0]], quadratic=QuadraticDamping.of_modes([0.7]), wave_amplitude=0.4)
    velocity = 0.4 * abs(motions.velocity[0, 0, 0])
    return float(8.0 / (3.0 * math.pi) * 0.7 * velocity**2 / 0.4)


def _case(
    name: str, compute: object, reference: float, tolerance: float, note: str, relative: bool = True
) -> ValidationCase:
    return ValidationCase(f"floating: {name}", PROTOTYPE, compute, reference, tolerance, relative, note)  # type: ignore[arg-type]


_PRINTED = "half a unit of the last printed digit, and 0.3 % of the prototype's hydrodynamics"

CASES: tuple[ValidationCase, ...] = (
    _case("metacentric height of the model", lambda: paper_model().statics.metacentric_height, 0.0770, 1e-3, _PRINTED),
    _case("roll with drift at T = 0.95 s", lambda: motion_ratio(0.95, 2), 0.697, 4e-3, _PRINTED),
    _case("sway with drift at T = 1.60 s", lambda: motion_ratio(1.60, 0), 1.487, 4e-3, _PRINTED),
    _case("heave with drift at T = 1.10 s", lambda: motion_ratio(1.10, 1), 0.883, 4e-3, _PRINTED),
    _case("reflection at T = 0.95 s", lambda: _fixed_quantity("reflection", 0.95), 0.487, 4e-3, _PRINTED),
    _case("transmission at T = 0.95 s", lambda: _fixed_quantity("transmission", 0.95), 0.294, 6e-3, _PRINTED),
    _case("drift coefficient at T = 0.60 s", lambda: _fixed_quantity("drift coefficient", 0.60), 0.837, 4e-3, _PRINTED),
    _case("mean offset at T = 0.60 s, mm", lambda: _fixed_quantity("offset", 0.60), 5.4, 0.012, _PRINTED),
    _case("mooring stiffness about the offset", lambda: _fixed_quantity("K11", 0.60), 317.9, 4e-3, _PRINTED),
    _case("roll peak with 15 % damping", lambda: roll_peak(0.15)[0], 0.72, 8e-3, _PRINTED),
    _case("L/B of the roll peak", lambda: roll_peak(0.15)[1], 3.45, 0.03, "flat peak, read from fourteen periods"),
    _case("roll period, free", lambda: _natural_period(2, 0, False), 0.935, 2e-3, _PRINTED),
    _case("roll period, four chains", lambda: _natural_period(2, 4, False), 0.902, 2e-3, _PRINTED),
    _case(
        "sway period alone, added mass of T = 0.95 s",
        lambda: _natural_period(0, 4, True),
        2.80,
        3e-3,
        "as the prototype did; coupled and with the added mass of its own frequency it is 3.37 s",
    ),
    _case("roll in time at T = 0.95 s", lambda: time_ratio(0.95, 2), 0.661, 5e-3, _PRINTED),
    _case("roll in time at T = 1.10 s", lambda: time_ratio(1.10, 2), 0.470, 5e-3, _PRINTED),
    _case("sway in time at T = 1.00 s", lambda: time_ratio(1.00, 0), 0.711, 5e-3, _PRINTED),
    ValidationCase(
        "floating: time domain with linear mooring, T = 0.95 s",
        "frequency domain of the same body",
        lambda: 1.0 + linear_time_error(0.95),
        1.0,
        0.004,
        note="the memory is realised by states to 2e-4 of its start",
    ),
    *(
        ValidationCase(
            f"floating: free decay, {name}",
            "Fourier integral over frequency",
            lambda mode=mode, softening=softening: free_decay_error(mode, softening),  # type: ignore[misc]
            0.0,
            1.5e-3,
            relative=False,
            note="parts of the first position; the memory is realised by states to 2e-4 of its start",
        )
        for name, mode, softening in (("heave", 1, 1.0), ("roll", 2, 1.0), ("slow heave", 1, 0.001))
    ),
    ValidationCase(
        "floating: energy of the moving section",
        "identity: loss of the far field equals the work of the damping",
        energy_identity,
        0.0,
        1e-6,
        relative=False,
        note="rounding and the corner accuracy of the hydrodynamics",
    ),
    ValidationCase(
        "floating: coupled motion with memory after 12 s",
        "matrix exponential",
        exact_linear_motion,
        0.0,
        1e-7,
        relative=False,
        note="fourth-order method at a step of 0.02 s",
    ),
    ValidationCase(
        "floating: righting lever of a wall-sided box at 12 degrees",
        "GZ = sin(heel) (GM + BM tan(heel)^2 / 2)",
        _wall_sided_lever,
        math.sin(math.radians(12.0)) * (1.55 + 1.0 * math.tan(math.radians(12.0)) ** 2),
        1e-9,
        note="exact geometry: GM = 0.75 + 2 - 1.2 m, BM = 2 m",
    ),
    ValidationCase(
        "floating: quadratic damping at resonance",
        "equal work of the linear equivalent",
        _quadratic_resonance,
        1.0,
        1e-8,
        note="fixed point of the iteration",
    ),
)
