"""The numbers of the first page: value, band, model and place, kept with the result and judged against its criteria.

A structure decides once, in its own package, which model governs each number; the report, the command line and the
verdict all show that one number.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from typing import Any, Literal

Bound = Literal["", "at most", "at least"]
Sense = Literal["at most", "at least"]
Outcome = Literal["holds", "does not hold", "not judged"]


@dataclass(frozen=True)
class Band:
    """How far a headline moves over what is uncertain or varies by chance.

    Parameters
    ----------
    low, high : float
        Smallest and largest value, in the unit of the headline.
    of : str
        What is varied and how far, for instance ``viscous damping halved and doubled`` or ``5 seeds``.
    decides : bool
        Whether a criterion is judged at the unfavourable end (an uncertain coefficient) or at the value itself
        (the scatter of seeds about their mean).
    """

    low: float
    high: float
    of: str
    decides: bool = True


@dataclass(frozen=True)
class Headline:
    """One number of the first page.

    Parameters
    ----------
    name : str
        Stable name, for instance ``line_tension``; criteria and comparisons use it.
    label : str
        Words for the reader.
    value : float
        In SI units and radians; NaN where only ``text`` says it.
    unit : str
        Unit of the value; ``1`` for ratios.
    where : str
        Water level, sea state, period, line.
    model : str
        The model that governs, by the name that the page "How the answer is made" gives it.
    band : Band or None
        What the number varies with.
    bound : {"", "at most", "at least"}
        Set where only a bound is known.
    detail : str
        One more fact that the reader needs, for instance the breaking load.
    text : str
        Shown in place of the number, for instance ``none``.
    """

    name: str
    label: str
    value: float
    unit: str
    where: str = ""
    model: str = ""
    band: Band | None = None
    bound: Bound = ""
    detail: str = ""
    text: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready mapping (numbers that are not finite become text)."""
        record = asdict(self)
        record["value"] = _writable(self.value)
        if self.band is not None:
            record["band"] |= {"low": _writable(self.band.low), "high": _writable(self.band.high)}
        return record

    @classmethod
    def from_dict(cls, record: Mapping[str, Any]) -> Headline:
        """Undo :meth:`as_dict`."""
        band = record.get("band")
        if band is not None:
            band = Band(**{**band, "low": float(band["low"]), "high": float(band["high"])})
        return cls(**{**record, "value": float(record["value"]), "band": band})


@dataclass(frozen=True)
class Criterion:
    """What a headline has to keep.

    Parameters
    ----------
    name : str
        Key of the criterion in the case file.
    headline : str
        Name of the headline that is judged.
    limit : float
        In the unit of the headline.
    sense : {"at most", "at least"}
    source : str
        Who set the limit: the case file, a code with its table, or the default of the structure.
    label : str
        Words for the reader; the headline's own label where empty.
    unit : str
        Unit of the limit, shown where the headline is absent.
    """

    name: str
    headline: str
    limit: float
    sense: Sense
    source: str
    label: str = ""
    unit: str = "1"


@dataclass(frozen=True)
class Judgement:
    """A criterion with the value it was judged at and the outcome; ``reason`` says why it was not judged."""

    criterion: Criterion
    value: float
    outcome: Outcome
    reason: str = ""

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready mapping."""
        record = asdict(self)
        record["value"] = _writable(self.value)
        record["criterion"]["limit"] = _writable(self.criterion.limit)
        return record

    @classmethod
    def from_dict(cls, record: Mapping[str, Any]) -> Judgement:
        """Undo :meth:`as_dict`."""
        given = record["criterion"]
        criterion = Criterion(**{**given, "limit": float(given["limit"])})
        return cls(criterion, float(record["value"]), record["outcome"], record.get("reason", ""))


@dataclass(frozen=True)
class Verdict:
    """Whether the design holds: every criterion judged, and the whole.

    Parameters
    ----------
    outcome : {"holds", "does not hold", "not judged"}
        ``does not hold`` when one criterion fails; ``holds`` when all judged ones hold and at least one was judged
        and none had to be left out; ``not judged`` otherwise.
    message : str
        One sentence: what fails, or what could not be judged.
    judgements : tuple of Judgement
    """

    outcome: Outcome = "not judged"
    message: str = ""
    judgements: tuple[Judgement, ...] = ()

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready mapping."""
        return {
            "outcome": self.outcome,
            "message": self.message,
            "judgements": [judgement.as_dict() for judgement in self.judgements],
        }

    @classmethod
    def from_dict(cls, record: Mapping[str, Any]) -> Verdict:
        """Undo :meth:`as_dict`."""
        judgements = tuple(Judgement.from_dict(item) for item in record.get("judgements", ()))
        return cls(record.get("outcome", "not judged"), record.get("message", ""), judgements)


