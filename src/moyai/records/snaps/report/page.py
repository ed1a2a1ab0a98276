"""Compose the report of ``moyai measure snaps``: tensions of every run, C_T over each number, models over them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.results import Result
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
from moyai.report.encoding import slug
from moyai.report.general_page import case_listing, closing_section, notice_blocks, provenance, report_title
from moyai.report.reading import Group, root_of

_SYMBOLS = {"froude": "Fr = U/√(gh)", "span_ratio": "B/l", "depth_ratio": "d/h", "cauchy": "C_E"}
_SHOWN = ("A", "A with drag", "A with memory", "AB")
GENERATED = "The records of this set were computed, not measured: they show what the evaluation finds again."


def compose(result: Result) -> Document:
    """Compose the report of ``moyai measure snaps``.

    Parameters
    ----------
    result : Result
        Groups ``runs``, ``agreement``, ``powers`` and ``curves``.

    Returns
    -------
    Document
    """
    root = root_of(result)
    runs, agreement, powers, curves = (root.child(name) for name in ("runs", "agreement", "powers", "curves"))
    generated = root.attributes.get("origin") == "generated"
    head: list[Block] = [Paragraph(GENERATED)] if generated else []
    word = "generated" if generated else "measured"
    sections = (
        Chapter(
            "summary",
            "Summary",
            (*head, _key_figures(runs, agreement), *notice_blocks(result), _agreement_table(agreement)),
        ),
        Chapter("runs", "Runs", tuple(_run_tables(runs))),
        Chapter("figures", "Impact tension and its numbers", tuple(_number_figures(runs, curves, word))),
        Chapter("powers", "Powers of the numbers", (_power_table(powers),)),
        Chapter("input", "Input", (case_listing(root),)),
        closing_section(result),
    )
    return Document(
        title=report_title(result),
        subtitle=f"{len(runs.labels('run'))} {word} flume runs",
        status=result.status,
        message=result.message,
        sections=sections,
        provenance=provenance(result),
    )


def _values(group: Group, name: str, *dims: str) -> Array:
    found = group.array(name, *dims)
    assert found is not None
    return found


def _key_figures(runs: Group, agreement: Group) -> Block:
    tension, coefficient = (
        _values(runs, "both_cables_impact_tension", "run"),
        _values(runs, "tension_coefficient", "run"),
    )
    items = [
        KeyFigure("Runs", str(tension.size), ", ".join(dict.fromkeys(_texts(runs)))),
        KeyFigure(
            "Impact tension", f"{tension.min():.3g} to {tension.max():.3g} N", "peak less drag level, both cables"
        ),
        KeyFigure("C_T", f"{coefficient.min():.3g} to {coefficient.max():.3g}", "by the speed of the current"),
    ]
    models, ratio = agreement.labels("impact_model"), _values(agreement, "ratio", "impact_model")
    scatter = _values(agreement, "scatter", "impact_model")
    for model in _SHOWN:
        if model in models:
            place = models.index(model)
            items.append(
                KeyFigure(f"Model {model} over record", f"{ratio[place]:.2f}", f"scatter {100 * scatter[place]:.0f} %")
            )
    return KeyFigures(tuple(items))


def _texts(group: Group, name: str = "cable_material") -> list[str]:
    assert group.node is not None
    return [str(value) for value in group.node.coords[name].values]


def _agreement_table(agreement: Group) -> Block:
    names = (
        ("ratio", "model over record"),
        ("ratio_low", "lower bound"),
        ("ratio_high", "upper bound"),
        ("scatter", "scatter of the logarithm"),
    )
    columns = [Column("Model", agreement.labels("impact_model"))]
    columns += [Column(title, list(_values(agreement, name, "impact_model")), uniform=False) for name, title in names]
    return Table(
        "agreement", "Models over the records", tuple(columns),
        note="Geometric mean over all runs with its bounds of 95 %; nothing is fitted.",
    )  # fmt: skip


def _run_tables(runs: Group) -> list[Block]:
    names = runs.labels("run")
    singles = (
        ("current_speed", "U", "m/s"), ("start_speed", "start speed", "m/s"), ("draught", "d", "m"),
        ("length", "l", "m"), ("both_cables_peak_tension", "peak", "N"),
        ("both_cables_plateau_tension", "drag level", "N"),
        ("both_cables_impact_tension", "impact", "N"), ("rise_time", "rise", "s"), ("tension_coefficient", "C_T", ""),
        ("froude", "Fr", ""), ("span_ratio", "B/l", ""), ("depth_ratio", "d/h", ""), ("cauchy", "C_E", ""),
    )  # fmt: skip
    # tensions with their own decimals: the impact of a steel wire is a hundred times that of a fishing line
    columns = [
        Column(title, list(_values(runs, name, "run")), unit, uniform=unit != "N" and name != "tension_coefficient")
        for name, title, unit in singles
    ]
    head = [Column("Run", names), Column("Cable", _texts(runs))]
    # two tables: one of all columns is wider than a page
    measured = tuple(column for column in columns if column.unit)
    numbers = tuple(column for column in columns if not column.unit)
    cables = runs.labels("cable")
    apart = [Column("Run", names)]
    for place, cable in enumerate(cables):
        for name, title in (("peak", "peak"), ("plateau", "drag level"), ("impact", "impact")):
            values = _values(runs, f"cable_{name}_tension", "run", "cable")[:, place]
            apart.append(Column(f"{cable} {title}", list(values), "N", uniform=False))
    models = runs.labels("impact_model")
    tension = _values(runs, "model_tension", "run", "impact_model")
    over = tension / _values(runs, "both_cables_impact_tension", "run")[:, None]
    ratios = [Column("Run", names)] + [Column(model, list(over[:, k])) for k, model in enumerate(models)]
    return [
        Table("runs", "Runs", (*head, *measured), note="Tensions are sums of both cables."),
        Table(
            "numbers", "Numbers of the runs", (*head, *numbers), note="C_T is the impact by the speed of the current."
        ),
        Table("cables", "Each cable", tuple(apart), note="Impact is peak less drag level of the cable."),
        Table("models", "Model over record, run by run", tuple(ratios)),
    ]


def _scatter(runs: Group, material: str, word: str) -> Block:
    """Draw records against models for one material (figure 16 of the paper)."""
    own = np.array(_texts(runs)) == material
    measured = _values(runs, "both_cables_impact_tension", "run")[own]
    models, tension = runs.labels("impact_model"), _values(runs, "model_tension", "run", "impact_model")[own]
    shown = [model for model in _SHOWN if model in models]
    series = [
        Series(f"model {model}", {"model": tension[:, models.index(model)]}, measured, 0, tone + 1, style="points")
        for tone, model in enumerate(shown)
    ]
    reach = np.array([0.0, float(measured.max())])
    series.append(Series("equal", {"model": reach}, reach, 0, 0))
    return Figure(
        slug("impact", material), f"Impact tension, record against model: {material}",
        (Abscissa("model", "impact tension of the model", "N"),),
        (Panel(f"impact tension, {word}", "N", from_zero=True),), tuple(series),
        "Sum of both cables, drag level taken off.",
    )  # fmt: skip


def _number_figures(runs: Group, curves: Group, word: str) -> list[Block]:
    """Draw C_T over Fr, B/l and d/h for each material, over C_E for all runs (figures 17 to 20 of the paper)."""
    materials = np.array(_texts(runs))
    blocks: list[Block] = []
    for material in dict.fromkeys(materials):
        own = materials == material
        found = [
            _over(runs, curves, number, str(material), own, word) for number in ("froude", "span_ratio", "depth_ratio")
        ]
        blocks += [_scatter(runs, str(material), word), *(block for block in found if block is not None)]
    last = _over(runs, curves, "cauchy", "all cables", np.ones(materials.size, dtype=bool), word)
    return [*blocks, *([] if last is None else [last])]


def _over(runs: Group, curves: Group, number: str, cable: str, own: NDArray[np.bool_], word: str) -> Block | None:
    """Return C_T over one number with model A at each run and along its curve; ``None`` where the number is one."""
    x = _values(runs, number, "run")[own]
    if np.ptp(x) < 1e-6 * x.max():
        return None
    models = runs.labels("impact_model")
    measured = _values(runs, "tension_coefficient", "run")[own]
    model = _values(runs, "model_tension_coefficient", "run", "impact_model")[own]
    series = [Series(word, {"x": x}, measured, 0, 0, style="points")]
    for tone, name in enumerate(("A", "A with drag"), 1):
        if name in models:
            points = model[:, models.index(name)]
            series.append(Series(f"model {name}, same run", {"x": x}, points, 0, tone, style="points"))
    of, cables = np.array(_texts(curves, "curve_of")), np.array(_texts(curves, "curve_cable"))
    along, coefficient = (_values(curves, f"curve_{name}", "curve", "point") for name in ("number", "coefficient"))
    for place in np.flatnonzero((of == number) & (cables == cable)):
        series.append(Series("curve of model A", {"x": along[place]}, coefficient[place], 0, 1))
    symbol = _SYMBOLS[number]
    return Figure(
        slug("over", number, cable), f"C_T over {symbol}: {cable}", (Abscissa("x", symbol),),
        (Panel("C_T", from_zero=True),), tuple(series),
        "Curve: the other numbers at the median of these runs; runs differ in the others as well.",
    )  # fmt: skip


def _power_table(powers: Group) -> Block:
    numbers, rows = powers.labels("number"), powers.labels("fit_of")
    values, low, high = (
        _values(powers, name, "fit_of", "number") for name in ("exponent", "exponent_low", "exponent_high")
    )
    columns = [Column("C_T of", rows)]
    for k, number in enumerate(numbers):
        columns.append(Column(f"power of {_SYMBOLS[number].split(' ')[0]}", list(values[:, k]), uniform=False))
        columns.append(Column("from", list(low[:, k]), uniform=False))
        columns.append(Column("to", list(high[:, k]), uniform=False))
    columns.append(Column("scatter", list(_values(powers, "product_scatter", "fit_of"))))
    return Table(
        "powers", "C_T as a product of powers", tuple(columns),
        note="Least squares of logarithms over all runs, with bounds of 95 %; not known where numbers vary only "
        "together or runs are too few.",
    )  # fmt: skip
