"""``moyai measure flume``: incident, reflected and transmitted wave and the harmonics of a run in regular waves."""

from __future__ import annotations

import cmath
import math
from pathlib import Path
from typing import Annotated

import typer

from moyai.cli.console import OK, guard, print_json, say
from moyai.cli.measured import say_notices
from moyai.core.errors import InputError


def flume(
    file: Annotated[Path, typer.Argument(metavar="RECORD", help="CSV file with one heading row.", show_default=False)],
    gauge: Annotated[
        list[str],
        typer.Option(
            "--gauge", metavar="NAME=POSITION", help="Wave gauge and its distance from the wavemaker [m]; repeat."
        ),
    ],
    model: Annotated[float, typer.Option("--model", help="Distance of the model's centre from the wavemaker [m].")],
    depth: Annotated[float, typer.Option("--depth", help="Water depth [m].")],
    period: Annotated[float, typer.Option("--period", help="Wave period [s].")],
    start: Annotated[float | None, typer.Option("--start", help="When the wavemaker starts [s].")] = None,
    wavemaker: Annotated[
        str, typer.Option("--wavemaker", help="Channel of the wavemaker's position, in place of --start.")
    ] = "",
    ramp: Annotated[float, typer.Option("--ramp", help="Periods until the waves are steady.")] = 5.0,
    fraction: Annotated[
        float, typer.Option("--fraction", help="Share of its largest excursion at which the wavemaker has started.")
    ] = 0.02,
    gravity: Annotated[float, typer.Option("--gravity", help="Acceleration of gravity [m/s2].")] = 9.81,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
) -> None:
    """Find reflection, transmission and the harmonics of every channel before waves come back from the wavemaker."""
    with guard(as_json):
        from moyai.records.survey.flume import FlumeLayout, analyse_regular_run, read_flume_record, wavemaker_start
        from moyai.sea.water import Water

        if (start is None) == (not wavemaker):
            raise InputError("the start of the wavemaker is not known", path="--start", remedy="give it or --wavemaker")
        if not period > 0.0:
            raise InputError(f"a period of {period:g} s", path="--period", allowed="greater than 0")
        places = dict(map(_gauge, gauge))
        ahead, behind = (
            tuple(name for name, place in places.items() if (place < model) == front) for front in (True, False)
        )
        if len(ahead) < 2 or not behind:
            raise InputError(
                f"{len(ahead)} gauges in front of the model and {len(behind)} behind it",
                path="--gauge",
                allowed="two or more in front, one or more behind",
            )
        record = read_flume_record(file)
        begun = wavemaker_start(record.time, record.channel(wavemaker), fraction=fraction) if start is None else start
        # waves alone are looked at: the density does not enter
        water = Water(depth, 1000.0, gravity)
        found = analyse_regular_run(
            record, FlumeLayout(model, places, ahead, behind), water, period, start=begun, ramp_periods=ramp
        )
        channels = [
            {
                "name": name,
                "unit": unit,
                "mean": found.mean(name),
                "amplitude": abs(found.amplitude(name)),
                "phase_deg": math.degrees(cmath.phase(found.amplitude(name))),
                "amplitude_spread": found.spread(name),
            }
            for name, unit in zip(record.names, record.units)
        ]
        if as_json:
            print_json(
                {
                    "window": [found.window.start, found.window.end],
                    "wave_number": found.wave_number,
                    "incident_amplitude": found.incident_amplitude,
                    "incident_spread": found.incident_spread,
                    "reflection": found.reflection,
                    "reflection_spread": found.reflection_spread,
                    "transmission": found.transmission,
                    "transmission_spread": found.transmission_spread,
                    "channels": channels,
                    "notices": [notice.as_dict() for notice in found.notices],
                    "faults": [],
                }
            )
            raise typer.Exit(OK)
        unit = record.units[record.names.index(ahead[0])]
        say(f"steady waves from {found.window.start:.5g} to {found.window.end:.5g} s")
        say(f"incident amplitude {found.incident_amplitude:.4g} +- {found.incident_spread:.2g} {unit}")
        say(f"reflection {found.reflection:.4g} +- {found.reflection_spread:.2g}")
        say(f"transmission {found.transmission:.4g} +- {found.transmission_spread:.2g}")
        for one in channels:
            say(
                f"{one['name']}: mean {one['mean']:.4g}, amplitude {one['amplitude']:.4g} +- "
                f"{one['amplitude_spread']:.2g} {one['unit']}, phase {one['phase_deg']:.4g} deg"
            )
        say("+- is how much a number moves while the whole periods slide in the window")
        say_notices(found.notices)
        raise typer.Exit(OK)


def _gauge(text: str) -> tuple[str, float]:
    """Return name and position of a gauge."""
    name, sign, place = text.partition("=")
    try:
        position = float(place)
    except ValueError:
        position = math.nan
    if not (sign and name.strip() and math.isfinite(position)):
        raise InputError(f"'{text}' is no gauge", path="--gauge", allowed="NAME=POSITION, such as WP_2=4.95")
    return name.strip(), position
