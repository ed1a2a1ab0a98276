"""Flow images against exact and published values: map, Stokes drift, drift over a period, extrapolation, law."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.validation import ValidationCase
from moyai.records.streaks.circulation_law import fit_circulation_law, inertia_reduction
from moyai.records.streaks.contour_circulation import extrapolate_stokes
from moyai.records.streaks.drift_velocity import StreakChain, fit_drift_harmonics
from moyai.records.streaks.flow import OrbitalFlow, circle_map, rectangle_map, track_particles

_ARAI = "Arai, low-KC cylinders, C_M and visualised flow"
_PROTOTYPE = "particle tracking of other construction"


def _ring(amplitude_number: float) -> float:
    """Circulation of the drift of particles started at 1.1 radii, over V^2 T."""
    speed = 2.0 * amplitude_number
    angle = 2.0 * math.pi * np.arange(24) / 24
    ring = 1.1 * np.column_stack([np.cos(angle), np.sin(angle)])
    time = np.linspace(0.0, 1.0, 201)
    path = track_particles(OrbitalFlow(circle_map(2.0), 1.0, speed, speed), ring, time)
    middle, drift = np.asarray(np.trapezoid(path, time, axis=1)), path[:, -1] - path[:, 0]
    turned = np.mean(drift[:, 0] * middle[:, 1] - drift[:, 1] * middle[:, 0])
    return float(2.0 * math.pi * turned / speed**2)


def _drift() -> float:
    """Drift of a particle whose velocity is exactly periodic, with 9.6 streaks a period."""
    start = np.arange(12) / 9.6
    place = [
        np.column_stack([0.01 * t + 0.01 * np.cos(2.0 * math.pi * t), 0.008 * np.sin(2.0 * math.pi * t)])
        for t in (start, start + 0.04)
    ]
    return float(fit_drift_harmonics(StreakChain(start, start + 0.04, place[0], place[1]), 1.0).velocity[0])


def _extrapolated() -> float:
    ratio = np.array([1.2, 1.5, 2.0, 2.5, 3.0])
    return extrapolate_stokes(ratio, 18.0 + 36.0 * ratio**-4)[0]


def _law() -> float:
    kc = np.array([1.0, 1.2, 1.5, 2.0])
    return fit_circulation_law(kc, 18e-4 * kc**2, 0.95, 0.045).coefficient


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "flow images: C_M of a square from the map",
        "exact Schwarz-Christoffel value",
        lambda: rectangle_map(1.0, 1.0).inertia_coefficients[0],
        2.1884,
        3e-5,
        note="printed digits",
    ),
    ValidationCase(
        "flow images: vertical C_M of 45 by 24 mm from the map",
        "exact Schwarz-Christoffel value",
        lambda: rectangle_map(0.045, 0.024).inertia_coefficients[1],
        3.0266,
        3e-5,
        note="printed digits",
    ),
    ValidationCase("flow images: Stokes drift, KC 0.05", _PROTOTYPE, lambda: _ring(0.05), 1.3656, 1e-4),
    ValidationCase(
        "flow images: Stokes drift, KC 1",
        _PROTOTYPE,
        lambda: _ring(1.0),
        1.139,
        3e-3,
        note="how the ring of mean positions was counted is not recorded",
    ),
    ValidationCase("flow images: drift of a periodic motion", "exact", _drift, 0.01, 1e-9),
    ValidationCase("flow images: fit with the Stokes term", "exact", _extrapolated, 18.0, 1e-10),
    ValidationCase("flow images: coefficient of the law", _ARAI, _law, 18.0 / (0.95 * 4.5**2), 1e-10),
    ValidationCase(
        "flow images: reduction of C_M of the rectangle at KC 1",
        _ARAI,
        lambda: float(inertia_reduction(18e-4, 1.0 / 0.95, 10.8e-4)),
        0.2792,
        3e-4,
        note="the paper rounds to 0.28",
    ),
)
