"""Impact models against energy, similarity, limits and independent integration, at random inputs."""

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from moyai.core.errors import InputError
from moyai.sea.water import Water
from moyai.structures.curtain.impact.added_mass import arc_skirt_mass, flat_skirt_mass
from moyai.structures.curtain.impact.cable import (
    Impact,
    check_impact,
    closed_form,
    edge_impact,
    impact_numbers,
    peak_by_energy,
    speed_factor,
    sweep_peaks,
)
from moyai.structures.curtain.impact.compare import compare_models
from moyai.structures.curtain.impact.cycles import slack_taut_motion
from moyai.structures.curtain.impact.kernels import spring, taut_shape
from moyai.structures.curtain.impact.march import march_impact
from moyai.structures.curtain.impact.skirt import BulgedSkirt, cable_and_skirt_impact, skirt_impact


def random_impact(seed, **changed):
    rng = np.random.default_rng(seed)
    depth = 10.0 ** rng.uniform(-1, 1)
    span = depth * rng.uniform(0.5, 5.0)
    numbers = {
        "span": span,
        "length": span * rng.uniform(1.02, 2.0),
        "draught": depth * rng.uniform(0.1, 0.9),
        "upper_stiffness": 10.0 ** rng.uniform(1, 5) * depth**2,
        "lower_stiffness": 10.0 ** rng.uniform(1, 5) * depth**2,
        "speed": rng.uniform(0.05, 0.5) * math.sqrt(depth),
        "water": Water(depth, rng.uniform(990, 1030), 9.81),
    }
    return Impact(**{**numbers, **changed})


