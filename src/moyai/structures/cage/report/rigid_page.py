"""Compose the report of a rigid cage: governing motions and tensions first, then what they rest on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np

from moyai.core.results import Result
from moyai.report.document import Block, Choice, Document, Option, Paragraph
from moyai.report.formatting import format_quantity
from moyai.report.general_page import case_listing, chapters, notice_blocks, page_of
from moyai.report.headlines import headline_figures
from moyai.report.levels import at_each_level
from moyai.report.reading import Group, root_of
from moyai.structures.cage.report import rigid_figures as figures
from moyai.structures.cage.report import rigid_tables as tables
from moyai.structures.cage.report.rigid_drawing import elevation_drawing, orbit_drawing
from moyai.structures.cage.report.rigid_reading import CageLevel, RigidRecord, levels_of, read_record
from moyai.structures.cage.report.rigid_time import run_blocks

MOST_RUNS = 12
MOST_ANIMATIONS = 6
BINS = 1200


def compose(result: Result) -> Document:
    """Compose the report of a rigid cage.

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

    literal = str(root.attributes.get("equations", "")) == "literal"
    sections = chapters(
        ("summary", "Summary", lambda: (*_summary(result, literal), *notice_blocks(result))),
        ("cage", "Cage and mooring", lambda: each_level(_cage)),
        ("motions", "Motions", lambda: each_level(_motions)),
        ("tensions", "Line tensions", lambda: each_level(_tensions)),
        ("stiffness", "Line stiffness", lambda: each_level(_stiffness)),
        ("time", "Motion over time", lambda: each_level(_time)),
        ("input", "Input", lambda: (case_listing(root),)),
    )
    return page_of(result, _subtitle(levels, literal), sections)


def _subtitle(levels: tuple[CageLevel, ...], literal: bool) -> str:
    parts = ["Rigid net cage"]
    if levels:
        cage = levels[0].part("cage")
        x, z = cage.array("outline_x", "corner"), cage.array("outline_z", "corner")
        if x is not None and z is not None:
            parts.append(f"{format_quantity(float(np.ptp(x)), 'm')} × {format_quantity(float(np.ptp(z)), 'm')}")
    if literal:
        parts.append("equations as printed")
    return ", ".join(parts)


def _summary(result: Result, literal: bool) -> tuple[Block, ...]:
    found = headline_figures(result)
    blocks: list[Block] = [] if found is None else [found]
    if literal:
        blocks.append(Paragraph("The equations are those in print, errors included: no result to design by."))
    return tuple(blocks)


def _cage(level: CageLevel) -> list[Block | None]:
    return [
        elevation_drawing(level),
        tables.rest_table(level),
        tables.line_table(level),
        tables.cage_table(level),
        tables.modes_table(level),
    ]


def _records(level: CageLevel, sea: Group) -> list[RigidRecord]:
    runs = level.part(f"time/{sea.name}").children()
    return [record for run in runs if (record := read_record(run)) is not None]


def _motions(level: CageLevel) -> list[Block | None]:
    blocks: list[Block | None] = []
    for sea in level.part("waves").children():
        blocks += [
            tables.motion_table(level, sea),
            figures.response_figure(level, sea),
            orbit_drawing(level, sea.name, _records(level, sea)),
        ]
    return blocks


def _tensions(level: CageLevel) -> list[Block | None]:
    return [
        block
        for sea in level.part("waves").children()
        for block in (tables.tension_table(level, sea), *tables.realisations_blocks(level, sea))
    ]


def _stiffness(level: CageLevel) -> list[Block | None]:
    return [block for sea in level.part("sensitivity").children() for block in figures.sensitivity_blocks(level, sea)]


def _time(level: CageLevel) -> list[Block | None]:
    options: list[Option] = []
    largest: list[float] = []
    for sea in level.part("waves").children():
        records = _records(level, sea)
        step = max(1, math.ceil(len(records) / MOST_RUNS))
        for number, record in enumerate(records[::-1][::step][::-1]):
            blocks = run_blocks(level, sea.name, record, number < MOST_ANIMATIONS, BINS)
            options.append(Option(f"{sea.name}: {record.label}", blocks))
            value = float(record.peak.max()) if record.peak.size else float(np.abs(record.pose[:, 2]).max())
            largest.append(value)
    if not options:
        return []
    return [Choice(f"run-{level.name}", "Wave", tuple(options), largest.index(max(largest)), print_all=False)]
