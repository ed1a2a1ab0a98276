"""The protocol by which bodies hang in networks: driven points in, reaction forces out.

A network knows a body only by the points that it drives; a body knows a network only by the forces at these points. The
package ``coupled`` joins the two: it asks the body where its points are, lets the network take a step (or many, while
the body
moves smoothly), and hands the mean reaction back. Both sides keep their own integrator and step.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


class PointCarrier(Protocol):
    """A body that carries points of a network (a floating body, a frame, a winch).

    The carrier moves between two times in one call; in between, its points follow the cubic through the places and
    velocities at both ends, so that a network may take many smaller steps without asking again.
    """

    @property
    def points(self) -> int:
        """Number of points carried."""

    def place_and_velocity(self) -> tuple[Array, Array]:
        """Return place [m] and velocity [m/s] of every point now, shape (points, 3) each, in the axes of the site."""

    def try_step(self, end: float, reaction: Array) -> tuple[Array, Array]:
        """Move to time ``end`` [s] under the mean forces of the network on the points, (points, 3) [N]; return place
        and velocity there.

        A second call with the same ``end`` starts again from the last accepted state with better forces.
        """

    def accept(self) -> None:
        """Keep the last tried step as the new state."""


class PointNetwork(Protocol):
    """A network that can be driven at its points."""

    @property
    def points(self) -> int:
        """Number of driven points."""

    def try_step(self, end: float, place: Array, velocity: Array) -> Array:
        """Move to time ``end`` [s] while the points go to ``place`` with ``velocity`` there; return the mean forces
        on the points [N].

        A second call with the same ``end`` starts again from the last accepted state.
        """

    def accept(self) -> None:
        """Keep the last tried step as the new state."""
