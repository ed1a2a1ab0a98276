"""What the program chooses for the user: frequencies for the memory, length of the memory, time step."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.potential.damping_model import DampingModel, Start
from moyai.potential.memory import local_errors, pair_measure
from moyai.sea.water import Water, check_water

#: Measured on random rectangles (docs/validation/memory.md): spacing and end that leave 1e-3 of the largest K, and less
_STEP_AT_REFERENCE = 0.1
_END_AT_REFERENCE = 10.0
_REFERENCE = 1e-3
_FIRST = 0.3


@dataclass(frozen=True)
class FrequencyPlan:
    """Frequencies at which radiation should be solved, and why these."""

    #: [rad/s]; shape (n,).
    omega: Array
    #: One or two sentences for the report.
    reason: str


def recommend_frequencies(
    water: Water, *, breadth: float, wall_height: float, accuracy: float = _REFERENCE
) -> FrequencyPlan:
    """Return the frequencies that a memory function of the given accuracy needs [eq:memory-tail].

    Parameters
    ----------
    water : Water
        Depth and gravity.
    breadth : float
        Breadth of the section over all [m].
    wall_height : float
        Height of the steep wetted side below the waterline: the draught of a box; for a body under water the depth of
        its top [m]. The damping leaves the exact tail once waves are short against it.
    accuracy : float
        Error of K over its largest value, from 1e-6 to 1e-2.

    Returns
    -------
    FrequencyPlan
        Frequencies ``omega`` [rad/s], shape (n,), and the ``reason`` for them.

    Raises
    ------
    InputError
        When an argument is out of range.

    Notes
    -----
    Evenly spaced near zero, then evenly in the logarithm: omega = c sinh(j step). Sharp resonances (the water between
    twin hulls) need more: solve, then ask :func:`refine_frequencies`.

    Examples
    --------
    >>> from moyai.potential import recommend_frequencies
    >>> from moyai.sea import Water
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> plan = recommend_frequencies(water, breadth=4.0, wall_height=1.0, accuracy=1e-3)
    >>> len(plan.omega), round(float(plan.omega[0]), 3), round(float(plan.omega[-1]), 1)   # [rad/s]
    (42, 0.03, 9.9)
    """
    check_water(water)
    for name, value in (("breadth", breadth), ("wall_height", wall_height)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
    if not 1e-6 <= accuracy <= 1e-2:
        raise InputError(f"accuracy is {accuracy:g}", parameter="accuracy", allowed="1e-6 to 1e-2")
    g = water.gravity
    # Longest waves that feel the body: kh of order 1 or, where that is longer, k breadth of order 1
    if math.isinf(water.depth):
        slow = 0.1 * math.sqrt(g / (breadth + wall_height))
    else:
        slow = _FIRST * math.sqrt(g * water.depth) / max(water.depth, breadth)
    digits = math.log(_REFERENCE / accuracy)
    step = _STEP_AT_REFERENCE * math.exp(-digits / 5.0)
    end = math.sqrt(max(_END_AT_REFERENCE + 1.5 * digits, 7.0) * g / wall_height)
    last = math.asinh(end / slow)
    count = max(12, math.ceil(last / step))
    omega = slow * np.sinh(last / count * np.arange(1, count + 1))
    return FrequencyPlan(
        omega,
        f"{count} frequencies from {omega[0]:.3g} rad/s, below which the damping is an even function of frequency, to "
        f"{end:.3g} rad/s, where waves are short against the wall (K times its height is "
        f"{end**2 * wall_height / g:.0f}) and the exact tail takes over; steps of {100.0 * last / count:.0f} % for an "
        f"error of {accuracy:g}",
    )


@checks_words
def refine_frequencies(
    omega: ArrayLike, radiation_damping: ArrayLike, *, start: Start, tolerance: float = _REFERENCE
) -> Array:
    """Return frequencies that should be solved in addition, none when the damping is resolved.

    Parameters
    ----------
    omega, radiation_damping : array_like (n,), (n, m, m)
        What is there.
    start : {"even", "zero"}
        See :func:`moyai.potential.damping_model.fit_damping`.
    tolerance : float
        Interpolation error over the largest damping.
    """
    w = np.asarray(omega, dtype=float)
    errors = local_errors(w, np.asarray(radiation_damping, dtype=float), start=start)
    poor = errors > tolerance
    # Both gaps next to a poor frequency are halved
    gaps = poor[:-1] | poor[1:]
    values: Array = 0.5 * (w[:-1] + w[1:])[gaps]
    return values


@checks_words
@dataclass(frozen=True)
class MemoryPlan:
    """Length and step of a convolution, and why."""

    #: Length of the memory [s].
    length: float
    #: Step of the memory [s].
    time_step: float
    #: Whether the memory has decayed at ``length``; if not the state-space form should be used.
    reached: bool
    #: One or two sentences for the report.
    reason: str


def recommend_memory(model: DampingModel, *, tolerance: float = _REFERENCE) -> MemoryPlan:
    """Return how long K has to be kept and how finely it has to be sampled [eq:memory-velocity-kernel].

    Parameters
    ----------
    model : DampingModel
        Damping at every frequency.
    tolerance : float
        Share of the largest values that may be lost.

    Returns
    -------
    MemoryPlan
        ``length`` and ``time_step`` [s], whether the memory has decayed by then, and the reason.

    Notes
    -----
    Length: after it both K and what is left of its integral (lambda - D(0)) stay below ``tolerance``. Step: the
    trapezoidal rule for the convolution errs by dt^2 K''/12 at the start of the kernel.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.potential import memory_functions, recommend_memory
    >>> omega = np.linspace(0.05, 20.0, 60)
    >>> damping = (omega**2 * np.exp(-omega)).reshape(-1, 1, 1)
    >>> memory = memory_functions(omega, damping, [[1.0]], np.linspace(0.0, 10.0, 101), start="zero")
    >>> plan = recommend_memory(memory.model, tolerance=1e-2)
    >>> plan.reached, round(plan.length), round(plan.time_step, 1)       # [s]
    (True, 7, 0.1)
    """
    slowest = model.knots[1]
    horizon = 60.0 / slowest
    time = np.concatenate([[0.0], np.geomspace(0.05 / model.knots[-1], horizon, 900)])
    kernel, integral = model.velocity_kernel(time), model.acceleration_kernel(time)
    rest = (np.abs(integral - model.steady) / pair_measure(integral)).max(axis=(1, 2))
    share = (np.abs(kernel) / pair_measure(kernel)).max(axis=(1, 2))
    above = np.flatnonzero((rest > tolerance) | (share > tolerance))
    last = int(above[-1]) if above.size else 0
    reached = last + 1 < len(time)
    length = float(time[min(last + 1, len(time) - 1)])
    top, curvature = np.diag(kernel[0]), np.abs(np.diag(model.second_derivative()))
    # a mode without damping has no say
    steps = [math.sqrt(12.0 * tolerance * a / c) for a, c in zip(np.abs(top), curvature, strict=True) if c > 0.0]
    step = min([*steps, length / 20.0]) if length > 0.0 else horizon
    words = (
        f"after {length:.3g} s both K and lambda - D(0) stay below {tolerance:g} of their largest values"
        if reached
        else f"the memory has not decayed to {tolerance:g} after {length:.3g} s: use the state-space form"
    )
    return MemoryPlan(
        length, step, reached, f"{words}; steps of {step:.3g} s keep the trapezoidal rule to {tolerance:g}"
    )