@pytest.mark.parametrize("seed", range(6))
def test_energy_form_against_integration_in_time(seed):
    impact = random_impact(seed)
    peak = peak_by_energy(impact)
    taut = taut_shape(impact.span_ratio)

    def rate(_t, y):
        return y[1], -spring(y[0], impact.span, impact.span_ratio, taut, impact.stiffness)[0] / impact.deep_mass

    def stop(_t, y):
        return y[1]

    stop.terminal = True
    found = solve_ivp(rate, (0, 9 * peak.time), (0.0, impact.speed), "DOP853", rtol=1e-11, atol=1e-15, events=stop)
    assert found.t_events[0][0] == pytest.approx(peak.time, rel=1e-7)
    assert found.y_events[0][0][0] == pytest.approx(peak.displacement, rel=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_small_strain_tends_to_the_closed_form(seed):
    impact = random_impact(seed, speed=1e-6)
    peak, small = peak_by_energy(impact), closed_form(impact)
    assert peak.tension == pytest.approx(small.tension, rel=1e-4)
    assert peak.time == pytest.approx(small.time, rel=1e-4)


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("scale", [10.0, 25.0, 50.0])
def test_froude_similarity_to_rounding(seed, scale):
    model = random_impact(seed)
    water = Water(model.water.depth * scale, model.water.density, model.water.gravity)
    prototype = Impact(
        model.span * scale,
        model.length * scale,
        model.draught * scale,
        model.upper_stiffness * scale**3,
        model.lower_stiffness * scale**3,
        model.speed * math.sqrt(scale),
        water,
    )
    small, large = peak_by_energy(model), peak_by_energy(prototype)
    assert large.tension == pytest.approx(small.tension * scale**3, rel=1e-12)
    one, two = impact_numbers(model, small.tension), impact_numbers(prototype, large.tension)
    assert two.tension_coefficient == pytest.approx(one.tension_coefficient, rel=1e-12)
    assert two.cauchy_number == pytest.approx(one.cauchy_number, rel=1e-12)
    assert two.froude_number == pytest.approx(one.froude_number, rel=1e-12)


@pytest.mark.parametrize("seed", range(3))
def test_marching_is_of_first_order_from_below(seed):
    impact = random_impact(seed)
    peak = peak_by_energy(impact)
    steps = (128, 256, 512)
    errors = [
        march_impact(impact, time_step=peak.time / n, duration=1.5 * peak.time).peak.tension / peak.tension - 1.0
        for n in steps
    ]
    assert all(error < 0.0 for error in errors)
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert orders == pytest.approx([1.0, 1.0], abs=0.05)


def test_error_of_a_linear_spring_is_an_eighth_of_pi():
    impact = random_impact(3, speed=1e-6)
    step = closed_form(impact).time / 500.0
    marched = march_impact(impact, time_step=step, duration=600 * step)
    error = 1.0 - marched.peak.tension / peak_by_energy(impact).tension
    assert error == pytest.approx(math.pi / 8.0 * marched.relative_step, rel=0.02)
    assert not marched.notices
    coarse = march_impact(impact, time_step=20 * step, duration=600 * step)
    assert coarse.notices[0].code == "impact-step"


def test_taut_cable_of_the_same_length_as_its_span():
    impact = random_impact(1, length=1.0, span=1.0)
    nearly = random_impact(1, length=1.0 + 1e-9, span=1.0)
    assert peak_by_energy(impact).tension == pytest.approx(peak_by_energy(nearly).tension, rel=1e-4)
    assert float(speed_factor(1.0)) == pytest.approx(math.sqrt(2.0 / 3.0), rel=1e-12)
    assert float(speed_factor(1.0 - 1e-7)) == pytest.approx(math.sqrt(2.0 / 3.0), rel=1e-6)
    assert math.isinf(closed_form(impact).time)


@pytest.mark.parametrize("seed", range(3))
def test_edges_apart_keep_energy_and_bracket_model_a(seed):
    rng = np.random.default_rng(seed)
    stiffness = 10.0 ** rng.uniform(2, 4)
    impact = random_impact(seed, upper_stiffness=stiffness, lower_stiffness=stiffness)
    found = edge_impact(impact)
    assert found.energy_error < 1e-8
    assert found.upper_peak < found.lower_peak
    assert found.simultaneous_peak == pytest.approx(peak_by_energy(impact).tension, rel=0.03)
    upper, lower = (found.time[np.argmax(t)] for t in (found.upper_tension, found.lower_tension))
    assert upper == pytest.approx(lower, rel=0.05)


def test_stiff_skirt_leaves_model_a_with_the_mass_of_the_arc():
    impact = random_impact(5)
    chord = 0.3 * impact.water.depth
    skirt = BulgedSkirt(chord / 0.97, chord, 300.0 * impact.stiffness / impact.span)
    mass = float(arc_skirt_mass(chord, Water(math.inf, impact.water.density, 9.81)).at(skirt.sagitta)[0])
    both = cable_and_skirt_impact(impact, skirt)
    assert both.tension == pytest.approx(peak_by_energy(impact, mass).tension, rel=0.01)


@pytest.mark.parametrize("seed", range(3))
def test_energy_of_the_stretching_skirt(seed):
    """Model B keeps energy: half M_ff(f0) U^2 becomes half E A d strain^2."""
    rng = np.random.default_rng(seed)
    impact = random_impact(seed)
    chord = rng.uniform(0.2, 0.8) * impact.water.depth
    skirt = BulgedSkirt(chord / rng.uniform(0.85, 0.97), chord, 1e4 * impact.water.density * impact.speed**2 * chord)
    mass = float(arc_skirt_mass(chord, Water(math.inf, impact.water.density, 9.81)).at(skirt.sagitta)[2])
    strain = math.sqrt(mass * impact.speed**2 / (skirt.stiffness * skirt.length))
    assert skirt_impact(impact, skirt).skirt_tension == pytest.approx(skirt.stiffness * strain, rel=1e-6)


def test_generalised_force_is_the_derivative_of_the_elastic_energy():
    skirt = BulgedSkirt(0.15, 0.135, 5e4)

    def energy(f):
        return 0.5 * skirt.length * skirt.arc(f)[1] ** 2 / skirt.stiffness

    for f in (0.0285, 0.03, 0.04):
        slope = (energy(f + 1e-7) - energy(f - 1e-7)) / 2e-7
        assert skirt.generalised_force(f) == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("seed", range(12))
def test_no_peak_exceeds_the_energy_of_the_whole_span(seed):
    def bound(impact):
        return impact.speed * math.sqrt(impact.deep_mass * impact.stiffness * impact.span_ratio)

    impact = random_impact(seed)
    assert peak_by_energy(impact).tension < bound(impact)
    base = Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, Water(0.4, 1000.0, 9.81))
    assert bound(base) == pytest.approx(13.01, abs=5e-3)
    assert peak_by_energy(base).tension < bound(base)
    ratio = np.linspace(0.01, 1.0, 200)
    assert np.all(speed_factor(ratio) < np.sqrt(ratio))


