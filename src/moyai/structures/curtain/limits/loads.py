"""What loads a curtain in any current and wave height, from the settings of a case: for load table and limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import each_at_once
from moyai.core.errors import ConvergenceError, InputError
from moyai.sea.breaking import breaking_limit
from moyai.sea.spectra import goda_peak_period, jonswap
from moyai.sea.states import IrregularSea
from moyai.structures.curtain.analyses.anchor import rope_model
from moyai.structures.curtain.analyses.impact import ImpactAnswer, bulging_skirt
from moyai.structures.curtain.analyses.waves import largest_tension, left_out, realisation, still_flow
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.impact.cable import peak_by_energy
from moyai.structures.curtain.impact.skirt import BulgedSkirt
from moyai.structures.curtain.model import CurtainSettings
from moyai.structures.curtain.seas.loads import DragCurve, ImpactLoad, SeaLoads
from moyai.structures.curtain.seas.squared_velocity import effective_height, squared_velocity
from moyai.structures.curtain.seas.states import DesignWave
from moyai.structures.curtain.snaps.flow import SkirtFlow
from moyai.structures.curtain.snaps.snap_table import SnapTable
from moyai.structures.curtain.statics.steady_load import drag_factors

#: Without impact at a standstill the start speed keeps this ratio to the water's [-]
_PAPER_RATIO = 1.0
#: Step of the logarithm of the speed between chords that are solved, and the chord of a straight skirt over its length.
_STEP, _STRAIGHT = 0.1, 1.0 - 1e-9
#: Part of the current of the case below which the water is slack [-].
_SLACK = 1e-3
#: Of the seas that snaps are looked for in; peak periods that are run of them.
_PEAK_ENHANCEMENT, _PERIODS = 3.3, 300.0
#: Acting over given height below which waves run along the curtain and draw it taut nowhere.
_ALONG = 1e-6


def impact_load(unit: LevelCurtain, answer: ImpactAnswer, settings: CurtainSettings) -> ImpactLoad:
    """Return the impact at any speed of the water, in the proportions of the case."""
    given = settings.impact
    ratio = _PAPER_RATIO
    if unit.normal_speed > 0.0 and (given.start_speed is not None or given.start == "slack_phase"):
        ratio = answer.impact.speed / unit.normal_speed
    return ImpactLoad(
        answer.impact,
        answer.design_tension / peak_by_energy(answer.impact).tension,
        answer.shares,
        ratio,
        answer.skirt or _straight_skirt(unit),
        unit.hanging.anchor_slope,
        answer.uncertainty,
        _skirt_in_current(unit, settings, answer),
    )


def _straight_skirt(unit: LevelCurtain) -> BulgedSkirt | None:
    """Return the skirt of a curtain that is held at both edges and hangs straight without a current, else ``None``."""
    skirt = unit.curtain.skirt
    hangs = unit.curtain.toe == "held" and unit.surface_speed == 0.0
    if not hangs or math.isinf(skirt.stiffness) or skirt.length > unit.water.depth:
        return None
    return BulgedSkirt(skirt.length, skirt.length * _STRAIGHT, skirt.stiffness)


def _skirt_in_current(
    unit: LevelCurtain, settings: CurtainSettings, answer: ImpactAnswer
) -> Callable[[float], BulgedSkirt | None] | None:
    """Return the skirt at any speed of the water along the normal [m/s]; None where its chord is not known.

    At slack water it hangs straight.
    """
    known = answer.skirt
    if known is None or not unit.normal_speed > 0.0:
        return None
    # a chord that is given is that in the current of the case: in a weaker one the skirt hangs no less straight
    given, free = settings.impact.chord, replace(settings.impact, chord=None)

    @cache
    def chord(step: int) -> float:
        there = replace(unit, surface_speed=unit.surface_speed * math.exp(step * _STEP))
        try:
            found = bulging_skirt(there, free)
        except (InputError, ConvergenceError):
            found = None
        if given is not None and (found is None or there.surface_speed >= unit.surface_speed):
            return given if there.surface_speed >= unit.surface_speed else known.length * _STRAIGHT
        if given is not None and found is not None:
            return max(given, found.chord)
        # nearly straight where the arc is not resolved, as deep as in the case where there is no equilibrium
        return known.length * _STRAIGHT if found is None and there.surface_speed < unit.surface_speed else (
            known.chord if found is None else found.chord
        )  # fmt: skip

    def at(speed: float) -> BulgedSkirt:
        if not speed > _SLACK * unit.normal_speed:
            return replace(known, chord=known.length * _STRAIGHT)
        # counted from the current of the case: a model in another size finds the same
        place = math.log(speed / unit.normal_speed) / _STEP
        below = math.floor(place)
        share = place - below
        return replace(known, chord=(1.0 - share) * chord(below) + share * chord(below + 1))

    return at


def fastest_water(unit: LevelCurtain, settings: CurtainSettings, waves: tuple[DesignWave, ...]) -> float:
    """Return the largest root of the squared velocity [m/s] that load table and operating limits ask for.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    waves : tuple of DesignWave
        Of the case.
    """
    limits = settings.limits
    rule, ratio = settings.direction
    water, speeds = unit.water, [unit.normal_speed]

    def root(height: float, period: float, current: float) -> float:
        return math.sqrt(float(squared_velocity(height, period, current, unit.depth, water)))

    speeds += [root(wave.effective_height(rule, ratio), wave.period, unit.normal_speed) for wave in waves]
    if "limits" in settings.analyses:
        current = unit.unit_normal_speed * limits.highest_speed
        for height in np.linspace(0.0, limits.highest_height, 30)[1:]:
            period = limits.period_of(float(height))
            acting = float(effective_height(height, limits.wave_angle, rule, ratio))
            if acting <= breaking_limit(period, water).height:
                speeds.append(root(acting, period, current))
        speeds.append(current)
    return 1.0001 * max(speeds)


def sea_loads(
    unit: LevelCurtain,
    settings: CurtainSettings,
    answer: ImpactAnswer | None,
    curve: DragCurve,
    duration: float | None = None,
    strong_drag: float = 1.0,
) -> SeaLoads:
    """Return what any sea adds to the steady loads.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    answer : ImpactAnswer or None
        None where neither impact nor slack and taut cycles were asked for.
    curve : DragCurve
        Loads at rest, up to :func:`fastest_water`.
    duration : float, optional
        Of a sea [s]; that of ``settings.waves.hours`` when left out.
    strong_drag : float
        What the upper end of the drag coefficient makes of snaps in waves [-].
    """
    limits, anchor = settings.limits, settings.anchor_loads
    asked = "impact" in settings.analyses
    lasting = 3600.0 * settings.waves.hours if duration is None else duration
    with_lines = anchor is not None and unit.curtain.anchors is not None and "anchor_loads" in settings.analyses
    return SeaLoads(
        period=limits.period_of,
        angle=limits.wave_angle,
        rule=settings.direction[0],
        height_ratio=settings.direction[1],
        depth=unit.depth,
        normal_ratio=unit.unit_normal_speed,
        drag=curve,
        energy=rope_model(unit, anchor) if with_lines and anchor is not None else None,
        pretension=_pretension(unit, settings),
        line_pretension=unit.hanging.pretension,
        impact=impact_load(unit, answer, settings) if answer is not None and asked and limits.impact else None,
        snaps=None
        if answer is None
        else (_snaps(unit, settings, answer, lasting), impact_load(unit, answer, settings)),
        strong_drag=strong_drag,
        strong_crest=1.0 if unit.nominal else drag_factors(unit.hanging.drag)[1],
    )


def _snaps(unit: LevelCurtain, settings: CurtainSettings, answer: ImpactAnswer, duration: float) -> SnapTable:
    """Return the snaps in JONSWAP seas of any height, long crested along the normal, with the periods of the limits."""
    rule, ratio = settings.direction
    limits, given = settings.limits, settings.waves

    def stands(height: float) -> bool:
        highest = float(effective_height(height, limits.wave_angle, rule, ratio))
        return highest <= breaking_limit(limits.period_of(height), unit.water).height

    @cache
    def seas(height: float) -> tuple[tuple[IrregularSea, SkirtFlow], ...]:
        """Return the realisations of a height and the waves that the skirt feels in them, whatever the current."""
        sea = _sea_of_height(unit, settings, height)
        lasting = min(duration, sea.duration)
        drawn = [replace(sea, duration=lasting, seed=seed) for seed in range(1, 1 + max(given.realisations, 2))]
        return tuple((sea, still_flow(unit, given, sea)) for sea in drawn)

    def realise(speed: float, height: float) -> Array:
        if not float(effective_height(height, limits.wave_angle, rule, 1.0)) > _ALONG * height:
            return np.zeros(2)
        there = replace(unit, surface_speed=speed)
        runs = each_at_once(lambda one, _: realisation(there, given, one[0], answer.impact, one[1]), seas(height))
        tops = np.array([largest_tension(run, left_out(sea)) for run, (sea, _) in zip(runs, seas(height))])
        # the largest of a longer sea, by Gumbel's law of the largest of shorter ones
        longer = math.log(duration / seas(height)[0][0].duration)
        return tops + float(tops.std(ddof=1)) * math.sqrt(6.0) / math.pi * longer

    return SnapTable(realise, stands, limits.highest_height)


def _sea_of_height(unit: LevelCurtain, settings: CurtainSettings, height: float) -> IrregularSea:
    """Return the JONSWAP sea of a significant height [m] as it acts along the normal, with the period of the limits."""
    limits = settings.limits
    acting = float(effective_height(height, limits.wave_angle, settings.direction[0], 1.0))
    period = goda_peak_period(limits.period_of(height), _PEAK_ENHANCEMENT)
    spectrum = jonswap(acting, period, _PEAK_ENHANCEMENT)
    return IrregularSea("sea", spectrum, unit.curtain.normal, duration=_PERIODS * period, seed=1)


def drift_of_height(unit: LevelCurtain, settings: CurtainSettings, height: float) -> float:
    """Return the current as strong as the drift of the sea of a significant height [m] [eq:curtain-wave-drift]."""
    return unit.drift_in([_sea_of_height(unit, settings, height)]) if height > 0.0 else 0.0


def _pretension(unit: LevelCurtain, settings: CurtainSettings) -> float | None:
    """Return the steady tension that the energy model takes [N]; None: that of the statics at each speed."""
    anchor, lines = settings.anchor_loads, unit.curtain.anchors
    if anchor is not None and not anchor.pretension:
        return 0.0
    return None if lines is None else lines.pretension
