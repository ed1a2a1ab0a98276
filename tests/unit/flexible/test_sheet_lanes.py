"""Sheets in the explicit scheme: triangles side by side give what they give one after the other."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.flexible import sheet_kernel, sheet_lanes
from moyai.flexible.explicit_rows import QX, ROW, TX, WU, U, X
from moyai.flexible.sheets import Sheets, sheet_grid
from moyai.sea.water import Water

WATER = Water(20.0, 1025.0, 9.81)


def _sheet(rng: np.random.Generator, *, tension_field: bool) -> tuple[Sheets, np.ndarray]:
    """Return 96 triangles, a block and a half, of cloth from soft to stiff between its threads, and places (3, n)."""
    y, z = np.linspace(0.0, 4.0, 9), np.linspace(0.3, -2.0, 7)
    triangles, rest = sheet_grid(np.arange(63).reshape(9, 7), y, -z)
    count = len(triangles)
    shear = 10.0 ** rng.uniform(0.0, 4.0, count)
    shear[::7] = 0.0  # threads alone
    sheets = Sheets(
        triangles, rest, 10.0 ** rng.uniform(1.5, 5.0, count), 3e4, shear, 0.1 * (shear > 0.0) / 30.0,
        mass_per_area=1.0, volume_per_area=1e-3, drag_normal=1.5, drag_tangential=0.02, damping_time=2e-3,
        pressure=rng.choice([0.0, 50.0], count), flow_factor=0.8, tension_field=tension_field,
        added_mass_per_area=120.0,
    )  # fmt: skip
    flat = np.stack([np.zeros(63), np.repeat(y, 7), np.tile(z, 9)])
    return sheets, flat + 0.02 * rng.normal(size=flat.shape)


@pytest.mark.parametrize("tension_field", [True, False])
@pytest.mark.parametrize("seed", range(3))
def test_forces_and_loads_are_those_of_triangles_one_by_one(seed: int, tension_field: bool) -> None:
    rng = np.random.default_rng(seed)
    sheets, place = _sheet(rng, tension_field=tension_field)
    nodes = place.shape[1]
    table = sheets.constants(WATER, place.T)
    speed, water = 0.3 * rng.normal(size=place.shape), 0.5 * rng.normal(size=(7, nodes))
    light = np.abs(rng.normal(size=(4, nodes)))
    light[2:] /= np.hypot(light[2], light[3])
    memory = np.zeros(50 * ROW)
    for first, rows in ((X, place), (U, speed), (WU, water)):
        for axis, row in enumerate(rows):
            memory[first + axis * ROW :][:nodes] = row
    packed, room = sheet_lanes.packed_constants(table), np.full(sheet_lanes.ROWS * sheet_lanes.LANES, np.nan)
    which, peak, wanted_peak = np.zeros(sheet_lanes.LANES, dtype=np.int64), np.zeros(96), np.zeros(96)
    sheet_lanes.sheet_forces(memory, sheets.triangles, packed, room, which, peak)
    rate = sheet_lanes.sheet_loads(memory, sheets.triangles, packed, room, light, 0.01)
    at, fast, flow = place.ravel(), speed.ravel(), water.ravel()
    for first, wanted in ((TX, np.zeros(3 * nodes)), (QX, np.zeros(3 * nodes))):
        if first == TX:
            sheet_kernel.sheet_forces(
                table, sheets.triangles, at, 0, fast, 0, wanted, 0, 1, nodes, wanted_peak
            )  # fmt: skip
        else:
            assert rate == pytest.approx(
                sheet_kernel.sheet_loads(
                    table, sheets.triangles, at, 0, fast, 0, flow, 0, wanted, 0, 1, nodes, light, 0.01
                ),
                rel=1e-12,
            )  # fmt: skip
        found = np.stack([memory[first + axis * ROW :][:nodes] for axis in range(3)])
        size = np.abs(wanted).max()
        assert size > 0.0
        np.testing.assert_allclose(found, wanted.reshape(3, nodes), rtol=0.0, atol=1e-12 * size)
    np.testing.assert_allclose(peak, wanted_peak, rtol=0.0, atol=1e-12 * wanted_peak.max())


@pytest.mark.parametrize("ratio", [0.0, 0.3, -0.9])
@pytest.mark.parametrize("shear", [3.0, 3e2, 3e4, 3e8])
@pytest.mark.parametrize("warp", [30.0, 1e4, 1e6])
def test_the_stress_is_the_projection_on_those_that_pull(warp: float, shear: float, ratio: float) -> None:
    """Of cloth of any kind: it nowhere pushes, the strain that it leaves nowhere stretches, and neither works."""
    rng = np.random.default_rng(7)
    sheets, _ = _sheet(rng, tension_field=True)
    weft = 3e5
    one = replace(
        sheets, warp_stiffness=warp, weft_stiffness=weft, shear_stiffness=shear,
        contraction=ratio * (warp / weft) ** 0.5,
    )  # fmt: skip
    table, states = one.constants(WATER), set()
    soft = np.linalg.inv(
        [[table[0, 5], table[0, 6], 0.0], [table[0, 6], table[0, 7], 0.0], [0.0, 0.0, table[0, 8]]]
    )  # fmt: skip
    for strain in rng.normal(size=(400, 3)) * 10.0 ** rng.uniform(-8.0, -1.0, (400, 3)):
        s11, s22, s12, energy, state = sheet_kernel.tensile_stress(table, 0, *strain)
        states.add(state)
        stress = np.array([s11, s22, s12])
        left = strain - soft @ stress
        # in axes in which both families of threads are as stiff, so that rounding counts alike along both
        stretch = np.array([warp, weft, (warp * weft) ** 0.5]) ** 0.5
        pull, rest = stress / stretch, left * stretch
        size = max(np.abs(strain * stretch))
        assert np.linalg.eigvalsh([[pull[0], pull[2]], [pull[2], pull[1]]])[0] >= -1e-11 * max(
            np.abs(pull), default=0.0
        )
        assert np.linalg.eigvalsh([[rest[0], 0.5 * rest[2]], [0.5 * rest[2], rest[1]]])[1] <= 1e-8 * size
        assert abs(pull @ rest) <= 1e-10 * max(np.abs(pull)) * size
        assert energy == pytest.approx(0.5 * stress @ soft @ stress, rel=1e-8, abs=1e-300)
    assert {0, 1} <= states
