"""Sine, cosine and the falling exponential in arithmetic alone, so that loops over components become vector code.

The functions of the C library are called one by one and take most of the time of a sum over the components of a sea.
Here the argument is brought near zero by whole quarters of a turn, or by whole powers of two, and a Taylor polynomial
does the rest; rounding is that of the argument (tests hold 1e-15).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.compiled import njit

#: Multiplication and addition in one rounding: nothing that would undo the reduction of arguments.
CONTRACT: Any = {"contract"}
#: Sums in any order, for loops that add up.
REORDER: Any = {"contract", "reassoc", "nsz"}
#: A quarter of a turn in three parts, the first two of 33 bits: their products with whole numbers are exact.
QUARTER, QUARTER_REST, QUARTER_LAST = 1.57079632673412561417, 6.07710050630396597660e-11, 2.02226624879595063154e-21
#: Natural logarithm of two in two parts, the first of 32 bits.
LOG_TWO, LOG_TWO_REST = 6.93147180369123816490e-01, 1.90821492927058770002e-10
QUARTERS_PER_RADIAN, TWOS_PER_UNIT = 2.0 / math.pi, 1.0 / math.log(2.0)
#: Exponents below which the exponential counts as that of this one.
LEAST_EXPONENT = -700.0
#: 2^-n.
HALVINGS = 0.5 ** np.arange(1024.0)


@njit(cache=True, error_model="numpy", fastmath=CONTRACT)
def sine_and_cosine(angle: float) -> tuple[float, float]:
    """Return sine and cosine of an angle of up to some million radians."""
    turns = np.floor(angle * QUARTERS_PER_RADIAN + 0.5)
    r = ((angle - turns * QUARTER) - turns * QUARTER_REST) - turns * QUARTER_LAST
    s = r * r
    # 1 / n! with signs in turn, from n = 15 and 16 down
    odd = 1.0 / 6227020800.0 - s / 1307674368000.0
    odd = 1.0 / 362880.0 + s * (-1.0 / 39916800.0 + s * odd)
    odd = 1.0 + s * (-1.0 / 6.0 + s * (1.0 / 120.0 + s * (-1.0 / 5040.0 + s * odd)))
    even = -1.0 / 87178291200.0 + s / 20922789888000.0
    even = -1.0 / 3628800.0 + s * (1.0 / 479001600.0 + s * even)
    even = 1.0 + s * (-0.5 + s * (1.0 / 24.0 + s * (-1.0 / 720.0 + s * (1.0 / 40320.0 + s * even))))
    sine, cosine = r * odd, even
    half, whole = 0.5 * turns, 0.25 * turns
    # an odd number of quarters changes places, two quarters change the sign
    swapped = half - np.floor(half) > 0.25
    sign = -1.0 if whole - np.floor(whole) > 0.375 else 1.0
    return sign * (cosine if swapped else sine), sign * (-sine if swapped else cosine)


@njit(cache=True, error_model="numpy", fastmath=CONTRACT)
def falling_exponential(exponent: float) -> float:
    """Return e^x for an exponent of zero or less, that of -700 below it and where it is no number."""
    x = exponent if exponent > LEAST_EXPONENT else LEAST_EXPONENT
    x = x if x < 0.0 else 0.0
    twos = np.floor(x * TWOS_PER_UNIT + 0.5)
    r = (x - twos * LOG_TWO) - twos * LOG_TWO_REST
    # 1 / n! from n = 13 down
    total = 1.0 / 479001600.0 + r / 6227020800.0
    total = 1.0 / 3628800.0 + r * (1.0 / 39916800.0 + r * total)
    total = 1.0 / 40320.0 + r * (1.0 / 362880.0 + r * total)
    total = 1.0 / 720.0 + r * (1.0 / 5040.0 + r * total)
    total = 1.0 / 24.0 + r * (1.0 / 120.0 + r * total)
    total = 0.5 + r * (1.0 / 6.0 + r * total)
    return float((1.0 + r * (1.0 + r * total)) * HALVINGS[int(-twos)])
