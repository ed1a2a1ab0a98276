"""A member below the drag crisis: the judged end holds its drag there, where the law speaks of post-critical flow."""

from __future__ import annotations

import pytest

import moyai
from moyai.core.headline import Headline
from moyai.morison.coefficients import amplified_drag, dnv_drag, share_below_crisis

CASE = """
moyai: 1
title: Smooth pipe in a river
site: {water_depth: 6 m, density: 1000 kg/m3, gravity: 9.81 m/s2}
WAVES
current: {speed: SPEED, heading_deg: 0}
structure:
  kind: member
  section: {shape: circle, diameter: 0.3 m}
  start: {y: -6 m, z: -3 m}
  end: {y: 6 m, z: -3 m}
  inertia: dnv_c205
  drag: LAW
  kinematic_viscosity: 1.14e-6 m2/s
analyses: [forces]
settings: {strips: 4}
criteria: {greatest_force: 0.6 kN}
"""


def _result(law: str, speed: float, waves: str = ""):
    given = CASE.replace("LAW", law).replace("SPEED", f"{speed} m/s").replace("WAVES", waves)
    return moyai.run(given.replace("  inertia: dnv_c205", "  inertia: dnv_c205\n  circulation: {purpose: extreme}"))


def _force(result) -> Headline:
    return next(item for item in result.headlines if item.name == "peak_force")


@pytest.mark.parametrize("law", ["{law: dnv_c205}", "{law: api}"])
def test_a_smooth_pipe_in_a_river_is_not_held_by_post_critical_drag(law: str) -> None:
    """Re 1.6e5: C_D is 1.2, 778 N, where the law says 0.65 and 421 N."""
    result = _result(law, 0.6)
    by_hand = 0.5 * 1000.0 * 1.2 * 0.3 * 12.0 * 0.6**2
    found = _force(result)
    assert found.value < 0.6e3 < by_hand < found.band.high < 1.3 * by_hand
    assert "before the drag crisis" in found.band.of
    assert result.verdict.outcome == "does not hold"
    # the law of the inertia, which acts nowhere, says nothing
    said = [notice.message for notice in result.notices if notice.code == "drag-reynolds"]
    assert len(said) == 1 and ("API" if "api" in law else "DNV") in said[0]


def test_drag_below_the_crisis_says_no_more_than_it_knows() -> None:
    steady = _result("{law: steady}", 0.6)
    assert not any(notice.code == "drag-reynolds" for notice in steady.notices)
    assert "drag crisis" not in _force(steady).band.of
    # post-critical flow: the allowance of the law alone
    fast = _force(_result("{law: dnv_c205}", 4.0))
    assert fast.band.high == pytest.approx(1.25 * fast.value, rel=1e-6)


def test_the_judged_force_rises_with_the_current_through_the_crisis() -> None:
    ends = [_force(_result("{law: dnv_c205}", speed)).band.high for speed in (1.0, 1.8, 1.95, 2.4, 3.0, 3.7, 3.9, 4.2)]
    assert ends == sorted(ends)
    assert ends[-2] == pytest.approx(ends[-3] * (3.9 / 3.7) ** 2, rel=0.08)


def test_in_waves_the_drag_before_the_crisis_is_amplified_as_well() -> None:
    wave = "waves: [{kind: regular, name: w, height: 0.8 m, period: 5 s, heading_deg: 0, theory: linear}]"
    found = _force(_result("{law: dnv_c205}", 0.01, wave))
    assert "before the drag crisis" in found.band.of
    assert amplified_drag(1.2, 12.0) == pytest.approx(1.8)
    assert dnv_drag(12.0, 0.0) < 0.5 * amplified_drag(1.2, 12.0)


def test_roughness_brings_the_crisis_forward() -> None:
    assert share_below_crisis(4e5, 0.0) == 1.0 and share_below_crisis(1e6, 0.0) == 0.0
    assert share_below_crisis(3e4, 1e-2) == 1.0 > share_below_crisis(2e5, 1e-2) > share_below_crisis(9e5, 1e-2) > 0.0
    assert share_below_crisis(7e5, 0.0) > share_below_crisis(7e5, 5e-3)
