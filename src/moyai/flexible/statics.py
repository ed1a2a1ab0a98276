"""A network at rest."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import ConvergenceError
from moyai.flexible import implicit_kernel as kernel
from moyai.flexible.arrays import KernelArrays, kernel_arrays
from moyai.flexible.checks import name_of_node
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.result import State

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


#: Steps towards Newton's method before the true motion is asked, and how often and how long it is asked.
#: The solver of a line is quick, that of a net is not.
_STEPS_OF_A_LINE, _STEPS_OF_A_NET, _SHAKES, _SHAKE_INTERVALS = 200, 40, 12, 40


#: Part of the largest force that may be left when the tolerance is out of reach (slack lines that may lie anywhere).
_GOOD_ENOUGH = 1e-5


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A network at rest under weight, buoyancy, bed and steady current.

    Parameters
    ----------
    state : State
        Positions (velocities are zero); a run starts from it.
    tension : ndarray, shape (m,)
        Tension of every bar [N].
    residual : float
        Largest force left on a free node over the largest force at work.
    steps : int
        Solves that it took.
    """

    state: State
    tension: Array
    residual: float
    steps: int


def order_of_unknowns(arrays: KernelArrays) -> tuple[IntArray, int]:
    """Return the rank of every node (reverse Cuthill-McKee) and the half band of the matrix in scalars."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import reverse_cuthill_mckee

    count = arrays.nodes.shape[1]
    i = np.concatenate([arrays.start, arrays.hinges[:, 0], arrays.hinges[:, 0], arrays.hinges[:, 1]])
    j = np.concatenate([arrays.end, arrays.hinges[:, 1], arrays.hinges[:, 2], arrays.hinges[:, 2]])
    if i.size == 0:
        return np.arange(count), 2
    natural = int(np.max(np.abs(i - j)))
    graph = coo_array((np.ones(2 * i.size), (np.concatenate([i, j]), np.concatenate([j, i]))), shape=(count, count))
    rank = np.empty(count, dtype=np.int64)
    rank[reverse_cuthill_mckee(graph.tocsr(), symmetric_mode=True)] = np.arange(count)
    found = int(np.max(np.abs(rank[i] - rank[j])))
    if natural <= found:
        rank, found = np.arange(count), natural
    return rank, 3 * found + 2


def kernel_system(arrays: KernelArrays) -> tuple[object, ...]:
    """Return the tuple that the kernels take."""
    return (
        arrays.nodes, arrays.bars, arrays.start, arrays.end, arrays.curve, arrays.curves, arrays.hinges, arrays.bending,
        arrays.attached,
    )  # fmt: skip


def kernel_bed(network: Network, fade: float = 1e-3) -> Array:
    """Return level, friction, speed below which friction fades [m/s], and whether there is a bed."""
    bed = network.bed
    return np.array([0.0, 0.0, 1.0, 0.0]) if bed is None else np.array([bed.level, bed.friction, fade, 1.0])


def solve_equilibrium(
    network: Network,
    *,
    flow: Flow | None = None,
    start: State | None = None,
    time: float = math.inf,
    tolerance: float = 1e-9,
    most_steps: int = 800,
) -> Equilibrium:
    """Find the network at rest.

    Implicit pseudo-time steps whose velocity is dropped after each (dynamic relaxation with the true stiffness) grow
    into Newton's method as the forces fall [eq:flexible-relaxation]. The bed bears without friction.

    Parameters
    ----------
    network : Network
        The network; driven points stand at their place of zero motion.
    flow : Flow, optional
        Steady current (waves are left out); still water when left out.
    start : State, optional
        First guess; as built when left out.
    time : float
        At which the flow is taken (its ramp is over when left out) [s].
    tolerance : float
        Force left over the largest force at work. Where it stays out of reach, 1e-5 is returned too; see ``residual``.
    most_steps : int
        Solves before it gives up.

    Returns
    -------
    Equilibrium

    Raises
    ------
    ConvergenceError
        When no equilibrium is found; the message names the node, the force left and what may be wrong.
    """
    arrays = kernel_arrays(network)
    rank, width = order_of_unknowns(arrays)
    place = np.array(network.nodes.position if start is None else start.position)
    fixed = network.nodes.kind != 0
    place[fixed] = network.nodes.position[fixed]
    calm = Flow() if flow is None else Flow(flow.velocity, flow.current)
    water = calm.at(1e300 if math.isinf(time) else time, place.T)
    count = len(network.nodes)
    band, tension = np.empty((3 * count, width + 1)), np.zeros(len(network.bars))
    typical = float(np.mean(network.bars.length)) if len(network.bars) else 1.0
    extent = float(np.max(np.ptp(network.nodes.position, axis=0))) if count > 1 else 1.0
    # rounding of a coordinate times the stiffest bar
    noise = (
        16.0 * np.finfo(np.float64).eps * float(arrays.greatest_spring.max(initial=0.0)) * float(np.max(np.abs(place)))
    )
    fluid = np.array([network.water.density, network.water.gravity, 0.0])
    steps, residual, worst, shaken = 0, math.inf, 0, 0
    at_once = _STEPS_OF_A_LINE if width <= 20 else _STEPS_OF_A_NET
    while True:
        before = place.copy()
        taken, residual, worst = kernel.relax(
            place, water, kernel_system(arrays), fluid, kernel_bed(network), rank, band,
            math.sqrt(typical / network.water.gravity), max(0.5 * typical, 0.02 * extent), tolerance, noise,
            min(at_once, most_steps - steps), tension,
        )  # fmt: skip
        steps += taken
        if taken < at_once or steps >= most_steps or shaken >= _SHAKES:
            break
        # Newton's method goes in circles: let the true motion, stopped at every peak of its speed, lead the way
        place = _shake(network, before if shaken == 0 or not np.isfinite(place).all() else place, calm, extent)
        shaken += 1
    rounding = 2.0 * noise / max(float(np.max(np.abs(tension), initial=0.0)), 1e-300)
    if not residual <= max(tolerance, rounding, _GOOD_ENOUGH):
        raise ConvergenceError(
            f"no equilibrium after {steps} steps: {residual:.2g} of the largest force is left at "
            f"{name_of_node(network, int(worst))}, z = {place[worst, 2]:.4g} m",
            path="statics",
            allowed=f"at most {max(tolerance, _GOOD_ENOUGH):g}",
            remedy=_advice(network, place),
        )
    return Equilibrium(State(0.0, place, np.zeros_like(place)), tension, float(residual), int(steps))


def _shake(network: Network, place: Array, flow: Flow, extent: float) -> Array:
    """Move a network towards rest by the explicit scheme, stopped whenever its kinetic energy has fallen."""
    from moyai.flexible.simulate import simulate

    interval = 0.5 * math.sqrt(extent / network.water.gravity)
    still = Motion(0.0, 10.0 * interval, np.zeros((2, 3)), np.zeros((2, 3)))
    motions = dict.fromkeys(network.motion_names, still)
    state, energy = State(0.0, place, np.zeros_like(place)), 0.0
    for _ in range(_SHAKE_INTERVALS):
        history = simulate(
            network,
            motions,
            duration=interval,
            output_step=interval,
            flow=flow,
            start=state,
            keep_nodes=[0],
            keep_bars=[],
        )
        if history.status != "converged":
            break
        now = float(history.kinetic_energy[-1])
        calm = now < energy
        energy = 0.0 if calm else now
        final = history.final
        state = State(0.0, final.position, np.zeros_like(place) if calm else final.velocity)
    return np.array(state.position)


def _advice(network: Network, place: Array) -> str:
    """Return what most likely hinders an equilibrium."""
    if not np.isfinite(place).all():
        return "positions are no longer finite: look for a bar whose stiffness or length is out of proportion"
    weight = float(np.sum(network.node_mass - network.water.density * network.node_volume)) * network.water.gravity
    holds = network.nodes.kind != 0
    if not holds.any() and not network.nodes.held.any():
        return f"nothing holds the network; its weight less its buoyancy is {weight:.3g} N: add an anchor"
    away = float(np.max(np.abs(place - network.nodes.position)))
    extent = float(np.max(np.ptp(network.nodes.position, axis=0))) + 1e-300
    if away > 3.0 * extent:
        return f"a node went {away:.3g} m away: something heavy or light hangs on nothing that bears it"
    return "give a better start, more steps, or look for slack parts that may lie anywhere"
