"""Morison's forces: drag forms, relative velocity, geometry, coefficient laws, flows, against closed forms."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.morison import sections
from moyai.morison.coefficients import (
    CoefficientRule,
    Conditions,
    KeuleganCarpenterTable,
    dnv_added_mass,
    dnv_drag,
    dnv_steady_drag,
)
from moyai.morison.flow import LinearFlow, NonlinearFlow
from moyai.morison.forces import strip_forces
from moyai.morison.members import StraightMember
from moyai.sea import irregular, nonlinear, spectra
from moyai.sea.water import Water
from moyai.tables.member_drag import api_circle, steady_rectangle


def test_vector_drag_of_a_circular_orbit_is_that_of_a_smaller_component_coefficient():
    """First harmonics: u|U| has amplitude V^2, u|u| 8 V^2/(3 pi), so C_D of the vector form is 0.849 of the other."""
    angle = 2.0 * math.pi * np.arange(720) / 720
    velocity = 1.3 * np.column_stack([np.cos(angle), -np.sin(angle)])
    both = {}
    for form in ("component", "vector"):
        drag = strip_forces(
            velocity,
            np.zeros_like(velocity),
            density=1000.0,
            area=1.0,
            inertia=[2.0, 2.0],
            drag=[1.0, 1.0],
            drag_widths=[0.5, 0.5],
            form=form,
        ).drag
        both[form] = 2.0 * np.mean(drag[:, 0] * np.cos(angle))
    assert both["component"] / both["vector"] == pytest.approx(8.0 / (3.0 * math.pi), rel=1e-4)


@pytest.mark.parametrize("seed", range(4))
def test_relative_velocity_leaves_only_the_pressure_of_the_wave(seed):
    """A member that moves with the water feels rho A a of the displaced water and nothing else."""
    rng = np.random.default_rng(seed)
    velocity, rate = rng.normal(size=(2, 30, 2))
    tensor = sections.polygon(rng.normal(size=(3, 2))).inertia.tensor
    found = strip_forces(
        velocity,
        rate,
        density=1020.0,
        area=0.3,
        inertia=tensor,
        drag=rng.uniform(0, 2, 2),
        drag_widths=[1.0, 2.0],
        circulation=rng.normal(),
        body_velocity=velocity,
        body_acceleration=rate,
        form=rng.choice(["component", "vector"]),
    )
    assert found.total == pytest.approx(1020.0 * 0.3 * rate)


@pytest.mark.parametrize("seed", range(4))
def test_forces_do_not_depend_on_the_axes_of_the_observer(seed):
    """Vector drag with equal coefficients, tensor inertia and Magnus force turn with the axes."""
    rng = np.random.default_rng(seed)
    velocity, rate, body = rng.normal(size=(3, 20, 2))
    angle = rng.uniform(0, 2 * math.pi)
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    tensor = np.array([[2.0, 0.3], [0.3, 1.4]])
    options = {"density": 1000.0, "area": 0.7, "drag": [1.1, 1.1], "drag_widths": [0.9, 0.9], "circulation": 0.4}
    plain = strip_forces(velocity, rate, inertia=tensor, body_velocity=body, form="vector", **options).total
    turned = strip_forces(
        velocity @ turn.T,
        rate @ turn.T,
        inertia=turn @ tensor @ turn.T,
        body_velocity=body @ turn.T,
        form="vector",
        **options,
    ).total
    assert turned == pytest.approx(plain @ turn.T)


def test_unknown_form_is_refused():
    with pytest.raises(InputError, match="form"):
        strip_forces(
            [[1, 0]], [[0, 0]], density=1, area=1, inertia=[2, 2], drag=[1, 1], drag_widths=[1, 1], form="both"
        )


@pytest.mark.parametrize("seed", range(6))
def test_axes_of_any_member_are_right_and_do_not_care_which_end_is_first(seed):
    rng = np.random.default_rng(seed)
    start, end = rng.normal(size=(2, 3))
    member = StraightMember(tuple(start), tuple(end), sections.circle(0.1))
    first, second, along = member.axes
    assert np.abs(member.axes @ member.axes.T - np.eye(3)).max() < 1e-12
    assert np.cross(first, second) == pytest.approx(-along) or np.cross(first, second) == pytest.approx(along)
    assert first[2] == pytest.approx(0.0, abs=1e-12)
    assert second[2] >= 0.0
    other = StraightMember(tuple(end), tuple(start), sections.circle(0.1))
    assert other.axes[:2] == pytest.approx(member.axes[:2])
    assert member.inclination == pytest.approx(math.asin(abs(end[2] - start[2]) / member.length))


def test_axes_of_members_along_the_axes_of_the_site():
    def axes(end):
        return StraightMember((0, 0, -5), end, sections.circle(0.1)).axes

    assert axes((0, 3, -5))[:2] == pytest.approx(np.array([[1, 0, 0], [0, 0, 1]]))
    assert axes((3, 0, -5))[:2] == pytest.approx(np.array([[0, 1, 0], [0, 0, 1]]))
    assert axes((0, 0, 3))[0] == pytest.approx([1, 0, 0])


def test_wetted_share_of_an_upright_strip_and_of_a_level_circle():
    upright = StraightMember((0, 0, -1.0), (0, 0, 1.0), sections.circle(0.1)).strips(2)
    assert upright.wet_share([[0.0, 0.25]]) == pytest.approx(np.array([[1.0, 0.25]]))
    level = StraightMember((0, -1, 0.0), (0, 1, 0.0), sections.circle(2.0)).strips(1)
    assert level.wet_share([[-1.0], [0.0], [0.5], [2.0]])[:, 0] == pytest.approx([0.0, 0.5, 0.75, 1.0])


@pytest.mark.parametrize(("start", "end"), [((0, 0, 0), (0, 0, 0)), ((0, 0, math.nan), (0, 0, 1))])
def test_impossible_members_are_refused(start, end):
    with pytest.raises(InputError):
        StraightMember(start, end, sections.circle(1.0))


@pytest.mark.parametrize("seed", range(3))
def test_wheeler_kinematics_over_time_agree_with_the_kernel_at_each_time(seed):
    rng = np.random.default_rng(seed)
    water = Water(rng.uniform(5.0, 40.0), 1025.0, 9.81)
    sea = irregular.synthesise(
        spectra.jonswap(0.2 * water.depth, rng.uniform(5, 12), 3.3),
        water,
        duration=300.0,
        seed=seed,
        time_step=0.5,
        heading=rng.uniform(-3, 3),
    )
    points = np.column_stack([rng.uniform(-20, 20, (2, 3)).T, rng.uniform(-0.9, 0.05, 3) * water.depth])
    time = 0.5 * np.arange(60)
    found = LinearFlow(sea, "wheeler").sample(time, points)
    for n in (0, 17, 59):
        eta, velocity, rate = sea.kinematics(float(time[n]), *points.T, "wheeler")
        assert found.elevation[n] == pytest.approx(eta, abs=1e-10)
        assert np.abs(found.velocity[n] - velocity).max() < 1e-6 * np.abs(found.velocity).max()
        assert np.abs(found.acceleration[n] - rate).max() < 1e-5 * np.abs(found.acceleration).max()


def test_flow_of_a_wave_of_finite_height_leaves_its_current_out():
    water = Water(10.0, 1000.0, 9.81)
    wave = nonlinear.nonlinear_wave(
        "stream_function", height=2.0, water=water, period=7.0, heading=0.6, current_along_wave=0.8
    )
    time = np.linspace(0.0, 7.0, 401)[:-1]
    sample = NonlinearFlow(wave).sample(time, np.array([[1.0, 2.0, -4.0]]))
    assert np.abs(sample.velocity.mean(axis=0)).max() < 1e-10


def test_dnv_laws_at_their_corners():
    """Continuity, limits and the two ends of roughness."""
    assert dnv_steady_drag(0.0) == 0.65
    assert dnv_steady_drag(0.05) == 1.05
    assert dnv_steady_drag(1.0000001e-4) == pytest.approx(0.65, abs=1e-6)
    assert dnv_steady_drag(0.99999999e-2) == pytest.approx(1.05, abs=1e-6)
    for rough in (0.0, 1e-3, 0.1):
        for corner in (0.75, 2.0, 12.0):
            assert dnv_drag(corner - 1e-9, rough) == pytest.approx(dnv_drag(corner + 1e-9, rough), abs=1e-7)
        assert dnv_added_mass(3.0 - 1e-9, rough) == pytest.approx(dnv_added_mass(3.0 + 1e-9, rough), abs=1e-7)
    assert dnv_added_mass(100.0, 0.0) == pytest.approx(0.6)
    assert dnv_added_mass(100.0, 0.1) == pytest.approx(0.2)


def test_tables_say_where_they_come_from():
    assert api_circle(rough=False).drag == 0.65
    assert api_circle(rough=True).inertia == 1.2
    assert steady_rectangle(1.0).drag == 2.1
    assert 1.65 < steady_rectangle(1.5).drag < 2.1
    assert not api_circle(rough=False).confirmed


@pytest.mark.parametrize(
    ("rule", "section", "words"),
    [
        (CoefficientRule("dnv_c205"), sections.rectangle(1, 2), "is for circles"),
        (CoefficientRule("steady"), sections.polygon([(0, 0), (1, 0), (0, 1)]), "no steady drag of a polygon"),
        (CoefficientRule((1.0, 1.0), "api"), sections.rectangle(1, 1), "is for circles"),
    ],
)
def test_laws_refuse_sections_they_do_not_know(rule, section, words):
    with pytest.raises(InputError, match=words):
        rule.at(section, Conditions(1.0, 1e6, 1e5))


def test_unknown_laws_and_negative_numbers_are_refused():
    with pytest.raises(InputError, match="unknown drag law"):
        CoefficientRule("dnv")
    with pytest.raises(InputError, match="at least 0"):
        CoefficientRule((1.0, -1.0))


def test_own_tables_over_kc():
    table = KeuleganCarpenterTable(((1.0, 2.0, 1.0), (3.0, 1.0, 0.5)))
    rule = CoefficientRule(table, table)
    found = rule.at(sections.rectangle(1, 2), Conditions(2.0, 1e5, 1e4))
    assert found.drag == pytest.approx([1.5, 0.75])
    assert found.inertia == pytest.approx(np.diag([1.5, 0.75]))
    assert found.notices == ()
    outside = rule.at(sections.circle(1.0), Conditions(9.0, 1e5, 1e4))
    assert outside.drag == pytest.approx([1.0, 0.5])
    assert {notice.code for notice in outside.notices} == {"coefficients-outside-table"}
    for rows in (((1.0, 2.0, 1.0),), ((3.0, 1, 1), (1.0, 1, 1)), ((1.0, -1, 1), (2.0, 1, 1))):
        with pytest.raises(InputError, match="KC"):
            KeuleganCarpenterTable(rows)


def test_notices_name_number_and_limit():
    circle = sections.circle(1.0)
    found = CoefficientRule("dnv_c205").at(circle, Conditions(15.0, 2e5, 1e4)).notices
    assert {notice.code for notice in found} == {"drag-reynolds", "drag-keulegan-carpenter"}
    unstable = CoefficientRule("stokes_wang", "stokes_wang").at(circle, Conditions(2.0, 3e3, 1690.0)).notices
    assert unstable[0].limit == pytest.approx(0.93, abs=0.01)
    laminar = CoefficientRule("stokes_wang", "stokes_wang").at(circle, Conditions(0.1, 3e3, 1690.0))
    assert laminar.notices == ()
    assert laminar.inertia[0, 0] == pytest.approx(2.0549, abs=1e-4)


@pytest.mark.parametrize(("form", "speed"), [("component", (3.0, 4.0)), ("vector", (5.0, 5.0))])
def test_drag_inertia_and_lift_of_a_strip_by_hand(form, speed):
    """0.5 rho C_D b u |u| with u = (3, -4) m/s, rho A C_M a, rho Gamma |u| across the flow."""
    found = strip_forces(
        [3.0, -4.0], [0.2, 0.7], density=1025.0, area=0.3, inertia=[1.8, 2.1], drag=[1.2, 0.7], drag_widths=[0.5, 2.0],
        circulation=0.4, form=form,
    )  # fmt: skip
    # 0.5 * 1025 * 1.2 * 0.5 = 307.5 and 0.5 * 1025 * 0.7 * 2 = 717.5 N s2/m3
    np.testing.assert_allclose(found.drag, [307.5 * 3.0 * speed[0], -717.5 * 4.0 * speed[1]], rtol=1e-12)
    np.testing.assert_allclose(found.inertia, [1025.0 * 0.3 * 1.8 * 0.2, 1025.0 * 0.3 * 2.1 * 0.7], rtol=1e-12)
    assert math.hypot(*found.magnus) == pytest.approx(1025.0 * 0.4 * 5.0, rel=1e-12)
    assert np.dot(found.magnus, [3.0, -4.0]) == pytest.approx(0.0, abs=1e-9)
