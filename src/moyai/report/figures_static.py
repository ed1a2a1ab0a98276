"""Figures for paper: the same :class:`~moyai.report.document.Figure` drawn by matplotlib."""

from __future__ import annotations

import io
from typing import Any

import numpy as np

from moyai.language import spoken_language
from moyai.report.document import Figure, Mark, Series
from moyai.report.fonts import matplotlib_families, require_japanese
from moyai.report.formatting import pretty_unit, subscripted

TONES = ("#0072b2", "#d55e00", "#009e73", "#b5609a", "#b98500", "#4aa3d8", "#5a5f66")
_MARKERS = ("o", "s", "^", "D", "P", "X", "*")
_DASHES: dict[str, Any] = {"solid": "-", "dash": (0, (5, 2)), "dot": (0, (1, 1.5)), "dashdot": (0, (5, 1.5, 1, 1.5))}
_INK, _MUTED, _RULE = "#1b2430", "#5b6775", "#d8dee5"


def _settings() -> Any:
    return {
        "font.family": list(matplotlib_families()),
        "font.size": 8.0,
        "axes.linewidth": 0.6,
        "axes.edgecolor": _MUTED,
        "axes.labelcolor": _INK,
        "text.color": _INK,
        "text.parse_math": False,  # titles are the user's own words; a dollar sign is a dollar sign
        "xtick.color": _MUTED,
        "ytick.color": _MUTED,
        "xtick.labelcolor": _INK,
        "ytick.labelcolor": _INK,
        "axes.grid": True,
        "grid.color": _RULE,
        "grid.linewidth": 0.5,
        "svg.fonttype": "path",
        "svg.hashsalt": "moyai",
        "legend.frameon": False,
        "axes.unicode_minus": True,
    }


def _labelled(label: str, unit: str) -> str:
    label = subscripted(label)
    return f"{label} [{pretty_unit(unit)}]" if unit else label


def draw_figure(figure: Figure, *, image_format: str = "svg", width: float = 17.0, dots_per_inch: int = 200) -> bytes:
    """Draw a figure for paper.

    Parameters
    ----------
    figure : Figure
        Drawn along its first abscissa and over its first window.
    image_format : {"svg", "png", "pdf"}
    width : float
        Width [cm]; the height follows the height of the figure on the screen.
    dots_per_inch : int
        Resolution of PNG.

    Returns
    -------
    bytes
        The image file.

    Raises
    ------
    InputError
        When the language in force is Japanese and no font has its letters.
    """
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure as Canvas

    if spoken_language() == "ja":
        require_japanese(matplotlib_families())
    inches = width / 2.54
    with matplotlib.rc_context(rc=_settings()):
        canvas = Canvas(figsize=(inches, inches * figure.height / 760.0))
        FigureCanvasAgg(canvas)
        axes = canvas.subplots(len(figure.panels), 1, sharex=True, squeeze=False)[:, 0]
        for item in figure.series:
            _draw_series(axes[item.panel], figure, item)
        for mark in filter(lambda entry: entry.known, figure.marks):
            _draw_mark(axes[mark.panel], mark)
        _finish_axes(canvas, axes, figure)
        stream = io.BytesIO()
        canvas.savefig(
            stream, format=image_format, dpi=dots_per_inch, metadata={"Date": None} if image_format == "svg" else None
        )
    return stream.getvalue()


def _draw_series(axis: Any, figure: Figure, item: Series) -> None:
    tone = TONES[item.tone % len(TONES)]
    named = item.label != figure.panels[item.panel].label and not item.belongs_to
    label = subscripted(item.label) if named else "_"
    if item.style == "bar":
        bars = [entry for entry in figure.series if entry.style == "bar" and entry.panel == item.panel]
        breadth = 0.7 / len(bars)
        at = np.arange(len(figure.categories)) + breadth * (bars.index(item) - 0.5 * (len(bars) - 1))
        axis.bar(at, item.y, breadth, color=tone, label=label, alpha=0.45 if item.faint else 1.0, zorder=2)
        return
    key = figure.abscissae[0].key
    if key not in item.x:
        return
    x, y = np.asarray(item.x[key], dtype=float), np.asarray(item.y, dtype=float)
    if figure.window is not None:
        shown = (x >= figure.window[0]) & (x <= figure.window[1])
        x, y = x[shown], y[shown]
    marker = _MARKERS[item.tone % len(_MARKERS)]
    hollow = item.style == "points"
    axis.plot(
        x,
        y,
        color=tone,
        label=label,
        zorder=3,
        linestyle="none" if hollow else _DASHES[item.dash],
        linewidth=0.6 if item.faint else 1.2,
        marker=None if item.style == "line" else marker,
        markersize=4.5 if hollow else 3.0,
        markerfacecolor="white" if hollow else tone,
    )


