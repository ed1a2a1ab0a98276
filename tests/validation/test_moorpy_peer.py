"""MoorPy (BSD-3-Clause) solves the same random lines: forces at both ends, grounded length, stiffness.

Needs MoorPy in this environment or in the interpreter named by MOYAI_PEER_PYTHON.
"""

from __future__ import annotations

import importlib.util
import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from moyai.mooring.catenary import CatenarySolution, solve_catenary

SCRIPT = Path(__file__).resolve().parents[2] / "benchmarks" / "peer_moorpy.py"

pytestmark = pytest.mark.peer


def moorpy(lines: np.ndarray) -> np.ndarray:
    """Return H, V at fairlead and anchor, grounded length and stiffness of MoorPy; NaN rows where it gives up."""
    python = os.environ.get("MOYAI_PEER_PYTHON") or (sys.executable if importlib.util.find_spec("moorpy") else "")
    if not python:
        pytest.skip("MoorPy is not installed here and MOYAI_PEER_PYTHON names no interpreter that has it")
    case = {"what": "solve", "lines": lines.tolist(), "tolerance": 1e-12}
    done = subprocess.run([python, str(SCRIPT)], input=json.dumps(case), capture_output=True, text=True, check=True)
    values = json.loads(done.stdout[done.stdout.index("{") :])["values"]
    return np.array([[np.nan] * 9 if row is None else row for row in values], dtype=float)


def compare(solution: CatenarySolution, peer: np.ndarray, length: np.ndarray) -> tuple[float, np.ndarray]:
    """Return the share of lines that the peer solved and the errors there (forces over tension, length, stiffness)."""
    tension = solution.tension_fairlead
    errors = np.max(
        [
            np.abs(peer[:, 0] - solution.horizontal_tension) / tension,
            np.abs(np.abs(peer[:, 1]) - np.abs(solution.vertical_tension_fairlead)) / tension,
            np.abs(peer[:, 2] - solution.horizontal_tension_anchor) / tension,
            np.abs(np.abs(peer[:, 3]) - np.abs(solution.vertical_tension_anchor)) / tension,
            np.abs(peer[:, 4] - solution.grounded_length) / length,
        ],
        axis=0,
    )
    solved = np.isfinite(peer[:, :5]).all(axis=1)
    return float(solved.mean()), errors[solved]


def family(seed: int, count: int = 400) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(seed)
    height = rng.uniform(5.0, 50.0, count)
    length = height * rng.uniform(1.5, 8.0, count)
    weight = 10.0 ** rng.uniform(1.0, 3.5, count)
    # between nearly slack and lifted
    reach = length - height * rng.uniform(0.1, 0.95, count)
    return {
        "horizontal_distance": reach,
        "vertical_distance": height,
        "unstretched_length": length,
        "axial_stiffness": weight * length * 10.0 ** rng.uniform(1.0, 5.0, count),
        "submerged_weight": weight,
    }


@pytest.mark.parametrize("friction", [0.0, 0.5])
def test_lines_on_a_bed(friction: float) -> None:
    lines = family(1)
    solution = solve_catenary(**lines, bed_friction=friction)
    columns = [*lines.values(), np.full(len(lines["unstretched_length"]), friction)]
    share, errors = compare(solution, moorpy(np.column_stack(columns)), lines["unstretched_length"])
    assert share > 0.9
    assert np.quantile(errors, 0.99) < 1e-8


def test_lines_clear_of_the_bed() -> None:
    lines = family(2)
    clearance = 5.0 * lines["unstretched_length"]
    solution = solve_catenary(**lines, bed_clearance=clearance)
    columns = [*lines.values(), -clearance]
    share, errors = compare(solution, moorpy(np.column_stack(columns)), lines["unstretched_length"])
    assert share > 0.9
    assert np.quantile(errors, 0.99) < 1e-8


def test_raised_anchor_that_hangs_clear_of_the_bed() -> None:
    """Lines that do reach the bed between two raised ends are left out: there MoorPy gives the forces without bed."""
    lines = family(3)
    clearance = 0.2 * lines["vertical_distance"]
    solution = solve_catenary(**lines, bed_clearance=clearance)
    columns = [*lines.values(), -clearance]
    clear = solution.grounded_length == 0.0
    assert clear.mean() > 0.2
    peer = moorpy(np.column_stack(columns))
    share, errors = compare(solution, peer, lines["unstretched_length"])
    assert share > 0.9
    assert np.quantile(errors[clear], 0.9) < 1e-8


def test_stiffness_of_the_fairlead() -> None:
    lines = family(4)
    solution = solve_catenary(**lines)
    columns = [*lines.values(), np.zeros(len(lines["unstretched_length"]))]
    peer = moorpy(np.column_stack(columns))
    ours = solution.stiffness.reshape(-1, 4)
    errors = np.abs(np.abs(peer[:, 5:]) - np.abs(ours)).max(axis=1) / np.abs(ours).max(axis=1)
    # of the lines on the bed MoorPy lets about one in a hundred sag through it (negative vertical force at the anchor)
    through_the_bed = (solution.grounded_length > 0.0) & (peer[:, 3] < 0.0)
    assert through_the_bed.mean() < 0.03
    assert np.nanmax(errors[~through_the_bed]) < 1e-5
