"""The report as files: whole, escaped, sensible with whatever the result holds."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from small_results import entitled, groups_of, pontoon, with_groups
from small_results import without as without_groups

from moyai.core.errors import InputError
from moyai.core.results import Result, read_result
from moyai.core.validity import IdentityCheck, Notice
from moyai.report.document import Abscissa, Animation, Column, Figure, KeyFigures, Mark, Panel, Series, Table
from moyai.report.encoding import figure_csv, page_json, table_csv
from moyai.report.figures_static import draw_figure
from moyai.report.html import render_html
from moyai.report.writer import compose_document, write_report
from moyai.structures.breakwater.headlines import headlines
from moyai.structures.breakwater.report.page import compose
from moyai.structures.breakwater.report.reading import all_numbers, governing_entry, water_levels
from moyai.structures.breakwater.variables import VOCABULARY

VOID = {"meta", "link", "br", "img", "input", "hr"}


class Balanced(HTMLParser):
    """Checks that every element is closed where it should be, and collects ids and scripts."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.ids: list[str] = []
        self.addresses: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        entries = dict(attrs)
        if entries.get("id"):
            self.ids.append(str(entries["id"]))
        self.addresses += [str(value) for key, value in attrs if key in {"src", "href"}]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Self-closing SVG elements."""

    def handle_endtag(self, tag: str) -> None:
        assert self.open and self.open.pop() == tag, f"</{tag}> closes nothing"


def read_page(text: str) -> Balanced:
    page = Balanced()
    page.feed(text)
    assert page.open == []
    assert len(set(page.ids)) == len(page.ids)
    return page


@pytest.fixture(scope="module")
def result() -> Result:
    return pontoon()


@pytest.mark.slow
def test_files_are_complete(result: Result, tmp_path: Path) -> None:
    written = write_report(result, tmp_path / "new" / "folder", name="report")
    assert written[0] == tmp_path / "new" / "folder" / "report.html"
    assert all(path.exists() for path in written)
    assert not list((tmp_path / "new").rglob("*.partial"))
    page = read_page(written[0].read_text(encoding="utf-8"))
    assert not [address for address in page.addresses if not address.startswith(("#", "data:"))], "asks for the network"
    assert written[0].stat().st_size < 6e6
    names = {path.name for path in written[1:]}
    assert {"governing-tensions-and-offsets.csv", "derived-numbers.csv", "identity-checks.csv"} <= names


@pytest.mark.slow
def test_result_read_from_its_file_gives_the_same_document(result: Result, tmp_path: Path) -> None:
    stored = read_result(result.write(tmp_path / "results.nc"))
    here, there = compose_document(result), compose_document(stored)
    assert [table_csv(a) for a in here.tables()] == [table_csv(b) for b in there.tables()]


@pytest.mark.slow
def test_governing_tension_is_the_largest_use_of_the_breaking_load() -> None:
    random = np.random.default_rng(11)
    for _ in range(5):
        groups = groups_of(pontoon())
        used = {}
        for path, data in groups.items():
            if "line_tension_maximum" in data and "/time/" in path:
                values = random.uniform(1e4, 1e6, data["line_tension_maximum"].shape)
                data["line_tension_maximum"] = (
                    data["line_tension_maximum"].dims,
                    values,
                    data["line_tension_maximum"].attrs,
                )
                data["lines_in_motion"] = (data["line_tension_maximum"].dims, np.ones(values.shape))
                data.attrs["status"] = "converged"
                used[path] = values.max()
        result = Result(xr.DataTree.from_dict(groups), headlines=headlines(groups))
        decides = governing_entry(result, all_numbers(water_levels(result)))
        assert decides is not None
        assert decides.tension == pytest.approx(max(used.values()))
        assert decides.domain == "time" and f"/{decides.level}/time/{decides.sea}" == max(used, key=used.__getitem__)
        strength = float(groups[f"/{decides.level}/statics"]["breaking_load"][0])
        assert decides.utilisation == pytest.approx(decides.tension / strength)


def test_summary_shows_the_governing_numbers(result: Result) -> None:
    document = compose(result)
    keys = next(block for block in document.sections[0].blocks if isinstance(block, KeyFigures))
    labels = [item.label for item in keys.items]
    assert labels[:2] == ["Largest line tension", "Utilisation of the breaking load"]
    assert any("offset" in label for label in labels) and any("K_T" in label for label in labels)
    assert 4 <= len([label for label in labels if label != "Not judged"]) <= 12


def test_hostile_titles_stay_text(tmp_path: Path) -> None:
    bad = "<script>alert('x')</script> & </script><img src=x onerror=alert(1)> \"q\" \u2028"
    made = entitled(pontoon(), bad, "H<b>WL")
    made.tree.attrs["case_text"] = f"title: {bad}\n=cmd|' /C calc'!A0"
    checks, notices = (IdentityCheck(bad, math.nan, 1e-6, bad),), (Notice(bad, bad, remedy=bad, source=bad),)
    hostile = Result(made.tree, "not_converged", bad, checks, notices, {"title": bad})
    text = render_html(compose_document(hostile))
    page = read_page(text)
    assert "img" not in re.findall(r"<(\w+)", text.split("<script", 1)[0])
    assert text.count("<script") == text.count("</script>")
    assert "<img" not in text.split('id="packed-plotly"')[0]
    assert page.open == []
    data = text.split('id="report-data">', 1)[1].split("</script>", 1)[0]
    assert "<" not in data and "\u2028" not in data
    json.loads(data)


def test_spreadsheets_get_no_formulas() -> None:
    texts, numbers = ["=1+1", "@x", "+5", "-2", "-abc"], [-1.5, math.nan, 0.1, None, True]
    table = Table("t", "t", (Column("=a", texts), Column("n", numbers)))
    rows = list(csv.reader(io.StringIO(table_csv(table))))
    assert [row[0] for row in rows] == ["'=a", "'=1+1", "'@x", "'+5", "-2", "'-abc"]
    assert [row[1] for row in rows[1:]] == ["-1.5", "", "0.1", "", "yes"]


def test_table_csv_carries_display_units() -> None:
    table = Table("t", "t", (Column("tension", [15000.0, math.nan], "N"), Column("roll", [0.1, 0.2], "rad")))
    rows = list(csv.reader(io.StringIO(table_csv(table))))
    assert rows[0] == ["tension [kN]", "roll [deg]"]
    assert float(rows[1][0]) == 15.0 and rows[2][0] == ""
    assert float(rows[2][1]) == pytest.approx(math.degrees(0.2), rel=1e-6)


def test_figure_csv_puts_series_of_one_abscissa_side_by_side() -> None:
    random = np.random.default_rng(1)
    x, other = np.sort(random.random(7)), np.sort(random.random(4))
    a, b, c = random.random(7), random.random(7), random.random(4)
    figure = Figure(
        "f", "f", (Abscissa("T", "period", "s"),), (Panel("amplitude", "m"),),
        (Series("a", {"T": x}, a), Series("b", {"T": x}, b), Series("measured", {"T": other}, c, style="points")),
    )  # fmt: skip
    rows = list(csv.reader(io.StringIO(figure_csv(figure))))
    assert rows[0] == ["period [s]", "a [m]", "b [m]", "period [s]", "measured [m]"]
    numbers = [[float(cell) for cell in row[:3]] for row in rows[1:]]
    np.testing.assert_allclose(numbers, np.stack([x, a, b], 1), rtol=1e-6)
    assert rows[5][3:] == ["", ""]


def without(result: Result, *parts: str) -> Result:
    return Result(without_groups(result, *parts).tree, "interrupted", "stopped by the user", (), (), {})


@pytest.mark.slow
@pytest.mark.parametrize(
    "absent",
    [
        ("/time", "/frequency", "/rao", "/hydrodynamics", "/sensitivity", "/measured"),
        ("/statics",),
        ("/rao", "/hydrodynamics"),
        ("/frequency",),
        ("/time",),
        ("/statics", "/mooring", "/time", "/frequency", "/rao", "/hydrodynamics", "/sensitivity"),
        ("/HWL", "/LWL"),
        ("storm",),
    ],
)
def test_whatever_is_absent_the_report_stands(result: Result, absent: tuple[str, ...], tmp_path: Path) -> None:
    partial = without(result, *absent)
    partial.tree.attrs.update(structure="breakwater", title="Partial")
    document = compose_document(partial)
    text = render_html(document)
    read_page(text)
    assert "Interrupted" in text and "stopped by the user" in text
    assert document.sections[0].key == "summary" and document.sections[-1].key == "checks"
    assert all(section.blocks for section in document.sections)


@pytest.mark.slow
def test_single_variables_may_be_absent_or_unknown(result: Result) -> None:
    """Drop or blank random variables that a run may lack: the page must stand and show dashes, never nan."""
    random = np.random.default_rng(21)
    for _ in range(6):
        groups = {}
        for node in result.tree.subtree:
            data = node.to_dataset(inherit=False)
            for name in data.data_vars:
                without = data.drop_vars(name)
                if random.random() < 0.2 and not VOCABULARY.absent(node.path, without):
                    data = without
            for name in data.data_vars:
                if random.random() < 0.1 and np.issubdtype(data[name].dtype, np.floating):
                    data[name] = (data[name].dims, np.full(data[name].shape, np.nan), data[name].attrs)
            groups[node.path] = data
        tree = xr.DataTree.from_dict(groups)
        tree.attrs.update(result.tree.attrs)
        text = render_html(compose_document(Result(tree, "converged", "", result.checks, result.notices, {})))
        read_page(text)
        visible = re.sub(r"<script.*?</script>|<style.*?</style>", "", text, flags=re.DOTALL)
        assert not re.search(r">\s*-?(nan|inf|None)\b", visible)


@pytest.mark.slow
def test_interrupted_record_within_its_ramp() -> None:
    groups = groups_of(pontoon())
    path = "/HWL/time/storm/realisation"
    short = groups[path].isel(time=slice(0, 40))
    short.attrs.update(ramp=1e6, status="interrupted")
    groups[path] = short
    text = render_html(compose_document(Result(with_groups(pontoon(), groups).tree, "interrupted")))
    read_page(text)


def test_any_other_structure_gets_a_plain_listing() -> None:
    tree = xr.DataTree.from_dict(
        {
            "/SWL/weir": xr.Dataset(
                {"tension": ("z", np.linspace(1.0, 2.0, 5), {"units": "N", "long_name": "tension"}),
                 "load": ((), 2.0e5, {"units": "N", "long_name": "total load"})},
                {"z": np.linspace(-5.0, 0.0, 5)},
            )
        }
    )  # fmt: skip
    tree.attrs.update(structure="weir", title="カーテン")
    text = render_html(compose_document(Result(tree)))
    read_page(text)
    assert "カーテン" in text and "total load" in text and "200" in text and "kN" in text


@pytest.mark.parametrize("name", ["", "a/b", "..", 'x"y', "a\0b"])
def test_bad_names_are_refused(result: Result, name: str, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="file name"):
        write_report(result, tmp_path, name=name)
    assert list(tmp_path.iterdir()) == []


def test_folder_that_cannot_be_written(result: Result, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InputError, match="cannot write"):
        write_report(result, tmp_path / "file" / "folder")


def test_static_figures_draw_marks_windows_and_bars() -> None:
    x = np.linspace(0.0, 10.0, 50)
    figure = Figure(
        "f", "港口 $5 <b>", (Abscissa("t", "time", "s"),), (Panel("港 $a_b$ K_T", "m", from_zero=True), Panel("x", "")),
        (Series("沖側 $1", {"t": x}, np.sin(x)), Series("b", {"t": x}, np.full(50, np.nan), 1, 1, "points")),
        marks=(Mark("at", x=3.0), Mark("level", y=0.5), Mark("point", x=2.0, y=0.9)), window=(1.0, 5.0),
    )  # fmt: skip
    svg = draw_figure(figure)
    assert svg.startswith(b"<?xml") and svg == draw_figure(figure), "the same figure is the same file"
    bars = Figure(
        "b", "b", (Abscissa("line", "line"),), (Panel("tension", "kN"),),
        (
            Series("rest", {}, np.array([1.0, 2.0]), style="bar"),
            Series("storm", {}, np.array([3.0, np.nan]), style="bar"),
        ),
        categories=("a", "b"),
    )  # fmt: skip
    assert draw_figure(bars, image_format="png")[:4] == b"\x89PNG"


@pytest.mark.slow
def test_pdf_is_written_with_hostile_text(tmp_path: Path) -> None:
    pytest.importorskip("typst")
    made = entitled(without_groups(pontoon(), "/time"), "#panic() *b* $x$ 浮防波堤 <a>", "SWL")
    made.tree.attrs["case_text"] = '#import "x" ``` \\ $'
    written = write_report(made, tmp_path, pdf=True)
    assert written[1].suffix == ".pdf" and written[1].read_bytes()[:5] == b"%PDF-"


def test_page_json_is_safe_inside_a_script() -> None:
    text = "</script><!-- \u2028 &amp; 港"
    assert json.loads(page_json({"a": text}))["a"] == text
    assert not set("<>&\u2028") & set(page_json({"a": text}))


def test_animations_carry_a_still_for_paper(result: Result) -> None:
    animations = [block for block in compose(result).blocks() if isinstance(block, Animation)]
    assert len(animations) == 8
    assert all(block.still.startswith("<svg") and "<style>" in block.still for block in animations)
    assert all(block.scene["window"][0] <= block.scene["maximum"] <= block.scene["window"][1] for block in animations)
