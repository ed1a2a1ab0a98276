"""From the plan of a network to the network of :mod:`moyai.flexible`, at one water level."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import SPHERE, BarType, Strand
from moyai.flexible.network import Network
from moyai.mooring.lines import Clump, Line, LineType, Segment
from moyai.mooring.shape import line_shape
from moyai.sea.water import Water
from moyai.structures.network.model import (
    STILL,
    Attached,
    LinePlan,
    NetPlan,
    NetworkProblem,
    PartPlan,
    PointPlan,
    SheetPlan,
)


@dataclass(frozen=True, eq=False)
class Assembly:
    """A network with what the reports need to know about it."""

    #: z above the still water of its level.
    network: Network
    #: The lines of the case, whole.
    lines: Mapping[str, Strand]
    #: Nodes of the nets; shape (rows, columns).
    nets: Mapping[str, NDArray[np.int64]]
    #: Bars of the nets.
    net_bars: Mapping[str, NDArray[np.int64]]
    #: Parts of lines whose parts differ in strength.
    parts: Mapping[str, Strand] = field(default_factory=dict)
    #: Names of the sheets.
    sheets: tuple[str, ...] = ()
    #: Width of netting that an inner bar of a column stands for, by net whose bars gather twines [m].
    net_widths: Mapping[str, float] = field(default_factory=dict)
    #: That width over the one that each bar of a net stands for, 1 where bars are ropes.
    net_factors: Mapping[str, Array] = field(default_factory=dict)
    #: Height of its still water above datum [m].
    level: float = 0.0

    @property
    def judged(self) -> dict[str, NDArray[np.int64]]:
        """Bars by line, and by part of lines whose parts differ in strength."""
        return {name: strand.bars for name, strand in (*self.lines.items(), *self.parts.items())}

    def line_of(self, name: str) -> str:
        """Return the line that a part belongs to; a line itself."""
        return name.rpartition(" part ")[0] if name in self.parts and name not in self.lines else name

    def net_tensions(self, tension: Array) -> list[Array]:
        """Return of every net the tensions of its bars, each that of a strip of the same width, shape (rows, bars)."""
        return [tension[:, bars] * self.net_factors.get(name, 1.0) for name, bars in self.net_bars.items()]


def assemble(problem: NetworkProblem, level: float) -> Assembly:
    """Build the network at a water level.

    Parameters
    ----------
    problem : NetworkProblem
    level : float
        Height of the still water above datum [m].

    Raises
    ------
    InputError
        Named with the path in the case: points that lines name but nobody gives, points on no line, parts that nothing
        holds, points under the bed, free points without mass.
    """
    water = problem.environment.water_at(level)
    bed = problem.bed
    builder = NetworkBuilder(water, None if bed is None or math.isinf(water.depth) else bed.at(level, water))
    places: dict[str, tuple[float, float, float]] = {}
    for point in problem.points:
        place = _place(point.position, point.floats, level, water, builder.bed, f"points.{point.name}.position")
        places[point.name] = place
        _add_point(builder, point, place, water)
    for plan in problem.bodies:
        for name, where in plan.body(water).points_at_start.items():
            builder.driven(name, where)
    for net in problem.nets:
        _add_net(builder, net, level, water)
    for sheet in problem.sheets:
        _add_sheet(builder, sheet, level, water)
    pieces: dict[str, list[str]] = {}
    for line in problem.lines:
        pieces[line.name] = _add_line(builder, line, water)
    _check_ends(problem)
    if not (problem.points or problem.nets or problem.sheets or any(plan.points for plan in problem.bodies)):
        # bodies alone: a network has one point at least
        builder.fixed("site", (0.0, 0.0, -water.depth if math.isfinite(water.depth) else 0.0))
    network = builder.build()
    network = _with_rows(network, problem, pieces)
    lines = {name: _joined(network, name, parts) for name, parts in pieces.items()}
    nets, bars, factors = {}, {}, {}
    for net in problem.nets:
        nets[net.name] = np.array(
            [[network.points[f"{net.name}[{i},{j}]"] for j in range(net.columns)] for i in range(net.rows)]
        )
        own = [strand for strand in network.strands if strand.name.startswith(f"{net.name} ")]
        bars[net.name] = np.concatenate([strand.bars for strand in own]) if own else np.zeros(0, dtype=np.int64)
        factors[net.name] = np.array([_strip_factor(net, strand) for strand in own for _ in strand.bars])
    differing = {name: network.strand(name) for name in problem.strengths if name not in lines}
    return Assembly(
        network, lines, nets, bars, differing, tuple(sheet.name for sheet in problem.sheets),
        {net.name: net.strips[1] for net in problem.nets if net.strips is not None}, factors, level,
    )  # fmt: skip


def _strip_factor(net: NetPlan, strand: Strand) -> float:
    """Return the width of netting of an inner column over that which a bar of a net stands for."""
    if net.strips is None:
        return 1.0
    kind, number = strand.name.removeprefix(f"{net.name} ").split(" ")[:2]
    own, last = (net.strips[0], net.rows - 1) if kind == "row" else (net.strips[1], net.columns - 1)
    return net.strips[1] / (own * (0.5 if int(number) in (0, last) else 1.0))


def _place(
    position: tuple[float, float, float], floats: bool, level: float, water: Water, bed: Bed | None, parameter: str
) -> tuple[float, float, float]:
    x, y, z = position
    if math.isnan(z):
        if math.isinf(water.depth):
            raise InputError("'bed' needs a finite water depth", parameter=parameter, remedy="give z as a number")
        return x, y, -water.depth if bed is None else float(bed.level_at(np.array([x, y])))
    height = z if floats else z - level
    depth = water.depth if bed is None else -float(bed.level_at(np.array([x, y])))
    if height < -depth - (1e-9 * water.depth if bed is None else bed.tolerance):
        raise InputError(
            f"z = {z:g} m lies under the bed, which is {depth:g} m below still water",
            parameter=parameter,
            allowed=f"at least {-depth + (0.0 if floats else level):g} m, or the word bed",
        )
    return x, y, height


def _add_point(builder: NetworkBuilder, point: PointPlan, place: tuple[float, float, float], water: Water) -> None:
    if point.kind == "fixed":
        builder.fixed(point.name, place)
    elif point.kind == "driven":
        builder.driven(point.name, place, point.motion or STILL)
    else:
        builder.free(point.name, place, held=point.held, **_carried(point.attached, water))


def _carried(attached: Attached, water: Water) -> dict[str, Any]:
    return {
        "mass": attached.mass,
        "volume": attached.volume,
        "height": attached.height,
        "form": attached.form,
        "drag_area": attached.drag_area,
        "added_mass": attached.added_mass_coefficient * water.density * attached.volume,
        "contact_area": attached.contact_area,
    }


def _check_ends(problem: NetworkProblem) -> None:
    """Refuse points that no line meets: they would float about, or mean a slip of the pen."""
    used = {name for line in problem.lines for name in (line.start, line.end)}
    for body in problem.bodies:
        for name in body.points:
            if name not in used:
                raise InputError(
                    f"no line meets the point '{name}' of the body '{body.name}'",
                    parameter=f"bodies.{body.name}.points.{name}",
                    remedy="join a line to it, or remove it",
                )
    for point in problem.points:
        if point.name not in used:
            raise InputError(
                f"no line meets the point '{point.name}'",
                parameter=f"points.{point.name}",
                remedy="join a line to it, or remove it",
            )


def _parts_shape(builder: NetworkBuilder, line: LinePlan, water: Water) -> list[Array]:
    """Return where the inner nodes of every part and the joints between them start."""
    a, b = builder.position(line.start), builder.position(line.end)
    total, along = line.length, []
    passed = 0.0
    for part in line.parts:
        along.append((passed + part.length * np.arange(1, part.segments + 1) / part.segments) / total)
        passed += part.length
    every = np.concatenate(along)
    points = a + every[:, None] * (b - a)
    if line.shape == "catenary":
        points = _catenary(builder, line, water, a, b, every, points)
    if builder.bed is not None:
        points = builder.bed.carried(points)
    cuts = np.cumsum([part.segments for part in line.parts])
    return list(np.split(points, cuts[:-1]))


def _catenary(
    builder: NetworkBuilder, line: LinePlan, water: Water, a: Array, b: Array, every: Array, chord: Array
) -> Array:
    """Return the elastic catenary of all parts and clumps, or a sagging curve where there is none."""
    weights = [part.bar_type.submerged_weight_per_length(water) for part in line.parts]
    span = float(np.linalg.norm(b - a))
    if line.length <= span:
        return chord
    bed, low = builder.bed, (a if a[2] <= b[2] else b)
    level = bed.level_for(low) if bed is not None else low[2] - 10.0 * line.length
    mean = sum(w * part.length for w, part in zip(weights, line.parts, strict=True)) / line.length
    upwards = mean < 0.0
    if min(weights) > 0.0:
        low, high, place = (a, b, every) if a[2] <= b[2] else (b, a, 1.0 - every)
        order = range(len(line.parts)) if a[2] <= b[2] else range(len(line.parts) - 1, -1, -1)
        segments = tuple(
            Segment(LineType("part", weights[k], line.parts[k].bar_type.axial_stiffness), line.parts[k].length)
            for k in order
        )
        hung = [None if item is None else (item.mass - water.density * item.volume) * water.gravity
                for item in line.between]  # fmt: skip
        hung = hung if a[2] <= b[2] else hung[::-1]
        clumps = tuple(Clump(k, value) for k, value in enumerate(hung) if value is not None)
        try:
            shape = line_shape(
                Line("start", tuple(low), tuple(high), segments, clumps), high, -level, points=max(80, 3 * every.size)
            )
            found = np.stack(
                [np.interp(place * line.length, shape.arc_length, shape.points[:, k]) for k in range(3)], axis=1
            )
            if np.isfinite(found).all():
                return found
        except InputError:
            pass
    # a parabola of about the right length; statics finds the rest
    sag = math.sqrt(3.0 / 8.0 * max(line.length - span, 0.0) * max(span, 1e-3 * line.length))
    drop = 4.0 * sag * every * (1.0 - every) * (1.0 if upwards else -1.0)
    out = chord + np.stack([np.zeros_like(drop), np.zeros_like(drop), drop], axis=1)
    out[:, 2] = np.maximum(out[:, 2], min(level, a[2], b[2]))
    return np.asarray(out)


def _add_line(builder: NetworkBuilder, line: LinePlan, water: Water) -> list[str]:
    for key in ("start", "end"):
        try:
            builder.position(getattr(line, key))
        except InputError as error:
            raise error.at(f"lines.{line.name}.{key}") from None
    shapes = _parts_shape(builder, line, water)
    names: list[str] = []
    start = line.start
    for number, (part, points) in enumerate(zip(line.parts, shapes, strict=True)):
        last = number == len(line.parts) - 1
        end = line.end if last else f"{line.name} joint {number + 1}"
        if not last:
            carried = line.between[number] if line.between else None
            builder.free(end, points[-1], **_carried(carried or Attached(), water))
        name = line.name if len(line.parts) == 1 else f"{line.name} part {number + 1}"
        builder.line(
            name, start, end, part.bar_type, length=part.length, segments=part.segments, shape=points[:-1],
            flow_factor=line.flow_factor,
        )  # fmt: skip
        names.append(name)
        start = end
    return names


def _joined(network: Network, name: str, parts: list[str]) -> Strand:
    found = [network.strand(part) for part in parts]
    nodes = np.concatenate([found[0].nodes, *(strand.nodes[1:] for strand in found[1:])])
    return Strand(name, nodes, np.concatenate([strand.bars for strand in found]))


def _add_net(builder: NetworkBuilder, net: NetPlan, level: float, water: Water) -> None:
    parameter = f"nets.{net.name}.corners"
    corners = [np.array(_place(corner, net.floats, level, water, builder.bed, parameter)) for corner in net.corners]
    u = np.linspace(0.0, 1.0, net.columns)[None, :, None]
    v = np.linspace(0.0, 1.0, net.rows)[:, None, None]
    grid = (1.0 - v) * ((1.0 - u) * corners[0] + u * corners[1]) + v * ((1.0 - u) * corners[3] + u * corners[2])
    bottom = float(np.sum(np.linalg.norm(np.diff(grid[-1], axis=0), axis=1))) * net.ballast
    sinkers = np.full(net.columns, bottom / (net.columns - 1))
    sinkers[[0, -1]] *= 0.5
    for i in range(net.rows):
        for j in range(net.columns):
            label = f"{net.name}[{i},{j}]"
            if i > 0 or net.first_row == "free":
                # the mass in water of a sinker line, which is taken for its inertia too
                load = sinkers[j] if i == net.rows - 1 else 0.0
                builder.free(label, grid[i, j], mass=load, volume=0.0)
            elif net.first_row == "fixed":
                builder.fixed(label, grid[i, j])
            else:
                builder.driven(label, grid[i, j], net.motion or STILL)

    def join(kind: str, number: int, first: tuple[int, int], second: tuple[int, int], bar: BarType) -> None:
        distance = float(np.linalg.norm(grid[second] - grid[first]))
        if distance <= 0.0:
            raise InputError(
                f"knots {first} and {second} are at the same place",
                parameter=f"nets.{net.name}.corners",
                remedy="give four different corners, once around the net",
            )
        labels = [f"{net.name}[{i},{j}]" for i, j in (first, second)]
        builder.line(
            f"{net.name} {kind} {number} bar {labels[1]}", labels[0], labels[1], bar,
            length=distance / net.hanging_ratio, segments=1, shape="straight", flow_factor=net.flow_factor,
        )  # fmt: skip

    for i in range(net.rows):
        bar = net.along[1 if i in (0, net.rows - 1) else 0]
        for j in range(net.columns - 1):
            join("row", i, (i, j), (i, j + 1), bar)
    for j in range(net.columns):
        bar = net.across[1 if j in (0, net.columns - 1) else 0]
        for i in range(net.rows - 1):
            join("column", j, (i, j), (i + 1, j), bar)


def _add_sheet(builder: NetworkBuilder, sheet: SheetPlan, level: float, water: Water) -> None:
    parameter = f"sheets.{sheet.name}.corners"
    a, b, c, d = (
        np.array(_place(corner, sheet.floats, level, water, builder.bed, parameter)) for corner in sheet.corners
    )
    u, v = np.linspace(0.0, 1.0, sheet.columns)[None, :, None], np.linspace(0.0, 1.0, sheet.rows)[:, None, None]
    grid = (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * d + u * c)
    high = 0.5 * float(np.linalg.norm(d - a) + np.linalg.norm(c - b)) * sheet.fullness
    wide = 0.5 * float(np.linalg.norm(b - a) + np.linalg.norm(c - d)) * sheet.fullness
    if not (high > 0.0 and wide > 0.0):
        raise InputError("two corners are at the same place", parameter=parameter, remedy="give four different corners")
    try:
        builder.sheet(
            sheet.name, grid, warp=np.linspace(0.0, high, sheet.rows), weft=np.linspace(0.0, wide, sheet.columns),
            first_row=sheet.first_row, motion=(sheet.motion or STILL) if sheet.first_row == "driven" else None,
            **sheet.properties,
        )  # fmt: skip
    except InputError as error:
        raise error.at(f"sheets.{sheet.name}") from None


def _with_rows(network: Network, problem: NetworkProblem, pieces: dict[str, list[str]]) -> Network:
    """Return the network with floats and weights along its lines put on the nearest nodes."""
    if not any(line.along for line in problem.lines):
        return network
    nodes, water = network.nodes, network.water
    arrays = {key: np.array(getattr(nodes, key)) for key in ("mass", "volume", "drag_area", "added_mass", "height")}
    form = np.array(nodes.form)
    for line in problem.lines:
        strand = _joined(network, line.name, pieces[line.name])
        along = np.concatenate([[0.0], np.cumsum(network.bars.length[strand.bars])])
        for row in line.along:
            for k in range(row.count):
                # ends belong to the points there
                inner = along[1:-1]
                if inner.size == 0:
                    raise InputError(
                        f"the line '{line.name}' has one bar: a clump along it needs at least two",
                        parameter=f"lines.{line.name}.along",
                        remedy="give it more segments",
                    )
                node = strand.nodes[1 + int(np.argmin(np.abs(inner - line.length * (k + 0.5) / row.count)))]
                carried = _carried(row.attached, water)
                for key in ("mass", "volume", "drag_area", "added_mass"):
                    arrays[key][node] += carried[key]
                arrays["height"][node] = max(arrays["height"][node], carried["height"])
                form[node] = row.attached.form
    return replace(network, nodes=replace(nodes, form=form, **arrays))


def sphere(diameter: float, mass: float, drag_coefficient: float, added_mass_coefficient: float) -> Attached:
    """Return a spherical float."""
    return Attached(
        mass, math.pi / 6.0 * diameter**3, diameter, SPHERE, drag_coefficient * math.pi / 4.0 * diameter**2,
        added_mass_coefficient,
    )  # fmt: skip


def mesh_bars(twine: BarType, pitch: float, spacing: float, name: str) -> tuple[BarType, BarType]:
    """Return the bar that gathers the twines of a strip of a net, and that of half a strip at its edge.

    Projected area, mass, volume, stiffness and viscosity of all twines of the strip are kept.

    Parameters
    ----------
    twine : BarType
        One twine.
    pitch, spacing : float
        Distance of twines of the mesh, and of bars of the model [m].
    name : str
    """

    def gathered(count: float, label: str) -> BarType:
        return replace(
            twine, name=label, mass_per_length=count * twine.mass_per_length,
            axial_stiffness=count * twine.axial_stiffness, diameter=count * twine.diameter,
            volume_per_length=count * twine.volume_per_length, viscosity=count * twine.viscosity,
        )  # fmt: skip

    count = spacing / pitch
    return gathered(count, name), gathered(0.5 * count, f"{name}, edge")


__all__ = ["Assembly", "PartPlan", "assemble", "mesh_bars", "sphere"]
