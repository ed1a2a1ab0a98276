"""Thin plates at infinite and zero frequency against closed forms, series, reciprocity and similarity."""

import math

import numpy as np
import pytest
from numpy.polynomial import chebyshev

from moyai.core.errors import InputError
from moyai.potential.modes import rigid_modes
from moyai.potential.solver import solve
from moyai.potential.thin_plate import Plate, hanging_arc, horizontal_motion, solve_plate_limit
from moyai.potential.thin_plate_waves import plate_section
from moyai.sea.water import Water

ZETA_3 = 1.2020569031595942
DEEP = Water(math.inf, 1.0, 9.81)
HANGING = Plate((0.0, 0.0), (0.0, -1.0))


def mass(plate, water=DEEP, **options):
    return solve_plate_limit(plate, water, **options).added_mass[0, 0]


def test_flat_plate_to_rounding():
    assert mass(HANGING) == pytest.approx(2.0 / math.pi, rel=1e-11)


@pytest.mark.parametrize("seed", range(5))
def test_flat_plate_of_any_size_density_and_place(seed):
    rng = np.random.default_rng(seed)
    draught, x, density = 10.0 ** rng.uniform(-2, 2), rng.uniform(-5, 5), rng.uniform(900, 1100)
    found = mass(Plate((x, 0.0), (x, -draught)), Water(math.inf, density, 9.81))
    assert found == pytest.approx(2.0 * density * draught**2 / math.pi, rel=1e-9)


def test_error_falls_exponentially_with_the_step():
    errors = [abs(mass(HANGING, step=step) * math.pi / 2.0 - 1.0) for step in (1.0, 0.8, 0.6)]
    assert errors[0] < 3e-6
    assert errors[1] < errors[0] / 10.0
    assert errors[2] < errors[1] / 100.0


def test_jump_is_the_inverse_hyperbolic_secant():
    solution = solve_plate_limit(HANGING, DEEP)
    z = -solution.points[:, 1]
    exact = 4.0 / math.pi * z * np.arccosh(np.maximum(1.0 / z, 1.0))
    assert np.abs(-solution.jump[:, 0] - exact).max() < 4e-7  # rounding of 1 - z at the edge, square root
    inner = z < 0.999
    assert np.abs(-solution.jump[:, 0] - exact)[inner].max() < 1e-10
    fine = solve_plate_limit(HANGING, DEEP, step=0.05)
    assert -fine.jump.min() == pytest.approx(0.8438, abs=1e-4)
    assert solution.centre_of_pressure[0, 1] == pytest.approx(-math.pi / 6.0, rel=1e-10)


def test_upper_and_lower_edge_share():
    def upper(points, normals):
        return normals[:, 0] * (1.0 + points[:, 1])

    def lower(points, normals):
        return -normals[:, 0] * points[:, 1]

    found = solve_plate_limit(HANGING, DEEP, (upper, lower)).added_mass
    cross = 1.0 / 3.0 - math.pi / 16.0
    exact = [[2.0 / math.pi - 2.0 / 3.0 + math.pi / 16.0, cross], [cross, math.pi / 16.0]]
    assert np.abs(found - exact).max() < 1e-11


def test_plate_that_stands_on_the_bed():
    found = mass(HANGING, Water(1.0, 1.0, 9.81))
    assert found == pytest.approx(28.0 * ZETA_3 / math.pi**3, rel=1e-8)


@pytest.mark.parametrize("seed", range(6))
def test_zero_frequency_in_finite_depth(seed):
    rng = np.random.default_rng(100 + seed)
    draught, depth = rng.uniform(0.05, 0.98), 10.0 ** rng.uniform(-1, 2)
    found = mass(Plate((0.0, 0.0), (0.0, -draught * depth)), Water(depth, 1.0, 9.81), frequency="zero")
    exact = -4.0 * depth**2 / math.pi * math.log(math.cos(0.5 * math.pi * draught))
    assert found == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_random_normal_velocities_far_from_all_walls(seed):
    """V = sum a_n U_n over a plate of half length c: M = rho pi c^2 sum a_n b_n / (n + 1)."""
    rng = np.random.default_rng(200 + seed)
    a, b = rng.normal(size=(2, 6))
    half, angle = rng.uniform(0.3, 3.0), rng.uniform(0.0, 2.0 * math.pi)
    middle, along = np.array([rng.uniform(-9, 9), -1e5 * half]), np.array([math.cos(angle), math.sin(angle)])

    def mode(coefficients):
        def velocity(points, _normals):
            t = np.clip((points - middle) @ along / half, -1.0, 1.0)
            # U_n = T'_{n+1} / (n + 1)
            series = np.concatenate([[0.0], coefficients / np.arange(1, 7)])
            return chebyshev.chebval(t, chebyshev.chebder(series))

        return velocity

    plate = Plate(tuple(middle - half * along), tuple(middle + half * along))
    found = solve_plate_limit(plate, DEEP, (mode(a), mode(b))).added_mass
    weights = math.pi * half**2 / np.arange(1, 7)
    exact = np.array([[a @ (weights * a), a @ (weights * b)], [b @ (weights * a), b @ (weights * b)]])
    assert np.abs(found - exact).max() < 1e-8 * np.abs(exact).max()


