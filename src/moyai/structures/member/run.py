"""Run a member: every water level, every sea, the analyses that the case names."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.at_once import one_after_the_other
from moyai.core.collected import Collected, most_severe
from moyai.core.progress import Progress, silent
from moyai.core.results import Result
from moyai.core.validity import IdentityCheck, Notice
from moyai.morison.members import StraightMember
from moyai.sea.irregular import realisation_seed
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.member.checks import member_notices, require_in_water, theory_notices, wave_notices
from moyai.structures.member.datasets import gathered, member_dataset, sea_dataset, time_dataset
from moyai.structures.member.headlines import headlines_of, range_notices
from moyai.structures.member.march import WaveForces, march
from moyai.structures.member.model import MemberProblem, MemberWaves
from moyai.structures.member.surface import can_be_evaluated, relative_heading, surface_effect, surface_notices
from moyai.structures.member.sweep import sweep
from moyai.structures.member.variables import VOCABULARY, labelled
from moyai.structures.member.waves import CURRENT_ALONE, MemberWave, current_alone, waves_of

if TYPE_CHECKING:
    import xarray as xr

#: Departure of the variance of a realisation, cut at its duration, from that of the spectrum
_VARIANCE = 0.05


def run(problem: MemberProblem, progress: Progress = silent) -> Result:
    """Run all analyses of a member.

    Parameters
    ----------
    problem : MemberProblem
    progress : Progress
        Called after every wave; KeyboardInterrupt ends the run with what there is and the status ``interrupted``.

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.

    Raises
    ------
    InputError
        When the member is above the surface, below the bed, or a coefficient law is not for its section.
    """
    collected = Collected()
    for name, level in problem.environment.water_levels:
        require_in_water(problem.member_at(level), problem.environment.water_at(level), name)
    collected.take(_steps(problem, collected, progress))
    return _result(problem, collected)


def _steps(problem: MemberProblem, collected: Collected, progress: Progress) -> Iterator[None]:
    levels = problem.environment.water_levels
    collected.checks.extend(problem.member.placed_section.inertia.checks)
    for index, (name, level) in enumerate(levels):
        progress("water levels", index, len(levels))
        member, water = problem.member_at(level), problem.environment.water_at(level)
        root = f"/{name}"
        collected.groups[root] = _header(level, water)
        collected.groups[f"{root}/member"] = member_dataset(problem, member)
        collected.notices.extend(member_notices(problem, member))
        frequency = _leading_frequency(problem)
        if "sweep" in problem.settings.analyses and frequency is not None:
            collected.groups[f"{root}/sweep"] = sweep(problem, frequency)
            yield
        if "forces" in problem.settings.analyses:
            for sea in problem.seas:
                yield from _sea_steps(problem, member, water, sea, collected, root, progress)
            if not problem.seas:
                wave = current_alone(problem, water)
                found = march(problem, member, wave)
                collected.groups[f"{root}/time/{CURRENT_ALONE}/wave 1"] = time_dataset(wave, found)
                collected.groups[f"{root}/waves/{CURRENT_ALONE}"] = sea_dataset(problem, member, [(wave, found)])
                collected.notices.extend(
                    replace(one, message=f"{name}: {one.message}") for one in most_severe(list(found.notices))
                )
                yield
        if "surface" in problem.settings.analyses:
            for sea in problem.seas:
                _surface(problem, member, water, sea, collected, root, progress)
                yield
    progress("water levels", len(levels), len(levels))


def _header(level: float, water: Water) -> xr.Dataset:
    import xarray as xr

    return xr.Dataset(attrs={"water_level": level, "water_depth": water.depth})


def _leading_frequency(problem: MemberProblem) -> float | None:
    """Return the frequency [Hz] that the sweep over KC is made at: that of the first sea."""
    if not problem.seas:
        return None
    first = problem.seas[0]
    period = first.periods[0] if isinstance(first, MemberWaves) else float(first.spectrum.peak_period)
    return 1.0 / period


def _sea_steps(
    problem: MemberProblem,
    member: StraightMember,
    water: Water,
    sea: MemberWaves | IrregularSea,
    collected: Collected,
    root: str,
    progress: Progress,
) -> Iterator[None]:
    if isinstance(sea, IrregularSea):
        yield from _realisations(problem, member, water, sea, collected, root, progress)
        return
    waves = waves_of(problem, sea, water)
    runs: list[tuple[MemberWave, WaveForces]] = []
    reported: list[Notice] = []
    forces = one_after_the_other(lambda wave, _: march(problem, member, wave), waves, f"forces, {sea.name}", progress)
    for number, (wave, found) in enumerate(zip(waves, forces, strict=True)):
        runs.append((wave, found))
        collected.groups[f"{root}/time/{sea.name}/wave {number + 1}"] = time_dataset(wave, found)
        collected.groups[f"{root}/waves/{sea.name}"] = sea_dataset(problem, member, runs)
        reported.extend([*wave_notices(problem, member, wave, found), *theory_notices(wave)])
        collected.checks.append(_periodicity(sea.name, wave, found))
        yield
    collected.notices.extend(
        replace(notice, message=f"{sea.name}: {notice.message}") for notice in most_severe(reported)
    )


def _realisations(
    problem: MemberProblem,
    member: StraightMember,
    water: Water,
    sea: IrregularSea,
    collected: Collected,
    root: str,
    progress: Progress,
) -> Iterator[None]:
    """Run the realisations of an irregular sea: largest forces are means, the record nearest to the mean is kept."""
    found: list[xr.Dataset] = []
    records: list[xr.Dataset] = []
    reported: list[Notice] = []
    variances: list[float] = []
    seeds = [realisation_seed(sea.seed, number) for number in range(problem.settings.realisations)]

    def realisation(seed: int, _: Progress) -> tuple[MemberWave, WaveForces]:
        wave = waves_of(problem, replace(sea, seed=seed), water)[0]
        return wave, march(problem, member, wave)

    runs = one_after_the_other(realisation, seeds, f"realisations, {sea.name}", progress)
    for seed, (wave, forces) in zip(seeds, runs, strict=True):
        found.append(sea_dataset(problem, member, [(wave, forces)]))
        records.append(time_dataset(wave, forces).assign_attrs(seed=seed))
        reported.extend(wave_notices(problem, member, wave, forces))
        variances.append(float(np.var(forces.elevation)))
        # kept after each realisation, so that an interrupted run holds those that ended
        numbers, kept = gathered(found, seeds[: len(found)])
        collected.groups[f"{root}/time/{sea.name}/sea"] = records[kept]
        collected.groups[f"{root}/waves/{sea.name}"] = numbers
        yield
    collected.checks.append(_variance(sea, variances))
    collected.notices.extend(
        replace(notice, message=f"{sea.name}: {notice.message}") for notice in most_severe(reported)
    )


def _periodicity(name: str, wave: MemberWave, found: WaveForces) -> IdentityCheck:
    """Tell whether the force of a regular wave repeats itself at the end of the run."""
    total = found.force.sum(axis=0)
    largest = float(np.abs(total).max())
    first, last = total[-wave.time.size], total[-1]
    violation = 0.0 if largest == 0.0 else float(np.abs(last - first).max()) / largest
    return IdentityCheck(
        f"{name}, {wave.name}: force after a period", violation, 1e-3, "the last period ends as it began"
    )


def _variance(sea: IrregularSea, found: list[float]) -> IdentityCheck:
    """Hold the variance of the surface above the member, the mean of the realisations, against the spectrum."""
    wanted = float(sea.spectrum.variance)
    violation = abs(float(np.mean(found)) / wanted - 1.0) if wanted > 0.0 else 0.0
    return IdentityCheck(
        f"{sea.name}: variance of the surface", violation, _VARIANCE, "that of the records equals the zeroth moment"
    )


def _surface(
    problem: MemberProblem,
    member: StraightMember,
    water: Water,
    sea: MemberWaves | IrregularSea,
    collected: Collected,
    root: str,
    progress: Progress,
) -> None:
    import xarray as xr

    why = can_be_evaluated(member, sea.heading)
    if why:
        collected.notices.append(
            Notice(
                "near-surface-not-evaluated",
                f"{sea.name}: what the free surface changes was not computed: {why}",
                severity="information",
            )
        )
        return
    periods = sea.periods if isinstance(sea, MemberWaves) else (float(sea.spectrum.peak_period),)
    depth = -0.5 * (member.start[2] + member.end[2])
    effect = surface_effect(
        member.placed_section,
        depth,
        water,
        np.asarray(periods, dtype=float),
        relative_heading(member, sea.heading),
        progress,
    )
    collected.checks.extend(replace(check, name=f"{sea.name}: {check.name}") for check in effect.checks)
    collected.notices.extend(surface_notices(effect, sea.name))
    collected.groups[f"{root}/surface/{sea.name}"] = labelled(
        xr.Dataset(
            {
                "near_surface_inertia_coefficient": (("period", "axis"), effect.inertia),
                "near_surface_change": (("period", "axis"), effect.change),
                "radiation_ratio": (("period", "axis"), effect.radiation),
            },
            coords={"period": effect.period, "axis": ["first", "second"]},
        )
    )


def _result(problem: MemberProblem, collected: Collected) -> Result:
    attributes = {
        "structure": "member",
        "title": problem.title,
        "case_hash": problem.case_hash,
        "case_text": problem.case_text,
        "purpose": problem.circulation.purpose,
    }
    collected.notices.extend(range_notices(problem, collected.groups))
    collected.notices[:] = _one_reynolds(collected.notices, collected.groups)
    return collected.close(
        VOCABULARY,
        attributes,
        [sea.seed for sea in problem.seas if isinstance(sea, IrregularSea)],
        headlines=headlines_of(problem, collected.groups),
        criteria=problem.criteria,
    )


def _one_reynolds(notices: Sequence[Notice], groups: Mapping[str, xr.Dataset]) -> list[Notice]:
    """Keep of the notices of Reynolds numbers out of a drag law's range the worst, with the range of the whole run."""
    mine = [notice for notice in notices if notice.code == "drag-reynolds"]
    if not mine:
        return list(notices)
    seas = [group for group in groups.values() if "strip_reynolds" in group]
    every = np.concatenate([sea["strip_reynolds"].values[sea["wet_share"].values > 0.0] for sea in seas])
    worst = most_severe(mine)[0]
    said = replace(worst, message=f"{worst.message}; over all waves and strips {every.min():.2g} to {every.max():.2g}")
    return [said if notice is worst else notice for notice in notices if notice is worst or notice not in mine]


__all__ = ["run"]
