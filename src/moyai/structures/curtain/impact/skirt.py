"""Impact models in which the skirt stretches: model B of the paper in three variants, and AB with cable and skirt."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice
from moyai.structures.curtain.impact.added_mass import LARGEST_SAGITTA, ArcMass, arc_skirt_mass
from moyai.structures.curtain.impact.cable import Impact, ImpactPeak, peak_by_energy
from moyai.structures.curtain.impact.kernels import cable_and_skirt, sag_ratio, shape_of_sag, spring, taut_shape
from moyai.structures.curtain.statics.closed_forms import arc_half_angle, solve_skirt_arc

Variant = Literal["literal", "energy_mid", "energy_proj"]

# Frequency of the skirt over that of the cable beyond which the skirt counts as rigid
_STIFFEST = 1000.0
# Growth of the sagitta beyond which frozen masses are doubtful
_FROZEN = 0.2

_WIDEST_HALF_ANGLE = 2.0 * math.atan(2.0 * 0.95 * LARGEST_SAGITTA)
#: Chord over length of the skirt that bulges as far as the added mass is known [-]
LEAST_CHORD = math.sin(_WIDEST_HALF_ANGLE) / _WIDEST_HALF_ANGLE


@dataclass(frozen=True)
class BulgedSkirt:
    """A skirt that bulges to an arc between its edges.

    Raises
    ------
    InputError
        When a number is not positive or the chord does not leave an arc within the range of the added mass.
    """

    #: Unstretched depth-wise length d [m].
    length: float
    #: Straight distance d0 of the edges when it becomes taut [m], less than ``length``.
    chord: float
    #: E_s A_s, Young's modulus times thickness [N/m].
    stiffness: float

    def __post_init__(self) -> None:
        for name in ("length", "chord", "stiffness"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{name} is {value:g}", parameter=f"skirt.{name}", allowed="greater than 0, finite")
        if not LEAST_CHORD * self.length < self.chord < self.length:
            raise InputError(
                f"chord is {self.chord:g} m of a skirt {self.length:g} m long",
                parameter="skirt.chord",
                allowed=f"between {LEAST_CHORD * self.length:.5g} and {self.length:g} m, both excluded",
                remedy="the skirt must bulge, and less than a half circle",
            )

    @property
    def sagitta(self) -> float:
        """Sagitta f0 of the just-taut arc [m]."""
        half_angle = float(arc_half_angle(self.chord / self.length))
        return 0.5 * self.chord * math.tan(0.5 * half_angle)

    def edge_tension(self, load: float) -> float:
        """Return the tension of the arc [N/m] whose edges each carry a load [N/m] [eq:curtain-edge-load].

        T_s = F_c / sin(alpha), with the half angle of equation (2) and not that of the just-taut arc: a skirt that
        hangs nearly straight stretches until it can carry the load. Infinite where it would stretch to a full circle.
        """
        if not load > 0.0:
            return 0.0
        pressure = 2.0 * load / self.chord
        # the arc closes where the stiffness is below pressure times length over 2 pi
        if self.stiffness <= pressure * self.length / (2.0 * math.pi):
            return math.inf
        return float(solve_skirt_arc(self.chord, self.length, pressure, self.stiffness).tension)

    def arc(self, sagitta: float) -> tuple[float, float]:
        """Return radius [m] and tension [N/m] at a sagitta [m]; slack below the taut one [eq:impact-skirt-spring]."""
        half = 0.5 * self.chord
        radius = 0.5 * (half * half / sagitta + sagitta)
        angle = 2.0 * math.atan(sagitta / half)
        return radius, self.stiffness * max(0.0, 2.0 * radius * angle / self.length - 1.0)

    def generalised_force(self, sagitta: float) -> float:
        """Force on the sagitta, T_s dL/df [N/m] [eq:impact-skirt-spring]."""
        half = 0.5 * self.chord
        radius, tension = self.arc(sagitta)
        angle = 2.0 * math.atan(sagitta / half)
        # r = (half^2/f + f)/2 and angle = 2 arctan(f/half)
        slope = 0.5 * (1.0 - half * half / sagitta**2)
        turn = 2.0 * half / (half * half + sagitta * sagitta)
        return tension * 2.0 * (slope * angle + radius * turn)


@dataclass(frozen=True)
class SkirtPeak:
    """Peak of model B."""

    #: F_c on each cable [N/m].
    edge_load: float
    #: Sum of the tensions of both cables [N].
    tension: float
    #: From the taut instant [s].
    time: float
    #: T_s [N/m].
    skirt_tension: float


def _arc_mass(impact: Impact, skirt: BulgedSkirt, finite_depth: bool) -> ArcMass:
    return arc_skirt_mass(skirt.chord, impact.water if finite_depth else impact.water.with_depth(math.inf))


def shape_of_displacement(impact: Impact, displacement: float) -> float:
    """Return the shape number b of the cable at a displacement of its middle from just taut [m]."""
    taut = taut_shape(impact.span_ratio)
    return float(shape_of_sag(sag_ratio(taut) + 2.0 * displacement / impact.span, taut))


@checks_words
def curved_impact(impact: Impact, skirt: BulgedSkirt, *, finite_depth: bool = False) -> ImpactPeak:
    """Return the peak of model A with the added mass of the skirt's just-taut arc in place of the flat plate's.

    The remedy for the paper's limitation that a flat plate stands for a skirt whose length is fixed
    [eq:impact-energy].
    """
    return peak_by_energy(impact, float(_arc_mass(impact, skirt, finite_depth).at(skirt.sagitta)[0]))


@checks_words
def skirt_impact(
    impact: Impact, skirt: BulgedSkirt, variant: Variant = "energy_mid", *, finite_depth: bool = False
) -> SkirtPeak:
    """Solve model B: the skirt stretches between cables that do not [eq:impact-stretch].

    Parameters
    ----------
    impact : Impact
        Span, length, speed and water; draught and stiffness of the cables do not enter.
    skirt : Skirt
        The arc.
    variant : {"literal", "energy_mid", "energy_proj"}
        ``literal`` starts the centre of the circle at U0 and balances forces as printed; ``energy_mid`` keeps energy
        and starts the middle of the skirt at U0; ``energy_proj`` keeps energy and starts with the momentum of the flat
        motion. The first is 1.7 to 8 times low against section finite elements, the second within 5 %, the third
        18 to 23 % high.
    finite_depth : bool
        Whether the added mass of the arc is that in the depth of the water, or in deep water.

    Raises
    ------
    InputError
        For another variant, a cable as long as its span, or a skirt so soft that it blows up beyond the table.
    """
    from scipy.integrate import solve_ivp

    if variant not in get_args(Variant):
        raise InputError(f"variant is {variant}", parameter="variant", allowed=", ".join(get_args(Variant)))
    b = taut_shape(impact.span_ratio)
    if b == 0.0:
        raise InputError("the cable is as long as its span: it holds no load without stretch", parameter="length")
    mass = _arc_mass(impact, skirt, finite_depth)
    start = skirt.sagitta
    _, xf, ff = mass.at(start)
    radius, _ = skirt.arc(start)
    speed = {
        "literal": impact.speed * start / radius,
        "energy_mid": impact.speed,
        "energy_proj": impact.speed * xf / ff,
    }[variant]

    def rate(_time: float, state: Array) -> tuple[float, float]:
        # Trial steps may leave the range of the masses; the event that refuses them comes afterwards
        f = min(max(float(state[0]), 0.5 * start), LARGEST_SAGITTA * skirt.chord)
        v = float(state[1])
        if variant == "literal":
            # M_xc c'' = -sigma_s d0 with f' = (f/r) c'
            r, tension = skirt.arc(f)
            share = f / r
            return share * v, -tension / r * skirt.chord / (float(mass.at(f)[1]) * share)
        moved, steeper = float(mass.at(f)[2]), float(mass.slope(f)[2])
        return v, -(skirt.generalised_force(f) + 0.5 * steeper * v * v) / moved

    def stops(_time: float, state: Array) -> float:
        return float(state[1])

    def largest_bulge(_time: float, state: Array) -> float:
        return float(state[0]) - 0.99 * LARGEST_SAGITTA * skirt.chord

    stops.terminal = largest_bulge.terminal = True  # type: ignore[attr-defined]
    stops.direction = -1.0  # type: ignore[attr-defined]
    scale = math.sqrt(ff * skirt.length / skirt.stiffness) + skirt.chord / impact.speed
    first = (start, impact.speed if variant == "literal" else speed)
    found = solve_ivp(rate, (0.0, 20.0 * scale), first, "DOP853", rtol=1e-10, atol=1e-14, events=(stops, largest_bulge))
    assert found.t_events is not None and found.y_events is not None
    if not len(found.t_events[0]):
        raise InputError(
            "the skirt stretches beyond the range of the added mass before it stops",
            parameter="skirt.stiffness",
            allowed=f"sagitta up to {LARGEST_SAGITTA} chords",
            remedy="take a stiffer skirt or a lower speed",
        )
    r, tension = skirt.arc(float(found.y_events[0][0][0]))
    edge = 0.5 * tension / r * skirt.chord
    return SkirtPeak(edge, edge * impact.span / b, float(found.t_events[0][0]), tension)


@dataclass(frozen=True)
class JointPeak(ImpactPeak):
    """Peak of model AB: of the sum of the cable tensions, and of the skirt."""

    #: Largest tension of the skirt [N/m].
    skirt_tension: float
    #: How far the skirt's middle moves against its edges [m].
    sagitta_increment: float
    #: Frequency of the skirt over that of the cable, both just taut.
    frequency_ratio: float
    #: Where the model leaves its range.
    notices: tuple[Notice, ...]


@checks_words
def cable_and_skirt_impact(impact: Impact, skirt: BulgedSkirt, *, finite_depth: bool = False) -> JointPeak:
    """Solve model AB: cable and skirt stretch together, masses frozen at the just-taut arc [eq:impact-cable-skirt].

    A skirt so stiff that it swings more than 1000 times faster than the cable is taken as rigid, with a notice: what
    its stretch changes falls with the square of that ratio.

    Parameters
    ----------
    impact : Impact
        The span; its draught does not enter.
    skirt : Skirt
        The arc.
    finite_depth : bool
        Whether the added mass of the arc is that in the depth of the water, or in deep water.
    """
    start = skirt.sagitta
    xx, xf, ff = (float(value) for value in _arc_mass(impact, skirt, finite_depth).at(start))
    rigid = peak_by_energy(impact, xx)
    small = 1e-6 * start
    stretch = skirt.generalised_force(start + small) / small
    ratio = math.sqrt(stretch / (ff - xf * xf / xx)) * rigid.time / (0.5 * math.pi)
    if ratio > _STIFFEST:
        # The skirt follows the deceleration of the whole: stretch f = M_xf q''/ -stretch with q'' = -load/M_xx
        load = 2.0 * shape_of_displacement(impact, rigid.displacement) * rigid.tension / impact.span
        increment = load * xf / xx / stretch
        notice = Notice(
            "impact-rigid-skirt",
            f"The skirt swings {ratio:.3g} times faster than the cable: it is taken as rigid, with the mass of its arc",
            ratio,
            _STIFFEST,
            severity="information",
            source="the change by its stretch falls with the square of the ratio",
        )
        return JointPeak(
            rigid.tension,
            rigid.displacement,
            rigid.time,
            skirt.arc(start + increment)[1],
            increment,
            ratio,
            (notice,),
        )
    taut = taut_shape(impact.span_ratio)
    cable = np.array([impact.span, impact.span_ratio, taut, impact.stiffness])
    arc = np.array([0.5 * skirt.chord, skirt.length, skirt.stiffness, start])
    inverse = np.linalg.inv(np.array([[xx, xf], [xf, ff]]))
    fastest = 2.0 * math.pi * min(rigid.time / (0.5 * math.pi), rigid.time / (0.5 * math.pi) / ratio)
    step = min(rigid.time / 400.0, fastest / 60.0)
    count = math.ceil(3.0 * rigid.time / step)
    furthest, time, bulge, tension = cable_and_skirt(cable, arc, inverse, impact.speed, step, count)
    _, peak = spring(furthest, impact.span, impact.span_ratio, taut, impact.stiffness)
    notices: tuple[Notice, ...] = ()
    if bulge - start > _FROZEN * start:
        notices = (
            Notice(
                "impact-frozen-mass",
                f"The skirt's sagitta grows by {100.0 * (bulge / start - 1.0):.3g} %; the masses are those of the "
                "just-taut arc",
                bulge / start - 1.0,
                _FROZEN,
                remedy="take a stiffer skirt, or read the result as a bound",
                source="masses frozen at the just-taut arc",
            ),
        )
    return JointPeak(peak, float(furthest), float(time), float(tension), float(bulge - start), ratio, notices)
