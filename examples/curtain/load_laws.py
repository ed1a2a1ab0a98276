"""Draw the four load laws of a curtain side by side, in plan and in section, and their spread.

    python examples/curtain/load_laws.py [folder]

writes load_laws.png and prints depth and tension of each law at two load ratios.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from moyai.structures.curtain.statics.load_laws import plan_laws, section_laws

STRETCH = 20.0  # skirt stiffness over toe weight, and EA over load times length, of the elastic law


def depths(ratios: np.ndarray) -> dict[str, np.ndarray]:
    """Return the effective depth over the length of each law, for load ratios qL/W."""
    found: dict[str, list[float]] = {}
    for ratio in ratios:
        for law in section_laws(1.0, 1.0, float(ratio), STRETCH):
            found.setdefault(law.name, []).append(law.effective_depth)
    return {name: np.array(values) for name, values in found.items()}


def tensions(ratios: np.ndarray) -> dict[str, np.ndarray]:
    """Return the tension over load times length of each law that has one, for ratios of span to length."""
    found: dict[str, list[float]] = {}
    for ratio in ratios:
        for law in plan_laws(float(ratio), 1.0, 1.0, STRETCH):
            if law.name != "rigid":
                found.setdefault(law.name, []).append(law.tension)
    return {name: np.array(values) for name, values in found.items()}


def draw(path: Path) -> None:
    """Draw depth against load ratio and tension against span ratio."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    loads, spans = np.linspace(0.05, 4.0, 80), np.linspace(0.4, 0.99, 60)
    for name, values in depths(loads).items():
        axes[0].plot(loads, np.where(values > 0.0, values, np.nan), label=name)
    for name, values in tensions(spans).items():
        axes[1].plot(spans, values, label=name)
    axes[0].set(xlabel="load ratio qL/W", ylabel="effective depth over length")
    axes[1].set(xlabel="span over length", ylabel="T/(q l)", ylim=(0, 2))
    for axis in axes:
        axis.legend()
    figure.savefig(path, dpi=120)


def main() -> None:
    """Write the picture and print two rows."""
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else Path.cwd()
    folder.mkdir(parents=True, exist_ok=True)
    draw(folder / "load_laws.png")
    for ratio in (0.5, 2.0):
        row = ", ".join(f"{name} {float(values[0]):.5f}" for name, values in depths(np.array([ratio])).items())
        print(f"qL/W = {ratio:g}: {row}")


if __name__ == "__main__":
    main()
