"""What the summaries of regular and irregular seas say of lines in motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.settings import LineDynamics

if TYPE_CHECKING:
    from moyai.structures.breakwater.time.model import TimeRun


#: Names of the variations of a peak, and of their variables.
SENSITIVITIES = {
    "twice the bars": "peak_change_twice_the_bars",
    "half the step": "peak_change_half_the_step",
    "twice the internal damping": "peak_change_twice_the_damping",
}
TWICE_THE_BARS = SENSITIVITIES["twice the bars"]
STATISTICS = ("slack_time", "longest_slack", "contact_count", "snap_count", "largest_snap", "shortest_rise_time")


def lines_at_rest(unit: FloatingUnit) -> NDArray[np.bool_]:
    """Return which lines are at rest at every instant in time."""
    return np.array(
        [not (isinstance(line, MooringLine) and line.dynamic) for line in unit.breakwater.lines], dtype=bool
    )


def motion_names(dynamics: LineDynamics) -> tuple[str, ...]:
    """Return the variables that lines in motion add to a summary."""
    own = (
        "line_tension_maximum_lines_at_rest",
        "anchor_vertical_tension_maximum_lines_in_motion",
        "anchor_tension_maximum",
        "least_grounded_length",
    )
    return (*own, *STATISTICS, *(SENSITIVITIES.values() if dynamics.sensitivity else ()))


def motion_summary(unit: FloatingUnit, run: TimeRun, window: NDArray[np.bool_], begin: float) -> dict[str, Array]:
    """Return uplift, grounded length, slack and snap of lines in motion, and the same peak with lines at rest.

    Parameters
    ----------
    unit : FloatingUnit
    run : TimeRun
        With lines in motion.
    window : ndarray of bool
        Rows that count.
    begin : float
        Time of the first of them [s].
    """
    lines, other = run.lines, run.at_rest
    assert lines is not None
    kinds = len(unit.lines)
    rest = np.full(kinds, np.nan)
    if other is not None:
        same = other.time >= begin
        rest = other.tension[same].max(axis=0) if same.any() else rest
    out = {
        "line_tension_maximum_lines_at_rest": rest,
        "anchor_vertical_tension_maximum_lines_in_motion": lines.uplift[window].max(axis=0),
        "anchor_tension_maximum": lines.anchor[window].max(axis=0),
        "least_grounded_length": lines.grounded[window].min(axis=0),
        **lines.statistics(unit, begin),
    }
    for name, variable in SENSITIVITIES.items():
        if name in lines.sensitivity:
            out[variable] = lines.sensitivity[name]
    return out
