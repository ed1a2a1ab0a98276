"""The protocol by which bodies hang in networks: driven points in, reaction forces out.

A network knows a body only by the points that it drives; a body knows a network only by the forces at these points. The
package ``coupled`` joins the two: it asks the body where its points go, lets the network take as many of its own small
steps as it needs, and hands the reaction back. Both sides keep their own integrator and step.

Between two times the points follow the cubic through places and velocities at both ends, and the reaction is reported
by its mean and its tilt: ``force = mean + tilt * s`` with ``s`` from -1 at the start to +1 at the end carries impulse
and first moment of whatever happened in between exactly, so that a body whose step is long next to the ringing of its
lines still ends where it should [eq:coupled-reaction].
"""

from __future__ import annotations

from typing import Protocol

from moyai.core.arrays import Array


class PointCarrier(Protocol):
    """A body that carries points of a network (a floating body, a frame, a winch)."""

    @property
    def points(self) -> tuple[str, ...]:
        """Names of the points carried."""

    def place_and_velocity(self) -> tuple[Array, Array]:
        """Return place [m] and velocity [m/s] of every point now, shape (points, 3) each, in the axes of the site."""

    def try_step(self, end: float, reaction: Array) -> tuple[Array, Array]:
        """Move to time ``end`` [s] under the forces of the network on the points; return place and velocity there.

        ``reaction`` has shape (2, points, 3): mean and tilt [N]. A second call starts again from the last accepted
        state, with better forces or with another ``end``.

        Parameters
        ----------
        end : float
            Later than the last accepted state [s].
        reaction : ndarray (2, points, 3)
            Mean and tilt of the forces, site axes [N].

        Returns
        -------
        tuple of ndarray (points, 3)
            Place [m] and velocity [m/s], site axes.
        """

    def accept(self) -> None:
        """Keep the last tried step as the new state."""


class PointNetwork(Protocol):
    """A network that can be driven at its points."""

    @property
    def points(self) -> tuple[str, ...]:
        """Names of the driven points."""

    @property
    def time(self) -> float:
        """Time of the last accepted state [s]."""

    def try_step(self, end: float, place: Array, velocity: Array) -> Array:
        """Move to time ``end`` [s] while the points go to ``place`` with ``velocity`` there.

        Returns mean and tilt of the forces of the network on the points, shape (2, points, 3) [N]. A second call starts
        again from the last accepted state.
        """

    def accept(self) -> None:
        """Keep the last tried step as the new state."""
