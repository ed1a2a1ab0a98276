"""Many runs of one network marched together: their nodes lie side by side in the array of the kernels.

Loops over the bars of a short line are too short for the vector instructions of a processor, and each step costs its
calls. Side by side the loops are as long as all members together [eq:flexible-ensemble]. What a member does never
depends on the company that it keeps: step and load interval are chosen from the network alone, and a member for which
they do not serve is run by itself.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, BoolArray, IntArray
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.flexible.arrays import kernel_arrays
from moyai.flexible.elements import Bars, Nodes, Strand
from moyai.flexible.explicit import DRAG_BROKEN, DRAG_SHARE, LOAD_STEPS, ExplicitRun
from moyai.flexible.explicit_rows import FASTEST, FASTEST_ATTACHED
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network, check_network
from moyai.flexible.numbers import whole_number
from moyai.flexible.result import State
from moyai.flexible.simulation import (
    LONGEST_LOOK,
    advance_rows,
    check_motions,
    check_start,
    check_step,
    fastest,
    kept_numbers,
    rows_of,
    simulate,
)
from moyai.flexible.stability import step_limit
from moyai.flexible.watch import Watch, watch_of
from moyai.sea.components import WaveComponents
from moyai.sea.kinematics import stretching_code, sum_orbits_of_seas

#: Nodes that are marched side by side, at most: more no longer fit into the near memory of a processor.
NODES_TOGETHER = 1500


@dataclass(frozen=True, eq=False)
class Member:
    """One run of an ensemble.

    Examples
    --------
    The same motion of a fairlead in still water and in a current:

    >>> from moyai.flexible import BarType, Flow, Member, Motion, NetworkBuilder, simulate_together
    >>> from moyai.sea import Water
    >>> surge = {"fairlead": Motion.harmonic((1.0, 0.0, 0.0), 5.0, duration=1.0)}
    >>> members = [Member(surge), Member(surge, Flow(velocity=(0.0, 0.5, 0.0)))]
    >>> builder = NetworkBuilder(Water(depth=60.0, density=1025.0, gravity=9.81))
    >>> rope = BarType("rope", mass_per_length=9.0, axial_stiffness=1e7, diameter=0.04, viscosity=1e3, drag_normal=1.2)
    >>> builder.fixed("anchor", (0.0, 0.0, -12.0))
    >>> builder.driven("fairlead", (44.0, 0.0, -2.0))
    >>> builder.line("rope", "anchor", "fairlead", rope, length=46.0, segments=10)
    >>> both = simulate_together(builder.build(), members, duration=1.0, output_step=0.5)
    >>> aside = both.position[:, -1, :, 1].max(axis=1)                   # across the rope, at the end of the run [m]
    >>> float(aside[0]), bool(aside[1] > 0.01)
    (0.0, True)
    """

    #: One for every name in ``network.motion_names``.
    motions: Mapping[str, Motion] = field(default_factory=dict)
    #: Motion of the water.
    flow: Flow = field(default_factory=Flow)


@dataclass(frozen=True, eq=False)
class Ensemble:
    """The runs of the members of an ensemble."""

    #: What was run.
    network: Network
    #: Times of the rows [s]; shape (k,).
    time: Array
    #: Which nodes the arrays hold.
    nodes: IntArray
    #: Which bars the arrays hold.
    bars: IntArray
    #: [m]; NaN of members that could not be run; shape (members, k, nodes, 3).
    position: Array
    #: At the times of the rows [N]; shape (members, k, bars).
    tension: Array
    #: Highest since the row before, taken at every step [N]; shape (members, k, bars).
    tension_peak: Array
    #: Time step of each member [s], NaN of members that could not be run; shape (members,).
    step: Array
    #: Steps between two evaluations of the loads of the water; shape (members,).
    load_steps: IntArray

    @property
    def complete(self) -> BoolArray:
        """Which members could be run; shape (members,)."""
        return np.asarray(np.isfinite(self.step))


@dataclass(frozen=True, eq=False)
class _Waters:
    """The water around members that lie side by side, in the manner of a :class:`moyai.flexible.flow.Flow`."""

    members: tuple[Flow, ...]
    nodes: int

    @property
    def steady(self) -> bool:
        """Whether that of all members is."""
        return all(flow.steady for flow in self.members)

    @property
    def waves(self) -> Any:
        return max(
            (f.waves for f in self.members if f.waves is not None), key=lambda w: w.amplitude.sum(), default=None
        )

    def at(self, time: float, position: Array) -> Array:
        """Return the water at the nodes of all members, shape (7, n)."""
        n = self.nodes
        parts = [flow.at(time, position[:, m * n : (m + 1) * n]) for m, flow in enumerate(self.members)]
        return np.concatenate(parts, axis=1)


@dataclass(frozen=True, eq=False)
class _Seas(Flow):
    """Flows that differ in nothing but the numbers of their waves, summed in one call."""

    #: Components of all members; shape (members, 9, components).
    rows: Array = field(default_factory=lambda: np.zeros((0, 9, 0)))

    def _orbital_motion(self, sea: WaveComponents, time: float, position: Array) -> tuple[Array, Array, Array]:
        count = position.shape[1]
        elevation, velocity, acceleration = np.empty(count), np.empty((count, 3)), np.empty((count, 3))
        depth = math.inf if sea.water is None else float(sea.water.depth)
        place = (np.ascontiguousarray(row) for row in position)
        sum_orbits_of_seas(
            self.rows, depth, *place, time, stretching_code(self.stretching), elevation, velocity, acceleration
        )
        return elevation, velocity, acceleration


def _water_of(flows: tuple[Flow, ...], nodes: int) -> Any:
    """Return the water around members side by side."""
    first, seas = flows[0], [flow.waves for flow in flows]
    alike = all(
        type(flow) is Flow and flow.steep is None and flow.waves is not None
        and np.array_equal(flow.velocity, first.velocity)
        and all(getattr(flow, key) == getattr(first, key) for key in ("ramp", "wave_ramp", "stretching"))
        and flow.current is first.current and flow.field is first.field
        for flow in flows
    )  # fmt: skip
    if not alike or len({(len(sea), sea.water.depth) for sea in seas if sea is not None and sea.water}) != 1:
        return _Waters(flows, nodes)
    rows = np.stack([sea.orbit_rows for sea in seas if sea is not None])
    return _Seas(rows=rows, **{entry.name: getattr(first, entry.name) for entry in fields(Flow)})


class _Together(ExplicitRun):
    """A march whose step and load interval are given, so that no member feels the others."""

    booked = False
    plan: tuple[float, int, int] = (0.0, 1, 1)

    def watch_of_run(self) -> Watch:
        """Return a watch without gauges."""
        return watch_of(replace(self.network, strands=()), self.packed.place)

    def choose(self, row_interval: float, wanted: float | None) -> tuple[float, int, int]:
        """Return what was given for rows ``row_interval`` apart."""
        step, per_load, _ = self.plan
        return step, per_load, round(row_interval / (step * per_load))

    def bounds_of_drag(self, bear: float) -> tuple[float, float]:
        """Return no bounds: members are looked at one by one after the march."""
        return math.inf, math.inf


def members_together(network: Network) -> int:
    """Return how many members of a network are marched side by side; 0 where its parts do not allow it."""
    slow = any(kind.slow is not None for kind in network.bars.types)
    if slow or any(part is not None for part in (network.sheets, network.blocks, network.panels)) or network.rings:
        return 0
    return max(1, NODES_TOGETHER // len(network.nodes))


def side_by_side(network: Network, count: int) -> Network:
    """Return a network of ``count`` copies, one after the other, whose strands and motions have the copy's number."""
    size, bars, motions = len(network.nodes), network.bars, len(network.motion_names)
    values = {entry.name: _repeated(getattr(network.nodes, entry.name), count) for entry in fields(Nodes)}
    copy = np.repeat(np.arange(count), size)
    values["motion"] = np.where(values["motion"] >= 0, values["motion"] + copy * motions, -1)
    shift = np.repeat(np.arange(count) * size, len(bars))
    strands = tuple(
        Strand(f"{strand.name} {m}", strand.nodes + m * size, strand.bars + m * len(bars))
        for m in range(count)
        for strand in network.strands
    )
    return Network(
        Nodes(**values),
        Bars(
            _repeated(bars.start, count) + shift, _repeated(bars.end, count) + shift, _repeated(bars.length, count),
            _repeated(bars.kind, count), bars.types, _repeated(bars.flow_factor, count),
        ),
        network.water, network.bed, strands, {},
        tuple(f"{name} {m}" for m in range(count) for name in network.motion_names),
    )  # fmt: skip


