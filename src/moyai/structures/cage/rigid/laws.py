"""The governing waves of a rigid cage under the laws of nets that were measured on nets like its own."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import one_after_the_other
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.morison.net_law_base import NetLaw
from moyai.morison.net_law_choice import METAL, choice_notice, law_choice
from moyai.sea.water import Water
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.model import RigidCageProblem
from moyai.structures.cage.rigid.runs import run_wave
from moyai.structures.cage.rigid.statics import RigidCageEquilibrium, equilibrium_with_lines
from moyai.structures.cage.rigid.variables import labelled
from moyai.structures.cage.rigid.waves import RigidCageWave, current_along

if TYPE_CHECKING:
    import xarray as xr


#: Name of the groups of the governing waves.
IN_WAVES = "laws_in_waves"


def is_metal(problem: RigidCageProblem) -> bool:
    """Whether the twines of the net are of metal, by their mass over their volume."""
    cage = problem.cage
    return cage.net_volume > 0.0 and cage.net_mass / cage.net_volume > METAL


def laws_dataset(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    rest: RigidCageEquilibrium,
    water: Water,
    wave: RigidCageWave,
    known: tuple[Array, float, float],
    progress: Progress = silent,
) -> tuple[xr.Dataset, Notice]:
    """Return the highest tensions and the offset of one wave under the law of the case and under every other valid one.

    Parameters
    ----------
    problem : RigidCageProblem
    lines : tuple of CageLine
        At this water level.
    rest : Rest
        Under the law of the case.
    water : Water
    wave : Wave
    known : tuple
        Under the law of the case: highest tension of each line [N], place of rest against where the cage floats freely
        [m], largest offset from there [m].
    progress : Progress
    """
    import xarray as xr

    cage = problem.cage
    speed = math.pi * wave.height / wave.period + abs(current_along(problem, water))
    choice = law_choice(cage.law, cage.net, speed, problem.kinematic_viscosity, metal=is_metal(problem))
    laws: tuple[NetLaw, ...] = (choice.chosen, *choice.others)
    highest, at_rest, offset = known
    peaks, offsets = [np.asarray(highest)], [offset]

    def run_under(law: NetLaw, heard: Progress) -> tuple[Array, float] | None:
        other = replace(problem, cage=replace(cage, law=law))
        begin = rest
        if problem.environment.current is not None:
            begin = equilibrium_with_lines(
                other.cage, lines, water, problem.kinematic_viscosity, problem.environment.current
            )  # fmt: skip
        found = run_wave(other, lines, begin, water, wave, progress=heard)
        if found.march.status == "interrupted":
            raise KeyboardInterrupt
        if found.march.status != "converged":
            return None
        numbers = found.numbers
        highest = numbers.line_tension_maximum.reshape(len(lines), -1).max(axis=1)
        return highest, numbers.largest_offset(at_rest + begin.x - rest.x)

    ended = [laws[0]]
    for law, run in zip(laws[1:], one_after_the_other(run_under, laws[1:], "laws of nets", progress), strict=True):
        if run is not None:
            ended.append(law)
            peaks.append(run[0])
            offsets.append(run[1])
    coefficients = [float(law.coefficients(0.0, speed, cage.net, problem.kinematic_viscosity)[0]) for law in ended]
    found = labelled(
        xr.Dataset(
            {
                "normal_drag_coefficient": ("law", np.array(coefficients)),
                "law_line_tension_maximum": ("law", np.array(peaks).max(axis=1)),
                "law_line_tension": (("law", "line"), np.array(peaks)),
                "law_largest_offset": ("law", np.array(offsets)),
            },
            coords={"law": [law.name for law in ended], "line": [line.name for line in lines]},
            attrs={
                "wave": wave.name,
                "speed": speed,
                "valid": choice.named,
                "reynolds": choice.reynolds,
                "missing": len(laws) - len(ended),
            },
        )
    )
    return found, choice_notice(choice, cage.net)
