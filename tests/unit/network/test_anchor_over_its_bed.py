"""An anchor that stands over the bed is warned of; fairleads, hangers and what is fixed above are not."""

from __future__ import annotations

from pathlib import Path

import pytest

import moyai

CASE = """
moyai: 1
title: Buoy on a chain
site: {water_depth: 20 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: network
  bed: {stiffness: 3e5 Pa/m, damping: 3e4 Pa s/m}
  line_types:
    chain: {catalogue: studless_chain_R3, diameter: 30 mm, damping_ratio: 0.1}
  points:
    anchor: {kind: fixed, position: [0, 0, PLACE]}
    wall: {kind: fixed, position: [30 m, 0, -1 m]}
    buoy: {kind: sphere, position: [20 m, 0, 0], diameter: 2 m, mass: 500 kg, drag_coefficient: 0.5,
           added_mass_coefficient: 0.5}
  lines:
    chain: {start: anchor, end: buoy, type: chain, length: 30 m, segments: 30}
    leash: {start: wall, end: END, type: chain, length: 12 m, segments: 12}
analyses: [statics]
"""


@pytest.mark.parametrize(("place", "end", "warned"), [
    ("-15 m", "buoy", ["anchor"]), ("bed", "buoy", []), ("-19.8 m", "buoy", []), ("-15 m", "anchor", ["anchor"]),
])  # fmt: skip
def test_an_anchor_over_the_bed_is_warned_of(tmp_path: Path, place: str, end: str, warned: list[str]) -> None:
    text = CASE.replace("PLACE", place).replace("END", end).replace("length: 12 m", "length: 36 m")
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    case = moyai.load_case(tmp_path / "case.yaml")
    found = [item.message for item in case.warnings if "above the bed" in item.message]
    assert len(found) == len(warned) and all(f"'{name}' is fixed 5 m above" in found[0] for name in warned)
