"""Ctrl-C a little later where it would do harm: in an import, while results are written, where nobody would hear it.

A module that is left half loaded spoils whatever asks for it afterwards. What is raised in a call back from machine
code, or while an object is given up, is reported and dropped.
"""

from __future__ import annotations

import signal
import threading
import time
import weakref
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
    before, _Interrupts.held_back = _Interrupts.held_back, True
    try:
        yield
    finally:
        _Interrupts.held_back = before


def listen() -> None:
    """Take Ctrl-C, and what ends the program politely, in the way of this module."""
    signal.signal(signal.SIGTERM, interrupt)
    # a shell has background jobs ignore Ctrl-C, and they go on doing so
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, interrupt)


def ignore() -> None:
    """Hear no more: what comes while the program ends changes nothing of what it did."""
    for number in (signal.SIGINT, signal.SIGTERM):
        if signal.getsignal(number) is interrupt:
            signal.signal(number, signal.SIG_IGN)


def interrupt(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt, after the import or call back that is going on or the block of :func:`held_back`.

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
    if (_Interrupts.held_back or _delicate(frame)) and now - (_Interrupts.since or now) < _PATIENCE:
        _Interrupts.since = _Interrupts.since or now
        again = threading.Timer(_AGAIN, _send, (number,))
        again.daemon = True
        again.start()
        return
    _Interrupts.since = None
    raise KeyboardInterrupt


def _delicate(frame: FrameType | None) -> bool:
    """Whether a frame or one that called it imports, is called by machine code of llvmlite, or gives up an object."""
    while frame is not None:
        file, name = frame.f_code.co_filename, frame.f_code.co_name
        if file.startswith("<frozen importlib") or "llvmlite" in file or name == "__del__" or file == weakref.__file__:
            return True
        frame = frame.f_back
    return False


def _send(number: int) -> None:
    """Send a signal to the main thread, which wakes it where the system can."""
    if hasattr(signal, "pthread_kill"):
        signal.pthread_kill(threading.main_thread().ident or 0, number)
    else:
        signal.raise_signal(number)
