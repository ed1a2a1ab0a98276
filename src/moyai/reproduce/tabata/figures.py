"""The figures of the paper from the synthetic campaign: tension over height, current, direction, squared velocity."""

from __future__ import annotations

import numpy as np

from moyai.report.document import Abscissa, Figure, Panel, Series
from moyai.reproduce.drawing import curve, figure
from moyai.reproduce.model import PaperFigure
from moyai.reproduce.tabata.campaign import CONVENTIONAL, wave_maxima
from moyai.reproduce.tabata.runs import TabataRuns
from moyai.series.regressions import fit_line, type_ratio
from moyai.structures.curtain.seas.anchor_energy import error_against_product
from moyai.structures.curtain.seas.squared_velocity import fit_proportional

PLOTTED = ("3a", "3b", "3c", "3d", "3e", "4a", "4b", "5", "6", "7", "8", "9")
MADE = "Blocks of a synthetic campaign with planted relations; the record of the paper is not published."
TENSION = "kN"


def _series(runs: TabataRuns) -> tuple[PaperFigure, ...]:
    """Return the strips of figure 3, one below the other."""
    new, axis = runs.new, (Abscissa("time", "time", "h"),)
    hours = {"time": np.arange(len(new)) / 3.0}

    def strip(letter: str, title: str, ordinate: Panel, *series: Series) -> PaperFigure:
        return PaperFigure(f"3{letter}", figure(f"3{letter}", title, axis, ordinate, series, MADE, 220))

    return (
        strip("a", "significant wave height", Panel("H₁/₃", "m", from_zero=True),
              curve("blocks", hours, new.significant_height, 0)),
        strip("b", "significant wave period", Panel("T₁/₃", "s", from_zero=True),
              curve("blocks", hours, new.significant_period, 0)),
        strip("c", "mean current", Panel("current", "m/s"), curve("along the normal", hours, new.current_normal, 0)),
        strip("d", "one-tenth maximum of the tension", Panel("T₁/₁₀", TENSION, from_zero=True),
              curve("new type", hours, new.averaged("tenth") / 1e3, 0),
              curve("conventional type", hours, runs.conventional.averaged("tenth") / 1e3, 1, dash="dash")),
        strip("e", "steady tension", Panel("steady tension", TENSION, from_zero=True),
              curve("new type", hours, new.averaged("steady") / 1e3, 0),
              curve("conventional type", hours, runs.conventional.averaged("steady") / 1e3, 1, dash="dash")),
    )  # fmt: skip


def _height(runs: TabataRuns) -> Figure:
    height, tenth = runs.new.significant_height, runs.new.averaged("tenth")
    line = fit_line(height, tenth)
    x = np.linspace(0.0, float(height.max()), 30)
    return figure(
        "4a", "one-tenth maximum against wave height", (Abscissa("height", "H₁/₃", "m"),),
        Panel("T₁/₁₀", TENSION, from_zero=True),
        [
            curve("blocks", {"height": height}, tenth / 1e3, 1, points=True),
            curve("line through all directions", {"height": x}, line.predict(x) / 1e3, 0),
        ],
        MADE,
    )  # fmt: skip


def _current(runs: TabataRuns) -> Figure:
    current, steady = runs.new.current_normal, runs.new.averaged("steady")
    line = fit_line(current, steady)
    x = np.linspace(float(current.min()), float(current.max()), 20)
    return figure(
        "4b", "steady tension against the current", (Abscissa("current", "current along the normal", "m/s"),),
        Panel("steady tension", TENSION, from_zero=True),
        [
            curve("blocks", {"current": current}, steady / 1e3, 1, points=True),
            curve("line", {"current": x}, line.predict(x) / 1e3, 0),
        ],
        MADE,
    )  # fmt: skip


def _direction(runs: TabataRuns) -> Figure:
    new = runs.new
    reduced = new.averaged("tenth") * new.significant_period / new.significant_height
    beta = np.linspace(0.0, 90.0, 91)
    return figure(
        "5", "tension against the angle of the waves", (Abscissa("angle", "angle from the normal", "deg"),),
        Panel("tension over its largest", from_zero=True),
        [
            curve("blocks", {"angle": np.degrees(new.angle)}, reduced / reduced.max(), 1, points=True),
            curve("cos²", {"angle": beta}, np.cos(np.radians(beta)) ** 2, 0),
        ],
        f"{MADE} Height and period are taken out.",
    )  # fmt: skip


