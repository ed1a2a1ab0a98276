"""Further realisations of an irregular sea: snaps are chaotic, and the highest tension of one sea is no result."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from moyai.core.arrays import Array, BoolArray, IntArray
from moyai.core.progress import Progress
from moyai.core.validity import Notice
from moyai.flexible.ensemble import Ensemble, Member, members_together, simulate_together
from moyai.flexible.motion import Motion
from moyai.flexible.result import History, State
from moyai.sea.irregular import realisation_seed
from moyai.sea.states import IrregularSea
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.equilibrium import around, highest_pulls, named_points
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.runs import RunPlan, flow_of_seed
from moyai.structures.network.settling import PARTS_IN_A_SEA
from moyai.structures.network.single_anchor import single_anchors

#: Bars times steps, and nodes times waves times evaluations of the sea, that further realisations may take by
#: themselves, and of a run whose peak is doubtful; realisations at most and, where fewer fit, none.
WORK, DOUBTFUL_WORK, MOST, LEAST = 2e8, 4e8, 20, 4


@dataclass(frozen=True, eq=False)
class Realisations:
    """The largest values of runs through realisations of one sea, over what counts; that of the case is the first."""

    #: Shape (r,).
    seeds: IntArray
    #: Highest tension of each line [N]; shape (r, lines).
    tension: Array
    #: Highest tension of each part of lines whose parts differ in strength [N]; shape (r, parts).
    part_tension: Array
    #: Highest tension in each net [N]; shape (r, nets).
    net_tension: Array
    #: Largest pull on each point: size, level, upward and downward part [N]; shape (r, points, 4).
    load: Array
    #: Largest distance of each point from its place in still water [m]; shape (r, points).
    excursion: Array
    #: Largest horizontal distance of each point from the only fixed point that holds it [m], not a number of others;
    #: shape (r, points).
    reach: Array
    #: Distance of the mean place of each point in each fifth of what counts from that in still water [m]; shape (r, 5,
    #: points).
    way: Array

    def notices(self) -> list[Notice]:
        """Say how many could not be run."""
        lost = int(np.count_nonzero(~np.isfinite(self.excursion).all(axis=1)))
        if not lost:
            return []
        return [
            Notice(
                "realisations-lost",
                f"{lost} of {self.seeds.size} realisations blew up at the shortest step: means are those of the others",
                lost, 0, remedy="give a shorter step or more internal damping",
            )
        ]  # fmt: skip


def left_out(problem: NetworkProblem, plan: RunPlan, history: History) -> list[Notice]:
    """Say that realisations were asked for and are not run, where that is so."""
    asked = problem.settings.realisations or 1
    if asked < 2 or history.status != "converged" or not isinstance(_sea(problem, plan), IrregularSea):
        return []
    return [
        Notice(
            "realisations-left-out",
            f"of {asked} realisations one was run: bodies, nets with panels, sheets, slow ropes, lines that part, "
            "implicit methods and runs that continue earlier ones have no others",
            1, asked, remedy="run the case with other seeds, one by one",
        )
    ]  # fmt: skip


def _wanted(problem: NetworkProblem, plan: RunPlan, history: History, doubtful: bool) -> int:
    """Return how many realisations the case requires, or fit into what may be spent; 1 is the run of the case alone."""
    network, asked = history.network, problem.settings.realisations
    together = (
        isinstance(_sea(problem, plan), IrregularSea) and history.method == "explicit"
        and history.status == "converged" and not (problem.bodies or problem.failures) and members_together(network)
    )  # fmt: skip
    if not together:
        return 1
    if asked is not None:
        return asked
    components = 0 if plan.waves is None else len(plan.waves)
    evaluations = plan.duration / plan.flow.update_interval
    each = len(network.bars) * history.steps + len(network.nodes) * components * evaluations
    fit = 1 + int((DOUBTFUL_WORK if doubtful else WORK) / each)
    return 1 if fit < LEAST else min(fit, MOST)


def _sea(problem: NetworkProblem, plan: RunPlan) -> object:
    return next((sea for sea in problem.environment.sea_states if sea.name == plan.name), None)


def realisations_of(
    problem: NetworkProblem,
    assembly: Assembly,
    plan: RunPlan,
    history: History,
    motions: dict[str, Motion],
    starts: tuple[State, Array],
    doubtful: bool,
    progress: Progress,
) -> Realisations | None:
    """Run further realisations of an irregular sea, as many as the case requires or as take little time.

    Parameters
    ----------
    problem, assembly, plan
    history : History
        Of the run of the case itself.
    motions : dict of str to Motion
        Of driven points, the same in all.
    starts : State, ndarray (points, 3)
        Where the runs begin; places of the points in still water [m].
    doubtful : bool
        Whether the peak hangs on snaps or fronts, so that more may be spent on it.
    progress : Progress
        Called with the realisations that are done.

    Returns
    -------
    Realisations or None
        ``None`` where one run is all there is.
    """
    count = _wanted(problem, plan, history, doubtful)
    if count < 2:
        return None
    begin, origin = starts
    network = assembly.network
    nodes = _nodes(assembly)
    counted = history.time >= history.time[0] + plan.skip
    seeds = np.array([realisation_seed(plan.seed, number) for number in range(count)], dtype=np.int64)
    own = Ensemble(
        network, history.time, history.nodes, history.bars, history.position[None], history.tension[None],
        history.tension_peak[None], np.array([history.step]), np.zeros(1, dtype=np.int64),
    )  # fmt: skip
    anchors = _anchors(problem, assembly)
    rows = [_largest(assembly, own, 0, counted, origin, anchors)]
    # one after the other in groups, so that the series of all are never in memory
    group, words = max(1, members_together(network)), f"realisations, {plan.name}"
    for first in range(1, count, group):
        progress(words, first, count)
        chosen = seeds[first : first + group]
        flows = [flow_of_seed(problem, plan, network.water, int(seed)) for seed in chosen]
        found = simulate_together(
            network, [Member(motions, flow) for flow in flows], duration=plan.duration, output_step=plan.output_step,
            interval=plan.flow.update_interval, start=begin, step=problem.settings.step,
            safety=1.0 if problem.settings.wave_front else None, keep_nodes=nodes, drag_rate=history.drag_rate,
            progress=partial(_told, progress, words, first, count),
        )  # fmt: skip
        rows += [_largest(assembly, found, m, counted, origin, anchors) for m in range(len(flows))]
    progress(words, count, count)
    return Realisations(seeds, *(np.array(values) for values in zip(*rows, strict=True)))


def _told(progress: Progress, words: str, before: int, count: int, what: str, done: float, total: float) -> None:
    progress(words, before + done, count)


def _nodes(assembly: Assembly) -> IntArray:
    """Return the nodes of the points and those next to them."""
    names, points = named_points(assembly)
    return np.union1d(around(assembly.network, dict(zip(names, points, strict=True)))[0], points)


def _anchors(problem: NetworkProblem, assembly: Assembly) -> IntArray:
    """Return the node of the only fixed point that holds each point, -1 where there is none or another."""
    anchors, nodes = single_anchors(problem), assembly.network.points
    names, _ = named_points(assembly)
    return np.array([nodes[anchors[name]] if name in anchors else -1 for name in names], dtype=np.int64)


def _largest(
    assembly: Assembly, runs: Ensemble, member: int, counted: BoolArray, origin: Array, anchors: IntArray
) -> tuple[Array, ...]:
    """Return the highest tensions of lines, parts and nets, pulls on points, excursions, reach and way of one run."""
    network = assembly.network
    _, points = named_points(assembly)
    pull = runs.tension[member][counted]
    highest = np.fmax(runs.tension_peak[member][counted], pull)
    place = np.full((pull.shape[0], len(network.nodes), 3), np.nan)
    place[:, runs.nodes] = runs.position[member][counted]
    loads = highest_pulls(network, points, place, pull, highest)
    lines = [float(highest[:, strand.bars].max()) for strand in assembly.lines.values()]
    parts = [float(highest[:, strand.bars].max()) for strand in assembly.parts.values()]
    nets = [float(own.max()) for own in assembly.net_tensions(highest)]
    away = np.linalg.norm(place[:, points] - origin, axis=2)
    apart = np.linalg.norm((place[:, points] - place[:, anchors])[..., :2], axis=2).max(axis=0)
    reach = np.where(anchors >= 0, apart, np.nan)
    # too few rows for parts show no way
    pieces = np.array_split(place[:, points], PARTS_IN_A_SEA)
    means = [part.mean(axis=0) if len(part) else np.full(origin.shape, np.nan) for part in pieces]
    way = np.linalg.norm(np.array(means) - origin, axis=2)
    return np.array(lines), np.array(parts), np.array(nets), loads.max(axis=0), away.max(axis=0), reach, way
