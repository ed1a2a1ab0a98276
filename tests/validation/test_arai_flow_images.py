"""Circulation from flow images, after Arai's measurements around horizontal cylinders at low KC.

Numbers named as the prototype's come from an independent construction for the same paper (circle of 45 mm, 0.95 Hz,
strobe of T/9.6); the orbit, the cloud of particles and the on-time of the light were not recorded with them, so that
they are reproduced within the spread of these choices.
"""

import math

import numpy as np
import pytest
from synthetic_pictures import Optics, synthesise

from moyai.core.errors import InputError
from moyai.records.streaks.circulation_law import fit_circulation_law, inertia_reduction
from moyai.records.streaks.contour_circulation import (
    contour_points,
    extrapolate_linear,
    extrapolate_stokes,
    line_integral,
    measure_circulation,
)
from moyai.records.streaks.detection import detect_streaks
from moyai.records.streaks.drift_velocity import StreakChain, close_period_cubic, fit_drift_harmonics
from moyai.records.streaks.flow import (
    OrbitalFlow,
    circle_map,
    rectangle_map,
    track_particles,
)
from moyai.records.streaks.linking import LinkingSettings, link_exposure, link_frames
from moyai.records.streaks.run import RunSettings, drift_of_chains, streaks_in_world
from moyai.records.streaks.timing import regular_pulses

BREADTH, FREQUENCY = 0.045, 0.95
PERIOD = 1.0 / FREQUENCY
SECTIONS = {
    "circle": circle_map(BREADTH),
    "square": rectangle_map(BREADTH, BREADTH),
    "rectangle": rectangle_map(BREADTH, 0.024),
}


def flow_of(section, kc, circulation):
    speed = kc * FREQUENCY * BREADTH
    return OrbitalFlow(section, PERIOD, speed, speed, circulation)


@pytest.mark.parametrize(("kc", "reference", "tolerance"), [(0.05, 1.3656, 1e-4), (1.0, 1.139, 3e-3)])
def test_stokes_drift_alone_circulates(kc, reference, tolerance):
    """Particles started on a ring of 1.1 a; leading order 2 (a/r)^4 = 1.3660. Prototype: 1.3656 and 1.139."""
    speed = 2.0 * kc
    flow = OrbitalFlow(circle_map(2.0), 1.0, speed, speed)
    angle = 2.0 * math.pi * np.arange(48) / 48
    ring = 1.1 * np.column_stack([np.cos(angle), np.sin(angle)])
    time = np.linspace(0.0, 1.0, 401)
    path = track_particles(flow, ring, time, steps_per_period=800)
    middle = np.trapezoid(path, time, axis=1)
    drift = path[:, -1] - path[:, 0]
    # Tangential drift times the length of the ring of mean positions
    circulation = 2.0 * math.pi * np.mean(drift[:, 0] * middle[:, 1] - drift[:, 1] * middle[:, 0])
    assert circulation / speed**2 == pytest.approx(reference, rel=tolerance)


def closure_errors(kc, circulation, noise, count=300):
    random = np.random.default_rng(1)
    radius = np.sqrt(random.uniform(1.25**2, 2.25**2, count)) * 0.5 * BREADTH
    angle = random.uniform(0.0, 2.0 * math.pi, count)
    start = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    interval = PERIOD / 9.6
    train = regular_pulses(interval, 0.5 * interval, 1.0, 12)
    target = train.start[0] + 0.25 * interval + PERIOD
    instants = np.sort(np.concatenate([train.start, train.end, [target]]))
    path = track_particles(flow_of(SECTIONS["circle"], kc, circulation), start, instants)
    first, last = np.searchsorted(instants, train.start), np.searchsorted(instants, train.end)
    errors = []
    for item in path:
        shaken = item + random.normal(0.0, 1.0, item.shape) * noise
        chain = StreakChain(train.start, train.end, shaken[first], shaken[last])
        truth = item[np.searchsorted(instants, target)]
        errors.append(
            [np.hypot(*(close(chain, PERIOD).closure - truth)) for close in (close_period_cubic, fit_drift_harmonics)]
        )
    return 1e3 * np.median(errors, axis=0)


