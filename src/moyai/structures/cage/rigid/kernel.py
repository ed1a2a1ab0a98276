"""Compiled mechanics of the rigid cage: water motion at its parts, forces, accelerations, time stepping.

State: x, z of the centre of gravity, rotation theta (about +y, moves a point r by theta (rz, -rx)), and their rates.
One call graph in one file, so that compiled code on disk never goes stale.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.compiled import njit


class Packed(NamedTuple):
    """A cage, its lines and its water as flat arrays (SI); columns as the ``*_COLUMNS`` of :mod:`rigid_pack` say."""

    spheres: Array
    patches: Array
    rods: Array
    blocks: Array
    lines: Array
    body: Array
    water: Array
    current: Array
    components: Array
    normal_table: Array
    tangential_table: Array
    table_axis: Array
    series: Array
    centre: Array
    depth_parts: Array
    summed_at: Array
    summed: Array


@njit(cache=True, error_model="numpy", inline="always")
def _current_at(current: Array, z: float) -> float:
    """Interpolate the current [m/s] over rising heights; constant beyond the ends."""
    last = current.shape[1] - 1
    if last == 0 or z <= current[0, 0]:
        return current[1, 0]
    if z >= current[0, last]:
        return current[1, last]
    i = 0
    while current[0, i + 1] < z:
        i += 1
    share = (z - current[0, i]) / (current[0, i + 1] - current[0, i])
    return current[1, i] + share * (current[1, i + 1] - current[1, i])


@njit(cache=True, error_model="numpy")
def _water_at(p: Packed, t: float, x: float, z: float, out: Array) -> None:
    """Fill elevation, velocity and acceleration of the waves at a point [eq:cage-water].

    Kinematics above still water are those at still water (code 0) or stretched (code 2).
    """
    depth, ramp, stretching = p.water[2], p.water[3], p.water[4]
    grown = 1.0
    if ramp > 0.0 and t < ramp:
        grown = 0.5 * (1.0 - math.cos(math.pi * max(t, 0.0) / ramp))
    c = p.components
    count = c.shape[1]
    out[:] = 0.0
    if grown == 0.0 or count == 0:
        return
    level = z
    if stretching == 2.0:
        eta = 0.0
        for i in range(count):
            eta += c[2, i] * math.cos(c[6, i] * c[4, i] * x - c[0, i] * t + c[3, i])
        eta *= grown
        level = z - eta if math.isinf(depth) else (z - eta) * depth / (depth + eta)
    if level > 0.0:
        level = 0.0
    if level < -depth:
        level = -depth
    for i in range(count):
        number, sigma = c[4, i], c[1, i]
        angle = c[6, i] * number * x - c[0, i] * t + c[3, i]
        amplitude = grown * c[2, i]
        real, imaginary = amplitude * math.cos(angle), amplitude * math.sin(angle)
        lift = math.exp(number * level)
        # c[5] = e^{-2kh}: cosh and sinh of k(z + h) over sinh kh without growing exponentials
        below = c[5, i] / lift
        across, upward = (lift + below) / (1.0 - c[5, i]), (lift - below) / (1.0 - c[5, i])
        sense = c[6, i]
        out[0] += real
        out[1] += sense * sigma * across * real
        out[2] += sigma * upward * imaginary
        out[3] += sense * sigma * sigma * across * imaginary
        out[4] -= sigma * sigma * upward * real


@njit(cache=True, error_model="numpy")
def _centre_waves(p: Packed, x: float, z: float) -> None:
    """Move the middle of the series to a point: depth functions of every wave there, and nothing summed yet."""
    depth = p.water[2]
    z = min(max(z, -depth), 0.0)
    p.centre[0], p.centre[1] = x, z
    c = p.components
    for i in range(c.shape[1]):
        lift = math.exp(c[4, i] * z)
        below = c[5, i] / lift
        p.depth_parts[0, i] = (lift + below) / (1.0 - c[5, i])
        p.depth_parts[1, i] = (lift - below) / (1.0 - c[5, i])
    p.summed_at[:] = math.inf


@njit(cache=True, error_model="numpy")
def _sum_waves(p: Packed, number: float, out: Array) -> None:
    """Sum the waves at a time of the grid into the coefficients of their series [eq:cage-series-of-waves].

    Rows of ``out``: elevation, velocity u - i w (real, imaginary), acceleration (real, imaginary); then their rates.
    """
    reach, step = p.series[0], p.series[1]
    t = number * step
    c = p.components
    terms = out.shape[1]
    out[:] = 0.0
    for i in range(c.shape[1]):
        sense, sigma, omega = c[6, i], c[1, i], c[0, i]
        angle = sense * c[4, i] * p.centre[0] - omega * t + c[3, i]
        cosine, sine = c[2, i] * math.cos(angle), c[2, i] * math.sin(angle)
        across, upward = p.depth_parts[0, i], p.depth_parts[1, i]
        # cosine and sine of the complex phase s k (x + i (z + h)) - omega t + eps, over sinh kh
        c_real, c_imaginary = across * cosine, -sense * upward * sine
        s_real, s_imaginary = across * sine, sense * upward * cosine
        factor = 1.0
        speed = sense * sigma
        for n in range(terms):
            out[0, n] += factor * cosine
            out[1, n] += factor * speed * c_real
            out[2, n] += factor * speed * c_imaginary
            out[3, n] += factor * speed * sigma * s_real
            out[4, n] += factor * speed * sigma * s_imaginary
            out[5, n] += factor * omega * sine
            out[6, n] += factor * speed * omega * s_real
            out[7, n] += factor * speed * omega * s_imaginary
            out[8, n] -= factor * speed * sigma * omega * c_real
            out[9, n] -= factor * speed * sigma * omega * c_imaginary
            # next derivative along x + i z: cosine to minus sine, sine to cosine
            cosine, sine = -sine, cosine
            c_real, s_real = -s_real, c_real
            c_imaginary, s_imaginary = -s_imaginary, c_imaginary
            factor *= sense * c[4, i] * reach / (n + 1.0)


@njit(cache=True, error_model="numpy")
def _series_at(p: Packed, t: float, x: float, z: float, out: Array) -> None:
    """Fill the coefficients at a time for a cage at a place, between two times of the grid by Hermite's cubic."""
    step, margin, ramp = p.series[1], p.series[2], p.water[3]
    if not math.hypot(x - p.centre[0], min(max(z, -p.water[2]), 0.0) - p.centre[1]) <= margin:
        _centre_waves(p, x, z)
    slots = p.summed_at.size
    first = math.floor(t / step)
    for number in (first, first + 1):
        slot = int(number) % slots
        if p.summed_at[slot] != number:
            _sum_waves(p, float(number), p.summed[slot])
            p.summed_at[slot] = number
    low, high = p.summed[int(first) % slots], p.summed[int(first + 1) % slots]
    grown = 1.0
    if ramp > 0.0 and t < ramp:
        grown = 0.5 * (1.0 - math.cos(math.pi * max(t, 0.0) / ramp))
    s = t / step - first
    rest = 1.0 - s
    a, b = grown * rest * rest * (1.0 + 2.0 * s), grown * s * s * (3.0 - 2.0 * s)
    d, e = grown * step * s * rest * rest, -grown * step * s * s * rest
    for row in range(5):
        for n in range(out.shape[1]):
            out[row, n] = a * low[row, n] + b * high[row, n] + d * low[row + 5, n] + e * high[row + 5, n]


