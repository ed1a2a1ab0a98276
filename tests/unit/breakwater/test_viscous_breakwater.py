"""Viscous damping of a breakwater case: what is the default, what carries the band, time against frequency."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.yaml_reader import parse_yaml
from moyai.sea.spectra import jonswap
from moyai.sea.states import IrregularSea, RegularSea
from moyai.structures.breakwater.assembly import assemble
from moyai.structures.breakwater.model import Damping, MooringSpring
from moyai.structures.breakwater.run import run
from moyai.structures.breakwater.settings import BreakwaterSettings, TimeSettings
from moyai.structures.breakwater.viscous_damping import unit_drag_rows, viscous_notices

CASE = """\
moyai: 1
title: Box
site: {water_depth: 12 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
waves: {kind: regular, height: 1 m, periods: [5], heading_deg: 0}
structure:
  kind: breakwater
  length: 40 m
  section: {shape: rectangle, beam: 20 m, height: 3.6 m}
  draught: 2.4 m
  centre_of_gravity_above_keel: 1.8 m
  roll_gyradius: 6 m
DAMPING
analyses: [statics]
settings: {drift: false}
"""


def damping_of(text):
    document = parse_yaml(CASE.replace("DAMPING", text), "box.yaml")
    return build(case_of(document, Path("box.yaml"))).breakwater.damping


@pytest.mark.parametrize(
    ("text", "viscous", "fraction"),
    [
        ("", True, 0.0),
        ("  damping: {viscous: computed}", True, 0.0),
        ("  damping: {viscous: none}", False, 0.0),
        ("  damping: {fraction_of_critical: 0.15, modes: [roll]}", False, 0.15),
        ("  damping: {fraction_of_critical: 0.15, modes: [sway, heave]}", True, 0.15),
        ("  damping: {viscous: computed, fraction_of_critical: 0.02, modes: [roll]}", True, 0.02),
        ("  roll_damping: {quadratic: 1e6 N m s2}", False, 0.0),
        ("  roll_damping: {quadratic: 1e6 N m s2}\n  damping: {viscous: computed}", True, 0.0),
        ("  additional_damping: {sway: 10 N s/m}", True, 0.0),
    ],
)
def test_what_a_case_computes(text, viscous, fraction):
    found = damping_of(text)
    assert (found.viscous, found.fraction_of_critical) == (viscous, fraction)
    assert found.band == (0.5, 2.0)


def test_band_and_factor_of_a_case():
    found = damping_of("  damping: {viscous: computed, viscous_factor: 1.3, band: [3, 0.4]}")
    assert (found.viscous_factor, found.band) == (1.3, (0.4, 3.0))


def springs():
    return tuple(
        MooringSpring(f"spring {side}", 2, (side * 0.19, 0.0, 0.0), (side * 3.0, 0.0, -0.113), 40.0, 5.0)
        for side in (-1, 1)
    )


def changed(problem, damping, seas, analyses=("frequency",), **time):
    unit = replace(problem.breakwater, damping=damping, lines=springs(), mass=None)
    environment = replace(problem.environment, sea_states=seas)
    settings = BreakwaterSettings(drift=False, time=TimeSettings(**time))
    return replace(problem, breakwater=unit, environment=environment, analyses=analyses, settings=settings)


COMPUTED = Damping(viscous=True, band=(0.5, 2.0))
WAVES = RegularSea("waves", 0.03, (0.8, 0.92, 1.0))


def test_band_holds_the_answers_with_scaled_damping(pontoon_problem):
    """Low and high are the runs with the factor itself, the nominal one between them or an end."""
    names = ("transmission_coefficient", "motion_amplitude")
    data = run(changed(pontoon_problem, COMPUTED, (WAVES,))).tree["SWL/frequency/waves"]
    single = [
        run(changed(pontoon_problem, replace(COMPUTED, viscous_factor=factor), (WAVES,))).tree["SWL/frequency/waves"]
        for factor in (0.5, 1.0, 2.0)
    ]
    for name in names:
        every = np.array([item[name].values for item in single])
        assert data[name].values == pytest.approx(every[1], rel=1e-9)
        assert data[f"{name}_low"].values == pytest.approx(every.min(axis=0), rel=1e-9)
        assert data[f"{name}_high"].values == pytest.approx(every.max(axis=0), rel=1e-9)
    assert np.ptp([item.transmission_coefficient.values for item in single], axis=0).max() > 0.05
    assert "times 0.5 to 2" in data.attrs["damping_band"]


def test_fraction_has_a_band_and_nothing_else(pontoon_problem):
    fraction = Damping(0.15, band=(0.5, 2.0))
    data = run(changed(pontoon_problem, fraction, (WAVES,))).tree["SWL/frequency/waves"]
    for factor in (0.5, 2.0):
        other = run(changed(pontoon_problem, Damping(0.15 * factor), (WAVES,))).tree["SWL/frequency/waves"]
        assert np.all(other.transmission_coefficient.values >= data.transmission_coefficient_low.values - 1e-12)
        assert np.all(other.transmission_coefficient.values <= data.transmission_coefficient_high.values + 1e-12)
    assert data.equivalent_damping_fraction.values == pytest.approx(np.full((3, 3), 0.15), rel=1e-9)
    assert "15 % of critical" in data.attrs["damping_band"]


def test_energy_balance_counts_the_moving_water(pontoon_problem):
    result = run(changed(pontoon_problem, COMPUTED, (WAVES,)))
    found = [check for check in result.checks if "energy of the moving body" in check.name]
    assert len(found) == 2 and all(check.passed for check in found)


def test_larger_waves_are_damped_more(pontoon_problem):
    low, high = (
        run(changed(pontoon_problem, COMPUTED, (RegularSea("waves", height, (0.92,)),))).tree["SWL/frequency/waves"]
        for height in (0.01, 0.04)
    )
    assert np.all(high.equivalent_damping.values > low.equivalent_damping.values)
    assert float(high.motion_ratio[0, 2]) < float(low.motion_ratio[0, 2])


def test_long_waves_pass_a_body_that_follows_them(pontoon_problem):
    """Against the water the loss vanishes in long waves."""
    sea = RegularSea("waves", 0.02, (3.0,))
    data = run(changed(pontoon_problem, COMPUTED, (sea,))).tree["SWL/frequency/waves"]
    assert abs(float(data.dissipation[0])) < 0.01


def test_irregular_sea_carries_its_damping_and_band(pontoon_problem):
    sea = IrregularSea("sea", jonswap(0.03, 0.95, 3.3), heading=0.0, duration=200.0, seed=1)
    data = run(changed(pontoon_problem, COMPUTED, (sea,))).tree["SWL/frequency/sea"]
    assert float(data.transmission_coefficient_low) < float(data.transmission_coefficient)
    assert float(data.transmission_coefficient) < float(data.transmission_coefficient_high)
    assert np.all(data.significant_motion_low.values <= data.significant_motion.values)
    assert np.all(data.significant_motion_high.values >= data.significant_motion.values)
    assert 0.0 < float(data.equivalent_damping_fraction.sel(dof="roll")) < 0.3


@pytest.mark.slow
def test_regular_waves_in_time_are_those_of_the_frequency_domain(pontoon_problem):
    """Quadratic force against moving water as it is, against its equal-work linearisation."""
    problem = changed(pontoon_problem, COMPUTED, (replace(WAVES, periods=(0.8, 1.0)),), ("frequency", "time"))
    tree = run(problem).tree
    frequency, time = tree["SWL/frequency/waves"], tree["SWL/time/waves"]
    assert time.motion_amplitude.values == pytest.approx(frequency.motion_amplitude.values, rel=0.015)
    assert time.transmission_coefficient.values == pytest.approx(frequency.transmission_coefficient.values, abs=0.01)
    assert time.dissipation.values == pytest.approx(frequency.dissipation.values, abs=0.01)


def test_notices_and_rows_of_a_unit(pontoon_problem):
    unit = assemble(changed(pontoon_problem, COMPUTED, ()), "SWL", 0.0)
    rows, coefficients = unit_drag_rows(unit)
    assert rows.shape == (2, 3) and np.all(coefficients > 0.0)
    assert viscous_notices(unit) == ()
    measured = replace(unit, breakwater=replace(unit.breakwater, damping=replace(COMPUTED, roll_quadratic=2.0)))
    rows, coefficients = unit_drag_rows(measured)
    assert rows[-1] == pytest.approx([0.0, 0.0, 1.0]) and coefficients[-1] == 2.0
