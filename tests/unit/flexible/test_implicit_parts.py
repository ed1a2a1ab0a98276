"""Sheets, net panels and elastic rings in the implicit schemes: derivatives, the explicit scheme, exact vibrations."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from test_elastic_rings import circle
from test_mass_blocks import matrix, small_network
from test_network_sheets import random_sheet

from moyai.core.errors import InputError
from moyai.flexible import sheet_kernel
from moyai.flexible.bed import Bed
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import Bars, BarType, Nodes
from moyai.flexible.flow import Flow
from moyai.flexible.modes import natural_modes, tangent_matrices
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.panels import NetPanels, PanelArrays, PanelLaw, forces_on_panels
from moyai.flexible.part_kernel import panel_rate_blocks, sheet_blocks, stress_slope
from moyai.flexible.result import State
from moyai.flexible.rings import Ring
from moyai.flexible.sheets import Sheets, sheet_grid
from moyai.flexible.simulation import Method, simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water

WATER = Water(20.0, 1000.0, 9.81)
NO_BARS = Bars([], [], [], [], ())


@pytest.mark.parametrize("seed", range(6))
def test_stress_slope_is_the_derivative_of_the_stress(seed: int) -> None:
    rng = np.random.default_rng(seed)
    sheets, _ = random_sheet(rng)
    table, slope, states = sheets.constants(WATER), np.zeros((3, 3)), set()
    for strain in 0.01 * rng.normal(size=(60, 3)):
        *_, state = stress_slope(table, 0, *strain, slope)
        states.add(state)
        for column in range(3):
            ends = []
            for sign in (1.0, -1.0):
                moved = strain.copy()
                moved[column] += sign * 1e-7
                found = sheet_kernel.tensile_stress(table, 0, *moved)
                ends.append((np.array(found[:3]), found[4]))
            if ends[0][1] == ends[1][1] == state:
                change = (ends[0][0] - ends[1][0]) / 2e-7
                assert slope[:, column] == pytest.approx(change, abs=2e-5 * np.max(np.abs(table[0, 5:9])))
        assert np.allclose(slope, slope.T) and np.linalg.eigvalsh(slope)[0] > -1e-9 * np.max(table[0, 5:9])
    assert states == {0, 1, 2}


def dense(blocks: np.ndarray, members: np.ndarray, count: int) -> np.ndarray:
    matrix = np.zeros((3 * count, 3 * count))
    for element, nodes in zip(blocks, members, strict=True):
        for i, a in enumerate(nodes):
            for j, b in enumerate(nodes):
                matrix[3 * a : 3 * a + 3, 3 * b : 3 * b + 3] += element[i, j]
    return matrix


def sheet_pull(table: np.ndarray, triangles: np.ndarray, x: np.ndarray, v: np.ndarray, water: np.ndarray) -> np.ndarray:
    """Return all forces of a sheet, the water's included."""
    count = len(x)
    place, speed, out = x.T.ravel(), v.T.ravel(), np.zeros(3 * count)
    sheet_kernel.sheet_forces(table, triangles, place, 0, speed, 0, out, 0, 1, count, np.zeros(len(triangles)))
    sheet_kernel.sheet_loads(
        table, triangles, place, 0, speed, 0, water.ravel(), 0, out, 0, 1, count, np.zeros((4, count)), 0.0
    )
    return out.reshape(3, count).T


