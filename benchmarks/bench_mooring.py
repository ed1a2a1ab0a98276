"""Mooring lines against MoorPy in the same run: rate of single lines, 6-DOF equilibrium, table of line forces.

    python benchmarks/bench_mooring.py [--peer-python PATH] [--repeat 5]

MoorPy runs in the interpreter given (or the environment variable MOYAI_PEER_PYTHON, or this one when MoorPy is
installed here); without it only our side is timed. CPU seconds, one thread, warm, compilation excluded on our side.
Prints JSON lines and fails when the outputs differ or the promised ratios (500 grounded, 200 suspended) are missed.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from moyai.mooring import kernels, segments
from moyai.mooring.catenary import solve_catenary
from moyai.mooring.lines import Clump, Line, LineType, Segment
from moyai.mooring.space_kernel import space_line_force
from moyai.mooring.system import LineSystem
from moyai.mooring.table import CompiledLines, compile_lines

AXIAL, WEIGHT, MASS, VOLUME_DIAMETER = 2.135e8, (49.8 - 1025.0 * np.pi / 4.0 * 0.09**2) * 9.81, 49.8, 0.09
HYDROSTATIC_AREA, DISPLACEMENT, CENTRE, METACENTRE = 210.0, 630.0, (0.0, 0.0, -0.5), (0.0, 0.0, 1.5)


def peer_python(given: str | None) -> str | None:
    """Return an interpreter that has MoorPy."""
    for candidate in (given, os.environ.get("MOYAI_PEER_PYTHON")):
        if candidate and Path(candidate).exists():
            return candidate
    return sys.executable if importlib.util.find_spec("moorpy") else None


def ask_peer(python: str, case: dict) -> dict:
    """Run MoorPy on one case."""
    script = Path(__file__).with_name("peer_moorpy.py")
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    done = subprocess.run(
        [python, str(script)], input=json.dumps(case), capture_output=True, text=True, check=True, env=environment
    )
    return json.loads(done.stdout[done.stdout.index("{") :])


def cpu(function: Callable[[], object], repeat: int) -> float:
    """Return the median CPU time of one call after a warm one."""
    function()
    spent = []
    for _ in range(repeat):
        started = time.process_time()
        function()
        spent.append(time.process_time() - started)
    return float(np.median(spent))


def largest_difference(found: np.ndarray, peer: np.ndarray) -> dict[str, float]:
    """Return largest errors: forces over the tension, grounded length [m], stiffness over its largest term."""
    tension = np.hypot(peer[:, 0], peer[:, 1])[:, None]
    scale = np.abs(peer[:, 5:9]).max(axis=1)[:, None]
    return {
        "forces": float((np.abs(found[:, :4] - np.abs(peer[:, :4])) / tension).max()),
        "grounded_m": float(np.abs(found[:, 4] - peer[:, 4]).max()),
        "stiffness": float((np.abs(found[:, 5:9] - peer[:, 5:9]) / scale).max()),
    }


def bench_lines(name: str, length: float, clearance: float, python: str | None, repeat: int) -> dict:
    """Time one family of lines; ``clearance`` is the height of the anchor over the bed."""
    rng = np.random.default_rng(1)
    count = 200_000
    x = rng.uniform(96.5, 99.2, count)
    full = [np.full(count, value) for value in (8.0, length, AXIAL, WEIGHT, clearance, 0.0)]
    out, regime = np.empty((count, 10)), np.empty(count, dtype=np.int64)
    seconds = cpu(lambda: kernels.solve_batch(x, *full, out, regime), repeat) / count
    record = {"bench": name, "moyai_us": 1e6 * seconds, "moyai_residual": float(out[:, 9].max())}
    rate = cpu(lambda: solve_catenary(x, 8.0, length, AXIAL, WEIGHT, bed_clearance=clearance), repeat) / count
    record["moyai_public_function_us"] = 1e6 * rate
    if python:
        case = {"what": "solve", "lines": [[float(v), 8.0, length, AXIAL, WEIGHT, -clearance] for v in x[:2000]]}
        timed = [ask_peer(python, case) for _ in range(3)]
        peer = float(np.median([item["cpu_s"] for item in timed])) / 2000
        exact = ask_peer(python, {**case, "tolerance": 1e-12, "lines": case["lines"][:500]})
        given = np.array([row for row in exact["values"] if row is not None])
        ours = out[: len(given)].copy()
        ours[:, [2, 3]] = np.abs(ours[:, [2, 3]])
        record |= {"moorpy_us": 1e6 * peer, "ratio": peer / seconds, "difference": largest_difference(ours, given)}
        record["moorpy_version"] = timed[0]["version"]
    return record


def breakwater() -> LineSystem:
    """Four 100 m chains on a pontoon 10 m x 21 m in 10 m of water."""
    chain = LineType("chain", WEIGHT, AXIAL)
    lines = []
    for sx in (-1, 1):
        for sy in (-1, 1):
            fairlead = (sx * 5.0, sy * 9.0, -2.0)
            anchor = (sx * 103.0, sy * 9.0, -10.0)
            lines.append(Line(f"chain {sx} {sy}", anchor, fairlead, (Segment(chain, 100.0),)))
    return LineSystem(tuple(lines), 10.0)


def bench_system(python: str | None, repeat: int) -> dict:
    """Time the 6-DOF equilibrium under loads, the stiffness matrix and the forces at a position."""
    system = breakwater()
    rng = np.random.default_rng(2)
    loads = rng.uniform(-1, 1, (40, 6)) * [3e4, 1e4, 5e4, 1e4, 1e4, 1e4]
    lift = 1025.0 * 9.81
    # MoorPy's body: buoyancy and weight balance; waterplane and metacentre give the restoring
    righting = lift * DISPLACEMENT * (METACENTRE[2] - CENTRE[2])
    hydrostatic = np.diag([0.0, 0.0, lift * HYDROSTATIC_AREA, righting, righting, 0.0])
    found = [system.equilibrium(load, hydrostatic, tolerance=1e-6) for load in loads]
    record = {
        "bench": "four chains, 6 degrees of freedom",
        "equilibrium_ms": 1e3
        * cpu(lambda: [system.equilibrium(load, hydrostatic, tolerance=1e-6) for load in loads], repeat)
        / 40,
        "stiffness_ms": 1e3 * cpu(lambda: [system.stiffness(np.zeros(6)) for _ in range(50)], repeat) / 50,
        "forces_ms": 1e3 * cpu(lambda: [system.forces(np.zeros(6)) for _ in range(50)], repeat) / 50,
        "forces_batched_us": 1e6 * cpu(lambda: system.forces(rng.normal(size=(20_000, 6)) * 0.01), repeat) / 20_000,
    }
    if python:
        peer = ask_peer(
            python,
            {
                "what": "system",
                "depth": 10.0,
                "axial": AXIAL,
                "mass": MASS,
                "weight": WEIGHT,
                "volume_diameter": VOLUME_DIAMETER,
                "displacement": DISPLACEMENT,
                "centre": CENTRE,
                "metacentre": METACENTRE,
                "waterplane": HYDROSTATIC_AREA,
                "length": 100.0,
                "tolerance": 1e-3,
                "ends": [(line.anchor, line.fairlead) for line in system.lines],
                "loads": loads.tolist(),
            },
        )
        positions = np.array(peer["positions"])
        ours = np.array([item.position for item in found])
        record |= {
            "moorpy_equilibrium_ms": 1e3 * peer["equilibrium_s"],
            "moorpy_stiffness_ms": 1e3 * peer["stiffness_s"],
            "moorpy_forces_ms": 1e3 * peer["forces_s"],
            "equilibrium_ratio": 1e3 * peer["equilibrium_s"] / record["equilibrium_ms"],
            "surge_difference_m": float(np.abs(positions[:, 0] - ours[:, 0]).max()),
            "surge_range_m": float(np.abs(ours[:, 0]).max()),
        }
    return record


def bench_segments(repeat: int) -> dict:
    """Time a chain-rope-chain line with a clump, from no guess and from the last tension."""
    chain, rope = LineType("chain", WEIGHT, AXIAL), LineType("rope", 20.0, 4e6)
    line = Line(
        "l", (0, 0, -10), (0, 0, 0), (Segment(chain, 60.0), Segment(rope, 30.0), Segment(chain, 10.0)), (Clump(0, 3e3),)
    )
    x, z = np.sort(np.random.default_rng(1).uniform(96.5, 99.2, 20_000)), np.full(20_000, 8.0)
    out, regime = np.empty((x.size, 11)), np.empty(x.size, dtype=np.int64)
    none = np.zeros(x.size)
    cold = cpu(lambda: segments.solve_segments_batch(x, z, line.table, 0.0, 0.0, none, out, regime), repeat)
    last = np.roll(out[:, 0], 1)
    warm = cpu(lambda: segments.solve_segments_batch(x, z, line.table, 0.0, 0.0, last, out, regime), repeat)
    return {
        "bench": "three segments and a clump",
        "no_guess_us": 1e6 * cold / x.size,
        "last_tension_us": 1e6 * warm / x.size,
        "residual": float(out[:, 9].max()),
    }


def bench_time_domain(repeat: int) -> dict:
    """Cost of one line at one step: table and exact kernel inside compiled code."""
    system = breakwater()
    steps = np.arange(50_000) * 0.05
    positions = np.column_stack([0.6 * np.sin(steps), 0.5 * np.cos(1.1 * steps), 0.05 * np.sin(steps + 1)])
    record: dict = {"bench": "planar force in compiled code, per line"}
    exact = compile_lines(system)
    lines = len(system.lines)
    _, tensions = exact.forces(positions)
    record["exact_ns"] = 1e9 * cpu(lambda: exact.forces(positions), repeat) / len(positions) / lines
    for tolerance in (1e-3, 1e-4, 1e-5):
        started = time.process_time()
        table = compile_lines(system, ((-1.0, 1.0), (-0.8, 0.8), (-0.1, 0.1)), tolerance)
        built = time.process_time() - started
        _, found = table.forces(positions)
        record[f"table_{tolerance:g}"] = {
            "ns": 1e9 * cpu(lambda table=table: table.forces(positions), repeat) / len(positions) / lines,
            "nodes": next(t.shape for t in table.tables if t is not None),
            "built_s": built,
            "largest_error_of_tension": float(np.abs(found / tensions - 1.0).max()),
        }
    return record


def bench_lines_in_space(repeat: int) -> dict:
    """Cost of one line at one step of a row of units, exactly and from a table: their ratio in one run."""
    lines = tuple(breakwater().lines)
    system = LineSystem(lines, breakwater().water_depth)
    steps = np.arange(20_000) * 0.05
    positions = np.zeros((len(steps), 6))
    for column, (size, omega) in enumerate(((0.6, 1.0), (0.3, 0.7), (0.5, 1.1), (0.03, 0.9), (0.05, 1.0), (0.02, 0.8))):
        positions[:, column] = size * np.sin(omega * steps)
    apart = system.fairleads(positions) - np.array([line.anchor for line in lines])
    over = np.stack([np.hypot(apart[..., 0], apart[..., 1]), apart[..., 2]], axis=-1)
    reach = np.stack([over.min(axis=0), over.max(axis=0)], axis=-1)
    packed = {"exact": compile_lines(system), "table": compile_lines(system, tolerance=1e-4, reach=reach)}
    body, out, found = np.zeros(len(lines), dtype=np.int64), {}, {}
    for name, each in packed.items():
        tension = np.zeros((len(steps), len(lines)))

        def go(each: CompiledLines = each, tension: np.ndarray = tension) -> None:
            last, force = np.zeros(len(lines)), np.zeros(6)
            for position, row in zip(positions, tension, strict=True):
                space_line_force(position, body, *each.arguments, last, force, row)

        out[f"{name}_ns"] = 1e9 * cpu(go, repeat) / len(steps) / len(lines)
        found[name] = tension
    worst = float(np.abs(found["table"] / found["exact"] - 1.0).max())
    return {
        "bench": "lines in space, per line, a call from Python each step", **out,
        "ratio": out["exact_ns"] / out["table_ns"], "largest_error_of_tension": worst,
    }  # fmt: skip


def main() -> int:
    """Run all and judge the promised ratios."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer-python")
    parser.add_argument("--repeat", type=int, default=5)
    arguments = parser.parse_args()
    python = peer_python(arguments.peer_python)
    if python is None:
        print(json.dumps({"peer": "MoorPy absent: only our side is timed (pip install moorpy in any environment)"}))
    failed = 0
    for name, length, clearance, promised in (("grounded", 100.0, 0.0, 500.0), ("suspended", 100.6, 20.0, 200.0)):
        record = bench_lines(name, length, clearance, python, arguments.repeat)
        if "ratio" in record:
            equal = max(record["difference"][key] for key in ("forces", "stiffness")) < 1e-6
            record["promise"] = promised
            record["passed"] = bool(record["ratio"] >= promised and equal)
            failed += not record["passed"]
        print(json.dumps(record))
    print(json.dumps(bench_system(python, arguments.repeat)))
    print(json.dumps(bench_segments(arguments.repeat)))
    print(json.dumps(bench_lines_in_space(arguments.repeat)))
    print(json.dumps(bench_time_domain(arguments.repeat)))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
