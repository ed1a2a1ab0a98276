"""Sheets, net panels and elastic rings, what hangs in a network beside bars and hinges, for statics.

Each kind is a family of elements: forces on (n, 3) arrays, and the derivative of minus the force in blocks of node
pairs, exact or close enough for Newton's method.
"""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
from numba import njit
from numpy.typing import NDArray

from moyai.flexible import sheet_kernel as sheet
from moyai.flexible.network import Network
from moyai.flexible.panel_kernel import panel_forces, panel_tangent
from moyai.flexible.panels import PanelArrays
from moyai.flexible.ring_kernel import ring_forces, ring_tangent
from moyai.flexible.rings import RingArrays
from moyai.flexible.sheet_kernel import sheet_forces, sheet_loads, triangle_force

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


class Part(Protocol):
    """A family of elements.

    ``members`` (e, k) are its nodes; ``stiffness`` [N/m] is that of the family where a ``share`` of it may be used on
    the way to the rest, 0 of others.
    """

    members: IntArray
    stiffness: float

    def add_forces(self, x: Array, v: Array, water: Array, share: float, force: Array) -> None:
        """Add the forces to ``force`` (n, 3)."""

    def blocks(self, x: Array, v: Array, water: Array, share: float) -> Array:
        """Return the derivative of minus the force of each element, shape (e, k, k, 3, 3)."""


@njit(cache=True, error_model="numpy")
def _sheet_blocks(C: Any, triangles: Any, x: Any, v: Any, water: Any, width: float, blocks: Any) -> None:
    """Write central differences of the forces of every triangle, its water included, over the places of its corners."""
    place, speed, flow = np.empty(9), np.empty(9), np.empty(21)
    edges, rates, force, pull = np.empty(6), np.empty(6), np.empty(9), np.empty((2, 9))
    one, light = np.arange(3).reshape(1, 3), np.zeros((4, 3))
    for t in range(triangles.shape[0]):
        for corner in range(3):
            node = triangles[t, corner]
            for row in range(7):
                flow[3 * row + corner] = water[row, node]
            for axis in range(3):
                place[3 * axis + corner], speed[3 * axis + corner] = x[node, axis], v[node, axis]
        for axis in range(3):
            rates[axis] = speed[3 * axis + 1] - speed[3 * axis]
            rates[3 + axis] = speed[3 * axis + 2] - speed[3 * axis]
        for column in range(9):
            kept = place[column]
            for side in range(2):
                place[column] = kept + (width if side == 0 else -width)
                for axis in range(3):
                    edges[axis] = place[3 * axis + 1] - place[3 * axis]
                    edges[3 + axis] = place[3 * axis + 2] - place[3 * axis]
                triangle_force(C, t, edges, rates, force)
                for corner in range(3):
                    for axis in range(3):
                        pull[side, 3 * axis + corner] = force[3 * corner + axis]
                sheet_loads(C[t : t + 1], one, place, 0, speed, 0, flow, 0, pull[side], 0, 1, 3, light, 0.0)
            place[column] = kept
            for row in range(9):
                value = 0.5 * (pull[1, row] - pull[0, row]) / width
                blocks[t, row % 3, column % 3, row // 3, column // 3] = value


class SheetPart:
    """The sheets of a network."""

    def __init__(self, network: Network) -> None:
        assert network.sheets is not None
        self.members = np.ascontiguousarray(network.sheets.triangles)
        self.table = network.sheets.constants(network.water)
        self.peak, self.light = np.zeros(len(self.members)), np.zeros((4, len(network.nodes)))
        self.width = 1e-6 * float(np.sqrt(np.min(network.sheets.area)))
        self.stiffness = float(np.max(self.table[:, [sheet.C11, sheet.C22, sheet.C33]]))
        self._blocks = np.zeros((len(self.members), 3, 3, 3, 3))

    def _constants(self, share: float) -> Array:
        if share == 1.0:
            return self.table
        table = self.table.copy()
        for column in (sheet.C11, sheet.C22, sheet.C12, sheet.C33):
            table[:, column] *= share
        for column in (sheet.A0, sheet.A1, sheet.A2):
            table[:, column] /= share
        return table

    def add_forces(self, x: Array, v: Array, water: Array, share: float, force: Array) -> None:
        """Add stress, pressure, buoyancy and drag."""
        table, count = self._constants(share), len(x)
        place, speed = np.ascontiguousarray(x.T).ravel(), np.ascontiguousarray(v.T).ravel()
        total = np.zeros(3 * count)
        sheet_forces(table, self.members, place, 0, speed, 0, total, 0, 1, count, self.peak)
        flow = np.ascontiguousarray(water).ravel()
        sheet_loads(table, self.members, place, 0, speed, 0, flow, 0, total, 0, 1, count, self.light, 0.0)
        force += total.reshape(3, count).T

    def blocks(self, x: Array, v: Array, water: Array, share: float) -> Array:
        """Return central differences, triangle by triangle."""
        _sheet_blocks(self._constants(share), self.members, x, v, water, self.width, self._blocks)
        return self._blocks


class PanelPart:
    """The net panels of a network: loads of the water."""

    stiffness = 0.0

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
    """The elastic rings of a network."""

    stiffness = 0.0

    def __init__(self, network: Network) -> None:
        rings = RingArrays.of(network.rings)
        self.system = rings.system
        self.members = np.zeros((rings.nodes.size, 3), dtype=np.int64)
        self._blocks = np.zeros((rings.nodes.size, 3, 3, 3, 3))
        ring_tangent(self.system, self.members, self._blocks)

    def add_forces(self, x: Array, v: Array, water: Array, share: float, force: Array) -> None:
        """Add bending and torsion."""
        ring_forces(x, self.system, force)

    def blocks(self, x: Array, v: Array, water: Array, share: float) -> Array:
        """Return the stiffness with the twist held."""
        return self._blocks


def network_parts(network: Network) -> tuple[Part, ...]:
    """Return the families of a network that are neither bars nor hinges."""
    parts: list[Part] = []
    if network.sheets is not None and len(network.sheets):
        parts.append(SheetPart(network))
    if network.panels is not None and len(network.panels):
        parts.append(PanelPart(network))
    if network.rings:
        parts.append(RingPart(network))
    return tuple(parts)
