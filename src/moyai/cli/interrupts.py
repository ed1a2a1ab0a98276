"""Ctrl-C between two imports: a module that is left half loaded spoils whatever asks for it afterwards."""

from __future__ import annotations

import signal
import threading
import time
from types import FrameType

#: Seconds after which Ctrl-C is passed on again, and after which it ends an import all the same.
_AGAIN, _PATIENCE = 0.02, 10.0


class _Interrupts:
    """When the first one came that an import held back; ``None`` while none is."""

    since: float | None = None


def interrupt(number: int, frame: FrameType | None) -> None:
    """Raise KeyboardInterrupt, after the import that is going on.

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
    if _importing(frame) and now - (_Interrupts.since or now) < _PATIENCE:
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
