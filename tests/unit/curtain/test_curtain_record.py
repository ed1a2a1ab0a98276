"""A record against the impact models: ratios, series, notices."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy
from moyai.structures.curtain.impact.compare import check_skirt, compare_models
from moyai.structures.curtain.impact.record import compare_record, model_series
from moyai.structures.curtain.impact.release import snap_in_current
from moyai.structures.curtain.impact.skirt import BulgedSkirt, cable_and_skirt_impact, curved_impact


def flume(stiffness=1500.0, **changed):
    numbers = {"span": 0.7, "length": 0.8, "draught": 0.15, "speed": 0.3, "water": Water(0.4, 1000.0, 9.81)}
    numbers |= {"upper_stiffness": 0.5 * stiffness, "lower_stiffness": 0.5 * stiffness}
    return Impact(**{**numbers, **changed})


def test_ratios_are_model_over_record():
    table = compare_models(flume(), BulgedSkirt(0.15, 0.135, 5e4))
    found = compare_record(table, impact_tension=30.0, rise_time=0.08, upper_impact=14.0, lower_impact=16.0)
    assert [line.model for line in found.lines if line.model.startswith("A2")] == ["A2", "A2 upper", "A2 lower"]
    for line in found.lines:
        if not line.model.startswith("A2 "):
            assert line.tension_ratio == pytest.approx(table.tension(line.model) / 30.0)
            assert line.time_ratio == pytest.approx(line.time / 0.08)
    assert not found.notices
    best = min(abs(math.log(line.tension_ratio)) for line in found.lines)
    assert abs(math.log(found.nearest.tension_ratio)) == best


def test_record_outside_all_models_is_reported():
    table = compare_models(flume(), memory=False)
    for impact, word in ((1.0, "outside"), (1e4, "outside")):
        found = compare_record(table, impact_tension=impact, rise_time=math.nan)
        assert word in found.notices[0].message
        assert math.isnan(found.lines[0].time_ratio)
    for bad in ({"impact_tension": -1.0}, {"impact_tension": 5.0, "rise_time": 0.0}, {"impact_tension": math.nan}):
        with pytest.raises(InputError):
            compare_record(table, **({"rise_time": 0.1} | bad))


def test_series_reach_the_peaks_of_their_models():
    impact = flume()
    table, series = compare_models(impact), model_series(impact, drag_coefficient=1.2, current=0.3)
    tops = {item.model: float(item.tension.max()) for item in series}
    for name in ("A", "A2", "A with memory"):
        assert tops[name] == pytest.approx(table.tension(name), rel=2e-3)
    assert tops["A with drag"] == pytest.approx(table.tension("A"), rel=0.1)
    assert all(item.time[0] == 0.0 for item in series)
    assert [item.model for item in model_series(impact, memory=False)] == ["A", "A2"]


def test_plateau_taken_off_explains_that_model_a_lies_above_records():
    """Statement 11 of the paper: impact = peak less drag level is below the peak of model A, with perfect gauges."""
    impact = flume(150.0)
    snap = snap_in_current(impact, drag_coefficient=1.2, current=0.3, position=0.0, speed=0.0)
    model = peak_by_energy(flume(150.0, speed=snap.start_speed)).tension
    assert 1.0 < model / snap.impact_tension < 1.6
    assert model < snap.peak_tension


@pytest.mark.slow
def test_finite_depth_raises_all_masses():
    """At h/d = 1.05 the flat plate has 1.127 M0; every model but the paper's A follows."""
    deep, shallow = flume(draught=0.38, water=Water(9.0, 1000.0, 9.81)), flume(draught=0.38)
    skirt = BulgedSkirt(0.41, 0.38, 5e4)
    one, two = (compare_models(item, skirt, memory=False) for item in (deep, shallow))
    assert two.tension("A") == one.tension("A")
    ratio = two.tension("A in this depth") / one.tension("A in this depth")
    assert 1.05 < ratio < math.sqrt(1.127) + 1e-3
    for model in ("A2", "A curved skirt", "B energy_mid", "AB"):
        assert 1.01 < two.tension(model) / one.tension(model) < 1.1
    assert {"impact-bed", "impact-arc-bed"} <= {item.code for item in two.notices}


def test_stiff_skirts_cost_nothing_and_meet_the_rigid_limit():
    """From 1e2 to 1e12 N/m: monotone up to model A with the arc's mass; the rigid limit is reported."""
    impact = flume(39000.0)
    stiffness = [3e3, 2e4, 1e5, 1e6, 1e7, 1e9, 1e12]
    found = [cable_and_skirt_impact(impact, BulgedSkirt(0.15, 0.135, value)) for value in stiffness]
    tensions = [item.tension for item in found]
    assert all(np.diff(tensions) >= -1e-9 * tensions[0])
    rigid = curved_impact(impact, BulgedSkirt(0.15, 0.135, 1e12)).tension
    assert tensions[-1] == rigid
    # the change falls with the square of the frequency ratio, that is with the stiffness
    assert (1.0 - tensions[4] / rigid) / (1.0 - tensions[3] / rigid) == pytest.approx(0.1, rel=0.1)
    assert [item.code for item in found[-1].notices] == ["impact-rigid-skirt"]
    assert found[-2].skirt_tension == pytest.approx(found[3].skirt_tension, rel=0.05)


def test_skirt_notices():
    impact = flume(39000.0)
    skirt = BulgedSkirt(0.15, 0.135, 2e3)
    both = cable_and_skirt_impact(impact, skirt)
    codes = {item.code for item in check_skirt(impact, skirt, both, 400.0)}
    assert codes == {"impact-soft-skirt", "impact-skirt-strain"}
    assert both.notices[0].code == "impact-frozen-mass"
    stiff = BulgedSkirt(0.15, 0.135, 1e6)
    assert not check_skirt(flume(150.0), stiff, cable_and_skirt_impact(flume(150.0), stiff), 10.0)


@pytest.mark.slow
def test_soft_skirt_leaves_no_false_alarm_below_two_percent():
    """The heuristic: sagitta increment below 2 % of the cable's way means AB within 1.5 % of A with the arc's mass."""
    rng = np.random.default_rng(3)
    seen = 0
    for _ in range(60):
        impact = flume(10.0 ** rng.uniform(1.5, 4.5), speed=rng.uniform(0.1, 0.5))
        skirt = BulgedSkirt(0.15, 0.15 * rng.choice([0.8, 0.9, 0.95]), 10.0 ** rng.uniform(3.5, 6.0))
        both = cable_and_skirt_impact(impact, skirt)
        if both.sagitta_increment < 0.02 * both.displacement:
            seen += 1
            assert both.tension == pytest.approx(curved_impact(impact, skirt).tension, rel=0.015)
    assert seen > 15


def test_skirt_deeper_than_the_water_is_refused():
    with pytest.raises(InputError, match="clear of the bed"):
        compare_models(flume(), BulgedSkirt(0.5, 0.45, 5e4), memory=False)
