"""What the lines of a row ask of their anchors: the line at rest that pulls as hard, in its own plane.

The tension that governs a line may come from the frequency domain, from the time domain or from lines in motion. At its
largest the line is nearly at rest, so that its tension tells the pull on its anchor whatever analysis found it
[eq:units-anchors].
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.mooring.lines import Line
from moyai.structures.units.assembly import RowAtLevel

if TYPE_CHECKING:
    import xarray as xr

#: Tensions of a curve, and the highest of them over the breaking load, or over the weight of the line where none is
#: known.
_POINTS, _BEYOND, _WEIGHTS = 48, 3.0, 1000.0
_TURNS = 50
#: Columns of a line in its plane: horizontal and vertical tension at the fairlead, vertical at the anchor, grounded.
_ACROSS, _UP, _LIFT, _LIES = 0, 1, 3, 4
_CURVE = ("tension", "horizontal_tension", "vertical_tension", "grounded_length")
LOADS = ("maximum_anchor_horizontal_tension", "maximum_anchor_vertical_tension", "least_grounded_length")


def anchor_curves(at: RowAtLevel) -> dict[str, tuple[tuple[str, str], Array]]:
    """Return tension [N] of every line, and with it pull across, uplift [N] and length on the bed [m], as variables.

    Fairleads keep their height at rest while they are drawn away from the anchor. Springs have no anchor: NaN.
    """
    found = np.full((len(_CURVE), len(at.line_names), _POINTS), np.nan)
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
    """Return tension, pull across, uplift and length on the bed (4, points) from slack to beyond the breaking load."""

    def solved(across: Array) -> Array:
        with np.errstate(invalid="ignore", over="ignore"):
            return line.solve_plane(across, np.full(across.size, rise), depth)[0]

    def tension(across: Array) -> Array:
        out = solved(across)
        pull = np.hypot(out[:, _ACROSS], out[:, _UP])
        return np.where(np.isnan(pull), np.inf, pull)

    load = line.breaking_load
    weight = sum(abs(part.line_type.submerged_weight) * part.length for part in line.segments)
    most = _BEYOND * load if np.isfinite(load) else _WEIGHTS * max(weight, 1.0)
    far = np.array([np.sqrt(max(line.length**2 - rise**2, (1e-3 * line.length) ** 2))])
    near = 1e-3 * far
    while tension(far)[0] < most:
        far = 1.1 * far
    least = float(tension(near)[0])
    wanted = np.geomspace(max(least * (1.0 + 1e-9), 1e-6 * most), most, _POINTS)
    low, high = np.repeat(near, _POINTS), np.repeat(far, _POINTS)
    for _ in range(_TURNS):
        middle = 0.5 * (low + high)
        under = tension(middle) < wanted
        low, high = np.where(under, middle, low), np.where(under, high, middle)
    out = solved(low)
    return np.stack([np.hypot(out[:, _ACROSS], out[:, _UP]), out[:, _ACROSS], out[:, _LIFT], out[:, _LIES]])


def loads_at(tension: Array, statics: xr.Dataset) -> Array:
    """Return pull across, uplift [N] and length on the bed [m] (3, ..., lines) of lines at tensions (..., lines) [N].

    A line that pulls its anchor down lifts it by nothing. Springs: NaN.
    """
    pull, *loads = (statics[f"anchor_curve_{name}"].values for name in _CURVE)
    out = np.full((len(loads), *tension.shape), np.nan)
    for line in np.flatnonzero(np.isfinite(pull).all(axis=1)):
        for number, load in enumerate(loads):
            out[number, ..., line] = np.interp(tension[..., line], pull[line], load[line])
    return np.asarray(np.maximum(out, 0.0))


def with_anchor_loads(data: xr.Dataset, statics: xr.Dataset) -> xr.Dataset:
    """Return a sea with the loads of its anchors at the largest tensions of its lines, their ends and realisations."""
    found: dict[str, tuple[tuple[Hashable, ...], Array]] = {}
    for end in ("", "_low", "_high", "_of_realisation"):
        tension = data.get(f"line_tension_maximum{end}")
        if tension is not None:
            loads = loads_at(tension.values, statics)
            found |= {f"{name}{end}": (tension.dims, values) for name, values in zip(LOADS, loads)}
    return data.assign(found)


def anchored(groups: Mapping[str, xr.Dataset]) -> Iterator[tuple[str, xr.Dataset]]:
    """Yield every sea of a row whose lines have anchors, with the loads of these."""
    for path, data in groups.items():
        statics = groups.get(f"/{path.split('/')[1]}/statics")
        if statics is None or "line_tension_maximum" not in data or path.count("/") != 3:
            continue
        if bool(np.isfinite(statics["anchor_curve_tension"].values).any()):
            yield path, with_anchor_loads(data, statics)


__all__ = ["anchor_curves", "anchored", "loads_at", "with_anchor_loads"]
