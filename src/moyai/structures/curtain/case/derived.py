"""Derived numbers of a curtain case: ratios, rise of an impact, waves against depth and breaking."""

from __future__ import annotations

import math
from collections.abc import Iterator

from moyai.case.builder import build
from moyai.case.derived import Number, force_unit
from moyai.case.reader import Case
from moyai.core.errors import InputError
from moyai.sea.breaking import breaking_limit
from moyai.sea.dispersion import wave_number
from moyai.structures.curtain.analyses.impact import impact_of, start_speed
from moyai.structures.curtain.assembly import LevelCurtain, assemble
from moyai.structures.curtain.case import schema
from moyai.structures.curtain.impact.cable import closed_form, impact_numbers, peak_by_energy
from moyai.structures.curtain.model import CurtainProblem
from moyai.structures.curtain.seas.squared_velocity import squared_velocity
from moyai.structures.curtain.seas.states import design_waves


def derived_numbers(case: Case) -> tuple[Number, ...]:
    """Return the derived numbers of a curtain case."""
    problem: CurtainProblem = build(case)
    numbers: list[Number] = []
    for name, level in problem.environment.water_levels:
        unit = assemble(problem, name, level)
        numbers.extend(_span_numbers(unit, case.model.structure.toe))
        if unit.surface_speed > 0.0:
            numbers.extend(_statics_numbers(unit))
        if "impact" in problem.settings.analyses:
            numbers.extend(_impact_numbers(unit, problem))
        numbers.extend(_wave_numbers(unit, problem))
    return tuple(numbers)


def _span_numbers(unit: LevelCurtain, toe: schema.Toe) -> Iterator[Number]:
    group, level, curtain, water = "Span", unit.name, unit.curtain, unit.water
    yield Number(group, level, "water depth h", water.depth, "m")
    yield Number(group, level, "span ratio R = B/l", curtain.span / curtain.length)
    yield Number(group, level, "depth ratio h/d", water.depth / curtain.skirt.length)
    if toe.chain_mass is not None:
        density = toe.chain_density or schema.STEEL_DENSITY
        yield Number(group, level, "density of the toe chain", density, "kg/m3")
    yield Number(group, level, "toe load under water", curtain.skirt.toe_load, "N/m")
    yield Number(group, level, "weight of skirt and toe on the floats", unit.hanging.net_weight, "N/m")
    yield Number(
        group,
        level,
        "share of the buoyancy used in still water",
        unit.hanging.net_weight / curtain.floats.buoyancy,
        "%",
        3,
    )
    if curtain.anchors is not None:
        yield Number(group, level, "slope of the anchor lines", unit.hanging.anchor_slope, "deg", 3)
        yield Number(group, level, "stiffness K of an anchor line", curtain.anchors.stiffness, "kN/m")


def _statics_numbers(unit: LevelCurtain) -> Iterator[Number]:
    group, level, water = "In the current", unit.name, unit.water
    statics = unit.statics
    yield Number(group, level, "speed along the normal, mean over the skirt", unit.normal_speed, "m/s")
    yield Number(group, level, "angle of the flow from the normal", unit.flow_angle, "deg", 3)
    if math.isfinite(water.depth):
        speed = unit.normal_speed / math.sqrt(water.gravity * water.depth)
        yield Number(group, level, "Froude number U/sqrt(gh)", speed)
        yield Number(group, level, "blockage d/h", statics.section.blockage, "%", 3)
    yield Number(group, level, "drag coefficient", statics.section.drag_coefficient)
    pressure = 0.5 * water.density * statics.section.drag_coefficient * unit.normal_speed**2
    load = pressure * unit.curtain.skirt.length / unit.curtain.skirt.toe_load
    yield Number(group, level, "load ratio qL/W", load)
    yield Number(group, level, "effective depth", statics.section.effective_depth, "m")
    yield Number(group, level, "tension of all cables", statics.plan.tension, force_unit(statics.plan.tension))
    yield Number(group, level, "float reserve", statics.reserve_ratio, "%", 3)


def _impact_numbers(unit: LevelCurtain, problem: CurtainProblem) -> Iterator[Number]:
    group, level, water = "Impact", unit.name, unit.water
    settings = problem.settings.impact
    speed, _ = start_speed(unit, settings)
    impact = impact_of(unit, settings, speed)
    peak, small = peak_by_energy(impact), closed_form(impact)
    yield Number(group, level, "start speed", speed, "m/s")
    if math.isfinite(water.depth):
        yield Number(group, level, "Cauchy number C_E", impact_numbers(impact, peak.tension).cauchy_number)
    yield Number(group, level, "added mass 2 rho d^2/pi", impact.deep_mass, "kg/m")
    yield Number(group, level, "tension by model A", peak.tension, force_unit(peak.tension))
    yield Number(group, level, "rise of the tension t_peak", peak.time, "s")
    yield Number(group, level, "t_peak/√(d/g)", peak.time / math.sqrt(impact.draught / water.gravity), "", 3)
    if settings.time_step is not None:
        rise = small.time if math.isfinite(small.time) else peak.time
        yield Number(group, level, "marching step omega dt", 0.5 * math.pi * settings.time_step / rise, "", 3)


def _wave_numbers(unit: LevelCurtain, problem: CurtainProblem) -> Iterator[Number]:
    water, level = unit.water, unit.name
    for sea in problem.environment.sea_states:
        for wave in design_waves(sea, unit.curtain.normal):
            group = f"Waves: {wave.name}"
            number = float(wave_number(2.0 * math.pi / wave.period, water.depth, water.gravity))
            label = "significant period T1/3" if wave.irregular else "period"
            yield Number(group, level, label, wave.period, "s")
            yield Number(group, level, "wavelength", 2.0 * math.pi / number, "m")
            if math.isfinite(water.depth):
                yield Number(group, level, "relative depth kh", number * water.depth)
            yield Number(group, level, "angle from the normal", wave.angle, "deg", 3)
            height = wave.effective_height(*problem.settings.direction)
            yield Number(group, level, "height that acts on the curtain", height, "m")
            limit = breaking_limit(wave.period, water).height
            yield Number(group, level, "share of the breaking height", height / limit, "%", 3)
            try:
                square = float(squared_velocity(height, wave.period, unit.normal_speed, unit.depth, water))
            except InputError:
                continue
            yield Number(group, level, "squared velocity under the crest", square, "m2/s2")
