"""The rigid cage at rest: floating freely, pulled down by its lines, in a current."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water, check_water
from moyai.structures.cage.rigid import load_kernel, march_kernel
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.parts import RigidCage
from moyai.structures.cage.rigid.water_kernel import PackedCage

#: Largest step of Newton's method: share of the size of the cage, and radians
_LARGEST_MOVE = 0.05


@dataclass(frozen=True, eq=False)
class RigidCageEquilibrium:
    """A position of rest."""

    #: x of the centre of gravity [m].
    x: float
    #: Centre of gravity above still water [m].
    z: float
    #: Rotation [rad].
    theta: float
    #: At the attachment [N]; shape (lines,).
    tension: Array
    #: Share of the volume of the floats under water [-].
    immersion: float
    #: Largest unbalanced force over the weight in air [-].
    residual: float
    #: -d(force)/d(x, z, theta) [N/m], [N], [N m/rad]; shape (3, 3).
    stiffness: Array
    #: Middle of the cage above still water [m].
    middle_z: float

    @property
    def place(self) -> Array:
        """x, z [m], theta [rad], (3,)."""
        return np.array([self.x, self.z, self.theta])


def force_at(packed: PackedCage, place: Array) -> Array:
    """Return the generalised force on the cage held at a place in still or flowing water [N], [N m]."""
    force, mass, work = np.empty(3), np.empty((3, 3)), np.empty(6)
    taut = np.full(len(packed.lines), -1.0)
    state = np.concatenate([place, np.zeros(3)])
    load_kernel.loads(packed, 0.0, state, taut, force, mass, work)
    return force


def stiffness_at(packed: PackedCage, place: Array, size: float) -> Array:
    """Return -d(force)/d(place): lines by their formulas, which bend where they go slack, the rest by differences."""
    bare = packed._replace(lines=packed.lines[:0].copy())
    out = np.empty((3, 3))
    for column, step in enumerate((1e-6 * size, 1e-6 * size, 1e-6)):
        shift = np.zeros(3)
        shift[column] = step
        out[:, column] = -(force_at(bare, place + shift) - force_at(bare, place - shift)) / (2.0 * step)
    for line in packed.lines:
        out += line_stiffness_at(line, place)
    return out


def line_stiffness_at(line: Array, place: Array) -> Array:
    """Return the elastic and geometric stiffness of a taut line, zero of a slack one [eq:cage-line-stiffness]."""
    cosine, sine = math.cos(place[2]), math.sin(place[2])
    arm = np.array([cosine * line[0] + sine * line[1], -sine * line[0] + cosine * line[1]])
    away = place[:2] + arm - line[2:4]
    span = float(np.hypot(*away))
    stretch = span - line[4]
    if stretch <= 0.0:
        return np.zeros((3, 3))
    # rows x, z of the attachment by (x, z, rotation)
    turn = np.array([[1.0, 0.0, arm[1]], [0.0, 1.0, -arm[0]]])
    unit = away / span
    growth = unit @ turn
    across = turn.T @ (np.eye(2) - np.outer(unit, unit)) @ turn / span
    across[2, 2] -= float(unit @ arm)
    return np.asarray(line[5] * (np.outer(growth, growth) + stretch * across))


def immersion(cage: RigidCage, place: Array) -> float:
    """Return the share of the floats' volume under still water for a place of the centre of gravity."""
    x, z = cage.centre
    cosine, sine = math.cos(place[2]), math.sin(place[2])
    arm = cage.floats.points[:, [0, 2]] - np.array([x, z])
    level = place[1] - sine * arm[:, 0] + cosine * arm[:, 1]
    radius = 0.5 * cage.floats.diameter
    high = np.clip(radius - level, 0.0, 2.0 * radius)
    volume = math.pi * high**2 * (radius - high / 3.0)
    return float(volume.mean() / cage.floats.volume)


def size_of(cage: RigidCage) -> float:
    """Return the length that scales motions [m]."""
    return max(cage.extent)


def reserve_buoyancy(cage: RigidCage, water: Water) -> float:
    """Return what the floats carry beyond the rest of the cage when all is under water [N]."""
    displaced = cage.float_volume + cage.solid_volume
    return water.gravity * (water.density * displaced - cage.mass)


