"""Energy in regular waves in time: the loss of the far field is the work of the damping, or the run says so."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.reproduce.inputs import problem_of
from moyai.reproduce.nakamura.runs import variant
from moyai.structures.breakwater.run import run
from moyai.structures.breakwater.time import regular

PERIODS = (1.2, 1.6)
LOSS, WORK = "loss of the first harmonic and work of the damping", "loss of the first harmonic and work of all forces"


def checks_of(result):
    return {name: next(check for check in result.checks if name in check.name) for name in (LOSS, WORK)}


@pytest.fixture(scope="module")
def at_rest():
    """The paper's model, chains at rest at every instant: at 1.6 s the motion stands in its second state."""
    return run(variant(problem_of("nakamura", "tank_model"), PERIODS, time=True))


@pytest.fixture(scope="module")
def in_motion():
    return run(variant(problem_of("nakamura", "tank_model"), (1.4,), time=True, moving=True))


@pytest.mark.slow
def test_status_tells_where_reflection_and_transmission_do_not_keep_the_energy(at_rest):
    found = checks_of(at_rest)
    assert at_rest.status == "not_converged"
    assert "T = 1.6 s" in at_rest.message
    assert LOSS in at_rest.message
    assert not found[LOSS].passed
    assert "third 13.7 %" in found[LOSS].meaning


@pytest.mark.slow
def test_what_damping_does_not_take_the_lines_carry_into_other_harmonics(at_rest):
    data = at_rest.tree["SWL/time/waves"].to_dataset()
    assert checks_of(at_rest)[WORK].value < 2e-3
    balance = data.dissipation - data.damping_work - data.energy_to_harmonics
    assert np.abs(balance.values).max() < 1e-3
    # the energy carried on is radiated and damped there: most of it leaves in the third harmonic
    assert float(data.energy_to_harmonics.sel(period=1.6)) > 0.2
    assert float(data.harmonic_radiation.sel(period=1.6, harmonic=3) / data.energy_to_harmonics.sel(period=1.6)) > 0.5
    assert float(data.energy_to_harmonics.sel(period=1.2)) < 1e-3


@pytest.mark.slow
def test_lines_in_motion_keep_the_energy(in_motion):
    """Forces of lines in motion taken half a step late miss 3.7 % of the loss here."""
    found = checks_of(in_motion)
    assert in_motion.status == "converged", in_motion.message
    assert found[WORK].value < 2e-3
    assert found[LOSS].value < 5e-3


@pytest.mark.slow
def test_viscous_damping_in_moving_water_keeps_the_energy():
    """Drag of eddies against the moving wave, quadratic: its work on the first harmonic is what the far field loses."""
    case = variant(problem_of("nakamura", "tank_model"), (0.95,), fraction=0.0, time=True)
    damping = replace(case.breakwater.damping, viscous=True)
    found = run(replace(case, breakwater=replace(case.breakwater, damping=damping)))
    data = found.tree["SWL/time/waves"].to_dataset()
    assert found.status == "converged", found.message
    assert float(data.dissipation[0]) > 0.02
    assert checks_of(found)[WORK].value < 5e-3


@pytest.mark.slow
def test_waves_without_height_and_a_damping_lid_have_no_energy_check(pontoon_problem):
    sea = replace(pontoon_problem.environment.sea_states[0], height=0.0, periods=(1.0,))
    environment = replace(pontoon_problem.environment, sea_states=(sea,))
    lid = replace(pontoon_problem.breakwater, gap_damping_lid=0.05)
    for problem in (replace(pontoon_problem, environment=environment), replace(pontoon_problem, breakwater=lid)):
        assert not [check for check in run(problem).checks if LOSS in check.name]


@pytest.mark.slow
def test_no_period_out_of_its_range_decides_a_headline(at_rest, in_motion):
    """In time roll at 1.6 s is five times that of 1.2 s; it is the motion of the second state and decides nothing."""
    time, frequency = (at_rest.tree[f"SWL/{domain}/waves"].to_dataset() for domain in ("time", "frequency"))
    roll, offset = (next(item for item in at_rest.headlines if item.name == name) for name in ("roll", "offset"))
    jumped = float(time.motion_amplitude.sel(period=1.6, dof="roll"))
    assert roll.value < 0.6 * jumped
    assert roll.value == pytest.approx(float(time.motion_amplitude.sel(period=1.2, dof="roll")), rel=1e-12)
    assert roll.where.endswith("T = 1.2 s") and "at T = 1.6 s the time domain is out of its range" in roll.detail
    linear = frequency.sel(period=1.6)
    expected = abs(float(linear.mean_offset[0])) + float(linear.motion_amplitude[0])
    assert offset.value == pytest.approx(expected, rel=1e-12)
    assert offset.model == "frequency domain, regular waves"
    assert np.isfinite(time.maximum_motion.values).all()
    moving = next(item for item in in_motion.headlines if item.name == "roll")
    assert moving.model == "time domain, lines in motion" and "out of its range" not in moving.detail


