"""Smooth (C1) tables of the planar force of mooring lines for time integration, with their measured error.

H and V of a line are tabulated over xi = X - X_r(Z) and Z, where X_r is the distance at which the line lifts off its
anchor: the jump of curvature there falls on a grid line. Bicubic Hermite cells take the exact stiffness as slopes, and
rows and columns are added until the interpolated force meets the wanted accuracy; the error is then measured at random
points.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.mooring import planar_kernel as pk
from moyai.mooring.lines import Line, SpringLine
from moyai.mooring.system import LineSystem

_BINS = 512
_MOST_XI, _MOST_Z = 600, 120
_MOST_SEGMENTED = 300, 64
_ROUNDS = 24


@dataclass(frozen=True)
class TabulatedForce:
    """Table of (H, V) of one line over the distance of its ends."""

    #: The line.
    line: Line
    #: [m].
    water_depth: float
    #: Window of X in which the table was asked for [m].
    horizontal_range: tuple[float, float]
    #: Window of Z in which the table was asked for [m].
    vertical_range: tuple[float, float]
    #: Relative accuracy asked for: |error of (H, V)| over the tension.
    tolerance: float
    #: Largest relative error found at 4000 random points of the window.
    measured_error: float
    #: Forces and derivatives at the nodes, for :func:`moyai.mooring.planar_kernel.table_force`.
    nodes: Array = field(repr=False)
    #: First cell of every uniform bin, for the same function.
    lookup: IntArray = field(repr=False)
    #: Integers of the line, for the same function.
    index: IntArray = field(repr=False)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of nodes along xi and Z."""
        return int(self.index[1]), int(self.index[2])

    def evaluate(self, horizontal: ArrayLike, vertical: ArrayLike) -> tuple[Array, Array]:
        """Return H and V [N] at distances [m]; NaN outside the window."""
        x, z = np.broadcast_arrays(np.asarray(horizontal, dtype=float), np.asarray(vertical, dtype=float))
        out = np.empty((x.size, 2))
        pk.table_force_batch(x.ravel(), z.ravel(), self.index, self.nodes, self.lookup, out)
        return out[:, 0].reshape(x.shape), out[:, 1].reshape(x.shape)


def _exact(line: Line, depth: float, x: Array, z: Array) -> Array:
    """Return (..., 6): H, V, dH/dX, dH/dZ, dV/dX, dV/dZ."""
    out, _ = line.solve_plane(x.ravel(), z.ravel(), depth)
    return out[:, [0, 1, 5, 6, 7, 8]].reshape(*x.shape, 6)


def _lift_off_distance(line: Line, depth: float, z: Array) -> Array | None:
    """Return the distance at which the line lifts off its anchor for every height, or None where it never does."""
    if line.bed_clearance(depth) != 0.0:
        return None
    low, high = np.zeros_like(z), np.full_like(z, 2.0 * line.length)

    def lifted(x: Array) -> NDArray[np.bool_]:
        out, _ = line.solve_plane(x, z, depth)
        return out[:, 10] > 0.0

    if not np.all(lifted(high)) or np.any(lifted(low)):
        return None
    for _ in range(60):
        middle = 0.5 * (low + high)
        up = lifted(middle)
        high = np.where(up, middle, high)
        low = np.where(up, low, middle)
    return 0.5 * (low + high)


def _bins(nodes: Array) -> IntArray:
    """Return the cell that holds the lower edge of every uniform bin."""
    edges = nodes[0] + (nodes[-1] - nodes[0]) * np.arange(_BINS) / _BINS
    values: IntArray = np.clip(np.searchsorted(nodes, edges, side="right") - 1, 0, len(nodes) - 2).astype(np.int64)
    return values


