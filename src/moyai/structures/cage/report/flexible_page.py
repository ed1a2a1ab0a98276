"""Compose the report of a flexible cage: volume, drag and tensions first, then what they rest on."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from moyai.core.results import Result
from moyai.report.document import Block, Choice, Document, Option
from moyai.report.formatting import format_quantity
from moyai.report.general_page import case_listing, chapters, notice_blocks, page_of
from moyai.report.headlines import headline_figures
from moyai.report.levels import at_each_level
from moyai.report.reading import Group, root_of
from moyai.structures.cage.report import flexible_figures as figures
from moyai.structures.cage.report import flexible_tables as tables
from moyai.structures.cage.report.flexible_scene import rest_views, run_view
from moyai.structures.cage.report.rigid_reading import CageLevel, levels_of


def compose(result: Result) -> Document:
    """Compose the report of a flexible cage.

    Parameters
    ----------
    result : Result
        With the layout of ``docs/result_layout.md``; whatever is absent is left out.

    Returns
    -------
    Document
    """
    root = root_of(result)
    levels = levels_of(root)

    def each_level(compose_level: Callable[[CageLevel], Sequence[Block | None]]) -> tuple[Block, ...]:
        return at_each_level(levels, compose_level, choice_of_one=False)

    sections = chapters(
        ("summary", "Summary", lambda: (*_summary(result), *notice_blocks(result))),
        ("shape", "Shape at rest", lambda: each_level(lambda level: [rest_views(level), figures.volume_figure(level)])),
        (
            "loads",
            "Drag and loads at rest",
            lambda: each_level(
                lambda level: [
                    figures.drag_figure(level),
                    tables.law_table(level),
                    tables.current_table(level),
                    tables.split_table(level),
                    tables.lines_table(level),
                ]
            ),
        ),
        ("collar", "Collar", lambda: each_level(lambda level: [figures.collar_figure(level)])),
        ("time", "In waves", lambda: each_level(_time)),
        ("cage", "The cage", lambda: each_level(lambda level: [tables.cage_table(level)])),
        ("input", "Input", lambda: (case_listing(root),)),
    )
    return page_of(result, _subtitle(levels), sections)


def _subtitle(levels: tuple[CageLevel, ...]) -> str:
    if not levels:
        return "Flexible net cage"
    cage = levels[0].part("cage")
    count = len(cage.labels("cage"))
    words = f"{cage.attributes.get('shape', '')}, {format_quantity(float(cage.attributes.get('size', 0.0)), 'm')}"
    return f"Flexible net cage, {words}" if count == 1 else f"{count} flexible net cages, {words} each"


def _summary(result: Result) -> tuple[Block, ...]:
    found = headline_figures(result)
    return () if found is None else (found,)


def _runs(level: CageLevel) -> list[tuple[str, Group]]:
    return [(sea.name, run) for sea in level.part("time").children() for run in sea.children()]


def _time(level: CageLevel) -> list[Block | None]:
    options: list[Option] = []
    for sea, run in _runs(level):
        blocks: list[Block | None] = [
            run_view(level, sea, run),
            *figures.run_figures(level, sea, run),
            tables.run_table(level, sea, run),
            tables.drag_table(level, sea, run),
        ]
        shown = tuple(block for block in blocks if block is not None)
        if shown:
            options.append(Option(f"{sea}: {run.attributes.get('wave', run.name)}", shown))
    found: list[Block | None] = []
    if len(options) == 1:
        found.extend(options[0].blocks)
    elif options:
        found.append(Choice(f"run-{level.name}", "Wave", tuple(options), print_all=False))
    for sea_group in level.part("sensitivity").children():
        found.append(tables.sensitivity_table(level, sea_group))
    return found
