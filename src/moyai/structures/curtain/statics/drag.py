"""Drag of a curtain: coefficient, its range, what blockage does to it, and the flow under the toe."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.sea.current import CurrentProfile
from moyai.sea.water import Water


@dataclass(frozen=True)
class DragLaw:
    """Drag coefficient of a curtain against its blockage, with a range."""

    #: What the law is.
    name: str
    #: Blockages d/h of the points, increasing [-]; C_D is linear between them and constant outside.
    blockage: tuple[float, ...]
    #: C_D at these blockages [-].
    coefficients: tuple[float, ...]
    #: Multipliers (low, high) of the coefficient that bound what is known, for instance (0.8, 1.4).
    range: tuple[float, float]
    #: Where it comes from.
    source: str
    #: Blockage that the case gives, at which the one coefficient was taken [-]; NaN where it follows from the shape.
    given_blockage: float = math.nan

    def __post_init__(self) -> None:
        if len(self.blockage) != len(self.coefficients) or not self.blockage or np.any(np.diff(self.blockage) <= 0.0):
            raise InputError("points of the drag law", parameter="drag", allowed="as many as coefficients, increasing")
        if not all(math.isfinite(c) and c > 0.0 for c in self.coefficients):
            raise InputError(
                f"drag coefficients {self.coefficients}", parameter="drag", allowed="greater than 0, finite"
            )
        low, high = self.range
        if not 0.0 < low <= 1.0 <= high < math.inf:
            raise InputError(
                f"range of the drag is {low:g} to {high:g}", parameter="drag.range", allowed="low <= 1 <= high"
            )

    def coefficient(self, blockage: float) -> float:
        """Return C_D [-] at a blockage d/h [-]."""
        return float(np.interp(blockage, self.blockage, self.coefficients))

    def scaled(self, factor: float) -> DragLaw:
        """Return the law times a factor, without a range: one end of a sensitivity."""
        scaled = tuple(factor * c for c in self.coefficients)
        return replace(self, name=f"{factor:g} x {self.name}", coefficients=scaled, range=(1.0, 1.0))


def constant_drag(coefficient: float, range: tuple[float, float], source: str) -> DragLaw:
    """Return a coefficient that blockage does not change [eq:curtain-drag].

    Parameters
    ----------
    coefficient : float
        C_D [-] on the depth of the curtain and the undisturbed speed; 1.2 to 2.0 for one that the flow can go round.
    range : tuple of float
        Multipliers (low, high).
    source : str
        Where it comes from.
    """
    return DragLaw("constant", (0.0,), (coefficient,), range, source)


def gap_speed_drag(coefficient: float, range: tuple[float, float], source: str, count: int = 400) -> DragLaw:
    """Return a coefficient that holds on the mean speed in the gap, C_D/(1 - d/h)^2 [eq:curtain-drag-gap].

    For a curtain from bank to bank, whose whole flow goes under the toe; up to a blockage of 0.95.
    """
    blockage = np.linspace(0.0, 0.95, count)
    values = coefficient / (1.0 - blockage) ** 2
    return DragLaw("on the gap speed", tuple(blockage), tuple(values), range, source)


def closure_drag(contraction: float, range: tuple[float, float], count: int = 400) -> DragLaw:
    """Return the coefficient of a closure from bank to bank by the momentum of the expanding jet.

    Parameters
    ----------
    contraction : float
        Contraction coefficient of the jet under the toe [-]: 0.61 (sharp edge) to 1.
    range : tuple of float
        Multipliers (low, high).
    count : int
        Points between blockages of 0.1 and 0.95; where the flow can pass unhindered the formula has no meaning.

    Notes
    -----
    Head loss of a sudden expansion, U^2/2g (h/(C_c (h - d)) - 1)^2, over the depth [eq:curtain-drag-closure].
    """
    if not 0.5 < contraction <= 1.0:
        raise InputError(f"contraction is {contraction:g}", parameter="contraction", allowed="above 0.5, at most 1")
    blockage = np.linspace(0.1, 0.95, count)
    values = (1.0 / (contraction * (1.0 - blockage)) - 1.0) ** 2 / blockage
    return DragLaw("closure", tuple(blockage), tuple(values), range, "Borda-Carnot head loss of a closure")


def under_toe_speed(
    current: CurrentProfile, heading: float, toe_depth: float, water: Water, passing_fraction: float
) -> float:
    """Return the mean speed under the toe [m/s] from continuity [eq:curtain-toe-speed].

    Parameters
    ----------
    current : CurrentProfile
        Undisturbed.
    heading : float
        Normal of the curtain [rad].
    toe_depth : float
        Depth of the toe below still water [m].
    water : Water
        Finite depth.
    passing_fraction : float
        Share of the flow held up by the curtain that goes under it, the rest round its ends: 1 from bank to bank.
    """
    if not 0.0 < toe_depth < water.depth or math.isinf(water.depth):
        raise InputError(
            f"toe at {toe_depth:g} m in water of {water.depth:g} m",
            parameter="toe_depth",
            allowed="between 0 and the depth",
        )
    if not 0.0 <= passing_fraction <= 1.0:
        raise InputError(f"passing fraction is {passing_fraction:g}", parameter="passing_fraction", allowed="0 to 1")
    normal = np.array([math.cos(heading), math.sin(heading)])
    held = float(current.depth_mean(-toe_depth, 0.0) @ normal) * toe_depth
    below = float(current.depth_mean(-water.depth, -toe_depth) @ normal)
    return below + passing_fraction * held / (water.depth - toe_depth)


def under_toe_flow(
    current: CurrentProfile, heading: float, toe_depth: float, water: Water, passing_fraction: float
) -> tuple[float, float]:
    """Return the mean speed under the toe [m/s] and its ratio to that of the undisturbed current there [-].

    Only the flow across the curtain is held up: what flows along it continues as it was. Arguments and errors as
    :func:`under_toe_speed`; the ratio is NaN where nothing flows.
    """
    across = under_toe_speed(current, heading, toe_depth, water, passing_fraction)
    below = current.depth_mean(-water.depth, -toe_depth)
    along = float(below @ np.array([-math.sin(heading), math.cos(heading)]))
    speed, undisturbed = math.hypot(across, along), float(np.hypot(*below))
    return speed, speed / undisturbed if undisturbed > 0.0 else math.nan


def sample_pressure(current: CurrentProfile, heading: float, z: ArrayLike, density: float) -> Array:
    """Return rho/2 u|u| [N/m2] of the component along ``heading`` [rad] at heights ``z`` [m]."""
    u = current.component(z, heading)
    values: Array = 0.5 * density * u * np.abs(u)
    return values


def check_drag(law: DragLaw, blockage: float) -> tuple[Notice, ...]:
    """Tell where a blockage lies outside the points of a drag law, or where blockage is left out."""
    if len(law.blockage) > 1 and not law.blockage[0] <= blockage <= law.blockage[-1]:
        limit = law.blockage[0] if blockage < law.blockage[0] else law.blockage[-1]
        return (
            Notice(
                "curtain-drag-range",
                f"blockage d/h = {blockage:.3g} is outside the drag law '{law.name}', whose end value was kept",
                blockage,
                limit,
                "warning",
                "give a drag law that covers the blockage",
                law.source,
            ),
        )
    if len(law.blockage) == 1 and blockage > 0.3:
        return (
            Notice(
                "curtain-blockage",
                f"blockage d/h = {blockage:.3g} is not in the drag coefficient; where the flow "
                "cannot go round the ends the load is larger",
                blockage,
                0.3,
                "warning",
                "for a closure from bank to bank use the gap speed or closure law",
                law.source,
            ),
        )
    return ()
