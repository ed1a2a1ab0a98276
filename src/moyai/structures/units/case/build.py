"""From the schema of a row of units to :mod:`moyai.structures.units.model`."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from moyai.case.build_lines import bar_type_of, line_parts
from moyai.case.build_sea import environment_of
from moyai.case.criteria import criteria_of
from moyai.case.schema_lines import ClumpEntry
from moyai.core.errors import InputError
from moyai.design.fatigue import EnduranceCurve
from moyai.sea.dispersion import wave_number
from moyai.sea.environment import Environment
from moyai.sea.water import Water
from moyai.structures.units.case import schema
from moyai.structures.units.case import schema_connectors as joints
from moyai.structures.units.case.places import placements_of
from moyai.structures.units.model import (
    DOFS,
    Connector,
    Curve,
    FloatingRow,
    MapArea,
    RowCoefficients,
    UnitLine,
    UnitSettings,
    UnitsProblem,
    UnitTimeSettings,
)
from moyai.structures.units.seas import frequencies_of

_AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}
#: Panels of a wave, of the beam and of a unit with panel_size: auto
_WAVE_PANELS, _BEAM_PANELS, _LENGTH_PANELS = 8.0, 6.0, 8.0
#: Half of the length of a curve that stands for a chain or a fender [m]
_REACH = 1.0


def build_problem(model: schema.UnitsCase, folder: Path, *, case_text: str = "", case_hash: str = "") -> UnitsProblem:
    """Return the problem of a case.

    Parameters
    ----------
    model : UnitsCase
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
    environment = environment_of(model, water, folder)
    row = row_of(model, water)
    return UnitsProblem(
        title=model.title,
        row=row,
        environment=environment,
        settings=settings_of(model, row, environment),
        map_area=map_of(model.map),
        criteria=criteria_of(model),
        case_text=case_text,
        case_hash=case_hash,
        coefficients=coefficients_of(model, folder),
    )


def coefficients_of(model: schema.UnitsCase, folder: Path) -> RowCoefficients | None:
    """Return where the coefficients are; None where they are computed."""
    given = model.structure.coefficients_file
    if given is None:
        return None
    options: dict[str, Any] = {}
    points = getattr(given, "reference_points", ())
    if points:
        options["reference_point"] = points
    for name in ("length_scale", "first_column", "phase_at"):
        if getattr(given, name, None) is not None:
            options[name] = getattr(given, name)
    if isinstance(given, schema.WamitRow):
        # WAMIT files are made dimensionless with these
        options |= {"density": model.site.density, "gravity": model.site.gravity}
    return RowCoefficients(
        given.program, folder / given.path, options, given.bodies, given.origin, math.radians(given.x_axis_heading_deg)
    )


def row_of(model: schema.UnitsCase, water: Water) -> FloatingRow:
    """Return the units with their connectors and lines."""
    unit = model.structure
    try:
        hull = unit.section.hull()
    except InputError as error:
        key = error.fault.path.split(".")[-1]
        inner = f".{key}" if key in type(unit.section).model_fields else ""
        raise error.at(f"structure.section{inner}") from None
    placements = placements_of(unit.units)
    fraction, linear = np.zeros(6), np.zeros(6)
    for mode in unit.damping.modes or ():
        fraction[DOFS.index(mode)] = unit.damping.fraction_of_critical or 0.0
    if unit.additional_damping is not None:
        linear = np.array([getattr(unit.additional_damping, name) for name in DOFS])
    return FloatingRow(
        hull=hull,
        length=unit.units.length,
        draught=unit.draught,
        centre_of_gravity_above_keel=unit.centre_of_gravity_above_keel,
        gyradii=(unit.pitch_gyradius, unit.roll_gyradius, unit.yaw_gyradius),
        placements=placements,
        connectors=tuple(connector_of(entry, len(placements)) for entry in unit.connectors),
        lines=tuple(line_of(entry, index, water, len(placements)) for index, entry in enumerate(model.lines)),
        damping_fraction=fraction,
        linear_damping=linear,
        viscous_factor=unit.damping.computed_factor(),
        gap_damping_lid=unit.gap_damping_lid,
        wind_drag_coefficient=unit.wind_drag_coefficient,
        current_drag_coefficient=unit.current_drag_coefficient,
    )


def _axis(given: Any) -> tuple[float, float, float]:
    if isinstance(given, str):
        return _AXES[given]
    size = math.hypot(*given)
    return given[0] / size, given[1] / size, given[2] / size


