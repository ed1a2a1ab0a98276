"""The model of a flexible network: its parts (:mod:`moyai.flexible.elements`), the water and the bed under them.

A network is frozen and checks itself. Builders live in :mod:`moyai.flexible.build`; theory: docs/theory/flexible.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import check_kind
from moyai.flexible.bed import Bed
from moyai.flexible.elements import DRIVEN, FIXED, FREE, Bars, Nodes, Strand
from moyai.flexible.mass_blocks import MassBlocks
from moyai.flexible.panels import NetPanels
from moyai.flexible.rings import Ring
from moyai.flexible.sheets import Sheets
from moyai.sea.water import Water


@dataclass(frozen=True, eq=False)
class Network:
    """A network ready for statics and dynamics.

    Raises
    ------
    InputError
        For bars that name absent nodes, nodes that can move but have no mass, parts without any hold, nodes deep under
        the bed, driven nodes without motion.
    """

    #: Nodes of the network.
    nodes: Nodes
    #: Bars of the network.
    bars: Bars
    #: Depth, density, gravity.
    water: Water
    #: Contact with the bed; none when left out.
    bed: Bed | None = None
    #: Named lines.
    strands: tuple[Strand, ...] = ()
    #: Named nodes.
    points: Mapping[str, int] = field(default_factory=dict)
    #: Names of the prescribed motions that driven nodes follow.
    motion_names: tuple[str, ...] = ()
    #: Triangles between nodes.
    sheets: Sheets | None = None
    #: Dense added mass of groups of nodes.
    blocks: MassBlocks | None = None
    #: Pieces of net that the water loads by a law.
    panels: NetPanels | None = None
    #: Elastic rings that are curved at rest.
    rings: tuple[Ring, ...] = ()

    def __post_init__(self) -> None:
        _check_network(self)

    def strand(self, name: str) -> Strand:
        """Return the strand of this name.

        Parameters
        ----------
        name : str
            As it was built.

        Raises
        ------
        InputError
            When there is none.
        """
        for strand in self.strands:
            if strand.name == name:
                return strand
        raise InputError(
            f"no strand {name!r}", parameter="strand", allowed=", ".join(s.name for s in self.strands) or "none"
        )

    def point(self, name: str) -> int:
        """Return the node of a named point.

        Parameters
        ----------
        name : str
            As it was built.

        Raises
        ------
        InputError
            When there is none.
        """
        if name not in self.points:
            raise InputError(f"no point {name!r}", parameter="point", allowed=", ".join(self.points) or "none")
        return self.points[name]

    @property
    def node_mass(self) -> Array:
        """Mass of every node: what is attached, half of each bar and a third of each triangle [kg]."""
        half = 0.5 * self.bars.of_type("mass_per_length") * self.bars.length
        mass = np.array(self.nodes.mass)
        np.add.at(mass, self.bars.start, half)
        np.add.at(mass, self.bars.end, half)
        return mass if self.sheets is None else mass + self.sheets.node_share(self.sheets.bulk[0], len(self.nodes))

    @property
    def node_volume(self) -> Array:
        """Volume of every node, wholly wet: what is attached, half of each bar, a third of each triangle, (n,) [m3]."""
        half = 0.5 * self.bars.of_type("volume_per_length") * self.bars.length
        volume = np.array(self.nodes.volume)
        np.add.at(volume, self.bars.start, half)
        np.add.at(volume, self.bars.end, half)
        return volume if self.sheets is None else volume + self.sheets.node_share(self.sheets.bulk[1], len(self.nodes))

    @property
    def node_contact_area(self) -> Array:
        """Contact area of every node with the bed [m2]."""
        half = 0.5 * self.bars.of_type("diameter") * self.bars.length
        area = np.array(self.nodes.contact_area)
        np.add.at(area, self.bars.start, half)
        np.add.at(area, self.bars.end, half)
        return area


def check_network(network: object) -> None:
    """Refuse what is not a :class:`Network`, a builder that was not asked to build one for instance.

    Raises
    ------
    InputError
        With what is to be given.
    """
    check_kind(network, Network, "network", "call build() of the builder" if hasattr(network, "build") else "")


def name_of_node(network: Network, node: int) -> str:
    """Return a node in words: its number, its name, its place in a line."""
    for name, index in network.points.items():
        if index == node:
            return f"node {node} (point {name!r})"
    for strand in network.strands:
        place = np.flatnonzero(strand.nodes == node)
        if place.size:
            return f"node {node} (node {int(place[0])} of {strand.name!r})"
    return f"node {node}"


def parts(count: int, start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Return the number of the connected part of every node."""
    lowest = np.arange(count)
    while True:
        at_start, at_end = lowest[start], lowest[end]
        lower = np.minimum(at_start, at_end)
        joined = lowest.copy()
        np.minimum.at(joined, at_start, lower)
        np.minimum.at(joined, at_end, lower)
        joined = joined[joined]
        if np.array_equal(joined, lowest):
            return np.unique(lowest, return_inverse=True)[1]
        lowest = joined


