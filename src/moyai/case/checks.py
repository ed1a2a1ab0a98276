"""Checks between the keys of a case, beyond what the schema alone can see."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

from moyai.case.findings import Findings
from moyai.case.plausibility import check_plausibility
from moyai.case.structures import part
from moyai.case.yaml_reader import Document
from moyai.core.errors import Fault


def check(model: Any, document: Document, folder: Path) -> Findings:
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
    findings = Findings(document)
    check_plausibility(model, findings)
    faults, warnings = len(findings.faults), len(findings.warnings)
    # What cannot be is told before anything is built of it: the checks build only what is sound so far
    part(model.structure.kind, "check")(model, findings, folder)
    _leave_to_the_particular(findings, faults, warnings)
    return findings


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
    own = [found.path for found in (*findings.faults[faults:], *findings.warnings[warnings:])]

    def general(found: Fault) -> bool:
        return not any(path == found.path or path.startswith((f"{found.path}.", f"{found.path}[")) for path in own)

    findings.faults[:faults] = [found for found in findings.faults[:faults] if general(found)]
    findings.warnings[:warnings] = [found for found in findings.warnings[:warnings] if general(found)]
