"""``moyai measure nets``: from YAML and CSV to results, report and JSON; mistakes reported with their place."""

from __future__ import annotations

import importlib.util
import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from moyai.case.templates import template
from moyai.cli.main import app
from moyai.core.errors import CaseError
from moyai.core.results import read_result
from moyai.morison.net_law_names import net_law
from moyai.records.nets.case.build import load_nets
from moyai.report.writer import compose_document

EXAMPLE = Path(__file__).resolve().parents[3] / "examples" / "nets"
runner = CliRunner()


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Return the example's folder with its records made."""
    place = tmp_path_factory.mktemp("nets")
    spec = importlib.util.spec_from_file_location("make_net_records", EXAMPLE / "make_records.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.main(place / "records")
    shutil.copy(EXAMPLE / "nets.yaml", place)
    return place, module


def reduced(place: Path) -> str:
    """Return the example with few of its runs."""
    kept = ("frame-10", "A-10", "C-10", "frame-waves-110", "A-waves-110", "frame-towed-waves", "A-towed-waves")
    lines = (place / "nets.yaml").read_text().splitlines()
    return (
        "\n".join(line for line in lines if "kind: " not in line or line.split("name: ")[1].split(",")[0] in kept)
        + "\n"
    )


@pytest.fixture(scope="module")
def run(folder):
    place, module = folder
    done = runner.invoke(app, ["measure", "nets", str(place / "nets.yaml"), "-o", str(place / "out"), "--json"])
    assert done.exit_code == 0, done.stdout
    return json.loads(done.stdout), place / "out", module


@pytest.mark.slow
def test_example_gives_back_what_was_planted(run):
    record, _, module = run
    assert record["vibration"]["frequency"] == pytest.approx(3.0, rel=0.02)
    hits = 0
    for item in record["towing"]:
        planted = module.drag(item["reynolds"], module.specimen(item["net"]).net.solidity)
        hits += abs(item["drag"] - planted) < item["drag_half_width"]
        assert item["drag"] == pytest.approx(planted, rel=0.25)
    assert hits >= 0.85 * len(record["towing"])
    for item in record["waves"]:
        planted = 1.1 if item["kind"] == "towing_waves" else 1.6
        assert abs(item["drag"] - planted) < 1.5 * item["drag_half_width"]
        if item["inertia"] is not None:
            assert abs(item["inertia"] - module.C_M) < 1.5 * item["inertia_half_width"]
    for item in record["laws"]:
        share = module.specimen(item["net"]).net.solidity
        low, high = item["exponent_interval"]
        assert net_law(item["law"]).exponent == pytest.approx(item["exponent"], abs=1e-3)
        assert low - 0.02 < 0.36 - 0.1 * (share - 0.3) < high + 0.02
    assert record["joint_law"]["left_out_error"] < record["joint_law"]["pooled_error"]


@pytest.mark.slow
def test_example_files_are_whole(run):
    record, out, _ = run
    assert {Path(name).name for name in record["files"]} >= {"results.nc", "report.html"}
    result = read_result(out / "results.nc")
    document = compose_document(result)
    titles = [section.title for section in document.sections]
    assert titles[:6] == [
        "Summary", "Drag in still water", "Laws of the drag", "Waves", "Tensions of lines", "Vibration of the carriage",
    ]  # fmt: skip
    assert {table.key for table in document.tables()} >= {"towing", "waves", "nets", "joint-law", "tensions"}
    assert all(check.passed for check in result.checks)
    peaks = {f"{item['line']}, {item['end']}": item for item in record["tensions"]}
    assert peaks["shore, cage"]["peak"] > peaks["shore, anchor"]["peak"] > peaks["offshore, cage"]["peak"]
    tree = result.tree
    force, fitted = (tree["records/A-waves-150"][name].values for name in ("force", "force_fitted"))
    assert np.var(force - fitted) < 0.1 * np.var(force)


@pytest.mark.slow
def test_comparison_of_laws(tmp_path, capsys):
    spec = importlib.util.spec_from_file_location("compare_net_laws", EXAMPLE / "compare_laws.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    module.main([str(tmp_path), "2.4", "22"])
    text = capsys.readouterr().out
    assert "solidity 0.206, fouled by half of the diameter 0.300" in text
    rows = {line.split()[0]: line.split()[1:] for line in text.splitlines() if line.count(".") >= 4}
    assert rows["loland"][0] == "0.304"
    assert len(rows) == 11
    assert (tmp_path / "net_laws.png").stat().st_size > 20_000


@pytest.mark.slow
def test_text_output(folder):
    place, _ = folder
    (place / "few.yaml").write_text(reduced(place))
    done = runner.invoke(app, ["measure", "nets", str(place / "few.yaml"), "-o", str(place / "text"), "--no-report"])
    assert done.exit_code == 0
    for words in ("vibration at", "A-towed-waves", "offshore", "results.nc"):
        assert words in done.stdout


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("table: A}", "table: K}", r"nets\[0\].table: 'K' is not known"),
        ("table: A}", "twine_diameter: 14 mm, mesh_pitch: 11.3 mm}", "close meshes"),
        ("table: A}", "twine_diameter: 1.4 mm, aperture: 11.3 mm, solidity_listed: 22}", "less than 1"),
        ("table: A}", "aperture: 11.3 mm}", "twine diameter of net 'A' is missing"),
        ("table: A}", "twine_diameter: 1.4 mm, mesh_pitch: 12.7}", "do not fit net A's panel"),
        ("net: C, kind", "net: Z, kind", "there is no net 'Z'"),
        ("file: records/A-10.csv", "file: records/A-11.csv", "A-11.csv cannot be read"),
        ("force: force,", "force: kraft,", "no column 'kraft'"),
        ("speed: 0.35 m/s, period: 1.25 s", "speed: -0.35 m/s, period: 1.25 s", "greater than 0"),
        ("water_depth: 45 cm\n", "", "'water_depth' is missing"),
        ("panel_z: -20 cm", "panel_z: -50 cm", "above the bed"),
        ("panel_area: 660 cm2", "panel_area: 660", "cm2 or m2"),
        ("name: C-10", "name: A-10", "is already given above"),
        ("kinematic_viscosity", "kinematic_viscosty", "did you mean"),
        ("columns: {lift: lift, velocity: velocity}", "columns: {lift: lift}", "velocity or of the elevation"),
    ],
)
def test_mistakes_are_reported_with_their_place(folder, tmp_path, old, new, words):
    import re

    place, _ = folder
    text = reduced(place)
    assert old in text
    path = place / f"broken-{abs(hash((old, new)))}.yaml"
    path.write_text(text.replace(old, new, 1))
    done = runner.invoke(app, ["measure", "nets", str(path), "-o", str(tmp_path / "o")])
    assert done.exit_code == 2, done.stdout
    assert re.search(words, done.stderr), done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.slow
