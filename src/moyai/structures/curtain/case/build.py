"""From the curtain schema to :mod:`moyai.structures.curtain.model`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from moyai.case.build_sea import environment_of
from moyai.case.criteria import criteria_of
from moyai.case.measured import read_points
from moyai.core.errors import InputError
from moyai.core.quantities import FORCE, TIME
from moyai.sea.environment import Environment
from moyai.sea.water import Water
from moyai.structures.curtain.case import schema
from moyai.structures.curtain.case.criteria import curtain_factor, curtain_limit
from moyai.structures.curtain.dynamic.model import Mesh
from moyai.structures.curtain.dynamic.runs import DynamicSettings
from moyai.structures.curtain.limits.utilisation import Strength
from moyai.structures.curtain.model import (
    UNJUDGED,
    AnchorLines,
    AnchorLoadSettings,
    Curtain,
    CurtainProblem,
    CurtainSettings,
    ImpactSettings,
    LimitSettings,
    RecordedCable,
    RecordedSnap,
    Strengths,
    WaveSettings,
)
from moyai.structures.curtain.statics.drag import DragLaw, closure_drag, constant_drag, gap_speed_drag
from moyai.structures.curtain.statics.hanging import FloatLine
from moyai.structures.curtain.statics.section import Skirt
from moyai.tables.flume_materials import available_flume_materials, flume_material
from moyai.tables.lines import line_type

#: Finer mesh of the runs of the whole span that are made without being asked for: seconds a sea.
PEAK_CELLS = (12, 4)
_CASE = "case file"


def build_problem(
    model: schema.CurtainCase, folder: Path, *, case_text: str = "", case_hash: str = ""
) -> CurtainProblem:
    """Return the curtain problem of a case.

    Parameters
    ----------
    model : CurtainCase
        Validated content.
    folder : Path
        Folder that the file names in it refer to.
    case_text, case_hash : str
        Kept with the result.

    Raises
    ------
    InputError
        For what the schema alone cannot see: catalogue names, a skirt that floats, files.
    """
    water = Water(model.site.water_depth, model.site.density, model.site.gravity)
    environment = environment_of(model, water, folder)
    return CurtainProblem(
        title=model.title,
        curtain=curtain_of(model, water),
        environment=environment,
        settings=settings_of(model, environment),
        record=None if model.record is None else recorded_snap(model.record, folder),
        case_text=case_text,
        case_hash=case_hash,
        criteria=criteria_of(model),
    )


def recorded_snap(entry: schema.RecordKeys, folder: Path) -> RecordedSnap:
    """Return what a flume record says.

    Parameters
    ----------
    entry : Record
    folder : Path
        Folder that its file refers to.

    Raises
    ------
    InputError
        When the file cannot be read or holds no snap.
    """
    from moyai.series.snap_record import read_snap, sampling_loss

    columns = {entry.time: "time", entry.upper: "upper"}
    kinds = {entry.time: TIME, entry.upper: FORCE}
    names = ["upper"]
    if entry.lower is not None:
        columns[entry.lower] = "lower"
        kinds[entry.lower] = FORCE
        names.append("lower")
    if len(columns) <= len(names):
        raise InputError("one column is named twice", path="record", remedy="name a different column for each")
    table = read_points(folder / entry.file, columns, "record.file", kinds)
    try:
        found = read_snap(
            np.array(table["time"]),
            np.array([table[name] for name in names]),
            unloaded=entry.unloaded,
            names=names,
            release_time=entry.release_time,
            window=entry.window,
        )
    except InputError as error:
        key = error.fault.path.split(".")[0].split("[")[0]
        raise error.at(f"record.{key if key in ('unloaded', 'window', 'release_time') else 'file'}") from None
    cables = [RecordedCable(cable.name, cable.peak, cable.plateau, cable.noise) for cable in (*found.cables, found.sum)]
    return RecordedSnap(
        entry.file,
        found.release_time,
        found.taut_time,
        found.peak_time,
        found.plateau_start,
        tuple(cables[:-1]),
        cables[-1],
        sampling_loss(found.samples_in_rise)[1],
        found.time,
        found.tension,
        found.notices,
    )


def curtain_of(model: schema.CurtainCase, water: Water) -> Curtain:
    """Return the curtain of a case in its water."""
    given = model.structure
    upper, upper_breaking = _cable(given.cables.upper, "structure.cables.upper")
    lower, lower_breaking = 0.0, math.inf
    if given.cables.lower is not None:
        lower, lower_breaking = _cable(given.cables.lower, "structure.cables.lower")
    floats = given.floats
    flooded = floats.buoyancy if floats.flooded_buoyancy is None else floats.flooded_buoyancy
    try:
        line = FloatLine(floats.buoyancy, floats.weight, flooded)
    except InputError as error:
        raise error.at("structure.floats.flooded_buoyancy") from None
    anchors = None
    if given.anchors is not None:
        stiffness = given.anchors.line_stiffness
        if stiffness is None:
            stiffness = (given.anchors.axial_stiffness or math.nan) / given.anchors.line_length
        slope = None if given.anchors.slope_deg is None else math.radians(given.anchors.slope_deg)
        anchors = AnchorLines(given.anchors.line_length, slope, stiffness, given.anchors.pretension)
    return Curtain(
        span=given.span,
        length=given.length,
        normal=math.radians(math.remainder(given.normal_deg, 360.0)),
        skirt=skirt_of(model, water),
        toe=given.toe.kind,
        toe_chain=given.toe.chain_mass if given.toe.chain_mass is not None else math.nan,
        toe_range=given.toe.range,
        floats=line,
        upper_stiffness=upper,
        lower_stiffness=lower,
        drag=_drag(given.drag),
        law=given.load_law,
        passing_fraction=given.passing_fraction,
        may_lie_on_bed=given.may_lie_on_bed,
        joint_distance=given.joints.distance if given.joints is not None else given.span,
        anchors=anchors,
        strengths=_strengths(model, upper_breaking, lower_breaking),
        curtain_class=given.curtain_class or "",
    )


def skirt_of(model: schema.CurtainCase, water: Water) -> Skirt:
    """Return the sheet with its toe load."""
    given, toe = model.structure.skirt, model.structure.toe
    stiffness, weight = given.stiffness, given.submerged_weight
    if given.film is not None:
        try:
            film = flume_material(given.film.material)
        except InputError as error:
            raise error.at("structure.skirt.film.material") from None
        modulus = given.film.modulus if given.film.modulus is not None else 0.5 * sum(film.modulus)
        stiffness = modulus * given.film.thickness
        if weight is None and given.mass_per_area is None:
            weight = film.sheet_submerged_weight(given.film.thickness, water.density, water.gravity)
    if given.mass_per_area is not None:
        if given.sheet_density is None:
            raise InputError(
                "'mass_per_area' needs 'sheet_density'",
                path="structure.skirt.mass_per_area",
                remedy="give it, or 'submerged_weight' in place of both",
            )
        weight = given.mass_per_area * water.gravity * (1.0 - water.density / given.sheet_density)
    if weight is None:
        raise InputError(
            "the weight of the skirt is missing",
            path="structure.skirt",
            remedy="give 'submerged_weight', or 'mass_per_area' with 'sheet_density'; 0 for a sheet as heavy as water",
        )
    load = toe.weight
    if load is not None and toe.chain_density is not None:
        raise InputError(
            "the density of the chain is not used next to 'weight', which is that under water",
            path="structure.toe.chain_density",
            remedy="leave it out, or give 'chain_mass' in place of 'weight'",
        )
    if load is None:
        density = toe.chain_density or schema.STEEL_DENSITY
        if not density > water.density:
            raise InputError(
                f"a chain of {density:g} kg/m3 floats",
                path="structure.toe.chain_density",
                allowed=f"more than {water.density:g} kg/m3",
            )
        load = (toe.chain_mass or 0.0) * water.gravity * (1.0 - water.density / density)
    try:
        return Skirt(given.length, weight, load, stiffness if stiffness is not None else math.inf)
    except InputError as error:
        key = "weight" if toe.weight is not None else "chain_mass"
        raise error.at(f"structure.toe.{key}") from None


def _cable(entry: schema.Cable, path: str) -> tuple[float, float]:
    """Return EA and breaking load [N] of a cable, infinite where it is not known."""
    breaking = math.inf if entry.breaking_load is None else entry.breaking_load
    if entry.catalogue is None:
        return entry.axial_stiffness or 0.0, breaking
    if entry.diameter is None:
        raise InputError(
            "a catalogue's line needs its 'diameter'", path=f"{path}.catalogue", remedy="give the nominal diameter"
        )
    if entry.catalogue in available_flume_materials():
        low, high = flume_material(entry.catalogue).line_stiffness(entry.diameter)
        return 0.5 * (low + high), breaking
    try:
        line = line_type(entry.catalogue, entry.diameter)
    except InputError as error:
        if error.fault.path == "diameter":
            raise error.at(f"{path}.diameter") from None
        named = f"{error.fault.allowed}; of flumes: {', '.join(available_flume_materials())}"
        raise InputError(
            error.fault.message, path=f"{path}.catalogue", allowed=named, remedy=error.fault.remedy
        ) from None
    return line.axial_stiffness, breaking if entry.breaking_load is not None else line.breaking_load


def _drag(entry: Any) -> DragLaw:
    """Return the drag law; a given blockage turns it into the coefficient at that blockage, its range included."""
    if isinstance(entry, schema.ConstantDrag):
        law = constant_drag(entry.coefficient, entry.range, _CASE)
    elif isinstance(entry, schema.GapSpeedDrag):
        law = gap_speed_drag(entry.coefficient, entry.range, _CASE)
    elif isinstance(entry, schema.ClosureDrag):
        law = closure_drag(entry.contraction, entry.range)
    else:
        blockage, coefficients = zip(*entry.points)
        try:
            law = DragLaw("table", blockage, coefficients, entry.range, _CASE)
        except InputError as error:
            raise error.at("structure.drag.points") from None
    if entry.blockage is None:
        return law
    low, middle, high = entry.blockage if isinstance(entry.blockage, tuple) else (entry.blockage,) * 3
    if not low <= middle <= high:
        raise InputError(
            f"blockages {low:g}, {middle:g}, {high:g}",
            path="structure.drag.blockage",
            allowed="low, middle, high rising",
        )
    ends = [law.coefficient(low) * entry.range[0], law.coefficient(high) * entry.range[1]]
    value = law.coefficient(middle)
    bounds = (min(ends[0] / value, 1.0), max(ends[1] / value, 1.0))
    return DragLaw(f"{law.name} at a blockage of {middle:g}", (0.0,), (value,), bounds, _CASE, middle)


def _strengths(model: schema.CurtainCase, upper: float, lower: float) -> Strengths:
    given = model.structure
    anchors, joints = given.anchors, given.joints

    def strength(capacity: float | None, part: str) -> Strength:
        factor, _ = curtain_factor(model, part)
        if capacity is None or math.isnan(factor) or math.isinf(capacity):
            return UNJUDGED
        return Strength(capacity, factor)

    return Strengths(
        upper_cable=strength(upper, "cable"),
        lower_cable=strength(lower, "cable"),
        sheet=strength(given.skirt.strength, "sheet"),
        joint=strength(joints.strength if joints else None, "joint"),
        anchor_line=strength(anchors.breaking_load if anchors else None, "anchor_line"),
        anchor=strength(anchors.holding_force if anchors else None, "anchor"),
        least_reserve=curtain_limit(model, "least_float_reserve"),
        least_depth=curtain_limit(model, "least_effective_depth"),
    )


def settings_of(model: schema.CurtainCase, environment: Environment) -> CurtainSettings:
    """Return analyses and settings."""
    given = model.settings
    impact, cycles, loads, limits = given.impact, given.waves, given.anchor_loads, given.limits
    anchor_loads = None
    if loads is not None and loads.float_mass is not None:
        anchor_loads = loads.fill(AnchorLoadSettings, rule=loads.direction_rule)
    step = limits.rose_step_deg
    return CurtainSettings(
        analyses=model.analyses,
        impact=impact.fill(ImpactSettings),
        waves=cycles.fill(WaveSettings, slowest=cycles.slowest_contact, law=cycles.exceedance),
        anchor_loads=anchor_loads,
        limits=limits.fill(
            LimitSettings,
            speeds=_values(limits.speeds),
            heights=_values(limits.heights),
            # along the normal the waves load a curtain most, whatever the seas of the case and their order
            wave_angle=math.remainder(math.radians(limits.wave_angle_deg or 0.0), 2.0 * math.pi),
            rose_step=None if step is None else math.radians(step),
        ),
        dynamic=dynamic_settings(model),
    )


def dynamic_settings(model: schema.CurtainCase) -> DynamicSettings | None:
    """Return how the whole span is run, ``None`` where it is neither asked for nor to be run by default.

    Raises
    ------
    InputError
        When the mass of the sheet is not known.
    """
    given, skirt = model.settings.dynamic, model.structure.skirt
    asked = "dynamic" in model.analyses
    if not asked and not given.by_default:
        return None
    cells = (given.cells_along, given.cells_down)
    if not asked and not {"cells_along", "cells_down"} & given.model_fields_set:
        cells = PEAK_CELLS
    mass, volume = given.sheet_mass, math.nan
    support, loads = given.support_mass, model.settings.anchor_loads
    if support is None and loads is not None:
        # the float that one anchor rope holds
        support = loads.float_mass
    if mass is None and skirt.mass_per_area is not None:
        mass = skirt.mass_per_area
        volume = mass / skirt.sheet_density if skirt.sheet_density is not None else math.nan
    if mass is None and skirt.film is not None:
        film = flume_material(skirt.film.material)
        mass, volume = film.density * skirt.film.thickness, skirt.film.thickness
    return given.fill(
        DynamicSettings,
        mesh=Mesh(*cells, given.cable_viscosity, given.skirt_damping_time),
        sheet_mass=mass,
        sheet_volume=volume,
        support_mass=support,
        profile=given.start_profile,
        threshold=given.snap_threshold,
    )


def _values(given: Any) -> tuple[float, ...] | None:
    """Return the values of ``auto``, a list or a range."""
    if isinstance(given, str):
        return None
    if isinstance(given, (schema.SpeedRange, schema.HeightRange)):
        return given.spread(given.first, given.last, given.count)
    return tuple(given)
