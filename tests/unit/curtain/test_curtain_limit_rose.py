"""Limit rose: what a curtain bears over wave heading and orientation, by hand, by symmetry and against the limits."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from renamed import unmissed

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.core.progress import silent
from moyai.core.results import Result
from moyai.sea.breaking import breaking_limit
from moyai.structures.curtain.analyses.limits import CountedLimits, fastest_water, limits_dataset, sea_loads
from moyai.structures.curtain.analyses.rose import best_orientation, folded, rose_dataset
from moyai.structures.curtain.assembly import assemble
from moyai.structures.curtain.report.page import compose
from moyai.structures.curtain.run import run
from moyai.structures.curtain.seas.loads import drag_curve

CASE = """moyai: 1
title: Curtain on ropes
site: {water_depth: 8 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.2 m/s, heading_deg: 0}
waves:
  - {name: gale, kind: regular, height: 0.5 m, period: 4 s, heading_deg: 20}
  - {name: swell, kind: regular, height: 0.3 m, period: 4 s, heading_deg: -10}
structure:
  kind: curtain
  normal_deg: 0
  span: 12 m
  length: 13.5 m
  skirt: {length: 4 m, submerged_weight: 3 N/m2, stiffness: 500 kN/m, strength: 100 kN/m}
  toe: {kind: free, weight: 600 N/m}
  cables: {upper: {axial_stiffness: 600 kN, breaking_load: 300 kN}}
  floats: {buoyancy: 2900 N/m, weight: 90 N/m}
  anchors: {line_length: 25 m, axial_stiffness: 2 MN, breaking_load: 12 kN, holding_force: 200 kN}
  drag: {law: constant, coefficient: 1.3, range: [0.8, 1.4]}
analyses: [anchor_loads, limits]
settings:
  anchor_loads: {energy_factor: 0.2, float_mass: 300 kg, pretension: false}
  safety_factors: {cable: 3, sheet: 4, anchor_line: 3, anchor: 1.5}
  limits: {highest_speed: 1 m/s, highest_height: 2 m, period: 4 s, wave_angle_deg: 30, rose_step_deg: 30}
