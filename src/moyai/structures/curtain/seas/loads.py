"""What waves and an impact add to the steady loads of every component, for load table and operating limits.

Three answers to waves stand side by side: the energy model of the anchor line, the drag at the speed whose square is
the squared velocity under the crest, and slack and taut cycles. The largest of each component counts, an impact in the
current next to them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import astuple, dataclass, replace
from functools import cached_property

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.sea.water import Water
from moyai.structures.curtain.assembly import LevelCurtain
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy
from moyai.structures.curtain.impact.kernels import taut_shape
from moyai.structures.curtain.impact.skirt import BulgedSkirt
from moyai.structures.curtain.limits.utilisation import AddedLoads
from moyai.structures.curtain.seas.anchor_energy import EnergyModel
from moyai.structures.curtain.seas.squared_velocity import DirectionRule, effective_height, squared_velocity
from moyai.structures.curtain.snaps.snap_table import SnapTable
from moyai.structures.curtain.statics.hanging import CurtainStatics, tight_line

_CURVE_POINTS = 31


@dataclass(frozen=True, eq=False)
class DragCurve:
    """Loads of the curtain at rest against the speed of the water along its normal."""

    #: Root mean square over the skirt along the normal [m/s], rising from 0; up to where there is equilibrium.
    speed: Array
    #: Upper cable, lower cable [N], skirt [N/m], anchor line [N], line load [N/m]; shape (speed, 5).
    loads: Array

    def at(self, speed: float) -> AddedLoads:
        """Return the whole loads at a speed [m/s].

        Raises
        ------
        InputError
            Where the curtain has no equilibrium.
        """
        if speed > self.speed[-1]:
            raise InputError(
                f"the curtain has no equilibrium in water that moves with {speed:.3g} m/s",
                parameter="current",
                allowed=f"at most {self.speed[-1]:.3g} m/s",
            )
        return AddedLoads(*(float(value) for value in self._curve(speed)))

    @cached_property
    def _curve(self) -> Callable[[float], Array]:
        from scipy.interpolate import PchipInterpolator

        if self.speed.size == 1:
            return lambda speed: self.loads[0]
        # even steps of the square root of the speed carry both the rise with its square and the bend of a flaring skirt
        shaped = PchipInterpolator(np.sqrt(self.speed), self.loads)
        return lambda speed: np.asarray(shaped(math.sqrt(speed)))


def drag_curve(unit: LevelCurtain, highest: float) -> DragCurve:
    """Return the loads at rest up to a speed of the water along the normal [m/s], or as far as there is equilibrium."""
    speeds, rows = [0.0], [_still(unit)]
    for speed in highest * (np.arange(1, _CURVE_POINTS) / (_CURVE_POINTS - 1.0)) ** 2:
        try:
            statics = unit.facing.statics(unit.hanging, float(speed) / unit.unit_normal_speed)
        except (InputError, ConvergenceError):
            break
        speeds.append(float(speed))
        rows.append(_loads(statics))
    return DragCurve(np.array(speeds), np.array(rows))


def _still(unit: LevelCurtain) -> tuple[float, float, float, float, float]:
    skirt = unit.curtain.skirt
    return 0.0, 0.0, skirt.toe_load + max(skirt.submerged_weight, 0.0) * unit.depth, 0.0, 0.0


def _loads(statics: CurtainStatics) -> tuple[float, float, float, float, float]:
    return (
        statics.upper_tension,
        statics.lower_tension,
        statics.section.sheet_tension,
        statics.anchor_tension,
        statics.section.load,
    )


def steady_loads(statics: CurtainStatics) -> AddedLoads:
    """Return the loads of a curtain at rest."""
    return AddedLoads(*_loads(statics))


def _beyond(statics: CurtainStatics, factors: AddedLoads) -> AddedLoads:
    """Return what steady loads have at the upper end of their band beyond their value."""
    return AddedLoads(*((factor - 1.0) * load for factor, load in zip(astuple(factors), _loads(statics), strict=True)))


def increase(whole: AddedLoads, statics: CurtainStatics) -> AddedLoads:
    """Return what loads have beyond those of a curtain at rest, at least 0."""
    upper, lower, sheet, line, load = _loads(statics)
    return AddedLoads(
        max(whole.upper_cable - upper, 0.0),
        max(whole.lower_cable - lower, 0.0),
        max(whole.sheet - sheet, 0.0),
        max(whole.anchor_line - line, 0.0),
        max(whole.line_load - load, 0.0),
    )


def on_lines(more: AddedLoads, force: float, pretension: float) -> AddedLoads:
    """Return loads with what they add to the tighter of two lines that carry a force [N] from both sides already.

    Parameters
    ----------
    more : AddedLoads
        Whose ``anchor_line`` adds to the force.
    force, pretension : float
        See :func:`moyai.structures.curtain.statics.hanging.tight_line`.
    """
    line = tight_line(force + more.anchor_line, pretension) - tight_line(force, pretension)
    return replace(more, anchor_line=line)


@dataclass(frozen=True)
class ImpactLoad:
    """Loads of an impact at any start speed, in the proportions of the case."""

    #: The span.
    impact: Impact
    #: Tension of the design model over that of model A [-].
    factor: float
    #: Of the upper and of the lower cable in the sum [-].
    shares: tuple[float, float]
    #: Start speed over the speed of the water [-].
    start_ratio: float
    #: The skirt that bulges; None: its share is not known and left out.
    skirt: BulgedSkirt | None
    #: Of the anchor line [rad].
    anchor_slope: float
    #: Ends of the band of the tension over its value [-] [eq:impact-band].
    uncertainty: tuple[float, float] = (1.0, 1.0)
    #: The skirt at a speed of the water along the normal [m/s], which hangs straighter in a weaker current; None: as in
    #: that of the case.
    skirt_at: Callable[[float], BulgedSkirt | None] | None = None

    def at(self, speed: float) -> AddedLoads:
        """Return the loads when the water moves with a speed [m/s] along the normal."""
        start = self.start_ratio * speed
        if start <= 0.0:
            return AddedLoads()
        impact = replace(self.impact, speed=start)
        skirt = self.skirt if self.skirt_at is None else self.skirt_at(speed)
        return self._of(self.factor * peak_by_energy(impact).tension, skirt)

    def of_tension(self, tension: float, speed: float | None = None) -> AddedLoads:
        """Return the loads that go with a sum of the cable tensions [N]; both spans of a support act at once.

        The skirt is that of a speed of the water along the normal [m/s], or that of the case.
        """
        return self._of(tension, self.skirt if speed is None or self.skirt_at is None else self.skirt_at(speed))

    def _of(self, tension: float, skirt: BulgedSkirt | None) -> AddedLoads:
        b = taut_shape(self.impact.span_ratio)
        load = 2.0 * b * tension / self.impact.span
        return AddedLoads(
            self.shares[0] * tension,
            self.shares[1] * tension,
            0.0 if skirt is None else skirt.edge_tension(0.5 * load),
            2.0 * tension * math.tanh(b) / math.cos(self.anchor_slope),
            load,
        )


@checks_words
@dataclass(frozen=True)
class SeaLoads:
    """What a significant height in a current adds to the steady loads, by all models that the case has data for."""

    #: [s] of a significant height [m].
    period: Callable[[float], float]
    #: Of the waves from the normal [rad].
    angle: float
    #: Direction rule; one of "paper", "normal", "none".
    rule: DirectionRule
    #: H_max/H_1/3 [-].
    height_ratio: float
    #: Of the skirt [m].
    depth: float
    #: Speed of the water along the normal, root mean square over the skirt, per surface speed of the current [-].
    normal_ratio: float
    drag: DragCurve
    #: Anchor lines.
    energy: EnergyModel | None = None
    #: Steady tension that the energy model takes [N]; None: that of the statics.
    pretension: float | None = None
    #: Tension of every anchor line without a load [N], where the case gives a pretension.
    line_pretension: float = 0.0
    #: An impact in the current, without waves.
    impact: ImpactLoad | None = None
    #: Slack and taut cycles, and how their tension goes to the components.
    snaps: tuple[SnapTable, ImpactLoad] | None = None
    #: Whether snaps count at the upper end of the interval of their mean.
    judged: bool = False
    #: What the upper end of the drag coefficient makes of that end [-].
    strong_drag: float = 1.0
    #: What it makes of the drag under the crest [-].
    strong_crest: float = 1.0
    #: Whether they count at that end as other seeds may give it.
    other_seeds: bool = False
    #: Whether snaps are those of the heights that were run already: at least so much above them.
    known: bool = False
    #: Upper end of the band of the steady loads over their value [-], by component; None: at their value.
    steady_factors: AddedLoads | None = None

    def water_speed(self, significant_height: float, speed: float, water: Water) -> float:
        """Return the root of the squared velocity under the crest of the highest wave [m/s] [eq:curtain-wave-drag]."""
        current = self.normal_ratio * speed
        if significant_height <= 0.0:
            return current
        height = effective_height(significant_height, self.angle, self.rule, self.height_ratio)
        period = self.period(significant_height)
        return math.sqrt(float(squared_velocity(height, period, current, self.depth, water)))

    def waves(self, statics: CurtainStatics, significant_height: float, speed: float, water: Water) -> AddedLoads:
        """Return what drag and snaps of a significant height [m] add at a surface speed [m/s]."""
        if significant_height <= 0.0:
            return AddedLoads()
        moving, current = self.water_speed(significant_height, speed, water), self.normal_ratio * speed
        found = increase(self.drag.at(moving), statics).times(self.strong_crest if self.judged else 1.0)
        if self.snaps is not None:
            table, proportions = self.snaps
            tension = table.tension(
                speed, significant_height, judged=self.judged, known=self.known, other_seeds=self.other_seeds
            )
            tension *= self.strong_drag if self.judged else 1.0
            struck = proportions.of_tension(tension, current)
            found = found.larger(increase(struck, statics))
        return found

    def _rise(self, statics: CurtainStatics, significant_height: float, speed: float, water: Water) -> float:
        """Return what waves add to the anchor line by the energy model [N]."""
        if self.energy is None or significant_height <= 0.0:
            return 0.0
        current = self.normal_ratio * speed
        height = effective_height(significant_height, self.angle, self.rule, self.height_ratio)
        float_speed = self.energy.float_speed(height, self.period(significant_height), current, water)
        steady = statics.anchor_tension if self.pretension is None else self.pretension
        return float(self.energy.fluctuating_tension(float_speed, steady))

    def added(self, statics: CurtainStatics, significant_height: float, speed: float, water: Water) -> AddedLoads:
        """Return what waves, impact and pretension add at a surface speed [m/s], the larger for each component."""
        found = self.waves(statics, significant_height, speed, water)
        if self.impact is not None:
            found = found.larger(self.impact.at(self.normal_ratio * speed))
        force, pretension = statics.anchor_tension, self.line_pretension
        if self.steady_factors is not None:
            force *= self.steady_factors.anchor_line
        rise = self._rise(statics, significant_height, speed, water)
        line = max(tight_line(force + found.anchor_line, pretension), tight_line(force, pretension) + rise) - force
        found = replace(found, anchor_line=line)
        return found if self.steady_factors is None else found.plus(_beyond(statics, self.steady_factors))
