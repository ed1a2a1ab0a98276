"""What both kinds of schemes watch at every step: fronts at the ends of lines, falls on the bed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.flexible.fronts import WINDOW, Front, travel_time
from moyai.flexible.network import Network

#: Part of a rise that the stop of landing nodes could make at most, below which they are not held to have made it.
LEAST_SHARE = 0.05


@dataclass(frozen=True, eq=False)
class Watch:
    """Gauges on the first and last bar of every line, one on a line of one bar, and the fall of nodes on the bed."""

    #: Line of each gauge; shape (g,).
    strands: IntArray
    #: Time of an elastic wave along it [s]; shape (g,).
    travel: Array
    #: Its bar in the array of the kernels; shape (g,).
    places: IntArray
    #: See :func:`moyai.flexible.explicit_kernel.read_gauges`; in the implicit schemes its blocks are counted in
    #: seconds; shape (g, 6).
    gauges: Array
    #: Longest time within which a rise was seen [s]; shape (g,).
    within: Array
    #: See :func:`moyai.flexible.explicit_kernel.note_landings`; of no nodes without a bed; shape (2, n).
    falls: Array
    #: Steps done of a row that was broken off, -1 when none was; shape (1,).
    broken: IntArray

    @property
    def seen(self) -> tuple[Array, Array, Array]:
        """What a step that is tried again has to give back."""
        return self.gauges.copy(), self.within.copy(), self.falls.copy()

    def see_again(self, seen: tuple[Array, Array, Array]) -> None:
        """Return to what was seen before."""
        self.gauges[:], self.within[:], self.falls[:] = seen

    def forget(self) -> None:
        """Begin anew with rises, highest tensions and falls."""
        self.gauges[:, 4:] = 0.0
        self.falls[1:] = 0.0

    @property
    def system(self) -> Any:
        """What the kernels take."""
        return self.places, self.gauges, self.falls, self.broken

    def at_step(self, step: float) -> None:
        """Fit the blocks of the gauges to the step of the run; a rise is seen over one block to two."""
        self.gauges[:, 3] = np.maximum(1.0, np.floor(0.5 * WINDOW * self.travel / step))
        # lines of few bars cannot be watched as finely
        np.maximum(self.within, 2.0 * step * self.gauges[:, 3], out=self.within)

    def in_time(self) -> None:
        """Count the blocks of the gauges in seconds."""
        self.gauges[:, 3] = 0.5 * WINDOW * self.travel

    def fronts(self, network: Network) -> list[Front]:
        """Return what the gauges have seen, and how fast nodes of the same line came down on the bed."""
        found = []
        for strand, travel, within, gauge in zip(self.strands, self.travel, self.within, self.gauges, strict=True):
            nodes, bars = network.strands[strand].nodes, network.strands[strand].bars
            fall = float(self.falls[1, nodes].max()) if self.falls.shape[1] else 0.0
            rise = max(float(gauge[4]), 0.0)
            if fall * stiffest_impedance(network, bars) < LEAST_SHARE * rise:
                # nodes that lie on the bed and quiver there do not make it
                fall = 0.0
            found.append(Front(int(strand), float(gauge[5]), rise, float(within), float(travel), fall))
        return found


def stiffest_impedance(network: Network, bars: IntArray) -> float:
    """Return the highest sqrt(EA m) of some bars [N s/m]: what a stop of one metre per second can make at most."""
    kinds = [network.bars.types[slot] for slot in np.unique(network.bars.kind[bars])]
    return max(
        float(
            np.sqrt((kind.axial_stiffness if kind.curve is None else kind.curve.stiffness.max()) * kind.mass_per_length)
        )
        for kind in kinds
    )


def watch_of(network: Network, places: IntArray) -> Watch:
    """Return the watch of a network whose bars stand at these places in the array of the kernels."""
    counts = np.minimum([strand.bars.size for strand in network.strands], 2).astype(np.int64)
    strands = np.arange(len(network.strands)).repeat(counts)
    ends = np.array(
        [strand.bars[end] for strand, count in zip(network.strands, counts, strict=True) for end in (0, -1)[:count]],
        dtype=np.int64,
    )
    travel = np.array([travel_time(network, int(number)) for number in strands])
    gauges = np.zeros((ends.size, 6))
    gauges[:, :2], gauges[:, 3] = np.inf, 1.0
    count = 0 if network.bed is None else len(network.nodes)
    return Watch(
        strands, travel, np.asarray(places, dtype=np.int64)[ends], gauges, WINDOW * travel, np.zeros((2, count)),
        np.full(1, -1, dtype=np.int64),
    )  # fmt: skip
