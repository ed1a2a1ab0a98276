"""What chance does to the largest values of a run: one record, realisations of a sea, motions that do not repeat."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array, BoolArray
from moyai.core.headline import Band, Bound
from moyai.core.wording import spoken, spoken_time
from moyai.series.block_maxima import LEAST_PERIODS, PERIODS, Maximum, maximum_of, too_short
from moyai.series.realisations import seeds
from moyai.structures.network.refinement import LANDING

if TYPE_CHECKING:
    import xarray as xr

#: Part by which the highest values of the periods of regular waves may differ where the motion repeats.
REPEATING = 0.05
ONE_SEED = "one seed: others may give more"
#: Lowest tension of a record over its mean below which a line comes near to slack: in another seed it may snap.
NEAR_SLACK = 1.0 / 3.0
#: Scatter of a pull over that of the tension of its line, below which the friction of the bed holds it.
HELD = 0.5
#: What is said of one seed in which lines snap, segments land or lines come near to slack, and what helps.
SNAPS_OF_ONE_SEED = "one seed of a line that snaps, lands or comes near to slack: others may give much more"
MORE_SEEDS, ONE_BY_ONE = "give the number of realisations to run them", "run the case with other seeds, one by one"
#: Key for more realisations.
MORE = "settings.realisations"


def series_of_run(groups: Mapping[str, xr.Dataset], level: str, run: str) -> xr.Dataset | None:
    """Return the record of a run over time."""
    return groups.get(f"/{level}/time/{run}")


def irregular(groups: Mapping[str, xr.Dataset], level: str, run: str) -> bool:
    """Whether a run is through an irregular sea."""
    series = series_of_run(groups, level, run)
    return series is not None and bool(int(series.attrs.get("irregular", 0)))


def _rows(series: xr.Dataset, full: bool = False) -> BoolArray:
    """Return which rows of a record count; with ``full`` those alone after waves, current and motions have grown."""
    begin = max(float(series.attrs["skip"]), float(series.attrs.get("growth", 0.0)) if full else 0.0)
    return np.asarray(series["time"].values >= series["time"].values[0] + begin)


def counted(series: xr.Dataset) -> xr.Dataset:
    """Return the part of a record that counts."""
    return series.isel(time=_rows(series))


def scatter_of(summary: xr.Dataset, name: str, run: str, **of: str) -> Array:
    """Return a largest value of the realisations of a run; none where fewer than two were run."""
    if name not in summary:
        return np.zeros(0)
    found = np.asarray(summary[name].sel({"run": run, **of}).values)
    found = found[np.isfinite(found)]
    return found if found.size > 1 else np.zeros(0)


def length_of(groups: Mapping[str, xr.Dataset], level: str, run: str, scatter: Array) -> tuple[str, Bound]:
    """Say in how long records of an irregular sea the largest values were found, and what they prove.

    Realisations of records too short to show the chance of one prove as little as one does: the largest of a storm is
    that of a longer record. Periods in which waves, current and motions still grow are none of theirs.

    Returns
    -------
    str
        Empty for other runs.
    bound
        ``at least`` where the records are too short.
    """
    series = series_of_run(groups, level, run)
    if series is None or not irregular(groups, level, run) or np.count_nonzero(_rows(series)) < 2:
        return "", ""
    time, period = series["time"].values[_rows(series, full=True)], float(series.attrs["period"])
    lasts = spoken_time(float(np.ptp(time)) if time.size else 0.0)
    words = f"largest in {lasts}"
    if scatter.size:
        words = f"mean of the largest of {scatter.size} records of {lasts}"
    if not too_short(time, period):
        return words, ""
    return f"{words}, less than {LEAST_PERIODS:g} periods: a longer sea gives more", "at least"


def one_seed_of_snaps(groups: Mapping[str, xr.Dataset], level: str, run: str, scatter: Array) -> list[str]:
    """Say of one seed of an irregular sea in which a line snaps or comes near to it that its band is no measure.

    The largest snaps grow faster than the maxima of blocks tell, and a seed of low waves knows nothing of the others.
    """
    summary = groups.get(f"/{level}/dynamic")
    if scatter.size or summary is None or not irregular(groups, level, run):
        return []
    snaps = "snap_count" in summary and bool((summary["snap_count"].sel(run=run).values > 0.0).any())
    if not (snaps or LANDING in str(summary.attrs.get(f"doubt {run}", "")) or _near_slack(groups, level, run)):
        return []
    # realisations of bodies are not run together
    return [SNAPS_OF_ONE_SEED, ONE_BY_ONE if "solid" in summary.coords else MORE_SEEDS]


def _near_slack(groups: Mapping[str, xr.Dataset], level: str, run: str) -> bool:
    """Whether a line comes near to slack in what counts of a record."""
    series = series_of_run(groups, level, run)
    if series is None:
        return False
    # each stretch of one type by itself: a chain over a wire stays taut by its weight
    for name in ("line_tension_peak_since_row", "stretch_tension"):
        record = series[name].values[_rows(series, full=True)] if name in series else np.zeros((0, 1))
        if record.size and (record.min(axis=0) < NEAR_SLACK * record.mean(axis=0)).any():
            return True
    return False


def of_record(groups: Mapping[str, xr.Dataset], level: str, run: str, line: str) -> tuple[Maximum | None, list[str]]:
    """Return the uncertainty of the highest tension of one record, and say the height that was realised."""
    series = series_of_run(groups, level, run)
    if series is None:
        return None, []
    values = _record(series, line)
    found = None if values is None else chance_of(series, values)
    if not irregular(groups, level, run):
        return found, []
    late, said = counted(series), []
    if "surface_elevation" in late:
        realised = 4.0 * float(late["surface_elevation"].values.std())
        said.append(f"realised Hs {realised:.2f} m of {series.attrs['wave_height']:.2f} m, seed {series.attrs['seed']}")
    if found is not None:
        said.append(
            f"largest of other seeds about {spoken(found.mean, 'N', 3)}, standard deviation "
            f"{spoken(found.deviation, 'N', 2, like=found.mean)}"
        )
    return found, said


def of_pull(
    groups: Mapping[str, xr.Dataset], level: str, run: str, series: xr.Dataset, point: str
) -> tuple[Maximum | None, str]:
    """Return the uncertainty of the largest pull of one record on a point, and what else it is of.

    Where the bed holds a line by its friction the pull of a whole record may stay at its rest, while that of another
    one grows by what passes the friction: as much as the tension over the bed, at most.
    """
    values = series["point_load_peak_since_row"].sel(point=point, measure="size").values
    found, network = chance_of(series, values), groups.get(f"/{level}/network")
    if found is None or network is None or not irregular(groups, level, run):
        return found, ""
    node = int(network["point_node"].sel(point=point))
    here = (network["bar_start"].values == node) | (network["bar_end"].values == node)
    lines = {str(name) for name in network["bar_line"].values[here]} & {str(name) for name in series["line"].values}
    for line in sorted(lines):
        own = chance_of(series, series["line_tension_peak_since_row"].sel(line=line).values)
        if own is not None and found.deviation < HELD * own.deviation:
            moved = found.observed + own.mean - own.observed
            return Maximum(found.observed, moved, own.deviation, own.blocks), f"as the tension of {line} over the bed"
    return found, ""


def _record(series: xr.Dataset, line: str) -> Array | None:
    """Return the highest tension since the row before of a line or net; None where it is not kept."""
    key, axis = "net_tension", "net"
    for kind in ("part", "line"):
        if kind in series and line in series[kind].values:
            key, axis = f"{kind}_tension_peak_since_row", kind
    return np.asarray(series[key].sel({axis: line}).values) if key in series else None


def chance_of(series: xr.Dataset, values: Array, *, as_tension: bool = False) -> Maximum | None:
    """Return what the largest of a record stands for: one seed of an irregular sea, or a motion that does not repeat.

    ``None`` where too little of the record is at full motion, or a motion of regular waves repeats.

    Parameters
    ----------
    series : xarray.Dataset
        Of the whole run.
    values : ndarray, shape (rows,)
        A load or an offset in it.
    as_tension : bool
        Whether a motion in which the highest tension does not repeat counts, though these values nearly do.
    """
    if int(series.attrs.get("irregular", 0)):
        grown = _rows(series, full=True)
        return maximum_of(series["time"].values[grown], values[grown], float(series.attrs["period"]))
    late = _rows(series)
    time = series["time"].values[late]
    found = of_periods(series, time, values[late])
    if found is None and as_tension and "line_tension_peak_since_row" in series and series.sizes["line"]:
        highest = series["line_tension_peak_since_row"].values[late].max(axis=1)
        if of_periods(series, time, highest) is not None:
            return of_periods(series, time, values[late], 0.0)
    return found


def of_periods(series: xr.Dataset, time: Array, values: Array, repeating: float = REPEATING) -> Maximum | None:
    """Return what the largest of a regular motion that never repeats stands for, ``None`` where it repeats.

    The highest values of its periods are then taken as those of blocks of a record; periods in which waves or motions
    still grow are none of them, where enough are left without.
    """
    period = float(series.attrs.get("period", math.nan))
    if not (math.isfinite(period) and period > 0.0 and time.size > 1 and np.isfinite(values).all()):
        return None
    count = int((time[-1] - time[0]) / period + 1e-9)
    highest = [float(part.max()) for part in np.array_split(values, count)] if count else [0.0]
    if min(highest) >= (1.0 - repeating) * max(highest):
        return None
    grown = time >= float(series["time"].values[0]) + float(series.attrs.get("growth", 0.0))
    found = maximum_of(time[grown], values[grown], period / PERIODS)
    if found is None:
        return maximum_of(time, values, period / PERIODS)
    return replace(found, observed=float(values.max()))


def with_chance(value: float, band: Band | None, found: Maximum, of_sea: bool = True) -> Band:
    """Return the band of mesh and step, where there is one, and of the chance of one record."""
    low, high, of = (value, value, "") if band is None else (band.low, band.high, band.of)
    least, highest = found.range
    return Band(max(min(low, least), 0.0), max(high, highest), "; ".join(filter(None, (of, of_seeds(found, of_sea)))))


def with_seeds(value: float, band: Band | None, scatter: Array) -> Band | None:
    """Return the band of realisations, widened in proportion by that of mesh and step where there is one."""
    found = seeds(scatter, more=MORE)
    if found is None or band is None or not value > 0.0:
        return found or band
    wider = found.scaled(band.low / value, band.high / value)
    return replace(wider, of=f"{band.of}; {found.of}")


def of_seeds(found: Maximum, of_sea: bool = True) -> str:
    """Say of what chance a band is."""
    if not of_sea:
        return f"90 of 100 records as long, estimated from {found.blocks} parts of a motion that does not repeat"
    return f"90 of 100 seeds, estimated from {found.blocks} blocks of the record of one"
