"""Progress of long work, reported to whoever listens; kernels never print."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol


class Progress(Protocol):
    """Listener for the progress of long work.

    A listener may raise :class:`KeyboardInterrupt` to stop the work; the worker then hands back what it has.
    """

    def __call__(self, what: str, done: float, total: float) -> None:
        """Tell that ``done`` of ``total`` units of the work named ``what`` are finished."""


def silent(what: str, done: float, total: float) -> None:
    """Listen and say nothing (the default)."""


@dataclass
class _Stage:
    first: float
    done: float
    total: float
    started: float
    reported: float
    #: Done between the last two reports.
    step: float = 1.0


class Pace:
    """Measures how fast the stages of a run go, and says how long they still take.

    A stage is known by its words; stages may lie in each other. The rate is that since the stage began, so that the
    time left is known from its second report on, however long one step takes.

    Parameters
    ----------
    clock : callable
        Seconds.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._stages: dict[str, _Stage] = {}
        self._begun = clock()

    def tell(self, what: str, done: float, total: float) -> None:
        """Take a report of progress; the listener of a run."""
        now = self._clock()
        stage = self._stages.get(what)
        if stage is None or done < stage.done:
            self._stages[what] = stage = _Stage(done, done, total, now, now)
        # The last one reported stands last: the innermost
        self._stages[what] = self._stages.pop(what)
        if done > stage.done:
            stage.reported, stage.step = now, done - stage.done
        stage.done, stage.total = done, total

    def left(self, what: str) -> float:
        """Return the seconds that a stage still takes, NaN while nothing of it is done."""
        stage = self._stages.get(what)
        if stage is None or not stage.done > stage.first:
            return math.nan
        each, waited = (stage.reported - stage.started) / (stage.done - stage.first), self._clock() - stage.reported
        # a step that takes longer than those before says that they were quick; what is not done takes some time
        remaining = stage.total - stage.done
        step = min(stage.step, remaining) or 1.0
        each = max(each, waited / step)
        return max(remaining * each - waited, 0.25 * step * each)

    def line(self) -> str:
        """Return where the run stands in one line, empty before the first report."""
        running = {what: stage for what, stage in self._stages.items() if stage.done < stage.total}
        if not running:
            return ""
        parts = []
        for what, stage in running.items():
            left = self.left(what)
            share = f"{100.0 * stage.done / stage.total:.0f} %" if stage.total > 0.0 else ""
            known = f"{share}, {duration_words(left)} left" if math.isfinite(left) else share
            parts.append(f"{what}: {known}")
        return f"{'; '.join(parts)} (running for {duration_words(self._clock() - self._begun)})"


def duration_words(seconds: float) -> str:
    """Return a duration as people say it: ``40 s``, ``3 min 20 s``, ``2 h 5 min``."""
    whole = round(seconds)
    if whole < 60:
        return f"{whole} s"
    if whole < 3600:
        return f"{whole // 60} min {whole % 60} s"
    return f"{whole // 3600} h {whole % 3600 // 60} min"
