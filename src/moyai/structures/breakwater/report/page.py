"""Compose the report of a floating breakwater: governing numbers first, then what they rest on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from moyai.core.results import Result
from moyai.report.document import (
    Block,
    Choice,
    Document,
    Drawing,
    Option,
)
from moyai.report.drawing import SectionGeometry, mooring_elevation, section_detail
from moyai.report.formatting import format_quantity
from moyai.report.general_page import case_listing, chapters, page_of
from moyai.report.levels import at_each_level, level_words
from moyai.report.plan import LineInPlan, UnitInPlan, unit_plan
from moyai.report.reading import Group, root_of
from moyai.structures.breakwater.report import damping, figures, sea_figures, tables
from moyai.structures.breakwater.report.reading import (
    MODES,
    BreakwaterLevel,
    Sea,
    SeaNumbers,
    all_numbers,
    attribute_number,
    governing_entry,
    water_levels,
)
from moyai.structures.breakwater.report.summary import summary_blocks
from moyai.structures.breakwater.report.time import (
    TimeRecord,
    centre_of_gravity,
    lines_rest_shapes,
    outlines_at_rest,
    read_record,
    run_blocks,
)

MOST_ANIMATIONS = 24
POINTS_OF_ALL_RECORDS = 40000  # thinned samples outside the windows, over all runs


def compose(result: Result) -> Document:
    """Compose the report of a floating breakwater.

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
    numbers = all_numbers(levels)
    decides = governing_entry(result, numbers)
    default = next((n for n, level in enumerate(levels) if decides is not None and level.name == decides.level), 0)
    measured = root.child("measured")

    def each_level(compose_level: Callable[[BreakwaterLevel], Sequence[Block | None]]) -> tuple[Block, ...]:
        return at_each_level(levels, compose_level, words=level_words, default=default)

    sections = chapters(
        (
            "summary",
            "Summary",
            lambda: (
                *summary_blocks(result, numbers, decides),
                *each_level(lambda level: [sea_figures.tension_bars(level)]),
            ),
        ),
        ("input", "Input", lambda: (*_input(root, levels), *each_level(_drawings))),
        ("rest", "At rest", lambda: each_level(_at_rest)),
        ("response", "Response to waves", lambda: each_level(_response)),
        ("seas", "Sea states", lambda: each_level(lambda level: _seas(level, measured, decides))),
        ("time", "Time domain", lambda: each_level(_time_section(levels, decides))),
        ("sensitivity", "Sensitivity", lambda: each_level(_sensitivity)),
    )
    return page_of(result, _subtitle(levels), sections)


def _subtitle(levels: tuple[BreakwaterLevel, ...]) -> str:
    parts = ["Floating breakwater"]
    if levels:
        statics = levels[0].group.child("statics")
        sizes = [
            format_quantity(value, "m")
            for name in ("beam", "section_height", "unit_length")
            if math.isfinite(value := statics.value(name))
        ]
        if len(sizes) == 3:
            parts.append(f"{sizes[0]} beam, {sizes[1]} high, {sizes[2]} long")
        parts.append(
            ("Water levels " if len(levels) > 1 else "Water level ") + ", ".join(level.name for level in levels)
        )
        seas = list(dict.fromkeys(name for level in levels for name in level.sea_names()))
        if seas:
            parts.append(("Sea states " if len(seas) > 1 else "Sea state ") + ", ".join(seas))
    return " · ".join(parts)


def _input(root: Group, levels: tuple[BreakwaterLevel, ...]) -> tuple[Block, ...]:
    derived = tables.derived_numbers(levels) if levels else None
    return (case_listing(root), *([derived] if derived is not None else []))


def _drawings(level: BreakwaterLevel) -> Sequence[Block | None]:
    outlines = outlines_at_rest(level)
    if not outlines:
        return ()
    statics = level.group.child("statics")
    geometry = SectionGeometry(
        outlines,
        centre_of_gravity(level),
        statics.value("draught"),
        statics.value("freeboard"),
        statics.value("beam"),
        statics.value("section_height"),
        level.depth,
        lines_rest_shapes(level),
    )
    drawings = [
        section_detail(geometry).drawing(
            figures.key(level, "section"),
            "Section and signs of the motions",
            "To scale. Axes x, z with the origin in the still water; positive roll turns the top towards +x.",
        )
    ]
    if geometry.lines:
        elevation = mooring_elevation(geometry)
        drawings.insert(0, elevation.drawing(figures.key(level, "elevation"), "Mooring at rest", "To scale, at rest."))
    if (plan := _plan(level, geometry)) is not None:
        drawings.append(plan)
    return drawings


def _plan(level: BreakwaterLevel, geometry: SectionGeometry) -> Drawing | None:
    """Return the unit from above on its lines, with the ways of the waves."""
    statics = level.group.child("statics")
    length = statics.value("unit_length")
    count, anchor, held = (statics.real(name, "line") for name in ("line_count", "anchor_x", "fairlead_x"))
    if not math.isfinite(length):
        return None
    lines: list[LineInPlan] = []
    if count is not None and anchor is not None and held is not None:
        rows = zip(statics.labels("line"), count, anchor, held, strict=True)
        lines = [LineInPlan(name, int(alike), float(far), float(near)) for name, alike, far, near in rows]
    every = [sea.domain(name) for sea in map(level.sea, level.sea_names()) for name in ("frequency", "time")]
    found = [attribute_number(domain, "heading") for domain in every]
    x0, x1, _, _ = geometry.box(with_lines=False)
    sketch = unit_plan(UnitInPlan(x0, x1, length, lines, [value for value in found if math.isfinite(value)]))
    return sketch.drawing(
        figures.key(level, "plan"),
        "Unit and mooring in plan",
        "To scale. Alike lines are drawn evenly along the unit: their places along the crest do not enter the "
        "computation.",
    )


