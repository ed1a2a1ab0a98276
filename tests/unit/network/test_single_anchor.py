"""Offsets of what swings round one anchor: the circle that it needs, wherever the case draws it."""

import pytest

import moyai
from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.structures.network.single_anchor import single_anchors

CASE = """moyai: 1
title: Buoy on a slack line
site: {{water_depth: 10 m, density: 1025 kg/m3, gravity: 9.81 m/s2}}
waves: {{name: daily, kind: regular, height: 0.6 m, period: 4 s, heading_deg: {heading}}}
current: {{speed: 0.5 m/s, heading_deg: {heading}}}
structure:
  kind: network
  line_types:
    rope: {{diameter: 20 mm, mass: 0.3 kg/m, axial_stiffness: 300 kN, damping_ratio: 0.2, drag_normal: 1.2,
           drag_tangential: 0.05, added_mass_normal: 1, breaking_load: 60 kN}}
  points:
    anchor: {{kind: fixed, position: [0, 0, bed]}}
    buoy: {{kind: sphere, position: [{drawn} m, 0, 0], diameter: 0.8 m, mass: 100 kg, drag_coefficient: 0.6,
           added_mass_coefficient: 0.5}}
{more}
  lines:
    leg: {{start: anchor, end: buoy, type: rope, length: 14 m, segments: 10}}
{lines}
analyses: [dynamic]
settings: {{start: rest_in_current, duration: 24 s, mesh_check: "off"}}
"""


def offset(tmp_path, heading: float, drawn: float) -> float:
    path = tmp_path / "buoy.yaml"
    path.write_text(CASE.format(heading=heading, drawn=drawn, more="", lines=""), encoding="utf-8")
    return next(item for item in moyai.run(moyai.load_case(path)).headlines if item.name == "offset").value


@pytest.mark.slow
def test_a_buoy_on_one_anchor_needs_the_same_room_wherever_it_is_drawn(tmp_path):
    found = [offset(tmp_path, heading, drawn) for heading, drawn in ((0, 6.0), (180, 6.0), (0, -3.0))]
    assert found[1] == pytest.approx(found[0], rel=1e-6) and found[2] == pytest.approx(found[0], rel=2e-3)
    # a taut line of 14 m in 10 m of water reaches sqrt(14^2 - 10^2) = 9.8 m
    assert 7.0 < found[0] < 10.0


def test_two_anchors_give_a_place_of_its_own(tmp_path):
    more, lines = (
        "    other: {kind: fixed, position: [20 m, 0, bed]}",
        "    back: {start: other, end: buoy, type: rope, length: 16 m, segments: 10}",
    )
    path = tmp_path / "buoy.yaml"
    known = {}
    for name, extra in (("one", ("", "")), ("two", (more, lines))):
        path.write_text(CASE.format(heading=0, drawn=8, more=extra[0], lines=extra[1]), encoding="utf-8")
        known[name] = single_anchors(build(load_case(path)))
    assert known == {"one": {"buoy": "anchor"}, "two": {}}


SEA = """{{name: storm, kind: jonswap, significant_height: 0.5 m, peak_period: 3 s, peak_enhancement: 3.3,
        heading_deg: {heading}, duration: 24 s, seed: 2}}"""


@pytest.fixture(scope="module")
def storm():
    daily = "{{name: daily, kind: regular, height: 0.6 m, period: 4 s, heading_deg: {heading}}}"
    text = CASE.replace(daily, SEA).replace('"off"}}', '"off", skip: 6 s, realisations: 3}}')
    return moyai.run(text.format(heading=0, drawn=3.0, more="", lines=""))


@pytest.mark.slow
def test_realisations_of_what_swings_round_one_anchor_are_a_mean_too(storm):
    found = next(item for item in storm.headlines if item.name == "offset" and item.shown)
    dynamic, series = storm.tree["SWL/dynamic"].to_dataset(), storm.tree["SWL/time/storm"].to_dataset()
    each = dynamic["distance_from_anchor_of_realisation"].sel(run="storm", point="buoy").values
    assert each.size == 3 and found.value == pytest.approx(each.mean()) and "only anchor 'anchor'" in found.detail
    place = series["point_position"].isel(time=series["time"].values >= 6.0)
    apart = (place.sel(point="buoy") - place.sel(point="anchor")).sel(axis=["x", "y"])
    assert each[0] == pytest.approx(float(((apart**2).sum("axis") ** 0.5).max()), rel=1e-9)
    assert dynamic["distance_from_anchor_of_realisation"].sel(point="anchor").isnull().all()


@pytest.mark.slow
def test_a_code_that_weighs_the_mean_has_it(storm):
    use = next(item for item in storm.headlines if item.name == "line_utilisation" and item.shown)
    mean = float(storm.tree["SWL/dynamic"]["line_tension_mean"].sel(run="storm", line="leg"))
    assert use.mean == pytest.approx(mean / 60e3) and 0.0 < use.mean < use.value
