"""The row in time: matrices for the motions that the constraints leave, runs, loads that follow from them."""

from __future__ import annotations

import math
import time as clock
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.mooring.lines import LineElement
from moyai.mooring.system import LineSystem
from moyai.mooring.table import compile_lines
from moyai.structures.units.assembly import RowAtLevel, held_load
from moyai.structures.units.connectors import UnitJoint, spring_matrices
from moyai.structures.units.response import critical_damping, masses_along_units
from moyai.structures.units.time import kernel
from moyai.structures.units.time.memory import RowMemory, check_mass
from moyai.structures.units.viscous import Eddies, eddies_of

Status = Literal["converged", "diverged", "interrupted"]
#: A motion beyond this many lengths of a unit is lost
LIMIT = 10.0
#: Steps of a contact between two units, of a period of the shortest waves
STEPS_OF_CONTACT, STEPS_OF_WAVE = 20, 40
SECONDS_BETWEEN_LOOKS = 0.3
#: Steps in which lines are solved exactly; tables then serve within what their ends moved, widened by this share of it
#: and at least so far [m] either way
STEPS_BEFORE_TABLES, WIDENED, LEAST_WIDENED = 4096, 0.3, 0.01
#: Accuracy of the tables over the tension
TABLE_TOLERANCE = 1e-4
#: Times whose loads of constraints are found at once
_ROWS = 4096


