"""Circles by multipoles against limits in closed form and energy."""

import math

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.potential.multipole_circle import half_immersed_circle, submerged_circle


@pytest.mark.slow
@pytest.mark.parametrize("mode", ["sway", "heave"])
@pytest.mark.parametrize("seed", [*range(1), *(pytest.param(s, marks=pytest.mark.slow) for s in range(1, 4))])
def test_half_circle_gives_the_waves_their_energy(mode, seed):
    rng = np.random.default_rng(seed)
    for ka in 10.0 ** rng.uniform(-3.0, 0.7, 3):
        coarse = half_immersed_circle(ka, mode, multipoles=128)
        assert coarse.energy_defect < 1e-9
        fine = half_immersed_circle(ka, mode, multipoles=256)
        assert coarse.added_mass == pytest.approx(fine.added_mass, rel=1e-9)


@pytest.mark.slow
def test_half_circle_limits():
    # slow sway is that of a whole circle in an unbounded fluid; slow heave makes the waves of a source
    assert half_immersed_circle(1e-6, "sway").added_mass == pytest.approx(1.0, abs=3e-6)
    low, lower = half_immersed_circle(1e-5, "heave"), half_immersed_circle(1e-6, "heave")
    assert lower.radiation_damping == pytest.approx(8.0 / math.pi, rel=2e-5)
    # the logarithm of a source; the next term is of the order of K a times its logarithm squared, 1e-3 here
    assert (lower.added_mass - low.added_mass) / math.log(10.0) == pytest.approx(8.0 / math.pi**2, rel=1e-3)
    # fast motion: phi = 0 on the surface
    assert half_immersed_circle(math.inf, "sway").added_mass == pytest.approx(4.0 / math.pi**2, rel=1e-15)
    assert half_immersed_circle(20.0, "heave").added_mass == pytest.approx(1.0, abs=0.03)
    # a wall moving horizontally makes waves of twice its amplitude
    assert half_immersed_circle(20.0, "sway").wave_ratio == pytest.approx(2.0, abs=0.15)


def image_added_mass(submergence, sign):
    """Circle below a plane by the chain of image dipoles: sign +1 rigid, -1 phi = 0; per area of the circle."""
    position, strength, total = 0.0, 1.0, 1.0
    for _ in range(400):
        # mirrored in the plane, then taken into the circle by the circle theorem (vertical dipoles)
        distance = 2.0 * submergence - position
        position = 1.0 / distance
        strength *= sign / distance**2
        total += 2.0 * strength
    return total


@pytest.mark.parametrize("seed", range(4))
def test_submerged_circle_passes_all_waves_and_keeps_energy(seed):
    rng = np.random.default_rng(seed)
    for _ in range(6):
        answer = submerged_circle(10.0 ** rng.uniform(-2.0, 0.8), 1.02 + 10.0 ** rng.uniform(-1.0, 1.0))
        assert abs(answer.transmission_coefficient) == pytest.approx(1.0, abs=1e-11)
        assert answer.energy_defect < 1e-9


@pytest.mark.parametrize("submergence", [1.5, 2.0, 3.0])
def test_submerged_circle_limits_are_those_of_image_dipoles(submergence):
    slow = submerged_circle(1e-5, submergence).added_mass
    assert slow == pytest.approx(image_added_mass(submergence, 1.0), abs=3e-4)
    fast = [submerged_circle(ka, submergence).added_mass for ka in (10.0, 20.0)]
    # the approach is like 1/K
    assert 2.0 * fast[1] - fast[0] == pytest.approx(image_added_mass(submergence, -1.0), abs=1e-3)


@pytest.mark.parametrize(
    "call",
    [
        lambda: half_immersed_circle(-1.0, "heave"),
        lambda: half_immersed_circle(1.0, "roll"),
        lambda: half_immersed_circle(1.0, "sway", multipoles=8),
        lambda: submerged_circle(0.0, 2.0),
        lambda: submerged_circle(1.0, 1.0),
    ],
)
def test_bad_input(call):
    with pytest.raises(InputError):
        call()
