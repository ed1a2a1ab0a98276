"""Speed of the whole span of a curtain: one wave period of a 48 x 16 sheet, and growth with the cells.

    python benchmarks/bench_curtain_dynamic.py

Prints JSON lines: CPU seconds of one wave period (5 s) of a span of 15 m with a skirt of 4 m in waves and current, from
the built network to the returned arrays, loads and output included, on several meshes; the same per cell and step.
Stress and loads of a crumpled sheet of 48 x 16 cells, triangles side by side over one by one. One core, warm;
compilation stated apart.
"""

from __future__ import annotations

import json
import time

import numpy as np

from moyai.flexible import sheet_kernel, sheet_lanes
from moyai.flexible.explicit_rows import ROW, WU, U, X
from moyai.flexible.flow import Flow
from moyai.flexible.simulation import simulate
from moyai.sea.current import uniform
from moyai.sea.regular import RegularWave
from moyai.sea.water import Water
from moyai.structures.curtain.dynamic.assembly import build_span
from moyai.structures.curtain.dynamic.model import CurtainSpan, Mesh

PERIOD = 5.0
WATER = Water(10.0, 1025.0, 9.81)
SPAN = CurtainSpan(
    span=15.0, length=16.5, skirt_length=4.0, chord=4.0, upper_stiffness=2.5e6, lower_stiffness=4e5, upper_mass=15.3,
    lower_mass=15.0, lower_volume=0.0019, sheet_stiffness=3e5, sheet_mass=0.8, sheet_volume=5.8e-4,
    drag_coefficient=1.5, float_volume=0.0975, float_height=0.35, edges="risen",
)  # fmt: skip


def run(along: int, down: int, periods: float) -> tuple[float, int, float]:
    """Return CPU time [s], steps, and peak [N] of a run."""
    built = build_span(SPAN, Mesh(along, down), WATER)
    waves = RegularWave(0.8, PERIOD, 0.0, WATER).components()
    flow = Flow(current=uniform(0.2, 0.0), waves=waves, ramp=PERIOD)
    begin = time.process_time()
    history = simulate(built.network, duration=periods * PERIOD, output_step=PERIOD / 400, flow=flow, start=built.state)
    if history.status != "converged":
        raise RuntimeError(history.message)
    return time.process_time() - begin, history.steps, float(history.tension_peak.max())


def kernels() -> dict[str, float | str]:
    """Return nanoseconds a triangle of stress and loads, side by side and one by one, in the same run."""
    built = build_span(SPAN, Mesh(48, 16), WATER)
    sheets = built.network.sheets
    assert sheets is not None
    rng, rest = np.random.default_rng(1), built.network.nodes.position.T
    nodes, count = rest.shape[1], len(sheets)
    table = sheets.constants(WATER, rest.T)
    place, speed = rest + 0.01 * rng.normal(size=rest.shape), 0.3 * rng.normal(size=rest.shape)
    water, light = rng.normal(size=(7, nodes)), np.ones((4, nodes))
    memory = np.zeros(50 * ROW)
    for first, rows in ((X, place), (U, speed), (WU, water)):
        for axis, row in enumerate(rows):
            memory[first + axis * ROW :][:nodes] = row
    packed, room = sheet_lanes.packed_constants(table), np.zeros(sheet_lanes.ROWS * sheet_lanes.LANES)
    which, peak, force = np.zeros(sheet_lanes.LANES, dtype=np.int64), np.zeros(count), np.zeros(3 * nodes)
    at, fast, flow, corners = place.ravel(), speed.ravel(), water.ravel(), np.ascontiguousarray(sheets.triangles)

    def side_by_side() -> None:
        sheet_lanes.sheet_forces(memory, corners, packed, room, which, peak)
        sheet_lanes.sheet_loads(memory, corners, packed, room, light, 1e-3)

    def one_by_one() -> None:
        sheet_kernel.sheet_forces(table, corners, at, 0, fast, 0, force, 0, 1, nodes, peak)
        sheet_kernel.sheet_loads(table, corners, at, 0, fast, 0, flow, 0, force, 0, 1, nodes, light, 1e-3)

    best = {}
    for work in (side_by_side, one_by_one):
        work()
        spent = []
        for _ in range(200):
            begin = time.perf_counter()
            work()
            spent.append(time.perf_counter() - begin)
        best[work] = 1e9 * min(spent) / count
    lanes, alone = best[side_by_side], best[one_by_one]
    return {
        "case": "stress and loads, ns a triangle", "side_by_side": round(lanes, 1), "one_by_one": round(alone, 1),
        "ratio": round(alone / lanes, 2),
    }  # fmt: skip


def main() -> None:
    """Measure and print."""
    print(json.dumps(kernels()), flush=True)
    begin = time.process_time()
    run(8, 4, 0.1)
    print(json.dumps({"case": "first use", "cpu_s": round(time.process_time() - begin, 2)}), flush=True)
    for along, down in ((12, 4), (24, 8), (48, 16)):
        seconds, steps, peak = run(along, down, 1.0)
        print(
            json.dumps(
                {
                    "case": f"{along} x {down} cells, one wave period",
                    "cpu_s": round(seconds, 3),
                    "steps": steps,
                    "ns_per_cell_and_step": round(1e9 * seconds / steps / along / down, 1),
                    "over_real_time": round(seconds / PERIOD, 3),
                    "peak_N": round(peak, 1),
                }
            ),
            flush=True,
        )


if __name__ == "__main__":
    main()
