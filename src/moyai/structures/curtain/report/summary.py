"""The first page of the report of a curtain: headlines, the models behind them, the load of every component."""

from __future__ import annotations

import math

from moyai.core.results import Result
from moyai.report.document import Block, Column, Paragraph, Table
from moyai.report.formatting import display_unit
from moyai.report.general_page import notice_blocks
from moyai.report.headlines import headline_figures
from moyai.structures.curtain.report.reading import Component, CurtainLevel, components, governing_component, words


def summary_blocks(result: Result, levels: tuple[CurtainLevel, ...]) -> tuple[Block, ...]:
    """Return the headlines, the models behind them, the components of every water level, and the notices.

    Parameters
    ----------
    result : Result
    levels : tuple of CurtainLevel

    Returns
    -------
    tuple of Block
    """
    found = (
        headline_figures(result) or Paragraph("The result holds no governing numbers."),
        models_table(levels),
        _components_table(levels, governing_component(levels)),
    )
    return (*(block for block in found if block is not None), *notice_blocks(result))


def models_table(levels: tuple[CurtainLevel, ...]) -> Table | None:
    """Return which model governs, one row for each model and role; levels that agree share a row."""
    rows: dict[tuple[str, str, str], tuple[list[str], str]] = {}
    for level in levels:
        group = level.part("models")
        names = group.labels("model")
        reported = [words(group, f"model_{what}", "model", len(names)) for what in ("of", "role", "reason")]
        for name, of, role, reason in zip(names, *reported, strict=True):
            rows.setdefault((name, of, role), ([], reason))[0].append(level.name)
    if not rows:
        return None
    return Table(
        "which-model-governs",
        "Which model governs",
        (
            Column("Model", [name for name, _, _ in rows]),
            Column("Gives", [of for _, of, _ in rows]),
            Column("Role", [role for _, _, role in rows]),
            Column(
                "Water level", [", ".join(where) if len(where) < len(levels) else "all" for where, _ in rows.values()]
            ),
            Column("Why", [reason for _, reason in rows.values()]),
        ),
        note="A bound says 'at most'; a comparison is not used for design. A model out of its range never governs.",
        emphasised=tuple(number for number, (_, _, role) in enumerate(rows) if role == "governs"),
    )


def _components_table(levels: tuple[CurtainLevel, ...], worst: tuple[CurtainLevel, Component] | None) -> Table | None:
    """Return the utilisation of every component at every water level."""
    rows = [
        (level, entry) for level in levels for entry in components(level) if math.isfinite(entry.loads["governing"])
    ]
    if not rows:
        return None
    emphasised = tuple(
        number
        for number, (level, entry) in enumerate(rows)
        if worst is not None and level.name == worst[0].name and entry.name == worst[1].name
    )
    shown = [display_unit(entry.unit, entry.loads["governing"]) for _, entry in rows]
    paired = list(zip(rows, shown, strict=True))
    bounded = any(entry.bound for _, entry in rows)
    return Table(
        "governing-loads",
        "Components at every water level",
        (
            Column("Water level", [level.name for level, _ in rows]),
            Column("Component", [entry.name for _, entry in rows]),
            Column("Unit", [unit.name for unit in shown]),
            Column("Governing load", [e.loads["governing"] * u.factor for (_, e), u in paired], uniform=False),
            *((Column("Known as", [entry.bound or "value" for _, entry in rows]),) if bounded else ()),
            Column("Governed by", [entry.governing for _, entry in rows]),
            Column("Capacity", [entry.capacity * unit.factor for (_, entry), unit in paired], uniform=False),
            Column("Safety factor", [entry.safety_factor for _, entry in rows]),
            Column("Utilisation", [entry.utilisation for _, entry in rows]),
        ),
        emphasised=emphasised,
        failed=tuple(number for number, (_, entry) in enumerate(rows) if entry.utilisation > 1.0 and not entry.bound),
        collapsed=len(rows) > 16,
    )


__all__ = ["models_table", "summary_blocks"]
