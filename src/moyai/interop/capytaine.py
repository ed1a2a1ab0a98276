"""Capytaine's NetCDF files: the names and signs of this package are Capytaine's own."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.foreign_files import open_netcdf, reads
from moyai.core.results import join_complex
from moyai.interop.coefficients import assemble, require

_FORCES = ("excitation_force", "Froude_Krylov_force", "diffraction_force")


@reads("a file of Capytaine", named="coefficients")
def read_capytaine(
    path: str | Path, *, reference_point: Sequence[float] | None = None, body: str | None = None
) -> xr.Dataset:
    """Read a NetCDF file written by Capytaine (version 1.4 and later).

    Parameters
    ----------
    path : path
        File, NetCDF 3 or 4.
    reference_point : sequence of three float, optional
        Rotation centre of the body's degrees of freedom [m]; from ``rotation_center`` in the file where it is there.
    body : str, optional
        Body to take from a file with several; the coupling with the others is left out then.

    Returns
    -------
    xarray.Dataset
        See :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Not such a file; several bodies and none named; forward speed; missing reference point.
    """
    file = Path(path)
    if not file.is_file():
        raise InputError(f"no such file: {file}", path="coefficients")
    with open_netcdf(file, "a file of Capytaine", named="coefficients") as stored:
        raw = join_complex(stored.load())
    for name in ("added_mass", "radiation_damping"):
        if name not in raw:
            raise InputError(f"{file.name} holds no {name}", path="coefficients", remedy="was it written by Capytaine?")
    for name in ("rho", "g", "water_depth", "forward_speed"):
        if name in raw and raw[name].ndim and raw.sizes.get(name, 1) != 1:
            raise InputError(
                f"{file.name} holds several values of {name}", path="coefficients", remedy=f"select one {name}"
            )
    raw = raw.squeeze([name for name in ("rho", "g", "water_depth", "forward_speed") if name in raw.dims])
    if float(raw.get("forward_speed", 0.0)) != 0.0:
        raise InputError(f"{file.name} was computed with forward speed", path="coefficients", allowed="forward speed 0")
    raw = _one_body(raw, file.name, body)
    if "omega" not in raw.dims:
        raw = raw.expand_dims("omega") if raw["omega"].ndim == 0 else raw.swap_dims({raw["omega"].dims[0]: "omega"})
    raw = raw.transpose("omega", "wave_direction", "radiating_dof", "influenced_dof", ..., missing_dims="ignore")
    if reference_point is None and "rotation_center" in raw:
        centre = np.asarray(raw["rotation_center"].values, dtype=float).ravel()
        reference_point = tuple(centre) if centre.size == 3 else None
    stated = {name: raw[name].item() if name in raw else None for name in ("rho", "g", "water_depth")}
    require(file.name, **stated, reference_point=reference_point)
    assert reference_point is not None
    if "excitation_force" not in raw and {"Froude_Krylov_force", "diffraction_force"} <= set(raw.data_vars):
        raw["excitation_force"] = raw["Froude_Krylov_force"] + raw["diffraction_force"]
    if "excitation_force" not in raw:
        raise InputError(
            f"{file.name} holds no exciting force", path="coefficients", remedy="run the diffraction problems too"
        )
    omega = np.asarray(raw["omega"].values, dtype=float)
    ordinary = np.isfinite(omega) & (omega > 0.0)
    return assemble(
        program=f"Capytaine {raw.attrs.get('capytaine_version', '')}".strip(),
        source=file.name,
        dofs=[str(name) for name in raw["radiating_dof"].values],
        omega=omega[ordinary],
        added_mass=raw["added_mass"].values[ordinary],
        radiation_damping=raw["radiation_damping"].values[ordinary],
        wave_direction=np.atleast_1d(raw["wave_direction"].values),
        forces={name: raw[name].values[ordinary] for name in _FORCES if name in raw},
        density=float(raw["rho"]),
        gravity=float(raw["g"]),
        water_depth=float(raw["water_depth"]),
        reference_point=reference_point,
        limits=_limits(raw, omega),
        hydrostatic_stiffness=raw["hydrostatic_stiffness"].transpose("influenced_dof", "radiating_dof").values
        if "hydrostatic_stiffness" in raw
        else None,
    )


def _limits(raw: xr.Dataset, omega: Array) -> dict[str, Array]:
    limits = {}
    for name, chosen in (
        ("zero_frequency_added_mass", omega == 0.0),
        ("infinite_frequency_added_mass", np.isinf(omega)),
    ):
        if np.any(chosen):
            values = raw["added_mass"].values[chosen][0]
            if np.all(np.isfinite(values)):
                limits[name] = values
    return limits


def _one_body(raw: xr.Dataset, source: str, body: str | None) -> xr.Dataset:
    """Return the coefficients of one body, its degrees of freedom without the prefix ``body__``."""
    names = [str(name) for name in raw["radiating_dof"].values]
    bodies = sorted({name.split("__")[0] for name in names if "__" in name})
    if not bodies:
        raw = raw.assign_coords(
            {"radiating_dof": names, "influenced_dof": [str(n) for n in raw["influenced_dof"].values]}
        )
    elif len(bodies) > 1 and body is None:
        raise InputError(
            f"{source} holds the bodies {', '.join(bodies)}",
            path="body",
            remedy="name one; its coupling with the others is left out",
        )
    else:
        chosen = bodies[0] if body is None else body
        kept = [name for name in names if name.startswith(f"{chosen}__")]
        if not kept:
            raise InputError(f"{source} has no body {chosen!r}", path="body", allowed=", ".join(bodies))
        short = [name.split("__", 1)[1] for name in kept]
        raw = raw.assign_coords(
            influenced_dof=[str(name) for name in raw["influenced_dof"].values], radiating_dof=names
        )
        raw = raw.sel(radiating_dof=kept, influenced_dof=kept).assign_coords(radiating_dof=short, influenced_dof=short)
    order = [str(name) for name in raw["radiating_dof"].values]
    return raw.sel(influenced_dof=order)
