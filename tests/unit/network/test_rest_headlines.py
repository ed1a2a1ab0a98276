"""A network in a current that is not run through time: pull on its anchor and offset are those at rest."""

from __future__ import annotations

import math

import pytest

import moyai

CASE = """
moyai: 1
title: Buoy on a rope
site: {water_depth: 25 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 1.2 m/s, heading_deg: 0}
structure:
  kind: network
  line_types:
    rope: {diameter: 30 mm, mass: 0.725 kg/m, axial_stiffness: 2 MN, damping_ratio: 0.2, drag_normal: 1.2,
           drag_tangential: 0.02, added_mass_normal: 1.0, breaking_load: 100 kN}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    buoy: {kind: sphere, position: [25 m, 0, 0], diameter: 1.8 m, mass: 500 kg, drag_coefficient: 0.5,
           added_mass_coefficient: 0.5}
  lines:
    rode: {start: anchor, end: buoy, type: rope, length: 40 m, segments: 20}
analyses: [statics]
criteria: {line_safety_factor: 10, greatest_offset: 35 m, greatest_anchor_load: LIMIT}
"""


@pytest.mark.parametrize(("limit", "outcome"), [("1 kN", "holds"), ("0.5 kN", "does not hold")])
def test_pull_and_offset_at_rest_are_judged(limit: str, outcome: str) -> None:
    result = moyai.run(CASE.replace("LIMIT", limit))
    found = {item.name: item for item in result.headlines if item.shown}
    rest = result.tree["SWL/statics"].sel(condition="current")
    load = rest["point_load"].sel(point="anchor").values
    assert found["point_load"].value == pytest.approx(float((load**2).sum() ** 0.5))
    # one line ends at the anchor: what it bears there
    assert found["point_load"].value == pytest.approx(float(rest["start_tension"].sel(line="rode")), rel=1e-6)
    place = rest["point_position"].sel(point="buoy").values
    assert found["offset"].value == pytest.approx(math.hypot(*place[:2]))
    # a taut line of 40 m in 25 m of water
    assert 29.0 < found["offset"].value < math.sqrt(40.0**2 - 25.0**2)
    assert result.verdict.outcome == outcome
