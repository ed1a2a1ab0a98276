"""Compiled step of a rigid body in six degrees of freedom: arrays in, arrays out.

State: place of the centre of gravity (3), unit quaternion body to site (4), velocity in site axes (3), spin in body
axes (3). One step is the classical fourth-order Runge-Kutta method, joined with its exponential form for the states of
the memory as in :mod:`moyai.floating.kernel` [eq:floating-etd]. Equations: [eq:coupled-newton-euler],
[eq:coupled-added-mass], [eq:coupled-lumps].
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit


@njit(cache=True, error_model="numpy")
def rotation_of(q: Any, r: Any) -> None:
    """Write the rotation matrix of a quaternion (scalar first, any length)."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    s = 2.0 / (w * w + x * x + y * y + z * z)
    r[0, 0], r[0, 1], r[0, 2] = 1.0 - s * (y * y + z * z), s * (x * y - w * z), s * (x * z + w * y)
    r[1, 0], r[1, 1], r[1, 2] = s * (x * y + w * z), 1.0 - s * (x * x + z * z), s * (y * z - w * x)
    r[2, 0], r[2, 1], r[2, 2] = s * (x * z - w * y), s * (y * z + w * x), 1.0 - s * (x * x + y * y)


@njit(cache=True, error_model="numpy")
def _to_site(r: Any, v: Any, out: Any) -> None:
    for i in range(3):
        out[i] = r[i, 0] * v[0] + r[i, 1] * v[1] + r[i, 2] * v[2]


@njit(cache=True, error_model="numpy")
def _to_body(r: Any, v: Any, out: Any) -> None:
    for i in range(3):
        out[i] = r[0, i] * v[0] + r[1, i] * v[1] + r[2, i] * v[2]


@njit(cache=True, error_model="numpy")
def _add_cross(a: Any, b: Any, sign: float, out: Any) -> None:
    out[0] += sign * (a[1] * b[2] - a[2] * b[1])
    out[1] += sign * (a[2] * b[0] - a[0] * b[2])
    out[2] += sign * (a[0] * b[1] - a[1] * b[0])


@njit(cache=True, error_model="numpy")
def points_of(state: Any, arms: Any, place: Any, velocity: Any) -> None:
    """Write place and velocity of points given by their arms from the centre of gravity in body axes."""
    r, arm, speed = np.empty((3, 3)), np.empty(3), np.empty(3)
    rotation_of(state[3:7], r)
    for p in range(arms.shape[0]):
        _to_site(r, arms[p], arm)
        speed[:] = 0.0
        _add_cross(state[10:13], arms[p], 1.0, speed)
        for i in range(3):
            place[p, i] = state[i] + arm[i]
            velocity[p, i] = state[7 + i] + r[i, 0] * speed[0] + r[i, 1] * speed[1] + r[i, 2] * speed[2]


@njit(cache=True, error_model="numpy")
def _immersion(height: float, size: float, length: float, upright: float, elevation: float) -> float:
    """Return the immersed part of a column whose centre stands ``height`` high [eq:coupled-lumps]."""
    if length == 0.0:
        return 1.0
    # along its axis while that is steep, over its breadth once it lies
    half = 0.5 * max(length * abs(upright), size * math.sqrt(max(0.0, 1.0 - upright * upright)))
    # a line without breadth that lies in the surface is half wet
    return min(max((elevation - height + half) / (2.0 * half) if half > 0.0 else 0.5, 0.0), 1.0)


