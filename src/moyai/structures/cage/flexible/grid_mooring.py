"""Grid mooring of net cages: a frame of ropes under the surface, buoys, bridles to the collars, anchor lines."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise

from moyai.core.errors import InputError
from moyai.tables.lines import LineProperties


@dataclass(frozen=True)
class Buoy:
    """A spherical buoy over a corner of the frame."""

    #: [m].
    diameter: float
    #: [kg].
    mass: float
    #: C_d on the section of the sphere [-].
    drag: float

    def __post_init__(self) -> None:
        for key in ("diameter", "mass"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{key} of a buoy is {value:g}", parameter=f"buoy.{key}", allowed="greater than 0")

    @property
    def volume(self) -> float:
        """Volume of the sphere [m3]."""
        return math.pi / 6.0 * self.diameter**3


@dataclass(frozen=True)
class GridMooring:
    """A square frame under water, one bay a cage, held by lines to anchors on the bed.

    Raises
    ------
    InputError
        For lengths that are not positive and lines that cannot reach.
    """

    #: Side of a bay [m].
    spacing: float
    #: Of the frame under still water [m].
    depth: float
    #: Ropes of the frame, and from its corners to the buoys.
    frame_rope: LineProperties
    #: Over every corner of the frame.
    buoy: Buoy
    #: From corners of the frame to the collar.
    bridle_rope: LineProperties
    #: Bridles from every corner of a bay to its cage.
    bridles_per_corner: int
    #: Rope and chain of an anchor line from the frame to the anchor, with lengths [m].
    anchor_segments: tuple[tuple[LineProperties, float], ...]
    #: Horizontally from the corner of the frame to its anchor [m].
    anchor_distance: float
    #: Anchor lines at the outer corners: one along the diagonal, or two in line with the frame; one of 1, 2.
    lines_per_corner: int = 1
    #: Length of a bridle over the straight way from corner to collar, less 1 [-].
    bridle_slack: float = 0.0
    #: Unstretched length of every bridle [m], instead of ``bridle_slack``.
    bridle_length: float | None = None
    #: Damping ratio of elastic waves in the ropes on the mesh [-].
    damping: float = 0.1

    def __post_init__(self) -> None:
        for key in ("spacing", "depth", "anchor_distance"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(
                    f"{key} of the grid is {value:g} m", parameter=f"mooring.{key}", allowed="greater than 0 m"
                )
        if not 1 <= self.bridles_per_corner <= 4:
            raise InputError(
                f"{self.bridles_per_corner} bridles per corner",
                parameter="mooring.bridles_per_corner",
                allowed="1 to 4",
            )
        if self.lines_per_corner not in (1, 2):
            raise InputError(
                f"{self.lines_per_corner} lines per corner", parameter="mooring.lines_per_corner", allowed="1 or 2"
            )
        if not self.anchor_segments:
            raise InputError(
                "an anchor line of nothing", parameter="mooring.anchor_line", allowed="one segment or more"
            )
        for properties, length in self.anchor_segments:
            if not (math.isfinite(length) and length > 0.0):
                raise InputError(
                    f"{length:g} m of {properties.name}", parameter="mooring.anchor_line", allowed="greater than 0 m"
                )
        if self.bridle_length is not None and not (math.isfinite(self.bridle_length) and self.bridle_length > 0.0):
            raise InputError(
                f"bridle_length is {self.bridle_length:g} m",
                parameter="mooring.bridle_length",
                allowed="greater than 0 m",
            )
        if not -0.2 < self.bridle_slack < 1.0:
            raise InputError(
                f"bridle_slack is {self.bridle_slack:g}", parameter="mooring.bridle_slack", allowed="-0.2 to 1"
            )

    @property
    def line_length(self) -> float:
        """Unstretched length of an anchor line [m]."""
        return math.fsum(length for _, length in self.anchor_segments)

    def plates(self, rows: int, columns: int) -> list[tuple[float, float]]:
        """Return the corners of the bays (x, y), row by row [m]."""
        return [
            (self.spacing * (c - 0.5 * columns), self.spacing * (r - 0.5 * rows))
            for r in range(rows + 1)
            for c in range(columns + 1)
        ]

    def frame_pairs(self, rows: int, columns: int) -> list[tuple[int, int]]:
        """Return which corners the ropes of the frame join."""
        number = [[r * (columns + 1) + c for c in range(columns + 1)] for r in range(rows + 1)]
        along = [pair for row in number for pair in pairwise(row)]
        across = [(number[r][c], number[r + 1][c]) for c in range(columns + 1) for r in range(rows)]
        return along + across

    def anchor_directions(self, rows: int, columns: int) -> list[tuple[int, tuple[float, float]]]:
        """Return corner and outward unit vector of every anchor line."""
        found: list[tuple[int, tuple[float, float]]] = []
        for r in range(rows + 1):
            for c in range(columns + 1):
                x = -1.0 if c == 0 else (1.0 if c == columns else 0.0)
                y = -1.0 if r == 0 else (1.0 if r == rows else 0.0)
                corner = r * (columns + 1) + c
                if x and y and self.lines_per_corner == 1:
                    found.append((corner, (x * math.sqrt(0.5), y * math.sqrt(0.5))))
                else:
                    if x:
                        found.append((corner, (x, 0.0)))
                    if y:
                        found.append((corner, (0.0, y)))
        return found
