"""Cloth against closed forms at random sizes and meshes: own weight, sag, wave front, and an energy written anew."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq, minimize_scalar
from scipy.spatial import Delaunay
from scipy.spatial.transform import Rotation

from moyai.flexible import sheet_kernel as kernel
from moyai.flexible.elements import DRIVEN, FIXED, Bars, Nodes
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.sheets import Sheets, sheet_grid, sheet_stress
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water

AIR = Water(20.0, 1e-9, 9.81)
NO_BARS = Bars([], [], [], [], ())


def strip(cells: int, length: float, stiffness: float, mass: float, place: np.ndarray, kind: np.ndarray) -> Network:
    """Return a strip 0.2 m wide whose two edges have the given places and kinds."""
    triangles, rest = sheet_grid(
        np.arange(2 * cells + 2).reshape(2, cells + 1), [0.0, 0.2], np.linspace(0.0, length, cells + 1)
    )
    both = np.concatenate([place, place + np.array([0.0, 0.2, 0.0])])
    sheets = Sheets(triangles, rest, 0.0, stiffness, mass_per_area=mass)
    return Network(Nodes(both, np.tile(kind, 2)), NO_BARS, AIR, sheets=sheets)


@pytest.mark.parametrize("seed", range(3))
def test_cloth_that_hangs_under_its_own_weight(seed: int) -> None:
    """Exact stretch of the law N = K l (l^2 - 1) / 2 under N = w (L - s), up to a third of the length."""
    rng = np.random.default_rng(seed)
    length, stiffness = rng.uniform(0.5, 20.0), 10.0 ** rng.uniform(2.0, 5.0)
    weight = stiffness * 10.0 ** rng.uniform(-2.0, 0.0) / length

    def stretch(load: float) -> float:
        return float(brentq(lambda value: 0.5 * stiffness * value * (value * value - 1.0) - load, 1.0, 50.0))

    exact = quad(lambda s: stretch(weight * (length - s)), 0.0, length, epsabs=1e-12)[0]
    error = []
    for cells in (4, 8):
        place = np.zeros((cells + 1, 3))
        place[:, 2] = -np.linspace(0.0, length, cells + 1)
        kind = np.zeros(cells + 1, dtype=int)
        kind[0] = FIXED
        found = solve_equilibrium(strip(cells, length, stiffness, weight / 9.81, place, kind)).state.position
        error.append(-found[[cells, -1], 2].mean() / exact - 1.0)
    assert abs(error[1]) < 1e-3 and error[1] == pytest.approx(0.25 * error[0], rel=0.1, abs=1e-9)


@pytest.mark.parametrize("ratio", [1.1, 1.4])
def test_sagging_cloth_is_a_catenary(ratio: float) -> None:
    span, mass = 4.0, 2.0
    a = float(brentq(lambda value: 2.0 * value * math.sinh(0.5 * span / value) - ratio * span, 0.2, 100.0))
    error = []
    for cells in (10, 20):
        s = np.linspace(0.0, 1.0, cells + 1)
        place = np.stack([span * s, 0.0 * s, -0.5 * np.sin(math.pi * s)], axis=1)
        kind = np.zeros(cells + 1, dtype=int)
        kind[[0, -1]] = FIXED
        network = strip(cells, ratio * span, 1e8, mass, place, kind)
        found = solve_equilibrium(network).state.position
        # alternate diagonals load the two edges by turns: their mean sags as the strip
        middle = found[[cells // 2, cells + 1 + cells // 2], 2].mean()
        error.append(-middle / (a * (math.cosh(0.5 * span / a) - 1.0)) - 1.0)
        # the pull on both ends together is the weight, its horizontal part w a
        stress = sheet_stress(network.sheets, found)  # type: ignore[arg-type]
        assert stress.first.min() == pytest.approx(mass * 9.81 * a, rel=0.02 * 100 / cells**2 + 0.003)
    assert abs(error[1]) < 1.2e-3 and error[1] < 0.3 * error[0]


def test_the_front_of_a_strip_that_is_drawn_bears_v_root_km() -> None:
    """As of a string, T0 = V sqrt(EA m): the mean behind the front, for speeds up to a fiftieth of the wave."""
    cells, length, stiffness, mass = 120, 3.0, 1e5, 2.0
    pace = math.sqrt(stiffness / mass)
    for speed in (0.002 * pace, 0.02 * pace):
        place = np.zeros((cells + 1, 3))
        place[:, 0] = np.linspace(0.0, length, cells + 1)
        kind = np.zeros(cells + 1, dtype=int)
        kind[[0, -1]] = FIXED
        bare = strip(cells, length, stiffness, mass, place, kind)
        motion, kinds = np.full(2 * cells + 2, -1), np.array(bare.nodes.kind)
        motion[[cells, -1]], kinds[[cells, -1]] = 0, DRIVEN
        network = Network(
            Nodes(bare.nodes.position, kinds, motion=motion), NO_BARS, Water(20.0, 1e-9, 1e-9),
            motion_names=("end",), sheets=bare.sheets,
        )  # fmt: skip
        last = 0.8 * length / pace
        time = np.linspace(0.0, 2.0 * last, 3)
        way = np.zeros((3, 3))
        way[:, 0] = speed * time
        drive = Motion(0.0, last, way, np.tile([speed, 0.0, 0.0], (3, 1)))
        start = State(0.0, np.array(network.nodes.position), np.zeros((2 * cells + 2, 3)))
        history = simulate(network, {"end": drive}, duration=last, output_step=last / 40.0, start=start)
        stress = sheet_stress(network.sheets, history.final.position)  # type: ignore[arg-type]
        middle = network.nodes.position[network.sheets.triangles, 0].mean(axis=1)  # type: ignore[union-attr]
        behind = (middle > 0.4 * length) & (middle < 0.97 * length)
        ahead = middle < 0.1 * length
        # the law stiffens: at a strain e = V / c fronts run faster by 3 e / 4
        strain = speed / pace
        assert stress.first[behind].mean() == pytest.approx(speed * math.sqrt(stiffness * mass), rel=1e-3 + strain)
        assert np.abs(stress.first[ahead]).max() < 1e-3 * speed * math.sqrt(stiffness * mass)


def energy_anew(triangles: np.ndarray, rest: np.ndarray, place: np.ndarray, law: np.ndarray, wrinkles: bool) -> float:
    """Return the energy of triangles: Green's strain, and the best of all single pulls where the stress would push."""
    angle = np.linspace(0.0, math.pi, 1441)[:-1]
    soft, total = np.linalg.inv(law), 0.0

    def pulls(phi: np.ndarray | float) -> np.ndarray:
        return np.stack([np.cos(phi) ** 2, np.sin(phi) ** 2, np.sin(phi) * np.cos(phi)])

    for corners, flat in zip(triangles, rest, strict=True):
        edges, now = (flat[1:] - flat[0]).T, (place[corners[1:]] - place[corners[0]]).T
        gradient = now @ np.linalg.inv(edges)
        green = 0.5 * (gradient.T @ gradient - np.eye(2))
        strain = np.array([green[0, 0], green[1, 1], 2.0 * green[0, 1]])
        stress, area = law @ strain, 0.5 * np.linalg.det(edges)
        best = 0.5 * float(strain @ stress)
        if wrinkles and not (stress[0] + stress[1] >= 0.0 and stress[0] * stress[1] >= stress[2] ** 2):
            p = pulls(angle)
            value = np.maximum(strain @ p, 0.0) ** 2 / np.einsum("ia,ij,ja->a", p, soft, p)
            first = angle[int(np.argmax(value))]

            def less(phi: float, strain: np.ndarray = strain) -> float:
                p = pulls(phi)
                return -(max(float(strain @ p), 0.0) ** 2) / float(p @ soft @ p)

            found = minimize_scalar(less, bounds=(first - 0.003, first + 0.003), method="bounded")
            best = 0.5 * max(-float(found.fun), float(value.max()))
        total += area * best
    return total


