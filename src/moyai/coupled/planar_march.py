"""One planar body on lines in motion, many steps a call: the compiled form of the joint where nothing requires more."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.compiled import with_pointers
from moyai.coupled import planar_kernel as kernel
from moyai.coupled.bodies import BodyLog
from moyai.coupled.joint import MOST_PASSES, Joint
from moyai.coupled.planar import PlanarCarrier
from moyai.flexible.explicit import DRAG_BROKEN, DRAG_SHARE, LEAST_PART
from moyai.flexible.explicit_kernel import march
from moyai.flexible.stepping import SteppedNetwork
from moyai.floating.kernel import run_state_space
from moyai.sea.kinematics import stretching_code


class PlanarMarch:
    """Takes steps of :class:`moyai.coupled.joint.Joint` in compiled code, to rounding with the same result.

    It serves one planar body that carries all driven points of its network. Body, network and joint hold the state
    between two calls, so that a step on which both do not agree can be taken, and cut, by the joint.

    Parameters
    ----------
    joint : Joint
    stepped : SteppedNetwork
    carrier : PlanarCarrier
    log : BodyLog
        Takes the rows of the body.
    interval : float
        Length of a step [s].
    rows : int
        Steps of the whole run.
    """

    def __init__(
        self, joint: Joint, stepped: SteppedNetwork, carrier: PlanarCarrier, log: BodyLog, interval: float, rows: int
    ) -> None:
        self.joint, self.stepped, self.carrier, self.log = joint, stepped, carrier, log
        self.interval, self.rows = interval, rows
        self._compiled: Callable[..., int] | None = None
        count, bars, nodes = len(carrier.points), stepped.keep_bars.size, stepped.keep_nodes.size
        self._network_rows = (
            np.zeros((rows, nodes, 3)), np.zeros((rows, bars)), np.zeros((rows, bars)), np.zeros((rows, 3))
        )  # fmt: skip
        self._motion, self._reaction = np.zeros((2, rows, 3)), np.zeros((rows, count, 3))
        self._halves: Array = 0.5 * interval * np.arange(2.0 * stepped.steps_to_choice + 1.0)

    @classmethod
    def where_possible(
        cls, joint: Joint, stepped: SteppedNetwork, logs: Sequence[BodyLog], interval: float, rows: int
    ) -> PlanarMarch | None:
        """Return the march, ``None`` for other bodies, several of them, sheets, or points that follow a motion."""
        carrier = joint.carriers[0] if len(joint.carriers) == 1 else None
        plain = not stepped.follows_motions and stepped.network.sheets is None
        if not (isinstance(carrier, PlanarCarrier) and plain):
            return None
        return cls(joint, stepped, carrier, logs[0], interval, rows)

    def advance(self, first: int) -> int:
        """Take steps from row ``first`` on until the network chooses its step again; return how many were agreed on.

        After fewer than one the joint has to take the step.
        """
        joint, stepped, carrier = self.joint, self.stepped, self.carrier
        begin, run = stepped.time, stepped.run
        steps = min(stepped.steps_to_choice, self.rows - first)
        choice, system, kept = stepped.begin_march(self.interval)
        bear = DRAG_BROKEN if choice[0] >= LEAST_PART * run.stable else math.inf
        near = run.near_surface(steps * self.interval)
        nodes, slots, now, tables = stepped.carried_system
        moved, change = np.ascontiguousarray(joint.differences)
        books = np.array([joint.largest, joint.length, 0.0, 0.0, 0.0, 0.0, joint.impulse, float(joint.known)])
        arguments = (
            steps, first, begin, self.interval, carrier.force_at(begin + self._halves[: 2 * steps + 1]),
            carrier.carried, carrier.system(self.interval), (carrier.q, carrier.v, carrier.z, carrier.rate),
            (*system, *kept), (nodes, slots, now, tables), self._sea(), (*choice, near, DRAG_SHARE, bear),
            (joint.reaction, joint.before, joint.oldest, joint.carry, joint.slips, moved, change), books,
            (joint.tolerance, MOST_PASSES), (*self._network_rows, self._motion, self._reaction),
        )  # fmt: skip
        if self._compiled is None:
            self._compiled = _compiled(arguments)
        good = int(self._compiled(*arguments))
        done = slice(first, first + good)
        stepped.end_march(good, self.interval, kept, now, tuple(rows[done] for rows in self._network_rows))
        carrier.time = stepped.time
        self.log.keep_march(self._motion[:, done], self._reaction[done])
        joint.largest, joint.length, joint.impulse, joint.known = books[0], books[1], books[6], int(books[7])
        joint.differences = np.stack([moved, change])
        joint.passes, joint.steps = joint.passes + int(books[2]), joint.steps + good
        joint.work, joint.lost = joint.work + books[4], joint.lost + books[5]
        return good

    def _sea(self) -> tuple[Any, ...]:
        """Return the water as the kernel takes it, its current as it stands at the nodes."""
        flow, run = self.stepped.run.flow, self.stepped.run
        table, step = flow.summed
        waves, depth = flow.waves, math.inf
        parts: tuple[Array, ...] = (np.zeros(0),) * 6
        if waves is not None and waves.water is not None:
            given = waves.omega, waves.intrinsic_omega, waves.amplitude, waves.phase, waves.heading, waves.wave_number
            parts = tuple(np.ascontiguousarray(part, dtype=float) for part in given)
            depth = float(waves.water.depth)
        steady, stretching = flow.steady_velocity(run.place), stretching_code(flow.stretching)
        return steady, flow.ramp, flow.wave_ramp, table, step, parts, depth, stretching


def _compiled(arguments: tuple[Any, ...]) -> Callable[..., int]:
    """Return the compiled kernel for arguments of these types.

    It calls the kernels of body and network through pointers, in the form in which they are compiled for their own
    runs: compiled into it they would cost the first run half a minute.
    """
    _, first, begin, h, force, _carried, body, motion, network, points, _sea, choice, *_, rows = arguments
    system, (ledger, *watched), water = network[:13], network[13:18], network[-1]
    constants, lines, rest, weights, inputs, outputs, saved = body
    step, per_load, per_row, near, most, bear = choice
    pairs, bed, parts, kept_nodes, kept_bars = system[8:]
    marched = (
        *system[:8], (True, near, water, water, begin), (pairs, points[2][0], points[3], begin, h), bed,
        (begin, step, per_load, per_row, 1, first, begin), ledger, (*rows[:4], kept_nodes, kept_bars), parts,
        (*watched, most, bear),
    )  # fmt: skip
    stepped = (
        *motion[:3], 0, 1, h, force, constants, lines, rest, weights, inputs, outputs, motion[0], kernel.NEVER, saved
    )  # fmt: skip
    return with_pointers(kernel.march_together, ((march, marched), (run_state_space, stepped)), arguments)
