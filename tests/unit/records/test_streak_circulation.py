"""Contours, interpolation, extrapolation and the law."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.streaks.circulation_law import check_amplitude, fit_circulation_law, inertia_reduction
from moyai.records.streaks.contour_circulation import (
    contour_points,
    extrapolate_linear,
    extrapolate_stokes,
    line_integral,
    measure_circulation,
)
from moyai.records.streaks.drift_interpolation import interpolation_matrix
from moyai.records.streaks.flow import circle_map, rectangle_map

RANDOM = np.random.default_rng(43)
SECTIONS = [circle_map(0.045), rectangle_map(0.045, 0.045), rectangle_map(0.045, 0.024), rectangle_map(0.02, 0.06)]


def vortex(points, circulation, stokes=0.0, radius=0.0225):
    """Clockwise vortex with a term of Stokes drift."""
    square = (points**2).sum(axis=1)
    strength = circulation + stokes * (radius**2 / square) ** 2
    return strength[:, None] * np.column_stack([points[:, 1], -points[:, 0]]) / (2.0 * math.pi * square[:, None])


def cloud_around(section, count, size, random):
    points = random.uniform(-size, size, (3 * count, 2))
    return points[~section.contains(points[:, 0] + 1j * points[:, 1], 1e-3)][:count]


@pytest.mark.parametrize("section", SECTIONS)
def test_line_integral_is_positive_clockwise_whichever_way_the_contour_runs(section):
    points = contour_points(section.outline, 1.8, 600)
    for contour in (points, points[::-1]):
        assert line_integral(contour, vortex(contour, 3e-3)) == pytest.approx(3e-3, rel=1e-3)
    assert line_integral(points, np.ones_like(points)) == pytest.approx(0.0, abs=1e-15)


def test_line_integral_of_a_rotation_is_twice_the_area():
    points = contour_points(SECTIONS[2].outline, 2.0, 37)
    turning = np.column_stack([points[:, 1], -points[:, 0]])
    assert line_integral(points, turning) == pytest.approx(2.0 * 4.0 * SECTIONS[2].area, rel=1e-12)


def test_extrapolation_is_exact_for_its_own_form():
    ratio = np.sort(RANDOM.uniform(1.2, 3.5, 8))
    g, c = RANDOM.normal(0.0, 1.0, 2)
    found = extrapolate_stokes(ratio, np.where(ratio < 1.5, 99.0, g + c * ratio**-4))
    assert found == pytest.approx((g, c), abs=1e-10)
    assert extrapolate_linear(ratio, g + c * (ratio - 1.0)) == pytest.approx(g, abs=1e-10)


# Straight lines between neighbours overrate a field that falls like 1/r, which is why the spline is the default
@pytest.mark.slow
@pytest.mark.parametrize(("method", "tolerance"), [("spline", 0.06), ("triangles", 0.25)])
@pytest.mark.parametrize("section", SECTIONS[:3])
def test_scattered_drift_gives_the_planted_circulation(section, method, tolerance):
    random = np.random.default_rng(7)
    planted, stokes = random.uniform(1e-3, 6e-3), random.uniform(1e-3, 4e-3)
    points = cloud_around(section, 250, 0.1, random)
    drift = vortex(points, planted, stokes) + random.normal(0.0, 2e-4, points.shape)
    found = measure_circulation(
        points, drift, section.outline, [1.5, 1.75, 2.0, 2.5, 3.0], method=method, resamples=12, seed=3
    )
    assert found.limit == pytest.approx(planted, rel=tolerance)
    assert found.limit_interval[0] < found.limit_interval[1]
    mirrored = measure_circulation(points, -drift, section.outline, [1.5, 2.0, 3.0], method=method, resamples=0)
    assert mirrored.limit == pytest.approx(-planted, rel=tolerance)


@pytest.mark.parametrize(
    ("sizes", "reported"), [([1.2, 1.5, 2.0], True), ([1.5, 1.75, 2.0], False), ([1.5, 2, 9], True)]
)
def test_a_limit_carried_by_two_contours_is_reported(sizes, reported):
    random = np.random.default_rng(5)
    points = cloud_around(SECTIONS[0], 60, 0.1, random)
    found = measure_circulation(points, vortex(points, 2e-3, 1e-3), SECTIONS[0].outline, sizes, resamples=0)
    few = [notice for notice in found.notices if notice.code == "contours-few"]
    assert [notice.value for notice in few] == ([2.0] if reported else [])


@pytest.mark.slow
def test_interval_covers_the_planted_circulation():
    random = np.random.default_rng(11)
    section, inside = SECTIONS[0], 0
    for trial in range(20):
        points = cloud_around(section, 120, 0.08, random)
        drift = vortex(points, 2e-3, 1e-3) + random.normal(0.0, 8e-4, points.shape)
        found = measure_circulation(
            points, drift, section.outline, [1.5, 2.0, 2.5, 3.0], resamples=60, confidence=0.9, seed=trial
        )
        inside += found.limit_interval[0] <= 2e-3 <= found.limit_interval[1]
    # Binomial of 20 at 0.9, and resampling is a little narrow with few particles
    assert inside >= 13


def test_spline_reproduces_straight_fields_and_passes_through_its_points():
    points, targets = RANDOM.uniform(-1.0, 1.0, (40, 2)), RANDOM.uniform(-1.0, 1.0, (9, 2))
    even = np.ones(40)
    straight = points @ np.array([2.0, -3.0]) + 0.7
    for smoothing in (0.0, 1.0):
        matrix = interpolation_matrix(points, targets, even, smoothing)
        assert matrix @ straight == pytest.approx(targets @ np.array([2.0, -3.0]) + 0.7, abs=1e-7)
    values = RANDOM.normal(size=40)
    assert interpolation_matrix(points, points, even, 0.0) @ values == pytest.approx(values, abs=1e-4)


def test_law_is_robust_and_scale_free():
    kc = np.array([1.0, 1.2, 1.5, 1.7, 2.0, 1.4])
    breadth, frequency = 0.06, 0.7
    gamma = 0.95 * frequency * breadth**2 * kc**2 * np.exp(RANDOM.normal(0.0, 0.01, 6))
    gamma[5] *= 2.5
    law = fit_circulation_law(kc, gamma, frequency, breadth)
    assert law.coefficient == pytest.approx(0.95, rel=0.03)
    assert law.weight[5] < 0.2
    assert law.dimensional[0] == pytest.approx(law.coefficient * frequency * breadth**2)


def test_law_leaves_out_runs_against_the_orbits_and_says_so():
    law = fit_circulation_law([1.0, 2.0], [1e-3, -1e-3], 1.0, 0.05)
    assert law.notices[0].code == "circulation-against-orbits"
    assert law.weight.tolist() == [1.0, 0.0]
    with pytest.raises(InputError, match="no run"):
        fit_circulation_law([1.0], [-1e-3], 1.0, 0.05)


def test_reduction_of_inertia_from_circulation():
    areas = np.array([15.904, 20.25, 10.80]) * 1e-4
    assert inertia_reduction(18e-4, 1.0 / 0.95, areas) == pytest.approx([0.1896, 0.1489, 0.2792], abs=1e-4)


def test_amplitudes_beyond_the_range_are_reported():
    assert check_amplitude(1.5) == ()
    assert check_amplitude(0.6)[0].limit == 1.0
    assert check_amplitude(2.6)[0].limit == 2.0


def test_faults_of_clouds_and_contours_are_reported():
    points = RANDOM.uniform(-0.1, 0.1, (30, 2))
    outline = SECTIONS[0].outline
    with pytest.raises(InputError, match="too few"):
        measure_circulation(points[:5], points[:5], outline, [1.5, 2.0])
    with pytest.raises(InputError, match="no contour lies within"):
        measure_circulation(points, points, outline, [8.0, 9.0], resamples=0)
    with pytest.raises(InputError, match="none smaller"):
        measure_circulation(points, points, outline, [0.8, 2.0])
    with pytest.raises(InputError, match="the fit needs two"):
        extrapolate_stokes([1.1, 1.2, 2.0], [1.0, 1.0, 1.0])
