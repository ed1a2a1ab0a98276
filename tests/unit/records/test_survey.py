"""Whole surveys: the chain of single functions gives the same, errors have their place, campaigns come back."""

import importlib.util
import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest

from moyai.core.errors import CaseError, InputError
from moyai.core.results import read_result
from moyai.records.comparison.run import Pairing, compare_result
from moyai.records.survey.campaign import CampaignLaws, Storm, generate, write_campaign
from moyai.records.survey.case.build import load_survey
from moyai.records.survey.run import run_survey
from moyai.report.writer import write_report
from moyai.series.spectra import WelchOptions, spectrum_of
from moyai.series.zero_crossing import WaveOptions, find_waves

EXAMPLES = Path(__file__).resolve().parents[3] / "examples" / "records"

SURVEY = """
moyai: 1
title: Two loggers
site: {water_depth: 12 m, density: 1025, gravity: 9.81, x_axis_bearing_deg: 270}
structure_normal_deg: 0
loggers:
  - name: tower
    file: 波.csv
    time: {column: 時刻, format: "%Y/%m/%d %H:%M:%S.%f", utc_offset: 9 h}
    channels:
      - {name: level, column: 水位, kind: elevation}
      - {name: u, column: 東, kind: velocity_x, z: -4 m}
      - {name: v, column: 北, kind: velocity_y, z: -4 m}
  - name: anchor
    file: tension.parquet
    clock: {offset: 12 s}
    time: {column: t, unit: s, start: "1999-09-23T00:00:00"}
    channels:
      - {name: J-1, column: J1, unit: kN, kind: tension}
blocks: {length: 10 min}
waves: {channels: [level], detrend: mean, crest: sample}
spectrum: {segment: 100 s, lowest: 0.05 Hz, highest: 0.5 Hz}
directions: {channels: [level, u, v]}
current: {velocity: [u, v]}
tensions: {waves: level, lines: [{channel: J-1, group: new}], snap_limit: 3 kN}
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """An hour of a sea from 0.5 rad, in two files on two clocks, with a gap and a spike."""
    import datetime as dt

    import pyarrow as pa
    import pyarrow.parquet as pq

    path = tmp_path_factory.mktemp("survey")
    laws = CampaignLaws(
        storms=(Storm("s", 938_044_800.0, 3600.0 / 86400.0, 2.0, 0.02, 1.5, 1.0, 0.5, 0.5),), block=600.0
    )
    parts = list(generate(laws, laws.storms[0], seed=3))
    time = np.concatenate([part.time for part in parts])
    values = np.concatenate([part.values for part in parts])
    values[12_345, 0] = 25.0
    kept = np.ones(time.size, bool)
    kept[20_000:20_100] = False
    tokyo = dt.timezone(dt.timedelta(hours=9))
    rows = ["時刻,水位（cm）,東[m/s],北[m/s]"]
    for t, row in zip(time[kept], values[kept]):
        stamp = dt.datetime.fromtimestamp(t, tokyo)
        rows.append(f"{stamp:%Y/%m/%d %H:%M:%S.%f},{100 * row[0]:.2f},{row[1]:.4f},{row[2]:.4f}")
    (path / "波.csv").write_text("\n".join(rows), encoding="cp932")
    table = pa.table({"t": time - 938_044_800.0 - 12.0, "J1": values[:, 4] / 1000.0})
    pq.write_table(table, path / "tension.parquet")
    (path / "survey.yaml").write_text(SURVEY, encoding="utf-8")
    return path, time, values, kept


def test_the_chain_is_its_links(folder):
    path, time, values, _ = folder
    survey = load_survey(path / "survey.yaml")
    result = run_survey(survey, rows=7000)
    waves, start = result.tree["waves"], result.tree["blocks"]["time"].values
    assert len(start) == 6 and start[0] == 938_044_800.0
    for place in (0, 4):  # blocks without planted faults
        part = slice(place * 6000, (place + 1) * 6000)
        level = np.round(100 * values[part, 0], 2) / 100.0
        own = find_waves(time[part], level, WaveOptions(crest="sample")).statistics()
        for key in ("third_height", "maximum_height", "mean_period", "count"):
            assert waves[key].values[place, 0] == pytest.approx(own[key], rel=1e-9)
        spectrum = spectrum_of(0.1, level, WelchOptions(segment=100.0)).figures(0.05, 0.5)
        assert waves["spectral_height"].values[place, 0] == pytest.approx(spectrum["spectral_height"], rel=1e-6)
    heading = result.tree["directions"]["mean_heading"].values
    assert heading == pytest.approx(0.5, abs=math.radians(4.0))
    current = result.tree["current"]["current_normal"].values
    assert current == pytest.approx([values[i * 6000 : (i + 1) * 6000, 1].mean() for i in range(6)], abs=3e-3)
    tension = result.tree["tensions"]
    assert tension["steady"].values[0, 0] == pytest.approx(np.median(values[:6000, 4]), rel=1e-6)
    assert np.all(tension["maximum"].values >= tension["tenth"].values)
    assert np.all(tension["waves"].values[:, 0] >= 0.9 * waves["count"].values[:, 0])
    kinds = dict(zip(result.tree["quality"]["kind"].values, result.tree["quality"]["start"].values))
    assert kinds["spike"] == pytest.approx(time[12_345], abs=1e-3)
    assert kinds["gap"] == pytest.approx(time[20_000], abs=1e-3)
    assert {"record-gaps", "record-quality"} <= {notice.code for notice in result.notices}
    again = run_survey(survey, rows=100_000)
    np.testing.assert_array_equal(again.tree["waves"]["third_height"].values, waves["third_height"].values)


def test_results_reports_and_comparison(folder):
    path, *_ = folder
    result = run_survey(load_survey(path / "survey.yaml"))
    stored = read_result(result.write(path / "out" / "results.nc"))
    files = write_report(stored, path / "out")
    names = {file.name for file in files}
    assert {"report.html", "waves-1.csv", "tensions-1.csv", "current.csv", "directions.csv", "quality.csv"} <= names
    table = (path / "out" / "report_tables" / "waves-1.csv").read_text(encoding="utf-8-sig").splitlines()
    assert table[0].startswith('"start of block, UTC",waves,Hmax [m]') and len(table) == 7
    third = stored.tree["waves"]["third_height"].values[:, 0]
    rows = ["start [s],third_height [cm],H13"]
    rows += [f"{t:.1f},{100 * h * 1.1:.6f},{h:.6f}" for t, h in zip(stored.tree["blocks"]["time"].values, third)]
    (path / "hand.csv").write_text("\n".join(rows))
    found = compare_result(stored, path / "hand.csv", state="H13", edges=(0.0, float(np.median(third)), 9.0))
    group = found.tree[next(iter(found.tree.children))]
    figures = dict(zip(group["figure"].values, group["agreement"].values))
    assert figures["slope through the origin, model over record"] == pytest.approx(1.0 / 1.1, rel=1e-6)
    assert figures["mean of (model - record)/model (Tabata et al.)"] == pytest.approx(-0.1, rel=1e-6)
    assert group["by_state"].shape[0] == 2 and group["state_count"].values.sum() == 6
    again = read_result(found.write(path / "out" / "comparison.nc"))
    assert "report.html" in {file.name for file in write_report(again, path / "compared")}
    with pytest.raises(InputError, match="did you mean"):
        compare_result(stored, path / "hand.csv", [Pairing("third_heigth", "H13")])
    with pytest.raises(InputError, match="no column 'H14'"):
        compare_result(stored, path / "hand.csv", [Pairing("third_height", "H14")])
    (path / "tons.csv").write_text("start [s],third_height [kN]\n0,1\n1,2\n")
    with pytest.raises(InputError, match="is in N and the variable in m"):
        compare_result(stored, path / "tons.csv")
    (path / "other.csv").write_text("start [s],something [m]\n0,1\n1,2\n")
    with pytest.raises(InputError, match="name pairs"):
        compare_result(stored, path / "other.csv")


FAULTS = {
    "unknown channel": ("channels: [level], detrend", "channels: [levle], detrend", "there is no channel 'levle'"),
    "wrong kind": ("waves: level, lines", "waves: J-1, lines", "'J-1' is of kind 'tension'"),
    "unknown key": ("crest: sample", "crests: sample", "crests"),
    "wrong unit": (
        "unit: kN, kind: tension",
        "unit: cm, kind: tension",
        "of kind 'tension': 'cm' is no unit of a force",
    ),
    "no such unit": ("unit: kN, kind: tension", "unit: kNm/, kind: tension", "unit"),
    "no file": ("file: tension.parquet", "file: tensoin.parquet", "no such file"),
    "empty band": ("lowest: 0.05 Hz", "lowest: 0.7 Hz", "the band is empty"),
    "bad date": ('start: "1999-09-23T00:00:00"', 'start: "1999-13-23"', "is no date"),
    "negative block": ("length: 10 min", "length: -10 min", "out of range"),
    "needs site": (
        "site: {water_depth: 12 m, density: 1025, gravity: 9.81, x_axis_bearing_deg: 270}\n",
        "",
        "needs 'site'",
    ),
    "twice": ("name: v,", "name: u,", "given twice"),
    "no cutoff": ("detrend: mean", "detrend: high_pass", "needs 'cutoff'"),
}


@pytest.mark.parametrize("case", FAULTS)
def test_faults_of_the_file_have_their_line(folder, case):
    path, *_ = folder
    old, new, message = FAULTS[case]
    assert old in SURVEY
    (path / "faulty.yaml").write_text(SURVEY.replace(old, new), encoding="utf-8")
    with pytest.raises(CaseError) as caught:
        load_survey(path / "faulty.yaml")
    assert message in str(caught.value)
    fault = caught.value.faults[0]
    assert fault.file.endswith("faulty.yaml") and fault.line > 0


def test_commands(folder, capsys):
    from typer.testing import CliRunner

    from moyai.cli.main import app

    path, *_ = folder
    runner = CliRunner()
    done = runner.invoke(app, ["measure", "records", str(path / "survey.yaml"), "-o", str(path / "out"), "--json"])
    record = json.loads(done.stdout)
    assert done.exit_code == 0 and record["status"] == "converged" and record["faults"] == []
    (path / "hand.csv").write_text("start [s],third_height [m]\n938044800,1.5\n938046600,1.7\n")
    done = runner.invoke(
        app, ["compare", str(path / "out" / "results.nc"), str(path / "hand.csv"), "-o", str(path / "cmp"), "--json"]
    )
    assert done.exit_code == 0
    assert json.loads(done.stdout)["pairs"][0]["agreement"]["pairs"] == 2.0
    (path / "wrong.yaml").write_text(SURVEY.replace("column: 水位", "column: 水"), encoding="utf-8")
    done = runner.invoke(app, ["measure", "records", str(path / "wrong.yaml"), "-o", str(path / "o"), "--json"])
    assert done.exit_code == 2
    assert "has no column '水'" in json.loads(done.stdout)["faults"][0]["message"]


def example(name):
    """Import an example by its file."""
    sys.path.insert(0, str(EXAMPLES))
    try:
        spec = importlib.util.spec_from_file_location(f"example_{name}", EXAMPLES / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module
    finally:
        sys.path.remove(str(EXAMPLES))


@pytest.mark.slow
def test_a_short_campaign_gives_its_ratios_back(tmp_path):
    """One block in forty at 5 Hz: what needs no long record."""
    module = example("campaign")
    laws = CampaignLaws(rate=5.0)
    data, pairs, _, _ = module.process(tmp_path, every=40, seed=8, laws=laws, report=False)
    rows, _ = module.statements(data, pairs, laws)
    found = {name: value for name, value, _, _ in rows}
    assert found["5  new over conventional type"] == pytest.approx(0.7, abs=0.03)
    assert found["7  wire over rope"] == pytest.approx(0.6, abs=0.03)
    assert found["3  exponent of the cosine"] == pytest.approx(2.0, abs=0.4)
    assert found["6  M m_B [kg]"] == pytest.approx(laws.mass_product, rel=0.2)


@pytest.mark.slow
def test_a_campaign_gives_its_planted_constants_back(tmp_path):
    """One block in twelve of the three campaigns: every statement of the field paper, within stated tolerances."""
    module = example("campaign")
    data, pairs, results, laws = module.process(tmp_path, every=12, seed=5, report=False)
    assert len(results) == 3
    rows, fitted = module.statements(data, pairs, laws)
    found = {name: value for name, value, _, _ in rows}
    assert found["1  T1/10 over cos^2 linear in H1/3: R^2"] > 0.9
    assert abs(found["2  steady tension with U_x: r"]) < 0.3
    assert found["3  exponent of the cosine"] == pytest.approx(2.0, abs=0.2)
    assert found["5  new over conventional type"] == pytest.approx(0.7, abs=0.02)
    assert found["6  M m_B [kg]"] == pytest.approx(laws.mass_product, rel=0.06)
    assert found["7  wire over rope"] == pytest.approx(0.6, abs=0.02)
    assert found["8  Hmax over H1/3"] == pytest.approx(1.7, abs=0.2)
    assert found["8  Tmax over T1/10"] == pytest.approx(1.7, abs=0.25)
    assert found["9  wave tension on a slack rope"] == pytest.approx(laws.slack_ratio, abs=0.04)
    near, far = found["10 0 to 20 deg off the common line, share"], found["10 40 to 60 deg off the common line, share"]
    assert near > 0.2 > 0.0 > far
    assert found["11 share of blocks with the higher steady tension"] > 0.97
    assert len(fitted.left_out) == 3 and not any(notice.code == "identifiability" for notice in fitted.notices)
    peaks = [float(np.nanmax(result.tree["waves"]["third_height"].values)) for result in results]
    assert peaks == pytest.approx([3.06, 1.11, 2.32], rel=0.08)


@pytest.mark.slow
def test_unit_slip_and_drift_in_a_survey(tmp_path):
    """Two hours in the wrong unit and a gauge whose zero wanders: both are reported, neither is mended."""
    storm = Storm("slip", 938_044_800.0, 0.6, 1.5, 0.3, 1.2, 1.0, 0.3, 0.3)
    laws = CampaignLaws(storms=(storm,), rate=1.0)
    path = write_campaign(laws, storm, tmp_path, seed=2)
    import h5py

    with h5py.File(tmp_path / "slip.nc", "r+") as file:
        level, time = file["elevation"][:], file["time"][:]
        level += 0.9 * (time - time[0]) / (time[-1] - time[0])
        level[18_000:25_200] *= 100.0
        file["elevation"][:] = level
    text = path.read_text().replace("kind: elevation}", "kind: elevation, quality: {drift_share: 0.5}}")
    path.write_text(text)
    result = run_survey(load_survey(path))
    reported = {notice.code: notice for notice in result.notices}
    assert "elevation" in reported["unit-slip"].message and "100" in reported["unit-slip"].message
    assert "elevation" in reported["drift"].message
    np.testing.assert_allclose(result.tree["blocks"]["channel_0_deviation"].values[15:21].mean(), 35.0, rtol=0.5)


def test_the_template_is_a_sound_file(tmp_path):
    """``moyai new records`` with files next to it that have its headings runs as it is."""
    import datetime as dt

    from moyai.case.templates import template

    random = np.random.default_rng(1)
    text = template("records")
    (tmp_path / "records.yaml").write_text(text, encoding="utf-8")
    with pytest.raises(CaseError, match=r"no such file.*waves\.csv"):
        load_survey(tmp_path / "records.yaml")
    start = dt.datetime(1999, 9, 23, 9)
    waves, tensions = ["time,水位,u,v"], ["time,J-1,F-1"]
    for i in range(4800):
        level = 80.0 * math.sin(2.0 * math.pi * i / 14.3) + 30.0 * random.normal()
        stamp = start + dt.timedelta(seconds=0.5 * i)
        waves.append(f"{stamp.isoformat()},{level:.2f},{10 + 0.3 * level:.2f},{0.1 * level:.2f}")
    for i in range(24_000):
        stamp = start + dt.timedelta(seconds=i // 10)
        tensions.append(f"{stamp.isoformat()},{5 + random.random():.4f},{0.5 + 0.1 * random.random():.4f}")
    (tmp_path / "waves.csv").write_text("\n".join(waves), encoding="cp932")
    (tmp_path / "tensions.csv").write_text("\n".join(tensions))
    result = run_survey(load_survey(tmp_path / "records.yaml"))
    assert result.tree["waves"]["third_period"].values[:, 0] == pytest.approx(7.15, rel=0.1)
    assert result.tree["current"]["current_normal"].values == pytest.approx(0.1, abs=0.02)
    assert result.tree["tensions"]["steady"].values[0] == pytest.approx([0.55 * 9806.65, 5.5e3], rel=0.02)
    assert {notice.code for notice in result.notices}.isdisjoint({"record-gaps", "time-order"})


def test_responses_and_reflection_through_a_survey(tmp_path):
    """An irregular test in a flume: a planted filter and a planted reflection, out of one file."""
    from moyai.sea.irregular import synthesise
    from moyai.sea.spectra import jonswap
    from moyai.sea.water import Water

    water = Water(depth=0.8, density=1000.0, gravity=9.81)
    sea = synthesise(jonswap(0.08, 1.6, 3.3), water, duration=600.0, seed=11, time_step=0.05)
    time = np.arange(12_000) * 0.05
    k, places = sea.wave_number, (0.0, 0.3, 0.75)
    gauges = sea.respond(np.array([np.exp(1j * k * x) + 0.4 * np.exp(1j * k * (4.0 - x)) for x in places]), time)
    behind = sea.respond(0.5 * np.exp(1j * k * 6.0), time)
    transfer = 1.5 / (1.0 - (sea.omega / 5.0) ** 2 - 0.4j * sea.omega / 5.0)
    sway = sea.respond(transfer * 0.5 * np.exp(1j * k * 6.0), time)
    table = np.column_stack([time, gauges, behind, sway])
    np.savetxt(tmp_path / "f.csv", table, delimiter=";", header="t;a;b;c;d;sway", comments="", fmt="%.7f")
    channels = "\n".join(f"      - {{name: {n}, column: {n}, unit: m, kind: elevation}}" for n in "abcd")
    (tmp_path / "f.yaml").write_text(
        f"""moyai: 1
