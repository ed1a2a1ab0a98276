"""Steady loads of wind and current on the unit."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.model import Environment

LEVELS = 41  # Simpson points over the draught for the current


def steady_forces(unit: FloatingUnit, environment: Environment) -> tuple[Array, Array]:
    """Return the forces of wind and of current on the unit [eq:breakwater-steady-load].

    Parameters
    ----------
    unit : FloatingUnit
    environment : Environment

    Returns
    -------
    wind, current : ndarray (3,)
        Sway force [N], heave force (zero) and roll moment about the centre of gravity [N m].

    Raises
    ------
    InputError
        When there is wind or current and its coefficient is missing.
    """
    breakwater, of_wind, of_current = unit.breakwater, np.zeros(3), np.zeros(3)
    if environment.wind is not None and environment.wind.speed != 0.0:
        coefficient = _required(breakwater.wind_drag_coefficient, "wind_drag_coefficient", "wind")
        wind, freeboard = environment.wind, max(unit.freeboard, 0.0)
        normal = wind.speed * math.cos(wind.heading)
        force = 0.5 * wind.density * coefficient * breakwater.length * freeboard * abs(wind.speed) * normal
        of_wind = force * np.array([1.0, 0.0, 0.5 * freeboard - unit.centre[1]])
    if environment.current is not None:
        coefficient = _required(breakwater.current_drag_coefficient, "current_drag_coefficient", "current")
        z = np.linspace(unit.section.bottom, min(0.0, unit.section.bounds[3]), LEVELS)
        normal_speed = np.asarray(environment.current.velocity(z), dtype=float)[..., 0]
        pressure = 0.5 * unit.water.density * coefficient * breakwater.length * np.abs(normal_speed) * normal_speed
        of_current = np.array([_simpson(pressure, z), 0.0, _simpson(pressure * (z - unit.centre[1]), z)])
    return of_wind, of_current


def _required(value: float | None, name: str, load: str) -> float:
    if value is None:
        raise InputError(
            f"there is {load} but no {name}", parameter=f"{name}", remedy=f"give {name} or leave {load} out"
        )
    return value


def _simpson(values: Array, z: Array) -> float:
    step = (z[-1] - z[0]) / (len(z) - 1)
    return float(step / 3.0 * (values[0] + values[-1] + 4.0 * values[1:-1:2].sum() + 2.0 * values[2:-1:2].sum()))
