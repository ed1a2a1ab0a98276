"""A flexible cage held against a plain program: masses on springs, stepped with damping until nothing moves."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.structures.cage.run import run

AROUND, DOWN = 16, 6
FLUME = """
moyai: 1
title: Cage of a flume
site: {{water_depth: 3 m, density: 1000 kg/m3, gravity: 9.81 m/s2}}
current: {{speed: {speed} m/s, heading_deg: 0}}
structure:
  kind: cage
  model: flexible
  kinematic_viscosity: 1.14e-6 m2/s
  shape: circular
  size: {size} m
  net: {{twine_diameter: 1.6 mm, solidity: {solidity}, density: 1140 kg/m3, youngs_modulus: 0.2 GPa,
    wall_depth: {depth} m, bottom: none, law: loland, wake: loland}}
  sinkers: {{count: 8, submerged_weight: {weight} N}}
  mooring: {{kind: fixed_collar}}
  mesh: {{around: 16, down: 6}}
analyses: [statics]
"""


def six(p, q, r):
    return float(np.sum(np.cross(p, q) * r))


def volume(x):
    """Inside the net, between a flat lid and a fan over the lower rim, by the divergence theorem."""
    a, b = x[:-1], x[1:]
    c, d = np.roll(b, -1, 1), np.roll(a, -1, 1)
    total = 0.5 * (six(a, b, c) + six(a, c, d) + six(a, b, d) + six(b, c, d))
    rim = x[-1]
    return abs(total - six(rim, np.roll(rim, -1, 0), np.broadcast_to(rim.mean(0), rim.shape))) / 6.0


def plain_cage(speed, size, depth, solidity, weight):
    """Return drag [N] and volume over that as built of a held, bottomless net under weights."""
    d, modulus, rho, g, s = 1.6e-3, 2e8, 1000.0, 9.81, solidity
    pitch = d / (1.0 - math.sqrt(1.0 - s))
    radius = 0.5 * size * math.sqrt(2.0 * math.pi / (AROUND * math.sin(2.0 * math.pi / AROUND)))
    angle = 2.0 * math.pi * np.arange(AROUND) / AROUND
    x = np.zeros((DOWN + 1, AROUND, 3))
    x[..., 0], x[..., 1] = radius * np.cos(angle), radius * np.sin(angle)
    x[..., 2] = -depth * np.arange(DOWN + 1)[:, None] / DOWN
    start = x.copy()
    wide, high = 2.0 * radius * math.sin(math.pi / AROUND), depth / DOWN
    twine = math.pi / 4.0 * d * d
    upright = modulus * twine * wide / pitch
    level = modulus * twine / pitch * np.array([0.5 * high, *[high] * (DOWN - 1), 0.5 * high])[:, None, None]
    load = np.zeros_like(x)
    net = (1140.0 - rho) * g * 2.0 / pitch * twine * wide * high
    load[:-1, :, 2] -= 0.5 * net
    load[1:, :, 2] -= 0.5 * net
    load[-1, :: AROUND // 8, 2] -= weight
    ahead = 0.33 * s + 6.54 * s**2 - 4.88 * s**3
    aside = -0.05 * s + 2.3 * s**2 - 1.76 * s**3
    middle = angle + math.pi / AROUND
    off = np.abs(np.sin(middle)) * radius * math.cos(math.pi / AROUND) / (0.5 * size)
    behind = 1.0 - 0.46 * (0.04 + (ahead - 0.04) * np.sqrt(1.0 - np.clip(off, 0.0, 1.0) ** 2))
    met = speed * np.where(np.cos(middle) > 1e-9, behind, 1.0)[None, :, None]
    step = 0.5 / math.sqrt(max(upright / high, level.max() / wide))
    motion = np.zeros_like(x)
    for _ in range(60_000):
        force = load.copy()
        e = x[1:] - x[:-1]
        length = np.linalg.norm(e, axis=2, keepdims=True)
        pull = np.maximum(0.0, upright * (length / high - 1.0)) * e / length
        force[:-1] += pull
        force[1:] -= pull
        e = np.roll(x, -1, 1) - x
        length = np.linalg.norm(e, axis=2, keepdims=True)
        pull = np.maximum(0.0, level * (length / wide - 1.0)) * e / length
        force += pull - np.roll(pull, 1, 1)
        a, b = x[:-1], x[1:]
        n = np.cross(np.roll(b, -1, 1) - a, np.roll(a, -1, 1) - b)
        n /= np.linalg.norm(n, axis=2, keepdims=True)
        n *= np.where(n[..., :1] < 0.0, -1.0, 1.0)
        cosine = n[..., :1]
        across = n - cosine * np.array([1.0, 0.0, 0.0])
        flow = (0.04 + (ahead - 0.04) * cosine) * np.array([1.0, 0.0, 0.0]) + 2.0 * aside * cosine * across
        panel = 0.5 * rho * wide * high * met**2 * flow
        drag = float(panel[..., 0].sum())
        quarter = 0.25 * (panel + np.roll(panel, 1, 1))
        force[:-1] += quarter
        force[1:] += quarter
        force[0] = 0.0
        motion = 0.995 * (motion + step * force)
        x = x + step * motion
        if np.abs(force).max() < 1e-5:
            return drag, volume(x) / volume(start)
    raise AssertionError("the plain cage does not come to rest")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed", "size", "depth", "solidity", "weight"),
    [(0.2, 1.3, 1.2, 0.2, 9.0), pytest.param(0.35, 1.8, 1.1, 0.28, 14.0, marks=pytest.mark.slow)],
)
def test_a_flexible_cage_rests_where_plain_steps_take_it(speed, size, depth, solidity, weight):
    text = FLUME.format(speed=speed, size=size, depth=depth, solidity=solidity, weight=weight)
    statics = run(build(case_of(parse_yaml(text, "case.yaml"), Path("case.yaml")))).tree["SWL/statics"].ds
    drag, share = plain_cage(speed, size, depth, solidity, weight)
    assert share < 0.9
    assert float(statics["total_drag"][-1]) == pytest.approx(drag, rel=2e-3)
    assert float(statics["volume_share"][-1, 0]) == pytest.approx(share, rel=2e-3)
