"""The spectrum of slow drift force against its integral in closed form."""

import numpy as np
import pytest

from moyai.structures.breakwater.slow_drift import force_spectrum


@pytest.mark.parametrize("heading_shares", [(1.0,), (0.3, 0.7)])
def test_a_level_spectrum_and_a_drift_linear_in_frequency(heading_shares):
    """Newman by the arithmetic mean: S_F(mu) = 8 int S(w) S(w + mu) [(D(w) + D(w + mu)) / 2]^2 dw.

    With S = s on (a, b) and D = p + q w the integrand is 2 s^2 (2 p + q (2 w + mu))^2.
    """
    a, b, s, p, q = 0.5, 1.7, 2.3, 40.0, 90.0
    omega = np.linspace(a, b, 601)
    directional = s * np.ones((omega.size, 1)) * np.array(heading_shares)
    drift = np.repeat((p + q * omega)[:, None], len(heading_shares), axis=1)
    mu = np.array([0.01, 0.1, 0.35])

    def cube(w):
        return (2.0 * p + q * (2.0 * w + mu)) ** 3 / (6.0 * q)

    exact = 2.0 * s**2 * (cube(b - mu) - cube(a))
    assert force_spectrum(omega, directional, drift, mu) == pytest.approx(exact, rel=6e-3)
