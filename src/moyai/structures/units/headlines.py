"""The numbers of the first page of a row: connectors, lines, waves behind, motions.

How the answer is made: docs/answer/units.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Bound, Headline, all_judged, governing
from moyai.series.realisations import ALONE
from moyai.structures.units import doubts
from moyai.structures.units.anchor_headlines import anchor_headlines
from moyai.structures.units.anchors import has_anchors, with_anchor_loads
from moyai.structures.units.datasets import BANDED
from moyai.structures.units.equilibrium_headlines import stability_headlines, steady_headlines
from moyai.structures.units.largest import Largest, each_of
from moyai.structures.units.line_headlines import left_out, line_headlines, with_unknown
from moyai.structures.units.unjudged import Seas, not_judged, not_judged_at_rest

if TYPE_CHECKING:
    import xarray as xr

MODEL = "linear, three dimensions"
TIME = "time domain, three dimensions"


def headlines_of(groups: Mapping[str, xr.Dataset]) -> tuple[Headline, ...]:
    """Return the first page's numbers."""
    seas = governing_seas(groups)
    maps = [(path, data) for path, data in groups.items() if path.count("/") == 3 and path.split("/")[2] == "map"]
    rests = [(path, data) for path, data in groups.items() if path.endswith("/statics")]
    found: list[Headline] = []
    if seas:
        found += _connectors(groups, seas)
        found += _gaps(groups, seas)
        found += line_headlines(groups, seas)
        found += anchor_headlines(seas)
        found += _motions(seas)
    else:
        found += steady_headlines(rests)
    found += _waves(maps)
    found += stability_headlines(rests)
    found.append(not_judged(seas) if seas else not_judged_at_rest(rests))
    return tuple(found)


def governing_seas(groups: Mapping[str, xr.Dataset]) -> Seas:
    """Return what governs every sea: the time domain where it came to its end, else the frequency domain."""
    found = []
    for path, data in groups.items():
        if path.count("/") != 3 or path.split("/")[2] != "frequency":
            continue
        other = path.replace("/frequency/", "/time/", 1)
        if other in groups and groups[other].attrs.get("status") == "converged":
            found.append((other, _with_damping(groups[other], data)))
        else:
            found.append((path, data))
    return [(path, _with_rest(groups, path, data)) for path, data in found]


def _with_rest(groups: Mapping[str, xr.Dataset], path: str, data: xr.Dataset) -> xr.Dataset:
    """Return a sea with curves, gaps and endurance of its row at rest, and whether hulls meet at the most."""
    rest = groups.get(f"/{path.split('/')[1]}/statics")
    if rest is None:
        return data
    names = ("curve_lowest", "curve_highest", "gap_width", "connector_endurance_exponent")
    data = data.assign({name: rest[name] for name in names if name in rest})
    if "line_tension_maximum" in data and has_anchors(rest):
        # with damping at its ends, which the time domain takes from the frequency domain
        data = with_anchor_loads(data, rest).assign({name: rest[name] for name in rest if "anchor_curve" in str(name)})
    return doubts.with_meeting(data, data["gap_width"].values) if "gap_width" in data else data


def _with_damping(time: xr.Dataset, frequency: xr.Dataset) -> xr.Dataset:
    """Return a sea in time with the ends over the damping of the units, by their change in the frequency domain.

    Ends that were run in time stay.
    """
    found = {}
    for name in BANDED:
        if (
            name not in time
            or f"{name}_low" in time
            or f"{name}_low" not in frequency
            or time[name].dims != frequency[name].dims
        ):
            continue
        own = frequency[name].values
        for end in ("low", "high"):
            with np.errstate(divide="ignore", invalid="ignore"):
                ratio = np.where(own > 0.0, frequency[f"{name}_{end}"].values / own, 1.0)
            found[f"{name}_{end}"] = (time[name].dims, time[name].values * ratio)
    return time.assign(found)


