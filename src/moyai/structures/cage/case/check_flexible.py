"""Checks of a flexible cage case: does it float, do its lines reach, does its law cover its net and speeds."""

from __future__ import annotations

from pathlib import Path

from moyai.case.check_catalogue import check_catalogue
from moyai.case.findings import Findings
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import InputError
from moyai.structures.cage.case import schema
from moyai.structures.cage.case.check_rigid import check_law_and_water
from moyai.structures.cage.case.schema_flexible import FlexibleCageStructure, GridEntry, RopeEntry


def _check_ropes(unit: FlexibleCageStructure, findings: Findings) -> None:
    mooring = unit.mooring
    if not isinstance(mooring, GridEntry):
        return
    ropes: dict[KeyPath, RopeEntry] = {("frame_rope",): mooring.frame_rope, ("bridle",): mooring.bridle}
    ropes |= {("anchor_line", index): part for index, part in enumerate(mooring.anchor_line)}
    for path, rope in ropes.items():
        if rope.catalogue is not None:
            check_catalogue(("structure", "mooring", *path), rope.catalogue, rope.diameter, findings)


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
