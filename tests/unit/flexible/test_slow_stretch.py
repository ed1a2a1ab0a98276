"""Ropes that give way slowly against the standard linear solid: creep, relaxation, loss angle; and they never gain."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible import BarType, NetworkBuilder, simulate, solve_equilibrium
from moyai.flexible.elements import SlowStretch
from moyai.flexible.motion import Motion
from moyai.sea.water import Water

STATIC, QUICK, DAMPING = 1.4e6, 3.5e6, 4.0e6
SLOW = 1.0 / (1.0 / STATIC - 1.0 / QUICK)
FADE = DAMPING / SLOW  # of a load that stays: 1.714 s


def rope(growth=0.0, **extra):
    return BarType(
        "rope", mass_per_length=1.0, axial_stiffness=QUICK, diameter=0.0, volume_per_length=0.0, viscosity=2e4,
        slow=SlowStretch(STATIC, DAMPING, growth), **extra,
    )  # fmt: skip


def pulled(kind, length=10.0, first=10.05):
    builder = NetworkBuilder(Water(100.0, 1e-3, 9.81))
    builder.fixed("left", (0.0, 0.0, 50.0))
    builder.driven("right", (first, 0.0, 50.0))
    builder.line("rope", "left", "right", kind, length=length, segments=4)
    return builder.build()


def motion(time, shift):
    place = np.zeros((len(time), 3))
    place[:, 0] = shift
    speed = np.zeros_like(place)
    speed[:, 0] = np.gradient(shift, time)
    return Motion(float(time[0]), float(time[1] - time[0]), place, speed)


@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
def test_a_step_of_strain_relaxes_to_the_static_stiffness(method):
    network = pulled(rope())
    rest = solve_equilibrium(network)
    sag = float(rest.tension.mean()) / (STATIC * 0.005)
    assert sag == pytest.approx(1.0, abs=2e-3)
    time = np.linspace(0.0, 12.0, 2401)
    rise = 0.2
    shift = 0.1 * np.clip(time / rise, 0.0, 1.0)
    history = simulate(
        network, {"right": motion(time, shift)}, duration=11.0, output_step=0.05, start=rest.state, method=method
    )
    assert history.status == "converged"
    # exact: the strain rises evenly in `rise`, then stays; stress of the solid by its relaxation modulus
    tau = DAMPING / (SLOW + QUICK)
    t = history.time
    rate = 0.01 / rise

    def ramp(t):
        past = np.maximum(t, 0.0)
        return rate * (STATIC * past + (QUICK - STATIC) * tau * (1.0 - np.exp(-past / tau)))

    exact = STATIC * 0.005 + ramp(t) - ramp(t - rise)
    found = history.tension.mean(axis=1)
    later = t > 0.5  # waves along the rope after the kinks of the motion have died
    assert float(np.abs(found - exact)[later].max()) < 0.01 * exact.max()
    assert found[-1] == pytest.approx(STATIC * 0.015, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("period", [2.0, 10.0, pytest.param(60.0, marks=pytest.mark.slow)])
def test_slow_and_quick_swings_have_the_stiffness_and_the_loss_of_the_solid(period):
    network = pulled(rope(), first=10.2)
    omega = 2.0 * math.pi / period
    time = np.linspace(0.0, 6.0 * period + 20.0, 40001)
    history = simulate(
        network, {"right": motion(time, 0.05 * np.sin(omega * time))}, duration=5.0 * period + 10.0,
        output_step=period / 100.0, start=solve_equilibrium(network).state,
    )  # fmt: skip
    last = history.time > 3.0 * period + 10.0
    t, force = history.time[last], history.tension.mean(axis=1)[last]
    basis = np.stack([np.ones_like(t), np.sin(omega * t), np.cos(omega * t)], axis=1)
    _, along, across = np.linalg.lstsq(basis, force, rcond=None)[0]
    quick = QUICK + 1j * omega * 2e4
    modulus = 1.0 / (1.0 / quick + 1.0 / (SLOW + 1j * omega * DAMPING)) * 0.005
    assert along == pytest.approx(modulus.real, rel=0.01)
    assert across == pytest.approx(modulus.imag, abs=0.012 * abs(modulus))


def test_a_stiffness_that_grows_is_that_of_the_tension_at_rest():
    network = pulled(rope(growth=50.0), first=10.1)
    tension = STATIC * 0.01
    time = np.linspace(0.0, 3.0, 3001)
    history = simulate(
        network, {"right": motion(time, 0.02 * np.clip(time / 0.05, 0.0, 1.0))}, duration=0.1, output_step=0.01,
        start=solve_equilibrium(network).state,
    )  # fmt: skip
    jump = float(history.tension[-4:].mean()) - tension
    fast = QUICK + 50.0 * tension
    assert jump == pytest.approx(fast * 0.002, rel=0.12)
    assert jump > 1.04 * QUICK * 0.002


def test_what_cannot_be_is_refused():
    with pytest.raises(InputError, match="static stiffness of 'rope'"):
        BarType("rope", 1.0, 1e6, 0.1, slow=SlowStretch(2e6, 1e6))
    with pytest.raises(InputError, match="viscosity of a slow rope"):
        SlowStretch(1e6, 0.0)
