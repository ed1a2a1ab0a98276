"""Compiled forces on a rigid cage, and its accelerations.

State: x, z of the centre of gravity, rotation theta (about +y, moves a point r by theta (rz, -rx)), and their rates.
"""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.structures.cage.rigid.water_kernel import (
    POINT_ROWS,
    TILE,
    PackedCage,
    X,
    Z,
    current_at,
    fill_series,
    water_motion,
)


@njit(cache=True, error_model="numpy", inline="always")
def _wet(eta: float, z: float, half: float) -> float:
    """Share of a part of vertical half extent ``half`` that is under the surface."""
    if half <= 0.0:
        return 1.0 if eta > z else 0.0
    return min(1.0, max(0.0, 0.5 + 0.5 * (eta - z) / half))


@njit(cache=True, error_model="numpy", inline="always")
def _table(p: PackedCage, angle: float, speed: float) -> tuple[float, float]:
    """Interpolate both coefficients of the net over angle and logarithm of the speed."""
    rows, columns = p.normal_table.shape
    place = angle * (rows - 1) / (0.5 * math.pi)
    i = min(int(place), rows - 2)
    a = place - i
    along = (math.log10(max(speed, 1e-12)) - p.table_axis[0]) / p.table_axis[1]
    along = min(max(along, 0.0), columns - 1.0)
    j = min(int(along), columns - 2)
    b = along - j
    n, s = p.normal_table, p.tangential_table
    first, second, third, fourth = (1.0 - a) * (1.0 - b), (1.0 - a) * b, a * (1.0 - b), a * b
    normal = first * n[i, j] + second * n[i, j + 1] + third * n[i + 1, j] + fourth * n[i + 1, j + 1]
    along_panel = first * s[i, j] + second * s[i, j + 1] + third * s[i + 1, j] + fourth * s[i + 1, j + 1]
    return normal, along_panel


@njit(cache=True, error_model="numpy", inline="always")
def _add(force: Array, vertical: float, rx: float, rz: float, fx: float, fz: float) -> None:
    """Add a force at r; ``vertical`` is the share of vertical forces that the moment counts (1; literal: 0)."""
    force[0] += fx
    force[1] += fz
    force[2] += fx * rz - vertical * fz * rx


@njit(cache=True, error_model="numpy", inline="always")
def _add_mass(mass: Array, rx: float, rz: float, axx: float, axz: float, azz: float) -> None:
    """Add the inertia of a part at r, a symmetric 2 x 2 tensor, to the 3 x 3 matrix [eq:cage-added-mass]."""
    tx, tz = axx * rz - axz * rx, axz * rz - azz * rx
    mass[0, 0] += axx
    mass[0, 1] += axz
    mass[1, 0] += axz
    mass[1, 1] += azz
    mass[0, 2] += tx
    mass[2, 0] += tx
    mass[1, 2] += tz
    mass[2, 1] += tz
    mass[2, 2] += tx * rz - tz * rx


@njit(cache=True, error_model="numpy")
def line_state(p: PackedCage, number: int, y: Array, out: Array) -> None:
    """Fill stretch [m], rate of stretch [m/s], unit vector body to anchor, arm of the attachment [eq:cage-line]."""
    cosine, sine = math.cos(y[2]), math.sin(y[2])
    line = p.lines[number]
    rx, rz = cosine * line[0] + sine * line[1], -sine * line[0] + cosine * line[1]
    dx, dz = line[2] - (y[0] + rx), line[3] - (y[1] + rz)
    length = math.sqrt(dx * dx + dz * dz)
    ex, ez = dx / length, dz / length
    vx, vz = y[3] + y[5] * rz, y[4] - y[5] * rx
    out[0] = length - line[4]
    out[1] = -(vx * ex + vz * ez)
    out[2], out[3], out[4], out[5] = ex, ez, rx, rz


@njit(cache=True, error_model="numpy", inline="always")
def tautness(p: PackedCage, number: int, state: Array) -> float:
    """Return a force that is positive just when the line pulls [N]: the smaller of k e and k e + c e'."""
    elastic = p.lines[number, 5] * state[0]
    return min(elastic, elastic + p.lines[number, 6] * state[1])