@pytest.mark.slow
@pytest.mark.parametrize(("kc", "circulation", "clean", "noisy"), [(1.0, 18e-4, 0.23, 0.3), (1.5, 40.5e-4, 0.6, 0.7)])
def test_period_closes_within_the_errors_of_the_prototype(kc, circulation, clean, noisy):
    """Median error of the end point [mm]; harmonics by least squares do better than the cubic."""
    for noise, reference in ((0.0, clean), (5e-5, noisy)):
        cubic, harmonic = closure_errors(kc, circulation, noise)
        assert cubic == pytest.approx(reference, rel=0.35)
        assert harmonic < cubic


def exact_cloud(section, kc, circulation, count, seed):
    random = np.random.default_rng(seed)
    start = random.uniform(-0.1, 0.1, (3 * count, 2))
    start = start[~section.contains(start[:, 0] + 1j * start[:, 1], 5e-4)][:count]
    train = regular_pulses(PERIOD / 9.6, 0.04, 1.0, 12)
    path = track_particles(flow_of(section, kc, circulation), start, np.sort(np.concatenate([train.start, train.end])))
    drifts = [fit_drift_harmonics(StreakChain(train.start, train.end, item[0::2], item[1::2]), PERIOD) for item in path]
    return np.array([item.position for item in drifts]), np.array([item.velocity for item in drifts])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("kc", "circulation", "fit", "linear"),
    [(1.0, 18e-4, 18.1, 29.0), pytest.param(1.5, 40.5e-4, 41.6, 53.0, marks=pytest.mark.slow)],
)
def test_only_the_fit_with_a_free_stokes_term_finds_the_circulation(kc, circulation, fit, linear):
    """Prototype: line 29 and 53, leading order taken off 12 and 14, fit 18.1 and 41.6 for 18.0 and 40.5 cm2/s.

    The contours behind the prototype's wrong answers were not recorded; these answers depend on them, the fit does not.
    """
    position, drift = exact_cloud(SECTIONS["circle"], kc, circulation, 500, 3)
    ratio = np.array([1.2, 1.4, 1.5, 1.6, 1.8, 2.0])
    found = measure_circulation(position, drift, SECTIONS["circle"].outline, ratio, resamples=0)
    assert 1e4 * found.limit == pytest.approx(fit, rel=0.03)
    assert 1e4 * found.linear == pytest.approx(linear, rel=0.1)
    speed = kc * FREQUENCY * BREADTH
    rest = found.value - 2.0 * speed**2 * PERIOD / ratio**4  # the leading order of the Stokes drift
    assert extrapolate_linear(ratio, rest) < 0.75 * circulation
    larger = measure_circulation(position, drift, SECTIONS["circle"].outline, [1.5, 2.0, 2.5, 3.0], resamples=0)
    assert larger.limit == pytest.approx(circulation, rel=0.02)


def stokes_along(section, ratio):
    """Circulation of the Stokes drift of small orbits along contours, over V^2 T: exact paths, mean of eight phases."""
    flow = flow_of(section, 0.02, 0.0)
    found = []
    for size in ratio:
        points = contour_points(section.outline, size, 120)
        moves = [track_particles(flow, points, [start, start + PERIOD]) for start in PERIOD * np.arange(8) / 8]
        drift = np.mean([(path[:, 1] - path[:, 0]) / PERIOD for path in moves], axis=0)
        found.append(line_integral(points, drift))
    return np.array(found) / (flow.amplitude_x**2 * PERIOD)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "leftover"),
    [
        ("circle", 1e-3),
        pytest.param("square", 0.055, marks=pytest.mark.slow),
        pytest.param("rectangle", 0.11, marks=pytest.mark.slow),
    ],
)
def test_stokes_drift_falls_with_the_fourth_power_for_every_section(name, leftover):
    """Far away exactly; where the fit is made, what a polygon's higher orders leave in G is small."""
    far = np.array([8.0, 10.0, 12.0])
    slope = np.polyfit(np.log(far), np.log(stokes_along(SECTIONS[name], far)), 1)[0]
    assert slope == pytest.approx(-4.0, abs=0.1)
    near = np.array([1.5, 1.75, 2.0, 2.25, 2.5, 3.0])
    values = stokes_along(SECTIONS[name], near)
    assert abs(extrapolate_stokes(near, values)[0]) < leftover * values[0]
    if name == "circle":
        assert values == pytest.approx(2.0 * near**-4.0, rel=1e-3)


