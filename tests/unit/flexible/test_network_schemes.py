"""Time integration of flexible networks: modes, pendulum, energy, orders, and one scheme against another."""

import math

import numpy as np
import pytest
from networks_for_tests import DEEP, NO_GRAVITY, rope, still
from scipy.special import ellipk

from moyai.core.errors import InputError
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import BarType
from moyai.flexible.flow import Flow
from moyai.flexible.modes import natural_modes
from moyai.flexible.motion import Motion
from moyai.flexible.result import State
from moyai.flexible.simulation import simulate
from moyai.flexible.statics import solve_equilibrium
from moyai.flexible.tableaus import TABLEAUS, order_residual
from moyai.sea.components import WaveComponents
from moyai.sea.water import Water

EARTH = Water(math.inf, 1000.0, 9.81)


def pendulum(stiffness=1e7, angle=1.0, length=2.0, mass=3.0):
    builder = NetworkBuilder(EARTH)
    builder.fixed("pivot", (0.0, 0.0, DEEP))
    builder.free("bob", (length * math.sin(angle), 0.0, DEEP - length * math.cos(angle)), mass=mass)
    builder.line("rod", "pivot", "bob", BarType("rod", 1e-9, stiffness, 1e-9), length=length, segments=1)
    return builder.build()


@pytest.mark.parametrize("angle", [0.1, 0.7, 1.4])
def test_pendulum_has_the_period_of_the_elliptic_integral(angle):
    length, mass = 2.0, 3.0
    network = pendulum(stiffness=1e6, angle=angle)
    exact = 4.0 * math.sqrt(length / 9.81) * ellipk(math.sin(angle / 2.0) ** 2)
    history = simulate(network, duration=3.2 * exact, output_step=exact / 400.0, keep_nodes=[1])
    x = history.position[:, 0, 0]
    falls = np.flatnonzero((x[:-1] > 0.0) & (x[1:] <= 0.0))
    when = history.time[falls] + x[falls] / (x[falls] - x[falls + 1]) * (history.time[1] - history.time[0])
    stretch = 3.0 * mass * 9.81 / 1e6
    assert np.diff(when) == pytest.approx(exact, rel=1e-4 + stretch)


def test_energy_of_smooth_motion_is_kept_for_a_hundred_periods():
    network = pendulum(stiffness=1e5, angle=1.0)
    period = 4.0 * math.sqrt(2.0 / 9.81) * ellipk(math.sin(0.5) ** 2)
    start = solve_equilibrium(network).state.position
    stretched = np.linalg.norm(start[1] - start[0])
    begin = State(
        0.0,
        np.array([[0, 0, DEEP], [stretched * math.sin(1.0), 0.0, DEEP - stretched * math.cos(1.0)]]),
        np.zeros((2, 3)),
    )
    history = simulate(network, duration=100.0 * period, output_step=period / 40.0, start=begin)
    swing = 3.0 * 9.81 * 2.0 * (1.0 - math.cos(1.0))
    assert np.max(np.abs(history.energy_balance)) < 1e-3 * swing


def test_energy_of_a_vibrating_string_is_kept_for_a_hundred_periods():
    network = rope(segments=40, span=(40.2, 0.0, 0.0))
    modes = natural_modes(network, State.at_rest(network), count=2)
    period = 2.0 * math.pi / modes.omega[0]
    begin = State.at_rest(network)
    begin.velocity[:, 1] = 0.3 * np.sin(math.pi * network.nodes.position[:, 0] / 40.2)
    begin.velocity[-1] = 0.0
    history = simulate(network, {"end": still()}, duration=100.0 * period, output_step=0.5 * period, start=begin)
    assert history.status == "converged"
    kinetic = 0.5 * float(network.node_mass @ np.sum(begin.velocity**2, axis=1))
    assert np.max(np.abs(history.energy_balance)) < 1e-3 * kinetic