loggers:
  - name: flume
    file: f.csv
    time: {{column: t}}
    channels:
{channels}
      - {{name: sway, column: sway, unit: m, kind: motion}}
site: {{water_depth: 0.8, density: 1000, gravity: 9.81}}
blocks: {{length: 601 s}}
spectrum: {{segment: 51.2 s, lowest: 0.4 Hz, highest: 1.1 Hz}}
reflection:
  front: [{{channel: a, x: 0}}, {{channel: b, x: 0.3}}, {{channel: c, x: 0.75}}]
  behind: [{{channel: d, x: 6}}]
responses: {{wave: d, channels: [sway]}}
"""
    )
    result = run_survey(load_survey(tmp_path / "f.yaml"))
    found = result.tree["reflection"]
    assert found["reflection_coefficient"].values[0] == pytest.approx(0.4, abs=0.02)
    assert found["transmission_coefficient"].values[0] == pytest.approx(0.5, abs=0.03)
    response = result.tree["responses"]
    frequency, modulus = response["frequency"].values, response["modulus"].values[0, 0]
    use = np.isfinite(modulus) & (frequency > 0.5) & (frequency < 0.75)
    omega = 2.0 * math.pi * frequency[use]
    expected = np.abs(1.5 / (1.0 - (omega / 5.0) ** 2 - 0.4j * omega / 5.0))
    np.testing.assert_allclose(modulus[use], expected, rtol=0.06)
    assert use.sum() > 8
    assert "responses.csv" in {file.name for file in write_report(result, tmp_path / "out")}


def test_a_calm_block_costs_only_its_own_reflection(tmp_path):
    """Waves, then noise alone, then a dead calm: the first block keeps its coefficients, the others say why not."""
    from moyai.sea.irregular import synthesise
    from moyai.sea.spectra import jonswap
    from moyai.sea.water import Water

    water = Water(depth=0.8, density=1000.0, gravity=9.81)
    sea = synthesise(jonswap(0.08, 1.6, 3.3), water, duration=200.0, seed=4, time_step=0.05)
    time = np.arange(12_000) * 0.05
    k, places = sea.wave_number, (0.0, 0.3, 0.75, 6.0, 6.3, 6.75)
    strength = [1.0, 1.0, 1.0, 0.5, 0.5, 0.5]
    waves = sea.respond(np.array([a * np.exp(1j * k * x) for a, x in zip(strength, places)]), time)
    values = np.where((time < 200.0)[:, None], waves, 0.0)
    noisy = (time >= 200.0) & (time < 400.0)
    values[noisy] = np.random.default_rng(3).normal(0.0, 1e-3, (int(noisy.sum()), 6))
    np.savetxt(tmp_path / "f.csv", np.column_stack([time, values]), delimiter=",", header="t,a,b,c,d,e,f", comments="")
    channels = "\n".join(
        f"      - {{name: {n}, column: {n}, unit: m, kind: elevation, quality: {{flat: never, clip_samples: 0}}}}"
        for n in "abcdef"
    )
    (tmp_path / "f.yaml").write_text(
        f"""moyai: 1
