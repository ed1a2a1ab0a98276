"""``moyai measure tide``: tidal constituents of a water level or a current out of a record with gaps."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from moyai.cli.console import OK, guard, print_json, say
from moyai.cli.files import decimal_sign
from moyai.cli.measured import Missing, TimeUnit, say_notices, sound_record


def tide(
    file: Annotated[Path, typer.Argument(metavar="RECORD", help="Text file with headings.", show_default=False)],
    column: Annotated[
        list[str],
        typer.Option("--column", help="Heading of the water level, or given twice: of the current along x and y."),
    ],
    time: Annotated[str, typer.Option("--time", help="Heading of the time; the first column when absent.")] = "",
    dates: Annotated[
        bool, typer.Option("--dates", help="The time is written as dates, such as 2024-05-01 06:10.")
    ] = False,
    unit: Annotated[str, typer.Option("--unit", help="Unit where the heading has none: m, cm, m/s, cm/s.")] = "",
    time_unit: TimeUnit = "",
    missing: Missing = None,
    names: Annotated[
        list[str] | None,
        typer.Option("--constituent", help="Constituent such as M2, repeat; all that can be distinguished if absent."),
    ] = None,
    trend: Annotated[bool, typer.Option("--trend", help="Fit a trend as well.")] = False,
    decimal: Annotated[str, typer.Option("--decimal", help="Decimal sign of the record.")] = ".",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
) -> None:
    """Find mean, constituents and what they explain; no nodal corrections."""
    with guard(as_json):
        from moyai.core.errors import InputError
        from moyai.core.quantities import LENGTH, PRESSURE, SPEED
        from moyai.records.reading.record import instant_text
        from moyai.records.reading.sources import ColumnSource, LoggerSource, TimeSource
        from moyai.records.survey.tides import fit_tide

        if len(column) > 2:
            raise InputError(
                f"{len(column)} columns", path="--column", allowed="one (water level) or two (current along x and y)"
            )
        if len(set(column)) < len(column):
            raise InputError(f"the column '{column[0]}' is named twice", path="--column")
        kinds, signs = (LENGTH, PRESSURE, SPEED) if len(column) == 1 else (SPEED,), tuple(missing or ())
        record = sound_record(
            LoggerSource(
                "tide",
                (file,),
                tuple(
                    ColumnSource(heading, name, unit, missing=signs, kinds=kinds)
                    for heading, name in zip(column, ("x", "y"))
                ),
                TimeSource((time or 1,), form="iso" if dates else "number", unit=time_unit),  # type: ignore[arg-type]
                format="csv",
                decimal=decimal_sign(decimal),
            )
        )
        current = len(column) == 2
        found = fit_tide(record.time, record["x"], record["y"] if current else None, names=names, trend=trend)
        notices = (*record.notices, *found.notices)
        stated = record.units[0] or "1"
        if as_json:
            print_json(
                {
                    "mean": list(found.mean) if current else found.mean[0],
                    "trend": list(found.trend) if current else found.trend[0],
                    "explained": found.explained,
                    "reference": found.reference,
                    "left_out": list(found.left_out),
                    "constituents": [
                        {
                            "name": one.name,
                            "period": one.period,
                            "major": one.major,
                            "minor": one.minor,
                            "heading_deg": math.degrees(one.heading),
                            "phase_deg": math.degrees(one.phase),
                            "error": one.error,
                        }
                        for one in found.ellipses
                    ],
                    "notices": [notice.as_dict() for notice in notices],
                    "faults": [],
                }
            )
            raise typer.Exit(OK)
        say(f"mean {', '.join(f'{value:.4g}' for value in found.mean[: len(column)])} {stated}")
        say(f"explained {100.0 * found.explained:.4g} % of the variance")
        for one in found.ellipses:
            phase = f"phase {math.degrees(one.phase):.4g} deg"
            if current:
                say(
                    f"{one.name} ({one.period / 3600.0:.4f} h): major {one.major:.4g} +- {one.error:.2g}, "
                    f"minor {one.minor:.3g} {stated}, axis {math.degrees(one.heading):.4g} deg, {phase}"
                )
            else:
                say(f"{one.name} ({one.period / 3600.0:.4f} h): {one.major:.4g} +- {one.error:.2g} {stated}, {phase}")
        say(f"phases count from {instant_text(found.reference, record.dated)}; +- is the standard error")
        say_notices(notices)
        raise typer.Exit(OK)