@dataclass(frozen=True)
class _Grid:
    """Nodes of a table under construction."""

    line: Line
    depth: float
    xi: Array
    z: Array
    reference: Array
    slope: Array

    def reference_at(self, z: Array) -> Array:
        """Interpolate the reference distance as the compiled table does."""
        j = np.clip(np.searchsorted(self.z, z, side="right") - 1, 0, len(self.z) - 2)
        dz = self.z[j + 1] - self.z[j]
        t = (z - self.z[j]) / dz
        u = 1.0 - t
        ends = u * u * (1 + 2 * t) * self.reference[j] + t * t * (3 - 2 * t) * self.reference[j + 1]
        return ends + t * u * u * dz * self.slope[j] - t * t * u * dz * self.slope[j + 1]

    def node_values(self) -> Array:
        """Return (xi, z, 8): H and V with their slopes and mixed derivative over (xi, Z)."""
        x = self.xi[:, None] + self.reference
        z = np.broadcast_to(self.z, x.shape)
        exact = _exact(self.line, self.depth, x, z)
        step = 1e-5 * (self.z[-1] - self.z[0])
        around = []
        for sign in (1.0, -1.0):
            shifted = np.clip(self.z + sign * step, self.z[0], self.z[-1])
            grid = np.broadcast_to(shifted, x.shape)
            around.append((shifted, _exact(self.line, self.depth, self.xi[:, None] + self.reference_at(shifted), grid)))
        mixed = (around[0][1] - around[1][1]) / (around[0][0] - around[1][0])[None, :, None]
        out = np.empty((*x.shape, 8))
        for block, force, by_x, by_z in ((0, 0, 2, 3), (4, 1, 4, 5)):
            out[..., block] = exact[..., force]
            out[..., block + 1] = exact[..., by_x]
            out[..., block + 2] = exact[..., by_z] + exact[..., by_x] * self.slope
            out[..., block + 3] = mixed[..., by_x]
        return out

    @cached_property
    def packed(self) -> tuple[Array, IntArray, IntArray]:
        """Nodes, lookup and index for the compiled table."""
        nodes = np.concatenate([self.xi, self.z, self.reference, self.slope, self.node_values().ravel()])
        lookup = np.concatenate([_bins(self.xi), _bins(self.z)])
        index = np.array([0, len(self.xi), len(self.z), 0, _BINS, _BINS], dtype=np.int64)
        return nodes, lookup, index


def _grid(line: Line, depth: float, xi: Array, z: Array, aligned: bool) -> _Grid:
    from scipy.interpolate import CubicSpline

    reference = _lift_off_distance(line, depth, z) if aligned else None
    if reference is None:
        return _Grid(line, depth, xi, z, np.zeros_like(z), np.zeros_like(z))
    return _Grid(line, depth, xi, z, reference, CubicSpline(z, reference)(z, 1))


def _errors(grid: _Grid, x: Array, z: Array) -> Array:
    """Return the relative error of the table at points of any shape."""
    nodes, lookup, index = grid.packed
    out = np.empty((x.size, 2))
    pk.table_force_batch(x.ravel(), z.ravel(), index, nodes, lookup, out)
    exact = _exact(grid.line, grid.depth, x, z)
    found = out.reshape(*x.shape, 2)
    tension = np.maximum(np.hypot(exact[..., 0], exact[..., 1]), 1e-300)
    return np.nan_to_num(np.hypot(found[..., 0] - exact[..., 0], found[..., 1] - exact[..., 1]) / tension)


