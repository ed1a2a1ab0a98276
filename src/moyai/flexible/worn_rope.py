"""Polyester ropes whose stretch depends on the highest mean tension that they have carried (Syrope) [eq:flexible-worn].

At rest a rope follows its working curve up to that tension, beyond it the curve of the new rope; quick changes have
the stiffness alpha + beta times the mean tension. A dashpot lies between: the mean tension, which is that of the slow
spring, follows the tension.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array, BoolArray, IntArray
from moyai.flexible.arrays import BAR_ROWS, KernelArrays
from moyai.flexible.network import Network
from moyai.flexible.slow_stretch import UPDATES, SlowBars
from moyai.flexible.worn_law import WornRope

_LENGTH, _SPRING = BAR_ROWS.index("length"), BAR_ROWS.index("spring")


@dataclass(frozen=True, eq=False)
class WornBars:
    """The bars of one kind of worn rope in a run; mean and highest tension of each are its state."""

    law: WornRope
    bars: IntArray
    #: Without any stretch [m].
    length: Array
    #: Nodes of their ends.
    ends: tuple[IntArray, IntArray]
    #: Of the quick dashpot [N s].
    fast_viscosity: float
    #: Mean tension, and the highest one so far [N].
    mean: Array
    highest: Array

    @classmethod
    def all_of(cls, network: Network, position: Array, arrays: KernelArrays) -> tuple[WornBars, ...]:
        """Return the worn bars of a network that starts at rest (n, 3); put stiffness and lengths into ``arrays``."""
        own, found = network.bars, []
        for number, kind in enumerate(own.types):
            bars = np.flatnonzero(own.kind == number)
            if not isinstance(kind.slow, WornRope) or not bars.size:
                continue
            rest = kind.slow.curve_at_rest()
            ends = own.start[bars], own.end[bars]
            strain = np.linalg.norm(position[ends[1]] - position[ends[0]], axis=1) / own.length[bars] - 1.0
            mean = np.maximum(np.interp(strain, *rest), kind.slow.least)
            made = cls(kind.slow, bars, own.length[bars].copy(), ends, kind.viscosity, mean,
                       np.maximum(mean, kind.slow.highest))  # fmt: skip
            arrays.bars[_SPRING, bars], arrays.bars[_LENGTH, bars] = made.spring, made.present
            found.append(made)
        return tuple(found)

    @property
    def spring(self) -> Array:
        """Stiffness of quick changes [N/m]."""
        return np.asarray(self.law.quick(self.mean) / self.length)

    @property
    def present(self) -> Array:
        """Unstretched lengths of the moment [m]."""
        quick = self.mean / self.law.quick(self.mean)
        return np.asarray(self.length * (1.0 + self.law.strain(self.mean, self.highest) - quick))

    @property
    def interval(self) -> float:
        """Longest time between two updates [s]."""
        sides = [self._give(np.full(self.mean.shape, rises)) for rises in (True, False)]
        return float(self.law.viscosity * np.min(sides)) / UPDATES

    @property
    def energy(self) -> float:
        """Energy that the ropes give back when they are let go slowly, less that of the quick springs [J]."""
        whole = self.law.energy(self.mean, self.highest) - 0.5 * self.mean**2 / self.law.quick(self.mean)
        return float(np.sum(self.length * whole))

    def _give(self, rises: BoolArray) -> Array:
        """Return the slow strain per mean tension on the side to which it goes: curves bend at the highest [1/N]."""
        law, step = self.law, 1e-4 * self.mean
        other = np.where(rises, self.mean + step, self.mean - step)
        highest = np.maximum(other, self.highest)
        change = np.abs(law.strain(other, highest) - law.strain(self.mean, self.highest)) / step
        quick = law.quick(self.mean)
        # a rope that is no stiffer to quick changes than at rest has no slow stretch
        return np.asarray(np.maximum(change - law.stiffness / quick**2, 0.05 / quick))

    def advance(self, place: Array, speed: Array, time: float) -> Array:
        """Let the mean tensions follow those at places and speeds (3, n) for a time [s]; return the lengths."""
        first, last = self.ends
        reach = place[:, last] - place[:, first]
        size = np.linalg.norm(reach, axis=0)
        rate = np.sum(reach * (speed[:, last] - speed[:, first]), axis=0) / np.maximum(size, 1e-300)
        pull = self.spring * (size - self.present) + self.fast_viscosity * rate / self.length
        tension = np.clip(np.where(size > self.present, pull, 0.0), self.law.least, self.law.new_tension[-1])
        kept = np.exp(-time / (self.law.viscosity * self._give(tension > self.mean)))
        self.mean[:] = tension + (self.mean - tension) * kept
        np.maximum(self.highest, self.mean, out=self.highest)
        return self.present


def slow_parts(network: Network, position: Array, arrays: KernelArrays) -> tuple[SlowBars | WornBars, ...]:
    """Return the bars of a run that give way slowly, by their law, and put stiffness and lengths into ``arrays``."""
    linear = SlowBars.of(network, position, arrays)
    return (*([] if linear is None else [linear]), *WornBars.all_of(network, position, arrays))
