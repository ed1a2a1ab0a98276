"""Lines as the unit feels them through shapes at rest: their drag as quadratic damping, their inertia.

In time a line at rest at every instant has no inertia; one in motion brings drag and inertia of its own.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.mooring.lines import LineElement
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.statics import line_points

STEP = 1e-4  # displacement of the fairlead over the beam for the slopes of the shape


def line_drag_rows(unit: FloatingUnit, *, of_moving: bool = True) -> tuple[Array, Array]:
    """Return the velocity across the line at its points as rows (k, 3), and the drag coefficients (k,) [N s2/m2].

    The line follows its fairlead from one shape at rest to the next (quasi-static); each piece of it is dragged across
    its own direction in still water [eq:breakwater-line-drag]. Waves and current at the line, and drag along it, are
    left out.

    Parameters
    ----------
    unit : FloatingUnit
        Lines with ``drag_width`` greater than zero count, and lines in motion with the drag of their segments where no
        ``drag_width`` is given.
    of_moving : bool
        Whether lines in motion count.
    """
    rows, coefficients = [np.zeros((0, 3))], [np.zeros(0)]
    for line, given in zip(unit.lines, unit.breakwater.lines):
        if not isinstance(given, MooringLine) or (given.dynamic and not of_moving):
            continue
        moving = given.dynamic and given.can_move and given.drag_width == 0.0
        if not moving and given.drag_width == 0.0:
            continue
        follows, along, length = _follows(unit, line)
        width = np.full(length.size, given.drag_width)
        if moving:
            segment = _segment_at(given, length)
            width = np.array([kind.drag_normal * kind.diameter for kind in given.bar_types])[segment]
        # velocity across the line per velocity of the modes
        rows.append(np.einsum("na,naj->nj", np.stack([-along[:, 1], along[:, 0]], axis=1), follows))
        coefficients.append(0.5 * unit.water.density * width * line.count * length)
    return np.concatenate(rows), np.concatenate(coefficients)


def line_inertia(unit: FloatingUnit) -> Array:
    """Return the inertia (3, 3) that lines in motion add to sway, heave and roll [kg, kg m, kg m2].

    Mass and added mass of every piece of a line that follows its fairlead through shapes at rest
    [eq:breakwater-line-inertia]. A slack chain moves across itself by several times what its fairlead moves: it weighs
    more in motion than on a scale. Bodies between segments are left out.
    """
    total = np.zeros((3, 3))
    for line, given in zip(unit.lines, unit.breakwater.lines):
        if not (isinstance(given, MooringLine) and given.dynamic and given.can_move):
            continue
        follows, along, length = _follows(unit, line)
        segment = _segment_at(given, length)
        across = np.einsum("na,naj->nj", np.stack([-along[:, 1], along[:, 0]], axis=1), follows)
        ahead = np.einsum("na,naj->nj", along, follows)
        mass = np.array([kind.mass_per_length for kind in given.bar_types])[segment]
        displaced = unit.water.density * np.array([kind.volume_per_length for kind in given.bar_types])[segment]
        normal = mass + displaced * np.array([kind.added_mass_normal for kind in given.bar_types])[segment]
        tangential = mass + displaced * np.array([kind.added_mass_tangential for kind in given.bar_types])[segment]
        for weight, row in ((normal, across), (tangential, ahead)):
            total += line.count * np.einsum("ni,n,nj->ij", row, weight * length, row)
    return total


def _follows(unit: FloatingUnit, line: LineElement) -> tuple[Array, Array, Array]:
    """Return velocity of points per velocity of the modes (n, 2, 3), direction (n, 2) and length (n,) of pieces."""
    step = STEP * unit.breakwater.hull.beam
    shape = line_points(unit, line, np.zeros(3))
    slopes = []
    for axis in (0, 2):
        shift = np.zeros(3)
        shift[axis] = step
        slopes.append((line_points(unit, line, shift) - line_points(unit, line, -shift)) / (2.0 * step))
    along = np.gradient(shape, axis=0)
    length = np.linalg.norm(along, axis=1)
    along = along / length[:, None]
    length[[0, -1]] *= 0.5
    x, _, z = line.fairlead
    modes = np.array([[1.0, 0.0, z], [0.0, 1.0, -x]])
    return np.stack(slopes, axis=2) @ modes, along, length


def _segment_at(given: MooringLine, length: Array) -> NDArray[np.int64]:
    """Return the segment (n,) that each point of a line belongs to, from the lengths (n,) of its pieces."""
    ends = np.cumsum([segment.length for segment in given.segments])
    middle = np.cumsum(length) - 0.5 * length
    values: NDArray[np.int64] = np.searchsorted(ends[:-1], middle * ends[-1] / float(np.sum(length)))
    return values
