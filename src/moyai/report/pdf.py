"""Write a document as PDF through typst: text as data, figures by matplotlib, drawings as they are."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path
from typing import Any

from moyai.language import said
from moyai.report.document import (
    Animation,
    Block,
    Choice,
    Document,
    Drawing,
    Figure,
    KeyFigures,
    Listing,
    NoticeBlock,
    Paragraph,
    Table,
)
from moyai.report.encoding import column_unit
from moyai.report.figures_static import draw_figure
from moyai.report.fonts import JAPANESE, font_folders, require_japanese
from moyai.report.formatting import pretty_unit
from moyai.report.html import (
    asset,
    badges_of,
    column_texts,
    foot_text,
    is_sentence,
    is_text_column,
    notice_items,
)
from moyai.report.language import for_its_reader, with_label

TEXT_FONTS = ("Noto Sans", "Segoe UI", "Helvetica Neue", "Arial", "Liberation Sans", "Noto Sans CJK JP", "DejaVu Sans")
MONO_FONTS = ("DejaVu Sans Mono", "Consolas", "Menlo")
LONG_TEXT = 24  # a column with longer texts than this may break its lines


@for_its_reader
def render_pdf(document: Document) -> bytes:
    """Return the report as PDF.

    Parameters
    ----------
    document : Document
        Of choices marked so, the default alone is printed, with a line that says it.

    Returns
    -------
    bytes

    Raises
    ------
    InputError
        When the document is in Japanese and no font has its letters.
    """
    import typst

    with tempfile.TemporaryDirectory(prefix="moyai-report-") as name:
        folder = Path(name)
        writer = _PdfWriter(folder)
        sections = [
            {"title": section.title, "blocks": [item for block in section.blocks for item in writer.block(block)]}
            for section in document.sections
        ]
        present = _present_fonts()
        if document.language == "ja":
            require_japanese(present)
        data = {
            "title": document.title,
            "subtitle": document.subtitle,
            "status": " · ".join(with_label(badge.label, badge.word) for badge in badges_of(document)),
            "badges": [
                {"label": badge.label, "word": badge.word, "tone": badge.tone, "message": badge.message}
                for badge in badges_of(document)
            ],
            "foot": foot_text(document),
            "fonts": _choose(TEXT_FONTS, present)[:1] + _choose(JAPANESE, present)[:1],
            "mono": _choose(MONO_FONTS, present)[:1] + _choose(JAPANESE, present)[:1],
            "language": document.language,
            "sections": sections,
        }
        (folder / "data.json").write_text(json.dumps(data, ensure_ascii=False, allow_nan=False), encoding="utf-8")
        (folder / "report.typ").write_text(asset("report.typ"), encoding="utf-8")
        return bytes(typst.compile(str(folder / "report.typ"), root=str(folder), font_paths=font_folders()))


def _present_fonts() -> set[str]:
    """Return the families that typst finds: its own, the machine's and that of the extra ``moyai[ja]``."""
    import typst

    return {str(family) for family in typst.Fonts(font_paths=font_folders()).families()}


def _choose(wanted: tuple[str, ...], present: set[str]) -> list[str]:
    """Return those of the wanted fonts that are there; typst's own serif where none is."""
    return [name for name in wanted if name in present] or ["Libertinus Serif"]


class _PdfWriter:
    """Turns blocks into data for the template and writes the images next to it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._images = 0

    def _image(self, content: bytes) -> str:
        self._images += 1
        name = f"image-{self._images}.svg"
        (self._folder / name).write_bytes(content)
        return name

    def block(self, block: Block) -> list[dict[str, Any]]:
        match block:
            case Figure():
                return [self._picture(block.title, block.caption, draw_figure(block))]
            case Drawing():
                return [self._picture(block.title, block.caption, block.fixed_svg.encode("utf-8"))]
            case Animation():
                if not block.still:
                    return []
                return [
                    self._picture(
                        with_label(block.title, said("the governing moment")),
                        block.caption,
                        block.still.encode("utf-8"),
                    )
                ]
            case Table():
                return [_table(block)]
            case KeyFigures():
                items = [
                    {
                        "label": item.label,
                        "text": item.text,
                        "sentence": is_sentence(item),
                        "detail": item.detail,
                        "judgement": item.judgement,
                        "filled": None
                        if item.utilisation != item.utilisation
                        else 100.0 * min(max(item.utilisation, 0.0), 1.0),
                    }
                    for item in block.items
                ]
                return [{"type": "keys", "items": items}]
            case Paragraph():
                return [{"type": "text", "text": block.text, "quiet": block.quiet}]
            case Listing():
                return [{"type": "listing", "title": block.title, "text": block.text}]
            case NoticeBlock():
                return [{"type": "notices", "items": _notices(block)}]
            case Choice():
                return self._choice(block)

    def _choice(self, choice: Choice) -> list[dict[str, Any]]:
        if len(choice.options) == 1:
            return [item for block in choice.options[0].blocks for item in self.block(block)]
        options = choice.options if choice.print_all else (choice.options[choice.default],)
        items: list[dict[str, Any]] = []
        for option in options:
            items.append({"type": "heading", "text": with_label(choice.label, option.label)})
            items += [item for block in option.blocks for item in self.block(block)]
        if not choice.print_all:
            others = ", ".join(option.label for option in choice.options if option is not options[0])
            items.append({"type": "text", "text": said(f"Also in the interactive report: {others}."), "quiet": True})
        return items

    def _picture(self, title: str, caption: str, svg: bytes) -> dict[str, Any]:
        return {"type": "figure", "title": title, "caption": caption, "file": self._image(svg)}


def _table(table: Table) -> dict[str, Any]:
    texts = [column_texts(column) for column in table.columns]
    longest = [max((len(text) for text in column), default=0) for column in texts]
    return {
        "type": "table",
        "title": table.title,
        "note": table.note,
        "heads": [[column.label, pretty_unit(column_unit(column).name)] for column in table.columns],
        "textual": [is_text_column(column) for column in table.columns],
        "widths": [min(length, 80) if length > LONG_TEXT else None for length in longest],
        "rows": [list(row) for row in zip(*texts, strict=True)],
        "emphasised": list(table.emphasised),
        "failed": list(table.failed),
    }


def _notices(block: NoticeBlock) -> list[dict[str, str]]:
    return [
        {"kind": kind, "word": said(kind.capitalize()), "first": first, "second": second}
        for kind, first, second in notice_items(block)
    ]