def test_empty_and_short_records(folder, tmp_path):
    place, _ = folder
    text = reduced(place)
    for name, content, words in (
        ("empty", "", "holds no table"),
        ("header", "time [s], force [N], lift [N], speed [m/s]\n", "no rows"),
        ("short", "time [s], force [N], lift [N], speed [m/s]\n0,1,0,1\n0.1,1,0,1\n", "holds 2 samples"),
        ("units", "time [s], force [m], lift [N], speed [m/s]\n0,1,0,1\n", "no unit of a force"),
        ("still", "time [s], force [N], lift [N], speed [m/s]\n" + "".join(f"{k / 50},0,0,0\n" for k in range(500)),
         "does not move"),
    ):  # fmt: skip
        (place / "records" / f"{name}.csv").write_text(content)
        path = place / f"{name}.yaml"
        path.write_text(text.replace("records/A-10.csv", f"records/{name}.csv"))
        done = runner.invoke(app, ["measure", "nets", str(path), "-o", str(tmp_path / name)])
        assert done.exit_code == 2
        assert words in done.stderr, done.stderr


def test_misprinted_rows_of_the_table_are_reported(folder):
    place, _ = folder
    text = reduced(place).replace("{name: E, table: E}", "{name: E, table: J}")
    path = place / "misprint.yaml"
    path.write_text(text)
    campaign, _, notices = load_nets(path)
    assert [notice.code for notice in notices] == ["net-table-misprint"]
    assert "projected area" in notices[0].message
    # data as printed
    assert campaign.specimen("E").projected_area == pytest.approx(675.8e-4)


def test_cages_alone_need_no_water(folder):
    place, _ = folder
    text = (place / "nets.yaml").read_text()
    cages = text[text.index("cages:") :]
    path = place / "cages.yaml"
    path.write_text(f"moyai: 1\ntitle: Cage\n{cages}")
    done = runner.invoke(app, ["measure", "nets", str(path), "-o", str(place / "cages"), "--json"])
    assert done.exit_code == 0, done.stdout
    assert len(json.loads(done.stdout)["tensions"]) == 4


def test_the_template_names_only_what_the_schema_knows(tmp_path):
    path = tmp_path / "nets.yaml"
    path.write_text(template("nets"), encoding="utf-8")
    with pytest.raises(CaseError) as raised:
        load_nets(path)
    # its files are absent, nothing else is wrong
    assert all("cannot be read" in fault.message for fault in raised.value.faults)
    assert len(raised.value.faults) == 7
