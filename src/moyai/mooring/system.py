"""Mooring lines on one body: forces, tensions, tangent stiffness, restoring curves, equilibrium (6 degrees of freedom).

A position is (x, y, z, roll, pitch, yaw) of the body origin, zero where body and site axes coincide; rotations are
finite and exact (order in :mod:`moyai.mooring.rotations`). Forces act on the body, in site axes; moments are about
the body origin or any other body-fixed point.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.mooring.balance import newton_with_line_search
from moyai.mooring.lines import LineElement, LineState, Vector
from moyai.mooring.rotations import cross_matrix, rotation_matrix, spin_of_angle_rates

DEGREES_OF_FREEDOM = ("surge", "sway", "heave", "roll", "pitch", "yaw")


@dataclass(frozen=True)
class RestoringCurve:
    """Answer of a line system to an imposed offset."""

    #: Imposed offsets [m or rad]; shape (n,).
    offsets: Array
    #: Unit motion of the offset; shape (d,).
    direction: Array
    #: Force and moment on the body [N, N m]; shape (n, d).
    force: Array
    #: Fairlead tension of one copy of every line [N]; shape (n, lines).
    tension: Array
    #: Tangent stiffness at every offset; shape (n, d, d).
    stiffness: Array


@dataclass(frozen=True)
class MooringEquilibrium:
    """A body at rest under its lines, an external load and linear hydrostatics."""

    #: Position found; shape (d,).
    position: Array
    #: Force of the lines on the body there [N, N m]; shape (d,).
    line_force: Array
    #: Fairlead tensions of one copy [N]; shape (lines,).
    tension: Array
    #: Tangent stiffness of the lines there; shape (d, d).
    stiffness: Array
    #: Largest imbalance over the largest load taking part.
    residual: float
    #: Newton steps.
    iterations: int


@dataclass(frozen=True)
class LineSystem:
    """Lines between the bed and one body.

    Examples
    --------
    >>> from moyai.mooring import Line, LineSystem, LineType, Segment
    >>> chain = Segment(LineType("chain", submerged_weight=1000.0, axial_stiffness=5e8), length=55.0)
    >>> pair = [Line(name, (x, 0.0, -10.0), (0.0, 0.0, 0.0), [chain]) for name, x in (("left", -50.0), ("right", 50.0))]
    >>> moored = LineSystem(pair, water_depth=10.0)
    >>> found = moored.equilibrium([20e3, 0, 0, 0, 0, 0], free=(0,))   # pushed by 20 kN along x
    >>> round(float(found.position[0]), 2)                           # [m]
    2.01
    """

    #: With unique names.
    lines: tuple[LineElement, ...]
    #: [m]; the bed lies at z = -water_depth; ``inf`` for no bed.
    water_depth: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "lines", tuple(self.lines))
        if not self.water_depth > 0.0:
            raise InputError(f"{self.water_depth:g} m", parameter="water_depth", allowed="greater than 0")
        names = [line.name for line in self.lines]
        for name in names:
            if names.count(name) > 1:
                raise InputError(
                    f"two lines are named {name!r}", parameter="lines", remedy="give every line its own name"
                )
        for line in self.lines:
            clearance = getattr(line, "bed_clearance", None)
            if clearance is not None:
                clearance(self.water_depth)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the lines, in the order of every ``tension`` array."""
        return tuple(line.name for line in self.lines)

    def fairleads(self, position: ArrayLike) -> Array:
        """Return fairlead positions (..., lines, 3) [m] in site axes for body positions (..., 6).

        Parameters
        ----------
        position : array_like (..., 6)
            x, y, z [m], roll, pitch, yaw [rad] of the body, site axes.

        Raises
        ------
        InputError
            For a position of another shape, or not finite.
        """
        position = _positions(position)
        rotation = rotation_matrix(position[..., 3:])
        values: Array = position[..., None, :3] + np.einsum("...ij,lj->...li", rotation, self._arms)
        return values

    def states(self, position: ArrayLike) -> dict[str, LineState]:
        """Solve every line for body positions (n, 6) or (6,); arrays of the states have a leading axis n.

        Parameters
        ----------
        position : array_like (n, 6) or (6,)
            x, y, z [m], roll, pitch, yaw [rad] of the body, site axes.

        Raises
        ------
        InputError
            For a position of another shape, or not finite.
        """
        points = self.fairleads(np.atleast_2d(_positions(position)))
        return {line.name: line.solve(points[:, i], self.water_depth) for i, line in enumerate(self.lines)}

    def forces(self, position: ArrayLike, about: Vector = (0.0, 0.0, 0.0)) -> Array:
        """Return force and moment (..., 6) [N, N m] of all lines on the body.

        Parameters
        ----------
        position : array_like (..., 6)
            Body positions.
        about : tuple
            Body-fixed point of the moments [m], body axes.
        """
        position = _positions(position)
        return self._assemble(position.reshape(-1, 6), about, False)[0].reshape(position.shape)

    def tensions(self, position: ArrayLike) -> Array:
        """Return fairlead tensions (..., lines) [N] of one copy of every line.

        Parameters
        ----------
        position : array_like (..., 6)
            x, y, z [m], roll, pitch, yaw [rad] of the body, site axes.

        Raises
        ------
        InputError
            For a position of another shape, or not finite.
        """
        position = _positions(position)
        states = self.states(position.reshape(-1, 6)).values()
        columns = [state.tension_fairlead for state in states]
        shape = (*position.shape[:-1], len(self.lines))
        return np.stack(columns, axis=-1).reshape(shape) if columns else np.zeros(shape)

    def stiffness(self, position: ArrayLike, about: Vector = (0.0, 0.0, 0.0)) -> Array:
        """Return the tangent stiffness (..., 6, 6) about any position ``[eq:mooring-stiffness]``.

        Minus the derivative of force and moment about ``about`` with respect to the displacement of that point and a
        small rotation vector, both in site axes. It holds the exact stiffness of every line and the moment of the
        turning lever; with frictionless lines it is symmetric wherever the total moment vanishes (and in its
        translational part everywhere).

        Parameters
        ----------
        position : array_like (..., 6)
            x, y, z [m], roll, pitch, yaw [rad] of the body, site axes.
        about : (float, float, float)
            Point that moments are about, in body axes [m].

        Returns
        -------
        ndarray (..., 6, 6)
            [N/m, N, N m].

        Raises
        ------
        InputError
            For a position of another shape, or not finite.
        """
        position = _positions(position)
        return self._assemble(position.reshape(-1, 6), about, True)[1].reshape(*position.shape[:-1], 6, 6)

    def restoring_curve(
        self, direction: str | ArrayLike, offsets: ArrayLike, position: ArrayLike = (0.0,) * 6
    ) -> RestoringCurve:
        """Move the body along ``direction`` (a name of :data:`DEGREES_OF_FREEDOM` or 6 numbers) from ``position``.

        Parameters
        ----------
        direction : str or array_like (6,)
            Surge, sway ..., or the displacement per unit of offset.
        offsets : array_like (n,)
            Along ``direction`` [m or rad].
        position : array_like (6,)
            Where the offset is zero, site axes [m, rad].

        Raises
        ------
        InputError
            For an unknown direction, or a position of another shape or not finite.
        """
        unit = direction_vector(direction, DEGREES_OF_FREEDOM)
        steps = np.atleast_1d(np.asarray(offsets, dtype=float))
        path = _positions(position) + steps[:, None] * unit
        return RestoringCurve(steps, unit, self.forces(path), self.tensions(path), self.stiffness(path))

    @checks_words
    def equilibrium(
        self,
        load: ArrayLike,
        hydrostatic_stiffness: ArrayLike | None = None,
        *,
        start: ArrayLike = (0.0,) * 6,
        subtract_equilibrium_force: bool = False,
        free: Sequence[int] = range(6),
        tolerance: float = 1e-10,
    ) -> MooringEquilibrium:
        """Find where line force + load - hydrostatic stiffness x position vanishes.

        Parameters
        ----------
        load : array_like (6,)
            External force and moment about the body origin [N, N m], constant in site axes.
        hydrostatic_stiffness : array_like (6, 6), optional
            Linear restoring of buoyancy and weight about the zero position; none for a body carried by its lines alone.
        start : array_like (6,)
            First position.
        subtract_equilibrium_force : bool
            Whether the line force at zero position is balanced already (by weight and buoyancy), so that a zero load
            leaves the body at zero.
        free : sequence of int
            Degrees of freedom that may move; the others stay at ``start``.
        tolerance : float
            Accepted imbalance over the largest load taking part.

        Raises
        ------
        ConvergenceError
            When no equilibrium is found.
        """
        load = np.asarray(load, dtype=float)
        hydrostatic = (
            np.zeros((6, 6)) if hydrostatic_stiffness is None else np.asarray(hydrostatic_stiffness, dtype=float)
        )
        evaluate = self.evaluator()
        rest = evaluate(np.zeros(6))[0] if subtract_equilibrium_force else np.zeros(6)

        def imbalance(position: Array) -> Array:
            values: Array = evaluate(position)[0] - rest + load - hydrostatic @ position
            return values

        def jacobian(position: Array) -> Array:
            spin = np.eye(6)
            spin[3:, 3:] = spin_of_angle_rates(position[3:])
            return -evaluate(position)[1] @ spin - hydrostatic

        first = np.asarray(start, dtype=float)
        position, residual, steps = newton_with_line_search(
            imbalance, jacobian, first, self._load_scale(first, load), list(free), tolerance
        )
        force, stiffness = evaluate(position)
        return MooringEquilibrium(position, force, self.tensions(position), stiffness, residual, steps)

    def evaluator(self) -> Callable[[Array], tuple[Array, Array]]:
        """Return a function of one position (6,) giving force (6,) and stiffness (6, 6) together; it keeps the last."""
        last: dict[bytes, tuple[Array, Array]] = {}

        def evaluate(position: Array) -> tuple[Array, Array]:
            key = position.tobytes()
            if key not in last:
                # where an inextensible line cannot reach, its force is infinite: a search turns back there
                with np.errstate(invalid="ignore"):
                    force, stiffness = self._assemble(_positions(position)[None, :], (0.0, 0.0, 0.0), True)
                last.clear()
                last[key] = force[0], stiffness[0]
            return last[key]

        return evaluate

    def planar(self) -> PlanarLineSystem:
        """Return the view in x-z: sway x, heave z, roll positive about +y (see :class:`PlanarLineSystem`)."""
        return PlanarLineSystem(self)

    @cached_property
    def _arms(self) -> Array:
        """Fairleads in body axes (lines, 3)."""
        return np.array([line.fairlead for line in self.lines], dtype=float).reshape(-1, 3)

    def _assemble(self, flat: Array, about: Vector, tangent: bool) -> tuple[Array, Array]:
        """Return force (n, 6) and, where asked for, tangent stiffness (n, 6, 6)."""
        rotation = rotation_matrix(flat[:, 3:])
        force, stiffness = np.zeros((len(flat), 6)), np.zeros((len(flat), 6, 6))
        for i, line in enumerate(self.lines):
            arm = rotation @ self._arms[i]
            state = line.solve(flat[:, :3] + arm, self.water_depth)
            lever = cross_matrix(arm - rotation @ np.asarray(about, dtype=float))
            force[:, :3] += state.force
            force[:, 3:] += (lever @ state.force[:, :, None])[:, :, 0]
            if tangent:
                shifted = lever @ state.stiffness
                stiffness[:, :3, :3] += state.stiffness
                stiffness[:, :3, 3:] -= state.stiffness @ lever
                stiffness[:, 3:, :3] += shifted
                # F x (d theta x r): the moment of the turning lever
                stiffness[:, 3:, 3:] -= cross_matrix(state.force) @ lever + shifted @ lever
        return force, stiffness

    def _load_scale(self, start: Array, load: Array) -> Array:
        """Return the largest force and moment taking part, for judging an imbalance (6,)."""
        force = max(float(np.sum(self.tensions(start))), float(np.max(np.abs(load[:3]))), 1e-12)
        arm = max((float(np.linalg.norm(line.fairlead)) for line in self.lines), default=1.0) or 1.0
        moment = max(force * arm, float(np.max(np.abs(load[3:]))))
        return np.array([force] * 3 + [moment] * 3)


