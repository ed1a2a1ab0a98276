"""Measured points and other results over the figures of a report, and the tables of differences."""

import math

import numpy as np
import pytest
from typer.testing import CliRunner

from moyai.case.reader import load_case
from moyai.case.templates import template
from moyai.cli.main import app
from moyai.cli.runner import run
from moyai.core.errors import CaseError, InputError
from moyai.core.kinds import structure_kinds
from moyai.core.results import read_result
from moyai.report.differences import read_others, with_others
from moyai.report.document import Abscissa, Chapter, Document, Figure, Panel, Series, Table
from moyai.report.overlay import figures_of, lay_over, misplaced_points, places, unit_factor
from moyai.report.writer import compose_document

MEMBER = template("member").replace("analyses: [sweep, forces, surface]", "analyses: [forces]").split("  - name: storm")
MEMBER = MEMBER[0] + "structure:" + MEMBER[1].split("\nstructure:")[1]
FIGURE = "swl-regular-wave-3-force"


def page(key, unit, factor=1.0, *, label="force", bars=()):
    x = np.linspace(0.0, 4.0, 5)
    axis = () if bars else (Abscissa("t", "time", "s"),)
    series = Series("load", {} if bars else {"t": x}, factor * x[: len(bars) or 5], style="bar" if bars else "line")
    return Document(
        "t",
        "",
        "converged",
        "",
        (Chapter("s", "S", (Figure(key, key, axis, (Panel(label, unit),), (series,), categories=bars),)),),
    )


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Two results of one member: a wide one, and a thin one with points of a flume."""
    folder = tmp_path_factory.mktemp("overlay")
    (folder / "flume.csv").write_text("time [s]; force [kN]\n# calm\n0;1\n2;3.5\n")
    (folder / "wide.yaml").write_text(MEMBER, encoding="utf-8")
    sets = f"measured:\n  - {{file: flume.csv, figure: {FIGURE}, panel: 2}}\n  - {{file: flume.csv, figure: rao}}\n"
    (folder / "thin.yaml").write_text(MEMBER.replace("diameter: 1 m", "diameter: 0.1 m") + sets, encoding="utf-8")
    for name in ("wide", "thin"):
        (folder / name).mkdir()
        run(load_case(folder / f"{name}.yaml")).write(folder / name / "results.nc")
    return folder


def test_units_of_both_are_brought_together():
    assert unit_factor("kN", "N") == 1000.0
    assert unit_factor("%", "1") == 0.01
    assert unit_factor("deg", "rad") == pytest.approx(math.pi / 180.0, rel=1e-15)
    with pytest.raises(InputError, match="'kN' cannot be shown in 'm'"):
        unit_factor("kN", "m")
    laid, (pair,) = lay_over(page("a", "N"), page("a", "kN", 2.0), "other")
    first, second = figures_of(laid)["a"].series
    assert second.label == "load (other)"
    assert second.dash != first.dash
    np.testing.assert_array_equal(second.y, 2000.0 * first.y)
    np.testing.assert_array_equal(pair.there, 2000.0 * pair.here)


def test_only_what_both_have_is_laid_over():
    for other in (page("b", "N"), page("a", "m"), page("a", "N", label="moment")):
        laid, pairs = lay_over(page("a", "N"), other, "other")
        assert len(figures_of(laid)["a"].series) == 1
        assert pairs == ()


def test_bars_stand_by_their_names():
    laid, _ = lay_over(page("a", "N", bars=("x", "y", "z")), page("a", "N", bars=("z", "x")), "other")
    np.testing.assert_array_equal(figures_of(laid)["a"].series[1].y, [1.0, math.nan, 0.0])


def test_a_figure_is_meant_by_its_whole_name_or_its_end():
    known = ("hwl-rao", "lwl-rao", "rao-phase", "swl-xrao")
    assert places("RAO", known) == ("hwl-rao", "lwl-rao")
    assert places("rao-phase", known) == ("rao-phase",)
    assert places("phase-rao", known) == ()


def test_measured_points_come_into_the_figure_that_they_name(folder):
    document = compose_document(read_result(folder / "thin" / "results.nc"))
    figure = figures_of(document)[FIGURE]
    points = figure.series[-1]
    unit = figure.panels[1].unit
    assert (points.label, points.panel, points.style) == ("flume", 1, "points")
    np.testing.assert_allclose(points.y, np.array([1.0, 3.5]) * unit_factor("kN", unit), rtol=1e-12)
    np.testing.assert_array_equal(points.x["time"], [0.0, 2.0])
    (line,) = misplaced_points(document)
    assert "there is no figure 'rao' in this report for the points of flume.csv" in line
    assert FIGURE in line
    assert all(
        item.label != "flume" for key, other in figures_of(document).items() if key != FIGURE for item in other.series
    )


@pytest.mark.slow
def test_differences_are_here_less_there_in_one_unit(folder):
    here = read_result(folder / "wide" / "results.nc")
    document = with_others(compose_document(here), here, read_others([folder / "thin" / "results.nc"]))
    numbers, series = (block for block in document.sections[1].blocks if isinstance(block, Table))
    columns = {column.label: column.values for column in numbers.columns}
    thin = {item.name: item.value for item in read_result(folder / "thin" / "results.nc").headlines}
    row = list(columns["Quantity"]).index("Largest force on the member")
    wide = next(item for item in here.headlines if item.label == "Largest force on the member")
    factor = columns["Here"][row] / wide.value
    assert columns["thin"][row] == pytest.approx(factor * thin[wide.name], rel=1e-12)
    assert columns["Difference"][row] == pytest.approx(columns["Here"][row] - columns["thin"][row], rel=1e-12)
    assert columns["Per cent"][row] == pytest.approx(100.0 * (wide.value / thin[wide.name] - 1.0), rel=1e-9)
    rows = dict(zip(zip(*(column.values for column in series.columns[:2])), range(series.row_count)))
    surface = next(at for (_, words), at in rows.items() if "surface" in words)
    assert series.columns[5].values[surface] == 0.0, "both stand in the same waves"


def test_a_result_without_anything_in_common_is_refused_in_one_line(folder):
    here = read_result(folder / "wide" / "results.nc")
    there = here.__class__(tree=here.tree.__class__())
    other = read_others([folder / "thin" / "results.nc"])[0]
    strange = other.__class__("strange", there, page("other", "N"))
    with pytest.raises(InputError, match=f"strange .* nothing in common.*figures here: .*{FIGURE}.*there: other"):
        with_others(compose_document(here), here, [strange])


@pytest.mark.slow
def test_commands(folder):
    files = [str(folder / name / "results.nc") for name in ("wide", "thin")]
    done = CliRunner().invoke(app, ["compare", *files, "--report", "-o", str(folder / "both")])
    assert done.exit_code == 0, done.output
    assert "First page: here and thin" in done.output
    assert (folder / "both" / "report_tables" / "differences-thin.csv").is_file()
    refused = CliRunner().invoke(app, ["compare", *files, "--pair", "a=b"])
    assert refused.exit_code == 2
    both = ["run", str(folder / "thin.yaml"), "-q", "-o", str(folder / "again")]
    done = CliRunner().invoke(app, [*both, "--overlay", files[0]])
    assert done.exit_code == 0, done.output
    assert "there is no figure 'rao'" in done.output
    assert (folder / "again" / "report_tables" / "series-differences-wide.csv").is_file()
    absent = CliRunner().invoke(app, [*both, "--overlay", "absent.nc"])
    assert absent.exit_code == 2
    assert "no such file: absent.nc" in absent.output


@pytest.mark.slow
@pytest.mark.parametrize("kind", structure_kinds())
def test_every_structure_takes_measured_points(kind, tmp_path):
    case = tmp_path / "case.yaml"
    case.write_text(template(kind) + "\nmeasured: {file: points.csv, figure: anything}\n", encoding="utf-8")
    with pytest.raises(CaseError, match=r"measured.file: there is no file 'points.csv'"):
        load_case(case)
    for text, words in (
        ("1,2\n3,x\n", "'x' is not a number"),
        ("1,2,3\n", "has 3 cells"),
        ("t,f\n", "holds no points"),
    ):
        (tmp_path / "points.csv").write_text(text)
        with pytest.raises(CaseError, match=words):
            load_case(case)
    (tmp_path / "points.csv").write_text("1,2\n")
    assert load_case(case).model.measured[0].figure == "anything"
