"""Planar oscillatory flow about a circle: the laminar limits of Stokes and Wang, and Hall's stability limit."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError


def _positive(name: str, value: ArrayLike) -> Array:
    array = np.asarray(value, dtype=float)
    if not (np.isfinite(array).all() and (array > 0.0).all()):
        raise InputError(
            f"{name} holds a value that is not a positive number", parameter=name, allowed="greater than 0"
        )
    return array


def stokes_wang_inertia(beta: ArrayLike) -> Array:
    """Return C_M = 2 + 4 (pi beta)^(-1/2) + (pi beta)^(-3/2) of a circle [eq:morison-stokes-wang].

    Parameters
    ----------
    beta : array_like
        Frequency parameter D^2 f / nu, large against one.
    """
    x = math.pi * _positive("beta", beta)
    return np.asarray(2.0 + 4.0 * x**-0.5 + x**-1.5)


def stokes_wang_drag(keulegan_carpenter: ArrayLike, beta: ArrayLike) -> Array:
    """Return C_D = (3 pi^3 / 2 KC) ((pi beta)^(-1/2) + (pi beta)^(-1) - (pi beta)^(-3/2) / 4) [eq:morison-stokes-wang].

    Parameters
    ----------
    keulegan_carpenter, beta : array_like
        KC = u T / D and D^2 f / nu.
    """
    x = math.pi * _positive("beta", beta)
    number = _positive("keulegan_carpenter", keulegan_carpenter)
    return np.asarray(1.5 * math.pi**3 / number * (x**-0.5 + 1.0 / x - 0.25 * x**-1.5))


def hall_limit(beta: ArrayLike) -> Array:
    """Return the KC at which laminar planar flow becomes unstable, 5.778 beta^(-1/4) (1 + 0.205 beta^(-1/4)).

    Hall (1984) [eq:morison-hall]; beyond it the formulas of Stokes and Wang give too little drag.
    """
    root = _positive("beta", beta) ** -0.25
    return np.asarray(5.778 * root * (1.0 + 0.205 * root))
