"""Validation of the analysis of flume records on synthetic records with known content."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.measure.harmonics import fit_harmonics
from moyai.measure.reflection import separate_waves


def _three_gauges() -> complex:
    """Return the reflection coefficient of a planted pair of waves at gauges 4.95, 5.20 and 5.50 m from the paddle."""
    k, reflection = 2.76, 0.62 * np.exp(0.9j)
    x = np.array([4.95, 5.20, 5.50]) - 7.0
    gauges = 0.012 * (np.exp(1j * k * x) + reflection * np.exp(-1j * k * x))
    return complex(separate_waves(x, gauges, k).reflection_coefficient[0])


def _whole_periods() -> float:
    """Return the first harmonic of a record whose period is no multiple of its step, with mean and second harmonic."""
    period = 1.158
    omega = 2.0 * math.pi / period
    time = 1234.5 + np.arange(2000) * 0.005
    values = 0.3 + 2.5 * np.cos(omega * time - 0.4) + 0.7 * np.cos(2.0 * omega * time + 1.0)
    return float(np.abs(fit_harmonics(time, values, omega, count=2).first[0]))


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        name="records: reflection from three gauges",
        source="planted waves; Mansard and Funke (1980)",
        compute=lambda: abs(_three_gauges()),
        reference=0.62,
        tolerance=1e-10,
        note="rounding",
    ),
    ValidationCase(
        name="records: phase of the reflection from three gauges",
        source="planted waves; Mansard and Funke (1980)",
        compute=lambda: float(np.angle(_three_gauges())),
        reference=0.9,
        tolerance=1e-10,
        note="rounding",
    ),
    ValidationCase(
        name="records: first harmonic over whole periods",
        source="planted harmonics",
        compute=_whole_periods,
        reference=2.5,
        tolerance=1e-9,
        note="rounding of the phase at a clock of 1234 s",
    ),
)
