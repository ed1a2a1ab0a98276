"""``moyai compile``: compile the numerical kernels beforehand, for images, clusters and the first run of a laptop."""

from __future__ import annotations

import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any

import typer

from moyai.cli.console import FAILED, guard, progress_bars, tell


def compile_command(
    kinds: Annotated[
        list[str] | None, typer.Argument(metavar="[KIND]...", help="Kinds of structure; all when left out.")
    ] = None,
    processes: Annotated[int | None, typer.Option(min=1, help="Processes; one a core when left out.")] = None,
    record: Annotated[list[Path] | None, typer.Option(hidden=True)] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress bars and no last line.")] = False,
) -> None:
    """Compile the numerical kernels once, so that the first run starts at full speed.

    They are kept in the cache of numba: in the package, in the user's cache folder where the package cannot be
    written, or in the folder that NUMBA_CACHE_DIR names.
    """
    with guard(False):
        from moyai.core.compile_ahead import SharedList, further_processes
        from moyai.core.errors import InputError
        from moyai.core.kinds import structure_kinds

        known = structure_kinds()
        for kind in kinds or ():
            if kind not in known:
                raise InputError(f"{kind!r} is no kind of structure", path="KIND", allowed=", ".join(known))
        if record:
            _record((kinds or [""])[0], record)
            return
        chosen = kinds or list(known)
        shared = SharedList(*chosen)
        whole = sum(kernel.seconds for kernel in shared.kernels)
        begin = time.perf_counter()
        try:
            shared.start(processes if processes is not None else further_processes() + 1)
            with progress_bars(quiet) as progress:
                while None in (codes := shared.codes):
                    time.sleep(0.2)
                    progress("compiling", shared.seconds_done, whole)
        finally:
            shared.stop()
        if any(codes):
            raise typer.Exit(FAILED)
        if not quiet:
            count, took = len(shared.kernels), time.perf_counter() - begin
            tell(f"{count} kernels of {', '.join(chosen)} are compiled ({took:.0f} s)")


def _record(kind: str, cases: Sequence[Path]) -> None:
    """Run cases with an empty cache and write the list of what they compile into the folder of the structure."""
    from importlib import import_module

    from moyai.core.compile_ahead import LIST
    from moyai.core.kinds import structure_kind

    package = import_module(structure_kind(kind).package)
    rows = recorded_kernels(cases)
    (Path(package.__path__[0]) / LIST).write_text("".join(rows), encoding="utf-8", newline="\n")
    tell(f"wrote {len(rows)} kernels of {kind}")


def recorded_kernels(cases: Sequence[Path]) -> list[str]:
    """Run cases and return what they compile, as lines of a list, in the order of completion."""
    from tempfile import TemporaryDirectory

    from numba.core import event

    from moyai.case.reader import load_case
    from moyai.cli.runner import run
    from moyai.core.compile_ahead import signature_text
    from moyai.report.writer import compose_document

    found: dict[str, float] = {}
    running: list[list[float]] = []

    class CompileClock(event.Listener):  # type: ignore[misc]
        def on_start(self, event: Any) -> None:
            running.append([time.process_time(), 0.0])

        def on_end(self, event: Any) -> None:
            begin, inner = running.pop()
            took = time.process_time() - begin
            if running:
                running[-1][1] += took
            kernel = event.data["dispatcher"]
            function = kernel.py_func
            if function.__module__.startswith("moyai.") and getattr(kernel._cache, "cache_path", None):
                with suppress(ValueError):
                    text = signature_text(event.data["args"])
                    found.setdefault(f"{function.__module__} {function.__name__} {text}", took - inner)

    with event.install_listener("numba:compile", CompileClock()), TemporaryDirectory() as folder:
        for path in cases:
            compose_document(run(load_case(path), keep=Path(folder)))
    return [f"{seconds:.2f} {line}\n" for line, seconds in found.items()]


__all__ = ["compile_command", "recorded_kernels"]
