"""A figure of a report as a figure of plotly, for notebooks: the same data, axes and marks as on the page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.report.document import Abscissa, Figure, Mark, Panel, Series
from moyai.report.figures_static import TONES
from moyai.report.formatting import pretty_unit
from moyai.report.html import words

if TYPE_CHECKING:
    from plotly.graph_objects import Figure as PlotlyFigure

_MODES = {"line": "lines", "points": "markers", "line+points": "lines+markers"}
_GAP = 0.045  # between panels, a share of the height


def plotly_figure(figure: Figure) -> PlotlyFigure:
    """Return a figure of a report as one of plotly.

    Parameters
    ----------
    figure : Figure

    Returns
    -------
    plotly.graph_objects.Figure
        Along the first abscissa. Its further abscissae are columns of the CSV of the figure.
    """
    from plotly.graph_objects import Figure as PlotlyFigure

    abscissa = figure.abscissae[0] if figure.abscissae else Abscissa("", "")
    drawn = PlotlyFigure(layout=_layout(figure, abscissa))
    for item in figure.series:
        if figure.categories or abscissa.key in item.x:
            drawn.add_trace(_trace(figure, item, abscissa))
    for mark in filter(lambda entry: entry.known, figure.marks):
        _add_mark(drawn, mark, abscissa.log)
    return drawn


def _axis(panel: int) -> str:
    return f"y{panel + 1}" if panel else "y"


def _labelled(axis: Abscissa | Panel) -> str:
    unit = pretty_unit(axis.unit)
    return words(f"{axis.label} [{unit}]" if unit else axis.label)


def _trace(figure: Figure, item: Series, abscissa: Abscissa) -> dict[str, Any]:
    colour = TONES[item.tone % len(TONES)]
    trace: dict[str, Any] = {
        "name": words(item.label),
        "yaxis": _axis(item.panel),
        "y": np.asarray(item.y, dtype=float),
        "legendgroup": item.belongs_to or item.label,
        "showlegend": not item.belongs_to and item.label != figure.panels[item.panel].label,
    }
    if item.style == "bar":
        return trace | {"type": "bar", "x": list(figure.categories), "marker": {"color": colour}}
    return trace | {
        "type": "scatter",
        "mode": _MODES[item.style],
        "x": np.asarray(item.x[abscissa.key], dtype=float),
        "line": {"color": colour, "width": 1 if item.faint else 1.8, "dash": item.dash},
    }


def _layout(figure: Figure, abscissa: Abscissa) -> dict[str, Any]:
    count = len(figure.panels)
    share = (1.0 - _GAP * (count - 1)) / count
    layout: dict[str, Any] = {
        "title": {"text": words(figure.title)},
        "template": "plotly_white",
        "height": figure.height + 100,  # title and legend stand outside the diagram
        "legend": {"orientation": "h", "y": 1.01, "yanchor": "bottom"},
        "xaxis": {"title": {"text": "" if figure.categories else _labelled(abscissa)}, "anchor": _axis(count - 1)},
    }
    if not figure.categories:
        layout["xaxis"] |= {"type": "log" if abscissa.log else "linear"}
        if figure.window is not None:
            layout["xaxis"]["range"] = list(np.log10(figure.window) if abscissa.log else figure.window)
    for number, panel in enumerate(figure.panels):
        top = 1.0 - number * (share + _GAP)
        axis = {"title": {"text": _labelled(panel)}, "domain": [max(top - share, 0.0), top]}
        axis["rangemode"] = "tozero" if panel.from_zero else "normal"
        if panel.limits is not None:
            axis["range"] = list(panel.limits)
        layout[f"yaxis{number + 1}" if number else "yaxis"] = axis
    return layout


def _add_mark(drawn: PlotlyFigure, mark: Mark, log: bool) -> None:
    """Add a labelled point or line."""
    axis, text = _axis(mark.panel), words(mark.label)
    line = {"color": "gray", "width": 1, "dash": "dot"}
    # shapes take values of a logarithmic axis, annotations their logarithm
    place = float(np.log10(mark.x)) if log and mark.x is not None else mark.x
    if mark.x is not None and mark.y is not None:
        drawn.add_annotation(text=text, x=place, y=mark.y, yref=axis, ax=40, ay=-14)
    elif mark.x is not None:
        drawn.add_shape(type="line", x0=mark.x, x1=mark.x, yref="paper", y0=0, y1=1, line=line)
        drawn.add_annotation(text=text, x=place, yref="paper", y=0, yanchor="bottom", textangle=-90, showarrow=False)
    elif mark.y is not None:
        drawn.add_shape(type="line", xref="paper", x0=0, x1=1, yref=axis, y0=mark.y, y1=mark.y, line=line)
        drawn.add_annotation(text=text, xref="paper", x=1, xanchor="right", yref=axis, y=mark.y, yanchor="bottom",
                             showarrow=False)  # fmt: skip
