"""The moored box of Wu et al. (2018) in waves, on four chains in motion, by two models of its water loads.

Box 0.2 x 0.2 x 0.132 m, 3.148 kg, moments of inertia 0.015, 0.015, 0.021 kg m2, 0.5 m of water, waves of 0.12 m and
2.0 s; four chains of 1.455 m, 0.0607 kg/m, EA 29 N, drag 1.6, to anchors at (+-1.385, +-0.423) m. Assumed, since the
source at hand does not tell: fairleads at the bottom corners, centre of gravity 12.6 mm under still water, chain
diameter 3.656 mm, added mass 1, drag along the chain 0.5, bed without friction, drag of the box 1.0 on its wet faces.

(a) coefficients of Capytaine (diffraction, radiation with memory, linear hydrostatics) and quadratic drag;
(b) sixteen upright columns with buoyancy under the moving surface, inertia and drag of the undisturbed wave (Morison),
    added mass 0.5 sideways and 0.8 up and down.

Run: python examples/coupled/moored_box.py
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np

from moyai.coupled.equilibrium import find_coupled_equilibrium
from moyai.coupled.hulls import box_hull
from moyai.coupled.rigid import RigidBody
from moyai.coupled.simulate import CoupledHistory, simulate_coupled
from moyai.coupled.wave_loads import WaveLoads
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.interop.read import read_coefficients
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.series.snaps import find_snaps

WATER = Water(depth=0.5, density=1000.0, gravity=9.81)
DRAUGHT, CENTRE = 0.0787, 0.0661
PERIOD, HEIGHT = 2.0, 0.12
COEFFICIENTS = Path(__file__).parents[2] / "tests/validation/data/wu_box_capytaine.nc"
CORNERS = {"front left": (-1, 1), "front right": (-1, -1), "back left": (1, 1), "back right": (1, -1)}


def chains(bars: int = 20) -> tuple[Network, dict[str, tuple[float, float, float]]]:
    """Return the four chains and the points of the box that they hang on."""
    chain = BarType(
        "chain", 0.0607, 29.0, 0.003656, viscosity=0.05, drag_normal=1.6, drag_tangential=0.5, added_mass_normal=1.0
    )
    builder = NetworkBuilder(WATER, Bed(-0.5, 1e5, 1e3))
    points = {name: (0.1 * x, 0.1 * y, 0.0) for name, (x, y) in CORNERS.items()}
    for name, (x, y) in CORNERS.items():
        builder.fixed(f"anchor {name}", (1.385 * x, 0.423 * y, -0.5))
        builder.driven(name, (0.1 * x, 0.1 * y, -DRAUGHT))
        builder.line(name, f"anchor {name}", name, chain, length=1.455, segments=bars)
    return builder.build(), points


def box(model: str, points: dict[str, tuple[float, float, float]]) -> RigidBody:
    """Return the box with one of the two models of its water loads."""
    face = 0.2 * DRAUGHT
    if model == "coefficients":
        dataset = read_coefficients("capytaine", COEFFICIENTS)
        loads = WaveLoads.from_dataset(dataset, displaced_volume=3.148e-3, equilibrium_position=(0.0, 0.0, -DRAUGHT))
        drag = 500.0 * np.array([face, face, 0.04, 0.0, 0.0, 0.0])
        return RigidBody(
            "box", 3.148, (0.015, 0.015, 0.021), (0, 0, CENTRE), (0, 0, -DRAUGHT), points=points, loads=loads,
            quadratic_damping=drag,
        )  # fmt: skip
    hull = box_hull((0.2, 0.2, 0.132), bottom=0.0, drag=(1, 1, 1), added_mass=(0.5, 0.5, 0.8), density=1000.0)
    return RigidBody("box", 3.148, (0.015, 0.015, 0.021), (0, 0, CENTRE), (0, 0, -DRAUGHT), points=points, lumps=hull)


def sea(ramp: float = 2.0 * PERIOD) -> Flow:
    """Return the regular wave, along +x."""
    omega = 2.0 * np.pi / PERIOD
    number = wave_number(np.array([omega]), WATER.depth, WATER.gravity)
    return Flow(waves=WaveComponents([omega], [0.5 * HEIGHT], [0.0], [0.0], number, WATER), ramp=ramp)


def run(model: str, *, periods: float = 20.0, bars: int = 20) -> CoupledHistory:
    """Run one model from rest."""
    network, points = chains(bars)
    rest = find_coupled_equilibrium(network, {"box": box(model, points)})
    return simulate_coupled(
        rest.network, rest.bodies, duration=periods * PERIOD, output_step=0.025, flow=sea(), start=rest.state
    )


def figures(history: CoupledHistory, last: float = 5.0) -> dict[str, float]:
    """Return double amplitudes of the motions [m, deg], extremes of tension [N] and slack of the chains."""
    body, network = history.bodies["box"], history.network
    keep = history.time > history.time[-1] - last * PERIOD
    found = {
        "surge": float(np.ptp(body.position[keep, 0])),
        "heave": float(np.ptp(body.position[keep, 2])),
        "pitch": float(np.degrees(np.ptp(body.angles[keep, 1]))),
        "offset": float(np.mean(body.position[keep, 0])),
    }
    for side, name in (("front", "front left"), ("back", "back left")):
        bar = int(history.network.bars[[*CORNERS].index(name) * (len(network.bars) // 4) + len(network.bars) // 4 - 1])
        pull, peak = network.tension[keep, bar], network.tension_peak[keep, bar]
        snaps = find_snaps(history.time[keep], pull, slack_level=0.02, threshold=3.0 * float(pull.mean()), peaks=peak)
        found |= {
            f"{side} max": float(peak.max()),
            f"{side} min": float(pull.min()),
            f"{side} slack": snaps.slack_time / (last * PERIOD),
            f"{side} contacts": float(len(snaps.contacts)),
        }
    return found


def main() -> None:
    """Print both models side by side."""
    table = {}
    for model in ("coefficients", "morison"):
        began = time.process_time()
        history = run(model)
        table[model] = figures(history)
        print(
            f"{model}: {history.status}, {history.passes:.2f} passes a step of {history.body_step:.3g} s, "
            f"{time.process_time() - began:.1f} s of CPU"
        )
    print(f"{'':16s}{'coefficients':>14s}{'Morison':>14s}")
    for name, value in table["coefficients"].items():
        print(f"{name:16s}{value:14.4f}{table['morison'][name]:14.4f}")


if __name__ == "__main__":
    main()
