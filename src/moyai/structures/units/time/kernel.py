"""Compiled steps of the row in time: arrays in, arrays out.

Average acceleration for the motions that the constraints leave, exact exponentials for the memory, whose part of the
new velocity stands with the damping [eq:units-step]. Lines and connectors with a curve are solved within the step.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.compiled import njit
from moyai.mooring.space_kernel import space_line_force
from moyai.sea.vector_kernel import REORDER
from moyai.structures.units.links import SHORTEST

RUNNING, DIVERGED, UNSETTLED = 0, 1, 2
_PASSES, _TURNS, _SWEEPS, _HALVINGS = 40, 60, 400, 80
_SETTLED = 1e-8
#: Change of the force of lines, of that at rest, below which it is no larger than its rounding lets it be settled
_AT_REST = 1e-4
#: Change of what lines push, over the largest force of lines, at which a step has settled. A pass brings a share of the
#: change of the pass before; a step ends one pass sooner where that share, as found in one of the last steps, times a
#: factor of caution, leads below it, and where the push was foreseen about as well as then (that of a line that comes
#: taut is not).
_SETTLED_PUSH = 1e-7
_CAUTION, _UNSEEN, _FORGOTTEN = 100.0, 8.0, 0.9
_LEAST_SHARE, _FORESEEN = 1e-3, 4.0
#: Share of the largest motion that an elongation may miss, change of its derivative within a pass of the step
_STRAIGHT, _DIRECTION = 1e-10, 1e-5


def side_by_side(residues: ComplexArray) -> Array:
    """Return residues (k, i, r) as the kernel takes them (i, 2 k r): the force is their real part times the states."""
    rows = residues.transpose(1, 0, 2)
    pairs = np.stack([rows.real, -rows.imag], axis=-1)
    return np.ascontiguousarray(pairs.reshape(len(pairs), math.prod(pairs.shape[1:])))


@njit(cache=True, error_model="numpy")
def joint_force(elongation: float, rate: float, x: Any, f: Any, dashpot: float, side: float) -> tuple[float, float]:
    """Return force [N] and tangent [N/m] of a connector with a curve and its dashpot; the tangent leaves the rate out.

    ``side`` is 1 of what only pulls, -1 of what only pushes, 0 of what does both: the former two carry nothing until
    they are tight, and their dashpots neither.
    """
    last = x.size - 1
    place = 0
    while place < last - 1 and elongation > x[place + 1]:
        place += 1
    slope = (f[place + 1] - f[place]) / (x[place + 1] - x[place])
    force = f[place] + slope * (elongation - x[place])
    if side != 0.0:
        if force * side <= 0.0:
            return 0.0, 0.0
        force += dashpot * rate
        if force * side <= 0.0:
            return 0.0, 0.0
        return force, slope
    return force + dashpot * rate, slope


@njit(cache=True, error_model="numpy")
def _draw(
    y: Any, basis: Any, pairs: Any, arms: Any, bends: Any, axes: Any, spans: Any, room: Any, drawn: Any, along: Any
) -> None:  # fmt: skip
    """Write elongation (j,) and its derivative by y (j, r) of every curve at y [eq:units-turned]; ``room`` (5, 3)."""
    moved, direction, part, turn = room[0], room[1], room[2], room[3:]
    for i in range(spans.size):
        moved[:] = 0.0
        for end in range(2):
            sign, first = 2.0 * end - 1.0, 6 * pairs[i, end]
            arm, w = arms[i, end], turn[end]
            for c in range(3):
                shift, w[c] = 0.0, 0.0
                for n in range(y.size):
                    shift += basis[first + c, n] * y[n]
                    w[c] += basis[first + 3 + c, n] * y[n]
                moved[c] += sign * shift
            inner, size = 0.0, 0.0
            for c in range(3):
                inner += w[c] * arm[c]
                size += w[c] * w[c]
            for c in range(3):
                second, third = (c + 1) % 3, (c + 2) % 3
                turned = w[second] * arm[third] - w[third] * arm[second]
                moved[c] += sign * (turned + 0.5 * bends[i] * (inner * w[c] - size * arm[c]))
        change, square = 0.0, 0.0
        for c in range(3):
            change += moved[c] * axes[i, c]
            square += moved[c] * moved[c]
            direction[c] = axes[i, c]
        drawn[i] = change
        if spans[i] > 0.0:
            change = 2.0 * spans[i] * change + square
            length = np.sqrt(max(spans[i] * spans[i] + change, 0.0))
            drawn[i] = change / (length + spans[i])
            # where both ends meet it has no direction and carries nothing
            length = max(length, SHORTEST * spans[i])
            for c in range(3):
                direction[c] = (spans[i] * axes[i, c] + moved[c]) / length
        along[i, :] = 0.0
        for end in range(2):
            sign, first = 2.0 * end - 1.0, 6 * pairs[i, end]
            arm, w = arms[i, end], turn[end]
            inner, across, over = 0.0, 0.0, 0.0
            for c in range(3):
                inner += w[c] * arm[c]
                across += w[c] * direction[c]
                over += direction[c] * arm[c]
            for c in range(3):
                second, third = (c + 1) % 3, (c + 2) % 3
                part[c] = arm[second] * direction[third] - arm[third] * direction[second]
                part[c] += bends[i] * (0.5 * (inner * direction[c] + across * arm[c]) - over * w[c])
            for c in range(3):
                for n in range(y.size):
                    along[i, n] += sign * (direction[c] * basis[first + c, n] + part[c] * basis[first + 3 + c, n])


@njit(cache=True, error_model="numpy")
def _solve_joints(
    start: Any, reach: Any, speed: Any, step: float, compliance: Any, joints: Any, alpha: Any, force: Any
) -> bool:
    """Find accelerations ``alpha`` and forces of all connectors with a curve at the end of the step.

    alpha = start - compliance force(reach + step^2/4 alpha, speed + step/2 alpha). Newton; where it does not settle,
    one connector after the other, each by halving: the problem is one of a convex energy.
    """
    x, f, ends, dashpots, sides = joints
    count = start.size
    beta, gamma = 0.25 * step * step, 0.5 * step
    alpha[:] = start
    matrix = np.empty((count, count))
    left, slopes = np.empty(count), np.empty(count)
    size = 1e-300
    for j in range(count):
        size = max(size, abs(start[j]))
    for _ in range(_TURNS):
        for j in range(count):
            first, after = ends[j], ends[j + 1]
            force[j], slopes[j] = joint_force(
                reach[j] + beta * alpha[j], speed[j] + gamma * alpha[j], x[first:after], f[first:after], dashpots[j],
                sides[j],
            )  # fmt: skip
            slopes[j] = beta * slopes[j] + (gamma * dashpots[j] if force[j] != 0.0 or sides[j] == 0.0 else 0.0)
        worst = 0.0
        for j in range(count):
            total = alpha[j] - start[j]
            for i in range(count):
                total += compliance[j, i] * force[i]
                matrix[j, i] = compliance[j, i] * slopes[i]
            matrix[j, j] += 1.0
            left[j] = total
            worst = max(worst, abs(total))
        if worst <= _SETTLED * size:
            return True
        alpha -= np.linalg.solve(matrix, left)
    for _ in range(_SWEEPS):
        worst = 0.0
        for j in range(count):
            first, after = ends[j], ends[j + 1]
            target = start[j]
            for i in range(count):
                if i != j:
                    target -= compliance[j, i] * force[i]
            # the force grows with alpha: the root lies between the target and what the force there leads to
            pull, _ = joint_force(
                reach[j] + beta * target, speed[j] + gamma * target, x[first:after], f[first:after], dashpots[j],
                sides[j],
            )  # fmt: skip
            low = min(target, target - compliance[j, j] * pull)
            high = max(target, target - compliance[j, j] * pull)
            for _ in range(_HALVINGS):
                middle = 0.5 * (low + high)
                pull, _ = joint_force(
                    reach[j] + beta * middle, speed[j] + gamma * middle, x[first:after], f[first:after], dashpots[j],
                    sides[j],
                )  # fmt: skip
                if middle - target + compliance[j, j] * pull > 0.0:
                    high = middle
                else:
                    low = middle
            worst = max(worst, abs(low - alpha[j]))
            alpha[j] = low
            force[j] = (target - low) / compliance[j, j]
        if worst <= _SETTLED * size:
            return True
    return False


@njit(cache=True, error_model="numpy", fastmath=REORDER)
def _of_memory(residues: Any, states: Any, out: Any) -> None:
    """Write the forces (i,) of the memory: residues (i, s) times states (s,), real and imaginary parts side by side."""
    for i in range(out.size):
        total = 0.0
        for s in range(states.size):
            total += residues[i, s] * states[s]
        out[i] = total


@njit(cache=True, error_model="numpy", pointer=True)
def march(
    y: Any, v: Any, a: Any, z: Any, first: int, steps: int, h: float, load: Any, body: Any, memory: Any, held: Any,
    lines: Any, joints: Any, drag: Any, limit: float, saved: Any,
) -> tuple[int, int]:  # fmt: skip
    """Advance ``steps`` steps from step number ``first``; y, v, a, z change in place.

    Parameters
    ----------
    y, v, a : ndarray (r,)
        Motions that the constraints leave, their velocities and accelerations.
    z : ndarray (k, r), complex
        States of the memory.
    load : ndarray (n, r)
        Forces at the steps.
    body : tuple
        Inverse of M + h/2 (C + D) + h^2/4 K; damping C + D with the part D of the memory; stiffness K; basis Z (m, r);
        tangent stiffness of the lines that K holds (r, r); force that the lines balance at rest (m,).
    memory : tuple
        Factors of the states and of the velocities at both ends of the step (k,); residues (r, 2 k r), as
        :func:`side_by_side` gives them.
    held : ndarray (c, 2 k r)
        Residues of the loads of the constraints, likewise.
    lines : tuple
        Body of every line, parameters, index, nodes, lookup, last tensions, what lines push beyond their tangent at the
        last three steps (3, r), the newest first; share of a change of that push that another pass would bring, the
        steps for which it is taken without looking, and the change then (3,).
    joints : tuple
        Of every curve: its units (j, 2), arms of its ends (j, 2, 3), 1 where turns count to second order (j,),
        direction (j, 3) and length (j,) at rest (zero: it keeps its direction); then points of all curves, where each
        begins, dashpots, sides.
    drag : tuple
        Rows (k, r) of the measures of the edges, coefficients (k,), motion of the waves in them (n, k).
    saved : tuple
        y, v, a (n, r), memory on the constraints (n, c), line force (n, m), tension (n, lines), force of joints (n, j).
    """
    inverse, damping, stiffness, basis, tangent, balanced = body
    decay, before, after, residues = memory
    holder, parameters, index, nodes, lookup, last, pushes, shrinking = lines
    edges, rough, water = drag
    pairs, arms, bends, axes, spans, xs, fs, ends, dashpots, sides = joints
    r, k, m, j = y.size, decay.size, basis.shape[0], spans.size
    states, constraint = z.reshape(-1).view(np.float64), np.empty(held.shape[0])
    history, right, free, new = np.empty(r), np.empty(r), np.empty(r), np.empty(r)
    y_p, v_p, pushed, former = np.empty(r), np.empty(r), np.zeros(r), np.empty(r)
    ahead, q, pull, tension = np.empty(r), np.empty(m), np.empty(m), np.zeros(parameters.shape[0])
    alpha, start, force = np.zeros(j), np.empty(j), np.zeros(j)
    reach, speed, drawn, drawn_next = np.empty(j), np.empty(j), np.empty(j), np.empty(j)
    along, along_next = np.empty((j, r)), np.empty((j, r))
    answer, compliance = np.empty((r, j)), np.empty((j, j))
    curves = (xs, fs, ends, dashpots, sides)
    room, has_lines, at_rest = np.empty((5, 3)), parameters.shape[0] > 0, 1e-300
    for i in range(m):
        at_rest = max(at_rest, _AT_REST * abs(balanced[i]))
    for step in range(steps):
        number = first + step + 1
        for i in range(r):
            y_p[i] = y[i] + h * v[i] + 0.25 * h * h * a[i]
            v_p[i] = v[i] + 0.5 * h * a[i]
        for p in range(k):
            for i in range(r):
                z[p, i] = decay[p] * z[p, i] + before[p] * v[i]
        _of_memory(residues, states, history)
        for i in range(r):
            total = load[number, i] - history[i]
            for n in range(r):
                total -= damping[i, n] * v_p[n] + stiffness[i, n] * y_p[n]
            right[i] = total
        for e in range(rough.size):
            # with the speed that the last acceleration leads to: as good as the step, and nothing to solve
            speed_past = -water[number, e]
            for n in range(r):
                speed_past += edges[e, n] * (v[n] + h * a[n])
            pulled = rough[e] * abs(speed_past) * speed_past
            for n in range(r):
                right[n] -= edges[e, n] * pulled
        for i in range(r):
            ahead[i] = y_p[i] + 0.25 * h * h * a[i]
        _draw(ahead, basis, pairs, arms, bends, axes, spans, room, drawn_next, along_next)
        settled, straight, known, first_change = False, True, False, 0.0
        for i in range(r):
            # continued along a parabola: a pass less than from the last step
            pushed[i] = 3.0 * (pushes[0, i] - pushes[1, i]) + pushes[2, i]
        for turn in range(_PASSES):
            if j > 0:
                drawn[:], along[:] = drawn_next, along_next
                answer = inverse @ np.ascontiguousarray(along.T)
                compliance = along @ answer
            for i in range(r):
                total = 0.0
                for n in range(r):
                    total += inverse[i, n] * (right[n] + pushed[n])
                free[i] = total
                new[i] = total
            if j > 0:
                for i in range(j):
                    # elongations are taken as straight about where they were last looked at
                    length, rate, total = drawn[i], 0.0, 0.0
                    for n in range(r):
                        length += along[i, n] * (y_p[n] - ahead[n])
                        rate += along[i, n] * v_p[n]
                        total += along[i, n] * free[n]
                    reach[i], speed[i], start[i] = length, rate, total
                if not _solve_joints(start, reach, speed, h, compliance, curves, alpha, force):
                    return UNSETTLED, step
                for i in range(r):
                    for n in range(j):
                        new[i] -= answer[i, n] * force[n]
            for i in range(r):
                ahead[i] = y_p[i] + 0.25 * h * h * new[i]
            if j > 0:
                _draw(ahead, basis, pairs, arms, bends, axes, spans, room, drawn_next, along_next)
                straight = True
                for i in range(j):
                    # the straight line serves unless it misses the length or, where it carries, the direction
                    missed = abs(drawn_next[i] - reach[i] - 0.25 * h * h * alpha[i])
                    straight = straight and missed <= _STRAIGHT * limit
                    for n in range(r if force[i] != 0.0 else 0):
                        straight = straight and abs(along_next[i, n] - along[i, n]) <= _DIRECTION
            if straight and (known or not has_lines):
                settled = True
                break
            if not has_lines:
                continue
            for i in range(m):
                total = 0.0
                for n in range(r):
                    total += basis[i, n] * ahead[n]
                q[i] = total
                pull[i] = 0.0
            space_line_force(q, holder, parameters, index, nodes, lookup, last, pull, tension)
            # what is left of forces in balance is rounding
            size, apart = at_rest, 0.0
            former[:] = pushed
            for i in range(r):
                total = 0.0
                for n in range(r):
                    total += tangent[i, n] * ahead[n]
                pushed[i] = total
            for i in range(m):
                total = pull[i] - balanced[i]
                size = max(size, abs(total))
                for n in range(r):
                    pushed[n] += basis[i, n] * total
            for i in range(r):
                apart = max(apart, abs(pushed[i] - former[i]))
            if turn == 0:
                first_change = apart
                # what another pass would change is far below what counts: the push is taken as it is
                known = shrinking[1] > 0.0 and apart <= _FORESEEN * shrinking[2]
                known = known and max(_CAUTION * shrinking[0], _LEAST_SHARE) * apart <= _SETTLED_PUSH * size
                shrinking[1] -= 1.0
            elif turn == 1:
                share = apart / max(first_change, 1e-300)
                shrinking[0], shrinking[1] = max(share, _FORGOTTEN * shrinking[0]), _UNSEEN
                shrinking[2] = first_change
            if apart <= _SETTLED_PUSH * size and straight:
                settled = True
                break
        if not settled:
            return UNSETTLED, step
        for i in range(r):
            pushes[2, i], pushes[1, i], pushes[0, i] = pushes[1, i], pushes[0, i], pushed[i]
            y[i] = y_p[i] + 0.25 * h * h * new[i]
            v[i] = v_p[i] + 0.5 * h * new[i]
            a[i] = new[i]
            # written so that NaN is lost too
            if not (abs(y[i]) <= limit):
                return DIVERGED, step
        for p in range(k):
            for i in range(r):
                z[p, i] += after[p] * v[i]
        saved[0][number], saved[1][number], saved[2][number] = y, v, a
        _of_memory(held, states, constraint)
        saved[3][number] = constraint
        if has_lines:
            saved[4][number] = pull
            saved[5][number] = tension
        saved[6][number] = force
    return RUNNING, steps
