"""The first page's numbers as key figures: value with its band, the model that governs, the criterion's judgement."""

from __future__ import annotations

import math
from typing import Literal

from moyai.core.headline import Criterion, Headline, Judgement
from moyai.core.results import Result
from moyai.report.document import KeyFigure, KeyFigures
from moyai.report.formatting import DASH, format_quantity

RATIO = "1"


def headline_figures(result: Result) -> KeyFigures | None:
    """Return the headlines of a result as key figures, ``None`` where it has none.

    Parameters
    ----------
    result : Result
    """
    if not result.headlines:
        return None
    judged: dict[str, list[Judgement]] = {}
    for item in result.verdict.judgements:
        judged.setdefault(item.criterion.headline, []).append(item)
    return KeyFigures(tuple(_figure(headline, judged.get(headline.name, [])) for headline in result.headlines))


def headline_text(headline: Headline) -> str:
    """Return the number of a headline with its unit, its bound and its band."""
    if headline.text:
        return headline.text
    if math.isnan(headline.value):
        return DASH
    unit = "" if headline.unit == RATIO else headline.unit
    text = format_quantity(headline.value, unit)
    return f"{headline.bound} {text}" if headline.bound else text


def band_text(headline: Headline) -> str:
    """Return the band of a headline in words, empty where it has none."""
    band = headline.band
    if band is None:
        return ""
    unit = "" if headline.unit == RATIO else headline.unit
    return f"{format_quantity(band.low, unit)} to {format_quantity(band.high, unit)} ({band.of})"


def _figure(headline: Headline, judged: list[Judgement]) -> KeyFigure:
    worst = max(judged, key=lambda item: _severity(item), default=None)
    detail = "; ".join(part for part in (band_text(headline), headline.detail, headline.where, headline.model) if part)
    if worst is None:
        return KeyFigure(headline.label, headline_text(headline), detail)
    judgement: Literal["", "good", "caution", "bad"] = {
        "holds": "good",
        "does not hold": "bad",
        "not judged": "caution",
    }[worst.outcome]  # type: ignore[assignment]
    share = _share(worst.criterion, worst.value)
    detail = "; ".join(part for part in (detail, _limit_text(worst.criterion)) if part)
    return KeyFigure(headline.label, headline_text(headline), detail, share, judgement)


def _severity(item: Judgement) -> int:
    return ("holds", "not judged", "does not hold").index(item.outcome)


def _share(criterion: Criterion, value: float) -> float:
    """Return how much of a limit from above is used, NaN for limits from below."""
    if criterion.sense == "at least" or criterion.limit <= 0.0 or not math.isfinite(value):
        return math.nan
    return value / criterion.limit


def _limit_text(criterion: Criterion) -> str:
    unit = "" if criterion.unit == RATIO else criterion.unit
    return f"limit {criterion.sense} {format_quantity(criterion.limit, unit)} ({criterion.source})"
