"""Static lines of other programs and papers (data/static_line_references.txt): every printed digit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from moyai.mooring.catenary import solve_catenary
from moyai.mooring.lines import Line, LineType, Segment
from moyai.mooring.system import LineSystem

ROWS = [
    line.split()
    for line in (Path(__file__).parent / "data" / "static_line_references.txt").read_text(encoding="utf-8").splitlines()
    if line and not line.startswith("#")
]


@pytest.mark.parametrize("row", ROWS, ids=[f"{row[0]}-{row[7]}-{row[1]}" for row in ROWS])
def test_every_printed_digit(row: list[str]) -> None:
    x, z, length, axial, weight = (float(item) for item in row[1:6])
    line = solve_catenary(x, z, length, axial, weight, bed=row[6] == "1")
    value = {
        "horizontal": line.horizontal_tension,
        "vertical": line.vertical_tension_fairlead,
        "grounded": line.grounded_length,
        "tension": line.tension_fairlead,
        "anchor_tension": line.tension_anchor,
        "stiffness": line.stiffness[0, 0],
    }[row[7]]
    assert float(value) == pytest.approx(float(row[8]), abs=float(row[9]))


def test_three_chains_to_one_anchor() -> None:
    """CableDyn V-S1m: the force of each chain on its turbine, and nothing left at the shared anchor but its uplift."""
    anchor = (725.382878, 418.8, -200.0)
    weight = (685.0 - 1025.0 * np.pi / 4.0 * 0.333**2) * 9.80665
    chain = LineType("chain", weight, 3.27e9)
    for fairlead, pull in (
        ((50.229473, 29.0, -14.0), (1168851.0, 674836.5, -2027608.6)),
        ((1400.536283, 29.0, -14.0), (-1168851.0, 674836.5, -2027608.6)),
        ((725.382878, 1198.4, -14.0), (0.0, -1349672.9, -2027608.6)),
    ):
        system = LineSystem((Line("chain", anchor, fairlead, (Segment(chain, 850.0),)),), 200.0)
        force = system.forces(np.zeros(6))[:3]
        # MoorDyn-C lumps the chain into 200 segments; 0.01 per cent of the tension
        assert np.abs(force - pull).max() < 1e-4 * np.linalg.norm(pull)


@pytest.mark.shared_data
@pytest.mark.parametrize(
    ("name", "fairlead", "anchor"), [("WD0050", 1001.995, 835.867), ("WD0200", 2070.805, 1406.618)]
)
def test_deck_values_are_those_of_the_files(shared_data: Path, name: str, fairlead: float, anchor: float) -> None:
    text = (shared_data / "moordyn_decks" / f"{name}_Chain.txt").read_text(encoding="utf-8", errors="replace")
    words = {line.split()[0]: line.split() for line in text.splitlines() if line.split()}
    diameter, mass, axial = (float(words["chain"][i]) for i in (1, 2, 3))
    rows = [line.split() for line in text.splitlines()]
    fixed = next(row for row in rows if len(row) > 1 and row[1] == "Fixed")
    length = next(float(row[4]) for row in rows if len(row) > 4 and row[1] == "chain")
    weight = (mass - 1025.0 * np.pi / 4.0 * diameter**2) * 9.81
    line = solve_catenary(float(fixed[2]), -float(fixed[4]), length, axial, weight)
    assert line.tension_fairlead / 1e3 == pytest.approx(fairlead, abs=1e-3)
    assert line.tension_anchor / 1e3 == pytest.approx(anchor, abs=1e-3)
