"""Write a document as one HTML file that opens offline: styles, scripts, plotly and all data are inside."""

from __future__ import annotations

import base64
import math
import re
from functools import cache
from html import escape
from importlib import resources
from typing import Any

from moyai.core.validity import IdentityCheck, Notice
from moyai.language import said
from moyai.language.words import breadth
from moyai.report.document import (
    Animation,
    Badge,
    Block,
    Cell,
    Chapter,
    Choice,
    Column,
    Document,
    Drawing,
    Figure,
    KeyFigure,
    KeyFigures,
    Listing,
    NoticeBlock,
    Paragraph,
    Table,
)
from moyai.report.encoding import column_unit, figure_specification, page_json, slug, table_csv
from moyai.report.first_page import COMPUTATION
from moyai.report.fonts import embedded_style
from moyai.report.formatting import DASH, column_decimals, format_fixed, format_number, pretty_unit, trimmed
from moyai.report.language import for_its_reader
from moyai.report.notices import grouped, value_and_limit
from moyai.report.packing import pack_arrays
from moyai.report.systems import words_in_system

STATUS_WORDS = {status: word for status, (word, _) in COMPUTATION.items()}
LEAST_LETTER = 9.0
_ONE_LINE = 24  # letters of a cell that is not broken
_HYPHENATED = re.compile(r"(?<![\w-])(?=[\w.-]{3,40}(?![\w.-]))\w[\w.]*(?:-[\w.]+)+")
"""Height of the smallest letters of a drawing on a narrow screen [CSS px]; the drawing moves sideways there."""
_JAPANESE_FACES = (
    '"Segoe UI","Helvetica Neue",Helvetica,Arial,"Hiragino Sans","Yu Gothic",Meiryo,'
    '"Noto Sans CJK JP","moyai-ja",sans-serif'
)  # fmt: skip
SCRIPT_WORDS = (
    "Copied", "Refused", "maximum", "max", "Maximum", "sway, heave, roll", "Play", "Pause", "Space", "Time",
    "Speed (plus, minus)", "Save this picture", "Show window", "Whole record", "tension", "slack", "plan", "to",
    "section at mid-span", "tension of both cables", "tension, both cables", "View (V)", "Farther", "Nearer", "waves",
    "current", "grid", "bar",
    "Animation. Space plays, arrows step, M jumps to the maximum, V changes the view, W the span, plus and minus the "
    "speed.",
    "Drag to turn, shift-drag to move, click and scroll to zoom, double-click to return.",
    "Drag to turn, shift-drag to move, click and scroll to zoom, double-click to return; click the trace to go to a "
    "time.",
    "This could not be drawn; its data are in report.xlsx and results.nc. A browser of 2023 or newer is needed.",
)  # fmt: skip
"""What the scripts of the page say of themselves."""
_PASTE = "Copy the data, ready to paste into a spreadsheet"
_NO_SCRIPT = "Figures and the animation need JavaScript; tables and text are complete without it."
SCRIPTS = ("report.js", "figures.js", "curtain.js", "scene_3d.js", "scene_3d_paint.js", "player.js")


def asset(name: str) -> str:
    """Return the text of a file that ships with the report."""
    return (resources.files("moyai.report") / "assets" / name).read_text(encoding="utf-8")


@for_its_reader
def render_parts(document: Document) -> tuple[str, dict[str, Any]]:
    """Return the inner part of the page and its data, for a page that has styles and scripts of the report already.

    Parameters
    ----------
    document : Document

    Returns
    -------
    str
        Badges and sections as HTML.
    dict
        What ``MOYAI.data`` of the report's scripts holds: figures, scenes, tables.
    """
    page = _Page(live=True)
    sections = "\n".join(page.section(section) for section in document.sections)
    data = page.data()
    return f"{_badges(document)}\n{sections}", data


def plotly_archive() -> bytes:
    """Return plotly.js as it ships with the report, gzip: the bundle of curves and bars, a quarter of the whole."""
    return (resources.files("moyai.report") / "assets" / "plotly-basic.min.js.gz").read_bytes()


@cache
def packed_plotly() -> str:
    """Return plotly.js compressed and in base64 (0.5 MB)."""
    return base64.b64encode(plotly_archive()).decode("ascii")


