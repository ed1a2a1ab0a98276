"""Gaps and their axes are those of the geometry: symmetric units turned about, listed anew, sites mirrored."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from test_units_faces import rows

from moyai.structures.units.faces import gaps_between, meeting
from moyai.structures.units.gaps import gaps_of
from moyai.structures.units.mesh import clearance
from moyai.structures.units.model import Placement

LENGTH, BOUNDS = 12.0, (-2.0, 2.0)


def bent(seed: int) -> list[Placement]:
    """Return two rectangles at random turns that stand apart, nearer than one is long."""
    rng = np.random.default_rng(seed)
    while True:
        places = [
            Placement(*rng.uniform(-3.0, 3.0, 2), rng.uniform(-np.pi, np.pi)),
            Placement(*rng.uniform(-14.0, 14.0, 2), rng.uniform(-np.pi, np.pi)),
        ]
        if 0.1 < clearance(*(rectangle(place) for place in places)) < 3.0:
            return places


def rectangle(place: Placement) -> np.ndarray:
    corners = np.array([(x, y) for x, y in ((-2.0, -6.0), (2.0, -6.0), (2.0, 6.0), (-2.0, 6.0))])
    return np.array([place.x, place.y]) + corners @ place.rotation[:2, :2].T


def found(places: list[Placement]) -> tuple[set[tuple[float, ...]], np.ndarray, bool]:
    """Return both points where units meet, the line across the gap without its sense, and whether there is a gap."""
    met = meeting(places, (0, 1), LENGTH, BOUNDS)
    across = met.frame[1]
    points = {tuple(np.round(point, 6) + 0.0) for point in (met.start, met.end)}
    return points, np.outer(across, across), bool(gaps_between(places, LENGTH, BOUNDS))


@pytest.mark.parametrize("seed", range(40))
def test_what_meets_is_that_of_the_geometry(seed: int) -> None:
    places = bent(seed)
    points, line, gap = found(places)
    for order, *turns in product((1, -1), (0.0, np.pi), (0.0, np.pi)):
        other = [Placement(p.x, p.y, p.heading + turn) for p, turn in zip(places, turns, strict=True)][::order]
        again = found(other)
        assert again[0] == points and again[2] == gap
        assert again[1] == pytest.approx(line, abs=1e-9)
    mirrored = found([Placement(p.x, -p.y, -p.heading) for p in places])
    assert mirrored[0] == {(x, -y + 0.0) for x, y in points} and mirrored[2] == gap
    flip = np.diag([1.0, -1.0, 1.0])
    assert mirrored[1] == pytest.approx(flip @ line @ flip, abs=1e-9)


def test_axes_of_a_gap_halve_the_angle_of_its_faces() -> None:
    """Two boxes as a V, mirrored in the line between them: across is the normal of that line, exactly."""
    turn = np.radians(15.0)
    x, y = 6.5 * np.sin(turn), 6.5 * np.cos(turn)
    met = meeting([Placement(x, -y, turn), Placement(x, y, -turn)], (0, 1), LENGTH, BOUNDS)
    assert met.frame == pytest.approx(np.eye(3), abs=1e-12)


def opening(places: list[str], move: np.ndarray) -> dict[str, object]:
    """Return width and opening of the gap, and what the connector moves by, of given motions by the order listed."""
    at = rows(f"units: {{length: 20 m, places: [{', '.join(places)}]}}")
    position = np.zeros(at.size)
    position[:] = move
    (gap,), (joint,) = gaps_of(at), at.joints
    relative = np.abs(joint.relative @ position)
    return {
        "name": gap.name, "width": gap.width, "closing": gap.largest(position[None]),
        "corners": sorted(gap.rows(at.size) @ position), "relative": relative.tolist(),
        "place": joint.place.tolist(), "elongation": joint.elongation(position),
    }  # fmt: skip


@pytest.mark.parametrize("heading", [-50.0, -30.0, -12.0])
def test_gaps_and_connectors_open_alike_however_a_unit_is_described(heading: float) -> None:
    """A box described by its heading or by that of its other end: the same gap, connector, opening."""
    move = np.random.default_rng(7).normal(0.0, 0.05, 12)
    turn = np.radians(heading)
    x, y = -10.0 * np.sin(turn) + 1.0, 11.0 + 6.0 * abs(np.sin(turn)) + 10.0 * np.cos(turn)
    first = ["{x: 0 m, y: 0 m}", "{x: 0 m, y: 0 m, heading_deg: 180}"]
    second = [f"{{x: {x} m, y: {y} m, heading_deg: {heading + more}}}" for more in (0.0, 180.0)]
    whole = opening([first[0], second[0]], move)
    swapped = np.concatenate([move[6:], move[:6]])
    for one, two in product(first, second):
        for places, moved in (([one, two], move), ([two, one], swapped)):
            other = opening(places, moved)
            assert other.pop("name") == "gap 1-2"
            for key, value in other.items():
                assert value == pytest.approx(whole[key], rel=1e-6, abs=1e-9), key
