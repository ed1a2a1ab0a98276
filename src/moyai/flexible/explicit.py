"""The explicit scheme: central differences, one force evaluation a step, loads of the water every few steps."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.flexible import sheet_kernel, sheet_lanes
from moyai.flexible.arrays import kernel_arrays, kernel_bed
from moyai.flexible.elements import DRIVEN
from moyai.flexible.explicit_kernel import march, survey
from moyai.flexible.explicit_motion import drive, kick_and_drift
from moyai.flexible.explicit_parts import kick_sections
from moyai.flexible.explicit_rows import FASTEST, FASTEST_ATTACHED, LEDGER, LENGTH, SPRING, VISCOUS, WU, U, X
from moyai.flexible.failures import Failing
from moyai.flexible.flow import Flow
from moyai.flexible.mass_block_kernel import room_for
from moyai.flexible.mass_blocks import pack_blocks
from moyai.flexible.motion import Motion
from moyai.flexible.network import Network
from moyai.flexible.packing import pack
from moyai.flexible.panels import PanelArrays
from moyai.flexible.result import State
from moyai.flexible.rings import RingArrays
from moyai.flexible.stability import step_limit
from moyai.flexible.watch import Watch, watch_of
from moyai.flexible.worn_rope import slow_parts

#: Part of the stable step that is used unless another is given.
SAFETY = 0.95
#: The same where bars go slack with a damping ratio on the mesh below ``LEAST_DAMPING``: a spring that only pulls gives
#: back more than it took when (w dt)^2 > 2, half of the bound of a spring that also pushes [eq:flexible-one-sided].
SAFETY_UNDAMPED, LEAST_DAMPING = 0.5, 0.05
#: Steps between two evaluations of the loads, at most; where the water that goes along with bars outweighs what carries
#: it, by more than ``MOST_ADDED`` at a node, and with sheets and sections of added mass, whose frames turn at these
#: moments (light parts that move along themselves gain or lose energy by frames that lag by more).
LOAD_STEPS, LOAD_STEPS_OF_LIGHT, MOST_ADDED = 12, 1, 2.0
#: Bound of the load interval times the fastest rate of drag; the same for the step, from which a row is broken off.
DRAG_SHARE, DRAG_BROKEN = 0.3, 0.4
#: Part of the stable step below which no row is broken off.
LEAST_PART = 1e-3
#: Choices of a step at one time after which it is marched with the last.
MOST_IDLE = 10


def driving_tables(network: Network, motions: Mapping[str, Motion]) -> tuple[Any, Any, Any, float, float]:
    """Return driven nodes, their places at rest, and the tables of their motions on one grid."""
    driven = np.flatnonzero(network.nodes.kind == DRIVEN)
    pairs = np.stack([driven, network.nodes.motion[driven]], axis=1).astype(np.int64)
    rest = np.ascontiguousarray(network.nodes.position[driven])
    if driven.size == 0:
        return pairs.reshape(0, 2), rest, np.zeros((1, 2, 6)), 0.0, 1e300
    chosen = [motions[name] for name in network.motion_names]
    lead = chosen[0]
    if not all(
        m.step == lead.step and m.start == lead.start and len(m.displacement) == len(lead.displacement) for m in chosen
    ):
        start, end, step = max(m.start for m in chosen), min(m.end for m in chosen), min(m.step for m in chosen)
        count = max(1, math.ceil((end - start) / step - 1e-9))
        grid = np.linspace(start, end, count + 1)
        chosen = [Motion(start, (end - start) / count, *m.at(grid)) for m in chosen]
        lead = chosen[0]
    tables = np.stack([np.concatenate([m.displacement, m.velocity], axis=1) for m in chosen])
    return pairs, rest, np.ascontiguousarray(tables), float(lead.start), float(lead.step)


#: Rows of the result where none is written, of the types of those of a run.
_NOTHING = (np.zeros((0, 0, 3)), *np.zeros((2, 0, 0)), np.zeros((0, 3)), *np.zeros((2, 0), np.int64))


class ExplicitRun:
    """The state of one run; :func:`moyai.flexible.simulation.simulate` makes it and asks it to advance."""

    name = "explicit"
    #: Whether work and impulse of driven points are booked.
    booked = True

    def __init__(
        self,
        network: Network,
        motions: Mapping[str, Motion],
        flow: Flow,
        start: State,
        *,
        safety: float | None,
        load_steps: int,
        shorter: float = 1.0,
    ) -> None:
        self.network, self.flow, self.load_steps = network, flow, load_steps
        self.arrays, self.bed = kernel_arrays(network), kernel_bed(network)
        self.slow = slow_parts(network, start.position, self.arrays)
        #: Lines that part in the course of the run.
        self.failing: Failing | None = None
        self.packed = pack(self.arrays)
        self.rings = RingArrays.of(network.rings)
        self.driving = driving_tables(network, motions)
        self.time, self.step = start.time, 0.0
        #: Steps that led to good rows, and the smallest of them [s].
        self.steps, self.smallest = 0, math.inf
        #: Steps of the last call, and whether it broke a row off.
        self.taken, self.parted, self.stable = 0, False, math.inf
        #: Distance over which a node and the surface may approach each other within a chunk [m].
        self.reach = 1.0 + (2.0 * float(np.sum(flow.waves.amplitude)) if flow.waves is not None else 0.0)
        self.watch = self.watch_of_run()
        self.fastest_drive = float(np.max(np.linalg.norm(self.driving[2][:, :, 3:], axis=2), initial=0.0))
        # 0 work of loads, 1 work at driven points, 2 turn of the added mass, 4 loads known, 5 velocity half a step
        # behind
        self.ledger = np.zeros(LEDGER + (6 * len(self.driving[0]) if self.booked else 0))
        self.place[:], self.speed[:] = start.position.T, start.velocity.T
        self.speed[:, network.nodes.kind != 0] = 0.0
        drive(self.packed.memory, *self.driving, self.time, 0.0)
        for node, slot in self.driving[0]:
            self.speed[:, node] = motions[network.motion_names[slot]].at(self.time)[1]
        self.sheets, self.blocks = self._surfaces(start)
        #: Panels, rings, sheets and blocks as the kernels take them, ``None`` for what the network has not.
        self.parts = self._parts()
        self.water = flow.at(self.time, self.place)
        self.packed.node_rows(WU, 7)[:] = self.water
        self._call_march(0, _NOTHING, np.zeros_like(self.water), 0, 0.0, (0.0, 1, 1), self.near_surface(), math.inf)
        self.safety = self._usual_safety() if safety is None else safety
        #: Factor on every step, for a look at what the step does.
        self.shorter = shorter
        #: Largest part of the step that is stable for this network, of which use was made, by a step given by hand.
        self.overstep = 0.0
        if network.blocks is not None or network.sheets is not None or self._most_added() > MOST_ADDED:
            self.load_steps = min(load_steps, LOAD_STEPS_OF_LIGHT)

    def _most_added(self) -> float:
        """Return the largest added mass of bars at a free node, over its own mass; that of attachments has no frame."""
        arrays, free = self.arrays, self.network.nodes.kind == 0
        if not free.any():
            return 0.0
        added = np.zeros(free.size)
        for end in (arrays.start, arrays.end):
            np.add.at(added, end, arrays.bar("added_normal"))
        return float(np.max(added[free] / np.maximum(arrays.node("mass")[free], 1e-300)))

    def _usual_safety(self) -> float:
        """Return the part of the stable step that suits the viscosity of the bars."""
        limit, _ = self.limit()
        pulls_only = self.arrays.bar("least_tension") == 0.0
        if not pulls_only.any() or not math.isfinite(limit):
            return SAFETY
        damping = self.arrays.bar("viscous")[pulls_only] / (self.arrays.greatest_spring[pulls_only] * limit)
        least = float(damping.min())
        sheets = self.network.sheets
        if sheets is not None and sheets.tension_field:
            least = min(least, float(np.min(sheets.damping_time)) / limit)
        return SAFETY if least >= LEAST_DAMPING else SAFETY_UNDAMPED

    def _surfaces(self, start: State) -> tuple[Any, Any]:
        """Return what the kernels take of sheets and of dense mass blocks; the frames of blocks count from as built."""
        arrays, network = self.arrays, self.network
        own = arrays.node("mass") + arrays.node("added_mass")
        for end in (arrays.start, arrays.end):
            np.add.at(own, end, arrays.bar("added_normal"))
        free = arrays.nodes[9:12]
        packed = pack_blocks(network.blocks, network.nodes.position.T, own, free)
        whole = network.blocks is not None and network.blocks.convective
        blocks = (
            packed.nodes, packed.guides, packed.frames, packed.added, packed.inverse, packed.along,
            own[packed.nodes], whole, packed.light, room_for(packed.nodes),
        )  # fmt: skip
        sheets = network.sheets
        count = 0 if sheets is None else len(sheets)
        table = (
            np.zeros((0, sheet_kernel.COLUMNS))
            if sheets is None
            else sheets.constants(network.water, network.nodes.position)
        )
        triangles = np.zeros((0, 3), dtype=np.int64) if sheets is None else sheets.triangles.copy()
        room = np.zeros(sheet_lanes.ROWS * sheet_lanes.LANES), np.zeros(sheet_lanes.LANES, dtype=np.int64)
        side_by_side = (sheet_lanes.packed_constants(table), *room)
        return (table, triangles, packed.light, np.zeros(1), np.zeros(count), *side_by_side), blocks

    def _parts(self) -> tuple[Any, Any, Any, Any]:
        network, count, rings = self.network, len(self.network.nodes), self.rings
        panels = (PanelArrays.of(network.panels).system, np.zeros((12, count)))
        spare = np.zeros((3, count)), np.zeros((rings.nodes.size, 3))
        return (
            panels if panels[0][0].shape[0] else None,
            (rings.system, spare[1], spare[0]) if rings.nodes.size else None,
            self.sheets if network.sheets is not None else None,
            self.blocks if network.blocks is not None else None,
        )

    def kick(self, push: float) -> None:
        """Advance all velocities by ``push`` seconds of the present forces."""
        kick_sections(self.packed.memory, self.parts[3], push, -1e300)
        kick_and_drift(self.packed.memory, self.packed.sizes[0], push, 0.0)

    @property
    def place(self) -> Array:
        """Positions, a view of shape (3, n)."""
        return self.packed.node_rows(X, 3)

    @property
    def speed(self) -> Array:
        """Velocities, a view of shape (3, n); half a step behind once the run goes."""
        return self.packed.node_rows(U, 3)

    def _call_march(
        self, rows: int, saved: Any, rate: Array, first: int, before: float, choice: tuple[float, int, int],
        surface: bool, bear: float,
    ) -> int:  # fmt: skip
        packed, arrays, water = self.packed, self.arrays, self.network.water
        *kept, bars = saved
        return int(march(
            packed.memory, packed.sizes, packed.runs, arrays.curves, arrays.hinges, arrays.bending, arrays.attached,
            np.array([water.density, water.gravity]),
            (not self.flow.steady, surface, self.water, rate, self.time), self.driving, self.bed,
            (self.time, *choice, rows, first, before), self.ledger, (*kept, packed.place[bars]), self.parts,
            (*self.watch.system, *self.bounds_of_drag(bear)),
        ))  # fmt: skip

    def watch_of_run(self) -> Watch:
        """Return what is watched at every step."""
        return watch_of(self.network, self.packed.place)

    def bounds_of_drag(self, bear: float) -> tuple[float, float]:
        """Return what the rate of drag times the load interval, and times the step, may be in a march."""
        return DRAG_SHARE, bear

    def _survey(self, ahead: float = 0.0) -> tuple[float, bool, Array]:
        """Return the rate that bounds the load interval, whether the surface is near, and inverse masses for the step.

        Near is what may cross the surface within ``ahead`` seconds, 5 m/s faster than twice the present speed.
        """
        arrays, water = self.arrays, self.network.water
        inverse = np.empty((6, arrays.nodes.shape[1]))
        rate, near = survey(
            self.packed.memory, arrays.nodes.shape[1], (arrays.nodes, arrays.bars), arrays.start, arrays.end,
            self.packed.place, self.water, float(self.sheets[3][0]), self.fastest_drive, water.density * water.gravity,
            self.reach, ahead, inverse,
        )  # fmt: skip
        if self.blocks[0].size:
            # nodes of dense blocks count with their own mass: along the cable they have no other
            for row, name in ((0, "free_x"), (3, "free_y"), (5, "free_z")):
                inverse[row, self.blocks[0]] = arrays.node(name)[self.blocks[0]] / self.blocks[6]
        return float(rate), bool(near), inverse

    def near_surface(self, ahead: float = 0.0) -> bool:
        """Whether a bar may cross the surface within ``ahead`` seconds."""
        return self._survey(ahead)[1]

    def first_row(self, saved: Any) -> None:
        """Write the row of the start."""
        self._call_march(-1, saved, np.zeros_like(self.water), 0, 0.0, (0.0, 1, 1), False, math.inf)

    def limit(self) -> tuple[float, int]:
        """Return the largest stable step now and the node that sets it; what may fall dry counts without added mass."""
        return self._bound(self.inverse_masses())

    def drag_rate(self) -> float:
        """Return the highest rate at which drag damped any part so far [1/s]."""
        bars = np.max(self.packed.bar_row(FASTEST), initial=0.0)
        return float(max(bars, np.max(self.packed.node_rows(FASTEST_ATTACHED, 1), initial=0.0)))

    def inverse_masses(self) -> Array:
        """Return the inverse mass blocks for the step (6, n): what may fall dry counts without added mass."""
        return self._survey()[2]

    def _bound(self, inverse: Array) -> tuple[float, int]:
        sheets = None if self.parts[2] is None else self.parts[2][:2]
        return step_limit(self.arrays, self.place, inverse, self.rings.hinges, sheets)

    def choose(self, row_interval: float, wanted: float | None) -> tuple[float, int, int]:
        """Return step, steps per load interval and load intervals per row that fill ``row_interval``."""
        fastest, _, inverse = self._survey()
        self.stable = stable = self._bound(inverse)[0]
        largest = min(self.safety * stable, DRAG_SHARE / max(fastest, 1e-300)) if wanted is None else wanted
        least = max(1, math.ceil(row_interval / (self.shorter * largest) * (1.0 - 1e-12)))
        if wanted is not None:
            # with the drag of the water, which a longer step would hold back, the bound may be a shorter one
            bound = min(stable, DRAG_SHARE / max(fastest, 1e-300))
            self.overstep = max(self.overstep, row_interval / least / bound)
        most = min(self.load_steps, least)
        while most > 1 and most * row_interval / least * fastest > DRAG_SHARE:
            most -= 1
        # the cheapest way to fill the row: the loads cost about as much as two steps
        choices = [(math.ceil(least / n), n) for n in range(1, most + 1)]
        if self.safety == 1.0:
            # the pace of the wave itself: no shorter step will do
            choices = [(count, n) for count, n in choices if count * n == least]
        per_row, per_load = min(choices, key=lambda choice: choice[0] * (choice[1] + 2.0))
        return row_interval / (per_row * per_load), per_load, per_row

    def prepare(self, row_interval: float, wanted: float | None) -> tuple[float, int, int]:
        """Choose as :meth:`choose` does and make the state ready for that step."""
        step, per_load, per_row = self.choose(row_interval, wanted)
        if self.ledger[5] > 0.0 and abs(step - self.step) > 1e-12 * step:
            # velocities stand half an old step before now: bring them to half a new step before now
            self.kick(0.5 * (self.step - step))
        self.step, self.per_load = step, per_load
        self.watch.at_step(step)
        return step, per_load, per_row

    def advance(self, rows: int, first: int, row_interval: float, wanted: float | None, saved: Any) -> int:
        """March ``rows`` rows of the result; return how many were good."""
        good = self._advance(rows, first, row_interval, wanted, saved)
        for slow in self.slow:
            place = self.packed.place[slow.bars]
            self.packed.memory[LENGTH + place] = slow.advance(self.place, self.speed, rows * row_interval)
            self.packed.memory[SPRING + place] = self.arrays.bar("spring")[slow.bars] = slow.spring
            saved[3][first : first + rows, 1] += slow.energy
        self.part()
        return good

    def part(self) -> None:
        """Take the stiffness from the bars that part now."""
        if self.failing is not None:
            gone = self.packed.place[self.failing.look(self.place, self.speed, self.time)]
            for row in (SPRING, VISCOUS):
                self.packed.memory[row + gone] = 0.0

    def _advance(self, rows: int, first: int, row_interval: float, wanted: float | None, saved: Any) -> int:
        begin, done, left = self.time, 0, row_interval
        self.taken, self.parted, idle = 0, False, 0
        while done < rows:
            self.parted = self.parted or left < row_interval
            asked = rows - done if left == row_interval else 1
            good = self._march(asked, first + done, (left, row_interval - left), wanted, saved, idle < MOST_IDLE)
            broken = int(self.watch.broken[0])
            if broken >= 0:
                # drag has outrun the step within a row: what is left of it continues with a shorter one
                idle = idle + 1 if good == -1 and broken == 0 else 0
                left = (left if good == -1 else row_interval) - broken * self.step
                done += -good - 1
                continue
            idle, left, done = 0, row_interval, done + abs(good)
            self.time = begin + done * row_interval
            if 0 <= good < asked:
                break
        return done

    def _march(
        self, rows: int, first: int, interval: tuple[float, float], wanted: float | None, saved: Any, watchful: bool
    ) -> int:
        """March with one step; a negative number of good rows means that another step is needed.

        ``interval`` is that of the rows, and what is gone of the only one already; a row is broken off when
        ``watchful``.
        """
        row_interval, before = interval
        step, per_load, per_row = self.prepare(row_interval, wanted)
        end = self.time + rows * row_interval
        # the water at the end, where the nodes are then by their present speeds: the next interval begins with it
        ahead = self.water
        if not self.flow.steady:
            ahead = self.flow.at(end, self.place + (end - self.time) * self.speed)
        rate = (ahead - self.water) / (end - self.time)
        # what blows up for another reason must not be followed down to steps without end
        bear = DRAG_BROKEN if watchful and step >= LEAST_PART * self.stable else math.inf
        good = self._call_march(
            rows, saved, rate, first, before, (step, per_load, per_row), self.near_surface(rows * row_interval), bear
        )
        taken, broken = abs(good) * per_load * per_row, int(self.watch.broken[0])
        if broken >= 0:
            taken += broken - per_load * per_row
        if good < 0:
            end = self.time + taken * step
        self.taken, self.steps, self.smallest = self.taken + taken, self.steps + taken, min(self.smallest, step)
        self.time = end
        whole = good >= 0 and broken < 0
        self.water = ahead if whole or self.flow.steady else self.flow.at(end, self.place)
        return good

    def state(self) -> State:
        """Return the state at the present time (the forces of the last row give the half step)."""
        before = self.speed.copy()
        if self.step:
            self.kick(0.5 * self.step)
        speed = self.speed.copy()
        self.speed[:] = before
        return State(self.time, self.place.T.copy(), np.ascontiguousarray(speed.T))