@dataclass(frozen=True, eq=False)
class RowInTime:
    """The row at one level with the memory of its water [eq:units-cummins]."""

    at: RowAtLevel
    memory: RowMemory
    #: Mean position, where lines have the stiffness that damping is a fraction of, and where runs start; shape (m,).
    position: Array
    #: Frequency [rad/s] whose added mass a fraction of critical damping is taken with.
    damping_frequency: float

    def __post_init__(self) -> None:
        check_mass(self.at.inertia, self.memory)

    @cached_property
    def mass(self) -> Array:
        """Mass and added mass at infinite frequency (m, m)."""
        return np.asarray(self.at.inertia + self.memory.infinite_added_mass)

    @cached_property
    def damping(self) -> Array:
        """Damping (m, m) but that of waves and of curves of connectors."""
        at = self.at
        added = self.memory.coefficients(np.array([self.damping_frequency]))[0]
        restoring = at.hydrostatic + at.line_stiffness(self.position)
        linear = tuple(joint for joint in at.joints if joint.connector.curve is None)
        own = critical_damping(at, masses_along_units(at, added), restoring)[0]
        return np.asarray((at.unit_axes.T * own) @ at.unit_axes + spring_matrices(linear, at.size)[1])

    @cached_property
    def eddies(self) -> Eddies | None:
        """Edges that shed eddies, where the case computes them."""
        return eddies_of(self.at)

    @cached_property
    def stiffness(self) -> Array:
        """Stiffness (m, m) of buoyancy and springs; lines and curves apart."""
        return np.asarray(self.at.hydrostatic + self.at.springs[0])

    @property
    def balanced(self) -> Array:
        """Part of the force of the lines (m,) that weight and buoyancy carry at rest."""
        out = np.zeros(self.at.size)
        out[2::6] = self.at.line_force(np.zeros(self.at.size))[2::6]
        return out

    def contact_step(self) -> float:
        """Return the step [s] that resolves the shortest contact of connectors with a curve; infinite without."""
        free, fastest = self.at.free, 0.0
        mass = np.linalg.inv(free.T @ self.mass @ free)
        for link in self.at.links:
            ends = link.rows(np.zeros(self.at.size)) @ free
            mobility = ends @ mass @ ends.T
            # a line in space is pulled whichever way the units move apart
            light = link.axis @ mobility @ link.axis if link.span == 0.0 else np.linalg.eigvalsh(mobility)[-1]
            steepest = np.max(np.diff(link.curve.force) / np.diff(link.curve.elongation))
            fastest = max(fastest, float(np.sqrt(max(light * steepest, 0.0))))
        return 2.0 * math.pi / fastest / STEPS_OF_CONTACT if fastest > 0.0 else math.inf

    def _lines(self, moved: Array | None = None) -> tuple[Any, ...]:
        """Return the lines for the kernel, with tables about the motions (n, m) of the units where these are given."""
        every = tuple(line for lines in self.at.lines for line in lines)
        holder = np.array([n for n, lines in enumerate(self.at.lines) for _ in lines], dtype=np.int64)
        depth = self.at.water.depth + float(self.at.centres[0, 2])
        reach = None if moved is None or not every else self._reach(every, moved)
        packed = compile_lines(
            LineSystem(every, depth), tolerance=None if reach is None else TABLE_TOLERANCE, reach=reach
        )
        return holder, *packed.arguments

    def _reach(self, every: tuple[LineElement, ...], moved: Array) -> Array:
        """Return least and largest level distance and height of the ends of every line (lines, 2, 2), widened."""
        ends = np.concatenate(
            [system.fairleads(moved[:, 6 * n : 6 * n + 6]) for n, system in enumerate(self.at.systems)], axis=1
        )
        apart = ends - np.array([line.anchor for line in every])
        over = np.stack([np.hypot(apart[..., 0], apart[..., 1]), apart[..., 2]], axis=-1)
        least, largest = over.min(axis=0), over.max(axis=0)
        room = np.maximum(WIDENED * (largest - least), LEAST_WIDENED)
        least, largest = least - room, largest + room
        least[:, 0] = np.maximum(least[:, 0], 0.0)
        return np.stack([least, largest], axis=-1)

    def _joints(self) -> tuple[Any, ...]:
        links = self.at.links
        xs = [np.zeros(0), *(np.array(link.curve.elongation, dtype=float) for link in links)]
        fs = [np.zeros(0), *(np.array(link.curve.force, dtype=float) for link in links)]
        return (
            np.array([link.pair for link in links], dtype=np.int64).reshape(len(links), 2),
            np.array([link.arms for link in links], dtype=float).reshape(len(links), 2, 3),
            np.array([link.bend for link in links], dtype=float),
            np.array([link.axis for link in links], dtype=float).reshape(len(links), 3),
            np.array([link.span for link in links], dtype=float), np.concatenate(xs), np.concatenate(fs),
            np.cumsum([len(x) for x in xs]), np.array([link.damping for link in links], dtype=float),
            np.array([link.side for link in links], dtype=float),
        )  # fmt: skip

    def run(
        self, load: Array, step: float, *, water: Array | None = None, start: Array | None = None,
        progress: Progress = silent, name: str = "",
    ) -> RowRun:  # fmt: skip
        """Integrate the row under given forces.

        Parameters
        ----------
        load : ndarray (n, m)
            Forces at the times ``step * arange(n)``, row axes; memory, buoyancy, lines and connectors apart.
        step : float
            [s].
        water : ndarray (n, k) or None
            Motion of the waves in the measures of the edges; still water without.
        start : ndarray (m,) or None
            Position from which it is let go; ``position`` without.
        progress : Progress
        name : str
            Of the run, for the listener.
        """
        at, free = self.at, self.at.free
        poles = self.memory.poles
        decay, before, after = step_weights(poles, step)
        reduced = np.einsum("mr,kmn,ns->krs", free, self.memory.residues, free)
        g = at.constraint
        share = np.linalg.solve(g @ g.T, g) if len(g) else np.zeros((0, at.size))
        held = np.einsum("cm,kmn,ns->kcs", share, self.memory.residues, free)
        memory, of_held = (decay, before, after, kernel.side_by_side(reduced)), kernel.side_by_side(held)
        mass = free.T @ self.mass @ free
        damping = free.T @ self.damping @ free + np.einsum("k,krs->rs", after, reduced).real
        tangent = free.T @ at.line_stiffness(self.position) @ free
        stiffness = free.T @ self.stiffness @ free + tangent
        inverse = np.linalg.inv(mass + 0.5 * step * damping + 0.25 * step**2 * stiffness)
        lines, joints = self._lines(), self._joints()
        so_far = np.zeros(len(lines[0])), np.zeros((3, free.shape[1])), np.zeros(3)
        count, size, link_count = len(load), free.shape[1], len(at.links)
        saved = (
            np.zeros((count, size)), np.zeros((count, size)), np.zeros((count, size)), np.zeros((count, len(g))),
            np.zeros((count, at.size)), np.zeros((count, len(lines[0]))), np.zeros((count, link_count)),
        )  # fmt: skip
        y = free.T @ (self.position if start is None else np.asarray(start, dtype=float))
        v, z = np.zeros(size), np.zeros((len(poles), size), dtype=complex)
        self._first(load[0], y, mass, saved)
        a = saved[2][0].copy()
        eddies = self.eddies
        moving = np.zeros((count, 0 if eddies is None else len(eddies.points))) if water is None else water
        rows = np.zeros((0, size)) if eddies is None else eddies.drag.directions @ free
        edges = np.zeros(0) if eddies is None else eddies.drag.coefficients
        drag = (np.ascontiguousarray(rows), edges, np.ascontiguousarray(moving))
        body = (
            np.ascontiguousarray(inverse), np.ascontiguousarray(damping), np.ascontiguousarray(stiffness),
            np.ascontiguousarray(free), np.ascontiguousarray(tangent), self.balanced,
        )  # fmt: skip
        given, limit = np.ascontiguousarray(load @ free), LIMIT * at.row.length

        def advance(first: int, steps: int) -> tuple[int, int]:
            nonlocal lines
            if first < STEPS_BEFORE_TABLES:
                steps = min(steps, STEPS_BEFORE_TABLES - first)
            elif first == STEPS_BEFORE_TABLES:
                lines = self._lines(saved[0][: first + 1] @ free.T)
            code, good = kernel.march(
                y,
                v,
                a,
                z,
                first,
                steps,
                step,
                given,
                body,
                memory,
                of_held,
                (*lines, *so_far),
                joints,
                drag,
                limit,
                saved,
            )
            return code, good

        done, status, message = _driven(advance, count - 1, step, progress, name)
        end = done + 1
        y_s, v_s, a_s, memory_s, line_s, tension_s, link_s = (item[:end] for item in saved)
        return RowRun(
            self, np.asarray(step * np.arange(end), dtype=float), load[:end], y_s, v_s, a_s, memory_s, line_s,
            tension_s, link_s, step, status, message, moving,
        )  # fmt: skip

    def _first(self, load: Array, y: Array, mass: Array, saved: tuple[Array, ...]) -> None:
        """Write position, acceleration, lines and connectors at the start; the row lies still."""
        at, free = self.at, self.at.free
        position = free @ y
        saved[0][0] = y
        force = load - self.stiffness @ position
        if at.line_names:
            saved[4][0] = at.line_force(position)
            saved[5][0] = at.tensions(position)
            force = force + saved[4][0] - self.balanced
        for number, link in enumerate(at.links):
            saved[6][0, number] = float(link.curve.at(link.elongation(position)))
            force = force - saved[6][0, number] * link.along(position)
        saved[2][0] = np.linalg.solve(mass, free.T @ force)


