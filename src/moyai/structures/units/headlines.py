"""The numbers of the first page of a row: connectors, lines, waves behind, motions.

How the answer is made: docs/answer/units.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.headline import Bound, Headline
from moyai.core.wording import spoken

if TYPE_CHECKING:
    import xarray as xr

MODEL = "linear, three dimensions"
AT_REST = "linear, lines at rest at every instant"


def headlines_of(groups: Mapping[str, xr.Dataset]) -> tuple[Headline, ...]:
    """Return the first page's numbers."""
    seas = [(path, data) for path, data in groups.items() if path.count("/") == 3 and path.split("/")[2] == "frequency"]
    maps = [(path, data) for path, data in groups.items() if path.count("/") == 3 and path.split("/")[2] == "map"]
    rests = [(path, data) for path, data in groups.items() if path.endswith("/statics")]
    found: list[Headline] = []
    if seas:
        found += _connectors(groups, seas)
        found += _lines(groups, seas)
        found += _motions(seas)
    found += _waves(maps)
    for name, label in (("freeboard", "Freeboard"), ("metacentric_height", "Metacentric height GM of a unit")):
        known = [(float(data[name]), path.split("/")[1]) for path, data in rests]
        if known:
            value, level = min(known)
            found.append(Headline(name, label, value, "m", level, "still water"))
    found.append(
        Headline(
            "not_judged", "Not judged", math.nan, "1",
            text="time domain, slow drift, fatigue",
            detail="no impacts and snaps in time, no slow drift about the mean, no lines in motion, no fatigue",
        )
    )  # fmt: skip
    return tuple(found)


def _where(path: str, data: xr.Dataset, index: tuple[int, ...], dims: tuple[str, ...]) -> str:
    level, _, sea = path.split("/")[1:]
    words = [level, sea]
    for dim, number in zip(dims, index):
        value = data[dim].values[number]
        words.append(f"T = {float(value):g} s" if dim == "period" else f"unit {value}" if dim == "unit" else str(value))
    return ", ".join(words)


def _greatest(
    groups: list[tuple[str, xr.Dataset]], name: str, over: Array | None = None
) -> tuple[float, str, tuple[str, xr.Dataset, tuple[int, ...]]] | None:
    best: tuple[float, str, tuple[str, xr.Dataset, tuple[int, ...]]] | None = None
    for path, data in groups:
        if name not in data or not data[name].size:
            continue
        values = np.abs(np.asarray(data[name].values, dtype=float))
        if over is not None:
            values = values / over
        if not np.isfinite(values).any():
            continue
        index = tuple(int(i) for i in np.unravel_index(int(np.nanargmax(values)), values.shape))
        value = float(values[index])
        if best is None or value > best[0]:
            best = value, _where(path, data, index, tuple(str(dim) for dim in data[name].dims)), (path, data, index)
    return best


#: Groups of waves move a row on chains slowly and far about its mean place; a single unit with it has several times the
#: tension. Without it tensions and offsets of an irregular sea prove no strength.
_WITHOUT_DRIFT = "; slow drift about the mean is not computed and adds to it, on chains several times over"


def _bound(data: xr.Dataset) -> Bound:
    """Return ``at least`` for an irregular sea, whose slow drift is left out."""
    return "at least" if "significant_motion" in data else ""


def _connectors(groups: Mapping[str, xr.Dataset], seas: list[tuple[str, xr.Dataset]]) -> Iterator[Headline]:
    found = _greatest(seas, "connector_resultant_largest")
    if found is None:
        return
    value, where, (path, _, _) = found
    words = "mean and waves together, along the direction that bears most"
    yield Headline("connector_force", "Largest force in a connector", value, "N", where, MODEL, detail=words)
    rest = groups[f"/{path.split('/')[1]}/statics"]
    load = np.asarray(rest["connector_breaking_load"].values, dtype=float)
    if np.isfinite(load).any():
        share = _greatest(seas, "connector_resultant_largest", over=load)
        if share is not None:
            yield Headline(
                "connector_utilisation",
                "Largest force over breaking load of a connector",
                share[0],
                "1",
                share[1],
                MODEL,
            )
    moment = _greatest(seas, "connector_moment_largest")
    if moment is not None and moment[0] > 0.0:
        yield Headline("connector_moment", "Largest moment in a connector", moment[0], "N m", moment[1], MODEL)
    opening = _greatest(
        [(place, item.assign(opening=item["relative_motion_largest"].sel(component="y"))) for place, item in seas],
        "opening",
    )
    if opening is not None and opening[0] > 1e-9:
        yield Headline(
            "gap_motion", "Largest opening and closing of a gap at a connector", opening[0], "m", opening[1], MODEL
        )


