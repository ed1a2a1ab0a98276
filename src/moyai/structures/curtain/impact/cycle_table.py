"""Largest tension of slack and taut cycles for any current and wave height: the oscillator itself, where asked for."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from moyai.core.arrays import Array
from moyai.sea import dispersion
from moyai.sea.breaking import breaking_limit
from moyai.structures.curtain.impact.cable import Impact
from moyai.structures.curtain.impact.settling import settled_cycles
from moyai.structures.curtain.snaps.flow import depth_mean_factor

_HEIGHTS = 10
_SETTLED, _ANALYSED = 4, 10


@dataclass(frozen=True, eq=False)
class CycleTable:
    """Tensions in regular waves as high as the highest of a sea, at the period that goes with its height."""

    #: The span; its speed does not enter.
    impact: Impact
    #: C_D of the flat skirt [-].
    drag_coefficient: float
    #: Of the skirt, over which the water's speed is averaged [m].
    depth: float
    #: Mean speed of the current along the normal per surface speed [-].
    normal_ratio: float
    #: Height [m] that acts, of a significant height [m]: highest wave and direction rule.
    acting_height: Callable[[float], float]
    #: [s] of a significant height [m].
    period: Callable[[float], float]
    #: Significant height up to which tensions are wanted [m].
    highest: float
    _rows: dict[float, tuple[Array, Array]] = field(default_factory=dict)

    def tension(self, speed: float, significant_height: float) -> float:
        """Return the largest sum of the cable tensions [N] in a surface speed [m/s].

        Between the heights that were run it is interpolated; where a higher wave gives less (cycles may be out of
        step with the waves) the larger tension of the lower one is kept.
        """
        if speed not in self._rows:
            self._rows[speed] = self._row(speed)
        heights, tensions = self._rows[speed]
        return float(np.interp(significant_height, heights, tensions))

    def _row(self, speed: float) -> tuple[Array, Array]:
        heights = self.highest * np.linspace(0.0, 1.0, _HEIGHTS + 1)[1:] ** 1.5
        standing = [h for h in heights if self._breaking(float(h)) >= self.acting_height(float(h))]
        tensions = [self._run(speed, float(height)) for height in standing]
        if not standing:
            return np.array([0.0]), np.array([0.0])
        return np.array([0.0, *standing]), np.maximum.accumulate([0.0, *tensions])

    def _breaking(self, height: float) -> float:
        return breaking_limit(self.period(height), self.impact.water).height

    def _run(self, speed: float, height: float) -> float:
        water, period = self.impact.water, self.period(height)
        omega = 2.0 * math.pi / period
        number = float(dispersion.wave_number(omega, water.depth, water.gravity))
        amplitude = 0.5 * self.acting_height(height) * omega * float(depth_mean_factor(number, self.depth, water))
        return settled_cycles(
            self.impact,
            drag_coefficient=self.drag_coefficient,
            current=self.normal_ratio * speed,
            velocity_amplitude=amplitude,
            period=period,
            least_settled=_SETTLED,
            least_analysed=_ANALYSED,
        ).tension