def _gaps(groups: Mapping[str, xr.Dataset], seas: Seas) -> Iterator[Headline]:
    statics = groups[f"/{seas[0][0].split('/')[1]}/statics"]
    if "gap_width" not in statics or not statics.sizes["gap"]:
        return
    width = np.asarray(statics["gap_width"].values, dtype=float)
    yield from all_judged([_closing(found) for found in each_of(seas, "gap_closing_largest", over=width)])


def _closing(found: Largest) -> Headline:
    """Return how far a gap closes; units that nothing joins drift against each other as well."""
    apart = "; ".join(filter(None, (found.why_loose, left_out(found)[2:] * found.drift_left_out)))
    detail = f"{found.value * found.scale:.3g} m of {found.scale:.3g} m; at 1 the hulls touch"
    return Headline(
        "gap_closing", "Largest share of a gap that closes at a corner of the hulls", found.value, "1",
        found.where, _model(found), band=found.band, bound="at least" if apart else _of_motion(found),
        detail="; ".join(filter(None, (detail, apart))),
    )  # fmt: skip


def _connectors(groups: Mapping[str, xr.Dataset], seas: Seas) -> Iterator[Headline]:
    each = each_of(seas, "connector_resultant_largest")
    if not each:
        return
    yield from _as_known(each, [_connector_force(found) for found in each])
    load = np.asarray(groups[f"/{each[0].path.split('/')[1]}/statics"]["connector_breaking_load"].values, dtype=float)
    moments = [found for found in each_of(seas, "connector_moment_largest") if found.value > 0.0]
    if np.isfinite(load).any():
        shares = each_of(seas, "connector_resultant_largest", over=load)
        yield from _as_known(
            shares,
            [
                Headline(
                    "connector_utilisation", "Largest force over breaking load of a connector", share.value, "1",
                    share.where, _model(share), band=share.band, bound=_of_motion(share),
                    judged_on="the force without the moment" * bool(moments), digits=share.digits,
                )
                for share in shares
            ],
        )  # fmt: skip
    yield from _as_known(
        moments,
        [
            Headline(
                "connector_moment", "Largest moment in a connector", found.value, "N m", found.where, _model(found),
                band=found.band, bound=_of_motion(found),
            )
            for found in moments
        ],
    )  # fmt: skip
    opened = each_of([(path, _with_opening(data)) for path, data in seas], "opened")
    openings = [found for found in opened if found.value > 1e-9]
    yield from _as_known(
        openings,
        [
            Headline(
                "gap_motion", "Largest opening and closing of a gap at a connector, about its mean", opening.value, "m",
                opening.where, _model(opening), band=opening.band, bound=_of_motion(opening),
                detail=opening.why_loose,
            )
            for opening in openings
        ],
    )  # fmt: skip
    worn = [(path, _with_damage(data)) for path, data in seas if "connector_damage_rate" in data]
    damages = each_of([item for item in worn if "duration" in item[1].attrs], "worn")
    yield from _as_known(
        damages,
        [
            Headline(
                "connector_damage", "Fatigue damage of a connector in this sea", damage.value, "1",
                damage.where, TIME, band=damage.band, bound=damage.bound,
                detail=f"in {float(damage.data.attrs['duration']) / 3600.0:.3g} h, cycles by rainflow",
            )
            for damage in damages
        ],
    )  # fmt: skip


def _as_known(each: list[Largest], items: list[Headline]) -> list[Headline]:
    """Return what governs of numbers of connectors, those first of which nothing is known as hulls meet.

    Of a load of which the linear answer has nothing at all nothing is known either.
    """
    found = []
    for one, item in zip(each, items, strict=True):
        if doubts.meets(one.data):
            found.append((replace(one, value=math.inf), doubts.not_known(item, doubts.MEET)))
        elif item.bound == "at least" and item.value == 0.0:
            # before a sea that is known to give nothing
            found.append((replace(one, value=1e-300), doubts.not_known(item, _reasons(one))))
        else:
            found.append((one, item))
    return with_unknown([one for one, _ in found], [item for _, item in found])


