"""Added mass at infinite and at zero frequency from the wetted boundary alone.

The still water is a mirror in both limits: phi = 0 there when the frequency is infinite, no flow through it when it is
zero. With the bed as second mirror the images repeat for ever and sum to sinh [eq:potential-limit-infinite],
[eq:potential-limit-zero].

At zero frequency a mode that displaces the volume Q drives the flux Q/2 to each side, and the potential far off is that
of a long wave, (Q / 2h) (1/ik + |x| - b/2): b, the breadth of the waterlines, is where the surface cannot store what
passes. The mirrors give |x| alone, the constant is added. In infinite depth such a mode has no limit: NaN.
"""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.potential.heading import Problem
from moyai.potential.panels import PLATE, Panels, gauss_rule
from moyai.potential.quadrature import add_rankine, add_rankine_slopes


def limit_added_mass(problem: Problem, waterplane_breadth: float, *, infinite_frequency: bool) -> Array:
    """Return the added mass (radiating, influenced) at infinite or zero frequency.

    Parameters
    ----------
    problem : Problem
        Whole wetted boundary, modes and water.
    waterplane_breadth : float
        Sum of the breadths of the waterlines [m].
    infinite_frequency : bool
        Which limit.
    """
    body, displacement, depth, density = problem.body, problem.displacement, problem.water.depth, problem.water.density
    single, double = _mirrored_influence(body, depth, -1.0 if infinite_frequency else 1.0)
    plate = body.kind == PLATE
    double.flat[:: len(double) + 1] += np.where(plate, 0.0, math.pi)
    if plate.any():
        # Plates: the derivative along the normal, and no source [eq:plate-waves]
        single[:, plate] = 0.0
        single[plate, plate] = -2.0 * math.pi
    weight = body.weight.real
    mass = -density * (displacement * weight) @ np.linalg.solve(double, single @ displacement.T)
    if not infinite_frequency:
        volume = displacement @ np.where(plate, 0.0, weight)
        if math.isfinite(depth):
            mass += 0.25 * density * waterplane_breadth / depth * np.outer(volume, volume)
        else:
            displaces = np.abs(volume) > 1e-9 * (np.abs(displacement) @ weight)
            mass[np.ix_(displaces, displaces)] = np.nan
    return np.asarray(mass.T)


def _mirrored_influence(body: Panels, depth: float, surface_sign: float) -> tuple[Array, Array]:
    """S and D of the wetted boundary with its images in still water and bed."""
    rule = gauss_rule(body.order)
    tables = body.kernel_panels, body.kernel_nodes, (rule.nodes, rule.weights, rule.projection)
    count = len(body.u)
    nobody = np.full(count, -1)
    normal = -1j * body.du / np.abs(body.du)
    plate, other = np.flatnonzero(body.kind == PLATE), np.flatnonzero(body.kind != PLATE)
    real = np.ones(len(other), dtype=bool)
    images: list[tuple[ComplexArray, ComplexArray, float]] = [
        (body.u, normal, 1.0),
        (body.v, normal.conj(), surface_sign),
    ]
    if math.isfinite(depth):
        images.append((body.v - 2j * depth, normal.conj(), 1.0))
    single, double = np.zeros((2, count, count))
    for number, (image, towards, sign) in enumerate(images):
        own = np.arange(count) if number == 0 else nobody
        s, d = np.zeros((2, len(other), count), dtype=complex)
        add_rankine((image[other], image[other].conj(), real), own[other], *tables, s, d)
        single[other] += sign * s.real
        double[other] += sign * d.real
        if len(plate):
            s, d = np.zeros((2, len(plate), count), dtype=complex)
            add_rankine_slopes((image[plate], towards[plate]), own[plate], *tables, s, d)
            single[plate] += sign * s.real
            double[plate] += sign * d.real
    if math.isfinite(depth):
        s_rest, d_rest = _all_images(body, normal, depth, surface_sign)
        single += s_rest
        double += d_rest
    return single, double