@njit(cache=True, error_model="numpy")
def _lump_loads(state: Any, r: Any, lumps: Any, water: Any, fluid: Any, force: Any, mass: Any) -> None:
    """Add the loads of all lumps in body axes about the centre of gravity, and their added mass."""
    place, volume, length, size, drag, added, axis = lumps
    rho, gravity = fluid[0], fluid[1]
    arm, speed, flow, pull, turn, w = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3), state[10:13]
    body_speed, more = np.empty(3), np.empty(3)
    _to_body(r, state[7:10], body_speed)
    for k in range(place.shape[0]):
        height = state[2] + r[2, 0] * place[k, 0] + r[2, 1] * place[k, 1] + r[2, 2] * place[k, 2]
        part = _immersion(height, size[k], length[k], r[2, 2], water[6, k])
        if part <= 0.0:
            continue
        arm[:] = place[k]
        if length[k] > 0.0:
            # the wet end of the column is the lower one
            arm[2] -= (0.5 if r[2, 2] >= 0.0 else -0.5) * (1.0 - part) * length[k]
        speed[:] = body_speed
        _add_cross(w, arm, 1.0, speed)
        _to_body(r, water[0:3, k], flow)
        _to_body(r, water[3:6, k], pull)
        # acceleration of the point that does not come from the unknowns: w x (w x arm)
        turn[:], more[:] = 0.0, 0.0
        _add_cross(w, arm, 1.0, turn)
        _add_cross(w, turn, 1.0, more)
        flow[0], flow[1], flow[2] = flow[0] - speed[0], flow[1] - speed[1], flow[2] - speed[2]
        square = flow[0] * flow[0] + flow[1] * flow[1] + flow[2] * flow[2]
        along = flow[axis[k]] * flow[axis[k]] if axis[k] >= 0 else 0.0
        across = math.sqrt(max(square - along, 0.0))
        for i in range(3):
            inertia = part * (rho * volume[k] * pull[i] + added[k, i] * (pull[i] - more[i]))
            lift = part * rho * volume[k] * gravity * r[2, i]
            meets = abs(flow[i]) if i == axis[k] else across
            pull[i] = inertia + part * 0.5 * rho * drag[k, i] * meets * flow[i] + lift
        for i in range(3):
            force[i] += pull[i]
        _add_cross(arm, pull, 1.0, force[3:6])
        # added mass of a point with an arm: rows of the motion of the point
        for i in range(3):
            a = part * added[k, i]
            if a > 0.0:
                j, m = (i + 1) % 3, (i + 2) % 3
                # component i of (ang x arm) = ang_j arm_m - ang_m arm_j
                mass[i, i] += a
                mass[i, 3 + j] += a * arm[m]
                mass[i, 3 + m] -= a * arm[j]
                mass[3 + j, i] += a * arm[m]
                mass[3 + m, i] -= a * arm[j]
                mass[3 + j, 3 + j] += a * arm[m] * arm[m]
                mass[3 + m, 3 + m] += a * arm[j] * arm[j]
                mass[3 + j, 3 + m] -= a * arm[m] * arm[j]
                mass[3 + m, 3 + j] -= a * arm[m] * arm[j]


@njit(cache=True, error_model="numpy")
def _restoring(state: Any, r: Any, stiffness: Any, rest: Any, force: Any) -> None:
    """Add the linear restoring force in body axes; it acts in axes that turn with the yaw [eq:coupled-restoring]."""
    yaw = math.atan2(r[1, 0], r[0, 0])
    c, s = math.cos(yaw), math.sin(yaw)
    d = np.empty(6)
    dx, dy = state[0] - rest[0], state[1] - rest[1]
    d[0], d[1], d[2] = c * dx + s * dy, -s * dx + c * dy, state[2] - rest[2]
    # rotation vector of what is left of the rotation next to the yaw
    t = np.empty((3, 3))
    for j in range(3):
        t[0, j], t[1, j], t[2, j] = c * r[0, j] + s * r[1, j], -s * r[0, j] + c * r[1, j], r[2, j]
    x, y, z = t[2, 1] - t[1, 2], t[0, 2] - t[2, 0], t[1, 0] - t[0, 1]
    double_sine = math.sqrt(x * x + y * y + z * z)
    angle = math.atan2(0.5 * double_sine, 0.5 * (t[0, 0] + t[1, 1] + t[2, 2] - 1.0))
    scale = angle / double_sine if double_sine > 1e-12 else 0.5
    d[3], d[4] = scale * x, scale * y
    turned = yaw - rest[3]
    d[5] = turned - 2.0 * math.pi * math.floor(turned / (2.0 * math.pi) + 0.5)
    f = np.zeros(6)
    for i in range(6):
        for j in range(6):
            f[i] -= stiffness[i, j] * d[j]
    # from the yawed axes to body axes: transpose of t
    for i in range(3):
        for j in range(3):
            force[i] += t[j, i] * f[j]
            force[3 + i] += t[j, i] * f[3 + j]


@njit(cache=True, error_model="numpy")
def _solve(a: Any, b: Any) -> None:
    """Solve a symmetric positive definite system of six in place."""
    n = 6
    for j in range(n):
        for k in range(j):
            a[j, j] -= a[j, k] * a[j, k]
        a[j, j] = math.sqrt(a[j, j])
        for i in range(j + 1, n):
            for k in range(j):
                a[i, j] -= a[i, k] * a[j, k]
            a[i, j] /= a[j, j]
    for i in range(n):
        for k in range(i):
            b[i] -= a[i, k] * b[k]
        b[i] /= a[i, i]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            b[i] -= a[k, i] * b[k]
        b[i] /= a[i, i]


