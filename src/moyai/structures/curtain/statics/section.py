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
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.compiled import njit
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.options import checks_words
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import DragLaw, sample_pressure

LoadLaw = Literal["normal_velocity", "uniform_normal", "free_streamline"]
LAW_CODES: dict[LoadLaw, float] = {"normal_velocity": 0.0, "uniform_normal": 1.0, "free_streamline": 2.0}
"""Of the laws in the kernel."""

_SAMPLES = 4001


@njit(cache=True, error_model="numpy")
def _pressure_at(z: float, low: float, step: float, pressure: Array) -> float:
    place = (z - low) / step
    if place <= 0.0:
        return pressure[0]
    i = int(place)
    if i >= pressure.size - 1:
        return pressure[pressure.size - 1]
    part = place - i
    return pressure[i] * (1.0 - part) + pressure[i + 1] * part


@njit(cache=True, error_model="numpy")
def _slopes(state: Array, out: Array, low: float, step: float, pressure: Array, data: Array) -> None:
    """Derivatives of x, z, F_x, F_z along the unstretched skirt, upwards [eq:curtain-section]."""
    scale, weight, flexibility, law, friction = data[0], data[1], data[2], data[3], data[4]
    tension = math.sqrt(state[2] ** 2 + state[3] ** 2)
    tx, tz = state[2] / tension, state[3] / tension
    stretch = 1.0 + tension * flexibility
    head = _pressure_at(state[1], low, step, pressure) * stretch
    load = scale * head
    if law == 0.0:
        load *= tz * abs(tz)
    elif law == 2.0:
        load *= (4.0 + math.pi) * tz / (4.0 + math.pi * abs(tz))
    drag = friction * head * tx * abs(tx)
    out[0] = stretch * tx
    out[1] = stretch * tz
    out[2] = -load * tz - drag * tx
    out[3] = weight + load * tx - drag * tz


@njit(cache=True, error_model="numpy")
def _climb(
    toe_height: float,
    hold: float,
    toe_load: float,
    nodes: Array,
    low: float,
    step: float,
    pressure: Array,
    data: Array,
    path: Array,
) -> None:
    """Follow the skirt from the toe at x = 0 to its top by Runge and Kutta's fourth order; fills ``path`` (n+1, 4)."""
    count = path.shape[0] - 1
    k1, k2, k3, k4, trial = np.empty(4), np.empty(4), np.empty(4), np.empty(4), np.empty(4)
    path[0, 0], path[0, 1], path[0, 2], path[0, 3] = 0.0, toe_height, hold, toe_load
    for i in range(count):
        h = nodes[i + 1] - nodes[i]
        state = path[i]
        _slopes(state, k1, low, step, pressure, data)
        for j in range(4):
            trial[j] = state[j] + 0.5 * h * k1[j]
        _slopes(trial, k2, low, step, pressure, data)
        for j in range(4):
            trial[j] = state[j] + 0.5 * h * k2[j]
        _slopes(trial, k3, low, step, pressure, data)
        for j in range(4):
            trial[j] = state[j] + h * k3[j]
        _slopes(trial, k4, low, step, pressure, data)
        for j in range(4):
            path[i + 1, j] = state[j] + h / 6.0 * (k1[j] + 2.0 * k2[j] + 2.0 * k3[j] + k4[j])


