"""The parts of a rigid cage: spherical floats, net in patches, rods, weights, and the body that they make together."""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.morison.net_law_names import Net, NetLaw
from moyai.morison.net_wake import WakeName


def _points(values: object, name: str) -> Array:
    array = np.array(values, dtype=float).reshape(-1, 3)
    if not np.isfinite(array).all():
        raise InputError(f"{name} holds a value that is not finite", parameter=name)
    array.setflags(write=False)
    return array


def _not_negative(owner: object, *names: str) -> None:
    for name in names:
        value = getattr(owner, name)
        if not (math.isfinite(value) and value >= 0.0):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="at least 0")


@dataclass(frozen=True, eq=False)
class Floats:
    """Equal spheres."""

    #: Centres from the middle of the cage [m]; shape (n, 3).
    points: Array
    #: Of one sphere [m].
    diameter: float
    #: Of one sphere [kg].
    mass: float
    #: C_d on the disc of the sphere [-].
    drag: float
    #: C_a on the volume of the sphere [-].
    added_mass: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", _points(self.points, "floats"))
        _not_negative(self, "mass", "drag", "added_mass")
        if not (math.isfinite(self.diameter) and self.diameter > 0.0):
            raise InputError(
                f"diameter is {self.diameter:g} m", parameter="floats.diameter", allowed="greater than 0 m"
            )

    @property
    def volume(self) -> float:
        """Volume of one sphere [m3]."""
        return math.pi / 6.0 * self.diameter**3


@dataclass(frozen=True, eq=False)
class Patches:
    """Small plane pieces of net."""

    #: Middles from the middle of the cage [m]; shape (n, 3).
    points: Array
    #: Unit normals, either side; shape (n, 3).
    normals: Array
    #: Outline areas [m2]; shape (n,).
    areas: Array
    #: Half extent in the panel along its line of steepest slope [m]; shape (n,).
    halves: Array
    #: Mean of (x^2 + z^2) over the patch about its own middle [m2]; shape (n,).
    spread: Array

    @property
    def area(self) -> float:
        """Outline area of all patches [m2]."""
        return float(self.areas.sum())


def join(parts: list[Patches]) -> Patches:
    """Return all patches of several faces."""
    if not parts:
        none = np.zeros(0)
        return Patches(np.zeros((0, 3)), np.zeros((0, 3)), none, none, none)
    names = ("points", "normals", "areas", "halves", "spread")
    return Patches(*(np.concatenate([getattr(part, name) for part in parts]) for name in names))


def rectangle(corner: object, first: object, second: object, count: int) -> Patches:
    """Return a rectangular face in ``count`` x ``count`` patches about the points of Gauss.

    Parameters
    ----------
    corner, first, second : array_like, shape (3,)
        A corner and the two edges that leave it [m].
    count : int
        Patches along each edge.
    """
    origin, a, b = (np.asarray(item, dtype=float) for item in (corner, first, second))
    nodes, weights = np.polynomial.legendre.leggauss(count)
    share, part = 0.5 * (1.0 + nodes), 0.5 * weights
    i, j = (item.reshape(-1) for item in np.meshgrid(np.arange(count), np.arange(count), indexing="ij"))
    normal = np.cross(a, b)
    area = float(np.linalg.norm(normal))
    # the half height of a patch; a level face has none, and its half edge serves when it tilts
    steep = abs(float(a[2])) > abs(float(b[2]))
    level = max(abs(float(a[2])), abs(float(b[2]))) < 1e-9 * math.sqrt(area)
    half = 0.5 * np.where(steep, part[i] * abs(a[2]), part[j] * abs(b[2]))
    if level:
        half = 0.5 * np.maximum(part[i] * np.linalg.norm(a), part[j] * np.linalg.norm(b))
    # two points of Gauss or more carry the second moments exactly
    spread = (a[0] ** 2 + a[2] ** 2 + b[0] ** 2 + b[2] ** 2) / 12.0 if count == 1 else 0.0
    return Patches(
        origin + share[i][:, None] * a + share[j][:, None] * b,
        np.tile(normal / area, (count * count, 1)),
        area * part[i] * part[j],
        np.asarray(half, dtype=float),
        np.full(count * count, float(spread)),
    )


