"""Where a steady force holds a body that hangs on nonlinear lines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.floating.arrays import square_matrix

#: Share of the pull of all lines at rest that their forces are smooth to
_SMOOTH = 1e-10

Status = Literal["converged", "not_converged", "interrupted"]


class Mooring(Protocol):
    """What the loop needs of the lines; positions are relative to the rest position, in the modes of the body."""

    def force(self, position: Array) -> Array:
        """Return the force (m,) of all lines on the body at the position (m,).

        Parameters
        ----------
        position : ndarray (m,)
            Displacement of the modes from rest [m, rad].

        Returns
        -------
        ndarray (m,)
            [N, N m].
        """

    def stiffness(self, position: Array) -> Array:
        """Return the tangent (m, m), minus the derivative of the force.

        Parameters
        ----------
        position : ndarray (m,)
            Displacement of the modes from rest [m, rad].

        Returns
        -------
        ndarray (m, m)
            [N/m, N, N m].
        """


@dataclass(frozen=True)
class LinearMooring:
    """Springs of constant stiffness.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import LinearMooring
    >>> springs = LinearMooring(np.diag([1000.0, 0.0, 0.0]))
    >>> springs.force(np.array([0.5, 0.0, 0.0])).tolist()                # sway, heave, roll [N, N, N m]
    [-500.0, 0.0, 0.0]
    """

    matrix: Array

    def force(self, position: Array) -> Array:
        """Return minus stiffness times position, (m,) [N, N m].

        Parameters
        ----------
        position : ndarray (m,)
            Displacement of the modes from rest [m, rad].
        """
        return -self.matrix @ position

    def stiffness(self, position: Array) -> Array:
        """Return the constant stiffness, (m, m) [N/m, N, N m].

        Parameters
        ----------
        position : ndarray (m,)
            Plays no part.
        """
        return self.matrix


@checks_words
@dataclass(frozen=True)
class MeanOffset:
    """Position under a steady force."""

    #: Relative to rest [m, m, rad]; shape (m,).
    position: Array
    #: Remaining force over the largest force involved, rows scaled by their stiffness.
    residual: float
    iterations: int
    #: One of "converged", "not_converged".
    status: Status


def mean_offset(
    mooring: Mooring,
    hydrostatic_stiffness: ArrayLike,
    steady_force: ArrayLike,
    *,
    start: ArrayLike | None = None,
    tolerance: float = 1e-10,
    maximum_iterations: int = 100,
) -> MeanOffset:
    """Solve ``F_moor(X) - F_moor(0) - K_H X + F = 0`` [eq:floating-offset].

    Parameters
    ----------
    mooring : Mooring
        Lines or springs.
    hydrostatic_stiffness : array_like (m, m)
        K_H [N/m, N, N m].
    steady_force : array_like (m,)
        Drift, wind, current [N, N, N m].
    start : array_like (m,) or None
        First guess; ``None`` starts at the undisturbed position.
    tolerance : float
        On the Newton correction relative to the offset, and on the residual relative to the force.
    maximum_iterations : int
        Steps of Newton's method at most.

    Returns
    -------
    MeanOffset
        Position [m, m, rad], residual and status; status ``not_converged`` when there is nothing to hold the body or
        the search stalls.

    Raises
    ------
    InputError
        For a stiffness of another shape, or one that is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import LinearMooring, mean_offset
    >>> found = mean_offset(LinearMooring(np.diag([2e4, 0.0, 0.0])), np.diag([0.0, 8e5, 3e6]), [1e4, 0.0, 3e4])
    >>> found.status, found.position.round(3).tolist()                   # [m], [m], [rad]
    ('converged', [0.5, 0.0, 0.01])
    """
    load = np.asarray(steady_force, dtype=float)
    restoring = square_matrix(hydrostatic_stiffness, len(load), "hydrostatic_stiffness")
    position = np.zeros(len(load)) if start is None else np.array(start, dtype=float)
    rest = mooring.force(np.zeros(len(load)))

    def residual(at: Array) -> Array:
        values: Array = mooring.force(at) - rest - restoring @ at + load
        return values

    if not np.any(load):
        return MeanOffset(np.zeros(len(load)), 0.0, 0, "converged")
    value = residual(position)
    iterations, measure = 0, np.inf
    # Moment rows are made comparable with force rows through the stiffness at rest
    diagonal = np.abs(np.diag(restoring + mooring.stiffness(np.zeros(len(load)))))
    if np.any((diagonal <= 0.0) & (load != 0.0)):
        return MeanOffset(np.full(len(load), np.nan), np.inf, 0, "not_converged")
    scale = np.sqrt(np.where(diagonal > 0.0, diagonal, 1.0))
    reference = float(np.linalg.norm(load / scale))
    while iterations < maximum_iterations:
        measure = float(np.linalg.norm(value / scale)) / reference
        if measure <= tolerance:
            break
        iterations += 1
        tangent = (restoring + mooring.stiffness(position)) / (scale[:, None] * scale[None, :])
        step = np.linalg.lstsq(tangent, value / scale, rcond=1e-14)[0] / scale
        for halving in range(40):
            trial = position + step / 2.0**halving
            trial_value = residual(trial)
            if np.linalg.norm(trial_value / scale) < np.linalg.norm(value / scale):
                position, value = trial, trial_value
                break
        else:
            break
    # Tabulated or iterated line forces are smooth to their own tolerance only, and a load may be less than that
    smooth = _SMOOTH * float(np.linalg.norm(rest / scale)) / reference
    status: Status = "converged" if measure <= max(tolerance, 1e-7, smooth) else "not_converged"
    return MeanOffset(position, measure, iterations, status)