def test_work_of_changing_loads_is_that_of_the_energy_that_leapfrog_keeps():
    """A tethered float without drag in waves: what the inertia of the water does is in the balance, at any step.

    Nothing damps it, so that the balance is zero but for the scheme, which is of second order. Booked at the places of
    the steps the balance would be of first order, here 1.4e-3 of the energy at 2 ms.
    """
    water = Water(50.0, 1025.0, 9.81)
    builder = NetworkBuilder(water)
    builder.fixed("anchor", (0.0, 0.0, -12.0))
    builder.free("float", (0.0, 0.0, -4.0), mass=60.0, volume=0.3, added_mass=250.0)
    builder.line("leg", "anchor", "float", BarType("rope", 0.5, 2e5, 0.01), length=7.9, segments=4)
    network = builder.build()
    start = solve_equilibrium(network).state
    omega, number = 1.1, 1.1**2 / 9.81
    waves = WaveComponents(*(np.array([value]) for value in (omega, 0.8, 0.0, 0.0, number)), water)
    worst = []
    for step in (2e-3, 1e-3, 5e-4):
        history = simulate(network, flow=Flow(waves=waves), start=start, duration=40.0, output_step=0.1, step=step)
        total = history.kinetic_energy + history.elastic_energy
        assert np.ptp(total) > 100.0
        worst.append(float(np.max(np.abs(history.energy_balance))) / np.ptp(total))
    assert worst[0] < 1e-5
    assert np.log2(worst[0] / worst[1]) == pytest.approx(2.0, abs=0.1)
    assert np.log2(worst[1] / worst[2]) == pytest.approx(2.0, abs=0.1)


@pytest.mark.parametrize("segments", [40, 80])
def test_modes_of_a_taut_string(segments):
    length, stiffness, mass = 40.0, 1e6, 2.0
    network = rope(segments=segments, span=(40.2, 0.0, 0.0))
    pull = stiffness * 0.2 / length
    modes = natural_modes(network, State.at_rest(network), count=8)
    # in pairs; mass per present length
    speed = math.sqrt(pull / (mass * length / 40.2))
    exact = np.repeat(np.arange(1, 5) * math.pi * speed / 40.2, 2)
    assert modes.omega == pytest.approx(exact, rel=0.6 * (4.0 * math.pi / segments) ** 2 / 2.0)
    assert modes.omega[0] == pytest.approx(exact[0], rel=(math.pi / segments) ** 2 / 20.0)


def test_string_swings_with_its_first_mode():
    network = rope(segments=30, span=(40.2, 0.0, 0.0))
    omega = natural_modes(network, State.at_rest(network), count=1).omega[0]
    begin = State.at_rest(network)
    begin.velocity[:, 2] = 1e-3 * np.sin(math.pi * network.nodes.position[:, 0] / 40.2)
    begin.velocity[-1] = 0.0
    history = simulate(
        network, {"end": still()}, duration=12 * math.pi / omega, output_step=0.01 * math.pi / omega, start=begin
    )
    z = history.position[:, 15, 2] - DEEP
    rises = np.flatnonzero((z[:-1] < 0.0) & (z[1:] >= 0.0))
    when = history.time[rises] - z[rises] / (z[rises + 1] - z[rises]) * (history.time[1] - history.time[0])
    assert np.diff(when) == pytest.approx(2.0 * math.pi / omega, rel=1e-4)


def test_modes_of_a_hanging_chain():
    """Zeros of J0 over 2, times sqrt(g/L) (Bernoulli)."""
    builder = NetworkBuilder(EARTH)
    builder.fixed("top", (0.0, 0.0, DEEP))
    builder.free("end", (0.0, 0.0, DEEP - 10.0))
    builder.line("chain", "top", "end", BarType("chain", 4.0, 1e9, 1e-9), length=10.0, segments=200, shape="straight")
    network = builder.build()
    modes = natural_modes(network, solve_equilibrium(network).state, count=6)
    exact = np.repeat([2.404825557695773, 5.520078110286311, 8.653727912911013], 2) / 2.0 * math.sqrt(9.81 / 10.0)
    # second order in the mesh: a part of (mode number / segments)^2
    assert modes.omega == pytest.approx(exact, rel=5e-4)
    assert modes.omega[0] == pytest.approx(exact[0], rel=1e-4)


