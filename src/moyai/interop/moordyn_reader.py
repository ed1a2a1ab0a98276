"""Read MoorDyn input files; all errors of a file come at once, each with its line.

MoorDyn itself ignores unknown words and takes columns by their place. Here columns go by their headings;
where a heading is not known by its place, and where the place would have given other values, a note says so. Options
that are not known are noted and skipped, unless they look like one that a run needs.
"""

from __future__ import annotations

import difflib
import math
import re
import string
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

from moyai.core.errors import CaseError, InputError
from moyai.core.foreign_files import reads
from moyai.interop import moordyn_keys as keys
from moyai.interop.moordyn_bodies import (
    BODY_COLUMNS,
    ROD_COLUMNS,
    ROD_TYPE_COLUMNS,
    DeckBody,
    DeckRod,
    body_number,
    read_bodies,
    read_rod_types,
    read_rods,
    unnumbered,
)
from moyai.interop.moordyn_currents import FIELD_FILES, read_current_field
from moyai.interop.moordyn_deck import DeckLine, DeckLineType, DeckPoint, MoorDynDeck
from moyai.interop.moordyn_records import CURRENT_FILE, DeckCurrentField, DeckFailure, DeckOption
from moyai.interop.moordyn_rows import DeckRow, Faults, file_of, read_current, read_seafloor, read_stiffness
from moyai.interop.moordyn_syrope import read_syrope, with_history
from moyai.interop.moordyn_waterkin import read_waterkin
from moyai.interop.moordyn_waves import read_waves
from moyai.interop.textfiles import parse_number, read_lines

_RULE = re.compile(r"^\s*-{3,}(.*)$")
_ROUND_A_TITLE = "-" + string.whitespace


def _suggest(word: str, known: Iterable[str]) -> str:
    close = difflib.get_close_matches(word, list(known), n=1)
    return f"did you mean {close[0]!r}?" if close else ""


def _tokens(text: str) -> list[str]:
    """Return the entries of a row; a remark after # or ! is left out."""
    return re.split(r"[#!]", text, maxsplit=1)[0].split()


def _split(lines: list[str], faults: Faults) -> dict[str, tuple[int, list[tuple[int, str]]]]:
    """Return the lines of every section with their numbers; the text before the first section is left out."""
    sections: dict[str, tuple[int, list[tuple[int, str]]]] = {}
    body: list[tuple[int, str]] | None = None
    for number, text in enumerate(lines, start=1):
        rule = _RULE.match(text)
        if rule is None:
            if body is not None and text.strip():
                body.append((number, text))
            continue
        title = " ".join(rule[1].strip(_ROUND_A_TITLE).upper().split())
        title = _section_of(title)
        name = keys.SECTIONS.get(title)
        if title in keys.REFUSED_SECTIONS:
            body = []
            sections[title] = (number, body)
        elif name is not None:
            if name in sections:
                faults.add(number, f"section {title} comes a second time", remedy=f"first in line {sections[name][0]}")
            body = []
            sections[name] = (number, body)
        elif title == "" or "NEED THIS LINE" in title:
            body = None
        elif sections:
            remedy = _suggest(title, [*keys.SECTIONS, *keys.REFUSED_SECTIONS])
            faults.add(number, f"unknown section {title!r}", "" if remedy else ", ".join(keys.SECTIONS), remedy)
            body = _meant(title, number, sections)
        else:
            # rules and remarks above the first section are a heading, unless one was meant to be a section
            meant = difflib.get_close_matches(title, list(keys.SECTIONS), n=1, cutoff=0.8)
            if meant:
                faults.add(number, f"unknown section {title!r}", remedy=f"did you mean {meant[0]!r}?")
                body = _meant(title, number, sections)
    return sections


def _section_of(title: str) -> str:
    """Return the section that a title begins with, or holds as two words; the title itself where it names none."""
    known = sorted([*keys.SECTIONS, *keys.REFUSED_SECTIONS], key=len, reverse=True)
    if title in known:
        return title
    for name in known:
        if re.match(rf"{name}\b", title) or (" " in name and re.search(rf"\b{name}\b", title)):
            return name
    return title


def _meant(
    title: str, number: int, sections: dict[str, tuple[int, list[tuple[int, str]]]]
) -> list[tuple[int, str]] | None:
    """Open the section that a misspelt title means, so that one slip is reported once; ``None`` where none is meant."""
    meant = difflib.get_close_matches(title, list(keys.SECTIONS), n=1)
    name = keys.SECTIONS[meant[0]] if meant else ""
    if not name or name in sections:
        return None
    body: list[tuple[int, str]] = []
    sections[name] = (number, body)
    return body


