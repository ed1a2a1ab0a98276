"""Planning formulas of curtain and boom practice, each under its name, with the drag coefficient that it amounts to."""

from __future__ import annotations

from dataclasses import dataclass

from moyai.core.options import checks_words

_KNOT = 1852.0 / 3600.0
_KILOGRAM_FORCE = 9.80665


@checks_words
@dataclass(frozen=True)
class PlanningLoad:
    """Load of one planning formula."""

    #: Whose formula.
    name: str
    #: On the whole area [N].
    force: float
    #: Coefficient on rho/2 A U^2 that gives the same force [-].
    drag_coefficient: float
    #: Whether the formula was read in its source.
    confirmed: bool
    #: Where it comes from.
    source: str


def _load(
    name: str, factor: float, area: float, speed: float, density: float, confirmed: bool, source: str
) -> PlanningLoad:
    per_square = factor * _KILOGRAM_FORCE / _KNOT**2  # kgf/(m2 kn2) in N/(m2 (m/s)2)
    return PlanningLoad(name, per_square * area * speed**2, 2.0 * per_square / density, confirmed, source)


def us_navy_load(area: float, speed: float, density: float) -> PlanningLoad:
    """Return 26 A V^2 (kgf, m2, knots): US Navy, about C_D = 1.9 [eq:curtain-planning].

    Parameters
    ----------
    area : float
        Submerged area across the current [m2]; for wind the freeboard area with a fortieth of the wind speed.
    speed : float
        [m/s].
    density : float
        Of the water [kg/m3], for the equivalent coefficient.
    """
    return _load(
        "US Navy", 26.0, area, speed, density, True, "US Navy Salvage Manual, volume 6, appendix E: F = 26 A V^2"
    )


def itopf_load(area: float, speed: float, density: float) -> PlanningLoad:
    """Return 100 A V^2 (kgf, m2, knots): ITOPF's planning number, which covers waves and reserve [eq:curtain-planning].

    Arguments as :func:`us_navy_load`; the number was not compared with its source.
    """
    return _load(
        "ITOPF",
        100.0,
        area,
        speed,
        density,
        False,
        "ITOPF, use of booms: F = 100 A V^2, not compared with the original publication",
    )


@checks_words
@dataclass(frozen=True)
class CurrentRule:
    """A speed beyond which practice expects failure."""

    #: What fails.
    name: str
    #: [m/s].
    speed: float
    #: Whether it was read in the source (abstract or text).
    confirmed: bool
    #: Where it comes from.
    source: str


CURRENT_RULES: tuple[CurrentRule, ...] = (
    CurrentRule("toe lifts off the bed", 0.15, True, "Kouwen (1990), Ontario, abstract"),
    CurrentRule("anchor loads become excessive", 0.3, True, "Kouwen (1990), Ontario, abstract"),
    CurrentRule(
        "a curtain is rarely economic",
        0.5,
        False,
        "ERDC TN-DOER-E21 (2005), 1 to 1.5 knots, not compared with the original publication",
    ),
)