def step_weights(poles: ComplexArray, step: float) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
    """Return factors of the states, of the velocity before and after a step in which it is a straight line."""
    q = poles * step
    decay = np.exp(q)
    small = np.abs(q) < 1e-3
    safe = np.where(small, 1.0, q)
    one = np.where(small, 1.0 + q / 2.0 + q**2 / 6.0, (decay - 1.0) / safe)
    two = np.where(small, 0.5 + q / 6.0 + q**2 / 24.0, (decay - 1.0 - q) / safe**2)
    weights = (decay, step * (one - two), step * two)
    first, second, third = (np.asarray(item, dtype=complex) for item in weights)
    return first, second, third


def _driven(advance: Any, steps: int, step: float, progress: Progress, name: str) -> tuple[int, Status, str]:
    """Call the kernel in pieces of a fraction of a second, so that an interrupt and the listener get their turn."""
    done, piece = 0, 32
    try:
        while done < steps:
            count = min(piece, steps - done)
            began = clock.perf_counter()
            code, good = advance(done, count)
            done += good
            if code != kernel.RUNNING:
                words = "grew without bound" if code == kernel.DIVERGED else "found no balance within a step"
                return done, "diverged", f"the motion {words} after {done * step:.4g} s; results before it are valid"
            spent = clock.perf_counter() - began
            progress(f"time domain{name}", done * step, steps * step)
            if spent < SECONDS_BETWEEN_LOOKS:
                piece = min(4 * piece, max(32, int(count * SECONDS_BETWEEN_LOOKS / max(spent, 1e-6))))
    except KeyboardInterrupt:
        return done, "interrupted", f"interrupted at {done * step:.4g} s of {steps * step:.4g} s"
    return done, "converged", ""


