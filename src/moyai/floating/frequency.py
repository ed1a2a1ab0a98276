"""Motions of a floating body in regular waves: linear equation of motion in the frequency domain."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.arrays import finite, square_matrix
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import EquivalentDamping, LinearDamping, QuadraticDamping

if TYPE_CHECKING:
    import xarray as xr

    from moyai.potential.solution import RadiationDiffraction

SINGULAR = 1e13
"""Condition number of the scaled dynamic stiffness above which an answer has no correct digit left to trust."""


@dataclass(frozen=True)
class Motions:
    """Complex amplitudes of motion, ``Re(X exp(-i omega t))``."""

    #: [rad/s]; shape (n,).
    omega: Array
    #: [rad]; shape (h,).
    heading: Array
    modes: tuple[str, ...]
    #: Per unit wave amplitude [m/m, rad/m]; NaN where the undamped body is at resonance; shape (n, h, m).
    displacement: ComplexArray
    #: Damping beyond radiation that was used, equivalents of quadratic terms included; shape (n, h, m, m).
    damping: Array
    #: Amplitude that quadratic terms were linearised at [m]; zero where there are none; shape (n, h).
    wave_amplitude: Array
    #: Iterations of the equivalent linearisation.
    iterations: int
    checks: tuple[IdentityCheck, ...] = ()
    notices: tuple[Notice, ...] = ()
    #: Force of moving water through linearised quadratic drag, per unit wave amplitude; shape (n, h, m).
    drag_excitation: ComplexArray | None = None

    @property
    def velocity(self) -> ComplexArray:
        """Complex velocities per unit wave amplitude, ``-i omega X`` [1/s, rad/(m s)]."""
        return -1j * self.omega[:, None, None] * self.displacement


def dynamic_stiffness(omega: Array, mass: Array, damping: Array, stiffness: Array) -> ComplexArray:
    """Return ``-omega^2 M - i omega B + K`` [eq:floating-motion].

    Parameters
    ----------
    omega : ndarray (...)
    mass, damping, stiffness : ndarray (..., m, m)
        Broadcast against ``omega[..., None, None]``.
    """
    w = np.asarray(omega)[..., None, None]
    return np.asarray(-(w**2) * mass - 1j * w * damping + stiffness, dtype=np.complex128)


def solve_scaled(matrix: ComplexArray, right: ComplexArray) -> tuple[ComplexArray, Array]:
    """Solve many small systems whose rows have different units, safely near singular ones.

    Parameters
    ----------
    matrix : ndarray (..., m, m)
    right : ndarray (..., m)

    Returns
    -------
    solution : ndarray (..., m)
        NaN where the matrix is singular to rounding.
    condition : ndarray (...)
        Condition number of the matrix with rows and columns scaled by their largest entries; a bound of it where that
        is far from singular.
    """
    size = np.sqrt(np.max(np.abs(matrix), axis=-1))
    # Symmetric scaling keeps the units of a mode together; a mode without any restoring or inertia keeps scale one
    size = np.where(size > 0.0, size, 1.0)
    scaled = matrix / (size[..., :, None] * size[..., None, :])
    with np.errstate(divide="ignore"):
        # no singular value is above m, and their product is the determinant
        condition = np.asarray(float(matrix.shape[-1]) ** matrix.shape[-1] / np.abs(np.linalg.det(scaled)))
    if np.max(condition, initial=0.0) <= 1e-3 * SINGULAR:
        return np.linalg.solve(scaled, (right / size)[..., None])[..., 0] / size, condition
    singular_values = np.linalg.svd(scaled, compute_uv=False)
    smallest = singular_values[..., -1]
    with np.errstate(divide="ignore"):
        condition = np.where(smallest > 0.0, singular_values[..., 0] / np.where(smallest > 0, smallest, 1.0), np.inf)
    bad = condition > SINGULAR
    safe = np.where(bad[..., None, None], np.eye(matrix.shape[-1]), scaled)
    solution = np.linalg.solve(safe, (right / size)[..., None])[..., 0] / size
    solution[bad] = np.nan
    return solution, condition


@checks_words
def solve_motions(
    hydrodynamics: Hydrodynamics | RadiationDiffraction | xr.Dataset,
    inertia: ArrayLike,
    stiffness: ArrayLike,
    *,
    damping: LinearDamping | None = None,
    quadratic: QuadraticDamping | None = None,
    line_damping: EquivalentDamping | None = None,
    wave_amplitude: ArrayLike | None = None,
    water_motion: ComplexArray | None = None,
    start: Motions | None = None,
    apart: bool = False,
    tolerance: float = 1e-10,
    maximum_iterations: int = 200,
) -> Motions:
    """Solve ``[-w^2 (M + A) - i w (B + C) + K] X = F`` for all frequencies and headings [eq:floating-motion].

    Parameters
    ----------
    hydrodynamics : Hydrodynamics, RadiationDiffraction or xarray.Dataset
        Coefficients of the whole unit (see :meth:`Hydrodynamics.scaled_to`). A solution or its dataset is taken as it
        is, per metre: inertia, stiffness and damping are then per metre too.
    inertia : array_like (m, m)
        M.
    stiffness : array_like (m, m) or (n, m, m)
        Hydrostatic and mooring restoring K_H + K_M, of all frequencies or of each.
    damping : LinearDamping or None
        Beyond radiation; the fraction of critical takes the added mass at the wave frequency.
    quadratic : QuadraticDamping or None
        Linearised by equal work at the amplitude of each wave and iterated.
    line_damping : callable or None
        Equivalent damping of lines, ``(velocity amplitudes, omega) -> (m, m)``, iterated likewise.
    wave_amplitude : array_like or None
        Scalar, (n, 1) or (n, h) [m]; needed with ``quadratic`` or ``line_damping``.
    water_motion : ndarray (n, h, k) or None
        What the water does in the measures of ``quadratic``, per unit wave amplitude; still water when absent.
    start : Motions or None
        With a stiffness nearby, from which the iteration continues.
    apart : bool
        Whether the iteration of each frequency ends by itself, as it would alone; else that of all ends together.
    tolerance : float
        Relative change of the velocities at which the iteration ends.
    maximum_iterations : int
        Rounds of the linearisation at most.

    Returns
    -------
    Motions
        With the notice ``motion-singular`` where the undamped body is at resonance to rounding and
        ``linearisation-not-converged`` where the iteration did not settle.

    Raises
    ------
    InputError
        When shapes disagree or an amplitude is missing.

    Examples
    --------
    >>> from moyai.floating import Hydrodynamics, hydrostatics, inertia_matrix, solve_motions
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> still = hydrostatics(
    ...     section, mass=82000.0, centre_of_gravity=(0.0, -0.2), length=20.0, density=1025.0, gravity=9.81
    ... )
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.3], modes=rigid_modes((0.0, -0.2)))
    >>> coefficients = Hydrodynamics.from_dataset(found.dataset).scaled_to(20.0)
    >>> motions = solve_motions(coefficients, inertia_matrix(82000.0, roll_gyradius=1.3), still.stiffness)
    >>> round(float(abs(motions.displacement[0, 0, 1])), 2)          # long waves lift the body by their amplitude
    1.0
    """
    hydrodynamics = Hydrodynamics.of(hydrodynamics)
    size, count, headings = hydrodynamics.size, len(hydrodynamics.omega), len(hydrodynamics.heading)
    inertia = square_matrix(inertia, size, "inertia")
    each = np.ndim(stiffness) == 3
    stiffness = np.asarray(stiffness, dtype=float)
    stiffness = finite(stiffness, "stiffness") if each else square_matrix(stiffness, size, "stiffness")
    if each and stiffness.shape != (count, size, size):
        raise InputError(
            f"stiffness has the shape {stiffness.shape}", parameter="stiffness", allowed=f"({count}, {size}, {size})"
        )
    linear = LinearDamping.none(size) if damping is None else damping
    constant = linear.at(inertia, hydrodynamics.added_mass, stiffness)
    constant = np.broadcast_to(constant[:, None], (count, headings, size, size))
    iterated = quadratic is not None or line_damping is not None
    if iterated and wave_amplitude is None:
        raise InputError("quadratic damping needs the wave amplitude", parameter="wave_amplitude")
    amplitude = np.zeros((count, headings)) + (0.0 if wave_amplitude is None else np.asarray(wave_amplitude, float))
    omega = np.broadcast_to(hydrodynamics.omega[:, None], (count, headings))
    mass = (inertia + hydrodynamics.added_mass)[:, None]
    radiation = hydrodynamics.radiation_damping[:, None]
    restoring = stiffness[:, None] if each else stiffness

    carried = np.zeros((count, headings, size), dtype=np.complex128)

    def solution(added: Array, carried: ComplexArray) -> tuple[ComplexArray, Array]:
        right = hydrodynamics.excitation_force + carried
        return solve_scaled(dynamic_stiffness(omega, mass, radiation + constant + added, restoring), right)

    def equivalent(displacement: ComplexArray) -> tuple[Array, ComplexArray]:
        velocity = -1j * np.abs(amplitude)[..., None] * omega[..., None] * displacement
        return _equivalent(velocity, omega, quadratic, line_damping, water_motion, amplitude)

    added, near = np.zeros_like(constant), start is not None and iterated
    if start is not None and iterated:
        added = start.damping - constant
        carried = carried if start.drag_excitation is None else start.drag_excitation
    displacement, condition = solution(added, carried)
    iterations, change = 0, 0.0
    if iterated:
        if np.any(condition > SINGULAR):
            # A finite first velocity even at an undamped resonance; the iteration forgets it
            first = LinearDamping(np.zeros((size, size)), np.full(size, 0.1))
            more = first.at(inertia, hydrodynamics.added_mass, stiffness)[:, None]
            displacement = np.where(np.isnan(displacement), solution(added + more, carried)[0], displacement)
        displacement, added, carried, condition, change, iterations = _linearised(
            solution, equivalent, (np.nan_to_num(displacement), added, carried, condition), near, apart, tolerance,
            maximum_iterations,
        )  # fmt: skip
        displacement[condition > SINGULAR] = np.nan
    notices = _notices(hydrodynamics, condition, change > tolerance, change, iterations)
    return Motions(
        omega=hydrodynamics.omega,
        heading=hydrodynamics.heading,
        modes=hydrodynamics.modes,
        displacement=displacement,
        damping=constant + added,
        wave_amplitude=amplitude,
        iterations=iterations,
        notices=notices,
        drag_excitation=carried if water_motion is not None else None,
    )


def _linearised(
    solution: Callable[[Array, ComplexArray], tuple[ComplexArray, Array]],
    equivalent: Callable[[ComplexArray], tuple[Array, ComplexArray]],
    state: tuple[ComplexArray, Array, ComplexArray, Array],
    near: bool,
    apart: bool,
    tolerance: float,
    most: int,
) -> tuple[ComplexArray, Array, ComplexArray, Array, float, int]:
    """Iterate displacements, added damping and carried forces, (n, h, ...), until they belong to each other.

    ``state`` holds these and the condition of the systems; what comes back, in addition, the last change and the
    iterations. ``near``: the state is that of a stiffness nearby; ``apart``: each frequency ends by itself.
    """
    displacement, added, carried, condition = state
    change, iterations, goes_on = np.inf, 0, np.ones((len(displacement), 1, 1), dtype=bool)
    while change > tolerance and iterations < most:
        iterations += 1
        target, driven = equivalent(displacement)
        if near or iterations > 1:
            # Half steps: near resonance the full step overshoots by as much as it should have gone
            target, driven = 0.5 * (added + target), 0.5 * (carried + driven)
        added, carried = np.where(goes_on[..., None], target, added), np.where(goes_on, driven, carried)
        updated, condition = solution(added, carried)
        updated = np.where(np.isnan(updated), 0.0, updated)
        moved = np.where(goes_on, np.abs(updated - displacement), 0.0)
        reference = np.max(np.abs(updated), axis=1 if apart else (0, 1), keepdims=True)
        off = np.max(moved / np.where(reference > 0.0, reference, 1.0), axis=(1, 2), keepdims=True)
        change, displacement = float(np.max(off)), updated
        if apart:
            goes_on = goes_on & (off > tolerance)
    return displacement, added, carried, condition, change, iterations


def _equivalent(
    velocity: ComplexArray,
    omega: Array,
    quadratic: QuadraticDamping | None,
    line_damping: EquivalentDamping | None,
    water_motion: ComplexArray | None,
    amplitude: Array,
) -> tuple[Array, ComplexArray]:
    """Return the equivalent damping (n, h, m, m) at complex velocities (n, h, m), and the force of the moving water."""
    size = velocity.shape[-1]
    total = np.zeros((*velocity.shape, size))
    driven = np.zeros(velocity.shape, dtype=np.complex128)
    if quadratic is not None:
        measure = velocity @ quadratic.directions.T
        if water_motion is not None:
            measure = measure - np.abs(amplitude)[..., None] * water_motion
            driven = quadratic.carried_regular(np.abs(measure), water_motion)
        total = total + quadratic.equivalent_regular(np.abs(measure))
    if line_damping is not None:
        for index in np.ndindex(*omega.shape):
            total[index] += line_damping(np.abs(velocity[index]), float(omega[index]))
    return total, driven


def _notices(
    hydrodynamics: Hydrodynamics, condition: Array, unsettled: bool, change: float, iterations: int
) -> tuple[Notice, ...]:
    notices: list[Notice] = []
    worst = float(np.max(condition))
    if worst > SINGULAR:
        where = hydrodynamics.omega[np.unravel_index(int(np.argmax(condition)), condition.shape)[0]]
        notices.append(
            Notice(
                code="motion-singular",
                message=f"the undamped body is at resonance at {where:.4g} rad/s: no finite linear motion",
                value=worst,
                limit=SINGULAR,
                severity="error",
                remedy="add damping, or leave this frequency out",
            )
        )
    if unsettled:
        notices.append(
            Notice(
                code="linearisation-not-converged",
                message=f"the equivalent damping still changes by {change:.2g} after {iterations} iterations",
                value=change,
                severity="warning",
                remedy="raise maximum_iterations",
            )
        )
    return tuple(notices)


def relative_elevation(
    motions: Motions,
    point: tuple[float, float],
    centre: tuple[float, float],
    wave_elevation: ComplexArray,
) -> ComplexArray:
    """Return the water surface less the vertical motion of a point of a planar body [eq:floating-relative].

    Parameters
    ----------
    motions : Motions
        Modes sway, heave, roll.
    point, centre : tuple of float
        Point, and centre of the modes, (x, z) [m].
    wave_elevation : ndarray (n, h)
        Complex elevation at the point per unit wave amplitude; ``exp(i k x cos beta)`` for the incident wave alone.

    Returns
    -------
    ndarray (n, h)
        Complex amplitude per unit wave amplitude [m/m].
    """
    vertical = motions.displacement[..., 1] - motions.displacement[..., 2] * (point[0] - centre[0])
    return wave_elevation - vertical