def test_coefficients_meet_their_order_conditions():
    for tableau in TABLEAUS.values():
        assert order_residual(tableau.stages, tableau.stages[-1], tableau.order) < 1e-14
        assert order_residual(tableau.stages, tableau.embedded, tableau.embedded_order) < 1e-14
        # stiffly accurate with an explicit first stage: stable at infinity when the last weights solve the stages
        s = len(tableau.embedded)
        inner = tableau.stages[1:, 1:]
        assert (
            abs(tableau.stages[-1, 0] - tableau.stages[-1, 1:] @ np.linalg.solve(inner, tableau.stages[1:, 0])) < 1e-12
            or s == 3
        )


@pytest.mark.parametrize(("method", "order"), [("explicit", 2), ("tr_bdf2", 2), ("esdirk4", 4)])
def test_order_of_accuracy(method, order):
    """A soft elastic pendulum with viscosity, always taut: the error falls with the declared order."""
    builder = NetworkBuilder(EARTH)
    builder.fixed("pivot", (0.0, 0.0, DEEP))
    builder.free("bob", (0.6, 0.0, DEEP - 2.1), mass=3.0)
    viscosity = 0.0 if method == "explicit" else 5.0
    builder.line(
        "band", "pivot", "bob", BarType("band", 1e-9, 300.0, 1e-9, viscosity=viscosity), length=2.0, segments=1
    )
    network = builder.build()

    def end(step):
        history = simulate(
            network, duration=1.6, output_step=0.1, step=step, method=method, load_steps=1, tolerance=1e-11
        )
        # a slack band would make a kink
        assert history.tension.min() > 1.0
        return history.final.position[1]

    steps = 0.1 / 2.0 ** np.arange(1, 5) if method != "explicit" else 0.02 / 2.0 ** np.arange(1, 5)
    reference = end(steps[-1] / 16.0) if method != "esdirk4" else end(steps[-1] / 4.0)
    errors = [np.linalg.norm(end(step) - reference) for step in steps[:3]]
    found = np.log2(np.array(errors[:-1]) / errors[1:])
    assert found[-1] == pytest.approx(order, abs=0.25)


def test_schemes_agree_on_a_rope_that_snaps():
    kind = {
        "stiffness": 1e6,
        "mass": 3.0,
        "viscosity": 2e3,
        "drag_normal": 1.2,
        "added_mass_normal": 1.0,
        "diameter": 0.04,
    }
    network = rope(segments=12, span=(39.5, 0.0, 0.0), water=Water(math.inf, 1025.0, 9.81), **kind)
    motion = {"end": Motion.harmonic((1.0, 0.0, 0.0), 3.0, duration=10.0, ramp=1.5)}
    begin = solve_equilibrium(network).state
    peaks = []
    for method in ("explicit", "tr_bdf2", "esdirk4"):
        history = simulate(network, motion, duration=7.5, output_step=0.02, start=begin, method=method, keep_bars=[11])
        assert history.status == "converged"
        peaks.append(float(history.tension_peak.max()))
    assert history.tension.min() < 100.0 < 5e3 < peaks[0]
    assert np.array(peaks[1:]) == pytest.approx(peaks[0], rel=5e-3)


def test_run_goes_on_from_its_final_state():
    network = rope(segments=10, span=(40.1, 0.0, 0.0))
    motion = {"end": Motion.harmonic((0.05, 0.1, 0.0), 1.0, duration=4.0, ramp=0.5)}
    whole = simulate(network, motion, duration=2.0, output_step=0.02)
    first = simulate(network, motion, duration=1.0, output_step=0.02)
    second = simulate(network, motion, duration=1.0, output_step=0.02, start=first.final)
    assert second.final.position == pytest.approx(whole.final.position, abs=2e-5)
    assert second.time[-1] == pytest.approx(2.0)


def test_interrupted_run_hands_back_its_rows():
    def stop(what, done, total):
        if done > 0.4:
            raise KeyboardInterrupt

    network = rope(segments=5)
    history = simulate(network, {"end": still()}, duration=1.0, output_step=0.05, progress=stop)
    assert history.status == "interrupted"
    assert 8 <= len(history.time) < 20
    assert np.isfinite(history.position).all()