def cylinder_wall(radius: float, low: float, high: float, count: int) -> Patches:
    """Return an upright cylindrical wall in ``4 count`` x ``count`` patches between two heights [m]."""
    around, rows = 4 * count, count
    angle = (np.arange(around) + 0.5) * 2.0 * math.pi / around
    height = (high - low) / rows
    level = low + (np.arange(rows) + 0.5) * height
    a, z = (item.reshape(-1) for item in np.meshgrid(angle, level, indexing="ij"))
    half_arc = math.pi / around
    # the middle of mass of an arc lies inside its radius; kept on the mean square so that the inertia is exact
    reach = radius * math.sin(half_arc) / half_arc
    normals = np.column_stack([np.cos(a), np.sin(a), np.zeros(a.size)])
    points = np.column_stack([reach * np.cos(a), reach * np.sin(a), z])
    mean_square = radius**2 * (0.5 + np.cos(2.0 * a) * math.sin(2.0 * half_arc) / (4.0 * half_arc))
    spread = mean_square - points[:, 0] ** 2 + height**2 / 12.0
    area = 2.0 * math.pi * radius * (high - low) / (around * rows)
    return Patches(points, normals, np.full(a.size, area), np.full(a.size, 0.5 * height), spread)


def disc(radius: float, level: float, count: int) -> Patches:
    """Return a level disc in ``4 count`` sectors of ``count`` rings of equal width [m]."""
    around = 4 * count
    edges = radius * np.arange(count + 1) / count
    angle = (np.arange(around) + 0.5) * 2.0 * math.pi / around
    half = math.pi / around
    points, areas, halves, spread = [], [], [], []
    for inner, outer in itertools.pairwise(edges):
        area = half * (outer**2 - inner**2)
        reach = 2.0 / 3.0 * (outer**3 - inner**3) / (outer**2 - inner**2) * math.sin(half) / half
        square = 0.25 * (outer**4 - inner**4) * (half + 0.5 * np.cos(2.0 * angle) * math.sin(2.0 * half)) / area
        for n, a in enumerate(angle):
            points.append((reach * math.cos(a), reach * math.sin(a), level))
            areas.append(area)
            halves.append(0.5 * (outer - inner))
            spread.append(square[n] - (reach * math.cos(a)) ** 2)
    normals = np.tile([0.0, 0.0, 1.0], (len(points), 1))
    return Patches(np.array(points), normals, np.array(areas), np.array(halves), np.array(spread))


@dataclass(frozen=True)
class Rod:
    """A round rod."""

    #: One end, from the middle of the cage [m].
    start: tuple[float, float, float]
    #: The other end, from the middle of the cage [m].
    end: tuple[float, float, float]
    #: [m].
    diameter: float
    #: [kg].
    mass: float

    @property
    def length(self) -> float:
        """[m]."""
        return math.dist(self.start, self.end)

    @property
    def volume(self) -> float:
        """[m3]."""
        return 0.25 * math.pi * self.diameter**2 * self.length


@dataclass(frozen=True)
class PointWeight:
    """A weight (or buoy, where it displaces more) at a point."""

    name: str
    #: From the middle of the cage [m].
    point: tuple[float, float, float]
    #: [kg].
    mass: float
    #: [m3].
    volume: float
    #: C_d of a sphere of that volume [-].
    drag: float
    #: C_a of a sphere of that volume [-].
    added_mass: float


