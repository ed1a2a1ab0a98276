"""Results of NEMOH (version 3) of bodies: Nemoh.cal, Results/CM.dat, CA.dat, the forces, and Mesh/KH.dat.

The conventions are those of :mod:`moyai.interop.nemoh`: SI, the time factor exp(-i omega t).
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator

import numpy as np
import xarray as xr

from moyai.interop.bodies import bodies_of, file_names, modes_of
from moyai.interop.coefficients import DOFS

_FORCES = {
    "excitation_force": ("ExcitationForce.tec", "Excitation force"),
    "Froude_Krylov_force": ("FKForce.tec", "FK force"),
    "diffraction_force": ("DiffractionForce.tec", "Diffraction force"),
}


def nemoh_files(dataset: xr.Dataset) -> dict[str, bytes]:
    """Return the files by their names; NEMOH has no place for limits of the added mass and for drift.

    Parameters
    ----------
    dataset : xarray.Dataset
        See :mod:`moyai.interop.coefficients`.
    """
    files: dict[str, Iterable[str]] = {
        "Nemoh.cal": _control(dataset),
        "Results/CM.dat": _matrices(dataset, "added_mass"),
        "Results/CA.dat": _matrices(dataset, "radiation_damping"),
    }
    for name, (file, title) in _FORCES.items():
        if name in dataset:
            files[f"Results/{file}"] = _force(dataset, name, title)
    if "hydrostatic_stiffness" in dataset:
        bodies = bodies_of(dataset)
        for number in range(max(len(bodies), 1)):
            files[f"Mesh/KH_{number}.dat" if bodies else "Mesh/KH.dat"] = _stiffness(dataset, number)
    return {name: ("\n".join(lines) + "\n").encode("ascii") for name, lines in files.items()}


def _row(*values: float) -> str:
    return " ".join(f"{float(value):.17E}" for value in values)


def _control(dataset: xr.Dataset) -> list[str]:
    depth = float(dataset["water_depth"])
    omega, headings = dataset["omega"].values, np.degrees(dataset["wave_direction"].values)
    return [
        "--- Environment ---",
        f"{_row(float(dataset['rho']))} ! RHO",
        f"{_row(float(dataset['g']))} ! G",
        f"{_row(depth if math.isfinite(depth) else 0.0)} ! DEPTH",
        "0. 0. ! XEFF YEFF",
        "--- Description of floating bodies ---",
        f"{max(len(bodies_of(dataset)), 1)} ! Number of bodies",
        *_bodies(dataset),
        "--- Load cases to be solved ---",
        f"1 {omega.size} {_row(omega[0], omega[-1])} ! Frequency type, number, least and largest [rad/s]",
        f"{headings.size} {_row(headings[0], headings[-1])} ! Number of directions, least and largest [deg]",
        "--- Post processing ---",
        "1 ! Output freq type, 1 is rad/s",
    ]


def _bodies(dataset: xr.Dataset) -> Iterator[str]:
    points, modes = np.atleast_2d(dataset["reference_point"].values), modes_of(dataset)
    for number, (name, point) in enumerate(zip(file_names(dataset, "none"), points)):
        own = [mode - 6 * number - 1 for mode in modes if 0 <= mode - 6 * number - 1 < 6]
        entries = []
        for mode in own:
            axis = " ".join("1." if k == mode % 3 else "0." for k in range(3))
            centre = "0. 0. 0." if mode < 3 else _row(*point)
            entries.append(f"{1 + mode // 3} {axis} {centre} ! {DOFS[mode]}")
        yield f"--- Body {number + 1} ---"
        yield f"{name} ! no mesh, coefficients written by moyai"
        yield "0 0 ! points and panels"
        yield f"{len(own)} ! Number of degrees of freedom"
        yield from entries
        yield f"{len(own)} ! Number of resulting generalised forces"
        yield from entries
        yield "0 ! Number of lines of additional information"


def _matrices(dataset: xr.Dataset, name: str) -> Iterator[str]:
    matrices = dataset[name].transpose("omega", "radiating_dof", "influenced_dof").values
    yield f"Nb de frequency : {dataset.sizes['omega']}"
    for omega, matrix in zip(dataset["omega"].values, matrices, strict=True):
        yield _row(omega)
        yield from (_row(*row) for row in matrix)


def _force(dataset: xr.Dataset, name: str, title: str) -> Iterator[str]:
    force = dataset[name].transpose("wave_direction", "omega", "influenced_dof").values
    yield 'VARIABLES="w (rad/s)"'
    yield from (f'"abs(F {n + 1})" "angle(F {n + 1})"' for n in range(force.shape[2]))
    for heading, rows in zip(np.degrees(dataset["wave_direction"].values), force, strict=True):
        yield f'Zone t="{title} - beta = {heading:.17E} deg",I={len(rows)},F=POINT'
        for omega, row in zip(dataset["omega"].values, rows, strict=True):
            yield _row(omega, *(part for value in row for part in (abs(value), np.angle(value))))


def _stiffness(dataset: xr.Dataset, number: int) -> Iterator[str]:
    """Yield the restoring of one body; that between bodies has no place."""
    own = [mode - 6 * number - 1 for mode in modes_of(dataset)]
    kept = [(index, mode) for index, mode in enumerate(own) if 0 <= mode < 6]
    rows, modes = [index for index, _ in kept], [mode for _, mode in kept]
    values = dataset["hydrostatic_stiffness"].transpose("influenced_dof", "radiating_dof").values
    matrix = np.zeros((6, 6))
    matrix[np.ix_(modes, modes)] = values[np.ix_(rows, rows)]
    yield from (_row(*row) for row in matrix)
