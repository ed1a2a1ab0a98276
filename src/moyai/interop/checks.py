"""Identities that coefficients of any program must obey: a wrong sign or time factor shows here, not in the motions."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import xarray as xr

from moyai.core.validity import IdentityCheck, Notice
from moyai.interop.bodies import each_body
from moyai.sea.dispersion import wave_number


def check_coefficients(dataset: xr.Dataset, *, tolerance: float = 0.05) -> tuple[IdentityCheck, ...]:
    """Hold symmetry and passivity against coefficients of :mod:`moyai.interop.coefficients`.

    Parameters
    ----------
    dataset : xarray.Dataset
    tolerance : float
        Accepted violation; panel programs reach a few per cent on coarse meshes and near irregular frequencies.

    Returns
    -------
    tuple of IdentityCheck
        Symmetry of added mass and damping, damping that takes no energy out of still water.
    """
    added_mass, damping = dataset["added_mass"].values, dataset["radiation_damping"].values
    scale = np.sqrt(np.abs(np.einsum("nii,njj->nij", added_mass, added_mass)))
    floor = 1e-6 * scale.max(axis=0, keepdims=True) + 1e-30 * scale.max()
    return (
        IdentityCheck(
            "symmetry of the added mass",
            float(np.max(np.abs(added_mass - added_mass.transpose(0, 2, 1)) / np.maximum(scale, floor))),
            tolerance,
            "A_ij = A_ji, relative to (A_ii A_jj)^(1/2)",
        ),
        IdentityCheck(
            "symmetry of the radiation damping",
            _relative(np.abs(damping - damping.transpose(0, 2, 1)), damping),
            tolerance,
            "B_ij = B_ji, relative to the largest (B_ii B_jj)^(1/2)",
        ),
        IdentityCheck(
            "radiation takes energy from the body",
            _relative(np.maximum(-np.einsum("nii->ni", damping), 0.0)[:, :, None] * np.eye(damping.shape[1]), damping),
            tolerance,
            "B_ii >= 0, relative to the largest B_ii",
        ),
    )


def import_notices(dataset: xr.Dataset) -> tuple[Notice, ...]:
    """Return what the identities and the long waves say against coefficients that were read from files.

    Parameters
    ----------
    dataset : xarray.Dataset
        From :func:`moyai.interop.read.read_coefficients`.

    Returns
    -------
    tuple of Notice
        A warning for each identity that fails (irregular frequencies, coarse mesh, wrong file), an error for a force
        with another time factor or direction.
    """
    failed = [check for check in check_coefficients(dataset) if not check.passed]
    dropped = int(dataset.attrs.get("dropped_frequencies", 0))
    return (
        *(
            (
                Notice(
                    "coefficients-dropped",
                    f"coefficients from files: the {dropped} lowest frequencies are no numbers and were left out; the "
                    f"lowest left is {dataset['omega'].values[0]:.4g} rad/s",
                    severity="information",
                ),
            )
            if dropped
            else ()
        ),
        *(
            Notice(
                "coefficients-identity",
                f"coefficients from files: {check.name} is off by {100.0 * check.value:.2g} % ({check.meaning})",
                check.value,
                check.tolerance,
                "warning",
                "leave out the irregular frequencies, refine the mesh, or check that the files belong together",
            )
            for check in failed
        ),
        *(
            notice if name is None else replace(notice, message=f"body '{name}': {notice.message}")
            for name, part in each_body(dataset)
            for notice in check_time_convention(part)
        ),
    )


def _relative(violation: np.ndarray, damping: np.ndarray) -> float:
    """Return the largest violation relative to the band maximum of the diagonal terms."""
    peak = np.max(np.abs(np.einsum("nii->ni", damping)), axis=0)
    # Motions that make no waves (yaw of a body of revolution) are compared with a millionth of the others' scale
    peak = np.maximum(peak, 1e-6 * peak.max())
    return float(np.max(violation / np.sqrt(peak[:, None] * peak[None, :])))


def check_time_convention(dataset: xr.Dataset) -> tuple[Notice, ...]:
    """Tell when the exciting force at the lowest frequency speaks against ``exp(-i omega t)``.

    In long waves the heave force of a floating body is the stiffness rho g A_w times the surface, so its real part is
    positive; the force along the waves follows the acceleration, rho g k V (1 + C_a) times -i. The other time factor or
    the opposite direction of travel turns its sign. Submerged bodies have no such heave force and are judged by
    the horizontal force alone. Equation [eq:long-wave-force].
    """
    notices = []
    low = dataset.isel(omega=0)
    names = [str(name) for name in dataset["influenced_dof"].values]
    forces = low["excitation_force"].values
    for j, angle in enumerate(low["wave_direction"].values):
        for name, part in (("Surge", math.cos(angle)), ("Sway", math.sin(angle))):
            if name in names and abs(part) > 0.4:
                force = forces[j, names.index(name)]
                # Its size falls with the cosine of the direction, its phase does not
                if -force.imag * math.copysign(1.0, part) < 0.5 * abs(force):
                    notices.append(
                        Notice(
                            "time-convention",
                            f"the {name.lower()} force at {low['omega'].item():.4g} rad/s and "
                            f"{math.degrees(angle):.4g} degrees does not follow the acceleration of the water: "
                            "another time factor, direction or phase origin?",
                            value=float(np.angle(force)),
                            limit=-0.5 * math.pi * math.copysign(1.0, part),
                            severity="error",
                            remedy="check the conventions of the program that wrote the file",
                        )
                    )
        if "Heave" in names and "hydrostatic_stiffness" in dataset:
            i = names.index("Heave")
            stiffness = float(dataset["hydrostatic_stiffness"].values[i, i])
            # Only where the lowest wave is much longer than the waterplane is wide
            size = math.sqrt(stiffness / (low["rho"].item() * low["g"].item())) if stiffness > 0.0 else math.inf
            number = float(wave_number(low["omega"].item(), low["water_depth"].item(), low["g"].item()))
            if number * size < 0.05 and abs(forces[j, i] - stiffness) > 0.5 * stiffness:
                notices.append(
                    Notice(
                        "long-wave-heave",
                        f"the heave force at {low['omega'].item():.4g} rad/s is {forces[j, i]:.4g} N/m, "
                        f"the heave stiffness {stiffness:.4g} N/m: they agree in long waves",
                        value=float(abs(forces[j, i])),
                        limit=stiffness,
                        remedy="check units and sign of the file, or whether its lowest frequency is low enough",
                    )
                )
    return tuple(notices)
