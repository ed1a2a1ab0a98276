"""What one case, run as a trial, shows of a study before it runs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from moyai.study import schema
from moyai.study.definition import Study
from moyai.study.responses import find_response

if TYPE_CHECKING:
    import xarray as xr


def require_responses(study: Study, tree: xr.DataTree) -> None:
    """Require that a case's result gives every response that the study names.

    Parameters
    ----------
    study : Study
    tree : xarray.DataTree
        Result of one of its cases.

    Raises
    ------
    InputError
        With the first that is missing, and the nearest that there are.
    """
    names: list[str] = []
    search = study.search
    if isinstance(search, schema.LimitSearch):
        names += [one.response for one in search.conditions]
    elif isinstance(search, schema.Optimisation):
        names += [search.minimise, *(one.response for one in search.subject_to)]
        names += [search.trade_off.response] if search.trade_off is not None else []
    else:
        reduced = {item.name for item in study.wanted}
        names += [item.variable for item in study.wanted]
        names += [name for name in _of_assessment(study) if name not in reduced]
    for name in names:
        find_response(tree, name)


def _of_assessment(study: Study) -> list[str]:
    """Return the responses of a study's assessment, and the one that is watched."""
    names = [study.watch] if study.watch else []
    wanted = study.assessment
    if wanted is not None:
        names += [one.response for one in wanted.extremes if one.family == "gumbel"]
        names += [one.response for one in wanted.long_term]
        for line in wanted.tensions.values():
            names += [name for name in (line.maximum, line.mean, line.uplift) if name]
    return names


def runs_of_search(study: Study) -> int:
    """Return how often a case is run at most: once, or as often as a search needs."""
    search = study.search
    if isinstance(search, schema.LimitSearch):
        return 2 + math.ceil(math.log2(1.0 / search.tolerance)) if search.tolerance < 1.0 else 2
    if isinstance(search, schema.Optimisation):
        return search.starts * search.evaluations
    return 1
