"""The flow that synthetic pictures are made from: map, wall, circulation, orbits."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.streaks.contour_circulation import contour_points, line_integral
from moyai.records.streaks.flow import OrbitalFlow, circle_map, rectangle_map, track_particles

RANDOM = np.random.default_rng(41)


@pytest.mark.parametrize(
    ("section", "along_x", "along_z"),
    [
        (circle_map(0.3), 2.0, 2.0),
        (rectangle_map(1.0, 1.0), 2.1884, 2.1884),
        (rectangle_map(0.045, 0.024), 1.7026, 3.0266),
        (rectangle_map(2.0, 1.0), 1.6658, 3.1421),
    ],
)
def test_dipoles_of_the_map_give_the_known_inertia_coefficients(section, along_x, along_z):
    assert section.inertia_coefficients == pytest.approx((along_x, along_z), abs=1e-4)


@pytest.mark.parametrize("ratio", RANDOM.uniform(0.1, 8.0, 4))
def test_map_of_a_random_rectangle_has_its_sides_and_inverts(ratio):
    section = rectangle_map(0.05, 0.05 * ratio)
    assert 2.0 * section.to_plane(1.0).real == pytest.approx(0.05, rel=2e-5)
    assert 2.0 * section.to_plane(1.0j).imag == pytest.approx(0.05 * ratio, rel=2e-5)
    zeta = RANDOM.uniform(1.05, 4.0, 30) * np.exp(1j * RANDOM.uniform(0.0, 2.0 * math.pi, 30))
    assert np.abs(section.to_circle(section.to_plane(zeta)) - zeta).max() < 1e-9


@pytest.mark.parametrize("section", [circle_map(0.045), rectangle_map(0.045, 0.03)])
def test_velocity_circulates_as_planted_around_any_contour(section):
    """Speeds from short paths; the waves and a current add no circulation."""
    planted = RANDOM.uniform(-5e-3, 5e-3)
    flow = OrbitalFlow(section, 1.0, 0.03, 0.02, planted, mass_transport=0.01)
    for size in RANDOM.uniform(1.3, 3.0, 3):
        points = contour_points(section.outline, size, 400)
        path = track_particles(flow, points, [0.3, 0.3 + 1e-6])
        assert line_integral(points, (path[:, 1] - path[:, 0]) / 1e-6) == pytest.approx(planted, rel=2e-3)


def test_particles_stay_outside_the_section():
    section = rectangle_map(0.045, 0.045)
    start = np.array([[0.0, 0.0235], [0.0235, 0.01], [-0.024, -0.022], [0.01, -0.0232]])
    path = track_particles(OrbitalFlow(section, 1.0, 0.05, 0.05, 3e-3), start, np.linspace(0.0, 3.0, 200))
    inside = section.contains(path[..., 0] + 1j * path[..., 1], -1e-6)
    assert np.isfinite(path).all()
    assert not inside.any()


def test_without_model_orbits_drift_by_transport_and_settling():
    flow = OrbitalFlow(None, 1.25, 0.05, 0.03, mass_transport=0.004, decay=6.0, settling=0.0007)
    path = track_particles(flow, [[0.01, 0.02]], np.linspace(0.0, 1.25, 101))[0]
    middle = path[:-1].mean(axis=0)
    drift = (path[-1] - path[0]) / 1.25
    assert drift[1] == pytest.approx(-0.0007, rel=1e-6)
    assert drift[0] == pytest.approx(0.004 * math.exp(6.0 * middle[1]), rel=5e-3)
    assert np.ptp(path[:, 0]) == pytest.approx(2.0 * 0.05 * 1.25 / (2.0 * math.pi), rel=0.2)


def test_faults_of_the_flow_are_reported():
    with pytest.raises(InputError, match="inside the section"):
        track_particles(OrbitalFlow(circle_map(1.0), 1.0, 0.1, 0.1), [[0.1, 0.1]], [0.0, 1.0])
    with pytest.raises(InputError, match="no circulation"):
        OrbitalFlow(None, 1.0, 0.1, 0.1, circulation=0.1)
    with pytest.raises(InputError, match="do not increase"):
        track_particles(OrbitalFlow(None, 1.0, 0.1, 0.1), [[0.0, 0.0]], [0.0, 0.0])
    with pytest.raises(InputError, match="not positive"):
        rectangle_map(-1.0, 1.0)