PILES = """\
moyai: 1
title: Pontoon between stiff springs that only pull
site: {water_depth: 9 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {name: op, kind: regular, height: 0.6 m, period: 3 s, heading_deg: 0}
structure:
  kind: breakwater
  length: 15 m
  section: {shape: rectangle, beam: 5 m, height: 1.8 m}
  draught: 1.2 m
  centre_of_gravity_above_keel: 0.95 m
  roll_gyradius: 1.6 m
lines:
  - {name: seaward, kind: spring, count: 2, fairlead: {x: -2.5 m, above_keel: 1.2 m}, anchor: {x: -4 m, z: 0 m},
     stiffness: 400 kN/m, pretension: 0 N}
  - {name: shoreward, kind: spring, count: 2, fairlead: {x: 2.5 m, above_keel: 1.2 m}, anchor: {x: 4 m, z: 0 m},
     stiffness: 400 kN/m, pretension: 0 N}
analyses: [statics, frequency, time]
"""


@pytest.mark.slow
def test_springs_that_come_tight_carry_energy_into_other_harmonics_and_the_run_stands(tmp_path):
    """No chain at rest is out of its range there: the balance of all forces holds, and the page says where it goes."""
    (tmp_path / "piles.yaml").write_text(PILES, encoding="utf-8")
    result = run(build(load_case(tmp_path / "piles.yaml")))
    assert result.status == "converged", result.message
    (notice,) = [one for one in result.notices if one.code == "energy-in-harmonics"]
    assert notice.value > notice.limit and "into other harmonics" in notice.message
    assert next(check for check in result.checks if WORK in check.name).value < 0.02


TAUT = """\
moyai: 1
title: short chains at high water
site: {water_depth: 9.2 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {name: daily, kind: regular, height: 0.4 m, period: 3 s, heading_deg: 0}
wind: {speed: 20 m/s, heading_deg: 0, density: 1.225 kg/m3}
current: {speed: 0.4 m/s, heading_deg: 0}
structure:
  kind: breakwater
  length: 30 m
  section: {shape: rectangle, beam: 4 m, height: 1.7 m}
  draught: 1.1 m
  centre_of_gravity_above_keel: 0.8 m
  roll_gyradius: 1.25 m
  wind_drag_coefficient: 1.2
  current_drag_coefficient: 1.5
lines:
  - name: seaward
    count: 3
    fairlead: {x: -2 m, above_keel: 0 m}
    anchor: {x: -37 m}
    segments: [{catalogue: studless_chain_R3, diameter: 32 mm, length: 36.2 m}]
  - name: shoreward
    count: 3
    fairlead: {x: 2 m, above_keel: 0 m}
    anchor: {x: 37 m}
    segments: [{catalogue: studless_chain_R3, diameter: 32 mm, length: 36.2 m}]
analyses: [statics, frequency, time]
settings: {time: {lines: {mode: quasi_static}}}
"""


@pytest.mark.slow
def test_a_motion_that_never_repeats_has_no_reflection_and_its_largest_values_are_of_a_hundred_periods(
    tmp_path, monkeypatch
):
    # rounding decides how much one hundred periods of chaos differ from the next: 2 to 10 %, never a thousandth
    monkeypatch.setattr(regular, "REPEATING_LIMIT", 5e-3)
    (tmp_path / "taut.yaml").write_text(TAUT, encoding="utf-8")
    result = run(build(load_case(tmp_path / "taut.yaml")))
    data = result.tree["SWL/time/daily"].to_dataset().sel(period=3.0)
    record = result.tree["SWL/time/daily/T3"].to_dataset()
    assert np.isnan(data[["reflection_coefficient", "transmission_coefficient", "dissipation"]].to_array()).all()
    (notice,) = [notice for notice in result.notices if notice.code == "not-steady"]
    assert "does not repeat" in notice.message
    assert "100 periods" in notice.message
    last = record.tension.values[record.time.values > float(record.time[-1]) - 300.0]
    assert data.line_tension_maximum.values == pytest.approx(last.max(axis=0))
    assert result.status == "converged"
