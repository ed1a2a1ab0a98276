"""Damping of a unit beyond wave radiation: what the case gives or the section gives, its equivalents, its band."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.validity import Notice
from moyai.floating.forcing import Forcing, IrregularForcing
from moyai.floating.moving_water import MovingWater
from moyai.floating.viscous import edge_damping, water_measure
from moyai.floating.viscous_section import section_edges
from moyai.sea.dispersion import wave_number
from moyai.structures.breakwater.assembly import FloatingUnit


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


def own_water_motion(unit: FloatingUnit, omega: Array, heading: Array) -> ComplexArray:
    """Return the undisturbed wave in the unit's own rows, (..., k) per metre of amplitude [eq:viscous-water].

    ``omega`` [rad/s] and ``heading`` [rad] broadcast; a given b2 of roll is about still water.
    """
    given, water = unit.breakwater.damping, unit.water
    number = np.asarray(wave_number(np.asarray(omega, dtype=float), water.depth, water.gravity), dtype=float)
    shape = np.broadcast_shapes(np.shape(omega), np.shape(heading))
    out = np.zeros((*shape, 0), dtype=np.complex128)
    if given.viscous:
        edges = section_edges(unit.section)
        out = water_measure(edges.corners, edges.plates, omega, number, heading, water.depth)
    return np.concatenate([out, np.zeros((*shape, 1))], axis=-1) if given.roll_quadratic else out


def in_moving_water(unit: FloatingUnit, forcing: IrregularForcing, heading: Array) -> Forcing:
    """Return a forcing with the undisturbed wave that computed viscous damping is taken against [eq:viscous-water].

    Parameters
    ----------
    unit : FloatingUnit
    forcing : IrregularForcing
    heading : ndarray
        Of every wave component [rad].
    """
    if not unit.breakwater.damping.viscous:
        return forcing
    moving = own_water_motion(unit, forcing.omega, heading)
    return MovingWater(forcing, forcing.omega, forcing.amplitude, moving, forcing.ramp)


def viscous_notices(unit: FloatingUnit) -> tuple[Notice, ...]:
    """Say what no law of the edges covers; nothing when the damping is not computed."""
    if not unit.breakwater.damping.viscous:
        return ()
    return tuple(
        replace(notice, message=f"{unit.name}: {notice.message}") for notice in section_edges(unit.section).notices
    )
