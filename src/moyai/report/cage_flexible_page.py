"""Compose the report of a flexible cage: volume, drag and tensions first, then what they rest on."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from moyai.core.results import Result
from moyai.report import cage_flexible_figures as figures
from moyai.report import cage_flexible_tables as tables
from moyai.report.cage_flexible_scene import rest_views, run_view
from moyai.report.cage_rigid_reading import Level, levels_of
from moyai.report.document import Block, Choice, Document, KeyFigure, KeyFigures, Option, Paragraph, Section
from moyai.report.formatting import format_quantity
from moyai.report.general_page import case_listing, closing_section, notice_blocks, provenance, report_title
from moyai.report.reading import Group


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
    root = Group("", result.tree)
    levels = levels_of(root)

    def at_each_level(compose_level: Callable[[Level], Sequence[Block | None]]) -> tuple[Block, ...]:
        options = []
        for level in levels:
            blocks = tuple(block for block in compose_level(level) if block is not None)
            options.append(Option(level.name, blocks or (Paragraph("Not run at this water level.", quiet=True),)))
        if all(isinstance(option.blocks[0], Paragraph) for option in options):
            return ()
        if len(options) == 1:
            return options[0].blocks
        return (Choice("water-level", "Water level", tuple(options)),)

    sections = [
        Section("summary", "Summary", (*_summary(levels), *notice_blocks(result))),
        Section(
            "shape", "Shape at rest", at_each_level(lambda level: [rest_views(level), figures.volume_figure(level)])
        ),
        Section(
            "loads",
            "Drag and loads at rest",
            at_each_level(
                lambda level: [
                    figures.drag_figure(level),
                    tables.current_table(level),
                    tables.split_table(level),
                    tables.lines_table(level),
                ]
            ),
        ),
        Section("collar", "Collar", at_each_level(lambda level: [figures.collar_figure(level)])),
        Section("time", "In waves", at_each_level(_time)),
        Section("cage", "The cage", at_each_level(lambda level: [tables.cage_table(level)])),
        Section("input", "Input", (case_listing(root),)),
    ]
    return Document(
        title=report_title(result),
        subtitle=_subtitle(levels),
        status=result.status,
        message=result.message,
        sections=(*(section for section in sections if section.blocks), closing_section(result)),
        provenance=provenance(result),
    )


def _subtitle(levels: tuple[Level, ...]) -> str:
    if not levels:
        return "Flexible net cage"
    cage = levels[0].part("cage")
    count = len(cage.labels("cage"))
    words = f"{cage.attributes.get('shape', '')}, {format_quantity(float(cage.attributes.get('size', 0.0)), 'm')}"
    return f"Flexible net cage, {words}" if count == 1 else f"{count} flexible net cages, {words} each"


def _summary(levels: tuple[Level, ...]) -> tuple[Block, ...]:
    items: list[KeyFigure] = []
    for level in levels[:1]:
        statics = level.part("statics")
        speed, share = statics.real("current_speed", "current"), statics.array("volume_share", "current", "cage")
        total = statics.array("total_drag", "current")
        if speed is not None and share is not None and total is not None and len(speed) > 1:
            last = len(speed) - 1
            least = 100.0 * float(share[last].min())
            where = f"at {speed[last]:.3g} m/s, {level.name}"
            items.append(
                KeyFigure("volume left", f"{least:.3g} %", where, judgement="good" if least > 70.0 else "caution")
            )
            items.append(KeyFigure("drag", format_quantity(float(total[last]), "N"), where))
        items += _tension(level)
        items += _stress(level)
    return (KeyFigures(tuple(items)),) if items else ()


def _runs(level: Level) -> list[tuple[str, Group]]:
    return [(sea.name, run) for sea in level.part("time").children() for run in sea.children()]


def _tension(level: Level) -> list[KeyFigure]:
    best: tuple[float, float, str] | None = None
    statics = level.part("statics")
    largest, used = (statics.array(name, "current", "line") for name in ("tension_largest", "utilisation"))
    if largest is not None and used is not None and used.size:
        row, line = np.unravel_index(int(np.argmax(used)), used.shape)
        best = (float(largest[row, line]), float(used[row, line]), f"{statics.labels('line')[line]}, at rest")
    for sea, run in _runs(level):
        peak, share = run.real("tension_maximum", "line"), run.real("utilisation", "line")
        if peak is None or share is None or not share.size:
            continue
        at = int(np.argmax(share))
        if best is None or float(share[at]) > best[1]:
            best = (float(peak[at]), float(share[at]), f"{run.labels('line')[at]}, {sea}")
    if best is None:
        return []
    judged = "bad" if best[1] > 1.0 else "caution" if best[1] > 0.33 else "good"
    return [
        KeyFigure("governing tension", format_quantity(best[0], "N"), best[2], utilisation=best[1], judgement=judged)  # type: ignore[arg-type]
    ]


def _stress(level: Level) -> list[KeyFigure]:
    found: list[tuple[float, str]] = []
    rest = level.part("statics").array("collar_stress_largest", "current", "cage")
    if rest is not None:
        found.append((float(rest.max()), "at rest"))
    for sea, run in _runs(level):
        stress = run.array("collar_stress_largest", "time", "cage")
        if stress is not None:
            found.append((float(stress.max()), sea))
    if not found:
        return []
    value, where = max(found)
    return [KeyFigure("collar stress", format_quantity(value, "Pa"), where)]


def _time(level: Level) -> list[Block | None]:
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
