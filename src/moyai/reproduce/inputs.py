"""The case files of the papers, and how they are run."""

from __future__ import annotations

import tempfile
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.core.progress import Progress, silent

if TYPE_CHECKING:
    from moyai.case.reader import Case
    from moyai.core.results import Result

CASES = Path(__file__).parent / "cases"


def case_files(paper: str) -> tuple[Path, ...]:
    """Return the case files of a paper in the order of their names."""
    return tuple(sorted((CASES / paper).glob("*.yaml")))


@cache
def _case(path: Path) -> Case:
    from moyai.case.reader import load_case

    return load_case(path)


@cache
def _folder() -> tempfile.TemporaryDirectory[str]:
    return tempfile.TemporaryDirectory(prefix="moyai_reproduce_")


def problem_of(paper: str, name: str) -> Any:
    """Return the problem that a case file of a paper states.

    Parameters
    ----------
    paper, name : str
        Key of the paper, and name of the file without its ending.
    """
    from moyai.case.builder import build

    return build(_case(CASES / paper / f"{name}.yaml"))


def run_problem(kind: str, problem: Any, progress: Progress = silent) -> Result:
    """Run a problem as ``moyai run`` runs its case; coefficients of the same body are computed once a session.

    Parameters
    ----------
    kind : str
        Kind of structure.
    problem : object
        As :func:`problem_of` gives it, or changed from that.
    progress : Progress
    """
    from moyai.core.kinds import structure_kind

    return structure_kind(kind).run(problem, progress, Path(_folder().name))
