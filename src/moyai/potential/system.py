"""Green's identity on body and free surface as a matrix, with the body eliminated once for all frequencies.

With n into the fluid on the body and z up on the free surface, every target on either obeys
pi phi + D phi + S q_F - S q_B = 0, where D and S integrate the normal derivative of ln r and ln r with its image in the
bed [eq:potential-green]. The frequency enters through q_F = K phi only. A thin plate carries the jump of phi, and there
the derivative of the identity along its normal stands, 2 pi q + D' phi + S' q_F - S' q_B = 0 [eq:plate-waves].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.potential.mesh import Layout, require_memory
from moyai.potential.oblique_quadrature import add_helmholtz, add_helmholtz_slopes
from moyai.potential.panels import GAP, PLATE, RAY, gauss_rule
from moyai.potential.quadrature import add_rankine, add_rankine_slopes

# Stacks of matrices are cut so that one takes about this many bytes: larger ones are not faster, and several are held
_STACK_BYTES = 8.0e6


@dataclass(frozen=True, eq=False)
class SymmetryBlock:
    """The problem of one symmetry with the body eliminated [eq:potential-reduced].

    phi_F solves (surface + K surface_rate) phi_F = flux q_B; then
    phi_B = body_flux q_B - (body + K body_rate) phi_F.
    """

    #: 1 symmetric, -1 antisymmetric, 0 the whole section.
    sign: int
    body: ComplexArray
    body_rate: ComplexArray
    body_flux: Array
    surface: ComplexArray
    surface_rate: ComplexArray
    flux: ComplexArray

    def solve(
        self, deep_wave_number: Array, flux: ComplexArray, source: ComplexArray | None = None
    ) -> tuple[ComplexArray, ComplexArray]:
        """Return phi on the body (waves, n, problems) and on the free surface.

        Parameters
        ----------
        deep_wave_number : ndarray, shape (waves,)
            K = omega^2 / g [1/m].
        flux : ndarray, shape (waves or 1, n, problems)
            Normal derivative q_B on the body.
        source : ndarray, shape (waves, n, problems), optional
            What the free surface gives in addition to K phi, over 1 + i lid.
        """
        k = deep_wave_number[:, None, None]
        right = self.flux @ flux
        if source is not None:
            right = right - self.surface_rate @ source
        surface = np.linalg.solve(self.surface + k * self.surface_rate, right)
        rate = k * surface if source is None else k * surface + source
        return np.asarray(self.body_flux @ flux - self.body @ surface - self.body_rate @ rate), np.asarray(surface)

    @property
    def chunk(self) -> int:
        """How many frequencies to solve at once."""
        return max(1, int(_STACK_BYTES / (16.0 * (len(self.surface) ** 2 + 1))))


def _slopes(
    u: ComplexArray, normal: ComplexArray, own: IntArray, tables: tuple[Any, ...], crest: float
) -> ComplexArray:
    """Return derivatives of S and D along normals at real targets, one image (2, targets, nodes)."""
    shape = 2, len(u), len(tables[1][0])
    slopes = np.zeros(shape, dtype=complex)
    add_rankine_slopes((u, normal), own, *tables, *slopes)
    if crest > 0.0:
        plain = np.zeros(shape, dtype=complex)
        add_rankine((u, u.conj(), np.ones(len(u), dtype=bool)), own, *tables, *plain)
        add_helmholtz_slopes((u, normal), own, *tables, crest, *plain, *slopes)
    return slopes


def influence(
    layout: Layout, depth: float, crest_wave_number: float = 0.0
) -> list[tuple[int, ComplexArray, ComplexArray]]:
    """Return (sign, S, D) of each symmetry, bed image included; kernel ln r, or -K0(kappa r) for oblique waves."""
    panels = layout.panels
    rule = gauss_rule(panels.order)
    tables = panels.kernel_panels, panels.kernel_nodes, (rule.nodes, rule.weights, rule.projection)
    count = len(panels.u)
    real = panels.kind != RAY
    nobody = np.full(count, -1)
    # On a plate stands the derivative along its normal of what stands elsewhere [eq:plate-waves]
    plate = np.flatnonzero(panels.kind == PLATE)
    other = np.flatnonzero(panels.kind != PLATE)
    towards = -1j * panels.du[plate] / np.abs(panels.du[plate])

    def pair(u: ComplexArray, v: ComplexArray, normal: ComplexArray, own: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        images = [(u, v, normal, own)]
        if math.isfinite(depth):
            images.append((v - 2j * depth, u + 2j * depth, normal.conj(), nobody))
        single, double = np.zeros((2, len(other), count), dtype=complex)
        slopes = np.zeros((2, len(plate), count), dtype=complex)
        for image_u, image_v, image_normal, image_own in images:
            targets = image_u[other], image_v[other], real[other]
            if crest_wave_number > 0.0:
                add_helmholtz(targets, image_own[other], *tables, crest_wave_number, single, double)
            else:
                add_rankine(targets, image_own[other], *tables, single, double)
            if len(plate):
                slopes += _slopes(image_u[plate], image_normal, image_own[plate], tables, crest_wave_number)
        if not len(plate):
            return single, double
        whole = np.zeros((2, count, count), dtype=complex)
        whole[:, other] = single, double
        whole[:, plate] = slopes
        # The flux through a plate is the same on both faces: it is no source
        whole[0, :, plate] = 0.0
        return whole[0], whole[1]

    single, double = pair(panels.u, panels.v, towards, np.arange(count))
    if layout.axis is None:
        return [(0, single, double)]
    mirrored = 2.0 * layout.axis - panels.v, 2.0 * layout.axis - panels.u
    other_single, other_double = pair(*mirrored, -towards.conj(), nobody)
    return [(sign, single + sign * other_single, double + sign * other_double) for sign in (1, -1)]


def reduce_blocks(layout: Layout, depth: float, lid: float, crest_wave_number: float = 0.0) -> list[SymmetryBlock]:
    """Assemble the problem and eliminate the body; ``lid`` damps the enclosed free surface [eq:potential-lid]."""
    require_memory(layout)
    body = slice(0, layout.body_count)
    surface = slice(layout.body_count, None)
    absorbing = np.where(layout.panels.kind[surface] == GAP, 1.0 + 1j * lid, 1.0)
    count = len(absorbing)
    blocks = []
    plate = np.flatnonzero(layout.panels.kind == PLATE)
    for sign, single, double in influence(layout, depth, crest_wave_number):
        double.flat[:: len(double) + 1] += np.where(layout.panels.kind == PLATE, 0.0, math.pi)
        single[plate, plate] = -2.0 * math.pi
        single[:, surface] *= absorbing
        # On the body all is real: the elimination needs real arithmetic only
        columns = np.concatenate([double[body, surface], single[body, surface]], axis=1)
        right = np.concatenate([columns.real, columns.imag, single[body, body].real], axis=1)
        left = np.linalg.solve(double[body, body].real, right)
        eliminated = left[:, : 2 * count] + 1j * left[:, 2 * count : 4 * count]
        from_flux = left[:, 4 * count :]
        below = double[surface, body]
        blocks.append(
            SymmetryBlock(
                sign=sign,
                body=eliminated[:, :count],
                body_rate=eliminated[:, count:],
                body_flux=from_flux,
                surface=double[surface, surface] - below @ eliminated[:, :count],
                surface_rate=single[surface, surface] - below @ eliminated[:, count:],
                flux=single[surface, body] - below @ from_flux,
            )
        )
    return blocks
