"""Lines that displace water without a diameter, and runs of which every step is shorter."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible import BarType, NetworkBuilder, State, simulate
from moyai.sea import Water

GRAVITY, DENSITY = 9.81, 1000.0


def floating(mass: float, volume: float, level: float, scale: float = 1.0):
    """Two free ends of a level line that weighs half of what it lifts, or all of it."""
    builder = NetworkBuilder(Water(100.0, DENSITY, GRAVITY))
    rope = BarType("rope", mass * scale**2, 1e6 * scale**3, 0.0, volume_per_length=volume * scale**2)
    builder.free("left", (0.0, 0.0, level * scale))
    builder.free("right", (2.0 * scale, 0.0, level * scale))
    builder.line("span", "left", "right", rope, length=2.0 * scale, segments=1)
    return builder.build()


def test_a_floating_line_bobs_over_the_circle_of_its_volume() -> None:
    """Half immersed it bobs at (rho g V / (2 r m))^1/2, r the radius of its volume [eq:flexible-immersion]."""
    volume, mass = 2e-3, 1.0
    radius = math.sqrt(volume / math.pi)
    period = 2.0 * math.pi / math.sqrt(DENSITY * GRAVITY * volume / (2.0 * radius * mass))
    network = floating(mass, volume, 0.0)
    start = State.at_rest(network)
    start.position[:, 2] = 0.2 * radius
    more = {"step": period / 4000.0, "load_steps": 1}
    history = simulate(network, duration=period, output_step=period / 40.0, start=start, **more)
    expected = 0.2 * radius * np.cos(2.0 * np.pi * history.time / period)
    assert np.abs(history.position[:, 0, 2] - expected).max() < 0.002 * radius


def test_steps_keep_froude_scale_where_a_line_without_diameter_comes_near_the_surface() -> None:
    """4.4 m down and, in a model of 1:16, 0.275 m: the same run, a quarter of the time."""
    large, small = (
        simulate(floating(2.0, 2e-3, -4.4, scale), duration=0.5 * scale**0.5, output_step=0.1 * scale**0.5)
        for scale in (1.0, 1.0 / 16.0)
    )
    assert large.steps == small.steps
    assert small.step == pytest.approx(0.25 * large.step, rel=1e-9)


def test_every_step_of_a_shorter_run_is_shorter() -> None:
    """Drag shortens the first steps of a line let go at 30 m/s to a small part of the others."""
    builder = NetworkBuilder(Water(100.0, DENSITY, GRAVITY))
    rope = BarType("rope", 1.0, 1e4, 0.03, drag_normal=1.2)
    builder.free("left", (0.0, 0.0, -20.0))
    builder.free("right", (2.0, 0.0, -20.0))
    builder.line("span", "left", "right", rope, length=2.0, segments=4)
    network = builder.build()
    start = State.at_rest(network)
    start.velocity[:, 1] = 30.0
    given = {"duration": 4.0, "output_step": 0.02, "start": start}
    whole, half = simulate(network, **given), simulate(network, **given, shorter=0.5)
    assert 4.0 / whole.step > 2.0 * whole.steps
    assert 1.8 * whole.steps < half.steps < 2.2 * whole.steps
    assert half.step == pytest.approx(0.5 * whole.step, rel=0.2)
    with pytest.raises(InputError, match="shorter is 2"):
        simulate(network, **given, shorter=2.0)
