"""Why a number of connectors and gaps is no more than a bound, or not known at all."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Headline
from moyai.core.validity import Notice
from moyai.structures.units.model import SNAP_RATIO
from moyai.structures.units.unjudged import Seas, in_time

if TYPE_CHECKING:
    import xarray as xr

SLOW_DRIFT = "slow drift of the units against each other is not computed in the frequency domain and adds to it"
LETS_GO = (
    "a connector acts and releases within the wave: its impacts are not in the linear answer and add to it, run the "
    "time domain"
)
MEET = "hulls meet in this sea, and their impact is not computed"
STRAINED = "the linear motion does not feel how tight lines come"
NOT_KNOWN = "not known"
#: Tension along the path of regular waves over the linear one, from which lines are no linear springs.
_TAUT = 1.5


def why_loose(path: str, data: xr.Dataset) -> str:
    """Return why units move against each other by more than the frequency domain knows; empty where they do not."""
    if in_time(path):
        return ""
    return "; ".join([SLOW_DRIFT] * ("significant_motion" in data) + [LETS_GO] * lets_go(path, data))


def lets_go(path: str, data: xr.Dataset) -> bool:
    """Whether a connector of the row carries and lets go within the waves, in the frequency domain."""
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


def strained(path: str, data: xr.Dataset) -> bool:
    """Whether any line of a sea comes tighter, with damping within its band, than its linear motions feel.

    So does one that is pulled beyond five times its mean, and one that is half as much again above its linear tension
    along the path of regular waves.
    """
    if in_time(path) or "line_tension_maximum" not in data:
        return False
    mean = data["line_tension_mean"]
    ends = [data[name] for name in ("line_tension_maximum", "line_tension_maximum_high") if name in data]
    if any(bool((tension > SNAP_RATIO * mean).any()) for tension in ends):
        return True
    if "tension_amplitude" not in data:
        return False
    return bool((data["line_tension_maximum"] > _TAUT * (mean + data["tension_amplitude"])).any())


def stretched(data: xr.Dataset) -> float:
    """Return what motion across would stretch any of the connectors of a sea [m]."""
    return float(np.max(data["stretch_across"].values, initial=0.0)) if "stretch_across" in data else 0.0


def most_closing(data: xr.Dataset) -> np.ndarray:
    """Return how far every gap closes at the most [m]: in any realisation, with damping at either end of its band."""
    own = data["gap_closing_largest"].values
    most = own
    if "gap_closing_largest_of_realisation" in data:
        most = np.fmax(own, np.fmax.reduce(data["gap_closing_largest_of_realisation"].values, axis=0))
    if "gap_closing_largest_high" in data:
        high = data["gap_closing_largest_high"].values
        # as its mean over realisations grows with damping, so does every one of them
        most = most * np.where(own > 0.0, high / np.where(own > 0.0, own, 1.0), 1.0)
    return np.asarray(most)


def with_meeting(data: xr.Dataset, width: np.ndarray) -> xr.Dataset:
    """Return a sea with whether hulls meet in it at the most that gaps of a width (gaps,) [m] close."""
    if "hulls_meet" not in data or "gap_closing_largest" not in data or not len(width):
        return data
    meet = (most_closing(data) >= width).any(axis=-1) | (data["hulls_meet"].values != 0)
    return data.assign(hulls_meet=(data["hulls_meet"].dims, meet.astype(np.int8)))


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
        closing = most_closing(data) / width
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
            "which is outside the model: forces of connectors and openings of gaps are not valid, offsets and lines "
            "are "
            "those of overlapping hulls",
            value=most, limit=1.0, severity="error", remedy=remedy,
        )  # fmt: skip
    elif least <= 0.0:
        yield Notice(
            "hulls-meet",
            f"{where}: two units overlap by {-least:.3g} m in their mean position: hulls meet, which is outside the "
            "model: forces of connectors and openings of gaps are not valid, offsets and lines are those of "
            "overlapping hulls",
            value=-least, limit=0.0, severity="error", remedy=remedy,
        )  # fmt: skip


def push_notices(groups: Mapping[str, xr.Dataset], seas: Seas) -> Iterator[Notice]:
    """Say which springs push: they stand for ropes that would go slack, or for guides."""
    worst: dict[str, tuple[float, str]] = {}
    for path, data in seas:
        rest = groups.get(f"/{path.split('/')[1]}/statics")
        if rest is None or "anchor_curve_tension" not in rest or "line_tension_mean" not in data:
            continue
        if "line_tension_minimum" in data:
            least = data["line_tension_minimum"].values
        else:
            least = 2.0 * data["line_tension_mean"].values - data["line_tension_maximum"].values
        springs = np.isnan(rest["anchor_curve_tension"].values).all(axis=1)
        for number in np.flatnonzero(springs):
            push = -float(np.min(least[..., number]))
            name = str(rest["line"].values[number])
            if push > max(0.0, worst.get(name, (0.0, ""))[0]):
                worst[name] = push, ", ".join(path.split("/")[1::2])
    for name, (push, where) in worst.items():
        yield Notice(
            "spring-pushes",
            f"{where}: the spring '{name}' pushes with up to {1e-3 * push:.3g} kN, as a rope does not",
            value=push, limit=0.0, remedy="give more pretension, or a rope with its segments",
        )  # fmt: skip


def curve_notices(seas: Seas) -> Iterator[Notice]:
    """Say which connectors are stretched or pressed beyond their measured curve, then extrapolated linearly."""
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
    "curve_notices", "lets_go", "meeting_notice", "meeting_notices", "meets", "most_closing", "not_known",
    "push_notices", "strained", "stretched", "why_beyond", "why_loose", "with_meeting",
]  # fmt: skip
