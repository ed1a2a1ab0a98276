"""Damping by eddies at the edges of a section: exact laws, identities, and Ikeda's formula."""

import itertools
import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.floating.damping import QuadraticDamping
from moyai.floating.forcing import CalmWater
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.moving_water import MovingWater
from moyai.floating.time import CumminsModel, simulate
from moyai.floating.viscous import (
    eddy_coefficient,
    edge_damping,
    rounding_factor,
    water_measure,
)
from moyai.floating.viscous_section import section_edges
from moyai.potential.sections import Hull, Outline
from moyai.potential.shapes import circle, rectangle
from moyai.tables.edge_damping import edge_damping_numbers


def damping_of(hull, draught, centre=(0.0, 0.0), density=1000.0, length=1.0, heel=0.0):
    edges = section_edges(hull.immersed(draught, heel=heel))
    return edge_damping(edges.corners, edges.plates, centre, density, length)


def barge_roll_damping(beam, draught, axis_depth, density, edge_pressure):
    """Ikeda's b2 per length [N s2] of a sharp-cornered barge that rolls about an axis below still water."""
    half, above = beam / (2.0 * draught), 1.0 - axis_depth / draught
    return 0.5 * density * edge_pressure * draught**4 * (half**2 + above) * (half**2 + above**2)


def diagonal(damping):
    """Quadratic coefficient of each mode alone."""
    return damping.coefficients @ np.abs(damping.directions) ** 3


def pi_hull():
    points = [[-5, 0], [-4.6, 0], [-4.6, 1.5], [4.6, 1.5], [4.6, 0], [5, 0], [5, 6], [-5, 6]]
    return Hull((Outline(np.array(points, dtype=float)),))


@pytest.mark.parametrize("beam", [0.6, 1.0, 2.0, 3.7, 8.0, 20.0])
def test_roll_of_a_sharp_box_is_that_of_a_barge(beam):
    found = diagonal(damping_of(rectangle(beam, 1.6), 1.0))[2]
    assert found == pytest.approx(barge_roll_damping(beam, 1.0, 0.0, 1000.0, 1.5), rel=1e-12)


@pytest.mark.parametrize(("beam", "ratio"), [(1.0, 0.68), (2.0, 0.70), (4.0, 0.78), (20.0, 0.96)])
def test_roll_about_other_axes_differs_from_ikedas_lever_as_the_theory_page_says(beam, ratio):
    found = diagonal(damping_of(rectangle(beam, 1.6), 1.0, centre=(0.0, -0.3)))[2]
    assert found / barge_roll_damping(beam, 1.0, 0.3, 1000.0, 1.5) == pytest.approx(ratio, abs=0.005)


def test_sway_and_heave_of_a_box_have_the_stated_drag_coefficients():
    sway, heave, _ = diagonal(damping_of(rectangle(4.0, 2.0), 1.2, density=1025.0))
    assert sway == pytest.approx(0.5 * 1025.0 * 3.0 * 1.2, rel=1e-12)
    assert heave == pytest.approx(0.5 * 1025.0 * 1.5 * 4.0, rel=1e-12)


@pytest.mark.parametrize("seed", range(4))
def test_power_does_not_depend_on_the_reference_point(seed):
    """The same motion counted about two points dissipates the same; forces move with their moment."""
    rng = np.random.default_rng(seed)
    hull, shift = pi_hull() if seed % 2 else rectangle(4.0, 2.0), rng.normal(size=2)
    heel = float(rng.uniform(-0.1, 0.1))
    first = damping_of(hull, 1.2, heel=heel)
    other = damping_of(hull, 1.2, centre=tuple(shift), heel=heel)
    v = rng.normal(size=3)
    # Roll is positive about +y: the velocity of a point is (v1 + z v3, v2 - x v3)
    moved = np.array([v[0] + shift[1] * v[2], v[1] - shift[0] * v[2], v[2]])
    f, g = first.force(v), other.force(moved)
    assert g[:2] == pytest.approx(f[:2], rel=1e-12)
    assert g @ moved == pytest.approx(f @ v, rel=1e-12)
    assert f @ v < 0.0


