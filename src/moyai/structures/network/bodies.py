"""Rigid bodies hung in a network: their plans, their rest, their runs through time."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress
from moyai.coupled.assembly import RodPart
from moyai.coupled.bodies import BodyHistory, BodyState
from moyai.coupled.equilibrium import CoupledEquilibrium, find_coupled_equilibrium
from moyai.coupled.rigid import RigidBody
from moyai.coupled.simulate import CoupledHistory, simulate_coupled
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.refine import more_viscous, with_viscosity
from moyai.flexible.result import History, State
from moyai.flexible.sensitivity import PeakSensitivity, refined_start
from moyai.structures.network.body_plan import BodyPlan
from moyai.structures.network.model import NetworkProblem


def drawn_parts(bodies: Sequence[BodyPlan]) -> dict[str, tuple[Any, ...]]:
    """Return rods and volumes of assembled bodies as cylinders from end to end, for drawing."""
    rows: list[tuple[int, list[float], list[float], float]] = []
    for number, body in enumerate(bodies):
        for part in body.parts:
            if isinstance(part, RodPart):
                rows.append((number, list(part.start), list(part.end), part.diameter))
            elif part.volume > 0.0:
                # a volume as the cylinder that is as high as it is broad
                x, y, z = part.place
                broad = (4.0 * part.volume / math.pi) ** (1.0 / 3.0)
                rows.append((number, [x, y, z - 0.5 * broad], [x, y, z + 0.5 * broad], broad))
    if not rows:
        return {}
    owner, start, end, diameter = zip(*rows, strict=True)
    return {
        "solid_part_solid": ("solid_part", np.array(owner), {"units": "1", "long_name": "body of the part"}),
        "solid_part_start": (
            ("solid_part", "axis"), np.array(start), {"units": "m", "long_name": "one end, in axes of the body"}
        ),
        "solid_part_end": (
            ("solid_part", "axis"), np.array(end), {"units": "m", "long_name": "other end, in axes of the body"}
        ),
        "solid_part_diameter": ("solid_part", np.array(diameter), {"units": "m", "long_name": "diameter of the part"}),
    }  # fmt: skip


def rest_of(problem: NetworkProblem, network: Network, flow: Flow) -> CoupledEquilibrium:
    """Return network and bodies at rest.

    Raises
    ------
    ConvergenceError
        When there is no equilibrium.
    """
    bodies = {plan.name: plan.body(network.water) for plan in problem.bodies}
    return find_coupled_equilibrium(network, bodies, flow=flow)


@dataclass(frozen=True, eq=False)
class CoupledRun:
    """A run of bodies and network."""

    #: Of the network, as that of any network.
    history: History
    bodies: Mapping[str, BodyHistory]
    #: Where the bodies end.
    ends: Mapping[str, BodyState]
    #: Of the bodies [s].
    step: float


def _start(
    problem: NetworkProblem, network: Network, rest: CoupledEquilibrium | None
) -> tuple[dict[str, RigidBody], State, Network]:
    if rest is None:
        bodies = {plan.name: plan.body(network.water) for plan in problem.bodies}
        return bodies, State.at_rest(network), network
    return dict(rest.bodies), rest.state, rest.network


def run_coupled(
    problem: NetworkProblem,
    network: Network,
    rest: CoupledEquilibrium | None,
    progress: Progress,
    left: tuple[State, Mapping[str, BodyState]] | None = None,
    **options: Any,
) -> CoupledRun:
    """Run bodies and network through time, from rest or from where an earlier run left them.

    ``options`` are those of :func:`moyai.coupled.simulate.simulate_coupled`.

    Raises
    ------
    InputError
        When the earlier run had other bodies.
    """
    bodies, start, placed = _start(problem, network, rest)
    if left is not None:
        start, states = left
        if set(states) != set(bodies):
            raise InputError(
                f"the earlier result has the bodies {', '.join(states) or 'none'}, this network "
                f"{', '.join(bodies)}", parameter="settings.resume", allowed="a result of the same network",
            )  # fmt: skip
        flow = options.get("flow") or Flow()
        options["carriers"] = {
            name: state.carrier(bodies[name], placed.water, flow, start.time) for name, state in states.items()
        }
    found = simulate_coupled(placed, bodies, start=start, progress=progress, **options)
    return CoupledRun(_as_history(placed, found), found.bodies, found.final_bodies, found.body_step)


def _as_history(network: Network, found: CoupledHistory) -> History:
    record, rows = found.network, found.time.size
    return History(
        network, found.time, record.nodes, record.bars, record.position[:rows], record.tension[:rows],
        record.tension_peak[:rows], record.kinetic_energy[:rows], record.elastic_energy[:rows], record.work[:rows],
        found.final, "explicit, with bodies", found.network_step, found.network_steps,
        found.status, found.message, found.checks, found.notices,
    )  # fmt: skip


def _told(progress: Progress, before: int, what: str, done: float, total: float) -> None:
    progress("sensitivity", before + done / total, 5)


def coupled_sensitivity(
    problem: NetworkProblem,
    network: Network,
    rest: CoupledEquilibrium | None,
    bar: int,
    after: float,
    peak: float,
    steps: tuple[float, float],
    progress: Progress,
    equilibrium_flow: Flow | None,
    checked: PeakSensitivity | None = None,
    **options: Any,
) -> PeakSensitivity:
    """Run bodies and network with half of both steps, half the bars, half and twice the viscosity.

    Where step and mesh were ``checked`` the viscosity is left.

    ``steps`` are those of the run, of network and bodies [s], ``equilibrium_flow`` that in which the start is at rest;
    ``options`` are those of :func:`moyai.coupled.simulate.simulate_coupled`.

    Raises
    ------
    ConvergenceError
        When one of the runs had to stop.
    """
    bodies, start, placed = _start(problem, network, rest)
    last = any(strand.bars[-1] == bar and strand.bars.size > 1 for strand in placed.strands)
    finer, state = refined_start(placed, 2, start, equilibrium_flow)
    # a step given by hand is the longest that is stable on the given mesh
    shorter = {} if options.get("step") is None else {"step": 0.5 * options["step"]}
    cases: tuple[tuple[str, Network, State, int, dict[str, Any]], ...] = (
        ("half the step", placed, start, bar, {"step": 0.5 * steps[0], "body_step": 0.5 * steps[1]}),
        ("half the mesh", finer, state, 2 * bar + (1 if last else 0), shorter),
        ("half the viscosity", with_viscosity(placed, 0.5), start, bar, {}),
        ("twice the viscosity", more_viscous(placed), start, bar, {}),
    )
    cases = cases if checked is None else cases[2:]
    peaks = []
    for number, (which, mesh, begin, chosen, changed) in enumerate(cases, 5 - len(cases)):
        found = simulate_coupled(
            mesh, bodies, start=begin, keep_nodes=[0], keep_bars=[chosen], progress=partial(_told, progress, number),
            **{**options, **changed},
        )  # fmt: skip
        if found.status == "interrupted":
            raise KeyboardInterrupt
        if found.status != "converged":
            raise ConvergenceError(f"run with {which}: {found.message}", parameter="sensitivity")
        late = found.time >= found.time[0] + after
        peaks.append(float(np.max(found.network.tension_peak[: found.time.size][late, 0])))
    progress("sensitivity", 5, 5)
    if checked is not None:
        return replace(checked, half_viscosity=peaks[0], double_viscosity=peaks[1])
    half, mesh_peak, less, more = peaks
    return PeakSensitivity(peak, half, mesh_peak, less, more, steps[0])


def lean_of(angles: Array) -> Array:
    """Return the angle between the axis of a body and the vertical [rad] from its roll, pitch and yaw (..., 3)."""
    values: Array = np.arccos(np.clip(np.cos(angles[..., 0]) * np.cos(angles[..., 1]), -1.0, 1.0))
    return values