def _of_motion(found: Largest) -> Bound:
    """Return ``at least`` where the units move against each other beyond what their linear motion knows."""
    doubted = (
        found.strained or found.why_loose or doubts.stretched(found.data) or found.why_beyond or found.drift_left_out
    )  # fmt: skip
    return "at least" if doubted else found.bound


def _with_opening(data: xr.Dataset) -> xr.Dataset:
    """Return a sea with the opening of its gaps, its realisations where they are known."""
    found = {
        f"opened{end}": data[f"relative_motion_largest{end}"].sel(component="y")
        for end in ("", "_low", "_high")
        if f"relative_motion_largest{end}" in data
    }
    if "gap_motion_largest_of_realisation" in data:
        found["opened_of_realisation"] = data["gap_motion_largest_of_realisation"]
    return data.assign(found)


def _with_damage(data: xr.Dataset) -> xr.Dataset:
    """Return a sea with the share of the life of its connectors that it takes, its realisations where known."""
    span = float(data.attrs.get("duration", math.nan))
    found = {"worn": data["connector_damage_rate"] * span}
    if "connector_damage_rate_of_realisation" in data:
        found["worn_of_realisation"] = data["connector_damage_rate_of_realisation"] * span
    force = data.get("connector_resultant_largest")
    if "connector_endurance_exponent" in data and "connector_resultant_largest_low" in data and force is not None:
        # ranges of force follow the largest one
        for end in ("low", "high"):
            ratio = (data[f"connector_resultant_largest_{end}"] / force).where(force > 0.0, 1.0)
            found[f"worn_{end}"] = found["worn"] * ratio ** data["connector_endurance_exponent"]
    return data.assign(found)


def _connector_force(found: Largest) -> Headline:
    words = (
        "largest of the record, all components together"
        if found.timed
        else "mean and waves together, along the direction of the largest force"
    )
    return Headline(
        "connector_force", "Largest force in a connector", found.value, "N", found.where, _model(found),
        band=found.band, bound=_of_motion(found),
        detail="; ".join(filter(None, (words, _reasons(found)))), digits=found.digits,
    )  # fmt: skip


def _reasons(found: Largest) -> str:
    """Return why a force is no more than a bound."""
    across = f"motion across would stretch a connector by {doubts.stretched(found.data):.3g} m, not counted"
    details = (
        ALONE if found.bound else "", across if doubts.stretched(found.data) else "", found.why_loose, found.why_beyond,
        doubts.STRAINED if found.strained else "", left_out(found)[2:] * found.drift_left_out,
    )  # fmt: skip
    return "; ".join(filter(None, details))


def _model(found: Largest) -> str:
    return TIME if found.timed else MODEL


def _motions(seas: Seas) -> Iterator[Headline]:
    offsets = []
    each = each_of(seas, "largest_offset")
    for offset in each:
        words = "mean, slow drift and waves" if offset.timed and not offset.drift_left_out else "mean and waves"
        offsets.append(
            Headline(
                "offset", "Largest offset of a unit from rest", offset.value, "m", offset.where, _model(offset),
                bound="at least"
                if offset.without_drift
                or offset.lets_go
                or doubts.stretched(offset.data)
                or offset.strained
                else offset.bound,
                band=offset.band,
                detail=words + left_out(offset) + f"; {doubts.LETS_GO}" * offset.lets_go,
            )
        )  # fmt: skip
    yield from _with_meeting_unknown(each, offsets)
    tilts, turns = [], []
    for dof in ("roll", "pitch"):
        turned = each_of([(path, _with_tilt(data, dof)) for path, data in seas], "tilt")
        turns += turned
        tilts += [
            Headline(
                "roll", f"Largest {dof} of a unit, double amplitude", tilt.value, "rad", tilt.where, _model(tilt),
                band=tilt.band, bound="at least" if tilt.lets_go or tilt.strained else tilt.bound,
            )
            for tilt in turned
        ]  # fmt: skip
    yield from _with_meeting_unknown(turns, tilts)


