"""The one steady load of a curtain: value of the model that governs, and its band over what is not known.

Section and plan in equilibrium give the load for a free and for a held toe alike. A skirt whose toe swings flares
until its weights balance the current: a load normal to the sheet leaves its tension alone, so the top carries at most
what hangs below it [eq:curtain-steady-bound], however large the drag coefficient is. What is not known is varied one
at a time, and then everything together that lowers or raises the load.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import DragLaw
from moyai.structures.curtain.statics.hanging import CurtainStatics, HangingCurtain, pull_of_lines
from moyai.structures.curtain.statics.section import LoadLaw

#: Drag coefficients of flat skirts and booms that sources give [-]: used where the case gives no range of its own
SOURCED_DRAG = (1.2, 2.0)
#: Factors on the coefficient of a law that knows the blockage, where the case gives none [-]
SOURCED_FACTORS = (0.8, 1.4)
#: Both faces of a fouled sheet [-]: Schlichting's fully rough plate, (1.89 + 1.62 log10(L/k))^-2.5 a face, L/k = 500
SKIN_FRICTION = 0.02
#: Circular cylinder below the critical Reynolds number [-], for floats at the surface
FLOAT_DRAG = 1.2
#: Times that floats sink by the drag that their draught of before made
_SINKING = 50
_MOST_BLOCKED = 0.95
_POINTS = 200

#: Quantities of a state: name, unit, words
QUANTITIES: tuple[tuple[str, str, str], ...] = (
    ("line_load", "N/m", "load of the current per length of curtain"),
    ("span_load", "N", "downstream load of the current on one span"),
    ("cable_tension", "N", "tension of all cables together"),
    ("upper_tension", "N", "tension of the upper cable"),
    ("lower_tension", "N", "tension of the lower cable"),
    ("sheet_tension", "N/m", "largest tension of the skirt"),
    ("anchor_horizontal_tension", "N", "horizontal force on the anchor of an inner support"),
    ("end_anchor_horizontal_tension", "N", "horizontal force on the more loaded support of a lone span"),
    ("anchor_tension", "N", "tension of the anchor line of an inner support"),
    ("float_load", "N/m", "weight and downward pull on the floats"),
    ("effective_depth", "m", "vertical reach of the skirt"),
    ("toe_gap", "m", "clearance between toe and bed"),
    ("float_reserve_ratio", "1", "buoyancy left over buoyancy"),
)


@dataclass(frozen=True, eq=False)
class SteadyState:
    """The curtain at rest under one assumption."""

    #: What was assumed.
    name: str
    statics: CurtainStatics
    #: Load per length of curtain beyond that of the section, which the float line takes [N/m].
    extra: float = 0.0
    #: Factor on every force of the statics [-].
    scale: float = 1.0
    #: Friction of the current along one span [N], half of which either end bears; the statics have none
    #: [eq:curtain-span-friction].
    along: float = 0.0

    def quantity(self, name: str) -> float:
        """Return a number of :data:`QUANTITIES`; what the float line takes more goes with the load into the cables."""
        statics, section, scale = self.statics, self.statics.section, self.scale
        borne = scale * _borne(statics)
        # of the float line's own load per that of the section
        more = (borne + self.extra) / borne
        buoyancy = statics.curtain.floats.buoyancy
        carried = buoyancy - statics.float_reserve
        further = pull_of_lines(statics.curtain, scale * more * statics.anchor_horizontal_tension)
        further -= pull_of_lines(statics.curtain, statics.anchor_horizontal_tension)
        # a sheet between two cables hands each of them half of its friction
        lower = 0.25 * self.along if statics.lower_tension > 0.0 else 0.0
        plain = {
            "line_load": scale * section.load + self.extra,
            "sheet_tension": scale * section.sheet_tension,
            "lower_tension": scale * statics.lower_tension + lower,
            "effective_depth": section.effective_depth,
            "toe_gap": statics.toe_gap if math.isfinite(statics.toe_gap) else math.nan,
            "float_load": carried + further,
            "float_reserve_ratio": 1.0 - (carried + further) / buoyancy,
            "upper_tension": scale * (more * statics.plan.tension - statics.lower_tension) + 0.5 * self.along - lower,
            "cable_tension": scale * more * statics.plan.tension + 0.5 * self.along,
            "end_anchor_horizontal_tension": scale * more * statics.end_anchor_horizontal_tension + 0.5 * self.along,
        }
        if name in plain:
            return plain[name]
        whole = {
            "span_load": sum(statics.plan.downstream_end_forces),
            "anchor_horizontal_tension": statics.anchor_horizontal_tension,
            "anchor_tension": statics.anchor_tension,
        }
        load = scale * more * whole[name]
        if name == "span_load":
            return load
        # an inner support has half a span on either side
        level = scale * more * statics.anchor_horizontal_tension
        return load * math.hypot(level, self.along) / level


def _borne(statics: CurtainStatics) -> float:
    """Return the load per length that reaches the cables [N/m]: without what a bed carries."""
    return statics.section.load if statics.toe_gap != 0.0 else statics.section.top_load


@dataclass(frozen=True, eq=False)
class SteadyLoad:
    """The steady load of a curtain with its band."""

    #: Of the model that governs, everything as the case gives it.
    governing: SteadyState
    #: One thing varied in each.
    causes: tuple[SteadyState, ...]
    #: Everything together that lowers the load.
    lowest: SteadyState
    #: Everything together that raises the load.
    highest: SteadyState
    #: Largest load per length that loads normal to the sheet can put on a skirt whose toe swings [N/m]; infinite where
    #: the toe is held.
    bound: float
    #: What could not be varied, and why.
    left_out: tuple[str, ...] = ()

    def band(self, name: str) -> tuple[float, float]:
        """Return the least and the largest of a quantity over all states."""
        values = [state.quantity(name) for state in (self.governing, *self.causes, self.lowest, self.highest)]
        return min(values), max(values)

    @property
    def factor(self) -> float:
        """Upper end of the load over its value [-]."""
        return self.band("line_load")[1] / self.governing.quantity("line_load")


@dataclass(frozen=True)
class _Change:
    """One thing that is not known: what it is called and what it makes of the curtain."""

    name: str
    subject: str
    apply: Callable[[HangingCurtain], HangingCurtain]


def partial_gap_drag(law: DragLaw, passing_fraction: float) -> DragLaw:
    """Return a constant law on the mean speed in the gap, of which a share of the held flow makes up a part.

    Parameters
    ----------
    law : DragLaw
        A coefficient that blockage does not change.
    passing_fraction : float
        Share f of the held flow that goes under the toe [-]; 1 gives the law of the gap speed, 0 the law itself.

    Notes
    -----
    C_D (1 + f b/(1 - b))^2 of the blockage b [eq:curtain-drag-partial-gap].
    """
    blockage = np.linspace(0.0, _MOST_BLOCKED, _POINTS)
    values = law.coefficients[0] * (1.0 + passing_fraction * blockage / (1.0 - blockage)) ** 2
    return replace(law, name="on the gap speed", blockage=tuple(blockage), coefficients=tuple(values))


def drag_factors(law: DragLaw) -> tuple[float, float]:
    """Return the factors [-] that bound a drag coefficient: of the case, or of the sources where the case is silent."""
    if law.range != (1.0, 1.0):
        return law.range
    if len(law.coefficients) > 1:
        return SOURCED_FACTORS
    given = law.coefficients[0]
    return min(SOURCED_DRAG[0] / given, 1.0), max(SOURCED_DRAG[1] / given, 1.0)


def float_drag(statics: CurtainStatics, water: Water, surface_speed: float) -> float:
    """Return the drag of the floats per length [N/m], which the model of the section leaves out.

    Parameters
    ----------
    statics : CurtainStatics
        Gives how deep the floats lie: round floats in a row without gaps.
    water : Water
    surface_speed : float
        Of the current along the normal [m/s].
    """
    return _drag_at(1.0 - statics.reserve_ratio, statics, water, surface_speed)


def _drag_at(sunk: float, statics: CurtainStatics, water: Water, surface_speed: float) -> float:
    """Return the drag of floats per length [N/m] of whose buoyancy a share is used [-]."""
    area = statics.curtain.floats.buoyancy / (water.density * water.gravity)
    draught = math.sqrt(4.0 * area / math.pi) * _segment_depth(min(max(sunk, 0.0), 1.0))
    return 0.5 * water.density * FLOAT_DRAG * surface_speed**2 * draught


def with_floats(statics: CurtainStatics, water: Water, surface_speed: float) -> SteadyState:
    """Return a state at rest with the drag of its floats, which lie as deep as that drag pulls them.

    Arguments as :func:`float_drag`. The anchor lines pull the floats down with what the floats collect.
    """
    at_rest = SteadyState("with the drag of the floats", statics, float_drag(statics, water, surface_speed))
    sunk = 1.0 - at_rest.quantity("float_reserve_ratio")
    for _ in range(_SINKING):
        state = replace(at_rest, extra=_drag_at(sunk, statics, water, surface_speed))
        deeper = 1.0 - state.quantity("float_reserve_ratio")
        if min(deeper, 1.0) - min(sunk, 1.0) <= 1e-6:
            break
        sunk = deeper
    return state


def _segment_depth(share: float) -> float:
    """Return the depth of a circular segment over the diameter [-] for its share of the circle's area [-]."""
    if share in (0.0, 1.0):
        return share
    from scipy.optimize import brentq

    angle = float(brentq(lambda a: (a - math.sin(a)) / (2.0 * math.pi) - share, 0.0, 2.0 * math.pi, xtol=1e-12))
    return 0.5 * (1.0 - math.cos(0.5 * angle))