def test_sinking_body_reaches_its_terminal_speed():
    water = Water(math.inf, 1025.0, 9.81)
    builder = NetworkBuilder(water)
    builder.free("weight", (0.0, 0.0, -100.0), mass=50.0, volume=0.01, drag_area=0.4, added_mass=5.0)
    network = builder.build()
    exact = math.sqrt(2.0 * (50.0 - 10.25) * 9.81 / (1025.0 * 0.4))
    for method in ("explicit", "tr_bdf2"):
        options = {"step": 0.01} if method == "explicit" else {}
        history = simulate(network, duration=8.0, output_step=0.1, method=method, **options)
        assert history.final.velocity[0, 2] == pytest.approx(-exact, rel=1e-3)


def test_rope_drifts_with_a_uniform_current():
    water = Water(math.inf, 1025.0, 9.81)
    builder = NetworkBuilder(water)
    density = 1025.0 * math.pi / 4.0 * 0.05**2
    builder.free("one", (0.0, 0.0, -50.0))
    builder.free("two", (0.0, 4.0, -50.0))
    kind = BarType("neutral", density, 1e4, 0.05, drag_normal=1.2, drag_tangential=0.05, added_mass_normal=1.0)
    builder.line("rope", "one", "two", kind, length=4.0, segments=4, shape="straight")
    history = simulate(builder.build(), duration=30.0, output_step=0.5, flow=Flow((0.7, 0.0, 0.0), ramp=1.0))
    assert history.final.velocity[:, 0] == pytest.approx(0.7, rel=0.02)


def test_sliding_node_stops_by_coulomb_friction():
    from moyai.flexible.bed import Bed

    builder = NetworkBuilder(Water(10.0, 1000.0, 9.81), Bed(-10.0, 1e5, 1e4, 0.4))
    builder.free("stone", (0.0, 0.0, -10.0), mass=20.0, contact_area=1.0)
    network = builder.build()
    rest = solve_equilibrium(network).state
    begin = State(0.0, rest.position, np.array([[2.0, 0.0, 0.0]]))
    history = simulate(network, duration=1.5, output_step=0.05, start=begin, step=1e-3)
    # v^2 / 2 mu g, in air as far as weight goes: no volume
    assert history.final.position[0, 0] == pytest.approx(2.0**2 / (2.0 * 0.4 * 9.81), rel=2e-3)
    assert history.final.velocity[0, 0] == pytest.approx(0.0, abs=1e-12)


def test_motion_outside_its_range_is_refused():
    network = rope(segments=3)
    with pytest.raises(InputError, match="covers 0 to 1 s"):
        simulate(network, {"end": Motion.harmonic((1, 0, 0), 1.0, duration=1.0)}, duration=2.0, output_step=0.1)
    with pytest.raises(InputError, match="not given"):
        simulate(network, {}, duration=2.0, output_step=0.1)
    with pytest.raises(InputError, match="no point follows"):
        simulate(network, {"end": still(), "top": still()}, duration=2.0, output_step=0.1)
    for wrong in ({"duration": -1.0}, {"output_step": 0.0}, {"method": "magic"}, {"safety": 0.0}, {"step": -1.0}):
        with pytest.raises(InputError):
            simulate(network, {"end": still()}, **{"duration": 1.0, "output_step": 0.1, **wrong})
    assert NO_GRAVITY.density > 0.0


@pytest.mark.parametrize("diameter", [0.6, 1.5])
def test_floating_sphere_bobs_at_its_natural_period(diameter):
    """Half immersed, small motion: omega^2 = rho g (waterplane) / (mass + added mass)."""
    water = Water(math.inf, 1025.0, 9.81)
    volume = math.pi / 6.0 * diameter**3
    mass = 0.5 * 1025.0 * volume
    builder = NetworkBuilder(water)
    builder.float_sphere(
        "buoy",
        (0.0, 0.0, 0.01 * diameter),
        diameter=diameter,
        mass=mass,
        drag_coefficient=0.0,
        added_mass_coefficient=0.5,
    )
    # the wet part of the added mass is half of it
    omega = math.sqrt(1025.0 * 9.81 * math.pi / 4.0 * diameter**2 / (mass + 0.25 * 1025.0 * volume))
    for method in ("explicit", "esdirk4"):
        history = simulate(builder.build(), duration=20.0 / omega, output_step=0.01 / omega, method=method)
        z = history.position[:, 0, 2]
        rises = np.flatnonzero((z[:-1] < 0.0) & (z[1:] >= 0.0))
        when = history.time[rises] - z[rises] / (z[rises + 1] - z[rises]) * (history.time[1] - history.time[0])
        assert np.diff(when) == pytest.approx(2.0 * math.pi / omega, rel=2e-3)
        assert np.max(np.abs(z)) == pytest.approx(0.01 * diameter, rel=0.02)