@njit(cache=True, error_model="numpy")
def body_velocity(state: Any, out: Any) -> None:
    """Write velocity and spin in body axes."""
    r = np.empty((3, 3))
    rotation_of(state[3:7], r)
    _to_body(r, state[7:10], out)
    out[3:6] = state[10:13]


@njit(cache=True, error_model="numpy")
def acceleration(
    state: Any, body: Any, lumps: Any, water: Any, fluid: Any, external: Any, memory: Any, arms: Any, pulls: Any,
    result: Any,
) -> None:  # fmt: skip
    """Write acceleration in site axes and of the spin in body axes.

    ``body`` is (rigid mass matrix, added mass of Morison kind, added mass of radiation, linear damping, quadratic
    damping, stiffness, rest, constant force in site axes, free); ``external`` a force in site axes about the centre of
    gravity, ``memory`` one in body axes, ``pulls`` forces on the points in site axes.
    """
    rigid, added, radiated, linear, quadratic, stiffness, rest, constant, free = body
    r, nu, wave, wave_rate = np.empty((3, 3)), np.empty(6), np.empty(3), np.empty(3)
    rotation_of(state[3:7], r)
    _to_body(r, state[7:10], nu)
    nu[3:6] = state[10:13]
    w = nu[3:6]
    force, mass = np.zeros(6), rigid + radiated + added
    last = water.shape[1] - 1
    _to_body(r, water[0:3, last], wave)
    _to_body(r, water[3:6, last], wave_rate)
    # added mass of Morison kind answers to the motion relative to the water, with its turning [eq:coupled-added-mass]
    relative, p, h, known = nu.copy(), np.zeros(3), np.zeros(3), np.empty(6)
    for i in range(3):
        relative[i] -= wave[i]
    known[0:3] = -wave_rate
    known[3:6] = 0.0
    _add_cross(w, relative[0:3], -1.0, known[0:3])
    for i in range(3):
        for j in range(6):
            p[i] += added[i, j] * relative[j]
            h[i] += added[3 + i, j] * relative[j]
            force[i] -= added[i, j] * known[j]
            force[3 + i] -= added[3 + i, j] * known[j]
    _add_cross(w, p, -1.0, force[0:3])
    _add_cross(relative[0:3], p, -1.0, force[3:6])
    _add_cross(w, h, -1.0, force[3:6])
    # gyroscopic moment of the rigid mass
    turn = np.zeros(3)
    for i in range(3):
        for j in range(3):
            turn[i] += rigid[3 + i, 3 + j] * w[j]
    _add_cross(w, turn, -1.0, force[3:6])
    for i in range(6):
        for j in range(6):
            force[i] -= linear[i, j] * nu[j]
        force[i] -= quadratic[i] * abs(relative[i]) * relative[i] + memory[i]
    _restoring(state, r, stiffness, rest, force)
    if lumps[0].shape[0] > 0:
        _lump_loads(state, r, lumps, water, fluid, force, mass)
    site, moment = np.empty(3), np.empty(3)
    for i in range(3):
        site[i] = constant[i] + external[i]
        moment[i] = constant[3 + i] + external[3 + i]
    arm = np.empty(3)
    for k in range(arms.shape[0]):
        _to_site(r, arms[k], arm)
        for i in range(3):
            site[i] += pulls[k, i]
        _add_cross(arm, pulls[k], 1.0, moment)
    turned = np.empty(3)
    _to_body(r, moment, turned)
    # unknowns: acceleration in site axes, of the spin in body axes
    for i in range(3):
        result[i] = site[i] + r[i, 0] * force[0] + r[i, 1] * force[1] + r[i, 2] * force[2]
        result[3 + i] = force[3 + i] + turned[i]
    whole = np.zeros((6, 6))
    half = np.zeros((3, 3))
    for i in range(3):
        for j in range(3):
            for k in range(3):
                half[i, j] += r[i, k] * mass[k, j]
                whole[i, 3 + j] += r[i, k] * mass[k, 3 + j]
            whole[3 + i, 3 + j] = mass[3 + i, 3 + j]
    for i in range(3):
        for j in range(3):
            for k in range(3):
                whole[i, j] += half[i, k] * r[j, k]
            whole[3 + j, i] = whole[i, 3 + j]
    for i in range(6):
        if free[i] == 0.0:
            whole[i, :], whole[:, i] = 0.0, 0.0
            whole[i, i], result[i] = 1.0, 0.0
    _solve(whole, result)


