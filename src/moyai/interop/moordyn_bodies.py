"""Bodies and rods of MoorDyn input files: frozen records, their rows read and written."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Literal

from moyai.core.options import checks_words
from moyai.interop.moordyn_rows import DeckRow, Faults
from moyai.interop.textfiles import parse_number

Triple = tuple[float, float, float]
BodyKind = Literal["fixed", "coupled", "coupled pinned", "free"]
RodKind = Literal["fixed", "coupled", "free", "pinned", "coupled pinned", "body", "body pinned"]

BODY_KINDS: dict[str, BodyKind] = {
    "fixed": "fixed", "fix": "fixed", "anchor": "fixed",
    "coupled": "coupled", "vessel": "coupled", "ves": "coupled", "cpld": "coupled",
    "coupledpinned": "coupled pinned", "cpldpin": "coupled pinned", "vesselpinned": "coupled pinned",
    "vespin": "coupled pinned",
    "free": "free",
}  # fmt: skip
ROD_KINDS: dict[str, RodKind] = {
    "fixed": "fixed", "fix": "fixed", "anchor": "fixed",
    "coupled": "coupled", "vessel": "coupled", "ves": "coupled", "cpld": "coupled",
    "coupledpinned": "coupled pinned", "cpldpin": "coupled pinned", "vesselpinned": "coupled pinned",
    "vespin": "coupled pinned", "free": "free",
    "pinned": "pinned", "pin": "pinned", "connect": "free", "con": "free",
}  # fmt: skip
_WORDS = {
    "fixed": "Fixed", "coupled": "Coupled", "free": "Free", "pinned": "Pinned", "coupled pinned": "CoupledPinned",
}  # fmt: skip

ROD_TYPE_COLUMNS = {
    "typename": "name", "rodtype": "name", "name": "name",
    "diam": "diameter", "diameter": "diameter",
    "mass/m": "mass_per_length", "massden": "mass_per_length",
    "cd": "drag_normal", "ca": "added_mass_normal", "cdend": "drag_end", "caend": "added_mass_end",
}  # fmt: skip
BODY_COLUMNS = {
    "id": "number", "attachment": "kind", "type": "kind",
    "x0": "x", "y0": "y", "z0": "z", "r0": "roll", "p0": "pitch", "yaw": "yaw",
    "mass": "mass", "cg*": "centre", "cg": "centre", "i*": "inertia", "i": "inertia", "volume": "volume",
    "cda*": "drag_area", "cda": "drag_area", "ca*": "added_mass", "ca": "added_mass",
}  # fmt: skip
ROD_COLUMNS = {
    "id": "number", "rodtype": "rod_type", "type": "rod_type", "attachment": "kind",
    "xa": "xa", "ya": "ya", "za": "za", "xb": "xb", "yb": "yb", "zb": "zb",
    "numsegs": "segments", "rodoutputs": "outputs", "outputs": "outputs",
}  # fmt: skip


@dataclass(frozen=True)
class DeckRodType:
    """A row of ROD TYPES."""

    name: str
    #: [m].
    diameter: float
    #: [kg/m].
    mass_per_length: float
    #: Drag coefficient across the rod, on the diameter [-].
    drag_normal: float
    #: Added-mass coefficient across the rod, on the volume [-].
    added_mass_normal: float
    #: Drag coefficient of each end along the rod, on the face [-].
    drag_end: float
    #: Added-mass coefficient of each end along the rod, on half a sphere [-].
    added_mass_end: float
    #: Line of the file.
    line: int = field(default=0, compare=False)


@checks_words
@dataclass(frozen=True)
class DeckBody:
    """A row of BODIES."""

    number: int
    #: One of "fixed", "coupled", "coupled pinned", "free".
    kind: BodyKind
    #: Of its axes [m].
    position: Triple
    #: Turns about its own x, then y, then z [deg].
    angles: Triple
    #: Without rods and points [kg].
    mass: float
    #: Centre of gravity in body axes [m].
    centre: Triple
    #: About it [kg m2].
    inertia: Triple
    #: [m3].
    volume: float
    #: Along and about the axes [m2, m5].
    drag_area: tuple[float, ...]
    #: On the volume [-].
    added_mass: Triple
    #: Line of the file.
    line: int = field(default=0, compare=False)


@checks_words
@dataclass(frozen=True)
class DeckRod:
    """A row of RODS."""

    number: int
    rod_type: str
    #: ``fixed``, ``coupled``, ``free``, ``pinned``, ``coupled pinned`` (at end A), ``body`` (part of one).
    kind: RodKind
    #: End A [m]; in body axes for part of a body.
    start: Triple
    #: End B [m]; in body axes for part of a body.
    end: Triple
    #: 0 for a rod of no length, which joins lines.
    segments: int
    #: The body it is part of, 0 for none.
    body: int = 0
    outputs: str = "-"
    #: Line of the file.
    line: int = field(default=0, compare=False)


def _several(
    row: DeckRow, key: str, sizes: tuple[int, ...], faults: Faults, *, least: float | None = None
) -> list[float]:
    """Return the numbers of an entry that may hold several, parted by |."""
    text = row.cells.get(key, "0")
    values = [parse_number(part) for part in text.split("|")]
    found = [value for value in values if value is not None]
    label = key.replace("_", " ")
    if len(found) != len(values) or len(found) not in sizes:
        faults.add(row.line, f"{label} is {text!r}", f"{' or '.join(map(str, sizes))} numbers parted by |", path=key)
        return [0.0]
    if least is not None and min(found) < least:
        faults.add(row.line, f"{label} is {text!r}", f"{least:g} or more", path=key)
    return found


def _triple(values: list[float]) -> Triple:
    return (values[0], values[0], values[0]) if len(values) < 3 else (values[0], values[1], values[2])


def body_number(word: str) -> int:
    """Return the body that a word such as ``Body2`` names, 0 for another word."""
    found = re.fullmatch(r"(?:body|bod|b)(\d+)", word.lower())
    return int(found[1]) if found else 0


def unnumbered(word: str) -> str:
    """Return a word in lower case without a number at its end: OpenFAST and its kin write Vessel1, Coupled1."""
    return re.sub(r"(?<=[a-z])\d+$", "", word.lower())


def read_rod_types(rows: list[DeckRow], faults: Faults) -> tuple[DeckRodType, ...]:
    """Return the rows of ROD TYPES."""
    found: list[DeckRodType] = []
    for row in rows:
        name = row.cells.get("name", "")
        if any(kind.name == name for kind in found):
            faults.add(row.line, f"two rod types are named {name!r}", path="rod types")
        found.append(
            DeckRodType(
                name,
                faults.number(row, "diameter", above=0.0),
                faults.number(row, "mass_per_length", least=0.0),
                faults.number(row, "drag_normal", least=0.0),
                faults.number(row, "added_mass_normal", least=0.0),
                faults.number(row, "drag_end", least=0.0),
                faults.number(row, "added_mass_end", least=0.0),
                row.line,
            )
        )
    return tuple(found)


def read_bodies(rows: list[DeckRow], faults: Faults) -> tuple[DeckBody, ...]:
    """Return the rows of BODIES."""
    found: list[DeckBody] = []
    for row in rows:
        number = faults.whole(row, "number")
        if number and any(body.number == number for body in found):
            faults.add(row.line, f"two bodies have the ID {number}", path="bodies")
        word = row.cells.get("kind", "")
        kind = BODY_KINDS.get(unnumbered(word))
        if kind is None:
            faults.add(row.line, f"attachment of body is {word!r}", "Fixed, Coupled, CoupledPinned, Free", path="kind")
        x, y, z = (faults.number(row, key) for key in "xyz")
        roll, pitch, yaw = (faults.number(row, key) for key in ("roll", "pitch", "yaw"))
        centre = _several(row, "centre", (1, 3), faults)
        areas = _several(row, "drag_area", (1, 2, 3, 6), faults, least=0.0)
        six = {1: areas * 6, 2: areas[:1] * 3 + areas[1:] * 3, 3: areas * 2}.get(len(areas), areas)
        found.append(
            DeckBody(
                number, kind or "fixed", (x, y, z), (roll, pitch, yaw), faults.number(row, "mass", least=0.0),
                (0.0, 0.0, centre[0]) if len(centre) == 1 else _triple(centre),
                _triple(_several(row, "inertia", (1, 3), faults, least=0.0)), faults.number(row, "volume", least=0.0),
                tuple(six), _triple(_several(row, "added_mass", (1, 3), faults, least=0.0)), row.line,
            )
        )  # fmt: skip
    return tuple(found)


def read_rods(
    rows: list[DeckRow], kinds: tuple[DeckRodType, ...], bodies: tuple[DeckBody, ...], faults: Faults, notes: list[str]
) -> tuple[DeckRod, ...]:
    """Return the rows of RODS."""
    found: list[DeckRod] = []
    names, known = [kind.name for kind in kinds], [body.number for body in bodies]
    for row in rows:
        number = faults.whole(row, "number")
        if number and any(rod.number == number for rod in found):
            faults.add(row.line, f"two rods have the ID {number}", path="rods")
        name = row.cells.get("rod_type", "")
        if name not in names and "rod types" not in faults.broken:
            faults.add(row.line, f"no rod type {name!r}", ", ".join(names) or "none", path="rod_type")
        word = row.cells.get("kind", "")
        pinned = re.fullmatch(r"((?:body|bod|b)\d+)(?:pinned|pin)", word.lower())
        body = body_number(pinned[1] if pinned else word)
        kind = ("body pinned" if pinned else "body") if body else ROD_KINDS.get(unnumbered(word))
        if kind is None:
            faults.add(
                row.line, f"attachment of rod is {word!r}",
                "Fixed, Coupled, CoupledPinned, Pinned, Free, Body1 ..., Body1Pinned ...", path="kind",
            )  # fmt: skip
        elif body and body not in known and "bodies" not in faults.broken:
            faults.add(
                row.line, f"rod {number} is on body {body}, which is not there", ", ".join(map(str, known)) or "none"
            )
        xa, ya, za, xb, yb, zb = (faults.number(row, key) for key in ("xa", "ya", "za", "xb", "yb", "zb"))
        segments = parse_number(row.cells.get("segments", ""))
        if segments is None or segments != int(segments) or segments < 0.0:
            faults.add(row.line, f"segments is {row.cells.get('segments')!r}", "a whole number, 0 or more", path="rods")
            segments = 0.0
        if (xa, ya, za) == (xb, yb, zb) and segments:
            faults.add(
                row.line, f"rod {number} has {segments:g} segments and no length", "0 segments for a rod of no length",
                path="rods",
            )  # fmt: skip
        if (xa, ya, za) != (xb, yb, zb) and not segments:
            # the two ends of a clamp say where it points to
            notes.append(f"line {row.line}: rod {number} has 0 segments: it is at its end A and has no length")
            xb, yb, zb = xa, ya, za
        choice: RodKind = kind or "fixed"
        found.append(
            DeckRod(
                number, name, choice, (xa, ya, za), (xb, yb, zb), int(segments), body, row.cells.get("outputs", "-"),
                row.line,
            )
        )  # fmt: skip
    return tuple(found)


def attachment_word(kind: str, body: int) -> str:
    """Return the word of a deck for what holds a rod or a point."""
    if kind.startswith("body"):
        return f"Body{body}" + ("Pinned" if kind.endswith("pinned") else "")
    return _WORDS[kind]
