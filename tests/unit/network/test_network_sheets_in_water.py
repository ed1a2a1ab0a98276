"""Sheets of a case take water along where it is said, and a run says when nothing is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.structures.network.run import run

CASE = """moyai: 1
title: Flap
site: {{water_depth: 30 m, density: 1000 kg/m3, gravity: 9.81 m/s2}}
structure:
  kind: network
  sheets:
    flap: {{corners: [[0, 0, -2], [0, 0.2, -2], [0, 0.2, -3], [0, 0, -3]], rows: 17, columns: 2,
           warp_stiffness: 50 kN/m,
           weft_stiffness: 50 kN/m, shear_stiffness: 2 kN/m, mass: 40 kg/m2, thickness: 2 mm, drag_normal: 0,
           drag_tangential: 0, first_row: fixed{more}}}
analyses: [modes, dynamic]
settings: {{duration: 0.5 s, output_step: 0.1 s}}
"""


@pytest.mark.parametrize(
    ("more", "reported"), [("", True), (", added_mass: 114 kg/m2", False), (", added_mass: 0", False)]
)
def test_a_run_tells_of_cloth_that_takes_no_water_along(more: str, reported: bool, tmp_path: Path) -> None:
    path = tmp_path / "case.yaml"
    path.write_text(CASE.format(more=more), encoding="utf-8")
    result = run(build(load_case(path)))
    assert result.status == "converged"
    assert any(notice.code == "sheet-without-water" for notice in result.notices) is reported


def test_added_mass_lengthens_the_periods_of_a_flap(tmp_path: Path) -> None:
    """Weight in water 38 kg/m2: three times the inertia across makes the swing of a hanging chain sqrt(4) as slow."""
    slowest = []
    for more in ("", ", added_mass: 120 kg/m2"):
        path = tmp_path / "case.yaml"
        path.write_text(CASE.format(more=more), encoding="utf-8")
        tree = run(build(load_case(path))).tree
        slowest.append(float(np.max(tree["SWL/modes"]["mode_period"].values)))
    # a chain of length L in water: 2.4048 / 2 sqrt(g' / L), g' = 38/40 g of the cloth alone
    chain = 2.0 * np.pi / (1.2024 * np.sqrt(9.81 * 38.0 / 40.0))
    assert slowest[0] == pytest.approx(chain, rel=0.02)
    assert slowest[1] / slowest[0] == pytest.approx(2.0, rel=1e-3)


@pytest.mark.parametrize(("speed", "reported"), [(0.05, False), (1.5, True)])
def test_a_run_tells_of_sheets_that_turned_away_from_their_water(speed: float, reported: bool, tmp_path: Path) -> None:
    """A flap that streams in a strong current lies across to where its added mass acts."""
    text = CASE.replace("mass: 40 kg/m2", "mass: 2.5 kg/m2").replace("drag_normal: 0", "drag_normal: 1.5")
    text = text.format(more=", added_mass: 20 kg/m2").replace(
        "analyses:", f"current: {{speed: {speed} m/s, heading_deg: 0}}\nanalyses:"
    )
    text = text.replace("output_step: 0.1 s", "output_step: 0.1 s, start: rest_in_current")
    path = tmp_path / "case.yaml"
    path.write_text(text, encoding="utf-8")
    result = run(build(load_case(path)))
    assert result.status == "converged"
    assert any(notice.code == "sheet-turned" for notice in result.notices) is reported