def _with_meeting_unknown(each: list[Largest], items: list[Headline]) -> list[Headline]:
    """Return what governs of motions; those of hulls that meet, first, are not known."""
    met = [doubts.meets(one.data) for one in each]
    kept = [doubts.not_known(item, doubts.MEET) if hit else item for item, hit in zip(items, met, strict=True)]
    ranked = [replace(one, value=math.inf) if hit else one for one, hit in zip(each, met, strict=True)]
    return with_unknown(ranked, kept)


def greatest_rolls(seas: Seas) -> list[tuple[str, float]]:
    """Return the largest roll [rad] of every sea from upright, at the end of its band, and where: level, sea, unit."""
    rolls: dict[int, tuple[str, float]] = {}
    for found in each_of([(path, _with_tilt(data, "roll")) for path, data in seas], "tilt"):
        mean = abs(float(found.data["mean_offset"].sel(dof="roll").values[found.index]))
        roll = mean + 0.5 * max(found.value, 0.0 if found.band is None else found.band.high)
        # members of a sea, or of one period of it, share its data
        sea = id(found.data)
        rolls[sea] = max(rolls.get(sea, ("", -math.inf)), (found.where, roll), key=lambda one: one[1])
    return list(rolls.values())


def _with_tilt(data: xr.Dataset, dof: str) -> xr.Dataset:
    """Return a sea with the largest double amplitude of a turn, its ends over the damping and its realisations."""
    regular = "significant_motion" not in data
    spread = "motion_amplitude" if regular else "significant_motion"
    several = "maximum_motion_of_realisation" in data  # of regular waves: a motion that does not repeat
    wanted = (
        ("maximum_motion",)
        if regular and several
        else ()
        if regular
        else ("most_probable_maximum_motion", "maximum_motion")
    )
    largest = next((name for name in wanted if name in data), spread)
    tilt = 2.0 * data[largest].sel(dof=dof)
    found = {"tilt": tilt}
    if f"{largest}_of_realisation" in data:
        found["tilt_of_realisation"] = 2.0 * data[f"{largest}_of_realisation"].sel(dof=dof)
    own = data[spread].sel(dof=dof)
    for end in ("_low", "_high"):
        if f"{spread}{end}" in data:
            found[f"tilt{end}"] = tilt * (data[f"{spread}{end}"].sel(dof=dof) / own).where(own > 0.0, 1.0)
    return data.assign(found)


def _waves(maps: list[tuple[str, xr.Dataset]]) -> Iterator[Headline]:
    passed = each_of(maps, "transmission_coefficient")
    items = [
        Headline(
            "transmission", "Transmission over the line behind", one.value, "1", one.where, MODEL, band=one.band,
            detail=_of_section(one),
        )
        for one in passed
    ]  # fmt: skip
    yield from governing(items)
    for one, item in zip(passed, items, strict=True):
        yield replace(item, detail="", sea=one.path.split("/")[3], shown=False)
    yield from governing(
        Headline(
            "berth_wave_height", "Largest wave height at a named point over the incident one", point.value, "1",
            point.where, MODEL, band=point.band,
        )
        for point in each_of(maps, "wave_height_ratio_of_point")
    )  # fmt: skip


def _of_section(found: Largest) -> str:
    """Say what the transmission is, and that of the section alone."""
    words = "root mean square of K along the line behind"
    section = float(np.atleast_1d(found.data["section_transmission"].values)[found.index[0] if found.index else 0])
    return f"{words}; the section alone, without ends and gaps, {section:.3g}" if math.isfinite(section) else words
