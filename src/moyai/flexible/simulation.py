"""Run a network through time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from os import PathLike
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck
from moyai.flexible.explicit import LOAD_STEPS, ExplicitRun
from moyai.flexible.failures import LOOK, Failing, LineFailure
from moyai.flexible.flow import Flow
from moyai.flexible.implicit import TOLERANCE, ImplicitRun
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network, check_network, name_of_node
from moyai.flexible.numbers import whole_number, whole_numbers
from moyai.flexible.peak_notices import advice, peak_notices, stable_step
from moyai.flexible.recovery import write_state
from moyai.flexible.result import History, RunStatus, State

#: Of the rows so far: times [s], places (k, nodes, 3) [m], highest tensions since the row before (k, bars) [N].
Enough = Callable[[np.ndarray, np.ndarray, np.ndarray], bool]

Method = Literal["explicit", "tr_bdf2", "esdirk4"]

#: Energy balance error, as a part of the energy that went through the network: what is called good, and what stops a
#: run.
ENERGY_TOLERANCE, ENERGY_STOP = 0.02, 0.25
#: Longest time over which step, drag and nearness of the surface are taken as they were at its start [s].
LONGEST_LOOK = 1.0


def rows_of(duration: float, output_step: float) -> tuple[int, float]:
    """Return the number of rows of a result and their spacing [s], moved a little so that they fill the run."""
    if not (math.isfinite(duration) and duration > 0.0):
        raise InputError(f"duration is {duration:g} s", parameter="duration", allowed="greater than 0")
    if not (math.isfinite(output_step) and output_step > 0.0):
        raise InputError(f"output step is {output_step:g} s", parameter="output_step", allowed="greater than 0")
    rows = max(1, round(duration / output_step))
    return rows, duration / rows


def check_motions(network: Network, motions: Mapping[str, Motion], start: float, end: float) -> None:
    """Refuse motions that are missing, unknown or too short."""
    for name in network.motion_names:
        if name not in motions:
            raise InputError(
                f"driven points follow the motion {name!r}, which is not given",
                parameter="motions",
                allowed=", ".join(network.motion_names),
            )
        motion = motions[name]
        slack = 1e-9 * max(1.0, abs(end))
        if motion.start > start + slack or motion.end < end - slack:
            raise InputError(
                f"motion {name!r} covers {motion.start:g} to {motion.end:g} s, the run {start:g} to {end:g} s",
                parameter=f"motions.{name}",
                allowed="a motion over the whole run",
                remedy="shorten the run or lengthen the motion",
            )
    for name in motions:
        if name not in network.motion_names:
            raise InputError(
                f"no point follows a motion {name!r}",
                parameter="motions",
                allowed=", ".join(network.motion_names) or "none",
            )


def check_start(network: Network, start: State) -> None:
    """Refuse a state that is not one of the network."""
    if not math.isfinite(start.time):
        raise InputError(f"time of the start is {start.time:g} s", parameter="start.time", allowed="a finite time")
    for name in ("position", "velocity"):
        values = np.asarray(getattr(start, name))
        if values.shape != (len(network.nodes), 3):
            raise InputError(
                f"{name} of the start has shape {values.shape}",
                parameter=f"start.{name}",
                allowed=f"({len(network.nodes)}, 3), a state of this network",
            )
        if not np.isfinite(values).all():
            node = int(np.flatnonzero(~np.isfinite(values).all(axis=1))[0])
            raise InputError(
                f"{name} of {name_of_node(network, node)} at the start is not finite",
                parameter=f"start.{name}",
                allowed="finite numbers",
            )


def check_step(step: float | None, safety: float | None, shorter: float = 1.0) -> None:
    """Refuse a step, a part of the stable one, or a factor on all steps, out of range."""
    if step is not None and not 0.0 < step < math.inf:
        raise InputError(f"step is {step:g} s", parameter="step", allowed="greater than 0")
    if safety is not None and not 0.0 < safety <= 1.0:
        raise InputError(f"safety is {safety:g}", parameter="safety", allowed="above 0, at most 1")
    if not 0.0 < shorter <= 1.0:
        raise InputError(f"shorter is {shorter:g}", parameter="shorter", allowed="above 0, at most 1")


def kept_numbers(given: ArrayLike | None, count: int, path: str) -> np.ndarray:
    """Return the numbers of the nodes or bars that a result keeps, all of them when nothing was given."""
    if given is None:
        return np.arange(count)
    kept = np.atleast_1d(whole_numbers(given, path))
    if kept.ndim != 1:
        raise InputError(f"{path} has shape {kept.shape}", parameter=path, allowed="one row of numbers")
    wrong = kept[(kept < 0) | (kept >= count)]
    if wrong.size:
        raise InputError(f"{path} names {int(wrong[0])} of {count}", parameter=path, allowed=f"0 to {count - 1}")
    return kept


@checks_words
def simulate(
    network: Network,
    motions: Mapping[str, Motion] | None = None,
    *,
    duration: float,
    output_step: float,
    flow: Flow | None = None,
    start: State | None = None,
    method: Method = "explicit",
    step: float | None = None,
    safety: float | None = None,
    shorter: float = 1.0,
    load_steps: int = LOAD_STEPS,
    tolerance: float = TOLERANCE,
    keep_nodes: ArrayLike | None = None,
    keep_bars: ArrayLike | None = None,
    state_file: str | PathLike[str] | None = None,
    failures: Sequence[LineFailure] = (),
    counted_from: float = 0.0,
    enough: Enough | None = None,
    progress: Progress = silent,
) -> History:
    """Run a network through time [eq:flexible-leapfrog] [eq:flexible-dirk].

    Parameters
    ----------
    network : Network
        The network.
    motions : mapping of str to Motion, optional
        One for every name in ``network.motion_names``.
    duration, output_step : float
        Length of the run and spacing of the rows of the result [s], moved a little so that rows fill the run; peaks are
        taken at every step all the same.
    flow : Flow, optional
        Motion of the water; still water when left out.
    start : State, optional
        Where to start; as built, without speed, when left out (:func:`moyai.flexible.statics.solve_equilibrium`
        gives the equilibrium).
    method : {"explicit", "tr_bdf2", "esdirk4"}
        Central differences at the pace of the elastic wave, or an implicit method of second or fourth order whose steps
        follow its error.
    step : float, optional
        Time step [s], rounded down to fill an output step; when left out the largest stable one times ``safety``, or,
        for the implicit methods, what ``tolerance`` requires.
    safety : float, optional
        Part of the largest stable step, above 0, at most 1. When left out 0.95, or 0.5 where bars may go slack with
        hardly any viscosity. 1 is the pace of the elastic wave: along equal bars wave fronts then travel without error,
        as long as ``output_step`` is a whole multiple of the travel time of a wave along one bar. Another one keeps its
        instants and shortens the step, and fronts overshoot; a notice gives their size.
    shorter : float
        Factor on every step of the explicit method, above 0, at most 1: with 0.5 each is half as long, those that drag
        shortens as well, and the run takes about twice the steps.
    load_steps : int
        Steps between two evaluations of the loads of the water, at most.
    tolerance : float
        Error of one implicit step: of tensions over the largest tension, of places over the mean bar length.
    keep_nodes, keep_bars : array_like of int, optional
        Which to keep in the result; all when left out.
    state_file : path, optional
        Where the last good state is kept when the run stops before its end; a run can start from it
        (:func:`moyai.flexible.recovery.read_state`).
    failures : sequence of LineFailure
        Lines that part in the course of the run.
    counted_from : float
        Time since the start before which fronts and falls on the bed are not reported [s].
    enough : callable, optional
        Called, after every part of the run, with times, places of the kept nodes and highest tensions of the kept bars
        of all rows so far; the run ends there, converged, where it returns True.
    progress : Progress
        Called with the simulated time.

    Returns
    -------
    History
        With status ``not_converged`` and all rows up to there when the run had to stop.

    Raises
    ------
    InputError
        For what is no network, motions that are missing, unknown or too short, and numbers out of range.

    Examples
    --------
    >>> from moyai.flexible import BarType, NetworkBuilder, simulate, solve_equilibrium
    >>> from moyai.sea import Water
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> rope = BarType("rope", mass_per_length=10.0, axial_stiffness=1e7, diameter=0.05)
    >>> builder.fixed("left", (0.0, 0.0, -2.0))
    >>> builder.fixed("right", (20.0, 0.0, -2.0))
    >>> builder.line("span", "left", "right", rope, length=21.0, segments=20)
    >>> network = builder.build()
    >>> found = solve_equilibrium(network)
    >>> history = simulate(network, {}, duration=0.5, output_step=0.1, start=found.state)
    >>> history.tension.shape                                        # instants, bars [N]
    (6, 20)
    """
    check_network(network)
    flow = flow or Flow()
    start = start or State.at_rest(network)
    rows, interval = rows_of(duration, output_step)
    check_start(network, start)
    check_motions(network, motions or {}, start.time, start.time + duration)
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"tolerance is {tolerance:g}", parameter="tolerance", allowed="above 0, below 1")
    check_step(step, safety, shorter)
    load_steps = whole_number(load_steps, "load_steps", least=1)
    nodes = kept_numbers(keep_nodes, len(network.nodes), "keep_nodes")
    bars = kept_numbers(keep_bars, len(network.bars), "keep_bars")
    run: ExplicitRun | ImplicitRun
    if method == "explicit":
        run = ExplicitRun(network, motions or {}, flow, start, safety=safety, load_steps=load_steps, shorter=shorter)
    else:
        run = ImplicitRun(network, motions or {}, flow, start, method=method, tolerance=tolerance)
    run.failing = Failing.of(network, failures)
    run.part()
    saved = (
        np.full((rows + 1, nodes.size, 3), np.nan),
        np.full((rows + 1, bars.size), np.nan),
        np.full((rows + 1, bars.size), np.nan),
        np.full((rows + 1, 3), np.nan),
        nodes,
        bars,
    )
    run.first_row(saved)
    look = LONGEST_LOOK if flow.steady else min(LONGEST_LOOK, flow.update_interval)
    if run.failing is not None:
        look = min(look, LOOK)
    for slow in run.slow:
        look = min(look, slow.interval)
        saved[3][0, 1] += slow.energy
    per_chunk = max(1, min(rows // 20, int(look / interval + 1e-9)))
    # rows further apart than that are marched in parts, but for the pace of the wave: whole steps fill its rows
    parts = (
        1
        if flow.steady and safety == 1.0 and not run.slow and run.failing is None
        else max(1, math.ceil(interval / look - 1e-9))
    )
    status: RunStatus = "converged"
    done, message, steps, smallest = 0, "", 0, math.inf
    sound, bound = start, fastest(network, run)
    # rounding must not count as energy: that of a strain of a millionth
    throughput = 1e-12 * float(np.sum(network.bars.of_type("axial_stiffness") * network.bars.length)) + 1e-12
    try:
        while done < rows:
            count = min(per_chunk, rows - done)
            if done * interval <= counted_from < (done + count) * interval:
                run.watch.forget()
            sound = run.state()
            good = advance_rows(run, count, 1 + done, interval, parts, step, saved)
            steps = int(run.counts[2]) if isinstance(run, ImplicitRun) else run.steps
            smallest = min(smallest, run.step if isinstance(run, ImplicitRun) else run.smallest)
            energy = saved[3][: 1 + done + good]
            total = energy[:, 0] + energy[:, 1]
            throughput = max(throughput, float(np.max(total)), float(np.max(np.abs(energy[:, 2]))))
            gain = total[-1] - total[0] - energy[-1, 2]
            done += good
            wild = not float(np.max(np.abs(run.speed), initial=0.0)) < bound
            if good < count or wild or not gain <= ENERGY_STOP * throughput:
                status = "not_converged"
                message = _failure(network, run, start.time + done * interval, good < count, wild, gain)
                if isinstance(run, ImplicitRun) and good < count and np.isfinite(run.place).all():
                    # the step that failed has changed nothing
                    sound = run.state()
                break
            progress("network", done * interval, duration)
            times = start.time + interval * np.arange(done + 1)
            if enough is not None and enough(times, saved[0][: done + 1], saved[2][: done + 1]):
                break
    except KeyboardInterrupt:
        status, message = "interrupted", f"interrupted at t = {start.time + done * interval:g} s"
        if abs(run.time - start.time - done * interval) < 1e-9 * max(1.0, abs(run.time)):
            # between two chunks: all that was marched is good
            sound = run.state()
    if status == "converged":
        sound = run.state()
    elif state_file is not None:
        message += f"; state of t = {sound.time:g} s in {write_state(state_file, sound)}"
    last = done + 1
    return _history(
        network,
        run,
        sound,
        saved,
        last,
        start.time,
        interval,
        steps,
        smallest,
        status,
        message,
        throughput,
    )


def advance_rows(
    run: ExplicitRun | ImplicitRun,
    rows: int,
    first: int,
    interval: float,
    parts: int,
    step: float | None,
    saved: tuple[np.ndarray, ...],
) -> int:
    """March rows, each in so many parts that the water is known well enough; return how many were good."""
    if parts == 1:
        return run.advance(rows, first, interval, step, saved)
    places, pulls, peaks, energy, nodes, bars = saved
    scratch = tuple(np.empty((2, *array.shape[1:])) for array in (places, pulls, peaks, energy))
    for row in range(first, first + rows):
        highest = np.full(bars.size, -np.inf)
        for _ in range(parts):
            if run.advance(1, 1, interval / parts, step, (*scratch, nodes, bars)) < 1:
                return row - first
            highest = np.maximum(highest, scratch[2][1])
        for array, part in zip((places, pulls, peaks, energy), scratch, strict=True):
            array[row] = part[1]
        peaks[row] = highest
    return rows


def fastest(network: Network, run: ExplicitRun | ImplicitRun) -> float:
    """Return a speed that no node reaches: some times that of elastic waves [m/s]."""
    bars = network.bars
    if not len(bars) or network.sheets is not None:
        return math.inf
    waves = np.sqrt(np.maximum(bars.of_type("axial_stiffness"), _steepest(network)) / bars.of_type("mass_per_length"))
    return 5.0 * float(waves.max()) + 10.0 * float(np.max(np.abs(run.speed), initial=0.0)) + 1e3


def _steepest(network: Network) -> np.ndarray:
    slopes = [kind.axial_stiffness if kind.curve is None else kind.curve.stiffness.max() for kind in network.bars.types]
    return np.array(slopes)[network.bars.kind]


def _failure(
    network: Network, run: ExplicitRun | ImplicitRun, time: float, not_finite: bool, wild: bool, gain: float
) -> str:
    """Return when, where and why a run had to stop, and what helps."""
    if isinstance(run, ImplicitRun) and not_finite:
        return (
            f"stopped at t = {run.time:g} s: no step of {run.step:.3g} s or less converges, {run.force_left:.3g} N are "
            f"left at {name_of_node(network, run.worst)}{advice(network)}"
        )
    worst = int(np.argmax(np.abs(np.nan_to_num(run.speed, nan=np.inf)).max(axis=0)))
    why = f"energy balance error of {gain:.3g} J"
    if not_finite or wild:
        why = "values are no longer finite" if not_finite else "a node outruns all elastic waves"
    return (
        f"stopped at t = {time:g} s: {why}, fastest at {name_of_node(network, worst)} (node {worst}); "
        f"step {run.step:.3g} s, stable below {stable_step(run):.3g} s{advice(network)}"
    )


def _history(
    network: Network,
    run: ExplicitRun | ImplicitRun,
    final: State,
    saved: tuple[np.ndarray, ...],
    last: int,
    begin: float,
    interval: float,
    steps: int,
    smallest: float,
    status: RunStatus,
    message: str,
    throughput: float,
) -> History:
    energy = saved[3][:last]
    total = energy[:, 0] + energy[:, 1]
    gain = float(np.max(total - total[0] - (energy[:, 2] - energy[0, 2]))) if last else math.nan
    check = IdentityCheck(
        "energy balance error",
        max(gain, 0.0) / throughput if throughput > 0.0 else 0.0,
        ENERGY_TOLERANCE,
        "rise of kinetic and elastic energy beyond the work done, over the energy that went through the network",
    )
    return History(
        network,
        np.asarray(begin + interval * np.arange(last), dtype=np.float64),
        saved[4],
        saved[5],
        saved[0][:last],
        saved[1][:last],
        saved[2][:last],
        energy[:, 0],
        energy[:, 1],
        energy[:, 2],
        final,
        run.name,
        smallest,
        steps,
        status,
        message,
        (check,),
        (
            *peak_notices(network, run, saved[5], saved[2][:last], check, status == "converged"),
            *(run.failing.notices if run.failing is not None else ()),
        ),
        run.drag_rate() if isinstance(run, ExplicitRun) else math.nan,
    )
