"""A current on a grid of times and places: exact for what is linear in each, held at its ends, and it drags lines."""

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible.flow import Flow
from moyai.sea.current_field import CurrentField


def field(seed=1):
    rng = np.random.default_rng(seed)
    axes = [np.sort(rng.uniform(-20.0, 20.0, n)) for n in (4, 3, 5)]
    time = np.array([0.0, 3.0, 10.0])
    a = rng.normal(size=(2, 2, 2, 2, 3))

    def exact(t, x, y, z):
        """Linear in each of t, x, y, z: what straight lines on any grid give again."""
        powers = [np.array([np.ones_like(v), v]) for v in np.broadcast_arrays(t / 10.0, x / 20.0, y / 20.0, z / 20.0)]
        return np.einsum("abcdk,a...,b...,c...,d...->...k", a, *powers)

    grid = np.meshgrid(time, *axes, indexing="ij")
    return CurrentField(time, *axes, exact(*grid)), exact, axes


def test_straight_lines_are_met_everywhere_inside():
    made, exact, axes = field()
    rng = np.random.default_rng(2)
    place = np.array([rng.uniform(axis[0], axis[-1], 40) for axis in axes])
    for time in (0.0, 1.7, 3.0, 8.5, 10.0):
        velocity, rate = made.at(time, place)
        np.testing.assert_allclose(velocity, exact(time, *place).T, rtol=1e-12, atol=1e-12)
        np.testing.assert_allclose(rate, (exact(1.0, *place) - exact(0.0, *place)).T, rtol=1e-9, atol=1e-12)


def test_beyond_its_ends_the_nearest_holds():
    made, _, axes = field()
    inside = np.array([[axis[-1]] for axis in axes])
    np.testing.assert_allclose(made.at(10.0, inside)[0], made.at(55.0, inside + 100.0)[0])
    assert not made.at(55.0, inside)[1].any()
    assert not made.at(-1.0, inside)[1].any()


def test_a_flow_adds_it_to_its_waves_and_current():
    made, _, axes = field()
    place = np.array([[0.0], [0.0], [axes[2][1]]])
    flow = Flow(velocity=(0.5, 0.0, 0.0), field=made)
    assert not flow.steady
    assert flow.update_interval == pytest.approx(0.1)
    found = flow.at(2.0, place)
    np.testing.assert_allclose(found[:3], made.at(2.0, place)[0] + np.array([[0.5], [0.0], [0.0]]))
    np.testing.assert_allclose(found[3:6], made.at(2.0, place)[1])


def test_what_does_not_rise_or_fit_is_refused():
    one = np.zeros(1)
    with pytest.raises(InputError, match="time of the current does not rise"):
        CurrentField(np.array([1.0, 1.0]), one, one, one, np.zeros((2, 1, 1, 1, 3)))
    with pytest.raises(InputError, match="have the shape"):
        CurrentField(np.array([0.0, 1.0]), one, one, one, np.zeros((1, 1, 1, 1, 3)))
