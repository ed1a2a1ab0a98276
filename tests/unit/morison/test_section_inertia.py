"""Ideal inertia coefficients against conformal maps, closed forms, covariance and another solver."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import gamma

from moyai.core.errors import InputError
from moyai.morison import sections
from moyai.morison.contour import Contour
from moyai.morison.inertia import inertia_coefficients


def tensor(points, bulges=None):
    return inertia_coefficients(Contour(np.asarray(points, dtype=float), bulges)).tensor


def test_circle_to_rounding():
    assert np.abs(sections.circle(0.37).inertia.tensor - 2.0 * np.eye(2)).max() < 1e-13


@pytest.mark.parametrize(("sides", "seed"), [(3, 0), (4, 1), (5, 2), pytest.param(9, 4, marks=pytest.mark.slow)])
def test_regular_polygons_have_the_capacity_of_their_exterior_map(sides, seed):
    """C_M = 2 pi cap^2 / A with the transfinite diameter in gamma functions, any size and turn."""
    rng = np.random.default_rng(seed)
    radius, turn = 10.0 ** rng.uniform(-2, 2), rng.uniform(0, 2 * math.pi)
    angle = turn + 2.0 * math.pi * np.arange(sides) / sides
    found = tensor(radius * np.column_stack([np.cos(angle), np.sin(angle)]) + rng.uniform(-3, 3, 2))
    side = 2.0 * radius * math.sin(math.pi / sides)
    capacity = side * gamma(1 / sides) / (2 ** (1 + 2 / sides) * math.sqrt(math.pi) * gamma(0.5 + 1 / sides))
    exact = 2.0 * math.pi * capacity**2 / (0.5 * sides * radius**2 * math.sin(2.0 * math.pi / sides))
    assert np.abs(found - exact * np.eye(2)).max() < 1e-8


@pytest.mark.parametrize("seed", range(5))
def test_rectangles_follow_the_schwarz_christoffel_map(seed):
    """The map of the exterior, z' = C sqrt((s^2 - e^{2ia})(s^2 - e^{-2ia})) / s^2, gives sides and doublets."""
    alpha = np.random.default_rng(seed).uniform(0.05, 1.5)
    half_height = quad(lambda t: math.sqrt(max(2 * (math.cos(2 * t) - math.cos(2 * alpha)), 0)), 0, alpha)[0]
    half_width = quad(lambda t: math.sqrt(max(2 * (math.cos(2 * alpha) - math.cos(2 * t)), 0)), alpha, math.pi / 2)[0]
    area = 4.0 * half_width * half_height
    exact = 2.0 * math.pi * np.array([1.0 - math.cos(2 * alpha), 1.0 + math.cos(2 * alpha)]) / area
    found = sections.rectangle(2 * half_width, 2 * half_height).inertia.tensor
    assert np.diagonal(found) == pytest.approx(exact, rel=1e-8)
    assert abs(found[0, 1]) < 1e-9


@pytest.mark.parametrize("seed", range(4))
def test_lenses_of_two_arcs_follow_their_map(seed):
    """Arcs that meet at corners: (z - c)/(z + c) = ((s - 1)/(s + 1))^k."""
    rng = np.random.default_rng(seed)
    sweep, tip = rng.uniform(0.3, 5.0), 10.0 ** rng.uniform(-1, 1)
    k = 2.0 - sweep / math.pi
    radius, first = tip / k, tip * (k * k - 1.0) / (3.0 * k)
    arc = tip / math.sin(0.5 * sweep)
    area = arc**2 * (sweep - math.sin(sweep))
    bulge = math.tan(0.25 * sweep)
    found = tensor([(-tip, 0.0), (tip, 0.0)], [bulge, bulge])
    exact = 2.0 * math.pi * radius * np.array([radius - first, radius + first]) / area
    assert np.diagonal(found) == pytest.approx(exact, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("ratio", [0.2, 0.7, 3.0])
def test_polygons_inscribed_in_an_ellipse_tend_to_its_coefficients(ratio):
    angle = 2.0 * math.pi * (np.arange(120) + 0.5) / 120
    found = tensor(np.column_stack([np.cos(angle), ratio * np.sin(angle)]))
    assert np.diagonal(found) == pytest.approx([1.0 + ratio, 1.0 + 1.0 / ratio], rel=1.5e-3)


@pytest.mark.parametrize("thickness", [1e-2, 1e-3, 1e-4])
def test_slender_rectangles_tend_to_the_flat_plate(thickness):
    """Added mass rho pi c^2 / 4 of a plate broadside on; the excess falls like t ln t."""
    found = sections.rectangle(1.0, thickness).inertia.added_mass[1, 1] * thickness
    excess = found / (math.pi / 4.0) - 1.0
    assert 0.0 < excess < 1.5 * thickness * math.log(1.0 / thickness)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 1])
