"""Panel integrals against adaptive quadrature: straight, circular, graded, complex panels; near, far, on the panel."""

import cmath
import itertools
import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import kv

from moyai.potential.oblique_quadrature import _bessel_k, add_helmholtz
from moyai.potential.panels import BODY, RAY, RAY_DIRECTION, Piece, gauss_rule, make_panels
from moyai.potential.quadrature import add_rankine, add_rankine_slopes

ORDER = 12


def density(t):
    return 1.0 + t - 2.0 * t**3


def weights_of(panels, target, own, kappa=0.0):
    rule = gauss_rule(panels.order)
    real = np.array([abs(target[1] - np.conj(target[0])) == 0.0])
    targets = np.array([target[0]]), np.array([target[1]]), real
    single, double = np.zeros((2, 1, len(panels.u)), dtype=complex)
    tables = panels.kernel_panels, panels.kernel_nodes, (rule.nodes, rule.weights, rule.projection)
    if kappa:
        add_helmholtz(targets, np.array([own]), *tables, kappa, single, double)
    else:
        add_rankine(targets, np.array([own]), *tables, single, double)
    return single[0] @ density(rule.nodes), double[0] @ density(rule.nodes)


def path(piece, t):
    """Position and derivative in t of a panel, written independently."""
    if piece.grade == 0:
        fraction, change = 0.5 * (1 + t), 0.5
    elif piece.grade < 0:
        fraction, change = (0.5 * (1 + t)) ** 3, 1.5 * (0.5 * (1 + t)) ** 2
    else:
        fraction, change = 1 - (0.5 * (1 - t)) ** 3, 1.5 * (0.5 * (1 - t)) ** 2
    if piece.sweep == 0.0:
        return piece.start + piece.step * fraction, piece.step * change
    turn = cmath.exp(1j * piece.sweep) - 1.0
    u = piece.start + piece.step * (cmath.exp(1j * piece.sweep * fraction) - 1.0) / turn
    return u, piece.step * 1j * piece.sweep * cmath.exp(1j * piece.sweep * fraction) / turn * change


def adaptive(piece, target, breaks, kappa=0.0):
    """Single and double layer integral by adaptive quadrature of real and imaginary part."""
    real = piece.kind == BODY

    def parts(t):
        u, du = path(piece, t)
        v, dv = (u.conjugate(), du.conjugate()) if real else (u, du)
        a, b = u - target[0], v - target[1]
        r2 = a * b
        element = abs(du) if real else du
        turning = -0.5j * (b * du - a * dv)
        if kappa:
            r = cmath.sqrt(r2)
            return -kv(0, kappa * r) * element, kappa * kv(1, kappa * r) / r * turning
        return 0.5 * cmath.log(r2) * element, turning / r2

    def integral(which):
        total = 0.0
        for part in ("real", "imag"):
            limits = [-1.0, *breaks, 1.0]
            for low, high in itertools.pairwise(limits):
                total += (1.0 if part == "real" else 1j) * quad(
                    lambda t, part=part: density(t) * getattr(complex(parts(t)[which]), part),
                    low,
                    high,
                    limit=400,
                    epsabs=1e-11,
                    epsrel=1e-11,
                )[0]
        return total

    return integral(0), integral(1)


def seen_along_an_arc(piece, place, kappa):
    """Double layer of a circular panel at its own point, from chord and half angle: nothing cancels there."""
    radius = abs(piece.step) / (2.0 * math.sin(piece.sweep / 2.0))

    def fraction(t):
        up, down = 0.5 * (1 + t), 0.5 * (1 - t)
        return {0: (up, 0.5), -1: (up**3, 1.5 * up**2), 1: (1 - down**3, 1.5 * down**2)}[piece.grade]

    def integrand(t):
        here, change = fraction(t)
        r = 2.0 * radius * abs(math.sin(0.5 * piece.sweep * (here - fraction(place)[0])))
        factor = kappa * r * kv(1, kappa * r) if kappa and r > 0.0 else 1.0
        return density(t) * factor * 0.5 * piece.sweep * change

    return sum(quad(integrand, *ends, epsabs=1e-12)[0] for ends in ((-1.0, place), (place, 1.0)))


REAL_TARGETS = [2 + 0.151j, 1 + 0.5j + 1e-3 * (2 - 0.7j) * 1j, 3.02 - 0.21j, 5 + 1j, 2.2 + 0.3j]


@pytest.mark.parametrize("kappa", [0.0, 1.3])
@pytest.mark.parametrize("grade", [0, -1, 1])
@pytest.mark.parametrize("sweep", [0.0, 0.7, -0.9])
def test_real_panels(sweep, grade, kappa):
    piece = Piece(1 + 0.5j, 2 - 0.7j, sweep, grade, BODY, 0)
    # with K_0 the density takes I_0(kappa r) along, which needs more nodes
    panels = make_panels([piece], 2 * ORDER if kappa else ORDER)
    tolerance = 1e-9
    for target in REAL_TARGETS:
        pair = target, np.conj(target)
        found = weights_of(panels, pair, -1, kappa)
        expected = adaptive(piece, pair, [], kappa)
        assert found[0] == pytest.approx(expected[0], abs=tolerance)
        assert found[1] == pytest.approx(expected[1], abs=tolerance)


