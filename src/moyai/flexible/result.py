"""What a run of a network hands back."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.validity import IdentityCheck, Notice
from moyai.flexible.network import Network

RunStatus = Literal["converged", "not_converged", "interrupted"]


@dataclass(frozen=True, eq=False)
class State:
    """Position and velocity of all nodes at one time.

    Parameters
    ----------
    time : float
        [s].
    position, velocity : ndarray, shape (n, 3)
        [m], [m/s].
    """

    time: float
    position: Array
    velocity: Array

    @classmethod
    def at_rest(cls, network: Network, time: float = 0.0) -> State:
        """Return the network as it was built, at rest."""
        return cls(time, np.array(network.nodes.position), np.zeros((len(network.nodes), 3)))


@dataclass(frozen=True, eq=False)
class History:
    """The run of a network through time.

    Parameters
    ----------
    network : Network
        What was run.
    time : ndarray, shape (k,)
        Times of the rows [s].
    nodes, bars : ndarray of int
        Which nodes and bars the arrays hold.
    position : ndarray, shape (k, nodes, 3)
        [m].
    tension : ndarray, shape (k, bars)
        At the times of the rows [N].
    tension_peak : ndarray, shape (k, bars)
        Highest since the row before, taken at every step [N].
    kinetic_energy, elastic_energy, work : ndarray, shape (k,)
        Energy of what is free, energy of bars, hinges and bed, and the work done on them since the start by weight,
        water and
        driven points [J].
    final : State
        State at the end, from which a run can go on.
    method : str
        Name of the scheme.
    step : float
        Time step (the smallest used) [s].
    steps : int
        Number of steps.
    status, message : str
        ``converged``, ``not_converged`` or ``interrupted``, and why.
    checks, notices : tuple
        Identities of the run; where it leaves its range.
    """

    network: Network
    time: Array
    nodes: IntArray
    bars: IntArray
    position: Array
    tension: Array
    tension_peak: Array
    kinetic_energy: Array
    elastic_energy: Array
    work: Array
    final: State
    method: str
    step: float
    steps: int
    status: RunStatus = "converged"
    message: str = ""
    checks: tuple[IdentityCheck, ...] = ()
    notices: tuple[Notice, ...] = field(default=())

    @property
    def energy_balance(self) -> Array:
        """Energy now minus energy at the first row minus work: minus what viscosity, bed and scheme have taken [J]."""
        energy = self.kinetic_energy + self.elastic_energy
        values: Array = energy - energy[0] - (self.work - self.work[0])
        return values

    def peak_at(self, bar: int) -> Array:
        """Return the highest tension of one bar in every row [N]."""
        return self.tension_peak[:, self._column(bar)]

    def _column(self, bar: int) -> int:
        place = np.flatnonzero(self.bars == bar)
        if place.size == 0:
            from moyai.core.errors import InputError

            raise InputError(f"bar {bar} was not kept", path="bar", allowed="one of the kept bars")
        return int(place[0])
