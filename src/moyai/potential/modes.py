"""Modes of motion: rigid sway, heave and roll, and any displacement field that a user gives."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words

#: Displacement (n, 2) of the boundary points (n, 2) for unit amplitude of a mode
DisplacementField = Callable[[Array], Array]
RigidKind = Literal["sway", "heave", "roll"]


@dataclass(frozen=True)
class Modes:
    """Named displacement fields of the wetted boundary.

    Raises
    ------
    InputError
        When names repeat or their number differs from that of the functions.

    Examples
    --------
    >>> from moyai.potential import rigid_modes
    >>> rigid_modes(centre=(0.0, -0.2)).names
    ('sway', 'heave', 'roll')
    """

    #: Unique names: the entries of ``radiating_dof`` and ``influenced_dof``.
    names: tuple[str, ...]
    #: Each takes points (n, 2) [m] in the frame of the site and returns displacements (n, 2) for unit amplitude.
    functions: tuple[DisplacementField, ...]
    #: For each mode the numbers of the outlines that it moves; ``None`` moves all.
    bodies: tuple[tuple[int, ...] | None, ...] = ()

    def __post_init__(self) -> None:
        names, functions = tuple(self.names), tuple(self.functions)
        bodies = tuple(self.bodies) or (None,) * len(names)
        if not names:
            raise InputError("no mode was given", parameter="modes")
        if len(set(names)) != len(names):
            raise InputError(f"names of modes repeat: {', '.join(names)}", parameter="modes.names")
        if not len(names) == len(functions) == len(bodies):
            raise InputError(
                f"{len(names)} names, {len(functions)} functions, {len(bodies)} bodies",
                parameter="modes",
                allowed="equal numbers",
            )
        object.__setattr__(self, "names", names)
        object.__setattr__(self, "functions", functions)
        object.__setattr__(self, "bodies", bodies)

    def __len__(self) -> int:
        return len(self.names)

    def __add__(self, other: Modes) -> Modes:
        return Modes(self.names + other.names, self.functions + other.functions, self.bodies + other.bodies)

    def normal_displacement(self, points: Array, normals: Array, body: NDArray[np.intp]) -> Array:
        """Return the normal displacement (modes, n) at boundary points with unit normals (n, 2), for unit amplitude.

        Parameters
        ----------
        points : ndarray (n, 2)
            x, z of the boundary points [m].
        normals : ndarray (n, 2)
            Unit normals there [-].
        body : ndarray of int (n,)
            Number of the body that each point belongs to.

        Raises
        ------
        InputError
            When a function gives another shape or a number that is not finite.
        """
        out = np.zeros((len(self), len(points)))
        for index, (function, moved) in enumerate(zip(self.functions, self.bodies, strict=True)):
            field = np.asarray(function(points), dtype=float)
            if field.shape != points.shape or not np.isfinite(field).all():
                raise InputError(
                    f"mode {self.names[index]} gives displacements of shape {field.shape} or not finite",
                    parameter="modes.functions",
                    allowed=f"finite, shape {points.shape}",
                )
            out[index] = np.einsum("ij,ij->i", field, normals)
            if moved is not None:
                out[index, ~np.isin(body, moved)] = 0.0
            if np.abs(out[index]).max() < 1e-12 * np.abs(field).max():
                # Rounding only: the mode slides along the boundary, like a circle that turns about its centre
                out[index] = 0.0
        return out


@checks_words
@dataclass(frozen=True)
class Rigid:
    """Unit translation or rotation; a small callable class, so that modes can be sent to other processes."""

    #: Of "sway", "heave", "roll".
    kind: RigidKind
    x: float = 0.0
    z: float = 0.0

    def __call__(self, points: Array) -> Array:
        if self.kind == "sway":
            return np.broadcast_to(np.array([1.0, 0.0]), points.shape).copy()
        if self.kind == "heave":
            return np.broadcast_to(np.array([0.0, 1.0]), points.shape).copy()
        return np.stack([points[:, 1] - self.z, -(points[:, 0] - self.x)], axis=1)


def rigid_modes(centre: tuple[float, float], *, body: int | None = None, prefix: str = "") -> Modes:
    """Return sway (x), heave (z) and roll (about +y: the top towards +x) about ``centre``.

    Parameters
    ----------
    centre : (float, float)
        x, z [m] in the frame of the site (z = 0 at still water) about which roll turns, mostly the centre of gravity.
    body : int, optional
        Number of the outline that moves; by default all move together.
    prefix : str
        Put before the three names, for instance ``"left "`` in an array of bodies.

    Returns
    -------
    Modes
        Three modes with their names and the outlines that they move.

    Raises
    ------
    InputError
        For a centre that is not finite.

    Examples
    --------
    >>> from moyai.potential import rigid_modes
    >>> rigid_modes(centre=(0.0, -0.2)).names
    ('sway', 'heave', 'roll')
    >>> rigid_modes(centre=(-6.0, -0.2), body=0, prefix="left ").names
    ('left sway', 'left heave', 'left roll')
    """
    x, z = float(centre[0]), float(centre[1])
    if not (np.isfinite(x) and np.isfinite(z)):
        raise InputError(f"centre is ({x:g}, {z:g})", parameter="centre", allowed="finite numbers")
    kinds: tuple[RigidKind, ...] = ("sway", "heave", "roll")
    moved = None if body is None else (body,)
    return Modes(
        names=tuple(prefix + kind for kind in kinds),
        functions=tuple(Rigid(kind, x, z) for kind in kinds),
        bodies=(moved,) * 3,
    )
