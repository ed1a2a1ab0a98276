"""Build the network of a flexible cage: knots, grouped twines, panels, collar, weights, grid, anchor lines."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.flexible.elements import FIXED, FREE, SPHERE, Bars, BarType, Nodes, Strand
from moyai.flexible.mesh_groups import group_meshes
from moyai.flexible.network import Network
from moyai.flexible.panels import NetPanels, PanelLaw, panel_areas
from moyai.flexible.rings import Ring
from moyai.structures.cage.flexible.collar import Pipe
from moyai.structures.cage.flexible.design import CageDesign
from moyai.structures.cage.flexible.grid_mooring import GridMooring
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.parts import CageNetwork, CageParts, LinePart, enclosed_volume
from moyai.tables.lines import LineProperties

#: Spacing of knots around over that at the rim below which the bottom drops every second one.
_CROWDED = 0.55


@dataclass
class _Assembly:
    """Collects nodes, bars and what hangs on them."""

    places: list[Array] = field(default_factory=list)
    kinds: list[int] = field(default_factory=list)
    attached: dict[int, dict[str, float]] = field(default_factory=dict)
    start: list[int] = field(default_factory=list)
    end: list[int] = field(default_factory=list)
    length: list[float] = field(default_factory=list)
    kind: list[int] = field(default_factory=list)
    types: list[BarType] = field(default_factory=list)
    strands: list[Strand] = field(default_factory=list)
    corners: list[IntArray] = field(default_factory=list)
    group: list[int] = field(default_factory=list)
    rings: list[Ring] = field(default_factory=list)

    def nodes(self, places: Array, kind: int = FREE) -> IntArray:
        """Add nodes (k, 3); return their numbers."""
        first = len(self.kinds)
        self.places.extend(np.asarray(places, dtype=np.float64))
        self.kinds.extend([kind] * len(places))
        return np.arange(first, first + len(places))

    def attach(self, node: int, **values: float) -> None:
        """Add mass, volume, ... to a node."""
        own = self.attached.setdefault(int(node), {})
        for key, value in values.items():
            own[key] = own.get(key, 0.0) + value if key not in ("height", "form") else value

    def bars(
        self, start: IntArray, end: IntArray, length: Array, types: tuple[BarType, ...], kind: IntArray
    ) -> IntArray:
        """Add bars; return their numbers."""
        first = len(self.start)
        base = len(self.types)
        self.types.extend(types)
        self.start.extend(int(i) for i in start)
        self.end.extend(int(i) for i in end)
        self.length.extend(float(value) for value in length)
        self.kind.extend(base + int(k) for k in kind)
        return np.arange(first, len(self.start))

    def place(self, nodes: IntArray) -> Array:
        """Return the places of nodes."""
        return np.stack([self.places[int(i)] for i in nodes])


def _outline(design: CageDesign, around: int, offset: float) -> Array:
    """Return the knots of the collar around (0, 0), the first towards +x (circle) or at a corner (square)."""
    if design.shape == "circular":
        angle = 2.0 * math.pi * np.arange(around) / around
        # the polygon encloses the area of the circle
        radius = 0.5 * design.size * math.sqrt(2.0 * math.pi / (around * math.sin(2.0 * math.pi / around))) + offset
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)
    half, quarter = 0.5 * design.size + offset, around // 4
    along = half * (2.0 * np.arange(quarter) / quarter - 1.0)
    fixed = np.full(quarter, half)
    sides = [(along, -fixed), (fixed, along), (-along, fixed), (-fixed, -along)]
    return np.concatenate([np.stack(side, axis=1) for side in sides])


def pipe_type(name: str, pipe: Pipe, density: float, length: float) -> BarType:
    """Return the bar of a pipe, which carries compression; its bending belongs to the ring."""
    mass = pipe.mass_per_length(density)
    return BarType(
        name,
        mass,
        pipe.axial_stiffness,
        pipe.diameter,
        pipe.volume_per_length,
        viscosity=0.05 * length * math.sqrt(pipe.axial_stiffness * mass),
        drag_normal=pipe.drag_normal,
        drag_tangential=pipe.drag_tangential,
        added_mass_normal=pipe.added_mass,
        tension_only=False,
    )


def _ring(
    work: _Assembly, name: str, nodes: IntArray, pipe: Pipe, stiffness: tuple[float, float], density: float
) -> IntArray:
    """Add the bars and the bending of a closed pipe; return its bars."""
    rest = work.place(nodes)
    following = np.roll(nodes, -1)
    length = np.linalg.norm(np.roll(rest, -1, axis=0) - rest, axis=1)
    bars = work.bars(
        nodes,
        following,
        length,
        (pipe_type(name, pipe, density, float(length.mean())),),
        np.zeros(nodes.size, np.int64),
    )
    work.rings.append(Ring(name, nodes, rest, *stiffness))
    return bars


def _collar(work: _Assembly, model: FlexibleCage, name: str, inner: IntArray) -> tuple[list[IntArray], list[IntArray]]:
    """Add the collar's bars, and its outer ring with brackets; return nodes and bars of the rings."""
    collar, density = model.design.collar, model.water.density
    stiffness = (collar.bending_stiffness, collar.torsional_stiffness)
    rings, bars = [inner], [_ring(work, f"{name} collar", inner, collar.pipe, stiffness, density)]
    if collar.rings == 2:
        centre = work.place(inner).mean(axis=0)
        flat = _outline(model.design, inner.size, collar.spacing)
        places = np.concatenate([flat, np.zeros((inner.size, 1))], axis=1) + centre
        outer = work.nodes(places)
        bars.append(_ring(work, f"{name} outer collar", outer, collar.pipe, stiffness, density))
        light = BarType(
            f"{name} bracket", 0.01 * collar.pipe.mass_per_length(density), 0.1 * collar.pipe.axial_stiffness, 0.0,
            viscosity=1e-3 * collar.pipe.axial_stiffness * math.sqrt(collar.pipe.density / collar.pipe.youngs_modulus),
            tension_only=False,
        )  # fmt: skip
        ends = np.concatenate([outer, np.roll(outer, -1), np.roll(outer, 1)])
        begins = np.tile(inner, 3)
        length = np.linalg.norm(work.place(ends) - work.place(begins), axis=1)
        work.bars(begins, ends, length, (light,), np.zeros(begins.size, np.int64))
        rings.append(outer)
    return rings, bars


