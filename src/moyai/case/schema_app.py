"""Schema of what the page of ``moyai app`` shows of a case, and the check of the paths that it names."""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import AfterValidator, Field

from moyai.case.findings import Findings
from moyai.case.paths import resolve, value_of
from moyai.case.schema_types import Block, once_each
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import InputError
from moyai.core.quantities import parse_quantity

APP = "What the page of `moyai app` shows; it changes no result."
_PATHS = "keys joined by dots, entries of a list by number or name in brackets: lines[0].segments[0].length"

Path = Annotated[str, Field(min_length=1, max_length=200)]


class AppKeys(Block):
    """What the page of `moyai app` shows of the case."""

    sliders: Annotated[tuple[Path, ...], Field(min_length=1, max_length=20), AfterValidator(once_each)] | None = Field(
        default=None,
        description=(
            "Numbers of the case that have a slider, by path, in this order: `structure.draught`, "
            "`lines[0].segments[0].length`. Default: those that matter most for the structure."
        ),
    )


def check_sliders(model: Any, findings: Findings) -> None:
    """Check that every slider stands for one number that is written in the file."""
    shown = getattr(model, "app", None)
    for index, path in enumerate((shown.sliders or ()) if shown is not None else ()):
        where: KeyPath = ("app", "sliders", index)
        try:
            places = resolve(findings.document.data, path)
        except InputError as error:
            fault = error.fault
            findings.fault(where, fault.message, allowed=fault.allowed or _PATHS, remedy=fault.remedy)
            continue
        if len(places) != 1:
            findings.fault(
                where, f"'{path}' means {len(places)} numbers", allowed="one number a slider", remedy="name one"
            )
        elif not is_number(value_of(findings.document.data, places[0])):
            absent = places[0] not in findings.document.values
            said = f"'{path}' is not written in the case" if absent else f"'{path}' is no number of the case"
            findings.fault(where, said, allowed=_PATHS, remedy="write its value into the case" if absent else "")


def is_number(value: Any) -> bool:
    """Whether a value of a file is a number, with or without a unit."""
    if isinstance(value, str):
        try:
            parse_quantity(value)
        except InputError:
            return False
        return True
    return isinstance(value, int | float) and not isinstance(value, bool)
