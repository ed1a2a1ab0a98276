"""What happens on the two faces and at the free edges of thin plates, from the jump of the potential over them.

Green's representation at a point of a plate gives the mean of both faces, with the plate's own part as a principal
value; half the jump is added on the side to which the normal points and subtracted on the other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.potential.heading import HeadingSolution
from moyai.potential.panels import GAP, PLATE, RAY, Panels, gauss_rule
from moyai.potential.quadrature import add_rankine


@dataclass(frozen=True, eq=False)
class PlateTip:
    """A free edge of a plate."""

    #: Where it is [m]; shape (2,).
    place: Array
    #: Unit vector along which the plate would go on; shape (2,).
    outward: Array
    #: Weights that give C of the jump C sqrt(distance) from the values on all nodes of the body [1 / sqrt(m)]; shape
    #: (n,).
    strength: Array
    #: Number of the body that carries the plate.
    body: int


def plate_tips(body: Panels) -> tuple[PlateTip, ...]:
    """Return the free edges of all plates."""
    rule = gauss_rule(body.order)
    degree = np.arange(body.order)
    steep = 0.5 * degree * (degree + 1.0)
    at_end = steep @ rule.projection
    at_start = (steep * (-1.0) ** (degree + 1)) @ rule.projection
    found = []
    for number, piece in enumerate(body.pieces):
        if piece.kind != PLATE or abs(piece.grade) != 2:
            continue
        last = piece.grade > 0
        length = abs(piece.step) / np.sinc(0.5 * piece.sweep / np.pi)
        # The distance is length times ((1 +- t) / 2)^2
        weights = np.zeros(len(body.u))
        here = slice(number * body.order, (number + 1) * body.order)
        weights[here] = (-2.0 * at_end if last else 2.0 * at_start) / math.sqrt(length)
        place = piece.start + (piece.step if last else 0.0)
        slope = piece.step * np.exp(1j * piece.sweep * (0.5 if last else -0.5))
        outward = slope / abs(slope) * (1.0 if last else -1.0)
        found.append(
            PlateTip(
                np.array([place.real, place.imag]), np.array([outward.real, outward.imag]), weights, int(piece.body)
            )
        )
    return tuple(found)


def mean_of_faces(
    part: HeadingSolution,
    depth: float,
    on_body: ComplexArray,
    flux: ComplexArray,
    on_surface: ComplexArray,
    surface_flux: ComplexArray,
) -> ComplexArray:
    """Return the mean of the potential on both faces (waves, plate nodes) [eq:plate-mean].

    Parameters
    ----------
    part : HeadingSolution
        Whose boundary it is; waves along +x.
    depth : float
        Water depth [m].
    on_body, flux : ndarray, shape (waves, n)
        Potential (jump on plates) and normal derivative on the nodes of the body.
    on_surface, surface_flux : ndarray, shape (waves, m)
        The same on the free surface.
    """
    body, surface = part.body, part.surface
    plate = np.flatnonzero(body.kind == PLATE)
    here = body.u[plate]
    nobody = np.full(len(plate), -1)
    real = np.ones(len(plate), dtype=bool)
    total = np.zeros((len(on_body), len(plate)), dtype=complex)
    closed = np.where(body.kind == PLATE, 0.0, 1.0)
    for panels, value, rate in ((body, on_body, -flux * closed), (surface, on_surface, surface_flux)):
        rule = gauss_rule(panels.order)
        tables = panels.kernel_panels, panels.kernel_nodes, (rule.nodes, rule.weights, rule.projection)
        single, double = np.zeros((2, len(plate), len(panels.u)), dtype=complex)
        add_rankine((here, here.conj(), real), plate if panels is body else nobody, *tables, single, double)
        if math.isfinite(depth):
            image = here.conj() - 2j * depth
            add_rankine((image, image.conj(), real), nobody, *tables, single, double)
        total -= value @ double.T + rate @ single.T
    return np.asarray(total / (2.0 * math.pi))


def surface_ends(surface: Panels, x: float) -> tuple[Array, Array]:
    """Return weights that give the potential of the free surface just left and just right of a plate at ``x``."""
    rule = gauss_rule(surface.order)
    scale = max(abs(x), float(np.abs([piece.step for piece in surface.pieces if piece.kind != RAY] or [0.0]).max()))
    sides = []
    for end, values in ((1, rule.last), (0, rule.first)):
        weights = np.zeros(len(surface.u))
        for number, piece in enumerate(surface.pieces):
            place = piece.start + end * piece.step
            if abs(place - x) < 1e-9 * max(scale, abs(piece.step)):
                weights[number * surface.order : (number + 1) * surface.order] = values
        sides.append(weights)
    return sides[0], sides[1]


def surface_rate(part: HeadingSolution, lid: float, on_surface: ComplexArray, gap_wave: ComplexArray) -> ComplexArray:
    """Return the vertical velocity of the disturbance on the nodes of the free surface [eq:potential-lid].

    ``gap_wave`` is the incident wave (waves, nodes of the enclosed surface).
    """
    deep = part.states.deep_wave_number[:, None]
    rate = deep * on_surface
    gap = part.surface.kind == GAP
    if lid > 0.0 and gap.any():
        rate[:, gap] += 1j * lid * deep * (on_surface[:, gap] + gap_wave)
    return np.asarray(rate)
