"""MoorDyn decks as case files of a network."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

import numpy as np

from moyai.core.errors import CaseError, Fault, InputError
from moyai.coupled.assembly import RodPart, VolumePart
from moyai.interop.moordyn_deck import DeckLineType, DeckPoint, MoorDynDeck
from moyai.interop.moordyn_keys import SECTIONS
from moyai.interop.moordyn_network import line_name, point_name, water_of
from moyai.interop.moordyn_records import DeckFailure, StiffnessTable
from moyai.interop.moordyn_syrope import law_of
from moyai.interop.moordyn_system import BodyOfDeck, bodies_of, end_name, rod_knots
from moyai.interop.moordyn_waves import amplitude_and_phase
from moyai.interop.textfiles import read_lines
from moyai.mooring.rotations import roll_pitch_yaw

_RULE = re.compile(r"^\s*-{3,}\s*([A-Za-z][A-Za-z ]*?)\s*-{3,}")
_PLAIN = re.compile(r"[A-Za-z][\w .()/+-]*")


def is_deck(path: Path) -> bool:
    """Whether a file is a MoorDyn input file: text with a section of one, if misspelt, and no YAML by its name."""
    if path.suffix.lower() in (".yaml", ".yml") or not path.is_file():
        return False
    try:
        titles = [" ".join(found[1].upper().split()) for line in read_lines(path) if (found := _RULE.match(line))]
    except InputError:
        return False
    return any(difflib.get_close_matches(title, SECTIONS, n=1, cutoff=0.8) for title in titles)


def case_text(
    deck: MoorDynDeck,
    *,
    motions: Mapping[int | str, Path] | None = None,
    duration: float | None = None,
    output_step: float | None = None,
    folder: Path | None = None,
) -> str:
    """Return the case file of a deck.

    Parameters
    ----------
    deck : MoorDynDeck
    motions : mapping of int or str to Path, optional
        Files of time [s] and displacement x, y, z [m] that coupled points follow, by the ID of the point, and coupled
        bodies, rods and rods of no length, by names such as ``body 1`` (they keep their angles); the others are held
        still.
    folder : Path, optional
        Of the deck, where a record of the elevation stands.
    duration, output_step : float, optional
        Of a run through time [s]; without motions, waves or a duration the network is only brought to rest.

    Returns
    -------
    str
        YAML; every number keeps all its digits.

    Raises
    ------
    InputError
        When the deck gives no depth, its current turns over the height, or a motion is given for what is not coupled.
    CaseError
        For points under the bed, and for bodies and rods that are not run, see
        :func:`moyai.interop.moordyn_system.bodies_of`.
    """
    water = water_of(deck)
    bodies, said = bodies_of(deck)
    _check_bed(deck, bodies)
    moved = _moved(deck, bodies, motions or {})
    dynamic = bool(moved) or duration is not None or deck.waves is not None or deck.current_field is not None
    dynamic = dynamic or any(item.time for item in deck.failures)
    current = _current(deck, dynamic)
    lines = [
        f"# From {deck.source or 'a deck'} of MoorDyn.",
        *(f"# {note}" for note in (*deck.notes, *said)),
        "moyai: 1",
        f"title: {_word(deck.title or deck.source or 'Moored lines')}",
        "plausibility: warn",
        "",
        f"site: {{water_depth: {_number(water.depth)}, density: {_number(water.density)}, "
        f"gravity: {_number(water.gravity)}}}",
        *_waves(deck, folder),
        *current,
        *_current_field(deck),
        "",
        "structure:",
        "  kind: network",
        _bed(deck),
        "  line_types:",
    ]
    used = {line.line_type for line in deck.lines}
    for kind in deck.line_types:
        lines += _line_type(kind) if kind.name in used else [f"    # {kind.name}: no line is made of it"]
    if not used:
        lines.remove("  line_types:")
    if moved:
        lines.append("  motions:")
        lines += [f"    {name}: {{kind: table, file: {_word(str(path))}}}" for name, path in moved.items()]
    lines += _points(deck, bodies, moved)
    lines += _bodies(bodies)
    if deck.lines:
        lines.append("  lines:")
    lines += [
        f"    {line_name(line.number)}: {{start: {end_name(deck, line.start)}, end: {end_name(deck, line.end)}, "
        f"type: {_word(line.line_type)}, length: {_number(line.length)}, segments: {line.segments}}}"
        for line in deck.lines
    ]
    if deck.failures:
        lines.append("  failures:")
    lines += [f"    - {_failure(deck, item)}" for item in deck.failures]
    # what moves in a deck without a search for rest starts where the deck has it
    as_built = any(body.moves for body in bodies) and deck.number("TmaxIC") == 0.0
    analyses = [*([] if as_built and dynamic else ["statics"]), *(["modes"] if deck.lines and not bodies else [])]
    lines += ["", f"analyses: [{', '.join([*analyses, *(['dynamic'] if dynamic else [])])}]"]
    if dynamic:
        steady = any(line.startswith("current:") for line in current)
        start = "as_built" if as_built else "rest_in_current" if steady else "rest"
        settings = [f"start: {start}"]
        if deck.waves is not None or deck.current_field is not None or (current and not steady):
            # in MoorDyn waves stand from the start, and their kinematics end at still water
            settings += ["ramp: 0", "stretching: constant"]
        if duration is not None:
            settings.append(f"duration: {_number(duration)}")
        if output_step is not None:
            settings.append(f"output_step: {_number(output_step)}")
        lines += ["", f"settings: {{{', '.join(settings)}}}"]
    return "\n".join([*lines, ""])


def _bed(deck: MoorDynDeck) -> str:
    numbers = (("stiffness", "kBot"), ("damping", "cBot"), ("friction", "FrictionCoefficient"))
    entries = [f"{word}: {_number(deck.number(key) or 0.0)}" for word, key in numbers]
    grid = deck.seafloor
    if grid is not None and grid.flat_depth is None:
        entries.append(f"grid: {{file: {_word(str(Path(grid.folder) / grid.file))}, form: seafloor}}")
    return f"  bed: {{{', '.join(entries)}}}"


def _check_bed(deck: MoorDynDeck, bodies: tuple[BodyOfDeck, ...]) -> None:
    """Refuse points under the bed, with their lines in the deck.

    Raises
    ------
    CaseError
        All of them.
    """
    placed: list[tuple[str, Any, int]] = [
        (point_name(p.number), p.position, p.line) for p in deck.points if p.kind != "body"
    ]
    placed += [(name, place, body.line) for body in bodies for name, place in body.points_in_site().items()]
    levels = [deck.bed_under(place) for _, place, _ in placed]
    faults = [
        Fault(f"{name} at z = {place[2]:g} m lies under the bed", "z", f"{level:g} m or more", "", deck.source, line, 1)
        for (name, place, line), level in zip(placed, levels, strict=True)
        if level is not None and place[2] < level - deck.bed_tolerance
    ]
    if faults:
        raise CaseError(faults)


def _moved(deck: MoorDynDeck, bodies: tuple[BodyOfDeck, ...], motions: Mapping[int | str, Path]) -> dict[str, Path]:
    """Return the motions by the names of what follows them.

    Raises
    ------
    InputError
        For a motion of what is not coupled.
    """
    coupled = [point_name(point.number) for point in deck.points if point.kind == "coupled"]
    coupled += [body.name for body in bodies if body.kind == "coupled" and body.points]
    coupled += [name for name, (kind, _) in rod_knots(deck).items() if kind == "driven"]
    found: dict[str, Path] = {}
    for key, path in motions.items():
        name = point_name(key) if isinstance(key, int) else key
        if name not in coupled:
            raise InputError(
                f"{name} is not coupled and follows no motion", path="--motion",
                allowed=", ".join(coupled) or "nothing of this deck is coupled to what moves it",
                remedy="pins of coupled bodies and rods are fixed here" if any(
                    body.name == name and body.kind == "pinned" for body in bodies
                ) else "",
            )  # fmt: skip
        found[name] = path
    return found


def _points(deck: MoorDynDeck, bodies: tuple[BodyOfDeck, ...], moved: Mapping[str, Path]) -> list[str]:
    """Return the points of a case: those of the deck, and those of bodies and rods that no force moves."""
    ends = {end for line in deck.lines for end in (line.start, line.end)}
    rows = []
    for point in deck.points:
        if point.kind == "body":
            continue
        if point.number in ends:
            rows.append(_point(point, point_name(point.number) in moved))
        else:
            rows.append(f"    # {point_name(point.number)}: no line meets it")
    for name, (kind, place) in rod_knots(deck).items():
        motion = f", motion: {name}" if name in moved else ""
        rows.append(f"    {name}: {{kind: {kind}, position: {_list(place)}{motion}}}")
    for body in bodies:
        if not body.moves:
            kind = "driven" if body.kind == "coupled" else "fixed"
            motion = f", motion: {body.name}" if body.name in moved else ""
            rows += [
                f"    {name}: {{kind: {kind}, position: {_list(place)}{motion}}}"
                for name, place in body.points_in_site().items()
            ]
    if not any(not row.lstrip().startswith("#") for row in rows):
        return []
    return ["  points:", *rows]


def _bodies(bodies: tuple[BodyOfDeck, ...]) -> list[str]:
    """Return the bodies of a case."""
    rows: list[str] = []
    for body in bodies:
        if not body.moves:
            continue
        angles = np.degrees(roll_pitch_yaw(body.rotation))
        rows += [
            f"    {body.name}:", "      shape: assembly", f"      position: {_list(body.position)}",
            f"      rotation_deg: {_list(angles)}",
        ]  # fmt: skip
        if body.mass > 0.0 or any(body.inertia):
            rows += [f"      mass: {_number(body.mass)}", f"      inertia: {_list(body.inertia)}"]
            rows.append(f"      centre_of_gravity: {_list(body.centre)}")
        if body.kind == "pinned":
            rows.append("      pin: [0, 0, 0]")
        if any(body.turning_drag):
            rows.append(f"      turning_drag: {_list(body.turning_drag)}")
        if body.points:
            rows.append("      points:")
            rows += [f"        {name}: {_list(place)}" for name, place in body.points.items()]
        rods = [part for part in body.parts if isinstance(part, RodPart)]
        if rods:
            rows.append("      rods:")
        for rod in rods:
            rows += [
                f"        - {{start: {_list(rod.start)}, end: {_list(rod.end)}, diameter: {_number(rod.diameter)},",
                f"           mass: {_number(rod.mass_per_length)}, drag_normal: {_number(rod.drag_normal)}, "
                f"added_mass_normal: {_number(rod.added_mass_normal)},",
                f"           drag_end: {_number(rod.drag_end)}, added_mass_end: {_number(rod.added_mass_end)}, "
                f"slices: {rod.slices}}}",
            ]
        volumes = [part for part in body.parts if isinstance(part, VolumePart)]
        if volumes:
            rows.append("      volumes:")
        for item in volumes:
            rows += [
                f"        - {{position: {_list(item.place)}, mass: {_number(item.mass)}, "
                f"volume: {_number(item.volume)},",
                f"           drag_area: {_list(item.drag_area)}, "
                f"added_mass_coefficient: {_list(item.added_mass_coefficient)}}}",
            ]
    return ["  bodies:", *rows] if rows else []


def _list(values: Iterable[float]) -> str:
    return f"[{', '.join(_number(value) for value in values)}]"


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
    law = None if kind.syrope is None or kind.syrope.original is None else law_of(kind.syrope.original, kind.syrope)
    curve = kind.stiffness if kind.syrope is None else kind.syrope.original
    if isinstance(curve, StiffnessTable):
        rows = zip(curve.strain, curve.tension, strict=True)
        parts.append(f"curve: {{table: [{', '.join(f'[{_number(e)}, {_number(t)}]' for e, t in rows)}]}}")
    elif isinstance(kind.stiffness, float):
        parts.append(f"axial_stiffness: {_number(kind.stiffness)}")
    if law is not None:
        parts.append(
            f"worn_rope: {{form: {law.form}, k1: {_number(law.k1)}, k2: {_number(law.k2)}, "
            f"quick_stiffness: {_number(law.stiffness)}, growth: {_number(law.growth)}, "
            f"viscosity: {_number(law.viscosity)}, highest_mean_tension: {_number(law.highest)}}}"
        )
    if kind.slow is not None:
        parts.append(
            f"slow_stretch: {{static_stiffness: {_number(kind.slow.stiffness)}, "
            f"viscosity: {_number(kind.slow.damping)}, growth: {_number(kind.slow.growth)}}}"
        )
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


def _waves(deck: MoorDynDeck, folder: Path | None) -> list[str]:
    waves = deck.waves
    if waves is None:
        return []
    if waves.file and folder is not None:
        step = "" if waves.time_step is None else f", time_step: {_number(waves.time_step)}"
        file = (folder / waves.file).resolve()
        heading = _number(math.degrees(waves.direction[0]))
        return [f"waves: {{kind: elevation_record, file: {_word(str(file))}{step}, heading_deg: {heading}}}"]
    amplitude, phase = amplitude_and_phase(waves)
    rows = zip(waves.omega, amplitude, np.degrees(phase), np.degrees(waves.direction), strict=True)
    return [
        "waves:", "  kind: components", "  waves:",
        *(
            f"    - {{angular_frequency: {_number(omega)}, amplitude: {_number(a)}, phase_deg: {_number(angle)}, "
            f"heading_deg: {_number(heading)}}}"
            for omega, a, angle, heading in rows
        ),
    ]  # fmt: skip


def _failure(deck: MoorDynDeck, item: DeckFailure) -> str:
    line = next(line for line in deck.lines if line.number == item.line_number)
    parts = [f"line: {line_name(line.number)}", f"at: {'start' if line.start == item.point else 'end'}"]
    parts += [f"{key}: {_number(value)}" for key, value in (("time", item.time), ("tension", item.tension)) if value]
    return f"{{{', '.join(parts)}}}"


def _current_field(deck: MoorDynDeck) -> list[str]:
    given = deck.current_field
    if given is None:
        return []
    return [f"current_field: {{file: {_word(str(Path(given.folder) / given.file))}, form: {given.form}}}"]


def _turns(headings: list[float]) -> bool:
    return any(abs(math.remainder(heading - headings[0], 2.0 * math.pi)) > 1e-9 for heading in headings)


def _current(deck: MoorDynDeck, dynamic: bool) -> list[str]:
    current = deck.current
    if current is None:
        return []
    rows = [(z, math.hypot(u, v), math.atan2(v, u)) for z, (u, v) in zip(current.z, current.velocity, strict=True)]
    headings = [heading for _, speed, heading in rows if speed > 0.0]
    if not headings:
        return []
    if _turns(headings):
        if current.file and dynamic:
            return [f"current_field: {{file: {_word(current.file)}, form: steady}}"]
        raise InputError(
            "the direction of the deck's current varies with depth; in statics a case file has one direction",
            path="Currents",
            remedy="run it through time (--duration)"
            if current.file
            else "give it by Currents 1 and current_profile.txt",
        )
    bed = -water_of(deck).depth
    deep = [(z, speed) for z, speed, _ in rows if z < bed]
    shown = [(z, speed) for z, speed, _ in rows if bed <= z <= 0.0]
    if deep and (not shown or shown[0][0] > bed):
        # profiles of case files end at the bed
        speeds = np.interp(bed, [z for z, _, _ in rows], [speed for _, speed, _ in rows])
        shown.insert(0, (bed, float(speeds)))
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
