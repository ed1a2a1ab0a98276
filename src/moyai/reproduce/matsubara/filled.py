"""What the paper leaves out, and how far motions and tensions move with it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from moyai.morison.net_laws.matsubara import Matsubara
from moyai.reproduce.inputs import run_problem
from moyai.reproduce.matsubara.runs import GRAM, HEIGHT, SHORE, TAUT_PERIOD, MatsubaraRuns, read, shortened
from moyai.reproduce.model import FilledInput
from moyai.structures.cage.rigid.model import RigidCageProblem, RigidCageWaves, RigidLinePlan


def _words(case: RigidCageProblem) -> str:
    result = run_problem("cage", shortened(case, RigidCageWaves("one", (HEIGHT,), (TAUT_PERIOD,))))
    (wave,) = read(result, "one")
    return (
        f"sway {wave.ratio('sway'):.2f} H, heave {wave.ratio('heave'):.2f} H, {wave.turn:.1f} deg, "
        f"{wave.peak[SHORE] / GRAM:.0f} gf"
    )


def _lines(case: RigidCageProblem, **changed: Any) -> RigidCageProblem:
    def change(plan: RigidLinePlan) -> RigidLinePlan:
        values = dict(changed)
        if "anchor_x" in values:
            values["anchor_x"] = math.copysign(values["anchor_x"], plan.anchor_x)
        return replace(plan, **values)

    return replace(case, plans=tuple(change(plan) for plan in case.plans))


def filled(runs: MatsubaraRuns) -> tuple[FilledInput, ...]:
    """Return the inputs that were filled in, with their effect on the taut cage at T = 1.1 s, H = 3 cm."""
    case = runs.case
    plain = f" (taken: {_words(case)})"
    outward = replace(
        case,
        plans=tuple(
            replace(plan, attachment=(plan.attachment[0], -plan.attachment[1]), anchor_x=-1.5 * plan.anchor_x)
            for plan in case.plans
        ),
    )
    return (
        FilledInput("anchors", "30 cm from the middle, lines crossed from the top "
                               "corners", "35 cm; outward from the bottom "
                    "corners to 45 cm", f"{_words(_lines(case, anchor_x=0.35))}; {_words(outward)}{plain}"),
        FilledInput("pull of the taut lines", "cage drawn down by 11 mm", "10; 12 mm",
                    f"{_words(_lines(case, value=0.010))}; {_words(_lines(case, value=0.012))}{plain}"),
        FilledInput("stiffness of wire and gauge", "2 kN/m", "1; 10 kN/m",
                    f"{_words(_lines(case, stiffness=1e3))}; {_words(_lines(case, stiffness=1e4))}{plain}"),
        FilledInput("drag along the net", "a quarter of that across", "none",
                    f"{_words(replace(case, cage=replace(case.cage, law=Matsubara(tangential_share=0.0))))}"
                    f"{plain}"),
        FilledInput("periods and heights of the records", "T = 1.1 s taut, 1.2 s slack, H = 3 cm", "1.0 to 2.5 s",
                    "; ".join(f"slack {wave.ratio('sway'):.2f} H and {wave.turn:.1f} deg at {wave.period:g} s"
                              for wave in runs.slack)),
    )  # fmt: skip
