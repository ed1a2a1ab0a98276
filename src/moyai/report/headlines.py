"""The first page's numbers as key figures: value with its band, the model that governs, the criterion's judgement."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Literal

from moyai.core.headline import Criterion, Headline, Judgement, unfavourable
from moyai.core.judgements import NOT_COMPUTED
from moyai.core.results import Result
from moyai.report.document import KeyFigure, KeyFigures
from moyai.report.first_page import largest_by_unit, limit_and_found
from moyai.report.formatting import DASH, display_unit, format_number
from moyai.report.systems import words_in_system

RATIO, _DIGITS = "1", 3


def headline_figures(result: Result) -> KeyFigures | None:
    """Return the headlines of a result as key figures, ``None`` where it has none.

    Parameters
    ----------
    result : Result
    """
    if not result.headlines:
        return None
    shown = [headline for headline in result.headlines if headline.shown]
    scale = largest_by_unit(result)
    return KeyFigures(tuple(_figure(headline, _judged(result, headline), scale) for headline in shown))


def _judged(result: Result, headline: Headline) -> list[Judgement]:
    """Return the judgements of one headline: of its name and sea, and where several on the page share it of its place.

    What is not shown and judged worse, another line with a wider band or a named sea, stands with the only one that is.
    """
    alone = sum(other.name == headline.name and other.shown for other in result.headlines) == 1
    found = [
        item
        for item in result.verdict.judgements
        if item.criterion.headline == headline.name
        and (item.criterion.sea in ("", headline.sea) or (alone and not headline.sea))
    ]
    return [item for item in found if alone or item.reason == headline.where or item.outcome == "not judged"]


def headline_text(headline: Headline, like: float = 0.0) -> str:
    """Return the number of a headline with its unit and its bound.

    Parameters
    ----------
    headline : Headline
    like : float
        Magnitude that chooses between N, kN and MN together with the value, so that a page has one unit of forces.
    """
    if headline.text:
        return headline.text
    if math.isnan(headline.value):
        return DASH
    text = _quantity(headline.value, headline.unit, like, headline.digits)
    return f"{headline.bound} {text}" if headline.bound else text


def band_text(headline: Headline, like: float = 0.0, *, with_judged: bool = True) -> str:
    """Return the band of a headline in words, empty where it has none; in the unit of its number.

    It reaches to what is judged, and names that where it is not the end of the band itself.

    Parameters
    ----------
    headline : Headline
    like : float
        See :func:`headline_text`.
    with_judged : bool
        Whether the value that is judged is named; not where a limit next to it does.
    """
    band = headline.band
    if band is None:
        return ""
    like = max(like, abs(headline.value)) if math.isfinite(headline.value) else like

    def said(value: float) -> str:
        return _quantity(value, headline.unit, like, headline.digits)

    end = _judged_end(headline)
    low, own, high, judged = map(said, (band.low, headline.value, max(band.high, end), end))
    if low == own == high:
        return f"the same to {headline.digits} digits ({band.of})"
    if band.decides or not with_judged or judged == own:
        return f"{low} to {high} ({band.of})"
    return f"{low} to {high}, judged {judged} ({band.of})"


def _judged_end(headline: Headline) -> float:
    """Return the value that a limit from above is compared with, or something bought for; that shown where unknown."""
    band = headline.band
    # what a growth that continues comes to is said with its words
    if band is None or band.decides or band.judged is None or band.beyond_bound or math.isnan(headline.value):
        return headline.value
    return unfavourable(headline)


def _quantity(value: float, unit: str, like: float, digits: int) -> str:
    shown = display_unit("" if unit == RATIO else unit, [value, like])
    number = value * shown.factor
    if math.isfinite(number) and digits < _DIGITS:
        # else digits before the point are kept
        number = float(f"{number:.{digits - 1}e}")
    text = format_number(number, digits)
    if text == DASH or not shown.name:
        return text
    return f"{text}{shown.pretty}" if shown.name == "deg" else f"{text} {shown.pretty}"


def _figure(headline: Headline, judged: list[Judgement], scale: Mapping[str, float]) -> KeyFigure:
    like = scale.get(headline.unit, 0.0)
    worst = max(judged, key=lambda item: (_severity(item), _use(item)), default=None)
    remark = words_in_system(headline.detail)
    # a limit that is not one of a factor says itself where it is judged
    alone = worst is None or worst.criterion.as_factor or worst.value != _judged_end(headline)
    band = band_text(headline, like, with_judged=alone)
    detail = "; ".join(part for part in (band, remark, headline.where, headline.model) if part)
    if worst is None:
        return KeyFigure(headline.label, headline_text(headline, like), detail)
    judgement: Literal["", "good", "caution", "bad"] = {
        "holds": "good",
        "does not hold": "bad",
        "not judged": "caution",
    }[worst.outcome]  # type: ignore[assignment]
    share = _share(worst.criterion, worst.value)
    known = max((item for item in judged if item.outcome == "holds"), key=_nearness, default=None)
    words = [_asked(headline, worst, like), _known(headline, worst, known, like) if judgement == "caution" else ""]
    words.append(f"not judged: {NOT_COMPUTED}" if worst.reason == NOT_COMPUTED else "")
    detail = "; ".join(part for part in (detail, *words) if part)
    return KeyFigure(headline.label, headline_text(headline, like), detail, share, judgement)


def _asked(headline: Headline, item: Judgement, like: float) -> str:
    """Return limit and judged value, with the value shown next to it where that is another one; why it is not known."""
    limit, found = limit_and_found(item, like)
    if item.criterion.sea not in ("", headline.sea):
        limit = f"{limit} in {item.criterion.sea}"
    if math.isnan(item.value):
        # the verdict says what to do about it
        reason = "" if item.reason == headline.text else f": {item.reason.partition('; ')[0]}"
        return f"asked {limit}; not judged{reason}"
    _, own = limit_and_found(replace(item, value=headline.value), like)
    plain = own == found or not math.isfinite(headline.value) or item.criterion.mean_weight != 1.0
    place = f" ({item.reason})" if item.outcome != "not judged" and item.reason not in ("", headline.where) else ""
    if item.outcome == "not judged" and item.judged_on not in ("", headline.where, headline.judged_on):
        # of another line, of which only a bound is known
        what = "factor of safety " if item.criterion.as_factor else ""
        return f"asked {limit}; not judged at {item.judged_on}: {what}{found}"
    if item.criterion.as_factor:
        if item.value == 0.0:
            return f"factor of safety not known, asked {limit}" if item.bound else f"no load, factor asked {limit}"
        here = (
            f" where it is judged{place}" * bool(place)
            if plain
            else (f" where it is judged{place}, {own} at the value shown")
        )
        return f"factor of safety {found}{here}, asked {limit}"
    if plain:
        return f"limit {limit}"
    end = found.removeprefix(f"{item.bound} ")
    return f"limit {limit}, judged at {end}{place}" if item.outcome != "not judged" else f"limit {limit}, against {end}"


def _known(headline: Headline, open_one: Judgement, item: Judgement | None, like: float) -> str:
    """Return the worst value that is known, with its place, next to one that leaves the limit open."""
    if item is None or not item.value:
        return ""
    limit, found = limit_and_found(item, like)
    what = "factor of safety " if item.criterion.as_factor else ""
    place = f" at {item.reason}" if item.reason not in ("", headline.where) else ""
    # a code asks another factor of each analysis
    asked = f", asked {limit}" if item.criterion != open_one.criterion else ""
    return f"worst known: {what}{found}{place}{asked}"


def _nearness(item: Judgement) -> float:
    """Return how near a value comes to its limit, of criteria of one sense."""
    share = _share(item.criterion, item.value)
    return _use(item) if math.isnan(share) else share


def _severity(item: Judgement) -> int:
    return ("holds", "not judged", "does not hold").index(item.outcome)


def _use(item: Judgement) -> float:
    """Return how far a value goes towards its limit or beyond, from either side; what is not known goes farthest."""
    if not math.isfinite(item.value):
        return math.inf
    return item.value if item.criterion.sense == "at most" else -item.value


def _share(criterion: Criterion, value: float) -> float:
    """Return how much of a limit from above is used, NaN for limits from below."""
    if criterion.sense == "at least" or criterion.limit <= 0.0 or not math.isfinite(value):
        return math.nan
    return value / criterion.limit
