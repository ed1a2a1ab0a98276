"""A curtain that is longer than the water is deep and may lie on the bed.

What is assumed. Where the current lifts the toe clear of the bed the whole skirt hangs, and nothing is assumed. Else
the part that hangs is as long as it takes to reach the bed, its lower end stays under the top, held there by the bed
(friction of the part that lies), and the toe pulls it straight with its full weight. The bed takes its share of the
current's load, the cables the rest; no water passes under the toe.
"""

from __future__ import annotations

import math
from dataclasses import replace

from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water
from moyai.structures.curtain.statics.hanging import CurtainStatics, HangingCurtain, solve_statics, supported
from moyai.structures.curtain.statics.plan import PlanLoad, section_load, solve_plan
from moyai.structures.curtain.statics.section import SectionShape, SectionStart, Skirt, solve_section

#: A skirt shorter than this part of the water depth is not looked at: no sheet stretches by so much.
LEAST_LENGTH = 0.95


def lies_on_bed(curtain: HangingCurtain, current: CurrentProfile, flow_heading: float, water: Water) -> bool:
    """Return whether the toe of a skirt that is as long as the water is deep, or stretches to it, rests on the bed."""
    if curtain.skirt.length <= LEAST_LENGTH * water.depth:
        return False
    free = solve_section(
        curtain.skirt, current, flow_heading, water, curtain.drag, law=curtain.law, toe=curtain.toe, below_bed=True
    )
    return free.toe_depth >= water.depth


def solve_on_bed(
    curtain: HangingCurtain,
    current: CurrentProfile,
    flow_heading: float,
    chord_normal: float,
    water: Water,
    *,
    passing_fraction: float,
) -> CurtainStatics:
    """Return shape and forces of a curtain that may lie on the bed [eq:curtain-on-bed].

    Arguments and errors as :func:`moyai.structures.curtain.statics.hanging.solve_statics`.

    Notes
    -----
    ``section.skirt.length`` of the result is what hangs; the rest lies on the bed.
    """
    if not lies_on_bed(curtain, current, flow_heading, water):
        return _lifted(curtain, current, flow_heading, chord_normal, water, passing_fraction)
    hanging, section = _hanging_part(curtain, current, flow_heading, water)
    # what hangs is another skirt in every current: its curve would serve this one alone
    load = section_load(
        hanging, current, flow_heading, chord_normal, water, curtain.drag,
        law=curtain.law, toe="held", below_bed=True, by_curve=False,
    )  # fmt: skip
    # the bed keeps its share wherever the curtain stands in the flow
    share = section.top_load / section.load
    carried = PlanLoad(load.across * share, load.flow_angle, load.angle, load.ratio)
    plan = solve_plan(curtain.span, curtain.length, curtain.upper_stiffness, carried)
    return supported(curtain, section, flow_heading, plan, (0.0, 0.0, math.nan), lower_share=0.0)


def _lifted(
    curtain: HangingCurtain,
    current: CurrentProfile,
    flow_heading: float,
    chord_normal: float,
    water: Water,
    passing_fraction: float,
) -> CurtainStatics:
    return solve_statics(
        curtain, current, flow_heading, chord_normal, water, passing_fraction=passing_fraction, below_bed=True
    )


def _hanging_part(
    curtain: HangingCurtain, current: CurrentProfile, flow_heading: float, water: Water
) -> tuple[Skirt, SectionShape]:
    """Return the part of the skirt that hangs between top and bed, its lower end held under the top."""

    from scipy.optimize import brentq

    near: SectionStart | None = None

    def reach(length: float) -> SectionShape:
        nonlocal near
        part = replace(curtain.skirt, length=length)
        found = solve_section(
            part, current, flow_heading, water, curtain.drag, law=curtain.law, toe="held", below_bed=True, near=near
        )
        near = found.start
        return found

    # the held part bulges, so it takes more skirt than the water is deep, or less where it stretches
    low, high = 0.5 * water.depth, curtain.skirt.length
    whole = reach(high)
    if whole.toe_depth <= water.depth:
        return whole.skirt, whole
    if reach(low).toe_depth < water.depth:
        low = float(brentq(lambda length: reach(length).toe_depth - water.depth, low, high, xtol=1e-12 * water.depth))
    found = reach(low)
    return found.skirt, found


def check_on_bed(statics: CurtainStatics, water: Water) -> tuple[Notice, ...]:
    """Tell what was assumed of a skirt that lies on the bed, and what friction that takes."""
    laid = statics.curtain.skirt.length - statics.section.skirt.length
    if statics.toe_gap > 0.0:
        return ()
    hold, weight = statics.section.toe_hold, statics.curtain.skirt.toe_load
    friction = hold / weight
    return (
        Notice(
            "curtain-on-bed",
            f"{laid:.3g} m of the skirt lie on the bed: assumed are a toe that stays under the top, held by the bed "
            f"with {spoken(hold, 'N/m')}, and no flow under it",
            laid,
            0.0,
            "information",
            "",
            "assumption for a skirt longer than the water is deep",
        ),
        *(
            (
                Notice(
                    "curtain-bed-friction",
                    f"the bed must hold {friction:.2g} of the toe's weight by friction; a chain on sand holds about "
                    "half, so the toe would slide",
                    friction,
                    0.5,
                    "warning",
                    "give more toe weight, or anchor the toe",
                    "friction of chain on sand, about 0.5 to 0.7",
                ),
            )
            if friction > 0.5
            else ()
        ),
    )
