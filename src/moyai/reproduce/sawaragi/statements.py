"""The statements of the paper, each judged from the runs, and what was filled in."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from moyai.design.similarity import Scale, scale_water
from moyai.reproduce.model import FilledInput, Finding, Statement, judged, measured
from moyai.reproduce.sawaragi.figures import log_slope
from moyai.reproduce.sawaragi.runs import DRAG, LINE, SHEET_MASS, STEEL, TOE_MASS, Release, SawaragiRuns, SpanRecord
from moyai.structures.curtain.impact.cable import Impact, impact_numbers, peak_by_energy
from moyai.structures.curtain.impact.march import iterate_first_step
from moyai.structures.curtain.impact.skirt import BulgedSkirt, cable_and_skirt_impact, curved_impact, skirt_impact


def _exponent(runs: SawaragiRuns, name: str) -> float:
    """Return d log T / d log of a size of the span, at the flume."""
    low, high = (
        peak_by_energy(replace(runs.span, **{name: getattr(runs.span, name) * (1.0 + step)})).tension
        for step in (-1e-3, 1e-3)
    )
    return math.log(high / low) / math.log(1.001 / 0.999)


def _rise_first(runs: SawaragiRuns) -> Finding:
    record = runs.whole_line
    parts = record.before_spike()
    words = ", ".join(f"{value:.2f}" for value in parts)
    return judged(
        parts[0] > 0.0 and bool(np.all(np.diff(parts) > 0.0)),
        f"whole span released slack: mean tension {words} N in the quarters of the {record.spike_time:.2f} s before "
        "the "
        f"spike, as the span is picked up from its supports; model A has no tension until taut",
    )


def _spike(runs: SawaragiRuns) -> Finding:
    one = runs.line
    words = f"spike {one.spike:.2f} N, {one.rise:.2f} s after taut, steady {one.plateau:.2f} N"
    return judged(one.spike > 2.0 * one.plateau, words)


def _one_spike(runs: SawaragiRuns) -> Finding:
    record = runs.whole_line
    count = record.spikes()
    return judged(
        count == 1,
        f"whole span released slack: {record.spike:.2f} N, then {record.plateau:.2f} N; peaks that rise by more than "
        f"half of the highest: {count}; contacts of model A above half of its highest: {_contacts(runs.line)}",
    )


def _one_spike_of_steel(runs: SawaragiRuns) -> Finding:
    count = _contacts(runs.steel)
    return judged(
        count == 1,
        f"model A: {count} contacts above half of the highest",
        "model A's cable gives its energy back and throws the skirt upstream. A whole span is picked up piece by "
        "piece: a hundred times the damping of the mesh takes the bounces away, and each cell still makes "
        "a spike of its own with steel, 11.6 N on 12 by 4 cells, 8.1 N on 24 by 8, so that no count is a finding",
    )


def _contacts(record: Release) -> int:
    """Return how many contacts of a record of model A exceed half of the highest."""
    return sum(contact.tension > 0.5 * record.spike for contact in record.motion.contacts)


def _same_time(runs: SawaragiRuns) -> Finding:
    upper, lower, first, second = runs.edges(LINE)
    words = f"upper {upper:.2f} N at {first:.3f} s, lower {lower:.2f} N at {second:.3f} s"
    return judged(abs(first / second - 1.0) < 0.05, words)


def _steel(runs: SawaragiRuns) -> Finding:
    ratio, faster = runs.steel.spike / runs.line.spike, runs.line.rise / runs.steel.rise
    return judged(
        ratio > 2.0 and faster > 2.0, f"steel is {ratio:.0f} times as high and rises {faster:.0f} times as fast"
    )


def _plateau(runs: SawaragiRuns) -> Finding:
    words = (
        f"{runs.line.plateau:.2f} N with fishing line, {runs.steel.plateau:.2f} N with steel; whole span "
        f"{runs.whole_line.plateau:.2f} N with fishing line"
    )
    return judged(abs(runs.steel.plateau / runs.line.plateau - 1.0) < 0.2, words)


def _high_frequency(runs: SawaragiRuns) -> Finding:
    number, mass, _ = runs.over_frequency
    words = (
        f"M/M0 = {np.interp(10.0, number, mass):.2f} at Kd = 10, {mass[-1]:.2f} at {number[-1]:.0f}, least "
        f"{mass.min():.2f}"
    )
    return judged(0.93 < mass[-1] < 1.0 and mass[-1] > np.interp(10.0, number, mass), words)


def _half_circle(runs: SawaragiRuns) -> Finding:
    found = float(runs.over_curvature[1][0, 0])
    return judged(1.35 < found < 1.5, f"{found:.3f} times the plate of the same chord")


def _stretching(runs: SawaragiRuns) -> Finding:
    distance, values, lengths = runs.over_curvature
    over = values[1:] / lengths**2
    far = over[:, distance >= 1.0].max()
    words = f"{over[0, 0]:.2f} of M0 at s/d = 0, {far:.2f} or less beyond 1"
    return judged(bool(np.all(np.diff(over, axis=1) < 0.0)) and over.max() < 0.65, words)


def _froude(runs: SawaragiRuns) -> Finding:
    slope = log_slope(*runs.over("froude", LINE), 0.05, 0.25)
    return judged(slope < -0.5, f"C_T goes with Fr to the power {slope:.2f}")


def _span(runs: SawaragiRuns) -> Finding:
    x, found = runs.over("span_ratio", LINE)
    slopes = [log_slope(x, found, low, low + 0.1) for low in (0.6, 0.8)]
    return judged(
        0.8 < slopes[1] < 1.05, f"C_T goes with B/l to the power {slopes[0]:.2f} at 0.65 and {slopes[1]:.2f} at 0.85"
    )


def _depth(runs: SawaragiRuns) -> Finding:
    x, found = runs.over("depth_ratio", LINE)
    change = float(np.ptp(found[(x >= 0.25) & (x <= 0.5)]) / found.mean())
    return judged(change < 0.03, f"C_T changes by {100 * change:.1f} % from d/h = 0.25 to 0.5")


def _root(runs: SawaragiRuns) -> Finding:
    x, found = runs.over_stiffness()
    slope = log_slope(x, found, float(x[1]), float(x[-2]))
    return judged(
        abs(slope - 1.0) < 0.05, f"C_T goes with C_E to the power {slope:.3f}, T with EA to {0.5 * slope:.3f}"
    )


def _proportional(runs: SawaragiRuns) -> Finding:
    speed, draught = _exponent(runs, "speed"), _exponent(runs, "draught")
    words = f"T goes with the speed to the power {speed:.3f}, with the depth of the skirt to {draught:.3f}"
    return judged(abs(speed - 1.0) < 0.05 and abs(draught - 1.0) < 0.05, words)


def _cube(runs: SawaragiRuns) -> Finding:
    length = 25.0
    scale, small = Scale(length, 1.0, 1.0), runs.span
    large = replace(
        small,
        **{name: scale.to_prototype(getattr(small, name), "m") for name in ("span", "length", "draught")},
        **{name: scale.to_prototype(getattr(small, name), "N") for name in ("upper_stiffness", "lower_stiffness")},
        speed=scale.to_prototype(small.speed, "m/s"),
        water=scale_water(small.water, Scale(1.0 / length, 1.0, 1.0)),
    )
    ratio = peak_by_energy(large).tension / peak_by_energy(small).tension / length**3
    return judged(abs(ratio - 1.0) < 1e-9, f"T over the cube of the scale, at 1:25: {ratio:.12f}")


def _iterates(runs: SawaragiRuns) -> Finding:
    omega = math.pi / 2.0 / peak_by_energy(runs.span).time
    tried = {each: iterate_first_step(runs.span, each / omega, reverse=False).converged for each in (0.02, 0.5, 2.0)}
    met, lost = (", ".join(f"{each:g}" for each in tried if bool(tried[each]) is meets) for meets in (True, False))
    words = f"the iteration converges at omega dt = {met or 'none'} and does not at omega dt = {lost or 'none'}"
    return judged(
        tried[0.02], words,
        "from displacement to acceleration to load it contracts only for steps too long to be accurate; the "
        "other way round it "
        "works, and the code needs none, since the load follows from the displacement",
    )  # fmt: skip


def _above(runs: SawaragiRuns) -> Finding:
    return measured(
        f"model A {peak_by_energy(runs.span).tension:.2f} N, released by itself {runs.line.spike:.2f} N: the "
        f"skirt is slower "
        "than the current when taut"
    )


def _start_speed(runs: SawaragiRuns) -> Finding:
    first = runs.line.motion.contacts[0]
    share = first.speed / runs.span.speed
    return judged(0.3 < share < 1.0, f"the skirt is taut at {100 * share:.0f} % of the current's speed")


def _skirt(runs: SawaragiRuns) -> BulgedSkirt:
    chord = runs.case.settings.impact.chord
    assert chord is not None
    return BulgedSkirt(runs.span.draught, chord, runs.case.curtain.skirt.stiffness)


def _rise_time(runs: SawaragiRuns) -> Finding:
    return measured(
        f"model A rises in {peak_by_energy(runs.span).time:.2f} s with fishing line, released by itself in "
        f"{runs.line.rise:.2f} s"
    )


def _span_in_tests(runs: SawaragiRuns) -> Finding:
    _, found = runs.over("span_ratio", LINE)
    return measured(f"C_T of model A is {found.min():.1f} to {found.max():.1f} from B/l = 0.5 to 0.99")


def _statics(runs: SawaragiRuns) -> Finding:
    whole, model = runs.whole_line.spike, runs.line.spike
    words = f"the whole span, dynamic, has a spike of {whole:.2f} N, model A released the same way {model:.2f} N"
    return judged(abs(whole / model - 1.0) > 0.1, words)


def _flat(runs: SawaragiRuns) -> Finding:
    skirt = _skirt(runs)
    curved, flat = curved_impact(runs.span, skirt).tension, peak_by_energy(runs.span).tension
    words = (
        f"{curved:.2f} N with the arc on a chord of {skirt.chord:g} m, {flat:.2f} N with the flat plate of the skirt's "
        f"length {skirt.length:g} m"
    )
    return judged(
        curved < flat, words,
        "an arc has more added mass than the plate of its chord, as figure 7 of the paper shows itself",
    )  # fmt: skip


def _stretches(runs: SawaragiRuns) -> Finding:
    both, alone = (
        cable_and_skirt_impact(runs.span, _skirt(runs)).tension,
        curved_impact(runs.span, _skirt(runs)).tension,
    )
    words = f"{both:.2f} N with a skirt that stretches, {alone:.2f} N with the same arc held rigid"
    return judged(both < alone, words)


def _separate(runs: SawaragiRuns) -> Finding:
    upper, lower, _, _ = runs.edges(LINE)
    words = f"edges that move by themselves: upper {upper:.2f} N, lower {lower:.2f} N, with cables of equal stiffness"
    return judged(abs(upper / lower - 1.0) > 0.05, words)


def _model_b(runs: SawaragiRuns) -> Finding:
    skirt = _skirt(runs)
    found = skirt_impact(runs.span, skirt)
    words = f"model B with a skirt of {1e-3 * skirt.stiffness:.0f} kN/m: {found.edge_load:.0f} N/m on a cable"
    return measured(words, "the paper gives no number for model B, since the modulus of its sheet was not known")


STATEMENTS = (
    Statement("rise", "2, figure 3", "From release to taut the tension rises gently.", _rise_first),
    Statement("spike", "2, figure 3", "A sharp spike when taut, then a steady level.", _spike),
    Statement("one-spike", "2, figure 3", "There is one spike with fishing line.", _one_spike),
    Statement("one-spike-steel", "2, figure 3", "There is one spike with steel wire.", _one_spike_of_steel),
    Statement("same-time", "2, figure 3", "Both cables spike together.", _same_time),
    Statement("steel", "2", "Steel makes the spike sharper and higher.", _steel),
    Statement("plateau", "2", "The steady level hardly depends on the cable.", _plateau),
    Statement(
        "high-frequency", "3.2, figure 6", "The added mass tends to the plate's at high frequency.", _high_frequency
    ),
    Statement(
        "half-circle", "3.2, figure 7", "A half circle has about 1.4 times the added mass of the plate.", _half_circle
    ),
    Statement(
        "stretching", "3.2, figure 8", "The added mass of stretching falls with s/d and is well below M0.", _stretching
    ),
    Statement("iteration", "3.4", "In each step the displacement is found by iteration.", _iterates),
    Statement("above", "4.1, figures 15, 16", "Model A lies a little above the tests with fishing line.", _above),
    Statement(
        "rise-time",
        "4.1, 4.5, figure 15",
        "Model A gives the rise time of the measured spike to some extent.",
        _rise_time,
    ),
    Statement("froude", "4.2, figure 17", "C_T falls with the Froude number.", _froude),
    Statement("span", "4.2, figure 18", "At large B/l C_T is nearly proportional to it.", _span),
    Statement("span-tests", "4.2, figure 18", "The tests do not show the effect of B/l clearly.", _span_in_tests),
    Statement("depth", "4.2, figure 19", "C_T hardly depends on d/h.", _depth),
    Statement("root", "4.3, figure 20", "C_T goes with the root of the stiffness.", _root),
    Statement(
        "statics",
        "4.4",
        "An impact needs the dynamics of the cable; its shape at rest and even acceleration are doubtful.",
        _statics,
    ),
    Statement("flat", "4.4", "The flat plate has too much added mass, since the skirt bulges.", _flat),
    Statement("stretches", "4.4", "Stretch of the skirt takes tension from the cables.", _stretches),
    Statement("separate", "4.4", "Upper and lower cable have different impacts, which model A cannot give.", _separate),
    Statement("start", "4.4", "The skirt may be slower than the flow when it becomes taut.", _start_speed),
    Statement(
        "proportional", "4.5", "The impact tension is proportional to speed and depth of the skirt.", _proportional
    ),
    Statement("cube", "4.3, 4.5", "A model needs a stiffness of the scale's cube.", _cube),
    Statement("model-b", "5", "Model B for stiff cables was not computed.", _model_b),
)


def _spike_words(record: SpanRecord) -> str:
    return f"spike {record.spike:.2f} N, steady {record.plateau:.2f} N"


def filled(runs: SawaragiRuns) -> tuple[FilledInput, ...]:
    """Return the inputs that were filled in, with the peak of model A and C_T."""

    def words(span: Impact) -> str:
        tension = peak_by_energy(span).tension
        return f"{tension:.2f} N, C_T {impact_numbers(span, tension).tension_coefficient:.2f}"

    span = runs.span
    plain = f" (taken: {words(span)})"
    skirt = _skirt(runs)
    curved = curved_impact(span, skirt)
    return (
        FilledInput("water depth", f"{span.water.depth:g} m", "0.6 m",
                    words(replace(span, water=replace(span.water, depth=0.6))) + plain),
        FilledInput("span between the supports", f"{span.span:g} m", "1.0 m at the same B/l",
                    words(replace(span, span=1.0, length=span.length / span.span)) + plain),
        FilledInput("length of the cable", f"{span.length:g} m", "0.75; 1.0 m",
                    f"{words(replace(span, length=0.75))}; {words(replace(span, length=1.0))}{plain}"),
        FilledInput("depth of the skirt", f"{span.draught:g} m", "0.10; 0.20 m",
                    f"{words(replace(span, draught=0.10))}; {words(replace(span, draught=0.20))}{plain}"),
        FilledInput("EA of both cables", f"{LINE:g} N, a fishing line", "75; 300 N; steel 39 kN",
                    "; ".join(words(runs.with_stiffness(total)) for total in (75.0, 300.0, STEEL)) + plain),
        FilledInput("speed of the current", f"{span.speed:g} m/s", "0.15; 0.45 m/s",
                    f"{words(replace(span, speed=0.15))}; {words(replace(span, speed=0.45))}{plain}"),
        FilledInput("curvature of the skirt", "flat plate, as in model A", f"arc on a chord of {skirt.chord:g} m",
                    f"{curved.tension:.2f} N{plain}"),
        FilledInput("slack at the release", "gathered evenly, straight between the supports", "half of the way to taut",
                    f"{_spike_words(runs.span_released(LINE, runs.cells, 0.5))} "
                    f"(taken: {_spike_words(runs.whole_line)})"),
        FilledInput("mass of sheet and lower edge", f"{SHEET_MASS:g} kg/m2, {TOE_MASS:g} kg/m", "twice as heavy",
                    f"{_spike_words(runs.span_released(LINE, runs.cells, heavier=2.0))} "
                    f"(taken: {_spike_words(runs.whole_line)})"),
        FilledInput("drag coefficient", f"{DRAG:g}", "1.2 to 2 in practice", "proportional to the steady level, "
                                                                             "none on A"),
    )  # fmt: skip
