"""Cost of curtain statics: closed forms against scipy's root finder, a section, a whole curtain, a limit table.

Prints one JSON line a measurement; the root finder of scipy on the same equation runs in the same process.

    OMP_NUM_THREADS=1 python benchmarks/bench_curtain_statics.py
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Callable

import numpy as np
from scipy.optimize import brentq

from moyai.sea.current import power_law
from moyai.sea.water import Water
from moyai.structures.curtain.limits.utilisation import CurtainSite, Requirements, Strength, WaveLoad, operating_limits
from moyai.structures.curtain.seas.anchor_energy import EnergyModel
from moyai.structures.curtain.statics.closed_forms import cable_shape_number
from moyai.structures.curtain.statics.drag import constant_drag, gap_speed_drag
from moyai.structures.curtain.statics.hanging import FloatLine, HangingCurtain
from moyai.structures.curtain.statics.section import Skirt, solve_section

WATER = Water(12.0, 1025.0, 9.81)
SKIRT = Skirt(6.0, 5.0, 200.0, 1e6)


def seconds(call: Callable[[], object], repeats: int) -> float:
    """Return the least time of one call, after a warm one."""
    call()
    times = []
    for _ in range(repeats):
        start = time.perf_counter()
        call()
        times.append(time.perf_counter() - start)
    return min(times)


def cable() -> None:
    """Shape numbers of 10^5 random cables against brentq on a thousand of them."""
    rng = np.random.default_rng(1)
    ratio, stiffness = rng.uniform(0.3, 1.1, 100_000), 10.0 ** rng.uniform(0, 5, 100_000)
    ours = seconds(lambda: cable_shape_number(ratio, stiffness), 5) / ratio.size
    few = list(zip(ratio[:1000], stiffness[:1000]))

    def peer() -> np.ndarray:
        return np.array([
            brentq(lambda b, r=r, e=e: math.sinh(b) - b / r - 0.5 / e, 1e-9 + _taut(r), 30.0, xtol=1e-14, rtol=1e-14)
            for r, e in few
        ])  # fmt: skip

    theirs = seconds(peer, 2) / len(few)
    error = float(np.max(np.abs(peer() / cable_shape_number(ratio[:1000], stiffness[:1000]) - 1.0)))
    print(json.dumps({"what": "cable with stretch", "microseconds": 1e6 * ours, "scipy_microseconds": 1e6 * theirs,
                      "ratio": theirs / ours, "difference": error}))  # fmt: skip


def _taut(ratio: float) -> float:
    return float(cable_shape_number(ratio)) if ratio < 1.0 else 0.0


def sections() -> None:
    """One section, free and held, with and without blockage."""
    current = power_law(0.3, 1 / 7, 0.0, WATER)
    constant, gap = constant_drag(1.4, (1, 1), "benchmark"), gap_speed_drag(1.4, (1, 1), "benchmark")
    for toe in ("free", "held"):
        for law in (constant, gap):
            cost = seconds(lambda: solve_section(SKIRT, current, 0.0, WATER, law, toe=toe), 5)  # noqa: B023
            print(json.dumps({"what": "section", "toe": toe, "drag": law.name, "milliseconds": 1e3 * cost}))


def whole() -> None:
    """A whole curtain, and a table of operating limits at ten currents."""
    strength = Strength(60e3, 3.0)
    for toe in ("free", "held"):
        curtain = HangingCurtain(
            20.0, 23.0, SKIRT, FloatLine(980.0, 100.0, 100.0), 3e6, 2e6, toe, 0.35,
            constant_drag(1.4, (0.8, 1.3), "benchmark"), "normal_velocity",
        )  # fmt: skip
        site = CurtainSite(WATER, lambda speed: power_law(speed, 1 / 7, 0.2, WATER), 0.2, 0.0, 1.0)
        required = Requirements(strength, strength, strength, strength, Strength(15e3, 1.5), 0.2, 3.0)
        waves = WaveLoad(EnergyModel(0.2, 300.0, 2e5, 2.0, 1.0, 1.0), lambda h: 3.86 * math.sqrt(h), 0.3, "normal", 1.8)
        one = seconds(lambda: site.statics(curtain, 0.3), 5)  # noqa: B023
        table = seconds(
            lambda: operating_limits(curtain, site, required, waves, speeds=np.linspace(0.02, 0.5, 10), highest=3.0),  # noqa: B023
            2,
        )
        print(json.dumps({"what": "curtain", "toe": toe, "milliseconds": 1e3 * one, "limit_table_seconds": table}))


if __name__ == "__main__":
    cable()
    sections()
    whole()
