"""The common form of three-dimensional coefficients: one dataset in Capytaine's names, SI, ``Re(X exp(-i omega t))``.

Whole body, not per metre. Rotations and moments are about ``reference_point``; the phase of the exciting force refers
to x = y = 0 of the program's own axes. The radiation force j of motion X_i is ``(omega^2 A_ij + i omega B_ij) X_i``.

Of several bodies the degrees of freedom are called ``body__Surge`` as in Capytaine, every motion with every force, all
in the same axes; ``reference_point`` has one row for each name of the coordinate ``body``.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.results import DIRECTION_CONVENTION, TIME_CONVENTION

DOFS = ("Surge", "Sway", "Heave", "Roll", "Pitch", "Yaw")

LONG_NAMES = {
    "added_mass": ("added mass", "kg, kg m, kg m2"),
    "radiation_damping": ("radiation damping", "kg/s, kg m/s, kg m2/s"),
    "excitation_force": ("exciting force per unit wave amplitude", "N/m, N m/m"),
    "Froude_Krylov_force": ("Froude-Krylov force per unit wave amplitude", "N/m, N m/m"),
    "diffraction_force": ("diffraction force per unit wave amplitude", "N/m, N m/m"),
    "infinite_frequency_added_mass": ("added mass at infinite frequency", "kg, kg m, kg m2"),
    "zero_frequency_added_mass": ("added mass at zero frequency", "kg, kg m, kg m2"),
    "hydrostatic_stiffness": ("hydrostatic stiffness", "N/m, N, N m"),
    "mean_drift_force": ("mean drift force per squared wave amplitude", "N/m2, N m/m2"),
    "mean_drift_of_all_bodies": (
        "mean drift along x and y and its moment about z of all bodies together per squared wave amplitude",
        "N/m2, N m/m2",
    ),
}
# Drift files often hold fewer degrees of freedom than the body has: NaN stays there
_DRIFT = ("mean_drift_force", "mean_drift_of_all_bodies")


def assemble(
    *,
    program: str,
    source: str,
    dofs: Sequence[str],
    omega: Array,
    added_mass: Array,
    radiation_damping: Array,
    wave_direction: Array,
    forces: Mapping[str, ComplexArray],
    density: float,
    gravity: float,
    water_depth: float,
    reference_point: ArrayLike,
    limits: Mapping[str, Array] | None = None,
    hydrostatic_stiffness: Array | None = None,
    mean_drift_force: Array | None = None,
    mean_drift_of_all_bodies: Array | None = None,
    bodies: Sequence[str] = (),
) -> xr.Dataset:
    """Put arrays together; sorted by frequency, checked for shape, sign and completeness.

    Parameters
    ----------
    program, source : str
        Where the numbers come from.
    dofs : sequence of str
        Names of the degrees of freedom, a subset of Surge ... Yaw.
    omega : ndarray, shape (n,)
        Angular frequencies [rad/s], finite and positive.
    added_mass, radiation_damping : ndarray, shape (n, radiating, influenced)
        Whole body, SI.
    wave_direction : ndarray, shape (m,)
        Directions of travel [rad].
    forces : dict of str to ndarray, shape (n, m, influenced)
        ``excitation_force`` and, where known, ``Froude_Krylov_force`` and ``diffraction_force``.
    density, gravity, water_depth : float
        Water [kg/m3, m/s2, m].
    reference_point : sequence of three float
        Point that rotations and moments are about [m]; of several bodies one a body.
    limits : dict of str to ndarray, shape (radiating, influenced), optional
        ``zero_frequency_added_mass``, ``infinite_frequency_added_mass``.
    hydrostatic_stiffness : ndarray, shape (influenced, radiating), optional
    mean_drift_force : ndarray, shape (n, m, influenced), optional
    mean_drift_of_all_bodies : ndarray, shape (n, m, 3), optional
        Along x and y, and the moment about the vertical through x = y = 0, of several bodies together.
    bodies : sequence of str
        Names of several bodies; ``dofs`` then hold ``body__Surge`` ... of each.

    Raises
    ------
    InputError
        Missing or non-finite values, repeated frequencies, unknown degrees of freedom.
    """
    known = set(dof_names(bodies))
    unknown = [name for name in dofs if name not in known]
    if unknown:
        raise InputError(
            f"{source}: degree of freedom {unknown[0]!r} is not a rigid-body motion",
            path="coefficients",
            allowed=", ".join(DOFS),
        )
    order, dropped = _usable(np.asarray(omega, dtype=float), added_mass, radiation_damping, forces)
    omega = np.asarray(omega, dtype=float)[order]
    if omega.size == 0 or not np.all(np.isfinite(omega)) or omega[0] <= 0.0 or np.any(np.diff(omega) <= 0.0):
        raise InputError(f"{source}: frequencies must be positive, finite and different", path="coefficients")
    if not (density > 0.0 and gravity > 0.0 and water_depth > 0.0):
        raise InputError(f"{source}: density, gravity and water depth must be positive", path="coefficients")
    holds = f"{source} holds the bodies {', '.join(bodies)}" if bodies else source
    point = points_of(reference_point, max(len(bodies), 1), holds)
    matrix = ("radiating_dof", "influenced_dof")
    variables: dict[str, tuple[tuple[str, ...], NDArray[Any]]] = {
        "added_mass": (("omega", *matrix), np.asarray(added_mass, dtype=float)[order]),
        "radiation_damping": (("omega", *matrix), np.asarray(radiation_damping, dtype=float)[order]),
    }
    for name, force in forces.items():
        variables[name] = (("omega", "wave_direction", "influenced_dof"), np.asarray(force, dtype=complex)[order])
    for name, limit in (limits or {}).items():
        variables[name] = (matrix, limit)
    if hydrostatic_stiffness is not None:
        variables["hydrostatic_stiffness"] = (("influenced_dof", "radiating_dof"), hydrostatic_stiffness)
    if mean_drift_force is not None:
        variables["mean_drift_force"] = (("omega", "wave_direction", "influenced_dof"), mean_drift_force[order])
    if mean_drift_of_all_bodies is not None:
        dims = ("omega", "wave_direction", "horizontal")
        variables["mean_drift_of_all_bodies"] = (dims, mean_drift_of_all_bodies[order])
    for name, (_, values) in variables.items():
        if name not in _DRIFT and not np.all(np.isfinite(values)):
            raise InputError(f"{source}: {name} is incomplete or not finite", path="coefficients")
    dataset = xr.Dataset(
        {name: (dims, values, describe(name)) for name, (dims, values) in variables.items()},
        coords={
            "omega": ("omega", omega, {"long_name": "angular frequency", "units": "rad/s"}),
            "period": ("omega", 2.0 * math.pi / omega, {"long_name": "wave period", "units": "s"}),
            "wave_direction": (
                "wave_direction",
                np.asarray(wave_direction, dtype=float),
                {"long_name": "direction of travel", "units": "rad"},
            ),
            "radiating_dof": ("radiating_dof", list(dofs)),
            "influenced_dof": ("influenced_dof", list(dofs)),
            "xyz": ("xyz", ["x", "y", "z"]),
            "reference_point": (
                ("body", "xyz") if bodies else ("xyz",),
                point if bodies else point[0],
                {"long_name": "point that moments are about", "units": "m"},
            ),
            **({"body": ("body", list(bodies))} if bodies else {}),
            "rho": ((), float(density), {"long_name": "water density", "units": "kg/m3"}),
            "g": ((), float(gravity), {"long_name": "gravity", "units": "m/s2"}),
            "water_depth": ((), float(water_depth), {"long_name": "water depth", "units": "m"}),
        },
        attrs={
            "program": program,
            "source": source,
            "time_convention": TIME_CONVENTION,
            "direction_convention": DIRECTION_CONVENTION,
            "scope": "whole body",
            **({"dropped_frequencies": dropped} if dropped else {}),
        },
    )
    return dataset.sortby("wave_direction")


def dof_names(bodies: Sequence[str] = ()) -> tuple[str, ...]:
    """Return the names of all motions: Surge ... Yaw of one body, ``body__Surge`` ... of several."""
    return tuple(f"{body}__{name}" for body in bodies for name in DOFS) if bodies else DOFS


def points_of(given: object, count: int, source: str) -> Array:
    """Return reference points (count, 3) [m]: three numbers of one body, or three of each of several.

    Raises
    ------
    InputError
        Another number of points, or what is no finite number.
    """
    try:
        points = np.atleast_2d(np.asarray(given, dtype=float))
    except (TypeError, ValueError):
        points = np.zeros((0, 0))
    if points.shape != (count, 3) or not np.all(np.isfinite(points)):
        raise InputError(
            f"{source}: the reference point must be three numbers"
            if count == 1
            else f"{source}: the reference point must be three numbers of each",
            path="reference_point",
        )
    return points


def _usable(
    omega: Array, added_mass: Array, damping: Array, forces: Mapping[str, ComplexArray]
) -> tuple[NDArray[np.intp], int]:
    """Return the order of rising frequency without those at the low end that hold NaN, and how many these are.

    Programs print NaN where their finite-depth series gives out in long waves; NaN elsewhere is left for the caller.
    """
    order = np.argsort(omega)
    arrays = [np.asarray(values)[order] for values in (added_mass, damping, *forces.values())]
    sound = np.all([np.isfinite(values).reshape(len(order), -1).all(axis=1) for values in arrays], axis=0)
    dropped = int(np.argmax(sound)) if sound.any() else 0
    return order[dropped:], dropped


def describe(name: str) -> dict[str, str]:
    """Return the attributes of a variable."""
    long_name, units = LONG_NAMES[name]
    return {"long_name": long_name, "units": units}


def require(source: str, **values: object) -> None:
    """Refuse when something that the files do not give was not given; all of them at once.

    Raises
    ------
    InputError
        Names every missing argument.
    """
    missing = [name for name, value in values.items() if value is None]
    if missing:
        raise InputError(
            f"{source} does not give {', '.join(name.replace('_', ' ') for name in missing)}",
            path=", ".join(missing),
            remedy="give " + " and ".join(missing),
        )
