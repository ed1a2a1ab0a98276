"""Reports in tonnes-force: every number is the SI one divided by standard gravity, and no unit of SI force is left."""

from __future__ import annotations

import io
import json
import math
import re
from pathlib import Path

import openpyxl
import pytest
from small_results import pontoon, without
from tonnes_force import assert_same_numbers, left_in_si
from typer.testing import CliRunner

import moyai
from moyai.cli.main import app
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.report.document import Chapter, Column, Document, Listing, NoticeBlock, Paragraph, Table
from moyai.report.encoding import column_unit
from moyai.report.formatting import display_unit, format_quantity
from moyai.report.html import notice_text, render_html
from moyai.report.language import with_words_in_system
from moyai.report.notices import value_and_limit
from moyai.report.sketch import Sketch
from moyai.report.systems import displayed_in, words_in_system
from moyai.report.workbook import render_workbook
from moyai.report.writer import compose_document, write_report


@pytest.mark.parametrize(
    ("unit", "value", "shown"),
    [
        ("N", 9806.65, "1.00 tf"), ("N", 98.0665, "10.0 kgf"), ("N", 98066.5, "10.0 tf"), ("kN", 9.80665, "1.00 tf"),
        ("N/m", 9806.65, "1.00 tf/m"), ("N m", 19613.3, "2.00 tf·m"), ("Pa", 9806.65, "1.00 tf/m²"),
        ("Pa", 9.80665, "1.00 kgf/m²"), ("N m/rad", 9806.65, "1.00 tf·m/rad"), ("N s/m", 9806.65, "1.00 tf·s/m"),
        ("kg", 2e4, "20.0 t"), ("rad", math.pi, "180°"), ("m", 3.0, "3.00 m"), ("N of a kind", 3.0, "3.00 N·of·a·kind"),
    ],
)  # fmt: skip
def test_quantities_in_tonnes_force(unit: str, value: float, shown: str) -> None:
    with displayed_in("tf"):
        assert format_quantity(value, unit) == shown
    assert display_unit("N", 9806.65).name == "kN"


def test_other_systems_are_refused() -> None:
    with pytest.raises(InputError, match="'lbf' is no system of units"):
        compose_document(without(pontoon(), "/HWL"), "lbf")


def test_columns_of_one_unit_share_tonnes_or_kilograms_force() -> None:
    from moyai.report.document import in_one_unit

    with displayed_in("tf"):
        columns = in_one_unit((Column("a", [10.0], "N"), Column("b", [2e4], "N")))
        assert [column_unit(column).name for column in columns] == ["tf", "tf"]


@pytest.mark.slow
def test_a_report_in_tonnes_force_holds_the_numbers_of_that_in_si() -> None:
    result = without(pontoon(), "/HWL")
    assert assert_same_numbers(result) > 20
    assert left_in_si(compose_document(result))
    assert left_in_si(compose_document(result, "tf")) == []


@pytest.mark.slow
def test_every_file_of_the_report_is_in_tonnes_force(tmp_path: Path) -> None:
    result = without(pontoon(), "/HWL")
    files = write_report(result, tmp_path, units="tf")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "The case and results.nc are in SI" in page and "9806.65" in page
    heads = [path.read_text(encoding="utf-8-sig").splitlines()[0] for path in files if path.suffix == ".csv"]
    assert any("[tf]" in head for head in heads)
    assert not [head for head in heads if re.search(r"\[[kM]?(N|Pa)\b", head)]
    book = openpyxl.load_workbook(io.BytesIO(render_workbook(compose_document(result, "tf"))))
    cells = [str(cell.value) for sheet in book if sheet.title != "Summary" for cell in sheet[1] if cell.value]
    assert any("[tf]" in cell for cell in cells)
    assert not [cell for cell in cells if re.search(r"\[[kM]?(N|Pa)\b", cell)]
    assert "9806.65" in str(book["Summary"]["A3"].value)


@pytest.mark.slow
def test_the_command_takes_units_and_keeps_the_data(tmp_path: Path) -> None:
    without(pontoon(), "/HWL").write(tmp_path / "results.nc")
    before = (tmp_path / "results.nc").read_bytes()
    found = CliRunner().invoke(app, ["report", str(tmp_path / "results.nc"), "--units", "tf"])
    assert found.exit_code == 0, found.output
    assert " tf" in found.output
    assert (tmp_path / "results.nc").read_bytes() == before
    assert "[tf]" in (tmp_path / "report.html").read_text(encoding="utf-8")
    wrong = CliRunner().invoke(app, ["report", str(tmp_path / "results.nc"), "--units", "stone"])
    assert wrong.exit_code == 2
    assert "'stone' is no system of units" in wrong.output


