"""Draw drag and lift of every law for one net, clean and fouled, and print where each leaves its range.

    python examples/nets/compare_laws.py [folder] [twine diameter in mm] [mesh pitch in mm] [speed in m/s]

writes net_laws.png. Without numbers: the netting of a cage for salmon, 2.4 mm twine in meshes of 22 mm, 0.5 m/s.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from moyai.morison.net_fouling import foul_by_name
from moyai.morison.net_law_names import Net, available_net_laws, net_law
from moyai.morison.net_wake import wake_factor

VISCOSITY = 1.35e-6  # sea water of 10 degrees


def coefficients(net: Net, speed: float, angles: np.ndarray) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return drag and lift of each law over the angle between flow and normal."""
    return {name: net_law(name).coefficients(angles, speed, net, VISCOSITY) for name in available_net_laws()}


def draw(path: Path, net: Net, speed: float) -> None:
    """Draw drag and lift over the angle."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    angles = np.linspace(0.0, 0.5 * np.pi, 91)
    figure = Figure(figsize=(11.0, 4.6), layout="constrained")
    FigureCanvasAgg(figure)
    drag_axis, lift_axis = figure.subplots(1, 2)
    for number, (name, (drag, lift)) in enumerate(coefficients(net, speed, angles).items()):
        style = "-" if net_law(name).kind == "screen" else "--"
        colour = f"C{number % 10}"
        drag_axis.plot(np.degrees(angles), drag, style, color=colour, label=name.replace("_", " "))
        lift_axis.plot(np.degrees(angles), lift, style, color=colour)
    for axis, label in ((drag_axis, "drag coefficient"), (lift_axis, "lift coefficient")):
        axis.set_xlabel("angle between flow and normal [degrees]")
        axis.set_ylabel(f"{label} on the outline")
        axis.grid(alpha=0.3)
    figure.legend(loc="outside right upper", fontsize=8)
    figure.suptitle(f"solidity {net.solidity:.3f}, {speed:g} m/s; twine laws dashed", fontsize=10)
    figure.savefig(path, dpi=150)


def main(arguments: list[str]) -> None:
    """Print and draw."""
    folder = Path(arguments[0]) if arguments else Path()
    diameter, pitch, speed = (float(value) for value in (*arguments[1:], *("2.4", "22", "0.5")[len(arguments[1:]) :]))
    net = Net(diameter * 1e-3, pitch * 1e-3)
    fouled = foul_by_name(net, "ns9415")
    print(f"solidity {net.solidity:.3f}, fouled by half of the diameter {fouled.net.solidity:.3f}")
    print(f"{'law':22} {'C_D':>7} {'fouled':>7} {'C_L 45':>7} {'behind':>7}")
    for name in available_net_laws():
        law = net_law(name)
        drag, lift = law.coefficients(np.radians([0.0, 45.0]), speed, net, VISCOSITY)
        growth = fouled.drag_ratio(law, 0.0, speed, VISCOSITY)
        behind = float(wake_factor("loland", law, net, speed=speed, viscosity=VISCOSITY))
        print(f"{name:22} {drag[0]:7.3f} {growth * drag[0]:7.3f} {lift[1]:7.3f} {behind:7.3f}")
        for notice in law.check(net, (speed, speed), VISCOSITY):
            print(f"    {notice.message}")
    folder.mkdir(parents=True, exist_ok=True)
    draw(folder / "net_laws.png", net, speed)


if __name__ == "__main__":
    main(sys.argv[1:])
