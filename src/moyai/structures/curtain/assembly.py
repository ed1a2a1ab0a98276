"""A curtain in the water of one level: the problem of the case file made ready for the solvers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from moyai.core.errors import InputError
from moyai.sea import current as currents
from moyai.sea.current import CurrentProfile, PowerLawCurrent, TabulatedCurrent, UniformCurrent
from moyai.sea.states import SeaState
from moyai.sea.water import Water
from moyai.structures.curtain.limits.utilisation import CurtainSite, Requirements, drowning_speed
from moyai.structures.curtain.model import UNJUDGED, Curtain, CurtainProblem
from moyai.structures.curtain.seas.drift import drift_speed
from moyai.structures.curtain.statics.hanging import CurtainStatics, HangingCurtain, pull_of_lines
from moyai.structures.curtain.statics.on_bed import LEAST_LENGTH, lies_on_bed
from moyai.structures.curtain.statics.steady_load import SteadyLoad, given_alone, steady_load

#: Speed up to which a drowning current is sought [m/s]; no tidal stream on record is faster
_FASTEST = 10.0


@dataclass(frozen=True)
class LevelCurtain:
    """A curtain at one water level."""

    #: Of the water level.
    name: str
    #: Above datum [m].
    level: float
    #: At this level.
    water: Water
    #: As the case file has it.
    curtain: Curtain
    #: For the solvers.
    hanging: HangingCurtain
    #: Water and the currents of the profile at any surface speed.
    site: CurtainSite
    #: Of the current of the case [m/s]; 0 without one.
    surface_speed: float
    #: Without band: :attr:`moyai.structures.curtain.model.Settings.nominal`.
    nominal: bool = False
    #: Of the current as strong as the drift of the waves of the case [m/s]
    #: (:mod:`moyai.structures.curtain.seas.drift`).
    drift_speed: float = 0.0

    @property
    def flow_angle(self) -> float:
        """Of the current from the normal of the span [rad]."""
        return math.remainder(self.site.flow_heading - self.curtain.normal, 2.0 * math.pi)

    @property
    def depth(self) -> float:
        """Depth that the skirt reaches when it hangs straight [m]."""
        return min(self.curtain.skirt.length, self.water.depth)

    @cached_property
    def unit_normal_speed(self) -> float:
        """Root mean square over the skirt of the normal component, per surface speed of the profile [-]."""
        square = self.site.current(1.0).depth_mean_squared(-self.depth, 0.0, self.curtain.normal)
        return math.sqrt(square)

    def slack_float_load(self, toe_factor: float = 1.0) -> float:
        """Return what the floats carry at slack water, per length [N/m], with a factor on the weight of the toe [-]."""
        skirt, floats = self.hanging.skirt, self.hanging.floats
        toe = skirt.toe_load if skirt.length < self.water.depth else 0.0
        hanging = max(skirt.submerged_weight * self.depth + toe_factor * toe, 0.0)
        return floats.weight + hanging + pull_of_lines(self.hanging, 0.0)

    def drift_in(self, seas: Sequence[SeaState]) -> float:
        """Return the current as strong as the drift of some seas on the upright skirt [m/s] [eq:curtain-wave-drift]."""
        blocked = 0.0 if math.isinf(self.water.depth) else self.depth / self.water.depth
        return drift_speed(seas, self.curtain.normal, self.depth, self.curtain.drag.coefficient(blocked), self.water)

    @property
    def normal_speed(self) -> float:
        """Mean over the skirt of the current's component along the normal [m/s]."""
        if self.surface_speed == 0.0:
            return 0.0
        mean = self.site.current(self.surface_speed).depth_mean(-self.depth, 0.0)
        return float(mean @ np.array([math.cos(self.curtain.normal), math.sin(self.curtain.normal)]))

    @cached_property
    def statics(self) -> CurtainStatics:
        """The curtain at rest in the current of the case."""
        return self.site.statics(self.hanging, self.surface_speed)

    @cached_property
    def steady(self) -> SteadyLoad:
        """The governing steady load in the current of the case, with its band."""
        current = self.site.current(self.surface_speed)
        surface = current.component(np.zeros(1), self.curtain.normal)
        along = current.depth_mean_squared(-self.depth, 0.0, self.curtain.normal + 0.5 * math.pi)
        hanging = self.hanging
        if self.nominal:
            return given_alone(hanging, self.statics)

        def solve(curtain: HangingCurtain) -> CurtainStatics:
            alike = (curtain.skirt, curtain.law, curtain.friction) == (hanging.skirt, hanging.law, hanging.friction)
            return self.site.statics(curtain, self.surface_speed, by_curve=alike)

        return steady_load(
            hanging,
            solve,
            self.water,
            toe_range=self.curtain.toe_range,
            passing_fraction=self.curtain.passing_fraction,
            surface_speed=float(surface[0]),
            along_speed=math.sqrt(along),
        )

    def turned(self, angle: float) -> CurtainSite:
        """Return the site with the current turned to an angle from the normal of the span [rad]."""
        site, by = self.site, angle - self.flow_angle
        return replace(
            site, current=lambda speed: _turned(site.current(speed), by), flow_heading=site.flow_heading + by
        )

    @cached_property
    def facing(self) -> CurtainSite:
        """The site with what of its currents goes along the normal: so the water of waves loads an oblique curtain."""
        site, normal = self.site, self.curtain.normal
        return replace(site, current=lambda speed: _across(site.current(speed), normal), flow_heading=normal)

    @cached_property
    def drowning_speed(self) -> float:
        """Surface speed that uses up the float reserve [m/s], infinite where none up to 10 m/s does."""
        return drowning_speed(self.hanging, self.site, highest=_FASTEST)

    @property
    def rests_on_bed(self) -> bool:
        """Whether part of the skirt lies on the bed in the current of the case."""
        current = self.site.current(self.surface_speed)
        return self.site.on_bed and lies_on_bed(self.hanging, current, self.site.flow_heading, self.water)

    @property
    def requirements(self) -> Requirements:
        """Strengths of the components."""
        known = self.curtain.strengths
        return Requirements(
            known.upper_cable,
            known.lower_cable,
            known.sheet,
            known.anchor_line,
            known.anchor,
            known.least_reserve,
            known.least_depth,
            known.joint if known.joint is not UNJUDGED else None,
            self.curtain.joint_distance,
        )


