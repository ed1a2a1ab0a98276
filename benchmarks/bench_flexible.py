"""Dynamic lines and nets: CPU time against MoorDyn on the same decks in the same run, cost per node and step, growth.

    OMP_NUM_THREADS=1 python benchmarks/bench_flexible.py --peer-python /path/to/python-with-moordyn

Timed from the built model to the returned arrays, warm, median of three; the static start stands apart. MoorDyn runs
its own
scheme RK2 at the largest Courant number whose peak stays within 1 %.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import flexible_decks as decks
import numpy as np

from moyai.flexible.flow import Flow
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium

HERE = Path(__file__).resolve().parent

#: Deck, size, simulated seconds, settle time, output step of ours, Courant numbers of the peer, watched bar,
#: reference [N].
CASES = (
    ("snap", 20, 20.0, 8.0, 0.02, (0.4, 0.5), lambda n: n.strand("rope").bars[-1], 102.36e3),
    ("snap", 100, 8.5, 4.0, 0.02, (0.4,), lambda n: n.strand("rope").bars[-1], None),
    ("snapmass", 20, 30.0, 12.0, 0.02, (0.4, 0.5), lambda n: n.strand("rope").bars[-1], 76.35e3),
    ("chain", 20, 30.0, 12.0, 0.05, (0.5,), lambda n: n.strand("chain").bars[-1], None),
    ("chain", 100, 18.0, 12.0, 0.05, (0.5,), lambda n: n.strand("chain").bars[-1], None),
    ("net", 10, 12.0, 6.0, 0.02, (1.0,), lambda n: n.strand("net column 0").bars[0], 71.73),
    ("net", 20, 12.0, 6.0, 0.02, (1.0,), lambda n: n.strand("net column 0").bars[0], 120.0),
)


def say(**record: object) -> None:
    """Print one JSON line."""
    print(json.dumps(record), flush=True)


def ours(name: str, size: int, duration: float, settle: float, output_step: float, watched: object) -> dict[str, float]:
    """Return the median CPU time of three runs, the peak, and the size of the step."""
    network, motion = getattr(decks, name)(size, duration + 1.0)
    bar = watched(network)  # type: ignore[operator]
    simulate(network, motion, duration=2.0 * output_step, output_step=output_step)
    times = []
    for _ in range(3):
        clock = time.process_time()
        history = simulate(network, motion, duration=duration, output_step=output_step)
        times.append(time.process_time() - clock)
    assert history.status == "converged", history.message
    peak = float(history.peak_at(bar)[history.time > settle].max())
    # the net at rest in the current that the deck makes by a tow
    flow = Flow((1.0, 0.0, 0.0)) if name == "net" else None
    solve_equilibrium(network, flow=flow)
    clock = time.process_time()
    solve_equilibrium(network, flow=flow)
    static = time.process_time() - clock
    used = float(np.median(times))
    return {
        "cpu_s": used,
        "peak_N": peak,
        "step_s": history.step,
        "steps": history.steps,
        "static_s": static,
        "ns_per_node_step": used / history.steps / len(network.nodes) * 1e9,
    }


def compare(python: str | None) -> None:
    """Run every deck on both sides, back to back."""
    for name, size, duration, settle, output_step, courants, watched, reference in CASES:
        mine = ours(name, size, duration, settle, output_step, watched)
        say(deck=name, size=size, program="moyai", simulated_s=duration, reference_N=reference, **mine)
        for courant in courants if python else ():
            # the peer drives its points at one speed between exchanges: 0.02 s would raise the chain's peak by 1.3 %
            exchange = {"net": 0.01}.get(name, 1e-3)
            command = [
                python,
                str(HERE / "peer_moordyn.py"),
                name,
                str(size),
                "--courant",
                str(courant),
                "--duration",
                str(duration),
                "--settle",
                str(settle),
                "--exchange",
                str(exchange),
            ]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            if done.returncode or not done.stdout:
                say(deck=name, size=size, program="MoorDyn", failed=done.stderr[-200:])
                continue
            peer = json.loads(done.stdout)
            say(deck=name, size=size, program="MoorDyn", courant=courant, ratio=peer["cpu_s"] / mine["cpu_s"], **peer)


def growth() -> None:
    """Show the cost per node and step from lines of ten bars and nets of a hundred knots to ten thousand nodes."""
    for size in (10, 20, 40, 100, 300, 1000, 3000, 10_000):
        network, motion = decks.snap(size, 100.0)
        interval = 400 * 46.0 / size / 3333.3 * 0.8
        simulate(network, motion, duration=interval, output_step=interval, keep_nodes=[0])
        clock = time.process_time()
        history = simulate(network, motion, duration=5 * interval, output_step=interval, keep_nodes=[0])
        used = time.process_time() - clock
        say(growth="line", nodes=len(network.nodes), ns_per_node_step=used / history.steps / len(network.nodes) * 1e9)
    for knots in (10, 20, 50, 100):
        network, motion = decks.net(knots, 10.0)
        simulate(network, motion, duration=0.1, output_step=0.1, keep_nodes=[0])
        clock = time.process_time()
        history = simulate(network, motion, duration=0.5, output_step=0.1, keep_nodes=[0])
        used = time.process_time() - clock
        say(growth="net", nodes=len(network.nodes), ns_per_node_step=used / history.steps / len(network.nodes) * 1e9)


def statics() -> None:
    """Show the cost of rest: lines and nets in a current from small to large."""
    for name, size, flow in (
        *(("snap", size, None) for size in (20, 100, 1000, 10_000)),
        *(("net", size, Flow((1.0, 0.0, 0.0))) for size in (10, 20, 40, 80)),
    ):
        network, _ = getattr(decks, name)(size, 1.0)
        solve_equilibrium(network, flow=flow)
        clock = time.process_time()
        rest = solve_equilibrium(network, flow=flow)
        used = time.process_time() - clock
        say(
            statics=name, nodes=len(network.nodes), cpu_s=used, solves=rest.steps, residual=rest.residual,
            ms_per_solve=used / rest.steps * 1e3,
        )  # fmt: skip


def implicit_growth() -> None:
    """Show the cost of one implicit step, which a fixed step and a smooth motion keep alike, as the network grows."""
    for name, sizes in (("snap", (20, 100, 1000, 10_000)), ("net", (10, 20, 40, 80))):
        for size in sizes:
            network, motion = getattr(decks, name)(size, 10.0)
            start = solve_equilibrium(network).state
            step = 1e-3 if name == "net" else 2e-4
            run = partial(
                simulate, network, motion, output_step=10 * step, method="tr_bdf2", step=step, start=start,
                keep_nodes=[0], keep_bars=[0],
            )  # fmt: skip
            run(duration=10 * step)
            clock = time.process_time()
            history = run(duration=30 * step)
            used = (time.process_time() - clock) / history.steps
            say(implicit=name, nodes=len(network.nodes), ms_per_step=used * 1e3, status=history.status)


def implicit() -> None:
    """Show what the implicit schemes cost on the snap deck at tolerances of one step."""
    for method in ("tr_bdf2", "esdirk4"):
        for tolerance in (1e-2, 1e-3):
            network, motion = decks.snap(20, 21.0)
            simulate(network, motion, duration=0.1, output_step=0.05, method=method)  # type: ignore[arg-type]
            clock = time.process_time()
            history = simulate(network, motion, duration=20.0, output_step=0.05, method=method, tolerance=tolerance)  # type: ignore[arg-type]
            used = time.process_time() - clock
            peak = float(history.tension_peak[history.time > 8.0, 19].max())
            say(method=method, tolerance=tolerance, cpu_s=used, steps=history.steps, peak_N=peak)


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--peer-python", default=None, help="interpreter that has the moordyn package")
    given = parser.parse_args()
    compare(given.peer_python)
    growth()
    statics()
    implicit()
    implicit_growth()
    sys.exit(0)
