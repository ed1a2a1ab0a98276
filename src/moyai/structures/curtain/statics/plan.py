"""Plan shape of a curtain between two supports, in a current at any angle, the load depending on the local angle.

Where the load is normal to the curtain the tension is the same everywhere, and T d(phi)/ds = -p(phi) turns the shape
into three integrals over the angle [eq:curtain-plan]. No marching, no mesh: two unknowns by Newton's steps, which two
nested roots in sure brackets stand in for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.curves import Spline
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import DragLaw
from moyai.structures.curtain.statics.section import LoadLaw, Skirt, solve_section
from moyai.structures.curtain.statics.section_curve import current_shape, section_family

_WIDEST = math.radians(85.0)
_MOST_STEPS = 30
# sixteen points in each of twelve pieces of (-1, 1): the curve of sections is smooth in pieces only
_PIECES = 12
_INNER, _SHARES = np.polynomial.legendre.leggauss(16)
_PIECE_NODES, _PIECE_WEIGHTS = np.polynomial.legendre.leggauss(8)
_POINTS = ((np.arange(_PIECES)[:, None] * 2.0 + 1.0 + _INNER) / _PIECES - 1.0).ravel()
_WEIGHTS = np.tile(_SHARES / _PIECES, _PIECES)


@dataclass(frozen=True, eq=False)
class PlanLoad:
    """Load normal to a curtain per length against its local angle to the flow."""

    #: Load where the curtain lies across the flow P [N/m].
    across: float
    #: Angle of the flow from the normal of the line between the supports, positive towards the second support [rad].
    flow_angle: float
    #: Local angles from across the flow of the points of c in p = P c cos^2 [rad]; a smooth curve between, constant
    #: outside.
    angle: Array
    #: c at these angles [-]; a single point means a constant c.
    ratio: Array

    def __post_init__(self) -> None:
        if not (math.isfinite(self.across) and self.across > 0.0):
            raise InputError(
                f"load across the flow is {self.across:g} N/m", parameter="plan.load", allowed="greater than 0"
            )
        if not abs(self.flow_angle) < 0.5 * math.pi:
            raise InputError(
                f"the flow reaches the curtain at {math.degrees(self.flow_angle):.4g} degrees from its normal",
                parameter="plan.flow_angle",
                allowed="less than 90 degrees",
                remedy="a curtain along the flow has friction only, which is not part of this model",
            )
        if not np.all(self.ratio > 0.0):
            raise InputError(
                "the load changes its side along the curtain",
                parameter="plan.load",
                remedy="the current turns too much over the depth for a shape without inflexion",
            )

    @cached_property
    def _curve(self) -> Spline:
        return Spline(self.angle, self.ratio)

    def factor(self, slope: Array) -> Array:
        """Return c at the tangent of an angle."""
        if self.ratio.size == 1:
            return np.full(np.shape(slope), self.ratio[0])
        turn = np.clip(np.arctan(slope), self.angle[0], self.angle[-1])
        return self._curve(turn)


def cosine_squared_load(line_load: float, flow_angle: float) -> PlanLoad:
    """Return the load of a skirt that keeps its depth: sigma cos^2 [eq:curtain-cable-load]."""
    return PlanLoad(line_load, flow_angle, np.zeros(1), np.ones(1))


@checks_words
def section_load(
    skirt: Skirt,
    current: CurrentProfile,
    flow_heading: float,
    chord_normal: float,
    water: Water,
    drag: DragLaw,
    *,
    law: LoadLaw = "normal_velocity",
    toe: Literal["free", "held"] = "free",
    top_depth: float = 0.0,
    below_bed: bool = False,
    friction: float = 0.0,
    by_curve: bool = True,
    count: int = 49,
) -> PlanLoad:
    """Return the load from sections of the skirt turned against the current: an oblique part flares less.

    Parameters
    ----------
    skirt, current, water, drag, law, toe, top_depth, below_bed, friction
        As :func:`moyai.structures.curtain.statics.section.solve_section`.
    flow_heading : float
        Heading of the flow near the surface [rad], about which the local angle counts.
    chord_normal : float
        Heading of the downstream normal of the line between the supports [rad].
    by_curve : bool
        Take the sections from their curve (:mod:`moyai.structures.curtain.statics.section_curve`), which pays where
        other currents follow; else each is solved.
    count : int
        Sections between -85 and 85 degrees, odd.
    """
    angle = np.linspace(-_WIDEST, _WIDEST, count)
    settings: dict[str, Any] = {"law": law, "toe": toe, "top_depth": top_depth, "friction": friction}
    room = water.depth - top_depth

    def loads(turns: Array) -> Array:
        found = np.full(turns.size, math.nan)
        # a skirt that has no room is refused by the direct solution
        if by_curve and top_depth >= 0.0 and (below_bed or skirt.length <= room):
            family = section_family(skirt, current, water.depth, water.density, drag, **settings)
            if family is not None:
                found = family.loads(flow_heading - turns, math.inf if below_bed else room)
        near = None
        for place in np.flatnonzero(np.isnan(found)):
            heading = flow_heading - turns[place]
            section = solve_section(skirt, current, heading, water, drag, below_bed=below_bed, near=near, **settings)
            near, found[place] = section.start, section.load
        return found

    shape = current_shape(current)
    across = math.inf if shape is None else abs(float(shape.speeds(np.array([flow_heading + 0.5 * math.pi]))[0]))
    if shape is not None and across <= 1e-12 * math.hypot(*shape.velocity):
        # a current of one direction loads both sides alike
        half = loads(angle[count // 2 :])
        load = np.concatenate([half[:0:-1], half])
    else:
        load = loads(angle)
    middle = float(load[count // 2])
    # span along y, downstream x: the second support lies at the heading of the normal plus a right angle
    return PlanLoad(middle, flow_heading - chord_normal, angle, load / (middle * np.cos(angle) ** 2))


@dataclass(frozen=True, eq=False)
class PlanShape:
    """A curtain at rest in plan."""

    #: Distance of the supports [m].
    span: float
    #: Unstretched length [m].
    length: float
    #: EA of all cables together [N].
    axial_stiffness: float
    #: Along the span from the first support [m].
    y: Array
    #: Downstream of the line between the supports [m].
    x: Array
    #: Stretched length from the first support [m].
    arc: Array
    #: Between curtain and span [rad].
    angle: Array
    #: Of all cables together [N].
    tension: float

    @property
    def sag(self) -> float:
        """Largest deflection downstream [m]."""
        return float(np.max(self.x))

    @property
    def strain(self) -> float:
        """T/EA [-]."""
        return self.tension / self.axial_stiffness

    @property
    def downstream_end_forces(self) -> tuple[float, float]:
        """Downstream force on first and second support [N]."""
        return self.tension * math.sin(self.angle[0]), -self.tension * math.sin(self.angle[-1])

    @property
    def inward_end_forces(self) -> tuple[float, float]:
        """Force along the span on first and second support, towards the other one [N]."""
        return self.tension * math.cos(self.angle[0]), self.tension * math.cos(self.angle[-1])


class _Integrals:
    """Integrals of 1/c, sinh v/c and cosh v/c over v from m - w to m + w, and the m of a given w."""

    def __init__(self, load: PlanLoad) -> None:
        self.load = load
        self.slope = math.tan(load.flow_angle)
        self.centre = math.asinh(self.slope)

    def over(self, m: float, w: float) -> Array:
        slope = np.sinh(m + w * _POINTS)
        weight = w * _WEIGHTS / self.load.factor(slope)
        return np.array([weight.sum(), weight @ slope, weight @ np.sqrt(1.0 + slope * slope)])

    def ends(self, m: float, w: float) -> tuple[Array, Array]:
        """Return what is integrated, at both ends."""
        slope = np.sinh(np.array([m - w, m + w]))
        both = np.stack([np.ones(2), slope, np.sqrt(1.0 + slope * slope)]) / self.load.factor(slope)
        return both[:, 0], both[:, 1]

    def middle(self, w: float) -> float:
        from scipy.optimize import brentq

        def lean(m: float) -> float:
            across, along, _ = self.over(m, w)
            return float(along - self.slope * across)

        # the chord's direction lies between the directions of the ends
        return float(brentq(lean, self.centre - w, self.centre + w, xtol=1e-14, rtol=1e-14))


@dataclass(frozen=True)
class _Span:
    """What the plan shape of a load must fit."""

    #: Extent of the span across the flow, and unstretched length [m].
    chord: float
    length: float
    axial_stiffness: float
    integrals: _Integrals

    def tension(self, across: float) -> float:
        return self.chord * self.integrals.load.across / across

    def excess(self, tension: float, arc: float) -> float:
        """Return by how much a shape is longer than the stretched curtain [m]."""
        return tension / self.integrals.load.across * arc - self.length * (1.0 + tension / self.axial_stiffness)

    def start(self) -> tuple[float, float]:
        """Return m and w of a load without c, which has closed integrals; NaN where they are out of reach."""
        slope, load = self.integrals.slope, self.integrals.load.across
        low, high = 1e-6, 20.0
        for _ in range(40):
            w = math.sqrt(low * high)
            m = math.asinh(slope * w / math.sinh(w))
            tension = 0.5 * self.chord * load / w
            if self.excess(tension, 2.0 * math.cosh(m) * math.sinh(w)) > 0.0:
                high = w
            else:
                low = w
            if high < low * 1.001:
                break
        return m, w

    def by_steps(self) -> tuple[float, float] | None:
        """Return m and w by Newton's steps, None where they do not arrive."""
        integrals, load, slope = self.integrals, self.integrals.load.across, self.integrals.slope
        m, w = self.start()
        last = math.inf
        for _ in range(_MOST_STEPS):
            across, along, arc = integrals.over(m, w)
            first, second = integrals.ends(m, w)
            tension = self.tension(across)
            # derivatives of the integrals by m and by w
            by_m, by_w = second - first, second + first
            lean = along - slope * across
            lean_m, lean_w = by_m[1] - slope * by_m[0], by_w[1] - slope * by_w[0]
            excess = self.excess(tension, arc)
            per_across = -tension / across * (arc / load - self.length / self.axial_stiffness)
            excess_m = per_across * by_m[0] + tension / load * by_m[2]
            excess_w = per_across * by_w[0] + tension / load * by_w[2]
            whole = lean_m * excess_w - lean_w * excess_m
            if not (math.isfinite(whole) and whole != 0.0):
                return None
            step_m = -(lean * excess_w - lean_w * excess) / whole
            step_w = -(lean_m * excess - lean * excess_m) / whole
            size = max(abs(step_m), abs(step_w)) / w
            if size > 1.0:
                step_m, step_w = step_m / size, step_w / size
            m, w = m + step_m, max(w + step_w, 0.3 * w)
            if size <= 1e-14 or (size <= 1e-12 and size >= 0.5 * last):
                return m, w
            last = size
        return None

    def by_brackets(self) -> tuple[float, float]:
        """Return m and w by two nested roots, each with a sure bracket."""
        from scipy.optimize import brentq

        integrals = self.integrals

        def excess(w: float) -> float:
            across, _, arc = integrals.over(integrals.middle(w), w)
            return self.excess(self.tension(across), arc)

        high = 0.1
        while excess(high) < 0.0:
            high *= 1.6
        low = min(high, 0.1)
        while excess(low) > 0.0:
            low *= 0.25
        width = float(brentq(excess, low, high, xtol=1e-15, rtol=1e-14)) if high > low else low
        return integrals.middle(width), width