def _repeated(values: Any, count: int) -> Any:
    return np.tile(values, (count,) + (1,) * (values.ndim - 1))


def simulate_together(
    network: Network,
    members: Sequence[Member],
    *,
    duration: float,
    output_step: float,
    interval: float | None = None,
    start: State | None = None,
    step: float | None = None,
    safety: float | None = None,
    load_steps: int = LOAD_STEPS,
    drag_rate: float = 0.0,
    keep_nodes: ArrayLike | None = None,
    keep_bars: ArrayLike | None = None,
    progress: Progress = silent,
) -> Ensemble:
    """Run a network through time many times over, in many waters or with many motions, by central differences.

    All members march as one network of separate parts [eq:flexible-ensemble]. The runs of a member
    are the same to the last bit whatever the others are, and in whatever order they stand.

    Parameters
    ----------
    network : Network
        The network: bars, bending, floats and weights, a bed.
    members : sequence of Member
        Motions and water of each run.
    duration, output_step : float
        Length of the runs and spacing of their rows [s], as in :func:`moyai.flexible.simulation.simulate`.
    interval : float, optional
        Time between two evaluations of the water [s]; what each member requires when left out. Members that share it
        are marched together.
    start : State, optional
        Where all start; as built, without speed, when left out.
    step, safety, load_steps : float, float, int
        As in :func:`moyai.flexible.simulation.simulate`. A member whose drag requires a shorter load interval is run
        again with loads at every step, and one that requires a shorter step by itself.
    drag_rate : float
        Rate at which drag is likely to damp the quickest part [1/s], for instance that of a run by itself: the first
        load interval suits it.
    keep_nodes, keep_bars : array_like of int, optional
        Which to keep in the result; all when left out.
    progress : Progress
        Called with the number of members that are done, those on the way by the part of their rows.

    Returns
    -------
    Ensemble
        Tensions and peaks [N], shape (members, instants, bars), and positions [m], with NaN for members that
        could not be run.

    Raises
    ------
    InputError
        For motions that are missing, unknown or too short, numbers out of range, parts that are not marched together.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.flexible import BarType, Member, Motion, NetworkBuilder, simulate_together
    >>> from moyai.sea import Water
    >>> builder = NetworkBuilder(Water(depth=60.0, density=1025.0, gravity=9.81))
    >>> rope = BarType("rope", mass_per_length=9.0, axial_stiffness=1e7, diameter=0.04, viscosity=1e3)
    >>> builder.fixed("anchor", (0.0, 0.0, -12.0))
    >>> builder.driven("fairlead", (44.0, 0.0, -2.0))
    >>> builder.line("rope", "anchor", "fairlead", rope, length=46.0, segments=10)
    >>> surges = [Motion.harmonic((1.0, 0.0, 0.0), period, duration=2.0) for period in (4.0, 5.0)]
    >>> both = simulate_together(
    ...     builder.build(), [Member({"fairlead": surge}) for surge in surges], duration=2.0, output_step=0.5
    ... )
    >>> both.tension_peak.shape                                      # members, instants, bars [N]
    (2, 5, 10)
    """
    check_network(network)
    start = start or State.at_rest(network)
    rows, spacing = rows_of(duration, output_step)
    check_start(network, start)
    check_step(step, safety)
    load_steps = whole_number(load_steps, "load_steps", least=1)
    if interval is not None and not interval > 0.0:
        raise InputError(f"interval is {interval:g} s", parameter="interval", allowed="greater than 0")
    if not drag_rate >= 0.0:
        raise InputError(f"drag_rate is {drag_rate:g} 1/s", parameter="drag_rate", allowed="0 or more")
    for member in members:
        check_motions(network, member.motions, start.time, start.time + duration)
    if not members:
        raise InputError("an ensemble without members", parameter="members", allowed="one or more")
    nodes = kept_numbers(keep_nodes, len(network.nodes), "keep_nodes")
    bars = kept_numbers(keep_bars, len(network.bars), "keep_bars")
    together = members_together(network)
    if not together:
        raise InputError(
            "net panels, rings, sheets, sections of added mass and slow ropes are not marched side by side",
            parameter="network",
            allowed="lines, twines, floats, a bed",
            remedy="run the members one by one with simulate",
        )
    count = len(members)
    out = Ensemble(
        network, np.asarray(start.time + spacing * np.arange(rows + 1), dtype=np.float64), nodes, bars,
        np.full((count, rows + 1, nodes.size, 3), np.nan), np.full((count, rows + 1, bars.size), np.nan),
        np.full((count, rows + 1, bars.size), np.nan), np.full(count, np.nan), np.zeros(count, dtype=np.int64),
    )  # fmt: skip
    # members by what they require: waves or not, how often the water is found, loads at every step or not
    waiting: dict[tuple[bool, float, bool], list[int]] = {}
    for number, member in enumerate(members):
        own = math.inf if member.flow.steady else interval or member.flow.update_interval
        waiting.setdefault((member.flow.waves is not None, min(LONGEST_LOOK, own), False), []).append(number)
    alone: list[int] = []
    while waiting:
        (waves, look, quick), left = waiting.popitem()
        plan = _plan(network, start, waves, (spacing, look), (step, safety, 1 if quick else load_steps, drag_rate))
        while left:
            chosen, left = np.array(left[:together]), left[together:]
            done = int(out.complete.sum())

            def marched(share: float, done: int = done, size: int = len(chosen)) -> None:
                progress("members", done + share * size, count)

            run = _march(network, [members[m] for m in chosen], start, plan, rows, (nodes, bars), marched)
            if not run.sound.all():
                # the others in an array with one that blew up begin anew without it
                left = [*chosen[run.sound], *left]
                alone.extend(chosen[~run.sound])
                continue
            calm = run.calm & run.stable
            for kept, found in zip((out.position, out.tension, out.tension_peak), run.rows, strict=True):
                kept[chosen[calm]] = found[calm]
            out.step[chosen[calm]], out.load_steps[chosen[calm]] = plan.step, plan.per_load
            again = run.stable & ~calm & (plan.per_load > 1)
            if again.any():
                waiting.setdefault((waves, look, True), []).extend(chosen[again])
            alone.extend(chosen[~calm & ~again])
            progress("members", int(out.complete.sum()), count)
    for m in sorted(alone):
        lone = simulate(
            network, members[m].motions, flow=members[m].flow, duration=duration, output_step=output_step, start=start,
            step=step, safety=safety, load_steps=load_steps, keep_nodes=nodes, keep_bars=bars,
        )  # fmt: skip
        if lone.status == "interrupted":
            raise KeyboardInterrupt
        if lone.status == "converged":
            out.position[m], out.tension[m], out.tension_peak[m] = lone.position, lone.tension, lone.tension_peak
            out.step[m] = lone.step
        progress("members", int(out.complete.sum()), count)
    return out


