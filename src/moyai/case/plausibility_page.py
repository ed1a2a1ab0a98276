"""The table of plausible ranges as Markdown, made from the data, so that it cannot fall behind them.

``python -m moyai.case.plausibility_page docs/answer/plausibility.md`` renews everything below the mark in that page.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

from moyai.core.kinds import structure_kinds
from moyai.tables.plausible_ranges import PlausibleRange, all_ranges, range_sources

MARK = "<!-- made by: python -m moyai.case.plausibility_page docs/answer/plausibility.md -->"
_TITLES = {
    "kind": "Bounds of every kind of quantity",
    "*": "Site, waves, wind, current",
    **{name: name.capitalize() for name in structure_kinds()},
}


def plausibility_markdown() -> str:
    """Return the sources and the table of every kind of structure."""
    rows = all_ranges()
    lines = ["## Sources", ""]
    lines += [f"- **{letter}** {text}." for letter, text in range_sources().items()]
    for structure, title in _TITLES.items():
        lines += [
            "",
            f"## {title}",
            "",
            "| quantity | meaning | usually | possible | source |",
            "|---|---|---|---|---|",
        ]
        lines += [_line(row) for row in rows if row.structure == structure]
    return "\n".join(lines) + "\n"


def _line(row: PlausibleRange) -> str:
    unit = f" {row.unit}" if row.unit else ""
    usual = "" if row.usual == row.possible else f"{_between(row.usual)}{unit}"
    possible = f"{_between(row.possible)}{unit}" if _between(row.possible) else ""
    cells = (f"`{row.quantity}`" if row.structure != "kind" else row.quantity, row.what, usual, possible, row.source)
    return "| " + " | ".join(cell.replace("|", "\\|") for cell in cells) + " |"


def _between(limits: tuple[float, float]) -> str:
    low, high = limits
    if math.isinf(high):
        return f"from {low:g}" if low > 0.0 else ""
    return f"{low:g} to {high:g}" if low > 0.0 else f"to {high:g}"


def renew(page: str) -> str:
    """Return a page with everything below the mark made again."""
    return page[: page.index(MARK)] + MARK + "\n\n" + plausibility_markdown()


if __name__ == "__main__":
    target = Path(sys.argv[1])
    target.write_text(renew(target.read_text(encoding="utf-8")), encoding="utf-8", newline="\n")
