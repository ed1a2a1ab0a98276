"""A frequency spectrum of the sea: density, moments, heights and periods.

Densities are one-sided over angular frequency [m2 s/rad]. A spectrum made from a closed shape keeps the shape: its
moments, periods and quantiles are those of the formula on (0, inf), not of the table that it also carries.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.single import plain
from moyai.sea import dispersion
from moyai.sea import spectral_integrals as integrals
from moyai.sea.spectrum_file import spectrum_table


@dataclass(frozen=True)
class WindSeaShape:
    """One wind-sea peak: scale omega^-5 exp(-5/4 (omega_p/omega)^4) gamma^r phi(omega) [eq:sea-jonswap]."""

    #: Coefficient of omega^-5 [m2 rad^4/s^4].
    scale: float
    #: Peak frequency omega_p of the deep-water form [rad/s].
    peak_omega: float
    #: gamma [-]; 1 gives Pierson-Moskowitz.
    peak_enhancement: float = 1.0
    #: Width of the peak below omega_p [-].
    sigma_low: float = 0.07
    #: Width of the peak above omega_p [-].
    sigma_high: float = 0.09
    #: Depth of the TMA depth function [m]; infinite where it is not applied.
    depth: float = math.inf
    #: Gravity of the TMA depth function [m/s2].
    gravity: float = math.nan

    def __call__(self, omega: Array) -> Array:
        """Return the density [m2 s/rad] at ``omega`` [rad/s], zero at and below zero."""
        omega = np.asarray(omega, dtype=np.float64)
        relative = np.maximum(omega, 1e-3 * self.peak_omega) / self.peak_omega
        density = self.scale * (self.peak_omega * relative) ** -5 * np.exp(-1.25 * relative**-4)
        if self.peak_enhancement != 1.0:
            sigma = np.where(relative <= 1.0, self.sigma_low, self.sigma_high)
            density = density * self.peak_enhancement ** np.exp(-0.5 * ((relative - 1.0) / sigma) ** 2)
        if not math.isinf(self.depth):
            density = density * depth_function(np.maximum(omega, 0.0), self.depth, self.gravity)
        return np.where(omega > 0.0, density, 0.0)


def depth_function(omega: ArrayLike, water_depth: float, gravity: float) -> Any:
    """Return Kitaigorodskii's depth function phi [-], tanh^2 kh / (1 + 2kh/sinh 2kh) [eq:sea-tma].

    1 in deep water, omega^2 h / (2 g) in shallow water.

    Parameters
    ----------
    omega : array_like
        Angular frequency [rad/s], 0 or more.
    water_depth : float
        [m], greater than 0; infinite is allowed.
    gravity : float
        [m/s2].

    Returns
    -------
    ndarray
        phi [-], of the shape of ``omega``.

    Raises
    ------
    InputError
        When an argument is negative or NaN.

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> spectra.depth_function([0.1, 3.0], water_depth=10.0, gravity=9.81).round(4).tolist()   # shallow, deep
    [0.0051, 1.0]
    """
    frequency = np.asarray(omega, dtype=np.float64)
    if math.isinf(water_depth):
        return plain(np.ones_like(frequency))
    kh = np.asarray(dispersion.wave_number(frequency, water_depth, gravity)) * water_depth
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        ratio = np.where(kh > 0.0, 4.0 * kh * np.exp(-2.0 * kh) / -np.expm1(-4.0 * kh), 1.0)
    return plain(np.tanh(kh) ** 2 / (1.0 + ratio))


@dataclass(frozen=True, eq=False)
class Spectrum:
    """A frequency spectrum of the sea.

    Raises
    ------
    InputError
        When the table has fewer than two points, is not increasing, or holds a negative or non-finite value.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.sea import Spectrum
    >>> omega = np.linspace(0.5, 1.5, 101)
    >>> spectrum = Spectrum(omega, 0.25 * np.ones(101), name="measured")
    >>> round(spectrum.significant_height, 3)                            # 4 sqrt(0.25 m2) [m]
    2.0
    """

    #: Angular frequencies [rad/s], strictly increasing, not negative.
    omega: Array
    #: One-sided spectral density S [m2 s/rad] at ``omega``, not negative.
    density: Array
    #: For instance ``jonswap``.
    name: str
    #: What the spectrum was made from, SI.
    parameters: Mapping[str, Any] = field(default_factory=dict)
    #: Closed shapes whose sum is the spectrum; empty for a table, which is linear between its points and zero outside.
    shapes: tuple[WindSeaShape, ...] = ()
    #: Lower band limit [rad/s]: the spectrum is zero below.
    lower: float = 0.0
    #: Upper band limit [rad/s]: the spectrum is zero above.
    upper: float = math.inf

    def __post_init__(self) -> None:
        omega, density = spectrum_table(self.omega, self.density, what="omega", unit="rad/s")
        for array in (omega, density):
            array.setflags(write=False)
        object.__setattr__(self, "omega", omega)
        object.__setattr__(self, "density", density)
        object.__setattr__(self, "parameters", MappingProxyType(dict(self.parameters)))
        if not 0.0 <= self.lower < self.upper:
            raise InputError(
                f"spectrum band {self.lower:g} to {self.upper:g} rad/s", parameter="upper", allowed="0 <= lower < upper"
            )

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by value; the read-only mapping itself cannot be pickled."""
        values = (np.array(self.omega), np.array(self.density), self.name, dict(self.parameters))
        return Spectrum, (*values, self.shapes, self.lower, self.upper)

    def density_at(self, omega: ArrayLike) -> Any:
        """Return the density [m2 s/rad] at any frequencies [rad/s]: the formula, or the table interpolated linearly.

        Parameters
        ----------
        omega : array_like (...)
            [rad/s].
        """
        frequency = np.asarray(omega, dtype=np.float64)
        if self.shapes:
            value = sum((shape(frequency) for shape in self.shapes), np.zeros_like(frequency))
        else:
            value = np.interp(frequency, self.omega, self.density, left=0.0, right=0.0)
        return plain(np.where((frequency >= self.lower) & (frequency <= self.upper), value, 0.0))

    def _edges(self, lower: float, upper: float) -> Array:
        peaks = tuple(shape.peak_omega for shape in self.shapes)
        return integrals.shape_edges(peaks, max(lower, self.lower), min(upper, self.upper))

    def _integral(self, exponent: float, power: int, lower: float, upper: float) -> float:
        def weight(omega: Array) -> Array:
            return omega**exponent

        if not self.shapes:
            low, high = max(lower, self.lower), min(upper, self.upper)
            return integrals.integrate_table(self.omega, self.density, weight, power, low, high)

        def integrand(omega: Array) -> Array:
            total = sum((shape(omega) for shape in self.shapes), np.zeros_like(omega))
            return np.asarray(total**power * omega**exponent)

        return integrals.integrate_shape(integrand, self._edges(lower, upper))

    def moment(self, order: float, lower: float = 0.0, upper: float = math.inf) -> float:
        """Return the spectral moment m_n, the integral of omega^n S over the band [eq:sea-moments].

        Parameters
        ----------
        order : float
            n; negative orders allowed.
        lower, upper : float
            Limits of integration [rad/s].

        Returns
        -------
        float
            m_n [m2 (rad/s)^n].

        Raises
        ------
        InputError
            When the moment diverges: order 4 and above of an omega^-5 tail without an upper limit.
        """
        if self.shapes and order >= 4.0 and math.isinf(min(upper, self.upper)):
            raise InputError(
                f"moment {order:g} of an omega^-5 tail diverges", parameter="upper", remedy="give an upper frequency"
            )
        return self._integral(order, 1, lower, upper)

    def energy_below(self, omega: ArrayLike) -> Any:
        """Return the variance [m2] of the frequencies below ``omega`` [rad/s].

        Parameters
        ----------
        omega : array_like (...)
            [rad/s].
        """
        frequency = np.asarray(omega, dtype=np.float64)
        return plain(self._energy_below()(np.ravel(frequency)).reshape(frequency.shape))

    def _energy_below(self) -> integrals.Density:
        """Return the variance below frequencies, shape (n,), as a function of these: what it integrates stands."""
        if self.shapes:
            cumulative: integrals.Density = integrals.cumulative_shape(self.density_at, self._edges(0.0, math.inf))
            nothing = 0.0
        else:
            cumulative = partial(integrals.cumulative_table, self.omega, self.density)
            nothing = float(cumulative(np.array([self.lower]))[0])
        return lambda omega: cumulative(np.clip(omega, self.lower, self.upper)) - nothing

    def quantile(self, fraction: ArrayLike) -> Any:
        """Return the frequency [rad/s] below which ``fraction`` (between 0 and 1) of the variance lies.

        Parameters
        ----------
        fraction : array_like (...)
            0 to 1 [-].

        Raises
        ------
        InputError
            For a fraction outside 0 to 1.
        """
        wanted = np.asarray(fraction, dtype=np.float64)
        if ((wanted < 0.0) | (wanted > 1.0) | np.isnan(wanted)).any():
            raise InputError("fraction outside 0 to 1", parameter="fraction", allowed="0 to 1")
        if self.shapes:
            low = max(self.lower, integrals.LOWEST * min(shape.peak_omega for shape in self.shapes))
            # energy above s peaks is below s^-4, so this bracket holds for all but the last 1e-16 of the variance
            high = min(self.upper, 2e4 * max(shape.peak_omega for shape in self.shapes))
        else:
            low, high = max(self.lower, float(self.omega[0])), min(self.upper, float(self.omega[-1]))
        below = self._energy_below()
        target = np.ravel(wanted) * float(below(np.array([high]))[0])
        return plain(integrals.invert_cumulative(below, self.density_at, target, low, high).reshape(wanted.shape))

    @property
    def variance(self) -> float:
        """Variance m_0 [m2]."""
        return self.moment(0)

    @property
    def significant_height(self) -> float:
        """Significant height H_m0 = 4 sqrt(m_0) [m]."""
        return 4.0 * math.sqrt(self.moment(0))

    @cached_property
    def peak_omega(self) -> float:
        """Frequency of the largest density [rad/s]: of the formula, or the largest entry of a table."""
        if not self.shapes:
            inside = (self.omega >= self.lower) & (self.omega <= self.upper)
            return float(self.omega[inside][np.argmax(self.density[inside])])
        peaks = [shape.peak_omega for shape in self.shapes]
        grid = np.unique(np.concatenate([np.geomspace(0.5 * peak, 2.0 * peak, 401) for peak in peaks] + [peaks]))
        grid = grid[(grid >= self.lower) & (grid <= self.upper)]
        if grid.size == 0:
            return self.upper
        best = int(np.argmax(self.density_at(grid)))
        if any(grid[best] == peak for peak in peaks):
            return float(grid[best])
        low, high = grid[max(best - 1, 0)], grid[min(best + 1, grid.size - 1)]
        golden = 0.5 * (math.sqrt(5.0) - 1.0)
        for _ in range(60):
            left, right = high - golden * (high - low), low + golden * (high - low)
            if self.density_at(left) < self.density_at(right):
                low = left
            else:
                high = right
        found = 0.5 * (low + high)
        # the top is flat: the peak of a formula is one where the density there is no lower but for rounding
        tops = [peak for peak in peaks if grid[0] <= peak <= grid[-1]]
        nearest = min(tops, key=lambda peak: abs(peak - found), default=found)
        as_high = self.density_at(nearest) >= (1.0 - 8.0 * np.finfo(np.float64).eps) * self.density_at(found)
        return float(nearest if as_high else found)

    @property
    def peak_period(self) -> float:
        """Peak period T_p [s]."""
        return 2.0 * math.pi / self.peak_omega

    @property
    def mean_period(self) -> float:
        """Mean period T_m01 = 2 pi m_0 / m_1 [s]."""
        return 2.0 * math.pi * self.moment(0) / self.moment(1)

    @property
    def zero_crossing_period(self) -> float:
        """Mean zero-crossing period T_m02 = 2 pi sqrt(m_0 / m_2) [s]."""
        return 2.0 * math.pi * math.sqrt(self.moment(0) / self.moment(2))

    @property
    def energy_period(self) -> float:
        """Energy period T_e = T_m-1,0 = ``2 pi m_-1 / m_0`` [s]."""
        return 2.0 * math.pi * self.moment(-1) / self.moment(0)

    def broadness(self, upper: float = math.inf) -> float:
        """Return epsilon = sqrt(1 - m_2^2 / (m_0 m_4)) of Cartwright and Longuet-Higgins (1956) [-].

        ``upper`` [rad/s] must be finite for an omega^-5 tail, on which epsilon depends.

        Parameters
        ----------
        upper : float
            Upper limit of the moments [rad/s].

        Raises
        ------
        InputError
            When the fourth moment diverges.
        """
        m0, m2, m4 = (self.moment(order, upper=upper) for order in (0, 2, 4))
        return math.sqrt(max(1.0 - m2 * m2 / (m0 * m4), 0.0))

    @property
    def peakedness(self) -> float:
        """Goda's peakedness Q_p = 2 / m_0^2 times the integral of omega S^2 [-]; 2 for Pierson-Moskowitz."""
        return 2.0 * self._integral(1.0, 2, 0.0, math.inf) / self.moment(0) ** 2

    def truncated(self, lower: float, upper: float) -> Spectrum:
        """Return the spectrum cut to a band [rad/s]; its energy outside the band is gone, nothing is scaled up.

        Parameters
        ----------
        lower, upper : float
            Ends of the band [rad/s].
        """
        return replace(self, lower=max(lower, self.lower), upper=min(upper, self.upper))

    def scaled(self, factor: float) -> Spectrum:
        """Return the spectrum with all densities multiplied by ``factor`` [-].

        Parameters
        ----------
        factor : float
            [-].
        """
        shapes = tuple(replace(shape, scale=shape.scale * factor) for shape in self.shapes)
        return replace(self, density=self.density * factor, shapes=shapes)
