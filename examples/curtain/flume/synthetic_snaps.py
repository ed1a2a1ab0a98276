"""Made records of a curtain that is let go in a current and becomes taut, with known impact.

They serve examples and tests. The tension is that of model A with drag; its spike is multiplied by a given factor, so
that what the evaluation finds is known beforehand and differs from the models that are held against it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.structures.curtain.impact.cable import Impact, edge_impact
from moyai.structures.curtain.impact.cycles import rise_time
from moyai.structures.curtain.impact.release import snap_in_current

# Samples to a rise of the series that is computed, before it is sampled as a logger does
_FINE = 40.0


@dataclass(frozen=True)
class SnapLogger:
    """How a record is taken."""

    #: Samples a second [Hz].
    rate: float
    #: Standard deviation of each cable's noise [N].
    noise: float
    #: Of each cable's zero over the record [N].
    drift: float


@dataclass(frozen=True, eq=False)
class MadeRecord:
    """A made record and what was planted in it."""

    #: [s]; tension has the shape (2, n): upper, lower.
    time: Array
    #: [N]; tension has the shape (2, n): upper, lower.
    tension: Array
    #: Peak of the sum above the drag level [N].
    impact: float
    #: Intervals in which the cables have no tension [s].
    unloaded: tuple[tuple[float, float], ...]
    #: Interval that holds snap and plateau [s].
    window: tuple[float, float]


def made_record(
    impact: Impact, *, drag_coefficient: float, spike_factor: float, logger: SnapLogger, rng: np.random.Generator,
    release: float = 2.0, length: float = 20.0,
) -> MadeRecord:  # fmt: skip
    """Return the record of one release.

    Parameters
    ----------
    impact : Impact
        The span; its speed is that of the current.
    drag_coefficient : float
    spike_factor : float
        On what stands above the drag level.
    logger : Logger
    rng : Generator
        Of the noise.
    release : float
        When the curtain is let go [s].
    length : float
        From release until it is let loose [s].
    """
    snap = snap_in_current(
        impact, drag_coefficient=drag_coefficient, current=impact.speed, position=0.0, speed=0.0, duration=length,
        time_step=rise_time(impact) / _FINE,
    )  # fmt: skip
    edges = edge_impact(impact, finite_depth=True)
    share = edges.upper_peak / (edges.upper_peak + edges.lower_peak)
    end = release + length
    time = np.arange(0.0, end + 2.0, 1.0 / logger.rate)
    level = snap.plateau_tension
    own = snap.motion.tension
    raised = np.where(own > level, level + spike_factor * (own - level), own)
    tension = np.interp(time - release, snap.motion.time, raised, left=0.0, right=0.0)
    # a slack cable carries a little of the drag, the more the farther it has drifted
    slow = np.clip((time - release) / snap.taut_time, 0.0, 1.0) * 0.04 * snap.peak_tension
    slack = (tension == 0.0) & (time > release) & (time < release + snap.taut_time)
    tension = np.where(slack, slow, tension)
    tension[time > end] = 0.0
    both = np.stack([share * tension, (1.0 - share) * tension])
    both += logger.noise * rng.standard_normal(both.shape) + logger.drift * time / time[-1] + np.array([[0.7], [-0.3]])
    return MadeRecord(
        time, both, spike_factor * snap.impact_tension, ((0.0, release - 0.1), (end + 0.5, end + 2.0)),
        (0.5 * release, end - 0.5),
    )  # fmt: skip
