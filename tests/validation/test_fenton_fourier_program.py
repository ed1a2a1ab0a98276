"""Stream-function waves against printed solutions of Fenton's own program FOURIER.

The program prints its inputs kd and kH with four or five digits, so a figure is known to the rounding of those inputs
times its order in the height; the tolerances below are that rounding, not an error of either program.
"""

import math
from pathlib import Path

import numpy as np
import pytest

from moyai.sea.breaking import highest_steady_wave
from moyai.sea.nonlinear import nonlinear_wave
from moyai.sea.water import Water

ROWS = np.loadtxt(Path(__file__).parent / "data" / "fenton_fourier_solutions.txt")


@pytest.fixture(params=range(len(ROWS)))
def pair(request):
    row = ROWS[request.param]
    water = Water(row[0], 1000.0, 1.0)
    wave = nonlinear_wave("stream_function", height=row[1], wavelength=2.0 * math.pi, water=water, order=8)
    return row, wave


def test_period_and_celerity(pair):
    row, wave = pair
    assert wave.period == pytest.approx(row[2], abs=4e-4)
    assert wave.celerity == pytest.approx(row[3], abs=1e-4)


def test_bernoulli_constant_and_mass_transport(pair):
    row, wave = pair
    # the program measures from the bed
    assert wave.bernoulli_constant + row[0] == pytest.approx(row[4], abs=2e-4)
    points, weights = np.polynomial.legendre.leggauss(60)
    x = (np.arange(128) + 0.5) * 2.0 * math.pi / 128.0
    flux = []
    for place, eta in zip(x, wave.elevation(0.0, x)):
        z = -row[0] + 0.5 * (eta + row[0]) * (points + 1.0)
        flux.append(0.5 * (eta + row[0]) * weights @ wave.velocity(0.0, place, 0.0, z)[:, 0])
    # Stokes' mean transport velocity: the flux of the wave over the depth
    assert np.mean(flux) / row[0] == pytest.approx(row[5], abs=1.2e-4)


@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_harmonics(pair, number):
    row, wave = pair
    rounding = number * 6e-5 / row[1]
    elevation = wave.elevation_harmonics[number - 1]
    assert elevation == pytest.approx(row[10 + number], rel=rounding + 1e-6)
    ratio = math.cosh(number * row[0]) / math.cosh(number * (row[0] + wave.crest))
    assert wave.crest_velocities[number - 1] / number * ratio == pytest.approx(row[6 + number], rel=4.0 * rounding)


def test_highest_wave_of_the_header(pair):
    row, _ = pair
    assert highest_steady_wave(2.0 * math.pi, row[0]) / row[0] == pytest.approx(row[6], abs=6e-4)