def test_sweep_is_the_single_solution():
    rng = np.random.default_rng(9)
    values = [rng.uniform(0.5, 1, 50), rng.uniform(1, 2, 50), 10 ** rng.uniform(1, 5, 50), rng.uniform(0.1, 1, 50)]
    found = sweep_peaks(*values, 12.0)
    assert found.shape == (50, 4)
    factor = speed_factor(values[0] / values[1])
    strain = found[:, 0] / values[2]
    closed = factor * values[3] * np.sqrt(12.0 * values[2])
    assert found[strain < 1e-3, 0] == pytest.approx(closed[strain < 1e-3], rel=3e-3)


def test_comparison_and_notices():
    impact = random_impact(2, draught=0.15, water=Water(0.4, 1000.0, 9.81), span=0.7, length=0.8)
    table = compare_models(impact, BulgedSkirt(0.15, 0.135, 5e4))
    assert [line.model for line in table.models] == [
        "A marched", "A", "A closed form", "A in this depth", "A with memory", "A2", "A curved skirt", "B literal",
        "B energy_mid", "B energy_proj", "AB",
    ]  # fmt: skip
    assert 1.0 < table.spread < 1e3
    soft = random_impact(2, upper_stiffness=1.0, lower_stiffness=1.0, draught=0.39, water=Water(0.4, 1000.0, 9.81))
    assert {notice.code for notice in check_impact(soft)} == {"impact-slow", "impact-strain", "impact-bed"}


def test_mass_of_the_flat_skirt_in_depth():
    shallow = flat_skirt_mass(1.0, Water(1.5, 1000.0, 9.81)).total
    assert shallow == pytest.approx(1.0119 * 2000.0 / math.pi, rel=1e-4)


@pytest.mark.parametrize(
    ("make", "word"),
    [
        (lambda: random_impact(0, length=0.01), "never slack"),
        (lambda: random_impact(0, upper_stiffness=0.0), "upper_stiffness"),
        (lambda: random_impact(0, speed=math.nan), "speed"),
        (lambda: random_impact(0, draught=100.0), "draught"),
        (lambda: march_impact(random_impact(0), time_step=0.0, duration=1.0), "time_step"),
        (lambda: sweep_peaks(1.0, 0.9, 1.0, 1.0, 1.0), "shorter"),
        (lambda: sweep_peaks(1.0, 1.1, 0.0, 1.0, 1.0), "stiffness"),
        (lambda: speed_factor(1.2), "span_ratio"),
        (lambda: BulgedSkirt(0.15, 0.15, 5e4), "chord"),
        (lambda: BulgedSkirt(0.15, 0.08, 5e4), "chord"),
        (lambda: skirt_impact(random_impact(0), BulgedSkirt(0.15, 0.135, 5e4), "other"), "literal"),
        (lambda: skirt_impact(random_impact(0, speed=5.0), BulgedSkirt(0.15, 0.135, 5.0)), "stiffer"),
        (lambda: impact_numbers(random_impact(0, water=Water(math.inf, 1000.0, 9.81)), 1.0), "infinite"),
    ],
)
def test_bad_input_is_refused_in_words(make, word):
    with pytest.raises(InputError, match=word):
        make()


