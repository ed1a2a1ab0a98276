"""How far a curtain holds: utilisation of each component, largest current, largest wave in a current, spacings.

Everything is found on the same statics that a user sees: the whole range is scanned, then each crossing closed in
(:mod:`moyai.structures.curtain.limits.search`); a state that has no solution counts as beyond the limit. What waves
and an impact add comes from a :class:`WaveLoading`: the energy model of Tabata et al. alone (:class:`WaveLoad`), or
with the drag of the waves and the impact (:mod:`moyai.structures.curtain.seas.loads`).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass, field, replace
from typing import Protocol

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.sea.breaking import breaking_limit
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water
from moyai.structures.curtain.limits.search import Limit, search
from moyai.structures.curtain.seas.anchor_energy import EnergyModel
from moyai.structures.curtain.seas.squared_velocity import DirectionRule, effective_height
from moyai.structures.curtain.statics.hanging import (
    CurtainStatics,
    HangingCurtain,
    loaded_section,
    solve_statics,
    tight_line,
)
from moyai.structures.curtain.statics.on_bed import solve_on_bed
from moyai.structures.curtain.statics.plan import PlanLoad
from moyai.structures.curtain.statics.section import SectionShape
from moyai.structures.curtain.statics.steady_load import SteadyState, with_floats

#: Share of the range that stands for nothing at all where a state at 0 does not exist [-]
_LEAST = 1e-4


@dataclass(frozen=True)
class Strength:
    """What a component carries, and the safety factor asked of it."""

    #: Breaking load [N], of the sheet per width [N/m]; infinite where it is not judged.
    capacity: float
    #: [-].
    safety_factor: float

    def __post_init__(self) -> None:
        if not (self.capacity > 0.0 and self.safety_factor >= 1.0 and math.isfinite(self.safety_factor)):
            raise InputError(
                f"capacity {self.capacity:g} with safety factor {self.safety_factor:g}",
                parameter="strength",
                allowed="capacity greater than 0, factor at least 1",
            )

    def utilisation(self, load: float) -> float:
        """Return load times safety factor over capacity [-]."""
        return load * self.safety_factor / self.capacity


@dataclass(frozen=True)
class Requirements:
    """Strengths of the components and what the curtain must keep."""

    #: Of the upper cable [N].
    upper_cable: Strength
    #: Of the lower cable [N].
    lower_cable: Strength
    #: Of the sheet [N/m].
    sheet: Strength
    #: Of the anchor line [N].
    anchor_line: Strength
    #: Horizontal holding force of the anchor [N].
    anchor: Strength
    #: Share of the buoyancy that must be left [-].
    least_reserve: float
    #: Effective depth that must be kept [m].
    least_depth: float
    #: Connection of the curtain units [N], which hands on what its unit collects; left out, joints are not judged.
    joint: Strength | None = None
    #: Length of a unit [m].
    joint_distance: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.least_reserve < 1.0 or not self.least_depth >= 0.0:
            raise InputError(
                f"least reserve {self.least_reserve:g}, least depth {self.least_depth:g} m",
                parameter="requirements",
                allowed="reserve from 0 to below 1, depth at least 0",
            )


@dataclass(frozen=True)
class AddedLoads:
    """What waves or an impact add to the steady loads."""

    #: Tension of the upper cable [N].
    upper_cable: float = 0.0
    #: Tension of the lower cable [N].
    lower_cable: float = 0.0
    #: Tension of the skirt per width [N/m].
    sheet: float = 0.0
    #: Tension of the anchor line [N].
    anchor_line: float = 0.0
    #: Load per length of curtain [N/m], which the joints hand on.
    line_load: float = 0.0

    def larger(self, other: AddedLoads) -> AddedLoads:
        """Return the larger load of each component: wave and impact do not act at one instant."""
        return AddedLoads(
            max(self.upper_cable, other.upper_cable),
            max(self.lower_cable, other.lower_cable),
            max(self.sheet, other.sheet),
            max(self.anchor_line, other.anchor_line),
            max(self.line_load, other.line_load),
        )

    def times(self, factor: float) -> AddedLoads:
        """Return the loads times a factor [-]."""
        return AddedLoads(*(factor * load for load in astuple(self)))

    def plus(self, other: AddedLoads) -> AddedLoads:
        """Return the sum of the loads of each component."""
        return AddedLoads(*map(sum, zip(astuple(self), astuple(other), strict=True)))


def utilisation(
    state: SteadyState, required: Requirements, wave_tension: float, *added: AddedLoads
) -> dict[str, float]:
    """Return the utilisation of each component, 1 at its limit.

    Parameters
    ----------
    state : SteadyState
        Steady loads, with the drag of the floats where they have one.
    required : Requirements
        Strengths.
    wave_tension : float
        Fluctuating tension of the anchor line [N].
    *added : AddedLoads
        Of waves and impact; of each component the largest counts.

    Notes
    -----
    Floats are judged by their steady reserve: what dips for an instant comes up again [eq:curtain-governing].
    """
    more = AddedLoads(anchor_line=wave_tension)
    for loads in added:
        more = more.larger(loads)
    at = state.quantity
    slope = math.cos(state.statics.curtain.anchor_slope)
    upper, lower = at("upper_tension") + more.upper_cable, at("lower_tension") + more.lower_cable
    parts = {
        "upper cable": required.upper_cable.utilisation(upper),
        "lower cable": required.lower_cable.utilisation(lower),
        "sheet": required.sheet.utilisation(at("sheet_tension") + more.sheet),
        "anchor line": required.anchor_line.utilisation(at("anchor_tension") + more.anchor_line),
        "anchor": required.anchor.utilisation(at("anchor_horizontal_tension") + more.anchor_line * slope),
        "floats": (1.0 - at("float_reserve_ratio")) / (1.0 - required.least_reserve),
        "effective depth": required.least_depth / at("effective_depth"),
    }
    if required.joint is not None:
        # a joint lies in the load line, which carries no more than its tension [eq:curtain-joint-load]
        load = min((at("line_load") + more.line_load) * required.joint_distance, upper + lower)
        parts["joint"] = required.joint.utilisation(load)
    return parts


@checks_words
@dataclass(frozen=True)
class CurtainSite:
    """Where the curtain hangs, with a family of currents.

    Notes
    -----
    What was solved is kept in ``solved`` and ``loaded``; both are empty again in a site that :func:`replace` makes.
    """

    #: Depth and density.
    water: Water
    #: Profile of a given surface speed [m/s].
    current: Callable[[float], CurrentProfile]
    #: Heading of the flow [rad].
    flow_heading: float
    #: Heading of the downstream normal of the span [rad].
    chord_normal: float
    #: Share of the held flow that goes under the toe [-].
    passing_fraction: float
    #: Whether the skirt may lie on the bed (:mod:`moyai.structures.curtain.statics.on_bed`).
    on_bed: bool = False
    solved: dict[tuple[HangingCurtain, float], CurtainStatics] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )
    loaded: dict[tuple[object, ...], tuple[SectionShape, PlanLoad]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def statics(self, curtain: HangingCurtain, speed: float, *, by_curve: bool = True) -> CurtainStatics:
        """Return the curtain at rest at a surface speed [m/s]; solved once, its sections once for all spans.

        Without ``by_curve`` the sections are solved one by one, which is less work for a skirt in a single current.
        """
        key = (curtain, speed)
        if key not in self.solved:
            current, headings = self.current(speed), (self.flow_heading, self.chord_normal)
            passing = self.passing_fraction
            if self.on_bed:
                self.solved[key] = solve_on_bed(curtain, current, *headings, self.water, passing_fraction=passing)
            else:
                alike = (curtain.skirt, curtain.drag, curtain.law, curtain.toe, curtain.friction, speed)
                if alike not in self.loaded:
                    self.loaded[alike] = loaded_section(curtain, current, *headings, self.water, by_curve=by_curve)
                self.solved[key] = solve_statics(
                    curtain, current, *headings, self.water, passing_fraction=passing, loaded=self.loaded[alike]
                )
        return self.solved[key]

    def with_floats(self, statics: CurtainStatics, speed: float) -> SteadyState:
        """Return a state at a surface speed [m/s] with the drag of its floats."""
        surface = self.current(speed).component(np.zeros(1), self.chord_normal)
        return with_floats(statics, self.water, float(surface[0]))


class WaveLoading(Protocol):
    """What waves of a height, in a current, add to the steady loads."""

    @property
    def height_ratio(self) -> float:
        """H_max / H_1/3 [-]."""

    @property
    def period(self) -> Callable[[float], float]:
        """Period [s] of a significant height [m]."""

    def added(self, statics: CurtainStatics, significant_height: float, speed: float, water: Water) -> AddedLoads:
        """Return the loads that a significant height [m] adds at a surface speed [m/s]."""


@checks_words
@dataclass(frozen=True)
class WaveLoad:
    """Wave part of the anchor load."""

    #: With M, m_B, K.
    model: EnergyModel
    #: Period [s] of a significant height [m].
    period: Callable[[float], float]
    #: Of the waves from the normal of the curtain [rad].
    angle: float
    #: Direction rule; one of "paper", "normal", "none".
    rule: DirectionRule
    #: H_max / H_1/3 [-].
    height_ratio: float

    def tension(self, significant_height: float, speed: float, pretension: float, water: Water) -> float:
        """Return the fluctuating tension of the anchor line [N] in a current [m/s] along the load."""
        if significant_height <= 0.0:
            return 0.0
        height = effective_height(significant_height, self.angle, self.rule, self.height_ratio)
        float_speed = self.model.float_speed(height, self.period(significant_height), speed, water)
        return float(self.model.fluctuating_tension(float_speed, pretension))

    def added(self, statics: CurtainStatics, significant_height: float, speed: float, water: Water) -> AddedLoads:
        """Return the loads that a significant height [m] adds: those of the anchor line."""
        rise = self.tension(significant_height, speed, statics.anchor_tension, water)
        return AddedLoads(anchor_line=rise)


def _worst(parts: dict[str, float]) -> tuple[float, str]:
    name = max(parts, key=lambda key: parts[key])
    return parts[name], name


def speed_limit(
    curtain: HangingCurtain,
    site: CurtainSite,
    required: Requirements,
    *,
    highest: float,
    wave_tension: float = 0.0,
    waves: WaveLoading | None = None,
    solved: dict[float, CurtainStatics | None] | None = None,
) -> Limit:
    """Return the largest surface speed [m/s] that every component carries, with what sets it.

    Parameters
    ----------
    curtain, site, required
        What hangs where and must carry what.
    highest : float
        Speed up to which the limit is sought [m/s].
    wave_tension : float
        Fluctuating tension of the anchor line that acts along with it [N].
    waves : WaveLoading, optional
        What is added in the current alone, for instance an impact.
    solved : dict, optional
        Statics by speed that are already known; filled, so that a second search need not solve them again.
    """
    known: dict[float, CurtainStatics | None] = {} if solved is None else solved

    def at(speed: float) -> CurtainStatics:
        if speed not in known:
            try:
                known[speed] = site.statics(curtain, speed)
            except (InputError, ConvergenceError):
                known[speed] = None
        statics = known[speed]
        if statics is None:
            raise InputError(f"no equilibrium in {speed:g} m/s", parameter="current")
        return statics

    def worst(speed: float) -> tuple[float, str]:
        try:
            statics = at(speed)
            more = () if waves is None else (waves.added(statics, 0.0, speed, site.water),)
        except (InputError, ConvergenceError):
            return math.inf, "no equilibrium"
        return _worst(utilisation(site.with_floats(statics, speed), required, wave_tension, *more))

    return search(worst, highest, start=_LEAST * highest)


def drowning_speed(curtain: HangingCurtain, site: CurtainSite, *, highest: float) -> float:
    """Return the surface speed [m/s] at which the float reserve is used up, infinite when not below ``highest``.

    The drag of the floats counts: it loads the anchor lines, which pull the floats down.

    Raises
    ------
    InputError
        When the floats do not even carry the curtain in still water.
    """
    if curtain.net_weight >= curtain.floats.buoyancy:
        raise InputError(
            f"floats of {curtain.floats.buoyancy:g} N/m under {curtain.net_weight:g} N/m",
            parameter="floats.buoyancy",
            allowed=f"more than {curtain.net_weight:g} N/m",
            remedy="give larger floats or a lighter toe",
        )

    def worst(speed: float) -> tuple[float, str]:
        try:
            return 1.0 - site.with_floats(site.statics(curtain, speed), speed).quantity("float_reserve_ratio"), "floats"
        except (InputError, ConvergenceError):
            return math.inf, "no equilibrium"

    limit = search(worst, highest, start=_LEAST * highest, first_only=True)
    return limit.value if limit.reached else math.inf


def height_limit(
    curtain: HangingCurtain,
    site: CurtainSite,
    required: Requirements,
    waves: WaveLoading,
    *,
    speed: float,
    highest: float,
    first_only: bool = False,
) -> Limit:
    """Return the largest significant height [m] that every component carries in a current.

    Parameters
    ----------
    curtain, site, required, waves
        What hangs where, must carry what, and how waves load it.
    speed : float
        Surface speed of the current [m/s].
    highest : float
        Height up to which the limit is sought [m]; the highest wave, ratio times H, may not break.
    first_only : bool
        End at the first height that is too much, for loads that never fall with the height and take time.
    """
    try:
        statics = site.statics(curtain, speed)
    except (InputError, ConvergenceError):
        return Limit(0.0, "no equilibrium", (), highest, math.inf)
    state = site.with_floats(statics, speed)

    def worst(height: float) -> tuple[float, str]:
        if height > 0.0 and waves.height_ratio * height > breaking_limit(waves.period(height), site.water).height:
            return math.inf, "breaking"
        try:
            more = waves.added(statics, height, speed, site.water)
        except (InputError, ConvergenceError):
            return math.inf, "no equilibrium"
        return _worst(utilisation(state, required, 0.0, more))

    return search(worst, highest, first_only=first_only)


def operating_limits(
    curtain: HangingCurtain,
    site: CurtainSite,
    required: Requirements,
    waves: WaveLoading,
    *,
    speeds: Sequence[float],
    highest: float,
    progress: Progress = silent,
) -> tuple[tuple[float, Limit], ...]:
    """Return the operating-limit table: for each surface speed [m/s] the largest significant height and what sets it.

    Other arguments as :func:`height_limit`. Interrupted by the listener it returns the rows that are there.
    """
    table: list[tuple[float, Limit]] = []
    try:
        for count, speed in enumerate(speeds):
            progress("operating limits", count, len(speeds))
            table.append((speed, height_limit(curtain, site, required, waves, speed=speed, highest=highest)))
        progress("operating limits", len(speeds), len(speeds))
    except KeyboardInterrupt:
        # what is there is handed back; the caller sees that rows are missing
        pass
    return tuple(table)


#: Components whose load grows with the distance of the anchors; the others are the same at any distance
_BY_SPAN = ("upper cable", "lower cable", "anchor line", "anchor")


def anchor_spacing(
    curtain: HangingCurtain,
    site: CurtainSite,
    required: Requirements,
    *,
    speed: float,
    longest: float,
    wave_tension: float,
    load_factor: float = 1.0,
) -> Limit:
    """Return the largest distance of the anchors [m] at the same ratio of span to length, with what sets it.

    Only what grows with the distance is judged: cables, anchor lines, anchors. Effective depth, floats, sheet and
    joints are the same at any distance, and :func:`fixed_failures` names those that fail.

    Parameters
    ----------
    curtain, site, required
        What hangs where and must carry what; anchors at each support.
    speed : float
        Surface speed [m/s].
    longest : float
        Distance up to which the limit is sought [m].
    wave_tension : float
        Fluctuating tension of the anchor line [N].
    load_factor : float
        Upper end of the steady load over its value [-].
    """
    ratio = curtain.length / curtain.span

    def worst(span: float) -> tuple[float, str]:
        try:
            statics = site.statics(replace(curtain, span=span, length=ratio * span), speed)
        except (InputError, ConvergenceError):
            return math.inf, "no equilibrium"
        force = statics.anchor_tension
        held = tight_line(force, curtain.pretension) - force
        parts = utilisation(SteadyState("", statics), required, held + wave_tension)
        return _worst({name: load_factor * parts[name] for name in _BY_SPAN})

    return search(worst, longest, start=0.01 * longest)


def fixed_failures(statics: CurtainStatics, required: Requirements) -> tuple[str, ...]:
    """Return the components that fail at any distance of the anchors, by the steady load alone."""
    parts = utilisation(SteadyState("", statics), required, 0.0)
    return tuple(name for name, value in parts.items() if name not in _BY_SPAN and value > 1.0)


def joint_spacing(tension_per_length: float, joint: Strength, longest: float = math.inf) -> float:
    """Return the largest distance of the joints [m] between curtain units [eq:curtain-joint-spacing].

    Each joint of the top load line hands on what its unit collects.

    Parameters
    ----------
    tension_per_length : float
        Load of the current per length of curtain [N/m], the section's load.
    joint : Strength
        Of the connection [N].
    longest : float
        Distance up to which it is of interest [m]; beyond it the distance is infinite: the joints set no limit.
    """
    if not tension_per_length > 0.0:
        raise InputError(f"load is {tension_per_length:g} N/m", parameter="load", allowed="greater than 0")
    found = joint.capacity / (joint.safety_factor * tension_per_length)
    return found if found <= longest else math.inf
