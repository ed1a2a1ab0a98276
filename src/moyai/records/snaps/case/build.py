"""From a file of ``moyai measure snaps`` to :class:`moyai.records.snaps.model.SnapRuns`."""

from __future__ import annotations

import os
from pathlib import Path

from moyai.case.findings import Findings, duplicates
from moyai.case.reader import read_block
from moyai.case.yaml_reader import CaseDocument, KeyPath, read_yaml
from moyai.core.errors import CaseError, InputError
from moyai.records.snaps.case.schema import SnapRunBlock, SnapRunsFile
from moyai.records.snaps.model import SnapRun, SnapRuns
from moyai.sea.water import Water
from moyai.structures.curtain.case.build import recorded_snap
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.impact.skirt import BulgedSkirt


def load_snaps(path: str | os.PathLike[str]) -> tuple[SnapRuns, CaseDocument]:
    """Read a file of ``moyai measure snaps`` with its records.

    Raises
    ------
    CaseError
        With every error at once, each with line and column.
    """
    document = read_yaml(path)
    model: SnapRunsFile = read_block(document, SnapRunsFile)
    findings = Findings(document)
    for key, names in (("cables", [item.name for item in model.cables]), ("runs", [item.name for item in model.runs])):
        for index in duplicates(names):
            findings.fault((key, index, "name"), f"'{names[index]}' is already given above")
    runs = [_run(block, index, model, findings, Path(path).parent) for index, block in enumerate(model.runs)]
    if findings.faults:
        raise CaseError(sorted(findings.faults, key=lambda fault: (fault.line, fault.column)))
    read = tuple(run for run in runs if run is not None)
    return SnapRuns(model.title, model.origin, model.drag_coefficient, model.memory, read), document


def _run(block: SnapRunBlock, index: int, model: SnapRunsFile, findings: Findings, folder: Path) -> SnapRun | None:
    path: KeyPath = ("runs", index)
    pair = next((item for item in model.cables if item.name == block.cable), None)
    if pair is None:
        names = ", ".join(item.name for item in model.cables)
        findings.fault((*path, "cable"), f"no cable '{block.cable}'", allowed=names)
        return None
    try:
        water = Water(block.water_depth or model.water_depth, model.density, model.gravity)
        impact = Impact(
            block.span or model.span, block.length, block.draught, pair.upper, pair.lower, block.current, water
        )
        skirt = None
        if model.skirt is not None:
            skirt = BulgedSkirt(block.draught, model.skirt.chord_ratio * block.draught, model.skirt.stiffness)
    except InputError as error:
        key = error.fault.path.split(".")[0]
        findings.raised(error, (*path, key) if key in ("length", "draught", "span") else path)
        return None
    try:
        return SnapRun(block.name, block.cable, impact, skirt, recorded_snap(block, folder))
    except InputError as error:
        key = error.fault.path.removeprefix("record.")
        known = key if key in ("unloaded", "window", "release_time") else "file"
        findings.fault((*path, known), error.fault.message, allowed=error.fault.allowed, remedy=error.fault.remedy)
        return None
