"""All lines of a row in one call against the line system of every unit, and tensions against their differences."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.mooring import LineType, Segment
from moyai.mooring.rotations import roll_pitch_yaw, rotation_from_vector
from moyai.structures.units.assembly import RowAtLevel
from moyai.structures.units.model import UnitLine
from moyai.validation.units import WATER, at_rest, row

CHAIN = Segment(LineType("chain", submerged_weight=400.0, axial_stiffness=2e8), length=46.0)
ROPE = Segment(LineType("rope", submerged_weight=20.0, axial_stiffness=2e6), length=20.0)


def moored() -> RowAtLevel:
    """Two boxes on chains that lie and hang, on chains with a rope, and on springs; the second one is turned."""
    depth = WATER.depth
    lines = (
        UnitLine("chain", 2, (0, 1), (-4.0, -6.0, 0.4), (-46.0, -12.0, 0.0), segments=(CHAIN,), bed_friction=0.4),
        UnitLine("mixed", 1, (0, 1), (4.0, 6.0, 0.4), (64.0, 9.0, 0.0), segments=(CHAIN, ROPE)),
        UnitLine("spring", 1, (1,), (0.0, 8.0, 1.0), (0.0, 60.0, depth), stiffness=3e4, pretension=0.0),
    )
    given = replace(row(()), lines=lines)
    turned = replace(given.placements[1], heading=0.3)
    return at_rest(replace(given, placements=(given.placements[0], turned)))


@pytest.mark.parametrize("offset", [0.0, 0.5, 1.5])
def test_force_stiffness_and_tension_are_those_of_each_unit(offset: float) -> None:
    at = moored()
    position = offset * np.array([0.8, -0.4, 0.2, 0.01, -0.02, 0.015, -0.6, 0.5, -0.1, 0.02, 0.01, -0.02])
    found = at.row_lines.at(position)
    # the system of a unit takes its turn as angles one after the other, the row as one vector
    turns = position.reshape(2, 6)[:, 3:]
    turns[:] = roll_pitch_yaw(rotation_from_vector(turns))
    stiffness = np.zeros((12, 12))
    for unit, system in enumerate(at.systems):
        part = slice(6 * unit, 6 * unit + 6)
        own = position[part]
        np.testing.assert_allclose(found.force[part], system.forces(own), rtol=1e-12, atol=1e-6)
        stiffness[part, part] = system.stiffness(own)
    np.testing.assert_allclose(found.stiffness, stiffness, rtol=0.0, atol=1e-12 * np.abs(stiffness).max())
    tension = [system.tensions(position[6 * unit : 6 * unit + 6]) for unit, system in enumerate(at.systems)]
    np.testing.assert_allclose(found.tension, np.concatenate(tension), rtol=1e-12, atol=1e-9)


@pytest.mark.parametrize("offset", [0.01, 0.5, 1.5])
def test_the_gradient_of_the_tensions_is_that_of_their_differences(offset: float) -> None:
    """About an untilted position, where angles and small turns are the same."""
    at = moored()
    position = offset * np.array([0.8, -0.4, 0.2, 0, 0, 0, -0.6, 0.5, -0.1, 0, 0, 0])
    found = at.row_lines.at(position).tension_gradient
    for motion in range(12):
        step = np.zeros(12)
        step[motion] = 1e-5
        change = (at.tensions(position + step) - at.tensions(position - step)) / 2e-5
        np.testing.assert_allclose(found[:, motion], change, rtol=1e-5, atol=1e-5 * np.abs(found).max())
