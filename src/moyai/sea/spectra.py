"""Frequency spectra of the sea: wind-sea shapes, measured tables, their moments and periods.

Densities are one-sided over angular frequency [m2 s/rad]. A spectrum made from a closed shape keeps the shape: its
moments, periods and quantiles are those of the formula on (0, inf), not of the table that it also carries.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.errors import InputError
from moyai.sea import dispersion
from moyai.sea import spectral_integrals as integrals
from moyai.sea.spectrum_file import read_spectrum_file, spectrum_table
from moyai.sea.water import Water

Array = NDArray[np.float64]

#: Table of a spectrum made from a formula when the caller names no frequencies, as multiples of the peak frequency.
DEFAULT_RELATIVE_FREQUENCIES = (0.3, 8.0, 771)


@dataclass(frozen=True)
class WindSeaShape:
    """One wind-sea peak: scale omega^-5 exp(-5/4 (omega_p/omega)^4) gamma^r phi(omega) [eq:sea-jonswap].

    Parameters
    ----------
    scale : float
        Coefficient of omega^-5 [m2 rad^4/s^4].
    peak_omega : float
        Peak frequency omega_p of the deep-water form [rad/s].
    peak_enhancement : float
        gamma [-]; 1 gives Pierson-Moskowitz.
    sigma_low, sigma_high : float
        Width of the peak below and above omega_p [-].
    depth, gravity : float
        Water of the TMA depth function; infinite depth where it is not applied.
    """

    scale: float
    peak_omega: float
    peak_enhancement: float = 1.0
    sigma_low: float = 0.07
    sigma_high: float = 0.09
    depth: float = math.inf
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


def depth_function(omega: ArrayLike, water_depth: float, gravity: float) -> Array:
    """Return Kitaigorodskii's depth function phi [-], tanh^2 kh / (1 + 2kh/sinh 2kh) [eq:sea-tma].

    1 in deep water, omega^2 h / (2 g) in shallow water.
    """
    frequency = np.asarray(omega, dtype=np.float64)
    if math.isinf(water_depth):
        return np.ones_like(frequency)
    kh = np.asarray(dispersion.wave_number(frequency, water_depth, gravity)) * water_depth
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        ratio = np.where(kh > 0.0, 4.0 * kh * np.exp(-2.0 * kh) / -np.expm1(-4.0 * kh), 1.0)
    return np.asarray(np.tanh(kh) ** 2 / (1.0 + ratio))


@dataclass(frozen=True, eq=False)
class Spectrum:
    """A frequency spectrum of the sea.

    Parameters
    ----------
    omega : array_like
        Angular frequencies [rad/s], strictly increasing, not negative.
    density : array_like
        One-sided spectral density S [m2 s/rad] at ``omega``, not negative.
    name : str
        For instance ``jonswap``.
    parameters : mapping
        What the spectrum was made from, SI.
    shapes : tuple of WindSeaShape
        Closed shapes whose sum is the spectrum; empty for a table, which is linear between its points and zero outside.
    lower, upper : float
        Band limits [rad/s]: the spectrum is zero outside.

    Raises
    ------
    InputError
        When the table has fewer than two points, is not increasing, or holds a negative or non-finite value.
    """

    omega: Array
    density: Array
    name: str
    parameters: Mapping[str, Any] = field(default_factory=dict)
    shapes: tuple[WindSeaShape, ...] = ()
    lower: float = 0.0
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
                f"spectrum band {self.lower:g} to {self.upper:g} rad/s", path="upper", allowed="0 <= lower < upper"
            )

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by value; the read-only mapping itself cannot be pickled."""
        values = (np.array(self.omega), np.array(self.density), self.name, dict(self.parameters))
        return Spectrum, (*values, self.shapes, self.lower, self.upper)

    def density_at(self, omega: ArrayLike) -> Array:
        """Return the density [m2 s/rad] at any frequencies [rad/s]: the formula, or the table interpolated linearly."""
        frequency = np.asarray(omega, dtype=np.float64)
        if self.shapes:
            value = sum((shape(frequency) for shape in self.shapes), np.zeros_like(frequency))
        else:
            value = np.interp(frequency, self.omega, self.density, left=0.0, right=0.0)
        return np.where((frequency >= self.lower) & (frequency <= self.upper), value, 0.0)

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
                f"moment {order:g} of an omega^-5 tail diverges", path="upper", remedy="give an upper frequency"
            )
        return self._integral(order, 1, lower, upper)

    def energy_below(self, omega: ArrayLike) -> Array:
        """Return the variance [m2] of the frequencies below ``omega`` [rad/s]."""
        frequency = np.asarray(omega, dtype=np.float64)
        flat = np.clip(np.ravel(frequency), self.lower, self.upper)
        if self.shapes:
            value = integrals.cumulative_shape(self.density_at, self._edges(0.0, math.inf), flat)
        else:
            value = integrals.cumulative_table(self.omega, self.density, flat)
            value = value - integrals.cumulative_table(self.omega, self.density, np.array([self.lower]))
        return np.asarray(value).reshape(frequency.shape)

    def quantile(self, fraction: ArrayLike) -> Array:
        """Return the frequency [rad/s] below which ``fraction`` (between 0 and 1) of the variance lies."""
        wanted = np.asarray(fraction, dtype=np.float64)
        if ((wanted < 0.0) | (wanted > 1.0) | np.isnan(wanted)).any():
            raise InputError("fraction outside 0 to 1", path="fraction", allowed="0 to 1")
        if self.shapes:
            low = max(self.lower, integrals._LOWEST * min(shape.peak_omega for shape in self.shapes))
            # energy above s peaks is below s^-4, so this bracket holds for all but the last 1e-16 of the variance
            high = min(self.upper, 2e4 * max(shape.peak_omega for shape in self.shapes))
        else:
            low, high = max(self.lower, float(self.omega[0])), min(self.upper, float(self.omega[-1]))
        target = np.ravel(wanted) * float(self.energy_below(high))
        return integrals.invert_cumulative(self.energy_below, self.density_at, target, low, high).reshape(wanted.shape)

    @property
    def variance(self) -> float:
        """Variance m_0 [m2]."""
        return self.moment(0)

    @property
    def significant_height(self) -> float:
        """Significant height H_m0 = 4 sqrt(m_0) [m]."""
        return 4.0 * math.sqrt(self.moment(0))

    @property
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
        return float(0.5 * (low + high))

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
        """Energy period T_e = T_m-1,0 = 2 pi m_-1 / m_0 [s]."""
        return 2.0 * math.pi * self.moment(-1) / self.moment(0)

    @property
    def narrowness(self) -> float:
        """Spectral width nu = sqrt(m_0 m_2 / m_1^2 - 1) of Longuet-Higgins (1975) [-]."""
        return math.sqrt(max(self.moment(0) * self.moment(2) / self.moment(1) ** 2 - 1.0, 0.0))

    def broadness(self, upper: float = math.inf) -> float:
        """Return epsilon = sqrt(1 - m_2^2 / (m_0 m_4)) of Cartwright and Longuet-Higgins (1956) [-].

        ``upper`` [rad/s] must be finite for an omega^-5 tail, on which epsilon depends.
        """
        m0, m2, m4 = (self.moment(order, upper=upper) for order in (0, 2, 4))
        return math.sqrt(max(1.0 - m2 * m2 / (m0 * m4), 0.0))

    @property
    def peakedness(self) -> float:
        """Goda's peakedness Q_p = 2 / m_0^2 times the integral of omega S^2 [-]; 2 for Pierson-Moskowitz."""
        return 2.0 * self._integral(1.0, 2, 0.0, math.inf) / self.moment(0) ** 2

    def truncated(self, lower: float, upper: float) -> Spectrum:
        """Return the spectrum cut to a band [rad/s]; its energy outside the band is gone, nothing is scaled up."""
        return replace(self, lower=max(lower, self.lower), upper=min(upper, self.upper))

    def scaled(self, factor: float) -> Spectrum:
        """Return the spectrum with all densities multiplied by ``factor`` [-]."""
        shapes = tuple(replace(shape, scale=shape.scale * factor) for shape in self.shapes)
        return replace(self, density=self.density * factor, shapes=shapes)

    def with_significant_height(self, significant_height: float) -> Spectrum:
        """Return the same form with another significant height H_m0 [m]."""
        _positive("significant_height", significant_height)
        return self.scaled((significant_height / self.significant_height) ** 2)


