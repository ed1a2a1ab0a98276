"""Forces of the network on a body at the instants of its rows."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.coupled.bodies import BodyHistory


def history(force):
    rows = len(force)
    none = np.zeros((rows, 3))
    return BodyHistory(
        none, np.zeros((rows, 3, 3)), np.zeros((rows, 6)), np.zeros((rows, 6)), force, ("a",), none[:, 0]
    )


def means(integral, time):
    """Return rows whose values are means over the step before, of a force with this integral."""
    rows = np.diff(integral(time)) / np.diff(time)
    return np.concatenate([[0.0], rows])[:, None, None] * np.array([1.0, 0.0, -2.0])


def test_means_of_a_cubic_force_give_its_values():
    time = 0.1 * np.arange(12)
    found = history(means(lambda t: t**4 / 4.0 - t**3 + t, time)).point_force_at_rows
    exact = time**3 - 3.0 * time**2 + 1.0
    assert found[2:-2, 0, 0] == pytest.approx(exact[2:-2], abs=1e-12)
    assert found[2:-2, 0, 2] == pytest.approx(-2.0 * exact[2:-2], abs=1e-12)


@pytest.mark.parametrize("rows", [1, 2, 3, 4, 6])
def test_short_records_keep_a_straight_force(rows):
    time = 0.1 * np.arange(rows)
    found = history(means(lambda t: 1.5 * t**2 + 2.0 * t, time)).point_force_at_rows[:, 0, 0]
    if rows > 2:
        assert found[1:] == pytest.approx(3.0 * time[1:] + 2.0, abs=1e-12)
    assert np.isfinite(found).all()
