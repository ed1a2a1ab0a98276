"""The figures of the paper: release record, added masses, time series, tension coefficient over its four numbers."""

from __future__ import annotations

import numpy as np

from moyai.report.document import Abscissa, Figure, Panel
from moyai.reproduce.drawing import curve, figure
from moyai.reproduce.model import PaperFigure
from moyai.reproduce.sawaragi.runs import LINE, STEEL, Release, SawaragiRuns, SpanRecord
from moyai.structures.curtain.impact.record import model_series

PLOTTED = ("3a", "3b", "6", "7", "8", "15", "16", "17", "18", "19", "20")
MATERIALS = (("fishing line", LINE), ("steel wire", STEEL))
COEFFICIENT = Panel("C_T", from_zero=True)
SUM = "Sum of both cables."


def _record(number: str, record: Release, material: str, whole: SpanRecord | None = None) -> Figure:
    time = record.motion.time
    shown = time < record.taut + 4.0
    series = [curve("both cables, model A with drag", {"time": time[shown]}, record.motion.tension[shown])]
    caption = f"{SUM} Current 0.30 m/s, C_D = 1.2; model A: a cable without tension until it is taut."
    if whole is not None:
        series.insert(0, curve("both cables, whole span released slack", {"time": whole.time}, whole.tension, 1))
        caption += " Whole span: gathered evenly between the supports at the release."
    return figure(
        number, f"release and snap, {material}", (Abscissa("time", "time from release", "s"),),
        Panel("tension", "N", from_zero=True),
        series, caption,
    )  # fmt: skip


def _frequency(runs: SawaragiRuns) -> Figure:
    number, mass, damping = runs.over_frequency
    x = {"number": number}
    return figure(
        "6", "added mass and wave damping of the flat skirt", (Abscissa("number", "Kd = ω²d/g", log=True),),
        Panel("over M₀"), [curve("M/M₀", x, mass, 0), curve("N/(ωM₀)", x, damping, 1, dash="dash")],
        "Depth three times the skirt.",
    )  # fmt: skip


def _rigid(runs: SawaragiRuns) -> Figure:
    distance, values, lengths = runs.over_curvature
    x = {"s": distance}
    return figure(
        "7", "added mass of a curved skirt that moves as a "
             "whole", (Abscissa("s", "s/d"),), Panel("M/M₀", from_zero=True),
        [curve("M₀ of the chord", x, values[0], 0), curve("M₀ of the arc", x, values[0] / lengths**2, 1, dash="dash")],
        "Infinite frequency, deep water. s/d = 0 is a half circle, large s/d the plate.",
    )  # fmt: skip


def _stretch(runs: SawaragiRuns) -> Figure:
    distance, values, lengths = runs.over_curvature
    x = {"s": distance}
    return figure(
        "8", "added mass of a skirt that stretches", (Abscissa("s", "s/d"),), Panel("M/M₀ of the arc", from_zero=True),
        [
            curve("force per acceleration of the centre", x, values[1] / lengths**2, 0),
            curve("energy", x, values[2] / lengths**2, 1, dash="dash"),
        ],
        "Infinite frequency, deep water. The paper does not say which of the two it shows.",
    )  # fmt: skip


def _series(runs: SawaragiRuns) -> Figure:
    series = [
        curve(f"model {one.model}", {"time": one.time}, one.tension, tone)
        for tone, one in enumerate(model_series(runs.span))
    ]
    return figure(
        "15", "tension from the taut instant, fishing line", (Abscissa("time", "time from taut", "s"),),
        Panel("tension", "N", from_zero=True), series, f"{SUM} A: the paper's model A marched with a thousandth "
                                                       f"of the rise.",
    )  # fmt: skip


def _peaks(runs: SawaragiRuns) -> Figure:
    computed, released = runs.peaks
    line = np.array([0.0, 1.1 * float(computed.max())])
    return figure(
        "16", "peaks against those of model A, fishing line", (Abscissa("computed", "peak of model A", "N"),),
        Panel("peak less drag", "N", from_zero=True),
        [
            curve("equal", {"computed": line}, line, 0),
            curve("model A released by itself, less drag", {"computed": computed}, released, 1, points=True),
        ],
        "Currents of 0.1 to 0.5 m/s. The measured peaks are not published as numbers: lay your own over it, or let "
        "moyai measure snaps draw it from records.",
    )  # fmt: skip


def _swept(runs: SawaragiRuns, number: str, name: str, words: str) -> Figure:
    series = []
    for tone, (material, total) in enumerate(MATERIALS[:1]):
        x, found = runs.over(name, total)
        series.append(curve(f"model A, {material}", {"x": x}, found, tone))
    return figure(number, f"C_T against {words}", (Abscissa("x", words),), COEFFICIENT, series,
                  "Sum of both cables; stiffness and sizes of the flume are filled in, slopes are the "
                  "paper's.")  # fmt: skip


def _stiffness(runs: SawaragiRuns) -> Figure:
    x, found = runs.over_stiffness()
    return figure(
        "20", "C_T against C_E", (Abscissa("x", "C_E"),), COEFFICIENT, [curve("model A", {"x": x}, found, 0)],
        "EA of both cables from 20 N to 60 kN.",
    )  # fmt: skip


def figures(runs: SawaragiRuns) -> tuple[PaperFigure, ...]:
    """Return the figures of the paper."""
    sketch = "definition sketch"
    return (
        PaperFigure("1", None, sketch),
        PaperFigure("2", None, sketch),
        PaperFigure("3a", _record("3a", runs.line, "fishing line", runs.whole_line)),
        PaperFigure("3b", _record("3b", runs.steel, "steel wire")),
        PaperFigure("4", None, sketch),
        PaperFigure("5", None, sketch),
        PaperFigure("6", _frequency(runs)),
        PaperFigure("7", _rigid(runs)),
        PaperFigure("8", _stretch(runs)),
        *(PaperFigure(str(number), None, sketch) for number in range(9, 15)),
        PaperFigure("15", _series(runs)),
        PaperFigure("16", _peaks(runs)),
        PaperFigure("17", _swept(runs, "17", "froude", "Froude number u/√(gh)")),
        PaperFigure("18", _swept(runs, "18", "span_ratio", "span ratio B/l")),
        PaperFigure("19", _swept(runs, "19", "depth_ratio", "depth ratio d/h")),
        PaperFigure("20", _stiffness(runs)),
    )


def log_slope(x: np.ndarray, found: np.ndarray, low: float, high: float) -> float:
    """Return d log C_T / d log x between two places of a curve."""
    ends = np.interp([low, high], x, np.log(found))
    return float((ends[1] - ends[0]) / np.log(high / low))
