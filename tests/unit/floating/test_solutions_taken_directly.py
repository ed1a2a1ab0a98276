"""Calls of floating bodies take the solution of a section as it is."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.floating import CumminsModel, Hydrodynamics, hydrostatics, inertia_matrix, natural_modes, solve_motions
from moyai.potential import rigid_modes, shapes, solve
from moyai.sea import Water

CENTRE = (0.0, -0.2)
SECTION = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
FOUND = solve(SECTION, Water(10.0, 1025.0, 9.81), [0.6, 1.0, 1.5], modes=rigid_modes(CENTRE))
STATICS = hydrostatics(SECTION, mass=4100.0, centre_of_gravity=CENTRE, length=1.0, density=1025.0, gravity=9.81)
INERTIA = inertia_matrix(4100.0, roll_gyradius=1.3)


@pytest.mark.parametrize("source", [FOUND, FOUND.dataset], ids=["solution", "dataset"])
def test_motions_and_modes_take_a_solution(source: Any) -> None:
    coefficients = Hydrodynamics.from_dataset(FOUND.dataset)
    known = solve_motions(coefficients, INERTIA, STATICS.stiffness)
    np.testing.assert_array_equal(solve_motions(source, INERTIA, STATICS.stiffness).displacement, known.displacement)
    expected = natural_modes(coefficients, INERTIA, STATICS.stiffness)
    np.testing.assert_array_equal(natural_modes(source, INERTIA, STATICS.stiffness).period, expected.period)


def test_what_holds_no_coefficients_is_refused() -> None:
    with pytest.raises(InputError, match="hydrodynamics: Section holds no radiation and diffraction"):
        solve_motions(SECTION, INERTIA, STATICS.stiffness)  # type: ignore[arg-type]


def test_a_solution_is_no_memory() -> None:
    with pytest.raises(InputError, match=r"memory: RadiationDiffraction is no memory; .*fit_memory"):
        CumminsModel(INERTIA, STATICS.stiffness, np.zeros((3, 3)), FOUND)  # type: ignore[arg-type]
