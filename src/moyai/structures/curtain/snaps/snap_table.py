"""Largest tension of slack and taut cycles in seas of any height and current: realisations, run where asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from moyai.core.arrays import Array
from moyai.series.intervals import reach_of_mean, scatter_of_end

_HEIGHTS, _HALVINGS = 10, 40


@dataclass(frozen=True, eq=False)
class SnapTable:
    """Tensions in irregular seas, by surface speed and significant height."""

    #: Largest sum of the cable tensions of each realisation [N], of a surface speed [m/s] and a significant height [m].
    realise: Callable[[float, float], Array]
    #: Whether the highest wave of a significant height [m] stands.
    stands: Callable[[float], bool]
    #: Significant height up to which tensions are wanted [m].
    highest: float
    _known: dict[tuple[float, int], tuple[float, float, float]] = field(default_factory=dict)

    def tension(
        self,
        speed: float,
        significant_height: float,
        *,
        judged: bool = False,
        known: bool = False,
        other_seeds: bool = False,
    ) -> float:
        """Return the mean of the realisations [N] in a surface speed [m/s], or the end of its interval.

        Between the heights that were run it is interpolated; where a higher sea gives less the larger tension of the
        lower one is kept.

        Parameters
        ----------
        speed, significant_height : float
            [m/s], [m].
        judged : bool
            At the upper end of the one-sided 95 % interval of the mean.
        known : bool
            Of the heights that were run already; above them the tension is at least what is returned.
        other_seeds : bool
            The judged end as other seeds may give it, one standard deviation higher.
        """
        wanted = min(int(np.searchsorted(self._heights, significant_height)), self._heights.size - 1)
        if known:
            wanted = min(wanted, max((number for ran, number in self._known if ran == speed), default=0))
        values = [self._at(speed, number)[2 if other_seeds else int(judged)] for number in range(wanted + 1)]
        return float(np.interp(significant_height, self._heights[: wanted + 1], np.maximum.accumulate(values)))

    @cached_property
    def _heights(self) -> Array:
        even = self._top * np.linspace(0.0, 1.0, _HEIGHTS + 1) ** 1.5
        return np.array([0.0, *(height for height in even[1:] if self.stands(float(height)))])

    @property
    def _top(self) -> float:
        """Return the highest of all heights [m]: that wanted, or the highest that stands, as in any other size."""
        stands, breaks = 0.0, self.highest
        if self.stands(breaks):
            return breaks
        for _ in range(_HALVINGS):
            middle = 0.5 * (stands + breaks)
            stands, breaks = (middle, breaks) if self.stands(middle) else (stands, middle)
        return stands

    def _at(self, speed: float, number: int) -> tuple[float, float, float]:
        """Return mean, judged end and the judged end of other seeds at a height of the table."""
        if number == 0:
            return 0.0, 0.0, 0.0
        if (speed, number) not in self._known:
            tops = self.realise(speed, float(self._heights[number]))
            mean = float(tops.mean())
            judged = mean + reach_of_mean(tops)
            self._known[speed, number] = mean, judged, judged + scatter_of_end(tops)
        return self._known[speed, number]
