"""Circulation out of the exact drift of particles in orbits past a section: what the estimate adds is taken off."""

import numpy as np
import pytest
from test_streak_circulation import cloud_around

from moyai.records.streaks.contour_circulation import extrapolate_stokes, measure_circulation
from moyai.records.streaks.flow import OrbitalFlow, circle_map, rectangle_map, track_particles
from moyai.records.streaks.orbital_bias import Orbits

PERIOD, BREADTH = 1.0, 0.045
SPEED = 1.5 * BREADTH / PERIOD  # KC = 1.5
SIZES = (1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0)
SECTIONS = {"circle": circle_map(BREADTH), "square": rectangle_map(BREADTH, BREADTH)}


def drift(shape, planted, seed, count=200, sense=1.0):
    """Return the section, its orbits, and mean positions and drift of particles tracked over one period."""
    section, random = SECTIONS[shape], np.random.default_rng(seed)
    flow = OrbitalFlow(section, PERIOD, SPEED, sense * SPEED, circulation=planted)
    path = track_particles(
        flow, cloud_around(section, count, 0.1, random), np.linspace(0.0, PERIOD, 41), steps_per_period=200
    )
    path = path[np.isfinite(path).all(axis=(1, 2))]
    mean = (0.5 * (path[:, 1:] + path[:, :-1])).mean(axis=1)
    return section, Orbits(section, PERIOD, SPEED, sense * SPEED), mean, (path[:, -1] - path[:, 0]) / PERIOD


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shape", "planted", "sense"), [("circle", 0.0, 1.0), ("square", 3e-3, 1.0), ("circle", -2e-3, -1.0)]
)
def test_circulation_of_an_exact_drift_comes_back_without_bias(shape, planted, sense):
    section, orbits, place, exact = drift(shape, planted, seed=3, count=120, sense=sense)
    plain = measure_circulation(place, exact, section.outline, SIZES, resamples=0)
    found = measure_circulation(place, exact, section.outline, SIZES, resamples=0, orbits=orbits)
    assert found.limit == pytest.approx(planted, abs=5e-6)
    assert abs(plain.limit - planted) > 4e-5
    assert np.isnan(plain.bias)


def test_the_bias_shifts_the_interval_with_the_limit():
    section, orbits, place, exact = drift("circle", 1e-3, seed=5, count=90)
    noisy = exact + np.random.default_rng(1).normal(0.0, 3e-4, exact.shape)
    found = measure_circulation(place, noisy, section.outline, SIZES, resamples=30, orbits=orbits)
    low, high = np.percentile(_limits(found), (2.5, 97.5)) - found.bias
    assert found.limit_interval == pytest.approx((low, high))
    assert low < found.limit < high


def _limits(found):
    return [extrapolate_stokes(found.size_ratio, sample)[0] for sample in found.samples]


@pytest.mark.slow
def test_intervals_of_a_hundred_drawn_sets_cover_the_planted_circulation():
    """Half of them around a circle, half around a square, which have no code for the map in common."""
    inside = 0
    for shape, planted, count, noise in (("circle", 30e-4, 120, 8e-4), ("square", 14e-4, 90, 8e-4)):
        sets = [drawn_set(shape, planted, count, noise, seed) for seed in range(50)]
        error = np.array([found.limit - planted for found in sets])
        width = np.diff([found.limit_interval for found in sets])[:, 0] / (2.0 * 1.96)
        inside += sum(found.limit_interval[0] <= planted <= found.limit_interval[1] for found in sets)
        # of normal errors the scatter over fifty sets is known to 10 %
        assert 0.8 < np.std(error / width) < 1.25, shape
        assert abs(error.mean()) < 0.25 * np.mean([found.bias for found in sets]), shape
    assert 90 <= inside <= 99


def drawn_set(shape, planted, count, noise, seed):
    section, orbits, place, exact = drift(shape, planted, seed, count)
    drawn = exact + np.random.default_rng(1000 + seed).normal(0.0, noise, exact.shape)
    return measure_circulation(place, drawn, section.outline, SIZES[::2], resamples=100, seed=seed, orbits=orbits)
