"""Compiled layers of 1/r over flat panels: in closed form near them, by Gauss's rule further away."""

from __future__ import annotations

import math
from typing import Any

from moyai.core.compiled import njit

#: Distance from a panel, over its radius, from which points on it serve: an error of some 1e-8.
FAR = 6.0


@njit(cache=True, error_model="numpy")
def flat_panel(x: float, y: float, z: float, corners: Any, normal: Any) -> tuple[float, float]:
    """Return the integrals of 1/r and of its derivative along the normal of a panel (4, 3), from a point.

    Edge by edge (Wilton et al. 1984) [eq:units-flat-panel]. In the plane of the panel the derivative is zero: half of
    the jump is left to the caller.
    """
    count = corners.shape[0]
    nx, ny, nz = normal[0], normal[1], normal[2]
    height = nx * (x - corners[0, 0]) + ny * (y - corners[0, 1]) + nz * (z - corners[0, 2])
    away = abs(height)
    whole, angle, furthest = 0.0, 0.0, 0.0
    for i in range(count):
        k = (i + 1) % count
        tx, ty, tz = corners[k, 0] - corners[i, 0], corners[k, 1] - corners[i, 1], corners[k, 2] - corners[i, 2]
        length = math.sqrt(tx * tx + ty * ty + tz * tz)
        ax, ay, az = corners[i, 0] - x, corners[i, 1] - y, corners[i, 2] - z
        bx, by, bz = corners[k, 0] - x, corners[k, 1] - y, corners[k, 2] - z
        first, last = math.sqrt(ax * ax + ay * ay + az * az), math.sqrt(bx * bx + by * by + bz * bz)
        furthest = max(furthest, first)
        # a triangle repeats a corner
        if length <= 1e-9 * (first + last):
            continue
        tx, ty, tz = tx / length, ty / length, tz / length
        # outwards in the plane
        across = (ty * nz - tz * ny) * ax + (tz * nx - tx * nz) * ay + (tx * ny - ty * nx) * az
        begin, end = tx * ax + ty * ay + tz * az, tx * bx + ty * by + tz * bz
        square = across * across + height * height
        if square <= 1e-20 * length * length:
            continue
        # r + s without the difference of numbers that are nearly equal: r^2 - s^2 is the square
        above = last + end if end > 0.0 else square / (last - end)
        below = first + begin if begin > 0.0 else square / (first - begin)
        whole += across * math.log(above / below)
        angle += math.atan(across * end / (square + away * last)) - math.atan(across * begin / (square + away * first))
    return whole - away * angle, math.copysign(angle, height) if away > 1e-10 * furthest else 0.0


@njit(cache=True, error_model="numpy")
def rankine_layers(target: Any, panels: Any, single: Any, double: Any) -> None:
    """Add the layers of -1 / (4 pi r) and of its derivative along the normals of the panels.

    Parameters
    ----------
    target : ndarray (q, 3)
        [m].
    panels : tuple
        Corners (n, 4, 3), centres and normals (n, 3), radii (n,) [m]; points (n, p, 3) and their areas (n, p).
    single, double : ndarray (q, n)
    """
    corners, centre, normal, radius, points, areas = panels
    scale = -0.25 / math.pi
    for row in range(target.shape[0]):
        x, y, z = target[row, 0], target[row, 1], target[row, 2]
        for n in range(centre.shape[0]):
            dx, dy, dz = x - centre[n, 0], y - centre[n, 1], z - centre[n, 2]
            one, two = 0.0, 0.0
            if dx * dx + dy * dy + dz * dz < (FAR * radius[n]) ** 2:
                one, two = flat_panel(x, y, z, corners[n], normal[n])
            else:
                for p in range(points.shape[1]):
                    dx, dy, dz = x - points[n, p, 0], y - points[n, p, 1], z - points[n, p, 2]
                    square = dx * dx + dy * dy + dz * dz
                    part = areas[n, p] / math.sqrt(square)
                    one += part
                    two += part / square * (dx * normal[n, 0] + dy * normal[n, 1] + dz * normal[n, 2])
            single[row, n] += scale * one
            double[row, n] += scale * two
