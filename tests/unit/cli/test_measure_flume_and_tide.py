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
