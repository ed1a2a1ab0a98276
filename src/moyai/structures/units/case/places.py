"""Where the units of a case stand."""

from __future__ import annotations

import math
from typing import Any

from moyai.structures.units.model import Placement, straight_row


def placements_of(units: Any) -> tuple[Placement, ...]:
    """Return the place of every unit."""
    if units.places:
        return tuple(Placement(place.x, place.y, math.radians(place.heading_deg)) for place in units.places)
    return straight_row(units.count or 1, units.length, units.gap or 0.0)