def test_any_polygon_turns_scales_and_mirrors_with_its_axes(seed):
    """A random star-shaped polygon; the tensor is one, whatever the axes; symmetry is not imposed by the solver."""
    rng = np.random.default_rng(seed)
    angle = np.sort(rng.uniform(0, 2 * math.pi, 5)) + 0.1 * np.arange(5)
    points = rng.uniform(0.5, 1.5, 5)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])
    section = sections.polygon(points)
    result = section.inertia
    assert result.checks[0].value < 1e-9
    turn = rng.uniform(0, math.pi)
    matrix = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    assert np.abs(section.turned(turn).inertia.tensor - matrix @ result.tensor @ matrix.T).max() < 1e-7
    mirrored = sections.polygon(100.0 * points * [-1, 1]).inertia.tensor
    assert np.abs(mirrored - result.tensor * [[1, -1], [-1, 1]]).max() < 1e-7
    low, high = result.principal
    axis = np.array([math.cos(result.principal_angle), math.sin(result.principal_angle)])
    assert axis @ result.tensor @ axis == pytest.approx(low, rel=1e-9)
    assert low + high == pytest.approx(np.trace(result.tensor))
    assert low > 1.0


@pytest.mark.parametrize("seed", range(2))
def test_a_potential_solver_with_surface_and_bed_agrees_far_below_the_surface(seed):
    """Green's identity with free surface, high frequency, deep: another solver of another room."""
    from moyai.potential.modes import rigid_modes
    from moyai.potential.sections import Hull, Outline
    from moyai.potential.solver import solve
    from moyai.sea.water import Water

    rng = np.random.default_rng(seed)
    angle = 2.0 * math.pi * np.arange(5) / 5
    section = sections.polygon(rng.uniform(0.6, 1.4, 5)[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]))
    hull = Hull((Outline(section.contour.vertices),))
    found = solve(hull.immersed(60.0), Water(math.inf, 1.0, 9.81), [2.0], modes=rigid_modes(centre=(0.0, -60.0)))
    mass = found.dataset["added_mass"].isel(omega=0).values[:2, :2]
    # images at twice the depth change the added mass like (size / depth)^2
    assert np.abs(mass / section.area - section.inertia.added_mass).max() < 2e-3


AWKWARD = {
    "spike of half a degree": [(0, 0), (1, -0.00437), (1, 0.00437)],
    "slot": [(-1, 0), (1, 0), (1, 2), (0.01, 2), (0.01, 0.1), (-0.01, 0.1), (-0.01, 2), (-1, 2)],
    "beam": [
        *[(-1, -1), (1, -1), (1, -0.95), (0.025, -0.95), (0.025, 0.95), (1, 0.95)],
        *[(1, 1), (-1, 1), (-1, 0.95), (-0.025, 0.95), (-0.025, -0.95), (-1, -0.95)],
    ],
}


@pytest.mark.slow
@pytest.mark.parametrize("name", AWKWARD)
def test_awkward_sections_settle(name):
    found = sections.polygon(AWKWARD[name]).inertia
    assert found.error < 1e-5
    assert found.checks[0].value < 1e-9
    assert abs(found.tensor[0, 1]) < 1e-8 * found.tensor.max()


@pytest.mark.slow
def test_random_stars_settle():
    rng = np.random.default_rng(0)
    for _ in range(24):
        count = rng.integers(4, 10)
        angle = 2.0 * math.pi * (np.arange(count) + rng.uniform(0.1, 0.9, count)) / count
        radius = 10.0 ** rng.uniform(-0.7, 0.3, count)
        found = sections.polygon(radius[:, None] * np.column_stack([np.cos(angle), np.sin(angle)])).inertia
        assert found.error < 1e-4
        assert found.checks[0].value < 1e-8
        assert found.principal[0] > 1.0


def test_rounding_of_corners_leads_from_the_square_to_the_circle():
    values = [sections.rounded_rectangle(1.0, 1.0, r).inertia.tensor[0, 0] for r in (0.01, 0.1, 0.3, 0.4999)]
    assert 2.18844 > values[0] > values[1] > values[2] > values[3] > 2.0
    assert values[3] == pytest.approx(2.0, abs=1e-6)


BAD = {
    "two corners": ([(0, 0), (1, 0)], None, "different corners"),
    "bow tie": ([(0, 0), (1, 1), (1, 0), (0, 1.2)], None, "intersects itself"),
    "no area": ([(0, 0), (1, 0), (2, 0)], None, "no area"),
    "not a number": ([(0, 0), (1, math.nan), (1, 1)], None, "not a finite number"),
    "twice": ([(0, 0), (0, 0), (1, 0), (1, 1)], None, "coincide"),
    "bulges": ([(0, 0), (1, 0), (1, 1)], [1.0], "bulges"),
}


@pytest.mark.parametrize("name", BAD)
def test_impossible_sections_are_refused(name):
    points, bulges, words = BAD[name]
    with pytest.raises(InputError, match=words):
        Contour(np.array(points, dtype=float), bulges)


@pytest.mark.parametrize(
    ("make", "sizes"),
    [(sections.circle, (-1.0,)), (sections.rectangle, (1.0, 0.0)), (sections.rounded_rectangle, (1.0, 1.0, 0.5))],
)
def test_impossible_sizes_are_refused(make, sizes):
    with pytest.raises(InputError, match="allowed"):
        make(*sizes)


def test_area_and_extents_of_arcs():
    section = sections.rounded_rectangle(3.0, 2.0, 0.4)
    assert section.area == pytest.approx(6.0 - (4.0 - math.pi) * 0.16, rel=1e-12)
    assert section.extents == pytest.approx((3.0, 2.0))
    turned = sections.circle(2.0).turned(0.7)
    assert turned.extents == pytest.approx((2.0, 2.0), rel=1e-9)
