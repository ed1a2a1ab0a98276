"""Chains from streaks whose ends are shuffled, and the order in time of pulses."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.records.streaks.flow import OrbitalFlow, circle_map, track_particles
from moyai.records.streaks.linking import LinkingSettings, WorldStreaks, link_exposure, link_frames
from moyai.records.streaks.timing import PulseTrain, direction_evidence, regular_pulses, require_time_order

RANDOM = np.random.default_rng(46)
PERIOD = 1.05


def shuffled_streaks(train, count, seed, noise=5e-5, scatter=0.1):
    """Streaks of many particles with the truth: particle and pulse of each, ends turned at random."""
    random = np.random.default_rng(seed)
    section = circle_map(0.045)
    speed = random.uniform(1.0, 1.6) * 0.045 / PERIOD
    flow = OrbitalFlow(section, PERIOD, speed, speed, 3e-3)
    start = random.uniform(-0.1, 0.1, (3 * count, 2))
    start = start[~section.contains(start[:, 0] + 1j * start[:, 1], 1e-3)][:count]
    instants = np.sort(np.concatenate([train.start, train.end]))
    path = track_particles(flow, start, instants)
    near = track_particles(flow, start, np.sort(np.concatenate([instants, train.start + 1e-4, train.end + 1e-4])))
    before, after = path[:, 0::2], path[:, 1::2]
    velocity = (near[:, 1::2] - near[:, 0::2]) / 1e-4
    ends = np.stack([before, after], axis=2) + random.normal(0.0, noise, (*before.shape[:2], 2, 2))
    tangents = np.stack([velocity[:, 0::2], velocity[:, 1::2]], axis=2)
    tangents /= np.linalg.norm(tangents, axis=-1, keepdims=True)
    light = random.normal(0.0, 0.3, (count, 1)) + train.light + random.normal(0.0, scatter, before.shape[:2])
    turned = random.random(before.shape[:2]) < 0.5
    ends[turned] = ends[turned][:, ::-1]
    tangents[turned] = -tangents[turned][:, ::-1]
    return ends, tangents, light


def check_against_truth(chains, owner, pulse):
    """Return how many chains mix particles, and how many streaks of the rest carry a wrong pulse (a wrong order)."""
    mixed = wrong = 0
    for chain in chains:
        names = owner(chain)
        if len(set(names)) > 1:
            mixed += 1
        elif np.any(np.diff(pulse(chain)) != np.diff(chain.pulse)):
            wrong += 1
    return mixed, wrong


@pytest.mark.parametrize("seed", [1, 2])
def test_frames_are_linked_in_the_right_order(seed):
    train = regular_pulses(PERIOD / 9.6, 0.045, 1.0, 12)
    ends, tangents, light = shuffled_streaks(train, 120, seed)
    order = [RANDOM.permutation(120) for _ in range(12)]
    pictures = [WorldStreaks(ends[o, k], tangents[o, k], light[o, k]) for k, o in enumerate(order)]
    chains = link_frames(pictures, train, LinkingSettings())
    full = [chain for chain in chains if len(chain.streak) == 12]
    mixed, wrong = check_against_truth(
        full, lambda c: [order[f][s] for f, s in zip(c.picture, c.streak)], lambda c: c.picture
    )
    assert len(full) > 90
    assert mixed <= 2
    assert wrong == 0
    for chain in full[:20]:
        particle = order[chain.picture[0]][chain.streak[0]]
        # The first end in time is the one that was before, whichever way the streak was handed over
        steps = np.hypot(*(chain.chain.start[1:] - chain.chain.end[:-1]).T)
        assert steps.max() < 0.02, particle


@pytest.mark.parametrize("powers", [(1.0, 0.65, 0.4), (1.0, 0.45)])
@pytest.mark.parametrize("seed", [3, 4])
def test_one_picture_of_all_pulses_is_linked_and_directed_by_its_light(powers, seed):
    if len(powers) == 2:
        # Pairs of pulses look alike both ways; a third on-time breaks that
        train = PulseTrain(
            PERIOD / 9.6 * np.arange(12), np.resize([0.05, 0.05, 0.025, 0.035], 12), np.resize([1.0, 0.8, 1.0, 0.5], 12)
        )
    else:
        train = regular_pulses(PERIOD / 9.6, 0.045, powers, 12)
    ends, tangents, light = shuffled_streaks(train, 40, seed)
    order = RANDOM.permutation(40 * 12)
    flat = WorldStreaks(ends.reshape(-1, 2, 2)[order], tangents.reshape(-1, 2, 2)[order], light.ravel()[order])
    chains, _ = link_exposure(flat, train, LinkingSettings())
    long = [chain for chain in chains if len(chain.streak) >= 10]
    mixed, wrong = check_against_truth(long, lambda c: order[c.streak] // 12, lambda c: order[c.streak] % 12)
    assert len(long) >= 16
    assert mixed <= 3
    assert wrong == 0


def test_chains_bridge_a_missing_streak():
    train = regular_pulses(PERIOD / 9.6, 0.045, [1.0, 0.65, 0.4], 12)
    ends, tangents, light = shuffled_streaks(train, 6, 5)
    keep = np.ones((6, 12), dtype=bool)
    keep[:, 5] = False
    flat = WorldStreaks(ends[keep], tangents[keep], light[keep])
    chains, _ = link_exposure(flat, train, LinkingSettings())
    assert any(2 in np.diff(chain.pulse) for chain in chains)
    assert not link_exposure(
        WorldStreaks(np.zeros((0, 2, 2)), np.zeros((0, 2, 2)), np.zeros(0)), train, LinkingSettings()
    )[0]


def test_time_order_must_be_given_by_the_pulses():
    require_time_order(regular_pulses(0.1, 0.05, [1.0, 0.65, 0.4], 12), 10)
    require_time_order(regular_pulses(0.1, [0.06, 0.04, 0.025], 1.0, 12), 10)
    for powers in ([1.0], [1.0, 0.5], [1.0, 0.5, 0.5]):
        with pytest.raises(InputError, match="order in time of the streaks is missing"):
            require_time_order(regular_pulses(0.1, 0.05, powers, 12), 10)
    with pytest.raises(InputError, match="do not cover a period"):
        require_time_order(regular_pulses(0.1, 0.05, [1.0, 0.6, 0.3], 6), 10)


def test_a_ramp_of_brightness_tells_the_order_only_when_it_is_steep():
    steep = regular_pulses(0.1, 0.05, np.exp(-0.35 * np.arange(12)), 12)
    flat = regular_pulses(0.1, 0.05, np.exp(-0.01 * np.arange(12)), 12)
    require_time_order(steep, 10)
    with pytest.raises(InputError, match="missing"):
        require_time_order(flat, 10)


@pytest.mark.parametrize("forward", [True, False])
def test_direction_withstands_scatter_and_a_spoilt_streak(forward):
    train = regular_pulses(0.1, 0.05, [1.0, 0.65, 0.4], 12)
    right = 0
    for _ in range(60):
        light = train.light[1:11] + RANDOM.normal(0.0, 0.12, 10) + RANDOM.normal(0.0, 0.03) * np.arange(10)
        light[RANDOM.integers(10)] += math.log(2.0)
        evidence, first, found = direction_evidence(light if forward else light[::-1], np.ones(9, dtype=int), train)
        right += found == forward and (evidence < 5.0 or (first - 1) % 3 == 0)
    assert right >= 58


def test_faulty_pulses_are_reported():
    with pytest.raises(InputError, match="begins before"):
        regular_pulses(0.05, 0.06, 1.0, 5)
    with pytest.raises(InputError, match="must be positive"):
        regular_pulses(0.05, 0.02, [1.0, 0.0], 5)
