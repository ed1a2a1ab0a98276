"""A structure of another package, found by its entry point: the spar of docs/tutorial/add_a_structure.md."""

import json
import math
import sys
from pathlib import Path

import pytest
import yaml
from typer.testing import CliRunner

import moyai as front_door
from moyai.cli.main import app
from moyai.core import kinds
from moyai.core.errors import InputError

PACKAGE = Path(__file__).resolve().parents[3] / "examples" / "new_structure"


def forget():
    for found in (kinds._foreign, kinds.structure_kind, kinds.kind_of_result):
        found.cache_clear()


def installed(folder, name, target):
    """Write what an installer leaves behind for a package with one structure."""
    record = folder / f"{name}-1.0.dist-info"
    record.mkdir()
    (record / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n", encoding="utf-8")
    (record / "entry_points.txt").write_text(f"[moyai.structures]\n{name} = {target}\n", encoding="utf-8")


@pytest.fixture
def site(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.syspath_prepend(str(PACKAGE))
    yield tmp_path
    forget()
    for name in [name for name in sys.modules if name.split(".")[0] == "moyai_spar"]:
        del sys.modules[name]


@pytest.fixture
def spar(site):
    installed(site, "spar", "moyai_spar:KIND")
    forget()
    return site


def moyai(*arguments, code=0):
    done = CliRunner().invoke(app, [str(argument) for argument in arguments])
    assert done.exit_code == code, done.output
    return done.stdout


def test_the_package_is_short():
    text = "".join(path.read_text(encoding="utf-8") for path in sorted(PACKAGE.rglob("*.py")))
    assert sum(bool(line.strip()) for line in text.splitlines()) < 200


@pytest.mark.slow
def test_every_command_knows_the_structure(spar):
    file, folder = spar / "case.yaml", spar / "out"
    moyai("new", "spar", "-o", file)
    checked = json.loads(moyai("check", file, "--json"))
    assert checked["structure"] == "spar" and not checked["warnings"]
    assert {item["headline"] for item in checked["criteria"]} == {"line_utilisation", "offset"}
    ran = json.loads(moyai("run", file, "-o", folder, "--json"))
    assert ran["status"] == "converged" and ran["verdict"]["outcome"] == "holds"
    front_door.write_report(front_door.read_result(folder / "results.nc"), spar / "again")
    page = (spar / "again" / "report.html").read_text(encoding="utf-8")
    assert "Draught of the spar" in page and "Tension of the chain at the keel" in page
    assert '"spar"' in moyai("schema")


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_the_answer_is_the_inextensible_catenary(spar):
    case = yaml.safe_load(front_door.template("spar"))
    case["structure"]["chain"]["axial_stiffness"] = "inextensible"
    file = spar / "case.yaml"
    file.write_text(yaml.safe_dump(case), encoding="utf-8")
    result = front_door.run(front_door.load_case(file))
    density, gravity, weight, length = 1025.0, 9.81, 150.0, 60.0
    for level, depth in (("HWL", 22.0), ("LWL", 20.0)):
        state = result.tree[level]
        draught = float(state["draught"])
        drag = 0.5 * density * draught * 1.0**2
        rise = depth - draught
        hanging = math.sqrt(rise**2 + 2.0 * rise * drag / weight)
        offset = length - hanging + drag / weight * math.asinh(weight * hanging / drag)
        assert density * gravity * math.pi / 4 * draught == pytest.approx(2000.0 * gravity + weight * hanging, rel=1e-8)
        assert float(state["offset"]) == pytest.approx(offset, rel=1e-8)
        assert float(state["tension"]) == pytest.approx(math.hypot(drag, weight * hanging), rel=1e-8)


@pytest.mark.parametrize(
    "key, value, place", [("mass", "9000 kg", "structure.mass"), ("chain", {"length": "60 m"}, "structure.chain")]
)
def test_faults_have_their_place(spar, key, value, place):
    case = yaml.safe_load(front_door.template("spar"))
    case["structure"][key] = value
    file = spar / "case.yaml"
    file.write_text(yaml.safe_dump(case), encoding="utf-8")
    found = json.loads(moyai("check", file, "--json", code=2))["faults"]
    assert any(fault["path"].startswith(place) and fault["line"] > 0 for fault in found)


def test_a_package_that_cannot_be_imported_is_named_and_leaves_the_others_alone(site):
    installed(site, "torn", "no_such_package:KIND")
    forget()
    moyai("new", "member")
    said = CliRunner().invoke(app, ["new", "torn"])
    assert said.exit_code == 2
    assert "the structure 'torn' cannot be loaded from no_such_package:KIND" in said.output


def test_an_entry_point_that_is_no_structure_is_refused(site):
    installed(site, "odd", "json:dumps")
    forget()
    with pytest.raises(InputError, match="json:dumps is no kind of structure"):
        kinds.structure_kind("odd")