def _is_data(text: str, names: list[str] | None) -> bool:
    """Whether a row holds the entries of a table: numbers wherever its columns hold numbers."""
    cells = _tokens(text)
    if names is None:
        return False
    fewest = len(names) - (1 if names[-1] == "outputs" else 0)
    return fewest <= len(cells) <= len(names) and all(
        parse_number(cell) is not None for name, cell in zip(names, cells) if name not in keys.WORDS
    )


def _names(
    section: str, head: tuple[int, str], columns: Mapping[str, str], faults: Faults, notes: list[str]
) -> list[str]:
    """Return the columns of a section by their headings, those with unknown headings by their place; none if faulty."""
    words = _tokens(head[1])
    names: list[str] = []
    for word in words:
        # the third angle of a body has the name of its second coordinate
        second = section == "bodies" and word.lower() == "y0" and "y" in names
        names.append("yaw" if second else columns.get(word.lower(), ""))
    if "" in names:
        odd = [word for word, name in zip(words, names) if not name]
        layout = next(
            (
                row[: len(names)]
                for row in keys.LAYOUTS[section]
                if len(names) <= len(row) and all(name in ("", place) for name, place in zip(names, row))
            ),
            None,
        )
        if layout is None:
            for word in odd:
                faults.add(
                    head[0], f"unknown column {word!r}", ", ".join(columns), _suggest(word.lower(), columns), section
                )
            faults.broken.add(section)
            return []
        names = list(layout)
        notes.append(f"line {head[0]}: columns {', '.join(odd)} of {section.upper()} are taken by their place")
    for index, name in enumerate(names):
        if name in names[:index]:
            faults.add(head[0], f"column {words[index]!r} comes a second time", path=section)
    missing = [c for c in dict.fromkeys(columns.values()) if c not in names and c not in keys.MAY_MISS.get(section, ())]
    if missing:
        faults.add(head[0], f"no column for {', '.join(m.replace('_', ' ') for m in missing)}", path=section)
        # its rows, and what refers to them, would be reported as faults that follow from this one
        faults.broken.add(section)
        return []
    return names


def _table(
    section: str,
    sections: dict[str, tuple[int, list[tuple[int, str]]]],
    columns: Mapping[str, str],
    faults: Faults,
    notes: list[str],
) -> tuple[list[str], list[DeckRow]]:
    """Return the columns and the rows of a section: names, units, then rows."""
    if section not in sections:
        if section not in ("line types", "points", "lines") or "rods" in sections or "bodies" in sections:
            return [], []
        faults.add(0, f"section {section.upper()} is missing", path=section)
        return [], []
    top, body = sections[section]
    if not body or (len(body) < 2 and not _is_data(body[0][1], None)):
        faults.add(
            top, f"section {section.upper()} is empty", "a row of names, a row of units, then rows", path=section
        )
        return [], []
    head = body[0]
    names = _names(section, head, columns, faults, notes)
    if not names:
        return [], []
    rest = body[1:]
    if rest and not rest[0][1].lstrip().startswith("("):
        number, text = rest[0]
        if _is_data(text, names):
            notes.append(f"line {number}: {section.upper()} has no row of units; MoorDyn would skip this row")
        elif any(parse_number(word) is not None for word in _tokens(text)):
            faults.add(
                number, f"the row under the names of {section.upper()} holds no units",
                "a row such as (-) (m) ..., which the format passes over", path=section,
            )  # fmt: skip
            rest = rest[1:]
        else:
            rest = rest[1:]
    else:
        rest = rest[1:]
    rows = []
    fewest = len(names) - (1 if names and names[-1] == "outputs" else 0)
    for number, text in rest:
        cells = _tokens(text)
        if not cells:
            continue
        if not fewest <= len(cells) <= len(names):
            faults.add(number, f"{len(cells)} columns", f"{len(names)}: {' '.join(_tokens(head[1]))}", path=section)
            continue
        rows.append(DeckRow(number, dict(zip(names, cells, strict=False))))
    return names, rows


