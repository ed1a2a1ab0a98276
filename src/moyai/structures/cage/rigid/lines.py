"""Lines of the rigid cage: unilateral springs with damping between a point of the cage and an anchor."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError


@dataclass(frozen=True)
class CageLine:
    """A straight line that pulls and never pushes [eq:cage-line].

    Raises
    ------
    InputError
        For lengths and stiffnesses that are not positive.
    """

    name: str
    #: Point of the cage x, z from its middle [m].
    attachment: tuple[float, float]
    #: Anchor x, z; x from the middle of the cage at rest, z above still water [m].
    anchor: tuple[float, float]
    #: Unstretched length [m].
    length: float
    #: Of line and gauge together [N/m].
    stiffness: float
    #: Force over speed of lengthening of a taut line [N s/m].
    damping: float = 0.0
    #: Weight in water per length [N/m]; parts the tensions of both ends, nothing else.
    submerged_weight: float = 0.0
    #: [N].
    breaking_load: float | None = None

    def __post_init__(self) -> None:
        for key in ("length", "stiffness"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0.0):
                raise InputError(f"{key} of line '{self.name}' is {value:g}", parameter=key, allowed="greater than 0")
        if not (math.isfinite(self.damping) and self.damping >= 0.0):
            raise InputError(
                f"damping of line '{self.name}' is {self.damping:g} N s/m",
                parameter="damping",
                allowed="at least 0 N s/m",
            )

    def with_stiffness(self, stiffness: float, tension: float) -> CageLine:
        """Return the line with another stiffness and the same tension [N] over the same distance.

        Its damping keeps its share of the critical one, sqrt(stiffness).

        Parameters
        ----------
        stiffness : float
            Greater than 0 [N/m].
        tension : float
            Of the line now; not taut at 0 or less [N].

        Raises
        ------
        InputError
            When the line would need a length that is not positive.
        """
        span = self.length + tension / self.stiffness if tension > 0.0 else self.length
        length = span - tension / stiffness if tension > 0.0 else self.length
        if length <= 0.0:
            raise InputError(
                f"line '{self.name}' of {stiffness:g} N/m would need a length of {length:g} m for {tension:g} N",
                parameter="stiffness",
                remedy="take a stiffer line",
            )
        damping = self.damping * math.sqrt(stiffness / self.stiffness)
        return replace(self, length=length, stiffness=stiffness, damping=damping)

    def span(self, pose: ArrayLike, centre: tuple[float, float]) -> float:
        """Return the distance from anchor to attachment [m].

        Parameters
        ----------
        pose : array_like (3,)
            x, z of the centre of gravity [m] and rotation [rad].
        centre : (float, float)
            x, z of the centre of gravity from the middle of the cage [m].
        """
        px, pz = self.place(pose, centre)
        return math.hypot(self.anchor[0] - px, self.anchor[1] - pz)

    def place(self, pose: ArrayLike, centre: tuple[float, float]) -> tuple[float, float]:
        """Return x, z of the attachment [m].

        Parameters
        ----------
        pose : array_like (3,)
            x, z of the centre of gravity [m] and rotation [rad].
        centre : (float, float)
            x, z of the centre of gravity from the middle of the cage [m].
        """
        x, z, theta = (float(value) for value in np.asarray(pose))
        rx, rz = self.attachment[0] - centre[0], self.attachment[1] - centre[1]
        cosine, sine = math.cos(theta), math.sin(theta)
        return x + cosine * rx + sine * rz, z - sine * rx + cosine * rz


def series_stiffness(axial_stiffness: float, length: float, gauge_stiffness: float | None = None) -> float:
    """Return the stiffness of a line in series with its gauge [N/m] [eq:cage-series].

    Parameters
    ----------
    axial_stiffness : float
        EA [N].
    length : float
        [m].
    gauge_stiffness : float or None
        [N/m]; ``None``: rigid.
    """
    line = axial_stiffness / length
    return line if gauge_stiffness is None else line * gauge_stiffness / (line + gauge_stiffness)