@pytest.mark.parametrize("seed", range(8))
def test_sheet_blocks_are_the_derivative_of_its_forces(seed: int) -> None:
    """Over place and velocity together: stress, damping, pressure, drag and its turn, a surface that cuts it."""
    rng = np.random.default_rng(100 + seed)
    sheets, flat = random_sheet(
        rng, tension_field=seed % 2 == 0, pressure=rng.normal(0.0, 50.0), damping_time=0.02, volume_per_area=0.05,
        drag_normal=1.1, drag_tangential=0.2,
    )  # fmt: skip
    table, count = sheets.constants(WATER), 16
    place = np.column_stack([flat, np.zeros(16)]) + 0.05 * rng.normal(size=(16, 3))
    place[:, 2] -= 5.0 if seed < 4 else 0.0
    speed, water = rng.normal(0.0, 0.3, (16, 3)), np.zeros((7, 16))
    water[:3] = rng.normal(0.0, 0.5, (3, 1))
    by_rate, by_place = rng.uniform(0.2, 1.0, 2)
    blocks = np.zeros((18, 3, 3, 3, 3))
    sheet_blocks(table, sheets.triangles, place, speed, water, by_rate, by_place, True, 1e-6, blocks)
    matrix, way, step = dense(blocks, sheets.triangles, count), rng.normal(size=(16, 3)), 1e-8
    ends = [
        sheet_pull(table, sheets.triangles, place + s * by_place * step * way, speed + s * by_rate * step * way, water)
        for s in (1.0, -1.0)
    ]
    change = -(ends[0] - ends[1]) / (2.0 * step)
    found = (matrix @ way.ravel()).reshape(16, 3)
    # a triangle on the border of two states has no derivative: most nodes have none near
    assert np.median(np.abs(found - change)) < 2e-6 * np.max(np.abs(change))
    assert np.max(np.abs(found - change)) < 1e-3 * np.max(np.abs(change))


@pytest.mark.parametrize("seed", range(4))
def test_panel_blocks_are_the_derivative_over_the_velocities(seed: int) -> None:
    rng = np.random.default_rng(200 + seed)
    points, speed, water = rng.normal(size=(6, 3)) - [0.0, 0.0, 9.0], 0.3 * rng.normal(size=(6, 3)), np.zeros((7, 6))
    water[:3] = rng.normal(0.0, 1.0, (3, 6))
    # one coefficient at every angle: what the blocks hold constant is constant
    panels = NetPanels([[0, 1, 2, 3], [2, 3, 4, -1]], (PanelLaw.constant("plate", 1.2),), flow_factor=[0.8, 1.0])
    blocks, system = np.zeros((2, 4, 4, 3, 3)), PanelArrays.of(panels).system
    panel_rate_blocks(points, speed, water, system, 0.5 * WATER.density, 0.7, blocks)
    matrix = dense(blocks, np.array([[0, 1, 2, 3], [2, 3, 4, 2]]), 6)
    way = rng.normal(size=(6, 3))
    ends = [forces_on_panels(panels, points, speed + s * 0.7e-6 * way, water, WATER.density)[0] for s in (1.0, -1.0)]
    change = -(ends[0] - ends[1]) / 2e-6
    assert (matrix @ way.ravel()).reshape(6, 3) == pytest.approx(change, rel=1e-5, abs=1e-6 * np.max(np.abs(change)))


def sheet_network(seed: int) -> Network:
    """A rectangle of random cloth, held along one edge, in air or water, with a rope around its lower edge."""
    rng = np.random.default_rng(seed)
    sheets, flat = random_sheet(rng, damping_time=0.02, drag_normal=1.0, drag_tangential=0.05, volume_per_area=1e-3)
    kind = np.zeros(16, dtype=int)
    kind[[3, 7, 11, 15]] = 1
    place = np.column_stack([flat[:, 0], np.zeros(16), flat[:, 1] - 6.0])
    rope = BarType("rope", 2.0, 2e4, 0.02, viscosity=200.0, drag_normal=1.2, added_mass_normal=1.0)
    bars = Bars([0, 4, 8], [4, 8, 12], [0.66, 0.66, 0.66], [0, 0, 0], (rope,))
    return Network(Nodes(place, kind), bars, WATER, sheets=sheets)


