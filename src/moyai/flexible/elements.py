"""The parts of a flexible network: nodes with lumped mass, kinds of bars, the bars between nodes, named lines.

Every object is frozen and checks itself. Arrays run over nodes (n), bars (m) or hinges of bending (h); three components
stand last.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from moyai.core.arrays import Array, BoolArray, IntArray
from moyai.core.options import checks_words
from moyai.flexible.numbers import frozen, require, whole_numbers
from moyai.flexible.worn_law import WornRope
from moyai.sea.water import Water
from moyai.tables.lines import LineProperties

#: Kinds of node: ``FREE`` moves by its forces, ``FIXED`` stays, ``DRIVEN`` follows a prescribed motion.
FREE, FIXED, DRIVEN = 0, 1, 2
#: Form of a float for its immersion: a box or upright cylinder, or a sphere.
BOX, SPHERE = 0, 1


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
        require(size >= 2, f"a rope curve of {size} point(s)", "curve.strain", "two points or more")
        for name in ("strain", "tension"):
            array = frozen(getattr(self, name), np.float64, (size,), f"curve.{name}")
            object.__setattr__(self, name, array)
            require(array[0] == 0.0, f"{name} of a rope curve starts at {array[0]:g}", f"curve.{name}", "0 first")
            require(
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
            require(math.isfinite(value) and value > 0.0, f"{key} of a slow rope is {value:g}", key, "greater than 0")
        require(math.isfinite(self.growth) and self.growth >= 0.0, f"growth is {self.growth:g}", "growth", "0 or more")


@checks_words
@dataclass(frozen=True, eq=False)
class BarType:
    """What a bar is made of.

    Raises
    ------
    InputError
        For a value that is negative or, where a zero makes no sense, zero.

    Examples
    --------
    >>> from moyai.flexible import BarType
    >>> chain = BarType("chain", mass_per_length=20.0, axial_stiffness=8e7, diameter=0.06, drag_normal=1.2)
    >>> chain.wave_speed                                                 # speed of an elastic wave, sqrt(EA / m) [m/s]
    2000.0
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
    #: Drag coefficient C of the force per length rho/2 C d u|u| across the bar [-].
    drag_normal: float = 0.0
    #: The same along the bar [-].
    drag_tangential: float = 0.0
    #: Added-mass coefficient across the bar, on the displaced volume [-].
    added_mass_normal: float = 0.0
    #: The same along the bar [-].
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
            require(math.isfinite(value) and value > 0.0, f"{key} of {self.name!r} is {value:g}", key, "greater than 0")
        if self.slow is not None:
            require(self.curve is None, f"{self.name!r} has a curve and slow stretch", "slow", "one of them")
        if isinstance(self.slow, SlowStretch):
            require(
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
            require(math.isfinite(value) and value >= 0.0, f"{key} of {self.name!r} is {value:g}", key, "0 or more")

    @property
    def wave_speed(self) -> float:
        """Speed of elastic waves sqrt(EA/m) [m/s], at zero strain for a rope curve."""
        return math.sqrt(self.axial_stiffness / self.mass_per_length)

    @property
    def impedance(self) -> float:
        """Tension of a wave front per jump of speed, sqrt(EA m) [N s/m]."""
        return math.sqrt(self.axial_stiffness * self.mass_per_length)

    def submerged_weight_per_length(self, water: Water) -> float:
        """Return the weight in water per unstretched metre [N/m].

        Parameters
        ----------
        water : Water
            Its density and gravity count.
        """
        return (self.mass_per_length - water.density * self.volume_per_length) * water.gravity

    @classmethod
    def from_properties(cls, properties: LineProperties, *, viscosity: float) -> BarType:
        """Return the type of a catalogue entry (:func:`moyai.tables.lines.line_type`) with a viscosity [N s].

        Parameters
        ----------
        properties : LineProperties
            The entry.
        viscosity : float
            Tension over strain rate [N s].
        """
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
        require(size > 0, "a network without nodes", "nodes.position", "one node or more")
        object.__setattr__(self, "position", frozen(self.position, np.float64, (size, 3), "nodes.position"))
        object.__setattr__(self, "held", frozen(self.held, np.bool_, (size, 3), "nodes.held"))
        for name in ("kind", "motion", "form"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64, (size,), f"nodes.{name}"))
        for name in ("mass", "volume", "drag_area", "added_mass", "contact_area", "height"):
            array = frozen(getattr(self, name), np.float64, (size,), f"nodes.{name}")
            require(
                bool(np.all(array >= 0.0)),
                f"{name} of node {int(np.argmin(array))} is {array.min():g}",
                f"nodes.{name}",
                "0 or more",
            )
            object.__setattr__(self, name, array)
        require(
            bool(np.isin(self.kind, (FREE, FIXED, DRIVEN)).all()),
            "unknown kind of node",
            "nodes.kind",
            "FREE, FIXED, DRIVEN",
        )
        require(bool(np.isin(self.form, (BOX, SPHERE)).all()), "unknown form of float", "nodes.form", "BOX, SPHERE")

    def __len__(self) -> int:
        return int(self.position.shape[0])


@dataclass(frozen=True, eq=False)
class Bars:
    """The bars: straight, elastic, each of one type."""

    #: Node at the start of each; shape (m,).
    start: IntArray
    #: Node at the end of each; shape (m,).
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
            object.__setattr__(self, name, frozen(getattr(self, name), np.int64, (size,), f"bars.{name}"))
        for name in ("length", "flow_factor"):
            object.__setattr__(self, name, frozen(getattr(self, name), np.float64, (size,), f"bars.{name}"))
        if size == 0:
            return
        require(
            bool(np.all(self.length > 0.0)),
            f"bar {int(np.argmin(self.length))} has length {self.length.min():g} m",
            "bars.length",
            "greater than 0",
        )
        require(bool(np.all(self.flow_factor >= 0.0)), "a flow factor is negative", "bars.flow_factor", "0 or more")
        require(bool(np.all(self.start != self.end)), "a bar starts and ends at the same node", "bars.end", "two nodes")
        require(
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
