"""What a result shows in Python: first page of a notebook, tables as pandas frames, figures of plotly."""

from __future__ import annotations

import pickle
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from small_results import pontoon

import moyai
from moyai.core.headline import Headline, Judgement, Verdict
from moyai.core.validity import Notice
from moyai.report.document import Abscissa, Figure, Mark, Panel, Series
from moyai.report.encoding import figure_columns
from moyai.report.plotly_figure import plotly_figure
from moyai.report.views import ReportedResult, Views, with_views


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> ReportedResult:
    """A result that was written and read."""
    file = tmp_path_factory.mktemp("views") / "results.nc"
    pontoon().write(file)
    return moyai.read_result(file)


@pytest.mark.slow
def test_frames_hold_the_tables_of_the_report(result: ReportedResult, tmp_path: Path) -> None:
    files = moyai.write_report(result, tmp_path)
    written = {path.stem: path for path in files if path.suffix == ".csv"}
    assert set(result.tables) == set(written)
    for name in result.tables:
        frame, csv = result.tables[name], pd.read_csv(written[name], encoding="utf-8-sig")
        assert list(frame.columns) == list(csv.columns)
        assert len(frame) == len(csv)
        for head in frame.columns:
            if pd.api.types.is_numeric_dtype(csv[head]) and pd.api.types.is_numeric_dtype(frame[head]):
                np.testing.assert_allclose(frame[head].astype(float), csv[head], rtol=1e-6)


def test_names_take_underscores_and_ends_and_a_wrong_one_names_those_that_exist(result: ReportedResult) -> None:
    level = next(name for name in result.tables if name.endswith("-natural-periods"))
    assert result.tables[level.replace("-", "_")].equals(result.tables[level])
    with pytest.raises(KeyError, match=rf"no table is called 'absent'; there are: .*{level}"):
        result.tables["absent"]
    # of the level that governs; another ending answers twice at each
    assert "layout" in dir(result.figures["rao"])
    with pytest.raises(KeyError, match=r"\d+ tables answer to 'wave'; there are: "):
        result.tables["wave"]
    assert "absent" not in result.tables


def test_plain_names_stand_for_one_block_and_an_ambiguous_one_lists_its_choices() -> None:
    x = np.array([1.0, 2.0])

    def block(key: str, title: str, label: str = "K") -> Figure:
        series = (Series(label, {"x": x}, x),)
        return Figure(key, title, (Abscissa("x", "T"),), (Panel("coefficient"),), series)

    one = [block("hwl-coefficients", "Reflection and transmission"), block("hwl-regular-coefficients", "Transmission")]
    views = Views("figure", one, lambda found: found.key, ["HWL"])
    # without the level, before the end of a name; then words of title and curves
    assert views["coefficients"] == views["transmission"] == "hwl-coefficients"
    assert views["regular"] == views["coefficients_regular"] == "hwl-regular-coefficients"
    two = [*one, block("lwl-coefficients", "Reflection and transmission", "K_T Macagno")]
    views = Views("figure", two, lambda found: found.key, ["HWL", "LWL"])
    with pytest.raises(KeyError, match="2 figures answer to 'transmission'; there are: hwl-coefficients, lwl-coeff"):
        views["transmission"]
    assert views["macagno"] == "lwl-coefficients"
    # the level of the governing number, where the same stands at several
    views = Views("figure", two, lambda found: found.key, ["HWL", "LWL"], "LWL")
    assert views["transmission"] == "lwl-coefficients" and views["regular"] == "hwl-regular-coefficients"
    with pytest.raises(KeyError, match="no figure is called '_'"):
        views["_"]


