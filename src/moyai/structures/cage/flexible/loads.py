"""What the water does to each part of a flexible cage: the split of its drag."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.flexible.elements import SPHERE
from moyai.flexible.network import Network
from moyai.flexible.panels import forces_on_panels
from moyai.structures.cage.flexible.parts import CageNetwork

#: Parts of the drag split.
PARTS = ("net walls", "net bottoms", "collars", "sinker tubes", "weights", "lines", "buoys")


def _drag_on_bars(network: Network, position: Array, velocity: Array, water: Array) -> Array:
    """Return the drag on both ends of every bar (2, m, 3) [N], as the engine takes it [eq:flexible-morison]."""
    bars = network.bars
    a, b = bars.start, bars.end
    along = position[b] - position[a]
    size = np.linalg.norm(along, axis=1)
    t = along / np.where(size > 0.0, size, 1.0)[:, None]
    radius = np.maximum(0.5 * bars.of_type("diameter"), 1e-9 * bars.length)
    over = position[:, 2] - water[6]
    low, high = np.minimum(over[a], over[b]) - radius, np.maximum(over[a], over[b]) + radius
    wet = np.clip(-low / (high - low), 0.0, 1.0)
    head = 0.25 * network.water.density * bars.of_type("diameter") * bars.length * wet
    force = np.zeros((2, len(bars), 3))
    for side, end in enumerate((a, b)):
        relative = bars.flow_factor[:, None] * water[:3, end].T - velocity[end]
        slide = np.einsum("ij,ij->i", relative, t)
        across = relative - slide[:, None] * t
        speed = np.linalg.norm(across, axis=1)
        force[side] += (head * bars.of_type("drag_normal") * speed)[:, None] * across
        force[side] += (head * bars.of_type("drag_tangential") * np.abs(slide) * slide)[:, None] * t
    return force


def _drag_on_nodes(network: Network, position: Array, velocity: Array, water: Array) -> Array:
    """Return the drag of what is attached to every node (n, 3) [N]."""
    nodes = network.nodes
    with np.errstate(divide="ignore", invalid="ignore"):
        part = np.where(nodes.height > 0.0, 0.5 - (position[:, 2] - water[6]) / nodes.height, 1.0)
    part = np.clip(part, 0.0, 1.0)
    part = np.where((nodes.form == SPHERE) & (nodes.height > 0.0), part**2 * (3.0 - 2.0 * part), part)
    relative = water[:3].T - velocity
    speed = np.linalg.norm(relative, axis=1)
    return np.asarray((0.5 * network.water.density * part * nodes.drag_area * speed)[:, None] * relative)


def drag_split(built: CageNetwork, network: Network, position: Array, velocity: Array, water: Array) -> Array:
    """Return the drag on every part of :data:`PARTS`, shape (parts, 3) [N].

    Parameters
    ----------
    built : CageNetwork
    network : Network
        Its network, with the shelter of the current.
    position, velocity : ndarray, shape (n, 3)
        Of the nodes.
    water : ndarray, shape (7, n)
        Of the flow at the nodes.
    """
    panels = network.panels
    assert panels is not None
    _, each = forces_on_panels(panels, position, velocity, water, network.water.density)
    bars = _drag_on_bars(network, position, velocity, water).sum(axis=0)
    points = _drag_on_nodes(network, position, velocity, water)
    out = np.zeros((len(PARTS), 3))
    for cage in built.cages:
        out[0] += each[cage.wall_panels].sum(axis=0)
        out[1] += each[cage.bottom_panels].sum(axis=0)
        for ring in cage.collar_bars:
            out[2] += bars[ring].sum(axis=0)
        out[3] += bars[cage.ring_bars].sum(axis=0)
    out[4] = points[built.sinkers].sum(axis=0)
    for strand in network.strands:
        out[5] += bars[strand.bars].sum(axis=0)
    out[6] = points[built.buoys].sum(axis=0)
    return out


def drag_on_holds(built: CageNetwork, network: Network, position: Array, water: Array) -> Array:
    """Return the drag that acts on the holds themselves, at rest, (holds, 3) [N].

    Half of the last bar of an anchor line, and the upper corners of the panels of a held collar: no bar pulls it.
    """
    panels = network.panels
    assert panels is not None
    still = np.zeros_like(position)
    total, _ = forces_on_panels(panels, position, still, water, network.water.density)
    ends = _drag_on_bars(network, position, still, water)
    np.add.at(total, network.bars.start, ends[0])
    np.add.at(total, network.bars.end, ends[1])
    return np.asarray(total[holds_of(built)])


def holds_of(built: CageNetwork) -> NDArray[np.int64]:
    """Return the nodes of the anchors, or of a collar that is held."""
    return built.anchors if built.anchors.size else built.cages[0].collar[0]


def pull_on_anchors(built: CageNetwork, network: Network, position: Array, tension: Array) -> Array:
    """Return the force of the cage on its anchors, or on what holds its collar, (holds, 3) [N]."""
    bars = network.bars
    held = holds_of(built)
    t = position[bars.end] - position[bars.start]
    t = t / np.linalg.norm(t, axis=1)[:, None]
    total = np.zeros_like(position)
    np.add.at(total, bars.start, tension[:, None] * t)
    np.add.at(total, bars.end, -tension[:, None] * t)
    return np.asarray(total[held])
