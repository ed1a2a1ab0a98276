"""Curtain impact and thin plates: sweep of ten thousand parameter sets, one plate, memory, three hours of snaps.

    python benchmarks/bench_curtain.py

One thread, warm; prints JSON lines.
"""

from __future__ import annotations

import json
import math
import time

import numpy as np

from moyai.potential.thin_plate import Plate, solve_plate_limit
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, sweep_peaks
from moyai.structures.curtain.impact.memory import impact_with_memory
from moyai.structures.curtain.snaps.events import snaps_in_sea, suggested_time_step
from moyai.structures.curtain.snaps.flow import SkirtFlow, flow_over_skirt

COUNT = 10_000


def sweep() -> dict[str, float]:
    """Time model A over random parameters and hold small strains against the closed form's scaling."""
    rng = np.random.default_rng(1)
    span, length = rng.uniform(0.5, 1.0, COUNT), rng.uniform(1.0, 2.0, COUNT)
    stiffness, speed, mass = 10.0 ** rng.uniform(1, 5, COUNT), rng.uniform(0.1, 1, COUNT), rng.uniform(5, 50, COUNT)
    sweep_peaks(span[:2], length[:2], stiffness[:2], speed[:2], mass[:2])
    start = time.perf_counter()
    sweep_peaks(span, length, stiffness, speed, mass)
    return {"seconds": time.perf_counter() - start, "sets": COUNT}


def plate() -> dict[str, float]:
    """Time one flat plate and give its error against the closed form."""
    water, flat = Water(math.inf, 1.0, 9.81), Plate((0.0, 0.0), (0.0, -1.0))
    solve_plate_limit(flat, water)
    start = time.perf_counter()
    for _ in range(20):
        found = solve_plate_limit(flat, water).added_mass[0, 0]
    return {"seconds": (time.perf_counter() - start) / 20, "error": abs(found * math.pi / 2.0 - 1.0)}


def memory() -> dict[str, float]:
    """Time the first impact with memory of a ratio of depth to draught, and the next ones."""
    impact = Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, Water(0.41, 1000.0, 9.81))
    start = time.perf_counter()
    impact_with_memory(impact)
    first = time.perf_counter() - start
    start = time.perf_counter()
    for _ in range(20):
        impact_with_memory(impact)
    return {"first": first, "seconds": (time.perf_counter() - start) / 20}


def snaps() -> dict[str, float]:
    """Time three hours of sea over a curtain with stiff cables, flow and oscillator apart."""
    water, step = Water(20.0, 1025.0, 9.81), suggested_time_step(6.0)
    curtain = Impact(15.0, 17.0, 5.0, 2e6, 2e6, 0.3, water)
    sea = synthesise(jonswap(2.0, 6.0, 3.3), water, duration=10800.0, seed=1, time_step=step)

    def flow(duration: float) -> SkirtFlow:
        return flow_over_skirt(
            sea,
            water,
            draught=5.0,
            normal_heading=0.0,
            current=0.3,
            duration=duration,
            time_step=step,
            velocity="skirt_mean",
        )

    snaps_in_sea(curtain, flow(60.0), drag_coefficient=1.2, slowest=0.2, transient=0.0)
    start = time.perf_counter()
    water_over_skirt = flow(10800.0)
    middle = time.perf_counter()
    found = snaps_in_sea(curtain, water_over_skirt, drag_coefficient=1.2, slowest=0.2, transient=60.0)
    end = time.perf_counter()
    return {
        "flow": middle - start,
        "seconds": end - middle,
        "samples": len(found.motion.time),
        "contacts": len(found.time),
    }


if __name__ == "__main__":
    for name, run in (
        ("model A sweep", sweep),
        ("flat plate, infinite frequency", plate),
        ("model A with memory", memory),
        ("three hours of snaps", snaps),
    ):
        print(json.dumps({"what": name, **run()}))
