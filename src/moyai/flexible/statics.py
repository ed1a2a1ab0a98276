"""A network at rest."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence
from os import PathLike

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError
from moyai.flexible.elements import FREE
from moyai.flexible.equilibrium_diagnosis import advice, refuse_impossible
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network, check_network, name_of_node
from moyai.flexible.relaxation import Attempt, Relaxation
from moyai.flexible.result import Equilibrium, State
from moyai.flexible.slow_stretch import at_rest

#: Part of the largest force that may be left when the tolerance is out of reach.
_GOOD_ENOUGH = 1e-5
#: Attempts one after another: largest turn of a bar in a step [rad], solves, whether bold. In still water ...
_CALM = ((1.0, 300, False), (0.25, 1000, False), (1.0, 700, True), (0.08, 1200, False))
#: ... and in a current, where the matrix need not be positive about a stable rest.
_MOVING = (
    (1.0, 150, True), (1.0, 300, False), (0.25, 400, True), (0.25, 1000, False), (1.0, 700, True), (0.08, 600, True),
    (1.0, 2500, True),
)  # fmt: skip
#: The same on the way of a rising stiffness or current, and after the true motion has led.
_STAGE, _LAST = (0.25, 150), (0.25, 400)
#: Parts of the current on the way to the whole.
_CURRENTS = (0.0, 0.03, 0.1, 0.2, 0.35, 0.5, 0.7, 0.85, 1.0)
#: Numbers in the factors of all solves together, before a network without rest is given up.
_MOST_NUMBERS = 2e8
#: Pseudo steps of dynamic relaxation, which cost about as much as steps of the explicit scheme.
_RELAXING = 40_000
#: Part of all solves that comes before it where there are sheets: slack cloth has a tangent without a slope.
_BEFORE = 0.6
#: First rounding of what only pulls or pushes, over the largest load, near a rest.
_NEAR_SOFT = 1e-2
#: How often and how long the true motion is asked for help.
_SHAKES, _SHAKE_INTERVALS = 6, 40


def _apart(network: Network, place: Array) -> Array:
    """Move free nodes that share their place with the other end of a bar: a bar of no length points nowhere."""
    bars = network.bars
    gap = np.linalg.norm(place[bars.end] - place[bars.start], axis=1)
    close = np.flatnonzero(gap < 1e-6 * bars.length)
    if close.size:
        nodes = np.unique(np.concatenate([bars.start[close], bars.end[close]]))
        nodes = nodes[network.nodes.kind[nodes] == FREE]
        aside = np.random.default_rng(1).normal(0.0, 0.3 * float(np.mean(bars.length[close])), (nodes.size, 3))
        place[nodes] += np.where(network.nodes.held[nodes], 0.0, aside)
    return place


def solve_equilibrium(
    network: Network,
    *,
    flow: Flow | None = None,
    start: State | None = None,
    time: float = math.inf,
    tolerance: float = 1e-9,
    most_steps: int | None = None,
    state_file: str | PathLike[str] | None = None,
) -> Equilibrium:
    """Find the equilibrium of a network.

    Newton's method on places and tensions together in pseudo-time steps [eq:flexible-relaxation]; where it fails, again
    with smaller turns, with a stiffness of sheets or a current that rises from nothing, led by dynamic relaxation
    (:func:`moyai.flexible.dynamic_relaxation.relax_network`), and last by the true motion, stopped at every peak of
    its speed. The bed has no friction.

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
    most_steps : int, optional
        Solves before it gives up; when left out 9000 for small networks, down to 500 for large ones.
    state_file : path, optional
        Where the nearest state is kept when no equilibrium is found (:func:`moyai.flexible.recovery.read_state`).

    Returns
    -------
    Equilibrium
        State, tensions [N], shape (bars,), and what is left of the balance.

    Raises
    ------
    InputError
        For what is no network, a builder for instance.
    ConvergenceError
        When there is no equilibrium or none is found; the message names the node, the force left and what is wrong:
        what nothing holds, what sinks, rises or drifts for ever, a mechanism.

    Examples
    --------
    >>> from moyai.flexible import BarType, NetworkBuilder, solve_equilibrium
    >>> from moyai.sea import Water
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> rope = BarType("rope", mass_per_length=10.0, axial_stiffness=1e7, diameter=0.05)
    >>> builder.fixed("left", (0.0, 0.0, -2.0))
    >>> builder.fixed("right", (20.0, 0.0, -2.0))
    >>> builder.line("span", "left", "right", rope, length=21.0, segments=20)
    >>> network = builder.build()
    >>> found = solve_equilibrium(network)
    >>> round(float(found.state.position[:, 2].min()), 2)            # deepest point of the hanging rope [m]
    -4.79
    """
    check_network(network)
    network = at_rest(network)
    place = np.array(network.nodes.position if start is None else start.position)
    fixed = network.nodes.kind != 0
    place[fixed] = network.nodes.position[fixed]
    place = _apart(network, place)
    calm = Flow() if flow is None else Flow(flow.velocity, flow.current)
    refuse_impossible(network)
    problem = Relaxation(network, calm, time)
    if most_steps is None:
        most_steps = int(min(max(_MOST_NUMBERS / max(problem.plan.size, 1), 500), 9000))
    best, found, steps = _ladder(problem, place, tolerance, most_steps)
    if not best.residual <= max(tolerance, _GOOD_ENOUGH):
        kept = ""
        if state_file is not None:
            from moyai.flexible.recovery import write_state

            kept = f"; nearest state in {write_state(state_file, State(0.0, best.place, np.zeros_like(place)))}"
        raise ConvergenceError(
            f"no equilibrium after {steps} steps: {best.residual:.2g} of the largest force is left at "
            f"{name_of_node(network, best.worst)}, z = {best.place[best.worst, 2]:.4g} m{kept}",
            parameter="statics",
            allowed=f"at most {max(tolerance, _GOOD_ENOUGH):g}",
            remedy=advice(network, best.place, calm),
        )
    problem.forces(best.place)
    state = State(0.0, best.place, np.zeros_like(best.place))
    return Equilibrium(state, problem.tension.copy(), best.residual, steps, found)


def nearby_equilibrium(
    network: Network, flow: Flow, starts: Sequence[State], *, tolerance: float, most_steps: int,
    soft: float = _NEAR_SOFT,
) -> Equilibrium | None:  # fmt: skip
    """Return the equilibrium near a state by Newton's method, ``None`` where a few steps find none.

    Parameters
    ----------
    network : Network
    flow : Flow
        Steady current.
    starts : sequence of State
        Rests of networks that differ little; the one that is closest to rest here is taken.
    tolerance : float
        Force left over the largest force at work.
    most_steps : int
        Solves.
    soft : float
        First rounding of what only pulls or pushes, over the largest load: little, where the start is near.
    """
    network = at_rest(network)
    problem = Relaxation(network, flow, math.inf)
    fixed = network.nodes.kind != 0
    places = [np.where(fixed[:, None], network.nodes.position, start.position) for start in starts]
    place = places[0] if len(places) == 1 else min(places, key=lambda one: problem.look(one).residual)
    found = problem.attempt(place, turn=1.0, most=most_steps, tolerance=tolerance, soft=soft)
    if not found.converged:
        return None
    problem.forces(found.place)
    state = State(0.0, found.place, np.zeros_like(found.place))
    return Equilibrium(state, problem.tension.copy(), found.residual, found.steps, "nearby")


def _ladder(problem: Relaxation, place: Array, tolerance: float, most: int) -> tuple[Attempt, str, int]:
    """Try one way after another; return the nearest to rest, how it was found, and all solves."""
    best = last = Attempt(place, math.inf, 0, 0, False)
    steps, found = 0, ""
    cloth = any(part.stiffness > 0.0 for part in problem.parts)
    whole, most = most, int(_BEFORE * most) if cloth else most

    def go(name: str, x: Array, way: tuple[float, int], bold: bool, soft: float = 0.0) -> bool:
        nonlocal steps, best, found, last
        turn, limit = way
        last = problem.attempt(
            x, turn=turn, most=max(1, min(limit, most - steps)), tolerance=tolerance, bold=bold, soft=soft
        )
        steps += last.steps
        if problem.share == 1.0 and problem.factor == 1.0 and (last.converged or last.residual < best.residual):
            best, found = last, name
        return best.converged or steps >= most

    moving = bool(np.any(problem.water[:3] != 0.0))

    def early() -> bool:
        if cloth:
            x = place
            for share in _shares(problem, place):
                problem.share = share
                if go("rising stiffness", x, _STAGE, moving):
                    return True
                x = last.place
        for turn, limit, bold in _MOVING if moving else _CALM:
            if go("direct" if turn == 1.0 else "small steps", place, (turn, limit), bold):
                return True
        x = place
        for factor in _CURRENTS if moving else ():
            problem.raise_current(factor)
            if go("rising current", x, _STAGE, True):
                return True
            x = last.place if np.isfinite(last.place).all() else x
        return False

    over = early()
    problem.share = 1.0
    problem.raise_current(1.0)
    most = whole
    if best.converged or best.residual <= _GOOD_ENOUGH or (over and steps >= most):
        return best, found, steps
    x = _relaxed(problem.network, place, problem.flow)
    if cloth:
        # it may be as near as rounding and folds allow already
        led = problem.look(x)
        if led.residual < best.residual:
            best, found = led, "dynamic relaxation"
    for bold in (moving, True):
        if go("dynamic relaxation", x, _LAST, bold, 1e-3):
            return best, found, steps
    if best.residual <= _GOOD_ENOUGH:
        return best, found, steps
    x = place
    for shake in range(_SHAKES):
        x = _shake(problem.network, x, problem.flow, not moving or shake % 2 == 1)
        # near the rest nothing is rounded much
        if go("true motion", x, _LAST, moving and shake % 2 == 0, 1e-3):
            break
    return best, found, steps


def _shares(problem: Relaxation, place: Array) -> list[float]:
    """Return parts of the stiffness of sheets, from one that loads stretch by a tenth or so to the whole."""
    problem.share = 1e-12
    load = float(np.linalg.norm(problem._loads_at(place, 0.0) * problem.free, axis=1).sum())
    extent = float(np.max(np.ptp(problem.network.nodes.position, axis=0)))
    stiffest = max(part.stiffness for part in problem.parts) * max(extent, 1e-300)
    if load <= 1e-9 * stiffest:
        # next to nothing stretches it: there is no way to go
        return [1.0]
    share, shares = min(1.0, 10.0 * load / stiffest), []
    while share < 0.2:
        shares.append(share)
        share *= 10.0
    return [*shares, 1.0]


def _relaxed(network: Network, place: Array, flow: Flow) -> Array:
    """Lead a network by dynamic relaxation, which requires no matrix; ``place`` again where that runs away."""
    from moyai.flexible.dynamic_relaxation import relax_network

    start = State(0.0, place, np.zeros_like(place))
    with contextlib.suppress(ConvergenceError, OverflowError, ValueError):
        return np.array(
            relax_network(
                network,
                flow=flow,
                start=start,
                tolerance=1e-6 if network.sheets is None else 1e-8,
                good_enough=math.inf,
                most_steps=_RELAXING,
            ).state.position
        )
    return place


def _pull_per_mass(network: Network) -> float:
    """Return the acceleration [m/s2] that sets the pace without gravity: the stiffest bar pulls the whole mass."""
    return max(kind.axial_stiffness for kind in network.bars.types) / float(np.sum(network.node_mass))


def _shake(network: Network, place: Array, flow: Flow, stops: bool) -> Array:
    """Move a network towards rest by the explicit scheme, stopped whenever its kinetic energy has fallen.

    Without ``stops`` the water alone calms it, as it does a net in a current.
    """
    from moyai.flexible.simulation import simulate

    extent = float(np.max(np.ptp(network.nodes.position, axis=0))) if len(network.nodes) > 1 else 1.0
    pull = network.water.gravity or _pull_per_mass(network)
    interval = 0.5 * math.sqrt(max(extent, 1e-3) / pull)
    still = Motion(0.0, 10.0 * interval, np.zeros((2, 3)), np.zeros((2, 3)))
    motions = dict.fromkeys(network.motion_names, still)
    state, energy = State(0.0, place, np.zeros_like(place)), 0.0
    with contextlib.suppress(OverflowError, ValueError):
        for _ in range(_SHAKE_INTERVALS):
            history = simulate(
                network, motions, duration=interval, output_step=interval, flow=flow, start=state, keep_nodes=[0],
                keep_bars=[],
            )  # fmt: skip
            if history.status == "interrupted":
                raise KeyboardInterrupt
            if history.status != "converged":
                break
            now = float(history.kinetic_energy[-1])
            calm = stops and now < energy
            energy = 0.0 if calm else now
            final = history.final
            state = State(0.0, final.position, np.zeros_like(place) if calm else final.velocity)
    return np.array(state.position)
