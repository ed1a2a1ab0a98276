"""Cycles in regular waves: repetition is found where it is made, and nothing of the start is left in what counts."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.impact.cycles import slack_sag, slack_taut_motion
from moyai.structures.curtain.impact.settling import _repetition, _steady, settled_cycles

WATER = Water(10.0, 1025.0, 9.81)
SPAN = Impact(20.0, 22.5, 5.0, 3.4e6, 3.4, 0.5, WATER)
WAVES = {3.0: 0.168, 4.0: 0.183, 5.0: 0.188}


def settled(period: float, drag: float = 1.5, **more: int):
    return settled_cycles(
        SPAN, drag_coefficient=drag, current=0.5, velocity_amplitude=WAVES[period], period=period,
        **({"least_settled": 4, "least_analysed": 20} | more),
    )  # fmt: skip


@pytest.mark.parametrize("multiple", [1, 2, 5, 16])
def test_repetition_is_found_with_its_start(multiple: int) -> None:
    cycle = 1.0 + np.arange(multiple) / max(multiple - 1, 1)
    peaks = np.tile(cycle, 120 // multiple + 1)[:120].copy()
    peaks[:17] += 3.0
    places = np.sin(peaks)
    found = _repetition(peaks, places, 1.0, 4, 20)
    assert found == (multiple, 17)


def test_slowly_dying_start_is_left_out() -> None:
    """What still falls by more than 1 % from period to period does not count."""
    peaks = 1.0 + 5.0 * 0.9 ** np.arange(200.0)
    found = _repetition(peaks, np.zeros(200), 1.0, 4, 20)
    assert found is not None
    multiple, first = found
    assert multiple == 1
    top = peaks[4:].max()
    assert abs(peaks[first + 1] - peaks[first]) <= 0.01 * top < abs(peaks[first] - peaks[first - 1])


def test_noise_repeats_nowhere_and_is_steady_unless_it_drifts() -> None:
    peaks = np.random.default_rng(3).uniform(1.0, 2.0, 600)
    assert _repetition(peaks, np.zeros(600), 1.0, 4, 20) is None
    assert _steady(peaks)
    assert not _steady(peaks + np.linspace(0.0, 1.0, 600))


@pytest.mark.parametrize("period", list(WAVES))
def test_the_start_does_not_count(period: float) -> None:
    """The number of a short settling is that of a long one, and of a release from the middle after 200 periods."""
    short, long = settled(period), settled(period, least_settled=120)
    assert short.kind == long.kind == "repeating"
    assert short.tension == pytest.approx(long.tension, rel=0.015)
    released = slack_taut_motion(
        SPAN, drag_coefficient=1.5, current=0.5, velocity_amplitude=WAVES[period], period=period, duration=240 * period
    )
    late = [contact.tension for contact in released.contacts if contact.time > 200 * period]
    assert max(late) == pytest.approx(short.tension, rel=0.015)
    early = [contact.tension for contact in released.contacts if contact.time < 12 * period]
    # the transient of the release, which used to be the number
    assert max(early) > 1.1 * short.tension


def test_cycles_start_taut() -> None:
    assert settled(3.0).motion.position[0] == pytest.approx(slack_sag(SPAN))


def test_a_chaotic_motion_has_a_distribution(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where repetition is not found the number is the mean of the largest of each hundred periods."""
    monkeypatch.setattr("moyai.structures.curtain.impact.settling._repetition", lambda *given: None)
    found = settled(5.0)
    assert found.kind == "chaotic" and found.count == 600 and found.multiple == 0
    blocks = found.peaks.reshape(6, 100).max(axis=1)
    assert found.tension == pytest.approx(blocks.mean())
    assert found.scatter == (blocks.min(), blocks.max())
