"""Morison's forces across a strip: inertia, drag by component or by vector, Magnus; any array shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.options import checks_words
from moyai.morison.circulation import magnus_force

DragForm = Literal["component", "vector"]


@dataclass(frozen=True, eq=False)
class StripForces:
    """Forces per length across a strip, by cause; shape (..., 2) [N/m]."""

    inertia: Array
    drag: Array
    magnus: Array

    @property
    def total(self) -> Array:
        """Their sum, (..., 2) [N/m]."""
        return np.asarray(self.inertia + self.drag + self.magnus)


@checks_words
def strip_forces(
    velocity: ArrayLike,
    acceleration: ArrayLike,
    *,
    density: float,
    area: float,
    inertia: ArrayLike,
    drag: ArrayLike,
    drag_widths: ArrayLike,
    circulation: ArrayLike = 0.0,
    body_velocity: ArrayLike = 0.0,
    body_acceleration: ArrayLike = 0.0,
    form: DragForm = "component",
) -> StripForces:
    """Return Morison's forces on a strip [eq:morison-strip].

    Parameters
    ----------
    velocity, acceleration : array_like, shape (..., 2)
        Of the water, undisturbed, at the axis of the member, across it [m/s], [m/s2].
    density, area : float
        Of the water [kg/m3], of the section [m2].
    inertia : array_like, shape (2,) or (..., 2, 2)
        C_M along both axes, or a tensor.
    drag : array_like, shape (..., 2)
        C_D along both axes.
    drag_widths : array_like, shape (2,)
        Width that flow along each axis meets [m].
    circulation : array_like
        Gamma [m2/s], positive clockwise; 0 leaves Magnus's force out.
    body_velocity, body_acceleration : array_like, shape (..., 2)
        Of the member [m/s], [m/s2]: drag and Magnus's force follow the relative velocity, inertia
        rho A (C_M a - (C_M - 1) a_body).
    form : {"component", "vector"}
        Drag u |u| along each axis by itself, or u |U| with the common speed [eq:morison-vector].

    Returns
    -------
    StripForces
        Inertia, drag and Magnus's force, shape (..., 2), and their ``total`` [N/m].

    Raises
    ------
    InputError
        For an unknown form.

    Examples
    --------
    >>> import math
    >>> from moyai.morison import strip_forces
    >>> force = strip_forces(
    ...     velocity=[2.0, 0.0], acceleration=[0.0, 0.0], density=1025.0, area=0.25 * math.pi,
    ...     inertia=[2.0, 2.0], drag=[1.0, 1.0], drag_widths=[1.0, 1.0],
    ... )
    >>> force.drag.tolist()                                              # 0.5 x 1025 x 1 x 1 x 2^2 [N/m]
    [2050.0, 0.0]
    """
    water, rate = np.asarray(velocity, dtype=float), np.asarray(acceleration, dtype=float)
    body_rate = np.asarray(body_acceleration, dtype=float)
    relative = water - np.asarray(body_velocity, dtype=float)
    tensor = np.asarray(inertia, dtype=float)
    if tensor.ndim == 1:
        tensor = np.diag(tensor)
    # the hull pushes rho A (C_M - 1) of water along when it moves itself
    inertial = np.einsum("...ij,...j->...i", tensor, rate - body_rate) + body_rate
    speed = np.abs(relative) if form == "component" else np.linalg.norm(relative, axis=-1, keepdims=True)
    factor = 0.5 * density * np.asarray(drag, dtype=float) * np.asarray(drag_widths, dtype=float)
    return StripForces(
        inertia=np.asarray(density * area * inertial),
        drag=np.asarray(factor * relative * speed),
        magnus=magnus_force(density, circulation, relative),
    )