def _line_types(names: list[str], rows: list[DeckRow], folder: Path, faults: Faults) -> tuple[DeckLineType, ...]:
    found: list[DeckLineType] = []
    for row in rows:
        # without lift, range and centre of its frequencies have no meaning
        if parse_number(row.cells.get("lift", "0")) != 0.0:
            faults.add(
                row.line, "vortex-induced vibration (Cl, dF, cF) is not read", "0 or no such column", path="lift"
            )
        if parse_number(row.cells.get("unused", "0")) != 0.0:
            faults.add(row.line, "the column 'tbd' has no meaning", "0", path="tbd")
        name = row.cells.get("name", "")
        if any(kind.name == name for kind in found):
            faults.add(row.line, f"two line types are named {name!r}", path="line types")
        law, slow = None, None
        if is_syrope := row.cells.get("stiffness", "").strip('"').upper().startswith("SYROPE"):
            stiffness, law = read_syrope(row, folder, faults)
        else:
            stiffness, slow = read_stiffness(row, folder, faults)
        damping = row.cells.get("damping", "0").split("|")[-1]
        if slow is None and not is_syrope and (parse_number(damping) is None or "|" in row.cells.get("damping", "")):
            words = f"damping is {row.cells.get('damping', '')!r}"
            faults.add(row.line, words, "one number: BA in N s, or minus a damping ratio")
        found.append(
            DeckLineType(
                name,
                faults.number(row, "diameter", above=0.0),
                faults.number(row, "mass_per_length", above=0.0),
                stiffness,
                parse_number(damping) or 0.0,
                faults.number(row, "bending_stiffness", least=0.0),
                faults.number(row, "drag_normal", least=0.0),
                faults.number(row, "added_mass_normal", least=0.0),
                faults.number(row, "drag_axial", least=0.0),
                faults.number(row, "added_mass_axial", least=0.0),
                row.line,
                slow,
                law,
            )
        )
    return tuple(found)


def _with_slow_damping(
    kinds: tuple[DeckLineType, ...], lines: tuple[DeckLine, ...], notes: list[str]
) -> tuple[DeckLineType, ...]:
    """Return the line types with BA_s in N s where it is minus a part of the critical damping of a segment."""
    found = []
    for kind in kinds:
        slow = kind.slow
        if slow is not None and slow.damping < 0.0:
            longest = max(
                (line.length / max(line.segments, 1) for line in lines if line.line_type == kind.name), default=0.0
            )
            damping = -slow.damping * longest * math.sqrt(slow.stiffness * kind.mass_per_length)
            notes.append(
                f"line {kind.line}: BA_s is {-slow.damping:g} of critical: {damping:.4g} N s with EA_s and the longest "
                "segment of the type"
            )
            kind = replace(kind, slow=replace(slow, damping=damping))
        found.append(kind)
    return tuple(found)


def _points(rows: list[DeckRow], bodies: tuple[DeckBody, ...], faults: Faults) -> tuple[DeckPoint, ...]:
    found: list[DeckPoint] = []
    known = [body.number for body in bodies]
    for row in rows:
        word = row.cells.get("kind", "")
        body = body_number(word)
        kind = "body" if body else keys.POINT_KINDS.get(unnumbered(word))
        if body and body not in known and "bodies" not in faults.broken:
            faults.add(
                row.line, f"the point is on body {body}, which is not there", ", ".join(map(str, known)) or "none"
            )
        if kind is None:
            hung = re.match(r"(rod|r|turbine|t)\d", word.lower())
            faults.add(
                row.line, f"type of point is {word!r}" + (": points on rods and turbines are not read" if hung else ""),
                "Fixed, Coupled (Vessel), Free, Body1 ...", _suggest(word.lower(), keys.POINT_KINDS), "points",
            )  # fmt: skip
        for axis in ("force x", "force y", "force z"):
            if parse_number(row.cells.get(axis, "0")) != 0.0:
                faults.add(row.line, f"a steady {axis} on a point is not read", "0", path="points")
        number = faults.whole(row, "number")
        if number and any(point.number == number for point in found):
            faults.add(row.line, f"two points have the ID {number}", path="points")
        place = tuple(faults.number(row, axis) for axis in "xyz")
        mass, volume, area, added = (
            faults.number(row, key, least=0.0) for key in ("mass", "volume", "drag_area", "added_mass_coefficient")
        )
        choice: Any = kind or "fixed"
        found.append(
            DeckPoint(number, choice, (place[0], place[1], place[2]), mass, volume, area, added, row.line, body)
        )
    return tuple(found)


