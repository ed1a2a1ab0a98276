"""Run every water level: variables, numbers of the first page."""

from dataclasses import asdict

import xarray as xr

from moyai.core.collected import Collected
from moyai.core.headline import Headline
from moyai.core.progress import Progress
from moyai.core.results import Result
from moyai.core.validity import IdentityCheck, Notice
from moyai.core.vocabulary import Vocabulary
from moyai_spar.model import SparProblem, SparState, equilibrium

VARIABLES = {
    "draught": ("m", "draught of the spar"),
    "offset": ("m", "distance of the spar from its anchor"),
    "drag": ("N", "drag of the current"),
    "tension": ("N", "tension of the chain at the keel"),
}


def run(problem: SparProblem, progress: Progress) -> Result:
    """Run a spar at every water level."""
    collected, states = Collected(), {}
    for index, (name, level) in enumerate(problem.water_levels):
        progress("water levels", index, len(problem.water_levels))
        state = states[name] = equilibrium(problem, level)
        values = {key: value for key, value in asdict(state).items() if key in VARIABLES}
        collected.groups[f"/{name}"] = xr.Dataset(values)
        collected.checks.append(IdentityCheck(f"{name}: buoyancy bears spar and hanging chain", state.residual, 1e-6))
        if state.draught >= problem.height:
            collected.notices.append(Notice("spar-under-water", f"{name}: the spar is pulled under", severity="error"))
    words, headlines = Vocabulary.of("spar", VARIABLES), headlines_of(problem, states)
    return collected.close(words, problem.attributes, headlines=headlines, criteria=problem.criteria)


def headlines_of(problem: SparProblem, states: dict[str, SparState]) -> tuple[Headline, ...]:
    """Return the first page's numbers, each at the water level where it is largest."""
    found = []
    for name, variable in (("line_tension", "tension"), ("offset", "offset")):
        level = max(states, key=lambda key: getattr(states[key], variable))
        unit, label = VARIABLES[variable]
        found.append(Headline(name, label, getattr(states[level], variable), unit, level, "elastic catenary"))
    share = found[0].value / problem.chain.line_type.breaking_load
    found.append(Headline("line_utilisation", "tension over breaking load", share, "1", found[0].where))
    return tuple(found if share > 0.0 else found[:2])  # a strength that is not known is infinite
