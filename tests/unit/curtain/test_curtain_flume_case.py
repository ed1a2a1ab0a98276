"""The flume of the impact paper from case to result: its figures come out of the groups."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from renamed import unmissed

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.core.results import read_result
from moyai.structures.curtain.run import run

PAPERS = Path(__file__).parents[3] / "src" / "moyai" / "reproduce" / "cases"


def problem_of(folder: Path, text: str):
    file = folder / "case.yaml"
    file.write_text(text, encoding="utf-8")
    return build(load_case(file))


@pytest.fixture(scope="module")
def flume():
    text = (PAPERS / "sawaragi" / "flume.yaml").read_text(encoding="utf-8").replace("[1.5 s, 2 s, 3 s, 4 s]", "[4 s]")
    return text


@pytest.fixture(scope="module")
def flume_result(flume, tmp_path_factory):
    folder = tmp_path_factory.mktemp("flume")
    text = flume.replace("[statics, impact, waves]", "[statics, impact]")
    assert text != flume
    return run(problem_of(folder, text)), folder


@pytest.fixture(scope="module")
def flume_in_waves(flume, tmp_path_factory):
    folder = tmp_path_factory.mktemp("flume")
    return run(problem_of(folder, flume)), folder


@pytest.mark.slow
def test_flume_gives_the_figures_of_the_impact_paper(flume_result):
    """Default flume case: independent prototype of other construction, printed digits."""
    result, _ = flume_result
    impact = result.tree["SWL/impact"]
    tension = {
        str(model): float(value)
        for model, value in zip(impact["impact_model"].values, impact["both_cables_impact_tension"])
    }
    assert tension["A"] == pytest.approx(9.86556, abs=5e-6)
    assert tension["A closed form"] == pytest.approx(10.0342, abs=5e-5)
    assert float(impact["impact_time"].sel(impact_model="A")) == pytest.approx(0.22976, abs=5e-6)
    # the prototype's water is infinitely deep, h/d = 2.7 here
    assert tension["AB"] == pytest.approx(9.22, rel=3e-3)
    assert tension["B literal"] == pytest.approx(78.5, rel=2e-3)
    assert tension["B energy_mid"] == pytest.approx(287.4, rel=2e-3)
    assert tension["B energy_proj"] == pytest.approx(345.0, rel=2e-3)
    edges = impact.to_dataset().sel(impact_model="A2")
    assert float(edges["impact_upper_tension"]) == pytest.approx(4.616, abs=5e-4)
    assert float(edges["impact_lower_tension"]) == pytest.approx(5.230, abs=5e-4)
    assert float(impact["tension_coefficient"]) == pytest.approx(2.088, abs=5e-4)
    assert float(impact["cauchy_number"]) == pytest.approx(0.4888, abs=5e-5)
    assert float(impact["froude_number"]) == pytest.approx(0.1514, abs=5e-5)
    assert float(impact["taut_sag"]) == pytest.approx(0.169908, abs=5e-7)
    assert float(impact["both_cables_plateau_tension"]) == pytest.approx(2.92, abs=5e-3)
    with_memory = [value for model, value in tension.items() if "memory" in model]
    assert with_memory and with_memory[0] / tension["A in this depth"] == pytest.approx(1.258, abs=0.01)


@pytest.mark.slow
def test_marching_table_shows_order_and_iterations(flume_result):
    result, _ = flume_result
    impact = result.tree["SWL/impact"]
    error = impact["march_error"].values
    # 1, 4, 16, 64, 256, 1024 steps to the peak; prototype
    assert error == pytest.approx([-0.314, -0.138, -0.0383, -0.0098, -0.00246, -0.000616], rel=0.01)
    orders = np.log(error[2:-1] / error[3:]) / math.log(4.0)
    assert np.all(np.abs(orders - 1.0) < 0.05)
    assert impact["forward_iteration_converges"].values[2:].sum() == 0.0
    assert impact["reverse_iteration_converges"].values[1:].all()


@pytest.mark.slow
def test_snap_runs_from_release_over_the_spike_to_the_plateau(flume_result):
    result, _ = flume_result
    snap = result.tree["SWL/impact/snap"].to_dataset()
    taut, peak = float(snap.attrs["taut_time"]), float(snap.attrs["peak_time"])
    time, tension = snap["time"].values, snap["tension"].values
    assert np.all(tension[time < taut - 1e-9] == 0.0)
    assert taut < float(time[int(np.argmax(tension))]) == pytest.approx(peak, abs=0.02 * peak)
    assert tension[-1] == pytest.approx(float(snap.attrs["both_cables_plateau_tension"]), rel=0.1)
    # pictures: the middle of the plan is mid-span, a taut plan is as long as the stretched cable
    x, y = snap["frame_plan_x"].values, snap["frame_plan_y"].values
    place, pull = snap["frame_position"].values, snap["frame_tension"].values
    middle = x.shape[1] // 2
    assert x[:, middle] == pytest.approx(place, abs=1e-9)
    arc = np.sum(np.hypot(np.diff(x, axis=1), np.diff(y, axis=1)), axis=1)
    stretched = 0.8 * (1.0 + pull / 150.0)
    held = pull > 0.1
    assert held.sum() > 20
    assert arc[held] == pytest.approx(stretched[held], rel=2e-3)
    assert np.all(snap["frame_section_x"].values == place[:, None])


@pytest.mark.slow
def test_result_is_written_and_read_again(flume_in_waves):
    result, folder = flume_in_waves
    assert result.status == "converged", result.message
    assert result.checks and all(check.passed for check in result.checks)
    again = read_result(result.write(folder / "results.nc"))
    assert again.status == result.status and len(again.checks) == len(result.checks)
    assert again.tree.attrs["structure"] == "curtain"
    assert again.tree["SWL/loads"]["governing"].values.tolist() == result.tree["SWL/loads"]["governing"].values.tolist()
    for node in again.tree.subtree:
        for name, variable in node.to_dataset(inherit=False).variables.items():
            if variable.dtype.kind == "f":
                assert "units" in variable.attrs and "long_name" in variable.attrs, (node.path, name)


@pytest.mark.slow
def test_waves_find_sides_and_thresholds(flume_in_waves):
    """Without enough travel nothing is taut; a current alone keeps the curtain on one side."""
    result, _ = flume_in_waves
    waves = result.tree["SWL/waves/swing"].to_dataset()
    assert float(waves["threshold_water_excursion"][0]) == pytest.approx(2.0 * 0.169908, abs=2e-6)
    assert float(waves["water_excursion"][0]) == pytest.approx(float(waves["velocity_amplitude"][0]) * 4.0 / math.pi)
    series = result.tree["SWL/waves/swing/T 4 s"].to_dataset()
    assert set(np.unique(series["contact_side"].values)) <= {1.0, -1.0}
    assert float(waves["both_cables_tension_maximum"][0]) >= float(series["tension"].max()) - 1e-9


@pytest.mark.slow
def test_record_of_a_flume_lies_next_to_the_models(flume, tmp_path):
    """A made record: its impact is found above the plateau, per cable and summed, each model is held against it."""
    from moyai.sea.water import Water
    from moyai.structures.curtain.impact.cable import Impact
    from moyai.structures.curtain.impact.release import snap_in_current

    impact = Impact(0.70, 0.80, 0.15, 75.0, 75.0, 0.3, Water(0.4, 1000.0, 9.81))
    snap = snap_in_current(impact, drag_coefficient=1.2, current=0.3, position=0.0, speed=0.0, duration=14.0)
    time = np.arange(0.0, 15.0, 0.005)
    total = np.interp(time - 2.0, snap.motion.time, snap.motion.tension, left=0.0, right=0.0)
    total = np.where(time < 14.0, total, 0.0)
    noise = np.random.default_rng(5).normal(0.0, 0.01, (2, time.size))
    rows = [
        f"{t:.4f},{0.47 * v + a:.5f},{0.53 * v + b:.5f}"
        for t, v, a, b in zip(time, total, noise[0], noise[1], strict=True)
    ]
    (tmp_path / "record.csv").write_text("time [s],up [N],down [N]\n" + "\n".join(rows), encoding="utf-8")
    text = flume.replace("[statics, impact, waves]", "[impact]").replace("start: current", "start: slack_phase")
    text += """record:
  file: record.csv
  upper: up
  lower: down
  unloaded: [[0 s, 1.9 s]]
  window: [0 s, 13.5 s]