@pytest.mark.parametrize("scale", [0.04, 26.0])
def test_froude_scaling(scale):
    small = damping_of(rectangle(4.0, 2.0), 1.2, centre=(0.1, -0.4), length=7.0)
    large = damping_of(
        rectangle(4.0 * scale, 2.0 * scale), 1.2 * scale, centre=(0.1 * scale, -0.4 * scale), length=7.0 * scale
    )
    v = np.array([0.3, -0.2, 0.15])
    # Velocities scale with the root of the length, turns with its inverse; forces with its cube
    scaled = v * np.array([scale**0.5, scale**0.5, scale**-0.5])
    assert large.force(scaled) == pytest.approx(small.force(v) * np.array([scale**3, scale**3, scale**4]), rel=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_work_of_a_cycle_is_that_of_the_equivalent_damping(seed):
    """One edge alone: equal work by quadrature over the cycle [8/(3 pi)]."""
    rng = np.random.default_rng(seed)
    whole = damping_of(rectangle(4.0, 2.0), 1.2, centre=(0.0, -0.4))
    one = QuadraticDamping(whole.directions[:1], whole.coefficients[:1])
    velocity = rng.normal(size=3) + 1j * rng.normal(size=3)
    phase = 2.0 * np.pi * (np.arange(20000) + 0.5) / 20000
    rates = (velocity[:, None] * np.exp(-1j * phase)).real
    work = np.mean([one.force(v) @ v for v in rates.T])
    equivalent = one.equivalent_regular(np.abs(one.directions @ velocity))
    assert work == pytest.approx(-0.5 * (velocity.conj() @ equivalent @ velocity).real, rel=1e-6)


def test_gaussian_linearisation_by_quadrature():
    """Least mean square error of b v against c |v| v for Gaussian v: b = E[c |v| v^2]/E[v^2]."""
    nodes, weights = np.polynomial.hermite_e.hermegauss(180)
    sigma, one = 0.37, QuadraticDamping(np.eye(3)[:1], np.array([2.5]))
    v = sigma * nodes
    expected = np.sum(weights * 2.5 * np.abs(v) * v * v) / np.sum(weights * v * v)
    assert one.equivalent_irregular(np.array([sigma]))[0, 0] == pytest.approx(expected, rel=1e-3)


def still_model(coefficient, rows=((0.0, 0.0, 1.0),), stiffness=(1.0, 1.0, 9.0)):
    return CumminsModel(
        inertia=np.eye(3),
        stiffness=np.diag(stiffness),
        linear_damping=np.zeros((3, 3)),
        memory=StateSpaceMemory.none(3),
        quadratic=QuadraticDamping(np.array(rows), np.array([coefficient])),
    )


def test_free_decay_in_time_follows_the_amplitude_law():
    """x'' + b |x'| x' + w^2 x = 0: (1 + 2 b a) exp(-2 b a) = (1 - 2 b a') exp(2 b a') from an extreme a to the next a'.

    First integral: x'^2 = C exp(2 b x) + w^2 (x/b + 1/(2 b^2)) while x falls.
    """
    b, start = 0.8, 0.5
    run = simulate(
        still_model(b), CalmWater(np.zeros(3)), duration=12.0, time_step=0.005, initial_position=[0.0, 0.0, start]
    )
    x = run.position[:, 2]
    inner = np.flatnonzero(np.diff(np.sign(run.velocity[1:, 2]))) + 1
    # Parabola through the rows about each extreme
    extremes = []
    for i in inner:
        i = max(i, 1)
        curve = np.polyfit(run.time[i - 2 : i + 4], x[i - 2 : i + 4], 4)
        slope = np.polyder(curve)
        roots = np.roots(slope)
        root = roots[np.argmin(np.abs(roots - run.time[i]))].real
        extremes.append(abs(float(np.polyval(curve, root))))
    assert len(extremes) >= 10
    before = start
    for after in extremes[:10]:
        left = (1.0 + 2.0 * b * before) * math.exp(-2.0 * b * before)
        right = (1.0 - 2.0 * b * after) * math.exp(2.0 * b * after)
        assert left == pytest.approx(right, abs=2e-6)
        before = after


def test_body_that_moves_with_uniform_water_feels_no_drag():
    """Long deep wave at the surface: sway of the water at the measure alone, body forced to the same velocity."""
    omega, edges = 0.05, section_edges(rectangle(4.0, 2.0).immersed(1.2))
    damping = edge_damping(edges.corners, edges.plates, (0.0, 0.0), 1000.0, 1.0)
    k = omega**2 / 9.81
    water = water_measure(edges.corners, edges.plates, np.array([omega]), np.array([k]), np.array([0.0]), math.inf)[0]
    velocity = np.array([omega, -1j * omega, 0.0])  # of the water at the origin per unit amplitude
    assert np.max(np.abs(water - damping.directions @ velocity)) < 5.0 * k * np.max(np.abs(water))


@pytest.mark.parametrize("depth", [3.0, 12.0])
def test_water_measure_is_the_wave_at_the_points(depth):
    """Against the gradient of the potential by central differences, oblique."""
    from moyai.sea.dispersion import wave_number

    omega, beta = 1.3, 0.4
    k = float(wave_number(omega, depth, 9.81))
    edges = section_edges(rectangle(4.0, 2.0).immersed(1.2))
    found = water_measure(edges.corners, edges.plates, np.array(omega), np.array(k), np.array(beta), depth)

    def potential(x, z):
        return -1j * 9.81 / omega * np.cosh(k * (z + depth)) / np.cosh(k * depth) * np.exp(1j * k * x * np.cos(beta))

    from moyai.floating.viscous import measures

    h = 1e-5
    for value, measure in zip(found, measures(edges.corners, edges.plates), strict=True):
        expected = 0.0
        for weight, (x, z), n in zip(measure.weights, measure.points, measure.directions, strict=True):
            across = (potential(x + h, z) - potential(x - h, z)) / (2 * h)
            upward = (potential(x, z + h) - potential(x, z - h)) / (2 * h)
            expected += weight * (n[0] * across + n[1] * upward)
        assert value == pytest.approx(expected, rel=1e-7)


def test_drag_in_time_is_against_the_moving_water():
    """A free mass in water that oscillates uniformly: v' = -c |v - u| (v - u), by an independent integration."""
    from scipy.integrate import solve_ivp

    c, omega, speed = 1.7, 2.0, 0.8
    forcing = MovingWater(
        CalmWater(np.zeros(3)), np.array([omega]), np.array([speed + 0j]), np.array([[1.0 + 0j]]), 0.0
    )
    model = still_model(c, rows=((1.0, 0.0, 0.0),), stiffness=(0.0, 1.0, 1.0))
    run = simulate(model, forcing, duration=10.0, time_step=0.01)

    def rate(t, v):
        relative = v - speed * math.cos(omega * t)
        return -c * np.abs(relative) * relative

    exact = solve_ivp(rate, (0.0, 10.0), [0.0], rtol=1e-10, atol=1e-12, t_eval=run.time[::100]).y[0]
    assert run.velocity[::100, 0] == pytest.approx(exact, abs=1e-5)
    assert np.max(np.abs(run.velocity[:, 0])) > 0.1


def test_edges_of_shapes():
    sharp = section_edges(rectangle(4.0, 2.0).immersed(1.2))
    assert len(sharp.corners) == 2 and not sharp.plates and not sharp.notices
    assert sharp.corners[0].point == pytest.approx((-2.0, -1.2))
    round_ = section_edges(circle(2.0).immersed(2.0))
    assert not round_.corners and [item.code for item in round_.notices] == ["viscous-no-edge"]
    bridged = section_edges(pi_hull().immersed(3.0))
    assert [item.code for item in bridged.notices] == ["viscous-hollow"]
    box = edge_damping(section_edges(rectangle(10.0, 6.0).immersed(3.0)).corners, (), (0.0, 0.0), 1.0, 1.0)
    assert diagonal(edge_damping(bridged.corners, (), (0.0, 0.0), 1.0, 1.0)) == pytest.approx(diagonal(box), rel=1e-12)


def test_round_bilges_shed_less_and_sharp_ones_all():
    factors = [rounding_factor(1.0, radius) for radius in (0.0, 0.02, 0.1, 0.25, 0.4)]
    assert factors[0] == 1.0
    assert all(a > b > 0.0 for a, b in itertools.pairwise(factors))


def test_thin_plate_has_its_drag_coefficient():
    """A plate across the flow in sway: C_D rho d / 2; in roll about its root the integral of its lever cubed."""
    from moyai.potential.plates import PlateLine

    hull = rectangle(4.0, 2.0).with_plates(PlateLine(np.array([[0.0, 0.0], [0.0, -1.0]])))
    edges = section_edges(hull.immersed(1.0))
    assert len(edges.plates) == 1 and "viscous-plates" in [item.code for item in edges.notices]
    drag = edge_damping_numbers().plate_coefficient
    found = diagonal(edge_damping((), edges.plates, (0.0, -1.0), 1000.0, 1.0))
    assert found[0] == pytest.approx(500.0 * drag, rel=1e-12)
    assert found[1] == pytest.approx(0.0, abs=1e-9)
    assert found[2] == pytest.approx(500.0 * drag / 4.0, rel=1e-6)


def test_impossible_arguments_are_refused():
    edges = section_edges(rectangle(4.0, 2.0).immersed(1.2))
    with pytest.raises(InputError):
        edge_damping(edges.corners, (), (0.0, 0.0), 0.0, 1.0)
    with pytest.raises(InputError):
        edge_damping(edges.corners, (), (0.0, 0.0), 1000.0, -1.0)


def ikeda_by_the_procedure(beam, draught, radius):
    """C_R of a section that rolls about the still water, copied from ITTC 7.5-02-07-04.5 (2011), section 2.1.3.

    In the symbols and with the dimensions of that page; the Lewis form of a section is that of its half beam over
    draught H0 and area coefficient sigma.
    """
    h0 = beam / (2.0 * draught)
    sigma = (beam * draught - 2.0 * (1.0 - math.pi / 4.0) * radius**2) / (beam * draught)
    f1 = 0.5 * (1.0 + math.tanh(20.0 * (sigma - 0.7)))
    f2 = 0.5 * (1.0 - math.cos(math.pi * sigma))
    f2 -= 1.5 * (1.0 - math.exp(-5.0 * (1.0 - sigma))) * math.sin(math.pi * sigma) ** 2
    f3 = 1.0 + 4.0 * math.exp(-1.65e5 * (1.0 - sigma) ** 2)
    # a1 and a3 of the form z = M (zeta + a1 / zeta + a3 / zeta^3): half beam, draught and area are those of the section
    from scipy.optimize import root

    def misses(a):
        wide, deep = 1.0 + a[0] + a[1], 1.0 - a[0] + a[1]
        area = 0.25 * math.pi * (1.0 - a[0] ** 2 - 3.0 * a[1] ** 2)
        return [wide / deep - h0, area / (wide * deep) - sigma]

    found = root(misses, [0.0, -0.1], tol=1e-13)
    assert np.abs(found.fun).max() < 1e-12
    a1, a3 = found.x
    m = beam / (2.0 * (1.0 + a1 + a3))

    def r_of(psi):
        return m * math.sqrt(
            ((1.0 + a1) * math.sin(psi) - a3 * math.sin(3.0 * psi)) ** 2
            + ((1.0 - a1) * math.cos(psi) + a3 * math.cos(3.0 * psi)) ** 2
        )

    psi1, psi2 = 0.0, 0.0
    if abs(a1 * (1.0 + a3)) < abs(4.0 * a3):
        psi2 = 0.5 * math.acos(a1 * (1.0 + a3) / (4.0 * a3))
    psi = psi1 if r_of(psi1) >= r_of(psi2) else psi2
    r_max = r_of(psi)
    h = 1.0 + a1**2 + 9.0 * a3**2 + 2.0 * a1 * (1.0 - 3.0 * a3) * math.cos(2.0 * psi) - 6.0 * a3 * math.cos(4.0 * psi)
    a = -2.0 * a3 * math.cos(5.0 * psi) + a1 * (1.0 - a3) * math.cos(3.0 * psi)
    a += ((6.0 - 3.0 * a1) * a3**2 + (a1**2 - 3.0 * a1) * a3 + a1**2) * math.cos(psi)
    b = -2.0 * a3 * math.sin(5.0 * psi) + a1 * (1.0 - a3) * math.sin(3.0 * psi)
    b += ((6.0 + 3.0 * a1) * a3**2 + (3.0 * a1 + a1**2) * a3 + a1**2) * math.sin(psi)
    gamma = math.sqrt(math.pi) * f3 / (2.0 * draught * math.sqrt(h0 * sigma))
    gamma *= r_max + 2.0 * m / h * math.sqrt(a**2 + b**2)
    c_p = 0.5 * (0.87 * math.exp(-gamma) - 4.0 * math.exp(-0.187 * gamma) + 3.0)
    levers = (1.0 - f1 * radius / draught) ** 2 + f2 * (beam / (2.0 * draught) - f1 * radius / draught) ** 2
    return levers * c_p * (r_max / draught) ** 2


@pytest.mark.parametrize(
    ("beam", "draught", "radius"),
    [(2.0, 1.0, 0.3), (3.1, 1.4, 0.7), (1.5, 1.0, 0.05), (2.4, 1.0, 0.9), (3.0, 1.2, 1.2)],
)
def test_eddies_of_a_round_bilge_are_those_of_the_procedure(beam, draught, radius):
    found = eddy_coefficient(0.5 * beam / draught, radius / draught)
    assert found == pytest.approx(ikeda_by_the_procedure(beam, draught, radius), rel=1e-9)


def test_a_half_circle_sheds_hardly_anything():
    """It turns in itself; what the law leaves is its pressure coefficient alone."""
    whole = rounding_factor(1.0, 1.0)
    assert 0.0 <= whole < 0.05
    assert whole == pytest.approx(rounding_factor(1.0, 1.0 - 1e-6), abs=1e-4)
