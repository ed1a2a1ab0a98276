"""Redraw the figures of the impact paper: C_T against Froude number, B/l, d/h, elastic number; tension against speed.

Sawaragi, Aoki and Liu (1991) measured the tension of a curtain that snaps taut in a flume and plotted C_T against
u/sqrt(gh), d/h, B/l and C_E = sqrt(EA/rho)/(h sqrt(gh)). The paper gives neither stiffness nor depth; the flume here
(h = 0.4 m, B = 0.7 m) is a choice, so slopes and ratios compare, levels do not. Lines are model A (energy form),
dashes its closed form for small strain.

    python examples/curtain/tension_coefficient.py [folder] [observed.csv]

writes tension_coefficient.png and tension_of_impact.png and prints the slopes that the paper states. ``observed.csv``
(columns froude_number, depth_ratio, span_ratio, cauchy_number, tension_coefficient) is drawn over the lines.
"""

from __future__ import annotations

import csv
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, closed_form, impact_numbers, peak_by_energy

Array = NDArray[np.float64]

FLUME = Impact(
    span=0.70,
    length=0.80,
    draught=0.15,
    upper_stiffness=75.0,
    lower_stiffness=75.0,
    speed=0.30,
    water=Water(depth=0.40, density=1000.0, gravity=9.81),
)
LINE, STEEL = 150.0, 39000.0  # EA of both cables [N]: 0.2 mm nylon, 0.5 mm steel wire
TICKS = (1, 2, 5, 10, 20, 50, 100)
STYLE = {
    "font.size": 9,
    "axes.grid": True,
    "grid.color": "#d8dee5",
    "grid.linewidth": 0.5,
    "axes.axisbelow": True,
    "axes.edgecolor": "#5b6775",
    "legend.frameon": False,
    "lines.linewidth": 1.4,
}
TONES = ("#0072b2", "#d55e00", "#009e73")


@dataclass(frozen=True)
class Curve:
    """C_T of both forms of model A along one number."""

    x: Array
    energy: Array
    small: Array


def with_stiffness(impact: Impact, total: float) -> Impact:
    """Return the span with EA shared by both cables [N]."""
    return replace(impact, upper_stiffness=0.5 * total, lower_stiffness=0.5 * total)


def coefficient(impact: Impact, tension: float) -> float:
    """Return C_T of a tension [N]."""
    return impact_numbers(impact, tension).tension_coefficient


def curve(x: Array, spans: list[Impact]) -> Curve:
    """Return C_T of a list of spans."""
    energy = np.array([coefficient(span, peak_by_energy(span).tension) for span in spans])
    small = np.array([coefficient(span, closed_form(span).tension) for span in spans])
    return Curve(x, energy, small)


def against_froude(stiffness: float) -> Curve:
    """Return C_T over u/sqrt(gh)."""
    number = np.linspace(0.04, 0.26, 45)
    speed = number * np.sqrt(FLUME.water.gravity * FLUME.water.depth)
    return curve(number, [replace(with_stiffness(FLUME, stiffness), speed=float(value)) for value in speed])


def against_span_ratio(stiffness: float) -> Curve:
    """Return C_T over B/l at constant B."""
    ratio = np.linspace(0.5, 0.995, 45)
    return curve(
        ratio, [replace(with_stiffness(FLUME, stiffness), length=FLUME.span / float(value)) for value in ratio]
    )


def against_draught(stiffness: float) -> Curve:
    """Return C_T over d/h."""
    ratio = np.linspace(0.2, 0.55, 36)
    depth = FLUME.water.depth
    return curve(ratio, [replace(with_stiffness(FLUME, stiffness), draught=depth * float(value)) for value in ratio])


def against_stiffness() -> Curve:
    """Return C_T over C_E."""
    stiffness = np.geomspace(20.0, 60000.0, 45)
    spans = [with_stiffness(FLUME, float(value)) for value in stiffness]
    number = np.array([impact_numbers(span, 1.0).cauchy_number for span in spans])
    return curve(number, spans)


def slope(found: Curve, low: float, high: float) -> float:
    """Return d log C_T / d log x between two values of x."""
    ends = np.interp([low, high], found.x, np.log(found.energy))
    return float((ends[1] - ends[0]) / np.log(high / low))


def read_observed(path: Path) -> list[dict[str, float]]:
    """Return the rows of a file of observed points."""
    with path.open(encoding="utf-8-sig", newline="") as stream:
        return [{key.strip(): float(value) for key, value in row.items()} for row in csv.DictReader(stream)]


