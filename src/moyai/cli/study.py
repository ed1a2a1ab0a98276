"""The ``moyai study`` command: many cases at once, here or on a cluster."""

from __future__ import annotations

import os
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from moyai.cli.console import BAD_INPUT, FAILED, OK, guard, inform, print_json, progress_bars, put, say, tell
from moyai.core.errors import InputError
from moyai.core.wording import counted
from moyai.language import said

if TYPE_CHECKING:
    from moyai.core.progress import Progress
    from moyai.core.results import Result
    from moyai.study.definition import Study
    from moyai.study.execute import Standing


def study(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Study file (YAML).", show_default=False)],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder of the results; out/<name of the file> when absent.")
    ] = None,
    check: Annotated[bool, typer.Option("--check", help="Check all cases, try one, list what would run.")] = False,
    workers: Annotated[
        int | None, typer.Option("--workers", "-w", help="Processes on this machine; one a core when absent.")
    ] = None,
    on: Annotated[str | None, typer.Option("--on", help="Cluster to run on: dask://host:port.")] = None,
    retry_failed: Annotated[bool, typer.Option("--retry-failed", help="Run cases again that failed before.")] = False,
    each: Annotated[bool, typer.Option("--each", help="Print a line for every case that ends.")] = False,
    as_zarr: Annotated[bool, typer.Option("--zarr", help="Write the results as study.zarr too.")] = False,
    report: Annotated[bool, typer.Option(help="Write the report of the study, and of its governing cases.")] = True,
    pdf: Annotated[bool, typer.Option("--pdf", help="Write the report as PDF too.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON on standard output, errors included.")] = False,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no summary.")] = False,
) -> None:
    """Run every case of a study; the same command continues where it was stopped."""
    with guard(as_json):
        from moyai.study.plan import load_study

        started = time.perf_counter()
        if as_zarr:
            from moyai.study.zarr_file import require_zarr

            require_zarr()
        if workers is not None and workers < 1:
            raise InputError(f"{workers} workers cannot run anything", path="--workers", allowed="1 or more")
        with progress_bars(quiet) as progress:
            plan = load_study(file, progress)
        folder = output if output is not None else Path("out") / file.stem
        if check:
            record = _plan(plan, workers, progress)
            if as_json:
                print_json(record)
            else:
                _print_plan(file, record)
            raise typer.Exit(OK)
        from moyai.cli.runner import run as run_case
        from moyai.study.execute import run_study

        count = workers if workers is not None else max(1, min(os.cpu_count() or 1, len(plan.cases)))
        if not quiet and not as_json:
            points = ", ".join(f"{axis.name.replace('_', ' ')}: {len(axis.points)}" for axis in plan.axes)
            count_of_cases = said(f"{counted(len(plan.cases), 'case')}" + (f" ({points})" if points else ""))
            inform(f"{plan.title}: {count_of_cases}")
        for word in _refused(plan) if not quiet and not as_json else ():
            tell(word)
        lines = _ProgressLines(plan, quiet or as_json, each)
        with progress_bars(quiet or as_json) as progress:
            result = run_study(
                plan, folder, run_case, workers=count, on=on, retry_failed=retry_failed, progress=progress, watch=lines
            )
        from moyai.study.report.finish import finish_study

        with progress_bars(quiet or as_json) as progress:
            result, files = finish_study(
                plan, result, folder, run_case, progress, report=report, pdf=pdf, as_zarr=as_zarr
            )
        seconds = time.perf_counter() - started
        if as_json:
            print_json(
                {
                    "status": result.status,
                    "message": result.message,
                    "cases": len(plan.cases),
                    "files": [str(path) for path in files],
                    "seconds": round(seconds, 3),
                    "faults": [],
                }
            )
        elif not quiet:
            for words in answers_of_search(result):
                say(words)
            say(f"{result.status}: {result.message} in {seconds:.1f} s")
            for path in files:
                put(f"  {path}")
            if result.status == "interrupted":
                say("give the same command again to continue")
        raise typer.Exit(OK if result.status == "converged" else FAILED)


