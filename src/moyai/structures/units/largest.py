"""The largest value of a variable over seas, with what it varies by."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Bound
from moyai.design.anchor_needs import judged_end
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


def _where(path: str, data: xr.Dataset, index: tuple[int, ...], dims: tuple[str, ...]) -> str:
    level, _, sea = path.split("/")[1:]
    words = [level, sea]
    for dim, number in zip(dims, index):
        value = data[dim].values[number]
        words.append(f"T = {float(value):g} s" if dim == "period" else f"unit {value}" if dim == "unit" else str(value))
    return ", ".join(words)


@dataclass(frozen=True)
class Largest:
    """A value of a variable in a sea, the largest of its connectors, lines, gaps or units, and where it stands."""

    value: float
    where: str
    path: str
    data: xr.Dataset
    index: tuple[int, ...]
    name: str
    scale: float

    @property
    def dims(self) -> tuple[str, ...]:
        return tuple(str(dim) for dim in self.data[self.name].dims)

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
        """What chance and the damping of the units are worth; none of nothing."""
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
        """Return a band of realisations widened by what the damping of the units is worth."""
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
        """Whether a connector of the row bears and lets go, which its linear motions do not know."""
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


def members_of(path: str, data: xr.Dataset, name: str, over: Array | None = None) -> list[Largest]:
    """Return every known value of a sea, whose places are still to be said, the largest first."""
    if name not in data or not data[name].size:
        return []
    values = np.abs(np.asarray(data[name].values, dtype=float))
    if name in _ROUNDED:
        values[values < _NOTHING] = 0.0
    if over is not None:
        values = values / over
    indices = [index for index in np.ndindex(values.shape) if not np.isnan(values[index])]
    found = [
        Largest(float(values[at]), "", path, data, at, name, 1.0 if over is None else float(over[at[-1]]))
        for at in indices
    ]
    return sorted(found, key=lambda one: -one.value)


def regular_apart(seas: Seas) -> Seas:
    """Return the seas, regular waves of each period by themselves."""
    return [
        (path, data.isel(period=[row])) if "period" in data.dims else (path, data)
        for path, data in seas
        for row in range(data.sizes.get("period", 1))
    ]


def each_of(
    seas: Seas, name: str, over: Array | None = None, band: Callable[[Largest], Band | None] | None = None
) -> list[Largest]:
    """Return the largest value of every sea, of regular waves of every period, and that which is judged highest.

    Another line or connector may have the smaller value and the wider band, whose end is what a limit is held against.

    Parameters
    ----------
    seas : list of (path, dataset)
    name : str
    over : ndarray, optional
        What the last dimension is divided by.
    band : callable, optional
        Band of a value; its own when left out.
    """
    found: list[Largest] = []
    for path, data in regular_apart(seas):
        members = members_of(path, data, name, over)
        if not members:
            continue
        ends = [judged_end(one.value, band(one) if band is not None else one.band) for one in members]
        widest = int(np.argmax(ends))
        chosen = [members[0], members[widest]] if ends[widest] > ends[0] else members[:1]
        found += [replace(one, where=_where(path, data, one.index, one.dims)) for one in chosen]
    return found


__all__ = ["Largest", "damping_band", "each_of", "members_of", "regular_apart"]
