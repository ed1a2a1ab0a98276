"""Bodies in networks as case files: rest and run of one piece, runs that stop and go on, runs that blow up."""

from dataclasses import replace

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.core.errors import InputError
from moyai.core.results import read_result
from moyai.structures.network.run import run

CASE = """moyai: 1
title: Box on two chains
site: {{water_depth: 8 m, density: 1025 kg/m3, gravity: 9.81 m/s2}}
waves: {{kind: regular, name: waves, height: 0.6 m, period: 3.2 s, heading_deg: 20}}
current: {{speed: 0.4 m/s, heading_deg: 70}}
structure:
  kind: network
  bed: {{stiffness: 3e5 Pa/m, damping: 3e4 Pa s/m, friction: 0.4}}
  line_types:
    chain: {{catalogue: studless_chain_U3, diameter: 16 mm, damping_ratio: 0.3}}
  bodies:
    box:
      shape: box
      size: [2 m, 3 m, 1 m]
      mass: 2.9 t
      gyration_radii: [0.9 m, 0.6 m, 1 m]
      centre_of_gravity: [0.05 m, 0, -0.1 m]
      position: [0, 0, 0]
      points: {{west: [-1 m, 0.2 m, 0.3 m], east: [1 m, -0.1 m, -0.4 m]}}
      drag: [1, 1, 1.4]
      added_mass: [0.5, 0.4, 0.9]
  points:
    anchor west: {{kind: fixed, position: [-16 m, 0, bed]}}
    anchor east: {{kind: fixed, position: [16 m, 1 m, bed]}}
  lines:
    chain west: {{start: anchor west, end: west, type: chain, length: 17.6 m, segments: {bars}}}
    chain east: {{start: anchor east, end: east, type: chain, length: 17.6 m, segments: {bars}}}
analyses: {analyses}
settings: {{duration: 5 s, output_step: 50 ms, start: rest_in_current{more}}}
"""


def problem_of(folder, analyses="[dynamic]", more="", bars=8):
    path = folder / "case.yaml"
    path.write_text(CASE.format(analyses=analyses, more=more, bars=bars), encoding="utf-8")
    return build(load_case(path))


def stopping_at(moment):
    def stop(what, done, total):
        if what == "waves" and done > moment:
            raise KeyboardInterrupt

    return stop


@pytest.fixture(scope="module")
def stopped(tmp_path_factory):
    """A problem, the result of a run of it that was stopped, and its file."""
    folder = tmp_path_factory.mktemp("stopped")
    problem = problem_of(folder, bars=4)
    # a whole period of the wave at its height counts
    problem = replace(problem, settings=replace(problem.settings, duration=3.6, ramp=0.3))
    part = run(problem, stopping_at(1.3))
    return problem, part, part.write(folder / "results.nc")


@pytest.mark.slow
def test_a_run_with_bodies_goes_on_from_where_it_was_stopped(stopped):
    problem, part, file = stopped
    whole = run(problem)
    assert part.status == "interrupted"
    assert "'resume' continues" in part.message
    reached = float(part.tree["SWL/time/waves"]["time"].values[-1])
    assert 1.0 < reached < 2.0
    # rows, state and message tell one and the same time
    assert f"t = {reached:g} s" in part.message
    kept = read_result(file).tree["SWL/time/waves/frames"]
    assert float(kept.attrs["final_time"]) == pytest.approx(reached, abs=1e-9)
    going = replace(problem, settings=replace(problem.settings, resume=file, sensitivity=True))
    rest = run(going)
    assert rest.status == "converged", rest.message
    one, two = (item.tree["SWL/time/waves"].to_dataset() for item in (whole, rest))
    assert np.allclose(one["time"].values, two["time"].values, atol=1e-9)
    for key, scale in (("solid_position", 0.3), ("solid_angle", 0.1)):
        apart = np.abs(one[key].values - two[key].values)
        late = one["time"].values > reached
        assert apart[~late].max() < 1e-12
        assert apart[late].max() < 2e-3 * scale
    peak = float(one["end_tension"].max())
    assert np.abs(one["end_tension"].values - two["end_tension"].values).max() < 0.02 * peak
    assert any("continues an earlier one" in notice.message for notice in rest.notices)


@pytest.mark.slow
def test_motions_of_bodies_stand_in_the_summary(tmp_path):
    text = CASE.format(analyses="[statics, dynamic]", more=", skip: 1 s", bars=4)
    path = tmp_path / "case.yaml"
    path.write_text(text.replace("duration: 5 s", "duration: 3 s"), encoding="utf-8")
    result = run(build(load_case(path)))
    summary = result.tree["SWL/dynamic"].to_dataset().sel(run="waves", solid="box")
    series = result.tree["SWL/time/waves"].to_dataset().sel(solid="box")
    place, turn = series["solid_position"].values, series["solid_angle"].values
    late = series["time"].values >= 1.0
    assert float(summary["heave_range"]) == pytest.approx(np.ptp(place[late, 2]), rel=1e-9)
    # offsets count from still water, not from where the run begins
    still = result.tree["SWL/statics"]["solid_position"].sel(condition="still water", solid="box").values
    away = place[:, :2] - still[:2]
    assert float(summary["largest_offset"]) == pytest.approx(np.hypot(*away[late].T).max(), rel=1e-9)
    assert float(summary["pitch_range"]) == pytest.approx(np.ptp(turn[late, 1]), rel=1e-9)
    upright = np.cos(turn[late, 0]) * np.cos(turn[late, 1])
    assert float(summary["highest_lean"]) == pytest.approx(np.arccos(upright.min()), rel=1e-6)
    assert not [item for item in result.notices if item.code == "body-turned-over"]


