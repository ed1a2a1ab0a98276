"""Compose the report of ``moyai measure nets``: coefficients with intervals, laws, reconstructed forces, tensions."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.results import Result
from moyai.records.nets.report.tables import net_table, tension_table, towing_table, wave_table
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
    Mark,
    Option,
    Panel,
    Paragraph,
    Series,
    Table,
)
from moyai.report.encoding import slug
from moyai.report.formatting import format_number
from moyai.report.general_page import case_listing, notice_blocks, page_of
from moyai.report.reading import Group, root_of

_MOST_POINTS = 3000
#: The law of the paper, drawn next to the points
_PAPER = (9.84, 0.36, 84.0, 1800.0)


def compose(result: Result) -> Document:
    """Compose the report of a campaign of nets.

    Parameters
    ----------
    result : Result
        Groups ``nets``, ``towing``, ``waves``, ``law``, ``vibration``, ``tensions``, ``records``.

    Returns
    -------
    Document
    """
    root = root_of(result)
    towing, waves, nets = root.child("towing"), root.child("waves"), root.child("nets")
    tensions = root.child("tensions")
    sections = [
        Chapter("summary", "Summary", (*_key_figures(root), *notice_blocks(result))),
        Chapter("drag", "Drag in still water", (*_drag_figure(towing, waves, nets), *towing_table(towing))),
        Chapter("laws", "Laws of the drag", (*net_table(nets), *_law_blocks(root.child("law"), nets))),
        Chapter("waves", "Waves", (*wave_table(waves), *_wave_figures(waves), *_reconstructions(root))),
        Chapter("lines", "Tensions of lines", (*tension_table(tensions), *_tension_figures(root))),
        Chapter("vibration", "Vibration of the carriage", (*_vibration(root.child("vibration")), *_tow_records(root))),
        Chapter("input", "Input", (case_listing(root),)),
    ]
    return page_of(result, "Coefficients of nets", sections)


def _key_figures(root: Group) -> tuple[Block, ...]:
    items = []
    towing, waves, tensions = root.child("towing"), root.child("waves"), root.child("tensions")
    drag, number = towing.real("drag", "run"), towing.real("reynolds", "run")
    if drag is not None and number is not None and drag.size:
        items.append(
            KeyFigure(
                "C_D in still water",
                f"{format_number(float(drag.min()))} to {format_number(float(drag.max()))}",
                f"{drag.size} runs, Re {number.min():.0f} to {number.max():.0f}",
            )
        )
    wave_drag = waves.real("drag", "run")
    if wave_drag is not None and wave_drag.size:
        count = waves.real("keulegan_carpenter", "run")
        detail = "" if count is None else f"{wave_drag.size} runs, KC {count.min():.0f} to {count.max():.0f}"
        text = f"{format_number(float(wave_drag.min()))} to {format_number(float(wave_drag.max()))}"
        items.append(KeyFigure("C_D in waves", text, detail))
    lift = towing.real("lift", "run")
    if lift is not None and drag is not None and np.isfinite(lift).any():
        share = float(np.nanmedian(np.abs(lift) / np.maximum(drag, 1e-12)))
        items.append(KeyFigure("lift over drag", f"{100.0 * share:.1f} %", "median of the runs in still water"))
    law = root.child("law").attributes
    if "left_out_error" in law:
        better = float(law["left_out_error"]) < float(law["pooled_error"])
        items.append(
            KeyFigure(
                "A, B by solidity and diameter",
                f"± {100.0 * float(law['left_out_error']):.0f} %",
                f"error for a net left out; {100.0 * float(law['pooled_error']):.0f} % by one power law",
                judgement="good" if better else "caution",
            )
        )
    line = root.child("vibration").attributes
    if "line" in line:
        items.append(
            KeyFigure(
                "vibration",
                f"{float(line['line']):.2f} Hz",
                f"taken out from {float(line['low']):.2f} to {float(line['high']):.2f} Hz",
            )
        )
    peak = tensions.real("tension_peak", "line_end")
    if peak is not None and peak.size:
        labels = tensions.labels("line_end")
        top = int(np.argmax(peak))
        items.append(KeyFigure("highest tension", f"{format_number(float(peak[top]))} N", labels[top]))
    return (KeyFigures(tuple(items)),) if items else ()


def _texts(group: Group, name: str) -> list[str]:
    node = group.node
    return [] if node is None or name not in node.coords else [str(value) for value in node.coords[name].values]


def _drag_figure(towing: Group, waves: Group, nets: Group) -> list[Block]:
    number, drag = towing.real("reynolds", "run"), towing.real("drag", "run")
    half = towing.real("drag_half_width", "run")
    if number is None or drag is None or half is None:
        return []
    names, order = _texts(towing, "net"), nets.labels("net")
    series: list[Series] = []
    for tone, name in enumerate(order):
        own = np.array([net == name for net in names], dtype=bool)
        if not own.any():
            continue
        x, y, spread = number[own], drag[own], half[own]
        sort = np.argsort(x)
        series.append(Series(f"net {name}", {"re": x[sort]}, y[sort], 0, tone, style="points"))
        bars_x = np.column_stack([x, x, np.full(x.size, np.nan)]).ravel()
        bars_y = np.column_stack([y - spread, y + spread, np.full(x.size, np.nan)]).ravel()
        label = f"net {name}"
        series.append(Series(f"{label}, interval", {"re": bars_x}, bars_y, 0, tone, faint=True, belongs_to=label))
        factor, exponent = nets.real("factor", "net"), nets.real("exponent", "net")
        k = order.index(name)
        if factor is not None and exponent is not None and math.isfinite(float(factor[k])):
            grid = np.geomspace(x.min(), x.max(), 40)
            series.append(
                Series(
                    f"{label}, fit",
                    {"re": grid},
                    float(factor[k]) * grid ** -float(exponent[k]),
                    0,
                    tone,
                    belongs_to=label,
                )
            )
    grid = np.geomspace(_PAPER[2], _PAPER[3], 60)
    series.append(
        Series("9.84 Re^-0.36", {"re": grid}, _PAPER[0] * grid ** -_PAPER[1], 0, len(order), dash="dash", faint=True)
    )
    return [
        Figure(
            "drag-reynolds",
            "Drag coefficient against Reynolds number",
            (Abscissa("re", "Re = U d / ν", "", log=True),),
            (Panel("C_D on the area of the twines", "", from_zero=True),),
            tuple(series),
            "Points with intervals, the power law of each net as a line, and the law of Matsubara and others over its "
            "range.",
            height=420,
        )
    ]


def _wave_figures(waves: Group) -> list[Block]:
    count, number = waves.real("keulegan_carpenter", "run"), waves.real("reynolds", "run")
    if count is None or number is None:
        return []
    names, kinds = _texts(waves, "net"), _texts(waves, "kind")
    series: list[Series] = []
    keys = list(dict.fromkeys(zip(names, kinds)))
    for tone, (name, kind) in enumerate(keys):
        own = np.array([pair == (name, kind) for pair in zip(names, kinds)], dtype=bool)
        for panel, key in enumerate(("drag", "inertia")):
            value, half = waves.real(key, "run"), waves.real(f"{key}_half_width", "run")
            if value is None or half is None:
                continue
            label = f"net {name}, {kind.replace('_', ' ')}"
            x = {"kc": count[own], "re": number[own]}
            series.append(Series(label, x, value[own], panel, tone, style="points"))
            gap = np.full(int(own.sum()), np.nan)
            bars = {axis: np.column_stack([v, v, gap]).ravel() for axis, v in x.items()}
            ends = np.column_stack([value[own] - half[own], value[own] + half[own], gap]).ravel()
            series.append(Series(f"{label}, interval", bars, ends, panel, tone, faint=True, belongs_to=label))
    return [
        Figure(
            "drag-kc",
            "Coefficients in waves against KC and Re",
            (Abscissa("kc", "KC = u T / d"), Abscissa("re", "largest Re")),
            (Panel("C_D", from_zero=True), Panel("C_M", from_zero=True)),
            tuple(series),
            "With intervals; C_M of a drag-ruled record is uncertain, as its interval shows.",
            height=440,
        )
    ]


def _law_blocks(law: Group, nets: Group) -> list[Block]:
    values = law.real("coefficient", "term")
    if values is None:
        return []
    attributes = law.attributes
    between, within, left, pooled = (
        100.0 * float(attributes[key]) for key in ("between_nets", "scatter", "left_out_error", "pooled_error")
    )
    cover = law.array("covariance", "term", "other_term")
    errors = np.full(values.size, np.nan) if cover is None else np.sqrt(np.maximum(np.diagonal(cover), 0.0))
    meaning = ("level", "ln Re", "S", "S ln Re", "ln d")
    table = Table(
        "joint-law",
        "All nets together",
        (
            Column("Term", list(law.labels("term"))),
            Column("belongs to", list(meaning[: values.size])),
            Column("coefficient", [float(value) for value in values], uniform=False),
            Column("standard error", [float(value) for value in errors], uniform=False),
        ),
        note="ln C_D = a0 + a1 ln Re + a2 S + a3 S ln Re + a4 ln d (d in m), so A = exp(a0 + a2 S + a4 ln d) and "
        f"B = -(a1 + a3 S), with the {attributes.get('solidity', '')} solidity. Spread between nets {between:.1f} %, "
        f"within {within:.1f} %. A net left out is predicted to "
        f"{left:.1f} %, by one power law for all to {pooled:.1f} %.",
    )
    return [table, *_factor_figure(nets)]


def _factor_figure(nets: Group) -> list[Block]:
    share, factor, exponent = (nets.real(key, "net") for key in ("solidity", "factor", "exponent"))
    joint, joint_b = nets.real("joint_factor", "net"), nets.real("joint_exponent", "net")
    if share is None or factor is None or exponent is None or joint is None or joint_b is None:
        return []
    sort = np.argsort(share)
    x = {"s": share[sort]}
    return [
        Figure(
            "factor-solidity",
            "A and B against solidity",
            (Abscissa("s", "geometric solidity"),),
            (Panel("A", from_zero=True), Panel("B", from_zero=True)),
            (
                Series("each net", x, factor[sort], 0, 0, style="points"),
                Series("all nets together", x, joint[sort], 0, 1, style="line+points"),
                Series("each net, B", x, exponent[sort], 1, 0, style="points"),
                Series("all nets together, B", x, joint_b[sort], 1, 1, style="line+points"),
            ),
            "A depends on the diameter too, so its points need not lie on one curve.",
        )
    ]


def _kept(values: Array) -> NDArray[np.intp]:
    if values.size <= _MOST_POINTS:
        return np.arange(values.size)
    return np.asarray(envelope_indices(values, _MOST_POINTS // 2))


def _reconstructions(root: Group) -> list[Block]:
    options = []
    for record in root.child("records").children():
        time, force, fitted = (record.real(key, "time") for key in ("time", "force", "force_fitted"))
        velocity = record.real("velocity", "time")
        if time is None or force is None or fitted is None or velocity is None:
            continue
        period = float(record.attributes.get("period", 0.0))
        keep = _kept(force)
        lines = (("measured, frame and vibration taken off", force, 0, 0), ("C_D and C_M", fitted, 0, 1),
                 ("rest", force - fitted, 1, 2), ("velocity", velocity, 2, 3))  # fmt: skip
        middle = 0.5 * float(time[0] + time[-1])
        figure = Figure(
            slug("reconstruction", record.name),
            f"{record.name}: force on net {record.attributes.get('net', '')}",
            (Abscissa("time", "time", "s"),),
            (Panel("force", "N"), Panel("rest", "N"), Panel("velocity", "m/s")),
            tuple(
                Series(label, {"time": time[keep]}, values[keep], panel, tone) for label, values, panel, tone in lines
            ),
            "Force by the coefficients of this record over that measured; below, what is left, and the velocity.",
            window=(middle - 2.5 * period, middle + 2.5 * period) if period > 0.0 else None,
            slider=True,
            height=480,
        )
        options.append(Option(record.name, (figure,)))
    return [Choice("reconstruction", "Run", tuple(options), print_all=False)] if options else []


def _tow_records(root: Group) -> list[Block]:
    options = []
    for record in root.child("records").children():
        time, raw = record.real("time", "time"), record.real("force_raw", "time")
        clean, slow = record.real("force_clean", "time"), record.real("force_slow", "time")
        if time is None or raw is None or clean is None or slow is None:
            continue
        window = [float(part) for part in _numbers(record, "window")]
        series = []
        for tone, (label, values) in enumerate((("as measured", raw), ("cleaned", clean), ("low-passed", slow))):
            keep = _kept(values)
            series.append(Series(label, {"time": time[keep]}, values[keep], 0, tone, faint=tone == 0))
        marks = tuple(Mark(word, x=place) for word, place in zip(("steady from", "to"), window))
        figure = Figure(
            slug("tow", record.name),
            f"{record.name}: force and its steady part",
            (Abscissa("time", "time", "s"),),
            (Panel("force", "N"),),
            tuple(series),
            "C_D is that of the mean between the marks.",
            marks=marks,
        )
        options.append(Option(record.name, (figure,)))
    return [Choice("tow", "Run", tuple(options), print_all=False)] if options else []


def _numbers(group: Group, name: str) -> list[float]:
    if group.node is None or name not in group.node.attrs:
        return []
    return [float(value) for value in np.atleast_1d(group.node.attrs[name])]


def _tension_figures(root: Group) -> list[Block]:
    options = []
    for record in root.child("records").children():
        if record.attributes.get("kind") != "cage" or record.node is None:
            continue
        time = record.real("time", "time")
        ends = [str(value) for value in np.atleast_1d(record.node.attrs["ends"])]
        if time is None:
            continue
        lines = list(dict.fromkeys(end.split(", ")[0] for end in ends))
        series = []
        for number, end in enumerate(ends):
            values = record.real(f"tension_{number}", "time")
            if values is None:
                continue
            keep = _kept(values)
            series.append(Series(end, {"time": time[keep]}, values[keep], lines.index(end.split(", ")[0]), number))
        figure = Figure(
            slug("tensions", record.name),
            f"{record.name}: tension at both ends of each line",
            (Abscissa("time", "time", "s"),),
            tuple(Panel(f"line {line}", "N", from_zero=True) for line in lines),
            tuple(series),
            window=(float(time[0]), float(time[0]) + min(12.0, float(time[-1] - time[0]))),
            slider=True,
            height=200 + 140 * len(lines),
        )
        options.append(Option(record.name, (figure,)))
    return [Choice("cage", "Run", tuple(options), print_all=False)] if options else []


def _vibration(group: Group) -> list[Block]:
    frequency, density = group.real("frequency", "frequency"), group.real("density", "frequency")
    background = group.real("background", "frequency")
    attributes = group.attributes
    if frequency is None or density is None or background is None:
        return []
    marks: tuple[Mark, ...] = ()
    words = "No spectral line is significant; nothing was removed."
    if "line" in attributes:
        marks = (
            Mark("stop band from", x=float(attributes["low"])),
            Mark("line", x=float(attributes["line"])),
            Mark("to", x=float(attributes["high"])),
        )
        words = f"The line is {float(attributes['prominence']):.0f} times above the spectrum around it."
    x = {"f": frequency}
    return [
        Paragraph(
            "The vibration is found in the steady parts of the still-water runs. It is taken out without shifting "
            "phases; in waves only what drag and inertia leave unexplained is filtered, so that the third harmonic of "
            "the drag stays.",
            quiet=True,
        ),
        Figure(
            "vibration",
            "Spectrum of the still-water runs",
            (Abscissa("f", "frequency", "Hz"),),
            (Panel("log10 of density over median"),),
            (
                Series("mean of the runs", x, np.log10(np.maximum(density, 1e-6)), 0, 0),
                Series("about it", x, np.log10(np.maximum(background, 1e-6)), 0, 1, dash="dash"),
            ),
            words,
            marks=marks,
        ),
    ]