def _lines(
    rows: list[DeckRow],
    kinds: tuple[DeckLineType, ...],
    points: tuple[DeckPoint, ...],
    rods: tuple[DeckRod, ...],
    faults: Faults,
) -> tuple[DeckLine, ...]:
    found: list[DeckLine] = []
    known = [point.number for point in points]
    for row in rows:
        number = faults.whole(row, "number")
        if number and any(line.number == number for line in found):
            faults.add(row.line, f"two lines have the ID {number}", path="lines")
        name = row.cells.get("line_type", "")
        types = [kind.name for kind in kinds]
        if name not in types and "line types" not in faults.broken:
            faults.add(row.line, f"no line type {name!r}", ", ".join(types), _suggest(name, types), "line_type")
        ends: list[int | str] = []
        for key in ("start", "end"):
            text = row.cells.get(key, "")
            on_rod = re.fullmatch(r"(?:rod|r)(\d+)([ab])", text.lower())
            if on_rod:
                ends.append(f"R{on_rod[1]}{on_rod[2].upper()}")
                there = [rod.number for rod in rods]
                if int(on_rod[1]) not in there and "rods" not in faults.broken:
                    faults.add(
                        row.line, f"{key} is on rod {on_rod[1]}, which is not there",
                        ", ".join(map(str, there)) or "none", path=key,
                    )  # fmt: skip
                continue
            end = faults.whole(row, key)
            if end and end not in known and "points" not in faults.broken:
                faults.add(row.line, f"{key} is point {end}, which is not there", ", ".join(map(str, known)), path=key)
            ends.append(end)
        if ends[0] == ends[1] != 0:
            faults.add(row.line, f"line {number} starts and ends at point {ends[0]}", "two points", path="end")
        length, segments = faults.number(row, "length", above=0.0), faults.whole(row, "segments")
        flags = row.cells.get("outputs", "-")
        found.append(DeckLine(number, name, ends[0], ends[1], length, segments, flags, row.line))
    return tuple(found)


def _failures(rows: list[DeckRow], lines: tuple[DeckLine, ...], faults: Faults) -> tuple[DeckFailure, ...]:
    """Return the rows of FAILURE; one line a row, which hangs on the point that it names."""
    found: list[DeckFailure] = []
    for row in rows:
        word = row.cells.get("point", "")
        on_rod = re.fullmatch(r"(?:rod|r)(\d+)([ab])", word.lower())
        point: int | str = f"R{on_rod[1]}{on_rod[2].upper()}" if on_rod else faults.whole(row, "point")
        numbers = [parse_number(part) for part in row.cells.get("lines", "").split(",") if part]
        if len(numbers) != 1 or numbers[0] is None:
            faults.add(
                row.line, f"lines {row.cells.get('lines', '')!r} part together", "one line a row", path="failure",
                remedy="lines that stay joined to each other are not run: give each its row where they part singly",
            )  # fmt: skip
            continue
        line = next((item for item in lines if item.number == numbers[0]), None)
        if "lines" not in faults.broken and (line is None or point not in (line.start, line.end)):
            faults.add(row.line, f"line {numbers[0]:g} is not attached to {word}", path="failure")
        time, tension = faults.number(row, "time", least=0.0), faults.number(row, "tension", least=0.0)
        if not time and not tension:
            continue  # it never parts
        found.append(DeckFailure(faults.whole(row, "number"), point, int(numbers[0]), time, tension, row.line))
    return tuple(found)


