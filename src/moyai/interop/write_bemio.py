"""BEMIO's HDF5 file of one or several bodies, as WEC-Sim and its relatives read it.

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
from moyai.interop.bodies import bodies_of, modes_of
from moyai.interop.coefficients import dof_names
from moyai.interop.limits import FEWEST_FREQUENCIES, complete_limits

_PARTS = {"Froude_Krylov_force": "froude-krylov", "diffraction_force": "scattering"}


def bemio_files(dataset: xr.Dataset) -> dict[str, bytes]:
    """Return the file by its name.

    Parameters
    ----------
    dataset : xarray.Dataset
        See :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        When the added mass at infinite frequency is not known, which the format requires, and the frequencies are too
        few to find it from the damping.
    """
    import h5py

    if "infinite_frequency_added_mass" not in dataset and dataset.sizes["omega"] >= FEWEST_FREQUENCIES:
        dataset = complete_limits(dataset)
    if "infinite_frequency_added_mass" not in dataset:
        raise InputError(
            "BEMIO requires the added mass at infinite frequency, which the coefficients lack",
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
    entries: dict[str, Any] = {
        "simulation_parameters/rho": density,
        "simulation_parameters/g": gravity,
        "simulation_parameters/w": omega,
        "simulation_parameters/T": dataset["period"].values,
        "simulation_parameters/wave_dir": np.degrees(dataset["wave_direction"].values),
        "simulation_parameters/water_depth": depth if math.isfinite(depth) else "infinite",
        "simulation_parameters/scaled": 0,
        "bem_data/code": "moyai",
    }
    added_mass = np.moveaxis(_matrix(dataset, "added_mass"), 0, -1) / density
    damping = np.moveaxis(_matrix(dataset, "radiation_damping"), 0, -1) / (density * omega)
    infinite = _matrix(dataset, "infinite_frequency_added_mass") / density
    stiffness = np.zeros_like(infinite)
    if "hydrostatic_stiffness" in dataset:
        stiffness = _matrix(dataset, "hydrostatic_stiffness") / weight
    for number, name in enumerate(bodies_of(dataset) or ("unit",)):
        body, own = f"body{number + 1}/hydro_coeffs", slice(6 * number, 6 * number + 6)
        entries |= {
            f"body{number + 1}/properties/name": name,
            f"body{number + 1}/properties/body_number": number + 1,
            f"body{number + 1}/properties/dof": 6,
            f"{body}/added_mass/all": added_mass[own],
            f"{body}/added_mass/inf_freq": infinite[own],
            f"{body}/radiation_damping/all": damping[own],
            f"{body}/linear_restoring_stiffness": stiffness[own, own],
        }
        entries |= _force(dataset, "excitation_force", f"{body}/excitation", weight, own)
        for force, part in _PARTS.items():
            if force in dataset:
                entries |= _force(dataset, force, f"{body}/excitation/{part}", weight, own)
    if "mean_drift_of_all_bodies" in dataset:
        values = dataset["mean_drift_of_all_bodies"].transpose("horizontal", "wave_direction", "omega").values
        drift = np.zeros((6, *values.shape[1:]))
        drift[[0, 1, 5]] = values / weight
        entries["body1/hydro_coeffs/mean_drift/momentum_conservation/val"] = drift
    return entries


def _matrix(dataset: xr.Dataset, name: str) -> np.ndarray:
    """Return (..., force, motion) of all six modes of all bodies."""
    values = dataset[name].transpose(..., "influenced_dof", "radiating_dof").values
    size = len(dof_names(bodies_of(dataset)))
    out = np.zeros((*values.shape[:-2], size, size))
    modes = np.array(modes_of(dataset)) - 1
    rows, columns = np.ix_(modes, modes)
    out[..., rows, columns] = values
    return out


def _force(dataset: xr.Dataset, name: str, path: str, weight: float, own: slice) -> dict[str, np.ndarray]:
    """Return real and imaginary part, magnitude and phase of shape (force, direction, frequency)."""
    values = np.conj(dataset[name].transpose("influenced_dof", "wave_direction", "omega").values) / weight
    out = np.zeros((len(dof_names(bodies_of(dataset))), *values.shape[1:]), dtype=complex)
    out[np.array(modes_of(dataset)) - 1] = values
    out = out[own]
    parts = {"re": out.real, "im": out.imag, "mag": np.abs(out), "phase": np.angle(out)}
    return {f"{path}/{key}": part for key, part in parts.items()}
