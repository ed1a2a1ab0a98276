"""The vessel type of a unit: what was solved, in te and kN, with the signs and lags that long waves must have."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
import yaml
from typer.testing import CliRunner

import moyai
from moyai.cli.main import app
from moyai.interop.whole_body import coefficients_of_result

CASE = """\
moyai: 1
title: Box
site: {water_depth: 10 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: regular, name: long, height: 0.1 m, periods: [6 s, 60 s], heading_deg: 0}
structure:
  kind: breakwater
  section: {shape: rectangle, beam: 6 m, height: 3.5 m}
  length: 24 m
  draught: 2 m
  centre_of_gravity_above_keel: 1.6 m
  roll_gyradius: 2.1 m
analyses: [statics, frequency]
settings: {drift: false}
"""


def test_the_unit_comes_back_with_the_signs_of_long_waves(tmp_path: Path) -> None:
    (tmp_path / "case.yaml").write_text(CASE, encoding="utf-8")
    result = moyai.run(tmp_path / "case.yaml")
    result.write(tmp_path / "results.nc")
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "results.nc"), "--to", "orcaflex", "--json"])
    assert ran.exit_code == 0, ran.output
    assert any("no OrcaFlex" in note for note in json.loads(ran.stdout)["notes"])
    text = (tmp_path / "results.yml").read_text(encoding="utf-8")
    assert "&id" not in text and "Unverified" in text
    model = yaml.safe_load(text)
    (kind,), (vessel,) = model["VesselTypes"], model["Vessels"]
    (draught,) = kind["Draughts"]
    assert (vessel["VesselType"], vessel["Draught"]) == (kind["Name"], draught["Name"])
    assert kind["Length"] == 24.0
    assert draught["Mass"] == pytest.approx(1.025 * 6.0 * 2.0 * 24.0, rel=1e-6)
    tensor = draught["MomentOfInertiaTensorX, MomentOfInertiaTensorY, MomentOfInertiaTensorZ"]
    assert tensor[0][0] == pytest.approx(draught["Mass"] * 2.1**2, rel=1e-6)
    assert draught["CentreOfMass"] == pytest.approx([0.0, 0.0, -0.4])

    given = coefficients_of_result(result, sea="beam")
    rows = {round(row["AMDPeriodOrFrequency"], 9): row for row in draught["FrequencyDependentAddedMassAndDamping"]}
    for name, key in (("added_mass", "AddedMassMatrix"), ("radiation_damping", "Damping")):
        table = ", ".join(key + axis for axis in ("X", "Y", "Z", "Rx", "Ry", "Rz"))
        for at, period in enumerate(given["period"].values):
            found = np.array(rows[round(float(period), 9)][table])
            want = given[name].isel(omega=at).transpose("influenced_dof", "radiating_dof").values / 1e3
            np.testing.assert_allclose(found[1:4, 1:4], want, rtol=1e-12, atol=1e-9)
            assert not found[[0, 4, 5]].any() and not found[:, [0, 4, 5]].any()

    (heading,) = draught["LoadRAOs"]["RAOs"]
    assert heading.pop("RAODirection") == pytest.approx(90.0)
    ((columns, table),) = heading.items()
    longest = dict(zip(columns.split(", "), table[-1], strict=True))
    assert table == sorted(table)
    # Waves much longer than the unit lift it by its stiffness, in phase with the crest; the water pushes it towards
    # +y a quarter period before the crest comes
    stiffness = np.array(draught["HydrostaticStiffnessz, HydrostaticStiffnessRx, HydrostaticStiffnessRy"])
    assert stiffness[0, 0] == pytest.approx(1.025 * 9.81 * 6.0 * 24.0, rel=1e-9)
    assert longest["RAOPeriodOrFrequency"] >= 60.0 - 1e-9
    assert longest["RAOHeaveAmp"] == pytest.approx(stiffness[0, 0], rel=0.02)
    assert longest["RAOHeavePhase"] == pytest.approx(0.0, abs=3.0)
    assert longest["RAOSwayPhase"] == pytest.approx(-90.0, abs=3.0)
    assert longest["RAOSurgeAmp"] == 0.0
