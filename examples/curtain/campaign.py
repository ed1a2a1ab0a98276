"""Make a field campaign of anchor tensions, process it as the field paper does, and find again what was planted.

Blocks of 20 minutes: an irregular sea from a direction, a tidal current, two anchors. Every wave pulls once, by the
energy model with its own height; steady tensions have nothing to do with the current; 15 % scatter, noise of the gauge.

    python examples/curtain/campaign.py [folder]

writes campaign.png (regressions, directions, types, residuals of the calibration) and prints the fits.
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from moyai.records.survey.tension_blocks import Blocks, analyse_blocks
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.series.regressions import correlation, fit_by_direction, fit_cosine, fit_line, type_ratio
from moyai.series.zero_crossing import zero_crossing
from moyai.structures.curtain.seas.anchor_energy import FITTING_RULES, EnergyModel, calibrate, calibration_bounds
from moyai.structures.curtain.seas.squared_velocity import effective_height, fit_proportional, squared_velocity

Array = NDArray[np.float64]

WATER = Water(depth=20.0, density=1025.0, gravity=9.81)
CURTAIN_DEPTH, BLOCK, STEP = 5.0, 1200.0, 0.1
NEW = EnergyModel(
    energy_factor=0.2, float_mass=518.0, rope_stiffness=890e3, orbital_factor=2.0, line_factor=1.0, type_factor=0.7
)
CONVENTIONAL = EnergyModel(
    energy_factor=0.2, float_mass=518.0, rope_stiffness=890e3, orbital_factor=2.0, line_factor=1.0, type_factor=1.0
)


@dataclass(frozen=True, eq=False)
class Campaign:
    """A record and what was put into it, block by block."""

    time: Array
    elevation: Array
    new: Array
    conventional: Array
    current: Array
    angle: Array
    steady: Array


def campaign(
    seed: int, blocks: int, *, pretension_in_model: float = 0.0, currents: float = 0.2, scatter: float = 0.15
) -> Campaign:
    """Return a campaign of so many blocks; angles of the waves are spread over 0 to 75 degrees from the normal."""
    rng = np.random.default_rng(seed)
    size = round(BLOCK / STEP)
    time = STEP * np.arange(blocks * size)
    elevation, new, conventional = np.empty(time.size), np.empty((2, time.size)), np.empty((2, time.size))
    current = np.zeros((time.size, 2))
    angle, steady = np.radians(rng.uniform(0.0, 75.0, blocks)), rng.uniform(4e3, 12e3, blocks)
    for k in range(blocks):
        part = slice(k * size, (k + 1) * size)
        height = rng.uniform(0.4, 3.0)
        flow = currents * np.sin(2.0 * np.pi * k / 18.0)
        sea = synthesise(
            jonswap(height, 3.86 * np.sqrt(height), 3.3), WATER, duration=BLOCK, seed=seed * 1000 + k, time_step=STEP,
            heading=angle[k], amplitudes="rayleigh",
        )  # fmt: skip
        local = STEP * np.arange(size)
        elevation[part] = sea.elevation(local)
        current[part, 0] = flow
        for model, lines, more in ((NEW, new, 0.0), (CONVENTIONAL, conventional, 3e3)):
            pulls = _pulls(model, elevation[part], local, angle[k], flow, pretension_in_model, rng, scatter)
            for line in lines:
                line[part] = steady[k] + more + pulls * rng.uniform(0.95, 1.05) + 60.0 * rng.standard_normal(size)
    return Campaign(time, elevation, new, conventional, current, angle, steady)


def _pulls(
    model: EnergyModel, elevation: Array, time: Array, angle: float, flow: float, pretension: float,
    rng: np.random.Generator, scatter: float,
) -> Array:  # fmt: skip
    """Return one short pull for every wave, at its crest."""
    waves = zero_crossing(time, elevation)
    acting = effective_height(waves.height, np.full(len(waves), angle), "paper", 1.0)
    speed = model.float_speed(acting, np.maximum(waves.period, 1.0), flow, WATER)
    size = model.fluctuating_tension(speed, pretension) * np.maximum(
        1.0 + scatter * rng.standard_normal(len(waves)), 0.1
    )
    out = np.zeros(time.size)
    for start, period, top in zip(waves.start, waves.period, size):
        centre, width = start + 0.25 * period, 0.05 * period
        near = slice(*np.searchsorted(time, [centre - 5.0 * width, centre + 5.0 * width]))
        out[near] += top * np.exp(-0.5 * ((time[near] - centre) / width) ** 2)
    return out


def process(data: Campaign, conventional: bool = False) -> Blocks:
    """Run the chain over one type of the campaign."""
    return analyse_blocks(
        data.time, data.elevation, data.conventional if conventional else data.new, block=BLOCK, rule="median",
        wave_heading=data.angle, current=data.current, normal_heading=0.0,
    )  # fmt: skip


def draw(path: Path, data: Campaign) -> None:
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
    for rule in FITTING_RULES:
        fit = calibrate(*_observations(old), 0.0, line_factor=1.0, rule=rule)
        axes[1, 2].plot(fit.calculated / 1e3, fit.residual, ".", label=rule)
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


def _observations(blocks: Blocks) -> tuple[Array, Array]:
    """Return largest tensions and the float speeds of the highest waves, current along the normal."""
    height = effective_height(blocks.maximum_height, blocks.angle, "paper", 1.0)
    speed = CONVENTIONAL.float_speed(height, blocks.significant_period, blocks.current_normal, WATER)
    return blocks.averaged("maximum"), speed


def report(data: Campaign) -> list[str]:
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
    for rule in FITTING_RULES:
        observed, speed = _observations(old)
        fit = calibrate(observed, speed, 0.0, line_factor=1.0, rule=rule)
        low, high = calibration_bounds(observed, speed, 0.0, line_factor=1.0, rule=rule, seed=1)
        scale = CONVENTIONAL.float_mass * CONVENTIONAL.rope_stiffness
        lines.append(
            f"{rule}: M = {fit.energy_factor(CONVENTIONAL.float_mass, CONVENTIONAL.rope_stiffness):.3f}, 95 % "
            f"{fit.interval[0] / scale:.3f} to {fit.interval[1] / scale:.3f} (covariance), "
            f"{low / scale:.3f} to {high / scale:.3f} (drawn again)"
        )
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
