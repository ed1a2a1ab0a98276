"""What loads a curtain in any current and wave height, from the settings of a case: for load table and limits."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.sea.breaking import breaking_limit
from moyai.structures.curtain.analyses.anchor import rope_model
from moyai.structures.curtain.analyses.impact import ImpactAnswer, bulging_skirt, drag_coefficient
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.impact.cable import peak_by_energy
from moyai.structures.curtain.impact.cycle_table import CycleTable
from moyai.structures.curtain.impact.skirt import Skirt
from moyai.structures.curtain.model import Settings
from moyai.structures.curtain.seas.loads import DragCurve, ImpactLoad, SeaLoads
from moyai.structures.curtain.seas.squared_velocity import effective_height, squared_velocity
from moyai.structures.curtain.seas.states import DesignWave

#: Without impact at a standstill the start speed keeps this ratio to the water's [-]
_PAPER_RATIO = 1.0
#: Step of the logarithm of the speed between chords that are solved, and the chord of a straight skirt over its length.
_STEP, _STRAIGHT = 0.1, 1.0 - 1e-9


def impact_load(unit: LevelCurtain, answer: ImpactAnswer, settings: Settings) -> ImpactLoad:
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
        answer.skirt,
        unit.hanging.anchor_slope,
        answer.uncertainty,
        _skirt_in_current(unit, settings, answer),
    )


def _skirt_in_current(
    unit: LevelCurtain, settings: Settings, answer: ImpactAnswer
) -> Callable[[float], Skirt | None] | None:
    """Return the skirt at any speed of the water along the normal [m/s]; None where its chord is given or not known."""
    known = answer.skirt
    if known is None or settings.impact.chord is not None or not unit.normal_speed > 0.0:
        return None

    @cache
    def chord(step: int) -> float:
        there = replace(unit, surface_speed=unit.surface_speed * math.exp(step * _STEP))
        try:
            found = bulging_skirt(there, settings.impact)
        except (InputError, ConvergenceError):
            found = None
        # nearly straight where the arc is not resolved, as deep as in the case where there is no equilibrium
        return known.length * _STRAIGHT if found is None and there.surface_speed < unit.surface_speed else (
            known.chord if found is None else found.chord
        )  # fmt: skip

    def at(speed: float) -> Skirt:
        # counted from the current of the case: a model in another size finds the same
        place = math.log(speed / unit.normal_speed) / _STEP
        below = math.floor(place)
        share = place - below
        return replace(known, chord=(1.0 - share) * chord(below) + share * chord(below + 1))

    return at


def fastest_water(unit: LevelCurtain, settings: Settings, waves: tuple[DesignWave, ...]) -> float:
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


def sea_loads(unit: LevelCurtain, settings: Settings, answer: ImpactAnswer | None, curve: DragCurve) -> SeaLoads:
    """Return what any sea adds to the steady loads.

    Parameters
    ----------
    unit : LevelCurtain
    settings : Settings
    answer : ImpactAnswer or None
        None where neither impact nor slack and taut cycles were asked for.
    curve : DragCurve
        Loads at rest, up to :func:`fastest_water`.
    """
    limits, anchor = settings.limits, settings.anchor_loads
    asked = "impact" in settings.analyses
    lines = unit.curtain.anchors
    with_lines = anchor is not None and lines is not None and "anchor_loads" in settings.analyses
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
        steady=0.0 if lines is None or lines.pretension is None else lines.pretension,
        impact=impact_load(unit, answer, settings) if answer is not None and asked and limits.impact else None,
        snaps=None if answer is None else (_cycles(unit, settings, answer), impact_load(unit, answer, settings)),
    )


def _cycles(unit: LevelCurtain, settings: Settings, answer: ImpactAnswer) -> CycleTable:
    rule, ratio = settings.direction
    limits = settings.limits

    def acting(height: float) -> float:
        return float(effective_height(height, limits.wave_angle, rule, ratio))

    at_unit = unit.site.current(1.0).depth_mean(-unit.depth, 0.0)
    normal = unit.curtain.normal
    return CycleTable(
        answer.impact,
        drag_coefficient(unit, answer.impact.draught),
        unit.depth,
        float(at_unit @ np.array([math.cos(normal), math.sin(normal)])),
        acting,
        limits.period_of,
        limits.highest_height,
    )


def _pretension(unit: LevelCurtain, settings: Settings) -> float | None:
    """Return the steady tension that the energy model takes [N]; None: that of the statics at each speed."""
    anchor, lines = settings.anchor_loads, unit.curtain.anchors
    if anchor is not None and not anchor.pretension:
        return 0.0
    return None if lines is None else lines.pretension
