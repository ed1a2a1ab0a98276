"""Squared velocity over the depth of a curtain: equation (1) of Tabata et al., exact for any relative depth.

The measure is the mean over the curtain's depth of the square of wave plus current velocity under the crest of a linear
wave. It is neither a mean in time (which has half of the wave part and no cross part) nor the square of a mean speed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.sea import dispersion
from moyai.sea.breaking import breaking_limit
from moyai.sea.water import Water

DirectionRule = Literal["paper", "normal", "none"]

_SOURCE = "Tabata et al., field observation of mooring forces of a new-type silt curtain"
_RULES: dict[str, int] = {"paper": 2, "normal": 1, "none": 0}


@checks_words
def effective_height(
    significant_height: ArrayLike, angle: ArrayLike, rule: DirectionRule, height_ratio: float
) -> Array:
    """Return the wave height that acts on a curtain, r H_1/3 times a power of the cosine [m].

    Parameters
    ----------
    significant_height : array_like
        H_1/3 [m].
    angle : array_like
        Between the direction of travel and the normal of the curtain [rad], 0 = square onto it; at most a right angle.
    rule : {"paper", "normal", "none"}
        cos^2 as printed, cos (the part of the velocity normal to the curtain), or no reduction.
    height_ratio : float
        r = H_max / H_1/3 [-]; 1.8 in the paper.

    Raises
    ------
    InputError
        Beyond 90 degrees, for a negative height or an unknown rule.

    Notes
    -----
    With the paper's rule the squared velocity goes with cos^4 where there is no current, while the paper states that
    tension goes with cos^2, which is what ``normal`` gives [eq:curtain-effective-height]; see
    :func:`check_direction_rule`.
    """
    height, beta = np.asarray(significant_height, dtype=np.float64), np.asarray(angle, dtype=np.float64)
    if rule not in _RULES:
        raise InputError(f"unknown direction rule {rule!r}", parameter="direction_rule", allowed=", ".join(_RULES))
    if not (np.all(np.isfinite(beta)) and np.all(np.abs(beta) <= 0.5 * math.pi * (1.0 + 1e-12))):
        raise InputError(
            f"waves at {math.degrees(float(np.max(np.abs(beta)))):.4g} degrees from the normal of the curtain",
            parameter="angle",
            allowed="at most 90 degrees",
            remedy="measure the angle from the other side of the curtain",
        )
    if not (np.all(np.isfinite(height)) and np.all(height >= 0.0)):
        raise InputError(f"wave height is {np.min(height):g} m", parameter="significant_height", allowed="at least 0 m")
    if not (math.isfinite(height_ratio) and height_ratio > 0.0):
        raise InputError(f"height ratio is {height_ratio:g}", parameter="height_ratio", allowed="greater than 0")
    values: Array = height_ratio * height * np.maximum(np.cos(beta), 0.0) ** _RULES[rule]
    return values


def _factors(period: ArrayLike, curtain_depth: ArrayLike, water: Water) -> tuple[Array, Array, Array, Array]:
    """Return omega, and the depth means of cosh^2 k(z+h)/sinh^2 kh, cosh k(z+h)/sinh kh, and coth kh.

    Written with e = exp(-2kh), exp(-2kd) and the like only: nothing grows with kh.
    """
    time, d = np.asarray(period, dtype=np.float64), np.asarray(curtain_depth, dtype=np.float64)
    if not (np.all(np.isfinite(time)) and np.all(time > 0.0)):
        raise InputError(f"period is {np.min(time):g} s", parameter="period", allowed="greater than 0 s")
    if not (np.all(d > 0.0) and np.all(d <= water.depth)):
        raise InputError(
            f"curtain depth is {np.max(d) if np.any(d > water.depth) else np.min(d):g} m in water of {water.depth:g} m",
            parameter="curtain_depth",
            allowed=f"above 0 to {water.depth:g} m",
        )
    omega = 2.0 * math.pi / time
    k = dispersion.wave_number(omega, water.depth, water.gravity)
    deep = math.isinf(water.depth)
    kd = k * d
    far = np.zeros_like(k) if deep else np.exp(-2.0 * k * water.depth)  # e^{-2kh}
    below = np.zeros_like(kd) if deep else np.exp(-2.0 * k * (water.depth - d))  # e^{-2k(h-d)}
    fall = -np.expm1(-2.0 * kd)  # 1 - e^{-2kd}
    sink = np.asarray(1.0) if deep else -np.expm1(-2.0 * k * water.depth)  # 1 - e^{-2kh}
    # [sinh 2kh - sinh 2k(h-d)]/4 = e^{2kh} fall (1 + e^{-2kh} below)/8, and sinh^2 kh = e^{2kh} sink^2/4
    squared = (0.5 * fall * (1.0 + far * below) + 2.0 * kd * far) / (kd * sink**2)
    half = np.zeros_like(kd) if deep else np.exp(-k * (2.0 * water.depth - d))  # e^{-2kh} e^{kd}
    # sinh kh - sinh k(h-d) = e^{kh} (1 - e^{-kd}) (1 + e^{-2kh} e^{kd})/2, over sinh kh = e^{kh} sink/2
    single = -np.expm1(-kd) * (1.0 + half) / (kd * sink)
    return omega, squared, single, (1.0 + far) / sink


def squared_velocity(
    height: ArrayLike, period: ArrayLike, current: ArrayLike, curtain_depth: ArrayLike, water: Water
) -> Array:
    """Return the mean over the curtain of the squared velocity under the crest [m2/s2], equation (1) of the paper.

    Parameters
    ----------
    height, period : array_like
        Wave height [m] and period [s].
    current : array_like
        Component normal to the curtain, uniform over depth, positive with the wave [m/s].
    curtain_depth : array_like
        Depth d of the toe [m], at most the water depth.
    water : Water
        Depth and gravity; infinite depth allowed.

    Raises
    ------
    InputError
        When a height is negative, a period not positive, or the curtain deeper than the water.

    Notes
    -----
    [eq:curtain-squared-velocity]. The wave number is that of still water, as in the paper.
    """
    high = np.asarray(height, dtype=np.float64)
    if not np.all(high >= 0.0):
        raise InputError(f"height is {np.min(high):g} m", parameter="height", allowed="at least 0 m")
    omega, squared, single, _ = _factors(period, curtain_depth, water)
    speed, u = 0.5 * high * omega, np.asarray(current)
    values: Array = speed**2 * squared + 2.0 * u * speed * single + u**2
    return values


def mean_squared_velocity(
    height: ArrayLike, period: ArrayLike, current: ArrayLike, curtain_depth: ArrayLike, water: Water
) -> Array:
    """Return the mean over curtain and wave period of the squared velocity [m2/s2], for comparison.

    Half of the wave part, no cross part [eq:curtain-squared-velocity-mean]; arguments as :func:`squared_velocity`.
    """
    omega, squared, _, _ = _factors(period, curtain_depth, water)
    values: Array = 0.5 * (0.5 * np.asarray(height) * omega) ** 2 * squared + np.asarray(current) ** 2
    return values


def surface_speed(height: ArrayLike, period: ArrayLike, water: Water) -> Array:
    """Return the largest horizontal velocity of a linear wave at still water, (pi H/T) coth kh [m/s]."""
    depth = water.depth if math.isfinite(water.depth) else 1.0
    omega, _, _, coth = _factors(period, depth, water)
    return 0.5 * np.asarray(height) * omega * coth


@dataclass(frozen=True)
class ProportionalFit:
    """Tension in proportion to the squared velocity, T = c u2."""

    #: c [N s2/m2].
    factor: float
    #: Of the factor [N s2/m2].
    standard_error: float
    #: R^2 about the mean [-]; negative when a constant would fit better.
    determination: float


def fit_proportional(squared: ArrayLike, tension: ArrayLike) -> ProportionalFit:
    """Fit tensions [N] by a line through the origin over squared velocities [m2/s2] [eq:curtain-proportional].

    Raises
    ------
    InputError
        For fewer than three pairs, or squared velocities that are all zero.
    """
    x, y = np.asarray(squared, dtype=np.float64), np.asarray(tension, dtype=np.float64)
    if x.ndim != 1 or x.shape != y.shape or x.size < 3 or not np.any(x):
        raise InputError(
            f"{x.size} and {y.size} values", parameter="squared", allowed="equal lists of at least 3, not all 0"
        )
    total = float(x @ x)
    factor = float(x @ y) / total
    left = float(np.sum((y - factor * x) ** 2))
    spread = float(np.sum((y - y.mean()) ** 2))
    error = math.sqrt(left / (x.size - 1) / total)
    return ProportionalFit(factor, error, 1.0 - left / spread if spread > 0.0 else math.nan)


@checks_words
def check_direction_rule(rule: DirectionRule, measure: Literal["squared_velocity", "energy"]) -> tuple[Notice, ...]:
    """Tell where a direction rule contradicts the paper's finding that tension goes with cos^2.

    Parameters
    ----------
    rule : {"paper", "normal", "none"}
        In use.
    measure : {"squared_velocity", "energy"}
        What the tension is taken from: in proportion to the squared velocity, or by the energy model, linear in height.
    """
    power = _RULES[rule] * (2 if measure == "squared_velocity" else 1)
    if power == 2:
        return ()
    better = "normal" if measure == "squared_velocity" else "paper"
    return (
        Notice(
            "curtain-direction-rule",
            f"direction rule '{rule}': without current tension goes with cos^{power} of the angle; cos^2 was observed",
            float(power),
            2.0,
            "information",
            f"rule '{better}' gives cos^2 here",
            _SOURCE,
        ),
    )


def check_squared_velocity(height: float, period: float, current: float, water: Water) -> tuple[Notice, ...]:
    """Tell where the measure has no meaning: a breaking wave, or an opposing current faster than the wave's water."""
    notices = []
    limit = breaking_limit(period, water)
    if height > limit.height:
        notices.append(
            Notice(
                "curtain-wave-breaks",
                f"a wave of {height:.3g} m and {period:.3g} s breaks ({limit.criterion}, {limit.height:.3g} m): "
                "the squared velocity of linear theory has no meaning",
                height,
                limit.height,
                "error",
                "lower the wave or lengthen its period",
                _SOURCE,
            )
        )
    if current < 0.0 and -current > float(surface_speed(height, period, water)):
        notices.append(
            Notice(
                "curtain-opposing-current",
                f"the current of {current:.3g} m/s against the wave is faster than its water: the largest load is at "
                "the trough, and the phase of the crest is not the largest",
                current,
                -float(surface_speed(height, period, water)),
                "warning",
                "count the current positive in the direction in which the load acts",
                _SOURCE,
            )
        )
    return tuple(notices)
