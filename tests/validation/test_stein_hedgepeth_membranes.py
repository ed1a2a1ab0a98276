"""Membranes that wrinkle against closed forms.

Pure bending of a stretched strip: Stein and Hedgepeth, Analysis of partly wrinkled membranes, NASA TN D-813 (1961).
Shear of a strip that bears no compression: Wagner (1929). A disc that a hub turns, with straight tension lines:
Reissner (1938). Rest is found by minimising the energy of the kernels with scipy, apart from the solvers of networks.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import minimize, minimize_scalar
from scipy.spatial import Delaunay

from moyai.flexible import sheet_kernel as kernel
from moyai.flexible.sheets import Sheets, sheet_grid, sheet_stress
from moyai.sea.water import Water

STIFF = 1e6
WATER = Water(20.0, 1000.0, 9.81)


def forces(sheets: Sheets, place: np.ndarray) -> np.ndarray:
    out = np.zeros(place.size)
    kernel.sheet_forces(
        sheets.constants(WATER), sheets.triangles, place.ravel(), 0, np.zeros(place.size), 0, out, 0, 3, 1,
        np.zeros(len(sheets)),
    )  # fmt: skip
    return out.reshape(-1, 3)


def at_rest(sheets: Sheets, place: np.ndarray, free: np.ndarray) -> np.ndarray:
    """Return the places of least energy; ``free`` names the components that may move."""
    table, x = sheets.constants(WATER), np.array(place)
    chosen = np.flatnonzero(free.ravel())

    def energy(values: np.ndarray) -> tuple[float, np.ndarray]:
        x.ravel()[chosen] = values
        whole = float(kernel.sheet_energy(table, sheets.triangles, x.ravel(), 0, 3, 1))
        return whole / STIFF, -forces(sheets, x).ravel()[chosen] / STIFF

    options = {"maxiter": 20000, "maxfun": 40000, "maxcor": 50, "ftol": 1e-30, "gtol": 1e-13}
    found = minimize(energy, x.ravel()[chosen], jac=True, method="L-BFGS-B", options=options)
    x.ravel()[chosen] = found.x
    return x


def isotropic(triangles: np.ndarray, rest: np.ndarray, ratio: float) -> Sheets:
    return Sheets(triangles, rest, STIFF, STIFF, 0.5 * STIFF / (1.0 + ratio), ratio)


def bent(cells: int, ratio: float, curvature: float) -> tuple[float, float]:
    """Return pull and moment of a strip of height 1 m stretched by 1e-4 and bent."""
    along, height = max(2, cells // 4), 0.25
    grid = np.arange((along + 1) * (cells + 1)).reshape(along + 1, cells + 1)
    x, y = np.linspace(-0.5 * height, 0.5 * height, along + 1), np.linspace(-0.5, 0.5, cells + 1)
    sheets = isotropic(*sheet_grid(grid, x, y), ratio)
    xx, yy = np.meshgrid(x, y, indexing="ij")
    place = np.zeros((grid.size, 3))
    place[:, 0] = (xx * (1.0001 - curvature * yy)).ravel()
    place[:, 1] = (yy + 0.5 * curvature * xx**2).ravel()
    free = np.ones((grid.size, 3), dtype=bool)
    free[:, 2] = False
    free[grid[[0, -1]].ravel(), 0] = False
    free[grid[along // 2, cells // 2], 1] = False
    pull = forces(sheets, at_rest(sheets, place, free))[grid[-1], 0]
    return abs(float(pull.sum())), abs(float(np.sum(pull * y)))


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.0, 0.4])
@pytest.mark.parametrize(("curvature", "wrinkled"), [(1e-4, False), (3e-4, True), (1e-3, True)])
def test_bending_of_a_stretched_strip(ratio: float, curvature: float, wrinkled: bool) -> None:
    """Beyond M = P h / 6 a part wrinkles: 2 M / P h = 1 - 2/3 sqrt(2 P / (K h^2 kappa)), whatever the contraction."""
    error = []
    for cells in (8, 16, 32):
        pull, moment = bent(cells, ratio, curvature)
        assert (moment > pull / 6.0 * 1.05) is wrinkled
        exact = STIFF * curvature / 12.0
        if wrinkled:
            exact = 0.5 * pull * (1.0 - 2.0 / 3.0 * math.sqrt(2.0 * pull / (STIFF * curvature)))
        error.append(moment / exact - 1.0)
    # second order; what is left is the stretch of the law, 1.5 e
    assert abs((4.0 * error[2] - error[1]) / 3.0) < 1e-3
    assert abs(error[2]) < 0.0025 and error[1] < 0.35 * error[0]


@pytest.mark.parametrize("seed", range(3))
def test_shear_is_borne_by_tension_at_half_a_right_angle(seed: int) -> None:
    """Wagner: shear and pull K gamma / 4 per length on any mesh, for any contraction; the plate would bear G gamma."""
    rng = np.random.default_rng(seed)
    side = np.linspace(0.0, 1.0, 6)
    edge = np.concatenate([np.stack([side, 0.0 * side], 1), np.stack([side, 0.0 * side + 1.0], 1)])
    walls = np.stack([np.repeat([0.0, 1.0], 4), np.tile(side[1:-1], 2)], 1)
    flat = np.concatenate([edge, walls, rng.uniform(0.1, 0.9, (12, 2))])
    triangles = Delaunay(flat).simplices
    ratio, gamma, turn = rng.uniform(-0.3, 0.45), 1e-4, rng.uniform(0.0, math.pi)
    threads = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    rest = (flat @ threads.T)[triangles]
    sheets = isotropic(triangles, rest, ratio)
    place = np.column_stack([flat[:, 0] + gamma * flat[:, 1], flat[:, 1], 0.0 * flat[:, 0]])
    stress = sheet_stress(sheets, place)
    assert np.all(stress.state == 1)
    assert stress.first == pytest.approx(np.full(len(sheets), 0.5 * STIFF * gamma), rel=3e-4)
    assert np.abs(stress.second).max() < 1e-9 * STIFF * gamma
    pull = forces(sheets, place)
    assert np.abs(pull[20:]).max() < 1e-9 * STIFF * gamma
    # what the edges bear, by the virial of their forces: mean shear and mean pull across
    whole = -np.sum(pull * (flat[:, 1] - 0.5)[:, None], axis=0)
    assert whole[:2] == pytest.approx(np.full(2, 0.25 * STIFF * gamma), rel=1e-3)


def disc(rings: int, ratio: float, inner: float, angle: float) -> float:
    """Return the torque on the hub of a disc of radius 1 m."""
    count = 6 * rings
    turn, radius = 2.0 * math.pi * np.arange(count) / count, np.linspace(inner, 1.0, rings + 1)
    flat = np.stack([np.outer(radius, np.cos(turn)), np.outer(radius, np.sin(turn))], -1).reshape(-1, 2)
    number = np.arange((rings + 1) * count).reshape(rings + 1, count)
    triangles = []
    for i in range(rings):
        for j in range(count):
            p, q, s, t = number[i, j], number[i + 1, j], number[i + 1, (j + 1) % count], number[i, (j + 1) % count]
            triangles += [[p, q, s], [p, s, t]] if (i + j) % 2 else [[p, q, t], [q, s, t]]
    corners = np.array(triangles)
    sheets = isotropic(corners, flat[corners], ratio)
    # the hub turns rigidly, the sheet follows linearly over the radius to start with
    share = np.repeat(angle * (1.0 - (radius - inner) / (1.0 - inner)), count)
    place = np.zeros((flat.shape[0], 3))
    place[:, 0] = np.cos(share) * flat[:, 0] - np.sin(share) * flat[:, 1]
    place[:, 1] = np.sin(share) * flat[:, 0] + np.cos(share) * flat[:, 1]
    free = np.ones(place.shape, dtype=bool)
    free[:, 2] = False
    free[number[[0, -1]].ravel()] = False
    place = at_rest(sheets, place, free)
    pull = forces(sheets, place)[number[0]]
    hub = place[number[0]]
    return abs(float(np.sum(hub[:, 0] * pull[:, 1] - hub[:, 1] * pull[:, 0])))


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [pytest.param(0.0, marks=pytest.mark.slow), 0.35])
def test_torsion_of_a_disc_by_its_hub(ratio: float) -> None:
    """Tension lines that touch a circle c: T = 2 pi K phi c^2 / ln(s_b / s_a), s^2 = r^2 - c^2, at its highest."""
    inner, angle = 0.3, 2e-4

    def torque(c: float) -> float:
        return 4.0 * math.pi * STIFF * angle * c * c / math.log((1.0 - c * c) / (inner * inner - c * c))

    exact = -float(
        minimize_scalar(
            lambda c: -torque(c), bounds=(1e-3, inner - 1e-9), method="bounded", options={"xatol": 1e-12}
        ).fun
    )
    error = [disc(rings, ratio, inner, angle) / exact - 1.0 for rings in (6, 12, 24)]
    assert 0.0 < error[2] < 0.012 and error[2] < 0.4 * error[1] < 0.16 * error[0]
