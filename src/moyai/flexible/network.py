"""The model of a flexible network: nodes with lumped mass, bars between them, the bed under them.

Every object is frozen and checks itself. Arrays run over nodes (n), bars (m) or hinges of bending (h); three components
stand last. Builders live in :mod:`moyai.flexible.build`; theory: docs/theory/flexible.md.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, BoolArray, IntArray
from moyai.core.errors import InputError
from moyai.flexible.bed import Bed as Bed
from moyai.flexible.mass_blocks import MassBlocks
from moyai.flexible.numbers import whole_numbers
from moyai.flexible.panels import NetPanels
from moyai.flexible.rings import Ring
from moyai.flexible.sheets import Sheets
from moyai.flexible.worn_law import WornRope
from moyai.sea.water import Water
from moyai.tables.lines import LineProperties

#: Kinds of node: ``FREE`` moves by its forces, ``FIXED`` stays, ``DRIVEN`` follows a prescribed motion.
FREE, FIXED, DRIVEN = 0, 1, 2
#: Form of a float for its immersion: a box or upright cylinder, or a sphere.
BOX, SPHERE = 0, 1


def _frozen(values: ArrayLike, dtype: Any, shape: tuple[int, ...], path: str) -> NDArray[Any]:
    if dtype is np.int64:
        values = whole_numbers(values, path)
    if dtype is np.bool_ and not np.isin(np.asarray(values), (0, 1)).all():
        raise InputError(f"{path} holds what is neither true nor false", parameter=path, allowed="true or false")
    array = np.array(values, dtype=dtype)
    if array.ndim < len(shape):
        array = np.array(np.broadcast_to(array, shape))
    if array.shape != shape:
        raise InputError(f"{path} has shape {array.shape}", parameter=path, allowed=str(shape))
    if array.dtype.kind == "f" and not np.isfinite(array).all():
        raise InputError(f"{path} holds a value that is not finite", parameter=path, allowed="finite numbers")
    array = np.ascontiguousarray(array)
    array.setflags(write=False)
    return array


def _require(ok: bool, message: str, path: str, allowed: str, remedy: str = "") -> None:
    if not ok:
        raise InputError(message, parameter=path, allowed=allowed, remedy=remedy)


@dataclass(frozen=True, eq=False)
class RopeCurve:
    """Tension of a rope over its strain, joined linearly between the points and continued with the last slope.

    Raises
    ------
    InputError
        When the points do not rise from (0, 0).
    """

    #: Engineering strain L/L0 - 1 [-], rising, the first 0.
    strain: Array
    #: Tension [N], rising, the first 0.
    tension: Array

    def __post_init__(self) -> None:
        size = int(np.size(self.strain))
        _require(size >= 2, f"a rope curve of {size} point(s)", "curve.strain", "two points or more")
        for name in ("strain", "tension"):
            array = _frozen(getattr(self, name), np.float64, (size,), f"curve.{name}")
            object.__setattr__(self, name, array)
            _require(array[0] == 0.0, f"{name} of a rope curve starts at {array[0]:g}", f"curve.{name}", "0 first")
            _require(
                bool(np.all(np.diff(array) > 0.0)),
                f"{name} of a rope curve does not rise",
                f"curve.{name}",
                "rising values",
            )

    @property
    def stiffness(self) -> Array:
        """Slope EA of each piece [N]."""
        return np.diff(self.tension) / np.diff(self.strain)


@dataclass(frozen=True)
class SlowStretch:
    """A rope that gives way slowly: spring parallel to dashpot, in series with the fast one [eq:flexible-slow-stretch].

    Raises
    ------
    InputError
        For values that are not positive, a growth below zero.
    """

    #: EA of the whole rope under a load that stays [N], below its axial stiffness.
    static_stiffness: float
    #: Of the dashpot parallel to the slow spring [N s].
    viscosity: float
    #: Axial stiffness per mean tension that it grows with [-].
    growth: float = 0.0

    def __post_init__(self) -> None:
        for key in ("static_stiffness", "viscosity"):
            value = getattr(self, key)
            _require(math.isfinite(value) and value > 0.0, f"{key} of a slow rope is {value:g}", key, "greater than 0")
        _require(math.isfinite(self.growth) and self.growth >= 0.0, f"growth is {self.growth:g}", "growth", "0 or more")


@dataclass(frozen=True, eq=False)
class BarType:
    """What a bar is made of.

    Raises
    ------
    InputError
        For a value that is negative or, where a zero makes no sense, zero.
    """

    #: For messages and reports.
    name: str
    #: In air, per unstretched metre [kg/m].
    mass_per_length: float
    #: EA [N] (with ``curve`` its slope at zero strain is taken instead).
    axial_stiffness: float
    #: Diameter of the drag and of the contact with the bed [m].
    diameter: float
    #: Displaced volume [m2]; pi d^2 / 4 when left out.
    volume_per_length: float = -1.0
    #: Internal damping BA [N s]: force per rate of strain. A property of the material, not of the mesh.
    viscosity: float = 0.0
    #: Force per length rho/2 C d u|u| [-].
    drag_normal: float = 0.0
    #: Force per length rho/2 C d u|u| [-].
    drag_tangential: float = 0.0
    #: On the displaced volume [-].
    added_mass_normal: float = 0.0
    #: On the displaced volume [-].
    added_mass_tangential: float = 0.0
    #: EI [N m2].
    bending_stiffness: float = 0.0
    #: Whether the bar goes slack instead of bearing compression.
    tension_only: bool = True
    #: Nonlinear tension over strain.
    curve: RopeCurve | None = None
    #: How it gives way slowly; ``axial_stiffness`` then is that of quick changes.
    slow: SlowStretch | WornRope | None = None

    def __post_init__(self) -> None:
        if self.volume_per_length == -1.0:
            object.__setattr__(self, "volume_per_length", math.pi / 4.0 * self.diameter**2)
        if self.curve is not None:
            object.__setattr__(self, "axial_stiffness", float(self.curve.stiffness[0]))
        for key in ("mass_per_length", "axial_stiffness"):
            value = getattr(self, key)
            _require(
                math.isfinite(value) and value > 0.0, f"{key} of {self.name!r} is {value:g}", key, "greater than 0"
            )
        if self.slow is not None:
            _require(self.curve is None, f"{self.name!r} has a curve and slow stretch", "slow", "one of them")
        if isinstance(self.slow, SlowStretch):
            _require(
                self.slow.static_stiffness < self.axial_stiffness,
                f"the static stiffness of {self.name!r} is {self.slow.static_stiffness:g} N, that of quick changes "
                f"{self.axial_stiffness:g} N",
                "slow.static_stiffness",
                "less than axial_stiffness",
            )
        for key in (
            "diameter", "volume_per_length", "viscosity", "drag_normal", "drag_tangential", "added_mass_normal",
            "added_mass_tangential", "bending_stiffness",
        ):  # fmt: skip
            value = getattr(self, key)
            _require(math.isfinite(value) and value >= 0.0, f"{key} of {self.name!r} is {value:g}", key, "0 or more")

    @property
    def wave_speed(self) -> float:
        """Speed of elastic waves sqrt(EA/m) [m/s], at zero strain for a rope curve."""
        return math.sqrt(self.axial_stiffness / self.mass_per_length)

    @property
    def impedance(self) -> float:
        """Tension of a wave front per jump of speed, sqrt(EA m) [N s/m]."""
        return math.sqrt(self.axial_stiffness * self.mass_per_length)

    def submerged_weight_per_length(self, water: Water) -> float:
        """Weight in water per unstretched metre [N/m]."""
        return (self.mass_per_length - water.density * self.volume_per_length) * water.gravity

    @classmethod
    def from_properties(cls, properties: LineProperties, *, viscosity: float) -> BarType:
        """Return the type of a catalogue entry (:func:`moyai.tables.lines.line_type`) with a viscosity [N s]."""
        return cls(
            name=properties.name,
            mass_per_length=properties.mass_per_length,
            axial_stiffness=properties.axial_stiffness,
            diameter=properties.diameter,
            volume_per_length=properties.volume_per_length,
            viscosity=viscosity,
            drag_normal=properties.drag_normal,
            drag_tangential=properties.drag_tangential,
            added_mass_normal=properties.added_mass_normal,
            added_mass_tangential=properties.added_mass_tangential,
        )


@dataclass(frozen=True, eq=False)
class Nodes:
    """The nodes and what is attached to them (floats, clump weights, sinkers, joints)."""

    #: Start position; of driven nodes the place from which their motion counts [m]; shape (n, 3).
    position: Array
    #: ``FREE``, ``FIXED`` or ``DRIVEN``; shape (n,).
    kind: IntArray
    #: Components that do not move although the node is free (a float held at the surface, a planar problem); shape (n,
    #: 3).
    held: BoolArray = field(default_factory=lambda: np.zeros((), dtype=np.bool_))
    #: Index into :attr:`Network.motion_names` of driven nodes, -1 of others; shape (n,).
    motion: IntArray = field(default_factory=lambda: np.full((), -1, dtype=np.int64))
    #: Attached mass [kg]; shape (n,).
    mass: Array = field(default_factory=lambda: np.zeros(()))
    #: Volume [m3]; shape (n,).
    volume: Array = field(default_factory=lambda: np.zeros(()))
    #: Drag coefficient times area [m2]; shape (n,).
    drag_area: Array = field(default_factory=lambda: np.zeros(()))
    #: Added mass [kg]; shape (n,).
    added_mass: Array = field(default_factory=lambda: np.zeros(()))
    #: Contact area with the bed [m2]; shape (n,).
    contact_area: Array = field(default_factory=lambda: np.zeros(()))
    #: Vertical extent of the attached body for its partial immersion [m]; 0 for one that is always wet; shape (n,).
    height: Array = field(default_factory=lambda: np.zeros(()))
    #: ``BOX`` or ``SPHERE``: how the immersed part of the height becomes a part of the volume; shape (n,).
    form: IntArray = field(default_factory=lambda: np.zeros((), dtype=np.int64))

    def __post_init__(self) -> None:
        size = len(self.position)
        _require(size > 0, "a network without nodes", "nodes.position", "one node or more")
        object.__setattr__(self, "position", _frozen(self.position, np.float64, (size, 3), "nodes.position"))
        object.__setattr__(self, "held", _frozen(self.held, np.bool_, (size, 3), "nodes.held"))
        for name in ("kind", "motion", "form"):
            object.__setattr__(self, name, _frozen(getattr(self, name), np.int64, (size,), f"nodes.{name}"))
        for name in ("mass", "volume", "drag_area", "added_mass", "contact_area", "height"):
            array = _frozen(getattr(self, name), np.float64, (size,), f"nodes.{name}")
            _require(
                bool(np.all(array >= 0.0)),
                f"{name} of node {int(np.argmin(array))} is {array.min():g}",
                f"nodes.{name}",
                "0 or more",
            )
            object.__setattr__(self, name, array)
        _require(
            bool(np.isin(self.kind, (FREE, FIXED, DRIVEN)).all()),
            "unknown kind of node",
            "nodes.kind",
            "FREE, FIXED, DRIVEN",
        )
        _require(bool(np.isin(self.form, (BOX, SPHERE)).all()), "unknown form of float", "nodes.form", "BOX, SPHERE")

    def __len__(self) -> int:
        return int(self.position.shape[0])


@dataclass(frozen=True, eq=False)
class Bars:
    """The bars: straight, elastic, each of one type."""

    #: Nodes; shape (m,).
    start: IntArray
    #: Nodes; shape (m,).
    end: IntArray
    #: Unstretched lengths [m]; shape (m,).
    length: Array
    #: Index into ``types``; shape (m,).
    kind: IntArray
    #: The materials.
    types: tuple[BarType, ...]
    #: Factor on the water velocity that meets the bar (1; less in the wake of others); shape (m,).
    flow_factor: Array = field(default_factory=lambda: np.ones(()))

    def __post_init__(self) -> None:
        size = int(np.size(self.start))
        for name in ("start", "end", "kind"):
            object.__setattr__(self, name, _frozen(getattr(self, name), np.int64, (size,), f"bars.{name}"))
        for name in ("length", "flow_factor"):
            object.__setattr__(self, name, _frozen(getattr(self, name), np.float64, (size,), f"bars.{name}"))
        if size == 0:
            return
        _require(
            bool(np.all(self.length > 0.0)),
            f"bar {int(np.argmin(self.length))} has length {self.length.min():g} m",
            "bars.length",
            "greater than 0",
        )
        _require(bool(np.all(self.flow_factor >= 0.0)), "a flow factor is negative", "bars.flow_factor", "0 or more")
        _require(
            bool(np.all(self.start != self.end)), "a bar starts and ends at the same node", "bars.end", "two nodes"
        )
        _require(
            bool(np.all((self.kind >= 0) & (self.kind < len(self.types)))),
            "a bar has an unknown type",
            "bars.kind",
            f"0 to {len(self.types) - 1}",
        )

    def __len__(self) -> int:
        return int(self.start.size)

    def of_type(self, name: str) -> Array:
        """Return one property of the types, spread over the bars."""
        return np.array([float(getattr(kind, name)) for kind in self.types])[self.kind] if self.types else np.zeros(0)


@dataclass(frozen=True, eq=False)
class Strand:
    """A named string of bars, from its first node to its last (a mooring line, a twine, a row of a net)."""

    #: For results and messages.
    name: str
    #: Nodes in order.
    nodes: IntArray
    #: Bars in order, one less than nodes.
    bars: IntArray

    def __post_init__(self) -> None:
        for name in ("nodes", "bars"):
            array = np.array(whole_numbers(getattr(self, name), f"strand.{name}"))
            array.setflags(write=False)
            object.__setattr__(self, name, array)


@dataclass(frozen=True, eq=False)
class Network:
    """A network ready for statics and dynamics.

    Raises
    ------
    InputError
        For bars that name absent nodes, nodes that can move but have no mass, parts without any hold, nodes deep under
        the bed, driven nodes without motion.
    """

    #: The parts.
    nodes: Nodes
    #: The parts.
    bars: Bars
    #: Depth, density, gravity.
    water: Water
    #: Contact with the bed; none when left out.
    bed: Bed | None = None
    #: Named lines.
    strands: tuple[Strand, ...] = ()
    #: Named nodes.
    points: Mapping[str, int] = field(default_factory=dict)
    #: Names of the prescribed motions that driven nodes follow.
    motion_names: tuple[str, ...] = ()
    #: Triangles between nodes.
    sheets: Sheets | None = None
    #: Dense added mass of groups of nodes.
    blocks: MassBlocks | None = None
    #: Pieces of net that the water loads by a law.
    panels: NetPanels | None = None
    #: Elastic rings that are curved at rest.
    rings: tuple[Ring, ...] = ()

    def __post_init__(self) -> None:
        from moyai.flexible.checks import check_network

        check_network(self)

    def strand(self, name: str) -> Strand:
        """Return the strand of this name.

        Raises
        ------
        InputError
            When there is none.
        """
        for strand in self.strands:
            if strand.name == name:
                return strand
        raise InputError(
            f"no strand {name!r}", parameter="strand", allowed=", ".join(s.name for s in self.strands) or "none"
        )

    def point(self, name: str) -> int:
        """Return the node of a named point.

        Raises
        ------
        InputError
            When there is none.
        """
        if name not in self.points:
            raise InputError(f"no point {name!r}", parameter="point", allowed=", ".join(self.points) or "none")
        return self.points[name]

    @property
    def node_mass(self) -> Array:
        """Mass of every node: what is attached, half of each bar and a third of each triangle [kg]."""
        half = 0.5 * self.bars.of_type("mass_per_length") * self.bars.length
        mass = np.array(self.nodes.mass)
        np.add.at(mass, self.bars.start, half)
        np.add.at(mass, self.bars.end, half)
        return mass if self.sheets is None else mass + self.sheets.node_share(self.sheets.bulk[0], len(self.nodes))

    @property
    def node_volume(self) -> Array:
        """Displaced volume of every node, wholly wet: what is attached, half of each bar, a third of each triangle."""
        half = 0.5 * self.bars.of_type("volume_per_length") * self.bars.length
        volume = np.array(self.nodes.volume)
        np.add.at(volume, self.bars.start, half)
        np.add.at(volume, self.bars.end, half)
        return volume if self.sheets is None else volume + self.sheets.node_share(self.sheets.bulk[1], len(self.nodes))

    @property
    def node_contact_area(self) -> Array:
        """Contact area of every node with the bed [m2]."""
        half = 0.5 * self.bars.of_type("diameter") * self.bars.length
        area = np.array(self.nodes.contact_area)
        np.add.at(area, self.bars.start, half)
        np.add.at(area, self.bars.end, half)
        return area