def test_small_float_rides_long_waves():
    """A light float without line follows the surface of long waves and the orbit of the water."""
    from moyai.sea.dispersion import wave_number
    from moyai.sea.irregular import WaveComponents

    water = Water(30.0, 1025.0, 9.81)
    omega, amplitude = 0.7, 0.5
    number = float(wave_number(omega, 30.0, 9.81))
    sea = WaveComponents([omega], [amplitude], [0.0], [0.0], [number], water)
    builder = NetworkBuilder(water)
    volume = math.pi / 6.0 * 0.5**3
    builder.float_sphere(
        "float",
        (0.0, 0.0, 0.0),
        diameter=0.5,
        mass=0.5 * 1025.0 * volume,
        drag_coefficient=0.6,
        added_mass_coefficient=0.5,
    )
    network = builder.build()
    results = []
    for method in ("explicit", "tr_bdf2"):
        history = simulate(network, duration=40.0, output_step=0.05, flow=Flow(waves=sea, ramp=9.0), method=method)
        assert history.status == "converged"
        late = history.time > 20.0
        x, z = history.position[late, 0, 0], history.position[late, 0, 2]
        surface = amplitude * np.cos(number * x - omega * history.time[late])
        assert z == pytest.approx(surface, abs=0.04 * amplitude)
        results.append(z)
    assert results[1] == pytest.approx(results[0], abs=0.01 * amplitude)


def test_wave_front_is_reported():
    builder = NetworkBuilder(NO_GRAVITY)
    builder.fixed("wall", (0.0, 0.0, DEEP))
    builder.free("mass", (50.0, 0.0, DEEP), mass=300.0)
    builder.line("string", "wall", "mass", BarType("string", 3.0, 2e7, 1e-9), length=50.0, segments=50)
    network = builder.build()
    velocity = np.zeros((51, 3))
    velocity[network.point("mass"), 0] = 1.0
    start = State(0.0, np.array(network.nodes.position), velocity)
    travel = 50.0 / math.sqrt(2e7 / 3.0)
    usual = simulate(network, duration=4.0 * travel, output_step=travel / 10.0, start=start)
    paced = simulate(network, duration=4.0 * travel, output_step=travel / 10.0, start=start, safety=1.0)
    assert [notice.code for notice in usual.notices] == ["wave-front"]
    assert not paced.notices


@pytest.mark.parametrize("share", [-0.5, 0.0, 0.5, 0.9])
def test_modes_of_a_pressed_column(share):
    """Pin-ended: the first frequency falls as the root of one less the push over Euler's load."""
    length, bending, mass, stiffness, count = 8.0, 900.0, 3.0, 1e7, 40
    load = share * bending * (math.pi / length) ** 2
    builder = NetworkBuilder(NO_GRAVITY)
    builder.fixed("low", (0.0, 0.0, DEEP))
    builder.fixed("high", (0.0, 0.0, DEEP + length * (1.0 - load / stiffness)))
    kind = BarType("rod", mass, stiffness, 1e-9, bending_stiffness=bending, tension_only=False)
    builder.line("rod", "low", "high", kind, length=length, segments=count, shape="straight")
    network = builder.build()
    omega = natural_modes(network, State.at_rest(network), count=2).omega
    exact = (math.pi / length) ** 2 * math.sqrt(bending / mass * (1.0 - share))
    assert omega == pytest.approx(exact, rel=4e-3)
