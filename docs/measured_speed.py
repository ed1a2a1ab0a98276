"""Sphinx extension: what commands cost, as ``benchmarks/bench_felt.py --json`` measured it on two cores.

``{measured-speed}`` draws the rows of ``docs/validation/speed.json``: processor seconds and their ratio to the
yardstick of the machine that ran them, which is what compares between machines.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from html import escape
from pathlib import Path
from typing import Any

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

RECORDS = Path(__file__).resolve().parent / "validation" / "speed.json"
COLOURS = {"first": "#9db8d2", "wheel": "#5f93bd", "warm": "#1b6ca8"}
_ROW, _LEFT, _WIDTH = 17, 130, 520


def records() -> list[dict[str, Any]]:
    """Return the rows that stand next to the page."""
    return list(json.loads(RECORDS.read_text(encoding="utf-8")))


def bars(rows: Sequence[dict[str, Any]]) -> str:
    """Return the ratios to the yardstick as SVG, a bar a row."""
    height, most = 30 + _ROW * len(rows), max(row["ratio"] for row in rows)
    parts = [
        f'<rect x="{_LEFT + 90 * number}" y="6" width="11" height="11" fill="{colour}"/>'
        f'<text x="{_LEFT + 16 + 90 * number}" y="15">{escape(state)}</text>'
        for number, (state, colour) in enumerate(COLOURS.items())
    ]
    for number, row in enumerate(rows):
        y, width = 26 + _ROW * number, max((_WIDTH - _LEFT - 50) * row["ratio"] / most, 1.0)
        colour = COLOURS[row["state"]]
        parts.append(
            f'<text x="{_LEFT - 6}" y="{y + 11}" text-anchor="end">{escape(row["command"])}</text>'
            f'<rect x="{_LEFT}" y="{y}" width="{width:.1f}" height="{_ROW - 4}" fill="{colour}"/>'
            f'<text x="{_LEFT + width + 5:.1f}" y="{y + 11}">{row["ratio"]:.3g}</text>'
        )
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {_WIDTH} {height}" font-family="sans-serif" '
        f'font-size="11" fill="#1b2430"><rect width="100%" height="100%" fill="#fff"/>{"".join(parts)}</svg>'
    )


def table(rows: Sequence[dict[str, Any]]) -> str:
    """Return the rows as an HTML table."""
    lines = [
        f"<tr><td>{escape(row['command'])}</td><td>{row['state']}</td><td>{row['seconds']:.3g}</td>"
        f"<td>{row['elapsed']:.3g}</td>"
        f"<td>{row['ratio']:.3g}</td><td>{row['memory']}</td></tr>"
        for row in rows
    ]
    heads = (
        "command",
        "state",
        "processor seconds",
        "elapsed seconds",
        "processor seconds over the yardstick",
        "memory, MB",
    )
    return (
        '<div class="table-wrapper"><table class="docutils validation"><thead><tr>'
        f"{''.join(f'<th>{head}</th>' for head in heads)}</tr></thead><tbody>{''.join(lines)}</tbody></table></div>"
    )


class MeasuredSpeed(SphinxDirective):
    """Figure and table of the records."""

    def run(self) -> list[nodes.Node]:
        """Return both."""
        from validation_results import figure

        rows = records()
        self.env.note_dependency(str(RECORDS))
        caption = "Processor time of each command over that of the yardstick: first, first of a wheel, warm."
        drawn = figure(bars(rows), caption)
        return [nodes.raw("", drawn + table(rows), format="html")]


def setup(app: Sphinx) -> dict[str, bool]:
    """Register the directive."""
    app.add_directive("measured-speed", MeasuredSpeed)
    return {"parallel_read_safe": True}
