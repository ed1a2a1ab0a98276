"""Where the memory of a row misses what stands between its frequencies, the middles of those gaps are solved."""

from __future__ import annotations

import numpy as np
import pytest

from moyai.structures.units.time.band import doubtful_gaps
from moyai.structures.units.time.memory import fit_row_memory


def test_the_worst_gaps_are_halved() -> None:
    solved, dense = np.array([1.0, 1.2, 1.4, 1.6]), np.linspace(1.0, 1.6, 13)
    error = np.where(np.abs(dense - 1.3) < 0.06, 0.2, 0.01)
    error[-1] = 0.05
    assert doubtful_gaps(solved, dense, error, 0.02, 8) == pytest.approx([1.3, 1.5])
    assert doubtful_gaps(solved, dense, error, 0.02, 1) == pytest.approx([1.3])
    assert doubtful_gaps(solved, dense, error, 0.3, 8).size == 0


def test_the_misfit_is_the_error_of_the_fit() -> None:
    """One resonance in one motion: the largest misfit over the band is the error that the fit reports."""
    omega = np.linspace(0.4, 3.0, 40)
    response = -1j * omega / (1.0 - omega**2 - 0.3j * omega) * -1j * omega * 2.0
    damping, excess = response.real[:, None, None], (-response.imag / omega)[:, None, None]
    memory = fit_row_memory(omega, 5.0 + excess, damping, goal=0.5, most=6)
    found = memory.misfit(omega, 5.0 + excess, damping)
    assert found.max() == pytest.approx(memory.error, rel=1e-6)
