"""``moyai measure forces`` and ``moyai run`` of a member, as typed."""

import json
import math

import numpy as np
import pytest
from japanese import compared
from typer.testing import CliRunner

from moyai.cli.main import app
from moyai.core.results import read_result

runner = CliRunner()

CONFIG = """\
moyai: 1
title: Circle of 4.5 cm
density: 1000 kg/m3
section: {shape: circle, diameter: 4.5 cm}
length: 79 cm
columns: {force: [force_x, force_z], velocity: [velocity_x, velocity_z]}
phase_error_deg: 0.5
period: 1.0526316 s
bootstrap: 60
"""


@pytest.fixture
def record(tmp_path):
    """C_M 1.7 and 1.65, C_D 1.2, KC about 1.4, with a little noise."""
    period, count = 1.0526316, 60
    omega, time = 2 * math.pi / period, period / count * np.arange(count * 12)
    area, length = math.pi * 0.045**2 / 4, 0.79
    u, w = 0.06 * np.cos(omega * time), -0.057 * np.sin(omega * time)
    du, dw = -0.06 * omega * np.sin(omega * time), -0.057 * omega * np.cos(omega * time)
    noise = 0.01 * np.random.default_rng(1).standard_normal((2, time.size)) * length
    drag = 500 * 0.045 * 1.2 * length
    x = 1000 * area * 1.7 * length * du + drag * u * np.abs(u) + noise[0]
    z = 1000 * area * 1.65 * length * dw + drag * w * np.abs(w) + noise[1]
    file = tmp_path / "record.csv"
    header = "time [s], force_x [N], force_z [N], velocity_x [m/s], velocity_z [m/s]"
    np.savetxt(file, np.column_stack([time, x, z, u, w]), delimiter=",", header=header, comments="", fmt="%.9g")
    (tmp_path / "config.yaml").write_text(CONFIG, encoding="utf-8")
    return file


def measure(record, *options, config=CONFIG):
    (record.parent / "config.yaml").write_text(config, encoding="utf-8")
    arguments = ["measure", "forces", str(record), "--config", str(record.parent / "config.yaml")]
    return runner.invoke(app, [*arguments, "--output", str(record.parent / "out"), *options])


def test_coefficients_are_found_printed_and_written(record):
    found = measure(record)
    assert found.exit_code == 0, found.output
    assert "1.70" in found.output or "1.69" in found.output
    result = read_result(record.parent / "out/results.nc")
    values = result.tree["/coefficients"]["value"].sel(fit_method="fourier", coefficient="inertia").values
    assert values == pytest.approx([1.7, 1.65], abs=0.02)
    left, _ = compared(result)
    assert not left, "\n".join(left)
    page = (record.parent / "out/report.html").read_text(encoding="utf-8")
    assert "Conditioning and circulation" in page
    assert "Bootstrap samples" in page
    assert (record.parent / "out/report_tables/coefficients.csv").exists()


def test_a_wave_gauge_takes_the_place_of_velocities(record):
    from moyai.sea.dispersion import wave_number

    rows = np.loadtxt(record, delimiter=",", skiprows=1)
    omega = 2 * math.pi / 1.0526316
    k = float(wave_number(omega, 0.5, 9.81))
    # the horizontal velocity of the fixture, 0.06 m/s, taken back to the surface
    eta = rows[:, 3] * math.sinh(k * 0.5) / (omega * math.cosh(k * (0.5 - 0.093)))
    header = "time [s], force_x [N], eta [mm]"
    table = np.column_stack([rows[:, :2], 1000.0 * eta])
    np.savetxt(record, table, delimiter=",", header=header, comments="", fmt="%.9g")
    gauge = "gauge: {elevation: eta, water_depth: 50 cm, gravity: 9.81 m/s2, member_z: -9.3 cm}\n"
    both = "columns: {force: [force_x, force_z], velocity: [velocity_x, velocity_z]}"
    config = CONFIG.replace(both, "columns: {force: [force_x]}\naxes: [first]") + gauge
    found = measure(record, "--json", "--no-report", config=config)
    assert found.exit_code == 0, found.output
    inertia = [row["value"] for row in json.loads(found.stdout)["coefficients"] if row["coefficient"] == "C_M"]
    assert inertia == pytest.approx([1.7] * 4, abs=0.02)
    neither = measure(record, config=config.replace(gauge, ""))
    assert (neither.exit_code, "or a wave gauge" in neither.stderr) == (2, True)