def tabulate_line(
    line: Line,
    water_depth: float,
    horizontal_range: tuple[float, float],
    vertical_range: tuple[float, float],
    tolerance: float,
) -> TabulatedForce:
    """Tabulate the planar force of a line to a wanted accuracy.

    Parameters
    ----------
    line : Line
        Of any number of segments.
    water_depth : float
        [m].
    horizontal_range, vertical_range : tuple
        Window of the distances from anchor to fairlead [m].
    tolerance : float
        |error of (H, V)| over the tension that is aimed at; ``measured_error`` gives what was reached.

    Raises
    ------
    InputError
        For an empty window or one that reaches under the bed.
    """
    if not (0.0 <= horizontal_range[0] < horizontal_range[1] and vertical_range[0] < vertical_range[1]):
        raise InputError(f"window {horizontal_range} x {vertical_range} m is empty", parameter="horizontal_range")
    if line.bed_clearance(water_depth) >= 0.0 and line.anchor[2] + vertical_range[0] < -water_depth:
        raise InputError("the window reaches under the bed", parameter="vertical_range", remedy="raise its lower limit")
    if not tolerance > 0.0:
        raise InputError(f"{tolerance:g}", parameter="tolerance", allowed="greater than 0")
    z = np.linspace(*vertical_range, 5)
    lift = _lift_off_distance(line, water_depth, z)
    aligned = lift is not None and bool(np.any((lift > horizontal_range[0]) & (lift < horizontal_range[1])))
    if aligned and lift is not None:
        ends = np.array([horizontal_range[0] - lift.max(), horizontal_range[1] - lift.min()])
        ends[0] = min(ends[0], -1e-6 * line.length)
        ends[1] = max(ends[1], 1e-6 * line.length)
        ends[0] = max(ends[0], -lift.min())  # distances are not negative
        xi = np.unique(np.concatenate([np.linspace(ends[0], 0.0, 7), np.linspace(0.0, ends[1], 5)]))
    else:
        xi = np.linspace(*horizontal_range, 9)
    grid = _grid(line, water_depth, xi, z, aligned)
    most_xi, most_z = (_MOST_XI, _MOST_Z) if line.is_uniform else _MOST_SEGMENTED
    history: list[float] = []
    for _ in range(_ROUNDS):
        xi_mid = 0.5 * (grid.xi[1:] + grid.xi[:-1])
        z_mid = 0.5 * (grid.z[1:] + grid.z[:-1])
        both = np.sort(np.concatenate([grid.z, z_mid]))
        across = _errors(
            grid, xi_mid[:, None] + grid.reference_at(both), np.broadcast_to(both, (len(xi_mid), len(both)))
        )
        along = _errors(
            grid, grid.xi[:, None] + grid.reference_at(z_mid), np.broadcast_to(z_mid, (len(grid.xi), len(z_mid)))
        )
        history.append(float(max(across.max(), along.max())))
        if len(history) > 4 and history[-1] > 10.0 * tolerance and history[-1] > 0.3 * history[-3]:
            break  # a sharp bend of the force: more nodes hardly help
        # a cell middle shows most of the error, not all of it
        split_z = along.max(axis=0) > 0.4 * tolerance
        split_xi = across[:, ::2].max(axis=1) > 0.4 * tolerance
        if not (split_z.any() or split_xi.any()):
            split_xi = across.max(axis=1) > 0.7 * tolerance
        room_xi, room_z = len(grid.xi) < most_xi, len(grid.z) < most_z
        if not ((split_z.any() and room_z) or (split_xi.any() and room_xi)):
            break
        new_xi = np.sort(np.concatenate([grid.xi, xi_mid[split_xi]])) if room_xi else grid.xi
        new_z = np.sort(np.concatenate([grid.z, z_mid[split_z]])) if room_z else grid.z
        grid = _grid(line, water_depth, new_xi, new_z, aligned)
    random = np.random.default_rng(20240)
    points_x = random.uniform(*horizontal_range, 4000)
    points_z = random.uniform(*vertical_range, 4000)
    nodes, lookup, index = grid.packed
    return TabulatedForce(
        line,
        water_depth,
        horizontal_range,
        vertical_range,
        tolerance,
        float(_errors(grid, points_x, points_z).max()),
        nodes,
        lookup,
        index,
    )


