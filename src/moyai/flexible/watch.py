"""What the explicit scheme watches at every step beside its result: fronts at the ends of lines, falls on the bed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from moyai.flexible.fronts import WINDOW, Front, travel_time
from moyai.flexible.network import Network
from moyai.flexible.packing import Packed

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Watch:
    """Gauges on the first and last bar of every line, and the fall of nodes on the bed.

    Parameters
    ----------
    strands : ndarray of int, shape (g,)
        Line of each gauge.
    travel : ndarray, shape (g,)
        Time of an elastic wave along it [s].
    places : ndarray of int, shape (g,)
        Its bar in the array of the kernels.
    gauges : ndarray, shape (g, 6)
        See :func:`moyai.flexible.explicit_kernel.read_gauges`.
    falls : ndarray, shape (2, n)
        See :func:`moyai.flexible.explicit_kernel.note_landings`; of no nodes without a bed.
    quickest : ndarray, shape (1,)
        Highest rate of drag times the step.
    """

    strands: IntArray
    travel: Array
    places: IntArray
    gauges: Array
    falls: Array
    quickest: Array

    @property
    def system(self) -> Any:
        """What the kernels take."""
        return self.places, self.gauges, self.falls, self.quickest

    def at_step(self, step: float) -> None:
        """Fit the blocks of the gauges to the step of the run; a rise is seen over one block to two."""
        self.gauges[:, 3] = np.maximum(1.0, np.floor(0.5 * WINDOW * self.travel / step))

    def fronts(self, network: Network) -> list[Front]:
        """Return what the gauges have seen, and how fast nodes of the same line came down on the bed."""
        found = []
        for strand, travel, gauge in zip(self.strands, self.travel, self.gauges, strict=True):
            nodes = network.strands[strand].nodes
            fall = float(self.falls[1, nodes].max()) if self.falls.shape[1] else 0.0
            found.append(
                Front(
                    int(strand), float(gauge[5]), max(float(gauge[4]), 0.0), WINDOW * float(travel), float(travel), fall
                )
            )
        return found


def watch_of(network: Network, packed: Packed) -> Watch:
    """Return the watch of a network."""
    lines = [number for number, strand in enumerate(network.strands) if strand.bars.size > 1]
    ends = np.array([network.strands[number].bars[end] for number in lines for end in (0, -1)], dtype=np.int64)
    travel = np.array([travel_time(network, number) for number in lines]).repeat(2)
    gauges = np.zeros((ends.size, 6))
    gauges[:, :2], gauges[:, 3] = np.inf, 1.0
    count = 0 if network.bed is None else len(network.nodes)
    strands = np.array(lines, dtype=np.int64).repeat(2)
    return Watch(strands, travel, packed.place[ends], gauges, np.zeros((2, count)), np.zeros(1))
