"""Sheets: tension field, patch tests, gradients, closed forms, stable step, energy, faults."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible import sheet_kernel as kernel
from moyai.flexible.arrays import kernel_arrays
from moyai.flexible.elements import FIXED, Bars, Nodes
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.sheets import Sheets, sheet_grid, sheet_stress
from moyai.flexible.simulation import simulate
from moyai.flexible.stability import step_limit
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water

WATER = Water(20.0, 1000.0, 9.81)
NO_BARS = Bars([], [], [], [], ())


def random_sheet(rng: np.random.Generator, *, tension_field: bool = True, **more: float) -> tuple[Sheets, np.ndarray]:
    """Return an irregular sheet of 3 x 3 cells and its unstretched places."""
    x, y = np.linspace(0.0, 2.0, 4), np.linspace(0.0, 1.5, 4)
    triangles, _ = sheet_grid(np.arange(16).reshape(4, 4), x, y)
    flat = np.stack(np.meshgrid(x, y, indexing="ij"), -1).reshape(16, 2)
    flat[[5, 6, 9, 10]] += rng.uniform(-0.12, 0.12, (4, 2))
    warp, weft, shear = 10.0 ** rng.uniform(2.0, 4.0, 3)
    contraction = rng.uniform(-0.5, 0.8) * math.sqrt(warp / weft)
    sheets = Sheets(
        triangles, flat[triangles], warp, weft, shear, contraction, tension_field=tension_field,
        **{"mass_per_area": 1.0, **more},
    )  # fmt: skip
    return sheets, flat


def forces(sheets: Sheets, place: np.ndarray, speed: np.ndarray | None = None) -> np.ndarray:
    out, at = np.zeros(place.size), np.zeros(len(sheets))
    velocity = np.zeros(place.size) if speed is None else speed.ravel()
    table = sheets.constants(WATER)
    kernel.sheet_forces(table, sheets.triangles, place.ravel(), 0, velocity, 0, out, 0, 3, 1, at)
    return out.reshape(-1, 3)


def energy(sheets: Sheets, place: np.ndarray) -> float:
    return float(kernel.sheet_energy(sheets.constants(WATER), sheets.triangles, place.ravel(), 0, 3, 1))


@pytest.mark.parametrize("seed", range(8))
def test_wrinkled_stress_is_the_best_of_all_single_pulls(seed: int) -> None:
    """The energy is the largest of e_t^2 / 2 c_t over all directions t, or the elastic one where no stress pushes."""
    rng = np.random.default_rng(seed)
    sheets, _ = random_sheet(rng)
    table = sheets.constants(WATER)
    warp, weft, shear, ratio = (
        float(np.asarray(v)[0])
        for v in (sheets.warp_stiffness, sheets.weft_stiffness, sheets.shear_stiffness, sheets.contraction)
    )
    soft = np.array([[1 / warp, -ratio / warp, 0.0], [-ratio / warp, 1 / weft, 0.0], [0.0, 0.0, 1 / shear]])
    angle = np.linspace(0.0, math.pi, 40001)
    c, s = np.cos(angle), np.sin(angle)
    pull = np.stack([c * c, s * s, c * s])
    compliance = np.einsum("ia,ij,ja->a", pull, soft, pull)
    states = set()
    for strain in 0.01 * rng.normal(size=(60, 3)):
        s11, s22, s12, found, state = kernel.tensile_stress(table, 0, *strain)
        states.add(state)
        along = np.maximum(strain @ pull, 0.0)
        elastic = np.linalg.solve(soft, strain)
        if state == 2:
            assert elastic[0] * elastic[1] >= elastic[2] ** 2 and elastic[0] >= 0.0
            assert found == pytest.approx(0.5 * strain @ elastic, rel=1e-12)
        else:
            whole = 0.5 * strain @ elastic
            assert found == pytest.approx(float(np.max(0.5 * along**2 / compliance)), abs=2e-7 * whole)
        # no push in any direction
        assert s11 + s22 >= -1e-12 and s11 * s22 - s12**2 >= -1e-9 * (s11 + s22) ** 2
    assert states == {0, 1, 2}


@pytest.mark.parametrize("seed", range(4))
def test_patch_of_one_strain(seed: int) -> None:
    """A random affine motion of an irregular mesh: one stress everywhere, no force inside."""
    rng = np.random.default_rng(seed)
    sheets, flat = random_sheet(rng, tension_field=False)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    gradient = turn[:, :2] @ (np.eye(2) + 0.02 * rng.normal(size=(2, 2)))
    place = flat @ gradient.T + rng.normal(size=3)
    strain = 0.5 * (gradient.T @ gradient - np.eye(2))
    stress = sheet_stress(sheets, place)
    table = sheets.constants(WATER)[0]
    wanted = table[kernel.C11] * strain[0, 0] + table[kernel.C12] * strain[1, 1]
    assert stress.warp == pytest.approx(np.full(18, wanted), rel=1e-9, abs=1e-9 * abs(table[kernel.C11]))
    assert stress.shear == pytest.approx(np.full(18, 2.0 * table[kernel.C33] * strain[0, 1]), rel=1e-7, abs=1e-8)
    inside = forces(sheets, place)[[5, 6, 9, 10]]
    assert np.max(np.abs(inside)) < 1e-9 * np.max(np.abs(forces(sheets, place)))


@pytest.mark.parametrize("seed", range(6))
def test_forces_are_the_gradient_of_the_energy(seed: int) -> None:
    rng = np.random.default_rng(seed)
    sheets, flat = random_sheet(rng)
    place = np.column_stack([flat, np.zeros(16)]) + 0.05 * rng.normal(size=(16, 3))
    pull, step = forces(sheets, place), 1e-7
    for node, axis in rng.integers(0, [16, 3], (12, 2)):
        moved = place.copy()
        moved[node, axis] += step
        high = energy(sheets, moved)
        moved[node, axis] -= 2.0 * step
        assert pull[node, axis] == pytest.approx(
            -(high - energy(sheets, moved)) / (2.0 * step), rel=1e-4, abs=1e-5 * np.max(np.abs(pull))
        )


@pytest.mark.parametrize("seed", range(4))
def test_turned_sheets_and_momentum(seed: int) -> None:
    """Forces turn with the sheet; without pressure they leave momentum and its moment alone, viscosity included."""
    rng = np.random.default_rng(seed)
    sheets, flat = random_sheet(rng, damping_time=0.01)
    place = np.column_stack([flat, np.zeros(16)]) + 0.05 * rng.normal(size=(16, 3))
    speed = rng.normal(size=(16, 3))
    pull = forces(sheets, place, speed)
    scale = np.max(np.abs(pull))
    assert np.max(np.abs(pull.sum(axis=0))) < 1e-10 * scale
    assert np.max(np.abs(np.cross(place, pull).sum(axis=0))) < 1e-10 * scale
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turned = forces(sheets, place @ turn.T + 3.0, speed @ turn.T)
    assert turned == pytest.approx(pull @ turn.T, abs=1e-8 * scale)
    # viscosity only takes: power of the damped force beyond the elastic one is not positive
    assert float(np.sum((pull - forces(sheets, place)) * speed)) <= 1e-9 * scale


def test_pressure_pushes_along_the_enclosed_normal() -> None:
    """A flat square under pressure: force pressure times area along its normal."""
    triangles, rest = sheet_grid(np.arange(9).reshape(3, 3), [0.0, 1.0, 2.0], [0.0, 0.5, 1.0])
    sheets = Sheets(triangles, rest, 1e3, 1e3, 1e3, pressure=7.0)
    x, y = np.meshgrid([0.0, 1.0, 2.0], [0.0, 0.5, 1.0], indexing="ij")
    place = np.column_stack([x.ravel(), y.ravel(), np.zeros(9)])
    assert forces(sheets, place).sum(axis=0) == pytest.approx([0.0, 0.0, 14.0], abs=1e-9)


def strip(cells: int, length: float, chord: float, **values: float) -> Network:
    """Return a strip of cloth that hangs between two held edges, its nodes on a shallow arc."""
    s = np.linspace(0.0, 1.0, cells + 1)
    grid = np.arange(2 * (cells + 1)).reshape(2, cells + 1)
    place = np.zeros((grid.size, 3))
    place[:, 1] = np.repeat([0.0, 0.1], cells + 1)
    place[:, 0] = np.tile(0.3 * chord * np.sin(math.pi * s), 2)
    place[:, 2] = np.tile(-chord * s, 2)
    kind = np.zeros(grid.size, dtype=int)
    kind[grid[:, [0, -1]].ravel()] = FIXED
    held = np.zeros((grid.size, 3), dtype=bool)
    held[:, 1] = True
    triangles, rest = sheet_grid(grid, [0.0, 0.1], length * s)
    sheets = Sheets(triangles, rest, 0.0, mass_per_area=1.0, volume_per_area=1e-3, **values)
    return Network(Nodes(place, kind, held), NO_BARS, WATER, sheets=sheets)


@pytest.mark.parametrize(("length", "stiffness", "pressure"), [(1.2, 1e4, 50.0), (1.05, 3e3, 20.0), (1.0, 1e4, 40.0)])
def test_pressurised_cylinder(length: float, stiffness: float, pressure: float) -> None:
    """Uniform pressure makes an arc whose tension is pressure times radius, whatever its stretch."""
    cells = 60
    network = strip(cells, length, 1.0, weft_stiffness=stiffness, pressure=pressure)
    found = solve_equilibrium(network)
    place = found.state.position[: cells + 1]
    sagitta = abs(place[cells // 2, 0])
    radius = 0.5 * (0.25 / sagitta + sagitta)
    # of the polygon: the arc through its corners is longer by more than the cloth stretches
    stretch = float(np.sum(np.linalg.norm(np.diff(place, axis=0), axis=1))) / length
    assert stretch == pytest.approx(4.0 * radius * math.atan(2.0 * sagitta) / length, rel=3e-4)
    wanted = stiffness * stretch * 0.5 * (stretch**2 - 1.0)
    assert wanted == pytest.approx(pressure * radius, rel=4e-3)
    stress = sheet_stress(network.sheets, found.state.position)  # type: ignore[arg-type]
    assert stress.first * stretch == pytest.approx(np.full(2 * cells, pressure * radius), rel=6e-3)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.25, 0.5, 1.0, 2.0])
def test_skirt_in_a_current(ratio: float) -> None:
    """Toe weight W, load q cos^2: tension W, reach a asinh(L/a), flare sqrt(a^2 + L^2) - a with a = W/q."""
    cells, length, drag, speed = 60, 2.0, 1.4, 0.5
    load = 500.0 * drag * speed**2
    weight = load * length / ratio
    grid = np.arange(2 * (cells + 1)).reshape(2, cells + 1)
    s = np.linspace(0.0, length, cells + 1)
    place = np.zeros((grid.size, 3))
    place[:, 1], place[:, 2] = np.repeat([0.0, 0.2], cells + 1), np.tile(-2.0 - s, 2)
    kind = np.zeros(grid.size, dtype=int)
    kind[grid[:, 0]] = FIXED
    held = np.zeros((grid.size, 3), dtype=bool)
    held[:, 1] = True
    mass = np.zeros(grid.size)
    mass[grid[:, -1]] = 0.1 * weight / WATER.gravity
    triangles, rest = sheet_grid(grid, [0.0, 0.2], s)
    sheets = Sheets(
        triangles, rest, 0.0, 2e7, mass_per_area=0.5, volume_per_area=0.5e-3, drag_normal=drag,
    )  # fmt: skip
    network = Network(Nodes(place, kind, held, mass=mass), NO_BARS, WATER, sheets=sheets)
    found = solve_equilibrium(network, flow=Flow((speed, 0.0, 0.0)))
    toe = found.state.position[cells]
    a = weight / load
    assert -2.0 - toe[2] == pytest.approx(a * math.asinh(length / a), rel=2e-3)
    assert toe[0] == pytest.approx(math.hypot(a, length) - a, rel=4e-3)
    stress = sheet_stress(sheets, found.state.position)
    assert stress.weft == pytest.approx(np.full(2 * cells, weight), rel=3e-3)


@pytest.mark.parametrize("seed", range(4))
def test_stable_step_bounds_the_dense_matrix(seed: int) -> None:
    rng = np.random.default_rng(seed)
    sheets, flat = random_sheet(rng, tension_field=False)
    place = np.column_stack([flat, np.zeros(16)])
    network = Network(Nodes(place, np.zeros(16, dtype=int)), NO_BARS, WATER, sheets=sheets)
    step, matrix = 1e-6, np.empty((48, 48))
    for column in range(48):
        moved = place.ravel().copy()
        moved[column] += step
        high = forces(sheets, moved.reshape(16, 3)).ravel()
        moved[column] -= 2.0 * step
        matrix[:, column] = -(high - forces(sheets, moved.reshape(16, 3)).ravel()) / (2.0 * step)
    mass = np.repeat(network.node_mass, 3)
    fastest = math.sqrt(np.max(np.linalg.eigvals(matrix / mass[:, None]).real))
    inverse = np.zeros((6, 16))
    inverse[[0, 3, 5]] = 1.0 / network.node_mass
    limit, _ = step_limit(
        kernel_arrays(network), place.T.copy(), inverse, None, (sheets.constants(WATER), sheets.triangles)
    )
    assert 0.4 < limit / (2.0 / fastest) <= 1.0 + 1e-6


def test_a_wrinkling_sheet_keeps_its_energy() -> None:
    """A loose sheet without viscosity, thrown out of its plane: energy and momentum stay."""
    rng = np.random.default_rng(5)
    sheets, flat = random_sheet(rng)
    place = np.column_stack([1.01 * flat, np.zeros(16)])
    network = Network(Nodes(place, np.zeros(16, dtype=int)), NO_BARS, Water(20.0, 1000.0, 1e-9), sheets=sheets)
    speed = 0.3 * rng.normal(size=(16, 3))
    history = simulate(network, duration=0.5, output_step=0.005, start=State(0.0, place, speed), safety=0.1)
    total = history.kinetic_energy + history.elastic_energy
    assert np.max(np.abs(total / total[0] - 1.0)) < 2e-3
    mass = network.node_mass[:, None]
    gained = np.sum(mass * (history.final.velocity - speed), axis=0)
    assert np.max(np.abs(gained)) < 1e-9 * np.sum(mass * np.abs(speed))


def test_wet_part_of_a_triangle() -> None:
    rng = np.random.default_rng(3)
    share = rng.dirichlet([1.0, 1.0, 1.0], 40000)
    for heights in rng.normal(size=(12, 3)):
        assert kernel.wet_share(*heights) == pytest.approx(float(np.mean(share @ heights < 0.0)), abs=0.01)
    assert kernel.wet_share(1.0, 2.0, 0.0) == 0.0
    assert kernel.wet_share(-1.0, 0.0, -2.0) == 1.0


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"weft_stiffness": -1.0}, "0 or more"),
        ({"warp_stiffness": 0.0, "weft_stiffness": 0.0, "shear_stiffness": 0.0}, "without stiffness"),
        ({"contraction": 1.2, "shear_stiffness": 1.0, "warp_stiffness": 1.0, "weft_stiffness": 1.0}, "yields energy"),
        ({"contraction": 0.3, "shear_stiffness": 0.0}, "contraction"),
        ({"warp_stiffness": 0.0, "shear_stiffness": 5.0}, "shear stiffness"),
        ({"mass_per_area": math.nan}, "mass_per_area"),
        ({"triangles": [[0, 1, 1]]}, "twice"),
        ({"rest": [[[0.0, 0.0], [0.0, 1.0], [1.0, 0.0]]]}, "clockwise"),
        ({"rest": [[[0.0, 0.0], [1.0, 0.0]]]}, "unstretched corners"),
        ({"drag_normal": [1.0, 2.0]}, "shape"),
    ],
)
def test_faults(change: dict[str, object], words: str) -> None:
    given = {
        "triangles": [[0, 1, 2]], "rest": [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]], "warp_stiffness": 10.0,
        "weft_stiffness": 10.0,
    }  # fmt: skip
    with pytest.raises(InputError, match=words):
        Sheets(**{**given, **change})  # type: ignore[arg-type]


@pytest.mark.parametrize("stretch", [1.01, 1.3, 1.8])
def test_the_step_of_a_stretched_strip_is_stable(stretch: float) -> None:
    """The pull of the strip itself counts: without it the step of a strip at 1.8 times its length was too long."""
    cells = 12
    along = np.linspace(0.0, 2.0, cells + 1)
    triangles, rest = sheet_grid(np.arange(2 * cells + 2).reshape(2, cells + 1), [0.0, 0.1], along)
    sheets = Sheets(triangles, rest, 0.0, 1e3, mass_per_area=1.0)
    place = np.zeros((2 * cells + 2, 3))
    place[:, 1], place[:, 2] = np.repeat([0.0, 0.1], cells + 1), -stretch * np.tile(along, 2)
    network = Network(Nodes(place, np.zeros(len(place), dtype=int)), NO_BARS, WATER, sheets=sheets)
    size, matrix = place.size, np.empty((place.size, place.size))
    for column in range(size):
        pulls = []
        for move in (1e-6, -1e-6):
            moved = place.copy()
            moved.ravel()[column] += move
            pulls.append(forces(sheets, moved).ravel())
        matrix[:, column] = (pulls[1] - pulls[0]) / 2e-6
    fastest = math.sqrt(np.max(np.linalg.eigvals(matrix / np.repeat(network.node_mass, 3)[:, None]).real))
    inverse = np.zeros((6, len(place)))
    inverse[[0, 3, 5]] = 1.0 / network.node_mass
    limit, _ = step_limit(
        kernel_arrays(network), place.T.copy(), inverse, None, (sheets.constants(WATER), sheets.triangles)
    )
    assert 0.6 < limit / (2.0 / fastest) < 0.95
