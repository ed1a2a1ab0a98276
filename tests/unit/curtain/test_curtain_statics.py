"""A whole curtain at rest: identities, closed forms as special cases, limits, practice checks."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.sea.current import power_law, uniform
from moyai.sea.water import Water
from moyai.structures.curtain.checks import check_class, check_statics
from moyai.structures.curtain.limits.utilisation import (
    CurtainSite,
    Requirements,
    Strength,
    WaveLoad,
    anchor_spacing,
    drowning_speed,
    height_limit,
    joint_spacing,
    operating_limits,
    speed_limit,
    utilisation,
)
from moyai.structures.curtain.seas.anchor_energy import EnergyModel
from moyai.structures.curtain.statics.closed_forms import solve_cable
from moyai.structures.curtain.statics.drag import constant_drag
from moyai.structures.curtain.statics.hanging import (
    FloatLine,
    HangingCurtain,
    drag_range,
    solve_statics,
    submerged_state,
)
from moyai.structures.curtain.statics.planning import itopf_load, us_navy_load
from moyai.structures.curtain.statics.section import Skirt
from moyai.structures.curtain.statics.steady_load import SteadyState
from moyai.tables.curtain_classes import curtain_class, curtain_classes, mildest_class

WATER = Water(12.0, 1025.0, 9.81)
CURTAIN = HangingCurtain(
    span=20.0,
    length=23.0,
    skirt=Skirt(6.0, 5.0, 200.0, 1e6),
    floats=FloatLine(980.0, 100.0, 100.0),
    upper_stiffness=3e6,
    lower_stiffness=2e6,
    toe="free",
    anchor_slope=math.radians(20.0),
    drag=constant_drag(1.4, (0.8, 1.3), "test"),
    law="normal_velocity",
)
SITE = CurtainSite(WATER, lambda speed: power_law(speed, 1 / 7, 0.2, WATER), 0.2, 0.0, 1.0)
REQUIRED = Requirements(
    Strength(60e3, 3.0), Strength(60e3, 3.0), Strength(150e3, 4.0), Strength(80e3, 3.0), Strength(15e3, 1.5), 0.2, 3.0
)
WAVES = WaveLoad(EnergyModel(0.2, 300.0, 2e5, 2.0, 1.0, 1.0), lambda h: 3.86 * math.sqrt(h), 0.3, "normal", 1.8)


def test_stiff_toe_joins_cable_and_rigid_wall() -> None:
    """A skirt that cannot flare, square to a uniform current, is the closed form of the cable."""
    rng = np.random.default_rng(51)
    for _ in range(10):
        depth, speed = rng.uniform(1, 8), rng.uniform(0.05, 1.0)
        skirt = Skirt(depth, 0.0, 1e9, math.inf)
        curtain = replace(CURTAIN, skirt=skirt, span=20.0, length=20.0 * rng.uniform(1.02, 1.5))
        found = solve_statics(curtain, uniform(speed, 0.0), 0.0, 0.0, WATER, passing_fraction=1.0)
        load = 0.5 * 1025.0 * 1.4 * speed**2 * depth
        cable = solve_cable(20.0, curtain.length, load, 3e6)
        assert found.section.load == pytest.approx(load, rel=1e-8)
        assert found.plan.tension == pytest.approx(float(cable.tension), rel=1e-6)
        assert found.anchor_horizontal_tension == pytest.approx(2.0 * float(cable.downstream_end_force), rel=1e-6)
        assert found.end_anchor_horizontal_tension == pytest.approx(float(cable.tension), rel=1e-6)
        assert found.toe_speed == pytest.approx(speed * 12.0 / (12.0 - depth), rel=1e-8)


def test_split_between_the_cables_and_the_floats_balance() -> None:
    for toe in ("free", "held"):
        found = solve_statics(replace(CURTAIN, toe=toe), SITE.current(0.3), 0.2, 0.0, WATER, passing_fraction=1.0)
        assert found.upper_tension + found.lower_tension == pytest.approx(found.plan.tension, rel=1e-12)
        assert (found.lower_tension == 0.0) == (toe == "free")
        anchors = found.anchor_tension * math.sin(CURTAIN.anchor_slope) / CURTAIN.span
        total = CURTAIN.floats.weight + found.section.top_pull + anchors + found.float_reserve
        assert total == pytest.approx(980.0, rel=1e-12)
        assert found.toe_gap + found.section.toe_depth == pytest.approx(12.0, rel=1e-12)


def test_range_of_the_drag_bounds_the_result() -> None:
    low, middle, high = drag_range(CURTAIN, SITE.current(0.3), 0.2, 0.0, WATER, passing_fraction=1.0)
    assert low.plan.tension < middle.plan.tension < high.plan.tension
    assert low.section.effective_depth > middle.section.effective_depth > high.section.effective_depth


def test_held_under_water() -> None:
    deep = solve_statics(CURTAIN, SITE.current(0.3), 0.2, 0.0, WATER, passing_fraction=1.0, top_depth=3.0)
    assert deep.section.z[0] == pytest.approx(-3.0, abs=1e-9)
    assert deep.section.toe_depth == pytest.approx(3.0 + deep.section.effective_depth, rel=1e-9)


def test_flooded_floats() -> None:
    state = submerged_state(CURTAIN, WATER)
    assert state.sinks
    assert state.net_weight == pytest.approx(200.0 + 30.0 + 100.0 - 100.0)
    assert state.air_to_surface * 1025.0 * 9.81 == pytest.approx(state.net_weight, rel=1e-12)
    floating = submerged_state(replace(CURTAIN, floats=FloatLine(980.0, 100.0, 600.0)), WATER)
    assert not floating.sinks
    assert floating.holding_buoyancy == 0.0


def afloat(speed: float) -> SteadyState:
    return SITE.with_floats(SITE.statics(CURTAIN, speed), speed)


def test_limit_of_the_current_is_where_a_component_is_full() -> None:
    limit = speed_limit(CURTAIN, SITE, REQUIRED, highest=2.0)
    parts = utilisation(afloat(limit.value), REQUIRED, 0.0)
    assert max(parts.values()) == pytest.approx(1.0, abs=1e-6)
    assert max(parts, key=lambda key: parts[key]) == limit.governing
    beyond = utilisation(afloat(limit.value * 1.01), REQUIRED, 0.0)
    assert max(beyond.values()) > 1.0
    assert speed_limit(CURTAIN, SITE, REQUIRED, highest=0.02).governing == "not reached"


def test_limit_of_the_waves_is_where_the_anchor_is_full() -> None:
    for speed in (0.05, 0.1):
        limit = height_limit(CURTAIN, SITE, REQUIRED, WAVES, speed=speed, highest=3.0)
        assert limit.governing in ("anchor", "anchor line")
        statics = SITE.statics(CURTAIN, speed)
        rise = WAVES.tension(limit.value, speed, statics.anchor_tension, WATER)
        assert max(utilisation(afloat(speed), REQUIRED, rise).values()) == pytest.approx(1.0, abs=1e-6)
    table = operating_limits(CURTAIN, SITE, REQUIRED, WAVES, speeds=(0.05, 0.1, 2.0), highest=3.0)
    heights = [row[1].value for row in table]
    assert heights[0] > heights[1] > heights[2] == 0.0


def test_interrupted_table_keeps_its_rows() -> None:
    def stop(what: str, done: float, total: float) -> None:
        if done >= 1:
            raise KeyboardInterrupt

    table = operating_limits(CURTAIN, SITE, REQUIRED, WAVES, speeds=(0.05, 0.1), highest=3.0, progress=stop)
    assert len(table) == 1


def test_floats_drown_where_the_anchor_lines_pull_them_under() -> None:
    steep = replace(CURTAIN, anchor_slope=math.radians(75.0), skirt=Skirt(6.0, 5.0, 600.0, math.inf))
    speed = drowning_speed(steep, SITE, highest=3.0)
    # by hand: what the skirt leaves of the buoyancy is what the lines pull down for the drag of floats that are awash
    left = SITE.statics(steep, speed).float_reserve
    diameter = math.sqrt(4.0 * steep.floats.buoyancy / (WATER.density * WATER.gravity) / math.pi)
    drag = 0.5 * WATER.density * 1.2 * speed**2 * diameter
    statics = SITE.statics(steep, speed)
    pulled = drag / statics.section.load * statics.anchor_horizontal_tension * math.tan(steep.anchor_slope) / steep.span
    # nearly awash, the last of a round float goes under by itself: its draught grows faster than its buoyancy
    assert 0.9 * pulled < left <= pulled
    # without that drag they drown in a stronger current
    notices = check_statics(SITE.statics(steep, 1.5 * speed), 1.5 * speed, WATER)
    assert "curtain-floats-drown" in {notice.code for notice in notices}
    flat = replace(CURTAIN, anchor_slope=0.0)
    assert drowning_speed(flat, SITE, highest=1.0) == math.inf
    with pytest.raises(InputError, match="larger floats"):
        drowning_speed(replace(CURTAIN, floats=FloatLine(300.0, 100.0, 100.0)), SITE, highest=1.0)


def test_anchor_spacing_is_in_proportion_to_strength() -> None:
    """At one ratio of span to length an inextensible curtain scales: twice the strength, twice the distance."""
    stiff = replace(CURTAIN, upper_stiffness=math.inf)
    strong = Strength(1e9, 1.0)
    required = Requirements(strong, strong, strong, strong, Strength(2e3, 1.0), 0.0, 0.0)
    one = anchor_spacing(stiff, SITE, required, speed=0.3, longest=300.0, wave_tension=0.0)
    two = anchor_spacing(
        stiff, SITE, replace(required, anchor=Strength(4e3, 1.0)), speed=0.3, longest=300.0, wave_tension=0.0
    )
    assert one.governing == two.governing == "anchor"
    assert two.value == pytest.approx(2.0 * one.value, rel=1e-6)
    assert joint_spacing(200.0, Strength(9e3, 3.0)) == pytest.approx(15.0)


def test_planning_formulas_as_drag_coefficients() -> None:
    """US Navy's 26 A V^2 equals C_D = 1.88, ITOPF's 100 A V^2 7.2, in sea water."""
    navy, itopf = us_navy_load(12.0, 0.7, 1025.0), itopf_load(12.0, 0.7, 1025.0)
    assert navy.drag_coefficient == pytest.approx(1.88, abs=5e-3)
    assert itopf.drag_coefficient == pytest.approx(7.2, abs=0.05)
    assert navy.force == pytest.approx(26.0 * 12.0 * (0.7 * 3600 / 1852) ** 2 * 9.80665, rel=1e-12)
    assert navy.force == pytest.approx(0.5 * 1025.0 * navy.drag_coefficient * 12.0 * 0.49, rel=1e-12)


def test_classes_of_the_table() -> None:
    assert curtain_class("A").float_buoyancy == 2352.0
    assert curtain_class("B").fabric_strength[1] == pytest.approx(7846.0 / 0.03)
    assert mildest_class(0.7, 0.08).name == "C"
    assert mildest_class(0.3, 0.2).name == "B"
    assert mildest_class(2.0, 0.2) is None
    assert mildest_class(0.3, 1.2, "United States").name == "III"
    assert all(not entry.confirmed for entry in curtain_classes() if entry.practice == "United States")
    with pytest.raises(InputError, match="did you mean"):
        curtain_class("iv")


def test_checks_against_class_and_practice() -> None:
    statics = SITE.statics(CURTAIN, 0.3)
    notices = check_class(curtain_class("B"), 1.2, 0.3, statics, 4.0, 2e5)
    assert {notice.code for notice in notices} == {
        "curtain-class-wave-height",
        "curtain-class-current",
        "curtain-class-chain",
    }
    assert check_class(curtain_class("B"), 0.9, 0.1, statics, 6.0, 2e5) == ()
    codes = {notice.code for notice in check_statics(statics, 0.3, WATER)}
    assert "curtain-current-rule" in codes
    long = replace(CURTAIN, span=40.0, length=41.0, skirt=Skirt(11.9, 5.0, 2000.0, math.inf))
    codes = {notice.code for notice in check_statics(SITE.statics(long, 0.05), 0.05, WATER)}
    assert {"curtain-anchor-span", "curtain-extra-length", "curtain-toe-gap"} <= codes


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: FloatLine(100.0, 10.0, 200.0), "flooded"),
        (lambda: Strength(0.0, 3.0), "capacity"),
        (lambda: replace(REQUIRED, least_reserve=1.0), "least reserve"),
        (lambda: replace(CURTAIN, anchor_slope=1.6), "anchor slope"),
        (lambda: SITE.statics(CURTAIN, 0.0), "give a current"),
        (lambda: CurtainSite(WATER, SITE.current, 0.2, 2.0, 1.0).statics(CURTAIN, 0.2), "less than 90"),
    ],
)
def test_refusals_of_the_statics(call, words) -> None:
    with pytest.raises(InputError, match=words):
        call()