def test_least_chord_is_the_one_that_is_reported() -> None:
    """The allowed range of the message is where a skirt is accepted."""
    with pytest.raises(InputError) as caught:
        BulgedSkirt(5.0, 3.0, 1e5)
    least = float(caught.value.fault.allowed.split()[1])
    assert BulgedSkirt(5.0, least * (1.0 + 1e-4), 1e5).sagitta < 0.44 * least
    with pytest.raises(InputError, match="chord"):
        BulgedSkirt(5.0, least * (1.0 - 1e-4), 1e5)


@pytest.mark.parametrize(
    ("call", "path"),
    [
        (lambda impact: peak_by_energy(impact, -5.0), "mass"),
        (lambda impact: closed_form(impact, 0.0), "mass"),
        (lambda impact: closed_form(impact, math.nan), "mass"),
        (lambda impact: march_impact(impact, time_step=0.01, duration=1.0, mass=-1.0), "mass"),
        (lambda impact: march_impact(impact, time_step=1e-9, duration=1.0), "time_step"),
        (lambda impact: edge_impact(impact, duration=-1.0), "duration"),
        (lambda impact: edge_impact(impact, samples=0), "samples"),
        (
            lambda impact: slack_taut_motion(
                impact,
                drag_coefficient=1.2,
                current=0.1,
                velocity_amplitude=0.3,
                period=4.0,
                duration=100.0,
                time_step=1e-9,
            ),
            "time_step",
        ),
    ],
)
def test_misuse_is_refused_before_any_work(call, path) -> None:
    with pytest.raises(InputError) as caught:
        call(Impact(12.0, 13.5, 4.0, 3e5, 3e5, 0.2, Water(8.0, 1025.0, 9.81)))
    assert caught.value.fault.path == path


@pytest.mark.parametrize("slack", [1e-6, 1e-3, 0.03, 0.25])
def test_a_struck_skirt_stretches_until_its_edges_bear_the_load(slack):
    """T sin(a) = F on an arc 2 r a = d (1 + T/EA) over the chord 2 r sin(a), solved for r by bisection."""
    length, stiffness, load = 5.0, 9e5, 2.1e3
    chord = length * (1.0 - slack)

    def excess(angle):
        tension = load / math.sin(angle)
        return chord * angle / math.sin(angle) - length * (1.0 + tension / stiffness)

    low, high = 1e-9, 0.5 * math.pi
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if excess(middle) < 0.0 else (low, middle)
    found = BulgedSkirt(length, chord, stiffness).edge_tension(load)
    assert found == pytest.approx(load / math.sin(low), rel=1e-9)
    assert BulgedSkirt(length, chord, stiffness).edge_tension(4.0 * load) > found
    # the arc would close: no tension carries it
    assert BulgedSkirt(length, chord, 100.0).edge_tension(load) == math.inf


@pytest.mark.slow
def test_a_skirt_that_bulges_out_of_the_range_of_its_mass_leaves_model_b_out():
    """The others stay: an ordinary held skirt of 4.5 m at a chord of 3.2 m in 0.7 m/s had no report."""
    water = Water(6.0, 1025.0, 9.81)
    impact = Impact(
        span=20.0, length=21.0, draught=3.19, upper_stiffness=8e5, lower_stiffness=8e5, speed=0.7, water=water
    )
    skirt = BulgedSkirt(4.5, 3.19, 6e5)
    with pytest.raises(InputError, match="beyond the range of the added mass"):
        skirt_impact(impact, skirt, finite_depth=True)
    found = compare_models(impact, skirt, memory=False)
    names = {line.model for line in found.models}
    assert "AB" in names and "B energy_mid" not in names
    (said, *_) = [notice for notice in found.notices if notice.code == "impact-skirt-range"]
    assert "left out" in said.message and said.severity == "information"
