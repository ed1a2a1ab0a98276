"""Criteria, what each of them was judged to, and the sentences that say it.

The numbers that are judged, and the verdict on all, are in :mod:`moyai.core.headline`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any, Literal

from moyai.core.options import checks_words
from moyai.core.wording import spoken

Bound = Literal["", "at most", "at least"]
Sense = Literal["at most", "at least"]
Outcome = Literal["holds", "does not hold", "not judged"]
UNCONFIRMED = "not confirmed against the standard"
"""What the source of a criterion says of values that nobody has yet compared with the standard itself."""
NOT_COMPUTED = "the computation did not converge inside its range"
"""Why nothing holds of a computation that cannot be judged."""
MOST_FAILING = 8
"""Lines, anchors or bodies that fail one criterion and have a row of their own, at most."""


@checks_words
@dataclass(frozen=True)
class Criterion:
    """What a headline has to keep."""

    #: Key of the criterion in the case file.
    name: str
    #: Name of the headline that is judged.
    headline: str
    #: In the unit of the headline.
    limit: float
    #: One of "at most", "at least".
    sense: Sense
    #: Who set the limit: the case file, a code with its table, or the default of the structure.
    source: str
    #: Words for the reader; the headline's own label where empty.
    label: str = ""
    #: Unit of the limit; ``%`` for a ratio that is shown in per cent.
    unit: str = "1"
    #: Name of the sea state that it is asked in; empty for the governing value.
    sea: str = ""
    #: Whether the limit is one over a factor of safety, which is what people want to read.
    as_factor: bool = False
    #: Weight of the mean of a value over time, that of its varying part being 1 (codes with partial factors).
    mean_weight: float = 1.0
    #: Whether the program assumed it: the case file does not name it.
    assumed: bool = False
    #: Analysis whose numbers it is for; empty: of any.
    analysis: str = ""

    @property
    def words(self) -> str:
        """The criterion in words, with its sea."""
        text = self.label or self.name.replace("_", " ")
        return f"{text} in {self.sea}" if self.sea else text

    def shown(self, value: float) -> float:
        """Return a value as people read it: the factor of safety in place of the utilisation.

        Parameters
        ----------
        value : float
            As it is judged, in the unit of the criterion.
        """
        if not self.as_factor:
            return value
        return math.inf if value == 0.0 else 1.0 / value


@checks_words
@dataclass(frozen=True)
class Judgement:
    """A criterion with the value it was judged at and the outcome; ``reason`` says why it was not judged.

    ``bound`` is that of the value.
    """

    criterion: Criterion
    value: float
    outcome: Outcome
    reason: str = ""
    bound: Bound = ""
    #: See :attr:`Headline.judged_on`.
    judged_on: str = ""
    #: What would decide a limit that lies between a mean over realisations and the end of its interval.
    remedy: str = ""

    @property
    def shown_bound(self) -> Bound:
        """The bound of the value as people read it: a load of at most so much is a factor of at least so much."""
        if not self.bound or not self.criterion.as_factor:
            return self.bound
        return "at least" if self.bound == "at most" else "at most"

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready mapping."""
        record = asdict(self)
        record["value"] = writable(self.value)
        record["criterion"]["limit"] = writable(self.criterion.limit)
        return record

    @classmethod
    def from_dict(cls, record: Mapping[str, Any]) -> Judgement:
        """Undo :meth:`as_dict`.

        Parameters
        ----------
        record : mapping
            As :meth:`as_dict` gives it.
        """
        given = record["criterion"]
        criterion = Criterion(**{**given, "limit": float(given["limit"])})
        return cls(
            criterion, float(record["value"]), record["outcome"], record.get("reason", ""), record.get("bound", ""),
            record.get("judged_on", ""), record.get("remedy", ""),
        )  # fmt: skip


def of_parts(judged: Iterable[tuple[str, bool, Judgement]]) -> tuple[list[Judgement], list[Judgement]]:
    """Return of one criterion what is to be said, and further lines, anchors or bodies that fail it, the worst first.

    A value of a part that holds says nothing where another one of the same part fails.

    Parameters
    ----------
    judged : iterable of tuple
        The part, or an empty text; whether the judgement is to be said in any case or only where it fails; it.
    """
    items = list(judged)
    failing: dict[str, Judgement] = {}
    for part, _, item in items:
        if part and item.outcome == "does not hold" and (part not in failing or _worse(item, failing[part])):
            failing[part] = item
    kept = [item for part, always, item in items if always and not (item.outcome == "holds" and part in failing)]
    found = _distinct(kept)
    listed = {part for part, _, item in items if any(item is one for one in found)}
    rest = [item for part, item in failing.items() if part not in listed]
    rest.sort(key=lambda item: item.value, reverse=bool(rest) and rest[0].criterion.sense == "at most")
    return found, rest[:MOST_FAILING]


