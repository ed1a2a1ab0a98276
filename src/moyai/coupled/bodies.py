"""The kinds of body that hang in networks, and what is kept of their motion."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from moyai.core.arrays import Array
from moyai.core.attachment import PointCarrier
from moyai.core.errors import InputError
from moyai.core.options import check_word
from moyai.coupled.joint import Joint
from moyai.coupled.planar import PlanarBody, PlanarCarrier
from moyai.coupled.rigid import RigidBody, RigidCarrier
from moyai.flexible.flow import Flow
from moyai.flexible.network import Network
from moyai.flexible.result import State
from moyai.flexible.stepping import carried_nodes
from moyai.mooring.rotations import roll_pitch_yaw
from moyai.sea.water import Water

Body = RigidBody | PlanarBody

#: How far a point of the network may stand from where its body has it, over the extent of the network.
PLACE_TOLERANCE = 1e-6


@dataclass(frozen=True, eq=False)
class BodyHistory:
    """Motion of one body."""

    #: Of the origin of its axes in site axes [m]; shape (k, 3).
    position: Array
    #: Body to site; shape (k, 3, 3).
    rotation: Array
    #: Of the centre of gravity and spin, site axes [m/s, rad/s]; shape (k, 6).
    velocity: Array
    #: Mean force of the network over the last step, and its moment about the centre of gravity, site axes [N, N m];
    #: shape (k, 6).
    reaction: Array
    #: The same for every carried point [N]; shape (k, points, 3).
    point_force: Array
    #: Their names.
    points: tuple[str, ...]
    #: With added mass at infinite frequency, without that of lumps [J]; shape (k,).
    kinetic_energy: Array

    @property
    def point_force_at_rows(self) -> Array:
        """Force of the network on every carried point at the instants of the rows (k, points, 3) [N].

        The rows of ``point_force`` are means over the step that ends there, half a step late. A cubic through the
        impulses of four steps gives the value between the middle two [eq:coupled-instant]; near the ends a line.
        """
        mean = self.point_force
        out = mean.copy()
        if len(mean) > 2:
            out[1:-1] = 0.5 * (mean[1:-1] + mean[2:])
            out[-1] = 1.5 * mean[-1] - 0.5 * mean[-2]
        if len(mean) > 4:
            out[2:-2] = (7.0 * (mean[2:-2] + mean[3:-1]) - mean[1:-3] - mean[4:]) / 12.0
        return out

    @property
    def angles(self) -> Array:
        """Roll, pitch, yaw (k, 3) [rad]; yaw continues beyond a half turn."""
        found = roll_pitch_yaw(self.rotation)
        found[:, 2] = np.unwrap(found[:, 2])
        return found


@dataclass(frozen=True, eq=False)
class BodyState:
    """Where a rigid body is in its motion, for a run that continues."""

    #: Place of the centre of gravity [m], unit quaternion from body to site, velocity [m/s] in site axes, spin [rad/s]
    #: in body axes; shape (13,).
    motion: Array
    #: States of the radiation, none without coefficients; shape (poles,).
    memory: NDArray[np.complex128]

    @classmethod
    def of(cls, carrier: RigidCarrier) -> BodyState:
        """Return the state of a body in motion."""
        return cls(carrier.state.copy(), carrier.states_of_memory.copy())

    def carrier(self, body: RigidBody, water: Water, flow: Flow, time: float) -> RigidCarrier:
        """Return the body in motion from here.

        Raises
        ------
        InputError
            When the body has other coefficients than the one that was left in this state.
        """
        carrier = body.carrier(water, flow, time)
        if self.memory.shape != carrier.states_of_memory.shape:
            raise InputError(
                f"body {body.name!r} was left with {self.memory.size} states of radiation, its coefficients have "
                f"{carrier.states_of_memory.size}",
                parameter=f"bodies.{body.name}", allowed="the same coefficients",
            )  # fmt: skip
        carrier.state[:], carrier.states_of_memory[:] = self.motion, self.memory
        return carrier


class BodyLog:
    """Collects the rows of one body."""

    def __init__(self, body: Body, carrier: PointCarrier) -> None:
        self.body, self.carrier = body, carrier
        #: Stretches of rows, each an array a quantity
        self._kept: list[tuple[Array, ...]] = []
        #: Stretches of marches, whose rows are made together
        self._marched: list[tuple[Array, Array]] = []
        self.count = 0

    def keep(self, joint: Joint) -> None:
        """Add the state after the last accepted step."""
        carrier = self.carrier
        if not isinstance(carrier, RigidCarrier | PlanarCarrier):
            return
        self._settle()
        index = joint.carriers.index(carrier)
        last = int(joint.ends[index])
        force = joint.reaction[0, last - joint.sizes[index] : last]
        place, _ = carrier.place_and_velocity()
        moment = np.sum(np.cross(place - carrier.centre, force * carrier.copies[:, None]), axis=0)
        total = np.concatenate([np.sum(force * carrier.copies[:, None], axis=0), moment])
        row = carrier.position, carrier.rotation, carrier.velocity, total, force, np.asarray(carrier.kinetic_energy)
        self._kept.append(tuple(value[None].copy() for value in row))
        self.count += 1

    def keep_march(self, motion: Array, force: Array) -> None:
        """Add rows of a planar body: motions and their rates (2, k, 3), forces on its points (k, points, 3)."""
        self._marched.append((motion, force))
        self.count += len(force)

    def _settle(self) -> None:
        if not self._marched:
            return
        carrier = self.carrier
        assert isinstance(carrier, PlanarCarrier)
        motion = np.concatenate([motion for motion, _ in self._marched], axis=1)
        force = np.concatenate([force for _, force in self._marched])
        place, turn, speed, arms, kinetic = carrier.rows(motion[0], motion[1])
        pull = force * carrier.copies[:, None]
        total = np.concatenate([pull.sum(axis=1), np.cross(arms, pull).sum(axis=1)], axis=1)
        self._kept.append((place, turn, speed, total, force, kinetic))
        self._marched = []

    @property
    def kinetic_energy(self) -> float:
        """Kinetic energy of the body in its present state, 0 where none is kept [J]."""
        return float(getattr(self.carrier, "kinetic_energy", 0.0))

    def history(self, size: int) -> BodyHistory:
        """Return the first ``size`` rows."""
        self._settle()
        place, turn, speed, total, force, kinetic = (
            np.concatenate(column)[:size] for column in zip(*self._kept, strict=True)
        )
        return BodyHistory(place, turn, speed, total, force, tuple(self.carrier.points), kinetic)


def check_points(
    network: Network, bodies: Mapping[str, Body], carriers: Mapping[str, PointCarrier], start: State
) -> None:
    """Refuse points of bodies that the network does not drive, or that stand elsewhere.

    Raises
    ------
    InputError
        Names the point, both places and what corrects it.
    """
    for name in carriers:
        check_word(name, bodies, "carriers")
    seen: list[str] = []
    for body in bodies.values():
        seen.extend(body.points)
    nodes = dict(zip(seen, carried_nodes(network, seen), strict=True))
    extent = max(float(np.max(np.ptp(start.position, axis=0))), 1e-3)
    for name, body in bodies.items():
        if name in carriers:
            moving = carriers[name]
            places = dict(zip(moving.points, moving.place_and_velocity()[0], strict=True))
        else:
            places = dict(body.points_at_start)
        for point, place in places.items():
            there = start.position[nodes[point]]
            off = float(np.linalg.norm(there - place))
            if off > PLACE_TOLERANCE * extent:
                raise InputError(
                    f"the point {point!r} of body {name!r} is at ({', '.join(f'{v:.6g}' for v in place)}), "
                    f"in the network at ({', '.join(f'{v:.6g}' for v in there)})",
                    parameter=f"bodies.{name}.points.{point}",
                    allowed="the same place",
                    remedy="move the point of the network or the start of the body",
                )
