"""Grouped twines: many meshes of a net drawn together into few bars that keep its material, stiffness and mass."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.flexible.elements import BarType


@dataclass(frozen=True, eq=False)
class GroupedBars:
    """Bars that stand for the twines of a net."""

    #: Node at the start.
    start: IntArray
    #: Node at the end.
    end: IntArray
    #: Unstretched [m].
    length: Array
    #: Length of all twines that each bar stands for [m].
    twine_length: Array
    #: How many twines side by side carry its tension [-].
    twines: Array

    def types(
        self,
        name: str,
        *,
        twine_mass: float,
        twine_volume: float,
        twine_stiffness: float,
        added_mass: float,
        damping: float,
    ) -> tuple[IntArray, tuple[BarType, ...]]:
        """Return the type of every bar and the types, for twines of given mass [kg/m], volume [m2] and EA [N].

        Bars carry no drag: the water loads the panels between them. ``damping`` is the damping ratio of the elastic
        wave on the mesh.
        """
        density = self.twine_length / self.length
        properties = np.stack(
            [density * twine_mass, density * twine_volume, self.twines * twine_stiffness, self.length], axis=1
        )
        scale = np.where(properties > 0.0, 10.0 ** np.floor(np.log10(np.maximum(properties, 1e-300))), 1.0)
        rounded = np.round(properties / scale, 8) * scale
        unique, kind = np.unique(rounded, axis=0, return_inverse=True)
        types = tuple(
            BarType(
                name,
                float(mass),
                float(stiffness),
                float(2.0 * np.sqrt(volume / np.pi)),
                float(volume),
                viscosity=float(damping * length * np.sqrt(stiffness * mass)),
                added_mass_normal=added_mass,
            )
            for mass, volume, stiffness, length in unique
        )
        return kind.reshape(-1).astype(np.int64), types


def group_meshes(corners: IntArray, rest: Array, pitch: float) -> GroupedBars:
    """Draw the twines of square meshes together into the edges of panels.

    Of a quad a-b-c-d twines run along a-d and b-c, and along a-b and d-c; of a triangle a-b-c with its point c, along
    a-b and towards c. Each family has one twine a pitch, half of it goes to either edge, so that the length of all
    bars' twines is twice the area over the pitch [eq:cage-mesh-group].

    Parameters
    ----------
    corners : ndarray of int, shape (p, 4)
        Panels; the fourth corner of a triangle is -1.
    rest : ndarray, shape (n, 3)
        Unstretched places of the nodes [m].
    pitch : float
        Between neighbouring twines [m].
    """
    from moyai.flexible.panels import panel_areas

    area, _ = panel_areas(corners, rest)
    edges: dict[tuple[int, int], list[float]] = {}

    def add(i: int, j: int, twine: float, count: float) -> None:
        entry = edges.setdefault((min(i, j), max(i, j)), [0.0, 0.0])
        entry[0] += twine
        entry[1] += count

    def size(i: int, j: int) -> float:
        return float(np.linalg.norm(rest[j] - rest[i]))

    for (a, b, c, d), whole in zip(corners.tolist(), area.tolist(), strict=True):
        half = 0.5 * whole / pitch
        if d >= 0:
            for one, two in (((a, d), (b, c)), ((a, b), (d, c))):
                count = half / (0.5 * (size(*one) + size(*two)))
                add(*one, half, count)
                add(*two, half, count)
        else:
            height = 2.0 * whole / size(a, b)
            add(a, b, 2.0 * half, height / pitch)
            add(a, c, half, half / height)
            add(b, c, half, half / height)
    # neighbours in memory first: the kernels run over them in one sweep
    pairs = np.array(sorted(edges, key=lambda pair: (pair[1] - pair[0], pair[0])), dtype=np.int64).reshape(-1, 2)
    values = np.array([edges[(int(i), int(j))] for i, j in pairs]).reshape(-1, 2)
    length = np.linalg.norm(rest[pairs[:, 1]] - rest[pairs[:, 0]], axis=1)
    return GroupedBars(pairs[:, 0], pairs[:, 1], length, values[:, 0], values[:, 1])
