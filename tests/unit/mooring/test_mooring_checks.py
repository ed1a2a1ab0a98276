"""Every bad mooring gets its one clear finding, a sound one none."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.mooring.checks import check_line_system
from moyai.mooring.lines import Clump, Line, LineType, Segment
from moyai.mooring.system import LineSystem

BOX = ((-5.0, -10.0, -3.0), (5.0, 10.0, 1.5))


def system(
    *,
    length: float = 100.0,
    anchor: tuple[float, float, float] = (103.0, 0.0, -10.0),
    fairlead: tuple[float, float, float] = (5.0, 0.0, -2.0),
    breaking_load: float = 2e6,
    depth: float = 10.0,
) -> LineSystem:
    chain = LineType("chain", 420.0, 2e8, breaking_load)
    return LineSystem((Line("east", anchor, fairlead, (Segment(chain, length),)),), depth)


def codes(lines: LineSystem, **arguments: object) -> dict[str, str]:
    return {notice.code: notice.severity for notice in check_line_system(lines, **arguments)}  # type: ignore[arg-type]


def test_a_sound_line_gives_nothing() -> None:
    assert codes(system(), body_box=BOX) == {}


@pytest.mark.parametrize(
    ("changes", "code", "severity"),
    [
        ({"length": 97.0}, "mooring-line-breaks", "error"),
        ({"length": 107.0}, "mooring-line-heap", "error"),
        ({"anchor": (103.0, 0.0, -8.0)}, "mooring-anchor-above-bed", "warning"),
        ({"anchor": (3.0, 0.0, -1.0)}, "mooring-anchor-in-body", "error"),
        ({"fairlead": (5.0, 0.0, -10.5)}, "mooring-fairlead-below-bed", "error"),
        ({"length": 98.15}, "mooring-anchor-uplift", "information"),
        ({"fairlead": (5.0, 0.0, 0.5)}, "mooring-fairlead-dry", "information"),
    ],
)
def test_each_fault_is_named(changes: dict[str, object], code: str, severity: str) -> None:
    lines = system(**changes)  # type: ignore[arg-type]
    assert codes(lines, body_box=BOX).get(code) == severity


def test_heap_limit_is_the_sum_of_both_distances() -> None:
    reach, rise = 98.0, 8.0
    assert "mooring-line-heap" not in codes(system(length=reach + rise - 0.01))
    assert "mooring-line-heap" in codes(system(length=reach + rise + 0.01))


def test_inextensible_line_that_cannot_reach() -> None:
    chain = LineType("chain", 420.0, np.inf)
    lines = LineSystem((Line("east", (103.0, 0, -10), (5.0, 0, -2), (Segment(chain, 98.0),)),), 10.0)
    assert codes(lines)["mooring-line-unreachable"] == "error"


def test_breaking_load_of_the_weakest_segment() -> None:
    strong, weak = LineType("a", 420.0, 2e8, 1e7), LineType("b", 50.0, 2e8, 1e3)
    line = Line("east", (103.0, 0, -10), (5.0, 0, -2), (Segment(strong, 80.0), Segment(weak, 20.0)))
    assert line.breaking_load == 1e3
    assert codes(LineSystem((line,), 10.0))["mooring-line-breaks"] == "error"


def test_second_contact_is_an_error() -> None:
    chain = LineType("chain", 300.0, 1e8)
    parts = (Segment(chain, 10.0), Segment(chain, 60.0))
    lines = LineSystem((Line("l", (0, 0, -20), (50, 0, -0.5), parts, (Clump(0, -2500.0),)),), 20.0)
    assert codes(lines)["mooring-touches-between"] == "error"


def test_buoy_that_would_leave_the_water() -> None:
    chain = LineType("chain", 100.0, 1e8)
    parts = (Segment(chain, 24.0), Segment(chain, 14.0))
    for buoyancy, expected in ((2e4, True), (1e3, False)):
        lines = LineSystem((Line("l", (20.0, 0, -20), (0, 0, -1), parts, (Clump(0, -buoyancy),)),), 20.0)
        assert ("mooring-buoy-above-water" in codes(lines)) is expected
