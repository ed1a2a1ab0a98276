"""Sawaragi, Aoki and Liu (1991), impact tension: statements of the paper and numbers of independent prototypes.

The paper leaves stiffnesses and depths of the experiment open; the flume case here is a choice, and only slopes and
ratios are statements of the paper. Its iteration was reported to fail for every omega dt up to sqrt 2; with the spring
hardening within the step it already converges at 1.3 (the border counts with the stiffness at the end of the step).
"""

import math
from typing import get_args

import numpy as np
import pytest

from moyai.sea.water import Water
from moyai.series.snap_record import read_snap
from moyai.structures.curtain.impact.cable import (
    Impact,
    closed_form,
    edge_impact,
    impact_numbers,
    peak_by_energy,
    speed_factor,
)
from moyai.structures.curtain.impact.march import iterate_first_step, march_impact
from moyai.structures.curtain.impact.release import slack_phase, snap_in_current
from moyai.structures.curtain.impact.skirt import BulgedSkirt, Variant, cable_and_skirt_impact, skirt_impact
from moyai.structures.curtain.statics.closed_forms import solve_cable

FREQUENCY = 6.0511


def flume(**changed):
    total = changed.pop("stiffness", 150.0)
    numbers = {"span": 0.7, "length": 0.8, "draught": 0.15, "speed": 0.3, "water": Water(0.4, 1000.0, 9.81)}
    numbers |= {"upper_stiffness": 0.5 * total, "lower_stiffness": 0.5 * total}
    return Impact(**{**numbers, **changed})


def peak(**changed):
    return peak_by_energy(flume(**changed)).tension


def slope(name, low, high, of=peak):
    return math.log(of(**{name: high}) / of(**{name: low})) / math.log(high / low)


def test_base_case():
    found, small = peak_by_energy(flume()), closed_form(flume())
    assert found.tension == pytest.approx(9.86556, abs=6e-6)
    assert found.displacement == pytest.approx(0.044927, abs=6e-7)
    assert found.time == pytest.approx(0.22976, abs=6e-6)
    assert small.tension == pytest.approx(10.0342, abs=6e-5)
    assert small.time == pytest.approx(0.25959, abs=6e-6)
    numbers = impact_numbers(flume(), found.tension)
    assert numbers.tension_coefficient == pytest.approx(2.088, abs=6e-4)
    assert numbers.cauchy_number == pytest.approx(0.4888, abs=6e-5)
    assert numbers.froude_number == pytest.approx(0.1514, abs=6e-5)


@pytest.mark.parametrize(
    ("changed", "tension"),
    [
        ({"length": 0.75}, 10.4447),
        ({"length": 1.0}, 8.16439),
        ({"length": 0.70}, 11.1160),
        ({"draught": 0.10}, 6.61289),
        ({"draught": 0.20}, 13.0853),
        ({"stiffness": 300.0}, 14.0187),
        ({"stiffness": 600.0}, 19.8942),
        ({"stiffness": 39000.0}, 161.617),
        ({"speed": 0.1}, 3.32516),
        ({"speed": 0.2}, 6.61289),
        ({"speed": 0.5}, 16.2740),
    ],
)
def test_table_of_model_a(changed, tension):
    assert peak(**changed) == pytest.approx(tension, rel=6e-6)


def test_factor_of_the_closed_form():
    ratio = [0.3, 0.5, 0.6, 0.7, 0.8, 0.85, 0.9, 0.95, 0.99]
    printed = [0.31025, 0.45300, 0.52331, 0.59420, 0.66633, 0.70304, 0.74026, 0.77806, 0.80875]
    assert speed_factor(ratio) == pytest.approx(printed, abs=6e-6)


