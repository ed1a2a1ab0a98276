"""Plan shape of a curtain between two supports, in a current at any angle, the load depending on the local angle.

Where the load is normal to the curtain the tension is the same everywhere, and T d(phi)/ds = -p(phi) turns the shape
into three integrals over the angle [eq:curtain-plan]. No marching, no mesh: two nested roots, each with a sure bracket.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import DragLaw
from moyai.structures.curtain.statics.section import LoadLaw, Skirt, solve_section

_WIDEST = math.radians(85.0)
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
    #: ``angle``, ``ratio``: Points of c in p = P c cos^2 over the local angle from across the flow [rad]; a smooth
    #: curve between, constant outside. A single point means a constant c.
    angle: Array
    #: ``angle``, ``ratio``: Points of c in p = P c cos^2 over the local angle from across the flow [rad]; a smooth
    #: curve between, constant outside. A single point means a constant c.
    ratio: Array

    def __post_init__(self) -> None:
        if not (math.isfinite(self.across) and self.across > 0.0):
            raise InputError(f"load across the flow is {self.across:g} N/m", path="plan.load", allowed="greater than 0")
        if not abs(self.flow_angle) < 0.5 * math.pi:
            raise InputError(
                f"the flow meets the curtain at {math.degrees(self.flow_angle):.4g} degrees from its normal",
                path="plan.flow_angle",
                allowed="less than 90 degrees",
                remedy="a curtain along the flow carries friction only, which is not part of this model",
            )
        if not np.all(self.ratio > 0.0):
            raise InputError(
                "the load changes its side along the curtain",
                path="plan.load",
                remedy="the current turns too much over the depth for a shape without inflexion",
            )

    @cached_property
    def _curve(self) -> object:
        from scipy.interpolate import CubicSpline

        return CubicSpline(self.angle, self.ratio)

    def factor(self, v: Array) -> Array:
        """Return c at v = arsinh(tan(angle))."""
        if self.ratio.size == 1:
            return np.full(np.shape(v), self.ratio[0])
        turn = np.clip(np.arctan(np.sinh(v)), self.angle[0], self.angle[-1])
        return np.asarray(self._curve(turn))  # type: ignore[operator]


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
    count : int
        Sections between -85 and 85 degrees, odd.
    """
    angle = np.linspace(-_WIDEST, _WIDEST, count)

    def loads(turns: Array) -> Array:
        found: list[float] = []
        near = None
        for turn in turns:
            section = solve_section(
                skirt, current, flow_heading - turn, water, drag, law=law, toe=toe, top_depth=top_depth,
                below_bed=below_bed, friction=friction, near=near,
            )  # fmt: skip
            near = section.start
            found.append(section.load)
        return np.array(found)

    heights = np.linspace(-min(water.depth, top_depth + 2.0 * skirt.length), -top_depth, 60)
    if np.max(np.abs(current.component(heights, flow_heading + 0.5 * math.pi))) <= 1e-12 * np.max(
        current.speed(heights), initial=1e-300
    ):
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
    #: ``y``, ``x``: Along the span from the first support and downstream of the line between the supports [m].
    y: Array
    #: ``y``, ``x``: Along the span from the first support and downstream of the line between the supports [m].
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

    def over(self, m: float, w: float) -> tuple[float, float, float]:
        v = m + w * _POINTS
        weight = w * _WEIGHTS / self.load.factor(v)
        return float(weight.sum()), float(weight @ np.sinh(v)), float(weight @ np.cosh(v))

    def middle(self, w: float) -> float:
        from scipy.optimize import brentq

        def lean(m: float) -> float:
            across, along, _ = self.over(m, w)
            return along - self.slope * across

        # the chord's direction lies between the directions of the ends
        return float(brentq(lean, self.centre - w, self.centre + w, xtol=1e-14, rtol=1e-14))


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
    from scipy.optimize import brentq

    for name, value in (("span", span), ("length", length), ("axial_stiffness", axial_stiffness)):
        if not value > 0.0 or (math.isinf(value) and name != "axial_stiffness"):
            raise InputError(f"{name} is {value:g}", path=f"plan.{name}", allowed="greater than 0")
    if math.isinf(axial_stiffness) and length <= span:
        raise InputError(
            f"a curtain of {length:g} m that does not stretch over a span of {span:g} m",
            path="plan.length",
            allowed=f"more than {span:g} m",
            remedy="give more length, or the stiffness of the cables",
        )
    integrals = _Integrals(load)
    chord = span * math.cos(load.flow_angle)

    def state(w: float) -> tuple[float, float, float]:
        m = integrals.middle(w)
        across, _, arc = integrals.over(m, w)
        tension = chord * load.across / across
        return m, tension, tension / load.across * arc - length * (1.0 + tension / axial_stiffness)

    high = 0.1
    while state(high)[2] < 0.0:
        high *= 1.6
    low = min(high, 0.1)
    while state(low)[2] > 0.0:
        low *= 0.25
    width = float(brentq(lambda w: state(w)[2], low, high, xtol=1e-15, rtol=1e-14)) if high > low else low
    middle, tension, _ = state(width)
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
    weight = tension / load.across * half[:, None] * _PIECE_WEIGHTS / load.factor(v)

    def along(values: Array) -> Array:
        return np.concatenate([[0.0], np.cumsum(np.sum(weight * values, axis=1))])

    across, down, arc = along(np.ones_like(v)), along(np.sinh(v)), along(np.cosh(v))
    c, s = math.cos(load.flow_angle), math.sin(load.flow_angle)
    angle = np.arctan(np.sinh(edges)) - load.flow_angle
    return PlanShape(span, length, axial_stiffness, down * s + across * c, down * c - across * s, arc, angle, tension)
