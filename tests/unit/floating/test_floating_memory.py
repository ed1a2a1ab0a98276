"""Memory models: modal form, truncation with what it owes to zero frequency."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.core.errors import InputError
from moyai.floating.memory import ConvolutionMemory, StateSpaceMemory


def test_truncation_keeps_the_damping_of_zero_frequency() -> None:
    time = np.linspace(0.0, 40.0, 4001)
    kernel = (2.0 * np.exp(-0.25 * time))[:, None, None]
    whole = ConvolutionMemory(time, kernel, np.zeros((1, 1)))
    cut = whole.truncated(6.0, [[8.0]])
    assert cut.time[-1] == pytest.approx(6.0)
    assert cut.dashpot[0, 0] == pytest.approx(8.0 * np.exp(-1.5), rel=1e-6)
    with pytest.raises(InputError, match="starts"):
        ConvolutionMemory(time + 1.0, kernel, np.zeros((1, 1)))


def test_states_after_a_known_motion_are_the_integral_of_their_own_equation():
    poles, inputs = np.array([-0.4 + 1.1j, -0.9 + 0.0j]), np.array([[1.0 + 2.0j], [0.5 + 0.0j]])
    memory = StateSpaceMemory(poles, inputs, np.ones((1, 2), np.complex128), np.zeros((1, 1)))
    time = np.linspace(0.0, 30.0, 6001)
    # z' = p z + b sin(w t) from rest, by hand
    w, end = 0.7, time[-1]
    exact = inputs[:, 0] * (w * np.exp(poles * end) - w * np.cos(w * end) - poles * np.sin(w * end)) / (w**2 + poles**2)
    assert memory.states_after(time, np.sin(w * time)[:, None]) == pytest.approx(exact, rel=1e-5)
