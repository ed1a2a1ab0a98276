"""A body at rest on a line of few segments: the band of a finer mesh counts as it does under a buoy."""

from __future__ import annotations

import pytest

import moyai
from moyai.structures.network import run as network_run

CASE = """
moyai: 1
title: Raft on one steep chain in a current, at rest
site: {water_depth: 40 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 1.0 m/s, heading_deg: 0}
structure:
  kind: network
  bed: {stiffness: 3e5 Pa/m, damping: 3e4 Pa s/m, friction: 0.5}
  line_types:
    chain: {catalogue: studless_chain_R3, diameter: 40 mm, damping_ratio: 0.3}
  bodies:
    raft:
      shape: box
      size: [6 m, 5 m, 1.5 m]
      mass: 20 t
      gyration_radii: [1.6 m, 1.9 m, 2.2 m]
      centre_of_gravity: [0, 0, -0.2 m]
      position: [28 m, 0, 0]
      points: {bow: [-3 m, 0, -0.3 m]}
      drag: [1.0, 1.0, 1.5]
      added_mass: [0.4, 0.4, 1.2]
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
  lines:
    chain: {start: anchor, end: bow, type: chain, length: 52 m, segments: SEGMENTS}
analyses: [statics]
criteria: {line_safety_factor: not_judged, greatest_tension: 13 kN, greatest_anchor_load: 4 kN}
"""


def _numbers(segments: int):
    result = moyai.run(CASE.replace("SEGMENTS", str(segments)))
    return result, {item.name: item for item in result.headlines if item.shown}


@pytest.mark.slow
def test_a_raft_on_four_segments_carries_what_its_mesh_leaves_out() -> None:
    coarse, own = _numbers(4)
    _, finer = _numbers(40)
    for name in ("line_tension", "point_load"):
        band = own[name].band
        assert band is not None and band.low <= finer[name].value <= band.high, name
    assert own["line_tension"].value < 12.5e3 < 13.7e3 < own["line_tension"].band.high
    assert coarse.verdict.outcome == "does not hold"


@pytest.mark.slow
def test_a_rest_whose_finer_mesh_is_not_found_keeps_no_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(network_run, "with_finer_meshes", lambda rested, *_: rested)
    result = moyai.run(CASE.replace("SEGMENTS", "4").replace("13 kN", "15 kN"))
    found = {item.name: item for item in result.headlines if item.shown}
    assert found["line_tension"].bound == found["point_load"].bound == "at least"
    assert result.verdict.outcome == "not judged" and "mesh not checked" in result.verdict.message


@pytest.mark.slow
@pytest.mark.parametrize("drawn", [28.0, 26.0])
def test_the_longest_period_of_lines_is_found_where_the_body_rests(drawn: float) -> None:
    """The band of 3.2 s reached to 23 s, or to 0.8 s, with the place where a platform was drawn."""
    text = CASE.replace("SEGMENTS", "12").replace("[28 m", f"[{drawn} m").replace("[statics]", "[statics, modes]")
    (period,) = [item for item in moyai.run(text).headlines if item.name == "natural_period" and item.shown]
    assert period.band is not None
    assert period.band.low > 0.95 * period.value and period.band.high < 1.05 * period.value


@pytest.mark.slow
def test_the_offset_of_a_raft_at_rest_stands_on_the_page_and_is_judged() -> None:
    """On one anchor it swings round: the distance from there, as of buoys."""
    text = CASE.replace("SEGMENTS", "8").replace(
        "{line_safety_factor: not_judged", "{line_safety_factor: not_judged, greatest_offset: 10 m"
    )
    result = moyai.run(text)
    (found,) = [item for item in result.headlines if item.name == "offset" and item.shown]
    assert found.detail.startswith("horizontal distance from its only anchor")
    rest = result.tree["SWL/statics"].to_dataset().sel(condition="current", solid="raft")
    assert found.value == pytest.approx(float((rest["solid_position"].values[:2] ** 2).sum() ** 0.5), rel=1e-9)
    assert found.band is not None and found.band.low <= found.value <= found.band.high
    assert any(
        one.criterion.headline == "offset" and one.outcome == "does not hold" for one in result.verdict.judgements
    )
