"""Text data files of OrcaFlex (YAML): lines of a deck with their water.

Points with mass, volume or drag become 3D buoys, whose height lets them come out of the water.

Written for a peer check by those who have OrcaFlex; no OrcaFlex has read these files, and their first lines say so.
Names of objects and data are those of public text data files. Units are OrcaFlex's SI: te, kN, m, s, degrees; z is up
from still water.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np

from moyai.core.errors import InputError
from moyai.interop.moordyn_deck import DeckLine, DeckLineType, DeckPoint, MoorDynDeck

_HEAD = """%YAML 1.1
# Type: Model
# Written by moyai. Unverified: no OrcaFlex has read this file. Look at units, phases and ends before use.
---
"""
_ENDS = (
    "Connection, ConnectionX, ConnectionY, ConnectionZ, ConnectionAzimuth, ConnectionDeclination, ConnectionGamma, "
    "ConnectionReleaseStage, ConnectionzRelativeTo"
)
_SECTIONS = "LineType, Length, TargetSegmentLength"
_CURRENT = "CurrentDepth, CurrentFactor, CurrentRotation"
#: How far a current may lie off its straight lines, over its largest speed.
_STRAIGHT = 1e-3
#: Height of a buoy that is always wet [m].
_SMALL = 0.01
#: kg, N over te, kN.
THOUSAND = 1e3
#: First of the notes on every file.
UNREAD = "no OrcaFlex has read this file: look at units, phases and ends before use"


def orcaflex_text(deck: MoorDynDeck) -> tuple[str, tuple[str, ...]]:
    """Return the text data file of a deck's lines with their water, and what it leaves out.

    Free points without mass, volume and drag between two lines become borders of sections, others 3D buoys. Ends that
    something else moves are fixed where they are.

    Parameters
    ----------
    deck : MoorDynDeck

    Raises
    ------
    InputError
        For bodies and rods, stretch by a table, or a deck without a depth.
    """
    model, notes = orcaflex_model(deck, {})
    return text_of(model), notes


def orcaflex_model(
    deck: MoorDynDeck, held: Mapping[int, tuple[str, Sequence[float]]]
) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return the model of a deck's lines with their water, and what it leaves out.

    Parameters
    ----------
    deck : MoorDynDeck
    held : mapping
        Object that holds a point of the deck, and its place there [m]; other ends are fixed where they are.

    Raises
    ------
    InputError
        See :func:`orcaflex_text`.
    """
    depth = deck.depth
    if depth is None or not math.isfinite(depth):
        raise InputError("a text data file of OrcaFlex needs a water depth", path="WtrDpth", remedy="give --depth")
    if deck.bodies or deck.rods:
        raise InputError("bodies and rods are not written for OrcaFlex", path="bodies", allowed="lines and points")
    buoys = _buoys(deck)
    held = {**held, **{number: (str(buoy["Name"]), (0.0, 0.0, 0.0)) for number, buoy in buoys.items()}}
    strands = _strands(deck, set(buoys))
    used = {line.line_type for strand in strands for line in strand}
    model: dict[str, Any] = {
        "General": {"UnitsSystem": "SI"},
        "Environment": {"WaterDepth": depth, "Density": (deck.number("WtrDnsty") or 1025.0) / THOUSAND},
        "LineTypes": [line_type_data(kind) for kind in deck.line_types if kind.name in used],
        **({"3DBuoys": list(buoys.values())} if buoys else {}),
        "Lines": [_line(deck, strand, held) for strand in strands],
    }
    notes = [
        UNREAD,
        *_sea(deck, depth, model["Environment"]),
    ]
    moved = sorted(
        {f"{point.number}" for point in _ends(deck, strands) if point.kind == "coupled"} - set(map(str, held))
    )
    if deck.seafloor is not None and deck.seafloor_depth is None:
        notes.append("the bed that varies is left out: it is flat at the depth of the deck")
    if any(point.height > 0.0 for point in deck.points):
        notes.append("the wet share of a buoy grows evenly over its height, that of a sphere too")
    if moved:
        notes.append(f"points {', '.join(moved)} are fixed where they are: connect them to your vessel")
    return model, tuple(notes)


