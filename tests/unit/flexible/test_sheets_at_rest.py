"""Sheets at rest with hardly any load, partly slack in their plane, and blown out."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.flexible import sheet_kernel as kernel
from moyai.flexible.dynamic_relaxation import relax_network
from moyai.flexible.elements import FIXED, Bars, Nodes
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.relaxation import Relaxation
from moyai.flexible.result import State
from moyai.flexible.sheets import Sheets, sheet_grid, sheet_stress
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water

NO_BARS = Bars([], [], [], [], ())


def stretched(rng: np.random.Generator, gravity: float, mass: float) -> tuple[Network, float, float]:
    """Return a flat sheet with its ends pulled apart, free in its plane besides, its strain and its stiffness."""
    length, depth, strain, stiffness = *rng.uniform(0.5, 5.0, 2), rng.uniform(0.01, 0.4), 10.0 ** rng.uniform(3.0, 6.0)
    columns, rows = (int(n) for n in rng.integers(3, 8, 2))
    along, across = np.linspace(0.0, length, columns), np.linspace(0.0, depth, rows)
    grid = np.arange(columns * rows).reshape(columns, rows)
    triangles, rest = sheet_grid(grid, along, across)
    place = np.zeros((grid.size, 3))
    place[:, :2] = np.stack(np.meshgrid((1.0 + strain) * along, across, indexing="ij"), -1).reshape(-1, 2)
    held = np.zeros((grid.size, 3), dtype=bool)
    held[:, 2] = held[grid[[0, -1]].ravel(), 0] = True
    held[grid[0, 0], 1] = True
    inner = ~held.any(axis=1) | ~held[:, 0]
    place[inner, :2] += rng.uniform(-0.1, 0.1, (int(inner.sum()), 2)) * min(length / columns, depth / rows)
    sheets = Sheets(
        triangles, rest, stiffness, stiffness, 0.4 * stiffness, 0.25, mass_per_area=mass,
    )  # fmt: skip
    return (
        Network(Nodes(place, np.zeros(grid.size, int), held), NO_BARS, Water(20.0, 1000.0, gravity), sheets=sheets),
        strain,
        stiffness,
    )


@pytest.mark.parametrize(("gravity", "mass"), [(9.81, 1.0), (1e-9, 1.0), (9.81, 1e-6)])
@pytest.mark.parametrize("seed", range(3))
def test_stretched_sheet_rests_whatever_it_weighs(seed: int, gravity: float, mass: float) -> None:
    """A strip pulled along pulls with K E, E Green's strain; the force left counts against that pull."""
    network, strain, stiffness = stretched(np.random.default_rng(seed), gravity, mass)
    rest = solve_equilibrium(network)
    assert rest.residual < 1e-9
    assert network.sheets is not None
    stress = sheet_stress(network.sheets, rest.state.position)
    green = strain + 0.5 * strain**2
    assert stress.warp == pytest.approx(stiffness * green, rel=1e-7)
    assert np.abs(stress.weft).max() < 1e-7 * stiffness * green


def test_stress_of_the_first_guess_is_no_measure() -> None:
    """A guess stretched a hundredfold must not make the force left look small."""
    network, strain, stiffness = stretched(np.random.default_rng(5), 9.81, 1.0)
    start = network.nodes.position.copy()
    free = ~network.nodes.held[:, 0]
    start[free, 0] += np.random.default_rng(6).uniform(-3.0, 3.0, int(free.sum()))
    look = Relaxation(network, Flow(), math.inf)
    assert look.look(start).residual > 0.1
    rest = solve_equilibrium(network, start=State(0.0, start, np.zeros_like(start)))
    stress = sheet_stress(network.sheets, rest.state.position)
    assert stress.warp == pytest.approx(stiffness * (strain + 0.5 * strain**2), rel=1e-6)


