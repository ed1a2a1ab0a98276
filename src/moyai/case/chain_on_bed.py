"""Check of lines before anything is solved: chain that lies on the bed at rest."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any

import numpy as np

from moyai.case.findings import Findings
from moyai.case.schema_lines import CatalogueSegment
from moyai.mooring.lines import Line, LineElement

#: Longest line that is looked for, over the line of the case
_LONGEST = 3.0


def check_chain_on_bed(
    lines: Iterable[tuple[int, Any, LineElement, float]], level: str, findings: Findings, reported: set[str]
) -> None:
    """Warn of chains to the bed that leave nothing on it at rest: their anchors are pulled upwards.

    Parameters
    ----------
    lines : iterable of tuple
        Place among the ``lines`` of the case, the block there, the line of the upright unit at rest with its origin at
        the centre of gravity, and the depth of the bed under that [m].
    level : str
        Name of the water level.
    findings : Findings
    reported : set of str
        Names of the blocks that were reported of; the highest level comes first.
    """
    for index, entry, line, depth in lines:
        if not isinstance(line, Line) or entry.name in reported or not _begins_with_chain(entry):
            continue
        if line.bed_clearance(depth) != 0.0:
            continue
        state = line.solve(np.array([line.fairlead]), depth)
        uplift = float(state.vertical_tension_anchor[0])
        if not (float(state.grounded_length[0]) <= 0.0 < uplift):
            continue
        reported.add(entry.name)
        needed = _length_with_chain_on_bed(line, depth)
        remedy = "bring the anchor nearer or lengthen the line"
        if needed is not None:
            remedy = f"{needed:.4g} m of line would just touch down at rest; in waves it needs more"
        findings.warn(
            ("lines", index, "segments"),
            f"line '{line.name}': no chain lies on the bed at rest (water level {level}); it pulls its anchor upwards "
            f"with {uplift / 1e3:.3g} kN before any wave",
            allowed="some chain on the bed, unless the anchor resists uplift",
            remedy=remedy,
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
