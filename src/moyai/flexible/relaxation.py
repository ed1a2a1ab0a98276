"""Towards rest: Newton's method on places and tensions together, in steps of a pseudo time.

The tensions of the bars and the pushes of the bed are unknowns of their own, tied to the places by the laws of bars and
bed [eq:flexible-mixed]. A stiff chain may then turn far in one step: the second-order lengthening of its bars, which
would count as an enormous tension if tension followed from the places, is only a gap that the next step closes. What
can only pull or push keeps its sign by a rounding that shrinks with the forces left (a primal-dual interior point).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.remembered import Remembered, key_of_objects
from moyai.flexible import equilibrium_kernel, force_kernel, front_kernel
from moyai.flexible.arrays import KernelArrays, bed_at_rest, kernel_arrays
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.parts import Part, network_parts
from moyai.flexible.sparse import SparsePlan, make_plan

#: Steps below this turn of every bar [rad or strain] are taken whole, without a search along them.
_SMALL_TURN = 1e-4
_PLANS: Remembered[SparsePlan] = Remembered(8)


def kernel_system(arrays: KernelArrays) -> tuple[object, ...]:
    """Return the tuple that the kernels take."""
    return (
        arrays.nodes, arrays.bars, arrays.start, arrays.end, arrays.curve, arrays.curves, arrays.hinges, arrays.bending,
        arrays.attached,
    )  # fmt: skip


def mean_size(network: Network) -> float:
    """Return the mean length of the bars, or of the edges of the triangles where there are none [m]."""
    if len(network.bars):
        return float(np.mean(network.bars.length))
    if network.sheets is not None and len(network.sheets):
        return float(np.mean(np.sqrt(2.0 * network.sheets.area)))
    return 1.0


def plan_of(network: Network, arrays: KernelArrays, parts: tuple[Part, ...] = ()) -> SparsePlan:
    """Plan the sparse solver of a network: bars first, hinges second, then the parts."""
    place, members = network.nodes.position, [np.stack([arrays.start, arrays.end], axis=1), arrays.hinges]
    members += [part.members for part in parts]
    return _PLANS.of(key_of_objects(place, members), lambda: make_plan(place, members))


def kernel_plan(plan: SparsePlan) -> tuple[object, ...]:
    """Return a plan of the sparse solver as the kernels take it, with room for its numbers."""
    return (
        plan.own, plan.pairs[0], plan.pairs[1], np.zeros(plan.size), plan.fronts, plan.target, plan.later, plan.order,
    )  # fmt: skip


@dataclass(frozen=True)
class Attempt:
    """How far one call went."""

    #: Where it ended [m]; shape (n, 3).
    place: Array
    #: Largest force left over the largest force at work.
    residual: float
    #: Node of the force left.
    worst: int
    #: Solves.
    steps: int
    #: Whether the tolerance was reached.
    converged: bool


class Relaxation:
    """The equations of a network at rest.

    Parameters
    ----------
    network : Network
        The network.
    flow : Flow
        Steady current.
    time : float
        At which the flow is taken [s].
    """

    def __init__(self, network: Network, flow: Flow, time: float) -> None:
        self.network, self.flow = network, flow
        self.time = 1e300 if math.isinf(time) else time
        self.arrays = arrays = kernel_arrays(network)
        self.system, self.bed = kernel_system(arrays), bed_at_rest(network)
        self.parts = network_parts(network)
        self.plan = plan_of(network, arrays, self.parts)
        count, bars = len(network.nodes), len(network.bars)
        self.free = np.ascontiguousarray(arrays.nodes[9:12].T)
        self.fluid = np.array([network.water.density, network.water.gravity, 0.0])
        # loads alone: bars and bed without stiffness
        nodes, self._bars = arrays.nodes.copy(), arrays.bars.copy()
        nodes[5], self._bars[1] = 0.0, 0.0
        self._loads = (nodes, self._bars, *self.system[2:4], np.full(bars, -1), *self.system[5:])
        self._no_bed = np.zeros(4)
        self.still = np.zeros((count, 3))
        self.mass, self.tension = np.zeros((count, 6)), np.zeros(bars)
        self._bar_law, self._node_law = np.zeros((3, bars)), np.zeros((4, count))
        self._node_block, self._bar_block = np.zeros((count, 3, 3)), np.zeros((bars, 2, 3, 3))
        self.numbers = np.zeros(self.plan.size)
        self.steady = flow.current is None
        self.water = np.ascontiguousarray(flow.at(self.time, network.nodes.position.T))
        self.share = self.factor = 1.0
        self.length = arrays.bar("length")
        self.typical = mean_size(network)

    @property
    def own_weight(self) -> float:
        """The largest weight or buoyancy of a node [N]."""
        water = self.network.water
        return float(np.max(self.arrays.node("weight") + water.density * water.gravity * self.arrays.node("volume")))

    def raise_current(self, factor: float) -> None:
        """Use a part of the current."""
        self.factor = factor
        self._take_water(self.network.nodes.position, True)

    def _take_water(self, place: Array, anew: bool = False) -> None:
        if anew or not self.steady:
            self.water = np.ascontiguousarray(self.flow.at(self.time, place.T))
            self.water[:6] *= self.factor

    def forces(self, place: Array) -> Array:
        """Return the forces left by the true laws on what is free, shape (n, 3); writes :attr:`tension`."""
        self._take_water(place)
        force = np.empty_like(place)
        self.fluid[2] = 0.0
        force_kernel.forces(
            place, self.still, self.water, self.system, self.fluid, self.bed, force, self.tension, self.mass
        )  # fmt: skip
        for part in self.parts:
            part.add_forces(place, self.still, self.water, 1.0, force)
        return force * self.free

    def _loads_at(self, place: Array, radius: float) -> Array:
        """Return all forces but those of bars and bed; bars cross the surface at least ``radius`` thick."""
        self._take_water(place)
        self._bars[10] = np.maximum(self.arrays.bars[10], radius)
        force, unused = np.empty_like(place), self._bar_law[0]
        self.fluid[2] = 0.0
        force_kernel.forces(
            place, self.still, self.water, self._loads, self.fluid, self._no_bed, force, unused, self.mass
        )
        for part in self.parts:
            part.add_forces(place, self.still, self.water, self.share, force)
        return force

    def _solve(self, place: Array, force: Array, by_mass: float, bold: bool) -> tuple[Array | None, float]:
        """Return the step and the work of ``force`` along it; none where the matrix is not positive (unless bold)."""
        for exact in (True, False):
            force_kernel.blocks(
                place, self.still, self.water, self._loads, self.fluid, self.bed, self.mass, self._bar_law,
                self._node_law, by_mass, 0.0, 1.0, exact, self._node_block, self._bar_block,
            )  # fmt: skip
            plan = self.plan
            front_kernel.to_fronts(
                self._node_block, self._bar_block, self.system, 1.0, plan.own, plan.pairs[0], plan.pairs[1],
                self.numbers,
            )  # fmt: skip
            for part, pairs in zip(self.parts, plan.pairs[2:], strict=True):
                blocks = part.blocks(place, self.still, self.water, self.share)
                front_kernel.add_elements(blocks, part.members, pairs, self.arrays.nodes[9:12], 1.0, self.numbers)
            if not front_kernel.factor_fronts(self.numbers, plan.fronts, plan.target, not bold):
                continue
            step = force.copy()
            front_kernel.solve_fronts(self.numbers, plan.fronts, plan.later, plan.order, step)
            work = float(np.sum(step * force))
            if math.isfinite(work) and (work > 0.0 or bold):
                return step, work
        return None, 0.0

    def _least_scale(self, place: Array) -> float:
        """Return the largest weight or load of a node [N]; the stress of a bad first guess is none."""
        share, self.share = self.share, 1e-12
        loads = self._loads_at(place, 0.0) * self.free
        self.share = share
        return max(self.own_weight, float(np.abs(loads).max()), 1e-300)

    def look(self, place: Array) -> Attempt:
        """Return a place as it is, with the force left there."""
        least, force = self._least_scale(place), self.forces(place)
        pulls = [float(np.abs(self.tension).max(initial=0.0)), *(part.pull for part in self.parts)]
        return Attempt(place, *self._residual(force, max(least, *pulls)), 0, False)

    def _first_pulls(self, place: Array, load: float, soft: float) -> tuple[Array, Array]:
        """Return tensions and pushes to start with: those of the laws, no more than all loads together."""
        self.fluid[2] = 0.0
        law, node_law = self._bar_law, self._node_law
        only = self.arrays.bar("least_tension") == 0.0
        start, end = place[self.arrays.start], place[self.arrays.end]
        size = np.linalg.norm(end - start, axis=1)
        force_kernel.laws(place, self.still, self.system, self.fluid, self.bed, 0.0, 1.0, law, node_law)
        pull = np.where(law[0] > 0.0, law[0], self.arrays.bar("spring") * (size - self.length))
        pull = np.clip(pull, -load, load)
        bed = self.network.bed
        depth = np.zeros(len(place)) if bed is None else bed.contact_at(place)[:, 0]
        push = np.clip(self.arrays.node("bed_stiffness") * depth, -load, load)
        rounded = 0.5 * (pull + np.sqrt(pull**2 + soft**2))
        return np.where(only, rounded, pull), 0.5 * (push + np.sqrt(push**2 + soft**2))

    def attempt(
        self, place: Array, *, turn: float, most: int, tolerance: float, bold: bool = False, soft: float = 0.0
    ) -> Attempt:
        """Go from ``place`` towards rest.

        Parameters
        ----------
        place : ndarray, shape (n, 3)
            Start [m].
        turn : float
            How far a bar may turn in one step [rad]: large is quick, small is safe.
        most : int
            Solves, at most.
        tolerance : float
            Force left over the largest force at work.
        bold : bool
            Whether to go where the matrix is not positive: drag may make it so about a stable rest.
        soft : float
            First rounding of what only pulls or pushes, over the largest load; 0.3 when left out.
        """
        x = place.copy()
        start, end = self.arrays.start, self.arrays.end
        # rounding of a coordinate times the stiffest bar or sheet, not that of what went astray
        stiffest = max([float(self.arrays.greatest_spring.max(initial=0.0)), *(p.stiffness for p in self.parts)])
        noise = 16.0 * np.finfo(np.float64).eps * stiffest * float(np.max(np.abs(self.network.nodes.position)))
        force = self._loads_at(x, 0.0) * self.free
        sizes = np.linalg.norm(force, axis=1)
        load, top = float(sizes.sum()), max(float(sizes.max()), 1e-300)
        soft, radius = (soft or 0.3) * top, 0.2 * self.typical if soft == 0.0 else 0.0
        pace = math.sqrt(self.typical / max(self.network.water.gravity, 1e-3))
        pulls, pushes = self._first_pulls(x, load, soft)
        own, before, taken = self._least_scale(x), float(np.abs(force).max()), 0
        scale = own
        while taken < most:
            taken += 1
            force = self._loads_at(x, radius)
            equilibrium_kernel.mixed_laws(
                x, self.system, self.bed, soft, pulls, pushes, self._bar_law, self._node_law, force
            )
            force *= self.free
            step, work = self._solve(x, force, 1.0 / pace**2, bold)
            if step is None:
                pace *= 0.3
                if pace < 1e-12 or not np.isfinite(force).all():
                    break
                continue
            big, part = float(np.abs(step).max()) / self.typical, 1.0
            if start.size:
                along = np.linalg.norm(step[end] - step[start], axis=1)
                size = np.maximum(np.linalg.norm(x[end] - x[start], axis=1), 0.3 * self.length)
                big = float(np.max(along / size))
            if big > turn:
                part = turn / big
            x, pulls, pushes, force, part = self._search(
                x, step, part, work, pulls, pushes, radius, big, 2.0 * before if bold else math.inf
            )
            left = float(np.abs(force).max())
            if not math.isfinite(left):
                break
            # what pulls there now, not before the step
            scale = max(own, float(np.abs(pulls).max(initial=0.0)), *(p.pull for p in self.parts))
            enough = max(tolerance * scale, noise)
            ratio = before / max(left, 1e-300)
            if part < 1.0:
                pace *= max(0.2, math.sqrt(part))
            elif ratio >= 1.0:
                pace = min(1e8, pace * (min(10.0, 1.5 * ratio) if big < 0.5 * turn else 1.0))
            else:
                pace *= max(0.2, ratio)
            before = left
            if part == 1.0:
                soft = max(min(soft, max(0.1 * soft, 0.3 * left)), 0.05 * enough)
                radius = 0.0 if radius < 1e-6 * self.typical else 0.3 * radius
            if self.share < 1.0 and left <= 1e-3 * scale:
                break
            if left <= enough and radius == 0.0:
                true = self.forces(x)
                if float(np.abs(true).max()) <= enough:
                    return Attempt(x, *self._residual(true, scale), taken, True)
        return Attempt(x, *self._residual(self.forces(x), scale), taken, False)

    def _search(
        self,
        x: Array,
        step: Array,
        part: float,
        work: float,
        pulls: Array,
        pushes: Array,
        radius: float,
        big: float,
        most: float,
    ) -> tuple[Array, Array, Array, Array, float]:
        """Take a part of the step that does not overshoot.

        The forces at its end must not drive it back or, where ``most`` is finite, must stay below it.
        """
        for _ in range(6):
            new, new_pulls, new_pushes = np.empty_like(x), np.empty_like(pulls), pushes.copy()
            force = self._loads_at(x + part * step, radius)
            equilibrium_kernel.mixed_step(
                x, step, part, self.system, self.bed, self._bar_law, self._node_law, pulls, pushes, new, new_pulls,
                new_pushes, force,
            )  # fmt: skip
            force *= self.free
            if big < _SMALL_TURN:
                break
            if math.isfinite(most):
                if float(np.abs(force).max()) <= most:
                    break
                part *= 0.5
                continue
            back = float(np.sum(step * force))
            if back >= -0.5 * work:
                break
            part = max(0.1 * part, min(0.5 * part, part * work / (work - back))) if math.isfinite(back) else 0.1 * part
        return new, new_pulls, new_pushes, force, part

    def _residual(self, force: Array, scale: float) -> tuple[float, int]:
        """Return the largest force left over ``scale`` [N] and its node."""
        sizes = np.abs(force).max(axis=1)
        return float(sizes.max()) / scale, int(np.argmax(sizes))
