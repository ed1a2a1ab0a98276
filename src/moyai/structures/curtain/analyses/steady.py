"""The governing steady load of a run with its band, what moves it, against direction, and other steady loads."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.statics.load_laws import section_laws
from moyai.structures.curtain.statics.planning import itopf_load, us_navy_load
from moyai.structures.curtain.statics.steady_load import QUANTITIES

_DIRECTIONS = np.radians(np.arange(0.0, 76.0, 15.0))


@dataclass(frozen=True)
class ComparedLoad:
    """A steady load of another model next to the governing one."""

    name: str
    #: Per length of curtain [N/m]; NaN where the model has no solution.
    line_load: float
    #: One of "governs", "upper bound", "other law", "out of range", "planning".
    standing: str
    #: Why it differs.
    why: str


def compared_loads(unit: LevelCurtain) -> tuple[ComparedLoad, ...]:
    """Return the governing steady load and the others that practice knows, each with the reason why it differs."""
    curtain, statics, steady = unit.curtain, unit.statics, unit.steady
    section, skirt = statics.section, curtain.skirt
    drag, span = section.drag_coefficient, curtain.span
    square = (unit.unit_normal_speed * unit.surface_speed) ** 2
    pressure = 0.5 * unit.water.density * drag * square
    free = math.isfinite(steady.bound)
    found = [
        ComparedLoad(
            "section and plan in equilibrium",
            section.load,
            "governs",
            "the skirt takes the shape in which current, weights and what holds top and toe balance",
        )
    ]
    if free:
        found.append(
            ComparedLoad(
                "weights of toe and sheet",
                steady.bound,
                "upper bound",
                "a load normal to the sheet leaves its tension alone: the top carries at most the weight below it",
            )
        )
    upright = pressure * unit.depth
    moment = f"with a free toe the plate would need {0.5 * upright:.3g} N/m at its toe, where nothing holds it"
    found.append(
        ComparedLoad(
            "full depth, upright plate",
            upright,
            "out of range" if free else "upper bound",
            moment if free else "the held skirt bulges and its ends lie oblique to the current",
        )
    )
    words = {
        "catenary": "load of the normal velocity without the weight of the sheet",
        "circular": "pressure normal to the sheet everywhere, without its weight: an arc that turns with qL/W",
        "rigid": "a stiff plate hinged at its top turns as a whole, its angle the same all the way down",
    }
    for law in section_laws(unit.depth, skirt.toe_load, pressure)[:3]:
        why = words[law.name]
        if math.isnan(law.horizontal_load):
            why += "; no solution at this load ratio"
        if not free:
            why += "; for a free toe"
        standing = "other law" if free else "out of range"
        found.append(ComparedLoad(f"free toe, {law.name}", law.horizontal_load, standing, why))
    area = span * section.effective_depth
    for formula in (us_navy_load, itopf_load):
        load = formula(area, abs(unit.normal_speed), unit.water.density)
        found.append(
            ComparedLoad(
                f"{load.name}, depth reached",
                load.force / span,
                "planning",
                f"an upright plate of the depth reached with C_D = {load.drag_coefficient:.3g}: the oblique lower "
                "part of the sheet is taken as upright"
                + ("" if load.confirmed else "; formula not compared with the original publication"),
            )
        )
    return tuple(found)


def steady_variables(unit: LevelCurtain) -> tuple[dict[str, Any], dict[str, list[Any]]]:
    """Return variables and coordinates that the group ``statics`` holds of the governing steady load."""
    steady = unit.steady
    data: dict[str, Any] = {}
    for name, _, _ in QUANTITIES:
        low, high = steady.band(name)
        data[f"steady_{name}"] = ((), steady.governing.quantity(name))
        data[f"steady_{name}_low"], data[f"steady_{name}_high"] = ((), low), ((), high)
    data["steady_load_bound"] = ((), steady.bound if math.isfinite(steady.bound) else math.nan)
    states = (steady.governing, *steady.causes, steady.lowest, steady.highest)
    for name in ("line_load", "cable_tension", "anchor_horizontal_tension", "effective_depth"):
        data[f"cause_{name}"] = ("steady_cause", [state.quantity(name) for state in states])
    compared = compared_loads(unit)
    data["compared_line_load"] = ("steady_model", [one.line_load for one in compared])
    data["compared_span_load"] = ("steady_model", [one.line_load * unit.curtain.span for one in compared])
    data["compared_ratio"] = ("steady_model", [one.line_load / compared[0].line_load for one in compared])
    data["compared_standing"] = ("steady_model", [one.standing for one in compared])
    data["compared_why"] = ("steady_model", [one.why for one in compared])
    turned = _by_direction(unit)
    for name, values in turned.items():
        data[f"direction_{name}"] = ("steady_direction", values)
    coords = {
        "steady_cause": [state.name for state in states],
        "steady_model": [one.name for one in compared],
        "steady_direction": list(_DIRECTIONS),
    }
    return data, coords


def _by_direction(unit: LevelCurtain) -> dict[str, list[float]]:
    """Return load and forces with the current turned away from the normal; NaN where there is no equilibrium."""
    names = ("span_load", "cable_tension", "anchor_horizontal_tension")
    rows: dict[str, list[float]] = {name: [] for name in names}
    for angle in _DIRECTIONS:
        try:
            statics = unit.turned(float(angle)).statics(unit.hanging, unit.surface_speed)
            values = (sum(statics.plan.downstream_end_forces), statics.plan.tension, statics.anchor_horizontal_tension)
        except (InputError, ConvergenceError):
            values = (math.nan,) * 3
        for name, value in zip(names, values):
            rows[name].append(value)
    return rows
