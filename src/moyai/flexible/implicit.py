"""The implicit schemes: error-controlled Runge-Kutta methods with the true tangent and a sparse solver."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.flexible import implicit_kernel as kernel
from moyai.flexible.arrays import kernel_arrays, kernel_bed
from moyai.flexible.explicit import driving_tables
from moyai.flexible.failures import Failing
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.parts import kernel_parts, network_parts
from moyai.flexible.relaxation import kernel_plan, kernel_system, mean_size, plan_of
from moyai.flexible.result import State
from moyai.flexible.tableaus import TABLEAUS
from moyai.flexible.watch import watch_of
from moyai.flexible.worn_rope import slow_parts

#: Error of one step that is accepted: of tensions over the largest tension, of places over the length of a bar.
TOLERANCE = 1e-3


class ImplicitRun:
    """The state of one run; :func:`moyai.flexible.simulation.simulate` makes it and asks it to advance."""

    def __init__(
        self,
        network: Network,
        motions: Mapping[str, Motion],
        flow: Flow,
        start: State,
        *,
        method: str,
        tolerance: float,
    ) -> None:
        self.network, self.flow, self.name = network, flow, method
        if network.blocks is not None:
            raise InputError(
                f"{method!r} does not march sections of added mass",
                parameter="method",
                allowed="'explicit' for this network",
            )
        self.arrays = kernel_arrays(network)
        self.slow = slow_parts(network, start.position, self.arrays)
        #: Lines that part in the course of the run.
        self.failing: Failing | None = None
        self.system = kernel_system(self.arrays)
        plan = plan_of(network, self.arrays, network_parts(network))
        self.plan, self.parts = kernel_plan(plan), kernel_parts(network, plan.pairs[2:])
        count = len(network.nodes)
        self.driving = driving_tables(network, motions)
        self.fluid = np.array([network.water.density, network.water.gravity, 0.0])
        self.bed = kernel_bed(network)
        self.time = start.time
        self._place, self._speed = np.array(start.position), np.array(start.velocity)
        self._speed[network.nodes.kind != 0] = 0.0
        kernel.driven_place(self._place, self._speed, self.driving, self.time)
        self.acceleration, self.mass = np.zeros((count, 3)), np.zeros((count, 6))
        self.tension = np.zeros(len(network.bars))
        self.water = np.ascontiguousarray(flow.at(self.time, self._place.T))
        kernel.acceleration(
            self._place, self._speed, self.water, self.system, self.fluid, self.bed, self.parts, self.tension,
            self.mass, self.acceleration,
        )  # fmt: skip
        tableau = TABLEAUS[method]
        exponent = 1.0 / (min(tableau.order, tableau.embedded_order) + 1.0)
        self.method = (np.array(tableau.stages), np.array(tableau.embedded), exponent)
        weights = float(np.max(self.arrays.node("weight"), initial=0.0))
        mean = mean_size(network)
        self.control = np.array(
            [
                1e-3,
                1e-9,
                1e3,
                tolerance,
                mean,
                max(float(np.max(np.abs(self.tension), initial=0.0)), weights, 1e-300),
                0.0,
                0.0,
            ]
        )
        self.ledger, self.counts = np.zeros(3), np.zeros(4, dtype=np.int64)
        self.step, self.worst = math.inf, 0
        self.watch = watch_of(network, np.arange(len(network.bars)))
        self.watch.in_time()

    @property
    def place(self) -> Array:
        """Positions, a view of shape (3, n)."""
        return self._place.T

    @property
    def speed(self) -> Array:
        """Velocities, a view of shape (3, n)."""
        return self._speed.T

    def first_row(self, saved: Any) -> None:
        """Write the row of the start."""
        places, pulls, peaks, energy, nodes, bars = saved
        places[0] = self._place[nodes]
        pulls[0] = peaks[0] = self.tension[bars]
        energy[0, :2] = kernel.whole_energy(self._place, self._speed, self.mass, self.system, self.parts)
        energy[0, 2] = 0.0

    def limit(self) -> tuple[float, int]:
        """Return the largest step allowed and the node of the largest force at the last failure."""
        return float(self.control[2]), self.worst

    @property
    def force_left(self) -> float:
        """Largest force that Newton's method left at the last failure [N]."""
        return float(self.control[7])

    def advance(self, rows: int, first: int, row_interval: float, wanted: float | None, saved: Any) -> int:
        """March ``rows`` rows of the result; return how many were good."""
        if wanted is not None:
            self.control[0], self.control[6] = wanted, 1.0
        else:
            self.control[0] = min(self.control[0], row_interval)
        rate = np.zeros_like(self.water)
        end = self.time + rows * row_interval
        if not self.flow.steady:
            ahead = self.flow.at(end, (self._place + (end - self.time) * self._speed).T)
            rate = (ahead - self.water) / (end - self.time)
        before = self.counts[2]
        status, good, reached, self.worst = kernel.implicit_march(
            self._place, self._speed, self.acceleration, self.system, self.parts, self.plan, self.fluid, self.bed,
            (self.water.copy(), self.water, rate, not self.flow.steady), self.driving, self.method, self.control,
            (self.time, row_interval, rows, first), self.ledger, saved, self.counts, self.watch.system[:3],
        )  # fmt: skip
        taken = max(1, int(self.counts[2] - before))
        self.step = min(self.step, (reached - self.time) / taken) if status == kernel.GOOD else self.control[0]
        self.time = reached if status != kernel.GOOD else end
        if not self.flow.steady:
            self.water = np.ascontiguousarray(self.flow.at(end, self._place.T))
        for slow in self.slow:
            self.arrays.bar("length")[slow.bars] = slow.advance(self.place, self.speed, rows * row_interval)
            self.arrays.bar("spring")[slow.bars] = slow.spring
            saved[3][first : first + rows, 1] += slow.energy
        self.part()
        return int(good)

    def part(self) -> None:
        """Take the stiffness from the bars that part now."""
        if self.failing is not None:
            gone = self.failing.look(self.place, self.speed, self.time)
            for name in ("spring", "viscous"):
                self.arrays.bar(name)[gone] = 0.0

    def state(self) -> State:
        """Return the state at the present time."""
        return State(self.time, self._place.copy(), self._speed.copy())
