"""Limiting heights of regular waves."""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.core.errors import InputError
from moyai.sea import dispersion
from moyai.sea.water import Water, check_water


@dataclass(frozen=True)
class BreakingLimit:
    """The smallest of the limiting heights that apply."""

    #: Limiting height [m].
    height: float
    #: Name and form of the criterion that governs.
    criterion: str
    #: Where it comes from.
    source: str


def miche_height(wavelength: float, water_depth: float) -> float:
    """Return Miche's limiting height 0.142 L tanh kh [m], 0.142 L in deep water [eq:sea-miche]."""
    return 0.142 * wavelength * math.tanh(2.0 * math.pi * water_depth / wavelength)


def mccowan_height(water_depth: float) -> float:
    """Return McCowan's limiting height of a solitary wave 0.78 h [m], infinite in infinite depth [eq:sea-mccowan]."""
    return 0.78 * water_depth


def highest_steady_wave(wavelength: float, water_depth: float) -> float:
    """Return the height of the highest steady wave of a given length [m] [eq:sea-highest].

    Fenton's (1990) fit to the computations of Williams (1981): 0.141 L in deep water, 0.833 h for long waves.
    """
    if math.isinf(water_depth):
        return 0.141063 * wavelength
    ratio = wavelength / water_depth
    above = ratio * (0.141063 + ratio * (0.0095721 + ratio * 0.0077829))
    below = 1.0 + ratio * (0.0788340 + ratio * (0.0317567 + ratio * 0.0093407))
    return water_depth * above / below


def linear_wavelength(period: float, water: Water, current_along_wave: float = 0.0) -> float:
    """Return the wavelength [m] of linear theory for a period [s] in the fixed frame."""
    check_water(water)
    if not (math.isfinite(period) and period > 0.0):
        raise InputError(f"wave period is {period:g} s", parameter="period", allowed="greater than 0 s")
    omega = 2.0 * math.pi / period
    k = dispersion.wave_number_in_current(omega, water.depth, water.gravity, current_along_wave)
    return 2.0 * math.pi / float(k)


def breaking_limit(period: float, water: Water, current_along_wave: float = 0.0) -> BreakingLimit:
    """Return the limiting height of a regular wave: the lower of [eq:sea-miche] and [eq:sea-mccowan].

    Parameters
    ----------
    period : float
        [s], in the fixed frame.
    water : Water
        Depth and gravity.
    current_along_wave : float
        Uniform current along the heading [m/s].

    Returns
    -------
    BreakingLimit
        Height [m], the criterion that decides and its source.

    Raises
    ------
    InputError
        Where the current blocks the wave, or the period is not positive.

    Examples
    --------
    >>> from moyai.sea import Water, breaking_limit
    >>> limit = breaking_limit(6.0, Water(depth=4.0, density=1025.0, gravity=9.81))
    >>> round(limit.height, 2), limit.criterion
    (3.05, 'Miche 0.142 L tanh kh')
    """
    length = linear_wavelength(period, water, current_along_wave)
    miche, mccowan = miche_height(length, water.depth), mccowan_height(water.depth)
    if mccowan < miche:
        return BreakingLimit(mccowan, "McCowan 0.78 h", "McCowan (1894)")
    if 2.0 * math.pi * water.depth / length > math.pi:
        return BreakingLimit(miche, "deep-water limit 0.142 L", "Michell (1893)")
    return BreakingLimit(miche, "Miche 0.142 L tanh kh", "Miche (1944)")
