"""From the case to the floating unit at one water level: lines in site axes, draught, mass, equilibrium, stiffness."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.remembered import Remembered, key_of_objects
from moyai.core.validity import Notice
from moyai.floating.statics import Hydrostatics, body_to_site, find_equilibrium, hydrostatics, inertia_matrix
from moyai.mooring.lines import Line, LineElement, SpringLine
from moyai.mooring.system import LineSystem, PlanarLineSystem
from moyai.potential.sections import Section
from moyai.sea.water import Water
from moyai.structures.breakwater.model import (
    Breakwater,
    BreakwaterProblem,
    Damping,
    Environment,
    MooringLine,
    MooringSpring,
)

IMBALANCE_LIMIT = 1.0  # per cent of the displacement above which the case is warned of (issue: over 1 % warned)
HEEL_LIMIT = math.radians(1.0)
_KNOWN: Remembered[FloatingUnit] = Remembered(64)


@dataclass(frozen=True)
class BodyFrameLines:
    """Lines about the centre of gravity of the unit, as the loops of :mod:`moyai.floating` ask for them."""

    #: Lines whose body origin is the centre of gravity at rest.
    planar: PlanarLineSystem

    def force(self, position: Array) -> Array:
        """Return (F_x, F_z, M_y) [N, N, N m] of all lines at a position relative to rest."""
        return self.planar.forces(np.asarray(position, dtype=float))

    def stiffness(self, position: Array) -> Array:
        """Return minus the derivative of :meth:`force`."""
        return self.planar.stiffness(np.asarray(position, dtype=float))


@dataclass(frozen=True)
class FloatingUnit:
    """The unit at rest at one water level, in a frame whose z = 0 is that level."""

    #: Name of the water level.
    name: str
    #: Elevation above datum [m].
    level: float
    #: With the depth at that level.
    water: Water
    breakwater: Breakwater
    #: Wetted section at rest.
    section: Section
    #: Draught at rest [m].
    draught: float
    #: Heel at rest [rad].
    heel: float
    #: Mass of the unit [kg].
    mass: float
    #: Centre of gravity (x, z) [m].
    centre: tuple[float, float]
    #: Shape (3, 3).
    inertia: Array
    statics: Hydrostatics
    #: With fairleads relative to the centre of gravity and anchors relative to it too.
    lines: tuple[LineElement, ...]
    mooring: BodyFrameLines
    #: Downward pull of all lines at rest [N].
    line_pull: float
    #: [%] of the displacement.
    imbalance: float
    notices: tuple[Notice, ...] = ()

    @property
    def freeboard(self) -> float:
        """Deck above still water at rest, upright [m]."""
        return self.breakwater.hull.bottom + self.breakwater.hull.height - self.draught

    @property
    def mooring_stiffness(self) -> Array:
        """Tangent stiffness of the lines at rest (3, 3)."""
        return self.mooring.stiffness(np.zeros(3))


def site_lines(
    breakwater: Breakwater, water: Water, centre: tuple[float, float], draught: float, heel: float
) -> tuple[LineElement, ...]:
    """Place the lines of the case for a unit at rest with its centre of gravity at ``centre`` [m].

    Line elements want the body origin at the origin of the site, so everything is counted from the centre of gravity.

    Raises
    ------
    InputError
        For lines to a bed that is infinitely deep.
    """
    return tuple(_place(line, breakwater, water, centre, draught, heel) for line in breakwater.lines)


def _place(
    line: MooringLine | MooringSpring,
    breakwater: Breakwater,
    water: Water,
    centre: tuple[float, float],
    draught: float,
    heel: float,
) -> LineElement:
    x, z = body_to_site((line.fairlead[0], line.fairlead[2]), draught, heel)
    fairlead = (x - centre[0], line.fairlead[1], z - centre[1])
    if isinstance(line, MooringSpring):
        anchor = (line.anchor[0] - centre[0], line.anchor[1], line.anchor[2] - centre[1])
        return SpringLine(
            line.name, anchor, fairlead, stiffness=line.stiffness, pretension=line.pretension, count=line.count
        )
    if math.isinf(water.depth):
        raise InputError(
            f"line {line.name!r} goes to a bed in infinite water depth",
            parameter=f"lines.{line.name}",
            remedy="give the water depth, or use springs to fixed points",
        )
    anchor = (line.anchor[0] - centre[0], line.anchor[1], line.anchor[2] - water.depth - centre[1])
    return Line(
        line.name,
        anchor,
        fairlead,
        segments=line.segments,
        clumps=line.clumps,
        bed_friction=line.bed_friction,
        count=line.count,
    )


def _system(lines: tuple[LineElement, ...], water: Water, centre: tuple[float, float]) -> PlanarLineSystem:
    # The bed of the lines lies below the centre of gravity, the origin of their frame
    return LineSystem(lines, water.depth + centre[1]).planar()


def _vertical_pull(breakwater: Breakwater, water: Water, draught: float) -> float:
    """Downward pull of all lines on the upright unit at a draught [N]."""
    if not breakwater.lines:
        return 0.0
    centre = body_to_site(breakwater.centre_of_gravity, draught, 0.0)
    lines = site_lines(breakwater, water, centre, draught, 0.0)
    return -float(_system(lines, water, centre).forces(np.zeros(3))[1])


@dataclass(frozen=True)
class _Balance:
    """What the reference level fixes for all levels: mass, and the force that a given mass and draught leave over."""

    mass: float
    leftover: float
    draught: float | None


def _reference_balance(breakwater: Breakwater, water: Water) -> _Balance:
    """Find the mass from the draught, or keep both and the difference between them [eq:breakwater-balance]."""
    if breakwater.draught is None:
        if breakwater.mass is None:
            raise InputError("neither mass nor draught is given", parameter="draught")
        return _Balance(breakwater.mass, 0.0, None)
    section = breakwater.hull.immersed(breakwater.draught)
    displaced = water.density * section.area * breakwater.length
    pull = _vertical_pull(breakwater, water, breakwater.draught)
    if breakwater.mass is None:
        mass = displaced - pull / water.gravity
        if mass <= 0.0:
            raise InputError(
                f"the lines pull {pull:.4g} N down, more than the displacement {displaced * water.gravity:.4g} N at a "
                f"draught of {breakwater.draught:g} m",
                parameter="draught",
                remedy="use lighter or longer lines, or a larger draught",
            )
        return _Balance(mass, 0.0, breakwater.draught)
    return _Balance(breakwater.mass, (breakwater.mass - displaced) * water.gravity + pull, breakwater.draught)


def _least_draught(breakwater: Breakwater, mass: float, density: float) -> float:
    """First guess of the draught: upright, without lines, by bisection on the displaced mass.

    Raises
    ------
    InputError
        When the body sinks.
    """
    hull = breakwater.hull
    high = hull.bottom + hull.height

    def displaced(draught: float) -> float:
        try:
            return density * hull.immersed(draught).area * breakwater.length
        except InputError:
            return 0.0

    whole = displaced(high * (1.0 - 1e-9))
    if mass >= whole:
        raise InputError(
            f"the unit weighs {mass:.5g} kg and displaces {whole:.5g} kg when it is wholly under water: it sinks",
            parameter="mass",
            allowed=f"below {whole:.5g} kg",
            remedy="lower the mass or enlarge the section",
        )
    low = hull.bottom
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if displaced(middle) < mass else (low, middle)
    return 0.5 * (low + high)


def assemble(problem: BreakwaterProblem, level_name: str, level: float) -> FloatingUnit:
    """Put the unit into the water of one level and find its equilibrium.

    Parameters
    ----------
    problem : BreakwaterProblem
    level_name : str
    level : float
        [m] above datum.

    Returns
    -------
    FloatingUnit

    Raises
    ------
    InputError
        When the body reaches the bed, sinks, or a line cannot be placed.

    Notes
    -----
    Units that differ only in what moves or damps them share one search.
    """
    breakwater, environment = problem.breakwater, problem.environment
    still = replace(breakwater, damping=Damping(), roll_gyradius=1.0, additional_mass=(0.0, 0.0, 0.0))
    key = key_of_objects(still, environment.water, environment.water_levels[0], level_name, level)
    unit = _KNOWN.of(key, lambda: _assembled(still, environment, level_name, level))
    inertia = inertia_matrix(unit.mass, breakwater.roll_gyradius, breakwater.additional_mass)
    return replace(unit, breakwater=breakwater, inertia=inertia)


def at_level(breakwater: Breakwater, level: float) -> Breakwater:
    """Return the breakwater with the fixed ends of springs counted from the still water of a level above datum [m].

    Parameters
    ----------
    breakwater : Breakwater
        As the case gives it, from still water at datum.
    level : float
        [m] above datum.
    """
    if level == 0.0 or not any(isinstance(line, MooringSpring) for line in breakwater.lines):
        return breakwater
    lines = tuple(
        replace(line, anchor=(line.anchor[0], line.anchor[1], line.anchor[2] - level))
        if isinstance(line, MooringSpring)
        else line
        for line in breakwater.lines
    )
    return replace(breakwater, lines=lines)


def _assembled(breakwater: Breakwater, environment: Environment, level_name: str, level: float) -> FloatingUnit:
    water, zero = _checked_water(environment, level_name, level), environment.water_levels[0][1]
    balance = _reference_balance(at_level(breakwater, zero), environment.water_at(zero))
    breakwater = at_level(breakwater, level)
    at_reference = level_name == environment.water_levels[0][0]
    start = balance.draught
    if start is None:
        start = _least_draught(breakwater, balance.mass, water.density)
    if at_reference and balance.draught is not None and _is_balanced_upright(breakwater, water, balance):
        draught, heel, offset = balance.draught, 0.0, 0.0
    else:
        draught, heel, offset = _equilibrium(breakwater, water, balance, start)
    _check_clearance(breakwater, water, level_name, draught)
    section = breakwater.hull.immersed(draught, heel)
    # The unit may stand a little aside at rest; anchors are counted from there
    centre = body_to_site(breakwater.centre_of_gravity, draught, heel)
    lines = site_lines(_shifted(breakwater, offset), water, centre, draught, heel)
    mooring = BodyFrameLines(_system(lines, water, centre))
    pull = -float(mooring.force(np.zeros(3))[1]) if lines else 0.0
    statics = hydrostatics(
        section,
        mass=balance.mass,
        centre_of_gravity=centre,
        length=breakwater.length,
        density=water.density,
        gravity=water.gravity,
    )
    imbalance = statics.imbalance(pull, gravity=water.gravity)
    imbalance = imbalance if abs(imbalance) > 1e-6 else 0.0
    unit = FloatingUnit(
        name=level_name,
        level=level,
        water=water,
        breakwater=breakwater,
        section=section,
        draught=draught,
        heel=heel,
        mass=balance.mass,
        centre=centre,
        inertia=inertia_matrix(balance.mass, breakwater.roll_gyradius, breakwater.additional_mass),
        statics=statics,
        lines=lines,
        mooring=mooring,
        line_pull=pull,
        imbalance=imbalance,
    )
    return replace(unit, notices=_notices(unit))


def _checked_water(environment: Environment, name: str, level: float) -> Water:
    if not math.isinf(environment.water.depth) and environment.water.depth + level <= 0.0:
        raise InputError(
            f"level {name} ({level:g} m) leaves no water over the bed at {-environment.water.depth:g} m",
            parameter=f"water_levels.{name}",
            allowed=f"above {-environment.water.depth:g} m",
        )
    return environment.water_at(level)


def _check_clearance(breakwater: Breakwater, water: Water, name: str, draught: float) -> None:
    if draught >= water.depth:
        raise InputError(
            f"the draught of {draught:.4g} m reaches the bed at {name} (depth {water.depth:.4g} m)",
            parameter="draught",
            allowed=f"below {water.depth:.4g} m",
            remedy="lower the draught or the mass",
        )


def _is_balanced_upright(breakwater: Breakwater, water: Water, balance: _Balance) -> bool:
    """Whether the unit rests upright at the given draught: no moment and no sideways pull left."""
    if balance.draught is None:
        return False
    draught = balance.draught
    centre = body_to_site(breakwater.centre_of_gravity, draught, 0.0)
    section = breakwater.hull.immersed(draught)
    buoyancy = water.density * water.gravity * section.area * breakwater.length
    moment = -buoyancy * (section.centroid[0] - centre[0])
    sideways = 0.0
    if breakwater.lines:
        lines = site_lines(breakwater, water, centre, draught, 0.0)
        force = _system(lines, water, centre).forces(np.zeros(3))
        sideways, moment = float(force[0]), moment + float(force[2])
    size = max(section.waterplane_breadth, draught)
    return abs(moment) <= 1e-9 * buoyancy * size and abs(sideways) <= 1e-9 * buoyancy


def _equilibrium(breakwater: Breakwater, water: Water, balance: _Balance, start: float) -> tuple[float, float, float]:
    """Find draught, heel and offset at rest."""
    upright = body_to_site(breakwater.centre_of_gravity, start, 0.0)
    moored: PlanarLineSystem | None = None
    if breakwater.lines and all(isinstance(line, MooringLine) for line in breakwater.lines):
        moored = _system(site_lines(breakwater, water, upright, start, 0.0), water, upright)

    def pull(x: float, z: float, heel: float) -> tuple[float, float, float]:
        if moored is not None:
            force = moored.forces(np.array([x - upright[0], z - upright[1], heel]))
            return float(force[0]), float(force[1]) + balance.leftover, float(force[2])
        # a spring has its pretension wherever the unit is at rest
        draught = _draught_of(breakwater, z, heel)
        body_x = x - body_to_site(breakwater.centre_of_gravity, draught, heel)[0]
        centre = body_to_site(breakwater.centre_of_gravity, draught, heel)
        lines = site_lines(_shifted(breakwater, body_x), water, centre, draught, heel)
        force = _system(lines, water, centre).forces(np.zeros(3))
        return float(force[0]), float(force[1]) + balance.leftover, float(force[2])

    def leftover(x: float, z: float, heel: float) -> tuple[float, float, float]:
        return 0.0, balance.leftover, 0.0

    try:
        found = find_equilibrium(
            breakwater.hull,
            mass=balance.mass,
            centre_of_gravity=breakwater.centre_of_gravity,
            length=breakwater.length,
            density=water.density,
            gravity=water.gravity,
            draught_start=start,
            line_pull=pull if breakwater.lines else leftover,
            free=(bool(breakwater.lines), True, True),
        )
    except ConvergenceError as error:
        raise InputError(
            f"the unit finds no equilibrium: {error.fault.message}", parameter="breakwater", remedy=error.fault.remedy
        ) from error
    # What is left of a Newton search is no heel and no offset
    heel = found.heel if abs(found.heel) > 1e-9 else 0.0
    size = breakwater.hull.beam
    return found.draught, heel, found.offset if abs(found.offset) > 1e-9 * size else 0.0


def _draught_of(breakwater: Breakwater, z_gravity: float, heel: float) -> float:
    """Return the draught at which the centre of gravity stands at z [m]."""
    return body_to_site(breakwater.centre_of_gravity, 0.0, heel)[1] - z_gravity


def _shifted(breakwater: Breakwater, offset: float) -> Breakwater:
    """Return the breakwater with its anchors moved so that a body at ``offset`` [m] stands at x = 0."""
    if offset == 0.0:
        return breakwater
    moved = tuple(
        replace(line, anchor=(line.anchor[0] - offset, line.anchor[1], line.anchor[2])) for line in breakwater.lines
    )
    return replace(breakwater, lines=moved)


def _notices(unit: FloatingUnit) -> tuple[Notice, ...]:
    notices = []
    if abs(unit.imbalance) > IMBALANCE_LIMIT:
        notices.append(
            Notice(
                "imbalance",
                f"{unit.name}: displacement, weight and line pull differ by {unit.imbalance:+.2f} % of the first",
                value=abs(unit.imbalance),
                limit=IMBALANCE_LIMIT,
                remedy="give mass or draught alone, or correct one of them",
            )
        )
    if abs(unit.heel) > HEEL_LIMIT:
        notices.append(
            Notice(
                "heel-at-rest",
                f"{unit.name}: the unit rests with a heel of {math.degrees(unit.heel):.2f} degrees",
                value=abs(unit.heel),
                limit=HEEL_LIMIT,
                remedy="trim the ballast or the lines",
                unit="rad",
            )
        )
    if unit.statics.metacentric_height <= 0.0:
        notices.append(
            Notice(
                "unstable",
                f"{unit.name}: the metacentric height is {unit.statics.metacentric_height:.3g} m; the unit capsizes "
                "unless the lines hold it",
                value=unit.statics.metacentric_height,
                limit=0.0,
                severity="error",
                remedy="lower the centre of gravity or widen the section",
            )
        )
    if unit.freeboard <= 0.0:
        notices.append(
            Notice(
                "freeboard", f"{unit.name}: the deck is {-unit.freeboard:.3g} m under still water", unit.freeboard, 0.0
            )
        )
    return tuple(notices)