loggers:
  - name: flume
    file: f.csv
    time: {{column: t}}
    channels:
{channels}
site: {{water_depth: 0.8, density: 1000, gravity: 9.81}}
blocks: {{length: 200 s}}
spectrum: {{segment: 51.2 s, lowest: 0.4 Hz, highest: 1.1 Hz}}
reflection:
  front: [{{channel: a, x: 0}}, {{channel: b, x: 0.3}}, {{channel: c, x: 0.75}}]
  behind: [{{channel: d, x: 6}}, {{channel: e, x: 6.3}}, {{channel: f, x: 6.75}}]
"""
    )
    result = run_survey(load_survey(tmp_path / "f.yaml"))
    found = result.tree["reflection"]
    assert found["transmission_coefficient"].values[0] == pytest.approx(0.5, abs=0.02)
    assert np.isnan(found["transmission_coefficient"].values[2])
    assert np.isnan(found["reflection_coefficient"].values[2])
    codes = {notice.code for notice in result.notices}
    assert {"reflection-noise", "transmission-skipped"} <= codes


def test_single_missing_samples_cost_no_spectrum(tmp_path):
    """0.25 % of a wave record lost, marked by a word: the height is that of the whole record, the share is stated."""
    time = np.arange(4000) * 0.25
    random = np.random.default_rng(8)
    level = sum(
        0.1 * np.cos(2.0 * math.pi * f * time + p)
        for f, p in zip(np.linspace(0.08, 0.2, 30), random.uniform(0, 6.3, 30))
    )
    words = [f"{value:.6f}" for value in level]
    for place in random.choice(np.arange(5, 3990), 10, replace=False):
        words[place] = "欠測"
    (tmp_path / "w.csv").write_text("t,h\n" + "\n".join(f"{t},{w}" for t, w in zip(time, words)), encoding="utf-8")
    (tmp_path / "w.yaml").write_text(
        """moyai: 1
