"""Networks at rest against the exact elastic catenary and other closed forms."""

import math

import numpy as np
import pytest
from networks_for_tests import random_network

from moyai.core.errors import ConvergenceError
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import Bars, BarType
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.statics import solve_equilibrium
from moyai.mooring.catenary import solve_catenary
from moyai.sea.water import Water

WATER = Water(100.0, 1025.0, 9.81)


def hanging(distance, rise, length, stiffness, mass, diameter, segments, bed=True, shape="catenary"):
    builder = NetworkBuilder(WATER, Bed(-100.0, 1e9) if bed else None)
    builder.fixed("anchor", (0.0, 0.0, -100.0))
    builder.fixed("fairlead", (distance * 0.6, distance * 0.8, -100.0 + rise))
    kind = BarType("chain", mass, stiffness, diameter)
    builder.line("line", "anchor", "fairlead", kind, length=length, segments=segments, shape=shape)
    return builder.build()


def top_tension(network):
    """Tension at the fairlead: that of the last bar and the weight of half of it."""
    rest = solve_equilibrium(network)
    strand = network.strand("line")
    along = rest.state.position[strand.nodes[-1]] - rest.state.position[strand.nodes[-2]]
    pull = rest.tension[strand.bars[-1]] * along / np.linalg.norm(along)
    kind = network.bars.types[0]
    weight = 0.5 * kind.submerged_weight_per_length(network.water) * network.bars.length[-1]
    return float(np.linalg.norm(pull + np.array([0.0, 0.0, weight])))


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize("bed", [True, False])
def test_lines_at_rest_are_exact_catenaries(seed, bed):
    rng = np.random.default_rng(seed)
    rise = rng.uniform(5.0, 90.0)
    distance = rng.uniform(0.3, 3.0) * rise
    chord = math.hypot(distance, rise)
    # not so long that it hangs straight down to a heap: there the mesh errs by half a bar's weight
    length = min(chord * rng.uniform(1.01, 1.6 if bed else 1.3), 0.95 * (distance + rise))
    diameter = rng.uniform(0.02, 0.1)
    mass = 1025.0 * math.pi / 4.0 * diameter**2 * rng.uniform(1.5, 7.0)
    weight = (mass - 1025.0 * math.pi / 4.0 * diameter**2) * 9.81
    stiffness = weight * length * 10.0 ** rng.uniform(1.5, 4)
    exact = float(solve_catenary(distance, rise, length, stiffness, weight, bed=bed).tension_fairlead)
    coarse, fine = (top_tension(hanging(distance, rise, length, stiffness, mass, diameter, n, bed)) for n in (200, 400))
    assert fine == pytest.approx(exact, rel=2e-3)
    # the mesh converges at second order; where the touchdown stands within a bar makes the order ragged
    assert (4.0 * fine - coarse) / 3.0 == pytest.approx(exact, rel=1e-4 if not bed else 3e-4)


@pytest.mark.parametrize("seed", range(6))
def test_fine_lines_are_within_one_in_ten_thousand(seed):
    rng = np.random.default_rng(50 + seed)
    distance, rise = rng.uniform(50.0, 120.0), rng.uniform(30.0, 80.0)
    length = math.hypot(distance, rise) * rng.uniform(1.02, 1.3)
    weight = (100.0 - 1025.0 * math.pi / 4.0 * 0.1**2) * 9.81
    exact = float(solve_catenary(distance, rise, length, 1e8, weight).tension_fairlead)
    assert top_tension(hanging(distance, rise, length, 1e8, 100.0, 0.1, 2000)) == pytest.approx(exact, rel=1e-4)


def test_bad_start_reaches_the_same_rest():
    good = hanging(60.0, 40.0, 90.0, 1e8, 60.0, 0.08, 60)
    poor = hanging(60.0, 40.0, 90.0, 1e8, 60.0, 0.08, 60, shape="straight")
    one, two = solve_equilibrium(good), solve_equilibrium(poor)
    assert two.tension == pytest.approx(one.tension, rel=1e-5)
    assert two.state.position == pytest.approx(one.state.position, abs=1e-4)


