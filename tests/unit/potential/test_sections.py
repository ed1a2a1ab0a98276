"""Outlines, hulls and sections: exact areas and cuts, arcs included, and refused outlines."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.potential import shapes
from moyai.potential.sections import Hull, Outline


def random_star(rng, corners=7, radius=1.0, centre=(0.0, 0.0)):
    """Corners of a star-shaped polygon, counter-clockwise."""
    while True:
        angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, corners))
        steps = np.diff(np.append(angle, angle[0] + 2.0 * np.pi))
        if steps.max() < 2.6 and steps.min() > 0.12:
            break
    reach = radius * rng.uniform(0.4, 1.0, corners)
    return np.stack([centre[0] + reach * np.cos(angle), centre[1] + reach * np.sin(angle)], axis=1)


def test_circle_segment_is_exact():
    for draught in (0.3, 1.0, 1.7):
        section = shapes.circle(1.0).immersed(draught)
        half = math.acos(1.0 - draught)
        area = half - math.sin(half) * math.cos(half)
        breadth = 2.0 * math.sin(half)
        assert section.area == pytest.approx(area, rel=1e-14)
        assert section.waterplane_breadth == pytest.approx(breadth, rel=1e-14)
        # centroid of a circular segment below its centre at z = 1 - draught
        depth = 2.0 * math.sin(half) ** 3 / (3.0 * area)
        assert section.centroid == pytest.approx((0.0, 1.0 - draught - depth), abs=1e-13)


def test_submerged_circle_is_whole():
    section = shapes.circle(0.7).immersed(3.0)
    assert section.area == pytest.approx(math.pi * 0.49, rel=1e-14)
    assert section.centroid == pytest.approx((0.0, -2.3))
    assert section.waterlines == () and section.chains[0].closed and not section.surface_piercing


@pytest.mark.parametrize("seed", range(30))
def test_immersed_part_against_fine_polygon(seed):
    """Area, centroid and waterlines of random outlines with arcs, heeled, against clipping of a fine polygon."""
    rng = np.random.default_rng(seed)
    points = random_star(rng)
    bulges = rng.uniform(-0.25, 0.25, len(points)) * (rng.random(len(points)) < 0.5)
    hull = Hull((Outline(points, bulges),))
    draught, heel = rng.uniform(-0.2, 0.4), rng.uniform(-0.5, 0.5)
    try:
        section = hull.immersed(draught, heel)
    except InputError as error:
        assert "encloses water" in str(error)
        return
    line = section.outlines[0].edges.polyline(1e-4)
    x, z = line.T
    x2, z2 = np.roll(x, -1), np.roll(z, -1)
    # clip at z = 0 piece by piece: the integral of x dz over the part below
    low, high = np.minimum(z, 0.0), np.minimum(z2, 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        slope = np.where(z2 != z, (x2 - x) / (z2 - z), 0.0)
    middle = x + slope * (0.5 * (low + high) - z)
    assert section.area == pytest.approx(float((middle * (high - low)).sum()), rel=1e-6)
    crossings = np.sort((x + slope * (0.0 - z))[(z < 0.0) != (z2 < 0.0)])
    assert np.array(section.waterlines).ravel() == pytest.approx(crossings, abs=1e-6)


def test_areas_of_the_shapes():
    assert shapes.rectangle(10.0, 4.5).immersed(3.0).area == pytest.approx(30.0)
    assert shapes.trapezoid(4.0, 8.0, 2.0).immersed(1.0).area == pytest.approx(5.0)
    rounded = shapes.rounded_rectangle(3.0, 2.0, 0.5).immersed(1.0)
    assert rounded.area == pytest.approx(3.0 - (2.0 - math.pi / 2.0) * 0.25)
    assert shapes.rounded_rectangle(2.0, 1.0, 1.0).immersed(1.0).area == pytest.approx(math.pi / 2.0)
    pi_type = shapes.pi_type(10.0, 3.0, 2.0, 0.5).immersed(4.0)
    assert pi_type.area == pytest.approx(22.0) and pi_type.bottom == -4.0
    decked = shapes.twin_pontoon(2.0, 3.0, 1.0, deck_thickness=0.5).immersed(2.0)
    assert decked.area == pytest.approx(8.0)
    assert np.array(decked.waterlines) == pytest.approx(np.array([(-2.5, -0.5), (0.5, 2.5)]))
    assert len(shapes.twin_pontoon(2.0, 3.0, 1.0).outlines) == 2


def test_heel_turns_the_top_towards_plus_x():
    section = shapes.rectangle(10.0, 4.5).immersed(3.0, heel=0.1)
    top = max(np.vstack(section.drawn().reshape(-1, 2)), key=lambda point: point[1])
    assert top == pytest.approx(
        (-5.0 * math.cos(0.1) + 4.5 * math.sin(0.1), -3.0 + 5.0 * math.sin(0.1) + 4.5 * math.cos(0.1))
    )
    assert section.symmetry_axis() is None
    assert shapes.rectangle(10.0, 4.5).immersed(3.0, offset=2.0).symmetry_axis() == pytest.approx(2.0)


def test_waterplane_moments_of_twin_hulls():
    section = shapes.twin_pontoon(2.0, 3.0, 1.0).immersed(2.0, offset=0.3)
    lines = section.waterlines
    assert section.waterplane_breadth == pytest.approx(4.0)
    assert section.waterplane_first_moment == pytest.approx(4.0 * 0.3)
    assert section.waterplane_second_moment == pytest.approx(sum((b**3 - a**3) / 3.0 for a, b in lines))


def test_clockwise_is_turned_round():
    points = np.array([(0, 0), (0, 1), (1, 1), (1, 0)], float)
    bulges = np.array([0.1, 0.0, 0.0, 0.0])
    outline = Outline(points, bulges)
    assert outline.area == pytest.approx(Outline(points[::-1], [0.0, 0.0, -0.1, 0.0]).area)
    # a clockwise arc with positive bulge turns to the left of its travel: into the body
    assert outline.area < 1.0


@pytest.mark.parametrize(
    ("points", "words"),
    [
        ([(0, 0), (1, 1), (1, 0), (0, 1)], "no area"),
        ([(0, 0), (2, 0), (2, 2), (1, -1), (0, 2)], "intersects itself"),
        ([(0, 0), (1, 0), (2, 0)], "no area"),
        ([(0, 0), (1, 0)], "corners"),
        ([(0, 0), (1, 0), (1, 0), (0, 1)], "coincide"),
        ([(0, 0), (np.nan, 0), (1, 1)], "finite"),
        ([(0, 0), (2, 0), (2, 1), (2, 0.5), (0, 1)], "intersects itself"),
    ],
)
def test_bad_outlines_get_a_clear_message(points, words):
    with pytest.raises(InputError, match=words):
        shapes.polygon(points)


def test_overlapping_outlines_are_refused():
    box = np.array([(0, 0), (2, 0), (2, 1), (0, 1)], float)
    for share, shift in ((1.0, (1.0, 0.5)), (0.2, (0.5, 0.5)), (1.0, (2.0, 0.0))):
        with pytest.raises(InputError, match="overlap"):
            Hull((Outline(box), Outline(share * box + np.array(shift))))


def test_dry_and_tank_sections_are_refused():
    with pytest.raises(InputError, match="does not reach the water"):
        shapes.rectangle(2.0, 1.0).immersed(-0.5)
    tank = [(0, 0), (5, 0), (5, 3), (4, 3), (4, 1), (1, 1), (1, 3), (0, 3)]
    with pytest.raises(InputError, match="encloses water"):
        shapes.polygon(tank).immersed(2.0)
    with pytest.raises(InputError, match="draught"):
        shapes.rectangle(2.0, 1.0).immersed(float("nan"))


def test_deck_flush_with_the_water():
    section = shapes.rectangle(4.0, 2.0).immersed(2.0)
    assert section.area == pytest.approx(8.0) and section.waterlines == ((-2.0, 2.0),)
