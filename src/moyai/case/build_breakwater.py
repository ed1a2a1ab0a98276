"""From the breakwater schema to :mod:`moyai.breakwater.model`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from moyai.breakwater.model import (
    Breakwater,
    BreakwaterProblem,
    CoefficientsFile,
    Damping,
    MeasuredPoints,
    MooringLine,
    MooringSpring,
    Sensitivity,
    Settings,
    TimeSettings,
)
from moyai.case import schema_breakwater as schema
from moyai.case.build_sea import environment_of
from moyai.case.measured import read_points
from moyai.case.schema_lines import CatalogueSegment, CatenaryLine, ClumpEntry, LineEntry, OwnSegment, SpringLine
from moyai.core.errors import InputError
from moyai.mooring.lines import Clump, LineType, Segment
from moyai.sea.water import Water
from moyai.tables.lines import line_type


def build_problem(
    model: schema.BreakwaterCase, folder: Path, *, case_text: str = "", case_hash: str = ""
) -> BreakwaterProblem:
    """Return the breakwater problem of a case.

    Parameters
    ----------
    model : BreakwaterCase
        Validated content.
    folder : Path
        Folder that the file names in it refer to.
    case_text, case_hash : str
        Kept with the result.

    Raises
    ------
    InputError
        For what the schema alone cannot see: shapes, catalogue names, files.
    """
    water = Water(model.site.water_depth, model.site.density, model.site.gravity)
    measured = None
    if model.measured is not None:
        columns = read_points(folder / model.measured.file, model.measured.columns, "measured.file")
        measured = MeasuredPoints(model.measured.file, columns)
    return BreakwaterProblem(
        title=model.title,
        breakwater=breakwater_of(model, water, folder),
        environment=environment_of(model, water, folder),
        settings=settings_of(model),
        measured=measured,
        case_text=case_text,
        case_hash=case_hash,
    )


def breakwater_of(model: schema.BreakwaterCase, water: Water, folder: Path) -> Breakwater:
    """Return the floating unit with its lines."""
    unit = model.structure
    try:
        hull = unit.section.hull()
    except InputError as error:
        fault = error.fault
        key = fault.path.split(".")[-1]
        inner = f".{key}" if key in type(unit.section).model_fields else ""
        raise InputError(
            fault.message, path=f"structure.section{inner}", allowed=fault.allowed, remedy=fault.remedy
        ) from None
    gyradius = unit.roll_gyradius
    if gyradius is None:
        if unit.mass is None or unit.roll_inertia is None:
            raise InputError(
                "'roll_inertia' needs 'mass'", path="structure.roll_inertia", remedy="give 'mass' or 'roll_gyradius'"
            )
        gyradius = math.sqrt(unit.roll_inertia / unit.mass)
    rig = unit.additional_mass or schema.AdditionalMass()
    return Breakwater(
        hull=hull,
        length=unit.length,
        roll_gyradius=gyradius,
        centre_of_gravity=(unit.centre_of_gravity_x, unit.centre_of_gravity_above_keel),
        mass=unit.mass,
        draught=unit.draught,
        damping=_damping(unit),
        additional_mass=(rig.sway, rig.heave, rig.roll),
        wind_drag_coefficient=unit.wind_drag_coefficient,
        current_drag_coefficient=unit.current_drag_coefficient,
        gap_damping_lid=unit.gap_damping_lid,
        lines=tuple(line_of(line, index, water) for index, line in enumerate(model.lines)),
        coefficients_file=_coefficients(unit.coefficients_file, model, folder),
    )


def _damping(unit: schema.BreakwaterStructure) -> Damping:
    extra = unit.additional_damping or schema.AdditionalDamping()
    roll = unit.roll_damping or schema.RollDampingTerms()
    linear = (extra.sway, extra.heave, extra.roll + roll.linear)
    if unit.damping is None:
        return Damping(linear=linear, roll_quadratic=roll.quadratic)
    return Damping(unit.damping.fraction_of_critical, unit.damping.modes, linear, roll.quadratic)


def _coefficients(entry: Any, model: schema.BreakwaterCase, folder: Path) -> CoefficientsFile | None:
    if entry is None:
        return None
    options: dict[str, Any] = {"sea": entry.sea, "origin": entry.origin}
    if not isinstance(entry, schema.NemohCoefficients) and entry.reference_point is not None:
        options["reference_point"] = entry.reference_point
    if isinstance(entry, schema.CapytaineCoefficients) and entry.body is not None:
        options["body"] = entry.body
    if isinstance(entry, schema.WamitCoefficients):
        # WAMIT files are made dimensionless with these
        options["density"] = model.site.density
        options["gravity"] = model.site.gravity
        for name in ("length_scale", "first_column"):
            if getattr(entry, name) is not None:
                options[name] = getattr(entry, name)
    return CoefficientsFile(entry.program, folder / entry.path, options)


def line_of(entry: LineEntry, index: int, water: Water) -> MooringLine | MooringSpring:
    """Return one entry of ``lines``."""
    fairlead = (entry.fairlead.x, entry.fairlead.y, entry.fairlead.above_keel)
    if isinstance(entry, SpringLine):
        anchor = (entry.anchor.x, entry.anchor.y, entry.anchor.z)
        return MooringSpring(entry.name, entry.count, fairlead, anchor, entry.stiffness, entry.pretension)
    segments: list[Segment] = []
    clumps: list[Clump] = []
    for number, part in enumerate(entry.segments):
        if isinstance(part, ClumpEntry):
            weight = (part.clump.mass - water.density * part.clump.volume) * water.gravity
            clumps.append(Clump(len(segments) - 1, weight))
        else:
            segments.append(_segment(part, f"lines[{index}].segments[{number}]", number, entry, water))
    anchor = (entry.anchor.x, entry.anchor.y, entry.anchor.above_bed)
    return MooringLine(
        entry.name, entry.count, fairlead, anchor, tuple(segments), tuple(clumps), entry.bed_friction, entry.drag_width
    )


def _segment(part: CatalogueSegment | OwnSegment, path: str, number: int, entry: CatenaryLine, water: Water) -> Segment:
    if isinstance(part, CatalogueSegment):
        try:
            properties = line_type(part.catalogue, part.diameter)
        except InputError as error:
            fault = error.fault
            key = "diameter" if fault.path == "diameter" else "catalogue"
            raise InputError(fault.message, path=f"{path}.{key}", allowed=fault.allowed, remedy=fault.remedy) from None
        return Segment(LineType.from_properties(properties, water.density, water.gravity), part.length)
    weight = part.submerged_weight
    if weight is None:
        weight = (part.submerged_mass or 0.0) * water.gravity
    name = part.name or f"{entry.name} {number + 1}"
    breaking = math.inf if part.breaking_load is None else part.breaking_load
    return Segment(LineType(name, weight, part.axial_stiffness, breaking), part.length)


def settings_of(model: schema.BreakwaterCase) -> Settings:
    """Return analyses and settings."""
    given = model.settings
    time = given.time
    return Settings(
        analyses=model.analyses,
        drift=given.drift,
        frequencies=_values(given.frequencies),
        restoring_offsets=_values(given.restoring_offsets),
        time=TimeSettings(time.duration, time.ramp, time.time_step, time.analysed_periods, time.drift, time.memory),
        sensitivity=Sensitivity(
            given.sensitivity.damping_fractions, given.sensitivity.line_slacks, given.sensitivity.line_counts
        ),
    )


def _values(given: Any) -> tuple[float, ...] | None:
    """Return the values of ``auto``, a list or a range."""
    if isinstance(given, str):
        return None
    if isinstance(given, (schema.FrequencyRange, schema.OffsetRange)):
        return given.spread(given.first, given.last, given.count)
    return tuple(given)
