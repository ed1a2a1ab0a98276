"""What a result shows in Python: its first page in a notebook, its tables as pandas frames, its figures by plotly."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cached_property
from html import escape
from typing import TYPE_CHECKING, Generic, TypeVar

from moyai.core.results import Result
from moyai.core.results import read_result as read_stored
from moyai.language import require_language
from moyai.report.document import Document, Figure, KeyFigure, KeyFigures, Panel, Series, Table
from moyai.report.encoding import column_unit, scaled_cell, slug, unique_slugs
from moyai.report.first_page import badges, criteria_table, units_of
from moyai.report.formatting import axis_label, pretty_unit
from moyai.report.headlines import headline_figures
from moyai.report.html import column_texts, words
from moyai.report.systems import UNITS_NOTES, displayed_in, require_system

if TYPE_CHECKING:
    import pandas as pd
    from plotly.graph_objects import Figure as PlotlyFigure

_B = TypeVar("_B", bound=Table | Figure)
_V = TypeVar("_V")
_COLOURS = {"good": "#1a7f37", "caution": "#9a6700", "bad": "#b00020", "neutral": "#666666"}
_LISTED = 40  # names in a message
#: What a block without its water level is called, by what a reader may look for.
_ALIASES = {"transmission": "coefficients", "reflection": "coefficients", "line-tensions": "loads"}


class Views(Mapping[str, _V], Generic[_B, _V]):
    """Blocks of a report by name, each turned into what Python works with when it is asked for.

    Names are those of the files of a report (``hwl-lines-at-rest``). ``_`` may stand for ``-``. A short name is enough
    where one block answers to it: the name without its water level, its end, or words of name and title or of the heads
    and curves (``line_tensions``, ``transmission``), looked for in this order; where one answers at every water level,
    that of the level of the first page's governing number.
    """

    def __init__(
        self, what: str, blocks: Sequence[_B], view: Callable[[_B], _V], levels: Iterable[str] = (), governs: str = ""
    ) -> None:
        self._what = what
        self._view = view
        self._blocks: dict[str, _B] = dict(zip(unique_slugs(block.key for block in blocks), blocks, strict=True))
        self._levels = tuple(f"{slug(level)}-".replace("_", "-") for level in levels)
        self._governs = f"{slug(governs)}-".replace("_", "-")

    def __getitem__(self, name: str) -> _V:
        found = self._called(name)
        if len(found) > 1:
            found = self._governing(found) or found
        if len(found) == 1:
            return self._view(self._blocks[found[0]])
        known = found or list(self._blocks)
        listed = ", ".join(known[:_LISTED]) + (f" and {len(known) - _LISTED} more" if len(known) > _LISTED else "")
        reason = f"{len(found)} {self._what}s answer to" if found else f"no {self._what} is called"
        raise KeyError(f"{reason} {name!r}; there are: {listed or 'none'}")

    def _called(self, name: str) -> list[str]:
        """Return the names that a short one may mean: those of the closest kind of likeness that has any."""
        wanted = name.replace("_", "-").lower()
        alias, asked = _ALIASES.get(wanted, wanted), _stems(wanted)
        plain = {key: key.replace("_", "-") for key in self._blocks}
        short = {key: text.removeprefix(self._level_of(text)) for key, text in plain.items()}
        said = {key: f"{plain[key]} {block.title}" for key, block in self._blocks.items()}
        ways: tuple[Callable[[str], bool], ...] = (
            lambda key: plain[key] == wanted,
            lambda key: short[key] == wanted,
            lambda key: plain[key].endswith(f"-{wanted}"),
            lambda key: short[key] == alias,
            lambda key: asked <= _stems(said[key]),
            lambda key: asked <= _stems(f"{said[key]} {_inner_words(self._blocks[key])}"),
        )
        hits = ([key for key in plain if way(key)] for way in ways)
        return next((keys for keys in hits if keys), []) if asked else []

    def _governing(self, keys: list[str]) -> list[str]:
        """Return the one of the governing level, where the same stands at several."""
        plain = {key: key.replace("_", "-") for key in keys}
        if len({text.removeprefix(self._level_of(text)) for text in plain.values()}) > 1:
            return []
        return [key for key, text in plain.items() if self._level_of(text) == self._governs]

    def _level_of(self, text: str) -> str:
        return max((level for level in self._levels if text.startswith(level)), key=len, default="")

    def __iter__(self) -> Iterator[str]:
        return iter(self._blocks)

    def __len__(self) -> int:
        return len(self._blocks)

    def __repr__(self) -> str:
        return f"{self._what}s: {', '.join(self._blocks)}"


def _stems(text: str) -> frozenset[str]:
    """Return the words of a text without the ending of a plural."""
    return frozenset(word.rstrip("s") or word for word in re.findall(r"[^\W_]+", text.lower()))


def _inner_words(block: Table | Figure) -> str:
    """Return the heads of a table, or panels and curves of a figure."""
    if isinstance(block, Table):
        return " ".join(column.label for column in block.columns)
    parts: tuple[Panel | Series, ...] = (*block.panels, *block.series)
    return " ".join(part.label for part in parts)


class ReportedResult(Result):
    """A result with its report: ``tables``, ``figures``, and the first page in a notebook."""

    @cached_property
    def document(self) -> Document:
        """The report of the result, composed at the first use."""
        from moyai.report.writer import compose_document

        return compose_document(self)

    @property
    def tables(self) -> Views[Table, pd.DataFrame]:
        """Tables of the report as pandas frames, in the units of their heads."""

        def frame(table: Table) -> pd.DataFrame:
            with displayed_in(self.document.units):
                return table_frame(table)

        return Views("table", self.document.tables(), frame, self._levels(), self._governing_level())

    @property
    def figures(self) -> Views[Figure, PlotlyFigure]:
        """Figures of the report as figures of plotly."""
        from moyai.report.plotly_figure import plotly_figure

        drawn = [item for item in self.document.blocks() if isinstance(item, Figure)]
        return Views("figure", drawn, plotly_figure, self._levels(), self._governing_level())

    def _levels(self) -> list[str]:
        return [name for name, node in self.held.children.items() if "water_level" in node.attrs]

    def _governing_level(self) -> str:
        """Return the water level of the first number of the first page; empty where it names none."""
        where = next((item.where for item in self.headlines if item.shown and item.where), "")
        named = [level for level in self._levels() if re.search(rf"(?<!\w){re.escape(level)}(?!\w)", where)]
        return named[0] if len(named) == 1 else ""

    def shown_in(self, units: str) -> ReportedResult:
        """Return the result with its report, tables and figures in ``SI`` or ``tf``; its data stay in SI.

        Parameters
        ----------
        units : {"SI", "tf"}
            System of units.

        Raises
        ------
        InputError
            For units of another name.
        """
        require_system(units)
        return replace(self, provenance={**self.provenance, "display_units": units})

    def said_in(self, language: str) -> ReportedResult:
        """Return the result with its report in ``en`` or ``ja``; its data, tables and figures in Python stay English.

        Parameters
        ----------
        language : {"en", "ja"}
            Of the report.

        Raises
        ------
        InputError
            For a language of another name.
        """
        return replace(self, provenance={**self.provenance, "display_language": require_language(language)})

    def _repr_html_(self) -> str:
        return summary_html(self)


def with_views(result: Result) -> ReportedResult:
    """Return a result with its tables and figures.

    Parameters
    ----------
    result : Result
    """
    if isinstance(result, ReportedResult):
        return result
    rest = {name: getattr(result, name) for name in Result.__dataclass_fields__ if name != "tree"}
    return ReportedResult(tree=result.held, **rest)


def read_result(path: str | os.PathLike[str]) -> ReportedResult:
    """Read a result written by :meth:`moyai.core.results.Result.write`, with its tables and figures.

    Parameters
    ----------
    path : path
        ``results.nc`` of any command.

    Raises
    ------
    InputError
        When the file is absent or was not written by moyai.
    """
    return with_views(read_stored(path))


def table_frame(table: Table) -> pd.DataFrame:
    """Return a table of a report as a pandas frame; its columns are called as in the CSV, ``tension [kN]``.

    Parameters
    ----------
    table : Table

    Returns
    -------
    pandas.DataFrame
        Numbers in the unit of their head, NaN for what is not known.
    """
    import pandas as pd

    heads, columns = [], []
    for column in table.columns:
        unit = column_unit(column)
        heads.append(axis_label(column.label, unit.name))
        columns.append(pd.Series([scaled_cell(value, unit.factor) for value in column.values]))
    frame = pd.concat(columns, axis=1) if columns else pd.DataFrame()
    return frame.set_axis(heads, axis=1)


def summary_html(result: ReportedResult) -> str:
    """Return the first page of a result as a piece of HTML: badges, governing numbers, criteria; nothing is loaded.

    Parameters
    ----------
    result : ReportedResult
    """
    parts = [f"<strong>{escape(str(result.provenance.get('title', '')))}</strong>"]
    for badge in badges(result):
        word = f'<strong style="color:{_COLOURS[badge.tone]}">{escape(badge.word)}</strong>'
        parts.append(f"<div>{escape(badge.label)}: {word} {words(badge.message)}</div>")
    with displayed_in(units_of(result)):
        numbers = [(item.label[:1].upper() + item.label[1:], item.text, item.detail) for item in _key_figures(result)]
        criteria = criteria_table(result)
    if numbers:
        parts.append(_grid(("Governing number", "Value", "Where, model and band"), numbers))
    if criteria is not None:
        units = [pretty_unit(column_unit(column).name) for column in criteria.columns]
        heads = [f"{c.label} [{u}]" if u else c.label for c, u in zip(criteria.columns, units, strict=True)]
        parts.append(_grid(heads, list(zip(*map(column_texts, criteria.columns), strict=True))))
    if note := UNITS_NOTES.get(units_of(result)):
        parts.append(f"<div>{escape(note)}</div>")
    return f'<div class="moyai-result">{"".join(parts)}</div>'


def _key_figures(result: ReportedResult) -> list[KeyFigure]:
    """Return the governing numbers: those of the result, else those that its report finds."""
    if (known := headline_figures(result)) is not None:
        return list(known.items)
    try:
        blocks = result.document.blocks()
    except Exception:
        # an interrupted result may hold too little for a report; its badges stand all the same
        if result.status != "interrupted":
            raise
        return []
    return [item for block in blocks if isinstance(block, KeyFigures) for item in block.items]


def _grid(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    style = ' style="text-align:left;vertical-align:top"'
    head = "".join(f"<th{style}>{words(text)}</th>" for text in heads)
    body = "".join(f"<tr>{''.join(f'<td{style}>{words(text)}</td>' for text in row)}</tr>" for row in rows)
    return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"
