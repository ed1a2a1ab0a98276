"""Capytaine as a peer in finite depth, its sum of exponentials for the bed fitted closer.

Delhommeau writes what the bed adds as sources mirrored at depths that follow from a sum of exponentials. The fits that
come with Capytaine are 0.003 to 0.05 off where the function is of order one, which is 1 to 3 % in the heave damping of
a box; the one here is some 1e-5 off.
"""

from __future__ import annotations

import logging
import math
from contextlib import suppress
from functools import lru_cache
from typing import Any

import numpy as np
from scipy.optimize import least_squares

from moyai.core.arrays import Array

#: Exponentials, and the error that ends the search
EXPONENTIALS, CLOSE = 8, 2e-5
#: Places of the fit: x is the wave number times the depth
_PLACES = np.concatenate([np.linspace(1e-6, 6.0, 240), np.geomspace(6.05, 60.0, 120)])
_TURNS = 60


def capytaine_mesh(corners: Array) -> Any:
    """Return panels (n, 4, 3) as a mesh of Capytaine; triangles repeat their first corner."""
    from capytaine.meshes.meshes import Mesh

    count = len(corners)
    faces = np.arange(4 * count).reshape(count, 4)
    repeated = np.linalg.norm(corners[:, 3] - corners[:, 0], axis=1) < 1e-12
    faces[repeated, 3] = faces[repeated, 0]
    return Mesh(corners.reshape(-1, 3), faces, auto_clean=False, auto_check=False)


@lru_cache(maxsize=1)
def closer_green_function() -> Any:
    """Return Capytaine's Green function with its own sum of exponentials."""
    from capytaine.green_functions.delhommeau import Delhommeau

    logging.getLogger("capytaine").setLevel(logging.ERROR)

    class Closer(Delhommeau):  # type: ignore[misc, unused-ignore]
        """The Green function with its own sum of exponentials."""

        def find_best_exponential_decomposition(self, dimensionless_wavenumber: float, *, method: Any = None) -> Array:
            return exponentials(float(dimensionless_wavenumber))

    return Closer()


def bed_function(kh: float, x: Array) -> Array:
    """Return what the exponentials stand for at x >= 0."""
    surface = kh * math.tanh(kh)
    pole = (1.0 + math.tanh(kh)) ** 2 / (1.0 - math.tanh(kh) ** 2 + math.tanh(kh) / kh)
    decay = np.exp(-2.0 * x)
    whole = 2.0 * (x + surface) / (x * (1.0 - decay) - surface * (1.0 + decay))
    return np.asarray(whole - pole / (x - kh) - 2.0)


@lru_cache(maxsize=512)
def exponentials(kh: float) -> Array:
    """Return rates and amplitudes (2, EXPONENTIALS) of the sum of exponentials.

    Parameters
    ----------
    kh : float
        Wave number times depth [-].
    """
    # a place at the pole itself is of no use: both terms are infinite there
    x = _PLACES[np.abs(_PLACES - kh) > 1e-4 * kh]
    wanted = bed_function(kh, x)
    small = 1e-5 * np.eye(EXPONENTIALS)

    def amplitudes(rates: Array) -> tuple[Array, Array]:
        basis = np.exp(-np.outer(x, np.exp(rates)))
        found = np.linalg.lstsq(
            np.vstack([basis, small]), np.concatenate([wanted, np.zeros(EXPONENTIALS)]), rcond=None
        )[0]
        return found, basis @ found - wanted

    class _Close(Exception):
        """The error is small enough."""

    best: list[Any] = [math.inf, None]

    def misfit(rates: Array) -> Array:
        error = amplitudes(rates)[1]
        size = float(np.abs(error).max())
        if size < best[0]:
            best[:] = [size, np.array(rates)]
        if size < CLOSE:
            raise _Close
        return error

    start = np.linspace(math.log(0.05), math.log(8.0), EXPONENTIALS)
    with suppress(_Close):
        least_squares(misfit, start, method="lm", max_nfev=_TURNS * EXPONENTIALS)
    return np.stack([-np.exp(best[1]), amplitudes(best[1])[0]])
