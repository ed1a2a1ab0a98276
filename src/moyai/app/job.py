"""A job and where it stands: what the page shows of it."""

from __future__ import annotations

import os
import shlex
import subprocess
import time
from pathlib import Path
from typing import Any

from moyai.app.job_process import Order
from moyai.app.job_records import ENDED, KeptJob, keep
from moyai.language import said
from moyai.report.on_demand import makeable

FILES = ("report.html", "results.nc", "study.nc", "fit.nc", "study.csv", "report.xlsx", "case.yaml")


class Job:
    """A job and where it stands.

    Parameters
    ----------
    key : str
    order : Order
    kept : Kept, optional
        What an app before this one left of it.

    Attributes
    ----------
    state : str
        ``waiting``, ``running``, ``cancelling``, ``done``, ``failed``, ``cancelled`` or ``lost`` (its process was
        killed from outside, or the app ended before it).
    """

    def __init__(self, key: str, order: Order, kept: KeptJob | None = None) -> None:
        self.key = key
        self.order = order
        self.state = "waiting" if kept is None else kept.state
        self.words = "" if kept is None else kept.words
        self.before = 0.0 if kept is None else kept.seconds
        self.ordered = time.time() if kept is None else kept.ordered
        self.stage = self.left = ""
        self.fraction = self.started = self.ended = self.asked = 0.0
        self.process: Any = None
        self.stop: Any = None

    def record(self, root: Path) -> dict[str, Any]:
        """Return what the page shows of it, in the language in force."""
        folder = self.order.folder
        shown = folder.relative_to(root) if folder.is_relative_to(root) else folder
        files = [name for name in FILES if (folder / name).is_file()] if self.state in ENDED else []
        files += makeable(folder) if self.state in ENDED else []
        return {
            "id": self.key,
            "kind": self.order.kind,
            "name": self.order.name,
            "folder": str(shown),
            "state": self.state,
            "words": said(self.words),
            "stage": said(self.stage),
            "fraction": round(self.fraction, 4),
            "left": said(self.left),
            "seconds": round(self.seconds(), 1),
            "files": files,
            "command": self.command(str(shown)),
            "process": self.process.pid if self.process is not None and self.state == "running" else None,
        }

    def seconds(self) -> float:
        """Return how long it has taken."""
        return (self.ended or time.monotonic()) - self.started if self.started else self.before

    def keep(self) -> None:
        """Write where it stands next to its results."""
        keep(self.order, self.state, self.words, self.seconds(), self.ordered)

    def command(self, shown: str) -> str:
        """Return the command line that does the same."""
        if self.order.kind == "paper":
            return f"moyai reproduce {self.order.name} --quick --output {_quoted(shown)}"
        file = self.order.name if self.order.saved else f"{shown}/case.yaml"
        return f"moyai {self.order.kind} {_quoted(file)} --output {_quoted(shown)}"


def _quoted(text: str) -> str:
    return subprocess.list2cmdline([text]) if os.name == "nt" else shlex.quote(text)
