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
from moyai.interop.bodies import distinct, one_body
from moyai.interop.coefficients import assemble, require

_FORCES = ("excitation_force", "Froude_Krylov_force", "diffraction_force")


@reads("a file of Capytaine", named="coefficients")
def read_capytaine(
    path: str | Path,
    *,
    reference_point: Sequence[float] | Sequence[Sequence[float]] | None = None,
    body: int | str | None = None,
) -> xr.Dataset:
    """Read a NetCDF file written by Capytaine (version 1.4 and later).

    Parameters
    ----------
    path : path
        File, NetCDF 3 or 4.
    reference_point : sequence of three float, optional
        Rotation centre of the body's degrees of freedom [m], one for each of several bodies; from ``rotation_center``
        in the file where it is there.
    body : int or str, optional
        Body to take from a file with several, by name or by number from 1; the coupling with the others is left out
        then. Three numbers as reference point are then those of this body. All bodies when absent.

    Returns
    -------
    xarray.Dataset
        Added mass [kg, kg m, kg m2], damping, forces per unit wave amplitude [N/m, N m/m] about ``reference_point``;
        see :mod:`moyai.interop.coefficients`.

    Raises
    ------
    InputError
        Not such a file; no such body; forward speed; missing reference point.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import xarray as xr
    >>> from moyai.interop import from_planar, read_capytaine
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, Water(10.0, 1025.0, 9.81), [0.5, 1.0], modes=rigid_modes((0.0, -0.2)))
    >>> unit = from_planar(found.dataset, length=20.0, centre_of_gravity=(0.0, -0.2))
    >>> forces = unit[["Froude_Krylov_force", "diffraction_force"]]
    >>> parts = xr.concat([forces.real, forces.imag], dim="complex").assign_coords(complex=["re", "im"])
    >>> file = Path(mkdtemp()) / "box.nc"
    >>> xr.merge([unit[["added_mass", "radiation_damping"]], parts]).to_netcdf(file, engine="scipy")
    >>> again = read_capytaine(file, reference_point=(0.0, 0.0, -0.2))
    >>> float(abs(again.excitation_force - unit.excitation_force).max()) < 1e-6   # [N/m]
    True
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
    raw, bodies = _named(raw)
    if "omega" not in raw.dims:
        raw = raw.expand_dims("omega") if raw["omega"].ndim == 0 else raw.swap_dims({raw["omega"].dims[0]: "omega"})
    raw = raw.transpose("omega", "wave_direction", "radiating_dof", "influenced_dof", ..., missing_dims="ignore")
    count = max(len(bodies), 1)
    if reference_point is None and "rotation_center" in raw:
        centres = np.asarray(raw["rotation_center"].values, dtype=float).ravel()
        reference_point = centres.reshape(count, 3).tolist() if centres.size == 3 * count else None
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
    points = np.atleast_2d(np.asarray(reference_point, dtype=float))
    if bodies and body is not None and points.shape == (1, 3):
        points = np.repeat(points, count, axis=0)
    dataset = assemble(
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
        reference_point=points,
        limits=_limits(raw, omega),
        hydrostatic_stiffness=raw["hydrostatic_stiffness"].transpose("influenced_dof", "radiating_dof").values
        if "hydrostatic_stiffness" in raw
        else None,
        bodies=bodies,
    )
    return dataset if body is None else one_body(dataset, body)


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


def _named(raw: xr.Dataset) -> tuple[xr.Dataset, tuple[str, ...]]:
    """Return motions and forces in one order with the names of several bodies; of one the prefix ``body__`` goes."""
    names = [str(name) for name in raw["radiating_dof"].values]
    bodies = tuple(dict.fromkeys(name.rsplit("__", 1)[0] for name in names if "__" in name))
    raw = raw.assign_coords(radiating_dof=names, influenced_dof=[str(name) for name in raw["influenced_dof"].values])
    raw = raw.sel(influenced_dof=names)
    if len(bodies) == 1:
        short = [name.rsplit("__", 1)[-1] for name in names]
        return raw.assign_coords(radiating_dof=short, influenced_dof=short), ()
    if not bodies:
        return raw, ()
    # Names within this package hold no further '__'
    plain = dict(zip(bodies, distinct(bodies)))
    full = [f"{plain[name.rsplit('__', 1)[0]]}__{name.rsplit('__', 1)[1]}" for name in names]
    return raw.assign_coords(radiating_dof=full, influenced_dof=full), tuple(plain.values())
