"""Exact limits of the catenary, regime by regime, and bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from moyai.core.errors import InputError
from moyai.mooring import kernels
from moyai.mooring.catenary import solve_catenary


@settings(deadline=None)
@given(st.floats(0.01, 1.55), st.floats(1e-6, 2.0), st.floats(1e-30, 1e-12))
def test_weightless_stretched_line_is_a_straight_bar(angle: float, strain: float, weight: float) -> None:
    length, axial = 10.0, 1e5
    chord = length * (1.0 + strain)
    for w in (weight, 0.0, -weight):
        line = solve_catenary(chord * math.cos(angle), chord * math.sin(angle), length, axial, w, bed=False)
        assert line.tension_fairlead == pytest.approx(axial * strain, rel=1e-8)
        assert line.vertical_tension_fairlead == pytest.approx(axial * strain * math.sin(angle), rel=1e-8)
        along = np.array([math.cos(angle), math.sin(angle)])
        assert along @ line.stiffness @ along == pytest.approx(axial / length, rel=1e-6)
        across = np.array([-math.sin(angle), math.cos(angle)])
        assert across @ line.stiffness @ across == pytest.approx(axial * strain / chord, rel=1e-6)


def test_weightless_slack_line_holds_nothing() -> None:
    line = solve_catenary(3.0, 4.0, 6.0, 1e5, 0.0, bed=False)
    assert line.regime == kernels.SLACK_WEIGHTLESS and line.tension_fairlead == 0.0


def test_shallow_cable_against_the_parabola() -> None:
    """H -> w X^2 / (8 sag) with the sag of the parabola; the catenary differs by terms of (sag/X)^2."""
    span, weight, stretch = 100.0, 5.0, 1.0 + 1e-6
    length = span * stretch
    sag = span * math.sqrt(3.0 / 8.0 * (stretch - 1.0))
    line = solve_catenary(span, 0.0, length, np.inf, weight, bed=False)
    assert line.horizontal_tension == pytest.approx(weight * span**2 / (8.0 * sag), rel=1e-5)


@settings(deadline=None)
@given(st.floats(0.05, 0.999), st.floats(1e-7, 1.0))
def test_vertical_line_slack_and_taut(share: float, softness: float) -> None:
    weight, length = 7.0, 20.0
    axial = weight * length / softness
    # slack: folded below, the longer leg on the upper end; Z of the fold follows from both legs under their own weight
    height = share * length * (1.0 + 0.5 * softness)
    line = solve_catenary(0.0, height, length, axial, weight, bed=False)
    upper, lower = line.vertical_tension_fairlead, -line.vertical_tension_anchor
    rise = (upper - lower) / weight + (upper**2 - lower**2) / (2.0 * axial * weight)
    assert rise == pytest.approx(height, rel=1e-12)
    assert upper + lower == pytest.approx(weight * length, rel=1e-12)
    # taut: Hooke with its own weight
    height = length * (1.0 + 0.5 * softness + share)
    line = solve_catenary(0.0, height, length, axial, weight, bed=False)
    assert line.regime == kernels.TAUT_VERTICAL
    assert line.vertical_tension_anchor == pytest.approx(axial * share, rel=1e-9)
    assert line.stiffness[1, 1] == pytest.approx(axial / length)


@settings(deadline=None)
@given(st.floats(0.05, 0.95))
def test_nearly_vertical_tends_to_vertical(share: float) -> None:
    for height in (10.0 * share, 10.0 * (1.1 + share)):
        exact = solve_catenary(0.0, height, 10.0, 500.0, 4.0, bed=False)
        near = solve_catenary(1e-9, height, 10.0, 500.0, 4.0, bed=False)
        assert near.vertical_tension_fairlead == pytest.approx(
            float(exact.vertical_tension_fairlead), rel=1e-6, abs=1e-9
        )
        assert near.horizontal_tension < 1e-6


def test_slack_line_hangs_and_rests() -> None:
    line = solve_catenary(3.0, 5.0, 20.0, 1e3, 4.0)
    hanging = line.vertical_tension_fairlead / 4.0
    assert hanging + 4.0 * hanging**2 / (2.0 * 1e3) == pytest.approx(5.0, rel=1e-14)
    assert line.regime == kernels.SLACK_ON_BED and line.horizontal_tension == 0.0
    assert line.grounded_length == pytest.approx(20.0 - hanging)


def test_stretched_along_the_bed() -> None:
    free = solve_catenary(10.5, 0.0, 10.0, 1000.0, 3.0)
    assert free.regime == kernels.ALONG_BED
    assert free.horizontal_tension == pytest.approx(1000.0 * 0.05, rel=1e-6)
    # friction mobilised along the whole line lowers the mean tension by mu w L / 2
    held = solve_catenary(10.5, 0.0, 10.0, 1000.0, 3.0, bed_friction=0.4)
    assert held.horizontal_tension == pytest.approx(1000.0 * 0.05 + 0.5 * 0.4 * 3.0 * 10.0, rel=1e-6)
    assert held.horizontal_tension_anchor == pytest.approx(float(held.horizontal_tension) - 0.4 * 3.0 * 10.0, rel=1e-6)


def test_friction_holds_the_line_before_its_anchor() -> None:
    line = solve_catenary(95.0, 8.0, 100.0, 1e8, 400.0, bed_friction=1.5)
    assert line.horizontal_tension_anchor == 0.0 and line.horizontal_tension > 0.0


def test_friction_falls_by_mu_w_per_metre() -> None:
    line = solve_catenary(99.0, 8.0, 100.0, 1e8, 400.0, bed_friction=0.5)
    expected = line.horizontal_tension - 0.5 * 400.0 * line.grounded_length
    assert line.horizontal_tension_anchor == pytest.approx(float(expected), rel=1e-13)


@pytest.mark.parametrize("softness", [1e-6, 1e-2, 0.6])
def test_forces_and_stiffness_pass_smoothly_from_resting_to_lifted(softness: float) -> None:
    length, weight, height = 50.0, 30.0, 25.0
    axial = weight * length / softness
    low, high = 0.0, 50.0 * length
    for _ in range(80):
        middle = 0.5 * (low + high)
        lifted = solve_catenary(middle, height, length, axial, weight).vertical_tension_anchor > 0.0
        low, high = (low, middle) if lifted else (middle, high)
    before = solve_catenary(low * (1 - 1e-9), height, length, axial, weight)
    after = solve_catenary(high * (1 + 1e-9), height, length, axial, weight)
    assert before.regime == kernels.GROUNDED and after.regime != kernels.GROUNDED
    assert before.horizontal_tension == pytest.approx(float(after.horizontal_tension), rel=1e-5)
    assert np.allclose(before.stiffness, after.stiffness, rtol=1e-4)
    assert after.vertical_tension_anchor == pytest.approx(0.0, abs=1e-4 * weight * length)


def test_bed_far_below_a_raised_anchor_is_no_bed() -> None:
    free = solve_catenary(30.0, 10.0, 50.0, 1e5, 20.0, bed=False)
    deep = solve_catenary(30.0, 10.0, 50.0, 1e5, 20.0, bed_clearance=100.0)
    assert deep.horizontal_tension == free.horizontal_tension and deep.grounded_length == 0.0


def test_line_hanging_from_both_ends_to_the_bed_is_two_lines() -> None:
    """Cut at the bed, each half is a line from the bed to its own fairlead under the same H."""
    whole = solve_catenary(40.0, 3.0, 46.0, 1e5, 20.0, bed_clearance=5.0)
    assert whole.regime == kernels.GROUNDED and whole.grounded_length > 0.0
    spans = 0.0
    for height, vertical in ((5.0, -whole.vertical_tension_anchor), (8.0, whole.vertical_tension_fairlead)):
        suspended = float(vertical) / 20.0
        low, high = 0.0, 2.0 * suspended
        for _ in range(80):
            middle = 0.5 * (low + high)
            half = solve_catenary(middle, height, suspended, 1e5, 20.0, bed=False)
            low, high = (middle, high) if half.horizontal_tension < whole.horizontal_tension else (low, middle)
        assert half.vertical_tension_fairlead == pytest.approx(float(vertical), rel=1e-6)
        spans += middle
    on_bed = float(whole.grounded_length) * (1.0 + float(whole.horizontal_tension) / 1e5)
    assert spans + on_bed == pytest.approx(40.0, rel=1e-9)


def test_inextensible_line_shorter_than_its_chord() -> None:
    line = solve_catenary(3.0, 4.0, 4.9, np.inf, 2.0, bed=False)
    assert line.regime == kernels.UNREACHABLE and line.regime_names == "unreachable"


def test_broadcasting_and_names() -> None:
    lines = solve_catenary(np.linspace(90, 99, 6).reshape(2, 3), 8.0, 100.0, 1e8, 400.0)
    assert lines.stiffness.shape == (2, 3, 2, 2) and lines.tension_anchor.shape == (2, 3)
    assert lines.regime_names.shape == (2, 3)


@pytest.mark.parametrize(
    ("changes", "path"),
    [
        ({"horizontal_distance": -1.0}, "horizontal_distance"),
        ({"horizontal_distance": math.nan}, "horizontal_distance"),
        ({"vertical_distance": math.inf}, "vertical_distance"),
        ({"vertical_distance": -0.5}, "vertical_distance"),
        ({"unstretched_length": 0.0}, "unstretched_length"),
        ({"axial_stiffness": -1.0}, "axial_stiffness"),
        ({"axial_stiffness": math.nan}, "axial_stiffness"),
        ({"submerged_weight": math.nan}, "submerged_weight"),
        ({"bed_friction": -0.1}, "bed_friction"),
        ({"bed_clearance": -0.1}, "bed_clearance"),
    ],
)
def test_bad_input_has_one_clear_message(changes: dict[str, float], path: str) -> None:
    good = {
        "horizontal_distance": 90.0,
        "vertical_distance": 8.0,
        "unstretched_length": 100.0,
        "axial_stiffness": 1e8,
        "submerged_weight": 400.0,
    }
    with pytest.raises(InputError) as caught:
        solve_catenary(**{**good, **changes})
    assert caught.value.fault.path == path and caught.value.fault.allowed
