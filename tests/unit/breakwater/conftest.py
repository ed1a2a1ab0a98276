"""A small breakwater problem: the tank model in two regular waves."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from moyai.mooring.lines import LineType, Segment
from moyai.potential.shapes import rectangle
from moyai.sea.water import Water
from moyai.structures.breakwater import run as running
from moyai.structures.breakwater.model import (
    Breakwater,
    BreakwaterProblem,
    Damping,
    Environment,
    MooringLine,
    RegularSea,
)


def chains(count: int = 2, length: float = 1.975) -> tuple[MooringLine, ...]:
    chain = LineType("chain", 1.122, 2.14e4)
    return tuple(
        MooringLine(name, count, (side * 0.19, 0.0, 0.0), (side * 2.115, 0.0, 0.0), (Segment(chain, length),))
        for name, side in (("seaward", -1), ("shoreward", 1))
    )


@pytest.fixture
def pontoon_problem() -> BreakwaterProblem:
    unit = Breakwater(
        rectangle(0.38, 0.17),
        0.986,
        0.101,
        (0.0, 0.086),
        mass=41.6,
        draught=0.113,
        damping=Damping(0.15),
        lines=chains(),
    )
    sea = RegularSea("waves", 0.02, (0.8, 1.0))
    environment = Environment(Water(0.38, 1000.0, 9.81), (("SWL", 0.0),), (sea,))
    return BreakwaterProblem("tank model", unit, environment)


@pytest.fixture
def nothing_remembered() -> Iterator[None]:
    """Compute regular waves anew in a test that changes how, and leave nothing of it to others."""
    running._REGULAR.clear()
    yield
    running._REGULAR.clear()
