"""Lines of :mod:`moyai.mooring` seen from the rest position of a planar body: force, tangent, tensions."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.mooring.system import LineSystem
from moyai.mooring.table import CompiledLines, compile_lines


@dataclass(frozen=True)
class PlanarMooring:
    """Nonlinear lines in the modes sway, heave, roll about the centre of gravity; positions are relative to rest.

    Implements [eq:floating-lines]; it serves the drift loop (exact forces and tangents) and the time domain (compiled).
    """

    #: Lines with their fairleads in body axes.
    system: LineSystem
    #: Centre of gravity (x, z) [m] in site axes and heel [rad] of the body at rest.
    rest: tuple[float, float, float]
    #: Centre of gravity (x, z) in the body axes of the fairleads [m].
    centre: tuple[float, float]
    #: For the time domain: tables inside a window of motion, the exact solver outside; or exact everywhere.
    compiled: CompiledLines

    @classmethod
    def of(
        cls,
        system: LineSystem,
        *,
        rest: tuple[float, float, float],
        centre: tuple[float, float],
        motion_range: ArrayLike | None = None,
        tolerance: float = 1e-4,
    ) -> PlanarMooring:
        """Prepare the lines of a body.

        Parameters
        ----------
        system, rest, centre
            As for the class.
        motion_range : array_like (3,) or None
            Largest sway [m], heave [m] and roll [rad] from rest, either way, within which tables serve (about five
            times faster than the exact solver); ``None`` for the exact solver everywhere.
        tolerance : float
            Accuracy of the tables over the tension.
        """
        shifted = replace(system, lines=tuple(_about(line, centre) for line in system.lines))
        window = None
        if motion_range is not None:
            reach = np.abs(np.asarray(motion_range, dtype=float))
            if reach.shape != (3,) or not np.all(reach > 0.0):
                raise InputError(
                    f"motion range {motion_range}", parameter="motion_range", allowed="three positive numbers"
                )
            ends = [(float(r - m), float(r + m)) for r, m in zip(rest, reach)]
            window = (ends[0], ends[1], ends[2])
        compiled = compile_lines(shifted, window, None if window is None else tolerance)
        return cls(system, rest, centre, compiled)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the lines, in the order of the tensions."""
        return self.system.names

    @property
    def count(self) -> int:
        """Number of different lines."""
        return len(self.system.lines)

    @property
    def reach(self) -> float:
        """Largest distance from an anchor to its fairlead at rest [m]."""
        fairlead = self.system.fairleads(self._pose(np.zeros(3)))
        anchor = np.array([line.anchor for line in self.system.lines])
        return float(np.max(np.linalg.norm(fairlead - anchor, axis=-1))) if len(anchor) else 0.0

    def _pose(self, position: ArrayLike) -> Array:
        """Return the six-component pose (..., 6) of the body axes at motions (..., 3) of the centre of gravity."""
        motion = np.asarray(position, dtype=float) + np.asarray(self.rest)
        cosine, sine = np.cos(motion[..., 2]), np.sin(motion[..., 2])
        x, z = self.centre
        pose = np.zeros((*motion.shape[:-1], 6))
        pose[..., 0] = motion[..., 0] - (x * cosine + z * sine)
        pose[..., 2] = motion[..., 1] - (-x * sine + z * cosine)
        pose[..., 4] = motion[..., 2]
        return pose

    def force(self, position: ArrayLike) -> Array:
        """Return exact forces (..., 3) of all lines about the centre of gravity [N, N, N m]."""
        x, z = self.centre
        return np.asarray(self.system.forces(self._pose(position), (x, 0.0, z))[..., [0, 2, 4]])

    def stiffness(self, position: ArrayLike) -> Array:
        """Return exact tangents (..., 3, 3) about the centre of gravity."""
        x, z = self.centre
        full = self.system.stiffness(self._pose(position), (x, 0.0, z))
        return np.asarray(full[..., [0, 2, 4], :][..., [0, 2, 4]])

    def force_and_tension(self, position: ArrayLike) -> tuple[Array, Array]:
        """Return what the time domain sees: compiled forces (..., 3) and fairlead tensions (..., lines)."""
        return self.compiled.forces(np.asarray(position, dtype=float) + np.asarray(self.rest))

    def states(self, position: ArrayLike) -> dict[str, Any]:
        """Return the exact state of every line at motions (n, 3): tensions at both ends, uplift, grounded length."""
        return self.system.states(self._pose(position))

    def packed(self) -> tuple[Any, ...]:
        """Return the lines as arguments of the time-domain kernel."""
        return (*self.compiled.arguments, np.asarray(self.rest, dtype=float), np.zeros(self.count))


def _about(line: Any, centre: tuple[float, float]) -> Any:
    """Return the line with its fairlead counted from the centre of gravity."""
    x, y, z = line.fairlead
    natural = getattr(line, "natural_length", None)
    moved = replace(line, fairlead=(x - centre[0], y, z - centre[1]))
    if natural is None:
        return moved
    # A spring's pretension belongs to its length at zero motion in the original axes: keep its natural length
    length = float(np.linalg.norm(np.asarray(moved.anchor) - np.asarray(moved.fairlead)))
    return replace(moved, pretension=line.stiffness * (length - natural))
