"""From the member schema to :mod:`moyai.structures.member.model`."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from moyai.case.build_sea import current_of, sea_state_of
from moyai.case.criteria import criteria_of
from moyai.case.headings import heading_of
from moyai.case.schema_environment import sea_names
from moyai.core.errors import InputError
from moyai.morison import sections
from moyai.morison.circulation import CirculationLaw
from moyai.morison.coefficients import CoefficientRule, KeuleganCarpenterTable
from moyai.morison.members import StraightMember
from moyai.sea.environment import Environment
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.member.case import schema
from moyai.structures.member.model import HarmonicMotion, MemberProblem, MemberSea, MemberSettings, MemberWaves


def build_problem(model: schema.MemberCase, folder: Path, *, case_text: str = "", case_hash: str = "") -> MemberProblem:
    """Return the member problem of a case.

    Parameters
    ----------
    model : MemberCase
        Validated content.
    folder : Path
        Folder that the file names in it refer to.
    case_text, case_hash : str
        Kept with the result.

    Raises
    ------
    InputError
        For what the schema alone cannot see: sections that meet themselves, files, ends that coincide.
    """
    water = Water(model.site.water_depth, model.site.density, model.site.gravity)
    levels, chosen = model.site.water_levels, model.settings.water_levels
    names = tuple(levels) if isinstance(chosen, str) else chosen
    bearing = model.site.x_axis_bearing_deg
    unit = model.structure
    return MemberProblem(
        title=model.title,
        member=member_of(unit),
        rule=CoefficientRule(drag=_drag(unit.drag), inertia=_inertia(unit.inertia)),
        kinematic_viscosity=unit.kinematic_viscosity,
        environment=Environment(
            water=water,
            water_levels=tuple((name, levels[name]) for name in names),
            current=current_of(model.current, water, bearing),
        ),
        seas=seas_of(model, water, folder),
        circulation=_circulation(unit.circulation),
        form=unit.drag_form,
        roughness=unit.drag.roughness if isinstance(unit.drag, schema.DragTable) else 0.0,
        motion=_motion(unit.motion),
        support=unit.support,
        settings=model.settings.fill(MemberSettings, analyses=model.analyses),
        case_text=case_text,
        case_hash=case_hash,
        criteria=criteria_of(model),
    )


def member_of(unit: schema.MemberStructure) -> StraightMember:
    """Return the member with z above datum."""
    ends = [(end.x, end.y, end.z) for end in (unit.start, unit.end)]
    section = member_section(unit.section, "structure.section")
    try:
        return StraightMember(ends[0], ends[1], section, math.radians(unit.section_angle_deg))
    except InputError as error:
        raise error.at(f"structure.{error.fault.path}") from None


def member_section(entry: Any, path: str) -> sections.MemberSection:
    """Return the section of an entry at ``path``.

    Raises
    ------
    InputError
        For sides that do not fit together or an outline that intersects itself, at the key of the entry.
    """
    try:
        return _section(entry)
    except InputError as error:
        key = error.fault.path.split(".")[-1]
        inner = f".{key}" if key in type(entry).model_fields else ""
        raise error.at(f"{path}{inner}") from None


def _section(entry: Any) -> sections.MemberSection:
    if isinstance(entry, schema.CircularMember):
        return sections.circle(entry.diameter)
    if isinstance(entry, schema.RectangularMember):
        return sections.rectangle(entry.width, entry.height)
    if isinstance(entry, schema.SquareMember):
        return sections.rectangle(entry.width, entry.width)
    if isinstance(entry, schema.RoundedMember):
        return sections.rounded_rectangle(entry.width, entry.height, entry.corner_radius)
    return sections.polygon(np.asarray(entry.points, dtype=float))


def _table(entry: schema.OverKeuleganCarpenter) -> KeuleganCarpenterTable:
    return KeuleganCarpenterTable(tuple((row[0], row[1], row[-1]) for row in entry.table))


def _drag(entry: Any) -> tuple[float, float] | str | KeuleganCarpenterTable:
    if isinstance(entry, schema.DragTable):
        return entry.law
    if isinstance(entry, schema.OverKeuleganCarpenter):
        return _table(entry)
    return (entry, entry) if isinstance(entry, float) else (entry[0], entry[1])


def _inertia(entry: Any) -> tuple[float, float] | str | KeuleganCarpenterTable:
    if isinstance(entry, str):
        return entry
    if isinstance(entry, schema.OverKeuleganCarpenter):
        return _table(entry)
    return (entry, entry) if isinstance(entry, float) else (entry[0], entry[1])


def _circulation(entry: schema.CirculationKeys | None) -> CirculationLaw:
    if entry is None:
        return CirculationLaw(purpose="extreme")
    try:
        return CirculationLaw(
            strength=entry.strength,
            purpose=entry.purpose,
            relaxation_periods=entry.relaxation_periods,
            start=entry.start,
            table=entry.table,
            beta_table=entry.beta_table,
        )
    except InputError as error:
        raise error.at(f"structure.circulation.{error.fault.path}") from None


def _motion(entry: schema.MemberMotion | None) -> HarmonicMotion | None:
    if entry is None:
        return None
    phases = (entry.phase_x_deg, entry.phase_y_deg, entry.phase_z_deg)
    first, second, third = (math.radians(phase) for phase in phases)
    return HarmonicMotion((entry.x, entry.y, entry.z), (first, second, third), entry.period)


def seas_of(model: schema.MemberCase, water: Water, folder: Path) -> tuple[MemberSea, ...]:
    """Return every sea state."""
    bearing = model.site.x_axis_bearing_deg
    names = sea_names(model.waves)
    found: list[MemberSea] = []
    for index, state in enumerate(model.waves):
        if isinstance(state, schema.MemberRegularWaves):
            heading = heading_of(state, bearing, f"waves[{index}]")
            found.append(MemberWaves(names[index], state.all_heights(), state.all_periods(), heading, state.theory))
            continue
        sea = sea_state_of(state, index, model.waves, water, folder, bearing)
        assert isinstance(sea, IrregularSea)
        found.append(sea)
    return tuple(found)
