"""Compiled kernels of a planar body on lines in motion: the step of the body, and many steps of both until they agree.

:func:`march_together` does what :class:`moyai.coupled.joint.Joint` does with one planar body, without its freedom:
steps of one length, and nothing is cut. Where that does not serve it stops, and the joint takes the step. The large
kernels of body and network come as compiled functions, ``take_step`` and ``march``, and are not compiled again here.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit
from moyai.flexible.explicit_rows import LEDGER, MXX, ROW, U, X
from moyai.sea.kinematics import linear_velocity_acceleration

#: What must be new of a difference of misses for it to count in the next guess, over the largest difference.
LEAST_NEW = 1e-6
#: No row of the step of a body is kept.
NEVER = 1 << 40


@njit(cache=True, error_model="numpy")
def place_points(q: Any, v: Any, arms: Any, centre: Any, place: Any, speed: Any) -> None:
    """Write place and velocity (points, 3) of points of a body at a planar motion."""
    c, s = math.cos(q[2]), math.sin(q[2])
    for p in range(arms.shape[0]):
        x, z = c * arms[p, 0] + s * arms[p, 2], -s * arms[p, 0] + c * arms[p, 2]
        place[p, 0], place[p, 1], place[p, 2] = centre[0] + q[0] + x, centre[1] + arms[p, 1], centre[2] + q[1] + z
        speed[p, 0], speed[p, 1], speed[p, 2] = v[0] + v[2] * z, 0.0, v[1] - v[2] * x


@njit(cache=True, error_model="numpy")
def try_body(
    take_step: Any, q: Any, v: Any, z: Any, guess: Any, h: float, reaction: Any, force: Any, carried: Any, body: Any,
    tried: Any, place: Any, speed: Any, no_limit: Any,
) -> None:  # fmt: skip
    """Take one step of the body from (q, v, z) under mean and tilt of the forces on its points.

    ``take_step`` is :func:`moyai.floating.kernel.run_state_space`, ``no_limit`` its bounds of the motion.
    ``guess`` (2, 3) holds position and velocity expected at the end, for the angle of roll in between, and is replaced
    by what is found. ``force`` (3, m + w) acts at start, middle and end. ``carried`` is (arms, copies, centre),
    ``body`` (constants, own lines, force at rest, exponential weights, inputs, outputs, saved rows). Writes the
    ``tried`` state (q, v, z) and ``place`` and ``speed`` of the points [eq:coupled-reaction].
    """
    arms, copies, centre = carried
    constants, lines, rest, weights, inputs, outputs, saved = body
    new_q, new_v, new_z = tried
    pushed = np.empty(force.shape)
    _copy_rows(force, pushed)
    for stage in range(3):
        angle = q[2]
        if stage == 1:
            angle = 0.5 * (q[2] + guess[0, 2]) + 0.125 * h * (v[2] - guess[1, 2])
        elif stage == 2:
            angle = guess[0, 2]
        c, s = math.cos(angle), math.sin(angle)
        for p in range(arms.shape[0]):
            x, y = c * arms[p, 0] + s * arms[p, 2], -s * arms[p, 0] + c * arms[p, 2]
            along = copies[p] * (reaction[0, p, 0] + (stage - 1.0) * reaction[1, p, 0])
            up = copies[p] * (reaction[0, p, 2] + (stage - 1.0) * reaction[1, p, 2])
            pushed[stage, 0] += along
            pushed[stage, 1] += up
            pushed[stage, 2] += y * along - x * up
    _copy(q, new_q)
    _copy(v, new_v)
    _copy(z, new_z)
    take_step(
        new_q, new_v, new_z, 0, 1, h, pushed, constants, lines, rest, weights, inputs, outputs, no_limit, NEVER, saved
    )  # fmt: skip
    for i in range(3):
        guess[0, i], guess[1, i] = new_q[i], new_v[i]
    place_points(new_q, new_v, arms, centre, place, speed)


@njit(cache=True, error_model="numpy")
def water_at(time: float, ahead: float, A: Any, sea: Any, out: Any) -> None:
    """Write the water (7, n) at a time, at the places of the nodes ``ahead`` seconds from now.

    ``sea`` is (steady velocity (3, n), ramp, ramp of the waves, table (7, n, times), its step, components, depth,
    stretching); the table or the components may be empty.
    """
    steady, ramp, wave_ramp, table, table_step, components, depth, stretching = sea
    omega, intrinsic, amplitude, phase, heading, wave_number = components
    count = out.shape[1]
    for i in range(count):
        for r in range(7):
            out[r, i] = steady[r, i] if r < 3 else 0.0
    if omega.size > 0:
        places, elevation = np.empty((3, count)), np.empty(count)
        velocity, acceleration = np.empty((count, 3)), np.empty((count, 3))
        for axis in range(3):
            for i in range(count):
                places[axis, i] = A[X + axis * ROW + i] + ahead * A[U + axis * ROW + i]
        linear_velocity_acceleration(
            omega, intrinsic, amplitude, phase, heading, wave_number, depth, places[0], places[1], places[2], time,
            stretching, elevation, velocity, acceleration,
        )  # fmt: skip
        swell, pace = _grown(time, wave_ramp)
        for i in range(count):
            for axis in range(3):
                out[axis, i] += swell * velocity[i, axis]
                out[3 + axis, i] = swell * acceleration[i, axis] + pace * velocity[i, axis]
            out[6, i] = swell * elevation[i]
    if table.shape[2] > 1:
        last = table.shape[2] - 2
        at = min(max(time / table_step, 0.0), last + 1.0)
        row = min(int(at), last)
        part = at - row
        for r in range(7):
            for i in range(count):
                out[r, i] += (1.0 - part) * table[r, i, row] + part * table[r, i, row + 1]
    grown, rate = _grown(time, ramp)
    if grown < 1.0:
        for i in range(count):
            for r in range(3):
                out[3 + r, i] = grown * out[3 + r, i] + rate * out[r, i]
                out[r, i] *= grown
            out[6, i] *= grown


@njit(cache=True, error_model="numpy")
def _grown(time: float, ramp: float) -> tuple[float, float]:
    """Return how far half a cosine has grown, and its rate [1/s]."""
    if ramp <= 0.0 or time >= ramp:
        return 1.0, 0.0
    angle = math.pi * max(time, 0.0) / ramp
    return 0.5 * (1.0 - math.cos(angle)), 0.5 * math.pi / ramp * math.sin(angle)


@njit(cache=True, error_model="numpy")
def _keep(A: Any, kept: Any) -> None:
    for r in range(kept.shape[0]):
        for i in range(kept.shape[1]):
            kept[r, i] = A[r * ROW + i]


@njit(cache=True, error_model="numpy")
def _bring_back(A: Any, kept: Any) -> None:
    for r in range(kept.shape[0]):
        for i in range(kept.shape[1]):
            A[r * ROW + i] = kept[r, i]


@njit(cache=True, error_model="numpy")
def _reaction(A: Any, nodes: Any, slots: Any, ledger: Any, now: Any, then: Any, h: float, answer: Any) -> None:
    """Write mean and tilt of the forces on the points, with the inertia of what is lumped there [eq:coupled-reaction].

    ``now`` and ``then`` (2, points, 3) are place and velocity at both ends of the step.
    """
    for p in range(nodes.size):
        m = np.empty(6)
        for row in range(6):
            m[row] = A[MXX + row * ROW + nodes[p]]
        pushed = np.empty((2, 3))
        for axis in range(3):
            pushed[0, axis] = then[1, p, axis] - now[1, p, axis]
            moved = then[0, p, axis] - now[0, p, axis]
            pushed[1, axis] = 0.5 * h * (now[1, p, axis] + then[1, p, axis]) - moved
        for part in range(2):
            x, y, z = pushed[part, 0], pushed[part, 1], pushed[part, 2]
            pushed[part, 0] = -(m[0] * x + m[1] * y + m[2] * z)
            pushed[part, 1] = -(m[1] * x + m[3] * y + m[4] * z)
            pushed[part, 2] = -(m[2] * x + m[4] * y + m[5] * z)
        for axis in range(3):
            impulse = ledger[LEDGER + 6 * slots[p] + axis]
            moment = ledger[LEDGER + 6 * slots[p] + 3 + axis]
            answer[0, p, axis] = (impulse + pushed[0, axis]) / h
            answer[1, p, axis] = 6.0 / h**2 * (moment - 0.5 * h * impulse + pushed[1, axis])


@njit(cache=True, error_model="numpy")
def _difference(back: int, own: int, inputs: Any, misses: Any, moved: Any, change: Any, step: Any, answer: Any) -> None:
    """Write the difference of guesses and of misses that is ``back`` from the newest one, of this step or before."""
    for i in range(step.size):
        if back <= own:
            k = own - back + 1
            step[i], answer[i] = inputs[k, i] - inputs[k - 1, i], misses[k, i] - misses[k - 1, i]
        else:
            k = moved.shape[0] - (back - own)
            step[i], answer[i] = moved[k, i], change[k, i]


@njit(cache=True, error_model="numpy")
def _better(inputs: Any, misses: Any, passes: int, moved: Any, change: Any, known: int, guess: Any) -> None:
    """Write the next guess; see :meth:`moyai.coupled.joint.Joint._better`.

    The last rows of ``moved`` and ``change`` (memory, size) are the differences that earlier steps left, ``known`` of
    them. Least squares by Gram and Schmidt, the newest difference first; what adds nothing new is left out.
    """
    memory, size = moved.shape
    own = passes - 1
    old = known if passes < 4 else 0
    left, gain = np.empty(size), np.empty(size)
    axes, moves = np.empty((memory, size)), np.empty((memory, size))
    for i in range(size):
        left[i] = misses[own, i]
        guess[i] = inputs[own, i] + misses[own, i]
    count, step, greatest = 0, np.empty(size), 0.0
    for back in range(1, min(own + old, memory) + 1):
        _difference(back, own, inputs, misses, moved, change, step, gain)
        whole = 0.0
        for i in range(size):
            whole += gain[i] * gain[i]
        greatest = max(greatest, whole)
    for back in range(1, min(own + old, memory) + 1):
        _difference(back, own, inputs, misses, moved, change, step, gain)
        for i in range(size):
            step[i] += gain[i]
        for k in range(count):
            part = 0.0
            for i in range(size):
                part += axes[k, i] * gain[i]
            for i in range(size):
                gain[i] -= part * axes[k, i]
                step[i] -= part * moves[k, i]
        rest = 0.0
        for i in range(size):
            rest += gain[i] * gain[i]
        if not rest > LEAST_NEW * LEAST_NEW * greatest:
            continue
        rest, part = math.sqrt(rest), 0.0
        for i in range(size):
            axes[count, i], moves[count, i] = gain[i] / rest, step[i] / rest
            part += axes[count, i] * left[i]
        for i in range(size):
            guess[i] -= part * moves[count, i]
        count += 1


@njit(cache=True, error_model="numpy")
def _remember(inputs: Any, misses: Any, passes: int, moved: Any, change: Any) -> None:
    """Keep the differences of the passes of a step behind those of the steps before."""
    memory, size = moved.shape
    for k in range(1, passes):
        for i in range(size):
            for row in range(memory - 1):
                moved[row, i], change[row, i] = moved[row + 1, i], change[row + 1, i]
            moved[memory - 1, i] = inputs[k, i] - inputs[k - 1, i]
            change[memory - 1, i] = misses[k, i] - misses[k - 1, i]


@njit(cache=True, error_model="numpy")
def _forecast(reaction: Any, before: Any, oldest: Any, share: float, straight: Any, curved: Any) -> None:
    """Write the mean reaction (points, 3) continued straight and along a parabola; ``share`` of the last step."""
    for p in range(straight.shape[0]):
        for axis in range(3):
            last, gone = reaction[0, p, axis], before[0, p, axis]
            straight[p, axis] = last + (last - gone) * 0.5 * (1.0 + share)
            bend = (last - 2.0 * gone + oldest[0, p, axis]) * 0.5 * (1.0 + share) * share
            curved[p, axis] = straight[p, axis] + bend


@njit(cache=True, error_model="numpy")
def _begin_step(
    reaction: Any, before: Any, oldest: Any, carry: Any, slips: Any, share: float, straight: Any, curved: Any,
    guess: Any, owed: Any,
) -> None:  # fmt: skip
    """Write the first guess of the reaction (2 points 3) and what is owed from the step before; no share, no guess."""
    count = straight.shape[0]
    if share > 0.0:
        _forecast(reaction, before, oldest, share, straight, curved)
    for p in range(count):
        for axis in range(3):
            mean, tilt = reaction[0, p, axis], reaction[1, p, axis]
            owed[p, axis] = 0.0
            if share > 0.0:
                mean = straight[p, axis] if slips[0] <= slips[1] else curved[p, axis]
                tilt *= share
                owed[p, axis] = carry[p, axis] / share
            guess[3 * p + axis], guess[3 * (count + p) + axis] = mean, tilt


@njit(cache=True, error_model="numpy")
def _compare(answer: Any, guess: Any, input_row: Any, miss_row: Any) -> tuple[float, float]:
    """Write guess and miss of a pass; return the largest mean reaction and the largest miss."""
    count = answer.shape[1]
    largest, off = 0.0, 0.0
    for part in range(2):
        for p in range(count):
            for axis in range(3):
                i = 3 * (part * count + p) + axis
                input_row[i], miss_row[i] = guess[i], answer[part, p, axis] - guess[i]
                # written so that NaN is found
                off = off if abs(miss_row[i]) <= off else abs(miss_row[i])
                if part == 0:
                    largest = max(largest, abs(answer[0, p, axis]))
    return largest, off


@njit(cache=True, error_model="numpy")
def _book(
    joint: Any, books: Any, answer: Any, given: Any, miss: Any, now: Any, then: Any, straight: Any, curved: Any,
    h: float,
) -> None:  # fmt: skip
    """Keep an accepted step: work of both reactions, forecasts that were better, reactions, what is owed."""
    reaction, before, oldest, carry, slips, _, _ = joint
    known = books[1] > 0.0
    slip_straight, slip_curved, owes = 0.0, 0.0, 0.0
    for p in range(answer.shape[1]):
        for axis in range(3):
            gone = then[0, p, axis] - now[0, p, axis]
            turned = h / 6.0 * (then[1, p, axis] - now[1, p, axis])
            books[5] += (answer[0, p, axis] - given[0, p, axis]) * gone
            books[5] += (answer[1, p, axis] - given[1, p, axis]) * turned
            books[4] += 0.5 * abs(answer[0, p, axis] * gone)
            slip_straight = max(slip_straight, abs(answer[0, p, axis] - straight[p, axis]))
            slip_curved = max(slip_curved, abs(answer[0, p, axis] - curved[p, axis]))
            carry[p, axis] = miss[3 * p + axis]
            owes = max(owes, abs(carry[p, axis]))
            for part in range(2):
                new = answer[part, p, axis]
                oldest[part, p, axis] = before[part, p, axis] if known else new
                before[part, p, axis] = reaction[part, p, axis] if known else new
                reaction[part, p, axis] = new
                now[part, p, axis] = then[part, p, axis]
    if known:
        slips[0], slips[1] = 0.7 * slips[0] + 0.3 * slip_straight, 0.7 * slips[1] + 0.3 * slip_curved
    books[6], books[1] = owes * h, h
    books[3] += 1.0


@njit(cache=True, error_model="numpy")
def _copy(source: Any, target: Any) -> None:
    for i in range(source.size):
        target[i] = source[i]


@njit(cache=True, error_model="numpy")
def _copy_rows(source: Any, target: Any) -> None:
    for r in range(source.shape[0]):
        for i in range(source.shape[1]):
            target[r, i] = source[r, i]


@njit(cache=True, error_model="numpy")
def _lead(slots: Any, now: Any, then: Any, tables: Any) -> None:
    """Write place and velocity of the points at both ends of a step into the driving tables."""
    for p in range(slots.size):
        for axis in range(3):
            tables[slots[p], 0, axis], tables[slots[p], 0, 3 + axis] = now[0, p, axis], now[1, p, axis]
            tables[slots[p], 1, axis], tables[slots[p], 1, 3 + axis] = then[0, p, axis], then[1, p, axis]


@njit(cache=True, error_model="numpy")
def _water_rate(water: Any, next_water: Any, h: float, rate: Any) -> None:
    for r in range(7):
        for i in range(water.shape[1]):
            rate[r, i] = (next_water[r, i] - water[r, i]) / h


@njit(cache=True, error_model="numpy")
def march_together(
    march: Any, take_step: Any, steps: int, first: int, begin: float, h: float, force: Any, carried: Any, body: Any,
    motion: Any, network: Any, points: Any, sea: Any, choice: Any, joint: Any, books: Any, limits: Any, rows: Any,
) -> int:  # fmt: skip
    """Take up to ``steps`` steps of body and network together; return how many were agreed on.

    Parameters
    ----------
    march, take_step : function
        :func:`moyai.flexible.explicit_kernel.march` and :func:`moyai.floating.kernel.run_state_space`.
    steps, first : int
        Number of steps, and the row that the first one writes.
    begin, h : float
        Time of the state, length of a step [s].
    force : (2 steps + 1, m + w)
        On the body from outside at half steps.
    carried, body
        As for :func:`try_body`.
    motion : tuple
        q, v, z and the rates of q and v over the last step (3,) of the body; changed in place.
    network : tuple
        Arguments of :func:`moyai.flexible.explicit_kernel.march` that do not change, the arrays that a try changes and
        what they are brought back from; see :class:`moyai.coupled.planar_march.PlanarMarch`.
    points : tuple
        Nodes and slots of the carried points, place and velocity now (2, points, 3), driving tables.
    sea
        As for :func:`water_at`.
    choice : tuple
        Step of the network, steps per load interval, load intervals per step, whether the surface is near, bound of the
        rate of drag at which a row is broken off.
    joint : tuple
        Reaction now, before, oldest (2, points, 3), carry (points, 3), slips (2,), differences (memory, size) of
        guesses and misses.
    books : (8,)
        Largest reaction, length of the last step, passes, steps, work, lost work, impulse owed, differences known.
    limits : (tolerance, passes)
    rows : tuple
        Of the network (positions, tensions, peaks, energies), of the body (q and v), of the reaction, to be written.
    """
    q, v, z, rate = motion
    (
        A,
        sizes,
        runs,
        curves,
        hinges,
        bending,
        attached,
        fluid,
        pairs,
        bed,
        parts,
        kept_nodes,
        kept_bars,
        ledger,
        watch_bars,
        gauges,
        falls,
        broken,
        kept,
        kept_ledger,
        kept_gauges,
        kept_falls,
        water,
    ) = network
    nodes, slots, now, tables = points
    step, per_load, per_row, near, most, bear = choice
    reaction, before, oldest, carry, slips, moved, change = joint
    tolerance, most_passes = limits
    places, pulls, peaks, energy, body_rows, reaction_rows = rows
    count, size = nodes.size, 6 * nodes.size
    new_q, new_v, new_z = np.empty(3), np.empty(3), np.empty(z.size, np.complex128)
    then, answer, given = np.zeros((2, count, 3)), np.zeros((2, count, 3)), np.zeros((2, count, 3))
    inputs, misses = np.zeros((most_passes, size)), np.zeros((most_passes, size))
    straight, curved, owed = np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3))
    guess, way = np.zeros(size), np.zeros((2, 3))
    next_water, water_rate = np.zeros(water.shape), np.zeros(water.shape)
    origin, no_limit = np.zeros((pairs.shape[0], 3)), np.full(3, 1e30)
    for taken in range(steps):
        time = begin + taken * h
        end = time + h
        share = h / books[1] if books[1] > 0.0 else 0.0
        _begin_step(reaction, before, oldest, carry, slips, share, straight, curved, guess, owed)
        for i in range(3):
            way[0, i], way[1, i] = q[i] + h * v[i] + 0.5 * h * h * rate[i], v[i] + h * rate[i]
        water_at(end, h, A, sea, next_water)
        _water_rate(water, next_water, h, water_rate)
        settled, passes, largest = False, 0, 0.0
        while passes < most_passes:
            if passes > 0:
                _bring_back(A, kept)
                _copy(kept_ledger, ledger)
                _copy_rows(kept_gauges, gauges)
                _copy_rows(kept_falls, falls)
            for p in range(count):
                for axis in range(3):
                    given[0, p, axis] = guess[3 * p + axis] + owed[p, axis]
                    given[1, p, axis] = guess[3 * (count + p) + axis]
            try_body(
                take_step, q, v, z, way, h, given, force[2 * taken : 2 * taken + 3], carried, body,
                (new_q, new_v, new_z), then[0], then[1], no_limit,
            )  # fmt: skip
            _lead(slots, now, then, tables)
            for i in range(LEDGER, ledger.size):
                ledger[i] = 0.0
            good = march(
                A, sizes, runs, curves, hinges, bending, attached, fluid, (True, near, water, water_rate, time),
                (pairs, origin, tables, time, h), bed, (time, step, per_load, per_row, 1, first + taken, 0.0), ledger,
                (places, pulls, peaks, energy, kept_nodes, kept_bars), parts,
                (watch_bars, gauges, falls, broken, most, bear),
            )  # fmt: skip
            if good != 1 or broken[0] >= 0:
                break
            _reaction(A, nodes, slots, ledger, now, then, h, answer)
            largest, off = _compare(answer, guess, inputs[passes], misses[passes])
            passes += 1
            if not off < math.inf:
                break
            if off <= tolerance * max(books[0], largest):
                settled = True
                break
            _better(inputs, misses, passes, moved, change, int(books[7]), guess)
        books[2] += passes
        if not settled:
            _bring_back(A, kept)
            _copy(kept_ledger, ledger)
            _copy_rows(kept_gauges, gauges)
            _copy_rows(kept_falls, falls)
            return taken
        _book(joint, books, answer, given, misses[passes - 1], now, then, straight, curved, h)
        _remember(inputs, misses, passes, moved, change)
        books[0], books[7] = max(books[0], largest), min(books[7] + passes - 1, moved.shape[0])
        for i in range(3):
            rate[i] = (new_v[i] - v[i]) / h
        _copy(new_q, q)
        _copy(new_v, v)
        _copy(new_z, z)
        water_at(end, 0.0, A, sea, water)
        _keep(A, kept)
        _copy(ledger, kept_ledger)
        _copy_rows(gauges, kept_gauges)
        _copy_rows(falls, kept_falls)
        for i in range(3):
            body_rows[0, first + taken, i], body_rows[1, first + taken, i] = q[i], v[i]
        _copy_rows(answer[0], reaction_rows[first + taken])
    return steps
