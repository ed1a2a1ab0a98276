"""The current as strong as the drift of the waves, of cases without one: a slack skirt drifts until it is taut."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.sea import dispersion
from moyai.sea.states import RegularSea, SeaState
from moyai.sea.water import Water


def reflected_energy(wave_number: ArrayLike, depth: float, water_depth: float) -> Array:
    """Return the share of the energy of waves that a fixed barrier from the surface throws back [-].

    The larger of Ursell's in infinite depth and that of long waves by the inertia of the water in the gap; all of it
    without a gap [eq:curtain-wave-drift].

    Parameters
    ----------
    wave_number : array_like
        k [1/m].
    depth : float
        Of the barrier d [m].
    water_depth : float
        h [m], may be infinite.
    """
    from scipy.special import i1e, k1e

    draught = np.asarray(wave_number, dtype=np.float64) * depth
    ratio = k1e(draught) / (math.pi * i1e(draught)) * np.exp(-2.0 * draught)
    share = np.asarray(1.0 / (1.0 + ratio**2))
    if math.isinf(water_depth):
        return share
    gap = water_depth - depth
    if gap <= 0.0:
        return np.ones_like(share)
    added = 4.0 * water_depth / math.pi * -math.log(math.sin(0.5 * math.pi * gap / water_depth))
    half = 0.5 * added * np.asarray(wave_number, dtype=np.float64)
    return np.asarray(np.maximum(share, half**2 / (1.0 + half**2)))


def mean_drift_force(sea: SeaState, normal: float, depth: float, water: Water) -> float:
    """Return the mean drift force along the normal of an upright skirt that does not give way [N/m].

    Parameters
    ----------
    sea : SeaState
        Of regular waves the period with the largest force counts.
    normal : float
        Heading of the normal of the span [rad].
    depth : float
        Of the skirt [m].
    water : Water
    """
    omega = 2.0 * math.pi / np.array(sea.periods) if isinstance(sea, RegularSea) else sea.spectrum.omega
    omega = omega[omega > 0.0]
    k = np.asarray(dispersion.wave_number(omega, water.depth, water.gravity))
    share = reflected_energy(k, depth, water.depth)
    if math.isfinite(water.depth):
        twice = np.minimum(2.0 * k * water.depth, 100.0)
        share = share * (1.0 + twice / np.sinh(twice))
    if isinstance(sea, RegularSea):
        square = sea.height**2 / 8.0 * float(share.max())
    else:
        square = float(np.trapezoid(share * sea.spectrum.density_at(omega), omega))
    return water.density * water.gravity * square * abs(math.cos(sea.heading - normal))


def drift_speed(seas: Sequence[SeaState], normal: float, depth: float, drag_coefficient: float, water: Water) -> float:
    """Return the current whose drag on the upright skirt is the largest mean drift force of some seas [m/s].

    Less is needed: the skirt gives way and throws less back, and in moving water drag grows faster with the current.

    Parameters
    ----------
    seas : sequence of SeaState
    normal, depth, water
        As :func:`mean_drift_force`.
    drag_coefficient : float
        C_D [-].
    """
    force = max((mean_drift_force(sea, normal, depth, water) for sea in seas), default=0.0)
    return math.sqrt(force / (0.5 * water.density * drag_coefficient * depth))


__all__ = ["drift_speed", "mean_drift_force", "reflected_energy"]
