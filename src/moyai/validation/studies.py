"""Extremes, fatigue and design checks against distributions and rules whose answers are known."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.design.codes import LineLoad, check_line, design_code
from moyai.design.extremes import fit
from moyai.design.fatigue import EnduranceCurve, count_cycles, damage
from moyai.design.long_term import YEAR, return_level


def _rayleigh_maximum() -> float:
    peaks = np.sqrt(-2.0 * np.log(1.0 - (np.arange(20000) + 0.5) / 20000))
    return fit(peaks, "weibull", location=0.0).most_probable_maximum(1000.0)


def _gumbel_mode() -> float:
    probability = (np.arange(2000) + 0.5) / 2000
    return fit(10.0 - 2.0 * np.log(-np.log(probability)), "gumbel").location


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