@checks_words
@dataclass(frozen=True, eq=False)
class RowRun:
    """Motions and loads over time."""

    model: RowInTime
    #: Shape (n,).
    time: Array
    #: Shape (n, m).
    load: Array
    #: Motions that the constraints leave; shape (n, r).
    reduced: Array
    #: Their velocity; shape (n, r).
    velocity: Array
    #: Their acceleration; shape (n, r).
    acceleration: Array
    #: Force of the memory on the constraints; shape (n, c).
    held_memory: Array
    #: Shape (n, m).
    line_force: Array
    #: At the fairleads; shape (n, lines).
    tension: Array
    #: Of the curves of connectors, pulling positive; shape (n, j).
    link_force: Array
    time_step: float
    status: Status
    message: str
    #: Motion of the waves in the measures of the edges; shape (n, k).
    water: Array

    @cached_property
    def position(self) -> Array:
        """All motions (n, m), row axes."""
        return np.asarray(self.reduced @ self.model.at.free.T)

    @cached_property
    def held(self) -> Array:
        """Loads of the constraints (n, c) [eq:units-held], pulling positive."""
        out = np.zeros((len(self.time), len(self.model.at.constraint)))
        if out.shape[1]:
            # arrays over a whole run would go through memory ten times
            for start in range(0, len(out), _ROWS):
                rows = slice(start, start + _ROWS)
                out[rows] = held_load(self.model.at, self._unbalanced(rows)) - self.held_memory[rows]
        return out

    def _unbalanced(self, rows: slice) -> Array:
        """Return the forces (n, m) that constraints and memory balance at some times."""
        model, free = self.model, self.model.at.free
        left = self.load[rows] - self.position[rows] @ model.stiffness
        left -= self.acceleration[rows] @ (free.T @ model.mass) + self.velocity[rows] @ (free.T @ model.damping)
        if model.at.line_names:
            left += self.line_force[rows] - model.balanced
        if model.eddies is not None:
            drag = model.eddies.drag
            measure = self.velocity[rows] @ (free.T @ drag.directions.T) - self.water[: len(self.time)][rows]
            left -= (drag.coefficients * np.abs(measure) * measure) @ drag.directions
        for number, link in enumerate(model.at.links):
            left -= self.link_force[rows, number, None] * link.along(self.position[rows])
        return left

    def relative(self, joint: UnitJoint) -> Array:
        """Return the relative motion (n, 6) of a connector."""
        return np.asarray(self.position @ joint.relative.T)

    @cached_property
    def joint_loads(self) -> Array:
        """Loads (n, joints, 6) of all connectors on the unit before each."""
        joints = self.model.at.joints
        out = np.zeros((len(self.time), len(joints), 6))
        rate = self.velocity @ self.model.at.free.T
        first = 0
        for number, joint in enumerate(joints):
            connector = joint.connector
            if len(joint.held):
                out[:, number] += self.held[:, first : first + len(joint.held)] @ joint.held
                first += len(joint.held)
            if connector.stiffness is not None:
                out[:, number] += self.relative(joint) @ connector.stiffness.T
            if connector.damping is not None:
                out[:, number] += rate @ (connector.damping @ joint.relative).T
        for number, link in enumerate(self.model.at.links):
            out[:, link.joint, :3] += self.link_force[:, [number]] * link.direction(self.position)
        return out
