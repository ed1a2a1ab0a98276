"""Tell when a load rises faster than an elastic wave runs through the line: then the wave makes the peak."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.flexible.network import Network

#: A rise counts as a front when it takes less than this part of the travel time of the wave, and is more than this part
#: of the highest tension.
WINDOW, JUMP = 0.25, 0.4
#: Strain whose rise is no front: tensions of bars that hang slack are rounding.
LEAST_STRAIN = 1e-9
OVERSHOOT = (
    "away from Courant number 1 its peak is likely too high: 15 to 25 % where the load jumps within the time of that "
    "wave along one bar and stays, below 5 % where it takes ten bars, less with viscosity, and too low where it falls "
    "again within a few bars"
)
"""What the mesh makes of a front; measured in tests/unit/flexible/test_front_overshoot.py."""


@dataclass(frozen=True)
class Front:
    """The steepest rise of tension that was seen at one place of a strand."""

    #: Its number.
    strand: int
    #: Highest tension there [N].
    highest: float
    #: Highest rise of tension within the window [N].
    rise: float
    #: The window [s].
    within: float
    #: Time of an elastic wave along the strand [s].
    travel: float
    #: Highest speed with which a node of the strand came down on the bed [m/s].
    fall: float


def travel_time(network: Network, strand: int) -> float:
    """Return the time of an elastic wave along a strand [s]."""
    bars = network.strands[strand].bars
    speed = np.array([network.bars.types[kind].wave_speed for kind in network.bars.kind[bars]])
    return float(np.sum(network.bars.length[bars] / speed))


def front_notices(network: Network, fronts: list[Front], *, explicit: bool = True) -> tuple[Notice, ...]:
    """Return a notice for each strand whose tension jumps within a part of the travel time of the elastic wave.

    A mesh that is not marched at Courant number 1 carries short waves too slowly, so that a front overshoots behind its
    edge; where the explicit scheme marches the notice names size and sign [eq:flexible-overshoot]. On a strand whose
    nodes come down on the bed the jump is likely made by the mesh [eq:flexible-landing].
    """
    worst: dict[int, Front] = {}
    for front in fronts:
        seen = worst.get(front.strand)
        kinds = network.bars.kind[network.strands[front.strand].bars]
        if front.rise <= LEAST_STRAIN * min(network.bars.types[kind].axial_stiffness for kind in kinds):
            continue
        if front.rise > JUMP * front.highest > 0.0 and (seen is None or front.rise > seen.rise):
            worst[front.strand] = front
    return tuple(_notice(network.strands[front.strand].name, front, explicit) for front in worst.values())


def _notice(name: str, front: Front, explicit: bool) -> Notice:
    said = (
        f"the tension of {name!r} (highest {spoken(front.highest, 'N')}) jumps by {spoken(front.rise, 'N')} "
        f"within {front.within:.3g} s, "
    )
    # lines of few bars cannot be watched as finely as the wave: there the steps are too few to follow the rise
    fine = front.within <= 2.0 * WINDOW * front.travel
    said += (
        f"a part of the {front.travel:.3g} s of an elastic wave along it"
        if fine
        else f"within which few steps fall (an elastic wave along it takes {front.travel:.3g} s)"
    )
    if front.fall > 0.0:
        return Notice(
            "landing-front",
            f"{said}, and its nodes come down on the bed at up to {front.fall:.3g} m/s: lumps that stop there "
            "produce spurious tension waves, and peaks, those at the ends too, may be too high",
            front.within,
            front.travel,
            "warning",
            "twice the segments: such fronts fall with the square of the length of bars; a sensitivity run shows it",
            "wave of a node that stops, sqrt(EA m) times its speed along the bar",
        )
    return Notice(
        "wave-front",
        f"{said}; {OVERSHOOT}" if fine and explicit else said,
        front.within,
        front.travel,
        "warning" if fine and explicit else "information",
        "equal bars and safety=1, with an output step that is a whole multiple of the travel time of the wave along "
        "a bar, reproduce the front without error; compare the peak with that of a finer mesh"
        if fine
        else "compare the peak with those of a shorter step and a finer mesh; a sensitivity run does both",
        "one-dimensional wave equation, central differences at Courant number 1",
    )