@pytest.mark.parametrize("seed", range(8))
def test_reciprocity_and_positive_energy_of_random_plates(seed):
    rng = np.random.default_rng(300 + seed)
    bulge, slant = rng.uniform(-0.6, 0.6), rng.uniform(-0.3, 0.3)
    plate = Plate((0.0, 0.0), (slant, -1.0), bulge)
    coefficients = rng.normal(size=(3, 4))
    modes = tuple(lambda p, n, c=c: n @ c[:2] + p @ c[2:] for c in coefficients)
    for frequency in ("infinite", "zero"):
        for depth in (math.inf, 1.5):
            found = solve_plate_limit(plate, Water(depth, 1.0, 9.81), modes, frequency=frequency).added_mass
            assert np.abs(found - found.T).max() < 2e-6 * np.abs(found).max()
            assert np.linalg.eigvalsh(0.5 * (found + found.T)).min() > 0.0


def test_a_deep_bed_is_no_bed():
    plate = Plate((0.0, 0.0), (0.3, -1.0), 0.3)
    assert mass(plate, Water(3e3, 1.0, 9.81)) == pytest.approx(mass(plate), rel=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_mirror_image_has_the_same_mass(seed):
    rng = np.random.default_rng(400 + seed)
    slant, bulge = rng.uniform(0.0, 0.4), rng.uniform(0.1, 0.5)
    water = Water(rng.uniform(1.2, 3.0), 1000.0, 9.81)
    assert mass(Plate((0, 0), (slant, -1), bulge), water) == pytest.approx(
        mass(Plate((0, 0), (-slant, -1), -bulge), water), rel=1e-9
    )


@pytest.mark.slow
def test_arc_becomes_half_circle():
    """Arcs that meet the still water at a finite angle go over into the cusp, which another rule solves."""
    distance = np.array([0.02, 0.03, 0.04])
    values = np.array([mass(hanging_arc(1.0, s)) for s in distance])
    limit = np.polyval(np.polyfit(distance, values, 2), 0.0)
    assert mass(hanging_arc(1.0, 0.0)) == pytest.approx(limit, rel=1e-3)


def test_surface_piercing_start_is_not_needed():
    """A plate just below the still water tends to the one through it, like 1 / ln of the gap or faster."""
    assert mass(Plate((0.0, -1e-7), (0.0, -1.0))) == pytest.approx(mass(HANGING), rel=1e-5)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: Plate((0, 0.2), (0, -1)), "still water"),
        (lambda: Plate((0, 0), (0, 0)), "no length"),
        (lambda: Plate((0, 0), (0, -1), 1.4), "half circle"),
        (lambda: Plate((0, 0), (0, math.nan)), "not finite"),
        (lambda: hanging_arc(1.0, -0.1), "centre_distance"),
        (lambda: hanging_arc(0.0, 1.0), "chord"),
        (lambda: mass(HANGING, Water(0.9, 1.0, 9.81)), "0.9 m deep"),
        (lambda: mass(HANGING, Water(1.0, 1.0, 9.81), frequency="zero"), "bed"),
        (lambda: mass(HANGING, modes=(lambda p, n: n,)), "shape"),
        (lambda: mass(HANGING, step=2.0), "step"),
    ],
)
def test_bad_input_is_refused_in_words(make, word):
    with pytest.raises(InputError, match=word):
        make()


def test_normal_of_a_hanging_plate_looks_downstream():
    solution = solve_plate_limit(HANGING, DEEP, (horizontal_motion,))
    assert (solution.jump < 0.0).all()
    assert Plate((0, 0), (0, -1)).slope(np.array([0.5]))[0] == pytest.approx(-1j)
    assert hanging_arc(1.0, 0.2).position(np.array([0.5])).real[0] > 0.0


def test_a_plate_takes_the_modes_of_any_section():
    """Sway of the rigid modes is the horizontal motion; heave slides along a vertical plate."""
    water, plate = Water(6.0, 1000.0, 9.81), Plate((0.0, 0.0), (0.0, -2.0))
    own = solve_plate_limit(plate, water, (horizontal_motion,)).added_mass[0, 0]
    rigid = solve_plate_limit(plate, water, rigid_modes((0.0, 0.0))).added_mass
    assert rigid.shape == (3, 3)
    assert rigid[0, 0] == pytest.approx(own, rel=1e-12)
    assert np.abs(rigid[1]).max() < 1e-9 * own
    # roll about the waterline moves each point by its depth below it, against the solver of any section
    assert rigid[0, 2] == pytest.approx(rigid[2, 0], rel=1e-9)
    section = plate_section(plate)
    other = solve(section, water, [1.0], modes=rigid_modes((0.0, 0.0)), accuracy=1e-4).infinite_frequency_added_mass
    assert np.allclose(rigid, other, atol=1e-3 * own)


def test_what_is_no_motion_is_refused():
    with pytest.raises(InputError, match="'sway' is no motion"):
        solve_plate_limit(Plate((0.0, 0.0), (0.0, -2.0)), Water(6.0, 1000.0, 9.81), ("sway",))
