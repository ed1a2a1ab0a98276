"""The numbers of the first page: value, band, model and place, kept with the result and judged against its criteria.

A structure decides once, in its own package, which model governs each number; the report, the command line and the
verdict all show that one number.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any, Literal

from moyai.core.judgements import (
    NOT_COMPUTED,
    holding,
    narrow,
    of_parts,
    open_reason,
    opened,
    said,
    worded,
    writable,
)
from moyai.core.judgements import UNCONFIRMED as UNCONFIRMED
from moyai.core.judgements import Bound as Bound
from moyai.core.judgements import Criterion as Criterion
from moyai.core.judgements import Judgement as Judgement
from moyai.core.judgements import Outcome as Outcome
from moyai.core.judgements import Sense as Sense
from moyai.core.options import checks_words

Role = Literal["", "weighed", "failing"]
SEAS_LEFT_OUT = "the seas of the case were not run"
"""What a run says that has seas and no analysis that runs them."""
MOST_REALISATIONS = 100
"""Realisations up to which more of them are proposed."""
NONE = "none"
"""Text of a headline whose number is zero."""


@checks_words
@dataclass(frozen=True)
class Band:
    """How far a headline moves over what is uncertain or varies by chance."""

    #: Smallest value, in the unit of the headline.
    low: float
    #: Largest value, in the unit of the headline.
    high: float
    #: What is varied and how far, for instance ``viscous damping halved and doubled`` or ``5 seeds``.
    of: str
    #: Whether a criterion is judged at the unfavourable end (an uncertain coefficient) or at the value itself (the
    #: scatter of seeds about their mean).
    decides: bool = True
    #: Interval at whose unfavourable end a criterion is judged where the band itself does not decide, for instance the
    #: confidence interval of a mean over few seeds; ``None``: at the value itself.
    judged: tuple[float, float] | None = None
    #: Realisations that the interval is of, and the key of the case for more of them.
    realisations: int = 0
    more: str = ""
    #: What the judged end comes to with very many realisations, the upper ends of coefficients in it.
    settled: float | None = None
    #: Whether the judged end lies beyond what a bound "at least" leaves open, as the growth that was seen continues.
    beyond_bound: bool = False

    def scaled(self, less: float, more: float | None = None) -> Band:
        """Return the band with its lower ends times ``less`` and its upper ends times ``more``, the same by default.

        Parameters
        ----------
        less : float
            0 or more [-].
        more : float, optional
            0 or more [-].
        """
        more = less if more is None else more
        judged = None if self.judged is None else (less * self.judged[0], more * self.judged[1])
        settled = None if self.settled is None else more * self.settled
        return replace(self, low=less * self.low, high=more * self.high, judged=judged, settled=settled)


@checks_words
@dataclass(frozen=True)
class Headline:
    """One number of the first page.

    Notes
    -----
    A headline called ``..._utilisation`` is the load over the strength, without any factor of safety: the factor is the
    criterion's.
    """

    #: Stable name, for instance ``line_tension``; criteria and comparisons use it.
    name: str
    #: Words for the reader; the first letter becomes a capital.
    label: str
    #: In SI units and radians; NaN where only ``text`` says it.
    value: float
    #: Unit of the value; ``1`` for ratios.
    unit: str
    #: Water level, sea state, period, line.
    where: str = ""
    #: The model that governs, by the name that the page "How the answer is made" gives it.
    model: str = ""
    #: What the number varies with.
    band: Band | None = None
    #: Set where only a bound is known; one of "", "at most", "at least".
    bound: Bound = ""
    #: One more fact that the reader needs, for instance the breaking load.
    detail: str = ""
    #: Shown in place of the number; ``none`` stands for zero.
    text: str = ""
    #: Name of the sea state that it holds in; criteria at a named sea are judged on it.
    sea: str = ""
    #: Mean over time of a value that is a maximum over time, in its unit; codes that weigh the mean and the varying
    #: part of a tension apart need it. None where it is not known.
    mean: float | None = None
    #: Whether it stands on the first page; one that does not and has a sea is judged only by a criterion at that sea.
    shown: bool = True
    #: ``dynamic``, ``quasi_static`` or ``static`` where criteria depend on the analysis that gave the number.
    analysis: str = ""
    #: Whether it is what the other numbers were found in (a current, the height of a sea, the start of a run) and not
    #: an answer: no limit is looked for.
    condition: bool = False
    #: What alone a criterion is judged on where more is uncertain, for instance ``the band of damping alone``.
    judged_on: str = ""
    #: Whether waves are no part of it, as stability at rest: it is judged where no sea was run.
    without_waves: bool = False
    #: Significant digits that it and its band are known to: two where chance or rounding decides the third.
    digits: int = 3
    #: Line, anchor or body that it is of: where it fails a criterion, none of its other values is said to hold.
    part: str = ""
    #: What judges it: every criterion where empty; "weighed": codes alone that weigh the mean and the varying part
    #: apart; "failing": every criterion, and a failure alone is listed; one of "", "weighed", "failing".
    role: Role = ""
    #: Why only a bound is known, where that is to be said with the criterion.
    bound_by: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "label", self.label[:1].upper() + self.label[1:])

    def as_dict(self) -> dict[str, Any]:
        """Return a JSON-ready mapping (numbers that are not finite become text)."""
        record = {**vars(self), "value": writable(self.value)}
        if self.band is not None:
            record["band"] = {**vars(self.band), "low": writable(self.band.low), "high": writable(self.band.high)}
        return record

    @classmethod
    def from_dict(cls, record: Mapping[str, Any]) -> Headline:
        """Undo :meth:`as_dict`.

        Parameters
        ----------
        record : mapping
            As :meth:`as_dict` gives it.
        """
        band = record.get("band")
        if band is not None:
            judged = band.get("judged")
            ends = {"low": float(band["low"]), "high": float(band["high"])}
            judged = None if judged is None else (float(judged[0]), float(judged[1]))
            band = Band(**{**band, **ends, "judged": judged})
        return cls(**{**record, "value": float(record["value"]), "band": band})


@checks_words
def unfavourable(headline: Headline, sense: Sense = "at most") -> float:
    """Return the end at which a limit is judged: of the band, of the interval of a mean, or the value itself."""
    band, value = headline.band, headline.value
    if band is None:
        return value
    given = (band.low, band.high) if band.decides else (band.judged or ())
    ends = [end for end in (value, *given) if not math.isnan(end)]
    return (max if sense == "at most" else min)(ends, default=value)


@checks_words
def governing(candidates: Iterable[Headline], sense: Sense = "at most") -> list[Headline]:
    """Return the worst of one number over seas, levels and places, and, not shown, the one whose judged end is worst.

    Another value with a wider band may pass a limit that the worst value keeps: both are judged.

    Parameters
    ----------
    candidates : iterable of Headline
    sense : {"at most", "at least"}
        Of the limits that it is compared with: the largest counts, or the least.
    """
    items = list(candidates)
    if not items:
        return []
    sign = 1.0 if sense == "at most" else -1.0
    # of equal values the one with the worst end, in whatever order they come
    shown = max(items, key=lambda item: (sign * item.value, sign * unfavourable(item, sense)))
    widest = max(items, key=lambda item: sign * unfavourable(item, sense))
    end, own = unfavourable(widest, sense), unfavourable(shown, sense)
    found = [shown]
    if sign * end > sign * own:
        if widest.where != shown.where and abs(end - own) > 1e-3 * abs(own):
            # the band of the number shown is not the one that is judged
            words = f"{'up' if sense == 'at most' else 'down'} to {worded(end, shown.unit)} at {widest.where}"
            found = [replace(shown, detail="; ".join(filter(None, (shown.detail, words))))]
        found.append(replace(widest, shown=False, sea=""))
    return found + (_varying_more(items, found) if sense == "at most" else [])


def _varying_more(items: list[Headline], kept: list[Headline]) -> list[Headline]:
    """Return, not shown, the smaller values with a smaller mean: codes may weigh their varying part more."""
    found, least = [], math.inf
    for item in sorted(items, key=unfavourable, reverse=True):
        if item.mean is None or not item.mean < least:
            continue
        least = item.mean
        if all((one.where, one.value) != (item.where, item.value) for one in kept):
            found.append(replace(item, shown=False, sea="", role="weighed"))
    return found


@checks_words
def all_judged(candidates: Iterable[Headline], sense: Sense = "at most") -> list[Headline]:
    """Return what governs of one number and, not shown, what governs of those known as a bound alone.

    A number that may be worse than shown is no less open because another one is worse. See :func:`governing`.
    """
    items = list(candidates)
    # of equal numbers the one that is open stands first
    kept = governing(sorted(items, key=lambda item: not item.bound), sense)
    for bound in sorted({item.bound for item in items} - {""}):
        alike = governing((item for item in items if item.bound == bound), sense)
        known = {one.where for one in kept if one.bound == bound and one.role != "weighed"}
        more = [replace(item, shown=False, sea="") for item in alike if item.where not in known]
        # a bound that every criterion judges stands once
        places = {item.where for item in more if item.role != "weighed"}
        kept = [one for one in kept if not (one.role == "weighed" and one.where in places)] + more
    return kept


def saying_what_is_open(items: Iterable[Headline]) -> list[Headline]:
    """Return numbers with the first, which is shown, naming the largest of those behind it that is but a lower bound.

    What is compared with no criterion has no other mark of it.
    """
    found = list(items)
    behind = [item for item in found[1:] if item.bound == "at least" and item.name == found[0].name]
    if not behind or found[0].bound:
        return found
    worst = max(behind, key=lambda item: item.value)
    words = f"more is possible at {worst.where}: at least {worded(worst.value, worst.unit)} there"
    return [replace(found[0], detail="; ".join(filter(None, (found[0].detail, words)))), *found[1:]]


@checks_words
def also_judged(shown: Headline, others: Iterable[Headline], sense: Sense = "at most") -> list[Headline]:
    """Return, not shown, what has to be judged with the one of a number that is shown.

    Of each kind the worst: what may be worse than it says without an end, with one, bounds from the safe side, values.
    The first is open however far behind; the others count where their judged end is worse than that shown, or where
    that is no value. What is not known is kept as it is.
    """
    sign = 1.0 if sense == "at most" else -1.0

    def kind(item: Headline) -> tuple[str, bool]:
        return item.bound, item.band is not None and item.band.beyond_bound

    def ends(item: Headline) -> tuple[float, float]:
        return sign * unfavourable(item, sense), sign * item.value

    items, known = list(others), math.isfinite(shown.value)
    kinds: dict[tuple[str, bool], list[Headline]] = {}
    for item in items:
        if math.isfinite(item.value):
            kinds.setdefault(kind(item), []).append(item)
    unknown = {item.text: item for item in items if not math.isfinite(item.value)}
    kept = [replace(item, shown=False) for item in unknown.values()] if known else []
    for own, alike in kinds.items():
        worst = max(alike, key=ends)
        # a value counts by its end alone, a bound from the open side may break a limit by its value too
        parts = ends(worst)[: 2 if own[0] not in ("", sense) else 1]
        worse = any(end > limit for end, limit in zip(parts, ends(shown), strict=False)) or not known
        open_end = own[0] not in ("", sense) and not own[1]
        # a bound says nothing of a value, nor a value of what is open; of one kind the worst is enough
        if worse or (own != kind(shown) and (open_end or shown.bound)):
            kept.append(replace(worst, shown=False, sea=""))
    return kept


@checks_words
@dataclass(frozen=True)
class Verdict:
    """Whether the design holds: every criterion judged, and the whole."""

    #: ``does not hold`` when one criterion fails; ``holds`` when all judged ones hold and at least one was judged and
    #: none had to be left out; ``not judged`` otherwise; one of "holds", "does not hold", "not judged".
    outcome: Outcome = "not judged"
    #: One sentence: what fails, or what could not be judged.
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
        """Undo :meth:`as_dict`.

        Parameters
        ----------
        record : mapping
            As :meth:`as_dict` gives it.
        """
        judgements = tuple(Judgement.from_dict(item) for item in record.get("judgements", ()))
        return cls(record.get("outcome", "not judged"), record.get("message", ""), judgements)


def judge(
    headlines: Iterable[Headline], criteria: Iterable[Criterion], *, computed: bool, left_out: str = ""
) -> Verdict:
    """Judge headlines against criteria.

    Parameters
    ----------
    headlines : iterable of Headline
    criteria : iterable of Criterion
        A criterion is judged on every headline of its name, or on those of its sea, at the unfavourable end of a band
        that decides. A bound proves that a limit is kept where it lies on the safe side, and that it is broken where it
        lies on the other; else it says nothing.
    computed : bool
        Whether the computation can be judged at all (it converged inside its range); nothing holds otherwise.
    left_out : str
        What the case names and was not run, for instance ``the seas of the case were not run``: numbers that it would
        change prove only that a limit is broken.
    """
    numbers = tuple(headlines)
    found: list[Judgement] = []
    further: list[Judgement] = []
    for criterion in criteria:
        members = _judged_by(criterion, numbers)
        if criterion.analysis:
            given = [member for member in members if member.analysis in ("", criterion.analysis)]
            if members and not given:
                continue  # every number is of another analysis, which has its own criterion
            members = given
        if not members:
            found.append(Judgement(criterion, math.nan, "not judged", _absent(criterion)))
        worst, others = of_parts(
            (member.part, member.role != "failing", _judge_part(criterion, member, left_out)) for member in members
        )
        found.extend(worst)
        further.extend(others)
    failing = [item for item in found if item.outcome == "does not hold"]
    judgements = tuple([*found, *further] if computed else opened([*found, *further], NOT_COMPUTED))
    if failing:
        doubt = "" if computed else f"; {NOT_COMPUTED}"
        return Verdict("does not hold", "; ".join(map(said, failing)) + doubt, judgements)
    if not found:
        return Verdict("not judged", "no criterion is given", ())
    if not computed:
        return Verdict("not judged", NOT_COMPUTED, judgements)
    open_ones = [item for item in found if item.outcome == "not judged"]
    if open_ones:
        reasons: dict[str, list[str]] = {}
        for item in open_ones:
            reasons.setdefault(open_reason(item), []).append(item.criterion.words)
        message = "; ".join(f"{', '.join(dict.fromkeys(names))}: {reason}" for reason, names in reasons.items())
        return Verdict("not judged", message, judgements)
    return Verdict("holds", holding([item.criterion for item in found]) + narrow(found), judgements)


def left_open(verdict: Verdict, reason: str) -> Verdict:
    """Return a verdict after something turned out to be left out: what held is not judged, for this reason."""
    rows = tuple(opened(verdict.judgements, reason))
    return Verdict("not judged", reason, rows) if verdict.outcome == "holds" else replace(verdict, judgements=rows)


def without_computation(verdict: Verdict) -> Verdict:
    """Return a verdict after the computation turned out to lie outside its range: what held is not judged."""
    return left_open(verdict, NOT_COMPUTED)


def _judged_by(criterion: Criterion, numbers: tuple[Headline, ...]) -> list[Headline]:
    weighs = criterion.mean_weight != 1.0
    named = [item for item in numbers if item.name == criterion.headline and (weighs or item.role != "weighed")]
    if not criterion.sea:
        return [headline for headline in named if headline.shown or not headline.sea]
    return [headline for headline in named if headline.sea == criterion.sea]


def _absent(criterion: Criterion) -> str:
    where = f" in {criterion.sea}" if criterion.sea else ""
    return f"nothing that was run gives this number{where}"


def _judge_part(criterion: Criterion, headline: Headline, left_out: str) -> Judgement:
    """Judge a number of which a part may be left out: it can but come nearer to its limit."""
    if not left_out or headline.without_waves:
        return _judge_one(criterion, headline)
    if headline.bound == criterion.sense:
        # what it bounds is but what was run
        return Judgement(criterion, headline.value, "not judged", left_out, headline.bound)
    # the end to which a growth continues is that of what was run too
    band = None if headline.band is not None and headline.band.beyond_bound else headline.band
    open_one: Bound = "at least" if criterion.sense == "at most" else "at most"
    found = _judge_one(criterion, replace(headline, bound=open_one, band=band))
    return replace(found, reason=left_out) if found.outcome == "not judged" else found


def _judge_one(criterion: Criterion, headline: Headline) -> Judgement:
    value = 0.0 if math.isnan(headline.value) and headline.text == NONE else headline.value
    if math.isnan(value):
        return Judgement(
            criterion,
            value,
            "not judged",
            headline.text or f"{headline.label[:1].lower()}{headline.label[1:]} is not known",
        )
    upward = criterion.sense == "at most"
    if headline.band is not None:
        value = unfavourable(replace(headline, value=value), criterion.sense)
    if criterion.mean_weight != 1.0:
        return _judge_parts(criterion, headline, value)
    good = value <= criterion.limit if upward else value >= criterion.limit
    # The true value lies below a bound "at most" and above a bound "at least"
    if headline.band is not None and headline.band.beyond_bound and headline.bound != criterion.sense:
        if good:
            return Judgement(criterion, value, "holds", headline.where, "", headline.judged_on)
        # beyond the limit that end proves nothing, the bound itself may
        found = _judge_one(criterion, replace(headline, band=None))
        more = headline.band.more if found.outcome == "not judged" else ""
        return replace(found, remedy=f"{more}: more may prove it") if more else found
    proves = not headline.bound or (headline.bound == criterion.sense) == good
    if not proves:
        found = Judgement(criterion, value, "not judged", "", headline.bound)
        reason = f"only a bound is known ({found.shown_bound} this value)"
        reason = "; ".join(filter(None, (reason, headline.bound_by)))
        return replace(found, reason=reason, judged_on=headline.judged_on or headline.where)
    outcome: Outcome = "holds" if good else "does not hold"
    remedy = "" if good else _more_realisations(criterion, headline, value)
    return Judgement(criterion, value, outcome, headline.where, headline.bound, headline.judged_on, remedy)


def _more_realisations(criterion: Criterion, headline: Headline, judged: float) -> str:
    """Return how many realisations would decide where the mean keeps a limit that the end of its interval does not.

    The interval narrows with the square root of their number; the mean itself may move.
    """
    band, sign = headline.band, 1.0 if criterion.sense == "at most" else -1.0
    if band is None or band.decides or not band.realisations:
        return ""
    settled = headline.value if band.settled is None else band.settled
    room = sign * (criterion.limit - settled)
    if not room > 0.0:
        return ""
    wanted = math.ceil(band.realisations * (sign * (judged - settled) / room) ** 2)
    if wanted > MOST_REALISATIONS:
        return f"the mean of {band.realisations} realisations keeps it, by too little to be proven"
    return f"the mean of {band.realisations} realisations keeps it: {band.more}: {wanted} may prove it"


def _judge_parts(criterion: Criterion, headline: Headline, value: float) -> Judgement:
    """Judge by a code that weighs the mean and the varying part apart; without the mean where either end agrees."""
    weight, limit = criterion.mean_weight, criterion.limit
    means = (0.0, value) if headline.mean is None else (headline.mean,)
    weighed = [value + (weight - 1.0) * mean for mean in means]
    where = headline.where
    if headline.bound == "at least" and min(weight, 1.0) * value > limit:
        # whatever the mean, and more than this makes it worse
        return Judgement(criterion, max(weighed), "does not hold", where)
    if headline.bound == "at least" or (min(weighed) <= limit < max(weighed)):
        known = "only a bound is known" if headline.bound else "the mean tension is not known"
        return Judgement(criterion, max(weighed), "not judged", known, judged_on=where)
    if headline.bound == "at most" and max(weighed) > limit:
        known = "only a bound is known (at most this value)"
        return Judgement(criterion, max(weighed), "not judged", known, judged_on=where)
    return Judgement(criterion, max(weighed), "holds" if max(weighed) <= limit else "does not hold", where)
