"""Screening formula of Ruol et al. against its published form, evaluated by hand."""

import math

import numpy as np
import pytest

from moyai.structures.breakwater.screening import transmission_macagno, transmission_ruol, transmission_wiegel


@pytest.mark.parametrize(
    ("shift", "factor"),
    # 1 / (1 + s exp(-s^2)): the steepest place s = 1/sqrt 2, its mirror, the centre, far off
    [(0.0, 1.0), (1.0 / math.sqrt(2.0), 0.69985), (-1.0 / math.sqrt(2.0), 1.75095), (3.0, 0.99963)],
)
def test_correction_of_macagno(shift, factor):
    gravity, draught, beam, depth = 9.81, 1.2, 4.0, 8.0
    chi = 0.7919 + 0.1922 * shift  # chi = sqrt(g / (d + 0.35 B)) / omega
    omega = np.array([math.sqrt(gravity / (draught + 0.35 * beam)) / chi])
    wave_number = np.array([0.4])
    ratio = transmission_ruol(omega, wave_number, depth, beam, draught, gravity) / transmission_macagno(
        wave_number, depth, beam, draught
    )
    assert float(ratio[0]) == pytest.approx(factor, abs=2e-5)


def test_macagno_as_published():
    """K_T = [1 + (k B sinh kh / (2 cosh k(h - d)))^2]^(-1/2); in deep water the fraction is exp(kd)."""
    depth, beam, draught = 7.0, 5.0, 1.6
    k = np.array([0.02, 0.2, 0.7, 1.5])
    fraction = np.sinh(k * depth) / np.cosh(k * (depth - draught))
    exact = (1.0 + (0.5 * k * beam * fraction) ** 2) ** -0.5
    assert transmission_macagno(k, depth, beam, draught) == pytest.approx(exact, rel=1e-12)
    deep = (1.0 + (0.5 * k * beam * np.exp(k * draught)) ** 2) ** -0.5
    assert transmission_macagno(k, math.inf, beam, draught) == pytest.approx(deep, rel=1e-12)


def test_wiegel_is_the_share_of_the_energy_flux_below_the_plate():
    """K_T^2 = (2 k s + sinh 2 k s) / (2 k h + sinh 2 k h), s = h - d; long waves sqrt(s / h), deep water exp(-k d)."""
    depth, draught = 6.0, 1.7
    k = np.array([1e-5, 0.05, 0.3, 1.0, 3.0])
    gap = depth - draught
    exact = np.sqrt((2.0 * k * gap + np.sinh(2.0 * k * gap)) / (2.0 * k * depth + np.sinh(2.0 * k * depth)))
    assert transmission_wiegel(k, depth, draught) == pytest.approx(exact, rel=1e-12)
    assert exact[0] == pytest.approx(math.sqrt(gap / depth), rel=1e-8)
    assert transmission_wiegel(k, math.inf, draught) == pytest.approx(np.exp(-k * draught), rel=1e-12)
