"""Nakamura, Ohmori and Ide: the chain mooring of their model, at rest and displaced (nakamura_chain_offsets.txt)."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from moyai.mooring.catenary import solve_catenary
from moyai.mooring.shoji import solve_shoji
from moyai.validation.mooring import CASES, NAKAMURA_CHAIN, nakamura_model

TABLE = np.loadtxt(Path(__file__).parent / "data" / "nakamura_chain_offsets.txt")
REACH, RISE, LENGTH, AXIAL, WEIGHT = NAKAMURA_CHAIN
OF_THE_LIST = [case for case in CASES if "Nakamura" in case.name]


@pytest.mark.parametrize("case", OF_THE_LIST, ids=[case.name for case in OF_THE_LIST])
def test_cases_of_the_list(case) -> None:
    """Horizontal tension at rest and displaced, Shoji's formula, stiffness of four chains."""
    assert case.error(case.compute()) <= case.tolerance


@pytest.mark.parametrize("row", TABLE, ids=[f"{row[0]:g} cm" for row in TABLE])
def test_horizontal_tension_against_offset(row: np.ndarray) -> None:
    """Half a unit of the last digit and the last digit of w (0.05 per cent, tenfold near taut)."""
    reach = REACH + row[0] / 100.0
    elastic = float(solve_catenary(reach, RISE, LENGTH, AXIAL, WEIGHT).horizontal_tension)
    rigid = float(solve_catenary(reach, RISE, LENGTH, np.inf, WEIGHT).horizontal_tension)
    assert elastic == pytest.approx(row[1], rel=7e-3 if row[0] > 3.1 else 2e-3)
    assert rigid == pytest.approx(row[2], rel=2e-3)


def test_rest_state() -> None:
    line = solve_catenary(REACH, RISE, LENGTH, AXIAL, WEIGHT)
    assert line.vertical_tension_fairlead == pytest.approx(1.080, abs=5e-4)
    assert line.grounded_length == pytest.approx(1.013, abs=5e-4)


def test_lift_off_offsets() -> None:
    """Lift-off between +2.6 and +2.7 cm; taut (inextensible chord) at +3.19 cm."""
    for offset, lifted in ((2.55, False), (2.7, True)):
        line = solve_catenary(REACH + offset / 100.0, RISE, LENGTH, AXIAL, WEIGHT)
        assert bool(line.vertical_tension_anchor > 0.0) is lifted
    assert np.sqrt(LENGTH**2 - RISE**2) - REACH == pytest.approx(0.0319, abs=5e-4)


def test_shoji_gives_the_same_line() -> None:
    shoji = solve_shoji(REACH, RISE, LENGTH, AXIAL, WEIGHT)
    exact = solve_catenary(REACH, RISE, LENGTH, AXIAL, WEIGHT)
    assert shoji.horizontal_tension == pytest.approx(float(exact.horizontal_tension), rel=1e-12)


def test_stiffness_of_four_lines() -> None:
    stiffness = nakamura_model().stiffness([0.0, 0.0, 0.0], about=(0.0, -0.027))
    assert stiffness[1, 1] == pytest.approx(31.7, rel=2e-3)
    half = nakamura_model(1).stiffness([0.0, 0.0, 0.0], about=(0.0, -0.027))
    assert np.allclose(2.0 * half, stiffness)


def test_stiffness_under_drift() -> None:
    """T = 0.95 s: a drift force of 1.34 N moves the model by 4.5 mm and stiffens it to 311.6 N/m."""
    hydrostatic = np.diag([0.0, 3675.6, 31.98])
    # the roll restoring is that about the centre of gravity; 2.7 cm higher it changes no printed digit here
    view = nakamura_model()
    found = view.equilibrium([1.34, 0.0, 0.0], hydrostatic, subtract_equilibrium_force=True)
    assert found.position[0] == pytest.approx(4.5e-3, abs=1e-4)
    stiffness = view.stiffness(found.position, about=(0.0, -0.027))
    assert stiffness[0, 0] == pytest.approx(311.6, rel=2e-3)
    assert stiffness[1, 1] == pytest.approx(31.9, rel=2e-3)
    assert stiffness[2, 2] == pytest.approx(2.46, rel=5e-3)
