"""Run a cage: the analyses of the model that its problem belongs to."""

from __future__ import annotations

from moyai.core.progress import Progress, silent
from moyai.core.results import Result
from moyai.structures.cage.flexible.problem import FlexibleCageProblem
from moyai.structures.cage.rigid.model import RigidCageProblem


def run(problem: RigidCageProblem | FlexibleCageProblem, progress: Progress = silent) -> Result:
    """Run all analyses of a cage.

    Parameters
    ----------
    problem : RigidCageProblem or FlexibleCageProblem
    progress : Progress

    Returns
    -------
    Result
        Groups as in docs/result_layout.md.
    """
    if isinstance(problem, RigidCageProblem):
        from moyai.structures.cage.rigid.run import run as run_rigid

        return run_rigid(problem, progress)
    from moyai.structures.cage.flexible.run import run as run_flexible

    return run_flexible(problem, progress)