def _plan(plan: Study, workers: int | None, progress: Progress) -> dict[str, Any]:
    """Return what would run; one case is run to know the time and the room that all need."""
    import json
    from dataclasses import replace

    from moyai.cli.runner import run as run_case
    from moyai.study.plan import case_at
    from moyai.study.trial import require_responses, runs_of_search
    from moyai.study.work import Task
    from moyai.study.work import run_case as run_one

    task = Task(plan.base, plan.base_path.resolve(), plan.wanted, None, run_case)
    sound = [case for case in plan.cases if case.index not in set(plan.refused)]
    middle = sound[len(sound) // 2]
    first = case_at(plan, middle)
    # The first run of a process loads and compiles; the ones after it tell what a case costs, and must be other cases,
    # since a case of its own hydrodynamics finds nothing in memory
    require_responses(plan, run_case(first, progress).tree)
    others = [case for case in (sound[0], sound[-1]) if case is not middle] or [middle]
    # What a search takes from a case (the step of a trade-off) means nothing to a single run
    plain = [replace(case, options=()) for case in others]
    records = [record for case in plain if (record := run_one(task, case)) is not None]
    record = max(records, key=lambda one: (one.status == "failed", len(one.values)))
    seconds = sum(one.seconds for one in records) / len(records)
    runs = runs_of_search(plan)
    count = workers or os.cpu_count() or 1
    size = len(json.dumps(record.values)) + 200 if plan.search is None else 2000
    return {
        "title": plan.title,
        "base": str(plan.base_path),
        "cases": len(plan.cases),
        "refused": len(plan.refused),
        "axes": [{"name": axis.name, "points": len(axis.points)} for axis in plan.axes],
        "seconds_per_case": seconds * runs,
        "runs_per_case": runs,
        "workers": count,
        "expected_seconds": seconds * runs * len(plan.cases) / min(count, len(plan.cases)),
        "expected_megabytes": size * len(plan.cases) / 1e6,
        "trial_status": record.status,
        "trial_message": record.message,
        "faults": [],
    }


def _refused(plan: Study) -> list[str]:
    """Return what is to be said of cases that the check refused."""
    if not plan.refused:
        return []
    return [f"{counted(len(plan.refused), 'case')} refused by the check: rows with the reason, not run"]


def _print_plan(file: Path, record: dict[str, Any]) -> None:
    say(f"{file}: no errors")
    for axis in record["axes"]:
        say(f"  {axis['name']}: {counted(axis['points'], 'point')}")
    runs = f", a search of up to {record['runs_per_case']} runs" if record["runs_per_case"] > 1 else ""
    each = f"{record['seconds_per_case']:.2f} s each as tried now ({record['trial_status']})"
    say(f"  {counted(record['cases'], 'case')}, {each}{runs}")
    if record["refused"]:
        say(f"  {counted(record['refused'], 'case')} refused by the check: rows with the reason, not run")
    if record["trial_message"]:
        say(f"  the trial said: {record['trial_message']}")
    say(f"  about {_duration(record['expected_seconds'])} on {counted(record['workers'], 'worker')}")
    say(f"  about {record['expected_megabytes']:.2g} MB of results")


def answers_of_search(result: Result, most: int = 12) -> list[str]:
    """Return what a search found, a line a case: the values, what was to be least, what governs."""
    from moyai.report.formatting import format_quantity
    from moyai.study.found import found_by_search
    from moyai.study.report.reading import read_study

    pages, found = read_study(result), found_by_search(result)
    lines = []
    for one in found[:most]:
        where = pages.case_words(one.index)
        parts = [
            f"{path} = {format_quantity(value, unit, 4)}" if value == value else f"no {path} in the range holds"
            for path, value, unit in one.values
        ]
        if one.objective is not None:
            name, least, unit = one.objective
            parts.append(f"least {name} {format_quantity(least, unit, 4)}")
        parts.append(f"governed by {' and '.join(one.governing)}" if one.governing else "no limit governs")
        if one.remark:
            parts.append(one.remark)
        lines.append((f"{where}: " if where else "") + "; ".join(parts))
    if len(found) > most:
        lines.append(f"and {counted(len(found) - most, 'case')} more in the report and study.csv")
    return lines


def _duration(seconds: float) -> str:
    if seconds < 100:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 6000 else f"{seconds / 3600:.1f} h"


class _ProgressLines:
    """Says on standard error how far the study is, where no bar can be drawn and for what a bar cannot say."""

    def __init__(self, plan: Study, silent: bool, each: bool = False) -> None:
        self.plan, self.silent, self.each = plan, silent, each
        self.reported = time.monotonic()

    def __call__(self, standing: Standing) -> None:
        from moyai.report.formatting import format_quantity

        now = time.monotonic()
        if self.each and not self.silent and standing.latest is not None:
            tell(self._case(standing))
        if self.silent or (now - self.reported < 5.0 and standing.done < standing.total):
            return
        self.reported = now
        parts = [f"{standing.done} of {standing.total} cases"]
        if standing.failed:
            parts.append(f"{standing.failed} failed")
        if standing.done < standing.total:
            parts.append(f"{_duration(standing.seconds_left)} left")
        for word, entry in (("largest", standing.largest), ("smallest", standing.smallest)):
            if entry is not None:
                where = ", ".join(self.plan.cases[entry[1]].labels)
                value = format_quantity(entry[0], standing.unit, 4)
                parts.append(f"{word} {self.plan.watch} {value}" + (f" ({where})" if where else ""))
        tell("; ".join(parts))

    def _case(self, standing: Standing) -> str:
        """Return the line of the case that ended last."""
        import numpy as np

        from moyai.report.formatting import format_quantity

        record = standing.latest
        assert record is not None
        words = ", ".join(self.plan.cases[record.index].labels)
        text = (
            f"[{standing.done}/{standing.total}] case {record.index} ({words}): {record.status}, {record.seconds:.2f} s"
        )
        item = record.values.get(self.plan.watch)
        if item is not None and np.isfinite(np.asarray(item["values"], dtype=float)).any():
            largest, unit = float(np.nanmax(item["values"])), item["units"]
            text += f", {format_quantity(largest, unit, 4)}"
        return text + (f": {record.message}" if record.status != "converged" and record.message else "")


__all__ = ["BAD_INPUT", "study"]
