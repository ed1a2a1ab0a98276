"""MoorDyn's side of ``bench_flexible.py``: the same four decks, run by the interpreter that has the ``moordyn``
package.

    python benchmarks/peer_moordyn.py snap 20 --courant 0.4 --duration 20 --repeat 3

Prints one JSON line: CPU seconds of MoorDyn's steps, highest tension. Initial conditions, the tables of the motions and
Python's driving loop (``driving_loop_s``: 6 to 20 % of the whole) are not counted. MoorDyn writes to the standard
streams, which are silenced here.
"""

from __future__ import annotations

import argparse
import itertools
import json
import math
import os
import resource
import sys
import tempfile
import time

import moordyn
import numpy as np

RHO = 1025.0
ROPE = "rope 0.040 9.0 1e8 1e4 0 1.2 1.0 0.02 0.0"
CHAIN = f"chain 0.09 49.8 2.135e8 -1 0 2.4 1.0 {1.15 / math.pi} 0.5"
SPRING = "soft 1e-3 1e-3 4e5 2e3 0 0 0 0 0"
TWINE = "twine 0.02 0.36 2e5 100.0 0 1.2 1.0 0.01 0.0"


def deck(types, points, lines, options):
    """Return the text of an input file."""
    rows = [
        "MoorDyn v2 input",
        "benchmark",
        "--- LINE TYPES ---",
        "TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx",
    ]
    rows += ["(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)", *types, "--- POINTS ---"]
    rows += ["ID Attachment X Y Z Mass Volume CdA Ca", "(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)"]
    rows += [f"{i + 1} {p[0]} " + " ".join(f"{v:.12g}" for v in p[1:]) for i, p in enumerate(points)]
    rows += [
        "--- LINES ---",
        "ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs",
        "(#) (name) (ID) (ID) (m) (-) (-)",
    ]
    rows += [f"{i + 1} {line[0]} {line[1]} {line[2]} {line[3]:.12g} {line[4]} -" for i, line in enumerate(lines)]
    rows += ["--- OPTIONS ---", "0 writeLog", "1 disableOutput", "1 disableOutTime"]
    rows += [f"{value} {key}" for key, value in options.items()]
    return "\n".join([*rows, "--- OUTPUTS ---", "FairTen1", "--- need this line ---", ""])


def problem(name, size, step):
    """Return the deck, the motion of its driven points, the watched line and node, and the settle time."""
    options = {
        "WtrDpth": 60.0,
        "rho": RHO,
        "tScheme": "rk2",
        "TmaxIC": 60,
        "dtIC": 0.5,
        "threshIC": 1e-4,
        "dtM": step,
        "CFL": 1e6,
    }
    off = (0.0, 0.0, 0.0, 0.0)
    period = {"snap": 4.0}.get(name, 6.0)
    amplitude = 3.0 if name == "snapmass" else 1.0

    def surge(start):
        def place(t):
            grown = 1.0 if t >= period else 0.5 * (1.0 - math.cos(math.pi * t / period))
            return [start[0] + amplitude * grown * math.sin(2.0 * math.pi / period * t), start[1], start[2]]

        return place

    if name == "snap":
        points = [("Fixed", 0, 0, -12.0, *off), ("Coupled", 43.9425, 0, -2.0, *off)]
        return deck([ROPE], points, [("rope", 1, 2, 46.0, size)], options), surge((43.9425, 0.0, -2.0)), (1, size), 8.0
    if name == "snapmass":
        options["TmaxIC"] = 0
        points = [
            ("Fixed", 0, 0, -12.0, *off),
            ("Free", 45.9, 0, -12.0, 5000.0, 5000.0 / RHO, 5.0, 0.0),
            ("Coupled", 66.5, 0, -12.0, *off),
        ]
        lines = [("rope", 1, 2, 46.0, size), ("soft", 2, 3, 20.0, 1)]
        return deck([ROPE, SPRING], points, lines, options), surge((66.5, 0.0, -12.0)), (1, size), 12.0
    if name == "chain":
        options.update(WtrDpth=10.0, kBot=3e5, cBot=3e4)
        points = [("Fixed", 0, 0, -10.0, *off), ("Coupled", 97.5, 0, 0.0, *off)]
        return deck([CHAIN], points, [("chain", 1, 2, 100.0, size)], options), surge((97.5, 0.0, 0.0)), (1, size), 12.0
    options["TmaxIC"] = 0
    points = [("Coupled" if j == 0 else "Free", 0.0, i, -1.0 - j, *off) for j in range(size) for i in range(size)]
    lines = []
    for j in range(size):
        for i in range(size):
            if i < size - 1:
                lines.append(("twine", j * size + i + 1, j * size + i + 2, 1.0, 1))
            if j < size - 1:
                lines.append(("twine", j * size + i + 1, (j + 1) * size + i + 1, 1.0, 1))

    def tow(t):
        grown = min(1.0, t / 3.0)
        away = -(t * t / 6.0 if t < 3.0 else t - 1.5)
        heave = 0.5 * grown * math.sin(2.0 * math.pi / 6.0 * t)
        return [value for i in range(size) for value in (away, float(i), -1.0 + heave)]

    return deck([TWINE], points, lines, options), tow, (2, 1), 6.0


