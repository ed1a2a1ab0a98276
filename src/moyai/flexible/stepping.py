"""A network that is stepped from outside: points go where a body takes them, and the network gives what they feel.

The explicit scheme does the small steps; a step that is tried again with a better path starts from the last accepted
state. See :mod:`moyai.core.attachment` for the two sides of the joint and docs/theory/coupled.md.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, IntArray
from moyai.core.errors import ConvergenceError, InputError
from moyai.core.validity import IdentityCheck, Notice
from moyai.flexible.elements import DRIVEN
from moyai.flexible.explicit import LOAD_STEPS, ExplicitRun
from moyai.flexible.explicit_rows import LEDGER, MXX, ROW, TOTAL_ROWS
from moyai.flexible.flow import Flow
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.peak_notices import peak_notices
from moyai.flexible.result import State

#: Accepted steps after which the step of the network is chosen again: within them a march ends where drag or a drying
#: part would make the step too long, so that the number is one of speed alone.
_CHOSEN_FOR = 64
#: Steps of the network within one step of a body, at least: mean and tilt of the reaction are sums over them.
LEAST_STEPS = 16


class _SteppedRun(ExplicitRun):
    """The explicit scheme with a choice of step that holds for some calls."""

    _choice: tuple[float, float, int, int] | None = None

    def choose(self, row_interval: float, wanted: float | None) -> tuple[float, int, int]:
        """Return the last choice for an interval of this length, a fresh one otherwise."""
        if self.parted:
            # what is left of a row that drag has broken off
            return super().choose(row_interval, wanted)
        if self._choice is None or abs(row_interval - self._choice[0]) > 1e-9 * row_interval:
            step, per_load, per_row = super().choose(row_interval, wanted)
            if per_load * per_row < LEAST_STEPS:
                # light lines would do with one step, but the reaction is a sum over steps
                step, per_load, per_row = super().choose(row_interval, row_interval / LEAST_STEPS)
            self._choice = (row_interval, step, per_load, per_row)
        _, _, per_load, per_row = self._choice
        return row_interval / (per_load * per_row), per_load, per_row

    def forget(self) -> None:
        """Choose again at the next call."""
        self._choice = None


@dataclass(frozen=True, eq=False)
class StepRecord:
    """What a network did in its accepted steps; rows are the ends of kept steps, the first is the start."""

    #: [s]; shape (k,).
    time: Array
    #: Which nodes the arrays hold.
    nodes: IntArray
    #: Which bars the arrays hold.
    bars: IntArray
    #: [m]; shape (k, nodes, 3).
    position: Array
    #: Tension at the row [N]; shape (k, bars).
    tension: Array
    #: Highest since the row before, over every small step [N]; shape (k, bars).
    tension_peak: Array
    #: Lowest since the row before, over the accepted steps [N]; shape (k, bars).
    tension_trough: Array
    #: Kinetic energy, as in :class:`moyai.flexible.result.History` [J]; shape (k,).
    kinetic_energy: Array
    #: Elastic energy [J]; shape (k,).
    elastic_energy: Array
    #: Work done on the network [J]; shape (k,).
    work: Array


class SteppedNetwork:
    """A network whose carried points are moved step by step.

    Parameters
    ----------
    network : Network
        Its carried points are of the kind ``DRIVEN``.
    carried : sequence of str
        Names of points that bodies carry; the other driven points follow ``motions``.
    motions : mapping of str to Motion
        Prescribed motions of the other driven points.
    flow : Flow
        Motion of the water.
    start : State
        Start.
    velocity : array_like, shape (points, 3), optional
        Velocities of the carried points at the start; 0 when left out.
    step : float, optional
        Time step [s]; the largest stable one when left out.
    safety : float, optional
        Part of the stable step, as in :func:`moyai.flexible.simulation.simulate`.
    keep_nodes, keep_bars : array_like of int, optional
        What the record holds; everything when left out.

    Raises
    ------
    InputError
        For a carried point that the network does not have or does not drive.
    """

    def __init__(
        self,
        network: Network,
        carried: Sequence[str],
        *,
        motions: Mapping[str, Motion] | None = None,
        flow: Flow | None = None,
        start: State | None = None,
        velocity: ArrayLike | None = None,
        step: float | None = None,
        safety: float | None = None,
        load_steps: int = LOAD_STEPS,
        keep_nodes: ArrayLike | None = None,
        keep_bars: ArrayLike | None = None,
    ) -> None:
        self.network, self.points, self.wanted = network, tuple(carried), step
        self._given = dict(motions or {})
        nodes = carried_nodes(network, self.points)
        start = start or State.at_rest(network)
        self.run = _SteppedRun(
            network,
            self._all_motions(nodes, start.time),
            flow or Flow(),
            start,
            safety=safety,
            load_steps=load_steps,
        )
        driven = np.flatnonzero(network.nodes.kind == DRIVEN)
        where = {int(node): row for row, node in enumerate(driven)}
        self._rows = np.array([where[int(node)] for node in nodes], dtype=np.int64)
        self._nodes = nodes
        self._others = [(row, network.motion_names[network.nodes.motion[node]]) for node, row in where.items()]
        self._others = [(row, name) for row, name in self._others if row not in set(self._rows.tolist())]
        self._rest = np.array(network.nodes.position[driven])
        pairs = np.stack([driven, np.arange(driven.size)], axis=1).astype(np.int64)
        self._tables = np.zeros((max(driven.size, 1), 2, 6))
        self.run.driving = (pairs, np.zeros((driven.size, 3)), self._tables, start.time, 1.0)
        self._now = np.zeros((2, driven.size, 3))
        self._now[0, self._rows] = start.position[nodes]
        if velocity is not None:
            self._now[1, self._rows] = velocity
        for row, name in self._others:
            moved, rate = self._given[name].at(start.time)
            self._now[:, row] = self._rest[row] + moved, rate
        self.run.place[:, driven], self.run.speed[:, driven] = self._now[0].T, self._now[1].T
        self._next = self._now.copy()
        self._impulse = np.zeros((2, driven.size, 3))
        count, bars = len(network.nodes), len(network.bars)
        self.keep_nodes = np.arange(count) if keep_nodes is None else np.atleast_1d(np.asarray(keep_nodes, np.int64))
        self.keep_bars = np.arange(bars) if keep_bars is None else np.atleast_1d(np.asarray(keep_bars, np.int64))
        shapes = ((1, self.keep_nodes.size, 3), (1, self.keep_bars.size), (1, self.keep_bars.size), (1, 3))
        self._row = (*(np.zeros(shape) for shape in shapes), self.keep_nodes, self.keep_bars)
        self.run.first_row(self._row)
        self._history: list[tuple[Array, ...]] = []
        self._accepted = 0
        self._peak, self._trough = self._row[2][0].copy(), self._row[1][0].copy()
        self.keep_row()
        self._kept, self._energy, self._fresh = self._snapshot(), self._row[3][0].copy(), True
        self.steps, self.smallest = 0, math.inf

    def _all_motions(self, nodes: IntArray, time: float) -> dict[str, Motion]:
        """Return the given motions and stillness for carried points, to start the scheme with."""
        network, motions = self.network, dict(self._given)
        for node in nodes:
            name = network.motion_names[network.nodes.motion[node]]
            if name in self._given:
                raise InputError(
                    f"the point {name!r} is carried by a body and driven by a motion",
                    parameter="motions",
                    allowed="one",
                )
            motions[name] = Motion(time, 1.0, np.zeros((2, 3)), np.zeros((2, 3)))
        for name in network.motion_names:
            if name not in motions:
                raise InputError(
                    f"the point {name!r} is driven, but belongs to no body, and no motion is given for it",
                    parameter="motions",
                    allowed=", ".join(network.motion_names),
                )
        return motions

    @property
    def time(self) -> float:
        """Time of the accepted state [s]."""
        return float(self._kept[1])

    @property
    def energy(self) -> tuple[float, float, float]:
        """Kinetic and elastic energy and the work done, at the accepted state [J]."""
        kinetic, elastic, work = self._energy
        return float(kinetic), float(elastic), float(work)

    def state(self) -> State:
        """Return the accepted state."""
        self._restore()
        return self.run.state()

    def _rows_of_memory(self) -> Array:
        """Return a view of what the kernels use of their array; the rest of each row is never touched."""
        packed = self.run.packed
        ribs = int(packed.runs[:, 3].sum()) if len(packed.runs) else 0
        width = max(int(packed.sizes.max()), ribs) + 8
        return packed.memory[: TOTAL_ROWS * ROW].reshape(TOTAL_ROWS, ROW)[:, :width]

    def _snapshot(self) -> tuple[Any, ...]:
        run = self.run
        return (
            self._rows_of_memory().copy(), run.time, run.step, run.water.copy(), run.ledger.copy(), run.watch.seen,
            run.sheets[3].copy(),
        )  # fmt: skip

    def _restore(self) -> None:
        rows, self.run.time, self.run.step, water, ledger, seen, gauge = self._kept
        self.run.watch.see_again(seen)
        self.run.sheets[3][:] = gauge
        self._rows_of_memory()[:] = rows
        self.run.water, self.run.ledger[:] = water.copy(), ledger
        self._fresh = True

    @property
    def follows_motions(self) -> bool:
        """Whether points that no body carries follow motions of their own."""
        return bool(self._others)

    @property
    def steps_to_choice(self) -> int:
        """Steps that may be accepted until the network chooses its own step again."""
        return _CHOSEN_FOR - self._accepted % _CHOSEN_FOR

    def begin_march(self, interval: float) -> tuple[tuple[float, int, int], tuple[Any, ...], tuple[Any, ...]]:
        """Hand the state over to a kernel that takes several steps of ``interval`` [s].

        Returns
        -------
        tuple
            Step of the network, steps per load interval and load intervals per step; the arguments of
            :func:`moyai.flexible.explicit_kernel.march` that do not change; the state that was accepted last, which the
            kernel changes as it goes and :meth:`end_march` takes back.
        """
        if not self._fresh:
            self._restore()
        run, packed, arrays = self.run, self.run.packed, self.run.arrays
        choice = run.prepare(interval, self.wanted)
        water = self.network.water
        system = (
            packed.memory, packed.sizes, packed.runs, arrays.curves, arrays.hinges, arrays.bending, arrays.attached,
            np.array([water.density, water.gravity]), run.driving[0],
            run.bed, run.parts,
            self.keep_nodes, packed.place[self.keep_bars], run.ledger, *run.watch.system,
        )  # fmt: skip
        rows, _, _, now, ledger, (gauges, _, falls), _ = self._snapshot()
        return choice, system, (rows, ledger, gauges, falls, now)

    @property
    def carried_system(self) -> tuple[IntArray, IntArray, Array, Array]:
        """Nodes of the carried points, their places among the driven ones, place and velocity now, driving tables."""
        return self._nodes, self._rows, np.ascontiguousarray(self._now[:, self._rows]), self._tables

    def end_march(
        self, count: int, interval: float, kept: tuple[Any, ...], now: Array, rows: tuple[Array, ...]
    ) -> None:
        """Take back a state after ``count`` accepted steps, and their rows: positions, tensions, peaks, energies."""
        run, begin = self.run, self._kept[1]
        memory, ledger, gauges, falls, water = kept
        run.time, run.water = begin + count * interval, water
        seen = (gauges, run.watch.within.copy(), falls)
        self._kept = (memory, run.time, run.step, water.copy(), ledger, seen, run.sheets[3].copy())
        self._fresh = True
        if count == 0:
            return
        places, pulls, peaks, energy = rows
        self._history.append((begin + interval * np.arange(1.0, count + 1.0), places, pulls, peaks, pulls, energy))
        self._peak, self._trough = np.full_like(self._peak, -np.inf), np.full_like(self._trough, np.inf)
        self._now[:, self._rows] = now
        self._next = self._now.copy()
        self._energy = np.array(rows[3][-1])
        self._accepted += count
        self.steps += count * round(interval / run.step)
        self.smallest = min(self.smallest, run.step)
        if self._accepted % _CHOSEN_FOR == 0:
            run.forget()

    def try_step(self, end: float, place: Array, velocity: Array) -> Array:
        """Move to ``end`` [s] while the carried points go to ``place`` [m] with ``velocity`` [m/s] there.

        Returns
        -------
        ndarray, shape (2, points, 3)
            Mean and tilt of the force of the network on every carried point [N] [eq:coupled-reaction], with the
            inertia of the mass that is lumped at the point.

        Raises
        ------
        ConvergenceError
            When values are no longer finite.
        """
        if not self._fresh:
            self._restore()
        self._fresh = False
        run, interval = self.run, end - self.run.time
        self._next[0, self._rows], self._next[1, self._rows] = place, velocity
        for row, name in self._others:
            moved, rate = self._given[name].at(end)
            self._next[:, row] = self._rest[row] + moved, rate
        self._tables[: self._now.shape[1], 0] = self._now.transpose(1, 0, 2).reshape(-1, 6)
        self._tables[: self._now.shape[1], 1] = self._next.transpose(1, 0, 2).reshape(-1, 6)
        run.driving = (*run.driving[:3], run.time, interval)
        run.fastest_drive = float(np.sqrt(np.max(np.sum(self._next[1] ** 2, axis=-1), initial=0.0)))
        run.ledger[LEDGER:] = 0.0
        good = run.advance(1, 0, interval, self.wanted, self._row)
        if good < 1 or not np.isfinite(place).all():
            raise ConvergenceError(
                f"the network blew up between t = {end - interval:g} and {end:g} s",
                remedy="a smaller step or more viscosity of the bars",
            )
        impulse = run.ledger[LEDGER:].reshape(-1, 2, 3)[self._rows].transpose(1, 0, 2)
        before, after = self._now[:, self._rows], self._next[:, self._rows]
        pushed, moment = -self._carried_mass(np.stack([
            after[1] - before[1],
            0.5 * interval * (before[1] + after[1]) - (after[0] - before[0]),
        ]))  # fmt: skip
        mean = (impulse[0] + pushed) / interval
        tilt = 6.0 / interval**2 * (impulse[1] - 0.5 * interval * impulse[0] + moment)
        return np.stack([mean, tilt])

    def _carried_mass(self, values: Array) -> Array:
        """Return the mass blocks lumped at the carried points times vectors (..., points, 3)."""
        m = self.run.packed.node_rows(MXX, 6)[:, self._nodes]
        x, y, z = values[..., 0], values[..., 1], values[..., 2]
        product = (m[0] * x + m[1] * y + m[2] * z, m[1] * x + m[3] * y + m[4] * z, m[2] * x + m[4] * y + m[5] * z)
        return np.stack(product, axis=-1)

    def accept(self) -> None:
        """Keep the last tried step."""
        self._kept, self._fresh = self._snapshot(), True
        self._accepted += 1
        if self._accepted % _CHOSEN_FOR == 0 or self.run.parted:
            self.run.forget()
        self._now = self._next.copy()
        np.maximum(self._peak, self._row[2][0], out=self._peak)
        np.minimum(self._trough, self._row[1][0], out=self._trough)
        self.steps += self.run.taken
        self._energy = self._row[3][0].copy()
        self.smallest = min(self.smallest, self.run.smallest)

    def keep_row(self) -> None:
        """Add the accepted state to the record."""
        places, pulls, _, energy = (np.array(part) for part in self._row[:4])
        extremes = self._peak[None], self._trough[None]
        self._history.append((np.array([self.run.time]), places, pulls, *extremes, energy))
        self._peak, self._trough = np.full_like(self._peak, -np.inf), np.full_like(self._trough, np.inf)

    def notices(self, record: StepRecord, check: IdentityCheck, finished: bool) -> tuple[Notice, ...]:
        """Return what makes the peaks of the record doubtful, as in :func:`moyai.flexible.simulation.simulate`."""
        self._restore()
        return peak_notices(self.network, self.run, record.bars, record.tension_peak, check, finished)

    def record(self) -> StepRecord:
        """Return what the network did at the kept rows."""
        time, position, pull, peak, trough, energy = map(np.concatenate, zip(*self._history, strict=True))
        return StepRecord(
            time, self.keep_nodes, self.keep_bars, position, pull, peak, trough,
            energy[:, 0], energy[:, 1], energy[:, 2],
        )  # fmt: skip


def carried_nodes(network: Network, names: Sequence[str]) -> IntArray:
    """Return the nodes of carried points.

    Raises
    ------
    InputError
        For a point that the network does not have, does not drive, or that is named twice.
    """
    driven = [name for name, node in network.points.items() if network.nodes.kind[node] == DRIVEN]
    nodes: list[int] = []
    for name in names:
        node = network.points.get(name)
        if node is None or network.nodes.kind[node] != DRIVEN:
            raise InputError(
                f"a body names the point {name!r}, which "
                + ("the network does not have" if node is None else "is not a driven point"),
                parameter=f"bodies.points.{name}",
                allowed=", ".join(driven) or "driven points",
            )
        if node in nodes:
            raise InputError(
                f"two bodies have the point {name!r}", parameter=f"bodies.points.{name}", allowed="one body"
            )
        nodes.append(int(node))
    return np.array(nodes, dtype=np.int64)
