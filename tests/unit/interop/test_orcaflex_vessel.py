"""The vessel type of a unit: what was solved, in te and kN, with the signs and lags that long waves must have."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml
from typer.testing import CliRunner

import moyai
from moyai.case.templates import template
from moyai.cli.main import app
from moyai.core.results import Result
from moyai.interop.whole_body import coefficients_of_result
from moyai.interop.write_orcaflex import _without_needless, text_of
from moyai.tables.lines import line_type

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


@pytest.mark.slow
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


MOORED = CASE.replace(
    "analyses:",
    """\
lines:
  - name: seaward
    count: 2
    fairlead: {x: -3 m, above_keel: 0.5 m}
    anchor: {x: -40 m}
    segments:
      - {catalogue: studless_chain_R3, diameter: 40 mm, length: 30 m}
      - {catalogue: studless_chain_R3, diameter: 40 mm, length: 8.5 m}
  - name: shoreward
    fairlead: {x: 3 m, above_keel: 0.5 m}
    anchor: {x: 40 m}
    segments: [{length: 38.5 m, submerged_weight: 300 N/m, axial_stiffness: 1e8 N, breaking_load: 1 MN}]
analyses:""",
)
ENDS = "Connection, ConnectionX, ConnectionY, ConnectionZ"


@pytest.mark.slow
def test_the_unit_stands_on_its_lines(tmp_path: Path) -> None:
    (tmp_path / "case.yaml").write_text(MOORED, encoding="utf-8")
    moyai.run(tmp_path / "case.yaml").write(tmp_path / "results.nc")
    (level,) = moyai.read_result(tmp_path / "results.nc").tree.children.values()
    statics = level["statics"].to_dataset()
    (tmp_path / "case.yaml").unlink()  # the result keeps the text of its case
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "results.nc"), "--to", "orcaflex", "--json"])
    assert ran.exit_code == 0, ran.output
    notes = json.loads(ran.stdout)["notes"]
    assert any("line 'shoreward' is left out: mass and diameter" in note for note in notes)
    assert any("equal lines are evenly spaced" in note for note in notes)
    model = yaml.safe_load((tmp_path / "results.yml").read_text(encoding="utf-8"))
    (vessel,), (kind,) = model["Vessels"], model["LineTypes"]
    assert [line["Name"] for line in model["Lines"]] == ["seaward 1", "seaward 2"]
    for line, aside in zip(model["Lines"], (-6.0, 6.0), strict=True):
        top, bottom = next(value for key, value in line.items() if key.startswith(ENDS))
        # x of the vessel runs along the crest, y along the waves: -y and x of the site
        # lines that differ heel the unit by 4.5 millirad about its keel, 2 m deep but for a millimetre
        heel = float(statics["heel"])
        across, up = -3.0 * np.cos(heel) + 0.5 * np.sin(heel), -2.0 + 0.5 * np.cos(heel) + 3.0 * np.sin(heel)
        assert top[:4] == [vessel["Name"], -aside, pytest.approx(across, abs=1e-3), pytest.approx(up, abs=1e-3)]
        # the origin is the unit at rest, which the lines shift by some decimetres
        assert bottom[:4] == ["Fixed", -aside, pytest.approx(float(statics["anchor_x"].sel(line="seaward"))), -10.0]
        assert bottom[2] == pytest.approx(-40.0, abs=0.3)
        sections = line["LineType, Length, TargetSegmentLength"]
        assert [section[:2] for section in sections] == [[kind["Name"], 8.5], [kind["Name"], 30.0]]
    # the chain weighs in water what the catalogue says
    properties = line_type("studless_chain_R3", 0.04)
    weight = 9.81 * (1e3 * kind["MassPerUnitLength"] - 1025.0 * np.pi / 4.0 * kind["OD"] ** 2)
    assert weight == pytest.approx(properties.submerged_weight_per_length(1025.0, 9.81), rel=1e-9)
    assert kind["EA"] * 1e3 == pytest.approx(properties.axial_stiffness, rel=1e-9)


def test_a_body_of_a_network_holds_its_lines(tmp_path: Path) -> None:
    example = Path(__file__).resolve().parents[3] / "examples" / "network" / "moored_box.yaml"
    target = tmp_path / "box.yml"
    ran = CliRunner().invoke(app, ["convert", str(example), "--to", "orcaflex", "-o", str(target), "--json"])
    assert ran.exit_code == 0, ran.output
    assert any("of the bodies are left out" in note for note in json.loads(ran.stdout)["notes"])
    model = yaml.safe_load(target.read_text(encoding="utf-8"))
    (vessel,), (kind,) = model["Vessels"], model["VesselTypes"]
    (draught,) = kind["Draughts"]
    assert (vessel["Name"], vessel["VesselType"]) == ("box", kind["Name"])
    ends = [next(value for key, value in line.items() if key.startswith(ENDS)) for line in model["Lines"]]
    assert sorted(end[1][:4] for end in ends) == sorted(
        ["box", x, y, -0.8] for x, y in ((-3.0, 6.0), (3.0, 6.0), (-3.0, -6.0), (3.0, -6.0))
    )
    # a box 6 by 12 m, 1 m deep: rho g (A, I + V (z_B - z_G)), by hand
    stiffness = np.diag(draught["HydrostaticStiffnessz, HydrostaticStiffnessRx, HydrostaticStiffnessRy"])
    rho_g = 1.025 * 9.81
    by_hand = (72.0, 6.0 * 12.0**3 / 12.0 - 72.0 * 0.3, 12.0 * 6.0**3 / 12.0 - 72.0 * 0.3)
    np.testing.assert_allclose(stiffness, rho_g * np.array(by_hand), rtol=1e-9)
    assert draught["Mass"] == 72.0 and draught["CentreOfMass"] == [0.0, 0.0, -0.2]
    added = next(value for key, value in draught["FrequencyDependentAddedMassAndDamping"][0].items() if "Added" in key)
    np.testing.assert_allclose(np.diag(added)[:3], 1.025 * 72.0 * np.array([0.5, 0.3, 1.2]), rtol=1e-9)


def test_what_it_cannot_hold_is_said_of_orcaflex(tmp_path: Path) -> None:
    case = BUOY.replace("water_depth: 12 m", "water_depth: infinite").replace("[0, 0, bed]", "[0, 0, -12 m]")
    (tmp_path / "case.yaml").write_text(case, encoding="utf-8")
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "case.yaml"), "--to", "orcaflex", "--json"])
    messages = [fault["message"] for fault in json.loads(ran.stdout)["faults"]]
    assert ran.exit_code == 2 and messages
    assert not any("MoorDyn" in message for message in messages)
    assert any("infinite depth cannot be written into a file of OrcaFlex" in message for message in messages)


@pytest.mark.parametrize("kind", ["curtain", "cage", "rigid_cage", "member"])
def test_sheets_and_nets_are_refused_in_one_sentence(kind: str, tmp_path: Path) -> None:
    (tmp_path / "case.yaml").write_text(template(kind), encoding="utf-8")
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "case.yaml"), "--to", "orcaflex", "--json"])
    (fault,) = json.loads(ran.stdout)["faults"]
    assert ran.exit_code == 2
    assert "is not written for OrcaFlex: sheets and nets have no place there" in fault["message"]
    assert "cases of a network" in fault["allowed"]


def test_results_of_a_network_point_to_its_case(tmp_path: Path) -> None:
    Result(xr.DataTree.from_dict({"/": xr.Dataset(attrs={"structure": "network"})})).write(tmp_path / "results.nc")
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "results.nc"), "--to", "orcaflex", "--json"])
    (fault,) = json.loads(ran.stdout)["faults"]
    assert "is written from the case file of a network" in fault["message"]


BUOY = """\
moyai: 1
title: Buoy on a light rope
site: {water_depth: 12 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: network
  line_types:
    rope: {diameter: 1 mm, mass: 0.8 g/m, axial_stiffness: 10 kN, drag_normal: 1.2, drag_tangential: 0.05,
           added_mass_normal: 1, viscosity: 10 N s}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    buoy: {kind: cylinder, position: [2 m, 0, -0.1 m], diameter: 1.2 m, height: 0.9 m, mass: 400 kg,
           drag_coefficient: 0.6, added_mass_coefficient: 0.4}
  lines:
    rope: {start: anchor, end: buoy, type: rope, length: 14 m, segments: 14}
analyses: [statics]
"""


@pytest.mark.slow
def test_a_buoy_that_is_partly_immersed(tmp_path: Path) -> None:
    """OrcaFlex wets a 3D buoy by 1/2 - z/Height: what is written has to float where the case rests."""
    (tmp_path / "case.yaml").write_text(BUOY, encoding="utf-8")
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "case.yaml"), "--to", "orcaflex"])
    assert ran.exit_code == 0, ran.output
    model = yaml.safe_load((tmp_path / "case.yml").read_text(encoding="utf-8"))
    (buoy,) = model["3DBuoys"]
    volume = math.pi / 4.0 * 1.2**2 * 0.9
    assert (buoy["Mass"], buoy["Volume"], buoy["Height"]) == pytest.approx((0.4, volume, 0.9))
    assert np.multiply(buoy["DragArea"], buoy["Cd"])[0] == pytest.approx(0.6 * 1.2 * 0.9, rel=1e-9)
    assert buoy["Ca"] == pytest.approx([0.4] * 3)
    names = list(model)
    assert names.index("3DBuoys") < names.index("Lines"), "what is connected to stands first"
    (line,) = model["Lines"]
    ends = next(value for key, value in line.items() if key.startswith("Connection,"))
    assert [ends[0][0], ends[1][:4]] == ["Fixed", [buoy["Name"], 0.0, 0.0, 0.0]]
    share = buoy["Mass"] / (model["Environment"]["Density"] * buoy["Volume"])
    rest = moyai.run(moyai.load_case(BUOY)).tree["/SWL/statics"]["point_position"]
    z = float(rest.sel(point="buoy").isel(condition=0)[-1])
    assert z == pytest.approx(buoy["Height"] * (0.5 - share), abs=2e-4)  # the rope weighs some grams


def test_the_template_of_a_network_gives_a_file(tmp_path: Path) -> None:
    (tmp_path / "case.yaml").write_text(template("network"), encoding="utf-8")
    ran = CliRunner().invoke(app, ["convert", str(tmp_path / "case.yaml"), "--to", "orcaflex", "--json"])
    assert ran.exit_code == 0, ran.output
    assert any("wet share of a buoy" in note for note in json.loads(ran.stdout)["notes"])
    (buoy,) = yaml.safe_load((tmp_path / "case.yml").read_text(encoding="utf-8"))["3DBuoys"]
    assert buoy["Height"] == 1.4 and buoy["Volume"] == pytest.approx(math.pi / 6.0 * 1.4**3)


def test_numbers_have_no_tail_and_a_current_no_needless_rows() -> None:
    text = text_of({"a": [0.1 + 0.2 - 0.21, -0.0, 1.0], "b": {"c": 3}})
    assert "a: [0.09, 0.0, 1.0]" in text and "c: 3" in text
    z = np.linspace(0.0, 20.0, 101)
    rows = [[float(depth), float((1.0 - depth / 20.0) ** (1 / 7)) if depth < 20.0 else 0.0, 0.0] for depth in z]
    few = _without_needless(rows)
    assert few[0] == rows[0] and few[-1] == rows[-1] and len(few) < 30
    found = np.interp(z, [row[0] for row in few], [row[1] for row in few])
    np.testing.assert_allclose(found, [row[1] for row in rows], atol=1.1e-3)
    assert len(_without_needless([[d, 1.0 - 0.05 * d, 0.0] for d in z.tolist()])) == 2


def test_the_file_goes_into_a_folder_that_is_named(tmp_path: Path) -> None:
    example = Path(__file__).resolve().parents[3] / "examples" / "network" / "moored_box.yaml"
    (tmp_path / "there").mkdir()
    for name, written in (("there", "there/moored_box.yml"), ("new", "new/moored_box.yml"), ("own.yml", "own.yml")):
        ran = CliRunner().invoke(app, ["convert", str(example), "--to", "orcaflex", "-o", str(tmp_path / name)])
        assert ran.exit_code == 0, ran.output
        assert (tmp_path / written).is_file()
