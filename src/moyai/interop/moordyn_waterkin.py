"""The file of waves and current of the Fortran MoorDyn (option WaterKin)."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from moyai.core.errors import Fault
from moyai.interop.moordyn_records import DeckCurrent, DeckOption, DeckWaves
from moyai.interop.moordyn_rows import Faults, file_of
from moyai.interop.moordyn_waves import read_elevation
from moyai.interop.textfiles import parse_number, read_lines


def read_waterkin(
    option: DeckOption, folder: Path, faults: Faults, notes: list[str]
) -> tuple[DeckCurrent | None, DeckWaves | None]:
    """Return the steady current and the waves of the file that WaterKin names.

    WaveKinMod 1 is a record of the elevation at the origin (its grid is not needed: every node has the sum of the
    waves); CurrentMod 1 is a table of depth, positive downwards, and two velocities.

    Parameters
    ----------
    option : DeckOption
    folder : Path
        Of the deck.
    faults : Faults
    notes : list of str
        What a user should know and is no error.
    """
    name = str(option.value)
    if name in ("", "0.0"):
        return None, None
    place = file_of(name, folder)
    if place is None:
        what = (
            "the waves of SeaState in OpenFAST are not read" if name.upper() == "SEASTATE" else "no file of that name"
        )
        faults.add(option.line, f"WaterKin is {name!r}: {what}", "a file next to the deck", path="WaterKin")
        return None, None
    lines = read_lines(place)
    said: dict[str, tuple[int, str]] = {}
    for number, text in enumerate(lines, start=1):
        words = text.split()
        if len(words) > 1:
            said.setdefault(words[1].lower(), (number, words[0].strip("\"'")))

    def choice(key: str, unread: str) -> bool:
        """Return whether a part of the file is used: 1 and not 0."""
        line, word = said.get(key.lower(), (0, "0"))
        value = parse_number(word)
        if value not in (0.0, 1.0):
            faults.found.append(Fault(f"{key} is {word}: {unread}", "WaterKin", "0 or 1", "", place.name, line, 1))
        return value == 1.0

    current = _current(place, lines, faults) if choice("CurrentMod", "currents of SeaState are not read") else None
    if not choice("WaveKinMod", "waves of SeaState are not read"):
        return current, None
    record = file_of(said.get("wavekinfile", (0, ""))[1] or "?", folder)
    step = parse_number(said.get("dtwave", (0, ""))[1])
    heading = parse_number(said.get("wavedir", (0, "0"))[1])
    if record is None or heading is None:
        what = "there is no file WaveKinFile next to the deck" if record is None else "WaveDir is no number"
        faults.found.append(Fault(what, "WaterKin", "", "", place.name, said.get("wavekinfile", (0, ""))[0], 1))
        return current, None
    waves = read_elevation(record, step if step and step > 0.0 else None, faults, notes)
    if waves is None:
        return current, None
    direction = (math.radians(heading),) * len(waves.omega)
    return current, replace(waves, direction=direction, file=record.relative_to(folder).as_posix())


def _current(place: Path, lines: list[str], faults: Faults) -> DeckCurrent | None:
    first = next((n for n, text in enumerate(lines) if text.split()[:1] == ["z-depth"]), len(lines))
    rows: list[tuple[float, float, float]] = []
    for number, text in enumerate(lines[first + 2 :], start=first + 3):
        words = text.split()
        if not words or words[0].startswith("--"):
            break
        found = [value for word in words[:3] if (value := parse_number(word)) is not None]
        if len(found) != 3 or (rows and found[0] <= rows[-1][0]):
            faults.found.append(
                Fault("a row is not a depth below the one before and two velocities", "WaterKin", "", "", place.name,
                      number, 1)
            )  # fmt: skip
            return None
        rows.append((found[0], found[1], found[2]))
    if not rows:
        faults.found.append(Fault("CurrentMod is 1, but there is no row of current", "WaterKin", "", "", place.name))
        return None
    return DeckCurrent(tuple(-z for z, *_ in reversed(rows)), tuple((u, v) for _, u, v in reversed(rows)))
