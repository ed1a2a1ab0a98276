"""Compose the report of a network: the governing tension first, then what it rests on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from moyai.core.results import Result
from moyai.report.document import Block, Choice, Document, Option, Paragraph
from moyai.report.formatting import format_quantity
from moyai.report.general_page import case_listing, chapters, notice_blocks, page_of
from moyai.report.headlines import headline_figures
from moyai.report.levels import at_each_level
from moyai.report.reading import root_of
from moyai.structures.network.report import figures, tables
from moyai.structures.network.report.reading import HighestTension, NetworkLevel, governing_of, levels_of
from moyai.structures.network.report.scene import mode_animations, rest_animation, run_animation

MOST_VIEWS = 8


def compose(result: Result) -> Document:
    """Compose the report of a network.

    Parameters
    ----------
    result : Result
        With the layout of ``docs/result_layout.md``; whatever is absent is left out.

    Returns
    -------
    Document
    """
    root, levels = root_of(result), levels_of(result)
    governing = governing_of(levels)
    default = next((n for n, level in enumerate(levels) if governing and level.name == governing.level.name), 0)

    def each_level(compose_level: Callable[[NetworkLevel], Sequence[Block | None]]) -> tuple[Block, ...]:
        return at_each_level(levels, compose_level, default=default)

    def runs(level: NetworkLevel) -> Sequence[Block | None]:
        return _of_runs(level, governing)

    sections = chapters(
        ("summary", "Summary", lambda: (*_summary(result, governing), *notice_blocks(result))),
        ("view", "In motion", lambda: each_level(lambda level: [_views(level, governing)])),
        ("runs", "Runs through time", lambda: each_level(runs)),
        ("rest", "At rest", lambda: each_level(_at_rest)),
        (
            "modes", "Natural modes",
            lambda: each_level(lambda level: [tables.mode_table(level), mode_animations(level)]),
        ),
        ("input", "Input", lambda: (case_listing(root), *each_level(lambda level: [tables.line_table(level)]))),
    )  # fmt: skip
    return page_of(result, _subtitle(levels), sections)


def _subtitle(levels: tuple[NetworkLevel, ...]) -> str:
    if not levels:
        return "Network"
    net = levels[0].network
    count = len(net.labels("line"))
    parts = ["Network", f"{count} line{'s' if count != 1 else ''}" if count else ""]
    nodes = 0 if net.node is None else int(net.node.sizes.get("node", 0))
    parts.append(f"{nodes} nodes")
    depth = levels[0].group.number("water_depth")
    parts.append(f"water depth {format_quantity(depth, 'm')}" if math.isfinite(depth) else "deep water")
    if len(levels) > 1:
        parts.append("water levels " + ", ".join(level.name for level in levels))
    return " · ".join(part for part in parts if part)


def _summary(result: Result, governing: HighestTension | None) -> tuple[Block, ...]:
    figures_of = headline_figures(result)
    if figures_of is None:
        return (Paragraph("The result holds no tensions."),)
    blocks: list[Block | None] = [figures_of, None if governing is None else tables.uncertainty_table(governing.level)]
    return tuple(block for block in blocks if block is not None)


def _views(level: NetworkLevel, governing: HighestTension | None) -> Block | None:
    runs = level.runs()[:MOST_VIEWS]
    if governing is not None and governing.level.name == level.name:
        names = [run.name for run in runs]
        if governing.run.name not in names:
            runs = (*runs[:-1], governing.run)
    options = [(run, run_animation(level, run)) for run in runs]
    known = [Option(run.name, (view,)) for run, view in options if view is not None]
    if not known:
        return None
    names = [option.label for option in known]
    default = names.index(governing.run.name) if governing is not None and governing.run.name in names else 0
    return Choice(f"run-{level.name}", "Run", tuple(known), default, print_all=False)


def _of_runs(level: NetworkLevel, governing: HighestTension | None) -> Sequence[Block | None]:
    options = []
    for run in level.runs():
        found = (
            figures.tension_figure(level, run),
            figures.places_figure(level, run),
            *figures.body_figures(level, run),
            tables.bodies_table(level, run),
            tables.peaks_table(level, run),
            tables.points_table(level, run),
            tables.largest_of_realisations(level, run),
            figures.largest_of_realisations(level, run),
            figures.exceedance_figure(level, run),
            tables.contact_table(level, run),
            figures.energy_figure(level, run),
        )
        blocks = tuple(block for block in found if block is not None)
        if blocks:
            options.append(Option(run.name, blocks))
    if not options:
        return ()
    names = [option.label for option in options]
    default = names.index(governing.run.name) if governing is not None and governing.run.name in names else 0
    return (tables.run_table(level), Choice(f"run-{level.name}", "Run", tuple(options), default, print_all=False))


def _at_rest(level: NetworkLevel) -> Sequence[Block | None]:
    return (rest_animation(level), figures.bed_figure(level), *tables.rest_tables(level))