@for_its_reader
def render_html(document: Document) -> str:
    """Return the report as one HTML page.

    Parameters
    ----------
    document : Document

    Returns
    -------
    str
        Complete page; it needs no network.
    """
    page = _Page()
    sections = "\n".join(page.section(section) for section in document.sections)
    contents = "\n".join(
        f'<li><a href="#{escape(slug(section.key))}">{escape(section.title)}</a></li>' for section in document.sections
    )
    plotly = f'<script type="text/plain" id="packed-plotly">{packed_plotly()}</script>' if page.figures else ""
    scripts = "\n".join(f"<script>\n{asset(name)}</script>" for name in SCRIPTS)
    data, numbers = pack_arrays(page.data())
    block = f'<script type="text/plain" id="packed-numbers">{numbers}</script>' if numbers else ""
    page_text = f"""<!DOCTYPE html>
<html lang="{document.language}">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="generator" content="moyai {escape(str(document.provenance.get("moyai_version", "")))}">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>{escape(document.title)}</title>
<style>
{asset("report.css")}</style>
</head>
<body>
<a class="skip" href="#content">{escape(said("To the content"))}</a>
<header class="masthead">
<div>
<h1>{escape(document.title)}</h1>
<p class="subtitle">{escape(document.subtitle)}</p>
</div>
{_badges(document)}
</header>
<div class="frame">
<nav aria-label="{escape(said("Contents"))}"><ol>
{contents}
</ol></nav>
<main id="content">
<noscript><p class="notice warning">{escape(said(_NO_SCRIPT))}</p></noscript>
{sections}
</main>
</div>
<footer>{escape(foot_text(document))}</footer>
<script type="application/json" id="report-data">{page_json(data)}</script>
{block}
{plotly}
{scripts}
</body>
</html>
"""
    if document.language != "ja":
        return page_text
    faces = f"{embedded_style(page_text)}body,svg{{font-family:{_JAPANESE_FACES}}}\n"
    return page_text.replace("</style>", f"{faces}</style>", 1)


def badges_of(document: Document) -> tuple[Badge, ...]:
    """Return the badges of a document; that of its status where it has no others."""
    if document.badges:
        return document.badges
    word, tone = COMPUTATION.get(document.status, (document.status, "bad"))
    return (Badge("", word, document.message, tone),)


def _badges(document: Document) -> str:
    items = []
    for badge in badges_of(document):
        label = f"<span>{escape(badge.label)}</span> " if badge.label else ""
        message = f'<p class="status-message">{words(badge.message)}</p>' if badge.message else ""
        items.append(f'<div class="status {badge.tone}">{label}<strong>{escape(badge.word)}</strong>{message}</div>')
    return f'<div class="badges">{"".join(items)}</div>'


def foot_text(document: Document) -> str:
    """Return version, time and case hash for the foot of the page."""
    parts = []
    for key, label in (("moyai_version", "moyai"), ("created", ""), ("case_hash", "case")):
        value = str(document.provenance.get(key, ""))
        if value:
            parts.append(f"{said(label)} {value[:25]}".strip())
    return " · ".join(parts)


def column_texts(column: Column) -> list[str]:
    """Return the shown texts of a column: a dash for what is not known, decimals under each other.

    Parameters
    ----------
    column : Column

    Returns
    -------
    list of str
    """
    factor = column_unit(column).factor
    numbers = [float(value) * factor for value in column.values if not isinstance(value, str | bool | None)]
    decimals = column_decimals(numbers, column.digits) if column.uniform else None

    def text(value: Cell) -> str:
        if value is None:
            return DASH
        if isinstance(value, str):
            return value
        if isinstance(value, bool):
            return said("yes" if value else "no")
        number = float(value) * factor
        shown = format_number(number, column.digits) if decimals is None else format_fixed(number, decimals)
        return trimmed(shown) if column.trim else shown

    return [text(value) for value in column.values]


def words(text: str) -> str:
    """Escape a text for HTML; the letter behind ``K_`` is lowered."""
    return re.sub(r"\b([KC])_([TRgDELM])(?![A-Za-z])", r"\1<sub>\2</sub>", escape(text))


