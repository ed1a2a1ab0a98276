"""BEMIO's HDF5 file of a body, as WEC-Sim and its relatives read it.

The conventions are those of :mod:`moyai.interop.bemio`: added mass over rho, damping over rho omega, force and
stiffness over rho g, the time factor exp(+i omega t). Motions that the coefficients lack are zero.
"""

from __future__ import annotations

import io
import math
from typing import Any

import numpy as np
import xarray as xr

from moyai.core.errors import InputError
from moyai.interop.coefficients import DOFS

_PARTS = {"Froude_Krylov_force": "froude-krylov", "diffraction_force": "scattering"}


def bemio_files(dataset: xr.Dataset) -> dict[str, bytes]:
    """Return the file of a body by its name.

    Parameters
    ----------
    dataset : xarray.Dataset
        See :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        When the added mass at infinite frequency is not known, which the format asks for.
    """
    import h5py

    if "infinite_frequency_added_mass" not in dataset:
        raise InputError(
            "BEMIO asks for the added mass at infinite frequency, which the coefficients lack",
            path="coefficients",
            remedy="more frequencies, from which moyai finds it",
        )
    stream = io.BytesIO()
    with h5py.File(stream, "w") as file:
        for name, values in _entries(dataset).items():
            file[name] = values
    return {"unit.h5": stream.getvalue()}


def _entries(dataset: xr.Dataset) -> dict[str, Any]:
    density, gravity, omega = float(dataset["rho"]), float(dataset["g"]), dataset["omega"].values
    depth = float(dataset["water_depth"])
    weight = density * gravity
    body = "body1/hydro_coeffs"
    entries: dict[str, Any] = {
        "simulation_parameters/rho": density,
        "simulation_parameters/g": gravity,
        "simulation_parameters/w": omega,
        "simulation_parameters/T": dataset["period"].values,
        "simulation_parameters/wave_dir": np.degrees(dataset["wave_direction"].values),
        "simulation_parameters/water_depth": depth if math.isfinite(depth) else "infinite",
        "simulation_parameters/scaled": 0,
        "bem_data/code": "moyai",
        "body1/properties/name": "unit",
        "body1/properties/body_number": 1,
        "body1/properties/dof": 6,
        f"{body}/added_mass/all": np.moveaxis(_matrix(dataset, "added_mass"), 0, -1) / density,
        f"{body}/added_mass/inf_freq": _matrix(dataset, "infinite_frequency_added_mass") / density,
        f"{body}/radiation_damping/all": np.moveaxis(_matrix(dataset, "radiation_damping"), 0, -1) / (density * omega),
        f"{body}/linear_restoring_stiffness": np.zeros((6, 6)),
    }
    if "hydrostatic_stiffness" in dataset:
        entries[f"{body}/linear_restoring_stiffness"] = _matrix(dataset, "hydrostatic_stiffness") / weight
    entries |= _force(dataset, "excitation_force", f"{body}/excitation", weight)
    for name, part in _PARTS.items():
        if name in dataset:
            entries |= _force(dataset, name, f"{body}/excitation/{part}", weight)
    return entries


def _modes(dataset: xr.Dataset) -> list[int]:
    return [DOFS.index(str(name)) for name in dataset["radiating_dof"].values]


def _matrix(dataset: xr.Dataset, name: str) -> np.ndarray:
    """Return (..., force, motion) of all six modes."""
    values = dataset[name].transpose(..., "influenced_dof", "radiating_dof").values
    out = np.zeros((*values.shape[:-2], 6, 6))
    modes = _modes(dataset)
    rows, columns = np.ix_(modes, modes)
    out[..., rows, columns] = values
    return out


def _force(dataset: xr.Dataset, name: str, path: str, weight: float) -> dict[str, np.ndarray]:
    """Return real and imaginary part, magnitude and phase of shape (force, direction, frequency)."""
    values = np.conj(dataset[name].transpose("influenced_dof", "wave_direction", "omega").values) / weight
    out = np.zeros((6, *values.shape[1:]), dtype=complex)
    out[_modes(dataset)] = values
    parts = {"re": out.real, "im": out.imag, "mag": np.abs(out), "phase": np.angle(out)}
    return {f"{path}/{key}": part for key, part in parts.items()}
