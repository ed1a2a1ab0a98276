"""Frequency spectra of the sea: wind-sea forms with their sources, and measured tables and files."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.sea import spectral_integrals as integrals
from moyai.sea.spectrum import Spectrum, WindSeaShape, depth_function
from moyai.sea.spectrum_file import read_spectrum_file, spectrum_table
from moyai.sea.water import Water, check_water

__all__ = [
    "Spectrum",
    "WindSeaShape",
    "bretschneider_mitsuyasu",
    "depth_function",
    "from_file",
    "from_table",
    "goda_factor",
    "goda_peak_period",
    "jonswap",
    "pierson_moskowitz",
    "pierson_moskowitz_of_wind",
    "superpose",
    "tma",
]


#: Table of a spectrum made from a formula when the caller names no frequencies, as multiples of the peak frequency.
DEFAULT_RELATIVE_FREQUENCIES = (0.3, 8.0, 771)


def _positive(name: str, value: float) -> float:
    if not (math.isfinite(value) and value > 0.0):
        raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
    return float(value)


def _from_shape(shape: WindSeaShape, name: str, omega: ArrayLike | None, **parameters: Any) -> Spectrum:
    low, high, count = DEFAULT_RELATIVE_FREQUENCIES
    grid = np.linspace(low, high, count) * shape.peak_omega if omega is None else np.asarray(omega, dtype=np.float64)
    return Spectrum(grid, shape(grid), name, parameters, (shape,))


def _normalised(shape: WindSeaShape, significant_height: float) -> WindSeaShape:
    """Scale a shape by quadrature so that 4 sqrt(m_0) is the significant height."""
    area = integrals.integrate_shape(shape, integrals.shape_edges((shape.peak_omega,), 0.0, math.inf))
    return replace(shape, scale=shape.scale * significant_height**2 / (16.0 * area))


@checks_words
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
        0.3 % for gamma up to 7. ``goda_significant`` multiplies it by (1.094 - 0.01915 ln gamma), as design manuals
        print it, because H_1/3 of the zero-crossing analysis is smaller than H_m0: the resulting H_m0 is 3 to 5 %
        above the height given [eq:sea-goda-factor].
    sigma_low, sigma_high : float
        Peak widths of Hasselmann et al. (1973) [-].

    Returns
    -------
    Spectrum
        Density [m2 s] over angular frequency [rad/s], one-sided.

    Raises
    ------
    InputError
        When a value is not positive or gamma is below 1.

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> spectrum = spectra.jonswap(significant_height=2.0, peak_period=7.0, peak_enhancement=3.3)
    >>> round(spectrum.significant_height, 6), round(spectrum.zero_crossing_period, 2)   # [m], [s]
    (2.0, 5.44)
    """
    _positive("significant_height", significant_height)
    peak = 2.0 * math.pi / _positive("peak_period", peak_period)
    if not (math.isfinite(peak_enhancement) and peak_enhancement >= 1.0):
        raise InputError(
            f"peak_enhancement is {peak_enhancement:g}", parameter="peak_enhancement", allowed="at least 1"
        )
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
            parameter="normalisation",
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


@checks_words
def goda_factor(peak_enhancement: float, *, zero_crossing: bool) -> float:
    """Return Goda's approximate normalisation of JONSWAP [-] [eq:sea-goda-factor].

    Parameters
    ----------
    peak_enhancement : float
        gamma [-], 1 or more.
    zero_crossing : bool
        Whether the factor goes with H_1/3 of the zero-crossing analysis (beta_J of Goda, Random Seas and Design of
        Maritime Structures) or with H_m0.

    Returns
    -------
    float
        Factor of the spectrum [-].

    Raises
    ------
    InputError
        Where ``zero_crossing`` is neither true nor false.

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> round(spectra.goda_factor(3.3, zero_crossing=False), 4), round(spectra.goda_factor(3.3, zero_crossing=True), 4)
    (0.2044, 0.2189)
    """
    gamma = peak_enhancement
    base = 0.0624 / (0.230 + 0.0336 * gamma - 0.185 / (1.9 + gamma))
    return base * (1.094 - 0.01915 * math.log(gamma)) if zero_crossing else base


