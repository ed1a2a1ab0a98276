"""The report of a survey: flags over time, directions by the compass, a survey of one block."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.results import Result
from moyai.records.survey.case.build import load_survey
from moyai.records.survey.report.compass import come_from, name_of
from moyai.records.survey.report.lanes import Span, flag_lanes
from moyai.records.survey.report.page import compose
from moyai.records.survey.run import run_survey
from moyai.report.document import Document, Drawing, Figure, KeyFigures, Table

Blocks = dict[tuple[str, str], Any]
BEARING = 30.0
HEADING = math.atan2(0.15, 0.3)  # of the velocities below, from +x


def survey(folder: Path, minutes: float) -> Result:
    """Return a survey of waves that travel along HEADING, with a hole and a flat stretch."""
    random = np.random.default_rng(1)
    time = np.arange(0.0, 60.0 * minutes, 0.5)
    level = 0.6 * np.sin(2.0 * np.pi * time / 6.3) + 0.02 * random.normal(size=time.size)
    rows = ["time,level,u,v"]
    for number, (now, value) in enumerate(zip(time, level, strict=True)):
        shown = "" if 600 <= number < 700 else ("0.1234" if 800 <= number < 900 else f"{value:.4f}")
        rows.append(f"{now:.1f},{shown},{0.1 + 0.3 * value:.4f},{0.05 + 0.15 * value:.4f}")
    (folder / "a.csv").write_text("\n".join(rows))
    (folder / "r.yaml").write_text(f"""
moyai: 1
title: survey
site: {{water_depth: 10, density: 1025, gravity: 9.81, x_axis_bearing_deg: {BEARING}}}
loggers:
  - name: tower
    file: a.csv
    time: {{column: time}}
    channels:
      - {{name: elevation, column: level, unit: m, kind: elevation}}
      - {{name: u, column: u, unit: m/s, kind: velocity_x, z: -4 m}}
      - {{name: v, column: v, unit: m/s, kind: velocity_y, z: -4 m}}
blocks: {{length: 5 min}}
quality: {{flat: 10 s}}
waves: {{channels: [elevation]}}
spectrum: {{segment: 60 s, lowest: 0.04 Hz, highest: 0.5 Hz}}
directions: {{channels: [elevation, u, v], estimator: moments}}
current: {{velocity: [u, v]}}
""")
    return run_survey(load_survey(folder / "r.yaml"))


def blocks_of(document: Document) -> Blocks:
    """Return figures, drawings and tables by kind and key."""
    found = [block for section in document.sections for block in section.blocks]
    return {(type(block).__name__, block.key): block for block in found if isinstance(block, Drawing | Figure | Table)}


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Blocks:
    return blocks_of(compose(survey(tmp_path_factory.mktemp("survey"), 15.0)))


@pytest.fixture(scope="module")
def alone(tmp_path_factory: pytest.TempPathFactory) -> Blocks:
    return blocks_of(compose(survey(tmp_path_factory.mktemp("alone"), 5.0)))


def test_bearings_are_the_way_back_clockwise_from_north() -> None:
    """Waves that travel to the east come from the west; +x to the bearing 30 with a heading of 30 goes due north."""
    assert come_from(0.0, 90.0) == pytest.approx(270.0)
    assert come_from(math.radians(30.0), 30.0) == pytest.approx(180.0)
    assert come_from(math.radians(-60.0), 30.0) == pytest.approx(270.0)
    names = [name_of(value) for value in (0.0, 45.0, 90.0, 202.5, 359.0, math.nan)]
    assert names == ["N", "NE", "E", "SSW", "N", ""]


def test_the_table_of_directions_has_bearings(page: Blocks) -> None:
    table = page["Table", "directions"]
    want = (BEARING - math.degrees(HEADING) + 180.0) % 360.0
    columns = {column.label: column.values for column in table.columns}
    assert np.asarray(columns["mean from, bearing"], float)[0] == pytest.approx(want, abs=1.0)
    assert columns["mean from"][0] == name_of(want)
    columns = {column.label: column.values for column in page["Table", "current"].columns}
    assert np.asarray(columns["current towards, bearing"], float)[0] == pytest.approx((want + 180.0) % 360.0, abs=1.0)


def test_every_channel_has_a_lane_and_every_flag_its_span(page: Blocks) -> None:
    drawing = page["Drawing", "flags"]
    for name in ("elevation", "u", "v"):
        assert f">{name}</text>" in drawing.svg
    titles = re.findall(r"<title>(.*?)</title>", drawing.svg)
    assert any(title.startswith("elevation: missing") for title in titles)
    assert any(title.startswith("elevation: flat") for title in titles)


def test_a_span_lies_where_its_time_is() -> None:
    drawing = flag_lanes(("a", "bb"), [Span("bb", "spike", 25.0, 50.0)], 0.0, 100.0, str)
    lanes = re.findall(r'<rect x="([\d.]+)" y="([\d.]+)" width="([\d.]+)"', drawing.svg)
    (left, _, wide), (_, second, _), (x, y, width) = [tuple(map(float, lane)) for lane in lanes[:3]]
    assert y == second
    assert (x - left) / wide == pytest.approx(0.25, abs=1e-3) and width / wide == pytest.approx(0.25, abs=1e-3)


def test_one_block_is_points_in_the_middle_of_its_time(alone: Blocks) -> None:
    figure = alone["Figure", "waves"]
    assert figure.window == (0.0, 300.0)
    assert {series.style for series in figure.series} == {"points"}
    assert all(list(series.x["time"]) == [150.0] for series in figure.series)
    assert len(alone["Figure", "spectra"].series) == 1


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_gauges_of_unlike_rates_on_one_page(tmp_path: Path) -> None:
    fast = np.arange(0.0, 600.0, 0.5)
    slow = np.arange(0.0, 300.0, 1.0 / 3.0)
    for name, time in (("fast", fast), ("slow", slow)):
        wave = np.sin(2.0 * np.pi * time / 8.0)
        rows = [f"{now:.4f},{value:.5f},{2000.0 + 900.0 * value:.3f}" for now, value in zip(time, wave, strict=True)]
        (tmp_path / f"{name}.csv").write_text("\n".join(["time,level,rope", *rows]))
    (tmp_path / "r.yaml").write_text("""
