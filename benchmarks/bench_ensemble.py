"""Runs of a network side by side: processor time a member over that of a run by itself, in the same run.

    OMP_NUM_THREADS=1 python benchmarks/bench_ensemble.py

The rope of ``flexible_decks.snap`` that goes slack and snaps, each member with a surge of its own, and one line of a
thousand bars next to it: what the vector code takes for a bar and a step when its loops are long.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable

import flexible_decks as decks
import numpy as np

from moyai.flexible import Member, Motion, simulate, simulate_together

DURATION, OUTPUT_STEP, MEMBERS = 20.0, 0.02, (1, 8, 64, 100)


def best(work: Callable[[], object], times: int = 3) -> float:
    """Return the shortest processor time of some runs [s]."""
    found = []
    for _ in range(times):
        clock = time.process_time()
        work()
        found.append(time.process_time() - clock)
    return min(found)


def main() -> None:
    """Print one line of JSON for each number of bars."""
    long, motion = decks.snap(1000, 1.0)
    simulate(long, motion, duration=0.01, output_step=0.005)
    steps = simulate(long, motion, duration=0.05, output_step=0.01).steps
    floor = best(lambda: simulate(long, motion, duration=0.05, output_step=0.01)) / steps / 1000.0
    for bars in (5, 20, 100):
        network, motions = decks.snap(bars, DURATION + 1.0)
        given = {"duration": DURATION, "output_step": OUTPUT_STEP, "keep_bars": np.array([bars - 1]), "keep_nodes": [0]}
        steps = simulate(network, motions, **given).steps
        alone = best(lambda: simulate(network, motions, **given))  # noqa: B023
        surges = [1.0 + 0.002 * number for number in range(max(MEMBERS))]
        members = [
            Member({"fairlead": Motion.harmonic((surge, 0.0, 0.0), 4.0, duration=DURATION + 1.0, ramp=4.0)})
            for surge in surges
        ]
        gains = {}
        for count in MEMBERS:
            chosen = members[:count]
            taken = best(lambda: simulate_together(network, chosen, **given)) / count  # noqa: B023
            gains[count] = {"seconds_a_member": taken, "times_as_fast": alone / taken,
                            "ns_a_bar_and_step": 1e9 * taken / steps / bars}  # fmt: skip
        print(json.dumps({
            "bars": bars, "steps": steps, "seconds_alone": alone, "ns_alone": 1e9 * alone / steps / bars,
            "ns_of_a_thousand_bars": 1e9 * floor, "together": gains,
        }), flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
