"""Sheets that take water along: exact periods by all schemes and as modes, sheets that follow the water, wet parts."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.core.errors import InputError
from moyai.flexible.elements import FIXED, FREE, Bars, BarType, Nodes
from moyai.flexible.flow import Flow
from moyai.flexible.mass_blocks import MassBlocks
from moyai.flexible.modes import natural_modes
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.sheets import Sheets, sheet_grid
from moyai.flexible.simulation import simulate
from moyai.sea.irregular import WaveComponents
from moyai.sea.water import Water

TURN = np.array([[0.36, 0.48, -0.8], [-0.8, 0.6, 0.0], [0.48, 0.64, 0.6]])


def sprung(added: float, water: Water) -> tuple[Network, float]:
    """Return a square of cloth in any attitude, every corner on three springs to fixed points; their stiffness."""
    triangles, rest = sheet_grid(np.arange(4).reshape(2, 2), [0.0, 1.0], [0.0, 1.0])
    flat = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]])
    corners = flat @ TURN.T + [0.0, 0.0, -8.0]
    far = 50.0
    anchors = np.concatenate([corner + far * TURN.T for corner in corners])
    spring = BarType("spring", 1e-9, 200.0 * far, 0.0, volume_per_length=0.0, tension_only=False)
    start = np.repeat(np.arange(4), 3)
    bars = Bars(start, 4 + np.arange(12), np.full(12, far), np.zeros(12, dtype=int), (spring,))
    sheets = Sheets(triangles, rest, 0.05, 0.05, 0.02, mass_per_area=3.0, added_mass_per_area=added)
    kind = np.array([FREE] * 4 + [FIXED] * 12)
    return Network(Nodes(np.concatenate([corners, anchors]), kind), bars, water, sheets=sheets), 200.0


@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
@pytest.mark.parametrize("across", [True, False])
def test_a_sheet_swings_with_the_water_across_it_alone(method: str, across: bool) -> None:
    """Every corner by itself: omega^2 = k / (m + a) across, k / m along."""
    network, spring = sprung(12.0, Water(20.0, 1000.0, 1e-9))
    way = TURN @ ([0.0, 0.0, 1.0] if across else [0.0, 1.0, 0.0])
    # thirds of triangles: the two corners of the diagonal bear twice as much as the others and swing more slowly
    place = np.array(network.nodes.position)
    share = network.node_mass[:4] / network.node_mass[:4].mean()
    omega = math.sqrt(spring / (0.75 * (5.0 if across else 1.0)))
    omega_of = omega / np.sqrt(share)
    place[:4] += 0.01 * way
    period = 2.0 * math.pi / omega
    history = simulate(
        network, duration=3.0 * period, output_step=period / 160.0, start=State(0.0, place, np.zeros_like(place)),
        method=method, **({"tolerance": 1e-7} if method != "explicit" else {}),
    )  # fmt: skip
    swing = (history.position[:, :4] - network.nodes.position[:4]) @ way
    wanted = 0.01 * np.cos(omega_of * history.time[:, None])
    # cloth of 0.05 N/m against springs of 200 N/m
    assert np.max(np.abs(swing - wanted)) < 0.01 * 0.01
    # the first row holds the energy of the state, the others that which leapfrog keeps at its step
    total = (history.kinetic_energy + history.elastic_energy)[1:]
    assert np.ptp(total) < 2e-3 * total[0]


def test_modes_know_the_water() -> None:
    network, spring = sprung(12.0, Water(20.0, 1000.0, 1e-9))
    found = np.sort(natural_modes(network, State.at_rest(network), count=12).omega)
    share = network.node_mass[:4]
    wanted = np.sort(np.concatenate([np.sqrt(spring / (5.0 * share)), np.sqrt(spring / np.repeat(share, 2))]))
    assert found == pytest.approx(wanted, rel=1e-3)


def test_dry_cloth_takes_no_water_along() -> None:
    network, spring = sprung(12.0, Water(20.0, 1000.0, 1e-9))
    place = network.nodes.position + np.array([0.0, 0.0, 12.0])
    dry = Network(Nodes(place, network.nodes.kind), network.bars, network.water, sheets=network.sheets)
    found = natural_modes(dry, State.at_rest(dry), count=12).omega
    assert found.min() == pytest.approx(math.sqrt(spring / network.node_mass[:4].max()), rel=1e-3)


@pytest.mark.parametrize("added", [0.0, 40.0])
def test_a_loose_sheet_as_heavy_as_water_follows_it(added: float) -> None:
    """Its displaced mass and what it takes along are pushed as they resist: it goes where the water would."""
    water = Water(np.inf, 1000.0, 9.81)
    omega = np.array([0.9])
    waves = WaveComponents(omega, np.array([0.4]), np.array([0.3]), np.array([0.5]), omega**2 / 9.81, water=water)
    flow = Flow(waves=waves)
    triangles, rest = sheet_grid(np.arange(4).reshape(2, 2), [0.0, 0.02], [0.0, 0.02])
    flat = np.array([[0.0, 0.0, 0.0], [0.0, 0.02, 0.0], [0.02, 0.0, 0.0], [0.02, 0.02, 0.0]])
    corners = flat @ TURN.T + [1.0, -2.0, -4.0]
    sheets = Sheets(
        triangles, rest, 1.0, 1.0, 0.5, mass_per_area=2.0, volume_per_area=0.002, added_mass_per_area=added,
        damping_time=0.01,
    )  # fmt: skip
    network = Network(Nodes(corners, np.zeros(4, dtype=int)), Bars([], [], [], [], ()), water, sheets=sheets)
    begin = np.zeros((4, 3))

    def rate(time: float, state: np.ndarray) -> np.ndarray:
        return np.concatenate([state[3:], flow.at(time, state[:3, None])[3:6, 0]])

    wanted = solve_ivp(rate, (0.0, 6.0), np.concatenate([corners.mean(axis=0), begin[0]]), rtol=1e-8).y[:3, -1]
    history = simulate(network, duration=6.0, output_step=0.1, flow=flow, start=State(0.0, corners, begin))
    gone = float(np.linalg.norm(wanted - corners.mean(axis=0)))
    assert gone > 0.3
    assert np.linalg.norm(history.final.position.mean(axis=0) - wanted) < 0.01 * gone


def test_water_does_not_count_twice() -> None:
    triangles, rest = sheet_grid(np.arange(9).reshape(3, 3), [0.0, 1.0, 2.0], [0.0, 1.0, 2.0])
    y, z = np.meshgrid([0.0, 1.0, 2.0], [-2.0, -3.0, -4.0], indexing="ij")
    nodes = Nodes(np.stack([0.0 * y, y, z], -1).reshape(9, 3), [FIXED] * 3 + [FREE] * 3 + [FIXED] * 3)
    blocks = MassBlocks([[3, 4, 5]], [[[0, 6], [1, 7], [2, 8]]], np.eye(6)[None])
    sheets = Sheets(triangles, rest, 1.0, 1.0, mass_per_area=1.0, added_mass_per_area=5.0)
    with pytest.raises(InputError, match="twice"):
        Network(nodes, Bars([], [], [], [], ()), Water(20.0, 1000.0, 9.81), sheets=sheets, blocks=blocks)


def test_folds_of_wet_cloth_make_no_energy() -> None:
    """A loose sheet that crumples with three hundred times its own mass across it: energy and momentum stay.

    With normals that follow the triangles the mass came and went with their folds, and so did the energy.
    """
    rng = np.random.default_rng(7)
    side = np.linspace(0.0, 1.0, 5)
    triangles, rest = sheet_grid(np.arange(25).reshape(5, 5), side, side)
    x, y = np.meshgrid(side, side, indexing="ij")
    place = np.stack([1.01 * x, 1.01 * y, 0.0 * x - 9.0], axis=-1).reshape(25, 3)
    sheets = Sheets(triangles, rest, 400.0, 300.0, 80.0, mass_per_area=1.0, added_mass_per_area=300.0)
    still = Water(20.0, 1000.0, 1e-9)
    network = Network(Nodes(place, np.zeros(25, dtype=int)), Bars([], [], [], [], ()), still, sheets=sheets)
    speed = 0.5 * rng.normal(size=(25, 3))
    history = simulate(network, duration=1.0, output_step=0.01, start=State(0.0, place, speed), safety=0.1)
    total = history.kinetic_energy + history.elastic_energy
    assert history.status == "converged"
    assert np.max(np.abs(total / total[0] - 1.0)) < 2e-3
    weight = network.node_mass[:, None] * np.array([1.0, 1.0, 301.0])
    gained = np.sum(weight * (history.final.velocity - speed), axis=0)
    assert np.max(np.abs(gained)) < 1e-9 * np.sum(weight * np.abs(speed))
    # it does fold: triangles lie far from where they were built
    one, two = (history.final.position[triangles[:, k]] - history.final.position[triangles[:, 0]] for k in (1, 2))
    across = np.cross(one, two)
    assert np.min(np.abs(across[:, 2]) / np.linalg.norm(across, axis=1)) < 0.5
