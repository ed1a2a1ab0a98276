"""Runs of a whole span through a snap, waves and current: tensions over time, snaps, and uncertainty of the peaks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.flexible.flow import Flow
from moyai.flexible.result import History
from moyai.flexible.sheets import sheet_stress
from moyai.flexible.simulation import simulate
from moyai.sea.water import Water
from moyai.series.snaps import SnapRecord, find_snaps
from moyai.structures.curtain.dynamic.assembly import build_span
from moyai.structures.curtain.dynamic.model import ANCHOR_LINE, CurtainNetwork, CurtainSpan, Mesh

#: Rows of a result, at most.
MOST_ROWS = 20000
#: Slack level and threshold of a snap where none is given, over the highest tension and the mean of what is taut.
_SLACK_SHARE, _SNAP_FACTOR = 0.01, 2.0


@checks_words
@dataclass(frozen=True)
class DynamicSettings:
    """How the dynamic analysis of a case is run."""

    mesh: Mesh
    #: Mass per area of the sheet [kg/m2]; None: as the case gives it elsewhere.
    sheet_mass: float | None = None
    #: Displaced volume per area [m]; NaN: from mass and weight in water.
    sheet_volume: float = math.nan
    #: Of the sheet along the span [N/m].
    span_stiffness: float = 0.0
    #: Of the sheet in shear [N/m].
    shear_stiffness: float = 0.0
    #: Of lower cable and ballast [kg/m3].
    ballast_density: float = 7850.0
    #: [m]; None: of a round float with the buoyancy given.
    float_height: float | None = None
    #: Of a buoy at a support with its added mass [kg]; needed with anchors.
    support_mass: float | None = None
    #: Speed of a drifting start over the span.
    profile: Literal["uniform", "sag"] = "uniform"
    #: Periods left out after the ramp of one period.
    settled_periods: int = 6
    #: Periods of regular waves that count.
    analysed_periods: int = 10
    #: Peak periods that count around the highest crest of an irregular sea.
    wave_count: int = 8
    #: Of the run in a current alone [s]; None: four rises of model A, longer while its highest tension stands in the
    #: later half.
    duration: float | None = None
    #: Curtain at rest in water that begins to move, drifting and just taut, or let go slack and at rest in the current;
    #: auto: at rest in waves, else drifting.
    start: Literal["auto", "at_rest", "drifting", "released"] = "auto"
    #: Whether runs with half the step, a mesh of half as many cells and twice the viscosity follow.
    sensitivity: bool = True
    #: Slack level of the snap statistics [N]; None: 1 % of the highest tension.
    slack_level: float | None = None
    #: Threshold of the snap statistics [N]; None: twice the mean of the taut times.
    threshold: float | None = None
    #: Whether peaks are taken from the span where it is not asked for and an upright plate only bounds them.
    by_default: bool = True


@dataclass(frozen=True, eq=False)
class DynamicRun:
    """One run of a span."""

    built: CurtainNetwork
    history: History
    flow: Flow
    #: Peaks before this are not counted [s].
    from_time: float = 0.0

    @property
    def counted(self) -> NDArray[np.bool_]:
        """Rows that count."""
        late = np.asarray(self.history.time >= self.from_time - 1e-12)
        # a run that stopped early counts whole, so that what it found can be seen
        return late if np.count_nonzero(late) > 2 else np.ones_like(late)

    def tension(self, name: str) -> Array:
        """Return the highest tension of a cable over the span, or of an anchor line, since the row before [N].

        Anchor lines carry two spans by halves: what is returned is that of the whole line. Of a line that is led to
        both edges it is that of one line of its slope with the same horizontal pull.
        """
        bars = self.built.bars(name)
        if bars.size == 0:
            return np.zeros(self.history.time.size)
        if name.startswith(ANCHOR_LINE):
            return np.asarray(2.0 * (self.history.tension_peak[:, bars] * self._of_line(bars)).sum(axis=1))
        return np.asarray(self.history.tension_peak[:, bars].max(axis=1))

    def _of_line(self, bars: NDArray[np.int64]) -> Array:
        """Return what a line of the slope of its anchor pulls over what its bars to both edges pull, at every row."""
        support = self.built.span.support
        if bars.size < 2 or support is None:
            return np.ones((1, bars.size))
        ends = self.built.network.bars
        way = self.history.position[:, ends.end[bars]] - self.history.position[:, ends.start[bars]]
        level = np.linalg.norm(way[..., :2], axis=-1) / np.linalg.norm(way, axis=-1)
        return np.asarray(level / math.cos(support.slope))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the cables and anchor lines."""
        return tuple(n for n in ("upper cable", "lower cable", *self.built.lines) if self.built.bars(n).size)

    @property
    def support_tension(self) -> Array:
        """Sum of the tensions of both cables at the first support [N]: what a gauge reads there."""
        bars = [self.built.bars(name)[0] for name in ("upper cable", "lower cable") if self.built.bars(name).size]
        return np.asarray(self.history.tension[:, bars].sum(axis=1))

    @property
    def both(self) -> Array:
        """Sum of the highest tensions of both cables [N]."""
        return self.tension("upper cable") + self.tension("lower cable")

    def peak(self, name: str) -> tuple[float, float]:
        """Return the highest governing tension [N] and when [s]; ``both`` for the sum of the cables."""
        values = np.where(self.counted, self.both if name == "both" else self.tension(name), -1.0)
        row = int(np.argmax(values))
        return float(values[row]), float(self.history.time[row])

    def skirt_tension(self, rows: NDArray[np.int64] | None = None) -> Array:
        """Return the highest principal tension of the skirt at rows [N/m]."""
        sheets = self.built.network.sheets
        assert sheets is not None
        chosen = np.arange(self.history.time.size) if rows is None else rows
        return np.array([float(sheet_stress(sheets, self.history.position[row]).first.max()) for row in chosen])

    def snaps(self, name: str, slack_level: float | None, threshold: float | None) -> SnapRecord:
        """Return slack times and snaps of a cable or line at its support."""
        bars = self.built.bars(name)
        # of a cable that at its support, of an anchor line both edges and both spans
        line = name.startswith(ANCHOR_LINE)
        factor, bars = (2.0 * self._of_line(bars), bars) if line else (np.ones((1, 1)), bars[:1])
        rows, history = self.counted, self.history
        pull, peaks = ((factor * one[:, bars]).sum(axis=1)[rows] for one in (history.tension, history.tension_peak))
        level = _SLACK_SHARE * float(peaks.max()) if slack_level is None else slack_level
        taut = pull[pull > level]
        limit = _SNAP_FACTOR * float(taut.mean()) if threshold is None and taut.size else threshold or level
        return find_snaps(history.time[rows], pull, slack_level=level, threshold=max(limit, level), peaks=peaks)