def goda_peak_period(significant_period: float, peak_enhancement: float) -> float:
    """Return T_p = T_1/3 / (1 - 0.132 (gamma + 0.2)^-0.559) of Goda (1988) [eq:sea-goda-period].

    Parameters
    ----------
    significant_period : float
        T_1/3 of the zero-crossing analysis [s].
    peak_enhancement : float
        gamma [-], 1 or more.

    Returns
    -------
    float
        T_p [s].

    Raises
    ------
    InputError
        When the period is not positive.

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> round(spectra.goda_peak_period(6.0, 3.3), 3)                     # [s]
    6.421
    """
    _positive("significant_period", significant_period)
    return float(significant_period / (1.0 - 0.132 * (peak_enhancement + 0.2) ** -0.559))


def pierson_moskowitz(significant_height: float, peak_period: float, omega: ArrayLike | None = None) -> Spectrum:
    """Return the two-parameter Pierson-Moskowitz (ISSC) spectrum of H_m0 [m] and T_p [s] [eq:sea-pierson-moskowitz].

    Its moments are closed: m_0 = H^2/16, T_m01 = 0.7718 T_p, T_m02 = 0.7104 T_p, T_e = 0.8572 T_p.

    Parameters
    ----------
    significant_height : float
        H_m0 [m].
    peak_period : float
        T_p [s].
    omega : array_like, optional
        Frequencies of the table [rad/s].

    Returns
    -------
    Spectrum
        Density [m2 s] over angular frequency [rad/s], one-sided.

    Raises
    ------
    InputError
        When height or period is not positive.

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> spectrum = spectra.pierson_moskowitz(significant_height=2.0, peak_period=7.0)
    >>> round(spectrum.variance, 4), round(spectrum.mean_period / 7.0, 4)   # H^2 / 16 [m2], 0.7718
    (0.25, 0.7718)
    """
    _positive("significant_height", significant_height)
    peak = 2.0 * math.pi / _positive("peak_period", peak_period)
    shape = WindSeaShape(5.0 / 16.0 * significant_height**2 * peak**4, peak)
    return _from_shape(
        shape, "pierson_moskowitz", omega, significant_height=significant_height, peak_period=peak_period
    )


def pierson_moskowitz_of_wind(wind_speed: float, gravity: float, omega: ArrayLike | None = None) -> Spectrum:
    """Return the fully developed sea of Pierson and Moskowitz (1964) under a wind [eq:sea-pierson-moskowitz].

    Parameters
    ----------
    wind_speed : float
        Wind speed at 19.5 m above the sea [m/s].
    gravity : float
        [m/s2].
    omega : array_like, optional
        Frequencies of the table [rad/s].

    Returns
    -------
    Spectrum
        Density [m2 s] over angular frequency [rad/s], one-sided.

    Raises
    ------
    InputError
        When wind speed or gravity is not positive.

    Notes
    -----
    alpha = 0.0081, beta = 0.74 in alpha g^2 omega^-5 exp(-beta (g / (U omega))^4).

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> round(spectra.pierson_moskowitz_of_wind(10.0, 9.81).significant_height, 2)   # [m]
    2.13
    """
    speed, g = _positive("wind_speed", wind_speed), _positive("gravity", gravity)
    shape = WindSeaShape(0.0081 * g * g, (0.8 * 0.74) ** 0.25 * g / speed)
    return _from_shape(shape, "pierson_moskowitz", omega, wind_speed=speed, gravity=g)


