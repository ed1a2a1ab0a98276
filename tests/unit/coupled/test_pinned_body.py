"""A body that turns about a pin."""

import math

import numpy as np
import pytest
from scipy.special import ellipk

from moyai.core.errors import InputError
from moyai.coupled.equilibrium import find_coupled_equilibrium
from moyai.coupled.rigid import RigidBody
from moyai.coupled.simulate import simulate_coupled
from moyai.flexible.build import NetworkBuilder
from moyai.sea.water import Water

WATER = Water(50.0, 1e-9, 9.81)


def nothing():
    builder = NetworkBuilder(WATER)
    builder.fixed("site", (0.0, 0.0, -50.0))
    return builder.build()


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_swings_with_the_exact_period_and_hangs_below_its_pin(seed):
    """Large swing of a compound pendulum: elliptic integral; the mass needs not lie on an axis of the body."""
    random = np.random.default_rng(seed)
    arm, pin = random.uniform(-1.0, 1.0, 3) * (1.0, 0.0, 1.0), random.uniform(-1.0, 1.0, 3)
    mass, inertia, place = random.uniform(1.0, 50.0), random.uniform(1.0, 1.5, 3), random.uniform(-5.0, 5.0, 3)
    length = float(np.linalg.norm(arm))
    # the mass stands at an angle from straight below the pin
    swing = random.uniform(0.3, 2.5)
    pitch = math.pi - swing - math.atan2(arm[0], arm[2])
    body = RigidBody("bob", mass, inertia, pin + arm, place, (0.0, pitch, 0.0), pin=pin)
    about = inertia[1] + mass * length**2
    period = 4.0 * math.sqrt(about / (mass * 9.81 * length)) * ellipk(math.sin(0.5 * swing) ** 2)
    step = period / 400.0
    history = simulate_coupled(nothing(), {"bob": body}, duration=2.1 * period, output_step=step)
    turn = history.bodies["bob"].rotation
    held = history.bodies["bob"].position + turn @ pin
    assert np.abs(held - held[0]).max() < 1e-12
    hang = turn @ arm
    angle = np.arctan2(hang[:, 0], -hang[:, 2])
    cut = np.flatnonzero(angle[:-1] * angle[1:] < 0.0)
    times = history.time[cut] - angle[cut] * step / (angle[cut + 1] - angle[cut])
    assert 2.0 * np.diff(times).mean() == pytest.approx(period, rel=1e-5)
    rest = find_coupled_equilibrium(nothing(), {"bob": body}).bodies["bob"]
    assert rest.start_rotation @ (arm / length) == pytest.approx([0.0, 0.0, -1.0], abs=1e-6)


def test_a_pin_is_three_numbers():
    with pytest.raises(InputError, match="pin"):
        RigidBody("bob", 1.0, (1.0, 1.0, 1.0), pin=(0.0, 1.0))
