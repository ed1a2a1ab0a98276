"""The sea around lines in motion for a minute of a three-hour storm: merged components against all of them.

    OMP_NUM_THREADS=1 python benchmarks/bench_sea_of_lines.py

Prints a JSON line: processor seconds of both in the same run, their ratio, and the largest difference over the largest
value. The cost of all components grows with their number and that of the nodes, that of merged ones too, without the
transforms.
"""

from __future__ import annotations

import json
import math
import time

import numpy as np
from scipy.fft import next_fast_len

from moyai.flexible import sea_table
from moyai.sea.components import WaveComponents
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water

NODES, DURATION, STEP, TURNS = 62, 62.0, 0.0408, 3


def seconds(share: float, sea: WaveComponents, nodes: np.ndarray) -> tuple[float, np.ndarray]:
    """Return the least processor time [s] of some turns, and the table, with components merged up to a share."""
    sea_table.LEAST_MERGED = share
    # a step that divides the period in which the sea repeats, for the transforms of the whole sum
    step = sea.repeat_period / next_fast_len(math.ceil(sea.repeat_period / STEP))
    spent = []
    for _ in range(TURNS):
        began = time.process_time()
        table = sea_table._table(sea, nodes, round(DURATION / step), step)
        spent.append(time.process_time() - began)
    return min(spent), table


def main() -> None:
    """Run the command."""
    water = Water(depth=12.0, density=1025.0, gravity=9.81)
    sea = synthesise(
        jonswap(significant_height=1.5, peak_period=5.0, peak_enhancement=3.3), water, duration=10800.0, seed=1
    )
    along = np.linspace(-97.8, 97.8, NODES)
    nodes = np.column_stack([along, 0.0 * along, -12.0 + 9.0 * (1.0 - np.abs(along) / 97.8) ** 2])
    merged, table = seconds(sea_table.LEAST_MERGED, sea, nodes)
    whole, exact = seconds(0.0, sea, nodes)
    shown = {
        "components": len(sea), "nodes": NODES, "merged": round(merged, 4), "whole": round(whole, 4),
        "ratio": round(whole / merged, 2), "difference": float(np.abs(table - exact).max() / np.abs(exact).max()),
    }  # fmt: skip
    print(json.dumps(shown))


if __name__ == "__main__":
    main()
