"""General section and plan of a curtain: closed forms as special cases, independent integration, equilibrium."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

from moyai.core.errors import InputError
from moyai.sea.current import power_law, table, uniform
from moyai.sea.water import Water
from moyai.structures.curtain.statics.closed_forms import solve_cable, solve_skirt_arc
from moyai.structures.curtain.statics.drag import (
    DragLaw,
    check_drag,
    closure_drag,
    constant_drag,
    gap_speed_drag,
    sample_pressure,
    under_toe_speed,
)
from moyai.structures.curtain.statics.load_laws import section_laws
from moyai.structures.curtain.statics.plan import PlanLoad, cosine_squared_load, section_load, solve_plan
from moyai.structures.curtain.statics.section import Skirt, solve_section
from moyai.structures.curtain.statics.section_kernels import climb

DEEP = Water(math.inf, 1000.0, 9.81)
DRAG = constant_drag(1.5, (0.8, 1.3), "test")


def speed_for(ratio: float, skirt: Skirt) -> float:
    return math.sqrt(ratio * skirt.toe_load / skirt.length / (0.5 * 1000.0 * 1.5))


def test_free_toe_joins_the_closed_forms() -> None:
    rng = np.random.default_rng(2)
    for _ in range(25):
        length, toe, ratio = rng.uniform(0.3, 30), 10.0 ** rng.uniform(1, 4), 10.0 ** rng.uniform(-1, 1.2)
        stiffness = toe * 10.0 ** rng.uniform(1.3, 6)
        skirt = Skirt(length, 0.0, toe, stiffness)
        current = uniform(speed_for(ratio, skirt), 0.4)
        found = solve_section(skirt, current, 0.4, DEEP, DRAG)
        law = section_laws(length, toe, ratio * toe / length, stiffness)[3]
        assert found.effective_depth == pytest.approx(law.effective_depth, rel=1e-9)
        assert found.flare == pytest.approx(law.flare, rel=1e-9)
        assert found.top_load == pytest.approx(law.horizontal_load, rel=1e-9)
        np.testing.assert_allclose(found.tension, toe, rtol=1e-9)
        if ratio < 3.0:
            stiff = Skirt(length, 0.0, toe, math.inf)
            arc = solve_section(stiff, current, 0.4, DEEP, DRAG, law="uniform_normal")
            circular = section_laws(length, toe, ratio * toe / length)[1]
            assert arc.effective_depth == pytest.approx(circular.effective_depth, rel=1e-9, abs=1e-9 * length)


def test_an_oblique_plate_in_separated_flow_has_its_closed_form() -> None:
    """Weightless sheet: d(alpha)/ds = -q c/W integrated; always a shape, less deep than by the normal velocity."""
    rng = np.random.default_rng(21)
    for ratio in 10.0 ** rng.uniform(-1, 1.5, 25):
        length, toe = rng.uniform(0.3, 30), 10.0 ** rng.uniform(1, 4)
        skirt = Skirt(length, 0.0, toe, math.inf)
        current = uniform(speed_for(ratio, skirt), 0.4)
        found = solve_section(skirt, current, 0.4, DEEP, DRAG, law="free_streamline")

        def miss(angle: float, ratio: float = ratio) -> float:
            turned = 4.0 * math.log(1.0 / math.tan(0.5 * angle)) + math.pi * (0.5 * math.pi - angle)
            return turned / (4.0 + math.pi) - ratio

        angle = brentq(miss, 1e-25, 0.5 * math.pi, xtol=1e-30, rtol=1e-14)
        depth = length / ratio * (4.0 * (0.5 * math.pi - angle) + math.pi * math.cos(angle)) / (4.0 + math.pi)
        assert found.effective_depth == pytest.approx(depth, rel=1e-7)
        assert found.top_load == pytest.approx(toe * math.cos(angle), rel=1e-7)
        assert found.effective_depth < solve_section(skirt, current, 0.4, DEEP, DRAG).effective_depth


def test_held_toe_is_the_arc_of_equation_two() -> None:
    rng = np.random.default_rng(4)
    for _ in range(8):
        length, toe, ratio = rng.uniform(0.5, 12), 10.0 ** rng.uniform(1, 4), rng.uniform(0.2, 5.0)
        skirt = Skirt(length, 0.0, toe, toe * 10.0 ** rng.uniform(1.5, 5))
        found = solve_section(
            skirt, uniform(speed_for(ratio, skirt), 0.0), 0.0, DEEP, DRAG, law="uniform_normal", toe="held"
        )
        arc = solve_skirt_arc(found.effective_depth, length, ratio * toe / length, skirt.stiffness)
        assert abs(found.flare) < 1e-8 * length
        assert found.toe_hold == pytest.approx(float(arc.edge_load), rel=1e-8)
        assert found.top_load == pytest.approx(float(arc.edge_load), rel=1e-8)
        assert found.sheet_tension == pytest.approx(float(arc.tension), rel=1e-8)


def random_case(rng: np.random.Generator) -> tuple[Skirt, object, Water]:
    water = Water(rng.uniform(6, 30), 1025.0, 9.81)
    length = water.depth * rng.uniform(0.2, 0.9)
    skirt = Skirt(length, rng.uniform(0.0, 15.0), rng.uniform(50, 800), 10.0 ** rng.uniform(4, 7))
    kind = rng.integers(3)
    if kind == 0:
        return skirt, power_law(rng.uniform(0.05, 0.5), rng.uniform(0.1, 0.5), 0.0, water), water
    if kind == 1:
        heights = -water.depth * np.array([0.0, 0.3, 0.7, 1.0])
        return skirt, table(heights, rng.uniform(0.0, 0.4, 4), 0.0), water
    return skirt, uniform(rng.uniform(0.05, 0.5), 0.3), water


@pytest.mark.slow
def test_skirt_with_weight_in_sheared_current_against_independent_integration() -> None:
    """Angle form of the same equilibrium, integrated by scipy from the toe that was found upwards."""
    from scipy.integrate import solve_ivp

    rng = np.random.default_rng(6)
    for _ in range(12):
        skirt, current, water = random_case(rng)
        found = solve_section(skirt, current, 0.0, water, DRAG)

        def rate(_: float, state: np.ndarray, skirt=skirt, current=current, water=water) -> list[float]:
            tension, angle, _, z = state
            stretch = 1.0 + tension / skirt.stiffness
            pressure = float(sample_pressure(current, 0.0, max(z, -water.depth), water.density))
            load, weight = 1.5 * pressure * math.cos(angle) ** 2, skirt.submerged_weight
            return [
                weight * math.cos(angle),
                (load * stretch - weight * math.sin(angle)) / tension,
                -stretch * math.sin(angle),
                stretch * math.cos(angle),
            ]

        start = [skirt.toe_load, 0.0, found.flare, found.z[-1]]
        end = solve_ivp(rate, (0.0, skirt.length), start, rtol=1e-11, atol=1e-11, max_step=skirt.length / 200).y[:, -1]
        assert end[0] == pytest.approx(found.tension[0], rel=1e-6)
        assert end[1] == pytest.approx(found.angle[0], abs=3e-6)
        assert end[2:] == pytest.approx([0.0, 0.0], abs=3e-6 * skirt.length)


def test_section_is_in_equilibrium_as_a_whole() -> None:
    rng = np.random.default_rng(9)
    for toe in ("free", "held"):
        for _ in range(6):
            skirt, current, water = random_case(rng)
            found = solve_section(skirt, current, 0.0, water, DRAG, toe=toe)
            s, z, angle = found.arc, found.z, found.angle
            assert s[0] == 0.0 and s[-1] == skirt.length
            stretch = 1.0 + found.tension / skirt.stiffness
            load = 1.5 * sample_pressure(current, 0.0, z, water.density) * np.cos(angle) ** 2 * stretch
            across = np.trapezoid(load * np.cos(angle), s)
            up = np.trapezoid(load * np.sin(angle), s)
            assert found.load == pytest.approx(across, rel=2e-4)
            weight = skirt.toe_load + skirt.submerged_weight * skirt.length
            assert found.top_pull == pytest.approx(weight - up, rel=2e-4)


@pytest.mark.parametrize("friction", [0.0, 0.02])
def test_fourth_order_of_the_integration(friction: float) -> None:
    """Halving the step divides the error of the top by sixteen."""
    # drag, weight in water, flexibility, whether the load is uniform, friction
    pressure, data = np.full(5, 60.0), np.array([1.5, 3.0, 1e-4, 0.0, friction])
    ends = []
    for count in (10, 20, 40, 80, 1280):
        path = np.empty((count + 1, 4))
        climb(-5.0, 0.0, 120.0, np.linspace(0.0, 5.0, count + 1), -10.0, 3.0, pressure, data, path)
        ends.append(path[-1].copy())
    errors = [np.linalg.norm(end - ends[-1]) for end in ends[:-1]]
    orders = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    assert np.all((orders > 3.7) & (orders < 4.5)), orders


def test_reversed_current_mirrors_the_section() -> None:
    skirt, water = Skirt(6.0, 3.0, 200.0, 1e5), Water(10.0, 1025.0, 9.81)
    for toe in ("free", "held"):
        there = solve_section(skirt, uniform(0.3, 0.0), 0.0, water, DRAG, toe=toe)
        back = solve_section(skirt, uniform(0.3, math.pi), 0.0, water, DRAG, toe=toe)
        np.testing.assert_allclose(back.x, -there.x, atol=1e-9)
        np.testing.assert_allclose(back.z, there.z, atol=1e-9)
        assert back.load == pytest.approx(-there.load, rel=1e-9)


def test_still_water_hangs_straight() -> None:
    for toe in ("free", "held"):
        found = solve_section(Skirt(5.0, 10.0, 100.0, 1e4), uniform(0.0, 0.0), 0.0, DEEP, DRAG, toe=toe)
        # each element stretches under what hangs below it
        stretched = 5.0 + (100.0 * 5.0 + 10.0 * 12.5) / 1e4
        assert found.effective_depth == pytest.approx(stretched, rel=1e-12)
        assert found.top_pull == pytest.approx(150.0, rel=1e-12)
        assert found.flare == 0.0


def test_blockage_is_that_of_the_deflected_skirt() -> None:
    water, skirt = Water(10.0, 1025.0, 9.81), Skirt(7.0, 3.0, 400.0, math.inf)
    for law in (gap_speed_drag(1.2, (0.7, 1.5), "test"), closure_drag(0.7, (0.7, 1.5))):
        found = solve_section(skirt, uniform(0.3, 0.0), 0.0, water, law)
        assert found.blockage == pytest.approx(found.effective_depth / 10.0, rel=1e-12)
        assert found.drag_coefficient == pytest.approx(law.coefficient(found.blockage), rel=1e-6)
    assert closure_drag(0.7, (1, 1)).coefficient(0.5) == pytest.approx((1 / 0.35 - 1) ** 2 / 0.5, rel=1e-4)
    assert gap_speed_drag(1.2, (1, 1), "").coefficient(0.5) == pytest.approx(4.8, rel=1e-4)


def test_speed_under_the_toe() -> None:
    water = Water(10.0, 1025.0, 9.81)
    current = power_law(0.5, 1 / 7, 0.2, water)
    total = float(np.hypot(*current.depth_mean(-10.0, 0.0))) * 10.0
    assert under_toe_speed(current, 0.2, 6.0, water, 1.0) == pytest.approx(total / 4.0, rel=1e-12)
    free = float(np.hypot(*current.depth_mean(-10.0, -6.0)))
    assert under_toe_speed(current, 0.2, 6.0, water, 0.0) == pytest.approx(free, rel=1e-12)


def test_plan_joins_the_closed_form() -> None:
    rng = np.random.default_rng(12)
    for _ in range(60):
        span = rng.uniform(1, 200)
        length, load = span * rng.uniform(0.98, 2.5), 10.0 ** rng.uniform(-1, 4)
        stiffness = load * length * 10.0 ** rng.uniform(1, 6)
        plan = solve_plan(span, length, stiffness, cosine_squared_load(load, 0.0))
        cable = solve_cable(span, length, load, stiffness)
        assert plan.tension == pytest.approx(float(cable.tension), rel=1e-9)
        assert plan.sag == pytest.approx(float(cable.sag), rel=1e-9)
        np.testing.assert_allclose(plan.x, cable.deflection(plan.y - span / 2), atol=1e-10 * span)


def test_uniform_normal_load_in_plan_is_a_circle() -> None:
    """c = 1/cos^2 makes the load independent of the angle, and the flow angle without meaning."""
    angle = np.linspace(-1.48, 1.48, 400)
    for flow in (0.0, 0.3):
        plan = solve_plan(10.0, 10.6, 1e9, PlanLoad(50.0, flow, angle, 1.0 / np.cos(angle) ** 2))
        arc = solve_skirt_arc(10.0, 10.6, 50.0, 1e9)
        assert plan.tension == pytest.approx(float(arc.tension), rel=1e-6)
        assert plan.sag == pytest.approx(float(arc.sagitta), rel=1e-4)


def test_oblique_plan_is_in_equilibrium() -> None:
    rng = np.random.default_rng(13)
    water = Water(12.0, 1025.0, 9.81)
    for _ in range(5):
        skirt = Skirt(rng.uniform(2, 9), rng.uniform(0, 5), rng.uniform(100, 500), math.inf)
        current = power_law(rng.uniform(0.1, 0.5), 1 / 7, 0.2, water)
        normal = 0.2 - rng.uniform(-1.0, 1.0)
        load = section_load(skirt, current, 0.2, normal, water, DRAG)
        plan = solve_plan(60.0, 60.0 * rng.uniform(1.02, 1.4), 1e7, load, intervals=2000)
        assert abs(plan.x[-1]) < 1e-5 * 60.0
        assert plan.y[-1] == pytest.approx(60.0, rel=1e-5)
        assert plan.arc[-1] == pytest.approx(plan.length * (1.0 + plan.strain), rel=1e-5)
        # a section solved at the local angle, at three places, is the load T dphi/ds there
        for place in (200, 900, 1700):
            bend = -(plan.angle[place + 1] - plan.angle[place - 1]) / (plan.arc[place + 1] - plan.arc[place - 1])
            heading = normal - plan.angle[place]
            local = solve_section(skirt, current, heading, water, DRAG).load
            if abs(plan.angle[place] + load.flow_angle) < 1.4:
                assert plan.tension * bend == pytest.approx(local, rel=2e-3)
        # the flow leans on the support it runs towards
        first, second = plan.downstream_end_forces
        if abs(load.flow_angle) > 0.05:
            assert (second > first) == (load.flow_angle > 0.0)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Skirt(5.0, 0.0, 0.0, 1e5), "toe_load"),
        (lambda: Skirt(5.0, 0.0, 10.0, 0.0), "stiffness"),
        (lambda: Skirt(5.0, -3.0, 10.0, 1e5), "floats"),
        (
            lambda: solve_section(Skirt(5.0, 0.0, 9.0, 1e5), uniform(1.0, 0.0), 0.0, Water(4.0, 1e3, 9.81), DRAG),
            "lie|lies on the bed",
        ),
        (
            lambda: solve_section(Skirt(5.0, 0.0, 9.0, 1e5), uniform(1.0, 0.0), 0.0, DEEP, DRAG, law="uniform_normal"),
            "overturns",
        ),
        (lambda: solve_plan(10.0, 9.0, math.inf, cosine_squared_load(1.0, 0.0)), "does not stretch"),
        (lambda: cosine_squared_load(1.0, 1.6), "less than 90"),
        (lambda: cosine_squared_load(0.0, 0.0), "greater than 0"),
        (lambda: closure_drag(0.3, (1, 1)), "contraction"),
        (lambda: DragLaw("x", (0.0,), (1.0,), (1.2, 1.5), ""), "range"),
        (lambda: under_toe_speed(uniform(1, 0), 0.0, 5.0, Water(4.0, 1e3, 9.81), 1.0), "toe"),
    ],
)
def test_refusals_of_section_and_plan(call, words) -> None:
    with pytest.raises(InputError, match=words):
        call()


def test_notices_of_the_drag() -> None:
    assert check_drag(DRAG, 0.1) == ()
    assert check_drag(DRAG, 0.6)[0].code == "curtain-blockage"
    assert check_drag(closure_drag(0.7, (1, 1)), 0.05)[0].code == "curtain-drag-range"
    assert DRAG.scaled(2.0).coefficient(0.3) == pytest.approx(3.0)