def direction_vector(direction: str | ArrayLike, names: Sequence[str]) -> Array:
    """Return a direction given by name or by components."""
    if isinstance(direction, str):
        if direction not in names:
            raise InputError(f"unknown direction {direction!r}", parameter="direction", allowed=", ".join(names))
        values: Array = np.eye(len(names))[list(names).index(direction)]
        return values
    vector = np.asarray(direction, dtype=float)
    if vector.shape != (len(names),):
        raise InputError(
            f"{vector.size} components", parameter="direction", allowed=f"{len(names)} components or a name"
        )
    return vector


def _positions(position: ArrayLike) -> Array:
    array = np.asarray(position, dtype=float)
    if array.shape[-1:] != (6,):
        raise InputError(
            f"shape {array.shape}", parameter="position", allowed="last axis of 6: x, y, z, roll, pitch, yaw"
        )
    if not np.all(np.isfinite(array)):
        raise InputError("position holds NaN or infinity", parameter="position")
    return array


PLANAR_DEGREES_OF_FREEDOM = ("sway", "heave", "roll")
_KEPT = [0, 2, 4]


@dataclass(frozen=True)
class PlanarLineSystem:
    """Line system of a body that moves in the x-z plane; positions and forces have 3 components.

    Sway x, heave z, roll positive about +y, as the breakwater literature counts them: roll theta moves a body point
    (x, z) to (x cos + z sin, -x sin + z cos), to first order by theta (z, -x); it is the pitch of the 3-D view. Forces
    out of the plane are left out; lines in mirror-image pairs have none.
    """

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
        subtract_equilibrium_force: bool = False,
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

        rest = planar_force(np.zeros(3)) if subtract_equilibrium_force else np.zeros(3)
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
