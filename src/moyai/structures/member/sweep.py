"""Inertia coefficient and circulation against KC in circular orbits, with the published curves next to them."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.morison.circulation import LAMINAR_EDGE, STRENGTHS, settled_circulation
from moyai.morison.field import circle_surface_speed
from moyai.morison.planar import stokes_wang_inertia
from moyai.morison.sections import MemberSection
from moyai.structures.member.model import MemberProblem
from moyai.structures.member.variables import labelled

if TYPE_CHECKING:
    import xarray as xr

LARGEST_KC = 4.0
POINTS = 161
#: Phases of a wave towards the first axis, and the Keulegan-Carpenter number of the photographs
PHASES = ("crest", "falling surface", "trough", "rising surface")
FIELD_KC = 1.5


def _surface_speed(radius: float, frequency: float, gamma: float) -> tuple[np.ndarray, np.ndarray]:
    """Return angles [rad] and speed along the surface of a circle over that of the stream, at KC = 1.5, four phases."""
    angle = np.radians(np.arange(-180.0, 181.0, 3.0))
    speed = FIELD_KC * 2.0 * radius * frequency
    circulation = float(settled_circulation(gamma, speed, speed, 1.0 / frequency))
    streams = [(speed, 0.0), (0.0, -speed), (-speed, 0.0), (0.0, speed)]
    rows = [circle_surface_speed(angle, radius, stream, circulation) / speed for stream in streams]
    return angle, np.array(rows)


def _planar(section: MemberSection, beta: float, ideal: np.ndarray) -> np.ndarray:
    """Return C_M of planar flow at small KC: laminar theory for a circle, ideal fluid for other sections."""
    return np.full(2, float(stokes_wang_inertia(beta))) if section.is_circle else ideal


def sweep(problem: MemberProblem, frequency: float) -> xr.Dataset:
    """Return C_M and Gamma over KC for circular orbits of one frequency.

    Parameters
    ----------
    problem : MemberProblem
    frequency : float
        f [Hz].

    Returns
    -------
    xarray.Dataset
        Over ``keulegan_carpenter`` and ``axis``. The case's own curve counts the circulation also where the purpose
        ``extreme`` leaves it out, so that its size is seen; beyond the law it ends.
    """
    import xarray as xr

    section, law = problem.member.placed_section, problem.circulation
    number = np.linspace(0.0, LARGEST_KC, POINTS)
    breadth, area, period = section.breadth, section.area, 1.0 / frequency
    speed = number * breadth * frequency
    beta = breadth**2 * frequency / problem.kinematic_viscosity
    ideal = np.diagonal(section.inertia.tensor)
    gamma = law.gamma(beta)

    def curve(strength: float) -> np.ndarray:
        fall = settled_circulation(strength, speed, speed, period) / (2.0 * math.pi * frequency * area)
        return ideal[None, :] - fall[:, None]

    counted = np.where(number > law.largest, np.nan, law.strength_at(number, breadth, area, gamma))
    own = counted * settled_circulation(1.0, speed, speed, period)
    axes = ("keulegan_carpenter", "axis")
    arrays: dict[str, Any] = {
        "inertia_coefficient": (axes, ideal[None, :] - own[:, None] / (2.0 * math.pi * frequency * area)),
        "planar_inertia_coefficient": (axes, np.tile(_planar(section, beta, ideal), (number.size, 1))),
        "laminar_inertia_coefficient": (axes, curve(LAMINAR_EDGE)),
        "circulation": (axes[0], own),
        "laminar_circulation": (axes[0], settled_circulation(LAMINAR_EDGE, speed, speed, period)),
        "magnus_force_per_length": (axes[0], problem.environment.water.density * speed * own),
    }
    for name, strength in STRENGTHS.items():
        arrays[f"{name}_inertia_coefficient"] = (axes, curve(strength))
        arrays[f"{name}_circulation"] = (axes[0], settled_circulation(strength, speed, speed, period))
    coords: dict[str, Any] = {"keulegan_carpenter": number, "axis": ["first", "second"]}
    if section.is_circle:
        angle, surface = _surface_speed(0.5 * breadth, frequency, gamma)
        arrays["surface_speed_ratio"] = (("phase", "surface_angle"), surface)
        coords |= {"phase": list(PHASES), "surface_angle": angle}
    data = xr.Dataset(
        arrays,
        coords=coords,
        attrs={"frequency": frequency, "beta": beta, "gamma": gamma, "counted": str(law.counted)},
    )
    return labelled(data)
