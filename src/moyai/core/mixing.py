"""Fixed points found by steps that learn from the steps before."""

from __future__ import annotations

import numpy as np

from moyai.core.arrays import Array


class Mixing:
    """Steps of an iteration x <- x + f(x), mixed after Anderson (1965): exact where f is linear in few directions.

    Parameters
    ----------
    depth : int
        Points that a step learns from, the newest included.
    """

    def __init__(self, depth: int = 5) -> None:
        self._depth = depth
        self.forget()

    def forget(self) -> None:
        """Start anew, where the map itself has changed."""
        self._points: list[Array] = []
        self._asked: list[Array] = []

    @property
    def knows(self) -> int:
        """How many points it has seen since it started."""
        return len(self._points)

    def step(self, point: Array, asked: Array, part: float = 1.0, scale: Array | float = 1.0) -> Array:
        """Return the step to take from ``point`` (n,).

        Parameters
        ----------
        point, asked : ndarray (n,)
            Where the iteration is, and f there.
        part : float
            Of the step asked for that is taken where nothing is known of it.
        scale : ndarray (n,) or float
            What the entries are measured by.
        """
        self._points = [*self._points, point][-self._depth :]
        self._asked = [*self._asked, asked][-self._depth :]
        plain = part * asked
        if len(self._points) < 2:
            return plain
        moved, turned = np.diff(self._points, axis=0).T, np.diff(self._asked, axis=0).T
        measure = np.broadcast_to(scale, asked.shape)
        share = np.linalg.lstsq(turned / measure[:, None], asked / measure, rcond=1e-6)[0]
        return np.asarray(plain - (moved + part * turned) @ share)


__all__ = ["Mixing"]
