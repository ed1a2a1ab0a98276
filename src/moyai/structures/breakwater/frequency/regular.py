"""Operators, and regular seas with drift and stiffness solved together."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.drift import DriftedMotions
from moyai.floating.far_field import far_field
from moyai.structures.breakwater.frequency.about_rest import (
    band_factors,
    band_words,
    equivalent_variables,
    motions_about_rest,
    scaled_damping,
)
from moyai.structures.breakwater.frequency.equivalent_lines import about_led_lines
from moyai.structures.breakwater.frequency.model import (
    FrequencyModel,
    FrequencyResult,
    energy_identity,
    far_field_variables,
    motion_ratio,
    solve_about_offset,
    worst_status,
)
from moyai.structures.breakwater.hydrodynamics import wavelengths
from moyai.structures.breakwater.model import RegularSea, SeaState
from moyai.structures.breakwater.responses import (
    deck_relative_elevation,
    line_tensions,
    overtopping_notices,
)
from moyai.structures.breakwater.screening import transmission_macagno, transmission_ruol, transmission_wiegel
from moyai.structures.breakwater.settings import MODES
from moyai.structures.breakwater.variables import VOCABULARY


def operators(model: FrequencyModel, omega: Array, heading: float, seas: tuple[SeaState, ...] = ()) -> FrequencyResult:
    """Response operators per metre of wave amplitude about the rest position, without drift.

    Quadratic damping needs an amplitude: viscous damping computed from the section takes that of the first irregular
    sea of ``seas`` or of the first regular one; other quadratic damping is left out here.
    """

    unit, whole = model.unit, model.hydro.whole(heading)
    # Coefficients of another program may end earlier than the operators would
    omega = omega[(omega >= whole.omega[0]) & (omega <= whole.omega[-1])] if model.hydro.solution is None else omega
    hydro = model.hydro.at(omega, heading)
    motions, linearised = motions_about_rest(model, hydro, seas)
    rao = motions.displacement[:, 0, :]
    out: dict[str, Any] = {"rao": (("omega", "dof"), rao)}
    checks: tuple[IdentityCheck, ...] = ()
    if hydro.has_far_field:
        far = far_field(hydro, motions.displacement)
        out |= far_field_variables(far, hydro, unit, ("omega",))
        # Operators keep the phase, for drawing the water; sea states give magnitudes
        out["reflection_coefficient"] = ("omega", far.reflection_coefficient[:, 0])
        out["transmission_coefficient"] = ("omega", far.transmission_coefficient[:, 0])
        checks = energy_identity(model, far, motions, hydro, unit.name)
    length = wavelengths(omega, unit)
    k = 2.0 * math.pi / length
    depth, gravity = unit.water.depth, unit.water.gravity
    beam, draught = unit.breakwater.hull.beam, -unit.section.bottom
    out |= {
        "transmission_macagno": ("omega", transmission_macagno(k, depth, beam, draught)),
        "transmission_wiegel": ("omega", transmission_wiegel(k, depth, draught)),
        "transmission_ruol": ("omega", transmission_ruol(omega, k, depth, beam, draught, gravity)),
    }
    coords = {
        "omega": omega,
        "dof": list(MODES),
        "period": ("omega", 2.0 * math.pi / omega),
        "wavelength": ("omega", length),
        "wavelength_over_beam": ("omega", length / beam),
    }
    data = VOCABULARY.dataset(out, coords, {"heading": heading, "damping": linearised})
    return FrequencyResult(data, checks, tuple(motions.notices))


def _solved(
    model: FrequencyModel, hydro: Hydrodynamics, amplitude: Array, progress: Progress
) -> tuple[DriftedMotions, DriftedMotions]:
    """Return motions, and those with the tangent of the lines: the same where no lines are led along the motion."""
    tangent = solve_about_offset(model, hydro, amplitude, progress)
    if model.led_lines is None or not model.unit.lines:
        return tangent, tangent
    return about_led_lines(model, hydro, amplitude, tangent, progress), tangent


def _band(model: FrequencyModel, hydro: Hydrodynamics, amplitude: Array, solved: DriftedMotions) -> dict[str, Any]:
    """Return transmission and motion with the damping of the unit at both ends of its band, nominal included."""
    answers = [solved]
    for factor in band_factors(model):
        answers.append(_solved(scaled_damping(model, factor), hydro, amplitude, silent)[0])
    motion = np.array([np.abs(item.motions.displacement[:, 0, :]) * amplitude[:, None] for item in answers])
    out: dict[str, Any] = {
        "motion_amplitude_low": (("period", "dof"), motion.min(axis=0)),
        "motion_amplitude_high": (("period", "dof"), motion.max(axis=0)),
    }
    if hydro.has_far_field:
        passed = np.array([np.abs(item.far.transmission_coefficient[:, 0]) for item in answers])
        out["transmission_coefficient_low"] = (("period",), passed.min(axis=0))
        out["transmission_coefficient_high"] = (("period",), passed.max(axis=0))
    return out


def regular_sea(model: FrequencyModel, sea: RegularSea, progress: Progress = silent) -> FrequencyResult:
    """Motions, reflection, transmission, drift [eq:breakwater-drift] and tensions in regular waves, solved together."""
    unit = model.unit
    periods = np.sort(np.asarray(sea.periods, dtype=float))
    omega = 2.0 * math.pi / periods[::-1]
    hydro = model.hydro.at(omega, sea.heading)
    amplitude = np.full(len(omega), 0.5 * sea.height)
    solved, tangent = _solved(model, hydro, amplitude, progress)
    moving = solved.motions.displacement[:, 0, :] * amplitude[:, None]
    length = wavelengths(omega, unit)
    k = 2.0 * math.pi / length
    tension = line_tensions(unit, solved, moving)
    dims = ("period",)
    out = {
        "omega": (dims, omega),
        "wavelength": (dims, length),
        "wavelength_over_beam": (dims, length / unit.breakwater.hull.beam),
        "rao": (("period", "dof"), solved.motions.displacement[:, 0, :]),
        "motion_amplitude": (("period", "dof"), np.abs(moving)),
        "motion_ratio": (("period", "dof"), motion_ratio(unit, np.abs(moving), sea.height)),
        "mean_drift_force": (dims, solved.drift_force),
        "mean_offset": (("period", "dof"), solved.offset),
        "mooring_stiffness": (("period", "influenced_dof", "radiating_dof"), solved.mooring_stiffness),
        **{name: (("period", "line"), values) for name, values in tension.items()},
    }
    if tangent is not solved:
        with_tangent = np.abs(tangent.motions.displacement[:, 0, :] * amplitude[:, None])
        out["motion_amplitude_with_tangent"] = (("period", "dof"), with_tangent)
    out |= far_field_variables(solved.far, hydro, unit, dims) if hydro.has_far_field else {}
    out |= equivalent_variables(
        ("period", "dof"),
        solved.motions.damping[:, 0],
        model.inertia,
        hydro.added_mass,
        unit.statics.stiffness + solved.mooring_stiffness,
    )
    out |= _band(model, hydro, amplitude, solved)
    elevation = deck_relative_elevation(unit, solved.motions, k, sea.heading) * amplitude
    out["relative_elevation"] = (dims, elevation)
    coords = {
        "period": periods,
        "dof": list(MODES),
        "influenced_dof": list(MODES),
        "radiating_dof": list(MODES),
        "line": [line.name for line in unit.lines],
    }
    attributes = {
        "kind": "regular",
        "height": sea.height,
        "heading": sea.heading,
        "status": worst_status(solved.status),
        "damping_band": band_words(model),
    }
    # from short periods to long ones
    data = VOCABULARY.dataset(
        {name: (along, values[::-1]) for name, (along, values) in out.items()}, coords, attributes
    )
    check: tuple[IdentityCheck, ...] = ()
    if hydro.has_far_field:
        check = energy_identity(model, solved.far, solved.motions, hydro, f"{unit.name}, {sea.name}")
    return FrequencyResult(
        data, check, (*solved.notices, *solved.motions.notices, *overtopping_notices(unit, sea.name, elevation))
    )
