"""Compose the report of an identification: coefficients with what is known of them, fits, residuals, bootstrap."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.results import Result
from moyai.report.decimate import envelope_indices
from moyai.report.document import (
    Abscissa,
    Block,
    Chapter,
    Choice,
    Column,
    Document,
    Figure,
    KeyFigure,
    KeyFigures,
    Option,
    Panel,
    Paragraph,
    Series,
    Table,
)
from moyai.report.encoding import slug
from moyai.report.formatting import DASH, format_number
from moyai.report.general_page import case_listing, notice_blocks, page_of
from moyai.report.reading import Group, root_of

COEFFICIENTS = (("inertia", "C_M"), ("drag", "C_D"))


def compose(result: Result) -> Document:
    """Compose the report of ``moyai measure forces``.

    Parameters
    ----------
    result : Result
        Groups ``coefficients`` and ``record``.

    Returns
    -------
    Document
    """
    root = root_of(result)
    found, record = root.child("coefficients"), root.child("record")
    fits = [
        Option(f"component {component}, {method.replace('_', ' ')}", tuple(_fit_figures(record, method, component)))
        for component in found.labels("component")
        for method in found.labels("fit_method")
    ]
    sections = [
        Chapter("summary", "Summary", (*_key_figures(found), *notice_blocks(result), *_tables(found))),
        Chapter("fits", "Fits and residuals", (Choice("fit", "Fit", tuple(fits), print_all=False),) if fits else ()),
        Chapter("spread", "Bootstrap", tuple(_spread_figures(found))),
        Chapter("input", "Input", (case_listing(root),)),
    ]
    return page_of(result, f"Force record {root.attributes.get('record', '')}".strip(), sections)


def _text(found: Group, name: str, method: str, component: str) -> tuple[str, bool]:
    """Return value and uncertainty with the digits that are known."""
    at = _place(found, method, component, name)
    value, low, known = (_entry(found, key, at) for key in ("value", "low", "known"))
    spread = value - low
    if not known or not math.isfinite(spread):
        return "not determined", False
    return _digits(value, spread), True


def _digits(value: float, spread: float) -> str:
    """Return a value up to the first digit of its uncertainty."""
    places = max(0, min(9, -math.floor(math.log10(max(spread, 1e-12)))))
    return f"{value:.{places}f} ± {spread:.{places}f}"


def _fall(found: Group, key: str, spread_key: str, at: tuple[int, int]) -> str:
    """Return the fall of C_M or its gamma with its digits; a dash where there is none, words where it is not known."""
    values = found.array(key, "fit_method", "component")
    if values is None:
        return DASH
    if spread_key:
        spreads = found.array(spread_key, "fit_method", "component")
        spread = math.inf if spreads is None else float(spreads[at])
    else:
        place = (*at, found.labels("coefficient").index("inertia"))
        spread = _entry(found, "value", place) - _entry(found, "low", place)
    value = float(values[at])
    if not math.isfinite(spread) or spread > 0.5 * abs(value):
        return "not determined"
    return _digits(value, spread)


def _place(found: Group, method: str, component: str, name: str) -> tuple[int, int, int]:
    return (
        found.labels("fit_method").index(method),
        found.labels("component").index(component),
        found.labels("coefficient").index(name),
    )


def _entry(found: Group, key: str, at: tuple[int, int, int]) -> float:
    values = found.array(key, "fit_method", "component", "coefficient")
    return math.nan if values is None else float(values[at])


def _key_figures(found: Group) -> tuple[Block, ...]:
    methods, components = found.labels("fit_method"), found.labels("component")
    if not methods:
        return ()
    items = []
    number = found.real("keulegan_carpenter", "component")
    for index, component in enumerate(components):
        for name, symbol in COEFFICIENTS:
            text, known = _text(found, name, methods[0], component)
            detail = f"component {component}, {methods[0].replace('_', ' ')}"
            items.append(KeyFigure(symbol, text, detail, judgement="" if known else "caution"))
        if number is not None:
            items.append(KeyFigure("KC", format_number(float(number[index])), f"component {component}"))
    return (KeyFigures(tuple(items)),)


def _tables(found: Group) -> list[Block]:
    rows: list[list[str | float]] = []
    for component in found.labels("component"):
        for method in found.labels("fit_method"):
            for name, symbol in COEFFICIENTS:
                at = _place(found, method, component, name)
                text, known = _text(found, name, method, component)
                sensitivity = math.radians(_entry(found, "phase_sensitivity", at))
                value = _entry(found, "value", at)
                share = 100.0 * sensitivity / value if known and value else math.nan
                rows.append(
                    [
                        component,
                        method.replace("_", " "),
                        symbol,
                        text,
                        _entry(found, "statistical_half_width", at),
                        _entry(found, "phase_half_width", at),
                        share,
                    ]
                )
    titles = (
        "Component",
        "Method",
        "Coefficient",
        "Value",
        "half width, bootstrap",
        "half width, phase",
        "change per degree of phase [%]",
    )
    blocks: list[Block] = [
        Table(
            "coefficients",
            "Coefficients",
            tuple(Column(title, [row[k] for row in rows], uniform=False) for k, title in enumerate(titles)),
            note="Only digits that the record holds are printed; a coefficient whose uncertainty exceeds half of it is "
            "called not determined.",
        )
    ]
    extra: list[list[str | float]] = []
    for i, method in enumerate(found.labels("fit_method")):
        for c, component in enumerate(found.labels("component")):
            row: list[str | float] = [component, method.replace("_", " ")]
            for key in ("correlation", "condition", "explained", "drag_share"):
                values = found.array(key, "fit_method", "component")
                row.append(math.nan if values is None else float(values[i, c]))
            row.append(_fall(found, "inertia_reduction", "", (i, c)))
            row.append(_fall(found, "equivalent_gamma", "equivalent_gamma_half_width", (i, c)))
            extra.append(row)
    names = (
        "Component",
        "Method",
        "correlation C_M, C_D",
        "condition",
        "variance explained",
        "drag over inertia",
        "fall of C_M",
        "equivalent γ",
    )
    blocks.append(
        Table(
            "conditioning",
            "Conditioning and circulation",
            tuple(Column(title, [row[k] for row in extra], uniform=False) for k, title in enumerate(names)),
            note="The fall of C_M is compared with the ideal coefficient of the section; γ is that of Γ = γ vx vy T.",
        )
    )
    return blocks


def _fit_figures(record: Group, method: str, component: str) -> list[Block]:
    time = record.real("time", "time")
    if time is None or method not in record.labels("fit_method"):
        return [Paragraph(DASH)]
    i, c = record.labels("fit_method").index(method), record.labels("component").index(component)
    force = record.array("force", "time", "component")
    fitted = record.array("fitted_force", "fit_method", "component", "time")
    residual = record.array("residual", "fit_method", "component", "time")
    if force is None or fitted is None or residual is None:
        return [Paragraph(DASH)]
    series = []
    for tone, (label, values, panel) in enumerate(
        (("measured", force[:, c], 0), ("fit", fitted[i, c], 0), ("residual", residual[i, c], 1))
    ):
        keep = np.arange(time.size) if time.size <= 3000 else np.asarray(envelope_indices(values, 1500))
        series.append(Series(label, {"time": time[keep]}, np.asarray(values)[keep], panel, tone))
    return [
        Figure(
            slug("fit", method, component),
            f"Component {component}, {method.replace('_', ' ')}",
            (Abscissa("time", "time", "s"),),
            (Panel("force per length", "N/m"), Panel("residual", "N/m")),
            tuple(series),
            height=440,
        )
    ]


def _spread_figures(found: Group) -> list[Block]:
    samples = found.array("sample", "fit_method", "component", "coefficient", "draw")
    if samples is None or not np.isfinite(samples).any():
        return []
    blocks: list[Block] = []
    for c, component in enumerate(found.labels("component")):
        series = tuple(
            Series(method.replace("_", " "), {"m": samples[i, c, 0]}, samples[i, c, 1], 0, i, style="points")
            for i, method in enumerate(found.labels("fit_method"))
        )
        blocks.append(
            Figure(
                slug("bootstrap", component),
                f"Bootstrap samples, component {component}",
                (Abscissa("m", "C_M"),),
                (Panel("C_D"),),
                series,
                "Each point is one resampled record; the cloud shows spread and correlation.",
            )
        )
    return blocks
