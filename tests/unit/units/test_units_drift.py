"""Mean drift of single units: exact where there are no waves, symmetric, and summed up that of the far waves."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.structures.units import bem
from moyai.structures.units.bem import MeshPanels, panels_of, solve_frequency
from moyai.structures.units.drift import near_drift, reconciled
from moyai.structures.units.hydrodynamics import RowHydrodynamics, solve_row
from moyai.structures.units.mesh import row_mesh
from moyai.structures.units.model import Connector, Placement
from moyai.structures.units.near_field import NearField
from moyai.structures.units.response import RowModel, far_waves, respond
from moyai.validation.units import LENGTH, WATER, at_rest, row

OMEGA = np.array([1.2])


def _panels(size: float, count: int = 2) -> tuple[NearField, MeshPanels]:
    at = at_rest(row(count=count))
    mesh = row_mesh(at.section, LENGTH, at.row.placements, size, lid=True, gap_lid=False)
    panels = panels_of(mesh, at.centres)
    return NearField(at, panels), panels


def _solved(size: float, heading: float) -> tuple[NearField, RowHydrodynamics]:
    field, panels = _panels(size)
    return field, solve_row(panels, WATER, field.at.centres, OMEGA, np.array([heading]))


@pytest.mark.slow
def test_a_hull_in_still_water_is_pushed_nowhere() -> None:
    """Whatever its place: what its own weight and buoyancy do to second order adds up to nothing."""
    field, panels = _panels(2.5, 1)
    solution = solve_frequency(panels, WATER, 1.2, np.zeros(1))
    still = replace(
        solution, omega=1e-7, added_mass=0.0 * solution.added_mass, damping=0.0 * solution.damping,
        excitation=0.0 * solution.excitation, radiation=0.0 * solution.radiation,
        diffraction=0.0 * solution.diffraction, wave_number=1e-14,
    )  # fmt: skip
    motion = np.array([[0.3, -0.2j, 0.5, 0.08 + 0.05j, 0.1 - 0.04j, 0.07]])
    lifted = NearField(field.at, panels)
    # without the incident wave, whose potential has no bound in so slow a wave
    with pytest.MonkeyPatch.context() as patch:
        nothing = np.zeros((panels.mesh.count, 1), dtype=complex)
        patch.setattr("moyai.structures.units.near_field.incident_potential", lambda *_: nothing)
        force = lifted.drift(still, np.zeros(1), motion)[0, 0]
    size = 0.25 * WATER.density * WATER.gravity * LENGTH * 0.5**2
    assert np.abs(force[:2]).max() < 1e-6 * size


@pytest.mark.slow
@pytest.mark.parametrize("heading", [pytest.param(0.0, marks=pytest.mark.slow), 0.6])
def test_pressures_on_the_hulls_add_up_to_the_far_waves(heading: float) -> None:
    """Held, and moving freely; what is left shrinks with the panels."""
    left = []
    for size in (2.5, 1.5):
        field, hydro = _solved(size, heading)
        model = RowModel(field.at, hydro, np.zeros(field.at.size))
        free = respond(model, OMEGA, np.zeros(len(field.at.joints)))
        for found in (free, replace(free, motion=np.zeros_like(free.motion))):
            whole = far_waves(model, found).drift[0, 0]
            near = field.drift(hydro.solutions[0], hydro.headings, found.motion[0])[0]
            left.append(np.linalg.norm(near[:, :2].sum(axis=0) - whole[:2]) / np.linalg.norm(whole[:2]))
    assert max(left[2:]) < 0.1 and max(left[2:]) < max(left[:2])


@pytest.mark.slow
def test_two_units_abeam_bear_the_same_and_push_each_other() -> None:
    field, hydro = _solved(2.5, 0.0)
    model = RowModel(field.at, hydro, np.zeros(field.at.size))
    found = respond(model, OMEGA, np.zeros(len(field.at.joints)))
    whole = far_waves(model, found).drift
    loads = reconciled(field.at, near_drift(model, found.motion), whole)[0, 0].reshape(2, 6)
    assert loads[0, 0] == pytest.approx(loads[1, 0], rel=1e-9) and loads[0, 0] > 0.0
    assert loads[0, 1] == pytest.approx(-loads[1, 1], rel=1e-9) and abs(loads[0, 1]) > 1e-3 * loads[0, 0]
    assert loads[0, 5] == pytest.approx(-loads[1, 5], rel=1e-9)


@pytest.mark.slow
def test_the_seaward_unit_shelters_the_next_and_the_sum_is_kept() -> None:
    field, hydro = _solved(2.5, np.radians(70.0))
    model = RowModel(field.at, hydro, np.zeros(field.at.size))
    found = respond(model, OMEGA, np.zeros(len(field.at.joints)))
    whole = far_waves(model, found).drift
    loads = reconciled(field.at, near_drift(model, found.motion), whole)[0, 0].reshape(2, 6)
    plan = field.at.centres
    assert loads[:, :2].sum(axis=0) == pytest.approx(whole[0, 0, :2], rel=1e-9)
    moment = loads[:, 5] + plan[:, 0] * loads[:, 1] - plan[:, 1] * loads[:, 0]
    assert moment.sum() == pytest.approx(whole[0, 0, 2], rel=1e-9)
    # waves travel towards +y: the first unit meets them
    assert plan[0, 1] < plan[1, 1] and loads[0, 1] > loads[1, 1]


def test_what_is_left_of_the_sum_goes_as_the_size_of_each() -> None:
    field, _ = _panels(2.5)
    near = np.array([[3.0, 0.0, 0.0], [1.0, 0.0, 0.0]])
    loads = reconciled(field.at, near, np.array([8.0, 0.0, 0.0])).reshape(2, 6)
    assert loads[:, 0] == pytest.approx([6.0, 2.0])


def test_shares_of_what_is_left_do_not_depend_on_the_axes_of_the_row() -> None:
    """Forces and places turned together give the same loads, turned."""
    angle = 0.6
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    straight = row()
    placements = tuple(Placement(*(turn @ [place.x, place.y, 0.0])[:2], angle) for place in straight.placements)
    generator = np.random.default_rng(3)
    near, whole = generator.normal(size=(4, 1, 2, 3)), generator.normal(size=(4, 1, 3))
    found = reconciled(at_rest(straight), near, whole).reshape(-1, 3)
    turned = reconciled(at_rest(replace(straight, placements=placements)), near @ turn.T, whole @ turn.T)
    assert np.allclose(turned.reshape(-1, 3), found @ turn.T, atol=1e-12)


@pytest.mark.slow
def test_the_drift_from_all_pairs_of_motions_is_that_of_the_panels(monkeypatch: pytest.MonkeyPatch) -> None:
    """Held in a wave, let go, and moved in any way: products of the motions are summed once for them all."""
    _, hydro = _solved(2.5, 0.6)
    hinged = at_rest(row((Connector("h", "hinge", ((0, 1),), 0.0, 3.0, (1.0, 0.0, 0.0)),)))
    assert hydro.panels is not None
    rng = np.random.default_rng(5)
    moved = rng.normal(size=(4, hinged.free.shape[1])) + 1j * rng.normal(size=(4, hinged.free.shape[1]))
    moved[0] = 0.0
    found = {}
    for often in (np.inf, 0.0):
        monkeypatch.setattr("moyai.structures.units.near_field.OFTEN", often)
        field = NearField(hinged, hydro.panels)
        found[often] = [field.drift(hydro.solutions[0], hydro.headings, one[None] @ hinged.free.T) for one in moved]
        assert bool(field._pairs) == (often == 0.0)
    np.testing.assert_allclose(found[0.0], found[np.inf], rtol=0.0, atol=1e-11 * np.abs(found[np.inf]).max())


def test_rows_of_other_damping_share_the_sums_and_rows_of_other_joints_do_not() -> None:
    field, panels = _panels(2.5)
    kept = NearField.of(field.at, panels)
    assert NearField.of(replace(field.at, row=field.at.row.damped(2.0)), panels) is kept
    hinged = at_rest(row((Connector("h", "hinge", ((0, 1),), 0.0, 3.0, (1.0, 0.0, 0.0)),)))
    assert NearField.of(hinged, panels) is not kept


def _far_drift(placements: tuple[Placement, ...], omega: float) -> np.ndarray:
    """Return the mean drift (3,) of units that are held, per amplitude squared, in waves at 0.6 rad."""
    at = at_rest(replace(row(count=len(placements)), placements=placements, connectors=()))
    mesh = row_mesh(at.section, LENGTH, at.row.placements, 4.0, lid=False, gap_lid=False)
    hydro = solve_row(panels_of(mesh, at.centres), WATER, at.centres, np.array([omega]), np.array([0.6]))
    model = RowModel(at, hydro, np.zeros(at.size))
    free = respond(model, hydro.omega, np.zeros(len(at.joints)))
    return far_waves(model, replace(free, motion=np.zeros_like(free.motion))).drift[0, 0]


def test_a_unit_that_is_moved_takes_its_drift_with_it() -> None:
    here, there = (_far_drift((Placement(x, y, 0.3),), 1.6) for x, y in ((0.0, 0.0), (400.0, -900.0)))
    assert there[:2] == pytest.approx(here[:2], rel=1e-9)
    turned = here[2] + 400.0 * here[1] + 900.0 * here[0]
    assert there[2] == pytest.approx(turned, rel=1e-9)


def test_far_waves_of_units_far_apart_have_directions_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    places = (Placement(0.0, -240.0, 0.0), Placement(60.0, 240.0, 0.2))
    found = _far_drift(places, 2.5)
    monkeypatch.setattr(bem, "FEWEST_DIRECTIONS", 1500)
    assert found == pytest.approx(_far_drift(places, 2.5), rel=1e-7)


def test_far_waves_in_more_directions_are_the_same_waves() -> None:
    waves = [np.exp(1j * 7.0 * np.cos(bem.directions(count) - 0.4)) for count in (60, 200)]
    assert np.abs(bem.in_directions(waves[0], 200) - waves[1]).max() < 1e-12
