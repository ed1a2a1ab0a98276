"""Polyester ropes of decks whose static curve depends on the highest mean tension that they have carried (Syrope).

A new rope follows its original curve. One that has carried a mean tension ``highest`` has stretched: up to that
tension it follows a working curve that begins at the strain left without tension, beyond it the original one. Quick
changes are stiffer (alpha + beta T); the law itself is in :mod:`moyai.flexible.worn_law`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.flexible.worn_law import Form, WornRope
from moyai.interop.moordyn_deck import DeckLine, DeckLineType
from moyai.interop.moordyn_records import DeckSyrope, StiffnessTable
from moyai.interop.moordyn_rows import DeckRow, Faults
from moyai.interop.textfiles import parse_number, read_lines

DeckForm = Literal["LINEAR", "QUADRATIC", "EXP"]
FORMS: tuple[DeckForm, ...] = ("LINEAR", "QUADRATIC", "EXP")


@checks_words
def working_curve(original: StiffnessTable, form: DeckForm, k1: float, k2: float, highest: float) -> StiffnessTable:
    """Return the curve at rest of a rope that has carried a mean tension.

    Parameters
    ----------
    original : StiffnessTable
        Of the new rope.
    form : {"LINEAR", "QUADRATIC", "EXP"}
        Shape of the working curve.
    k1 : float
        Strain left without tension over the strain at the highest tension [-]; above 1 the stiffness of a linear
        working curve [N].
    k2 : float
        Of the shape [-]: 1 for the parabola, the exponent of the exponential; without meaning for a line.
    highest : float
        Highest mean tension so far [N]; 0 for a new rope.

    Raises
    ------
    InputError
        For tensions beyond the original curve, and parameters out of their range.

    Examples
    --------
    >>> new = StiffnessTable((0.0, 0.04), (0.0, 4e5), "owc.dat")
    >>> worn = working_curve(new, "QUADRATIC", 0.25, 1.0, 2e5)
    >>> float(np.interp(0.0125, worn.strain, worn.tension))       # half way from 0.005 to 0.02 [N]
    50000.0
    """
    strain, tension = law_of(original, DeckSyrope(form, k1, k2, 1.0, 0.0, 1.0, highest)).curve_at_rest()
    return StiffnessTable(tuple(strain.tolist()), tuple(tension.tolist()), original.file)


def law_of(original: StiffnessTable, syrope: DeckSyrope) -> WornRope:
    """Return the law of a rope of a deck.

    Raises
    ------
    InputError
        For what :class:`moyai.flexible.worn_law.WornRope` refuses.
    """
    form: Form = {"LINEAR": "linear", "QUADRATIC": "quadratic", "EXP": "exponential"}[syrope.form]  # type: ignore[assignment]
    return WornRope(
        np.array(original.strain), np.array(original.tension), form, syrope.k1, syrope.k2, syrope.alpha, syrope.beta,
        syrope.damping, syrope.highest,
    )  # fmt: skip


def read_syrope(row: DeckRow, folder: Path, faults: Faults) -> tuple[float | StiffnessTable, DeckSyrope | None]:
    """Return the original curve and the rest of ``SYROPE:file|alpha|beta`` with BA_s|BA_d."""
    text = row.cells.get("stiffness", "")
    name, *numbers = text.split(":", 1)[-1].strip('"').split("|")
    damping = [parse_number(part) for part in row.cells.get("damping", "").split("|")]
    values = [value for word in numbers if (value := parse_number(word)) is not None and value > 0.0]
    dashpots = [value for value in damping if value is not None and value >= 0.0]
    if len(numbers) != 2 or len(values) != 2 or len(damping) != 2 or len(dashpots) != 2:
        faults.add(
            row.line, f"stiffness {text!r} with damping {row.cells.get('damping', '')!r}",
            "SYROPE:file|alpha|beta with BA_s|BA_d", path="stiffness",
        )  # fmt: skip
        return math.nan, None
    try:
        said = _settings(folder / name)
        original = _table(folder / name, said["OWC"])
        form = next((word for word in FORMS if word == said["WCTYPE"].upper()), None)
        if form is None:
            raise InputError(f"WCType {said['WCTYPE']!r} of {name}", path="WCType", allowed=", ".join(FORMS))
        k1, k2 = (parse_number(said[key]) for key in ("K1", "K2"))
        if k1 is None or k2 is None:
            raise InputError(f"k1 and k2 of {name} are no numbers", path="k1", allowed="two numbers")
        law = DeckSyrope(form, k1, k2, values[0], values[1], dashpots[0], original=original)
        law_of(original, law)
    except InputError as error:
        faults.add(row.line, error.fault.message, error.fault.allowed, path="stiffness")
        return math.nan, None
    return original, law


def _settings(place: Path) -> dict[str, str]:
    if not place.is_file():
        raise InputError(f"there is no file {place.name} next to the deck", path="stiffness")
    rows = [line.split() for line in read_lines(place)]
    found = {words[1].upper(): words[0].strip("\"'") for words in rows if len(words) > 1}
    missing = [key for key in ("OWC", "WCType", "k1", "k2") if key.upper() not in found]
    if missing:
        raise InputError(f"{place.name} has no row {', '.join(missing)}", path="stiffness")
    return found


def _table(settings: Path, name: str) -> StiffnessTable:
    place = settings.parent / name
    if not place.is_file():
        raise InputError(f"there is no file {name} next to {settings.name}", path="OWC")
    rows = [[parse_number(word) for word in line.split()] for line in read_lines(place)]
    known = [row[:2] for row in rows if len(row) > 1 and None not in row[:2]]
    pairs = np.array(known, dtype=float)
    if len(pairs) < 2 or pairs[0].any() or not np.all(np.diff(pairs, axis=0) > 0.0):
        raise InputError(f"{name}: strain and tension do not rise from 0 and 0", path="OWC")
    return StiffnessTable(tuple(pairs[:, 0].tolist()), tuple(pairs[:, 1].tolist()), name)


def with_history(
    kinds: tuple[DeckLineType, ...], lines: tuple[DeckLine, ...], rows: Sequence[DeckRow], faults: Faults
) -> tuple[tuple[DeckLineType, ...], tuple[DeckLine, ...]]:
    """Return line types and lines with the curves of what each line has carried, by the rows of SYROPE IC.

    A line whose history differs from that of a new rope gets a line type of its own.
    """
    found, out = {kind.name: kind for kind in kinds}, {line.number: line for line in lines}
    for row in rows:
        highest, mean = faults.number(row, "highest", above=0.0), faults.number(row, "mean", least=0.0)
        if mean > highest:
            faults.add(row.line, f"Tmean0 of {mean:g} N", f"at most Tmax0, {highest:g} N", path="syrope ic")
        for word in row.cells.get("lines", "").split(","):
            number = parse_number(word)
            line = None if number is None else out.get(int(number))
            kind = None if line is None else found.get(line.line_type)
            if line is None or kind is None or kind.syrope is None:
                faults.add(row.line, f"line {word!r} is none of a Syrope rope", path="syrope ic")
                continue
            name, law = f"{kind.name} after {highest:g} N", kind.syrope
            try:
                assert isinstance(kind.stiffness, StiffnessTable)
                curve = working_curve(kind.stiffness, law.form, law.k1, law.k2, highest)
            except InputError as error:
                faults.add(row.line, error.fault.message, error.fault.allowed, path="syrope ic")
                continue
            found[name] = replace(kind, name=name, stiffness=curve, syrope=replace(law, highest=highest, mean=mean))
            out[line.number] = replace(line, line_type=name)
    return tuple(found.values()), tuple(out.values())
