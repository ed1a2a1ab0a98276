"""Waves on rows of units: identities of the coefficients, far waves, drift, connectors, and waves around bodies."""

from dataclasses import replace

import numpy as np
import pytest

from moyai.sea.environment import Environment, Wind
from moyai.structures.units import bem
from moyai.structures.units.assembly import steady_load, steady_position
from moyai.structures.units.bem import elevation_at, far_amplitudes, given_flow, panels_of, solve_frequency
from moyai.structures.units.hydrodynamics import solve_row
from moyai.structures.units.mesh import row_mesh
from moyai.structures.units.model import Connector, Curve, Placement, UnitLine
from moyai.structures.units.response import (
    RowModel,
    far_waves,
    gaussian_stiffness,
    harmonic_stiffness,
    respond,
)
from moyai.structures.units.symmetry import Symmetry
from moyai.validation import units as known
from moyai.validation._screens import waves_on_screens
from moyai.validation.units import OMEGA, WATER, at_rest, row

HINGE = Connector("h", "hinge", ((0, 1),), 0.0, 3.0, (1.0, 0.0, 0.0))


# each of these takes seconds; `moyai validate` computes them, and those in time
LONGER = (
    "ten wave", "limit of", "4032 panels", "1008 panels", "252 panels", "barrier", "gap of two", "cut in two halves",
    "ten times the stiffness", "fine panels",
)  # fmt: skip
QUICK = [item for item in known.CASES if not any(words in item.name for words in LONGER)]


@pytest.mark.slow
@pytest.mark.parametrize("case", QUICK, ids=lambda item: item.name)
def test_known_values(case):
    value = case.compute()
    assert case.error(value) <= case.tolerance, (value, case.reference)


@pytest.fixture(scope="module")
def box():
    at = at_rest(row(count=1))
    mesh = row_mesh(at.section, 20.0, at.row.placements, 2.5, lid=True, gap_lid=False)
    return at, panels_of(mesh, at.centres)


@pytest.mark.slow
def test_quarter_mesh_and_mirrors_give_the_whole(box):
    _, panels = box
    whole = replace(panels, symmetry=Symmetry(((False, False),), np.arange(panels.mesh.count)[None]))
    headings = np.radians([0.0, 35.0])
    one, other = (solve_frequency(item, WATER, 1.2, headings) for item in (panels, whole))
    assert len(panels.symmetry.mirrors) == 4
    for name in ("added_mass", "damping", "excitation", "radiation", "scattered"):
        first, second = getattr(one, name), getattr(other, name)
        assert np.abs(first - second).max() < 1e-9 * np.abs(second).max(), name


@pytest.mark.slow
def test_far_waves_are_those_of_the_field(box):
    _, panels = box
    headings = np.zeros(1)
    found = solve_frequency(panels, WATER, 1.2, headings)
    k = found.wave_number
    given = given_flow(panels, WATER, 1.2, k, headings)[:, 6:]
    angle = np.array([0.0, 0.7, 1.6, 3.0])
    points = 2000.0 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    near = elevation_at(points, panels, WATER, 1.2, found.diffraction, given)[:, 0]
    far = far_amplitudes(panels, WATER, 1.2, k, found.diffraction, given, angle, np.zeros(2))[0]
    far = far * np.sqrt(2.0 / (np.pi * k * 2000.0)) * np.exp(1j * (k * 2000.0 - 0.25 * np.pi))
    assert np.abs(near - far).max() < 0.01 * np.abs(far).max()


def test_screens_go_over_into_the_half_plane_with_the_root_of_their_length():
    points = 2.0 * np.pi * np.array([[1.0, 0.0], [1.0, 1.0], [2.0, 0.0]])
    half_plane = known.sommerfeld(1.0, points[:, 0], points[:, 1])
    apart = [
        np.abs(waves_on_screens(1.0, ((-2.0 * np.pi * length, 0.0),), points) - half_plane).max() for length in (3, 12)
    ]
    assert apart[1] < 0.15
    assert apart[1] / apart[0] == pytest.approx(0.5, abs=0.1)


def test_two_screens_that_touch_are_one():
    points = np.array([[3.0, 0.5], [6.0, -2.0], [-4.0, 1.0]])
    one = waves_on_screens(1.0, ((-6.0, 6.0),), points)
    two = waves_on_screens(1.0, ((-6.0, -1e-7), (1e-7, 6.0)), points)
    # a slit closes with the logarithm of its width
    assert np.abs(one - two).max() < 0.1


@pytest.mark.slow
def test_haskind_holds_with_a_damped_gap():
    at = at_rest(row())
    mesh = row_mesh(at.section, 20.0, at.row.placements, 2.5, lid=True, gap_lid=True)
    found = solve_frequency(panels_of(mesh, at.centres, 0.2), WATER, 1.6, np.radians([0.0, 60.0]))
    size = np.abs(found.excitation).reshape(-1, 6).max(axis=0)
    assert (found.haskind / size).max() < 0.005
    free = solve_frequency(panels_of(mesh, at.centres, 0.0), WATER, 1.6, np.zeros(1))
    without = row_mesh(at.section, 20.0, at.row.placements, 2.5, lid=True, gap_lid=False)
    same = solve_frequency(panels_of(without, at.centres), WATER, 1.6, np.zeros(1))
    # a lid without damping is the water itself
    assert np.abs(free.added_mass - same.added_mass).max() < 1e-9 * np.abs(same.added_mass).max()


