"""A vessel of OrcaFlex (text data) from the result of a floating breakwater: mass, stiffness, coefficients, load RAOs.

Names of data, signs and the layout of the tables are those of text data files that the program itself saves and of its
documentation (*Vessel types*, *Text data files*). Vessel axes: x along the crest, y along the travel of the waves, z up
from still water; waves at 90 degrees. SI units of the program: te, kN, m, s, degrees.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.results import Result
from moyai.interop.coefficients import DOFS
from moyai.interop.moordyn_deck import DeckLineType, MoorDynDeck
from moyai.interop.whole_body import coefficients_of_result, level_of_result
from moyai.interop.write_orcaflex import THOUSAND, UNREAD, line_data, line_type_data, orcaflex_model, text_of

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
    "surge, pitch and yaw have no coefficients: a section is for waves at right angles to its axis only",
    "inertia in pitch and yaw is that of a uniform bar of the unit's length",
    "viscous damping, drift, wind and current are left out",
)
NAME = "Unit1"
"""Of the vessel, to which lines are connected."""


def orcaflex_vessel(
    result: Result, water_level: str | None = None, moorings: Moorings | None = None
) -> tuple[str, tuple[str, ...]]:
    """Return the text data file of the unit with its lines, and what it leaves out.

    Parameters
    ----------
    result : Result
        Of a floating breakwater with the analysis ``frequency`` or ``time``.
    water_level : str, optional
        The first level when left out.
    moorings : Moorings, optional
        No lines when left out.

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
    vessel = _vessel(NAME, "Unit", level, [0.0, 0.0, 0.0], wave_loads=True)
    model = {"General": {"UnitsSystem": "SI"}, "Environment": environment, "VesselTypes": [kind], "Vessels": [vessel]}
    if moorings is None:
        return text_of(model), (*_LEFT_OUT, "the lines are left out")
    lines = [_mooring(line) for line in moorings.lines]
    if lines:
        used = {kind for line in moorings.lines for kind, _, _ in line.sections}
        model |= {"LineTypes": [line_type_data(kind) for kind in moorings.types if kind.name in used], "Lines": lines}
    return text_of(model), (*_LEFT_OUT, *moorings.notes)


def _vessel(name: str, kind: str, draught: str, position: Sequence[float], *, wave_loads: bool) -> dict[str, Any]:
    return {
        "Name": name,
        "VesselType": kind,
        "Draught": draught,
        "InitialPosition": list(position),
        "Orientation": [0.0, 0.0, 0.0],
        "PrimaryMotion": "Calculated (6 DOF)",
        "SuperimposedMotion": "None",
        "IncludeWaveLoad1stOrder": "Yes" if wave_loads else "No",
        "IncludeAddedMassAndDamping": "Yes",
        "IncludeWaveDriftLoad2ndOrder": "No",
        "IncludeOtherDamping": "No",
        "IncludeCurrentLoad": "No",
        "IncludeWindLoad": "No",
    }


@dataclass(frozen=True)
class FloatingBox:
    """A body of a network as a vessel takes it: mass, stiffness and a constant added mass, in axes from its middle."""

    name: str
    #: Of its middle, z above still water [m].
    position: tuple[float, float, float]
    length: float
    mass: float
    #: About the centre of gravity [kg m2].
    inertia: tuple[float, float, float]
    centre_of_gravity: tuple[float, float, float]
    #: Heave, roll, pitch about the centre of gravity [N/m, N m/rad].
    stiffness: tuple[float, float, float]
    #: Along its axes [kg].
    added_mass: tuple[float, float, float]
    #: Places that lines meet, from its middle [m].
    points: tuple[tuple[float, float, float], ...]


def orcaflex_network(deck: MoorDynDeck, boxes: Sequence[FloatingBox]) -> tuple[str, tuple[str, ...]]:
    """Return the text data file of a deck's lines with the bodies that they hold, and what it leaves out.

    Parameters
    ----------
    deck : MoorDynDeck
        Its coupled points at places of a body are connected to the body.
    boxes : sequence of FloatingBox

    Raises
    ------
    InputError
        See :func:`moyai.interop.write_orcaflex.orcaflex_model`.
    """
    held = {}
    for box in boxes:
        for point in box.points:
            at = np.add(box.position, point)
            near = [one.number for one in deck.points if np.allclose(one.position, at, atol=1e-6)]
            held.update(dict.fromkeys(near, (box.name, point)))
    model, notes = orcaflex_model(deck, held)
    kinds = [_box_type(box) for box in boxes]
    vessels = [
        _vessel(box.name, str(kind["Name"]), draught, box.position, wave_loads=False)
        for box, (kind, draught) in zip(boxes, kinds, strict=True)
    ]
    # what is connected to stands before what connects to it
    first = {name: model.pop(name) for name in ("General", "Environment")}
    model = {**first, "VesselTypes": [kind for kind, _ in kinds], "Vessels": vessels, **model}
    left = "wave loads, drag and wave radiation of the bodies are left out: add them in OrcaFlex"
    return text_of(model), (*notes, left)


def _box_type(box: FloatingBox) -> tuple[dict[str, Any], str]:
    """Return a vessel type without wave loads, and the name of its draught."""
    heave, roll, pitch = (value / THOUSAND for value in box.stiffness)
    added = (np.diag([*box.added_mass, 0.0, 0.0, 0.0]) / THOUSAND).tolist()
    height = box.position[2] + box.centre_of_gravity[2]
    draught: dict[str, Any] = {
        "Name": "Draught1",
        "Mass": box.mass / THOUSAND,
        _INERTIA: (np.diag(box.inertia) / THOUSAND).tolist(),
        "CentreOfMass": list(box.centre_of_gravity),
        "AMDMethod": "Frequency dependent",
        "ReferenceOrigin": list(box.centre_of_gravity),
        "ReferenceOriginDatumPosition": [height, 0.0, 0.0],
        "HydrostaticStiffnessMethod": "Displacement",
        _STIFFNESS: np.diag([heave, roll, pitch]).tolist(),
        "FrequencyDependentAddedMassAndDamping": [
            {"AMDPeriodOrFrequency": period, _ADDED_MASS: added, _DAMPING: np.zeros((6, 6)).tolist()}
            for period in (1.0, 100.0)
        ],
    }
    return {"Name": f"{box.name} type", "Length": box.length, **_CONVENTIONS, "Draughts": [draught]}, "Draught1"


@dataclass(frozen=True)
class MooringOfUnit:
    """A line between the unit and the bed, in the axes of the site."""

    name: str
    #: Fairlead, z from still water [m].
    fairlead: tuple[float, float, float]
    #: Anchor, z from still water [m].
    anchor: tuple[float, float, float]
    #: Line type, length and longest segment [m], from the fairlead.
    sections: tuple[tuple[str, float, float], ...]


@dataclass(frozen=True)
class Moorings:
    """The lines of a unit."""

    types: tuple[DeckLineType, ...]
    lines: tuple[MooringOfUnit, ...]
    #: What is left out.
    notes: tuple[str, ...] = ()


def _mooring(line: MooringOfUnit) -> dict[str, Any]:
    """Return a line in the axes of the vessel, x along the crest: a quarter turn from those of the site."""
    ends = [(held, (-y, x, z)) for held, (x, y, z) in ((NAME, line.fairlead), ("Fixed", line.anchor))]
    return line_data(line.name, ends, line.sections)


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
