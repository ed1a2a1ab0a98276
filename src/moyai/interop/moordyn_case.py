"""MoorDyn decks as case files of a network, and case files of a network as decks."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from moyai.core.errors import InputError
from moyai.interop.moordyn_deck import DeckLineType, DeckPoint, MoorDynDeck
from moyai.interop.moordyn_network import line_name, point_name, to_deck, water_of
from moyai.interop.moordyn_records import StiffnessTable
from moyai.interop.textfiles import read_lines

if TYPE_CHECKING:
    from moyai.case.reader import Case

_TITLE_OF_SECTION = re.compile(r"^\s*-{3,}.*\b(LINE TYPES|LINE DICTIONARY)\b", re.IGNORECASE)
_PLAIN = re.compile(r"[A-Za-z][\w .()/+-]*")


def is_deck(path: Path) -> bool:
    """Whether a file is a MoorDyn input file: text with a section of line types, and no YAML by its name."""
    if path.suffix.lower() in (".yaml", ".yml") or not path.is_file():
        return False
    try:
        return any(_TITLE_OF_SECTION.match(line) for line in read_lines(path))
    except InputError:
        return False


def case_text(
    deck: MoorDynDeck,
    *,
    motions: Mapping[int, Path] | None = None,
    duration: float | None = None,
    output_step: float | None = None,
) -> str:
    """Return the case file of a deck.

    Parameters
    ----------
    deck : MoorDynDeck
    motions : mapping of int to Path, optional
        Files of time [s] and displacement x, y, z [m] that coupled points follow, by the ID of the point; the others
        are held still.
    duration, output_step : float, optional
        Of a run through time [s]; without motions, waves or a duration the network is only brought to rest.

    Returns
    -------
    str
        YAML; every number keeps all its digits.

    Raises
    ------
    InputError
        When the deck gives no depth, its current turns over the height, or a motion is given for a point that is not
        coupled.
    """
    if deck.bodies or deck.rods:
        raise InputError(
            f"{deck.source or 'the deck'} has bodies or rods whose parts no case file can hold",
            path="bodies" if deck.bodies else "rods",
            remedy="run the deck from Python: read_deck, to_system, find_rest, simulate_coupled",
        )
    water = water_of(deck)
    motions = motions or {}
    coupled = [point.number for point in deck.points if point.kind == "coupled"]
    for number in motions:
        if number not in coupled:
            raise InputError(
                f"point {number} is not coupled and follows no motion", path="--motion",
                allowed=", ".join(map(str, coupled)) or "no point of this deck is coupled",
            )  # fmt: skip
    lines = [
        f"# From {deck.source or 'a deck'} of MoorDyn.",
        *(f"# {note}" for note in deck.notes),
        "moyai: 1",
        f"title: {_word(deck.title or deck.source or 'Moored lines')}",
        "",
        f"site: {{water_depth: {_number(water.depth)}, density: {_number(water.density)}, "
        f"gravity: {_number(water.gravity)}}}",
        *_current(deck),
        "",
        "structure:",
        "  kind: network",
        f"  bed: {{stiffness: {_number(deck.number('kBot') or 0.0)}, damping: {_number(deck.number('cBot') or 0.0)}, "
        f"friction: {_number(deck.number('FrictionCoefficient') or 0.0)}}}",
        "  line_types:",
    ]
    used = {line.line_type for line in deck.lines}
    for kind in deck.line_types:
        lines += _line_type(kind) if kind.name in used else [f"    # {kind.name}: no line is made of it"]
    if motions:
        lines.append("  motions:")
        lines += [f"    {point_name(n)}: {{kind: table, file: {_word(str(p))}}}" for n, p in motions.items()]
    lines.append("  points:")
    lines += [_point(point, point.number in motions) for point in deck.points]
    lines.append("  lines:")
    lines += [
        f"    {line_name(line.number)}: {{start: {point_name(int(line.start))}, end: {point_name(int(line.end))}, "
        f"type: {_word(line.line_type)}, length: {_number(line.length)}, segments: {line.segments}}}"
        for line in deck.lines
    ]
    dynamic = bool(motions) or duration is not None
    lines += ["", f"analyses: [statics, modes{', dynamic' if dynamic else ''}]"]
    if dynamic:
        settings = ["start: rest_in_current" if deck.current is not None else "start: rest"]
        if duration is not None:
            settings.append(f"duration: {_number(duration)}")
        if output_step is not None:
            settings.append(f"output_step: {_number(output_step)}")
        lines += ["", f"settings: {{{', '.join(settings)}}}"]
    return "\n".join([*lines, ""])


def _number(value: float) -> str:
    number = float(value)
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def _word(text: str) -> str:
    """Return a text as YAML takes it: plain where that is safe, in quotes otherwise."""
    plain = text.strip()
    if _PLAIN.fullmatch(plain) and plain.lower() not in ("yes", "no", "true", "false", "null", "on", "off"):
        return plain
    return '"' + plain.replace("\\", "\\\\").replace('"', '\\"') + '"'


def _line_type(kind: DeckLineType) -> list[str]:
    parts = [f"diameter: {_number(kind.diameter)}", f"mass: {_number(kind.mass_per_length)}"]
    if isinstance(kind.stiffness, StiffnessTable):
        rows = zip(kind.stiffness.strain, kind.stiffness.tension, strict=True)
        parts.append(f"curve: {{table: [{', '.join(f'[{_number(e)}, {_number(t)}]' for e, t in rows)}]}}")
    else:
        parts.append(f"axial_stiffness: {_number(kind.stiffness)}")
    # a negative BA is minus the part of the critical damping of a segment
    parts.append(
        f"viscosity: {_number(kind.damping)}" if kind.damping >= 0.0 else f"damping_ratio: {_number(-kind.damping)}"
    )
    parts += [
        f"drag_normal: {_number(kind.drag_normal)}",
        # on the circumference there, on the diameter here
        f"drag_tangential: {_number(math.pi * kind.drag_axial)}",
        f"added_mass_normal: {_number(kind.added_mass_normal)}",
        f"added_mass_tangential: {_number(kind.added_mass_axial)}",
    ]
    if kind.bending_stiffness > 0.0:
        parts.append(f"bending_stiffness: {_number(kind.bending_stiffness)}")
    return [f"    {_word(kind.name)}:", "      {" + ",\n       ".join(parts) + "}"]


def _point(point: DeckPoint, moves: bool) -> str:
    x, y, z = (_number(value) for value in point.position)
    name, place = point_name(point.number), f"position: [{x}, {y}, {z}]"
    if point.kind == "fixed":
        return f"    {name}: {{kind: fixed, {place}}}"
    if point.kind == "coupled":
        return f"    {name}: {{kind: driven, {place}{f', motion: {name}' if moves else ''}}}"
    carried = {
        "mass": point.mass, "volume": point.volume, "drag_area": point.drag_area,
        "added_mass_coefficient": point.added_mass_coefficient,
    }  # fmt: skip
    words = "".join(f", {key}: {_number(value)}" for key, value in carried.items() if value > 0.0)
    return f"    {name}: {{kind: free, {place}{words}}}"


def _current(deck: MoorDynDeck) -> list[str]:
    current = deck.current
    if current is None:
        return []
    rows = [(z, math.hypot(u, v), math.atan2(v, u)) for z, (u, v) in zip(current.z, current.velocity, strict=True)]
    headings = [heading for _, speed, heading in rows if speed > 0.0]
    if not headings:
        return []
    if any(abs(math.remainder(heading - headings[0], 2.0 * math.pi)) > 1e-9 for heading in headings):
        raise InputError(
            "the current of the deck turns over the height; a case file has one direction",
            path="Currents",
            remedy="run the deck from Python: read_deck, to_network, flow_of",
        )
    shown = [(z, speed) for z, speed, _ in rows if z <= 0.0]
    if not shown or shown[-1][0] < 0.0:
        above = [(z, speed) for z, speed, _ in rows if z > 0.0]
        last = rows[-1][1]
        if above and shown:
            (z0, s0), (z1, s1) = shown[-1], above[0]
            last = s0 + (s1 - s0) * (0.0 - z0) / (z1 - z0)
        shown.append((0.0, last))
    if len(shown) < 2:
        shown.insert(0, (shown[0][0] - 1.0, shown[0][1]))
    table = ", ".join(f"[{_number(z)}, {_number(speed)}]" for z, speed in shown)
    heading = math.degrees(headings[0])
    return [f"current: {{heading_deg: {_number(heading)}, profile: {{table: [{table}]}}}}"]


def deck_of_case(case: Case, water_level: str | None = None) -> MoorDynDeck:
    """Return the deck of a network case at one water level (the first when left out).

    Raises
    ------
    InputError
        For a case of another structure, or an unknown water level.
    CaseError
        All that MoorDyn cannot express, see :func:`moyai.interop.moordyn_network.to_deck`.
    """
    from moyai.case.builder import build
    from moyai.network.assembly import assemble

    if case.kind != "network":
        raise InputError(f"a case of kind '{case.kind}' has no deck", path="structure.kind", allowed="network")
    problem = build(case)
    levels = dict(problem.environment.water_levels)
    name = water_level or next(iter(levels))
    if name not in levels:
        raise InputError(f"there is no water level '{name}'", path="--water-level", allowed=", ".join(levels))
    return to_deck(assemble(problem, levels[name]).network, title=case.title)
