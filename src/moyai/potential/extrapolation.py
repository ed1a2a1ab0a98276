"""Limit of a sequence whose error is known to fall like given powers of the number of terms."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray


def extrapolated_limit(terms: NDArray[Any], exponent: ArrayLike) -> NDArray[Any]:
    """Return the limit of values at doubled counts whose error is a power series in 1/count, [eq:reference-richardson].

    Parameters
    ----------
    terms : ndarray (levels, ...)
        Values at ``count``, ``2 count``, ``4 count``, ...
    exponent : array_like
        Leading exponent p, ``S - S_M = M^-p (d0 + d1/M + ...)``; of a shape that broadcasts.
    """
    levels = len(terms)
    # Coordinates scaled by the last level keep the small system well conditioned
    ratio = 0.5 ** np.arange(levels)[::-1]
    out = np.empty(np.broadcast_shapes(terms.shape[1:], np.shape(exponent)), dtype=terms.dtype)
    exponents = np.broadcast_to(exponent, out.shape)
    for value in np.unique(exponents):
        system = np.ones((levels, levels))
        for column in range(1, levels):
            system[:, column] = ratio ** -(value + column - 1.0)
        weights = np.linalg.solve(system.T, np.eye(levels)[0])
        chosen = exponents == value
        total = np.tensordot(weights, terms, axes=(0, 0))
        out[chosen] = np.broadcast_to(total, out.shape)[chosen]
    return out
