"""From a file of ``moyai measure nets`` to :class:`moyai.records.nets.campaign.NetCampaign`."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from moyai.case.findings import Findings, duplicates
from moyai.case.measured import read_points
from moyai.case.reader import read_block
from moyai.case.yaml_reader import CaseDocument, KeyPath, read_yaml
from moyai.core import quantities
from moyai.core.errors import CaseError, InputError
from moyai.core.quantities import QuantityKind
from moyai.core.validity import Notice
from moyai.morison.nets import Net
from moyai.records.nets.case.schema import CageRunBlock, NetRunBlock, NetsFile, NetSpecimen
from moyai.tables.nets import matsubara_net

if TYPE_CHECKING:
    from moyai.records.nets.campaign import NetCampaign
    from moyai.records.nets.runs import NetRun, Specimen, Tank
    from moyai.records.nets.tensions import CageRecord

_KINDS: dict[str, QuantityKind] = {
    "time": quantities.TIME,
    "force": quantities.FORCE,
    "lift": quantities.FORCE,
    "speed": quantities.SPEED,
    "velocity": quantities.SPEED,
    "elevation": quantities.LENGTH,
    "acceleration": quantities.ACCELERATION,
}
_NEEDED = ("density", "kinematic_viscosity", "gravity", "water_depth", "panel_z", "nets")


def load_nets(path: str | os.PathLike[str]) -> tuple[NetCampaign, CaseDocument, tuple[Notice, ...]]:
    """Read a file of ``moyai measure nets`` with its records.

    Parameters
    ----------
    path : path-like
        YAML, UTF-8; records are found next to it.

    Returns
    -------
    campaign : NetCampaign
        Nets, runs and how they are read, for :func:`moyai.records.measure_nets`.
    document : CaseDocument
        The file as it was read.
    notices : tuple of Notice
        Misprints of the table's rows that are used.

    Raises
    ------
    CaseError
        With every error at once, each with line and column.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> from moyai.records import load_nets
    >>> folder = Path(mkdtemp())
    >>> text = "moyai: 1\\ntitle: Nets\\npanel_area: 0.066\\npanel_z: -0.2\\nwater_depth: 0.45\\ngravity: 9.81\\n"
    >>> text += "density: 1000\\nkinematic_viscosity: 1.1e-6\\nnets: [{name: A, table: A}]\\nruns:\\n"
    >>> for net, force in (("none", 0.2), ("A", 1.1)):
    ...     rows = [f"{0.05 * n},{force + 0.01 * (n % 2)}" for n in range(400)]
    ...     _ = (folder / f"{net}.csv").write_text("\\n".join(["time [s],force [N]", *rows]), encoding="utf-8")
    ...     text += f"  - {{name: {net}, net: {net}, kind: still_water, file: {net}.csv, speed: 0.3}}\\n"
    >>> _ = (folder / "nets.yaml").write_text(text + "columns: {time: time, force: force}\\n", encoding="utf-8")
    >>> campaign, _, _ = load_nets(folder / "nets.yaml")
    >>> [(run.name, run.speed) for run in campaign.runs]
    [('none', 0.3), ('A', 0.3)]
    """
    document = read_yaml(path)
    model: NetsFile = read_block(document, NetsFile)
    findings = Findings(document)
    campaign, notices = _build(model, findings, Path(path).parent)
    if findings.faults or campaign is None:
        raise CaseError(sorted(findings.faults, key=lambda fault: (fault.line, fault.column)))
    return campaign, document, notices


def _build(model: NetsFile, findings: Findings, folder: Path) -> tuple[NetCampaign | None, tuple[Notice, ...]]:
    from moyai.records.nets.campaign import NetCampaign
    from moyai.records.nets.runs import Tank
    from moyai.records.nets.vibration import Vibration

    for key, items in (("nets", model.nets), ("runs", model.runs), ("cages", model.cages)):
        names = [item.name for item in items]
        for index in duplicates(names):
            findings.fault((key, index, "name"), f"'{names[index]}' is already given above")
    tank: Tank | None = None
    if model.runs:
        for key in _NEEDED:
            if getattr(model, key) in (None, ()):
                findings.fault((), f"'{key}' is missing", remedy="runs of nets need it")
    if model.runs and not findings.faults:
        try:
            tank = Tank(
                model.density or 0.0,
                model.kinematic_viscosity or 0.0,
                model.gravity or 0.0,
                model.water_depth or 0.0,
                model.panel_z or 0.0,
            )
        except InputError as error:
            findings.raised(error, ())
    notices: list[Notice] = []
    specimens = [_specimen(block, index, model, findings, notices) for index, block in enumerate(model.nets)]
    _check_runs(model, findings)
    if findings.faults:
        return None, ()
    runs = [_run(block, index, model, findings, folder) for index, block in enumerate(model.runs)]
    cages = [_cage(block, index, findings, folder) for index, block in enumerate(model.cages)]
    block = model.vibration
    vibration: Vibration | str = "auto" if block.remove else "none"
    if block.remove and block.band is not None:
        low, high = block.band
        if low >= high:
            findings.fault(("vibration", "band"), f"{low:g} Hz is not below {high:g} Hz", allowed="[low, high]")
        else:
            vibration = Vibration(0.5 * (low + high), low, high)
    if block.search[0] >= block.search[1]:
        findings.fault(("vibration", "search"), "the range does not rise", allowed="[low, high]")
    if findings.faults:
        return None, ()
    try:
        campaign = NetCampaign(
            title=model.title,
            tank=tank if tank is not None else Tank(1000.0, 1e-6, 9.81, 1.0, -0.5),
            specimens=tuple(item for item in specimens if item is not None),
            runs=tuple(item for item in runs if item is not None),
            cages=tuple(item for item in cages if item is not None),
            vibration=vibration,  # type: ignore[arg-type]
            search=(block.search[0], block.search[1]),
            solidity=model.law_solidity,
            confidence=model.confidence,
            calibration=model.calibration_error,
            phase_error=float(np.radians(model.phase_error_deg)),
            bootstrap=model.bootstrap,
            seed=model.seed,
        )
    except InputError as error:
        findings.raised(error, ())
        return None, ()
    return campaign, tuple(notices)


def _specimen(
    block: NetSpecimen, index: int, model: NetsFile, findings: Findings, notices: list[Notice]
) -> Specimen | None:
    from moyai.records.nets.runs import Specimen

    path: KeyPath = ("nets", index)
    panel = block.panel_area if block.panel_area is not None else model.panel_area
    if panel is None:
        findings.fault(path, f"the panel area of net '{block.name}' is missing", remedy="give 'panel_area'")
        return None
    area = block.projected_area
    try:
        if block.table is not None:
            row = matsubara_net(block.table)
            notices.extend(row.check())
            net = Net.from_aperture(
                row.twine_diameter, row.aperture, solidity_listed=block.solidity_listed or row.solidity
            )
            if area is None:
                area = row.projected_area
        else:
            if block.twine_diameter is None:
                findings.fault(path, f"the twine diameter of net '{block.name}' is missing")
                return None
            pitch = block.mesh_pitch
            if pitch is None:
                pitch = (block.aperture or 0.0) + block.twine_diameter
            net = Net(block.twine_diameter, pitch, block.solidity_listed, block.knotted, block.solidity_measured)
        return Specimen(block.name, net, panel, net.listed * panel if area is None else area)
    except InputError as error:
        fault = error.fault
        place = (*path, fault.path) if fault.path and (*path, fault.path) in findings.document.values else path
        findings.fault(place, fault.message, allowed=fault.allowed, remedy=fault.remedy)
        return None


def _check_runs(model: NetsFile, findings: Findings) -> None:
    nets = [block.name for block in model.nets]
    frames = [block.name for block in model.runs if block.net == "none"]
    for index, run in enumerate(model.runs):
        path: KeyPath = ("runs", index)
        columns = run.columns or model.columns
        if run.net != "none" and run.net not in nets:
            findings.fault((*path, "net"), f"there is no net '{run.net}'", allowed=", ".join([*nets, "none"]))
        if run.frame is not None and run.frame not in frames:
            allowed = ", ".join(frames) or "give a run with 'net: none'"
            findings.fault((*path, "frame"), f"'{run.frame}' is no run of the bare frame", allowed=allowed)
        if columns.force is None:
            findings.fault((*path, "columns"), "the column of the force is missing")
        if run.kind != "waves" and run.speed is None and columns.speed is None:
            findings.fault(path, "the speed of towing is missing", remedy="give 'speed', or its column")
        if run.kind != "still_water" and columns.velocity is None and columns.elevation is None:
            findings.fault(
                path, "waves need a column of the velocity or of the elevation", remedy="give it under 'columns'"
            )
        for key in ("window", "zero_window"):
            part = getattr(run, key)
            if part is not None and part[0] >= part[1]:
                findings.fault((*path, key), f"{part[0]:g} s is not before {part[1]:g} s", allowed="[start, end]")


def _run(block: NetRunBlock, index: int, model: NetsFile, findings: Findings, folder: Path) -> NetRun | None:
    from moyai.records.nets.runs import NetRun

    columns = block.columns or model.columns
    # a run reads what its kind uses: a calm run has no waves to read
    skipped = {"still_water": ("velocity", "elevation"), "waves": ("speed",), "towing_waves": ()}[block.kind]
    wanted: dict[str, str] = {}
    for target in _KINDS:
        name = getattr(columns, target)
        if name is None or target in skipped:
            continue
        if name in wanted:
            findings.fault(("runs", index, "columns"), f"the column '{name}' is named twice")
            return None
        wanted[name] = target
    kinds = {name: _KINDS[target] for name, target in wanted.items()}
    try:
        table = read_points(folder / block.file, wanted, "file", kinds)
        read = {target: np.asarray(table[target]) for target in wanted.values()}
        return NetRun(
            name=block.name,
            net="" if block.net == "none" else block.net,
            kind=block.kind,
            time=read["time"],
            force=-read["force"] if model.reverse_force else read["force"],
            lift=read.get("lift"),
            speed=block.speed or 0.0,
            speed_record=read.get("speed"),
            velocity=read.get("velocity"),
            elevation=read.get("elevation"),
            distance=block.gauge_to_panel,
            acceleration=read.get("acceleration"),
            period=block.period,
            regular=block.regular,
            following=block.following,
            window=_pair(block.window),
            zero=_pair(block.zero_window),
            frame=block.frame or "",
        )
    except InputError as error:
        _at(findings, ("runs", index), error)
        return None


def _cage(block: CageRunBlock, index: int, findings: Findings, folder: Path) -> CageRecord | None:
    from moyai.records.nets.tensions import CageRecord, EndRecord

    wanted = {block.time: "time"}
    for number, end in enumerate(block.tensions):
        if end.column in wanted:
            findings.fault(("cages", index, "tensions", number, "column"), f"'{end.column}' is named twice")
            return None
        wanted[end.column] = f"tension_{number}"
    kinds = {name: quantities.TIME if target == "time" else quantities.FORCE for name, target in wanted.items()}
    try:
        table = read_points(folder / block.file, wanted, "file", kinds)
        ends = tuple(
            EndRecord(end.line, end.end, np.asarray(table[f"tension_{number}"]))
            for number, end in enumerate(block.tensions)
        )
        return CageRecord(block.name, np.asarray(table["time"]), ends, block.period, _pair(block.window))
    except InputError as error:
        _at(findings, ("cages", index), error)
        return None


def _pair(values: tuple[float, ...] | None) -> tuple[float, float] | None:
    return None if values is None else (values[0], values[1])


def _at(findings: Findings, path: KeyPath, error: InputError) -> None:
    fault = error.fault
    key = {"zero": "zero_window", "speed_record": "columns"}.get(fault.path, fault.path)
    place = (*path, key) if (*path, key) in findings.document.values else path
    findings.fault(place, fault.message, allowed=fault.allowed, remedy=fault.remedy)
