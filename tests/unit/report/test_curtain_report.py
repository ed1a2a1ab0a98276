"""The report of a curtain as files: whole, with the numbers of the result, sensible with whatever is absent."""

from __future__ import annotations

import csv
import io
import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyogrio
import pytest
import xarray as xr
from small_results import curtain, groups_of, with_groups, without
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.results import Result
from moyai.report.document import Animation, Document, Drawing, Figure, KeyFigures, Table
from moyai.report.encoding import figure_csv, table_csv
from moyai.report.html import render_html
from moyai.report.writer import compose_document, write_report
from moyai.structures.curtain.report.drawing import plan_drawing, section_drawing
from moyai.structures.curtain.report.figures import utilisation_bars
from moyai.structures.curtain.report.limits import colour, operating_map
from moyai.structures.curtain.report.page import compose
from moyai.structures.curtain.report.reading import components, governing_component, water_levels
from moyai.structures.curtain.report.snap import snap_animation


@pytest.fixture(scope="module")
def result() -> Result:
    return curtain()


@pytest.fixture(scope="module")
def document(result: Result) -> Document:
    return compose(result)


def named(document: Document, kind: type, title: str) -> list:
    return [block for block in document.blocks() if isinstance(block, kind) and block.title.startswith(title)]


def test_files_are_complete_and_offline(result: Result, tmp_path: Path) -> None:
    written = write_report(result, tmp_path)
    page = written[0].read_text(encoding="utf-8")
    assert not re.findall(r'(?:src|href)="(?!#|data:)[^"]*"', page)
    assert "curtain-snap" in page and "MOYAI.painters" in page
    names = {path.stem for path in written if path.suffix == ".csv"}
    assert {"governing-loads", "hwl-loads", "lwl-statics", "hwl-impact-models-table", "hwl-operating-limits"} <= names
    assert compose_document(result).title == "Curtain at the outfall"


@pytest.mark.slow
def test_pages_for_paper(result: Result, tmp_path: Path) -> None:
    written = write_report(result, tmp_path, pdf=True)
    assert written[1].read_bytes().startswith(b"%PDF") and written[1].stat().st_size > 100_000


def test_first_page_names_the_governing_component(result: Result, document: Document) -> None:
    worst = governing_component(water_levels(result))
    assert worst is not None
    level, entry = worst
    used = max(float(np.nanmax(result.tree[f"/{name}/loads"]["factored_utilisation"])) for name in ("HWL", "LWL"))
    assert entry.utilisation == pytest.approx(used)
    first = document.sections[0].blocks[0]
    assert isinstance(first, KeyFigures)
    assert first.items[0].label == result.headlines[0].label
    leading = next(one for one in result.headlines if one.name == "anchor_utilisation")
    assert leading.value == pytest.approx(entry.loads["governing"] / entry.capacity)
    assert f"{entry.name}," in leading.where and level.name in leading.where
    labels = [item.label for item in first.items]
    for wanted in ("Effective depth", "Clearance of the toe from the bed", "Largest tension of a cable"):
        assert wanted in labels


def test_first_page_shows_the_headlines_and_nothing_else(result: Result, document: Document) -> None:
    """Table, verdict and page show one number: the page computes none of its own."""
    keys = document.sections[0].blocks[0]
    assert isinstance(keys, KeyFigures)
    assert [item.label for item in keys.items] == [headline.label for headline in result.headlines]
    none = compose(replace(result, headlines=()))
    assert "no governing numbers" in render_html(none)


def test_load_table_is_the_result(result: Result, document: Document) -> None:
    table = named(document, Table, "Loads of each component")[0]
    rows = list(csv.DictReader(io.StringIO(table_csv(table))))
    loads = result.tree["/HWL/loads"]
    for row, name in zip(rows, loads["component"].values, strict=True):
        factor = {"kN": 1e3, "N": 1.0, "N/m": 1.0, "kN/m": 1e3}[row["Unit"]]
        for column, variable in (
            ("Steady", "steady_load"),
            ("Added by waves", "wave_load"),
            ("Added by the impact", "impact_load"),
            ("Governing", "governing_load"),
            ("Capacity", "capacity"),
        ):
            value = float(loads[variable].sel(component=name))
            shown = float(row[column]) * factor if row[column] else math.nan
            assert shown == pytest.approx(value, rel=1e-6, nan_ok=True), (name, column)
        assert row["Governed by"] == str(loads["governing"].sel(component=name).values)
    worst = int(np.nanargmax(loads["factored_utilisation"]))
    assert table.emphasised == (worst,)


