"""The kinds of structure and who reads, checks, builds, sums up and runs each of them.

A further structure is one entry here, a schema, and the modules that the entry names; nothing else of the case files
or of the command line knows the kinds.
"""

from __future__ import annotations

from dataclasses import dataclass
from importlib import import_module
from typing import Any


@dataclass(frozen=True)
class Structure:
    """Where the parts of one kind of structure live, as ``module:name``, imported when they are needed.

    Parameters
    ----------
    schema : str
        Root schema of its case files.
    check : str
        ``check(model, findings, folder)``: faults and warnings beyond the schema.
    build : str
        ``build_problem(model, folder, case_text=..., case_hash=...)``: from the schema to the problem.
    derived : str
        ``derived_numbers(case)``: what ``moyai check`` shows.
    run : str
        ``run(problem, progress)``: all analyses.
    """

    schema: str
    check: str
    build: str
    derived: str
    run: str


STRUCTURES = {
    "breakwater": Structure(
        schema="moyai.case.schema_breakwater:BreakwaterCase",
        check="moyai.case.check_breakwater:check",
        build="moyai.case.build_breakwater:build_problem",
        derived="moyai.case.derived_breakwater:derived_numbers",
        run="moyai.breakwater.analysis:run",
    ),
    "curtain": Structure(
        schema="moyai.case.schema_curtain:CurtainCase",
        check="moyai.case.check_curtain:check",
        build="moyai.case.build_curtain:build_problem",
        derived="moyai.case.derived_curtain:derived_numbers",
        run="moyai.curtain.analysis:run",
    ),
    "cage": Structure(
        schema="moyai.case.schema_cage:CageCase",
        check="moyai.case.check_cage:check",
        build="moyai.case.build_cage:build_problem",
        derived="moyai.case.derived_cage:derived_numbers",
        run="moyai.cage.analysis:run",
    ),
    "network": Structure(
        schema="moyai.case.schema_network:NetworkCase",
        check="moyai.case.check_network:check",
        build="moyai.case.build_network:build_problem",
        derived="moyai.case.derived_network:derived_numbers",
        run="moyai.network.analysis:run",
    ),
    "member": Structure(
        schema="moyai.case.schema_member:MemberCase",
        check="moyai.case.check_member:check",
        build="moyai.case.build_member:build_problem",
        derived="moyai.case.derived_member:derived_numbers",
        run="moyai.member.analysis:run",
    ),
}


def part(kind: str, name: str) -> Any:
    """Return one part of a kind of structure, for instance ``part("breakwater", "schema")``."""
    module, attribute = getattr(STRUCTURES[kind], name).split(":")
    return getattr(import_module(module), attribute)
