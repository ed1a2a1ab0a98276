"""Screening formula of Ruol et al. against its published form, evaluated by hand."""

import math

import numpy as np
import pytest

from moyai.structures.breakwater.screening import transmission_macagno, transmission_ruol


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
