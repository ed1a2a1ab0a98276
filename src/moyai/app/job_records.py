"""What is kept of jobs next to their results, so that an app that starts later lists them."""

from __future__ import annotations

import contextlib
import json
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from moyai.app.folder import Folder
from moyai.app.job_process import Order
from moyai.core.errors import InputError, MoyaiError
from moyai.core.files import write_whole
from moyai.core.run_folder import alone_in

NAME = "job.json"
ENDED = ("done", "failed", "cancelled", "lost")
WAITED = "the app ended before this job began; start it again"
STOPPED = "the app ended before this job did; start it again"
STOPPED_STUDY = "the app ended before this job did; it continues from the cases that have ended"
_KINDS = ("run", "study", "fit", "paper")
_MOST_FOLDERS = 1000
_LARGEST = 5_000_000


@dataclass(frozen=True)
class KeptJob:
    """A job of an app that has ended."""

    order: Order
    state: str
    words: str
    #: It took [s].
    seconds: float
    #: When it was ordered [s since 1970].
    ordered: float


def keep(order: Order, state: str, words: str, seconds: float, ordered: float) -> None:
    """Write where a job stands into its folder; where that cannot be written the job goes on without."""
    file = order.file.relative_to(order.root) if order.file.is_relative_to(order.root) else Path(order.file.name)
    content = {
        "moyai_job": 1,
        **{name: getattr(order, name) for name in ("kind", "name", "text", "saved", "language")},
        "file": file.as_posix(),
        "state": state,
        "words": words,
        "seconds": seconds,
        "ordered": ordered,
    }
    with contextlib.suppress(OSError, MoyaiError):
        order.folder.mkdir(parents=True, exist_ok=True)
        write_whole(order.folder / NAME, json.dumps(content).encode())


def kept_jobs(folder: Folder) -> list[KeptJob]:
    """Return the jobs whose results lie in the output folder, in the order in which they were ordered.

    One at which another app is at work is left out. One that had not ended when its app did is reported as lost.
    """
    found: list[KeptJob] = []
    with contextlib.suppress(OSError):
        for place in sorted(folder.output.iterdir())[:_MOST_FOLDERS]:
            path = place / NAME
            if place.is_symlink() or path.is_symlink() or not path.is_file() or path.stat().st_size > _LARGEST:
                continue
            with contextlib.suppress(OSError, ValueError, KeyError, TypeError, RecursionError, MoyaiError):
                if (one := _read(folder, place, json.loads(path.read_text(encoding="utf-8")))) is not None:
                    found.append(one)
    return sorted(found, key=lambda one: one.ordered)


def _read(folder: Folder, place: Path, content: dict[str, Any]) -> KeptJob | None:
    """Return a job as it was kept; nothing that it names lies outside the folder of the app."""
    kind, state, words = content["kind"], str(content["state"]), str(content["words"])
    if content["moyai_job"] != 1 or kind not in _KINDS:
        return None
    if state not in ENDED:
        try:
            with alone_in(place):
                pass
        except InputError:
            return None
        words = WAITED if state == "waiting" else STOPPED_STUDY if kind == "study" else STOPPED
        state = "lost"
    order = Order(
        kind, str(content["name"]), place, folder.root, folder.inside(str(content["file"])),
        str(content["text"]), content["saved"] is True, "ja" if content["language"] == "ja" else "en",
    )  # fmt: skip
    ordered = float(content["ordered"])
    return KeptJob(order, state, words, float(content["seconds"]), ordered if ordered < time.time() else time.time())
