"""The same sheets on a finer mesh: what stays the same, what is held, and how uncertain a peak next to cloth is."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible import sheet_kernel as kernel
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import DRIVEN, FIXED, FREE, BarType
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.refine import refined, with_viscosity
from moyai.flexible.result import State
from moyai.flexible.sensitivity import peak_sensitivity
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.water import Water

WATER = Water(20.0, 1000.0, 9.81)
ROPE = BarType("rope", 0.5, 2e5, 0.02, viscosity=300.0, drag_normal=1.2, added_mass_normal=1.0)


def skirt(rows: int = 3, columns: int = 4, first_row: str = "fixed") -> Network:
    """Return cloth under a held row, a rope along its toe and one from a corner to the bed."""
    builder = NetworkBuilder(WATER)
    v, u = np.meshgrid(np.linspace(0.0, 1.0, rows), np.linspace(0.0, 1.0, columns), indexing="ij")
    points = np.stack([0.3 * v, 6.0 * u, -1.0 - 3.0 * v], axis=-1)
    builder.sheet(
        "skirt", points, warp=np.linspace(0.0, 3.0, rows), weft=np.linspace(0.0, 6.0, columns),
        first_row=first_row, warp_stiffness=2e4, weft_stiffness=1e4, shear_stiffness=2e3, contraction=0.2,
        mass_per_area=4.0, volume_per_area=2e-3, drag_normal=1.3, drag_tangential=0.02, damping_time=1e-3,
        added_mass_per_area=1500.0,
    )  # fmt: skip
    toe = f"skirt[{rows - 1},"
    for j in range(columns - 1):
        builder.line(f"toe {j}", f"{toe}{j}]", f"{toe}{j + 1}]", ROPE, length=6.0 / (columns - 1), segments=1)
    builder.fixed("anchor", (-5.0, 0.0, -12.0))
    builder.line("stay", "anchor", f"{toe}0]", ROPE, length=9.6, segments=4, shape="straight")
    return builder.build()


@pytest.mark.parametrize("factor", [2, 4])
def test_a_finer_sheet_is_the_same_sheet(factor: int) -> None:
    rng = np.random.default_rng(factor)
    network = skirt()
    assert network.sheets is not None
    state = State(3.0, rng.normal(size=network.nodes.position.shape), rng.normal(size=network.nodes.position.shape))
    finer, now = refined(network, factor, state)
    assert finer.sheets is not None and len(finer.sheets) == factor**2 * len(network.sheets)
    for name in ("node_mass", "node_volume"):
        assert getattr(finer, name).sum() == pytest.approx(getattr(network, name).sum(), rel=1e-12)
    assert finer.sheets.area.sum() == pytest.approx(18.0, rel=1e-12)
    # straight edges, cut: any shape of the coarse mesh has its energy on the fine one
    energies = [
        kernel.sheet_energy(net.sheets.constants(WATER), net.sheets.triangles, place.ravel(), 0, 3, 1)  # type: ignore[union-attr]
        for net, place in ((network, state.position), (finer, now.position))
    ]
    assert energies[1] == pytest.approx(energies[0], rel=1e-12)
    for name, node in network.points.items():
        assert np.array_equal(now.position[finer.points[name]], state.position[node])
        assert np.array_equal(now.velocity[finer.points[name]], state.velocity[node])
    # one node in each place: the rope along the toe keeps to the cloth
    rest = refined(network, factor)[1].position
    assert len(np.unique(np.round(rest, 9), axis=0)) == len(rest)
    toe = np.flatnonzero(np.abs(rest[:, 2] + 4.0) < 1e-9)
    assert toe.size == 3 * factor + 1 and np.isin(toe, finer.sheets.triangles).all()


def test_borders_that_stay_do_so_on_the_fine_mesh() -> None:
    for first_row, kind in (("fixed", FIXED), ("driven", DRIVEN)):
        finer, _ = refined(skirt(first_row=first_row), 2)
        top = np.abs(finer.nodes.position[:, 2] + 1.0) < 1e-9
        assert top.sum() == 7 and np.all(finer.nodes.kind[top] == kind)
        assert np.all(finer.nodes.motion[top] == (0 if kind == DRIVEN else -1))
        assert np.all(finer.nodes.kind[~top & (finer.nodes.position[:, 0] > -1.0)] == FREE)
    plane = skirt()
    held = np.zeros((len(plane.nodes), 3), dtype=bool)
    held[:, 1] = True
    finer, _ = refined(replace(plane, nodes=replace(plane.nodes, held=held)), 2)
    cloth = np.unique(finer.sheets.triangles)  # type: ignore[union-attr]
    moves = cloth[finer.nodes.kind[cloth] == FREE]
    assert finer.nodes.held[moves, 1].all() and not finer.nodes.held[moves][:, [0, 2]].any()


def test_rest_of_finer_sheets_converges() -> None:
    flow = Flow((0.4, 0.0, 0.0))
    network, toes = skirt(5, 5), []
    for _ in range(3):
        toes.append(float(solve_equilibrium(network, flow=flow).state.position[network.points["skirt[4,2]"], 0]))
        network, _ = refined(network, 2)
    assert abs(toes[2] - toes[1]) < 0.6 * abs(toes[1] - toes[0]) < 0.1


def test_the_uncertainty_of_a_peak_next_to_cloth() -> None:
    network = skirt(first_row="driven")
    drive = Motion.harmonic((0.0, 0.0, 0.3), 2.0, duration=4.0, ramp=1.0)
    begin = solve_equilibrium(network).state
    stay = int(network.strand("stay").bars[-1])
    found = peak_sensitivity(
        network, {"skirt": drive}, bar=stay, start=begin, duration=3.0, output_step=0.05,
    )  # fmt: skip
    assert found.peak > 0.0 and found.double_mesh > 0.0
    assert found.double_mesh != found.peak and found.double_viscosity != found.peak
    # six cells do not hold this peak, and the run says so
    assert [notice.code for notice in found.notices()] == ["peak-not-converged"]


def test_viscosity_of_cloth_counts() -> None:
    network = skirt()
    assert network.sheets is not None
    changed = with_viscosity(network, 0.5).sheets
    assert changed is not None
    assert np.array_equal(changed.damping_time, 0.5 * np.asarray(network.sheets.damping_time))
    with pytest.raises(InputError, match="refined 3 times"):
        refined(network, 3)
