"""Ranges of validity of waves and spectra: every notice names the number and the limit.

Recommended theory: each Stokes order neglects harmonics above it, and the first neglected one over the first harmonic
is a number. The boundaries of Le Mehaute's (1976) chart in deep water lie where that number is one per cent, and this
rule is used at every depth; where the Ursell number exceeds 26 the expansion itself fails [eq:sea-neglected-harmonic].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice, Severity
from moyai.sea.breaking import (
    BreakingLimit,
    breaking_limit,
    highest_steady_wave,
    linear_wavelength,
    mccowan_height,
    miche_height,
)
from moyai.sea.nonlinear import stokes_coefficients
from moyai.sea.permanent_wave import Theory
from moyai.sea.spectrum import Spectrum
from moyai.sea.water import Water

__all__ = [
    "BreakingLimit",
    "TheoryAdvice",
    "breaking_limit",
    "check_realised_height",
    "check_sea_state",
    "check_spectrum",
    "check_wave",
    "highest_steady_wave",
    "mccowan_height",
    "miche_height",
    "recommended_theory",
]

#: Neglected harmonic over first harmonic at which the next order is recommended.
NEGLECTED_HARMONIC = 0.01
#: Neglected harmonic above which a theory in use is warned about.
NEGLECTED_HARMONIC_WARNING = 0.10
#: Ursell number H L^2 / h^3 beyond which Stokes' expansion does not hold.
URSELL_LIMIT = 26.0
#: Part of the breaking height above which a wave is called near breaking.
NEAR_BREAKING = 0.8
#: Realised over asked significant height below which a record is called too low: forces with its square lack a tenth.
REALISED_HEIGHT = 0.95


@checks_words
@dataclass(frozen=True)
class TheoryAdvice:
    """The lowest wave theory that serves a regular wave."""

    #: ``airy``, ``stokes`` or ``stream_function``.
    theory: Theory
    #: Stokes order; 1 for Airy, 0 for the stream function (as many components as it needs).
    order: int
    #: First neglected harmonic over the first one for orders 1 to 4 [-].
    neglected: tuple[float, float, float, float]
    #: H L^2 / h^3 [-].
    ursell_number: float
    #: Height over the breaking height [-].
    breaking_ratio: float

    @property
    def name(self) -> str:
        """Theory in words."""
        if self.theory == "stokes":
            return f"Stokes order {self.order}"
        return {"airy": "linear theory", "stream_function": "stream function"}[self.theory]


def recommended_theory(height: float, period: float, water: Water, current_along_wave: float = 0.0) -> TheoryAdvice:
    """Return the lowest theory whose first neglected harmonic is below one per cent of the first one.

    Parameters
    ----------
    height, period : float
        Wave height [m] and period in the fixed frame [s].
    water : Water
        Depth and gravity.
    current_along_wave : float
        Uniform current along the heading [m/s].
    """
    if not (math.isfinite(height) and height >= 0.0):
        raise InputError(f"wave height is {height:g} m", parameter="height", allowed="at least 0 m")
    return _recommended_theory(float(height), float(period), water, float(current_along_wave))


@lru_cache(maxsize=1024)
def _recommended_theory(height: float, period: float, water: Water, current_along_wave: float) -> TheoryAdvice:
    length = linear_wavelength(period, water, current_along_wave)
    eps = math.pi * height / length
    data = stokes_coefficients(height, length, water, 5).data
    ratios = (eps * data["B22"], -(eps**2) * data["B31"], eps**3 * data["B44"], eps**4 * data["B55"])
    ursell = height * length**2 / water.depth**3
    ratio = height / breaking_limit(period, water, current_along_wave).height
    theory: Theory = "stream_function"
    order = 0
    if ursell <= URSELL_LIMIT and ratio <= 0.9:
        for number, neglected in enumerate(ratios, 1):
            if abs(neglected) < NEGLECTED_HARMONIC:
                theory, order = ("airy", 1) if number == 1 else ("stokes", number)
                break
        else:
            # the sixth harmonic is about eps times the fifth
            if abs(ratios[3]) * eps < NEGLECTED_HARMONIC:
                theory, order = "stokes", 5
    return TheoryAdvice(theory, order, ratios, ursell, ratio)


@checks_words
def check_wave(
    height: float,
    period: float,
    water: Water,
    *,
    theory: Theory = "airy",
    order: int = 1,
    current_along_wave: float = 0.0,
) -> tuple[Notice, ...]:
    """Check a regular wave against breaking and against the theory in use.

    Parameters
    ----------
    height, period : float
        Wave height [m] and period in the fixed frame [s].
    water : Water
        Depth and gravity.
    theory : {"airy", "stokes", "stream_function"}
        Theory in use.
    order : int
        Order of a Stokes wave.
    current_along_wave : float
        Uniform current along the heading [m/s].

    Returns
    -------
    tuple of Notice
        ``wave-breaking`` (error), ``wave-near-breaking``, ``ursell-number``, ``wave-theory``; empty when all is well.
    """
    return _check_wave(float(height), float(period), water, theory, order, float(current_along_wave))


@lru_cache(maxsize=1024)
def _check_wave(
    height: float, period: float, water: Water, theory: Theory, order: int, current_along_wave: float
) -> tuple[Notice, ...]:
    advice = recommended_theory(height, period, water, current_along_wave)
    notices = [*_breaking_notices(height, period, water, current_along_wave)]
    number = 1 if theory == "airy" else order
    if theory == "stokes" and advice.ursell_number > URSELL_LIMIT:
        notices.append(
            Notice(
                "ursell-number",
                f"the Ursell number {advice.ursell_number:.3g} exceeds {URSELL_LIMIT:g}: Stokes' expansion fails",
                advice.ursell_number,
                URSELL_LIMIT,
                "warning",
                "use the stream function",
                "Le Mehaute (1976)",
            )
        )
    if theory != "stream_function" and height > 0.0:
        needed = advice.order or math.inf
        if number < needed and number <= 4:
            neglected = abs(advice.neglected[number - 1])
            severe = neglected > NEGLECTED_HARMONIC_WARNING
            severity: Severity = "warning" if severe else "information"
            used = "linear theory" if number == 1 else f"Stokes order {number}"
            limit = NEGLECTED_HARMONIC_WARNING if severe else NEGLECTED_HARMONIC
            notices.append(
                Notice(
                    "wave-theory",
                    f"{used} neglects harmonics of {100.0 * neglected:.3g} % of the first (limit {100.0 * limit:g} %); "
                    f"recommended: {advice.name}",
                    neglected,
                    limit,
                    severity,
                    f"see how far the answer needs {advice.name}",
                    "Fenton (1985), Le Mehaute (1976)",
                )
            )
    return tuple(notices)


def _breaking_notices(height: float, period: float, water: Water, current: float) -> tuple[Notice, ...]:
    limit = breaking_limit(period, water, current)
    if height > limit.height:
        return (
            Notice(
                "wave-breaking",
                f"wave height {height:.4g} m exceeds the breaking height {limit.height:.4g} m ({limit.criterion})",
                height,
                limit.height,
                "error",
                "lower the wave, lengthen the period, or check the water depth",
                limit.source,
            ),
        )
    if height > NEAR_BREAKING * limit.height:
        return (
            Notice(
                "wave-near-breaking",
                f"wave height {height:.4g} m is {100.0 * height / limit.height:.3g} % of the breaking height "
                f"{limit.height:.4g} m ({limit.criterion})",
                height,
                NEAR_BREAKING * limit.height,
                "warning",
                "expect forces beyond non-breaking theory",
                limit.source,
            ),
        )
    return ()


def check_sea_state(significant_height: float, peak_period: float, water: Water) -> tuple[Notice, ...]:
    """Check significant height and peak period of an irregular sea against depth and steepness.

    Parameters
    ----------
    significant_height, peak_period : float
        H_m0 [m] and T_p [s].
    water : Water
        Depth and gravity.

    Returns
    -------
    tuple of Notice
        ``significant-height-depth`` (error above 0.78 h, warning above 0.6 h), ``sea-steepness`` (error where the
        significant height is more than the breaking height of a regular wave of the peak period).
    """
    notices = []
    breaking = breaking_limit(peak_period, water)
    for factor, severity in ((0.78, "error"), (0.6, "warning")):
        limit = factor * water.depth
        if significant_height > limit:
            notices.append(
                Notice(
                    "significant-height-depth",
                    f"significant height {significant_height:.4g} m exceeds {factor:g} of the depth, {limit:.4g} m",
                    significant_height,
                    limit,
                    "error" if severity == "error" else "warning",
                    "use the height that reaches this depth after breaking",
                    "Thompson and Vincent (1985): depth-limited seas have H_m0 of about 0.6 h",
                )
            )
            break
    steepness = 2.0 * math.pi * significant_height / (water.gravity * peak_period**2)
    # DNV-RP-C205: 1/15 up to 8 s, 1/25 from 15 s, linear in T_p between
    share = min(max((peak_period - 8.0) / 7.0, 0.0), 1.0)
    limit = 1.0 / 15.0 + share * (1.0 / 25.0 - 1.0 / 15.0)
    if steepness > limit:
        # one error is enough of a sea that is higher than the water is deep
        broken = significant_height > breaking.height and not any(one.severity == "error" for one in notices)
        more = f": more than the breaking height {breaking.height:.3g} m of a regular wave" if broken else ""
        notices.append(
            Notice(
                "sea-steepness",
                f"sea steepness 2 pi H_s / (g T_p^2) = {steepness:.3g} exceeds {limit:.3g}{more}",
                steepness,
                limit,
                "error" if broken else "warning",
                "lengthen the period or lower the height: such a sea breaks",
                "DNV-RP-C205, limiting average steepness",
            )
        )
    return tuple(notices)


def check_realised_height(name: str, realised: float, asked: float) -> tuple[Notice, ...]:
    """Check the significant height of a record against the one that was asked for.

    Parameters
    ----------
    name : str
        Name of the sea state.
    realised : float
        Four standard deviations of the surface over the part of the record that counts [m].
    asked : float
        Significant height of the spectrum [m].

    Returns
    -------
    tuple of Notice
        ``sea-realised-low``; empty when the record is high enough.
    """
    if asked <= 0.0 or not realised < REALISED_HEIGHT * asked:
        return ()
    share = realised / asked
    return (
        Notice(
            "sea-realised-low",
            f"{name}: the record has a significant height of {realised:.3g} m, {asked:.3g} m were asked: forces are "
            f"up to {100.0 * (1.0 - share**2):.2g} % low (those that go with the square of the height)",
            share,
            REALISED_HEIGHT,
            remedy="lengthen the duration, or take the largest of several seeds (moyai study)",
        ),
    )


def _parameter(spectrum: Spectrum, name: str) -> float:
    value = spectrum.parameters.get(name, math.nan)
    return float(value) if isinstance(value, int | float) else math.nan


def check_spectrum(
    spectrum: Spectrum,
    water: Water | None = None,
    *,
    lower_omega: float | None = None,
    upper_omega: float | None = None,
) -> tuple[Notice, ...]:
    """Check a spectrum: band in use, peak enhancement, range of JONSWAP and TMA, depth and steepness of the sea.

    Parameters
    ----------
    spectrum : Spectrum
        The spectrum.
    water : Water, optional
        Depth and gravity, for the checks that need them.
    lower_omega, upper_omega : float, optional
        Band of frequencies that the analysis covers [rad/s].

    Returns
    -------
    tuple of Notice
        ``spectrum-truncated``, ``spectrum-table-cut``, ``peak-enhancement``, ``jonswap-range``, ``tma-range`` and those
        of :func:`check_sea_state`.
    """
    notices = [*_band_notices(spectrum, lower_omega, upper_omega)]
    gamma = _parameter(spectrum, "peak_enhancement")
    if not math.isnan(gamma) and not 1.0 <= gamma <= 7.0:
        notices.append(
            Notice(
                "peak-enhancement",
                f"peak enhancement {gamma:g} is outside 1 to 7",
                gamma,
                7.0 if gamma > 7.0 else 1.0,
                "warning",
                "values observed lie between 1 and 7, 3.3 on average",
                "Hasselmann et al. (1973)",
            )
        )
    height, period = spectrum.significant_height, spectrum.peak_period
    if spectrum.name == "jonswap" and gamma > 1.0:
        ratio = period / math.sqrt(height)
        if not 3.6 < ratio < 5.0:
            notices.append(
                Notice(
                    "jonswap-range",
                    f"T_p / sqrt(H_m0) = {ratio:.3g} is outside 3.6 to 5 s/m^1/2, the range of JONSWAP",
                    ratio,
                    3.6 if ratio <= 3.6 else 5.0,
                    "information",
                    "below 3.6 the peak is sharper than gamma 5, above 5 the sea is swell or fully developed",
                    "DNV-RP-C205",
                )
            )
    if spectrum.name == "tma":
        notices.extend(_tma_notices(spectrum))
    if water is not None:
        notices.extend(check_sea_state(height, period, water))
    return tuple(notices)


def _band_notices(spectrum: Spectrum, lower: float | None, upper: float | None) -> tuple[Notice, ...]:
    notices = []
    if lower is not None or upper is not None:
        low, high = lower or 0.0, math.inf if upper is None else upper
        left_out = 1.0 - spectrum.moment(0, low, high) / spectrum.moment(0)
        if left_out > 0.01:
            notices.append(
                Notice(
                    "spectrum-truncated",
                    f"{100.0 * left_out:.3g} % of the energy lies outside {low:.4g} to {high:.4g} rad/s (limit 1 %)",
                    left_out,
                    0.01,
                    "warning",
                    "widen the band of frequencies",
                )
            )
    if not spectrum.shapes:
        worst = max(float(spectrum.density[0]), float(spectrum.density[-1])) / float(spectrum.density.max())
        if worst > 0.05:
            notices.append(
                Notice(
                    "spectrum-table-cut",
                    f"the table of the spectrum ends at {100.0 * worst:.3g} % of its peak (limit 5 %): it is cut",
                    worst,
                    0.05,
                    "warning",
                    "extend the table to lower and higher frequencies",
                )
            )
    return tuple(notices)


def _tma_notices(spectrum: Spectrum) -> tuple[Notice, ...]:
    shape = spectrum.shapes[0]
    if math.isinf(shape.depth):
        return ()
    relative = shape.peak_omega * math.sqrt(shape.depth / shape.gravity)
    if relative >= 0.5:
        return ()
    return (
        Notice(
            "tma-range",
            f"omega_p sqrt(h/g) = {relative:.3g} is below 0.5: shallower than the storms behind the TMA form",
            relative,
            0.5,
            "warning",
            "use a measured spectrum or a shallow-water wave model",
            "Bouws et al. (1985), depths of 6 to 42 m (limit rounded)",
        ),
    )