@njit(cache=True, error_model="numpy")
def tension_of(p: PackedCage, number: int, y: Array, work: Array) -> float:
    """Return the tension of a line [N], zero when it is slack."""
    line_state(p, number, y, work)
    if tautness(p, number, work) <= 0.0:
        return 0.0
    return p.lines[number, 5] * work[0] + p.lines[number, 6] * work[1]


@njit(cache=True, error_model="numpy", inline="always")
def _place_arms(parts: Array, first: int, cosine: float, sine: float, out: Array) -> int:
    """Turn the arms of parts into site axes, from column ``first``; return the next column."""
    for i in range(parts.shape[0]):
        out[5, first + i] = cosine * parts[i, 0] + sine * parts[i, 1]
        out[6, first + i] = -sine * parts[i, 0] + cosine * parts[i, 1]
    return first + parts.shape[0]


@njit(cache=True, error_model="numpy")
def water_at_parts(p: PackedCage, t: float, y: Array, cosine: float, sine: float) -> Array:
    """Return elevation, velocity, acceleration of the water at all parts and their arms, shape (7, parts).

    Parts in the order of spheres, patches, rods and blocks.
    """
    count = p.spheres.shape[0] + p.patches.shape[0] + p.rods.shape[0] + p.blocks.shape[0]
    out = np.empty((POINT_ROWS, count))
    first = _place_arms(p.spheres, 0, cosine, sine, out)
    first = _place_arms(p.patches, first, cosine, sine, out)
    first = _place_arms(p.rods, first, cosine, sine, out)
    _place_arms(p.blocks, first, cosine, sine, out)
    # many waves are summed into a series about the cage, few at every part
    series = np.empty((5, p.summed.shape[2]))
    if series.shape[1] > 0:
        fill_series(p, t, y[0], y[1], series)
    points = np.empty(POINT_ROWS * TILE)
    for begin in range(0, count, TILE):
        size = min(TILE, count - begin)
        for i in range(size):
            points[X + i], points[Z + i] = y[0] + out[5, begin + i], y[1] + out[6, begin + i]
        water_motion(p, t, points, size, series)
        for row in range(5):
            for i in range(size):
                out[row, begin + i] = points[row * TILE + i]
    return out


