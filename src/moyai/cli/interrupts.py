"""Ctrl-C after an import, or after results are written, where it comes within.

A module that is left half loaded spoils whatever asks for it afterwards.
"""

from __future__ import annotations

import signal
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from types import FrameType

#: Seconds after which Ctrl-C is passed on again, and after which it comes through all the same.
_AGAIN, _PATIENCE = 0.02, 30.0


class _Interrupts:
    #: When the first one came that is held back; ``None`` while none is.
    since: float | None = None
    held_back = False


@contextmanager
def held_back() -> Iterator[None]:
    """Hold interrupts back until the block ends."""
    _Interrupts.held_back = True
    try:
        yield
    finally:
        _Interrupts.held_back = False


def listen() -> None:
    """Take Ctrl-C, and what ends the program politely, in the way of this module."""
    signal.signal(signal.SIGTERM, interrupt)
    # a shell has background jobs ignore Ctrl-C, and they go on doing so
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, interrupt)


def interrupt(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt, after the import that is going on or the block of :func:`held_back`.

    Parameters
    ----------
    number : int
        Of the signal.
    frame : FrameType or None
        What the program was doing.

    Raises
    ------
    KeyboardInterrupt
    """
    now = time.monotonic()
    if (_Interrupts.held_back or _importing(frame)) and now - (_Interrupts.since or now) < _PATIENCE:
        _Interrupts.since = _Interrupts.since or now
        again = threading.Timer(_AGAIN, _send, (number,))
        again.daemon = True
        again.start()
        return
    _Interrupts.since = None
    raise KeyboardInterrupt


def _importing(frame: FrameType | None) -> bool:
    while frame is not None:
        if frame.f_code.co_filename.startswith("<frozen importlib"):
            return True
        frame = frame.f_back
    return False


def _send(number: int) -> None:
    """Send a signal to the main thread, which wakes it where the system can."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        signal.raise_signal(number)
