"""``moyai measure decay``: natural period and damping out of a free decay."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from moyai.cli.console import OK, guard, print_json, say
from moyai.cli.files import decimal_sign
from moyai.cli.measured import Missing, TimeUnit, say_notices, sound_record


def decay(
    file: Annotated[Path, typer.Argument(metavar="RECORD", help="Text file with headings.", show_default=False)],
    column: Annotated[str, typer.Option("--column", help="Heading of the motion.")],
    time: Annotated[str, typer.Option("--time", help="Heading of the time; the first column when absent.")] = "",
    unit: Annotated[
        str, typer.Option("--unit", help="Unit of the motion where the heading has none: m, mm, deg.")
    ] = "",
    time_unit: TimeUnit = "",
    missing: Missing = None,
    start: Annotated[float | None, typer.Option("--start", help="First instant to use [s].")] = None,
    end: Annotated[float | None, typer.Option("--end", help="Last instant to use [s].")] = None,
    equilibrium: Annotated[
        float | None, typer.Option("--equilibrium", help="Position at rest, SI; found when absent.")
    ] = None,
    smallest: Annotated[float, typer.Option("--smallest", help="Smallest swing used, over the first.")] = 0.05,
    linear: Annotated[bool, typer.Option("--linear", help="Fit linear damping alone.")] = False,
    decimal: Annotated[str, typer.Option("--decimal", help="Decimal sign of the record.")] = ".",
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
) -> None:
    """Find natural period, linear and quadratic damping of a free decay."""
    with guard(as_json):
        from moyai.core.quantities import ANGLE, LENGTH
        from moyai.records.reading.sources import ColumnSource, LoggerSource, TimeSource
        from moyai.records.survey.motions import fit_decay_record

        source = LoggerSource(
            "decay",
            (file,),
            (ColumnSource(column, "motion", unit, missing=tuple(missing or ()), kinds=(LENGTH, ANGLE)),),
            TimeSource((time or 1,), unit=time_unit),  # type: ignore[arg-type]
            format="csv",
            decimal=decimal_sign(decimal),
        )
        record = sound_record(source)
        found = fit_decay_record(
            record.time,
            record["motion"],
            start=start,
            end=end,
            equilibrium=equilibrium,
            smallest=smallest,
            quadratic=not linear,
        )
        notices = (*record.notices, *found.notices)
        unit_of = record.units[0]
        if as_json:
            print_json(
                {
                    "period": found.decay.period,
                    "period_error": found.period_error,
                    "damping_ratio": found.decay.damping_ratio,
                    "damping_error": found.damping_error,
                    "quadratic_over_inertia": found.decay.quadratic_over_inertia,
                    "quadratic_error": found.quadratic_error,
                    "equilibrium": found.equilibrium,
                    "start": found.start,
                    "end": found.end,
                    "swings": [float(value) for value in found.decay.extremes],
                    "notices": [notice.as_dict() for notice in notices],
                    "faults": [],
                }
            )
        else:
            say(f"damped period {found.decay.period:.5g} +- {found.period_error:.2g} s")
            say(f"damping ratio {found.decay.damping_ratio:.4g} +- {found.damping_error:.2g} (linear part)")
            quadratic, error = found.decay.quadratic_over_inertia, found.quadratic_error
            say(f"quadratic damping over inertia {quadratic:.4g} +- {error:.2g} 1/{unit_of or '1'}")
            say(f"equilibrium {found.equilibrium:.5g} {unit_of}")
            say(f"{found.decay.extremes.size} swings from {found.start:.5g} to {found.end:.5g} s")
            say("+- is the standard error, over the half cycles left out one by one")
            say_notices(notices)
        raise typer.Exit(OK)
