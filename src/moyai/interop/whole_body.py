"""The coefficients of a result in space: a section as a whole unit (:mod:`moyai.interop.planar` undone), a row."""

from __future__ import annotations

from typing import Literal

import numpy as np
import xarray as xr

from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.results import Result
from moyai.interop.coefficients import assemble, dof_names
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
        Added mass [kg, kg m, kg m2], damping, forces per unit wave amplitude [N/m, N m/m] about ``reference_point``;
        see :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        For another ``sea``.
    KeyError
        For coefficients without sway, heave and roll.

    Examples
    --------
    >>> from moyai.interop import from_planar
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.5, 1.0], modes=rigid_modes((0.0, -0.2)))
    >>> unit = from_planar(found.dataset, length=20.0, centre_of_gravity=(0.0, -0.2))
    >>> unit.radiating_dof.values.tolist()
    ['Sway', 'Heave', 'Roll']
    >>> round(float(unit.added_mass[1, 1, 1] / found.added_mass[1, 1, 1]), 6)   # heave, of 20 m and of 1 m
    20.0
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


def level_of_result(result: Result, water_level: str | None = None) -> str:
    """Return the water level whose coefficients are asked for; the first when left out.

    Raises
    ------
    InputError
        When the result holds no coefficients, or not at this level.
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
            allowed="results of a floating breakwater or of a row of units with the analysis frequency or time",
        )
    level = levels[0] if water_level is None else water_level
    if level not in levels:
        raise InputError(f"no water level '{level}' in the result", path="water_level", allowed=", ".join(levels))
    return level


@checks_words
def coefficients_of_result(result: Result, *, water_level: str | None = None, sea: Sea = "beam") -> xr.Dataset:
    """Return the coefficients that a result holds, of the whole unit or of all units of a row.

    Parameters
    ----------
    result : Result
        Of a floating breakwater or a row of units, with the analysis frequency or time.
        Of a floating breakwater or a row of units, with the analysis frequency or time.
    water_level : str, optional
        The first level when left out.
    sea : {"beam", "head"}
        See :func:`from_planar`; of a section alone.

    Returns
    -------
    xarray.Dataset
        Added mass [kg, kg m, kg m2], damping, forces per unit wave amplitude [N/m, N m/m]; see
        :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        When the result holds none, or not at this level.

    Examples
    --------
    >>> import numpy as np
    >>> import xarray as xr
    >>> from moyai.core import Result
    >>> from moyai.interop import coefficients_of_result
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.5, 1.0], modes=rigid_modes((0.0, -0.2))).dataset
    >>> names = found.radiating_dof.values
    >>> statics = xr.Dataset(
    ...     dict(
    ...         hydrostatic_stiffness=(("influenced_dof", "radiating_dof"), np.diag([0.0, 8e5, 8e5])),
    ...         unit_length=20.0, centre_of_gravity_x=0.0, centre_of_gravity_z=-0.2,
    ...     ),
    ...     coords=dict(influenced_dof=names, radiating_dof=names),
    ... )
    >>> result = Result(xr.DataTree.from_dict({"/HWL/statics": statics, "/HWL/hydrodynamics": found}))
    >>> unit = coefficients_of_result(result, water_level="HWL")
    >>> unit.radiating_dof.values.tolist()
    ['Sway', 'Heave', 'Roll']
    >>> bool(np.allclose(unit.added_mass[:, 1, 1], 20.0 * found.added_mass[:, 1, 1]))
    True
    """
    level = level_of_result(result, water_level)
    group = result.tree.children[level].children
    statics = group["statics"].to_dataset(inherit=False)
    if "unit_x" in statics:
        return _row_of_result(result.tree.children[level], statics)
    order = list(PLANAR_DOFS)
    stiffness = statics["hydrostatic_stiffness"].sel(influenced_dof=order, radiating_dof=order)
    return from_planar(
        group["hydrodynamics"].to_dataset(inherit=False),
        length=float(statics["unit_length"]),
        centre_of_gravity=(float(statics["centre_of_gravity_x"]), float(statics["centre_of_gravity_z"])),
        sea=sea,
        hydrostatic_stiffness=stiffness.transpose("influenced_dof", "radiating_dof").values,
    )


def _row_of_result(group: xr.DataTree, statics: xr.Dataset) -> xr.Dataset:
    """Return the coefficients of all units, about their centres of gravity, with the drift of the row as it moved."""
    found = group.children["hydrodynamics"].to_dataset(inherit=False)
    count = statics.sizes["unit"]
    bodies = tuple(f"unit_{number}" for number in range(1, count + 1)) if count > 1 else ()
    points = np.stack([statics[name].values for name in ("unit_x", "unit_y", "unit_centre_z")], axis=1)
    square = ("radiating_dof", "influenced_dof")
    limits = {}
    if "memory" in group.children:
        memory = group.children["memory"].to_dataset(inherit=False)
        limits["infinite_frequency_added_mass"] = memory["infinite_frequency_added_mass"].transpose(*square).values
    drift = _drift_of_row(group, found)
    return assemble(
        program="moyai",
        source="result",
        dofs=dof_names(bodies),
        omega=found["omega"].values,
        added_mass=found["added_mass"].transpose("omega", *square).values,
        radiation_damping=found["radiation_damping"].transpose("omega", *square).values,
        wave_direction=found["wave_direction"].values,
        forces={"excitation_force": found["excitation_force"].values},
        density=float(found.attrs["rho"]),
        gravity=float(found.attrs["g"]),
        water_depth=float(found.attrs["water_depth"]),
        reference_point=points,
        limits=limits,
        hydrostatic_stiffness=found["hydrostatic_stiffness"].transpose("influenced_dof", "radiating_dof").values,
        mean_drift_of_all_bodies=drift,
        bodies=bodies,
    )


def _drift_of_row(group: xr.DataTree, found: xr.Dataset) -> np.ndarray | None:
    """Return the drift (n, m, 3) of the row in each heading, of the first sea that came from there; None if unknown."""
    headings = found["wave_direction"].values
    drift = np.full((found.sizes["omega"], headings.size, 3), np.nan)
    for sea in group.children["frequency"].children.values() if "frequency" in group.children else ():
        data = sea.to_dataset(inherit=False)
        if "drift_per_amplitude_squared" not in data:
            continue
        values = data["drift_per_amplitude_squared"].transpose("omega", "wave_direction", "direction").values
        for column, heading in enumerate(data["wave_direction"].values):
            place = int(np.argmin(np.abs(headings - heading)))
            if np.isnan(drift[:, place]).any():
                drift[:, place] = values[:, column]
    return None if np.isnan(drift).any() else drift
