"""The report of ``moyai fit``: values with intervals, what cannot be distinguished, observed and fitted, residuals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.results import Result
from moyai.core.wording import counted
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
    Paragraph,
    Series,
    Table,
)
from moyai.report.formatting import DASH
from moyai.report.general_page import case_listing, closing_section, notice_blocks, provenance, report_title
from moyai.report.reading import Group

STRONG_CORRELATION = 0.95
"""Correlation from which the interval of one value is three times what it is with the other known: 1/sqrt(1 - r^2)."""


def compose(result: Result) -> Document:
    """Compose the report of a fit.

    Parameters
    ----------
    result : Result
        Group ``fit``.

    Returns
    -------
    Document
    """
    found: Any = result.tree["fit"]
    names = [str(name) for name in found["parameter"].values]
    units = [str(unit) for unit in found["unit"].values]
    columns = {name: _list(found, name) for name in ("value", "standard_error", "lower", "upper")}
    rows = list(zip(names, units, *columns.values(), strict=True))
    figures = KeyFigures(
        tuple(
            KeyFigure(
                name,
                f"{_shown(value, error)} {unit}".strip(),
                f"standard error {error:.2g}; 95 %: {_shown(low, error)} to {_shown(high, error)} {unit}".strip(),
            )
            for name, unit, value, error, low, high in rows
        )
    )
    table = Table(
        "values",
        "Values found",
        (
            Column("parameter", names),
            Column("unit", [unit or DASH for unit in units]),
            Column("value", [_shown(row[2], row[3]) for row in rows], quantities=True),
            Column("standard error", [f"{row[3]:.2g}" for row in rows], quantities=True),
            Column("95 % from", [_shown(row[4], row[3]) for row in rows], quantities=True),
            Column("95 % to", [_shown(row[5], row[3]) for row in rows], quantities=True),
        ),
    )
    unit = _unit(found)
    response = str(found["predicted"].attrs.get("long_name", "")).removeprefix("predicted ")
    mean, rms = (f"{found[name].item():.3g} {unit}".strip() for name in ("bias", "rms"))
    agreement = Paragraph(
        f"Response {response}; prediction less observation over {counted(found.sizes['row'], 'observation')}: "
        f"mean {mean}, root mean square {rms}."
    )
    return Document(
        title=report_title(result),
        subtitle="values of a case found from observations",
        status=result.status,
        message=result.message,
        sections=(
            Chapter("summary", "Summary", (figures, agreement, *notice_blocks(result), table)),
            Chapter("correlations", "What cannot be distinguished", _correlations(found, names)),
            Chapter("observations", "Observed and fitted", _agreement(found)),
            Chapter("input", "Input", (case_listing(Group("", result.tree)),)),
            closing_section(result),
        ),
        provenance=provenance(result),
    )


def _unit(found: Any) -> str:
    unit = str(found["observed"].attrs.get("units", "1"))
    return "" if unit == "1" else unit


def _list(found: Any, name: str) -> list[float]:
    return [float(value) for value in found[name].values]


def _shown(value: float, error: float) -> str:
    """Return a value up to the second digit of its standard error."""
    if not (math.isfinite(value) and math.isfinite(error)) or error <= 0.0:
        return f"{value:.6g}"
    places = 1 - math.floor(math.log10(error))
    return f"{value:.{min(places, 9)}f}" if places >= 0 else f"{round(value, places):.0f}"


def _correlations(found: Any, names: list[str]) -> tuple[Block, ...]:
    matrix = np.asarray(found["correlation"].values, dtype=float)
    if len(names) == 1:
        return (Paragraph("One value was fitted: there is no other that it could be confused with."),)
    words = []
    for i, j in zip(*np.triu_indices(len(names), 1), strict=True):
        if abs(matrix[i, j]) >= STRONG_CORRELATION:
            words.append(
                f"{names[i]} and {names[j]} (correlation {matrix[i, j]:.3f}): a "
                f"{'higher' if matrix[i, j] > 0.0 else 'lower'} value of one goes with a higher value of the other "
                "and changes the prediction little"
            )
    if not np.isfinite(matrix).all():
        said = "The observations do not fix all values: some correlations are not known."
    elif words:
        alike = "; ".join(words)
        said = f"These observations hardly distinguish: {alike}. Observe other states, or fix one value."
    else:
        said = f"No two values have a correlation of {STRONG_CORRELATION:g} or more: all are distinguished."
    shown = [[f"{value:.3f}" if math.isfinite(value) else DASH for value in row] for row in matrix]
    columns = [Column("correlation", names), *(Column(name, [row[k] for row in shown]) for k, name in enumerate(names))]
    return Paragraph(said), Table("correlation", "Correlation of the errors", tuple(columns))


def _agreement(found: Any) -> tuple[Block, ...]:
    observed, predicted = (np.asarray(found[name].values, dtype=float) for name in ("observed", "predicted"))
    ends = np.array([min(observed.min(), predicted.min()), max(observed.max(), predicted.max())])
    unit = _unit(found)
    scatter = Figure(
        "observed-fitted",
        "Observed against fitted",
        (Abscissa("o", "observed", unit),),
        (Panel("fitted", unit),),
        (
            Series("observations", {"o": observed}, predicted, 0, 0, "points"),
            Series("equal", {"o": ends}, ends, 0, 1, dash="dash", faint=True),
        ),
    )
    residual = Figure(
        "residuals",
        "Residuals",
        (Abscissa("o", "observed", unit),),
        (Panel("fitted less observed", unit),),
        (
            Series("residual", {"o": observed}, predicted - observed, 0, 0, "points"),
            Series(
                "zero", {"o": np.array([observed.min(), observed.max()])}, np.zeros(2), 0, 1, dash="dash", faint=True
            ),
        ),
        caption="A slope or a curve in the residuals shows that the model lacks something that no value can replace.",
    )
    return scatter, residual
