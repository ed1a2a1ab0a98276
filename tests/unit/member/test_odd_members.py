"""A pile that is held at its top and stands free on the bed, and loads of very few strips, are warned of."""

from __future__ import annotations

from pathlib import Path

import pytest

import moyai

CASE = """
moyai: 1
title: Monopile
site: {water_depth: 24 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: regular, name: design, height: 6 m, period: 11 s, heading_deg: 0}
structure:
  kind: member
  section: {shape: circle, diameter: 2.4 m}
  start: {z: FOOT m}
  end: {z: 10 m}
  support: SUPPORT
  inertia: dnv_c205
  drag: {law: dnv_c205, roughness: 20 mm}
  kinematic_viscosity: 1.19e-6 m2/s
  circulation: {purpose: extreme}
analyses: [forces]
settings: {strips: STRIPS}
"""


@pytest.mark.parametrize(("foot", "support", "strips", "words"), [
    (-24, "start", 40, []), (-24, "both_ends", 8, []), (-12, "end", 40, []),
    (-24, "end", 40, ["fixed at its upper end"]), (-24, "start", 1, ["strips are few (1)"]),
    (-24, "start", 4, ["strips are few (4)"]),
])  # fmt: skip
def test_what_is_odd_is_warned_of(tmp_path: Path, foot: int, support: str, strips: int, words: list[str]) -> None:
    text = CASE.replace("FOOT", str(foot)).replace("SUPPORT", support).replace("STRIPS", str(strips))
    (tmp_path / "case.yaml").write_text(text, encoding="utf-8")
    found = [str(item) for item in moyai.load_case(tmp_path / "case.yaml").warnings]
    found = [item for item in found if "upper end" in item or "strip" in item]
    assert len(found) == len(words) and all(word in found[0] for word in words)