def _net(work: _Assembly, model: FlexibleCage, index: int, centre: tuple[float, float]) -> CageParts:
    """Add one cage: net, collar, weights."""
    design, mesh = model.design, model.mesh
    net, around, name = design.net, mesh.around, model.names[index]
    held = not isinstance(model.mooring, GridMooring)
    middle = np.array([*centre, 0.0])
    flat = np.concatenate([_outline(design, around, 0.0), np.zeros((around, 1))], axis=1)
    rows = []
    for i in range(mesh.down + 1):
        down = np.array([0.0, 0.0, -net.wall_depth * i / mesh.down])
        rows.append(work.nodes(flat + middle + down, FIXED if held and i == 0 else FREE))
    wall = np.stack(rows)
    inside: list[IntArray] = []
    hub = -1
    if net.bottom != "none":
        kept = flat
        for i in range(1, mesh.bottom):
            share = 1.0 - i / mesh.bottom
            # towards the middle every second knot is left out: short bars would ask for short time steps
            if share * around < _CROWDED * len(kept) and len(kept) % 8 == 0 and len(kept) >= 16:
                kept = kept[::2]
            down = np.array([0.0, 0.0, -net.wall_depth - net.cone_depth * (1.0 - share)])
            inside.append(work.nodes(kept * share + middle + down))
        hub = int(work.nodes((middle - [0.0, 0.0, net.wall_depth + net.cone_depth])[None, :])[0])
        work.attach(hub, mass=design.centre_weight)
    corners, walls = _panels(wall, inside, hub)
    rest = np.stack(work.places)
    grouped = group_meshes(corners, rest, net.net.mesh_pitch)
    kind, types = grouped.types(
        f"{name} net", twine_mass=net.twine_mass, twine_volume=net.twine_volume,
        twine_stiffness=net.youngs_modulus * net.bearing_area, added_mass=net.added_mass, damping=net.damping,
    )  # fmt: skip
    net_bars = work.bars(grouped.start, grouped.end, grouped.length, types, kind)
    first = len(work.group)
    work.corners.append(corners)
    work.group.extend([2 * index] * walls + [2 * index + 1] * (len(corners) - walls))
    rings, bars = ([wall[0]], []) if held else _collar(work, model, name, wall[0])
    ring_bars = np.zeros(0, dtype=np.int64)
    if design.bottom_ring is not None:
        pipe = design.bottom_ring
        stiffness = (pipe.bending_stiffness, pipe.torsional_stiffness)
        ring_bars = _ring(work, f"{name} sinker tube", wall[-1], pipe, stiffness, model.water.density)
    return CageParts(
        name, centre, wall, tuple(inside), hub, tuple(rings), tuple(bars), ring_bars,
        np.arange(first, first + walls), np.arange(first + walls, first + len(corners)), net_bars, corners,
        float(enclosed_volume(corners, wall[0], wall[-1] if hub < 0 else None, rest)),
    )  # fmt: skip


