"""The conditions that the numbers of a cage's first page were found in: current, height and seed of the seas."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Headline
from moyai.core.validity import Notice
from moyai.sea.validity import check_realised_height

if TYPE_CHECKING:
    import xarray as xr

Groups = Mapping[str, "xr.Dataset"]


def sea_words(name: str, run: xr.Dataset, current: float, realisations: int = 1) -> str:
    """Return a sea in words: its name or wave, the seed of an irregular one, and the current of the site.

    Parameters
    ----------
    name : str
        Name of the sea state.
    run : xarray.Dataset
        Its series over time.
    current : float
        Speed of the current of the site [m/s].
    realisations : int
        Seeds that the number is of.
    """
    words = [name]
    if int(run.attrs["regular"]):
        words.append(str(run.attrs["wave"]))
    else:
        others = f" and {realisations - 1} more" if realisations > 1 else ""
        words.append(f"seed {int(run.attrs['seed'])}{others}")
    if current:
        words.append(f"current {abs(current):.3g} m/s")
    return ", ".join(words)


def runs_of(groups: Groups) -> Iterator[tuple[str, str, xr.Dataset]]:
    """Yield water level, name of the sea state and series of every run through time."""
    for path, run in groups.items():
        parts = path.strip("/").split("/")
        if len(parts) == 4 and parts[1] == "time":
            yield parts[0], parts[2], run


def condition_headlines(groups: Groups) -> tuple[Headline, ...]:
    """Return the current of the site, and the height of the irregular sea that fell shortest of what was asked.

    Parameters
    ----------
    groups : mapping of str to xarray.Dataset
        What was run, by its place in the result.
    """
    return (*_current(groups), *_height(groups))


def height_notices(name: str, run: xr.Dataset, sea: xr.Dataset | None = None) -> tuple[Notice, ...]:
    """Tell of an irregular sea whose record, or whose realisations in the mean, are clearly lower than what was asked.

    Parameters
    ----------
    name : str
        Name of the sea state.
    run : xarray.Dataset
        Its series over time.
    sea : xarray.Dataset, optional
        Its numbers, which know of realisations.
    """
    if int(run.attrs["regular"]):
        return ()
    return check_realised_height(name, _realised(run, sea), float(run.attrs["wave_height"]))


def _realised(run: xr.Dataset, sea: xr.Dataset | None) -> float:
    """Return the realised significant height, its mean over realisations where there are any [m]."""
    mean = None if sea is None else sea.attrs.get("realised_height")
    return float(run.attrs["realised_height"] if mean is None else mean)


def _current(groups: Groups) -> list[Headline]:
    levels = {path[1:]: group.attrs for path, group in groups.items() if path.count("/") == 1}
    speeds = {name: abs(float(attrs["current"])) for name, attrs in levels.items() if float(attrs["current"])}
    if not speeds:
        return []
    level = max(speeds, key=lambda name: speeds[name])
    swept = [
        float(speed)
        for name in levels
        if (statics := groups.get(f"/{name}/statics")) is not None and "current_speed" in statics.coords
        for speed in statics["current_speed"].values
        if abs(float(speed) - speeds.get(name, 0.0)) > 1e-9 and speed > 0.0
    ]
    detail = f"the sweep of {min(swept):.3g} to {max(swept):.3g} m/s decides no number" if swept else ""
    return [
        Headline("current_speed", "design current speed", speeds[level], "m/s", level, detail=detail, condition=True)
    ]


def _height(groups: Groups) -> list[Headline]:
    seas = [(level, name, run) for level, name, run in runs_of(groups) if not int(run.attrs["regular"])]
    if not seas:
        return []
    heights = [_realised(run, groups.get(f"/{level}/waves/{name}")) for level, name, run in seas]
    worst = int(np.argmin([height / run.attrs["wave_height"] for height, (*_, run) in zip(heights, seas, strict=True)]))
    level, name, run = seas[worst]
    realised, asked = heights[worst], float(run.attrs["wave_height"])
    seeds = sorted({int(run.attrs["seed"]) for _, _, run in seas})
    length = max(float(run["time"].values[-1]) - float(run.attrs["ramp"]), 0.0)
    detail = f"{asked:.3g} m asked; {length:.4g} s after the start; seed{'s' if len(seeds) > 1 else ''} "
    detail += ", ".join(map(str, seeds))
    sea = groups.get(f"/{level}/waves/{name}")
    if sea is not None and "seed_of_realisation" in sea and len(seeds) == 1:
        detail += f" and {sea.sizes['realisation'] - 1} more"
    return [
        Headline(
            "realised_height", "realised significant wave height", realised, "m", f"{name}, {level}", detail=detail,
            condition=True,
        )
    ]  # fmt: skip
