"""Section of a curtain at rest in a current that varies with depth: weight, toe load, stretch, free or held toe.

The skirt is followed upwards from the toe by its force vector; the height of the toe is found such that the top comes
out where it is held, and for a held toe the force of the lower cable such that the toe hangs under the top. The closed
forms of :mod:`moyai.structures.curtain.statics.load_laws` and :mod:`moyai.structures.curtain.statics.closed_forms` are
special cases and its tests.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import DragLaw, sample_pressure
from moyai.structures.curtain.statics.section_kernels import hang, hang_held

LoadLaw = Literal["normal_velocity", "uniform_normal", "free_streamline"]
LAW_CODES: dict[LoadLaw, float] = {"normal_velocity": 0.0, "uniform_normal": 1.0, "free_streamline": 2.0}
"""Of the laws in the kernel."""

_SAMPLES = 4001
#: Stretch below the bed over the depth of the water, of a skirt that is cut to that depth and stands on it [-].
_TOUCHES = 1e-3


@dataclass(frozen=True)
class Skirt:
    """The sheet of a curtain per length of span."""

    #: Unstretched, from the top load line to the toe [m].
    length: float
    #: Per area of sheet in water [N/m2]; may be negative (buoyant film).
    submerged_weight: float
    #: Submerged weight of chain, ballast and lower cable per span [N/m].
    toe_load: float
    #: Modulus times thickness per span [N/m]; infinite for a sheet that does not stretch.
    stiffness: float

    def __post_init__(self) -> None:
        for name in ("length", "toe_load"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} is {value:g}", parameter=f"skirt.{name}", allowed="greater than 0, finite")
        if not math.isfinite(self.submerged_weight):
            raise InputError("weight of the sheet is no number", parameter="skirt.submerged_weight", allowed="finite")
        if not self.stiffness > 0.0:
            raise InputError(
                f"stiffness is {self.stiffness:g} N/m",
                parameter="skirt.stiffness",
                allowed="greater than 0",
                remedy="give modulus times thickness, or infinite for a sheet that does not stretch",
            )
        if self.toe_load + self.submerged_weight * self.length <= 0.0:
            raise InputError(
                f"the skirt floats: its sheet lifts {-self.submerged_weight * self.length:g} N/m, its toe holds "
                f"{self.toe_load:g} N/m",
                parameter="skirt.toe_load",
                remedy="give more toe weight",
            )


@dataclass(frozen=True, eq=False)
class SectionShape:
    """A section at rest; arrays run from the top to the toe."""

    #: What hangs.
    skirt: Skirt
    #: Unstretched length of skirt from the top [m].
    arc: Array
    #: Downstream of the top [m].
    x: Array
    #: Height above still water [m].
    z: Array
    #: Along the skirt per span [N/m].
    tension: Array
    #: Of the skirt from the vertical [rad], positive where it leads downstream.
    angle: Array
    #: Horizontal force per span of the current on the top [N/m].
    top_load: float
    #: Horizontal force per span of the current on the lower cable [N/m]; 0 for a free toe.
    toe_hold: float
    #: Vertical force per span by which the skirt pulls its floats down [N/m].
    top_pull: float
    #: Drag coefficient in use [-].
    drag_coefficient: float
    #: Blockage in use [-]; none in infinite depth.
    blockage: float
    #: Miss of the top over the length [-].
    residual: float
    #: Hold of the toe over that of a straight sheet [-], NaN for a free toe.
    hold_share: float = math.nan

    @property
    def effective_depth(self) -> float:
        """Vertical reach from top to toe [m]."""
        return float(self.z[0] - self.z[-1])

    @property
    def flare(self) -> float:
        """Downstream reach of the toe [m]."""
        return float(self.x[-1])

    @property
    def toe_depth(self) -> float:
        """Depth of the toe below still water [m]."""
        return float(-self.z[-1])

    @property
    def load(self) -> float:
        """Horizontal force per span of the current on the whole section [N/m]."""
        return self.top_load + self.toe_hold

    @property
    def start(self) -> SectionStart:
        """Where the search for a section in a current nearby begins."""
        return SectionStart(float(self.z[-1]), self.hold_share)

    @property
    def sheet_tension(self) -> float:
        """Largest tension of the sheet per span [N/m]."""
        return float(np.max(self.tension))


@dataclass(frozen=True)
class Pressure:
    """rho/2 u|u| on an even grid of heights, for the kernels."""

    #: Lowest height of the grid [m].
    low: float
    #: Step of the grid [m].
    step: float
    #: [N/m2].
    values: Array


@dataclass(frozen=True)
class SectionStart:
    """Where the search for a section begins; the solution is the same to its tolerance."""

    #: Height of the toe [m].
    toe_height: float
    #: Hold of the toe over that of a straight sheet [-], NaN where it is not known.
    hold_share: float = math.nan
    #: Of this current on this skirt, where it has been sampled before.
    pressure: Pressure | None = None


def sampled(
    skirt: Skirt, current: CurrentProfile, heading: float, water_depth: float, density: float, top_depth: float
) -> Pressure:
    """Return the pressure of a current along a heading [rad] on all heights that a skirt can reach."""
    most = skirt.toe_load + max(skirt.submerged_weight, 0.0) * skirt.length
    low = max(-water_depth, -top_depth - skirt.length * (1.0 + 2.0 * most / skirt.stiffness))
    z = np.linspace(low, -top_depth, _SAMPLES)
    values = sample_pressure(current, heading, z, density)
    return Pressure(low, float(z[1] - z[0]), np.ascontiguousarray(values))


def _nodes(skirt: Skirt, largest: float) -> Array:
    """Return unstretched lengths from the toe: steps follow the bend, whose radius grows from W/q at the toe.

    Under the load of the normal velocity the slope grows as s q/W, so even steps of arsinh(s q/W) turn evenly.
    """
    bend = max(largest * skirt.length / skirt.toe_load, 1e-3)
    turn = math.asinh(bend)
    count = 70 * (3 + math.ceil(turn))
    nodes = np.sinh(np.linspace(0.0, turn, count + 1)) * (skirt.length / bend)
    nodes[-1] = skirt.length
    return nodes


class HangingSkirt:
    """One skirt in one current: solutions for any drag coefficient and hold.

    Parameters
    ----------
    skirt : Skirt
    pressure : Pressure
    law : LoadLaw
    top_depth : float
        [m].
    friction : float
        [-].
    start : SectionStart, optional
    """

    def __init__(
        self,
        skirt: Skirt,
        pressure: Pressure,
        law: LoadLaw,
        top_depth: float,
        friction: float,
        start: SectionStart | None = None,
    ) -> None:
        self.skirt, self.top, self.pressure, self.friction = skirt, -top_depth, pressure, friction
        #: Hold of the toe over that of a straight sheet, as guessed and then as found.
        self.share = start.hold_share if start is not None else math.nan
        self.law = LAW_CODES[law]
        self.largest = float(np.max(np.abs(self.pressure.values)))
        #: Height of the toe found last, NaN before; rise of the lean with the hold, at first of a toe load alone.
        self.toe, self._slope = start.toe_height if start is not None else math.nan, skirt.length / skirt.toe_load
        self._turned = np.full((2, 2), math.nan)

    def nodes(self, drag: float) -> Array:
        """Return the steps of a solution, from the toe."""
        return _nodes(self.skirt, drag * self.largest)

    @cached_property
    def straight(self) -> float:
        """Hold that a straight sheet needs by moments about its top, per drag coefficient [N/m]."""
        z = np.linspace(self.top - self.skirt.length, self.top, 200)
        values = np.interp(z, self.pressure.low + self.pressure.step * np.arange(_SAMPLES), self.pressure.values)
        return float(np.mean(values * (self.top - z)))

    def _arguments(self, drag: float, hold: float) -> tuple[float, tuple[Any, ...], Array]:
        """Return how far the toe can reach, what the kernels take, and the path that they fill."""
        skirt, pressure = self.skirt, self.pressure
        data = np.array([drag, skirt.submerged_weight, 1.0 / skirt.stiffness, self.law, self.friction])
        nodes = self.nodes(drag)
        path = np.empty((nodes.size, 4))
        most = math.hypot(
            skirt.toe_load + abs(skirt.submerged_weight) * skirt.length,
            abs(hold) + drag * self.largest * skirt.length * 2.0,
        )
        reach = skirt.length * (1.0 + 1.5 * most / skirt.stiffness) * (1.0 + 1e-9)
        return reach, (skirt.toe_load, nodes, pressure.low, pressure.step, pressure.values, data, path), path

    def free(self, drag: float, hold: float = 0.0) -> tuple[Array, float]:
        """Return the path (n+1, 4) from the toe up and the miss of the top [m]."""
        reach, arguments, path = self._arguments(drag, hold)
        miss = hang(self.top, reach, hold, *arguments, self.toe)
        self.toe = float(path[0, 1]) if math.isfinite(miss) else math.nan
        return path, miss

    def held(self, drag: float) -> tuple[Array, float, float]:
        """Return path, miss and hold of a skirt whose toe hangs under its top [eq:curtain-section-held]."""
        limit = 2.0 * drag * self.largest * self.skirt.length
        if limit == 0.0:
            return *self.free(drag, 0.0), 0.0
        # too far from the hold of a straight sheet the sheet may have no shape at all
        straight = drag * self.straight
        quick = self._held_by_steps(drag, straight)
        if quick is not None:
            return quick
        found: list[tuple[Array, float]] = []

        def lean(hold: float) -> float:
            found[:] = [self.free(drag, hold)]
            path, miss = found[0]
            # the top lies at path[-1, 0] from the toe: upstream of it (negative) while the hold is too small
            return float(path[-1, 0]) if math.isfinite(miss) else math.copysign(math.inf, hold - straight)

        start = straight * self.share if math.isfinite(self.share) else straight
        low, high = straight - limit, straight + limit
        start = min(max(start, low), high)
        hold, slope = _crossing(lean, low, high, start, self._slope, 1e-12 * self.skirt.length, 1e-14 * limit)
        path, miss = found[0]
        if math.isfinite(miss) and slope > 0.0:
            self._slope = slope
            self.share = hold / straight if straight != 0.0 else math.nan
        return path, miss, hold

    def _held_by_steps(self, drag: float, straight: float) -> tuple[Array, float, float] | None:
        """Return what :meth:`held` does by Newton's steps, None where they do not arrive."""
        skirt = self.skirt
        share = self.share if math.isfinite(self.share) else 1.0
        reach, arguments, path = self._arguments(drag, straight * share)
        toe = self.toe if math.isfinite(self.toe) else self.top - skirt.length
        start = np.array([max(toe, self.top - reach * (1.0 - 1e-12)), straight * share / skirt.toe_load])
        miss = hang_held(start, self._turned, self.top, reach, *arguments)
        if math.isnan(miss):
            self._turned = np.full((2, 2), math.nan)
            return None
        hold = float(start[1]) * skirt.toe_load
        self.toe, self.share = float(start[0]), hold / straight if straight != 0.0 else math.nan
        return path, miss, hold


