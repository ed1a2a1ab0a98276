"""Tables of the damping that a sea met, and of the band that its uncertainty gives transmission and motion."""

from __future__ import annotations

import math

from moyai.report.document import Column, Table
from moyai.report.reading import Group
from moyai.structures.breakwater.report.figures import key
from moyai.structures.breakwater.report.reading import MODES, BreakwaterLevel, Sea
from moyai.structures.breakwater.report.tables import useful_table


def damping_table(level: BreakwaterLevel, sea: Sea) -> Table | None:
    """Return equivalent damping beyond radiation of each mode in an irregular sea, with the motions of its band."""
    group = sea.frequency
    turned = {mode: 180.0 / math.pi if mode == "roll" else 1.0 for mode in MODES}

    def values(name: str) -> list[float]:
        return [group.value(name, dof=mode) * turned[mode] for mode in MODES]

    return useful_table(
        key(level, sea.name, "damping"),
        "Damping beyond wave radiation in this sea, frequency domain",
        [
            Column("Motion", list(MODES)),
            Column(
                "Equivalent, of critical",
                [100.0 * group.value("equivalent_damping_fraction", dof=m) for m in MODES],
                "%",
            ),
            Column("Unit", ["°" if mode == "roll" else "m" for mode in MODES]),
            Column("Significant motion", values("significant_motion"), uniform=False),
            Column("lowest in the band", values("significant_motion_low"), uniform=False),
            Column("highest in the band", values("significant_motion_high"), uniform=False),
        ],
        always=2,
        note=_note(group),
    )


def regular_damping_table(level: BreakwaterLevel, sea: Sea) -> Table | None:
    """Return equivalent damping beyond radiation and the band of the transmission for each period."""
    group = sea.frequency
    periods = group.real("period", "period")
    if periods is None:
        return None

    def column(name: str, words: str, unit: str = "", factor: float = 1.0, **choice: str) -> Column:
        found = group.real(name, "period", **choice)
        values = [math.nan] * len(periods) if found is None else [factor * float(value) for value in found]
        return Column(words, values, unit)

    return useful_table(
        key(level, sea.name, "damping"),
        "Damping beyond wave radiation, frequency domain",
        [
            column("period", "T", "s"),
            *(column("equivalent_damping_fraction", mode, "%", 100.0, dof=mode) for mode in MODES),
            column("transmission_coefficient", "K_T"),
            column("transmission_coefficient_low", "K_T, lowest in the band"),
            column("transmission_coefficient_high", "K_T, highest in the band"),
        ],
        note="Equivalent linear damping of each mode over critical. " + _note(group),
    )


def _note(group: Group) -> str:
    words = group.attributes.get("damping_band", "")
    return f"Band: {words}." if words else ""
