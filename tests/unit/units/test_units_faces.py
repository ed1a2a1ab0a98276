"""Which faces of units face each other: whatever the order and the headings that they are listed with."""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import numpy as np
import pytest

from moyai.case.builder import build
from moyai.case.reader import case_of
from moyai.case.templates import template
from moyai.case.yaml_reader import parse_yaml
from moyai.structures.units.faces import between, gaps_between, meeting
from moyai.structures.units.gaps import gaps_of
from moyai.structures.units.model import Placement, straight_row
from moyai.validation.units import at_rest

LENGTH, BOUNDS = 12.0, (-2.0, 2.0)


def found(places):
    return {(met.pair, round(met.distance, 9)) for met in gaps_between(places, LENGTH, BOUNDS)}


def test_neighbours_of_a_row_meet_in_any_order() -> None:
    row = straight_row(3, LENGTH, 0.5)
    assert found(row) == {((0, 1), 0.5), ((1, 2), 0.5)}
    for order in permutations(range(3)):
        places = [row[i] for i in order]
        names = {tuple(order[unit] for unit in pair) for pair, _ in found(places)}
        assert names == {(0, 1), (1, 2)}
    assert found(straight_row(1, LENGTH, 0.5)) == set()


def test_units_to_the_millimetre_turned_shifted_and_side_by_side_meet() -> None:
    assert found([Placement(0.0, 0.0, 0.5), Placement(-5.993, 10.971, 0.5)]) != set()
    assert found([Placement(0.0, 0.0), Placement(0.4, 12.5)]) != set()
    side = gaps_between([Placement(0.0, 0.0), Placement(4.6, 3.0)], LENGTH, BOUNDS)[0]
    assert side.pair == (0, 1) and side.distance == pytest.approx(0.6)
    assert side.frame[1] == pytest.approx([1.0, 0.0, 0.0])
    assert side.start == pytest.approx([2.0, 1.5])  # in the middle of the nine metres that face each other
    # three side by side: the middle one lies between the others
    three = [Placement(4.6 * n, 0.0) for n in range(3)]
    assert {pair for pair, _ in found(three)} == {(0, 1), (1, 2)}
    assert between(three, meeting(three, (0, 2), LENGTH, BOUNDS), LENGTH, BOUNDS) == 1


def test_an_end_before_a_side_meets_it_where_it_stands() -> None:
    places = [Placement(0.0, 0.0), Placement(2.0 + 0.5 + 6.0, 3.0, 0.5 * np.pi)]
    met = gaps_between(places, LENGTH, BOUNDS)[0]
    # from the end at +y of the second to the side of the first
    assert met.pair == (1, 0) and met.frame[1] == pytest.approx([-1.0, 0.0, 0.0])
    assert met.start == pytest.approx([2.5, 3.0]) and met.end == pytest.approx([2.0, 3.0])


@pytest.mark.parametrize("across", [0.0, 1.2])
def test_a_place_is_the_same_whatever_the_headings(across: float) -> None:
    row = straight_row(2, LENGTH, 0.5)
    for one, other in ((0.0, 0.0), (0.0, np.pi), (np.pi, np.pi)):
        places = [Placement(0.0, row[0].y, one), Placement(0.0, row[1].y, other)]
        for pair in ((0, 1), (1, 0)):
            met = meeting(places, pair, LENGTH, BOUNDS)
            start, end = met.joined_at(across)
            # across counts in axes of the unit before it
            expected = across if places[met.near.unit].heading == 0.0 else -across
            assert start[0] == pytest.approx(expected) and end[0] == pytest.approx(expected)
            assert sorted([start[1], end[1]]) == pytest.approx([-0.25, 0.25])


UNITS = "units: {count: 3, length: 20 m, gap: 1 m}"
PIN = "- {name: pin, kind: hinge, axis: x, above_keel: 3 m, breaking_load: 3 MN}"
FENDER = "- {name: f, kind: fender, above_keel: 2 m, between: BETWEEN, stiffness: 1 MN/m, clearance: 0.05 m}"


def rows(units: str, between: str = "all"):
    text = template("units").replace(UNITS, units, 1).replace(PIN, FENDER.replace("BETWEEN", between), 1)
    return at_rest(build(case_of(parse_yaml(text, "case.yaml"), Path("case.yaml"))).row)


PLACES = ("{y: -21 m}", "{y: 0 m}", "{y: 21 m}")


@pytest.mark.parametrize(
    ("units", "pairs"),
    [
        ("units: {count: 3, length: 20 m, gap: 1 m}", "[[2, 1], [3, 2]]"),
        (f"units: {{length: 20 m, places: [{', '.join(PLACES[::-1])}]}}", "all"),
        ("units: {length: 20 m, places: [{y: -21 m}, {y: 0 m, heading_deg: 180}, {y: 21 m}]}", "all"),
    ],
)
def test_a_fender_bears_where_its_gap_closes_whatever_the_order(units: str, pairs: str) -> None:
    at = rows(units, pairs)
    up = np.argsort([place.y for place in at.row.placements])
    position = np.zeros(at.size)
    # motions are along the axes of the row: the lowest unit moves up by 0.2 m and closes its gap
    lowest = [joint for joint in at.joints if int(up[0]) in joint.pair]
    position[6 * up[0] + 1] = 0.2
    assert [joint.elongation(position) for joint in lowest] == [pytest.approx(-0.2)]
    gap = next(gap for gap in gaps_of(at) if int(up[0]) in gap.pair)
    assert gap.width == pytest.approx(1.0)
    assert gap.rows(at.size) @ position == pytest.approx(np.full(len(gap.weight), 0.2))
    assert gap.largest(position[None]) == pytest.approx(0.2)


def test_corners_of_turned_units_count_by_their_own_clearance() -> None:
    """A unit turned by 2 degrees about its near end: a corner stands half a beam times the sine nearer."""
    turn, half = np.radians(2.0), 10.0
    middle = np.array([0.0, -10.5 + 21.0 - 10.0]) + half * np.array([-np.sin(turn), np.cos(turn)])
    units = f"units: {{length: 20 m, places: [{{y: -10.5 m}}, {{x: {middle[0]} m, y: {middle[1]} m, heading_deg: 2}}]}}"
    at = rows(units)
    (gap,) = gaps_of(at)
    outline = np.concatenate([item.edges.polyline() for item in at.row.hull.outlines])
    reach = float(np.abs(outline[:, 0]).max())
    assert gap.width == pytest.approx(1.0 - reach * np.sin(turn), rel=1e-6)
    push = np.zeros(at.size)
    push[1] = gap.width
    # the nearest corner has met, the others have not
    closing = gap.rows(at.size) @ push
    assert closing.max() == pytest.approx(gap.width) and closing.min() < 0.9 * gap.width


def test_units_on_both_sides_of_the_first_one_do_not_face_each_other() -> None:
    """Three narrow units side by side, the middle one listed first."""
    places = [Placement(0.0, 0.0), Placement(-4.6, 0.0), Placement(4.6, 0.0)]
    assert {met.pair for met in gaps_between(places, LENGTH, BOUNDS)} <= {(0, 1), (1, 0), (0, 2), (2, 0)}
