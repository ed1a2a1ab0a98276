"""A flexible cage at rest in a current, and the numbers that a designer requires."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError
from moyai.core.progress import Progress, silent
from moyai.flexible.dynamic_relaxation import relax_network
from moyai.flexible.flow import Current, Flow
from moyai.flexible.network import Network
from moyai.flexible.result import Equilibrium, State
from moyai.flexible.rings import ring_moments
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import nearby_equilibrium, solve_equilibrium
from moyai.structures.cage.flexible.loads import PARTS, drag_on_holds, drag_split, pull_on_anchors
from moyai.structures.cage.flexible.model import FlexibleCage
from moyai.structures.cage.flexible.parts import CageNetwork, CageParts
from moyai.structures.cage.flexible.wake import sheltered

#: Force left over the largest tension: what is asked for, and above what the true motion leads to rest.
TOLERANCE, SETTLE_ABOVE = 1e-4, 1e-3
#: The same before Newton's method is asked, and how far it may lead away from there, over the size of a cage.
LEAD, ASTRAY = 1e-3, 0.05
#: First rounding of what only pulls, over the largest load, that Newton's method begins with there, and its steps;
#: where they fail, those that it gets with large rounding, of which it takes 10 to 50 where it finds an equilibrium.
LED_SOFT, LED_STEPS, NEWTON_STEPS = 1e-3, 20, 100
#: Residual of Newton's method.
FINE = 1e-9
#: The same from the rest of a cage that differs little.
NEAR_STEPS = 32
#: Time of that motion over the square root of size over gravity.
SETTLE_TIME = 15.0


@dataclass(frozen=True, eq=False)
class CageEquilibrium:
    """A cage at rest."""

    built: CageNetwork
    #: With the shelter of its current.
    network: Network
    current: Current | None
    state: State
    #: Of every bar [N].
    tension: Array
    #: Largest force left on a node over the largest tension.
    residual: float
    #: Of the relaxation.
    steps: int


def solve_cage_equilibrium(
    model: FlexibleCage,
    built: CageNetwork,
    current: Current | None,
    *,
    start: State | None = None,
    near: Sequence[State] = (),
    progress: Progress = silent,
) -> CageEquilibrium:
    """Find a cage at rest in a current.

    Dynamic relaxation leads, which ends in no unstable rest, then Newton's method. Where slack net flutters and will
    not come to rest, the true motion, which the water damps, continues from there.

    Parameters
    ----------
    model : FlexibleCage
        At one water level.
    built : CageNetwork
        Of :func:`moyai.structures.build_cage`.
    current : Current, optional
        Still water without one.
    start : State, optional
        Rest in a similar current.
    near : sequence of State
        Rests of cages that differ little, for a draft: a few steps of Newton's method from the best of them are enough,
        to a thousandth of the largest tension; where they fail it is as if there were none.
    progress : Progress
        Called within the search.

    Returns
    -------
    CageEquilibrium
        Places, tensions and what the water brings to every part.

    Raises
    ------
    ConvergenceError
        When it does not come near rest.

    Examples
    --------
    >>> import moyai
    >>> from moyai.case import build
    >>> from moyai.structures import build_cage, solve_cage_equilibrium
    >>> model = build(moyai.load_case(moyai.template("cage"))).at_level(0.0)
    >>> built = build_cage(model)
    >>> rest = solve_cage_equilibrium(model, built, None)
    >>> cage = built.cages[0]
    >>> round(float(cage.volume(rest.state.position)) / cage.rest_volume, 2)     # of its volume without water
    1.01
    """
    network, flow = sheltered(model, built, current), Flow(current=current)
    if alike := [one for one in near if one.position.shape == network.nodes.position.shape]:
        nearby = nearby_equilibrium(network, flow, alike, tolerance=LEAD, most_steps=NEAR_STEPS)
        if nearby is not None:
            return CageEquilibrium(built, network, current, nearby.state, nearby.tension, nearby.residual, nearby.steps)
    found = relax_network(
        network, flow=flow, start=start, tolerance=LEAD, good_enough=1.0, most_steps=30_000, progress=progress
    )
    polished = _newton(model, network, flow, found.state)
    if polished is None:
        found = relax_network(
            network, flow=flow, start=found.state, tolerance=TOLERANCE, good_enough=0.05, most_steps=50_000,
            progress=progress,
        )  # fmt: skip
        polished = _newton(model, network, flow, found.state)
    if polished is not None:
        return CageEquilibrium(
            built, network, current, polished.state, polished.tension, polished.residual, found.steps
        )
    state, tension, residual = found.state, found.tension, found.residual
    if residual > SETTLE_ABOVE:
        duration = SETTLE_TIME * math.sqrt(model.design.size / model.water.gravity)
        history = simulate(network, duration=duration, output_step=duration / 20.0, flow=flow, start=state)
        if history.status == "interrupted":
            raise KeyboardInterrupt
        if history.status == "converged":
            place = history.final.position
            state, tension = State(0.0, place, np.zeros_like(place)), history.tension[-1]
            again = relax_network(network, flow=flow, start=state, tolerance=1.0, good_enough=1.0)
            residual = again.residual
    return CageEquilibrium(built, network, current, state, tension, residual, found.steps)


def _newton(model: FlexibleCage, network: Network, flow: Flow, start: State) -> Equilibrium | None:
    """Return the rest near a state by Newton's method, ``None`` where it finds none or another one."""

    def is_near(found: Equilibrium) -> bool:
        away = np.linalg.norm(found.state.position - start.position, axis=1)
        return float(away.max()) < ASTRAY * max(model.design.size, model.spacing)

    led = nearby_equilibrium(network, flow, [start], tolerance=FINE, most_steps=LED_STEPS, soft=LED_SOFT)
    if led is not None and is_near(led):
        return led
    try:
        found = solve_equilibrium(network, flow=flow, start=start, tolerance=FINE, most_steps=NEWTON_STEPS)
    except ConvergenceError:
        return None
    return found if is_near(found) else None


