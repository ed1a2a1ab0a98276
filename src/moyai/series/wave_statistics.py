"""Statistics of wave heights and other peaks: significant values, exceedance, Weibull and Rayleigh distributions."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.series.extremes import ExtremeFit, fit, kolmogorov_distance
from moyai.series.zero_crossing import share_of


def significant(values: ArrayLike, fraction: float = 1.0 / 3.0) -> float:
    """Return the mean of the highest ``fraction`` of the values, 1/3 for the significant value.

    The number of values is rounded to the nearest whole number, at least one. NaN for no values.
    """
    if not 0.0 < fraction <= 1.0:
        raise InputError(f"fraction is {fraction:g}", parameter="fraction", allowed="greater than 0, at most 1")
    array = np.sort(np.asarray(values, dtype=np.float64).reshape(-1))[::-1]
    if array.size == 0:
        return math.nan
    return float(np.mean(array[: share_of(array.size, fraction)]))


def exceedance(values: ArrayLike) -> tuple[Array, Array]:
    """Return sorted values (largest first) and their exceedance probabilities i / (N + 1)."""
    array = np.sort(np.asarray(values, dtype=np.float64).reshape(-1))[::-1]
    return array, np.arange(1, array.size + 1) / (array.size + 1.0)


def rayleigh_significant(fraction: float) -> float:
    """Return the mean of the highest ``fraction`` of Rayleigh heights over their root mean square [-].

    sqrt(ln 1/p) + sqrt(pi)/(2p) erfc(sqrt(ln 1/p)); 1.41573 for p = 1/3 [eq:sea-rayleigh].
    """
    if not 0.0 < fraction <= 1.0:
        raise InputError(f"fraction is {fraction:g}", parameter="fraction", allowed="greater than 0, at most 1")
    root = math.sqrt(-math.log(fraction))
    return root + 0.5 * math.sqrt(math.pi) / fraction * math.erfc(root)


def rayleigh_expected_maximum(count: int) -> float:
    """Return the expected largest of independent Rayleigh heights over their significant value [eq:sea-rayleigh].

    The integral of 1 - (1 - exp(-x^2))^N over x by Gauss panels; 1.5974, 1.7030, 1.9259 for N = 100, 200, 1000.

    Parameters
    ----------
    count : int
        Number N of heights, 1 or more.

    Returns
    -------
    float
        [-].

    Raises
    ------
    InputError
        For a count below 1.

    Examples
    --------
    >>> from moyai.series import rayleigh_expected_maximum
    >>> [round(rayleigh_expected_maximum(count), 3) for count in (100, 1000)]
    [1.597, 1.926]
    """
    if count < 1:
        raise InputError(f"count is {count}", parameter="count", allowed="at least 1")
    points, weights = np.polynomial.legendre.leggauss(20)
    edges = np.linspace(0.0, math.sqrt(math.log(count) + 45.0), 60)
    half = 0.5 * np.diff(edges)
    x = (0.5 * (edges[1:] + edges[:-1]))[:, None] + half[:, None] * points
    integrand = -np.expm1(count * np.log1p(-np.exp(-x * x)))
    return float(np.sum(half * (integrand @ weights))) / rayleigh_significant(1.0 / 3.0)


@dataclass(frozen=True)
class HeightFit:
    """Weibull distribution ``1 - exp(-(x / scale)^shape)`` of heights, and its uncertainty [eq:records-weibull]."""

    #: The distribution; a shape of 2 is Rayleigh's.
    fitted: ExtremeFit
    #: Standard error of the scale, by the observed information.
    scale_error: float
    #: Standard error of the shape, by the observed information.
    shape_error: float
    #: Largest distance of the empirical from the fitted distribution (Kolmogorov) [-].
    distance: float

    @property
    def scale(self) -> float:
        """Scale [unit of the heights]."""
        return self.fitted.scale

    @property
    def shape(self) -> float:
        """Shape [-]."""
        return self.fitted.shape


def fit_rayleigh(heights: ArrayLike) -> HeightFit:
    """Fit a Rayleigh distribution: its scale is the root mean square height [eq:records-weibull]."""
    x = _heights(heights)
    scale = math.sqrt(float(np.mean(x**2)))
    ratio = x / scale
    likelihood = float(np.sum(math.log(2.0 / scale) + np.log(ratio) - ratio**2))
    fitted = ExtremeFit("weibull", 0.0, scale, 2.0, int(x.size), likelihood)
    return HeightFit(fitted, scale / (2.0 * math.sqrt(x.size)), 0.0, kolmogorov_distance(fitted, x))


def fit_weibull(heights: ArrayLike) -> HeightFit:
    """Fit scale and shape by maximum likelihood [eq:records-weibull].

    Raises
    ------
    InputError
        With fewer than five different positive heights.
    """
    x = _heights(heights)
    fitted = fit(x, "weibull", location=0.0)
    scale, shape, n = fitted.scale, fitted.shape, x.size
    # Observed information of (shape, scale)
    z = np.log(x / scale)
    power = (x / scale) ** shape
    mixed = -float(np.sum(power * (1.0 + shape * z)) - n) / scale
    information = np.array([[n / shape**2 + float(np.sum(power * z**2)), mixed], [mixed, n * shape**2 / scale**2]])
    shape_error, scale_error = (float(error) for error in np.sqrt(np.diag(np.linalg.inv(information))))
    return HeightFit(fitted, scale_error, shape_error, kolmogorov_distance(fitted, x))


def _heights(heights: ArrayLike) -> Array:
    x = np.asarray(heights, dtype=np.float64).reshape(-1)
    x = x[np.isfinite(x)]
    if np.unique(x).size < 5 or (x <= 0.0).any():
        raise InputError(f"{x.size} heights", parameter="heights", allowed="five or more different, all greater than 0")
    return x
