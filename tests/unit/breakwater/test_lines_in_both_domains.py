"""Lines in motion in both domains: inertia, drag and force as in time; with their tangent they lack the hardening."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.flexible.elements import BarType
from moyai.floating.forcing import RegularForcing
from moyai.floating.frequency import dynamic_stiffness
from moyai.floating.time import simulate
from moyai.reproduce.inputs import problem_of
from moyai.reproduce.nakamura.runs import variant
from moyai.series.harmonics import fit_harmonics, fit_last_periods
from moyai.structures.breakwater.assembly import assemble
from moyai.structures.breakwater.frequency import equivalent_lines
from moyai.structures.breakwater.frequency.model import make_model
from moyai.structures.breakwater.frequency.regular import regular_sea as regular_in_frequency
from moyai.structures.breakwater.hydrodynamics import solve_unit
from moyai.structures.breakwater.lines.drag import line_drag_rows, line_inertia
from moyai.structures.breakwater.memory_model import unit_memory
from moyai.structures.breakwater.run import run
from moyai.structures.breakwater.time.model import compiled_lines, linear_damping
from moyai.structures.breakwater.time.regular import regular_sea as regular_in_time

DOMAINS = ("time", "frequency")


def tank_model(height, periods, *, moving=True, drift=True, restoring="tangent"):
    case = problem_of("nakamura", "tank_model")
    sea = replace(case.environment.sea_states[0], height=height)
    case = replace(case, environment=replace(case.environment, sea_states=(sea,)))
    case = variant(case, periods, time=True, moving=moving, drift=drift)
    return replace(case, settings=case.settings.changed(line_restoring=restoring))


def ratios(result, name):
    time, frequency = (result.tree[f"SWL/{domain}/waves"].to_dataset()[name].values for domain in DOMAINS)
    return np.abs(time / frequency)


def against_tangent(result):
    time, frequency = (result.tree[f"SWL/{domain}/waves"].to_dataset() for domain in DOMAINS)
    return time["motion_amplitude"].values / frequency["motion_amplitude_with_tangent"].values


def run_frequency(problem):
    return run(replace(problem, analyses=("frequency",))).tree["SWL/frequency/waves"].to_dataset()


@pytest.fixture(scope="module")
def paper():
    return run(tank_model(0.04, (0.6, 0.95, 1.2)))


@pytest.fixture(scope="module")
def low():
    return run(tank_model(0.01, (0.6, 1.2)))


def test_inertia_of_a_taut_line_is_a_third_of_its_mass(pontoon_problem):
    """Its points move in proportion to their distance from the anchor, along and across alike."""
    material = BarType("rope", 0.4, 2.0e4, 0.01, drag_normal=1.2, added_mass_normal=1.0, added_mass_tangential=1.0)
    lines = tuple(
        replace(
            line,
            segments=tuple(
                replace(part, length=1.90, line_type=replace(part.line_type, submerged_weight=1e-3))
                for part in line.segments
            ),
            bar_types=(material,),
            dynamic=True,
        )
        for line in pontoon_problem.breakwater.lines
    )
    problem = replace(pontoon_problem, breakwater=replace(pontoon_problem.breakwater, lines=lines))
    unit = assemble(problem, *problem.environment.water_levels[0])
    length = float(np.hypot(2.115 - 0.19, 0.38 - 0.113))
    third = 4.0 * (0.4 + 1000.0 * math.pi / 4.0 * 0.01**2) * length / 3.0
    found = line_inertia(unit)
    assert found[0, 0] == pytest.approx(third, rel=5e-3)
    assert found[1, 1] == pytest.approx(third, rel=5e-3)
    # four fairleads 0.19 m to either side and z below the centre
    arm = 0.19**2 + unit.lines[0].fairlead[2] ** 2
    assert found[2, 2] == pytest.approx(third * arm, rel=5e-3)
    assert found == pytest.approx(found.T, abs=1e-12)
    _, coefficients = line_drag_rows(unit)
    assert coefficients.sum() == pytest.approx(4.0 * 0.5 * 1000.0 * 1.2 * 0.01 * length, rel=5e-3)
    assert not line_drag_rows(unit, of_moving=False)[1].size
    still = replace(
        unit, breakwater=replace(unit.breakwater, lines=tuple(replace(line, dynamic=False) for line in lines))
    )
    assert not line_inertia(still).any() and not line_drag_rows(still)[1].size


@pytest.mark.slow
def test_low_waves_give_the_same_motion_in_both_domains(low):
    """Without inertia and drag of the chains in frequency sway is 4 % lower in time, roll 6 % at 0.6 s."""
    assert ratios(low, "motion_amplitude")[:, :2] == pytest.approx(1.0, abs=3e-3)
    assert ratios(low, "motion_amplitude")[:, 2] == pytest.approx(1.0, abs=1e-2)
    assert ratios(low, "transmission_coefficient") == pytest.approx(1.0, abs=3e-3)


@pytest.mark.slow
def test_the_difference_of_the_domains_falls_with_the_square_of_the_wave_height(paper, low):
    """The hardening of chains is of third order: four times lower waves, sixteen times less difference of roll."""
    high, small = (1.0 - ratios(item, "motion_amplitude")[-1, 2] for item in (paper, low))
    assert high > 0.08
    assert 10.0 < high / small < 22.0


@pytest.mark.slow
def test_roll_and_transmission_of_the_paper_are_alike_in_both_domains_to_its_resonance(paper):
    assert ratios(paper, "motion_amplitude")[:2] == pytest.approx(1.0, abs=0.03)
    assert ratios(paper, "transmission_coefficient") == pytest.approx(1.0, abs=0.02)


@pytest.mark.slow
def test_all_periods_of_the_paper_agree_and_with_the_tangent_all_but_roll_in_long_waves():
    """Every second one, the longest among them."""
    periods = tuple(problem_of("nakamura", "tank_model").environment.sea_states[0].periods)
    assert len(periods) == 14
    result = run(tank_model(0.04, periods[1::2], restoring="equivalent"))
    assert result.status == "converged"
    assert ratios(result, "transmission_coefficient") == pytest.approx(1.0, abs=0.005)
    assert ratios(result, "motion_amplitude")[:, :2] == pytest.approx(1.0, abs=0.005)
    roll = ratios(result, "motion_amplitude")[:, 2]
    # the longest wave has a third harmonic, which one harmonic does not know
    assert roll[:6] == pytest.approx(1.0, abs=0.01) and roll[6] == pytest.approx(1.0, abs=0.05)
    of_tangent = against_tangent(result)[:, 2]
    assert of_tangent[:5] == pytest.approx(1.0, abs=0.08)
    assert (of_tangent[5:] < 0.90).all()


@pytest.mark.slow
def test_the_lines_alone_make_the_difference():
    """With the first harmonic of the line force of the run in time the frequency domain gives the motion in time."""
    problem = tank_model(0.04, (1.2,))
    unit = assemble(problem, *problem.environment.water_levels[0])
    model = make_model(unit, solve_unit(unit, problem), np.zeros(3), True)
    sea = problem.environment.sea_states[0]
    frequency = regular_in_frequency(model, sea).dataset
    found = regular_in_time(model, unit_memory(model), sea, frequency, problem.settings.time)
    simulation, omega = found.runs[0].simulation, 2.0 * math.pi / 1.2
    force = fit_last_periods(simulation.time, simulation.mooring_force, omega, periods=10).first
    hydro = model.hydro.at(np.array([omega]), 0.0)
    stiffness = unit.statics.stiffness + frequency.mooring_stiffness.values[0]
    damping = model.damping.at(model.inertia, hydro.added_mass[0], stiffness)
    matrix = dynamic_stiffness(
        np.array(omega),
        unit.inertia + hydro.added_mass[0],
        hydro.radiation_damping[0] + damping,
        unit.statics.stiffness,
    )
    motion = np.abs(np.linalg.solve(matrix, 0.02 * hydro.excitation_force[0, 0] + force))
    assert motion == pytest.approx(found.dataset.motion_amplitude.values[0], rel=2e-3)
    # the tangent of the lines gives another roll
    assert motion[2] < 0.92 * float(frequency.motion_amplitude.values[0, 2])


@pytest.mark.slow
def test_led_lines_give_the_motion_in_time_where_the_tangent_does_not():
    """No run in time stands behind the frequency domain: fairleads are led, and the body balances mean and harmonic."""
    result = run(tank_model(0.04, (0.6, 1.4), restoring="equivalent"))
    assert result.status == "converged"
    assert ratios(result, "motion_amplitude") == pytest.approx(1.0, abs=0.01)
    assert ratios(result, "transmission_coefficient") == pytest.approx(1.0, abs=0.005)
    assert against_tangent(result)[1, 2] < 0.78
    offset = [result.tree[f"SWL/{domain}/waves"].to_dataset()["mean_offset"].values[:, 0] for domain in DOMAINS]
    assert offset[0] == pytest.approx(offset[1], abs=5e-5)
    # the work of led lines is that of all forces, so that the far field keeps the energy
    energy = next(check for check in result.checks if check.name == "SWL, waves: energy of the moving body")
    assert energy.value < 1e-6


@pytest.mark.slow
def test_led_lines_are_their_tangent_in_low_waves():
    found = run_frequency(tank_model(0.0025, (0.95, 1.4), restoring="equivalent"))
    share = found["motion_amplitude"].values / found["motion_amplitude_with_tangent"].values
    assert share == pytest.approx(1.0, abs=5e-3)


@pytest.mark.slow
def test_led_chains_at_rest_at_every_instant_give_the_motion_of_such_chains_in_time():
    result = run(tank_model(0.03, (1.0, 1.2), moving=False, restoring="equivalent"))
    assert ratios(result, "motion_amplitude") == pytest.approx(1.0, abs=0.01)
    assert against_tangent(result)[-1, 2] < 0.92


def test_drag_of_lines_at_rest_stays_next_to_led_lines():
    """Drag of a given width is no part of the force of lines at rest: a thin one changes nothing, a wide one damps."""
    problem = tank_model(0.02, (1.2,), moving=False, restoring="equivalent")

    def sway(width):
        lines = tuple(replace(line, drag_width=width) for line in problem.breakwater.lines)
        wide = replace(problem, breakwater=replace(problem.breakwater, lines=lines))
        return float(run_frequency(wide)["motion_amplitude"].values[0, 0])

    assert sway(1e-9) == pytest.approx(sway(0.0), rel=1e-6)
    assert sway(0.05) < 0.97 * sway(0.0)


@pytest.mark.usefixtures("nothing_remembered")
def test_a_wave_without_a_balance_keeps_the_tangent_and_says_so(monkeypatch):
    monkeypatch.setattr(equivalent_lines, "MOST_TURNS", 1)
    problem = tank_model(0.04, (1.4,), restoring="equivalent")
    result = run(replace(problem, analyses=("frequency",)))
    found = result.tree["SWL/frequency/waves"].to_dataset()
    assert (found["motion_amplitude"].values == found["motion_amplitude_with_tangent"].values).all()
    notice = next(one for one in result.notices if one.code == "led-lines")
    assert "4.488 rad/s" in notice.message and notice.severity == "warning"


class Swelling:
    """A regular wave whose height follows a given course."""

    def __init__(self, forcing, times, shares):
        self.forcing, self.times, self.shares = forcing, times, shares
        self.shortest_period, self.longest_step = forcing.shortest_period, forcing.longest_step

    def fitted_step(self, step):
        return self.forcing.fitted_step(step)

    def sample(self, step, count):
        force, elevation = self.forcing.sample(step, count)
        share = np.interp(step * np.arange(count), self.times, self.shares)
        return share[:, None] * force, share * elevation


@pytest.mark.slow
def test_chains_at_rest_at_every_instant_have_two_states_for_one_wave():
    """Waves of 3.2 cm and 1.6 s, raised to from below and lowered to from above."""
    period, height = 1.6, 0.032
    problem = tank_model(height, (period,), moving=False, drift=False)
    unit = assemble(problem, *problem.environment.water_levels[0])
    model = make_model(unit, solve_unit(unit, problem), np.zeros(3), False)
    omega = 2.0 * math.pi / period
    hydro = model.hydro.at(np.array([omega]), 0.0)
    damping = linear_damping(model, hydro.added_mass[0], model.stiffness)
    lines = compiled_lines(unit, np.array([0.1, 0.05, 0.3]))
    cummins = replace(unit_memory(model).model(model, damping), mooring=lines)
    wave = RegularForcing(omega, 0.5 * height, hydro.excitation_force[0, 0], np.zeros(3), np.zeros(3))
    course = period * np.array([0, 40, 100, 120, 150, 170, 230])
    run_of = simulate(
        cummins, Swelling(wave, course, [0, 1, 1, 1.15, 1.15, 1, 1]), duration=course[-1], time_step=0.016
    )
    first, second = (
        np.abs(
            fit_harmonics(
                run_of.time, run_of.position, omega, count=3, start=course[at] - 10 * period, end=course[at]
            ).amplitude
        )
        for at in (2, 6)
    )
    sway, roll = 2.0 / height, 0.38 / height
    assert (first[0, 0] * sway, first[0, 2] * roll) == pytest.approx((1.73, 0.11), abs=0.02)
    assert (second[0, 0] * sway, second[0, 2] * roll) == pytest.approx((2.23, 1.05), abs=0.02)
    # sway of the second state has a strong third harmonic
    assert second[2, 0] > 0.1 * second[0, 0] and first[2, 0] < 0.02 * first[0, 0]
