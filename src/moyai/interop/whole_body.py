"""The coefficients of a section as those of a whole unit in space: :mod:`moyai.interop.planar` undone."""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.results import Result
from moyai.interop.coefficients import assemble
from moyai.interop.planar import FRAMES, PLANAR_DOFS

_LIMITS = ("zero_frequency_added_mass", "infinite_frequency_added_mass")
_FORCES = ("excitation_force", "Froude_Krylov_force", "diffraction_force")

Sea = Literal["beam", "head"]


@checks_words
def from_planar(
    planar: xr.Dataset,
    *,
    length: float,
    centre_of_gravity: tuple[float, float],
    sea: Sea = "beam",
    hydrostatic_stiffness: np.ndarray | None = None,
) -> xr.Dataset:
    """Return the coefficients of a whole unit from those of its section: per metre times the length.

    Equation [eq:planar-frame] undone. What happens at the ends of the unit is not in them, and motions that the section
    does not have are absent.

    Parameters
    ----------
    planar : xarray.Dataset
        Sway, heave and roll per metre about the centre of gravity.
    length : float
        Length of the unit along its crest [m].
    centre_of_gravity : tuple of two float
        Planar x and z of the centre of gravity [m], z from still water.
    sea : {"beam", "head"}
        ``beam``: sway, heave and roll of a body whose x axis runs along the crest, waves at 90 degrees; ``head``:
        surge, heave and pitch, waves at 0 degrees.
    hydrostatic_stiffness : ndarray, shape (3, 3), optional
        Of the whole unit in planar axes [N/m, N, N m].

    Returns
    -------
    xarray.Dataset
        See :mod:`moyai.interop.coefficients`.
    """
    frame, along = FRAMES[sea]
    signs = np.array([sign for _, sign in frame])
    pair = signs[:, None] * signs[None, :] * length
    planar = planar.sel(radiating_dof=list(PLANAR_DOFS), influenced_dof=list(PLANAR_DOFS))

    def fact(name: str) -> float:
        return float(planar[name] if name in planar.variables else planar.attrs[name])

    x, z = centre_of_gravity
    # Towards zero frequency the added mass of a section may have no limit
    limits = {name: planar[name].values * pair for name in _LIMITS if name in planar}
    return assemble(
        program="moyai",
        source=str(planar.attrs.get("section", "section")),
        dofs=[name for name, _ in frame],
        omega=planar["omega"].values,
        added_mass=planar["added_mass"].values * pair,
        radiation_damping=planar["radiation_damping"].values * pair,
        wave_direction=planar["wave_direction"].values + along,
        forces={name: planar[name].values * signs * length for name in _FORCES if name in planar},
        density=fact("rho"),
        gravity=fact("g"),
        water_depth=fact("water_depth"),
        reference_point=(0.0, x, z) if sea == "beam" else (x, 0.0, z),
        limits={name: values for name, values in limits.items() if np.all(np.isfinite(values))},
        hydrostatic_stiffness=None if hydrostatic_stiffness is None else hydrostatic_stiffness * pair / length,
    )


@checks_words
def coefficients_of_result(result: Result, *, water_level: str | None = None, sea: Sea = "beam") -> xr.Dataset:
    """Return the coefficients that a result holds, of the whole unit.

    Parameters
    ----------
    result : Result
    water_level : str, optional
        The first level when left out.
    sea : {"beam", "head"}
        See :func:`from_planar`.

    Raises
    ------
    InputError
        When the result holds none, or not at this level.
    """
    levels = [
        name
        for name, group in result.tree.children.items()
        if {"hydrodynamics", "statics"} <= set(group.children) and "added_mass" in group["hydrodynamics"]
    ]
    if not levels:
        raise InputError(
            "the result holds no coefficients of a floating body",
            path="results",
            allowed="results of a floating breakwater with the analysis frequency or time",
        )
    level = levels[0] if water_level is None else water_level
    if level not in levels:
        raise InputError(f"no water level '{level}' in the result", path="water_level", allowed=", ".join(levels))
    group = result.tree.children[level].children
    statics = group["statics"].to_dataset(inherit=False)
    order = list(PLANAR_DOFS)
    stiffness = statics["hydrostatic_stiffness"].sel(influenced_dof=order, radiating_dof=order)
    return from_planar(
        group["hydrodynamics"].to_dataset(inherit=False),
        length=float(statics["unit_length"]),
        centre_of_gravity=(float(statics["centre_of_gravity_x"]), float(statics["centre_of_gravity_z"])),
        sea=sea,
        hydrostatic_stiffness=stiffness.transpose("influenced_dof", "radiating_dof").values,
    )