"""
    result = run(problem_of(tmp_path, text))
    assert unmissed(result) == set()
    record = result.tree["record"]
    assert float(record["taut_time"]) == pytest.approx(2.0 + snap.taut_time, abs=0.05)
    assert float(record["both_cables_impact_tension"]) == pytest.approx(snap.impact_tension, rel=0.03)
    assert float(record["cable_impact_tension"].sel(cable="upper")) == pytest.approx(
        0.47 * snap.impact_tension, rel=0.05
    )
    table = result.tree["SWL/impact"].to_dataset()
    expected = table["both_cables_impact_tension"].values / float(record["both_cables_impact_tension"])
    assert table["record_ratio"].values == pytest.approx(expected, rel=1e-12)
    assert "impact" in result.tree["SWL"] and float(table["record_upper_ratio"]) > 0.0
    with pytest.raises(Exception, match="no column 'sideways'"):
        problem_of(tmp_path, text.replace("upper: up", "upper: sideways"))
    with pytest.raises(Exception, match="there is no file"):
        problem_of(tmp_path, text.replace("file: record.csv", "file: recrod.csv"))


@pytest.mark.slow
def test_whatever_a_run_of_the_flume_writes_is_missed_where_it_is_absent(flume_in_waves):
    assert unmissed(flume_in_waves[0]) == {"strong_drag_tension"}