@njit(cache=True, error_model="numpy")
def _hang(
    top_height: float,
    reach: float,
    hold: float,
    toe_load: float,
    nodes: Array,
    low: float,
    step: float,
    pressure: Array,
    data: Array,
    path: Array,
    guess: float,
) -> float:
    """Find the height of the toe whose skirt ends at ``top_height``; returns the miss [m], NaN without a solution.

    ``guess`` is the height in a load nearby, or NaN.
    """
    a, b = top_height - reach, top_height
    length = nodes[nodes.size - 1]
    if a < guess < b:
        # secants from nearby take a third of the climbs; what they do not find is left to the bracket
        c, last, old = guess, math.nan, math.nan
        for _ in range(8):
            _climb(c, hold, toe_load, nodes, low, step, pressure, data, path)
            f = path[-1, 1] - top_height
            if abs(f) <= 1e-13 * length:
                return f
            # the top moves with the toe where nothing else is known
            move = -f if math.isnan(old) else -f * (c - last) / (f - old)
            last, old = c, f
            c += move
            if not a < c < b:
                break
    _climb(a, hold, toe_load, nodes, low, step, pressure, data, path)
    fa = path[-1, 1] - top_height
    _climb(b, hold, toe_load, nodes, low, step, pressure, data, path)
    fb = path[-1, 1] - top_height
    if not (fa <= 0.0 <= fb):
        return math.nan
    side = 0
    f = fb
    for _ in range(200):
        c = (fa * b - fb * a) / (fa - fb)
        if not a < c < b:
            c = 0.5 * (a + b)
        _climb(c, hold, toe_load, nodes, low, step, pressure, data, path)
        f = path[-1, 1] - top_height
        if abs(f) <= 1e-13 * length or b - a <= 1e-15 * length:
            break
        # Illinois: an end that stays twice loses half of its weight
        if f > 0.0:
            b, fb = c, f
            if side == 1:
                fa *= 0.5
            side = 1
        else:
            a, fa = c, f
            if side == -1:
                fb *= 0.5
            side = -1
    return f


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
    #: ``x``, ``z``: Downstream of the top and height above still water [m].
    x: Array
    #: ``x``, ``z``: Downstream of the top and height above still water [m].
    z: Array
    #: Along the skirt per span [N/m].
    tension: Array
    #: Of the skirt from the vertical [rad], positive where it leads downstream.
    angle: Array
    #: ``top_load``, ``toe_hold``: Horizontal force per span of the current on the top and on the lower cable [N/m]; the
    #: latter 0 for a free toe.
    top_load: float
    #: ``top_load``, ``toe_hold``: Horizontal force per span of the current on the top and on the lower cable [N/m]; the
    #: latter 0 for a free toe.
    toe_hold: float
    #: Vertical force per span by which the skirt pulls its floats down [N/m].
    top_pull: float
    #: ``drag_coefficient``, ``blockage``: In use [-]; no blockage in infinite depth.
    drag_coefficient: float
    #: ``drag_coefficient``, ``blockage``: In use [-]; no blockage in infinite depth.
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
    def sheet_tension(self) -> float:
        """Largest tension of the sheet per span [N/m]."""
        return float(np.max(self.tension))


@dataclass(frozen=True)
class _Pressure:
    """rho/2 u|u| on an even grid of heights, for the kernel."""

    low: float
    step: float
    values: Array


def _sample(current: CurrentProfile, heading: float, low: float, high: float, density: float) -> _Pressure:
    z = np.linspace(low, high, _SAMPLES)
    values = sample_pressure(current, heading, z, density)
    return _Pressure(low, float(z[1] - z[0]), np.ascontiguousarray(values))


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


