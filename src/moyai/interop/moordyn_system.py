"""MoorDyn decks with bodies and rods as rigid bodies of :mod:`moyai.coupled` on a network.

A rod is a cylinder of equal slices along its axis, each with its own waterline; its mass is that of a solid cylinder.
Drag acts axis by axis here and on the whole velocity across the rod there: oblique flow differs. A rod of no length
joins the lines at it; what bends there bends freely. Bodies count no waterline, as in MoorDyn.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.errors import CaseError, Fault
from moyai.coupled.hulls import Lumps, volume_lump
from moyai.coupled.rigid import RigidBody
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.network import Network
from moyai.interop.moordyn_bodies import DeckBody, DeckRod, DeckRodType
from moyai.interop.moordyn_deck import MoorDynDeck
from moyai.interop.moordyn_network import add_lines, add_point, builder_of, point_name, water_of
from moyai.mooring.rotations import roll_pitch_yaw, rotation_matrix
from moyai.sea.water import Water

Array = NDArray[np.float64]

#: Slices of a rod at least; an inclined rod that crosses the surface is followed slice by slice.
SLICES = 24
#: How far a rod may lean from an axis of its body, where its coefficients are told axis by axis.
ALIGNED = 1e-6


@dataclass(frozen=True, eq=False)
class DeckSystem:
    """Network and bodies of a deck.

    Parameters
    ----------
    network : Network
        Points ``point 1`` ..., ends of rods ``rod 1 A`` ..., lines ``line 1`` ....
    bodies : dict of str to RigidBody
        ``body 1`` ..., and ``rod 1`` ... for rods that move by themselves.
    notes : tuple of str
        What a run here does otherwise than MoorDyn.
    """

    network: Network
    bodies: dict[str, RigidBody]
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


@dataclass
class _Assembly:
    """What a body is made of, in its axes."""

    mass: float = 0.0
    moment: Array = field(default_factory=lambda: np.zeros(3))
    inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))
    lumps: list[Lumps] = field(default_factory=list)
    points: dict[str, Array] = field(default_factory=dict)

    def add_mass(self, mass: float, place: ArrayLike, inertia: ArrayLike) -> None:
        """Add a mass with its inertia about its own centre; the sum counts about the origin."""
        x = np.asarray(place, dtype=float)
        self.mass += mass
        self.moment = self.moment + mass * x
        self.inertia = self.inertia + np.asarray(inertia) + mass * (x @ x * np.eye(3) - np.outer(x, x))

    def add_rod(self, kind: DeckRodType, start: Array, end: Array, segments: int, density: float) -> None:
        """Add a rod along one of the axes."""
        length = float(np.linalg.norm(end - start))
        unit = (end - start) / length
        axis = int(np.argmax(np.abs(unit)))
        across = [k for k in range(3) if k != axis]
        mass, d = kind.mass_per_length * length, kind.diameter
        own = np.eye(3) * mass * (length**2 / 12.0 + d**2 / 16.0)
        own[axis, axis] = mass * d**2 / 8.0
        self.add_mass(mass, 0.5 * (start + end), own)
        count = max(SLICES, 2 * segments)
        volume = 0.25 * math.pi * d**2 * length / count
        # extent along z: that of the slice, or the side of the square of the same area for a rod that lies
        height = length / count if axis == 2 else math.sqrt(0.25 * math.pi) * d
        place = start + (np.arange(count)[:, None] + 0.5) / count * (end - start)
        drag, added = np.zeros((count, 3)), np.zeros((count, 3))
        drag[:, across] = kind.drag_normal * d * length / count
        added[:, across] = kind.added_mass_normal * density * volume
        # the ends: their faces, and half a sphere of water each
        drag[[0, -1], axis] = kind.drag_end * 0.25 * math.pi * d**2
        added[[0, -1], axis] = kind.added_mass_end * density * math.pi / 12.0 * d**3
        self.lumps.append(Lumps(place, np.full(count, volume), np.full(count, height), drag, added))

    def body(self, name: str, position: ArrayLike, rotation: Array, **options: object) -> RigidBody:
        """Return the rigid body."""
        centre = self.moment / self.mass if self.mass > 0.0 else np.zeros(3)
        inertia = self.inertia - self.mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
        lumps = None
        for part in self.lumps:
            lumps = part if lumps is None else lumps + part
        return RigidBody(
            name, self.mass, inertia, centre, np.asarray(position, dtype=float), roll_pitch_yaw(rotation),
            dict(self.points), lumps, **options,  # type: ignore[arg-type]
        )  # fmt: skip


def to_system(deck: MoorDynDeck, *, water: Water | None = None, segments: int | None = None) -> DeckSystem:
    """Return network and bodies of a deck.

    Coupled bodies, rods and points become driven points, which stand still unless the run gives them motions; what is
    pinned turns about its pin. :func:`moyai.coupled.rest.find_rest` and
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
    return _Builder(deck, site).run(segments)


