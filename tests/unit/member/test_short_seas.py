"""Realisations of a sea of a few waves prove no more than one of them does: the largest is that of a few waves."""

from __future__ import annotations

import pytest

import moyai

CASE = """
moyai: 1
title: Pile in a sea
site: {water_depth: 9.5 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: jonswap, name: storm, significant_height: 1.5 m, peak_period: 5.5 s, peak_enhancement: 3.3,
        heading_deg: 0, duration: DURATION, seed: 1}
structure:
  kind: member
  section: {shape: circle, diameter: 0.5 m}
  start: {z: -9.5 m}
  end: {z: 2.5 m}
  support: start
  drag: {law: dnv_c205, roughness: 3 mm}
  kinematic_viscosity: 1.19e-6 m2/s
  circulation: {purpose: extreme}
analyses: [forces]
criteria: {greatest_force: LIMIT}
settings: {strips: 10}
"""


@pytest.mark.parametrize(
    ("duration", "limit", "outcome"),
    [("60 s", "60 kN", "not judged"), ("60 s", "0.5 kN", "does not hold"), ("150 s", "60 kN", "holds")],
)
def test_realisations_of_a_few_waves_keep_no_limit(duration: str, limit: str, outcome: str) -> None:
    result = moyai.run(CASE.replace("DURATION", duration).replace("LIMIT", limit))
    (force,) = [item for item in result.headlines if item.name == "peak_force"]
    short = duration == "60 s"
    assert (force.bound == "at least") is short and ("less than 24 periods" in force.detail) is short
    assert f"each of {'60 s' if short else '2.5 min'}" in force.detail
    assert result.verdict.outcome == outcome
