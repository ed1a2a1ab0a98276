"""The planar view of a line system: sway x, heave z, roll positive about +y, as the breakwater literature counts them.

Roll theta moves a body point (x, z) to (x cos + z sin, -x sin + z cos), to first order by theta (z, -x); it is the
pitch of the 3-D view. Forces out of the plane are left out; lines in mirror-image pairs have none.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.mooring.lines import LineState
from moyai.mooring.system import (
    LineSystem,
    MooringEquilibrium,
    RestoringCurve,
    direction_vector,
    newton_with_line_search,
)

PLANAR_DEGREES_OF_FREEDOM = ("sway", "heave", "roll")
_KEPT = [0, 2, 4]


@dataclass(frozen=True)
class PlanarLineSystem:
    """Line system of a body that moves in the x-z plane; positions and forces have 3 components."""

    #: The lines in space; their y coordinates are honoured, all copies and all lines count.
    system: LineSystem

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the lines, in the order of every ``tension`` array."""
        return self.system.names

    def states(self, position: ArrayLike) -> dict[str, LineState]:
        """Solve every line for positions (n, 3) or (3,)."""
        return self.system.states(_space(position))

    def forces(self, position: ArrayLike, about: tuple[float, float] = (0.0, 0.0)) -> Array:
        """Return (F_x, F_z, M_y) (..., 3) [N, N m] of all lines on the body, moment about the body point (x, z)."""
        return self.system.forces(_space(position), (about[0], 0.0, about[1]))[..., _KEPT]

    def tensions(self, position: ArrayLike) -> Array:
        """Return fairlead tensions (..., lines) [N] of one copy of every line."""
        return self.system.tensions(_space(position))

    def stiffness(self, position: ArrayLike, about: tuple[float, float] = (0.0, 0.0)) -> Array:
        """Return the tangent stiffness (..., 3, 3) for sway, heave of the point ``about``, and roll.

        It is symmetric at every position when the bed is frictionless.
        """
        full = self.system.stiffness(_space(position), (about[0], 0.0, about[1]))
        return full[..., _KEPT, :][..., :, _KEPT]

    def restoring_curve(
        self, direction: str | ArrayLike, offsets: ArrayLike, position: ArrayLike = (0.0, 0.0, 0.0)
    ) -> RestoringCurve:
        """Move the body along ``direction`` (``sway``, ``heave``, ``roll`` or 3 numbers) from ``position``."""
        unit = direction_vector(direction, PLANAR_DEGREES_OF_FREEDOM)
        steps = np.atleast_1d(np.asarray(offsets, dtype=float))
        path = np.asarray(position, dtype=float) + steps[:, None] * unit
        return RestoringCurve(steps, unit, self.forces(path), self.tensions(path), self.stiffness(path))

    def equilibrium(
        self,
        load: ArrayLike,
        hydrostatic_stiffness: ArrayLike | None = None,
        *,
        start: ArrayLike = (0.0, 0.0, 0.0),
        subtract_rest_force: bool = False,
        tolerance: float = 1e-10,
    ) -> MooringEquilibrium:
        """Find where line force + load - hydrostatic stiffness x position vanishes; see :meth:`LineSystem.equilibrium`.

        Raises
        ------
        ConvergenceError
            When no equilibrium is found.
        """
        load = np.asarray(load, dtype=float)
        hydrostatic = (
            np.zeros((3, 3)) if hydrostatic_stiffness is None else np.asarray(hydrostatic_stiffness, dtype=float)
        )
        evaluate = self.system.evaluator()

        def planar_force(position: Array) -> Array:
            return evaluate(_space(position))[0][_KEPT]

        def planar_stiffness(position: Array) -> Array:
            return evaluate(_space(position))[1][np.ix_(_KEPT, _KEPT)]

        rest = planar_force(np.zeros(3)) if subtract_rest_force else np.zeros(3)
        first = np.asarray(start, dtype=float)
        scale = self.system._load_scale(_space(first), _space(load))[_KEPT]
        position, residual, steps = newton_with_line_search(
            lambda x: planar_force(x) - rest + load - hydrostatic @ x,
            lambda x: -planar_stiffness(x) - hydrostatic,
            first,
            scale,
            [0, 1, 2],
            tolerance,
        )
        return MooringEquilibrium(
            position, planar_force(position), self.tensions(position), planar_stiffness(position), residual, steps
        )


def _space(planar: ArrayLike) -> Array:
    """Put (x, z, about y) into six components."""
    array = np.asarray(planar, dtype=float)
    if array.shape[-1:] != (3,):
        raise InputError(f"shape {array.shape}", parameter="position", allowed="last axis of 3: sway, heave, roll")
    out = np.zeros((*array.shape[:-1], 6))
    out[..., _KEPT] = array
    return out
