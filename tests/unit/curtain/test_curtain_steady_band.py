"""The governing steady load: force balance, its bound by the weights, its band, friction, the gap that closes."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.sea.current import uniform
from moyai.sea.water import Water
from moyai.structures.curtain.limits.utilisation import CurtainSite
from moyai.structures.curtain.statics.closed_forms import solve_cable
from moyai.structures.curtain.statics.drag import constant_drag, gap_speed_drag
from moyai.structures.curtain.statics.hanging import FloatLine, HangingCurtain
from moyai.structures.curtain.statics.section import Skirt, solve_section
from moyai.structures.curtain.statics.steady_load import (
    QUANTITIES,
    SteadyState,
    drag_factors,
    float_drag,
    partial_gap_drag,
    steady_load,
)

WATER = Water(12.0, 1025.0, 9.81)


def random_curtain(rng, toe="free"):
    span = rng.uniform(10.0, 40.0)
    return HangingCurtain(
        span=span,
        length=span * rng.uniform(1.05, 1.2),
        skirt=Skirt(rng.uniform(2.0, 6.0), rng.uniform(0.0, 6.0), rng.uniform(40.0, 200.0), 9e5),
        floats=FloatLine(2400.0, 100.0, 2400.0),
        upper_stiffness=2e6,
        lower_stiffness=2e6,
        toe=toe,
        anchor_slope=0.2,
        drag=constant_drag(1.5, (1.0, 1.0), "test"),
        law="normal_velocity",
    )


def load_of(curtain, speed, along=0.0):
    site = CurtainSite(WATER, lambda value: uniform(value, 0.0), 0.0, 0.0, 0.5)
    return steady_load(
        curtain,
        lambda item: site.statics(item, speed),
        WATER,
        toe_range=(0.9, 1.1),
        passing_fraction=0.5,
        surface_speed=speed,
        along_speed=along,
    )


@pytest.mark.parametrize("toe", ["free", "held"])
def test_load_is_the_force_balance(toe):
    """Pressure integrated over the drawn section is what its top and toe bear; the span's is what its ends bear."""
    rng = np.random.default_rng(7)
    for _ in range(3):
        speed = rng.uniform(0.1, 0.5)
        steady = load_of(random_curtain(rng, toe), speed)
        statics = steady.governing.statics
        x, z = statics.section.x, statics.section.z
        step = np.hypot(np.diff(x), np.diff(z))
        down = -np.diff(z) / step
        pressure = 0.5 * WATER.density * 1.5 * speed**2
        total = float(np.sum(pressure * down * np.abs(down) * down * step))
        assert steady.governing.quantity("line_load") == pytest.approx(total, rel=1e-3)
        ends = sum(statics.plan.downstream_end_forces)
        assert steady.governing.quantity("span_load") == pytest.approx(ends, rel=1e-12)
        # oblique parts take at most what the middle takes, at least cos^2 of it
        share = ends / (statics.section.load * statics.plan.span)
        assert 0.7 < share < 1.001


def test_weights_bound_the_load_of_a_free_toe_at_any_drag():
    rng = np.random.default_rng(8)
    for _ in range(6):
        curtain = random_curtain(rng)
        bound = curtain.skirt.toe_load + curtain.skirt.submerged_weight * curtain.skirt.length
        for coefficient in (0.5, 2.0, 20.0):
            given = replace(curtain, drag=constant_drag(coefficient, (1.0, 1.0), "test"))
            found = solve_section(given.skirt, uniform(0.6, 0.0), 0.0, WATER, given.drag)
            assert found.load < bound
        assert load_of(curtain, 0.3).bound == pytest.approx(bound, rel=1e-12)
    assert math.isinf(load_of(random_curtain(rng, "held"), 0.2).bound)


@pytest.mark.parametrize("toe", ["free", "held"])
def test_band_holds_every_state_and_load_rises_with_it(toe):
    rng = np.random.default_rng(9)
    for _ in range(3):
        steady = load_of(random_curtain(rng, toe), rng.uniform(0.1, 0.4))
        for name, _, _ in QUANTITIES:
            low, high = steady.band(name)
            values = [state.quantity(name) for state in (steady.governing, *steady.causes)]
            assert low <= min(values) and max(values) <= high
        assert steady.lowest.quantity("line_load") < steady.governing.quantity("line_load")
        one = max(state.quantity("line_load") for state in steady.causes)
        assert steady.highest.quantity("line_load") >= one
        assert steady.factor > 1.0


def test_drag_of_the_floats_goes_into_cables_and_anchors():
    curtain = random_curtain(np.random.default_rng(10))
    steady = load_of(curtain, 0.3)
    plain = steady.governing
    more = SteadyState("more", plain.statics, 0.1 * plain.quantity("line_load"))
    for name in ("line_load", "cable_tension", "upper_tension", "anchor_horizontal_tension", "anchor_tension"):
        assert more.quantity(name) == pytest.approx(1.1 * plain.quantity(name), rel=1e-12)
    assert more.quantity("sheet_tension") == plain.quantity("sheet_tension")
    # half of a round float's buoyancy in use: its draught is its radius
    statics = plain.statics
    half = replace(statics, float_reserve=0.5 * curtain.floats.buoyancy)
    radius = math.sqrt(curtain.floats.buoyancy / (WATER.density * WATER.gravity * math.pi))
    assert float_drag(half, WATER, 0.3) == pytest.approx(0.5 * 1025.0 * 1.2 * 0.09 * radius, rel=1e-9)


