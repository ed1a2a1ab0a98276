"""A rigid body in six degrees of freedom: what it is made of, how it moves under waves and the pull of a network."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.coupled import rigid_kernel as kernel
from moyai.coupled.hulls import Lumps, no_lumps
from moyai.coupled.wave_loads import WaveLoads
from moyai.flexible.flow import Flow
from moyai.floating.time import exponential_weights
from moyai.mooring.rotations import rotation_from_vector, rotation_matrix
from moyai.sea.water import Water


def _vector(value: ArrayLike, size: int, path: str) -> Array:
    given = np.array(value, dtype=np.float64)
    if given.shape != (size,) or not np.isfinite(given).all():
        raise InputError(f"{path} is {value!r}", parameter=path, allowed=f"{size} finite numbers")
    given.setflags(write=False)
    return given


def _matrix(value: ArrayLike | None, size: int, path: str, *, positive: bool) -> Array:
    given = np.zeros((size, size)) if value is None else np.array(value, dtype=np.float64)
    if given.shape == (size,):
        given = np.diag(given)
    if given.shape != (size, size) or not np.isfinite(given).all():
        raise InputError(
            f"{path} has shape {given.shape} or is not finite", parameter=path, allowed=f"({size}, {size})"
        )
    if positive:
        scale = float(np.abs(given).max(initial=0.0))
        if float(np.abs(given - given.T).max(initial=0.0)) > 1e-6 * scale:
            raise InputError(f"{path} is not symmetric", parameter=path, allowed="a symmetric matrix")
        if float(np.linalg.eigvalsh(0.5 * (given + given.T))[0]) < -1e-9 * scale:
            raise InputError(
                f"{path} has a negative eigenvalue", parameter=path, allowed="0 or more in every direction"
            )
    given.setflags(write=False)
    return given


@checks_words
@dataclass(frozen=True, eq=False)
class RigidBody:
    """A rigid body that hangs in a network or floats by itself [eq:coupled-newton-euler].

    Body axes are fixed in the body; their origin is any point of it. Rotations are finite and exact.

    Raises
    ------
    InputError
        For values out of range, each with its name.

    Examples
    --------
    >>> from moyai.coupled import RigidBody
    >>> buoy = RigidBody(
    ...     "buoy", mass=500.0, inertia=(50.0, 50.0, 40.0), position=(0.0, 0.0, -2.0), points={"eye": (0.0, 0.0, -0.5)}
    ... )
    >>> buoy.points_at_start["eye"].tolist()                             # where a line is made fast [m]
    [0.0, 0.0, -2.5]
    """

    #: For messages and results.
    name: str
    #: [kg].
    mass: float
    #: About the centre of gravity in body axes [kg m2]; three numbers stand for a diagonal; shape (3, 3) or (3,).
    inertia: ArrayLike
    #: In body axes [m]; shape (3,).
    centre_of_gravity: ArrayLike = field(default_factory=lambda: np.zeros(3))
    #: Of the origin of the body axes at the start, in site axes [m]; shape (3,).
    position: ArrayLike = field(default_factory=lambda: np.zeros(3))
    #: Roll, pitch, yaw at the start [rad]: R = Rz(yaw) Ry(pitch) Rx(roll); shape (3,).
    rotation: ArrayLike = field(default_factory=lambda: np.zeros(3))
    #: Points of the network that the body carries, in body axes [m]; shape (3,).
    points: Mapping[str, ArrayLike] = field(default_factory=dict)
    #: What the water meets: buoyancy, drag, inertia part by part (see :mod:`moyai.coupled.hulls`).
    lumps: Lumps | None = None
    #: About the origin in body axes [kg, kg m, kg m2]; answers to the motion relative to the water at the centre of
    #: gravity, with its turning [eq:coupled-added-mass]; shape (6, 6) or (6,).
    added_mass: ArrayLike | None = None
    #: About the centre of gravity in body axes, on the velocity through the site [N s/m ... N m s]. Shape (6, 6) or
    #: (6,).
    linear_damping: ArrayLike | None = None
    #: About the centre of gravity, axis by axis: force b u|u| of the velocity relative to the water [N s2/m2, N m s2];
    #: shape (6,).
    quadratic_damping: ArrayLike = field(default_factory=lambda: np.zeros(6))
    #: Linear restoring about the centre of gravity at the start pose, in axes that turn with the yaw
    #: [eq:coupled-restoring] (springs of a test rig); that of the water comes with ``loads`` or ``lumps``; shape (6, 6)
    #: or (6,).
    stiffness: ArrayLike | None = None
    #: Coefficients of a three-dimensional program: excitation, radiation with memory, linear hydrostatics.
    loads: WaveLoads | None = None
    #: Constant force and moment about the centre of gravity in site axes [N, N m]; shape (6,).
    force: ArrayLike = field(default_factory=lambda: np.zeros(6))
    #: Translations along site axes and rotations about body axes that may change.
    free: tuple[bool, ...] = (True,) * 6
    #: Place of the origin [m] and yaw [rad] that ``stiffness`` counts from; those of the start when left out; shape
    #: (3,).
    equilibrium: tuple[ArrayLike, float] | None = None
    #: Place in body axes that stays where it is at the start: the body only turns about it. Damping, stiffness and the
    #: moments of the results then refer to this place, not to the centre of gravity. Shape (3,).
    pin: ArrayLike | None = None

    def __post_init__(self) -> None:
        path = f"bodies.{self.name}"
        if not (math.isfinite(self.mass) and self.mass > 0.0):
            raise InputError(
                f"mass of body {self.name!r} is {self.mass:g} kg", parameter=f"{path}.mass", allowed="greater than 0"
            )
        for name, size in (("centre_of_gravity", 3), ("position", 3), ("rotation", 3), ("force", 6)):
            object.__setattr__(self, name, _vector(getattr(self, name), size, f"{path}.{name}"))
        quadratic = _vector(self.quadratic_damping, 6, f"{path}.quadratic_damping")
        if np.any(quadratic < 0.0):
            raise InputError(
                f"quadratic damping of body {self.name!r} is {quadratic.min():g}",
                parameter=f"{path}.quadratic_damping",
                allowed="0 or more",
            )
        object.__setattr__(self, "quadratic_damping", quadratic)
        inertia = _matrix(self.inertia, 3, f"{path}.inertia", positive=True)
        moments = np.linalg.eigvalsh(inertia)
        if not moments[0] > 0.0 or moments[2] > (moments[0] + moments[1]) * (1.0 + 1e-9):
            raise InputError(
                f"principal moments of inertia of body {self.name!r} are "
                f"{', '.join(f'{m:.4g}' for m in moments)} kg m2",
                parameter=f"{path}.inertia",
                allowed="positive, none above the sum of the other two",
            )
        object.__setattr__(self, "inertia", inertia)
        for name in ("added_mass", "stiffness"):
            object.__setattr__(self, name, _matrix(getattr(self, name), 6, f"{path}.{name}", positive=True))
        object.__setattr__(
            self, "linear_damping", _matrix(self.linear_damping, 6, f"{path}.linear_damping", positive=False)
        )
        if self.pin is not None:
            object.__setattr__(self, "pin", _vector(self.pin, 3, f"{path}.pin"))
        places = {name: _vector(place, 3, f"{path}.points.{name}") for name, place in self.points.items()}
        object.__setattr__(self, "points", places)
        if len(self.free) != 6:
            raise InputError(f"{len(self.free)} degrees of freedom", parameter=f"{path}.free", allowed="six")
        if self.loads is not None and self.lumps is not None and np.any(self.lumps.volume * self.lumps.length > 0.0):
            raise InputError(
                f"body {self.name!r} has both hydrodynamic coefficients and a hull: its buoyancy would count twice",
                parameter=f"{path}.lumps",
                remedy="leave one of them out; lumps without volume may have drag",
            )

    @property
    def pivot(self) -> Array:
        """Place in body axes whose motion is reported [m]: the pin, or the centre of gravity without one, (3,)."""
        return np.asarray(self.centre_of_gravity if self.pin is None else self.pin, dtype=float)

    @property
    def equilibrium_pose(self) -> tuple[Array, float]:
        """Place (3,) of the origin [m] and yaw [rad] that the stiffness counts from, in site axes."""
        if self.equilibrium is None:
            return np.asarray(self.position, dtype=float), float(np.asarray(self.rotation)[2])
        return np.asarray(self.equilibrium[0], dtype=float), float(self.equilibrium[1])

    @property
    def start_rotation(self) -> Array:
        """Rotation matrix at the start, body to site, (3, 3) [-]."""
        return rotation_matrix(self.rotation)

    @property
    def points_at_start(self) -> dict[str, Array]:
        """Where the carried points stand at the start, in site axes [m]."""
        turn = self.start_rotation
        return {name: self.position + turn @ np.asarray(place) for name, place in self.points.items()}

    def carrier(self, water: Water, flow: Flow | None = None, time: float = 0.0) -> RigidCarrier:
        """Return the body in motion from its start at rest.

        Parameters
        ----------
        water : Water
            Around the body.
        flow : Flow, optional
            Current and waves; calm water when left out.
        time : float
            When the motion begins [s].
        """
        return RigidCarrier(self, water, flow or Flow(), time)


def about(matrix: ArrayLike, offset: ArrayLike) -> Array:
    """Return a 6x6 matrix about a point that lies ``offset`` from the old one."""
    x, y, z = np.asarray(offset, dtype=float)
    # the old point moves with v - offset x w
    motion = np.eye(6)
    motion[:3, 3:] = [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
    return np.asarray(motion.T @ np.asarray(matrix, dtype=float) @ motion)


def quaternion_of(rotation: ArrayLike) -> Array:
    """Return the unit quaternion (scalar first) of a rotation matrix."""
    r = np.asarray(rotation, dtype=float)
    squares = np.array(
        [
            1.0 + r[0, 0] + r[1, 1] + r[2, 2],
            1.0 + r[0, 0] - r[1, 1] - r[2, 2],
            1.0 - r[0, 0] + r[1, 1] - r[2, 2],
            1.0 - r[0, 0] - r[1, 1] + r[2, 2],
        ]
    )
    largest = int(np.argmax(squares))
    s = 2.0 * math.sqrt(squares[largest])
    rows = (
        (0.25 * s, (r[2, 1] - r[1, 2]) / s, (r[0, 2] - r[2, 0]) / s, (r[1, 0] - r[0, 1]) / s),
        ((r[2, 1] - r[1, 2]) / s, 0.25 * s, (r[0, 1] + r[1, 0]) / s, (r[0, 2] + r[2, 0]) / s),
        ((r[0, 2] - r[2, 0]) / s, (r[0, 1] + r[1, 0]) / s, 0.25 * s, (r[1, 2] + r[2, 1]) / s),
        ((r[1, 0] - r[0, 1]) / s, (r[0, 2] + r[2, 0]) / s, (r[1, 2] + r[2, 1]) / s, 0.25 * s),
    )
    return np.array(rows[largest])


class RigidCarrier:
    """A rigid body in motion; follows :class:`moyai.core.attachment.PointCarrier`.

    Parameters
    ----------
    body : RigidBody
    water : Water
    flow : Flow
        Current and waves around it.
    time : float
        Start [s].
    """

    def __init__(self, body: RigidBody, water: Water, flow: Flow, time: float = 0.0) -> None:
        self.body, self.water, self.flow, self.time = body, water, flow, time
        self.points, self.copies = tuple(body.points), np.ones(len(body.points))
        centre = body.pivot
        self.arms = np.array([np.asarray(body.points[name]) - centre for name in self.points]).reshape(-1, 3)
        self.lumps = (body.lumps or no_lumps()).arrays(centre)
        self.state, self.states_of_memory = np.zeros(13), np.zeros(0, np.complex128)
        self.place_body(np.asarray(body.position), body.start_rotation)
        loads = body.loads
        rigid = np.zeros((6, 6))
        rigid[:3, :3], rigid[3:, 3:] = body.mass * np.eye(3), body.inertia
        free = np.array(body.free, dtype=np.float64)
        weight = np.array([0.0, 0.0, -body.mass * water.gravity])
        # the weight of a pinned body pulls at an arm of its own
        self._own_arms, self._own_pulls = np.zeros((0, 3)), np.zeros((0, 3))
        if body.pin is not None:
            arm = np.asarray(body.centre_of_gravity) - centre
            rigid[3:, 3:] += body.mass * (arm @ arm * np.eye(3) - np.outer(arm, arm))
            self._own_arms, self._own_pulls = arm[None], weight[None]
            free[:3] = 0.0
        radiated, inputs, outputs = np.zeros((6, 6)), np.zeros((0, 6), np.complex128), np.zeros((6, 0), np.complex128)
        self.poles = np.zeros(0, np.complex128)
        place_there, equilibrium_yaw = body.equilibrium_pose
        upright = rotation_matrix((0.0, 0.0, equilibrium_yaw))
        rest = np.array([*(np.asarray(place_there) + upright @ centre), equilibrium_yaw])
        stiffness, linear = np.array(body.stiffness), np.array(body.linear_damping)
        constant = np.array(body.force)
        if body.pin is None:
            constant[:3] += weight
        self.excitation = None
        if loads is not None:
            found = loads.about(centre, np.asarray(body.position))
            radiated, self.poles = found.infinite_frequency_added_mass, found.memory.poles
            inputs, outputs = found.memory.inputs, found.memory.outputs
            linear = linear + found.memory.dashpot
            stiffness = stiffness + found.stiffness
            constant[2] += water.density * water.gravity * found.displaced_volume
            rest = np.array(
                [
                    *(found.equilibrium_position + rotation_matrix((0.0, 0.0, found.equilibrium_yaw)) @ centre),
                    found.equilibrium_yaw,
                ]
            )
            self.excitation = found.excitation(flow.waves)
            self.states_of_memory = np.zeros(self.poles.size, np.complex128)
        self._body = (
            rigid, about(np.asarray(body.added_mass), centre), np.ascontiguousarray(radiated), linear,
            np.array(body.quadratic_damping), stiffness, rest, constant, free,
        )  # fmt: skip
        self._memory = (np.ascontiguousarray(inputs), np.ascontiguousarray(outputs))
        self._fluid = np.array([water.density, water.gravity])
        self._weights: dict[float, tuple[ComplexArray, ...]] = {}
        self._tried = (self.state.copy(), self.states_of_memory.copy(), time)
        self._guess: tuple[float, Array] | None = None
        self.spent = np.zeros(6)

    # -- state ---------------------------------------------------------------------------------------------------------

    def place_body(self, position: ArrayLike, rotation: ArrayLike, velocity: ArrayLike = (0.0,) * 6) -> None:
        """Put the origin at ``position`` [m] with a rotation matrix; ``velocity`` of the centre of gravity and spin in
        site axes [m/s, rad/s]."""
        turn, speed = np.asarray(rotation, dtype=float), np.asarray(velocity, dtype=float)
        self.state[:3] = np.asarray(position, dtype=float) + turn @ self.body.pivot
        self.state[3:7] = quaternion_of(turn)
        self.state[7:10], self.state[10:13] = speed[:3], turn.T @ speed[3:]
        self._guess = None

    @property
    def rotation(self) -> Array:
        """Rotation matrix, body to site."""
        out = np.empty((3, 3))
        kernel.rotation_of(self.state[3:7], out)
        return out

    @property
    def position(self) -> Array:
        """Place of the origin of the body axes [m]."""
        return self.state[:3] - self.rotation @ self.body.pivot

    @property
    def velocity(self) -> Array:
        """Velocity of the centre of gravity and spin, site axes [m/s, rad/s]."""
        return np.concatenate([self.state[7:10], self.rotation @ self.state[10:13]])

    @property
    def free(self) -> Array:
        """One for what may move, 0 for what is held: along the axes of the site, about those of the body (6,)."""
        return np.asarray(self._body[8])

    @property
    def body_mass(self) -> float:
        """Mass of the body [kg]."""
        return self.body.mass

    @property
    def centre(self) -> Array:
        """Centre of gravity in site axes [m]."""
        return self.state[:3]

    @property
    def inertia(self) -> Array:
        """Mass and added mass (6, 6) about the centre of gravity, in site axes now; held components are heavy."""
        turn = np.zeros((6, 6))
        turn[:3, :3] = turn[3:, 3:] = self.rotation
        whole = self._body[0] + self._body[1] + self._body[2]
        held = np.where(self._body[8] > 0.0, 0.0, 1e9 * np.abs(np.diag(whole)))
        out = turn @ whole @ turn.T
        out[:3, :3] += np.diag(held[:3])
        out[3:, 3:] += self.rotation @ np.diag(held[3:]) @ self.rotation.T
        return np.asarray(out)

    @property
    def restoring(self) -> Array:
        """Restoring of water and springs (6, 6), for the choice of the step; that of a hull by differences."""
        out, calm = np.zeros((6, 6)), Flow()
        scale = 1e-4 * max(float(np.max(np.abs(self.lumps[0]), initial=0.0)), 1e-2)
        kept = self.state.copy()
        for axis in range(6):
            step = scale if axis < 3 else 1e-4
            ends = []
            for sign in (1.0, -1.0):
                self.displace(axis, sign * step)
                ends.append(self.imbalance(np.zeros_like(self.arms), self.time, calm))
                self.state[:] = kept
            out[:, axis] = -(ends[0] - ends[1]) / (2.0 * step)
        return out

    def displace(self, axis: int, amount: float) -> None:
        """Move the body along a site axis [m] or turn it about one through its centre of gravity [rad]."""
        if axis < 3:
            self.state[axis] += amount
        else:
            turn = rotation_from_vector(amount * np.eye(3)[axis - 3])
            self.state[3:7] = quaternion_of(turn @ self.rotation)

    @property
    def kinetic_energy(self) -> float:
        """Of the body with its added mass, without that of lumps [J]."""
        nu = np.empty(6)
        kernel.body_velocity(self.state, nu)
        return float(0.5 * nu @ (self._body[0] + self._body[1] + self._body[2]) @ nu)

    def place_and_velocity(self) -> tuple[Array, Array]:
        """Return place [m] and velocity [m/s] of the carried points, (points, 3), in site axes."""
        return self._points_of(self.state)

    def _points_of(self, state: Array) -> tuple[Array, Array]:
        place, velocity = np.empty_like(self.arms), np.empty_like(self.arms)
        kernel.points_of(state, self.arms, place, velocity)
        return place, velocity

    # -- loads of the water --------------------------------------------------------------------------------------------

    def _water_at(self, time: float, state: Array) -> Array:
        """Return the water at all lumps and at the centre of gravity (7, lumps + 1)."""
        arms = np.concatenate([self.lumps[0], np.zeros((1, 3))])
        place, _ = np.empty_like(arms), np.empty_like(arms)
        kernel.points_of(state, arms, place, _)
        return self.flow.at(time, np.ascontiguousarray(place.T))

    def _external(self, time: float, state: Array) -> Array:
        """Return the exciting force in site axes about the centre of gravity (6,)."""
        if self.excitation is None:
            return np.zeros(6)
        turn = np.empty((3, 3))
        kernel.rotation_of(state[3:7], turn)
        return self.excitation.force(time, state[:3], math.atan2(turn[1, 0], turn[0, 0]), self.flow.growth(time)[0])

    def surroundings(self, time: float, state: Array) -> tuple[Array, Array]:
        """Return water and exciting force at one instant."""
        return self._water_at(time, state), self._external(time, state)

    def _forecast(self, end: float) -> tuple[Array, Array]:
        """Return where the body is expected in the middle and at the end of the step."""
        start, h = self.state, end - self.time
        if self._guess is not None and self._guess[0] == end:
            last = self._guess[1]
            middle = 0.5 * (start + last)
            middle[:3] += 0.125 * h * (start[7:10] - last[7:10])
            return middle, last
        middle, last = start.copy(), start.copy()
        for out, time in ((middle, 0.5 * h), (last, h)):
            kernel._advance(start, start, self.spent, time, out)
            out[:3] += 0.5 * time**2 * self.spent[:3]
        return middle, last

    def try_step(self, end: float, reaction: Array) -> tuple[Array, Array]:
        """Move to ``end`` [s] under mean and tilt of the forces on the points; return place and velocity there."""
        h = end - self.time
        middle, last = self._forecast(end)
        water = np.stack(
            [
                self._water_at(time, at)
                for time, at in ((self.time, self.state), (self.time + 0.5 * h, middle), (end, last))
            ]
        )
        external = np.stack(
            [
                self._external(time, at)
                for time, at in ((self.time, self.state), (self.time + 0.5 * h, middle), (end, last))
            ]
        )
        key = round(h, 14)
        if key not in self._weights:
            self._weights[key] = exponential_weights(self.poles, h)
        new, states = np.empty(13), np.empty_like(self.states_of_memory)
        kernel.step(
            self.state, self.states_of_memory, h, self._body, self.lumps, water, self._fluid, external,
            *self._pulled(np.asarray(reaction, dtype=np.float64).reshape(2, -1, 3)), self._weights[key], *self._memory,
            new, states,
        )  # fmt: skip
        self._tried, self._guess = (new, states, end), (end, new.copy())
        return self._points_of(new)

    def _pulled(self, reaction: Array) -> tuple[Array, Array]:
        """Return arms and reaction (2, points, 3) with those of the body's own."""
        if not len(self._own_arms):
            return self.arms, np.ascontiguousarray(reaction)
        own = np.stack([self._own_pulls, np.zeros_like(self._own_pulls)])
        return np.concatenate([self.arms, self._own_arms]), np.concatenate([reaction, own], axis=1)

    def accept(self) -> None:
        """Keep the last tried step."""
        h = self._tried[2] - self.time
        if h > 0.0:
            self.spent[:3] = (self._tried[0][7:10] - self.state[7:10]) / h
            self.spent[3:] = (self._tried[0][10:13] - self.state[10:13]) / h
        self.state, self.states_of_memory, self.time = self._tried

    def imbalance(self, pulls: Array, time: float, calm: Flow) -> Array:
        """Return force and moment about the centre of gravity left at rest under forces on the points (6,), site axes.

        Held components are zero.
        """
        state = self.state.copy()
        state[7:] = 0.0
        arms = np.concatenate([self.lumps[0], np.zeros((1, 3))])
        place, _ = np.empty_like(arms), np.empty_like(arms)
        kernel.points_of(state, arms, place, _)
        water = calm.at(time, np.ascontiguousarray(place.T))
        water[3:7] = 0.0
        arms, reaction = self._pulled(np.stack([pulls, np.zeros_like(pulls)]))
        huge = 1e12
        heavy = (huge * np.eye(6), np.zeros((6, 6)), np.zeros((6, 6)), *self._body[3:])
        result = np.empty(6)
        lumps = (*self.lumps[:5], np.zeros_like(self.lumps[5]), self.lumps[6])
        kernel.acceleration(
            state, heavy, lumps, water, self._fluid, np.zeros(6), np.zeros(6), arms, reaction[0], result,
        )  # fmt: skip
        result[3:] = self.rotation @ result[3:]
        return huge * result