@dataclass(frozen=True)
class _Plan:
    """Step [s], steps per load interval and load intervals per part of a row; times of a row and of its parts [s]."""

    step: float
    per_load: int
    per_row: int
    spacing: float
    #: Rows further apart than the water is known are marched in so many parts; rows marched in one go.
    parts: int
    per_chunk: int
    #: Part of the stable step up to which it serves, and a speed that no node reaches [m/s].
    most: float
    fastest: float


def _plan(
    network: Network, start: State, waves: bool, times: tuple[float, float],
    asked: tuple[float | None, float | None, int, float],
) -> _Plan:  # fmt: skip
    """Return a step and load interval from the network where it starts, in still water: no member decides them."""
    (spacing, look), (step, safety, load_steps, rate) = times, asked
    parts = max(1, math.ceil(spacing / look - 1e-9))
    still = {n: Motion(start.time, 1.0, np.zeros((2, 3)), np.zeros((2, 3))) for n in network.motion_names}
    run = ExplicitRun(network, still, Flow(), start, safety=safety, load_steps=load_steps)
    run.reach = math.inf if waves else run.reach
    interval = spacing / parts
    largest = run.choose(interval, step)[0]
    least = max(1, math.ceil(interval / largest * (1.0 - 1e-12)))
    per_load = max(1, min(run.load_steps, least, int(DRAG_SHARE / max(rate * largest, 1e-300))))
    per_row = math.ceil(least / per_load)
    most = math.inf if step is not None else min(1.0, 1.05 * run.safety)
    return _Plan(
        interval / (per_row * per_load),
        per_load,
        per_row,
        spacing,
        parts,
        max(1, int(look / spacing + 1e-9)),
        most,
        fastest(network, run),
    )


