"""Snaps that were planted in a record."""

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.series.snaps import find_snaps


def test_snaps_of_a_planted_record():
    time = np.linspace(0.0, 30.0, 30001)
    pull = np.full(time.size, 500.0)
    planted = ((5.0, 8.0, 0.02, 4000.0), (14.0, 16.5, 0.05, 9000.0), (22.0, 22.5, 0.1, 700.0))
    for begin, end, rise, peak in planted:
        pull[(time >= begin) & (time < end)] = 0.0
        up = (time >= end) & (time < end + rise)
        pull[up] = peak * (time[up] - end) / rise
        down = (time >= end + rise) & (time < end + 1.0)
        pull[down] = peak + (500.0 - peak) * (time[down] - end - rise) / (1.0 - rise)
    found = find_snaps(time, pull, slack_level=5.0, threshold=1000.0)
    assert found.slack_time == pytest.approx(6.0, abs=0.01)
    assert len(found.contacts) == 3 and len(found.snaps) == 2
    for contact, (begin, end, rise, peak) in zip(found.contacts, planted, strict=True):
        assert contact.time == pytest.approx(end, abs=0.003)
        assert contact.slack_before == pytest.approx(end - begin, abs=0.005)
        assert contact.peak == pytest.approx(peak, rel=0.05)
        assert contact.rise_time == pytest.approx(0.8 * rise, rel=0.1)
    peaks, part = found.exceedance()
    assert peaks[0] > peaks[1] and part == pytest.approx([1 / 3, 2 / 3])
    with pytest.raises(InputError):
        find_snaps(time, pull, slack_level=10.0, threshold=5.0)