def panel_network(seed: int) -> Network:
    """A net of 4 x 4 knots hung from its upper edge, with panels."""
    rng = np.random.default_rng(seed)
    grid = np.arange(16).reshape(4, 4)
    place = np.stack([np.zeros(16), (grid % 4).ravel() * 0.5, -3.0 - 0.5 * (grid // 4).ravel()], axis=1)
    pairs = np.concatenate([np.stack([grid[:, :-1].ravel(), grid[:, 1:].ravel()], 1),
                            np.stack([grid[:-1].ravel(), grid[1:].ravel()], 1)])  # fmt: skip
    twine = BarType("twine", 0.4, 10.0 ** rng.uniform(4, 5), 0.01, viscosity=100.0, added_mass_normal=1.0)
    corners = np.stack([grid[:-1, :-1].ravel(), grid[:-1, 1:].ravel(), grid[1:, 1:].ravel(), grid[1:, :-1].ravel()], 1)
    law = PanelLaw.constant("net", rng.uniform(0.3, 0.9), rng.uniform(0.0, 0.2))
    kind = np.zeros(16, dtype=int)
    kind[:4] = 1
    mass = np.zeros(16)
    mass[12:] = rng.uniform(0.5, 3.0, 4)
    bars = Bars(pairs[:, 0], pairs[:, 1], np.full(len(pairs), 0.5 * rng.uniform(1.0, 1.05)),
                np.zeros(len(pairs), dtype=int), (twine,))  # fmt: skip
    return Network(Nodes(place, kind, mass=mass), bars, WATER, panels=NetPanels(corners, (law,)))


def ring_network(seed: int) -> Network:
    """A pipe bent to a circle, moored at one node, with a weight on another."""
    rng = np.random.default_rng(seed)
    count, radius, bending = 12, rng.uniform(1.0, 4.0), 10.0 ** rng.uniform(2.0, 3.5)
    shape = circle(count, radius)
    size = float(np.linalg.norm(shape[1] - shape[0]))
    pipe = BarType("pipe", 5.0, 1e5, 0.08, viscosity=500.0, drag_normal=1.0, added_mass_normal=1.0, tension_only=False)
    bars = Bars(np.arange(count), np.roll(np.arange(count), -1), np.full(count, size), np.zeros(count, int), (pipe,))
    kind, mass = np.zeros(count, dtype=int), np.zeros(count)
    kind[0], mass[count // 2] = 1, rng.uniform(1.0, 10.0)
    ring = Ring("collar", np.arange(count), shape, bending, bending * rng.uniform(0.5, 1.0))
    return Network(Nodes(shape - [0.0, 0.0, 8.0], kind, mass=mass), bars, WATER, rings=(ring,))


@pytest.mark.slow
@pytest.mark.parametrize("make", [sheet_network, panel_network, ring_network])
@pytest.mark.parametrize("seed", [0, *(pytest.param(k, marks=pytest.mark.slow) for k in (1, 2))])
def test_implicit_and_explicit_schemes_meet(make: Callable[[int], Network], seed: int) -> None:
    """Random networks in a current: both families close in on one motion, each at its own order."""
    network, flow = make(seed), Flow(velocity=(0.4, 0.3, 0.1))
    times = {"duration": 1.0, "output_step": 0.05, "flow": flow}
    exact = simulate(network, method="esdirk4", tolerance=1e-7, **times)
    moved, top = float(np.ptp(exact.position, axis=0).max()), float(exact.tension_peak.max())
    assert exact.status == "converged" and moved > 0.1 and exact.checks[0].value < 1e-3

    def errors(**given: Any) -> tuple[float, float]:
        found = simulate(network, **times, **given)
        assert found.status == "converged", found.message
        assert found.checks[0].value < 0.01
        return (
            float(np.max(np.abs(found.position - exact.position))) / moved,
            max(float(np.max(np.abs(found.tension - exact.tension))) / top, abs(found.tension_peak.max() / top - 1.0)),
        )

    coarse, fine = errors(safety=0.2, load_steps=1), errors(safety=0.1, load_steps=1)
    assert max(fine) < 5e-3
    # viscosity lags by half a step: first order
    assert fine[1] < 0.6 * coarse[1]
    for method in ("tr_bdf2", "esdirk4"):
        coarse, fine = errors(method=method, tolerance=1e-3), errors(method=method, tolerance=1e-5)
        assert max(fine) < 2e-3
        assert max(fine) < 0.2 * max(coarse)


def drum(cells: int, side: float, tension: float, mass: float, stiffness: float) -> Network:
    """A square membrane in air under the same pull both ways, held along its edges."""
    count = cells + 1
    flat = np.linspace(0.0, side / (1.0 + tension / stiffness), count)
    triangles, rest = sheet_grid(np.arange(count**2).reshape(count, count), flat, flat)
    edge = np.linspace(0.0, side, count)
    place = np.stack([*(grid.ravel() for grid in np.meshgrid(edge, edge, indexing="ij")), np.full(count**2, 5.0)], 1)
    inside = (place[:, 0] > 0.0) & (place[:, 0] < side) & (place[:, 1] > 0.0) & (place[:, 1] < side)
    # no contraction: each direction for itself; Green's strain of a small stretch is the stretch
    sheets = Sheets(triangles, rest, stiffness, stiffness, 0.4 * stiffness, mass_per_area=mass)
    kind = np.where(inside, 0, 1)
    return Network(Nodes(place, kind), NO_BARS, Water(20.0, 1000.0, 1e-9), sheets=sheets)


@pytest.mark.slow
def test_a_taut_membrane_swings_with_its_exact_modes() -> None:
    """omega = pi sqrt(T / m (p^2 + q^2)) / a, from the eigenproblem and from a run of each implicit scheme."""
    side, tension, mass, stiffness = 3.0, 40.0, 0.7, 4e5
    wave = math.sqrt(tension / mass)
    exact = math.pi * wave / side * np.sqrt([2.0, 5.0, 5.0, 8.0])
    errors = []
    for cells in (8, 16):
        network = drum(cells, side, tension, mass, stiffness)
        found = natural_modes(network, State.at_rest(network), count=4).omega
        errors.append(np.abs(found / exact - 1.0))
    assert max(errors[1]) < 0.02 and max(errors[1]) < 0.3 * max(errors[0])
    network = drum(12, side, tension, mass, stiffness)
    modes = natural_modes(network, State.at_rest(network), count=1)
    period = 2.0 * math.pi / modes.omega[0]
    for method, tolerance in (("tr_bdf2", 1e-5), ("esdirk4", 1e-5)):
        begin = State.at_rest(network)
        begin.velocity[:] = 1e-3 * modes.shape[0]
        run = simulate(
            network, duration=5.3 * period, output_step=period / 100.0, start=begin, method=method, tolerance=tolerance
        )
        assert run.status == "converged", run.message
        z = run.position[:, 6 * 13 + 6, 2] - 5.0
        rises = np.flatnonzero((z[:-1] < 0.0) & (z[1:] >= 0.0))
        when = run.time[rises] - z[rises] / (z[rises + 1] - z[rises]) * run.time[1]
        assert np.diff(when) == pytest.approx(period, rel=2e-3)


@pytest.mark.parametrize("wide", [1, 3])
def test_a_hanging_cloth_swings_like_a_chain(wide: int) -> None:
    """Out of its plane a cloth hung by its upper edge is a chain: zeros of J0 over 2, times sqrt(g / L)."""
    length, cells = 4.0, 40
    grid = np.arange((cells + 1) * (wide + 1)).reshape(cells + 1, wide + 1)
    down = np.linspace(0.0, length, cells + 1)
    across = np.linspace(0.0, 0.1 * wide, wide + 1)
    triangles, rest = sheet_grid(grid, down, across)
    place = np.stack([np.zeros(grid.size), np.tile(across, cells + 1), 10.0 - np.repeat(down, wide + 1)], axis=1)
    sheets = Sheets(triangles, rest, 1e6, 1e6, 0.0, mass_per_area=0.5)
    kind = np.zeros(grid.size, dtype=int)
    kind[: wide + 1] = 1
    held = np.zeros((grid.size, 3), dtype=bool)
    held[:, 1] = True
    network = Network(Nodes(place, kind, held), NO_BARS, WATER, sheets=sheets)
    rest_state = solve_equilibrium(network).state
    # without shear every thread swings for itself
    modes = natural_modes(network, rest_state, count=2 * (wide + 1))
    first, second = 0.5 * np.array([2.404825557695773, 5.520078110286311]) * math.sqrt(9.81 / length)
    assert modes.omega[: wide + 1] == pytest.approx(first, rel=1e-3)
    assert modes.omega[wide + 1 :] == pytest.approx(second, rel=6e-3)
    tips = modes.shape[: wide + 1, -wide - 1 :, 0]
    together = np.tensordot(np.linalg.solve(tips.T, np.ones(wide + 1)), modes.shape[: wide + 1], axes=1)
    begin = State(0.0, rest_state.position, 1e-3 * together)
    period = 2.0 * math.pi / modes.omega[0]
    run = simulate(
        network, duration=2.3 * period, output_step=period / 50.0, start=begin, method="esdirk4", tolerance=1e-4,
        keep_nodes=[grid.size - 1],
    )  # fmt: skip
    assert run.status == "converged", run.message
    x = run.position[:, 0, 0]
    falls = np.flatnonzero((x[:-1] > 0.0) != (x[1:] > 0.0))
    when = run.time[falls] + x[falls] / (x[falls] - x[falls + 1]) * run.time[1]
    assert np.diff(when) == pytest.approx(0.5 * period, rel=5e-3)


@pytest.mark.parametrize("make", [sheet_network, panel_network, ring_network])
@pytest.mark.parametrize(("method", "order", "least"), [("tr_bdf2", 2, 1.9), ("esdirk4", 4, 3.1)])
def test_order_of_both_schemes(make: Callable[[int], Network], method: Method, order: int, least: float) -> None:
    """Steps halved thrice in smooth motion; drag by |u| u costs the fourth order a part where the flow turns."""
    network, flow = make(0), Flow(velocity=(0.4, 0.3, 0.1))
    begin = simulate(network, method="esdirk4", tolerance=1e-7, duration=1.0, output_step=0.5, flow=flow).final
    ends = [
        simulate(
            network, method=method, step=0.4 / count, duration=0.4, output_step=0.4, flow=flow, start=begin,
            tolerance=1e-7,
        ).final.position
        for count in (8, 16, 32)
    ]  # fmt: skip
    coarse, fine = (np.max(np.abs(a - b)) for a, b in itertools.pairwise(ends))
    assert 0.0 < fine < 1e-5
    assert least < math.log2(coarse / fine) < order + 0.2


def test_free_rings_have_the_modes_of_hoppe_and_love() -> None:
    """Six motions of no frequency, then n = 2, 3 out of the plane and in it; second order in the mesh."""
    radius, bending, torsion, mass = 5.0, 2e4, 1.4e4, 5.0
    n = np.array([2.0, 3.0])
    unit = bending * n**2 * (n**2 - 1.0) ** 2 / (mass * radius**4)
    exact = np.sqrt(np.stack([unit / (n**2 + bending / torsion), unit / (n**2 + 1.0)], axis=1).ravel())
    found = []
    for count in (24, 48):
        shape = circle(count, radius)
        size = np.full(count, float(np.linalg.norm(shape[1] - shape[0])))
        pipe = BarType("pipe", mass, 1e8, 1e-6, tension_only=False)
        bars = Bars(np.arange(count), np.roll(np.arange(count), -1), size, np.zeros(count, dtype=int), (pipe,))
        nodes = Nodes(shape - [0.0, 0.0, 50.0], np.zeros(count, dtype=int))
        ring = Ring("pipe", np.arange(count), shape, bending, torsion)
        network = Network(nodes, bars, Water(100.0, 1000.0, 1e-12), rings=(ring,))
        omega = natural_modes(network, State.at_rest(network), count=14).omega
        assert np.max(omega[:6]) < 1e-4 * exact[0]
        assert omega[6::2] == pytest.approx(omega[7::2], rel=1e-6)
        found.append(omega[6::2])
    assert found[1] == pytest.approx(exact, rel=0.02)
    assert (4.0 * found[1] - found[0]) / 3.0 == pytest.approx(exact, rel=2e-3)


@pytest.mark.parametrize("method", ["tr_bdf2", "esdirk4"])
def test_a_ring_swings_with_its_exact_mode(method: Method) -> None:
    """In the plane, started as cos 2t; viscosity calms what stretches."""
    count, radius, bending, mass = 32, 5.0, 2e4, 5.0
    shape, angle = circle(count, radius), 2.0 * math.pi * np.arange(count) / count
    size = np.full(count, float(np.linalg.norm(shape[1] - shape[0])))
    pipe = BarType("pipe", mass, 1e6, 1e-6, viscosity=1e4, tension_only=False)
    bars = Bars(np.arange(count), np.roll(np.arange(count), -1), size, np.zeros(count, dtype=int), (pipe,))
    nodes = Nodes(shape - [0.0, 0.0, 50.0], np.zeros(count, dtype=int))
    ring = Ring("pipe", np.arange(count), shape, bending, bending)
    network = Network(nodes, bars, Water(100.0, 1000.0, 1e-12), rings=(ring,))
    begin = State.at_rest(network)
    out, along = 0.01 * np.cos(2.0 * angle), -0.005 * np.sin(2.0 * angle)
    begin.velocity[:, 0] = out * np.cos(angle) - along * np.sin(angle)
    begin.velocity[:, 1] = out * np.sin(angle) + along * np.cos(angle)
    period = 2.0 * math.pi / math.sqrt(bending * 36.0 / 5.0 / (mass * radius**4))
    run = simulate(
        network, duration=3.3 * period, output_step=period / 60.0, start=begin, method=method, tolerance=1e-5
    )
    assert run.status == "converged" and run.checks[0].value < 1e-3
    x = run.position[:, 0, 0] - radius
    turns = np.flatnonzero((x[:-1] > 0.0) != (x[1:] > 0.0))
    when = run.time[turns] + x[turns] / (x[turns] - x[turns + 1]) * run.time[1]
    # second order in the mesh: 1 % at 32 bars
    assert np.diff(when) == pytest.approx(0.5 * period, rel=0.015)


@pytest.mark.parametrize("seed", range(4))
def test_modes_know_the_added_mass_of_sections(seed: int) -> None:
    rng = np.random.default_rng(seed)
    network, _ = small_network(rng, convective=bool(seed % 2), turn=rng.uniform(0.0, 6.0))
    place = np.array(network.nodes.position) + 0.1 * rng.normal(size=(10, 3))
    mass, stiffness = tangent_matrices(network, place, np.zeros((7, 10)))
    assert mass.toarray() == pytest.approx(matrix(network, place), abs=1e-9 * float(mass.max()))
    assert abs(stiffness - stiffness.T).max() == 0.0
    # what the sections add makes every mode slower
    bare = natural_modes(replace(network, blocks=None), State(0.0, place, np.zeros_like(place)), count=16).omega
    whole = natural_modes(network, State(0.0, place, np.zeros_like(place)), count=16).omega
    assert np.all(whole <= bare) and whole.sum() < 0.8 * bare.sum()


def test_what_the_implicit_schemes_do_not_march_is_reported() -> None:
    network, _ = small_network(np.random.default_rng(1), True)
    with pytest.raises(InputError, match="does not march sections of added mass"):
        simulate(network, duration=1.0, output_step=0.1, method="tr_bdf2")


@pytest.mark.slow
def test_the_error_estimate_is_real() -> None:
    """A chain with friction beats on a bed and snaps: the global error falls with the tolerance."""
    builder = NetworkBuilder(Water(40.0, 1025.0, 9.81), bed=Bed(-40.0, 1e6, 2e5, 0.3))
    builder.fixed("anchor", (0.0, 0.0, -40.0))
    builder.driven("end", (45.0, 0.0, -10.0))
    chain = BarType(
        "chain", 20.0, 4e7, 0.05, viscosity=8e3, drag_normal=2.0, drag_tangential=0.3, added_mass_normal=1.0
    )
    builder.line("chain", "anchor", "end", chain, length=60.0, segments=20)
    network = builder.build()
    times = {"duration": 3.0, "output_step": 0.02, "start": solve_equilibrium(network).state}
    motions = {"end": Motion.harmonic((1.5, 0.0, 1.5), 4.0, duration=3.0, ramp=2.0)}
    exact = simulate(network, motions, method="esdirk4", tolerance=1e-6, **times)
    top = float(exact.tension_peak.max())
    for method in ("tr_bdf2", "esdirk4"):
        errors = []
        for tolerance in (1e-2, 1e-3, 1e-4, 1e-5):
            found = simulate(network, motions, method=method, tolerance=tolerance, **times)
            assert found.status == "converged" and found.checks[0].value < 0.02
            assert float(found.tension_peak.max()) == pytest.approx(top, rel=2e-3)
            errors.append(float(np.max(np.abs(found.position - exact.position))))
        assert errors[3] < errors[2] < errors[0] and errors[3] < 0.1 * errors[0]
        assert errors[3] < 1e-3
    # the explicit scheme comes to the same peak by another law of rubbing: an impulse that may stop a node
    other = simulate(network, motions, safety=0.1, **times)
    assert float(other.tension_peak.max()) == pytest.approx(top, rel=1e-3)