def is_text_column(column: Column) -> bool:
    """Whether a column is set flush left."""
    return any(isinstance(value, str | bool) for value in column.values)


class _Page:
    """Collects the data that blocks leave behind while they are rendered."""

    def __init__(self, *, live: bool = False) -> None:
        # A page that changes names a single option too: others may come
        self._live = live
        self.figures: dict[str, Any] = {}
        self.scenes: dict[str, Any] = {}
        self.tables: dict[str, str] = {}
        self._used: set[str] = set()
        self._choices = 0

    def data(self) -> dict[str, Any]:
        """Return what the scripts read: figures, scenes, tables and, in another language, their words."""
        found: dict[str, Any] = {"figures": self.figures, "scenes": self.scenes, "tables": self.tables}
        views = [view for scene in self.scenes.values() for view in scene.get("extents", {})]
        spoken = {text: said(text) for text in (*SCRIPT_WORDS, *views)}
        if words := {text: translated for text, translated in spoken.items() if translated != text}:
            found["words"] = words
        return found

    def _unique(self, key: str) -> str:
        name, count = slug(key), 2
        while name in self._used:
            name, count = f"{slug(key)}-{count}", count + 1
        self._used.add(name)
        return name

    def section(self, section: Chapter) -> str:
        blocks = "\n".join(self.block(block) for block in section.blocks)
        name = escape(slug(section.key))
        return f'<section id="{name}"><h2>{escape(section.title)}</h2>\n{blocks}\n</section>'

    def block(self, block: Block) -> str:
        match block:
            case Figure():
                return self._figure(block)
            case Table():
                return self._table(block)
            case KeyFigures():
                return '<div class="key-figures">' + "".join(_key_figure(item) for item in block.items) + "</div>"
            case Paragraph():
                return f'<p class="{"quiet" if block.quiet else "text"}">{words(block.text)}</p>'
            case Listing():
                opened = "" if block.collapsed else " open"
                return (
                    f'<details class="listing"{opened}><summary>{escape(block.title)}</summary>'
                    f"<pre>{escape(block.text)}</pre></details>"
                )
            case Drawing():
                return self._drawing(block)
            case Animation():
                return self._animation(block)
            case NoticeBlock():
                return _notices(block)
            case Choice():
                return self._choice(block)

    def _figure(self, figure: Figure) -> str:
        name = self._unique(figure.key)
        hint = f'<p class="caption hint">{escape(figure.hint)}</p>' if figure.hint else ""
        self.figures[name] = {**figure_specification(figure), "key": name}
        switch = ""
        if len(figure.abscissae) > 1:
            buttons = "".join(
                f'<button type="button" data-abscissa="{escape(a.key)}" aria-pressed="{"false" if i else "true"}">'
                f"{escape(a.label)}</button>"
                for i, a in enumerate(figure.abscissae)
            )
            switch = f'<span class="segmented" role="group" aria-label="{said("Plot against")}">{buttons}</span>'
        shown = said("Shown part of the record")
        overview = (
            f'<canvas class="overview" tabindex="0" role="slider" aria-label="{shown}"></canvas>'
            if figure.slider
            else ""
        )
        return f"""<figure class="figure" id="{name}" data-figure="{name}">
<figcaption><h3>{words(figure.title)}</h3>{_caption(figure.caption)}{hint}</figcaption>
<div class="plot" style="height:{figure.height}px" role="img" aria-label="{escape(figure.title)}"></div>{overview}
<div class="tools">{switch}<span class="spring"></span>
<button type="button" data-do="csv" title="{said("Download the data of this figure")}">CSV</button>
<button type="button" data-do="copy" title="{said(_PASTE)}">{said("Copy data")}</button>
<button type="button" data-do="svg">SVG</button><button type="button" data-do="png">PNG</button></div>
</figure>"""

    def _table(self, table: Table) -> str:
        name = self._unique(table.key)
        self.tables[name] = table_csv(table)
        heads, units = [], [column_unit(column) for column in table.columns]
        for column, unit in zip(table.columns, units, strict=True):
            kind = ' class="text"' if is_text_column(column) else ""
            shown = f"<span>{escape(pretty_unit(unit.name))}</span>" if unit.name else ""
            heads.append(f'<th scope="col"{kind}>{words(column.label)}{shown}</th>')
        rows = []
        texts = [column_texts(column) for column in table.columns]
        for row in range(table.row_count):
            kinds = [word for word, at in (("governs", table.emphasised), ("failed", table.failed)) if row in at]
            cells = []
            for column, shown_texts in zip(table.columns, texts, strict=True):
                kind = ' class="text"' if is_text_column(column) else ""
                link = column.links[row] if column.links else ""
                shown = words(shown_texts[row])
                if kind:
                    kind, shown = _unbroken(shown_texts[row], shown)
                cells.append(f"<td{kind}>" + (f'<a href="{escape(link)}">{shown}</a>' if link else shown) + "</td>")
            rows.append(f'<tr class="{" ".join(kinds)}">' + "".join(cells) + "</tr>")
        copy = said("Copy data")
        body = f"""<div class="scroll" tabindex="0" role="region" aria-label="{escape(table.title)}"><table>
<thead><tr>{"".join(heads)}</tr></thead>
<tbody>{"".join(rows)}</tbody></table></div>
<div class="tools">{_caption(table.note)}<span class="spring"></span>
<button type="button" data-do="csv">CSV</button><button type="button" data-do="copy">{copy}</button></div>"""
        if table.collapsed:
            return (
                f'<details class="table" id="{name}" data-table="{name}"><summary>{words(table.title)}</summary>'
                f"{body}</details>"
            )
        return f'<div class="table" id="{name}" data-table="{name}"><h3>{words(table.title)}</h3>{body}</div>'

    def _drawing(self, drawing: Drawing) -> str:
        name = self._unique(drawing.key)
        return f"""<figure class="drawing" id="{name}" data-drawing="{name}">
<figcaption><h3>{words(drawing.title)}</h3>{_caption(drawing.caption)}</figcaption>
<div class="sideways" tabindex="0" role="region" aria-label="{escape(drawing.title)}">
<div style="min-width:{least_width(drawing.svg):.0f}px">{drawing.svg}</div></div>
<div class="tools"><span class="spring"></span><button type="button" data-do="svg">SVG</button></div></figure>"""

    def _animation(self, animation: Animation) -> str:
        name = self._unique(animation.key)
        self.scenes[name] = dict(animation.scene)
        return f"""<figure class="animation" id="{name}">
<figcaption><h3>{words(animation.title)}</h3>{_caption(animation.caption)}</figcaption>
<div class="player" data-scene="{name}"></div></figure>"""

    def _choice(self, choice: Choice) -> str:
        if len(choice.options) == 1:
            only = choice.options[0]
            inner = "\n".join(self.block(block) for block in only.blocks)
            if not self._live:
                return inner
            pane = f'<div class="pane" data-option="{escape(only.label)}">{inner}</div>'
            return f'<div class="choice" data-group="{escape(choice.group)}">{pane}</div>'
        self._choices += 1
        number = self._choices
        if sum(len(option.label) for option in choice.options) + 4 * len(choice.options) > 96:
            items = "".join(
                f"<option{' selected' if i == choice.default else ''}>{escape(option.label)}</option>"
                for i, option in enumerate(choice.options)
            )
            control = (
                f'<label>{escape(choice.label)} <select data-choose="{escape(choice.group)}">{items}</select></label>'
            )
        else:
            items = "".join(
                f'<button type="button" data-choose="{escape(choice.group)}" data-option="{escape(option.label)}" '
                f'aria-pressed="{"true" if i == choice.default else "false"}">{escape(option.label)}</button>'
                for i, option in enumerate(choice.options)
            )
            control = (
                f'<span class="choice-label">{escape(choice.label)}</span>'
                f'<span class="segmented" role="group" aria-label="{escape(choice.label)}">{items}</span>'
            )
        panes = []
        for i, option in enumerate(choice.options):
            hidden = "" if i == choice.default else " hidden"
            inner = "\n".join(self.block(block) for block in option.blocks)
            heading = f'<p class="print-only">{escape(choice.label)}: <strong>{escape(option.label)}</strong></p>'
            panes.append(f'<div class="pane" data-option="{escape(option.label)}"{hidden}>{heading}{inner}</div>')
        return (
            f'<div class="choice" data-group="{escape(choice.group)}" id="choice-{number}">'
            f'<div class="chooser">{control}</div>{"".join(panes)}</div>'
        )


