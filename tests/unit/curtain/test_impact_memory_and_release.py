"""Memory of the waves and the slack phase against ordinary differential equations and exact limits, random inputs."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.core.errors import ConvergenceError, InputError
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, peak_by_energy
from moyai.structures.curtain.impact.cycles import slack_sag
from moyai.structures.curtain.impact.kernels import spring, taut_shape
from moyai.structures.curtain.impact.memory import impact_with_memory, memory_impact
from moyai.structures.curtain.impact.release import slack_phase, snap_in_current
from moyai.structures.curtain.statics.closed_forms import solve_cable


def random_span(seed, **changed):
    rng = np.random.default_rng([seed, 31])
    depth = 10.0 ** rng.uniform(-1, 1)
    span = depth * rng.uniform(0.5, 5.0)
    numbers = {
        "span": span,
        "length": span * rng.uniform(1.02, 2.0),
        "draught": depth * rng.uniform(0.1, 0.9),
        "upper_stiffness": 10.0 ** rng.uniform(2, 5) * depth**2,
        "lower_stiffness": 10.0 ** rng.uniform(2, 5) * depth**2,
        "speed": rng.uniform(0.1, 0.5) * math.sqrt(depth),
        "water": Water(depth, rng.uniform(990, 1030), 9.81),
    }
    return Impact(**{**numbers, **changed})


@pytest.mark.parametrize("seed", range(4))
def test_no_memory_is_model_a(seed):
    impact = random_span(seed)
    exact = peak_by_energy(impact)
    found = memory_impact(impact, np.zeros(1200), exact.time / 400.0, impact.deep_mass)
    assert found.peak.tension == pytest.approx(exact.tension, rel=1e-6)
    assert found.peak.time == pytest.approx(exact.time, rel=1e-5)
    assert found.ratio == pytest.approx(1.0, rel=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_exponential_memory_is_a_third_state(seed):
    """K = a e^{-bt} makes the memory integral a state with z' = v - U - b z: no convolution in the reference."""
    rng = np.random.default_rng(seed)
    impact = random_span(seed)
    mass, exact = impact.deep_mass, peak_by_energy(impact)
    strength, decay = rng.uniform(0.2, 2.0) * mass / exact.time**2, rng.uniform(0.2, 3.0) / exact.time
    taut = taut_shape(impact.span_ratio)

    def rate(_t, y):
        load, _ = spring(y[0], impact.span, impact.span_ratio, taut, impact.stiffness)
        return y[1], (-load - strength * y[2]) / mass, y[1] - impact.speed - decay * y[2]

    def stop(_t, y):
        return y[1]

    stop.terminal = True
    other = solve_ivp(rate, (0, 9 * exact.time), (0, impact.speed, 0), "DOP853", rtol=1e-11, atol=1e-14, events=stop)
    step = exact.time / 400.0
    found = memory_impact(impact, strength * np.exp(-decay * step * np.arange(3000)), step, mass)
    assert found.peak.displacement == pytest.approx(other.y_events[0][0][0], rel=1e-6)
    assert found.peak.time == pytest.approx(other.t_events[0][0], rel=1e-5)
    assert found.ratio > 1.0
    assert found.step_error < 1e-4


def test_step_is_of_second_order():
    impact = random_span(2)
    exact = peak_by_energy(impact)
    kernel = 2.0 * impact.deep_mass / exact.time**2

    def error(steps):
        step = exact.time / steps
        return memory_impact(impact, kernel * np.exp(-np.arange(8 * steps) / steps), step, impact.deep_mass).step_error

    assert math.log2(error(50) / error(100)) == pytest.approx(2.0, abs=0.1)


def test_faster_rise_needs_no_memory():
    """The ratio falls to 1 as the cable stiffens; it depends on t sqrt(g/d) alone, so a scaled span has it too."""
    spans = [random_span(5, upper_stiffness=s, lower_stiffness=s) for s in (2e2, 2e4, 2e6)]
    ratios = [impact_with_memory(item).ratio for item in spans]
    assert ratios[0] > ratios[1] > ratios[2] > 1.0
    assert ratios[2] < 1.002
    small, scale = spans[0], 30.0
    large = Impact(
        small.span * scale,
        small.length * scale,
        small.draught * scale,
        small.upper_stiffness * scale**3,
        small.lower_stiffness * scale**3,
        small.speed * math.sqrt(scale),
        small.water.with_depth(small.water.depth * scale),
    )
    assert impact_with_memory(large).ratio == pytest.approx(ratios[0], rel=1e-9)


