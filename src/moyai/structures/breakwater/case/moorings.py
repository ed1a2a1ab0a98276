"""The lines of a floating breakwater for other programs, from the case that its result keeps."""

from __future__ import annotations

from typing import Any

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.core.errors import CaseError, InputError
from moyai.core.results import Result
from moyai.interop.moordyn_network import deck_line_types
from moyai.interop.write_orcaflex_vessel import MooringOfUnit, Moorings
from moyai.structures.breakwater.model import Breakwater, MooringLine

#: Segments of a line, about.
SEGMENTS = 40


def moorings_of_result(result: Result, level: str) -> Moorings:
    """Return the lines of the unit at one water level, each of alike lines by itself, evenly along the unit.

    Parameters
    ----------
    result : Result
        Of a floating breakwater; it holds the text of its case.
    level : str
        Name of the water level.
    """
    text = str(result.tree.attrs.get("case_text", ""))
    try:
        breakwater = build(load_case(text)).breakwater
    except (InputError, CaseError) as error:
        return Moorings((), (), (f"the lines are left out: the case in the result cannot be read ({error})",))
    return _moorings(breakwater, result.tree.children[level].children["statics"])


def _moorings(breakwater: Breakwater, statics: Any) -> Moorings:
    known = [line for line in breakwater.lines if isinstance(line, MooringLine) and line.can_move]
    # equal materials are one line type
    materials = {repr(kind): kind for line in known for kind in line.bar_types}
    types = dict(zip(materials, deck_line_types(list(materials.values())), strict=True))
    notes = [
        f"line '{line.name}' is left out: "
        + ("a spring" if not isinstance(line, MooringLine) else "mass and diameter of its segments are not given")
        for line in breakwater.lines
        if line not in known
    ]
    found: list[MooringOfUnit] = []
    for line in known:
        own = [types[repr(kind)] for kind in line.bar_types]
        if line.clumps:
            notes.append(f"the weights between the segments of line '{line.name}' are left out")
        longest = sum(segment.length for segment in line.segments) / SEGMENTS
        sections = tuple(
            (kind.name, segment.length, min(longest, segment.length)) for kind, segment in zip(own, line.segments)
        )[::-1]
        at = {
            name: float(statics[name].sel(line=line.name))
            for name in ("fairlead_x", "fairlead_z", "anchor_x", "anchor_z")
        }
        for number in range(line.count):
            aside = (number + 0.5) / line.count * breakwater.length - 0.5 * breakwater.length if line.count > 1 else 0.0
            found.append(
                MooringOfUnit(
                    line.name if line.count == 1 else f"{line.name} {number + 1}",
                    (at["fairlead_x"], line.fairlead[1] + aside, at["fairlead_z"]),
                    (at["anchor_x"], line.anchor[1] + aside, at["anchor_z"]),
                    sections,
                )
            )
    if any(line.count > 1 for line in known):
        notes.append("equal lines are evenly spaced along the unit: their places along the crest are not in the case")
    return Moorings(tuple(types.values()), tuple(found), tuple(notes))
