"""The first page: numbers first, then what the design has to keep, then what limits the computation."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace

from moyai.core.headline import Judgement, Outcome
from moyai.core.results import Result
from moyai.report.document import (
    Badge,
    Block,
    Chapter,
    Choice,
    Column,
    Document,
    KeyFigures,
    NoticeBlock,
    Paragraph,
    Table,
    Tone,
    in_one_unit,
)
from moyai.report.formatting import DASH, display_unit, format_number, format_percent
from moyai.report.input_line import input_line
from moyai.report.systems import UNITS_NOTES, words_in_system

COMPUTATION: dict[str, tuple[str, Tone]] = {
    "converged": ("Converged", "good"),
    "outside_validity": ("Outside the range of validity", "caution"),
    "not_converged": ("Not converged", "bad"),
    "interrupted": ("Interrupted: partial result", "caution"),
    "failed": ("Failed", "bad"),
}
"""Words and colour of the status of a computation."""
DESIGN: dict[Outcome, tuple[str, Tone]] = {
    "holds": ("Holds", "good"),
    "does not hold": ("Does not hold", "bad"),
    "not judged": ("Not judged", "neutral"),
}
"""Words and colour of the verdict on the design."""
_LIKE_UNITS = ("N", "Pa")
"""Units whose columns in one table are shown alike."""
_RANK: dict[Outcome, int] = {"does not hold": 0, "not judged": 1, "holds": 2}


def badges(result: Result) -> tuple[Badge, ...]:
    """Return the badges of a result: of its computation, and of its design where it was to be judged.

    Parameters
    ----------
    result : Result
    """
    word, tone = COMPUTATION.get(result.status, (result.status, "bad"))
    found = [Badge("Computation", word, result.message, tone)]
    if result.verdict.message:
        word, tone = DESIGN[result.verdict.outcome]
        found.append(Badge("Design", word, sentence(words_in_system(result.verdict.message)), tone))
    return tuple(found)


def units_of(result: Result) -> str:
    """Return the system of units that a result is shown in: that of its case or of the command, else SI."""
    return str(result.provenance.get("display_units", "SI"))


def with_first_page(document: Document, result: Result) -> Document:
    """Return a document with both badges, and its first section in order: numbers, criteria, notices, the rest.

    Parameters
    ----------
    document : Document
        As its composer made it; badges of its own stay.
    result : Result
    """
    first, *others = document.sections
    numbers = [block for block in first.blocks if isinstance(block, KeyFigures)]
    notices = [block for block in first.blocks if isinstance(block, NoticeBlock)]
    rest = [block for block in first.blocks if not isinstance(block, KeyFigures | NoticeBlock)]
    # empty where a draft is of other sections
    table, conditions = (criteria_table(result), input_line(result)) if first.blocks else (None, "")
    said_of = [Paragraph(conditions, quiet=True)] if conditions else []
    blocks: list[Block] = [*numbers, *said_of, *([] if table is None else [table]), *notices, *rest]
    if first.blocks and (said := UNITS_NOTES.get(units_of(result))):
        blocks.append(Paragraph(said, quiet=True))
    ordered = (Chapter(first.key, first.title, tuple(blocks)), *others)
    sections = tuple(replace(section, blocks=tuple(map(in_like_units, section.blocks))) for section in ordered)
    return replace(document, badges=document.badges or badges(result), sections=sections)


def in_like_units(block: Block) -> Block:
    """Return a block whose tables have one unit of forces and one of stresses, so that columns can be compared."""
    if isinstance(block, Choice):
        options = tuple(replace(option, blocks=tuple(map(in_like_units, option.blocks))) for option in block.options)
        return replace(block, options=options)
    if not isinstance(block, Table):
        return block
    columns: Sequence[Column] = block.columns
    for unit in _LIKE_UNITS:
        columns = in_one_unit(columns, unit)
    return replace(block, columns=tuple(columns))


def criteria_table(result: Result) -> Table | None:
    """Return the criteria of a result, the failing ones first; ``None`` where there are none.

    Parameters
    ----------
    result : Result
    """
    items = sorted(result.verdict.judgements, key=lambda item: _RANK[item.outcome])
    if not items:
        return None
    like = largest_by_unit(result)
    limits, found = zip(*(limit_and_found(item, like.get(item.criterion.unit, 0.0)) for item in items), strict=True)
    return Table(
        "criteria",
        "Criteria",
        (
            Column("Criterion", [_asked(item) for item in items]),
            Column("Limit", list(limits), quantities=True),
            Column("Found", list(found), quantities=True),
            Column("Where", [_place(item) for item in items]),
            Column("Outcome", [item.outcome for item in items]),
            Column("Source", [item.criterion.source for item in items]),
        ),
        note=" ".join(filter(None, (criteria_note(items), without_limit(result)))),
        failed=tuple(row for row, item in enumerate(items) if item.outcome == "does not hold"),
    )


def _asked(item: Judgement) -> str:
    """Return a criterion in words, with the line and sea where a code asks other factors of each analysis."""
    words = sentence(item.criterion.words)
    return f"{words}: {item.reason}" if item.criterion.analysis and item.reason else words


def _place(item: Judgement) -> str:
    place = "; judged on ".join(filter(None, (item.reason, item.judged_on)))
    return "; ".join(filter(None, (place, item.remedy))) or DASH


def criteria_note(items: Iterable[Judgement]) -> str:
    """Return what the reader has to know about the criteria: how they are judged, and that some were assumed."""
    text = "Judged at the unfavourable end of the band of an uncertain coefficient or of the 95 % interval of a mean."
    if any(item.criterion.assumed for item in items):
        text += " A default of moyai is no requirement of yours: give your own under 'criteria', or 'criteria: none'."
    return text


def without_limit(result: Result) -> str:
    """Return which numbers of the first page no criterion judges; empty where all are judged."""
    judged = {item.criterion.headline for item in result.verdict.judgements}
    # a tension is judged by its utilisation
    judged |= {name.replace("utilisation", "tension") for name in judged}
    answers = [item for item in result.headlines if item.shown and not item.condition]
    left = [item for item in answers if item.name not in judged and math.isfinite(item.value)]
    names = dict.fromkeys(_within_a_sentence(item.label) for item in left if not item.name.startswith("limit_"))
    return f"No criterion is given for: {', '.join(names)}." if names else ""


def largest_by_unit(result: Result) -> dict[str, float]:
    """Return the largest magnitude of each unit among the headlines and the limits, which chooses the unit shown."""
    pairs = [(headline.unit, headline.value) for headline in result.headlines if headline.shown]
    for item in result.verdict.judgements:
        pairs += [(item.criterion.unit, item.value), (item.criterion.unit, item.criterion.limit)]
    found: dict[str, float] = {}
    for unit, value in pairs:
        if math.isfinite(value):
            found[unit] = max(found.get(unit, 0.0), abs(value))
    return found


def limit_and_found(item: Judgement, like: float = 0.0) -> tuple[str, str]:
    """Return limit and value of a judgement in one unit, a factor of safety as a factor.

    Parameters
    ----------
    item : Judgement
    like : float
        Magnitude that chooses between N, kN and MN together with both.
    """
    criterion = item.criterion
    bound = f"{item.shown_bound} " if item.shown_bound else ""
    if criterion.as_factor:
        asked = f"at least {format_number(criterion.shown(criterion.limit))}"
        if item.value == 0.0:
            return asked, DASH if item.bound else "no load"
        value = math.nan if math.isnan(item.value) else criterion.shown(item.value)
        return asked, f"{bound}{format_number(value)}"
    if criterion.unit == "1":
        return f"{criterion.sense} {format_number(criterion.limit)}", f"{bound}{format_number(item.value)}"
    if criterion.unit == "%":
        return f"{criterion.sense} {format_percent(criterion.limit, 3)}", f"{bound}{format_percent(item.value, 3)}"
    pair = [value for value in (criterion.limit, item.value, like) if math.isfinite(value)]
    shown = display_unit(criterion.unit, pair)
    texts = []
    for value in (criterion.limit, item.value):
        text = format_number(value * shown.factor)
        joint = "" if shown.name == "deg" else " "
        texts.append(text if text == DASH else f"{text}{joint}{shown.pretty}")
    return f"{criterion.sense} {texts[0]}", f"{bound}{texts[1]}"


def _within_a_sentence(text: str) -> str:
    """Return a text without its capital letter, unless it begins with a name or a symbol."""
    first = text.split(" ", 1)[0]
    return text[:1].lower() + text[1:] if first[1:].islower() else text


def sentence(text: str) -> str:
    """Return a text with a capital letter, unless it begins with a name or a symbol."""
    first = text.split(" ", 1)[0]
    return text[:1].upper() + text[1:] if first.islower() and first.isalpha() else text
