"""Reading of flume records and the useful window, on files written here."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.survey.flume import (
    FlumeLayout,
    analyse_regular_run,
    read_flume_record,
    useful_window,
    wavemaker_start,
)
from moyai.sea.dispersion import group_velocity, wave_number
from moyai.sea.water import Water

LAYOUT = FlumeLayout(model=7.0, gauges={"A": 4.95, "B": 5.2, "C": 5.5, "D": 8.5}, front=("A", "B", "C"), behind=("D",))
WATER = Water(1.0, density=1000.0, gravity=9.81)


def write(path, time, columns, headings):
    rows = [",".join(headings)]
    rows += [",".join([f"{t:.3f}", *(f"{value:.6f}" for value in row)]) for t, row in zip(time, columns)]
    path.write_text("\n".join(rows) + "\n")


def test_row_numbers_before_the_time_are_left_out(tmp_path):
    (tmp_path / "r.csv").write_text(",Time [s],a [m]\n0,0.0,1\n1,0.5,2\n2,1.0,x\n")
    record = read_flume_record(tmp_path / "r.csv")
    np.testing.assert_allclose(record.time, [0.0, 0.5, 1.0])
    assert record.names == ("a",)
    (tmp_path / "r.csv").write_text(",Time [s],a [m]\n0,0.0,1\n1,,2\n2,1.0,3\n")
    with pytest.raises(InputError, match="row 3, column 2"):
        read_flume_record(tmp_path / "r.csv")


def test_headings_units_and_gaps(tmp_path):
    file = tmp_path / "r.csv"
    file.write_text(
        "\ufeff,Paddle,Gauge 1 [m],F_x [N]\n0.0,0.1,1,2\n0.1,,1,x\n0.2,0.3,1,2\n0.3,0.3,1,2\n", encoding="utf-8"
    )
    record = read_flume_record(file)
    assert record.names == ("Paddle", "Gauge 1", "F_x")
    assert record.units == ("", "m", "N")
    assert np.isnan(record.channel("Paddle")[1]) and np.isnan(record.channel("F_x")[1])
    assert [notice.code for notice in record.notices] == ["record-heading", "record-unit", "record-gaps"]
    assert "1 of them text" in record.notices[2].message
    assert read_flume_record(file, units={"Paddle": "m"}).units == ("m", "m", "N")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("t,a\n", "0 rows"),
        ("t,a\n0,1\n1,2,3\n2,1\n", "row 3 has 3 columns"),
        ("t,a\n0,1\n2,2\n1,1\n", "row 4, column 1: time does not increase"),
        ("t,a\n0,1\n,2\n1,1\n", "row 3, column 1: time is missing"),
    ],
)
def test_faults_are_named_with_row_and_column(tmp_path, text, message):
    (tmp_path / "r.csv").write_text(text)
    with pytest.raises(InputError, match=message):
        read_flume_record(tmp_path / "r.csv")


@pytest.mark.parametrize("seed", range(4))
def test_synthetic_run(tmp_path, seed):
    """Waves that set in with the group velocity, a reflecting body and a reflecting wavemaker."""
    rng = np.random.default_rng(seed)
    period = rng.uniform(0.85, 1.2)
    omega = 2.0 * math.pi / period
    k = float(wave_number(omega, 1.0, 9.81))
    speed = float(group_velocity(omega, 1.0, 9.81))
    time = np.arange(0.0, 44.0, 0.005)
    amplitude, reflection = rng.uniform(0.005, 0.02), rng.uniform(0.2, 0.9) * np.exp(1j * rng.uniform(0.0, 6.28))
    transmission = rng.uniform(0.2, 0.9)
    start = 8.0

    def wave(path_length, x, value):
        return np.real(value * np.exp(1j * (k * (x - 7.0) - omega * time))) * (time > start + path_length / speed)

    columns = [np.where(time > start, 0.01 * np.sin(omega * (time - start)), 0.0)]
    for x in (4.95, 5.2, 5.5):
        returned = np.real(amplitude * reflection * np.exp(1j * (-k * (x - 7.0) - omega * time)))
        again = wave(14.0 + x, x, 0.9 * amplitude * reflection)
        columns.append(wave(x, x, amplitude) + returned * (time > start + (14.0 - x) / speed) + again)
    columns.append(wave(8.5, 8.5, transmission * amplitude))
    columns.append(0.3 + wave(7.0, 7.0, 2.0j * amplitude))
    write(
        tmp_path / "s.csv", time, np.column_stack(columns), ["", "P [m]", "A [m]", "B [m]", "C [m]", "D [m]", "F [N]"]
    )
    record = read_flume_record(tmp_path / "s.csv")
    begin = wavemaker_start(record.time, record.channel("P"), fraction=0.02)
    assert begin == pytest.approx(start, abs=0.02)
    run = analyse_regular_run(record, LAYOUT, WATER, period, start=begin, ramp_periods=2.0)
    # Files keep six decimals: 5e-7 of a 5 mm wave
    assert run.incident_amplitude == pytest.approx(amplitude, rel=2e-4)
    assert run.reflection == pytest.approx(abs(reflection), abs=5e-4)
    assert run.transmission == pytest.approx(transmission, rel=5e-4)
    assert run.amplitude("F") == pytest.approx(2.0j * amplitude, rel=5e-4)
    assert run.mean("F") == pytest.approx(0.3, rel=1e-5)
    assert run.reflection_spread < 1e-3


def test_window_by_hand():
    # Deep water, T = 0.8 s: c_g = g T / 4 pi = 0.6245 m/s
    window = useful_window(LAYOUT, Water(math.inf, 1000.0, 9.81), 0.8, start=3.0, ramp_periods=5.0)
    assert window.start == pytest.approx(3.0 + 9.05 / 0.62452 + 4.0, abs=1e-3)
    assert window.end == pytest.approx(3.0 + 18.95 / 0.62452, abs=1e-3)
    with pytest.raises(InputError, match="less than one period"):
        useful_window(LAYOUT, WATER, 1.6, start=3.0, ramp_periods=5.0)


def test_layout_and_start_refusals():
    with pytest.raises(InputError, match="no position"):
        FlumeLayout(model=7.0, gauges={"A": 1.0}, front=("A", "B"), behind=())
    with pytest.raises(InputError, match="between wavemaker and model"):
        FlumeLayout(model=7.0, gauges={"A": 1.0, "B": 8.0}, front=("A", "B"), behind=())
    with pytest.raises(InputError, match="start of the wavemaker"):
        wavemaker_start(np.arange(100.0), np.zeros(100), fraction=0.02)
