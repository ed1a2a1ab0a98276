"""Put a curtain into its water before it is run: equilibrium, floats, impact, squared velocity."""

from __future__ import annotations

from moyai.case.check_sea import wave_path
from moyai.case.findings import Findings
from moyai.case.yaml_reader import KeyPath
from moyai.core.errors import ConvergenceError, InputError
from moyai.structures.curtain.assembly import LevelCurtain, assemble
from moyai.structures.curtain.model import CurtainProblem


def check_in_water(problem: CurtainProblem, findings: Findings) -> None:
    """Put the curtain into its water at every level: equilibrium, floats, and where the squared velocity ends."""
    said: set[str] = set()
    for name, level in problem.environment.water_levels:
        where = f" (water level {name})" if len(problem.environment.water_levels) > 1 else ""
        try:
            unit = assemble(problem, name, level)
            _check_floats(unit, findings, said, where)
            if unit.surface_speed > 0.0 and not findings.faults:
                _check_at_rest(unit, findings, where)
            if not findings.faults:
                _check_impact(problem, unit)
            if not findings.faults:
                _check_span(problem, unit)
        except InputError as error:
            _once(findings, said, error, where)
        except ConvergenceError as error:
            fault = error.fault
            _once(findings, said, InputError(fault.message, path="structure", remedy=fault.remedy), where)
        if "anchor_loads" in problem.settings.analyses:
            _check_squares(problem, level, findings, said, where)


def _once(findings: Findings, said: set[str], error: InputError, where: str) -> None:
    fault = error.fault
    if fault.message in said:
        return
    said.add(fault.message)
    path = findings.path_of(fault.path) or ("structure",)
    findings.fault(path, f"{fault.message}{where}", allowed=fault.allowed, remedy=fault.remedy)


def _check_span(problem: CurtainProblem, unit: LevelCurtain) -> None:
    """Put the whole span together where it is to be run through time: masses, ballast, floats, buoys."""
    given = problem.settings.dynamic
    if given is None or "dynamic" not in problem.settings.analyses:
        return
    from moyai.structures.curtain.dynamic.span import span_of

    span_of(unit, given)


def _check_floats(unit: LevelCurtain, findings: Findings, said: set[str], where: str) -> None:
    """Refuse floats that do not carry the curtain in still water."""
    net, buoyancy = unit.hanging.net_weight, unit.curtain.floats.buoyancy
    if net >= buoyancy:
        sinks = InputError(
            f"the floats lift {buoyancy:.4g} N/m under {net:.4g} N/m of skirt, toe and fittings: the curtain sinks in "
            "still water",
            path="structure.floats.buoyancy",
            allowed=f"more than {net:.4g} N/m",
            remedy="give larger floats or a lighter toe",
        )
        _once(findings, said, sinks, where)


def _check_at_rest(unit: LevelCurtain, findings: Findings, where: str) -> None:
    """Refuse a current that submerges the floats, and say which speed would."""
    statics = unit.statics
    if statics.float_reserve > 0.0:
        return
    limit = unit.drowning_speed
    path: KeyPath = ("current", "speed") if ("current", "speed") in findings.document.values else ("current",)
    findings.fault(
        path,
        f"the current of {unit.surface_speed:.4g} m/s submerges the floats: they lack {-statics.float_reserve:.4g} N/m"
        f"{where}",
        allowed=f"less than {limit:.4g} m/s at the surface, where the reserve is used up",
        remedy="give larger floats, flatter anchor lines or a lighter toe",
    )


def _check_impact(problem: CurtainProblem, unit: LevelCurtain) -> None:
    """Let the impact models refuse what they cannot take, before anything runs."""
    from moyai.structures.curtain.analyses.impact import bulging_skirt, impact_of, start_speed

    settings = problem.settings
    if "impact" in settings.analyses:
        speed, _ = start_speed(unit, settings.impact)
        impact_of(unit, settings.impact, speed)
        bulging_skirt(unit, settings.impact)


def _check_squares(problem: CurtainProblem, level: float, findings: Findings, said: set[str], where: str) -> None:
    """Refuse waves for which the squared velocity has no meaning: the highest wave breaks."""
    from moyai.sea.breaking import breaking_limit
    from moyai.structures.curtain.seas.states import design_waves

    water = problem.environment.water_at(level)
    for index, sea in enumerate(problem.environment.sea_states):
        for wave in design_waves(sea, problem.curtain.normal):
            acting = wave.effective_height(*problem.settings.direction)
            limit = breaking_limit(wave.period, water)
            if acting <= limit.height or wave.name in said:
                continue
            said.add(wave.name)
            path = wave_path(findings, index, "period")
            for key in ("period", "periods", "significant_period", "peak_period", "significant_height", "height"):
                if wave_path(findings, index, key) in findings.document.values:
                    path = wave_path(findings, index, key)
                    break
            findings.fault(
                path,
                f"the squared velocity has no meaning for {wave.name}: the wave of {acting:.3g} m that acts breaks at "
                f"a period of {wave.period:.3g} s ({limit.criterion}, {limit.height:.3g} m){where}",
                remedy="lengthen the period, lower the wave, or leave 'anchor_loads' out",
            )
