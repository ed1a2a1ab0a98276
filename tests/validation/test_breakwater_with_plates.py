"""A breakwater case with keel plates and a curtain: from the case file through the frequency domain to the drawing."""

import numpy as np
import pytest

import moyai
from moyai.core.errors import MoyaiError

CASE = """
moyai: 1
title: box with keel plates
site: {{water_depth: 10 m, density: 1025 kg/m3, gravity: 9.81 m/s2}}
waves: {{kind: regular, height: 0.5 m, period: 5 s, heading_deg: {heading}}}
structure:
  kind: breakwater
  section: {{shape: rectangle, beam: 8 m, height: 3 m{plates}}}
  length: 50 m
  draught: 2 m
  centre_of_gravity_above_keel: 1.5 m
  roll_gyradius: 2.8 m
  damping: {{fraction_of_critical: 0.05, modes: [sway, heave, roll]}}
lines:
  - {{name: sea, kind: spring, fairlead: {{x: -4 m, above_keel: 1 m}},
     anchor: {{x: -40 m, z: -9 m}}, stiffness: 40 kN/m, pretension: 200 kN}}
  - {{name: shore, kind: spring, fairlead: {{x: 4 m, above_keel: 1 m}},
     anchor: {{x: 40 m, z: -9 m}}, stiffness: 40 kN/m, pretension: 200 kN}}
analyses: [{analyses}]
"""
PLATES = ", plates: [{points: [[-4, 0], [-4, -1.2]]}, {points: [[4, 0], [4, -1.2]]}, {points: [[0, 0], [0.4, -2]]}]"


@pytest.fixture
def solved(tmp_path):
    def solve(plates=PLATES, heading=0, analyses="statics, frequency"):
        path = tmp_path / "case.yaml"
        path.write_text(CASE.format(plates=plates, heading=heading, analyses=analyses))
        return moyai.run(moyai.load_case(path))

    return solve


def first_level(result):
    return next(iter(result.tree.children.values()))


@pytest.mark.slow
def test_runs_with_all_identities(solved):
    bare, plated = solved(plates=""), solved()
    assert plated.status == "converged"
    drift = [check for check in plated.checks if "momentum" in check.name]
    assert drift
    assert all(check.passed for check in plated.checks)
    statics = first_level(plated)["statics"]
    x, z = statics["outline_x"].values, statics["outline_z"].values
    assert np.isnan(x).sum() == 3
    assert np.nanmin(z) == pytest.approx(-4.0)
    assert float(statics["draught"]) == pytest.approx(2.0)
    # Plates hold back the water: more added mass in every motion, less transmission
    for name in ("sway", "heave", "roll"):
        before, after = (
            first_level(item)["hydrodynamics"]["infinite_frequency_added_mass"].sel(
                radiating_dof=name, influenced_dof=name
            )
            for item in (bare, plated)
        )
        assert float(after) > float(before)


@pytest.mark.slow
def test_oblique_sea(solved):
    assert solved(heading=30).status == "converged"


@pytest.mark.slow
def test_time_domain(solved):
    assert solved(analyses="statics, frequency, time").status == "converged"


@pytest.mark.parametrize(
    ("plates", "word"),
    [
        (", plates: [{points: [[0, 0], [0, -9]]}]", "9 m|11 m down"),
        (", plates: [{points: [[0, 0], [0, 0]]}]", "no length"),
        (", plates: [{points: [[-6, 1], [6, 1]]}]", "outline"),
        (", plates: [{points: [[0, 0]]}]", "at least 2"),
        (", plates: [{points: [[0, 0], [0, -1]], bulges: [0, 0]}]", "bulges"),
        (", plates: [{pionts: [[0, 0], [0, -1]]}]", "points"),
    ],
)
def test_faults_are_reported_at_their_line(solved, plates, word):
    with pytest.raises(MoyaiError, match=word):
        solved(plates=plates)
