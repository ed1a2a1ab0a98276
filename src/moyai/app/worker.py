"""One warm process that makes drafts: the newest wish of a page counts, what is stale is given up."""

from __future__ import annotations

import asyncio
import itertools
import multiprocessing
import tempfile
import time
from collections.abc import AsyncIterator, Callable
from pathlib import Path
from typing import Any

from moyai.app.draft_process import answer_wishes
from moyai.app.messages import END, STALE, Wish, message
from moyai.app.pins import Run
from moyai.language import said, spoken_in

LONGEST = 120.0
"""Seconds after which a draft is given up and its process ended."""


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
        # Of coefficients; here, so that it goes with the app and outlives a process that is ended
        self._keep = tempfile.TemporaryDirectory(prefix="moyai-app-", ignore_cleanup_errors=True)
        self._turn = asyncio.Lock()
        self._numbers = itertools.count(1)
        self._newest: dict[str, int] = {}
        self._hasty: set[int] = set()
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
        self._end()
        self._pipe, far = self._context.Pipe()
        arguments = (far, self._run, self._stop, self._language, Path(self._keep.name))
        self._process = self._context.Process(target=answer_wishes, args=arguments, daemon=True)
        self._process.start()
        far.close()

    def close(self) -> None:
        """End the process, and remove what it kept."""
        self._end()
        self._keep.cleanup()

    def _end(self) -> None:
        if self._process is None:
            return
        self._stop.set()
        self._pipe.close()
        self._process.join(0.2)
        if self._process.is_alive():
            self._process.kill()
            self._process.join(5.0)
        self._process = None

    async def ask(self, name: str, wish: Callable[[], Wish], *, patient: bool = False) -> AsyncIterator[bytes]:
        """Yield the answers to a wish as lines of JSON; ``stale`` as soon as a newer one is known.

        Parameters
        ----------
        name : str
            Who asks: a newer wish takes the place of one that waits.
        wish : callable
            Gives the wish when its turn has come.
        patient : bool
            Whether what is at work is left to its end; else it is given up.
        """
        number = self._newest[name] = next(self._numbers)
        if not patient:
            self._hasty.add(number)
            if self._turn.locked():
                self._stop.set()
        try:
            async with self._turn:
                self._hasty.discard(number)
                if self._newest[name] != number or (patient and self._hasty):
                    yield STALE
                    return
                try:
                    # what is stale by now is given up by the process, or not drawn by the page
                    async for line in self._exchange(wish()):
                        yield line
                except BaseException:
                    # A page that has gone leaves answers in the pipe that belong to nobody
                    self._end()
                    raise
        finally:
            self._hasty.discard(number)

    async def _exchange(self, wish: Wish) -> AsyncIterator[bytes]:
        self.start()
        if not self._hasty:
            self._stop.clear()
        try:
            self._pipe.send(wish)
            end = time.monotonic() + LONGEST
            while True:
                line = await asyncio.to_thread(self._received, end)
                if line is None:
                    self._end()
                    yield self._lost(f"the draft took more than {LONGEST:.0f} s: start a full run instead")
                    return
                if line == END:
                    return
                yield line
        except (EOFError, OSError):
            code = None if self._process is None else self._process.exitcode
            self._end()
            yield self._lost(f"the process of the drafts ended (exit code {code}); the next change starts it")

    def _lost(self, words: str) -> bytes:
        with spoken_in(self._language):
            return message("lost", text=said(words))

    def _received(self, end: float) -> bytes | None:
        left = max(end - time.monotonic(), 0.0)
        return self._pipe.recv_bytes() if self._pipe.poll(left) else None
