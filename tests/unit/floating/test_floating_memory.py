"""Memory models: modal form, realisation of a kernel, truncation with what it owes to zero frequency."""

from __future__ import annotations

import numpy as np
import pytest
from floating_samples import random_memory

from moyai.core.errors import ConvergenceError, InputError
from moyai.floating.memory import ConvolutionMemory, StateSpaceMemory
from moyai.floating.realisation import realise_memory


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


@pytest.mark.parametrize("seed", range(6))
def test_realisation_gives_back_a_random_kernel_and_its_transfer(seed: int) -> None:
    rng = np.random.default_rng(seed)
    memory = random_memory(rng, 3, 4)
    time = np.linspace(0.0, 25.0, 1201)
    found = realise_memory(time, memory.kernel(time), tolerance=1e-5)
    assert found.error < 1e-5 and found.notices == ()
    assert all(check.passed for check in found.checks)
    assert found.states <= 10
    omega = np.linspace(0.0, 5.0, 50)
    exact = memory.transfer(omega)
    assert np.max(np.abs(found.memory.transfer(omega) - exact)) < 1e-3 * np.abs(exact).max()


def test_realisation_says_when_it_does_not_reach_the_tolerance() -> None:
    time = np.linspace(0.0, 20.0, 801)
    kernel = (np.exp(-0.3 * time) * np.cos(time) + np.exp(-1.1 * time) * np.cos(3 * time))[:, None, None]
    found = realise_memory(time, kernel, tolerance=1e-6, largest=2)
    assert [notice.code for notice in found.notices] == ["memory-realisation"]
    assert not found.checks[0].passed
    with pytest.raises(InputError, match="evenly"):
        realise_memory([0.0, 1.0, 3.0], np.ones((3, 1, 1)))


def test_truncation_keeps_the_damping_of_zero_frequency() -> None:
    time = np.linspace(0.0, 40.0, 4001)
    kernel = (2.0 * np.exp(-0.25 * time))[:, None, None]
    whole = ConvolutionMemory(time, kernel, np.zeros((1, 1)))
    cut = whole.truncated(6.0, [[8.0]])
    assert cut.time[-1] == pytest.approx(6.0)
    assert cut.dashpot[0, 0] == pytest.approx(8.0 * np.exp(-1.5), rel=1e-6)
    assert whole.tail_length(1e-3) == pytest.approx(np.log(1e3) / 0.25, abs=0.02)
    with pytest.raises(InputError, match="starts"):
        ConvolutionMemory(time + 1.0, kernel, np.zeros((1, 1)))