@dataclass(frozen=True, eq=False)
class _Marched:
    """Places, tensions, highest tensions of members (members, k, ...), and which of them can be used."""

    rows: tuple[Array, Array, Array]
    #: Whose values stayed finite and slower than elastic waves allow.
    sound: BoolArray
    #: Whose drag outran neither load interval nor step.
    calm: BoolArray
    #: Whose stable step was never the shorter one.
    stable: BoolArray


def _march(
    network: Network, members: Sequence[Member], start: State, plan: _Plan, rows: int, keep: tuple[IntArray, IntArray],
    marched: Callable[[float], None],
) -> _Marched:  # fmt: skip
    """March members side by side; ``marched`` is called with the part of the rows that is done."""
    count, size, bars = len(members), len(network.nodes), len(network.bars)
    tiled = side_by_side(network, count)
    motions = {f"{name} {m}": motion for m, member in enumerate(members) for name, motion in member.motions.items()}
    begin = State(start.time, np.tile(start.position, (count, 1)), np.tile(start.velocity, (count, 1)))
    water = _water_of(tuple(member.flow for member in members), size)
    run = _Together(tiled, motions, water, begin, safety=1.0, load_steps=plan.per_load)
    run.plan, run.reach = (plan.step, plan.per_load, plan.per_row), math.inf if water.waves is not None else run.reach
    shift = np.arange(count)[:, None]
    all_nodes, all_bars = (shift * size + keep[0]).ravel(), (shift * bars + keep[1]).ravel()
    saved = (
        np.full((rows + 1, all_nodes.size, 3), np.nan), np.full((rows + 1, all_bars.size), np.nan),
        np.full((rows + 1, all_bars.size), np.nan), np.full((rows + 1, 3), np.nan), all_nodes, all_bars,
    )  # fmt: skip
    run.first_row(saved)
    stable, sound, done = np.ones(count, dtype=np.bool_), np.ones(count, dtype=np.bool_), 0
    one = kernel_arrays(network)
    while done < rows and stable.any():
        inverse = run.inverse_masses()
        if plan.step > plan.most * step_limit(run.arrays, run.place, inverse)[0]:
            for m in np.flatnonzero(stable):
                own = slice(m * size, (m + 1) * size)
                stable[m] = plan.step <= plan.most * step_limit(one, run.place[:, own], inverse[:, own])[0]
        chunk = min(plan.per_chunk, rows - done)
        good = advance_rows(run, chunk, 1 + done, plan.spacing, plan.parts, None, saved)
        sound &= np.abs(run.speed).reshape(3, count, size).max(axis=(0, 2)) < plan.fastest
        if good < chunk or not sound.all():
            # where none stands out all go on with a shorter step
            sound = sound if not sound.all() else ~sound
            break
        done += chunk
        marched(done / rows)
    drag = run.packed.bar_row(FASTEST).reshape(count, bars).max(axis=1, initial=0.0)
    attached = run.packed.node_rows(FASTEST_ATTACHED, 1).reshape(count, size).max(axis=1, initial=0.0)
    quickest = np.maximum(drag, attached) * plan.step
    calm = (quickest * plan.per_load <= 1.5 * DRAG_SHARE) & (quickest <= DRAG_BROKEN)
    places, pulls, peaks = (
        np.moveaxis(values.reshape(rows + 1, count, -1, *values.shape[2:]), 0, 1) for values in saved[:3]
    )
    return _Marched((places, pulls, peaks), sound, calm, stable)