@pytest.mark.slow
@pytest.mark.parametrize("kappa", [0.0, 1.3])
@pytest.mark.parametrize("grade", [0, -1, 1])
@pytest.mark.parametrize("sweep", [0.0, 0.7])
@pytest.mark.filterwarnings("ignore::scipy.integrate.IntegrationWarning")
def test_target_on_its_own_panel(sweep, grade, kappa):
    piece = Piece(1 + 0.5j, 2 - 0.7j, sweep, grade, BODY, 0)
    order = 2 * ORDER if kappa else ORDER
    panels = make_panels([piece], order)
    for own in (0, 5, order - 1):
        target = panels.u[own], panels.v[own]
        found = weights_of(panels, target, own, kappa)
        place = float(gauss_rule(order).nodes[own])
        expected = adaptive(piece, target, [place], kappa)
        assert found[0] == pytest.approx(expected[0], abs=1e-7)
        if sweep == 0.0:
            assert abs(found[1]) < 1e-12  # a straight panel does not see itself
        else:
            assert found[1].real == pytest.approx(seen_along_an_arc(piece, place, kappa), abs=1e-7)


@pytest.mark.parametrize("kappa", [0.0, 0.8])
def test_complex_targets_and_panels(kappa):
    """A body panel seen from the ray, the ray seen from the body, and the ray from itself and its bed image."""
    body = Piece(0.0 + 0j, -0.4 - 1.1j, 0.0, -1, BODY, 0)
    ray = Piece(0.0 + 0j, 1.5 * RAY_DIRECTION, 0.0, -1, RAY, -1)
    x = 0.3 * RAY_DIRECTION
    pairs = [
        (body, (x, x)),
        (ray, (-0.2 - 0.5j, -0.2 + 0.5j)),
        (ray, (x - 1.6j, x + 1.6j)),
        (ray, (3.1 * RAY_DIRECTION, 3.1 * RAY_DIRECTION)),
        (ray, (-1.0 - x, -1.0 - x)),
    ]
    for piece, target in pairs:
        found = weights_of(make_panels([piece], 2 * ORDER if kappa else ORDER), target, -1, kappa)
        expected = adaptive(piece, target, [], kappa)
        assert found[0] == pytest.approx(expected[0], abs=1e-7)
        assert found[1] == pytest.approx(expected[1], abs=1e-8)


@pytest.mark.parametrize("grade", [0, -1, 1])
@pytest.mark.parametrize("sweep", [0.0, 0.7])
def test_slopes_are_the_differences_of_what_they_belong_to(sweep, grade):
    """Panels of a body and of the ray, at points near and far, along a normal of no special direction."""
    normal, step = np.exp(0.7j), 1e-3
    for piece in (
        Piece(1 + 0.5j, 2 - 0.7j, sweep, grade, BODY, 0),
        Piece(0j, 1.5 * RAY_DIRECTION, 0.0, grade, RAY, -1),
    ):
        panels = make_panels([piece], ORDER)
        rule = gauss_rule(ORDER)
        tables = panels.kernel_panels, panels.kernel_nodes, (rule.nodes, rule.weights, rule.projection)
        for target in (0.3 + 0.15j, 2 + 0.28j, 5 + 1j):
            slopes = np.zeros((2, 1, ORDER), dtype=complex)
            add_rankine_slopes((np.array([target]), np.array([normal])), np.array([-1]), *tables, *slopes)
            one, two = (
                np.array([
                    np.subtract(*(
                        weights_of(panels, (place, np.conj(place)), -1)
                        for place in (target + n * step * normal, target - n * step * normal)
                    )) / (2.0 * n * step)
                    for n in (1, 2)
                ])
            )  # fmt: skip
            found = slopes[:, 0] @ density(rule.nodes)
            assert found == pytest.approx((4.0 * one - two) / 3.0, rel=1e-6, abs=1e-7)


def test_bessel_functions_of_complex_argument():
    modulus = 10.0 ** np.linspace(-4, 2, 61)
    for angle in (-math.pi / 4, 0.0, 0.4, math.pi / 4):
        for z in modulus * np.exp(1j * angle):
            k0, k1 = _bessel_k(z)
            assert abs(k0 / kv(0, z) - 1.0) < 1e-10
            assert abs(k1 / kv(1, z) - 1.0) < 1e-10


def test_convergence_is_exponential_for_a_corner_singularity():
    """A density rho^(2/3) on the graded panel: the error falls by orders, not by a fixed power."""
    target = 0.4 + 0.3j
    errors = []
    for order in (4, 8, 12):
        panels = make_panels([Piece(0j, 1.0 + 0j, 0.0, -1, BODY, 0)], order)
        rule = gauss_rule(order)
        single, double = np.zeros((2, 1, order), dtype=complex)
        tables = panels.kernel_panels, panels.kernel_nodes, (rule.nodes, rule.weights, rule.projection)
        add_rankine(
            (np.array([target]), np.array([target.conjugate()]), np.array([True])),
            np.array([-1]),
            *tables,
            single,
            double,
        )
        exact = quad(lambda x: x ** (2 / 3) * math.log(abs(x - target)), 0.0, 1.0, epsabs=1e-13)[0]
        errors.append(abs((single[0] @ panels.u.real ** (2 / 3)).real - exact))
    assert errors[1] < 1e-2 * errors[0] or errors[0] < 1e-10
    assert errors[2] < 1e-10