class _Idle:
    """Stands for MoorDyn where the driving loop alone is timed."""

    def step(self, system, place, speed, now, interval):
        """Do nothing."""


def run(name, size, courant, duration, exchange, settle):
    """Run once; return CPU seconds of MoorDyn alone, highest tension after the start, step, seconds of the loop."""
    stiffness, mass, length = {"chain": (2.135e8, 49.8, 100.0), "net": (2e5, 0.36, size)}.get(name, (1e8, 9.0, 46.0))
    step = courant * length / size / math.sqrt(stiffness / mass)
    text, place, watched, usual = problem(name, size, step)
    settle = usual if settle is None else settle
    path = os.path.join(tempfile.mkdtemp(prefix="peer"), "lines.txt")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    system = moordyn.Create(path)
    exchange = max(exchange, step)
    steps, most = round(duration / exchange), 0.0
    places = [place(k * exchange) for k in range(steps + 1)]
    speeds = [[(b - a) / exchange for a, b in zip(*pair, strict=True)] for pair in itertools.pairwise(places)]
    moordyn.Init(system, places[0], [0.0] * len(places[0]))
    line = moordyn.GetLine(system, watched[0])
    clock = time.process_time()
    for k in range(steps):
        moordyn.Step(system, places[k], speeds[k], k * exchange, exchange)
        pull = moordyn.GetLineNodeTen(line, watched[1])
        if (k + 1) * exchange > settle:
            most = max(most, math.sqrt(pull[0] ** 2 + pull[1] ** 2 + pull[2] ** 2))
    whole = time.process_time() - clock
    # what is Python's: the same loop with a call in place of Step that takes the same arguments and does nothing
    nothing = _Idle().step
    clock, unused = time.process_time(), 0.0
    for k in range(steps):
        nothing(system, places[k], speeds[k], k * exchange, exchange)
        pull = moordyn.GetLineNodeTen(line, watched[1])
        if (k + 1) * exchange > settle:
            unused = max(unused, math.sqrt(pull[0] ** 2 + pull[1] ** 2 + pull[2] ** 2))
    idle = time.process_time() - clock
    moordyn.Close(system)
    return whole - idle, most, step, idle


def main():
    """Read the command line and print one JSON line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("problem", choices=["snap", "snapmass", "chain", "net"])
    parser.add_argument("size", type=int)
    parser.add_argument("--courant", type=float, default=0.4)
    parser.add_argument("--duration", type=float, default=20.0)
    parser.add_argument("--exchange", type=float, default=1e-3)
    parser.add_argument("--settle", type=float, default=None)
    parser.add_argument("--repeat", type=int, default=3)
    given = parser.parse_args()
    voice = os.fdopen(os.dup(1), "w")
    silence = os.open(os.devnull, os.O_WRONLY)
    os.dup2(silence, 1)
    os.dup2(silence, 2)
    runs = [
        run(given.problem, given.size, given.courant, given.duration, given.exchange, given.settle)
        for _ in range(given.repeat)
    ]
    record = {
        "cpu_s": float(np.median([entry[0] for entry in runs])),
        "peak_N": runs[0][1],
        "step_s": runs[0][2],
        "driving_loop_s": float(np.median([entry[3] for entry in runs])),
        "version": getattr(moordyn, "__version__", "2"),
        "peak_memory_kb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss,
    }
    voice.write(json.dumps(record) + "\n")
    voice.flush()


if __name__ == "__main__":
    sys.exit(main())
