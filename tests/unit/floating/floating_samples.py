"""Random floating bodies whose radiation is exact: memory kernels that are sums of damped oscillations."""

from __future__ import annotations

import numpy as np

from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.memory import StateSpaceMemory


def positive_definite(rng: np.random.Generator, size: int, scale: float = 1.0) -> np.ndarray:
    root = rng.normal(size=(size, size))
    return scale * (root @ root.T / size + 0.3 * np.eye(size))


def random_memory(rng: np.random.Generator, size: int = 3, terms: int = 4) -> StateSpaceMemory:
    """Passive memory: every term g g^T exp(-a t) (cos b t + (a/b) sin b t) has a positive spectrum."""
    poles, inputs, outputs = [], [], []
    for _ in range(terms):
        a, b = rng.uniform(0.3, 2.0), rng.uniform(0.5, 3.0)
        g = rng.normal(size=size)
        poles.append(-a + 1j * b)
        inputs.append(g.astype(complex))
        # Re((1 - i a/b) exp((-a + i b) t)) = exp(-a t) (cos b t + (a/b) sin b t)
        outputs.append(rng.uniform(0.2, 1.0) * g * (1.0 - 1j * a / b))
    return StateSpaceMemory(np.array(poles), np.array(inputs), np.array(outputs).T.copy(), np.zeros((size, size)))


def hydrodynamics_of(
    memory: StateSpaceMemory, infinite: np.ndarray, omega: np.ndarray, rng: np.random.Generator, headings: int = 1
) -> Hydrodynamics:
    """Coefficients that belong to the memory exactly, and a random excitation that is smooth in frequency."""
    transfer = memory.transfer(omega)
    size = memory.size
    base = rng.normal(size=(headings, size)) + 1j * rng.normal(size=(headings, size))
    excitation = base[None] * np.exp(-0.05 * omega**2 + 0.2j * omega)[:, None, None]
    return Hydrodynamics(
        omega=omega,
        added_mass=infinite - transfer.imag / omega[:, None, None],
        radiation_damping=transfer.real,
        excitation_force=excitation,
        heading=np.linspace(0.0, 0.5, headings) if headings > 1 else np.zeros(1),
        modes=tuple(f"mode{index}" for index in range(size)),
        infinite_frequency_added_mass=infinite,
    )
