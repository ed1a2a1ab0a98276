"""Realisations of an irregular sea: a rigid cage between lines that snap is chaotic, one largest tension is chance."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.at_once import one_after_the_other
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.sea.irregular import realisation_seed
from moyai.sea.states import IrregularSea
from moyai.sea.water import Water
from moyai.structures.cage.rigid.checks import limit_notices
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.model import RigidCageProblem
from moyai.structures.cage.rigid.numbers import Numbers
from moyai.structures.cage.rigid.runs import run_wave
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium
from moyai.structures.cage.rigid.variables import labelled
from moyai.structures.cage.rigid.waves import waves_of

if TYPE_CHECKING:
    import xarray as xr

#: Key of the case for more of them.
MORE = "settings.rigid.realisations"


def further_numbers(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    rest: RigidCageEquilibrium,
    water: Water,
    sea: IrregularSea,
    progress: Progress = silent,
) -> Iterator[tuple[int, Numbers | None]]:
    """Yield the seed and the numbers of each further realisation of a sea, ``None`` of one that left all bounds.

    As many run at once as there are cores; what one gives depends on its seed alone.

    Parameters
    ----------
    problem : RigidCageProblem
    lines : tuple of CageLine
        At this water level.
    rest : RigidCageEquilibrium
    water : Water
    sea : IrregularSea
        With the seed of the first realisation, which the run of the case is.
    progress : Progress
    """
    count = problem.settings.realisations if problem.equations == "sound" else 1
    seeds = [realisation_seed(sea.seed, number) for number in range(1, count)]

    def realisation(seed: int, heard: Progress) -> Numbers | None:
        def told(what: str, done: float, total: float) -> None:
            # hears of a stop, and leaves the line to the count of realisations
            heard(words, number_of[seed], count)

        wave = waves_of(problem, replace(sea, seed=seed), water)[0]
        found = run_wave(problem, lines, rest, water, wave, progress=told)
        if found.march.status == "interrupted":
            raise KeyboardInterrupt
        return found.numbers if found.march.status == "converged" else None

    words = f"realisations, {sea.name}"
    number_of = {seed: number for number, seed in enumerate(seeds, start=1)}
    yield from zip(seeds, one_after_the_other(realisation, seeds, words, progress), strict=True)


def with_realisations(
    found: xr.Dataset, own: tuple[int, Numbers], others: list[tuple[int, Numbers | None]], at_rest: float
) -> xr.Dataset:
    """Return the numbers of a sea with the largest values of all realisations, those that ended.

    Parameters
    ----------
    found : Dataset
        Of the run of the case.
    own, others
        Seeds and numbers of that run and of the others.
    at_rest : float
        Place of rest against where the cage floats freely [m].
    """
    import xarray as xr

    kept = [own, *((seed, numbers) for seed, numbers in others if numbers is not None)]
    data = {
        "seed_of_realisation": ("realisation", np.array([seed for seed, _ in kept], dtype=np.int64)),
        "line_tension_maximum_of_realisation": (
            ("realisation", "line", "end"),
            np.array([numbers.line_tension_maximum for _, numbers in kept]),
        ),
        "largest_offset_of_realisation": (
            "realisation",
            np.array([numbers.largest_offset(at_rest) for _, numbers in kept]),
        ),
    }
    return found.merge(labelled(xr.Dataset(data))).assign_attrs(found.attrs)


def notices(others: list[tuple[int, Numbers | None]], lines: tuple[CageLine, ...]) -> list[Notice]:
    """Return what the further realisations reach beyond limits, and how many were lost."""
    found = lost(others)
    for seed, numbers in others:
        if numbers is not None:
            roll = max(abs(float(numbers.maximum[2])), abs(float(numbers.minimum[2])))
            found += limit_notices(f"seed {seed}", numbers.line_tension_maximum, roll, lines)
    return found


def lost(others: list[tuple[int, Numbers | None]]) -> list[Notice]:
    """Say how many realisations left all bounds."""
    count = sum(numbers is None for _, numbers in others)
    if not count:
        return []
    return [
        Notice(
            "realisations-lost",
            f"{count} of {len(others) + 1} realisations left all bounds: means are those of the others",
            count, 0, remedy="smaller errors of a step, or lines with damping",
        )
    ]  # fmt: skip
