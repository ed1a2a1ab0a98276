"""The bands of a cage's numbers: chance of the seed, periods that have not settled, laws of the net.

How the answer is made: docs/answer/cage.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Band, Headline
from moyai.series.block_maxima import LEAST_PERIODS, maximum_of
from moyai.structures.cage.flexible.law_runs import line_quantity
from moyai.structures.cage.flexible.sensitivity import DRAG, LEAST_VOLUME, NET_TENSION, OFFSET, STRESS
from moyai.structures.cage.settling import by_period, is_settled, scatters, still_to_come

if TYPE_CHECKING:
    import xarray as xr

TOO_SHORT = "one seed, too short to show the scatter of its maximum"
FEW_WAVES = f"records of fewer than {LEAST_PERIODS:g} peak periods: a longer sea gives more"
UNSETTLED = "regular waves whose periods do not repeat yet"
NO_LAWS = "without the net laws in the sea, whose runs failed"
_SAME_LAWS = "the same net laws as for the volume"
#: Numbers of the first page that a run under another law gives, those of lines apart.
_IN_WAVES = {
    "volume_share": LEAST_VOLUME, "drag": DRAG, "largest_offset": OFFSET, "net_tension": NET_TENSION,
    "collar_stress": STRESS,
}  # fmt: skip


@dataclass(frozen=True, eq=False)
class LawRuns:
    """What the other valid laws make of the numbers of a wave, as factors."""

    #: Of each quantity.
    factors: Mapping[str, tuple[float, float]]
    #: Names of the laws next to that of the case.
    laws: tuple[str, ...]
    regular: bool
    #: Whether a run under a law failed.
    failed: bool = False

    @classmethod
    def of(cls, group: xr.Dataset) -> LawRuns:
        """Return the ratios of the runs of a wave."""
        values = group["value"].values
        factors = {}
        for number, quantity in enumerate(group.variables["quantity"].values):
            if values[0, number] > 0.0 and np.isfinite(values[:, number]).all():
                ratio = values[:, number] / values[0, number]
                factors[str(quantity)] = float(ratio.min()), float(ratio.max())
        names = tuple(str(name) for name in group.variables["law"].values[1:])
        return cls(factors, names, bool(group.attrs["regular"]), bool(group.attrs["missing"]))


#: Of one place in the result each: the level, the sea and the wave.
AllRuns = Mapping[str, LawRuns]


@dataclass(frozen=True, eq=False)
class LevelState:
    """The equilibrium in the current of the site at one water level.

    Without ``statics`` there is only what the laws of nets change in it, which numbers of a sea carry.
    """

    level: str
    speed: float
    row: int
    cage: xr.Dataset
    statics: xr.Dataset
    laws: xr.Dataset | None
    #: The laws in the governing waves, and the place of the wave given.
    law_runs: AllRuns = field(default_factory=dict)
    wave: str = ""

    @property
    def where(self) -> str:
        """Current and level."""
        return f"current {self.speed:.3g} m/s, {self.level}"

    def _by_law(self, name: str, line: int | None) -> Array | None:
        """Return a number, that of one line where it is named, under every valid law; None without a second one."""
        if self.laws is None or self.laws.sizes["law"] < 2:
            return None
        if line is not None:
            return np.asarray(self.laws["law_line_tension"].values[:, line])
        return np.asarray(self.laws[f"law_{name}"].values)

    def band(self, name: str, line: int | None = None) -> Band | None:
        """Return the range of a number, of one line where it is named, over the laws valid for this net."""
        values = self._by_law(name, line)
        if values is None or self.laws is None:
            return None
        words = laws_text(self.laws) if name == "volume_share" else _SAME_LAWS
        return Band(float(np.min(values)), float(np.max(values)), words)

    def moved(self, name: str, low: float, high: float, line: int | None = None) -> tuple[float, float, str]:
        """Return a range in the sea with what the laws change in it.

        In a wave that was run under the laws by their ratio there; in others by the largest ratio of all such
        waves and, added, what the laws change in the current alone, since the sea moves the cage about its place in it.
        A short part of an irregular sea is but a sample: both count there too. The words are empty where no second law
        is valid.

        Parameters
        ----------
        name : str
            Of the number.
        low, high : float
            Range without the laws.
        line : int, optional
            Which line, by its place among all.
        """
        least, most, words = low, high, []
        own = self.law_runs.get(self.wave)
        ratios = [own] if own is not None else list(self.law_runs.values())
        known = [one.factors[key] for one in ratios if (key := self._key(name, line)) in one.factors]
        if known:
            least, most = low * min(less for less, _ in known), high * max(more for _, more in known)
            laws = ", ".join(dict.fromkeys(law for one in ratios for law in one.laws))
            if laws:
                words.append(_said(own, laws))
        if own is None or not own.regular or not known or own.failed:
            values = self._by_law(name, line)
            if values is not None and np.isfinite(values).all():
                change = values - float(values[0])
                least, most = min(least, low + float(change.min())), max(most, high + float(change.max()))
                words.append(f"{_SAME_LAWS}, by their change in the current alone")
        if any(one.failed for one in ratios):
            words.append(NO_LAWS)
        return max(least, 0.0), most, "; ".join(words)

    def _key(self, name: str, line: int | None) -> str:
        """Return the quantity of a run under another law that a number is."""
        if line is None:
            return _IN_WAVES.get(name, "")
        return line_quantity(str(self.cage.variables["line"].values[line])) if "line" in self.cage.variables else ""


def _said(own: LawRuns | None, laws: str) -> str:
    """Return in which waves the laws were run."""
    if own is None:
        return f"net laws run in the governing waves, by their ratio: {laws}"
    return f"net laws run in this wave: {laws}" if own.regular else f"net laws run about its highest moment: {laws}"


def band_in_sea(
    state: LevelState | None,
    name: str,
    run: xr.Dataset,
    value: float,
    series: Array,
    line: int | None = None,
    scale: float | None = None,
) -> Band | None:
    """Return the band of a number found in the sea: chance of its seed, and the laws of the net."""
    return band_with_laws(state, name, *reach(run, value, series, scale=scale), line)


def band_with_laws(
    state: LevelState | None, name: str, low: float, high: float, seed: str, line: int | None = None
) -> Band | None:
    """Return a range over seeds with what the laws of the net add; None where neither is known."""
    words = [seed] if seed else []
    if state is not None:
        low, high, text = state.moved(name, low, high, line)
        words += [text] if text else []
    return Band(max(low, 0.0), high, "; ".join(words)) if words else None


def chance(run: xr.Dataset, value: float, series: Array, time: Array | None = None) -> tuple[float, float, str]:
    """Return a range of the largest value over other seeds, with its words; none in regular waves or short records."""
    if int(run.attrs["regular"]):
        return value, value, ""
    times = run["time"].values if time is None else time
    late = times >= float(run.attrs["ramp"])
    found = maximum_of(times[late], series[late], float(run.attrs["period"]))
    if found is None:
        return value, value, TOO_SHORT
    low, high = found.range
    words = f"90 of 100 seeds, estimated from {found.blocks} blocks of the record of one"
    return max(min(value, low), 0.0), max(value, high), words


def reach(
    run: xr.Dataset, value: float, series: Array, time: Array | None = None, scale: float | None = None
) -> tuple[float, float, str]:
    """Return a range of the largest value with its words: over other seeds, of regular waves as far as they repeat.

    Periods that repeat have no range, those that never do one of records as long; the words begin with ``UNSETTLED``
    where more periods bring more. ``scale`` is what a rise is a part of, the value itself by default.
    """
    if not int(run.attrs["regular"]):
        return chance(run, value, series, time)
    times = run["time"].values if time is None else time
    period, ramp = float(run.attrs["period"]), float(run.attrs["ramp"])
    highest = by_period(times, series, period, ramp)
    scale = abs(value) if scale is None else scale
    if is_settled(highest, scale):
        more = max(float(highest[-1]) + still_to_come(highest) - value, 0.0)
        # what rounding and the rows of a period hide is not reported
        known = more > 2e-3 * scale
        return value, value + more, f"periods still to come {100.0 * more / scale:.2g} %" if known else ""
    late = times >= ramp
    found = maximum_of(times[late], series[late], period) if scatters(highest, scale) else None
    if found is None:
        return value, value, UNSETTLED
    low, high = found.range
    words = f"90 of 100 records as long, estimated from {found.blocks} parts of a motion that does not repeat"
    return max(min(value, low), 0.0), max(value, high), words


def alone(item: Headline) -> Headline:
    """Return a number that is known as a bound alone as one: more is to come, of a volume less.

    That of seeds too short to show the scatter of a storm, of waves that have not settled, without the laws in the sea.
    """
    if item.band is None or not any(words in item.band.of for words in (TOO_SHORT, FEW_WAVES, UNSETTLED, NO_LAWS)):
        return item
    return replace(item, bound="at most" if item.name == "volume_left" else "at least")


def laws_text(laws: xr.Dataset) -> str:
    return f"law of the case and those valid for this net: {laws.attrs['valid']}"
