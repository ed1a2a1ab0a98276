"""Impact with memory: kernel and peaks against matched eigenfunctions, an independent solution of the hanging plate.

Antisymmetry cuts the water at the plate; below it phi = 0. Eigenfunctions of the depth, the velocity in the gap by
Chebyshev polynomials over the root at the edge (Galerkin). Numbers of the prototype: kernel at h/d = 8/3, Cummins form
over model A at five stiffnesses.
"""

import math

import numpy as np
import pytest
from scipy.special import ive, jv, sici

from moyai.potential.thin_plate_waves import plate_memory
from moyai.sea.dispersion import evanescent_wave_numbers, wave_number
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, check_impact, peak_by_energy
from moyai.structures.curtain.impact.compare import compare_models
from moyai.structures.curtain.impact.memory import impact_with_memory, memory_impact

DEPTH = 8.0 / 3.0
PRINTED = {150.0: 1.258, 600.0: 1.059, 1500.0: 1.023, 5000.0: 1.007, 39000.0: 1.001}
TIMES = np.array([0.0, 0.25, 0.5, 1.0, 1.5, 2.0, 3.0, 4.0])
KERNEL = np.array([1.275, 1.100, 0.793, 0.166, -0.272, -0.480, -0.426, -0.147])


def plate(omega, depth, count=1500, terms=10):
    """Added mass and damping of a plate of unit draught, g = rho = 1."""
    gap = depth - 1.0
    k0 = float(wave_number(omega, depth, 1.0))
    kn = evanescent_wave_numbers(omega, depth, 1.0, count)
    p = np.arange(terms)
    # the progressive mode is divided by cosh kh
    first = gap * math.pi / 2 * ive(2 * p, k0 * gap) * math.exp(k0 * (gap - depth))
    wet = (-math.expm1(-2 * k0 * depth) - math.exp(k0 * (gap - depth)) * -math.expm1(-2 * k0 * gap)) / (2 * k0)
    norm = 0.5 * depth * (math.exp(-2 * k0 * depth) + (1 - math.exp(-4 * k0 * depth)) / (4 * k0 * depth))
    others = gap * math.pi / 2 * ((-1.0) ** p)[:, None] * jv(2 * p[:, None], kn[None] * gap)
    wall = (np.sin(kn * depth) - np.sin(kn * gap)) / kn
    norms = 0.5 * depth * (1 + np.sin(2 * kn * depth) / (2 * kn * depth))
    shape, loads = np.hstack([first[:, None], others]), np.append(wet, wall)
    weight = np.append(1 / (1j * k0), -1 / kn) / np.append(norm, norms)
    gap_flow = np.linalg.solve((shape * weight) @ shape.T, -(shape * weight) @ loads)
    impedance = np.sum(weight * (gap_flow @ shape + loads) * loads)
    return -2 * impedance.real, -2 * impedance.imag * omega


@pytest.fixture(scope="module")
def kernel():
    """K(t) in rho g d over t in sqrt(d/g)."""
    end = 12.0
    nodes, weights = np.polynomial.legendre.leggauss(160)
    omega, weights = 0.5 * end * (nodes + 1), 0.5 * end * weights
    damping = np.array([plate(value, DEPTH)[1] for value in omega])
    assert damping[-1] * omega[-1] ** 3 == pytest.approx(4.0, rel=1e-6)

    def at(time):
        turn = end * np.maximum(time, 1e-12)
        # integral of cos(omega t)/omega^3 beyond the end
        tail = np.cos(turn) / (2 * end**2) - 0.5 * time * (np.sin(turn) / end - time * sici(turn)[1])
        return 2 / math.pi * (np.cos(np.outer(time, omega)) @ (weights * damping) + 4 * tail)

    return at


def flume(stiffness):
    return Impact(0.7, 0.8, 0.15, 0.5 * stiffness, 0.5 * stiffness, 0.3, Water(0.4, 1000.0, 9.81))


@pytest.mark.parametrize(
    ("relative", "mass", "damping"),
    [(0.3, 3.2294, 0.6342), (0.5, 3.4964, 1.6465), (0.7, 2.7460, 2.8391), (1.0, 1.0148, 2.7876)],
)
def test_independent_plate_against_its_table(relative, mass, damping):
    """h/d = 3, in units of M0; the prototype's table holds three to four digits."""
    omega = math.sqrt(relative)
    found = plate(omega, 3.0)
    assert found[0] * math.pi / 2 == pytest.approx(mass, rel=5e-4)
    assert found[1] / omega * math.pi / 2 == pytest.approx(damping, rel=5e-4)


@pytest.mark.slow
def test_kernel_of_the_plate(kernel):
    found, mass = plate_memory(1.0, Water(DEPTH, 1.0, 1.0), TIMES)
    assert kernel(TIMES) == pytest.approx(KERNEL, abs=1e-3)
    assert found == pytest.approx(kernel(TIMES), abs=4e-4)
    assert mass == pytest.approx(2.0 / math.pi * 1.00088, rel=1e-4)


@pytest.mark.slow
@pytest.mark.parametrize("stiffness", sorted(PRINTED))
def test_peak_over_model_a(kernel, stiffness):
    impact, unit = flume(stiffness), math.sqrt(0.15 / 9.81)
    step = peak_by_energy(impact).time / 200.0
    other = memory_impact(impact, 1000.0 * 9.81 * 0.15 * kernel(np.arange(800) * step / unit), step, impact.deep_mass)
    found = impact_with_memory(impact)
    assert other.ratio == pytest.approx(PRINTED[stiffness], abs=6e-4)
    assert found.ratio == pytest.approx(other.ratio, rel=3e-4)
    slow = peak_by_energy(impact).time / unit
    assert (slow > 0.6) == any(notice.code == "impact-slow" for notice in check_impact(impact))
    assert compare_models(impact).tension("A with memory") == pytest.approx(found.peak.tension, rel=1e-12)


def test_deep_water_counts_as_twelve_draughts():
    """The kernel of infinite depth differs from that of twelve draughts by 1.4e-4 of its start: not in the peak."""
    one, two = (
        impact_with_memory(Impact(0.7, 0.8, 0.15, 75.0, 75.0, 0.3, Water(h, 1000.0, 9.81))) for h in (3.0, math.inf)
    )
    assert one.ratio == pytest.approx(two.ratio, rel=1e-3)
