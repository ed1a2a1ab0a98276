"""Put a network together from points, lines and nets.

Nodes of one line stand next to each other in memory, so that the kernels run over them in one sweep.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.flexible.bed import Bed
from moyai.flexible.elements import BOX, DRIVEN, FIXED, FREE, SPHERE, Bars, BarType, Nodes, Strand
from moyai.flexible.network import Network
from moyai.flexible.numbers import whole_number
from moyai.flexible.sheets import Sheets, sheet_grid
from moyai.mooring.lines import Line, LineType, Segment
from moyai.mooring.shape import line_shape
from moyai.sea.water import Water, check_water

Start = Literal["catenary", "straight"]


@dataclass
class _Point:
    position: Array
    kind: int
    held: tuple[bool, bool, bool]
    motion: int
    mass: float
    volume: float
    drag_area: float
    added_mass: float
    contact_area: float
    height: float
    form: int


@dataclass
class _Run:
    """Bars of one line: the two end points by name, and the nodes between them."""

    name: str
    start: str
    end: str
    between: Array
    length: Array
    kind: int
    flow_factor: float


class NetworkBuilder:
    """Collects points and lines; :meth:`build` returns the frozen network.

    Parameters
    ----------
    water : Water
        Depth, density and gravity.
    bed : Bed, optional
        Contact with the bed.

    Raises
    ------
    InputError
        For what is no :class:`~moyai.sea.water.Water`, a depth alone for instance.

    Examples
    --------
    >>> from moyai.flexible import BarType, NetworkBuilder
    >>> from moyai.sea import Water
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> rope = BarType("rope", mass_per_length=10.0, axial_stiffness=1e7, diameter=0.05)
    >>> builder.fixed("left", (0.0, 0.0, -2.0))
    >>> builder.fixed("right", (20.0, 0.0, -2.0))
    >>> builder.line("span", "left", "right", rope, length=21.0, segments=20)
    >>> network = builder.build()
    >>> network.nodes.position.shape                                 # nodes, axes [m]
    (21, 3)
    """

    def __init__(self, water: Water, bed: Bed | None = None) -> None:
        check_water(water)
        self.water, self.bed = water, bed
        self._points: dict[str, _Point] = {}
        self._runs: list[_Run] = []
        self._types: list[BarType] = []
        self._motions: list[str] = []
        self._sheets: list[tuple[list[list[str]], Array, Array, dict[str, float]]] = []

    def _add(
        self, name: str, position: ArrayLike, kind: int, held: tuple[bool, bool, bool], motion: int, **attached: float
    ) -> None:
        if name in self._points:
            raise InputError(f"two points are named {name!r}", parameter="points", allowed="different names")
        place = np.array(position, dtype=np.float64)
        if place.shape != (3,) or not np.isfinite(place).all():
            raise InputError(
                f"position of {name!r} is {position!r}", parameter=f"points.{name}", allowed="three finite numbers"
            )
        values = {"mass": 0.0, "volume": 0.0, "drag_area": 0.0, "added_mass": 0.0, "contact_area": 0.0, "height": 0.0}
        if len(held) != 3 or any(part not in (True, False) for part in held):
            raise InputError(
                f"held of {name!r} is {held!r}", parameter=f"points.{name}.held", allowed="three of true, false"
            )
        if attached.get("form", BOX) not in (BOX, SPHERE):
            raise InputError(
                f"form of {name!r} is {attached['form']!r}", parameter=f"points.{name}.form", allowed="BOX, SPHERE"
            )
        for key, value in attached.items():
            if key != "form" and not (np.isfinite(value) and value >= 0.0):
                raise InputError(
                    f"{key} of {name!r} is {value:g}", parameter=f"points.{name}.{key}", allowed="0 or more"
                )
        form = int(attached.pop("form", BOX))
        self._points[name] = _Point(place, kind, held, motion, form=form, **{**values, **attached})

    def fixed(self, name: str, position: ArrayLike) -> None:
        """Add a point that does not move (an anchor).

        Parameters
        ----------
        name, position : str and array_like (3,)
            A name of its own, and the place in site axes [m].

        Raises
        ------
        InputError
            For a name that is taken or a position that is not three finite numbers.
        """
        self._add(name, position, FIXED, (False, False, False), -1)

    def driven(self, name: str, position: ArrayLike, motion: str | None = None) -> None:
        """Add a point that follows the prescribed motion of this name (its own name when left out).

        Parameters
        ----------
        name, position : str and array_like (3,)
            A name of its own, and the place in site axes while the motion is zero [m].
        motion : str, optional
            Name of the motion.

        Raises
        ------
        InputError
            For a name that is taken or a position that is not three finite numbers.
        """
        slot = motion or name
        if slot not in self._motions:
            self._motions.append(slot)
        self._add(name, position, DRIVEN, (False, False, False), self._motions.index(slot))

    @checks_words
    def free(
        self,
        name: str,
        position: ArrayLike,
        *,
        mass: float = 0.0,
        volume: float = 0.0,
        drag_area: float = 0.0,
        added_mass: float = 0.0,
        contact_area: float = 0.0,
        height: float = 0.0,
        form: int = BOX,
        held: tuple[bool, bool, bool] = (False, False, False),
    ) -> None:
        """Add a point that moves by its forces: a joint, clump weight, float or small buoy.

        Parameters
        ----------
        name : str
            Its name.
        position : array_like
            Start position of its centre [m].
        mass, volume : float
            Attached mass [kg] and displaced volume when wholly wet [m3].
        drag_area, added_mass : float
            Drag coefficient times area [m2] and added mass [kg] when wholly wet, all directions alike.
        contact_area : float
            With the bed [m2].
        height : float
            Vertical extent about the centre [m]; 0 keeps it wholly wet wherever it is.
        form : int
            ``BOX`` or ``SPHERE`` (of diameter ``height``).
        held : tuple of bool
            Components x, y, z that do not move.
        """
        self._add(
            name, position, FREE, held, -1,
            mass=mass, volume=volume, drag_area=drag_area, added_mass=added_mass, contact_area=contact_area,
            height=height, form=form,
        )  # fmt: skip

    def float_sphere(
        self,
        name: str,
        position: ArrayLike,
        *,
        diameter: float,
        mass: float,
        drag_coefficient: float,
        added_mass_coefficient: float,
    ) -> None:
        """Add a spherical float or buoy with partial immersion [eq:flexible-immersion].

        Parameters
        ----------
        name, position : str and array_like (3,)
            A name of its own, and the centre in site axes [m].
        diameter, mass : float
            [m], [kg].
        drag_coefficient, added_mass_coefficient : float
            On the circular area and on the displaced mass [-].

        Raises
        ------
        InputError
            For a name that is taken or a position that is not three finite numbers, or a negative value.
        """
        volume = np.pi / 6.0 * diameter**3
        self.free(
            name, position, mass=mass, volume=volume, drag_area=drag_coefficient * np.pi / 4.0 * diameter**2,
            added_mass=added_mass_coefficient * self.water.density * volume, contact_area=0.0, height=diameter, form=1,
        )  # fmt: skip

    def _kind(self, bar_type: BarType) -> int:
        for index, known in enumerate(self._types):
            if known is bar_type:
                return index
        self._types.append(bar_type)
        return len(self._types) - 1

    def position(self, name: str) -> Array:
        """Return the position (3,) of a named point in site axes [m].

        Parameters
        ----------
        name : str
            As the point was added.

        Raises
        ------
        InputError
            When there is none.
        """
        if name not in self._points:
            raise InputError(f"no point {name!r}", parameter="points", allowed=", ".join(self._points) or "none")
        return self._points[name].position

    def line(
        self,
        name: str,
        start: str,
        end: str,
        bar_type: BarType,
        *,
        length: float,
        segments: int,
        shape: Start | ArrayLike = "catenary",
        flow_factor: float = 1.0,
    ) -> None:
        """Add a line of equal bars between two named points.

        Parameters
        ----------
        name : str
            Its name.
        start, end : str
            Points.
        bar_type : BarType
            Material.
        length : float
            Unstretched [m].
        segments : int
            Number of bars.
        shape : {"catenary", "straight"} or array_like, shape (segments - 1, 3)
            Where the nodes between the ends start: on the catenary at rest, on the chord, or as given [m].
        flow_factor : float
            Factor on the water velocity that meets the line.

        Raises
        ------
        InputError
            For unknown points, less than one segment or a length that is not positive.
        """
        if any(run.name == name for run in self._runs):
            raise InputError(f"two lines are named {name!r}", parameter="lines", allowed="different names")
        try:
            segments = whole_number(segments, "segments", least=1)
        except InputError:
            raise InputError(
                f"line {name!r} has {segments} segments", parameter=f"lines.{name}.segments", allowed="1 or more, whole"
            ) from None
        if not (np.isfinite(length) and length > 0.0):
            raise InputError(
                f"line {name!r} has length {length:g} m", parameter=f"lines.{name}.length", allowed="greater than 0"
            )
        a, b = self.position(start), self.position(end)
        if start == end:
            raise InputError(
                f"line {name!r} starts and ends at {start!r}", parameter=f"lines.{name}.end", allowed="another point"
            )
        fraction = np.arange(1, segments) / segments
        if isinstance(shape, str) and shape not in ("catenary", "straight"):
            raise InputError(
                f"shape of line {name!r} is {shape!r}", parameter=f"lines.{name}.shape",
                allowed="catenary, straight, or places of the nodes between its ends",
            )  # fmt: skip
        if isinstance(shape, str):
            between = a + fraction[:, None] * (b - a)
            if shape == "catenary" and segments > 1:
                between = _at_rest(a, b, bar_type, length, fraction, self.water, self.bed)
        else:
            between = np.array(shape, dtype=np.float64)
            if between.shape != (segments - 1, 3):
                raise InputError(
                    f"places of the nodes of line {name!r} have shape {between.shape}", parameter=f"lines.{name}.shape",
                    allowed=f"({segments - 1}, 3), one for each node between its ends",
                )  # fmt: skip
        lengths = np.full(segments, length / segments)
        self._runs.append(_Run(name, start, end, between, lengths, self._kind(bar_type), flow_factor))

    @checks_words
    def net(
        self,
        name: str,
        points: ArrayLike,
        bar_type: BarType,
        *,
        lengths: tuple[float, float],
        top: Literal["free", "fixed", "driven"] = "driven",
        motion: str | None = None,
        across_type: BarType | None = None,
        flow_factor: float = 1.0,
    ) -> None:
        """Add a net of square or rectangular meshes: a grid of points joined by bars along rows and columns.

        Parameters
        ----------
        name : str
            Its name; the points are called ``name[row,column]``, the rows ``name row 0`` ..., the columns ``name
            column 0`` ...
        points : array_like, shape (rows, columns, 3)
            Positions of the knots [m].
        bar_type : BarType
            Twine (or group of twines) of the rows.
        lengths : (float, float)
            Unstretched bar length along the rows and along the columns [m].
        top : {"free", "fixed", "driven"}
            What holds the first row.
        motion : str, optional
            Name of the motion of a driven first row (the net's name when left out).
        across_type : BarType, optional
            Twine of the columns when it differs.
        flow_factor : float
            Factor on the water velocity that meets the net.

        Raises
        ------
        InputError
            For points or lengths of another shape.
        """
        grid = np.array(points, dtype=np.float64)
        if grid.ndim != 3 or grid.shape[2] != 3 or min(grid.shape[:2]) < 2:
            raise InputError(
                f"points of net {name!r} have shape {grid.shape}",
                parameter=f"nets.{name}",
                allowed="(rows, columns, 3), two or more each",
            )
        if np.shape(lengths) != (2,):
            raise InputError(
                f"lengths of net {name!r} are {lengths!r}", parameter=f"nets.{name}.lengths",
                allowed="two: of bars along the rows and along the columns",
            )  # fmt: skip
        rows, columns = grid.shape[:2]
        for i in range(rows):
            for j in range(columns):
                label = f"{name}[{i},{j}]"
                if i > 0 or top == "free":
                    self.free(label, grid[i, j])
                elif top == "fixed":
                    self.fixed(label, grid[i, j])
                else:
                    self.driven(label, grid[i, j], motion or name)
        none = np.zeros((0, 3))
        along, across = self._kind(bar_type), self._kind(across_type or bar_type)
        for i in range(rows):
            for j in range(columns - 1):
                self._runs.append(
                    _Run(
                        f"{name} row {i}",
                        f"{name}[{i},{j}]",
                        f"{name}[{i},{j + 1}]",
                        none,
                        np.full(1, lengths[0]),
                        along,
                        flow_factor,
                    )
                )
        for i in range(rows - 1):
            for j in range(columns):
                self._runs.append(
                    _Run(
                        f"{name} column {j}",
                        f"{name}[{i},{j}]",
                        f"{name}[{i + 1},{j}]",
                        none,
                        np.full(1, lengths[1]),
                        across,
                        flow_factor,
                    )
                )

    @checks_words
    def sheet(
        self,
        name: str,
        points: ArrayLike,
        *,
        warp: ArrayLike,
        weft: ArrayLike,
        first_row: Literal["free", "fixed", "driven"] = "free",
        motion: str | None = None,
        **properties: float,
    ) -> None:
        """Add a sheet: a grid of points, ``name[row,column]``, with an orthotropic membrane between them.

        Parameters
        ----------
        name : str
            Its name.
        points : array_like, shape (rows, columns, 3)
            Positions of the knots [m].
        warp, weft : array_like, shape (rows,) and (columns,)
            Unstretched places of rows and columns [m], rising.
        first_row : {"free", "fixed", "driven"}
            What holds the first row.
        motion : str, optional
            Name of the motion of a driven first row (the sheet's name when left out).
        **properties
            Stiffnesses, mass, drag ... of :class:`moyai.flexible.sheets.Sheets`.

        Raises
        ------
        InputError
            For points of another shape.
        """
        grid = np.array(points, dtype=np.float64)
        if grid.ndim != 3 or grid.shape[2] != 3:
            raise InputError(
                f"points of sheet {name!r} have shape {grid.shape}",
                parameter=f"sheets.{name}",
                allowed="(rows, columns, 3)",
            )
        labels = [[f"{name}[{i},{j}]" for j in range(grid.shape[1])] for i in range(grid.shape[0])]
        for i, row in enumerate(labels):
            for j, label in enumerate(row):
                if i > 0 or first_row == "free":
                    self.free(label, grid[i, j])
                elif first_row == "fixed":
                    self.fixed(label, grid[i, j])
                else:
                    self.driven(label, grid[i, j], motion or name)
        self._sheets.append(
            (labels, np.asarray(warp, dtype=np.float64), np.asarray(weft, dtype=np.float64), properties)
        )

    def _joined_sheets(self, index: dict[str, int]) -> Sheets | None:
        if not self._sheets:
            return None
        triangles, rest = [], []
        # what a sheet does not name has the default of Sheets, a stiffness without one is asked for
        usual = {entry.name: entry.default for entry in fields(Sheets)}
        values: dict[str, list[Array]] = {key: [] for _, _, _, given in self._sheets for key in given}
        for key in values:
            if key not in usual or key in ("triangles", "rest"):
                raise InputError(f"a sheet has no {key!r}", parameter="sheets", allowed=", ".join(list(usual)[2:]))
        for key in ("warp_stiffness", "weft_stiffness"):
            if any(key not in given for _, _, _, given in self._sheets):
                raise InputError(f"a sheet without {key!r}", parameter=f"sheets.{key}", allowed="0 or more")
        for labels, warp, weft, given in self._sheets:
            corners, places = sheet_grid([[index[label] for label in row] for row in labels], warp, weft)
            triangles.append(corners)
            rest.append(places)
            for key, column in values.items():
                column.append(np.full(len(corners), given.get(key, usual[key])))
        joined: dict[str, Any] = {key: np.concatenate(column) for key, column in values.items()}
        if "tension_field" in joined:
            if np.ptp(joined["tension_field"].astype(float)) > 0.0:
                raise InputError(
                    "one sheet wrinkles, another one does not",
                    parameter="sheets.tension_field",
                    allowed="the same for all",
                )
            joined["tension_field"] = bool(joined["tension_field"][0])
        return Sheets(np.concatenate(triangles), np.concatenate(rest), **joined)

    def build(self) -> Network:
        """Return the network.

        Raises
        ------
        InputError
            For the faults that :class:`moyai.flexible.network.Network` names.
        """
        index: dict[str, int] = {}
        size = 0
        inner: list[int] = []
        for run in self._runs:
            if run.start not in index:
                index[run.start] = size
                size += 1
            inner.append(size)
            size += len(run.between)
            if run.end not in index:
                index[run.end] = size
                size += 1
        for name in self._points:
            if name not in index:
                index[name] = size
                size += 1
        position = np.zeros((size, 3))
        kind, motion, form = np.zeros(size, np.int64), np.full(size, -1, np.int64), np.zeros(size, np.int64)
        held = np.zeros((size, 3), dtype=bool)
        attached = {
            key: np.zeros(size) for key in ("mass", "volume", "drag_area", "added_mass", "contact_area", "height")
        }
        for name, point in self._points.items():
            node = index[name]
            position[node], kind[node], held[node], motion[node], form[node] = (
                point.position, point.kind, point.held, point.motion, point.form,
            )  # fmt: skip
            for key, values in attached.items():
                values[node] = getattr(point, key)
        starts: list[int] = []
        ends: list[int] = []
        lengths: list[float] = []
        kinds: list[int] = []
        factors: list[float] = []
        strands: dict[str, tuple[list[int], list[int]]] = {}
        for run, first in zip(self._runs, inner, strict=True):
            chain = [index[run.start], *range(first, first + len(run.between)), index[run.end]]
            position[first : first + len(run.between)] = run.between
            numbers = range(len(starts), len(starts) + len(chain) - 1)
            nodes, bars = strands.setdefault(run.name, ([], []))
            nodes.extend(chain if not nodes else chain[1:])
            bars.extend(numbers)
            starts.extend(chain[:-1])
            ends.extend(chain[1:])
            lengths.extend(run.length)
            kinds.extend([run.kind] * len(numbers))
            factors.extend([run.flow_factor] * len(numbers))
        return Network(
            Nodes(position, kind, held, motion, form=form, **attached),
            Bars(
                np.array(starts, np.int64), np.array(ends, np.int64), np.array(lengths), np.array(kinds, np.int64),
                tuple(self._types), np.array(factors),
            ),
            self.water,
            self.bed,
            tuple(Strand(name, np.array(nodes), np.array(bars)) for name, (nodes, bars) in strands.items()),
            dict(index),
            tuple(self._motions),
            sheets=self._joined_sheets(index),
        )  # fmt: skip


def _at_rest(
    a: Array, b: Array, bar_type: BarType, length: float, fraction: Array, water: Water, bed: Bed | None
) -> Array:
    """Return points on the exact catenary between two ends, or on the chord of a weightless line."""
    chord = a + fraction[:, None] * (b - a)
    weight = bar_type.submerged_weight_per_length(water)
    low, high, along = (a, b, fraction) if a[2] <= b[2] else (b, a, 1.0 - fraction)
    level = bed.level_for(low) if bed is not None else low[2] - 10.0 * length
    if abs(weight) < 1e-9 * bar_type.mass_per_length * water.gravity or length <= np.linalg.norm(b - a):
        return chord
    if weight < 0.0:
        # a floating line hangs upwards: the mirror image without bed
        mirror = np.array([1.0, 1.0, -1.0])
        flipped = (b, a, 1.0 - fraction) if a[2] <= b[2] else (a, b, fraction)
        low, high, along, level = flipped[0] * mirror, flipped[1] * mirror, flipped[2], -np.inf
        level = low[2] - 10.0 * length
    line = Line(
        "start", tuple(low), tuple(high), (Segment(LineType("start", abs(weight), bar_type.axial_stiffness), length),)
    )
    shape = line_shape(line, high, -level, points=max(60, 4 * (len(fraction) + 1)))
    points = np.stack([np.interp(along * length, shape.arc_length, shape.points[:, k]) for k in range(3)], axis=1)
    if not np.isfinite(points).all():
        return chord
    if weight < 0.0:
        return np.asarray(points * np.array([1.0, 1.0, -1.0]))
    return np.asarray(points if bed is None else bed.carried(points))
