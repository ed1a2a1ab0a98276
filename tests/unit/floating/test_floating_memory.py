"""Memory models: modal form, truncation with what it owes to zero frequency."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.core.errors import ConvergenceError, InputError
from moyai.floating.memory import ConvolutionMemory, StateSpaceMemory


@pytest.mark.parametrize("seed", range(5))
def test_modal_form_of_a_random_real_model_has_its_kernel(seed: int) -> None:
    from scipy.linalg import expm

    rng = np.random.default_rng(seed)
    states, modes = 7, 3
    a = rng.normal(size=(states, states)) - 4.0 * np.eye(states)
    b, c = rng.normal(size=(states, modes)), rng.normal(size=(modes, states))
    memory = StateSpaceMemory.from_matrices(a, b, c, 0.3 * np.eye(modes))
    for time in (0.0, 0.3, 1.1):
        assert np.allclose(memory.kernel(time)[0], c @ expm(a * time) @ b, atol=1e-10)
    omega = 1.7
    exact = c @ np.linalg.solve(-1j * omega * np.eye(states) - a, b.astype(complex)) + 0.3 * np.eye(modes)
    assert np.allclose(memory.transfer(omega)[0], exact)
    assert len(memory.poles) <= states


def test_defective_and_growing_models_are_refused() -> None:
    jordan = np.array([[-1.0, 1.0], [0.0, -1.0]])
    with pytest.raises((ConvergenceError, np.linalg.LinAlgError)):
        StateSpaceMemory.from_matrices(jordan, np.array([[0.0], [1.0]]), np.array([[1.0, 0.0]]))
    with pytest.raises(InputError, match="grows"):
        StateSpaceMemory.from_matrices([[0.1]], [[1.0]], [[1.0]])


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
