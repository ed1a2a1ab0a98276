"""Hydrodynamics of the floating breakwater of Nakamura, Ohmori and Ide (model scale, per metre), and of its prototype.

Model: B = h = 0.38 m, draught 0.113 m, centre of gravity at z = -0.027 m. Values found by matched eigenfunctions with
240 terms (0.3 % for b33 at T = 0.6 s, where it is 1 % with 60 terms); by constant panels 10.18, 93.86, .3083 for m*.
"""

import math

import numpy as np
import pytest

from moyai.potential import shapes
from moyai.potential.modes import rigid_modes
from moyai.potential.solver import solve
from moyai.sea.water import Water

#: T: a11, a22, a33, b11, b22, b33, X1, X2, X3, R, T
TABLE = {
    0.60: (1.910, 74.27, 0.2973, 175.9, 34.43, 0.0157, 1273.5, 563.3, 12.03, 0.9997, 0.0235),
    0.95: (18.08, 55.23, 0.2890, 207.9, 191.4, 0.1831, 1852.3, 1777.7, 54.98, 0.9422, 0.3352),
    1.60: (37.92, 48.74, 0.3253, 88.04, 308.1, 0.1772, 1567.5, 2932.3, 70.32, 0.6296, 0.7769),
}


@pytest.fixture(scope="module")
def model():
    omega = 2.0 * math.pi / np.array(list(TABLE))
    section = shapes.rectangle(0.38, 0.17).immersed(0.113)
    return solve(section, Water(0.38, 1000.0, 9.81), omega, modes=rigid_modes((0.0, -0.027)))


@pytest.mark.parametrize("index", range(3))
def test_coefficients_of_the_model(model, index):
    row = list(TABLE.values())[index]
    found = [
        *np.diag(model.added_mass[index]),
        *np.diag(model.radiation_damping[index]),
        *np.abs(model.excitation_force[index, 0]),
        abs(model.reflection_coefficient[index, 0]),
        abs(model.transmission_coefficient[index, 0]),
    ]
    for value, reference in zip(found, row):
        # four printed digits, three for b33 at T = 0.6 s
        assert value == pytest.approx(reference, rel=1.5e-3, abs=7e-5)


def test_limit_at_infinite_frequency(model):
    mass = model.infinite_frequency_added_mass
    assert np.diag(mass) == pytest.approx([10.16, 93.77, 0.3081], rel=1e-3)
    assert mass[0, 2] == pytest.approx(0.142, abs=5e-4)


def test_prototype_pontoon():
    """10 m x 3 m in 10 m of water; t/m from a converging two-dimensional prototype."""
    omega = [0.5, 1.0128205, 1.5256410, 2.0384615, 2.5]
    section = shapes.rectangle(10.0, 4.5).immersed(3.0)
    found = solve(section, Water(10.0, 1000.0, 9.81), omega, modes=rigid_modes((0.0, 0.0)))
    a11, a33 = (found.added_mass[:, i, i] / 1000.0 for i in (0, 1))
    b11, b33 = (found.radiation_damping[:, i, i] / 1000.0 for i in (0, 1))
    assert a33 == pytest.approx([32.99, 35.36, 42.36, 51.63, 56.88], rel=1e-3)
    assert a11 == pytest.approx([29.67, 21.07, 6.48, 1.32, 1.11], rel=2e-3, abs=2e-2)
    assert b11 == pytest.approx([4.98, 20.90, 29.92, 23.99, 17.73], rel=3e-3)
    assert b33 == pytest.approx([46.21, 35.09, 17.07, 4.59, 1.01], rel=2e-3)
