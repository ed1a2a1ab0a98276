"""Slack and taut cycles in the sea states of a case: regular waves by period, irregular seas with their snaps."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import InputError
from moyai.core.progress import Progress
from moyai.core.validity import Notice
from moyai.curtain.analysis_impact import drag_coefficient, impact_of
from moyai.curtain.assembly import LevelCurtain
from moyai.curtain.impact import Impact, speed_factor
from moyai.curtain.impact_waves import Contact, SlackTautMotion, slack_sag, slack_taut_motion
from moyai.curtain.model import Settings, WaveSettings
from moyai.curtain.snap_events import SeaSnaps, snaps_in_sea, suggested_time_step
from moyai.curtain.snap_flow import check_samples, depth_mean_factor, flow_over_skirt
from moyai.curtain.snap_statistics import SnapFit, fit_snaps
from moyai.curtain.variables import labelled
from moyai.sea import dispersion
from moyai.sea.breaking import linear_wavelength
from moyai.sea.states import IrregularSea, RegularSea, SeaState

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

_TRANSIENT = 10  # peak periods left out of an irregular sea
_WINDOW = 6.0  # peak periods on each side of the largest snap that are kept
_MOST_POINTS = 6000
#: Start speed of the Impact object, which the oscillator does not use [m/s]
_NO_SPEED = 1.0


@dataclass(frozen=True)
class WaveAnswer:
    """Groups of one sea state, the largest tension in it, and what must be told.

    Parameters
    ----------
    groups : dict
        Name under the sea's group ("" is that group itself) and dataset.
    maximum_tension : float
        Of both cables together [N].
    notices : tuple of Notice
    """

    groups: dict[str, xr.Dataset]
    maximum_tension: float
    notices: tuple[Notice, ...]


def wave_answer(unit: LevelCurtain, settings: Settings, sea: SeaState, progress: Progress) -> WaveAnswer:
    """Run the slack and taut curtain through a sea state.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    sea : RegularSea or IrregularSea
    progress : Progress

    Raises
    ------
    InputError
        When the curtain is shorter than its span.
    """
    impact = impact_of(unit, settings.impact, unit.normal_speed or _NO_SPEED)
    if isinstance(sea, RegularSea):
        return _regular(unit, settings.waves, sea, impact, progress)
    progress(f"slack and taut, {sea.name}", 0, 1)
    answer = _irregular(unit, settings.waves, sea, impact)
    progress(f"slack and taut, {sea.name}", 1, 1)
    return answer


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
    drag = drag_coefficient(unit, impact.draught)
    for index, period in enumerate(sea.periods):
        progress(f"slack and taut, {sea.name}", index, len(sea.periods))
        amplitude = velocity_amplitude(unit, sea, period, settings)
        settled = settings.settled_periods * period
        last = settled + settings.analysed_periods * period
        motion = slack_taut_motion(
            impact,
            drag_coefficient=drag,
            current=unit.normal_speed,
            velocity_amplitude=amplitude,
            period=period,
            duration=last,
            time_step=settings.time_step,
        )
        contacts = [c for c in motion.contacts if c.time >= settled and abs(c.speed) >= settings.slowest]
        rows.append(_row(impact, motion, contacts, amplitude, period, settled))
        groups[f"T {period:g} s"] = _series(
            motion,
            motion.contacts,
            unit.normal_speed + amplitude * np.sin(2.0 * math.pi / period * motion.time),
            (max(settled, last - 6.0 * period), last),
            {"period": period, "duration": last},
        )
        if rows[-1]["contact_count"] == 0.0:
            notices.append(_never_taut(unit, sea, period, rows[-1]))
    progress(f"slack and taut, {sea.name}", len(sea.periods), len(sea.periods))
    data = {name: ("period", [row[name] for row in rows]) for name in rows[0]}
    groups[""] = labelled(
        xr.Dataset(data, coords={"period": list(sea.periods)}, attrs={"kind": "regular", "height": sea.height})
    )
    return WaveAnswer(groups, max(row["maximum_tension"] for row in rows), tuple(notices))


def _row(
    impact: Impact,
    motion: SlackTautMotion,
    contacts: list[Contact],
    amplitude: float,
    period: float,
    settled: float,
) -> dict[str, float]:
    first = [contact for contact in contacts if contact.first]
    later = [contact for contact in contacts if not contact.first]
    largest = max(first, key=lambda contact: contact.tension, default=None)
    after = motion.time >= settled
    tension = motion.tension[after]
    # a contact peaks between the samples
    top = max([float(tension.max()), *(contact.tension for contact in contacts)])
    factor = float(speed_factor(impact.span_ratio)) * math.sqrt(impact.deep_mass * impact.stiffness)
    return {
        "velocity_amplitude": amplitude,
        "excursion": amplitude * period / math.pi,
        "threshold_excursion": 2.0 * slack_sag(impact),
        "maximum_tension": top,
        "mean_tension": float(tension.mean()),
        "first_contact_tension": largest.tension if largest else 0.0,
        "later_contact_tension": max((contact.tension for contact in later), default=0.0),
        "largest_contact_speed": abs(largest.speed) if largest else 0.0,
        "contact_count": float(len(contacts)),
        "first_contact_count": float(len(first)),
        "closed_form_tension": factor * abs(largest.speed) if largest else 0.0,
    }


def _never_taut(unit: LevelCurtain, sea: RegularSea, period: float, row: dict[str, float]) -> Notice:
    if row["mean_tension"] > 0.0:
        text = f"{unit.name}, {sea.name}, T = {period:g} s: the current keeps it taut, the waves do not slacken it"
        return Notice("curtain-always-taut", text, row["velocity_amplitude"], unit.normal_speed, "information")
    text = (
        f"{unit.name}, {sea.name}, T = {period:g} s: the water travels {row['excursion']:.3g} m to and fro and never "
        f"draws the curtain taut, which takes {row['threshold_excursion']:.3g} m"
    )
    return Notice("curtain-never-taut", text, row["excursion"], row["threshold_excursion"], "information")


def _series(
    motion: SlackTautMotion,
    contacts: tuple[Contact, ...],
    flow: Array,
    window: tuple[float, float],
    attrs: dict[str, float],
) -> xr.Dataset:
    """Return a series within a window, thinned between contacts but not in them, and the contacts of the whole run."""
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


def _irregular(unit: LevelCurtain, settings: WaveSettings, sea: IrregularSea, impact: Impact) -> WaveAnswer:
    import xarray as xr

    from moyai.sea.irregular import synthesise

    peak = sea.spectrum.peak_period
    step = settings.time_step if settings.time_step is not None else suggested_time_step(peak)
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
    flow = flow_over_skirt(
        waves,
        unit.water,
        draught=unit.depth,
        normal_heading=unit.curtain.normal,
        current=unit.normal_speed,
        duration=sea.duration,
        time_step=step,
        velocity=settings.velocity,
        span=unit.curtain.span if sea.spreading is not None or _oblique(unit, sea) else 0.0,
    )
    transient = min(_TRANSIENT * peak, 0.2 * sea.duration)
    snaps = snaps_in_sea(
        impact,
        flow,
        drag_coefficient=drag_coefficient(unit, impact.draught),
        slowest=settings.slowest,
        transient=transient,
    )
    fit, notices = _fit(unit, sea, snaps, settings)
    motion = snaps.motion
    peaks = np.sort(snaps.snap_tension)[::-1]
    after = motion.time >= transient
    top = max([float(motion.tension[after].max()), *snaps.tension.tolist()])
    scalars = {
        "significant_height": sea.spectrum.significant_height,
        "maximum_tension": top,
        "mean_tension": float(motion.tension[after].mean()),
        "contact_count": float(snaps.time.size),
        "first_contact_count": float(snaps.counted.sum()),
        "contacts_per_hour": snaps.time.size / snaps.hours,
        "snaps_per_hour": snaps.snaps_per_hour,
        "taut_share": snaps.taut_share,
        "later_contact_tension": float(snaps.later_tension.max()) if snaps.later_tension.size else 0.0,
        "weibull_shape": fit.shape.value if fit and fit.law == "weibull" else math.nan,
        "weibull_scale": fit.scale.value if fit and fit.law == "weibull" else math.nan,
        "weibull_threshold": fit.threshold if fit and fit.law == "weibull" else math.nan,
        "analysed_hours": snaps.hours,
        **_maximum(fit, settings.hours),
    }
    data: dict[str, Any] = {name: ((), value) for name, value in scalars.items()}
    data["contact_tension_sorted"] = ("snap", peaks)
    data["exceedance"] = ("snap", np.arange(1, peaks.size + 1) / (peaks.size + 1.0))
    fitted = np.full(peaks.size, math.nan) if fit is None else fit.exceedance(peaks)
    data["fitted_exceedance"] = ("snap", fitted)
    attrs = {"kind": "irregular", "law": settings.law, "seed": sea.seed, "peak_period": peak}
    largest = float(snaps.time[int(np.argmax(snaps.tension))]) if snaps.time.size else 0.5 * sea.duration
    groups = {
        "": labelled(xr.Dataset(data, attrs=attrs)),
        "largest": _series(
            motion,
            motion.contacts,
            flow.speed,
            (largest - _WINDOW * peak, largest + _WINDOW * peak),
            {"period": peak, "duration": sea.duration},
        ),
    }
    told = tuple(replace(notice, message=f"{sea.name}: {notice.message}") for notice in snaps.notices)
    return WaveAnswer(groups, top, (*told, *notices))


def _oblique(unit: LevelCurtain, sea: IrregularSea) -> bool:
    """Whether crests lie across the span so that the waves along it differ."""
    length = linear_wavelength(sea.spectrum.peak_period, unit.water)
    return abs(math.sin(sea.heading - unit.curtain.normal)) * unit.curtain.span > 0.02 * length


def _fit(
    unit: LevelCurtain, sea: IrregularSea, snaps: SeaSnaps, settings: WaveSettings
) -> tuple[SnapFit | None, tuple[Notice, ...]]:
    """Fit the law above a tenth of the largest snap; weak contacts follow no law of extremes."""
    peaks = snaps.snap_tension
    if peaks.size == 0:
        return None, ()
    try:
        fit = fit_snaps(peaks, snaps.hours, threshold=0.1 * float(peaks.max()), law=settings.law, seed=sea.seed)
    except InputError as error:
        text = f"{unit.name}, {sea.name}: no law was fitted to the snaps: {error.fault.message}"
        return None, (Notice("snap-no-fit", text, severity="information", remedy=error.fault.remedy),)
    return fit, fit.notices


def _maximum(fit: SnapFit | None, hours: float) -> dict[str, float]:
    names = ("most_probable_maximum", "most_probable_maximum_low", "most_probable_maximum_high")
    try:
        found = None if fit is None else fit.most_probable_maximum(hours)
    except InputError:
        found = None
    if found is None:
        return dict.fromkeys(names, math.nan)
    return dict(zip(names, (found.value, found.low, found.high)))