def _positive(name: str, value: float) -> float:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{name} is {value:g}", path=name, allowed="greater than 0")
    return float(value)


def _from_shape(shape: WindSeaShape, name: str, omega: ArrayLike | None, **parameters: Any) -> Spectrum:
    low, high, count = DEFAULT_RELATIVE_FREQUENCIES
    grid = np.linspace(low, high, count) * shape.peak_omega if omega is None else np.asarray(omega, dtype=np.float64)
    return Spectrum(grid, shape(grid), name, parameters, (shape,))


def _normalised(shape: WindSeaShape, significant_height: float) -> WindSeaShape:
    """Scale a shape by quadrature so that 4 sqrt(m_0) is the significant height."""
    area = integrals.integrate_shape(shape, integrals.shape_edges((shape.peak_omega,), 0.0, math.inf))
    return replace(shape, scale=shape.scale * significant_height**2 / (16.0 * area))


def jonswap(
    significant_height: float,
    peak_period: float,
    peak_enhancement: float,
    omega: ArrayLike | None = None,
    *,
    normalisation: Literal["quadrature", "goda", "goda_significant"] = "quadrature",
    sigma_low: float = 0.07,
    sigma_high: float = 0.09,
) -> Spectrum:
    """Return a JONSWAP spectrum of given significant height and peak period.

    Parameters
    ----------
    significant_height : float
        H_m0 [m]; with ``normalisation="goda_significant"`` H_1/3 of the zero-crossing analysis.
    peak_period : float
        T_p [s].
    peak_enhancement : float
        gamma [-]; 1 gives Pierson-Moskowitz.
    omega : array_like, optional
        Frequencies of the table [rad/s]; by default 0.3 to 8 peak frequencies.
    normalisation : {"quadrature", "goda", "goda_significant"}
        ``quadrature`` makes 4 sqrt(m_0) equal to ``significant_height`` to rounding [eq:sea-jonswap]. ``goda`` uses
        Goda's approximate factor 0.0624 / (0.230 + 0.0336 gamma - 0.185 / (1.9 + gamma)), whose H_m0 is right within
        1 % for gamma up to 7. ``goda_significant`` multiplies it by (1.094 - 0.01915 ln gamma), as design manuals
        print it, because H_1/3 of the zero-crossing analysis is smaller than H_m0: the resulting H_m0 is 3 to 5 %
        above the height given [eq:sea-goda-factor].
    sigma_low, sigma_high : float
        Peak widths of Hasselmann et al. (1973) [-].

    Raises
    ------
    InputError
        When a value is not positive or gamma is below 1.
    """
    _positive("significant_height", significant_height)
    peak = 2.0 * math.pi / _positive("peak_period", peak_period)
    if not (math.isfinite(peak_enhancement) and peak_enhancement >= 1.0):
        raise InputError(f"peak_enhancement is {peak_enhancement:g}", path="peak_enhancement", allowed="at least 1")
    _positive("sigma_low", sigma_low)
    _positive("sigma_high", sigma_high)
    shape = WindSeaShape(1.0, peak, peak_enhancement, sigma_low, sigma_high)
    if normalisation == "quadrature":
        shape = _normalised(shape, significant_height)
    elif normalisation in ("goda", "goda_significant"):
        factor = goda_factor(peak_enhancement, zero_crossing=normalisation == "goda_significant")
        # in f: beta H^2 Tp^-4 f^-5; S(omega) = S(f) / 2 pi and f^-5 = (2 pi)^5 omega^-5
        shape = replace(shape, scale=factor * significant_height**2 * peak**4)
    else:
        raise InputError(
            f"unknown normalisation {normalisation!r}",
            path="normalisation",
            allowed="quadrature, goda, goda_significant",
        )
    return _from_shape(
        shape,
        "jonswap",
        omega,
        significant_height=significant_height,
        peak_period=peak_period,
        peak_enhancement=peak_enhancement,
        normalisation=normalisation,
    )


