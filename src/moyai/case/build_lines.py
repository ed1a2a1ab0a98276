"""From the segments and clumps of a line of a case to :mod:`moyai.mooring`, the same for every structure."""

from __future__ import annotations

import math

from moyai.case.schema_lines import CatalogueSegment, CatenaryLine, ClumpEntry, OwnSegment
from moyai.core.errors import InputError
from moyai.mooring.lines import Clump, LineType, Segment
from moyai.sea.water import Water
from moyai.tables.lines import line_type


def line_parts(entry: CatenaryLine, path: str, water: Water) -> tuple[tuple[Segment, ...], tuple[Clump, ...]]:
    """Return segments and clumps of a line, from the anchor to the fairlead.

    Parameters
    ----------
    entry : CatenaryLine
    path : str
        Of the line in the case, for messages.
    water : Water

    Raises
    ------
    InputError
        For names and diameters that the catalogue does not know.
    """
    segments: list[Segment] = []
    clumps: list[Clump] = []
    for number, part in enumerate(entry.segments):
        if isinstance(part, ClumpEntry):
            weight = (part.clump.mass - water.density * part.clump.volume) * water.gravity
            clumps.append(Clump(len(segments) - 1, weight))
        else:
            segments.append(segment_of(part, f"{path}.segments[{number}]", number, entry, water))
    return tuple(segments), tuple(clumps)


def segment_of(
    part: CatalogueSegment | OwnSegment, path: str, number: int, entry: CatenaryLine, water: Water
) -> Segment:
    if isinstance(part, CatalogueSegment):
        try:
            properties = line_type(part.catalogue, part.diameter)
        except InputError as error:
            key = "diameter" if error.fault.path == "diameter" else "catalogue"
            raise error.at(f"{path}.{key}") from None
        return Segment(LineType.from_properties(properties, water.density, water.gravity), part.length)
    weight = part.submerged_weight
    if weight is None:
        weight = (part.submerged_mass or 0.0) * water.gravity
    name = part.name or f"{entry.name} {number + 1}"
    breaking = math.inf if part.breaking_load is None else part.breaking_load
    return Segment(LineType(name, weight, part.axial_stiffness, breaking), part.length)
