"""Damping of a unit beyond wave radiation: what the case gives or the section tells, its equivalents, its band."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.breakwater.assembly import FloatingUnit
from moyai.breakwater.hydrodynamics import spectrum_band
from moyai.breakwater.model import RegularSea, SeaState
from moyai.core.validity import Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping, QuadraticDamping, critical_damping
from moyai.floating.frequency import Motions, solve_motions
from moyai.floating.irregular import linearised_in_sea
from moyai.floating.modes import natural_modes
from moyai.floating.viscous import edge_damping
from moyai.floating.viscous_section import section_edges

if TYPE_CHECKING:
    from moyai.breakwater.frequency_model import FrequencyModel

Array = NDArray[np.float64]


def unit_drag_rows(unit: FloatingUnit) -> tuple[Array, Array]:
    """Return the unit's own quadratic damping as rows (k, 3) and coefficients (k,), without that of its lines.

    Eddies at the edges of the section [eq:viscous-edge] where the case computes them, and the given b2 of roll.
    """
    given = unit.breakwater.damping
    rows, coefficients = np.zeros((0, 3)), np.zeros(0)
    if given.viscous:
        edges = section_edges(unit.section)
        found = edge_damping(edges.corners, edges.plates, unit.centre, unit.water.density, unit.breakwater.length)
        rows, coefficients = found.directions, given.viscous_factor * found.coefficients
    if given.roll_quadratic:
        rows = np.vstack([rows, [0.0, 0.0, 1.0]])
        coefficients = np.append(coefficients, given.roll_quadratic)
    return rows, coefficients


def viscous_notices(unit: FloatingUnit) -> tuple[Notice, ...]:
    """Say what no law of the edges covers; nothing when the damping is not computed."""
    if not unit.breakwater.damping.viscous:
        return ()
    return tuple(
        replace(notice, message=f"{unit.name}: {notice.message}") for notice in section_edges(unit.section).notices
    )


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
    return f"{' and '.join(what)}, times {low:g} to {high:g}"


def natural_added_mass(model: FrequencyModel, hydro: Hydrodynamics) -> Array:
    """Added mass with the diagonal of each mode at that mode's own natural frequency, for the fraction of critical."""
    modes = natural_modes(hydro, model.unit.inertia, model.stiffness)
    omega = np.clip(np.nan_to_num(modes.omega), hydro.omega[0], hydro.omega[-1])
    out = np.zeros((3, 3))
    for index in range(3):
        out[index, index] = hydro.at(np.array([omega[index]])).added_mass[0, index, index]
    return out


def equivalent_variables(
    dims: tuple[str, ...], damping: Array, inertia: Array, added_mass: Array, stiffness: Array
) -> dict:
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


def damping_in_sea(model: FrequencyModel, sea: SeaState) -> LinearDamping:
    """Return the damping of the unit in an irregular sea about rest, quadratic terms linearised for it."""
    if model.quadratic is None or isinstance(sea, RegularSea):
        return model.damping
    omega = spectrum_band(sea)
    found = linearised_in_sea(
        model.hydro.at(omega, sea.heading),
        model.unit.inertia,
        model.stiffness,
        np.asarray(sea.spectrum.density_at(omega), dtype=float),
        quadratic=model.quadratic,
        damping=model.damping,
    )
    return LinearDamping(model.damping.matrix + found.equivalent_damping, model.damping.critical_fraction)


def motions_about_rest(model: FrequencyModel, hydro: Hydrodynamics, seas: tuple[SeaState, ...]) -> tuple[Motions, str]:
    """Return motions per metre of wave amplitude about rest, and what their damping was linearised at.

    Computed viscous damping needs a sea: the first irregular one of the case, or else the height of the first regular
    one. Where it is not computed the linear damping of the case stands alone.
    """
    unit = model.unit
    if not unit.breakwater.damping.viscous or not seas or model.quadratic is None:
        motions = solve_motions(hydro, unit.inertia, model.stiffness, damping=model.damping)
        return motions, "linear damping of the case alone"
    irregular = [sea for sea in seas if not isinstance(sea, RegularSea)]
    if irregular:
        damping = damping_in_sea(model, irregular[0])
        return (
            solve_motions(hydro, unit.inertia, model.stiffness, damping=damping),
            f"viscous damping as in {irregular[0].name}",
        )
    first = seas[0]
    assert isinstance(first, RegularSea)
    motions = solve_motions(
        hydro,
        unit.inertia,
        model.stiffness,
        damping=model.damping,
        quadratic=model.quadratic,
        wave_amplitude=0.5 * first.height,
    )
    return motions, f"viscous damping in waves of the height of {first.name}, {first.height:g} m"