def test_law_and_force_reduction_of_the_paper():
    kc = np.array([1.0, 1.5, 2.0])
    law = fit_circulation_law(kc, 18e-4 * kc**2, FREQUENCY, BREADTH)
    assert law.coefficient == pytest.approx(0.9357, abs=1e-4)
    reduction = inertia_reduction(18e-4, PERIOD, [SECTIONS[name].area for name in SECTIONS])
    assert reduction == pytest.approx([0.1896, 0.1489, 0.2792], abs=1e-4)


class Plane:
    """A camera without perspective: 6.4 pixels a millimetre."""

    residual = 0.0

    def __init__(self, shape):
        self.middle = 0.5 * (np.array(shape[::-1]) - 1.0)

    def to_pixels(self, world):
        return self.middle + 6400.0 * np.atleast_2d(world) * [1.0, -1.0]

    def to_world(self, pixels):
        return (np.atleast_2d(pixels) - self.middle) / 6400.0 * [1.0, -1.0]


def from_pictures(section, kc, circulation, *, frames, seed, takes):
    """Return the circulation measured from synthetic pictures of 1600 by 1200 pixels."""
    shape = (1200, 1600)
    camera = Plane(shape)
    train = regular_pulses(PERIOD / 9.6, 0.45 * PERIOD / 9.6, 1.0 if frames else [1.0, 0.65, 0.4], 12)
    drifts = []
    for take in range(takes):
        optics = Optics(density=6000.0 if frames else 2200.0)
        made = synthesise(
            flow_of(section, kc, circulation),
            camera,
            shape,
            train,
            optics=optics,
            seed=100 * seed + take,
            frames=frames,
            phase=1.7 * take + seed,
        )
        row, column = np.mgrid[0 : shape[0], 0 : shape[1]]
        world = camera.to_world(np.column_stack([column.ravel(), row.ravel()]))
        mask = section.contains(world[:, 0] + 1j * world[:, 1], 6e-4).reshape(shape)
        found = [
            streaks_in_world(detect_streaks(picture, mask=mask, saturation=254.5), camera) for picture in made.pictures
        ]
        if frames:
            chains = link_frames(found, train, LinkingSettings())
        else:
            chains = link_exposure(found[0], train, LinkingSettings())[0]
        drifts += drift_of_chains(chains, PERIOD, RunSettings())[0]
    deviation = np.array([item.deviation for item in drifts])
    return measure_circulation(
        np.array([item.position for item in drifts]),
        np.array([item.velocity for item in drifts]),
        section.outline,
        [1.5, 1.75, 2.0, 2.25, 2.5],
        deviation=np.maximum(deviation, np.median(deviation)),
        resamples=40,
        seed=seed,
    )


# A picture costs ten seconds; examples/member/streaks makes the whole table of sections and KC
@pytest.mark.slow
@pytest.mark.parametrize(("name", "kc", "takes"), [("circle", 1.0, 2), ("square", 1.5, 1)])
def test_planted_circulation_comes_back_from_one_picture_of_all_pulses(name, kc, takes):
    planted = 18e-4 * kc**2
    found = from_pictures(SECTIONS[name], kc, planted, frames=False, seed=1, takes=takes)
    assert found.limit == pytest.approx(planted, rel=0.1)
    assert found.limit_interval[0] > 0.0


@pytest.mark.slow
def test_planted_circulation_comes_back_from_frames():
    planted = 18e-4 * 2.0**2
    found = from_pictures(SECTIONS["rectangle"], 2.0, planted, frames=True, seed=3, takes=1)
    assert found.limit == pytest.approx(planted, rel=0.1)


@pytest.mark.slow
def test_sign_of_a_circulation_against_the_orbits_is_found():
    found = from_pictures(SECTIONS["circle"], 1.2, -20e-4, frames=False, seed=4, takes=1)
    assert found.limit == pytest.approx(-20e-4, rel=0.1)
    assert found.limit_interval[1] < 0.0


def test_pictures_without_the_pattern_of_pulses_are_refused():
    from moyai.records.streaks.timing import require_time_order

    with pytest.raises(InputError, match="order in time"):
        require_time_order(regular_pulses(PERIOD / 9.6, 0.05, 1.0, 12), 11)
