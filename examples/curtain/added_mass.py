"""Redraw the added mass of the impact paper: M and N of a skirt against frequency, and against its curvature.

Sawaragi, Aoki and Liu (1991) computed the added mass of a flat, curved and stretching skirt by boundary elements on
both sides of the sheet. Here the plate of no thickness is solved as such: above, M and N of flat and curved skirts of
the same chord d over the frequency (centre of the circle a distance s from the chord: s/d = 0 is a half circle, large
s/d the plate); below, at infinite frequency, rigid motion M_xx, force per acceleration of the stretching skirt M_xc and
its energy M_cc against s/d, over M0 of the chord and over M0 of the arc, since the paper does not say which length it
took.

    python examples/curtain/added_mass.py [folder]

writes added_mass.png and prints the plate at some frequencies and the half circle.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from moyai.potential.modes import Modes, Rigid
from moyai.potential.solver import solve
from moyai.potential.thin_plate import Plate, hanging_arc, horizontal_motion, solve_plate_limit
from moyai.potential.thin_plate_waves import plate_section
from moyai.sea.water import Water

Array = NDArray[np.float64]

DRAUGHT, RELATIVE_DEPTH = 0.15, 3.0
WATER = Water(depth=RELATIVE_DEPTH * DRAUGHT, density=1000.0, gravity=9.81)
DEEP = Water(depth=math.inf, density=1000.0, gravity=9.81)
SWAY = Modes(("sway",), (Rigid("sway"),))
TONES = ("#0072b2", "#d55e00", "#009e73", "#b5609a")
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


def flat_mass(draught: float) -> float:
    """Return M0 = 2 rho d^2/pi [kg/m]."""
    return 2.0 * WATER.density * draught**2 / math.pi


def against_frequency(centre_distance: float, number: Array, water: Water = WATER) -> tuple[Array, Array]:
    """Return M/M0 and N/(omega M0) of a skirt in rigid motion over K d = omega^2 d/g.

    Parameters
    ----------
    centre_distance : float
        s/d [-]; infinite for the flat plate. A half circle (0) leaves the still water flat, where no waves come back.
    number : ndarray
        K d [-], increasing.
    water : Water
        Its depth counts.
    """
    omega = np.sqrt(number * water.gravity / DRAUGHT)
    if math.isinf(centre_distance):
        plate = Plate((0.0, 0.0), (0.0, -DRAUGHT))
    else:
        plate = hanging_arc(DRAUGHT, centre_distance * DRAUGHT)
    found = solve(plate_section(plate), water, omega, modes=SWAY)
    mass = flat_mass(DRAUGHT) * water.density / WATER.density
    return found.added_mass[:, 0, 0] / mass, found.radiation_damping[:, 0, 0] / (omega * mass)


def against_curvature(distance: Array) -> tuple[Array, Array]:
    """Return M_xx, M_xc, M_cc (3, n) at infinite frequency in deep water over M0 of the chord, and arc over chord."""
    values, lengths = np.empty((3, distance.size)), np.empty(distance.size)
    for column, ratio in enumerate(distance):
        arc = hanging_arc(DRAUGHT, float(ratio) * DRAUGHT)
        radius = DRAUGHT * math.hypot(float(ratio), 0.5)

        def stretch(points: Array, _normals: Array, radius: float = radius) -> Array:
            return np.asarray(points[:, 0] / radius)

        mass = solve_plate_limit(arc, DEEP, (horizontal_motion, stretch)).added_mass / flat_mass(DRAUGHT)
        values[:, column] = mass[0, 0], mass[0, 1], mass[1, 1]
        lengths[column] = arc.length / DRAUGHT
    return values, lengths


def draw(path: Path) -> None:
    """Draw M and N over frequency above, the masses over s/d below."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    number = np.geomspace(0.05, 40.0, 90)
    distance = np.concatenate([[0.0], np.linspace(0.02, 2.0, 60)])
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(8.4, 6.8), layout="constrained")
        for tone, (ratio, words) in zip(
            TONES, ((math.inf, "flat plate"), (0.5, "s/d = 0.5"), (0.2, "s/d = 0.2"), (0.1, "s/d = 0.1"))
        ):
            mass, damping = against_frequency(ratio, number)
            axes[0, 0].plot(number, mass, color=tone, label=words)
            axes[0, 1].plot(number, damping, color=tone, label=words)
        axes[0, 0].axhline(1.0, color="#5b6775", linestyle=":", linewidth=0.9)
        axes[0, 0].axhline(0.0, color="#5b6775", linewidth=0.9)
        for axis, label in zip(axes[0], ("$M/M_0$", "$N/(\\omega M_0)$")):
            axis.set(xlabel="$Kd = \\omega^2 d/g$", ylabel=label, xscale="log")
            axis.set_xticks([0.1, 1, 10], ["0.1", "1", "10"])
            axis.legend(fontsize=8)
        masses, lengths = against_curvature(distance)
        for axis, over in zip(axes[1], (np.ones_like(lengths), lengths**2)):
            for tone, values, label in zip(
                TONES, masses, ("$M_{xx}$ rigid", "$M_{xc}$ stretch, force", "$M_{cc}$ energy")
            ):
                axis.plot(distance, values / over, color=tone, label=label)
            axis.set(xlabel="s/d", xlim=(0.0, 2.0), ylim=(0.0, None))
            axis.legend(fontsize=8)
        axes[1, 0].set_ylabel("over $M_0$ of the chord")
        axes[1, 1].set_ylabel("over $M_0$ of the arc")
        figure.suptitle(f"above: h/d = {RELATIVE_DEPTH:g}, chord d; below: infinite frequency, deep water", fontsize=9)
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main() -> None:
    """Write the picture and print what the paper states."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    folder.mkdir(parents=True, exist_ok=True)
    draw(folder / "added_mass.png")
    number = np.array([0.1, 0.5, 1.0, 2.0, 10.0, 30.0])
    for value, mass, damping in zip(number, *against_frequency(math.inf, number)):
        print(f"plate, Kd = {value:g}: M/M0 = {mass:.4f}, N/(omega M0) = {damping:.4f}")
    masses, lengths = against_curvature(np.array([0.0, 0.5]))
    over_arc = masses[0, 0] / lengths[0] ** 2
    print(f"half circle, infinite frequency: {masses[0, 0]:.4f} M0 of the chord, {over_arc:.4f} of the arc")
    print(f"stretching skirt, s/d = 0.5: M_xc = {masses[1, 1]:.4f} M0")
    print(f"wrote {folder / 'added_mass.png'}")


if __name__ == "__main__":
    main()
