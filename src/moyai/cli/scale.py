"""The ``moyai scale`` command: from prototype to model and back."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path
from typing import Annotated

import typer

from moyai.cli.console import guard, print_json, rich_console, say, tell
from moyai.core.errors import InputError

What = Annotated[
    list[str],
    typer.Argument(
        metavar="FILE | NAME=VALUE...",
        help='A case file, or figures with their units: "EA=890 kN" "draught=3 m".',
        show_default=False,
    ),
]


def scale(
    what: What,
    ratio: Annotated[
        str,
        typer.Option(
            "--scale", "--length", metavar="RATIO", help="New size over that given: 1/26 to a model, 26 back from it."
        ),
    ],
    density: Annotated[
        str | None, typer.Option("--density", help="Water of the new size [kg/m3]; that given when absent.")
    ] = None,
    given_density: Annotated[
        str | None, typer.Option("--given-density", help="Water of single values; a case file states its own.")
    ] = None,
    gravity: Annotated[
        str, typer.Option("--gravity", help="Gravity of the new size over that given: 1, but in a centrifuge.")
    ] = "1",
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Case file of the new size to write.", show_default=False)
    ] = None,
    at_hand: Annotated[
        list[str] | None,
        typer.Option(
            "--at-hand",
            metavar="NAME=VALUE",
            help="What the model really has of a quantity (EA, spring, mass): gives the spring in series or the mass "
            "to add. May be repeated.",
        ),
    ] = None,
    line_length: Annotated[
        str | None, typer.Option("--line-length", help="Length in the prototype of the line whose EA is --at-hand.")
    ] = None,
    speed: Annotated[
        str | None,
        typer.Option("--speed", help="Speed of the water in the prototype, for the Reynolds number and others."),
    ] = None,
    across: Annotated[
        str | None, typer.Option("--across", help="Size of the member across the flow, in the prototype.")
    ] = None,
    period: Annotated[str | None, typer.Option("--period", help="Wave period in the prototype.")] = None,
    digits: Annotated[int, typer.Option("--digits", help="Significant digits in the file written.")] = 7,
    force: Annotated[bool, typer.Option("--force", help="Replace a file that exists.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
) -> None:
    """Scale a case file or single values: prototype to model and back, Froude with the Cauchy number kept."""
    with guard(as_json):
        from moyai.cli.scaling import Request, answer

        answered = answer(
            Request(
                what=tuple(what),
                factor=_positive(ratio, "scale"),
                gravity=_positive(gravity, "gravity"),
                density=density,
                given_density=given_density,
                at_hand=tuple(at_hand or ()),
                line_length=line_length,
                speed=speed,
                across=across,
                period=period,
                digits=digits,
            )
        )
        if output is not None:
            if answered.text is None:
                raise InputError(
                    "there is no case file to write", path="output", remedy="name a case file, or leave -o"
                )
            from moyai.cli.files import write_text

            for name, content in answered.files:
                write_text(output.parent / name, content, replace=force)
            write_text(output, answered.text, replace=force)
        if as_json:
            print_json({**answered.record(), "file": None if output is None else str(output)})
            return
        from moyai.cli.scaling import print_answer

        print_answer(rich_console(), answered)
        if output is not None:
            tell(f"wrote {output}; next: moyai check {output}")
        elif answered.text is not None:
            say("nothing written: -o FILE writes the case file of the new size")


def _positive(text: str, name: str) -> Fraction:
    """Return ``1/26``, ``1:26``, ``26`` or ``0.04`` as a fraction."""
    plain = text.strip().replace(":", "/")
    try:
        if not re.fullmatch(r"[0-9.eE+]+(-[0-9]+)?(/[0-9.]+)?", plain):
            raise ValueError
        parts = plain.split("/")
        value = Fraction(parts[0]) / (Fraction(parts[1]) if len(parts) > 1 else 1)
    except (ValueError, ZeroDivisionError):
        raise InputError(
            f"'{text}' is not a ratio", path=name, allowed="a positive ratio such as 1/26, 26 or 0.04"
        ) from None
    if not Fraction(1, 10**6) <= value <= 10**6:
        raise InputError(f"the ratio is {text}", path=name, allowed="1/1000000 to 1000000")
    return value
