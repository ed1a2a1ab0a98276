"""Commands that measure a run in a flume and a tide: planted waves and constituents come back."""

import json
import math

import numpy as np
import pytest
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.records.survey.tides import CONSTITUENTS
from moyai.sea.dispersion import wave_number

PERIOD, DEPTH, MODEL = 1.2, 1.0, 7.0
GAUGES = {"A": 4.95, "B": 5.2, "C": 5.5, "D": 8.5}


def run(*arguments):
    return CliRunner().invoke(app, ["measure", *map(str, arguments)])


@pytest.fixture
def flume_file(tmp_path):
    omega = 2.0 * math.pi / PERIOD
    k = float(wave_number(omega, DEPTH, 9.81))
    t = np.arange(0.0, 40.0, 0.01)

    def wave(x):
        if x < MODEL:
            return 0.02 * np.cos(k * (x - MODEL) - omega * t) + 0.006 * np.cos(-k * (x - MODEL) - omega * t)
        return 0.009 * np.cos(k * (x - MODEL) - omega * t)

    paddle = np.where(t > 2.0, 0.05 * np.sin(omega * (t - 2.0)), 0.0)
    columns = np.column_stack([t, paddle, *(wave(x) for x in GAUGES.values())])
    file = tmp_path / "run.csv"
    np.savetxt(file, columns, "%.7f", ",", header="Time [s],paddle [m],A [m],B [m],C [m],D [m]", comments="")
    return file


def flume(file, *more, start=("--start", 2)):
    gauges = [text for name, place in GAUGES.items() for text in ("--gauge", f"{name}={place}")]
    return run(
        "flume", file, *gauges, "--model", MODEL, "--depth", DEPTH, "--period", PERIOD, "--ramp", 2, *start, *more
    )


def test_planted_waves_of_a_flume_come_back(flume_file):
    done = flume(flume_file, "--json")
    found = json.loads(done.output)
    assert found["incident_amplitude"] == pytest.approx(0.02, rel=2e-3)
    assert found["reflection"] == pytest.approx(0.3, rel=5e-3)
    assert found["transmission"] == pytest.approx(0.45, rel=5e-3)
    behind = next(one for one in found["channels"] if one["name"] == "D")
    k = found["wave_number"]
    turn = (behind["phase_deg"] - math.degrees(k * (GAUGES["D"] - MODEL)) + 180.0) % 360.0 - 180.0
    assert abs(turn) < 1.0
    reported = flume(flume_file, start=("--wavemaker", "paddle"))
    assert reported.exit_code == 0 and "reflection 0.3" in reported.output


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--start", 2, "--gauge", "E"), "NAME=POSITION"),
        ((), "the start of the wavemaker is not known"),
        (("--wavemaker", "pedal"), "pedal"),
        (("--start", 2, "--ramp", 500), "less than one period"),
    ],
)
def test_mistakes_at_a_flume_are_reported(flume_file, arguments, words):
    done = flume(flume_file, *arguments, start=())
    assert done.exit_code == 2 and words in done.output and "Traceback" not in done.output


def test_planted_constituents_of_a_level_and_a_current_come_back(tmp_path):
    t = np.arange(0.0, 30.0 * 86400.0, 600.0)
    m2, k1 = (np.radians(CONSTITUENTS[name]) / 3600.0 for name in ("M2", "K1"))
    level = 0.3 + 0.8 * np.cos(m2 * t - 1.0) + 0.25 * np.cos(k1 * t - 2.0)
    east, north = 0.5 * np.cos(m2 * t), 0.5 * np.cos(m2 * t) + 0.02
    file = tmp_path / "tide.csv"
    columns = np.column_stack([t, level, east, north])
    np.savetxt(file, columns, "%.6f", ",", header="time [s],level [m],u [m/s],v [m/s]", comments="")
    found = json.loads(run("tide", file, "--column", "level", "--json").output)
    size = {one["name"]: one["major"] for one in found["constituents"]}
    assert found["mean"] == pytest.approx(0.3, abs=1e-3)
    assert size["M2"] == pytest.approx(0.8, rel=2e-3) and size["K1"] == pytest.approx(0.25, rel=2e-3)
    assert max(value for name, value in size.items() if name not in ("M2", "K1")) < 2e-3
    both = json.loads(run("tide", file, "--column", "u", "--column", "v", "--constituent", "M2", "--json").output)[
        "constituents"
    ][0]
    assert both["major"] == pytest.approx(0.5 * math.sqrt(2.0), rel=1e-3)
    assert both["heading_deg"] == pytest.approx(45.0, abs=0.1) and abs(both["minor"]) < 1e-3
    read = run("tide", file, "--column", "level", "--constituent", "M2")
    assert read.exit_code == 0 and "M2 (12.42" in read.output
    wrong = run("tide", file, "--column", "level", "--constituent", "M9")
    assert wrong.exit_code == 2 and "unknown constituent" in wrong.output


