"""The loop of P3: mean drift moves the body, the moved lines are stiffer, the stiffer body drifts differently."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import EquivalentDamping, LinearDamping, QuadraticDamping
from moyai.floating.far_field import FarField, drift_force_per_amplitude_squared, far_field
from moyai.floating.frequency import Motions, solve_motions
from moyai.floating.irregular import linearised_in_sea
from moyai.floating.offset import MeanOffset, Mooring, Status, mean_offset
from moyai.sea.water import Water


@checks_words
@dataclass(frozen=True)
class DriftedMotions:
    """Motions about the mean offset that their own drift causes."""

    #: One heading.
    motions: Motions
    far: FarField
    #: Mean drift force along x [N]: of each regular wave, or n equal values in an irregular sea; shape (n,).
    drift_force: Array
    #: Mean offset X0; shape (n, m).
    offset: Array
    #: K_M about the offset; shape (n, m, m).
    mooring_stiffness: Array
    #: Shape (n,).
    iterations: Array
    #: One for each wave.
    status: tuple[Status, ...]
    notices: tuple[Notice, ...] = ()


@dataclass(frozen=True)
class DriftProblem:
    """A moored section in one sea: everything that the loop holds fixed."""

    #: Coefficients of the whole unit with the far field; the loop uses heading number ``heading_index``.
    hydrodynamics: Hydrodynamics
    #: Mass matrix; shape (m, m).
    inertia: Array
    #: Hydrostatic stiffness; shape (m, m).
    hydrostatic_stiffness: Array
    mooring: Mooring
    water: Water
    #: The fraction of critical follows K_M of the offset position.
    damping: LinearDamping | None = None
    quadratic: QuadraticDamping | None = None
    line_damping: EquivalentDamping | None = None
    #: Wind and current [N, N, N m]; shape (m,).
    steady_force: Array | None = None
    heading_index: int = 0
    #: What the water does in the measures of ``quadratic``, per unit wave amplitude; shape (n, 1, k).
    water_motion: ComplexArray | None = None

    def one_heading(self) -> Hydrodynamics:
        """Return the coefficients of the heading in use."""
        chosen = slice(self.heading_index, self.heading_index + 1)
        hydro = self.hydrodynamics

        def of_heading(values: ComplexArray | None) -> ComplexArray | None:
            return None if values is None else values[:, chosen]

        return replace(
            hydro,
            heading=hydro.heading[chosen],
            excitation_force=hydro.excitation_force[:, chosen],
            reflection_coefficient=of_heading(hydro.reflection_coefficient),
            transmission_coefficient=of_heading(hydro.transmission_coefficient),
        )


def _rows(hydrodynamics: Hydrodynamics, rows: slice) -> Hydrodynamics:
    def taken(values: ComplexArray | None) -> ComplexArray | None:
        return None if values is None else values[rows]

    return replace(
        hydrodynamics,
        omega=hydrodynamics.omega[rows],
        added_mass=hydrodynamics.added_mass[rows],
        radiation_damping=hydrodynamics.radiation_damping[rows],
        excitation_force=hydrodynamics.excitation_force[rows],
        reflection_coefficient=taken(hydrodynamics.reflection_coefficient),
        transmission_coefficient=taken(hydrodynamics.transmission_coefficient),
        radiated_wave=taken(hydrodynamics.radiated_wave),
    )


@dataclass(frozen=True)
class _State:
    motions: Motions
    far: FarField
    offset: MeanOffset
    stiffness: Array
    force: float


def _answer(
    problem: DriftProblem,
    hydro: Hydrodynamics,
    drift: float,
    weight: Array,
    amplitude: Array,
    start: Array | None,
    with_drift: bool,
    density: Array | None,
    near: _State | None = None,
    held: tuple[MeanOffset, Array] | None = None,
) -> _State:
    """Return the motions about the offset of a given drift, and the drift that they cause.

    ``near`` is the state in a drift nearby, from which the linearisation continues; ``held`` is that of :func:`_held`.
    """
    offset, stiffness = held or _held(problem, drift, start)
    total = problem.hydrostatic_stiffness + stiffness
    nonlinear = problem.quadratic is not None or problem.line_damping is not None
    if density is not None and nonlinear:
        motions = linearised_in_sea(
            hydro,
            problem.inertia,
            total,
            density,
            quadratic=problem.quadratic,
            line_damping=problem.line_damping,
            damping=problem.damping,
            water_motion=problem.water_motion,
        ).motions
    else:
        motions = solve_motions(
            hydro,
            problem.inertia,
            total,
            damping=problem.damping,
            quadratic=problem.quadratic,
            line_damping=problem.line_damping,
            wave_amplitude=amplitude[:, None] if nonlinear else None,
            water_motion=problem.water_motion,
            start=None if near is None else near.motions,
        )
    far = far_field(hydro, motions.displacement)
    per_square = drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, problem.water, hydro.length)[:, 0]
    force = float(np.sum(weight * per_square)) if with_drift else 0.0
    return _State(motions, far, offset, stiffness, force)


def _held(problem: DriftProblem, drift: float, start: Array | None) -> tuple[MeanOffset, Array]:
    """Return the offset in a drift and the stiffness of the lines there."""
    size = len(problem.inertia)
    load = np.zeros(size) if problem.steady_force is None else np.array(problem.steady_force, dtype=float)
    load[0] += drift
    offset = mean_offset(problem.mooring, problem.hydrostatic_stiffness, load, start=start)
    position = offset.position if offset.status == "converged" else np.zeros(size)
    return offset, np.asarray(problem.mooring.stiffness(position), dtype=float)


@checks_words
def solve_with_drift(
    problem: DriftProblem,
    wave_amplitude: ArrayLike,
    *,
    with_drift: bool = True,
    tolerance: float = 1e-8,
    maximum_iterations: int = 60,
    progress: Progress = silent,
) -> DriftedMotions:
    """Run the drift/stiffness loop for regular waves, each frequency a wave of its own.

    Parameters
    ----------
    problem : DriftProblem
    wave_amplitude : array_like
        Scalar or (n,) [m].
    with_drift : bool
        False leaves the drift out of the loop (steady loads stay): offset and stiffness under wind and current alone.
    tolerance : float
        Relative change of the drift force at which a loop ends.
    maximum_iterations : int
    progress : Progress

    Returns
    -------
    DriftedMotions
        Waves whose loop did not settle carry the status ``not_converged`` and their last values.

    Notes
    -----
    The fixed point F -> X0(F) -> K_M(X0) -> motions -> C_R, E_L -> F is damped by one half as in P3 and hastened by
    secant steps where those do not leap [eq:floating-drift-loop].
    """
    hydro = problem.one_heading()
    count = len(hydro.omega)
    amplitude = np.zeros(count) + np.asarray(wave_amplitude, dtype=float)
    if not with_drift:
        # all waves share one offset
        state = _answer(problem, hydro, 0.0, amplitude**2, amplitude, None, with_drift, None)
        found = _joined(hydro, [state], amplitude, np.ones(count), (state.offset.status,) * count)
        return replace(
            found,
            drift_force=np.zeros(count),
            offset=np.tile(state.offset.position, (count, 1)),
            mooring_stiffness=np.tile(state.stiffness, (count, 1, 1)),
        )
    states: list[_State] = []
    iterations, statuses = np.zeros(count), []
    without_drift = _held(problem, 0.0, None)
    for index in range(count):
        progress("drift loop", index, count)
        rows = slice(index, index + 1)
        moving = None if problem.water_motion is None else problem.water_motion[rows]
        state, used, status = _loop(
            replace(problem, water_motion=moving),
            _rows(hydro, rows),
            amplitude[rows] ** 2,
            amplitude[rows],
            tolerance,
            maximum_iterations,
            held=without_drift,
        )
        states.append(state)
        iterations[index] = used
        statuses.append(status)
    progress("drift loop", count, count)
    return _joined(hydro, states, amplitude, iterations, tuple(statuses))


def _loop(
    problem: DriftProblem,
    hydro: Hydrodynamics,
    weight: Array,
    amplitude: Array,
    tolerance: float,
    maximum_iterations: int,
    density: Array | None = None,
    held: tuple[MeanOffset, Array] | None = None,
) -> tuple[_State, int, Status]:
    """Find the drift force that causes itself [eq:floating-drift-loop]; ``held`` is the state without drift."""
    force = 0.0
    state = _answer(problem, hydro, force, weight, amplitude, None, True, density, held=held)
    previous_force, previous_gap = force, state.force - force
    force = 0.5 * (force + state.force)
    used = 1
    while used < maximum_iterations:
        start = state.offset.position if state.offset.status == "converged" else None
        state = _answer(problem, hydro, force, weight, amplitude, start, True, density, state)
        used += 1
        gap = state.force - force
        if not np.isfinite(gap) or state.offset.status != "converged":
            return state, used, "not_converged"
        if abs(gap) <= tolerance * max(abs(state.force), abs(force), 1e-300):
            return state, used, "converged"
        next_force = force + 0.5 * gap
        if gap != previous_gap:
            secant = force - gap * (force - previous_force) / (gap - previous_gap)
            if abs(secant - force) <= 4.0 * abs(force - previous_force):
                next_force = secant
        previous_force, previous_gap, force = force, gap, next_force
    return state, used, "not_converged"


def _loop_notices(status: tuple[Status, ...], omega: Array) -> tuple[Notice, ...]:
    failed = [float(omega[index]) for index, item in enumerate(status) if item != "converged"]
    if not failed:
        return ()
    return (
        Notice(
            code="drift-loop",
            message=f"mean offset and drift did not settle for {len(failed)} waves, first at {failed[0]:.4g} rad/s",
            value=float(len(failed)),
            severity="error",
            remedy="look whether the lines can hold the steady load, or lower the wave height",
        ),
    )


def _carried(states: list[_State]) -> ComplexArray | None:
    found = [state.motions.drag_excitation for state in states if state.motions.drag_excitation is not None]
    return np.concatenate(found) if len(found) == len(states) else None


def _joined(
    hydro: Hydrodynamics,
    states: list[_State],
    amplitude: Array,
    iterations: Array,
    status: tuple[Status, ...],
) -> DriftedMotions:
    """Join the waves of :func:`solve_with_drift` along frequency."""
    motions = Motions(
        omega=hydro.omega,
        heading=hydro.heading,
        modes=hydro.modes,
        displacement=np.concatenate([state.motions.displacement for state in states]),
        damping=np.concatenate([state.motions.damping for state in states]),
        wave_amplitude=amplitude[:, None],
        iterations=max(state.motions.iterations for state in states),
        notices=tuple({notice.message: notice for state in states for notice in state.motions.notices}.values()),
        drag_excitation=_carried(states),
    )
    far = FarField(
        *(
            np.concatenate([getattr(state.far, name) for state in states])
            for name in ("reflection_coefficient", "transmission_coefficient", "loss", "drift_coefficient")
        )
    )
    return DriftedMotions(
        motions=motions,
        far=far,
        drift_force=np.array([state.force for state in states]),
        offset=np.array([state.offset.position for state in states]),
        mooring_stiffness=np.array([state.stiffness for state in states]),
        iterations=iterations,
        status=status,
        notices=_loop_notices(status, hydro.omega),
    )
