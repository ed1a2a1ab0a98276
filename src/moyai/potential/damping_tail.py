"""How radiation damping falls at high frequency, decided coefficient by coefficient and reported."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.potential.oscillatory import power_tail
from moyai.sea.water import Water, check_water

TailKind = Literal["zero", "negligible", "theory", "series", "power"]

#: Share of the largest damping below which a coefficient at the last frequency needs no tail
_NEGLIGIBLE = 1e-7
#: Share of the given damping within which a theoretical tail or a fitted series has to lie
_TRUST = 0.05
_STEEPEST = 24.0


@checks_words
@dataclass(frozen=True)
class Tail:
    """Damping beyond the last frequency: sum of coefficient (start/omega)^exponent, [eq:memory-tail-series]."""

    #: ``theory``: the exact leading terms with two matched corrections; ``series``: omega^-3 and omega^-5 matched;
    #: ``power``: one fitted exponent; ``negligible``: one steep power of no consequence; ``zero``: no damping at all;
    #: one of "zero", "negligible", "theory", "series", "power".
    kind: TailKind
    #: Last frequency given [rad/s].
    start: float
    #: Exponents of the terms.
    exponents: tuple[float, ...]
    #: Coefficients of the terms: their values at ``start``.
    coefficients: tuple[float, ...]
    #: Why this kind was taken.
    reason: str

    def damping(self, omega: ArrayLike) -> Array:
        """Return the damping at frequencies beyond ``start``."""
        ratio = self.start / np.asarray(omega, dtype=float)
        out = np.zeros(ratio.shape)
        for exponent, coefficient in zip(self.exponents, self.coefficients, strict=True):
            out += coefficient * ratio**exponent
        return out

    def cosine(self, time: Array) -> Array:
        """Return the integral of damping times cos(omega t) beyond ``start``."""
        out = np.zeros(len(time))
        for exponent, coefficient in zip(self.exponents, self.coefficients, strict=True):
            out += coefficient * self.start * power_tail(exponent, self.start * time).real
        return out

    def sine_over_frequency(self, time: Array) -> Array:
        """Return the integral of damping times sin(omega t)/omega beyond ``start``."""
        out = np.zeros(len(time))
        for exponent, coefficient in zip(self.exponents, self.coefficients, strict=True):
            out += coefficient * power_tail(exponent + 1.0, self.start * time).imag
        return out


@dataclass(frozen=True)
class TailTheory:
    """Leading high-frequency terms that are known exactly, for matrix entry (i, j): coefficient omega^-exponent."""

    entry: tuple[int, int]
    exponents: tuple[float, ...]
    coefficients: tuple[float, ...]


def wall_sided_tails(water: Water, centre_height: float) -> tuple[TailTheory, ...]:
    """Return the exact leading damping of sway and roll of a section with two vertical walls at the waterline.

    A short wave is reflected by the wall as by a cliff, its pressure doubled; with the Haskind relation the damping of
    sway, sway-roll and roll follows, [eq:memory-wall-tail]. It holds where the waves are short against the height of
    the vertical part of the walls. Sway of a thin plate obeys the same law.

    Parameters
    ----------
    water : Water
        Density and gravity (the depth does not matter for short waves).
    centre_height : float
        z of the centre of roll [m], negative below still water.

    Returns
    -------
    tuple of TailTheory
        For modes in the order sway, heave, roll, per metre.

    Examples
    --------
    >>> from moyai.potential import wall_sided_tails
    >>> from moyai.sea import Water
    >>> tails = wall_sided_tails(Water(depth=10.0, density=1025.0, gravity=9.81), centre_height=-0.2)
    >>> [tail.entry for tail in tails]                                   # rows and columns of the damping matrix
    [(0, 0), (0, 2), (2, 0), (2, 2)]
    >>> tails[0].exponents, round(tails[0].coefficients[0])              # sway: 4 rho g^2 omega^-3 [kg/(m s4)]
    ((3.0,), 394568)
    """
    check_water(water)
    rho, g, z = water.density, water.gravity, centre_height
    # Moment of exp(K z)(z - centre) over the wall: -(centre/K + 1/K^2)
    sway = TailTheory((0, 0), (3.0,), (4.0 * rho * g**2,))
    cross = (3.0, 5.0), (-4.0 * rho * g**2 * z, -4.0 * rho * g**3)
    roll = (3.0, 5.0, 7.0), (4.0 * rho * g**2 * z**2, 8.0 * rho * g**3 * z, 4.0 * rho * g**4)
    return sway, TailTheory((0, 2), *cross), TailTheory((2, 0), *cross), TailTheory((2, 2), *roll)


def choose_tail(omega: Array, damping: Array, slope: float, largest: float, theory: TailTheory | None) -> Tail:
    """Decide the tail of one coefficient.

    Parameters
    ----------
    omega, damping : ndarray (n,)
        The coefficient at the given frequencies.
    slope : float
        Its derivative at the last frequency.
    largest : float
        Largest damping of the pair of modes, the measure of what is negligible.
    theory : TailTheory, optional
        Exact leading terms; taken when they agree with the last values.
    """
    start, value = float(omega[-1]), float(damping[-1])
    if not np.any(damping) or largest == 0.0:
        return Tail("zero", start, (), (), "the damping vanishes at every frequency")
    upper = omega >= 0.85 * start
    if theory is not None:
        parts = np.array([c * omega**-e for e, c in zip(theory.exponents, theory.coefficients, strict=True)])
        # The terms of roll nearly cancel at some frequency: the sum of their magnitudes is the fair measure
        error = float(np.max(np.abs(parts.sum(axis=0) - damping)[upper]) / np.max(np.abs(parts).sum(axis=0)[upper]))
        if error < _TRUST:
            terms = [c * start**-e for e, c in zip(theory.exponents, theory.coefficients, strict=True)]
            next_exponent = max(theory.exponents) + 4.0
            rest = value - sum(terms)
            rest_slope = slope * start + sum(e * c for e, c in zip(theory.exponents, terms, strict=True))
            pair = _matched_pair(rest, rest_slope, next_exponent)
            reason = f"exact leading terms, within {error:.1e} of the last values"
            exponents = (*theory.exponents, next_exponent, next_exponent + 2.0)
            return Tail("theory", start, exponents, (*terms, *pair), reason)
    if abs(value) < _NEGLIGIBLE * largest:
        return Tail("negligible", start, (8.0,), (value,), f"{abs(value) / largest:.1e} of the largest at the end")
    ratio = start / omega[upper]
    height = float(np.max(np.abs(damping[upper])))
    pair = _matched_pair(value, slope * start, 3.0)
    error = float(np.max(np.abs(pair[0] * ratio**3 + pair[1] * ratio**5 - damping[upper]))) / height
    local = -slope * start / value if value else 0.0
    if local >= 3.0:
        exponent = min(local, _STEEPEST)
        alone = float(np.max(np.abs(value * ratio**exponent - damping[upper]))) / height
        if alone < error:
            reason = f"slope of the last values, omega^-{local:.1f}, within {alone:.1e}"
            return Tail("power", start, (exponent,), (value,), reason)
    if error < _TRUST:
        reason = f"omega^-3, omega^-5 match the last values to {error:.1e}"
    else:
        reason = f"no law fits (slope omega^{-local:.1f}): omega^-3, omega^-5 matched in value and slope"
    return Tail("series", start, (3.0, 5.0), pair, reason)


def _matched_pair(value: float, slope: float, exponent: float) -> tuple[float, float]:
    """Coefficients of u^-p and u^-(p + 2) at u = 1 that give a value and a slope."""
    second = -(slope + exponent * value) / 2.0
    return value - second, second
