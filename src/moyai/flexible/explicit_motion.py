"""Velocities and places of the explicit scheme: kick and drift, a bed in between, driven nodes."""

from __future__ import annotations

import math

from moyai.core.arrays import Array, IntArray
from moyai.core.compiled import njit
from moyai.flexible.explicit_rows import (
    DAMP,
    FAST,
    FX,
    FY,
    FZ,
    IXX,
    IXY,
    IXZ,
    IYY,
    IYZ,
    IZZ,
    ROW,
    STIFF,
    TINY,
    TX,
    TY,
    TZ,
    U,
    V,
    W,
    X,
    Y,
    Z,
)
from moyai.flexible.ground_kernel import ground


@njit(cache=True, error_model="numpy", fastmath=FAST)
def kick_and_drift(A: Array, count: int, push: float, move: float) -> None:
    """Advance velocities by ``push`` times inverse mass times force, positions by ``move`` times velocity.

    The element before the first of a force row belongs to the unused end of another row and is zero.
    """
    for i in range(count):
        fx = push * (A[TX + i] + A[FX + i] - A[FX + i - 1])
        fy = push * (A[TY + i] + A[FY + i] - A[FY + i - 1])
        fz = push * (A[TZ + i] + A[FZ + i] - A[FZ + i - 1])
        u = A[U + i] + A[IXX + i] * fx + A[IXY + i] * fy + A[IXZ + i] * fz
        v = A[V + i] + A[IXY + i] * fx + A[IYY + i] * fy + A[IYZ + i] * fz
        w = A[W + i] + A[IXZ + i] * fx + A[IYZ + i] * fy + A[IZZ + i] * fz
        A[U + i], A[V + i], A[W + i] = u, v, w
        A[X + i] += move * u
        A[Y + i] += move * v
        A[Z + i] += move * w


@njit(cache=True, error_model="numpy", fastmath=FAST)
def kick_contact_and_drift(A: Array, count: int, level: float, time: float, move: float) -> None:
    """Do what :func:`kick_and_drift` does, with the impulses of a smooth bed in between.

    Implicit spring and dashpot [eq:flexible-bed], without branches, for whole vectors.
    """
    for i in range(count):
        share = A[IZZ + i]
        fx = time * (A[TX + i] + A[FX + i] - A[FX + i - 1])
        fy = time * (A[TY + i] + A[FY + i] - A[FY + i - 1])
        fz = time * (A[TZ + i] + A[FZ + i] - A[FZ + i - 1])
        u = A[U + i] + A[IXX + i] * fx + A[IXY + i] * fy + A[IXZ + i] * fz
        v = A[V + i] + A[IXY + i] * fx + A[IYY + i] * fy + A[IYZ + i] * fz
        w = A[W + i] + A[IXZ + i] * fx + A[IYZ + i] * fy + share * fz
        depth = level - A[Z + i]
        # depth - time w replaces depth: a stiff bed then needs no smaller step
        grip = A[STIFF + i] * time + A[DAMP + i]
        push = time * (A[STIFF + i] * depth - grip * w) / (1.0 + time * grip * share)
        # contact is given by where the node would end: a hard bed stops it at its face instead of throwing it back
        push = push if depth > time * w else 0.0
        push = push if push > 0.0 else 0.0
        u += A[IXZ + i] * push
        v += A[IYZ + i] * push
        w += share * push
        A[U + i], A[V + i], A[W + i] = u, v, w
        A[X + i] += move * u
        A[Y + i] += move * v
        A[Z + i] += move * w


@njit(cache=True, error_model="numpy", fastmath=FAST)
def kick_with_friction_and_drift(A: Array, count: int, level: float, friction: float, time: float, move: float) -> None:
    """Do the same on a rough bed: Coulomb friction that sticks.

    The body is repeated from :func:`kick_contact_and_drift`: a shared function in the loop would hinder the compiler,
    and the
    roots and divisions of friction cost as much as all the rest.
    """
    for i in range(count):
        share = A[IZZ + i]
        fx = time * (A[TX + i] + A[FX + i] - A[FX + i - 1])
        fy = time * (A[TY + i] + A[FY + i] - A[FY + i - 1])
        fz = time * (A[TZ + i] + A[FZ + i] - A[FZ + i - 1])
        u = A[U + i] + A[IXX + i] * fx + A[IXY + i] * fy + A[IXZ + i] * fz
        v = A[V + i] + A[IXY + i] * fx + A[IYY + i] * fy + A[IYZ + i] * fz
        w = A[W + i] + A[IXZ + i] * fx + A[IYZ + i] * fy + share * fz
        depth = level - A[Z + i]
        # depth - time w replaces depth: a stiff bed then needs no smaller step
        grip = A[STIFF + i] * time + A[DAMP + i]
        push = time * (A[STIFF + i] * depth - grip * w) / (1.0 + time * grip * share)
        # contact is given by where the node would end: a hard bed stops it at its face instead of throwing it back
        push = push if depth > time * w else 0.0
        push = push if push > 0.0 else 0.0
        u += A[IXZ + i] * push
        v += A[IYZ + i] * push
        w += share * push
        light = A[IXX + i] if A[IXX + i] > A[IYY + i] else A[IYY + i]
        # the impulse that stops the node, or the one that friction can give
        speed, bound = math.sqrt(u * u + v * v) + TINY, friction * push
        stop = speed / (light + TINY)
        hold = (stop if stop < bound else bound) / speed
        px, py = hold * u, hold * v
        u, v = u - A[IXX + i] * px - A[IXY + i] * py, v - A[IXY + i] * px - A[IYY + i] * py
        A[U + i], A[V + i], A[W + i] = u, v, w
        A[X + i] += move * u
        A[Y + i] += move * v
        A[Z + i] += move * w


