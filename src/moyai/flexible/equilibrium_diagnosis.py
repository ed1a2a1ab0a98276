"""Why a network has no equilibrium, or none was found: what sinks, rises or drifts for ever, what is a mechanism."""

from __future__ import annotations

import contextlib

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError
from moyai.core.wording import spoken
from moyai.flexible.elements import FREE
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network, name_of_node, parts

#: A mode this much slower than a pendulum of the size of the network is one that nothing resists.
_LOOSE = 1e-3


def _free_parts(network: Network) -> tuple[NDArray[np.int64], NDArray[np.bool_]]:
    """Return the connected part of every node, and which axes of each part are free of any hold."""
    nodes, pairs = network.nodes, [np.stack([network.bars.start, network.bars.end], axis=1)]
    if network.sheets is not None:
        pairs += [network.sheets.triangles[:, :2], network.sheets.triangles[:, 1:]]
    ends = np.concatenate(pairs)
    part = parts(len(nodes), ends[:, 0], ends[:, 1])
    loose = np.ones((int(part.max()) + 1, 3), dtype=bool)
    for axis in range(3):
        holds = (nodes.kind != FREE) | nodes.held[:, axis]
        np.logical_and.at(loose[:, axis], part, ~holds)
    return part, loose


def refuse_impossible(network: Network) -> None:
    """Tell of a part that nothing holds vertically and whose weight no water can balance.

    Raises
    ------
    ConvergenceError
        When it sinks without a bed, or is lifted by volume that stays wet however high it rises.
    """
    nodes, water = network.nodes, network.water
    if (nodes.kind != FREE).any() and not nodes.held.any():
        # a network has no part without any hold, unless it has none at all
        return
    part, loose = _free_parts(network)
    weight, lift = network.node_mass * water.gravity, water.density * water.gravity * network.node_volume
    always = np.where(nodes.height > 0.0, 0.0, water.density * water.gravity * nodes.volume)
    for number in np.flatnonzero(loose[:, 2]):
        own = part == number
        heavy, most, least = float(weight[own].sum()), float(lift[own].sum()), float(always[own].sum())
        slack = 1e-9 * max(heavy, most)
        if heavy > most + slack and network.bed is None:
            worst = int(np.flatnonzero(own)[np.argmax((weight - lift)[own])])
            raise ConvergenceError(
                f"no equilibrium: nothing holds the {int(own.sum())} nodes around {name_of_node(network, worst)}, they "
                f"weigh {spoken(heavy - most, 'N')} more than their buoyancy and sink without end",
                parameter="statics", allowed="weight that floats, hangs or rests on the bed",
                remedy="add an anchor, a bed or buoyancy",
            )  # fmt: skip
        if least > heavy + slack:
            worst = int(np.flatnonzero(own)[np.argmax(always[own])])
            raise ConvergenceError(
                f"no equilibrium: the volume of {name_of_node(network, worst)} lifts all {int(own.sum())} nodes "
                f"attached to it by {spoken(least - heavy, 'N')}, and without a height it never leaves the water",
                parameter="statics", allowed="lift that an anchor holds, or that ends at the surface",
                remedy="give the float its height, or add an anchor",
            )  # fmt: skip


def advice(network: Network, place: Array, flow: Flow) -> str:
    """Return what most likely hinders an equilibrium."""
    if not np.isfinite(place).all():
        return "positions are no longer finite: look for a bar whose stiffness or length is out of proportion"
    part, loose = _free_parts(network)
    moving = flow.current is not None or bool(np.any(np.asarray(flow.velocity) != 0.0))
    drifting = np.flatnonzero(loose[:, :2].any(axis=1))
    if moving and drifting.size:
        own = np.flatnonzero(part == drifting[0])
        axes = " and ".join(name for name, free in zip("xy", loose[drifting[0], :2], strict=True) if free)
        return (
            f"nothing holds the {own.size} nodes around {name_of_node(network, int(own[0]))} along {axes}: the "
            "current moves them away (friction of the bed holds no pull in statics); add an anchor"
        )
    if loose[:, 2].any():
        return "nothing holds the network vertically: add an anchor, a bed or a float with a height"
    away = np.linalg.norm(place - network.nodes.position, axis=1)
    extent = float(np.max(np.ptp(network.nodes.position, axis=0))) + float(np.max(network.bars.length, initial=0.0))
    if float(away.max()) > 3.0 * extent:
        return (
            f"{name_of_node(network, int(np.argmax(away)))} went {float(away.max()):.3g} m away: a heavy or buoyant "
            "part is attached to elements too soft to hold it"
        )
    mechanism = _mechanism(network, place, flow, extent)
    if mechanism:
        return mechanism
    if moving:
        return "slack parts may flutter in this current and have no equilibrium: lower the current, or run it with time"
    return "give a better start, more steps, or look for slack parts that may lie anywhere"


def _mechanism(network: Network, place: Array, flow: Flow, extent: float) -> str:
    """Return the motion that next to nothing resists, in words; empty when there is none."""
    from moyai.flexible.modes import natural_modes
    from moyai.flexible.result import State

    # a place far from rest may have a tangent that no solver takes
    with contextlib.suppress(ValueError, RuntimeError, np.linalg.LinAlgError):
        modes = natural_modes(network, State(0.0, place, np.zeros_like(place)), count=1, flow=flow)
        if modes.omega[0] < _LOOSE * np.sqrt(network.water.gravity / extent):
            node = int(np.argmax(np.linalg.norm(modes.shape[0], axis=1)))
            return (
                f"a mechanism: nothing resists a motion that is largest at {name_of_node(network, node)}; "
                "hold it, or give it weight, tension or bending stiffness"
            )
    return ""
