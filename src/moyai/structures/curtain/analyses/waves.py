"""Slack and taut cycles in the sea states of a case: regular waves by period, irregular seas with their snaps."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import each_at_once
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress
from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.sea import dispersion
from moyai.sea.breaking import linear_wavelength
from moyai.sea.states import IrregularSea, RegularSea, SeaState
from moyai.series.snap_statistics import SnapFit, fit_snaps
from moyai.structures.curtain.analyses.impact import drag_coefficient, impact_of
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.impact.cable import Impact, speed_factor
from moyai.structures.curtain.impact.cycles import CableContact, SlackTautMotion, slack_sag
from moyai.structures.curtain.impact.settling import SettledCycles, settled_cycles
from moyai.structures.curtain.model import CurtainSettings, WaveSettings
from moyai.structures.curtain.seas.cycles_of_sea import SeaCycles
from moyai.structures.curtain.snaps.events import SeaSnaps, snaps_in_sea, suggested_time_step
from moyai.structures.curtain.snaps.flow import SkirtFlow, check_samples, depth_mean_factor, flow_over_skirt
from moyai.structures.curtain.statics.steady_load import drag_factors
from moyai.structures.curtain.variables import labelled

if TYPE_CHECKING:
    import xarray as xr


_TRANSIENT = 10  # peak periods left out of an irregular sea
_WINDOW = 6.0  # peak periods on each side of the largest snap that are kept
_MOST_POINTS = 6000
#: Parts of the height of regular waves that are run too: snaps may lock into a gentle motion in a higher wave, which
#: the lower ones of its train do not have.
_LOWER = (0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1)
#: Start speed of the Impact object, which the oscillator does not use [m/s]
_NO_SPEED = 1.0


@dataclass(frozen=True)
class WaveAnswer:
    """Groups of one sea state, the largest tension in it, and what must be reported."""

    #: Name under the sea's group ("" is that group itself) and dataset.
    groups: dict[str, xr.Dataset]
    #: Of both cables together, the number of the sea [N].
    maximum_tension: float
    #: Upper end of its scatter [N].
    highest_tension: float
    notices: tuple[Notice, ...]


def wave_answer(
    unit: LevelCurtain,
    settings: CurtainSettings,
    sea: SeaState,
    progress: Progress,
    flows: Sequence[SkirtFlow] = (),
) -> WaveAnswer:
    """Run the slack and taut curtain through a sea state.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    sea : RegularSea or IrregularSea
    progress : Progress
    flows : sequence of SkirtFlow, optional
        What :func:`still_flows` gives for the sea, where it is known.

    Raises
    ------
    InputError
        When the curtain is shorter than its span.
    """
    impact = impact_of(unit, settings.impact, unit.normal_speed or _NO_SPEED)
    if isinstance(sea, RegularSea):
        return _regular(unit, settings.waves, sea, impact, progress)
    progress(f"slack and taut, {sea.name}", 0, 1)
    answer = _irregular(unit, settings.waves, sea, impact, flows or still_flows(unit, settings.waves, sea))
    progress(f"slack and taut, {sea.name}", 1, 1)
    return answer


def sea_cycles(
    unit: LevelCurtain, settings: CurtainSettings, sea: SeaState, flows: Sequence[SkirtFlow] = ()
) -> SeaCycles:
    """Return what :func:`wave_answer` says of the tension in a sea, without its series and the law of its snaps.

    Parameters
    ----------
    unit, settings, sea
        As there.
    flows : sequence of SkirtFlow, optional
        What :func:`still_flows` gives for the sea, where it is known.
    """
    import xarray as xr

    impact = impact_of(unit, settings.impact, unit.normal_speed or _NO_SPEED)
    if isinstance(sea, RegularSea):
        rows = each_at_once(lambda period, _: _settled(unit, settings.waves, sea, period, impact)[-1], sea.periods)
        return SeaCycles.of(xr.Dataset({name: ("period", [row[name] for row in rows]) for name in rows[0]}))
    drawn = realisations(sea, settings.waves.realisations)
    flows = flows or still_flows(unit, settings.waves, sea)
    pairs = tuple(zip(drawn, flows, strict=True))
    snaps = each_at_once(lambda pair, _: realisation(unit, settings.waves, pair[0], impact, pair[1]), pairs)
    return SeaCycles.of(xr.Dataset(_tops(np.array([largest_tension(found, left_out(sea)) for found in snaps]))))


def strong_tension(
    unit: LevelCurtain, settings: CurtainSettings, sea: SeaState, own: SeaCycles, flows: Sequence[SkirtFlow] = ()
) -> float:
    """Return the judged tension with the drag coefficient at the upper end of its range [N], ``own`` without.

    Both ends run the same waves: the ratio of their tensions hardly knows which seeds they are.
    """
    factor = drag_factors(unit.hanging.drag)[1]
    strong = replace(unit, hanging=replace(unit.hanging, drag=unit.hanging.drag.scaled(factor)))
    high = sea_cycles(strong, settings, sea, flows)
    return own.judged * high.top / own.top if own.top > 0.0 else high.judged


def with_strong_drag(
    unit: LevelCurtain, settings: CurtainSettings, sea: SeaState, found: WaveAnswer, flows: Sequence[SkirtFlow] = ()
) -> WaveAnswer:
    """Return the answer with the judged tension that the upper end of the drag coefficient gives [N]."""
    judged = strong_tension(unit, settings, sea, SeaCycles.of(found.groups[""]), flows)
    table = labelled(found.groups[""].assign(strong_drag_tension=judged))
    return replace(found, groups={**found.groups, "": table})


def velocity_amplitude(unit: LevelCurtain, sea: RegularSea, period: float, settings: WaveSettings) -> float:
    """Return the amplitude of the water's speed along the normal [m/s], mean over the skirt or at the surface."""
    omega = 2.0 * math.pi / period
    k = float(dispersion.wave_number(omega, unit.water.depth, unit.water.gravity))
    if settings.velocity == "surface":
        factor = 1.0 / math.tanh(k * unit.water.depth)
    else:
        factor = float(depth_mean_factor(k, unit.depth, unit.water))
    angle = sea.heading - unit.curtain.normal
    return abs(0.5 * sea.height * omega * factor * math.cos(angle))


