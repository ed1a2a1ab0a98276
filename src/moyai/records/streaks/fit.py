"""Least-squares fit of blurred streaks to grey levels: ends, bow, width and brightness to a fraction of a pixel."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.compiled import njit

PARAMETERS = 7
"""Of one streak: column and row of both ends, bow, amplitude, logarithm of the blur."""


@njit(cache=True, error_model="numpy")
def fit_streaks(column, row, grey, start, iterations):  # type: ignore[no-untyped-def]
    """Fit streaks and a constant background to pixels by the method of Levenberg and Marquardt [eq:streaks-profile].

    Parameters
    ----------
    column, row, grey : ndarray, shape (pixels,)
        Places and grey levels.
    start : ndarray, shape (7 * streaks + 1,)
        First guess: per streak x0, y0, x1, y1, bow, amplitude, log blur; then the background.
    iterations : int
        Most steps.

    Returns
    -------
    parameters : ndarray
    squares : float
        Sum of squared differences.
    """
    size = start.size
    streaks = (size - 1) // 7
    best = start.copy()
    normal, right, squares = _normal_equations(column, row, grey, best, streaks)
    damping = 1e-2
    for _ in range(iterations):
        system = normal.copy()
        for i in range(size):
            system[i, i] += damping * normal[i, i] + 1e-12
        step = np.linalg.solve(system, right)
        trial = best + step
        for k in range(streaks):
            low, high = math.log(0.35), math.log(6.0)
            trial[7 * k + 6] = min(max(trial[7 * k + 6], low), high)
            trial[7 * k + 5] = max(trial[7 * k + 5], 1e-3)
            length = math.hypot(trial[7 * k + 2] - trial[7 * k], trial[7 * k + 3] - trial[7 * k + 1])
            bound = 0.25 * length
            trial[7 * k + 4] = min(max(trial[7 * k + 4], -bound), bound)
        new_normal, new_right, new_squares = _normal_equations(column, row, grey, trial, streaks)
        if new_squares < squares:
            gain = squares - new_squares
            best, normal, right, squares = trial, new_normal, new_right, new_squares
            damping = max(damping * 0.3, 1e-9)
            if gain < 1e-5 * squares:
                break
        else:
            damping *= 6.0
            if damping > 1e6:
                break
    return best, squares


@njit(cache=True, error_model="numpy")
def _normal_equations(column, row, grey, p, streaks):  # type: ignore[no-untyped-def]
    size = p.size
    normal = np.zeros((size, size))
    right = np.zeros(size)
    squares = 0.0
    gradient = np.zeros(size)
    root = math.sqrt(2.0)
    for i in range(column.size):
        value = p[size - 1]
        gradient[:] = 0.0
        gradient[size - 1] = 1.0
        for k in range(streaks):
            o = 7 * k
            dx, dy = p[o + 2] - p[o], p[o + 3] - p[o + 1]
            length = math.sqrt(dx * dx + dy * dy) + 1e-9
            tx, ty = dx / length, dy / length
            ux, uy = column[i] - p[o], row[i] - p[o + 1]
            s = ux * tx + uy * ty
            q = -ux * ty + uy * tx
            blur = math.exp(p[o + 6])
            if s < -5.0 * blur - 1.0 or s > length + 5.0 * blur + 1.0 or abs(q) > 5.0 * blur + abs(p[o + 4]) + 1.0:
                continue
            bow, amplitude = p[o + 4], p[o + 5]
            inside = min(max(s / length, 0.0), 1.0)
            rest = q - 4.0 * bow * inside * (1.0 - inside)
            across = math.exp(-0.5 * (rest / blur) ** 2)
            along = 0.5 * (math.erf(s / (root * blur)) - math.erf((s - length) / (root * blur)))
            edge0 = math.exp(-0.5 * (s / blur) ** 2) / (math.sqrt(2.0 * math.pi) * blur)
            edge1 = math.exp(-0.5 * ((s - length) / blur) ** 2) / (math.sqrt(2.0 * math.pi) * blur)
            value += amplitude * along * across
            pull = amplitude * along * across * rest / blur**2
            bend_s, bend_l = 0.0, 0.0
            if 0.0 < inside < 1.0:
                bend_s = 4.0 * bow / length * (1.0 - 2.0 * inside)
                bend_l = 4.0 * bow / length * inside * (2.0 * inside - 1.0)
            by_s = amplitude * across * (edge0 - edge1) + pull * bend_s
            by_l = amplitude * across * edge1 + pull * bend_l
            by_q = -pull
            # Moving the second end turns the axis; moving the first one shifts it as well
            nx, ny = -ty, tx
            turn = (by_s * q - by_q * s) / length
            gradient[o + 2] = by_l * tx + turn * nx
            gradient[o + 3] = by_l * ty + turn * ny
            gradient[o] = -(by_s + by_l) * tx - by_q * nx - turn * nx
            gradient[o + 1] = -(by_s + by_l) * ty - by_q * ny - turn * ny
            gradient[o + 4] = pull * 4.0 * inside * (1.0 - inside)
            gradient[o + 5] = along * across
            by_blur = amplitude * (
                along * across * rest**2 / blur**3 + across * (edge1 * (s - length) - edge0 * s) / blur
            )
            gradient[o + 6] = by_blur * blur
        miss = grey[i] - value
        squares += miss * miss
        for a in range(size):
            if gradient[a] != 0.0:
                right[a] += gradient[a] * miss
                for b in range(a + 1):
                    normal[a, b] += gradient[a] * gradient[b]
    for a in range(size):
        for b in range(a):
            normal[b, a] = normal[a, b]
    return normal, right, squares


@njit(cache=True, error_model="numpy")
def streak_grey(column, row, p):  # type: ignore[no-untyped-def]
    """Return the grey levels of fitted streaks and background at pixels [eq:streaks-profile]."""
    out = np.full(column.size, p[p.size - 1])
    root = math.sqrt(2.0)
    for k in range((p.size - 1) // 7):
        o = 7 * k
        dx, dy = p[o + 2] - p[o], p[o + 3] - p[o + 1]
        length = math.sqrt(dx * dx + dy * dy) + 1e-9
        blur = math.exp(p[o + 6])
        for i in range(column.size):
            ux, uy = column[i] - p[o], row[i] - p[o + 1]
            s = (ux * dx + uy * dy) / length
            q = (uy * dx - ux * dy) / length
            inside = min(max(s / length, 0.0), 1.0)
            rest = q - 4.0 * p[o + 4] * inside * (1.0 - inside)
            along = 0.5 * (math.erf(s / (root * blur)) - math.erf((s - length) / (root * blur)))
            out[i] += p[o + 5] * along * math.exp(-0.5 * (rest / blur) ** 2)
    return out


@njit(cache=True, error_model="numpy")
def gather_pixels(place, light, starts, sweeps):  # type: ignore[no-untyped-def]
    """Share pixels out among line segments, each moved to its pixels until they fit; the best of several starts.

    Parameters
    ----------
    place : ndarray, shape (pixels, 2)
    light : ndarray, shape (pixels,)
        Weights, positive.
    starts : ndarray of int, shape (starts, segments, 2)
        Pixels that the segments run between at first.
    sweeps : int

    Returns
    -------
    ndarray of int, shape (pixels,)
        Segment of every pixel; -1 everywhere where no start leaves each segment six pixels.
    """
    pixels, count = place.shape[0], starts.shape[1]
    best = np.full(pixels, -1)
    smallest = np.inf
    group = np.zeros(pixels, dtype=np.int64)
    ends = np.zeros((count, 4))
    for trial in range(starts.shape[0]):
        for k in range(count):
            a, b = starts[trial, k, 0], starts[trial, k, 1]
            ends[k, 0], ends[k, 1], ends[k, 2], ends[k, 3] = place[a, 0], place[a, 1], place[b, 0], place[b, 1]
        cost = 0.0
        for _ in range(sweeps):
            cost = 0.0
            for i in range(pixels):
                nearest, where = np.inf, 0
                for k in range(count):
                    dx, dy = ends[k, 2] - ends[k, 0], ends[k, 3] - ends[k, 1]
                    ux, uy = place[i, 0] - ends[k, 0], place[i, 1] - ends[k, 1]
                    share = (ux * dx + uy * dy) / max(dx * dx + dy * dy, 1e-9)
                    share = min(max(share, 0.0), 1.0)
                    square = (ux - share * dx) ** 2 + (uy - share * dy) ** 2
                    if square < nearest:
                        nearest, where = square, k
                group[i] = where
                cost += nearest * light[i]
            for k in range(count):
                _move_segment(place, light, group, k, ends)
        enough = True
        for k in range(count):
            enough = enough and (group == k).sum() >= 6
        if enough and cost < smallest:
            smallest = cost
            best = group.copy()
    return best


@njit(cache=True, error_model="numpy")
def _move_segment(place, light, group, k, ends):  # type: ignore[no-untyped-def]
    """Lay a segment along the main axis of its pixels, from the first to the last of them."""
    total, mx, my, members = 0.0, 0.0, 0.0, 0
    for i in range(place.shape[0]):
        if group[i] == k:
            total += light[i]
            mx += light[i] * place[i, 0]
            my += light[i] * place[i, 1]
            members += 1
    if members < 4:
        return
    mx, my = mx / total, my / total
    xx, xy, yy = 0.0, 0.0, 0.0
    for i in range(place.shape[0]):
        if group[i] == k:
            dx, dy = place[i, 0] - mx, place[i, 1] - my
            xx += light[i] * dx * dx
            xy += light[i] * dx * dy
            yy += light[i] * dy * dy
    angle = 0.5 * math.atan2(2.0 * xy, xx - yy)
    tx, ty = math.cos(angle), math.sin(angle)
    low, high = np.inf, -np.inf
    for i in range(place.shape[0]):
        if group[i] == k:
            along = (place[i, 0] - mx) * tx + (place[i, 1] - my) * ty
            low, high = min(low, along), max(high, along)
    ends[k, 0], ends[k, 1] = mx + low * tx, my + low * ty
    ends[k, 2], ends[k, 3] = mx + high * tx, my + high * ty
