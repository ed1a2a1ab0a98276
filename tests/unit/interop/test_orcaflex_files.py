"""Text data files of OrcaFlex read back with the same numbers, in te, kN, m and degrees."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

from moyai.case.reader import load_case
from moyai.cli.main import app
from moyai.core.errors import InputError
from moyai.interop.write_orcaflex import orcaflex_text
from moyai.structures.network.case.line_deck import deck_of_case

CASE = """\
moyai: 1
title: Two parts
site: {water_depth: 20 m, density: 1030 kg/m3, gravity: 9.81 m/s2}
waves: {kind: regular, name: swell, height: 1.5 m, period: 7 s, heading_deg: 30, theory: linear}
current: {speed: 0.6 m/s, heading_deg: 90}
structure:
  kind: network
  line_types:
    chain: {diameter: 60 mm, mass: 25 kg/m, axial_stiffness: 90 MN, drag_normal: 2.4, drag_tangential: 1.1,
            added_mass_normal: 1, volume: 3.2e-3 m3/m, viscosity: 1 kN s}
    rope: {diameter: 80 mm, mass: 4 kg/m, axial_stiffness: 5 MN, drag_normal: 1.2, drag_tangential: 0.05,
           added_mass_normal: 1, viscosity: 1 kN s}
  points:
    anchor: {kind: fixed, position: [-60 m, 0, bed]}
    fairlead: {kind: fixed, position: [0, 5 m, -1 m]}
  lines:
    leg: {start: anchor, end: fairlead, parts: [{type: chain, length: 40 m, segments: 20},
          {type: rope, length: 28 m, segments: 7}]}
analyses: [dynamic]
settings: {duration: 10 s}
"""


def test_lines_of_a_case_come_back(tmp_path: Path) -> None:
    (tmp_path / "case.yaml").write_text(CASE, encoding="utf-8")
    found = CliRunner().invoke(app, ["convert", str(tmp_path / "case.yaml"), "--to", "orcaflex", "--json"])
    assert found.exit_code == 0, found.output
    assert any("no OrcaFlex" in note for note in json.loads(found.stdout)["notes"])
    text = (tmp_path / "case.yml").read_text(encoding="utf-8")
    assert text.startswith("%YAML 1.1\n# Type: Model\n") and "Unverified" in text
    model = yaml.safe_load(text)
    assert model["General"]["UnitsSystem"] == "SI"
    water = model["Environment"]
    assert (water["WaterDepth"], water["Density"]) == (20.0, 1.03)
    (wave,) = water["WaveTrains"]
    assert wave["WaveType"] == "Airy"
    assert [wave[name] for name in ("WaveHeight", "WavePeriod", "WaveDirection")] == pytest.approx([1.5, 7.0, 30.0])
    assert (water["RefCurrentSpeed"], water["RefCurrentDirection"]) == pytest.approx((0.6, 90.0))
    rows = np.array(water["CurrentDepth, CurrentFactor, CurrentRotation"])
    assert rows[[0, -1], 0] == pytest.approx([0.0, 20.0])
    assert rows[:, 1] == pytest.approx(1.0) and rows[:, 2] == pytest.approx(0.0)
    chain, rope = model["LineTypes"]
    # moyai's own deck gives the chain the diameter of its volume
    assert chain["OD"] == pytest.approx(math.sqrt(4.0 * 3.2e-3 / math.pi))
    assert (chain["MassPerUnitLength"], chain["EA"]) == pytest.approx((0.025, 90e3))  # te/m, kN
    assert (rope["OD"], rope["MassPerUnitLength"], rope["EA"]) == pytest.approx((0.08, 0.004, 5e3))
    assert (rope["NormalDragCoefficient"], rope["NormalAddedMassCoefficient"]) == pytest.approx((1.2, 1.0))
    (line,) = model["Lines"]
    sections = line["LineType, Length, TargetSegmentLength"]
    assert sections == [[chain["Name"], 40.0, 2.0], [rope["Name"], 28.0, 4.0]]
    ends = next(value for key, value in line.items() if key.startswith("Connection, "))
    assert [row[0] for row in ends] == ["Fixed", "Fixed"]
    assert [row[1:4] for row in ends] == [[-60.0, 0.0, -20.0], [0.0, 5.0, -1.0]]
    assert line["TopEnd"] == "End B"
    # it is not written over
    again = CliRunner().invoke(app, ["convert", str(tmp_path / "case.yaml"), "--to", "orcaflex"])
    assert again.exit_code == 2


def test_what_a_line_cannot_hold_is_refused(tmp_path: Path) -> None:
    (tmp_path / "case.yaml").write_text(CASE, encoding="utf-8")
    deck = deck_of_case(load_case(tmp_path / "case.yaml"))
    with pytest.raises(InputError, match="needs a water depth"):
        orcaflex_text(replace(deck, options=()))
