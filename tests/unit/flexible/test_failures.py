"""Lines that part: at their time, at their tension, what is left falls free, and energy is lost, not gained."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible import BarType, NetworkBuilder, simulate, solve_equilibrium
from moyai.flexible.failures import LineFailure
from moyai.flexible.motion import Motion
from moyai.sea.water import Water

G = 9.81


def hanging():
    """A lump of 500 kg between two wires in air: each bears its part until one goes."""
    builder = NetworkBuilder(Water(1000.0, 1e-3, G))
    wire = BarType("wire", mass_per_length=0.01, axial_stiffness=1e6, diameter=0.0, volume_per_length=0.0,
                   viscosity=1e3)  # fmt: skip
    builder.fixed("left", (-5.0, 0.0, 500.0))
    builder.fixed("right", (5.0, 0.0, 500.0))
    builder.free("lump", (0.0, 0.0, 495.0), mass=500.0)
    builder.line("one", "left", "lump", wire, length=7.0, segments=5)
    builder.line("two", "lump", "right", wire, length=7.0, segments=5)
    return builder.build()


@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
def test_at_its_time_the_line_goes_and_the_lump_swings_on_the_other(method):
    network = hanging()
    rest = solve_equilibrium(network)
    history = simulate(
        network, {}, duration=3.0, output_step=0.02, start=rest.state, method=method,
        failures=[LineFailure("two", at_end=False, time=1.0)],
    )  # fmt: skip
    assert [notice.message for notice in history.notices if notice.code == "line-parted"] == [
        "line 'two' parted at t = 1 s"
    ]
    lump = network.points["lump"]
    place = history.position[:, lump]
    before = history.time < 0.99
    np.testing.assert_allclose(place[before], np.repeat(place[:1], before.sum(), axis=0), atol=1e-4)
    bar = network.strand("two").bars[0]
    assert not history.tension[history.time > 1.05, bar].any()
    # a pendulum on the other wire: energy from rest, and a path at its length
    arm = place - np.array([-5.0, 0.0, 500.0])
    reach = np.linalg.norm(arm, axis=1)
    assert reach[~before].min() > 6.9 and reach[~before].max() < 7.2
    speed = np.gradient(place, history.time, axis=0)[-10:-1]
    fallen = place[0, 2] - place[-10:-1, 2]
    assert 0.5 * np.sum(speed**2, axis=1) == pytest.approx(G * fallen, rel=0.03)


def test_at_its_tension_it_goes_when_it_is_pulled_that_far():
    builder = NetworkBuilder(Water(100.0, 1e-3, G))
    wire = BarType("wire", mass_per_length=0.1, axial_stiffness=1e6, diameter=0.0, volume_per_length=0.0, viscosity=1e3)
    builder.fixed("left", (0.0, 0.0, 50.0))
    builder.driven("right", (10.0, 0.0, 50.0))
    builder.line("wire", "left", "right", wire, length=10.0, segments=5)
    network = builder.build()
    time = np.linspace(0.0, 11.0, 1101)
    shift = np.zeros((len(time), 3))
    shift[:, 0] = 0.02 * time
    speed = np.zeros_like(shift)
    speed[:, 0] = 0.02
    history = simulate(
        network, {"right": Motion(0.0, time[1], shift, speed)}, duration=10.0, output_step=0.05,
        start=solve_equilibrium(network).state, failures=[LineFailure("wire", at_end=True, tension=1e4)],
    )  # fmt: skip
    pull = history.tension[:, network.strand("wire").bars[-1]]
    # EA x / L = 10 kN at x = 0.1 m, t = 5 s
    assert pull[history.time < 4.9].max() == pytest.approx(9.8e3, rel=0.02)
    assert not pull[history.time > 5.1].any()


def test_what_cannot_be_is_refused():
    with pytest.raises(InputError, match="parts at inf s or inf N"):
        LineFailure("a", at_end=True)
    with pytest.raises(InputError, match="no strand 'three'"):
        simulate(hanging(), {}, duration=0.1, output_step=0.1, failures=[LineFailure("three", at_end=True, time=1.0)])
    assert math.isinf(LineFailure("a", at_end=True, time=1.0).tension)
