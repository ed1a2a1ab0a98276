"""The floating breakwater of Nakamura, Ohmori and Ide as a whole, and the screening formulas."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from moyai.core.results import Result
from moyai.core.validation import ValidationCase
from moyai.mooring.lines import LineType, Segment
from moyai.potential.shapes import rectangle
from moyai.sea.water import Water
from moyai.structures.breakwater.model import (
    Breakwater,
    BreakwaterProblem,
    Damping,
    Environment,
    MooringLine,
    MooringSpring,
    RegularSea,
)
from moyai.structures.breakwater.run import run
from moyai.structures.breakwater.screening import transmission_macagno, transmission_wiegel

PAPER = "Nakamura, Ohmori and Ide, recomputed by a second program (independent prototype)"
CLOSED_FORM = "closed form, evaluated independently of the code"


def tank_model(periods: tuple[float, ...], *analyses: str, height: float = 0.04) -> BreakwaterProblem:
    """Return the tank model of the paper in regular waves of some periods [s]."""
    chain = LineType("chain", 1.122, 2.14e4)
    lines = tuple(
        MooringLine(name, 2, (side * 0.19, 0.0, 0.0), (side * 2.115, 0.0, 0.0), (Segment(chain, 1.975),))
        for name, side in (("seaward", -1), ("shoreward", 1))
    )
    hull = rectangle(0.38, 0.17)
    unit = Breakwater(hull, 0.986, 0.101, (0.0, 0.086), mass=41.6, draught=0.113, damping=Damping(0.15), lines=lines)
    water = Water(0.38, 1000.0, 9.81)
    environment = Environment(water, (("SWL", 0.0),), (RegularSea("waves", height, periods),))
    return BreakwaterProblem("tank model", unit, environment, analyses)  # type: ignore[arg-type]


@cache
def _frequency() -> Result:
    return run(tank_model((0.6, 0.95, 1.4), "statics", "frequency"))


@cache
def _time() -> Result:
    return run(tank_model((0.95,), "statics", "frequency", "time"))


@cache
def _linear() -> Result:
    problem = tank_model((0.95,), "statics", "frequency", "time", height=0.002)
    springs = tuple(
        MooringSpring(name, 1, (side * 0.19, 0.0, 0.086), (side * 60.0, 0.0, -0.027), 150.0, 2.0)
        for name, side in (("left", -1), ("right", 1))
    )
    return run(replace(problem, breakwater=replace(problem.breakwater, lines=springs, mass=None)))


def _value(group: str, name: str, period: float, dof: str | None = None) -> Callable[[], float]:
    def value() -> float:
        result = _time() if "/time/" in group else _frequency()
        data = result.tree[group].to_dataset()[name].sel(period=period)
        return float(data if dof is None else data.sel(dof=dof))

    return value


def _linear_difference() -> float:
    tree = _linear().tree
    time, frequency = (tree[f"SWL/{name}/waves"].to_dataset().motion_amplitude for name in ("time", "frequency"))
    return float(np.max(np.abs(time.values / frequency.values - 1.0)))


def _drift_difference() -> float:
    return next(check.value for check in _frequency().checks if "by momentum and by pressure" in check.name)


def _roll_period() -> float:
    return float(_frequency().tree["SWL/statics"].to_dataset().natural_period.sel(mode="roll"))


def _screening(formula: str, length_over_beam: float) -> Callable[[], float]:
    def value() -> float:
        k = 2.0 * math.pi / (length_over_beam * 0.38)
        if formula == "macagno":
            return float(transmission_macagno(k, 0.38, 0.38, 0.113))
        return float(transmission_wiegel(k, 0.38, 0.113))

    return value


_FD, _TD = "SWL/frequency/waves", "SWL/time/waves"
_DIGIT = "half of the last printed digit"

CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        "breakwater: roll at T = 0.95 s", PAPER, _value(_FD, "motion_ratio", 0.95, "roll"), 0.697, 1.2e-3, False, _DIGIT
    ),
    ValidationCase(
        "breakwater: heave at T = 1.40 s",
        PAPER,
        _value(_FD, "motion_ratio", 1.4, "heave"),
        0.958,
        1.2e-3,
        False,
        _DIGIT,
    ),
    ValidationCase(
        "breakwater: C_R at T = 0.60 s", PAPER, _value(_FD, "reflection_coefficient", 0.6), 0.894, 1.2e-3, False, _DIGIT
    ),
    ValidationCase(
        "breakwater: C_T at T = 0.95 s",
        PAPER,
        _value(_FD, "transmission_coefficient", 0.95),
        0.294,
        1.2e-3,
        False,
        _DIGIT,
    ),
    ValidationCase(
        "breakwater: F* at T = 0.95 s", PAPER, _value(_FD, "drift_coefficient", 0.95), 0.575, 1.2e-3, False, _DIGIT
    ),
    ValidationCase("breakwater: moored roll period", PAPER, _roll_period, 0.902, 6e-4, False, _DIGIT),
    ValidationCase(
        "breakwater: roll in time at T = 0.95 s",
        PAPER,
        _value(_TD, "motion_ratio", 0.95, "roll"),
        0.661,
        6e-3,
        True,
        "prototype of second order, T/80",
    ),
    ValidationCase(
        "breakwater: time equals frequency domain with springs",
        "identity",
        _linear_difference,
        0.0,
        0.01,
        False,
        "1 % asked; waves so low that springs stay linear",
    ),
    ValidationCase(
        "breakwater: drift by momentum and by pressure",
        "identity (Maruo against pressure integration)",
        _drift_difference,
        0.0,
        0.02,
        False,
        "of the largest drift over the band",
    ),
    ValidationCase(
        "breakwater: Macagno at L/B = 3", CLOSED_FORM, _screening("macagno", 3.0), 0.4803, 6e-5, False, _DIGIT
    ),
    ValidationCase(
        "breakwater: Wiegel at L/B = 5", CLOSED_FORM, _screening("wiegel", 5.0), 0.7297, 6e-5, False, _DIGIT
    ),
)
