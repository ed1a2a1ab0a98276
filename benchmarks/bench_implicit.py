"""Cost of the implicit schemes with sheets and rings: against the explicit one, as they grow, and at first use.

Run ``python benchmarks/bench_implicit.py``; prints one JSON line per figure. CPU seconds, one thread, warm unless said.
"""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import tempfile
import time

import numpy as np

from moyai.flexible.elements import Bars, BarType, Nodes
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.rings import Ring
from moyai.flexible.sheets import Sheets, sheet_grid
from moyai.flexible.simulation import Method, simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.regular import RegularWave
from moyai.sea.water import Water

WATER = Water(10.0, 1025.0, 9.81)
PERIOD = 4.0


def say(**values: object) -> None:
    """Print one line."""
    print(json.dumps(values), flush=True)


def curtain(across: int, down: int) -> Network:
    """A curtain 30 m wide and 4 m deep between two cables, held at its ends, with ballast below."""
    grid = np.arange((across + 1) * (down + 1)).reshape(across + 1, down + 1)
    along, height = np.linspace(0.0, 30.0, across + 1), np.linspace(0.0, 4.0, down + 1)
    triangles, rest = sheet_grid(grid, along, height)
    y, z = (values.ravel() for values in np.meshgrid(0.97 * along, -5.0 + height, indexing="ij"))
    kind = np.zeros(grid.shape, dtype=int)
    kind[[0, -1]] = 1
    mass = np.zeros(grid.shape)
    mass[1:-1, 0] = 20.0 * 30.0 / across
    sheets = Sheets(
        triangles, rest, 4e5, 4e5, 4e4, 0.1, mass_per_area=1.2, volume_per_area=1e-3, drag_normal=1.2,
        drag_tangential=0.02, damping_time=2e-3,
    )  # fmt: skip
    cable = BarType("cable", 3.0, 2e6, 0.03, viscosity=2e3, drag_normal=1.2, added_mass_normal=1.0)
    start, end = grid[:-1, [0, -1]].T.ravel(), grid[1:, [0, -1]].T.ravel()
    bars = Bars(start, end, np.full(start.size, 30.0 / across), np.zeros(start.size, dtype=int), (cable,))
    place = np.stack([np.zeros(y.size), y, z], axis=1)
    return Network(Nodes(place, kind.ravel(), mass=mass.ravel()), bars, WATER, sheets=sheets)


def one_period() -> None:
    """Show a curtain sheet of 48 x 16 cells through one wave period after a ramp of one, by each scheme."""
    network = curtain(48, 16)
    flow = Flow(waves=RegularWave(0.8, PERIOD, 0.0, WATER).components(), wave_ramp=PERIOD)
    clock = time.process_time()
    start = solve_equilibrium(network).state
    say(statics="curtain 48 x 16", nodes=len(network.nodes), cpu_s=time.process_time() - clock)
    runs: tuple[tuple[Method, float], ...] = (
        ("explicit", 0.0), ("tr_bdf2", 1e-2), ("tr_bdf2", 1e-3), ("esdirk4", 1e-2), ("esdirk4", 1e-3)
    )  # fmt: skip
    for method, tolerance in runs:
        more = {"tolerance": tolerance} if tolerance else {}
        simulate(network, duration=0.1, output_step=0.1, flow=flow, start=start, method=method)
        clock = time.process_time()
        run = simulate(network, duration=2.0 * PERIOD, output_step=0.05, flow=flow, start=start, method=method, **more)
        used = time.process_time() - clock
        say(
            curtain=method, tolerance=tolerance, status=run.status, cpu_s_per_period=0.5 * used, steps=run.steps,
            peak_N=float(run.tension_peak[1:].max()), energy=run.checks[0].value,
        )  # fmt: skip


def growth() -> None:
    """Show the cost of one step of a sheet and of a ring as they grow, at a fixed step of smooth motion."""
    for cells in (8, 16, 32, 64):
        network = curtain(cells, cells)
        _growth("sheet", network, solve_equilibrium(network).state)
    for count in (16, 32, 64, 128):
        angle = 2.0 * math.pi * np.arange(count) / count
        shape = 10.0 * np.stack([np.cos(angle), np.sin(angle), 0.0 * angle], axis=1)
        size = np.full(count, float(np.linalg.norm(shape[1] - shape[0])))
        pipe = BarType("pipe", 60.0, 2e7, 0.3, viscosity=1e5, drag_normal=1.0, tension_only=False)
        ends = np.arange(count)
        bars = Bars(ends, np.roll(ends, -1), size, np.zeros(count, dtype=int), (pipe,))
        network = Network(Nodes(shape - [0.0, 0.0, 5.0], np.where(ends == 0, 1, 0)), bars, WATER,
                          rings=(Ring("pipe", ends, shape, 5e5, 4e5),))  # fmt: skip
        _growth("ring", network, State.at_rest(network))


def _growth(name: str, network: Network, start: State) -> None:
    flow = Flow(velocity=(0.05, 0.0, 0.0))
    used, steps = [], 20
    for _ in range(3):
        clock = time.process_time()
        run = simulate(
            network, duration=1e-3 * steps, output_step=1e-3 * steps, flow=flow, start=start, method="tr_bdf2",
            step=1e-3, keep_nodes=[0], keep_bars=[0],
        )  # fmt: skip
        used.append(time.process_time() - clock)
    say(implicit=name, nodes=len(network.nodes), ms_per_step=min(used) / steps * 1e3, status=run.status)


_FIRST = """
import time
import numpy as np
from moyai.flexible.elements import Bars, BarType, Nodes
from moyai.flexible.network import Network
from moyai.flexible.sheets import Sheets
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water
place = np.array([[0.0, 0.0, -5.0], [1.0, 0.0, -5.0], [0.0, 1.0, -5.0]])
rope = BarType("rope", 1.0, 1e4, 0.01, viscosity=10.0)
sheets = Sheets([[0, 1, 2]], place[None, :, :2], 1e4, 1e4) if PARTS else None
network = Network(Nodes(place, [1, 0, 0]), Bars([0, 1], [1, 2], [1.0, 1.4], [0, 0], (rope,)), Water(9.0, 1e3, 9.81),
                  sheets=sheets)
clock = time.process_time()
simulate(network, duration=0.1, output_step=0.1, method=METHOD)
print(time.process_time() - clock)
"""


def first_use() -> None:
    """Show what the kernels cost the first time, with an empty cache."""
    for method in ("explicit", "tr_bdf2"):
        with tempfile.TemporaryDirectory() as folder:
            environment = {**os.environ, "NUMBA_CACHE_DIR": folder}
            for parts in (False, True):
                text = _FIRST.replace("PARTS", str(parts)).replace("METHOD", repr(method))
                for use in ("first", "cached"):
                    found = subprocess.run(
                        [sys.executable, "-c", text], env=environment, capture_output=True, text=True, check=True
                    )
                    say(method=method, sheets=parts, use=use, cpu_s=float(found.stdout))


if __name__ == "__main__":
    one_period()
    growth()
    first_use()