def test_a_bound_stands_at_the_upper_ends_of_its_shares(result: Result) -> None:
    """Loads of an upright plate on a free toe are at most so large."""
    loads = result.tree["/HWL/loads"].to_dataset()
    bounded = [entry for entry in components(water_levels(result)[0]) if entry.bound == "at most"]
    assert {"upper cable", "anchor line", "anchor"} <= {entry.name for entry in bounded}
    for entry in bounded:
        row = loads.sel(component=entry.name)
        assert entry.loads["governing"] == pytest.approx(float(row["steady_high"] + row["impact_high"]), rel=1e-9)


def test_shares_add_up_to_the_utilisation(result: Result) -> None:
    """Of what is no bound: the larger of wave and impact comes to the steady load."""
    groups = groups_of(result)
    loads = groups["/HWL/loads"]
    added = loads["steady_load"] + np.fmax(loads["wave_load"], loads["impact_load"])
    known = xr.where(loads["governing"] == "steady", loads["steady_load"], added)
    groups["/HWL/loads"] = loads.assign(
        governing_load=known,
        load_bound=loads["load_bound"].where(False, ""),
        utilisation=known * loads["safety_factor"] / loads["capacity"],
    )
    level = water_levels(with_groups(result, groups))[0]
    for entry in components(level):
        parts = [entry.share("steady"), *(entry.share(part) for part in ("wave", "impact"))]
        if math.isfinite(entry.utilisation):
            added = np.nanmax([0.0, *[part for part in parts[1:] if math.isfinite(part)]])
            assert parts[0] + added == pytest.approx(entry.utilisation, rel=1e-9)
    bars = utilisation_bars(level)
    assert bars is not None and "joint" not in bars.categories  # no strength is given


def test_float_that_waves_do_not_judge_shows_its_steady_share_alone(result: Result) -> None:
    changed = result.tree["/HWL/loads"].to_dataset()
    changed["impact_load"].loc[{"component": "float"}] = 5e3
    tree = result.tree.copy()
    tree["/HWL/loads"] = xr.DataTree(changed)
    entry = next(e for e in components(water_levels(replace(result, tree=tree))[0]) if e.name == "float")
    assert math.isnan(entry.share("impact"))
    assert entry.share("steady") == pytest.approx(entry.utilisation)


