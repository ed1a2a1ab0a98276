"""Tell when a load rises faster than an elastic wave runs through the line: then the wave makes the peak."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from moyai.core.validity import Notice
from moyai.flexible.network import Network

Array = NDArray[np.float64]


def travel_time(network: Network, strand: int) -> float:
    """Return the time of an elastic wave along a strand [s]."""
    bars = network.strands[strand].bars
    speed = np.array([network.bars.types[kind].wave_speed for kind in network.bars.kind[bars]])
    return float(np.sum(network.bars.length[bars] / speed))


def front_notices(
    network: Network, time: Array, bars: NDArray[np.int64], tension: Array, exact: bool
) -> tuple[Notice, ...]:
    """Return a notice for each strand whose tension jumps within a quarter of the travel time of the elastic wave.

    Parameters
    ----------
    network : Network
        The network.
    time, bars, tension : ndarray
        Rows, kept bars and their tensions as in :class:`moyai.flexible.result.History`.
    exact : bool
        Whether the run went at the pace of the wave (``safety=1`` and rows that whole steps fill).
    """
    if time.size < 3 or exact:
        return ()
    interval, found = float(time[1] - time[0]), []
    for number, strand in enumerate(network.strands):
        travel = travel_time(network, number)
        columns = np.flatnonzero(np.isin(bars, strand.bars))
        # rows further apart than the travel time cannot tell
        if columns.size == 0 or interval > 0.5 * travel or strand.bars.size < 2:
            continue
        column = columns[int(np.argmax(tension[:, columns].max(axis=0)))]
        record = tension[:, column]
        peak, rows = float(record.max()), max(1, round(0.25 * travel / interval))
        if record.size <= rows or peak <= 0.0:
            continue
        jump = float(np.max(record[rows:] - record[:-rows]))
        if jump > 0.4 * peak:
            found.append(
                Notice(
                    "wave-front",
                    f"the tension of {strand.name!r} (highest {peak:.4g} N) jumps by {jump:.4g} N "
                    f"within {rows * interval:.3g} s, a part of the {travel:.3g} s of an elastic wave along it",
                    rows * interval,
                    travel,
                    "information",
                    "equal bars and safety=1, with rows that whole steps of the wave along a bar fill, carry the front "
                    "without error; hold the peak against a finer mesh",
                    "one-dimensional wave equation, central differences at Courant number 1",
                )
            )
    return tuple(found)
