"""Run a case: from the case file's content to its result, whatever the structure."""

from __future__ import annotations

import tempfile
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice

if TYPE_CHECKING:
    from moyai.case.reader import Case
    from moyai.core.results import Result

_ANALYSES = {"breakwater": "moyai.breakwater.analysis"}


def run(case: Case, progress: Progress = silent) -> Result:
    """Run all analyses that a case names.

    Parameters
    ----------
    case : Case
        From :func:`moyai.load_case`.
    progress : Progress
        Listener told of every step. KeyboardInterrupt ends the run with what there is, status ``interrupted``.

    Returns
    -------
    Result

    Raises
    ------
    InputError
        When the case is impossible.
    """
    from moyai.case.builder import build

    problem = build(case)
    analysis = import_module(_ANALYSES[case.kind])
    result: Result = analysis.run(problem, progress, **_extras(case, problem))
    told = {notice.message for notice in result.notices}
    warnings = [
        Notice("case", f"{fault.path}: {fault.message}" if fault.path else fault.message, remedy=fault.remedy)
        for fault in case.warnings
        if fault.message not in told
    ]
    return result.with_notices(*warnings) if warnings else result


def _extras(case: Case, problem: Any) -> dict[str, Any]:
    """Return what the structure's package may not fetch itself: coefficients out of other programs' files."""
    if case.kind == "breakwater" and problem.breakwater.coefficients_file is not None:
        return {"coefficients": _planar_coefficients(problem)}
    return {}


def _planar_coefficients(problem: Any) -> Any:
    from moyai.interop.planar import to_planar
    from moyai.interop.read import read_coefficients

    given = problem.breakwater.coefficients_file
    options = dict(given.options)
    sea, origin = options.pop("sea"), options.pop("origin")
    dataset = read_coefficients(given.program, given.path, options)

    def of_unit(unit: Any) -> Any:
        return to_planar(
            dataset, length=problem.breakwater.length, centre_of_gravity=unit.centre, sea=sea, origin=origin
        )

    return of_unit


def prepare_output(directory: Path) -> Path:
    """Make the folder of a run and prove that it can be written, before any work starts.

    Raises
    ------
    InputError
        When it cannot be made or written, or a file stands in its place.
    """
    if directory.exists() and not directory.is_dir():
        raise InputError(f"{directory} is a file", path="output", remedy="name a folder with --output")
    try:
        directory.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=directory) as probe:
            probe.write(b"moyai")
    except OSError as error:
        raise InputError(
            f"cannot write to {directory}: {error.strerror or error}",
            path="output",
            remedy="choose a folder that can be written with --output",
        ) from None
    return directory