@dataclass(frozen=True)
class CompiledLines:
    """All lines of a planar system as arrays for :func:`moyai.mooring.planar_kernel.planar_line_force`."""

    #: Passed on to the compiled function in this order.
    parameters: Array
    #: Passed on to the compiled function in this order.
    index: IntArray
    #: Passed on to the compiled function in this order.
    nodes: Array
    #: Passed on to the compiled function in this order.
    lookup: IntArray
    #: The table of every line, None where the exact solver serves.
    tables: tuple[TabulatedForce | None, ...]

    @property
    def arguments(self) -> tuple[Array, IntArray, Array, IntArray]:
        """``(parameters, index, nodes, lookup)``."""
        return self.parameters, self.index, self.nodes, self.lookup

    @property
    def measured_error(self) -> float:
        """Largest measured error of the tables; 0 when all lines are exact."""
        return max((table.measured_error for table in self.tables if table is not None), default=0.0)

    def forces(self, position: ArrayLike) -> tuple[Array, Array]:
        """Return force (..., 3) on the body and tensions (..., lines) for planar positions (..., 3)."""
        array = np.asarray(position, dtype=float)
        flat = np.ascontiguousarray(array.reshape(-1, 3))
        force = np.zeros_like(flat)
        tension = np.zeros((len(flat), len(self.parameters)))
        pk.planar_line_force_batch(flat, *self.arguments, force, tension)
        return force.reshape(array.shape), tension.reshape(*array.shape[:-1], -1)


def compile_lines(
    system: LineSystem,
    motion_range: tuple[tuple[float, float], tuple[float, float], tuple[float, float]] | None = None,
    tolerance: float | None = None,
    *,
    reach: Array | None = None,
) -> CompiledLines:
    """Prepare the lines of a system for time integration.

    Parameters
    ----------
    system : LineSystem
        Lines and springs.
    motion_range : three pairs, optional
        Lowest and highest sway [m], heave [m], roll [rad] for which tables are made; beyond it the exact solver serves.
    tolerance : float, optional
        Wanted accuracy of the tables over the tension. Without range and tolerance every line is solved exactly, and so
        is a line whose table misses the tolerance twofold (a clump that lifts off the bed).
    reach : ndarray (lines, 2, 2), optional
        Least and largest level distance of the ends of every line, and height of the fairlead over the anchor [m], for
        which tables are made, in place of a planar motion. Lines that are alike share a table.

    Raises
    ------
    InputError
        When only one of range and tolerance is given, or a line does not follow the protocol.
    """
    if (motion_range is None and reach is None) != (tolerance is None):
        raise InputError("tables need both a motion range and a tolerance", parameter="tolerance")
    parameters = np.zeros((len(system.lines), 16))
    index = np.full((len(system.lines), 8), -1, dtype=np.int64)
    nodes: list[Array] = [np.zeros(1)]
    lookups: list[IntArray] = [np.zeros(1, dtype=np.int64)]
    tables: list[TabulatedForce | None] = []
    for i, line in enumerate(system.lines):
        row = parameters[i]
        row[pk.ANCHOR_X : pk.ANCHOR_Z + 1] = line.anchor
        row[pk.FAIRLEAD_X : pk.FAIRLEAD_Z + 1] = line.fairlead
        row[pk.COUNT] = line.count
        tables.append(None)
        if isinstance(line, SpringLine):
            row[pk.KIND] = pk.SPRING
            row[pk.RATE], row[pk.NATURAL], row[pk.TENSION_ONLY] = line.stiffness, line.natural_length, line.tension_only
            continue
        if not isinstance(line, Line):
            raise InputError(f"{type(line).__name__} cannot be compiled", parameter=f"lines.{line.name}")
        rows = line.table
        row[pk.KIND] = pk.UNIFORM if line.is_uniform else pk.SEGMENTED
        row[pk.LENGTH], row[pk.AXIAL], row[pk.WEIGHT] = line.length, rows[0, 1], rows[0, 2]
        row[pk.CLEARANCE], row[pk.FRICTION] = line.bed_clearance(system.water_depth), line.bed_friction
        index[i, pk.ROWS], index[i, pk.ROW_COUNT] = sum(map(len, nodes)), len(rows)
        nodes.append(rows.ravel())
        if tolerance is None:
            continue
        if reach is not None:
            alike = [
                n for n, other in enumerate(system.lines) if isinstance(other, Line) and _alone(other) == _alone(line)
            ]
            window = _wider(line, reach[alike, :, 0].min(axis=0), reach[alike, :, 1].max(axis=0), system.water_depth)
        else:
            assert motion_range is not None
            window = _window(line, motion_range, system.water_depth)
        table = _table(_alone(line), system.water_depth, *window, tolerance)
        if table.measured_error > 2.0 * tolerance:
            continue  # a clump that lifts off bends the force sharply: no smooth table follows that
        index[i, : pk.ROWS] = table.index
        same = next((n for n, other in enumerate(tables) if other is table), None)
        tables[-1] = table
        if same is not None:
            index[i, [pk.TABLE, pk.LOOKUP]] = index[same, [pk.TABLE, pk.LOOKUP]]
            continue
        index[i, pk.TABLE] = sum(map(len, nodes))
        index[i, pk.LOOKUP] = sum(map(len, lookups))
        nodes.append(table.nodes)
        lookups.append(table.lookup)
    return CompiledLines(parameters, index, np.concatenate(nodes), np.concatenate(lookups), tuple(tables))


