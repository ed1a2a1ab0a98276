"""Radiation and diffraction of a pontoon: cost against accuracy and panels, Capytaine on a long box in the same run.

    python benchmarks/bench_potential.py [--peer-python PATH] [--length 105] [--panels 504] [--repeat 9]

The pontoon is 10 m wide with 3 m draught in 10 m of water, 40 frequencies from 0.5 to 2.5 rad/s, sway, heave, roll and
diffraction. Ours is two-dimensional, per metre; Capytaine is three-dimensional and solves a box of finite length: the
ratio is the price of the third dimension as much as that of the method. CPU seconds, one thread, warm, with assembly,
limits and identity checks, without compilation. Errors are against our own solution converged to 1e-9.
Prints JSON lines; fails when the promise (0.1 % of each coefficient's band maximum, 1 % pointwise, 30 ms) is missed.
"""

from __future__ import annotations

import argparse
import importlib.util
import json
import os
import subprocess
import sys
import time
import tracemalloc
from pathlib import Path

import numpy as np

from moyai.potential import shapes
from moyai.potential.mesh import Resolution
from moyai.potential.modes import rigid_modes
from moyai.potential.solution import RadiationDiffraction
from moyai.potential.solver import solve
from moyai.sea.water import Water

BEAM, HEIGHT, DRAUGHT, DEPTH = 10.0, 4.5, 3.0, 10.0
OMEGA = np.linspace(0.5, 2.5, 40)
WATER = Water(DEPTH, 1000.0, 9.81)
PROMISED_SECONDS = 0.030


def pontoon(accuracy: float) -> RadiationDiffraction:
    """Solve the pontoon."""
    section = shapes.rectangle(BEAM, HEIGHT).immersed(DRAUGHT)
    return solve(section, WATER, OMEGA, modes=rigid_modes((0.0, 0.0)), accuracy=accuracy)


def cpu(accuracy: float, repeat: int) -> float:
    """Return the median CPU time of a warm solve."""
    spent = []
    for _ in range(repeat):
        started = time.process_time()
        pontoon(accuracy)
        spent.append(time.process_time() - started)
    return float(np.median(spent))


def errors(found: RadiationDiffraction, reference: RadiationDiffraction) -> tuple[float, float]:
    """Return the largest error over a coefficient's band maximum and the largest pointwise one.

    Pointwise only where a coefficient is above a thousandth of its own maximum; coefficients that vanish are left out.
    """
    band, pointwise = [], []
    for name in (
        "added_mass",
        "radiation_damping",
        "excitation_force",
        "reflection_coefficient",
        "transmission_coefficient",
    ):
        a, b = getattr(found, name), getattr(reference, name)
        a, b = a.reshape(len(OMEGA), -1), b.reshape(len(OMEGA), -1)
        largest = np.abs(b).max(axis=0)
        there = largest > 1e-9 * largest.max()
        difference = np.abs(a - b)[:, there]
        band.append((difference.max(axis=0) / largest[there]).max())
        size = np.abs(b[:, there])
        pointwise.append((difference / size)[size > 1e-3 * largest[there]].max())
    return float(max(band)), float(max(pointwise))


def peer_python(given: str | None) -> str | None:
    """Return an interpreter that has Capytaine."""
    for candidate in (given, os.environ.get("MOYAI_PEER_PYTHON")):
        if candidate and Path(candidate).exists():
            probe = subprocess.run([candidate, "-c", "import capytaine"], capture_output=True, check=False)
            if probe.returncode == 0:
                return candidate
    return sys.executable if importlib.util.find_spec("capytaine") else None


def compare_with_capytaine(
    python: str, length: float, panels: int, ours: float, reference: RadiationDiffraction
) -> None:
    """Run Capytaine on the same frequencies and print both sides."""
    case = {
        "beam": BEAM,
        "draught": DRAUGHT,
        "length": length,
        "depth": DEPTH,
        "panels": panels,
        "lid": True,
        "density": WATER.density,
        "omega": OMEGA.tolist(),
    }
    script = Path(__file__).with_name("peer_capytaine.py")
    done = subprocess.run([python, str(script)], input=json.dumps(case), capture_output=True, text=True, check=True)
    peer = json.loads(done.stdout[done.stdout.index("{") :])
    middle = slice(10, 30)
    away = {}
    for index, name in enumerate(("sway", "heave")):
        for ours_name, key in (("added_mass", "A"), ("radiation_damping", "B")):
            exact = getattr(reference, ours_name)[middle, index, index]
            other = np.array(peer[ours_name][name])[middle]
            away[f"{key}_{name}"] = round(float(np.abs(other - exact).max() / np.abs(exact).max()), 4)
    print(
        json.dumps(
            {
                "case": "capytaine, three-dimensional box, lid, two planes of symmetry",
                "version": peer["version"],
                "length_m": length,
                "panels": peer["panels"],
                "cpu_s": round(peer["cpu_s"], 3),
                "peak_rss_mb": round(peer["peak_rss_mb"], 1),
                "ours_cpu_s": round(ours, 5),
                "ratio_3d_over_2d": round(peer["cpu_s"] / ours, 1),
                "its_distance_from_2d_in_mid_band": away,
            }
        ),
        flush=True,
    )


