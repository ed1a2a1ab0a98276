"""Whether the peak of a run hangs on its mesh or its step: the run once more with each of them halved.

Theory: docs/answer/network.md and [eq:flexible-landing].
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from moyai.core.at_once import each_at_once
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress
from moyai.core.validity import Notice
from moyai.core.wording import spoken
from moyai.flexible.elements import FIXED
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.refine import refined
from moyai.flexible.result import History, State
from moyai.flexible.sensitivity import PeakSensitivity, refined_start
from moyai.flexible.simulation import simulate
from moyai.series.snaps import SnapRecord
from moyai.structures.network.assembly import Assembly
from moyai.structures.network.equilibrium import around, highest_of_run, named_points

#: Bars times steps that both further runs together may take: of any run, and of one whose peak is doubtful. The
#: explicit scheme does some ten million a second; a step of the implicit schemes costs about thirty times as much.
WORK, DOUBTFUL_WORK, IMPLICIT = 3e8, 1e9, 30.0
#: Part of the critical damping of one bar that calms fronts on the mesh, and bars of the line that they then need.
DAMPING, DAMPED_BARS = 0.3, 32
#: Periods before and after the highest tension that an event by itself takes, and how well it gives the peak again.
LEAD, AFTER, SAME_EVENT = 3.0, 0.25, 0.02
#: Highest pull on a point before a run counts, over that of the run itself, up to which another mesh begins like it.
JERK = 1.1
#: Bars of a line up to which its peak is doubtful whatever the run shows.
FEW_BARS = 5
#: Doubt of a peak that finer segments only lower: lumps that stop on the bed pull harder than a smooth line.
LANDING = "segments that land on the bed produce spurious tension waves"
#: Bars times steps that the finest mesh of one event may take, diameters below which bars of a line mean nothing, and
#: the change of a peak that lands with twice the bars below which no finer mesh is run.
LADDER_WORK, SHORTEST_BAR, LANDED = 3e8, 2.0, 0.1
#: Values that a further run keeps for the peaks of all lines and nets, at most.
MOST_VALUES = 40_000_000


def doubt(assembly: Assembly, history: History, snaps: Mapping[str, SnapRecord], line: str) -> str:
    """Return why the peak of a line may hang on mesh and step, empty where nothing says so.

    Snaps, fronts that rise within a part of the travel time of the elastic wave, and lines of few bars make peaks that
    the mesh decides.

    Parameters
    ----------
    assembly : Assembly
    history : History
    snaps : mapping of str to SnapRecord
    line : str
        Of the highest tension.
    """
    codes = [notice.code for notice in history.notices]
    landing = LANDING if "landing-front" in codes else ""
    if any(record.snaps for record in snaps.values()):
        return "; ".join(filter(None, ("a slack line snaps taut", landing)))
    if landing:
        return landing
    if "wave-front" in codes:
        return "the load rises faster than an elastic wave runs through the line"
    return few_bars(assembly, line)


def few_bars(assembly: Assembly, line: str) -> str:
    """Say that a line has so few bars that its peak is doubtful whatever the run shows, empty where it has more."""
    strand = assembly.lines.get(line)
    if strand is None or strand.bars.size > FEW_BARS:
        return ""
    return f"'{line}' has {strand.bars.size} segment{'s' if strand.bars.size > 1 else ''}"


def affordable(history: History, doubtful: bool, share: float = 1.0) -> bool:
    """Whether half the step and twice the bars can be run as well, over a share of the run."""
    network = history.network
    work = 10.0 * len(network.bars) * share * history.steps * (1.0 if history.method == "explicit" else IMPLICIT)
    return work <= (DOUBTFUL_WORK if doubtful else WORK)


@dataclass(frozen=True, eq=False)
class PeakWindow:
    """The part of a run that holds its highest tension, from a state of the run itself."""

    begin: State
    #: [s].
    duration: float
    #: Time before the peak in which the start fades [s].
    lead: float


def window_of(history: History, bars: np.ndarray, skip: float, period: float) -> PeakWindow | None:
    """Return the window around the highest tension of some bars; ``None`` where the places of nodes were not all kept.

    Parameters
    ----------
    history : History
    bars : ndarray of int
    skip : float
        Start-up that does not count [s].
    period : float
        Of the waves or motions [s].
    """
    if history.nodes.size != len(history.network.nodes) or not math.isfinite(period):
        return None
    columns = np.flatnonzero(np.isin(history.bars, bars))
    peaks = np.nan_to_num(history.tension_peak[:, columns], nan=-math.inf).max(axis=1)
    peaks[history.time < history.time[0] + skip] = -math.inf
    top = float(history.time[int(np.argmax(peaks))])
    row = int(np.searchsorted(history.time, top - LEAD * period))
    if not 0 < row < len(history.time) - 1:
        return None
    time, place = history.time, history.position
    velocity = (place[row + 1] - place[row - 1]) / (time[row + 1] - time[row - 1])
    begin = State(float(time[row]), np.array(place[row]), np.asarray(velocity))
    end = min(top + AFTER * period, float(time[-1]))
    return PeakWindow(begin, end - begin.time, 0.5 * (top - begin.time))


def check_event(
    assembly: Assembly,
    history: History,
    motions: Mapping[str, Motion],
    line: str,
    skip: float,
    period: float,
    options: Mapping[str, Any],
    progress: Progress,
    why: str = "",
) -> PeakSensitivity | None:
    """Run only the event of the highest tension again, with half the step and with every bar cut in two.

    The event is run first on the mesh and step of the run: where that does not give its peak again within
    :data:`SAME_EVENT` the start has not faded, and nothing is known. What finer runs change is taken in proportion.
    Fronts of segments that land never come twice at one height: there the highest of the event on shorter bars is the
    measure by itself, and bars are cut further until it stands or bars are as short as the line is thick.

    Returns
    -------
    PeakSensitivity or None
        ``None`` where the event cannot be run by itself.
    """
    bars = _bars_of(assembly, line)
    window = window_of(history, bars, skip, period)
    if window is None:
        return None
    share = window.duration / float(history.time[-1] - history.time[0])
    if not affordable(history, True, share):
        return None
    chosen = {**options, "duration": window.duration}
    peak = _highest(history, bars, skip)
    every = np.concatenate([bars, *_parts(assembly, history).values()])
    same = simulate(
        history.network, motions, start=window.begin, progress=progress,
        **{**chosen, "step": history.step, **_kept(assembly, history.network, every)},
    )  # fmt: skip
    if same.status == "interrupted":
        raise KeyboardInterrupt
    if same.status != "converged":
        return None
    again = _peaks_of(assembly, same, bars, window.lead).peak
    lands = LANDING in why
    if not again > 0.0 or (abs(again / peak - 1.0) > SAME_EVENT and not lands):
        return None
    found = check_peak(assembly, same, motions, line, window.begin, window.lead, chosen, progress)
    if found is None:
        return None
    if lands:
        found = _down_to_links(found, assembly, same, motions, line, window, chosen, progress)
    whole, pulls = highest_of_run(history, fixed_points(assembly, history.network), skip), {}
    for name, one in found.pulls.items():
        # the event of the highest tension need not be that of this point
        if one.peak > 0.0 and name in whole and (lands or abs(one.peak / whole[name] - 1.0) <= SAME_EVENT):
            pulls[name] = _in_proportion(one, whole[name] / one.peak, lands)
    own = {}
    for name, one in found.lines.items():
        # another line may carry most at another time: what the event says of it is then not of its peak
        top = peak if name == line else _highest(history, _bars_of(assembly, name), skip)
        if one.peak > 0.0 and (name == line or abs(one.peak / top - 1.0) <= SAME_EVENT):
            own[name] = _in_proportion(one, top / one.peak, lands)
    return replace(_in_proportion(found, peak / again, lands), pulls=pulls, lines=own)


def _in_proportion(found: PeakSensitivity, factor: float, lands: bool) -> PeakSensitivity:
    """Return peaks of an event taken in proportion to those of the whole run.

    Where segments land, the chance of their height is that of this mesh: shorter ones give what they give.
    """
    finer = 1.0 if lands else factor
    return replace(
        found, peak=factor * found.peak, half_step=factor * found.half_step, double_mesh=finer * found.double_mesh,
        damped=finer * found.damped, finest=finer * found.finest,
    )  # fmt: skip


def fixed_points(assembly: Assembly, network: Network) -> dict[str, int]:
    """Return the fixed points of the case and their nodes in a network, also one whose bars were cut."""
    points = {name: network.points[name] for name in named_points(assembly)[0] if name in network.points}
    return {name: node for name, node in points.items() if network.nodes.kind[node] == FIXED}


def _kept(assembly: Assembly, network: Network, bars: np.ndarray) -> dict[str, np.ndarray]:
    """Return what a run keeps for the peaks of some bars and the pulls on fixed points."""
    nodes, own = around(network, fixed_points(assembly, network))
    return {"keep_nodes": nodes if nodes.size else np.zeros(1, dtype=np.int64), "keep_bars": np.union1d(bars, own)}


@dataclass(frozen=True)
class _Peaks:
    """Highest tension of the line that is looked at, pulls on fixed points, highest tensions of lines and nets [N]."""

    peak: float
    pulls: dict[str, float]
    lines: dict[str, float] = field(default_factory=dict)


def _peaks_of(
    assembly: Assembly, history: History, bars: np.ndarray, after: float, parts: Mapping[str, np.ndarray] | None = None
) -> _Peaks:
    """Return the highest tensions of a run in some bars and in each of ``parts``, and the pull on each fixed point."""
    lines = {name: _highest(history, own, after) for name, own in (parts or {}).items()}
    pulls = highest_of_run(history, fixed_points(assembly, history.network), after)
    return _Peaks(_highest(history, bars, after), pulls, lines)


def _highest(history: History, bars: np.ndarray, after: float) -> float:
    """Return the highest tension of some bars in what counts of a run."""
    columns = np.flatnonzero(np.isin(history.bars, bars))
    return float(np.nanmax(history.tension_peak[history.time >= history.time[0] + after][:, columns]))


def _parts(assembly: Assembly, history: History) -> dict[str, np.ndarray]:
    """Return the bars of every line and net whose peaks are looked at again: none where they fill the memory."""
    found = assembly.judged | dict(assembly.net_bars)
    if 4 * len(history.network.bars) * history.time.size > MOST_VALUES:
        return {}
    return {name: bars for name, bars in found.items() if bars.size and np.isin(bars, history.bars).all()}


def _cut(bars: np.ndarray, factor: int) -> np.ndarray:
    """Return the bars of a mesh whose every bar was cut in ``factor``."""
    return np.concatenate([factor * bars + part for part in range(factor)])


def _early(assembly: Assembly, history: History, skip: float) -> dict[str, float]:
    """Return the highest pull on each fixed point before what counts of a run."""
    return highest_of_run(history, fixed_points(assembly, history.network), 0.0, skip)


def _down_to_links(
    found: PeakSensitivity, assembly: Assembly, event: History, motions: Mapping[str, Motion], line: str,
    window: PeakWindow, options: Mapping[str, Any], progress: Progress,
) -> PeakSensitivity:  # fmt: skip
    """Cut the bars of an event in four, eight ... as long as its highest tension changes by a tenth each time."""
    network, factor, last, bars = event.network, 4, found.double_mesh, _bars_of(assembly, line)
    own = network.bars.length[bars] / (SHORTEST_BAR * network.bars.of_type("diameter")[bars])
    most = min(int(np.min(own)), math.isqrt(int(LADDER_WORK / (len(network.bars) * event.steps))))
    while factor <= most:
        finer, state = refined(network, factor, window.begin)
        kept = _cut(bars, factor)
        shorter = {} if options.get("step") is None else {"step": options["step"] / factor}
        chosen = {**options, **shorter, **_kept(assembly, finer, kept)}
        run = simulate(finer, motions, start=state, progress=progress, **chosen)
        if run.status == "interrupted":
            raise KeyboardInterrupt
        if run.status != "converged":
            break
        own_parts = {name: _cut(own, factor) for name, own in assembly.judged.items() if assembly.line_of(name) == line}
        again = _peaks_of(assembly, run, kept, window.lead, own_parts)
        pulls = {
            n: replace(one, finest=again.pulls[n], factor=factor) for n, one in found.pulls.items() if n in again.pulls
        }
        of_line = {
            name: replace(found.lines[name], finest=top, factor=factor)
            for name, top in again.lines.items()
            if name in found.lines
        }  # fmt: skip
        found = replace(found, finest=again.peak, factor=factor, pulls=pulls, lines={**found.lines, **of_line})
        if abs(again.peak / last - 1.0) <= LANDED or factor == most:
            break
        factor, last = min(2 * factor, most), again.peak
    return found


def _bars_of(assembly: Assembly, line: str) -> np.ndarray:
    return assembly.judged.get(line, assembly.net_bars.get(line, np.zeros(0, dtype=np.int64)))


#: A network, its start, into how many its bars were cut, and what else is changed.
_Variant = tuple[Network, State, int, dict[str, float]]


def check_peak(
    assembly: Assembly,
    history: History,
    motions: Mapping[str, Motion],
    line: str,
    begin: State,
    skip: float,
    options: Mapping[str, Any],
    progress: Progress,
    equilibrium_flow: Flow | None = None,
) -> PeakSensitivity | None:
    """Run again with half the step and with every bar cut in two; return the highest tension of each in a line.

    Steps at the pace of the elastic wave are exact along equal bars: they are halved with the bars alone.

    Parameters
    ----------
    assembly : Assembly
    history : History
        Of the run itself.
    motions : mapping of str to Motion
    line : str
        Line or net whose highest tension is compared; those of all others come with it.
    begin : State
    skip : float
        Start-up that does not count [s].
    options : mapping
        Arguments of :func:`moyai.flexible.simulation.simulate`.
    progress : Progress
    equilibrium_flow : Flow, optional
        In which ``begin`` is at rest.

    Returns
    -------
    PeakSensitivity or None
        Without what the viscosity changes; ``None`` for networks that cannot be refined, or a run that had to stop.
    """
    bars = _bars_of(assembly, line)
    if not np.isin(history.bars, bars).any() or not (history.time >= history.time[0] + skip).any():
        return None
    parts = _parts(assembly, history)
    own = _peaks_of(assembly, history, bars, skip, parts)
    early = _early(assembly, history, skip)

    def again(variant: _Variant, heard: Progress) -> _Peaks:
        network, start, factor, more = variant
        kept, of_parts = _cut(bars, factor), {name: _cut(part, factor) for name, part in parts.items()}
        every = np.unique(np.concatenate([kept, *of_parts.values()]))
        chosen = {**options, **more, **_kept(assembly, network, every)}
        found = simulate(network, motions, start=start, progress=heard, **chosen)
        if found.status == "interrupted":
            raise KeyboardInterrupt
        if found.status != "converged":
            raise ConvergenceError(found.message, parameter="sensitivity")
        made = _peaks_of(assembly, found, kept, skip, of_parts)
        if equilibrium_flow is None:
            # what another mesh makes of a place between its nodes jerks at the start, and friction on the bed keeps it
            begun = _early(assembly, found, skip)
            pulls = {n: pull for n, pull in made.pulls.items() if begun.get(n, 0.0) <= JERK * early.get(n, 0.0)}
            made = replace(made, pulls=pulls)
        return made

    try:
        finer, state = refined_start(history.network, 2, begin, equilibrium_flow)
        exact, given = options.get("safety") == 1.0, options.get("step")

        def shorter(factor: int) -> dict[str, float]:
            return {} if given is None else {"step": given / factor}

        variants: list[_Variant] = [(finer, state, 2, shorter(2))]
        if not exact:
            variants.append((history.network, begin, 1, {"step": 0.5 * history.step}))
        if not exact and damped_bars(finer) is not finer:
            factor = 2
            while factor * bars.size < DAMPED_BARS:
                factor *= 2
            calm, state = refined_start(history.network, factor, begin, equilibrium_flow)
            variants.append((damped_bars(calm), state, factor, shorter(factor)))
        made = each_at_once(again, variants, progress)
        mesh, step = made[0], own if exact else made[1]
        calmed = made[2] if len(made) > 2 else _Peaks(math.nan, {})
    except (ConvergenceError, InputError):
        return None

    def gathered(kind: str) -> dict[str, PeakSensitivity]:
        first, half, finer, calm = (getattr(item, kind) for item in (own, step, mesh, calmed))
        return {
            name: PeakSensitivity(
                first[name], half[name], finer[name], math.nan, math.nan, history.step, calm.get(name, math.nan)
            )
            for name in first.keys() & half.keys() & finer.keys()
        }  # fmt: skip

    return PeakSensitivity(
        own.peak, step.peak, mesh.peak, math.nan, math.nan, history.step, calmed.peak, pulls=gathered("pulls"),
        lines=gathered("lines"),
    )  # fmt: skip


def change_of(found: PeakSensitivity) -> float:
    """Return the largest relative change of the peak with half the step, twice the bars, and bars that are damped."""
    if found.peak == 0.0:
        return 0.0
    return max(abs(value / found.peak - 1.0) for value in _finer(found))


def lowered(found: PeakSensitivity, goal: float) -> bool:
    """Whether half the step, twice the bars and damped bars all give less: the peak of the run is on the safe side."""
    return all(value <= found.peak * (1.0 + goal) for value in _finer(found))


def _finer(found: PeakSensitivity) -> list[float]:
    others = (found.half_step, found.double_mesh, found.damped, found.finest)
    return [value for value in others if math.isfinite(value)]


def band_of(found: PeakSensitivity) -> tuple[float, float]:
    """Return the range that the peak has with half the step, twice the bars, and bars of no length [N].

    The last one continues the change of the mesh as that of a method of first order, which snaps and fronts are at
    best: twice the bars take half of the error.
    """
    ends = [found.peak, found.half_step, found.double_mesh, max(2.0 * found.double_mesh - found.peak, 0.0)]
    ends += [value for value in (found.damped, found.finest) if math.isfinite(value)]
    return min(ends), max(ends)


def damped_bars(network: Network) -> Network:
    """Return a network whose bars have three tenths of critical damping at least; itself where they have half of it.

    That is 0.3 l sqrt(EA m) of the longest bar of each type, less on a finer mesh: another mesh, not another line.
    """
    bars, types = network.bars, []
    for number, kind in enumerate(network.bars.types):
        longest = float(np.max(bars.length[bars.kind == number], initial=0.0))
        least = DAMPING * longest * kind.impedance
        types.append(replace(kind, viscosity=least) if kind.viscosity < 0.5 * least else kind)
    if all(new is old for new, old in zip(types, bars.types, strict=True)):
        return network
    return replace(network, bars=replace(bars, types=tuple(types)))


def not_converged(found: PeakSensitivity, goal: float, line: str, why: str, segments: int, knots: bool = False) -> str:
    """Return why the peak of a run is not converged and what helps, empty where it is.

    ``knots`` where the finer mesh has twice the knots of its nets as well.
    """
    if not change_of(found) > goal:
        return ""
    by_mesh = max(abs(found.double_mesh - found.peak), abs(np.nan_to_num(found.damped, nan=found.peak) - found.peak))
    by_step = abs(found.half_step - found.peak)
    half, mesh, calm = (spoken(v, "N", like=found.peak) for v in (found.half_step, found.double_mesh, found.damped))
    damped = f", {calm} where bars are damped as well" if math.isfinite(found.damped) else ""
    below = ""
    if segments and math.isfinite(found.finest):
        below = f"; {found.factor * segments} segments give {spoken(found.finest, 'N', like=found.peak)}"
    least, most = max(2, found.factor // 2), max(4, found.factor)
    finer = f"{least * segments} to {most * segments} segments" if segments else "a finer net"
    remedy = (
        f"{finer}, more internal damping (damping_ratio: {DAMPING:g} of critical), or a line that does not go slack"
        if by_mesh >= by_step
        else "a shorter step, or the internal damping that the line has"
    )
    if knots:
        return (
            f"the peak of '{line}', {spoken(found.peak, 'N')}, is {mesh} with twice the knots{damped} and {half} "
            f"with half the step: {100.0 * change_of(found):.0f} % where {100.0 * goal:g} % is asked for"
            f"{' (' + why + ')' if why else ''}; {remedy}"
        )
    return (
        f"the peak of '{line}', {spoken(found.peak, 'N')}, is {mesh} with twice the segments{damped} and {half} "
        f"with half the step: {100.0 * change_of(found):.0f} % where {100.0 * goal:g} % is asked for"
        f"{' (' + why + ')' if why else ''}{below}; {remedy}"
    )


def unchecked(why: str, off: bool = False) -> Notice:
    """Return the notice of a doubtful peak that was too costly to run again, or whose check is switched off."""
    return Notice(
        "peak-not-checked",
        f"{why}; twice the segments and half the step were not run: the check of the mesh is off"
        if off
        else f"{why}; twice the segments and half the step were not run: they would take too long",
        severity="warning",
        remedy="a sensitivity run runs them all the same",
    )
