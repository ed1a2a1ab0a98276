"""Waves around and behind the row: wave height over that of the incident sea, on a map, at points, along a line.

Incident, scattered and radiated waves of all units are summed before their height is taken [eq:units-map].
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.core.progress import Progress, silent
from moyai.core.store import DatasetStore, key_of
from moyai.core.version import VERSION
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.bem import Solution, elevation_at, given_flow, steady_potentials
from moyai.structures.units.hydrodynamics import METHOD, RowHydrodynamics
from moyai.structures.units.mesh import waterplane
from moyai.structures.units.model import ON_HULL, MapArea

if TYPE_CHECKING:
    import xarray as xr

LINE_POINTS = 41


@dataclass(frozen=True, eq=False)
class MapPoints:
    """Where the waves are computed."""

    #: Grid of the map along x [m].
    x: Array
    #: Grid of the map along y [m].
    y: Array
    #: Map (y slowest), named points, line; all of them; shape (p, 2).
    points: Array
    #: Whether a point lies outside of all units; shape (p,).
    wet: NDArray[np.bool_]
    #: Where the named points stand in ``points``.
    named: slice
    #: Where the line stands in ``points``.
    line: slice


def map_points(area: MapArea, at: RowAtLevel) -> MapPoints:
    """Return the points of a map."""
    x, y = np.linspace(*area.x, area.cells[0]), np.linspace(*area.y, area.cells[1])
    grid_x, grid_y = np.meshgrid(x, y)
    parts = [np.stack([grid_x.ravel(), grid_y.ravel()], axis=1)]
    parts.append(np.array([point[1:] for point in area.points], dtype=float).reshape(-1, 2))
    if area.line is None:
        parts.append(np.zeros((0, 2)))
    else:
        t = np.linspace(0.0, 1.0, LINE_POINTS)[:, None]
        first, last = np.array(area.line[:2]), np.array(area.line[2:])
        parts.append(first + t * (last - first))
    counts = np.cumsum([0, *(len(part) for part in parts)])
    points = np.concatenate(parts)
    wet = np.ones(len(points), dtype=bool)
    for place in at.row.placements:
        wet[_inside(points, waterplane(at.section, at.row.length, place))] = False
    return MapPoints(x, y, points, wet, slice(counts[1], counts[2]), slice(counts[2], counts[3]))


def _inside(points: Array, corners: Array) -> NDArray[np.bool_]:
    """Return which points lie inside of a waterplane or on its edge, where a hull has two sides."""
    inside = np.ones(len(points), dtype=bool)
    for a, b in zip(corners, np.roll(corners, -1, axis=0)):
        apart = (b[0] - a[0]) * (points[:, 1] - a[1]) - (b[1] - a[1]) * (points[:, 0] - a[0])
        inside &= apart >= -ON_HULL * float(np.hypot(*(b - a)))
    return inside


@dataclass(frozen=True, eq=False)
class WaveField:
    """Elevation at points (p,) for every frequency that was solved, row axes."""

    #: Per unit displacement; shape (p, m).
    radiated: tuple[ComplexArray, ...]
    #: Incident and scattered, per unit wave amplitude; shape (p, h).
    diffracted: tuple[ComplexArray, ...]


def wave_field(
    points: MapPoints, hydro: RowHydrodynamics, *, store: DatasetStore | None = None, progress: Progress = silent
) -> WaveField:
    """Return the waves of all motions and all headings at the points; NaN inside of units."""
    wet = points.points[points.wet]
    radiated, diffracted = [], []
    panels, water = hydro.panels, hydro.water
    assert panels is not None, "a file holds no panels"
    base = key_of(
        VERSION, METHOD, panels.mesh.corners, wet, hydro.centres, panels.gap_damping, hydro.headings,
        (water.depth, water.density, water.gravity),
    )  # fmt: skip
    keys = [key_of(base, solution.omega, "field") for solution in hydro.solutions]
    kept = [None if store is None else store.get(key) for key in keys]
    known = [None if data is None or "field" not in data else data["field"].values for data in kept]
    asked = [_solved(hydro, solution) for solution, waves in zip(hydro.solutions, known) if waves is None]
    steady = iter(steady_potentials(wet, panels, water, asked))
    for index, (solution, key, found) in enumerate(zip(hydro.solutions, keys, known)):
        progress("waves around the row", index, len(hydro.solutions))
        waves = found
        if waves is None:
            waves = elevation_at(wet, panels, water, *_solved(hydro, solution), next(steady))
            if store is not None:
                store.put(key, _kept(waves))
        count = solution.radiation.shape[1]
        along = np.cos(hydro.headings) * wet[:, [0]] + np.sin(hydro.headings) * wet[:, [1]]
        incident = np.exp(1j * solution.wave_number * along)
        radiated.append(_spread(waves[:, :count], points.wet))
        diffracted.append(_spread(waves[:, count:] + incident, points.wet))
    progress("waves around the row", len(hydro.solutions), len(hydro.solutions))
    return WaveField(tuple(radiated), tuple(diffracted))


def _solved(hydro: RowHydrodynamics, solution: Solution) -> tuple[float, ComplexArray, ComplexArray]:
    """Return a frequency, the solutions of all motions and headings there, and the flows that they were given."""
    assert hydro.panels is not None
    surface = np.concatenate([solution.radiation, solution.diffraction], axis=1)
    given = given_flow(hydro.panels, hydro.water, solution.omega, solution.wave_number, hydro.headings)
    return solution.omega, surface, given


def _kept(waves: ComplexArray) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset({"field": (("point", "wave"), waves)})


def _spread(values: ComplexArray, wet: NDArray[np.bool_]) -> ComplexArray:
    out = np.full((len(wet), values.shape[1]), complex(np.nan, np.nan))
    out[wet] = values
    return out


def height_ratio(field: WaveField, index: int, motion: ComplexArray, columns: IntArray) -> Array:
    """Return K at all points for one frequency and headings (p, h): |elevation| over the incident amplitude.

    Parameters
    ----------
    field : WaveField
    index : int
        Of the frequency.
    motion : ndarray (h, m)
        Of the row, per unit wave amplitude.
    columns : ndarray (h,)
        Headings among those that were solved.
    """
    return np.asarray(np.abs(field.diffracted[index][:, columns] + field.radiated[index] @ motion.T))


def sea_height_ratio(field: WaveField, motion: ComplexArray, columns: IntArray, energy: Array) -> Array:
    """Return K (p,) of a sea: root of the energy at a point over that of the incident sea.

    Parameters
    ----------
    field : WaveField
    motion : ndarray (f, h, m)
    columns : ndarray (h,)
    energy : ndarray (f, h)
        Of the incident sea, in cells of frequency and heading [m2].
    """
    total = np.zeros(len(field.radiated[0]))
    for index in range(len(field.radiated)):
        if energy[index].any():
            total = total + height_ratio(field, index, motion[index], columns) ** 2 @ energy[index]
    return np.asarray(np.sqrt(total / energy.sum()))


def line_transmission(ratio: Array) -> float:
    """Return the transmission over a line: root of the mean square of K along it [eq:units-transmission]."""
    return float(np.sqrt(np.nanmean(ratio**2))) if ratio.size else float("nan")
