"""Extremes, fatigue and design checks against distributions and rules whose answers are known."""

from __future__ import annotations

import math

import numpy as np
from scipy.special import ndtri

from moyai.core.validation import ValidationCase
from moyai.design.codes import LineLoad, check_line, design_code
from moyai.design.fatigue import EnduranceCurve, damage
from moyai.design.long_term import YEAR, JointSea, environmental_contour, return_level
from moyai.series.extremes import ExtremeFit, fit
from moyai.series.peaks import PeakKind, maximum_of_kinds
from moyai.series.rainflow import count_cycles


def _rayleigh_maximum() -> float:
    peaks = np.sqrt(-2.0 * np.log(1.0 - (np.arange(20000) + 0.5) / 20000))
    return fit(peaks, "weibull", location=0.0).most_probable_maximum(1000.0)


def _gumbel_mode() -> float:
    probability = (np.arange(2000) + 0.5) / 2000
    return fit(10.0 - 2.0 * np.log(-np.log(probability)), "gumbel").location


def _weibull_tail() -> float:
    # Quantiles of a Weibull law of exponent 1.4 above its median; nothing below is looked at
    values = (-np.log(1.0 - (np.arange(20000) + 0.5) / 20000)) ** (1.0 / 1.4)
    return float(fit(values, "weibull", location=0.0, threshold=float(np.median(values))).level(2e-4))


def _two_kinds() -> float:
    ordinary = PeakKind(ExtremeFit("weibull", 0.0, 1.0, 2.0, 0, math.nan), 400.0)
    snaps = PeakKind(ExtremeFit("generalised_pareto", 2.0, 0.5, 0.0, 0, math.nan), 20.0)
    level = maximum_of_kinds([ordinary, snaps], 0.9)
    return float((1.0 - math.exp(-(level**2))) ** 400 * (1.0 - math.exp(-(level - 2.0) / 0.5)) ** 20)


def _contour() -> float:
    height = ExtremeFit("weibull", 0.3, 1.2, 1.3, 0, math.nan)
    sea = JointSea(height, (0.7, 0.4, 0.5), (0.05, 0.1, -0.4))
    significant, period = environmental_contour(sea, 50.0, 3600.0, 36)
    first = -ndtri(height.exceedance(significant))
    second = (np.log(period) - 0.7 - 0.4 * significant**0.5) / (0.05 + 0.1 * np.exp(-0.4 * significant))
    return float(np.max(np.abs(np.hypot(first, second)[height.exceedance(significant) < 0.999999])))


def _long_term() -> float:
    def exceeds(level: np.ndarray) -> np.ndarray:
        return np.asarray(-np.expm1(-1000.0 * np.exp(-(level**2) / 2.0)))

    return return_level(100.0, [1.0], [exceeds], 10800.0, (1.0, 20.0))


def _rainflow() -> float:
    ranges, _, counts = count_cycles([-2.0, 1.0, -3.0, 5.0, -1.0, 3.0, -4.0, 4.0, -2.0])
    return damage(ranges, counts, EnduranceCurve("cube", 3.0, 1.0, "1", True, ""))


def _partial_factors() -> float:
    load = LineLoad("line", 400e3, 100e3, 1e6, "chain")
    return check_line(load, design_code("DNV-OS-E301", analysis="dynamic", consequence="1")).utilisation


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "extremes: most probable maximum of a thousand Rayleigh peaks",
        "sqrt(2 ln 1000), exact; fitted to 20 000 quantiles",
        _rayleigh_maximum,
        math.sqrt(2.0 * math.log(1000.0)),
        2e-3,
    ),
    ValidationCase("extremes: mode of a Gumbel distribution from its quantiles", "10, exact", _gumbel_mode, 10.0, 1e-3),
    ValidationCase(
        "extremes: tail of a Weibull law above its median",
        "(ln 10 000)^(1/1.4), exact: 1 in 5000 of the values above the median",
        _weibull_tail,
        math.log(10_000.0) ** (1.0 / 1.4),
        2e-3,
    ),
    ValidationCase(
        "extremes: maximum of ordinary peaks and snaps",
        "0.9, product of the laws of both kinds at the level found",
        _two_kinds,
        0.9,
        1e-9,
    ),
    ValidationCase(
        "extremes: contour of 50 years, back in standard normal space",
        "radius of the circle, 50 years of hours",
        _contour,
        float(-ndtri(3600.0 / (50.0 * YEAR))),
        1e-6,
    ),
    ValidationCase(
        "extremes: 100-year level of one Rayleigh sea state",
        "sqrt(2 ln N), N waves of 100 years, exact",
        _long_term,
        math.sqrt(2.0 * math.log(1000.0 * 100.0 * YEAR / 10800.0)),
        1e-8,
    ),
    ValidationCase(
        "fatigue: rainflow of the record printed in ASTM E1049",
        "ranges 3, 4, 6, 8, 9 counted 0.5, 1.5, 0.5, 1, 0.5, cubed",
        _rainflow,
        0.5 * 27 + 1.5 * 64 + 0.5 * 216 + 512 + 0.5 * 729,
        1e-12,
    ),
    ValidationCase(
        "design checks: partial factors on mean and dynamic tension",
        "(1.1 x 0.1 + 1.5 x 0.3) / 0.95 by hand",
        _partial_factors,
        (1.1 * 0.1 + 1.5 * 0.3) / 0.95,
        1e-12,
    ),
)
