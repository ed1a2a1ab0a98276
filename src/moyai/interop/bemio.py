"""BEMIO's HDF5 files, the common form of WEC-Sim and its relatives.

Added mass is divided by rho, damping by rho omega, exciting force and stiffness by rho g (unless the file says that it
is scaled). The time factor is WAMIT's, exp(+i omega t): forces are conjugated.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr

from moyai.core.arrays import ComplexArray
from moyai.core.errors import InputError
from moyai.core.foreign_files import open_hdf5, reads, require_plausible_size
from moyai.interop.coefficients import DOFS, assemble


@reads("a file of BEMIO", named="coefficients")
def read_bemio(path: str | Path, *, reference_point: Sequence[float], body: int = 1) -> xr.Dataset:
    """Read one body of a BEMIO file.

    Parameters
    ----------
    path : path
        HDF5 file.
    reference_point : sequence of three float
        Point that the program behind the file took moments about [m]; the file does not tell.
    body : int
        Number of the body, from 1.

    Returns
    -------
    xarray.Dataset
        See :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Not such a file, no such body, coupling with other bodies.
    """
    file = Path(path)
    if not file.is_file():
        raise InputError(f"no such file: {file}", path="coefficients")
    with open_hdf5(file) as stored:
        stored.visititems(lambda name, item: _require_size(file, name, item))
        for name in ("simulation_parameters", f"body{body}/hydro_coeffs/added_mass/all"):
            if name not in stored:
                raise InputError(f"{file.name} holds no {name}", path="body", remedy="was it written by BEMIO?")
        parameters = stored["simulation_parameters"]
        coefficients = stored[f"body{body}/hydro_coeffs"]
        density, gravity = _scalar(parameters["rho"]), _scalar(parameters["g"])
        omega = np.ravel(parameters["w"][()]).astype(float)
        scaled = bool(_scalar(parameters["scaled"])) if "scaled" in parameters else False
        added_mass = np.moveaxis(coefficients["added_mass/all"][()], -1, 0)
        damping = np.moveaxis(coefficients["radiation_damping/all"][()], -1, 0)
        infinite = np.asarray(coefficients["added_mass/inf_freq"][()], dtype=float)
        stiffness = np.asarray(coefficients["linear_restoring_stiffness"][()], dtype=float)
        directions = np.radians(np.ravel(parameters["wave_dir"][()]).astype(float))
        forces = {"excitation_force": _force(coefficients["excitation"])}
        for name, key in (("Froude_Krylov_force", "froude-krylov"), ("diffraction_force", "scattering")):
            group = coefficients["excitation"].get(key)
            # Programs that do not part the force leave zeros or NaN
            if group is None or "re" not in group:
                continue
            values = _force(group)
            if np.all(np.isfinite(values)) and np.any(values):
                forces[name] = values
        depth = _depth(parameters["water_depth"][()])
        code = stored["bem_data/code"][()] if "bem_data/code" in stored else b"unknown program"
    if added_mass.shape[1:] != (6, 6):
        raise InputError(
            f"{file.name}: matrices of {added_mass.shape[1]} x {added_mass.shape[2]}: several bodies or modes",
            path="coefficients",
            allowed="one rigid body",
        )
    mass_scale = 1.0 if scaled else density
    force_scale = 1.0 if scaled else density * gravity
    damping_scale = np.ones_like(omega) if scaled else density * omega
    transpose = (0, 2, 1)
    return assemble(
        program=f"BEMIO ({_text(code)})",
        source=file.name,
        dofs=DOFS,
        omega=omega,
        added_mass=added_mass.transpose(transpose) * mass_scale,
        radiation_damping=damping.transpose(transpose) * damping_scale[:, None, None],
        wave_direction=directions,
        forces={name: values * force_scale for name, values in forces.items()},
        density=density,
        gravity=gravity,
        water_depth=depth,
        reference_point=reference_point,
        limits={"infinite_frequency_added_mass": infinite.T * mass_scale},
        hydrostatic_stiffness=stiffness * force_scale,
    )


def _require_size(file: Path, name: str, item: Any) -> None:
    require_plausible_size(file, getattr(item, "nbytes", 0), f"'{name}'", named="coefficients")


def _scalar(dataset: Any) -> float:
    return float(np.ravel(dataset[()])[0])


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)


def _depth(value: Any) -> float:
    """Return the depth; infinite depth is written as a word."""
    first = np.ravel(value)[0]
    if isinstance(first, bytes | str):
        return math.inf if _text(first).lower().startswith("inf") else float(_text(first))
    return float(first)


def _force(group: Any) -> ComplexArray:
    """Return (frequency, direction, influenced), conjugated to exp(-i omega t)."""
    values = np.asarray(group["re"][()]) - 1j * np.asarray(group["im"][()])
    return np.moveaxis(values, (0, 1, 2), (2, 1, 0))