def _at_rest(level: BreakwaterLevel) -> Sequence[Block | None]:
    return (
        tables.lines_at_rest(level),
        tables.natural_periods(level),
        figures.restoring(level),
        tables.stiffness_matrices(level),
    )


def _response(level: BreakwaterLevel) -> Sequence[Block | None]:
    return (
        *figures.response_operators(level),
        figures.wave_coefficients(level),
        figures.drift(level),
        *figures.hydrodynamic_coefficients(level),
    )


def _seas(level: BreakwaterLevel, measured: Group, decides: SeaNumbers | None) -> Sequence[Block | None]:
    names = level.sea_names()
    options = []
    for name in names:
        sea = level.sea(name)
        found = _regular_blocks(level, sea, measured) if sea.regular else _irregular_blocks(level, sea)
        blocks = tuple(block for block in found if block is not None)
        if blocks:
            options.append(Option(name, blocks))
    if not options:
        return ()
    default = next((n for n, option in enumerate(options) if decides is not None and option.label == decides.sea), 0)
    return (Choice("sea", "Sea state", tuple(options), default),)


def _regular_blocks(level: BreakwaterLevel, sea: Sea, measured: Group) -> Sequence[Block | None]:
    return (
        sea_figures.regular_motions(level, sea, measured),
        sea_figures.regular_coefficients(level, sea, measured),
        sea_figures.regular_drift(level, sea, measured),
        sea_figures.stiffness_under_drift(level, sea),
        sea_figures.regular_tension(level, sea),
        *tables.regular_tables(level, sea),
        damping.regular_damping_table(level, sea),
    )


def _irregular_blocks(level: BreakwaterLevel, sea: Sea) -> Sequence[Block | None]:
    return (
        tables.irregular_waves(level, sea),
        tables.irregular_motions(level, sea),
        tables.irregular_tensions(level, sea),
        damping.damping_table(level, sea),
        sea_figures.spectra(level, sea),
    )


def _time_section(
    levels: tuple[BreakwaterLevel, ...], decides: SeaNumbers | None
) -> Callable[[BreakwaterLevel], Sequence[Block | None]]:
    """Return the composer of the runs: animations for as many as a mail can carry, the worst runs first."""
    records: dict[tuple[str, str, str], tuple[BreakwaterLevel, Sea, TimeRecord]] = {}
    for level in levels:
        for name in level.sea_names():
            sea = level.sea(name)
            for run in sea.runs():
                record = read_record(level, run)
                if record is not None:
                    records[level.name, name, run.name] = (level, sea, record)

    def severity(entry: tuple[str, str, str]) -> float:
        record = records[entry][2]
        if record.run.name == "event":  # lines in motion stand before the same record with lines at rest
            return math.inf
        peak = (
            record.tension[record.at, record.governing_line]
            if record.governing_line >= 0
            else abs(record.pose[record.at, 0])
        )
        return float(peak)

    animated = set(sorted(records, key=severity, reverse=True)[:MOST_ANIMATIONS])
    bins = max(POINTS_OF_ALL_RECORDS // max(len(records), 1) // 16, 60)

    def compose_level(level: BreakwaterLevel) -> Sequence[Block | None]:
        options = []
        for name in level.sea_names():
            mine = [entry for entry in records if entry[:2] == (level.name, name)]
            if not mine:
                continue
            worst = max(range(len(mine)), key=lambda number: severity(mine[number]))
            runs = tuple(
                Option(_run_words(records[entry][2]), run_blocks(*records[entry], entry in animated, bins))
                for entry in mine
            )
            options.append(Option(name, (Choice(f"run-{name}", "Run", runs, worst, print_all=False),)))
        if not options:
            return ()
        default = next(
            (n for n, option in enumerate(options) if decides is not None and option.label == decides.sea), 0
        )
        return (Choice("sea", "Sea state", tuple(options), default),)

    return compose_level


def _run_words(record: TimeRecord) -> str:
    period, attributes = attribute_number(record.run, "period"), record.run.attributes
    named = {"event": "largest event, lines in motion", "realisation": "whole record"}
    words = f"T = {period:.4g} s" if period > 0.0 else named.get(record.run.name, record.run.name.replace("_", " "))
    if "seed" in attributes and "seed" not in words:
        words += f", seed {attributes['seed']}"
    status = str(attributes.get("status", "converged"))
    return words if status in {"converged", ""} else f"{words} ({status.replace('_', ' ')})"


def _sensitivity(level: BreakwaterLevel) -> Sequence[Block | None]:
    return [sea_figures.sensitivity(level, group) for group in level.group.child("sensitivity").children()]


__all__ = ["MODES", "compose"]