def test_drawings_are_to_scale(result: Result) -> None:
    """The span in pixels over the sag in pixels is that of the result; the skirt ends at its toe."""
    level = water_levels(result)[0]
    plan_sketch, section_sketch = plan_drawing(level), section_drawing(level)
    assert plan_sketch is not None and section_sketch is not None
    svg = plan_sketch.svg()
    drawn = re.search(r'class="sheet" d="M([^"]*)"', svg)
    assert drawn is not None
    points = np.array([[float(v) for v in pair.split(",")] for pair in drawn[1].replace("L", "").split()])
    plan = result.tree["/HWL/plan"]
    x, y = (plan[name].sel(drag_case="given").values for name in ("plan_x", "plan_y"))
    assert np.ptp(points[:, 0]) / np.ptp(points[:, 1]) == pytest.approx(np.ptp(y) / np.ptp(x), rel=2e-3)
    assert points[0, 1] < points[len(points) // 2, 1], "downstream is drawn downwards"
    section = section_sketch.svg()
    high, depth, low = result.tree["/HWL/statics"]["effective_depth"].values
    assert f"effective depth {depth:.3g} m ({low:.3g} to {high:.3g} m)" in section and "under the toe" in section
    assert f"toe gap {9.2 - depth:.3g} m" in section
    skirt = re.search(r'class="sheet" d="M([^"]*)"', section)
    assert skirt is not None
    pixels = np.array([[float(v) for v in pair.split(",")] for pair in skirt[1].replace("L", "").split()])
    group = result.tree["/HWL/section"]
    x, z = (group[name].sel(drag_case="given").values for name in ("section_x", "section_z"))
    assert np.ptp(pixels[:, 0]) / np.ptp(pixels[:, 1]) == pytest.approx(np.ptp(x) / np.ptp(z), rel=3e-3)


@pytest.mark.slow
def test_drawings_go_to_drawing_programs_in_millimetres(result: Result, tmp_path: Path) -> None:
    """GDAL finds the sheet of the plan as long as the span, from a command that runs nothing again."""
    result.write(tmp_path / "results.nc")
    run = CliRunner().invoke(app, ["report", str(tmp_path / "results.nc"), "--dxf", "mm", "-q"])
    assert run.exit_code == 0, run.output
    (file,) = (tmp_path / "report_drawings").glob("hwl-plan*.dxf")
    _, _, _, (layer,) = pyogrio.raw.read(file, columns=["Layer"])
    _, bounds = pyogrio.read_bounds(file)
    x0, _, x1, _ = bounds[:, list(layer).index("SHEET")]
    y = result.tree["/HWL/plan"]["plan_y"].sel(drag_case="given").values
    assert x1 - x0 == pytest.approx(1000.0 * np.ptp(y), rel=1e-6)
    refused = CliRunner().invoke(app, ["report", str(tmp_path / "results.nc"), "--dxf", "inch", "-o", f"{tmp_path}/no"])
    assert refused.exit_code != 0 and not list((tmp_path / "no").glob("*.html"))


def test_long_anchor_lines_are_cut(result: Result) -> None:
    tree = result.tree.copy()
    plan = tree["/HWL/plan"].to_dataset()
    plan["anchor_x"] = plan["anchor_x"] * 0.0 - 200.0
    tree["/HWL/plan"] = xr.DataTree(plan)
    sketch = plan_drawing(water_levels(replace(result, tree=tree))[0])
    assert sketch is not None
    svg = sketch.svg()
    assert "to its anchor, 200 m from the float" in svg
    size = [float(value) for value in re.search(r'viewBox="0 0 (\S+) (\S+)"', svg).groups()]  # type: ignore[union-attr]
    assert size[1] < size[0]


def test_fixed_supports_have_no_anchor_drawing(result: Result) -> None:
    groups = groups_of(result)
    held = [f"{end}_{axis}" for end in ("float", "anchor") for axis in "xyz"]
    groups |= {path: plan.drop_vars(held) for path, plan in groups.items() if path.endswith("/plan")}
    document = compose(with_groups(result, groups))
    titles = [block.title for block in document.blocks() if isinstance(block, Drawing)]
    assert "Plan" in titles and "Section with an anchor line" not in titles


def test_map_shows_every_cell(result: Result) -> None:
    level = water_levels(result)[0]
    drawing = operating_map(level)
    assert drawing is not None
    limits = result.tree["/HWL/limits"]
    assert drawing.svg.count("<rect") == limits["limit_factored_utilisation"].size
    for value, name in zip(
        limits["limit_factored_utilisation"].values.ravel(), limits["limit_component"].values.ravel(), strict=True
    ):
        assert f"{name}</title>" in drawing.svg
        assert colour(float(value)) in drawing.svg
    shades = [colour(v) for v in np.linspace(0, 1, 9)], [colour(v) for v in np.linspace(1.001, 3, 9)]
    assert len(set(shades[0])) == 9 and len(set(shades[1])) == 9 and not set(shades[0]) & set(shades[1])
    red, blue = (int(shade[1:3], 16) - int(shade[5:7], 16) for shade in (colour(1.2), colour(0.9)))
    assert red > 0 > blue


def test_frames_of_the_snap_come_back(result: Result) -> None:
    """What the page unpacks is the shape of the result within a pixel, opened at the largest tension."""
    level = water_levels(result)[0]
    animation = snap_animation(level)
    assert isinstance(animation, Animation)
    scene = json.loads(json.dumps(animation.scene))
    snap = result.tree["/HWL/impact/snap"]
    at = int(np.argmax(snap["frame_tension"].values))
    assert scene["start"] == pytest.approx(float(snap["frame_time"][at]))
    assert scene["window"][0] < float(snap.attrs["taut_time"]) < scene["start"] < scene["window"][1]
    assert list(scene["extents"]) == ["Section and plan", "Section", "Plan"]
    box = scene["plan_box"]
    assert box[0] < 0.0 and box[1] > 20.0
    assert -box[2] > float(snap["frame_plan_x"].max())
    assert animation.still.startswith("<svg") and "Plan" not in animation.still[:5]


def test_section_stands_where_mid_span_is(result: Result) -> None:
    """Frames stored from the float are carried downstream with mid-span."""
    level = water_levels(result)[0]
    animation = snap_animation(level)
    assert animation is not None
    reach = float(np.ptp(result.tree["/HWL/impact/snap"]["frame_position"].values))
    box = animation.scene["section_box"]
    assert box[1] - box[0] > reach


def test_figures_hold_the_result(result: Result, document: Document) -> None:
    figure = named(document, Figure, "Exceedance of the snaps")[0]
    rows = list(csv.reader(io.StringIO(figure_csv(figure))))
    storm = result.tree["/HWL/waves/storm"]
    found = np.array([[float(cell) for cell in row[:2]] for row in rows[1:] if row[0] and row[1]])
    assert found[:, 1] * 1e3 == pytest.approx(storm["contact_tension_sorted"].values, rel=1e-6)
    models = named(document, Figure, "Tension of both cables by each impact model")[0]
    drawn = np.nansum(np.nan_to_num([item.y for item in models.series]), axis=0)
    assert drawn * 1e3 == pytest.approx(result.tree["/HWL/impact"]["both_cables_impact_tension"].values)
    assert len(models.series) == 2, "the model that does not count is distinguished"
    counted = result.tree["/HWL/impact"]["both_cables_impact_tension"].values[
        result.tree["/HWL/impact"]["counts"].values > 0
    ]
    note = named(document, Table, "Impact models")[0].note
    assert f"{counted.max() / counted.min():.2f} times the smallest" in note
    # regular waves and a storm at each water level
    assert len(named(document, Figure, "Record about the largest snap")) == 4


@pytest.mark.slow
@pytest.mark.parametrize(
    "absent",
    ["impact", "waves", "anchor_loads", "limits", "loads", "section", "plan", "statics", "statics_laws", "impact/snap"],
)
def test_any_part_may_be_absent(result: Result, absent: str) -> None:
    document = compose(without(result, f"/HWL/{absent}", f"/LWL/{absent}"))
    page = render_html(document)
    assert "NaN" not in page.split("report-data")[1].split("</script>")[0]
    assert document.sections[0].title == "Summary"


def test_nothing_but_the_case() -> None:
    empty = Result(xr.DataTree.from_dict({"/": xr.Dataset(attrs={"structure": "curtain", "title": "Empty"})}), "failed")
    document = compose(empty)
    assert "no governing numbers" in render_html(document)


def test_warnings_stand_below_the_numbers(result: Result) -> None:
    for notices in (result.notices, result.notices * 6):
        kinds = [type(block).__name__ for block in compose(replace(result, notices=notices)).sections[0].blocks]
        assert kinds.index("KeyFigures") < kinds.index("NoticeBlock")


def test_flume_record_is_shown(result: Result) -> None:
    time = np.linspace(0.0, 10.0, 400)
    spike = np.exp(-(((time - 4.0) / 0.1) ** 2)) * 8.0 + np.where(time > 4.0, 3.0, 0.0)
    tree = result.tree.copy()
    tree["/record"] = xr.DataTree(
        xr.Dataset(
            {
                "record_tension": (("cable", "time"), np.stack([spike, 1.1 * spike]), {"units": "N"}),
                "taut_time": ((), 3.8, {"units": "s"}),
                "peak_time": ((), 4.0, {"units": "s"}),
                "cable_peak_tension": ("cable", [9.5, 10.4], {"units": "N"}),
                "cable_plateau_tension": ("cable", [3.0, 3.3], {"units": "N"}),
                "cable_impact_tension": ("cable", [6.5, 7.1], {"units": "N"}),
                "both_cables_peak_tension": ((), 19.9, {"units": "N"}),
                "both_cables_plateau_tension": ((), 6.3, {"units": "N"}),
                "both_cables_impact_tension": ((), 13.6, {"units": "N"}),
                "cable_noise": ("cable", [0.01, 0.01], {"units": "N"}),
                **{name: ((), 0.2, {"units": "s"}) for name in ("release_time", "plateau_start", "rise_time")},
                "peak_missed": ((), 0.0),
            },
            {"cable": ["upper", "lower"], "time": ("time", time, {"units": "s"})},
        )
    )
    document = compose(replace(result, tree=tree))
    figure = named(document, Figure, "Record of the flume")[0]
    assert [item.label for item in figure.series] == ["upper", "lower", "sum"]
    table = named(document, Table, "Readings of the flume record")[0]
    assert list(table.columns[0].values) == ["upper", "lower", "sum"]
    assert list(table.columns[3].values) == [6.5, 7.1, 13.6]
    over = named(document, Figure, "Models over the flume record")[0]
    labels = [item.label for item in over.series]
    assert labels[:5] == [
        "record, both cables",
        "model A, marched",
        "model A2, sum",
        "with the memory of waves",
        "with drag",
    ]
    assert "peak of AB" in labels and "peak of B literal" not in labels
    found = over.series[0]
    expected = np.interp(found.x["time"] / 1e3 + 3.8, time, 2.1 * spike)
    assert found.y * (1e3 if over.panels[0].unit == "kN" else 1.0) == pytest.approx(expected, rel=1e-9)
