"""Thin plates in the limits of infinite and zero frequency: jump of the potential and added mass.

A plate of no thickness is a line of doublets. Its stream function is given along the plate up to a constant, the jump
of the potential vanishes at a free edge, and the still water and the bed are mirrors [eq:plate-stream],
[eq:plate-images].
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, cast

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import check_kind, checks_words
from moyai.potential.edges import arc_position, arc_slope, as_points
from moyai.potential.modes import DisplacementField, Modes, rigid_modes
from moyai.potential.thin_plate_grid import PlateGrid, plate_grid, with_tails
from moyai.sea.water import Water, check_water

#: Normal velocity (n,) at points (n, 2) with unit normals (n, 2), for unit amplitude of a mode
NormalVelocity = Callable[[Array, Array], Array]

# Share of the length that holds no unknowns at the waterline, at a free edge, and at the bed
_CUT_SURFACE, _CUT_EDGE, _CUT_BED = 1e-8, 1e-13, 1e-9
_TAIL = 1e-4
# A plate that leaves the still water along itself: sine of the angle, the cut there, the share to which its nodes go
_CUSP, _CUT_CUSP, _TAIL_CUSP = 1e-3, 1e-2, 5e-2


@dataclass(frozen=True)
class Plate:
    """A straight or circular plate of no thickness.

    Its normal points to the left of the way from ``start`` to ``end``: towards +x for a plate that hangs down from its
    start.

    Raises
    ------
    InputError
        When the plate has no length, is more than a half circle, or rises above the still water.

    Examples
    --------
    >>> from moyai.potential import Plate
    >>> skirt = Plate(start=(0.0, 0.0), end=(0.0, -2.0))
    >>> skirt.length, skirt.pierces                                      # [m]
    (2.0, True)
    """

    #: x, z of its start [m]; may lie on the still water z = 0 or be submerged.
    start: tuple[float, float]
    #: x, z of its end [m]; may stand on the bed or be submerged.
    end: tuple[float, float]
    #: tan(sweep / 4): 0 straight, positive turns counter-clockwise (a hanging plate bulges towards -x), 1 half circle.
    bulge: float = 0.0

    def __post_init__(self) -> None:
        values = (*self.start, *self.end, self.bulge)
        if not all(math.isfinite(value) for value in values):
            raise InputError("the plate has coordinates that are not finite", parameter="plate")
        if self.start == self.end:
            raise InputError("the plate has no length", parameter="plate", allowed="start and end apart")
        if abs(self.bulge) > 1.0 + 1e-12:
            raise InputError(f"bulge is {self.bulge:g}", parameter="plate.bulge", allowed="-1 to 1 (a half circle)")
        highest = float(self.position(np.linspace(0.0, 1.0, 201)[1:-1]).imag.max())
        if self.start[1] > 0.0 or self.end[1] >= 0.0 or highest > 1e-12 * self.length:
            raise InputError(
                f"the plate reaches up to z = {max(self.start[1], self.end[1], highest):g} m",
                parameter="plate",
                allowed="z <= 0, and only the start at z = 0",
                remedy="cut the plate at the still water and start there",
            )

    @property
    def length(self) -> float:
        """Length along the plate [m]."""
        return float(abs(self.slope(np.array([0.0]))[0]))

    @property
    def pierces(self) -> bool:
        """Whether the plate starts at the still water."""
        return self.start[1] == 0.0

    @property
    def corner(self) -> float:
        """Sine of the angle between plate and still water at the start [-]; 1 for a submerged plate."""
        if not self.pierces:
            return 1.0
        slope = self.slope(np.array([0.0]))[0]
        return max(0.0, -float(slope.imag) / self.length)

    def position(self, fraction: Array) -> ComplexArray:
        """Return x + i z at arc-length fractions [m].

        Parameters
        ----------
        fraction : ndarray (...)
            Arc length from the start over the whole length, 0 to 1 [-].
        """
        return np.asarray(arc_position(*self._ends, np.asarray(self.bulge), fraction))

    def offset(self, fraction: Array) -> ComplexArray:
        """Return the position from the start of the plate, x + i z, with all digits near it [m].

        Parameters
        ----------
        fraction : ndarray (...)
            Arc length from the start over the whole length, 0 to 1 [-].
        """
        start, end = self._ends
        return np.asarray(arc_position(0.0 * start, end - start, np.asarray(self.bulge), fraction))

    def slope(self, fraction: Array) -> ComplexArray:
        """Return the derivative of the position with respect to the arc-length fraction, x + i z [m].

        Parameters
        ----------
        fraction : ndarray (...)
            Arc length from the start over the whole length, 0 to 1 [-].
        """
        return np.asarray(arc_slope(*self._ends, np.asarray(self.bulge), fraction))

    @property
    def _ends(self) -> tuple[ComplexArray, ComplexArray]:
        return np.asarray(complex(*self.start)), np.asarray(complex(*self.end))


def hanging_arc(chord: float, centre_distance: float, *, x: float = 0.0) -> Plate:
    """Return a skirt that hangs from the still water at ``x``, an upright chord with a circular arc towards +x.

    Parameters
    ----------
    chord : float
        Straight distance between the edges [m].
    centre_distance : float
        Distance s of the centre of the circle from the chord [m]: 0 gives a half circle, infinity a flat plate.
    x : float
        Place of both edges [m].

    Raises
    ------
    InputError
        When the chord is not positive or the distance negative.
    """
    if not (math.isfinite(chord) and chord > 0.0):
        raise InputError(f"chord is {chord:g} m", parameter="chord", allowed="greater than 0")
    if math.isnan(centre_distance) or centre_distance < 0.0:
        raise InputError(f"centre_distance is {centre_distance:g} m", parameter="centre_distance", allowed="0 or more")
    half_angle = math.atan2(0.5 * chord, centre_distance)
    return Plate((x, 0.0), (x, -chord), -math.tan(0.5 * half_angle))


def horizontal_motion(_points: Array, normals: Array) -> Array:
    """Normal velocity of a plate that moves along x with unit speed."""
    return normals[:, 0]


@dataclass(frozen=True, eq=False)
class PlateLimit:
    """Added mass and jumps at one of the limits of frequency."""

    #: The plate.
    plate: Plate
    #: M_ij per metre of structure [kg/m for translations]: force against mode i for unit acceleration of mode j; shape
    #: (modes, modes).
    added_mass: Array
    #: Places along the plate [m]; shape (n, 2).
    points: Array
    #: Arc-length fractions of the points; shape (n,).
    arc: Array
    #: Potential on the side of the normal minus that on the other side, for unit velocity [m2/s per m/s]; negative
    #: where the plate pushes water. The impulsive pressure difference is -rho times the jump times the speed. Shape (n,
    #: modes).
    jump: Array
    #: Where the impulse of each mode acts on the average [m]; shape (modes, 2).
    centre_of_pressure: Array


@checks_words
def solve_plate_limit(
    plate: Plate,
    water: Water,
    modes: Modes | Sequence[NormalVelocity] = (horizontal_motion,),
    *,
    frequency: Literal["infinite", "zero"] = "infinite",
    step: float = 0.3,
) -> PlateLimit:
    """Solve a thin plate at infinite frequency (impulsive motion, phi = 0 at z = 0) or at zero frequency.

    Images in surface and bed take the place of the waves [eq:potential-limit-infinite] [eq:potential-limit-zero].

    Parameters
    ----------
    plate : Plate
        Where the plate is.
    water : Water
        Depth (may be infinite), density.
    modes : Modes or sequence of callable
        Motions as for :func:`moyai.potential.solver.solve`, for instance :func:`moyai.potential.modes.rigid_modes`; or
        normal velocities of unit motion, each a function of points (n, 2) and unit normals (n, 2), for instance
        :func:`horizontal_motion`. One is enough.
    frequency : {"infinite", "zero"}
        Which limit.
    step : float
        Step of the quadrature; the error falls as exp(-pi^2 / step) until rounding stops it.

    Returns
    -------
    PlateLimit
        A flat plate has ten digits with the default step and some 160 unknowns, an arc that meets the still water at
        more than a degree eight, a half circle (which leaves it along itself) three.

    Raises
    ------
    InputError
        When the plate goes through the bed, stands on it at zero frequency, or a mode gives no finite velocity.

    Examples
    --------
    A plate that hangs 2 m deep far from the bed, 2 rho d^2 / pi at infinite and pi rho d^2 / 2 at zero frequency:

    >>> from moyai.potential import Plate, solve_plate_limit
    >>> from moyai.sea import Water
    >>> plate, water = Plate((0.0, 0.0), (0.0, -2.0)), Water(float("inf"), 1000.0, 9.81)
    >>> round(float(solve_plate_limit(plate, water).added_mass[0, 0]), 1)                        # [kg/m]
    2546.5
    >>> round(float(solve_plate_limit(plate, water, frequency="zero").added_mass[0, 0]), 1)
    6283.2
    """
    check_kind(plate, Plate, "plate", "give Plate(start, end)")
    check_water(water)
    velocities = _velocities_of(modes)
    stands = _stands_on_bed(plate, water)
    if frequency == "zero" and stands:
        raise InputError(
            "a plate that reaches the bed has no added mass at zero frequency",
            parameter="plate.end",
            allowed="clear of the bed",
            remedy="lift the end, or take a frequency",
        )
    if not 0.02 <= step <= 1.0:
        raise InputError(f"step is {step:g}", parameter="step", allowed="0.02 to 1")
    mirrored = 1 if frequency == "infinite" else -1
    if plate.pierces and plate.corner < _CUSP:
        # Nodes crowd there as the inverse of the distance: a wide step is fine enough elsewhere
        step = max(step, 0.45)
        coarse = _solve(plate, water, velocities, mirrored, stands, step, 2.0 * _CUT_CUSP)
        fine = _solve(plate, water, velocities, mirrored, stands, step, _CUT_CUSP)
        # The cut cusp costs in proportion to its length
        mass = 2.0 * fine.added_mass - coarse.added_mass
        return PlateLimit(plate, mass, fine.points, fine.arc, fine.jump, fine.centre_of_pressure)
    return _solve(plate, water, velocities, mirrored, stands, step, _CUT_SURFACE)


def _velocities_of(modes: Modes | Sequence[NormalVelocity]) -> Sequence[NormalVelocity]:
    """Return normal velocities, of the displacement fields where those are given."""
    if isinstance(modes, Modes):

        def along_normal(field: DisplacementField) -> NormalVelocity:
            return lambda points, normals: np.einsum("ij,ij->i", np.asarray(field(points), dtype=float), normals)

        return [along_normal(field) for field in modes.functions]
    found = modes if isinstance(modes, Sequence) else (modes,)
    for mode in found:
        if not callable(mode) or mode is cast(object, rigid_modes):
            raise InputError(
                f"{mode!r} is no motion",
                parameter="modes",
                allowed="rigid_modes(centre), other Modes, or functions of points and normals",
            )
    return found


def _stands_on_bed(plate: Plate, water: Water) -> bool:
    lowest = float(plate.position(np.linspace(0.0, 1.0, 401)).imag.min())
    clearance = water.depth + lowest
    if clearance < -1e-12 * plate.length or (clearance < 1e-9 * plate.length and plate.end[1] > lowest):
        raise InputError(
            f"the plate reaches down to z = {lowest:g} m in water {water.depth:g} m deep",
            parameter="plate",
            allowed="clear of the bed, or standing on it with its end",
            remedy="shorten the plate or take deeper water",
        )
    return clearance < 1e-9 * plate.length


def _solve(
    plate: Plate,
    water: Water,
    modes: Sequence[NormalVelocity],
    mirrored: int,
    stands: bool,
    step: float,
    surface_cut: float,
) -> PlateLimit:
    """Solve the equation of the stream function; ``mirrored`` is 1 where phi = 0 at z = 0, -1 where phi_z = 0."""
    cusp = plate.corner < _CUSP
    grid = plate_grid(
        0.0 if cusp else plate.corner,
        step,
        (surface_cut if plate.pierces else _CUT_EDGE, _CUT_BED if stands else _CUT_EDGE),
        ((_TAIL_CUSP if cusp else _TAIL) if plate.pierces else 1.0, 1e-4 * _TAIL if stands else 1.0),
    )
    # Places count from the start of the plate: far from the origin the edges would drown in rounding
    nodes, target = plate.offset(grid.fraction), plate.offset(grid.target)
    element = plate.slope(grid.fraction) * grid.weight
    influence = stream_influence(nodes, element, target, plate.start[1], water.depth, mirrored)
    matrix = with_tails(influence, grid, joined=stands)
    # At zero frequency the still water is a streamline, and the bed always is: the constant is known there
    known = (mirrored < 0 and plate.pierces) or stands
    flux = _flux_along(plate, grid, modes)
    if known:
        chosen = slice(None, -1) if stands else slice(1, None)
        datum = flux[-1] if stands else flux[0]
        jump = np.linalg.solve(matrix[chosen], -(flux[chosen] - datum))
    else:
        jump = np.linalg.solve(np.hstack([matrix, -np.ones((len(matrix), 1))]), -flux)[:-1]
    inside = slice(grid.first, grid.last)
    width = np.abs(element)
    velocity = _velocities(plate, grid.fraction, modes)
    mass = -water.density * with_tails((velocity * width[:, None]).T, grid, joined=stands) @ jump
    points = as_points(nodes) + np.array(plate.start)
    moments = [with_tails((points[:, axis] * width)[None, :], grid, joined=stands)[0] @ jump for axis in (0, 1)]
    total = with_tails(width[None, :], grid, joined=stands)[0] @ jump
    with np.errstate(invalid="ignore", divide="ignore"):
        centre = np.stack(moments, axis=1) / total[:, None]
    return PlateLimit(plate, mass, points[inside], grid.fraction[inside], jump, centre)


def stream_influence(
    nodes: ComplexArray, element: ComplexArray, target: ComplexArray, level: float, depth: float, mirrored: int
) -> Array:
    """Return the stream function at targets for unit jumps at nodes, with the mirror images [eq:plate-images].

    Parameters
    ----------
    nodes, element, target : ndarray of complex
        Places of the nodes, their line elements, places of the targets, all from an origin at z = ``level``.
    level : float
        z [m] of the origin.
    depth : float
        Water depth [m], may be infinite.
    mirrored : int
        1 where phi = 0 at z = 0, -1 where phi_z = 0.
    """

    def kernel(offset: ComplexArray) -> ComplexArray:
        if math.isinf(depth):
            return np.asarray(1.0 / offset)
        rate = 0.5 * math.pi / depth
        right = offset.real >= 0.0
        decay = np.exp(-rate * np.where(right, offset, -offset))
        square = decay * decay
        part = 2.0 * decay if mirrored > 0 else 1.0 + square
        return np.asarray(np.where(right, rate, -rate) * part / (1.0 - square))

    own = element * kernel(nodes - target[:, None])
    image = element * kernel(nodes - target.conj()[:, None] + 2j * level)
    return np.asarray(-(own + mirrored * image).real / (2.0 * math.pi))


def _velocities(plate: Plate, fraction: Array, modes: Sequence[NormalVelocity]) -> Array:
    """Normal velocities (n, modes) at arc-length fractions."""
    slope = plate.slope(fraction)
    normal = as_points(1j * slope / np.abs(slope))
    points = as_points(plate.position(fraction))
    out = np.empty((len(fraction), len(modes)))
    for number, mode in enumerate(modes):
        values = np.asarray(mode(points, normal), dtype=float)
        if values.shape != fraction.shape or not np.isfinite(values).all():
            raise InputError(
                f"mode {number} gives velocities of shape {values.shape} or not finite",
                parameter="modes",
                allowed=f"finite, shape {fraction.shape}",
            )
        out[:, number] = values
    return out


def _flux_along(plate: Plate, grid: PlateGrid, modes: Sequence[NormalVelocity]) -> Array:
    """Integral of the normal velocity from the start of the plate to every target, by Gauss's rule between them."""
    limits = np.concatenate([[0.0], grid.target])
    nodes, weights = np.polynomial.legendre.leggauss(8)
    half = 0.5 * np.diff(limits)
    places = limits[:-1, None] + half[:, None] * (1.0 + nodes)
    velocity = _velocities(plate, places.ravel(), modes).reshape(*places.shape, len(modes))
    parts = np.einsum("p,npm->nm", weights, velocity) * (half * plate.length)[:, None]
    return np.asarray(np.cumsum(parts, axis=0))
