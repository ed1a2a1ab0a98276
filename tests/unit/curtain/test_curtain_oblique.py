"""Curtains in oblique currents: the section that is reported, and the flow under the toe."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.sea.current import power_law, table, uniform
from moyai.sea.water import Water
from moyai.structures.curtain.statics.drag import constant_drag, under_toe_speed
from moyai.structures.curtain.statics.hanging import FloatLine, HangingCurtain, solve_statics
from moyai.structures.curtain.statics.section import Skirt, solve_section

WATER = Water(9.0, 1025.0, 9.81)
CURTAIN = HangingCurtain(
    span=15.0,
    length=15.3,
    skirt=Skirt(5.0, 4.0, 200.0, 9e5),
    floats=FloatLine(980.0, 100.0, 100.0),
    upper_stiffness=1e6,
    lower_stiffness=0.0,
    toe="free",
    anchor_slope=math.radians(20.0),
    drag=constant_drag(1.5, (0.8, 1.3), "test"),
    law="normal_velocity",
)


def test_section_is_where_the_span_faces_the_current_most() -> None:
    """A tight span has no part across a very oblique current: its most loaded section alone is reported."""
    rng = np.random.default_rng(63)
    for _ in range(4):
        speed, turn = rng.uniform(0.2, 0.4), rng.choice([-1.0, 1.0]) * rng.uniform(0.7, 1.2)
        current = power_law(speed, 0.15, turn, WATER)
        found = solve_statics(CURTAIN, current, turn, 0.0, WATER, passing_fraction=0.5)
        local = found.plan.angle + turn
        assert np.abs(local).min() > 0.1
        nearest = local[np.argmin(np.abs(local))]
        assert math.remainder(found.section_heading - (turn - nearest), 2.0 * math.pi) == pytest.approx(0.0, abs=1e-12)
        alone = solve_section(CURTAIN.skirt, current, turn - nearest, WATER, CURTAIN.drag)
        assert found.section.load == pytest.approx(alone.load, rel=1e-12)
        facing = solve_section(CURTAIN.skirt, current, turn, WATER, CURTAIN.drag)
        assert found.section.load < facing.load and found.section.effective_depth > facing.effective_depth


def test_section_of_a_slack_span_lies_across_the_current() -> None:
    slack = replace(CURTAIN, length=18.0)
    found = solve_statics(slack, uniform(0.3, 0.4), 0.4, 0.0, WATER, passing_fraction=0.5)
    assert found.section_heading == 0.4


def test_only_the_flow_across_the_curtain_is_held_up() -> None:
    rng = np.random.default_rng(64)
    for turn in (0.0, *rng.uniform(-1.4, 1.4, 4)):
        current = power_law(0.3, 0.2, turn, WATER)
        found = solve_statics(CURTAIN, current, turn, 0.0, WATER, passing_fraction=0.7)
        depth = found.section.toe_depth
        free = float(np.hypot(*current.depth_mean(-9.0, -depth)))
        held = float(np.hypot(*current.depth_mean(-depth, 0.0)))
        across = math.cos(turn) * (free + 0.7 * held * depth / (9.0 - depth))
        assert found.toe_speed == pytest.approx(math.hypot(across, free * math.sin(turn)), rel=1e-12)
        assert found.toe_speed_ratio == pytest.approx(found.toe_speed / free, rel=1e-12)
    along = solve_statics(CURTAIN, uniform(0.3, 1.55), 1.55, 0.0, WATER, passing_fraction=1.0)
    assert along.toe_speed == pytest.approx(0.3, rel=5e-3)
    # a current that turns over the depth: what crosses the line between the supports
    turning = table([-9.0, -4.0, 0.0], [0.1, 0.2, 0.3], [0.5, 0.2, 0.1])
    found = solve_statics(CURTAIN, turning, 0.15, 0.0, WATER, passing_fraction=0.0)
    depth = found.section.toe_depth
    assert under_toe_speed(turning, 0.0, depth, WATER, 0.0) == pytest.approx(turning.depth_mean(-9.0, -depth)[0])
    assert found.toe_speed_ratio == pytest.approx(1.0, rel=1e-12)
