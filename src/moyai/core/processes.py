"""Processes that end with the one that started them and do not look for garbage all the time."""

from __future__ import annotations

import gc
import multiprocessing
import os
import threading
from multiprocessing.connection import wait


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