def least_width(svg: str) -> float:
    """Return the width under which the letters of a drawing would be smaller than can be read [CSS px].

    Parameters
    ----------
    svg : str
        With a view box; its letters have their size in units of it.
    """
    box = re.search(r'viewBox="[-\d.]+ [-\d.]+ ([\d.]+) ', svg)
    sizes = [float(size) for size in re.findall(r'font-size="([\d.]+)"', svg)]
    return 0.0 if box is None or not sizes else math.ceil(float(box.group(1)) * LEAST_LETTER / min(sizes))


def _unbroken(text: str, shown: str) -> tuple[str, str]:
    """Return class and content of a cell of words: short ones stay on one line, names and dates keep their hyphens."""
    if len(text) <= _ONE_LINE:
        return ' class="text whole"', shown
    return ' class="text"', _HYPHENATED.sub(r'<span class="whole">\g<0></span>', shown)


def _caption(text: str) -> str:
    return f'<p class="caption">{words(text)}</p>' if text else ""


_LONG_TEXT = 24
"""Letters from which a key figure is a sentence."""


def is_sentence(item: KeyFigure) -> bool:
    """Whether a governing number is words, which are shown smaller: what is not judged."""
    return breadth(item.text) >= _LONG_TEXT


def _key_figure(item: KeyFigure) -> str:
    bar = ""
    if item.utilisation == item.utilisation:
        filled = min(max(item.utilisation, 0.0), 1.0)
        over = " over" if item.utilisation > 1.0 else ""
        bar = f'<div class="meter{over}" aria-hidden="true"><i style="width:{100 * filled:.1f}%"></i></div>'
    kind = "number sentence" if is_sentence(item) else "number"
    return (
        f'<div class="key-figure {item.judgement}"><div class="label">{words(item.label)}</div>'
        f'<div class="{kind}">{words(item.text)}</div>{bar}<div class="detail">{words(item.detail)}</div></div>'
    )


