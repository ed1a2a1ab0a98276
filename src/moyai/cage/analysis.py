"""Run a cage: the analyses of the model that its problem belongs to."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from moyai.core.progress import Progress, silent
from moyai.core.results import Result

#: Attribute ``model`` of a problem: who runs it
RUNNERS = {
    "rigid": "moyai.cage.rigid_analysis:run",
    "flexible": "moyai.cage.flexible_analysis:run",
}


def run(problem: Any, progress: Progress = silent) -> Result:
    """Run all analyses of a cage.

    Parameters
    ----------
    problem : RigidCageProblem or another problem of :data:`RUNNERS`
        Its attribute ``model`` chooses.
    progress : Progress

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.
    """
    module, name = RUNNERS[problem.model].split(":")
    result: Result = getattr(import_module(module), name)(problem, progress)
    return result