def _check_network(network: Network) -> None:
    """Raise InputError at the first error of a network.

    Raises
    ------
    InputError
        See :class:`Network`.
    """
    nodes, bars = network.nodes, network.bars
    count = len(nodes)
    if len(bars) and not (min(bars.start.min(), bars.end.min()) >= 0 and max(bars.start.max(), bars.end.max()) < count):
        raise InputError(
            "a bar ends at a node that does not exist", parameter="bars", allowed=f"nodes 0 to {count - 1}"
        )
    if network.sheets is not None and network.sheets.triangles.max() >= count:
        raise InputError(
            f"a triangle of a sheet names node {int(network.sheets.triangles.max())}, which does not exist",
            parameter="sheets.triangles",
            allowed=f"nodes 0 to {count - 1}",
        )
    held = nodes.held.all(axis=1) | (nodes.kind != FREE)
    empty = (network.node_mass <= 0.0) & ~held
    if empty.any():
        raise InputError(
            f"{name_of_node(network, int(np.argmax(empty)))} can move but has no mass",
            parameter="nodes.mass",
            allowed="greater than 0 for free nodes",
            remedy="give the point a mass or connect a bar to it",
        )
    start, end = bars.start, bars.end
    if network.sheets is not None:
        corners = network.sheets.triangles
        start = np.concatenate([start, corners[:, 0], corners[:, 1]])
        end = np.concatenate([end, corners[:, 1], corners[:, 2]])
    if network.blocks is not None:
        _check_blocks(network)
    _check_nets(network)
    _check_names(network)
    part = parts(count, start, end)
    anchored = np.zeros(int(part.max()) + 1, dtype=bool)
    np.logical_or.at(anchored, part, (nodes.kind != FREE) | nodes.held.any(axis=1))
    if not anchored.all() and anchored.any():
        lost = int(np.argmin(anchored[part]))
        raise InputError(
            f"{name_of_node(network, lost)} belongs to a part of {int((part == part[lost]).sum())} nodes "
            "that nothing holds",
            parameter="bars",
            allowed="every part connected to a fixed or driven point, or no such point at all",
            remedy="connect the part or make one of its points fixed",
        )
    driven = nodes.kind == DRIVEN
    wrong = driven & ((nodes.motion < 0) | (nodes.motion >= len(network.motion_names)))
    if wrong.any():
        raise InputError(
            f"{name_of_node(network, int(np.argmax(wrong)))} is driven but names no motion",
            parameter="nodes.motion",
            allowed=", ".join(network.motion_names) or "a named motion",
        )
    if network.bed is not None:
        # anchors may lie in the bed; whatever moves may not start deep in it
        if network.bed.ground is not None and network.blocks is not None:
            raise InputError(
                "sections with a stated added mass lie on a flat bed only", parameter="bed.ground",
                allowed="no ground",
            )  # fmt: skip
        level = network.bed.level_at(nodes.position)
        deep = (nodes.position[:, 2] < level - 0.02 * np.maximum(1.0, np.abs(level))) & (nodes.kind != FIXED)
        if deep.any():
            worst = int(np.argmin(np.where(deep, nodes.position[:, 2], np.inf)))
            raise InputError(
                f"{name_of_node(network, worst)} starts at z = {nodes.position[worst, 2]:g} m, "
                f"under the bed at {level[worst]:g} m",
                parameter="nodes.position",
                allowed="on or above the bed",
            )


def _check_names(network: Network) -> None:
    """Raise InputError for strands and points that name what is not there."""
    for strand in network.strands:
        if strand.nodes.ndim != 1 or strand.bars.ndim != 1 or strand.nodes.size != strand.bars.size + 1:
            raise InputError(
                f"strand {strand.name!r} has {strand.nodes.size} nodes and {strand.bars.size} bars",
                parameter="strands",
                allowed="one node more than bars, in order",
            )
        for what, numbers, most in (
            ("node", strand.nodes, len(network.nodes)),
            ("bar", strand.bars, len(network.bars)),
        ):
            if numbers.size and not (numbers.min() >= 0 and numbers.max() < most):
                raise InputError(
                    f"strand {strand.name!r} names a {what} that does not exist",
                    parameter="strands",
                    allowed=f"{what}s 0 to {most - 1}",
                )
    for name, node in network.points.items():
        if not 0 <= node < len(network.nodes):
            raise InputError(
                f"point {name!r} is node {node}", parameter="points", allowed=f"nodes 0 to {len(network.nodes) - 1}"
            )


def _check_blocks(network: Network) -> None:
    blocks, nodes = network.blocks, network.nodes
    assert blocks is not None
    if max(blocks.nodes.max(), blocks.guides.max()) >= len(nodes) or min(blocks.nodes.min(), blocks.guides.min()) < 0:
        raise InputError(
            "a section of added mass names a node that does not exist",
            parameter="blocks.nodes",
            allowed=f"nodes 0 to {len(nodes) - 1}",
        )
    sheets = network.sheets
    if (
        sheets is not None
        and np.isin(sheets.triangles[np.asarray(sheets.added_mass_per_area) > 0.0], blocks.nodes).any()
    ):
        raise InputError(
            "a sheet with a stated added mass has nodes in sections of added mass: the water would be counted twice",
            parameter="sheets.added_mass_per_area",
            allowed="0 where sections hold the added mass",
        )
    bound = blocks.nodes.ravel()[nodes.kind[blocks.nodes.ravel()] != FREE]
    if bound.size:
        raise InputError(
            f"{name_of_node(network, int(bound[0]))} of a section of added mass cannot move",
            parameter="blocks.nodes",
            allowed="free nodes (hold single components by 'held')",
        )


def _check_nets(network: Network) -> None:
    """Raise at a net panel or ring that names an absent node."""
    count = len(network.nodes)
    if network.panels is not None and len(network.panels) and network.panels.corners.max() >= count:
        worst = int(np.argmax(network.panels.corners.max(axis=1)))
        raise InputError(
            f"net panel {worst} names node {int(network.panels.corners.max())}, which does not exist",
            parameter="panels.corners",
            allowed=f"nodes 0 to {count - 1}; -1 for the fourth corner of a triangle",
        )
    for ring in network.rings:
        absent = ring.nodes[(ring.nodes < 0) | (ring.nodes >= count)]
        if absent.size:
            raise InputError(
                f"ring {ring.name!r} names node {int(absent[0])}, which does not exist",
                parameter=f"rings.{ring.name}.nodes",
                allowed=f"nodes 0 to {count - 1}",
            )
