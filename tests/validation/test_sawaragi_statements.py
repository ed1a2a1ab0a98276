"""Sawaragi, Aoki and Liu (1991): each statement of the paper in words, named, as far as no other file holds it.

The experiment's depth, stiffness and drag are not printed; the flume here is a choice, so statements on slopes,
ratios and shapes are tested, no level. Statement 11 (the model lies slightly above the tests) needs the measured
points, which are not published as numbers; what can be held is on which side the idealisations err.
"""

from __future__ import annotations

import importlib.util
import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from kept_runs import kept_value

from moyai.design.similarity import Scale, scale_water
from moyai.reproduce.inputs import problem_of
from moyai.reproduce.sawaragi.runs import SawaragiRuns, span_of
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import closed_form, edge_impact, impact_numbers, peak_by_energy
from moyai.structures.curtain.impact.cycles import slack_taut_motion

FOLDER = Path(__file__).resolve().parents[2] / "examples" / "curtain"


def example(name):
    spec = importlib.util.spec_from_file_location(f"statement_{name}", FOLDER / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # dataclasses look their module up
    spec.loader.exec_module(module)
    return module


SNAP, SWEEP, MASS = example("snap_in_current"), example("tension_coefficient"), example("added_mass")


def log_slope(of, name, at, step=1e-3):
    """d log T / d log x of the peak tension about a value of one parameter."""
    low, high = at * (1.0 - step), at * (1.0 + step)
    return math.log(of(**{name: high}) / of(**{name: low})) / math.log(high / low)


def peak(stiffness=150.0, **changed):
    return peak_by_energy(replace(SWEEP.with_stiffness(SWEEP.FLUME, stiffness), **changed)).tension


@pytest.mark.parametrize("stiffness", [150.0, 39000.0])
def test_statement_1_spike_then_steady_level(stiffness):
    """Slack, then a spike when taut, then the drag level; both cables spike together, alike in shape."""
    record = SNAP.release(stiffness)
    motion = record.motion
    before = motion.time < record.taut - 1e-9
    assert np.all(motion.tension[before] == 0.0)
    assert record.spike > 2.0 * record.plateau
    # the cable carries half rho C_D d U^2 at its catenary parameter T/sigma: 2.92 N, stretch lowers it a little
    flume = SNAP.flume(stiffness)
    assert record.plateau == pytest.approx(2.92, rel=0.08)
    late = motion.tension[motion.time > 0.9 * motion.time[-1]]
    assert np.ptp(late) < 0.02 * record.plateau
    edges = edge_impact(flume, duration=1.5 * record.rise)
    upper, lower = (edges.time[np.argmax(tension)] for tension in (edges.upper_tension, edges.lower_tension))
    assert upper == pytest.approx(lower, rel=0.06 if stiffness > 1e4 else 0.02)
    rising = edges.time <= min(upper, lower)
    shape = [tension[rising] / tension.max() for tension in (edges.upper_tension, edges.lower_tension)]
    assert np.max(np.abs(shape[0] - shape[1])) < 0.08


def test_statement_2_steel_is_sharper_and_higher_at_the_same_level():
    line, steel = SNAP.release(150.0), SNAP.release(39000.0)
    assert steel.spike > 10.0 * line.spike
    assert 10.0 < line.rise / steel.rise < 20.0
    assert steel.plateau / line.plateau == pytest.approx(1.0, abs=0.2)
    without_drag = [peak_by_energy(SNAP.flume(total)) for total in (150.0, 39000.0)]
    assert without_drag[0].time / without_drag[1].time == pytest.approx(229.76 / 15.95, rel=2e-3)


# Kd: M/M0 and N/(omega M0) at h/d = 10 and 3, by an eigenfunction expansion with a Galerkin velocity in the gap
PLATE = {
    0.1: ((2.7125, 0.0518), (2.7748, 0.1790)),
    0.3: ((3.3762, 0.5178), (3.2294, 0.6342)),
    0.5: ((3.6389, 1.7709), (3.4964, 1.6465)),
    0.7: ((2.6742, 2.9419), (2.7460, 2.8391)),
    1.0: ((0.9909, 2.7650), (1.0148, 2.7876)),
    2.0: ((0.2071, 1.1248), (0.2068, 1.1248)),
    4.0: ((0.4335, 0.3693), (0.4335, 0.3693)),
    10.0: ((0.7618, 0.0628), (0.7618, 0.0628)),
    30.0: ((0.9258, 0.0070), (0.9258, 0.0070)),
}


@pytest.mark.parametrize(("column", "relative_depth"), [(0, 10.0), (1, 3.0)])
def test_statement_3_added_mass_tends_to_the_flat_plate_at_high_frequency(column, relative_depth):
    """From below and slowly, through a minimum of 0.207 at Kd = 2; N falls as 4 rho g^2/omega^3."""
    number = np.array(list(PLATE))
    water = Water(relative_depth * MASS.DRAUGHT, 1000.0, 9.81)
    mass, damping = MASS.against_frequency(math.inf, number, water)
    printed = np.array([row[column] for row in PLATE.values()])
    # the reference was computed to three digits at small and large Kd
    assert mass == pytest.approx(printed[:, 0], rel=1.5e-3)
    assert damping == pytest.approx(printed[:, 1], rel=3e-3)
    high = np.array([20.0, 40.0, 80.0])
    mass, damping = MASS.against_frequency(math.inf, high, water)
    assert np.all(np.diff(mass) > 0.0) and np.all(mass < 1.0) and mass[-1] > 0.96
    omega = np.sqrt(high * water.gravity / MASS.DRAUGHT)
    tail = damping * omega * MASS.flat_mass(MASS.DRAUGHT) * omega**3
    assert tail[-1] == pytest.approx(4.0 * water.density * water.gravity**2, rel=0.01)


def test_statement_4_half_circle_about_one_and_four_tenths():
    masses, lengths = MASS.against_curvature(np.array([0.0]))
    assert masses[0, 0] == pytest.approx(1.4609, abs=2e-4)
    assert 1.40 < masses[0, 0] < 1.50
    assert masses[0, 0] / lengths[0] ** 2 == pytest.approx(0.592, abs=1e-3)


def test_statement_5_stretching_skirt_falls_with_the_centre_distance():
    distance = np.array([0.05, 0.1, 0.2, 0.3, 0.5, 1.0, 2.0])
    masses, lengths = MASS.against_curvature(distance)
    for values in masses[1:]:
        over_arc = values / lengths**2
        assert np.all(np.diff(over_arc) < 0.0)
        assert np.all(over_arc < 0.6) and np.all(over_arc[distance >= 1.0] < 0.1)


def test_statement_6_coefficient_falls_with_the_froude_number():
    for stiffness in (SWEEP.LINE, SWEEP.STEEL):
        found = SWEEP.against_froude(stiffness)
        assert np.all(np.diff(found.energy) < 0.0)
        assert -1.03 < SWEEP.slope(found, 0.05, 0.25) < -0.97


def test_statement_7_coefficient_hardly_depends_on_the_depth_ratio():
    found = SWEEP.against_draught(SWEEP.LINE)
    ends = np.interp([0.25, 0.5], found.x, found.energy)
    assert ends[0] / ends[1] == pytest.approx(1.011, abs=1e-3)
    stiff = SWEEP.against_draught(SWEEP.STEEL)
    assert np.ptp(stiff.energy) / stiff.energy.mean() < 0.002


def test_statement_8_coefficient_nearly_proportional_to_the_span_ratio():
    for stiffness in (SWEEP.LINE, SWEEP.STEEL):
        found = SWEEP.against_span_ratio(stiffness)
        for low, high in ((0.8, 0.85), (0.85, 0.9), (0.9, 0.95)):
            assert 0.84 < SWEEP.slope(found, low, high) < 0.95


def test_statement_9_coefficient_is_a_straight_line_in_the_elastic_number():
    found = SWEEP.against_stiffness()
    # the closed form is a straight line through the origin; hardening takes 0.26 % off it at a strain of one per cent
    strains = np.array(
        [
            peak_by_energy(span).tension / span.stiffness
            for span in (SWEEP.with_stiffness(SWEEP.FLUME, float(value)) for value in np.geomspace(20.0, 60000.0, 45))
        ]
    )
    small = strains < 0.01
    assert small.sum() > 10
    assert np.max(np.abs(found.energy[small] / found.small[small] - 1.0)) < 2.8e-3
    assert np.ptp(found.small / found.x) < 1e-9 * found.small.max()


@pytest.mark.parametrize(
    ("name", "at", "stiffness", "expected"),
    [
        ("speed", 0.30, 150.0, 0.984),
        ("draught", 0.15, 150.0, 0.984),
        ("stiffness", 150.0, None, 0.508),
        ("speed", 0.30, 1e4, 0.998),
        ("draught", 0.15, 1e4, 0.998),
        ("stiffness", 1e4, None, 0.501),
    ],
)
def test_statement_10_tension_goes_with_speed_draught_and_root_of_stiffness(name, at, stiffness, expected):
    def tension(**changed):
        return peak(**({"stiffness": stiffness} if stiffness else {}), **changed)

    assert log_slope(tension, name, at) == pytest.approx(expected, abs=1e-3)


@pytest.mark.parametrize(("stiffness", "expected"), [(150.0, 0.874), (1e4, 0.897)])
def test_statement_10_tension_against_the_span_ratio(stiffness, expected):
    def tension(ratio):
        return peak(stiffness, length=0.7 / ratio)

    # the reference states three digits and not its step; the derivative itself is 0.0011 and 0.0019 higher
    assert log_slope(tension, "ratio", 0.7 / 0.8) == pytest.approx(expected, abs=2.5e-3)


def test_statement_11_what_the_idealisations_add():
    """The model above the tests: deep-water mass of a rigid flat plate, no drag. Each is larger than what it replaces.

    Drag while the cable stretches would add to the spike, the start below the speed of the flow takes from it: released
    by itself the curtain is slower than the current when it becomes taut, and its spike is lower than model A.
    """
    record = SNAP.release(150.0)
    first = record.motion.contacts[0]
    assert 0.5 * SNAP.CURRENT < first.speed < SNAP.CURRENT
    assert record.spike < peak_by_energy(SNAP.flume(150.0)).tension
    assert closed_form(SNAP.flume(150.0)).tension > peak_by_energy(SNAP.flume(150.0)).tension


@pytest.mark.parametrize("length", [10.0, 25.0, 50.0])
def test_statement_12_scale_law_of_the_cube(length):
    """(EA)_m/(EA)_p = S^-3 gives T S^3, also with drag and the slack phase, step by step."""
    scale = Scale(length, 1.0, 1.0)
    small = SNAP.flume(150.0)
    large = replace(
        small,
        **{name: scale.to_prototype(getattr(small, name), "m") for name in ("span", "length", "draught")},
        **{name: scale.to_prototype(getattr(small, name), "N") for name in ("upper_stiffness", "lower_stiffness")},
        speed=scale.to_prototype(small.speed, "m/s"),
        water=scale_water(small.water, Scale(1.0 / length, 1.0, 1.0)),
    )
    ratio = peak_by_energy(large).tension / peak_by_energy(small).tension
    assert ratio == pytest.approx(length**3, rel=1e-12)
    assert impact_numbers(large, ratio).cauchy_number == pytest.approx(
        impact_numbers(small, 1.0).cauchy_number, rel=1e-12
    )
    root = math.sqrt(length)
    motions = [
        slack_taut_motion(span, drag_coefficient=1.2, current=0.3 * k, velocity_amplitude=0.2 * k, period=4.0 * k,
                          duration=12.0 * k, time_step=0.004 * k)
        for span, k in ((small, 1.0), (large, root))
    ]  # fmt: skip
    assert np.max(np.abs(motions[1].tension / length**3 - motions[0].tension)) < 1e-7 * motions[0].tension.max()


@pytest.mark.slow
def test_the_whole_span_let_go_slack_comes_to_the_level_of_drag():
    """One spike, whose height and instant stand on a finer mesh; the steady level is the catenary's 2.92 N."""
    case = problem_of("sawaragi", "flume")
    runs = SawaragiRuns(span_of(case), case, 5, (12, 4))
    coarse = kept_value(f"whole span of the flume, {runs.cells} cells", lambda: runs.whole_line)
    assert coarse.plateau == pytest.approx(2.92, rel=0.08)
    assert coarse.spikes() == 1
    # two thirds of the way from these cells to half of them, and two thirds of 5 %
    fine = runs.span_released(150.0, (18, 6), duration=1.8)
    assert fine.spike == pytest.approx(coarse.spike, rel=0.033)
    assert fine.spike_time == pytest.approx(coarse.spike_time, rel=0.033)
    assert np.all(np.diff(fine.before_spike()) > 0.0)
    assert fine.before_spike()[0] > 0.0
    half_way = runs.span_released(150.0, (12, 4), share=0.5, duration=2.5)
    assert half_way.spikes() == 1