def changed(flume_file, change):
    """Rewrite the record with other headings or columns."""
    table = np.loadtxt(flume_file, delimiter=",", skiprows=1)
    headings = flume_file.read_text().splitlines()[0].split(",")
    change(headings, table)
    np.savetxt(flume_file, table, "%.7f", ",", header=",".join(headings), comments="")
    return flume_file


def test_units_of_a_flume_record_are_taken(flume_file):
    def in_mm_and_ms(headings, table):
        headings[0], headings[5], headings[2] = "Time [ms]", "D [mm]", "A [cm]"
        table[:, 0] *= 1e3
        table[:, 5] *= 1e3
        table[:, 2] *= 1e2

    found = json.loads(flume(changed(flume_file, in_mm_and_ms), "--json").output)
    assert found["incident_amplitude"] == pytest.approx(0.02, rel=2e-3)
    assert found["transmission"] == pytest.approx(0.45, rel=5e-3)
    assert {one["unit"] for one in found["channels"]} == {"m"}


def rename(place, heading):
    return lambda headings, table: headings.__setitem__(place, heading)


def put(value, rows):
    return lambda headings, table: table.__setitem__((rows, 3), value)


def clip(headings, table):
    np.clip(table[:, 3], -0.015, 0.015, out=table[:, 3])


@pytest.mark.parametrize(
    ("change", "code", "words"),
    [
        (rename(3, "B [kg]"), 2, "gauge 'B': 'kg' is no unit of a length"),
        (rename(0, "Time [m]"), 2, "column 'Time': 'm' is no unit of a time"),
        (put(0.1, slice(None)), 2, "gauge B does not change"),
        (
            put(-99.0, slice(2000, 2001)),
            0,
            "column 'B' holds 1 value of -99 far outside of all others, the first in row",
        ),
        (clip, 0, "B: stands"),
    ],
)
def test_gauges_that_are_none_are_reported(flume_file, change, code, words):
    assert "warning" not in flume(flume_file).output
    done = flume(changed(flume_file, change))
    assert done.exit_code == code and words in done.output


def decay_file(tmp_path, change=lambda heave: heave):
    time = np.arange(0.0, 24.0, 0.05)
    heave = change(0.2 * np.exp(-0.03 * np.pi * time) * np.cos(np.pi * time))
    np.savetxt(
        tmp_path / "d.csv", np.column_stack([time, heave]), "%.5f", ",", header="time [s],heave [m]", comments=""
    )
    return tmp_path / "d.csv"


def spoil(row, value):
    def change(values):
        values[row] = value
        return values

    return change


@pytest.mark.parametrize("sign", [-99.0, 9999.0, -999.0])
def test_numbers_for_no_value_are_refused_in_decays_and_tides(tmp_path, sign):
    done = run("decay", decay_file(tmp_path, spoil(400, sign)), "--column", "heave")
    assert (
        done.exit_code == 2 and f"1 value of {sign:g} far outside of all others, the first in line 402" in done.output
    )
    assert f"--missing {sign:g}" in done.output
    done = run("decay", tmp_path / "d.csv", "--column", "heave", "--missing", f"{sign:g}", "--end", 19.9)
    assert done.exit_code == 0 and "damped period 2 +-" in done.output
    time = np.arange(0.0, 30 * 24.0)
    level = np.cos(np.radians(CONSTITUENTS["M2"]) * time)
    level[100:120] = sign
    np.savetxt(
        tmp_path / "t.csv", np.column_stack([time, level]), "%.6f", ",", header="time [h],level [m]", comments=""
    )
    arguments = ("tide", tmp_path / "t.csv", "--column", "level", "--constituent", "M2")
    assert "line 102" in run(*arguments).output
    assert "explained 100 %" in run(*arguments, "--missing", f"{sign:g}").output


