"""Compose the report of a silt curtain: governing numbers first, then what they rest on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from moyai.core.results import Result
from moyai.report.document import Block, Choice, Document, Option
from moyai.report.formatting import format_quantity
from moyai.report.general_page import case_listing, chapters, page_of
from moyai.report.levels import at_each_level, level_words
from moyai.report.reading import Group, root_of
from moyai.structures.curtain.report import figures, limits, sea_figures, sea_tables, tables
from moyai.structures.curtain.report.drawing import drawings
from moyai.structures.curtain.report.dynamic import dynamic_blocks
from moyai.structures.curtain.report.reading import CurtainLevel, governing_component, water_levels
from moyai.structures.curtain.report.rose import rose_blocks
from moyai.structures.curtain.report.snap import snap_animation
from moyai.structures.curtain.report.steady import site_table, steady_tables
from moyai.structures.curtain.report.summary import summary_blocks


def compose(result: Result) -> Document:
    """Compose the report of a silt curtain.

    Parameters
    ----------
    result : Result
        With the layout of ``docs/result_layout.md``; whatever is absent is left out.

    Returns
    -------
    Document
    """
    root = root_of(result)
    levels = water_levels(result)
    worst = governing_component(levels)
    default = next((n for n, level in enumerate(levels) if worst is not None and level.name == worst[0].name), 0)

    def each_level(compose_level: Callable[[CurtainLevel], Sequence[Block | None]]) -> tuple[Block, ...]:
        return at_each_level(levels, compose_level, words=level_words, default=default)

    record = [figures.flume_record(root), *tables.record_tables(root)]
    sections = chapters(
        (
            "summary",
            "Summary",
            lambda: (
                *summary_blocks(result, levels),
                *each_level(lambda level: [figures.utilisation_bars(level), limits.operating_map(level)]),
            ),
        ),
        ("input", "Input", lambda: (case_listing(root), *each_level(lambda level: [site_table(level)]))),
        ("shape", "Shape", lambda: each_level(drawings)),
        ("loads", "Loads", lambda: each_level(tables.load_tables)),
        ("rest", "At rest in the current", lambda: each_level(_at_rest)),
        (
            "impact",
            "Impact when it snaps taut",
            lambda: (
                *each_level(lambda level: _impact(level, root)),
                *(block for block in record if block is not None),
            ),
        ),
        ("waves", "Waves: slack and taut", lambda: each_level(_waves)),
        ("dynamic", "The whole span through time", lambda: each_level(dynamic_blocks)),
        ("anchors", "Anchor loads", lambda: each_level(_anchors)),
        ("limits", "Operating limits", lambda: each_level(_limits)),
    )
    return page_of(result, _subtitle(levels), sections)


def _subtitle(levels: tuple[CurtainLevel, ...]) -> str:
    parts = ["Silt curtain"]
    if levels:
        statics = levels[0].part("statics")
        span, skirt, speed = (statics.value(name) for name in ("span", "skirt_length", "surface_speed"))
        if math.isfinite(span) and math.isfinite(skirt):
            parts.append(f"span {format_quantity(span, 'm')}, skirt {format_quantity(skirt, 'm')}")
        if math.isfinite(speed):
            parts.append(f"current {format_quantity(speed, 'm/s')}")
        names = ", ".join(level.name for level in levels)
        parts.append(("Water levels " if len(levels) > 1 else "Water level ") + names)
        seas = list(dict.fromkeys(sea.name for level in levels for sea in level.seas()))
        seas = seas or list(
            dict.fromkeys(name for level in levels for name in level.part("anchor_loads").labels("sea"))
        )
        if seas:
            parts.append(("Sea states " if len(seas) > 1 else "Sea state ") + ", ".join(seas))
    return " · ".join(parts)


def _at_rest(level: CurtainLevel) -> Sequence[Block | None]:
    return (
        *steady_tables(level),
        tables.statics_table(level),
        figures.section_laws(level),
        figures.plan_laws(level),
        *tables.law_tables(level),
        tables.paper_table(level),
    )


def _impact(level: CurtainLevel, root: Group) -> Sequence[Block | None]:
    return (
        snap_animation(level),
        *tables.impact_tables(level),
        figures.record_over_models(level, root),
        figures.impact_bars(level),
        figures.snap_record(level),
        figures.impact_series(level),
        figures.march_errors(level),
    )


def _waves(level: CurtainLevel) -> Sequence[Block | None]:
    options = []
    for sea in level.seas():
        found: list[Block | None] = [
            sea_figures.regular_tension(level, sea),
            sea_tables.regular_table(level, sea),
            sea_tables.irregular_table(level, sea),
            sea_figures.exceedance(level, sea),
        ]
        runs = []
        for run in sea.children():
            inside = [sea_figures.run_record(level, sea, run), sea_tables.contact_table(level, sea, run)]
            known = tuple(block for block in inside if block is not None)
            if known:
                runs.append(Option(run.name.replace("_", " "), known))
        if runs:
            found.append(Choice(f"run-{sea.name}", "Run", tuple(runs), print_all=False))
        blocks = tuple(block for block in found if block is not None)
        if blocks:
            options.append(Option(sea.name, blocks))
    chosen = (Choice("sea", "Sea state", tuple(options)),) if options else ()
    return (*chosen, sea_tables.weaker_table(level))


def _anchors(level: CurtainLevel) -> Sequence[Block | None]:
    return (
        *sea_tables.anchor_tables(level),
        sea_figures.anchor_against_height(level),
        sea_figures.anchor_against_direction(level),
        sea_figures.anchor_against_velocity(level),
    )


def _limits(level: CurtainLevel) -> Sequence[Block | None]:
    return (limits.limit_curve(level), limits.limit_table(level), limits.map_table(level), *rose_blocks(level))
