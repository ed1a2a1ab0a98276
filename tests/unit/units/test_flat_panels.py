"""Layers of 1/r over flat panels: against sums of many points, on the panel itself, and far away."""

import numpy as np
import pytest

from moyai.potential import shapes
from moyai.structures.units.bem import panels_of
from moyai.structures.units.mesh import LID, unit_mesh
from moyai.structures.units.rankine_kernel import FAR, flat_panel
from moyai.structures.units.variation import gauss_points

SQUARE = np.array([[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 1.0, 0.0], [0.0, 1.0, 0.0]])
UPWARD = np.array([0.0, 0.0, 1.0])


@pytest.mark.parametrize("point", [(0.7, 0.4, 0.9), (-1.5, 0.3, -0.6), (3.0, 2.0, 0.8), (1.0, 0.5, 4.0)])
@pytest.mark.parametrize("triangle", [False, True])
def test_layers_are_sums_of_many_points(point, triangle):
    corners = SQUARE[[0, 1, 2, 0]] if triangle else SQUARE
    places, areas = gauss_points(corners[None], 40)
    away = np.array(point) - places[0]
    r = np.linalg.norm(away, axis=1)
    single, double = flat_panel(*point, corners, UPWARD)
    assert single == pytest.approx((areas[0] / r).sum(), rel=1e-8)
    assert double == pytest.approx((areas[0] * away[:, 2] / r**3).sum(), rel=1e-7)


def test_a_square_at_its_own_centre():
    """1/r over a square of side a from its centre is 4 a ln(1 + sqrt 2); half of the solid angle is left out."""
    corners = SQUARE * np.array([0.5, 1.0, 1.0])
    single, double = flat_panel(0.5, 0.5, 0.0, corners, UPWARD)
    assert single == pytest.approx(4.0 * np.log(1.0 + np.sqrt(2.0)), rel=1e-14)
    assert double == 0.0
    for side in (1.0, -1.0):
        assert flat_panel(0.5, 0.5, side * 1e-6, corners, UPWARD)[1] == pytest.approx(side * 2.0 * np.pi, rel=1e-5)
    # on an edge and on its line, where a factor of the logarithm is zero
    assert np.isfinite(flat_panel(0.5, 0.0, 0.0, corners, UPWARD)).all()
    assert np.isfinite(flat_panel(3.0, 0.0, 0.0, corners, UPWARD)).all()
    # ever nearer to an edge, from the side and from above
    for away in 10.0 ** np.arange(-14.0, -3.0, 0.25):
        for point in ((0.3, away, 0.0), (0.3, -away, 0.0), (0.3, 0.0, away), (1.3, -away, away)):
            single, double = flat_panel(*point, corners, UPWARD)
            near = flat_panel(point[0], 0.0, 0.0, corners, UPWARD)[0]
            assert abs(single - near) < 10.0 * away * (1.0 - np.log(away)) + 1e-13
            assert abs(double) < 2.0 * np.pi


def test_a_closed_surface_holds_its_inside_in_a_whole_solid_angle():
    """The double layer of all panels is 1 inside and 0 outside, near rule and far rule together."""
    mesh = unit_mesh(shapes.rectangle(10.0, 4.5).immersed(3.0), 20.0, 2.0, lid=True)
    panels = panels_of(mesh, np.zeros((1, 3)))
    inside = np.array([[0.0, 0.0, -1.0], [3.0, -8.0, -2.5]])
    outside = np.array([[0.0, 0.0, -3.5], [9.0, 4.0, -1.0], [0.0, 60.0, -2.0]])
    away = np.linalg.norm(inside[0] - mesh.centre, axis=1)
    assert (away > FAR * 1.5).any() and (away < FAR).any()
    # normals of lids point into the hull
    outward = np.where(mesh.part == LID, -1.0, 1.0)
    for points, whole in ((inside, 1.0), (outside, 0.0)):
        total = panels.even_layers(points)[1] @ outward
        assert np.abs(np.abs(total) - whole).max() < 1e-7
