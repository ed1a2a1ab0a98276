"""The figures of the paper: drag of nets, force in waves, motions and tensions of the cage over time."""

from __future__ import annotations

import numpy as np

from moyai.report.document import Abscissa, Figure, Panel
from moyai.reproduce.drawing import curve, drawing_of, figure
from moyai.reproduce.matsubara.runs import (
    GRAM,
    NETS,
    OFFSHORE,
    SHORE,
    SLACK_PERIOD,
    TAUT_PERIOD,
    CageWave,
    MatsubaraRuns,
    net_in_wave,
    towed,
)
from moyai.reproduce.model import PaperFigure

PLOTTED = ("3", "4", "5", "9", "10", "11", "12", "13a", "13b")
REYNOLDS = (Abscissa("re", "Reynolds number U d/ν", log=True),)
TIME = (Abscissa("time", "time", "s"),)


def _drag(number: str, nets: tuple[str, ...], words: str) -> Figure:
    series = []
    for tone, net in enumerate(nets):
        reynolds, drag = towed(net)
        series.append(curve(f"net {net}", {"re": reynolds}, drag, tone % 8))
    return figure(
        number, f"drag coefficient, {words}", REYNOLDS, Panel("C_d", from_zero=True), series,
        "Equation (2) over the speeds that were towed, 5 to 90 cm/s; a cap of 3 below Re = 27, held above 1800.",
    )  # fmt: skip


def _wave_force() -> Figure:
    time, velocity, drag, inertia = net_in_wave("F", 0.065, 1.3)
    x = {"time": time}
    return figure(
        "5", "force on net F in waves", TIME, Panel("force", "N"),
        [
            curve("drag and inertia", x, drag + inertia, 0),
            curve("drag", x, drag, 1, dash="dash"),
            curve("inertia", x, inertia, 2, dash="dot"),
            curve("velocity, scaled to the "
                  "force", x, velocity * np.abs(drag).max() / np.abs(velocity).max(), 5, faint=True),
        ],
        "H = 6.5 cm, T = 1.3 s, depth 45 cm, panel at 20 cm; C_d by equation (2), C_m = 2. Wave and place of the "
        "paper's "
        "record are not printed.",
    )  # fmt: skip


def _words(wave: CageWave) -> str:
    return f"H = {100 * wave.height:g} cm, T = {wave.period:g} s; the wave of the paper's record is not printed."


def _motion(number: str, wave: CageWave, mooring: str) -> Figure:
    x = {"time": wave.time}
    return figure(
        number, f"motion of the cage, {mooring}", TIME, Panel("displacement", "cm"),
        [curve("sway", x, 100 * wave.sway, 0), curve("heave", x, 100 * wave.heave, 1, dash="dash")], _words(wave),
    )  # fmt: skip


def _rotation(number: str, wave: CageWave, mooring: str) -> Figure:
    turned = curve("rotation", {"time": wave.time}, np.degrees(wave.rotation), 0)
    return figure(number, f"rotation of the cage, {mooring}", TIME, Panel("rotation", "deg"), [turned], _words(wave))


def _tension(number: str, wave: CageWave, mooring: str) -> Figure:
    x = {"time": wave.time}
    return figure(
        number, f"line tensions, {mooring}", TIME, Panel("tension", "gf", from_zero=True),
        [
            curve("line attached on the shore side", x, wave.tension[SHORE] / GRAM, 0),
            curve("line attached offshore", x, wave.tension[OFFSHORE] / GRAM, 1, dash="dash"),
        ],
        _words(wave),
    )  # fmt: skip


def figures(runs: MatsubaraRuns) -> tuple[PaperFigure, ...]:
    """Return the figures of the paper."""
    taut, slack = runs.at(runs.taut, TAUT_PERIOD), runs.at(runs.slack, SLACK_PERIOD)
    return (
        PaperFigure("1", None, "sketch of the carriage"),
        PaperFigure("2", None, "one record of a towing test, measured"),
        PaperFigure("3", _drag("3", ("G",), "net G")),
        PaperFigure("4", _drag("4", NETS, "all nets"), "its caption in print repeats that of figure 3"),
        PaperFigure("5", _wave_force()),
        PaperFigure("6", None, "photograph or sketch of the model; figure 7 shows it to scale"),
        PaperFigure("7", drawing_of(runs.results[0], "7", "cage on its lines in the tank", "elevation"),
                    "taut lines; anchors are filled in"),
        PaperFigure("8", None, "definition of forces and axes"),
        PaperFigure("9", _motion("9", taut, "taut lines")),
        PaperFigure("10", _motion("10", slack, "slack lines")),
        PaperFigure("11", _rotation("11", taut, "taut lines")),
        PaperFigure("12", _rotation("12", slack, "slack lines")),
        PaperFigure("13a", _tension("13a", taut, "taut lines")),
        PaperFigure("13b", _tension("13b", slack, "slack lines")),
    )  # fmt: skip
