"""How long a step of the bodies may be: waves, restoring, and the lines when they are taut."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from moyai.core.arrays import Array
from moyai.core.attachment import PointCarrier
from moyai.core.validity import Notice
from moyai.coupled.bodies import Body
from moyai.coupled.planar import PlanarBody, PlanarCarrier
from moyai.coupled.rigid import RigidCarrier
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.stepping import LEAST_STEPS
from moyai.floating.forcing import STEPS_PER_PERIOD
from moyai.floating.time import STEPS_PER_NATURAL_PERIOD

#: Longest step of a body that nothing hurries [s], and one for bodies under gravity alone over their size.
CALM_STEP = 0.1


def line_stiffness(network: Network, point: str) -> Array:
    """Return the stiffness of what is tied to a point when it is taut, as a matrix (3, 3) [N/m].

    A strand that ends at the point counts with its whole length, other bars one by one.
    """
    node, bars = network.points[point], network.bars
    total = np.zeros((3, 3))
    counted: set[int] = set()
    spring = bars.of_type("axial_stiffness") / bars.length if len(bars) else np.zeros(0)
    place = network.nodes.position
    for strand in network.strands:
        if strand.nodes.size < 2 or node not in (strand.nodes[0], strand.nodes[-1]):
            continue
        counted.update(int(bar) for bar in strand.bars)
        far, near = (
            (strand.nodes[-1], strand.nodes[1]) if node == strand.nodes[0] else (strand.nodes[0], strand.nodes[-2])
        )
        whole = 1.0 / float(np.sum(1.0 / spring[strand.bars]))
        for other in (far, near):
            # taut it points at its far end, hanging at its next node: both directions are provided for
            direction = place[other] - place[node]
            size = float(np.linalg.norm(direction))
            if size > 0.0:
                total += 0.5 * whole * np.outer(direction, direction) / size**2
    for bar in np.flatnonzero((bars.start == node) | (bars.end == node)) if len(bars) else ():
        if int(bar) not in counted:
            direction = place[bars.end[bar]] - place[bars.start[bar]]
            size = float(np.linalg.norm(direction))
            total += spring[bar] * np.outer(direction, direction) / max(size, 1e-300) ** 2
    return total


def _fastest(inertia: Array, stiffness: Array) -> float:
    return math.sqrt(max(float(np.max(np.linalg.eigvals(np.linalg.solve(inertia, stiffness)).real)), 0.0))


def _arms_to_modes(arms: Array) -> Array:
    """Return the motion of points under the six motions of the centre of gravity (points, 3, 6)."""
    out = np.zeros((len(arms), 3, 6))
    out[:, :, :3] = np.eye(3)
    x, y, z = arms.T
    out[:, 0, 4], out[:, 0, 5] = z, -y
    out[:, 1, 3], out[:, 1, 5] = -z, x
    out[:, 2, 3], out[:, 2, 4] = y, -x
    return out


def choose_body_step(
    network: Network, bodies: Mapping[str, Body], carriers: Mapping[str, PointCarrier], flow: Flow
) -> tuple[float, Notice]:
    """Choose the step of the bodies and say why.

    Parameters
    ----------
    network : Network
    bodies, carriers : mapping
        Models and their motion.
    flow : Flow

    Returns
    -------
    step : float
        [s].
    notice : Notice
        What decides.
    """
    limits: dict[str, float] = {"the longest step of a calm body": CALM_STEP}
    if flow.waves is not None:
        limits["the shortest wave period that carries energy"] = 50.0 * flow.update_interval / STEPS_PER_PERIOD
    for name, carrier in carriers.items():
        body = bodies[name]
        if isinstance(carrier, RigidCarrier):
            inertia, stiffness, place = carrier.inertia, carrier.restoring, carrier.place_and_velocity()[0]
            pull = np.zeros((6, 6))
            for point, arm in zip(carrier.points, _arms_to_modes(place - carrier.centre), strict=True):
                pull += arm.T @ line_stiffness(network, point) @ arm
        elif isinstance(carrier, PlanarCarrier) and isinstance(body, PlanarBody):
            inertia, stiffness, place = body.model.inertia, body.model.stiffness, carrier.place_and_velocity()[0]
            if math.isfinite(body.forcing.longest_step):
                limits["the periods of the waves"] = body.forcing.longest_step
            pull = np.zeros((3, 3))
            modes = _arms_to_modes(place - carrier.centre)[:, :, [0, 2, 4]]
            for point, arm, copies in zip(carrier.points, modes, carrier.copies, strict=True):
                pull += copies * arm.T @ line_stiffness(network, point) @ arm
        else:
            continue
        rate = _fastest(inertia, stiffness + pull)
        if rate > 0.0:
            limits[f"the shortest natural period of {name!r} on taut lines"] = (
                2.0 * math.pi / rate / STEPS_PER_NATURAL_PERIOD
            )
    reason = min(limits, key=lambda name: limits[name])
    return limits[reason], Notice(
        "body-step",
        f"bodies step {limits[reason]:.4g} s at most, set by {reason}",
        value=limits[reason],
        severity="information",
        remedy="give a shorter step to see its effect",
    )


#: Share of the pace of the elastic wave under which a run that was to go at this pace says so.
PACE = 0.99


def steps_at_the_pace(interval: float, least: int, limit: float) -> tuple[int, tuple[Notice, ...]]:
    """Return how many steps of the bodies fill an interval so that those of the network go at the pace of the wave.

    Parameters
    ----------
    interval : float
        Between two rows [s].
    least : int
        Steps of the bodies that it needs anyway.
    limit : float
        Stable step of the network, the pace of the elastic wave [s].

    Returns
    -------
    count : int
        Within four times ``least``.
    notices : tuple of Notice
        Where no count comes near.
    """
    counts = np.arange(least, 4 * least + 1)
    steps = interval / counts / limit
    courant = steps / np.maximum(np.ceil(steps * (1.0 - 1e-12)), LEAST_STEPS)
    count = int(counts[int(np.argmax(courant - 1e-3 * counts / least))])
    reached = float(courant[count - least])
    if reached >= PACE:
        return count, ()
    return count, (
        Notice(
            "wave-front", f"steps of the network are {reached:.2f} of the pace of the elastic wave: sharp fronts run "
            "with ripples that raise peaks by up to a tenth", reached, PACE, "warning",
            f"rows that are a multiple of {limit:.5g} s apart, {LEAST_STEPS} times it at least, reach this step",
        ),
    )  # fmt: skip
