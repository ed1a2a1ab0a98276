"""What a run of a network hands back."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from moyai.core.arrays import Array, IntArray
from moyai.core.options import checks_words
from moyai.core.validity import IdentityCheck, Notice
from moyai.flexible.network import Network

RunStatus = Literal["converged", "not_converged", "interrupted"]


@dataclass(frozen=True, eq=False)
class State:
    """Position and velocity of all nodes at one time.

    Examples
    --------
    >>> from moyai.flexible import BarType, NetworkBuilder, State
    >>> from moyai.sea import Water
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> builder.fixed("top", (0.0, 0.0, 0.0))
    >>> builder.fixed("low", (0.0, 0.0, -5.0))
    >>> rope = BarType("rope", mass_per_length=1.0, axial_stiffness=1e6, diameter=0.03)
    >>> builder.line("line", "top", "low", rope, length=5.0, segments=4)
    >>> State.at_rest(builder.build()).position.shape                    # nodes, axes
    (5, 3)
    """

    #: [s].
    time: float
    #: [m]; shape (n, 3).
    position: Array
    #: [m/s]; shape (n, 3).
    velocity: Array

    @classmethod
    def at_rest(cls, network: Network, time: float = 0.0) -> State:
        """Return the network as it was built, at rest.

        Parameters
        ----------
        network : Network
            Gives the places [m].
        time : float
            Of the state [s].
        """
        return cls(time, np.array(network.nodes.position), np.zeros((len(network.nodes), 3)))


@dataclass(frozen=True, eq=False)
class Equilibrium:
    """A network at rest under weight, buoyancy, bed and steady current."""

    #: Positions (velocities are zero); a run starts from it.
    state: State
    #: Tension of every bar [N]; shape (m,).
    tension: Array
    #: Largest force left on a free node over the largest force at work.
    residual: float
    #: Solves that it took.
    steps: int
    #: How: ``direct``, ``small steps``, ``rising current``, ``rising stiffness``, ``dynamic relaxation``, ``true
    #: motion``.
    found: str = "direct"


@checks_words
@dataclass(frozen=True, eq=False)
class History:
    """The run of a network through time."""

    #: What was run.
    network: Network
    #: Times of the rows [s]; shape (k,).
    time: Array
    #: Which nodes the arrays hold.
    nodes: IntArray
    #: Which bars the arrays hold.
    bars: IntArray
    #: [m]; shape (k, nodes, 3).
    position: Array
    #: At the times of the rows [N]; shape (k, bars).
    tension: Array
    #: Highest since the row before, taken at every step [N]; shape (k, bars).
    tension_peak: Array
    #: Energy of motion of what is free [J]; shape (k,).
    kinetic_energy: Array
    #: Energy of bars, hinges and bed [J]; shape (k,).
    elastic_energy: Array
    #: Work done on the network since the start by weight, water and driven points [J]; shape (k,).
    work: Array
    #: State at the end, from which a run can go on.
    final: State
    #: Name of the scheme.
    method: str
    #: Time step (the smallest used) [s].
    step: float
    #: Number of steps.
    steps: int
    #: How the run ended: ``converged``, ``not_converged`` or ``interrupted``.
    status: RunStatus = "converged"
    #: Why it ended so.
    message: str = ""
    #: Identities of the run.
    checks: tuple[IdentityCheck, ...] = ()
    #: Where the run leaves its range.
    notices: tuple[Notice, ...] = field(default=())
    #: Highest rate at which drag damped any part [1/s]; NaN where the method does not watch it.
    drag_rate: float = math.nan

    @property
    def energy_balance(self) -> Array:
        """Energy now minus energy at the first row minus work: minus what viscosity, bed and scheme have taken [J]."""
        energy = self.kinetic_energy + self.elastic_energy
        values: Array = energy - energy[0] - (self.work - self.work[0])
        return values

    def peak_at(self, bar: int) -> Array:
        """Return the highest tension of one bar in every row [N].

        Parameters
        ----------
        bar : int
            Number of the bar in the network.

        Raises
        ------
        InputError
            When the tensions of the bar were not kept.
        """
        return self.tension_peak[:, self._column(bar)]

    def _column(self, bar: int) -> int:
        place = np.flatnonzero(self.bars == bar)
        if place.size == 0:
            from moyai.core.errors import InputError

            raise InputError(f"bar {bar} was not kept", parameter="bar", allowed="one of the kept bars")
        return int(place[0])
