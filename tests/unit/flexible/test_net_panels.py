"""Net panels: forces by the law at random attitudes, both families of kernels, big steps in fast drag."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.dynamic_relaxation import relax_network
from moyai.flexible.elements import BarType
from moyai.flexible.explicit import ExplicitRun
from moyai.flexible.explicit_parts import screens
from moyai.flexible.explicit_rows import WU
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.panel_kernel import panel_tangent
from moyai.flexible.panels import NetPanels, PanelArrays, PanelLaw, forces_on_panels
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.morison.net_law_names import Net, net_law, panel_force
from moyai.sea.components import WaveComponents
from moyai.sea.water import Water

WATER = Water(50.0, 1025.0, 9.81)
VISCOSITY = 1.3e-6
TWINE = BarType("twine", 0.3, 2e5, 0.02, volume_per_length=2.5e-4, viscosity=300.0, added_mass_normal=1.0)


def table_of(name: str, net: Net) -> PanelLaw:
    law = net_law(name)
    return PanelLaw.tabulate(name, lambda angle, speed: law.coefficients(angle, speed, net, VISCOSITY))


def still(count: int) -> np.ndarray:
    return np.zeros((7, count))


@pytest.mark.parametrize("name", ["loland", "aarsnes", "kristiansen_faltinsen", "bi", "takagi"])
def test_a_panel_bears_what_the_law_says(name: str) -> None:
    rng = np.random.default_rng(len(name))
    net = Net.from_solidity(0.0025, 0.23)
    law, table = net_law(name), table_of(name, net)
    for _ in range(20):
        # a parallelogram anywhere, or a triangle, far under water
        origin, one, two = rng.normal(size=(3, 3))
        origin[2] -= 20.0
        quad = rng.random() < 0.5
        points = np.stack([origin, origin + one, origin + one + two, origin + two])[: 4 if quad else 3]
        velocity = rng.normal(size=3) * rng.uniform(0.05, 1.5)
        motion = rng.normal(size=3) * 0.3
        water = still(len(points))
        water[:3] = velocity[:, None]
        corners = np.array([[0, 1, 2, 3 if quad else -1]])
        panels = NetPanels(corners, (table,))
        force, each = forces_on_panels(panels, points, np.tile(motion, (len(points), 1)), water, WATER.density)
        normal = np.cross(one, two)
        area = np.linalg.norm(normal) * (1.0 if quad else 0.5)
        expected = panel_force(
            law, net, normal, velocity - motion, area=area, density=WATER.density, viscosity=VISCOSITY
        )
        # linear between 129 cosines and 10 speeds a decade
        assert np.linalg.norm(each[0] - expected) < 3e-3 * np.linalg.norm(expected)
        assert np.allclose(force.sum(axis=0), each[0], rtol=1e-12)


def test_the_force_turns_with_the_panel_and_reverses_with_the_flow() -> None:
    from scipy.spatial.transform import Rotation

    table = table_of("loland", Net.from_solidity(0.002, 0.3))
    points = np.array([[0.0, 0.0, -9.0], [1.3, 0.1, -9.1], [1.4, 0.9, -8.7], [0.1, 1.1, -9.0]])
    panels = NetPanels(np.array([[0, 1, 2, 3]]), (table,))
    velocity = np.array([0.4, -0.3, 0.2])
    water = still(4)
    water[:3] = velocity[:, None]
    _, first = forces_on_panels(panels, points, np.zeros((4, 3)), water, 1000.0)
    for seed in range(5):
        turn = Rotation.random(random_state=seed).as_matrix()
        turned = (points - points.mean(axis=0)) @ turn.T - [0.0, 0.0, 30.0]
        water[:3] = (turn @ velocity)[:, None]
        _, other = forces_on_panels(panels, turned, np.zeros((4, 3)), water, 1000.0)
        assert np.allclose(other[0], turn @ first[0], rtol=1e-10)
        water[:3] *= -1.0
        _, back = forces_on_panels(panels, turned, np.zeros((4, 3)), water, 1000.0)
        assert np.allclose(back, -other, rtol=1e-12)


def test_the_surface_cuts_a_panel() -> None:
    law = PanelLaw.constant("plate", 1.2)
    panels = NetPanels(np.array([[0, 1, 2, 3]]), (law,))
    water = still(4)
    water[0] = 1.0
    for top, share in ((2.0, 0.0), (0.5, 0.5), (0.25, 0.75), (-1.0, 1.0)):
        points = np.array([[0.0, 0.0, top], [0.0, 0.0, top - 1.0], [0.0, 1.0, top - 1.0], [0.0, 1.0, top]])
        if top == 2.0:
            points[:, 2] += 1.0
        _, each = forces_on_panels(panels, points, np.zeros((4, 3)), water, 1000.0)
        assert each[0, 0] == pytest.approx(share * 600.0, abs=1e-9)


def test_shadow_and_flow_factor() -> None:
    law = PanelLaw.constant("plate", 1.0)
    points = np.array([[0.0, 0.0, -2.0], [0.0, 0.0, -3.0], [0.0, 1.0, -3.0], [0.0, 1.0, -2.0]])
    water = still(4)
    water[0] = 2.0
    base = np.array([[0, 1, 2, 3]])
    _, one = forces_on_panels(NetPanels(base, (law,), flow_factor=0.5), points, np.zeros((4, 3)), water, 1000.0)
    _, two = forces_on_panels(
        NetPanels(base, (law,), shadow=np.array([[1.0, 0.0, 0.0]])), points, np.zeros((4, 3)), water, 1000.0
    )
    assert one[0, 0] == pytest.approx(500.0) and two[0, 0] == pytest.approx(500.0)
    _, gone = forces_on_panels(NetPanels(base, (law,), area=0.25), points, np.zeros((4, 3)), water, 1000.0)
    assert gone[0, 0] == pytest.approx(500.0)


def curtain(rows: int, law: PanelLaw, top: str = "fixed") -> Network:
    """Return a square net of 1 m meshes that hangs from its first row."""
    builder = NetworkBuilder(WATER)
    grid = np.zeros((rows, rows, 3))
    grid[:, :, 1] = np.arange(rows)
    grid[:, :, 2] = -5.0 - np.arange(rows)[:, None]
    builder.net("net", grid, TWINE, lengths=(1.0, 1.0), top=top)  # type: ignore[arg-type]
    network = builder.build()
    index = np.array([[network.points[f"net[{i},{j}]"] for j in range(rows)] for i in range(rows)])
    corners = np.stack([index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]], -1).reshape(-1, 4)
    mass = network.nodes.mass.copy()
    mass[index[-1]] = 8.0
    return replace(network, panels=NetPanels(corners, (law,), area=1.0), nodes=replace(network.nodes, mass=mass))


def found_for(run: ExplicitRun, onward: float, speeds: np.ndarray | None = None) -> float:
    """Find the loads of the panels of a run in still time, led on by the change of the relative speeds."""
    room = np.zeros(len(run.parts[0][0][0])) if speeds is None else speeds
    size = int(run.packed.sizes[0])
    return screens(run.packed.memory, size, run.parts[0], 0.5 * WATER.density, 0.0, 1e-3, True, room, onward)


def test_the_speed_of_panels_is_led_on() -> None:
    """Of a law without the Reynolds number C goes with the speed: to where its change leads, a twentieth at most."""
    network = curtain(5, table_of("loland", Net.from_solidity(0.002, 0.25)))
    still = State.at_rest(network)
    run = ExplicitRun(network, {}, Flow(velocity=(0.7, -0.2, 0.1)), still, safety=None, load_steps=1)
    speeds, matrices = np.zeros(16), []
    rates = [found_for(run, 0.0, speeds)]
    matrices.append(run.parts[0][1][:6].copy())
    water = run.packed.node_rows(WU, 3)
    for factor, onward in ((1.02, 0.0), (1.02 * 1.01, 2.0), (1.3, 2.0)):
        water[:] = factor * run.water[:3]
        rates.append(found_for(run, onward, speeds))
        matrices.append(run.parts[0][1][:6].copy())
    wanted = [1.0, 1.02, 1.02 * 1.01 + 2.0 * 1.02 * 0.01, 1.3 * 1.05]
    for value, matrix, rate in zip(wanted, matrices, rates, strict=True):
        assert matrix == pytest.approx(value * matrices[0], rel=1e-12, abs=1e-12)
        assert rate == pytest.approx(value * rates[0], rel=1e-12)
    assert rates[0] > 0.0


def test_the_explicit_scheme_sees_the_same_forces() -> None:
    rng = np.random.default_rng(2)
    network = curtain(5, table_of("kristiansen_faltinsen", Net.from_solidity(0.002, 0.25)))
    place = network.nodes.position + 0.3 * rng.normal(size=(25, 3))
    speed = 0.4 * rng.normal(size=(25, 3))
    flow = Flow(velocity=(0.7, -0.2, 0.1))
    run = ExplicitRun(network, {}, flow, State(0.0, place, speed), safety=None, load_steps=1)
    found_for(run, 0.0)
    screen = run.parts[0][1]
    v = run.speed
    c = screen[[0, 1, 2, 1, 3, 4, 2, 4, 5]].reshape(3, 3, -1)
    mine = screen[6:9] - np.einsum("ijn,jn->in", c, v)
    other, _ = forces_on_panels(network.panels, place, v.T.copy(), flow.at(0.0, place.T), WATER.density)  # type: ignore[arg-type]
    assert np.allclose(mine.T.sum(axis=0), other.sum(axis=0), rtol=1e-10)
    # nodes: shared by the corners' own velocities, which adds nothing to the whole
    assert np.all(np.linalg.eigvalsh(c.transpose(2, 0, 1)) > -1e-9)


def test_the_tangent_is_the_derivative_and_blind_to_translation() -> None:
    rng = np.random.default_rng(8)
    points = np.array([[0.0, 0.0, -9.0], [1.3, 0.1, -9.1], [1.4, 0.9, -8.7], [0.1, 1.1, -9.0]])
    panels = NetPanels(np.array([[0, 1, 2, 3]]), (table_of("loland", Net.from_solidity(0.002, 0.3)),), area=1.0)
    water = still(4)
    water[:3] = rng.normal(size=(3, 1))
    system = PanelArrays.of(panels).system
    blocks = np.empty((1, 4, 4, 3, 3))
    panel_tangent(points, np.zeros((4, 3)), water, system, 500.0, 1e-4, blocks)
    assert np.abs(blocks[0].sum(axis=1)).max() < 1e-4 * np.abs(blocks).max()
    move = 1e-3 * rng.normal(size=(4, 3))
    before, _ = forces_on_panels(panels, points, np.zeros((4, 3)), water, 1000.0)
    after, _ = forces_on_panels(panels, points + move, np.zeros((4, 3)), water, 1000.0)
    reported = -np.einsum("ijab,jb->ia", blocks[0], move)
    assert np.allclose(after - before, reported, atol=2e-2 * np.abs(reported).max())


def test_a_light_plate_slows_down_as_it_must_at_steps_far_above_its_own_time() -> None:
    # m v' = -k v^2: v = v0 / (1 + k v0 t / m); the rate of drag k v0 / m is many times one over the step
    builder = NetworkBuilder(WATER)
    for name, y, z in (("a", 0.0, -5.0), ("b", 0.0, -6.0), ("c", 1.0, -6.0), ("d", 1.0, -5.0)):
        builder.free(name, (0.0, y, z), mass=1.0, volume=1.0 / WATER.density)
    soft = BarType("soft", 1e-6, 1e-3, 0.0, 0.0)
    for one, two in (("a", "b"), ("b", "c"), ("c", "d"), ("d", "a")):
        builder.line(f"{one}{two}", one, two, soft, length=1.0, segments=1)
    network = builder.build()
    corners = np.array([[network.point(name) for name in "abcd"]])
    network = replace(network, panels=NetPanels(corners, (PanelLaw.constant("plate", 1.0),), area=1.0))
    start = State(0.0, np.array(network.nodes.position), np.tile([3.0, 0.0, 0.0], (4, 1)))
    k, m = 0.5 * WATER.density, 4.0
    path = m / k * np.log1p(k * 3.0 * 2.0 / m)
    errors = []
    for step in (4e-4, 2e-4):
        history = simulate(network, duration=2.0, output_step=0.1, start=start, step=step, load_steps=1)
        assert history.status == "converged" and history.checks[0].passed
        gone = float((history.position[-1] - history.position[0])[:, 0].mean())
        errors.append(abs(gone / path - 1.0))
    # its own time m / (k v0) is 2.6 ms: first order in the interval of the loads
    assert errors[1] < 0.6 * errors[0] and errors[1] < 0.02
    # and an interval of 48 ms, eighteen times its own time, only stops it too early
    history = simulate(network, duration=2.0, output_step=0.1, start=start, step=4e-3)
    assert history.status == "converged"
    speed = np.diff(history.position[:, network.point("a"), 0])
    assert np.all(speed > -1e-12) and speed[-1] < 1e-3


def test_held_loads_of_panels_give_what_a_quarter_of_the_step_gives() -> None:
    """A net in waves on a current, at the usual step with loads held for up to four steps, against shorter ones."""
    network = curtain(6, table_of("loland", Net.from_solidity(0.0025, 0.25)))
    omega = 2.0 * np.pi / 4.0
    waves = WaveComponents([omega], [0.8], [0.0], [0.0], [omega**2 / 9.81], WATER)
    flow = Flow(velocity=(0.6, 0.0, 0.0), waves=waves, wave_ramp=4.0)
    usual = simulate(network, duration=16.0, output_step=0.1, flow=flow, load_steps=1)
    finer = simulate(network, duration=16.0, output_step=0.1, flow=flow, load_steps=1, step=0.25 * usual.step)
    late = usual.time > 8.0
    sums = [np.maximum(run.tension[late], 0.0).sum(axis=1) for run in (usual, finer)]
    # twice what four steps give; loads that are held for twelve exceed each
    assert sums[0].mean() == pytest.approx(sums[1].mean(), rel=4e-5)
    assert sums[0].max() == pytest.approx(sums[1].max(), rel=1.8e-4)
    assert np.abs(usual.position[late] - finer.position[late]).max() < 6e-4


def test_rest_of_a_net_in_a_current_stays_at_rest() -> None:
    network = curtain(6, table_of("loland", Net.from_solidity(0.002, 0.25)))
    flow = Flow(velocity=(0.5, 0.0, 0.0))
    rest = relax_network(network, flow=flow, tolerance=1e-7)
    history = simulate(network, duration=4.0, output_step=0.5, flow=flow, start=rest.state)
    assert np.abs(history.position - rest.state.position).max() < 1e-4
    # and the drag is what its knots feel
    force, each = forces_on_panels(
        network.panels,
        rest.state.position,
        np.zeros((36, 3)),
        flow.at(0.0, rest.state.position.T),
        WATER.density,  # type: ignore[arg-type]
    )
    assert each[:, 0].sum() > 0.0 and force.sum() == pytest.approx(each.sum())


def test_faults_of_panels_are_reported() -> None:
    law = PanelLaw.constant("plate", 1.0)
    with pytest.raises(InputError, match="same node"):
        NetPanels(np.array([[0, 1, 1, 2]]), (law,))
    with pytest.raises(InputError, match="negative area"):
        NetPanels(np.array([[0, 1, 2, 3]]), (law,), area=-1.0)
    with pytest.raises(InputError, match="unknown law"):
        NetPanels(np.array([[0, 1, 2, 3]]), (law,), law=np.array([1]))
    with pytest.raises(InputError, match="not finite"):
        PanelLaw("bad", np.array([np.nan, 1.0]), np.zeros(2))


@pytest.mark.parametrize("seed", range(3))
def test_a_panel_in_pieces_bears_the_same(seed: int) -> None:
    """A flat panel cut into quads or triangles, outlines present or given, in uniform water: the same whole force."""
    rng = np.random.default_rng(seed)
    law = table_of(["loland", "aarsnes", "kristiansen_faltinsen"][seed], Net.from_solidity(0.002, 0.22))
    one, two = rng.normal(size=(2, 3))
    velocity, motion = rng.normal(size=3), 0.2 * rng.normal(size=3)
    whole = float(np.linalg.norm(np.cross(one, two)))
    found = []
    for cells in (1, 2, 5):
        share = np.linspace(0.0, 1.0, cells + 1)
        points = (share[:, None, None] * one + share[None, :, None] * two).reshape(-1, 3) - [0.0, 0.0, 30.0]
        number = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
        quads = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], -1).reshape(-1, 4)
        halves = np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]])
        thirds = np.column_stack([halves, np.full(len(halves), -1)])
        water = still(len(points))
        water[:3] = velocity[:, None]
        for corners in (quads, thirds):
            for area in (0.0, whole / len(corners)):
                panels = NetPanels(corners, (law,), area=area)
                force, _ = forces_on_panels(panels, points, np.tile(motion, (len(points), 1)), water, WATER.density)
                found.append(force.sum(axis=0))
    assert np.allclose(found, found[0], rtol=1e-12, atol=1e-12 * float(np.abs(found[0]).max()))
