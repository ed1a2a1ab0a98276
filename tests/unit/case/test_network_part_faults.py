"""Mistakes in bodies, floats, sheets and meshes of network cases: reported at their place, before anything is run."""

import pytest

from moyai.case.reader import load_case
from moyai.core.errors import CaseError

SITE = """moyai: 1
title: Test
site: {water_depth: 12 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
"""
BODY = (
    SITE
    + """current: {speed: 0.4 m/s, heading_deg: 0}
waves: {kind: regular, name: waves, height: 0.5 m, period: 4 s, heading_deg: 0}
structure:
  kind: network
  bed: {stiffness: 3e5 Pa/m, damping: 3e4 Pa s/m}
  line_types: {chain: {catalogue: studless_chain_U3, diameter: 22 mm, damping_ratio: 0.3}}
  bodies:
    box: {shape: box, size: [4 m, 6 m, 2 m], mass: 20 t, gyration_radii: [1.8 m, 1.3 m, 2.1 m], position: [0, 0, 0],
          drag: [1, 1, 1], added_mass: [0.5, 0.5, 1], points: {west: [-2 m, 0, -1 m]}}
  points:
    anchor: {kind: fixed, position: [-30 m, 0, bed]}
    buoy: {kind: sphere, position: [-15 m, 0, 0], diameter: 1 m, mass: 100 kg, drag_coefficient: 0.5,
           added_mass_coefficient: 0.5}
  lines:
    one: {start: anchor, end: buoy, type: chain, length: 22 m, segments: 10}
    two: {start: buoy, end: west, type: chain, length: 14 m, segments: 7}
analyses: [statics, dynamic]
settings: {duration: 8 s}
"""
)
SHEET = (
    SITE
    + """structure:
  kind: network
  line_types: {chain: {catalogue: studless_chain_U3, diameter: 22 mm, damping_ratio: 0.3}}
  sheets:
    cloth: {corners: [[0, -3, -1], [0, 3, -1], [0, 3, -4], [0, -3, -4]], rows: 4, columns: 5, warp_stiffness: 40 kN/m,
            weft_stiffness: 40 kN/m, shear_stiffness: 1 kN/m, mass: 1 kg/m2, thickness: 1 mm, drag_normal: 1.4,
            drag_tangential: 0.02, first_row: fixed}
  points: {anchor: {kind: fixed, position: [-5 m, 0, -8 m]}}
  lines: {rope: {start: anchor, end: "cloth[3,2]", type: chain, length: 6.5 m, segments: 4}}
analyses: [statics, dynamic]
settings: {duration: 2 s}
"""
)
FAULTS = [
    (BODY, "position: [0, 0, 0]", "position: [0, 0, -11.5 m]", "points.west", "under the bed", "at least -12 m"),
    (BODY, "length: 22 m", "length: 1e-9 m", "lines.one", "never end", "fewer segments or more length"),
    (BODY, "0.4 m/s, heading_deg: 0", "4 m/s, heading_deg: 180", "current", "blocks waves", "longer than"),
    (SHEET, "[0, 3, -4], [0, -3, -4]", "[0, 3, -1], [0, -3, -4]", "corners[2]", "same place", "move one"),
    (SHEET, "[0, 3, -4], [0, -3, -4]", "[0, -3, -4], [0, 3, -4]", "cloth.corners", "two sides cross", "swap"),
    (SHEET, "40 kN/m", "0", "cloth.warp_stiffness", "neither along warp nor along weft", "greater than 0"),
    (SHEET, "cloth[3,2]", "cloth[4,2]", "rope.end", "no point 'cloth[4,2]'", "'cloth[0,0]' to 'cloth[3,4]'"),
]  # fmt: skip
WARNINGS = [
    ("mass: 20 t", "mass: 60 t", "structure.bodies.box.mass", "wholly under water it displaces 4.92e+04 kg"),
    ("mass: 100 kg", "mass: 900 kg", "structure.points.buoy.mass", "the sphere of 900 kg sinks"),
]


def written(folder, text):
    path = folder / "case.yaml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("text", [BODY, SHEET])
def test_the_cases_that_the_mistakes_start_from_are_sound(tmp_path, text):
    assert not load_case(written(tmp_path, text)).warnings


@pytest.mark.parametrize(("text", "good", "bad", "where", "said", "helps"), FAULTS)
def test_a_mistake_in_a_part_is_reported_once_with_its_place(tmp_path, text, good, bad, where, said, helps):
    assert good in text
    with pytest.raises(CaseError) as raised:
        load_case(written(tmp_path, text.replace(good, bad)))
    faults = raised.value.faults
    assert len(faults) == 1
    assert where in str(faults[0]) and said in str(faults[0]) and helps in str(faults[0])


@pytest.mark.parametrize(("good", "bad", "where", "said"), WARNINGS)
def test_what_sinks_is_reported(tmp_path, good, bad, where, said):
    warnings = load_case(written(tmp_path, BODY.replace(good, bad))).warnings
    assert [item.path for item in warnings] == [where]
    assert said in warnings[0].message
