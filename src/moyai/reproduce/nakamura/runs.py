"""Runs of the paper: the tank model undamped, damped and under drift, in both domains, chains at rest and moving."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.at_once import each_counted
from moyai.core.progress import Progress, silent
from moyai.reproduce.inputs import problem_of, run_problem
from moyai.structures.breakwater.model import BreakwaterProblem, Damping, MooringLine, RegularSea
from moyai.structures.breakwater.settings import Sensitivity

if TYPE_CHECKING:
    from moyai.core.results import Result

LEVEL, SEA = "SWL", "waves"
FRACTION = 0.15
CURVE = tuple(float(value) for value in np.linspace(0.58, 1.62, 53))
QUICK_PERIODS = (0.60, 0.80, 0.95, 1.10, 1.40, 1.60)
QUICK_MOVING = (0.95, 1.60)
MODES = ("sway", "heave", "roll")


@dataclass(frozen=True)
class NakamuraRuns:
    """The runs that the figures and statements read."""

    #: Frequency domain over :data:`CURVE` with no damping beyond waves.
    undamped: Result
    #: Frequency domain over :data:`CURVE` with 15 % of critical damping.
    damped: Result
    #: Frequency domain over :data:`CURVE` with that damping and the drift force.
    drifted: Result
    #: Undamped in time at the periods of the paper, chains at rest at every instant.
    undamped_time: Result
    #: Damped in time, as ``undamped_time``.
    damped_time: Result
    #: Damped with drift in time, as ``undamped_time``.
    drifted_time: Result
    #: With drift and chains in motion.
    moving_time: Result
    #: As the case file states it.
    case: BreakwaterProblem
    quick: bool


def variant(
    case: BreakwaterProblem,
    periods: tuple[float, ...],
    *,
    fraction: float = FRACTION,
    drift: bool = True,
    time: bool = False,
    moving: bool = False,
) -> BreakwaterProblem:
    """Return the case with other periods, damping, drift and lines.

    Parameters
    ----------
    case : BreakwaterProblem
    periods : tuple of float
        [s].
    fraction : float
        Damping over critical, in the modes of the case.
    drift, time, moving : bool
        Whether the drift force acts, the time domain is run, and the chains are in motion in it.
    """
    kept: dict[str, Any] = {} if moving else {"bar_types": (), "drag_width": 0.0}
    chains = (line for line in case.breakwater.lines if isinstance(line, MooringLine))
    lines = tuple(replace(line, dynamic=moving, **kept) for line in chains)
    damping = Damping(fraction, case.breakwater.damping.modes)
    height = case.environment.sea_states[0].height  # type: ignore[union-attr]
    of_time = case.settings.time
    of_time = of_time.changed(lines=of_time.lines.changed(mode="dynamic" if moving else "quasi_static"))
    return replace(
        case,
        breakwater=replace(case.breakwater, lines=lines, damping=damping),
        environment=replace(case.environment, sea_states=(RegularSea(SEA, height, periods),)),
        analyses=("statics", "mooring", "frequency", "time") if time else ("statics", "mooring", "frequency"),
        settings=case.settings.changed(
            sensitivity=Sensitivity(), drift=drift, time=of_time, line_restoring="equivalent" if moving else "tangent"
        ),
    )


def run(quick: bool = False, progress: Progress = silent) -> NakamuraRuns:
    """Run everything.

    Parameters
    ----------
    quick : bool
        Six periods in time in place of fourteen, two with moving chains.
    progress : Progress
    """
    case: BreakwaterProblem = problem_of("nakamura", "tank_model")
    periods = QUICK_PERIODS if quick else case.environment.sea_states[0].periods  # type: ignore[union-attr]
    plans = {
        "undamped": variant(case, CURVE, fraction=0.0, drift=False),
        "damped": variant(case, CURVE, drift=False),
        "drifted": variant(case, CURVE),
        "undamped_time": variant(case, periods, fraction=0.0, drift=False, time=True),
        "damped_time": variant(case, periods, drift=False, time=True),
        "drifted_time": variant(case, periods, time=True),
        "moving_time": variant(case, QUICK_MOVING if quick else periods, time=True, moving=True),
    }
    found = each_counted("runs of the paper", partial(run_problem, "breakwater"), tuple(plans.values()), progress)
    return NakamuraRuns(**dict(zip(plans, found, strict=True)), case=case, quick=quick)


def values(result: Result, domain: str, name: str, dof: str = "") -> Array:
    """Return a variable of the regular sea over its periods.

    Parameters
    ----------
    result : Result
    domain : {"frequency", "time"}
    name : str
        As in the vocabulary of breakwaters.
    dof : str
        Degree of freedom of a vector, the diagonal entry of a matrix.
    """
    data = result.tree[f"{LEVEL}/{domain}/{SEA}"][name]
    for dimension in ("dof", "influenced_dof", "radiating_dof"):
        if dimension in data.dims:
            data = data.sel({dimension: dof})
    return np.asarray(data.values, dtype=float)


def abscissae(result: Result, domain: str) -> dict[str, Array]:
    """Return wavelength over beam and period of the regular sea."""
    return {
        "ratio": values(result, domain, "wavelength_over_beam"),
        "period": values(result, domain, "period"),
    }


def at(result: Result, domain: str, name: str, place: float, dof: str = "") -> float:
    """Return a variable at a wavelength over beam, by interpolation."""
    return float(np.interp(place, abscissae(result, domain)["ratio"], values(result, domain, name, dof)))


def peak(result: Result, name: str = "motion_ratio", dof: str = "roll") -> tuple[float, float]:
    """Return the largest value over the curve of the frequency domain and its wavelength over beam."""
    found, place = values(result, "frequency", name, dof), abscissae(result, "frequency")["ratio"]
    top = int(np.argmax(found))
    return float(found[top]), float(place[top])


def paired(runs: NakamuraRuns, result: Result, name: str, dof: str = "") -> tuple[Array, Array, Array]:
    """Return L/B, a variable in time and the same of the frequency domain at the same periods and drift."""
    return (
        abscissae(result, "time")["ratio"],
        values(result, "time", name, dof),
        values(result, "frequency", name, dof),
    )
