"""Sections by their curve against the direct solution; which currents share a curve; plan by steps and by brackets."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.current import CurrentProfile, power_law, table, uniform
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import DragLaw, closure_drag, constant_drag, gap_speed_drag
from moyai.structures.curtain.statics.plan import _Integrals, _Span, section_load
from moyai.structures.curtain.statics.section import Skirt, solve_section
from moyai.structures.curtain.statics.section_curve import SectionFamily, current_shape, section_family

LAWS = ("normal_velocity", "free_streamline", "uniform_normal")
WIDEST = math.radians(85.0)
CONSTANT = constant_drag(1.5, (0.8, 1.3), "test")


def random_case(rng: np.random.Generator) -> tuple[Skirt, CurrentProfile, Water, DragLaw, dict]:
    water = Water(rng.uniform(6, 30), 1025.0, 9.81)
    length = water.depth * rng.uniform(0.2, 0.9)
    stiffness = math.inf if rng.random() < 0.2 else 10.0 ** rng.uniform(4.5, 7)
    skirt = Skirt(length, rng.uniform(-2.0, 15.0), rng.uniform(80, 800), stiffness)
    speed, heading = 10.0 ** rng.uniform(-2.5, 0.2), rng.uniform(-3, 3)
    current = uniform(speed, heading) if rng.random() < 0.5 else power_law(speed, rng.uniform(0.1, 0.4), heading, water)
    drag = (CONSTANT, gap_speed_drag(1.2, (1, 1), ""), closure_drag(0.7, (1, 1)))[rng.integers(3)]
    settings = {"law": LAWS[rng.integers(3)], "toe": ("free", "held")[rng.integers(2)], "top_depth": 0.0}
    settings["friction"] = 0.02 if drag is CONSTANT and rng.random() < 0.4 else 0.0
    return skirt, current, water, drag, settings


def family_of(skirt: Skirt, current: CurrentProfile, water: Water, drag: DragLaw, settings: dict) -> SectionFamily:
    found = section_family(skirt, current, water.depth, water.density, drag, **settings)
    assert found is not None
    return found


@pytest.mark.slow
def test_the_curve_gives_what_the_direct_solution_gives() -> None:
    """Random skirts, laws, drag laws, friction, toes, angles: to 1e-8, and nearly always from the curve."""
    rng, asked, answered = np.random.default_rng(31), 0, 0
    for _ in range(60):
        skirt, current, water, drag, settings = random_case(rng)
        along = math.atan2(*current.velocity(0.0)[::-1])
        headings = along - rng.uniform(-WIDEST, WIDEST, 3)
        found = family_of(skirt, current, water, drag, settings).loads(headings, water.depth)
        for heading, load in zip(headings, found):
            try:
                direct = solve_section(skirt, current, heading, water, drag, **settings)
            except InputError:
                assert math.isnan(load)
                continue
            asked, answered = asked + 1, answered + math.isfinite(load)
            if math.isfinite(load):
                assert load == pytest.approx(direct.load, rel=1e-8)
    assert answered > 0.9 * asked > 100


def test_a_start_from_the_curve_leads_to_the_same_section() -> None:
    rng = np.random.default_rng(32)
    for _ in range(20):
        skirt, current, water, drag, settings = random_case(rng)
        heading = math.atan2(*current.velocity(0.0)[::-1])
        try:
            direct = solve_section(skirt, current, heading, water, drag, **settings)
        except InputError:
            continue
        start = family_of(skirt, current, water, drag, settings).start(heading)
        found = solve_section(skirt, current, heading, water, drag, near=start, **settings)
        for name in ("load", "top_pull", "effective_depth", "sheet_tension", "toe_hold", "drag_coefficient"):
            # the search ends where the top leans by 1e-12 of the length: that much of the toe load
            small = 1e-11 * skirt.toe_load
            assert getattr(found, name) == pytest.approx(getattr(direct, name), rel=1e-10, abs=small), name
        np.testing.assert_allclose(found.x, direct.x, atol=1e-9 * skirt.length)


def test_a_curve_does_not_depend_on_what_was_asked_before() -> None:
    from moyai.structures.curtain.statics.section_curve import SectionCurve

    skirt, water = Skirt(6.0, 4.0, 170.0, 9e5), Water(12.0, 1025.0, 9.81)
    settings = {"law": "normal_velocity", "toe": "held", "top_depth": 0.0, "friction": 0.0}
    kind = family_of(skirt, uniform(0.3, 0.0), water, CONSTANT, settings).curve.kind
    places = np.geomspace(0.01, 400.0, 40)
    once, piece_by_piece = SectionCurve(kind), SectionCurve(kind)
    whole = once.at(places)
    np.testing.assert_array_equal(np.array([piece_by_piece.at(place[None])[0] for place in places]), whole)
    np.testing.assert_array_equal(once.at(-places), whole)


def test_speed_and_heading_leave_the_curve_of_a_current() -> None:
    water, skirt = Water(12.0, 1025.0, 9.81), Skirt(6.0, 4.0, 170.0, 9e5)
    settings = {"law": "normal_velocity", "toe": "free", "top_depth": 0.0, "friction": 0.0}
    heights, shares = [0.0, -4.0, -12.0], np.array([1.0, 0.7, 0.2])
    for make in (
        lambda speed, heading: uniform(speed, heading),
        lambda speed, heading: power_law(speed, 0.143, heading, water),
        lambda speed, heading: table(heights, speed * shares, heading),
    ):
        families = [family_of(skirt, make(*one), water, CONSTANT, settings) for one in ((0.3, 0.0), (0.171, 2.2))]
        assert families[0].curve is families[1].curve
        for family, (speed, heading) in zip(families, ((0.3, 0.0), (0.171, 2.2))):
            direct = solve_section(skirt, make(speed, heading), heading + 0.4, water, CONSTANT, **settings)
            assert family.shape.speeds(np.array([heading + 0.4]))[0] == pytest.approx(speed * math.cos(0.4))
            load = family.loads(np.array([heading + 0.4]), 12.0)[0]
            assert math.isnan(load) or load == pytest.approx(direct.load, rel=1e-6)
    assert current_shape(table(heights, 0.3 * shares, [0.0, 0.2, 0.4])) is None
    assert current_shape(uniform(0.0, 0.0)) is None


def test_loads_of_all_angles_are_the_same_by_curve_and_directly() -> None:
    rng, count = np.random.default_rng(33), 0
    for _ in range(12):
        skirt, current, water, drag, settings = random_case(rng)
        along = math.atan2(*current.velocity(0.0)[::-1])
        arguments = (skirt, current, along, along, water, drag)
        try:
            direct = section_load(*arguments, by_curve=False, **settings)
        except InputError:
            continue
        found = section_load(*arguments, **settings)
        assert found.across == pytest.approx(direct.across, rel=1e-8)
        np.testing.assert_allclose(found.ratio, direct.ratio, rtol=1e-8)
        count += 1
    assert count > 6


def test_a_skirt_without_room_is_refused_by_the_curve_too() -> None:
    water = Water(6.0, 1025.0, 9.81)
    with pytest.raises(InputError, match=r"6\.5 m"):
        section_load(Skirt(6.5, 4.0, 170.0, 9e5), uniform(0.3, 0.0), 0.0, 0.0, water, CONSTANT)
    # hanging by its stretch into the bed where the current hardly presses, by more than a thousandth of the depth
    with pytest.raises(InputError, match="deeper than the water"):
        section_load(Skirt(5.99, 4.0, 170.0, 4e4), uniform(0.05, 0.0), 0.0, 0.0, water, CONSTANT)


@pytest.mark.slow
def test_plan_by_steps_is_that_by_brackets() -> None:
    rng, arrived = np.random.default_rng(34), 0
    for _ in range(30):
        skirt, _, water, _, settings = random_case(rng)
        angle = rng.uniform(-1.3, 1.3)
        settings["law"] = "normal_velocity"
        load = section_load(skirt, uniform(rng.uniform(0.05, 0.8), angle), angle, 0.0, water, CONSTANT, **settings)
        span = rng.uniform(5, 200)
        within = _Span(
            span * math.cos(angle), span * rng.uniform(1.0, 1.5), 10.0 ** rng.uniform(5, 8), _Integrals(load)
        )
        quick = within.by_steps()
        if quick is not None:
            arrived += 1
            np.testing.assert_allclose(quick, within.by_brackets(), rtol=1e-11, atol=1e-12)
    assert arrived > 25
