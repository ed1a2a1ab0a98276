"""What the process of the drafts does: answer one wish after the other, warm from its start."""

from __future__ import annotations

import contextlib
import os
import signal
from collections.abc import Callable
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from moyai.app.draft import Drafts
from moyai.app.messages import END, STALE, message
from moyai.app.pins import Run
from moyai.core.processes import collect_rarely, die_with_parent
from moyai.language import said, speak

REST = 0.35
"""Seconds without a newer wish before the longer analyses of a draft begin."""


def answer_wishes(pipe: Any, run: Run, stop: Any, language: str, keep: Path) -> None:
    """Answer wishes until the pipe closes; Ctrl-C is the parent's business."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    die_with_parent()
    collect_rarely()
    speak(language)
    warm_up(pipe.poll)

    def listen(what: str, done: float, total: float) -> None:
        if stop.is_set():
            raise KeyboardInterrupt

    def rest() -> None:
        if stop.wait(REST):
            raise KeyboardInterrupt

    with contextlib.suppress(EOFError, OSError):
        drafts = Drafts(run, keep, rest)
        while True:
            wish = pipe.recv()
            try:
                for answer in drafts.answer(wish, listen):
                    pipe.send_bytes(message(answer.pop("message"), **answer))
            except KeyboardInterrupt:
                pipe.send_bytes(STALE)
            except OSError:
                raise
            except Exception as error:
                words = f"internal error, {type(error).__name__}: {error}"
                pipe.send_bytes(message("not drawn", faults=[{"message": said(words), "line": 0}]))
            pipe.send_bytes(END)
    os._exit(0)


def warm_up(wanted: Callable[[], Any]) -> None:
    """Import what drafts need, until one is wanted: that one goes on with its own."""
    from moyai.core.kinds import structure_kind, structure_kinds

    modules = ("moyai.case.builder", "moyai.report.writer", "moyai.report.html", "xarray", "numba")
    steps = [partial(import_module, name) for name in modules]
    steps += [partial(lambda kind: structure_kind(kind).schema(), name) for name in structure_kinds()]
    for step in steps:
        if wanted():
            return
        with contextlib.suppress(Exception):
            step()
