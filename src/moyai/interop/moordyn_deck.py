"""A MoorDyn input file as frozen records, each with its line number, and the writer of such files.

Read with :func:`moyai.interop.moordyn_reader.read_deck`; turned into a network of :mod:`moyai.flexible` and back by
:mod:`moyai.interop.moordyn_network`. Units are those of the file, which are SI.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.core.files import write_whole
from moyai.core.options import checks_words
from moyai.flexible.bed import Bed
from moyai.interop.moordyn_bodies import DeckBody, DeckRod, DeckRodType, attachment_word
from moyai.interop.moordyn_records import (
    CURRENT_FILE,
    FREQUENCY_FILE,
    DeckCurrent,
    DeckCurrentField,
    DeckFailure,
    DeckOption,
    DeckSeafloor,
    DeckSlowStretch,
    DeckSyrope,
    DeckWaves,
    StiffnessTable,
)

PointKind = Literal["fixed", "coupled", "free", "body"]

#: Options that the file format gives a value when they are left out (manual of MoorDyn v2).
FORMAT_DEFAULTS = {"g": 9.80665, "WtrDnsty": 1025.0, "kBot": 3.0e6, "cBot": 3.0e5, "FrictionCoefficient": 0.0}


@dataclass(frozen=True)
class DeckLineType:
    """A row of LINE TYPES."""

    #: Its name.
    name: str
    #: Volume-equivalent [m].
    diameter: float
    #: In air [kg/m].
    mass_per_length: float
    #: EA [N], or the table.
    stiffness: float | StiffnessTable
    #: BA [N s]; negative: minus the part of the critical damping of one segment.
    damping: float
    #: EI [N m2].
    bending_stiffness: float
    #: Cd across the line, on the diameter [-].
    drag_normal: float
    #: Ca across the line [-].
    added_mass_normal: float
    #: CdAx along the line, on the circumference [-].
    drag_axial: float
    #: CaAx along the line [-].
    added_mass_axial: float
    #: Line of the file, 0 for a record that was not read.
    line: int = field(default=0, compare=False)
    #: Of a viscoelastic rope, whose ``stiffness`` and ``damping`` are the dynamic ones.
    slow: DeckSlowStretch | None = None
    #: Of a polyester rope whose ``stiffness`` is its curve at rest.
    syrope: DeckSyrope | None = None


@checks_words
@dataclass(frozen=True)
class DeckPoint:
    """A row of POINTS."""

    #: Its ID.
    number: int
    #: What moves it: nothing, a prescribed motion, its forces, the body that carries it; one of "fixed", "coupled",
    #: "free", "body".
    kind: PointKind
    #: Start [m]; in body axes on a body.
    position: tuple[float, float, float]
    #: [kg].
    mass: float
    #: [m3].
    volume: float
    #: [m2].
    drag_area: float
    #: On the volume [-].
    added_mass_coefficient: float
    #: Line of the file.
    line: int = field(default=0, compare=False)
    #: The body that carries it, 0 for none.
    body: int = 0
    #: Vertical extent over which it comes out of the water [m]; 0: always wet, as MoorDyn takes all points.
    height: float = 0.0


@dataclass(frozen=True)
class DeckLine:
    """A row of LINES."""

    #: Its ID.
    number: int
    #: Name of a line type.
    line_type: str
    #: ID of the point at its end A, or an end of a rod such as ``R1A``.
    start: int | str
    #: ID of the point at its end B, or an end of a rod.
    end: int | str
    #: Unstretched [m].
    length: float
    #: Number of segments.
    segments: int
    #: Flags of the line's own output file, ``-`` for none.
    outputs: str = "-"
    #: Line of the file.
    line: int = field(default=0, compare=False)


@dataclass(frozen=True)
class MoorDynDeck:
    """A MoorDyn input file."""

    #: Rows of the section of line types.
    line_types: tuple[DeckLineType, ...]
    #: Rows of the section of points.
    points: tuple[DeckPoint, ...]
    #: Rows of the section of lines.
    lines: tuple[DeckLine, ...]
    #: Rows of OPTIONS, in order.
    options: tuple[DeckOption, ...] = ()
    #: Channels of OUTPUTS.
    outputs: tuple[str, ...] = ()
    #: When the option Currents is 1.
    current: DeckCurrent | None = None
    #: Of the option SeafloorFile.
    seafloor: DeckSeafloor | None = None
    #: Rows of ROD TYPES.
    rod_types: tuple[DeckRodType, ...] = ()
    #: Rows of BODIES.
    bodies: tuple[DeckBody, ...] = ()
    #: Rows of RODS.
    rods: tuple[DeckRod, ...] = ()
    #: Line that describes the deck.
    title: str = field(default="", compare=False)
    #: Name of the file.
    source: str = field(default="", compare=False)
    #: What the reader says about the file that is no fault: options without meaning here, columns in another order.
    notes: tuple[str, ...] = field(default=(), compare=False)
    #: Rows of FAILURE.
    failures: tuple[DeckFailure, ...] = ()
    #: When the option Currents is 2 or 5.
    current_field: DeckCurrentField | None = None
    #: When the option WaveKin is 2, 3 or 7. Decks are written with 7, which needs no grid.
    waves: DeckWaves | None = None

    def number(self, key: str) -> float | None:
        """Return an option as a number; the value of the format when the deck leaves it out; ``None`` without one."""
        for option in self.options:
            if option.key == key and isinstance(option.value, float):
                return option.value
        return FORMAT_DEFAULTS.get(key)

    def in_depth(self, depth: float | None) -> MoorDynDeck:
        """Return the deck in water of a depth [m]; as it is for ``None``. A grid of depths gives way to it."""
        if depth is None:
            return self
        kept = tuple(option for option in self.options if option.key not in ("WtrDpth", "SeafloorFile"))
        return replace(self, options=(*kept, DeckOption("WtrDpth", depth)), seafloor=None)

    @property
    def seafloor_depth(self) -> float | None:
        """Depth of a flat grid of depths [m]."""
        return None if self.seafloor is None else self.seafloor.flat_depth

    @property
    def depth(self) -> float | None:
        """Depth of the water [m]: that of a flat grid, the greatest of WtrDpth and of a grid that varies."""
        given = self.number("WtrDpth")
        if self.seafloor is None:
            return given
        flat = self.seafloor.flat_depth
        return flat if flat is not None else max(self.seafloor.deepest, given or 0.0)

    def bed_under(self, place: ArrayLike) -> float | None:
        """Height of the bed under a place above still water [m]; ``None`` where the deck gives no depth."""
        ground = None if self.seafloor is None else self.seafloor.ground
        if ground is not None:
            return float(Bed.on(ground, 1.0).level_at(np.asarray(place, dtype=float)))
        return None if self.depth is None else -self.depth

    @property
    def bed_tolerance(self) -> float:
        """How far under the bed a point may stand that is meant to stand on it [m]."""
        ground = None if self.seafloor is None else self.seafloor.ground
        return 1e-9 * (self.depth or 0.0) + (0.0 if ground is None else ground.rounding)

    def point(self, number: int) -> DeckPoint:
        """Return the point of an ID.

        Raises
        ------
        InputError
            When there is none.
        """
        for point in self.points:
            if point.number == number:
                return point
        raise InputError(f"no point {number}", path="points", allowed=", ".join(str(p.number) for p in self.points))

    def line_type(self, name: str) -> DeckLineType:
        """Return the line type of a name.

        Raises
        ------
        InputError
            When there is none.
        """
        for kind in self.line_types:
            if kind.name == name:
                return kind
        raise InputError(
            f"no line type {name!r}", path="line_types", allowed=", ".join(t.name for t in self.line_types)
        )


def _title(name: str) -> str:
    return f"---------------------- {name} ".ljust(100, "-")


def _digits(value: float) -> str:
    """Return the shortest text that gives the same number again; whole numbers without a point, as flags need them."""
    number = float(value)
    return str(int(number)) if number.is_integer() and abs(number) < 1e15 else repr(number)


def _columns(names: str, units: str, rows: Iterable[Iterable[str]]) -> list[str]:
    """Return aligned rows under two heading lines."""
    table = [names.split(), units.split(), *[list(row) for row in rows]]
    widths = [max(len(row[i]) for row in table) for i in range(len(table[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in table]


def _shortest(areas: tuple[float, ...]) -> str:
    """Return six areas as two, along and about all axes, or three, the same along and about each, where they allow it.

    MoorDyn 2.7.2 does not give the drag of six areas to a body that six equal ones describe.
    """
    along, about = areas[:3], areas[3:]
    if len(set(along)) == len(set(about)) == 1:
        areas = (along[0],) if along == about else (along[0], about[0])
    elif along == about:
        areas = along
    return "|".join(map(_digits, areas))


def _section(name: str, names: str, units: str, rows: Sequence[Iterable[str]], keep: bool) -> list[str]:
    """Return a section; nothing for one without rows, unless it is to be kept."""
    return [_title(name), *_columns(names, units, rows)] if rows or keep else []


def _body_sections(deck: MoorDynDeck) -> list[str]:
    """Return the sections ROD TYPES, BODIES and RODS of a deck that has them."""
    text: list[str] = []
    if deck.rod_types:
        rows: list[Iterable[str]] = [
            (
                t.name, *map(_digits, (t.diameter, t.mass_per_length, t.drag_normal, t.added_mass_normal)),
                _digits(t.drag_end), _digits(t.added_mass_end),
            )
            for t in deck.rod_types
        ]  # fmt: skip
        names, units = "TypeName Diam Mass/m Cd Ca CdEnd CaEnd", "(name) (m) (kg/m) (-) (-) (-) (-)"
        text += [_title("ROD TYPES"), *_columns(names, units, rows)]
    if deck.bodies:
        rows = [
            (
                str(b.number), attachment_word(b.kind, 0), *map(_digits, (*b.position, *b.angles, b.mass)),
                "|".join(map(_digits, b.centre)), "|".join(map(_digits, b.inertia)), _digits(b.volume),
                _shortest(b.drag_area), "|".join(map(_digits, b.added_mass)),
            )
            for b in deck.bodies
        ]  # fmt: skip
        names = "ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG* I* Volume CdA* Ca*"
        units = "(#) (-) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2) (-)"
        text += [_title("BODIES"), *_columns(names, units, rows)]
    if deck.rods:
        rows = [
            (
                str(r.number), r.rod_type, attachment_word(r.kind, r.body), *map(_digits, (*r.start, *r.end)),
                str(r.segments), r.outputs,
            )
            for r in deck.rods
        ]  # fmt: skip
        names = "ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs RodOutputs"
        units = "(#) (name) (#/key) (m) (m) (m) (m) (m) (m) (-) (-)"
        text += [_title("RODS"), *_columns(names, units, rows)]
    return text


def _value(option: DeckOption, waves: DeckWaves | None) -> str:
    if option.key == "WaveKin" and waves is not None:
        return "7"
    return option.value if isinstance(option.value, str) else _digits(option.value)


def _stiffness(kind: DeckLineType) -> str:
    if isinstance(kind.stiffness, StiffnessTable):
        return kind.stiffness.file
    if kind.slow is None:
        return _digits(kind.stiffness)
    parts = [kind.slow.stiffness, kind.stiffness, *([kind.slow.growth] if kind.slow.growth else [])]
    return "|".join(map(_digits, parts))


def deck_text(deck: MoorDynDeck) -> str:
    """Return the text of a MoorDyn v2 input file; every number keeps all its digits."""
    kinds = [
        (
            t.name, _digits(t.diameter), _digits(t.mass_per_length),
            _stiffness(t), _digits(t.damping) if t.slow is None else f"{_digits(t.slow.damping)}|{_digits(t.damping)}",
            _digits(t.bending_stiffness), _digits(t.drag_normal), _digits(t.added_mass_normal), _digits(t.drag_axial),
            _digits(t.added_mass_axial),
        )
        for t in deck.line_types
    ]  # fmt: skip
    points = [
        (
            str(p.number), attachment_word(p.kind, p.body), *map(_digits, p.position), _digits(p.mass),
            _digits(p.volume), _digits(p.drag_area), _digits(p.added_mass_coefficient),
        )
        for p in deck.points
    ]  # fmt: skip
    lines = [
        (str(n.number), n.line_type, str(n.start), str(n.end), _digits(n.length), str(n.segments), n.outputs)
        for n in deck.lines
    ]
    # MoorDyn takes no empty sections, and needs none of these three next to bodies or rods
    keep = not (deck.bodies or deck.rods)
    text = [
        _title("MoorDyn Input File"),
        deck.title or "moored lines",
        *_section(
            "LINE TYPES",
            "TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx",
            "(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)",
            kinds,
            keep,
        ),
        *_body_sections(deck),
        *_section(
            "POINTS", "ID Type X Y Z Mass Volume CdA Ca", "(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)", points, keep
        ),
        *_section(
            "LINES",
            "ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs",
            "(#) (name) (#) (#) (m) (-) (-)",
            lines,
            keep,
        ),
        *_section(
            "FAILURE",
            "FailureID Point Line(s) FailTime FailTen",
            "() () (,) (s) (N)",
            [
                (str(f.number), str(f.point), str(f.line_number), _digits(f.time), _digits(f.tension))
                for f in deck.failures
            ],
            False,
        ),
        _title("OPTIONS"),
        *[f"{_value(o, deck.waves):<24}{o.key}" for o in deck.options],
    ]
    if deck.outputs:
        text += [_title("OUTPUTS"), *deck.outputs, "END"]
    return "\n".join([*text, _title("need this line"), ""])


def write_deck(deck: MoorDynDeck, path: str | Path) -> Path:
    """Write a deck and the files that it names (stiffness tables, the profile of the current, the waves).

    Parameters
    ----------
    deck : MoorDynDeck
        The deck.
    path : path
        File; its folder takes the others.

    Returns
    -------
    Path
        The file of the deck.

    Raises
    ------
    InputError
        When the folder is absent, or the deck rests on a grid of depths, which is not written.
    """
    place = Path(path)
    if not place.parent.is_dir():
        raise InputError(f"no such folder: {place.parent}", path="path")
    if any(option.key == "SeafloorFile" for option in deck.options):
        raise InputError(
            "the deck takes its depth from a grid file, which is not written",
            path="options.SeafloorFile",
            remedy="replace it by WtrDpth",
        )
    if any(kind.syrope is not None for kind in deck.line_types):
        raise InputError(
            "the deck has Syrope ropes, whose files are not written", path="line types",
            remedy="replace them by ropes with a curve",
        )  # fmt: skip
    if deck.current_field is not None:
        raise InputError(
            f"the deck takes its current from {deck.current_field.file}, which is not written",
            path="options.Currents",
            remedy="replace it by a steady current (Currents 1)",
        )
    lines: dict[str, list[str]] = {}
    for kind in deck.line_types:
        if isinstance(kind.stiffness, StiffnessTable):
            table = kind.stiffness
            rows = [f"{_digits(e)} {_digits(t)}" for e, t in zip(table.strain, table.tension, strict=True)]
            lines[table.file] = ["Strain Tension", "(-) (N)", *rows]
    if deck.waves is not None:
        columns = (deck.waves.omega, deck.waves.real, deck.waves.imaginary, deck.waves.direction)
        rows = [" ".join(map(_digits, row)) for row in zip(*columns, strict=True)]
        lines[FREQUENCY_FILE] = ["0 0 0 0", *rows]
    if deck.current is not None:
        rows = [
            f"{_digits(z)} {_digits(u)} {_digits(v)} 0.0"
            for z, (u, v) in zip(deck.current.z, deck.current.velocity, strict=True)
        ]
        heading = ["--- MoorDyn steady currents File", "Water currents", "z (m), ux (m/s), uy (m/s), uz (m/s)"]
        lines[CURRENT_FILE] = [*heading, *rows]
    for name, rows in lines.items():
        write_whole(place.parent / name, "\n".join([*rows, ""]).encode("utf-8"))
    return write_whole(place, deck_text(deck).encode("utf-8"))
