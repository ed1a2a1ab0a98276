"""The runs of the dynamic analysis of a level: through every sea state, or through the snap in the current alone."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.flexible.flow import Flow
from moyai.sea.components import WaveComponents
from moyai.sea.current import CurrentProfile
from moyai.sea.dispersion import wave_number_in_current
from moyai.sea.states import IrregularSea, RegularSea, SeaState
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.dynamic.model import CurtainSpan
from moyai.structures.curtain.dynamic.runs import DynamicSettings
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy
from moyai.structures.curtain.impact.cycles import slack_sag
from moyai.structures.curtain.model import CurtainSettings

#: Rows in a period and in the rise of model A, components of an irregular sea.
_ROWS_OF_A_PERIOD, _ROWS_OF_A_RISE, _COMPONENTS = 400, 150, 120
_RISES = 4.0
#: Duration of a run from release over the time in which the current crosses the sag.
_DRIFTS = 8.0
#: Part of what counts of an irregular sea that lies before its highest crest.
_CREST = 0.6


@dataclass(frozen=True, eq=False)
class _CurrentOfSpan:
    """A current in the axes of the span, asked at any height."""

    profile: CurrentProfile
    normal: float
    depth: float

    def velocity(self, z: ArrayLike) -> Array:
        """Return the velocity (..., 2) downstream and along the span."""
        given = np.asarray(self.profile.velocity(np.clip(z, -self.depth, 0.0)))
        c, s = math.cos(self.normal), math.sin(self.normal)
        return np.stack([c * given[..., 0] + s * given[..., 1], c * given[..., 1] - s * given[..., 0]], axis=-1)


@dataclass(frozen=True)
class Plan:
    """One run of a span."""

    name: str
    #: Of :func:`moyai.structures.curtain.dynamic.runs.run_span`.
    arguments: dict[str, Any]
    #: Of the waves, of their peak, or the rise of model A [s].
    period: float
    #: Whether it runs through regular waves.
    regular: bool = False
    #: Whether the run may be made longer until the tension is past its peak.
    open: bool = False

    @property
    def random(self) -> bool:
        """Whether it runs through one realisation of an irregular sea."""
        return self.arguments["flow"].waves is not None and not self.regular


def plans_of(
    unit: LevelCurtain, settings: CurtainSettings, seas: tuple[SeaState, ...], span: CurtainSpan
) -> list[Plan]:
    """Return the runs of a level.

    Raises
    ------
    InputError
        Where there is neither a sea nor a current nor a start speed.
    """
    given = settings.dynamic
    assert given is not None
    profile = unit.site.current(unit.surface_speed) if unit.surface_speed > 0.0 else None
    current = None if profile is None else _CurrentOfSpan(profile, unit.curtain.normal, float(unit.water.depth))
    common = {"water": unit.water, "profile": given.profile}
    if not seas:
        return [_snap_plan(unit, settings, span, current, common)]
    found: list[Plan] = []
    for sea in seas:
        if isinstance(sea, RegularSea):
            many = len(sea.periods) > 1
            for period in sea.periods:
                name = f"{sea.name}, T {period:g} s" if many else sea.name
                waves = _regular(unit, sea, period)
                last = (1 + given.settled_periods + given.analysed_periods) * period
                found.append(replace(_wave_plan(name, waves, current, period, last, given, unit, common), regular=True))
        else:
            period = float(sea.spectrum.peak_period)
            before = (1 + given.settled_periods) * period
            last = before + given.wave_count * period
            waves = _window(unit, sea, before + _CREST * given.wave_count * period)
            found.append(_wave_plan(sea.name, waves, current, period, last, given, unit, common))
    if "impact" in settings.analyses and (settings.impact.start_speed or unit.normal_speed) > 0.0:
        # the release in the current is an event of its own, which no sea holds
        found.append(_snap_plan(unit, settings, span, current, common))
    return found


def _snap_plan(
    unit: LevelCurtain,
    settings: CurtainSettings,
    span: CurtainSpan,
    current: _CurrentOfSpan | None,
    common: dict[str, Any],
) -> Plan:
    """Return the run of the snap alone: just taut at the start speed, in the current where there is one."""
    given = settings.dynamic
    assert given is not None
    speed = settings.impact.start_speed or unit.normal_speed
    if not speed > 0.0:
        raise InputError(
            "the analysis 'dynamic' needs waves, a current along the normal, or a start speed",
            parameter="analyses",
            remedy="give waves, a current, or the start speed of the impact",
        )
    lower = span.lower_stiffness if span.lower_stiffness > 0.0 else 1e-6 * span.upper_stiffness
    draught = min(span.skirt_length, 0.98 * unit.water.depth)
    rise = peak_by_energy(Impact(span.span, span.length, draught, span.upper_stiffness, lower, speed, unit.water)).time
    duration = _RISES * rise if given.duration is None else given.duration
    start = 0.0 if given.start in ("at_rest", "released") else speed
    if given.start == "released":
        if current is None or not unit.normal_speed > 0.0:
            raise InputError(
                "a curtain released at rest needs a current along its normal to become taut",
                parameter="settings.dynamic.start",
                remedy="give 'current'",
            )
        sag = slack_sag(Impact(span.span, span.length, draught, span.upper_stiffness, lower, speed, unit.water))
        duration = _DRIFTS * sag / unit.normal_speed if given.duration is None else given.duration
        return Plan(
            "release in the current",
            {
                **common, "flow": Flow(current=current), "duration": duration, "output_step": rise / _ROWS_OF_A_RISE,
                "speed": 0.0, "release": 0.0,
            },
            rise,
        )  # fmt: skip
    return Plan(
        "snap in the current" if current is not None else "snap",
        {
            **common, "flow": Flow(current=current), "duration": duration, "output_step": rise / _ROWS_OF_A_RISE,
            "speed": start,
        },
        rise,
        open=given.duration is None,
    )  # fmt: skip


def _wave_plan(
    name: str, waves: WaveComponents, current: _CurrentOfSpan | None, period: float, last: float,
    given: DynamicSettings, unit: LevelCurtain, common: dict[str, Any],
) -> Plan:  # fmt: skip
    drifting = given.start == "drifting"
    flow = Flow(current=current, waves=waves, ramp=0.0 if drifting else period, wave_ramp=period if drifting else 0.0)
    return Plan(
        name,
        {
            **common, "flow": flow, "duration": last, "output_step": period / _ROWS_OF_A_PERIOD,
            "speed": unit.normal_speed if drifting else 0.0,
            "from_time": (1 + given.settled_periods) * period,
        },
        period,
    )  # fmt: skip


def _carried(unit: LevelCurtain) -> tuple[float, float]:
    if unit.surface_speed <= 0.0:
        return 0.0, 0.0
    profile = unit.site.current(unit.surface_speed)
    found = profile.velocity(0.0) if math.isinf(unit.water.depth) else profile.depth_mean(-unit.water.depth, 0.0)
    return float(found[0]), float(found[1])


def _regular(unit: LevelCurtain, sea: RegularSea, period: float) -> WaveComponents:
    omega, water = 2.0 * math.pi / period, unit.water
    u, v = _carried(unit)
    along = u * math.cos(sea.heading) + v * math.sin(sea.heading)
    number = float(wave_number_in_current(omega, water.depth, water.gravity, along))
    return WaveComponents(
        np.array([omega]), np.array([0.5 * sea.height]), np.zeros(1), np.array([sea.heading - unit.curtain.normal]),
        np.array([number]), water, np.array([omega - number * along]),
    )  # fmt: skip


def _window(unit: LevelCurtain, sea: IrregularSea, place: float) -> WaveComponents:
    """Return the sea with its clock set so that the highest crest stands at a time [s], in what counts of the run."""
    from moyai.sea.irregular import synthesise

    waves = synthesise(
        sea.spectrum, unit.water, duration=sea.duration, seed=sea.seed, method="equal_energy", count=_COMPONENTS,
        heading=sea.heading, spreading=sea.spreading, current=_carried(unit),
    )  # fmt: skip
    time = np.arange(0.0, sea.duration, float(sea.spectrum.peak_period) / 40.0)
    crest = float(time[int(np.argmax(waves.elevation(time)))])
    begin = crest - place
    return replace(
        waves,
        phase=np.asarray(waves.phase) - np.asarray(waves.omega) * begin,
        heading=np.asarray(waves.heading) - unit.curtain.normal,
        frequency_step=None,
    )


__all__ = ["Plan", "plans_of"]
