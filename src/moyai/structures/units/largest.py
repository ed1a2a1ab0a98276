"""The largest value of a variable over seas, with what it varies by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Bound
from moyai.series.realisations import alone, seeds, storms
from moyai.structures.units import doubts
from moyai.structures.units.model import DAMPING_BAND, SNAP_RATIO
from moyai.structures.units.unjudged import Seas, in_time

if TYPE_CHECKING:
    import xarray as xr

_DAMPING = f"damping of the units beyond waves times {DAMPING_BAND[0]:g} to {DAMPING_BAND[1]:g}"
#: Loads and closings of connectors that pull nothing or do not move are differences of large numbers: what is below
#: this [N, N m, m] is rounding.
_ROUNDED, _NOTHING = ("connector_resultant_largest", "connector_moment_largest", "gap_closing_largest"), 1e-6


#: Mean over time of a largest value of an irregular sea.
_MEAN: dict[str, Callable[[xr.Dataset, tuple[int, ...]], float]] = {
    "connector_resultant_largest": lambda data, at: float(np.linalg.norm(data["connector_force_mean"].values[at])),
    "connector_moment_largest": lambda data, at: float(data["connector_moment_mean"].values[at]),
    "line_tension_maximum": lambda data, at: float(data["line_tension_mean"].values[at]),
    "gap_closing_largest": lambda data, at: 0.0,
    "opened": lambda data, at: 0.0,
    "tilt": lambda data, at: 0.0,
}


def _labels(data: xr.Dataset, dims: tuple[str, ...]) -> list[list[str]]:
    """Return how every place along each dimension is called."""
    called: dict[str, Callable[[Any], str]] = {
        "period": lambda value: f"T = {float(value):g} s",
        "unit": "unit {}".format,
    }
    return [[called.get(dim, str)(value) for value in data[dim].values] for dim in dims]


@dataclass(frozen=True)
class Largest:
    """A value of a variable in a sea: of a connector, line, gap or unit, and where it stands."""

    value: float
    where: str
    path: str
    data: xr.Dataset
    index: tuple[int, ...]
    name: str
    scale: float

    @property
    def timed(self) -> bool:
        return in_time(self.path)

    @property
    def scatter(self) -> Array:
        """The value of each realisation, none where the number is of no random sea in time and repeats."""
        return self.members(self.name)

    def members(self, name: str) -> Array:
        """Return a number of each realisation, or of each part of a regular motion that does not repeat."""
        # asked for by membership: a missing variable takes milliseconds to be missed
        own = f"{name}_of_realisation"
        rows = np.asarray(self.data[own].values, dtype=float) if own in self.data else ()
        found = np.array([row[self.index] for row in rows]) / self.scale
        return found[np.isfinite(found)]

    @property
    def band(self) -> Band | None:
        """The band of chance and of the damping of the units; none of nothing."""
        return self.spread(self.chance()) if self.value > 0.0 else None

    def chance(self, bound: Array | None = None) -> Band | None:
        """Return the band of realisations, of parts of a regular motion that does not repeat, or of storms alike."""
        if not self.timed:
            return self._of_storms()
        found = seeds(self.scatter, bound)
        if found is None or "period" not in self.data.dims:
            return found
        of = f"{found.realisations} parts of a record that does not repeat; judged at the 95 % end of their mean"
        return replace(found, of=of, more="settings.time.duration")

    def _of_storms(self) -> Band | None:
        """Return the band of a most probable largest value of the frequency domain over storms alike.

        That of a curve does not follow its motion, and an offset is no number without slow drift.
        """
        if "most_probable_maximum_motion" not in self.data or self.name not in _MEAN:
            return None
        worked = self.data.get("elongation_highest") if self.name == "connector_resultant_largest" else None
        if worked is not None and np.isfinite(worked.values[self.index]):
            return None
        deviation = 0.25 * self.data["significant_motion"].values
        moving = deviation > _NOTHING * max(float(deviation.max(initial=0.0)), _NOTHING)
        if not moving.any():
            return None
        ratio = self.data["most_probable_maximum_motion"].values[moving] / deviation[moving]
        mean = _MEAN[self.name](self.data, self.index) / self.scale
        return storms(self.value, min(abs(mean), self.value), float(np.median(ratio)))

    def spread(self, chance: Band | None) -> Band | None:
        """Return a band of realisations widened by the damping of the units."""
        damping = damping_band(self.data, self.name, self.index, self.scale)
        if damping is None or chance is None or not self.value > 0.0:
            return chance or damping
        less, more = damping.low / self.value, damping.high / self.value
        return replace(chance.scaled(less, more), of=f"{chance.of}; {damping.of}")

    @property
    def bound(self) -> Bound:
        """What one realisation alone proves."""
        return alone(self.scatter)

    @property
    def digits(self) -> int:
        """Digits that are known: two where rounding decides when a connector or a line comes taut, so that no run
        repeats."""
        if not self.timed:
            return 3
        tight = self.data["line_tension_maximum"] > SNAP_RATIO * self.data["line_tension_mean"]
        curved = "elongation_highest" in self.data and bool(np.isfinite(self.data["elongation_highest"]).any())
        return 2 if self.scatter.size and (curved or bool(tight.any())) else 3

    @property
    def why_loose(self) -> str:
        """Why units move against each other by more than the linear answer knows."""
        return doubts.why_loose(self.path, self.data)

    @property
    def why_beyond(self) -> str:
        """How far a connector is worked beyond its measured curve."""
        return doubts.why_beyond(self.data, self.name, self.index)

    @property
    def lets_go(self) -> bool:
        """Whether a connector of the row carries and lets go, which its linear motions do not have."""
        return doubts.lets_go(self.path, self.data)

    @property
    def strained(self) -> bool:
        """Whether a line of the sea comes tighter than its linear motions feel."""
        return doubts.strained(self.path, self.data)

    @property
    def without_drift(self) -> bool:
        """Whether it is of an irregular sea without slow drift, or of any without drift."""
        return self.drift_left_out or (not self.timed and "significant_motion" in self.data)

    @property
    def drift_left_out(self) -> bool:
        """Whether the case leaves drift out."""
        return bool(self.data.attrs.get("drift") == "none")


def damping_band(data: xr.Dataset, name: str, index: tuple[int, ...], scale: float = 1.0) -> Band | None:
    """Return the band of a number over the damping of the units; None where there was none to vary."""
    if f"{name}_low" not in data:
        return None
    low, high = (abs(float(data[f"{name}_{end}"].values[index])) / scale for end in ("low", "high"))
    return Band(low, high, _DAMPING)


def each_of(seas: Seas, name: str, over: Array | None = None) -> list[Largest]:
    """Return every known value of every sea, the largest of each sea first.

    Which one decides is known where bands, bounds and means are: another line or connector may have the smaller value
    and the wider band, or be known as a bound alone.

    Parameters
    ----------
    seas : list of (path, dataset)
    name : str
    over : ndarray, optional
        What the last dimension is divided by.
    """
    found: list[Largest] = []
    for path, whole in seas:
        if name not in whole or not whole[name].size:
            continue
        parts = (
            [whole.isel(period=[row]) for row in range(whole.sizes["period"])] if "period" in whole.dims else [whole]
        )
        for data in parts:
            found += _members(path, data, name, over)
    return found


def _members(path: str, data: xr.Dataset, name: str, over: Array | None) -> list[Largest]:
    values = np.abs(np.asarray(data[name].values, dtype=float))
    if name in _ROUNDED:
        values[values < _NOTHING] = 0.0
    if over is not None:
        values = values / over
    level, _, sea = path.split("/")[1:]
    labels = _labels(data, tuple(str(dim) for dim in data[name].dims))
    found = []
    for at in np.ndindex(values.shape):
        if not np.isnan(values[at]):
            where = ", ".join([level, sea, *(names[row] for names, row in zip(labels, at, strict=True))])
            scale = 1.0 if over is None else float(over[at[-1]])
            found.append(Largest(float(values[at]), where, path, data, at, name, scale))
    return sorted(found, key=lambda one: -one.value)


__all__ = ["Largest", "damping_band", "each_of"]