@pytest.mark.parametrize("seed", range(6))
def test_energy_of_any_mesh_with_turned_threads(seed: int) -> None:
    """Random triangles, threads at any angle, flat or crumpled, anywhere in space; forces are its slope."""
    rng = np.random.default_rng(seed)
    flat = rng.uniform(0.0, 2.0, (12, 2))
    turn = rng.uniform(0.0, 2.0 * math.pi)
    threads = flat @ np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    triangles = Delaunay(flat).simplices
    rest = threads[triangles]
    area = np.linalg.det(rest[:, 1:] - rest[:, :1])
    triangles = triangles[np.abs(area) > 0.03]
    triangles = np.where((area[np.abs(area) > 0.03] < 0.0)[:, None], triangles[:, [0, 2, 1]], triangles)
    warp, weft, shear = 10.0 ** rng.uniform(2.0, 5.0, 3)
    ratio, wrinkles = rng.uniform(-0.6, 0.9) * math.sqrt(warp / weft), seed % 3 > 0
    sheets = Sheets(triangles, threads[triangles], warp, weft, shear, ratio, tension_field=wrinkles)
    law = np.linalg.inv(
        np.array([[1 / warp, -ratio / warp, 0.0], [-ratio / warp, 1 / weft, 0.0], [0.0, 0.0, 1 / shear]])
    )
    spin = Rotation.random(random_state=seed).as_matrix()
    place = np.column_stack([flat, np.zeros(12)]) @ spin.T + 0.05 * rng.normal(size=(12, 3)) + 30.0
    found = float(kernel.sheet_energy(sheets.constants(AIR), sheets.triangles, place.ravel(), 0, 3, 1))
    assert found == pytest.approx(energy_anew(triangles, threads[triangles], place, law, wrinkles), rel=1e-8)
    pull = np.zeros(36)
    kernel.sheet_forces(
        sheets.constants(AIR), sheets.triangles, place.ravel(), 0, np.zeros(36), 0, pull, 0, 3, 1, np.zeros(len(sheets))
    )
    way = rng.normal(size=(12, 3))
    ends = [
        energy_anew(triangles, threads[triangles], place + sign * 1e-5 * way, law, wrinkles) for sign in (1.0, -1.0)
    ]
    scale = float(np.linalg.norm(pull) * np.linalg.norm(way))
    assert float(np.sum(pull.reshape(12, 3) * way)) == pytest.approx(-(ends[0] - ends[1]) / 2e-5, abs=3e-4 * scale)