def overturned(path: Array, miss: float) -> bool:
    """Return whether a path has no end, or turns over."""
    return math.isnan(miss) or bool(np.max(np.abs(_angle(path))) >= math.pi)


def _angle(path: Array) -> Array:
    """Return the angle of a path from the vertical [rad], from the toe up."""
    if np.min(path[:, 3]) > 0.0:
        return np.arctan(-path[:, 2] / path[:, 3])
    return np.unwrap(np.arctan2(-path[:, 2], path[:, 3]))


def _crossing(
    value: Callable[[float], float],
    low: float,
    high: float,
    start: float,
    slope: float,
    tolerance: float,
    width: float,
) -> tuple[float, float]:
    """Return where a rising function crosses zero and its slope there, by secants that a bracket keeps safe.

    Parameters
    ----------
    value : callable
        May be infinite where no more than its sign is known. Its last call is the one whose place is returned.
    low, high : float
        Ends of the bracket.
    start, slope : float
        First place, and slope there, NaN where not known.
    tolerance, width : float
        Value, and width of bracket or step, at which the search ends.
    """
    place, last, known = start, math.nan, math.nan
    wide, since = high - low, 0
    for _ in range(100):
        found = value(place)
        low, high = (low, place) if found > 0.0 else (place, high)
        if not math.isnan(known) and math.isfinite(found - known) and place != last:
            slope = (found - known) / (place - last)
        if abs(found) <= tolerance or high - low <= width:
            break
        last, known = place, found
        then = place - found / slope if slope > 0.0 and math.isfinite(found) else math.nan
        if abs(then - place) <= width:
            break
        since += 1
        if high - low <= 0.5 * wide:
            wide, since = high - low, 0
        # secants that come from one side leave the bracket wide: they are quick or they are cut short
        place = then if low < then < high and since < 6 else 0.5 * (low + high)
        if since >= 6:
            since = 0
    return place, slope


