"""Coefficients straight from the solution of a section are those of its dataset, to the bit."""

from __future__ import annotations

import numpy as np

from moyai.floating import Hydrodynamics
from moyai.potential import rigid_modes, shapes, solve
from moyai.sea import Water


def test_a_solution_gives_the_coefficients_of_its_dataset() -> None:
    section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    found = solve(section, Water(10.0, 1025.0, 9.81), [0.9, 0.3, 1.7], modes=rigid_modes((0.0, -0.2)))
    straight, read = Hydrodynamics.from_section(found), Hydrodynamics.from_dataset(found.dataset)
    assert straight.modes == read.modes and straight.length == read.length
    for name in (
        "omega", "heading", "added_mass", "radiation_damping", "excitation_force", "infinite_frequency_added_mass",
        "reflection_coefficient", "transmission_coefficient", "radiated_wave",
    ):  # fmt: skip
        np.testing.assert_array_equal(getattr(straight, name), getattr(read, name), err_msg=name)