def _worse(item: Judgement, other: Judgement) -> bool:
    return item.value > other.value if item.criterion.sense == "at most" else item.value < other.value


def opened(found: Iterable[Judgement], reason: str) -> list[Judgement]:
    """Return judgements of which none says that a limit is kept, for this reason."""
    return [
        replace(item, outcome="not judged", reason=reason, judged_on=item.judged_on or item.reason)
        if item.outcome == "holds"
        else item
        for item in found
    ]


def _distinct(found: list[Judgement]) -> list[Judgement]:
    """Return of the judgements of one criterion that say the same on the same ground the worst one, the first of twins.

    Values not judged stay unless they agree.
    """
    kept: list[Judgement] = []
    for item in found:
        for place, other in enumerate(kept):
            same = (item.outcome, item.bound, item.judged_on) == (other.outcome, other.bound, other.judged_on)
            unknown = math.isnan(item.value) and math.isnan(other.value) and item.reason == other.reason
            close = unknown or math.isclose(item.value, other.value, rel_tol=1e-3)
            if same and (close or item.outcome != "not judged"):
                if not close and _worse(item, other):
                    kept[place] = item
                break
        else:
            kept.append(item)
    return kept


def holding(criteria: list[Criterion]) -> str:
    """Return the sentence of a design that holds: how many criteria, how many of them assumed, and on what word."""
    kept = {(item.name, item.sea): item for item in criteria}
    count, assumed = len(kept), sum(item.assumed for item in kept.values())
    words = "the criterion holds" if count == 1 else f"all {count} criteria hold"
    if assumed:
        several = "all" if assumed == count else f"{assumed} of them"
        words += ", a default of moyai" if count == 1 else f", {several} defaults of moyai"
    if any(UNCONFIRMED in item.source for item in criteria):
        words += "; factors of a standard that were not confirmed against it"
    return words


def narrow(found: list[Judgement]) -> str:
    """Return which criteria were judged on a part of what is uncertain."""
    kept = dict.fromkeys((item.criterion.words, item.judged_on) for item in found if item.judged_on)
    return "".join(f"; {words} judged on {on}" for words, on in kept)


def said(item: Judgement) -> str:
    """Return a judgement as half a sentence: ``effective depth 1.99 m is below 4 m``."""
    criterion = item.criterion
    if item.outcome == "not judged":
        return f"{criterion.words} is not judged: {item.reason}"
    # A factor of safety is read upside down: it has to stay above its limit
    upward = (criterion.sense == "at most") != criterion.as_factor
    holds = item.outcome == "holds"
    relation = ("at most" if upward else "at least") if holds else ("above" if upward else "below")
    size = max(abs(value) if math.isfinite(value) else 0.0 for value in (item.value, criterion.limit))
    found, limit = (_spoken(criterion, value, size) for value in (item.value, criterion.limit))
    # by a code that weighs the mean another line than the one shown may be the worst
    place = item.reason if criterion.mean_weight != 1.0 else ""
    words = ", ".join(filter(None, (place, item.remedy)))
    return f"{criterion.words} {found} is {relation} {limit}" + (f" ({words})" if words else "")


def open_reason(item: Judgement) -> str:
    """Return why a criterion is not judged, by a code that weighs the mean with the line that leaves it open."""
    weighed = item.criterion.mean_weight != 1.0 and item.judged_on
    return f"{item.reason} ({item.judged_on})" if weighed else item.reason


def _spoken(criterion: Criterion, value: float, size: float) -> str:
    return worded(criterion.shown(value), criterion.unit, size)


def worded(value: float, unit: str, size: float | None = None) -> str:
    """Return a number with its unit; forces in the unit that fits ``size``."""
    if unit == "1":
        return f"{value:.3g}"
    if unit == "%":
        return f"{100.0 * value:.3g} %"
    if unit == "rad":
        return f"{math.degrees(value):.3g} deg"
    if unit.startswith("N"):
        return spoken(value, unit, 3, like=value if size is None else size)
    return f"{value:.3g} {unit}"


def writable(value: float) -> float | str:
    return value if math.isfinite(value) else str(value)