def submerged_weight(cage: RigidCage, water: Water) -> float:
    """Return the weight in water of net, frame and weights, floats left out [N]."""
    return water.gravity * (cage.mass_without_floats - water.density * cage.solid_volume)


def require_floating(cage: RigidCage, water: Water) -> None:
    """Refuse a cage that sinks.

    Raises
    ------
    InputError
        With the weight in water and what the floats carry.
    """
    reserve = reserve_buoyancy(cage, water)
    if reserve > 0.0:
        return
    weight = submerged_weight(cage, water)
    net_lift = reserve + weight
    per_float = water.gravity * (water.density * cage.floats.volume - cage.floats.mass)
    more = math.ceil(weight / per_float) if per_float > 0.0 else 0
    remedy = f"it takes {more} such floats" if more else "floats must be lighter than the water they displace"
    raise InputError(
        f"the cage does not float: it weighs {weight:.4g} N in water, and its {len(cage.floats.points)} floats carry "
        f"{max(net_lift, 0.0):.4g} N beyond their own weight",
        parameter="floats",
        allowed="floats with more buoyancy than the cage weighs in water",
        remedy=remedy,
    )


def _newton(packed: PackedCage, place: Array, size: float, held: tuple[int, ...], weight: float) -> tuple[Array, float]:
    """Newton's method for zero force in the free directions, with bounded moves."""
    free = [i for i in range(3) if i not in held]
    scale = np.array([weight, weight, weight * size])
    reach = np.array([_LARGEST_MOVE * size, _LARGEST_MOVE * size, _LARGEST_MOVE])
    best = math.inf
    for _ in range(200):
        force = force_at(packed, place)
        error = float(np.abs(force / scale)[free].max())
        best = min(best, error)
        if error < 1e-12:
            return place, error
        matrix = stiffness_at(packed, place, size)[np.ix_(free, free)]
        # a direction without stiffness (a slack line, a drowned float) must not send the cage away
        units = np.array([1.0, 1.0, size])[free]
        scaled = matrix / np.outer(units, units)
        least = 1e-6 * weight / size
        values, vectors = np.linalg.eigh(0.5 * (scaled + scaled.T))
        move = np.zeros(3)
        pulled = force[free] / units
        stable = np.where(np.abs(values) < least, least, np.abs(values))
        if (values > least).all():
            step = np.linalg.solve(scaled, pulled)
        else:
            step = vectors @ ((vectors.T @ pulled) / stable)
        move[free] = step / units
        move *= min(1.0, float(np.min(reach / np.maximum(np.abs(move), 1e-300))))
        place = place + move
        if np.abs(move / reach).max() < 1e-14:
            break
    force = force_at(packed, place)
    return place, float(np.abs(force / scale)[free].max())


def rest_of(packed: PackedCage, cage: RigidCage, place: Array, held: tuple[int, ...] = ()) -> RigidCageEquilibrium:
    """Return the position of rest near a place [eq:cage-rest].

    Parameters
    ----------
    packed : Packed
        Without waves.
    cage : RigidCage
    place : ndarray
        First guess.
    held : tuple of int
        Directions (0 x, 1 z, 2 rotation) that are not sought.

    Raises
    ------
    ConvergenceError
        With the force that is left.
    """
    size, weight = size_of(cage), float(packed.body[0] * packed.water[1])
    found, error = _newton(packed, place, size, held, weight)
    if error > 1e-8:
        found, error = _settle(packed, found, size, held, weight)
    if error > 1e-8:
        raise ConvergenceError(
            f"no position of equilibrium was found: a force of {error:.2g} of the weight is left",
            parameter="mooring",
            remedy="check anchors, lengths and current",
        )
    work = np.empty(6)
    state = np.concatenate([found, np.zeros(3)])
    tension = np.array([load_kernel.tension_of(packed, i, state, work) for i in range(len(packed.lines))])
    middle = found[1] + math.sin(found[2]) * cage.centre[0] - math.cos(found[2]) * cage.centre[1]
    return RigidCageEquilibrium(
        float(found[0]),
        float(found[1]),
        float(found[2]),
        tension,
        immersion(cage, found),
        error,
        stiffness_at(packed, found, size),
        float(middle),
    )


