"""From the segments and clumps of a line of a case to :mod:`moyai.mooring`, the same for every structure."""

from __future__ import annotations

import math

from moyai.case.schema_lines import CatalogueSegment, CatenaryLine, ClumpEntry, OwnSegment
from moyai.core.errors import InputError
from moyai.flexible.elements import BarType
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
        For names and diameters that the catalogue does not have.
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


#: What a segment of its own must tell when its line is in motion.
NEEDED_IN_MOTION = ("mass", "diameter", "drag_normal", "drag_tangential", "added_mass_normal")


def bar_type_of(
    part: CatalogueSegment | OwnSegment, path: str, entry: CatenaryLine, water: Water, *, needed: bool
) -> BarType | None:
    """Return what a segment is made of for a line in motion, without internal damping.

    ``None`` where the segment does not give enough and the line need not be ``needed`` in motion.

    Raises
    ------
    InputError
        For a segment that does not give enough, cannot stretch, or floats more than its mass allows.
    """
    if isinstance(part, CatalogueSegment):
        return BarType.from_properties(line_type(part.catalogue, part.diameter), viscosity=0.0)
    missing = [name for name in NEEDED_IN_MOTION if getattr(part, name) is None]
    if not needed and (missing or math.isinf(part.axial_stiffness)):
        return None
    if missing:
        raise InputError(
            f"line {entry.name!r} is in motion and a segment of it lacks {', '.join(missing)}",
            path=f"{path}.{missing[0]}",
            remedy="give " + " and ".join(missing) + ", or set dynamic: false",
        )
    if math.isinf(part.axial_stiffness):
        raise InputError(
            f"line {entry.name!r} is in motion and a segment of it cannot stretch",
            path=f"{path}.axial_stiffness",
            allowed="a finite stiffness",
            remedy="give EA, or set dynamic: false",
        )
    mass = float(part.mass or 0.0)
    weight = part.submerged_weight
    if weight is None:
        weight = float(part.submerged_mass or 0.0) * water.gravity
    volume = (mass - weight / water.gravity) / water.density
    if volume < 0.0 and not needed:
        return None
    if volume < 0.0:
        raise InputError(
            f"a segment of line {entry.name!r} weighs {weight / water.gravity:.4g} kg/m in water, {mass:.4g} in air",
            path=f"{path}.mass",
            allowed="more in air than in water",
        )
    return BarType(
        part.name or entry.name, mass, part.axial_stiffness, float(part.diameter or 0.0), volume_per_length=volume,
        drag_normal=float(part.drag_normal or 0.0), drag_tangential=float(part.drag_tangential or 0.0),
        added_mass_normal=float(part.added_mass_normal or 0.0), added_mass_tangential=part.added_mass_tangential,
    )  # fmt: skip
