"""Checks of a breakwater before anything is solved: chain left on the bed at rest, panels that its section needs."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.case.findings import Findings
from moyai.case.schema_lines import CatalogueSegment
from moyai.core.remembered import Remembered, key_of_objects
from moyai.mooring.lines import Line

if TYPE_CHECKING:
    from collections.abc import Sequence

    from moyai.structures.breakwater.assembly import FloatingUnit

_COUNTED: Remembered[bool] = Remembered(64)
#: Longest line that is looked for, over the line of the case
_LONGEST = 3.0


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


def check_chain_on_bed(
    model: Any, lines: Sequence[Any], depth: float, level: str, findings: Findings, reported: set[str]
) -> None:
    """Warn of chains to the bed that leave nothing on it at rest: their anchors are pulled upwards.

    Parameters
    ----------
    model : BreakwaterCase
    lines : sequence of line elements
        Of the upright unit at rest, their origin at its centre of gravity.
    depth : float
        Of the bed under that origin [m].
    level : str
        Name of the water level.
    findings : Findings
    reported : set of str
        Names of the lines that were reported of at another level; the highest level comes first.
    """
    for index, (entry, line) in enumerate(zip(model.lines, lines)):
        if not isinstance(line, Line) or line.name in reported or not _begins_with_chain(entry):
            continue
        if line.bed_clearance(depth) != 0.0:
            continue
        state = line.solve(np.array([line.fairlead]), depth)
        uplift = float(state.vertical_tension_anchor[0])
        if not (float(state.grounded_length[0]) <= 0.0 < uplift):
            continue
        reported.add(line.name)
        needed = _length_with_chain_on_bed(line, depth)
        remedy = "bring the anchor nearer or lengthen the line"
        if needed is not None:
            remedy = f"{needed:.4g} m of line would just touch down at rest; in waves it needs more"
        findings.warn(
            ("lines", index, "segments"),
            f"line '{line.name}': no chain lies on the bed at rest (water level {level}); it pulls its anchor upwards "
            f"with {uplift / 1e3:.3g} kN before any wave",
            allowed="some chain on the bed, unless the anchor bears uplift",
            remedy=remedy,
        )


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


def _begins_with_chain(entry: Any) -> bool:
    first = entry.segments[0]
    if isinstance(first, CatalogueSegment):
        return "chain" in first.catalogue
    return "chain" in (first.name or "") or "chain" in entry.name


def _length_with_chain_on_bed(line: Line, depth: float) -> float | None:
    """Return the shortest length whose catenary touches the bed at the anchor [m], to a thousandth."""

    def grounded(length: float) -> bool:
        first = replace(line.segments[0], length=line.segments[0].length + length - line.length)
        longer = replace(line, segments=(first, *line.segments[1:]))
        return float(longer.solve(np.array([line.fairlead]), depth).grounded_length[0]) > 0.0

    low, high = line.length, line.length
    while not grounded(high):
        high += 0.02 * line.length
        if high > _LONGEST * line.length:
            return None
    low = max(low, high - 0.02 * line.length)
    while high - low > 1e-4 * line.length:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grounded(middle) else (middle, high)
    return high
