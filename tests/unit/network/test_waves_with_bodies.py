"""A body in waves on a line of few segments: its mesh is checked where that takes little time, else nothing holds."""

from __future__ import annotations

from functools import cache

import pytest

import moyai
from moyai.core.results import Result
from moyai.structures.network import dynamics

CASE = """
moyai: 1
title: Raft on one steep chain in waves
site: {water_depth: 40 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 1.0 m/s, heading_deg: 0}
waves: {kind: regular, name: wave, height: 1 m, period: 6 s, heading_deg: 0, theory: linear}
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
      held: [sway, roll, yaw]
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
  lines:
    chain: {start: anchor, end: bow, type: chain, length: 52 m, segments: SEGMENTS}
analyses: [statics, dynamic]
settings: {duration: 14 s, skip: 8 s, mesh_check: 'CHECK'}
criteria: {line_safety_factor: not_judged, greatest_tension: LIMIT}
"""


@cache
def _result(segments: int, check: str, limit: str = "15 kN") -> Result:
    text = CASE.replace("SEGMENTS", str(segments)).replace("CHECK", check).replace("LIMIT", limit)
    return moyai.run(text)


def _number(result: Result, name: str):
    return next(item for item in result.headlines if item.name == name and item.shown)


@pytest.mark.slow
def test_six_segments_under_a_raft_are_judged_with_what_their_mesh_leaves_out() -> None:
    coarse = _result(6, "auto")
    tension, finer = _number(coarse, "line_tension"), _number(_result(40, "off"), "line_tension").value
    assert tension.band is not None and tension.bound == ""
    assert tension.value < 15e3 < finer <= tension.band.high
    pull = _number(coarse, "point_load")
    assert pull.band is not None and pull.band.low <= _number(_result(40, "off"), "point_load").value <= pull.band.high
    assert coarse.verdict.outcome == "does not hold"


@pytest.mark.slow
def test_a_body_whose_mesh_was_not_checked_keeps_no_limit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dynamics, "finer_is_useful", lambda *_: False)
    for check in ("auto", "off"):
        result = _result.__wrapped__(3, check, "30 kN")
        assert _number(result, "line_tension").bound == _number(result, "point_load").bound == "at least"
        assert result.verdict.outcome == "not judged"
        assert "a sensitivity run checks them" in result.verdict.message
    assert _result.__wrapped__(3, "off", "5 kN").verdict.outcome == "does not hold"
