"""Checks between the keys of a case, beyond what the schema alone can see."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.case.check_sea import check_file
from moyai.case.criteria import criteria_of
from moyai.case.faults import did_you_mean
from moyai.case.findings import Findings
from moyai.case.measured import measured_sets, read_pairs
from moyai.case.plausibility import check_plausibility
from moyai.case.schema_app import check_sliders
from moyai.case.schema_environment import sea_names
from moyai.case.yaml_reader import CaseDocument, KeyPath, dotted
from moyai.core.errors import Fault, InputError
from moyai.core.kinds import structure_kind


def check(model: Any, document: CaseDocument, folder: Path) -> Findings:
    """Return every fault and warning of a case whose keys are sound.

    Parameters
    ----------
    model : Block
        Validated content.
    document : Document
        The file, for the places.
    folder : Path
        Folder that file names refer to.
    """
    kind = structure_kind(model.structure.kind)
    findings = Findings(document, kind.keys())
    check_plausibility(model, findings)
    faults, warnings = len(findings.faults), len(findings.warnings)
    _check_criteria(model, findings)
    # Checks that build the problem would stumble over criteria that are at fault
    sound = model if findings.sound("criteria") else model.model_copy(update={"criteria": "none"})
    # What cannot be is reported before anything is built of it: the checks build only what is sound so far
    kind.check(sound, findings, folder)
    _check_measured(sound, findings, folder)
    check_sliders(model, findings)
    _leave_to_the_particular(findings, faults, warnings)
    return findings


def _check_measured(model: Any, findings: Findings, folder: Path) -> None:
    """Check that files of measured points are there and hold points."""
    for index, points in measured_sets(model):
        path: KeyPath = ("measured", index, "file")
        # A single set stands in the file without its list
        path = path if path in findings.document.values else ("measured", "file")
        if check_file(path, points.file, folder, findings):
            try:
                read_pairs(folder / points.file, dotted(path))
            except InputError as error:
                findings.raised(error, path)


def _check_criteria(model: Any, findings: Findings) -> None:
    """Check that seas are known, and that a design code has values for the lines."""
    limits = getattr(getattr(model, "criteria", None), "greatest_transmission", None)
    known = sea_names(getattr(model, "waves", ()))
    for name in limits if isinstance(limits, dict) else ():
        if name not in known:
            findings.fault(
                ("criteria", "greatest_transmission", name),
                f"there is no sea state '{name}'",
                allowed=", ".join(known),
                remedy=did_you_mean(name, known),
            )
    try:
        criteria_of(model)
    except InputError as error:
        findings.raised(error, ("criteria",))


def _leave_to_the_particular(findings: Findings, faults: int, warnings: int) -> None:
    """Leave out a general word on a number of which a check of its own speaks too.

    Parameters
    ----------
    findings : Findings
        Of plausibility first, then of the structure's own checks.
    faults, warnings : int
        How many are of plausibility.
    """
    asked = {found.path: found.remedy for found in findings.faults[:faults] if "number without unit" in found.remedy}
    findings.faults[faults:] = [
        replace(found, remedy=asked[found.path]) if found.path in asked and not found.remedy else found
        for found in findings.faults[faults:]
    ]
    grave = [found.path for found in findings.faults[faults:]]
    own = [*grave, *(found.path for found in findings.warnings[warnings:])]

    def general(found: Fault, particular: list[str]) -> bool:
        below = (f"{found.path}.", f"{found.path}[")
        return not any(path == found.path or path.startswith(below) for path in particular)

    # what is impossible is never left to a warning
    findings.faults[:faults] = [found for found in findings.faults[:faults] if general(found, grave)]
    findings.warnings[:warnings] = [found for found in findings.warnings[:warnings] if general(found, own)]