@pytest.mark.slow
def test_rest_in_a_current_is_rest_in_the_run(tmp_path):
    """With a fairlead in the air and half bars that the current drags at: nothing moves."""
    text = CASE.format(analyses="[dynamic]", more="", bars=5).replace("duration: 5 s", "duration: 4 s")
    path = tmp_path / "case.yaml"
    path.write_text("\n".join(line for line in text.splitlines() if "waves" not in line), encoding="utf-8")
    series = run(build(load_case(path))).tree["SWL/time/current"].to_dataset()
    assert np.ptp(series["solid_position"].values, axis=0).max() < 1e-7
    assert np.ptp(series["solid_angle"].values, axis=0).max() < 1e-7
    # and the current has moved it
    assert abs(float(series["solid_position"][0, 0, 1])) > 0.5


@pytest.mark.slow
def test_a_body_that_turns_over_is_reported(tmp_path, monkeypatch):
    # nine more meshes of the chains say nothing of it
    monkeypatch.setattr("moyai.structures.network.run.with_finer_meshes", lambda rested, *_: rested)
    text = CASE.format(analyses="[statics]", more="", bars=2).replace("[0.05 m, 0, -0.1 m]", "[0, 0, 1.5 m]")
    path = tmp_path / "case.yaml"
    path.write_text(text, encoding="utf-8")
    result = run(build(load_case(path)))
    reported = [item for item in result.notices if item.code == "body-turned-over"]
    assert reported and "from upright" in reported[0].message and reported[0].value > 1.05


@pytest.mark.slow
def test_the_uncertainty_of_a_peak_is_reported_with_bodies(tmp_path):
    text = CASE.format(
        analyses="[dynamic]", more=", sensitivity: true, skip: 0.5 s, peak_goal: 0.3, ramp: 0.2 s", bars=4
    )
    path = tmp_path / "case.yaml"
    text = text.replace("height: 0.6 m, period: 3.2 s", "height: 0.2 m, period: 1.4 s")
    path.write_text(text.replace("duration: 5 s", "duration: 2 s"), encoding="utf-8")
    result = run(build(load_case(path)))
    assert result.status == "converged", result.message
    summary = result.tree["SWL/dynamic"].to_dataset().sel(run="waves")
    peak = float(summary["line_tension_maximum"].max())
    assert float(summary["sensitivity_peak"]) == pytest.approx(peak, rel=1e-9)
    assert float(summary["half_step"]) == pytest.approx(peak, rel=0.02)
    for key in ("double_mesh", "half_viscosity", "double_viscosity"):
        assert float(summary[key]) == pytest.approx(peak, rel=0.3)
        assert float(summary[key]) != peak
    assert not [item for item in result.notices if item.code == "sensitivity-failed"]


@pytest.mark.parametrize("bodies", [pytest.param(True, marks=pytest.mark.slow), False])
def test_an_interrupt_while_the_uncertainty_is_found_keeps_the_run(tmp_path, bodies):
    text = CASE.format(analyses="[dynamic]", more=", sensitivity: true", bars=4)
    text = text.replace("duration: 5 s", "duration: 1.5 s")
    if not bodies:
        lines = text.splitlines()
        first, last = lines.index("  bodies:"), lines.index("  points:")
        held = ["    west: {kind: fixed, position: [-1 m, 0, 0.3 m]}", "    east: {kind: fixed, position: [1 m, 0, 0]}"]
        text = "\n".join([*lines[:first], lines[last], *held, *lines[last + 1 :]])
    path = tmp_path / "case.yaml"
    path.write_text(text, encoding="utf-8")
    complete = []

    def stop(what, done, total):
        # what is reported after the run itself belongs to its numerical uncertainty
        if complete:
            raise KeyboardInterrupt
        if what == "waves" and done == total == 1.0:
            complete.append(True)

    result = run(build(load_case(path)), stop)
    assert result.status == "interrupted"
    assert float(result.tree["SWL/time/waves"]["time"].values[-1]) == pytest.approx(1.5)
    assert "SWL/dynamic" in [name.strip("/") for name in result.tree.groups]


@pytest.mark.slow
def test_a_run_does_not_go_on_with_other_bodies(stopped):
    problem, _, file = stopped
    other = replace(problem.bodies[0], name="pontoon")
    with pytest.raises(InputError, match=r"has the bodies box, this network pontoon"):
        settings = replace(problem.settings, resume=file)
        run(replace(problem, bodies=(other,), settings=settings))


@pytest.mark.slow
def test_a_run_with_bodies_that_blows_up_tells_its_sound_rows(tmp_path):
    result = run(problem_of(tmp_path, more=", step: 12 ms", bars=80))
    assert result.status == "not_converged"
    assert "t = " in result.message
    series = result.tree["SWL/time/waves"].to_dataset()
    assert np.isfinite(series["solid_position"].values).all()
    assert float(np.abs(series["solid_position"].values).max()) < 10.0
    frames = result.tree["SWL/time/waves/frames"]
    assert np.isfinite(frames["final_motion"].values).all()
    result.write(tmp_path / "results.nc")
