"""Compute published and exact cases again and compare them with their references."""

from __future__ import annotations

import math
import pkgutil
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent

if TYPE_CHECKING:
    from moyai.core.validation import ValidationCase


@dataclass(frozen=True)
class Outcome:
    """One case computed again."""

    #: Module that holds the case.
    topic: str
    case: ValidationCase
    #: What came out (NaN when it failed).
    value: float
    #: Why there is no value, else empty.
    failure: str = ""

    @property
    def error(self) -> float:
        """Error against the reference, relative [-] or in its unit."""
        return self.case.error(self.value)

    @property
    def passed(self) -> bool:
        """Whether the error is within the tolerance."""
        return bool(self.error <= self.case.tolerance)

    def as_dict(self) -> dict[str, Any]:
        """Return the record that ``moyai validate --json`` prints."""
        return {
            "name": self.case.name,
            "source": self.case.source,
            "reference_kind": self.case.kind,
            "value": self.value,
            "reference": self.case.reference,
            "error": self.error,
            "tolerance": self.case.tolerance,
            "passed": self.passed,
            "topic": self.topic,
            "relative": self.case.relative,
            "note": self.case.note,
            "failure": self.failure,
        }


def topics() -> tuple[str, ...]:
    """Return the names of all modules of :mod:`moyai.validation`.

    Returns
    -------
    tuple of str
        In the order of the alphabet.

    Examples
    --------
    >>> from moyai.validation import topics
    >>> "mooring" in topics()
    True
    """
    names = [
        module.name for module in pkgutil.iter_modules([str(Path(__file__).parent)]) if not module.name.startswith("_")
    ]
    return tuple(sorted(names))


def choose(wanted: Iterable[str]) -> list[tuple[str, ValidationCase]]:
    """Return the cases of the wanted topics, all of them when none is named.

    Parameters
    ----------
    wanted : iterable of str
        Topics.

    Returns
    -------
    list of (str, ValidationCase)
        Topic and case.

    Raises
    ------
    InputError
        For a topic that does not exist.

    Examples
    --------
    >>> from moyai.validation import choose
    >>> {topic for topic, _ in choose(["mooring"])}
    {'mooring'}
    """
    known = topics()
    names = list(wanted)
    for name in names:
        if name not in known:
            import difflib

            near = difflib.get_close_matches(name, known, 1)
            remedy = f"did you mean '{near[0]}'?" if near else ""
            raise InputError(f"unknown topic '{name}'", path="--only", allowed=", ".join(known), remedy=remedy)
    found: list[tuple[str, ValidationCase]] = []
    for topic in names or known:
        module = import_module(f"moyai.validation.{topic}")
        found.extend((topic, case) for case in getattr(module, "CASES", ()))
    return found


def _nobody(_outcome: Outcome) -> None:
    """Take an outcome and do nothing."""


def compute(
    chosen: list[tuple[str, ValidationCase]],
    progress: Progress = silent,
    ended: Callable[[Outcome], None] = _nobody,
) -> list[Outcome]:
    """Compute every case; one that raises has failed and the others go on.

    Parameters
    ----------
    chosen : list of (str, ValidationCase)
        Topic and case.
    progress : Progress
        Called before every case.
    ended : callable
        Takes each outcome as its case ends.

    Returns
    -------
    list of Outcome
        In the order of the cases.

    Examples
    --------
    >>> from moyai.validation import choose, compute
    >>> [outcome.passed for outcome in compute(choose(["mooring"])[:1])]
    [True]
    """
    outcomes = []
    for index, (topic, case) in enumerate(chosen):
        progress("validation", index, len(chosen))
        try:
            outcomes.append(Outcome(topic, case, float(case.compute())))
        except Exception as error:
            # A broken case must not hide the others; its name and reason stand in the table
            outcomes.append(Outcome(topic, case, math.nan, f"{type(error).__name__}: {error}"))
        ended(outcomes[-1])
    progress("validation", len(chosen), max(len(chosen), 1))
    return outcomes
