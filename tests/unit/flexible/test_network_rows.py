"""Coarse rows of the result must not make the run itself coarse, nor lose what happens between them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.panels import NetPanels, PanelLaw
from moyai.flexible.refine import refined
from moyai.flexible.result import State
from moyai.flexible.sensitivity import peak_sensitivity
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.sea.components import WaveComponents
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.series.snaps import find_snaps

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


def _snatched(segments=8):
    """A slack rope in a vacuum that its top draws taut."""
    builder = NetworkBuilder(Water(math.inf, 1e-9, 9.81))
    builder.fixed("bottom", (0.0, 0.0, -100.0))
    builder.driven("top", (0.0, 0.0, -80.2))
    kind = BarType("rope", 2.0, 2e5, 0.03, viscosity=200.0)
    builder.line("rope", "bottom", "top", kind, length=20.0, segments=segments)
    return builder.build(), {"top": Motion.harmonic((0.0, 0.0, 0.8), 3.0, duration=4.0)}


def test_a_step_that_is_too_long_is_reported_even_when_the_run_ends():
    network, motions = _snatched()
    sound = simulate(network, motions, duration=3.0, output_step=0.05)
    assert not [notice for notice in sound.notices if notice.code == "step-not-stable"]
    bold = simulate(network, motions, duration=3.0, output_step=0.05, step=1.3 * sound.step)
    reported = [notice for notice in bold.notices if notice.code == "step-not-stable"]
    assert len(reported) == 1 and reported[0].severity == "warning" and reported[0].value > 1.0


def test_sensitivity_bears_a_step_given_by_hand():
    network, motions = _snatched()
    sound = simulate(network, motions, duration=1.5, output_step=0.05)
    free = peak_sensitivity(network, motions, bar=7, duration=1.5, output_step=0.05)
    hand = peak_sensitivity(network, motions, bar=7, duration=1.5, output_step=0.05, step=sound.step, keep_bars=[0])
    assert hand.peak == pytest.approx(free.peak, rel=1e-9)
    assert hand.double_mesh == pytest.approx(free.double_mesh, rel=0.02)
    assert hand.double_viscosity == pytest.approx(free.double_viscosity, rel=0.02)


def test_rows_that_whole_steps_do_not_fill_do_not_hide_a_wave_front():
    water = Water(math.inf, 1e-9, 1e-12)
    builder = NetworkBuilder(water)
    builder.fixed("end", (0.0, 0.0, -500.0))
    builder.free("mass", (10.0, 0.0, -500.0), mass=20.0)
    kind = BarType("string", 1.0, 1e4, 1e-9)
    builder.line("string", "end", "mass", kind, length=10.0, segments=50, shape="straight")
    network = builder.build()
    velocity = np.zeros((len(network.nodes), 3))
    velocity[network.point("mass"), 0] = 0.1
    start = State(0.0, network.nodes.position.copy(), velocity)
    codes = []
    for output_step in (0.004, 0.005):
        history = simulate(network, duration=0.3, output_step=output_step, start=start, safety=1.0, keep_bars=[0])
        codes.append([notice.code for notice in history.notices])
    assert codes == [[], ["wave-front"]]


def test_net_panels_and_rings_are_not_lost_on_a_finer_mesh():
    network, _ = _snatched()
    panels = NetPanels(np.array([[0, 1, 2, -1]]), (PanelLaw.tabulate("still", lambda a, s: (0.0 * a, 0.0 * a)),))
    with pytest.raises(InputError, match="not refined"):
        refined(replace(network, panels=panels), 2)


@pytest.mark.parametrize("heap", [(5.0, 0.0, -20.0), (60.0, 0.0, -1.0)])
def test_rest_is_found_from_nodes_that_all_lie_at_one_point(heap):
    def rest(shape):
        builder = NetworkBuilder(Water(60.0, 1025.0, 9.81))
        builder.fixed("one", (0.0, 0.0, -50.0))
        builder.fixed("two", (60.0, 0.0, -1.0))
        chain = BarType("chain", 50.0, 2e8, 0.08)
        builder.line("chain", "one", "two", chain, length=100.0, segments=30, shape=shape)
        return solve_equilibrium(builder.build())

    assert rest(np.tile(heap, (29, 1))).tension == pytest.approx(rest("catenary").tension, rel=1e-5)
