"""Further processes: how they are started, end with the one that started them and look for garbage seldom."""

from __future__ import annotations

import gc
import multiprocessing
import os
import sys
import tempfile
import threading
from collections.abc import Callable
from multiprocessing.connection import wait
from typing import Any

LONGEST_FOLDER = 70  # letters of a folder whose sockets have a name of at most 107


class Starter:
    """Starts processes that have imported some modules: on Linux forked from one that has done nothing else.

    Elsewhere each imports them by itself. The process that calls is not forked: its threads and those of its libraries
    do not survive that.

    Parameters
    ----------
    modules : str
        Names of what is imported ahead, by the first that is started.
    """

    def __init__(self, *modules: str) -> None:
        # the socket of the process that is forked has room for a short folder of temporary files only
        forks = sys.platform == "linux" and len(tempfile.gettempdir()) <= LONGEST_FOLDER
        self.context: Any = multiprocessing.get_context("forkserver" if forks else "spawn")
        if forks:
            self.context.set_forkserver_preload(list(modules))

    def start(self, target: Callable[..., None], *arguments: Any) -> Any:
        """Return a process that runs a function of a module in the present environment.

        Parameters
        ----------
        target : callable
        arguments
            Of the function.
        """
        given = dict(os.environ), target, arguments
        process = self.context.Process(target=_in_environment, args=given, daemon=True)
        process.start()
        return process


def _in_environment(environment: dict[str, str], target: Callable[..., None], arguments: tuple[Any, ...]) -> None:
    """Run a function with the variables of whoever started it, not those of the time of the imports."""
    os.environ.clear()
    os.environ.update(environment)
    target(*arguments)


def die_with_parent() -> None:
    """End this process when its parent is gone, also in the middle of its work (kill -9 of the parent)."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def watch() -> None:
        wait([parent.sentinel])
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()


def collect_rarely() -> None:
    """Look for garbage less often: imports and the compiler make a million objects that live on, a tenth of a start."""
    gc.set_threshold(100_000, 50, 50)
