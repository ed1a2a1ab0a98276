"""Mooring lines and springs: what they are made of, and their force on a body for given positions of the fairlead."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.mooring import kernels, segments

if TYPE_CHECKING:
    from moyai.tables.lines import LineProperties

Vector = tuple[float, float, float]


@dataclass(frozen=True)
class LineType:
    """What a segment is made of.

    Examples
    --------
    >>> from moyai.mooring import LineType
    >>> chain = LineType("chain", submerged_weight=1000.0, axial_stiffness=5e8, breaking_load=2e6)
    >>> chain.submerged_weight                                           # [N/m]
    1000.0
    """

    #: For messages and reports.
    name: str
    #: Weight in water per unstretched metre [N/m]; negative for a buoyant rope.
    submerged_weight: float
    #: EA [N]; ``inf`` for inextensible.
    axial_stiffness: float
    #: Minimum breaking load [N]; ``inf`` where it is not known, then no check against it is made.
    breaking_load: float = math.inf

    def __post_init__(self) -> None:
        _number(self.submerged_weight, f"line_type.{self.name}.submerged_weight", positive=False)
        _number(self.axial_stiffness, f"line_type.{self.name}.axial_stiffness", infinite=True)
        _number(self.breaking_load, f"line_type.{self.name}.breaking_load", infinite=True)

    @classmethod
    def from_properties(cls, properties: LineProperties, density: float, gravity: float) -> LineType:
        """Make a line type of a catalogue entry for water of ``density`` [kg/m3] under ``gravity`` [m/s2].

        Parameters
        ----------
        properties : LineProperties
            The entry.
        density : float
            Of the water [kg/m3].
        gravity : float
            [m/s2].
        """
        return cls(
            properties.name,
            properties.submerged_weight_per_length(density, gravity),
            properties.axial_stiffness,
            properties.breaking_load,
        )


@dataclass(frozen=True)
class Segment:
    """A length of one line type.

    Examples
    --------
    >>> from moyai.mooring import LineType, Segment
    >>> chain = LineType("chain", submerged_weight=1000.0, axial_stiffness=5e8)
    >>> Segment(chain, length=55.0).length                               # [m]
    55.0
    """

    #: The material.
    line_type: LineType
    #: Unstretched length [m].
    length: float

    def __post_init__(self) -> None:
        _number(self.length, "segment.length")


@dataclass(frozen=True)
class Clump:
    """A weight or buoy at the upper end of a segment that is not the last one.

    Examples
    --------
    >>> from moyai.mooring import Clump, Line, LineType, Segment
    >>> chain = LineType("chain", submerged_weight=1000.0, axial_stiffness=5e8)
    >>> parts = (Segment(chain, 40.0), Segment(chain, 15.0))
    >>> line = Line("line 1", (50.0, 0.0, -10.0), (0.0, 0.0, 0.0), parts, clumps=(Clump(0, submerged_weight=5000.0),))
    >>> line.length                                                      # [m]
    55.0
    """

    #: Index of the segment below it, counted from 0 at the anchor.
    after_segment: int
    #: Weight in water [N]; negative for a buoy.
    submerged_weight: float


@dataclass(frozen=True)
class LineState:
    """Lines at rest for n fairlead positions."""

    #: Force of all copies on the body [N], site axes; shape (n, 3).
    force: Array
    #: Minus the derivative of ``force`` with respect to the fairlead position [N/m]; shape (n, 3, 3).
    stiffness: Array
    #: Tension of one copy at the fairlead [N]; shape (n,).
    tension_fairlead: Array
    #: Tension of one copy at the anchor [N]; shape (n,).
    tension_anchor: Array
    #: Horizontal component of one copy [N]; shape (n,).
    horizontal_tension: Array
    #: Vertical component of one copy at the fairlead [N]; shape (n,).
    vertical_tension_fairlead: Array
    #: Vertical component of one copy at the anchor [N]; shape (n,).
    vertical_tension_anchor: Array
    #: Unstretched length on the bed of one copy [m]; shape (n,).
    grounded_length: Array
    #: Angle at the anchor above the horizontal [rad]; shape (n,).
    anchor_uplift_angle: Array
    #: Error of the end position over the line length; shape (n,).
    residual: Array
    #: Codes of :mod:`moyai.mooring.kernels`; -1 for a spring; shape (n,).
    regime: IntArray


class LineElement(Protocol):
    """What a line system requires of its members."""

    @property
    def name(self) -> str:
        """Name, unique in a system."""

    @property
    def anchor(self) -> Vector:
        """Fixed end [m], site axes."""

    @property
    def fairlead(self) -> Vector:
        """End on the body [m], body axes."""

    @property
    def count(self) -> int:
        """Number of identical copies at the same place."""

    @property
    def breaking_load(self) -> float:
        """Lowest breaking load along the line [N]."""

    def solve(self, points: Array, water_depth: float) -> LineState:
        """Solve for fairlead positions (n, 3) in site axes."""


def _number(value: float, path: str, *, positive: bool = True, infinite: bool = False) -> None:
    good = not math.isnan(value) and (infinite or math.isfinite(value)) and (value > 0.0 or not positive)
    if not good:
        raise InputError(f"{value:g}", parameter=path, allowed="greater than 0" if positive else "a finite number")


def _vector(value: ArrayLike, path: str) -> Vector:
    array = np.asarray(value, dtype=float)
    if array.shape != (3,) or not np.all(np.isfinite(array)):
        raise InputError(f"{value!r} is not a position", parameter=path, allowed="three finite coordinates (x, y, z)")
    return float(array[0]), float(array[1]), float(array[2])


@dataclass(frozen=True)
class Line:
    """A mooring line of one or more segments from an anchor to a fairlead on a body.

    Raises
    ------
    InputError
        For an empty line, a clump that is not between two segments, NaN.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.mooring import Line, LineType, Segment
    >>> chain = LineType("chain", submerged_weight=1000.0, axial_stiffness=5e8, breaking_load=2e6)
    >>> line = Line("line 1", anchor=(50.0, 0.0, -10.0), fairlead=(0.0, 0.0, 0.0), segments=(Segment(chain, 55.0),))
    >>> state = line.solve(np.array([[0.0, 0.0, 0.0]]), water_depth=10.0)
    >>> round(float(state.tension_fairlead[0]) / 1000.0, 2)              # [kN]
    16.04
    """

    #: Unique name.
    name: str
    #: Position of the anchor (x, y, z) [m], site axes, z up from still water.
    anchor: Vector
    #: Position of the fairlead (x, y, z) [m], body axes (equal to site axes at zero motion).
    fairlead: Vector
    #: From the anchor to the fairlead.
    segments: tuple[Segment, ...]
    #: Weights or buoys between segments.
    clumps: tuple[Clump, ...] = ()
    #: Coulomb coefficient of the bed [-].
    bed_friction: float = 0.0
    #: Number of identical copies at the same place.
    count: int = 1

    def __post_init__(self) -> None:
        path = f"lines.{self.name}"
        object.__setattr__(self, "anchor", _vector(self.anchor, f"{path}.anchor"))
        object.__setattr__(self, "fairlead", _vector(self.fairlead, f"{path}.fairlead"))
        object.__setattr__(self, "segments", tuple(self.segments))
        object.__setattr__(self, "clumps", tuple(self.clumps))
        if not self.segments:
            raise InputError("a line needs at least one segment", parameter=f"{path}.segments")
        if self.count < 1:
            raise InputError(f"{self.count} copies", parameter=f"{path}.count", allowed="1 or more")
        if not (math.isfinite(self.bed_friction) and self.bed_friction >= 0.0):
            raise InputError(f"{self.bed_friction:g}", parameter=f"{path}.bed_friction", allowed="0 or more")
        for clump in self.clumps:
            _number(clump.submerged_weight, f"{path}.clumps", positive=False)
            if not 0 <= clump.after_segment < len(self.segments) - 1:
                raise InputError(
                    f"clump after segment {clump.after_segment}",
                    parameter=f"{path}.clumps",
                    allowed=f"0 to {len(self.segments) - 2} (between two segments)",
                )

    @cached_property
    def length(self) -> float:
        """Unstretched length of the whole line [m]."""
        return float(sum(segment.length for segment in self.segments))

    @property
    def breaking_load(self) -> float:
        """Lowest breaking load along the line [N]."""
        return min(segment.line_type.breaking_load for segment in self.segments)

    @cached_property
    def table(self) -> Array:
        """One row a segment for the kernels: length [m], EA [N], submerged weight [N/m], clump at its upper end [N]."""
        rows = np.zeros((len(self.segments), 4))
        for row, segment in zip(rows, self.segments):
            row[:3] = segment.length, segment.line_type.axial_stiffness, segment.line_type.submerged_weight
        for clump in self.clumps:
            rows[clump.after_segment, 3] += clump.submerged_weight
        return rows

    @cached_property
    def is_uniform(self) -> bool:
        """Whether the line is one material throughout."""
        rows = self.table
        return bool(np.all(rows[:, 1:3] == rows[0, 1:3]) and np.all(rows[:-1, 3] == 0.0))

    @cached_property
    def _mean_properties(self) -> tuple[float, float]:
        """EA and submerged weight per metre of a uniform line with the stretch and the weight of this one."""
        rows = self.table
        soft = float((rows[:, 0] / rows[:, 1]).sum())
        weight = float((rows[:, 0] * rows[:, 2]).sum() + rows[:-1, 3].sum())
        return (self.length / soft if soft > 0.0 else math.inf), weight / self.length

    def bed_clearance(self, water_depth: float) -> float:
        """Return the height of the anchor over the bed [m]; -1 (no bed) in infinite depth.

        Parameters
        ----------
        water_depth : float
            [m]; infinite where there is no bed.

        Raises
        ------
        InputError
            When the anchor lies under the bed.
        """
        if math.isinf(water_depth):
            return kernels.NO_BED
        clearance = self.anchor[2] + water_depth
        if abs(clearance) <= 1e-6 * max(1.0, water_depth):
            return 0.0
        if clearance < 0.0:
            raise InputError(
                f"the anchor lies {-clearance:g} m under the bed (z = {self.anchor[2]:g} m, depth {water_depth:g} m)",
                parameter=f"lines.{self.name}.anchor",
                allowed=f"z of {-water_depth:g} m or higher",
            )
        return clearance

    def solve_plane(self, horizontal: Array, vertical: Array, water_depth: float) -> tuple[Array, IntArray]:
        """Solve in the line's own vertical plane for distances (n,) from anchor to fairlead [m].

        Parameters
        ----------
        horizontal, vertical : ndarray (n,)
            From anchor to fairlead, vertical positive upwards [m].
        water_depth : float
            [m].

        Returns
        -------
        tuple
            Array (n, 11): H fairlead, V fairlead, H anchor, V anchor, grounded length, dH/dX, dH/dZ, dV/dX, dV/dZ,
            residual over length, q (vertical tension at the anchor or minus the bed reaction); and regimes (n,).

        Raises
        ------
        InputError
            When the anchor lies under the bed.
        """
        rows = self.table
        clearance = self.bed_clearance(water_depth)
        x, z = np.ascontiguousarray(horizontal), np.ascontiguousarray(vertical)
        out = np.empty((x.size, 11))
        regime = np.empty(x.size, dtype=np.int64)
        axial, weight = self._mean_properties
        kernels.solve_line_batch(x, z, self.length, axial, weight, clearance, self.bed_friction, out, regime)
        if not self.is_uniform:
            # the uniform line of mean properties is the first guess
            start = np.where(np.isfinite(out[:, 0]), out[:, 0], 0.0)
            segments.solve_segments_batch(x, z, rows, clearance, self.bed_friction, start, out, regime)
        return out, regime

    def solve(self, points: Array, water_depth: float) -> LineState:
        """Solve for fairlead positions (n, 3) [m], site axes; see :class:`LineState`.

        Parameters
        ----------
        points : array_like (n, 3)
            Fairlead positions in site axes [m].
        water_depth : float
            [m].

        Raises
        ------
        InputError
            When the anchor lies under the bed.
        """
        span = np.asarray(points, dtype=float).reshape(-1, 3) - np.asarray(self.anchor)
        out, regime = self.solve_plane(np.hypot(span[:, 0], span[:, 1]), span[:, 2], water_depth)
        force, stiffness = np.empty((len(span), 3)), np.empty((len(span), 3, 3))
        kernels.plane_to_space(span, out, self.count, force, stiffness)
        return LineState(
            force=force,
            stiffness=stiffness,
            tension_fairlead=np.hypot(out[:, 0], out[:, 1]),
            tension_anchor=np.hypot(out[:, 2], out[:, 3]),
            horizontal_tension=out[:, 0],
            vertical_tension_fairlead=out[:, 1],
            vertical_tension_anchor=out[:, 3],
            grounded_length=out[:, 4],
            anchor_uplift_angle=np.arctan2(out[:, 3], out[:, 2]),
            residual=out[:, 9],
            regime=regime,
        )


@checks_words
@dataclass(frozen=True)
class SpringLine:
    """A straight weightless linear spring between a fixed point and the body, for flume tests and soft guides.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.mooring import SpringLine
    >>> spring = SpringLine("spring", (10.0, 0.0, 0.0), (0.0, 0.0, 0.0), stiffness=500.0, pretension=100.0)
    >>> state = spring.solve(np.array([[-0.1, 0.0, 0.0]]), water_depth=10.0)
    >>> round(float(state.tension_fairlead[0]), 3)                       # 100 + 500 * 0.1 [N]
    150.0
    """

    #: Name, as for :class:`Line`.
    name: str
    #: Anchor, as for :class:`Line`.
    anchor: Vector
    #: Fairlead, as for :class:`Line`.
    fairlead: Vector
    #: [N/m].
    stiffness: float
    #: Tension at zero motion of the body [N]; may be negative unless ``tension_only``.
    pretension: float
    #: Whether the spring goes slack instead of pushing.
    tension_only: bool = False
    #: As for :class:`Line`.
    count: int = 1
    #: [N]; ``inf`` where it is not known.
    breaking_load: float = math.inf

    def __post_init__(self) -> None:
        path = f"lines.{self.name}"
        object.__setattr__(self, "anchor", _vector(self.anchor, f"{path}.anchor"))
        object.__setattr__(self, "fairlead", _vector(self.fairlead, f"{path}.fairlead"))
        _number(self.stiffness, f"{path}.stiffness")
        _number(self.pretension, f"{path}.pretension", positive=False)
        if self.count < 1:
            raise InputError(f"{self.count} copies", parameter=f"{path}.count", allowed="1 or more")
        if math.dist(self.anchor, self.fairlead) == 0.0:
            raise InputError("the spring has no length", parameter=f"{path}.anchor", remedy="move the anchor")

    @property
    def natural_length(self) -> float:
        """Length at which the spring carries nothing [m]; may be negative when strongly pretensioned."""
        return math.dist(self.anchor, self.fairlead) - self.pretension / self.stiffness

    def solve(self, points: Array, water_depth: float) -> LineState:
        """Solve for fairlead positions (n, 3) [m], site axes; the water depth plays no part.

        Parameters
        ----------
        points : array_like (n, 3)
            Fairlead positions in site axes [m].
        water_depth : float
            Plays no part [m].
        """
        span = np.asarray(points, dtype=float).reshape(-1, 3) - np.asarray(self.anchor)
        length = np.maximum(np.linalg.norm(span, axis=1), 1e-300)
        unit = span / length[:, None]
        tension = self.stiffness * (length - self.natural_length)
        rate = np.full_like(tension, self.stiffness)
        if self.tension_only:
            slack = tension <= 0.0
            tension = np.where(slack, 0.0, tension)
            rate = np.where(slack, 0.0, rate)
        along = unit[:, :, None] * unit[:, None, :]
        stiffness = rate[:, None, None] * along + (tension / length)[:, None, None] * (np.eye(3) - along)
        zero = np.zeros_like(tension)
        horizontal = tension * np.hypot(unit[:, 0], unit[:, 1])
        vertical = tension * unit[:, 2]
        return LineState(
            force=-self.count * tension[:, None] * unit,
            stiffness=self.count * stiffness,
            tension_fairlead=tension,
            tension_anchor=tension,
            horizontal_tension=horizontal,
            vertical_tension_fairlead=vertical,
            vertical_tension_anchor=vertical,
            grounded_length=zero,
            anchor_uplift_angle=np.arctan2(unit[:, 2], np.hypot(unit[:, 0], unit[:, 1])),
            residual=zero,
            regime=np.full(len(tension), -1, dtype=np.int64),
        )
