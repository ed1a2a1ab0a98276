"""Tables that stand on a page of the documentation, and the numbers written in them."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

DOCS = Path(__file__).parents[3] / "docs"
_NUMBER = re.compile(r"(?<![\w.])[+\-−]?\d+(?:\.\d+)?|\bnone\b")
_FENCE = re.compile(r"^(`{3,}|:{3,})")


def tables_of(page: Path) -> dict[str, list[list[str]]]:
    """Return the bodies of the Markdown tables of a page by their heading, the second of one as ``heading 2``."""
    found: dict[str, list[list[str]]] = {}
    heading, fenced, waiting = "", "", []
    for line in [*page.read_text(encoding="utf-8").splitlines(), ""]:
        fence = _FENCE.match(line)
        if fence:
            fenced = "" if fenced else fence[0]
        elif line.startswith("#") and not fenced:
            heading = line.lstrip("# ")
        if line.startswith("|") and not fenced:
            waiting.append([cell.strip() for cell in line.strip()[1:-1].split("|")])
        elif waiting:
            count = sum(name == heading or name.startswith(f"{heading} ") for name in found) + 1
            found[heading if count == 1 else f"{heading} {count}"] = waiting[2:]
            waiting = []
    return found


def numbers_in(cells: Sequence[str]) -> list[tuple[float, float]]:
    """Return the numbers of cells, "none" as zero, each with half a unit of its last digit."""
    found = _NUMBER.findall(", ".join(cells))
    return [
        (0.0, 0.5) if one == "none" else (float(one.replace("−", "-")), 0.5 * 10.0 ** -len(one.partition(".")[2]))
        for one in found
    ]


def differences(rows: Sequence[Sequence[str]], values: Sequence[Sequence[float]]) -> list[str]:
    """Return the numbers of rows that are not the values, rounded to the digits that are written."""
    found = []
    for cells, row in zip(rows, values, strict=True):
        written = numbers_in(cells)
        if len(written) != len(row):
            found.append(f"{cells}: {len(written)} numbers for {len(row)} values, {row}")
            continue
        found += [f"{list(cells)}: {shown:g} for {value:.6g}" for value, (shown, half) in zip(row, written, strict=True)
                  if not abs(value - shown) <= 1.01 * half]  # fmt: skip
    return found
