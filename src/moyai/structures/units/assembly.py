"""From the case to the row at one water level: draught, masses, stiffness, lines in row axes, steady loads."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.validity import Notice
from moyai.floating.statics import Hydrostatics, hydrostatics
from moyai.mooring.balance import newton_with_line_search
from moyai.mooring.lines import Line, LineElement, SpringLine
from moyai.mooring.system import LineSystem
from moyai.potential.sections import Section
from moyai.sea.environment import Environment
from moyai.sea.water import Water
from moyai.structures.units.connectors import UnitJoint, constraints, joints_of, null_space, spring_matrices
from moyai.structures.units.links import Link, Work, links_of
from moyai.structures.units.model import FloatingRow, Placement, UnitLine
from moyai.structures.units.row_lines import RowLines

IMBALANCE_LIMIT = 1.0  # per cent of the displacement of a unit
#: Half width that corners of curves are rounded over at rest, over the length of a unit; wider ones lead the way there
ROUNDING = 1e-4
_WIDER = (100.0, 10.0, 1.0)
#: The same in smaller steps, the whole load put on by tenths before them, where these find no equilibrium
_SLOWLY = (100.0, 50.0, 20.0, 10.0, 5.0, 2.0, 1.0)
_SHARES = tuple(0.1 * number for number in range(1, 10))
_LEVELS = 41  # Simpson points over the draught for the current


@dataclass(frozen=True, eq=False)
class RowAtLevel:
    """The row at rest at one water level; z = 0 is that level."""

    #: Of the water level.
    name: str
    #: [m] above datum.
    level: float
    water: Water
    row: FloatingRow
    section: Section
    #: [m].
    draught: float
    #: [kg]; shape (u,).
    masses: Array
    #: Of one unit across its length.
    statics: Hydrostatics
    #: Centres of gravity [m], row axes; shape (u, 3).
    centres: Array
    joints: tuple[UnitJoint, ...]
    #: Shape (c, m).
    constraint: Array
    #: Of every unit, in row axes counted from its centre of gravity.
    lines: tuple[tuple[LineElement, ...], ...]

    @property
    def size(self) -> int:
        """Number of motions, six a unit."""
        return 6 * self.row.count

    @property
    def freeboard(self) -> float:
        """Deck above still water [m]."""
        return self.row.hull.bottom + self.row.hull.height - self.draught

    @cached_property
    def free(self) -> Array:
        """Basis (m, m - c) of the motions that connectors leave."""
        return null_space(self.constraint)

    @cached_property
    def systems(self) -> tuple[LineSystem, ...]:
        """Line system of every unit, about its centre of gravity."""
        return tuple(
            LineSystem(lines, self.water.depth + float(centre[2])) for lines, centre in zip(self.lines, self.centres)
        )

    @cached_property
    def inertia(self) -> Array:
        """Mass matrix (m, m), row axes."""
        blocks = []
        for mass in self.masses:
            blocks.append(np.diag([mass] * 3 + [mass * radius**2 for radius in self.row.gyradii]))
        return self._joined(blocks)

    @cached_property
    def hydrostatic(self) -> Array:
        """Restoring of weight and buoyancy (m, m), row axes [eq:units-hydrostatic]."""
        planar, row = self.statics.stiffness, self.row
        area, breadth = self.section.area, self.section.waterplane_breadth
        weight = self.water.density * self.water.gravity * row.length
        lever = self.section.centroid[1] - float(self.centres[0, 2])
        one = np.zeros((6, 6))
        one[2, 2] = planar[1, 1]
        one[2, 4] = one[4, 2] = planar[1, 2]
        one[4, 4] = planar[2, 2]
        one[3, 3] = weight * (breadth * row.length**2 / 12.0 + area * lever)
        return self._joined([one] * row.count)

    @cached_property
    def links(self) -> tuple[Link, ...]:
        """Curves of all connectors."""
        return links_of(self.joints, self.centres)

    @cached_property
    def springs(self) -> tuple[Array, Array]:
        """Stiffness and damping (m, m) of connectors that are linear."""
        return spring_matrices(self.joints, self.size)

    def _joined(self, blocks: list[Array]) -> Array:
        """Return blocks (6, 6) in axes of their units as one matrix in row axes."""
        whole = np.kron(np.eye(len(blocks)), np.ones((6, 6))) * np.tile(np.hstack(blocks), (len(blocks), 1))
        return np.asarray(self.unit_axes.T @ whole @ self.unit_axes)

    @cached_property
    def unit_axes(self) -> Array:
        """Turns motions in row axes to those of their units (m, m)."""
        out = np.zeros((self.size, self.size))
        for number, place in enumerate(self.row.placements):
            part = slice(6 * number, 6 * number + 6)
            out[part, part] = np.kron(np.eye(2), place.rotation.T)
        return out

    def in_unit_axes(self, motion: Any) -> Any:
        """Return motions (..., m) in row axes as (..., u, 6) in axes of each unit."""
        return (np.asarray(motion) @ self.unit_axes.T).reshape(*np.shape(motion)[:-1], self.row.count, 6)

    @cached_property
    def row_lines(self) -> RowLines:
        """All lines of the row."""
        return RowLines(self.lines, self.water.depth + float(self.centres[0, 2]))

    def line_stiffness(self, position: Array) -> Array:
        """Return the tangent stiffness (m, m) of all lines at a position (m,) from rest."""
        return self.row_lines.at(position).stiffness

    def line_force(self, position: Array) -> Array:
        """Return the force (m,) of all lines at a position (m,) from rest."""
        return self.row_lines.at(position).force

    def curve_force(self, position: Array, work: Work) -> Array:
        """Return the mean force (m,) of connectors with a curve about a position (m,)."""
        out = np.zeros(self.size)
        for link in self.links:
            out -= link.bears(position, work)[0] * link.along(position)
        return out

    @property
    def rounding(self) -> float:
        """Half width [m] that the corners of curves are rounded over when the row comes to rest."""
        return ROUNDING * self.row.length

    @property
    def line_names(self) -> tuple[str, ...]:
        """Names of all lines of all units, in the order of :meth:`tensions`."""
        return tuple(line.name for lines in self.lines for line in lines)

    @property
    def breaking_load(self) -> Array:
        """Breaking loads (lines,) [N]; infinite where not known."""
        return np.array([line.breaking_load for lines in self.lines for line in lines], dtype=float)

    def tensions(self, position: Array) -> Array:
        """Return the tensions at the fairleads (lines,) [N] at a position (m,)."""
        return self.row_lines.at(position).tension

    def tension_gradient(self, position: Array) -> Array:
        """Return the derivative of the tensions (lines, m) by the motions."""
        return self.row_lines.at(position).tension_gradient


def assemble(row: FloatingRow, environment: Environment, name: str, level: float) -> RowAtLevel:
    """Put the row into the water of one level.

    The masses follow from the draught at the first level, less what the lines pull down; at other levels the row
    floats with these masses, every unit at the same draught [eq:units-balance].

    Raises
    ------
    InputError
        When the row stands on the bed, the lines pull it under, or connectors hold the same twice.
    """
    reference = environment.water_at(environment.water_levels[0][1])
    _check_depth(row.draught, reference, environment.water_levels[0][0])
    masses = _masses(row, reference, environment.water_levels[0][1])
    water = environment.water_at(level)
    draught = row.draught
    if name != environment.water_levels[0][0]:
        draught = _draught(row, water, masses, level)
    _check_depth(draught, water, name)
    section = row.hull.immersed(draught)
    centre_z = row.centre_of_gravity_above_keel - draught
    centres = np.array([[place.x, place.y, centre_z] for place in row.placements])
    joints = joints_of(row, centres, draught)
    statics = hydrostatics(
        section,
        mass=float(masses.mean()),
        centre_of_gravity=(0.0, centre_z),
        length=row.length,
        density=water.density,
        gravity=water.gravity,
    )
    lines = tuple(_lines_of(row, number, water, draught, level) for number in range(row.count))
    constraint = constraints(joints, 6 * row.count)
    return RowAtLevel(
        name, level, water, row, section, draught, masses, statics, centres, joints, constraint, lines
    )  # fmt: skip


def _check_depth(draught: float, water: Water, name: str) -> None:
    if draught >= water.depth:
        raise InputError(
            f"the draught of {draught:.4g} m reaches the bed at {name} (depth {water.depth:.4g} m)",
            parameter="draught",
            allowed=f"below {water.depth:.4g} m",
        )


def _pull(row: FloatingRow, number: int, water: Water, draught: float, level: float) -> float:
    """Return the downward pull [N] of the lines of one unit."""
    lines = _lines_of(row, number, water, draught, level)
    if not lines:
        return 0.0
    system = LineSystem(lines, water.depth + row.centre_of_gravity_above_keel - draught)
    return -float(system.forces(np.zeros(6))[2])


def _masses(row: FloatingRow, water: Water, level: float) -> Array:
    displaced = water.density * row.hull.immersed(row.draught).area * row.length
    masses = np.array([displaced - _pull(row, n, water, row.draught, level) / water.gravity for n in range(row.count)])
    if masses.min() <= 0.0:
        number = int(masses.argmin())
        raise InputError(
            f"the lines of unit {number + 1} pull more than its displacement of {displaced:.5g} kg",
            parameter="lines",
            remedy="use lighter or longer lines, or a larger draught",
        )
    return masses


def _draught(row: FloatingRow, water: Water, masses: Array, level: float) -> float:
    """Return the draught at which all units together float with the pull of their lines, by bisection."""
    top = row.hull.bottom + row.hull.height

    def surplus(draught: float) -> float:
        area = row.hull.immersed(draught).area
        pull = sum(_pull(row, n, water, draught, level) for n in range(row.count))
        return water.density * area * row.length * row.count - float(masses.sum()) - pull / water.gravity

    low, high = 1e-3 * top, top * (1.0 - 1e-9)
    if surplus(high) < 0.0:
        raise InputError(
            "the lines pull the row under at this water level", parameter="lines", remedy="use longer or lighter lines"
        )
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if surplus(middle) < 0.0 else (low, middle)
    return 0.5 * (low + high)


def _lines_of(row: FloatingRow, number: int, water: Water, draught: float, level: float) -> tuple[LineElement, ...]:
    place = row.placements[number]
    centre_z = row.centre_of_gravity_above_keel - draught
    return tuple(
        _place(line, place, number, row.count, centre_z, draught, water, level)
        for line in row.lines
        if number in line.units
    )


def _place(
    line: UnitLine, place: Placement, number: int, count: int, centre_z: float, draught: float, water: Water,
    level: float,
) -> LineElement:  # fmt: skip
    """Return a line in row axes, counted from the centre of gravity of its unit."""
    name = line.name if count == 1 else f"{line.name} {number + 1}"
    turn = place.rotation
    fairlead = turn @ np.array([line.fairlead[0], line.fairlead[1], line.fairlead[2] - draught - centre_z])
    if not line.segments:
        anchor = turn @ np.array([line.anchor[0], line.anchor[1], line.anchor[2] - level - centre_z])
        return SpringLine(
            name, _vector(anchor), _vector(fairlead), stiffness=line.stiffness, pretension=line.pretension,
            count=line.count,
        )  # fmt: skip
    if math.isinf(water.depth):
        raise InputError(
            f"line {line.name!r} goes to a bed that is infinitely deep",
            parameter="lines",
            remedy="give the water depth",
        )
    anchor = turn @ np.array([line.anchor[0], line.anchor[1], line.anchor[2] - water.depth - centre_z])
    return Line(
        name, _vector(anchor), _vector(fairlead), segments=line.segments, clumps=line.clumps,
        bed_friction=line.bed_friction, count=line.count,
    )  # fmt: skip


def _vector(values: Array) -> tuple[float, float, float]:
    return float(values[0]), float(values[1]), float(values[2])


@dataclass(frozen=True, eq=False)
class RowPosition:
    """The row at rest under steady loads."""

    #: From rest, row axes; shape (m,).
    position: Array
    #: Shape (m,).
    load: Array
    #: Of the constraints; shape (c,).
    held_load: Array


def steady_position(at: RowAtLevel, load: Array, work: Work | None = None) -> RowPosition:
    """Find where lines, buoyancy, connectors and a steady load balance [eq:units-steady].

    Parameters
    ----------
    at : RowAtLevel
    load : ndarray (m,)
    work : Work or None
        How waves work the curves of connectors about that position; a slack chain pulls in the mean.

    Raises
    ------
    InputError
        When the lines cannot hold the load.
    """
    rest = at.line_force(np.zeros(at.size))
    balanced = np.zeros(at.size)
    balanced[2::6] = rest[2::6]
    linear = at.hydrostatic + at.springs[0]

    def worked(width: float) -> Work:
        return Work(width) if work is None else replace(work, width=width)

    def imbalance(position: Array, width: float, share: float = 1.0) -> Array:
        curves = at.curve_force(position, worked(width))
        return at.line_force(position) - balanced + curves + share * load - linear @ position

    def tangent(position: Array, width: float) -> Array:
        curves = sum((link.stiffness(position, worked(width)) for link in at.links), np.zeros((at.size, at.size)))
        return -(at.line_stiffness(position) + linear + curves)

    free = at.free
    weight = float(at.masses.max()) * at.water.gravity
    size = np.tile([1.0, 1.0, 1.0, *([at.row.length] * 3)], at.row.count)
    scale = weight * np.sqrt(((free * size[:, None]) ** 2).sum(axis=0))

    def found(start: Array, factor: float, share: float) -> Array:
        """Return the motions left at rest with corners rounded over some widths, under a share of the load."""
        width = factor * at.rounding
        return newton_with_line_search(
            lambda motions: free.T @ imbalance(free @ motions, width, share),
            lambda motions: free.T @ tangent(free @ motions, width) @ free,
            start, scale, list(range(free.shape[1])), 1e-9,
        )[0]  # fmt: skip

    def settled(steps: Iterable[tuple[float, float]]) -> Array:
        motions = np.zeros(free.shape[1])
        for factor, share in steps:
            motions = found(motions, factor, share)
        return motions

    reduced = np.zeros(free.shape[1])
    if at.row.lines or np.any(load):
        try:
            reduced = settled((factor, 1.0) for factor in (_WIDER if at.links else (1.0,)))
        except ConvergenceError as first:
            try:
                growing = [(_SLOWLY[0], share) for share in _SHARES]
                reduced = settled([*growing, *((factor, 1.0) for factor in _SLOWLY)])
            except ConvergenceError:
                raise InputError(
                    f"{at.name}: the row finds no equilibrium under wind, current and drift: {first.fault.message}",
                    parameter="lines",
                    remedy="use stronger or more lines",
                ) from first
    position = free @ reduced
    return RowPosition(position, load, held_load(at, imbalance(position, at.rounding)))


def held_load(at: RowAtLevel, force: Any) -> Any:
    """Return the loads (..., c) of the constraints that balance forces (..., m) [eq:units-held]."""
    g = at.constraint
    if not len(g):
        return np.zeros((*np.shape(force)[:-1], 0))
    return np.asarray(force @ np.linalg.solve(g @ g.T, g).T)


def steady_load(at: RowAtLevel, environment: Environment) -> tuple[Array, Array]:
    """Return the forces (m,) of wind and of current on all units [eq:units-steady-load].

    Each unit carries the pressure across and along its own axes on its side and its end; no unit shelters another.
    """
    wind, current = np.zeros(at.size), np.zeros(at.size)
    row = at.row
    for number, place in enumerate(row.placements):
        part = slice(6 * number, 6 * number + 6)
        widths = (row.length, row.hull.beam)
        if environment.wind is not None:
            blowing, height = environment.wind, max(at.freeboard, 0.0)
            angle = blowing.heading - place.heading
            speeds = blowing.speed * np.array([math.cos(angle), math.sin(angle)])
            pressure = 0.5 * blowing.density * (row.wind_drag_coefficient or 0.0) * np.abs(blowing.speed) * speeds
            wind[part] = _load(place, pressure * widths * height, 0.5 * height - at.centres[number, 2])
        if environment.current is not None:
            z = np.linspace(-at.draught, 0.0, _LEVELS)
            velocity = np.asarray(environment.current.velocity(z), dtype=float)[..., :2] @ place.rotation[:2, :2]
            speed = np.hypot(*velocity.T)[:, None]
            coefficient = row.current_drag_coefficient or 0.0
            pressure = 0.5 * at.water.density * coefficient * speed * velocity * np.array(widths)
            total = np.trapezoid(pressure, z, axis=0)
            lever = np.trapezoid(pressure * (z - at.centres[number, 2])[:, None], z, axis=0)
            arm = float(np.hypot(*lever) / np.hypot(*total)) if np.hypot(*total) > 0.0 else 0.0
            sign = float(np.sign(lever @ total))
            current[part] = _load(place, total, sign * arm)
    return wind, current


def _load(place: Placement, force: Array, arm: float) -> Array:
    """Return a level force in unit axes at a height over the centre of gravity as six components in row axes."""
    level = place.rotation @ np.array([force[0], force[1], 0.0])
    return np.concatenate([level, np.cross([0.0, 0.0, arm], level)])


def level_notices(at: RowAtLevel) -> tuple[Notice, ...]:
    """Return what speaks against the row at rest."""
    notices = []
    if at.statics.metacentric_height <= 0.0:
        notices.append(
            Notice(
                "unstable", f"{at.name}: the metacentric height of a unit is {at.statics.metacentric_height:.3g} m",
                at.statics.metacentric_height, 0.0, "error", "lower the centre of gravity or widen the section",
            )
        )  # fmt: skip
    if at.freeboard <= 0.0:
        notices.append(
            Notice("freeboard", f"{at.name}: the deck is {-at.freeboard:.3g} m under water", at.freeboard, 0.0)
        )
    displaced = at.statics.displaced_mass
    pulls = np.array([-system.forces(np.zeros(6))[2] if system.lines else 0.0 for system in at.systems])
    share = 100.0 * (displaced - at.masses - pulls / at.water.gravity) / displaced
    spread = 100.0 * float(np.ptp(at.masses) / at.masses.mean())
    if spread > IMBALANCE_LIMIT:
        light, heavy = int(at.masses.argmin()), int(at.masses.argmax())
        notices.append(
            Notice(
                "unlike-masses",
                f"{at.name}: all units float at the draught of the case only where unit {light + 1} weighs "
                f"{1e-3 * at.masses[light]:.4g} t and unit {heavy + 1} {1e-3 * at.masses[heavy]:.4g} t, as their lines "
                "pull them down unlike",
                spread, IMBALANCE_LIMIT, remedy="check length and anchors of the lines of these units",
            )
        )  # fmt: skip
    worst = int(np.abs(share).argmax())
    if abs(share[worst]) > IMBALANCE_LIMIT:
        notices.append(
            Notice(
                "imbalance",
                f"{at.name}: unit {worst + 1} would float {share[worst]:+.2f} % of its displacement off the draught "
                "that all units are given",
                float(abs(share[worst])), IMBALANCE_LIMIT,
            )
        )  # fmt: skip
    return tuple(notices)


__all__ = ["RowAtLevel", "RowPosition", "assemble", "held_load", "level_notices", "steady_load", "steady_position"]
