"""A clump on a slack line lies on the bed as a body of its size does, whatever the segments of the line."""

import numpy as np
import pytest

import moyai

CASE = """
moyai: 1
title: Chain, clump and a rope that floats
site: {water_depth: 25 m, density: 1025 kg/m3, gravity: 9.81 m/s2}
structure:
  kind: network
  bed: {stiffness: 3e5 Pa/m, damping: 3e4 Pa s/m, friction: 0.4}
  line_types:
    chain: {diameter: 40 mm, mass: 32 kg/m, volume: 0.004076 m2, axial_stiffness: 130 MN, damping_ratio: 0.2,
            drag_normal: 2.4, drag_tangential: 1.15, added_mass_normal: 1.0}
    rope: {diameter: 48 mm, mass: 1.7 kg/m, volume: 0.0018 m2, axial_stiffness: 4 MN, damping_ratio: 0.2,
           drag_normal: 1.6, drag_tangential: 0.05, added_mass_normal: 1.0}
  points:
    anchor: {kind: fixed, position: [0, 0, bed]}
    fairlead: {kind: fixed, position: [70 m, 0, -1 m]}
  lines:
    m:
      start: anchor
      end: fairlead
      parts:
        - {type: chain, length: 40 m, segments: BARS}
        - clump: {mass: 800 kg, volume: VOLUME m3}
        - {type: rope, length: 40 m, segments: BARS}
analyses: [statics]
"""


def tension(bars: int, volume: float) -> float:
    result = moyai.run(CASE.replace("BARS", f"{bars}").replace("VOLUME", f"{volume:g}"))
    assert result.status == "converged"
    return float(np.max(result.tree["SWL/statics"]["line_tension_of_mesh"].values[0, 0]))


@pytest.mark.parametrize("volume", [0.1, 0.0])
def test_the_tension_at_rest_does_not_grow_with_the_segments(volume: float) -> None:
    """The rope weighs 1.42 N/m upwards: some 34 N of it, and what holds it level, not the weight of the clump."""
    coarse, fine = tension(10, volume), tension(40, volume)
    assert 34.0 < coarse < 75.0
    assert abs(fine / coarse - 1.0) < 0.05
