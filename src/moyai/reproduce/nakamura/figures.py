"""The figures of the paper over L/B: motions in both domains, drift, stiffness, transmission and reflection."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.floating.energy import ENERGY_TOLERANCE, SHOWN_LOSS, unexplained_share
from moyai.mooring.catenary import solve_catenary
from moyai.mooring.shoji import solve_shoji
from moyai.report.document import Abscissa, Figure, Panel, Series
from moyai.reproduce.drawing import curve, drawing_of, figure
from moyai.reproduce.model import PaperFigure
from moyai.reproduce.nakamura.runs import FRACTION, MODES, NakamuraRuns, abscissae, values
from moyai.structures.breakwater.model import MooringLine

if TYPE_CHECKING:
    from moyai.core.results import Result

AXES = (Abscissa("ratio", "wavelength over beam L/B"), Abscissa("period", "wave period T", "s"))
LETTERS = "abc"
PLOTTED = ("4", "5a", "5b", "5c", "6a", "6b", "6c", "7", "8a", "8b", "8c", "9a", "9b", "9c", "10a", "10b")
CUT = 3.0  # of the undamped resonance under a damped figure
STIFFNESS_UNITS = {"sway": "N/m", "heave": "N/m", "roll": "N m"}


def chain(runs: NakamuraRuns) -> tuple[float, float, float, float, float]:
    """Return distance, height, length [m], EA [N] and submerged weight [N/m] of one chain at rest."""
    line = runs.case.breakwater.lines[0]
    assert isinstance(line, MooringLine)
    segment = line.segments[0]
    draught = runs.case.breakwater.draught
    assert draught is not None
    height = runs.case.environment.water.depth - draught + line.fairlead[2] - line.anchor[2]
    reach = abs(line.anchor[0] - line.fairlead[0])
    return reach, height, segment.length, segment.line_type.axial_stiffness, segment.line_type.submerged_weight


def restoring_curves(runs: NakamuraRuns) -> tuple[Array, Array, Array, Array]:
    """Return offsets [m] and the horizontal tension [N] of one chain: elastic, inextensible, and by Shoji.

    Shoji's form holds while some line lies on the bed; it is blank beyond.
    """
    reach, height, length, stiffness, weight = chain(runs)
    taut = math.sqrt(length**2 - height**2) - reach
    offsets = np.concatenate([np.linspace(-0.05, 0.8 * taut, 60), np.linspace(0.8 * taut, 0.995 * taut, 40)[1:]])
    elastic = solve_catenary(reach + offsets, height, length, stiffness, weight)
    stiff = solve_catenary(reach + offsets, height, length, 1e4 * stiffness, weight)
    grounded = np.asarray(elastic.grounded_length) > 1e-9
    by_shoji = np.full(offsets.size, math.nan)
    for index in np.flatnonzero(grounded):
        solved = solve_shoji(reach + float(offsets[index]), height, length, stiffness, weight)
        by_shoji[index] = solved.horizontal_tension
    return offsets, np.asarray(elastic.horizontal_tension), np.asarray(stiff.horizontal_tension), by_shoji


def _restoring(runs: NakamuraRuns) -> Figure:
    offsets, elastic, stiff, by_shoji = restoring_curves(runs)
    x = {"offset": 100.0 * offsets}
    return figure(
        "4",
        "horizontal tension of a chain against the displacement of its fairlead",
        (Abscissa("offset", "horizontal displacement of the fairlead", "cm"),),
        Panel("horizontal tension", "N", from_zero=True),
        (
            curve("elastic catenary", x, elastic, 0),
            curve("inextensible catenary", x, stiff, 1, dash="dash"),
            curve("modified catenary of Shoji", x, by_shoji, 2, dash="dot"),
        ),
        "One chain. Shoji's form covers the elastic catenary while some chain lies on the bed and ends where it lifts.",
    )


def _both(result: Result, name: str, dof: str = "", label: str = "", tone: int = 0) -> list[Series]:
    """Return the curve of the frequency domain and, where the result has it, the points of the time domain."""
    return [curve(label or "frequency domain", abscissae(result, "frequency"), values(result, "frequency", name, dof),
                  tone)]  # fmt: skip


def _points(result: Result, name: str, dof: str, label: str, tone: int, domain: str = "time") -> Series:
    return curve(label, abscissae(result, domain), values(result, domain, name, dof), tone, points=True)


def _moving(runs: NakamuraRuns, name: str, dof: str = "") -> list[Series]:
    """Return both domains with chains in motion, in frequency by the first harmonic of their force."""
    return [
        _points(runs.moving_time, name, dof, "time domain, chains in motion", 2),
        _points(runs.moving_time, name, dof, "frequency domain, first harmonic of chains in motion", 3, "frequency"),
    ]


def _motion(runs: NakamuraRuns, number: str, state: Literal["undamped", "damped", "drifted"], letter: int) -> Figure:
    mode = MODES[letter]
    result: Result = getattr(runs, state)
    in_time: Result = getattr(runs, f"{state}_time")
    series = [
        *_both(result, "motion_ratio", mode),
        _points(in_time, "motion_ratio", mode, "time domain, chains at rest", 1),
    ]
    words = {
        "undamped": "no damping beyond waves, no drift",
        "damped": f"damping {100 * FRACTION:.0f} % of critical, no drift",
        "drifted": f"damping {100 * FRACTION:.0f} % of critical, with drift",
    }[state]
    if state == "drifted":
        series += _moving(runs, "motion_ratio", mode)
        series += _other_state(runs.damped, runs.damped_time, mode, "without drift")
    if state == "damped":
        series += _other_state(runs.undamped, runs.undamped_time, mode, "without damping")
    if state == "undamped":
        series += _other_state(runs.damped, runs.damped_time, mode, f"with {100 * FRACTION:.0f} % of critical")
    symbol = {"sway": "X₁/(H/2)", "heave": "X₂/(H/2)", "roll": "θB/H"}[mode]
    cut = f" The undamped curve is cut at {CUT:g}." if state == "damped" and mode == "roll" else ""
    return figure(
        number, f"{mode}, {words}", AXES, Panel(f"{mode} {symbol}", from_zero=True), series,
        f"Wave height 4 cm, four chains.{cut}{_second_state(in_time)}",
    )  # fmt: skip


def _other_state(result: Result, in_time: Result, mode: str, words: str) -> list[Series]:
    """Return both domains of another state of damping or drift, faint, to lay under a figure."""
    found = np.minimum(values(result, "frequency", "motion_ratio", mode), CUT)
    timed = np.minimum(values(in_time, "time", "motion_ratio", mode), CUT)
    return [
        curve(f"frequency domain {words}", abscissae(result, "frequency"), found, 5, dash="dash", faint=True),
        curve(f"time domain {words}, chains at rest", abscissae(in_time, "time"), timed, 5, points=True, faint=True),
    ]


def unkept(result: Result) -> Array:
    """Return the periods [s] at which the loss of the far field in time is not the work of the damping."""
    share = unexplained_share(values(result, "time", "dissipation"), values(result, "time", "damping_work"), SHOWN_LOSS)
    return np.asarray(values(result, "time", "period")[share > ENERGY_TOLERANCE])


def _second_state(in_time: Result) -> str:
    periods = unkept(in_time)
    if not periods.size:
        return ""
    named = ", ".join(f"{period:.3g}" for period in periods)
    return (
        f" In time, chains at rest: at T = {named} s the motion has strong other harmonics, or has not settled, and "
        "its first harmonic does not keep the energy of the wave."
    )


def _drift(runs: NakamuraRuns) -> Figure:
    return figure(
        "7", "drift force on the model", AXES, Panel("F*", from_zero=True),
        [
            curve("F* = C_R² + E_L/2", abscissae(runs.drifted, "frequency"),
                  values(runs.drifted, "frequency", "drift_coefficient"), 0),
            curve("C_R² alone", abscissae(runs.drifted, "frequency"),
                  values(runs.drifted, "frequency", "reflection_coefficient") ** 2, 5, dash="dash"),
        ],
        "Frequency domain with damping and drift.",
    )  # fmt: skip


def _stiffness(runs: NakamuraRuns, number: str, letter: int) -> Figure:
    mode = MODES[letter]
    x = abscissae(runs.drifted, "frequency")
    found = values(runs.drifted, "frequency", "mooring_stiffness", mode)
    rest = values(runs.damped, "frequency", "mooring_stiffness", mode)
    index = letter + 1
    return figure(
        number, f"stiffness of all lines, K{index}{index} ({mode})", AXES,
        Panel(f"K{index}{index}", STIFFNESS_UNITS[mode]),
        [curve("under drift", x, found, 0), curve("without drift", x, rest, 5, dash="dash")],
        "Tangent stiffness about the mean position, four chains.",
    )  # fmt: skip


def _far(runs: NakamuraRuns, number: str, name: str, words: str, symbol: str) -> Figure:
    return figure(
        number, words, AXES, Panel(symbol, limits=(0.0, 1.05)),
        [
            *_both(runs.drifted, name),
            _points(runs.drifted_time, name, "", "time domain, chains at rest", 1),
            *_moving(runs, name),
        ],
        "With damping and drift. In time the operators of the frequency domain take the motion of the simulation."
        f"{_second_state(runs.drifted_time)}",
    )  # fmt: skip


def figures(runs: NakamuraRuns) -> tuple[PaperFigure, ...]:
    """Return the figures of the paper."""
    out = [
        PaperFigure("1", drawing_of(runs.drifted, "1", "model and axes", "section")),
        PaperFigure("2", None, "definition of a line's coordinates; figure 3 shows the lines to scale"),
        PaperFigure("3", drawing_of(runs.drifted, "3", "model on its chains in the tank", "elevation"),
                    "gauges are not drawn, their places are not printed"),
        PaperFigure("4", _restoring(runs)),
    ]  # fmt: skip
    states: tuple[tuple[str, Literal["undamped", "damped"]], ...] = (("5", "undamped"), ("6", "damped"))
    for number, state in states:
        out += [
            PaperFigure(f"{number}{LETTERS[i]}", _motion(runs, f"{number}{LETTERS[i]}", state, i)) for i in range(3)
        ]
    out.append(PaperFigure("7", _drift(runs)))
    out += [PaperFigure(f"8{LETTERS[i]}", _stiffness(runs, f"8{LETTERS[i]}", i)) for i in range(3)]
    out += [PaperFigure(f"9{LETTERS[i]}", _motion(runs, f"9{LETTERS[i]}", "drifted", i)) for i in range(3)]
    out.append(PaperFigure("10a", _far(runs, "10a", "transmission_coefficient", "transmission", "C_T")))
    out.append(PaperFigure("10b", _far(runs, "10b", "reflection_coefficient", "reflection", "C_R")))
    return tuple(out)
