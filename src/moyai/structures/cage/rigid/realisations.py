"""Realisations of an irregular sea: a rigid cage between lines that snap is chaotic, one largest tension is chance."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
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
from moyai.structures.cage.rigid.runs import RigidCageRun, realised_height, run_wave
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium
from moyai.structures.cage.rigid.variables import labelled
from moyai.structures.cage.rigid.waves import waves_of

if TYPE_CHECKING:
    import xarray as xr

#: Key of the case for more of them.
MORE = "settings.rigid.realisations"


@dataclass(frozen=True, eq=False)
class RigidCageRealisation:
    """What is kept of a run through a sea."""

    seed: int
    #: ``None`` where the motion left all bounds.
    numbers: Numbers | None
    #: Four standard deviations of the surface after the waves have grown [m].
    height: float

    @classmethod
    def of(cls, problem: RigidCageProblem, run: RigidCageRun) -> RigidCageRealisation:
        """Return that of a run."""
        ended = run.march.status == "converged"
        return cls(int(run.wave.seed or 0), run.numbers if ended else None, realised_height(problem, run))


def further_realisations(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    rest: RigidCageEquilibrium,
    water: Water,
    sea: IrregularSea,
    progress: Progress = silent,
) -> Iterator[RigidCageRealisation]:
    """Yield each further realisation of a sea; none without lines, whose numbers alone are chance.

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
    count = problem.settings.realisations if problem.equations == "sound" and lines else 1
    seeds = [realisation_seed(sea.seed, number) for number in range(1, count)]

    def realisation(seed: int, heard: Progress) -> RigidCageRealisation:
        def told(what: str, done: float, total: float) -> None:
            parts[seed] = done / max(total, 1e-300)
            heard(words, sum(parts.values()), len(seeds))

        wave = waves_of(problem, replace(sea, seed=seed), water)[0]
        found = run_wave(problem, lines, rest, water, wave, progress=told)
        if found.march.status == "interrupted":
            raise KeyboardInterrupt
        return RigidCageRealisation.of(problem, found)

    words, parts = f"realisations, {sea.name}", dict.fromkeys(seeds, 0.0)
    yield from one_after_the_other(realisation, seeds, words, progress)


def with_realisations(found: xr.Dataset, all_of_them: Sequence[RigidCageRealisation], at_rest: float) -> xr.Dataset:
    """Return the numbers of a sea with the largest values of all realisations, those that ended.

    Parameters
    ----------
    found : Dataset
        Of the run of the case.
    all_of_them : sequence of RigidCageRealisation
        That of the case first.
    at_rest : float
        Place of rest against where the cage floats freely [m].
    """
    import xarray as xr

    kept = [(one.seed, one.numbers) for one in all_of_them if one.numbers is not None]
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
    height = float(np.mean([one.height for one in all_of_them if one.numbers is not None]))
    return found.merge(labelled(xr.Dataset(data))).assign_attrs(found.attrs | {"realised_height": height})


def notices(others: Sequence[RigidCageRealisation], lines: tuple[CageLine, ...]) -> list[Notice]:
    """Return what further realisations reach beyond limits."""
    found: list[Notice] = []
    for one in others:
        if one.numbers is not None:
            roll = max(abs(float(one.numbers.maximum[2])), abs(float(one.numbers.minimum[2])))
            found += limit_notices(f"seed {one.seed}", one.numbers.line_tension_maximum, roll, lines)
    return found


def lost(others: Sequence[RigidCageRealisation]) -> str:
    """Say how many realisations left all bounds, in no words where none did."""
    count = sum(one.numbers is None for one in others)
    return f"{count} of {len(others) + 1} realisations left all bounds" if count else ""
