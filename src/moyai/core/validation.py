"""A published or exact case that ``moyai validate`` computes again."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from moyai.core.options import checks_words

ReferenceKind = Literal["exact", "published", "measured", "other program", "own second"]

#: What the words of a source tell of it, the first that fits; what none fits is exact: a closed form or an identity.
_WORDS: tuple[tuple[ReferenceKind, str], ...] = (
    ("exact", r"^planted"),
    ("own second", r"^matched eigenfunctions|matched eigenfunctions with|vortex panels|of (an)?other construction"),
    ("own second", r"computed independently|evaluated (apart|independently)|recomputed|^independent prototype"),
    ("own second", r"^(two-dimensional |converging )?prototype|\(independent prototype\)|independent prototype of the"),
    ("own second", r"converging two-dimensional prototype|by an independent prototype"),
    ("other program", r"MoorDyn|MoorPy|CableDyn|raschii|scipy|FOURIER|same printed solution"),
    ("measured", r"measurements"),
    ("published", r"\b(18|19|20)\d\d\b|Arai|Matsubara|Nakamura|Sawaragi|Tabata|printed|published|ITOPF|US Navy|Love:"),
    ("published", r"tabulated|studies of it"),
)


def reference_kind(source: str) -> ReferenceKind:
    """Return what kind of reference the words of a source name.

    Parameters
    ----------
    source : str

    Returns
    -------
    str
        ``exact``: closed form, identity or planted value; ``published``; ``measured``; ``other program``;
        ``own second``: a second program of our own, or a published formula evaluated apart from the code.
    """
    return next((kind for kind, words in _WORDS if re.search(words, source)), "exact")


@checks_words
@dataclass(frozen=True)
class ValidationCase:
    """One number that somebody else found, and how to compute it here."""

    #: Short unique name, ``<topic>: <what>``.
    name: str
    #: Paper and equation, exact solution, identity, or measured record.
    source: str
    #: Returns the value; called without arguments, pure, quick (seconds at most).
    compute: Callable[[], float]
    #: The value of the source.
    reference: float
    #: Accepted error, with its reason in ``note``.
    tolerance: float
    #: Whether the error is divided by ``|reference|``.
    relative: bool = True
    #: Why the tolerance is what it is; known misprints of the source.
    note: str = ""

    @property
    def kind(self) -> ReferenceKind:
        """What kind of reference it is, see :func:`reference_kind`."""
        return reference_kind(self.source)

    def error(self, value: float) -> float:
        """Return the absolute or relative error of ``value``.

        Parameters
        ----------
        value : float
            In the unit of the reference.

        Returns
        -------
        float
            In that unit, or [-] where it is relative.
        """
        difference = abs(value - self.reference)
        if self.relative:
            return difference / abs(self.reference) if self.reference else math.inf
        return difference
