"""Compiled kernels of dense mass blocks: sections whose nodes feel each other's acceleration through the water.

Rows of the explicit scheme are addressed as ``first + node + axis * row``. Each node of a block has a frame: cosine and
sine of the direction along the cable in plan, and the root of its present over its first length. The normal is the
direction turned clockwise; local unknowns are the normal velocities of all nodes of a block, then the vertical ones.
``room``, of :func:`room_for`, takes what a kernel keeps of one block at a time.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.arrays import PLAIN
from moyai.core.compiled import njit

#: What is known of each node of a block: cosine, sine, root of the stretch, the first length of its cable [m], and what
#: the own mass was multiplied with for the normal and for the vertical unknown when the inverse was last taken.
COS, SIN, ROOT, LENGTH, FLAT, UPRIGHT, COLUMNS = range(7)
#: Own mass that is missing in the inverse, over the whole mass, beyond which the inverse is taken again; the kick takes
#: out what is missing to the first order, so that its square is left.
STALE = 0.005
#: Least part of the normal along the one axis on which a node is free.
FACING = 1e-3


#: Rows of the room before the matrix.
_ROWS = 7


def room_for(nodes: Any) -> Any:
    """Return room for the kernels: rows as long as a block has unknowns, and a matrix of them."""
    size = 2 * nodes.shape[1]
    return np.empty((_ROWS + size, size))


@njit(cache=True, error_model="numpy")
def set_frames(nodes: Any, guides: Any, frames: Any, P: Any, p0: int, axis: int, stretch: bool) -> None:
    """Turn the frames with the cable, along the way from the guide before to the one behind; let them stretch."""
    for g in range(nodes.shape[0]):
        for i in range(nodes.shape[1]):
            a, b = guides[g, i, 0] & PLAIN, guides[g, i, 1] & PLAIN
            dx, dy = P[p0 + b] - P[p0 + a], P[p0 + axis + b] - P[p0 + axis + a]
            size = math.sqrt(dx * dx + dy * dy)
            if size > 0.0:
                frames[g, i, COS], frames[g, i, SIN] = dx / size, dy / size
            frames[g, i, ROOT] = math.sqrt(max(size / frames[g, i, LENGTH], 1e-12)) if stretch else 1.0


@njit(cache=True, error_model="numpy", inline="always")
def _lever(c: float, s: float, r: float, mx: float, my: float) -> float:
    """Return the local unknown per velocity: along the normal, or along the one horizontal axis that is free."""
    if mx > 0.0 and my > 0.0:
        return r
    part = s if mx > 0.0 else -c
    return r * math.copysign(max(abs(part), FACING), part)


@njit(cache=True, error_model="numpy")
def _inverse(whole: Any, moves: Any, out: Any) -> None:
    """Write the inverse of a positive symmetric matrix over the unknowns that move, zero elsewhere.

    ``whole`` is overwritten: Cholesky's factor, its inverse, and the product of that with its transpose.
    """
    size = whole.shape[0]
    for i in range(size):
        for j in range(i + 1):
            out[i, j] = out[j, i] = 0.0
        if moves[i] == 0.0:
            for j in range(size):
                whole[i, j] = whole[j, i] = 0.0
            whole[i, i] = 1.0
    for j in range(size):
        for k in range(j):
            part = whole[j, k]
            if part != 0.0:
                for i in range(j, size):
                    whole[i, j] -= whole[i, k] * part
        root = 1.0 / math.sqrt(whole[j, j])
        for i in range(j, size):
            whole[i, j] *= root
    # the factor's inverse, row by row, over the factor
    for i in range(size):
        low = 1.0 / whole[i, i]
        for j in range(i):
            total = 0.0
            for k in range(j, i):
                total += whole[i, k] * whole[k, j]
            out[i, j] = -low * total
        for j in range(i):
            whole[i, j] = out[i, j]
        whole[i, i] = low
    for i in range(size):
        for j in range(i + 1):
            total = 0.0
            for k in range(i, size):
                total += whole[k, i] * whole[k, j]
            out[i, j] = out[j, i] = total
        if moves[i] == 0.0:
            out[i, i] = 0.0


@njit(cache=True, error_model="numpy")
def refresh_inverse(
    nodes: Any, frames: Any, added: Any, inverse: Any, own: Any, A: Any, free: int, axis: int, stale: float, room: Any
) -> None:  # fmt: skip
    """Take the inverse of the whole mass of those sections anew in which it is out of date by more than ``stale``.

    Local unknowns stretch with the section, the own mass does not: to a local unknown ``g`` times a velocity the own
    mass counts over ``g`` squared.
    """
    count = nodes.shape[1]
    whole, moves, share = room[_ROWS:], room[0], room[1]
    for g in range(nodes.shape[0]):
        late = False
        for i in range(count):
            at = free + (nodes[g, i] & PLAIN)
            mx, my, mz = A[at], A[at + axis], A[at + 2 * axis]
            r = frames[g, i, ROOT]
            lever = _lever(frames[g, i, COS], frames[g, i, SIN], r, mx, my)
            share[i], share[count + i] = 1.0 / (lever * lever), 1.0 / (r * r)
            moves[i], moves[count + i] = max(mx, my), mz
            late |= own[g, i] * abs(share[i] - frames[g, i, FLAT]) * inverse[g, i, i] > stale
            late |= own[g, i] * abs(share[count + i] - frames[g, i, UPRIGHT]) * inverse[g, count + i, count + i] > stale
        if not late:
            continue
        for i in range(2 * count):
            for j in range(2 * count):
                whole[i, j] = added[g, i, j]
            whole[i, i] += own[g, i % count] * share[i]
        _inverse(whole, moves, inverse[g])
        for i in range(count):
            frames[g, i, FLAT], frames[g, i, UPRIGHT] = share[i], share[count + i]


@njit(cache=True, error_model="numpy")
def block_energy(nodes: Any, frames: Any, added: Any, V: Any, v0: int, axis: int, room: Any) -> float:
    """Return the kinetic energy of the water of all blocks [J] [eq:flexible-block-energy]."""
    count, total = nodes.shape[1], 0.0
    w = room[0]
    for g in range(nodes.shape[0]):
        for i in range(count):
            at = v0 + (nodes[g, i] & PLAIN)
            c, s, r = frames[g, i, COS], frames[g, i, SIN], frames[g, i, ROOT]
            w[i], w[count + i] = r * (s * V[at] - c * V[at + axis]), r * V[at + 2 * axis]
        for i in range(2 * count):
            # the matrix is symmetric: its lower half is all of it
            row = 0.5 * added[g, i, i] * w[i]
            for j in range(i):
                row += added[g, i, j] * w[j]
            total += row * w[i]
    return total


@njit(cache=True, error_model="numpy")
def kick_blocks(
    nodes: Any, frames: Any, inverse: Any, light: Any, own: Any, A: Any, vel: int, force: int, axis: int, place: int,
    push: float, level: float, stiff: int, damp: int, free: int, room: Any,
) -> None:  # fmt: skip
    """Advance the velocities of the nodes of blocks by ``push`` times their force, and hold them off a smooth bed.

    ``force`` names the rows that hold the whole force of each node, ``free`` those that hold 1 where it may move.
    ``inverse`` is the inverse of the whole mass over the local unknowns, ``light`` that of each node along the cable,
    ``own`` the mass of each node without water. A node that is held along x or y moves by the force along the other
    axis alone.
    """
    count = nodes.shape[1]
    # of each node, one over its lever and over the root of its stretch
    f, kick, rest, per, up = room[0], room[1], room[2], room[3], room[4]
    for g in range(nodes.shape[0]):
        for i in range(count):
            node = nodes[g, i] & PLAIN
            at, mobile = force + node, free + node
            c, s, r = frames[g, i, COS], frames[g, i, SIN], frames[g, i, ROOT]
            mx, my = A[mobile], A[mobile + axis]
            per[i], up[i] = 1.0 / _lever(c, s, r, mx, my), 1.0 / r
            across = s * A[at] - c * A[at + axis] if mx > 0.0 and my > 0.0 else mx * A[at] + my * A[at + axis]
            f[i], f[count + i] = across * per[i], A[at + 2 * axis] * up[i]
        for i in range(2 * count):
            row = 0.0
            for j in range(2 * count):
                row += inverse[g, i, j] * f[j]
            kick[i] = push * row
        # what the section has stretched and turned since the inverse was taken: one step of an iteration
        for i in range(count):
            rest[i] = own[g, i] * (per[i] * per[i] - frames[g, i, FLAT]) * kick[i]
            rest[count + i] = own[g, i] * (up[i] * up[i] - frames[g, i, UPRIGHT]) * kick[count + i]
        for i in range(2 * count):
            row = 0.0
            for j in range(2 * count):
                row += inverse[g, i, j] * rest[j]
            f[i] = row
        for i in range(2 * count):
            kick[i] -= f[i]
        for i in range(count):
            node = nodes[g, i] & PLAIN
            at, to, mobile = force + node, vel + node, free + node
            c, s = frames[g, i, COS], frames[g, i, SIN]
            mx, my = A[mobile], A[mobile + axis]
            if mx > 0.0 and my > 0.0:
                along = push * light[g, i] * (c * A[at] + s * A[at + axis])
                A[to] += s * kick[i] * per[i] + c * along
                A[to + axis] += s * along - c * kick[i] * per[i]
            else:
                A[to] += mx * kick[i] * per[i]
                A[to + axis] += my * kick[i] * per[i]
            A[to + 2 * axis] += kick[count + i] * up[i]
        for i in range(count):
            node = nodes[g, i] & PLAIN
            depth, w = level - A[place + 2 * axis + node], A[vel + 2 * axis + node]
            if depth <= push * w:
                continue
            share = up[i] * up[i] * inverse[g, count + i, count + i]
            grip = A[stiff + node] * push + A[damp + node]
            blow = push * (A[stiff + node] * depth - grip * w) / (1.0 + push * grip * share)
            if blow <= 0.0:
                continue
            for j in range(count):
                to, mobile = vel + nodes[g, j], free + nodes[g, j]
                c, s = frames[g, j, COS], frames[g, j, SIN]
                mx, my = A[mobile], A[mobile + axis]
                turn = up[i] * inverse[g, j, count + i] * blow * per[j]
                if mx > 0.0 and my > 0.0:
                    A[to] += s * turn
                    A[to + axis] -= c * turn
                else:
                    A[to] += mx * turn
                    A[to + axis] += my * turn
                A[to + 2 * axis] += up[i] * inverse[g, count + j, count + i] * blow * up[j]


@njit(cache=True, error_model="numpy")
def block_loads(
    nodes: Any, guides: Any, frames: Any, added: Any, A: Any, vel: int, water: int, force: int, axis: int,
    moving: bool, whole: bool, room: Any,
) -> None:  # fmt: skip
    """Add the forces of the water on blocks beyond added mass times acceleration of the nodes.

    The inertia of moving water and, where ``whole``, what follows from the turn and stretch of the blocks in Lagrange's
    equations, so that the energy of the water is kept [eq:flexible-block-force].
    """
    count = nodes.shape[1]
    w, e, p, q, turn, grow, slide = room[0], room[1], room[2], room[3], room[4], room[5], room[6]
    for g in range(nodes.shape[0]):
        for i in range(count):
            node = nodes[g, i] & PLAIN
            c, s, r = frames[g, i, COS], frames[g, i, SIN], frames[g, i, ROOT]
            at, by = vel + node, water + node
            x, y, z = A[at] - A[by], A[at + axis] - A[by + axis], A[at + 2 * axis] - A[by + 2 * axis]
            n, u = s * x - c * y, c * x + s * y
            w[i], w[count + i] = r * n, r * z
            e[i] = e[count + i] = 0.0
            if whole:
                a, b = guides[g, i, 0] & PLAIN, guides[g, i, 1] & PLAIN
                size = r * r * frames[g, i, LENGTH]
                # guides move with the relative velocity as well
                dx = A[vel + b] - A[vel + a] - A[water + b] + A[water + a]
                dy = A[vel + axis + b] - A[vel + axis + a] - A[water + axis + b] + A[water + axis + a]
                turn[i], grow[i] = (c * dy - s * dx) / size, 0.5 * r * (c * dx + s * dy) / size
                slide[i] = u
                e[i], e[count + i] = grow[i] * n + r * turn[i] * u, grow[i] * z
            if moving:
                px, py, pz = A[by + 3 * axis], A[by + 4 * axis], A[by + 5 * axis]
                e[i] -= r * (s * px - c * py)
                e[count + i] -= r * pz
        for i in range(2 * count):
            one, two = 0.0, 0.0
            for j in range(2 * count):
                one += added[g, i, j] * w[j]
                two += added[g, i, j] * e[j]
            p[i], q[i] = one, two
        for i in range(count):
            node = nodes[g, i] & PLAIN
            c, s, r = frames[g, i, COS], frames[g, i, SIN], frames[g, i, ROOT]
            normal, along, up = r * q[i], 0.0, r * q[count + i]
            if whole:
                normal += p[i] * grow[i]
                along = p[i] * r * turn[i]
                up += p[count + i] * grow[i]
                size = r * r * frames[g, i, LENGTH]
                # derivative of the energy by the way between the guides
                back = -p[i] * r * slide[i] / size
                stretch = 0.5 * (p[i] * w[i] + p[count + i] * w[count + i]) / size
                gx, gy = back * s + stretch * c, -back * c + stretch * s
                a, b = force + (guides[g, i, 0] & PLAIN), force + (guides[g, i, 1] & PLAIN)
                A[b] += gx
                A[b + axis] += gy
                A[a] -= gx
                A[a + axis] -= gy
            at = force + node
            A[at] -= s * normal + c * along
            A[at + axis] += c * normal - s * along
            A[at + 2 * axis] -= up
