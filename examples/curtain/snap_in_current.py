"""Redraw the tension record of the impact paper: release, slack, spike, plateau, for fishing line and steel wire.

A curtain held back in a steady current is let go, drifts slack and snaps taut. The slack-taut equation with drag gives
the record; the spike above the plateau is what the impact models compute. Steel gives a sharper and higher spike, the
plateau hardly changes, and the spikes of upper and lower cable come together (model A2).

    python examples/curtain/snap_in_current.py [folder]

writes snap_in_current.png and prints spike, rise time and plateau of both materials.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, edge_impact
from moyai.structures.curtain.impact.cycles import SlackTautMotion, slack_taut_motion

Array = NDArray[np.float64]

WATER = Water(depth=0.40, density=1000.0, gravity=9.81)
CURRENT, DRAG = 0.30, 1.2
MATERIALS = {"line, EA = 150 N": 150.0, "steel, EA = 39 kN": 39000.0}
TONES = ("#0072b2", "#d55e00")
STYLE = {
    "font.size": 9,
    "axes.grid": True,
    "grid.color": "#d8dee5",
    "grid.linewidth": 0.5,
    "axes.axisbelow": True,
    "axes.edgecolor": "#5b6775",
    "legend.frameon": False,
    "lines.linewidth": 1.3,
}


@dataclass(frozen=True)
class Record:
    """What the paper reads off a record.

    Parameters
    ----------
    motion : SlackTautMotion
        The record itself, released at t = 0.
    taut, rise : float
        Taut instant and time from there to the spike [s].
    spike, plateau : float
        Largest and steady sum of the tensions [N].
    """

    motion: SlackTautMotion
    taut: float
    rise: float
    spike: float
    plateau: float


def flume(stiffness: float) -> Impact:
    """Return the span of the flume with EA shared by both cables [N]."""
    return Impact(0.70, 0.80, 0.15, 0.5 * stiffness, 0.5 * stiffness, CURRENT, WATER)


def release(stiffness: float, duration: float = 60.0) -> Record:
    """Let the curtain go from the line between the supports, where it is held."""
    motion = slack_taut_motion(
        flume(stiffness),
        drag_coefficient=DRAG,
        current=CURRENT,
        velocity_amplitude=0.0,
        period=duration,
        duration=duration,
    )
    first = motion.contacts[0]
    end = int(np.searchsorted(motion.time, first.time + 1.0))
    peak = int(np.argmax(motion.tension[:end]))
    late = motion.tension[motion.time > 0.9 * duration]
    rise = float(motion.time[peak]) - first.time
    return Record(motion, first.time, rise, float(motion.tension[peak]), float(late.mean()))


def draw(path: Path) -> None:
    """Draw the records about the taut instant, and the cables apart."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(8.4, 5.4), layout="constrained")
        for column, (tone, (words, stiffness)) in enumerate(zip(TONES, MATERIALS.items())):
            record = release(stiffness)
            axis = axes[0, column]
            axis.plot(record.motion.time, record.motion.tension, color=tone, label=words)
            axis.axhline(record.plateau, color="#5b6775", linestyle=":", linewidth=0.9)
            axis.annotate(
                f"plateau {record.plateau:.2f} N", (0.5 * record.taut, record.plateau), xytext=(0, 4),
                textcoords="offset points", fontsize=8, color="#5b6775", ha="center",
            )  # fmt: skip
            axis.annotate(f"spike {record.spike:.3g} N", (record.taut + record.rise, record.spike), xytext=(6, -10),
                          textcoords="offset points", fontsize=8)  # fmt: skip
            axis.set(xlim=(0.0, record.taut + 3.2), ylim=(0.0, 1.12 * record.spike))
            axis.set(xlabel="time from release [s]", ylabel="tension, both cables [N]")
            axis.legend(loc="upper left", fontsize=8)
            edges = edge_impact(flume(stiffness))
            below = axes[1, column]
            below.plot(1e3 * edges.time, edges.upper_tension, color=tone, label="upper cable")
            below.plot(1e3 * edges.time, edges.lower_tension, color=tone, linestyle=(0, (4, 2)), label="lower cable")
            below.set(xlabel="time from taut [ms]", ylabel="tension of a cable [N]", ylim=(0.0, None))
            below.set_xlim(0.0, 1e3 * float(edges.time[-1]))
            below.legend(loc="upper right", fontsize=8)
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main() -> None:
    """Write the picture and print the readings."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    folder.mkdir(parents=True, exist_ok=True)
    draw(folder / "snap_in_current.png")
    for words, stiffness in MATERIALS.items():
        record = release(stiffness)
        print(
            f"{words}: taut after {record.taut:.3f} s, spike {record.spike:.4g} N after {1e3 * record.rise:.3g} ms, "
            f"plateau {record.plateau:.3f} N, impact {record.spike - record.plateau:.4g} N"
        )
    print(f"wrote {folder / 'snap_in_current.png'}")


if __name__ == "__main__":
    main()