def test_partial_gap_lies_between_the_constant_law_and_the_gap_speed():
    law = constant_drag(1.5, (1.0, 1.0), "test")
    none, half, all_ = (partial_gap_drag(law, share).coefficient(0.5) for share in (0.0, 0.5, 1.0))
    assert none == pytest.approx(1.5) and none < half < all_
    assert half == pytest.approx(1.5 * 1.5**2, rel=1e-4)
    assert all_ == pytest.approx(gap_speed_drag(1.5, (1.0, 1.0), "test").coefficient(0.5), rel=1e-4)


def test_sources_bound_the_drag_where_the_case_is_silent():
    low, high = drag_factors(constant_drag(1.5, (1.0, 1.0), "test"))
    assert (1.5 * low, 1.5 * high) == pytest.approx((1.2, 2.0))
    assert drag_factors(constant_drag(1.5, (0.7, 1.2), "test")) == (0.7, 1.2)
    assert drag_factors(constant_drag(2.2, (1.0, 1.0), "test"))[1] == 1.0
    assert drag_factors(gap_speed_drag(1.5, (1.0, 1.0), "test")) == (0.8, 1.4)


def test_friction_pulls_along_the_sheet():
    """A skirt that streams away bears friction on its whole length; a straight one, hanging, none."""
    water, drag = Water(40.0, 1025.0, 9.81), constant_drag(1.5, (1.0, 1.0), "test")
    skirt = Skirt(10.0, 0.0, 5.0, 1e9)
    current = uniform(1.0, 0.0)
    plain = solve_section(skirt, current, 0.0, water, drag)
    rough = solve_section(skirt, current, 0.0, water, drag, friction=0.02)
    # nearly horizontal all the way: C_t rho/2 U^2 L to 3 %
    pull = 0.5 * 1025.0 * 0.02 * 10.0
    assert rough.tension[0] - rough.tension[-1] == pytest.approx(pull, rel=0.03)
    assert plain.tension[0] == pytest.approx(plain.tension[-1], rel=1e-9)
    steep = solve_section(Skirt(3.0, 0.0, 5e4, 1e9), uniform(0.1, 0.0), 0.0, water, drag, friction=0.02)
    assert steep.tension[0] == pytest.approx(steep.tension[-1], rel=1e-9)


def test_cable_of_the_plan_is_bounded_by_the_closed_form():
    """The plan's load falls off less than cos^2 of the angle, as an oblique part flares less."""
    rng = np.random.default_rng(11)
    for _ in range(4):
        curtain = random_curtain(rng)
        steady = load_of(curtain, 0.3)
        line = steady.governing.quantity("line_load")
        closed = float(solve_cable(curtain.span, curtain.length, line, curtain.axial_stiffness).tension)
        assert steady.governing.quantity("cable_tension") >= closed * (1.0 - 1e-6)


def test_friction_along_the_span_goes_into_the_upper_ends_of_cable_and_anchors():
    """Half of it at either end of the cable, all of it on the support between two spans, nothing on the load itself."""
    curtain = random_curtain(np.random.default_rng(4), "free")
    still, along = (load_of(curtain, 0.2, along=speed) for speed in (0.0, 0.5))
    wetted = min(curtain.skirt.length, WATER.depth) * curtain.length
    force = 0.5 * WATER.density * 0.02 * 0.5**2 * wetted
    for name, share in (("upper_tension", 0.5), ("cable_tension", 0.5), ("end_anchor_horizontal_tension", 0.5)):
        assert along.highest.quantity(name) == pytest.approx(still.highest.quantity(name) + share * force, rel=1e-12)
    level = still.highest.quantity("anchor_horizontal_tension")
    assert along.highest.quantity("anchor_horizontal_tension") == pytest.approx(np.hypot(level, force), rel=1e-12)
    ratio = along.highest.quantity("anchor_tension") / still.highest.quantity("anchor_tension")
    assert ratio == pytest.approx(np.hypot(level, force) / level, rel=1e-12)
    assert along.band("line_load") == still.band("line_load")
    assert along.governing.quantity("upper_tension") == still.governing.quantity("upper_tension")


def test_two_cables_share_the_friction_along_the_span():
    curtain = random_curtain(np.random.default_rng(4), "held")
    still, along = (load_of(curtain, 0.2, along=speed).highest for speed in (0.0, 0.5))
    more = {name: along.quantity(name) - still.quantity(name) for name in ("upper_tension", "lower_tension")}
    assert more["lower_tension"] == pytest.approx(0.25 * along.along, rel=1e-9)
    assert more["upper_tension"] == pytest.approx(more["lower_tension"], rel=1e-9)
