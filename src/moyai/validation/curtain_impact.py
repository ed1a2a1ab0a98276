"""Impact of a curtain in a current: closed forms, similarity, numbers of independent prototypes."""

from __future__ import annotations

import math

from moyai.core.validation import ValidationCase
from moyai.curtain.impact import Impact, edge_impact, peak_by_energy, speed_factor
from moyai.curtain.impact_march import march_impact
from moyai.curtain.impact_skirt import Skirt, cable_and_skirt_impact, skirt_impact
from moyai.sea.water import Water

_PROTOTYPE = "prototype of other construction for the case of Sawaragi, Aoki and Liu (1991)"
_SKIRT = Skirt(0.15, 0.135, 5e4)


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
)
