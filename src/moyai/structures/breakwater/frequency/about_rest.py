"""Motions about rest, the damping that they meet there, and the band of that damping."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.remembered import Remembered
from moyai.core.store import key_of
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping, QuadraticDamping, critical_damping
from moyai.floating.frequency import Motions, solve_motions
from moyai.floating.irregular import linearised_in_sea
from moyai.floating.modes import natural_modes
from moyai.sea.states import RegularSea, SeaState
from moyai.structures.breakwater.frequency.model import FrequencyModel, water_motion
from moyai.structures.breakwater.hydrodynamics import spectrum_band


def scaled_damping(model: FrequencyModel, factor: float) -> FrequencyModel:
    """Return the model with the unit's own damping times ``factor``; drag of lines and given linear terms stay."""
    quadratic = model.quadratic
    if quadratic is not None:
        coefficients = quadratic.coefficients.copy()
        coefficients[model.rows_of_lines :] *= factor
        quadratic = QuadraticDamping(quadratic.directions, coefficients)
    linear = LinearDamping(model.damping.matrix, factor * np.asarray(model.damping.critical_fraction))
    return replace(model, damping=linear, quadratic=quadratic)


def band_factors(model: FrequencyModel) -> tuple[float, ...]:
    """Return the factors on the unit's own damping for the band of an answer; none where there is nothing to vary."""
    own = model.quadratic is not None and len(model.quadratic.coefficients) > model.rows_of_lines
    if not own and not np.any(np.asarray(model.damping.critical_fraction)):
        return ()
    return tuple(factor for factor in model.unit.breakwater.damping.band if factor != 1.0)


def band_words(model: FrequencyModel) -> str:
    """Return what the band of transmission and motion stands for."""
    given, factors = model.unit.breakwater.damping, band_factors(model)
    if not factors and given.band == (1.0, 1.0):
        return "no band: the damping is not varied"
    if not factors:
        return "no band: no damping beyond wave radiation that could be varied"
    what = []
    if given.viscous:
        what.append("viscous damping computed from the section")
    fraction = float(np.max(model.damping.critical_fraction))
    if fraction:
        what.append(f"damping of {100.0 * fraction:.3g} % of critical")
    if given.roll_quadratic:
        what.append("given quadratic roll damping")
    low, high = given.band
    lid = model.unit.breakwater.gap_damping_lid
    words = f"{' and '.join(what)}, times {low:g} to {high:g}"
    return f"{words}; the lid of {lid:g} in the gap is not varied" if lid else words


_NATURAL: Remembered[Array] = Remembered(16)


def natural_added_mass(model: FrequencyModel, hydro: Hydrodynamics) -> Array:
    """Added mass with the diagonal of each mode at that mode's own natural frequency, for the fraction of critical."""
    known = (hydro.omega, hydro.added_mass, hydro.infinite_frequency_added_mass, model.inertia, model.stiffness)
    return _NATURAL.of(key_of(*known), lambda: _natural_added_mass(model, hydro)).copy()


def _natural_added_mass(model: FrequencyModel, hydro: Hydrodynamics) -> Array:
    modes = natural_modes(hydro, model.inertia, model.stiffness)
    omega = np.clip(np.nan_to_num(modes.omega), hydro.omega[0], hydro.omega[-1])
    out = np.zeros((3, 3))
    for index in range(3):
        out[index, index] = hydro.at(np.array([omega[index]])).added_mass[0, index, index]
    return out


def equivalent_variables(
    dims: tuple[str, ...], damping: Array, inertia: Array, added_mass: Array, stiffness: Array
) -> dict[str, Any]:
    """Return equivalent linear damping of each mode beyond radiation, and its fraction of critical.

    Parameters
    ----------
    dims : tuple of str
        Leading dimensions, then ``dof``.
    damping, added_mass, stiffness : ndarray (..., 3, 3)
        Total damping beyond radiation, quadratic terms as their equivalents.
    inertia : ndarray (3, 3)
    """
    own = np.diagonal(damping, axis1=-2, axis2=-1)
    critical = critical_damping(inertia, added_mass, stiffness)
    with np.errstate(divide="ignore", invalid="ignore"):
        fraction = np.where(critical > 0.0, own / np.where(critical > 0.0, critical, 1.0), np.nan)
    return {"equivalent_damping": (dims, own), "equivalent_damping_fraction": (dims, fraction)}


def about_rest_in_sea(model: FrequencyModel, hydro: Hydrodynamics, sea: SeaState) -> Motions:
    """Return motions about rest per metre of wave amplitude in one heading, quadratic terms linearised for a sea.

    Parameters
    ----------
    model : FrequencyModel
    hydro : Hydrodynamics
        Of one heading, at any frequencies.
    sea : IrregularSea
        Long-crested from that heading for this purpose.
    """
    if model.quadratic is None or isinstance(sea, RegularSea):
        return solve_motions(hydro, model.inertia, model.stiffness, damping=model.damping)
    omega = spectrum_band(sea)
    found = linearised_in_sea(
        model.hydro.at(omega, sea.heading),
        model.inertia,
        model.stiffness,
        np.asarray(sea.spectrum.density_at(omega), dtype=float),
        quadratic=model.quadratic,
        damping=model.damping,
        water_motion=water_motion(model, omega, np.array([sea.heading])),
    )
    damping = LinearDamping(model.damping.matrix + found.equivalent_damping, model.damping.critical_fraction)
    return driven_motions(model, hydro, model.stiffness, damping, found.measure_deviation)


def driven_motions(
    model: FrequencyModel, hydro: Hydrodynamics, stiffness: Array, damping: LinearDamping, deviation: Array
) -> Motions:
    """Return motions with drag that was linearised at standard deviations (k,) of its measures.

    Parameters
    ----------
    model : FrequencyModel
    hydro : Hydrodynamics
    stiffness : ndarray (3, 3)
    damping : LinearDamping
        Equivalents included.
    deviation : ndarray (k,)
    """
    moving = water_motion(model, hydro.omega, hydro.heading)
    if moving is None or model.quadratic is None:
        return solve_motions(hydro, model.inertia, stiffness, damping=damping)
    drag = model.quadratic.carried_irregular(deviation, moving)
    driven = replace(hydro, excitation_force=hydro.excitation_force + drag)
    return replace(solve_motions(driven, model.inertia, stiffness, damping=damping), drag_excitation=drag)


def motions_about_rest(model: FrequencyModel, hydro: Hydrodynamics, seas: tuple[SeaState, ...]) -> tuple[Motions, str]:
    """Return motions per metre of wave amplitude about rest, and what their damping was linearised at.

    Computed viscous damping needs a sea: the first irregular one of the case, or else the height of the first regular
    one. Where it is not computed the linear damping of the case stands alone.
    """
    unit = model.unit
    if not unit.breakwater.damping.viscous or not seas or model.quadratic is None:
        motions = solve_motions(hydro, model.inertia, model.stiffness, damping=model.damping)
        return motions, "linear damping of the case alone"
    irregular = [sea for sea in seas if not isinstance(sea, RegularSea)]
    if irregular:
        return about_rest_in_sea(model, hydro, irregular[0]), f"viscous damping as in {irregular[0].name}"
    first = seas[0]
    assert isinstance(first, RegularSea)
    motions = solve_motions(
        hydro,
        model.inertia,
        model.stiffness,
        damping=model.damping,
        quadratic=model.quadratic,
        wave_amplitude=0.5 * first.height,
        water_motion=water_motion(model, hydro.omega, hydro.heading),
    )
    return motions, f"viscous damping in waves of the height of {first.name}, {first.height:g} m"
