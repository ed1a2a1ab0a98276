"""Slack and taut cycles against the water at rest, the static cable, energy and the order of the scheme."""

import itertools
import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy, speed_factor
from moyai.structures.curtain.impact.cycles import slack_taut_motion
from moyai.structures.curtain.statics.closed_forms import solve_cable


def flume(stiffness=150.0, speed=0.3):
    return Impact(0.7, 0.8, 0.15, 0.5 * stiffness, 0.5 * stiffness, speed, Water(0.4, 1000.0, 9.81))


def run(impact, current, amplitude, period, **options):
    options = {"duration": 12 * period, "drag_coefficient": 1.2} | options
    return slack_taut_motion(impact, current=current, velocity_amplitude=amplitude, period=period, **options)


def test_small_excursion_never_becomes_taut():
    amplitude = 0.143 * math.pi / 4.0
    assert run(flume(), 0.0, amplitude, 4.0, start=(-0.0715, 0.0)).tension.max() == 0.0


@pytest.mark.parametrize("period", [4.0, 6.0, 8.0])
def test_contacts_alternate_and_peak_as_model_a(period):
    impact = flume()
    found = run(impact, 0.0, 0.573 * math.pi / period, period, start=(-0.2865, 0.0))
    late = [contact for contact in found.contacts if contact.time > 2 * period and contact.first]
    assert len(late) >= 16
    assert all(a.side == -b.side for a, b in itertools.pairwise(late))
    scale = float(speed_factor(impact.span_ratio)) * math.sqrt(impact.deep_mass * impact.stiffness)
    ratios = [contact.tension / (abs(contact.speed) * scale) for contact in late]
    assert 0.9 < min(ratios) <= max(ratios) < 1.15


@pytest.mark.parametrize("seed", range(4))
def test_steady_current_ends_at_the_static_cable(seed):
    rng = np.random.default_rng(seed)
    impact = flume(10.0 ** rng.uniform(1.5, 3.0))
    current, drag = rng.uniform(0.2, 0.5), rng.uniform(1.0, 2.0)
    found = run(impact, current, 0.0, 1.0, duration=120.0, drag_coefficient=drag)
    static = solve_cable(0.7, 0.8, 0.5 * 1000.0 * drag * 0.15 * current**2, impact.stiffness)
    # Quadratic drag about the mean flow damps linearly: all motion has died out
    assert found.tension[-1] == pytest.approx(float(static.tension), rel=1e-6)
    assert found.tension.max() > 1.2 * found.tension[-1]


def test_spike_then_plateau_of_the_base_case():
    found = run(flume(), 0.3, 0.0, 1.0, duration=60.0)
    assert found.tension[-1] == pytest.approx(2.92, abs=6e-3)


@pytest.mark.parametrize("seed", range(3))
def test_without_drag_the_contact_is_model_a(seed):
    rng = np.random.default_rng(seed)
    impact = flume(10.0 ** rng.uniform(2, 4), rng.uniform(0.1, 0.5))
    found = run(impact, 0.0, 0.0, 1.0, duration=6.0, drag_coefficient=0.0, start=(0.0, impact.speed), time_step=2e-4)
    assert found.contacts[0].speed == pytest.approx(impact.speed, rel=1e-4)
    assert found.contacts[0].tension == pytest.approx(peak_by_energy(impact).tension, rel=1e-4)
    slack = found.tension == 0.0
    assert np.abs(found.speed[slack]) == pytest.approx(impact.speed, rel=1e-6)


def test_numbers_out_of_range_are_refused():
    with pytest.raises(InputError, match="period"):
        run(flume(), 0.0, 0.1, 0.0, duration=1.0)
    with pytest.raises(InputError, match="drag"):
        run(flume(), 0.0, 0.1, 1.0, drag_coefficient=-1.0)
