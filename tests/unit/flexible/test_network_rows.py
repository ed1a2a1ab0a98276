"""Coarse rows of the result must not make the run itself coarse, nor lose what happens between them."""

import numpy as np
import pytest

from moyai.flexible.build import NetworkBuilder
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import BarType
from moyai.flexible.simulate import simulate
from moyai.flexible.snap import find_snaps
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water

ROPE = BarType("rope", 1.0, 1e5, 0.06, viscosity=3e2, drag_normal=1.2, added_mass_normal=1.0)


@pytest.mark.parametrize(("duration", "output_step"), [(40.0, 20.0), (200.0, 0.5)])
def test_a_rising_line_stops_at_the_surface(duration, output_step):
    builder = NetworkBuilder(Water(50.0, 1025.0, 9.81))
    builder.free("one", (0.0, 0.0, -20.0))
    builder.free("two", (5.0, 0.0, -20.0))
    builder.line("rope", "one", "two", ROPE, length=5.0, segments=10, shape="straight")
    history = simulate(builder.build(), duration=duration, output_step=output_step)
    # Archimedes: the immersed part of its thickness, linear over the diameter, carries its mass
    level = (0.5 - ROPE.mass_per_length / (1025.0 * ROPE.volume_per_length)) * ROPE.diameter
    assert history.position[-1, :, 2] == pytest.approx(level, abs=3e-3)
    assert history.position[:, :, 2].max() < 0.05


def test_a_line_drawn_out_of_the_water_weighs_as_in_air():
    builder = NetworkBuilder(Water(50.0, 1025.0, 9.81))
    builder.driven("top", (0.0, 0.0, -30.0))
    builder.free("stone", (0.0, 0.0, -40.0), mass=50.0)
    builder.line("rope", "top", "stone", ROPE, length=10.0, segments=10, shape="straight")
    motion = Motion.from_function(
        lambda t: np.stack([0.0 * t, 0.0 * t, 45.0 * (t / 20.0) ** 2 * (3.0 - t / 10.0)], axis=1),
        duration=20.0,
        step=0.01,
    )
    tension = [
        simulate(builder.build(), {"top": motion}, duration=20.0, output_step=rows).tension[-1] for rows in (0.1, 20.0)
    ]
    assert tension[1] == pytest.approx(tension[0], rel=1e-3)
    # the upper bar carries the stone and nine and a half metres of dry rope, all slowed down by 6 x 45 m / (20 s)^2
    assert tension[1][0] == pytest.approx((50.0 + 9.5) * (9.81 - 6.0 * 45.0 / 400.0), rel=3e-3)


@pytest.mark.parametrize("method", ["explicit", "tr_bdf2"])
def test_waves_do_not_depend_on_the_rows(method):
    water, omega = Water(20.0, 1025.0, 9.81), 2.0 * np.pi / 4.0
    builder = NetworkBuilder(water)
    builder.fixed("anchor", (0.0, 0.0, -20.0))
    builder.float_sphere(
        "float", (3.0, 0.0, -1.0), diameter=1.2, mass=300.0, drag_coefficient=0.6, added_mass_coefficient=0.5
    )
    builder.line("rope", "anchor", "float", ROPE, length=18.3, segments=4)
    network = builder.build()
    number = np.atleast_1d(wave_number(omega, 20.0, 9.81))
    waves = WaveComponents(np.array([omega]), np.array([0.8]), np.array([0.3]), np.zeros(1), number, water)
    start = solve_equilibrium(network).state
    runs = [
        simulate(network, duration=12.0, output_step=rows, flow=Flow(waves=waves), start=start, method=method)
        for rows in (0.08, 2.0)
    ]
    assert runs[1].tension_peak.max() == pytest.approx(runs[0].tension_peak.max(), rel=3e-3)
    assert runs[1].position[-1] == pytest.approx(runs[0].position[-1], abs=5e-3)


def test_a_snap_between_two_slack_rows_is_found():
    time = np.arange(0.0, 2.0, 0.1)
    tension, peaks = np.zeros_like(time), np.zeros_like(time)
    peaks[7] = 1000.0
    tension[13], peaks[13], peaks[14] = 50.0, 50.0, 800.0
    record = find_snaps(time, tension, slack_level=1.0, threshold=100.0, peaks=peaks)
    assert [contact.peak for contact in record.snaps] == [1000.0, 800.0]
    assert record.snaps[0].time == pytest.approx(0.6, abs=1e-3)
    assert record.slack_time == pytest.approx(1.9 - 0.1 - 0.2, abs=0.01)