def bent(cells: int, curvature: float, stretch: float, ratio: float, stiffness: float) -> Network:
    """Return a sheet of 2 x 1 m bent in its plane between ends that stay flat."""
    grid = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    along, across = np.linspace(-1.0, 1.0, cells + 1), np.linspace(-0.5, 0.5, cells + 1)
    triangles, rest = sheet_grid(grid, along, across)
    x, y = np.meshgrid(along, across, indexing="ij")
    place = np.zeros((grid.size, 3))
    place[:, 0] = (x + (stretch - curvature * y) * x).ravel()
    place[:, 1] = (y + 0.5 * curvature * x**2 - ratio * stretch * y).ravel()
    held = np.zeros((grid.size, 3), dtype=bool)
    held[:, 2] = held[grid[[0, -1]].ravel(), 0] = held[grid[cells // 2, cells // 2], 1] = True
    sheets = Sheets(triangles, rest, stiffness, stiffness, 0.5 * stiffness / (1.0 + ratio), ratio, mass_per_area=1.0)
    return Network(Nodes(place, np.zeros(grid.size, int), held), NO_BARS, Water(20.0, 1000.0, 9.81), sheets=sheets)


def moment(network: Network, place: np.ndarray, cells: int) -> tuple[float, float]:
    """Return pull and moment at the end of the sheet."""
    sheets, force = network.sheets, np.zeros(place.size)
    assert sheets is not None
    flat = np.ascontiguousarray(place).ravel()
    kernel.sheet_forces(
        sheets.constants(network.water), sheets.triangles, flat, 0, np.zeros(flat.size), 0, force, 0, 3, 1,
        np.zeros(len(sheets)),
    )  # fmt: skip
    end = force.reshape(-1, 3)[-(cells + 1) :, 0]
    return float(-end.sum()), float(end @ np.linspace(-0.5, 0.5, cells + 1))


def wrinkled_moment(pull: float, curvature: float, stiffness: float) -> float:
    """Return the moment of a sheet of depth 1 m that bears no compression, in closed form (a triangle of stress)."""
    loaded = math.sqrt(2.0 * pull / (stiffness * curvature))
    return stiffness * curvature / 12.0 if loaded >= 1.0 else pull * (0.5 - loaded / 3.0)


@pytest.mark.slow
@pytest.mark.parametrize(("curvature", "cells", "error"), [(3e-3, 8, 0.03), (3e-3, 16, 0.015), (8e-3, 16, 0.025)])
def test_sheet_slack_along_one_edge_finds_its_rest(curvature: float, cells: int, error: float) -> None:
    """Slack cloth has no tangent: dynamic relaxation leads there."""
    stiffness = 1e6
    network = bent(cells, curvature, 1e-3, 0.0, stiffness)
    rest = solve_equilibrium(network)
    assert rest.residual <= 1e-5
    assert network.sheets is not None
    pull, found = moment(network, rest.state.position, cells)
    assert found == pytest.approx(wrinkled_moment(pull, curvature, stiffness), rel=error)
    # what bears nothing is slack, or pulls by rounding
    pulls = sheet_stress(network.sheets, rest.state.position).first
    assert np.count_nonzero(pulls < 1e-8 * pulls.max()) > 0


def test_dynamic_relaxation_counts_the_pull_of_sheets() -> None:
    """A sheet alone calms, without a bar to measure by."""
    network, strain, stiffness = stretched(np.random.default_rng(2), 9.81, 1.0)
    rest = relax_network(network, tolerance=1e-7)
    stress = sheet_stress(network.sheets, rest.state.position)
    assert rest.residual <= 1e-7
    assert stress.warp == pytest.approx(stiffness * (strain + 0.5 * strain**2), rel=1e-4)


@pytest.mark.parametrize("moved", [0.0, 1e-9])
def test_sheet_that_nothing_loads_rests_as_built(moved: float) -> None:
    """Cloth as heavy as water between fixed edges: the ladder of its stiffness has no first rung."""
    grid = np.arange(20).reshape(5, 4)
    along, across = np.linspace(0.0, 2.0, 5), np.linspace(0.0, 1.5, 4)
    triangles, rest = sheet_grid(grid, along, across)
    place = np.zeros((20, 3))
    place[:, :2] = np.stack(np.meshgrid(along, across, indexing="ij"), -1).reshape(-1, 2)
    place[:, 2] = -3.0
    kind = np.zeros(20, int)
    kind[grid[[0, -1]].ravel()] = FIXED
    place[kind == 0] += moved * np.random.default_rng(1).normal(size=(12, 3))
    sheets = Sheets(triangles, rest, 1e5, 1e4, 1e3, mass_per_area=1.0, volume_per_area=1e-3)
    network = Network(Nodes(place, kind, np.zeros((20, 3), bool)), NO_BARS, Water(20.0, 1000.0, 9.81), sheets=sheets)
    found = solve_equilibrium(network)
    assert found.residual < 1e-5
    assert found.state.position == pytest.approx(place, abs=1e-6)


@pytest.mark.parametrize("seed", range(2))
def test_work_of_pressure_is_that_of_the_volume_swept(seed: int) -> None:
    """Cloth as heavy as water, blown out between fixed edges: p times the volume, and none of it from nowhere."""
    rng = np.random.default_rng(seed)
    length, depth, pressure = *rng.uniform(0.5, 3.0, 2), float(rng.choice([-1.0, 1.0]) * rng.uniform(5.0, 50.0))
    grid = np.arange(30).reshape(6, 5)
    along, across = np.linspace(0.0, length, 6), np.linspace(0.0, depth, 5)
    triangles, rest = sheet_grid(grid, along, across)
    place = np.zeros((30, 3))
    place[:, :2] = np.stack(np.meshgrid(along, across, indexing="ij"), -1).reshape(-1, 2)
    place[:, 2] = -3.0
    kind = np.full(30, FIXED)
    kind[grid[1:-1, 1:-1].ravel()] = 0
    sheets = Sheets(
        triangles, rest, 2e4, 1e4, 3e3, mass_per_area=1.0, volume_per_area=1e-3, pressure=pressure, damping_time=1e-4
    )
    network = Network(Nodes(place, kind, np.zeros((30, 3), bool)), NO_BARS, Water(20.0, 1000.0, 9.81), sheets=sheets)
    run = simulate(network, duration=1.0, output_step=0.05)

    def volume(x: np.ndarray) -> float:
        a, b, c = (x[sheets.triangles[:, k]] for k in range(3))
        return float(np.sum(a * np.cross(b, c)) / 6.0)

    swept = np.array([volume(x) for x in run.position]) - volume(run.position[0])
    assert run.status == "converged"
    assert not any(notice.code == "energy-from-nowhere" for notice in run.notices)
    assert np.max(run.work) > 0.0
    assert run.work - run.work[0] == pytest.approx(pressure * swept, abs=1e-3 * float(np.max(np.abs(pressure * swept))))
