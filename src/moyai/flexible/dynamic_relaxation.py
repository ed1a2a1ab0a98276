"""Rest of nets in a current by dynamic relaxation on the explicit kernels."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.errors import ConvergenceError
from moyai.core.progress import Progress, silent
from moyai.flexible.arrays import bed_at_rest
from moyai.flexible.dynamic_relaxation_kernel import relax
from moyai.flexible.explicit import ExplicitRun
from moyai.flexible.explicit_rows import PULL, WU
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network, name_of_node
from moyai.flexible.result import Equilibrium, State
from moyai.flexible.sheet_kernel import sheet_stiffness, stress_field

#: Steps between two evaluations of the loads of the water, and between two looks at the current and the surface.
EVERY, CHUNK = 5, 500
#: Part of the pseudo velocity kept in a step, from how many steps on: slack net may flutter without any damping.
KEEP = ((0, 1.0), (5_000, 0.999), (12_000, 0.998), (25_000, 0.996))


def relax_network(
    network: Network,
    *,
    flow: Flow | None = None,
    start: State | None = None,
    tolerance: float = 1e-6,
    good_enough: float = 1e-3,
    most_steps: int = 200_000,
    progress: Progress = silent,
) -> Equilibrium:
    """Find a net, its ropes and floats at rest in a steady current.

    Every node gets the mass for which a pseudo step of one is stable, and the motion is stopped whenever its kinetic
    energy has passed a peak [eq:cage-relaxation]. It requires no matrix and finds slack nets, whose tangent is
    singular.

    Parameters
    ----------
    network : Network
    flow : Flow, optional
        Steady current; waves are left out.
    start : State, optional
        First guess; as built when left out.
    tolerance : float
        Force left on a free node over the largest tension.
    good_enough : float
        What is returned as well when the steps are used up.
    most_steps : int
        Pseudo steps before it gives up.
    progress : Progress

    Raises
    ------
    ConvergenceError
        When the forces stay above ``good_enough``; the message names the node.
    """
    calm = Flow() if flow is None else Flow(flow.velocity, flow.current)
    still = Motion(0.0, 1.0, np.zeros((2, 3)), np.zeros((2, 3)))
    state = State.at_rest(network) if start is None else State(0.0, start.position, np.zeros_like(start.position))
    run = ExplicitRun(network, dict.fromkeys(network.motion_names, still), calm, state, safety=1.0, load_steps=1)
    packed, arrays = run.packed, run.arrays
    bare = _masses(run)
    pace = np.zeros((3, len(network.nodes)))
    bed = bed_at_rest(network)
    fluid = np.array([network.water.density, network.water.gravity])
    done, left, worst, reference = 0, math.inf, 0, 1.0
    while done < most_steps:
        run.water = calm.at(0.0, run.place)
        mass = bare + 1.1 * _sheet_masses(run)
        packed.node_rows(WU, 7)[:] = run.water
        taken, left, worst = relax(
            packed.memory, packed.sizes, packed.runs, arrays.curves, arrays.hinges, arrays.bending, arrays.attached,
            fluid, run.near_surface(), run.parts, bed, mass, pace, CHUNK, EVERY, tolerance * reference,
            next(keep for begin, keep in reversed(KEEP) if done >= begin),
        )  # fmt: skip
        done += taken
        reference = max(float(np.max(np.abs(packed.bar_row(PULL)), initial=0.0)), _sheet_pull(run), 1e-9)
        if not np.isfinite(run.place).all() or left <= tolerance * reference:
            break
        progress("rest", done, most_steps)
    residual = left / reference
    if not (residual <= max(tolerance, good_enough) and np.isfinite(run.place).all()):
        raise ConvergenceError(
            f"no equilibrium after {done} steps: {residual:.2g} of the largest tension is left at "
            f"{name_of_node(network, int(worst))}",
            parameter="statics",
            allowed=f"at most {good_enough:g}",
            remedy="look for a part that floats away or lines that cannot reach",
        )
    place = run.place.T.copy()
    tension = packed.bar_row(PULL)
    return Equilibrium(State(0.0, place, np.zeros_like(place)), tension, float(residual), done)


def _masses(run: ExplicitRun) -> np.ndarray:
    """Return the masses for which a pseudo step of one is stable: half the sum of twice the stiffness at a node."""
    arrays, count = run.arrays, len(run.network.nodes)
    mass = np.zeros(count)
    for end in (arrays.start, arrays.end):
        np.add.at(mass, end, arrays.greatest_spring)
    triples, stiffness = run.rings.hinges
    for which, part in ((0, 1.0), (1, 2.0), (2, 1.0)):
        np.add.at(mass, triples[:, which], 8.0 * part * stiffness[:, 0] * stiffness[:, 1] ** 2)
        np.add.at(
            mass,
            arrays.hinges[:, which],
            8.0 * part * arrays.bending[:, 0] * np.max(arrays.bending[:, 1:], axis=1) ** 2,
        )
    lift = run.network.water.density * run.network.water.gravity
    with np.errstate(divide="ignore", invalid="ignore"):
        bob = np.where(arrays.node("height") > 0.0, 1.5 * lift * arrays.node("volume") / arrays.node("height"), 0.0)
    mass += arrays.node("bed_stiffness") + bob
    for end in (arrays.start, arrays.end):
        np.add.at(mass, end, arrays.bar("buoyancy") / arrays.bar("radius"))
    return 1.1 * mass + 1e-9


def _sheet_masses(run: ExplicitRun) -> np.ndarray:
    """Return what the triangles as they lie now ask for, by a bound of their stiffness (that of taut ones)."""
    stiff, damp = np.zeros((len(run.network.nodes), 6)), np.zeros((len(run.network.nodes), 6))
    if run.parts[2] is not None:
        sheet_stiffness(run.sheets[0], run.sheets[1], run.place, stiff, damp)
    # the trace of a block is no less than its largest value
    return np.asarray(stiff[:, 0] + stiff[:, 3] + stiff[:, 5])


def _sheet_pull(run: ExplicitRun) -> float:
    """Return the largest pull of a triangle [N]."""
    sheets = run.network.sheets
    if sheets is None:
        return 0.0
    out = np.empty((len(sheets), 6))
    stress_field(run.sheets[0], run.sheets[1], np.ascontiguousarray(run.place.T), out)
    return float(np.max(out[:, 3] * np.sqrt(2.0 * sheets.area)))