def assemble(problem: CurtainProblem, name: str, level: float) -> LevelCurtain:
    """Return the curtain of a problem at a water level.

    Raises
    ------
    InputError
        When the skirt is longer than the water is deep and may not lie on the bed, or an anchor line is too short.
    """
    curtain, water = problem.curtain, problem.environment.water_at(level)
    long = curtain.skirt.length > water.depth
    if long and not curtain.may_lie_on_bed:
        raise InputError(
            f"the skirt of {curtain.skirt.length:g} m is longer than the water is deep at {name}, {water.depth:g} m",
            parameter="skirt.length",
            allowed=f"at most {water.depth:g} m",
            remedy="shorten the skirt, or set 'may_lie_on_bed: true' in 'structure'",
        )
    on_bed = curtain.may_lie_on_bed and curtain.skirt.length > LEAST_LENGTH * water.depth
    anchors = curtain.anchors
    hanging = HangingCurtain(
        span=curtain.span,
        length=curtain.length,
        skirt=curtain.skirt,
        floats=curtain.floats,
        upper_stiffness=curtain.upper_stiffness,
        lower_stiffness=curtain.lower_stiffness,
        toe=curtain.toe,
        anchor_slope=0.0 if anchors is None else anchors.slope_in(water.depth),
        drag=curtain.drag,
        law=curtain.law,
        pretension=0.0 if anchors is None else anchors.pretension or 0.0,
    )
    given = problem.environment.current
    profile = currents.uniform(1.0, curtain.normal) if given is None else given.in_depth(water.depth)
    depth = min(curtain.skirt.length, water.depth)
    reference = _reference_speed(profile, depth)
    heading = _heading(profile, depth, curtain.normal)

    def family(speed: float) -> CurrentProfile:
        return scaled_current(profile, speed / reference)

    unit = LevelCurtain(
        name=name,
        level=level,
        water=water,
        curtain=curtain,
        hanging=hanging,
        site=CurtainSite(water, family, heading, curtain.normal, curtain.passing_fraction, on_bed=on_bed),
        surface_speed=0.0 if given is None else reference,
        nominal=problem.settings.nominal,
    )
    return replace(unit, drift_speed=unit.drift_in(problem.environment.sea_states))


def scaled_current(profile: CurrentProfile, factor: float) -> CurrentProfile:
    """Return a current with all its speeds times a factor."""
    if isinstance(profile, UniformCurrent):
        return replace(profile, current_speed=factor * profile.current_speed)
    if isinstance(profile, PowerLawCurrent):
        return replace(profile, surface_speed=factor * profile.surface_speed)
    if isinstance(profile, TabulatedCurrent):
        return replace(profile, components=factor * profile.components)
    raise TypeError(f"a current of kind {type(profile).__name__} cannot be scaled")


def _across(profile: CurrentProfile, normal: float) -> CurrentProfile:
    """Return the part of a current along a heading."""
    if isinstance(profile, TabulatedCurrent):
        direction = np.array([math.cos(normal), math.sin(normal)])
        return replace(profile, components=np.outer(profile.components @ direction, direction))
    if isinstance(profile, UniformCurrent):
        share = math.cos(profile.heading - normal)
        return replace(profile, current_speed=share * profile.current_speed, heading=normal)
    if isinstance(profile, PowerLawCurrent):
        share = math.cos(profile.heading - normal)
        return replace(profile, surface_speed=share * profile.surface_speed, heading=normal)
    raise TypeError(f"a current of kind {type(profile).__name__} has no part along a heading")


def _turned(profile: CurrentProfile, by: float) -> CurrentProfile:
    """Return a current turned by an angle [rad]."""
    if isinstance(profile, TabulatedCurrent):
        c, s = math.cos(by), math.sin(by)
        return replace(profile, components=profile.components @ np.array([[c, s], [-s, c]]))
    if isinstance(profile, UniformCurrent | PowerLawCurrent):
        return replace(profile, heading=profile.heading + by)
    raise TypeError(f"a current of kind {type(profile).__name__} cannot be turned")


def _reference_speed(profile: CurrentProfile, depth: float) -> float:
    """Return the surface speed, or the largest over the skirt where the surface stands still."""
    surface = float(profile.speed(0.0))
    largest = float(np.max(profile.speed(np.linspace(-depth, 0.0, 101))))
    speed = surface if surface > 1e-3 * largest else largest
    if speed <= 0.0:
        raise InputError(
            "the current is zero over the depth of the skirt",
            parameter="current",
            remedy="give its speed, or leave 'current' out",
        )
    return speed


def _heading(profile: CurrentProfile, depth: float, otherwise: float) -> float:
    """Return the heading of the mean flow over the skirt [rad]."""
    mean = profile.depth_mean(-depth, 0.0)
    return math.atan2(mean[1], mean[0]) if float(np.hypot(*mean)) > 0.0 else otherwise
