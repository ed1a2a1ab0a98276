"""Progress of long work, told to whoever listens; kernels never print."""

from __future__ import annotations

from typing import Protocol


class Progress(Protocol):
    """Listener for the progress of long work.

    A listener may raise :class:`KeyboardInterrupt` to stop the work; the worker then hands back what it has.
    """

    def __call__(self, what: str, done: float, total: float) -> None:
        """Tell that ``done`` of ``total`` units of the work named ``what`` are finished."""


def silent(what: str, done: float, total: float) -> None:
    """Listen and say nothing (the default)."""