@njit(cache=True, error_model="numpy")
def loads(p: PackedCage, t: float, y: Array, taut: Array, force: Array, mass: Array, work: Array) -> None:
    """Fill the generalised force without added mass terms in the accelerations, and the mass matrix [eq:cage-motion].

    ``taut`` says which lines pull: 1 pulls (its force may pass through zero within a step), 0 does not, -1: decide by
    the state.
    """
    density, gravity = p.water[0], p.water[1]
    vertical, constant_buoyancy = p.body[4], p.body[5]
    cosine, sine = math.cos(y[2]), math.sin(y[2])
    turn = y[5] * y[5]
    at = water_at_parts(p, t, y, cosine, sine)
    part = -1
    force[:] = 0.0
    mass[:] = 0.0
    mass[0, 0] = mass[1, 1] = p.body[0]
    mass[2, 2] = p.body[1]
    force[1] -= p.body[2]
    if constant_buoyancy >= 0.0:
        force[1] += constant_buoyancy
    weightless = constant_buoyancy >= 0.0
    for i in range(p.spheres.shape[0]):
        e = p.spheres[i]
        part += 1
        rx, rz = at[5, part], at[6, part]
        z = y[1] + rz
        radius = e[2]
        high = at[0, part] - z + radius
        if high <= 0.0 and not weightless:
            continue
        if high >= 2.0 * radius or weightless:
            volume, plane = 4.0 / 3.0 * math.pi * radius**3, 0.0
        else:
            volume = math.pi * high * high * (radius - high / 3.0)
            plane = math.pi * high * (2.0 * radius - high)
        share = volume / (4.0 / 3.0 * math.pi * radius**3)
        volume *= e[3]
        plane *= e[3]
        vx, vz = y[3] + y[5] * rz, y[4] - y[5] * rx
        wx, wz = at[1, part] + current_at(p.current, z) - vx, at[2, part] - vz
        speed = math.sqrt(wx * wx + wz * wz)
        drag = 0.5 * density * e[4] * math.pi * radius * radius * e[3] * share * speed
        added = density * volume * e[6]
        fx = drag * wx + density * volume * e[5] * at[3, part] + added * turn * rx
        fz = drag * wz + density * volume * e[5] * at[4, part] + added * turn * rz
        # kinetic energy of the water that goes along changes with the depth of immersion [eq:cage-immersion]
        changing = density * plane * e[6]
        fx += changing * wz * wx
        fz += changing * (wz * wz - 0.5 * speed * speed)
        if not weightless:
            fz += density * gravity * volume
        _add(force, vertical, rx, rz, fx, fz)
        _add_mass(mass, rx, rz, added, 0.0, added)
    for i in range(p.patches.shape[0]):
        e = p.patches[i]
        part += 1
        rx, rz = at[5, part], at[6, part]
        nx, nz = cosine * e[2] + sine * e[3], -sine * e[2] + cosine * e[3]
        z = y[1] + rz
        share = 1.0 if weightless else _wet(at[0, part], z, e[6] * math.sqrt(max(0.0, 1.0 - nz * nz)))
        if share <= 0.0:
            continue
        vx, vz = y[3] + y[5] * rz, y[4] - y[5] * rx
        wx, wz = at[1, part] + e[10] * current_at(p.current, z) - vx, at[2, part] - vz
        across = wx * nx + wz * nz
        tx, tz = wx - across * nx, wz - across * nz
        along_squared = max(0.0, wx * wx + wz * wz - across * across)
        speed_squared = across * across + along_squared
        fx = fz = 0.0
        if speed_squared > 1e-20:
            along = math.sqrt(along_squared)
            # a side wall lies along the plane of motion: nothing passes it
            angle = math.atan2(along, abs(across)) if across != 0.0 else 0.5 * math.pi
            normal, tangential = _table(p, angle, math.sqrt(speed_squared))
            head = 0.5 * density * e[4] * share * speed_squared
            sign = 1.0 if across >= 0.0 else -1.0
            fx, fz = head * normal * sign * nx, head * normal * sign * nz
            if along > 1e-10:
                fx += head * tangential * tx / along
                fz += head * tangential * tz / along
        volume = e[5] * share
        fx += density * volume * e[7] * at[3, part]
        fz += density * volume * e[7] * at[4, part]
        # added mass: both families of twines across the panel, half of their length along it
        first, second = density * volume * e[8], 0.5 * density * volume * e[8]
        ax, az = at[3, part] * e[9] + turn * rx, at[4, part] * e[9] + turn * rz
        through = ax * nx + az * nz
        fx += second * ax + (first - second) * through * nx
        fz += second * az + (first - second) * through * nz
        # the added mass turns with the panel: rate of its impulse, and the couple of its axes [eq:cage-turning]
        turning = first - second
        swept = y[5] * (wx * nz - wz * nx)
        fx += turning * (swept * nx + across * y[5] * nz)
        fz += turning * (swept * nz - across * y[5] * nx)
        force[2] += turning * across * (wx * nz - wz * nx)
        if not weightless:
            fz += density * gravity * volume
        _add(force, vertical, rx, rz, fx, fz)
        body = (first - second) * nx
        _add_mass(mass, rx, rz, second + body * nx, body * nz, second + (first - second) * nz * nz)
    for i in range(p.rods.shape[0]):
        e = p.rods[i]
        part += 1
        rx, rz = at[5, part], at[6, part]
        ex, ez = cosine * e[2] + sine * e[3], -sine * e[2] + cosine * e[3]
        z = y[1] + rz
        share = 1.0 if weightless else _wet(at[0, part], z, 0.5 * (abs(ez) * e[4] / e[11] + e[5]))
        if share <= 0.0:
            continue
        vx, vz = y[3] + y[5] * rz, y[4] - y[5] * rx
        wx, wz = at[1, part] + current_at(p.current, z) - vx, at[2, part] - vz
        along = wx * ex + wz * ez
        px, pz = wx - along * ex, wz - along * ez
        speed = math.sqrt(max(0.0, wx * wx + wz * wz - along * along))
        drag = 0.5 * density * e[7] * e[5] * e[4] * share * speed
        volume = e[6] * share
        added = density * volume * e[8]
        ax, az = at[3, part] * e[9] + turn * rx, at[4, part] * e[9] + turn * rz
        through = ax * ex + az * ez
        fx = drag * px + density * volume * e[10] * at[3, part] + added * (ax - through * ex)
        fz = drag * pz + density * volume * e[10] * at[4, part] + added * (az - through * ez)
        swept = y[5] * (wx * ez - wz * ex)
        fx -= added * (swept * ex + along * y[5] * ez)
        fz -= added * (swept * ez - along * y[5] * ex)
        force[2] -= added * along * (wx * ez - wz * ex)
        if not weightless:
            fz += density * gravity * volume
        _add(force, vertical, rx, rz, fx, fz)
        _add_mass(mass, rx, rz, added * (1.0 - ex * ex), -added * ex * ez, added * (1.0 - ez * ez))
    for i in range(p.blocks.shape[0]):
        e = p.blocks[i]
        part += 1
        rx, rz = at[5, part], at[6, part]
        added = density * e[2] * e[4]
        fx = density * e[2] * e[3] * at[3, part] + added * turn * rx
        fz = density * e[2] * e[3] * at[4, part] + added * turn * rz
        vx, vz = y[3] + y[5] * rz, y[4] - y[5] * rx
        wx = at[1, part] + current_at(p.current, y[1] + rz) - vx
        wz = at[2, part] - vz
        # force on an area by the law of the net at normal flow, each component with its own square
        normal, _ = _table(p, 0.0, abs(wx))
        fx += 0.5 * density * e[5] * normal * wx * abs(wx)
        normal, _ = _table(p, 0.0, abs(wz))
        fz += 0.5 * density * e[6] * normal * wz * abs(wz)
        _add(force, vertical, rx, rz, fx, fz)
        _add_mass(mass, rx, rz, added, 0.0, added)
    for i in range(p.lines.shape[0]):
        line_state(p, i, y, work)
        pulls = tautness(p, i, work) > 0.0 if taut[i] < 0.0 else taut[i] > 0.0
        if pulls:
            tension = p.lines[i, 5] * work[0] + p.lines[i, 6] * work[1]
            _add(force, vertical, work[4], work[5], p.lines[i, 7] * tension * work[2], tension * work[3])
    # damping that settles a search for rest; zero in motion
    for i in range(3):
        force[i] -= p.body[6 + i] * y[3 + i]


@njit(cache=True, error_model="numpy")
def slope(p: PackedCage, t: float, y: Array, taut: Array, out: Array, force: Array, mass: Array, work: Array) -> None:
    """Fill the rates of the state: velocities and the solution of the 3 x 3 system."""
    loads(p, t, y, taut, force, mass, work)
    out[0], out[1], out[2] = y[3], y[4], y[5]
    a, b, c = mass[0, 0], mass[0, 1], mass[0, 2]
    d, e, f = mass[1, 1], mass[1, 2], mass[2, 2]
    # inverse of a symmetric matrix by its adjoint
    ia, ib, ic = d * f - e * e, c * e - b * f, b * e - c * d
    id_, ie, if_ = a * f - c * c, b * c - a * e, a * d - b * b
    determinant = a * ia + b * ib + c * ic
    out[3] = (ia * force[0] + ib * force[1] + ic * force[2]) / determinant
    out[4] = (ib * force[0] + id_ * force[1] + ie * force[2]) / determinant
    out[5] = (ic * force[0] + ie * force[1] + if_ * force[2]) / determinant
