"""Viscous damping of a floating section by eddies at its edges, from the outline alone.

Every sharp edge under water is one quadratic drag on one linear measure of the velocity of the body, so that sway,
heave and roll are coupled by the lever of the edge and the answer does not depend on the point that the motions are
counted about [eq:viscous-edge]. The numbers stand in ``moyai/tables/data/edge_damping.csv``.

The velocity is that of the body against the undisturbed wave at the points of the measure [eq:viscous-water]: a body
that follows long waves sheds no eddies. Still water is the case of the decay tests that the numbers come from.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.floating.damping import QuadraticDamping

PLATE_POINTS = 8
"""Gauss points along a thin plate: |v| v of a plate that turns about a point on it within 2 %."""


@dataclass(frozen=True)
class EdgeFace:
    """A face next to an edge, as far as it belongs to that edge."""

    #: End of it away from the edge (x, z) [m].
    far: tuple[float, float]
    #: [m].
    length: float
    #: Out of the body.
    normal: tuple[float, float]


@dataclass(frozen=True)
class CornerEdge:
    """A corner of the section under water."""

    #: (x, z) [m], for a round bilge where the faces would meet.
    point: tuple[float, float]
    #: Face before the edge.
    before: EdgeFace
    #: Face after the edge.
    after: EdgeFace
    #: C_p, rounding and angle included; the same at every KC for a right angle [eq:viscous-exponent].
    pressure: float


@dataclass(frozen=True)
class PlateEdge:
    """A thin plate with a free edge: from its root to its tip (x, z) [m], with its drag coefficient."""

    root: tuple[float, float]
    tip: tuple[float, float]
    drag: float


def equivalent_point(first: float, second: float) -> float:
    """Return where on a face the velocity that counts is taken, as a part of the face from its far end.

    Chosen so that a box that rolls about the still water has the damping of Ikeda's sharp-cornered barge at every
    ratio of beam to draught [eq:viscous-point].

    Parameters
    ----------
    first, second : float
        Lengths of the two faces [m].
    """
    numerator = (0.5 * (first**2 + second**2) ** 2) ** (1.0 / 3.0)
    return float(numerator / (first ** (4.0 / 3.0) + second ** (4.0 / 3.0)))


@dataclass(frozen=True)
class Measure:
    """One measure of velocity: weighted velocities of points along directions, with its drag coefficient per length."""

    #: Shape (p,).
    weights: Array
    #: (x, z) [m]; shape (p, 2).
    points: Array
    #: Unit vectors; shape (p, 2).
    directions: Array
    #: c / (rho l) of the force c |J v| J v.
    coefficient: float

    def row(self, centre: tuple[float, float]) -> Array:
        """Return J of sway, heave, roll about ``centre``."""
        rows = [
            weight * velocity_row(point, direction, centre)
            for weight, point, direction in zip(self.weights, self.points, self.directions, strict=True)
        ]
        values: Array = np.sum(rows, axis=0)
        return values


def measures(corners: tuple[CornerEdge, ...], plates: tuple[PlateEdge, ...]) -> tuple[Measure, ...]:
    """Return the measures of corners [eq:viscous-edge] and of points along plates [eq:viscous-plate]."""
    found = []
    for edge in corners:
        part = equivalent_point(edge.before.length, edge.after.length)
        faces = (edge.before, edge.after)
        far = np.array([face.far for face in faces])
        found.append(
            Measure(
                np.array([edge.before.length ** (1.0 / 3.0), -(edge.after.length ** (1.0 / 3.0))]),
                far + part * (np.array(edge.point) - far),
                np.array([face.normal for face in faces]),
                0.5 * edge.pressure,
            )
        )
    nodes, weights = np.polynomial.legendre.leggauss(PLATE_POINTS)
    for plate in plates:
        root, tip = np.array(plate.root), np.array(plate.tip)
        extent = float(np.hypot(*(tip - root)))
        along = (tip - root) / extent
        normal = np.array([[-along[1], along[0]]])
        for node, weight in zip(nodes, weights, strict=True):
            point = root + 0.5 * (1.0 + node) * (tip - root)
            drag = 0.5 * plate.drag * 0.5 * float(weight) * extent
            found.append(Measure(np.ones(1), point[None, :], normal, drag))
    return tuple(found)


def velocity_row(point: Array, direction: Array, centre: tuple[float, float]) -> Array:
    """Return the velocity of a point of the body along a direction per unit velocity of sway, heave, roll."""
    x, z = point[0] - centre[0], point[1] - centre[1]
    return np.array([direction[0], direction[1], direction[0] * z - direction[1] * x])


def edge_damping(
    corners: tuple[CornerEdge, ...],
    plates: tuple[PlateEdge, ...],
    centre: tuple[float, float],
    density: float,
    length: float,
) -> QuadraticDamping:
    """Return the quadratic damping of a unit by eddies at its edges [eq:viscous-edge] [eq:viscous-plate].

    A sharp-cornered box that rolls about the still water has what Ikeda gives for a barge [eq:viscous-barge].

    Parameters
    ----------
    corners : tuple of CornerEdge
    plates : tuple of PlateEdge
    centre : tuple of float
        Centre of the modes sway, heave, roll (x, z) [m].
    density : float
        Of the water [kg/m3].
    length : float
        Of the unit [m].

    Raises
    ------
    InputError
        For a density or length that is not positive.
    """
    for name, value in (("density", density), ("length", length)):
        if not value > 0.0:
            raise InputError(f"{name} is {value}", parameter=name, allowed="greater than 0")
    found = measures(corners, plates)
    rows = np.array([item.row(centre) for item in found]).reshape(-1, 3)
    return QuadraticDamping(rows, density * length * np.array([item.coefficient for item in found]))


def water_measure(
    corners: tuple[CornerEdge, ...],
    plates: tuple[PlateEdge, ...],
    omega: Array,
    wave_number: Array,
    heading: Array,
    depth: float,
) -> ComplexArray:
    """Return the undisturbed wave in the measures of :func:`edge_damping`, per metre of amplitude [eq:viscous-water].

    Parameters
    ----------
    corners, plates
        As in :func:`edge_damping`.
    omega, wave_number, heading : ndarray (...)
        [rad/s], [1/m], [rad]; they broadcast.
    depth : float
        [m]; may be infinite.

    Returns
    -------
    ndarray (..., k)
        Complex, time factor exp(-i omega t), phase of the wave at x = 0.
    """
    w, k, beta = np.broadcast_arrays(omega, wave_number, heading)
    found = measures(corners, plates)
    out = np.zeros((*w.shape, len(found)), dtype=np.complex128)
    for column, measure in enumerate(found):
        for weight, (x, z), direction in zip(measure.weights, measure.points, measure.directions, strict=True):
            down, mirrored = np.exp(k * z), np.exp(-k * (z + 2.0 * depth))
            decay = w * np.exp(1j * k * x * np.cos(beta)) / (1.0 - np.exp(-2.0 * k * depth))
            across = np.cos(beta) * decay * (down + mirrored)
            upward = -1j * decay * (down - mirrored)
            out[..., column] += weight * (direction[0] * across + direction[1] * upward)
    return out


def lewis_parameters(half_beam_over_draught: float, area_coefficient: float) -> tuple[float, float]:
    """Return a1 and a3 of the Lewis form of this half beam over draught and area coefficient."""
    ratio = (half_beam_over_draught - 1.0) / (half_beam_over_draught + 1.0)
    c = 4.0 * area_coefficient / math.pi
    d = 3.0 + c + (1.0 - c) * ratio**2
    a3 = (3.0 - d + math.sqrt(9.0 - 2.0 * d)) / d
    return (1.0 + a3) * ratio, a3


def eddy_coefficient(half_beam: float, radius: float) -> float:
    """Return Ikeda's C_R of a box with round bilges that rolls about the still water [eq:viscous-round].

    Parameters
    ----------
    half_beam, radius : float
        Half the beam and bilge radius over the draught.

    Returns
    -------
    float
        b2 is C_R rho d^4 / 2 per length.
    """
    sigma = 1.0 - (1.0 - 0.25 * math.pi) * radius**2 / half_beam
    f1 = 0.5 * (1.0 + math.tanh(20.0 * (sigma - 0.7)))
    f2 = (
        0.5 * (1.0 - math.cos(math.pi * sigma))
        - 1.5 * (1.0 - math.exp(-5.0 * (1.0 - sigma))) * math.sin(math.pi * sigma) ** 2
    )
    f3 = 1.0 + 4.0 * math.exp(-1.65e5 * (1.0 - sigma) ** 2)
    a1, a3 = lewis_parameters(half_beam, sigma)
    scale = half_beam / (1.0 + a1 + a3)  # over the draught, as all lengths here

    def distance(psi: float) -> float:
        across = (1.0 + a1) * math.sin(psi) - a3 * math.sin(3.0 * psi)
        down = (1.0 - a1) * math.cos(psi) + a3 * math.cos(3.0 * psi)
        return scale * math.hypot(across, down)

    turning = a1 * (1.0 + a3) / (4.0 * a3) if a3 != 0.0 else math.inf  # without a3 it is an ellipse
    psi = max([0.0] + ([0.5 * math.acos(turning)] if abs(turning) <= 1.0 else []), key=distance)
    farthest = distance(psi)
    h = 1.0 + a1**2 + 9.0 * a3**2 + 2.0 * a1 * (1.0 - 3.0 * a3) * math.cos(2.0 * psi) - 6.0 * a3 * math.cos(4.0 * psi)
    speed = math.hypot(
        -2.0 * a3 * math.cos(5.0 * psi)
        + a1 * (1.0 - a3) * math.cos(3.0 * psi)
        + ((6.0 - 3.0 * a1) * a3**2 + (a1**2 - 3.0 * a1) * a3 + a1**2) * math.cos(psi),
        -2.0 * a3 * math.sin(5.0 * psi)
        + a1 * (1.0 - a3) * math.sin(3.0 * psi)
        + ((6.0 + 3.0 * a1) * a3**2 + (3.0 * a1 + a1**2) * a3 + a1**2) * math.sin(psi),
    )
    gamma = math.sqrt(math.pi) * f3 / (2.0 * math.sqrt(half_beam * sigma)) * (farthest + 2.0 * scale / h * speed)
    pressure = 0.5 * (0.87 * math.exp(-gamma) - 4.0 * math.exp(-0.187 * gamma) + 3.0)
    lever = (1.0 - f1 * radius) ** 2 + f2 * (half_beam - f1 * radius) ** 2
    return lever * pressure * farthest**2


def rounding_factor(half_beam: float, radius: float) -> float:
    """Return the eddy damping of a bilge of radius R over that of a sharp one, by Ikeda's law [eq:viscous-round].

    Parameters
    ----------
    half_beam, radius : float
        Length of the bottom face and bilge radius over that of the side; the former within the range of the law.
    """
    if radius == 0.0:
        return 1.0
    sharp = eddy_coefficient(half_beam, 0.0)
    return min(1.0, max(0.0, eddy_coefficient(half_beam, radius) / sharp))
