"""A planar floating body (sway, heave, roll with the memory of the water) that carries points of a network.

The step is that of :mod:`moyai.floating.time`, to the letter: the lines come from outside instead of from a table.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.compiled import with_pointers
from moyai.core.errors import InputError
from moyai.coupled import planar_kernel as step_kernel
from moyai.flexible.flow import Flow
from moyai.floating.forcing import Forcing
from moyai.floating.kernel import run_state_space
from moyai.floating.memory import StateSpaceMemory
from moyai.floating.time import CumminsModel, exponential_weights, packed_lines
from moyai.sea.water import Water

#: Places of the force's table in its shortest period; a cubic between them keeps 1e-7.
SAMPLES_PER_PERIOD = 160


@dataclass(frozen=True, eq=False)
class PlanarBody:
    """A floating body in the modes sway, heave, roll of [eq:floating-cummins] that carries points of a network.

    Raises
    ------
    InputError
        For a model of other modes, or with a memory that is not in states.

    Examples
    --------
    A unit in calm water that a taut rope pulls towards its anchor:

    >>> import numpy as np
    >>> from moyai.coupled import PlanarBody, simulate_coupled
    >>> from moyai.flexible import BarType, NetworkBuilder
    >>> from moyai.floating import CumminsModel, RegularForcing, StateSpaceMemory
    >>> from moyai.sea import Water
    >>> inertia, stiffness, damping = (np.diag(row) for row in ([3e4, 4e4, 5e4], [5e3, 2e5, 2e5], [2e4, 8e4, 1e5]))
    >>> model = CumminsModel(inertia, stiffness, damping, StateSpaceMemory.none(3))
    >>> calm = RegularForcing(1.0, 0.0, np.zeros(3, complex), np.zeros(3), np.zeros(3))
    >>> unit = PlanarBody("unit", model, calm, duration=10.0, points={"eye": (2.0, 0.0, -1.0)})
    >>> builder = NetworkBuilder(Water(depth=10.0, density=1025.0, gravity=9.81))
    >>> builder.fixed("anchor", (6.0, 0.0, -10.0))
    >>> builder.driven("eye", unit.points_at_start["eye"])
    >>> rope = BarType("rope", mass_per_length=1.0, axial_stiffness=1e5, diameter=0.03)
    >>> builder.line("line", "anchor", "eye", rope, length=9.8, segments=4)
    >>> run = simulate_coupled(builder.build(), {"unit": unit}, duration=10.0, output_step=0.1)
    >>> round(float(run.bodies["unit"].position[-1, 0]), 2)              # centre of gravity from its rest [m]
    0.03
    """

    name: str
    #: Its memory as states; nonlinear lines of its own act next to the network, at rest at every instant.
    model: CumminsModel
    #: Waves, drift, steady loads.
    forcing: Forcing
    #: How long the forcing is needed [s].
    duration: float
    #: Carried points from the centre of gravity at rest: x, y, z [m]; shape (3,).
    points: Mapping[str, ArrayLike]
    #: How many identical lines one point stands for (1 when left out).
    copies: Mapping[str, int] = field(default_factory=dict)
    #: Centre of gravity at rest in site axes [m]; shape (3,).
    centre_at_rest: ArrayLike = (0.0, 0.0, 0.0)
    #: Pull of the network at rest that weight and buoyancy balance (F_x, F_z, M_y), copies included [N, N, N m]
    #: [eq:coupled-rest]; shape (3,).
    reaction_at_rest: ArrayLike = (0.0, 0.0, 0.0)
    #: Displacement at the start in sway, heave [m] and roll [rad], relative to rest; shape (3,).
    initial_position: ArrayLike = (0.0, 0.0, 0.0)
    #: Velocity at the start in the same modes [m/s, m/s, rad/s]; shape (3,).
    initial_velocity: ArrayLike = (0.0, 0.0, 0.0)
    #: States of the memory at the start, one per pole; empty when left out.
    initial_memory: ArrayLike | None = None

    def __post_init__(self) -> None:
        if len(self.model.modes) != 3:
            raise InputError(
                f"body {self.name!r} has {len(self.model.modes)} modes",
                parameter=f"bodies.{self.name}",
                allowed="three",
            )
        if not isinstance(self.model.memory, StateSpaceMemory):
            raise InputError(
                "lines in motion need the memory of the water as states, not as a convolution",
                parameter="model.memory",
                allowed="state_space",
                remedy="give memory: state_space, or leave the lines quasi-static",
            )

    @property
    def points_at_start(self) -> dict[str, Array]:
        """Where the carried points stand at the start, in site axes [m]."""
        place, _ = _places(
            np.asarray(self.initial_position, dtype=float),
            np.zeros(3),
            np.array([np.asarray(place, dtype=float) for place in self.points.values()]).reshape(-1, 3),
            np.asarray(self.centre_at_rest, dtype=float),
        )
        return dict(zip(self.points, place, strict=True))

    def carrier(self, water: Water, flow: Flow | None = None, time: float = 0.0) -> PlanarCarrier:
        """Return the body in motion; water and flow are in its model already.

        Parameters
        ----------
        water : Water
            Plays no part.
        flow : Flow, optional
            Plays no part.
        time : float
            When the motion begins [s].
        """
        return PlanarCarrier(self, time)


def _places(q: Array, v: Array, arms: Array, centre: Array) -> tuple[Array, Array]:
    """Return place and velocity of points at a planar motion."""
    place, speed = np.empty((2, len(arms), 3))
    step_kernel.place_points(q, v, arms, centre, place, speed)
    return place, speed


class PlanarCarrier:
    """A planar body in motion; follows :class:`moyai.core.attachment.PointCarrier`."""

    def __init__(self, body: PlanarBody, time: float = 0.0) -> None:
        from scipy.interpolate import CubicSpline

        self.body, self.time, self.points = body, time, tuple(body.points)
        self.arms = np.array([np.asarray(place, dtype=float) for place in body.points.values()]).reshape(-1, 3)
        self.copies = np.array([float(body.copies.get(name, 1)) for name in self.points])
        self.rest = np.asarray(body.centre_at_rest, dtype=float)
        self.q = np.array(body.initial_position, dtype=float)
        self.v = np.array(body.initial_velocity, dtype=float)
        memory = body.model.memory
        assert isinstance(memory, StateSpaceMemory)
        self._memory, self.z = memory, np.zeros(len(memory.poles), np.complex128)
        if body.initial_memory is not None:
            self.z = np.array(body.initial_memory, dtype=np.complex128)
        shortest = body.forcing.shortest_period
        grid = body.duration / 64.0
        if np.isfinite(shortest):
            grid = min(grid, shortest / SAMPLES_PER_PERIOD)
        grid = body.forcing.fitted_step(grid)
        count = int(np.ceil(body.duration / grid)) + 3
        force, elevation = body.forcing.sample(grid, count)
        at = grid * np.arange(count)
        self._force, self._surface = CubicSpline(at, force), CubicSpline(at, elevation)
        model = body.model
        constants = (
            np.ascontiguousarray(np.linalg.inv(model.inertia)),
            np.ascontiguousarray(np.asarray(model.linear_damping, dtype=float) + memory.dashpot),
            np.ascontiguousarray(model.stiffness, dtype=float),
            np.zeros((0, 3)) if model.quadratic is None else np.ascontiguousarray(model.quadratic.directions),
            np.zeros(0) if model.quadratic is None else np.ascontiguousarray(model.quadratic.coefficients),
        )
        lines, own, _ = packed_lines(model.mooring, 3)
        no_rows = np.zeros((0, 3))
        nothing = (no_rows, no_rows, no_rows, np.zeros((0, 0)), np.zeros(3), np.zeros(lines[0].shape[0]))
        sides = (np.ascontiguousarray(memory.inputs), np.ascontiguousarray(memory.outputs))
        self._system = (constants, lines, own + np.asarray(body.reaction_at_rest, dtype=float)), (*sides, nothing)
        self._weights: dict[float, tuple[NDArray[np.complex128], ...]] = {}
        self._tried = (self.q.copy(), self.v.copy(), self.z.copy(), time)
        self._guess: tuple[float, Array] | None = None
        self._step: Callable[..., Any] | None = None
        self._outside: tuple[tuple[float, float], Array] = ((np.nan, np.nan), np.zeros((3, 3)))
        #: Rate of the velocity over the last step
        self.rate = np.zeros(3)

    @property
    def carried(self) -> tuple[Array, Array, Array]:
        """Carried points from the centre of gravity, how many lines each stands for, the centre at rest."""
        return self.arms, self.copies, self.rest

    def system(self, step: float) -> tuple[Any, ...]:
        """Return what the kernels take of the body for a step [s]; see :mod:`moyai.coupled.planar_kernel`."""
        key = round(step, 14)
        if key not in self._weights:
            self._weights[key] = exponential_weights(self._memory.poles, step)
        return *self._system[0], self._weights[key], *self._system[1]

    def force_at(self, time: Array) -> Array:
        """Return the force from outside and the motion of the water at times (k,)."""
        return np.ascontiguousarray(self._force(time))

    @property
    def body_mass(self) -> float:
        """Mass of the body with its added mass in sway [kg]."""
        return float(self.body.model.inertia[0, 0])

    @property
    def centre(self) -> Array:
        """Centre of gravity in site axes [m]."""
        return np.asarray(self.rest + np.array([self.q[0], 0.0, self.q[1]]))

    @property
    def position(self) -> Array:
        """The same: the origin of the body is its centre of gravity."""
        return self.centre

    @property
    def rotation(self) -> Array:
        """Rotation matrix, body to site."""
        c, s = np.cos(self.q[2]), np.sin(self.q[2])
        return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])

    @property
    def velocity(self) -> Array:
        """Velocity and spin in site axes [m/s, rad/s]."""
        return np.array([self.v[0], 0.0, self.v[1], 0.0, self.v[2], 0.0])

    @property
    def kinetic_energy(self) -> float:
        """With added mass at infinite frequency [J]."""
        return float(0.5 * self.v @ self.body.model.inertia @ self.v)

    def elevation(self, time: Array) -> Array:
        """Return the incident surface at the body [m]."""
        return np.asarray(self._surface(time))

    def place_and_velocity(self) -> tuple[Array, Array]:
        """Return place [m] and velocity [m/s] of the carried points, (points, 3), in site axes."""
        return _places(self.q, self.v, self.arms, self.rest)

    def rows(self, q: Array, v: Array) -> tuple[Array, Array, Array, Array, Array]:
        """Return what is kept of motions (k, 3): position, rotation, velocity, points from the centre, energy."""
        rows = len(q)
        c, s, one, none = np.cos(q[:, 2]), np.sin(q[:, 2]), np.ones(rows), np.zeros(rows)
        rotation = np.stack([c, none, s, none, one, none, -s, none, c], axis=1).reshape(rows, 3, 3)
        velocity = np.stack([v[:, 0], none, v[:, 1], none, v[:, 2], none], axis=1)
        position = self.rest + np.stack([q[:, 0], none, q[:, 1]], axis=1)
        energy = 0.5 * np.einsum("ki,ij,kj->k", v, self.body.model.inertia, v)
        return position, rotation, velocity, np.einsum("kij,pj->kpi", rotation, self.arms), energy

    def try_step(self, end: float, reaction: Array) -> tuple[Array, Array]:
        """Move to ``end`` [s] under mean and tilt of the forces on the points; return place and velocity there."""
        h = end - self.time
        if self._guess is None or self._guess[0] != end:
            first = np.stack([self.q + h * self.v + 0.5 * h * h * self.rate, self.v + h * self.rate])
            self._guess = (end, first)
        if self._outside[0] != (self.time, end):
            self._outside = ((self.time, end), self.force_at(np.array([self.time, self.time + 0.5 * h, end])))
        tried = (np.empty(3), np.empty(3), np.empty_like(self.z))
        place, speed = np.empty((2, len(self.arms), 3))
        force, body, limit = self._outside[1], self.system(h), np.full(3, 1e30)
        arguments = (
            self.q, self.v, self.z, self._guess[1], h, np.ascontiguousarray(reaction), force, self.carried, body,
            tried, place, speed, limit,
        )  # fmt: skip
        if self._step is None:
            constants, lines, rest, weights, inputs, outputs, saved = body
            stepped = (*tried, 0, 1, h, force, constants, lines, rest, weights, inputs, outputs, limit,
                       step_kernel.NEVER, saved)  # fmt: skip
            self._step = with_pointers(step_kernel.try_body, ((run_state_space, stepped),), arguments)
        self._step(*arguments)
        self._tried = (*tried, end)
        return place, speed

    def accept(self) -> None:
        """Keep the last tried step."""
        h = self._tried[3] - self.time
        if h > 0.0:
            self.rate = (self._tried[1] - self.v) / h
        self.q, self.v, self.z, self.time = self._tried
