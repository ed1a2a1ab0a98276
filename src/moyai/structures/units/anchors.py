"""What the lines of a row ask of their anchors [eq:units-anchors].

In the time domain and along regular waves the lines at rest are solved where the row is when they pull most. A tension
that another analysis gives (lines in motion, damping at the end of its band, an irregular sea in the frequency domain)
adds what the line at rest adds from one tension to the other, its fairlead at its height at rest.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.mooring.lines import Line
from moyai.structures.units.assembly import RowAtLevel

if TYPE_CHECKING:
    import xarray as xr

#: Tensions of a curve next to that at which the anchor is lifted, and the highest of them: over the breaking load, as a
#: share of the axial stiffness where none is known, over the weight of a line that does not stretch.
_POINTS, _BEYOND, _STRAIN, _WEIGHTS = 95, 3.0, 0.3, 1e4
#: Instants at which a line is solved, those of its largest tensions.
_INSTANTS = 20
_TURNS = 50
#: Columns of a line in its plane: horizontal and vertical tension at the fairlead, vertical at the anchor, grounded.
_ACROSS, _UP, _LIFT, _LIES = 0, 1, 3, 4
_CURVE = ("tension", "horizontal_tension", "vertical_tension", "grounded_length")
#: Loads of anchors of a sea, and those with lines at rest at the largest tension with these.
LOADS = ("anchor_horizontal_tension_maximum", "anchor_vertical_tension_maximum", "least_grounded_length")
AT_REST = (
    "anchor_horizontal_tension_maximum_lines_at_rest", "anchor_vertical_tension_maximum_lines_at_rest",
    "grounded_length_lines_at_rest",
)  # fmt: skip
TENSION = "line_tension_of_anchor_loads"


def anchor_curves(at: RowAtLevel) -> dict[str, tuple[tuple[str, str], Array]]:
    """Return tension [N] of every line with its horizontal pull, uplift [N] and length on the bed [m], as variables.

    Fairleads keep their height at rest while they are drawn away from the anchor. Springs have no anchor: NaN.
    """
    found = np.full((len(_CURVE), len(at.line_names), _POINTS + 1), np.nan)
    known: dict[tuple[object, ...], Array] = {}
    number = 0
    for lines, centre in zip(at.lines, at.centres):
        for line in lines:
            if isinstance(line, Line):
                rise, depth = line.fairlead[2] - line.anchor[2], at.water.depth + float(centre[2])
                key = (line.segments, line.clumps, line.bed_friction, round(rise, 6), round(line.anchor[2] + depth, 6))
                if key not in known:
                    known[key] = _curve(line, rise, depth)
                found[:, number] = known[key]
            number += 1
    dims = ("line", "anchor_point")
    return {f"anchor_curve_{name}": (dims, values) for name, values in zip(_CURVE, found)}


def _curve(line: Line, rise: float, depth: float) -> Array:
    """Return tension, horizontal pull, uplift, length on the bed (4, points) from slack to beyond the breaking load."""

    def solved(across: Array) -> Array:
        with np.errstate(invalid="ignore", over="ignore"):
            return line.solve_plane(across, np.full(across.size, rise), depth)[0]

    def tension(across: Array) -> Array:
        out = solved(across)
        pull = np.hypot(out[:, _ACROSS], out[:, _UP])
        return np.where(np.isnan(pull), np.inf, pull)

    load, stiffness = line.breaking_load, min(part.line_type.axial_stiffness for part in line.segments)
    weight = sum(abs(part.line_type.submerged_weight) * part.length for part in line.segments)
    most = _BEYOND * load if np.isfinite(load) else _STRAIN * stiffness
    most = most if np.isfinite(most) else _WEIGHTS * max(weight, 1.0)
    far = np.array([np.sqrt(max(line.length**2 - rise**2, (1e-3 * line.length) ** 2))])
    near = 1e-3 * far
    for _ in range(_TURNS):
        far = far if tension(far)[0] >= most else 1.1 * far
    least = float(tension(near)[0])
    wanted = np.geomspace(max(least * (1.0 + 1e-9), 1e-9 * most), most, _POINTS)

    def found(short: Callable[[Array], NDArray[np.bool_]], count: int) -> Array:
        low, high = np.repeat(near, count), np.repeat(far, count)
        for _ in range(_TURNS):
            middle = 0.5 * (low + high)
            under = short(middle)
            low, high = np.where(under, middle, low), np.where(under, high, middle)
        return low

    across = np.sort(np.append(
        found(lambda at: tension(at) < wanted, _POINTS),
        # the curve has a corner where the anchor is lifted
        found(lambda at: (solved(at)[:, _LIES] > 0.0) & (tension(at) < most), 1),
    ))  # fmt: skip
    out = solved(across)
    return np.stack([np.hypot(out[:, _ACROSS], out[:, _UP]), out[:, _ACROSS], out[:, _LIFT], out[:, _LIES]])


def loads_of_record(at: RowAtLevel, motions: Array, tension: Array) -> dict[str, Array]:
    """Return the largest loads of the anchors in a record, where their lines pull most, by the names of results.

    Parameters
    ----------
    at : RowAtLevel
    motions : ndarray (n, m)
        From rest.
    tension : ndarray (n, lines)
        Of the lines at rest [N].
    """
    lines, count = at.row_lines, min(_INSTANTS, len(tension))
    if not tension.shape[1]:
        return {name: np.zeros(0) for name in (*AT_REST, TENSION)}
    rows = np.argpartition(-tension, count - 1, axis=0)[:count]
    positions = motions.reshape(len(motions), -1, 6)[rows, lines.unit[None, :]]
    across, uplift, grounded = lines.anchor_loads_of(positions)
    values = across.max(axis=0), uplift.max(axis=0), grounded.min(axis=0), tension.max(axis=0)
    return dict(zip((*AT_REST, TENSION), values, strict=True))


def loads_at(tension: Array, statics: xr.Dataset) -> Array:
    """Return horizontal pull, uplift [N], length on the bed [m] (3, ..., lines) of lines at tensions (..., lines) [N].

    A line that pulls its anchor down lifts it by nothing. Springs: NaN.
    """
    pull, *loads = (statics[f"anchor_curve_{name}"].values for name in _CURVE)
    out = np.full((len(loads), *tension.shape), np.nan)
    for line in np.flatnonzero(np.isfinite(pull).all(axis=1)):
        # beyond the curve a straight line passes on what it is pulled by
        further = np.maximum(tension[..., line] / pull[line, -1], 1.0)
        for number, load in enumerate(loads):
            out[number, ..., line] = np.interp(tension[..., line], pull[line], load[line]) * further
    return np.asarray(np.maximum(out, 0.0))


def with_anchor_loads(data: xr.Dataset, statics: xr.Dataset) -> xr.Dataset:
    """Return a sea with the loads of its anchors at the largest tensions of its lines, their ends and realisations."""

    def curve(end: str) -> Array:
        return loads_at(data[f"line_tension_maximum{end}"].values, statics)

    def own(end: str) -> Array:
        if f"{TENSION}{end}" not in data:
            return curve(end)
        base = np.stack([data[f"{name}{end}"].values for name in AT_REST])
        return np.asarray(np.maximum(base + curve(end) - loads_at(data[f"{TENSION}{end}"].values, statics), 0.0))

    each = own("_of_realisation") if "line_tension_maximum_of_realisation" in data else None
    mean = own("") if each is None or "period" in data.dims else each.mean(axis=1)
    found = {"": mean}
    if each is not None:
        found["_of_realisation"] = each
    for end in (end for end in ("_low", "_high") if f"line_tension_maximum{end}" in data):
        found[end] = np.maximum(mean + curve(end) - curve(""), 0.0)
    return data.assign(
        {
            f"{name}{end}": (data[f"line_tension_maximum{end}"].dims, values)
            for end, loads in found.items()
            for name, values in zip(LOADS, loads, strict=True)
        }
    )


def has_anchors(statics: xr.Dataset) -> bool:
    """Whether any line of a row at rest has an anchor; springs have none."""
    return "anchor_curve_tension" in statics and bool(np.isfinite(statics["anchor_curve_tension"].values).any())


def anchored(groups: Mapping[str, xr.Dataset]) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield every sea of a row whose lines have anchors, with the loads of these."""
    for path, data in groups.items():
        statics = groups.get(f"/{path.split('/')[1]}/statics")
        sea = "line_tension_maximum" in data and path.count("/") == 3
        if sea and statics is not None and has_anchors(statics):
            yield path, with_anchor_loads(data, statics)


__all__ = ["anchor_curves", "anchored", "has_anchors", "loads_at", "loads_of_record", "with_anchor_loads"]
