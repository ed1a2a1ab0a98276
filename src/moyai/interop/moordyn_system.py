"""MoorDyn decks with bodies and rods as rigid bodies of :mod:`moyai.coupled` on a network.

A rod is a cylinder of equal slices along its axis, each with its own waterline; its mass is that of a solid cylinder.
Drag acts axis by axis here and on the whole velocity across the rod there: oblique flow differs. A rod of no length
joins the lines at it; what bends there bends freely. Bodies count no waterline, as in MoorDyn.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import CaseError, Fault, InputError
from moyai.coupled.assembly import ALIGNED, BodyAssembly, RodPart, VolumePart
from moyai.coupled.rigid import RigidBody
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.network import Network
from moyai.interop.moordyn_bodies import DeckBody, DeckRod
from moyai.interop.moordyn_deck import MoorDynDeck
from moyai.interop.moordyn_network import add_lines, add_point, builder_of, point_name, water_of
from moyai.mooring.rotations import rotation_matrix
from moyai.sea.water import Water

Triple = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class DeckSystem:
    """Network and bodies of a deck."""

    #: Points ``point 1`` ..., ends of rods ``rod 1 A`` ..., lines ``line 1`` ....
    network: Network
    #: ``body 1`` ..., and ``rod 1`` ... for rods that move by themselves.
    bodies: dict[str, RigidBody]
    #: What a run here does otherwise than MoorDyn.
    notes: tuple[str, ...] = ()


def body_name(number: int) -> str:
    """Return the name of a deck's body."""
    return f"body {number}"


def rod_name(number: int, end: str = "") -> str:
    """Return the name of a deck's rod, or of one of its ends."""
    return f"rod {number} {end}".rstrip()


def rotation_of(body: DeckBody) -> Array:
    """Return the rotation matrix of a deck's body: turns about its own x, then y, then z."""
    roll, pitch, yaw = np.radians(body.angles)
    turns = [rotation_matrix(angles) for angles in ((roll, 0.0, 0.0), (0.0, pitch, 0.0), (0.0, 0.0, yaw))]
    return np.asarray(turns[0] @ turns[1] @ turns[2])


def to_system(deck: MoorDynDeck, *, water: Water | None = None, segments: int | None = None) -> DeckSystem:
    """Return network and bodies of a deck.

    Coupled bodies, rods and points become driven points, which stand still unless the run gives them motions; what is
    pinned turns about its pin. :func:`moyai.coupled.equilibrium.find_coupled_equilibrium` and
    :func:`moyai.coupled.simulate.simulate_coupled` take the result.

    Parameters
    ----------
    deck : MoorDynDeck
    water : Water, optional
        Instead of the deck's own.
    segments : int, optional
        Segments of every line instead of the deck's own.

    Raises
    ------
    CaseError
        For rods hinged to a body, and rods that lean from the axes of theirs.
    InputError
        No depth, bodies without mass or inertia, and what the network refuses.
    """
    site = water or water_of(deck)
    return _SystemBuilder(deck, site).run(segments)


@dataclass(frozen=True, eq=False)
class BodyOfDeck:
    """A body of a deck, or a rod that is none's, in axes of its own."""

    name: str
    #: What holds it; ``pinned``: the origin of its axes stays; one of "fixed", "coupled", "free", "pinned".
    kind: str
    #: Of the origin of its axes [m]; shape (3,).
    position: Array
    #: From its axes to those of the site; shape (3, 3).
    rotation: Array
    #: Without parts [kg].
    mass: float
    #: Centre of that mass, in its axes [m].
    centre: Triple
    #: Moments of inertia about that centre [kg m2].
    inertia: Triple
    parts: tuple[RodPart | VolumePart, ...]
    #: Points that lines meet, in its axes [m]; shape (3,).
    points: dict[str, Array]
    #: Drag of turns about its axes, CdA of the deck [m5].
    turning_drag: Triple = (0.0, 0.0, 0.0)
    #: Line of the file.
    line: int = 0

    @property
    def moves(self) -> bool:
        """Whether forces move it."""
        return self.kind in ("free", "pinned")

    def points_in_site(self) -> dict[str, Array]:
        """Return where its points stand [m]."""
        return {name: self.position + self.rotation @ place for name, place in self.points.items()}

    def body(self, density: float) -> RigidBody:
        """Return it as a rigid body in water of a density [kg/m3]."""
        made = BodyAssembly(density)
        made.add_mass(self.mass, self.centre, np.diag(self.inertia))
        for part in self.parts:
            made.add(part, self.name)
        quadratic = np.concatenate([np.zeros(3), 0.5 * density * np.array(self.turning_drag)])
        return made.body(
            self.name, self.position, self.rotation, self.points, quadratic_damping=quadratic,
            pin=np.zeros(3) if self.kind == "pinned" else None,
        )  # fmt: skip