@pytest.mark.parametrize("seed", range(5))
def test_forces_on_the_holds_balance_weight_of_random_networks(seed):
    rng = np.random.default_rng(70 + seed)
    network = random_network(rng, bed=False, held=False, curve=False, bending=False, buoyant=False)
    rest = solve_equilibrium(network)
    pull = np.zeros(3)
    for k in range(len(network.bars)):
        for node, other in ((network.bars.start[k], network.bars.end[k]), (network.bars.end[k], network.bars.start[k])):
            if network.nodes.kind[node] != 0:
                along = rest.state.position[other] - rest.state.position[node]
                pull += rest.tension[k] * along / np.linalg.norm(along)
    moving = network.nodes.kind == 0
    assert rest.state.position[:, 2].max() < -2.0
    if moving.any():
        load = (network.node_mass - network.water.density * network.node_volume)[moving].sum() * 9.81
        assert pull[2] == pytest.approx(-load, rel=1e-6, abs=1e-5 * abs(load))


def test_net_in_a_current_comes_to_rest():
    builder = NetworkBuilder(WATER)
    grid = np.zeros((6, 6, 3))
    grid[..., 1], grid[..., 2] = np.arange(6)[None, :], -5.0 - np.arange(6)[:, None]
    twine = BarType(
        "twine", 0.36, 2e5, 0.02, viscosity=100.0, drag_normal=1.2, drag_tangential=0.03, added_mass_normal=1.0
    )
    builder.net("net", grid, twine, lengths=(1.0, 1.0), top="fixed")
    rest = solve_equilibrium(builder.build(), flow=Flow((0.8, 0.0, 0.0)))
    assert rest.residual < 1e-8
    assert rest.state.position[:, 0].max() > 2.0
    mirrored = rest.state.position.reshape(6, 6, 3)
    assert mirrored[:, ::-1, 0] == pytest.approx(mirrored[..., 0], abs=1e-3)


def test_float_settles_at_its_draught():
    builder = NetworkBuilder(WATER)
    builder.fixed("anchor", (0.0, 0.0, -20.0))
    builder.float_sphere(
        "buoy", (0.5, 0.0, 0.2), diameter=1.0, mass=200.0, drag_coefficient=0.5, added_mass_coefficient=0.5
    )
    builder.line("tether", "anchor", "buoy", BarType("rope", 1e-3, 1e4, 1e-3), length=25.0, segments=1)
    rest = solve_equilibrium(builder.build())
    depth = 0.5 - rest.state.position[1, 2]
    volume = math.pi * depth**2 * (1.5 - depth) / 3.0
    assert volume * 1025.0 == pytest.approx(200.0, rel=1e-3)


def test_what_cannot_rest_is_reported():
    builder = NetworkBuilder(Water(math.inf, 1000.0, 9.81))
    builder.free("one", (0.0, 0.0, -5.0), mass=10.0)
    builder.free("two", (1.0, 0.0, -5.0), mass=10.0)
    builder.line("tie", "one", "two", BarType("tie", 1.0, 1e4, 0.01), length=1.0, segments=2)
    with pytest.raises(ConvergenceError, match=r"nothing holds the 3 nodes around .*sink without end"):
        solve_equilibrium(builder.build())


def test_bars_keep_their_direction_on_the_spine():
    """A bar given backwards gives the same rest."""
    builder = NetworkBuilder(WATER)
    builder.fixed("a", (0.0, 0.0, -10.0))
    builder.fixed("b", (8.0, 0.0, -10.0))
    builder.line("rope", "a", "b", BarType("rope", 5.0, 1e5, 0.02), length=10.0, segments=8)
    network = builder.build()
    bars = network.bars
    turned = Bars(bars.end, bars.start, bars.length, bars.kind, bars.types)
    other = Network(network.nodes, turned, network.water)
    assert solve_equilibrium(other).tension == pytest.approx(solve_equilibrium(network).tension, rel=1e-9)
