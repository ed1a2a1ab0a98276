"""What slack and taut cycles of a sea come to: its number, its scatter and the end at which criteria are judged."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.series.intervals import reach_of_mean

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class SeaCycles:
    """Slack and taut cycles of a sea, sums of both cables [N]."""

    #: Lower end of its scatter.
    low: float
    #: The number of the sea, its lower waves counted.
    top: float
    #: Upper end of its scatter.
    high: float
    #: From the number to the end of its interval.
    reach: float
    words: str
    #: Realisations that the interval is of; none of regular waves.
    count: int = 0
    #: What the judged end is with the drag coefficient at the upper end of its range [N].
    strong_drag: float = 0.0

    @property
    def judged(self) -> float:
        """At which criteria are judged."""
        return max(self.top + self.reach, self.strong_drag)

    @property
    def of_strong_drag(self) -> float:
        """What the upper end of the drag coefficient makes of the judged end [-]."""
        return self.judged / (self.top + self.reach) if self.top + self.reach > 0.0 else 1.0

    @classmethod
    def of(cls, table: xr.Dataset) -> SeaCycles:
        """Take them from the group of a sea."""
        found = cls._at_value(table)
        # results of older versions do not have it
        strong = float(table["strong_drag_tension"]) if "strong_drag_tension" in table else 0.0
        return replace(found, strong_drag=strong)

    @classmethod
    def _at_value(cls, table: xr.Dataset) -> SeaCycles:
        tops, lows, highs = (
            np.atleast_1d(table[f"both_cables_tension_maximum{end}"].values) for end in ("", "_low", "_high")
        )
        row = int(np.argmax(tops))
        top, low, high = float(tops[row]), float(lows[row]), float(highs.max())
        # results of older versions do not have it
        lower = table["lower_wave_tension"].values if "lower_wave_tension" in table else np.zeros(1)
        if float(lower.max()) > top:
            top = float(lower.max())
            height = float(table["lower_wave_height"].values[int(np.argmax(lower))])
            words = f"a lower wave of the train, of {height:.3g} m, pulls hardest"
            return cls(low, top, max(top, high), float(table["judged_tension"].max()) - top, words)
        if "realisation_tension" not in table:
            reach = float(table["judged_tension"].max()) - top if "judged_tension" in table else 0.0
            return cls(low, top, high, reach, "largest of 100 periods")
        scatter = table["realisation_tension"].values
        return cls(low, top, high, reach_of_mean(scatter), f"{scatter.size} realisations", scatter.size)


__all__ = ["SeaCycles"]