class _Builder:
    """Collects points and bodies of one deck."""

    def __init__(self, deck: MoorDynDeck, site: Water) -> None:
        self.deck, self.site = deck, site
        self.network: NetworkBuilder = builder_of(deck, site)
        self.ends = {end for line in deck.lines for end in (line.start, line.end)}
        self.kinds = {kind.name: kind for kind in deck.rod_types}
        self.faults: list[Fault] = []
        self.notes: list[str] = []
        self.bodies: dict[str, RigidBody] = {}

    def run(self, segments: int | None) -> DeckSystem:
        self._check()
        for body in self.deck.bodies:
            self._body(body)
        for rod in self.deck.rods:
            if rod.kind != "body":
                self._own_rod(rod)
        for point in self.deck.points:
            if point.kind != "body":
                add_point(self.network, point, self.site)
        add_lines(self.network, self.deck, segments, self._end)
        if not self.ends and all(point.kind == "body" for point in self.deck.points):
            self.network.fixed("site", (0.0, 0.0, -self.site.depth if math.isfinite(self.site.depth) else 0.0))
        return DeckSystem(self.network.build(), self.bodies, tuple(self.notes))

    def _check(self) -> None:
        for rod in self.deck.rods:
            if rod.kind == "body pinned":
                self._refuse(rod, f"rod {rod.number} is hinged to body {rod.body}: hinges between bodies are not run")
            if rod.kind == "body" and rod.segments and _lean(np.array(rod.end) - np.array(rod.start)) > ALIGNED:
                self._refuse(rod, f"rod {rod.number} leans from the axes of body {rod.body}")
            if not rod.segments:
                self.notes.append(f"rod {rod.number} has no length: the lines at it are joined and bend freely there")
        if self.faults:
            raise CaseError(self.faults)

    def _refuse(self, rod: DeckRod, message: str) -> None:
        self.faults.append(Fault(message, "rods", "", "", self.deck.source, rod.line, 1))

    def _end(self, end: int | str) -> str:
        if isinstance(end, int):
            return point_name(end)
        rod = next(rod for rod in self.deck.rods if rod.number == int(end[1:-1]))
        return rod_name(rod.number, end[-1] if rod.segments else "")

    def _stand(self, name: str, place: Array, kind: str) -> None:
        """Add a point that no forces move."""
        if kind == "fixed":
            self.network.fixed(name, place)
        else:
            self.network.driven(name, place)

    def _rod_ends(self, rod: DeckRod) -> dict[str, Array]:
        """Return the ends of a rod where lines meet it."""
        if not rod.segments:
            used = {f"R{rod.number}A", f"R{rod.number}B"} & self.ends
            return {rod_name(rod.number): np.array(rod.start)} if used else {}
        ends = (("A", rod.start), ("B", rod.end))
        return {rod_name(rod.number, e): np.array(p) for e, p in ends if f"R{rod.number}{e}" in self.ends}

    def _body(self, body: DeckBody) -> None:
        made, density, turn = _Assembly(), self.site.density, rotation_of(body)
        made.add_mass(body.mass, body.centre, np.diag(body.inertia))
        area = np.array(body.drag_area)
        if body.volume > 0.0 or np.any(area[:3] > 0.0):
            added = density * body.volume * np.array(body.added_mass)
            made.lumps.append(volume_lump((0.0, 0.0, 0.0), body.volume, drag_area=area[:3], added_mass=added))
        for rod in self.deck.rods:
            if rod.kind == "body" and rod.body == body.number:
                made.points.update(self._rod_ends(rod))
                if rod.segments:
                    kind = self.kinds[rod.rod_type]
                    made.add_rod(kind, np.array(rod.start), np.array(rod.end), rod.segments, density)
        for point in self.deck.points:
            if point.kind == "body" and point.body == body.number:
                made.add_mass(point.mass, point.position, np.zeros((3, 3)))
                if point.volume > 0.0 or point.drag_area > 0.0:
                    added = np.full(3, density * point.volume * point.added_mass_coefficient)
                    made.lumps.append(
                        volume_lump(
                            point.position, point.volume, drag_area=np.full(3, point.drag_area), added_mass=added
                        )
                    )
                if point.number in self.ends:
                    made.points[point_name(point.number)] = np.array(point.position)
        places = {name: np.array(body.position) + turn @ place for name, place in made.points.items()}
        for name, place in places.items():
            self._stand(name, place, body.kind)
        if body.kind in ("free", "coupled pinned"):
            pin = np.zeros(3) if body.kind == "coupled pinned" else None
            quadratic = np.concatenate([np.zeros(3), 0.5 * density * area[3:]])
            name = body_name(body.number)
            self.bodies[name] = made.body(name, body.position, turn, pin=pin, quadratic_damping=quadratic)

    def _own_rod(self, rod: DeckRod) -> None:
        name, ends, start = rod_name(rod.number), self._rod_ends(rod), np.array(rod.start)
        if not rod.segments and rod.kind == "free":
            for end, place in ends.items():
                self.network.free(end, place)
            return
        for end, place in ends.items():
            self._stand(end, place, rod.kind)
        if rod.kind in ("fixed", "coupled") or not rod.segments:
            return
        along = np.array(rod.end) - start
        length, turn = float(np.linalg.norm(along)), _upright(along)
        made = _Assembly()
        made.add_rod(
            self.kinds[rod.rod_type], np.zeros(3), np.array([0.0, 0.0, length]), rod.segments, self.site.density
        )
        made.points = {end: np.array([0.0, 0.0, length if end.endswith("B") else 0.0]) for end in ends}
        pin = np.zeros(3) if "pinned" in rod.kind else None
        self.bodies[name] = made.body(name, start, turn, pin=pin)


def _lean(along: Array) -> float:
    """Return how far a direction is from the nearest axis."""
    unit = np.abs(along) / np.linalg.norm(along)
    return float(np.linalg.norm(np.delete(unit, int(np.argmax(unit)))))


def _upright(along: Array) -> Array:
    """Return the rotation that takes the z axis to a direction without turning about it."""
    z = along / np.linalg.norm(along)
    heading = math.atan2(z[1], z[0]) if math.hypot(z[0], z[1]) > 0.0 else 0.0
    tilt = math.atan2(math.hypot(z[0], z[1]), z[2])
    turns = rotation_matrix((0.0, 0.0, heading)) @ rotation_matrix((0.0, tilt, 0.0))
    return np.asarray(turns @ rotation_matrix((0.0, 0.0, -heading)))
