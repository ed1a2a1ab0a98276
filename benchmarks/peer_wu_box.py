"""Compute the coefficients of the box of Wu et al. with Capytaine and write tests/validation/data/wu_box_capytaine.nc.

Run it with a Python that has capytaine (3.0):
``python benchmarks/peer_wu_box.py tests/validation/data/wu_box_capytaine.nc``.
Box 0.2 x 0.2 m, draught 0.0787 m, 0.5 m of fresh water, 520 panels with a lid; about half a minute.
"""

from __future__ import annotations

import sys

import numpy as np


def main(path: str) -> None:
    """Solve and write."""
    import capytaine
    import xarray as xr
    from capytaine.io.xarray import separate_complex_values

    beam, draught, centre = 0.2, 0.0787, -0.0126
    mesh = capytaine.mesh_parallelepiped(
        size=(beam, beam, draught), resolution=(14, 14, 6), center=(0, 0, -0.5 * draught), missing_sides={"top"}
    )
    body = capytaine.FloatingBody(
        mesh=mesh, lid_mesh=mesh.generate_lid(), dofs=capytaine.rigid_body_dofs(rotation_center=(0, 0, centre)),
        center_of_mass=(0, 0, centre), name="box",
    )  # fmt: skip
    low = [0.8, 1.2, 1.6, 2.0, 2.4, 2.8, np.pi, 3.5]
    omega = np.concatenate([low, np.arange(4.0, 14.1, 0.5), [15, 16, 17, 18, 20, 22, 25, 28, 32, np.inf]])
    problem = xr.Dataset(
        coords={
            "omega": omega, "wave_direction": np.radians(np.arange(0, 360, 45)), "radiating_dof": list(body.dofs),
            "water_depth": [0.5], "rho": [1000.0], "g": [9.81],
        }
    )  # fmt: skip
    solved = capytaine.BEMSolver().fill_dataset(problem, body, n_jobs=1)
    solved["hydrostatic_stiffness"] = body.compute_hydrostatic_stiffness(rho=1000.0, g=9.81)
    keep = ["added_mass", "radiation_damping", "excitation_force", "hydrostatic_stiffness"]
    out = separate_complex_values(solved[keep]).drop_vars(
        ["freq", "period", "wavenumber", "wavelength", "body"], errors="ignore"
    )
    out["rotation_center"] = ("point_coordinate", [0.0, 0.0, centre])
    version = solved.attrs["capytaine_version"]
    out.attrs = {
        "capytaine_version": version,
        "source": f"Capytaine {version}: benchmarks/peer_wu_box.py; box of Wu et al. (2018), draught without lines",
    }
    for name in out.variables:
        out[name].attrs = {}
    out.to_netcdf(path)


if __name__ == "__main__":
    main(sys.argv[1])