class _Problem:
    """One skirt in one current: solutions for any drag coefficient and hold."""

    def __init__(
        self,
        skirt: Skirt,
        current: CurrentProfile,
        heading: float,
        water: Water,
        law: LoadLaw,
        top_depth: float,
        friction: float,
        share: float = math.nan,
    ) -> None:
        self.skirt, self.top, self.friction = skirt, -top_depth, friction
        #: Hold of the toe over that of a straight sheet, as guessed and then as found.
        self.share = share
        self.law = LAW_CODES[law]
        most = skirt.toe_load + max(skirt.submerged_weight, 0.0) * skirt.length
        low = max(-water.depth, self.top - skirt.length * (1.0 + 2.0 * most / skirt.stiffness))
        self.pressure = _sample(current, heading, low, self.top, water.density)
        self.largest = float(np.max(np.abs(self.pressure.values)))
        #: Height of the toe found last, NaN before; rise of the lean with the hold, at first of a toe load alone.
        self._toe, self._slope = math.nan, skirt.length / skirt.toe_load

    def nodes(self, drag: float) -> Array:
        """Return the steps of a solution, from the toe."""
        return _nodes(self.skirt, drag * self.largest)

    def solve(self, drag: float, hold: float) -> tuple[Array, float]:
        """Return the path (n+1, 4) from the toe up and the miss of the top [m]."""
        skirt, pressure = self.skirt, self.pressure
        data = np.array([drag, skirt.submerged_weight, 1.0 / skirt.stiffness, self.law, self.friction])
        nodes = self.nodes(drag)
        path = np.empty((nodes.size, 4))
        most = math.hypot(
            skirt.toe_load + abs(skirt.submerged_weight) * skirt.length,
            abs(hold) + drag * self.largest * skirt.length * 2.0,
        )
        reach = skirt.length * (1.0 + 1.5 * most / skirt.stiffness) * (1.0 + 1e-9)
        miss = _hang(
            self.top,
            reach,
            hold,
            skirt.toe_load,
            nodes,
            pressure.low,
            pressure.step,
            pressure.values,
            data,
            path,
            self._toe,
        )
        self._toe = float(path[0, 1]) if math.isfinite(miss) else math.nan
        return path, miss

    def held(self, drag: float) -> tuple[Array, float, float]:
        """Return path, miss and hold of a skirt whose toe hangs under its top [eq:curtain-section-held]."""
        limit = 2.0 * drag * self.largest * self.skirt.length
        if limit == 0.0:
            return *self.solve(drag, 0.0), 0.0
        # a straight sheet needs this much by moments about its top; too far from it the sheet may have no shape at all
        z = np.linspace(self.top - self.skirt.length, self.top, 200)
        values = np.interp(z, self.pressure.low + self.pressure.step * np.arange(_SAMPLES), self.pressure.values)
        straight = drag * float(np.mean(values * (self.top - z)))
        found: list[tuple[Array, float]] = []

        def lean(hold: float) -> float:
            found[:] = [self.solve(drag, hold)]
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
    near: SectionShape | None = None,
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
    near : SectionShape, optional
        The same skirt in a current nearby, from which the search starts; the solution is the same to its tolerance.

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
    share = near.hold_share if near is not None else math.nan
    problem = _Problem(skirt, current, heading, water, law, top_depth, friction, share)

    def solve(coefficient: float) -> tuple[Array, float, float]:
        if toe == "held":
            return problem.held(coefficient)
        path, miss = problem.solve(coefficient, 0.0)
        return path, miss, 0.0

    finite = math.isfinite(water.depth)
    low, high = 0.0, skirt.length / water.depth if finite else 0.0
    coefficient = drag.coefficient(high)
    path, miss, hold = solve(coefficient)
    if finite and len(drag.blockage) > 1:
        # a deeper curtain is loaded more and reaches less deep: one crossing
        found: list[tuple[float, Array, float, float]] = []

        def surplus(blockage: float) -> float:
            coefficient = drag.coefficient(blockage)
            path, miss, hold = solve(coefficient)
            found[:] = [(coefficient, path, miss, hold)]
            return blockage - ((path[-1, 1] - path[0, 1]) / water.depth if math.isfinite(miss) else 0.0)

        reached = (path[-1, 1] - path[0, 1]) / water.depth if math.isfinite(miss) else 0.5 * high
        _crossing(surplus, low, high, min(max(reached, low), high), 1.0, 1e-13, 1e-13)
        coefficient, path, miss, hold = found[0]
    down = path[::-1]
    angle = np.unwrap(np.arctan2(-down[::-1, 2], down[::-1, 3]))[::-1]
    if math.isnan(miss) or np.max(np.abs(angle)) >= math.pi:
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
    if path[0, 1] < -water.depth and not below_bed:
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
        angle=angle,
        top_load=float(-down[0, 2]),
        toe_hold=float(hold),
        top_pull=float(down[0, 3]),
        drag_coefficient=coefficient,
        blockage=depth / water.depth if finite else 0.0,
        residual=abs(miss) / skirt.length,
        hold_share=problem.share if toe == "held" else math.nan,
    )