@njit(cache=True, error_model="numpy")
def kick_on_ground_and_drift(A: Array, count: int, bed: Array, friction: float, time: float, move: float) -> None:
    """Do the same on a bed that varies: spring and dashpot along its normal, friction across [eq:flexible-ground]."""
    for i in range(count):
        fx = time * (A[TX + i] + A[FX + i] - A[FX + i - 1])
        fy = time * (A[TY + i] + A[FY + i] - A[FY + i - 1])
        fz = time * (A[TZ + i] + A[FZ + i] - A[FZ + i - 1])
        u = A[U + i] + A[IXX + i] * fx + A[IXY + i] * fy + A[IXZ + i] * fz
        v = A[V + i] + A[IXY + i] * fx + A[IYY + i] * fy + A[IYZ + i] * fz
        w = A[W + i] + A[IXZ + i] * fx + A[IYZ + i] * fy + A[IZZ + i] * fz
        level, nx, ny, nz = ground(bed, A[X + i], A[Y + i])
        depth, out = (level - A[Z + i]) * nz, nx * u + ny * v + nz * w
        if depth > time * out and A[STIFF + i] > 0.0:
            # what an impulse along the normal does to the velocity
            gx = A[IXX + i] * nx + A[IXY + i] * ny + A[IXZ + i] * nz
            gy = A[IXY + i] * nx + A[IYY + i] * ny + A[IYZ + i] * nz
            gz = A[IXZ + i] * nx + A[IYZ + i] * ny + A[IZZ + i] * nz
            share = nx * gx + ny * gy + nz * gz
            grip = A[STIFF + i] * time + A[DAMP + i]
            push = max(time * (A[STIFF + i] * depth - grip * out) / (1.0 + time * grip * share), 0.0)
            u, v, w = u + gx * push, v + gy * push, w + gz * push
            if friction > 0.0:
                out = nx * u + ny * v + nz * w
                tx, ty, tz = u - out * nx, v - out * ny, w - out * nz
                # the lightest of two directions in the plane of the bed, one of them upright over the x axis
                size = math.sqrt(nx * nx + nz * nz)
                ax, az = nz / size, -nx / size
                bx, by, bz = ny * az, nz * ax - nx * az, -ny * ax
                one = A[IXX + i] * ax * ax + 2.0 * A[IXZ + i] * ax * az + A[IZZ + i] * az * az
                two = A[IXX + i] * bx * bx + A[IYY + i] * by * by + A[IZZ + i] * bz * bz
                two += 2.0 * (A[IXY + i] * bx * by + A[IXZ + i] * bx * bz + A[IYZ + i] * by * bz)
                speed = math.sqrt(tx * tx + ty * ty + tz * tz) + TINY
                hold = min(speed / (max(one, two) + TINY), friction * push) / speed
                px, py, pz = hold * tx, hold * ty, hold * tz
                u -= A[IXX + i] * px + A[IXY + i] * py + A[IXZ + i] * pz
                v -= A[IXY + i] * px + A[IYY + i] * py + A[IYZ + i] * pz
                w -= A[IXZ + i] * px + A[IYZ + i] * py + A[IZZ + i] * pz
        A[U + i], A[V + i], A[W + i] = u, v, w
        A[X + i] += move * u
        A[Y + i] += move * v
        A[Z + i] += move * w


@njit(cache=True, error_model="numpy", fastmath=FAST)
def drive(
    A: Array, driven: IntArray, rest: Array, tables: Array, start: float, step: float, now: float, time: float
) -> None:
    """Put driven nodes at their place at ``now``; their velocity is the mean over the last ``time``."""
    last = tables.shape[1] - 1
    place = (now - start) / step
    row = int(place)
    row = 0 if row < 0 else (last - 1 if row > last - 1 else row)
    s = place - row
    # cubic through displacement and velocity at both ends of the interval
    h1 = s * s * (3.0 - 2.0 * s)
    h2, h3 = s * (1.0 - s) * (1.0 - s) * step, s * s * (s - 1.0) * step
    per = 1.0 / time if time > 0.0 else 0.0
    for d in range(driven.shape[0]):
        node, table = driven[d, 0], driven[d, 1]
        for axis in range(3):
            p0, p1 = tables[table, row, axis], tables[table, row + 1, axis]
            v0, v1 = tables[table, row, 3 + axis], tables[table, row + 1, 3 + axis]
            target = rest[d, axis] + p0 + h1 * (p1 - p0) + h2 * v0 + h3 * v1
            if time > 0.0:
                # The step has carried the node on with its last velocity already: what is missing corrects it
                A[U + axis * ROW + node] += (target - A[X + axis * ROW + node]) * per
            A[X + axis * ROW + node] = target
