"""Runs of a network through time, and the uncertainty of their peaks."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import at_once
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.coupled.equilibrium import CoupledEquilibrium
from moyai.flexible.motion import Motion
from moyai.flexible.result import History, State
from moyai.flexible.sensitivity import PeakSensitivity, peak_sensitivity
from moyai.flexible.simulation import simulate
from moyai.series.snaps import SnapRecord
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.bodies import CoupledRun, coupled_sensitivity, run_coupled
from moyai.structures.network.finer import check_finer, finer_is_useful
from moyai.structures.network.model import NetworkProblem
from moyai.structures.network.realisations import Realisations, left_out, realisations_of
from moyai.structures.network.refinement import (
    LANDING,
    affordable,
    band_of,
    check_event,
    check_peak,
    doubt,
    few_bars,
    lowered,
    not_converged,
    unchecked,
)
from moyai.structures.network.resume import Earlier, joined, last_good_state, with_ends
from moyai.structures.network.run_notices import capsized, peak_inside, realised_low, run_notices
from moyai.structures.network.runs import RunPlan, motions_of
from moyai.structures.network.series import frames_of, kept_nodes, series_of, snaps_of, utilisations, with_bodies
from moyai.structures.network.settling import drift_of_all, led_points, settled

if TYPE_CHECKING:
    import xarray as xr


#: What is known of the accuracy of a peak, what is to be reported, and the history, marked where the user ended it.
_Accuracy = tuple[PeakSensitivity | None, list[Notice], History]


@dataclass(frozen=True, eq=False)
class NetworkRun:
    """A run and what is reported of it."""

    plan: RunPlan
    history: History
    #: Time series of lines and points.
    series: xr.Dataset
    #: Places of all nodes and tensions of all bars at fewer times.
    frames: xr.Dataset
    #: By line.
    snaps: Mapping[str, SnapRecord]
    #: Of the line with the highest tension.
    sensitivity: PeakSensitivity | None
    #: That line.
    governing: str
    notices: tuple[Notice, ...]
    checks: tuple[IdentityCheck, ...]
    #: Why the peak may hang on mesh and step; empty where nothing says so.
    doubt: str = ""
    #: Why the peak is not converged; empty where it is, or was not checked.
    failure: str = ""
    #: Whether finer runs all give less, so that the peak is on the safe side.
    lowered: bool = False
    #: Largest values of further realisations of its sea.
    realisations: Realisations | None = None
    #: Lines of so few bars that their peaks are doubtful, and how many.
    few_bars: Mapping[str, str] = field(default_factory=dict)


def options_of(problem: NetworkProblem, plan: RunPlan) -> dict[str, Any]:
    """Return the arguments of :func:`moyai.flexible.simulation.simulate` for a run."""
    settings = problem.settings
    method = "explicit" if settings.method == "auto" else settings.method
    return {
        "duration": plan.duration,
        "output_step": plan.output_step,
        "flow": plan.flow,
        "method": method,
        "step": settings.step,
        "safety": 1.0 if settings.wave_front and method == "explicit" else None,
        "tolerance": settings.tolerance,
        "failures": problem.failures,
    }


def run(
    problem: NetworkProblem,
    assembly: Assembly,
    plan: RunPlan,
    begin: State,
    progress: Progress = silent,
    earlier: Earlier | None = None,
    hung: CoupledEquilibrium | None = None,
    still: Array | None = None,
) -> NetworkRun:
    """Run a network through time and gather what is reported of it.

    Parameters
    ----------
    problem : NetworkProblem
    assembly : Assembly
    plan : RunPlan
    begin : State
        Where it starts.
    progress : Progress
    earlier : Earlier, optional
        Rows of the same run up to ``begin``.
    hung : CoupledRest, optional
        Bodies and network at rest, where a run with bodies starts; as built when left out.
    still : ndarray, shape (points, 3), optional
        Places of the points at rest in still water [m]; without them no further realisations are run.

    Raises
    ------
    InputError
        When a table of motion ends before the run.
    """
    network = assembly.network
    motions = motions_of(problem, plan.duration)
    nodes = kept_nodes(assembly, round(plan.duration / plan.output_step) + 1)

    def reported(what: str, done: float, total: float) -> None:
        progress(plan.name, done, total)

    options = {**options_of(problem, plan), "duration": plan.duration - begin.time}
    coupled: CoupledRun | None = None
    if problem.bodies:
        options = _of_bodies(options)
        left = None if earlier is None else (earlier.state, earlier.bodies)
        coupled = run_coupled(problem, network, hung, reported, left, motions=motions, keep_nodes=nodes, **options)
        history = coupled.history
    else:
        history = simulate(
            network, motions, start=begin, progress=reported, keep_nodes=nodes, counted_from=plan.skip - begin.time,
            **options,
        )  # fmt: skip
    progress(plan.name, 1.0, 1.0)
    if history.status == "not_converged":
        history = sound_rows(history)
    series, frames = series_of(assembly, plan, history), frames_of(plan, history)
    if coupled is not None:
        series, frames = with_bodies(series, with_ends(frames, coupled.ends), coupled)
    series.attrs |= {"skip": plan.skip, "skip_rule": plan.skip_rule}
    if earlier is not None:
        series, frames = joined(earlier.series, series, "time"), joined(earlier.frames, frames, "frame")
    plan, drift = settled(problem, plan, series, still)
    series.attrs |= {"skip": plan.skip, "skip_rule": plan.skip_rule, "unsettled": drift.words()}
    snaps = snaps_of(problem, series)
    governing = _governing(problem, series)
    worst = _worst_bar(assembly, history, governing, plan.skip)
    notices = [*history.notices, *run_notices(problem, history, plan, snaps)]
    notices += peak_inside(assembly, series, governing, worst)
    notices += realised_low(series) + drift.notices()
    if coupled is not None:
        notices += capsized(series)
    why = doubt(assembly, history, snaps, governing)
    starts, peak = (begin, still if earlier is None else None), (governing, worst, why)

    def find_accuracy(heard: Progress) -> _Accuracy:
        return _peak_uncertainty(problem, assembly, plan, (begin, hung), (history, coupled), peak, earlier, heard)

    (sensitivity, found, history), others = _accuracy_and_others(
        problem, assembly, plan, history, motions, starts, bool(why), find_accuracy, progress
    )
    notices += found
    notices += left_out(problem, plan, history) if others is None else others.notices()
    if others is not None and not drift.point and problem.current_field is None:
        names = [str(name) for name in series["point"].values]
        led = led_points(problem, names)
        drift = drift_of_all(others.way, others.excursion, names, led, plan.duration - plan.skip)
        series.attrs["unsettled"] = drift.words()
        notices += drift.notices()
    few = {name: said for name in assembly.judged if (said := few_bars(assembly, assembly.line_of(name)))}
    failure, safe = _failure(problem, assembly, sensitivity, governing, {**few, governing: why})
    prefix = f"{plan.name}: "
    return NetworkRun(
        plan, history, series, frames, snaps, sensitivity, governing,
        tuple(replace(notice, message=f"{prefix}{notice.message}") for notice in notices),
        tuple(replace(check, name=f"{prefix}{check.name}") for check in history.checks), why, failure, safe, others,
        few,
    )  # fmt: skip


def _accuracy_and_others(
    problem: NetworkProblem,
    assembly: Assembly,
    plan: RunPlan,
    history: History,
    motions: dict[str, Motion],
    starts: tuple[State, Array | None],
    doubtful: bool,
    find_accuracy: Callable[[Progress], _Accuracy],
    progress: Progress,
) -> tuple[_Accuracy, Realisations | None]:
    """Find the accuracy of a peak and run further realisations, both at once; none without places in still water.

    The history is marked where the user ended this part.
    """
    accuracy: list[_Accuracy] = []
    further: list[Realisations | None] = []
    begin, still = starts

    def one(number: int, heard: Progress) -> None:
        def told(what: str, done: float, total: float) -> None:
            heard(f"accuracy, {plan.name}", done, total)

        if number == 0:
            accuracy.append(find_accuracy(told))
        elif still is not None:
            given = motions, (begin, still), doubtful
            further.append(realisations_of(problem, assembly, plan, history, *given, heard))

    message = ""
    try:
        at_once(one, 2, progress)
    except KeyboardInterrupt:
        message = "interrupted while further realisations were run; the run itself is complete"
    sensitivity, notices, history = accuracy[0] if accuracy else (None, [], history)
    if message and history.status == "converged":
        history = replace(history, status="interrupted", message=message)
    return (sensitivity, notices, history), further[0] if further else None


def _failure(
    problem: NetworkProblem,
    assembly: Assembly,
    found: PeakSensitivity | None,
    governing: str,
    doubts: Mapping[str, str],
) -> tuple[str, bool]:
    """Return why a peak is not converged, empty where all are, and whether finer runs give less of each that is not.

    Counted are the governing line and those that finer runs bring as near to their breaking load, or as high.
    """
    if found is None:
        return "", False
    goal, strengths = problem.settings.peak_goal, problem.strengths
    every = {**found.lines, governing: found}
    if assembly.lines and not any(line.without_strength for line in problem.lines):
        # nets have no breaking load here, nor lines whose parts differ
        uses = {name: (one.peak / load, band_of(one)[1] / load) for name, one in every.items()
                if (load := strengths.get(name))}  # fmt: skip
    else:
        uses = {name: (one.peak, band_of(one)[1]) for name, one in every.items() if name not in assembly.parts}
    worst = max((own for name, (own, _) in uses.items() if assembly.line_of(name) == governing), default=0.0)
    near = [name for name in every if name == governing or (name in uses and uses[name][1] >= worst)]
    failures, safe = [], True
    for name in sorted(near, key=lambda one: one != governing):
        bars = assembly.judged.get(name)
        segments = 0 if bars is None else bars.size
        words = not_converged(every[name], goal, name, doubts.get(name, ""), segments, problem.gathers_twines)
        if words:
            failures.append(words)
            safe = safe and lowered(every[name], goal)
    if not failures:
        return "", False
    return failures[0] + ("; finer runs give less, the design is judged at the larger peak" if safe else ""), safe


def _peak_uncertainty(
    problem: NetworkProblem,
    assembly: Assembly,
    plan: RunPlan,
    starts: tuple[State, CoupledEquilibrium | None],
    made: tuple[History, CoupledRun | None],
    peak: tuple[str, int, str],
    earlier: Earlier | None,
    reported: Progress,
) -> _Accuracy:
    """Find the uncertainty of the peak of a run: as asked for, or as far as it costs little.

    ``peak`` is the line, its bar and why the peak is doubtful. Returns what was found, what is to be reported, and the
    history, marked where the user ended this part.
    """
    (governing, worst, why), (history, coupled) = peak, made
    if history.status != "converged" or worst < 0:
        return None, [], history
    asked = problem.settings.sensitivity
    if earlier is not None:
        if not asked:
            return None, [], history
        return None, [
            Notice("sensitivity-left-out", "accuracy of the peak not found: the run continues an earlier one",
                   severity="information", remedy="run it from its start with a sensitivity run")
        ], history  # fmt: skip
    try:
        motions = motions_of(problem, plan.duration)
        options = options_of(problem, plan) if coupled is None else _of_bodies(options_of(problem, plan))
        netted = problem.gathers_twines
        wanted = problem.settings.mesh_check == "auto" and finer_is_useful(history, coupled, bool(why))
        checked: PeakSensitivity | None = None
        if (netted or coupled is not None) and (asked or wanted):
            of = (governing, why)
            checked = check_finer(problem, assembly, plan, starts, made, of, motions, options, reported)
        if asked and not netted:
            found = _sensitivity(problem, assembly, plan, starts, made, worst, reported, checked)
            return found, list(found.notices()), history
        if checked is not None:
            return checked, [], history
        off = problem.settings.mesh_check == "off"
        if off or netted or coupled is not None:
            return None, [unchecked(why, off=off)] if why else [], history
        event = (governing, plan.skip, plan.period, options, reported, why)
        checked = check_event(assembly, history, motions, *event) if LANDING in why else None
        few = any(few_bars(assembly, name) for name in assembly.lines)
        if checked is None and affordable(history, bool(why) or few):
            checked = check_peak(
                assembly, history, motions, governing, starts[0], plan.skip, options, reported, plan.equilibrium_flow
            )
        elif checked is None and LANDING not in why:
            checked = check_event(assembly, history, motions, *event)
        return checked, [unchecked(why)] if checked is None and why else [], history
    except (ConvergenceError, InputError) as error:
        return None, [Notice("sensitivity-failed", error.fault.message, remedy=error.fault.remedy)], history
    except KeyboardInterrupt:
        message = "interrupted while the accuracy of its peak was found; the run itself is complete"
        return None, [], replace(history, status="interrupted", message=message)


def sound_rows(history: History) -> History:
    """Return a run that blew up without what came after its last good state: no peak is taken from there."""
    good = int(np.count_nonzero(history.time <= last_good_state(history).time * (1.0 + 1e-12)))
    rows = ("time", "position", "tension", "tension_peak", "kinetic_energy", "elastic_energy", "work")
    cut = {name: getattr(history, name)[: max(good, 1)] for name in rows}
    return replace(history, **cut)


def _of_bodies(options: dict[str, Any]) -> dict[str, Any]:
    """Return the options that runs with bodies know: they have one method and a tolerance of their own."""
    return {key: value for key, value in options.items() if key not in ("method", "tolerance", "failures")}


def _sensitivity(
    problem: NetworkProblem,
    assembly: Assembly,
    plan: RunPlan,
    starts: tuple[State, CoupledEquilibrium | None],
    made: tuple[History, CoupledRun | None],
    bar: int,
    progress: Progress,
    checked: PeakSensitivity | None,
) -> PeakSensitivity:
    """Run again with half the step, half the bars, half and twice the viscosity; with bodies what was not checked."""
    (begin, hung), (history, coupled) = starts, made
    after, motions = plan.skip, motions_of(problem, plan.duration)
    options = options_of(problem, plan)
    if coupled is not None:
        peak = float(np.nanmax(history.peak_at(bar)[history.time >= after]))
        return coupled_sensitivity(
            problem, assembly.network, hung, bar, after, peak, (history.step, coupled.step), progress,
            plan.equilibrium_flow, checked, motions=motions, **_of_bodies(options),
        )  # fmt: skip
    # built anew, the finer network may drop what its materials gathered: the plain call refines the network itself
    return peak_sensitivity(
        assembly.network, motions, bar=bar, after=after, start=begin, equilibrium_flow=plan.equilibrium_flow,
        progress=progress, **options,
    )  # fmt: skip


def _governing(problem: NetworkProblem, series: xr.Dataset) -> str:
    """Return the line that comes nearest to its breaking load, or the line or net with the highest tension.

    The first where every line has a breaking load: it decides whether the design holds. Rows of an earlier run count.
    """
    counted = series["time"].values >= series["time"].values[0] + series.attrs["skip"]
    best, highest = "", -np.inf
    for key, names in (("line_tension_peak_since_row", "line"), ("net_tension", "net")):
        if key not in series or not counted.any() or not series.sizes[names]:
            continue
        values = np.nan_to_num(series[key].values[counted], nan=-np.inf).max(axis=0)
        if names == "line":
            uses = utilisations(problem, series, counted)
            if all(map(math.isfinite, uses.values())):
                # nets have no breaking load here and come after the lines
                return max(uses, key=lambda name: uses[name])
        if values.max() > highest:
            best, highest = str(series[names].values[int(np.argmax(values))]), float(values.max())
    return best


def _worst_bar(assembly: Assembly, history: History, name: str, skip: float) -> int:
    """Return the bar of a line or net that bore most in the rows of this run that count, -1 without any."""
    chosen = history.time >= skip
    strand = assembly.lines.get(name)
    bars = strand.bars if strand is not None else assembly.net_bars.get(name, np.zeros(0, dtype=np.int64))
    columns = np.flatnonzero(np.isin(history.bars, bars))
    if not chosen.any() or columns.size == 0:
        return -1
    peaks = np.nan_to_num(history.tension_peak[chosen][:, columns], nan=-np.inf).max(axis=0)
    return int(history.bars[columns[int(np.argmax(peaks))]])
