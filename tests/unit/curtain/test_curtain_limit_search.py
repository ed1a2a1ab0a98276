"""Limits are searched over the whole range: the smallest crossing counts, nothing is taken to be monotone."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
import xarray as xr

from moyai.sea.current import uniform
from moyai.sea.water import Water
from moyai.structures.curtain.analyses.limits import CountedLimits
from moyai.structures.curtain.limit_headlines import limit_headlines
from moyai.structures.curtain.limits.search import NOT_REACHED, Limit, search
from moyai.structures.curtain.limits.utilisation import (
    CurtainSite,
    Requirements,
    Strength,
    anchor_spacing,
    fixed_failures,
    joint_spacing,
    speed_limit,
)
from moyai.structures.curtain.snaps.snap_table import SnapTable
from moyai.structures.curtain.statics.drag import constant_drag
from moyai.structures.curtain.statics.hanging import FloatLine, HangingCurtain
from moyai.structures.curtain.statics.section import Skirt

UNJUDGED = Strength(math.inf, 1.0)
WATER = Water(12.0, 1025.0, 9.81)
SITE = CurtainSite(WATER, lambda speed: uniform(speed, 0.0), 0.0, 0.0, 0.5)


#: Random curtains of a test: two in the fast suite
SAMPLES = pytest.mark.parametrize("count", [2, pytest.param(6, marks=pytest.mark.slow)])


def required(**given):
    plain = {
        name: given.get(name, UNJUDGED) for name in ("upper_cable", "lower_cable", "sheet", "anchor_line", "anchor")
    }
    return Requirements(**plain, least_reserve=0.0, least_depth=given.get("least_depth", 0.0))


def curtains(seed, count):
    rng = np.random.default_rng(seed)
    for _ in range(count):
        span = rng.uniform(10.0, 40.0)
        yield HangingCurtain(
            span=span,
            length=span * rng.uniform(1.05, 1.2),
            skirt=Skirt(rng.uniform(2.0, 6.0), rng.uniform(0.0, 6.0), rng.uniform(40.0, 200.0), 9e5),
            floats=FloatLine(2400.0, 100.0, 2400.0),
            upper_stiffness=2e6,
            lower_stiffness=0.0,
            toe="free",
            anchor_slope=rng.uniform(0.1, 0.4),
            drag=constant_drag(rng.uniform(1.2, 2.0), (1.0, 1.0), "test"),
            law="normal_velocity",
        )


@pytest.mark.parametrize("at_rest", [0.5, 2.0])
def test_the_first_crossing_alone_is_that_of_the_whole_search(at_rest):
    looked: list[float] = []

    def worst(x):
        looked.append(x)
        return (at_rest if x == 0.0 else 0.5 + x**2 if x <= 0.9 else 0.2), "part"

    first = search(worst, 1.2, first_only=True)
    assert max(looked) < 0.8
    whole = search(worst, 1.2)
    assert max(looked) == 1.2 and len(whole.crossings) > 1
    assert (first.value, first.governing, first.ratio) == (whole.value, whole.governing, whole.ratio)
    assert first.crossings == whole.crossings[:1] or at_rest > 1.0


def test_smallest_of_several_crossings_is_the_limit():
    """Halving the range looks at 0.5, which holds, and ends at 0.7."""
    found = search(lambda x: (0.5 if x <= 0.3 or 0.45 <= x <= 0.7 else 2.0, "part"), 1.0)
    assert found.value == pytest.approx(0.3, rel=1e-6) and found.governing == "part"
    assert found.crossings == pytest.approx((0.3, 0.45, 0.7), rel=1e-6)
    assert found.ratio == 2.0


def test_a_hump_inside_a_range_that_holds_at_its_end_is_found():
    """Only the end was looked at before the range was called free of limits."""
    found = search(lambda x: (1.5 - 8.0 * abs(x - 0.4), "hump"), 1.0)
    assert found.value == pytest.approx(0.3375, rel=1e-6) and found.reached
    assert found.crossings == pytest.approx((0.3375, 0.4625), rel=1e-6)


def test_nothing_found_and_nothing_held_are_distinguished():
    free = search(lambda x: (0.2, "part"), 3.0)
    assert (free.value, free.governing, free.reached, free.highest) == (3.0, NOT_REACHED, False, 3.0)
    none = search(lambda x: (1.7, "effective depth"), 3.0)
    assert (none.value, none.governing, none.ratio) == (0.0, "effective depth", 1.7)
    later = search(lambda x: (0.5 if x > 1.2 else 1.7, "part"), 3.0)
    assert later.value == 0.0 and later.crossings == pytest.approx((1.2,), rel=1e-6)


def test_states_without_equilibrium_end_the_range():
    found = search(lambda x: (0.1, "part") if x < 0.77 else (math.inf, "no equilibrium"), 1.0)
    assert found.value == pytest.approx(0.77, rel=1e-6) and found.governing == "no equilibrium"


def test_limit_rises_with_strength():
    """Any utilisation that a strength divides, rising or not."""
    rng = np.random.default_rng(4)
    for _ in range(40):
        a, b, c = rng.uniform(0.5, 2.0), rng.uniform(0.2, 1.0), rng.uniform(2.0, 9.0)

        def load(x, a=a, b=b, c=c):
            return a * x**2 + b * math.sin(c * x)

        values = [search(lambda x, s=s: (load(x) / s, "part"), 2.0).value for s in (0.4, 0.8, 1.6, 3.2)]
        assert np.all(np.diff(values) >= -1e-9)


@pytest.mark.slow
@SAMPLES
def test_current_that_keeps_the_depth_rises_with_the_toe_weight(count):
    for curtain in curtains(1, count):
        need = required(least_depth=0.8 * curtain.skirt.length)
        values = []
        for factor in (0.7, 1.0, 1.5):
            heavy = replace(curtain, skirt=replace(curtain.skirt, toe_load=factor * curtain.skirt.toe_load))
            found = speed_limit(heavy, SITE, need, highest=2.0)
            assert found.governing == "effective depth"
            values.append(found.value)
        assert values == sorted(values) and values[0] < values[-1]


@pytest.mark.slow
@SAMPLES
def test_current_that_an_anchor_holds_falls_with_the_distance_and_rises_with_its_strength(count):
    for curtain in curtains(2, count):
        # a third of what the skirt can put on it at most
        most = (curtain.skirt.toe_load + curtain.skirt.submerged_weight * curtain.skirt.length) * curtain.span
        values = []
        for ratio in (1.0, 1.3, 1.6):
            longer = replace(curtain, span=ratio * curtain.span, length=ratio * curtain.length)
            found = speed_limit(longer, SITE, required(anchor=Strength(most / 3.0, 1.0)), highest=2.0)
            assert found.governing == "anchor"
            values.append(found.value)
        assert values[0] > values[1] > values[2]
        stronger = speed_limit(curtain, SITE, required(anchor=Strength(most / 2.0, 1.0)), highest=2.0)
        assert stronger.value > values[0]


@pytest.mark.slow
def test_anchor_that_bears_all_weights_is_filled_by_the_floats_alone():
    """A free toe bounds its own load: with more than toe and sheet weigh, only the drag of the floats is too much."""
    for curtain in curtains(3, 4):
        most = (curtain.skirt.toe_load + curtain.skirt.submerged_weight * curtain.skirt.length) * curtain.span
        anchor = Strength(1.02 * most, 1.0)
        found = speed_limit(curtain, SITE, required(anchor=anchor), highest=2.0)
        skirt = SITE.statics(curtain, 2.0)
        assert skirt.anchor_horizontal_tension < anchor.capacity
        if found.reached:
            extra = SITE.with_floats(SITE.statics(curtain, found.value), found.value).extra
            assert extra * curtain.span >= 0.02 * most


def test_distance_of_anchors_is_judged_by_what_grows_with_it():
    """A depth that fails at any distance set it to 0 m."""
    curtain = next(curtains(5, 1))
    need = replace(required(anchor=Strength(5e3, 1.0)), least_depth=2.0 * curtain.skirt.length)
    found = anchor_spacing(curtain, SITE, need, speed=0.4, longest=300.0, wave_tension=0.0)
    assert found.governing == "anchor" and found.value > 5.0
    assert fixed_failures(SITE.statics(curtain, 0.4), need) == ("effective depth",)
    upper = anchor_spacing(curtain, SITE, need, speed=0.4, longest=300.0, wave_tension=0.0, load_factor=1.25)
    assert upper.value == pytest.approx(found.value / 1.25, rel=1e-3)


def test_joints_that_bear_more_than_a_span_set_no_length():
    assert math.isinf(joint_spacing(134.0, Strength(180e3, 3.0), 20.0))
    assert joint_spacing(134.0, Strength(180e3, 3.0), 1000.0) == pytest.approx(447.76, abs=0.01)


def test_the_period_next_to_a_limit_height_is_that_of_the_height_printed() -> None:
    """The height that is held at the unfavourable end is printed; its period follows from it by T = c sqrt(H)."""
    table = xr.Dataset(
        {"design_limit_height": 0.64, "design_limit_low": 0.36},
        attrs={"design_limit_governing": "anchor", "design_limit_period": 3.86 * 0.8, "period_follows_height": 1},
    )
    groups = {"/LW": xr.Dataset(), "/LW/limits": table}
    shown = {item.name: item for item in limit_headlines(groups, ["LW"], lambda _: False)}
    limit = shown["limit_wave_height"]
    assert limit.value == pytest.approx(0.36)
    assert f"in waves of {3.86 * 0.6:.3g} s" in limit.detail
    # a height found by realisations has two digits, rounded down
    drawn = table.assign(design_limit_low=0.3689).assign_attrs(with_snaps=1, sea_duration=1800.0)
    groups = {"/LW": xr.Dataset(), "/LW/limits": drawn}
    (found,) = [item for item in limit_headlines(groups, ["LW"], lambda _: False) if item.name == "limit_wave_height"]
    assert found.value == pytest.approx(0.36)
    assert "other seeds" not in found.detail


def test_a_height_proved_by_few_seeds_says_what_others_may_give() -> None:
    table = xr.Dataset(
        {"design_limit_height": 0.64, "design_limit_low": 0.48, "design_limit_scatter": 0.045},
        attrs={"design_limit_governing": "anchor", "with_snaps": 1, "sea_duration": 1800.0, "realisations": 5},
    )

    def detail(found: xr.Dataset) -> str:
        shown = limit_headlines({"/LW": xr.Dataset(), "/LW/limits": found}, ["LW"], lambda _: False)
        return next(item.detail for item in shown if item.name == "limit_wave_height")

    assert "other seeds may give 0.045 m less or more (one standard deviation with 5 realisations)" in detail(table)
    # less than its two digits show, or set by the depth and not by snaps
    assert "other seeds" not in detail(table.assign(design_limit_scatter=0.004))
    assert "other seeds" not in detail(table.assign(design_limit_scatter=0.0))


@pytest.mark.parametrize(
    ("role", "height", "bound"),
    [("bound", 1.7, "at least"), ("bound", 0.0, ""), ("governs", 1.7, ""), ("out of range", 1.7, "")],
)
def test_breaking_above_a_plate_that_is_a_bound_proves_no_height(monkeypatch, role, height, bound):
    """The plate knows neither sheet nor anchors of a free toe: a ceiling that it does not reach is no limit."""
    loads = SimpleNamespace(impact=object(), snaps=(object(), object()))
    monkeypatch.setattr(CountedLimits, "_knows_sheet", lambda *_: True)
    monkeypatch.setattr(CountedLimits, "role", lambda self, speed: role)
    monkeypatch.setattr(CountedLimits, "loads_in", lambda self, speed: loads)
    monkeypatch.setattr(CountedLimits, "_judged", lambda self, *_: (Limit(height, "breaking"), ""))
    counted = CountedLimits(None, None, loads)
    assert counted.height(0.3)[1] == bound


def test_heights_at_which_seas_are_run_are_those_of_any_size():
    """A curtain of a flume has as many heights below breaking as the one of a harbour."""
    tables = [
        SnapTable(lambda speed, height: np.array([height, height]), lambda height, most=most: height <= most, 3.0)
        for most in (2.3, 2.3 / 9.0, 5.0)
    ]
    large, small, whole = (table._heights for table in tables)
    assert small == pytest.approx(large / 9.0, rel=1e-6) and large.size == 11 and large[-1] == pytest.approx(2.3)
    assert whole[-1] == 3.0
    assert tables[1].tension(0.2, 0.1) == pytest.approx(0.1)
