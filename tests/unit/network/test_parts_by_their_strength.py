"""A line of parts of different strength: each part's own highest tension over its own strength decides.

Independent reference: weights in water, of a line that hangs straight down and of one between a float and its anchor.
"""

from __future__ import annotations

import pytest

import moyai

HEAVE = """
    heave: {kind: harmonic, amplitude: [0, 0, 0.2 m], period: 8 s, ramp: 12 s}"""
CASE = """
moyai: 1
title: Two ropes and a weight
site: {water_depth: 60 m, density: 1000 kg/m3, gravity: 10 m/s2}
structure:
  kind: network
  line_types:
    thin: {diameter: 10 mm, mass: 1.0 kg/m, volume: 0 m2, axial_stiffness: 2 MN, damping_ratio: 0.3,
           drag_normal: 1.2, drag_tangential: 0.1, added_mass_normal: 1, breaking_load: 12 kN}
    heavy: {diameter: 60 mm, mass: 25 kg/m, volume: 0 m2, axial_stiffness: 300 MN, damping_ratio: 0.3,
            drag_normal: 1.2, drag_tangential: 0.1, added_mass_normal: 1, breaking_load: 2000 kN}
  motions:
    heave: {kind: harmonic, amplitude: [0, 0, 0.2 m], period: 8 s, ramp: 12 s}
  points:
    top: {kind: driven, position: [0, 0, -5 m], motion: heave}
    weight: {kind: free, position: [0, 0, -45 m], mass: 300 kg, volume: 0 m3}
  lines:
    hoist:
      start: top
      end: weight
      parts:
        - {type: heavy, length: 20 m, segments: 20}
        - {type: thin, length: 20 m, segments: 20}
analyses: ANALYSES
settings: {duration: 28 s, skip: 12 s}
criteria: {line_safety_factor: 2}
"""


def _utilisation(result: moyai.Result):
    return next(item for item in result.headlines if item.name == "line_utilisation" and item.shown)


def test_at_rest_the_thin_part_bears_its_own_tension() -> None:
    # a motion that is not run would leave the design open
    result = moyai.run(CASE.replace("ANALYSES", "[statics]").replace(", motion: heave", "").replace(HEAVE, " {}"))
    found = _utilisation(result)
    # at its top the thin rope bears the weight and itself; the heavy one, of another strength, 5000 N more
    assert found.band is not None and found.band.high == pytest.approx((3000.0 + 200.0) / 12e3, rel=2e-3)
    assert found.value == pytest.approx((3000.0 + 195.0) / 12e3, rel=1e-3)
    assert found.part == "hoist part 2" and "thin" in found.detail and "12 kN" in found.detail
    tension = next(item for item in result.headlines if item.name == "line_tension" and item.shown)
    assert tension.value == pytest.approx(3000.0 + 200.0 + 5000.0 - 125.0, rel=1e-3)
    (row,) = [row for row in result.verdict.judgements if row.criterion.name == "line_safety_factor"]
    assert row.outcome == "holds" and "hoist part 2" in row.reason


@pytest.mark.slow
def test_through_time_each_part_has_its_own_peak_and_band() -> None:
    result = moyai.run(CASE.replace("ANALYSES", "[statics, dynamic]"))
    found = _utilisation(result)
    summary = result.tree["SWL/dynamic"].to_dataset()
    # heave of 0.2 m in 8 s moves the load by 0.2 (2 pi / 8)^2 = 0.123 m/s2, and the long weight with it
    moved = 0.2 * (2.0 * 3.14159 / 8.0) ** 2
    assert found.value == pytest.approx(3195.0 * (1.0 + moved / 10.0) / 12e3, rel=0.03)
    assert found.part == "hoist part 2" and found.band is not None and found.band.high < 1.1 * found.value
    assert float(summary["utilisation"][0, 0]) == pytest.approx(found.value, rel=1e-6)
    checks = summary["part_tension_of_check"].sel(part="hoist part 2").values[0]
    assert checks[0] == pytest.approx(found.value * 12e3, rel=1e-6) and checks[2] == pytest.approx(checks[0], rel=0.05)


def test_a_part_with_a_strength_is_judged_where_others_have_none() -> None:
    text = CASE.replace("ANALYSES", "[statics]").replace(", motion: heave", "").replace(HEAVE, " {}")
    text = text.replace(", breaking_load: 2000 kN", "")
    result = moyai.run(text)
    found = _utilisation(result)
    assert found.value == pytest.approx((3000.0 + 195.0) / 12e3, rel=1e-3)
    assert found.part == "hoist part 2" and "breaking load not given of hoist part 1" in found.detail
    assert result.verdict.outcome == "not judged"
    assert moyai.run(text.replace("breaking_load: 12 kN", "breaking_load: 4 kN")).verdict.outcome == "does not hold"
