"""The report of ``moyai compare``: overlay, scatter and figures of agreement of every pair."""

from __future__ import annotations

from typing import Any

import numpy as np

from moyai.core.results import Result
from moyai.records.reading.record import instant_text
from moyai.report.decimate import envelope_indices
from moyai.report.document import (
    Abscissa,
    Block,
    Chapter,
    Column,
    Document,
    Figure,
    KeyFigure,
    KeyFigures,
    Panel,
    Series,
    Table,
)
from moyai.report.general_page import closing_section, notice_blocks, provenance, report_title

MOST_POINTS = 4000


def compose(result: Result) -> Document:
    """Compose the report of a comparison.

    Parameters
    ----------
    result : Result

    Returns
    -------
    Document
    """
    tree: Any = result.tree
    names = list(tree.children)
    figures = [np.asarray(tree[name]["agreement"].values, dtype=float) for name in names]
    words = [str(value) for value in tree[names[0]]["figure"].values]
    columns = [Column("pair", [str(tree[name].attrs["label"]) for name in names])]
    columns += [
        Column(word, [float(row[place]) for row in figures], digits=4, uniform=False)
        for place, word in enumerate(words)
    ]
    table = Table(
        "agreement", "Agreement", tuple(columns), "Bias and root mean square in the unit of the variable (SI)."
    )
    skill = words.index("skill (Nash and Sutcliffe)")
    items = tuple(
        KeyFigure(str(tree[name].attrs["label"]), f"skill {row[skill]:.3f}", f"bias {row[1]:.4g}, rms {row[2]:.4g}")
        for name, row in zip(names, figures, strict=True)
    )
    sections = [Chapter("summary", "Summary", (KeyFigures(items[:8]), table, *notice_blocks(result)))]
    for number, name in enumerate(names, 1):
        sections.append(
            Chapter(f"pair-{number}", str(tree[name].attrs["label"]), tuple(_pair(tree[name], number, words)))
        )
    sections.append(closing_section(result))
    return Document(
        title=report_title(result),
        subtitle="comparison",
        status=result.status,
        message=result.message,
        sections=tuple(sections),
        provenance=provenance(result),
    )


def _pair(group: Any, number: int, words: list[str]) -> list[Block]:
    x = np.asarray(group["coordinate"].values, dtype=float)
    model, observed = (np.asarray(group[name].values, dtype=float) for name in ("model", "observed"))
    unit = str(group["model"].attrs.get("units", ""))
    axis, axis_unit = str(group.attrs.get("axis", "")), ""
    if "since 1970" in axis and x.size:  # nobody reads seconds of sixty years
        first, span = float(x[0]), float(x[-1] - x[0])
        axis_unit, divisor = ("d", 86400.0) if span > 3 * 86400.0 else (("h", 3600.0) if span > 7200.0 else ("s", 1.0))
        axis, x = f"time since {instant_text(first, True)}", (x - first) / divisor
    kept = envelope_indices(np.column_stack([model, observed]), MOST_POINTS // 4)
    few = x.size <= 200
    lag = float(group.attrs.get("lag", 0.0))
    series = (
        Series("record", {"x": x[kept]}, observed[kept], 0, 0, "points" if few else "line"),
        Series("model", {"x": x[kept]}, model[kept], 0, 1, "line+points" if few else "line"),
        Series("model minus record", {"x": x[kept]}, (model - observed)[kept], 1, 2, "line"),
    )
    caption = f"The model was moved by {lag:.4g} to fit best." if lag else ""
    blocks: list[Block] = [
        Figure(
            f"overlay-{number}",
            "Model over record",
            (Abscissa("x", axis, axis_unit),),
            (Panel("value", unit), Panel("difference", unit)),
            series,
            caption,
            height=460,
        )
    ]
    thin = slice(None, None, max(x.size // MOST_POINTS, 1))
    pairs = np.isfinite(model) & np.isfinite(observed)
    low, high = (float(f(np.concatenate([model[pairs], observed[pairs]]))) for f in (np.min, np.max))
    blocks.append(
        Figure(
            f"scatter-{number}",
            "Model against record",
            (Abscissa("o", "record", unit),),
            (Panel("model", unit),),
            (
                Series("pairs", {"o": observed[thin]}, model[thin], 0, 0, "points"),
                Series("equal", {"o": np.array([low, high])}, np.array([low, high]), 0, 1, dash="dash", faint=True),
            ),
        )
    )
    if "by_state" in group:
        rows = np.asarray(group["by_state"].values, dtype=float)
        columns = [
            Column(str(group.attrs.get("state", "state")), [str(value) for value in group["state"].values]),
            *(Column(word, list(rows[:, place]), digits=4, uniform=False) for place, word in enumerate(words)),
        ]
        blocks.append(Table(f"by-state-{number}", "By sea state", tuple(columns)))
    return blocks
