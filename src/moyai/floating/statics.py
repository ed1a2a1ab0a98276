"""Statics of a floating section: restoring, metacentric height, equilibrium with lines, righting curve.

Sections are taken from :mod:`moyai.potential.sections` by their attributes ``area``, ``centroid`` and ``waterlines``
(per metre of structure, z = 0 at the still water); results are of the whole unit, length included.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Protocol, runtime_checkable

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import check_kind, checks_words
from moyai.floating.arrays import positive


@runtime_checkable
class SectionLike(Protocol):
    """What statics need of an immersed section."""

    @property
    def area(self) -> float:
        """Displaced area [m2]."""

    @property
    def centroid(self) -> tuple[float, float]:
        """Centre of buoyancy (x, z) [m]."""

    @property
    def waterlines(self) -> tuple[tuple[float, float], ...]:
        """Left and right x [m] of each cut with the still water."""


@runtime_checkable
class HullLike(Protocol):
    """What statics need of a hull."""

    def immersed(self, draught: float, heel: float = 0.0) -> SectionLike:
        """Return the section at a depth of the keel origin [m], turned about it by ``heel`` [rad].

        Parameters
        ----------
        draught : float
            Depth of the keel origin under still water [m].
        heel : float
            Turn about the keel origin [rad].
        """


_OWN_FRAME = "give the hull in its own frame, before it is set into the water"
LinePull = Callable[[float, float, float], "tuple[float, float, float]"]
"""Force of all lines (F_x, F_z, moment about the centre of gravity; N, N, N m) on the unit whose centre of gravity
is at x, z [m] with heel [rad]."""


@dataclass(frozen=True)
class Hydrostatics:
    """Weight, buoyancy and restoring of one position."""

    #: Restoring of buoyancy and weight about ``centre`` in sway, heave, roll [N/m, N, N m] [eq:floating-hydrostatic];
    #: shape (3, 3).
    stiffness: Array
    #: Mass of the displaced water, rho A l [kg].
    displaced_mass: float
    #: Mass of the body [kg].
    mass: float
    #: Centre of gravity (x, z) of the site frame [m].
    centre: tuple[float, float]
    #: (x, z) [m].
    centre_of_buoyancy: tuple[float, float]
    #: GM [m] [eq:floating-metacentre].
    metacentric_height: float
    #: Breadth of all waterlines times length [m2].
    waterplane_area: float
    #: Displacement less weight [N]: what lines may pull down.
    reserve: float

    def imbalance(self, vertical_pull: float = 0.0, *, gravity: float) -> float:
        """Return displacement less weight and downward line pull [N], in per cent of the displacement.

        Parameters
        ----------
        vertical_pull : float
            Of all lines, positive downwards [N].
        gravity : float
            [m/s2].
        """
        displacement = self.displaced_mass * gravity
        return 100.0 * (self.reserve - vertical_pull) / displacement


def hydrostatics(
    section: SectionLike,
    *,
    mass: float,
    centre_of_gravity: tuple[float, float],
    length: float,
    density: float,
    gravity: float,
) -> Hydrostatics:
    """Return the linear restoring of a section about its centre of gravity.

    Parameters
    ----------
    section : SectionLike
        Immersed section, z = 0 at the still water.
    mass : float
        Mass of the unit [kg].
    centre_of_gravity : tuple of float
        (x, z) in the frame of the site [m].
    length : float
        Length of the unit [m].
    density, gravity : float
        Of the water [kg/m3], [m/s2].

    Returns
    -------
    Hydrostatics
        Totals of the unit.

    Raises
    ------
    InputError
        For a mass or length that is not positive, and for what is no section.

    Notes
    -----
    Implements [eq:floating-hydrostatic] and [eq:floating-metacentre]. Buoyancy, not weight, carries the lever of the
    centre of buoyancy; the weight acts at the centre of the modes and adds nothing. The part of the buoyancy that lines
    hold down acts through the geometric stiffness of those lines, which belongs to the mooring stiffness.

    Examples
    --------
    >>> from moyai.floating import hydrostatics
    >>> from moyai.potential import shapes
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> still = hydrostatics(
    ...     section, mass=82000.0, centre_of_gravity=(0.0, -0.2), length=20.0, density=1025.0, gravity=9.81
    ... )
    >>> round(still.metacentric_height, 3)                           # KB + BM - KG = 0.5 + 4^2 / 12 - 0.8 [m]
    1.033
    """
    check_kind(section, SectionLike, "section", "set a hull into the water: hull.immersed(draught=...)")
    positive(mass, "mass")
    positive(length, "length")
    x_centre, z_centre = centre_of_gravity
    edges = np.asarray(section.waterlines, dtype=float).reshape(-1, 2) - x_centre
    breadth = float(np.sum(edges[:, 1] - edges[:, 0]))
    first = float(np.sum(edges[:, 1] ** 2 - edges[:, 0] ** 2)) / 2.0
    second = float(np.sum(edges[:, 1] ** 3 - edges[:, 0] ** 3)) / 3.0
    area = float(section.area)
    x_buoyancy, z_buoyancy = section.centroid
    unit_weight = density * gravity * length
    lever = second + area * (z_buoyancy - z_centre)
    stiffness = unit_weight * np.array([[0.0, 0.0, 0.0], [0.0, breadth, -first], [0.0, -first, lever]])
    displaced = density * area * length
    return Hydrostatics(
        stiffness=stiffness,
        displaced_mass=displaced,
        mass=float(mass),
        centre=(float(x_centre), float(z_centre)),
        centre_of_buoyancy=(float(x_buoyancy), float(z_buoyancy)),
        metacentric_height=lever / area,
        waterplane_area=breadth * length,
        reserve=(displaced - mass) * gravity,
    )


def inertia_matrix(
    mass: float, roll_gyradius: float, additional_mass: tuple[float, float, float] = (0.0, 0.0, 0.0)
) -> Array:
    """Return the planar inertia matrix about the centre of gravity [kg, kg, kg m2].

    Parameters
    ----------
    mass : float
        Mass of the unit [kg].
    roll_gyradius : float
        Radius of gyration about the centre of gravity [m].
    additional_mass : tuple of float
        Mass that moves in one mode only, for instance the rig of a model test [kg, kg, kg m2].

    Returns
    -------
    ndarray, shape (3, 3)
        Sway, heave, roll on the diagonal [kg, kg, kg m2].

    Raises
    ------
    InputError
        For a mass or gyradius that is not positive.

    Examples
    --------
    >>> from moyai.floating import inertia_matrix
    >>> inertia_matrix(82000.0, roll_gyradius=1.3).diagonal().round().tolist()   # [kg], [kg], [kg m2]
    [82000.0, 82000.0, 138580.0]
    """
    positive(mass, "mass")
    positive(roll_gyradius, "roll_gyradius")
    return np.diag([mass, mass, mass * roll_gyradius**2]) + np.diag(np.asarray(additional_mass, dtype=float))


@dataclass(frozen=True)
class FloatingEquilibrium:
    """A position at rest: draught and heel of the hull, and what is left of the balance."""

    #: Depth of the origin of the body frame [m].
    draught: float
    #: Turn about it [rad].
    heel: float
    #: x [m] of that origin.
    offset: float
    #: (x, z) of the site frame [m].
    centre_of_gravity: tuple[float, float]
    #: Immersed section at that position, drawn with its body origin at x = 0.
    section: SectionLike
    #: Largest remaining force or moment, in parts of the displacement (moment: times the waterline breadth).
    residual: float
    iterations: int


def body_to_site(point: tuple[float, float], draught: float, heel: float, offset: float = 0.0) -> tuple[float, float]:
    """Return a point of the body frame (x, z above keel) [m] in the frame of the site."""
    cosine, sine = math.cos(heel), math.sin(heel)
    return offset + point[0] * cosine + point[1] * sine, -draught - point[0] * sine + point[1] * cosine


@checks_words
def find_equilibrium(
    hull: HullLike,
    *,
    mass: float,
    centre_of_gravity: tuple[float, float],
    length: float,
    density: float,
    gravity: float,
    draught_start: float,
    line_pull: LinePull | None = None,
    free: tuple[bool, bool, bool] | None = None,
    tolerance: float = 1e-11,
    maximum_iterations: int = 80,
) -> FloatingEquilibrium:
    """Find draught, heel and (with lines) offset where weight, buoyancy and lines balance [eq:floating-equilibrium].

    Parameters
    ----------
    hull : HullLike
        Outlines of the body frame.
    mass : float
        Mass of the unit [kg].
    centre_of_gravity : tuple of float
        x from the centre line and z above the keel, body frame [m].
    length, density, gravity : float
        Length of the unit [m], water density [kg/m3], gravity [m/s2].
    draught_start : float
        First guess [m].
    line_pull : callable or None
        ``(x, z, heel) -> (F_x, F_z, moment)`` of all lines; ``None`` for none.
    free : tuple of bool or None
        Whether offset, draught and heel may change; offset only with lines by default.
    tolerance : float
        On the residual in parts of the displacement.
    maximum_iterations : int
        Steps of Newton's method at most.

    Returns
    -------
    FloatingEquilibrium
        Draught [m], heel [rad], offset [m], the immersed section and what is left of the balance.

    Raises
    ------
    InputError
        For a mass that is not positive, a hull that is not in the water at its first draught, and what is no hull.
    ConvergenceError
        When no position balances, with the residual; for instance a body heavier than its hull can displace.

    Notes
    -----
    Newton's method on the exact immersed geometry with a tangent by central differences, updated by Broyden's rule as
    long as the residual falls tenfold, and a step that is halved until it falls.

    Examples
    --------
    >>> from moyai.floating import find_equilibrium
    >>> from moyai.potential import shapes
    >>> found = find_equilibrium(
    ...     shapes.rectangle(beam=4.0, height=2.0), mass=82000.0, centre_of_gravity=(0.0, 0.8), length=20.0,
    ...     density=1025.0, gravity=9.81, draught_start=0.8,
    ... )
    >>> round(found.draught, 6), abs(found.heel) < 1e-9                  # [m], upright
    (1.0, True)
    """
    check_kind(hull, HullLike, "hull", _OWN_FRAME)
    positive(mass, "mass")
    weight = mass * gravity
    if free is None:
        free = (line_pull is not None, True, True)
    active = np.flatnonzero(free)
    state = np.array([0.0, draught_start, 0.0])
    breadth = _scale_of(hull, draught_start)
    scale = np.array([weight, weight, weight * breadth])

    @cache
    def displaced(draught: float, heel: float) -> tuple[float, float]:
        section = _immersed_or_none(hull, draught, heel)
        return (0.0, 0.0) if section is None else (section.area, section.centroid[0])

    def residual(position: Array) -> Array:
        offset, draught, heel = position.tolist()
        x_gravity, z_gravity = body_to_site(centre_of_gravity, draught, heel, offset)
        lines = (0.0, 0.0, 0.0) if line_pull is None else line_pull(x_gravity, z_gravity, heel)
        area, centre = displaced(draught, heel)
        x_buoyancy = centre + offset
        buoyancy = density * gravity * area * length
        # Positive roll carries a point on the +x side down, so an upward force there turns the body back
        values: Array = (
            np.array([lines[0], lines[1] + buoyancy - weight, lines[2] - buoyancy * (x_buoyancy - x_gravity)]) / scale
        )
        return values

    value = residual(state)
    iterations = 0
    tangent: Array | None = None
    steps = np.array([breadth, breadth, 1.0]) * 1e-6
    while float(np.max(np.abs(value[active]))) > tolerance and iterations < maximum_iterations:
        iterations += 1
        known = tangent is not None
        if tangent is None:
            tangent = np.empty((active.size, active.size))
            for column, dof in enumerate(active):
                ahead, behind = state.copy(), state.copy()
                ahead[dof] += steps[dof]
                behind[dof] -= steps[dof]
                tangent[:, column] = (residual(ahead) - residual(behind))[active] / (2.0 * steps[dof])
        step = -np.linalg.lstsq(tangent, value[active], rcond=None)[0]
        limit = np.array([0.5 * breadth, 0.5 * breadth, 0.3])[active]
        step /= max(1.0, float(np.max(np.abs(step) / limit)))
        accepted = False
        for halving in range(30):
            trial = state.copy()
            trial[active] += step / 2.0**halving
            trial_value = residual(trial)
            if np.linalg.norm(trial_value[active]) < np.linalg.norm(value[active]):
                moved, turned = (trial - state)[active], (trial_value - value)[active]
                good = halving == 0 and np.linalg.norm(trial_value[active]) < 0.1 * np.linalg.norm(value[active])
                # a step that did what the tangent said corrects it; any other requires a new one
                tangent = tangent + np.outer(turned - tangent @ moved, moved) / (moved @ moved) if good else None
                state, value, accepted = trial, trial_value, True
                break
        if not accepted:
            if not known:
                break
            tangent = None
    left = float(np.max(np.abs(value[active])))
    # Differences of the residual end at rounding: a stalled search below 1e-9 of the weight is an equilibrium
    if left > max(tolerance, 1e-9) or _immersed_or_none(hull, state[1], state[2]) is None:
        raise ConvergenceError(
            f"no position balances weight, buoyancy and lines: residual {left:.3g} of the weight at a draught of "
            f"{state[1]:.4g} m and a heel of {math.degrees(state[2]):.3g} deg",
            remedy="compare the mass with the full displacement, and the centre of gravity with the metacentre",
        )
    offset, draught, heel = (float(item) for item in state)
    return FloatingEquilibrium(
        draught=draught,
        heel=heel,
        offset=offset,
        centre_of_gravity=body_to_site(centre_of_gravity, draught, heel, offset),
        section=hull.immersed(draught, heel),
        residual=left,
        iterations=iterations,
    )


def _immersed_or_none(hull: HullLike, draught: float, heel: float) -> SectionLike | None:
    """Return the section, or ``None`` for a hull that does not reach the water."""
    try:
        return hull.immersed(draught, heel)
    except InputError:
        return None


def _scale_of(hull: HullLike, draught: float) -> float:
    """Return a length for scaling: breadth of the outer waterline, or the root of the area of a submerged body."""
    section = _immersed_or_none(hull, draught, 0.0)
    if section is None:
        raise InputError(f"the hull does not reach the water at a draught of {draught:g} m", parameter="draught_start")
    if section.waterlines:
        return section.waterlines[-1][1] - section.waterlines[0][0]
    return math.sqrt(section.area)


@dataclass(frozen=True)
class RightingCurve:
    """Righting lever against heel at constant displacement."""

    #: [rad]; shape (n,).
    heel: Array
    #: GZ [m], positive when it turns the body back from a positive heel; NaN where the displacement cannot be reached;
    #: shape (n,).
    lever: Array
    #: Depth of the body origin that keeps the displacement [m]; shape (n,).
    draught: Array


def righting_curve(
    hull: HullLike,
    heel: Array,
    *,
    area: float,
    centre_of_gravity: tuple[float, float],
    draught_start: float,
    tolerance: float = 1e-12,
) -> RightingCurve:
    """Return GZ of the free body for finite heel by exact immersed geometry [eq:floating-righting].

    Parameters
    ----------
    hull : HullLike
        Outlines of the body frame.
    heel : ndarray
        Angles [rad], top towards +x.
    area : float
        Displaced area [m2] that is kept.
    centre_of_gravity : tuple of float
        Body frame, x and z above the keel [m].
    draught_start : float
        Draught of the upright body [m].
    tolerance : float
        On the displaced area, relative.

    Returns
    -------
    RightingCurve
        Heel [rad], lever GZ [m] and draught [m]; lever and draught are NaN where the hull cannot displace the area.

    Raises
    ------
    InputError
        For a hull that is not in the water at its first draught, and for what is no hull.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import righting_curve
    >>> from moyai.potential import shapes
    >>> hull = shapes.rectangle(beam=4.0, height=2.0)
    >>> curve = righting_curve(hull, np.array([0.0, 0.1]), area=4.0, centre_of_gravity=(0.0, 0.8), draught_start=1.0)
    >>> curve.lever.round(4).tolist()                                    # near GM sin(heel), GM = 1.033 m [m]
    [0.0, 0.1038]
    """
    check_kind(hull, HullLike, "hull", _OWN_FRAME)
    angles = np.atleast_1d(np.asarray(heel, dtype=float))
    lever, draughts = np.full(angles.shape, np.nan), np.full(angles.shape, np.nan)
    reach = 2.0 * _scale_of(hull, draught_start) + 2.0 * abs(draught_start)
    for index, angle in enumerate(angles):

        def displaced(draught: float, angle: float = float(angle)) -> float:
            section = _immersed_or_none(hull, draught, angle)
            return 0.0 if section is None else section.area

        low, high = draught_start - reach, draught_start + reach
        if displaced(high) < area * (1.0 - 1e-9):
            continue
        # Bisection first (the area is monotonic in the draught but not smooth at deck edges), secant steps inside it
        for _ in range(200):
            middle = 0.5 * (low + high)
            if displaced(middle) < area:
                low = middle
            else:
                high = middle
            if high - low < tolerance * reach:
                break
        draughts[index] = 0.5 * (low + high)
        section = hull.immersed(float(draughts[index]), float(angle))
        x_gravity, _ = body_to_site(centre_of_gravity, float(draughts[index]), float(angle))
        lever[index] = section.centroid[0] - x_gravity
    return RightingCurve(heel=angles, lever=lever, draught=draughts)
