"""Checks between the keys of a case, beyond what the schema alone can see."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from moyai.case.findings import Findings
from moyai.case.plausibility import check_plausibility
from moyai.case.structures import part
from moyai.case.yaml_reader import Document


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
    part(model.structure.kind, "check")(model, findings, folder)
    return findings
