"""Model A with the memory of the waves that the impact itself makes: for a rise that is not short.

The added mass of infinite frequency holds while the tension rises much faster than sqrt(d/g). Otherwise the waves that
the slowing skirt sends out push back; their force follows from the damping of the plate at all frequencies.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import ConvergenceError, InputError
from moyai.potential.thin_plate_waves import plate_memory
from moyai.sea.water import Water
from moyai.structures.curtain.impact.cable import Impact, ImpactPeak, peak_by_energy
from moyai.structures.curtain.impact.kernels import memory_march, spring, taut_shape

# Steps to the peak of model A
_STEPS = 400
# Depth over draught from which on the water counts as this deep: K changes by less than 2e-4 of its start beyond
_DEEP = 12.0
# Lengths of the kernel in sqrt(d/g) that are tried one after the other, and points on each
_LENGTHS = (8.0, 32.0, 128.0)
_POINTS = 1601


@dataclass(frozen=True, eq=False)
class MemoryImpact:
    """Time series of model A with memory, to just beyond the peak."""

    #: [s].
    time: Array
    #: Mid-span from the just-taut shape [m].
    displacement: Array
    #: [m/s].
    speed: Array
    #: [N/m].
    load: Array
    #: Sum of both cables [N].
    tension: Array
    #: Force of the waves made since the cable became taut, in the direction of the current [N/m].
    memory_force: Array
    #: Extrapolated from this step and its double.
    peak: ImpactPeak
    #: Peak over that of model A with the same mass.
    ratio: float
    #: Time of the peak over sqrt(d/g).
    rise_ratio: float
    #: Relative change of the peak by the extrapolation: a bound of its error.
    step_error: float


def memory_impact(impact: Impact, kernel: ArrayLike, time_step: float, mass: float) -> MemoryImpact:
    """Solve model A with a given memory of the water [eq:impact-memory].

    Parameters
    ----------
    impact : Impact
        The span.
    kernel : array_like
        K at 0, dt, 2 dt, ... [N/m per m/s per s]: the force of the water is -integral of K(t - s) (v(s) - U0) ds.
    time_step : float
        dt of the kernel and of the march [s].
    mass : float
        Added mass at infinite frequency that belongs to the kernel [kg/m].

    Raises
    ------
    InputError
        When a number is not positive or the kernel not finite.
    ConvergenceError
        When the cable has not come to its largest displacement within the length of the kernel.
    """
    given = np.ascontiguousarray(kernel, dtype=float)
    if given.ndim != 1 or given.size < 5 or not np.isfinite(given).all():
        raise InputError(
            f"kernel has shape {given.shape} or is not finite", parameter="kernel", allowed="5 values or more"
        )
    for name, value in (("time_step", time_step), ("mass", mass)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
    fine, series = _march(impact, given, time_step, mass)
    coarse, _ = _march(impact, np.ascontiguousarray(given[::2]), 2.0 * time_step, mass)
    # second order: a third of the change is left in the finer one
    furthest, time = (f + (f - c) / 3.0 for f, c in zip(fine, coarse))
    taut = taut_shape(impact.span_ratio)
    _, tension = spring(furthest, impact.span, impact.span_ratio, taut, impact.stiffness)
    _, unrefined = spring(fine[0], impact.span, impact.span_ratio, taut, impact.stiffness)
    place, speed, load, pull, force = series.T.copy()
    return MemoryImpact(
        time=time_step * np.arange(len(series), dtype=np.float64),
        displacement=place,
        speed=speed,
        load=load,
        tension=pull,
        memory_force=force,
        peak=ImpactPeak(tension, furthest, time),
        ratio=tension / peak_by_energy(impact, mass).tension,
        rise_ratio=time / math.sqrt(impact.draught / impact.water.gravity),
        step_error=abs(tension / unrefined - 1.0),
    )


def impact_with_memory(impact: Impact) -> MemoryImpact:
    """Solve model A with the waves that the plate makes in this depth [eq:impact-memory].

    The kernel of a ratio of depth to draught is computed once (some seconds) and kept.

    Parameters
    ----------
    impact : Impact
        The span.

    Raises
    ------
    ConvergenceError
        When the tension still rises after 128 sqrt(d/g): cables softer than the model is meant for.
    """
    unit = math.sqrt(impact.draught / impact.water.gravity)
    ratio = min(impact.water.depth / impact.draught, _DEEP)
    # rho g d times the kernel, rho d^2 times the mass, of a plate of one metre with g = 1, rho = 1
    for length in _LENGTHS:
        grid, kernel, mass = _scaled_memory(ratio, length)
        moved = mass * impact.water.density * impact.draught**2
        step = peak_by_energy(impact, moved).time / _STEPS
        if step * _STEPS > 0.8 * length * unit:
            continue
        count = min(int(length * unit / step), 6 * _STEPS) + 1
        from scipy.interpolate import CubicSpline

        values = CubicSpline(grid, kernel)(np.arange(count) * (step / unit))
        force = impact.water.density * impact.water.gravity * impact.draught
        try:
            return memory_impact(impact, force * values, step, moved)
        except ConvergenceError:
            continue
    raise ConvergenceError(
        f"the tension still rises after {_LENGTHS[-1]:g} √(d/g)",
        parameter="stiffness",
        remedy="take stiffer cables; so slow a rise is a drift, not an impact",
    )


@lru_cache(maxsize=32)
def _scaled_memory(ratio: float, length: float) -> tuple[Array, Array, float]:
    """Return times, kernel and added mass of a plate of unit draught, unit density and gravity."""
    grid = np.linspace(0.0, length, _POINTS)
    kernel, mass = plate_memory(1.0, Water(ratio, 1.0, 1.0), grid)
    return grid, kernel, mass


def _march(impact: Impact, kernel: Array, step: float, mass: float) -> tuple[tuple[float, float], Array]:
    """Return furthest displacement and its time, and the series."""
    out = np.empty((len(kernel), 5))
    count = memory_march(impact.span, impact.length, impact.stiffness, impact.speed, mass, kernel, step, out)
    turned = np.flatnonzero(out[1:count, 1] <= 0.0)
    if not turned.size:
        raise ConvergenceError(
            f"no peak within the {step * (len(kernel) - 1):.3g} s of the kernel",
            parameter="kernel",
            remedy="give the kernel over a longer time",
        )
    n = int(turned[0])
    before, after = out[n, 1], out[n + 1, 1]
    share = before / (before - after)
    # Hermite's cubic of the displacement at the instant at which the speed vanishes
    far = 1.0 - share
    top = far * far * ((1.0 + 2.0 * share) * out[n, 0] + share * step * before) + share * share * (
        (3.0 - 2.0 * share) * out[n + 1, 0] - far * step * after
    )
    return (float(top), (n + share) * step), out[:count]