def test_kernel_that_is_too_short_is_refused():
    impact = random_span(1)
    with pytest.raises(ConvergenceError, match="kernel"):
        memory_impact(impact, np.zeros(50), peak_by_energy(impact).time / 400.0, impact.deep_mass)
    with pytest.raises(InputError, match="kernel"):
        memory_impact(impact, [0.0, math.nan, 0.0, 0.0, 0.0], 0.1, 1.0)
    with pytest.raises(InputError, match="time_step"):
        memory_impact(impact, np.zeros(50), 0.0, 1.0)


@pytest.mark.parametrize("seed", range(12))
def test_slack_phase_against_integration(seed):
    rng = np.random.default_rng([seed, 7])
    impact = random_span(seed)
    sag = slack_sag(impact)
    current = rng.choice([-1.0, 1.0]) * rng.uniform(0.05, 0.6)
    speed, place = current * rng.uniform(-3.0, 3.0), sag * rng.uniform(-0.99, 0.99)
    drag, mass = rng.uniform(0.5, 3.0), impact.deep_mass * rng.uniform(0.5, 2.0)
    decay = 0.5 * impact.water.density * drag * impact.draught / mass

    def rate(_t, y):
        return y[1], decay * (current - y[1]) * abs(current - y[1])

    def reached(_t, y):
        return abs(y[0]) - sag

    reached.terminal = True
    other = solve_ivp(
        rate, (0, 1e5), (place, speed), "DOP853", rtol=1e-11, atol=1e-13, events=reached, max_step=0.05 * sag
    )
    found = slack_phase(impact, drag_coefficient=drag, current=current, position=place, speed=speed, mass=mass)
    assert found.duration == pytest.approx(other.t_events[0][0], rel=1e-7)
    assert found.speed == pytest.approx(other.y_events[0][0][1], rel=1e-7, abs=1e-9)
    assert found.side == math.copysign(1.0, other.y_events[0][0][0])


def test_without_drag_the_release_speed_stays():
    impact = random_span(3)
    found = slack_phase(impact, drag_coefficient=0.0, current=0.0, position=0.0, speed=0.4)
    assert found.speed == 0.4
    assert found.duration == pytest.approx(slack_sag(impact) / 0.4, rel=1e-12)
    assert found.started(impact).speed == 0.4


@pytest.mark.parametrize("seed", range(4))
def test_snap_runs_from_release_to_plateau(seed):
    impact = random_span(seed, length=1.3, span=1.0, draught=0.2, water=Water(0.6, 1000.0, 9.81))
    given = {"drag_coefficient": 1.4, "current": 0.3, "position": -0.1, "speed": 0.0}
    snap, phase = snap_in_current(impact, **given, duration=120.0), slack_phase(impact, **given)
    assert snap.taut_time == pytest.approx(phase.duration, rel=1e-6)
    assert snap.motion.contacts[0].speed == pytest.approx(phase.speed, rel=1e-6)
    assert snap.plateau_tension == pytest.approx(
        float(solve_cable(1.0, 1.3, 0.5 * 1000.0 * 1.4 * 0.2 * 0.09, impact.stiffness).tension), rel=1e-12
    )
    assert not snap.notices
    assert snap.motion.tension[-1] == pytest.approx(snap.plateau_tension, rel=0.05)
    assert snap.peak_tension > snap.plateau_tension
    # stiff cables: the drag during the short rise hardly matters
    if impact.stiffness > 2e3:
        assert snap.impact_tension + snap.plateau_tension == pytest.approx(
            peak_by_energy(phase.started(impact)).tension, rel=0.15
        )


@pytest.mark.parametrize(
    ("changed", "word"),
    [
        ({"position": 9.0}, "taut there"),
        ({"drag_coefficient": -1.0}, "drag"),
        ({"current": math.nan}, "current"),
        ({"current": 0.0, "speed": 0.0}, "never"),
    ],
)
def test_bad_release_is_refused(changed, word):
    given = {"drag_coefficient": 1.2, "current": 0.3, "position": 0.0, "speed": 0.0} | changed
    impact = random_span(0, length=1.3, span=1.0)
    with pytest.raises(InputError, match=word):
        slack_phase(impact, **given)
    if word == "never":
        with pytest.raises(InputError):
            snap_in_current(impact, **given)


def test_cable_as_long_as_its_span_has_no_slack_phase():
    with pytest.raises(InputError, match="taut from the start"):
        slack_phase(random_span(0, length=1.0, span=1.0), drag_coefficient=1.2, current=0.3, position=0.0, speed=0.0)


def test_series_that_ends_before_the_cable_is_taut_is_refused():
    impact = random_span(0, length=1.3, span=1.0)
    with pytest.raises(InputError, match="duration"):
        snap_in_current(impact, drag_coefficient=1.2, current=0.3, position=0.0, speed=0.0, duration=0.1)
