"""Elastic string stopped by its end mass: the exact series of reflected waves.

At rest and unstressed, one end fixed, the mass at the other end gets a speed V. With T0 = V sqrt(EA m) the wave from
the
mass obeys s' = r' - k (s + r), k = sqrt(EA m) / M, r(t) = s(t - 2L/c); the fixed end feels 2 s(t - L/c). In units L =
c = T0 = 1
every interval of 2 is a polynomial times exp(-k t). Until the string goes slack; for M/(mL) <= 5 the highest value is
2 (1 + exp(-2 m L / M)) at t = 3 L/c (Saint-Venant's problem of the struck bar).
"""

import math

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water

SPAN = 2.0


def exact_peak(ratio, intervals=30):
    """Highest tension at the fixed end before the string goes slack, over T0, and when, over L/c."""
    k = 1.0 / ratio
    waves = [Polynomial([0.0]), Polynomial([1.0])]
    for _ in range(intervals):
        inner = (waves[-1].deriv() - 2.0 * k * waves[-1]).integ()
        # the speed of the mass is continuous: the wave jumps with the reflected front
        start = math.exp(-k * SPAN) * (waves[-1](SPAN) - waves[-2](SPAN)) + waves[-1](0.0)
        waves.append(inner + start)
    best, when = 0.0, 0.0
    for n, wave in enumerate(waves[1:]):
        local = np.linspace(0.0, SPAN, 4001)
        tension = 2.0 * np.exp(-k * local) * wave(local)
        stop = int(np.argmax(tension < 0.0)) if (tension < 0.0).any() else tension.size
        if stop and tension[:stop].max() > best:
            best, when = float(tension[:stop].max()), 1.0 + SPAN * n + float(local[int(np.argmax(tension[:stop]))])
        if stop < tension.size:
            break
    return best, when


def computed_peak(ratio, segments, *, span=50.0, stiffness=2e7, mass=3.0, speed=1.0, travels=8.0):
    """Highest tension of the bar at the fixed end over T0, at the pace of the wave (Courant number 1)."""
    builder = NetworkBuilder(Water(math.inf, 1000.0, 1e-12))
    builder.fixed("wall", (0.0, 0.0, -500.0))
    builder.free("mass", (span, 0.0, -500.0), mass=ratio * mass * span)
    builder.line("string", "wall", "mass", BarType("string", mass, stiffness, 1e-9), length=span, segments=segments)
    network = builder.build()
    velocity = np.zeros((len(network.nodes), 3))
    velocity[network.point("mass"), 0] = speed
    pace = span / segments / math.sqrt(stiffness / mass)
    history = simulate(
        network, duration=math.ceil(travels) * segments * pace, output_step=segments * pace, safety=1.0,
        start=State(0.0, np.array(network.nodes.position), velocity), keep_bars=[0], keep_nodes=[0],
    )  # fmt: skip
    assert history.step == pytest.approx(pace, rel=1e-9)
    return float(history.tension_peak.max()) / (speed * math.sqrt(stiffness * mass))


@pytest.mark.parametrize("ratio", [0.25, 0.5, 1.0, 2.0, 3.0, 5.0])
def test_series_gives_the_closed_form_for_light_masses(ratio):
    peak, when = exact_peak(ratio)
    assert peak == pytest.approx(2.0 * (1.0 + math.exp(-2.0 / ratio)), rel=1e-12)
    assert when == pytest.approx(3.0)


def test_series_tends_to_the_spring_for_heavy_masses():
    # V sqrt(k M) over T0 is sqrt(M / mL); the string adds a third of its mass
    peak, _ = exact_peak(2000.0, 120)
    assert peak == pytest.approx(math.sqrt(2000.0 + 1.0 / 3.0) + 1.0, rel=5e-3)


@pytest.mark.parametrize("ratio", [1.0, 1.7, 2.0, 3.0, 5.0, 7.0, 10.0, 20.0, 50.0])
def test_peak_within_one_percent(ratio):
    exact, when = exact_peak(ratio)
    assert computed_peak(ratio, 250, travels=when + 3.0) == pytest.approx(exact, rel=0.01)


@pytest.mark.parametrize("ratio", [0.25, 0.5, 0.8])
def test_peak_of_light_masses_within_two_percent(ratio):
    exact, when = exact_peak(ratio)
    assert computed_peak(ratio, 300, travels=when + 3.0) == pytest.approx(exact, rel=0.02)


@pytest.mark.parametrize("seed", range(6))
def test_mesh_converges_at_first_order_to_the_exact_peak(seed):
    """The bar's tension is the mean over its length behind a front: half the mesh, half the error."""
    rng = np.random.default_rng(seed)
    ratio = 10.0 ** rng.uniform(0.0, 1.5)
    options = {
        "span": rng.uniform(5.0, 500.0),
        "stiffness": 10.0 ** rng.uniform(4, 9),
        "mass": 10.0 ** rng.uniform(-1, 2),
    }
    exact, when = exact_peak(ratio)
    coarse, fine = (computed_peak(ratio, n, travels=when + 3.0, **options) for n in (200, 400))
    assert 2.0 * fine - coarse == pytest.approx(exact, rel=2e-3)
    assert abs(coarse - exact) == pytest.approx(2.0 * abs(fine - exact), rel=0.15)
