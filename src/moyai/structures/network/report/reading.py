"""What the report of a network asks of a result: water levels, runs, the governing line, texts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from moyai.core.results import Result
from moyai.report.reading import Group, root_of


@dataclass(frozen=True)
class NetworkLevel:
    """One water level of a result."""

    group: Group

    @property
    def name(self) -> str:
        """Name as in the case file."""
        return self.group.name

    def part(self, name: str) -> Group:
        """Return a group of the level."""
        return self.group.child(name)

    @property
    def network(self) -> Group:
        """The network itself."""
        return self.group.child("network")

    def runs(self) -> tuple[Group, ...]:
        """Return the runs through time."""
        return tuple(run for run in self.part("time").children() if run.exists)

    def governing_line(self, run: str) -> str:
        """Return the line or net with the highest tension of a run."""
        return str(self.part("dynamic").attributes.get(f"governing {run}", ""))


@dataclass(frozen=True)
class HighestTension:
    """The highest tension of a result: where, in which run, how much [N], when [s]."""

    level: NetworkLevel
    run: Group
    line: str
    peak: float
    time: float


def levels_of(result: Result) -> tuple[NetworkLevel, ...]:
    """Return the water levels of a result."""
    root = root_of(result)
    return tuple(NetworkLevel(child) for child in root.children() if "water_depth" in child.attributes)


def texts(group: Group, name: str) -> tuple[str, ...]:
    """Return a variable of words, empty where it is absent."""
    if group.node is None or name not in group.node.variables:
        return ()
    found: Any = group.node.variables[name]
    return tuple(str(value) for value in np.atleast_1d(found.values))


def peak_of_run(level: NetworkLevel, run: Group) -> HighestTension | None:
    """Return the highest tension of a run after the part that is left out, ``None`` where there is none."""
    best: HighestTension | None = None
    summary, time = level.part("dynamic"), run.real("time", "time")
    if time is None:
        return None
    for line in summary.labels("line"):
        peak, when = (summary.value(key, run=run.name, line=line) for key in ("line_tension_maximum", "peak_time"))
        if math.isfinite(peak) and (best is None or peak > best.peak):
            best = HighestTension(level, run, line, peak, when)
    skip = run.number("skip")
    counted = time >= time[0] + (skip if math.isfinite(skip) else 0.0)
    for net in run.labels("net"):
        record = run.real("net_tension", "time", net=net)
        if record is None or not counted.any() or not np.isfinite(record[counted]).any():
            continue
        at = int(np.flatnonzero(counted)[int(np.nanargmax(record[counted]))])
        if best is None or record[at] > best.peak:
            best = HighestTension(level, run, net, float(record[at]), float(time[at]))
    return best


def governing_of(levels: tuple[NetworkLevel, ...]) -> HighestTension | None:
    """Return the highest tension of all runs."""
    found = [peak_of_run(level, run) for level in levels for run in level.runs()]
    return max((item for item in found if item is not None), key=lambda item: item.peak, default=None)
