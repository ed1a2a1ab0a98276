"""Speed of the flexible cage: time of a run over the time that it simulates, rest, and growth with the nodes.

    python benchmarks/bench_cage.py

Prints JSON lines. A full-scale cage (50 m, two rings, grid of four anchor lines) in a current of 0.5 m/s and waves of
2 m and 8 s; one core, warm, medians of three; compilation distinguished.
"""

from __future__ import annotations

import json
import statistics
import time
from collections.abc import Callable
from dataclasses import replace

from moyai.flexible.bed import Bed
from moyai.morison.net_law_names import Net, net_law
from moyai.sea.current import uniform
from moyai.sea.water import Water
from moyai.structures.cage.flexible.build import build_cage
from moyai.structures.cage.flexible.collar import Collar, Pipe
from moyai.structures.cage.flexible.design import CageDesign, CageNet
from moyai.structures.cage.flexible.equilibrium import solve_cage_equilibrium
from moyai.structures.cage.flexible.grid_mooring import Buoy, GridMooring
from moyai.structures.cage.flexible.model import CageMesh, FlexibleCage
from moyai.structures.cage.flexible.problem import FlexibleSettings
from moyai.structures.cage.flexible.time import run_cage
from moyai.structures.cage.rigid.waves import wave_of
from moyai.tables.lines import line_type

WATER = Water(60.0, 1025.0, 9.81)
SIMULATED = 40.0


def cage(mesh: CageMesh) -> FlexibleCage:
    """Return the full-scale cage of examples/cage/circular_50m.yaml on a mesh."""
    pipe = Pipe(0.45, 0.0265, 955.0, 0.9e9, 0.42, 1.0, 0.1, 1.0, 12.0)
    tube = Pipe(0.28, 0.0255, 955.0, 0.9e9, 0.42, 1.0, 0.1, 1.0, 50.0, flooded=True)
    net = CageNet(Net(0.0025, 0.0225), net_law("loland"), "loland", 15.0, "cone", 1140.0, 1e9, cone_depth=5.0)
    rope, chain = line_type("polyester", 0.072), line_type("studless_chain_U3", 0.048)
    grid = GridMooring(
        75.0, 6.0, line_type("polyester", 0.064), Buoy(1.6, 200.0, 0.6), line_type("nylon", 0.064), 3,
        ((rope, 160.0), (chain, 27.5)), 180.0,
    )  # fmt: skip
    design = CageDesign("circular", 50.0, Collar(pipe, 2, 0.9), net, None, tube, 200.0)
    return FlexibleCage(design, grid, WATER, Bed(-60.0, 1e5, 1e4, 0.6), mesh, 1.3e-6)


def cpu(action: Callable[[], object], repeat: int = 3) -> float:
    """Return the median CPU time of an action [s]."""
    found = []
    for _ in range(repeat):
        begin = time.process_time()
        action()
        found.append(time.process_time() - begin)
    return statistics.median(found)


def main() -> None:
    """Run all."""
    current = uniform(0.5, 0.0)
    wave = wave_of("linear", 2.0, 8.0, 0.0, WATER, 0.5, 1)
    settings = FlexibleSettings(("time",), ramp_periods=2.0, rows_per_period=40)
    wave = replace(wave, duration=SIMULATED - 16.0)
    for number, (around, down, bottom) in enumerate(((24, 4, 3), (32, 8, 4), (48, 12, 6), (64, 20, 8), (96, 36, 12))):
        model = cage(CageMesh(around, down, bottom, 8.0))
        built = build_cage(model)
        begin = time.process_time()
        rest = solve_cage_equilibrium(model, built, current)
        first = time.process_time() - begin
        if number == 0:
            run_cage(model, rest, replace(wave, duration=1.0), settings)
            print(
                json.dumps({"what": "first use, compilation and all", "cpu_s": round(time.process_time() - begin, 1)})
            )
            first = cpu(lambda m=model, b=built: solve_cage_equilibrium(m, b, current), 1)
        run = run_cage(model, rest, wave, settings)
        taken = cpu(lambda m=model, r=rest: run_cage(m, r, wave, settings), 3 if number < 3 else 1)
        nodes = len(built.network.nodes)
        print(
            json.dumps(
                {
                    "what": "cage of 50 m in waves and current",
                    "nodes": nodes,
                    "bars": len(built.network.bars),
                    "panels": len(built.network.panels) if built.network.panels is not None else 0,
                    "step_ms": round(1e3 * run.history.step, 3),
                    "status": run.history.status,
                    "rest_cpu_s": round(first, 2),
                    "simulated_s": SIMULATED,
                    "cpu_s": round(taken, 2),
                    "times_faster_than_real_time": round(SIMULATED / taken, 1),
                    "ns_per_node_and_step": round(1e9 * taken / run.history.steps / nodes),
                }
            )
        )


if __name__ == "__main__":
    main()
