"""What follows the cases of a study: assessment, reports of the governing cases, table, report of the study."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.results import Result
from moyai.study.definition import RunCase, Study
from moyai.study.plan import case_at


@checks_words
def finish_study(
    plan: Study,
    result: Result,
    folder: Path,
    run: RunCase,
    progress: Progress = silent,
    *,
    report: bool = True,
    pdf: bool = False,
    as_zarr: bool = False,
) -> tuple[Result, list[Path]]:
    """Assess a study and write its files.

    Parameters
    ----------
    plan : Study
    result : Result
        As :func:`moyai.study.execute.run_study` gathered it.
    folder : Path
    run : callable
        ``run(case, progress)``, for the governing cases, which get reports of their own.
    progress : Progress
    report, pdf, as_zarr : bool
        What is written next to ``study.nc`` and ``study.csv``.

    Returns
    -------
    Result
        With the assessment and the governing cases.
    list of Path
        The files.
    """
    from moyai.study.assess import assess, governing
    from moyai.study.summary import write_table

    result = assess(plan, result, plan.assessment)
    if report and plan.search is None and not plan.watch:
        plan = _with_watched_response(plan, result)
    governs = governing(plan, result, max(plan.replays, 1))
    if report:
        result = _with_replays(plan, result, governs, folder, run, progress)
    files = [result.write(folder / "study.nc")]
    if as_zarr:
        from moyai.study.zarr_file import write_zarr

        files.append(write_zarr(result, folder / "study.zarr"))
    files.append(write_table(plan, result, folder / "study.csv"))
    if report:
        from moyai.report.writer import write_report

        files += write_report(result, folder, pdf=pdf)
    return result, files


def _with_watched_response(plan: Study, result: Result) -> Study:
    """Return the study watching the response that varies most, where the file names none."""
    from moyai.study.report.page import interesting
    from moyai.study.report.reading import read_study

    names = interesting(read_study(result))
    return replace(plan, watch=names[0]) if names else plan


def _with_replays(
    plan: Study, result: Result, governs: list[tuple[str, int, float]], folder: Path, run: RunCase, progress: Progress
) -> Result:
    """Run the governing cases again with reports of their own, and note in the result where they lie."""
    from moyai.report.writer import write_report
    from moyai.study.assess import utilised

    folders: dict[int, str] = {}
    wanted = plan.replays if plan.search is None and result.status != "interrupted" else 0
    for index in list(dict.fromkeys(index for _, index, _ in governs))[:wanted]:
        name = f"governing/case {index}"
        again = run(case_at(plan, plan.cases[index]), progress)
        again.write(folder / name / "results.nc")
        write_report(again, folder / name)
        folders[index] = name
    reported = [[component, index, value, folders.get(index, "")] for component, index, value in governs]
    kind = "utilisation" if utilised(result) else "watch"
    tree = result.tree.copy()
    tree.attrs.update({"governing": json.dumps(reported), "governing_kind": kind})
    return replace(result, tree=tree)
