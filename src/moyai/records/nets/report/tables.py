"""Tables of the report of nets."""

from __future__ import annotations

import math

from moyai.morison.net_laws.matsubara import Matsubara
from moyai.report.document import Block, Column, Table
from moyai.report.reading import Group


def _texts(group: Group, name: str) -> list[str]:
    node = group.node
    return [] if node is None or name not in node.coords else [str(value) for value in node.coords[name].values]


def _numbers(group: Group, name: str, dim: str) -> list[float]:
    values = group.real(name, dim)
    return [] if values is None else [float(value) for value in values]


def _known(values: list[float], known: list[float]) -> list[float]:
    """Return values, NaN where the record does not hold them."""
    return [value if sure else math.nan for value, sure in zip(values, known)]


def towing_table(towing: Group) -> list[Block]:
    """Return the coefficients of the runs through still water."""
    if not towing.exists:
        return []
    law = Matsubara()
    low, high = law.reynolds_range
    ratio = [
        value / float(law.twine_drag(number)) if low <= number <= high else math.nan
        for value, number in zip(_numbers(towing, "drag", "run"), _numbers(towing, "reynolds", "run"))
    ]
    return [
        Table(
            "towing",
            "Runs through still water",
            (
                Column("Run", list(towing.labels("run"))),
                Column("Net", _texts(towing, "net")),
                Column("speed", _numbers(towing, "speed", "run"), "m/s"),
                Column("Re", _numbers(towing, "reynolds", "run")),
                Column("force on the frame", _numbers(towing, "frame_force", "run"), "N"),
                Column("C_D", _numbers(towing, "drag", "run"), digits=4),
                Column("± C_D", _numbers(towing, "drag_half_width", "run"), digits=3),
                Column("over 9.84 Re^-0.36", ratio),
                Column("C_L", _numbers(towing, "lift", "run"), digits=2),
                Column("± C_L", _numbers(towing, "lift_half_width", "run"), digits=3),
                Column("effective degrees of freedom", _numbers(towing, "freedom", "run"), digits=2),
            ),
            note="On the area of the twines, the frame's force taken off. Intervals follow the autocorrelation of the "
            "low-passed force: so many samples are independent, not more.",
        )
    ]


def wave_table(waves: Group) -> list[Block]:
    """Return the coefficients of the runs in waves."""
    if not waves.exists:
        return []
    values = {
        key: _known(_numbers(waves, key, "run"), _numbers(waves, f"{key}_known", "run")) for key in ("drag", "inertia")
    }
    return [
        Table(
            "waves",
            "Runs in waves",
            (
                Column("Run", list(waves.labels("run"))),
                Column("Net", _texts(waves, "net")),
                Column("Kind", [kind.replace("_", " ") for kind in _texts(waves, "kind")]),
                Column("period as met", _numbers(waves, "period", "run"), "s"),
                Column("velocity amplitude", _numbers(waves, "velocity_amplitude", "run"), "m/s"),
                Column("KC", _numbers(waves, "keulegan_carpenter", "run")),
                Column("largest Re", _numbers(waves, "reynolds", "run")),
                Column("C_D", values["drag"], digits=4),
                Column("± C_D", _numbers(waves, "drag_half_width", "run"), digits=3),
                Column("C_M", values["inertia"]),
                Column("± C_M", _numbers(waves, "inertia_half_width", "run"), digits=2),
                Column("correlation", _numbers(waves, "correlation", "run"), digits=2),
                Column("explained", _numbers(waves, "explained", "run")),
                Column("lift over drag, rms", _numbers(waves, "lift_share", "run"), digits=2),
            ),
            note="By least squares over the record, on the area and the volume of the twines; the bare frame's "
            "coefficients in the same waves are taken off. A coefficient whose interval exceeds half of it is not "
            "given.",
        )
    ]


def net_table(nets: Group) -> list[Block]:
    """Return the nets with the power law of each."""
    if not nets.exists:
        return []
    columns = [
        Column("Net", list(nets.labels("net"))),
        Column("twine", [1e3 * value for value in _numbers(nets, "twine_diameter", "net")], "mm", fixed=True),
        Column("pitch", [1e3 * value for value in _numbers(nets, "mesh_pitch", "net")], "mm", fixed=True),
        Column("solidity, geometric", _numbers(nets, "solidity", "net")),
        Column("solidity, listed", _numbers(nets, "solidity_listed", "net")),
        Column("A", _numbers(nets, "factor", "net")),
        Column("A from", _numbers(nets, "factor_low", "net")),
        Column("A to", _numbers(nets, "factor_high", "net")),
        Column("B", _numbers(nets, "exponent", "net")),
        Column("B from", _numbers(nets, "exponent_low", "net")),
        Column("B to", _numbers(nets, "exponent_high", "net")),
    ]
    if nets.real("joint_factor", "net") is not None:
        columns.append(Column("A, all nets", _numbers(nets, "joint_factor", "net")))
        columns.append(Column("B, all nets", _numbers(nets, "joint_exponent", "net")))
    return [Table("nets", "Nets and C_D = A Re^-B", tuple(columns))]


def tension_table(tensions: Group) -> list[Block]:
    """Return the tension at every end of every line."""
    if not tensions.exists:
        return []

    def of(name: str) -> list[float]:
        return _numbers(tensions, name, "line_end")

    return [
        Table(
            "tensions",
            "Tension at both ends of each line",
            (
                Column("Run", _texts(tensions, "run")),
                Column("Line", _texts(tensions, "line")),
                Column("End", _texts(tensions, "end")),
                Column("mean", of("tension_mean"), "N"),
                Column("least", of("tension_least"), "N"),
                Column("peak", of("tension_peak"), "N"),
                Column("mean of peaks", of("tension_mean_peak"), "N"),
                Column("deviation of peaks", of("tension_peak_deviation"), "N"),
                Column("first harmonic", of("tension_first"), "N"),
                Column("slack, share of time", of("slack"), digits=2),
            ),
        )
    ]