def notice_text(notice: Notice, where: str = "") -> tuple[str, str]:
    """Return the sentence of a notice and its second line: where else, number, limit, remedy, source."""
    message = notice.message.strip()
    parts = [where] if where else []
    if notice.value == notice.value and notice.limit == notice.limit:
        value, limit = value_and_limit(notice)
        parts.append(f"found {format_number(value)}, limit {format_number(limit)}")
    if notice.remedy:
        parts.append(notice.remedy.strip().rstrip("."))
    if notice.source:
        parts.append(f"source: {notice.source.strip().rstrip('.')}")
    second = "; ".join(parts)
    first = message.split(" ", 1)[0]
    if first.isalpha():  # a path of the case file or a name keeps its letters
        message = message[:1].upper() + message[1:]
    return message, second[:1].upper() + second[1:]


def notice_items(block: NoticeBlock) -> list[tuple[str, str, str]]:
    """Return severity and both lines of failed checks and of every kind of notice, the most severe first.

    Parameters
    ----------
    block : NoticeBlock
    """
    items = [("error", *check_text(check)) for check in block.failed_checks]
    items += [(group.severity, *notice_text(group.notice, group.where)) for group in grouped(block.notices)]
    return [(severity, said(words_in_system(head)), said(words_in_system(more))) for severity, head, more in items]


def check_text(check: IdentityCheck) -> tuple[str, str]:
    """Return the sentence of a failed identity check and its meaning."""
    figure = "no figure" if check.value != check.value else f"{check.value:.2e}"
    return f"Identity check not met: {check.name}, {figure} against {check.tolerance:.2e}", check.meaning


def _notices(block: NoticeBlock) -> str:
    items = notice_items(block)
    if not items:
        return ""
    kinds = {"error": "Error", "warning": "Warning", "information": "Note"}
    return (
        '<ul class="notices">'
        + "".join(
            f'<li class="notice {severity}"><strong>{said(kinds.get(severity, severity))}</strong><span>{words(first)}'
            + (f"<small>{words(second)}</small>" if second else "")
            + "</span></li>"
            for severity, first, second in items
        )
        + "</ul>"
    )
