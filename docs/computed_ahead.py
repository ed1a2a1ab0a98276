"""Sphinx extension: what the pages show of runs, computed by all cores while the pages are read.

A directive asks for what it shows by :func:`ahead`: it waits for what is being computed, and computes the rest itself.
"""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ProcessPoolExecutor
from pathlib import Path
from typing import Any

from sphinx.application import Sphinx
from sphinx.environment import BuildEnvironment

_started: dict[str, Future[Any]] = {}
_pools: list[ProcessPoolExecutor] = []
Job = tuple[Callable[..., Any], tuple[Any, ...], dict[str, Any]]


def ahead(function: Callable[..., Any], *arguments: Any, **options: Any) -> Any:
    """Return what a function gives, computed ahead where it was started."""
    started = _started.get(_key(function, arguments, options))
    return function(*arguments, **options) if started is None else started.result()


def _key(function: Callable[..., Any], arguments: tuple[Any, ...], options: dict[str, Any]) -> str:
    return repr((function.__module__, function.__name__, arguments, options))


def jobs(outdir: Path, text: str, *, quick: bool) -> Iterator[Job]:
    """Give what the directives in a text will ask for, the longest first."""
    import gallery
    import moving_picture
    import report_pictures
    import reproduced_papers
    import validation_results

    if "{validation" in text:
        yield validation_results.computed, (outdir / "validation",), {"quick": quick}
    if ".. reproduced-papers::" in text:
        from moyai.reproduce import papers

        yield from ((reproduced_papers.compute, (paper.key, outdir), {}) for paper in papers())
    if ".. example-gallery::" in text:
        places = ((path, gallery.folder_of(path, outdir)) for path in gallery.examples())
        yield from ((gallery.card, place, {"quick": quick}) for place in places)
    if "{moving-picture}" in text:
        yield moving_picture.kept_picture, (outdir / "_images",), {}
    for name in (*report_pictures.RUNS, "add_a_structure"):
        if f":of: {name}\n" in text:
            yield report_pictures.kept_pictures, (name, outdir / "pictures"), {}


def _begin() -> None:
    """Prepare a process: the others take the other cores."""
    from moyai.core.processes import collect_rarely, die_with_parent

    os.environ["MOYAI_COMPILE_PROCESSES"] = "0"
    collect_rarely()
    die_with_parent()


def start(app: Sphinx, env: BuildEnvironment, names: list[str]) -> None:
    """Start what the pages to be read will ask for."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if cores < 2:
        return
    text = "\n".join(Path(env.doc2path(name)).read_text(encoding="utf-8") for name in names)
    found = list(jobs(Path(app.outdir), text, quick=os.environ.get("MOYAI_DOCS_QUICK") == "1"))
    if not found:
        return
    pool = ProcessPoolExecutor(cores, multiprocessing.get_context("spawn"), initializer=_begin)
    _pools.append(pool)
    for function, arguments, options in found:
        _started[_key(function, arguments, options)] = pool.submit(function, *arguments, **options)


def stop(app: Sphinx, exception: Exception | None) -> None:
    """End the processes."""
    while _pools:
        _pools.pop().shutdown(cancel_futures=True)
    _started.clear()


def setup(app: Sphinx) -> dict[str, bool]:
    """Take part in the reading of the pages."""
    app.connect("env-before-read-docs", start)
    app.connect("build-finished", stop)
    return {"parallel_read_safe": False}