def _draw_mark(axis: Any, mark: Mark) -> None:
    words = {"fontsize": 7.0, "color": _MUTED}
    if mark.x is not None and mark.y is not None:
        axis.annotate(
            mark.label,
            (mark.x, mark.y),
            xytext=(14, 4),
            textcoords="offset points",
            fontsize=7.0,
            color=_INK,
            arrowprops={"arrowstyle": "-", "color": _MUTED, "linewidth": 0.6},
        )
    elif mark.x is not None:
        axis.axvline(mark.x, color=_MUTED, linewidth=0.7, linestyle=":")
        axis.annotate(mark.label, (mark.x, 0.02), xycoords=("data", "axes fraction"), rotation=90, ha="right", **words)
    elif mark.y is not None:
        axis.axhline(mark.y, color=_MUTED, linewidth=0.7, linestyle=":")
        axis.annotate(
            mark.label,
            (0.995, mark.y),
            xycoords=("axes fraction", "data"),
            xytext=(0, 2),
            textcoords="offset points",
            ha="right",
            **words,
        )


def _finish_axes(canvas: Any, axes: Any, figure: Figure) -> None:
    for axis, panel in zip(axes, figure.panels, strict=True):
        axis.set_ylabel(_labelled(panel.label, panel.unit), fontsize=8.0 if len(axes) < 3 else 6.5)
        if panel.limits is not None:
            axis.set_ylim(panel.limits)
        elif panel.from_zero:
            low, high = axis.get_ylim()
            axis.set_ylim(min(low, 0.0) if low < -1e-12 * abs(high) else 0.0, max(high, 0.0))
    last, abscissa = axes[-1], figure.abscissae[0]
    if figure.categories:
        last.set_xticks(np.arange(len(figure.categories)), figure.categories)
        last.grid(False, axis="x")
    else:
        last.set_xlabel(_labelled(abscissa.label, abscissa.unit))
        if abscissa.log:
            from matplotlib.ticker import FuncFormatter, NullFormatter

            last.set_xscale("log")
            # the usual labels of powers are markup, which titles in plain words forbid
            last.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
            last.xaxis.set_minor_formatter(NullFormatter())
        if figure.window is not None:
            last.set_xlim(figure.window)
    _place(canvas, axes)


def _tick_reach(canvas: Any, axes: Any) -> float:
    """Return how far the numbers of the ordinates reach to the left of their axes [inches]."""
    renderer = canvas.canvas.get_renderer()
    widths = [
        label.get_window_extent(renderer).width
        for axis in axes
        for label in axis.yaxis.get_ticklabels()
        if label.get_text()
    ]
    ticks = 0.08
    return float(max(widths, default=0.0) / canvas.dpi) + ticks


def _place(canvas: Any, axes: Any) -> None:
    """Put the legend above and the axes into fixed margins: faster than a layout engine, and labels line up."""
    handles: dict[str, Any] = {}
    for axis in axes:
        for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
            handles.setdefault(label, handle)
    wide, high = canvas.get_size_inches()
    columns = max(min(len(handles), int(wide / (0.55 + 0.062 * max(map(len, handles), default=1)))), 1)
    rows = -(-len(handles) // columns)
    reach = _tick_reach(canvas, axes)
    left, right = max(0.62, reach + 0.26) / wide, 1.0 - 0.10 / wide
    top, bottom = 1.0 - (0.08 + 0.17 * rows) / high, 0.40 / high
    canvas.subplots_adjust(left=left, right=right, top=top, bottom=bottom, hspace=0.12 if len(axes) < 4 else 0.16)
    for axis in axes:
        axis.yaxis.set_label_coords(-max(0.47, reach + 0.11) / (wide * (right - left)), 0.5)
    if handles:
        canvas.legend(
            handles.values(),
            handles.keys(),
            loc="upper left",
            bbox_to_anchor=(left, 1.0),
            borderaxespad=0.0,
            ncols=columns,
            fontsize=7.5,
        )