@pytest.mark.parametrize(
    ("steps", "error"), [(1, -0.314), (4, -0.138), (16, -0.0383), (64, -0.0098), (256, -0.00246), (1024, -0.000616)]
)
def test_marching_comes_from_below(steps, error):
    exact = peak_by_energy(flume())
    marched = march_impact(flume(), time_step=exact.time / steps, duration=2.0 * exact.time)
    assert marched.peak.tension / exact.tension - 1.0 == pytest.approx(error, rel=6e-3)


def test_iteration_of_the_paper_fails_where_the_step_is_fine():
    for relative in (0.1, 0.5, 1.0):
        assert not iterate_first_step(flume(), relative / FREQUENCY, reverse=False).converged
        assert iterate_first_step(flume(), relative / FREQUENCY, reverse=True).converged
    for relative in (1.5, 2.0):
        assert iterate_first_step(flume(), relative / FREQUENCY, reverse=False).converged
        assert not iterate_first_step(flume(), relative / FREQUENCY, reverse=True).converged


def coefficient(**changed):
    return impact_numbers(flume(**changed), peak(**changed)).tension_coefficient


def test_statement_1_spike_then_steady_level_simultaneous_in_both_cables():
    """Slow drift, spike, steady level; with equal cables both spikes of A2 come within 2 % of their time."""
    snap = snap_in_current(flume(), drag_coefficient=1.2, current=0.3, position=0.0, speed=0.0, duration=60.0)
    assert snap.motion.tension[snap.motion.time < 0.99 * snap.taut_time].max() == 0.0
    assert snap.peak_tension > 2.0 * snap.plateau_tension
    assert snap.plateau_tension == pytest.approx(2.92, abs=5e-3)
    assert snap.motion.tension[-1] == pytest.approx(snap.plateau_tension, rel=1e-6)
    found = edge_impact(flume())
    times = [found.time[np.argmax(tension)] for tension in (found.upper_tension, found.lower_tension)]
    assert times[0] == pytest.approx(times[1], rel=0.02)


def test_statement_2_steel_is_sharper_and_higher_and_the_steady_level_stays():
    line, steel = peak_by_energy(flume()), peak_by_energy(flume(stiffness=39000.0))
    assert steel.tension > 10.0 * line.tension
    assert steel.time == pytest.approx(0.01595, abs=6e-6)
    assert line.time / steel.time == pytest.approx(14.4, abs=0.1)
    load = 0.5 * 1000.0 * 1.2 * 0.15 * 0.3**2
    steady = [float(solve_cable(0.7, 0.8, load, stiffness).tension) for stiffness in (150.0, 39000.0)]
    assert abs(steady[1] / steady[0] - 1.0) < 0.2


def test_statement_6_coefficient_falls_with_the_froude_number():
    assert -1.03 < slope("speed", 0.1, 0.5, coefficient) < -0.97


def test_statement_7_coefficient_hardly_depends_on_the_draught():
    assert coefficient(draught=0.10) / coefficient(draught=0.20) == pytest.approx(1.011, abs=1e-3)


def slope_in_ratio(ratio, stiffness):
    one, two = (peak(length=0.7 / (ratio + step), stiffness=stiffness) for step in (-1e-4, 1e-4))
    return math.log(two / one) / math.log((ratio + 1e-4) / (ratio - 1e-4))


def test_statement_8_coefficient_is_nearly_in_proportion_to_the_span_ratio():
    """0.87 to 0.95 from B/l = 0.8 on, where the strain is small; the soft line of the flume case stretches by 6 to 7 %.

    Its hardening takes 0.02 to 0.04 off the slope: 0.853 at 0.8, below the range, and 0.910 at 0.99.
    """
    for ratio, small in ((0.5, 0.776), (0.7, 0.841), (0.8, 0.876), (0.9, 0.912), (0.99, 0.946)):
        assert slope_in_ratio(ratio, 1e8) == pytest.approx(small, abs=6e-4)
        if ratio >= 0.8:
            assert 0.87 < slope_in_ratio(ratio, 1e8) < 0.95
    assert slope_in_ratio(0.9999, 1e12) == pytest.approx(0.95, abs=1e-3)
    for ratio, soft in ((0.8, 0.853), (0.9, 0.883), (0.99, 0.910)):
        assert slope_in_ratio(ratio, 150.0) == pytest.approx(soft, abs=1e-3)
    assert slope_in_ratio(0.875, 150.0) == pytest.approx(0.874, abs=2e-3)
    assert slope_in_ratio(0.875, 1e4) == pytest.approx(0.897, abs=2e-3)