def goda_factor(peak_enhancement: float, *, zero_crossing: bool) -> float:
    """Return Goda's approximate normalisation of JONSWAP [-] [eq:sea-goda-factor].

    Parameters
    ----------
    peak_enhancement : float
        gamma [-].
    zero_crossing : bool
        Whether the factor goes with H_1/3 of the zero-crossing analysis (beta_J of Goda, Random Seas and Design of
        Maritime Structures) or with H_m0.
    """
    gamma = peak_enhancement
    base = 0.0624 / (0.230 + 0.0336 * gamma - 0.185 / (1.9 + gamma))
    return base * (1.094 - 0.01915 * math.log(gamma)) if zero_crossing else base


def goda_peak_period(significant_period: float, peak_enhancement: float) -> float:
    """Return T_p = T_1/3 / (1 - 0.132 (gamma + 0.2)^-0.559) [s] of Goda (1988) [eq:sea-goda-period]."""
    _positive("significant_period", significant_period)
    return significant_period / (1.0 - 0.132 * (peak_enhancement + 0.2) ** -0.559)


def pierson_moskowitz(significant_height: float, peak_period: float, omega: ArrayLike | None = None) -> Spectrum:
    """Return the two-parameter Pierson-Moskowitz (ISSC) spectrum of H_m0 [m] and T_p [s] [eq:sea-pierson-moskowitz].

    Its moments are closed: m_0 = H^2/16, T_m01 = 0.7718 T_p, T_m02 = 0.7104 T_p, T_e = 0.8572 T_p.
    """
    _positive("significant_height", significant_height)
    peak = 2.0 * math.pi / _positive("peak_period", peak_period)
    shape = WindSeaShape(5.0 / 16.0 * significant_height**2 * peak**4, peak)
    return _from_shape(
        shape, "pierson_moskowitz", omega, significant_height=significant_height, peak_period=peak_period
    )


