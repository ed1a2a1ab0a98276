"""Bodies in networks: the moored box over a hundred wave periods, cost of a step and how it grows with the lines.

    OMP_NUM_THREADS=1 python benchmarks/bench_coupled.py

CPU time, warm, one thread. The same lines driven with the motion that came out, without the joint, are the limit that
the ratio refers to.
"""

from __future__ import annotations

import importlib.util
import json
import time
from pathlib import Path

import numpy as np

from moyai.coupled.equilibrium import find_coupled_equilibrium
from moyai.coupled.planar import PlanarBody
from moyai.coupled.planar_march import PlanarMarch
from moyai.coupled.simulate import simulate_coupled
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.motion import Motion
from moyai.flexible.simulation import simulate
from moyai.floating.forcing import RegularForcing
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.time import CumminsModel
from moyai.sea.water import Water

EXAMPLE = Path(__file__).resolve().parents[1] / "examples/coupled/moored_box.py"


def say(**record: object) -> None:
    """Print one JSON line."""
    print(json.dumps(record), flush=True)


def load_example():
    """Return the module of the moored box."""
    spec = importlib.util.spec_from_file_location("moored_box", EXAMPLE)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def main() -> None:
    """Run everything."""
    example = load_example()
    for bars in (10, 20, 40, 80, 160):
        network, points = example.chains(bars)
        rest = find_coupled_equilibrium(network, {"box": example.box("morison", points)})
        options = {"output_step": 0.025, "flow": example.sea(), "start": rest.state, "body_step": 0.0125}
        simulate_coupled(rest.network, rest.bodies, duration=0.5, **options)
        began = time.process_time()
        history = simulate_coupled(rest.network, rest.bodies, duration=10.0, **options)
        spent = time.process_time() - began
        body = history.bodies["box"]
        motions = {}
        for name, place in points.items():
            there = body.position + np.einsum("kij,j->ki", body.rotation, place)
            motions[name] = Motion.from_table(
                history.time, there - rest.network.nodes.position[rest.network.points[name]]
            )
        simulate(rest.network, motions, duration=10.0, output_step=0.025, flow=example.sea(), start=rest.state)
        began = time.process_time()
        simulate(rest.network, motions, duration=10.0, output_step=0.025, flow=example.sea(), start=rest.state)
        alone = time.process_time() - began
        steps = 10.0 / history.body_step
        say(
            what="cost of a body step", bars=4 * bars, nodes=len(network.nodes), ms_per_body_step=1e3 * spent / steps,
            passes=history.passes, network_step=history.network_step, ratio_to_lines_alone=spent / alone,
        )  # fmt: skip
    for model in ("coefficients", "morison"):
        began = time.process_time()
        history = example.run(model, periods=100.0)
        say(
            what="moored box, 100 wave periods", model=model, cpu_s=time.process_time() - began, status=history.status,
            passes=history.passes, body_step=history.body_step,
        )  # fmt: skip
    compare_march()


def planar_unit():
    """Return a network of two chains and a pontoon of three motions that rides on them."""
    water = Water(depth=10.0, density=1025.0, gravity=9.81)
    chain = BarType("chain", mass_per_length=90.0, axial_stiffness=3e8, diameter=0.12, volume_per_length=0.0115)
    bed = Bed(-10.0, stiffness=3e5, damping=3e4, friction=0.5)
    builder, points = NetworkBuilder(water, bed), {"seaward": (-5.0, 0.0, -2.3), "shoreward": (5.0, 0.0, -2.3)}
    for name, (x, y, z) in points.items():
        builder.fixed(f"{name} anchor", (20.0 * x, y, -10.0))
        builder.driven(name, (x, y, z))
        builder.line(name, f"{name} anchor", name, chain, length=97.0, segments=40)
    inertia, damping = np.diag([1.5e6, 2.2e6, 1.2e7]), np.diag([6e4, 2e5, 8e5])
    poles, inputs = np.array([-0.6 + 1.1j, -0.4 + 0.2j]), np.eye(2, 3, dtype=complex)
    memory = StateSpaceMemory(poles, inputs, 1e4 * inputs.T.conj(), np.diag([1e4, 2e4, 1e5]))
    model = CumminsModel(inertia, np.diag([2e4, 2e6, 1.2e7]), damping, memory)
    forcing = RegularForcing(
        omega=1.3, wave_amplitude=0.6, excitation_force=np.array([4e5 + 1e5j, 6e5 - 2e5j, 1e6j]),
        mean_drift=np.array([2e4, 0.0, 0.0]), steady=np.zeros(3), ramp=8.0,
    )  # fmt: skip
    return builder.build(), PlanarBody("unit", model, forcing, duration=64.0, points=points)


def compare_march() -> None:
    """Time the compiled march of a planar body against the general joint, in the same run."""
    network, body = planar_unit()
    possible, spent = PlanarMarch.where_possible, {}
    for way, found in (("joint", lambda *_: None), ("march", possible)):
        PlanarMarch.where_possible = found
        for _ in range(2):  # the first one compiles
            began = time.process_time()
            history = simulate_coupled(network, {"unit": body}, duration=60.0, output_step=0.04, body_step=0.04)
            spent[way] = time.process_time() - began
    say(
        what="planar body on two chains, 60 s", status=history.status, passes=history.passes,
        joint_s=spent["joint"], march_s=spent["march"], ratio=spent["joint"] / spent["march"],
    )  # fmt: skip


if __name__ == "__main__":
    main()
