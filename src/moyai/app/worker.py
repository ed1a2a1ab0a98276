"""One warm process that makes drafts: the newest wish of a document counts, what is stale is given up."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import multiprocessing
import os
import signal
import tempfile
import time
from collections.abc import AsyncIterator, Callable
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import Any

from moyai.app.draft import VERSION, Drafts, Wish
from moyai.app.pins import Run
from moyai.core.processes import collect_rarely, die_with_parent
from moyai.language import said, speak, spoken_in

LONGEST = 120.0
"""Seconds after which a draft is given up and its process ended."""
REST = 0.35
"""Seconds without a newer wish before the longer analyses of a draft begin."""
_END = b""
_STALE = b'{"version":1,"message":"stale"}\n'


class DraftWorker:
    """Parent's side of the process.

    Parameters
    ----------
    run : callable
        Runs a case; a function of a module, since the process imports it by name.
    language : str
        Of errors, and of drafts whose case names none.
    """

    def __init__(self, run: Run, language: str = "en") -> None:
        self._run = run
        self._language = language
        self._context = multiprocessing.get_context("spawn")
        self._stop = self._context.Event()
        self._turn = asyncio.Lock()
        self._numbers = itertools.count(1)
        self._newest: dict[str, int] = {}
        self._busy_with = ""
        self._process: Any = None
        self._pipe: Any = None

    @property
    def process_id(self) -> int | None:
        """Number of the process, None before it was started."""
        return None if self._process is None else self._process.pid

    def start(self) -> None:
        """Start the process, so that it is warm when the first draft is asked for."""
        if self._process is not None and self._process.is_alive():
            return
        self.close()
        self._pipe, far = self._context.Pipe()
        arguments = (far, self._run, self._stop, self._language)
        self._process = self._context.Process(target=_serve, args=arguments, daemon=True)
        self._process.start()
        far.close()

    def close(self) -> None:
        """End the process."""
        if self._process is None:
            return
        self._stop.set()
        self._pipe.close()
        self._process.join(0.2)
        if self._process.is_alive():
            self._process.kill()
            self._process.join(5.0)
        self._process = None

    async def ask(self, name: str, wish: Wish) -> AsyncIterator[bytes]:
        """Yield the answers to a wish as lines of JSON; ``stale`` as soon as a newer one of this name is known.

        Parameters
        ----------
        name : str
            The document.
        wish : Wish
        """
        number = self._newest[name] = next(self._numbers)
        if self._busy_with == name:
            self._stop.set()
        async with self._turn:
            if self._newest[name] != number:
                yield _STALE
                return
            self._busy_with = name
            try:
                # what is stale by now is given up by the process, or not drawn by the page
                async for line in self._exchange(wish):
                    yield line
            except BaseException:
                # A page that has gone leaves answers in the pipe that belong to nobody
                self.close()
                raise
            finally:
                self._busy_with = ""

    async def _exchange(self, wish: Wish) -> AsyncIterator[bytes]:
        self.start()
        self._stop.clear()
        try:
            self._pipe.send(wish)
            end = time.monotonic() + LONGEST
            while True:
                line = await asyncio.to_thread(self._received, end)
                if line is None:
                    self.close()
                    yield self._lost(f"the draft took more than {LONGEST:.0f} s: start a full run instead")
                    return
                if line == _END:
                    return
                yield line
        except (EOFError, OSError):
            code = None if self._process is None else self._process.exitcode
            self.close()
            yield self._lost(f"the process of the drafts ended (exit code {code}); the next change starts it")

    def _lost(self, words: str) -> bytes:
        with spoken_in(self._language):
            return message("lost", text=said(words))

    def _received(self, end: float) -> bytes | None:
        left = max(end - time.monotonic(), 0.0)
        return self._pipe.recv_bytes() if self._pipe.poll(left) else None


def message(kind: str, /, **content: Any) -> bytes:
    """Return a message to the page as a line of JSON."""
    from moyai.report.encoding import page_json

    return page_json({"version": VERSION, "message": kind, **content}).encode() + b"\n"


def _serve(pipe: Any, run: Run, stop: Any, language: str) -> None:
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

    with tempfile.TemporaryDirectory(prefix="moyai-app-") as keep, contextlib.suppress(EOFError, OSError):
        drafts = Drafts(run, Path(keep), rest)
        while True:
            wish = pipe.recv()
            try:
                for answer in drafts.answer(wish, listen):
                    kind = answer.pop("message")
                    pipe.send_bytes(_encoded(kind, answer))
            except KeyboardInterrupt:
                pipe.send_bytes(_STALE)
            except OSError:
                raise
            except Exception as error:
                words = f"internal error, {type(error).__name__}: {error}"
                pipe.send_bytes(message("not drawn", faults=[{"message": said(words), "line": 0}]))
            pipe.send_bytes(_END)
    os._exit(0)


def _encoded(kind: str, answer: dict[str, Any]) -> bytes:
    return message(kind, **{key: _finite(value) if key == "headlines" else value for key, value in answer.items()})


def _finite(value: Any) -> Any:
    """Return a value with None where a number is not finite."""
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(item) for item in value]
    return None if isinstance(value, float) and not abs(value) < float("inf") else value


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