@njit(cache=True, error_model="numpy")
def _from_series(p: Packed, x: float, z: float, series: Array, out: Array) -> None:
    """Evaluate the series of the waves at a point."""
    reach, depth = p.series[0], p.water[2]
    terms = series.shape[1]
    along = (x - p.centre[0]) / reach
    eta = 0.0
    for n in range(terms - 1, -1, -1):
        eta = eta * along + series[0, n]
    level = z
    if p.water[4] == 2.0:
        level = z - eta if math.isinf(depth) else (z - eta) * depth / (depth + eta)
    up = (min(max(level, -depth), 0.0) - p.centre[1]) / reach
    u, w, first, second = 0.0, 0.0, 0.0, 0.0
    for n in range(terms - 1, -1, -1):
        u, w = u * along - w * up + series[1, n], u * up + w * along + series[2, n]
        first, second = first * along - second * up + series[3, n], first * up + second * along + series[4, n]
    out[0] = eta
    out[1], out[2], out[3], out[4] = u, -w, first, -second


@njit(cache=True, error_model="numpy", inline="always")
def _water(p: Packed, t: float, x: float, z: float, series: Array, out: Array) -> None:
    """Fill elevation, velocity and acceleration at a point, wave by wave or from their series."""
    if series.shape[1] > 0:
        _from_series(p, x, z, series, out)
    else:
        _water_at(p, t, x, z, out)


