"""From planned lines to lines with a length: pulled down, with a pretension, slack, or as long as given."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.sea.water import Water
from moyai.structures.cage.rigid.lines import CageLine, series_stiffness
from moyai.structures.cage.rigid.model import RigidCageProblem, RigidLinePlan
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.parts import RigidCage
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium, force_at, free_floating, reserve_buoyancy, size_of


def lines_of(problem: RigidCageProblem) -> tuple[CageLine, ...]:
    """Return the lines of a problem in the water at datum; see :func:`resolve`."""
    return resolve(problem.cage, problem.plans, problem.environment.water, problem.kinematic_viscosity)


def at_level(lines: tuple[CageLine, ...], level: float) -> tuple[CageLine, ...]:
    """Return the same lines with anchors below the still water of a level [m above datum]."""
    return tuple(replace(line, anchor=(line.anchor[0], line.anchor[1] - level)) for line in lines)


def resolve(
    cage: RigidCage, plans: tuple[RigidLinePlan, ...], water: Water, kinematic_viscosity: float
) -> tuple[CageLine, ...]:
    """Return lines with their lengths [eq:cage-setup].

    Raises
    ------
    InputError
        When lines cannot reach, or ask for more than the floats carry.
    """
    if not plans:
        return ()
    for plan in plans:
        if not plan.anchor_above_bed < water.depth:
            raise InputError(
                f"the anchor of line '{plan.name}' is {plan.anchor_above_bed:g} m above the bed, over the surface",
                parameter="mooring",
                allowed=f"less than {water.depth:g} m",
            )
    free = free_floating(cage, water, kinematic_viscosity)
    drafts = tuple(_draft(plan, cage, water, free) for plan in plans)
    tense = [plan.setting in ("pull_down", "pretension") for plan in plans]
    place, tension = free.place, np.zeros(len(plans))
    if any(tense):
        place, tension = _balance(cage, plans, drafts, water, kinematic_viscosity, free)
    lines = []
    for plan, draft, pull, pulled in zip(plans, drafts, tension, tense):
        if pulled:
            span = draft.span(place, cage.centre)
            lines.append(_tightened(plan, draft, span, float(pull)))
            continue
        span = draft.span(free.place, cage.centre)
        length = span + plan.value if plan.setting == "slack" else plan.value
        line = replace(draft, length=length, stiffness=_stiffness(plan, length))
        _require_reach(line, cage, water, free)
        lines.append(line)
    return tuple(lines)


def _draft(plan: RigidLinePlan, cage: RigidCage, water: Water, free: RigidCageEquilibrium) -> CageLine:
    anchor = (plan.anchor_x, -water.depth + plan.anchor_above_bed)
    line = CageLine(
        plan.name, plan.attachment, anchor, 1.0, 1.0, plan.damping, plan.submerged_weight, plan.breaking_load
    )
    if line.span(free.place, cage.centre) < 1e-6 * size_of(cage):
        raise InputError(
            f"line '{plan.name}' is anchored where it meets the cage", parameter="mooring", allowed="apart"
        )
    return line


def _stiffness(plan: RigidLinePlan, length: float) -> float:
    if plan.stiffness is not None:
        return plan.stiffness
    assert plan.axial_stiffness is not None
    return series_stiffness(plan.axial_stiffness, length, plan.gauge_stiffness)


def _tightened(plan: RigidLinePlan, draft: CageLine, span: float, tension: float) -> CageLine:
    """Return the line that has a tension over a span."""
    length = span
    for _ in range(100):
        length = span - tension / _stiffness(plan, length)
        if length <= 0.0:
            raise InputError(
                f"line '{plan.name}' stretches by more than the {span:.4g} m that it spans",
                parameter="mooring.stiffness",
                remedy="take a stiffer line or a smaller pretension",
            )
    return replace(draft, length=length, stiffness=_stiffness(plan, length))


def _balance(
    cage: RigidCage,
    plans: tuple[RigidLinePlan, ...],
    drafts: tuple[CageLine, ...],
    water: Water,
    kinematic_viscosity: float,
    free: RigidCageEquilibrium,
) -> tuple[Array, Array]:
    """Return the place at rest and the tensions that were asked for there."""
    still = pack(cage, (), water, kinematic_viscosity)
    depths = {plan.value for plan in plans if plan.setting == "pull_down"}
    if len(depths) > 1:
        raise InputError("lines of one cage pull it down differently", parameter="mooring", allowed="one value")
    shared = [plan.setting == "pull_down" for plan in plans]
    given = np.array([plan.value if plan.setting == "pretension" else 0.0 for plan in plans])
    weight, size = cage.mass * water.gravity, size_of(cage)

    def pull_of(place: Array, tension: Array) -> Array:
        total = np.zeros(3)
        for line, value in zip(drafts, tension):
            px, pz = line.place(place, cage.centre)
            dx, dz = line.anchor[0] - px, line.anchor[1] - pz
            span = math.hypot(dx, dz)
            rx, rz = px - place[0], pz - place[1]
            fx, fz = value * dx / span, value * dz / span
            total += np.array([fx, fz, fx * rz - fz * rx])
        return total

    depth = depths.pop() if depths else None

    def unpack(unknown: Array) -> tuple[Array, Array]:
        if depth is None:
            return free.place + unknown * np.array([size, size, 1.0]), given
        place = free.place + np.array([unknown[0] * size, -depth, unknown[2]])
        return place, np.where(shared, unknown[1] * weight, given)

    def residual(unknown: Array) -> Array:
        place, tension = unpack(unknown)
        values: Array = (force_at(still, place) + pull_of(place, tension)) / np.array([weight, weight, weight * size])
        return values

    if depth is None:
        _require_carried(cage, drafts, water, free, given)
    found, error = _root(residual, np.array([0.0, 0.1 if depth is not None else 0.0, 0.0]))
    place, tension = unpack(found)
    if error > 1e-8 or (tension < -1e-9 * weight).any():
        raise InputError(
            "the tensions of the lines do not balance: the cage finds no equilibrium with them",
            parameter="mooring",
            remedy="give lines on both sides, or their lengths",
        )
    return place, tension


def _require_carried(
    cage: RigidCage, drafts: tuple[CageLine, ...], water: Water, free: RigidCageEquilibrium, given: Array
) -> None:
    """Refuse tensions that pull more than the floats carry, with the directions of the floating cage."""
    carried = reserve_buoyancy(cage, water)
    steep = []
    for line in drafts:
        px, pz = line.place(free.place, cage.centre)
        steep.append((pz - line.anchor[1]) / math.hypot(px - line.anchor[0], pz - line.anchor[1]))
    asked = float(given @ np.array(steep))
    if asked > carried:
        equal = carried / max(sum(steep), 1e-12)
        raise InputError(
            f"the pretension pulls the cage down with {asked:.4g} N; the buoyancy of its floats is {carried:.4g} N "
            "beyond its "
            "weight",
            parameter="mooring.pretension",
            allowed=f"less than about {equal:.4g} N in each line",
        )


def _root(residual: Callable[[Array], Array], start: Array) -> tuple[Array, float]:
    """Newton's method with halving steps on three scaled equations."""
    point = start
    value = residual(point)
    for _ in range(100):
        error = float(np.abs(value).max())
        if error < 1e-13:
            break
        jacobian = np.empty((3, 3))
        for column in range(3):
            shift = np.zeros(3)
            shift[column] = 1e-6
            jacobian[:, column] = (residual(point + shift) - residual(point - shift)) / 2e-6
        step = np.linalg.lstsq(jacobian, -value, rcond=1e-10)[0]
        step *= min(1.0, 0.2 / max(float(np.abs(step).max()), 1e-300))
        for _ in range(30):
            trial = residual(point + step)
            if np.linalg.norm(trial) < np.linalg.norm(value):
                break
            step = 0.5 * step
        else:
            break
        point, value = point + step, trial
    return point, float(np.abs(value).max())