def _options(body: list[tuple[int, str]], folder: Path, faults: Faults, notes: list[str]) -> tuple[DeckOption, ...]:
    found: list[DeckOption] = []
    known = {**keys.OPTIONS_USED, **keys.OPTIONS_WITHOUT_MEANING}
    unused: list[str] = []
    skipped: list[str] = []
    for number, text in body:
        words = [word.strip("\"'") for word in _tokens(text.replace("=", " "))]
        if not words:
            continue
        if len(words) < 2:
            faults.add(number, f"option {words[0]!r} has no key", "a value, then its key", path="options")
            continue
        if words[1].lower() not in known and words[0].lower() in known:
            notes.append(f"line {number}: {words[0]} is before its value; MoorDyn would ignore it")
            words[:2] = words[1::-1]
        key = known.get(words[1].lower())
        if key is None:
            close = difflib.get_close_matches(words[1].lower(), list(keys.OPTIONS_USED), n=1, cutoff=0.75)
            if close:
                meant = f"did you mean {known[close[0]]!r}?"
                faults.add(number, f"unknown option {words[1]!r}", remedy=meant, path="options")
            else:
                skipped.append(f"{words[1]} (line {number})")
            continue
        if words[0].upper() == "DEFAULT":
            continue
        before = next((option for option in found if option.key == key), None)
        if before is not None:
            # some decks of MoorDyn's own give the density twice under two names: the last one counts
            notes.append(f"line {number}: {words[1]} replaces {key} of line {before.line}")
            found.remove(before)
        value = {"true": 1.0, "t": 1.0, "false": 0.0, "f": 0.0}.get(words[0].lower(), parse_number(words[0]))
        if key == "WtrDpth" and value is None and file_of(words[0], folder) is not None:
            # the Fortran version takes the name of a depth file here
            key = "SeafloorFile"
        if words[1].lower() in keys.OPTIONS_WITHOUT_MEANING:
            unused.append(key)
        elif key not in ("SeafloorFile", "WaterKin") and (value is None or not math.isfinite(value)):
            faults.add(number, f"{key} is {words[0]!r}, which is no number", path=key)
            continue
        found.append(DeckOption(key, words[0] if value is None else value, number))
    if skipped:
        notes.append(f"not known, and skipped: {', '.join(skipped)}")
    if unused:
        notes.append(f"kept, without meaning here: {', '.join(dict.fromkeys(unused))}")
    return tuple(found)


def _current_field(option: DeckOption, folder: Path, faults: Faults) -> DeckCurrentField | None:
    """Return the current that changes with time of the file next to the deck, once it was read without a fault."""
    form: Literal["profile", "grid"] = "profile" if option.value == 2.0 else "grid"
    name = FIELD_FILES[form]
    if not (folder / name).is_file():
        words = f"Currents is {option.value:g}, but there is no {name} next to the deck"
        faults.add(option.line, words, path="Currents")
        return None
    try:
        read_current_field(folder / name, form)
    except InputError as error:
        faults.add(option.line, error.fault.message, error.fault.allowed, path="Currents")
        return None
    return DeckCurrentField(name, form, str(folder.resolve()))


def _check_option_values(deck_options: tuple[DeckOption, ...], faults: Faults) -> None:
    positive, not_negative = ("WtrDpth", "kBot"), ("g", "WtrDnsty", "cBot", "FrictionCoefficient")
    for option in deck_options:
        value = option.value
        if not isinstance(value, float):
            continue
        if option.key in positive and value <= 0.0:
            faults.add(option.line, f"{option.key} is {value:g}", "greater than 0", path=option.key)
        if option.key in not_negative and value < 0.0:
            faults.add(option.line, f"{option.key} is {value:g}", "0 or more", path=option.key)
        if option.key == "WaveKin" and value not in keys.WAVES_READ:
            words = keys.WAVE_KINEMATICS.get(value, "unknown")
            allowed = ", ".join(f"{number:g}: {text}" for number, text in keys.WAVES_READ.items())
            faults.add(option.line, f"WaveKin {value:g} ({words}) is not read", allowed, path="WaveKin")
        if option.key == "Currents" and value not in (0.0, 1.0, 2.0, 5.0):
            words = keys.CURRENT_KINDS.get(value, "unknown")
            faults.add(
                option.line, f"Currents {value:g} ({words}) is not read",
                f"0, 1: {CURRENT_FILE}, 2: {FIELD_FILES['profile']}, 5: {FIELD_FILES['grid']}", path="Currents",
            )  # fmt: skip
        if option.key == "dtWave" and value <= 0.0:
            faults.add(option.line, f"dtWave is {value:g}", "greater than 0", path="dtWave")
        if option.key == "StatDynFricScale" and value != 1.0:
            faults.add(option.line, f"StatDynFricScale is {value:g}", "1: friction at rest as in motion")


def _check_site(deck: MoorDynDeck, faults: Faults) -> None:
    held = {end for line in deck.lines for end in (line.start, line.end)}
    for point in deck.points:
        level = deck.bed_under(point.position) if point.kind not in ("fixed", "body") else None
        if level is not None and point.position[2] < level - 0.02 * abs(level):
            faults.add(
                point.line, f"point {point.number} at z = {point.position[2]:g} m is under the bed",
                f"{level:g} or more", path="points",
            )  # fmt: skip
        if point.number not in held and point.kind == "free" and "lines" not in faults.broken:
            faults.add(point.line, f"free point {point.number} has no line", path="points")