@njit(cache=True, error_model="numpy", inline="always")
def _wet(eta: float, z: float, half: float) -> float:
    """Share of a part of vertical half extent ``half`` that is under the surface."""
    if half <= 0.0:
        return 1.0 if eta > z else 0.0
    return min(1.0, max(0.0, 0.5 + 0.5 * (eta - z) / half))


@njit(cache=True, error_model="numpy", inline="always")
def _table(p: Packed, angle: float, speed: float) -> tuple[float, float]:
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
def line_state(p: Packed, number: int, y: Array, out: Array) -> None:
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
def _tautness(p: Packed, number: int, state: Array) -> float:
    """Return a force that is positive just when the line pulls [N]: the smaller of k e and k e + c e'."""
    elastic = p.lines[number, 5] * state[0]
    return min(elastic, elastic + p.lines[number, 6] * state[1])


@njit(cache=True, error_model="numpy")
def tension_of(p: Packed, number: int, y: Array, work: Array) -> float:
    """Return the tension of a line [N], zero when it is slack."""
    line_state(p, number, y, work)
    if _tautness(p, number, work) <= 0.0:
        return 0.0
    return p.lines[number, 5] * work[0] + p.lines[number, 6] * work[1]


@njit(cache=True, error_model="numpy")
def loads(p: Packed, t: float, y: Array, taut: Array, force: Array, mass: Array, work: Array) -> None:
    """Fill the generalised force without added mass terms in the accelerations, and the mass matrix [eq:cage-motion].

    ``taut`` says which lines pull: 1 pulls (its force may pass through zero within a step), 0 does not, -1: decide by
    the state.
    """
    density, gravity = p.water[0], p.water[1]
    vertical, constant_buoyancy = p.body[4], p.body[5]
    cosine, sine = math.cos(y[2]), math.sin(y[2])
    turn = y[5] * y[5]
    # many waves are summed into a series about the cage, few at every part
    series = np.empty((5, p.summed.shape[2]))
    if series.shape[1] > 0:
        _series_at(p, t, y[0], y[1], series)
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
        rx, rz = cosine * e[0] + sine * e[1], -sine * e[0] + cosine * e[1]
        x, z = y[0] + rx, y[1] + rz
        _water(p, t, x, z, series, work)
        radius = e[2]
        high = work[0] - z + radius
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
        wx, wz = work[1] + _current_at(p.current, z) - vx, work[2] - vz
        speed = math.sqrt(wx * wx + wz * wz)
        drag = 0.5 * density * e[4] * math.pi * radius * radius * e[3] * share * speed
        added = density * volume * e[6]
        fx = drag * wx + density * volume * e[5] * work[3] + added * turn * rx
        fz = drag * wz + density * volume * e[5] * work[4] + added * turn * rz
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
        rx, rz = cosine * e[0] + sine * e[1], -sine * e[0] + cosine * e[1]
        nx, nz = cosine * e[2] + sine * e[3], -sine * e[2] + cosine * e[3]
        x, z = y[0] + rx, y[1] + rz
        _water(p, t, x, z, series, work)
        share = 1.0 if weightless else _wet(work[0], z, e[6] * math.sqrt(max(0.0, 1.0 - nz * nz)))
        if share <= 0.0:
            continue
        vx, vz = y[3] + y[5] * rz, y[4] - y[5] * rx
        wx, wz = work[1] + e[10] * _current_at(p.current, z) - vx, work[2] - vz
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
        fx += density * volume * e[7] * work[3]
        fz += density * volume * e[7] * work[4]
        # added mass: both families of twines across the panel, half of their length along it
        first, second = density * volume * e[8], 0.5 * density * volume * e[8]
        ax, az = work[3] * e[9] + turn * rx, work[4] * e[9] + turn * rz
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
        rx, rz = cosine * e[0] + sine * e[1], -sine * e[0] + cosine * e[1]
        ex, ez = cosine * e[2] + sine * e[3], -sine * e[2] + cosine * e[3]
        x, z = y[0] + rx, y[1] + rz
        _water(p, t, x, z, series, work)
        share = 1.0 if weightless else _wet(work[0], z, 0.5 * (abs(ez) * e[4] / e[11] + e[5]))
        if share <= 0.0:
            continue
        vx, vz = y[3] + y[5] * rz, y[4] - y[5] * rx
        wx, wz = work[1] + _current_at(p.current, z) - vx, work[2] - vz
        along = wx * ex + wz * ez
        px, pz = wx - along * ex, wz - along * ez
        speed = math.sqrt(max(0.0, wx * wx + wz * wz - along * along))
        drag = 0.5 * density * e[7] * e[5] * e[4] * share * speed
        volume = e[6] * share
        added = density * volume * e[8]
        ax, az = work[3] * e[9] + turn * rx, work[4] * e[9] + turn * rz
        through = ax * ex + az * ez
        fx = drag * px + density * volume * e[10] * work[3] + added * (ax - through * ex)
        fz = drag * pz + density * volume * e[10] * work[4] + added * (az - through * ez)
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
        rx, rz = cosine * e[0] + sine * e[1], -sine * e[0] + cosine * e[1]
        _water(p, t, y[0] + rx, y[1] + rz, series, work)
        added = density * e[2] * e[4]
        fx = density * e[2] * e[3] * work[3] + added * turn * rx
        fz = density * e[2] * e[3] * work[4] + added * turn * rz
        vx, vz = y[3] + y[5] * rz, y[4] - y[5] * rx
        wx = work[1] + _current_at(p.current, y[1] + rz) - vx
        wz = work[2] - vz
        # force on an area by the law of the net at normal flow, each component with its own square
        normal, _ = _table(p, 0.0, abs(wx))
        fx += 0.5 * density * e[5] * normal * wx * abs(wx)
        normal, _ = _table(p, 0.0, abs(wz))
        fz += 0.5 * density * e[6] * normal * wz * abs(wz)
        _add(force, vertical, rx, rz, fx, fz)
        _add_mass(mass, rx, rz, added, 0.0, added)
    for i in range(p.lines.shape[0]):
        line_state(p, i, y, work)
        pulls = _tautness(p, i, work) > 0.0 if taut[i] < 0.0 else taut[i] > 0.0
        if pulls:
            tension = p.lines[i, 5] * work[0] + p.lines[i, 6] * work[1]
            _add(force, vertical, work[4], work[5], p.lines[i, 7] * tension * work[2], tension * work[3])
    # damping that settles a search for rest; zero in motion
    for i in range(3):
        force[i] -= p.body[6 + i] * y[3 + i]