@checks_words
def run_span(
    span: CurtainSpan,
    mesh: Mesh,
    water: Water,
    *,
    flow: Flow | None = None,
    duration: float,
    output_step: float,
    speed: float = 0.0,
    profile: Literal["uniform", "sag"] = "uniform",
    weight: bool = True,
    deep: bool = False,
    release: float | None = None,
    from_time: float = 0.0,
    step: float | None = None,
    shorter: float = 1.0,
    progress: Progress = silent,
) -> DynamicRun:
    """Run a span through time.

    Parameters
    ----------
    span, mesh, water
        As :func:`moyai.structures.curtain.dynamic.model.build_span`, with ``speed``, ``profile``, ``weight``,
        ``deep`` and ``release``.
    flow : Flow, optional
        Motion of the water in the axes of the span; still water when left out.
    duration, output_step : float
        [s].
    from_time : float
        Peaks before this are not counted [s].
    step : float, optional
        Time step [s]; chosen by the program when left out.
    shorter : float
        Factor on every step, above 0, at most 1.

    Returns
    -------
    DynamicRun
        Its history has the status ``not_converged`` where the run had to stop.
    """
    built = build_span(span, mesh, water, speed=speed, profile=profile, weight=weight, deep=deep, release=release)
    chosen = flow or Flow()
    rows = min(MOST_ROWS, max(2, round(duration / output_step)))
    history = simulate(
        built.network, duration=duration, output_step=duration / rows, flow=chosen, start=built.state, step=step,
        shorter=shorter, counted_from=from_time, progress=progress,
    )  # fmt: skip
    return DynamicRun(built, history, chosen, from_time)


__all__ = ["DynamicRun", "DynamicSettings", "run_span"]
