"""How fast the water of a case passes its structure, for the numbers that a model keeps and does not keep."""

from __future__ import annotations

import math
import re
from typing import Any

from moyai.case.reader import Case
from moyai.core.units import parse_unit
from moyai.design.model_numbers import WaterMotion
from moyai.sea.dispersion import wave_number
from moyai.study.scaled_case import ScaledCase

# Keys that tell how large a structure is across the flow
_SIZES = ("draught", "skirt_length", "skirt_depth", "depth", "beam", "bottom_beam", "pontoon_beam", "radius")


def motions_of(scaled: ScaledCase, case: Case) -> dict[str, WaterMotion]:
    """Return how fast the water passes the structure and its thinnest member, in the prototype.

    The speed is that of the current and of the largest wave at the surface by linear theory together; a member is
    missing where the case does not give its size, all are where nothing moves.

    Parameters
    ----------
    scaled : ScaledCase
    case : Case
        The case given.
    """
    prototype = scaled.case if scaled.from_model else case
    speed, period = _fastest(prototype)
    if not speed > 0.0:
        return {}
    sizes: dict[str, float] = {}
    for row in scaled.rows:
        key = re.sub(r"\[\d+\]$", "", row.name).rsplit(".", 1)[-1]
        size = abs(row.prototype) * float(parse_unit(row.unit).factor)
        if key in _SIZES and "structure" not in sizes:
            sizes["structure"] = size
        elif key.endswith("diameter"):
            sizes["thinnest member"] = min(size, sizes.get("thinnest member", math.inf))
    depth = float(prototype.model.site.water_depth)
    return {name: WaterMotion(speed, size, period, depth) for name, size in sizes.items()}


def _fastest(case: Case) -> tuple[float, float]:
    """Return the largest speed of the water [m/s] and the shortest wave period [s]."""
    current, site = getattr(case.model, "current", None), case.model.site
    steady = 0.0 if current is None else _current_speed(current)
    orbital, shortest = 0.0, math.inf
    for sea in getattr(case.model, "waves", ()) or ():
        height = getattr(sea, "height", None) or getattr(sea, "significant_height", None)
        periods = sea.all_periods() if hasattr(sea, "all_periods") else ()
        periods = periods or tuple(
            value for name in ("peak_period", "significant_period") if (value := getattr(sea, name, None)) is not None
        )
        for period in periods:
            shortest = min(shortest, period)
            if height is not None:
                number = float(wave_number(2.0 * math.pi / period, site.water_depth, site.gravity))
                orbital = max(orbital, math.pi * height / (period * math.tanh(number * site.water_depth)))
    return steady + orbital, shortest


def _current_speed(current: Any) -> float:
    if current.speed is not None:
        return float(current.speed)
    return max((abs(row[1]) for row in getattr(current.profile, "table", ())), default=0.0)