def _panels(wall: IntArray, inside: list[IntArray], hub: int) -> tuple[IntArray, int]:
    """Return the corners of the panels of one cage, the wall's first, and how many of them are the wall's."""
    bands = [_band(upper, lower) for upper, lower in pairwise([*wall, *inside])]
    if hub >= 0:
        last = inside[-1] if inside else wall[-1]
        bands.append(np.stack([np.roll(last, -1), last, np.full(last.size, hub), np.full(last.size, -1)], axis=1))
    return np.concatenate(bands).astype(np.int64), (len(wall) - 1) * wall.shape[1]


def _band(upper: IntArray, lower: IntArray) -> IntArray:
    """Return the panels between two rings of knots; the lower one may have half as many."""
    following = np.roll(lower, -1)
    if lower.size == upper.size:
        return np.stack([upper, lower, following, np.roll(upper, -1)], axis=1)
    a, b, c = upper[0::2], upper[1::2], np.roll(upper, -2)[0::2]
    none = np.full(lower.size, -1)
    triangles = ((b, a, lower), (c, b, following), (lower, following, b))
    return np.concatenate([np.stack([*corners, none], axis=1) for corners in triangles])


def _sinkers(work: _Assembly, model: FlexibleCage, cage: CageParts) -> list[int]:
    """Hang the sinkers on the lower rim; return their nodes."""
    sinkers = model.design.sinkers
    if sinkers is None:
        return []
    around = cage.wall.shape[1]
    chosen = [int(cage.wall[-1, round(k * around / sinkers.count) % around]) for k in range(sinkers.count)]
    for node in chosen:
        work.attach(
            node, mass=sinkers.mass, volume=sinkers.volume, drag_area=sinkers.drag_area, added_mass=sinkers.added_mass
        )
    return chosen


