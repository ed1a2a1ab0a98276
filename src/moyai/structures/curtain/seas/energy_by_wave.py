"""The energy model fitted wave by wave: each pull is laid against the wave that made it, blocks against each other.

The largest pull of a block need not come from its highest wave. Fitted to block maxima, the energy model therefore
takes the scatter of the pulls for energy; single waves have no such excess.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.series.intervals import student_quantile

# The pulls of a fit stand this many times above the noise of their block
_ABOVE_NOISE = 40.0


@dataclass(frozen=True, eq=False)
class WaveCalibration:
    """M m_B K from single waves."""

    #: M m_B K [kg N/m].
    product: float
    #: Bounds of 95 % [kg N/m]: Student's t over blocks, each left out in turn.
    interval: tuple[float, float]
    #: What noise and the steady level add to every maximum [N].
    floor: float
    #: Standard deviation of a pull over its expected value [-].
    scatter: float
    #: Waves whose expected pull stands clear of the noise.
    chosen: NDArray[np.bool_]
    #: Blocks that hold such waves.
    blocks: int

    def energy_factor(self, float_mass: float, rope_stiffness: float) -> tuple[float, float, float]:
        """Return M [-] and its bounds for a float mass [kg] and a rope stiffness [N/m]."""
        unit = float_mass * rope_stiffness
        return self.product / unit, self.interval[0] / unit, self.interval[1] / unit


def _line(sums: Array) -> tuple[float, float]:
    """Return root and floor of ``o = root c + floor`` from sums of 1, 1/c, 1/c^2, o/c and o/c^2."""
    count, first, second, ratio, over = sums
    spread = count * second - first**2
    return float((second * ratio - first * over) / spread), float((count * over - first * ratio) / spread)


def calibrate_by_wave(
    observed: ArrayLike, float_speed: ArrayLike, block: ArrayLike, noise: ArrayLike, *, line_factor: float
) -> WaveCalibration:
    """Find M m_B K from the largest fluctuating tension in the time of each wave [eq:curtain-calibration-waves].

    A line ``o = root c + floor`` with weights ``1/c^2`` (scatter in proportion to the pull). Waves are chosen by the
    pull that is expected of them, 40 times the noise of their block, never by the pull that was observed: that would
    keep the strong and drop the weak. Valid without pretension in the model (``T_e = c sqrt(M m_B K)``).

    Parameters
    ----------
    observed : array_like
        Fluctuating tension of the member [N]; NaN where a wave has none.
    float_speed : array_like
        U_max of each wave, of its own height and period [m/s].
    block : array_like of int
        Block of each wave: direction, current and gauge are one draw for all of its waves.
    noise : array_like
        Of each block [N].
    line_factor : float
        Tension of the member over that of the rope [-].

    Raises
    ------
    InputError
        When fewer than three blocks hold waves that stand clear of the noise.
    """
    rise, speed = np.asarray(observed, dtype=np.float64) / line_factor, np.asarray(float_speed, dtype=np.float64)
    of = np.asarray(block, dtype=np.int64)
    least = _ABOVE_NOISE * np.asarray(noise, dtype=np.float64)[of] / line_factor
    usable = np.isfinite(rise) & (speed > 0.0)
    if not np.any(usable):
        raise InputError("no wave has a tension and a speed", parameter="observed", allowed="waves with both")
    high = usable & (speed >= np.percentile(speed[usable], 67.0))
    root, floor, chosen = float(np.median(rise[high] / speed[high])), 0.0, high
    rows: Array = np.empty((0, 5))
    for _ in range(2):
        chosen = usable & (root * speed > least)
        c, o = speed[chosen], rise[chosen]
        # a block left out in turn needs two others for a line
        members, place = np.unique(of[chosen], return_inverse=True)
        if members.size < 3:
            raise InputError(
                f"{members.size} blocks have waves whose pull is {_ABOVE_NOISE:g} times above the noise",
                parameter="observed", allowed="at least 3 blocks",
                remedy="take higher seas, or a gauge with less noise",
            )  # fmt: skip
        terms = np.column_stack([np.ones(c.size), 1.0 / c, 1.0 / c**2, o / c, o / c**2])
        rows = np.array([np.bincount(place, weights=column) for column in terms.T]).T
        root, floor = _line(rows.sum(axis=0))
    count = len(rows)
    without = np.array([_line(rows.sum(axis=0) - row)[0] for row in rows])
    error = math.sqrt((count - 1) / count * float(np.sum((without - without.mean()) ** 2)))
    reach = student_quantile(0.95, count - 1) * error
    scatter = float(np.std((rise[chosen] - floor) / (root * speed[chosen]), ddof=2))
    return WaveCalibration(
        root**2, (max(root - reach, 0.0) ** 2, (root + reach) ** 2), floor * line_factor, scatter, chosen, count
    )
