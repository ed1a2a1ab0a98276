"""Checks of a flexible cage case: does it float, do its lines reach, does its law cover its net and speeds."""

from __future__ import annotations

import math
from pathlib import Path

from moyai.case.check_catalogue import check_catalogue
from moyai.case.findings import Findings
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import InputError
from moyai.structures.cage.case import schema
from moyai.structures.cage.case.check_rigid import check_law_and_water
from moyai.structures.cage.case.schema_flexible import FlexibleCageStructure, GridEntry, RopeEntry

#: Share of the way that anchor lines may lack at rest; fibre ropes take it as a pretension
_USUAL_STRETCH = 0.02


def _check_ropes(unit: FlexibleCageStructure, findings: Findings) -> None:
    mooring = unit.mooring
    if not isinstance(mooring, GridEntry):
        return
    ropes: dict[KeyPath, RopeEntry] = {("frame_rope",): mooring.frame_rope, ("bridle",): mooring.bridle}
    ropes |= {("anchor_line", index): part for index, part in enumerate(mooring.anchor_line)}
    for path, rope in ropes.items():
        if rope.catalogue is not None:
            check_catalogue(("structure", "mooring", *path), rope.catalogue, rope.diameter, findings)


def _check_sinkers(model: schema.CageCase, unit: FlexibleCageStructure, findings: Findings) -> None:
    """Refuse sinkers that are lighter than water, and more of them than the net has knots around."""
    around = unit.mesh.around
    if unit.sinkers is not None and unit.sinkers.count > around:
        findings.fault(
            ("structure", "sinkers", "count"),
            f"{unit.sinkers.count} sinkers on a net of {around} knots around",
            allowed=f"at most {around}",
            remedy="give more knots around in 'mesh', a multiple of 4, or fewer and heavier sinkers",
        )
    density = None if unit.sinkers is None else unit.sinkers.density
    if density is not None and density <= model.site.density:
        findings.fault(
            ("structure", "sinkers", "density"),
            f"sinkers of {density:g} kg/m3 float in water of {model.site.density:g} kg/m3",
            allowed=f"more than {model.site.density:g} kg/m3",
            remedy="steel has 7850 kg/m3, concrete 2400",
        )


def _check_anchor_lines(model: schema.CageCase, unit: FlexibleCageStructure, findings: Findings) -> None:
    """Warn of anchor lines that are much shorter than the way from frame to anchor: they start pulled taut."""
    mooring = unit.mooring
    if not isinstance(mooring, GridEntry):
        return
    length = sum(part.length for part in mooring.anchor_line)
    name, level = max(model.site.water_levels.items(), key=lambda entry: entry[1])
    way = math.hypot(mooring.anchor_distance, model.site.water_depth + level - mooring.frame_depth)
    if math.isfinite(way) and length < (1.0 - _USUAL_STRETCH) * way:
        findings.warn(
            ("structure", "mooring", "anchor_distance"),
            f"the anchors are farther than their lines of {length:g} m reach: {way:.4g} m from frame to anchor at "
            f"{name}, a stretch of {100.0 * (way / length - 1.0):.3g} % before any load",
            allowed=f"usually a way of at most {length / (1.0 - _USUAL_STRETCH):.4g} m",
            remedy="bring the anchors nearer or lengthen the lines",
        )


def check(model: schema.CageCase, findings: Findings, folder: Path) -> None:
    """Record every fault and warning of a flexible cage case in ``findings``."""
    from moyai.morison.net_fouling import check_fouling
    from moyai.structures.cage.case.build_flexible import build_problem
    from moyai.structures.cage.flexible.checks import problem_notices

    unit = model.structure
    assert isinstance(unit, FlexibleCageStructure)
    check_law_and_water(("structure", "net", "law"), unit.net.law, unit.kinematic_viscosity, findings)
    needs = [name for name in ("time", "sensitivity") if name in model.analyses]
    if needs and not model.waves:
        findings.fault(
            ("analyses", model.analyses.index(needs[0])),
            f"'{needs[0]}' needs waves",
            remedy="give 'waves', or leave it out",
        )
    if model.settings.flexible.current_speeds and (model.current is None):
        findings.fault(
            ("settings", "flexible", "current_speeds"),
            "speeds of a current without a current",
            remedy="give 'current', whose profile and heading they scale",
        )
    _check_ropes(unit, findings)
    _check_sinkers(model, unit, findings)
    _check_anchor_lines(model, unit, findings)
    if not findings.sound("structure", "settings", "analyses", "site"):
        return
    try:
        problem = build_problem(model, folder)
        for _, level in problem.environment.water_levels:
            problem.at_level(level)
    except InputError as error:
        findings.raised(error, ("structure",))
        return
    growth = unit.net.growth
    if growth is not None and growth.standard is not None:
        for notice in check_fouling(growth.standard):
            findings.warn(("structure", "net", "growth", "standard"), notice.message, remedy=notice.remedy)
    for notice in problem_notices(problem):
        if notice.severity == "information":
            continue
        where = ("structure", "mesh") if notice.code == "cage-mesh" else ("structure", "net", "law")
        findings.warn(where, notice.message, remedy=notice.remedy)
