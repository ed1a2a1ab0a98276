"""The time domain of one water level: memory, runs of every sea, what they have to say."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, TypeVar

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import one_after_the_other
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress
from moyai.core.store import DatasetStore
from moyai.core.validity import IdentityCheck, Notice
from moyai.sea.states import IrregularSea, RegularSea
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.hydrodynamics import RowHydrodynamics, solve_row
from moyai.structures.units.model import SNAP_RATIO, UnitSettings
from moyai.structures.units.seas import SeaAnswer
from moyai.structures.units.time.band import dense_coefficients, doubtful_gaps, wide_coefficients
from moyai.structures.units.time.datasets import (
    KeptRun,
    irregular_time_dataset,
    memory_dataset,
    regular_time_dataset,
    shown_run,
    status_of,
)
from moyai.structures.units.time.lines import LEAD, Carried, Reruns, rerun_events
from moyai.structures.units.time.memory import FIT, RowMemory, fit_row_memory
from moyai.structures.units.time.seas import REPEATING, SeaRun, Water3D, irregular_run, repeating_run
from moyai.structures.units.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

Found = TypeVar("Found")
#: Peak periods in a record, below which its largest values say nothing of the sea state
LEAST_WAVES = 10.0
#: Natural periods of sway in a record, for its largest slow excursion to be near its most probable
LEAST_CYCLES = 25.0
#: Frequency of slow drift, for its added mass [rad/s].
_SLOW = 1e-3
#: Error of the memory that is reported, of the largest response
_REPORTED = 0.02
#: Change of a growing motion from one period to the next that is reported.
_SEEN = 1e-3
#: Turns in which frequencies are added where the memory misses what was interpolated, and most of them a turn.
_MOST_TURNS, _MOST_GAPS = 2, 8


@dataclass(frozen=True)
class SeaInTime:
    """What a sea gave."""

    #: Datasets by the end of their path.
    groups: dict[str, xr.Dataset]
    notices: list[Notice]
    status: str
    #: Of the run that did not come to its end.
    message: str = ""


def water_in_time(
    at: RowAtLevel, hydro: RowHydrodynamics, steady: Array, settings: UnitSettings, *, store: DatasetStore | None,
    progress: Progress,
) -> tuple[Water3D, dict[str, xr.Dataset], list[IdentityCheck], list[Notice]]:  # fmt: skip
    """Solve the band of the memory and fit it; return also its dataset, identities and notices."""
    wide = wide_coefficients(hydro, settings.time.memory_frequencies, store=store, progress=progress)
    memory, wide = _fitted(hydro, wide, store, progress)
    checks = [replace(item, name=f"{at.name}: {item.name}") for item in memory.checks]
    notices = [
        Notice(
            "memory",
            f"{at.name}: {len(memory.poles)} poles represent the radiation memory; added mass and damping within "
            f"{100.0 * memory.error:.2g} % of the largest of their pair in the band of the waves, "
            f"{100.0 * memory.error_outside:.2g} % outside",
            value=memory.error, limit=_REPORTED, severity="information" if memory.error <= _REPORTED else "warning",
            remedy="give smaller panels or more memory frequencies",
        )
    ]  # fmt: skip
    data = {"memory": memory_dataset(at, memory, wide.omega)}
    return Water3D(at, wide, memory, steady, settings), data, checks, notices


def _fitted(
    hydro: RowHydrodynamics, wide: RowHydrodynamics, store: DatasetStore | None, progress: Progress
) -> tuple[RowMemory, RowHydrodynamics]:
    """Fit the memory; where it misses what stands between the frequencies, solve those in the middle and fit again."""
    low, high = float(hydro.omega[0]), float(hydro.omega[-1])
    for turn in range(_MOST_TURNS + 1):
        dense = dense_coefficients(wide)
        memory: RowMemory = fit_row_memory(*dense, band=(low, high))
        if memory.error <= FIT or wide.panels is None or turn == _MOST_TURNS:
            break
        inside = (dense[0] >= low) & (dense[0] <= high)
        error = np.where(inside, memory.misfit(*dense), 0.0)
        further = doubtful_gaps(wide.omega, dense[0], error, 0.5 * FIT, _MOST_GAPS)
        if not further.size:
            break
        added = solve_row(wide.panels, wide.water, wide.centres, further, wide.headings, store=store, progress=progress)
        every = sorted((*wide.solutions, *added.solutions), key=lambda item: item.omega)
        wide = replace(wide, solutions=tuple(every))
    return memory, wide


def sea_in_time(
    water: Water3D, sea: RegularSea | IrregularSea, answers: list[SeaAnswer], progress: Progress
) -> SeaInTime:
    """Run all periods or all realisations of a sea."""
    found, stopped = runs_of(water, sea, answers, _kept_and_carried, progress)
    runs, carried = [run for run, _ in found], [parts for run, parts in found if run.status == "converged"]
    good = [item for item in runs if item.status == "converged"] or runs[:1]
    regular = isinstance(sea, RegularSea)
    notices: list[Notice] = []
    data = numbers_of(water.at, sea, good)
    if isinstance(sea, RegularSea):
        if len(carried) == len(runs):
            data, further = _periods_in_motion(water, sea, data, carried, progress)
            notices += further
        groups = {f"T{period:g}": item.series for period, item in zip(sea.periods, good)}
    else:
        if len(carried) == len(runs):
            data, further = _in_motion(water, sea, data, [member for (member,) in carried], progress)
            notices += further
        groups = {"realisation": good[shown_run(good)].series}
    status = "interrupted" if stopped else status_of(runs)
    data.attrs["status"] = status
    data.attrs["drift"] = "none" if not water.settings.drift else "mean" if regular else "newman"
    bad = [item.message for item in runs if item.status == "diverged"]
    return SeaInTime(
        {"": data} | {f"/{name}": item for name, item in groups.items()},
        [*notices, *_notices(water, sea, data, good)],
        status, bad[0] if bad else "",
    )  # fmt: skip


def numbers_of(at: RowAtLevel, sea: RegularSea | IrregularSea, runs: list[KeptRun]) -> xr.Dataset:
    """Return the numbers of a sea."""
    if isinstance(sea, RegularSea):
        return regular_time_dataset(at, sea, runs)
    return irregular_time_dataset(at, sea, runs)


def runs_of(
    water: Water3D, sea: RegularSea | IrregularSea, answers: list[SeaAnswer], take: Callable[[SeaRun], Found],
    progress: Progress,
) -> tuple[list[Found], bool]:  # fmt: skip
    """Return what is taken of the run of every period or realisation of a sea, and whether they were stopped.

    So many run at a time as there are cores. The first that does not come to its end is the last.

    Raises
    ------
    KeyboardInterrupt
        When it comes before there is anything.
    """
    found: dict[int, tuple[str, Found]] = {}

    def run(number: int, heard: Progress) -> str:
        if isinstance(sea, RegularSea):
            ended = repeating_run(water, sea, sea.periods[number], answers[number], heard)
        else:
            ended = irregular_run(water, sea, number, answers[0], heard)
        found[number] = ended.run.status, take(ended)
        return ended.run.status

    regular, where = isinstance(sea, RegularSea), f"{water.at.name}, {sea.name}"
    numbers = range(len(answers) if regular else water.time.realisations)
    stopped = False
    try:
        for status in one_after_the_other(run, numbers, f"{'time' if regular else 'realisations'}, {where}", progress):
            if status != "converged":
                break
    except KeyboardInterrupt:
        stopped = True
        if not found:
            raise
    out: list[Found] = []
    for number in numbers:
        status, taken = found.get(number, ("", None))
        if taken is None:
            break
        out.append(taken)
        if status != "converged":
            return out, stopped or status == "interrupted"
    return out, stopped


def _kept_and_carried(run: SeaRun) -> tuple[KeptRun, list[Carried]]:
    return KeptRun.of(run), [_carried(part) for part in run.parts]


def _carried(run: SeaRun) -> Carried:
    """Return what reruns of lines need of the analysed part of a run."""
    found = run.run
    first = int(np.searchsorted(found.time, run.begin - LEAD * run.period))
    part = slice(max(first, 0), run.kept.stop)
    return Carried(
        found.time[part], found.reduced[part], found.velocity[part], found.model.at.free, found.tension[part],
        run.waves, run.begin, run.period,
    )  # fmt: skip


def _in_motion(
    water: Water3D, sea: IrregularSea, data: xr.Dataset, carried: list[Carried], progress: Progress
) -> tuple[xr.Dataset, list[Notice]]:
    """Put the tensions of lines in motion in the place of those at rest where these do not serve."""
    still = data["line_tension_maximum_of_realisation"].values
    found, notices = _rerun(water, f"{water.at.name}, {sea.name}", carried, progress)
    if found is None:
        return data, notices
    moved = found.moved
    each = np.where(moved, found.tension, still)
    data = data.assign(
        line_tension_maximum_of_realisation=(("member", "line"), each),
        line_tension_bound_of_realisation=(("member", "line"), np.where(moved, found.bound, each)),
        line_tension_maximum=("line", each.mean(axis=0)),
        line_tension_maximum_lines_at_rest=("line", still.mean(axis=0)),
        lines_in_motion=("line", moved.astype(np.int8)),
    )
    return labelled(data), notices


def _periods_in_motion(
    water: Water3D, sea: RegularSea, data: xr.Dataset, carried: list[list[Carried]], progress: Progress
) -> tuple[xr.Dataset, list[Notice]]:
    """Do the same period by period; parts of a motion that does not repeat are taken as realisations are."""
    still = data["line_tension_maximum"].values
    tension, moved = still.copy(), np.zeros(still.shape, dtype=bool)
    named = "line_tension_maximum_of_realisation"
    each = data[named].values.copy() if named in data else None
    bound = None if each is None else each.copy()
    notices: list[Notice] = []
    for row, members in enumerate(carried):
        where = f"{water.at.name}, {sea.name}, T = {float(sea.periods[row]):g} s"
        found, further = _rerun(water, where, members, progress)
        notices += further
        if found is None:
            continue
        there = found.moved
        moved[row] = there
        tension[row] = np.where(there, found.tension.mean(axis=0), still[row])
        if each is not None and bound is not None and len(members) > 1:
            each[:, row] = np.where(there, found.tension, each[:, row])
            bound[:, row] = np.where(there, found.bound, each[:, row])
    if not moved.any():
        return data, notices
    data = data.assign(
        line_tension_maximum=(("period", "line"), tension),
        line_tension_maximum_lines_at_rest=(("period", "line"), still),
        lines_in_motion=(("period", "line"), moved.astype(np.int8)),
    )
    if each is not None and bound is not None:
        dims = ("member", "period", "line")
        data = data.assign({named: (dims, each), "line_tension_bound_of_realisation": (dims, bound)})
    return labelled(data), notices


def _rerun(
    water: Water3D, where: str, carried: list[Carried], progress: Progress
) -> tuple[Reruns | None, list[Notice]]:
    """Rerun the events of lines that lines at rest do not serve; nothing where they all do, or none can be moved."""
    if not water.at.line_names:
        return None, []
    try:
        found = rerun_events(water.at, carried, progress, f", {where}")
    except (InputError, ConvergenceError) as error:
        message = f"{where}: {error.fault.message}; lines stay at rest at every instant"
        return None, [Notice("lines-stay-at-rest", message, remedy=error.fault.remedy)]
    if found is None:
        return None, []
    names = ", ".join(name for name, moved in zip(water.at.line_names, found.moved.tolist(), strict=True) if moved)
    words = (
        f"{where}: {found.count} events were run with one line in motion ({names}), its fairlead as with lines at "
        "rest, until no further one could pass the largest"
    )
    return found, [Notice("lines-set-in-motion", words, severity="information")]


def _notices(water: Water3D, sea: RegularSea | IrregularSea, data: xr.Dataset, runs: list[KeptRun]) -> list[Notice]:
    where = f"{water.at.name}, {sea.name}"
    out: list[Notice] = []
    if not all(item.contacts for item in runs):
        out.append(
            Notice(
                "contacts-not-resolved",
                f"{where}: a stiff connector comes tight within fewer than ten steps; its largest load is uncertain",
                remedy="give a shorter time step",
            )
        )
    if data.sizes["line"]:
        named = "line_tension_maximum_of_realisation"
        largest = data[named if named in data else "line_tension_maximum"].values
        mean = np.broadcast_to(data["line_tension_mean"].values, largest.shape)
        with np.errstate(divide="ignore", invalid="ignore"):
            ratio = np.nan_to_num(largest / mean)
        if "lines_in_motion" in data:
            # the others were found to stay under the largest in motion
            ratio = np.where(data["lines_in_motion"].values.any(axis=-1, keepdims=True), 0.0, ratio)
        if float(ratio.max()) > SNAP_RATIO:
            line = str(data["line"].values[int(np.unravel_index(ratio.argmax(), ratio.shape)[-1])])
            out.append(
                Notice(
                    "snaps",
                    f"{where}: line '{line}' is pulled to {float(ratio.max()):.3g} times its mean tension, beyond the "
                    "range of lines at rest at every instant: its largest tension is higher than what is shown",
                    value=float(ratio.max()), limit=SNAP_RATIO,
                    remedy="use longer or softer lines; lines are set in motion where their segments give mass, "
                    "diameter, drag_normal, drag_tangential and added_mass_normal",
                )
            )  # fmt: skip
    if isinstance(sea, RegularSea):
        for period, run in zip(sea.periods, runs):
            there = f"{where}, T = {float(period):g} s"
            if run.growth and run.change > _SEEN:
                out.append(
                    Notice(
                        "still-growing",
                        f"{there}: the motion changes by {100.0 * run.change:.2g} % from one period to the next, "
                        f"{100.0 * run.growth:.2g} % more each period: it grows slowly to another motion, whose loads "
                        "are higher",
                        value=run.change, limit=_SEEN, remedy="a longer duration, or more damping",
                    )
                )  # fmt: skip
            elif run.change > REPEATING:
                ends = f"means over {len(run.parts)} parts of its end" if run.parts else "those of its end alone"
                out.append(
                    Notice(
                        "not-repeating",
                        f"{there}: the motion changes by {100.0 * run.change:.0f} % from one period to the next: it "
                        f"does not repeat, and its largest values are {ends}",
                        value=run.change, limit=REPEATING,
                        remedy="slack connectors and lines may never settle to one period; a longer duration narrows "
                            "the band",
                    )
                )  # fmt: skip
    if isinstance(sea, IrregularSea):
        waves = sea.duration * float(sea.spectrum.peak_omega) / (2.0 * np.pi)
        if waves < LEAST_WAVES:
            out.append(
                Notice(
                    "short-record",
                    f"{where}: the record of {sea.duration:g} s holds {waves:.3g} peak periods; its largest values are "
                    "none of the sea state",
                    value=waves, limit=LEAST_WAVES, severity="error", remedy="give a longer duration",
                )
            )  # fmt: skip
        period = slow_sway_period(water)
        if water.settings.drift and sea.duration < LEAST_CYCLES * period < math.inf:
            cycles = sea.duration / period
            out.append(
                Notice(
                    "few-slow-cycles",
                    f"{where}: the record of {sea.duration:g} s holds {cycles:.2g} natural periods of sway "
                    f"({period:.3g} s); its largest slow excursion "
                    + ("scatters widely" if cycles >= 1.0 else "is not in it"),
                    value=cycles, limit=LEAST_CYCLES, severity="warning" if cycles >= 1.0 else "error",
                    remedy=f"give a duration of {LEAST_CYCLES * period:.0f} s or more, or more realisations",
                )
            )  # fmt: skip
    return out


def slow_sway_period(water: Water3D) -> float:
    """Return the natural period of the whole row across its axis on its lines at rest [s]; infinite without any."""
    at = water.at
    across = np.tile(np.eye(6)[0], at.row.count)
    stiffness = float(across @ at.line_stiffness(np.zeros(at.size)) @ across)
    added = water.memory.coefficients(np.array([_SLOW]))[0][0]
    mass = float(across @ (at.inertia + added) @ across)
    return 2.0 * math.pi * math.sqrt(mass / stiffness) if stiffness > 0.0 else math.inf
