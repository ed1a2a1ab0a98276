"""A line at rest on its bed: whatever its segments, the band holds the elastic catenary, and no limit below it holds.

Independent reference: the elastic catenary whose lower end lies on a flat bed without friction.
"""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import moyai
from moyai.structures.network.rest_mesh import Reach
from moyai.tables.lines import line_type

CASE = """
moyai: 1
title: Ship's chain at rest, fairlead held
site: {water_depth: 70 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: network
  bed: {stiffness: 3e7 Pa/m, damping: 3e5 Pa s/m, friction: 0.6}
  line_types:
    chain: {catalogue: studless_chain_R3, diameter: 76 mm, damping_ratio: 0.1}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    fairlead: {kind: fixed, position: [AWAY m, 0, -5 m]}
  lines:
    chain: {start: anchor, end: fairlead, type: chain, length: 400 m, segments: SEGMENTS}
analyses: [statics]
criteria: {line_safety_factor: not_judged, greatest_tension: LIMIT kN}
"""
LENGTH, HIGH = 400.0, 65.0


def _catenary(away: float) -> tuple[float, float]:
    """Return tension at the fairlead and at the anchor [N] of an elastic chain that lies on its bed."""
    chain = line_type("studless_chain_R3", 0.076)
    weight, stiffness = (chain.mass_per_length - 1025.0 * chain.volume_per_length) * 9.81, chain.axial_stiffness

    def hanging(level: float) -> float:
        def too_high(length: float) -> float:
            return (math.hypot(level, weight * length) - level) / weight + weight * length**2 / (2.0 * stiffness) - HIGH

        return brentq(too_high, HIGH, LENGTH)

    def too_far(level: float) -> float:
        length = hanging(level)
        return (
            LENGTH - length + level / weight * math.asinh(weight * length / level) + level * LENGTH / stiffness - away
        )

    level = brentq(too_far, 1e3, 7e5)
    return math.hypot(level, weight * hanging(level)), level


@pytest.mark.parametrize("away", [360.0, 380.0, 390.0])
@pytest.mark.parametrize("segments", [3, 4, 5, 7, 9, 14, 25, 60])
def test_the_band_holds_the_elastic_catenary(away: float, segments: int) -> None:
    top, level = _catenary(away)
    text = CASE.replace("AWAY", str(away)).replace("SEGMENTS", str(segments))
    result = moyai.run(text.replace("LIMIT", f"{0.99e-3 * top:.4f}"))
    (tension,) = [item for item in result.headlines if item.name == "line_tension" and item.shown]
    assert tension.band is not None and tension.bound == ""
    # the chain sinks some millimetres into the bed
    rest = result.tree["SWL/statics"].to_dataset().sel(condition="still water", point="anchor")
    # touchdown and end are known to half a bar each of those that are clear of the bed
    bar = top / float(rest["clear_bars_of_mesh"].sel(line="chain")[-1])
    assert tension.band.low <= top * 1.0005 and 0.9995 * top <= tension.band.high <= 1.012 * top + bar
    assert result.verdict.outcome == "does not hold"
    assert float(rest["point_load_of_mesh"][-1]) == pytest.approx(level, rel=0.02)
    coarse = [notice for notice in result.notices if notice.code == "coarse-rest"]
    assert bool(coarse) == (abs(tension.value / top - 1.0) > 0.05) or 0.04 < abs(tension.value / top - 1.0) < 0.06
    assert not coarse or (coarse[0].severity == "warning" and "segments" in coarse[0].remedy)


@pytest.mark.parametrize("level", [50.0, 400.0, 2e4])
@pytest.mark.parametrize("segments", [3, 8, 13, 40])
def test_few_bars_clear_of_the_bed_prove_nothing(level: float, segments: int) -> None:
    """Of 400 m of chain some metres hang: meshes with no bar clear of the bed, or with one, agree with each other."""
    chain, high = line_type("studless_chain_R3", 0.076), 3.0
    weight, stiffness = (chain.mass_per_length - 1025.0 * chain.volume_per_length) * 9.81, chain.axial_stiffness
    hanging = math.sqrt(high**2 + 2.0 * high * level / weight)
    away = LENGTH - hanging + level / weight * math.asinh(weight * hanging / level) + level * LENGTH / stiffness
    top = math.hypot(level, weight * hanging)
    text = CASE.replace("70 m", "8 m").replace("AWAY", f"{away:.6f}").replace("SEGMENTS", str(segments))
    result = moyai.run(text.replace("LIMIT", f"{0.98e-3 * top:.5f}"))
    (tension,) = [item for item in result.headlines if item.name == "line_tension" and item.shown]
    assert tension.bound == "at least" or (tension.band is not None and tension.band.high > 0.995 * top)
    assert result.verdict.outcome != "holds"


def test_a_line_that_lies_on_the_bed_as_a_whole_leaves_the_others_their_mesh() -> None:
    text = CASE.replace("AWAY", "380").replace("SEGMENTS", "40").replace("LIMIT", "250")
    laid = text.replace("  lines:\n", """  lines:
    laid: {start: one, end: other, type: chain, length: 100 m, segments: 20}
""").replace("  points:\n", """  points:
    one: {kind: fixed, position: [0, 10 m, bed]}
    other: {kind: fixed, position: [95 m, 10 m, bed]}
""")  # fmt: skip
    alone, found = moyai.run(text), moyai.run(laid)
    assert found.verdict.outcome == alone.verdict.outcome == "holds"
    rest = [result.tree["SWL/statics"].to_dataset() for result in (alone, found)]
    assert rest[0].sizes["mesh"] == rest[1].sizes["mesh"] < 5
    pull = next(item for item in found.headlines if item.name == "point_load")
    assert pull.bound == "" and pull.value == pytest.approx(
        next(item for item in alone.headlines if item.name == "point_load").value, rel=1e-6
    )


def test_a_change_of_first_order_goes_on_to_its_limit_and_one_that_jumps_is_open() -> None:
    meshes = 2.0 ** np.arange(4)
    found = Reach.of(100.0 - 8.0 / meshes)
    assert found.low == 92.0 and found.high == pytest.approx(100.0) and found.settled and found.stands
    # as far again as it is not of first order: here of second
    found = Reach.of(100.0 - 8.0 / meshes**2)
    assert found.low == 92.0 and 100.0 < found.high < 100.7 and found.stands
    jumps = Reach.of(np.array([175.0, 168.0, 182.5]))
    assert not jumps.settled and jumps.high > 192.9
    assert not Reach.of(np.array([176.35, 176.4])).settled and Reach.of(np.array([176.35, 176.4]), few=False).settled
    assert Reach.of(np.array([5.0])).settled is False
