"""Sine, cosine and falling exponential for whole vectors against NumPy's, and against their identities."""

import numpy as np
import pytest

from moyai.core.compiled import njit
from moyai.sea.vector_kernel import falling_exponential, sine_and_cosine


@njit(cache=True)
def _turns(angles, out):
    for i in range(angles.size):
        out[0, i], out[1, i] = sine_and_cosine(angles[i])


@njit(cache=True)
def _falls(exponents, out):
    for i in range(exponents.size):
        out[i] = falling_exponential(exponents[i])


@pytest.mark.parametrize("reach", [1.0, 100.0, 1e6])
def test_sine_and_cosine_to_their_rounding(reach):
    angles = np.concatenate([np.linspace(-reach, reach, 20001), np.arange(-20, 21) * 0.25 * np.pi])
    out = np.empty((2, angles.size))
    _turns(angles, out)
    np.testing.assert_allclose(out, [np.sin(angles), np.cos(angles)], rtol=0.0, atol=3e-16)


def test_falling_exponential_to_its_rounding():
    exponents = -np.concatenate([np.linspace(0.0, 700.0, 20001), np.arange(40) * 0.5 * np.log(2.0)])
    out = np.empty(exponents.size)
    _falls(exponents, out)
    np.testing.assert_allclose(out, np.exp(exponents), rtol=4e-16)


def test_what_is_no_exponent_reads_nothing_beyond_the_table():
    out = np.empty(4)
    _falls(np.array([-1e300, -np.inf, np.nan, 1e-3]), out)
    np.testing.assert_allclose(out, [np.exp(-700.0)] * 3 + [1.0], rtol=1e-15)


def test_an_angle_without_bound_is_no_number():
    out = np.empty((2, 2))
    _turns(np.array([np.inf, np.nan]), out)
    assert np.isnan(out).all()
