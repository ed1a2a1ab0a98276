"""Closed forms of cable and skirt at random inputs: identities, equilibrium, exact limits."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.structures.curtain.statics.closed_forms import (
    arc_half_angle,
    arc_tension_ratio,
    cable_shape_number,
    cable_tension_ratio,
    solve_cable,
    solve_skirt_arc,
)
from moyai.structures.curtain.statics.load_laws import check_section_load, plan_laws, section_laws

COUNT = 20_000


def test_cable_equation_holds_for_any_ratio() -> None:
    rng = np.random.default_rng(11)
    ratio, stiffness = 10.0 ** rng.uniform(-2, 1, COUNT), 10.0 ** rng.uniform(-3, 12, COUNT)
    b = cable_shape_number(ratio, stiffness)
    parts = np.sinh(b), b / ratio, 0.5 / stiffness
    assert np.max(np.abs(parts[0] - parts[1] - parts[2]) / sum(parts)) < 2e-15


def test_nearly_taut_cable_keeps_its_digits() -> None:
    """b^2 = 6e - (9/10) ... : sinh(b)/b = 1/(1-e) gives b^2 = 6e (1 + 7e/10 + ...) for a small lack e of span."""
    lack = 2.0 ** -np.arange(20.0, 50.0)
    b = cable_shape_number(1.0 - lack)
    np.testing.assert_allclose(b**2, 6.0 * lack * (1.0 + 0.7 * lack), rtol=2e-12)


def test_pretension_without_load() -> None:
    assert float(solve_cable(11.0, 10.0, 1e-9, 5e4).tension) == pytest.approx(5e3, rel=1e-9)


def test_soft_and_stiff_limits() -> None:
    ratio = np.linspace(0.2, 0.98, 40)
    np.testing.assert_allclose(cable_tension_ratio(ratio, 1e13), cable_tension_ratio(ratio), rtol=1e-9)
    np.testing.assert_allclose(arc_tension_ratio(ratio, 1e13), arc_tension_ratio(ratio), rtol=1e-9)
    # straight cable of initial length: sigma l = (24 EA)^(1/3) ... tau^3 = R_E / 24 for large R_E
    assert float(cable_tension_ratio(1.0, 1e9) ** 3 * 24.0 / 1e9) == pytest.approx(1.0, abs=1e-5)
    assert float(arc_tension_ratio(1.0, 1e9) ** 3 * 24.0 / 1e9) == pytest.approx(1.0, abs=1e-5)


def test_cable_is_in_equilibrium() -> None:
    """Load p = sigma cos^2 over the arc, by quadrature of the shape itself, is carried by the two ends."""
    rng = np.random.default_rng(3)
    span = rng.uniform(1.0, 100.0, 30)
    length, load, stiffness = span * rng.uniform(0.97, 1.8, 30), rng.uniform(1, 1e3, 30), 10.0 ** rng.uniform(4, 8, 30)
    cable = solve_cable(span, length, load, stiffness)
    points, weights = np.polynomial.legendre.leggauss(60)
    slope = np.sinh(cable.shape_number[:, None] * points)
    downstream = np.sum(weights * load[:, None] / (1.0 + slope**2), axis=1) * span / 2
    arc = np.sum(weights * np.sqrt(1.0 + slope**2), axis=1) * span / 2
    # the load on ds = dy sqrt(1 + slope^2) has the downstream part cos(theta): the roots cancel
    np.testing.assert_allclose(2.0 * cable.downstream_end_force, downstream, rtol=1e-11)
    np.testing.assert_allclose(arc, length * (1.0 + cable.strain), rtol=1e-11)
    np.testing.assert_allclose(cable.stretched_length, arc, rtol=1e-11)
    ends = cable.deflection(np.array([0.0]))[:, 0]
    np.testing.assert_allclose(ends, cable.sag, rtol=1e-12)
    assert np.max(np.abs(cable.deflection(span / 2).diagonal())) < 1e-12 * span.max()


def test_arc_geometry_at_random() -> None:
    rng = np.random.default_rng(5)
    length, pressure = rng.uniform(0.1, 20, COUNT), 10.0 ** rng.uniform(-1, 4, COUNT)
    stiffness = pressure * length * 10.0 ** rng.uniform(-0.79, 9, COUNT)
    chord = length * 10.0 ** rng.uniform(-2, 0.3, COUNT)
    arc = solve_skirt_arc(chord, length, pressure, stiffness)
    assert np.all((arc.half_angle > 0) & (arc.half_angle < np.pi))
    np.testing.assert_allclose(2.0 * arc.radius * np.sin(arc.half_angle), chord, rtol=1e-9)
    np.testing.assert_allclose(arc.stretched_length, length * (1.0 + arc.tension / stiffness), rtol=1e-9)
    np.testing.assert_allclose(2.0 * arc.edge_load, 2.0 * arc.tension * np.sin(arc.half_angle), rtol=1e-9)


@pytest.mark.slow
def test_rigid_law_obeys_moments_and_elastic_law_its_length() -> None:
    rng = np.random.default_rng(8)
    for _ in range(200):
        length, toe, pressure = rng.uniform(0.5, 20), 10.0 ** rng.uniform(0, 4), 10.0 ** rng.uniform(-1, 3)
        catenary, circular, rigid, elastic = section_laws(length, toe, pressure, toe * 50.0)
        moment = pressure * length * np.cos(rigid.top_angle) ** 2 * length / 2
        assert moment == pytest.approx(toe * rigid.flare, rel=1e-12)
        assert np.hypot(rigid.effective_depth, rigid.flare) == pytest.approx(length, rel=1e-12)
        longer = section_laws(length * (1.0 + toe / (toe * 50.0)), toe, pressure)[0]
        assert (elastic.effective_depth, elastic.flare) == (longer.effective_depth, longer.flare)
        # the horizontal part of the load is the integral of q cos^3 over the arc, tan of the angle = s/a
        s = 0.5 * length * (1.0 + np.polynomial.legendre.leggauss(80)[0])
        weights = 0.5 * length * np.polynomial.legendre.leggauss(80)[1]
        load = pressure * np.sum(weights * (1.0 + (s * pressure / toe) ** 2) ** -1.5)
        if pressure * length / toe < 20.0:
            assert catenary.horizontal_load == pytest.approx(load, rel=1e-7)
        if pressure * length / toe < 0.05:
            assert circular.effective_depth == pytest.approx(catenary.effective_depth, rel=1e-3)


def test_flat_curtain_joins_all_laws() -> None:
    catenary, circular, rigid, elastic, parabola = plan_laws(100.0, 100.05, 300.0, 1e12)
    for law in (circular, elastic, parabola):
        assert law.tension == pytest.approx(catenary.tension, rel=2e-3)
        assert law.sag == pytest.approx(catenary.sag, rel=2e-3)
        assert law.downstream_end_force == pytest.approx(rigid.downstream_end_force, rel=2e-3)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: cable_shape_number(1.0), "no bound"),
        (lambda: cable_shape_number(-0.5, 10.0), "greater than 0"),
        (lambda: cable_shape_number(0.5, 0.0), "greater than 0"),
        (lambda: arc_half_angle(0.5, 0.1), "full circle"),
        (lambda: solve_cable(10.0, 12.0, 0.0), "line_load"),
        (lambda: section_laws(1.0, 0.0, 1.0), "toe_load"),
    ],
)
def test_refusals(call, words) -> None:
    with pytest.raises(InputError, match=words):
        call()


def test_notice_where_the_laws_drift_apart() -> None:
    assert check_section_load(1.0, 1.0, 0.9) == ()
    assert "no solution" in check_section_load(1.0, 1.0, 4.0)[0].message
    assert check_section_load(1.0, 1.0, 2.0)[0].value == pytest.approx(2.0)
