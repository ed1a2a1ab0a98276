"""Array types and the small checks that every module of this package makes of its arguments."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError


def square_matrix(value: ArrayLike, size: int, name: str) -> Array:
    """Return ``value`` as a finite (size, size) array, or raise."""
    matrix = np.asarray(value, dtype=float)
    if matrix.shape != (size, size):
        raise InputError(f"{name} has the shape {matrix.shape}", parameter=name, allowed=f"({size}, {size})")
    values: Array = finite(matrix, name)
    return values


def finite(value: Any, name: str) -> Any:
    """Return ``value`` unchanged when every number in it is finite, or raise."""
    if not np.all(np.isfinite(value)):
        raise InputError(f"{name} holds a number that is not finite", parameter=name, allowed="finite numbers")
    return value


def positive(value: float, name: str) -> float:
    """Return ``value`` when it is finite and greater than zero, or raise."""
    if not math.isfinite(value) or value <= 0.0:
        raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
    return float(value)


def increasing(value: ArrayLike, name: str) -> Array:
    """Return ``value`` as a strictly increasing 1-D array, or raise."""
    array = np.atleast_1d(np.asarray(value, dtype=float))
    if array.ndim != 1 or array.size == 0 or np.any(np.diff(array) <= 0.0):
        raise InputError(f"{name} is not a strictly increasing list", parameter=name)
    values: Array = finite(array, name)
    return values