def connector_of(entry: Any, count: int) -> Connector:
    """Return one entry of ``connectors``."""
    if isinstance(entry.between, str):
        pairs = tuple((number, number + 1) for number in range(count - 1))
    else:
        pairs = tuple((first - 1, second - 1) for first, second in entry.between)
    base: dict[str, Any] = {
        "name": entry.name, "kind": entry.kind, "pairs": pairs, "x": entry.x, "above_keel": entry.above_keel,
        "breaking_load": math.inf if entry.breaking_load is None else entry.breaking_load,
        "endurance": _endurance(entry.endurance),
    }  # fmt: skip
    if isinstance(entry, joints.HingeConnector):
        return Connector(**base, axis=_axis(entry.axis))
    if isinstance(entry, joints.SpringConnector):
        stiffness = np.diag([*entry.stiffness, *entry.rotational_stiffness])
        return Connector(**base, stiffness=stiffness, damping=np.diag([*entry.damping, *entry.rotational_damping]))
    if isinstance(entry, (joints.RigidConnector, joints.BallConnector)):
        return Connector(**base)
    if isinstance(entry, joints.RubberConnector):
        elongation, force = zip(*entry.curve)
        curve = Curve(elongation, force)
    elif isinstance(entry, joints.ChainConnector):
        reach = entry.slack + _REACH
        curve = Curve((entry.slack - reach, entry.slack, reach), (0.0, 0.0, entry.stiffness * _REACH))
    else:
        reach = entry.clearance + _REACH
        curve = Curve((-reach, -entry.clearance, reach), (-entry.stiffness * _REACH, 0.0, 0.0))
    return Connector(
        **base, axis=_axis(entry.direction or "y"), curve=curve, linear_damping=entry.damping,
        end_to_end=entry.direction is None,
    )  # fmt: skip


def _endurance(given: joints.Endurance | None) -> EnduranceCurve | None:
    if given is None:
        return None
    capacity = given.cycles * given.range**given.exponent
    return EnduranceCurve("of the case", given.exponent, capacity, "N", True, "case file")


def line_of(entry: Any, index: int, water: Water, count: int) -> UnitLine:
    """Return one entry of ``lines``."""
    units = tuple(range(count)) if isinstance(entry.units, str) else tuple(number - 1 for number in entry.units)
    fairlead = (entry.fairlead.x, entry.fairlead.y, entry.fairlead.above_keel)
    if isinstance(entry, schema.UnitSpringLine):
        anchor = (entry.anchor.x, entry.anchor.y, entry.anchor.z)
        return UnitLine(
            entry.name, entry.count, units, fairlead, anchor, stiffness=entry.stiffness, pretension=entry.pretension
        )
    segments, clumps = line_parts(entry, f"lines[{index}]", water)
    anchor = (entry.anchor.x, entry.anchor.y, entry.anchor.above_bed)
    materials = [
        bar_type_of(part, f"lines[{index}].segments[{number}]", entry, water, needed=False)
        for number, part in enumerate(entry.segments)
        if not isinstance(part, ClumpEntry)
    ]
    kinds = tuple(kind for kind in materials if kind is not None)
    bodies = tuple((part.clump.mass, part.clump.volume) for part in entry.segments if isinstance(part, ClumpEntry))
    return UnitLine(
        entry.name, entry.count, units, fairlead, anchor, segments, clumps, entry.bed_friction,
        bar_types=kinds if len(kinds) == len(materials) else (), clump_bodies=bodies,
    )  # fmt: skip


def map_of(block: schema.MapBlock | None) -> MapArea:
    """Return where the waves are computed; a point where the case has no map."""
    if block is None:
        return MapArea((0.0, 0.0), (0.0, 0.0), (1, 1))
    return MapArea(
        block.x, block.y, (block.points_across, block.points_along),
        tuple((point.name, point.x, point.y) for point in block.points),
        None if block.line is None else (*block.line.start, *block.line.end),
    )  # fmt: skip


def settings_of(model: schema.UnitsCase, row: FloatingRow, environment: Environment) -> UnitSettings:
    """Return analyses and settings."""
    given = model.settings
    frequencies: tuple[float, ...] | None = None
    if isinstance(given.frequencies, schema.RowFrequencyRange):
        frequencies = given.frequencies.spread(given.frequencies.first, given.frequencies.last, given.frequencies.count)
    elif not isinstance(given.frequencies, str):
        frequencies = tuple(given.frequencies)
    settings = given.fill(
        UnitSettings,
        panel_size=given.panel_size or 0.0,
        analyses=model.analyses,
        frequencies=frequencies,
        section_compare=given.compare_with_section,
        time=given.time.fill(UnitTimeSettings),
    )
    if given.panel_size is not None:
        return settings
    size = min(row.hull.beam / _BEAM_PANELS, row.length / _LENGTH_PANELS)
    omega = frequencies_of(environment, settings)
    if omega.size:
        depth = environment.water.depth + min(level for _, level in environment.water_levels)
        k = float(wave_number(float(omega.max()), depth, environment.water.gravity))
        size = min(size, 2.0 * math.pi / (k * _WAVE_PANELS))
    return replace(settings, panel_size=float(f"{size:.3g}"))
