"""Compiled layers of what waves add to the Green function, from tables and near the surface in closed form."""

from __future__ import annotations

import math
from typing import Any

from moyai.core.compiled import njit

#: Distance from the mirror of the source in the surface, times K, within which the closed form serves in place of a
#: table: there the function grows like the logarithm of the distance.
NEAR = 1.0
#: Distance, over the root of the area of a panel, at which its own function is taken where it lies in the surface: the
#: mean logarithm of the distance over a disc.
OWN = 0.6065 / math.sqrt(math.pi)
_MOMENTS, _TERMS = 20, 11
_EULER = 0.5772156649015329


@njit(cache=True, error_model="numpy")
def deep_wave(x: float, y: float) -> tuple[float, float, float]:
    """Return PV of the integral of e^{-ty} J0(tx) / (t - 1) over t > 0 and its derivatives by x and y.

    By power series, for x and y in 0 ... 1.2, not both zero [eq:units-deep-wave].
    """
    r = math.sqrt(x * x + y * y)
    decay = math.exp(-y)
    if x < 1e-8:
        x = 1e-8
    # J0, J1, Y0, Y1, and Struve's H0, H1, of which all but the logarithm are sums of powers
    quarter, term = 0.25 * x * x, 1.0
    j0, j1, harmonic, y0_sum, y1_sum = 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(_TERMS):
        if n > 0:
            term *= -quarter / (n * n)
            harmonic += 1.0 / n
        j0 += term
        y0_sum -= term * harmonic
        part = term / (n + 1)
        j1 += part
        y1_sum += part * (2.0 * harmonic + 1.0 / (n + 1) - 2.0 * _EULER)
    j1 *= 0.5 * x
    log = math.log(0.5 * x)
    y0 = 2.0 / math.pi * ((log + _EULER) * j0 + y0_sum)
    y1 = 2.0 / math.pi * (log * j1 - 1.0 / x) - 0.5 * x / math.pi * y1_sum
    h0, h1, odd = 0.0, 0.0, 2.0 / math.pi * x
    for n in range(_TERMS):
        h0 += odd
        # H1 = 2/pi - H0': the derivative of each power
        h1 -= odd * (2 * n + 1) / x
        odd *= -(x * x) / ((2 * n + 3) * (2 * n + 3))
    h1 += 2.0 / math.pi
    # moments of t^n / sqrt(x^2 + t^2) over 0 < t < y
    before, now = math.log((y + r) / x), y * y / (r + x)
    shape, slope, factorial, power = before, now, 1.0, 1.0
    for n in range(1, _MOMENTS):
        factorial *= n
        power *= y
        shape += now / factorial
        before, now = now, (power * r - n * x * x * before) / (n + 1)
        slope += now / factorial
    value = -decay * (0.5 * math.pi * (h0 + y0) + shape)
    by_x = y / (r * x) - decay * (1.0 - 0.5 * math.pi * (h1 + y1)) - decay * slope / x
    if x <= 1e-8:
        by_x = 0.0
    return value, by_x, -1.0 / r - value


@njit(cache=True, error_model="numpy")
def _from_table(table: Any, steps: Any, x: float, y: float) -> tuple[float, float, float]:
    """Return value and derivatives at x, y from the corner of a table, by bicubic Hermite polynomials.

    It holds value, slopes and mixed derivative (nx, ny, 4), even in x and in a ln(1 + y / a), ``a`` the last of the
    steps.
    """
    stretch = 1.0 + y / steps[2]
    across, up = x / steps[0], steps[2] * math.log(stretch) / steps[1]
    i, j = min(int(across), table.shape[0] - 2), min(int(up), table.shape[1] - 2)
    s, t = across - i, up - j
    q, u = 1.0 - s, 1.0 - t
    a0, a1, a2, a3 = q * q * (1.0 + 2.0 * s), s * s * (3.0 - 2.0 * s), s * q * q, -s * s * q
    b0, b1, b2, b3 = u * u * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t), t * u * u, -t * t * u
    c0, c2, c3 = -6.0 * s * q, q * (1.0 - 3.0 * s), s * (3.0 * s - 2.0)
    d0, d2, d3 = -6.0 * t * u, u * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)
    value, by_x, by_y = 0.0, 0.0, 0.0
    for place in range(2):
        row = table[i + place]
        if place == 0:
            a, e, c, g = a0, a2, c0, c2
        else:
            a, e, c, g = a1, a3, -c0, c3
        low, high = row[j], row[j + 1]
        plain = b0 * low[0] + b1 * high[0] + steps[1] * (b2 * low[2] + b3 * high[2])
        tilted = steps[0] * (b0 * low[1] + b1 * high[1] + steps[1] * (b2 * low[3] + b3 * high[3]))
        rising = d0 * (low[0] - high[0]) + steps[1] * (d2 * low[2] + d3 * high[2])
        turning = steps[0] * (d0 * (low[1] - high[1]) + steps[1] * (d2 * low[3] + d3 * high[3]))
        value += a * plain + e * tilted
        by_x += c * plain + g * tilted
        by_y += a * rising + e * turning
    return value, by_x / steps[0], by_y / (steps[1] * stretch)


