"""Notices as the reader of the first page needs them: each kind once, counted, the most severe first."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass

from moyai.core.results import Result
from moyai.core.validity import Notice, Severity

_RANK: dict[Severity, int] = {"error": 0, "warning": 1, "information": 2}
_PLACE = re.compile(r"([^:.]{1,60}): (?=\S)")
_MOST_PLACES = 6
_FROM_CASE = "case"
#: Notices whose number stands on the first page as the headline of this name.
_REPEATED = {
    "line-breaks": "line_utilisation",
    "freeboard": "freeboard",
    "unstable": "metacentric_height",
    "curtain-strength": "cable_utilisation",
    "curtain-anchor": "anchor_utilisation",
}


@dataclass(frozen=True)
class NoticeGroup:
    """All notices of one kind."""

    #: The most severe of them.
    notice: Notice
    count: int = 1
    #: Water level, sea, line of each, as their messages begin; empty where they do not say it.
    places: tuple[str, ...] = ()

    @property
    def severity(self) -> Severity:
        """Severity of the most severe one."""
        return self.notice.severity

    @property
    def where(self) -> str:
        """The places in words, empty for a notice that stands alone."""
        if self.count == 1:
            return ""
        named = "; ".join(self.places[:_MOST_PLACES])
        more = len(self.places) - _MOST_PLACES
        if more > 0:
            named += f"; {more} more"
        return f"{self.count} times" + (f": {named}" if named else "") + "; the most severe is shown"


def grouped(notices: Iterable[Notice]) -> tuple[NoticeGroup, ...]:
    """Return notices by kind, the most severe kind first and otherwise in their order.

    Parameters
    ----------
    notices : iterable of Notice
        Of one kind are those with the same code; warnings of the case file are of one kind when they are for the same
        key.
    """
    kinds: dict[tuple[str, str], list[Notice]] = {}
    for notice in notices:
        kinds.setdefault((notice.code, notice.source if notice.code == _FROM_CASE else ""), []).append(notice)
    groups = [_group(members) for members in kinds.values()]
    return tuple(sorted(groups, key=lambda group: _RANK.get(group.severity, 1)))


def first_page_notices(result: Result) -> tuple[Notice, ...]:
    """Return the notices of the first page: no information, nothing that a badge or a number there says already.

    Parameters
    ----------
    result : Result
    """
    numbers = {headline.name for headline in result.headlines if headline.shown}
    return tuple(
        notice
        for notice in result.notices
        if notice.severity != "information" and _REPEATED.get(notice.code) not in numbers
    )


def _group(members: list[Notice]) -> NoticeGroup:
    unlike = list(dict.fromkeys(members))
    worst = min(unlike, key=lambda notice: (_RANK.get(notice.severity, 1), -_distance(notice)))
    places = tuple(dict.fromkeys(found.group(1) for notice in unlike if (found := _PLACE.match(notice.message))))
    return NoticeGroup(worst, len(unlike), places if len(unlike) > 1 else ())


def value_and_limit(notice: Notice) -> tuple[float, float]:
    """Return the number of a notice and its limit as a page shows them: angles in degrees."""
    if notice.unit == "rad":
        return math.degrees(notice.value), math.degrees(notice.limit)
    return notice.value, notice.limit


def _distance(notice: Notice) -> float:
    """Return how far a notice's number lies from its limit, as a ratio; 0 where it is not known."""
    value, limit = abs(notice.value), abs(notice.limit)
    if not (value > 0.0 and limit > 0.0 and math.isfinite(value) and math.isfinite(limit)):
        return abs(notice.value - notice.limit) if math.isfinite(notice.value - notice.limit) else 0.0
    return abs(math.log(value / limit))