def bodies_of(deck: MoorDynDeck) -> tuple[tuple[BodyOfDeck, ...], tuple[str, ...]]:
    """Return bodies and rods of a deck, and what a run here does otherwise than MoorDyn.

    Raises
    ------
    CaseError
        For rods hinged to a body, rods that lean from the axes of theirs, bodies that move without mass or inertia.
    """
    faults: list[Fault] = []
    notes: list[str] = []
    ends = {end for line in deck.lines for end in (line.start, line.end)}
    for rod in deck.rods:
        why, remedy = _refusal(deck, rod)
        if why:
            faults.append(Fault(why, "rods", "", remedy, deck.source, rod.line, 1))
        if not rod.segments:
            notes.append(f"rod {rod.number} has no length: the lines at it are joined and bend freely there")
    if faults:
        raise CaseError(faults)
    found = [_body_of(deck, body, ends) for body in deck.bodies]
    found += [_rod_alone(deck, rod, ends) for rod in deck.rods if rod.kind != "body" and rod.segments]
    return tuple(found), tuple(notes)


def _refusal(deck: MoorDynDeck, rod: DeckRod) -> tuple[str, str]:
    """Return why a rod is not run, and what corrects it; two empty texts when it is."""
    if rod.kind == "body pinned":
        return (
            f"rod {rod.number} is hinged to body {rod.body}: hinges between bodies are not run",
            f"hold it by Body{rod.body} instead, which fixes it to the body, or let it be Free on a short line",
        )
    if rod.kind == "body" and rod.segments and not _rod_part(deck, rod, rod.start, rod.end).lean <= ALIGNED:
        return (
            f"rod {rod.number} leans from the axes of body {rod.body}",
            "turn the axes of the body so that one of them lies along its rods",
        )
    return "", ""


def _rod_part(deck: MoorDynDeck, rod: DeckRod, start: Triple, end: Triple) -> RodPart:
    kind = next(kind for kind in deck.rod_types if kind.name == rod.rod_type)
    return RodPart(
        start, end, kind.diameter, kind.mass_per_length, kind.drag_normal, kind.added_mass_normal, kind.drag_end,
        kind.added_mass_end, 2 * rod.segments,
    )  # fmt: skip


def _rod_ends(rod: DeckRod, ends: set[int | str]) -> dict[str, Array]:
    """Return the ends of a rod where lines meet it."""
    if not rod.segments:
        used = {f"R{rod.number}A", f"R{rod.number}B"} & ends
        return {rod_name(rod.number): np.array(rod.start)} if used else {}
    both = (("A", rod.start), ("B", rod.end))
    return {rod_name(rod.number, e): np.array(p) for e, p in both if f"R{rod.number}{e}" in ends}


def _body_of(deck: MoorDynDeck, body: DeckBody, ends: set[int | str]) -> BodyOfDeck:
    parts: list[RodPart | VolumePart] = []
    points: dict[str, Array] = {}
    area = body.drag_area
    if body.volume > 0.0 or any(area[:3]):
        parts.append(VolumePart((0.0, 0.0, 0.0), 0.0, body.volume, (area[0], area[1], area[2]), body.added_mass))
    for rod in deck.rods:
        if rod.kind == "body" and rod.body == body.number:
            points.update(_rod_ends(rod, ends))
            if rod.segments:
                parts.append(_rod_part(deck, rod, rod.start, rod.end))
    for point in deck.points:
        if point.kind == "body" and point.body == body.number:
            if point.mass > 0.0 or point.volume > 0.0 or point.drag_area > 0.0:
                ca = point.added_mass_coefficient
                parts.append(VolumePart(point.position, point.mass, point.volume, (point.drag_area,) * 3, (ca, ca, ca)))
            if point.number in ends:
                points[point_name(point.number)] = np.array(point.position)
    # rods first, as case files list them
    parts.sort(key=lambda part: not isinstance(part, RodPart))
    return BodyOfDeck(
        body_name(body.number), "pinned" if body.kind == "coupled pinned" else body.kind, np.array(body.position),
        rotation_of(body), body.mass, body.centre, body.inertia, tuple(parts), points, (area[3], area[4], area[5]),
        body.line,
    )  # fmt: skip


