"""Planes of symmetry of a mesh: a quarter of it is solved for each parity in place of the whole."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.structures.units.mesh import PanelMesh


@dataclass(frozen=True, eq=False)
class Symmetry:
    """Mirrors that map a mesh onto itself."""

    #: One entry an element of the group: whether x, whether y changes its sign; the identity first.
    mirrors: tuple[tuple[bool, bool], ...]
    #: Panel of the whole mesh that is the image of panel q of the part, under each element; shape (group, q).
    images: IntArray

    @property
    def part(self) -> IntArray:
        """Panels of the part that is solved."""
        return np.asarray(self.images[0])

    @property
    def parities(self) -> Array:
        """Characters (parity, group): +1 or -1."""
        axes = [any(mirror[axis] for mirror in self.mirrors) for axis in (0, 1)]
        signs = product(*[(1.0, -1.0) if axis else (1.0,) for axis in axes])
        return np.array(
            [[(sx if mx else 1.0) * (sy if my else 1.0) for mx, my in self.mirrors] for sx, sy in signs], dtype=float
        )

    def split(self, values: ComplexArray) -> ComplexArray:
        """Return values (n, r) on the whole mesh as parts (parity, q, r) [eq:units-symmetry]."""
        every = values[self.images]
        return np.asarray(np.einsum("pg,gqr->pqr", self.parities, every) / len(self.mirrors))

    def joined(self, parts: ComplexArray) -> ComplexArray:
        """Undo :meth:`split`."""
        out = np.zeros((self.images.size, parts.shape[2]), dtype=complex)
        for element, panels in enumerate(self.images):
            out[panels] = np.einsum("p,pqr->qr", self.parities[:, element], parts)
        return out


def symmetry_of(mesh: PanelMesh) -> Symmetry:
    """Return the mirrors x -> -x and y -> -y that map a mesh onto itself, none of its panels onto itself."""
    from scipy.spatial import cKDTree

    centre = mesh.centre
    size = float(np.ptp(centre, axis=0).max())
    tolerance = 1e-7 * size
    tree = cKDTree(centre)
    found: list[tuple[int, IntArray]] = []
    for axis in (0, 1):
        mirrored = centre.copy()
        mirrored[:, axis] *= -1.0
        apart, image = tree.query(mirrored)
        normal = mesh.normal.copy()
        normal[:, axis] *= -1.0
        if (
            float(apart.max()) < tolerance
            and len(np.unique(image)) == mesh.count
            and float(np.abs(mesh.normal[image] - normal).max()) < 1e-6
            and float(np.abs(centre[:, axis]).min()) > tolerance
            and bool((mesh.part[image] == mesh.part).all())
        ):
            found.append((axis, np.asarray(image, dtype=np.int64)))
    keep = np.ones(mesh.count, dtype=bool)
    for axis, _ in found:
        keep &= centre[:, axis] > 0.0
    part = np.flatnonzero(keep)
    mirrors: list[tuple[bool, bool]] = [(False, False)]
    images = [part]
    for axis, image in found:
        for mirror, panels in list(zip(mirrors, images)):
            turned = (True, mirror[1]) if axis == 0 else (mirror[0], True)
            mirrors.append(turned)
            images.append(image[panels])
    return Symmetry(tuple(mirrors), np.array(images))
