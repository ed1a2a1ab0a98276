"""Cages of the two usual shapes: a box and an upright cylinder, with rods along the edges and floats on the top."""

from __future__ import annotations

import itertools
import math
from typing import Literal

import numpy as np

from moyai.core.options import checks_words
from moyai.structures.cage.rigid.parts import Patches, Rod, cylinder_wall, disc, join, rectangle

Face = Literal["sides", "bottom", "top"]
#: Straight pieces that stand for a ring of rod
RING_PIECES = 24


@checks_words
def box_patches(length: float, width: float, height: float, faces: tuple[Face, ...], count: int) -> Patches:
    """Return the net of a box from its middle, ``faces`` among sides, bottom, top; lengths in metres."""
    x, y, z = 0.5 * length, 0.5 * width, 0.5 * height
    parts = []
    if "sides" in faces:
        parts += [
            rectangle((-x, -y, -z), (0, width, 0), (0, 0, height), count),
            rectangle((x, -y, -z), (0, width, 0), (0, 0, height), count),
            rectangle((-x, -y, -z), (length, 0, 0), (0, 0, height), count),
            rectangle((-x, y, -z), (length, 0, 0), (0, 0, height), count),
        ]
    for name, level in (("bottom", -z), ("top", z)):
        if name in faces:
            parts.append(rectangle((-x, -y, level), (length, 0, 0), (0, width, 0), count))
    return join(parts)


def box_rods(length: float, width: float, height: float, diameter: float) -> tuple[Rod, ...]:
    """Return massless rods along the twelve edges of a box; lengths in metres."""
    x, y, z = 0.5 * length, 0.5 * width, 0.5 * height
    rods = []
    for a in (-1, 1):
        for b in (-1, 1):
            rods.append(Rod((-x, a * y, b * z), (x, a * y, b * z), diameter, 0.0))
            rods.append(Rod((a * x, -y, b * z), (a * x, y, b * z), diameter, 0.0))
            rods.append(Rod((a * x, b * y, -z), (a * x, b * y, z), diameter, 0.0))
    return tuple(rods)


def box_floats(length: float, width: float, level: float, per_side: int) -> np.ndarray:
    """Return float centres on the four sides of a box, each in the middle of its share of the side [m]."""
    share = (np.arange(per_side) + 0.5) / per_side - 0.5
    x, y = 0.5 * length, 0.5 * width
    points = []
    for s in share:
        points += [(-x, s * width, level), (x, s * width, level), (s * length, -y, level), (s * length, y, level)]
    return np.array(points)


@checks_words
def cylinder_patches(diameter: float, height: float, faces: tuple[Face, ...], count: int) -> Patches:
    """Return the net of an upright cylinder from its middle; lengths in metres."""
    radius, z = 0.5 * diameter, 0.5 * height
    parts = [cylinder_wall(radius, -z, z, count)] if "sides" in faces else []
    for name, level in (("bottom", -z), ("top", z)):
        if name in faces:
            parts.append(disc(radius, level, count))
    return join(parts)


def cylinder_rods(diameter: float, height: float, rod_diameter: float) -> tuple[Rod, ...]:
    """Return massless rods of an upright cylinder: rings at top and bottom, and four uprights; lengths in metres."""
    radius, z = 0.5 * diameter, 0.5 * height
    # chords of the mean radius keep the length of the ring
    angle = 2.0 * math.pi * np.arange(RING_PIECES + 1) / RING_PIECES
    reach = radius * (math.pi / RING_PIECES) / math.sin(math.pi / RING_PIECES)
    rods = []
    for level in (-z, z):
        for a, b in itertools.pairwise(angle):
            ends = [(reach * math.cos(t), reach * math.sin(t), level) for t in (a, b)]
            rods.append(Rod(ends[0], ends[1], rod_diameter, 0.0))
    for a in (0.25, 0.75, 1.25, 1.75):
        x, y = radius * math.cos(a * math.pi), radius * math.sin(a * math.pi)
        rods.append(Rod((x, y, -z), (x, y, z), rod_diameter, 0.0))
    return tuple(rods)


def ring_floats(diameter: float, level: float, count: int) -> np.ndarray:
    """Return float centres spread evenly around a ring, symmetric about y = 0 [m]."""
    angle = 2.0 * math.pi * (np.arange(count) + 0.5) / count
    return np.column_stack([0.5 * diameter * np.cos(angle), 0.5 * diameter * np.sin(angle), np.full(count, level)])
