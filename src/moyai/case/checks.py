"""Checks between the keys of a case, beyond what the schema alone can see."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from moyai.case.criteria import criteria_of
from moyai.case.faults import did_you_mean
from moyai.case.findings import Findings
from moyai.case.schema_environment import sea_names
from moyai.case.structures import part
from moyai.case.yaml_reader import Document
from moyai.core.errors import InputError


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
    _check_criteria(model, findings)
    # Checks that build the problem would stumble over criteria that are at fault
    sound = model if findings.sound("criteria") else model.model_copy(update={"criteria": "none"})
    part(model.structure.kind, "check")(sound, findings, folder)
    return findings


def _check_criteria(model: Any, findings: Findings) -> None:
    """Check that seas are known, and that a design code has values for the lines."""
    limits = getattr(model.criteria, "greatest_transmission", None)
    known = sea_names(model.waves)
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