def _window(
    line: Line, motion: tuple[tuple[float, float], tuple[float, float], tuple[float, float]], depth: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the ranges of distance and height that the fairlead can reach."""
    rolls = np.linspace(*motion[2], 41)
    arm_x = line.fairlead[0] * np.cos(rolls) + line.fairlead[2] * np.sin(rolls)
    arm_z = -line.fairlead[0] * np.sin(rolls) + line.fairlead[2] * np.cos(rolls)
    dx = np.array([motion[0][0] + arm_x.min(), motion[0][1] + arm_x.max()]) - line.anchor[0]
    dy = line.fairlead[1] - line.anchor[1]
    nearest = 0.0 if dx[0] * dx[1] < 0.0 else float(np.abs(dx).min())
    low = float(np.hypot(nearest, dy))
    high = float(np.hypot(np.abs(dx).max(), dy))
    bottom = motion[1][0] + float(arm_z.min()) - line.anchor[2]
    top = motion[1][1] + float(arm_z.max()) - line.anchor[2]
    if line.bed_clearance(depth) >= 0.0:
        bottom = max(bottom, -depth - line.anchor[2] + 1e-9 * line.length)
    return _wider(line, np.array([low, bottom]), np.array([high, top]), depth)


def _wider(line: Line, least: Array, largest: Array, depth: float) -> tuple[tuple[float, float], tuple[float, float]]:
    """Widen least and largest distance and height of a fairlead over its anchor, not below the bed."""
    if not np.all(largest > least):
        raise InputError("the line is taut within the motion range", parameter=f"lines.{line.name}")
    low, high = _outward(float(least[0]), float(largest[0]))
    bottom, top = _outward(float(least[1]), float(largest[1]))
    floor = -math.inf if line.bed_clearance(depth) < 0.0 else -depth - line.anchor[2] + 1e-9 * line.length
    return (low, high), (max(bottom, floor), top)


def _alone(line: Line) -> Line:
    """Return a line without its name, place and number, which do not count for its table."""
    return replace(line, name="line", anchor=(0.0, 0.0, line.anchor[2]), fairlead=(0.0, 0.0, 0.0), count=1)


def _outward(low: float, high: float) -> tuple[float, float]:
    """Widen a range by up to an eighth at each end, to round numbers: runs of near motions then share one table."""
    step = 2.0 ** math.floor(math.log2(high - low)) / 8.0
    return math.floor(low / step) * step, math.ceil(high / step) * step


@lru_cache(maxsize=64)
def _table(
    line: Line,
    water_depth: float,
    horizontal_range: tuple[float, float],
    vertical_range: tuple[float, float],
    tolerance: float,
) -> TabulatedForce:
    """Return :func:`tabulate_line` of a line whose name, place and number do not count; the last ones are kept."""
    return tabulate_line(line, water_depth, horizontal_range, vertical_range, tolerance)