def judge(headlines: Iterable[Headline], criteria: Iterable[Criterion], *, computed: bool) -> Verdict:
    """Judge headlines against criteria.

    Parameters
    ----------
    headlines : iterable of Headline
    criteria : iterable of Criterion
        A criterion is judged on every headline of its name, at the unfavourable end of a band that decides. An upper
        bound that meets a limit from above holds; one that passes it says nothing.
    computed : bool
        Whether the computation can be judged at all (it converged inside its range); nothing holds otherwise.
    """
    by_name: dict[str, list[Headline]] = {}
    for headline in headlines:
        by_name.setdefault(headline.name, []).append(headline)
    found: list[Judgement] = []
    for criterion in criteria:
        members = by_name.get(criterion.headline, [])
        if not members:
            found.append(Judgement(criterion, math.nan, "not judged", "nothing that was run gives this number"))
        found.extend(_judge_one(criterion, member) for member in members)
    failing = [item for item in found if item.outcome == "does not hold"]
    open_ones = [item for item in found if item.outcome == "not judged"]
    if failing:
        return Verdict("does not hold", "; ".join(_said(item) for item in failing), tuple(found))
    if not found:
        return Verdict("not judged", "no criterion is given", ())
    if not computed:
        return Verdict("not judged", "the computation did not converge inside its range", tuple(found))
    if open_ones:
        names = ", ".join(f"{item.criterion.name} ({item.reason})" for item in open_ones)
        return Verdict("not judged", f"not judged: {names}", tuple(found))
    count = len(found)
    return Verdict("holds", "the criterion holds" if count == 1 else f"all {count} criteria hold", tuple(found))


def _judge_one(criterion: Criterion, headline: Headline) -> Judgement:
    value = headline.value
    if math.isnan(value):
        return Judgement(criterion, value, "not judged", f"{headline.label.lower()} is not known")
    upward = criterion.sense == "at most"
    if headline.band is not None and headline.band.decides:
        ends = (value, headline.band.low, headline.band.high)
        value = max(ends) if upward else min(ends)
    good = value <= criterion.limit if upward else value >= criterion.limit
    # A bound on the safe side proves that a limit is kept, never that it is broken
    if headline.bound and not good and headline.bound == criterion.sense:
        return Judgement(criterion, value, "not judged", f"only a bound is known ({headline.bound} this value)")
    if headline.bound and good and headline.bound != criterion.sense:
        return Judgement(criterion, value, "not judged", f"only a bound is known ({headline.bound} this value)")
    return Judgement(criterion, value, "holds" if good else "does not hold", headline.where)


def _said(item: Judgement) -> str:
    relation = "above" if item.criterion.sense == "at most" else "below"
    name = item.criterion.name.replace("_", " ")
    unit = "" if item.criterion.unit == "1" else f" {item.criterion.unit}"
    return f"{name}: {item.value:.3g}{unit} is {relation} {item.criterion.limit:.3g}{unit}"


def _writable(value: float) -> float | str:
    return value if math.isfinite(value) else str(value)
