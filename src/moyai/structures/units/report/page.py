"""Compose the report of a row of units: what governs, the waves around it, connectors, motions, lines."""

from __future__ import annotations

from collections.abc import Callable

from moyai.core.results import Result
from moyai.report.document import Block, Choice, Document, Option
from moyai.report.general_page import case_listing, chapters, notice_blocks, page_of
from moyai.report.headlines import headline_figures
from moyai.report.levels import at_each_level
from moyai.report.reading import Group, root_of
from moyai.structures.units.report import figures
from moyai.structures.units.report.time import time_blocks


def compose(result: Result) -> Document:
    """Compose the report of a row of units.

    Parameters
    ----------
    result : Result
        With the layout of ``docs/result_layout.md``; whatever is absent is left out.

    Returns
    -------
    Document
    """
    root = root_of(result)
    levels = tuple(child for child in root.children() if "water_depth" in child.attributes)

    sections = chapters(
        ("summary", "Summary", lambda: (*_summary(result), *notice_blocks(result))),
        ("row", "The row", lambda: at_each_level(levels, _row)),
        ("waves", "Waves around the row", lambda: at_each_level(levels, _maps)),
        (
            "connectors",
            "Connectors",
            lambda: at_each_level(levels, lambda level: _tables(level, figures.connector_table)),
        ),
        ("motions", "Motions", lambda: at_each_level(levels, _motions)),
        ("time", "Records in time", lambda: at_each_level(levels, _records)),
        ("lines", "Lines", lambda: at_each_level(levels, lambda level: _tables(level, figures.line_table))),
        ("input", "Input", lambda: (case_listing(root),)),
    )
    return page_of(result, _subtitle(levels), sections)


def _row(level: Group) -> list[Block | None]:
    return [figures.plan(level), *figures.sections(level), figures.rest_table(level)]


def _summary(result: Result) -> tuple[Block, ...]:
    numbers = headline_figures(result)
    return () if numbers is None else (numbers,)


def _subtitle(levels: tuple[Group, ...]) -> str:
    if not levels:
        return "Floating row of units"
    statics = levels[0].child("statics")
    count = len(statics.labels("unit"))
    length = float(statics.attributes.get("length", float("nan")))
    return f"Floating row of {count} unit{'s' if count != 1 else ''} of {length:g} m"


def _periods(sea: Group) -> tuple[int | None, ...]:
    """Return the rows of a sea: every period of regular waves, one of an irregular sea."""
    count = len(sea.labels("period"))
    return tuple(range(count)) if count else (None,)


def _maps(level: Group) -> list[Block | None]:
    blocks: list[Block | None] = []
    for sea in level.child("map").children():
        options = []
        for period in _periods(sea):
            drawing = figures.wave_map(level, sea, period)
            if drawing is not None:
                label = sea.name if period is None else f"T = {float(sea.require('period', 'period')[period]):g} s"
                options.append(Option(label, (drawing,)))
        if len(options) == 1:
            blocks.append(options[0].blocks[0])
        elif options:
            blocks.append(Choice(f"map-{level.name}-{sea.name}", "Period", tuple(options)))
        blocks += [figures.points_table(level, sea), figures.along_line(level, sea)]
    return blocks


def _tables(level: Group, table: Callable[[Group, Group, int | None], Block | None]) -> list[Block | None]:
    """Return a table of every sea: of the time domain where it was run, that of the frequency domain behind it."""
    blocks: list[Block | None] = []
    for sea in level.child("frequency").children():
        timed = level.child("time").child(sea.name)
        domains = [("time", timed), ("frequency", sea)] if timed.exists else [("frequency", sea)]
        options = []
        for domain, group in domains:
            for period in _periods(group):
                found = table(level, group, period)
                if found is not None:
                    label = sea.name if period is None else f"T = {float(sea.require('period', 'period')[period]):g} s"
                    options.append(Option(f"{label}, {domain} domain" if timed.exists else label, (found,)))
        if len(options) == 1:
            blocks.append(options[0].blocks[0])
        elif options:
            blocks.append(Choice(f"{table.__name__}-{level.name}-{sea.name}", "Period or domain", tuple(options)))
    return blocks


def _records(level: Group) -> list[Block | None]:
    return [block for sea in level.child("time").children() for block in time_blocks(level, sea)]


def _motions(level: Group) -> list[Block | None]:
    curves: list[Block | None] = [figures.over_period(level, sea) for sea in level.child("frequency").children()]
    return [*curves, *_tables(level, figures.motion_table)]
