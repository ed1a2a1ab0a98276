"""Thin plates in waves: cost against accuracy, alone and on a hull, and the limits by the stream function.

    python benchmarks/bench_thin_plates.py [--peer-python PATH] [--repeat 7]

A barrier of 1 m draught in 3 m of water, 40 frequencies with K d from 0.05 to 10, sway, heave, roll and diffraction;
the same for a box with two keel plates. CPU seconds, one thread, warm, with assembly, limits and identity checks.
Errors are against matched eigenfunctions (barrier, 16000 modes) and against accuracy 1e-8 (hull). Capytaine cannot take
plates of no thickness: in an interpreter that has it (``--peer-python`` or MOYAI_PEER_PYTHON) a box of 0.1 m x 1 m and
40 m length is solved at four frequencies, for the cost of one. Prints JSON lines; fails when the promise (0.1 % in 5 ms
a frequency, at the default accuracy) is missed.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from moyai.potential.modes import rigid_modes
from moyai.potential.plates import PlateLine
from moyai.potential.sections import Section
from moyai.potential.shapes import rectangle
from moyai.potential.solution import RadiationDiffraction
from moyai.potential.solver import solve
from moyai.potential.thin_plate import Plate, solve_plate_limit
from moyai.potential.thin_plate_waves import plate_memory, plate_section
from moyai.potential.vertical_barrier import solve_vertical_barrier
from moyai.sea.water import Water

GRAVITY = 9.81
WATER = Water(3.0, 1000.0, GRAVITY)
OMEGA = np.sqrt(GRAVITY * np.linspace(0.05, 10.0, 40))
PROMISED_SECONDS, PROMISED_ERROR = 0.005, 1e-3
BARRIER = plate_section(Plate((0.0, 0.0), (0.0, -1.0)))
KEELS = (
    rectangle(2.0, 1.0)
    .with_plates(*(PlateLine(np.array([(side, 0.0), (side, -0.6)])) for side in (-1.0, 1.0)))
    .immersed(0.7)
)


def solved(section: Section, accuracy: float) -> RadiationDiffraction:
    """Solve one section at all frequencies."""
    return solve(section, WATER, OMEGA, modes=rigid_modes((0.0, 0.0)), accuracy=accuracy)


def cpu(work: Callable[[], object], repeat: int) -> float:
    """Return the median CPU time of warm runs."""
    work()
    spent = []
    for _ in range(repeat):
        started = time.process_time()
        work()
        spent.append(time.process_time() - started)
    return float(np.median(spent))


def peer(interpreter: str) -> dict[str, float] | None:
    """Return what Capytaine takes for a thin box, CPU seconds per frequency."""
    case = {
        "beam": 0.1,
        "draught": 1.0,
        "length": 40.0,
        "panels": 1000,
        "depth": 3.0,
        "density": 1000.0,
        "omega": list(OMEGA[[5, 15, 25, 35]]),
        "lid": False,
    }
    script = Path(__file__).with_name("peer_capytaine.py")
    ran = subprocess.run(
        [interpreter, str(script)], input=json.dumps(case), capture_output=True, text=True, check=False
    )
    if ran.returncode:
        return None
    return {"cpu_s": json.loads(ran.stdout)["cpu_s"] / 4.0}


def main() -> int:
    """Run all and print JSON lines."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--peer-python", default=os.environ.get("MOYAI_PEER_PYTHON"))
    parser.add_argument("--repeat", type=int, default=7)
    options = parser.parse_args()
    reference = solve_vertical_barrier(1.0, WATER, OMEGA, evanescent_modes=16000, polynomials=20)
    fine = solved(KEELS, 1e-8)
    promised = False
    own = 0.0
    for accuracy in (1e-3, 1e-4, 1e-6):
        found = solved(BARRIER, accuracy)
        mass = np.abs(found.added_mass[:, 0, 0] - reference.added_mass).max() / reference.added_mass.max()
        wave = np.abs(found.normal.reflection_coefficient - reference.reflection_coefficient).max()
        spent = cpu(lambda accuracy=accuracy: solved(BARRIER, accuracy), options.repeat) / len(OMEGA)
        own = own or spent
        print(
            json.dumps(
                {
                    "case": "barrier",
                    "accuracy": accuracy,
                    "unknowns": found.unknowns,
                    "ms_per_frequency": 1e3 * spent,
                    "error_added_mass": mass,
                    "error_reflection": wave,
                }
            )
        )
        keels = solved(KEELS, accuracy)
        error = np.abs(keels.added_mass - fine.added_mass).max() / np.abs(fine.added_mass).max()
        hull = cpu(lambda accuracy=accuracy: solved(KEELS, accuracy), options.repeat) / len(OMEGA)
        print(
            json.dumps(
                {
                    "case": "box with keel plates",
                    "accuracy": accuracy,
                    "unknowns": keels.unknowns,
                    "ms_per_frequency": 1e3 * hull,
                    "error_added_mass": error,
                }
            )
        )
        if accuracy == 1e-3:
            promised = max(spent, hull) < PROMISED_SECONDS and max(mass, wave, error) < PROMISED_ERROR
    galerkin = cpu(lambda: solve_vertical_barrier(1.0, WATER, OMEGA), 3) / len(OMEGA)
    print(json.dumps({"case": "matched eigenfunctions", "ms_per_frequency": 1e3 * galerkin, "ratio": galerkin / own}))
    plate = Plate((0.0, 0.0), (0.0, -1.0))
    print(
        json.dumps(
            {"case": "limit by the stream function", "ms": 1e3 * cpu(lambda: solve_plate_limit(plate, WATER), 7)}
        )
    )
    instants = np.linspace(0.0, 10.0, 401)
    print(json.dumps({"case": "memory of a plate", "ms": 1e3 * cpu(lambda: plate_memory(1.0, WATER, instants), 3)}))
    if options.peer_python:
        measured = peer(options.peer_python)
        if measured is not None:
            out = {"case": "capytaine, thin box", "ms_per_frequency": 1e3 * measured["cpu_s"]}
            print(json.dumps({**out, "ratio": measured["cpu_s"] / own}))
    return 0 if promised else 1


if __name__ == "__main__":
    sys.exit(main())