def pierson_moskowitz_of_wind(wind_speed: float, gravity: float, omega: ArrayLike | None = None) -> Spectrum:
    """Return the fully developed sea of Pierson and Moskowitz (1964) under a wind.

    Parameters
    ----------
    wind_speed : float
        Wind speed at 19.5 m above the sea [m/s].
    gravity : float
        [m/s2].
    omega : array_like, optional
        Frequencies of the table [rad/s].

    Notes
    -----
    alpha = 0.0081, beta = 0.74 in alpha g^2 omega^-5 exp(-beta (g / (U omega))^4).
    """
    speed, g = _positive("wind_speed", wind_speed), _positive("gravity", gravity)
    shape = WindSeaShape(0.0081 * g * g, (0.8 * 0.74) ** 0.25 * g / speed)
    return _from_shape(shape, "pierson_moskowitz", omega, wind_speed=speed, gravity=g)


def bretschneider_mitsuyasu(
    significant_height: float,
    significant_period: float,
    omega: ArrayLike | None = None,
    *,
    coefficients: Literal["mitsuyasu", "goda"] = "mitsuyasu",
) -> Spectrum:
    """Return the Bretschneider-Mitsuyasu spectrum of H_1/3 [m] and T_1/3 [s] [eq:sea-bretschneider].

    Parameters
    ----------
    significant_height, significant_period : float
        H_1/3 [m] and T_1/3 [s] of the zero-crossing analysis.
    omega : array_like, optional
        Frequencies of the table [rad/s].
    coefficients : {"mitsuyasu", "goda"}
        0.257 and 1.03 of Mitsuyasu (1970), giving T_p = 1.0496 T_1/3 and H_m0 = 0.999 H_1/3; or 0.205 and 0.75 of
        Goda's modification (1988).
    """
    _positive("significant_height", significant_height)
    _positive("significant_period", significant_period)
    if coefficients not in ("mitsuyasu", "goda"):
        raise InputError(f"unknown coefficients {coefficients!r}", path="coefficients", allowed="mitsuyasu, goda")
    factor, decay = (0.257, 1.03) if coefficients == "mitsuyasu" else (0.205, 0.75)
    turn = 2.0 * math.pi / significant_period
    # exp(-decay (T f)^-4) = exp(-5/4 (omega_p/omega)^4)
    shape = WindSeaShape(factor * significant_height**2 * turn**4, (0.8 * decay) ** 0.25 * turn)
    return _from_shape(
        shape,
        "bretschneider_mitsuyasu",
        omega,
        significant_height=significant_height,
        significant_period=significant_period,
        coefficients=coefficients,
    )