def _squared(runs: TabataRuns) -> Figure:
    top = runs.new.averaged("maximum")
    fit = fit_proportional(runs.squared, top)
    x = np.linspace(0.0, float(runs.squared.max()), 60)
    root = fit_proportional(np.sqrt(runs.squared), top)
    return figure(
        "6", "largest tension against squared velocity", (Abscissa("squared", "squared velocity u²", "m2/s2"),),
        Panel("T_max", TENSION, from_zero=True),
        [
            curve("blocks", {"squared": runs.squared}, top / 1e3, 1, points=True),
            curve("in proportion to u²", {"squared": x}, fit.factor * x / 1e3, 0),
            curve("in proportion to u", {"squared": x}, root.factor * np.sqrt(x) / 1e3, 2, dash="dash"),
        ],
        MADE,
    )  # fmt: skip


def _types(runs: TabataRuns) -> Figure:
    old, new = runs.conventional.averaged("maximum"), runs.new.averaged("maximum")
    line, _ = type_ratio(old, new)
    x = np.array([0.0, float(old.max())])
    return figure(
        "7", "new against conventional type", (Abscissa("old", "T_max, conventional type", TENSION),),
        Panel("T_max, new type", TENSION, from_zero=True),
        [
            curve("blocks", {"old": old / 1e3}, new / 1e3, 1, points=True),
            curve("line through the origin", {"old": x / 1e3}, line.predict(x) / 1e3, 0),
        ],
        MADE,
    )  # fmt: skip


def _error(runs: TabataRuns) -> Figure:
    factor = np.linspace(0.05, 0.6, 80)
    unit = CONVENTIONAL.float_mass * CONVENTIONAL.rope_stiffness
    mean, spread = error_against_product(*runs.observed, factor * unit)
    x = {"factor": factor}
    tension, speed = wave_maxima(runs.conventional)
    chosen, floor = runs.by_wave.chosen, runs.by_wave.floor
    single, _ = error_against_product(tension[chosen] - floor, speed[chosen], factor * unit)
    return figure(
        "8", "error of the energy model against M", (Abscissa("factor", "mass factor M"),),
        Panel("(calculated − observed)/calculated"),
        [
            curve("mean, rule of the paper", x, mean, 0),
            curve("root mean square, rule of the paper", x, spread, 1, dash="dash"),
            curve("mean, single waves", x, single, 2, dash="dot"),
        ],
        f"{MADE} Planted: {CONVENTIONAL.energy_factor}.",
    )  # fmt: skip


def _compared(runs: TabataRuns) -> Figure:
    observed, speed = runs.observed
    unit = CONVENTIONAL.float_mass * CONVENTIONAL.rope_stiffness
    calculated = np.sqrt(CONVENTIONAL.energy_factor * unit) * speed
    line = np.array([0.0, float(observed.max())]) / 1e3
    return figure(
        "9", "energy model with M = 0.2 against the blocks", (Abscissa("calculated", "calculated T_max", TENSION),),
        Panel("observed T_max", TENSION, from_zero=True),
        [
            curve("blocks", {"calculated": calculated / 1e3}, observed / 1e3, 1, points=True),
            curve("equal", {"calculated": line}, line, 0),
        ],
        MADE,
    )  # fmt: skip


def figures(runs: TabataRuns) -> tuple[PaperFigure, ...]:
    """Return the figures of the paper."""
    return (
        PaperFigure("1", None, "sketch of the construction"),
        PaperFigure("2", None, "map of the site and of the gauges"),
        *_series(runs),
        PaperFigure("4a", _height(runs)),
        PaperFigure("4b", _current(runs)),
        PaperFigure("5", _direction(runs)),
        PaperFigure("6", _squared(runs)),
        PaperFigure("7", _types(runs)),
        PaperFigure("8", _error(runs)),
        PaperFigure("9", _compared(runs)),
    )
