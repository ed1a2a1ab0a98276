"""Speed of the whole span of a curtain: one wave period of a 48 x 16 sheet, and growth with the cells.

    python benchmarks/bench_curtain_dynamic.py

Prints JSON lines: CPU seconds of one wave period (5 s) of a span of 15 m with a skirt of 4 m in waves and current, from
the built network to the returned arrays, loads and output included, on several meshes; the same per cell and step.
One core, warm; compilation stated apart.
"""

from __future__ import annotations

import json
import time

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


def main() -> None:
    """Measure and print."""
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