"""


def problem_of(folder, text):
    file = folder / "case.yaml"
    file.write_text(text, encoding="utf-8")
    return build(load_case(file))


def rose_of(problem):
    unit = assemble(problem, *problem.environment.water_levels[0])
    return unit, rose_dataset(unit, problem.settings, problem.environment.sea_states, silent)


@pytest.fixture(scope="module")
def calm(tmp_path_factory):
    text = CASE.replace("current: {speed: 0.2 m/s, heading_deg: 0}\n", "")
    return rose_of(problem_of(tmp_path_factory.mktemp("calm"), text))


@pytest.fixture(scope="module")
def stream(tmp_path_factory):
    problem = problem_of(tmp_path_factory.mktemp("stream"), CASE)
    return problem, *rose_of(problem)


@pytest.mark.slow
def test_in_calm_water_the_height_goes_with_one_over_the_squared_cosine(calm) -> None:
    """At one period and without current every load hangs on H cos^2; breaking and the end of the range cap it."""
    unit, rose = calm
    held = rose["rose_height"].values
    orientation, heading = rose["orientation"].values, rose["wave_heading"].values
    most = min(2.0, breaking_limit(4.0, unit.water).height / 1.8)
    seen = 0
    for row, normal in enumerate(orientation):
        square = float(held[row, row])
        # a standstill is run as a current of 1 mm/s, some 0.2 % of the speed of the water under the crest
        assert 0.2 < square < 0.9 and square == pytest.approx(float(held[0, 0]), rel=3e-3)
        for column, angle in enumerate(heading):
            expected = square / max(math.cos(angle - normal) ** 2, 1e-9)
            seen += expected < most
            assert held[row, column] == pytest.approx(min(expected, most), rel=1e-6)
    assert seen == 60


@pytest.mark.slow
def test_own_row_is_the_limit_of_the_table(stream) -> None:
    """As it lies, waves at the angle of the table: the least of half and whole current, by the limits themselves."""
    problem, unit, rose = stream
    settings = problem.settings
    curve = drag_curve(unit, fastest_water(unit, settings, ()))
    counted = CountedLimits(unit, settings, sea_loads(unit, settings, None, curve))
    expected = min(counted.height(speed)[0].value for speed in (0.1, 0.2))
    found = rose.sel(wave_heading=math.radians(30.0), method="nearest").isel(orientation=0)
    assert float(found["rose_height"]) == pytest.approx(expected, rel=1e-3)
    table = limits_dataset(unit, settings, None, curve, silent)
    assert float(found["rose_height"]) <= float(table["design_limit_height"]) * 1.001
    assert 0.0 < expected < 2.0


@pytest.mark.slow
def test_rose_has_the_symmetry_of_the_water(stream) -> None:
    """Current along x: mirrored orientation and waves bear the same; waves from behind as from the front."""
    _, _, rose = stream
    held = rose["rose_height"].values
    half = held.shape[0]
    for row in range(half):
        for column in range(2 * half):
            assert held[row, column] == pytest.approx(held[-row % half, -column % (2 * half)], rel=1e-6)
            assert held[row, column] == held[row, (column + half) % (2 * half)]
    # the current takes part of what the ropes bear: across it the curtain holds less than along it, waves alike
    assert held[0, 0] < held[3, 3]


def test_the_orientation_that_bears_most_lies_along_the_seas(stream) -> None:
    """Seas to 20 and -10 degrees, current to 0: the curtain along x, its normal near 90, bears most."""
    _, _, rose = stream
    best = math.degrees(rose.attrs["best_orientation"])
    assert best == pytest.approx(90.0)
    ratio = rose["held_ratio"].values
    assert ratio[3] > 2.0 * ratio[0]
    heights = rose["sea_rose_height"].values / rose["sea_height"].values
    assert np.array_equal(ratio, heights.min(axis=1))


@pytest.mark.parametrize(
    ("ratio", "place"),
    [
        ([1.0, 3.0, 2.0, 1.0], 1),
        ([1.0, 2.0, 2.0, 2.0], 2),
        ([2.0, 2.0, 1.0, 2.0], 0),  # round the end: 3, 0, 1
        ([2.0, 1.0, 2.0, 2.0, 1.0, 1.0], 2),  # the longest run
        ([1.0, 1.0, 1.0], None),
        ([math.nan, math.nan], None),
        ([math.nan, 1.0, 0.5], 1),
    ],
)
def test_best_of_alike_orientations_is_their_middle(ratio, place) -> None:
    assert best_orientation(np.array(ratio)) == place


def test_directions_fold_to_a_right_angle() -> None:
    assert [math.degrees(folded(math.radians(angle))) for angle in (0, 30, 90, 150, 180, 210, -45)] == pytest.approx(
        [0, 30, 90, 30, 0, 30, 45], abs=1e-6
    )


@pytest.mark.slow
def test_rose_stands_in_result_and_report_only_where_it_is_asked_for(stream) -> None:
    problem, _, rose = stream
    coarse = replace(problem.settings, limits=replace(problem.settings.limits, rose_step=math.radians(45.0)))
    result = run(replace(problem, settings=coarse))
    assert result.tree["SWL/limits/rose"]["rose_height"].shape == (4, 8)
    assert unmissed(result) <= {"strong_drag_tension"}
    assert float(result.tree["SWL/limits/rose"]["rose_height"][0, 0]) == pytest.approx(float(rose["rose_height"][0, 0]))
    keys = _keys(result)
    assert {"swl-limit-rose", "swl-limit-over-orientation", "swl-limit-rose-seas", "swl-limit-rose-data"} <= keys
    without = replace(problem.settings, limits=replace(problem.settings.limits, rose_step=None))
    plain = run(replace(problem, settings=without))
    assert "rose" not in plain.tree["SWL/limits"].children
    assert not any("rose" in key for key in _keys(plain))


def _keys(result: Result) -> set[str]:
    """Return the keys of all blocks of the report, those of the water level included."""
    found: set[str] = set()

    def visit(blocks) -> None:
        for block in blocks:
            if hasattr(block, "key"):
                found.add(block.key)
            for option in getattr(block, "options", ()):
                visit(option.blocks)

    for section in compose(result).sections:
        visit(section.blocks)
    return found
