"""Homography and rays through wall and water."""

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.streaks.camera_calibration import (
    RayCamera,
    Refraction,
    dry_to_wet,
    fit_homography,
    fit_ray_camera,
)

RANDOM = np.random.default_rng(44)
SHAPE = (1200, 1600)
CENTRE = np.array([799.5, 599.5])


def random_camera():
    refraction = Refraction(
        RANDOM.uniform(0.4, 1.5),
        RANDOM.uniform(0.0, 0.03),
        RANDOM.uniform(1.4, 1.6),
        RANDOM.uniform(0.1, 0.6),
        1.333,
    )
    focal = 6000.0 * refraction.distance / 1.2
    return RayCamera(RANDOM.normal(0.0, 0.02, 2), RANDOM.normal(0.0, 0.03, 3), focal, CENTRE, refraction)


def grid(camera):
    edge = camera.to_world([[100, 100], [1500, 1100]])
    x, z = np.meshgrid(np.linspace(*edge[:, 0], 8), np.linspace(*edge[:, 1], 6))
    return np.column_stack([x.ravel(), z.ravel()])


def in_air(refraction):
    return Refraction(
        refraction.camera_to_wall, refraction.wall_thickness, refraction.wall_index, refraction.sheet_distance, 1.0
    )


@pytest.mark.parametrize("trial", range(3))
def test_rays_go_there_and_back_and_obey_snell(trial):
    camera = random_camera()
    points = grid(camera)
    assert camera.to_world(camera.to_pixels(points)) == pytest.approx(points, abs=1e-12)
    # The sine times the index stays the same through all media
    refraction, tangent = camera.refraction, RANDOM.uniform(0.05, 0.5)
    sine = tangent / np.hypot(1.0, tangent)
    angles = [np.arcsin(sine / index) for index in (1.0, refraction.wall_index, refraction.water_index)]
    depths = [refraction.camera_to_wall, refraction.wall_thickness, refraction.sheet_distance]
    expected = sum(depth * np.tan(angle) for depth, angle in zip(depths, angles))
    assert refraction.reach(tangent) == pytest.approx(expected, rel=1e-12)


def test_without_refraction_the_camera_is_a_homography():
    camera = random_camera()
    plain = Refraction(0.7, 0.0, 1.0, 0.4, 1.0)
    pinhole = RayCamera(camera.foot, camera.rotation, 6000.0, CENTRE, plain)
    points = grid(pinhole)
    found = fit_homography(pinhole.to_pixels(points), points)
    assert found.residual < 1e-8
    assert found.to_world(found.to_pixels(points)) == pytest.approx(points, abs=1e-12)
    assert found.to_pixels(points) == pytest.approx(pinhole.to_pixels(points), abs=1e-7)


@pytest.mark.parametrize("trial", range(3))
def test_camera_is_found_from_its_targets(trial):
    camera = random_camera()
    points = grid(camera)
    pixels = camera.to_pixels(points)
    exact = fit_ray_camera(pixels, points, refraction=camera.refraction, shape=SHAPE)
    assert exact.residual < 1e-6
    assert exact.focal_length == pytest.approx(camera.focal_length, rel=1e-6)
    noisy = fit_ray_camera(
        pixels + RANDOM.normal(0.0, 0.1, pixels.shape), points, refraction=camera.refraction, shape=SHAPE
    )
    pixel = np.linalg.norm(points[1] - points[0]) / np.linalg.norm(pixels[1] - pixels[0])
    assert np.abs(noisy.to_world(pixels) - points).max() < 0.5 * pixel


def test_homography_in_water_takes_most_of_the_refraction_up():
    camera = random_camera()
    points = grid(camera)
    pixels = camera.to_pixels(points)
    found = fit_homography(pixels, points)
    size = np.ptp(points[:, 0])
    assert np.abs(found.to_world(pixels) - points).max() < 2e-3 * size
    assert np.linalg.det(found.matrix) != 0.0


def test_targets_of_the_empty_tank_serve_with_the_refraction():
    camera = random_camera()
    dry = RayCamera(camera.foot, camera.rotation, camera.focal_length, CENTRE, in_air(camera.refraction))
    points = grid(camera)
    pixels = camera.to_pixels(points)
    rays = fit_ray_camera(dry.to_pixels(points), points, refraction=camera.refraction, shape=SHAPE, dry=True)
    assert np.abs(rays.to_world(pixels) - points).max() < 1e-8
    size = np.ptp(points[:, 0])
    raw = fit_homography(dry.to_pixels(points), points)
    paraxial = dry_to_wet(raw, camera.refraction, camera.foot)
    wrong = np.abs(raw.to_world(pixels) - points).max()
    assert np.abs(paraxial.to_world(pixels) - points).max() < min(0.15 * wrong, 0.01 * size)


def test_magnification_is_the_limit_of_the_rays():
    refraction = random_camera().refraction
    ratio = refraction.reach(1e-5) / (1e-5 * refraction.distance)
    assert refraction.magnification == pytest.approx(1.0 / ratio, rel=1e-8)


def test_faulty_targets_are_reported():
    line = np.column_stack([np.arange(6.0), 2.0 * np.arange(6.0)])
    spread = RANDOM.uniform(0.0, 1.0, (6, 2))
    with pytest.raises(InputError, match="on one line"):
        fit_homography(100.0 * spread, line)
    with pytest.raises(InputError, match="on one line"):
        fit_homography(100.0 * line, spread)
    with pytest.raises(InputError, match="too few"):
        fit_homography(spread[:3], spread[:3])
    with pytest.raises(InputError, match="share one"):
        fit_homography(np.vstack([spread, spread[:1]]), np.vstack([spread, spread[:1] + 0.3]))
    three_on_a_line = np.array([[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.5, 1.0]])
    with pytest.raises(InputError, match="not determined"):
        fit_homography(100.0 * three_on_a_line, three_on_a_line)
    with pytest.raises(InputError, match="between 1 and 3"):
        Refraction(1.0, 0.01, 0.5, 0.3, 1.33)
