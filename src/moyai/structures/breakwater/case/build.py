"""From the breakwater schema to :mod:`moyai.structures.breakwater.model`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from moyai.case.build_lines import bar_type_of, line_parts
from moyai.case.build_sea import environment_of
from moyai.case.criteria import criteria_of
from moyai.case.measured import read_points
from moyai.case.schema_lines import ClumpEntry, LineEntry, SpringLineKeys
from moyai.core.errors import InputError
from moyai.sea.water import Water
from moyai.structures.breakwater.case import schema
from moyai.structures.breakwater.model import (
    Breakwater,
    BreakwaterProblem,
    CoefficientsFile,
    Damping,
    MeasuredPoints,
    MooringLine,
    MooringSpring,
)
from moyai.structures.breakwater.settings import MODES
from moyai.tables.edge_damping import edge_damping_numbers


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
    if isinstance(model.measured, schema.MeasuredColumns):
        columns = read_points(folder / model.measured.file, model.measured.columns, "measured.file")
        measured = MeasuredPoints(model.measured.file, columns)
    return BreakwaterProblem(
        title=model.title,
        breakwater=breakwater_of(model, water, folder),
        environment=environment_of(model, water, folder),
        analyses=model.analyses,
        settings=model.settings,
        measured=measured,
        case_text=case_text,
        case_hash=case_hash,
        criteria=criteria_of(model),
    )


def breakwater_of(model: schema.BreakwaterCase, water: Water, folder: Path) -> Breakwater:
    """Return the floating unit with its lines."""
    unit = model.structure
    try:
        hull = unit.section.hull()
    except InputError as error:
        key = error.fault.path.split(".")[-1]
        inner = f".{key}" if key in type(unit.section).model_fields else ""
        raise error.at(f"structure.section{inner}") from None
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
        lines=tuple(
            line_of(line, index, water, in_motion=model.settings.time.lines.mode == "dynamic")
            for index, line in enumerate(model.lines)
        ),
        coefficients_file=_coefficients(unit.coefficients_file, model, folder),
    )


def _damping(unit: schema.BreakwaterStructure) -> Damping:
    extra = unit.additional_damping or schema.AdditionalDamping()
    roll = unit.roll_damping or schema.RollDampingTerms()
    linear = (extra.sway, extra.heave, extra.roll + roll.linear)
    numbers = edge_damping_numbers()
    terms = unit.damping or schema.DampingTerms()
    factor = terms.computed_factor(roll_is_given=unit.roll_damping is not None)
    band = terms.band or (numbers.band_low, numbers.band_high)
    return Damping(
        terms.fraction_of_critical or 0.0,
        terms.modes or MODES,
        linear,
        roll.quadratic,
        factor > 0.0,
        terms.viscous_factor,
        (min(band), max(band)),
    )


def _coefficients(entry: Any, model: schema.BreakwaterCase, folder: Path) -> CoefficientsFile | None:
    if entry is None:
        return None
    options: dict[str, Any] = {"sea": entry.sea, "origin": entry.origin}
    if not isinstance(entry, schema.NemohCoefficients) and entry.reference_point is not None:
        options["reference_point"] = entry.reference_point
    if entry.body is not None:
        options["body"] = entry.body
    if isinstance(entry, schema.WamitCoefficients):
        # WAMIT files are made dimensionless with these
        options["density"] = model.site.density
        options["gravity"] = model.site.gravity
        for name in ("length_scale", "first_column"):
            if getattr(entry, name) is not None:
                options[name] = getattr(entry, name)
    return CoefficientsFile(entry.program, folder / entry.path, options)


def line_of(entry: LineEntry, index: int, water: Water, *, in_motion: bool = False) -> MooringLine | MooringSpring:
    """Return one entry of ``lines``; ``in_motion`` sets it in motion from the start whatever it says itself."""
    fairlead = (entry.fairlead.x, entry.fairlead.y, entry.fairlead.above_keel)
    if isinstance(entry, SpringLineKeys):
        anchor = (entry.anchor.x, entry.anchor.y, entry.anchor.z)
        return MooringSpring(entry.name, entry.count, fairlead, anchor, entry.stiffness, entry.pretension)
    segments, clumps = line_parts(entry, f"lines[{index}]", water)
    anchor = (entry.anchor.x, entry.anchor.y, entry.anchor.above_bed)
    moving = entry.dynamic or in_motion
    materials = tuple(
        bar_type_of(part, f"lines[{index}].segments[{number}]", entry, water, needed=moving)
        for number, part in enumerate(entry.segments)
        if not isinstance(part, ClumpEntry)
    )
    bodies = tuple((part.clump.mass, part.clump.volume) for part in entry.segments if isinstance(part, ClumpEntry))
    return MooringLine(
        entry.name, entry.count, fairlead, anchor, segments, clumps, entry.bed_friction, entry.drag_width,
        moving, tuple(kind for kind in materials if kind is not None) if None not in materials else (), bodies,
    )  # fmt: skip
