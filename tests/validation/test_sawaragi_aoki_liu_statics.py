"""Sawaragi, Aoki and Liu (1991): static members, equations (2) to (6), and the load laws of practice."""

from __future__ import annotations

from pathlib import Path

import pytest

from moyai.structures.curtain.statics.closed_forms import (
    arc_tension_ratio,
    cable_shape_number,
    cable_tension_ratio,
    solve_cable,
)
from moyai.structures.curtain.statics.load_laws import plan_laws, section_laws

ROWS = [
    line.split()
    for line in (Path(__file__).parent / "data" / "curtain_closed_forms.txt").read_text(encoding="utf-8").splitlines()
    if line and not line.startswith("#")
]


def rows(kind: str) -> list[list[float]]:
    return [[float(part) for part in row[1:]] for row in ROWS if row[0] == kind]


@pytest.mark.parametrize("row", rows("6"), ids=str)
def test_inextensible_cable(row: list[float]) -> None:
    ratio, shape, tension, sag = row
    assert float(cable_shape_number(ratio)) == pytest.approx(shape, abs=6e-7)
    assert float(cable_tension_ratio(ratio)) == pytest.approx(tension, abs=6e-7)
    assert float(solve_cable(1.0, 1.0 / ratio, 1.0).sag) == pytest.approx(sag, abs=6e-7)


@pytest.mark.parametrize("row", rows("4"), ids=str)
def test_cable_with_stretch(row: list[float]) -> None:
    assert float(cable_tension_ratio(row[0], row[1])) == pytest.approx(row[2], abs=6e-7)


@pytest.mark.parametrize("row", rows("2"), ids=str)
def test_arc_of_the_skirt(row: list[float]) -> None:
    assert float(arc_tension_ratio(row[0], row[1])) == pytest.approx(row[2], abs=6e-7)


@pytest.mark.parametrize("row", rows("plan"), ids=str)
def test_load_laws_in_plan(row: list[float]) -> None:
    catenary, circular, *_ = plan_laws(row[0], 1.0, 1.0, 1e12)
    assert [catenary.tension, catenary.sag, circular.tension] == pytest.approx(row[1:], abs=6e-6)


@pytest.mark.parametrize("row", rows("section"), ids=str)
def test_load_laws_in_section(row: list[float]) -> None:
    catenary, circular, rigid, elastic = section_laws(1.0, 1.0, row[0])
    found = [catenary.effective_depth, catenary.flare]
    assert found == pytest.approx(row[1:3], abs=6e-6)
    assert rigid.effective_depth == pytest.approx(row[4], abs=6e-6)
    assert elastic.effective_depth == catenary.effective_depth
    if row[0] < 3.1:
        assert circular.effective_depth == pytest.approx(row[3], abs=6e-6)
    else:
        assert circular.effective_depth != circular.effective_depth