moyai: 1
title: two rates
site: {water_depth: 10, density: 1025, gravity: 9.81}
loggers:
  - {name: a, file: fast.csv, time: {column: time}, channels: [
      {name: fast, column: level, unit: m, kind: elevation}, {name: rope, column: rope, unit: N, kind: tension}]}
  - {name: b, file: slow.csv, time: {column: time}, channels: [{name: slow, column: level, unit: m, kind: elevation}]}
blocks: {length: 5 min}
waves: {channels: [fast, slow]}
spectrum: {segment: 60 s, lowest: 0.04 Hz, highest: 0.5 Hz}
tensions: {waves: fast, lines: [{channel: rope, group: new}]}
""")
    document = compose(run_survey(load_survey(tmp_path / "r.yaml")))
    assert len([block for section in document.sections for block in section.blocks if isinstance(block, Figure)]) > 2


def test_the_largest_tension_is_the_whole_of_the_line(tmp_path: Path) -> None:
    """A line at 20 kN that the waves pull 6 kN more: the page says 26 kN, its parts, and of how many waves."""
    time = np.arange(0.0, 900.0, 0.1)
    level = 0.6 * np.sin(2.0 * np.pi * time / 6.0)
    rows = ["time,level,F", *(f"{t:.1f},{z:.4f},{20.0 + 10.0 * z:.4f}" for t, z in zip(time, level, strict=True))]
    (tmp_path / "a.csv").write_text("\n".join(rows))
    (tmp_path / "r.yaml").write_text("""
moyai: 1
title: tensions
site: {water_depth: 10, density: 1025, gravity: 9.81}
loggers:
  - name: line
    file: a.csv
    time: {column: time}
    channels:
      - {name: elevation, column: level, unit: m, kind: elevation}
      - {name: F, column: F, unit: kN, kind: tension}
