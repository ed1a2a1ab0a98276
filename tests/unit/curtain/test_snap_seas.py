"""Water over a skirt against quadrature of the wave kinematics; snaps in seas against other integration and limits."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.core.errors import InputError
from moyai.sea.components import WaveComponents
from moyai.sea.current import power_law
from moyai.sea.dispersion import wave_number
from moyai.sea.irregular import synthesise
from moyai.sea.spectra import jonswap
from moyai.sea.water import Water
from moyai.series.snap_statistics import fit_snaps
from moyai.structures.curtain.impact.cable import Impact, speed_factor
from moyai.structures.curtain.impact.cycles import simulate_in_flow, slack_sag, slack_taut_motion
from moyai.structures.curtain.impact.kernels import spring, taut_shape
from moyai.structures.curtain.snaps.events import compare_steps, snaps_in_sea, suggested_time_step
from moyai.structures.curtain.snaps.flow import SkirtFlow, depth_mean_factor, flow_over_skirt


def random_sea(seed, water, count=6):
    rng = np.random.default_rng([seed, 3])
    omega = rng.uniform(0.5, 2.0, count)
    number = wave_number(omega, water.depth, water.gravity)
    return WaveComponents(
        omega, rng.uniform(0.01, 0.2, count), rng.uniform(0, 6, count), rng.uniform(-3, 3, count), number, water
    )


def flume(stiffness=150.0, length=0.8):
    return Impact(0.7, length, 0.15, 0.5 * stiffness, 0.5 * stiffness, 0.3, Water(0.4, 1000.0, 9.81))


def curtain(stiffness):
    return Impact(20.0, 23.0, 5.0, 0.5 * stiffness, 0.5 * stiffness, 0.5, Water(20.0, 1025.0, 9.81))


def sea_flow(duration=1800.0, step=0.1, seed=3, height=1.5, current=0.2):
    water = Water(20.0, 1025.0, 9.81)
    sea = synthesise(jonswap(height, 6.0, 3.3), water, duration=duration, seed=seed, time_step=step)
    return flow_over_skirt(
        sea, water, draught=5.0, normal_heading=0.0, current=current, duration=duration, time_step=step,
        velocity="skirt_mean",
    )  # fmt: skip


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("velocity", ["skirt_mean", "surface", "wheeler"])
def test_flow_against_quadrature_of_the_kinematics(seed, velocity):
    rng = np.random.default_rng([seed, 5])
    water = Water(rng.uniform(4.0, 30.0), 1025.0, 9.81)
    sea, draught, normal = random_sea(seed, water), rng.uniform(1.0, 3.0), rng.uniform(-3, 3)
    current = power_law(0.3, 1.0 / 7.0, rng.uniform(-3, 3), water)
    found = flow_over_skirt(
        sea,
        water,
        draught=draught,
        normal_heading=normal,
        current=current,
        duration=10.0,
        time_step=0.5,
        velocity=velocity,
    )
    nodes, weights = np.polynomial.legendre.leggauss(24)
    for n in (0, 7, 20):
        time = found.time[n]
        eta = float(sea.elevation(time))
        assert found.elevation[n] == pytest.approx(eta, rel=1e-9)
        if velocity == "surface":
            z, share, kind = np.zeros(1), np.ones(1), "constant"
            steady = current.velocity(0.0)
        else:
            top = eta if velocity == "wheeler" else 0.0
            z, share = top - 0.5 * draught * (1.0 - nodes), 0.5 * weights
            kind = "wheeler" if velocity == "wheeler" else "constant"
            steady = current.depth_mean(-draught, 0.0)
        _, speed, rate = sea.kinematics(float(time), 0.0, 0.0, z, kind)
        direction = np.array([math.cos(normal), math.sin(normal)])
        assert found.speed[n] == pytest.approx(float(share @ (speed[:, :2] @ direction) + steady @ direction), abs=2e-6)
        assert found.acceleration[n] == pytest.approx(float(share @ (rate[:, :2] @ direction)), abs=4e-6)


def test_wheeler_in_deep_water_is_the_mean_over_the_still_skirt():
    water = Water(math.inf, 1025.0, 9.81)
    sea = random_sea(1, water)
    options = {"draught": 3.0, "normal_heading": 0.3, "current": 0.1, "duration": 20.0, "time_step": 0.1}
    one = flow_over_skirt(sea, water, velocity="wheeler", **options)
    two = flow_over_skirt(sea, water, velocity="skirt_mean", **options)
    np.testing.assert_array_equal(one.speed, two.speed)


def test_oblique_crests_are_averaged_along_the_span():
    water = Water(12.0, 1025.0, 9.81)
    sea = random_sea(2, water)
    options = {"draught": 3.0, "normal_heading": 0.4, "current": 0.0, "duration": 5.0, "time_step": 0.5}
    found = flow_over_skirt(sea, water, velocity="skirt_mean", span=18.0, **options)
    nodes, weights = np.polynomial.legendre.leggauss(30)
    place, factor = 9.0 * nodes, depth_mean_factor(sea.wave_number, 3.0, water)
    toward = sea.omega * factor * np.cos(sea.heading - 0.4)
    # the curtain runs square to its normal
    travel = sea.travel(-place * math.sin(0.4), place * math.cos(0.4))
    mean = 0.5 * np.einsum("p,tp->t", weights, sea.respond(travel * toward, found.time))
    assert found.speed == pytest.approx(mean, abs=1e-9)


def test_waves_along_the_curtain_move_nothing():
    water = Water(20.0, 1025.0, 9.81)
    sea = synthesise(jonswap(1.5, 6.0, 3.3), water, duration=300.0, seed=1, time_step=0.1, heading=math.pi / 2)
    options = {"draught": 5.0, "current": 0.0, "duration": 300.0, "time_step": 0.1, "velocity": "skirt_mean"}
    along = flow_over_skirt(sea, water, normal_heading=0.0, **options)
    square = flow_over_skirt(sea, water, normal_heading=math.pi / 2, **options)
    against = flow_over_skirt(sea, water, normal_heading=-math.pi / 2, **options)
    assert np.abs(along.speed).max() < 1e-12
    assert against.speed == pytest.approx(-square.speed, abs=1e-12)


def reference_contacts(impact, drag_coefficient, current, amplitude, period, duration):
    """Contacts by an integrator of eighth order that stops at every corner of the spring."""
    sag, taut, mass = slack_sag(impact), taut_shape(impact.span_ratio), impact.deep_mass
    drag, omega = 0.5 * impact.water.density * drag_coefficient * impact.draught, 2 * math.pi / period

    def rate(side):
        def right(t, y):
            slip = current + amplitude * math.sin(omega * t) - y[1]
            value = amplitude * omega * math.cos(omega * t) + drag * slip * abs(slip) / mass
            if side:
                value -= (
                    side * spring(side * y[0] - sag, impact.span, impact.span_ratio, taut, impact.stiffness)[0] / mass
                )
            return y[1], value

        return right

    def event(function, direction, terminal=True):
        function.direction, function.terminal = direction, terminal
        return function

    time, state, rows = 0.0, np.zeros(2), []
    while True:
        events = (event(lambda _t, y: y[0] - sag, 1), event(lambda _t, y: -y[0] - sag, 1))
        found = solve_ivp(
            rate(0), (time, duration), state, "DOP853", rtol=1e-10, atol=1e-12, events=events, max_step=period / 50
        )
        if found.status != 1:
            return np.array(rows)
        time, state, side = found.t[-1], found.y[:, -1], 1 if found.y[0, -1] > 0 else -1
        state[0] = side * sag
        begin = (time, state[1])
        events = (event(lambda _t, y: side * y[0] - sag, -1), event(lambda _t, y: side * y[1], -1, terminal=False))  # noqa: B023
        found = solve_ivp(
            rate(side), (time, duration), state, "DOP853", rtol=1e-10, atol=1e-12, events=events, max_step=period / 50
        )
        if found.status != 1:
            return np.array(rows)
        tops = [
            spring(side * y[0] - sag, impact.span, impact.span_ratio, taut, impact.stiffness)[1]
            for y in found.y_events[1]
        ]
        rows.append((*begin, max(tops)))
        time, state = found.t[-1], found.y[:, -1]
        state[0] = side * sag


@pytest.mark.parametrize("seed", range(3))
def test_contacts_against_an_integrator_of_eighth_order(seed):
    rng = np.random.default_rng([seed, 11])
    impact = flume(10.0 ** rng.uniform(2, 3.5), rng.uniform(0.72, 0.9))
    period, current, drag = rng.uniform(1.2, 5.0), rng.uniform(-0.1, 0.1), rng.uniform(1.0, 2.0)
    amplitude = rng.uniform(2.2, 4.0) * slack_sag(impact) * math.pi / period
    other = reference_contacts(impact, drag, current, amplitude, period, 6 * period)
    found = slack_taut_motion(
        impact, drag_coefficient=drag, current=current, velocity_amplitude=amplitude, period=period, duration=6 * period
    )
    mine = np.array([(item.time, item.speed, item.tension) for item in found.contacts])[: len(other)]
    assert len(other) >= 8
    assert mine == pytest.approx(other, rel=2e-5)


def test_contacts_converge_at_fourth_order():
    impact, period = flume(600.0), 2.0
    tensions = []
    for parts in (40, 80, 160, 1600):
        step = period / parts
        time = step * np.arange(round(5.7 * period / step) + 1)
        flow = np.stack([np.sin(math.pi * time), math.pi * np.cos(math.pi * time)], axis=1)
        found = simulate_in_flow(impact, 1.2, flow, step, (0.0, 0.0), taut_step=4.0 * step * 0.05)
        tensions.append(np.array([item.time for item in found.contacts][:6]))
    errors = [float(np.abs(item - tensions[-1]).max()) for item in tensions[:-1]]
    assert math.log2(errors[0] / errors[2]) / 2.0 > 3.5


def test_short_contact_between_two_samples_is_found():
    """Excursion just beyond the slack: a contact much shorter than the step of the flow."""
    impact = flume(39000.0)
    period, drag = 4.0, 0.0
    amplitude = 1.0002 * slack_sag(impact) * math.pi / period
    step = period / 40.0
    time = step * np.arange(37)
    flow = np.stack(
        [2 * amplitude * np.sin(math.pi * time / 2), math.pi * amplitude * np.cos(math.pi * time / 2)], axis=1
    )
    found = simulate_in_flow(impact, drag, flow, step, (-slack_sag(impact) * 0.9999, 0.0))
    # without drag the skirt moves with the water until it touches: at the end of its half cycle
    assert len(found.contacts) >= 1
    assert found.contacts[0].time == pytest.approx(0.5 * period, rel=0.55)


@pytest.mark.slow
def test_peak_over_closed_form_depends_on_amplitude_at_short_periods():
    """T = 1.5 s: 0.79 to 0.84 at excursions of 0.35 to 0.38 m, 0.90 and 0.95 at 0.477 and 0.573 m: no single number."""
    impact = flume()
    scale = float(speed_factor(impact.span_ratio)) * math.sqrt(impact.deep_mass * impact.stiffness)
    ratios = []
    for excursion in (0.35, 0.38, 0.477, 0.573):
        found = slack_taut_motion(
            impact,
            drag_coefficient=1.2,
            current=0.0,
            velocity_amplitude=excursion * math.pi / 1.5,
            period=1.5,
            duration=30.0,
        )
        late = [item for item in found.contacts if item.first and item.time > 20.0]
        ratios.append(np.mean([item.tension / abs(item.speed) for item in late]) / scale)
        other = reference_contacts(impact, 1.2, 0.0, excursion * math.pi / 1.5, 1.5, 24.0)[-4:]
        assert ratios[-1] == pytest.approx(np.mean(other[:, 2] / abs(other[:, 1])) / scale, rel=1e-3)
    assert 0.79 < ratios[0] < ratios[1] < 0.84
    assert ratios[2:] == pytest.approx([0.902, 0.948], abs=2e-3)


@pytest.mark.parametrize(("period", "excursion"), [(4.0, 0.477), (4.0, 0.573), (8.0, 0.477), (8.0, 0.573)])
def test_first_contacts_of_a_stiff_cable(period, excursion):
    """EA = 5000 N: first contacts of each half cycle within 0.95 to 1.03; bounces are distinguished."""
    impact = flume(5000.0)
    found = slack_taut_motion(
        impact, drag_coefficient=1.2, current=0.0, velocity_amplitude=excursion * math.pi / period, period=period,
        duration=20 * period,
    )  # fmt: skip
    scale = float(speed_factor(impact.span_ratio)) * math.sqrt(impact.deep_mass * impact.stiffness)
    late = [item for item in found.contacts if item.time > 2 * period]
    first = [item.tension / abs(item.speed) / scale for item in late if item.first]
    assert 0.95 < min(first) <= max(first) < 1.03
    assert sum(item.first for item in late) == pytest.approx(36, abs=1)


def test_half_waves_on_a_taut_side_count_as_first():
    """In a strong current the curtain stays downstream: every wave brings one first contact, not one for ever."""
    impact = flume(600.0)
    found = slack_taut_motion(
        impact, drag_coefficient=1.2, current=0.3, velocity_amplitude=0.35, period=3.0, duration=60.0
    )
    late = [item for item in found.contacts if item.time > 15.0]
    assert {item.side for item in late} == {1}
    assert sum(item.first for item in late) == pytest.approx(15, abs=1)


def test_sea_of_one_component_is_the_regular_wave():
    water = Water(20.0, 1025.0, 9.81)
    omega = 2 * math.pi / 6.0
    number = wave_number(np.array([omega]), 20.0, 9.81)
    # cos(pi/2 - omega t) = sin(omega t)
    sea = WaveComponents([omega], [0.8], [0.5 * math.pi], [0.0], number, water)
    flow = flow_over_skirt(
        sea, water, draught=5.0, normal_heading=0.0, current=0.1, duration=120.0, time_step=0.02, velocity="skirt_mean"
    )
    amplitude = 0.8 * omega * float(depth_mean_factor(number, 5.0, water)[0])
    impact = curtain(1e6)
    found = snaps_in_sea(impact, flow, drag_coefficient=1.2, slowest=0.0, transient=0.0, start=(0.0, 0.0))
    regular = slack_taut_motion(
        impact, drag_coefficient=1.2, current=0.1, velocity_amplitude=amplitude, period=6.0, duration=120.0
    )
    assert flow.speed.max() == pytest.approx(0.1 + amplitude, rel=1e-4)
    assert [item.tension for item in regular.contacts] == pytest.approx(list(found.tension), rel=1e-4)


def test_snaps_of_a_sea_are_the_contacts_that_count():
    flow, impact = sea_flow(), curtain(1e6)
    found = snaps_in_sea(impact, flow, drag_coefficient=1.2, slowest=0.2, transient=60.0)
    assert found.time.min() >= 60.0
    assert found.hours == pytest.approx((1800.0 - 60.0) / 3600.0, rel=1e-3)
    assert found.counted.sum() == found.snap_tension.size > 30
    assert found.speed[found.counted].min() >= 0.2
    assert found.snaps_per_hour == pytest.approx(found.snap_tension.size / found.hours)
    assert 0.0 < found.taut_share < 1.0
    assert np.all(found.rise_time > 0.0)
    same = snaps_in_sea(impact, flow, drag_coefficient=1.2, slowest=0.2, transient=60.0)
    np.testing.assert_array_equal(found.tension, same.tension)


def test_steps_of_a_sea_are_fine_enough():
    impact = curtain(1e6)
    step = suggested_time_step(6.0)
    water = Water(20.0, 1025.0, 9.81)
    sea = synthesise(jonswap(1.5, 6.0, 3.3), water, duration=900.0, seed=5, time_step=step)
    runs = []
    for part in (1, 4):
        flow = flow_over_skirt(
            sea, water, draught=5.0, normal_heading=0.0, current=0.2, duration=900.0, time_step=step / part,
            velocity="skirt_mean",
        )  # fmt: skip
        runs.append(snaps_in_sea(impact, flow, drag_coefficient=1.2, slowest=0.2, transient=60.0))
    found = compare_steps(*runs)
    assert abs(found.count_change) <= 1
    assert abs(found.largest_change) < 2e-4
    assert abs(found.mean_change) < 5e-3
    assert found.parted > 300.0


@pytest.mark.slow
def test_bounces_of_a_stiff_cable_part_the_paths_but_not_the_statistics():
    """Fourth-order steps delay the parting by little each time they are halved; law and rate of the snaps stay."""
    impact, step = curtain(4e6), suggested_time_step(6.0)
    water = Water(20.0, 1025.0, 9.81)
    changes = []
    for seed in range(11, 19):
        sea = synthesise(jonswap(2.0, 6.0, 3.3), water, duration=10800.0, seed=seed, time_step=step)
        runs = []
        for part in (1, 2, 4):
            flow = flow_over_skirt(
                sea, water, draught=5.0, normal_heading=0.0, current=0.3, duration=10800.0, time_step=step / part,
                velocity="skirt_mean",
            )  # fmt: skip
            runs.append(snaps_in_sea(impact, flow, drag_coefficient=1.2, slowest=0.2, transient=60.0))
        coarse, fine = compare_steps(runs[0], runs[2]), compare_steps(runs[1], runs[2])
        changes.append([[one.count_change, one.mean_change] for one in (coarse, fine)])
    assert coarse.parted < fine.parted < 1000.0
    # eight seeds as samples of one law: 99.9 of 100 means are within Student's 5.4 standard errors of none
    error = np.std(changes, axis=0, ddof=1) / math.sqrt(len(changes))
    assert (np.abs(np.mean(changes, axis=0)) < 5.4 * error).all()
    assert (error[:, 1] < 0.03).all()
    laws = [
        fit_snaps(run.snap_tension, run.hours, threshold=float(np.median(runs[2].snap_tension)), resamples=100)
        for run in runs
    ]
    tops = [law.most_probable_maximum(24.0) for law in laws]
    assert all(one.lower < two.upper for one in tops for two in tops)


def test_sea_too_small_for_the_slack_says_so():
    water = Water(20.0, 1025.0, 9.81)
    flow = sea_flow(300.0, height=0.2, current=0.0)
    loose = Impact(20.0, 24.0, 5.0, 5e5, 5e5, 0.5, water)
    found = snaps_in_sea(loose, flow, drag_coefficient=1.2, slowest=0.2, transient=0.0)
    assert [notice.code for notice in found.notices] == ["snap-none"]
    assert found.snaps_per_hour == 0.0
    assert found.notices[0].value < found.notices[0].limit


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"draught": 25.0}, "draught"),
        ({"velocity": "mean"}, "wheeler"),
        ({"time_step": 0.0}, "time_step"),
        ({"duration": 0.2}, "four"),
        ({"current": math.nan}, "current"),
        ({"span": -1.0}, "span"),
    ],
)
def test_bad_flow_is_refused(change, word):
    water = Water(20.0, 1025.0, 9.81)
    given = {"draught": 5.0, "normal_heading": 0.0, "current": 0.0, "duration": 9.0, "time_step": 0.1}
    with pytest.raises(InputError, match=word):
        flow_over_skirt(random_sea(0, water), water, **(given | {"velocity": "skirt_mean"} | change))


def test_bad_runs_are_refused():
    flow = SkirtFlow(np.arange(5.0), np.zeros(5), np.zeros(5), np.zeros(5), 0.0)
    with pytest.raises(InputError, match="transient"):
        snaps_in_sea(curtain(1e6), flow, drag_coefficient=1.2, slowest=0.2, transient=4.0)
    with pytest.raises(InputError, match="slowest"):
        snaps_in_sea(curtain(1e6), flow, drag_coefficient=1.2, slowest=-0.2, transient=0.0)
    with pytest.raises(InputError, match="start"):
        simulate_in_flow(flume(), 1.2, np.zeros((5, 2)), 0.1, (math.nan, 0.0))
    with pytest.raises(InputError, match="flow"):
        simulate_in_flow(flume(), 1.2, np.zeros(5), 0.1, (0.0, 0.0))
