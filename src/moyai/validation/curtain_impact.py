"""Impact of a curtain in a current: closed forms, similarity, numbers of independent prototypes."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from moyai.core.validation import ValidationCase
from moyai.sea.water import Water
from moyai.series.snap_statistics import fit_snaps
from moyai.structures.curtain.impact.cable import Impact, edge_impact, peak_by_energy, speed_factor
from moyai.structures.curtain.impact.cycles import slack_sag
from moyai.structures.curtain.impact.kernels import spring, taut_shape
from moyai.structures.curtain.impact.march import march_impact
from moyai.structures.curtain.impact.memory import impact_with_memory, memory_impact
from moyai.structures.curtain.impact.release import slack_phase, snap_in_current
from moyai.structures.curtain.impact.skirt import BulgedSkirt, cable_and_skirt_impact, skirt_impact

_PROTOTYPE = "prototype of other construction for the case of Sawaragi, Aoki and Liu (1991)"
_SKIRT = BulgedSkirt(0.15, 0.135, 5e4)


def _flume(scale: float = 1.0, stiffness: float = 150.0) -> Impact:
    half = 0.5 * stiffness * scale**3
    water = Water(0.4 * scale, 1000.0, 9.81)
    return Impact(0.7 * scale, 0.8 * scale, 0.15 * scale, half, half, 0.3 * math.sqrt(scale), water)


def _march_order() -> float:
    exact = peak_by_energy(_flume())
    errors = [
        1.0 - march_impact(_flume(), time_step=exact.time / n, duration=1.5 * exact.time).peak.tension / exact.tension
        for n in (256, 512)
    ]
    return math.log2(errors[0] / errors[1])


def _exponential_memory() -> float:
    """Return the ratio of peaks with K = a exp(-bt), marched over the exact third state."""
    from scipy.integrate import solve_ivp

    impact = _flume()
    mass, rise = impact.deep_mass, peak_by_energy(impact).time
    strength, decay, taut = mass / rise**2, 1.0 / rise, taut_shape(impact.span_ratio)

    def rate(_time: float, y: NDArray[np.float64]) -> tuple[float, float, float]:
        load = spring(y[0], impact.span, impact.span_ratio, taut, impact.stiffness)[0]
        return y[1], (-load - strength * y[2]) / mass, y[1] - impact.speed - decay * y[2]

    def stops(_time: float, y: NDArray[np.float64]) -> float:
        return float(y[1])

    stops.terminal = True  # type: ignore[attr-defined]
    exact = solve_ivp(rate, (0.0, 9.0 * rise), (0.0, impact.speed, 0.0), "DOP853", rtol=1e-11, atol=1e-14, events=stops)
    assert exact.y_events is not None
    step = rise / 400.0
    marched = memory_impact(impact, strength * np.exp(-decay * step * np.arange(2000)), step, mass)
    return marched.peak.displacement / float(exact.y_events[0][0][0])


def _unequal() -> Impact:
    return Impact(0.7, 0.8, 0.15, 150.0, 75.0, 0.3, Water(0.4, 1000.0, 9.81))


def _exponential_maximum() -> float:
    """Return what the most probable maximum misses of the top of the density of the largest, at the fitted law."""
    peaks = -np.log((np.arange(400) + 0.5) / 400.0)
    law = fit_snaps(peaks, 2.0, threshold=0.0, resamples=50)
    found = law.most_probable_maximum(100.0).value
    c, a, n = law.shape.value, law.scale.value, law.rate.value * 100.0
    t = (found / a) ** c
    # slope of log density of the largest: (c - 1)/(c t) - 1 + n exp(-t) = 0
    return float((c - 1.0) / (c * t) - 1.0 + n * math.exp(-t))


def _slack_drift() -> float:
    """Return the speed at the taut instant over that of an integration in time."""
    from scipy.integrate import solve_ivp

    impact = _flume()
    rate, sag = 0.5 * 1000.0 * 1.2 * 0.15 / impact.deep_mass, slack_sag(impact)

    def right(_time: float, y: NDArray[np.float64]) -> tuple[float, float]:
        return y[1], rate * (0.3 - y[1]) * abs(0.3 - y[1])

    def taut(_time: float, y: NDArray[np.float64]) -> float:
        return float(y[0]) - sag

    taut.terminal = True  # type: ignore[attr-defined]
    other = solve_ivp(right, (0.0, 1e3), (-0.1, 0.0), "DOP853", rtol=1e-11, atol=1e-13, events=taut, max_step=0.05)
    assert other.y_events is not None
    found = slack_phase(impact, drag_coefficient=1.2, current=0.3, position=-0.1, speed=0.0)
    return found.speed / float(other.y_events[0][0][1])


CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "curtain impact: model A, flume case", _PROTOTYPE, lambda: peak_by_energy(_flume()).tension, 9.86556, 1e-6
    ),
    ValidationCase(
        "curtain impact: factor of the closed form at l = B",
        "sqrt(2/3), limit of the closed form",
        lambda: float(speed_factor(1.0)),
        math.sqrt(2.0 / 3.0),
        1e-12,
    ),
    ValidationCase(
        "curtain impact: tension under Froude scale 25",
        "similarity, equation (8)",
        lambda: peak_by_energy(_flume(25.0)).tension / peak_by_energy(_flume()).tension,
        25.0**3,
        1e-12,
    ),
    ValidationCase(
        "curtain impact: order of the marching scheme", "first order (Newmark 1/2, 1)", _march_order, 1.0, 0.02
    ),
    ValidationCase(
        "curtain impact: model A2, lower cable",
        _PROTOTYPE,
        lambda: edge_impact(_flume(), duration=0.4).lower_peak,
        5.230,
        2e-4,
        note="printed digits",
    ),
    ValidationCase(
        "curtain impact: model B energy_mid, load on a cable",
        _PROTOTYPE,
        lambda: skirt_impact(_flume(), _SKIRT).edge_load,
        372.3,
        2e-4,
        note="printed digits",
    ),
    ValidationCase(
        "curtain impact: model AB, steel cables",
        _PROTOTYPE,
        lambda: cable_and_skirt_impact(_flume(1.0, 39000.0), _SKIRT).tension,
        137.1,
        5e-4,
        note="printed digits",
    ),
    ValidationCase(
        "curtain impact: model A with memory over model A, EA = 150 N",
        _PROTOTYPE,
        lambda: impact_with_memory(_flume()).ratio,
        1.258,
        5e-4,
        note="four printed digits",
    ),
    ValidationCase(
        "curtain impact: memory that is an exponential",
        "ordinary differential equation with a third state, 8th order",
        _exponential_memory,
        1.0,
        2e-6,
        note="extrapolated second-order march",
    ),
    ValidationCase(
        "curtain impact: speed after the slack phase", "integration in time, 8th order", _slack_drift, 1.0, 1e-8
    ),
    ValidationCase(
        "curtain impact: model A2, sum at one instant, EA = 150 and 75 N",
        _PROTOTYPE,
        lambda: edge_impact(_unequal(), duration=0.4).simultaneous_peak,
        10.54,
        4e-4,
        note="four printed digits",
    ),
    ValidationCase(
        "curtain snaps: steady drag level, flume case [N]",
        _PROTOTYPE,
        lambda: snap_in_current(_flume(), drag_coefficient=1.2, current=0.3, position=0.0, speed=0.0).plateau_tension,
        2.92,
        2e-3,
        note="three printed digits",
    ),
    ValidationCase(
        "curtain snaps: slope of the density at the most probable largest",
        "density of the largest of a Poisson number of Weibull peaks",
        _exponential_maximum,
        0.0,
        1e-9,
        relative=False,
        note="rounding",
    ),
)