blocks: {length: 5 min}
waves: {channels: [elevation]}
tensions: {waves: elevation, steady: median, snap_limit: 40 kN, lines: [{channel: F, group: one}]}
""")
    document = compose(run_survey(load_survey(tmp_path / "r.yaml")))
    shown = next(block for section in document.sections for block in section.blocks if isinstance(block, KeyFigures))
    figures = {item.label: item for item in shown.items}
    assert figures["largest tension"].text.startswith("26.0")
    assert re.search(r"6\.0\d* kN above the steady (20\.0|-?19\.9\d*) kN", figures["largest tension"].detail)
    count = int(re.search(r"largest of (\d+) waves", figures["largest tension"].detail).group(1))  # type: ignore[union-attr]
    assert 120 <= count <= 150
    assert "median of 3 blocks 1.20 m" in figures["largest H1/3"].detail
    assert re.search(r"of 1[2345]\d waves", figures["highest wave"].detail)


def test_the_page_says_how_much_of_the_time_lies_in_no_wave_that_counts(tmp_path: Path) -> None:
    """One sample of 400 is missing, one in nine waves: few samples, a ninth of the waves; figures stand in the JSON."""
    time = np.arange(0.0, 900.0, 0.125)
    level = 0.6 * np.sin(2.0 * np.pi * time / 6.0)
    texts = [f"{value:.4f}" for value in level]
    for place in range(200, len(texts), 432):  # every ninth wave of 48 samples
        texts[place] = "-9999"
    (tmp_path / "a.csv").write_text("\n".join(["time,level", *(f"{t:.3f},{z}" for t, z in zip(time, texts))]))
    (tmp_path / "r.yaml").write_text("""
moyai: 1
title: gaps
site: {water_depth: 10, density: 1025, gravity: 9.81}
loggers:
  - name: line
    file: a.csv
    time: {column: time}
    channels: [{name: elevation, column: level, unit: m, kind: elevation, missing: [-9999]}]
blocks: {length: 5 min}
waves: {channels: [elevation]}
""")
    runner = CliRunner()
    done = runner.invoke(app, ["measure", "records", str(tmp_path / "r.yaml"), "-o", str(tmp_path / "out"), "--json"])
    figures = {item["label"]: item for item in json.loads(done.stdout)["key_figures"]}
    assert figures["sound samples"]["text"] == "99.8 %"
    share = float(re.search(r"([\d.]+) % of the time is in no wave", figures["highest wave"]["detail"])[1])
    # a ninth, and the waves cut by the ends of three blocks of fifty waves
    assert 11.1 <= share <= 11.1 + 100.0 * 2.0 / 50.0


@pytest.mark.parametrize("noise", [0.0, 0.002])
def test_calm_blocks_do_not_enter_the_reflection_of_the_page(tmp_path: Path, noise: float) -> None:
    """Planted 0.3 in the first and last of three blocks; still water, or the noise of the gauges, between them."""
    time = np.arange(0.0, 1800.0, 0.25)
    number, random = 0.1, np.random.default_rng(0)
    omega = math.sqrt(9.81 * number * math.tanh(number * 20.0))
    columns = [time]
    for x in (0.0, 8.0, 18.0):
        level = np.cos(number * x - omega * time) + 0.3 * np.cos(-number * x - omega * time + 0.4)
        level[(time >= 600.0) & (time < 1200.0)] = 0.0
        columns.append(level + noise * random.standard_normal(time.size))
    np.savetxt(
        tmp_path / "g.csv", np.column_stack(columns), delimiter=",", header="time,a,b,c", comments="", fmt="%.4f"
    )
    (tmp_path / "r.yaml").write_text("""
moyai: 1
title: reflection
site: {water_depth: 20, density: 1025, gravity: 9.81, x_axis_bearing_deg: 270}
loggers:
  - name: g
    file: g.csv
    time: {column: time}
    channels:
      - {name: a, column: a, unit: m, kind: elevation}
      - {name: b, column: b, unit: m, kind: elevation}
      - {name: c, column: c, unit: m, kind: elevation}
blocks: {length: 10 min}
reflection: {front: [{channel: a, x: 0}, {channel: b, x: 8}, {channel: c, x: 18}]}
spectrum: {segment: 100 s, lowest: 0.04 Hz, highest: 0.5 Hz}
waves: {channels: [a]}
""")
    result = run_survey(load_survey(tmp_path / "r.yaml"))
    shown = next(
        block for section in compose(result).sections for block in section.blocks if isinstance(block, KeyFigures)
    )
    (figure,) = [item for item in shown.items if item.label == "reflection"]
    assert float(figure.text) == pytest.approx(0.3, abs=0.005)
    if noise == 0.0:
        assert math.isnan(result.tree["reflection"]["reflection_coefficient"].values[1])
        assert figure.detail == "of the energy of 2 blocks"
