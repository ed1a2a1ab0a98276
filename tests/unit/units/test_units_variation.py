"""Parabolas over panels: exact for squares, areas that integrate, Rankine terms against plain sums over fine panels."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from moyai.potential import shapes
from moyai.structures.units.bem import panels_of
from moyai.structures.units.mesh import GAP, HULL, LID, PanelMesh, row_mesh, unit_mesh
from moyai.structures.units.model import straight_row
from moyai.structures.units.variation import even_variation, neighbours, rankine_terms, variation_of


def cut(mesh, count):
    """Return every panel cut in count times count: centres stay centres where it is odd."""
    a, b, c, d = (mesh.corners[:, index] for index in range(4))

    def at(s, t):
        return (1 - s) * (1 - t) * a + s * (1 - t) * b + s * t * c + (1 - s) * t * d

    steps = np.arange(count + 1) / count
    parts = [
        np.stack([at(s, t), at(v, t), at(v, w), at(s, w)], axis=1)
        for s, v in pairwise(steps)
        for t, w in pairwise(steps)
    ]
    corners = np.stack(parts, axis=1).reshape(-1, 4, 3)
    return PanelMesh(corners, np.repeat(mesh.unit, count**2), np.repeat(mesh.part, count**2))


@pytest.fixture(scope="module")
def box():
    return unit_mesh(shapes.rectangle(10.0, 4.5).immersed(3.0), 20.0, 2.5, lid=True)


def test_parabolas_are_exact_for_squares(box):
    found, centre = variation_of(box), box.centre
    value = centre[:, 0] ** 2 - centre[:, 1] ** 2 + 2.0 * centre[:, 2] ** 2 + 3.0 * centre[:, 0] - centre[:, 2]
    axes = np.linalg.pinv(found.frame).transpose(0, 2, 1)
    slope = np.stack([2.0 * centre[:, 0] + 3.0, -2.0 * centre[:, 1], 4.0 * centre[:, 2] - 1.0], axis=1)
    bend = np.array([1.0, -1.0, 2.0])
    for axis in range(2):
        along = axes[:, axis]
        assert np.abs(found.slopes[axis] @ value - (along * slope).sum(axis=1)).max() < 1e-10
        assert np.abs(found.slopes[axis + 2] @ value - along**2 @ bend).max() < 1e-10


def test_areas_integrate_squares(box):
    found, centre = variation_of(box), box.centre
    for part, whole in ((HULL, box.area[box.part == HULL].sum()), (LID, 200.0)):
        assert found.areas[box.part == part].sum() == pytest.approx(whole, rel=1e-12)
    bottom = np.abs(centre[:, 2] + 3.0) < 1e-9
    assert found.areas[bottom] @ centre[bottom, 0] ** 2 == pytest.approx(20.0 * 10.0**3 / 12.0, rel=1e-12)


def test_neighbours_are_mutual_and_never_round_a_sharp_edge():
    section = shapes.rectangle(10.0, 4.5).immersed(3.0)
    mesh = row_mesh(section, 20.0, straight_row(3, 20.0, 1.0), 2.5, lid=True, gap_lid=True)
    beyond = neighbours(mesh)
    sides = np.flatnonzero(beyond.ravel() >= 0)
    other = beyond.ravel()[sides]
    assert (beyond.ravel()[other] == sides).all()
    assert (mesh.unit[sides // 4] == mesh.unit[other // 4]).all()
    assert (mesh.part[sides // 4] == mesh.part[other // 4]).all()
    assert np.abs(mesh.normal[sides // 4] - mesh.normal[other // 4]).max() < 1e-9
    assert {HULL, LID, GAP} == set(mesh.part.tolist())


def test_round_hulls_have_neighbours_round_the_bilge():
    mesh = unit_mesh(shapes.circle(2.5).immersed(2.0), 10.0, 1.0, lid=False)
    shell = np.abs(mesh.normal[:, 1]) < 1e-9
    deep = shell & (mesh.centre[:, 2] < -0.5)
    assert (neighbours(mesh)[deep][:, [0, 2]] >= 0).all()


@pytest.mark.slow
def test_rankine_terms_are_those_of_fine_panels():
    """A parabola over each panel, summed over its 81 parts with the layers of Capytaine."""
    pytest.importorskip("capytaine", reason="Capytaine is not installed")
    from capytaine.green_functions.delhommeau import Delhommeau

    from moyai.validation._capytaine import capytaine_mesh

    box = unit_mesh(shapes.rectangle(10.0, 4.5).immersed(3.0), 20.0, 4.0, lid=True)
    hull = replace(box, corners=box.corners[box.part == HULL], unit=box.unit[box.part == HULL],
                   part=box.part[box.part == HULL])  # fmt: skip
    engine, depth = Delhommeau(), np.inf

    def layers(points, mesh):
        return engine.evaluate_rankine_only(
            points, mesh, adjoint_double_layer=False, diagonal_term_in_double_layer=False
        )

    found = variation_of(hull)
    part = np.arange(0, hull.count, 7)
    whole = capytaine_mesh(hull.corners)
    single, double = rankine_terms(hull, part, found, depth, lambda points: layers(points, whole))
    rng = np.random.default_rng(3)
    value = 0.1 * hull.centre @ rng.normal(size=3) + 0.02 * hull.centre[:, 0] ** 2 + 0.01 * hull.centre[:, 1] ** 2
    fine = cut(hull, 9)
    mother = np.repeat(np.arange(hull.count), 81)
    local = np.einsum("nkx,nx->nk", found.frame[mother], fine.centre - hull.centre[mother])
    varied = value[mother]
    for slope, factor in zip(found.slopes, np.concatenate([local.T, local.T**2])):
        varied = varied + factor * (slope @ value)[mother]
    places = [hull.centre[part] * np.array([1.0, 1.0, sign]) for sign in (1.0, -1.0)]
    of_fine, of_hull = (
        [sum(both) for both in zip(*(layers(place, mesh) for place in places), strict=True)]
        for mesh in (capytaine_mesh(fine.corners), whole)
    )
    for number, term in enumerate((single, double)):
        wanted = of_fine[number] @ varied
        even = of_hull[number] @ value
        assert np.abs(even - wanted).max() > 0.005 * np.abs(wanted).max()
        # the plain sum itself is known to a sixth of that for the double layer
        assert np.abs(term @ value - wanted).max() < 0.2 * np.abs(even - wanted).max()


def test_even_panels_add_nothing(box):
    panels = replace(panels_of(box, np.zeros((1, 3))), even=True)
    assert (panels.variation.areas == box.area).all()
    assert even_variation(box).slopes[0].nnz == 0
    plain = panels.even_rankine(box.centre[panels.symmetry.part], 10.0)
    for one, other in zip(panels.rankine(10.0), plain, strict=True):
        assert (one == other).all()
