"""Nets at rest on the first page: tension per metre of width, and the pull on the row that holds them."""

from __future__ import annotations

from pathlib import Path

import pytest

import moyai
from moyai.core.headline import Headline

CASE = """\
moyai: 1
title: Stop net
site: {water_depth: 8 m, density: 1000 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.6 m/s, heading_deg: 0}
structure:
  kind: network
  nets:
    net:
      corners: [[0, 0, -0.5 m], [0, 8 m, -0.5 m], [0, 8 m, -4.5 m], [0, 0, -4.5 m]]
      rows: %d
      columns: %d
      twine: {diameter: 3 mm, mesh_pitch: 50 mm, density: 1140 kg/m3, modulus: 1.2 GPa, damping_ratio: 0.2,
              drag_normal: 1.2, drag_tangential: 0.02}
      first_row: fixed
      ballast: 12 kg/m
analyses: [%s]
%s
"""


def run(folder: Path, rows: int, columns: int, analyses: str = "statics", more: str = "") -> dict[str, Headline]:
    (folder / "case.yaml").write_text(CASE % (rows, columns, analyses, more))
    result = moyai.run(folder / "case.yaml")
    return {item.name: item for item in reversed(result.headlines)} | {"verdict": result.verdict}


@pytest.mark.slow
def test_tension_and_pull_at_rest_have_the_band_of_finer_nets_and_are_judged(tmp_path: Path) -> None:
    found = run(tmp_path, 3, 4, more="criteria: {greatest_net_tension: 500 N/m}")
    tension, pull = found["net_tension"], found["held_row_load"]
    # at the row that holds it the net bears all of its pull; strips at its edges are half as wide and lean otherwise
    assert tension.value == pytest.approx(pull.value / 8.0, rel=0.05)
    assert tension.band is not None and pull.band is not None
    finer = run(tmp_path, 9, 13)
    for name, own in (("net_tension", tension), ("held_row_load", pull)):
        assert own.band.low <= finer[name].value <= own.band.high, name
    assert found["verdict"].outcome == "holds"
    assert run(tmp_path, 3, 4, more="criteria: {greatest_net_tension: 20 N/m}")["verdict"].outcome == "does not hold"


@pytest.mark.slow
def test_at_rest_a_net_bears_what_a_run_comes_to(tmp_path: Path) -> None:
    rest = run(tmp_path, 3, 4)
    moving = run(tmp_path, 3, 4, "statics, dynamic", "settings: {duration: 40 s}")
    for name in ("net_tension", "held_row_load"):
        assert rest[name].value == pytest.approx(moving[name].value, rel=0.01), name
