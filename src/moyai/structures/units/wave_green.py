"""What waves add to the Green function in water of any depth: exact, tabulated once a frequency [eq:units-green-waves].

The Green function of John (1950) is a sum of two functions of two numbers each, of the distance in plan R with z + zeta
and with z - zeta. They are tabulated with their derivatives: from the series of eigenfunctions where R is more than
half of the depth, from integrals round the poles within that. What grows like the logarithm of the distance from the
mirror of the source in the surface is the function of infinite depth, which has a closed form.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy import special

from moyai.core.arrays import Array, ComplexArray
from moyai.core.at_once import each_at_once, threads
from moyai.core.progress import Progress
from moyai.sea.dispersion import evanescent_wave_numbers, wave_number
from moyai.sea.water import Water
from moyai.structures.units.wave_green_kernel import wave_layers

#: Step of the tables over 1/k and over the depth
_OF_WAVE, _OF_DEPTH = 0.08, 0.05
#: Depth, times k, over which steps downwards grow by as much as they are, and places of a table that are found at once
_GROWTH, _AT_ONCE = 4.0, 50_000
#: Share of the depth from which the series of eigenfunctions serves, and its terms
_SERIES_FROM, _SERIES = 0.5, 26
#: Exponent at which integrands have fallen below rounding
_FADED = 40.0
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_TWENTY, _OF_TWENTY = np.polynomial.legendre.leggauss(20)
#: Depth, times the wave number, beyond which the wave of infinite depth has faded to rounding
_DEEP = 30.0
#: Distance from the axis at which functions with a logarithm there are taken on it, times the wave number
_ON_AXIS = 1e-7


@dataclass(frozen=True, eq=False)
class WaveGreen:
    """What waves add to the Green function at one frequency: all but 1/r and its mirrors in surface and bed."""

    #: omega^2 / g [1/m].
    surface_number: float
    #: [1/m].
    wave_number: float
    #: (k^2 - K^2) cosh^2 kh / ((k^2 - K^2) h + K) [1/m].
    factor: float
    #: [m].
    depth: float
    #: Over distance in plan and depth z + zeta below the surface, without the logarithm: value, slopes, mixed
    #: derivative; shape (i, j, 4).
    far: Array
    #: The same without the function of infinite depth, which holds the logarithm.
    near: Array
    #: Over distance in plan and difference in depth; shape (i, j, 4).
    bed: Array
    #: J0(kR) and two derivatives over the distance in plan; shape (i, 3).
    bessel: Array
    #: Step in plan, first step downwards, depth over which steps downwards grow [m]; shape (3,).
    steps: Array

    @classmethod
    def of(cls, water: Water, omega: float, reach: float, lowest: float) -> WaveGreen:
        """Return the function at a frequency.

        Parameters
        ----------
        water : Water
        omega : float
            [rad/s].
        reach : float
            Largest distance in plan [m].
        lowest : float
            Level of the deepest point [m], negative.
        """
        surface, depth = omega**2 / water.gravity, water.depth
        k = float(wave_number(omega, depth, water.gravity))
        step = min(_OF_WAVE / k, _OF_DEPTH * depth)
        # a cell at least beyond the last distance
        r: Array = step * np.arange(math.ceil(reach / step) + 2.0)
        # downwards everything fades, and steps may grow
        growth = _GROWTH / k
        steps = np.array([step, step, growth])
        turns: Array = step * np.arange(math.ceil(growth * math.log1p(-2.0 * lowest / growth) / step) + 2.0)
        down: Array = growth * np.expm1(turns / growth)
        deep = np.concatenate([_deep_table(some, down, surface) for some in _in_blocks(r, down)])
        far = deep + 2.0 * surface * _logarithm(r, down)
        near = bed = np.zeros((2, 2, 4))
        if math.isfinite(depth):
            near, bed = _bed_tables(r, down, surface, k, water, omega, deep)
            far += near
        # slopes over the turns that the tables are even in
        for table in (far, near, bed) if math.isfinite(depth) else (far,):
            table[..., 2:] *= (1.0 + down / growth)[:, None]
        j0, j1 = special.j0(k * r), special.j1(k * r)
        with np.errstate(invalid="ignore", divide="ignore"):
            bend = np.where(r > 0.0, -(k**2) * (j0 - j1 / (k * r)), -0.5 * k**2)
        bessel = np.stack([j0, -k * j1, bend], axis=1)
        return cls(surface, k, far_factor(surface, k, depth), depth, far, near, bed, bessel, steps)

    def layers(self, target: Array, panels: tuple[Array, ...]) -> tuple[ComplexArray, ComplexArray]:
        """Return single and double layer (q, n) of -G / 4 pi at targets (q, 3); see :func:`wave_layers`."""
        single = np.zeros((len(target), len(panels[0])), dtype=complex)
        double, given = np.zeros_like(single), np.ascontiguousarray(target)
        edges = np.linspace(0, len(target), threads() + 1).astype(int)

        def some(ends: tuple[int, int], _: Progress) -> None:
            rows = slice(*ends)
            wave_layers(given[rows], panels, self._packed, single[rows], double[rows])

        each_at_once(some, [*pairwise(edges.tolist())])
        return single, double

    @property
    def _packed(self) -> tuple[Any, ...]:
        return (
            self.surface_number, self.wave_number, self.factor, self.depth, self.far, self.near, self.bed, self.bessel,
            self.steps,
        )  # fmt: skip


def _in_blocks(r: Array, down: Array) -> list[Array]:
    """Return distances in pieces whose integrals fit into memory."""
    return np.array_split(r, max(1, math.ceil(len(r) * len(down) / _AT_ONCE)))


def far_factor(surface: float, k: float, depth: float) -> float:
    """Return F of [eq:units-green-waves], of far waves [1/m]: (k^2 - K^2) cosh^2 kh / ((k^2 - K^2) h + K)."""
    if math.isinf(depth):
        return k
    # (k^2 - K^2) cosh^2 kh = k^2
    return k**2 / (k**2 * depth / math.cosh(min(k * depth, 300.0)) ** 2 + surface)


def _deep_table(r: Array, down: Array, surface: float) -> Array:
    """Return 2 K times the function of infinite depth with its derivatives (r, down, 4)."""
    x = np.maximum(surface * r, _ON_AXIS)[:, None]
    y = (surface * down)[None, :]
    apart = np.hypot(x, y)
    shape, slope = _moments(x, y)
    value = -0.5 * np.pi * np.exp(-y) * (special.struve(0, x) + special.y0(x)) - shape
    lift = 1.0 - 0.5 * np.pi * (special.struve(1, x) + special.y1(x))
    by_x = y / (apart * x) - np.exp(-y) * lift - slope / x
    by_x[r == 0.0] = 0.0
    by_y = -1.0 / apart - value
    # x / r^3 - L_x
    mixed = np.where(r[:, None] > 0.0, x / apart**3 - by_x, 0.0)
    scale = 2.0 * surface * surface ** np.array([0, 1, 1, 2])
    return np.stack([value, by_x, by_y, mixed], axis=-1) * scale


def _moments(x: Array, y: Array) -> tuple[Array, Array]:
    """Return the integrals of e^{t - y} / sqrt(x^2 + t^2) and of e^{t - y} t / sqrt(x^2 + t^2) over 0 < t < y."""
    x, y = np.broadcast_arrays(x, y)
    out = np.empty((2, *x.shape))
    deep, wide = y > _DEEP, x >= y
    # of deep ones what lies further up has fallen below rounding
    pieces = np.concatenate([[0.0], np.geomspace(2.0, _DEEP, 4)])
    back = (0.5 * np.diff(pieces)[:, None] * (_TWENTY + 1.0) + pieces[:-1, None]).ravel()
    shares = (0.5 * np.diff(pieces)[:, None] * _OF_TWENTY).ravel() * np.exp(-back)
    half = 0.5 * y[wide & ~deep][:, None]
    for chosen, t, weight in (
        (deep, y[deep][:, None] - back, shares),
        (wide & ~deep, half * (_TWENTY + 1.0), half * _OF_TWENTY * np.exp(half * (_TWENTY - 1.0))),
    ):
        part = weight / np.hypot(x[chosen][:, None], t)
        out[0, chosen], out[1, chosen] = part.sum(axis=1), (part * t).sum(axis=1)
    # recursion from moment to moment, stable where y is the larger
    left = ~(deep | wide)
    a, b = x[left], y[left]
    apart = np.hypot(a, b)
    before, now = np.log((b + apart) / a), b * b / (apart + a)
    shape, slope, factorial, power = before.copy(), now.copy(), 1.0, np.ones_like(b)
    for n in range(1, 40 + 4 * math.ceil(float(b.max(initial=0.0)))):
        factorial *= n
        power = power * b
        shape += now / factorial
        before, now = now, (power * apart - n * a * a * before) / (n + 1)
        slope += now / factorial
    out[0, left], out[1, left] = shape * np.exp(-b), slope * np.exp(-b)
    return out[0], out[1]


def _bed_tables(
    r: Array, down: Array, surface: float, k: float, water: Water, omega: float, deep: Array
) -> tuple[Array, Array]:
    """Return what the bed adds over z + zeta, less the deep wave, and over z - zeta (r, down, 4)."""
    depth = water.depth
    out = np.zeros((2, len(r), len(down), 4))
    within = r < _SERIES_FROM * depth
    mu, weight = _path(surface, k, depth)
    fall = np.exp(-2.0 * mu * depth)
    pole = (mu - surface) - (mu + surface) * fall
    own = fall * (mu + surface) ** 2 / (pole * (mu - surface))
    whole = (mu + surface) / pole
    level, drop = mu[:, None], mu[:, None] * down
    # over z + zeta: own e^{-mu down} + whole e^{-mu (4 h - down)}, and its derivative by down
    first, second = (
        weight[:, None] * item
        for item in (own[:, None] * np.exp(-drop), whole[:, None] * np.exp(drop - 4.0 * level * depth))
    )
    third, fourth = (
        weight[:, None] * whole[:, None] * np.exp(sign * drop - 2.0 * level * depth) for sign in (1.0, -1.0)
    )
    across, bent = special.jv(0, np.outer(r[within], mu)), -special.jv(1, np.outer(r[within], mu)) * mu
    for table, values, slopes in (
        (out[0], first + second, level * (second - first)), (out[1], third + fourth, level * (third - fourth))
    ):  # fmt: skip
        for column, left, right in ((0, across, values), (1, bent, values), (2, across, slopes), (3, bent, slopes)):
            table[within, :, column] = (left @ right).real
    beyond = ~within
    if beyond.any():
        for table, height, sign in ((out[0], 2.0 * depth - down, -1.0), (out[1], down, 1.0)):
            table[beyond] = _series(r[beyond], height, sign, surface, k, water, omega)
        mirror = _inverse_distance(r[beyond], down)
        out[0][beyond] -= mirror + deep[beyond]
    return out[0], out[1]


def _path(surface: float, k: float, depth: float) -> tuple[ComplexArray, ComplexArray]:
    """Return places and weights of integrals over the wave number, above the poles K and k."""
    end = _FADED / depth
    turn = min(k + surface, end)
    # no higher than J0 of complex arguments stays moderate within half of the depth
    top = complex(0.5 * turn, min(0.5 * turn, 12.0 / depth))
    corners = [0.0, top, complex(turn)] + ([complex(end)] if end > turn else [])
    places, weights = [], []
    for a, b in pairwise(corners):
        length = abs(b - a)
        # panels grow from both ends of a piece: K may lie close to zero
        edges = np.concatenate([[0.0], np.geomspace(1e-3, 0.5, 7)])
        edges = np.concatenate([edges, 1.0 - edges[-2::-1]]) * length
        longest = 2.0 / depth
        fine = np.concatenate(
            [np.linspace(x, y, math.ceil((y - x) / longest) + 1)[:-1] for x, y in pairwise(edges)] + [[length]]
        )
        half = 0.5 * np.diff(fine)
        along = (fine[:-1, None] + half[:, None] * (_NODES + 1.0)).ravel()
        direction = (b - a) / length
        places.append(a + direction * along)
        weights.append(direction * (half[:, None] * _WEIGHTS).ravel())
    return np.concatenate(places), np.concatenate(weights)


def _series(r: Array, height: Array, sign: float, surface: float, k: float, water: Water, omega: float) -> Array:
    """Return g of distance in plan and height, from eigenfunctions (r, height, 4) [eq:units-green-series].

    ``sign`` is that of the height with growing column number.
    """
    depth = water.depth
    other = evanescent_wave_numbers(omega, depth, water.gravity, _SERIES)
    out = np.zeros((len(r), len(height), 4))
    factor = far_factor(surface, k, depth)
    grown, back = np.exp(k * (height - 2.0 * depth)), np.exp(-2.0 * k * height)
    whole = (1.0 + math.exp(-2.0 * k * depth)) ** 2
    up, rise = grown * (1.0 + back) / whole, k * grown * (1.0 - back) / whole
    plan, bent = -2.0 * np.pi * factor * special.y0(k * r), 2.0 * np.pi * factor * k * special.y1(k * r)
    share = 2.0 * (other**2 + surface**2) / ((other**2 + surface**2) * depth - surface)
    turn = np.outer(other, height)
    wave, slope = np.cos(turn), -other[:, None] * np.sin(turn)
    far, fall = special.k0(np.outer(r, other)) * share, -special.k1(np.outer(r, other)) * share * other
    for column, (one, two, left, right) in enumerate(
        ((plan, up, far, wave), (bent, up, fall, wave), (plan, rise, far, slope), (bent, rise, fall, slope))
    ):
        out[..., column] = np.outer(one, two) + left @ right
    out -= _inverse_distance(r, height)
    out[..., 2:] *= sign
    return out


def _logarithm(r: Array, down: Array) -> Array:
    """Return ln(r1 + down) with its derivatives (r, down, 4); its place at zero is never read."""
    x, y = np.maximum(r, _ON_AXIS * r[1])[:, None], down[None, :]
    apart = np.hypot(x, y)
    by_x = x / (apart * (apart + y))
    by_x[r == 0.0] = 0.0
    mixed = np.where(r[:, None] > 0.0, -x / apart**3, 0.0)
    return np.stack([np.log(apart + y), by_x, 1.0 / apart, mixed], axis=-1)


def _inverse_distance(r: Array, height: Array) -> Array:
    """Return 1/sqrt(r^2 + height^2) with its derivatives (r, height, 4)."""
    x, y = r[:, None], height[None, :]
    apart = np.hypot(x, y)
    return np.stack([1.0 / apart, -x / apart**3, -y / apart**3, 3.0 * x * y / apart**5], axis=-1)
