"""Run a rigid cage: every water level, every sea, the analyses that the case names."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import one_after_the_other
from moyai.core.collected import STOPPED, Collected, most_severe
from moyai.core.headline import SEAS_LEFT_OUT
from moyai.core.progress import Progress, silent
from moyai.core.results import Result
from moyai.core.validity import Notice
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.cage.conditions import height_notices
from moyai.structures.cage.rigid.checks import (
    cage_notices,
    level_notices,
    mass_checks,
    rest_checks,
    run_checks,
    run_notices,
)
from moyai.structures.cage.rigid.datasets import cage_dataset, sea_dataset, statics_dataset, time_dataset
from moyai.structures.cage.rigid.headlines import (
    offsets_of_each,
    rigid_headlines,
    rigid_offsets,
    tensions_of_each,
)
from moyai.structures.cage.rigid.laws import IN_WAVES, laws_dataset
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.model import CageSea, RigidCageProblem, RigidCageWaves
from moyai.structures.cage.rigid.modes import natural_modes
from moyai.structures.cage.rigid.pack import pack
from moyai.structures.cage.rigid.realisations import RigidCageRealisation, further_realisations, lost, with_realisations
from moyai.structures.cage.rigid.realisations import notices as realisation_notices
from moyai.structures.cage.rigid.runs import RigidCageRun, run_wave
from moyai.structures.cage.rigid.sensitivity import sensitivity_dataset
from moyai.structures.cage.rigid.setup import at_level, lines_of
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium, equilibrium_with_lines, free_floating, size_of
from moyai.structures.cage.rigid.variables import VOCABULARY
from moyai.structures.cage.rigid.waves import RigidCageWave, current_along, waves_of

if TYPE_CHECKING:
    import xarray as xr


def run(problem: RigidCageProblem, progress: Progress = silent) -> Result:
    """Run all analyses of a rigid cage.

    Parameters
    ----------
    problem : RigidCageProblem
    progress : Progress
        Called after every wave; KeyboardInterrupt ends the run with what there is and the status ``interrupted``.

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.

    Raises
    ------
    InputError
        When the cage sinks, its lines cannot reach, or a current would carry it away.
    """
    collected = Collected()
    lines = lines_of(problem)
    collected.take(_steps(problem, lines, collected, progress))
    return _result(problem, collected)


def rest_at(
    problem: RigidCageProblem, lines: tuple[CageLine, ...], water: Water
) -> tuple[RigidCageEquilibrium, RigidCageEquilibrium]:
    """Return the cage floating freely and as moored; without lines in a current both float freely in still water."""
    viscosity = problem.kinematic_viscosity
    free = free_floating(problem.cage, water, viscosity)
    if not lines:
        return free, free
    return free, equilibrium_with_lines(problem.cage, lines, water, viscosity, problem.environment.current)


def _steps(
    problem: RigidCageProblem, lines: tuple[CageLine, ...], collected: Collected, progress: Progress
) -> Iterator[None]:
    import xarray as xr

    levels = problem.environment.water_levels
    collected.checks.extend(mass_checks(problem.cage))
    collected.notices.extend(cage_notices(problem))
    for index, (name, level) in enumerate(levels):
        progress("water levels", index, len(levels))
        water = problem.environment.water_at(level)
        here = at_level(lines, level)
        root = f"/{name}"
        collected.groups[root] = xr.Dataset(
            attrs={"water_level": level, "water_depth": water.depth, "current": current_along(problem, water)}
        )
        collected.groups[f"{root}/cage"] = cage_dataset(problem, water)
        free, rest = rest_at(problem, here, water)
        packed = pack(problem.cage, here, water, problem.kinematic_viscosity)
        modes = natural_modes(packed, rest, size_of(problem.cage))
        collected.groups[f"{root}/statics"] = statics_dataset(problem, here, free, rest, modes)
        collected.checks.extend(rest_checks(name, problem, here, water, free, rest))
        collected.notices.extend(level_notices(name, problem, here, water, free, rest))
        yield
        for sea in problem.seas:
            if "time" in problem.settings.analyses:
                yield from _sea_steps(problem, here, rest, water, sea, collected, root, progress)
            if "sensitivity" in problem.settings.analyses and here:
                yield from _sensitivity_steps(problem, here, water, sea, collected, root, progress)
        if here and "time" in problem.settings.analyses and problem.equations == "sound":
            yield from _law_steps(problem, here, rest, water, collected, root, progress)
    progress("water levels", len(levels), len(levels))


def _law_steps(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    rest: RigidCageEquilibrium,
    water: Water,
    collected: Collected,
    root: str,
    progress: Progress,
) -> Iterator[None]:
    """Run the waves that give the highest tension of a line or the largest offset under every valid law of nets."""
    worst: dict[str, tuple[float, CageSea, int]] = {}
    for sea in problem.seas:
        known = collected.groups.get(f"{root}/waves/{sea.name}")
        if known is None or not known["line_tension_maximum"].size:
            continue
        _, offsets = rigid_offsets(collected.groups[f"{root}/statics"], known)
        for number in range(known.sizes["wave"]):
            # of the means over realisations, which the first page shows
            peaks = tensions_of_each(known, number).mean(axis=0).max(axis=1)
            each = {f"line {line}": float(peak) for line, peak in enumerate(peaks)}
            way = float(offsets_of_each(known, float(offsets[number])).mean())
            values = {"tension": float(peaks.max()), "offset": way, **each}
            for name, value in values.items():
                if name not in worst or value > worst[name][0]:
                    worst[name] = value, sea, number
    done: set[tuple[str, int]] = set()
    # the wave of the highest tension comes first
    for _, sea, number in worst.values():
        if (sea.name, number) in done:
            continue
        known = collected.groups[f"{root}/waves/{sea.name}"]
        at_rest, offsets = rigid_offsets(collected.groups[f"{root}/statics"], known)
        case = (_peaks(known)[number], at_rest, float(offsets[number]))
        wave = waves_of(problem, sea, water)[number]
        found, notice = laws_dataset(problem, lines, rest, water, wave, case, progress)
        label = f"wave {number + 1}" if wave.regular else "sea"
        found.attrs["sea"] = sea.name
        collected.groups[f"{root}/{IN_WAVES}/{sea.name}/{label}"] = found
        if not done:
            collected.groups[f"{root}/laws"] = found
            if notice.severity == "warning":
                # it says more than that the Reynolds number is out of the range of the law
                collected.notices[:] = [one for one in collected.notices if one.code != "net-reynolds-range"]
            collected.notices.append(replace(notice, message=f"{sea.name}: {notice.message}"))
        done.add((sea.name, number))
        yield


def _peaks(sea: xr.Dataset) -> Array:
    """Return the highest tension of each line in each wave, (waves, lines) [N]."""
    found: Array = sea["line_tension_maximum"].values.reshape(sea.sizes["wave"], sea.sizes["line"], -1).max(axis=2)
    return found


def _sea_steps(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    rest: RigidCageEquilibrium,
    water: Water,
    sea: CageSea,
    collected: Collected,
    root: str,
    progress: Progress,
) -> Iterator[None]:
    waves = waves_of(problem, sea, water)
    runs: list[RigidCageRun] = []
    reported: list[Notice] = []

    def march(wave: RigidCageWave, heard: Progress) -> RigidCageRun:
        def told(what: str, done: float, total: float) -> None:
            heard(f"time, {sea.name}", done, total)

        return run_wave(problem, lines, rest, water, wave, progress=silent if wave.regular else told)

    others: list[RigidCageRealisation] = []
    group = f"{root}/waves/{sea.name}"
    try:
        marched = one_after_the_other(march, waves, f"time, {sea.name}", progress)
        for number, (wave, found) in enumerate(zip(waves, marched, strict=True)):
            runs.append(found)
            label = f"wave {number + 1}" if wave.regular else "sea"
            series = time_dataset(problem, found, lines)
            collected.groups[f"{root}/time/{sea.name}/{label}"] = series
            collected.groups[group] = sea_dataset(problem, water, runs, lines)
            reported.extend(run_notices(problem, found, lines))
            collected.checks.extend(run_checks(sea.name, problem, found, lines))
            if found.march.status == "interrupted":
                collected.interrupted = STOPPED
                raise KeyboardInterrupt
            if found.march.status == "not_converged":
                collected.failures.append(
                    f"{sea.name}, {wave.name}: the motion left all bounds at t = {found.march.time[-1]:.4g} s"
                )
            yield
        if isinstance(sea, IrregularSea) and runs[0].march.status == "converged":
            own, first = collected.groups[group], RigidCageRealisation.of(problem, runs[0])
            at_rest, _ = rigid_offsets(collected.groups[f"{root}/statics"], own)
            for one in further_realisations(problem, lines, rest, water, sea, progress):
                others.append(one)
                collected.groups[group] = with_realisations(own, [first, *others], at_rest)
                yield
            if said := lost(others):
                collected.failures.append(f"{sea.name}: {said}")
    finally:
        # what is stopped keeps what the runs that ended say
        if runs and runs[-1].march.status != "interrupted":
            collected.notices.extend(height_notices(sea.name, series, collected.groups[group]))
        collected.notices.extend(
            replace(notice, message=f"{sea.name}: {notice.message}")
            for notice in most_severe([*reported, *realisation_notices(others, lines)])
        )


def _sensitivity_steps(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    water: Water,
    sea: CageSea,
    collected: Collected,
    root: str,
    progress: Progress,
) -> Iterator[None]:
    """Run the wave of the largest peak (the last one without `time`) with other line stiffnesses."""
    waves = waves_of(problem, sea, water)
    at = len(waves) - 1
    known = collected.groups.get(f"{root}/waves/{sea.name}")
    if known is not None and known["line_tension_maximum"].size:
        at = int(np.argmax(known["line_tension_maximum"].values.reshape(len(known["wave"]), -1).max(axis=1)))
    wave = waves[at]
    if not isinstance(sea, RigidCageWaves):
        wave = replace(wave, duration=min(wave.duration, 100.0 * wave.period))
    found = sensitivity_dataset(problem, lines, water, wave, progress)
    if found is not None:
        collected.groups[f"{root}/sensitivity/{sea.name}"] = found
    yield


def _result(problem: RigidCageProblem, collected: Collected) -> Result:
    attributes = {
        "structure": "cage",
        "cage_model": "rigid",
        "title": problem.title,
        "case_hash": problem.case_hash,
        "case_text": problem.case_text,
        "equations": problem.equations,
    }
    return collected.close(
        VOCABULARY,
        attributes,
        [sea.seed for sea in problem.seas if isinstance(sea, IrregularSea)],
        headlines=rigid_headlines(collected.groups),
        criteria=problem.criteria,
        left_out=SEAS_LEFT_OUT if problem.seas and "time" not in problem.settings.analyses else "",
    )


__all__ = ["rest_at", "run"]
