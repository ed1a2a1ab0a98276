"""Theory of regular waves: what is chosen, and the water that a network feels in it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.flexible.flow import Flow
from moyai.sea import Water, nonlinear_wave
from moyai.sea.regular_theory import harmonics_of, linear_limit, regular_wave, theory_of

SHALLOW = Water(depth=6.0, density=1025.0, gravity=9.81)
DEEP = Water(depth=80.0, density=1025.0, gravity=9.81)


def test_automatic_takes_linear_waves_where_they_are_enough():
    assert theory_of("automatic", 0.1, 6.0, DEEP) == "linear"
    assert theory_of("automatic", 1.5, 8.0, SHALLOW) == "stream_function"
    assert theory_of("linear", 1.5, 8.0, SHALLOW) == "linear"


@pytest.mark.parametrize("along", [0.0, 0.6, -0.4])
def test_harmonics_are_the_elevation_of_the_wave(along):
    wave = nonlinear_wave(
        "stream_function", height=2.0, water=SHALLOW, period=7.0, heading=0.4, current_along_wave=along
    )
    time, x, y = np.linspace(0.0, 14.0, 61), np.array([0.0, 3.0, -11.0]), np.array([0.0, 5.0, 2.0])
    assert np.allclose(harmonics_of(wave).elevation(time, x, y), wave.elevation(time, x, y), atol=1e-12)
    assert harmonics_of(wave).elevation(0.0) > 0.55 * wave.height


def test_nodes_feel_the_stream_function_on_top_of_the_current():
    parts, steep = regular_wave("automatic", 2.0, 7.0, 0.3, SHALLOW, 0.5)
    assert steep is not None
    flow = Flow(velocity=(0.5 * math.cos(0.3), 0.5 * math.sin(0.3), 0.0), waves=parts, steep=steep)
    place = np.array([[0.0, 4.0, -7.0], [1.0, 0.0, 3.0], [-5.5, -2.0, 0.4]])
    for now in (0.0, 1.3, 5.9):
        water = flow.at(now, place)
        assert np.allclose(water[:3].T, steep.velocity(now, *place), atol=1e-12)
        assert np.allclose(water[3:6].T, steep.acceleration(now, *place), atol=1e-12)
        assert np.allclose(water[6], steep.elevation(now, place[0], place[1]), atol=1e-12)


def test_a_low_wave_is_the_linear_one_in_either_theory():
    linear = Flow(waves=regular_wave("linear", 1e-4, 5.0, 0.0, SHALLOW)[0])
    parts, steep = regular_wave("stream_function", 1e-4, 5.0, 0.0, SHALLOW)
    exact = Flow(waves=parts, steep=steep)
    place = np.array([[0.0, 2.0, 5.0], [0.0, 0.0, 0.0], [-1.0, -3.0, -5.0]])
    for now in (0.2, 2.1):
        assert np.allclose(exact.at(now, place), linear.at(now, place), atol=2e-8)


def test_a_linear_wave_beyond_a_tenth_is_an_error_on_a_current_as_well():
    parts, _ = regular_wave("linear", 1.5, 8.0, 0.0, SHALLOW, 0.4)
    (notice,) = linear_limit("swell", parts, "use automatic")
    assert notice.severity == "error"
    assert notice.value > 0.1
    assert notice.message.startswith("swell: linear theory neglects harmonics")
    assert linear_limit("ripple", regular_wave("linear", 0.05, 5.0, 0.0, DEEP)[0], "") == []