def _changes(curtain: HangingCurtain, toe_range: tuple[float, float], passing_fraction: float) -> list[_Change]:
    low, high = drag_factors(curtain.drag)
    middle = curtain.drag.coefficients[0]
    known = len(curtain.drag.coefficients) == 1

    def said(factor: float) -> str:
        return f"drag coefficient {factor * middle:.3g}" if known else f"drag coefficient times {factor:.3g}"

    def scaled(factor: float) -> Callable[[HangingCurtain], HangingCurtain]:
        return lambda item: replace(item, drag=item.drag.scaled(factor))

    def weighed(factor: float) -> Callable[[HangingCurtain], HangingCurtain]:
        return lambda item: replace(item, skirt=replace(item.skirt, toe_load=factor * item.skirt.toe_load))

    found = [_Change(said(factor), "drag", scaled(factor)) for factor in (low, high) if factor != 1.0]
    found += [
        _Change(f"toe weight times {factor:.3g}", "toe", weighed(factor)) for factor in toe_range if factor != 1.0
    ]
    # a coefficient at a blockage that the case gives holds the closing of the gap already
    if known and math.isnan(curtain.drag.given_blockage) and passing_fraction > 0.0:
        found.append(
            _Change(
                f"gap under the toe closes: {passing_fraction:.3g} of the held flow under it",
                "gap",
                lambda item: replace(item, drag=partial_gap_drag(item.drag, passing_fraction)),
            )
        )
    # full pressure on a sheet that lies along the flow is out of range: separated flow stands for the upper end
    other: LoadLaw = "free_streamline" if curtain.law == "normal_velocity" else "normal_velocity"
    words = "oblique plate in separated flow" if other == "free_streamline" else "load of the normal velocity"
    found.append(_Change(f"other load law: {words}", "law", lambda item: replace(item, law=other)))
    found.append(
        _Change("friction along a fouled sheet", "friction", lambda item: replace(item, friction=SKIN_FRICTION))
    )
    return found