def draw_coefficient(path: Path, observed: list[dict[str, float]]) -> None:
    """Draw C_T against the four numbers of the paper."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    panels: tuple[tuple[Any, str, str], ...] = (
        (against_froude, "froude_number", "Froude number u/√(gh)"),
        (against_span_ratio, "span_ratio", "B/l"),
        (against_draught, "depth_ratio", "d/h"),
        (None, "cauchy_number", "elastic number $C_E$"),
    )
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(7.6, 6.4), layout="constrained")
        for axis, (along, name, label) in zip(axes.ravel(), panels):
            curves = [(along(LINE), "line, EA = 150 N"), (along(STEEL), "steel, EA = 39 kN")] if along else []
            for tone, (found, words) in zip(TONES, curves or [(against_stiffness(), "model A")]):
                axis.plot(found.x, found.energy, color=tone, label=words)
                axis.plot(found.x, found.small, color=tone, linestyle=(0, (4, 2)), linewidth=0.9)
            if observed:
                points = [(row[name], row["tension_coefficient"]) for row in observed]
                axis.plot(*zip(*points), "o", color="k", markerfacecolor="w", markersize=4, label="observed")
            axis.set(xlabel=label, ylabel="$C_T$", yscale="log", ylim=(0.7, 150.0))
            axis.set_yticks(TICKS, [f"{tick:g}" for tick in TICKS])
            axis.minorticks_off()
            axis.legend(loc="best", fontsize=8)
        axes[0, 0].set_xscale("log")
        axes[0, 0].set_xticks([0.05, 0.1, 0.2], ["0.05", "0.1", "0.2"])
        axes[0, 0].minorticks_off()
        axes[1, 1].set_xscale("log")
        axes[1, 1].set_xticks([0.2, 0.5, 1, 2, 5, 10], ["0.2", "0.5", "1", "2", "5", "10"])
        axes[1, 1].minorticks_off()
        guide = np.array([0.3, 8.0])
        axes[1, 1].plot(guide, 6.0 * guide, color="#5b6775", linewidth=0.8, linestyle=":")
        axes[1, 1].annotate("slope 1", (0.62, 5.5), color="#5b6775", fontsize=8)
        figure.suptitle("h = 0.4 m, B = 0.7 m, l = 0.8 m, d = 0.15 m, u = 0.3 m/s; dashes: closed form", fontsize=9)
        figure.savefig(path, dpi=150)
        plt.close(figure)


def draw_tension(path: Path) -> None:
    """Draw the tension itself against speed, draught and the root of EA: straight lines in the paper."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    speeds, draughts, roots = np.linspace(0.02, 0.5, 40), np.linspace(0.02, 0.2, 40), np.linspace(4.0, 200.0, 40)

    def tension(span: Impact) -> float:
        return peak_by_energy(span).tension

    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(1, 3, figsize=(9.2, 3.1), layout="constrained")
        for tone, draught in zip(TONES, (0.10, 0.15, 0.20)):
            values = [tension(replace(FLUME, draught=draught, speed=float(u))) for u in speeds]
            axes[0].plot(speeds, values, color=tone, label=f"d = {draught:.2f} m")
        for tone, speed in zip(TONES, (0.1, 0.3, 0.5)):
            values = [tension(replace(FLUME, speed=speed, draught=float(d))) for d in draughts]
            axes[1].plot(draughts, values, color=tone, label=f"u = {speed:.1f} m/s")
            values = [tension(with_stiffness(replace(FLUME, speed=speed), float(root) ** 2)) for root in roots]
            axes[2].plot(roots, values, color=tone, label=f"u = {speed:.1f} m/s")
        for axis, label in zip(axes, ("speed u [m/s]", "draught d [m]", "√EA [√N]")):
            axis.set(xlabel=label, ylabel="peak tension of both cables [N]", xlim=(0, None), ylim=(0, None))
            axis.legend(fontsize=8)
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main() -> None:
    """Write both pictures and print what the paper states."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    folder.mkdir(parents=True, exist_ok=True)
    observed = read_observed(Path(sys.argv[2])) if len(sys.argv) > 2 else []
    draw_coefficient(folder / "tension_coefficient.png", observed)
    draw_tension(folder / "tension_of_impact.png")
    draught = against_draught(LINE)
    change = np.interp([0.25, 0.5], draught.x, draught.energy)
    print(f"log C_T over log Fr: {slope(against_froude(LINE), 0.05, 0.25):.3f} (the paper: falls with Fr)")
    print(f"log C_T over log B/l, 0.8 to 0.99: {slope(against_span_ratio(LINE), 0.8, 0.99):.3f} (nearly proportional)")
    print(f"C_T at d/h = 0.25 over that at 0.5: {change[0] / change[1]:.4f} (hardly depends)")
    print(f"log C_T over log C_E: {slope(against_stiffness(), 1.0, 8.0):.3f} (straight line)")
    for name in ("tension_coefficient.png", "tension_of_impact.png"):
        print(f"wrote {folder / name}")


if __name__ == "__main__":
    main()