def solve_plan(
    span: float, length: float, axial_stiffness: float, load: PlanLoad, *, intervals: int = 100
) -> PlanShape:
    """Return the plan shape of a curtain between two supports.

    Parameters
    ----------
    span, length : float
        Distance of the supports B and unstretched length l [m]; l may be shorter than B (pretension) with stretch.
    axial_stiffness : float
        EA of all cables together [N], infinite for no stretch.
    load : PlanLoad
        Load against the local angle.
    intervals : int
        Pieces of the shape handed back.

    Raises
    ------
    InputError
        When a number is not positive, or a curtain without stretch is not longer than the span.

    Notes
    -----
    For the load sigma cos^2 across the span this is :func:`moyai.structures.curtain.statics.closed_forms.solve_cable`.
    """
    for name, value in (("span", span), ("length", length), ("axial_stiffness", axial_stiffness)):
        if not value > 0.0 or (math.isinf(value) and name != "axial_stiffness"):
            raise InputError(f"{name} is {value:g}", parameter=f"plan.{name}", allowed="greater than 0")
    if math.isinf(axial_stiffness) and length <= span:
        raise InputError(
            f"a curtain of {length:g} m that does not stretch over a span of {span:g} m",
            parameter="plan.length",
            allowed=f"more than {span:g} m",
            remedy="give more length, or the stiffness of the cables",
        )
    integrals = _Integrals(load)
    within = _Span(span * math.cos(load.flow_angle), length, axial_stiffness, integrals)
    middle, width = within.by_steps() or within.by_brackets()
    tension = within.tension(float(integrals.over(middle, width)[0]))
    return _draw(span, length, axial_stiffness, load, middle, width, tension, intervals)


def _draw(
    span: float,
    length: float,
    axial_stiffness: float,
    load: PlanLoad,
    middle: float,
    width: float,
    tension: float,
    intervals: int,
) -> PlanShape:
    """Integrate the shape piece by piece and turn it from the frame of the flow into that of the span."""
    edges = np.linspace(middle + width, middle - width, intervals + 1)
    half = 0.5 * (edges[:-1] - edges[1:])
    v = 0.5 * (edges[:-1] + edges[1:])[:, None] + half[:, None] * _PIECE_NODES
    slope = np.sinh(v)
    weight = tension / load.across * half[:, None] * _PIECE_WEIGHTS / load.factor(slope)

    def along(values: Array) -> Array:
        return np.concatenate([[0.0], np.cumsum(np.sum(weight * values, axis=1))])

    across, down, arc = along(np.ones_like(v)), along(slope), along(np.sqrt(1.0 + slope * slope))
    c, s = math.cos(load.flow_angle), math.sin(load.flow_angle)
    angle = np.arctan(np.sinh(edges)) - load.flow_angle
    return PlanShape(span, length, axial_stiffness, down * s + across * c, down * c - across * s, arc, angle, tension)
