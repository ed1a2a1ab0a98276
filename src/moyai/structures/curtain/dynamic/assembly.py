"""The network of a span that has just come taut: cables, skirt with sections of added mass, floats, ballast, lines."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Literal

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.flexible.elements import FIXED, FREE, Bars, BarType, Nodes, Strand
from moyai.flexible.mass_blocks import MassBlocks
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.sheets import Sheets, sheet_grid
from moyai.sea.water import Water
from moyai.structures.curtain.dynamic.model import ANCHOR_LINE, AT_TOE, CurtainNetwork, CurtainSpan, Mesh
from moyai.structures.curtain.dynamic.section import SectionMesh, section_mesh
from moyai.structures.curtain.impact.kernels import taut_shape

#: Viscosity of cables and skirt where none is given, as a part of what would be critical on the mesh.
MESH_DAMPING = 0.05
_TIGHT = 1e-9
#: Stiffness along the span over that along the depth, where none is given: cloth without any slides in itself until its
#: columns meet, and no mesh converges; so little changes the peak by less than 1 %.
TRACE = 1e-4


@checks_words
def build_span(
    span: CurtainSpan,
    mesh: Mesh,
    water: Water,
    *,
    speed: float = 0.0,
    profile: Literal["uniform", "sag"] = "uniform",
    weight: bool = True,
    deep: bool = False,
    release: float | None = None,
) -> CurtainNetwork:
    """Return the network of a span that has just come taut downstream, or that is let go slack.

    Parameters
    ----------
    span : CurtainSpan
    mesh : Mesh
    water : Water
    speed : float
        Of the curtain downstream [m/s].
    profile : {"uniform", "sag"}
        Whether every point moves with that speed, or as the sag of its cable.
    weight : bool
        Whether weight and buoyancy act; without them skirt and ballast have mass alone.
    deep : bool
        Whether the added mass is that of deep water, as the papers take it.
    release : float, optional
        Let the span go at this share of the way from the line between its supports (0) to the just-taut shape
        (below 1), its length gathered evenly between the columns [eq:curtain-release-place]. Turning
        sections then keep no energy of the water (:class:`MassBlocks`), since the drag coefficient holds all of the
        force of a steady current.

    Returns
    -------
    CurtainNetwork

    Raises
    ------
    InputError
        As :class:`CurtainSpan`, and for a skirt that reaches the bed or floats that do not carry it.
    """
    along, down = mesh.along, mesh.down
    section = section_mesh(span.skirt_length, span.chord, down, math.inf if deep else float(water.depth), water.density)
    shape, arc = _plan(span, along)
    sag = float(np.max(shape[:, 0]))
    if release is not None:
        shape = _gathered(shape, arc, release)
    normal = _normals(shape)
    drop, sink, stretched = _hang(span, section, water, weight)
    grid = np.arange((along + 1) * (down + 1)).reshape(down + 1, along + 1).T.copy()
    count = grid.size
    place = np.zeros((count, 3))
    place[grid, 0] = shape[:, :1] + normal[:, :1] * section.x
    place[grid, 1] = shape[:, 1:] + normal[:, 1:] * section.x
    place[grid, 2] = (sink + section.z + drop)[None, :]
    velocity = np.zeros_like(place)
    velocity[grid, 0] = (speed if profile == "uniform" else speed * shape[:, :1] / sag) * np.ones((1, down + 1))
    extra = 4 if span.support is not None else 0
    place = np.vstack([place, np.zeros((extra, 3))])
    velocity = np.vstack([velocity, np.zeros((extra, 3))])
    nodes = _nodes(span, grid, place, arc, water, weight)
    velocity[(nodes.kind == FIXED)] = 0.0
    velocity[nodes.held] = 0.0
    bars, strands = _bars(span, mesh, grid, place, arc, weight)
    triangles, rest = sheet_grid(grid, arc, np.concatenate([[0.0], np.cumsum(stretched)]))
    cell = float(np.min(stretched))
    time = mesh.skirt_damping_time
    if time is None:
        time = 4.0 * MESH_DAMPING * cell * math.sqrt(span.sheet_mass / span.sheet_stiffness)
    warp, shear = span.span_stiffness, span.shear_stiffness
    if warp == 0.0:
        warp, shear = TRACE * span.sheet_stiffness, TRACE * span.sheet_stiffness / 3.0
    sheets = Sheets(
        triangles, rest, warp, span.sheet_stiffness, shear,
        mass_per_area=span.sheet_mass, volume_per_area=span.sheet_volume if weight else 0.0,
        drag_normal=span.drag_coefficient, damping_time=time,
    )  # fmt: skip
    network = Network(
        nodes, bars, water if weight else replace(water, gravity=_TIGHT), strands=strands,
        points={"mid-span": int(grid[along // 2, 0])}, sheets=sheets,
        blocks=_blocks(grid, arc, section, nodes, mesh if release is None else replace(mesh, convective=False)),
    )  # fmt: skip
    return CurtainNetwork(span, mesh, network, State(0.0, place, velocity), grid, section)


def _plan(span: CurtainSpan, along: int) -> tuple[Array, Array]:
    """Return the just-taut nodes in plan (x, y) and the unstretched places along the cable, as long as their chords."""
    b = taut_shape(span.span / span.length)
    scale = 0.5 * span.span / b
    steps = np.linspace(-0.5 * span.length, 0.5 * span.length, along + 1)
    y = scale * np.arcsinh(steps / scale)
    y[[0, -1]] = -0.5 * span.span, 0.5 * span.span
    x = scale * (math.cosh(b) - np.cosh(y / scale))
    arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
    return np.stack([x, y], axis=1), arc


def _gathered(shape: Array, arc: Array, release: float) -> Array:
    """Return the nodes in plan of a span that is let go slack [eq:curtain-release-place].

    Raises
    ------
    InputError
        For a share outside of 0 to 1.
    """
    if not 0.0 <= release < 1.0:
        raise InputError(f"release is {release:g}", parameter="release", allowed="0 or more, below 1")
    # between two shapes whose cells are not longer than the cable lies one whose cells are not longer either
    line = np.zeros_like(shape)
    line[:, 1] = shape[0, 1] + (shape[-1, 1] - shape[0, 1]) * arc / arc[-1]
    return np.asarray((1.0 - release) * line + release * shape)


def _normals(shape: Array) -> Array:
    """Return unit normals of the cable in plan, downstream."""
    way = np.empty_like(shape)
    way[1:-1] = shape[2:] - shape[:-2]
    way[0], way[-1] = (0.0, 1.0), (0.0, 1.0)
    way /= np.linalg.norm(way, axis=1)[:, None]
    return np.stack([way[:, 1], -way[:, 0]], axis=1)


def _hang(span: CurtainSpan, section: SectionMesh, water: Water, weight: bool) -> tuple[Array, float, Array]:
    """Return how far each node hangs below its unstretched place, the level of the top, and the lengths of the cells.

    A flat skirt is stretched by its weight; a bulging one is just taut.
    """
    cells = np.hypot(np.diff(section.x), np.diff(section.z))
    drop = np.zeros(section.x.size)
    if not weight:
        return drop, 0.0, cells
    rho, g = water.density, water.gravity
    below = (span.lower_mass - rho * span.lower_volume) * g
    skin = (span.sheet_mass - rho * span.sheet_volume) * g
    if span.edges != "held" and span.chord >= span.skirt_length * (1.0 - _TIGHT):
        # each node carries what hangs below the middle of the cell under it
        load = below + skin * (span.skirt_length - np.cumsum(cells) + 0.5 * cells)
        strain = np.sqrt(1.0 + 2.0 * np.maximum(load, 0.0) / span.sheet_stiffness) - 1.0
        drop[1:] = -np.cumsum(strain * cells)
    whole = below + skin * span.skirt_length + span.upper_mass * g
    lift = rho * g * span.float_volume
    if span.float_volume <= 0.0:
        return drop, 0.0, cells
    if lift <= whole:
        raise InputError(
            f"the floats lift {lift:g} N/m, curtain and ballast weigh {whole:g} N/m",
            parameter="floats.buoyancy",
            allowed=f"more than {whole:g} N/m",
            remedy="give larger floats or a lighter toe",
        )
    return drop, span.float_height * (0.5 - whole / lift), cells


def _nodes(span: CurtainSpan, grid: IntArray, place: Array, arc: Array, water: Water, weight: bool) -> Nodes:
    """Return the nodes: ends by their supports, the upper edge with its floats."""
    count = len(place)
    kind = np.full(count, FREE, dtype=np.int64)
    held = np.zeros((count, 3), dtype=np.bool_)
    mass, volume, height = np.zeros(count), np.zeros(count), np.zeros(count)
    share = np.zeros(arc.size)
    share[:-1] += 0.5 * np.diff(arc)
    share[1:] += 0.5 * np.diff(arc)
    top, toe, ends = grid[:, 0], grid[:, -1], grid[[0, -1]]
    if span.float_volume > 0.0 and weight:
        volume[top], height[top] = span.float_volume * share, span.float_height
    else:
        held[top, 2] = True
    if span.edges == "held":
        held[toe, 2] = True
    if span.lower_stiffness == 0.0:
        # ballast without a cable that carries: its mass alone
        mass[toe] += span.lower_mass * share
        volume[toe] += span.lower_volume * share if weight else 0.0
    support = span.support
    if support is None:
        if span.edges == "free":
            # held in all components, not fixed: the rest of the column moves, and its section with it
            held[ends[:, 0]] = True
            held[ends[:, 1:], 1] = True
        else:
            kind[ends.ravel()] = FIXED
    else:
        held[ends, 1] = True
        held[ends[:, 0], 2] = True
        volume[ends[:, 0]] = 0.0
        mass[ends[:, 0]] += 0.5 * support.mass
        reach, depth = support.line_length * math.cos(support.slope), support.line_length * math.sin(support.slope)
        for number, (end, side) in enumerate(((0, -1.0), (0, 1.0), (1, -1.0), (1, 1.0))):
            at = place[ends[end, 0]]
            place[grid.size + number] = at + np.array([side * reach, 0.0, -depth])
        kind[grid.size :] = FIXED
    return Nodes(place, kind, held, mass=mass, volume=volume, height=height)


def _bars(
    span: CurtainSpan, mesh: Mesh, grid: IntArray, place: Array, arc: Array, weight: bool
) -> tuple[Bars, tuple[Strand, ...]]:
    """Return cables and anchor lines; unstretched lengths are the chords of the just-taut shape."""
    along, cells = mesh.along, np.diff(arc)
    longest = float(np.max(cells))

    def cable(name: str, stiffness: float, mass: float, volume: float) -> BarType:
        viscosity = mesh.cable_viscosity
        if viscosity is None:
            viscosity = MESH_DAMPING * longest * math.sqrt(stiffness * mass)
        return BarType(name, mass, stiffness, 0.0, volume_per_length=volume, viscosity=viscosity)

    types = [cable("upper cable", span.upper_stiffness, span.upper_mass, 0.0)]
    start, end, length, which = [grid[:-1, 0]], [grid[1:, 0]], [cells], [np.zeros(along, dtype=np.int64)]
    strands = [Strand("upper cable", grid[:, 0], np.arange(along))]
    if span.lower_stiffness > 0.0:
        types.append(cable("lower cable", span.lower_stiffness, span.lower_mass, span.lower_volume if weight else 0.0))
        start.append(grid[:-1, -1])
        end.append(grid[1:, -1])
        length.append(cells)
        which.append(np.ones(along, dtype=np.int64))
        strands.append(Strand("lower cable", grid[:, -1], np.arange(along, 2 * along)))
    support = span.support
    if support is not None:
        first = sum(part.size for part in start)
        half = 0.5 * support.stiffness
        edges = (0, -1) if span.edges != "free" and span.lower_stiffness > 0.0 else (0,)
        # a straight line without mass: its own waves are left out, its mass stands with the buoy
        mass = 1e-3 * support.mass / support.line_length
        viscosity = MESH_DAMPING * math.sqrt(half / support.line_length * support.mass) * support.line_length
        parts = len(edges)
        types.append(
            BarType("anchor line", mass / parts, half / parts, 0.0, volume_per_length=0.0, viscosity=viscosity / parts)
        )
        # a line that holds both edges is led to both, so that the lower cable stays under the upper one
        tied = np.concatenate([grid[[0, 0, -1, -1], edge] for edge in edges])
        anchors = np.tile(grid.size + np.arange(4), parts)
        start.append(tied)
        end.append(anchors)
        ways = np.linalg.norm(place[anchors] - place[tied], axis=1)
        length.append(ways / (1.0 + support.pretension / support.stiffness))
        which.append(np.full(tied.size, len(types) - 1, dtype=np.int64))
        names = ("first support, upstream", "first support, downstream", "last support, upstream",
                 "last support, downstream")  # fmt: skip
        for number, name in enumerate(names * parts):
            line = ANCHOR_LINE if number < len(names) else AT_TOE
            ends = np.array([tied[number], anchors[number]])
            strands.append(Strand(f"{line}, {name}", ends, np.array([first + number])))
    bars = Bars(
        np.concatenate(start), np.concatenate(end), np.concatenate(length), np.concatenate(which), tuple(types)
    )  # fmt: skip
    return bars, tuple(strands)


def _blocks(grid: IntArray, arc: Array, section: SectionMesh, nodes: Nodes, mesh: Mesh) -> MassBlocks:
    """Return the sections that can move, each with the added mass of its part of the span."""
    chosen, guides, share = [], [], []
    lengths, last = np.diff(arc), grid.shape[0] - 1
    # at least past the neighbours, and a sixth of the span at most, so that the normals still follow its shape
    reach = 1
    if mesh.normal_reach > 0.0:
        reach = max(2, min(round(mesh.normal_reach / float(np.mean(lengths))), last // 6))
    for row in range(grid.shape[0]):
        column = grid[row]
        if np.any(nodes.kind[column] == FIXED):
            continue
        inner = 0 < row < last
        wide = min(reach, row, last - row)
        before, behind = (grid[row - wide], grid[row + wide]) if inner else (grid[0], grid[-1])
        chosen.append(column)
        guides.append(np.stack([before, behind], axis=1))
        share.append(0.5 * (lengths[row - 1] + lengths[row]) if inner else 0.5 * lengths[0])
    matrices = np.asarray(share)[:, None, None] * section.added_mass
    return MassBlocks(np.array(chosen), np.array(guides), matrices, mesh.convective and mesh.turning, mesh.turning)


__all__ = ["MESH_DAMPING", "build_span"]
