"""Flat constants of a network for the compiled kernels."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.flexible.elements import FREE, RopeCurve
from moyai.flexible.network import Network

#: Rows of ``KernelArrays.nodes``.
NODE_ROWS = (
    "mass", "weight", "volume", "drag", "added_mass", "bed_stiffness", "bed_damping", "height", "form",
    "free_x", "free_y", "free_z",
)  # fmt: skip
#: Rows of ``KernelArrays.bars``; drag, added mass, buoyancy and displaced mass are those of half a bar.
BAR_ROWS = (
    "length", "spring", "viscous", "least_tension", "drag_normal", "drag_tangential", "added_normal",
    "added_tangential", "buoyancy", "flow_factor", "radius", "per_mass", "displaced",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class KernelArrays:
    """What the kernels read."""

    #: Rows of ``NODE_ROWS``: mass [kg], weight [N], attached volume [m3], rho/2 times drag area, attached added mass
    #: [kg], stiffness [N/m] and damping [N s/m] of the bed, height [m], form, 1 where a component is free; shape (12,
    #: n).
    nodes: Array
    #: Rows of ``BAR_ROWS``: length [m], EA/L0 [N/m], BA/L0 [N s/m], least tension (0, or -1e300 of bars that carry
    #: compression), rho/2 Cd d l, ..., radius [m], one over the mass of half a bar; shape (13, m).
    bars: Array
    start: IntArray
    end: IntArray
    #: Rope curve of each bar, -1 for a linear one; shape (m,).
    curve: IntArray
    #: Rope curves: strain, tension, slope; shape (c, 3, points).
    curves: Array
    #: Node triples of bending; EI over the mean bar length [N m].
    hinges: IntArray
    #: One over both unstretched lengths [1/m].
    bending: Array
    #: Nodes that carry volume, drag or added mass of their own.
    attached: IntArray

    def node(self, name: str) -> Array:
        """Return one row of the nodes."""
        values: Array = self.nodes[NODE_ROWS.index(name)]
        return values

    def bar(self, name: str) -> Array:
        """Return one row of the bars."""
        values: Array = self.bars[BAR_ROWS.index(name)]
        return values

    @property
    def greatest_spring(self) -> Array:
        """The steepest slope of each bar's force over its length [N/m]."""
        slope = self.bar("spring").copy()
        for slot in range(len(self.curves)):
            chosen = self.curve == slot
            slope[chosen] = self.curves[slot, 2].max() / self.bar("length")[chosen]
        return slope


def find_hinges(network: Network) -> tuple[IntArray, Array]:
    """Return the node triples of strands that bend, each with EI over the mean length of its bars, 1/l1, 1/l2."""
    triples, stiffness = [], []
    bending = network.bars.of_type("bending_stiffness")
    if not np.any(bending > 0.0):
        return np.zeros((0, 3), dtype=np.int64), np.zeros((0, 3))
    for strand in network.strands:
        for left, right, one, two, three in zip(
            strand.bars[:-1], strand.bars[1:], strand.nodes[:-2], strand.nodes[1:-1], strand.nodes[2:], strict=True
        ):
            value = min(bending[left], bending[right])
            if value > 0.0:
                triples.append((one, two, three))
                first, second = network.bars.length[left], network.bars.length[right]
                stiffness.append((value / (0.5 * (first + second)), 1.0 / first, 1.0 / second))
    return np.array(triples, dtype=np.int64).reshape(-1, 3), np.array(stiffness).reshape(-1, 3)


def _node_rows(network: Network) -> Array:
    nodes, water = network.nodes, network.water
    mass, area = network.node_mass, network.node_contact_area
    stiffness, damping = (0.0, 0.0) if network.bed is None else (network.bed.stiffness, network.bed.damping)
    moves = np.where((nodes.kind == FREE)[:, None] & ~nodes.held, 1.0, 0.0)
    return np.stack(
        [
            # held nodes without mass still need a block that can be inverted
            np.where(mass > 0.0, mass, 1.0),
            mass * water.gravity,
            nodes.volume,
            0.5 * water.density * nodes.drag_area,
            nodes.added_mass,
            stiffness * area,
            damping * area,
            nodes.height,
            nodes.form.astype(np.float64),
            *moves.T,
        ]
    )


