"""What the paper leaves out, and how far roll and transmission move with it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from moyai.core.results import Result
from moyai.mooring.lines import LineType
from moyai.reproduce.inputs import run_problem
from moyai.reproduce.model import FilledInput
from moyai.reproduce.nakamura.runs import CURVE, NakamuraRuns, abscissae, at, peak, values, variant
from moyai.structures.breakwater.model import BreakwaterProblem, Damping, MooringLine, RegularSea

PLACE = 3.5


def _words(case: BreakwaterProblem) -> str:
    found = run_problem("breakwater", case)
    top, place = peak(found)
    return f"roll {top:.2f} at L/B {place:.2f}, C_T {at(found, 'frequency', 'transmission_coefficient', PLACE):.2f}"


def _lines(case: BreakwaterProblem, change: Callable[[MooringLine], MooringLine]) -> BreakwaterProblem:
    lines = tuple(change(line) for line in case.breakwater.lines if isinstance(line, MooringLine))
    return replace(case, breakwater=replace(case.breakwater, lines=lines))


def _counted(case: BreakwaterProblem, total: int) -> BreakwaterProblem:
    return _lines(case, lambda line: replace(line, count=total // 2))


def _stiffer(case: BreakwaterProblem, stiffness: float) -> BreakwaterProblem:
    def change(line: MooringLine) -> MooringLine:
        segment = line.segments[0]
        kind = LineType(segment.line_type.name, segment.line_type.submerged_weight, stiffness)
        return replace(line, segments=(replace(segment, line_type=kind),))

    return _lines(case, change)


def _higher(case: BreakwaterProblem, height: float) -> BreakwaterProblem:
    return _lines(case, lambda line: replace(line, fairlead=(*line.fairlead[:2], height)))


def _waves(case: BreakwaterProblem, height: float) -> BreakwaterProblem:
    sea = case.environment.sea_states[0]
    assert isinstance(sea, RegularSea)
    return replace(case, environment=replace(case.environment, sea_states=(replace(sea, height=height),)))


def _centre(case: BreakwaterProblem, height: float) -> BreakwaterProblem:
    return replace(case, breakwater=replace(case.breakwater, centre_of_gravity=(0.0, height)))


def _only_roll(case: BreakwaterProblem) -> BreakwaterProblem:
    fraction = case.breakwater.damping.fraction_of_critical
    return replace(case, breakwater=replace(case.breakwater, damping=Damping(fraction, ("roll",))))


def _hardening(runs: NakamuraRuns) -> FilledInput:
    """Return what the tangent of moving chains does to roll, at the height of the paper and at a quarter of it."""
    periods = tuple(float(period) for period in abscissae(runs.moving_time, "time")["period"][-3:])
    height = runs.case.environment.sea_states[0].height  # type: ignore[union-attr]
    low = run_problem("breakwater", _waves(variant(runs.case, periods, time=True, moving=True), 0.25 * height))

    def less(result: Result, name: str) -> str:
        ratio = values(result, "time", "motion_amplitude", "roll") / values(result, "frequency", name, "roll")
        return ", ".join(f"{100 * (value - 1.0):+.1f}" for value in ratio[-len(periods) :])

    tangent, led = "motion_amplitude_with_tangent", "motion_amplitude"
    return FilledInput(
        "restoring of moving chains in frequency",
        "first harmonic of their force, led along the motion",
        "their tangent about the mean offset, as the paper takes chains at rest",
        f"roll in time over frequency at T = {', '.join(f'{period:.3g}' for period in periods)} s: "
        f"{less(runs.moving_time, led)} %; tangent {less(runs.moving_time, tangent)} %, "
        f"at a quarter of the height {less(low, tangent)} %",
    )


def filled(runs: NakamuraRuns) -> tuple[FilledInput, ...]:
    """Return the inputs that were filled in, with the effect of other values on the frequency domain with drift."""
    case = variant(runs.case, CURVE)
    draught = case.breakwater.draught
    assert draught is not None
    scale = 0.38 / 10.0
    plain = _words(case)

    def row(name: str, value: str, varied: str, *changed: BreakwaterProblem) -> FilledInput:
        return FilledInput(name, value, varied, "; ".join(_words(one) for one in changed) + f" (taken: {plain})")

    moving = values(runs.moving_time, "time", "motion_ratio", "roll")
    rows = [
        row("number of chains", "4", "2; 8", _counted(case, 2), _counted(case, 8)),
        row("EA of a chain", "21.4 kN, a studless chain of its weight at model scale", "560 kN, a small real chain",
            _stiffer(case, 5.6e5)),
        row("place of the fairleads", "bottom corners: the chain reaches up by depth less draught", "half the draught",
            _higher(case, 0.5 * draught)),
        row("wave height", "4.0 cm, printed as about", "3.5; 4.5 cm", _waves(case, 0.035), _waves(case, 0.045)),
        row("modes that the 15 % act on", "all three", "roll alone", _only_roll(case)),
        row("centre of gravity", "2.7 cm below still water, the model's column",
            "0.17 m below at prototype scale, as its column prints", _centre(case, draught - 0.17 * scale)),
        FilledInput(
            "mass, drag and added mass of moving chains", "0.1315 kg/m; 2.4 and 1.15 on 2.6 mm; 1.0",
            "chains at rest at every instant",
            f"roll at the longest wave {moving[-1]:.2f} moving, "
            f"{values(runs.drifted_time, 'time', 'motion_ratio', 'roll')[-1]:.2f} at rest, "
            f"{values(runs.moving_time, 'frequency', 'motion_ratio', 'roll')[-1]:.2f} in frequency",
        ),
        _hardening(runs),
        FilledInput("periods", "14 between 0.6 and 1.6 s", "curves over 53 periods", "none: linear waves, one by one"),
    ]  # fmt: skip
    return tuple(rows)