@pytest.mark.slow
def test_every_figure_becomes_one_of_plotly_with_its_data(result: ReportedResult) -> None:
    blocks = [block for block in result.document.blocks() if isinstance(block, Figure)]
    assert len(result.figures) == len(blocks) > 5
    for name, block in zip(result.figures, blocks, strict=True):
        drawn = result.figures[name]
        drawn.to_json()
        assert [len(trace.y) for trace in drawn.data] == [len(item.y) for item in block.series]
        assert figure_columns(block)
        for number, panel in enumerate(block.panels):
            title = drawn.layout[f"yaxis{number + 1}" if number else "yaxis"].title.text
            assert ("[" in title) == (panel.unit not in ("", "1", "-"))


def test_marks_bars_and_logarithmic_axes_are_kept() -> None:
    x = np.array([1.0, 10.0, 100.0])
    drawn = plotly_figure(
        Figure(
            "f", "<i>K_T</i>", (Abscissa("x", "N", log=True),), (Panel("tension", "kN", limits=(0.0, 5.0)), Panel("b")),
            (Series("a", {"x": x}, x), Series("b", {"x": x}, x, panel=1, style="points")),
            marks=(Mark("top", x=10.0, y=2.0), Mark("line", y=3.0), Mark("<b>", x=100.0), Mark("?", x=np.nan)),
            window=(1.0, 100.0),
        )
    )  # fmt: skip
    assert drawn.layout.xaxis.type == "log"
    np.testing.assert_allclose(drawn.layout.xaxis.range, [0.0, 2.0])
    assert drawn.layout.yaxis.range == (0.0, 5.0)
    assert [note.x for note in drawn.layout.annotations] == [1.0, 1, 2.0]
    assert drawn.layout.annotations[2].text == "&lt;b&gt;"
    assert "<i>" not in drawn.layout.title.text
    bars = plotly_figure(
        Figure("g", "bars", (), (Panel("share"),), (Series("a", {}, x, style="bar"),), categories=("u", "v", "w"))
    )
    assert bars.data[0].type == "bar"
    assert bars.data[0].x == ("u", "v", "w")


def test_a_notebook_shows_badges_numbers_and_criteria(result: ReportedResult) -> None:
    shown = result._repr_html_()
    assert "Computation" in shown
    for headline in result.headlines:
        assert headline.shown is False or headline.label in re.sub("<sub>(.)</sub>", r"_\1", shown)
    assert "<script" not in shown
    assert "http" not in shown
    assert "plotly" not in shown


def test_what_a_case_says_is_escaped(result: ReportedResult) -> None:
    evil = "<script>alert(1)</script>"
    changed = replace(
        result,
        message=evil,
        headlines=(Headline("a", evil, 1.0, "m", where=evil),),
        provenance={**result.provenance, "title": evil},
    )
    assert "<script" not in changed._repr_html_()


def test_a_result_keeps_its_views_when_notices_are_added_and_when_it_is_stored(result: ReportedResult) -> None:
    noted = result.with_notices(Notice("a", "a notice"))
    assert isinstance(noted, ReportedResult)
    assert list(pickle.loads(pickle.dumps(noted)).tables) == list(result.tables)
    assert with_views(noted) is noted


def test_an_interrupted_result_without_data_shows_its_badges(result: ReportedResult) -> None:
    import xarray as xr

    broken = replace(
        result, status="interrupted", tree=xr.DataTree(xr.Dataset(attrs={"structure": "breakwater"})), headlines=(),
        verdict=Verdict(),
    )  # fmt: skip
    assert "Interrupted" in broken._repr_html_()


def test_criteria_stand_in_the_notebook(result: ReportedResult) -> None:
    from moyai.core.headline import Criterion

    item = Judgement(Criterion("largest_tension", "line_tension", 2e5, "at most", "case", unit="N"), 3e5, "holds")
    judged = replace(result, verdict=Verdict("holds", "the criterion holds", (item,)))
    assert "at most 200 kN" in judged._repr_html_()
    heavy = judged.shown_in("tf")._repr_html_()
    assert "at most 20.4 tf" in heavy
    assert "The case and results.nc are in SI" in heavy
