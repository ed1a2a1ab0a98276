"""Panels of rows of units: closed hulls of the right volume, normals into the water, mirrors, gaps."""

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.potential import shapes
from moyai.structures.units.mesh import GAP, HULL, LID, clearance, cuts, row_mesh, unit_mesh
from moyai.structures.units.model import Curve, Placement, straight_row
from moyai.structures.units.symmetry import symmetry_of

SECTIONS = {
    "rectangle": shapes.rectangle(10.0, 4.5),
    "trapezoid": shapes.trapezoid(8.0, 10.0, 4.5),
    "circle": shapes.circle(2.5),
    "rounded": shapes.rounded_rectangle(10.0, 4.5, 1.0),
    "pi": shapes.pi_type(10.0, 4.5, 1.5, 0.5),
    "twin": shapes.twin_pontoon(3.0, 4.5, 4.0),
}


@pytest.mark.parametrize("name", SECTIONS)
def test_hulls_are_closed_and_hold_the_volume_of_the_section(name):
    section = SECTIONS[name].immersed(3.0 if name != "circle" else 2.0)
    mesh = unit_mesh(section, 20.0, 1.0, lid=False)
    vector, centre = mesh.area_vector, mesh.centre
    # with the waterplane the surface is closed: level areas cancel, the upward one is that of the waterplane
    assert np.abs(vector[:, :2].sum(axis=0)).max() < 1e-9
    assert -vector[:, 2].sum() == pytest.approx(
        section.waterplane_breadth * 20.0, rel=2e-2 if name == "circle" else 1e-9
    )
    volume = section.area * 20.0
    rough = 1e-2 if name in ("circle", "rounded") else 1e-9
    # by each coordinate; level and upright parts of the normal are independent
    assert (vector[:, 0] * centre[:, 0]).sum() == pytest.approx(volume, rel=rough)
    assert (vector[:, 1] * centre[:, 1]).sum() == pytest.approx(volume, rel=rough)
    assert (vector[:, 2] * centre[:, 2]).sum() == pytest.approx(volume, rel=rough)


def test_lids_cover_the_water_inside_and_between():
    section = SECTIONS["rectangle"].immersed(3.0)
    mesh = row_mesh(section, 20.0, straight_row(3, 20.0, 1.0), 2.0, lid=True, gap_lid=True)
    assert mesh.area[mesh.part == LID].sum() == pytest.approx(3 * 200.0)
    assert mesh.area[mesh.part == GAP].sum() == pytest.approx(2 * 10.0)
    assert (mesh.normal[mesh.part != HULL][:, 2] == -1.0).all()


@pytest.mark.parametrize("size", [0.7, 1.3, 2.9])
def test_cuts_are_no_longer_than_asked_and_shrink_to_the_ends(size):
    steps = np.diff(cuts(20.0, size, even=True))
    assert len(steps) % 2 == 0
    assert steps.max() <= size * (1.0 + 1e-9)
    assert steps.sum() == pytest.approx(20.0)
    assert steps[0] < 0.6 * steps.max()
    assert np.allclose(steps, steps[::-1])


def test_mirrors_are_found_and_undo_themselves():
    section = SECTIONS["rectangle"].immersed(3.0)
    straight = symmetry_of(row_mesh(section, 20.0, straight_row(2, 20.0, 1.0), 2.0, lid=True, gap_lid=True))
    assert len(straight.mirrors) == 4
    bent = (Placement(0.0, 0.0), Placement(14.0, 18.0, -1.0))
    assert len(symmetry_of(row_mesh(section, 20.0, bent, 2.0, lid=False, gap_lid=False)).mirrors) == 1
    values = np.random.default_rng(1).normal(size=(straight.images.size, 3)) + 0j
    assert np.allclose(straight.joined(straight.split(values)), values)


def test_clearance_of_turned_units():
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    turn = np.array([[1.0, -1.0], [1.0, 1.0]]) / np.sqrt(2.0)
    far, near = np.array([3.0, 0.0]), np.array([2.0, 0.0])
    assert clearance(square, square + far) == pytest.approx(1.0)
    assert clearance(square, square @ turn.T + far) == pytest.approx(2.0 - np.sqrt(2.0))
    assert clearance(square, square @ turn.T + near) < 0.0


def test_gaps_that_no_panel_resolves_are_refused():
    section = SECTIONS["rectangle"].immersed(3.0)
    with pytest.raises(InputError, match="tenth of a panel"):
        row_mesh(section, 20.0, straight_row(2, 20.0, 0.1), 2.0, lid=False, gap_lid=False)


def test_curves_go_on_beyond_their_ends_and_are_rounded_by_their_mean():
    curve = Curve((-1.0, 0.0, 1.0), (0.0, 0.0, 5.0))
    assert curve.at(np.array([-3.0, 0.5, 2.0])).tolist() == [0.0, 2.5, 10.0]
    force, slope = curve.rounded(0.0, 0.2)
    assert force == pytest.approx(0.25 * 0.2 * 5.0)
    assert slope == pytest.approx(2.5)


def test_lids_lie_between_ends_that_face_each_other_whatever_the_order_of_the_units():
    section = shapes.rectangle(10.0, 4.5).immersed(3.0)

    def lids(places):
        mesh = row_mesh(section, 20.0, tuple(places), 2.5, lid=False, gap_lid=True)
        part = mesh.part == GAP
        return float(mesh.area[part].sum()), set(mesh.unit[part].tolist())

    row = straight_row(3, 20.0, 1.0)
    assert lids(row) == (pytest.approx(20.0), {0, 1})
    assert lids(row[::-1]) == (pytest.approx(20.0), {1, 2})
    # one of them turned round has its gap as well
    turned = [row[0], Placement(row[1].x, row[1].y, np.pi), row[2]]
    assert lids(turned) == (pytest.approx(20.0), {0, 1})
    # side by side, and an end before a side of which it covers nine metres
    assert lids([Placement(0.0, 0.0), Placement(11.0, 0.0)]) == (pytest.approx(20.0), {0})
    assert lids([Placement(0.0, 0.0), Placement(15.5, 6.0, 0.5 * np.pi)]) == (pytest.approx(4.5), {1})
    # far apart there is open water
    assert lids([Placement(0.0, 0.0), Placement(25.0, 0.0)]) == (0.0, set())
