"""A published or exact case that ``moyai validate`` computes again."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class ValidationCase:
    """One number that somebody else found, and how to compute it here.

    Parameters
    ----------
    name : str
        Short unique name, ``<topic>: <what>``.
    source : str
        Paper and equation, exact solution, identity, or measured record.
    compute : callable
        Returns the value; called without arguments, pure, quick (seconds at most).
    reference : float
        The value of the source.
    tolerance : float
        Accepted error, with its reason in ``note``.
    relative : bool
        Whether the error is divided by ``|reference|``.
    note : str
        Why the tolerance is what it is; known misprints of the source.
    """

    name: str
    source: str
    compute: Callable[[], float]
    reference: float
    tolerance: float
    relative: bool = True
    note: str = ""

    def error(self, value: float) -> float:
        """Return the absolute or relative error of ``value``."""
        difference = abs(value - self.reference)
        if self.relative:
            return difference / abs(self.reference) if self.reference else math.inf
        return difference
