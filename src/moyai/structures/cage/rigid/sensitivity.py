"""How the peak tension of a rigid cage depends on the stiffness of its lines."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from moyai.core.errors import ConvergenceError, InputError
from moyai.core.progress import Progress, silent
from moyai.sea.water import Water
from moyai.structures.cage.rigid.lines import CageLine
from moyai.structures.cage.rigid.model import RigidCageProblem
from moyai.structures.cage.rigid.runs import run_wave
from moyai.structures.cage.rigid.statics import equilibrium_with_lines
from moyai.structures.cage.rigid.variables import labelled
from moyai.structures.cage.rigid.waves import RigidCageWave

if TYPE_CHECKING:
    import xarray as xr


def stiffer(lines: tuple[CageLine, ...], tension: np.ndarray, factor: float) -> tuple[CageLine, ...]:
    """Return lines of ``factor`` times the stiffness with the same tension [N] over the same span."""
    return tuple(line.with_stiffness(line.stiffness * factor, float(pull)) for line, pull in zip(lines, tension))


def sensitivity_dataset(
    problem: RigidCageProblem,
    lines: tuple[CageLine, ...],
    water: Water,
    wave: RigidCageWave,
    progress: Progress = silent,
) -> xr.Dataset | None:
    """Return peaks and motions over line stiffness in one wave, ``None`` where no stiffness can be run.

    Parameters
    ----------
    problem : RigidCageProblem
    lines : tuple of CageLine
        At this water level.
    water : Water
    wave : Wave
    progress : Progress

    Notes
    -----
    Every variant has the tension at rest of the case; the peaks grow about as the square root of the stiffness
    [eq:cage-snap], the motions hardly at all.
    """
    import xarray as xr

    own = max(line.stiffness for line in lines)
    settings = problem.settings
    wanted = settings.stiffnesses or tuple(own * factor for factor in settings.stiffness_factors)
    rest = equilibrium_with_lines(problem.cage, lines, water, problem.kinematic_viscosity, problem.environment.current)
    rows = []
    for number, stiffness in enumerate(sorted(wanted)):
        progress(f"stiffness, {wave.name}", number, len(wanted))
        try:
            varied = stiffer(lines, rest.tension, stiffness / own)
            place = equilibrium_with_lines(
                problem.cage, varied, water, problem.kinematic_viscosity, problem.environment.current, rest.place
            )
        except (InputError, ConvergenceError):
            continue
        found = run_wave(problem, varied, place, water, wave)
        rows.append((stiffness, found.numbers))
    progress(f"stiffness, {wave.name}", len(wanted), len(wanted))
    if len(rows) < 2:
        return None
    return labelled(
        xr.Dataset(
            {
                "line_tension_maximum": (
                    ("varied_stiffness", "line"),
                    np.array([n.line_tension_maximum[:, 0] for _, n in rows]),
                ),
                "line_tension_mean_peak": (
                    ("varied_stiffness", "line"),
                    np.array([n.line_tension_mean_peak[:, 0] for _, n in rows]),
                ),
                "range": (("varied_stiffness", "mode"), np.array([n.range for _, n in rows])),
            },
            coords={
                "varied_stiffness": np.array([k for k, _ in rows]),
                "line": [line.name for line in lines],
                "mode": ["sway", "heave", "roll"],
            },
            attrs={"wave": wave.name, "own_stiffness": own, "wave_height": wave.height, "period": wave.period},
        )
    )