@checks_words
@dataclass(frozen=True, eq=False)
class RigidCage:
    """A rigid cage, symmetric about the plane y = 0.

    Raises
    ------
    InputError
        When parts lie aside of the plane of symmetry or masses are not positive.

    Examples
    --------
    >>> from moyai.structures import model_cage
    >>> cage = model_cage()
    >>> round(cage.enclosed_volume, 6), cage.outline                     # [m3]
    (0.008, 'box')
    """

    floats: Floats
    #: Its net.
    patches: Patches
    #: Twine and mesh.
    net: Net
    #: Drag of the net.
    law: NetLaw
    #: Mass of the net per outline area [kg/m2].
    net_mass: float
    #: Solid volume of the net per outline area [m].
    net_volume: float
    #: C_a of twine [-].
    net_added_mass: float
    rods: tuple[Rod, ...]
    #: Drag coefficient of the rods [-].
    rod_drag: float
    #: Added-mass coefficient of the rods [-].
    rod_added_mass: float
    #: Length along x, width and height, for drawings and attachment points [m].
    extent: tuple[float, float, float]
    weights: tuple[PointWeight, ...] = ()
    outline: Literal["box", "cylinder"] = "box"
    #: Law by which the upstream wall shelters the net behind it from the current.
    wake: WakeName = "none"

    def __post_init__(self) -> None:
        _not_negative(self, "net_mass", "net_volume", "net_added_mass", "rod_drag", "rod_added_mass")
        if not self.mass > 0.0:
            raise InputError("the cage has no mass", parameter="mass", allowed="greater than 0 kg")

    @cached_property
    def _masses(self) -> tuple[Array, Array, Array]:
        """Mass, middle and own mean square (x, z) of every part."""
        mass, middle, own = [], [], []
        size = len(self.floats.points)
        mass.append(np.full(size, self.floats.mass))
        middle.append(self.floats.points)
        own.append(np.full(size, 0.1 * self.floats.diameter**2))  # 2/5 R^2 of a solid sphere about its diameter
        mass.append(self.net_mass * self.patches.areas)
        middle.append(self.patches.points)
        own.append(self.patches.spread)
        for rod in self.rods:
            a, b = np.array(rod.start), np.array(rod.end)
            along = (b - a) ** 2
            mass.append(np.array([rod.mass]))
            middle.append(0.5 * (a + b)[None, :])
            own.append(np.array([(along[0] + along[2]) / 12.0 + rod.diameter**2 / 16.0]))
        for weight in self.weights:
            mass.append(np.array([weight.mass]))
            middle.append(np.array([weight.point]))
            own.append(np.zeros(1))
        return np.concatenate(mass), np.concatenate(middle), np.concatenate(own)

    @property
    def mass(self) -> float:
        """Dry mass [kg]."""
        return float(self._masses[0].sum())

    @cached_property
    def centre(self) -> tuple[float, float]:
        """Centre of gravity x, z from the middle of the cage [m]."""
        mass, middle, _ = self._masses
        x, z = (mass @ middle[:, [0, 2]]) / mass.sum()
        return float(x), float(z)

    @cached_property
    def inertia(self) -> float:
        """Moment of inertia about the y axis through the centre of gravity [kg m2]."""
        mass, middle, own = self._masses
        x, z = self.centre
        return float(mass @ ((middle[:, 0] - x) ** 2 + (middle[:, 2] - z) ** 2 + own))

    @property
    def solid_volume(self) -> float:
        """Volume of net, rods and weights, floats left out [m3]."""
        rods = sum(rod.volume for rod in self.rods)
        return self.net_volume * self.patches.area + rods + sum(weight.volume for weight in self.weights)

    @property
    def float_volume(self) -> float:
        """Volume of all floats [m3]."""
        return self.floats.volume * len(self.floats.points)

    @property
    def enclosed_volume(self) -> float:
        """Volume that the nets enclose [m3]."""
        length, width, height = self.extent
        return length * width * height * (1.0 if self.outline == "box" else 0.25 * math.pi)

    @property
    def mass_without_floats(self) -> float:
        """Mass of net, frame and weights [kg]."""
        return self.mass - self.floats.mass * len(self.floats.points)

    @checks_words
    def attachment(self, where: Literal["top", "middle", "bottom"], side: float) -> tuple[float, float]:
        """Return x, z of a point on a side of the cage, from its middle [m].

        Parameters
        ----------
        where : {"top", "middle", "bottom"}
            Of the side.
        side : float
            1 at +x, -1 at -x.
        """
        level = {"top": 0.5, "middle": 0.0, "bottom": -0.5}[where]
        return side * 0.5 * self.extent[0], level * self.extent[2]
