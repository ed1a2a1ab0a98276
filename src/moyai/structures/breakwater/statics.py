"""The unit at rest: balance, stiffness, natural periods, lines, and everything needed to draw it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validity import Notice
from moyai.floating.modes import NaturalModes, natural_modes
from moyai.floating.offset import mean_offset
from moyai.mooring.lines import LineElement
from moyai.mooring.shape import even_points
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.hydrodynamics import UnitHydrodynamics
from moyai.structures.breakwater.model import MooringLine
from moyai.structures.breakwater.settings import MODES
from moyai.structures.breakwater.variables import VOCABULARY, labelled

if TYPE_CHECKING:
    import xarray as xr


LINE_POINTS = 60
SHIFTS_X, SHIFTS_Z = 15, 7  # displacements of the fairlead for which shapes are stored
CURVE_POINTS = 61


def statics_dataset(
    unit: FloatingUnit, hydro: UnitHydrodynamics | None, wind: Array, current: Array
) -> tuple[xr.Dataset, tuple[Notice, ...]]:
    """Return the group ``statics`` of a water level and its notices.

    Parameters
    ----------
    unit : FloatingUnit
    hydro : UnitHydrodynamics or None
        For natural periods; left out without.
    wind, current : ndarray (3,)
        Their steady forces [N, N, N m].
    """
    steady = wind + current
    breakwater, statics = unit.breakwater, unit.statics
    offset = mean_offset(unit.mooring, statics.stiffness, steady)
    matrix = ("influenced_dof", "radiating_dof")
    outline_x, outline_z = unit.section.drawn().T
    out: dict[str, Any] = {
        "draught": ((), -unit.section.keel),
        "body_mass": ((), unit.mass),
        "displaced_mass": ((), statics.displaced_mass),
        "line_vertical_pull": ((), unit.line_pull),
        "imbalance": ((), unit.imbalance),
        "heel": ((), unit.heel),
        "metacentric_height": ((), statics.metacentric_height),
        "freeboard": ((), unit.freeboard),
        "centre_of_gravity_x": ((), unit.centre[0]),
        "centre_of_gravity_z": ((), unit.centre[1]),
        "beam": ((), breakwater.hull.beam),
        "section_height": ((), breakwater.hull.height),
        "unit_length": ((), breakwater.length),
        "steady_force": ("dof", steady),
        "steady_force_of_wind": ("dof", wind),
        "steady_force_of_current": ("dof", current),
        "steady_offset": ("dof", offset.position),
        "hydrostatic_stiffness": (matrix, statics.stiffness),
        "mooring_stiffness": (matrix, unit.mooring_stiffness),
        "inertia_matrix": (matrix, unit.inertia),
        "outline_x": ("outline_point", outline_x),
        "outline_z": ("outline_point", outline_z),
    }
    notices: list[Notice] = []
    if offset.status != "converged":
        notices.append(
            Notice(
                "no-steady-offset",
                f"{unit.name}: nothing balances wind and current ({steady[0]:.4g} N)",
                float(steady[0]),
                severity="error",
                remedy="add lines or shorten them",
            )
        )
    if hydro is not None:
        moored = natural_modes(hydro.unit, unit.inertia, statics.stiffness + unit.mooring_stiffness)
        free = natural_modes(hydro.unit, unit.inertia, statics.stiffness)
        out |= _modes(moored, free)
        notices.extend(moored.notices)
    out |= _lines(unit)
    coords = {
        "dof": list(MODES),
        "influenced_dof": list(MODES),
        "radiating_dof": list(MODES),
        "mode": list(MODES),
        "line": [line.name for line in unit.lines],
    }
    return VOCABULARY.dataset(out, coords), tuple(notices)


def _modes(moored: NaturalModes, free: NaturalModes) -> dict[str, Any]:
    return {
        "natural_period": ("mode", moored.period),
        "natural_period_without_lines": ("mode", free.period),
        "mode_shape": (("mode", "dof"), moored.shape),
        "damping_ratio": ("mode", moored.damping_ratio),
    }


def _lines(unit: FloatingUnit) -> dict[str, Any]:
    """Return what is known of the lines at rest, one entry a kind; shapes in site axes."""
    kinds = len(unit.lines)
    if not kinds:
        return {}
    centre = np.array([unit.centre[0], 0.0, unit.centre[1]])
    states = unit.mooring.planar.states(np.zeros(3))
    names = {
        "fairlead_tension": "tension_fairlead",
        "anchor_tension": "tension_anchor",
        "anchor_horizontal_tension": "horizontal_tension",
        "fairlead_vertical_tension": "vertical_tension_fairlead",
        "anchor_vertical_tension": "vertical_tension_anchor",
        "grounded_length": "grounded_length",
    }
    out: dict[str, Any] = {
        ours: ("line", np.array([getattr(state, theirs)[0] for state in states.values()]))
        for ours, theirs in names.items()
    }
    load = np.array([line.breaking_load for line in unit.lines])
    known = np.isfinite(load)
    fairleads = np.array([line.fairlead for line in unit.lines]) + centre
    anchors = np.array([line.anchor for line in unit.lines]) + centre
    shapes = np.array([line_points(unit, line, np.zeros(3)) for line in unit.lines])
    x, z = shapes[:, :, 0], shapes[:, :, 1]
    out |= {
        "line_count": ("line", np.array([line.count for line in unit.lines])),
        "unstretched_length": ("line", np.array([_length(line) for line in unit.breakwater.lines])),
        "breaking_load": ("line", np.where(known, load, np.nan)),
        "utilisation": ("line", np.where(known, out["fairlead_tension"][1] / load, np.nan)),
        "fairlead_x": ("line", fairleads[:, 0]),
        "fairlead_z": ("line", fairleads[:, 2]),
        "anchor_x": ("line", anchors[:, 0]),
        "anchor_z": ("line", anchors[:, 2]),
        "line_x": (("line", "line_point"), x),
        "line_z": (("line", "line_point"), z),
    }
    return out


def line_points(unit: FloatingUnit, line: LineElement, shift: Array) -> Array:
    """Return a line as evenly spaced points (LINE_POINTS, 2) in site axes, its fairlead moved by ``shift`` [m]."""
    centre = np.array([unit.centre[0], 0.0, unit.centre[1]])
    fairlead = np.asarray(line.fairlead) + shift
    points: Array = even_points(line, fairlead, unit.water.depth + unit.centre[1], LINE_POINTS) + centre
    return points[:, [0, 2]]


def moving_shapes(unit: FloatingUnit, runs: list[xr.Dataset]) -> xr.Dataset | None:
    """Return the shapes of the lines for displacements of their fairleads, as far as time-domain runs moved them.

    For drawing: a player interpolates between them. ``None`` without lines or runs.
    """
    import xarray as xr

    if not unit.lines or not runs:
        return None
    moved = np.max([np.abs(run["position"].values).max(axis=0) for run in runs], axis=0)
    arm = np.max(np.abs([line.fairlead for line in unit.lines]), axis=0)
    least = 1e-3 * unit.breakwater.hull.beam
    reach_x = max(1.05 * float(moved[0] + moved[2] * arm[2]), least)
    reach_z = max(1.05 * float(moved[1] + moved[2] * arm[0]), least)
    shift_x, shift_z = np.linspace(-reach_x, reach_x, SHIFTS_X), np.linspace(-reach_z, reach_z, SHIFTS_Z)
    table = np.array(
        [[[line_points(unit, line, np.array([x, 0.0, z])) for z in shift_z] for x in shift_x] for line in unit.lines]
    )
    dims = ("line", "shift_x", "shift_z", "line_point")
    data = xr.Dataset(
        {"line_shape_x": (dims, table[..., 0]), "line_shape_z": (dims, table[..., 1])},
        coords={"line": [line.name for line in unit.lines], "shift_x": shift_x, "shift_z": shift_z},
    )
    return labelled(data)


def _length(line: object) -> float:
    return sum(segment.length for segment in line.segments) if isinstance(line, MooringLine) else math.nan


def mooring_dataset(unit: FloatingUnit, offsets: Array | None) -> xr.Dataset:
    """Return the group ``mooring``: restoring force and tensions against sway offset.

    Parameters
    ----------
    unit : FloatingUnit
    offsets : ndarray or None
        [m]; by default as far as the stiffest line allows before it carries a hundred times its tension at rest, or its
        breaking load.
    """
    import xarray as xr

    reach = default_offsets(unit) if offsets is None else np.sort(np.asarray(offsets, dtype=float))
    path = reach[:, None] * np.array([1.0, 0.0, 0.0])
    planar = unit.mooring.planar
    force = planar.forces(path)
    states = planar.states(path)
    kinds = len(unit.lines)

    def column(name: str) -> Array:
        return np.array([getattr(state, name) for state in states.values()]).reshape(kinds, len(reach))

    out = {
        "restoring_force": ("offset", force[:, 0]),
        "vertical_force": ("offset", force[:, 1]),
        "line_tension": (("line", "offset"), column("tension_fairlead")),
        "anchor_horizontal_tension": (("line", "offset"), column("horizontal_tension")),
        "anchor_vertical_tension": (("line", "offset"), column("vertical_tension_anchor")),
        "mooring_stiffness": (
            "offset",
            planar.stiffness(path)[:, 0, 0],
            {"units": "N/m", "long_name": "tangent stiffness in sway"},
        ),
    }
    return labelled(xr.Dataset(out, coords={"offset": reach, "line": [line.name for line in unit.lines]}))


def default_offsets(unit: FloatingUnit) -> Array:
    """Return offsets that show the mooring from slack to nearly taut [m]."""
    rest = unit.mooring.planar.tensions(np.zeros(3))
    load = np.array([line.breaking_load for line in unit.lines])
    limit = np.where(np.isfinite(load), np.minimum(load, 30.0 * rest), 30.0 * rest)
    limit = np.maximum(limit, 2.0 * rest)
    low, high = 0.0, 0.5 * unit.breakwater.hull.beam
    for _ in range(50):
        middle = 0.5 * (low + high)
        pull = np.maximum(
            unit.mooring.planar.tensions(np.array([middle, 0.0, 0.0])),
            unit.mooring.planar.tensions(np.array([-middle, 0.0, 0.0])),
        )
        low, high = (middle, high) if np.all(pull <= limit) else (low, middle)
    reach = max(low, 1e-3 * unit.breakwater.hull.beam)
    return np.linspace(-reach, reach, CURVE_POINTS)
