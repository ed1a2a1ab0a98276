"""The unit as the frequency domain sees it, and what regular and irregular seas share."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.progress import Progress
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping, QuadraticDamping
from moyai.floating.drift import DriftedMotions, DriftProblem, solve_with_drift
from moyai.floating.far_field import FarField, drift_force_per_amplitude_squared, energy_check
from moyai.floating.frequency import Motions, solve_motions
from moyai.floating.offset import mean_offset
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.hydrodynamics import UnitHydrodynamics
from moyai.structures.breakwater.lines.drag import line_drag_rows, line_inertia
from moyai.structures.breakwater.settings import MODES, LineDynamics
from moyai.structures.breakwater.viscous_damping import own_water_motion, unit_drag_rows

if TYPE_CHECKING:
    import xarray as xr

    from moyai.flexible.flow import Current


COEFFICIENT_ACCURACY = 1e-3  # of the solve of the section


@dataclass(frozen=True)
class FrequencyModel:
    """The unit as the frequency domain sees it."""

    unit: FloatingUnit
    hydro: UnitHydrodynamics
    damping: LinearDamping
    quadratic: QuadraticDamping | None
    #: Wind and current [N, N, N m]; shape (3,).
    steady: Array
    with_drift: bool
    #: How many of the first rows of ``quadratic`` are drag of lines; the others are the unit's own.
    rows_of_lines: int = 0
    #: Of lines that are in motion in time, which bring their inertia themselves there; shape (3, 3).
    line_inertia: Array = field(default_factory=lambda: np.zeros((3, 3)))
    #: Cutting of lines that are led along the motion in regular waves, and the current around them; ``None``: tangent.
    led_lines: tuple[LineDynamics, Current | None] | None = None

    @property
    def inertia(self) -> Array:
        """M of the unit with the lines that are in motion in time."""
        return np.asarray(self.unit.inertia + self.line_inertia, dtype=float)

    @property
    def stiffness(self) -> Array:
        """K_H + K_M at rest."""
        return self.unit.statics.stiffness + self.unit.mooring_stiffness


def make_model(
    unit: FloatingUnit,
    hydro: UnitHydrodynamics,
    steady: Array,
    with_drift: bool,
    fraction: float | None = None,
    led_lines: tuple[LineDynamics, Current | None] | None = None,
) -> FrequencyModel:
    """Put unit, coefficients and damping together.

    ``fraction`` of critical replaces both the case's and viscous damping computed from the section.
    """
    given = unit.breakwater.damping
    if fraction is not None and given.viscous:
        given = replace(given, viscous=False)
        unit = replace(unit, breakwater=replace(unit.breakwater, damping=given))
    zeta = given.fraction_of_critical if fraction is None else fraction
    damping = LinearDamping.of_modes(
        linear=np.array(given.linear), critical_fraction=[zeta if mode in given.modes else 0.0 for mode in MODES]
    )
    rows, coefficients = line_drag_rows(unit)
    of_lines = len(coefficients)
    own_rows, own_coefficients = unit_drag_rows(unit)
    coefficients = np.append(coefficients, own_coefficients)
    quadratic = QuadraticDamping(np.vstack([rows, own_rows]), coefficients) if len(coefficients) else None
    return FrequencyModel(unit, hydro, damping, quadratic, steady, with_drift, of_lines, line_inertia(unit), led_lines)


@dataclass(frozen=True)
class FrequencyResult:
    """A labelled dataset with what it has to say for itself."""

    dataset: xr.Dataset
    checks: tuple[IdentityCheck, ...] = ()
    notices: tuple[Notice, ...] = ()


def drift_problem(model: FrequencyModel, hydro: Hydrodynamics) -> DriftProblem:
    """Return what the loop of drift and stiffness holds fixed."""
    unit = model.unit
    return DriftProblem(
        hydrodynamics=hydro,
        inertia=model.inertia,
        hydrostatic_stiffness=unit.statics.stiffness,
        mooring=unit.mooring,
        water=unit.water,
        damping=model.damping,
        quadratic=model.quadratic,
        steady_force=model.steady,
        water_motion=water_motion(model, hydro.omega, hydro.heading[:1]),
    )


def solve_about_offset(
    model: FrequencyModel, hydro: Hydrodynamics, amplitude: Array, progress: Progress
) -> DriftedMotions:
    """Solve motions about the mean offset; without a far field the offset is that of the steady loads."""
    unit = model.unit
    if hydro.has_far_field:
        problem = drift_problem(model, hydro)
        return solve_with_drift(problem, amplitude, with_drift=model.with_drift, progress=progress)
    offset = mean_offset(unit.mooring, unit.statics.stiffness, model.steady)
    stiffness = unit.mooring.stiffness(offset.position)
    motions = solve_motions(
        hydro,
        model.inertia,
        unit.statics.stiffness + stiffness,
        damping=model.damping,
        quadratic=model.quadratic,
        wave_amplitude=amplitude[:, None],
        water_motion=water_motion(model, hydro.omega, hydro.heading),
    )
    count = len(hydro.omega)
    nothing = np.full((count, 1), np.nan)
    return DriftedMotions(
        motions=motions,
        far=FarField(nothing.astype(complex), nothing.astype(complex), nothing, nothing),
        drift_force=np.zeros(count),
        offset=np.tile(offset.position, (count, 1)),
        mooring_stiffness=np.tile(stiffness, (count, 1, 1)),
        iterations=np.ones(count),
        status=(offset.status,) * count,
        notices=(
            Notice(
                "no-drift-of-given-coefficients",
                "coefficients of a 3-D program have no far field: no reflection, transmission or drift is computed",
                severity="information",
            ),
        ),
    )


def energy_identity(
    model: FrequencyModel, far: FarField, motions: Motions, hydro: Hydrodynamics, where: str
) -> tuple[IdentityCheck, ...]:
    """Compare the loss of the moving body with the work of its damping, to the accuracy of the coefficients.

    A damping lid takes energy of its own, which the solve of the section holds against its own identity.
    """
    if model.unit.breakwater.gap_damping_lid:
        return ()
    found = energy_check(far, motions, model.unit.water, hydro.length, COEFFICIENT_ACCURACY)
    return (replace(found, name=f"{where}: energy of the moving body"),)


def far_field_variables(
    far: FarField, hydro: Hydrodynamics, unit: FloatingUnit, dims: tuple[str, ...]
) -> dict[str, Any]:
    """Return magnitudes of reflection and transmission, and the drift [eq:breakwater-drift-coefficient]."""
    drift = drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, unit.water, hydro.length)
    return {
        "reflection_coefficient": (dims, np.abs(far.reflection_coefficient[:, 0])),
        "transmission_coefficient": (dims, np.abs(far.transmission_coefficient[:, 0])),
        "dissipation": (dims, far.loss[:, 0]),
        "drift_coefficient": (dims, far.drift_coefficient[:, 0]),
        "mean_drift_force_per_amplitude_squared": (dims, drift[:, 0]),
    }


def motion_ratio(unit: FloatingUnit, amplitude: Array, height: float) -> Array:
    """Return |x|/(H/2), |z|/(H/2) and |theta| B/H (P3 equation 6)."""
    scale = np.array([2.0, 2.0, unit.breakwater.hull.beam])
    return np.asarray(amplitude * scale / height if height > 0.0 else np.full_like(amplitude, np.nan))


def worst_status(status: tuple[str, ...]) -> str:
    return "converged" if all(item == "converged" for item in status) else "not_converged"


def water_motion(model: FrequencyModel, omega: Array, headings: Array) -> ComplexArray | None:
    """Return the undisturbed wave in the measures of the model's quadratic damping (n, h, k); ``None``: still water."""
    if model.quadratic is None or not model.unit.breakwater.damping.viscous:
        return None
    own = own_water_motion(model.unit, omega[:, None], np.asarray(headings, dtype=float)[None, :])
    return np.concatenate([np.zeros((*own.shape[:2], model.rows_of_lines)), own], axis=2)
