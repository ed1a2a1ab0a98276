"""Closing of gaps at the corners of hulls: by hand, and against small motions."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from moyai.structures.units.gaps import gaps_of, largest_closing
from moyai.structures.units.model import Connector, Placement
from moyai.validation.units import at_rest, row

PIN = Connector("pin", "hinge", ((0, 1),), 0.0, 3.0, (1.0, 0.0, 0.0))
GUIDE, SPRING = (
    Connector("s", "spring", ((0, 1),), 0.0, 3.0, stiffness=np.diag([1e6, along, 1e6, 0.0, 0.0, 0.0]))
    for along in (0.0, 5e6)
)
#: Of the deck above the centre of gravity, half of a unit [m]
DECK, HALF = 4.5 - 2.29, 10.0


@pytest.mark.parametrize(("connectors", "drawn"), [((), 1.0), ((GUIDE,), 1.0), ((PIN,), 0.0), ((SPRING,), 0.0)])
def test_two_decks_that_lean_on_each_other(connectors: tuple[Connector, ...], drawn: float) -> None:
    """Each deck comes nearer by its height times the turn; a free unit is drawn in by t^2 / 2 of its half length."""
    at = at_rest(row(connectors))
    (gap,) = gaps_of(at)
    assert gap.name == "gap 1-2" and gap.width == pytest.approx(1.0)
    turn, position = 0.1, np.zeros((2, 12))
    position[1, 3], position[1, 9] = -turn, turn
    assert gap.largest(position[:1]) == 0.0
    expected = 2.0 * (DECK * turn - drawn * 0.5 * HALF * turn**2)
    assert gap.largest(position) == pytest.approx(expected, rel=1e-12)


def test_surge_sway_and_yaw_close_a_gap_as_small_motions_do() -> None:
    at = at_rest(row())
    generator = np.random.default_rng(4)
    for _ in range(5):
        position = 1e-5 * generator.normal(size=12)
        (small,) = largest_closing(at, position, lambda rows: np.zeros(len(rows)))
        assert gaps_of(at)[0].largest(position[None]) == pytest.approx(small, abs=1e-8)


def test_gaps_are_those_of_neighbours_that_face_each_other() -> None:
    assert [gap.name for gap in gaps_of(at_rest(row(count=3)))] == ["gap 1-2", "gap 2-3"]
    corner = replace(row(), placements=(Placement(0.0, 0.0), Placement(16.0, 16.5, 0.5 * np.pi)))
    assert not gaps_of(at_rest(corner))
