"""The circulation law: orbits, Magnus force, relaxation, range, against identities and random elliptic orbits."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.morison import circulation as law
from moyai.morison import planar
from moyai.morison.field import circle_velocity
from moyai.morison.orbits import mean_frequency, orbit_amplitudes, orbit_product


def orbit(rng, sense=1.0):
    """Return velocity, acceleration, axes and frequency of a random ellipse, tilted and at random phase."""
    omega, major, minor = rng.uniform(0.3, 8.0), rng.uniform(0.5, 2.0), rng.uniform(0.0, 0.5)
    tilt, phase = rng.uniform(0, math.pi), rng.uniform(0, 2 * math.pi)
    angle = omega * np.linspace(0.0, 2 * math.pi / omega, 40, endpoint=False) + phase
    turn = np.array([[math.cos(tilt), -math.sin(tilt)], [math.sin(tilt), math.cos(tilt)]])
    velocity = np.column_stack([major * np.cos(angle), -sense * minor * np.sin(angle)]) @ turn.T
    rate = omega * np.column_stack([-major * np.sin(angle), -sense * minor * np.cos(angle)]) @ turn.T
    return velocity, rate, major, minor, omega


@pytest.mark.parametrize("seed", range(6))
def test_momentary_orbit_of_any_ellipse(seed):
    rng = np.random.default_rng(seed)
    velocity, rate, major, minor, omega = orbit(rng, sense := rng.choice([-1.0, 1.0]))
    assert orbit_product(velocity, rate, omega) == pytest.approx(np.full(40, sense * major * minor), abs=1e-12)
    large, small = orbit_amplitudes(velocity, rate, omega)
    assert large == pytest.approx(np.full(40, major), rel=1e-7)
    assert small == pytest.approx(np.full(40, minor), abs=1e-7)
    assert mean_frequency(velocity, rate) == pytest.approx(omega, rel=1e-10)


@pytest.mark.parametrize("seed", range(4))
def test_magnus_force_is_a_fall_of_the_inertia_coefficients(seed):
    """rho Gamma (-w, u) equals -rho A (dC_x a_x, dC_z a_z) of an upright ellipse at every instant."""
    rng = np.random.default_rng(seed)
    omega, first, second, area, rho = rng.uniform(0.2, 9.0, 5)
    angle = np.linspace(0, 2 * math.pi, 50)
    velocity = np.column_stack([first * np.cos(angle), -second * np.sin(angle)])
    rate = omega * np.column_stack([-first * np.sin(angle), -second * np.cos(angle)])
    gamma = float(law.settled_circulation(1.0, first, second, 2 * math.pi / omega))
    fall = np.array(law.inertia_reduction(gamma, omega, area, first, second))
    lift = law.magnus_force(rho, gamma, velocity)
    assert lift == pytest.approx(-rho * area * fall * rate, rel=1e-10, abs=1e-12)
    # 90 degrees left of the flow, so it does no work
    assert np.abs(np.sum(lift * velocity, axis=1)).max() < 1e-12 * np.abs(lift).max() * max(first, second)
    assert np.all(velocity[:, 0] * lift[:, 1] - velocity[:, 1] * lift[:, 0] >= 0.0)


def test_strengths_are_those_of_the_three_papers():
    assert law.STRENGTHS["arai"] == pytest.approx(0.9357, abs=5e-5)
    assert law.STRENGTHS["otsuka"] == 1.0
    assert law.STRENGTHS["chaplin"] == pytest.approx(1.0363, abs=5e-5)
    area, breadth = math.pi / 4.0, 1.0
    for name, fall in (("otsuka", 2.0 / math.pi**2), ("chaplin", 0.21)):
        found = law.STRENGTHS[name] * breadth**2 / (2.0 * math.pi * area)
        assert found == pytest.approx(fall, rel=1e-12), name


def test_flattening_orbits_lose_their_circulation_in_proportion():
    rule = law.CirculationLaw(purpose="response")
    target = []
    for minor in (0.1, 0.01, 0.001, 0.0):
        angle = np.linspace(0, 6, 20)
        velocity = np.column_stack([0.1 * np.cos(angle), -minor * 0.1 * np.sin(angle)])
        rate = np.column_stack([-0.1 * np.sin(angle), -minor * 0.1 * np.cos(angle)])
        target.append(law.target_circulation(rule, velocity, rate, 1.0, breadth=1.0, area=1.0)[3])
    assert target[1] / target[0] == pytest.approx(0.1)
    assert target[2] / target[0] == pytest.approx(0.01)
    assert target[3] == 0.0


@pytest.mark.parametrize("seed", range(3))
def test_state_of_a_ramp_is_exact_at_any_step(seed):
    rng = np.random.default_rng(seed)
    tau, slope, start = rng.uniform(0.1, 5.0), rng.normal(), rng.normal()
    for step in (0.05, 0.5, 5.0):
        time = step * np.arange(12)
        exact = slope * (time - tau) + (start + slope * tau) * np.exp(-time / tau)
        assert law.relaxed(slope * time, step, tau, start) == pytest.approx(exact, rel=1e-12, abs=1e-12)


def test_state_is_slow_against_an_alternating_orbit():
    """Orbits that change their sense every period leave almost nothing."""
    time = np.arange(0.0, 200.0, 0.05)
    target = np.sign(np.sin(math.pi * time))
    state = law.relaxed(target, 0.05, 5.0, 0.0)
    assert np.abs(state[2000:]).max() < 0.13  # 1/(2 tau) and a step of the grid


def test_share_holds_the_reduction_and_then_drops_it():
    rule = law.CirculationLaw(purpose="response")
    number = np.array([0.5, 2.0, 2.5, 3.0, 3.01, 10.0])
    share = rule.share(number, 1.0, 1.0, 1.0)
    assert share == pytest.approx([1.0, 1.0, 4.0 / 6.25, 4.0 / 9.0, 0.0, 0.0])
    # the reduction of C_M itself, share KC^2, does not change between KC 2 and 3
    assert share[1:4] * number[1:4] ** 2 == pytest.approx([4.0, 4.0, 4.0])


def test_user_table_replaces_the_law_where_it_speaks():
    rule = law.CirculationLaw(purpose="response", table=((2.0, 0.6), (3.0, 0.9), (4.0, 0.3)))
    area, breadth, gamma = 0.6, 1.1, 0.936
    for number, fall in ((2.0, 0.6), (2.5, 0.75), (3.5, 0.6), (4.0, 0.3)):
        share = float(rule.share(number, breadth, area, gamma))
        assert share * gamma * number**2 * breadth**2 / (2 * math.pi * area) == pytest.approx(fall)
    assert float(rule.share(1.9, breadth, area, gamma)) == 1.0
    assert float(rule.share(4.1, breadth, area, gamma)) == 0.0
    assert rule.largest == 4.0


def test_strength_by_beta():
    rule = law.CirculationLaw(beta_table=((1000.0, 0.9), (10000.0, 1.1)))
    assert rule.gamma(math.sqrt(1e7)) == pytest.approx(1.0)
    assert rule.gamma(10.0) == 0.9


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"strength": "morison"}, "unknown circulation"),
        ({"strength": 6.0}, "laminar ceiling"),
        ({"strength": -1.0}, "strength"),
        ({"purpose": "design"}, "purpose"),
        ({"start": "cold"}, "start"),
        ({"relaxation_periods": 0.0}, "relaxation_periods"),
        ({"table": ((2.0, 0.5),)}, "at least 2 rows"),
        ({"table": ((3.0, 0.5), (2.0, 0.5))}, "does not rise"),
        ({"beta_table": ((-1.0, 1.0),)}, "does not rise"),
    ],
)
def test_impossible_laws_are_refused(options, words):
    with pytest.raises(InputError, match=words):
        law.CirculationLaw(**options)


def test_laminar_planar_flow():
    """Figures of the laminar theory at the two frequency parameters of the literature."""
    assert float(planar.stokes_wang_inertia(1035.0)) == pytest.approx(2.0702, abs=5e-5)
    assert float(planar.stokes_wang_inertia(1690.0)) == pytest.approx(2.0549, abs=5e-5)
    assert float(planar.stokes_wang_drag(1.0, 1035.0)) == pytest.approx(0.8299, abs=5e-5)
    assert float(planar.stokes_wang_drag(1.0, 1690.0)) == pytest.approx(0.6470, abs=5e-5)
    assert float(planar.hall_limit(1690.0)) == pytest.approx(0.93, abs=5e-3)
    assert float(planar.stokes_wang_inertia(1e12)) == pytest.approx(2.0, abs=1e-5)
    with pytest.raises(InputError, match="beta"):
        planar.stokes_wang_inertia(-1.0)


@pytest.mark.parametrize("seed", range(3))
def test_field_around_a_circle_slips_circulates_and_fades(seed):
    rng = np.random.default_rng(seed)
    radius, gamma, stream = rng.uniform(0.1, 2.0), rng.normal(), rng.normal(size=2)
    angle = 2.0 * math.pi * np.arange(64) / 64
    for reach in (1.0, 1.7):
        points = reach * radius * np.column_stack([np.cos(angle), np.sin(angle)])
        velocity = circle_velocity(points, radius, stream, gamma)
        tangent = np.column_stack([-np.sin(angle), np.cos(angle)])
        # clockwise is positive
        around = -np.sum(velocity * tangent) * 2.0 * math.pi * reach * radius / 64
        assert around == pytest.approx(gamma)
        if reach == 1.0:
            assert np.abs(np.sum(velocity * points, axis=1)).max() < 1e-12 * radius * np.abs(velocity).max() * 10
    far = circle_velocity([[1e6 * radius, 0.0]], radius, stream, gamma)
    assert far[0] == pytest.approx(stream, abs=1e-5)
    # Kutta and Joukowski: the mean of the pressure round the circle gives rho Gamma (-w, u)
    points = radius * np.column_stack([np.cos(angle), np.sin(angle)])
    pressure = -0.5 * np.sum(circle_velocity(points, radius, stream, gamma) ** 2, axis=1)
    force = -np.sum(pressure[:, None] * points, axis=0) * 2.0 * math.pi / 64
    assert force == pytest.approx(law.magnus_force(1.0, gamma, stream[None])[0])
    with pytest.raises(InputError, match="inside"):
        circle_velocity([[0.0, 0.0]], radius, stream, gamma)


def test_a_table_speaks_next_to_a_law_of_no_strength():
    rule = law.CirculationLaw(0.0, "response", table=((1.0, 0.2), (4.0, 0.5)))
    assert rule.reduction([0.5, 1.0, 2.5, 4.0, 4.1], 1.3, 0.7, 0.0) == pytest.approx([0.0, 0.2, 0.35, 0.5, 0.0])
    other = law.CirculationLaw("otsuka", "response", table=((1.0, 0.2), (4.0, 0.5)))
    assert other.reduction([1.0, 2.5, 4.0], 1.3, 0.7, 1.0) == pytest.approx([0.2, 0.35, 0.5])
    angle, omega = np.linspace(0, 6, 7), 1.3
    velocity = np.column_stack([np.cos(angle), -np.sin(angle)])
    rate = -omega * np.column_stack([np.sin(angle), np.cos(angle)])
    breadth = 2 * math.pi / omega / 2.5
    found = law.target_circulation(rule, velocity, rate, omega, breadth=breadth, area=0.7 * breadth**2)
    # a fall of 0.35 in a circular orbit is Gamma = 0.35 omega A
    assert found == pytest.approx(0.35 * omega * 0.7 * breadth**2)


def test_tables_of_gamma_stay_below_the_ceiling():
    with pytest.raises(InputError, match="gamma is 50 at beta 1000"):
        law.CirculationLaw(beta_table=((1000.0, 50.0),))
    with pytest.raises(InputError, match="below 0"):
        law.CirculationLaw(table=((1.0, -0.2), (2.0, 0.5)))
