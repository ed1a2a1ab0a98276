"""Run a case: from the case file's content to its result, whatever the structure."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.core.errors import InputError
from moyai.core.headline import left_open
from moyai.core.options import check_kind
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice

if TYPE_CHECKING:
    from moyai.case.reader import Case
    from moyai.report.views import ReportedResult


def run(
    case: Case | str | Path, progress: Progress = silent, *, keep: Path | None = None, problem: Any = None
) -> ReportedResult:
    """Run all analyses that a case names.

    Parameters
    ----------
    case : Case or path
        From :func:`moyai.load_case`, or the file to load.
    progress : Progress
        Listener reported of every step. KeyboardInterrupt ends the run with what there is, status ``interrupted``.
    keep : Path or None
        Folder where coefficients that took long are kept under their hash and looked for by the next run.
    problem : object or None
        Taken in place of the problem that the case builds (:meth:`moyai.core.kinds.StructureKind.nominal`).

    Returns
    -------
    ReportedResult
        With its tables and figures at hand.

    Raises
    ------
    InputError
        When the case is impossible, with the key and its line, or what is given is neither a case nor a path.
    """
    from moyai.case.builder import build
    from moyai.case.reader import Case, load_case
    from moyai.core.kinds import structure_kind
    from moyai.report.views import with_views

    if isinstance(case, str | Path):
        case = load_case(case)
    check_kind(case, Case, "case", "give the path of a case file, or what load_case returned")
    problem = build(case) if problem is None else problem
    try:
        result = structure_kind(case.kind).run(problem, progress, keep)
    except InputError as error:
        raise case.located(error) from error
    if getattr(case.model, "measured", None):
        from moyai.case.measured import with_measured

        result = with_measured(result, case.model, case.folder)
    said = " | ".join(_wording(notice.message) for notice in result.notices)
    warnings = [
        Notice("case", fault.message, remedy=fault.remedy, source=fault.path)
        for fault in case.warnings
        if _wording(fault.message).split("; ", 1)[-1] not in said
    ]
    result = result.with_notices(*warnings) if warnings else result
    if levels := _levels_left_out(case.model):
        result = result.changed(verdict=left_open(result.verdict, f"not run: water level {', '.join(levels)}"))
    if (display := getattr(case.model, "display", None)) is not None and display.units != "SI":
        result = result.changed(provenance={**result.provenance, "display_units": display.units})
    if display is not None and display.language is not None:
        result = result.changed(provenance={**result.provenance, "display_language": display.language})
    return with_views(result)


def _levels_left_out(model: Any) -> list[str]:
    """Return the water levels of the site that the settings of a case leave out."""
    levels = getattr(getattr(model, "site", None), "water_levels", None) or {}
    chosen = getattr(getattr(model, "settings", None), "water_levels", "all")
    return [] if isinstance(chosen, str) else [name for name in levels if name not in chosen]


def _wording(message: str) -> str:
    """Return a message without its numbers.

    The run states them better than the check of the case: where it says what follows from them (behind the semicolon),
    the check has nothing to add.
    """
    return re.sub(r"[-+]?\d[\d.]*(?:e[-+]?\d+)?", "#", message)
