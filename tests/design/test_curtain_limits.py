"""Operating limits of the flared curtain: monotone by construction, in words where there is no number, bounds named."""

from __future__ import annotations

import math

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.structures.curtain.report.reading import water_levels
from moyai.structures.curtain.report.steady import site_table, steady_tables
from moyai.structures.curtain.run import run

CASE = """moyai: 1
title: Flared curtain
site: {water_depth: 10 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
current: {speed: 0.5 m/s, heading_deg: 0}
waves: {kind: regular, height: 0.8 m, period: 3.5 s, heading_deg: 0}
structure:
  kind: curtain
  span: 20 m
  length: 22.5 m
  skirt: {length: 5 m, submerged_weight: 4 N/m2, stiffness: 900 kN/m, strength: 160 kN/m}
  toe: {kind: free, chain_mass: 15 kg/m}
  cables: {upper: {catalogue: polyester, diameter: 28 mm}}
  floats: {buoyancy: 980 N/m, weight: 100 N/m}
  joints: {distance: 10 m, strength: 60 kN}
  anchors: {line_length: 40 m, axial_stiffness: 10 MN, breaking_load: 300 kN, holding_force: 120 kN}
  drag: {law: constant, coefficient: 1.5, range: [0.8, 1.3]}
  passing_fraction: 0.5
analyses: [statics, ANALYSES limits]
settings:
  safety_factors: {cable: 3, sheet: 4, joint: 3, anchor_line: 3, anchor: 1.5}
  limits: {highest_speed: 1 m/s, highest_height: 2 m, speeds: [0.05 m/s, 0.12 m/s, 0.2 m/s, 0.5 m/s]}
  least_effective_depth: 4 m
"""


def result_of(folder, analyses):
    file = folder / "case.yaml"
    file.write_text(CASE.replace("ANALYSES ", analyses), encoding="utf-8")
    return run(build(load_case(file)))


@pytest.fixture(scope="module")
def plain(tmp_path_factory):
    return result_of(tmp_path_factory.mktemp("plain"), "")


@pytest.fixture(scope="module")
def snapping(tmp_path_factory):
    return result_of(tmp_path_factory.mktemp("snapping"), "waves, ")


def test_limiting_current_is_the_one_of_the_depth_by_hand(plain):
    """Closed form with half of the sheet's weight at the toe: a arsinh(L/a) = 4 m gives a = W'/q; 3 %."""
    from scipy.optimize import brentq

    found = plain.tree["SWL/limits"]
    radius = brentq(lambda a: a * math.asinh(5.0 / a) - 4.0, 0.5, 50.0)
    weight = 15.0 * 9.81 * (1.0 - 1025.0 / 7850.0) + 0.5 * 4.0 * 5.0
    speed = math.sqrt(2.0 * weight / (radius * 1025.0 * 1.5))
    assert float(found["speed_limit"]) == pytest.approx(speed, rel=0.03)
    assert found.attrs["speed_limit_governing"] == "effective depth"
    # the ratio is that of the two numbers beside it
    assert float(found["speed_limit_ratio"]) == pytest.approx(float(found["speed_limit"]) / 0.5, rel=1e-12)
    # the load goes with C_D U^2
    assert float(found["speed_limit_low"]) == pytest.approx(float(found["speed_limit"]) / math.sqrt(1.3), rel=1e-12)
    assert float(found["speed_limit_high"]) == pytest.approx(float(found["speed_limit"]) / math.sqrt(0.8), rel=1e-12)


def test_band_of_the_limiting_current_is_that_of_the_scaled_drag(plain, tmp_path):
    """A run with the upper coefficient itself."""
    file = tmp_path / "case.yaml"
    text = CASE.replace("ANALYSES ", "").replace("coefficient: 1.5, range: [0.8, 1.3]", "coefficient: 1.95")
    file.write_text(text, encoding="utf-8")
    other = run(build(load_case(file))).tree["SWL/limits"]
    assert float(other["speed_limit"]) == pytest.approx(float(plain.tree["SWL/limits"]["speed_limit_low"]), rel=1e-5)


@pytest.mark.parametrize("which", ["plain", "snapping"])
def test_height_never_rises_with_the_current(which, request):
    """It rose from 1.27 to 1.81 m before it fell to nothing."""
    found = request.getfixturevalue(which).tree["SWL/limits"]
    height, alone = found["limit_height"].values, found["limit_height_alone"].values
    assert np.all(np.diff(height) <= 0.0)
    assert np.array_equal(height, np.minimum.accumulate(alone))
    rises = bool(np.any(np.diff(alone) > 1e-6))
    assert bool(found.attrs["limit_not_monotone"]) == rises
    assert float(found["design_limit_height"]) == height[-1] == 0.0


def test_nothing_held_names_the_component_and_how_far_beyond(plain):
    found = plain.tree["SWL/limits"]
    note = found.attrs["design_limit_note"]
    depth = float(plain.tree["SWL/statics"]["effective_depth"].sel(drag_case="given"))
    assert note.startswith("0 m: the current alone is too much for the effective depth")
    assert f"({100.0 * 4.0 / depth:.0f} %)" in note


def test_bounds_are_named(plain, snapping):
    """Without snaps a height is at most; by the upright plate on a free toe, out of its range, at least."""
    first = [str(bound) for bound in plain.tree["SWL/limits"]["limit_bound"].values]
    assert first[:3] == ["at most"] * 3 and first[3] == ""
    found = snapping.tree["SWL/limits"]
    assert found.attrs["plate_role"] == "bound"
    for bound, governing in zip(found["limit_bound"].values, found["limit_governing"].values):
        assert str(bound) in ("at least", "")
        if str(governing) in ("joint", "upper cable"):
            assert str(bound) == "at least"


def test_words_in_place_of_numbers_that_are_none(plain):
    """449 m of unit, 0 m between anchors and a net weight of -732 stood there."""
    (level,) = water_levels(plain)
    table = site_table(level)
    rows = dict(zip(table.columns[0].values, table.columns[1].values))
    assert rows["with flooded floats"] == "floats, 732 N/m of buoyancy left"
    assert rows["fails at any distance of anchors"] == "effective depth"
    assert "no limit within the range searched (up to 60.0 m)" in rows.values()
    assert "no limit within the range searched (up to 20.0 m)" in rows.values()
    assert not any(isinstance(value, float) and (value < 0.0 or math.isinf(value)) for value in rows.values())


def test_report_shows_the_one_steady_load_and_why_others_differ(plain):
    (level,) = water_levels(plain)
    titles = [table.title for table in steady_tables(level)]
    assert titles[:3] == [
        "The governing steady load",
        "What moves the steady load",
        "Other steady loads, and why they differ",
    ]
    compared = steady_tables(level)[2]
    assert all(str(why) for why in compared.columns[-1].values)
    assert [str(one) for one in compared.columns[4].values].count("governs") == 1


def test_the_current_that_is_held_is_no_matter_of_the_current_of_the_case(tmp_path):
    """Judged with the depth at the lower end of its band in the current that is found, not in that of the case."""
    found = []
    for speed in (0.1, 0.25):
        file = tmp_path / "case.yaml"
        text = CASE.replace("ANALYSES ", "").replace("speed: 0.5 m/s", f"speed: {speed} m/s")
        file.write_text(text, encoding="utf-8")
        limits = run(build(load_case(file))).tree["SWL/limits"].to_dataset()
        assert limits.attrs["speed_limit_of_least_depth"] < float(limits["speed_limit"])
        found.append(limits.attrs["speed_limit_of_least_depth"])
    assert found[0] == pytest.approx(found[1], rel=5e-3)
