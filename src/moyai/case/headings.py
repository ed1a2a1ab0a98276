"""From the directions of a case file to headings in site axes."""

from __future__ import annotations

import math
from typing import Any

from moyai.core.errors import InputError


def heading_of(entry: Any, x_axis_bearing_deg: float | None, path: str) -> float:
    """Return the direction of travel [rad] of waves, wind or current, in (-pi, pi].

    Parameters
    ----------
    entry : Block
        With one of ``heading_deg``, ``from_bearing_deg``, ``to_bearing_deg``.
    x_axis_bearing_deg : float or None
        Compass bearing that +x points to [deg].
    path : str
        Of the entry, for messages.

    Raises
    ------
    InputError
        When a bearing is given and the bearing of the x axis is not.
    """
    if entry.heading_deg is not None:
        return _wrapped(entry.heading_deg)
    bearing = getattr(entry, "to_bearing_deg", None)
    key = "to_bearing_deg"
    if bearing is None:
        key, bearing = "from_bearing_deg", entry.from_bearing_deg + 180.0
    if x_axis_bearing_deg is None:
        raise InputError(
            f"'{key}' needs site.x_axis_bearing_deg",
            path=f"{path}.{key}",
            remedy="give the bearing that +x points to, or use 'heading_deg'",
        )
    # Bearings run clockwise seen from above, headings counter-clockwise from +x
    return _wrapped(x_axis_bearing_deg - bearing)


def _wrapped(degrees: float) -> float:
    turned = math.remainder(degrees, 360.0)
    return math.radians(180.0 if turned == -180.0 else turned)