def _bar_rows(network: Network) -> Array:
    bars, water = network.bars, network.water
    if len(bars) == 0:
        return np.zeros((len(BAR_ROWS), 0))
    half = 0.5 * bars.length
    displaced = water.density * bars.of_type("volume_per_length") * half
    drag = 0.5 * water.density * bars.of_type("diameter") * half
    added = bars.of_type("added_mass_normal") * displaced
    # without a diameter what displaces water is a circle of its volume [eq:flexible-immersion]: with no height all of
    # its lift would come and go at the surface at once
    circle = np.sqrt(bars.of_type("volume_per_length") / math.pi)
    radius = np.where(bars.of_type("diameter") > 0.0, 0.5 * bars.of_type("diameter"), circle)
    return np.stack(
        [
            bars.length,
            bars.of_type("axial_stiffness") / bars.length,
            bars.of_type("viscosity") / bars.length,
            np.where(bars.of_type("tension_only") > 0.0, 0.0, -1e300),
            bars.of_type("drag_normal") * drag,
            bars.of_type("drag_tangential") * drag,
            added,
            bars.of_type("added_mass_tangential") * displaced,
            water.gravity * displaced,
            bars.flow_factor,
            np.maximum(radius, 1e-9 * bars.length),
            1.0 / (bars.of_type("mass_per_length") * half + added),
            displaced,
        ]
    )


def _curves(network: Network) -> tuple[IntArray, Array]:
    known: list[RopeCurve] = []
    number = np.full(len(network.bars.types), -1, dtype=np.int64)
    for index, kind in enumerate(network.bars.types):
        if kind.curve is not None:
            number[index] = len(known)
            known.append(kind.curve)
    curves = np.zeros((len(known), 3, max((c.strain.size for c in known), default=2)))
    for slot, curve in enumerate(known):
        last = curve.stiffness[-1]
        # shorter curves are continued with their last slope
        extra = curve.strain[-1] + np.arange(1, curves.shape[2] - curve.strain.size + 1)
        curves[slot, 0] = np.concatenate([curve.strain, extra])
        curves[slot, 1] = np.concatenate([curve.tension, curve.tension[-1] + last * (extra - curve.strain[-1])])
        curves[slot, 2] = np.append(np.diff(curves[slot, 1]) / np.diff(curves[slot, 0]), last)
    return (number[network.bars.kind] if len(network.bars) else np.zeros(0, np.int64)), curves


def kernel_arrays(network: Network) -> KernelArrays:
    """Flatten a network."""
    nodes = network.nodes
    curve, curves = _curves(network)
    hinges, bending = find_hinges(network)
    attached = np.flatnonzero((nodes.volume > 0.0) | (nodes.drag_area > 0.0) | (nodes.added_mass > 0.0))
    return KernelArrays(
        _node_rows(network), _bar_rows(network), network.bars.start, network.bars.end, curve, curves, hinges, bending,
        attached.astype(np.int64),
    )  # fmt: skip


def kernel_bed(network: Network, fade: float = 1e-5) -> Array:
    """Return the bed as the kernels take it; ``fade`` is the speed below which friction fades [m/s]."""
    return np.array([0.0, 0.0, 1.0, 0.0]) if network.bed is None else network.bed.numbers(fade)


#: Of the four levels of a grid of two lines either way.
_TWIST = np.array([1.0, -1.0, -1.0, 1.0])


def bed_at_rest(network: Network) -> Array:
    """Return the bed as the kernels of statics take it: friction holds what lies on a plane slope [eq:flexible-held].

    Over a bed that bends friction would also count what a taut line presses onto it, with a sign that only its way
    there decides: there is none.
    """
    bed = kernel_bed(network)
    ground = None if network.bed is None else network.bed.ground
    # a grid of two lines either way may be twisted
    plane = ground is not None and ground.level.shape == (2, 2) and abs(float(_TWIST @ ground.level.ravel())) < 1e-9
    bed[1] = -bed[1] if plane else 0.0
    return bed
