"""A rigid cage on taut lines held against a plain program: every part by itself, in fixed Runge-Kutta steps."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import brentq

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.structures.cage.run import run

CASE = """
moyai: 1
title: Box on two lines
site: {water_depth: 0.7 m, density: 1000 kg/m3, gravity: 9.81 m/s2}
waves: {kind: regular, height: 4 cm, period: 1.3 s, heading_deg: 0}
structure:
  kind: cage
  model: rigid
  kinematic_viscosity: 1.0e-6 m2/s
  shape: {kind: box, length: 30 cm, width: 24 cm, height: 22 cm}
  net: {twine_diameter: 0.8 mm, aperture: 6 mm, mass_per_area: 0.6 kg/m2, density: 7850 kg/m3, drag: {law: matsubara}}
  frame: {diameter: 3 mm, density: 7850 kg/m3}
  floats: {diameter: 5 cm, mass: 9 g, per_side: 2}
  mooring: {kind: outward_bottom, anchor_distance: 60 cm, pretension: 0.3 N, stiffness: 0.5 kN/m}
analyses: [statics, time]
settings: {rigid: {periods: 12, settled_periods: 4}}
"""
RHO, G, DEPTH, NU, STEEL = 1000.0, 9.81, 0.7, 1e-6, 7850.0
LONG, BROAD, HIGH, RADIUS, FLOAT = 0.30, 0.24, 0.22, 0.025, 0.009
TWINE, PITCH, PER_AREA, ROD = 8e-4, 6.8e-3, 0.6, 3e-3
STIFF, TAUT, HEIGHT, PERIOD = 500.0, 0.3, 0.04, 1.3


def net_parts(n):
    """Patches of the five faces: place (x, z), normal in the plane (0, 0 for the sides along the waves), area."""
    grid = (np.arange(n) + 0.5) / n - 0.5
    one, two = (value.ravel() for value in np.meshgrid(grid, grid))
    rows = []
    for side in (-0.5, 0.5):
        rows.append((np.full(n * n, side * LONG), HIGH * two, (1.0, 0.0), BROAD * HIGH))
        rows.append((LONG * one, HIGH * two, (0.0, 0.0), LONG * HIGH))
    rows.append((LONG * one, np.full(n * n, -0.5 * HIGH), (0.0, 1.0), LONG * BROAD))
    place = np.concatenate([np.stack([x, z], 1) for x, z, _, _ in rows])
    normal = np.concatenate([np.tile(of, (n * n, 1)) for _, _, of, _ in rows])
    return place, normal, np.concatenate([np.full(n * n, area / n**2) for *_, area in rows])


def rod_parts(n):
    """Pieces of the twelve edges: place, direction in the plane (0, 0 for those across), length."""
    place, along, length = [], [], []
    for one in (-0.5, 0.5):
        for two in (-0.5, 0.5):
            for share in (np.arange(n) + 0.5) / n - 0.5:
                place += [[share * LONG, two * HIGH], [one * LONG, two * HIGH], [one * LONG, share * HIGH]]
                along += [[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]]
                length += [LONG / n, BROAD / n, HIGH / n]
    return np.array(place), np.array(along), np.array(length)


def cap(depth):
    """Volume of a float that is immersed so deep."""
    depth = np.clip(depth, 0.0, 2.0 * RADIUS)
    return math.pi * depth**2 * (RADIUS - depth / 3.0)


def plain_march(periods, steps, settled):
    """Return ranges of the centre of gravity over H, rotation range [rad], peaks of both lines [N]."""
    omega = 2.0 * math.pi / PERIOD
    k = brentq(lambda q: G * q * math.tanh(q * DEPTH) - omega**2, 1e-3, 1e3)
    net, normal, area = net_parts(6)
    rods, axis, length = rod_parts(12)
    quarter = 0.25 * LONG
    floats = np.array(
        [[x, 0.5 * HIGH] for x in (-quarter, quarter)] * 2 + [[s * LONG / 2, HIGH / 2] for s in (-1, 1)] * 2
    )
    volume, rod_volume = PER_AREA * area / STEEL, math.pi / 4.0 * ROD**2 * length
    places = np.concatenate([net, rods, floats])
    masses = np.concatenate([PER_AREA * area, STEEL * rod_volume, np.full(8, FLOAT)])
    mass = masses.sum()
    middle = (places * masses[:, None]).sum(0) / mass
    inertia = (masses * ((places - middle) ** 2).sum(1)).sum() + 8 * 0.4 * FLOAT * RADIUS**2
    net, rods, floats = net - middle, rods - middle, floats - middle
    held = np.array([[LONG / 2, -HIGH / 2], [-LONG / 2, -HIGH / 2]]) - middle
    anchors = np.array([[0.6, -DEPTH], [-0.6, -DEPTH]])
    solid = volume.sum() + rod_volume.sum()

    def spare(z):
        way = anchors[0] - held[0] - [0.0, z]
        down = 2.0 * TAUT * way[1] / math.hypot(*way)
        return RHO * G * (8.0 * cap(RADIUS - z - floats[0, 1]) + solid) - mass * G + down

    rest = brentq(spare, -0.3, 0.1)
    unstretched = np.linalg.norm(anchors[0] - held[0] - [0.0, rest]) - TAUT / STIFF

    def water(place, t):
        x, z = place[:, 0], np.minimum(place[:, 1], 0.0)
        size = 0.5 * HEIGHT * 0.5 * (1.0 - math.cos(math.pi * min(1.0, t / (3.0 * PERIOD))))
        up = np.cosh(k * (z + DEPTH)) / math.sinh(k * DEPTH)
        across = np.sinh(k * (z + DEPTH)) / math.sinh(k * DEPTH)
        c, s = np.cos(k * x - omega * t), np.sin(k * x - omega * t)
        speed = size * omega * np.stack([up * c, across * s], 1)
        return speed, size * omega**2 * np.stack([up * s, -across * c], 1), size * c

    def square(v):
        return np.linalg.norm(v, axis=1, keepdims=True) * v

    def rate(t, y):
        c, s = math.cos(y[2]), math.sin(y[2])
        turn = np.array([[c, s], [-s, c]])
        force, moment, system = np.zeros(2), 0.0, np.diag([mass, mass, inertia])

        def add(arm, f, added=None):
            nonlocal force, moment, system
            if added is not None:
                rows = np.zeros((len(arm), 2, 3))
                rows[:, 0, 0] = rows[:, 1, 1] = 1.0
                rows[:, 0, 2], rows[:, 1, 2] = arm[:, 1], -arm[:, 0]
                system = system + np.einsum("nij,nik,nkl->jl", rows, added, rows)
                f = f + np.einsum("nij,nj->ni", added, y[5] ** 2 * arm)
            force = force + f.sum(0)
            moment = moment + float((arm[:, 1] * f[:, 0] - arm[:, 0] * f[:, 1]).sum())

        def met(part):
            arm = part @ turn.T
            place = arm + y[:2]
            speed, change, surface = water(place, t)
            own = y[3:5] + y[5] * np.stack([arm[:, 1], -arm[:, 0]], 1)
            return arm, place, speed - own, change, surface

        arm, place, flow, change, surface = met(net)
        wet = (place[:, 1] < surface).astype(float)
        n = normal @ turn.T
        ahead = (flow * n).sum(1, keepdims=True) * n
        number = np.linalg.norm(flow, axis=1, keepdims=True) * TWINE / NU
        drag = np.minimum(3.0, 9.84 * np.clip(number, 1e-9, 1800.0) ** -0.36)
        f = (
            0.5
            * RHO
            * (area * wet * 2.0 * TWINE / PITCH)[:, None]
            * drag
            * (square(ahead) + 0.25 * square(flow - ahead))
        )
        f = f + 2.0 * RHO * (volume * wet)[:, None] * change + np.outer(RHO * G * volume * wet, [0.0, 1.0])
        add(arm, f, RHO * (volume * wet)[:, None, None] * np.eye(2))
        arm, place, flow, change, surface = met(rods)
        wet = (place[:, 1] < surface).astype(float)
        e = axis @ turn.T
        aside = np.eye(2) - e[:, :, None] * e[:, None, :]
        f = 0.6 * RHO * ROD * (length * wet)[:, None] * square(np.einsum("nij,nj->ni", aside, flow))
        f = f + RHO * (rod_volume * wet)[:, None] * (change + np.einsum("nij,nj->ni", aside, change))
        add(arm, f + np.outer(RHO * G * rod_volume * wet, [0.0, 1.0]), RHO * (rod_volume * wet)[:, None, None] * aside)
        arm, place, flow, change, surface = met(floats)
        under = cap(surface - place[:, 1] + RADIUS)
        share = under / cap(2.0 * RADIUS)
        f = 0.3 * RHO * math.pi * RADIUS**2 * share[:, None] * square(flow) + 1.5 * RHO * under[:, None] * change
        add(arm, f + np.outer(RHO * G * under, [0.0, 1.0]), 0.5 * RHO * under[:, None, None] * np.eye(2))
        arm = held @ turn.T
        way = anchors - arm - y[:2]
        far = np.linalg.norm(way, axis=1)
        pull = STIFF * np.maximum(0.0, far - unstretched)
        add(arm, pull[:, None] * way / far[:, None])
        return np.concatenate([y[3:], np.linalg.solve(system, [force[0], force[1] - mass * G, moment])]), pull

    y, step, rows, pulls = np.array([0.0, rest, 0.0, 0.0, 0.0, 0.0]), PERIOD / steps, [], []
    for i in range(periods * steps):
        t = i * step
        one, pull = rate(t, y)
        two = rate(t + step / 2, y + step / 2 * one)[0]
        three = rate(t + step / 2, y + step / 2 * two)[0]
        if i >= (periods - settled) * steps:
            rows.append(y)
            pulls.append(pull)
        y = y + step / 6 * (one + 2 * two + 2 * three + rate(t + step, y + step * three)[0])
    ranges = np.ptp(np.array(rows)[:, :3].reshape(settled, steps, 3), axis=1).mean(axis=0)
    return ranges[:2] / HEIGHT, ranges[2], np.array(pulls).max(axis=0)


@pytest.mark.slow
def test_a_rigid_cage_moves_as_plain_steps_take_it():
    result = run(build(case_of(parse_yaml(CASE, "case.yaml"), Path("case.yaml"))))
    sea = result.tree["SWL/waves/regular"].to_dataset()
    ranges, turned, peaks = plain_march(9, 180, 2)
    assert sea["range_ratio"].values[0] == pytest.approx(ranges, rel=0.02)
    assert float(sea["range"].sel(mode="roll")[0]) == pytest.approx(turned, rel=0.02)
    found = sea["line_tension_maximum"].sel(line=["shore line", "offshore line"]).values[0].max(axis=-1)
    assert found == pytest.approx(peaks, rel=0.04)
