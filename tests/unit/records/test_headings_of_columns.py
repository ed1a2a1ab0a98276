"""Headings of columns: the unit of the time is taken, units of the wrong kind and surplus cells are refused."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.errors import CaseError, InputError
from moyai.core.quantities import FORCE, LENGTH
from moyai.records import ColumnSource, LoggerSource, TimeSource, load_survey, read_record, run_survey
from moyai.records.forces.case.build import record_of
from moyai.records.forces.case.schema import ForceRecordFile
from moyai.study.rows_of_files import read_rows

SECONDS = np.arange(0.0, 24.0, 0.05)
# a decay of 2 s with 3 % damping
HEAVE = 0.2 * np.exp(-0.03 * np.pi * SECONDS) * np.cos(np.pi * SECONDS)


def write(path, heading, *columns):
    rows = [",".join(f"{value:.9g}" for value in row) for row in zip(*columns)]
    path.write_text("\n".join([heading, *rows]) + "\n", encoding="utf-8")
    return path


def source(path, *, unit="", kinds=(), time="t"):
    return LoggerSource("a", (path,), (ColumnSource("h", "h", kinds=kinds),), TimeSource((time,), unit=unit))


@pytest.mark.parametrize(
    ("unit", "seconds"), [("ms", 1e-3), ("min", 60.0), ("h", 3600.0), ("d", 86400.0), ("msec", 1e-3), ("分", 60.0)]
)
def test_the_unit_of_the_time_is_that_of_its_heading(tmp_path, unit, seconds):
    path = write(tmp_path / "a.csv", f"t [{unit}],h [m]", np.arange(5.0), np.arange(5.0))
    np.testing.assert_allclose(read_record(source(path)).time, seconds * np.arange(5.0), rtol=1e-14)


def test_units_of_the_time_that_disagree_are_refused(tmp_path):
    path = write(tmp_path / "a.csv", "t [ms],h [m]", np.arange(5.0), np.arange(5.0))
    with pytest.raises(InputError, match=r"column 't' states the unit \[ms\] and the configuration says 's'"):
        read_record(source(path, unit="s"))
    assert read_record(source(path, unit="ms")).time[1] == 1e-3
    write(path, "t [m],h [m]", np.arange(5.0), np.arange(5.0))
    with pytest.raises(InputError, match="'m' is no unit of a time"):
        read_record(source(path))
    write(path, "t [tick],h [m]", np.arange(5.0), np.arange(5.0))
    with pytest.raises(InputError, match=r"states the unit \[tick\], which is not understood"):
        read_record(source(path))
    assert read_record(source(path, unit="ms")).time[1] == 1e-3


@pytest.mark.parametrize(("unit", "seconds"), [("ms", 1e-3), ("min", 60.0)])
def test_decay_and_tide_take_the_unit_of_the_time(tmp_path, unit, seconds):
    path = write(tmp_path / "a.csv", f"time [{unit}],heave [m]", SECONDS / seconds, HEAVE)
    found = CliRunner().invoke(app, ["measure", "decay", str(path), "--column", "heave", "--json"])
    assert json.loads(found.output)["period"] == pytest.approx(2.0, rel=1e-8)
    hours = np.arange(0.0, 30 * 24.0)
    level = np.cos(np.radians(28.9841042) * hours)
    path = write(tmp_path / "b.csv", f"time [{unit}],level [m]", hours * 3600.0 / seconds, level)
    found = CliRunner().invoke(app, ["measure", "tide", str(path), "--column", "level", "--constituent", "M2"])
    assert "explained 100 %" in found.output
    found = CliRunner().invoke(app, ["measure", "tide", str(path), "--column", "level", "--time-unit", "h"])
    assert found.exit_code == 2 and "the configuration says 'h'" in found.output


def test_a_mass_is_no_force(tmp_path):
    path = write(tmp_path / "a.csv", "t [s],h [t]", np.arange(5.0), np.arange(5.0))
    with pytest.raises(InputError, match=r"'t' is no unit of a force.*'t' is a mass: write 'kgf' or 'tf'"):
        read_record(source(path, kinds=(FORCE,)))
    write(path, "t [s],h [kn]", np.arange(5.0), np.arange(5.0))
    with pytest.raises(InputError, match="did you mean 'kN'"):
        read_record(source(path, kinds=(FORCE,)))
    write(path, "t [s],h [kPa]", np.arange(5.0), np.arange(5.0))
    with pytest.raises(InputError, match=r"a\.csv, column 'h': 'kPa' is no unit of a length; allowed: for instance m"):
        read_record(source(path, kinds=(LENGTH,)))


SURVEY = """
moyai: 1
title: t
loggers:
- {name: a, file: a.csv, time: {column: t}, channels: [{name: c, column: c, kind: KIND}]}
blocks: {length: 5 min}
"""


@pytest.mark.parametrize(
    ("kind", "unit"), [("tension", "kg"), ("elevation", "kPa"), ("pressure", "m"), ("rotation", "m"), ("speed", "m")]
)
def test_channels_of_a_survey_have_units_of_their_kind(tmp_path, kind, unit):
    write(tmp_path / "a.csv", f"t [s],c [{unit}]", SECONDS, HEAVE)
    (tmp_path / "s.yaml").write_text(SURVEY.replace("KIND", kind), encoding="utf-8")
    with pytest.raises(InputError, match=f"a.csv, column 'c': '{unit}' is no unit of a"):
        run_survey(load_survey(tmp_path / "s.yaml"))
    (tmp_path / "s.yaml").write_text(SURVEY.replace("kind: KIND", f"kind: {kind}, unit: {unit}"), encoding="utf-8")
    with pytest.raises(CaseError, match=f"'{unit}' is no unit of a"):
        load_survey(tmp_path / "s.yaml")


@pytest.mark.parametrize(
    ("force", "velocity", "length", "message"),
    [
        ("kg", "m/s", 1.0, "'kg' is no unit of a force"),
        ("N", "m", 1.0, "'m' is no unit of a speed"),
        ("N", "m/s", None, "'N' is no unit of a force per length"),
    ],
)
def test_columns_of_a_force_record_have_units_of_their_kind(tmp_path, force, velocity, length, message):
    path = write(tmp_path / "a.csv", f"time [s],f [{force}],u [{velocity}]", SECONDS, HEAVE, HEAVE)
    keys = {
        "moyai": 1,
        "title": "t",
        "density": 1000.0,
        "section": {"shape": "circle", "diameter": 0.1},
        "columns": {"force": ["f"], "velocity": ["u"]},
        "axes": ["first"],
        "phase_error_deg": 0.0,
        "length": length,
    }
    with pytest.raises(InputError, match=message):
        record_of(path, ForceRecordFile(**keys))


def test_decay_and_tide_refuse_other_quantities(tmp_path):
    path = write(tmp_path / "a.csv", "time [s],heave [kg]", SECONDS, HEAVE)
    for command in ("decay", "tide"):
        found = CliRunner().invoke(app, ["measure", command, str(path), "--column", "heave"])
        assert found.exit_code == 2 and "'kg' is no unit of a length" in found.output


def test_rows_longer_than_the_headings_are_refused(tmp_path):
    path = tmp_path / "a.csv"
    # decimal commas between commas: 0,05 and 0,19 would be read as 0 s and 5 m
    path.write_text("# logger\nt [s],h [m]\n0,05,0,19\n0,10,0,18\n", encoding="utf-8")
    message = "a.csv line 3 has 4 cells for 2 headings; name every column; where the comma is the decimal sign"
    with pytest.raises(InputError, match=message):
        read_record(source(path))
    with pytest.raises(InputError, match=message):
        read_rows(path)
    path.write_text("t [s],h [m]\n0.0,0.19\n0.1,0.18,7\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"a\.csv line 3 has 3 cells for 2 headings"):
        read_rows(path)
    with pytest.raises(InputError, match="line 3 has 3 cells"):
        read_record(source(path))


def test_empty_cells_at_the_end_of_rows_are_none(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t [s],h [m]\n0.0,0.19,\n0.1,0.18,\n", encoding="utf-8")
    assert read_record(source(path))["h"].tolist() == [0.19, 0.18]
    assert read_rows(path)[1] == {"t [s]": "0.1", "h [m]": "0.18"}


def test_a_heading_without_cells_is_named(tmp_path):
    path = tmp_path / "a.csv"
    path.write_text("t [s],u [m],h [m]\n0.0,0.19\n0.1,0.18\n", encoding="utf-8")
    with pytest.raises(InputError, match="line 2 has 2 cells for 3 headings, and none for the column 'h'"):
        read_record(source(path))