@checks_words
def solve_section(
    skirt: Skirt,
    current: CurrentProfile,
    heading: float,
    water: Water,
    drag: DragLaw,
    *,
    law: LoadLaw = "normal_velocity",
    toe: Literal["free", "held"] = "free",
    top_depth: float = 0.0,
    below_bed: bool = False,
    friction: float = 0.0,
    near: SectionStart | None = None,
) -> SectionShape:
    """Return the section of a hanging skirt at rest in a current.

    Parameters
    ----------
    skirt : Skirt
        Length, weight, toe load, stiffness.
    current : CurrentProfile
        Undisturbed current.
    heading : float
        Normal of the curtain [rad]; the component along it loads the skirt.
    water : Water
        Depth and density.
    drag : DragLaw
        Coefficient on the undisturbed speed, with the blockage of the deflected skirt.
    law : {"normal_velocity", "uniform_normal", "free_streamline"}
        Load normal to the sheet: from the velocity normal to it (cos^2), full everywhere, or that of an oblique
        plate in separated flow [eq:curtain-free-streamline], in closed form without the weight of the sheet
        [eq:curtain-free-streamline-shape].
    toe : {"free", "held"}
        Whether the toe swings, or a lower cable as long as the upper one keeps it under the top.
    top_depth : float
        Depth of the top below still water [m]: 0 afloat, more in the submerged (float-and-sink) state.
    below_bed : bool
        Let the toe hang below the bed, as if the current went on there: to find how much of a long skirt hangs free
        (:mod:`moyai.structures.curtain.statics.on_bed`).
    friction : float
        Coefficient of the load along the sheet from the velocity along it, both faces together [-]; 0 leaves it out.
    near : SectionStart, optional
        From a current nearby, where the search starts; the solution is the same to its tolerance.

    Raises
    ------
    InputError
        When the skirt is longer than the water is deep below its top, or the load overturns it.
    ConvergenceError
        When the top is missed by more than 1e-9 of the length.

    Notes
    -----
    Equilibrium [eq:curtain-section]; load of the current [eq:curtain-drag], friction [eq:curtain-friction].
    """
    room = water.depth - top_depth
    if top_depth < 0.0 or (skirt.length > room and not below_bed):
        raise InputError(
            f"a skirt of {skirt.length:g} m from {top_depth:g} m below the surface in water of {water.depth:g} m",
            parameter="skirt.length",
            allowed=f"at most {room:g} m",
            remedy="shorten the skirt, or let it lie on the bed",
        )
    pressure = near.pressure if near is not None else None
    if pressure is None:
        pressure = sampled(skirt, current, heading, water.depth, water.density, top_depth)
    problem = HangingSkirt(skirt, pressure, law, top_depth, friction, near)

    def solve(coefficient: float) -> tuple[Array, float, float]:
        if toe == "held":
            return problem.held(coefficient)
        return *problem.free(coefficient), 0.0

    finite = math.isfinite(water.depth)
    low, high = 0.0, skirt.length / water.depth if finite else 0.0
    if finite and len(drag.blockage) > 1:
        # a deeper curtain is loaded more and reaches less deep: one crossing
        found: list[tuple[float, Array, float, float]] = []

        def surplus(blockage: float) -> float:
            coefficient = drag.coefficient(blockage)
            path, miss, hold = solve(coefficient)
            found[:] = [(coefficient, path, miss, hold)]
            return blockage - ((path[-1, 1] - path[0, 1]) / water.depth if math.isfinite(miss) else 0.0)

        if near is not None and math.isfinite(near.toe_height):
            reached = (-top_depth - near.toe_height) / water.depth
        else:
            reached = high - surplus(high)
            reached = reached if math.isfinite(found[0][2]) else 0.5 * high
        _crossing(surplus, low, high, min(max(reached, low), high), 1.0, 1e-13, 1e-13)
        coefficient, path, miss, hold = found[0]
    else:
        coefficient = drag.coefficient(high)
        path, miss, hold = solve(coefficient)
    down = path[::-1]
    if overturned(path, miss):
        ratio = coefficient * problem.largest * skirt.length / skirt.toe_load
        raise InputError(
            f"the current overturns the skirt (load ratio qL/W = {ratio:.3g})",
            parameter="skirt.toe_load",
            remedy="give more toe weight, or the load law of the normal velocity",
        )
    if abs(miss) > 1e-9 * skirt.length:
        raise ConvergenceError(
            f"the top of the skirt is missed by {abs(miss):.3g} m",
            parameter="skirt",
            remedy="check the load ratio qL/W",
        )
    if path[0, 1] < -(1.0 + _TOUCHES) * water.depth and not below_bed:
        raise InputError(
            f"the skirt stretches {-path[0, 1] - water.depth:.3g} m deeper than the water of {water.depth:g} m",
            parameter="skirt.stiffness",
            remedy="shorten or stiffen the skirt",
        )
    depth = float(down[0, 1] - down[-1, 1])
    return SectionShape(
        skirt=skirt,
        arc=skirt.length - problem.nodes(coefficient)[::-1],
        x=down[:, 0] - down[0, 0],
        z=down[:, 1].copy(),
        tension=np.hypot(down[:, 2], down[:, 3]),
        angle=_angle(path)[::-1],
        top_load=float(-down[0, 2]),
        toe_hold=float(hold),
        top_pull=float(down[0, 3]),
        drag_coefficient=coefficient,
        blockage=depth / water.depth if finite else 0.0,
        residual=abs(miss) / skirt.length,
        hold_share=problem.share if toe == "held" else math.nan,
    )
