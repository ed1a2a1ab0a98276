"""Random lines and nets of every kind for statics: chains, ropes, floats, clumps, beds soft to rigid, currents."""

import math

import numpy as np

from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.flow import Flow
from moyai.sea.water import Water


def random_line(rng):
    """One to three lines from an anchor to a fixed, loose or floating end, a clump weight or float between."""
    depth = 10.0 ** rng.uniform(0.7, 2.3)
    bed = Bed(-depth, 10.0 ** rng.uniform(2, 9), 0.0, rng.choice([0.0, 0.5])) if rng.random() < 0.75 else None
    builder = NetworkBuilder(Water(depth, 1025.0, 9.81), bed)
    diameter = 10.0 ** rng.uniform(-2, -0.7)
    gravity = rng.choice([rng.uniform(0.5, 0.99), rng.uniform(1.01, 1.3), rng.uniform(1.3, 8)])
    mass = gravity * 1025.0 * math.pi / 4.0 * diameter**2
    length = depth * 10.0 ** rng.uniform(-0.3, 0.8)
    weight = mass * 9.81 * length
    bending = rng.choice([0.0, 0.0, 1.0]) * weight * length**2 * 10.0 ** rng.uniform(-6, -2)
    kind = BarType(
        "line", mass, weight * 10.0 ** rng.uniform(1, 5), diameter, drag_normal=1.2, drag_tangential=0.05,
        added_mass_normal=1.0, bending_stiffness=bending, tension_only=bool(rng.random() < 0.85),
    )  # fmt: skip
    end, ratio = rng.choice(["surface", "middle", "loose", "float"]), rng.uniform(0.5, 1.02)
    top = -depth * rng.uniform(0.1, 0.9) if end == "middle" else 0.0
    rise = min(top + depth, 0.98 * length) if ratio * length < top + depth else top + depth
    across = math.sqrt(max((ratio * length) ** 2 - rise**2, (0.05 * length) ** 2))
    if end in ("surface", "middle") and math.hypot(across, rise) > 1.01 * length:
        across = math.sqrt(max((1.01 * length) ** 2 - rise**2, 0.0))
    builder.fixed("anchor", (0.0, 0.0, -depth))
    heading = rng.uniform(0.0, 2.0 * math.pi)
    far = (across * math.cos(heading), across * math.sin(heading), rise - depth)
    if end in ("surface", "middle"):
        builder.fixed("top", far)
    elif end == "loose":
        builder.free("top", far, mass=mass * length * rng.uniform(0.0, 2.0))
    else:
        size = (9.0 / math.pi * mass * length / 1025.0) ** (1.0 / 3.0)
        builder.float_sphere(
            "top", far, diameter=size, mass=0.3 * mass * length, drag_coefficient=0.5, added_mass_coefficient=0.5
        )
    bars = int(rng.integers(3, 80))
    shape = rng.choice(["catenary", "straight"])
    builder.line("line", "anchor", "top", kind, length=length, segments=bars, shape=shape)
    if rng.random() < 0.4:
        place = (0.5 * far[0], 0.5 * far[1], min(0.0, 0.5 * rise - depth))
        volume = mass * length / 1025.0 * rng.choice([0.05, 2.0])
        builder.free("clump", place, mass=mass * length * rng.uniform(0.1, 3.0), volume=volume, height=0.2)
        for name, ends, other in (
            ("second", ("anchor", "clump"), (0.0, 0.0, -depth)),
            ("third", ("clump", "top"), far),
        ):
            long = max(0.6 * length, 1.02 * math.dist(other, place))
            builder.line(name, *ends, kind, length=long, segments=bars // 2 + 1, shape=shape)
    flow = Flow((rng.normal(0.0, 0.7), rng.normal(0.0, 0.7), 0.0)) if rng.random() < 0.5 else None
    return builder.build(), flow


def random_net(rng):
    """A net upright or flat, light or heavy, taut or slack, held at its top row, in an oblique current."""
    rows, columns = int(rng.integers(3, 14)), int(rng.integers(3, 14))
    builder = NetworkBuilder(Water(60.0, 1025.0, 9.81), Bed(-60.0, 1e5) if rng.random() < 0.3 else None)
    grid, mesh = np.zeros((rows, columns, 3)), 10.0 ** rng.uniform(-1, 0.3)
    grid[..., 1], upright = mesh * np.arange(columns)[None, :], rng.random() < 0.6
    grid[..., 2] = -rng.choice([0.0, 1.0, 5.0])
    grid[..., 2 if upright else 0] += (-1.0 if upright else 1.0) * mesh * np.arange(rows)[:, None]
    diameter = mesh * 10.0 ** rng.uniform(-2.5, -1)
    mass = rng.choice([0.92, 1.15, 2.0, 7.0]) * 1025.0 * math.pi / 4.0 * diameter**2
    stiffness = mass * 9.81 * mesh * rows * 10.0 ** rng.uniform(2, 6)
    twine = BarType("twine", mass, stiffness, diameter, drag_normal=1.2, drag_tangential=0.03, added_mass_normal=1.0)
    lengths = (mesh * rng.uniform(0.98, 1.1), mesh * rng.uniform(0.98, 1.1))
    builder.net("net", grid, twine, lengths=lengths, top="fixed")
    flow = Flow((rng.normal(0.0, 0.8), rng.normal(0.0, 0.3), 0.0)) if rng.random() < 0.8 else None
    return builder.build(), flow
