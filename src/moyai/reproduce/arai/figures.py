"""The figures of the paper: coefficients, their fall, flow around the circle, circulation and lift over KC."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.morison.circulation import STRENGTHS, settled_circulation
from moyai.report.document import Abscissa, Figure, Panel, Series
from moyai.reproduce.arai.runs import (
    BREADTH,
    CONTOURS,
    DENSITY,
    HEIGHTS,
    MODEL_LENGTH,
    OMEGA,
    PERIOD,
    PRINTED,
    SECTIONS,
    AraiRuns,
    speed,
)
from moyai.reproduce.drawing import curve, figure
from moyai.reproduce.model import PaperFigure

NUMBER = (Abscissa("kc", "Keulegan-Carpenter number KC"),)
PLOTTED = ("2", "2a", "2b", "2c", "3", "6", "7", "10a", "10b", "10c", "10d", "10e", "10f", "12", "13", "14")
LARGEST, LAMINAR_END = 4.0, 1.0  # KC of the paper's axes; to which laminar theory of planar flow holds
PLANAR_WORDS = (
    "Planar flow is laminar theory, which holds below KC = 1; the curve of Sarpkaya that the paper shows is measured, "
    "no number of it is printed, and the level is held in its place."
)
LAW_WORDS = "The law is held from KC = 2 and ends at 3, where vortices of the size of the section govern."


def _planar(runs: AraiRuns) -> list[Series]:
    """Return the curve of planar flow for what it is: laminar theory, held where the paper shows measured points."""
    data = runs.sweep("circle")
    kc, found = data.keulegan_carpenter.values, data.planar_inertia_coefficient.values[:, 0]
    below = kc <= LAMINAR_END
    return [
        curve("circle in planar flow: laminar theory (Stokes, Wang)", {"kc": kc[below]}, found[below], 5, dash="dash"),
        curve("the same, held in place of Sarpkaya's measured curve", {"kc": kc[~below]}, found[~below], 5,
              dash="dot", faint=True),
    ]  # fmt: skip


def _all_sections(runs: AraiRuns) -> Figure:
    series = []
    for tone, section in enumerate(SECTIONS):
        data = runs.sweep(section)
        x = {"kc": data.keulegan_carpenter.values}
        for axis, (words, dash) in enumerate((("C_Mx", "solid"), ("C_My", "dash"))):
            found = data.inertia_coefficient.values[:, axis]
            series.append(curve(f"{section}, {words}", x, found, tone, dash=dash))  # type: ignore[arg-type]
    return figure(
        "2", "inertia coefficients of all sections", NUMBER, Panel("C_M", from_zero=True),
        [*series, *_planar(runs)], f"{LAW_WORDS} {PLANAR_WORDS}",
    )  # fmt: skip


def _coefficients(runs: AraiRuns, number: str, section: str) -> Figure:
    data = runs.sweep(section)
    kc = data.keulegan_carpenter.values
    x = {"kc": kc}
    own = data.inertia_coefficient.values
    ideal = runs.ideal(section)
    series = [
        curve("C_Mx with circulation", x, own[:, 0], 0),
        curve("C_My with circulation", x, own[:, 1], 1, dash="dash"),
        curve("ideal fluid, horizontal", x, np.full(kc.size, ideal[0]), 0, dash="dot", faint=True),
        curve("ideal fluid, vertical", x, np.full(kc.size, ideal[1]), 1, dash="dot", faint=True),
    ]
    if section == "circle":
        below = kc <= 2.0
        near = {"kc": kc[below]}
        series.append(curve("Chaplin", near, data.chaplin_inertia_coefficient.values[below, 0], 2, dash="dashdot"))
        series.append(curve("Otsuka and Ikeda", near, data.otsuka_inertia_coefficient.values[below, 0], 3, dash="dot"))
        series += _planar(runs)
    words = f"{LAW_WORDS} {PLANAR_WORDS}" if section == "circle" else LAW_WORDS
    return figure(number, f"inertia coefficients of the {section}", NUMBER, Panel("C_M", from_zero=True), series, words)


def _fall(runs: AraiRuns) -> Figure:
    series = []
    for tone, section in enumerate(SECTIONS):
        data = runs.sweep(section)
        fall = runs.ideal(section)[0] - data.inertia_coefficient.values[:, 0]
        series.append(curve(section, {"kc": data.keulegan_carpenter.values}, fall, tone))
        kc = np.linspace(0.0, LARGEST, 81)
        series.append(
            curve(f"{section}, as printed", {"kc": kc}, PRINTED[section] * kc**2, tone, dash="dot", faint=True)
        )
    return figure(
        "3", "fall of the inertia coefficient", NUMBER, Panel("fall of C_M", from_zero=True), series,
        f"Both directions are alike in circular orbits. Thin: equations (8) to (10), drawn on "
        f"beyond KC = 2, where the paper's own points leave them. {LAW_WORDS}",
    )  # fmt: skip


def _surface(runs: AraiRuns) -> Figure:
    data = runs.sweep("circle")
    angle = {"angle": np.degrees(data.surface_angle.values)}
    series = [
        curve(str(phase), angle, data.surface_speed_ratio.sel(phase=phase).values, tone)
        for tone, phase in enumerate(data.phase.values)
    ]
    return figure(
        "6", "speed around the circle at KC = 1.5, four phases", (Abscissa("angle", "angle from the x axis", "deg"),),
        Panel("speed over that of the stream", from_zero=True), series,
        "In place of photographs: potential flow with the paper's circulation. 90 degrees is the top, -90 the bottom; "
        "waves go right.",
    )  # fmt: skip


def _paths(runs: AraiRuns) -> Figure:
    _, paths = runs.paths(1.5, 2.2, 8)
    series = [
        curve(f"particle {index + 1}", {"x": 1e3 * path[:, 0]}, 1e3 * path[:, 1], index % 8)
        for index, path in enumerate(paths)
    ]
    angle = np.linspace(0.0, 2.0 * math.pi, 121)
    series.append(curve("circle", {"x": 500 * BREADTH * np.cos(angle)}, 500 * BREADTH * np.sin(angle), 7, dash="dash"))
    return figure(
        "7", "particles over one period at KC = 1.5", (Abscissa("x", "x", "mm"),), Panel("z", "mm"), series,
        "Eight particles that start on a ring; they do not return to their place.", 520,
    )  # fmt: skip


def _drift(runs: AraiRuns, number: str, section: str, keulegan_carpenter: float) -> Figure:
    """Draw the drift of particles on rings, each from its mean place."""
    arrows = []
    for ratio in (1.6, 2.0, 2.5):
        _, paths = runs.paths(keulegan_carpenter, ratio, 16, section=section)
        middle = np.trapezoid(paths, axis=1) / (paths.shape[1] - 1)
        arrows.append(np.stack([middle, middle + paths[:, -1] - paths[:, 0], np.full_like(middle, np.nan)], axis=1))
    ends = 1e3 * np.concatenate(arrows).reshape(-1, 2)
    heads = ends[1::3]
    outline = 1e3 * _outline(section)
    return figure(
        number, f"drift of particles, {section}, KC = {keulegan_carpenter:g}", (Abscissa("x", "x", "mm"),),
        Panel("z", "mm"),
        [
            curve("way of the mean place in a period", {"x": ends[:, 0]}, ends[:, 1], 0),
            curve("its end", {"x": heads[:, 0]}, heads[:, 1], 0, points=True),
            curve(section, {"x": outline[:, 0]}, outline[:, 1], 7, dash="dash"),
        ],
        "Potential flow with the paper's circulation; it holds the Stokes drift, as the beads of the paper do. "
        "moyai measure streaks draws the same from pictures.", 520,
    )  # fmt: skip


def _outline(section: str) -> Array:
    """Return the closed outline of a section [m]."""
    if section == "circle":
        angle = np.linspace(0.0, 2.0 * math.pi, 121)
        return 0.5 * BREADTH * np.column_stack([np.cos(angle), np.sin(angle)])
    corner = 0.5 * np.array([BREADTH, HEIGHTS[section]])
    return np.array([(1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1)]) * corner


def _contour(runs: AraiRuns) -> Figure:
    ratio = np.array(CONTOURS)
    series = []
    for tone, (number, found) in enumerate(runs.contours.items()):
        series.append(curve(f"drift of particles, KC = {number:g}", {"ratio": ratio}, 1e4 * found, tone, points=True))
        wall = np.array([1.0, CONTOURS[-1]])
        level = np.full(2, 1e4 * runs.extrapolated(number))
        series.append(curve(f"circulation found, KC = {number:g}", {"ratio": wall}, level, tone, dash="dash"))
    return figure(
        "12", "circulation against the size of the contour, circle", (Abscissa("ratio", "contour over section B_c/B"),),
        Panel("circulation", "cm2/s", from_zero=True), series,
        "Drift of particles on rings in a flow without vortices; it holds the Stokes drift, which falls with the "
        "fourth "
        "power of the distance.",
    )  # fmt: skip


def _circulation(runs: AraiRuns) -> Figure:
    data = runs.sweep("circle")
    kc = data.keulegan_carpenter.values
    known = (kc > 0.2) & (kc <= 2.0)
    x = {"kc": kc[known]}
    return figure(
        "13", "circulation against KC", (Abscissa("kc", NUMBER[0].label, log=True),), Panel("circulation", "cm2/s"),
        [
            curve("18 KC²", x, 1e4 * data.arai_circulation.values[known], 0),
            curve("Otsuka and Ikeda", x, 1e4 * data.otsuka_circulation.values[known], 1, dash="dash"),
            curve("Chaplin", x, 1e4 * data.chaplin_circulation.values[known], 2, dash="dot"),
        ],
        "The same for the three sections.",
    )  # fmt: skip


def lost_force(runs: AraiRuns, section: str, number: float) -> tuple[float, float]:
    """Return the loss of inertia force on the model [N], horizontal and vertical, at a KC in circular orbits."""
    data = runs.sweep(section)
    fall = runs.ideal(section)[None, :] - data.inertia_coefficient.values
    area = float(runs.members[section].tree["SWL/member"].to_dataset().area)
    at = [float(np.interp(number, data.keulegan_carpenter.values, fall[:, axis])) for axis in (0, 1)]
    size = DENSITY * area * OMEGA * speed(number) * MODEL_LENGTH
    return size * at[0], size * at[1]


def lift(number: Array) -> Array:
    """Return the lift of the circulation on the model [N] over KC by equations (6) and (7)."""
    v = speed(1.0) * number
    circulation = settled_circulation(STRENGTHS["arai"], v, v, PERIOD)
    return np.asarray(DENSITY * v * circulation * MODEL_LENGTH, dtype=float)


def _force(runs: AraiRuns) -> Figure:
    series = []
    for tone, section in enumerate(SECTIONS):
        kc = np.linspace(0.1, 3.0, 30)
        for axis, words in enumerate(("horizontal", "vertical")):
            loss = np.array([lost_force(runs, section, float(number))[axis] for number in kc])
            series.append(
                curve(f"loss of inertia force, {section}, {words}", {"kc": kc}, loss, tone, points=True, faint=axis > 0)
            )
    inside, beyond = np.linspace(0.0, 2.0, 41), np.linspace(2.0, LARGEST, 41)
    series.append(curve("lift, equations (6) and (7)", {"kc": inside}, lift(inside), 4))
    series.append(
        curve("lift, drawn on beyond its measured range", {"kc": beyond}, lift(beyond), 4, dash="dash", faint=True)
    )
    return figure(
        "14", "loss of inertia force and lift on the model of 79 cm", NUMBER, Panel("force", "N", from_zero=True),
        series, f"All sections, both directions. {LAW_WORDS}",
    )  # fmt: skip


def figures(runs: AraiRuns) -> tuple[PaperFigure, ...]:
    """Return the figures of the paper."""
    sarpkaya = f"panels a to c of the paper in one. {PLANAR_WORDS}"
    return (
        PaperFigure("1", None, "sketch of the tank; its dimensions are in the case files"),
        PaperFigure("2", _all_sections(runs), sarpkaya),
        PaperFigure("2a", _coefficients(runs, "2a", "circle")),
        PaperFigure("2b", _coefficients(runs, "2b", "square")),
        PaperFigure("2c", _coefficients(runs, "2c", "rectangle")),
        PaperFigure("3", _fall(runs)),
        PaperFigure("4", None, "sketch of the light sheets and the camera"),
        PaperFigure(
            "5", None, "photographs of vortices of the size of the section at KC near 3.8; no model here sheds them"
        ),
        PaperFigure("6", _surface(runs)),
        PaperFigure("7", _paths(runs)),
        PaperFigure("8", None, "sketch of the interpolation; the table of statements gives its error"),
        PaperFigure("9", None, "drift without a model: settling and mass transport, measured in each campaign"),
        *(
            PaperFigure(
                f"10{'abcdef'[2 * place + index]}", _drift(runs, f"10{'abcdef'[2 * place + index]}", section, kc)
            )
            for place, section in enumerate(SECTIONS)
            for index, kc in enumerate((1.0, 1.5))
        ),
        PaperFigure("11", None, "sketch of the lift"),
        PaperFigure("12", _contour(runs)),
        PaperFigure("13", _circulation(runs)),
        PaperFigure("14", _force(runs)),
    )
