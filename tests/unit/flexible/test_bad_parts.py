"""Sheets, net panels, rings and sections that make no sense: one sentence each, nothing taken silently."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.flexible.build import NetworkBuilder
from moyai.flexible.elements import Bars, Nodes
from moyai.flexible.mass_blocks import MassBlocks
from moyai.flexible.network import Network
from moyai.flexible.panels import NetPanels, PanelLaw
from moyai.flexible.rings import Ring
from moyai.flexible.sheets import Sheets
from moyai.sea.water import Water

WATER = Water(20.0, 1000.0, 9.81)
NO_BARS = Bars([], [], [], [], ())
REST = [[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]]
LAW = PanelLaw.constant("plate", 1.0)
TURN = 2.0 * np.pi * np.arange(8) / 8.0
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN), 0.0 * TURN], axis=1)
LINE = np.stack([TURN, 0.0 * TURN, 0.0 * TURN], axis=1)
EIGHT = np.stack([np.sin(TURN), np.sin(2.0 * TURN), 0.0 * TURN], axis=1)


def network(**parts: object) -> Network:
    return Network(Nodes(CIRCLE, [1] * 8), NO_BARS, WATER, **parts)  # type: ignore[arg-type]


FAULTS: dict[str, tuple[Callable[[], object], str]] = {
    "half a node": (lambda: Sheets([[0, 1, 2.7]], REST, 1.0, 1.0), "holds 2.7"),
    "no node": (lambda: Sheets([[0, 1, np.nan]], REST, 1.0, 1.0), "holds nan"),
    "a word for a node": (lambda: Sheets([["a", 1, 2]], REST, 1.0, 1.0), "no number"),
    "ragged triangles": (lambda: Sheets([[0, 1], [0, 1, 2]], REST, 1.0, 1.0), "unequal length"),
    "ragged rest": (lambda: Sheets([[0, 1, 2]], [[[0, 0], [1, 0], [0]]], 1.0, 1.0), "unequal length"),
    "no area": (lambda: Sheets([[0, 1, 2]], [[[0, 0], [1, 0], [2, 0]]], 1.0, 1.0), "no area"),
    "a word for a stiffness": (lambda: Sheets([[0, 1, 2]], REST, "a", 1.0), "no number"),  # type: ignore[arg-type]
    "endless stiffness": (lambda: Sheets([[0, 1, 2]], REST, np.inf, 1.0), "warp_stiffness of a sheet is inf"),
    "one bare triangle": (lambda: Sheets([[0, 1, 2], [0, 2, 3]], REST * 2, [1, 0], [1, 0]), "triangle 1"),
    "a word for a switch": (lambda: Sheets([[0, 1, 2]], REST, 1, 1, tension_field="no"), "True or False"),  # type: ignore[arg-type]
    "absent corner": (lambda: network(sheets=Sheets([[0, 1, 9]], REST, 1.0, 1.0)), "node 9, which does not exist"),
    "absent knot": (lambda: network(panels=NetPanels(np.array([[0, 1, 2, 9]]), (LAW,))), "panel 0 names node 9"),
    "hole in a panel": (lambda: NetPanels(np.array([[-1, 1, 2, 3]]), (LAW,)), "negative"),
    "no panels": (lambda: NetPanels(np.zeros((0, 4), dtype=int), (LAW,)), "without corners"),
    "no area of a panel": (lambda: NetPanels(np.array([[0, 1, 2, 3]]), (LAW,), area=np.nan), "not finite"),
    "drag below zero": (lambda: PanelLaw.constant("pump", -1.0), "drag below zero"),
    "no decades": (lambda: PanelLaw("x", np.ones((3, 4)), np.ones((3, 4)), per_decade=0.0), "decade"),
    "lift across": (lambda: PanelLaw.tabulate("x", lambda a, s: (1.0 + 0.0 * a, 1.0 + 0.0 * a)), "does not vanish"),
    "absent node of a ring": (lambda: network(rings=(Ring("r", np.arange(8) + 3, CIRCLE, 1, 1),)), "does not exist"),
    "negative node of a ring": (lambda: network(rings=(Ring("r", np.arange(8) - 1, CIRCLE, 1, 1),)), "node -1"),
    "half nodes of a ring": (lambda: Ring("r", np.arange(8) + 0.5, CIRCLE, 1.0, 1.0), "holds 0.5"),
    "two in one place": (lambda: Ring("r", np.arange(8), CIRCLE[[0, 0, 2, 3, 4, 5, 6, 7]], 1.0, 1.0), "one place"),
    "a ring in a line": (lambda: Ring("r", np.arange(8), LINE, 1.0, 1.0), "encloses nothing"),
    "a crossed ring": (lambda: Ring("r", np.arange(8), EIGHT, 1.0, 1.0), "encloses nothing"),
    "a word for EI": (lambda: Ring("r", np.arange(8), CIRCLE, "x", 1.0), "bending_stiffness"),  # type: ignore[arg-type]
    "half a node of a section": (lambda: MassBlocks([[1.5]], [[[0, 2]]], np.eye(2)[None]), "holds 1.5"),
    "a word in a section": (lambda: MassBlocks([[1]], [[[0, 2]]], [[["a", 0], [0, 1]]]), "no number"),
}


@pytest.mark.parametrize("name", FAULTS)
def test_faults_are_reported_in_one_sentence(name: str) -> None:
    make, words = FAULTS[name]
    with pytest.raises(InputError, match=words):
        make()


def two_sheets(**other: object) -> NetworkBuilder:
    builder = NetworkBuilder(WATER)
    x, y = np.meshgrid([0.0, 1.0], [0.0, 1.0], indexing="ij")
    for name, shift, more in (("one", 0.0, {}), ("two", 5.0, other)):
        points = np.stack([x + shift, y, 0.0 * x - 3.0], axis=-1)
        values = {"warp_stiffness": 10.0, "weft_stiffness": 20.0, "mass_per_area": 1.0, **more}
        builder.sheet(name, points, warp=[0.0, 1.0], weft=[0.0, 1.0], first_row="fixed", **values)
    return builder


def test_what_one_of_two_sheets_leaves_out_has_its_default() -> None:
    """It was 0: a sheet next to one with a ``flow_factor`` lost all its drag."""
    sheets = two_sheets(flow_factor=0.4, pressure=3.0).build().sheets
    assert sheets is not None
    assert np.array_equal(sheets.flow_factor, [1.0, 1.0, 0.4, 0.4])
    assert np.array_equal(sheets.pressure, [0.0, 0.0, 3.0, 3.0])
    with pytest.raises(InputError, match="another one does not"):
        two_sheets(tension_field=False).build()
    with pytest.raises(InputError, match="no 'weight'"):
        two_sheets(weight=1.0).build()
