"""Checks of a breakwater before anything is solved: sides of its lines, panels that its section needs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.case.findings import Findings
from moyai.core.remembered import Remembered, key_of_objects

if TYPE_CHECKING:
    from moyai.structures.breakwater.assembly import FloatingUnit

_COUNTED: Remembered[bool] = Remembered(64)


def count_panels(unit: FloatingUnit) -> None:
    """Lay out the panels of a section without solving anything, once for every draught.

    Raises
    ------
    InputError
        For a section that needs more panels than memory and time allow.
    """
    key = key_of_objects(unit.breakwater.hull, unit.draught, unit.heel, unit.water)
    _COUNTED.of(key, lambda: _count(unit))


def _count(unit: FloatingUnit) -> bool:
    from moyai.potential.mesh import Resolution, lay_out, require_memory
    from moyai.sea.dispersion import wave_number
    from moyai.structures.breakwater.hydrodynamics import band

    omega = band(unit).omega
    water = unit.water
    numbers = wave_number(np.array([omega.min(), omega.max()]), water.depth, water.gravity)
    require_memory(lay_out(unit.section, water.depth, (float(numbers[0]), float(numbers[1])), Resolution()))
    return True


def across_the_hull(entry: Any) -> str:
    """Say where a line runs whose anchor lies on the other side of the hull than its fairlead; empty for others.

    Parameters
    ----------
    entry : block of ``lines``
    """
    fairlead, anchor = float(entry.fairlead.x), float(entry.anchor.x)
    if fairlead * anchor >= 0.0:
        return ""
    return (
        f"its fairlead is at x = {fairlead:.4g} m and its anchor at x = {anchor:.4g} m, on the other side of the hull, "
        "so that it runs under the keel"
    )


def off_the_hull(entry: Any, bounds: tuple[float, float, float, float]) -> str:
    """Say where a fairlead stands that lies outside of the hull; empty for others.

    Parameters
    ----------
    entry : block of ``lines``
    bounds : tuple of float
        Of the hull: left, right, keel, deck [m].
    """
    left, right, _, deck = bounds
    x, z = float(entry.fairlead.x), float(entry.fairlead.above_keel)
    margin = 1e-6 * max(right - left, deck)
    if left - margin <= x <= right + margin and -margin <= z <= deck + margin:
        return ""
    return f"its fairlead at x = {x:g} m, {z:g} m above the keel, lies outside the hull"


def check_sides(model: Any, findings: Findings) -> None:
    """Warn of anchors that all lie on one side: nothing then holds the unit against loads towards it."""
    sides = {float(entry.anchor.x) > 0.0 for entry in model.lines if entry.anchor.x}
    if len(sides) != 1:
        return
    towards = "+x" if sides.pop() else "-x"
    crossing = [index for index, entry in enumerate(model.lines) if across_the_hull(entry)]
    place = ("lines", crossing[0], "anchor") if crossing else ("lines",)
    words = f"; line '{model.lines[crossing[0]].name}': {across_the_hull(model.lines[crossing[0]])}" if crossing else ""
    findings.warn(
        place,
        f"all anchors lie on the side {towards} of the unit: no line holds it against loads towards {towards}{words}",
        allowed="anchors on both sides",
        remedy="check the sign of the anchor's x" if crossing else "add lines on the other side",
    )
