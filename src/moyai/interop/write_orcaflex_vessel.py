"""A vessel of OrcaFlex (text data) from the result of a floating breakwater: mass, stiffness, coefficients, load RAOs.

Names of data, signs and the layout of the tables are those of text data files that the program itself saves and of its
documentation (*Vessel types*, *Text data files*). Vessel axes: x along the crest, y along the travel of the waves, z up
from still water; waves at 90 degrees. SI units of the program: te, kN, m, s, degrees.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import xarray as xr

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.interop.coefficients import DOFS
from moyai.interop.whole_body import coefficients_of_result, level_of_result
from moyai.interop.write_orcaflex import THOUSAND, UNREAD, text_of

_AXES = ("X", "Y", "Z", "Rx", "Ry", "Rz")
_ADDED_MASS = ", ".join(f"AddedMassMatrix{axis}" for axis in _AXES)
_DAMPING = ", ".join(f"Damping{axis}" for axis in _AXES)
_RAOS = ", ".join(["RAOPeriodOrFrequency", *(f"RAO{dof}{part}" for dof in DOFS for part in ("Amp", "Phase"))])
_STIFFNESS = "HydrostaticStiffnessz, HydrostaticStiffnessRx, HydrostaticStiffnessRy"
_INERTIA = "MomentOfInertiaTensorX, MomentOfInertiaTensorY, MomentOfInertiaTensorZ"
_CONVENTIONS = {
    "RAOResponseUnits": "radians",
    "RAOWaveUnit": "amplitude",
    "WavesReferredToBy": "period (s)",
    "RAOPhaseConvention": "lags",
    "RAOPhaseUnitsConvention": "degrees",
    "RAOPhaseRelativeToConvention": "crest",
    "SurgePositive": "forward",
    "SwayPositive": "port",
    "HeavePositive": "up",
    "RollPositiveStarboard": "down",
    "PitchPositiveBow": "down",
    "YawPositiveBow": "port",
    "Symmetry": "None",
}
_LEFT_OUT = (
    UNREAD,
    "surge, pitch and yaw have no coefficients: a section knows waves square to the crest alone",
    "inertia in pitch and yaw is that of a uniform bar of the unit's length",
    "viscous damping, drift, wind, current and lines are left out",
)


def orcaflex_vessel(result: Result, water_level: str | None = None) -> tuple[str, tuple[str, ...]]:
    """Return the text data file of the unit, and what it leaves out.

    Parameters
    ----------
    result : Result
        Of a floating breakwater with the analysis ``frequency`` or ``time``.
    water_level : str, optional
        The first level when left out.

    Raises
    ------
    InputError
        For a row of units, or when the result holds no coefficients.
    """
    level = level_of_result(result, water_level)
    statics = result.tree.children[level].children["statics"].to_dataset(inherit=False)
    if "inertia_matrix" not in statics:
        raise InputError(
            "a vessel type is one body, the result is of a row of units", path="results",
            allowed="results of a floating breakwater", remedy="write the row with --to wamit, nemoh or bemio",
        )  # fmt: skip
    found = coefficients_of_result(result, water_level=level, sea="beam")
    x, y, z = (float(value) for value in np.ravel(found["reference_point"].values))
    inertia = statics["inertia_matrix"]
    mass, roll = (float(inertia.sel(influenced_dof=mode, radiating_dof=mode)) for mode in ("sway", "roll"))
    bar = mass * float(statics["unit_length"]) ** 2 / 12.0
    draught: dict[str, Any] = {
        "Name": level,
        "Mass": mass / THOUSAND,
        _INERTIA: (np.diag([roll, bar, bar]) / THOUSAND).tolist(),
        "CentreOfMass": [x, y, z],
        "LoadRAOs": {"RAOOrigin": [x, y, z], "PhaseOrigin": [0.0, 0.0, 0.0], "RAOs": _load_raos(found)},
        "AMDMethod": "Frequency dependent",
        "ReferenceOrigin": [x, y, z],
        "ReferenceOriginDatumPosition": [z, 0.0, 0.0],
        "HydrostaticStiffnessMethod": "Displacement",
        _STIFFNESS: (_whole(found["hydrostatic_stiffness"])[2:5, 2:5] / THOUSAND).tolist(),
        "FrequencyDependentAddedMassAndDamping": _added_mass_and_damping(found),
    }
    environment: dict[str, Any] = {"Density": float(found["rho"]) / THOUSAND}
    if math.isfinite(depth := float(found["water_depth"])):
        environment["WaterDepth"] = depth
    kind = {
        "Name": "Unit",
        "Length": float(statics["unit_length"]),
        **_CONVENTIONS,
        "Draughts": [draught],
    }
    vessel = {
        "Name": "Unit1",
        "VesselType": "Unit",
        "Draught": level,
        "InitialPosition": [0.0, 0.0, 0.0],
        "Orientation": [0.0, 0.0, 0.0],
        "PrimaryMotion": "Calculated (6 DOF)",
        "SuperimposedMotion": "None",
        "IncludeWaveLoad1stOrder": "Yes",
        "IncludeAddedMassAndDamping": "Yes",
        "IncludeWaveDriftLoad2ndOrder": "No",
        "IncludeOtherDamping": "No",
        "IncludeCurrentLoad": "No",
        "IncludeWindLoad": "No",
    }
    model = {"General": {"UnitsSystem": "SI"}, "Environment": environment, "VesselTypes": [kind], "Vessels": [vessel]}
    return text_of(model), _LEFT_OUT


def _places(found: xr.Dataset | xr.DataArray) -> list[int]:
    return [DOFS.index(str(name)) for name in found["influenced_dof"].values]


def _whole(values: xr.DataArray) -> Array:
    """Return a matrix (influenced, radiating) of all six motions; those that the section lacks are zero."""
    matrix = np.zeros((6, 6))
    places = _places(values)
    matrix[np.ix_(places, places)] = values.transpose("influenced_dof", "radiating_dof").values
    return matrix


def _added_mass_and_damping(found: xr.Dataset) -> list[dict[str, Any]]:
    return [
        {
            "AMDPeriodOrFrequency": float(found["period"].values[row]),
            _ADDED_MASS: (_whole(found["added_mass"][row]) / THOUSAND).tolist(),
            _DAMPING: (_whole(found["radiation_damping"][row]) / THOUSAND).tolist(),
        }
        for row in np.argsort(found["period"].values)
    ]


def _load_raos(found: xr.Dataset) -> list[dict[str, Any]]:
    """Return amplitudes [kN/m, kN m/m] and lags [degrees] behind the crest at the origin, the angle of X."""
    force = found["excitation_force"].transpose("wave_direction", "omega", "influenced_dof").values
    period = found["period"].values
    tables = []
    for heading, values in zip(np.degrees(found["wave_direction"].values), force, strict=True):
        table = np.zeros((period.size, 13))
        table[:, 0] = period
        for place, column in zip(_places(found), values.T, strict=True):
            table[:, 1 + 2 * place] = np.abs(column) / THOUSAND
            table[:, 2 + 2 * place] = np.degrees(np.angle(column))
        tables.append({"RAODirection": float(heading) % 360.0, _RAOS: table[np.argsort(period)].tolist()})
    return tables
