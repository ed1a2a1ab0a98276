"""Compiled kernels of sheets: forces of triangles with a tension field, their energy, loads of the water, stable step.

Positions, velocities and forces are flat arrays in which component ``a`` of node ``i`` stands at ``first + i * node +
a * axis``: one function serves arrays of shape (n, 3) (node 3, axis 1), (3, n) (node 1, axis n) and the rows of the
explicit scheme. Constants of the triangles are the columns named below; see :mod:`moyai.flexible.sheets`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit

#: Columns of the constants of triangles: inverse of the unstretched edges (2 x 2), area, stiffness C11, C12, C22, C33,
#: roots of the stiffness along warp and weft, what bends the compliance between them, damping time, law, added mass per
#: area across, displaced mass of a third, buoyancy of a third, rho/2 Cd, rho/2 Ct, pressure, factor on the water's
#: velocity.
E11, E12, E21, E22, AREA, C11, C12, C22, C33, WARP, WEFT, BEND, DAMPING, LAW, ADDED, DISPLACED, LIFT, ACROSS, SKIN = (
    range(19)
)
PRESSURE = 19
#: Unit normal as built, along which the added mass acts.
SHARE, FACE, COLUMNS = 20, 21, 24
#: Laws: stress also in compression; nearest tensile stress; two families of threads that only pull.
LINEAR, FIELD, THREADS = 0.0, 1.0, 2.0
#: Of twice the area a corner has a sixth; a division takes as long as six products.
_SIXTH = 1.0 / 6.0
#: Keeps the secular equation finite where a strain has no part along an axis.
SMALL = 1e-30
#: Change of its root at which Newton's next step, of the order of its square, is below rounding; steps at most.
NEAR, MOST_STEPS = 1e-8, 60


@njit(cache=True, error_model="numpy")
def tensile_stress(C: Any, t: int, e11: float, e22: float, shear: float) -> tuple[float, float, float, float, int]:
    """Return the stresses S11, S22, S12 [N/m], the energy per area [J/m2] and the state of a strained triangle.

    The stress is the tensile one nearest to that of the elastic law in the norm of its energy
    [eq:flexible-tension-field]. States: 0 slack, 1 wrinkled, 2 taut.
    """
    s11, s22 = C[t, C11] * e11 + C[t, C12] * e22, C[t, C12] * e11 + C[t, C22] * e22
    s12 = C[t, C33] * shear
    law = C[t, LAW]
    if law == LINEAR or (law == FIELD and s11 + s22 >= 0.0 and s11 * s22 >= s12 * s12):
        return s11, s22, s12, 0.5 * (s11 * e11 + s22 * e22 + s12 * shear), 2
    if law == THREADS:
        s11, s22 = max(s11, 0.0), max(s22, 0.0)
        state = (1 if s11 > 0.0 else 0) + (1 if s22 > 0.0 else 0)
        return s11, s22, 0.0, 0.5 * (s11 * e11 + s22 * e22), state
    # in axes stretched so that both families of threads are as stiff, along twice an angle: mean + half cos + turn sin
    warp, weft = C[t, WARP], C[t, WEFT]
    both = math.sqrt(warp * weft)
    mean, half, turn = 0.5 * (warp * e11 + weft * e22), 0.5 * (warp * e11 - weft * e22), 0.5 * both * shear
    if mean <= 0.0 and mean * mean >= half * half + turn * turn:
        return 0.0, 0.0, 0.0, 0.0, 0
    c, s = _direction(mean, half, turn, C[t, BEND])
    along = mean + half * c + turn * s
    pull = along / (1.0 + C[t, BEND] * s * s)
    return 0.5 * warp * pull * (1.0 + c), 0.5 * weft * pull * (1.0 - c), 0.5 * both * pull * s, 0.5 * pull * along, 1


@njit(cache=True, error_model="numpy")
def _direction(mean: float, half: float, turn: float, bend: float) -> tuple[float, float]:
    """Return cosine and sine of twice the angle of the pull that stores most [eq:flexible-wrinkle-direction].

    It lies in the quadrant of ``half`` and ``turn``. The root is approached from below, never passed.
    """
    small = SMALL * (abs(mean) + abs(half) + abs(turn))
    even, odd, shift = (1.0 + bend) * abs(half) + small, abs(turn) + small, bend * mean
    first, second, gap = (even, odd, shift) if shift >= 0.0 else (odd, even, -shift)
    root = max(first, second - gap)
    for _ in range(MOST_STEPS):
        one, two = 1.0 / root, 1.0 / (root + gap)
        x, y = first * one, second * two
        square = x * x + y * y
        step = square * (math.sqrt(square) - 1.0) / (x * x * one + y * y * two)
        root += step
        if abs(step) < NEAR * root:
            break
    x, y = first / root, second / (root + gap)
    c, s = (x, y) if shift >= 0.0 else (y, x)
    return math.copysign(c, half), math.copysign(s, turn)


@njit(cache=True, error_model="numpy")
def _strain_of_edges(
    C: Any, t: int, p0: float, p1: float, p2: float, r0: float, r1: float, r2: float, u0: float, u1: float, u2: float,
    w0: float, w1: float, w2: float, damping: float,
) -> tuple[float, float, float]:  # fmt: skip
    """Return Green's strain E11, E22, 2 E12 from two edges p, r, with ``damping`` times its rate from their rates u, w.

    Numbers by themselves stay in the registers of a processor, arrays do not.
    """
    a, b, c, d = C[t, E11], C[t, E12], C[t, E21], C[t, E22]
    f0, f1, f2 = p0 * a + r0 * c, p1 * a + r1 * c, p2 * a + r2 * c
    s0, s1, s2 = p0 * b + r0 * d, p1 * b + r1 * d, p2 * b + r2 * d
    e11, e22 = 0.5 * (f0 * f0 + f1 * f1 + f2 * f2 - 1.0), 0.5 * (s0 * s0 + s1 * s1 + s2 * s2 - 1.0)
    shear = f0 * s0 + f1 * s1 + f2 * s2
    if damping > 0.0:
        g0, g1, g2 = u0 * a + w0 * c, u1 * a + w1 * c, u2 * a + w2 * c
        h0, h1, h2 = u0 * b + w0 * d, u1 * b + w1 * d, u2 * b + w2 * d
        e11 += damping * (f0 * g0 + f1 * g1 + f2 * g2)
        e22 += damping * (s0 * h0 + s1 * h1 + s2 * h2)
        shear += damping * (f0 * h0 + s0 * g0 + (f1 * h1 + s1 * g1) + (f2 * h2 + s2 * g2))
    return e11, e22, shear


@njit(cache=True, error_model="numpy")
def _strain(C: Any, t: int, p: Any, q: Any, damping: float) -> tuple[float, float, float]:
    """Do the same from the two edges in one array ``p`` (6), their rates in ``q``."""
    return _strain_of_edges(
        C, t, p[0], p[1], p[2], p[3], p[4], p[5], q[0], q[1], q[2], q[3], q[4], q[5], damping
    )  # fmt: skip


@njit(cache=True, error_model="numpy")
def sheet_forces(
    C: Any, triangles: Any, P: Any, p0: int, V: Any, v0: int, F: Any, f0: int, node: int, axis: int, peak: Any
) -> None:  # fmt: skip
    """Add the forces of all triangles to ``F``; keep the highest principal pull of each in ``peak`` [N/m]."""
    up = 2 * axis
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t, 0] * node, triangles[t, 1] * node, triangles[t, 2] * node
        x, y, z = P[p0 + i], P[p0 + i + axis], P[p0 + i + up]
        px, py, pz = P[p0 + j] - x, P[p0 + j + axis] - y, P[p0 + j + up] - z
        rx, ry, rz = P[p0 + k] - x, P[p0 + k + axis] - y, P[p0 + k + up] - z
        x, y, z = V[v0 + i], V[v0 + i + axis], V[v0 + i + up]
        ux, uy, uz = V[v0 + j] - x, V[v0 + j + axis] - y, V[v0 + j + up] - z
        wx, wy, wz = V[v0 + k] - x, V[v0 + k + axis] - y, V[v0 + k + up] - z
        e11, e22, shear = _strain_of_edges(
            C, t, px, py, pz, rx, ry, rz, ux, uy, uz, wx, wy, wz, C[t, DAMPING]
        )  # fmt: skip
        s11, s22, s12, _, _ = tensile_stress(C, t, e11, e22, shear)
        a, b, c, d, area = C[t, E11], C[t, E12], C[t, E21], C[t, E22], C[t, AREA]
        gx, hx = _on_corners(px, rx, a, b, c, d, area, s11, s22, s12)
        gy, hy = _on_corners(py, ry, a, b, c, d, area, s11, s22, s12)
        gz, hz = _on_corners(pz, rz, a, b, c, d, area, s11, s22, s12)
        lx, ly, lz = -(gx + hx), -(gy + hy), -(gz + hz)
        if C[t, PRESSURE] != 0.0:
            push = C[t, PRESSURE] / 6.0
            x, y, z = push * (py * rz - pz * ry), push * (pz * rx - px * rz), push * (px * ry - py * rx)
            lx, ly, lz, gx, gy, gz, hx, hy, hz = (
                lx + x, ly + y, lz + z, gx + x, gy + y, gz + z, hx + x, hy + y, hz + z
            )  # fmt: skip
        mean, half = 0.5 * (s11 + s22), 0.5 * (s11 - s22)
        peak[t] = max(peak[t], mean + math.sqrt(half * half + s12 * s12))
        F[f0 + i] += lx
        F[f0 + i + axis] += ly
        F[f0 + i + up] += lz
        F[f0 + j] += gx
        F[f0 + j + axis] += gy
        F[f0 + j + up] += gz
        F[f0 + k] += hx
        F[f0 + k + axis] += hy
        F[f0 + k + up] += hz


@njit(cache=True, error_model="numpy")
def _on_corners(
    p: float, r: float, a: float, b: float, c: float, d: float, area: float, s11: float, s22: float, s12: float
) -> tuple[float, float]:  # fmt: skip
    """Return what the stress does at the second and the third corner along an axis, from the edges along it [N]."""
    one, two = p * a + r * c, p * b + r * d
    along, across = area * (one * s11 + two * s12), area * (one * s12 + two * s22)
    return -(along * a + across * b), -(along * c + across * d)


@njit(cache=True, error_model="numpy")
def pressure_forces(C: Any, triangles: Any, P: Any, p0: int, axis: int, F: Any) -> None:
    """Write what pressure alone does on the nodes to ``F`` (3, n); places stand one behind the other (node 1)."""
    p = np.empty(6)
    F[:, :] = 0.0
    for t in range(triangles.shape[0]):
        for a in range(3):
            step = p0 + a * axis
            p[a] = P[triangles[t, 1] + step] - P[triangles[t, 0] + step]
            p[3 + a] = P[triangles[t, 2] + step] - P[triangles[t, 0] + step]
        push = C[t, PRESSURE] / 6.0
        for k in range(3):
            m, n = (k + 1) % 3, (k + 2) % 3
            out = push * (p[m] * p[3 + n] - p[n] * p[3 + m])
            for corner in range(3):
                F[k, triangles[t, corner]] += out


@njit(cache=True, error_model="numpy")
def sheet_energy(C: Any, triangles: Any, P: Any, p0: int, node: int, axis: int) -> float:
    """Return the elastic energy of all triangles [J]."""
    p, q, total = np.empty(6), np.zeros(6), 0.0
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t, 0] * node, triangles[t, 1] * node, triangles[t, 2] * node
        for a in range(3):
            step = p0 + a * axis
            p[a], p[3 + a] = P[j + step] - P[i + step], P[k + step] - P[i + step]
        e11, e22, shear = _strain(C, t, p, q, 0.0)
        total += C[t, AREA] * tensile_stress(C, t, e11, e22, shear)[3]
    return total


@njit(cache=True, error_model="numpy")
def stress_field(C: Any, triangles: Any, place: Any, out: Any) -> None:
    """Write warp, weft and shear stress, both principal stresses [N/m] and the state of each triangle, shape (t, 6)."""
    p, q = np.empty(6), np.zeros(6)
    for t in range(triangles.shape[0]):
        for a in range(3):
            p[a] = place[triangles[t, 1], a] - place[triangles[t, 0], a]
            p[3 + a] = place[triangles[t, 2], a] - place[triangles[t, 0], a]
        e11, e22, shear = _strain(C, t, p, q, 0.0)
        s11, s22, s12, _, state = tensile_stress(C, t, e11, e22, shear)
        mean, half = 0.5 * (s11 + s22), 0.5 * (s11 - s22)
        size = math.sqrt(half * half + s12 * s12)
        out[t, 0], out[t, 1], out[t, 2], out[t, 3], out[t, 4], out[t, 5] = (
            s11,
            s22,
            s12,
            mean + size,
            mean - size,
            state,
        )


@njit(cache=True, error_model="numpy")
def wet_share(a: float, b: float, c: float) -> float:
    """Return the part of a triangle under the surface from the heights of its corners over it."""
    low, high = min(a, b, c), max(a, b, c)
    if high <= 0.0:
        return 1.0
    if low >= 0.0:
        return 0.0
    middle = a + b + c - low - high
    if middle <= 0.0:
        return 1.0 - high * high / ((high - low) * (high - middle))
    return low * low / ((middle - low) * (high - low))


@njit(cache=True, error_model="numpy")
def sheet_loads(
    C: Any, triangles: Any, P: Any, p0: int, V: Any, v0: int, W: Any, w0: int, F: Any, f0: int, node: int, axis: int,
    light: Any, ahead: float,
) -> float:  # fmt: skip
    """Add buoyancy, drag and inertia of moving water to ``F``; weight stands with the nodes.

    The drag of each corner takes its own relative velocity, across and along the triangle [eq:flexible-sheet-drag], the
    inertia the acceleration of the water there [eq:flexible-sheet-inertia].
    ``W`` holds velocity, acceleration and elevation of the water in the same layout; ``light`` (4, n) is one over the
    own mass of each node and over its mass along a horizontal axis [1/kg], and that axis. Returns the fastest rate at
    which drag damps a node [1/s].
    """
    fastest, up = 0.0, 2 * axis
    for t in range(triangles.shape[0]):
        i, j, k = triangles[t, 0] * node, triangles[t, 1] * node, triangles[t, 2] * node
        x, y, z = P[p0 + i], P[p0 + i + axis], P[p0 + i + up]
        second, third = P[p0 + j + up], P[p0 + k + up]
        wet = wet_share(z - W[w0 + i + 3 * up], second - W[w0 + j + 3 * up], third - W[w0 + k + 3 * up])
        if wet == 0.0:
            continue
        px, py, pz = P[p0 + j] - x, P[p0 + j + axis] - y, second - z
        rx, ry, rz = P[p0 + k] - x, P[p0 + k + axis] - y, third - z
        nx, ny, nz = py * rz - pz * ry, pz * rx - px * rz, px * ry - py * rx
        size = math.sqrt(nx * nx + ny * ny + nz * nz)
        per = 1.0 / size if size > 0.0 else 0.0
        nx, ny, nz = nx * per, ny * per, nz * per
        area, share = _SIXTH * wet * size, C[t, SHARE]
        across, skin = area * C[t, ACROSS], area * C[t, SKIN]
        fx, fy, fz = C[t, FACE], C[t, FACE + 1], C[t, FACE + 2]
        taken, displaced, lift = 2.0 * _SIXTH * wet * C[t, ADDED] * C[t, AREA], wet * C[t, DISPLACED], wet * C[t, LIFT]
        for corner in range(3):
            point = triangles[t, corner]
            base = point * node
            at, to = w0 + base, f0 + base
            ux, uy = share * W[at] - V[v0 + base], share * W[at + axis] - V[v0 + base + axis]
            uz = share * W[at + up] - V[v0 + base + up]
            along = ux * nx + uy * ny + uz * nz
            ux, uy, uz = ux - along * nx, uy - along * ny, uz - along * nz
            hold, slip_drag = across * abs(along), skin * math.sqrt(ux * ux + uy * uy + uz * uz)
            facing = nx * light[2, point] + ny * light[3, point]
            part = light[0, point] + (light[1, point] - light[0, point]) * facing * facing
            rate = 2.0 * max(hold * part, slip_drag * light[0, point])
            fastest = max(fastest, rate)
            quick = ahead * rate
            held = 1.0 / (1.0 + 0.4 * quick * quick * quick * quick)
            ax, ay, az = W[at + 3 * axis], W[at + 4 * axis], W[at + 5 * axis]
            rise = taken * (ax * fx + ay * fy + az * fz)
            push, pull = held * hold * along, held * slip_drag
            F[to] += push * nx + pull * ux + rise * fx + displaced * ax
            F[to + axis] += push * ny + pull * uy + rise * fy + displaced * ay
            F[to + up] += push * nz + pull * uz + rise * fz + displaced * az + lift
    return fastest


@njit(cache=True, error_model="numpy")
def sheet_added_mass(
    C: Any, triangles: Any, P: Any, p0: int, node: int, axis: int, W: Any, w0: int, place: int, row: int, M: Any,
    m0: int, block: int, part: int,
) -> None:  # fmt: skip
    """Add the water that triangles take along across themselves to the mass blocks (xx, xy, xz, yy, yz, zz) of nodes.

    Across is the direction as built: were it that of every fold of the mesh, mass would come and go with the folds.

    Elevations of the surface stand at ``w0 + place * i + 6 * row``, blocks at ``m0 + block * i + part * k``
    [eq:flexible-sheet-inertia].
    """
    for t in range(triangles.shape[0]):
        if C[t, ADDED] == 0.0:
            continue
        i, j, k = triangles[t, 0], triangles[t, 1], triangles[t, 2]
        up, top = p0 + 2 * axis, w0 + 6 * row
        wet = wet_share(
            P[up + i * node] - W[top + i * place], P[up + j * node] - W[top + j * place],
            P[up + k * node] - W[top + k * place],
        )  # fmt: skip
        x, y, z = C[t, FACE], C[t, FACE + 1], C[t, FACE + 2]
        scale = wet * C[t, ADDED] * C[t, AREA] / 3.0
        for corner in range(3):
            at = m0 + triangles[t, corner] * block
            M[at] += scale * x * x
            M[at + part] += scale * x * y
            M[at + 2 * part] += scale * x * z
            M[at + 3 * part] += scale * y * y
            M[at + 4 * part] += scale * y * z
            M[at + 5 * part] += scale * z * z


@njit(cache=True, error_model="numpy")
def sheet_stiffness(C: Any, triangles: Any, place: Any, stiff: Any, damp: Any) -> None:
    """Add a bound of the stiffness of every taut triangle to the 3x3 blocks of its nodes, shape (n, 6).

    The blocks are half of it, as those of a bar are: (sum y_a)^2 <= sum y_a^2 / w_a for shares w_a that add to one
    [eq:flexible-sheet-step]. The present pull counts with it: it stiffens the sheet in all directions.
    """
    p, still, block, share = np.empty(6), np.zeros(6), np.empty((3, 6)), np.empty(3)
    for t in range(triangles.shape[0]):
        a, b, c, d = C[t, E11], C[t, E12], C[t, E21], C[t, E22]
        for k in range(3):
            p[k] = place[k, triangles[t, 1]] - place[k, triangles[t, 0]]
            p[3 + k] = place[k, triangles[t, 2]] - place[k, triangles[t, 0]]
        e11, e22, shear = _strain(C, t, p, still, 0.0)
        s11, s22, s12, _, _ = tensile_stress(C, t, e11, e22, shear)
        # gathered cloth may be taut before the step is chosen again: its threads count with their full length
        one, two = 0.0, 0.0
        for k in range(3):
            fk, sk = p[k] * a + p[3 + k] * c, p[k] * b + p[3 + k] * d
            one += fk * fk
            two += sk * sk
        one, two = 1.0 / math.sqrt(min(max(one, 1e-12), 1.0)), 1.0 / math.sqrt(min(max(two, 1e-12), 1.0))
        whole = 0.0
        for corner in range(3):
            g, h = (-a - c, -b - d) if corner == 0 else ((a, b) if corner == 1 else (c, d))
            row, trace = 0, 0.0
            taut = max(0.0, g * g * s11 + h * h * s22 + 2.0 * g * h * s12)
            for k in range(3):
                fk, sk = one * (p[k] * a + p[3 + k] * c), two * (p[k] * b + p[3 + k] * d)
                for m in range(k, 3):
                    fm, sm = one * (p[m] * a + p[3 + m] * c), two * (p[m] * b + p[3 + m] * d)
                    value = C[t, C11] * g * g * fk * fm + C[t, C22] * h * h * sk * sm
                    value += C[t, C12] * g * h * (fk * sm + sk * fm)
                    value += C[t, C33] * (fk * h + sk * g) * (fm * h + sm * g)
                    block[corner, row] = C[t, AREA] * (value + taut if k == m else value)
                    if k == m:
                        trace += block[corner, row]
                    row += 1
            share[corner] = math.sqrt(max(trace, 0.0))
            whole += share[corner]
        for corner in range(3):
            if share[corner] <= 1e-9 * whole:
                continue
            factor = 0.5 * whole / share[corner]
            for row in range(6):
                stiff[triangles[t, corner], row] += factor * block[corner, row]
                damp[triangles[t, corner], row] += C[t, DAMPING] * factor * block[corner, row]