@njit(cache=True, error_model="numpy")
def slope(p: Packed, t: float, y: Array, taut: Array, out: Array, force: Array, mass: Array, work: Array) -> None:
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


@njit(cache=True, error_model="numpy")
def march_fixed(
    p: Packed, t: float, y: Array, step: float, count: int, every: int, rows: Array, tension: Array, peak: Array
) -> int:
    """Runge-Kutta of fourth order with a fixed step; writes every ``every``-th state, returns the rows written."""
    size = y.size
    k = np.empty((4, size))
    stage = np.empty(size)
    force, mass, work = np.empty(3), np.empty((3, 3)), np.empty(6)
    taut = np.full(p.lines.shape[0], -1.0)
    written = 0
    for n in range(count + 1):
        for i in range(p.lines.shape[0]):
            pull = tension_of(p, i, y, work)
            row = min((n + every // 2) // every, rows.shape[0] - 1)
            peak[row, i] = max(peak[row, i], pull)
            if n % every == 0:
                tension[written, i] = pull
        if n % every == 0:
            rows[written] = y
            written += 1
        if n == count:
            break
        now = t + n * step
        slope(p, now, y, taut, k[0], force, mass, work)
        for i in range(size):
            stage[i] = y[i] + 0.5 * step * k[0, i]
        slope(p, now + 0.5 * step, stage, taut, k[1], force, mass, work)
        for i in range(size):
            stage[i] = y[i] + 0.5 * step * k[1, i]
        slope(p, now + 0.5 * step, stage, taut, k[2], force, mass, work)
        for i in range(size):
            stage[i] = y[i] + step * k[2, i]
        slope(p, now + step, stage, taut, k[3], force, mass, work)
        for i in range(size):
            y[i] += step / 6.0 * (k[0, i] + 2.0 * k[1, i] + 2.0 * k[2, i] + k[3, i])
        if not math.isfinite(y[0]):
            return -written
    return written


@njit(cache=True, error_model="numpy")
def _dense(share: float, step: float, y: Array, difference: Array, k: Array, fifth: Array, out: Array) -> None:
    """Evaluate the continuous extension of the Dormand-Prince pair, fourth order, at a share of the step."""
    rest = 1.0 - share
    for i in range(y.size):
        slope_part = step * k[0, i] - difference[i]
        last = difference[i] - step * k[6, i] - slope_part
        out[i] = y[i] + share * (difference[i] + rest * (slope_part + share * (last + rest * fifth[i])))


@njit(cache=True, error_model="numpy")
def _step(
    p: Packed, t: float, y: Array, h: float, taut: Array, k: Array, new: Array, stage: Array, work: Array
) -> None:
    """One step of the Dormand-Prince pair: ``k[0]`` is given, ``k[6]`` and the new state come back [eq:cage-pair]."""
    force, mass, wave = work[:3], work[3:12].reshape((3, 3)), work[12:18]
    size = y.size
    for i in range(size):
        stage[i] = y[i] + h * k[0, i] / 5.0
    slope(p, t + h / 5.0, stage, taut, k[1], force, mass, wave)
    for i in range(size):
        stage[i] = y[i] + h * (3.0 / 40.0 * k[0, i] + 9.0 / 40.0 * k[1, i])
    slope(p, t + 0.3 * h, stage, taut, k[2], force, mass, wave)
    for i in range(size):
        stage[i] = y[i] + h * (44.0 / 45.0 * k[0, i] - 56.0 / 15.0 * k[1, i] + 32.0 / 9.0 * k[2, i])
    slope(p, t + 0.8 * h, stage, taut, k[3], force, mass, wave)
    for i in range(size):
        stage[i] = y[i] + h * (
            19372.0 / 6561.0 * k[0, i]
            - 25360.0 / 2187.0 * k[1, i]
            + 64448.0 / 6561.0 * k[2, i]
            - 212.0 / 729.0 * k[3, i]
        )
    slope(p, t + 8.0 / 9.0 * h, stage, taut, k[4], force, mass, wave)
    for i in range(size):
        stage[i] = y[i] + h * (
            9017.0 / 3168.0 * k[0, i]
            - 355.0 / 33.0 * k[1, i]
            + 46732.0 / 5247.0 * k[2, i]
            + 49.0 / 176.0 * k[3, i]
            - 5103.0 / 18656.0 * k[4, i]
        )
    slope(p, t + h, stage, taut, k[5], force, mass, wave)
    for i in range(size):
        new[i] = y[i] + h * (
            35.0 / 384.0 * k[0, i]
            + 500.0 / 1113.0 * k[2, i]
            + 125.0 / 192.0 * k[3, i]
            - 2187.0 / 6784.0 * k[4, i]
            + 11.0 / 84.0 * k[5, i]
        )
    slope(p, t + h, new, taut, k[6], force, mass, wave)


@njit(cache=True, error_model="numpy")
def _switched(p: Packed, y: Array, taut: Array, work: Array) -> bool:
    """Whether a line pulls that did not at the start of the step, or the other way round."""
    for i in range(p.lines.shape[0]):
        line_state(p, i, y, work)
        if (_tautness(p, i, work) > 0.0) != (taut[i] > 0.0):
            return True
    return False


@njit(cache=True, error_model="numpy")
def _decide(p: Packed, y: Array, taut: Array, work: Array) -> None:
    for i in range(p.lines.shape[0]):
        line_state(p, i, y, work)
        taut[i] = 1.0 if _tautness(p, i, work) > 0.0 else 0.0


@njit(cache=True, error_model="numpy")
def _note_peaks(
    p: Packed, t: float, y: Array, begin: float, spacing: float, peak: Array, total: Array, work: Array
) -> None:
    row = int((t - begin) / spacing + 0.5)
    if row < 0 or row >= peak.shape[0]:
        return
    for i in range(p.lines.shape[0]):
        pull = tension_of(p, i, y, work)
        peak[row, i] = max(peak[row, i], pull)
        total[i] = max(total[i], pull)


@njit(cache=True, error_model="numpy")
def march(
    p: Packed,
    t: float,
    end: float,
    y: Array,
    first_step: float,
    longest: float,
    longest_taut: float,
    tolerance: float,
    scale: Array,
    begin: float,
    spacing: float,
    rows: Array,
    tension: Array,
    peak: Array,
    counts: NDArray[np.int64],
) -> tuple[float, float]:
    """Adaptive Dormand-Prince steps from ``t`` to ``end`` that land where a line goes taut or slack [eq:cage-event].

    Parameters
    ----------
    t, end : float
        [s].
    y : array, shape (6,)
        State, changed in place.
    first_step, longest, longest_taut : float
        First step, longest steps with slack lines and with taut ones [s].
    tolerance : float
        Local error allowed, of ``scale`` plus the size of the state.
    scale : array, shape (6,)
        Natural size of each state.
    begin, spacing : float
        Row ``i`` of the output belongs to ``begin + i spacing`` [s].
    rows, tension, peak : array
        Output: state, tension and largest tension around every row.
    counts : array of int, shape (4,)
        Raised by: steps taken, steps refused, events, evaluations.

    Returns
    -------
    float, float
        Time reached (before ``end`` when the step shrank to nothing or the motion left all bounds), next step [s].
    """
    size = y.size
    lines = p.lines.shape[0]
    k = np.empty((7, size))
    new, stage, difference, fifth, between = (
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
        np.empty(size),
    )
    work, wave = np.empty(18), np.empty(6)
    taut, total = np.empty(lines), np.zeros(lines)
    _decide(p, y, taut, wave)
    force, mass = work[:3], work[3:12].reshape((3, 3))
    slope(p, t, y, taut, k[0], force, mass, work[12:18])
    h = min(first_step, longest)
    row = math.ceil((t - begin) / spacing - 1e-9)
    checks = 6
    while t < end * (1.0 - 1e-15):
        most = longest
        for i in range(lines):
            if taut[i] > 0.0:
                most = longest_taut
        h = min(h, end - t, most)
        if h < 1e-13 * max(abs(end), 1.0) or abs(y[3]) + abs(y[4]) > 1e2 * scale[3]:
            # a hundred times the speed of free fall through the cage: it has left all bounds
            return t, h
        _step(p, t, y, h, taut, k, new, stage, work)
        counts[3] += 6
        error = 0.0
        for i in range(size):
            estimate = h * (
                71.0 / 57600.0 * k[0, i]
                - 71.0 / 16695.0 * k[2, i]
                + 71.0 / 1920.0 * k[3, i]
                - 17253.0 / 339200.0 * k[4, i]
                + 22.0 / 525.0 * k[5, i]
                - 1.0 / 40.0 * k[6, i]
            )
            error += (estimate / (tolerance * (scale[i] + abs(y[i])))) ** 2
        error = math.sqrt(error / size)
        if not error <= 1.0:
            counts[1] += 1
            h *= max(0.2, 0.9 * error**-0.2) if error < 1e30 else 0.2
            continue
        for i in range(size):
            difference[i] = new[i] - y[i]
            fifth[i] = h * (
                -12715105075.0 / 11282082432.0 * k[0, i]
                + 87487479700.0 / 32700410799.0 * k[2, i]
                - 10690763975.0 / 1880347072.0 * k[3, i]
                + 701980252875.0 / 199316789632.0 * k[4, i]
                - 1453857185.0 / 822651844.0 * k[5, i]
                + 69997945.0 / 29380423.0 * k[6, i]
            )
        # where within the step a line goes taut or slack first, if at all
        share = 1.0
        low = 0.0
        happened = False
        for n in range(1, checks + 1):
            at = n / checks
            if n == checks:
                between[:] = new
            else:
                _dense(at, h, y, difference, k, fifth, between)
            if _switched(p, between, taut, wave):
                happened, share = True, at
                break
            low = at
        if happened:
            counts[2] += 1
            for _ in range(60):
                if (share - low) * h < 1e-12:
                    break
                middle = 0.5 * (low + share)
                _dense(middle, h, y, difference, k, fifth, between)
                if _switched(p, between, taut, wave):
                    share = middle
                else:
                    low = middle
        reached = t + share * h
        while row < rows.shape[0] and begin + row * spacing <= reached + 1e-12:
            at = min(1.0, max(0.0, (begin + row * spacing - t) / h))
            _dense(at, h, y, difference, k, fifth, between)
            rows[row] = between
            for i in range(lines):
                tension[row, i] = tension_of(p, i, between, wave)
            row += 1
        for n in range(1, checks + 1):
            at = share * n / checks
            _dense(at, h, y, difference, k, fifth, between)
            _note_peaks(p, t + at * h, between, begin, spacing, peak, total, wave)
        counts[0] += 1
        grow = 5.0 if error < 1e-12 else min(5.0, max(0.2, 0.9 * error**-0.2))
        if happened and share < 1.0:
            _dense(share, h, y, difference, k, fifth, between)
            y[:] = between
        else:
            y[:] = new
        t = reached
        if happened:
            # the rates jump or bend here: begin afresh on the other side
            _decide(p, y, taut, wave)
            slope(p, t, y, taut, k[0], force, mass, work[12:18])
            counts[3] += 1
        else:
            k[0] = k[6]
        h *= grow
    return t, h
