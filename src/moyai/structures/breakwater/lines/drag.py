"""Drag of the water on the lines, as quadratic damping of the unit: linearised in frequency, as it is in time."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.statics import line_points

STEP = 1e-4  # displacement of the fairlead over the beam for the slopes of the shape


def line_drag_rows(unit: FloatingUnit) -> tuple[Array, Array]:
    """Return the velocity across the line at its points as rows (k, 3), and the drag coefficients (k,) [N s2/m2].

    The line follows its fairlead from one shape at rest to the next (quasi-static); each piece of it is dragged across
    its own direction in still water [eq:breakwater-line-drag]. Waves and current at the line, drag along it, and its
    added mass are left out.

    Parameters
    ----------
    unit : FloatingUnit
        Lines with ``drag_width`` greater than zero count.
    """
    rows, coefficients = [np.zeros((0, 3))], [np.zeros(0)]
    step = STEP * unit.breakwater.hull.beam
    for line, given in zip(unit.lines, unit.breakwater.lines):
        if not isinstance(given, MooringLine) or given.drag_width == 0.0:
            continue
        shape = line_points(unit, line, np.zeros(3))
        slopes = []
        for axis in (0, 2):
            shift = np.zeros(3)
            shift[axis] = step
            slopes.append((line_points(unit, line, shift) - line_points(unit, line, -shift)) / (2.0 * step))
        along = np.gradient(shape, axis=0)
        length = np.linalg.norm(along, axis=1)
        normal = np.stack([-along[:, 1], along[:, 0]], axis=1) / length[:, None]
        # Velocity across the line per velocity of the fairlead along x and z, then per velocity of the modes
        across = np.stack([np.sum(normal * slope, axis=1) for slope in slopes], axis=1)
        x, _, z = line.fairlead
        modes = np.array([[1.0, 0.0, z], [0.0, 1.0, -x]])
        length[[0, -1]] *= 0.5
        rows.append(across @ modes)
        coefficients.append(0.5 * unit.water.density * given.drag_width * line.count * length)
    return np.concatenate(rows), np.concatenate(coefficients)