def collar_forces(
    model: FlexibleCage, rest: CageEquilibrium, position: Array, tension: Array
) -> list[list[dict[str, Array]]]:
    """Return axial force, moments and stress around the rings of each collar.

    Parameters
    ----------
    model : FlexibleCage
    rest : CageRest
    position : ndarray, shape (n, 3)
    tension : ndarray
        Of every bar [N].
    """
    moments = dict(
        zip((ring.name for ring in rest.network.rings), ring_moments(rest.network.rings, position), strict=True)
    )
    pipe, out = model.design.collar.pipe, []
    for cage in rest.built.cages:
        rings = []
        for number, bars in enumerate(cage.collar_bars):
            name = f"{cage.name} {'outer ' if number else ''}collar"
            bending = moments[name]
            # at a node: the mean of the bars that meet there
            axial = 0.5 * (tension[bars] + np.roll(tension[bars], 1))
            torsion = 0.5 * (bending[:, 2] + np.roll(bending[:, 2], 1))
            rings.append(
                {
                    "axial": axial, "in_plane": bending[:, 0], "out_of_plane": bending[:, 1], "torsion": torsion,
                    "stress": pipe.stress(axial, bending[:, 0], bending[:, 1], torsion),
                }
            )  # fmt: skip
        out.append(rings)
    return out


def ring_shape(cage: CageParts, position: Array, built: Array) -> tuple[Array, float, float]:
    """Return the mean place of the collar (3), its ovality and its largest height out of its plane [m].

    Ovality is the largest less the smallest diameter across opposite knots over their mean [-], each diameter over
    that as built (places of all nodes ``built``): a square has none before it is pulled out of shape.
    """
    ring = position[cage.collar[0]]
    middle = ring.mean(axis=0)
    half = len(ring) // 2
    drawn = built[cage.collar[0]]
    across = np.linalg.norm(ring[:half] - ring[half : 2 * half], axis=1)
    across = across / np.linalg.norm(drawn[:half] - drawn[half : 2 * half], axis=1)
    _, _, axes = np.linalg.svd(ring - middle)
    warp = np.abs((ring - middle) @ axes[2])
    return middle, float((across.max() - across.min()) / across.mean()), float(warp.max())


def horizontal_balance(equilibrium: CageEquilibrium) -> tuple[Array, Array]:
    """Return the drag on all parts and the pull on all holds: they agree at equilibrium.

    Parameters
    ----------
    equilibrium : CageEquilibrium
        Of :func:`moyai.structures.solve_cage_equilibrium`.

    Returns
    -------
    tuple of ndarray
        Drag (parts, 3) and the sum of the pulls (3) [N].

    Examples
    --------
    >>> import moyai
    >>> from moyai.case import build
    >>> from moyai.structures import build_cage, horizontal_balance, solve_cage_equilibrium
    >>> model = build(moyai.load_case(moyai.template("cage"))).at_level(0.0)
    >>> drag, pull = horizontal_balance(solve_cage_equilibrium(model, build_cage(model), None))
    >>> bool(abs(drag).max() < 1.0)                                  # in still water [N]
    True
    """
    position = equilibrium.state.position
    water = Flow(current=equilibrium.current).at(0.0, position.T)
    split = drag_split(equilibrium.built, equilibrium.network, position, np.zeros_like(position), water)
    pull = pull_on_anchors(equilibrium.built, equilibrium.network, position, equilibrium.tension)
    return split, (pull + drag_on_holds(equilibrium.built, equilibrium.network, position, water)).sum(axis=0)


__all__ = [
    "PARTS", "CageEquilibrium", "collar_forces", "horizontal_balance", "ring_shape", "solve_cage_equilibrium",
]  # fmt: skip