def test_a_case_says_its_units_and_keeps_its_hash() -> None:
    case = moyai.load_case(moyai.template("member"))
    changed = case.replace("display", {"units": "tf"})
    assert changed.model.display.units == "tf"
    assert changed.case_hash == case.case_hash


def test_forces_in_remarks_are_in_the_units_of_their_number() -> None:
    said = "steady 3.97 kN; 18.5 kN of 300 kN; 228 N/m, 12.5 kN m; 0.05 kN; 3 m of 2.5 MPa; 0.5 rho, 12 knots"
    assert words_in_system(said) == said
    with displayed_in("tf"):
        found = words_in_system(said)
    assert (
        found
        == "steady 0.405 tf; 1.89 tf of 30.6 tf; 23.2 kgf/m, 1.27 tf m; 5.1 kgf; 3 m of 255 tf/m2; 0.5 rho, 12 knots"
    )


def test_both_ends_of_a_range_change_together() -> None:
    said = "12.0 to 30.8 kN; between 2 and 3 kN/m, 0.4 ± 0.1 kN; legs 1 and 20 kN; 3 to 5 m"
    with displayed_in("tf"):
        found = words_in_system(said)
        assert words_in_system(found) == found
    assert found == "1.22 to 3.14 tf; between 0.204 and 0.306 tf/m, 40.8 ± 10.2 kgf; legs 1 and 2.04 tf; 3 to 5 m"


def test_no_remark_of_a_page_is_left_in_newtons() -> None:
    notice = Notice("kind", "a line bears 12.0 to 30.8 kN", remedy="choose one of 40 kN")
    drawn = Sketch((-1.0, 1.0, -1.0, 1.0))
    drawn.label(5.0, 5.0, "pull 25 kN", "start")
    blocks = (
        NoticeBlock((notice,)), Paragraph("at 5.0 kN/m"), drawn.drawing("d", "Drawing", "of 3 kN"),
        Table("t", "Table", (Column("Where", ["steady 8.0 kN"]),), "note of 9 kN"), Listing("case", "load: 7 kN"),
    )  # fmt: skip
    document = Document("t", "", "converged", "", (Chapter("s", "S", blocks),), units="tf")
    with displayed_in("tf"):
        document = with_words_in_system(document)
    page = render_html(document)
    assert set(re.findall(r"[\d.]+ [kM]?N\b", page)) == {"7 kN"}  # the case as it was typed
    for text in ("1.22 to 3.14 tf", "4.08 tf", "0.51 tf/m", "2.55 tf", "0.816 tf", "0.918 tf", "0.306 tf"):
        assert text in page, text


@pytest.mark.slow
@pytest.mark.parametrize("words", [["--units", "tf"], []])
def test_check_shows_forces_in_the_units_asked(tmp_path: Path, words: list[str]) -> None:
    text = moyai.template("breakwater")
    file = tmp_path / "case.yaml"
    file.write_text(text if words else text + "\ndisplay: {units: tf}\n", encoding="utf-8")
    found = CliRunner().invoke(app, ["check", str(file), *words])
    assert found.exit_code == 0, found.output
    assert re.search(r"\d +(tf|kgf)", found.output)
    assert not re.search(r"\d +[kM]?(N|Pa)\b", found.output)
    plain = CliRunner().invoke(app, ["check", str(file), "--units", "SI"]).output
    tension = r"seaward: tension at the fairlead +([\d.]+)"
    (heavy,), (si,) = (re.findall(tension, shown) for shown in (found.output, plain))
    assert float(heavy) * 9.80665 == pytest.approx(float(si), rel=2e-3)
    record = json.loads(CliRunner().invoke(app, ["check", str(file), *words, "--json"]).output)
    assert not any("tf" in number["shown"] for number in record["derived"])
    wrong = CliRunner().invoke(app, ["check", str(file), "--units", "stone"])
    assert wrong.exit_code == 2 and "'stone' is no system of units" in wrong.output


def test_angles_of_notices_are_radians_inside_and_degrees_on_the_page() -> None:
    notice = Notice("body-turned-over", "it leans", value=math.radians(120.0), limit=math.radians(60.0), unit="rad")
    assert "ound 120, limit 60" in notice_text(notice)[1]
    assert value_and_limit(Notice("k", "m", value=2.0, limit=1.0)) == (2.0, 1.0)
    assert notice.as_dict()["unit"] == "rad" and "unit" not in Notice("k", "m").as_dict()
