"""Which nodes, bars and panels of a network belong to which part of a cage."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.flexible.network import Network


@dataclass(frozen=True, eq=False)
class CageParts:
    """One cage in the network."""

    name: str
    #: Where its middle stands as built (x, y) [m].
    centre: tuple[float, float]
    #: Nodes of the wall, the first row on the collar; shape (down + 1, around).
    wall: IntArray
    #: Rings of nodes of the bottom inside its rim.
    bottom: tuple[IntArray, ...]
    #: Node in the middle of the bottom; -1 without bottom net.
    hub: int
    #: Nodes of the collar's rings, the inner first.
    collar: tuple[IntArray, ...]
    #: Bars of each ring; bar k goes from node k to the next. Empty for a collar that is held.
    collar_bars: tuple[IntArray, ...]
    #: Bars of the sinker tube.
    ring_bars: IntArray
    #: Panels of the wall.
    wall_panels: IntArray
    #: Panels of the bottom.
    bottom_panels: IntArray
    #: Bars of grouped twines.
    net_bars: IntArray
    #: Corners of its panels; shape (p, 4).
    corners: IntArray
    #: Inside the net as built [m3].
    rest_volume: float

    def volume(self, position: Array) -> Array:
        """Return the volume inside the net [m3] at places of all nodes (..., n, 3) [eq:cage-volume]."""
        return enclosed_volume(self.corners, self.wall[0], self.wall[-1] if self.hub < 0 else None, position)

    @property
    def net_nodes(self) -> IntArray:
        """All nodes of the net."""
        hub = np.array([self.hub] if self.hub >= 0 else [], dtype=np.int64)
        return np.concatenate([self.wall.ravel(), *(ring.ravel() for ring in self.bottom), hub]).astype(np.int64)


@dataclass(frozen=True)
class LinePart:
    """One rope or line."""

    #: Its name.
    name: str
    #: ``anchor``, ``bridle``, ``frame`` or ``buoy``.
    kind: str
    #: Index into the strands of the network, from the anchor, frame corner or lower end upwards.
    strand: int
    #: The smallest of its segments [N].
    breaking_load: float


@dataclass(frozen=True, eq=False)
class CageNetwork:
    """A cage, or several, as a network."""

    network: Network
    cages: tuple[CageParts, ...]
    lines: tuple[LinePart, ...]
    #: Nodes of the anchors.
    anchors: IntArray
    #: Nodes of the buoys.
    buoys: IntArray
    #: Nodes of the sinkers.
    sinkers: IntArray

    @property
    def anchor_names(self) -> list[str]:
        """Names of the anchors: those of their lines."""
        return [part.name for part in self.lines if part.kind == "anchor"]

    def net_tension(self, tension: Array) -> Array:
        """Return the largest tension [N/m] of each net over the width that a bar stands for, (..., cages).

        The width [m] is half of each panel at the bar, over its length, as built [eq:net-tension].

        Parameters
        ----------
        tension : ndarray (..., bars)
            Of all bars of the network [N].
        """
        return np.stack(
            [
                (tension[..., cage.net_bars] / bar_widths(self.network, cage.net_bars)).max(axis=-1)
                for cage in self.cages
            ],
            axis=-1,
        )


def bar_widths(network: Network, bars: IntArray) -> Array:
    """Return the width of net that each bar stands for, as built [m]: half of the panels at it over its length."""
    panels = network.panels
    assert panels is not None
    size = len(network.nodes.position)
    corners = panels.corners
    # a triangle's last side runs from its third corner to its first
    third = np.where(corners[:, 3] < 0, corners[:, 0], corners[:, 3])
    sides = [corners[:, :2], corners[:, 1:3], np.stack([corners[:, 2], third], axis=1), corners[:, [3, 0]]]
    area = np.concatenate([panels.area, panels.area, panels.area, np.where(corners[:, 3] < 0, 0.0, panels.area)])
    ends = np.sort(np.concatenate(sides), axis=1)
    key = ends[:, 0] * size + ends[:, 1]
    own = np.sort(np.stack([network.bars.start[bars], network.bars.end[bars]], axis=1), axis=1)
    names, where = np.unique(key, return_inverse=True)
    adjacent = np.zeros(len(names) + 1)
    np.add.at(adjacent, where, area)
    wanted = own[:, 0] * size + own[:, 1]
    at = np.searchsorted(names, wanted)
    at = np.where((at < len(names)) & (names[np.minimum(at, len(names) - 1)] == wanted), at, len(names))
    width = 0.5 * adjacent[at] / network.bars.length[bars]
    return np.where(width > 0.0, width, np.inf)


def _six(p: Array, q: Array, r: Array) -> Array:
    """Return six times the volume between the origin and triangles, summed over them."""
    return np.asarray(np.sum(np.cross(p, q) * r, axis=(-2, -1)))


def _fan(ring: Array) -> Array:
    """Return six times the volume between the origin and a ring closed by its mean point, (..., k, 3) -> (...)."""
    return _six(ring, np.roll(ring, -1, axis=-2), np.broadcast_to(ring.mean(axis=-2, keepdims=True), ring.shape))


def enclosed_volume(corners: IntArray, top: IntArray, rim: IntArray | None, position: Array) -> Array:
    """Return the volume between the collar's plane and the panels of a net [m3] [eq:cage-volume].

    Parameters
    ----------
    corners : ndarray of int, shape (p, 4)
        Panels, all turned the same way; a quad counts as the mean of its two foldings.
    top : ndarray of int
        Knots of the collar, closed by a fan to their mean point.
    rim : ndarray of int, optional
        Lower rim of a net without bottom, closed alike.
    position : ndarray, shape (..., n, 3)
    """
    base = position[..., top, :].mean(axis=-2, keepdims=True)
    quad, flat = corners[corners[:, 3] >= 0], corners[corners[:, 3] < 0]
    a, b, c, d = (position[..., quad[:, k], :] - base for k in range(4))
    six = 0.5 * (_six(a, b, c) + _six(a, c, d) + _six(a, b, d) + _six(b, c, d))
    if len(flat):
        six = six + _six(*(position[..., flat[:, k], :] - base for k in range(3)))
    six = six + _fan(position[..., top, :] - base)
    if rim is not None:
        six = six - _fan(position[..., rim, :] - base)
    return np.asarray(np.abs(six) / 6.0)
