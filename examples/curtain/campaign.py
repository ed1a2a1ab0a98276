"""Make a field campaign of anchor tensions, process it as the field paper does, and find again what was planted.

Blocks of 20 minutes: an irregular sea from a direction, a tidal current, two anchors. Every wave pulls once, by the
energy model with its own height; steady tensions have nothing to do with the current; 15 % scatter, noise of the gauge.
The energy model is fitted to single waves, which finds the planted M, and to the maxima of blocks, which does not: the
largest of many scattered pulls exceeds that of the highest wave, and 1.7 T_1/10 exceeds T_max.

    python examples/curtain/campaign.py [folder]

writes campaign.png (regressions, directions, types, residuals of the calibration) and prints the fits.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from moyai.reproduce.tabata.campaign import (
    CONVENTIONAL,
    CURTAIN_DEPTH,
    WATER,
    FieldCampaign,
    block_maxima,
    by_wave,
    campaign,
    paper_maxima,
    process,
    wave_maxima,
)
from moyai.series.regressions import correlation, fit_by_direction, fit_cosine, fit_line, type_ratio
from moyai.structures.curtain.seas.anchor_energy import FITTING_RULES, calibrate, calibration_bounds
from moyai.structures.curtain.seas.squared_velocity import effective_height, fit_proportional, squared_velocity

MAXIMA = {"T_max over H_max": block_maxima, "1.7 T_1/10 over 1.8 H_1/3 (rule of the paper)": paper_maxima}


def draw(path: Path, data: FieldCampaign) -> None:
    """Draw regressions, directions, types and the residuals of the calibration."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    new, old = process(data), process(data, conventional=True)
    figure, axes = plt.subplots(2, 3, figsize=(14, 8), layout="constrained")
    tenth, degrees = new.averaged("tenth") / 1e3, np.degrees(new.angle)
    dots = axes[0, 0].scatter(new.significant_height, tenth, c=degrees, s=14)
    figure.colorbar(dots, ax=axes[0, 0], label="angle from the normal [°]")
    axes[0, 1].plot(new.current_normal, new.averaged("steady") / 1e3, ".")
    beta = np.linspace(0.0, np.pi / 2, 60)
    reduced = tenth / new.significant_height
    cosine = fit_cosine(new.angle, reduced)
    axes[0, 2].plot(degrees, reduced, ".")
    axes[0, 2].plot(np.degrees(beta), cosine.predict(beta), label=f"cos^{cosine['exponent'].value:.2f}")
    axes[0, 2].legend()
    axes[1, 0].plot(old.averaged("maximum") / 1e3, new.averaged("maximum") / 1e3, ".")
    line, _ = type_ratio(old.averaged("maximum"), new.averaged("maximum"))
    top = old.averaged("maximum").max() / 1e3
    axes[1, 0].plot([0, top], line.predict([0, top]), label=f"slope {line['slope'].value:.2f}")
    axes[1, 0].legend()
    square = squared_velocity(
        effective_height(new.significant_height, new.angle, "normal", 1.8), new.significant_period, new.current_normal,
        CURTAIN_DEPTH, WATER,
    )  # fmt: skip
    axes[1, 1].plot(square, new.averaged("maximum") / 1e3, ".")
    fits = [(name, calibrate(*maxima(old), 0.0, line_factor=1.0)) for name, maxima in MAXIMA.items()]
    for name, fit in fits:
        axes[1, 2].plot(fit.calculated / 1e3, fit.residual, ".", label=name)
    single, (tension, speed) = by_wave(old), wave_maxima(old)
    calculated = np.sqrt(single.product) * speed[single.chosen]
    axes[1, 2].plot(
        calculated / 1e3, 1.0 - (tension[single.chosen] - single.floor) / calculated, ",", color="0.6",
        label="single waves", zorder=0,
    )  # fmt: skip
    axes[1, 2].axhline(0.0, color="0.5", linewidth=0.8)
    axes[1, 2].legend()
    for axis, (x, y) in zip(
        axes.ravel(),
        (
            ("H₁/₃ [m]", "T₁/₁₀ [kN]"),
            ("current along the normal [m/s]", "steady tension [kN]"),
            ("angle from the normal [°]", "T₁/₁₀ / H₁/₃ [kN/m]"),
            ("T_max conventional [kN]", "T_max new type [kN]"),
            ("squared velocity [m²/s²]", "T_max [kN]"),
            ("calculated [kN]", "(calculated − observed)/calculated"),
        ),
    ):
        axis.set(xlabel=x, ylabel=y)
    figure.savefig(path, dpi=110)
    plt.close(figure)


def report(data: FieldCampaign) -> list[str]:
    """Return the fits in lines."""
    new, old = process(data), process(data, conventional=True)
    tenth, top = new.averaged("tenth"), new.averaged("maximum")
    line = fit_line(new.significant_height, new.maximum_height, through_origin=True)["slope"]
    current = correlation(new.current_normal, new.averaged("steady"))
    cosine = fit_cosine(new.angle, tenth / new.significant_height)["exponent"]
    _, ratio = type_ratio(old.averaged("maximum"), top)
    common, classes = fit_by_direction(new.significant_height, tenth, new.angle, np.radians([0, 25, 50, 76]))
    square = squared_velocity(
        effective_height(new.significant_height, new.angle, "normal", 1.8), new.significant_period, new.current_normal,
        CURTAIN_DEPTH, WATER,
    )  # fmt: skip
    shares = [
        f"{np.degrees(item.low):.0f} to {np.degrees(item.high):.0f} deg {item.departure.value:+.2f}"
        for item in classes
        if item.departure
    ]
    lines = [
        f"{len(new)} blocks; H_max/H_1/3 {line.value:.3f}, T_max/T_1/10 {float(np.mean(top / tenth)):.3f}",
        f"steady tension against current: r = {current.value:.3f} ({current.low:.3f} to {current.high:.3f})",
        f"direction: cos^{cosine.value:.2f} ({cosine.low:.2f} to {cosine.high:.2f})",
        f"new over conventional {ratio.value:.3f} ({ratio.low:.3f} to {ratio.high:.3f})",
        f"T_max over squared velocity: R2 = {fit_proportional(square, top).determination:.3f}",
        f"T_1/10 = {common['slope'].value / 1e3:.2f} kN/m H_1/3; off that line " + ", ".join(shares),
    ]
    mass, stiffness = CONVENTIONAL.float_mass, CONVENTIONAL.rope_stiffness
    single = by_wave(old)
    factor, low, high = single.energy_factor(mass, stiffness)
    lines.append(
        f"single waves: M = {factor:.3f}, 95 % {low:.3f} to {high:.3f}, planted {CONVENTIONAL.energy_factor}; "
        f"{single.chosen.sum()} waves of {single.blocks} blocks, scatter {100.0 * single.scatter:.0f} %"
    )
    for name, maxima in MAXIMA.items():
        for rule in FITTING_RULES:
            fit = calibrate(*maxima(old), 0.0, line_factor=1.0, rule=rule)
            bounds = calibration_bounds(*maxima(old), 0.0, line_factor=1.0, rule=rule, seed=1)
            low, high = (bound / (mass * stiffness) for bound in bounds)
            lines.append(f"{name}, {rule}: M = {fit.energy_factor(mass, stiffness):.3f}, 95 % {low:.3f} to {high:.3f}")
    return lines


def main() -> None:
    """Write the picture and print the fits."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    folder.mkdir(parents=True, exist_ok=True)
    data = campaign(3, 60)
    draw(folder / "campaign.png", data)
    print("\n".join(report(data)))


if __name__ == "__main__":
    main()