@checks_words
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

    Returns
    -------
    Spectrum
        Density [m2 s] over angular frequency [rad/s], one-sided.

    Raises
    ------
    InputError
        When height or period is not positive, and for other ``coefficients``.

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> spectrum = spectra.bretschneider_mitsuyasu(significant_height=2.0, significant_period=6.0)
    >>> round(spectrum.significant_height, 3), round(spectrum.peak_period / 6.0, 4)   # [m], 1.0496
    (1.998, 1.0496)
    """
    _positive("significant_height", significant_height)
    _positive("significant_period", significant_period)
    if coefficients not in ("mitsuyasu", "goda"):
        raise InputError(f"unknown coefficients {coefficients!r}", parameter="coefficients", allowed="mitsuyasu, goda")
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


@checks_words
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

    Returns
    -------
    Spectrum
        Density [m2 s] over angular frequency [rad/s], one-sided.

    Raises
    ------
    InputError
        When a value is not positive, gamma is below 1, and for another ``height_at``.

    Examples
    --------
    >>> from moyai.sea import Water, spectra
    >>> water = Water(depth=8.0, density=1025.0, gravity=9.81)
    >>> round(spectra.tma(2.0, 8.0, 3.3, water).significant_height, 4)   # [m]
    2.0
    >>> offshore = spectra.tma(2.0, 8.0, 3.3, water, height_at="deep water")
    >>> round(offshore.significant_height, 2)                            # less in shallow water [m]
    1.19
    """
    check_water(water)
    if height_at not in ("site", "deep water"):
        raise InputError(f"unknown height_at {height_at!r}", parameter="height_at", allowed="site, deep water")
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

    Parameters
    ----------
    *spectra : Spectrum
        One or more, all of formulas or all of tables, over the same band.

    Returns
    -------
    Spectrum
        Density [m2 s] over angular frequency [rad/s]: the sum.

    Raises
    ------
    InputError
        When none is given, or formulas and tables (or band limits) are mixed.

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> swell = spectra.jonswap(significant_height=1.5, peak_period=12.0, peak_enhancement=5.0)
    >>> wind_sea = spectra.jonswap(significant_height=2.0, peak_period=6.0, peak_enhancement=3.3)
    >>> round(spectra.superpose(swell, wind_sea).significant_height, 4)  # sqrt(1.5^2 + 2^2) [m]
    2.5
    """
    if not spectra:
        raise InputError("no spectrum to superpose", parameter="spectra")
    if len({(bool(item.shapes), item.lower, item.upper) for item in spectra}) > 1:
        raise InputError(
            "spectra of formulas and of tables, or of different bands, cannot be superposed",
            parameter="spectra",
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

    Returns
    -------
    Spectrum
        Density [m2 s] over angular frequency [rad/s], one-sided.

    Raises
    ------
    InputError
        When the table is empty, unsorted, negative or holds NaN; the message names the row (from 1).

    Examples
    --------
    >>> from moyai.sea import spectra
    >>> round(spectra.from_table([0.05, 0.10, 0.20], [0.0, 4.0, 0.0]).variance, 4)   # area of the triangle [m2]
    0.3
    """
    hertz, values = spectrum_table(frequency, density, what="frequency", unit="Hz")
    turn = 2.0 * math.pi
    return Spectrum(hertz * turn, values / turn, name, {"rows": hertz.size})


def from_file(path: Any, *, frequency_column: int | str = 1, density_column: int | str = 2) -> Spectrum:
    """Return a measured spectrum from a text file.

    Parameters
    ----------
    path : path-like
        CSV, semicolon, tab or blank separated; lines starting with ``#`` or ``%`` are skipped, one header line is
        allowed.
    frequency_column, density_column : int or str
        Column of the frequency [Hz] and of the density [m2/Hz]: number from 1, or name in the header.

    Returns
    -------
    Spectrum
        Density [m2 s] over angular frequency [rad/s], one-sided.

    Raises
    ------
    InputError
        When the file cannot be read or its table is wrong; the message names the row of the file.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import numpy as np
    >>> from moyai.sea import spectra
    >>> file = Path(mkdtemp()) / "buoy.txt"
    >>> np.savetxt(file, [[0.05, 0.0], [0.10, 4.0], [0.20, 0.0]])        # [Hz], [m2/Hz]
    >>> round(spectra.from_file(file).variance, 4)                       # area of the triangle [m2]
    0.3
    """
    first, second, rows = read_spectrum_file(path, frequency_column, density_column)
    hertz, values = spectrum_table(first, second, what="frequency", unit="Hz", rows=rows, path=str(path))
    turn = 2.0 * math.pi
    return Spectrum(hertz * turn, values / turn, "file", {"file": str(path), "rows": hertz.size})
