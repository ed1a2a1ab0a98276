"""The same network on a finer mesh that the plan itself gives, and its runs: nets with twice the knots, and bodies.

Bars of a net gather the twines of a strip. Cut in two they are no finer net: a half cell at each held row is still
left out, and slack bars send fronts of their own. Theory: docs/answer/network.md.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress
from moyai.coupled.equilibrium import CoupledEquilibrium
from moyai.flexible.elements import BarType
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.refine import refined
from moyai.flexible.result import Equilibrium, History, State
from moyai.flexible.sensitivity import PeakSensitivity
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.structures.network.assembly import Assembly, assemble
from moyai.structures.network.bodies import CoupledRun, rest_of, run_coupled
from moyai.structures.network.equilibrium import around, highest_of_run
from moyai.structures.network.held_rows import held_knots, held_of_run
from moyai.structures.network.model import NetPlan, NetworkProblem
from moyai.structures.network.refinement import affordable, damped_bars, fixed_points
from moyai.structures.network.runs import RunPlan

#: Steps of bodies that the runs which check a mesh may take together: a thousand take some twenty seconds.
BODY_STEPS = 8000
_KNOT = re.compile(r"^(.+)\[(\d+),(\d+)\]$")


def finer_problem(problem: NetworkProblem) -> NetworkProblem:
    """Return the problem with twice the cells of nets whose bars gather twines, of sheets, and segments of lines."""
    doubled = {net.name for net in problem.nets if net.strips is not None} | {sheet.name for sheet in problem.sheets}

    def knot(name: str) -> str:
        found = _KNOT.match(name)
        if found is None or found[1] not in doubled:
            return name
        return f"{found[1]}[{2 * int(found[2])},{2 * int(found[3])}]"

    lines = tuple(
        replace(
            line, start=knot(line.start), end=knot(line.end),
            parts=tuple(replace(part, segments=2 * part.segments) for part in line.parts),
        )
        for line in problem.lines
    )  # fmt: skip
    sheets = tuple(replace(one, rows=2 * one.rows - 1, columns=2 * one.columns - 1) for one in problem.sheets)
    return replace(problem, lines=lines, nets=tuple(map(_finer_net, problem.nets)), sheets=sheets)


def _finer_net(net: NetPlan) -> NetPlan:
    """Return a net with twice the cells each way: its bars gather half the twines. A net of ropes stays."""
    if net.strips is None:
        return net

    def half(bar: BarType) -> BarType:
        return replace(
            bar, mass_per_length=0.5 * bar.mass_per_length, axial_stiffness=0.5 * bar.axial_stiffness,
            diameter=0.5 * bar.diameter, volume_per_length=0.5 * bar.volume_per_length, viscosity=0.5 * bar.viscosity,
        )  # fmt: skip

    return replace(
        net, rows=2 * net.rows - 1, columns=2 * net.columns - 1, along=(half(net.along[0]), half(net.along[1])),
        across=(half(net.across[0]), half(net.across[1])), strips=(0.5 * net.strips[0], 0.5 * net.strips[1]),
    )  # fmt: skip


def _rest_of_nets(finer: Assembly, flow: Flow) -> Equilibrium:
    """Return the rest in a flow, from that in still water: a net that hangs finds it where one as built may not."""
    still = solve_equilibrium(finer.network, flow=Flow())
    return solve_equilibrium(finer.network, flow=flow, start=still.state)


@dataclass(frozen=True, eq=False)
class _Mesh:
    """A mesh, where runs on it start, and its bars by line and net."""

    assembly: Assembly
    network: Network
    start: State
    hung: CoupledEquilibrium | None
    parts: dict[str, NDArray[np.int64]]
    #: Width of the strips of the case over those of this mesh.
    share: float = 1.0


@dataclass(frozen=True)
class _Found:
    lines: dict[str, float]
    pulls: dict[str, float]
    held: dict[str, float]


def finer_is_useful(history: History, coupled: CoupledRun | None, doubtful: bool) -> bool:
    """Whether the runs of :func:`check_finer` take little time."""
    body_steps = 0.0 if coupled is None else (5.0 if doubtful else 4.0) * np.ptp(history.time) / coupled.step
    return affordable(history, doubtful) and body_steps <= BODY_STEPS


def check_finer(
    problem: NetworkProblem,
    assembly: Assembly,
    plan: RunPlan,
    starts: tuple[State, CoupledEquilibrium | None],
    made: tuple[History, CoupledRun | None],
    peak: tuple[str, str],
    motions: Mapping[str, Motion],
    options: Mapping[str, Any],
    progress: Progress,
) -> PeakSensitivity | None:
    """Run networks with bodies, or with nets whose bars gather twines, with half the step and on a finer mesh.

    Tensions of such nets are those of strips as wide as in the case.

    Parameters
    ----------
    problem, assembly, plan
    starts : State, CoupledEquilibrium
        Where the run begins.
    made : History, CoupledRun
        The run itself.
    peak : tuple of str
        Line or net with the highest tension, and why its peak is doubtful: where it is, a run on damped bars follows.
    motions, options, progress
        Of :func:`moyai.flexible.simulation.simulate`, or of the run with bodies.

    Returns
    -------
    PeakSensitivity or None
        ``None`` where a run had to stop, or nothing is left to compare.
    """
    (begin, hung), (history, coupled), (line, why) = starts, made, peak
    if not (history.time >= history.time[0] + plan.skip).any():
        return None
    own_parts = assembly.judged | dict(assembly.net_bars)
    own_mesh = _Mesh(assembly, history.network, begin, hung, own_parts)
    if not all(np.isin(bars, history.bars).all() for bars in own_parts.values()):
        return None
    own = _found(own_mesh, history, plan)

    def again(mesh: _Mesh, **more: Any) -> _Found:
        kept = np.unique(np.concatenate(list(mesh.parts.values())))
        nodes, next_bars = around(mesh.network, fixed_points(mesh.assembly, mesh.network))
        nodes = np.union1d(nodes, held_knots(mesh.assembly)) if mesh.assembly.net_bars else nodes
        chosen = {
            **options, **more, "keep_nodes": nodes if nodes.size else np.zeros(1, dtype=np.int64),
            "keep_bars": np.union1d(kept, next_bars),
        }  # fmt: skip
        if coupled is None:
            found = simulate(mesh.network, motions, start=mesh.start, progress=progress, **chosen)
        else:
            network = mesh.network if mesh.hung is None else mesh.hung.network
            rest = None if mesh.hung is None else replace(mesh.hung, network=replace(network, bars=mesh.network.bars))
            found = run_coupled(problem, mesh.network, rest, progress, motions=motions, **chosen).history
        if found.status == "interrupted":
            raise KeyboardInterrupt
        if found.status != "converged":
            raise ConvergenceError(found.message, parameter="sensitivity")
        return _found(mesh, found, plan)

    try:
        finer = _finer_mesh(problem, own_mesh, plan, coupled is not None)
        shorter = {} if options.get("step") is None else {"step": 0.5 * options["step"]}
        mesh = again(finer, **shorter)
        exact = options.get("safety") == 1.0 and coupled is None
        halved = {"step": 0.5 * history.step} | ({} if coupled is None else {"body_step": 0.5 * coupled.step})
        step = own if exact else again(own_mesh, **halved)
        calm = damped_bars(finer.network)
        calmed = _Found({}, {}, {})
        if not exact and calm is not finer.network and (why or coupled is None):
            calmed = again(replace(finer, network=calm), **shorter)
    except (ConvergenceError, InputError):
        return None

    def of(kind: str) -> dict[str, PeakSensitivity]:
        first, half, cut, damped = (getattr(item, kind) for item in (own, step, mesh, calmed))
        return {
            name: PeakSensitivity(
                first[name], half[name], cut[name], math.nan, math.nan, history.step, damped.get(name, math.nan)
            )
            for name in first.keys() & half.keys() & cut.keys()
        }  # fmt: skip

    every = of("lines")
    if line not in every:
        return None
    # at the start of a run that is not at rest another mesh jerks, and friction on the bed keeps that in the pulls
    pulls = {} if plan.equilibrium_flow is None else of("pulls")
    return replace(every[line], lines=every, pulls=pulls, held=of("held"))


def _found(mesh: _Mesh, history: History, plan: RunPlan) -> _Found:
    """Return the highest tensions, pulls on fixed points and on held rows of what counts of a run."""
    counted = history.time >= history.time[0] + plan.skip
    tension = np.full((int(counted.sum()), len(mesh.network.bars)), np.nan)
    tension[:, history.bars] = history.tension_peak[counted]
    lines = {name: float(np.nanmax(tension[:, mesh.parts[name]])) for name in mesh.assembly.judged}
    for name, own in zip(mesh.assembly.net_bars, mesh.assembly.net_tensions(tension), strict=True):
        scale = mesh.share if name in mesh.assembly.net_widths else 1.0
        lines[name] = scale * float(np.nanmax(own))
    pulls = highest_of_run(history, fixed_points(mesh.assembly, history.network), plan.skip)
    held = held_of_run(mesh.assembly, history, plan.skip) if mesh.assembly.net_bars else {}
    return _Found(lines, pulls, held)


def _finer_mesh(problem: NetworkProblem, own: _Mesh, plan: RunPlan, bodies: bool) -> _Mesh:
    """Return the finer mesh, begun at its own rest where the run begins at rest."""
    if problem.gathers_twines:
        finer = assemble(finer_problem(problem), own.assembly.level)
        network, start = finer.network, State.at_rest(finer.network)
        parts = finer.judged | dict(finer.net_bars)
        if plan.equilibrium_flow is not None and not bodies:
            start = _rest_of_nets(finer, plan.equilibrium_flow).state
        made = _Mesh(finer, network, start, None, parts, 2.0)
    else:
        network, start = refined(own.assembly.network, 2, own.start)
        parts = {name: np.concatenate([2 * bars, 2 * bars + 1]) for name, bars in own.parts.items()}
        made = _Mesh(own.assembly, network, start, None, parts)
    if bodies and plan.equilibrium_flow is not None:
        hung = rest_of(problem, network, plan.equilibrium_flow)
        made = replace(made, network=hung.network, start=hung.state, hung=hung)
    return made
