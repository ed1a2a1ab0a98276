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

from moyai.coupled.rest import find_rest
from moyai.coupled.simulate import simulate_coupled
from moyai.flexible.motion import Motion
from moyai.flexible.simulation import simulate

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
        rest = find_rest(network, {"box": example.box("morison", points)})
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


if __name__ == "__main__":
    main()