def test_statement_9_coefficient_is_a_straight_line_in_the_cauchy_number():
    assert slope("stiffness", 149.0, 151.0) == pytest.approx(0.508, abs=1e-3)
    assert slope("stiffness", 9990.0, 10010.0) == pytest.approx(0.501, abs=1e-3)
    # within 0.2 % of the line through the origin where the strain is below 1 %
    for stiffness in (1e4, 39e3, 1e6):
        assert peak(stiffness=stiffness) / stiffness < 0.01
        assert slope("stiffness", 0.99 * stiffness, 1.01 * stiffness) == pytest.approx(0.5, rel=2.5e-3)


def test_statement_10_tension_goes_with_speed_draught_and_root_of_stiffness():
    for name, middle in (("speed", 0.3), ("draught", 0.15)):
        assert slope(name, 0.99 * middle, 1.01 * middle) == pytest.approx(0.984, abs=1e-3)

        def stiff(**changed):
            return peak(stiffness=1e4, **changed)

        assert slope(name, 0.99 * middle, 1.01 * middle, stiff) == pytest.approx(0.998, abs=1e-3)


def test_statement_11_model_a_lies_slightly_above_what_is_read_from_a_record():
    """Peak less drag level, read with perfect gauges from model A with drag, is below model A's peak."""
    for stiffness in (150.0, 1500.0, 39000.0):
        given = {"drag_coefficient": 1.2, "current": 0.3, "position": 0.0, "speed": 0.0}
        impact = flume(stiffness=stiffness)
        snap = snap_in_current(impact, **given)
        model = peak_by_energy(slack_phase(impact, **given).started(impact)).tension
        assert 1.0 < model / snap.impact_tension < 1.55


def test_statement_12_scale_law_is_the_cube():
    for scale in (10.0, 25.0, 50.0):
        large = Impact(
            0.7 * scale, 0.8 * scale, 0.15 * scale, 75 * scale**3, 75 * scale**3, 0.3 * math.sqrt(scale),
            Water(0.4 * scale, 1000.0, 9.81),
        )  # fmt: skip
        assert peak_by_energy(large).tension / peak() == pytest.approx(scale**3, rel=1e-12)


@pytest.mark.parametrize(("stiffness", "steady"), [(150.0, 2.92)])
def test_statement_13_impact_is_peak_less_drag_level_of_the_summed_cables(stiffness, steady):
    snap = snap_in_current(
        flume(stiffness=stiffness),
        drag_coefficient=1.2,
        current=0.3,
        position=0.0,
        speed=0.0,
        time_step=1e-3,
        duration=25.0,
    )
    time = np.arange(0.0, 30.0, 1e-3)
    total = np.interp(time - 2.0, snap.motion.time, snap.motion.tension, left=0.0, right=0.0)
    found = read_snap(time, [0.45 * total, 0.55 * total], unloaded=[(0.0, 1.9), (27.5, 29.9)], window=(0.0, 26.9))
    assert found.sum.plateau == pytest.approx(steady, abs=5e-3)
    assert found.impact == pytest.approx(snap.impact_tension, rel=1e-3)
    assert sum(cable.impact for cable in found.cables) == pytest.approx(found.impact, rel=1e-3)