def _regular(
    unit: LevelCurtain, settings: WaveSettings, sea: RegularSea, impact: Impact, progress: Progress
) -> WaveAnswer:
    import xarray as xr

    rows: list[dict[str, float]] = []
    groups: dict[str, xr.Dataset] = {}
    notices: list[Notice] = []
    for index, period in enumerate(sea.periods):
        progress(f"slack and taut, {sea.name}", index, len(sea.periods))
        amplitude = velocity_amplitude(unit, sea, period, settings)
        found, ends = _settled(unit, settings, sea, period, impact)
        counted = [c for c in found.motion.contacts if c.time >= found.begin and abs(c.speed) >= settings.slowest]
        rows.append(ends | _row(impact, found, counted, amplitude))
        groups[f"T {period:g} s"] = _series(
            found.motion,
            counted,
            unit.normal_speed + amplitude * np.sin(2.0 * math.pi / period * found.motion.time),
            _shown(found),
            {"period": period, "duration": found.end, "counted_from": found.begin},
        )
        place = f"{unit.name}, {sea.name}, T = {period:g} s"
        if rows[-1]["contact_count"] == 0.0:
            notices.append(_never_taut(place, unit, rows[-1]))
        elif found.kind != "repeating":
            notices.append(_not_repeating(place, found))
    progress(f"slack and taut, {sea.name}", len(sea.periods), len(sea.periods))
    data = {name: ("period", [row[name] for row in rows]) for name in rows[0]}
    groups[""] = labelled(
        xr.Dataset(data, coords={"period": list(sea.periods)}, attrs={"kind": "regular", "height": sea.height})
    )
    top = max(row[name] for row in rows for name in ("both_cables_tension_maximum", "lower_wave_tension"))
    return WaveAnswer(groups, top, max(top, *(row["both_cables_tension_maximum_high"] for row in rows)), tuple(notices))


def _settled(
    unit: LevelCurtain, settings: WaveSettings, sea: RegularSea, period: float, impact: Impact
) -> tuple[SettledCycles, dict[str, float]]:
    """Run a period at its height and at lower ones; return the former, and what :class:`SeaCycles` reads of all."""
    amplitude, drag = velocity_amplitude(unit, sea, period, settings), drag_coefficient(unit, impact.draught)
    found, *lower = (
        settled_cycles(
            impact,
            drag_coefficient=drag,
            current=unit.normal_speed,
            velocity_amplitude=part * amplitude,
            period=period,
            least_settled=settings.settled_periods,
            least_analysed=settings.analysed_periods,
            time_step=settings.time_step,
        )
        for part in (1.0, *_LOWER)
    )
    low, high = found.scatter
    tensions = [item.tension for item in lower]
    return found, {
        "both_cables_tension_maximum": found.tension,
        "both_cables_tension_maximum_low": low,
        "both_cables_tension_maximum_high": high,
        "lower_wave_tension": max(tensions),
        "lower_wave_height": _LOWER[int(np.argmax(tensions))] * sea.height,
        "judged_tension": max(item.judged for item in (found, *lower)),
    }


