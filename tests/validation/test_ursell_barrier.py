"""F. Ursell (1947), The effect of a fixed vertical barrier on surface waves in deep water, Proc. Camb. Phil. Soc. 43.

|R| and |T| of a barrier from the still water down to the depth a, in closed form with modified Bessel functions.
"""

import math

import numpy as np
import pytest

from moyai.potential.thin_plate import Plate
from moyai.potential.thin_plate_waves import solve_plate_waves
from moyai.sea.water import Water
from moyai.validation.thin_plates import CASES, ursell_barrier


@pytest.mark.parametrize("case", [case for case in CASES if case.source.startswith("Ursell (1947)")])
def test_the_case_of_the_list(case):
    assert case.error(case.compute()) <= case.tolerance


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_reflection_and_transmission(seed):
    rng = np.random.default_rng(seed)
    draught, x = 10.0 ** rng.uniform(-1, 1.5), rng.uniform(-20, 20)
    ka = np.sort(10.0 ** rng.uniform(-1.5, 0.7, 5))
    found = solve_plate_waves(
        Plate((x, 0.0), (x, -draught)), Water(math.inf, 1025.0, 9.81), np.sqrt(9.81 * ka / draught), accuracy=1e-5
    )
    reflected, transmitted = ursell_barrier(ka)
    turn = np.exp(2j * ka / draught * x)
    assert np.abs(found.reflection_coefficient[:, 0] - reflected * turn).max() < 1e-5
    assert np.abs(found.reflection_coefficient[:, 1] - reflected / turn).max() < 1e-5
    assert np.abs(found.transmission_coefficient - transmitted[:, None]).max() < 1e-5


def test_a_barrier_in_water_of_many_draughts_is_in_deep_water():
    ka = np.array([0.3, 1.0, 3.0])
    found = solve_plate_waves(Plate((0, 0), (0, -1)), Water(40.0, 1025.0, 9.81), np.sqrt(9.81 * ka), accuracy=1e-5)
    assert np.abs(found.reflection_coefficient[:, 0] - ursell_barrier(ka)[0]).max() < 1e-3
