"""Bodies and networks that the tests of the room share."""

from __future__ import annotations

import numpy as np

from moyai.coupled.rigid import RigidBody
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.network import Network
from moyai.sea.water import Water

GRAVITY = 9.81
VACUUM = Water(depth=1e3, density=1e-9, gravity=GRAVITY)
SPACE = Water(depth=1e3, density=1e-9, gravity=1e-9)
SEA = Water(depth=50.0, density=1000.0, gravity=GRAVITY)


def light(stiffness: float, *, mass: float = 1e-5, tension_only: bool = True) -> BarType:
    """A line with hardly any mass and no drag."""
    return BarType("light", mass, stiffness, 1e-3, volume_per_length=0.0, tension_only=tension_only)


def hung(
    body: RigidBody,
    lines: list[tuple[str, tuple[float, float, float], BarType, float]],
    segments: int = 1,
    water: Water = VACUUM,
) -> Network:
    """Tie points of a body to fixed points: (point, fixed place, material, unstretched length)."""
    builder = NetworkBuilder(water)
    for name, place in body.points_at_start.items():
        builder.driven(name, place)
    for number, (point, place, material, length) in enumerate(lines):
        builder.fixed(f"fixed {number}", place)
        builder.line(
            f"line {number}", f"fixed {number}", point, material, length=length, segments=segments, shape="straight"
        )
    return builder.build()


def random_inertia(random: np.random.Generator, mass: float, size: float) -> np.ndarray:
    """Inertia of a random heap of points."""
    points = size * random.normal(size=(6, 3))
    points -= points.mean(axis=0)
    return mass / 6.0 * sum((p @ p) * np.eye(3) - np.outer(p, p) for p in points)