def test_json_holds_no_digit_that_is_not_known(record):
    found = measure(
        record, "--json", "--no-report", config=CONFIG.replace("phase_error_deg: 0.5", "phase_error_deg: 15")
    )
    rows = json.loads(found.stdout)["coefficients"]
    drag = [row for row in rows if row["coefficient"] == "C_D"]
    assert drag
    assert all(row["value"] is None and not row["known"] for row in drag)
    assert all(row["known"] for row in rows if row["coefficient"] == "C_M")


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("phase_error_deg", "phase_eror_deg"), "did you mean 'phase_error_deg'?"),
        (("force: [force_x, force_z]", "force: [force_x, force_q]"), "no column 'force_q'"),
        (("velocity: [velocity_x, velocity_z]", "velocity: [velocity_x]"), "1 columns of velocity for 2 of force"),
        (("velocity: [velocity_x, velocity_z]", "velocity: [force_x, velocity_z]"), "named twice"),
        (("diameter: 4.5 cm", "diameter: -4.5 cm"), "out of range"),
        (("period: 1.0526316 s", "period: 20 s"), "shorter than one period"),
        (("bootstrap: 60", "methods: [fourrier]"), "fourrier"),
        (("bootstrap: 60", "regular: false\nmethods: [fourier]"), "'fourier' needs a periodic record"),
        (("bootstrap: 60", "axes: [first]"), "1 axes for 2 force columns"),
    ],
)
def test_each_slip_of_the_configuration_gives_one_message(record, change, words):
    found = measure(record, config=CONFIG.replace(*change))
    assert found.exit_code == 2
    assert words in found.stderr
    assert len(found.stderr.strip().splitlines()) <= 2, found.stderr


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda rows: [*rows[:30], rows[30].replace(rows[30].split(",")[1], "", 1), *rows[31:]], "is not a number"),
        (lambda rows: [*rows[:30], *rows[31:]], "not evenly sampled"),
        (lambda rows: [*rows[:30], "what,is,this,now,then", *rows[31:]], "'what' is not a number"),
        (lambda rows: rows[:1], "header and no rows"),
        (lambda rows: [], "holds no table"),
        (lambda rows: rows[:9], "samples"),
    ],
)
def test_each_bad_record_gives_one_message(record, spoil, words):
    rows = record.read_text(encoding="utf-8").splitlines()
    record.write_text("\n".join(spoil(rows)) + "\n", encoding="utf-8")
    found = measure(record)
    assert found.exit_code == 2, found.output
    assert words in found.stderr
    assert len(found.stderr.strip().splitlines()) == 1


def test_absent_files(record):
    found = runner.invoke(app, ["measure", "forces", "none.csv", "-c", str(record.parent / "config.yaml")])
    assert (found.exit_code, "none.csv" in found.stderr) == (2, True)
    found = runner.invoke(app, ["measure", "forces", str(record), "-c", "none.yaml"])
    assert (found.exit_code, "none.yaml" in found.stderr) == (2, True)


@pytest.mark.slow
def test_a_member_is_run_and_reported(tmp_path):
    from moyai.case.templates import template

    file = tmp_path / "brace.yaml"
    text = template("member").replace("duration: 30 min", "duration: 3 min")
    file.write_text(text, encoding="utf-8")
    found = runner.invoke(app, ["run", str(file), "-o", str(tmp_path / "out"), "--json"])
    assert found.exit_code == 0, found.output
    record = json.loads(found.stdout)
    assert record["status"] == "converged"
    assert record["key_figures"][0]["label"] == "Largest force on the member"
    page = (tmp_path / "out/report.html").read_text(encoding="utf-8")
    for words in (
        "Inertia coefficient over KC",
        "Circulation over KC",
        "Along the member",
        "Force on the member",
        "Otsuka",
    ):
        assert words in page, words
    tables = {path.name for path in (tmp_path / "out/report_tables").iterdir()}
    assert any("coefficients" in name for name in tables)
