"""Compose the report of a submerged member: governing forces first, then what they rest on."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from moyai.core.results import Result
from moyai.report.document import (
    Block,
    Choice,
    Document,
    Option,
    Paragraph,
)
from moyai.report.formatting import format_quantity
from moyai.report.general_page import case_listing, chapters, notice_blocks, page_of
from moyai.report.headlines import headline_figures
from moyai.report.levels import at_each_level
from moyai.report.reading import Group, root_of
from moyai.structures.member.report import figures
from moyai.structures.member.waves import CURRENT_ALONE

MOST_RUNS = 12


def compose(result: Result) -> Document:
    """Compose the report of a submerged member.

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

    def each_level(compose_level: Callable[[Group], Sequence[Block | None]]) -> tuple[Block, ...]:
        return at_each_level(levels, compose_level)

    purpose = str(root.attributes.get("purpose", ""))
    sections = chapters(
        ("summary", "Summary", lambda: (*_summary(result, purpose), *notice_blocks(result))),
        ("input", "Input", lambda: (case_listing(root), *each_level(_input))),
        ("law", "Inertia and circulation over KC", lambda: each_level(figures.over_keulegan_carpenter)),
        ("seas", "Sea states", lambda: each_level(_seas)),
        ("surface", "Free surface", lambda: each_level(lambda level: [figures.surface_table(level)])),
        ("time", "Forces over time", lambda: each_level(_time)),
    )
    return page_of(result, _subtitle(levels), sections)


def _subtitle(levels: tuple[Group, ...]) -> str:
    parts = ["Submerged member"]
    if levels:
        member = levels[0].child("member")
        parts.append(str(member.attributes.get("section", "")))
        sizes = [format_quantity(member.value(name), "m") for name in ("width", "height", "length")]
        parts.append(" × ".join(sizes))
    return ", ".join(part for part in parts if part)


def _summary(result: Result, purpose: str) -> tuple[Block, ...]:
    figures_of = headline_figures(result)
    if figures_of is None:
        return (Paragraph("The result holds no forces."),)
    if _current_alone(result):
        return (figures_of,)
    said = (
        "The circulation of orbital flow is left out, which keeps the larger inertia force (purpose: extreme)."
        if purpose == "extreme"
        else "The circulation of orbital flow is counted (purpose: response); it lowers the inertia force."
    )
    return (figures_of, Paragraph(said))


def _current_alone(result: Result) -> bool:
    """Whether no wave was run."""
    return any(path.endswith(f"/waves/{CURRENT_ALONE}") for path in result.tree.groups)


def _input(level: Group) -> list[Block | None]:
    return [figures.member_table(level), figures.section_drawing(level)]


def _seas(level: Group) -> list[Block | None]:
    blocks: list[Block | None] = []
    for sea in level.child("waves").children():
        blocks += [
            figures.force_table(level, sea),
            figures.coefficient_table(level, sea),
            figures.along_member(level, sea),
            figures.bending_along(level, sea),
        ]
    return blocks


def _time(level: Group) -> list[Block | None]:
    options, largest = [], []
    for sea in level.child("time").children():
        runs = sea.children()
        step = max(1, math.ceil(len(runs) / MOST_RUNS))
        # counted from the end, so that the last and highest wave is among them
        for run in runs[::-1][::step][::-1]:
            figure = figures.force_over_time(level, sea, run)
            force = run.real("force", "time", "component")
            if figure is not None and force is not None:
                options.append(Option(f"{sea.name}: {run.attributes.get('wave', run.name)}", (figure,)))
                largest.append(float((force**2).sum(axis=1).max()))
    if not options:
        return []
    return [Choice(f"run-{level.name}", "Wave", tuple(options), largest.index(max(largest)), print_all=False)]
