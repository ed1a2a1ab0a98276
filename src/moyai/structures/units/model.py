"""The row of floating units as the case file states it: SI units and radians, frozen.

The frame of the row has x across, y along, z up. A unit has axes of its own, turned by its heading about z. Its six
motions are named as on a ship that lies along y: sway along x, surge along y, heave along z; pitch turns about x, roll
about y, yaw about z.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Criterion
from moyai.core.options import checks_words
from moyai.design.fatigue import EnduranceCurve
from moyai.flexible.elements import BarType
from moyai.mooring.lines import Clump, Segment
from moyai.potential.sections import Hull
from moyai.sea.environment import Environment

#: Along x, y, z and about x, y, z of the unit.
DOFS = ("sway", "surge", "heave", "pitch", "roll", "yaw")
#: Distance from a hull within which a point lies on it [m]
ON_HULL = 1e-3
#: Largest tension over the mean up to which a line at rest at every instant serves
SNAP_RATIO = 5.0
#: Factors on the damping of the units beyond waves for the band of an answer, as for a single breakwater.
DAMPING_BAND = (0.5, 2.0)
ConnectorKind = Literal["rigid", "hinge", "ball", "spring", "rubber", "chain", "fender"]
Analysis = Literal["statics", "frequency", "map", "time"]


@dataclass(frozen=True)
class Placement:
    """Middle of a unit (x, y) [m] in the frame of the row, and how far its axes are turned from it [rad]."""

    x: float
    y: float
    heading: float = 0.0

    @property
    def rotation(self) -> Array:
        """Matrix (3, 3) from axes of the unit to those of the row."""
        c, s = math.cos(self.heading), math.sin(self.heading)
        return np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def to_row(self, points: Array) -> Array:
        """Return points (..., 3) [m] of the unit in the frame of the row."""
        return np.asarray(np.asarray(points, dtype=float) @ self.rotation.T + np.array([self.x, self.y, 0.0]))


@dataclass(frozen=True)
class Curve:
    """Force [N] over elongation [m] of a connector that acts along one direction, straight between its points.

    Beyond the ends it continues with the slope of the last piece.
    """

    elongation: tuple[float, ...]
    force: tuple[float, ...]

    def at(self, elongation: Array) -> Array:
        """Return the force [N] at elongations [m]."""
        x, f = np.array(self.elongation), np.array(self.force)
        first, last = (f[1] - f[0]) / (x[1] - x[0]), (f[-1] - f[-2]) / (x[-1] - x[-2])
        e = np.asarray(elongation, dtype=float)
        inside = np.interp(e, x, f)
        return np.asarray(
            np.where(e < x[0], f[0] + first * (e - x[0]), np.where(e > x[-1], f[-1] + last * (e - x[-1]), inside))
        )

    def rounded(self, elongation: float, width: float) -> tuple[float, float]:
        """Return force [N] and slope [N/m], the mean over ``width`` [m] to either side: a curve without corners."""
        nodes = np.array(self.elongation)
        low, high = elongation - width, elongation + width
        e = np.concatenate([[low], nodes[(nodes > low) & (nodes < high)], [high]])
        force = self.at(e)
        return float(np.trapezoid(force, e)) / (2.0 * width), float(force[-1] - force[0]) / (2.0 * width)

    def worked(self, elongation: float, size: float, regular: bool) -> tuple[float, float]:
        """Return mean force [N] and its slope [N/m] where the elongation moves about its mean [eq:units-mean-force].

        ``size`` [m] is the amplitude of a harmonic, or the standard deviation of a Gaussian motion; above zero.
        """
        x, f = np.array(self.elongation), np.array(self.force)
        slopes = np.diff(f) / np.diff(x)
        u = (elongation - x[1:-1]) / size
        if regular:
            angle = np.arccos(np.clip(-u, -1.0, 1.0))
            share = angle / math.pi
            ramp = size * (u * share + np.sin(angle) / math.pi)
        else:
            from scipy.special import ndtr

            share = ndtr(u)
            ramp = size * (u * share + np.exp(-0.5 * u**2) / math.sqrt(2.0 * math.pi))
        bends = np.diff(slopes)
        force = f[0] + slopes[0] * (elongation - x[0]) + float(bends @ ramp)
        return float(force), float(slopes[0] + bends @ share)


@checks_words
@dataclass(frozen=True)
class Connector:
    """A connector between neighbours."""

    name: str
    #: ``rigid`` holds all six relative motions, ``hinge`` all but the turn about its axis, ``ball`` the three
    #: translations; ``spring`` has stiffness and damping of 6 x 6; ``rubber``, ``chain`` and ``fender`` have a curve of
    #: force over elongation, along one direction or from end to end.
    kind: ConnectorKind
    #: Units that it joins, counted from 0.
    pairs: tuple[tuple[int, int], ...]
    #: Across from the centre line [m]; along, it is in the middle of the gap.
    x: float = 0.0
    #: Above the keel [m].
    above_keel: float = 0.0
    #: Axis of a hinge, direction of a curve, in axes of the gap.
    axis: tuple[float, float, float] = (1.0, 0.0, 0.0)
    #: Of a spring [N/m, N, N m]; shape (6, 6).
    stiffness: Array | None = None
    #: Of a spring [N s/m, N s, N m s]; shape (6, 6).
    damping: Array | None = None
    curve: Curve | None = None
    #: Of a curve, per rate of elongation [N s/m].
    linear_damping: float = 0.0
    #: Largest resultant force [N]; infinite where it is not known.
    breaking_load: float = math.inf
    #: Cycles that it withstands over the range of its force [N].
    endurance: EnduranceCurve | None = None
    #: Whether chain or rubber is drawn between its ends in space; else a curve acts along ``axis`` alone.
    end_to_end: bool = False


@dataclass(frozen=True)
class UnitLine:
    """Identical lines of one unit; a spring of a laboratory has ``stiffness`` and no segments."""

    name: str
    count: int
    #: Units that have it, counted from 0.
    units: tuple[int, ...]
    #: x across, y along from the middle of the unit, z above the keel [m].
    fairlead: tuple[float, float, float]
    #: x, y from the middle of the unit, in its axes [m]; z above the bed, of a spring from still water at datum.
    anchor: tuple[float, float, float]
    #: Segments of :class:`moyai.mooring.Line`.
    segments: tuple[Segment, ...] = ()
    #: Clumps of :class:`moyai.mooring.Line`.
    clumps: tuple[Clump, ...] = ()
    #: Friction of the bed as of :class:`moyai.mooring.Line`.
    bed_friction: float = 0.0
    #: Of a spring [N/m].
    stiffness: float = 0.0
    #: Of a spring [N].
    pretension: float = 0.0
    #: What the segments are made of, for a line in motion; empty where a segment does not give enough.
    bar_types: tuple[BarType, ...] = ()
    #: Mass [kg] and volume [m3] of the clumps.
    clump_bodies: tuple[tuple[float, float], ...] = ()


@dataclass(frozen=True, eq=False)
class FloatingRow:
    """Equal units in a row, their connectors and lines."""

    #: Section, keel to deck.
    hull: Hull
    #: Of one unit [m].
    length: float
    #: At the first water level [m].
    draught: float
    #: [m].
    centre_of_gravity_above_keel: float
    #: Of pitch (about x), roll (about y) and yaw about the centre of gravity [m].
    gyradii: tuple[float, float, float]
    placements: tuple[Placement, ...]
    connectors: tuple[Connector, ...] = ()
    lines: tuple[UnitLine, ...] = ()
    #: Fraction of critical damping of every motion of a unit, beyond wave radiation; shape (6,).
    damping_fraction: Array = field(default_factory=lambda: np.zeros(6))
    #: Damping of a unit beyond wave radiation [N s/m, N m s]; shape (6,).
    linear_damping: Array = field(default_factory=lambda: np.zeros(6))
    #: What the damping by eddies at the edges of the section is multiplied with; 0 where it is not computed.
    viscous_factor: float = 0.0
    #: epsilon of the lids in the gaps; 0 for none.
    gap_damping_lid: float = 0.0
    wind_drag_coefficient: float | None = None
    current_drag_coefficient: float | None = None

    @property
    def count(self) -> int:
        """Number of units."""
        return len(self.placements)

    def damped(self, factor: float) -> FloatingRow:
        """Return the row with its damping beyond wave radiation times a factor."""
        return replace(
            self, damping_fraction=factor * self.damping_fraction, linear_damping=factor * self.linear_damping,
            viscous_factor=factor * self.viscous_factor,
        )  # fmt: skip

    @property
    def damping_band(self) -> tuple[float, ...]:
        """Factors on the damping that answers are given a band for, those of a single breakwater; none without it."""
        own = np.any(self.damping_fraction) or np.any(self.linear_damping) or self.viscous_factor > 0.0
        return DAMPING_BAND if own else ()


@dataclass(frozen=True)
class MapArea:
    """Where the waves are computed: rectangle [m] in the frame of the row, cells, named points, a line behind."""

    x: tuple[float, float]
    y: tuple[float, float]
    #: Along x and y.
    cells: tuple[int, int]
    #: Name, x, y.
    points: tuple[tuple[str, float, float], ...] = ()
    #: x, y of both ends of the line that transmission is averaged over.
    line: tuple[float, float, float, float] | None = None


@dataclass(frozen=True)
class UnitTimeSettings:
    """How the time domain is run; ``None`` means that the program chooses."""

    #: [s].
    time_step: float | None = None
    #: Length of the cosine ramp of the waves [s].
    ramp: float | None = None
    #: Simulated time of regular waves [s] (irregular seas carry their own).
    duration: float | None = None
    #: Whole periods at the end that are analysed in regular waves.
    analysed_periods: int = 10
    #: Of every irregular sea.
    realisations: int = 5
    #: Frequencies over the band that the memory of the water is fitted to, those of the seas among them.
    memory_frequencies: int = 24


@checks_words
@dataclass(frozen=True)
class UnitSettings:
    """Which analyses are run and how."""

    #: Largest step of the panels [m].
    panel_size: float
    analyses: tuple[Analysis, ...] = ("statics", "frequency", "map")
    #: Angular frequencies of the coefficients [rad/s]; ``None``: from the seas.
    frequencies: tuple[float, ...] | None = None
    #: Number of frequencies of each irregular sea where they follow from the seas.
    frequency_count: int = 20
    #: Whether the mean drift force moves the row.
    drift: bool = True
    #: Whether the two-dimensional section is computed next to the row.
    section_compare: bool = True
    time: UnitTimeSettings = field(default_factory=UnitTimeSettings)
    #: Whether the band of the damping is left out, and seas take coefficients at round frequencies, which serve the
    #: next sea as well: for drafts.
    nominal: bool = False


@dataclass(frozen=True)
class RowCoefficients:
    """Coefficients of all units together from the file of another program."""

    program: str
    path: Path
    #: Of the reader.
    options: Mapping[str, Any] = field(default_factory=dict)
    #: Bodies of the file in the order of the units; empty for that of the file.
    bodies: tuple[str, ...] = ()
    #: Origin of the axes of the file in those of the row [m].
    origin: tuple[float, float] = (0.0, 0.0)
    #: From the x axis of the row to that of the file [rad].
    heading: float = 0.0


@dataclass(frozen=True, eq=False)
class UnitsProblem:
    """The whole problem; ``coefficients`` stand in place of a computation by panels."""

    title: str
    row: FloatingRow
    environment: Environment
    settings: UnitSettings
    map_area: MapArea
    criteria: tuple[Criterion, ...] = ()
    case_text: str = ""
    case_hash: str = ""
    coefficients: RowCoefficients | None = None


def straight_row(count: int, length: float, gap: float) -> tuple[Placement, ...]:
    """Return units one after the other along y, the middle of the row at the origin [m]."""
    step = length + gap
    return tuple(Placement(0.0, (number - 0.5 * (count - 1)) * step) for number in range(count))


__all__ = [
    "DOFS",
    "SNAP_RATIO",
    "Analysis",
    "Connector",
    "ConnectorKind",
    "Curve",
    "FloatingRow",
    "MapArea",
    "Placement",
    "RowCoefficients",
    "UnitLine",
    "UnitSettings",
    "UnitTimeSettings",
    "UnitsProblem",
    "straight_row",
]  # fmt: skip
