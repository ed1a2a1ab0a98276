"""Make a flume record of a snapping curtain, read it, and lay the impact models over it.

Two cables of a curtain 0.7 m wide and 0.15 m deep are held, let go in a current of 0.3 m/s, and become taut. The record
has noise, a drifting zero and the sampling rate of a logger; the models are run with the speed of the slack phase, and
nothing is fitted. Give a file with columns time [s], upper and lower tension [N] to read your own record instead.

    python examples/curtain/flume_record.py [folder] [record.csv]

writes flume_record.png and prints what the record says and each model over it.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from moyai.sea.water import Water
from moyai.series.snap_record import MeasuredSnap, read_snap, sampling_loss
from moyai.structures.curtain.impact.cable import Impact, edge_impact
from moyai.structures.curtain.impact.compare import compare_models
from moyai.structures.curtain.impact.record import RecordComparison, compare_record, model_series
from moyai.structures.curtain.impact.release import slack_phase, snap_in_current
from moyai.structures.curtain.impact.skirt import BulgedSkirt

Array = NDArray[np.float64]

WATER = Water(depth=0.4, density=1000.0, gravity=9.81)
CURRENT, DRAG, RELEASE = 0.3, 1.2, 2.0
IMPACT = Impact(
    span=0.7, length=0.8, draught=0.15, upper_stiffness=750.0, lower_stiffness=750.0, speed=CURRENT, water=WATER
)
SKIRT = BulgedSkirt(length=0.15, chord=0.135, stiffness=5e4)
UNLOADED = ((0.0, 1.9), (22.0, 23.0))


def synthetic(rate: float, noise: float, drift: float, seed: int) -> tuple[Array, Array]:
    """Return times [s] and tensions [N] of the upper and lower cable, at a sampling rate [1/s].

    The tension is that of model A with drag; its halves differ as the edges of model A2 do.
    """
    snap = snap_in_current(
        IMPACT, drag_coefficient=DRAG, current=CURRENT, position=0.0, speed=0.0, duration=19.5, time_step=5e-4
    )
    edges = edge_impact(IMPACT, finite_depth=True)
    share = edges.upper_peak / (edges.upper_peak + edges.lower_peak)
    time = np.arange(0.0, 23.0, 1.0 / rate)
    tension = np.interp(time - RELEASE, snap.motion.time, snap.motion.tension, left=0.0, right=0.0)
    # a slack cable carries a little of the drag, the more the farther it has drifted
    slow = np.clip((time - RELEASE) / snap.taut_time, 0.0, 1.0) * 0.04 * snap.peak_tension
    tension += np.where((tension == 0.0) & (time > RELEASE) & (time < RELEASE + 19.5), slow, 0.0)
    rng = np.random.default_rng(seed)
    both = np.stack([share * tension, (1.0 - share) * tension])
    return time, both + noise * rng.standard_normal(both.shape) + drift * time / 23.0 + np.array([[0.7], [-0.3]])


def read(time: Array, tension: Array) -> MeasuredSnap:
    """Read the record; the plateau is sought before the curtain is let loose."""
    return read_snap(time, tension, unloaded=UNLOADED, names=("upper", "lower"), window=(0.0, 21.0))


def compare(found: MeasuredSnap) -> RecordComparison:
    """Hold all models against the record."""
    phase = slack_phase(IMPACT, drag_coefficient=DRAG, current=CURRENT, position=0.0, speed=0.0)
    return compare_record(
        compare_models(phase.started(IMPACT), SKIRT),
        impact_tension=found.impact,
        rise_time=found.rise_time,
        upper_impact=found.cables[0].impact,
        lower_impact=found.cables[1].impact,
        peak_missed=sampling_loss(found.samples_in_rise)[1],
    )


def draw(path: Path, found: MeasuredSnap) -> None:
    """Draw the record and the models over it, from just before the taut instant."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    phase = slack_phase(IMPACT, drag_coefficient=DRAG, current=CURRENT, position=0.0, speed=0.0)
    figure, axes = plt.subplots(1, 2, figsize=(12, 4.5), layout="constrained")
    total = found.tension.sum(axis=0)
    for axis in axes:
        axis.plot(found.time, total, "0.4", linewidth=0.8, label="record, both cables")
        axis.set(xlabel="time [s]", ylabel="tension [N]")
    for name, when in (
        ("release", found.release_time),
        ("taut", found.taut_time),
        ("peak", found.peak_time),
        ("plateau", found.plateau_start),
    ):
        axes[0].axvline(when, linestyle=":", color="0.6")
        axes[0].text(when, found.sum.peak, name, rotation=90, va="top", ha="right", fontsize=8)
    axes[0].axhline(found.sum.plateau, color="0.6", linewidth=0.8)
    for series in model_series(phase.started(IMPACT), drag_coefficient=DRAG, current=CURRENT):
        axes[1].plot(found.taut_time + series.time, series.tension, label=series.model)
    axes[1].set_xlim(found.taut_time - 2.0 * found.rise_time, found.taut_time + 8.0 * found.rise_time)
    axes[1].legend()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def main() -> None:
    """Write the picture and print the numbers."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    folder.mkdir(parents=True, exist_ok=True)
    if len(sys.argv) > 2:
        table = np.loadtxt(sys.argv[2], delimiter=",", comments="#")
        time, tension = table[:, 0], table[:, 1:].T
    else:
        time, tension = synthetic(rate=500.0, noise=0.05, drift=0.4, seed=1)
    found = read(time, tension)
    draw(folder / "flume_record.png", found)
    print(
        f"released {found.release_time:.3f} s, taut {found.taut_time:.3f} s, peak {found.peak_time:.3f} s, "
        f"rise {1e3 * found.rise_time:.1f} ms, plateau from {found.plateau_start:.2f} s"
    )
    for item in (*found.cables, found.sum):
        print(f"{item.name}: peak {item.peak:.2f} N, plateau {item.plateau:.2f} N, impact {item.impact:.2f} N")
    for line in compare(found).lines:
        print(f"{line.model}: {line.tension:.2f} N, {line.tension_ratio:.2f} of the record, time {line.time_ratio:.2f}")
    for notice in found.notices:
        print(f"{notice.code}: {notice.message}")


if __name__ == "__main__":
    main()
