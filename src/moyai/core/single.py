"""Numbers for single values, arrays for many: what a function hands back has the shape of what it was given."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike


def plain(values: ArrayLike) -> Any:
    """Return a single value as a float, and everything else as the array that it is.

    Parameters
    ----------
    values : array_like

    Returns
    -------
    float or ndarray
        A float where numpy would leave a scalar of its own or an array without dimensions.
    """
    array = np.asarray(values, dtype=float)
    return float(array) if array.ndim == 0 else array