loggers:
  - name: buoy
    file: w.csv
    time: {column: t}
    channels: [{name: h, column: h, unit: m, kind: elevation, missing: [欠測, -9999]}]
blocks: {length: 1000 s}
waves: {channels: [h]}
spectrum: {segment: 200 s, lowest: 0.05 Hz, highest: 0.4 Hz}
""",
        encoding="utf-8",
    )
    result = run_survey(load_survey(tmp_path / "w.yaml"))
    reported = [notice for notice in result.notices if notice.code == "short-gaps-filled"]
    assert len(reported) == 1 and "0.25 %" in reported[0].message
    spectra = result.tree["spectra"]
    height = 4.0 * math.sqrt(np.trapezoid(spectra["density"].values[0, 0], spectra["frequency"].values))
    assert height == pytest.approx(4.0 * np.std(level), rel=0.03)


def test_decay_command(tmp_path):
    from typer.testing import CliRunner

    from moyai.cli.main import app

    time = np.arange(0.0, 30.0, 0.02)
    roll = 2.0 + 10.0 * np.exp(-0.04 * math.pi * time) * np.cos(2.0 * math.pi * time / 2.0)
    rows = ["経過[s];横揺れ[deg]"] + [f"{t:.2f};{r:.5f}" for t, r in zip(time, roll)]
    (tmp_path / "d.csv").write_text("\n".join(rows), encoding="cp932")
    runner = CliRunner()
    done = runner.invoke(app, ["measure", "decay", str(tmp_path / "d.csv"), "--column", "横揺れ", "--json"])
    found = json.loads(done.stdout)
    assert found["period"] == pytest.approx(2.0, rel=1e-3)
    assert found["damping_ratio"] == pytest.approx(0.04, rel=0.02)
    assert found["equilibrium"] == pytest.approx(math.radians(2.0), abs=2e-3)
    done = runner.invoke(app, ["measure", "decay", str(tmp_path / "d.csv"), "--column", "縦揺れ", "--json"])
    assert done.exit_code == 2 and "横揺れ" in json.loads(done.stdout)["faults"][0]["remedy"]
