"""Sheets, net panels and elastic rings, what hangs in a network next to bars and hinges.

Each kind is a family of elements: forces on (n, 3) arrays, and the derivative of minus the force in blocks of node
pairs, exact or close enough for Newton's method.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.flexible import sheet_kernel as sheet
from moyai.flexible.network import Network
from moyai.flexible.panel_kernel import panel_forces, panel_tangent
from moyai.flexible.panels import PanelArrays
from moyai.flexible.part_kernel import ring_stiffness, sheet_blocks
from moyai.flexible.ring_kernel import ring_forces
from moyai.flexible.rings import RingArrays
from moyai.flexible.sheet_kernel import sheet_forces, sheet_loads


class Part(Protocol):
    """A family of elements.

    ``members`` (e, k) are its nodes; ``stiffness`` [N/m] is that of the family where a ``share`` of it may be used on
    the way to the rest, 0 of others; ``pull`` [N] is the largest of an element when the forces were last asked for.
    """

    members: IntArray
    stiffness: float
    pull: float

    def add_forces(self, x: Array, v: Array, water: Array, share: float, force: Array) -> None:
        """Add the forces to ``force`` (n, 3)."""

    def blocks(self, x: Array, v: Array, water: Array, share: float) -> Array:
        """Return the derivative of minus the force of each element, shape (e, k, k, 3, 3)."""


class SheetPart:
    """The sheets of a network."""

    def __init__(self, network: Network) -> None:
        assert network.sheets is not None
        self.members = np.ascontiguousarray(network.sheets.triangles)
        self.table = network.sheets.constants(network.water, network.nodes.position)
        self.peak, self.light = np.zeros(len(self.members)), np.zeros((4, len(network.nodes)))
        self.width = 1e-6 * float(np.sqrt(np.min(network.sheets.area)))
        self.stiffness = float(np.max(self.table[:, [sheet.C11, sheet.C22, sheet.C33]]))
        self.pull, self._across = 0.0, np.sqrt(2.0 * network.sheets.area)
        self._blocks = np.zeros((len(self.members), 3, 3, 3, 3))

    def _constants(self, share: float) -> Array:
        if share == 1.0:
            return self.table
        table = self.table.copy()
        for column in (sheet.C11, sheet.C22, sheet.C12, sheet.C33):
            table[:, column] *= share
        for column in (sheet.WARP, sheet.WEFT):
            table[:, column] *= np.sqrt(share)
        return table

    def add_forces(self, x: Array, v: Array, water: Array, share: float, force: Array) -> None:
        """Add stress, pressure, buoyancy and drag."""
        table, count = self._constants(share), len(x)
        place, speed = np.ascontiguousarray(x.T).ravel(), np.ascontiguousarray(v.T).ravel()
        total = np.zeros(3 * count)
        self.peak[:] = 0.0
        sheet_forces(table, self.members, place, 0, speed, 0, total, 0, 1, count, self.peak)
        self.pull = float(np.max(self.peak * self._across))
        flow = np.ascontiguousarray(water).ravel()
        sheet_loads(table, self.members, place, 0, speed, 0, flow, 0, total, 0, 1, count, self.light, 0.0)
        force += total.reshape(3, count).T

    def blocks(self, x: Array, v: Array, water: Array, share: float) -> Array:
        """Return the derivative of the stress, and central differences of what the water does."""
        table = self._constants(share)
        sheet_blocks(table, self.members, x, v, water, 0.0, 1.0, True, self.width, self._blocks)
        return self._blocks


class PanelPart:
    """The net panels of a network: loads of the water."""

    stiffness = pull = 0.0

    def __init__(self, network: Network) -> None:
        panels = PanelArrays.of(network.panels)
        self.system = panels.system
        # an absent fourth corner has zero rows: any node will do
        self.members = np.where(panels.corners < 0, panels.corners[:, :1], panels.corners)
        self.half_density = 0.5 * network.water.density
        self.each = np.zeros((len(self.members), 3))
        self.width = 1e-6 * (float(np.mean(network.bars.length)) if len(network.bars) else 1.0)
        self._blocks = np.zeros((len(self.members), 4, 4, 3, 3))

    def add_forces(self, x: Array, v: Array, water: Array, share: float, force: Array) -> None:
        """Add the loads of the screen law."""
        panel_forces(x, v, water, self.system, self.half_density, force, self.each)

    def blocks(self, x: Array, v: Array, water: Array, share: float) -> Array:
        """Return central differences, panel by panel."""
        panel_tangent(x, v, water, self.system, self.half_density, self.width, self._blocks)
        return self._blocks


class RingPart:
    """One elastic ring of a network."""

    stiffness = pull = 0.0

    def __init__(self, rings: RingArrays, number: int) -> None:
        a, b = int(rings.first[number]), int(rings.first[number + 1])
        self.members = np.ascontiguousarray(rings.nodes[a:b])[None]
        self.system = self.members[0], np.array([0, b - a]), np.ascontiguousarray(rings.rows[a:b])
        self.width = 1e-6 / float(rings.rows[a, 2])
        self._matrix = np.zeros((3 * (b - a), 3 * (b - a)))

    def add_forces(self, x: Array, v: Array, water: Array, share: float, force: Array) -> None:
        """Add bending and torsion."""
        ring_forces(x, self.system, force)

    def blocks(self, x: Array, v: Array, water: Array, share: float) -> Array:
        """Return central differences; the twist of the pipe couples all its nodes."""
        ring_stiffness(x, self.system, 0, self.width, self._matrix)
        count = self.members.shape[1]
        return np.ascontiguousarray(self._matrix.reshape(count, 3, count, 3).transpose(0, 2, 1, 3))[None]


def network_parts(network: Network) -> tuple[Part, ...]:
    """Return the families of a network that are neither bars nor hinges."""
    parts: list[Part] = []
    if network.sheets is not None and len(network.sheets):
        parts.append(SheetPart(network))
    if network.panels is not None and len(network.panels):
        parts.append(PanelPart(network))
    rings = RingArrays.of(network.rings)
    parts.extend(RingPart(rings, number) for number in range(len(network.rings)))
    return tuple(parts)


def kernel_parts(network: Network, pairs: tuple[IntArray, ...]) -> tuple[Any, ...] | None:
    """Return the parts as the kernels of the implicit schemes take them, ``None`` for bars alone.

    Parameters
    ----------
    network : Network
        The network.
    pairs : tuple of ndarray of int
        Addresses in the fronts (:attr:`moyai.flexible.sparse.SparsePlan.pairs`) of the families of
        :func:`network_parts`.
    """
    if not pairs:
        return None
    left = list(pairs)
    no_sheet, no_panel = np.zeros((0, 3, 3, 2), dtype=np.int64), np.zeros((0, 4, 4, 2), dtype=np.int64)
    table, triangles, at = np.zeros((0, sheet.COLUMNS)), np.zeros((0, 3), dtype=np.int64), no_sheet
    if network.sheets is not None and len(network.sheets):
        table, triangles = (
            network.sheets.constants(network.water, network.nodes.position),
            network.sheets.triangles.copy(),
        )
        at = left.pop(0)
    dry = table.copy()
    dry[:, sheet.PRESSURE] = 0.0
    panels, screens = PanelArrays.of(network.panels), no_panel
    if panels.corners.size:
        screens = left.pop(0)
    corners = np.where(panels.corners < 0, panels.corners[:, :1], panels.corners)
    ring_pairs = np.concatenate([np.zeros((0, 2), dtype=np.int64), *(found.reshape(-1, 2) for found in left)])
    return (
        (table, dry, triangles, np.zeros(len(triangles)), np.zeros((4, len(network.nodes)))),
        (panels.system, 0.5 * network.water.density, np.zeros((len(corners), 3))),
        RingArrays.of(network.rings).system,
        (at, screens, corners, ring_pairs),
    )
