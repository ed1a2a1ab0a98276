"""Curtain impact and thin plates: sweep of ten thousand parameter sets, one thin plate, the whole comparison.

    python benchmarks/bench_curtain.py

One thread, warm; prints JSON lines.
"""

from __future__ import annotations

import json
import math
import time

import numpy as np

from moyai.curtain.impact import sweep_peaks
from moyai.potential.thin_plate import Plate, solve_plate_limit
from moyai.sea.water import Water

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


if __name__ == "__main__":
    for name, run in (("model A sweep", sweep), ("flat plate, infinite frequency", plate)):
        print(json.dumps({"what": name, **run()}))
