"""Why a number of connectors and gaps is no more than a bound, or not known at all."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterator, Mapping
from functools import reduce
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Headline
from moyai.core.validity import Notice
from moyai.structures.units.unjudged import Seas, in_time

if TYPE_CHECKING:
    import xarray as xr

DRIFTS_APART = "nothing holds the units together, their slow drift against each other is not computed and adds to it"
LETS_GO = (
    "a connector bears and lets go within the wave: its impacts are not in the linear answer and add to it, run the "
    "time domain"
)
FEELS_DRIFT = "slow drift, which is not computed in the frequency domain, goes through it and adds to it"
MEET = "hulls meet in this sea, and their impact is not computed"
STRAINED = "the linear motion does not feel how tight lines come"
OTHERS_APART = "other units of the row drift apart and meet, and their impacts go through it"
NOT_KNOWN = "not known"
_JOINS = {"gap": "gap_joined", "connector": "connector_joins"}


def followed(data: xr.Dataset, name: str) -> xr.DataArray | None:
    """Return whether the units of each connector or gap are followed in the linear answer; None where all are.

    In an irregular sea what nothing holds together drifts apart, and slow drift goes through what bears mean drift; in
    any sea what bears and lets go meets with impacts.
    """
    kind = "gap" if name.startswith("gap_closing") else "connector"
    if name not in data or kind not in data[name].dims:
        return None
    joins = data.get(_JOINS[kind]) if "significant_motion" in data else None
    if joins is not None and elsewhere_apart(data):
        return joins.astype(bool) & False
    flags = [data[flag] == 0 for flag in (f"{kind}_loses_contact", f"{kind}_feels_drift") if flag in data]
    if joins is not None:
        flags.append(joins.astype(bool))
    return reduce(operator.and_, flags) if flags else None


def why_loose(path: str, data: xr.Dataset, name: str, index: tuple[int, ...]) -> str:
    """Return why a number of a connector or a gap is larger than the linear answer knows; empty where it is not."""
    known = None if in_time(path) else followed(data, name)
    if known is None:
        return ""
    place = tuple(number for dim, number in zip(data[name].dims, index, strict=True) if dim in known.dims)
    if bool(known.values[place]):
        return ""
    joins = data.get(_JOINS["gap" if name.startswith("gap_closing") else "connector"])
    apart = "significant_motion" in data and joins is not None and not bool(joins.values[place])
    others = elsewhere_apart(data) and not apart
    felt = data.get("gap_feels_drift" if name.startswith("gap_closing") else "connector_feels_drift")
    drift = felt is not None and bool(felt.values[place]) and not apart
    reasons = {DRIFTS_APART: apart, OTHERS_APART: others, FEELS_DRIFT: drift, LETS_GO: lets_go(path, data)}
    return "; ".join(words for words, there in reasons.items() if there)


def elsewhere_apart(data: xr.Dataset) -> bool:
    """Whether a connector of the row in an irregular sea does not hold its units, which drift apart and meet."""
    joins = data.get("connector_joins") if "significant_motion" in data else None
    return joins is not None and not bool(joins.values.all())


def lets_go(path: str, data: xr.Dataset) -> bool:
    """Whether a connector of the row bears and lets go within the waves, in the frequency domain."""
    lost = None if in_time(path) else data.get("connector_loses_contact")
    return lost is not None and bool(lost.values.any())


def why_beyond(data: xr.Dataset, name: str, index: tuple[int, ...]) -> str:
    """Return how far a connector is worked beyond the curve that was measured; empty within."""
    if "curve_lowest" not in data or name != "connector_resultant_largest":
        return ""
    row = index[data[name].dims.index("connector")]
    ends = [float(data[f"curve_{end}"].values[row]) for end in ("lowest", "highest")]
    worked = [float(data[f"elongation_{end}"].values[index]) for end in ("lowest", "highest")]
    if not (worked[0] < ends[0] or worked[1] > ends[1]):
        return ""
    known = " and ".join(f"{end:.3g}" for end in ends if not math.isnan(end))
    return (
        f"it is worked from {worked[0]:.3g} to {worked[1]:.3g} m, its curve ends at {known} m and is drawn out straight"
    )


def meets(data: xr.Dataset) -> bool:
    """Whether hulls meet in a sea, or in one period of it."""
    return "hulls_meet" in data and bool(data["hulls_meet"].values.any())


def not_known(item: Headline, why: str) -> Headline:
    """Return a number of which nothing is known, with the reason."""
    return Headline(
        item.name, item.label, math.nan, item.unit, item.where, item.model, detail=why, text=NOT_KNOWN,
        analysis=item.analysis, shown=item.shown,
    )  # fmt: skip


def meeting_notices(groups: Mapping[str, xr.Dataset], seas: Seas) -> Iterator[Notice]:
    """Say where hulls meet, without waves and in every sea of those that govern."""
    for path, rest in groups.items():
        if path.endswith("/statics") and "gap_closing_steady" in rest:
            level = path.split("/")[1]
            share = rest["gap_closing_steady"] / rest["gap_width"]
            yield from meeting_notice(
                f"{level}, without waves", share.values, rest["gap_width"].values, float(rest["least_distance"]),
            )  # fmt: skip
    for path, data in seas:
        if not meets(data):
            continue
        level, _, sea = path.split("/")[1:]
        width = groups[f"/{level}/statics"]["gap_width"].values
        closing = data["gap_closing_largest"].values / width
        # in any realisation, and with damping at the end of its band, which is where the closing is judged
        for further in ("gap_closing_largest_high", "gap_closing_largest_of_realisation"):
            if further in data:
                closing = np.fmax(closing, data[further].values / width)
        least = data["least_distance"].values
        periods = data["period"].values if "period" in data.dims else [None]
        for row, period in enumerate(periods):
            where = f"{level}, {sea}" if period is None else f"{level}, {sea}, T = {float(period):g} s"
            part = closing if period is None else closing[..., row, :]
            yield from meeting_notice(where, part, width, float(least if period is None else least[row]))


def meeting_notice(where: str, share: np.ndarray, width: np.ndarray, least: float) -> Iterator[Notice]:
    """Say that hulls meet, by the shares (..., gaps) that gaps close, or by the least distance of units [m] in plan."""
    remedy = "widen the gap, hold the units apart, or hold them with stronger lines"
    most = float(np.nanmax(share, initial=0.0))
    if most >= 1.0:
        gap = int(np.unravel_index(int(np.nanargmax(share)), share.shape)[-1])
        yield Notice(
            "hulls-meet",
            f"{where}: a gap closes by {most * float(width[gap]):.3g} m of {float(width[gap]):.3g} m: hulls meet, "
            "which lies outside the model: what connectors bear and how gaps open is not known, offsets and lines are "
            "those of units that lie in one another",
            value=most, limit=1.0, severity="error", remedy=remedy,
        )  # fmt: skip
    elif least <= 0.0:
        yield Notice(
            "hulls-meet",
            f"{where}: two units overlap by {-least:.3g} m in their mean position: hulls meet, which lies outside the "
            "model: what connectors bear and how gaps open is not known, offsets and lines are those of units that lie "
            "in one another",
            value=-least, limit=0.0, severity="error", remedy=remedy,
        )  # fmt: skip


def curve_notices(seas: Seas) -> Iterator[Notice]:
    """Say which connectors are stretched or pressed beyond their measured curve, which then goes on straight."""
    for path, data in seas:
        name = "connector_resultant_largest"
        if "curve_lowest" not in data or name not in data:
            continue
        level, _, sea = path.split("/")[1:]
        for row, connector in enumerate(data["connector"].values):
            low = float(np.min(data["elongation_lowest"].values[..., row]))
            high = float(np.max(data["elongation_highest"].values[..., row]))
            ends = float(data["curve_lowest"].values[row]), float(data["curve_highest"].values[row])
            if not (low < ends[0] or high > ends[1]):
                continue
            known = " and ".join(f"{end:.3g}" for end in ends if not math.isnan(end))
            yield Notice(
                "beyond-curve",
                f"{level}, {sea}: connector '{connector}' is worked from {low:.3g} to {high:.3g} m, its curve ends at "
                f"{known} m and is drawn out straight",
                value=max(-low, high), limit=float(np.nanmax(np.abs(ends))),
                remedy="give the curve farther, or a stiffer connector",
            )  # fmt: skip


__all__ = [
    "curve_notices", "followed", "lets_go", "meeting_notice", "meeting_notices", "meets", "not_known", "why_beyond",
    "why_loose",
]  # fmt: skip