def text_of(model: dict[str, Any]) -> str:
    """Return a model as text data."""
    import yaml

    return _HEAD + yaml.safe_dump(
        _rounded(model), sort_keys=False, default_flow_style=None, width=10_000, allow_unicode=True
    )


def _rounded(value: Any) -> Any:
    """Return data whose numbers have no tail of rounding and no negative zero."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(entry) for entry in value]
    return float(f"{value:.14g}") + 0.0 if isinstance(value, float) else value


def line_type_data(kind: DeckLineType) -> dict[str, Any]:
    """Return the data of a line type.

    Raises
    ------
    InputError
        For one that stretches by a table or slowly.
    """
    if not isinstance(kind.stiffness, float | int) or kind.slow is not None:
        raise InputError(
            f"line type '{kind.name}' stretches by a table or slowly", path="line_types", allowed="one stiffness EA"
        )
    return {
        "Name": kind.name,
        "Category": "General",
        "OD": kind.diameter,
        "ID": 0.0,
        "MassPerUnitLength": kind.mass_per_length / THOUSAND,
        "EA": kind.stiffness / THOUSAND,
        "EI": kind.bending_stiffness / THOUSAND,
        "NormalDragCoefficient": kind.drag_normal,
        "AxialDragCoefficient": kind.drag_axial,
        "NormalAddedMassCoefficient": kind.added_mass_normal,
        "AxialAddedMassCoefficient": kind.added_mass_axial,
    }


def _buoys(deck: MoorDynDeck) -> dict[int, dict[str, Any]]:
    """Return the free points that are more than a border between two lines as 3D buoys, by their numbers."""
    meeting = Counter(end for line in deck.lines for end in (line.start, line.end))
    found = {}
    for point in deck.points:
        border = meeting[point.number] == 2 and not (point.mass or point.volume or point.drag_area)
        if point.kind == "free" and meeting[point.number] and not border:
            found[point.number] = {
                "Name": f"Buoy{point.number}",
                "Connection": "Free",
                "InitialPosition": list(point.position),
                "Mass": point.mass / THOUSAND,
                "Volume": point.volume,
                "Height": point.height or _SMALL,
                "DragArea": [point.drag_area] * 3,
                "Cd": [1.0] * 3,
                "Ca": [point.added_mass_coefficient] * 3,
            }
    return found


def _strands(deck: MoorDynDeck, buoys: Collection[int]) -> list[list[DeckLine]]:
    """Return the lines joined over free points that are borders alone, each from one held end to the other."""
    at: dict[int | str, list[DeckLine]] = {}
    for line in deck.lines:
        for end in (line.start, line.end):
            at.setdefault(end, []).append(line)
    free = {point.number for point in deck.points if point.kind == "free" and point.number in at} - set(buoys)
    found, done = [], set()
    for line in deck.lines:
        start = next((end for end in (line.start, line.end) if end not in free), None)
        if line.number in done or start is None:
            continue
        strand, here = [], start
        step: DeckLine | None = line
        while step is not None and step.number not in done:
            done.add(step.number)
            strand.append(step)
            here = step.end if step.start == here else step.start
            step = next((other for other in at[here] if other.number not in done), None) if here in free else None
        found.append(strand)
    return found


def _end_points(deck: MoorDynDeck, strand: list[DeckLine]) -> tuple[DeckPoint, DeckPoint]:
    first, last = strand[0], strand[-1]
    inner = {first.start, first.end} & {strand[1].start, strand[1].end} if len(strand) > 1 else {first.end}
    begin = first.end if first.start in inner else first.start
    here = begin
    for line in strand:
        here = line.end if line.start == here else line.start
    assert here in (last.start, last.end)
    return deck.point(int(begin)), deck.point(int(here))


def _ends(deck: MoorDynDeck, strands: list[list[DeckLine]]) -> list[DeckPoint]:
    return [point for strand in strands for point in _end_points(deck, strand)]


def _line(deck: MoorDynDeck, strand: list[DeckLine], held: Mapping[int, tuple[str, Sequence[float]]]) -> dict[str, Any]:
    begin, end = _end_points(deck, strand)
    first = begin.position[2] > end.position[2]
    return line_data(
        f"Line{strand[0].number}",
        [held.get(point.number, ("Fixed", point.position)) for point in (begin, end)],
        [(line.line_type, line.length, line.length / line.segments) for line in strand],
        "End A" if first else "End B",
    )


def line_data(
    name: str,
    ends: Sequence[tuple[str, Sequence[float]]],
    sections: Sequence[tuple[str, float, float]],
    top: str = "End A",
) -> dict[str, Any]:
    """Return the data of a line.

    Parameters
    ----------
    name : str
    ends : sequence
        What each end is connected to, and its place there [m].
    sections : sequence
        Line type, length and longest segment [m], from the first end.
    top : str
    """
    return {
        "Name": name,
        "TopEnd": top,
        _ENDS: [[held, *map(float, place), 0.0, 0.0, 0.0, None, None] for held, place in ends],
        _SECTIONS: [list(section) for section in sections],
    }


def _without_needless(rows: list[list[float]]) -> list[list[float]]:
    """Return rows of a table that straight lines between them bring back to a thousandth; the ends stay."""
    table = np.array(rows)
    if len(table) < 3 or not np.all(np.diff(table[:, 0]) > 0.0):
        return rows
    kept = [0, len(table) - 1]
    while True:
        off = [abs(table[:, k] - np.interp(table[:, 0], table[kept, 0], table[kept, k])) for k in (1, 2)]
        worst = np.max([off[0], off[1] / 90.0], axis=0)
        if worst.max() <= _STRAIGHT:
            return [rows[k] for k in kept]
        kept = sorted([*kept, int(np.argmax(worst))])


def _sea(deck: MoorDynDeck, depth: float, environment: dict[str, Any]) -> list[str]:
    """Add a current and one regular wave to the environment; return what is left out."""
    notes = []
    if deck.current is not None:
        velocity = np.asarray(deck.current.velocity)[:, :2]
        speed = np.hypot(velocity[:, 0], velocity[:, 1])
        top = int(np.argmax(speed))
        if speed[top] > 0.0:
            heading = math.degrees(math.atan2(velocity[top, 1], velocity[top, 0]))
            turned = np.degrees(np.arctan2(velocity[:, 1], velocity[:, 0])) - heading
            rows = [
                [-float(z), float(part / speed[top]), float(turn if part > 0.0 else 0.0)]
                for z, part, turn in zip(deck.current.z, speed, turned, strict=True)
            ]
            environment["RefCurrentSpeed"], environment["RefCurrentDirection"] = float(speed[top]), heading
            inside = sorted(row for row in rows if -1e-9 <= row[0] <= depth * (1.0 + 1e-9))
            environment[_CURRENT] = _without_needless(inside)
    if deck.current_field is not None:
        notes.append("the current that changes over place and time is left out")
    if deck.waves is not None:
        amplitude = np.hypot(deck.waves.real, deck.waves.imaginary)
        moving = np.flatnonzero(amplitude > 0.0)
        if moving.size == 1:
            only = int(moving[0])
            environment["WaveTrains"] = [
                {
                    "Name": "Wave1",
                    "WaveType": "Airy",
                    "WaveDirection": math.degrees(deck.waves.direction[only]),
                    "WaveHeight": 2.0 * float(amplitude[only]),
                    "WavePeriod": 2.0 * math.pi / deck.waves.omega[only],
                }
            ]
        elif moving.size:
            notes.append("waves of several components are left out: give the sea in OrcaFlex")
    return notes
