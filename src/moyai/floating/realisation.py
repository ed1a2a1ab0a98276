"""States for a memory that is known as a kernel in time: Kung's realisation by singular values of the Hankel matrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.arrays import FloatArray, finite
from moyai.floating.memory import StateSpaceMemory


@dataclass(frozen=True)
class Realisation:
    """A memory of states and how well it gives back its kernel.

    Parameters
    ----------
    memory : StateSpaceMemory
    states : int
        Real states.
    error : float
        Largest difference of the kernel, modes scaled by their own K_jj(0), over 1.
    checks : tuple of IdentityCheck
        Fit of the kernel; passivity (the damping that the states give is nowhere negative).
    notices : tuple of Notice
    """

    memory: StateSpaceMemory
    states: int
    error: float
    checks: tuple[IdentityCheck, ...]
    notices: tuple[Notice, ...] = ()


def realise_memory(
    time: ArrayLike,
    velocity_kernel: ArrayLike,
    *,
    tolerance: float = 1e-4,
    largest: int = 60,
    dashpot: ArrayLike | None = None,
) -> Realisation:
    """Find the fewest states whose kernel is K(t) within a tolerance [eq:floating-realisation].

    Parameters
    ----------
    time : array_like (n,)
        Evenly spaced from 0 [s], fine enough for the fastest turn of K, up to where K has died away.
    velocity_kernel : array_like (n, m, m)
    tolerance : float
        Largest error of the kernel in parts of sqrt(K_ii(0) K_jj(0)).
    largest : int
        Most real states.
    dashpot : array_like (m, m) or None
        Instantaneous part, see :class:`StateSpaceMemory`.

    Returns
    -------
    Realisation
        With a notice when ``largest`` states do not reach the tolerance.

    Raises
    ------
    InputError
        When the time is not even or the kernel of a mode is zero at the start but not later.
    """
    instants, values = np.asarray(time, dtype=float), np.asarray(finite(np.asarray(velocity_kernel, float), "kernel"))
    step = (instants[-1] - instants[0]) / (len(instants) - 1)
    if instants[0] != 0.0 or np.max(np.abs(np.diff(instants) - step)) > 1e-6 * step:
        raise InputError("the kernel's time does not start at 0 or is not evenly spaced", path="time")
    size = values.shape[1]
    start = np.abs(np.diagonal(values[0]))
    peak = np.max(np.abs(values), axis=0)
    if np.any((start <= 0.0) & (np.diagonal(peak) > 0.0)):
        raise InputError("a mode's kernel is zero at the start and not later", path="velocity_kernel")
    scale = np.sqrt(np.where(start > 0.0, start, 1.0))
    scaled = values / np.outer(scale, scale)
    # Thin the samples to a Hankel matrix that is quick to decompose
    stride = max(1, len(instants) // 400)
    sampled, period = scaled[::stride], stride * step
    rows = len(sampled) // 2
    blocks = np.array([[sampled[i + j] for j in range(rows)] for i in range(rows)])
    hankel = blocks.transpose(0, 2, 1, 3).reshape(rows * size, rows * size)
    left, singular, right = np.linalg.svd(hankel)
    best: tuple[float, int, StateSpaceMemory] | None = None
    for order in range(2, min(largest, rows * size) + 1, 2):
        if singular[order - 1] <= 1e-14 * singular[0]:
            break
        root = np.sqrt(singular[:order])
        observability, controllability = left[:, :order] * root, root[:, None] * right[:order]
        advance = np.linalg.lstsq(observability[:-size], observability[size:], rcond=None)[0]
        memory = _modal(advance, controllability[:, :size], observability[:size], period, scale, dashpot)
        error = float(np.max(np.abs(memory.kernel(instants) / np.outer(scale, scale) - scaled)))
        if best is None or error < best[0]:
            best = (error, order, memory)
        if error <= tolerance:
            break
    assert best is not None
    error, order, memory = best
    notices: tuple[Notice, ...] = ()
    if error > tolerance:
        notices = (
            Notice(
                code="memory-realisation",
                message=f"{order} states give the memory to {error:.2g} of its start, not to {tolerance:.2g}",
                value=error,
                limit=tolerance,
                remedy="use a longer or finer kernel, more states, or the convolution",
            ),
        )
    checks = (
        IdentityCheck("states give back the memory", error, tolerance, "kernel of the states against K(t)"),
        _passivity(memory, scale, period),
    )
    return Realisation(memory, order, error, checks, notices)


def _modal(
    advance: FloatArray,
    inputs: FloatArray,
    outputs: FloatArray,
    period: float,
    scale: FloatArray,
    dashpot: ArrayLike | None,
) -> StateSpaceMemory:
    """Turn a discrete model into poles, inputs and outputs in continuous time; growing poles are turned to decay."""
    multipliers, vectors = np.linalg.eig(advance)
    modal_inputs = np.linalg.solve(vectors, inputs.astype(np.complex128)) * scale
    modal_outputs = (outputs @ vectors) * scale[:, None]
    size = np.abs(multipliers)
    multipliers = np.where(size >= 1.0, multipliers / size**2 * (1.0 - 1e-12), multipliers)
    # A negative real multiplier has no real root: give it the complex pole, whose real part of the sum is taken
    keep = (multipliers.imag >= 0.0) & (size > 1e-12)
    poles = np.log(multipliers[keep]) / period
    factor = np.where(multipliers[keep].imag > 0.0, 2.0, 1.0)
    zeros = np.zeros((len(scale), len(scale)))
    return StateSpaceMemory(
        np.ascontiguousarray(poles.astype(np.complex128)),
        np.ascontiguousarray(modal_inputs[keep].astype(np.complex128)),
        np.ascontiguousarray((modal_outputs[:, keep] * factor).astype(np.complex128)),
        zeros if dashpot is None else np.asarray(dashpot, dtype=float),
    )


def _passivity(memory: StateSpaceMemory, scale: FloatArray, period: float) -> IdentityCheck:
    """Return the most negative eigenvalue of the damping of the states over its largest, as a check."""
    omega = np.linspace(0.0, 0.5 * np.pi / period, 400)
    damping = memory.transfer(omega).real / np.outer(scale, scale)
    eigenvalues = np.linalg.eigvalsh(0.5 * (damping + damping.transpose(0, 2, 1)))
    return IdentityCheck(
        name="states take energy at every frequency",
        value=float(max(0.0, -eigenvalues.min()) / eigenvalues.max()),
        tolerance=1e-2,
        meaning="the real part of the memory's transfer function has no negative eigenvalue beyond the fit's error",
    )