def _require_reach(line: CageLine, cage: RigidCage, water: Water, free: RigidCageEquilibrium) -> None:
    """Refuse a line so short that it submerges the cage."""
    span = line.span(free.place, cage.centre)
    if line.length >= span:
        return
    drop = drowning_depth(cage, free)
    drowned = free.place - np.array([0.0, drop, 0.0])
    shortest = line.span(drowned, cage.centre)
    _, pz = line.place(drowned, cage.centre)
    steep = max((pz - line.anchor[1]) / shortest, 1e-6)
    shortest -= reserve_buoyancy(cage, water) / steep / line.stiffness
    if line.length < shortest:
        raise InputError(
            f"line '{line.name}' of {line.length:.4g} m cannot reach: from its anchor to the floating cage are "
            f"{span:.4g} m, and its pull would drown the floats",
            parameter="mooring",
            allowed=f"at least about {max(shortest, 0.0):.4g} m",
            remedy="lengthen the line, or bring the anchor nearer",
        )


def drowning_depth(cage: RigidCage, free: RigidCageEquilibrium) -> float:
    """Return how far the freely floating cage has to be pulled under until its floats are wholly in water [m]."""
    top = float(np.max(cage.floats.points[:, 2])) - cage.centre[1] + 0.5 * cage.floats.diameter
    return max(free.z + top, 0.0)