def _all_images(body: Panels, normal: ComplexArray, depth: float, surface_sign: float) -> tuple[Array, Array]:
    """What the endless images add to the three integrated exactly; smooth, so that the Gauss rule suffices."""
    source = body.u[None, :]
    plate = np.flatnonzero(body.kind == PLATE)
    if surface_sign < 0.0:
        rate = math.pi / (4.0 * depth)
        families = [
            (body.u, normal, 1.0, True),
            (body.v, normal.conj(), -1.0, True),
            (body.v - 2j * depth, normal.conj(), 1.0, True),
            (body.u - 2j * depth, normal, -1.0, False),
        ]
    else:
        # The bed image belongs to the second family here, one period away
        rate = math.pi / (2.0 * depth)
        families = [(body.u, normal, 1.0, True), (body.v, normal.conj(), 1.0, True)]
    potential = np.zeros((len(body.u), len(body.u)))
    slope = np.zeros((len(body.u), len(body.u)), dtype=complex)
    for image, towards, sign, pole_done in families:
        offset = source - image[:, None]
        value, change = (_log_sinh_rest if pole_done else _log_sinh)(rate * offset)
        if pole_done:
            value = value + math.log(rate)
        if len(plate):
            direction = -towards[plate, None]
            value[plate] = (direction * rate * change[plate]).real
            change[plate] = direction * rate * _second(rate * offset[plate], pole_done)
        potential += sign * value
        slope += sign * rate * change
    if surface_sign > 0.0:
        offset = source - (body.v - 2j * depth)[:, None]
        value, change = np.log(np.abs(offset)), 1.0 / offset
        value -= 2.0 * math.log(2.0)
        if len(plate):
            direction = -normal[plate, None].conj()
            value[plate] = (direction * change[plate]).real
            change[plate] = -direction * change[plate] ** 2
        # 2 sinh rather than sinh: at a great distance the kernel is then pi |x| / h without a constant
        potential -= value
        slope -= change
    rule = gauss_rule(body.order)
    weights = np.tile(rule.weights, len(body.pieces))
    return potential * body.weight.real, (slope * (body.du * weights)).imag


def _second(y: ComplexArray, rest: bool) -> ComplexArray:
    """Derivative of coth y; of coth y - 1/y for the rest, which is smooth at y = 0."""
    forward = np.where(y.real >= 0.0, y, -y)
    small = np.exp(-2.0 * forward)
    if not rest:
        return np.asarray(-4.0 * small / (1.0 - small) ** 2)
    near = np.abs(y) < 0.4
    small = np.where(near, 0.5, small)
    s = np.where(near, y * y, 0.0)
    series = 1.0 / 3.0 - s * (1.0 / 15.0 - s * (2.0 / 189.0 - s * (1.0 / 675.0 - s * (2.0 / 10395.0))))
    safe = np.where(near, 1.0, y)
    return np.asarray(np.where(near, series, -4.0 * small / (1.0 - small) ** 2 + 1.0 / safe**2))


def _log_sinh(y: ComplexArray) -> tuple[Array, ComplexArray]:
    """ln |sinh y| and coth y, without overflow."""
    forward = np.where(y.real >= 0.0, y, -y)
    small = np.exp(-2.0 * forward)
    value = forward.real - math.log(2.0) + np.log(np.abs(1.0 - small))
    return value, np.asarray(np.where(y.real >= 0.0, 1.0, -1.0) * (1.0 + small) / (1.0 - small), dtype=np.complex128)


def _log_sinh_rest(y: ComplexArray) -> tuple[Array, ComplexArray]:
    """ln |sinh y / y| and coth y - 1/y; both smooth at y = 0."""
    near = np.abs(y) < 0.4
    safe = np.where(near, 1.0, y)
    value, change = _log_sinh(safe)
    s = np.where(near, y * y, 0.0)
    series = s * (1.0 / 6.0 - s * (1.0 / 180.0 - s * (1.0 / 2835.0 - s * (1.0 / 37800.0 - s / 467775.0))))
    slope = y * (1.0 / 3.0 - s * (1.0 / 45.0 - s * (2.0 / 945.0 - s * (1.0 / 4725.0 - s * (2.0 / 93555.0)))))
    rest = np.where(near, slope, change - 1.0 / safe)
    return np.where(near, series.real, value - np.log(np.abs(safe))), np.asarray(rest, dtype=np.complex128)
