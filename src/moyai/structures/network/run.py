"""Run a network: every water level, at rest, its modes, every sea through time."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.collected import Collected
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.headline import SEAS_LEFT_OUT
from moyai.core.progress import Progress, silent
from moyai.core.results import Result
from moyai.core.validity import IdentityCheck, Notice
from moyai.coupled.equilibrium import CoupledEquilibrium
from moyai.flexible.elements import DRIVEN, FIXED
from moyai.flexible.flow import Flow
from moyai.flexible.result import Equilibrium, State
from moyai.flexible.statics import solve_equilibrium
from moyai.structures.network.assembly import Assembly, assemble
from moyai.structures.network.bodies import drawn_parts, lean_of, rest_of
from moyai.structures.network.coefficients import loads_on_time, with_coefficients
from moyai.structures.network.dynamics import NetworkRun
from moyai.structures.network.dynamics import run as run_through_time
from moyai.structures.network.equilibrium import (
    bodies_at_rest,
    driven_names,
    modes_dataset,
    named_points,
    pulls,
    rest_dataset,
    stiffness_at_driven,
)
from moyai.structures.network.headlines import headlines_of, mesh_checked
from moyai.structures.network.held_rows import nets_at_rest
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.rest_mesh import coarse_rest, heavy_touchdown, with_finer_meshes
from moyai.structures.network.resume import earlier_run, read_earlier
from moyai.structures.network.run_notices import OVER, overturned, wet_in_air
from moyai.structures.network.runs import run_plans, steady_flow, theory_limit
from moyai.structures.network.summary import contacts_dataset, summary_dataset
from moyai.structures.network.variables import VOCABULARY, labelled

if TYPE_CHECKING:
    import xarray as xr

    from moyai.sea.water import Water

#: Driven points whose stiffness is taken, at most; sum of all forces at rest over the largest one.
MOST_STIFFNESSES, BALANCE = 6, 1e-4


def run(
    problem: NetworkProblem, progress: Progress = silent, *, coefficients: Mapping[str, xr.Dataset] | None = None
) -> Result:
    """Run all analyses of a network.

    Parameters
    ----------
    problem : NetworkProblem
    progress : Progress
        Called with the simulated time of every run. KeyboardInterrupt ends the work with what there is and the status
        ``interrupted``.
    coefficients : mapping of str to xarray.Dataset, optional
        Of the bodies whose loads come from a 3-D program, in the names of Capytaine.

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.

    Raises
    ------
    InputError
        For a network that cannot be built.
    """
    collected = Collected()
    problem, notices, checks = with_coefficients(problem, coefficients or {})
    collected.notices.extend(notices)
    collected.checks.extend(checks)
    collected.take(_steps(problem, collected, progress), "interrupted")
    return _result(problem, collected)


def _steps(problem: NetworkProblem, collected: Collected, progress: Progress) -> Iterator[None]:
    levels = problem.environment.water_levels
    if problem.bodies and "dynamic" in problem.settings.analyses:
        # waves that the loads do not have are reported before anything is run
        for _, level in levels:
            for plan in run_plans(problem, problem.environment.water_at(level)):
                collected.notices.extend(loads_on_time(problem, plan))

    def of_level(name: str, level: float) -> Callable[[Collected, Progress], Iterator[None]]:
        return lambda own, heard: _level_steps(problem, name, level, own, heard)

    yield from collected.take_together([of_level(*each) for each in levels], progress, "water levels")


def _level_steps(
    problem: NetworkProblem, name: str, level: float, collected: Collected, progress: Progress
) -> Iterator[None]:
    assembly, water = assemble(problem, level), problem.environment.water_at(level)
    root = f"/{name}"
    collected.groups[root] = _header(level, water)
    collected.groups[f"{root}/network"] = network_dataset(problem, assembly, water)
    said = f"water level {name}: " if len(problem.environment.water_levels) > 1 else ""
    rests, hung = _at_rest(problem, assembly, water, root, said, collected)
    yield
    if "modes" in problem.settings.analyses and rests:
        flow = steady_flow(problem, water) if "current" in rests else Flow()
        rest = rests.get("current", rests.get("still water"))
        assert rest is not None
        if problem.bodies:
            collected.groups[root].attrs["bodies_held"] = len(problem.bodies)
            collected.notices.append(
                Notice("bodies-held", "natural modes are those with the bodies held where they rest",
                       severity="information")
            )  # fmt: skip
        collected.groups[f"{root}/modes"] = modes_dataset(assembly, rest, flow, problem.settings.modes)
        yield
    if "dynamic" in problem.settings.analyses:
        yield from _dynamic(problem, assembly, water, (rests, hung), root, said, collected, progress)


def _header(level: float, water: Water) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset(attrs={"water_level": level, "water_depth": water.depth})


def network_dataset(problem: NetworkProblem, assembly: Assembly, water: Water) -> xr.Dataset:
    """Return the network itself: nodes, bars, lines, points."""
    import xarray as xr

    network, (names, nodes) = assembly.network, named_points(assembly)
    kinds = {FIXED: "fixed", DRIVEN: "driven"}
    plans = {point.name: point for point in problem.points}
    owner = np.full(len(network.bars), "", dtype=object)
    thin = np.zeros(len(network.bars), dtype=bool)
    for name, strand in assembly.lines.items():
        owner[strand.bars] = name
    for name, bars in assembly.net_bars.items():
        owner[bars], thin[bars] = name, True
    weight = np.array([kind.submerged_weight_per_length(water) for kind in network.bars.types])
    strands = list(assembly.lines.values())
    speed = network.bars.of_type("axial_stiffness"), network.bars.of_type("mass_per_length")
    celerity = np.sqrt(speed[0] / speed[1])
    attached = np.flatnonzero((network.nodes.mass > 0.0) | (network.nodes.volume > 0.0))
    data = {
        "node_position": (("node", "axis"), network.nodes.position),
        "node_mass": ("node", network.node_mass),
        "bar_start": ("bar", network.bars.start),
        "bar_end": ("bar", network.bars.end),
        "bar_length": ("bar", network.bars.length),
        "bar_line": ("bar", owner),
        "bar_thin": ("bar", thin),
        "line_length": ("line", np.array([network.bars.length[s.bars].sum() for s in strands])),
        "line_weight": (
            "line",
            np.array([(weight[network.bars.kind[s.bars]] * network.bars.length[s.bars]).sum() for s in strands]),
        ),
        "line_segments": ("line", np.array([s.bars.size for s in strands])),
        "wave_speed": ("line", np.array([celerity[s.bars].min() for s in strands])),
        "travel_time": (
            "line", np.array([float(np.sum(network.bars.length[s.bars] / celerity[s.bars])) for s in strands]),
        ),
        "breaking_load": ("line", np.array([line.breaking_load for line in problem.lines])),
        "point_node": ("point", nodes),
        "point_diameter": ("point", np.array([plans[n].diameter if n in plans else 0.0 for n in names])),
        "body_node": ("body", attached, {"units": "1", "long_name": "nodes that carry something"}),
        "body_height": ("body", network.nodes.height[attached], {"units": "m", "long_name": "its vertical extent"}),
        "body_volume": ("body", network.nodes.volume[attached], {"units": "m3", "long_name": "its volume"}),
        "body_mass": ("body", network.nodes.mass[attached], {"units": "kg", "long_name": "its mass"}),
    }  # fmt: skip
    carried = {name for body in problem.bodies for name in body.points}
    kind_names = np.array(
        ["on a body" if name in carried else kinds.get(int(network.nodes.kind[node]), "free")
         for name, node in zip(names, nodes, strict=True)], dtype=object,
    )  # fmt: skip
    if assembly.parts:
        loads = problem.strengths
        data["part_breaking_load"] = ("part", np.array([loads[name] for name in assembly.parts]))
    data["point_kind"] = ("point", kind_names, {"units": "1", "long_name": "what moves the point"})
    if assembly.net_bars:
        widths = [assembly.net_widths.get(name, math.nan) for name in assembly.net_bars]
        data["net_strip"] = ("net", np.array(widths))
    if network.sheets is not None:
        data["sheet_nodes"] = (
            ("triangle", "corner"),
            network.sheets.triangles,
            {"units": "1", "long_name": "nodes of the triangles of sheets"},
        )
    if problem.bodies:
        data["solid_size"] = (
            ("solid", "axis"),
            np.array([body.size for body in problem.bodies]),
            {"units": "m", "long_name": "size of the body along its axes"},
        )
        shapes = np.array([body.shape for body in problem.bodies], dtype=object)
        data["solid_shape"] = ("solid", shapes, {"units": "1", "long_name": "shape of the body"})
        data |= drawn_parts(problem.bodies)
    coords = {"axis": ["x", "y", "z"], "line": list(assembly.lines), "point": names}
    if assembly.parts:
        coords["part"] = list(assembly.parts)
    if assembly.net_bars:
        coords["net"] = list(assembly.net_bars)
    out = labelled(xr.Dataset(data, coords=coords))
    bed = network.bed
    # views show a bed that varies as deep as it is under the network
    lowest = math.nan if bed is None else float(np.min(bed.level_at(network.nodes.position)))
    out.attrs |= {"bed": lowest, "slack_level": problem.settings.slack_level}
    current = problem.environment.current
    surface = (0.0, 0.0) if current is None else tuple(float(v) for v in current.in_depth(water.depth).velocity(0.0))
    out.attrs |= {"current_x": surface[0], "current_y": surface[1]}
    return out


def _at_rest(
    problem: NetworkProblem, assembly: Assembly, water: Water, root: str, said: str, collected: Collected
) -> tuple[dict[str, Equilibrium], dict[str, CoupledEquilibrium]]:
    """Find the networks at rest that the analyses need; tell where there is none."""
    wanted = set(problem.settings.analyses)
    if not ({"statics", "modes"} & wanted) and problem.start == "as_built":
        return {}, {}
    conditions: dict[str, Flow] = {"still water": Flow()}
    if problem.environment.current is not None:
        conditions["current"] = steady_flow(problem, water)
    found: dict[str, Equilibrium] = {}
    hung: dict[str, CoupledEquilibrium] = {}
    for name, flow in conditions.items():
        begin = found["still water"].state if "still water" in found else None
        try:
            if problem.bodies:
                both = hung[name] = rest_of(problem, assembly.network, flow)
                found[name] = Equilibrium(both.state, both.tension, both.residual, both.rounds)
                for body in both.bodies.values():
                    lean = float(lean_of(np.asarray(body.rotation, dtype=float)))
                    if lean > OVER:
                        collected.notices.append(overturned(body.name, lean, f"rests in {name} turned by"))
            else:
                found[name] = solve_equilibrium(assembly.network, flow=flow, start=begin)
        except ConvergenceError as error:
            fault = error.fault
            collected.failures.append(f"{said}at rest in {name}: {fault.message}; {fault.remedy}".rstrip("; "))
            break
        rest = found[name]
        collected.checks.append(
            IdentityCheck(
                f"{said}equilibrium in {name}: forces left", rest.residual, BALANCE,
                "largest force left on a free node over the largest force at work",
            )
        )  # fmt: skip
        collected.notices.extend(wet_in_air(assembly.network, rest.state.position, said))
    if found and ("statics" in wanted):
        stiffness = _stiffness(problem, assembly, water, found, said, collected)
        rested = bodies_at_rest(nets_at_rest(rest_dataset(assembly, found, stiffness), assembly), hung)
        # the check of a run through time says nothing of its offset
        if "dynamic" not in wanted or heavy_touchdown(problem, assembly, found):
            rested = with_finer_meshes(rested, problem, assembly, found, conditions)
        if "dynamic" not in wanted:
            network = collected.groups[f"{root}/network"]
            collected.notices.extend(coarse_rest(rested, network, problem.settings.peak_goal, said))
        collected.groups[f"{root}/statics"] = rested
        _weight_check(assembly, found, said, collected)
    elif found and heavy_touchdown(problem, assembly, found):
        collected.groups[f"{root}/network"].attrs["heavy_touchdown"] = 1
    return found, hung


def _stiffness(
    problem: NetworkProblem,
    assembly: Assembly,
    water: Water,
    found: dict[str, Equilibrium],
    said: str,
    collected: Collected,
) -> np.ndarray | None:
    count = 0 if problem.bodies else len(driven_names(assembly))
    if count == 0:
        return None
    if count > MOST_STIFFNESSES:
        collected.notices.append(
            Notice(
                "stiffness-left-out",
                f"{said}the stiffness at {count} driven points was left out",
                count, MOST_STIFFNESSES, "information", "the stiffness is taken for few points only",
            )
        )  # fmt: skip
        return None
    name = list(found)[-1]
    flow = steady_flow(problem, water) if name == "current" else Flow()
    try:
        return stiffness_at_driven(assembly, found[name], flow, problem.settings.stiffness_step)
    except ConvergenceError as error:
        collected.notices.append(
            Notice("stiffness-failed", f"{said}stiffness at driven points: {error.fault.message}",
                   remedy="set the step of the stiffness")
        )  # fmt: skip
        return None


def _weight_check(assembly: Assembly, found: dict[str, Equilibrium], said: str, collected: Collected) -> None:
    """Compare the loads on all held points with the weight in water, where nothing lies on a bed or floats."""
    network = assembly.network
    carried = any(name in network.points for name in network.motion_names)
    if carried or network.sheets is not None or network.bed is not None or network.nodes.held.any():
        return
    rest = found.get("still water")
    if rest is None or np.any(rest.state.position[:, 2] + 0.5 * network.nodes.height > -1e-6):
        return
    held = np.flatnonzero(network.nodes.kind != 0)
    if held.size == 0:
        return
    pull = pulls(network, held, rest.state.position[None], rest.tension[None])[0, :, 2].sum()
    free = network.nodes.kind == 0
    weight = float(
        np.sum((network.node_mass - network.water.density * network.node_volume)[free]) * network.water.gravity
    )
    scale = max(abs(weight), 1e-3 * float(np.abs(rest.tension).max(initial=0.0)))
    collected.checks.append(
        IdentityCheck(
            f"{said}equilibrium in still water: weight", abs(float(pull) + weight) / max(scale, 1e-300), BALANCE,
            "upward pull on all held points equals minus the weight in water of what is free",
        )
    )  # fmt: skip


def _dynamic(
    problem: NetworkProblem,
    assembly: Assembly,
    water: Water,
    at_rest: tuple[dict[str, Equilibrium], dict[str, CoupledEquilibrium]],
    root: str,
    said: str,
    collected: Collected,
    progress: Progress,
) -> Iterator[None]:
    rests, hung = at_rest
    start = problem.start
    condition = "current" if start == "rest_in_current" and problem.environment.current is not None else "still water"
    if start != "as_built" and condition not in rests:
        collected.failures.append(
            f"{said}no run through time: there is no equilibrium to start from; the start 'as_built' needs none"
        )
        return
    begin = State.at_rest(assembly.network) if start == "as_built" else rests[condition].state
    _, nodes = named_points(assembly)
    # offsets count from still water, wherever the run starts: what the current does is a part of them
    still = rests.get("still water")
    origin = (begin if still is None else still.state).position[nodes]
    statics = collected.groups.get(f"{root}/statics")
    solids = None
    if statics is not None and "solid_position" in statics:
        solids = np.asarray(statics["solid_position"].sel(condition="still water"))
    runs: list[NetworkRun] = []
    earlier = None if problem.settings.resume is None else read_earlier(problem.settings.resume)
    for plan in run_plans(problem, water):
        collected.notices.extend(theory_limit(problem, plan))
        before = None if earlier is None else earlier_run(earlier, root[1:], plan.name, len(assembly.network.nodes))
        start_of_run = begin if before is None else before.state
        if before is not None and before.state.time >= plan.duration * (1.0 - 1e-9):
            raise InputError(
                f"the run '{plan.name}' of the earlier result is complete: it reached {before.state.time:g} s",
                parameter="settings.resume",
                remedy="lengthen the duration, or remove 'resume'",
            )
        item = run_through_time(
            problem,
            assembly,
            plan,
            start_of_run,
            progress,
            before,
            None if start == "as_built" else hung.get(condition),
            origin,
        )
        runs.append(item)
        collected.groups[f"{root}/time/{plan.name}"] = item.series
        collected.groups[f"{root}/time/{plan.name}/frames"] = item.frames
        contacts = contacts_dataset(item)
        if contacts is not None:
            collected.groups[f"{root}/time/{plan.name}/contacts"] = contacts
        collected.groups[f"{root}/dynamic"] = summary_dataset(problem, assembly, runs, origin, solids)
        collected.checks.extend(item.checks)
        collected.notices.extend(item.notices)
        if item.history.status == "not_converged":
            collected.failures.append(f"{said}{plan.name}: {item.history.message}")
        if item.failure:
            collected.failures.append(f"{said}{plan.name}: {item.failure}")
        if item.lowered:
            collected.on_the_safe_side.append(collected.failures[-1])
        if item.history.status == "interrupted":
            collected.interrupted = f"{said}{plan.name}: {item.history.message}"
            raise KeyboardInterrupt
        yield


def _not_run(problem: NetworkProblem) -> str:
    """Return what of the case only a run through time brings in; empty where there is nothing."""
    if problem.environment.sea_states:
        return SEAS_LEFT_OUT
    return "the motions of the case were not run" if problem.motions else ""


def _result(problem: NetworkProblem, collected: Collected) -> Result:
    if collected.interrupted:
        begun = any("/time/" in name for name in collected.groups)
        ahead = "; 'resume' continues from its last state" if begun else ""
        collected.interrupted += f"; what there was by then is kept{ahead}"
    attributes = {
        "structure": "network",
        "title": problem.title,
        "case_hash": problem.case_hash,
        "case_text": problem.case_text,
    }
    numbers = headlines_of(problem, collected.groups)
    checked = mesh_checked(collected.groups)
    return collected.close(
        VOCABULARY,
        attributes,
        [sea.seed for sea in problem.environment.sea_states if hasattr(sea, "seed")],
        fulfilled="all identities hold" + ("" if checked else "; mesh of the highest tension not checked"),
        headlines=numbers,
        criteria=problem.criteria,
        left_out="" if "dynamic" in problem.settings.analyses else _not_run(problem),
    )


__all__ = ["run"]
