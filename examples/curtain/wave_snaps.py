"""Find and fit the snaps of a curtain in irregular waves, with and without a current.

Three hours of a JONSWAP sea run over a curtain 5 m deep in 20 m of water. Each contact is located; first contacts of a
half wave that are fast enough are snaps. Their exceedance is fitted and gives the largest to be expected in a storm.

    python examples/curtain/wave_snaps.py [folder]

writes wave_snaps.png and prints rates and maxima.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np

from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.series.snap_statistics import SnapFit, dispersion, fit_snaps
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.snaps.events import SeaSnaps, compare_steps, snaps_in_sea, suggested_time_step
from moyai.structures.curtain.snaps.flow import SkirtVelocity, flow_over_skirt

WATER = Water(depth=20.0, density=1025.0, gravity=9.81)
CURTAIN = Impact(span=15.0, length=17.0, draught=5.0, upper_stiffness=2e6, lower_stiffness=2e6, speed=0.3, water=WATER)
PERIOD, HOURS, DRAG, SLOWEST = 6.0, 3.0, 1.2, 0.2


def snaps(
    significant_height: float,
    current: float,
    *,
    heading: float = 0.0,
    velocity: SkirtVelocity = "skirt_mean",
    refine: int = 1,
    seed: int = 11,
    hours: float = HOURS,
) -> SeaSnaps:
    """Return the snaps of a sea; ``heading`` [rad] counts from the normal of the curtain."""
    step = suggested_time_step(PERIOD)
    sea = synthesise(
        jonswap(significant_height, PERIOD, 3.3),
        WATER,
        duration=3600.0 * hours,
        seed=seed,
        time_step=step,
        heading=heading,
    )
    flow = flow_over_skirt(
        sea,
        WATER,
        draught=CURTAIN.draught,
        normal_heading=0.0,
        current=current,
        duration=3600.0 * hours,
        time_step=step / refine,
        velocity=velocity,
        span=CURTAIN.span,
    )
    return snaps_in_sea(CURTAIN, flow, drag_coefficient=DRAG, slowest=SLOWEST, transient=10.0 * PERIOD)


def fit(found: SeaSnaps) -> SnapFit:
    """Fit the upper half of the peaks."""
    return fit_snaps(found.snap_tension, found.hours, threshold=float(np.median(found.snap_tension)), seed=1)


def draw(path: Path, found: SeaSnaps, law: SnapFit) -> None:
    """Draw a piece of the series and the exceedance."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(12, 4.5), layout="constrained")
    largest = found.time[int(np.argmax(found.tension))]
    near = np.abs(found.motion.time - largest) < 30.0 * PERIOD
    axes[0].plot(found.motion.time[near], found.motion.tension[near] / 1e3, linewidth=0.9)
    axes[0].set(xlabel="time [s]", ylabel="tension of both cables [kN]")
    axes[1].semilogy(law.peaks / 1e3, law.empirical, ".", label="snaps above the threshold")
    grid = np.linspace(law.threshold, 1.3 * law.peaks[0], 200)
    axes[1].semilogy(grid / 1e3, law.exceedance(grid), label=law.law)
    top = law.most_probable_maximum(24.0)
    axes[1].axvspan(top.lower / 1e3, top.upper / 1e3, color="0.9", label="most probable in 24 h")
    axes[1].set(xlabel="peak tension [kN]", ylabel="exceedance", ylim=(1e-4, 1.0))
    axes[1].legend()
    figure.savefig(path, dpi=120)
    plt.close(figure)


def main() -> None:
    """Write the picture and print the table."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    folder.mkdir(parents=True, exist_ok=True)
    for current in (0.0, 0.15, 0.3):
        found = snaps(2.0, current)
        print(
            f"current {current:.2f} m/s: {found.snaps_per_hour:.0f} snaps an hour, {(~found.first).sum()} bounces, "
            f"largest {found.tension.max(initial=0.0) / 1e3:.0f} kN"
        )
    found = snaps(2.0, 0.3)
    law = fit(found)
    for hours in (3.0, 24.0):
        top = law.most_probable_maximum(hours)
        print(
            f"most probable in {hours:g} h: {top.value / 1e3:.0f} kN ({top.lower / 1e3:.0f} to {top.upper / 1e3:.0f})"
        )
    print(
        f"variance over mean of the counts in 20 minutes: {dispersion(found.time[found.counted], 60.0, 10740.0, 9):.2f}"
    )
    for degrees in (0.0, 30.0, 60.0):
        turned = snaps(2.0, 0.3, heading=math.radians(degrees))
        print(f"waves {degrees:.0f} degrees off the normal: {turned.snaps_per_hour:.0f} snaps an hour")
    error = compare_steps(found, snaps(2.0, 0.3, refine=2))
    print(
        f"steps halved: mean snap {error.mean_change:+.1%}, largest {error.largest_change:+.1%}; the paths part after "
        f"{error.parted:.0f} s"
    )
    draw(folder / "wave_snaps.png", found, law)


if __name__ == "__main__":
    main()
