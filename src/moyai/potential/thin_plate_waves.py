"""Thin plates in waves at any frequency: sections of plates alone, modes of a skirt, memory of a hanging plate.

The plates are solved together with whatever hulls there are by :func:`moyai.potential.solver.solve`
[eq:plate-waves].
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.potential.damping_tail import TailTheory
from moyai.potential.edges import FloatArray
from moyai.potential.memory import MemoryFunctions, memory_functions
from moyai.potential.memory_plan import recommend_frequencies
from moyai.potential.modes import Modes, Rigid
from moyai.potential.plates import PlateLine, check_plates
from moyai.potential.sections import Section
from moyai.potential.solver import solve
from moyai.potential.thin_plate import Plate
from moyai.sea.water import Water


def plate_section(*plates: Plate | PlateLine, name: str = "plates") -> Section:
    """Return a section of thin plates alone, in the frame of the site (z = 0 at still water).

    Parameters
    ----------
    *plates : Plate or PlateLine
        Straight, circular or of several edges; surface-piercing, submerged or standing on the bed.
    name : str
        For messages and plots.

    Raises
    ------
    InputError
        When there is none, none is under water, or they cross.
    """
    if not plates:
        raise InputError("no plate was given", path="plates", allowed="one or more")
    lines = tuple(plate if isinstance(plate, PlateLine) else PlateLine.of(plate) for plate in plates)
    check_plates((), lines)
    return Section((), draught=0.0, name=name, plates=lines)


def plate_memory_functions(draught: float, water: Water, time: ArrayLike, *, accuracy: float = 1e-4) -> MemoryFunctions:
    """Return the memory functions of a vertical plate through the still water that moves along x.

    Parameters
    ----------
    draught : float
        Depth of the lower edge [m].
    water : Water
        Depth (may be infinite), density, gravity.
    time : array_like (t,)
        Increasing from 0 [s].
    accuracy : float
        Of the kernel, relative to its largest value, 1e-6 to 1e-2.

    Returns
    -------
    MemoryFunctions
        One mode; ``.velocity_kernel`` K(t) in [kg/s2] per metre with its checks (Kramers-Kronig, Ogilvie).

    Raises
    ------
    InputError
        When the draught is not between 0 and the water depth.
    """
    if not (math.isfinite(draught) and 0.0 < draught < water.depth):
        raise InputError(
            f"draught is {draught:g} m in water {water.depth:g} m deep",
            path="draught",
            allowed=f"greater than 0, less than {water.depth:g} m",
            remedy="a plate that reaches the bed leaves no gap: shorten it or take deeper water",
        )
    plan = recommend_frequencies(water, breadth=draught, wall_height=draught, accuracy=accuracy)
    section = plate_section(Plate((0.0, 0.0), (0.0, -draught)), name="hanging plate")
    sway = Modes(("sway",), (Rigid("sway"),))
    found = solve(section, water, plan.omega, modes=sway, accuracy=accuracy)
    # Short waves are reflected as by a cliff on either side, [eq:memory-wall-tail]
    tail = TailTheory((0, 0), (3.0,), (4.0 * water.density * water.gravity**2,))
    return memory_functions(
        found.omega,
        found.radiation_damping,
        found.infinite_frequency_added_mass,
        time,
        start="even" if math.isfinite(water.depth) else "zero",
        tail_theory=(tail,),
        added_mass=found.added_mass,
    )


def plate_memory(draught: float, water: Water, time: ArrayLike) -> tuple[FloatArray, float]:
    """Return the velocity kernel K(t) of a hanging vertical plate and its added mass at infinite frequency.

    The water resists a motion y(t) of the plate along x with m_inf y'' + integral of K(t - s) y'(s) ds.

    Parameters
    ----------
    draught : float
        Depth of the lower edge [m].
    water : Water
        Depth (may be infinite), density, gravity.
    time : array_like (t,)
        Increasing from 0 [s].

    Returns
    -------
    kernel : ndarray, shape (t,)
        K(t) per metre of plate [kg/s2 per m].
    infinite_frequency_added_mass : float
        Per metre of plate [kg/m].

    Raises
    ------
    InputError
        When the draught is not between 0 and the water depth, or the times do not increase from 0.
    """
    found = plate_memory_functions(draught, water, time)
    kernel = np.ascontiguousarray(found.velocity_kernel[:, 0, 0])
    return kernel, float(found.infinite_frequency_added_mass[0, 0])