def _shown(found: SettledCycles) -> tuple[float, float]:
    """Return the stretch that is kept: six periods, or one repetition, about the period whose peak is the number."""
    width = max(6, found.multiple)
    first = min(max(found.typical - width // 2, found.first), found.first + found.count - width)
    first = max(first, found.first)
    return first * found.period, min(first + width, found.first + found.count) * found.period


def _row(impact: Impact, found: SettledCycles, contacts: list[CableContact], amplitude: float) -> dict[str, float]:
    first = [contact for contact in contacts if contact.first]
    largest = max(first, key=lambda contact: contact.tension, default=None)
    tension = found.motion.tension[found.motion.time >= found.begin]
    factor = float(speed_factor(impact.span_ratio)) * math.sqrt(impact.deep_mass * impact.stiffness)
    return {
        "velocity_amplitude": amplitude,
        "water_excursion": amplitude * found.period / math.pi,
        "threshold_water_excursion": 2.0 * slack_sag(impact),
        "both_cables_tension_mean": float(tension.mean()),
        "first_contact_tension": found.of_contacts(first),
        "later_contact_tension": found.of_contacts(contact for contact in contacts if not contact.first),
        "largest_contact_speed": abs(largest.speed) if largest else 0.0,
        "contact_count": float(len(contacts)),
        "first_contact_count": float(len(first)),
        "closed_form_tension": factor * abs(largest.speed) if largest else 0.0,
        "periods_left_out": float(found.first),
        "periods_analysed": float(found.count),
        "repeats_after": float(found.multiple) if found.kind == "repeating" else math.nan,
    }


def _not_repeating(place: str, found: SettledCycles) -> Notice:
    low, high = found.scatter
    steady = found.kind == "chaotic"
    state = "are steady in the mean" if steady else "are not steady in the mean either"
    return Notice(
        "curtain-chaotic-cycles" if steady else "curtain-unsteady-cycles",
        f"{place}: periods do not repeat but {state}: the tension is the mean of the largest of 100 periods, "
        f"{spoken(low, 'N')} to {spoken(high, 'N')} of {found.count} periods after {found.first}",
        math.nan,
        math.nan,
        "information" if steady else "warning",
        "",
        "slack and taut cycles; repetition within 1 %, over at most 16 periods",
    )


def _never_taut(place: str, unit: LevelCurtain, row: dict[str, float]) -> Notice:
    if row["both_cables_tension_mean"] > 0.0:
        text = f"{place}: the current keeps it taut, the waves do not slacken it"
        return Notice("curtain-always-taut", text, row["velocity_amplitude"], unit.normal_speed, "information")
    text = (
        f"{place}: the water travels {row['water_excursion']:.3g} m to and fro and never "
        f"draws the curtain taut, which takes {row['threshold_water_excursion']:.3g} m"
    )
    return Notice("curtain-never-taut", text, row["water_excursion"], row["threshold_water_excursion"], "information")


def _series(
    motion: SlackTautMotion,
    contacts: Sequence[CableContact],
    flow: Array,
    window: tuple[float, float],
    attrs: dict[str, float],
) -> xr.Dataset:
    """Return a series within a window, thinned between contacts but not in them, and the contacts that count."""
    import xarray as xr

    inside = np.flatnonzero((motion.time >= window[0]) & (motion.time <= window[1]))
    stride = max(1, inside.size // _MOST_POINTS)
    taut = inside[motion.tension[inside] > 0.0]
    keep = np.unique(np.concatenate([inside[::stride], taut[:: max(1, taut.size // _MOST_POINTS)]]))
    data: dict[str, Any] = {
        "flow_speed": ("time", flow[keep]),
        **{name: ("time", getattr(motion, name)[keep]) for name in ("position", "speed", "tension")},
        "contact_time": ("contact", [contact.time for contact in contacts]),
        "contact_speed": ("contact", [contact.speed for contact in contacts]),
        "contact_tension": ("contact", [contact.tension for contact in contacts]),
        "contact_side": ("contact", [float(contact.side) for contact in contacts]),
        "contact_first": ("contact", [float(contact.first) for contact in contacts]),
    }
    step = float(motion.time[1] - motion.time[0])
    return labelled(xr.Dataset(data, coords={"time": motion.time[keep]}, attrs={**attrs, "time_step": step}))


def left_out(sea: IrregularSea) -> float:
    """Return the time of the start that is left out of an irregular sea [s]."""
    return min(_TRANSIENT * sea.spectrum.peak_period, 0.2 * sea.duration)


def _irregular(
    unit: LevelCurtain, settings: WaveSettings, sea: IrregularSea, impact: Impact, flows: Sequence[SkirtFlow]
) -> WaveAnswer:
    """Run several realisations of a sea: their mean largest tension counts, and all their snaps make the law."""
    import xarray as xr

    peak = sea.spectrum.peak_period
    transient = left_out(sea)
    drawn = realisations(sea, settings.realisations)
    pairs = tuple(zip(drawn, flows, strict=True))
    snaps = each_at_once(lambda pair, _: realisation(unit, settings, pair[0], impact, pair[1]), pairs)
    tops = np.array([largest_tension(found, transient) for found in snaps])
    tensions = np.concatenate([found.snap_tension for found in snaps])
    hours = sum(found.hours for found in snaps)
    fit, notices = _fit(unit, sea, tensions, hours, settings)
    largest, without = _maximum(f"{unit.name}, {sea.name}", fit, settings.hours)
    notices += without
    peaks = np.sort(tensions)[::-1]
    count = sum(found.time.size for found in snaps)
    later = np.array([found.later_tension.max() if found.later_tension.size else 0.0 for found in snaps])
    scalars = {
        "significant_height": sea.spectrum.significant_height,
        "realisations": float(tops.size),
        "both_cables_tension_mean": float(
            np.mean([found.motion.tension[found.motion.time >= transient].mean() for found in snaps])
        ),
        "contact_count": float(count),
        "first_contact_count": float(peaks.size),
        "contacts_per_hour": count / hours,
        "snaps_per_hour": peaks.size / hours,
        "taut_share": float(np.mean([found.taut_share for found in snaps])),
        "later_contact_tension": float(later.mean()),
        "weibull_shape": fit.shape.value if fit and fit.law == "weibull" else math.nan,
        "weibull_scale": fit.scale.value if fit and fit.law == "weibull" else math.nan,
        "weibull_threshold": fit.threshold if fit and fit.law == "weibull" else math.nan,
        "analysed_hours": hours,
        "left_out": transient,
        **largest,
    }
    data: dict[str, Any] = {name: ((), value) for name, value in scalars.items()} | _tops(tops)
    data["contact_tension_sorted"] = ("snap", peaks)
    data["exceedance"] = ("snap", np.arange(1, peaks.size + 1) / (peaks.size + 1.0))
    fitted = np.full(peaks.size, math.nan) if fit is None else fit.exceedance(peaks)
    data["fitted_exceedance"] = ("snap", fitted)
    across = math.asin(abs(math.sin(sea.heading - unit.curtain.normal)))
    attrs = {
        "kind": "irregular", "law": settings.law, "seed": sea.seed, "peak_period": peak, "angle_from_normal": across,
    }  # fmt: skip
    # shown is the realisation whose largest tension is nearest to the mean
    typical = int(np.argmin(np.abs(tops - tops.mean())))
    shown, flow = snaps[typical], flows[typical].in_current(unit.normal_speed)
    after = shown.motion.time >= transient
    top = float(shown.motion.time[after][int(np.argmax(shown.motion.tension[after]))])
    window = (max(top - _WINDOW * peak, transient), top + _WINDOW * peak)
    coords = {"seed": [sea.seed + number for number in range(tops.size)]}
    groups = {
        "": labelled(xr.Dataset(data, coords=coords, attrs=attrs)),
        "largest": _series(
            shown.motion,
            [contact for contact in shown.motion.contacts if contact.time >= transient],
            flow.speed,
            window,
            {"period": peak, "duration": sea.duration, "counted_from": transient, "seed": sea.seed + typical},
        ),
    }
    reported = tuple(replace(notice, message=f"{sea.name}: {notice.message}") for notice in shown.notices)
    return WaveAnswer(groups, float(tops.mean()), float(tops.max()), (*reported, *notices))


def _tops(tops: Array) -> dict[str, Any]:
    """Return the variables of an irregular sea that :class:`SeaCycles` reads."""
    return {
        "both_cables_tension_maximum": ((), float(tops.mean())),
        "both_cables_tension_maximum_low": ((), float(tops.min())),
        "both_cables_tension_maximum_high": ((), float(tops.max())),
        "realisation_tension": ("seed", tops),
    }


def realisations(sea: IrregularSea, count: int) -> tuple[IrregularSea, ...]:
    """Return a sea with its own seed and those that follow."""
    return tuple(replace(sea, seed=sea.seed + number) for number in range(count))


def still_flows(unit: LevelCurtain, settings: WaveSettings, sea: SeaState) -> tuple[SkirtFlow, ...]:
    """Return the waves that the skirt feels in every realisation of an irregular sea, without a current."""
    if isinstance(sea, RegularSea):
        return ()
    return tuple(still_flow(unit, settings, one) for one in realisations(sea, settings.realisations))


def still_flow(unit: LevelCurtain, settings: WaveSettings, sea: IrregularSea) -> SkirtFlow:
    """Return the waves that the skirt feels in one realisation, without a current."""
    from moyai.sea.irregular import synthesise

    step = _step(settings, sea)
    check_samples(sea.duration, step)
    waves = synthesise(
        sea.spectrum,
        unit.water,
        duration=sea.duration,
        seed=sea.seed,
        heading=sea.heading,
        spreading=sea.spreading,
        time_step=step,
    )
    return flow_over_skirt(
        waves,
        unit.water,
        draught=unit.depth,
        normal_heading=unit.curtain.normal,
        current=0.0,
        duration=sea.duration,
        time_step=step,
        velocity=settings.velocity,
        span=unit.curtain.span if sea.spreading is not None or _oblique(unit, sea) else 0.0,
    )


def _step(settings: WaveSettings, sea: IrregularSea) -> float:
    return settings.time_step if settings.time_step is not None else suggested_time_step(sea.spectrum.peak_period)


def realisation(
    unit: LevelCurtain, settings: WaveSettings, sea: IrregularSea, impact: Impact, flow: SkirtFlow
) -> SeaSnaps:
    """Run one realisation in the waves of :func:`still_flow`.

    It starts just taut downstream where a current holds it there.
    """
    start = None
    if unit.normal_speed != 0.0:
        start = (math.copysign(slack_sag(impact), unit.normal_speed), 0.0)
    return snaps_in_sea(
        impact,
        flow.in_current(unit.normal_speed),
        drag_coefficient=drag_coefficient(unit, impact.draught),
        slowest=settings.slowest,
        transient=left_out(sea),
        start=start,
    )


def largest_tension(snaps: SeaSnaps, transient: float) -> float:
    """Return the largest sum of the cable tensions [N] of a sea after its start."""
    after = snaps.motion.time >= transient
    return float(max([float(snaps.motion.tension[after].max()), *snaps.tension.tolist()]))


def _oblique(unit: LevelCurtain, sea: IrregularSea) -> bool:
    """Whether crests lie across the span so that the waves along it differ."""
    length = linear_wavelength(sea.spectrum.peak_period, unit.water)
    return abs(math.sin(sea.heading - unit.curtain.normal)) * unit.curtain.span > 0.02 * length


def _fit(
    unit: LevelCurtain, sea: IrregularSea, peaks: Array, hours: float, settings: WaveSettings
) -> tuple[SnapFit | None, tuple[Notice, ...]]:
    """Fit the law above a tenth of the largest snap; weak contacts follow no law of extremes."""
    if peaks.size == 0:
        return None, ()
    try:
        fit = fit_snaps(peaks, hours, threshold=0.1 * float(peaks.max()), law=settings.law, seed=sea.seed)
    except (InputError, ConvergenceError) as error:
        text = f"{unit.name}, {sea.name}: no law was fitted to the snaps: {error.fault.message}"
        return None, (Notice("snap-no-fit", text, severity="information", remedy=error.fault.remedy),)
    return fit, fit.notices


def _maximum(place: str, fit: SnapFit | None, hours: float) -> tuple[dict[str, float], tuple[Notice, ...]]:
    """Return the most probable largest tension and its interval; not a number and a notice where there is none."""
    names = ("most_probable_maximum", "most_probable_maximum_low", "most_probable_maximum_high")
    notices: tuple[Notice, ...] = ()
    if fit is not None:
        try:
            found = fit.most_probable_maximum(hours)
        except InputError as error:
            text = f"{place}: no most probable largest tension: {error.fault.message}"
            notices = (Notice("snap-no-maximum", text, severity="information", remedy=error.fault.remedy),)
        else:
            return dict(zip(names, (found.value, found.lower, found.upper))), notices
    return dict.fromkeys(names, math.nan), notices
