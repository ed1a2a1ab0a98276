"""From a record and its configuration to :mod:`moyai.records.forces.identification`."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from moyai.case.measured import read_points
from moyai.case.reader import read_block
from moyai.case.yaml_reader import CaseDocument, read_yaml
from moyai.core import quantities
from moyai.core.errors import CaseError, InputError
from moyai.records.forces.case.schema import ForceRecordFile, WaveGauge
from moyai.records.forces.identification import METHODS, ForceRecord, Setup
from moyai.records.forces.record import period_of
from moyai.records.forces.waves import orbital_motion
from moyai.structures.member.case.build import member_section


def load_force_record(path: Path) -> tuple[CaseDocument, ForceRecordFile]:
    """Read the configuration of a force record.

    Raises
    ------
    CaseError
        With every error at once, each with line and column.
    """
    document = read_yaml(path)
    model: ForceRecordFile = read_block(document, ForceRecordFile)
    return document, model


def setup_of(model: ForceRecordFile, document: CaseDocument) -> Setup:
    """Return the set-up of a configuration.

    Raises
    ------
    CaseError
        With the place of what does not fit together.
    """
    section = member_section(model.section, "section")
    components = len(model.columns.force)
    order = [("first", "second").index(axis) for axis in model.axes][:components]
    if len(order) < components:
        fault = document.fault(("axes",), f"{len(order)} axes for {components} force columns", remedy="name one each")
        raise CaseError([fault])
    tensor = section.inertia.tensor
    try:
        return Setup(
            density=model.density,
            area=section.area,
            widths=tuple(section.drag_widths[axis] for axis in order),
            period=model.period,
            regular=model.regular,
            form=model.drag_form,
            methods=model.methods or tuple(word for word in METHODS if model.regular or word != "fourier"),
            harmonics=model.harmonics,
            phase_error=math.radians(model.phase_error_deg),
            confidence=model.confidence,
            bootstrap=model.bootstrap,
            seed=model.seed,
            ideal_inertia=tuple(float(tensor[axis, axis]) for axis in order),
        )
    except InputError as error:
        fault = error.fault
        raise CaseError([document.fault((fault.path,), fault.message, remedy=fault.remedy)]) from None


def record_of(path: Path, model: ForceRecordFile) -> ForceRecord:
    """Read the record.

    Raises
    ------
    InputError
        When the file cannot be read or the record is unusable; the message names column and sample.
    """
    names, gauge = model.columns, model.gauge
    if (names.velocity is None) == (gauge is None):
        raise InputError(
            "give the columns of the velocity or a wave gauge, one of both",
            path="columns.velocity",
            allowed="exactly one",
        )
    groups = {"force": names.force, "velocity": names.velocity or (), "acceleration": names.acceleration or ()}
    for key, columns in groups.items():
        if columns and len(columns) != len(names.force):
            raise InputError(
                f"{len(columns)} columns of {key} for {len(names.force)} of force",
                path=f"columns.{key}",
                allowed="equal",
            )
    wanted, kinds = {names.time: "time"}, {names.time: quantities.TIME}
    of = {
        "force": quantities.FORCE_PER_LENGTH if model.length is None else quantities.FORCE,
        "velocity": quantities.SPEED,
        "acceleration": quantities.ACCELERATION,
        "elevation": quantities.LENGTH,
    }
    entries = [(column, f"{key}_{number}") for key, columns in groups.items() for number, column in enumerate(columns)]
    if gauge is not None:
        entries.append((gauge.elevation, "elevation"))
    for column, target in entries:
        if column in wanted:
            raise InputError(f"the column '{column}' is named twice", path="columns")
        wanted[column], kinds[column] = target, of[target.split("_")[0]]
    table = read_points(path, wanted, "record", kinds)

    def gathered(key: str) -> np.ndarray:
        return np.column_stack([table[f"{key}_{number}"] for number in range(len(names.force))])

    force = gathered("force") / (model.length or 1.0)
    time = np.asarray(table["time"])
    if gauge is None:
        rate = gathered("acceleration") if names.acceleration else None
        return ForceRecord(time, force, gathered("velocity"), rate)
    return _with_gauge(time, force, np.asarray(table["elevation"]), model, gauge)


def _with_gauge(
    time: np.ndarray, force: np.ndarray, elevation: np.ndarray, model: ForceRecordFile, gauge: WaveGauge
) -> ForceRecord:
    """Return the record with the motion that linear theory finds from a gauge."""
    # the record itself is judged first: gaps and steps of time and force, clipping of the gauge
    both = np.column_stack([force, elevation])
    ForceRecord(time, both, both)
    period = model.period
    if model.regular and period is None:
        period = period_of(time, elevation[:, None])
    velocity, rate = orbital_motion(
        time,
        elevation,
        water_depth=gauge.water_depth,
        gravity=gauge.gravity,
        height=gauge.member_z,
        distance=gauge.distance_to_member,
        period=period if model.regular else None,
    )
    order = [("first", "second").index(axis) for axis in model.axes][: force.shape[1]]
    return ForceRecord(time, force, velocity[:, order], rate[:, order])