@reads("a deck of MoorDyn", named="deck")
def read_deck(path: str | Path) -> MoorDynDeck:
    """Read a MoorDyn input file, version 1 or 2.

    Parameters
    ----------
    path : path
        File; stiffness tables, profiles of current and grids of depths are looked for next to it.

    Returns
    -------
    MoorDynDeck
        Its ``notes`` hold what a user should know and is no error.

    Raises
    ------
    InputError
        When the file is absent or empty.
    CaseError
        All errors at once, each with its line: missing and unknown sections, columns, options; failures and other
        parts of the format that have no counterpart here; numbers out of range; points and line types that
        are not there.
    """
    place = Path(path)
    lines = read_lines(place)
    faults, notes = Faults(place.name), list[str]()
    sections = _split(lines, faults)
    for title, why in keys.REFUSED_SECTIONS.items():
        if why and title in sections and len(sections[title][1]) > 2:
            top, body = sections[title]
            faults.add(top, f"section {title} with {len(body) - 2} row(s): {why}", path=title.lower())
    names, kind_rows = _table("line types", sections, keys.LINE_TYPE_COLUMNS, faults, notes)
    kinds = _line_types(names, kind_rows, place.parent, faults)
    if names and tuple(names[: len(keys.LINE_TYPE_ORDER)]) != keys.LINE_TYPE_ORDER:
        notes.append(
            f"line {kind_rows[0].line - 2 if kind_rows else 0}: the columns of LINE TYPES are in another order than "
            "that of MoorDyn v2; they are read by their headings"
        )
    rod_types = read_rod_types(_table("rod types", sections, ROD_TYPE_COLUMNS, faults, notes)[1], faults)
    bodies = read_bodies(_table("bodies", sections, BODY_COLUMNS, faults, notes)[1], faults)
    rods = read_rods(_table("rods", sections, ROD_COLUMNS, faults, notes)[1], rod_types, bodies, faults, notes)
    points = _points(_table("points", sections, keys.POINT_COLUMNS, faults, notes)[1], bodies, faults)
    rows = _lines(_table("lines", sections, keys.LINE_COLUMNS, faults, notes)[1], kinds, points, rods, faults)
    kinds = _with_slow_damping(kinds, rows, notes)
    histories = _table("syrope ic", sections, keys.SYROPE_COLUMNS, faults, notes)[1]
    kinds, rows = with_history(kinds, rows, histories, faults)
    used = {line.line_type for line in rows}
    notes += [
        f"line type {kind.name}: runs begin at rest after {kind.syrope.highest:g} N, whatever Tmean0 is"
        for kind in kinds
        if kind.syrope is not None and kind.name in used
    ]
    failures = _failures(_table("failure", sections, keys.FAILURE_COLUMNS, faults, notes)[1], rows, faults)
    options = _options(sections.get("options", (0, []))[1], place.parent, faults, notes)
    _check_option_values(options, faults)
    current, field, seafloor, waves = None, None, None, None
    steps = [option.value for option in options if option.key == "dtWave" and isinstance(option.value, float)]
    for option in options:
        if option.key == "WaveKin" and option.value in (2.0, 3.0, 7.0):
            step = steps[-1] if steps and steps[-1] > 0.0 else None
            waves = read_waves(option, step, place.parent, faults, notes)
        if option.key == "WaveKin" and option.value == 1.0:
            notes.append(f"line {option.line}: WaveKin 1: the waves come from the program that runs MoorDyn; none here")
        if option.key == "Currents" and option.value == 1.0:
            current = read_current(option, place.parent, faults)
        if option.key == "Currents" and option.value in (2.0, 5.0):
            field = _current_field(option, place.parent, faults)
        if option.key == "WaterKin":
            current, waves = read_waterkin(option, place.parent, faults, notes)
        if option.key == "SeafloorFile":
            seafloor = read_seafloor(option, place.parent, faults)
    outputs = [word for _, text in sections.get("outputs", (0, []))[1] for word in text.replace(",", " ").split()]
    outputs = outputs[: outputs.index("END")] if "END" in outputs else outputs
    title = lines[1].strip() if len(lines) > 1 and not _RULE.match(lines[1]) else ""
    deck = MoorDynDeck(
        kinds, points, rows, options, tuple(outputs), current, seafloor, rod_types, bodies, rods, title, place.name,
        tuple(notes), failures, field, waves,
    )  # fmt: skip
    _check_site(deck, faults)
    if faults.found:
        raise CaseError(sorted(faults.found, key=lambda fault: (fault.file != place.name, fault.line)))
    return deck
