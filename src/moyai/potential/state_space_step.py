"""Exact time steps of a state-space memory for velocities that vary linearly or quadratically within a step."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from moyai.core.arrays import ComplexArray
from moyai.core.compiled import njit
from moyai.core.errors import InputError
from moyai.potential.state_space import StateSpace


@dataclass(frozen=True)
class DiscreteMemory:
    """Arrays for a kernel: ``z_new = decay z + old v_0 + middle v_(1/2) + new v_1``; force ``-Re(outputs z)``."""

    #: [s].
    time_step: float
    #: exp(pole time_step); shape (n,).
    decay: ComplexArray
    #: ``old``, ``middle``, ``new``: Weights of the velocities at start, middle and end of the step; ``middle`` is zero
    #: for linear variation; shape (n, m).
    old: ComplexArray
    #: See ``old``.
    middle: ComplexArray
    #: See ``old``.
    new: ComplexArray
    #: Of the state space; shape (m, n).
    outputs: ComplexArray


def discretise(state_space: StateSpace, time_step: float, *, quadratic: bool = False) -> DiscreteMemory:
    """Return the exact update of the states over one step, [eq:memory-step].

    Parameters
    ----------
    state_space : StateSpace
    time_step : float
        [s].
    quadratic : bool
        The velocity within the step is a parabola through start, middle and end (for methods with a middle stage)
        instead of a straight line.

    Raises
    ------
    InputError
        When the step is not positive.
    """
    if not (math.isfinite(time_step) and time_step > 0.0):
        raise InputError(f"time step is {time_step:g} s", parameter="time_step", allowed="greater than 0")
    q = state_space.poles * time_step
    one, two, three = (_phi(q, order) for order in (1, 2, 3))
    if quadratic:
        weights = (one - 3.0 * two + 4.0 * three, 4.0 * two - 8.0 * three, 4.0 * three - two)
    else:
        weights = (one - two, np.zeros_like(one), two)
    old, middle, new = (time_step * weight[:, None] * state_space.inputs for weight in weights)
    return DiscreteMemory(
        time_step=float(time_step),
        decay=np.exp(q),
        old=np.ascontiguousarray(old),
        middle=np.ascontiguousarray(middle),
        new=np.ascontiguousarray(new),
        outputs=np.ascontiguousarray(state_space.outputs),
    )


def _phi(q: ComplexArray, order: int) -> ComplexArray:
    """phi_k(q) = (phi_(k-1)(q) - 1/(k-1)!)/q with phi_0 = exp; a series where that would cancel."""
    small = np.abs(q) < 1.0
    safe = np.where(small, 1.0, q)
    closed = np.exp(safe)
    for k in range(1, order + 1):
        closed = (closed - 1.0 / math.factorial(k - 1)) / safe
    series = np.zeros_like(q)
    for j in range(20, -1, -1):
        series = series * q + 1.0 / math.factorial(j + order)
    return np.asarray(np.where(small, series, closed), dtype=complex)


@njit(cache=True, error_model="numpy")
def advance_states(
    states: Any, decay: Any, old: Any, middle: Any, new: Any, v_old: Any, v_middle: Any, v_new: Any
) -> None:
    """Advance the states (n,) in place over one step."""
    for i in range(states.size):
        z = decay[i] * states[i]
        for j in range(v_old.size):
            z += old[i, j] * v_old[j] + middle[i, j] * v_middle[j] + new[i, j] * v_new[j]
        states[i] = z


@njit(cache=True, error_model="numpy")
def memory_force(states: Any, outputs: Any, force: Any) -> None:
    """Write the memory force (m,) of the states (n,)."""
    for j in range(force.size):
        total = 0.0
        for i in range(states.size):
            total -= (outputs[j, i] * states[i]).real
        force[j] = total


@njit(cache=True, error_model="numpy")
def force_history(velocity: Any, decay: Any, old: Any, middle: Any, new: Any, outputs: Any) -> Any:
    """Return the memory force (t, m) for velocities (t, m) at every step; starts from water at rest."""
    count, m = velocity.shape
    force = np.zeros((count, m))
    states = np.zeros(decay.size, np.complex128)
    for row in range(1, count):
        # without values between the steps the middle is the straight line
        half = 0.5 * (velocity[row - 1] + velocity[row])
        advance_states(states, decay, old, middle, new, velocity[row - 1], half, velocity[row])
        memory_force(states, outputs, force[row])
    return force