def _rod_alone(deck: MoorDynDeck, rod: DeckRod, ends: set[int | str]) -> BodyOfDeck:
    along = np.array(rod.end) - np.array(rod.start)
    length = float(np.linalg.norm(along))
    points = {end: np.array([0.0, 0.0, length if end.endswith("B") else 0.0]) for end in _rod_ends(rod, ends)}
    return BodyOfDeck(
        rod_name(rod.number), "pinned" if "pinned" in rod.kind else rod.kind, np.array(rod.start), _upright(along), 0.0,
        (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (_rod_part(deck, rod, (0.0, 0.0, 0.0), (0.0, 0.0, length)),), points,
        line=rod.line,
    )  # fmt: skip


def rod_knots(deck: MoorDynDeck) -> dict[str, tuple[str, Triple]]:
    """Return the points that rods of no length stand for, where lines meet them: what holds each, and where."""
    ends = {end for line in deck.lines for end in (line.start, line.end)}
    found: dict[str, tuple[str, Triple]] = {}
    for rod in deck.rods:
        if not rod.segments and rod.kind != "body" and _rod_ends(rod, ends):
            kind = {"free": "free", "fixed": "fixed", "pinned": "fixed"}.get(rod.kind, "driven")
            found[rod_name(rod.number)] = (kind, rod.start)
    return found


def end_name(deck: MoorDynDeck, end: int | str) -> str:
    """Return the point of the network at an end of a line of a deck."""
    if isinstance(end, int):
        return point_name(end)
    rod = next(rod for rod in deck.rods if rod.number == int(end[1:-1]))
    return rod_name(rod.number, end[-1] if rod.segments else "")


class _SystemBuilder:
    """Collects points and bodies of one deck."""

    def __init__(self, deck: MoorDynDeck, site: Water) -> None:
        self.deck, self.site = deck, site
        self.network: NetworkBuilder = builder_of(deck, site)
        self.bodies: dict[str, RigidBody] = {}

    def run(self, segments: int | None) -> DeckSystem:
        bodies, notes = bodies_of(self.deck)
        for body in bodies:
            for name, place in body.points_in_site().items():
                self._stand(name, place, body.kind)
            if body.moves:
                self.bodies[body.name] = self._rigid(body)
        for name, (kind, knot) in rod_knots(self.deck).items():
            if kind == "free":
                self.network.free(name, knot)
            else:
                self._stand(name, np.array(knot), kind)
        for point in self.deck.points:
            if point.kind != "body":
                add_point(self.network, point, self.site)
        add_lines(self.network, self.deck, segments, lambda end: end_name(self.deck, end))
        if not self.deck.lines and all(point.kind == "body" for point in self.deck.points):
            self.network.fixed("site", (0.0, 0.0, -self.site.depth if math.isfinite(self.site.depth) else 0.0))
        return DeckSystem(self.network.build(), self.bodies, notes)

    def _rigid(self, body: BodyOfDeck) -> RigidBody:
        try:
            return body.body(self.site.density)
        except InputError as error:
            fault = error.fault
            raise CaseError(
                [Fault(fault.message, fault.path, fault.allowed, fault.remedy, self.deck.source, body.line, 1)]
            ) from None

    def _stand(self, name: str, place: Array, kind: str) -> None:
        """Add a point that no forces of the network move."""
        if kind == "fixed":
            self.network.fixed(name, place)
        else:
            self.network.driven(name, place)


def _upright(along: Array) -> Array:
    """Return the rotation that takes the z axis to a direction without turning about it."""
    z = along / np.linalg.norm(along)
    heading = math.atan2(z[1], z[0]) if math.hypot(z[0], z[1]) > 0.0 else 0.0
    tilt = math.atan2(math.hypot(z[0], z[1]), z[2])
    turns = rotation_matrix((0.0, 0.0, heading)) @ rotation_matrix((0.0, tilt, 0.0))
    return np.asarray(turns @ rotation_matrix((0.0, 0.0, -heading)))
