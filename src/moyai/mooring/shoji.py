"""The modified catenary of Shoji, used for floating breakwaters in Japan: an independent path to the same numbers.

Its equation ``[eq:mooring-shoji]`` is the elastic catenary on a frictionless bed, written with the whole length S. It
holds while part of the line lies on the bed and only together with its closure ``sinh(.) = w s / T_H``;
docs/theory/mooring.md explains the common misreading.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from moyai.core.errors import InputError


@dataclass(frozen=True)
class ShojiSolution:
    """A line with part of it on the bed."""

    #: T_H at the fairlead [N].
    horizontal_tension: float
    #: T_V = w s at the fairlead [N].
    vertical_tension: float
    #: Unstretched length s clear of the bed [m].
    suspended_length: float
    #: xbar: distance to the fairlead less the unstretched grounded length [m].
    reduced_distance: float


def solve_shoji(
    horizontal_distance: float, vertical_distance: float, length: float, axial_stiffness: float, weight: float
) -> ShojiSolution:
    """Solve Shoji's modified catenary with its closure.

    Parameters
    ----------
    horizontal_distance, vertical_distance : float
        From anchor to fairlead [m], both positive.
    length, axial_stiffness, weight : float
        Whole unstretched length S [m], EA [N], submerged weight w [N/m].

    Returns
    -------
    ShojiSolution

    Raises
    ------
    InputError
        Where the formula does not hold: the line is lifted off its anchor, or slack without horizontal tension.
    """
    if not (vertical_distance > 0.0 and weight > 0.0 and length > 0.0 and axial_stiffness > 0.0):
        raise InputError(
            "the modified catenary needs a heavy line below its fairlead", parameter="line", allowed="Z, w, S, EA > 0"
        )

    def state(angle: float) -> tuple[float, float, float]:
        """Return (distance, T_H, s) for the slope parameter at the fairlead; T_H from the height, a quadratic."""
        rise = math.cosh(angle) - 1.0
        quadratic = math.sinh(angle) ** 2 / (2.0 * axial_stiffness)
        load = weight * vertical_distance
        tension = 2.0 * load / (rise + math.sqrt(rise * rise + 4.0 * quadratic * load))
        suspended = tension / weight * math.sinh(angle)
        reduced = tension / weight * angle + tension * length / axial_stiffness
        return reduced + length - suspended, tension, suspended

    low, high = 1e-6, 300.0  # flat and slack ends; the distance falls with the angle
    if not state(high)[0] < horizontal_distance < state(low)[0]:
        raise InputError(
            "the line is slack or straight: outside the modified catenary", parameter="horizontal_distance"
        )
    for _ in range(200):
        middle = 0.5 * (low + high)
        if state(middle)[0] > horizontal_distance:
            low = middle
        else:
            high = middle
        if high - low <= 1e-15 * high:
            break
    _, tension, suspended = state(0.5 * (low + high))
    if suspended > length:
        raise InputError(
            "no part of the line lies on the bed: outside the modified catenary",
            parameter="horizontal_distance",
            remedy="use solve_catenary, which covers lifted lines",
        )
    return ShojiSolution(tension, weight * suspended, suspended, horizontal_distance - length + suspended)