def _lines(groups: Mapping[str, xr.Dataset], seas: list[tuple[str, xr.Dataset]]) -> Iterator[Headline]:
    found = _greatest(seas, "line_tension_maximum")
    if found is None:
        return
    value, where, (path, data, index) = found
    mean = float(data["line_tension_mean"].values[index])
    yield Headline(
        "line_tension", "Largest tension of a line", value, "N", where, AT_REST, mean=mean, bound=_bound(data),
        detail=f"mean {spoken(mean, 'N', 3)}" + _WITHOUT_DRIFT * bool(_bound(data)),
        analysis="quasi_static",
    )  # fmt: skip
    load = np.asarray(groups[f"/{path.split('/')[1]}/statics"]["breaking_load"].values, dtype=float)
    if np.isfinite(load).any():
        share = _greatest(seas, "line_tension_maximum", over=load)
        if share is not None:
            _, _, (_, other, place) = share
            part = float(other["line_tension_mean"].values[place] / load[place[-1]])
            yield Headline(
                "line_utilisation", "Tension over breaking load of a line", share[0], "1", share[1], AT_REST, mean=part,
                bound=_bound(other), analysis="quasi_static",
            )  # fmt: skip


def _motions(seas: list[tuple[str, xr.Dataset]]) -> Iterator[Headline]:
    offset = _greatest(seas, "largest_offset")
    if offset is not None:
        yield Headline(
            "offset", "Largest sway of a unit from rest", offset[0], "m", offset[1], MODEL,
            bound=_bound(offset[2][1]), detail="mean and waves" + _WITHOUT_DRIFT * bool(_bound(offset[2][1])),
        )  # fmt: skip
    rolls = []
    for path, data in seas:
        name = "significant_motion" if "significant_motion" in data else "motion_amplitude"
        factor = 1.0 if name == "significant_motion" else 2.0
        rolls.append((path, data.assign(roll=factor * data[name].sel(dof="roll"))))
    roll = _greatest(rolls, "roll")
    if roll is not None:
        yield Headline("roll", "Largest roll of a unit (double amplitude, significant in seas)", roll[0], "rad",
                       roll[1], MODEL)  # fmt: skip


def _waves(maps: list[tuple[str, xr.Dataset]]) -> Iterator[Headline]:
    found = _greatest(maps, "transmission_coefficient")
    if found is not None:
        value, where, (_, data, index) = found
        alone = float(np.atleast_1d(data["section_transmission"].values)[index[0] if index else 0])
        words = "root mean square of K along the line behind"
        if math.isfinite(alone):
            words += f"; the section alone, without ends and gaps, {alone:.3g}"
        yield Headline("transmission", "Transmission over the line behind", value, "1", where, MODEL, detail=words)
        for path, data in maps:
            if not data["transmission_coefficient"].dims:
                level, _, sea = path.split("/")[1:]
                yield Headline(
                    "transmission", "Transmission over the line behind", float(data["transmission_coefficient"]), "1",
                    level, MODEL, sea=sea, shown=False,
                )  # fmt: skip
    point = _greatest(maps, "wave_height_ratio_of_point")
    if point is not None:
        yield Headline(
            "berth_wave_height", "Largest wave height at a named point over the incident one", point[0], "1", point[1],
            MODEL,
        )  # fmt: skip
