"""The water around a network: current and waves at its nodes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.sea.components import WaveComponents
from moyai.sea.current_field import CurrentField
from moyai.sea.kinematics import Stretching, stretching_code, sum_orbits
from moyai.sea.permanent_wave import NonlinearWave


class Current(Protocol):
    """Anything that knows the horizontal velocity over the height (the profiles of :mod:`moyai.sea.current`)."""

    def velocity(self, z: ArrayLike) -> Array:
        """Return the velocity (..., 2) at heights z.

        Parameters
        ----------
        z : array_like (...)
            Heights above still water [m].

        Returns
        -------
        ndarray (..., 2)
            x, y in site axes [m/s].
        """


@checks_words
@dataclass(frozen=True, eq=False)
class Flow:
    """Motion of the water: a uniform velocity, a profile over the height, waves, or all of them together.

    Raises
    ------
    InputError
        For a velocity that is not finite, waves without water, or an interval that is not positive.

    Examples
    --------
    >>> from moyai.flexible import Flow
    >>> from moyai.sea import RegularWave, Water
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> wave = RegularWave(height=1.0, period=5.0, heading=0.0, water=water)
    >>> flow = Flow(velocity=(0.5, 0.0, 0.0), waves=wave.components())
    >>> flow.steady, Flow(velocity=(0.5, 0.0, 0.0)).steady               # waves change with time
    (False, True)
    """

    #: Uniform and steady [m/s]; shape (3,).
    velocity: Array | tuple[float, float, float] = (0.0, 0.0, 0.0)
    #: Profile over the height.
    current: Current | None = None
    #: Time over which velocity, current and waves grow from zero, half a cosine [s].
    ramp: float = 0.0
    #: Linear waves; they need their ``water``.
    waves: WaveComponents | None = None
    #: A wave of finite height in their place: the waves are then the harmonics of its elevation.
    steep: NonlinearWave | None = None
    #: Kinematics of linear waves above still water; one of "wheeler", "linear", "constant".
    stretching: Stretching = "wheeler"
    #: Time between two evaluations, joined linearly [s]; when left out a fiftieth of the shortest wave period that
    #: carries energy, a hundredth of that of a wave of finite height, whose crest is shorter.
    interval: float | None = None
    #: Time over which the waves alone grow from zero, while the current stands [s].
    wave_ramp: float = 0.0
    #: A current that changes with time and place, on top of the others.
    field: CurrentField | None = None

    def __post_init__(self) -> None:
        try:
            given = np.array(self.velocity, dtype=np.float64)
        except (TypeError, ValueError):  # a word
            given = np.zeros(0)
        if given.shape != (3,) or not np.isfinite(given).all():
            raise InputError(
                f"velocity of the flow is {self.velocity}", parameter="flow.velocity", allowed="three finite numbers"
            )
        given.setflags(write=False)
        object.__setattr__(self, "velocity", given)
        if self.waves is not None and self.waves.water is None:
            raise InputError("the waves have no water", parameter="flow.waves", allowed="waves with water")
        if not (math.isfinite(self.ramp) and self.ramp >= 0.0):
            raise InputError(f"ramp of the flow is {self.ramp:g} s", parameter="flow.ramp", allowed="0 or more")
        if not (math.isfinite(self.wave_ramp) and self.wave_ramp >= 0.0):
            raise InputError(
                f"ramp of the waves is {self.wave_ramp:g} s", parameter="flow.wave_ramp", allowed="0 or more"
            )
        if self.interval is not None and not self.interval > 0.0:
            raise InputError(
                f"interval of the flow is {self.interval:g} s", parameter="flow.interval", allowed="greater than 0"
            )
        stretching_code(self.stretching)
        # what holds at every height is found once
        same = None if self.current is None else getattr(self.current, "everywhere", None)
        everywhere = given.copy()
        if same is not None:
            everywhere[:2] += same
        object.__setattr__(self, "_everywhere", everywhere if self.current is None or same is not None else None)

    @property
    def steady(self) -> bool:
        """Whether the water at a node changes neither with time nor with its place."""
        return self.waves is None and self.current is None and self.field is None and self.ramp == 0.0

    @property
    def update_interval(self) -> float:
        """Time between two evaluations [s]."""
        if self.interval is not None:
            return self.interval
        return self._own_interval if self.field is None else min(self._own_interval, self.field.interval)

    @property
    def _own_interval(self) -> float:
        if self.steep is not None:
            return self.steep.period / 100.0
        if self.waves is not None:
            order = np.argsort(self.waves.omega)
            share = np.cumsum(self.waves.amplitude[order] ** 2)
            fastest = self.waves.omega[order][int(np.searchsorted(share, 0.995 * share[-1]))]
            return 2.0 * math.pi / float(fastest) / 50.0
        return self.ramp / 50.0 if self.ramp > 0.0 else 0.1

    def growth(self, time: float) -> tuple[float, float]:
        """Return the part of the flow that has grown at a time, and its rate [1/s].

        Parameters
        ----------
        time : float
            [s].

        Returns
        -------
        (float, float)
            Share, 0 to 1 [-], and its rate [1/s].
        """
        if self.ramp <= 0.0 or time >= self.ramp:
            return 1.0, 0.0
        angle = math.pi * max(time, 0.0) / self.ramp
        return 0.5 * (1.0 - math.cos(angle)), 0.5 * math.pi / self.ramp * math.sin(angle)

    def steady_velocity(self, position: Array) -> Array:
        """Return what stands of the velocity at nodes (3, n) once it has grown: all but the waves, shape (3, n).

        Parameters
        ----------
        position : ndarray (3, n)
            x, y, z of the nodes, site axes [m].

        Returns
        -------
        ndarray (3, n)
            Site axes [m/s].
        """
        everywhere: Array | None = self.__dict__["_everywhere"]
        if everywhere is not None:
            return np.repeat(everywhere[:, None], position.shape[1], axis=1)
        out = np.repeat(np.asarray(self.velocity)[:, None], position.shape[1], axis=1)
        if self.current is not None:
            depth = self.waves.water.depth if self.waves is not None and self.waves.water is not None else math.inf
            out[:2] += self.current.velocity(np.clip(position[2], -depth, None)).T
        return out

    @property
    def summed(self) -> tuple[NDArray[np.float32], float]:
        """Sea summed beforehand at nodes, (7, nodes, times), and its step [s]; empty here."""
        return np.zeros((7, 0, 0), dtype=np.float32), 1.0

    def at(self, time: float, position: Array) -> Array:
        """Return velocity, acceleration and elevation of the water at nodes, shape (7, n).

        Parameters
        ----------
        time : float
            [s].
        position : ndarray, shape (3, n)
            Nodes [m].
        """
        count = position.shape[1]
        out = np.zeros((7, count))
        grown, rate = self.growth(time)
        out[:3] = self.steady_velocity(position)
        if self.field is not None:
            velocity, rate_of_field = self.field.at(time, position)
            out[:3] += velocity
            out[3:6] += rate_of_field
        if self.waves is not None and self.waves.water is not None:
            elevation, velocity, acceleration = self._orbital_motion(self.waves, time, position)
            swell, pace = 1.0, 0.0
            if self.wave_ramp > 0.0 and time < self.wave_ramp:
                angle = math.pi * max(time, 0.0) / self.wave_ramp
                swell, pace = 0.5 * (1.0 - math.cos(angle)), 0.5 * math.pi / self.wave_ramp * math.sin(angle)
            if swell == 1.0:
                out[:3] += velocity.T
                out[3:6] += acceleration.T
                out[6] = elevation
            else:
                out[:3] += swell * velocity.T
                out[3:6] += swell * acceleration.T + pace * velocity.T
                out[6] = swell * elevation
        if grown < 1.0:
            out[3:6] = grown * out[3:6] + rate * out[:3]
            out[:3] *= grown
            out[6] *= grown
        return out

    def _orbital_motion(self, sea: WaveComponents, time: float, position: Array) -> tuple[Array, Array, Array]:
        if self.steep is not None:
            return self.steep.orbital_motion(time, *position)
        count = position.shape[1]
        elevation, velocity, acceleration = np.empty(count), np.empty((count, 3)), np.empty((count, 3))
        water = sea.water
        sum_orbits(
            *sea.orbit_rows,
            math.inf if water is None else float(water.depth),
            *(np.ascontiguousarray(row) for row in position),
            time,
            stretching_code(self.stretching),
            elevation,
            velocity,
            acceleration,
        )
        return elevation, velocity, acceleration
