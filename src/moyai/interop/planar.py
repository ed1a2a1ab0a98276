"""From a three-dimensional body to the planar section of this package, and from one reference point to another.

A planar section lies in x-z with the degrees of freedom sway (x), heave (z) and roll, the positive rotation about +y.
For a body whose waves travel along its x axis these are surge, heave and pitch. For a body in beam seas, waves along
its y axis, planar x is the body's y; a positive 3-D roll about +x moves the top towards -y, a planar roll moves it
towards +x, so the sign of roll turns: sway-roll terms and the roll force flip.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Literal

import numpy as np
import xarray as xr

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.interop.bodies import about_points, refer_phase, transformed

PLANAR_DOFS = ("sway", "heave", "roll")

# Planar degree of freedom -> (3-D degree of freedom, sign); the heading is the 3-D direction of planar +x
FRAMES: dict[str, tuple[tuple[tuple[str, float], ...], float]] = {
    "beam": ((("Sway", 1.0), ("Heave", 1.0), ("Roll", -1.0)), 0.5 * math.pi),
    "head": ((("Surge", 1.0), ("Heave", 1.0), ("Pitch", 1.0)), 0.0),
}


def move_reference_point(dataset: xr.Dataset, point: Sequence[float]) -> xr.Dataset:
    """Return the coefficients of the same body with rotations and moments about another point.

    Equation [eq:reference-point]: with d from the new to the old point, a motion X of the new point moves the old one
    by ``M X``, and ``A' = M^T A M``, ``B' = M^T B M``, ``F' = M^T F``. The stiffness follows the same law when weight
    and buoyancy balance. Phases stay referred to x = y = 0. Mean drift is left out: its moment needs the motions.

    Parameters
    ----------
    dataset : xarray.Dataset
        Coefficients of :mod:`moyai.interop.coefficients`, all six degrees of freedom.
    point : sequence of three float
        New reference point in the axes of the dataset [m].

    Returns
    -------
    xarray.Dataset

    Raises
    ------
    InputError
        When a degree of freedom is missing, which the move would need.
    """
    return about_points(dataset, np.atleast_2d(np.asarray(point, dtype=float)))


@checks_words
def to_planar(
    dataset: xr.Dataset,
    *,
    length: float,
    centre_of_gravity: tuple[float, float],
    sea: Literal["beam", "head"],
    origin: tuple[float, float] = (0.0, 0.0),
) -> xr.Dataset:
    """Return planar sway, heave and roll coefficients per metre, about the centre of gravity.

    Equations [eq:planar-frame] and [eq:reference-point]. They stand in place of a section's. End effects of the finite
    unit are in the numbers; dividing by the length only makes them comparable with a section.

    Parameters
    ----------
    dataset : xarray.Dataset
        Coefficients of :mod:`moyai.interop.coefficients`, whole body.
    length : float
        Length of the unit along its crest [m].
    centre_of_gravity : tuple of two float
        Planar x and z of the centre of gravity [m], z from still water; the roll is about it.
    sea : {"beam", "head"}
        ``beam``: planar +x is the body's +y (waves at 90 degrees); ``head``: planar +x is the body's +x (0 degrees).
    origin : tuple of two float
        Body-axes x and y of the planar origin [m]; phases refer to it.

    Returns
    -------
    xarray.Dataset
        Same names per metre; ``wave_direction`` is the planar heading, 0 along planar +x; attribute ``unit_length``.

    Raises
    ------
    InputError
        No waves along planar +x, missing degrees of freedom, non-positive length.
    """
    if not (math.isfinite(length) and length > 0.0):
        raise InputError(f"length {length}", path="length", allowed="positive")
    frame, along = FRAMES[sea]
    names = [name for name, _ in frame]
    missing = [name for name in names if name not in dataset["radiating_dof"].values]
    if missing:
        raise InputError(f"the coefficients lack {', '.join(missing)}", path="coefficients")
    heading = _wrap(dataset["wave_direction"].values - along)
    if not np.any(np.abs(heading) < 1e-6):
        raise InputError(
            f"no waves at {math.degrees(along):.0f} degrees, along planar +x",
            path="coefficients",
            allowed="directions in the file: "
            + ", ".join(f"{math.degrees(angle):g}" for angle in dataset["wave_direction"].values),
            remedy=f"run the program with a heading of {math.degrees(along):.0f} degrees",
        )
    planar = dataset.drop_vars("mean_drift_force", errors="ignore").sel(radiating_dof=names, influenced_dof=names)
    planar = transformed(planar, np.diag([sign for _, sign in frame]))
    planar = planar.assign_coords(radiating_dof=list(PLANAR_DOFS), influenced_dof=list(PLANAR_DOFS))
    # Reference point in planar axes: x is the component along the waves
    point, shift = dataset["reference_point"].values, np.asarray(origin, dtype=float)
    direction = np.array([math.cos(along), math.sin(along)])
    dx = float((point[:2] - shift) @ direction) - centre_of_gravity[0]
    dz = float(point[2]) - centre_of_gravity[1]
    planar = transformed(planar, np.array([[1.0, 0.0, dz], [0.0, 1.0, -dx], [0.0, 0.0, 1.0]]))
    planar = refer_phase(planar, shift)
    for name in planar.data_vars:
        planar[name] = planar[name].copy(data=planar[name].values / length)
        planar[name].attrs["units"] = ", ".join(_per_metre(unit) for unit in dataset[name].attrs["units"].split(", "))
    planar = planar.drop_vars(["reference_point", "xyz"]).assign_coords(
        wave_direction=dataset["wave_direction"].copy(data=heading)
    )
    planar.attrs.update(
        scope="per metre of structure",
        unit_length=float(length),
        centre_of_gravity=list(map(float, centre_of_gravity)),
        sea=sea,
    )
    return planar.sortby("wave_direction")


def _wrap(angle: Array) -> Array:
    """Return the angle in (-pi, pi], rounding-proof at the ends."""
    wrapped = np.mod(angle, 2.0 * math.pi)
    return np.where(wrapped > math.pi + 1e-9, wrapped - 2.0 * math.pi, wrapped)


_PER_METRE = {
    "kg": "kg/m",
    "kg m": "kg",
    "kg m2": "kg m",
    "kg/s": "kg/(m s)",
    "kg m/s": "kg/s",
    "kg m2/s": "kg m/s",
    "N/m": "N/m2",
    "N m/m": "N/m",
    "N": "N/m",
    "N m": "N",
}


def _per_metre(unit: str) -> str:
    return _PER_METRE.get(unit, f"{unit}/m")
