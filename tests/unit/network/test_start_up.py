"""The beginning of a run whose stored motion starts at speed: left out of the highest tension, and shown apart."""

from __future__ import annotations

import math

import numpy as np
import pytest

import moyai
from moyai.core.headline import Headline
from moyai.core.results import Result
from moyai.flexible.motion import Motion
from moyai.structures.network.model import MotionPlan
from moyai.structures.network.start_up import ASKED, WAVES, start_up

PERIOD, AMPLITUDE, STIFFNESS, MASS = 4.0, 0.2, 4.0e6, 10.0
SPEED = 2.0 * math.pi * AMPLITUDE / PERIOD
NEUTRAL = math.sqrt(4.0 * MASS / (math.pi * 1025.0))  # a line without weight in water lies straight


def case(motion: str = "", settings: str = "") -> str:
    time = np.linspace(0.0, 16.0, 321)
    rows = ", ".join(f"[{t:.3f}, {AMPLITUDE * math.sin(2.0 * math.pi * t / PERIOD):.8f}, 0, 0]" for t in time)
    return f"""
moyai: 1
title: Line that is seized
site: {{water_depth: 100, density: 1025, gravity: 9.81}}
structure:
  kind: network
  line_types:
    rope: {{diameter: {NEUTRAL:.6f}, mass: {MASS}, axial_stiffness: {STIFFNESS}, damping_ratio: 0.05, drag_normal: 1.2,
            drag_tangential: 0, added_mass_normal: 1, added_mass_tangential: 0}}
  motions:
    seized: {{kind: table, rows: [{rows}]{motion}}}
  points:
    anchor: {{kind: fixed, position: [0, 0, -20]}}
    top: {{kind: driven, position: [101, 0, -20], motion: seized}}
  lines:
    line: {{start: anchor, end: top, type: rope, length: 100, segments: 20}}
analyses: [statics, dynamic]
settings: {{duration: 16, mesh_check: off{settings}}}
"""


def solved(motion: str = "", settings: str = "") -> Result:
    return moyai.run(moyai.load_case(case(motion, settings)))


@pytest.fixture(scope="module")
def seized() -> Result:
    return solved(", ramp: 0 s")


@pytest.fixture(scope="module")
def grown() -> Result:
    return solved()


def number(result: Result, name: str) -> Headline:
    (found,) = [item for item in result.headlines if item.name == name]
    return found


def quasi_static() -> float:
    """Return the largest tension of a straight line that is only stretched."""
    return STIFFNESS * (1.0 + AMPLITUDE) / 100.0


def test_the_jerk_of_the_start_is_shown_apart(seized: Result) -> None:
    """The elastic wave of v sqrt(EA m) comes on top of the tension at rest, and doubles where it is thrown back."""
    apart, highest = number(seized, "start_up_tension"), number(seized, "line_tension")
    rest, jerk = STIFFNESS / 100.0, SPEED * math.sqrt(STIFFNESS * MASS)
    swing = quasi_static() - rest
    assert rest + jerk < apart.value < rest + swing + 2.0 * jerk
    assert f"first {PERIOD:g} s" in apart.detail and "'seized'" in apart.detail
    assert highest.value < apart.value
    run = seized.tree["SWL/time/still water"]
    late = run["time"].values >= PERIOD - 0.01
    assert highest.value == pytest.approx(float(run["line_tension_peak_since_row"].values[late].max()))
    assert apart.value == pytest.approx(float(run["line_tension_peak_since_row"].values[~late].max()))


def test_a_stored_motion_grows_over_its_first_period(grown: Result) -> None:
    highest = number(grown, "line_tension")
    assert highest.value == pytest.approx(quasi_static(), rel=0.02)
    apart = number(grown, "start_up_tension")
    assert apart.value < quasi_static() * 1.02 and "grows from nothing" in apart.detail
    run = grown.tree["SWL/time/still water"]
    time, place = run["time"].values, run["point_position"].sel(point="top", axis="x").values - 101.0
    share = 0.5 * (1.0 - np.cos(np.pi * np.clip(time / PERIOD, 0.0, 1.0)))
    np.testing.assert_allclose(place, share * AMPLITUDE * np.sin(2.0 * np.pi * time / PERIOD), atol=2e-4)


def test_skip_of_the_case_stands() -> None:
    motion = MotionPlan("m", "harmonic", 10.0, math.inf, amplitude=(0.0, 0.0, 1.0))
    # waves find the network at rest: five periods, a quarter of a short run, and never the last period
    assert start_up(None, [], 120.0, 6.0) == (30.0, WAVES) and start_up(None, [], 60.0, 6.0) == (15.0, WAVES)
    assert start_up(None, [], 7.0, 6.0)[0] == pytest.approx(1.0) and start_up(0.0, [], 60.0, 6.0) == (0.0, "")
    assert start_up(0.0, [motion], 100.0) == (0.0, "")
    assert start_up(7.0, [motion], 100.0) == (7.0, ASKED)
    assert start_up(None, [motion], 100.0)[0] == pytest.approx(10.0, rel=0.01)
    assert start_up(None, [motion], 16.0)[0] == 8.0


def test_smooth_and_steady_motions_count_from_the_start() -> None:
    smooth = MotionPlan("m", "harmonic", 10.0, math.inf, amplitude=(0.0, 0.0, 1.0), ramp=5.0)
    assert start_up(None, [smooth], 100.0) == (0.0, "")
    tow = MotionPlan(
        "t", "table", math.nan, 9.0, table=Motion.from_table([0.0, 9.0], [[0, 0, 0], [9, 0, 0]]), ramp=None
    )
    assert start_up(None, [tow], 9.0) == (0.0, "")
    assert tow.growth(9.0) == 0.0


def test_a_motion_that_begins_away_from_its_place_is_a_jerk() -> None:
    away = MotionPlan("c", "harmonic", 10.0, math.inf, amplitude=(1.0, 0.0, 0.0), phase=(0.5 * math.pi, 0.0, 0.0))
    length, rule = start_up(None, [away], 100.0)
    assert length == pytest.approx(10.0, rel=0.01) and "1 m from its place at rest" in rule
