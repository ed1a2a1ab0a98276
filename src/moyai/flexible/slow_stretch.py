"""Ropes that give way slowly: a fast spring in series with a slow one parallel to a dashpot [eq:flexible-slow-stretch].

The slow stretch is a change of the unstretched length that a bar has at the moment; it is brought up to date between
the calls of a run, exactly for a tension that stays. At rest the dashpot carries nothing and both springs act.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.flexible.arrays import BAR_ROWS, KernelArrays
from moyai.flexible.elements import BarType, RopeCurve, SlowStretch
from moyai.flexible.network import Network
from moyai.flexible.worn_law import WornRope

_LENGTH, _SPRING = BAR_ROWS.index("length"), BAR_ROWS.index("spring")
#: Updates over the shortest time in which the slow stretch fades
UPDATES = 100.0


def at_rest(network: Network) -> Network:
    """Return the network as it is under loads that stay: the stiffness of slow ropes is their static one."""
    if not any(kind.slow is not None for kind in network.bars.types):
        return network
    types = tuple(_at_rest(kind) for kind in network.bars.types)
    return replace(network, bars=replace(network.bars, types=types))


def _at_rest(kind: BarType) -> BarType:
    if isinstance(kind.slow, WornRope):
        return replace(kind, curve=RopeCurve(*kind.slow.curve_at_rest()), slow=None)
    return kind if kind.slow is None else replace(kind, axial_stiffness=kind.slow.static_stiffness, slow=None)


@dataclass(frozen=True, eq=False)
class SlowBars:
    """The slow stretch of some bars of a run."""

    #: Which bars.
    bars: IntArray
    #: Without slow stretch [m].
    length: Array
    #: Nodes of their ends.
    ends: tuple[IntArray, IntArray]
    #: Of the quick spring [N] and its dashpot [N s].
    fast: Array
    fast_viscosity: Array
    #: Of the slow spring [N] and its dashpot [N s].
    stiffness: Array
    viscosity: Array
    #: Slow strain [-].
    strain: Array

    @classmethod
    def of(cls, network: Network, position: Array, arrays: KernelArrays) -> SlowBars | None:
        """Return the slow bars of a network that starts at rest (n, 3), and put stiffness and lengths into ``arrays``.

        A stiffness that grows with the load is taken at the tension of the start.
        """
        slow = [kind.slow if isinstance(kind.slow, SlowStretch) else None for kind in network.bars.types]
        bars = np.flatnonzero([slow[kind] is not None for kind in network.bars.kind])
        if not bars.size:
            return None
        own = network.bars
        laws = [law for kind in own.kind[bars] if (law := slow[kind]) is not None]
        static = np.array([law.static_stiffness for law in laws])
        reach = np.linalg.norm(position[own.end[bars]] - position[own.start[bars]], axis=1)
        tension = static * np.maximum(reach / own.length[bars] - 1.0, 0.0)
        growth = np.array([law.growth for law in laws])
        fast = own.of_type("axial_stiffness")[bars] + growth * tension
        stiffness = 1.0 / (1.0 / static - 1.0 / fast)
        made = cls(
            bars, own.length[bars].copy(), (own.start[bars], own.end[bars]), fast, own.of_type("viscosity")[bars],
            stiffness, np.array([law.viscosity for law in laws]), tension / stiffness,
        )  # fmt: skip
        arrays.bars[_SPRING, bars] = fast / made.length
        arrays.bars[_LENGTH, bars] = made.present
        return made

    @property
    def spring(self) -> Array:
        """Stiffness of quick changes [N/m]."""
        return self.fast / self.length

    @property
    def present(self) -> Array:
        """Unstretched lengths of the moment [m]."""
        return np.asarray(self.length * (1.0 + self.strain))

    @property
    def interval(self) -> float:
        """Longest time between two updates [s]."""
        return float(np.min(self.viscosity / self.stiffness)) / UPDATES

    @property
    def energy(self) -> float:
        """Energy in the slow springs [J]."""
        return 0.5 * float(np.sum(self.length * self.stiffness * self.strain**2))

    def advance(self, place: Array, speed: Array, time: float) -> Array:
        """Let the slow stretch follow the tensions at places and speeds (3, n) for a time [s]; return the lengths."""
        first, last = self.ends
        reach = place[:, last] - place[:, first]
        size = np.linalg.norm(reach, axis=0)
        rate = np.sum(reach * (speed[:, last] - speed[:, first]), axis=0) / np.maximum(size, 1e-300)
        pull = (self.fast * (size - self.present) + self.fast_viscosity * rate) / self.length
        tension = np.where(size > self.present, np.maximum(pull, 0.0), 0.0)
        goal = tension / self.stiffness
        self.strain[:] = goal + (self.strain - goal) * np.exp(-time * self.stiffness / self.viscosity)
        return self.present