def test_spikes_clipping_and_coarse_steps_of_a_decay_are_reported(tmp_path):
    assert "warning" not in run("decay", decay_file(tmp_path), "--column", "heave").output
    done = run("decay", decay_file(tmp_path, spoil(400, 0.5)), "--column", "heave", "--start", 0)
    assert "1 sample far from the neighbours, the first in line 402: 0.5 m" in done.output
    done = run("decay", decay_file(tmp_path, lambda heave: np.clip(heave, -0.08, 0.08)), "--column", "heave")
    assert "stands 10 times at its limit, first at 0.08 m from line 2 on" in done.output
    # what is rounded, or held before it is let go, is not clipped
    done = run("decay", decay_file(tmp_path, lambda heave: np.round(heave, 2)), "--column", "heave")
    assert "limit" not in done.output
    done = run(
        "decay",
        decay_file(tmp_path, lambda heave: np.concatenate([np.full(80, 0.2), heave[:-80]])),
        "--column",
        "heave",
    )
    assert "limit" not in done.output
    time = np.arange(0.0, 24.0, 1.5)
    coarse = 0.2 * np.exp(-0.03 * np.pi * time) * np.cos(np.pi * time)
    np.savetxt(
        tmp_path / "d.csv", np.column_stack([time, coarse]), "%.5f", ",", header="time [s],heave [m]", comments=""
    )
    assert "a period holds 4 samples" in run("decay", tmp_path / "d.csv", "--column", "heave").output


@pytest.mark.parametrize("arguments", [("--start", 100), ("--start", 10, "--end", 5), ("--end", 0.1)])
def test_parts_of_a_decay_without_samples_are_refused(tmp_path, arguments):
    done = run("decay", decay_file(tmp_path), "--column", "heave", *arguments)
    assert done.exit_code == 2 and "allowed: 8 or more, within 0 to 23.95 s" in done.output


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time [s];heave [m]\n0,0;0,1\n0,1;0,2\n", "add --decimal , where a comma is the decimal sign"),
        ("time [s],heave [m]\n0.0,abc\n0.1,0.2\n", "name signs that mean 'no value' by --missing"),
        ("time [s],heave\n0.0,0.1\n0.1,0.2\n", "add --unit, or write the unit into the heading"),
        ("time [s],heave [m]\n0.0,0.1\n0.0,0.2\n", "does not come after 0 s; sort or cut the file\n"),
        ("time [tick],heave [m]\n0.0,0.1\n0.1,0.2\n", "add --time-unit, or correct the heading"),
        ("time [s],heave [m]\n2024-05-01,0.1\n2024-05-02,0.2\n", "need --dates"),
    ],
)
def test_remedies_name_options_of_the_command(tmp_path, text, words):
    (tmp_path / "d.csv").write_text(text, encoding="utf-8")
    for command in ("decay", "tide"):
        done = run(command, tmp_path / "d.csv", "--column", "heave")
        assert done.exit_code == 2 and words in done.output


def test_phases_errors_and_names_of_a_tide_are_said(tmp_path):
    hours = np.arange(0.0, 30 * 24.0)
    level = np.cos(np.radians(CONSTITUENTS["M2"]) * hours)
    stamps = np.datetime_as_string(np.datetime64("2024-05-01") + (3600 * hours).astype("timedelta64[s]"))
    rows = [f"{stamp},{value:.6f}" for stamp, value in zip(stamps, level)]
    (tmp_path / "t.csv").write_text("\n".join(["time,level [m]", *rows]), encoding="utf-8")
    done = run("tide", tmp_path / "t.csv", "--column", "level", "--dates", "--constituent", "m2", "--constituent", "M2")
    # the middle of 719 h; M2 is at its top at the start
    assert "phases count from 2024-05-15 23:30:00.000Z; +- is the standard error" in done.output
    turn = (CONSTITUENTS["M2"] * 359.5 + 180.0) % 360.0 - 180.0
    assert f"phase {-turn:.4g} deg" in done.output and "too short" not in done.output