@njit(cache=True, error_model="numpy")
def _advance(state: Any, speed: Any, rate: Any, time: float, out: Any) -> None:
    """Write ``state`` plus ``time`` times the rate of change at the stage ``speed`` with accelerations ``rate``."""
    for i in range(3):
        out[i] = state[i] + time * speed[7 + i]
        out[7 + i] = state[7 + i] + time * rate[i]
        out[10 + i] = state[10 + i] + time * rate[3 + i]
    w, x, y, z = speed[3], speed[4], speed[5], speed[6]
    p, q, r = 0.5 * speed[10], 0.5 * speed[11], 0.5 * speed[12]
    out[3] = state[3] + time * (-x * p - y * q - z * r)
    out[4] = state[4] + time * (w * p + y * r - z * q)
    out[5] = state[5] + time * (w * q + z * p - x * r)
    out[6] = state[6] + time * (w * r + x * q - y * p)


@njit(cache=True, error_model="numpy")
def _memory_force(outputs: Any, z: Any, result: Any) -> None:
    for i in range(6):
        total = 0.0
        for k in range(z.size):
            total += outputs[i, k].real * z[k].real - outputs[i, k].imag * z[k].imag
        result[i] = total


@njit(cache=True, error_model="numpy")
def step(
    state: Any, z: Any, h: float, body: Any, lumps: Any, water: Any, fluid: Any, external: Any, arms: Any,
    reaction: Any, exponential: Any, inputs: Any, outputs: Any, new_state: Any, new_z: Any,
) -> None:  # fmt: skip
    """Take one step of ``h`` seconds.

    ``water`` (3, 7, lumps + 1) and ``external`` (3, 6) stand for its start, middle and end; ``reaction`` (2, points, 3)
    is mean and tilt of the forces on the points [eq:coupled-reaction].
    """
    half, full, weight_q, f1, f2, f3 = exponential
    n = z.size
    rates, stages = np.empty((4, 6)), np.empty((4, 13))
    nu, memory, pulls = np.empty(6), np.empty(6), np.empty_like(reaction[0])
    heard = np.empty((4, n), np.complex128)
    z_a, z_stage = z.copy(), z.copy()
    stages[0] = state
    for s in range(4):
        moment = 0 if s == 0 else (1 if s < 3 else 2)
        if s == 1 or s == 2:
            _advance(state, stages[s - 1], rates[s - 1], 0.5 * h, stages[s])
        elif s == 3:
            _advance(state, stages[2], rates[2], h, stages[3])
        _memory_force(outputs, z_stage, memory)
        for k in range(arms.shape[0]):
            for i in range(3):
                pulls[k, i] = reaction[0, k, i] + (moment - 1.0) * reaction[1, k, i]
        acceleration(
            stages[s], body, lumps, water[moment], fluid, external[moment], memory, arms, pulls, rates[s]
        )  # fmt: skip
        body_velocity(stages[s], nu)
        for k in range(n):
            total = 0.0j
            for j in range(6):
                total += inputs[k, j] * nu[j]
            heard[s, k] = total
        for k in range(n):
            if s == 0:
                z_a[k] = half[k] * z[k] + weight_q[k] * heard[0, k]
                z_stage[k] = z_a[k]
            elif s == 1:
                z_stage[k] = half[k] * z[k] + weight_q[k] * heard[1, k]
            elif s == 2:
                z_stage[k] = half[k] * z_a[k] + weight_q[k] * (2.0 * heard[2, k] - heard[0, k])
    for k in range(n):
        new_z[k] = full[k] * z[k] + f1[k] * heard[0, k] + 2.0 * f2[k] * (heard[1, k] + heard[2, k])
        new_z[k] += f3[k] * heard[3, k]
    out, mean = np.empty(13), np.zeros(13)
    still = np.zeros(13)
    for s in range(4):
        weight = h / 6.0 if s == 0 or s == 3 else h / 3.0
        _advance(still, stages[s], rates[s], weight, out)
        for i in range(13):
            mean[i] += out[i]
    size = 0.0
    for i in range(13):
        new_state[i] = state[i] + mean[i]
    for i in range(3, 7):
        size += new_state[i] * new_state[i]
    for i in range(3, 7):
        new_state[i] /= math.sqrt(size)