def _rope(
    work: _Assembly,
    name: str,
    begin: int,
    end: int,
    segments: tuple[tuple[LineProperties, float], ...],
    step: float,
    damping: float,
) -> Strand:
    """Add a rope of several segments along the chord between two nodes; return its strand."""
    total = math.fsum(length for _, length in segments)
    a, b = work.places[begin], work.places[end]
    nodes, numbers, gone = [begin], [], 0.0
    for place, (properties, length) in enumerate(segments):
        count = max(1, math.ceil(length / step - 1e-9))
        piece = length / count
        share = (gone + piece * np.arange(1, count + (place < len(segments) - 1))) / total
        inner = work.nodes(a + share[:, None] * (b - a)) if share.size else np.zeros(0, dtype=np.int64)
        chain = [nodes[-1], *inner.tolist(), *([end] if place == len(segments) - 1 else [])]
        viscosity = damping * piece * math.sqrt(properties.axial_stiffness * properties.mass_per_length)
        kind = BarType.from_properties(properties, viscosity=viscosity)
        numbers.extend(
            work.bars(
                np.array(chain[:-1]), np.array(chain[1:]), np.full(count, piece), (kind,), np.zeros(count, np.int64)
            ).tolist()
        )
        nodes.extend(chain[1:])
        gone += length
    return Strand(name, np.array(nodes), np.array(numbers))


def bridle_ends(model: FlexibleCage, corner: tuple[float, float], cage: CageParts) -> list[int]:
    """Return the knots of a collar that the bridles of one corner of its bay hold.

    Each takes the nearest free knot on its own side of the way to the corner, so that a cage and its image in a mirror
    hold the images of the same knots on any mesh.
    """
    mooring = model.mooring
    assert isinstance(mooring, GridMooring)
    flat = _outline(model.design, cage.wall.shape[1], 0.0)
    toward = math.atan2(corner[1] - cage.centre[1], corner[0] - cage.centre[0])
    count = mooring.bridles_per_corner
    offsets = np.radians([0.0] if count == 1 else np.linspace(-20.0, 20.0, count))
    # rounded: knots as near as each other are so on both sides
    turned = np.angle(np.exp(1j * (np.arctan2(flat[:, 1], flat[:, 0]) - toward))).round(9)
    chosen: dict[int, int] = {}
    for number in np.argsort(np.abs(offsets).round(9), kind="stable"):
        offset = float(offsets[number])
        across = (turned * offset <= 0.0) & (abs(offset) > 1e-9)
        away = np.where(across, math.inf, np.abs(turned - offset).round(9))
        away[list(chosen.values())] = math.inf
        chosen[int(number)] = int(np.lexsort((np.abs(turned), away))[0])
    return [int(cage.collar[-1][chosen[number]]) for number in range(count)]


def _grid(work: _Assembly, model: FlexibleCage, cages: list[CageParts]) -> tuple[list[LinePart], list[int], list[int]]:
    """Add frame, buoys, bridles and anchor lines; return the lines, anchors and buoys."""
    mooring = model.mooring
    assert isinstance(mooring, GridMooring)
    step, damping = model.mesh.rope_length, mooring.damping
    lines: list[LinePart] = []

    def rope(name: str, kind: str, begin: int, end: int, segments: tuple[tuple[LineProperties, float], ...]) -> None:
        work.strands.append(_rope(work, name, begin, end, segments, step, damping))
        least = min(properties.breaking_load for properties, _ in segments)
        lines.append(LinePart(name, kind, len(work.strands) - 1, least))

    flat = mooring.plates(model.rows, model.columns)
    plates = work.nodes(np.array([[x, y, -mooring.depth] for x, y in flat]))
    for one, two in mooring.frame_pairs(model.rows, model.columns):
        rope(f"frame {one + 1}-{two + 1}", "frame", int(plates[one]), int(plates[two]),
             ((mooring.frame_rope, mooring.spacing),))  # fmt: skip
    buoy = mooring.buoy
    buoys = work.nodes(np.array([[x, y, 0.0] for x, y in flat]))
    for k, node in enumerate(buoys):
        work.attach(
            int(node), mass=buoy.mass, volume=buoy.volume, drag_area=buoy.drag * math.pi / 4.0 * buoy.diameter**2,
            added_mass=0.5 * model.water.density * buoy.volume, height=buoy.diameter, form=float(SPHERE),
        )  # fmt: skip
        rope(f"buoy {k + 1}", "buoy", int(plates[k]), int(node), ((mooring.frame_rope, mooring.depth),))
    for index, cage in enumerate(cages):
        row, column = divmod(index, model.columns)
        for corner in (
            row * (model.columns + 1) + column, row * (model.columns + 1) + column + 1,
            (row + 1) * (model.columns + 1) + column, (row + 1) * (model.columns + 1) + column + 1,
        ):  # fmt: skip
            for number, node in enumerate(bridle_ends(model, flat[corner], cage)):
                chord = float(np.linalg.norm(work.places[node] - work.places[int(plates[corner])]))
                label = f"bridle {corner + 1}{'abcd'[number]}" + (f" {cage.name}" if len(cages) > 1 else "")
                length = mooring.bridle_length or chord * (1.0 + mooring.bridle_slack)
                rope(label, "bridle", int(plates[corner]), node, ((mooring.bridle_rope, length),))
    anchors = []
    lower_first = tuple(reversed(mooring.anchor_segments))
    for number, (corner, (dx, dy)) in enumerate(mooring.anchor_directions(model.rows, model.columns)):
        x, y = flat[corner]
        place = [x + dx * mooring.anchor_distance, y + dy * mooring.anchor_distance, model.bed.level]
        anchor = int(work.nodes(np.array([place]), FIXED)[0])
        anchors.append(anchor)
        rope(f"anchor {number + 1}", "anchor", anchor, int(plates[corner]), lower_first)
    return lines, anchors, buoys.tolist()


