"""Compiled kernels of the implicit schemes: Newton's method of a stage, error of a step, the march.

Arrays run over nodes first (n, 3); ``system`` as in :mod:`moyai.flexible.force_kernel`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.flexible.force_kernel import (
    accelerate,
    bend,
    blocks,
    cut,
    elastic_pull,
    energies,
    forces,
    kinetic_energy,
    laws,
)
from moyai.flexible.front_kernel import factor_fronts, solve_fronts, to_fronts
from moyai.flexible.ground_kernel import FLAT, ground
from moyai.flexible.part_kernel import part_energy, part_forces, part_masses, part_measure, part_pulls, part_tangent

#: How much smaller the error of a step must be in which a bar turns slack or taut, or a node meets or leaves the bed.
AT_EVENTS = 10.0
#: Outcomes of a march.
GOOD, STUCK, NOT_FINITE = 0, 1, 2


@njit(cache=True, error_model="numpy")
def step_matrix(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, parts: Any, mass: Any, by_mass: float,
    by_rate: float, by_place: float, plan: Any,
) -> bool:  # fmt: skip
    """Write and factor ``by_mass M + by_rate C + by_place K`` without its unsymmetric part.

    The change of drag and added mass with the direction of the bars is left out: over a step it is small, and Newton's
    method converges linearly at a rate far below one. ``plan`` is (own, pairs of bars, pairs of hinges, numbers,
    fronts, target, later, order) of :class:`moyai.flexible.sparse.SparsePlan`.
    """
    node_block, bar_block = np.empty((x.shape[0], 3, 3)), np.empty((system[2].size, 2, 3, 3))
    bar_law, node_law = np.empty((2, system[2].size)), np.empty((4, x.shape[0]))
    laws(x, v, system, fluid, bed, by_rate, by_place, bar_law, node_law)
    blocks(
        x, v, water, system, fluid, bed, mass, bar_law, node_law, by_mass, by_rate, by_place, False, node_block,
        bar_block,
    )  # fmt: skip
    to_fronts(node_block, bar_block, system, by_place, plan[0], plan[1], plan[2], plan[3])
    if parts is not None:
        part_tangent(x, v, water, parts, by_rate, by_place, system[0], plan[3])
    return factor_fronts(plan[3], plan[4], plan[5], True)


@njit(cache=True, error_model="numpy")
def _masked_norm(force: Any, nodes: Any) -> tuple[float, int]:
    """Return the largest force on a free component and its node."""
    most, worst = 0.0, 0
    for i in range(force.shape[0]):
        for axis in range(3):
            size = abs(force[i, axis]) * nodes[9 + axis, i]
            if not size <= most:
                most, worst = size, i
    return most, worst


@njit(cache=True, error_model="numpy")
def driven_place(x: Any, v: Any, driving: Any, now: float) -> None:
    """Put driven nodes at their place and velocity of ``now``."""
    driven, rest, tables, start, step = driving
    last = tables.shape[1] - 1
    place = (now - start) / step
    row = int(place)
    row = 0 if row < 0 else (last - 1 if row > last - 1 else row)
    s = place - row
    for d in range(driven.shape[0]):
        node, table = driven[d, 0], driven[d, 1]
        for axis in range(3):
            p0, p1 = tables[table, row, axis], tables[table, row + 1, axis]
            v0, v1 = tables[table, row, 3 + axis] * step, tables[table, row + 1, 3 + axis] * step
            bend, twist = 3.0 * (p1 - p0) - 2.0 * v0 - v1, v0 + v1 - 2.0 * (p1 - p0)
            x[node, axis] = rest[d, axis] + p0 + s * (v0 + s * (bend + s * twist))
            v[node, axis] = (v0 + s * (2.0 * bend + 3.0 * s * twist)) / step


@njit(cache=True, error_model="numpy")
def _water_at(water: Any, base: Any, rate: Any, ahead: float, moving: bool) -> None:
    if moving:
        for r in range(7):
            for i in range(water.shape[1]):
                water[r, i] = base[r, i] + ahead * rate[r, i]


@njit(cache=True, error_model="numpy")
def _measure(change: Any, x: Any, system: Any, bed: Any, length: float, pull: float) -> float:
    """Return a change of place in units of what is allowed: [m] for nodes, [N] of tension for bars and of bed push."""
    nodes, bars, start, end, curve, curves, _, _, _ = system
    most = 0.0
    for i in range(change.shape[0]):
        for axis in range(3):
            size = abs(change[i, axis]) / length
            if not size <= most:
                most = size
        if bed[3] > 0.0:
            level, nx, ny, nz = bed[0], 0.0, 0.0, 1.0
            if bed.size > FLAT:
                level, nx, ny, nz = ground(bed, x[i, 0], x[i, 1])
            if x[i, 2] < level:
                size = abs(nx * change[i, 0] + ny * change[i, 1] + nz * change[i, 2]) * nodes[5, i] / pull
                if not size <= most:
                    most = size
    for k in range(start.size):
        a, b = start[k], end[k]
        size = dot = 0.0
        for axis in range(3):
            t = x[b, axis] - x[a, axis]
            size += t * t
            dot += t * (change[b, axis] - change[a, axis])
        size = max(math.sqrt(size), 1e-100)
        _, slope = elastic_pull(bars, k, size, curve[k], curves)
        value = abs(dot) / size * slope / pull
        if not value <= most:
            most = value
    return most


@njit(cache=True, error_model="numpy")
def _mass_times(mass: Any, u: Any, nodes: Any, out: Any, sign: float) -> None:
    for i in range(u.shape[0]):
        out[i, 0] += sign * (mass[i, 0] * u[i, 0] + mass[i, 1] * u[i, 1] + mass[i, 2] * u[i, 2])
        out[i, 1] += sign * (mass[i, 1] * u[i, 0] + mass[i, 3] * u[i, 1] + mass[i, 4] * u[i, 2])
        out[i, 2] += sign * (mass[i, 2] * u[i, 0] + mass[i, 4] * u[i, 1] + mass[i, 5] * u[i, 2])
        for axis in range(3):
            out[i, axis] *= nodes[9 + axis, i]


@njit(cache=True, error_model="numpy")
def all_forces(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, parts: Any, force: Any, tension: Any, mass: Any
) -> None:
    """Write the forces of bars, hinges, bed, water and parts, the tensions and the mass blocks."""
    forces(x, v, water, system, fluid, bed, force, tension, mass)
    if parts is not None:
        part_forces(x, v, water, parts, False, force)
        part_masses(x, water, parts, mass)


@njit(cache=True, error_model="numpy")
def acceleration(
    x: Any, v: Any, water: Any, system: Any, fluid: Any, bed: Any, parts: Any, tension: Any, mass: Any, result: Any
) -> None:
    """Write the acceleration of what is free."""
    all_forces(x, v, water, system, fluid, bed, parts, result, tension, mass)
    accelerate(system[0], mass, result)


@njit(cache=True, error_model="numpy")
def whole_energy(x: Any, v: Any, mass: Any, system: Any, parts: Any) -> tuple[float, float]:
    """Return kinetic energy of what is free and elastic energy [J]."""
    kinetic, elastic = energies(x, v, mass, system)
    if parts is not None:
        elastic += part_energy(x, parts)
    return kinetic, elastic


@njit(cache=True, error_model="numpy")
def _stage(
    h: float, gain: float, ahead: Any, across: Any, guess: Any, system: Any, fluid: Any, bed: Any, parts: Any,
    plan: Any, fresh: bool, water: Any, driving: Any, now: float, limits: Any, place: Any, speed: Any, mass: Any,
    tension: Any, force: Any, change: Any, counts: Any,
) -> int:  # fmt: skip
    """Solve one stage for its acceleration ``guess`` by Newton's method; 0 when solved, 1 when not.

    ``limits`` is allowed error of place and of tension, force left at the last look and its node. The factors in
    ``plan`` are kept as long as they serve.
    """
    nodes, count = system[0], guess.shape[0]
    last = math.inf
    for _ in range(12):
        for i in range(count):
            for axis in range(3):
                speed[i, axis] = across[i, axis] + gain * guess[i, axis]
                place[i, axis] = ahead[i, axis] + gain * speed[i, axis]
        driven_place(place, speed, driving, now)
        all_forces(place, speed, water, system, fluid, bed, parts, force, tension, mass)
        counts[0] += 1
        _mass_times(mass, guess, nodes, force, -1.0)
        limits[2], limits[3] = _masked_norm(force, nodes)
        if fresh:
            counts[1] += 1
            if not step_matrix(place, speed, water, system, fluid, bed, parts, mass, 1.0, gain, gain * gain, plan):
                return 1
            fresh = False
        solve_fronts(plan[3], plan[4], plan[6], plan[7], force)
        for i in range(count):
            for axis in range(3):
                step = force[i, axis] * nodes[9 + axis, i]
                guess[i, axis] += step
                # a short step must not hide an error of the velocity behind its own square
                change[i, axis] = gain * max(gain, 0.02) * step
        size = _measure(change, place, system, bed, limits[0], limits[1])
        if parts is not None:
            size = part_measure(change, place, parts, size, limits[1])
        if not size < 1e12:
            return 1
        if size <= 0.02:
            for i in range(count):
                for axis in range(3):
                    speed[i, axis] = across[i, axis] + gain * guess[i, axis]
                    place[i, axis] = ahead[i, axis] + gain * speed[i, axis]
            driven_place(place, speed, driving, now)
            return 0
        # a bar that turned slack or taut wants a new tangent
        if size > 0.3 * last:
            fresh = True
        last = size
    return 1


@njit(cache=True, error_model="numpy")
def _turns(tension: Any, before: Any, x: Any, old: Any, nodes: Any, bed: Any) -> bool:
    """Whether a bar has turned slack or taut, or a node has met or left the bed."""
    for k in range(tension.size):
        if (tension[k] > 0.0) != (before[k] > 0.0):
            return True
    if bed[3] > 0.0:
        for i in range(x.shape[0]):
            if nodes[5, i] * nodes[11, i] > 0.0:
                now = then = bed[0]
                if bed.size > FLAT:
                    now, then = ground(bed, x[i, 0], x[i, 1])[0], ground(bed, old[i, 0], old[i, 1])[0]
                if (x[i, 2] < now) != (old[i, 2] < then):
                    return True
    return False


@njit(cache=True, error_model="numpy")
def _rises(x: Any, v: Any, a: Any, system: Any, tension: Any, rises: Any) -> None:
    """Write the rate of every tension [N/s], without the turn of the bars."""
    _, bars, start, end, curve, curves, _, _, _ = system
    for k in range(start.size):
        size = stretching = quickening = 0.0
        for axis in range(3):
            t = x[end[k], axis] - x[start[k], axis]
            size += t * t
            stretching += t * (v[end[k], axis] - v[start[k], axis])
            quickening += t * (a[end[k], axis] - a[start[k], axis])
        size = max(math.sqrt(size), 1e-100)
        _, slope = elastic_pull(bars, k, size, curve[k], curves)
        rises[k] = (slope * stretching + bars[2, k] * quickening) / size if tension[k] > bars[3, k] else 0.0


@njit(cache=True, error_model="numpy")
def _top(first: float, last: float, rise: float, fall: float) -> float:
    """Return the top of the cubic through both ends of a step, with the changes that their rates would give."""
    if not (rise > 0.0 and fall < 0.0):
        return max(first, last)
    a, b = 6.0 * (first - last) + 3.0 * (rise + fall), -6.0 * (first - last) - 4.0 * rise - 2.0 * fall
    s = 2.0 * rise / (-b + math.sqrt(max(b * b - 4.0 * a * rise, 0.0)))
    s = min(max(s, 0.0), 1.0)
    r = 1.0 - s
    value = r * r * ((1.0 + 2.0 * s) * first + s * rise) + s * s * ((1.0 + 2.0 * r) * last - r * fall)
    return max(first, last, value)


@njit(cache=True, error_model="numpy")
def _powers(x: Any, v: Any, a: Any, mass: Any, system: Any, fluid: Any, parts: Any, own: Any, result: Any) -> None:
    """Write the power of the loads on what is free and of the driven points on the bars [W].

    The loads are what mass times acceleration leaves of the pull of bars, hinges and parts.
    """
    nodes, bars, start, end, curve, curves, hinges, bending, _ = system
    own[:] = 0.0
    for k in range(start.size):
        one, two = start[k], end[k]
        size = rate = 0.0
        for axis in range(3):
            t = x[two, axis] - x[one, axis]
            size += t * t
            rate += t * (v[two, axis] - v[one, axis])
        size = max(math.sqrt(size), 1e-100)
        elastic, _ = elastic_pull(bars, k, size, curve[k], curves)
        pull, _ = cut(elastic + bars[2, k] * rate / size, bars[3, k], fluid[2])
        for axis in range(3):
            t = (x[two, axis] - x[one, axis]) / size
            own[one, axis] += pull * t
            own[two, axis] -= pull * t
    for h in range(hinges.shape[0]):
        bend(x, hinges[h, 0], hinges[h, 1], hinges[h, 2], bending[h], own)
    if parts is not None:
        part_forces(x, v, np.empty((7, 0)), parts, True, own)
    result[0] = result[1] = 0.0
    for i in range(x.shape[0]):
        p, q, s = nodes[9, i] * a[i, 0], nodes[10, i] * a[i, 1], nodes[11, i] * a[i, 2]
        fx = mass[i, 0] * p + mass[i, 1] * q + mass[i, 2] * s
        fy = mass[i, 1] * p + mass[i, 3] * q + mass[i, 4] * s
        fz = mass[i, 2] * p + mass[i, 4] * q + mass[i, 5] * s
        for axis in range(3):
            if nodes[9 + axis, i] > 0.0:
                push = fx if axis == 0 else (fy if axis == 1 else fz)
                result[0] += (push - own[i, axis]) * v[i, axis]
            else:
                result[1] -= own[i, axis] * v[i, axis]


@njit(cache=True, error_model="numpy")
def _read_gauges(before: Any, now: Any, step: float, bars: Any, gauges: Any) -> None:
    """Keep the highest rise of the tension of some bars within two blocks of time, and their highest tension.

    A gauge holds: lowest tension in the block before, in this block, time in this block, length of a block [s], highest
    rise, highest tension. A step longer than two blocks shows nothing: the error estimate made it smooth.
    """
    for g in range(bars.size):
        first, last, block = before[bars[g]], now[bars[g]], gauges[g, 3]
        gauges[g, 5] = max(gauges[g, 5], first, last)
        if step > block:
            if step <= 2.0 * block:
                gauges[g, 4] = max(gauges[g, 4], last - first)
            gauges[g, 0], gauges[g, 1], gauges[g, 2] = last, last, 0.0
            continue
        gauges[g, 1] = min(gauges[g, 1], first)
        gauges[g, 2] += step
        if gauges[g, 2] > block:
            gauges[g, 0], gauges[g, 1], gauges[g, 2] = gauges[g, 1], first, step
        gauges[g, 4] = max(gauges[g, 4], last - min(gauges[g, 0], gauges[g, 1]))


@njit(cache=True, error_model="numpy")
def _note_landings(x: Any, v: Any, bed: Any, falls: Any) -> None:
    """Keep the highest speed with which each node came down on the bed [eq:flexible-landing]."""
    for i in range(falls.shape[1]):
        level, nx, ny, nz = ground(bed, x[i, 0], x[i, 1])
        if x[i, 2] > level:
            falls[0, i] = -(nx * v[i, 0] + ny * v[i, 1] + nz * v[i, 2])
        elif falls[0, i] > 0.0:
            falls[1, i] = max(falls[1, i], falls[0, i])
            falls[0, i] = 0.0


@njit(cache=True, error_model="numpy")
def implicit_march(
    x: Any, v: Any, a: Any, system: Any, parts: Any, plan: Any, fluid: Any, bed: Any, water: Any, driving: Any,
    method: Any, control: Any, timing: Any, ledger: Any, saved: Any, counts: Any, watch: Any,
) -> tuple[int, int, float, int]:  # fmt: skip
    """Advance by rows of the result with an error-controlled implicit Runge-Kutta method [eq:flexible-dirk].

    ``water`` is (now, at the start, rate, moving); ``method`` is (stages, embedded, exponent); ``control`` is 0 step, 1
    smallest step, 2 largest step, 3 tolerance, 4 length for the error of place, 5 largest tension so far, 6 fixed step
    (1) or not (0), 7 force left at a failure [N]; ``counts`` is force evaluations, factorisations, steps, rejected
    steps; ``watch`` is (bars with gauges, gauges, falls on the bed). Returns status, good rows, time reached, node of
    the largest force left.
    """
    nodes, start = system[0], system[2]
    gauge_bars, gauges, falls = watch
    stages, embedded, exponent = method
    now_water, base, rate, moving = water
    time, interval, rows, first_row = timing
    places, pulls, peaks, energy, keep_nodes, keep_bars = saved
    count, many = x.shape[0], stages.shape[0]
    gamma = stages[1, 1]
    vs, accelerations = np.zeros((many, count, 3)), np.zeros((many, count, 3))
    ahead, across, place, speed = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3))
    force, change, own = np.empty((count, 3)), np.empty((count, 3)), np.empty((count, 3))
    mass, old_mass = np.empty((count, 6)), np.empty((count, 6))
    tension, peak, pulled = np.zeros(start.size), np.full(start.size, -1e300), np.zeros(start.size)
    limits, powers, before, work = np.zeros(4), np.zeros(2), np.zeros(2), np.zeros(2)
    begin = time
    _water_at(now_water, base, rate, 0.0, moving)
    acceleration(x, v, now_water, system, fluid, bed, parts, tension, mass, a)
    old_mass[:] = mass
    _powers(x, v, a, mass, system, fluid, parts, own, before)
    pulled[:] = tension
    rises, risen = np.zeros(start.size), np.zeros(start.size)
    _rises(x, v, a, system, tension, risen)
    triangles, highest = 0, 0.0
    if parts is not None:
        triangles = parts[0][2].shape[0]
    slack, loose = np.zeros(triangles, dtype=np.bool_), np.zeros(triangles, dtype=np.bool_)
    if parts is not None:
        highest, _ = part_pulls(x, v, parts, slack)
        control[5] = max(control[5], highest)
    for row in range(rows):
        target = begin + (row + 1) * interval
        while time < target - 1e-9 * interval:
            h = control[0]
            remaining = target - time
            h = remaining / math.ceil(remaining / h * (1.0 - 1e-9))
            limits[0], limits[1] = control[3] * control[4], control[3] * control[5]
            gain = gamma * h
            vs[0], accelerations[0] = v, a
            bad, fresh, turned = 0, True, False
            work[0], work[1] = h * stages[many - 1, 0] * before[0], h * stages[many - 1, 0] * before[1]
            for s in range(1, many):
                part = 0.0
                for j in range(s + 1):
                    part += stages[s, j]
                for i in range(count):
                    for axis in range(3):
                        p, q = x[i, axis], v[i, axis]
                        for j in range(s):
                            p += h * stages[s, j] * vs[j, i, axis]
                            q += h * stages[s, j] * accelerations[j, i, axis]
                        ahead[i, axis], across[i, axis] = p, q
                        accelerations[s, i, axis] = accelerations[s - 1, i, axis]
                _water_at(now_water, base, rate, time + part * h - begin, moving)
                bad = _stage(
                    h, gain, ahead, across, accelerations[s], system, fluid, bed, parts, plan, fresh, now_water,
                    driving, time + part * h, limits, place, speed, mass, tension, force, change, counts,
                )  # fmt: skip
                if bad > 0:
                    break
                fresh = False
                vs[s] = speed
                turned = turned or _turns(tension, pulled, place, x, nodes, bed)
                _powers(place, speed, accelerations[s], mass, system, fluid, parts, own, powers)
                for which in range(2):
                    work[which] += h * stages[many - 1, s] * powers[which]
            error = math.inf
            if bad == 0:
                for i in range(count):
                    for axis in range(3):
                        total = 0.0
                        for j in range(many):
                            total += (stages[many - 1, j] - embedded[j]) * vs[j, i, axis]
                        change[i, axis] = h * total * nodes[9 + axis, i]
                # the stiff part of the estimate is filtered by the matrix of the step
                own[:] = 0.0
                _mass_times(mass, change, nodes, own, 1.0)
                solve_fronts(plan[3], plan[4], plan[6], plan[7], own)
                for i in range(count):
                    for axis in range(3):
                        change[i, axis] = own[i, axis]
                error = _measure(change, place, system, bed, limits[0], limits[1])
                if parts is not None:
                    error = part_measure(change, place, parts, error, limits[1])
                    loose[:] = slack
                    highest, loosened = part_pulls(place, speed, parts, loose)
                    turned = turned or loosened
                # across slack and taut the estimate is one of a smooth motion no more: it must be the smaller
                if turned:
                    error *= AT_EVENTS
            if control[6] > 0.0:
                if bad > 0:
                    control[7] = limits[2]
                    return STUCK, row, time, int(limits[3])
            elif not error <= 1.0:
                counts[3] += 1
                control[0] = h * (0.25 if bad > 0 or not error < 1e6 else max(0.2, 0.9 * error**-exponent))
                if control[0] < control[1]:
                    control[7] = limits[2]
                    return STUCK, row, time, int(limits[3])
                continue
            x[:], v[:], a[:] = place, speed, accelerations[many - 1]
            time += h
            counts[2] += 1
            all_forces(x, v, now_water, system, fluid, bed, parts, force, tension, mass)
            _rises(x, v, a, system, tension, rises)
            for k in range(start.size):
                # peaks fall between long steps
                peak[k] = max(peak[k], _top(pulled[k], tension[k], h * risen[k], h * rises[k]))
                control[5] = max(control[5], abs(tension[k]))
            if parts is not None:
                slack[:] = loose
                control[5] = max(control[5], highest)
            _read_gauges(pulled, tension, h, gauge_bars, gauges)
            _note_landings(x, v, bed, falls)
            pulled[:] = tension
            risen[:] = rises
            ledger[0] += work[0]
            ledger[1] += work[1]
            before[:] = powers
            # the turn of the added mass, at the velocities before and after
            ledger[2] += 0.5 * (kinetic_energy(v, mass, nodes) - kinetic_energy(v, old_mass, nodes))
            ledger[2] += 0.5 * (kinetic_energy(vs[0], mass, nodes) - kinetic_energy(vs[0], old_mass, nodes))
            old_mass[:] = mass
            if control[6] == 0.0:
                control[0] = min(control[2], h * min(4.0, 0.9 * max(error, 1e-8) ** -exponent))
        kinetic, elastic = whole_energy(x, v, mass, system, parts)
        out = first_row + row
        energy[out, 0], energy[out, 1], energy[out, 2] = kinetic, elastic, ledger[0] + ledger[1] + ledger[2]
        for j in range(keep_nodes.size):
            for axis in range(3):
                places[out, j, axis] = x[keep_nodes[j], axis]
        for j in range(keep_bars.size):
            pulls[out, j] = tension[keep_bars[j]]
            peaks[out, j] = peak[keep_bars[j]]
        peak[:] = tension
        if not (kinetic + elastic < np.inf):
            return NOT_FINITE, row, time, 0
    return GOOD, rows, time, 0
