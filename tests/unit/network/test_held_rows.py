"""A net hung from a fixed row pulls on it with its weight in water and its ballast; criteria of lines need lines."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

import moyai
from moyai.core.errors import CaseError

CASE = """
moyai: 1
title: Hanging net
site: {water_depth: 8 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: network
  points: {}
  nets:
    net:
      corners: [[0, 0, -0.5 m], [0, 10 m, -0.5 m], [0, 10 m, -5 m], [0, 0, -5 m]]
      rows: 8
      columns: 15
      twine: {diameter: 3 mm, mesh_pitch: 40 mm, density: 1140 kg/m3, modulus: 1.2 GPa, damping_ratio: 0.2,
              drag_normal: 1.2, drag_tangential: 0.02}
      first_row: fixed
      ballast: 8 kg/m
analyses: [statics, dynamic]
settings: {start: rest, duration: 2 s, mesh_check: 'off'}
"""


def test_a_net_at_rest_hangs_its_weight_on_the_held_row(tmp_path: Path) -> None:
    path = tmp_path / "net.yaml"
    path.write_text(CASE, encoding="utf-8")
    result = moyai.run(path)
    # twine of two directions at 40 mm over 10 m x 4.5 m, and 8 kg/m of ballast in water
    twine = (1140.0 - 1025.0) * math.pi / 4.0 * 0.003**2 * 2.0 / 0.040 * 10.0 * 4.5
    number = next(item for item in result.headlines if item.name == "held_row_load")
    assert number.value == pytest.approx((twine + 80.0) * 9.81, rel=3e-3)
    assert f"{number.value / 10.0:.3g} N per metre" in number.detail


def test_a_factor_of_safety_of_lines_needs_lines(tmp_path: Path) -> None:
    path = tmp_path / "net.yaml"
    path.write_text(CASE + "criteria: {line_safety_factor: 3}\n", encoding="utf-8")
    with pytest.raises(CaseError, match="no lines"):
        moyai.load_case(path)