@pytest.mark.parametrize(
    ("upper", "lower", "tensions"),
    [(75, 75, (4.616, 5.230)), (150, 150, (6.543, 7.445)), (75, 150, (5.917, 5.277)), (150, 75, (4.957, 6.285))],
)
def test_cables_apart(upper, lower, tensions):
    found = edge_impact(flume(upper_stiffness=float(upper), lower_stiffness=float(lower)), duration=0.4)
    assert (found.upper_peak, found.lower_peak) == pytest.approx(tensions, abs=6e-4)
    # sums printed for unequal cables are the largest at one instant; the separate peaks add up to more
    together = {(75, 150): 11.14, (150, 75): 10.54, (75, 75): 9.846}.get((upper, lower))
    if together is not None:
        assert found.simultaneous_peak == pytest.approx(together, abs=6e-3)
    if upper != lower:
        whole = peak(stiffness=225.0)
        assert whole == pytest.approx(12.119, abs=6e-4)
        assert 1.08 < whole / found.simultaneous_peak < 1.16
        assert found.sum_peak > found.simultaneous_peak + 0.05
    if upper == lower:
        times = [found.time[np.argmax(tension)] for tension in (found.upper_tension, found.lower_tension)]
        assert times[0] == pytest.approx(times[1], rel=0.02)


@pytest.mark.parametrize(
    ("chord", "stiffness", "rows"),
    [
        (0.135, 5e4, ((101.7, 78.5), (372.3, 287.4), (447.1, 345.0))),
        (0.135, 2e4, ((65.4, 50.5), (239.8, 185.1), (288.8, 222.9))),
        (0.12, 5e4, ((258.1, 199.2), (463.6, 357.8), (520.9, 402.0))),
        (0.1425, 5e4, ((37.8, 29.2), (288.5, 222.7), (359.9, 277.8))),
    ],
)
def test_stretching_skirt(chord, stiffness, rows):
    for variant, (load, tension) in zip(("literal", "energy_mid", "energy_proj"), rows):
        found = skirt_impact(flume(), BulgedSkirt(0.15, chord, stiffness), variant)
        assert found.edge_load == pytest.approx(load, abs=0.1)
        assert found.tension == pytest.approx(tension, abs=0.1)


@pytest.mark.parametrize(
    ("cable", "skirt", "tension"),
    [
        (150, 2e4, 9.22),
        (600, 2e4, 18.51),
        (5000, 2e4, 52.1),
        (39000, 2e4, 124.8),
        (39000, 5e4, 137.1),
        (39000, 1e6, 150.3),
    ],
)
def test_cable_and_skirt_together(cable, skirt, tension):
    found = cable_and_skirt_impact(flume(stiffness=float(cable)), BulgedSkirt(0.15, 0.135, skirt))
    assert found.tension == pytest.approx(tension, rel=6e-4)


@pytest.mark.parametrize(
    ("chord", "stiffness", "elements"),
    [(0.135, 5e4, 373.5), (0.135, 2e4, 240.6), (0.12, 5e4, 442.0), (0.1425, 5e4, 293.5)],
)
def test_stretching_skirt_against_section_finite_elements(chord, stiffness, elements):
    """Bars with the dense added mass of panels, ends held, uniform start: energy_mid within 5 %, others as stated."""
    loads = {
        name: skirt_impact(flume(), BulgedSkirt(0.15, chord, stiffness), name).edge_load for name in get_args(Variant)
    }
    assert loads["energy_mid"] == pytest.approx(elements, rel=0.05)
    assert 1.15 < loads["energy_proj"] / elements < 1.25
    assert 1.6 < elements / loads["literal"] < 8.0


def test_powers_of_the_stretching_skirt():
    def tension(speed, stiffness):
        return skirt_impact(flume(speed=speed), BulgedSkirt(0.15, 0.135, stiffness)).tension

    assert math.log(tension(0.33, 5e4) / tension(0.27, 5e4)) / math.log(0.33 / 0.27) == pytest.approx(1.04, abs=0.01)
    assert math.log(tension(0.3, 5.5e4) / tension(0.3, 4.5e4)) / math.log(5.5 / 4.5) == pytest.approx(0.48, abs=0.01)
