"""Draw the figures of the field paper from its own model: tension against height, direction and squared velocity.

Tabata et al. observed anchor tensions of a curtain 5 m deep in 20 m of water. The energy model with M = 0.2 and a float
mass of 518 kg (sheet and ballast of one unit; the paper gives no mass) is swept over waves; the last figure finds M
again from tensions with 15 % scatter and shows the error against M.

    python examples/curtain/anchor_loads.py [folder]

writes anchor_loads.png and prints the fitted factors of the three rules.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from moyai.sea.water import Water
from moyai.structures.curtain.seas.anchor_energy import (
    FITTING_RULES,
    EnergyCalibration,
    EnergyModel,
    calibrate,
    error_against_product,
)
from moyai.structures.curtain.seas.squared_velocity import DirectionRule, effective_height, squared_velocity

Array = NDArray[np.float64]

RULES: tuple[DirectionRule, ...] = ("paper", "normal", "none")
TONES = ("#0072b2", "#d55e00", "#009e73")
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
WATER = Water(depth=20.0, density=1025.0, gravity=9.81)
CURTAIN_DEPTH, CURRENT, HEIGHT_RATIO = 5.0, 0.2, 1.8
MODEL = EnergyModel(
    energy_factor=0.2, float_mass=518.0, rope_stiffness=890e3, orbital_factor=2.0, line_factor=1.0, type_factor=1.0
)


def period(significant_height: Array) -> Array:
    """Return the period that goes with a significant height where none was recorded, 3.86 sqrt(H) [s]."""
    return 3.86 * np.sqrt(significant_height)


def tension(significant_height: Array, angle: Array, rule: DirectionRule) -> tuple[Array, Array]:
    """Return rope tension [N] and squared velocity [m2/s2] under waves at an angle from the normal [rad]."""
    height = effective_height(significant_height, angle, rule, HEIGHT_RATIO)
    time = period(np.asarray(significant_height))
    load = MODEL.fluctuating_tension(MODEL.float_speed(height, time, CURRENT, WATER), 0.0)
    return load, squared_velocity(height, time, CURRENT, CURTAIN_DEPTH, WATER)


def campaign(seed: int, count: int) -> tuple[Array, Array]:
    """Return observed tensions [N] with 15 % scatter, and the float speeds [m/s] behind them."""
    rng = np.random.default_rng(seed)
    height = rng.uniform(0.3, 3.0, count)
    angle = np.radians(rng.uniform(0.0, 75.0, count))
    speed = MODEL.float_speed(
        effective_height(height, angle, "paper", HEIGHT_RATIO), period(height), rng.uniform(0.0, 0.2, count), WATER
    )
    return MODEL.fluctuating_tension(speed, 0.0) * (1.0 + 0.15 * rng.standard_normal(count)), speed


def fits(observed: Array, speed: Array) -> tuple[EnergyCalibration, ...]:
    """Return the calibration by each rule."""
    return tuple(calibrate(observed, speed, 0.0, line_factor=1.0, rule=rule) for rule in FITTING_RULES)


def draw(path: Path) -> None:
    """Draw the four figures into one picture."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(2, 2, figsize=(8.4, 6.6), layout="constrained")
        heights = np.linspace(0.3, 3.0, 60)
        for tone, degrees in zip(TONES, (0, 30, 60)):
            load, square = tension(heights, np.radians(degrees), "paper")
            axes[0, 0].plot(heights, load / 1e3, color=tone, label=f"{degrees}° from the normal")
            axes[1, 0].plot(square, load / 1e3, color=tone, label=f"{degrees}° from the normal")
        angle = np.radians(np.linspace(0, 90, 91))
        for tone, rule in zip(TONES, RULES):
            load, _ = tension(np.full(angle.shape, 2.0), angle, rule)
            axes[0, 1].plot(np.degrees(angle), load / load[0], color=tone, label=f"rule '{rule}'")
        axes[0, 1].plot(np.degrees(angle), np.cos(angle) ** 2, "k:", label="cos²")
        observed, speed = campaign(7, 200)
        factor = np.linspace(0.1, 0.35, 100)
        unit = MODEL.float_mass * MODEL.rope_stiffness
        mean, deviation = error_against_product(observed, speed, factor * unit)
        axes[1, 1].plot(factor, mean, color=TONES[0], label="mean")
        axes[1, 1].plot(factor, deviation, color=TONES[1], label="root mean square")
        axes[1, 1].axhline(0.0, color="#5b6775", linewidth=0.8)
        for fit, dash in zip(fits(observed, speed), ("-", "--", ":")):
            found = fit.energy_factor(MODEL.float_mass, MODEL.rope_stiffness)
            axes[1, 1].axvline(found, color="#5b6775", linewidth=0.9, linestyle=dash, label=f"{fit.rule}: {found:.3f}")
        labels = (
            ("$H_{1/3}$ [m]", "rope tension [kN]"),
            ("angle of the waves from the normal [°]", "tension over that at 0°"),
            ("squared velocity [m²/s²]", "rope tension [kN]"),
            ("energy factor M", "(calculated − observed)/calculated"),
        )
        for axis, (x, y) in zip(axes.ravel(), labels):
            axis.set(xlabel=x, ylabel=y)
            axis.legend(fontsize=8)
        for axis in axes[:, 0]:
            axis.set(xlim=(0.0, None), ylim=(0.0, None))
        figure.savefig(path, dpi=150)
        plt.close(figure)


def main() -> None:
    """Write the picture and print the fitted factors."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    folder.mkdir(parents=True, exist_ok=True)
    draw(folder / "anchor_loads.png")
    for fit in fits(*campaign(7, 200)):
        low, high = (bound / (MODEL.float_mass * MODEL.rope_stiffness) for bound in fit.interval)
        found = fit.energy_factor(MODEL.float_mass, MODEL.rope_stiffness)
        print(f"{fit.rule}: M = {found:.4f}, 95 % from {low:.4f} to {high:.4f}")
    print(f"wrote {folder / 'anchor_loads.png'}")


if __name__ == "__main__":
    main()
