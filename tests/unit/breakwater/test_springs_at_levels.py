"""Fixed ends of springs stay where they are when the water rises."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import load_case
from moyai.structures.breakwater.assembly import assemble

CASE = """
moyai: 1
title: Pontoon on springs
site: {{water_depth: {depth} m, density: 1025 kg/m3, gravity: 9.81 m/s2, water_levels: {levels}}}
structure:
  kind: breakwater
  length: 12 m
  section: {{shape: rectangle, beam: 4 m, height: 1.6 m}}
  {size}
  centre_of_gravity_above_keel: 0.7 m
  roll_gyradius: 1.2 m
lines:
  - {{name: left, kind: spring, count: 2, fairlead: {{x: -2 m, above_keel: 0.1 m}}, anchor: {{x: -8 m, z: {z} m}},
     stiffness: 6 kN/m, pretension: 5 kN}}
  - {{name: right, kind: spring, count: 2, fairlead: {{x: 2 m, above_keel: 0.1 m}}, anchor: {{x: 8 m, z: {z} m}},
     stiffness: 6 kN/m, pretension: 5 kN}}
analyses: [statics]
"""


def unit(depth: float, levels: str, level: str, z: float, size: str):
    problem = build(load_case(CASE.format(depth=depth, levels=levels, z=z, size=size)))
    return assemble(problem, level, dict(problem.environment.water_levels)[level])


def test_the_level_is_the_same_whatever_it_is_counted_from() -> None:
    """High water next to low water, and alone with the depth and the anchors counted from it."""
    low = unit(6.0, "{LW: 0 m, HW: 2 m}", "LW", -6.0, "draught: 0.9 m")
    found = unit(6.0, "{LW: 0 m, HW: 2 m}", "HW", -6.0, "draught: 0.9 m")
    alone = unit(8.0, "{HW: 0 m}", "HW", -8.0, f"mass: {low.mass!r} kg")
    for line, other in zip(found.lines, alone.lines, strict=True):
        # on the bed
        assert line.anchor[2] + found.centre[1] == pytest.approx(-8.0)
        assert np.allclose(line.anchor, other.anchor, rtol=0.0, atol=1e-9)
    assert found.draught == pytest.approx(alone.draught, rel=1e-9)
    assert np.allclose(found.mooring_stiffness, alone.mooring_stiffness, rtol=1e-7, atol=1e-3)
    # steeper than at low water by two metres
    assert found.line_pull > 1.1 * low.line_pull


def test_a_shift_of_the_datum_changes_nothing() -> None:
    one = unit(8.0, "{HW: 0 m}", "HW", -8.0, "draught: 0.9 m")
    other = unit(5.0, "{HW: 3 m}", "HW", -5.0, "draught: 0.9 m")
    assert other.mass == pytest.approx(one.mass, rel=1e-12)
    assert np.allclose(other.mooring_stiffness, one.mooring_stiffness, rtol=1e-12, atol=0.0)
