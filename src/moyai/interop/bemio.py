"""BEMIO's HDF5 files, the common form of WEC-Sim and its relatives.

Added mass is divided by rho, damping by rho omega, exciting force and stiffness by rho g (unless the file says that it
is scaled). Of several bodies each has its rows, the forces on it, for the motions of all. The time factor is WAMIT's,
exp(+i omega t): forces are conjugated.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import NDArray

from moyai.core.arrays import ComplexArray
from moyai.core.errors import InputError
from moyai.core.foreign_files import open_hdf5, reads, require_plausible_size
from moyai.interop.bodies import distinct, one_body
from moyai.interop.coefficients import assemble, dof_names


@reads("a file of BEMIO", named="coefficients")
def read_bemio(
    path: str | Path,
    *,
    reference_point: Sequence[float] | Sequence[Sequence[float]],
    body: int | str | None = None,
) -> xr.Dataset:
    """Read the bodies of a BEMIO file.

    Parameters
    ----------
    path : path
        HDF5 file.
    reference_point : sequence of three float
        Point that the program behind the file took moments about [m], one for each of several bodies; the file does
        not say.
    body : int or str, optional
        One of several bodies, by number from 1 or by its name; all of them when absent. Three numbers as reference
        point are then those of this body.

    Returns
    -------
    xarray.Dataset
        Added mass [kg, kg m, kg m2], damping, forces per unit wave amplitude [N/m, N m/m] about ``reference_point``;
        see :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Not such a file, no such body, modes beyond those of rigid bodies.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> import numpy as np
    >>> from moyai.interop import from_planar, read_bemio, write_coefficients
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.5, 1.0], modes=rigid_modes((0.0, -0.2)))
    >>> unit = from_planar(found.dataset, length=20.0, centre_of_gravity=(0.0, -0.2))
    >>> [file] = write_coefficients("bemio", unit, mkdtemp())
    >>> again = read_bemio(file, reference_point=(0.0, 0.0, -0.2))
    >>> bool(np.allclose(again.added_mass.sel(radiating_dof="Heave", influenced_dof="Heave"), unit.added_mass[:, 1, 1]))
    True
    """
    file = Path(path)
    if not file.is_file():
        raise InputError(f"no such file: {file}", path="coefficients")
    with open_hdf5(file) as stored:
        stored.visititems(lambda name, item: _require_size(file, name, item))
        count = 1
        while f"body{count + 1}/hydro_coeffs" in stored:
            count += 1
        for name in ("simulation_parameters", *(f"body{n}/hydro_coeffs/added_mass/all" for n in range(1, count + 1))):
            if name not in stored:
                raise InputError(f"{file.name} holds no {name}", path="body", remedy="was it written by BEMIO?")
        parameters = stored["simulation_parameters"]
        groups = [stored[f"body{n}/hydro_coeffs"] for n in range(1, count + 1)]
        density, gravity = _scalar(parameters["rho"]), _scalar(parameters["g"])
        omega = np.ravel(parameters["w"][()]).astype(float)
        scaled = bool(_scalar(parameters["scaled"])) if "scaled" in parameters else False
        # Rows are the forces on this body, columns the motions of all of them
        added_mass = np.concatenate([_rows(group, "added_mass/all", count, file) for group in groups])
        damping = np.concatenate([_rows(group, "radiation_damping/all", count, file) for group in groups])
        infinite = np.concatenate([_rows(group, "added_mass/inf_freq", count, file) for group in groups])
        from scipy.linalg import block_diag

        stiffness = block_diag(*(np.asarray(group["linear_restoring_stiffness"][()], dtype=float) for group in groups))
        directions = np.radians(np.ravel(parameters["wave_dir"][()]).astype(float))
        forces = {"excitation_force": np.concatenate([_force(group["excitation"]) for group in groups], axis=2)}
        for name, key in (("Froude_Krylov_force", "froude-krylov"), ("diffraction_force", "scattering")):
            parts = [group["excitation"].get(key) for group in groups]
            # Programs that do not part the force leave zeros or NaN
            if any(part is None or "re" not in part for part in parts):
                continue
            values = np.concatenate([_force(part) for part in parts], axis=2)
            if np.all(np.isfinite(values)) and np.any(values):
                forces[name] = values
        drift = _drift(groups)
        depth = _depth(parameters["water_depth"][()])
        code = stored["bem_data/code"][()] if "bem_data/code" in stored else b"unknown program"
        names = [_text(stored[f"body{n}/properties/name"][()]) if f"body{n}/properties/name" in stored else ""
                 for n in range(1, count + 1)]  # fmt: skip
    mass_scale = 1.0 if scaled else density
    force_scale = 1.0 if scaled else density * gravity
    damping_scale = np.ones_like(omega) if scaled else density * omega
    bodies = distinct(names) if count > 1 else ()
    points = np.atleast_2d(np.asarray(reference_point, dtype=float))
    if bodies and body is not None and points.shape == (1, 3):
        points = np.repeat(points, count, axis=0)
    dataset = assemble(
        program=f"BEMIO ({_text(code)})",
        source=file.name,
        dofs=dof_names(bodies),
        omega=omega,
        added_mass=np.moveaxis(added_mass, -1, 0).transpose(0, 2, 1) * mass_scale,
        radiation_damping=np.moveaxis(damping, -1, 0).transpose(0, 2, 1) * damping_scale[:, None, None],
        wave_direction=directions,
        forces={name: np.asarray(values * force_scale, dtype=complex) for name, values in forces.items()},
        density=density,
        gravity=gravity,
        water_depth=depth,
        reference_point=points,
        limits={"infinite_frequency_added_mass": infinite.T * mass_scale},
        hydrostatic_stiffness=stiffness * force_scale,
        mean_drift_of_all_bodies=None if drift is None or not bodies else drift * (density * gravity),
        bodies=bodies,
    )
    return dataset if body is None else one_body(dataset, body)


def _rows(group: Any, name: str, count: int, file: Path) -> NDArray[np.float64]:
    values = np.asarray(group[name][()], dtype=float)
    if values.shape[:2] != (6, 6 * count):
        raise InputError(
            f"{file.name}: matrices of {values.shape[0]} x {values.shape[1]} of {count} bodies",
            path="coefficients",
            allowed=f"6 x {6 * count}, rigid bodies",
        )
    return values


def _drift(groups: list[Any]) -> NDArray[np.float64] | None:
    """Return the mean drift of all bodies together (frequency, direction, 3), where momentum gave it.

    The far field gives their sum alone, which stands with the first body, the moment about the vertical through
    x = y = 0.
    """
    key = "mean_drift/momentum_conservation/val"
    if key not in groups[0]:
        return None
    values = np.asarray(groups[0][key][()], dtype=float)
    if values.ndim != 3 or values.shape[0] != 6 or not np.any(values):
        return None
    if any(key in group and np.any(np.nan_to_num(group[key][()])) for group in groups[1:]):
        return None
    return np.moveaxis(values[[0, 1, 5]], (0, 1, 2), (2, 1, 0))


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