@pytest.mark.slow
def test_yaw_moment_of_drift_of_a_row_moved_aside(box):
    at, _ = box
    headings = np.radians([20.0, 70.0])
    found = []
    for place in (Placement(0.0, 0.0), Placement(5.0, 30.0)):
        moved = at_rest(replace(at.row, placements=(place,)))
        mesh = row_mesh(moved.section, 20.0, moved.row.placements, 2.5, lid=True, gap_lid=False)
        hydro = solve_row(panels_of(mesh, moved.centres), WATER, moved.centres, np.array([1.2]), headings)
        model = RowModel(moved, hydro, np.zeros(6))
        found.append(far_waves(model, respond(model, np.array([1.2]), np.zeros(0))).drift[0])
    force, moment = found[0][:, :2], found[0][:, 2]
    assert np.allclose(found[1][:, :2], force, rtol=1e-6)
    assert np.allclose(found[1][:, 2], moment + 5.0 * force[:, 1] - 30.0 * force[:, 0], rtol=1e-6)


@pytest.mark.slow
def test_a_row_turned_with_its_waves_moves_the_same():
    motions = []
    for turn in (0.0, 0.6):
        c, s = np.cos(turn), np.sin(turn)
        places = tuple(Placement(c * p.x - s * p.y, s * p.x + c * p.y, turn) for p in row().placements)
        at = at_rest(replace(row((HINGE,)), placements=places))
        mesh = row_mesh(at.section, 20.0, places, 3.3, lid=False, gap_lid=False)
        hydro = solve_row(panels_of(mesh, at.centres), WATER, at.centres, np.array([1.0]), np.array([0.3 + turn]))
        found = respond(RowModel(at, hydro, np.zeros(12)), np.array([1.0]), np.zeros(1))
        motions.append((at.in_unit_axes(found.motion), found.load))
    for first, second in zip(*motions):
        assert np.abs(first - second).max() < 1e-6 * np.abs(first).max()


@pytest.mark.slow
def test_loads_of_connectors_balance_each_unit():
    """Newton's law of unit 2 by itself: its inertia is what waves, water and the hinge push."""
    at, found = known.response((HINGE,))
    hydro = known.two_boxes(True)
    for n, omega in enumerate(OMEGA):
        matrix = -(omega**2) * (at.inertia + hydro.added_mass[n]) - 1j * omega * hydro.damping[n] + at.hydrostatic
        matrix = matrix - 1j * omega * _damping(at, hydro.added_mass[n])
        for h in range(3):
            left = hydro.excitation[n, h] - matrix @ found.motion[n, h]
            # the load pulls unit 2 back, about the place of the hinge
            load, arm = found.load[n, h, 0], at.joints[0].place - at.centres[1]
            force, moment = -load[:3], -load[3:] - np.cross(arm, load[:3])
            assert np.abs(left[6:9] + force).max() < 1e-8 * np.abs(load[:3]).max()
            assert np.abs(left[9:] + moment).max() < 1e-8 * np.abs(load[3:]).max()


def _damping(at, added):
    fraction = np.tile(at.row.damping_fraction, at.row.count)
    diagonal = 2.0 * fraction * np.sqrt(np.diag(at.inertia + added) * np.maximum(np.diag(at.hydrostatic), 0.0))
    return np.diag(diagonal)


def test_linear_curves_are_springs_whatever_the_sea():
    line = Curve((-1.0, 1.0), (-3e6, 3e6))
    assert harmonic_stiffness(line, 0.3, 0.2) == pytest.approx(3e6)
    assert gaussian_stiffness(line, -0.1, 0.2) == pytest.approx(3e6)
    chain = Curve((-1.0, 0.0, 1.0), (0.0, 0.0, 4e6))
    # half a wave pulls: half the stiffness
    assert harmonic_stiffness(chain, 0.0, 0.5) == pytest.approx(2e6)
    assert gaussian_stiffness(chain, 0.0, 0.1) == pytest.approx(2e6, rel=1e-6)


def test_wind_is_borne_by_the_lines():
    springs = tuple(
        UnitLine(name, 1, (0, 1), (side * 5.0, 0.0, 2.0), (side * 60.0, 0.0, -1.0), stiffness=5e4, pretension=2e4)
        for name, side in (("a", -1.0), ("b", 1.0))
    )
    at = at_rest(replace(row((HINGE,)), lines=springs, wind_drag_coefficient=1.2))
    environment = Environment(WATER, wind=Wind(25.0, 0.3, 1.225))
    wind, current = steady_load(at, environment)
    across = 0.5 * 1.225 * 1.2 * 20.0 * at.freeboard * 25.0**2 * np.cos(0.3)
    assert wind[0] == pytest.approx(across) and not current.any()
    rest = steady_position(at, wind)
    pull = at.line_force(rest.position)
    assert pull[0] + pull[6] == pytest.approx(-2.0 * across, rel=1e-6)
    assert rest.position[0] > 0.0


def test_a_machine_without_memory_is_reported_before_it_starts(box, monkeypatch):
    from moyai.core.errors import InputError

    at, panels = box
    monkeypatch.setattr(bem, "memory_of_machine", lambda: 1e6)
    with pytest.raises(InputError, match="GiB"):
        solve_row(panels, WATER, at.centres, np.array([1.0]), np.zeros(1))


def test_waves_longer_than_the_green_function_reaches_are_refused(box):
    from moyai.core.errors import InputError

    with pytest.raises(InputError, match="depths long"):
        solve_frequency(box[1], WATER, 0.05, np.zeros(1))