def steady_load(
    curtain: HangingCurtain,
    solve: Callable[[HangingCurtain], CurtainStatics],
    water: Water,
    *,
    toe_range: tuple[float, float],
    passing_fraction: float,
    surface_speed: float,
    along_speed: float,
) -> SteadyLoad:
    """Return the governing steady load with its band.

    Parameters
    ----------
    curtain : HangingCurtain
    solve : callable
        Statics of a curtain at the site, in the current that is asked for.
    water : Water
    toe_range : tuple of float
        Factors (low, high) on the toe's weight.
    passing_fraction : float
        Share of the held flow that goes under the toe [-].
    surface_speed : float
        Component of the current along the normal at the surface [m/s], for the drag of the floats.
    along_speed : float
        Root mean square over the skirt of the component along the span [m/s], for the friction there.

    Raises
    ------
    InputError
        When the curtain as given has no equilibrium.

    Notes
    -----
    Everything that raises the load acts together at the upper end: an envelope, no probability.
    """
    alone = given_alone(curtain, solve(curtain))
    given, bound, left_out = alone.governing, alone.bound, []
    middle, free = given.quantity("line_load"), math.isfinite(bound)
    causes: list[SteadyState] = []
    lower: dict[str, tuple[float, _Change]] = {}
    raised: dict[str, tuple[float, _Change]] = {}
    unknown_law = 0.0
    for change in _changes(curtain, toe_range, passing_fraction):
        try:
            state = SteadyState(change.name, solve(change.apply(curtain)))
        except (InputError, ConvergenceError):
            if change.subject == "law" and free:
                # no shape to compute: but whatever the law is, the top carries no more than what hangs below it
                unknown_law = max(bound - middle, 0.0)
                causes.append(SteadyState(f"{change.name}: no shape, bound by the weights", given.statics, unknown_law))
            else:
                left_out.append(f"{change.name}: no equilibrium")
            continue
        causes.append(state)
        value = state.quantity("line_load")
        for found, beyond in ((lower, middle - value), (raised, value - middle)):
            if beyond > max(0.0, found.get(change.subject, (0.0, change))[0]):
                found[change.subject] = (beyond, change)
    afloat = float_drag(given.statics, water, surface_speed)
    causes.append(SteadyState("floats in the current, not in the model", given.statics, afloat))
    wetted = min(curtain.skirt.length, water.depth) * curtain.length
    along = 0.5 * water.density * SKIN_FRICTION * along_speed**2 * wetted
    if along > 0.0:
        causes.append(SteadyState("friction along the span, not in the model", given.statics, along=along))
    lowest = _together(curtain, solve, lower, "all that lowers the load", 0.0) or given
    highest = _together(curtain, solve, raised, "all that raises the load", afloat + unknown_law)
    if highest is None:
        # without a common equilibrium the increases are added
        total = sum(beyond for beyond, _ in raised.values())
        scale = 1.0 + total / middle
        highest = SteadyState("all that raises the load, added", given.statics, afloat + unknown_law, scale)
        left_out.append("all that raises the load has no common equilibrium: the increases are added")
    highest = replace(highest, along=along)
    return SteadyLoad(given, tuple(causes), lowest, highest, bound, tuple(left_out))


def given_alone(curtain: HangingCurtain, statics: CurtainStatics) -> SteadyLoad:
    """Return a steady load without band: what is at rest as the case gives it."""
    given, skirt = SteadyState("as given", statics), curtain.skirt
    free = curtain.toe == "free" and statics.toe_gap != 0.0
    bound = skirt.toe_load + max(skirt.submerged_weight, 0.0) * skirt.length if free else math.inf
    return SteadyLoad(given, (), given, given, bound, ("drafted without band",))


def _together(
    curtain: HangingCurtain,
    solve: Callable[[HangingCurtain], CurtainStatics],
    changes: dict[str, tuple[float, _Change]],
    name: str,
    extra: float,
) -> SteadyState | None:
    """Return the state with all changes; ``None`` where it has no equilibrium."""
    changed = curtain
    for subject in ("drag", "gap", "toe", "law", "friction"):
        if subject in changes:
            changed = changes[subject][1].apply(changed)
    try:
        return SteadyState(name, solve(changed), extra)
    except (InputError, ConvergenceError):
        return None