def panel_law(model: FlexibleCage) -> PanelLaw:
    """Return the table of the net's law."""
    net = model.design.net
    return PanelLaw.tabulate(
        net.law.name, lambda angle, speed: net.law.coefficients(angle, speed, net.net, model.kinematic_viscosity)
    )


def build_cage(model: FlexibleCage) -> CageNetwork:
    """Return the network of a flexible cage, without shelter (see :mod:`moyai.structures.cage.flexible.wake`).

    Parameters
    ----------
    model : FlexibleCage
        At one water level: ``at_level`` of the problem that :func:`moyai.case.build` makes of a case.

    Returns
    -------
    CageNetwork
        The network, and which of its nodes and bars belong to which part.

    Examples
    --------
    >>> import moyai
    >>> from moyai.case import build
    >>> from moyai.structures import build_cage
    >>> model = build(moyai.load_case(moyai.template("cage"))).at_level(0.0)
    >>> len(build_cage(model).cages)
    1
    """
    work = _Assembly()
    cages = [_net(work, model, index, centre) for index, centre in enumerate(model.centres)]
    sinkers = [node for cage in cages for node in _sinkers(work, model, cage)]
    lines, anchors, buoys = _grid(work, model, cages) if isinstance(model.mooring, GridMooring) else ([], [], [])
    count = len(work.kinds)
    rows = {
        key: np.array([work.attached.get(i, {}).get(key, 0.0) for i in range(count)])
        for key in ("mass", "volume", "drag_area", "added_mass", "height", "form")
    }
    rest = np.stack(work.places)
    corners = np.concatenate(work.corners)
    network = Network(
        Nodes(rest, np.array(work.kinds), form=rows.pop("form").astype(np.int64), **rows),
        Bars(
            np.array(work.start), np.array(work.end), np.array(work.length), np.array(work.kind), tuple(work.types)
        ),
        model.water,
        model.bed,
        tuple(work.strands),
        panels=NetPanels(
            corners,
            (panel_law(model),),
            area=panel_areas(corners, rest)[0],
            group=np.array(work.group),
            group_names=tuple(f"{name} {part}" for name in model.names for part in ("wall", "bottom")),
        ),
        rings=tuple(work.rings),
    )  # fmt: skip
    return CageNetwork(
        network, tuple(cages), tuple(lines), np.array(anchors, dtype=np.int64), np.array(buoys, dtype=np.int64),
        np.array(sinkers, dtype=np.int64),
    )  # fmt: skip
