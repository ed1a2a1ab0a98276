"""Studies and fits as jobs: run in the process of the job, shown as a table while they run, any case opened."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from moyai.app.folder import Folder, refuse_foreign_files, within
from moyai.app.pins import Run
from moyai.case.yaml_reader import read_yaml
from moyai.core.errors import InputError


def file_kind(data: Any) -> str:
    """Return ``study`` or ``fit`` for the content of such a file, empty for another."""
    kinds = ("study", "fit") if isinstance(data, Mapping) else ()
    return next((kind for kind in kinds if isinstance(data.get(kind), Mapping)), "")


def refuse_foreign_base(folder: Folder, path: Path) -> str:
    """Return the kind of a study or fit file of the folder, whose files and base case lie in the folder too.

    Raises
    ------
    InputError
        When it is neither, or one of its files is outside.
    """
    document = read_yaml(path)
    kind = file_kind(document.data)
    if not kind:
        raise InputError(f"{path.name!r} is no study and no fit", path="file")
    refuse_foreign_files(folder.root, path.parent, document)
    base = document.data[kind].get("base")
    if isinstance(base, str):
        target = within(folder.root, path.parent / base, base)
        if target.is_file():
            refuse_foreign_files(folder.root, target.parent, read_yaml(target))
    return kind


def run_study_job(file: Path, folder: Path, run: Run, listen: Any) -> tuple[str, str, str]:
    """Run a study, or what is left of it; return status, message and verdict."""
    from moyai.study.cases_so_far import write_cases
    from moyai.study.execute import Standing, run_study
    from moyai.study.plan import load_study
    from moyai.study.report.finish import finish_study

    plan = load_study(file, listen)
    write_cases(plan, read_yaml(file).data["study"], folder)

    def watch(standing: Standing) -> None:
        listen("cases", standing.done, standing.total)

    workers = max(1, min((os.cpu_count() or 2) - 1, len(plan.cases)))
    result = run_study(plan, folder, run, workers=workers, progress=listen, watch=watch)
    result, _ = finish_study(plan, result, folder, run)
    return result.status, result.message, ""


def run_fit_job(file: Path, folder: Path, run: Run, listen: Any) -> tuple[str, str, str]:
    """Fit values of a case to observations; return status, message and verdict."""
    from moyai.core.files import write_whole
    from moyai.report.writer import write_report
    from moyai.study.fitting import fitted_text, load_fit, run_fit

    plan = load_fit(file)
    result, found = run_fit(plan, run, listen)
    result.write(folder / "fit.nc")
    write_whole(folder / "case.yaml", fitted_text(plan, found).encode("utf-8"))
    write_report(result, folder)
    return result.status, result.message, ""
