"""Load laws of curtain practice side by side: catenary, circular, rigid, elastic, in plan and in section.

The laws differ in how the load of the current falls off where the curtain is oblique to it. Nobody has measured which
one a skirt follows beyond load ratios of about 1, so their spread is a result of its own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.structures.curtain.statics.closed_forms import arc_half_angle, solve_cable

_DOMAIN = "closed forms of curtain statics, recomputed independently"


@dataclass(frozen=True)
class SectionLaw:
    """Shape of a weightless skirt that hangs from its top with a toe load, under one load law."""

    #: ``catenary``, ``circular``, ``rigid`` or ``elastic``.
    name: str
    #: Vertical reach of the toe [m]; NaN where the law has no solution.
    effective_depth: float
    #: Downstream reach of the toe [m]; NaN where the law has no solution.
    flare: float
    #: Force per span along the skirt at its top [N/m].
    top_tension: float
    #: Downstream force per span on the top [N/m].
    horizontal_load: float
    #: Angle of the skirt at its top from the vertical [rad].
    top_angle: float


def _section_catenary(length: float, toe_load: float, pressure: float, name: str) -> SectionLaw:
    """Load q cos^2 of the angle from the vertical: tension W everywhere [eq:curtain-section-catenary]."""
    a = toe_load / pressure
    angle = math.atan2(length, a)
    flare = length * length / (math.hypot(a, length) + a)
    return SectionLaw(name, a * math.asinh(length / a), flare, toe_load, toe_load * math.sin(angle), angle)


def _section_circular(length: float, toe_load: float, pressure: float) -> SectionLaw:
    """Uniform normal pressure: an arc of radius W/q [eq:curtain-section-circular]."""
    turn = pressure * length / toe_load
    if turn >= math.pi:
        return SectionLaw("circular", math.nan, math.nan, math.nan, math.nan, math.nan)
    a = toe_load / pressure
    horizontal = toe_load * math.sin(turn)
    return SectionLaw("circular", a * math.sin(turn), 2.0 * a * math.sin(0.5 * turn) ** 2, toe_load, horizontal, turn)


def _section_rigid(length: float, toe_load: float, pressure: float) -> SectionLaw:
    """Hinged plate: sin(theta) = (qL/2W) cos^2(theta), the positive root of a quadratic [eq:curtain-section-rigid]."""
    half = 0.5 * pressure * length / toe_load
    sine = 2.0 * half / (1.0 + math.sqrt(1.0 + 4.0 * half * half))
    cosine = math.sqrt((1.0 - sine) * (1.0 + sine))
    load = pressure * length * cosine**2
    # forces of the hinge on the plate: load normal to it, toe load down
    horizontal, vertical = load * cosine, toe_load - load * sine
    along = horizontal * sine + vertical * cosine
    return SectionLaw("rigid", length * cosine, length * sine, along, horizontal, math.asin(sine))


def section_laws(
    length: float, toe_load: float, pressure: float, stiffness: float = math.inf
) -> tuple[SectionLaw, SectionLaw, SectionLaw, SectionLaw]:
    """Return catenary, circular, rigid and elastic shapes of a hanging skirt.

    Parameters
    ----------
    length : float
        Unstretched skirt length L [m].
    toe_load : float
        Submerged weight at the toe per span W [N/m].
    pressure : float
        q = rho/2 C_D U^2 [N/m2].
    stiffness : float
        Skirt stiffness per span [N/m] of the elastic law; infinite makes it the catenary.

    Raises
    ------
    InputError
        When a number is not positive and finite.

    Notes
    -----
    The elastic law is the catenary of the length under the tension W [eq:curtain-section-elastic].
    """
    for name, value in (("length", length), ("toe_load", toe_load), ("pressure", pressure)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0, finite")
    if not stiffness > 0.0:
        raise InputError(f"skirt stiffness is {stiffness:g} N/m", parameter="stiffness", allowed="greater than 0")
    stretched = length * (1.0 + toe_load / stiffness)
    return (
        _section_catenary(length, toe_load, pressure, "catenary"),
        _section_circular(length, toe_load, pressure),
        _section_rigid(length, toe_load, pressure),
        _section_catenary(stretched, toe_load, pressure, "elastic"),
    )


@dataclass(frozen=True)
class PlanLaw:
    """Shape and forces of a curtain between two supports in plan, under one load law."""

    #: ``catenary``, ``circular``, ``rigid``, ``elastic`` or ``small sag``.
    name: str
    #: Tension of the cables together [N]; 0 for a rigid curtain, which carries its load by bending.
    tension: float
    #: Deflection at mid-span [m].
    sag: float
    #: Force on each support, downstream [N].
    downstream_end_force: float
    #: Force on each support along the span [N].
    inward_end_force: float


def _plan_cable(span: float, length: float, line_load: float, stiffness: float, name: str) -> PlanLaw:
    cable = solve_cable(span, length, line_load, stiffness)
    return PlanLaw(
        name,
        float(cable.tension),
        float(cable.sag),
        float(cable.downstream_end_force),
        float(cable.inward_end_force),
    )


def _plan_circular(span: float, length: float, line_load: float) -> PlanLaw:
    """Uniform normal load: an arc of a circle, sin(alpha)/alpha = B/l [eq:curtain-plan-circular]."""
    angle = float(arc_half_angle(span / length))
    tension = line_load * length / (2.0 * angle)
    sag = length / (2.0 * angle) * 2.0 * math.sin(0.5 * angle) ** 2
    return PlanLaw("circular", tension, sag, tension * math.sin(angle), tension * math.cos(angle))


def _plan_small_sag(span: float, length: float, line_load: float) -> PlanLaw:
    """Parabola of small sag: H = qB/(8 s), l = B (1 + 8 s^2/3), s = sag/B [eq:curtain-plan-small-sag]."""
    ratio = math.sqrt(0.375 * (length - span) / span)
    end, inward = 0.5 * line_load * span, line_load * span / (8.0 * ratio)
    return PlanLaw("small sag", math.hypot(inward, end), ratio * span, end, inward)


def plan_laws(
    span: float, length: float, line_load: float, axial_stiffness: float
) -> tuple[PlanLaw, PlanLaw, PlanLaw, PlanLaw, PlanLaw]:
    """Return catenary, circular, rigid, elastic and small-sag forms of a curtain across a uniform current.

    Parameters
    ----------
    span, length : float
        Distance of the supports B and unstretched length l > B [m].
    line_load : float
        Load per length of curtain across the current q [N/m].
    axial_stiffness : float
        EA of all cables together [N] of the elastic law.

    Raises
    ------
    InputError
        When a number is not positive or the curtain is not longer than the span.

    Notes
    -----
    A rigid curtain carries qB/2 to each support and has no tension; the small-sag parabola is the check of the ice
    boom manuals (CRREL TD 96-01).
    """
    return (
        _plan_cable(span, length, line_load, math.inf, "catenary"),
        _plan_circular(span, length, line_load),
        PlanLaw("rigid", 0.0, 0.0, 0.5 * line_load * span, 0.0),
        _plan_cable(span, length, line_load, axial_stiffness, "elastic"),
        _plan_small_sag(span, length, line_load),
    )


def check_section_load(length: float, toe_load: float, pressure: float) -> tuple[Notice, ...]:
    """Tell where the load laws of a hanging skirt drift apart, with the spread of their effective depths."""
    ratio = pressure * length / toe_load
    if ratio <= 1.0:
        return ()
    depths = [law.effective_depth for law in section_laws(length, toe_load, pressure)[:3]]
    spread = (np.nanmax(depths) - np.nanmin(depths)) / length
    named = "the circular law has no solution" if math.isnan(depths[1]) else f"they differ by {spread:.2f} lengths"
    return (
        Notice(
            "curtain-section-laws",
            f"load ratio qL/W = {ratio:.3g}: the load laws give different effective depths ({named})",
            ratio,
            1.0,
            "warning",
            "give more toe weight, or take the range of the laws as the result",
            _DOMAIN,
        ),
    )
