"""Rows of MoorDyn decks, what is wrong with them, and the small files that stand next to a deck."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

from moyai.core.errors import Fault, InputError
from moyai.interop.moordyn_records import (
    CURRENT_FILE,
    DeckCurrent,
    DeckOption,
    DeckSeafloor,
    DeckSlowStretch,
    StiffnessTable,
)
from moyai.interop.textfiles import parse_number, read_lines


@dataclass(frozen=True)
class DeckRow:
    """Entries of a row of a deck by column, and its line."""

    #: Line of the file.
    line: int
    #: Entries by the names of :mod:`moyai.interop.moordyn_keys`.
    cells: Mapping[str, str]


class Faults:
    """Collects what is wrong, so that all of it is reported at once; ``broken`` sections hold no rows to refer to."""

    def __init__(self, file: str) -> None:
        self.file, self.found = file, list[Fault]()
        self.broken = set[str]()

    def add(self, line: int, message: str, allowed: str = "", remedy: str = "", path: str = "") -> None:
        """Note a fault of a line."""
        self.found.append(Fault(message, path, allowed, remedy, self.file, line, 1 if line else 0))

    def number(self, row: DeckRow, key: str, *, least: float = -math.inf, above: float = -math.inf) -> float:
        """Return an entry as a number; NaN with a fault when it is none or out of range."""
        text = row.cells.get(key, "0")
        value = parse_number(text)
        label = key.replace("_", " ")
        if value is None or not math.isfinite(value):
            self.add(row.line, f"{label} is {text!r}, which is no number", path=key)
            return math.nan
        if value < least or value <= above:
            allowed = f"{least:g} or more" if math.isfinite(least) else f"greater than {above:g}"
            self.add(row.line, f"{label} is {value:g}", allowed, path=key)
            return math.nan
        return value

    def whole(self, row: DeckRow, key: str) -> int:
        """Return an entry as a whole number above 0; 0 with a fault when it is none."""
        value = parse_number(row.cells.get(key, ""))
        if value is None or value != int(value) or value < 1.0:
            self.add(row.line, f"{key} is {row.cells.get(key, '')!r}", "a whole number, 1 or more", path=key)
            return 0
        return int(value)


def read_stiffness(row: DeckRow, folder: Path, faults: Faults) -> tuple[float | StiffnessTable, DeckSlowStretch | None]:
    """Return EA [N] of a row or the table of its file, and the slow stretch of a viscoelastic rope."""
    text = row.cells.get("stiffness", "")
    if parse_number(text) is not None:
        return faults.number(row, "stiffness", above=0.0), None
    if "|" in text:
        return _viscoelastic(row, text, faults)
    return _stiffness_table(row, text, folder, faults), None


def _viscoelastic(row: DeckRow, text: str, faults: Faults) -> tuple[float, DeckSlowStretch | None]:
    """Return the dynamic stiffness and the rest of EA_s|EA_d or EA_s|EA_Dc|EA_D_Lm with BA_s|BA_d."""
    stiffness = [parse_number(part) for part in text.split("|")]
    damping = [parse_number(part) for part in row.cells.get("damping", "").split("|")]
    known = [value for value in (*stiffness, *damping) if value is not None]
    # the first of the dashpots may be minus a part of the critical damping of a segment
    numbers = [value for n, value in enumerate(known) if value > 0.0 or (n == len(stiffness) and value < 0.0)]
    if len(stiffness) not in (2, 3) or len(damping) != 2 or len(numbers) != len(stiffness) + len(damping):
        faults.add(
            row.line, f"stiffness {text!r} with damping {row.cells.get('damping', '')!r}",
            "EA_s|EA_d or EA_s|EA_Dc|EA_D_Lm with BA_s|BA_d, all greater than 0 but -zeta in place of BA_s",
            path="stiffness",
        )  # fmt: skip
        return math.nan, None
    if numbers[1] <= numbers[0]:
        faults.add(row.line, f"stiffness {text!r}", "a dynamic stiffness above the static one", path="stiffness")
        return math.nan, None
    slow = DeckSlowStretch(numbers[0], numbers[len(stiffness)], numbers[2] if len(stiffness) == 3 else 0.0)
    return numbers[1], slow


def _stiffness_table(row: DeckRow, text: str, folder: Path, faults: Faults) -> float | StiffnessTable:
    place = folder / text
    if not place.is_file():
        faults.add(row.line, f"stiffness is {text!r}, neither a number nor a file next to the deck", path="stiffness")
        return math.nan
    strain: list[float] = []
    tension: list[float] = []
    for number, line in enumerate(read_lines(place), start=1):
        values = [parse_number(token) for token in line.replace(",", " ").split()]
        if not values or (not strain and values[0] is None):
            continue
        if len(values) != 2 or values[0] is None or values[1] is None:
            faults.found.append(Fault("a row is not strain and tension", "stiffness", "", "", place.name, number, 1))
            return math.nan
        strain.append(values[0])
        tension.append(values[1])
    rising = all(b > a for series in (strain, tension) for a, b in pairwise(series))
    if len(strain) < 2 or strain[0] != 0.0 or tension[0] != 0.0 or not rising:
        faults.found.append(
            Fault(
                "strain and tension do not rise from 0",
                "stiffness",
                "two rows or more, the first 0 0",
                "",
                place.name,
                0,
                0,
            )
        )
        return math.nan
    return StiffnessTable(tuple(strain), tuple(tension), text)


def read_current(option: DeckOption, folder: Path, faults: Faults) -> DeckCurrent | None:
    """Return the steady current of the file next to the deck."""
    place = folder / CURRENT_FILE
    if not place.is_file():
        faults.add(option.line, f"Currents is 1, but there is no {CURRENT_FILE} next to the deck", path="Currents")
        return None
    rows: list[list[float]] = []
    for number, text in enumerate(read_lines(place)[3:], start=4):
        values = [parse_number(token) for token in text.replace(",", " ").split()]
        if not values:
            continue
        row = [value for value in values if value is not None]
        fault = ""
        if len(row) != len(values) or len(row) != 4:
            fault = "a row is not z and three velocities"
        elif rows and row[0] <= rows[-1][0]:
            fault = f"z = {row[0]:g} m does not rise"
        elif row[3] != 0.0:
            fault = f"a vertical current of {row[3]:g} m/s is not read"
        if fault:
            faults.found.append(Fault(fault, "Currents", "", "", place.name, number, 1))
            return None
        rows.append(row)
    if not rows:
        faults.add(option.line, f"{CURRENT_FILE} holds no rows", path="Currents")
        return None
    return DeckCurrent(tuple(r[0] for r in rows), tuple((r[1], r[2]) for r in rows), str(place.resolve()))


def file_of(name: str, folder: Path) -> Path | None:
    """Return a file that a deck names from wherever its program was started: next to the deck, or below it."""
    parts = Path(name.strip("\"'").replace("\\", "/")).parts
    tries = (folder.joinpath(*parts[first:]) for first in range(len(parts)))
    return next((place for place in tries if place.is_file()), None)


def read_seafloor(option: DeckOption, folder: Path, faults: Faults) -> DeckSeafloor | None:
    """Return the bed of the grid file of a deck."""
    place = file_of(str(option.value), folder)
    if place is None:
        faults.add(option.line, f"there is no file {option.value!s} next to the deck", path="SeafloorFile")
        return None
    try:
        return read_seafloor_file(place)
    except InputError as error:
        fault = error.fault
        faults.found.append(Fault(fault.message, "SeafloorFile", fault.allowed, "", place.name, 1, 1))
        return None


def _depth_table(place: Path, lines: list[str]) -> list[tuple[float, float, float]]:
    """Return x, y, z of the depths of the Fortran MoorDyn."""
    table = [[parse_number(word) for word in text.split()] for text in lines[3:] if text.split()]
    along, rows = table[0] if table else [], []
    for number, row in enumerate(table[1:], start=5):
        if len(row) != len(along) + 1 or any(value is None for value in (*along, *row)):
            raise InputError(f"line {number} of {place.name}: a row is not y and a depth at every x", path="file")
        rows += [(float(x or 0.0), float(row[0] or 0.0), -float(d or 0.0)) for x, d in zip(along, row[1:])]
    return rows


def read_seafloor_file(place: Path) -> DeckSeafloor:
    """Return the heights of a grid file.

    Numbers of lines, lines along x and along y, then rows x, y, z; or, as the Fortran MoorDyn has it, a title, nGridX
    and nGridY with their numbers, a row of x, and rows of y and the depths at every x.

    Raises
    ------
    InputError
        For a row of other than three numbers, or a crossing of the grid lines that is left out.
    """
    rows: list[tuple[float, float, float]] = []
    lines = read_lines(place)
    if len(lines) > 1 and lines[1].split()[:1] == ["nGridX"]:
        rows, lines = _depth_table(place, lines), []
    for number, text in enumerate(lines[3:], start=4):
        values = [parse_number(token) for token in text.split()]
        if not values:
            continue
        known = [value for value in values if value is not None]
        if len(values) != 3 or len(known) != 3:
            raise InputError(f"line {number} of {place.name}: a row is not x, y, z", path="file")
        rows.append((known[0], known[1], known[2]))
    if not rows:
        raise InputError(f"{place.name} holds no rows", path="file")
    found = DeckSeafloor(tuple(rows), place.name, str(place.parent.absolute()))
    try:
        _ = found.ground
    except InputError as error:
        raise InputError(f"{place.name}: {error.fault.message}", path="file", allowed=error.fault.allowed) from None
    return found
