"""The statements of the paper, each judged from the runs, and what was filled in."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from moyai.core.arrays import Array
from moyai.reproduce.model import FilledInput, Finding, Statement, judged, measured
from moyai.reproduce.tabata.campaign import CONVENTIONAL, CURTAIN_DEPTH, NEW, WATER
from moyai.reproduce.tabata.runs import CHOSEN, ROPES, TYPHOON, Pulls, TabataRuns
from moyai.series.regressions import correlation, fit_by_direction, fit_cosine, fit_power, type_ratio
from moyai.structures.curtain.seas.anchor_energy import EnergyModel, product_needed
from moyai.structures.curtain.seas.squared_velocity import effective_height, fit_proportional
from moyai.tables import line_type

PLANTED = "planted in a synthetic campaign"
_TAKEN = "10 % longer than its span, waves at 60 degrees, T_1/3 of 6.75 s, stiffness, damping and drag of the case"
#: Highest steady and fluctuating tension of an anchor rope of the new type that figure 3 shows [N]
STEADY, FLUCTUATING = 13.7e3, 14.7e3


def _linear(runs: TabataRuns) -> Finding:
    new = runs.new
    chosen = new.angle < CHOSEN
    reduced = (new.averaged("tenth") * new.significant_period / np.cos(new.angle) ** 2)[chosen]
    found = fit_power(new.significant_height[chosen], reduced)["exponent"]
    words = (
        f"T_1/10 times the period goes with H_1/3 to the power {found.value:.2f} ({found.low:.2f} to {found.high:.2f})"
    )
    return judged(abs(found.value - 1.0) < 0.15, words)


def _uncorrelated(runs: TabataRuns) -> Finding:
    found = correlation(runs.new.current_normal, runs.new.averaged("steady"))
    words = f"correlation {found.value:+.2f} ({found.low:+.2f} to {found.high:+.2f}), none {PLANTED}"
    return judged(found.low <= 0.0 <= found.high, words)


def _weak(runs: TabataRuns) -> Finding:
    load = 0.5 * WATER.density * 1.2 * CURTAIN_DEPTH * 0.2**2 * runs.case.curtain.span
    words = f"drag of 0.2 m/s on a unit {load / 1e3:.1f} kN, steady tension of the paper up to {STEADY / 1e3:.1f} kN"
    return judged(load < 0.25 * STEADY, words)


def _cosine(runs: TabataRuns) -> Finding:
    new = runs.new
    found = fit_cosine(new.angle, new.averaged("tenth") * new.significant_period / new.significant_height)["exponent"]
    words = f"cos to the power {found.value:.2f} ({found.low:.2f} to {found.high:.2f}); 2 {PLANTED}"
    return judged(abs(found.value - 2.0) < 0.25, words)


def _near_normal(runs: TabataRuns) -> Finding:
    edges = np.radians([0.0, 25.0, 50.0, 76.0])
    _, classes = fit_by_direction(runs.new.significant_height, runs.new.averaged("tenth"), runs.new.angle, edges)
    parts = ", ".join(
        f"{math.degrees(one.low):.0f} to {math.degrees(one.high):.0f} degrees {100 * one.departure.value:+.0f} %"
        for one in classes
        if one.departure
    )
    first = classes[0].departure
    return judged(first is not None and first.low > 0.0, f"off the line through all: {parts}")


def _squared(runs: TabataRuns) -> Finding:
    top = runs.new.averaged("maximum")
    found = fit_power(runs.squared, top)["exponent"]
    words = f"T_max goes with u^2 to the power {found.value:.2f} ({found.low:.2f} to {found.high:.2f})"
    return judged(
        found.value > 0.8, words,
        "in proportion to the height, as figure 4 and the energy model have it, the tension goes with the root "
        "of u^2; the two "
        "statements of the paper exclude each other but for scatter",
    )  # fmt: skip


def _flume_line(runs: TabataRuns) -> Finding:
    fit = fit_proportional(runs.squared, runs.new.averaged("maximum"))
    return measured(
        f"{fit.factor / 1e3:.2f} kN for 1 m2/s2 through the origin in the synthetic campaign",
        "the line of the flume tests is drawn without numbers; lay your own points over the figure with --points",
    )


def _compared(runs: TabataRuns) -> Finding:
    tension, speed = runs.observed
    model = math.sqrt(CONVENTIONAL.energy_factor * CONVENTIONAL.float_mass * CONVENTIONAL.rope_stiffness) * speed
    words = (
        f"computed with 0.2 over observed by the rule of the paper: {float(np.mean(model / tension)):.2f} in the mean"
    )
    return measured(f"{words}, 0.2 {PLANTED}")


def _waves_govern(runs: TabataRuns) -> Finding:
    tenth = runs.new.averaged("tenth")
    height = correlation(effective_height(runs.new.significant_height, runs.new.angle, "paper", 1.0), tenth)
    flow = correlation(np.abs(runs.new.current_normal), tenth)
    words = f"T_1/10 is correlated with H_1/3 cos^2 by {height.value:+.2f}, with the current by {flow.value:+.2f}"
    return judged(height.low > flow.high, f"{words}, {PLANTED}")


def _design_height(runs: TabataRuns) -> Finding:
    new = _worked(replace(CONVENTIONAL, type_factor=NEW.type_factor), 60.0)
    old = _worked(replace(CONVENTIONAL, type_factor=1.0), 60.0, height=2.5)
    return judged(
        new < old,
        f"by the energy model the new type pulls in 3.06 m {new / old:.2f} of what the conventional one pulls in 2.5 m",
    )


def _seven_tenths(runs: TabataRuns) -> Finding:
    _, ratio = type_ratio(runs.conventional.averaged("maximum"), runs.new.averaged("maximum"))
    words = f"ratio {ratio.value:.3f} ({ratio.low:.3f} to {ratio.high:.3f}); {NEW.type_factor} {PLANTED}"
    return judged(abs(ratio.value - 0.7) < 0.03, words)


def _higher_steady(runs: TabataRuns) -> Finding:
    more = runs.conventional.averaged("steady") - runs.new.averaged("steady")
    return judged(bool(more.min() > 0.0), f"{more.min() / 1e3:.1f} to {more.max() / 1e3:.1f} kN more; 3 kN {PLANTED}")


def _waves(runs: TabataRuns) -> Finding:
    found = float(np.mean(runs.new.maximum_height / runs.new.significant_height))
    return judged(
        abs(found - 1.8) < 0.2, f"H_max is {found:.2f} H_1/3 in blocks of {runs.new.wave_count.mean():.0f} waves"
    )


def _tenths(runs: TabataRuns) -> Finding:
    found = float(np.mean(runs.conventional.averaged("maximum") / runs.conventional.averaged("tenth")))
    return judged(
        abs(found - 1.7) < 0.15, f"T_max is {found:.2f} T_1/10",
        "1.7 needs a tension that grows faster than the height, as it does over a pretension; the energy model "
        "of the paper is "
        "linear",
    )  # fmt: skip


def _factor(runs: TabataRuns) -> Finding:
    planted = CONVENTIONAL.energy_factor
    paper, single = runs.paper_factor(), runs.energy_factor
    ratio = float(np.mean(runs.conventional.averaged("maximum") / runs.conventional.averaged("tenth")))
    words = (
        f"the rule of the paper gives M = {paper[0]:.3f} ({paper[1]:.3f} to {paper[2]:.3f}) where {planted} was "
        f"planted; single waves give {single[0]:.3f} ({single[1]:.3f} to {single[2]:.3f})"
    )
    return judged(
        paper[1] <= planted <= paper[2] and single[1] <= planted <= single[2], words,
        f"1.7 T_1/10 represents T_max, which is {ratio:.2f} T_1/10 here: a factor {(1.7 / ratio) ** 2:.2f} in M; the "
        f"largest of many scattered pulls is set against the wave of 1.8 H_1/3: a factor "
        f"{paper[0] / planted / (1.7 / ratio) ** 2:.2f}. Where the sea scatters as the campaign does, 0.2 by that rule "
        f"is {0.2 * planted / paper[0]:.2f} by single waves",
    )  # fmt: skip


def _flume(_runs: TabataRuns) -> Finding:
    ratio = float(product_needed(FLUCTUATING, 2.0, STEADY) / product_needed(FLUCTUATING, 2.0, 0.0))
    words = (
        f"with the steady {STEADY / 1e3:.1f} kN in the rope the same {FLUCTUATING / 1e3:.1f} kN need "
        f"M = {0.2 * ratio:.2f}"
    )
    return measured(words, "the model of the paper leaves the pretension out; with it field and flume need not differ")


def _wire(runs: TabataRuns) -> Finding:
    anchors = runs.case.curtain.anchors
    assert anchors is not None
    return measured(
        f"0.6 of the rope, {0.6 * FLUCTUATING / 1e3:.1f} kN of {FLUCTUATING / 1e3:.1f} kN",
        "a factor of flume tests that are not in the paper",
    )


def _impulsive(runs: TabataRuns) -> Finding:
    none, many = runs.snaps
    words = f"{none} snaps in 20 minutes without current, {many} with 0.3 m/s, in one sea of H_1/3 = 1.2 m"
    return judged(none == 0 and many > 20, words)


def _ropes(runs: TabataRuns, rope: str) -> Array:
    """Return the highest pull of an anchor rope in each realisation [N]."""
    return np.array([one.rope for one in runs.typhoon[rope]])


def _pulls(runs: TabataRuns, rope: str) -> str:
    found = _ropes(runs, rope) / 1e3
    several = f", {len(found)} realisations {found.min():.0f} to {found.max():.0f} kN" if len(found) > 1 else ""
    return f"{found.mean():.0f} kN{several}"


def _factor_of_span(runs: TabataRuns, rope: str) -> float:
    """Return M that gives the energy model the pull of the span in the typhoon, mean of the realisations."""
    height = float(effective_height(TYPHOON, math.radians(60.0), "paper", 1.8))
    speed = CONVENTIONAL.float_speed(height, 6.75, 0.2, WATER)
    product = product_needed(float(_ropes(runs, rope).mean()) - STEADY, speed, 0.0)
    return float(product) / (CONVENTIONAL.float_mass * ROPES[rope])


def _highest(runs: TabataRuns) -> Finding:
    # the print is not clear on whether its highest value is T_max or T_1/10, of which T_max is 1.7
    most = STEADY + 1.7 * FLUCTUATING
    printed, soft = (_ropes(runs, name) for name in ROPES)
    words = (
        f"the span in the typhoon pulls an anchor rope of 890 kN/m with {_pulls(runs, '890 kN/m')}, one of 890 kN for "
        f"a strain of one with {_pulls(runs, '890 kN')}; measured {(STEADY + FLUCTUATING) / 1e3:.0f} to "
        f"{most / 1e3:.0f} kN with the steady part; over the steady part the span has the M = "
        f"{_factor_of_span(runs, '890 kN/m'):.2g} and {_factor_of_span(runs, '890 kN'):.2g} of the energy model"
    )
    return judged(
        float(printed.mean()) < most, words,
        f"a rope as stiff as printed arrests what the water gives the skirt {printed.mean() / soft.mean():.1f} times "
        f"as hard as one of {ROPES['890 kN'] / 1e3:.1f} kN/m over its 46 m. With that stiffness the least error lies "
        "at M = 9.2, and M = 1 + kappa_B has the added mass of the skirt in it; M = 0.2 would be a negative one",
    )  # fmt: skip


def _most_used(runs: TabataRuns, pulls: Sequence[Pulls]) -> tuple[float, str]:
    """Return the largest load over strength, mean of the realisations, and its part."""
    each = [one.shares(runs.case.curtain.strengths) for one in pulls]
    mean = {name: float(np.mean([shares[name] for shares in each])) for name in each[0]}
    part = max(mean, key=mean.__getitem__)
    return mean[part], part


def _stands(runs: TabataRuns) -> Finding:
    strengths = runs.case.curtain.strengths
    (share, part), (printed, other) = (_most_used(runs, runs.typhoon[name]) for name in ("890 kN", "890 kN/m"))
    return judged(
        share < 1.0,
        f"{part} used to {100.0 * share:.0f} % of its strength, anchor rope {_pulls(runs, '890 kN')}, at 60 degrees, "
        "with 890 kN taken for a strain of one: over 46 m the 890 kN/m of the print are a rope of 41 MN, many times "
        f"what a fibre rope has, and {other} would be used to {100.0 * printed:.0f} %. Strengths are not in the "
        f"paper and filled in: rope {strengths.anchor_line.capacity / 1e3:.0f} kN, anchor "
        f"{strengths.anchor.capacity / 1e3:.0f} kN, wire {strengths.upper_cable.capacity / 1e3:.0f} kN, sheet "
        f"{strengths.sheet.capacity / 1e3:.0f} kN/m",
    )


def _along(_runs: TabataRuns) -> Finding:
    model = replace(CONVENTIONAL, type_factor=1.0)
    load = [_worked(model, angle) for angle in (0.0, 60.0)]
    words = f"{load[0] / 1e3:.1f} kN in waves across, {load[1] / 1e3:.1f} kN at 60 degrees, by the energy model"
    return judged(load[1] < 0.5 * load[0], words)


def _worked(model: EnergyModel, angle: float, period: float = 7.0, height: float = 3.06) -> float:
    height = float(effective_height(height, math.radians(angle), "paper", 1.8))
    return float(model.fluctuating_tension(model.float_speed(height, period, 0.2, WATER), 0.0))


STATEMENTS = (
    Statement(
        "impulsive",
        "3 (1)",
        "Impulsive tension comes when waves act on a rope that the current has drawn taut.",
        _impulsive,
    ),
    Statement("linear", "3 (1), figure 4", "T_1/10 is nearly linear in H_1/3.", _linear),
    Statement("uncorrelated", "3 (1), figure 4", "Steady tension has nothing to do with the current.", _uncorrelated),
    Statement("weak", "3 (1)", "The current is too weak to draw the curtain taut.", _weak),
    Statement("waves-govern", "3 (1)", "Waves, not the current, govern the tension that was measured.", _waves_govern),
    Statement("near-normal", "3 (1), figure 4", "Waves near normal incidence leave the line.", _near_normal),
    Statement("cosine", "3 (1), figure 5", "Tension goes with cos^2 of the angle.", _cosine),
    Statement("squared", "3 (2), figure 6", "The largest tension is proportional to the squared velocity.", _squared),
    Statement("flume-line", "3 (2), figure 6", "The largest tensions lie near the line of flume tests.", _flume_line),
    Statement(
        "types", "3 (3), figure 7", "The new type has 0.7 of the tension of the conventional one.", _seven_tenths
    ),
    Statement("steady", "3 (1), figure 3", "The conventional type has the higher steady tension.", _higher_steady),
    Statement("waves", "2", "H_max is 1.8 H_1/3.", _waves),
    Statement("tenths", "2", "T_max is 1.7 T_1/10.", _tenths),
    Statement("factor", "4, figure 8", "M = 0.2 makes the error of the energy model least.", _factor),
    Statement("compared", "4, figure 9", "With M = 0.2 computed tensions are those measured.", _compared),
    Statement("flume", "4", "Flume tests gave M = 0.5.", _flume),
    Statement("wire", "4", "The wire has 0.6 of the strength of the anchor rope.", _wire),
    Statement(
        "highest",
        "3 (1), figure 3",
        "The fluctuating tension of an anchor rope reaches 14.7 kN, the steady one 13.7 kN.",
        _highest,
    ),
    Statement(
        "design-height",
        "3 (3)",
        "The new type survived more than the 2.5 m that the conventional one is designed for.",
        _design_height,
    ),
    Statement("stands", "3 (3), 5", "The curtain survived H_1/3 = 3.06 m.", _stands),
    Statement("along", "5", "It survived since the high waves travelled along it.", _along),
)


def filled(runs: TabataRuns) -> tuple[FilledInput, ...]:
    """Return the inputs that were filled in, with the tension of the energy model in the typhoon."""
    model = replace(CONVENTIONAL, type_factor=1.0)
    plain = f" (taken: {_worked(model, 60.0) / 1e3:.1f} kN)"
    least, squares = runs.paper_factor("least_relative_error"), runs.paper_factor("least_squares")
    return (
        FilledInput("wave period of the typhoon", "7 s", "6; 8 s",
                    f"{_worked(model, 60.0, 6.0) / 1e3:.1f}; {_worked(model, 60.0, 8.0) / 1e3:.1f} kN{plain}"),
        FilledInput("angle of the waves from the normal", "60 degrees", "45; 70 degrees",
                    f"{_worked(model, 45.0) / 1e3:.1f}; {_worked(model, 70.0) / 1e3:.1f} kN{plain}"),
        FilledInput("mass of a float and what moves with it", "518 kg, sheet and ballast of a unit", "130; 1036 kg",
                    "; ".join(f"{_worked(replace(model, float_mass=mass), 60.0) / 1e3:.1f}" for mass in (130.0, 1036.0))
                    + f" kN{plain}"),
        FilledInput("rule by which the error is least", "mean of zero", "least relative error; least squares",
                    f"M = {least[0]:.3f}; {squares[0]:.3f} (taken: {runs.paper_factor()[0]:.3f})"),
        FilledInput("fitted parameter and its data", "1.7 T_1/10 to 1.8 H_1/3 of a block, as the paper", "pull by "
            "pull to the "
                    "wave that made it", f"M = {runs.energy_factor[0]:.3f} (taken: {runs.paper_factor()[0]:.3f})"),
        *_guesses(runs),
        FilledInput("the record", "a synthetic campaign of "
                    f"{len(runs.new)} blocks, its relations planted, 15 % scatter", "other seeds",
                    "intervals are given with each number"),
    )  # fmt: skip


def rope_diameter(name: str, axial_stiffness: float) -> float:
    """Return the diameter of a rope of the catalogue with this EA [N], which goes with its square [m]."""
    one = line_type(name, 0.03)
    return one.diameter * math.sqrt(axial_stiffness / one.axial_stiffness)


def _reading(runs: TabataRuns) -> FilledInput:
    """Return what the two readings of K are as ropes, and what they do to the span."""
    anchors = runs.case.curtain.anchors
    assert anchors is not None
    length = anchors.length
    (share, part), (printed, other) = (_most_used(runs, runs.typhoon[name]) for name in ("890 kN", "890 kN/m"))
    fibre = 1e3 * rope_diameter("polyester_8_strand", length * ROPES["890 kN"])
    wire, thick = (
        1e3 * rope_diameter(name, length * ROPES["890 kN/m"]) for name in ("wire_6x19_wire_core", "polyester_8_strand")
    )
    return FilledInput(
        "what K = 890 kN/m of an anchor rope of 46 m is",
        f"the force of a strain of one, as its name in the paper (elongation) says: a polyester rope of {fibre:.0f} mm",
        f"as printed: steel wire of {wire:.0f} mm (in polyester {thick:.0f} mm)",
        f"anchor rope {_pulls(runs, '890 kN/m')}, {100.0 * printed:.0f} %, {other} (taken: {_pulls(runs, '890 kN')}, "
        f"{100.0 * share:.0f} %, {part})",
    )


def _guesses(runs: TabataRuns) -> Iterator[FilledInput]:
    """Yield how far the most used part moves with each guessed value of the span in the typhoon, one realisation."""
    yield _reading(runs)
    share, part = _most_used(runs, runs.typhoon["890 kN"][:1])
    taken = f" (taken: {100.0 * share:.0f} %, {part})"
    yield FilledInput("strengths of anchor, rope, wire and sheet", "those of the case file", "half of them",
                      f"{200.0 * share:.0f} %, {part}{taken}")  # fmt: skip
    wire = float(np.mean([one.shares(runs.case.curtain.strengths)["wire"] for one in runs.typhoon["890 kN"]]))
    yield FilledInput(
        "what loads are compared with",
        "the strength itself: whether it is sufficient",
        "a factor of safety of 3 on the wire, as in a design",
        f"wire {300.0 * wire:.0f} % (taken: {100.0 * wire:.0f} %)",
    )
    for words, pulls in runs.guessed.items():
        share, part = _most_used(runs, [pulls])
        yield FilledInput("span in the typhoon, rope of 890 kN", _TAKEN, words, f"{100.0 * share:.0f} %, {part}{taken}")
