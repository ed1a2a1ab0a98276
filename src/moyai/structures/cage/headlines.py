"""The numbers of a cage's first page: volume, drag, tensions, offset, anchors, stress, with the band of the net law.

A sweep of currents never decides one of them: the design state does, which is the current of the site and its seas.
How the answer is made: docs/answer/cage.md.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.headline import Band, Headline, Sense, all_judged
from moyai.core.options import checks_words
from moyai.structures.cage.bands import AllRuns, LawRuns, LevelState, alone, band_in_sea, band_with_laws, reach
from moyai.structures.cage.conditions import condition_headlines, sea_words
from moyai.structures.cage.flexible.law_runs import IN_WAVES
from moyai.structures.cage.flexible.problem import FlexibleCageProblem
from moyai.structures.cage.flexible.sensitivity import (
    COARSER,
    DRAG,
    DRAG_IN_CURRENT,
    LEAST_VOLUME,
    NET_TENSION,
    NET_TENSION_IN_CURRENT,
    OFFSET,
    STRESS,
    VOLUME_IN_CURRENT,
    tension_of,
)

if TYPE_CHECKING:
    import xarray as xr

STATICS, DYNAMIC = "equilibrium in the current of the site", "run through time"
#: By which factors a finer mesh may move each number, either way.
Factors = Mapping[str, tuple[float, float]]
NO_MESH: Factors = MappingProxyType({})
#: Change of the tension of the net with the mesh from which on it is known from below alone.
_GROWTH = 0.2
Groups = Mapping[str, "xr.Dataset"]
NOT_JUDGED = Headline(
    "not_judged", "Not judged", math.nan, "1",
    text="one line or buoy lost, wear and fatigue, chafe of the net, soil of the anchors", condition=True,
)  # fmt: skip
_OTHER_DIRECTIONS = replace(
    NOT_JUDGED, text=f"{NOT_JUDGED.text}, other directions of current and waves",
    detail="along the diagonal of a frame an anchor may take half as much load again as along its side, and less "
        "volume is "
    "left: run both headings",
)  # fmt: skip


def flexible_headlines(problem: FlexibleCageProblem, groups: Groups) -> tuple[Headline, ...]:
    """Return the first page's numbers of a flexible cage.

    Parameters
    ----------
    problem : FlexibleCageProblem
    groups : mapping of str to xarray.Dataset
        What was run, by its place in the result.
    """
    levels = [path[1:] for path in groups if path.count("/") == 1]
    known = [_state(level, groups) for level in levels]
    laws = _law_runs(groups)
    runs = [item for state in known for item in _runs(state, groups, laws)]
    states = [state for state in known if state.row >= 0]
    factors = _mesh_factors(groups)
    tension, utilisation = _tension(states, runs, factors)
    items = [
        *_volume(states, runs, factors),
        *_drag(states, runs, factors),
        *tension,
        *utilisation,
        *_offset(states, runs, factors),
        *_anchor(states, runs, factors),
        *_net(states, runs, factors),
        *_stress(states, runs, factors),
    ]
    named = [_OTHER_DIRECTIONS] if runs else [NOT_JUDGED]
    return (*items, *condition_headlines(groups), *(named if items else []))


@checks_words
def judged_seas(items: Iterable[Headline], sense: Sense = "at most", factors: Factors = NO_MESH) -> list[Headline]:
    """Return what is judged of one number of all seas, with the band of the mesh, those of one short seed as bounds.

    Both decide which one is the worst: they come first.
    """
    return all_judged((alone(_with_mesh(item, factors)) for item in items), sense)


def _mesh_factors(groups: Groups) -> Factors:
    """Return by which factors a finer mesh may move each number: what a coarser one changed, either way."""
    found: dict[str, tuple[float, float]] = {}
    for path, group in groups.items():
        if "/sensitivity/" not in path or COARSER not in group.variables["variant"].values:
            continue
        given, coarser = (group["value"].sel(variant=name).values for name in ("as given", COARSER))
        for quantity, first, other in zip(group.variables["quantity"].values, given, coarser, strict=True):
            if first > 0.0 and math.isfinite(other):
                change = min(abs(float(other) / float(first) - 1.0), 1.0)
                low, high = found.get(str(quantity), (1.0, 1.0))
                found[str(quantity)] = min(low, 1.0 - change), max(high, 1.0 + change)
    return found


def _with_mesh(item: Headline, factors: Factors) -> Headline:
    """Return a number whose band covers the mesh as well, where it was checked."""
    kinds = ("anchor", "bridle", "frame", "buoy")
    line = next((kind for kind in kinds if item.where.removeprefix("lower end of ").startswith(kind)), "")
    steady = item.model == STATICS
    quantity = {
        "volume_left": VOLUME_IN_CURRENT if steady else LEAST_VOLUME, "drag": DRAG_IN_CURRENT if steady else DRAG,
        "line_tension": tension_of(line), "line_utilisation": tension_of(line), "offset": OFFSET,
        "anchor_tension": tension_of("anchor"),
        "collar_stress": STRESS, "net_tension": NET_TENSION_IN_CURRENT if steady else NET_TENSION,
    }.get(item.name, "")  # fmt: skip
    if quantity not in factors:
        return item
    less, more = factors[quantity]
    band = item.band or Band(item.value, item.value, "")
    words = f"mesh ±{100.0 * (more - 1.0):.2g} %, the change of a coarser one"
    words = "; ".join(filter(None, (band.of, words)))
    high = band.high * more
    if item.name == "volume_left":
        # cloth does not stretch beyond what was built
        high = max(min(high, 1.0), item.value)
    item = replace(item, band=replace(band, low=band.low * less, high=high, of=words))
    if item.name != "net_tension" or more <= 1.0 + _GROWTH:
        return item
    # what a weight or a rope brings in at a knot goes over the width of the mesh there: a finer one has no limit
    grows = "grows with finer meshes at weights and ropes"
    return replace(item, bound="at least", detail="; ".join(filter(None, (item.detail, grows))))


def _state(level: str, groups: Groups) -> LevelState:
    """Return the equilibrium in the current of the site, not the fastest of the sweep; row -1 where it was not run."""
    import xarray as xr

    speed = float(groups[f"/{level}"].attrs["current"])
    statics, laws, none = groups.get(f"/{level}/statics"), groups.get(f"/{level}/laws"), xr.Dataset()
    row = -1
    if statics is not None:
        speeds = statics.variables["current_speed"].values
        at = int(np.argmin(np.abs(speeds - speed)))
        row = at if abs(float(speeds[at]) - speed) <= 1e-6 * max(1.0, speed) else -1
    return LevelState(level, speed, row, groups.get(f"/{level}/cage", none), none if statics is None else statics, laws)


def _law_runs(groups: Groups) -> AllRuns:
    """Return what the other laws change in the waves that were run under them, by their places as runs."""
    found = {}
    for path, group in groups.items():
        parts = path.strip("/").split("/")
        if len(parts) == 4 and parts[1] == IN_WAVES:
            found["/".join((parts[0], *parts[2:]))] = LawRuns.of(group)
    return found


def _runs(state: LevelState, groups: Groups, laws: AllRuns) -> Iterator[Run]:
    """Yield water level, words and series of every run through time that came beyond its growing waves."""
    for path, run in groups.items():
        parts = path.strip("/").split("/")
        if len(parts) == 4 and parts[1] == "time" and parts[0] == state.level:
            if not float(run["time"].values[-1]) >= float(run.attrs["ramp"]):
                continue
            place = "/".join((parts[0], *parts[2:]))
            words = f"{sea_words(parts[2], run, state.speed)}, {state.level}"
            yield replace(state, law_runs=laws, wave=place), words, run


def volume_text(volume: float) -> str:
    """Return a volume [m3] in words, without a power of ten."""
    return f"{volume:.0f} m³" if volume >= 1000.0 else f"{volume:.3g} m³"


#: The water level of a run through time, its sea in words, its series.
Run = tuple[LevelState, str, "xr.Dataset"]
Runs = list[Run]


def _volume(states: list[LevelState], runs: Runs, factors: Factors = NO_MESH) -> list[Headline]:
    """Return the least volume in the current of the site and, judged with it, what the sea leaves for moments."""
    found = []
    for state in states:
        shares = state.statics.variables["volume_share"].values[state.row]
        value, at = float(shares.min()), int(np.argmin(shares))
        built = float(state.cage.variables["rest_volume"].values[at])
        detail = f"{volume_text(value * built)} of {volume_text(built)} as built"
        band = state.band("volume_share")
        found.append(
            Headline("volume_left", "volume left", value, "1", state.where, STATICS, band, detail=detail)
        )  # fmt: skip
    moments = []
    for state, where, run in runs:
        series = run["volume_share"].values.min(axis=1)
        least = float(series[run["time"].values >= float(run.attrs["ramp"])].min())
        # the largest loss has the scatter of a maximum
        low, high, seed = reach(run, 1.0 - least, 1.0 - series, scale=least)
        band = band_with_laws(state, "volume_share", 1.0 - high, 1.0 - low, seed)
        moments.append(Headline("volume_left", "volume left for moments", least, "1", where, DYNAMIC, band))
    worst, words = judged_seas(moments, "at least", factors), ""
    if worst:
        band = worst[0].band
        span = "" if band is None else f" ({band.low:.3g} to {band.high:.3g})"
        words = f"down to {worst[0].value:.3g} for moments in the sea" + span
    return _with_moments(judged_seas(found, "at least", factors), worst, words)


def _drag(states: list[LevelState], runs: Runs, factors: Factors = NO_MESH) -> list[Headline]:
    """Return the largest drag in the current of the site and, judged with it, what the sea brings for moments."""
    found = []
    for state in states:
        value = float(state.statics.variables["total_drag"].values[state.row])
        along = state.statics.variables["drag_along"].values[state.row]
        shares = [
            (str(part), float(share))
            for part, share in zip(state.statics.variables["part"].values, along)
            if abs(share) > 5e-3 * value
        ]
        detail = ", ".join(f"{part} {100.0 * share / value:.0f} %" for part, share in shares)
        band = state.band("drag")
        found.append(Headline("drag", "drag in the current", value, "N", state.where, STATICS, band, detail=detail))
    moments = []
    for state, where, run in runs:
        series = np.linalg.norm(run["drag"].values.sum(axis=1), axis=1)
        value = float(series.max())
        low, high, seed = reach(run, value, series, run["drag_time"].values)
        band = band_with_laws(state, "drag", low, high, seed)
        moments.append(Headline("drag", "drag for moments", value, "N", where, DYNAMIC, band))
    worst, words = judged_seas(moments, factors=factors), ""
    if worst:
        band = worst[0].band
        span = "" if band is None else f" ({band.low / 1e3:.3g} to {band.high / 1e3:.3g} kN)"
        words = f"up to {worst[0].value / 1e3:.3g} kN for moments in the sea" + span
    return _with_moments(judged_seas(found, factors=factors), worst, words)


def _with_moments(steady: list[Headline], moments: list[Headline], words: str) -> list[Headline]:
    """Return numbers of the current alone, in words those for moments in the sea too, and these, judged, not shown."""
    if steady and moments:
        detail = "; ".join(filter(None, (steady[0].detail, words)))
        steady = [replace(steady[0], detail=detail), *steady[1:]]
    return [*steady, *(replace(item, shown=False) for item in moments)]


def _tension(states: list[LevelState], runs: Runs, factors: Factors = NO_MESH) -> tuple[list[Headline], list[Headline]]:
    """Return the governing tension and its utilisation: of the seas where they were run, else of the current.

    Each line carries its own band; the one whose judged end is nearest to its breaking load is judged.
    """
    used: dict[str, Headline] = {}
    tensions: dict[str, Headline] = {}

    def add(item: Headline, share: float) -> None:
        if not share > 0.0:
            return
        factor = share / item.value
        band = item.band
        used[item.where] = Headline(
            "line_utilisation", "tension over breaking load", share, "1", item.where, item.model,
            None if band is None else replace(band, low=band.low * factor, high=band.high * factor),
            detail=f"breaking load of new rope {1e-3 / factor:.4g} kN, without a safety factor",
            mean=None if item.mean is None else item.mean * factor,
        )  # fmt: skip
        tensions[item.where] = item

    for state, where, run in runs:
        if "utilisation" in run:
            for line, share in enumerate(run["utilisation"].values):
                add(_dynamic_tension(run, line, where, state), float(share))
    for state in [] if tensions else states:
        for line, name in enumerate(state.statics.variables["line"].values):
            add(
                _static_tension(state, line, str(name)),
                float(state.statics.variables["utilisation"].values[state.row, line]),
            )
    if not used:
        return [], []
    utilisations = judged_seas(used.values(), factors=factors)
    own = [
        replace(alone(_with_mesh(tensions[item.where], factors)), shown=item.shown, mean=None) for item in utilisations
    ]
    return own, utilisations


def _static_tension(state: LevelState, line: int, name: str) -> Headline:
    """Return the tension of a line in the current of the site with the band of the law of the net."""
    value = float(state.statics.variables["line_tension_maximum"].values[state.row, line])
    return Headline(
        "line_tension", "tension of the governing line", value, "N", f"{name}, {state.where}", STATICS,
        state.band("line_tension_maximum", line), detail="no sea was run: waves are not in it",
    )  # fmt: skip


def _dynamic_tension(run: xr.Dataset, line: int, where: str, state: LevelState | None) -> Headline:
    """Return the highest tension of a run with its band: chance of the seed, and the law of the net."""
    value = float(run["line_tension_maximum"].values[line])
    details = []
    everything = run["line_tension_maximum"].values
    if float(everything.max()) > 1.01 * value:
        name, most = str(run["line"].values[int(np.argmax(everything))]), float(everything.max()) / 1e3
        details.append(f"nearest to its breaking load; the largest tension of all is {most:.3g} kN, in {name}")
    mean = float(run["line_tension_mean"].values[line]) if "line_tension_mean" in run else None
    slack, snaps = float(run["slack_share"].values[line]), int(run["snap_count"].values[line])
    if slack > 0.0:
        details.append(f"slack for {100.0 * slack:.2g} % of the time" + (f", {snaps} snaps" if snaps else ""))
    series = run["line_tension_peak_since_row"].values[:, line]
    name = str(run["line"].values[line])
    # what a line that carries little still rises by counts against the one nearest to its breaking load
    share = run["utilisation"].values
    scale = value * float(share.max()) / max(float(share[line]), 1e-300)
    band = band_in_sea(state, "line_tension_maximum", run, value, series, line, scale)
    return Headline(
        "line_tension", "tension of the governing line", value, "N", f"{name}, {where}",
        f"{DYNAMIC}, {run.attrs['theory']}", band, detail="; ".join(details), mean=mean,
    )  # fmt: skip


def _offset(states: list[LevelState], runs: Runs, factors: Factors = NO_MESH) -> list[Headline]:
    """Return the largest way of a collar from its place in still water."""
    found: list[tuple[float, str, str, Band | None]] = []
    for state in states:
        calm = state.statics.variables["collar_place"].values[0]
        away = state.statics.variables["collar_place"].values[state.row] - calm
        found.append(
            (float(np.linalg.norm(away[:, :2], axis=1).max()), state.where, STATICS, state.band("largest_offset"))
        )
        for at, where, run in runs:
            if at.level != state.level:
                continue
            late = run["time"].values >= float(run.attrs["ramp"])
            moved = np.linalg.norm((run["collar_place"].values - calm)[..., :2], axis=-1)
            series = moved.reshape(moved.shape[0], -1).max(axis=1)
            value = float(series[late].max())
            found.append((value, where, DYNAMIC, band_in_sea(at, "largest_offset", run, value, series)))
    if not found or max(item[0] for item in found) < 1e-9:
        return []
    return judged_seas(
        (
            Headline("offset", "largest offset of a collar", value, "m", where, model, band)
            for value, where, model, band in found
        ),
        factors=factors,
    )


def _anchor(states: list[LevelState], runs: Runs, factors: Factors = NO_MESH) -> list[Headline]:
    found: list[tuple[float, str, str, str, Band | None]] = []
    for state, where, run in runs:
        if "anchor_tension_maximum" not in run:
            continue
        pulls, lines = run["anchor_tension_maximum"].values, [str(name) for name in run["line"].values]
        up = float(run["anchor_vertical_tension_maximum"].values.max())
        detail = f"upwards {up / 1e3:.3g} kN, the largest of all anchors in this run, without a band"
        for name, pull in zip(map(str, run["anchor"].values), map(float, pulls), strict=True):
            line = lines.index(name)
            # the lower end has no series of its own peaks: the chance is that of the line's largest tension
            share = pull / max(float(run["line_tension_maximum"].values[line]), 1e-300)
            series = share * run["line_tension_peak_since_row"].values[:, line]
            band = band_in_sea(state, "anchor_tension_maximum", run, pull, series, line, float(pulls.max()))
            found.append((pull, f"lower end of {name}, {where}", DYNAMIC, detail, band))
    for state in [] if found else states:
        if "anchor_tension" in state.statics and state.statics["anchor_tension"].size:
            pulls = state.statics.variables["anchor_tension"].values[state.row]
            at = int(np.argmax(pulls))
            up = float(state.statics.variables["anchor_vertical_tension"].values[state.row, at])
            name = str(state.statics.variables["anchor"].values[at])
            detail = f"upwards {up / 1e3:.3g} kN; no sea was run"
            found.append(
                (float(pulls[at]), f"{name}, {state.where}", STATICS, detail, state.band("anchor_tension_maximum"))
            )
    if not found:
        return []
    return judged_seas(
        (
            Headline("anchor_tension", "largest pull on an anchor", value, "N", where, model, band, detail=detail)
            for value, where, model, detail, band in found
        ),
        factors=factors,
    )


def _net(states: list[LevelState], runs: Runs, factors: Factors = NO_MESH) -> list[Headline]:
    """Return the largest tension of the net over its width: of the seas where they were run, else of the current."""
    found: list[tuple[float, str, str, Band | None]] = []
    for state, where, run in runs:
        late = run["time"].values >= float(run.attrs["ramp"])
        series = run["net_tension_peak_since_row"].values.max(axis=1)
        value = float(series[late].max())
        found.append((value, where, DYNAMIC, band_in_sea(state, "net_tension", run, value, series)))
    for state in [] if found else states:
        value = float(state.statics.variables["net_tension"].values[state.row].max())
        found.append((value, state.where, STATICS, state.band("net_tension")))
    return judged_seas(
        (
        Headline(
            "net_tension", "largest tension of the net", value, "N/m", where, model, band,
            detail="ropes sewn into the net share it; a bar of the mesh spreads what a weight or rope brings in",
        )
        for value, where, model, band in found
        ),
        factors=factors,
    )  # fmt: skip


def _stress(states: list[LevelState], runs: Runs, factors: Factors = NO_MESH) -> list[Headline]:
    found: list[tuple[float, str, str, Band | None]] = []
    for state in states:
        if "collar_stress_largest" in state.statics:
            value = float(state.statics.variables["collar_stress_largest"].values[state.row].max())
            found.append((value, state.where, STATICS, state.band("collar_stress")))
    for state, where, run in runs:
        if "collar_stress_largest" in run:
            late = run["time"].values >= float(run.attrs["ramp"])
            stress = run["collar_stress_largest"].values
            series = stress.reshape(stress.shape[0], -1).max(axis=1)
            value = float(series[late].max())
            band = band_in_sea(state, "collar_stress", run, value, series)
            found.append((value, where, DYNAMIC, band))
    if not found:
        return []
    return judged_seas(
        (
            Headline("collar_stress", "largest stress of the collar", value, "Pa", where, model, band)
            for value, where, model, band in found
        ),
        factors=factors,
    )