def tma(
    significant_height: float,
    peak_period: float,
    peak_enhancement: float,
    water: Water,
    omega: ArrayLike | None = None,
    *,
    height_at: Literal["site", "deep water"] = "site",
) -> Spectrum:
    """Return the TMA spectrum of Bouws et al. (1985): JONSWAP times the depth function [eq:sea-tma].

    Parameters
    ----------
    significant_height : float
        H_m0 [m].
    peak_period : float
        T_p of the JONSWAP spectrum [s]; in shallow water the largest density lies slightly above its frequency.
    peak_enhancement : float
        gamma [-].
    water : Water
        Depth and gravity of the site; infinite depth gives JONSWAP.
    omega : array_like, optional
        Frequencies of the table [rad/s].
    height_at : {"site", "deep water"}
        Whether ``significant_height`` is that of the TMA spectrum or of the JONSWAP spectrum under it.
    """
    if height_at not in ("site", "deep water"):
        raise InputError(f"unknown height_at {height_at!r}", path="height_at", allowed="site, deep water")
    deep = jonswap(significant_height, peak_period, peak_enhancement).shapes[0]
    shape = replace(deep, depth=water.depth, gravity=water.gravity)
    if height_at == "site":
        shape = _normalised(shape, significant_height)
    return _from_shape(
        shape,
        "tma",
        omega,
        significant_height=significant_height,
        peak_period=peak_period,
        peak_enhancement=peak_enhancement,
        water_depth=water.depth,
        gravity=water.gravity,
        height_at=height_at,
    )


def superpose(*spectra: Spectrum) -> Spectrum:
    """Return the sum of several spectra, for instance swell and wind sea.

    Raises
    ------
    InputError
        When none is given, or formulas and tables (or band limits) are mixed.
    """
    if not spectra:
        raise InputError("no spectrum to superpose", path="spectra")
    if len({(bool(item.shapes), item.lower, item.upper) for item in spectra}) > 1:
        raise InputError(
            "spectra of formulas and of tables, or of different bands, cannot be superposed",
            path="spectra",
            remedy="make tables of all of them over the same frequencies",
        )
    omega = np.unique(np.concatenate([item.omega for item in spectra]))
    density = sum((item.density_at(omega) for item in spectra), np.zeros_like(omega))
    shapes = tuple(shape for item in spectra for shape in item.shapes)
    name = " + ".join(item.name for item in spectra)
    parameters = {f"part_{number}": dict(item.parameters) for number, item in enumerate(spectra, 1)}
    return Spectrum(omega, density, name, parameters, shapes, spectra[0].lower, spectra[0].upper)


def from_table(frequency: ArrayLike, density: ArrayLike, name: str = "table") -> Spectrum:
    """Return a measured spectrum from a table over frequency in hertz.

    Parameters
    ----------
    frequency : array_like
        Frequencies [Hz], strictly increasing, not negative.
    density : array_like
        Spectral density [m2/Hz], not negative.
    name : str
        Name of the spectrum.

    Raises
    ------
    InputError
        When the table is empty, unsorted, negative or holds NaN; the message names the row (from 1).
    """
    hertz, values = spectrum_table(frequency, density, what="frequency", unit="Hz")
    turn = 2.0 * math.pi
    return Spectrum(hertz * turn, values / turn, name, {"rows": hertz.size})


def from_file(path: Any, *, frequency_column: int | str = 0, density_column: int | str = 1) -> Spectrum:
    """Return a measured spectrum from a text file.

    Parameters
    ----------
    path : path-like
        CSV, semicolon, tab or blank separated; lines starting with ``#`` or ``%`` are skipped, one header line is
        allowed.
    frequency_column, density_column : int or str
        Column of the frequency [Hz] and of the density [m2/Hz]: number from 0, or name in the header.

    Raises
    ------
    InputError
        When the file cannot be read or its table is faulty; the message names the row of the file.
    """
    hertz, values, rows = read_spectrum_file(path, frequency_column, density_column)
    hertz, values = spectrum_table(hertz, values, what="frequency", unit="Hz", rows=rows, path=str(path))
    turn = 2.0 * math.pi
    return Spectrum(hertz * turn, values / turn, "file", {"file": str(path), "rows": hertz.size})
