"""A hanging curtain at rest: section, plan, cables and anchors, floats, flow under the toe, submerged state."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any, Literal

import numpy as np

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import DragLaw, under_toe_flow
from moyai.structures.curtain.statics.plan import PlanLoad, PlanShape, section_load, solve_plan
from moyai.structures.curtain.statics.section import LoadLaw, SectionShape, SectionStart, Skirt, solve_section
from moyai.structures.curtain.statics.section_curve import section_family


@dataclass(frozen=True)
class FloatLine:
    """Floats, top cable and fittings per length of curtain."""

    #: Upward force of the wholly submerged floats, before their weight [N/m].
    buoyancy: float
    #: Of floats, top cable and fittings in air [N/m].
    weight: float
    #: Upward force that is left when the floats are flooded (float-and-sink type) [N/m]; equal to ``buoyancy`` for
    #: floats that cannot be flooded.
    flooded_buoyancy: float

    def __post_init__(self) -> None:
        if not 0.0 <= self.flooded_buoyancy <= self.buoyancy < math.inf or not 0.0 <= self.weight < math.inf:
            raise InputError(
                f"buoyancy {self.buoyancy:g}, flooded {self.flooded_buoyancy:g}, weight {self.weight:g} N/m",
                parameter="floats",
                allowed="0 <= flooded <= buoyancy, weight at least 0",
            )


@checks_words
@dataclass(frozen=True)
class HangingCurtain:
    """One span of a curtain between two anchored supports, its neighbours alike."""

    #: Distance of the supports [m].
    span: float
    #: Unstretched length of curtain between the supports [m].
    length: float
    #: Section.
    skirt: Skirt
    #: What carries it.
    floats: FloatLine
    #: EA of the cables at the top [N].
    upper_stiffness: float
    #: EA of the cables at the toe [N]; counts only for a held toe.
    lower_stiffness: float
    #: Whether a lower cable as long as the upper one keeps the toe under the top.
    toe: Literal["free", "held"]
    #: Angle of the anchor lines from the horizontal at the float [rad]; straight taut lines are assumed.
    anchor_slope: float
    #: Coefficient with range and blockage.
    drag: DragLaw
    #: Load law of the section; one of "normal_velocity", "uniform_normal", "free_streamline".
    law: LoadLaw
    #: Coefficient of the load along the sheet, both faces together [-].
    friction: float = 0.0
    #: Tension of every anchor line without a load [N].
    pretension: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.anchor_slope < 0.5 * math.pi:
            raise InputError(
                f"anchor slope is {math.degrees(self.anchor_slope):.4g} degrees",
                parameter="anchor_slope",
                allowed="0 to 90",
            )

    @property
    def axial_stiffness(self) -> float:
        """EA of the cables that carry the load [N]."""
        return self.upper_stiffness + (self.lower_stiffness if self.toe == "held" else 0.0)

    @property
    def net_weight(self) -> float:
        """Submerged weight of skirt and toe plus the weight of the float line [N/m]."""
        return self.skirt.toe_load + self.skirt.submerged_weight * self.skirt.length + self.floats.weight


@dataclass(frozen=True, eq=False)
class CurtainStatics:
    """A curtain at rest in a current."""

    #: What was solved.
    curtain: HangingCurtain
    #: Where the curtain faces the current most: at the middle of the span in a current along its normal.
    section: SectionShape
    #: Of the curtain's normal at that section [rad].
    section_heading: float
    #: Between the supports.
    plan: PlanShape
    #: Clearance between toe and bed [m].
    toe_gap: float
    #: Mean speed under the toe [m/s], what flows along the curtain included; NaN in infinite depth.
    toe_speed: float
    #: Over that of the undisturbed current there [-]; NaN in infinite depth, or where nothing flows there.
    toe_speed_ratio: float
    #: Tension of the upper cable [N].
    upper_tension: float
    #: Tension of the lower cable [N].
    lower_tension: float
    #: Horizontal force on the anchor of an inner support, with an equal span on its other side [N].
    anchor_horizontal_tension: float
    #: Horizontal force on the more loaded support of a lone span [N].
    end_anchor_horizontal_tension: float
    #: Of a straight line at the given slope that carries ``anchor_horizontal_tension`` [N].
    anchor_tension: float
    #: Buoyancy left per length after weight, pull of the skirt and of the inner anchor lines [N/m]; negative drowns.
    float_reserve: float

    @property
    def reserve_ratio(self) -> float:
        """Float reserve over buoyancy [-]."""
        return self.float_reserve / self.curtain.floats.buoyancy


@checks_words
def solve_statics(
    curtain: HangingCurtain,
    current: CurrentProfile,
    flow_heading: float,
    chord_normal: float,
    water: Water,
    *,
    passing_fraction: float,
    top_depth: float = 0.0,
    below_bed: bool = False,
    loaded: tuple[SectionShape, PlanLoad] | None = None,
) -> CurtainStatics:
    """Return shape and forces of a curtain at rest.

    Parameters
    ----------
    curtain : HangingCurtain
        Span, skirt, floats, cables.
    current : CurrentProfile
        Undisturbed.
    flow_heading, chord_normal : float
        Heading of the flow and of the downstream normal of the span [rad], less than 90 degrees apart.
    water : Water
        Site.
    passing_fraction : float
        Share of the flow held up that goes under the toe [-], 1 from bank to bank.
    top_depth : float
        Depth of the top [m]; more than 0 for a curtain held under water.
    below_bed : bool
        As :func:`moyai.structures.curtain.statics.section.solve_section`: for a long skirt whose toe the current lifts.
    loaded : tuple of SectionShape and PlanLoad, optional
        Of :func:`loaded_section` with the same arguments, where they are known: no span changes them.

    Raises
    ------
    InputError
        As the solvers of section and plan; and without any load, when there is no plan shape.
    """
    section, load = loaded or loaded_section(
        curtain, current, flow_heading, chord_normal, water, top_depth=top_depth, below_bed=below_bed
    )
    plan = solve_plan(curtain.span, curtain.length, curtain.axial_stiffness, load)
    local = plan.angle + load.flow_angle
    turn = float(np.clip(0.0, local.min(), local.max()))
    if turn != 0.0:
        # no part of the span lies across so oblique a current
        settings = _settings(curtain, top_depth, below_bed)
        section = solve_section(curtain.skirt, current, flow_heading - turn, water, curtain.drag, **settings)
    gap, under, ratio = water.depth - section.toe_depth, math.nan, math.nan
    if gap <= 0.0:
        gap, under = 0.0, 0.0
    elif math.isfinite(gap):
        under, ratio = under_toe_flow(current, chord_normal, section.toe_depth, water, passing_fraction)
    toe = (gap, under, ratio)
    return supported(curtain, section, flow_heading - turn, plan, toe, lower_share=section.toe_hold / section.load)


def tight_line(force: float, pretension: float) -> float:
    """Return the tension of the tighter of two alike lines that hold a support from both sides [N].

    While neither is slack the one gains half of the force and the other loses it; beyond twice the pretension the one
    carries all of it [eq:curtain-pretension].

    Parameters
    ----------
    force : float
        Along the lines [N].
    pretension : float
        Tension of each line without a force [N]; 0 for a line on one side.
    """
    return max(force, pretension + 0.5 * force)


def pull_of_lines(curtain: HangingCurtain, anchor_horizontal_tension: float) -> float:
    """Return the downward pull of the anchor lines on the floats [N/m] by the force of the current on an anchor [N].

    Lines with a pretension pull with twice that until one of them is slack.
    """
    along = max(anchor_horizontal_tension / math.cos(curtain.anchor_slope), 2.0 * curtain.pretension)
    return along * math.sin(curtain.anchor_slope) / curtain.span


def supported(
    curtain: HangingCurtain,
    section: SectionShape,
    section_heading: float,
    plan: PlanShape,
    toe: tuple[float, float, float],
    *,
    lower_share: float,
) -> CurtainStatics:
    """Return the statics of a section and a plan with the forces of supports and floats.

    Supports: [eq:curtain-anchor]; floats: [eq:curtain-float-reserve].

    Parameters
    ----------
    curtain : HangingCurtain
        Its floats and anchor lines.
    section, section_heading
        Section, and heading of the flow across it [rad].
    plan : PlanShape
        Of the load that the cables carry.
    toe : tuple of float
        Gap under the toe [m], speed in it [m/s], that over the undisturbed one [-].
    lower_share : float
        Share of the tension that the lower cable carries [-].
    """
    first, second = plan.downstream_end_forces
    lean = abs(plan.inward_end_forces[0] - plan.inward_end_forces[1])
    inner = math.hypot(first + second, lean)
    lone = max(math.hypot(down, along) for down, along in zip((first, second), plan.inward_end_forces))
    down_pull = section.top_pull + pull_of_lines(curtain, inner)
    return CurtainStatics(
        curtain=curtain,
        section=section,
        section_heading=section_heading,
        plan=plan,
        toe_gap=toe[0],
        toe_speed=toe[1],
        toe_speed_ratio=toe[2],
        upper_tension=plan.tension * (1.0 - lower_share),
        lower_tension=plan.tension * lower_share,
        anchor_horizontal_tension=inner,
        end_anchor_horizontal_tension=lone,
        anchor_tension=inner / math.cos(curtain.anchor_slope),
        float_reserve=curtain.floats.buoyancy - curtain.floats.weight - down_pull,
    )


@checks_words
def loaded_section(
    curtain: HangingCurtain,
    current: CurrentProfile,
    flow_heading: float,
    chord_normal: float,
    water: Water,
    *,
    top_depth: float = 0.0,
    below_bed: bool = False,
    by_curve: bool = True,
) -> tuple[SectionShape, PlanLoad]:
    """Return the section across the flow and the load of sections at every angle to it, whatever the span is.

    Arguments and errors as :func:`solve_statics`, and ``by_curve`` as
    :func:`moyai.structures.curtain.statics.plan.section_load`.
    """
    settings = _settings(curtain, top_depth, below_bed)
    near = _start(curtain, current, flow_heading, water, top_depth) if by_curve else None
    section = solve_section(curtain.skirt, current, flow_heading, water, curtain.drag, near=near, **settings)
    if section.load <= 0.0:
        raise InputError(
            f"the current loads the curtain with {section.load:g} N/m along its heading",
            parameter="current",
            remedy="give a current, and the heading in which it flows",
        )
    load = section_load(
        curtain.skirt, current, flow_heading, chord_normal, water, curtain.drag, by_curve=by_curve, **settings
    )
    return section, load


def _start(
    curtain: HangingCurtain, current: CurrentProfile, heading: float, water: Water, top_depth: float
) -> SectionStart | None:
    """Return where the search for a section begins by the curve of such sections, None where there is none."""
    family = section_family(
        curtain.skirt, current, water.depth, water.density, curtain.drag,
        law=curtain.law, toe=curtain.toe, top_depth=top_depth, friction=curtain.friction,
    )  # fmt: skip
    return None if family is None else family.start(heading)


def _settings(curtain: HangingCurtain, top_depth: float, below_bed: bool) -> dict[str, Any]:
    return {
        "law": curtain.law,
        "toe": curtain.toe,
        "top_depth": top_depth,
        "below_bed": below_bed,
        "friction": curtain.friction,
    }


def drag_range(
    curtain: HangingCurtain,
    current: CurrentProfile,
    flow_heading: float,
    chord_normal: float,
    water: Water,
    *,
    passing_fraction: float,
) -> tuple[CurtainStatics, CurtainStatics, CurtainStatics]:
    """Return the statics with the drag at the low end, as given, and at the high end of its range.

    Arguments as :func:`solve_statics`.
    """
    laws = (curtain.drag.scaled(curtain.drag.range[0]), curtain.drag, curtain.drag.scaled(curtain.drag.range[1]))
    low, middle, high = (
        solve_statics(
            replace(curtain, drag=law), current, flow_heading, chord_normal, water, passing_fraction=passing_fraction
        )
        for law in laws
    )
    return low, middle, high


@dataclass(frozen=True)
class SubmergedState:
    """A float-and-sink curtain with flooded floats."""

    #: Force towards the bed per length [N/m]; negative when the flooded curtain still floats.
    net_weight: float
    #: Whether it goes to the bed by itself.
    sinks: bool
    #: Volume of air per length that lifts it again [m3/m], without suction of the bed.
    air_to_surface: float
    #: Upward force per length of buoys or legs that hold it off the bed [N/m].
    holding_buoyancy: float


def submerged_state(curtain: HangingCurtain, water: Water) -> SubmergedState:
    """Return whether the curtain sinks with flooded floats, and what lifts it again [eq:curtain-submerged].

    In still water; a curtain held at a depth is solved by :func:`solve_statics` with ``top_depth``.
    """
    net = curtain.net_weight - curtain.floats.flooded_buoyancy
    down = max(net, 0.0)
    return SubmergedState(net, net > 0.0, down / (water.density * water.gravity), down)