def _settle(packed: PackedCage, place: Array, size: float, held: tuple[int, ...], weight: float) -> tuple[Array, float]:
    """March the strongly damped cage until it lies still, then polish."""
    gravity = float(packed.water[1])
    rate = math.sqrt(gravity / size)
    mass = weight / gravity
    drag = 4.0 * mass * rate
    body = packed.body.copy()
    body[6:9] = (drag, drag, drag * size**2)
    for i in held:
        body[6 + i] = 1e9 * drag * (size**2 if i == 2 else 1.0)
    damped = packed._replace(body=body)
    state = np.concatenate([place, np.zeros(3)])
    scale = np.array([size, size, 1.0, size * rate, size * rate, rate])
    lines = len(packed.lines)
    rows, tension, peak = np.empty((1, 6)), np.empty((1, lines)), np.zeros((1, lines))
    counts = np.zeros(4, dtype=np.int64)
    step = 1e-3 / rate
    best, least = state[:3].copy(), math.inf
    for turn in range(60):
        span = 20.0 / rate
        _, step = march_kernel.march(
            damped, turn * span, (turn + 1) * span, state, step, 1.0 / rate, 1.0 / rate, 1e-7, scale, 0.0, 1e12, rows,
            tension, peak, counts,
        )  # fmt: skip
        found, error = _newton(packed, state[:3].copy(), size, held, weight)
        if error < least:
            best, least = found, error
        if least < 1e-9:
            break
    return best, least


def free_floating(cage: RigidCage, water: Water, kinematic_viscosity: float) -> RigidCageEquilibrium:
    """Return the cage floating without lines in still water, at x = 0 of its middle.

    Parameters
    ----------
    cage : RigidCage
        In its own axes.
    water : Water
        In which it floats.
    kinematic_viscosity : float
        Of the water [m2/s].

    Returns
    -------
    RigidCageEquilibrium
        Place, immersion and forces.

    Raises
    ------
    InputError
        When it sinks.

    Examples
    --------
    >>> from moyai.structures import free_floating, model_cage
    >>> from moyai.structures.cage.rigid.matsubara import VISCOSITY, WATER
    >>> round(free_floating(model_cage(), WATER, VISCOSITY).immersion, 3)
    0.806
    """
    check_water(water)
    require_floating(cage, water)
    packed = pack(cage, (), water, kinematic_viscosity)
    top = float(np.max(cage.floats.points[:, 2])) - cage.centre[1]
    start = np.array([cage.centre[0], -top - 0.1 * cage.floats.diameter, 0.0])
    return rest_of(packed, cage, start, held=(0,))


def equilibrium_with_lines(
    cage: RigidCage,
    lines: tuple[CageLine, ...],
    water: Water,
    kinematic_viscosity: float,
    current: CurrentProfile | None = None,
    start: Array | None = None,
) -> RigidCageEquilibrium:
    """Return the moored cage at rest in still water or a current.

    Parameters
    ----------
    cage : RigidCage
        In its own axes.
    lines : tuple of CageLine
        Between its corners and the bed.
    water : Water
        In which it floats.
    kinematic_viscosity : float
        Of the water [m2/s].
    current : CurrentProfile, optional
        Still water without one.
    start : ndarray, optional
        Place from which the search begins.

    Returns
    -------
    RigidCageEquilibrium
        Place, immersion, tensions and forces.

    Raises
    ------
    InputError
        When a current carries a cage without lines away.
    ConvergenceError
        When no equilibrium is found.

    Examples
    --------
    >>> from moyai.structures import model_cage, equilibrium_with_lines, taut_lines
    >>> from moyai.structures.cage.rigid.matsubara import VISCOSITY, WATER
    >>> cage = model_cage()
    >>> rest = equilibrium_with_lines(cage, taut_lines(cage, pull_down=0.011, stiffness=2000.0), WATER, VISCOSITY)
    >>> (rest.tension / 9.81e-3).round(1).tolist()                   # [gf]
    [53.5, 53.5]
    """
    check_water(water)
    packed = pack(cage, lines, water, kinematic_viscosity, current=current)
    flowing = bool(np.abs(packed.current[1]).max() > 0.0)
    free = free_floating(cage, water, kinematic_viscosity)
    place = free.place if start is None else start
    if not lines:
        if flowing:
            raise InputError(
                "a current carries the cage away: it has no lines",
                parameter="mooring",
                remedy="give 'mooring', or leave the current out",
            )
        return free
    return rest_of(packed, cage, place)
