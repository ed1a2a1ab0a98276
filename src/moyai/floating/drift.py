"""The loop of P3: mean drift moves the body, the moved lines are stiffer, the stiffer body drifts differently."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, BoolArray, ComplexArray, IntArray
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import EquivalentDamping, LinearDamping, QuadraticDamping
from moyai.floating.far_field import FarField, drift_force_per_amplitude_squared, far_field
from moyai.floating.frequency import Motions, solve_motions
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


def _rows(hydrodynamics: Hydrodynamics, rows: IntArray) -> Hydrodynamics:
    return replace(
        hydrodynamics,
        omega=hydrodynamics.omega[rows],
        added_mass=hydrodynamics.added_mass[rows],
        radiation_damping=hydrodynamics.radiation_damping[rows],
        excitation_force=hydrodynamics.excitation_force[rows],
        reflection_coefficient=_taken(hydrodynamics.reflection_coefficient, rows),
        transmission_coefficient=_taken(hydrodynamics.transmission_coefficient, rows),
        radiated_wave=_taken(hydrodynamics.radiated_wave, rows),
    )


def _taken(values: ComplexArray | None, rows: IntArray) -> ComplexArray | None:
    return None if values is None else values[rows]


@dataclass(frozen=True)
class _Held:
    """Where drifts hold the body, a row a wave."""

    offsets: tuple[MeanOffset, ...]
    #: K_M about the offset; shape (n, m, m).
    stiffness: Array

    @property
    def converged(self) -> BoolArray:
        return np.array([offset.status == "converged" for offset in self.offsets])


def _held(problem: DriftProblem, drift: Array, start: Sequence[MeanOffset | None]) -> _Held:
    """Return the offsets in drifts (n,) and the stiffness of the lines there."""
    size, offsets, stiffness = len(problem.inertia), [], []
    for force, near in zip(drift, start, strict=True):
        load = np.zeros(size) if problem.steady_force is None else np.array(problem.steady_force, dtype=float)
        load[0] += force
        begin = None if near is None or near.status != "converged" else near.position
        offset = mean_offset(problem.mooring, problem.hydrostatic_stiffness, load, start=begin)
        position = offset.position if offset.status == "converged" else np.zeros(size)
        offsets.append(offset)
        stiffness.append(np.asarray(problem.mooring.stiffness(position), dtype=float))
    return _Held(tuple(offsets), np.array(stiffness))


def _answer(
    problem: DriftProblem, hydro: Hydrodynamics, held: _Held, amplitude: Array, near: Motions | None = None
) -> tuple[Motions, FarField, Array]:
    """Return the motions of waves about their offsets, the waves that they radiate, and the drifts (n,) [N].

    ``near`` are motions in drifts nearby, from which the linearisation continues.
    """
    nonlinear = problem.quadratic is not None or problem.line_damping is not None
    motions = solve_motions(
        hydro,
        problem.inertia,
        problem.hydrostatic_stiffness + held.stiffness,
        damping=problem.damping,
        quadratic=problem.quadratic,
        line_damping=problem.line_damping,
        wave_amplitude=amplitude[:, None] if nonlinear else None,
        water_motion=problem.water_motion,
        start=near,
        apart=True,
    )
    far = far_field(hydro, motions.displacement)
    per_square = drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, problem.water, hydro.length)[:, 0]
    return motions, far, amplitude**2 * per_square


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
    # without drift all waves share one offset
    rest = _held(problem, np.zeros(1), [None])
    held = _Held(rest.offsets * count, np.repeat(rest.stiffness, count, axis=0))
    motions, far, force = _answer(problem, hydro, held, amplitude)
    first = motions.iterations
    iterations, status = np.ones(count), np.where(held.converged, "converged", "not_converged")
    if with_drift:
        held, near, iterations, status = _loop(
            problem, hydro, amplitude, held, motions, force, tolerance, maximum_iterations, progress
        )
        motions, far, force = _answer(problem, hydro, held, amplitude, near)
    statuses: tuple[Status, ...] = tuple(status.tolist())
    return DriftedMotions(
        motions=replace(motions, wave_amplitude=amplitude[:, None], iterations=max(first, motions.iterations)),
        far=far,
        drift_force=force if with_drift else np.zeros(count),
        offset=np.array([offset.position for offset in held.offsets]),
        mooring_stiffness=held.stiffness,
        iterations=iterations,
        status=statuses,
        notices=_loop_notices(statuses, hydro.omega) if with_drift else (),
    )


def _loop(
    problem: DriftProblem,
    hydro: Hydrodynamics,
    amplitude: Array,
    held: _Held,
    motions: Motions,
    caused: Array,
    tolerance: float,
    maximum_iterations: int,
    progress: Progress,
) -> tuple[_Held, Motions, Array, NDArray[np.str_]]:
    """Find for each wave the drift that causes itself [eq:floating-drift-loop]; return where it holds the body.

    ``held``, ``motions`` and ``caused``, the drifts, are those of no drift. All waves go on together, each until it
    has settled. The motions there, rounds and the status of each come with the answer.
    """
    count = len(amplitude)
    offsets, stiffness = list(held.offsets), held.stiffness.copy()
    previous_force, previous_gap, force = np.zeros(count), caused.copy(), 0.5 * caused
    used, status = np.ones(count), np.full(count, "not_converged")
    going = np.arange(count)
    for _ in range(1, maximum_iterations):
        progress("drift loop", count - len(going), count)
        if not len(going):
            break
        held = _held(problem, force[going], [offsets[row] for row in going])
        part = replace(problem, water_motion=_taken(problem.water_motion, going))
        found, _, drift = _answer(part, _rows(hydro, going), held, amplitude[going], _of_rows(motions, going))
        motions = _with_rows(motions, found, going)
        for row, offset, matrix in zip(going, held.offsets, held.stiffness, strict=True):
            offsets[row], stiffness[row] = offset, matrix
        used[going] += 1
        gap = drift - force[going]
        lost = ~np.isfinite(gap) | ~held.converged
        near = np.abs(gap) <= tolerance * np.maximum(np.maximum(np.abs(drift), np.abs(force[going])), 1e-300)
        status[going[near & ~lost]] = "converged"
        on = ~(lost | near)
        force[going], previous_force[going], previous_gap[going] = (
            _next_force(force[going], gap, previous_force[going], previous_gap[going]), force[going], gap,
        )  # fmt: skip
        going = going[on]
    progress("drift loop", count, count)
    return _Held(tuple(offsets), stiffness), motions, used, status


def _next_force(force: Array, gap: Array, previous_force: Array, previous_gap: Array) -> Array:
    """Return the next guess of the drifts: half of the way, or the secant where it does not leap."""
    half = force + 0.5 * gap
    turned = gap - previous_gap
    with np.errstate(invalid="ignore"):
        secant = force - gap * (force - previous_force) / np.where(turned != 0.0, turned, 1.0)
        calm = (turned != 0.0) & (np.abs(secant - force) <= 4.0 * np.abs(force - previous_force))
    return np.where(calm, secant, half)


def _of_rows(motions: Motions, rows: IntArray) -> Motions:
    return replace(
        motions, omega=motions.omega[rows], displacement=motions.displacement[rows], damping=motions.damping[rows],
        wave_amplitude=motions.wave_amplitude[rows], drag_excitation=_taken(motions.drag_excitation, rows),
    )  # fmt: skip


def _with_rows(motions: Motions, found: Motions, rows: IntArray) -> Motions:
    """Return the motions with those of some waves replaced."""
    displacement, damping, carried = motions.displacement.copy(), motions.damping.copy(), motions.drag_excitation
    displacement[rows], damping[rows] = found.displacement, found.damping
    if carried is not None and found.drag_excitation is not None:
        carried = carried.copy()
        carried[rows] = found.drag_excitation
    return replace(motions, displacement=displacement, damping=damping, drag_excitation=carried)


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
