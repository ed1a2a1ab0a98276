"""The flow past a member: linear, irregular and finite-height waves behind one call, current next to it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.sea.components import WaveComponents
from moyai.sea.kinematics import Stretching, stretching_code, wheeler_elevation
from moyai.sea.nonlinear import NonlinearWave

#: Nodes of the interpolation over the heights that Wheeler's stretching reaches at one point, at most, and its error
#: over the largest acceleration that all components can give there together.
_WHEELER_NODES, _WHEELER_ERROR = 14, 1e-8


@dataclass(frozen=True, eq=False)
class FlowSample:
    """Orbital motion at points over time, without current."""

    #: Surface above each point [m]; shape (times, points).
    elevation: Array
    #: [m/s]; above the surface whatever the theory continues to, see the wetted share; shape (times, points, 3).
    velocity: Array
    #: [m/s2]; above the surface whatever the theory continues to, see the wetted share; shape (times, points, 3).
    acceleration: Array


class PointFlow(Protocol):
    """Waves that can be asked for their motion at fixed points."""

    def sample(self, time: Array, points: Array) -> FlowSample:
        """Return the motion at times [s] at points (n, 3) [m]."""


@checks_words
@dataclass(frozen=True, eq=False)
class LinearFlow:
    """Linear waves, regular or irregular, with a treatment of the region above still water."""

    #: With their water.
    components: WaveComponents
    #: See :func:`moyai.sea.kinematics.stretching_code`; one of "constant", "linear", "wheeler".
    stretching: Stretching = "wheeler"

    def __post_init__(self) -> None:
        stretching_code(self.stretching)
        if self.components.water is None:
            raise InputError("the components have no water", parameter="components", remedy="give water=Water(...)")

    def sample(self, time: Array, points: Array) -> FlowSample:
        """Return the motion at times [s] at points (n, 3) [m]."""
        sea, at = self.components, np.asarray(points, dtype=float)
        x, y, z = at.T
        elevation = np.asarray(sea.elevation(time, x, y), dtype=float)
        if self.stretching != "wheeler":
            moved, pushed = sea.transfer_functions(x, y, z, self.stretching)
            return FlowSample(elevation, sea.respond(moved, time), sea.respond(pushed, time))
        velocity = np.empty((*elevation.shape, 3))
        acceleration = np.empty_like(velocity)
        for number in range(len(at)):
            self._wheeler(time, at[number], elevation[:, number], velocity[:, number], acceleration[:, number])
        return FlowSample(elevation, velocity, acceleration)

    def _wheeler(self, time: Array, point: Array, elevation: Array, velocity: Array, acceleration: Array) -> None:
        """Fill the motion at one point: linear motion at a few heights, interpolated to the stretched height."""
        depth = float(self.components.water.depth)  # type: ignore[union-attr]
        level = np.clip(wheeler_elevation(point[2], elevation, depth), -depth, 0.0)
        low, high = float(level.min()), float(level.max())
        count = self._nodes_over(low, high) if high - low > 1e-12 else 1
        nodes = np.cos(math.pi * (np.arange(count) + 0.5) / count) if count > 1 else np.zeros(1)
        heights = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        x, y = np.full(count, point[0]), np.full(count, point[1])
        transfer = np.concatenate(self.components.transfer_functions(x, y, heights), axis=-2)
        values = self.components.respond(transfer, time)
        share = np.ones((time.size, 1)) if count == 1 else _lagrange(nodes, (2.0 * level - low - high) / (high - low))
        both = np.einsum("tn,tna->ta", share, values)
        velocity[:], acceleration[:] = both[:, :3], both[:, 3:]

    def _nodes_over(self, low: float, high: float) -> int:
        """Return how many Chebyshev nodes represent the decay of the waves between two heights [m].

        Those of n nodes err by 2 (q / 2)^n / n! of the exponential of q x, -1 <= x <= 1; q is k times half the range.
        """
        sea = self.components
        number = np.asarray(sea.wave_number)
        size = sea.amplitude * np.asarray(sea.intrinsic_omega) ** 2 * np.exp(number * high)
        reach, error = 0.25 * number * (high - low), 2.0 * size
        for count in range(1, _WHEELER_NODES + 1):
            error = error * reach / count
            if float(error.sum()) <= _WHEELER_ERROR * float(size.sum()):
                return max(count, 2)
        return _WHEELER_NODES


def _lagrange(nodes: Array, at: Array) -> Array:
    """Return the values of the Lagrange polynomials of Chebyshev nodes, shape (points, nodes)."""
    count = len(nodes)
    angle = math.pi * (np.arange(count) + 0.5) / count
    weight = np.where(np.arange(count) % 2 == 0, 1.0, -1.0) * np.sin(angle)
    gap = at[:, None] - nodes
    exact = np.abs(gap) < 1e-15
    share = weight / np.where(exact, 1.0, gap)
    share = np.where(exact.any(axis=1, keepdims=True), exact.astype(float), share)
    return np.asarray(share / share.sum(axis=1, keepdims=True))


@dataclass(frozen=True, eq=False)
class NonlinearFlow:
    """A regular wave of finite height (Stokes, stream function); its uniform current is taken out."""

    #: Kinematics reach the crest; the acceleration is that of water particles, convective part included.
    wave: NonlinearWave

    def sample(self, time: Array, points: Array) -> FlowSample:
        """Return the motion at times [s] at points (n, 3) [m]."""
        x, y, z = np.asarray(points, dtype=float).T
        return FlowSample(*self.wave.orbital_motion(time, x, y, z))