def one_thread() -> int | None:
    """Run again in a process whose linear algebra has one thread, unless this is one; return its exit code."""
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    if os.environ.get(names[0]) == "1":
        return None
    environment = {**os.environ, **dict.fromkeys(names, "1")}
    return subprocess.run([sys.executable, *sys.argv], env=environment, check=False).returncode


def main() -> int:
    """Run the benchmark."""
    again = one_thread()
    if again is not None:
        return again
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--peer-python", default=None, help="interpreter that has Capytaine")
    parser.add_argument("--length", type=float, default=105.0, help="length of Capytaine's box [m]")
    parser.add_argument("--panels", type=int, default=504, help="panels of Capytaine's box")
    parser.add_argument("--repeat", type=int, default=9)
    parser.add_argument("--no-peer", action="store_true")
    arguments = parser.parse_args()

    reference = pontoon(1e-9)
    pontoon(1e-3)
    kept = True
    ours = cpu(1e-3, arguments.repeat)
    for accuracy in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        found = pontoon(accuracy)
        spent = ours if accuracy == 1e-3 else cpu(accuracy, arguments.repeat)
        tracemalloc.start()
        pontoon(accuracy)
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        band, pointwise = errors(found, reference)
        line = {
            "case": "pontoon 10 m x 3 m, depth 10 m, 40 frequencies, 3 modes + diffraction (two-dimensional)",
            "accuracy_asked": accuracy,
            "unknowns": found.unknowns,
            "order": Resolution.for_accuracy(accuracy).order,
            "status": found.status,
            "cpu_s": round(spent, 5),
            "ms_per_frequency": round(1e3 * spent / len(OMEGA), 4),
            "peak_memory_mb": round(peak / 2**20, 2),
            "error_of_band_maximum": float(f"{band:.2g}"),
            "error_pointwise": float(f"{pointwise:.2g}"),
            "largest_identity": float(f"{max(check.value for check in found.checks[:4]):.2g}"),
        }
        print(json.dumps(line), flush=True)
        if accuracy == 1e-3:
            kept = band < 1e-3 and pointwise < 1e-2 and spent < PROMISED_SECONDS
    for name, section, heading in (
        ("heeled 0.1 rad (no symmetry)", shapes.rectangle(BEAM, HEIGHT).immersed(DRAUGHT, heel=0.1), 0.0),
        ("pi type with 2 m plates", shapes.pi_type(BEAM, 3.0, 2.0, 0.5).immersed(4.0), 0.0),
        ("twin pontoon, gap 2 m", shapes.twin_pontoon(4.0, 3.0, 2.0, deck_thickness=0.5).immersed(2.0), 0.0),
        ("pontoon, oblique 30 degrees", shapes.rectangle(BEAM, HEIGHT).immersed(DRAUGHT), np.radians(30.0)),
    ):

        def run(section=section, heading=heading) -> RadiationDiffraction:
            return solve(section, WATER, OMEGA, modes=rigid_modes((0.0, 0.0)), heading=heading)

        found = run()
        started = time.process_time()
        run()
        spent = time.process_time() - started
        print(
            json.dumps(
                {
                    "case": name,
                    "unknowns": found.unknowns,
                    "status": found.status,
                    "cpu_s": round(spent, 4),
                    "largest_identity": float(f"{max(check.value for check in found.checks[:4]):.2g}"),
                }
            ),
            flush=True,
        )
    python = None if arguments.no_peer else peer_python(arguments.peer_python)
    if python is None:
        print(json.dumps({"case": "capytaine", "skipped": "no interpreter with Capytaine; give --peer-python"}))
    else:
        compare_with_capytaine(python, arguments.length, arguments.panels, ours, reference)
    if not kept:
        print(json.dumps({"failed": f"0.1 % of band maximum, 1 % pointwise, {PROMISED_SECONDS} s"}))
    return 0 if kept else 1


if __name__ == "__main__":
    sys.exit(main())