@njit(cache=True, error_model="numpy", nogil=True)
def wave_layers(target: Any, panels: Any, green: Any, single: Any, double: Any) -> None:
    """Add the layers of the part of the Green function that waves make, all but 1/r, its two mirrors and the logarithm.

    Parameters
    ----------
    target : ndarray (q, 3)
        [m].
    panels : tuple
        Centres and normals (n, 3), areas (n,) that stand for an integral [m2].
    green : tuple
        K and k [1/m], factor of the far waves and depth [m]; tables of the surface, of the same without the deep wave,
        of the bed, of J0(kR); steps of the tables.
    single, double : ndarray (q, n), complex
        Layers of -G / 4 pi and of its derivative along the normals of the panels.
    """
    centre, normal, area = panels
    surface, k, factor, depth, far_table, near_table, bed_table, bessel, steps = green
    finite = not math.isinf(depth)
    scale = -0.25 / math.pi
    whole = 1.0 + math.exp(-2.0 * k * depth)
    for row in range(target.shape[0]):
        x, y, z = target[row, 0], target[row, 1], target[row, 2]
        back = math.exp(-k * (z + 2.0 * depth)) if finite else 0.0
        own = (math.exp(k * z) + back) / whole
        for n in range(centre.shape[0]):
            dx, dy, zeta = centre[n, 0] - x, centre[n, 1] - y, centre[n, 2]
            r, v = math.sqrt(dx * dx + dy * dy), z + zeta
            outward = (normal[n, 0] * dx + normal[n, 1] * dy) / r if r > 0.0 else 0.0
            upward, size = normal[n, 2], area[n]
            apart = math.sqrt(r * r + v * v)
            real, slope = 0.0, 0.0
            if surface * apart >= NEAR:
                value, by_r, by_v = _from_table(far_table, steps, r, -v)
                real += size * value
                slope += size * (by_r * outward - by_v * upward)
            else:
                beside = r
                if v == 0.0 and r < OWN * math.sqrt(size):
                    beside = OWN * math.sqrt(size)
                value, by_x, by_y = deep_wave(surface * beside, -surface * v)
                distance = math.sqrt(beside * beside + v * v)
                value += math.log(distance - v)
                by_x = surface * by_x + beside / (distance * (distance - v))
                by_y = surface * by_y + 1.0 / distance
                real += 2.0 * surface * value * size
                slope += 2.0 * surface * (by_x * outward - by_y * upward) * size
                if finite:
                    value, by_r, by_v = _from_table(near_table, steps, r, -v)
                    real += size * value
                    slope += size * (by_r * outward - by_v * upward)
            if finite:
                value, by_r, by_v = _from_table(bed_table, steps, r, abs(z - zeta))
                real += size * value
                slope += size * (by_r * outward + (by_v if zeta > z else -by_v) * upward)
            along = r / steps[0]
            i = min(int(along), bessel.shape[0] - 2)
            s = along - i
            q = 1.0 - s
            left, right = bessel[i], bessel[i + 1]
            wave = q * q * ((1.0 + 2.0 * s) * left[0] + s * steps[0] * left[1])
            wave += s * s * ((3.0 - 2.0 * s) * right[0] - q * steps[0] * right[1])
            turned = q * q * ((1.0 + 2.0 * s) * left[1] + s * steps[0] * left[2])
            turned += s * s * ((3.0 - 2.0 * s) * right[1] - q * steps[0] * right[2])
            up = math.exp(k * zeta)
            down = math.exp(-k * (zeta + 2.0 * depth)) if finite else 0.0
            far = 2.0 * math.pi * factor * own / whole * size
            single[row, n] += scale * (real + 1j * far * (up + down) * wave)
            double[row, n] += scale * (
                slope + 1j * far * ((up + down) * turned * outward + k * (up - down) * wave * upward)
            )
