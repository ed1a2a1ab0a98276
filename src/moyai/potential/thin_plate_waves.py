"""Thin plates in waves at any frequency: sections of plates alone, modes of a skirt, memory of a hanging plate.

The plates are solved together with whatever hulls there are by :func:`moyai.potential.solver.solve`
[eq:plate-waves].
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import check_kind
from moyai.core.validity import IdentityCheck
from moyai.potential.damping_tail import TailTheory
from moyai.potential.drift import FarFieldDrift, NearFieldDrift, mean_drift_far_field, mean_drift_near_field
from moyai.potential.memory import MemoryFunctions, memory_functions
from moyai.potential.memory_plan import recommend_frequencies
from moyai.potential.modes import Modes, Rigid, rigid_modes
from moyai.potential.panels import PLATE
from moyai.potential.plate_faces import plate_tips
from moyai.potential.plates import PlateLine, check_plates
from moyai.potential.sections import Section
from moyai.potential.solution import RadiationDiffraction
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
        raise InputError("no plate was given", parameter="plates", allowed="one or more")
    lines = tuple(plate if isinstance(plate, PlateLine) else PlateLine.of(plate) for plate in plates)
    check_plates((), lines)
    return Section((), draught=0.0, name=name, plates=lines)


@dataclass(frozen=True, eq=False)
class PlateJump:
    """Jump of the potential over one plate: its value where the normal points minus that behind."""

    #: Places [m]; shape (n, 2).
    points: Array
    #: Unit normals; shape (n, 2).
    normals: Array
    #: Distance along the plate [m]; shape (n,).
    arc: Array
    #: Sums over it are integrals along the plate [m]; shape (n,).
    weight: Array
    #: For unit velocity [m2/s per m/s]; the pressure difference is i omega rho times it; shape (omega, n, mode).
    radiation: ComplexArray
    #: Of the section held fixed, for unit wave amplitude [m2/s per m]; shape (omega, n).
    diffraction: ComplexArray
    #: Free edges [m]; shape (tips, 2).
    tip_places: Array
    #: C of the jump C sqrt(distance) at the free edges, for unit velocity [eq:plate-suction]; shape (omega, tips,
    #: mode).
    tip_radiation: ComplexArray
    #: The same for unit wave amplitude; shape (omega, tips).
    tip_diffraction: ComplexArray


def plate_jumps(solution: RadiationDiffraction, heading: float = 0.0) -> tuple[PlateJump, ...]:
    """Return the jumps over all plates of a solved section, one entry for each connected line.

    Parameters
    ----------
    solution : RadiationDiffraction
        With thin plates.
    heading : float
        One of the headings of the solution [rad].
    """
    part = solution.at_heading(heading)
    body = part.body
    size = float(np.abs(body.points).max())
    groups: list[list[int]] = []
    last: complex | None = None
    for number, piece in enumerate(body.pieces):
        if piece.kind != PLATE:
            last = None
            continue
        if last is None or abs(piece.start - last) > 1e-9 * size:
            groups.append([])
        groups[-1].append(number)
        last = piece.start + piece.step
    tips = plate_tips(body)
    found = []
    for group in groups:
        here = (np.array(group)[:, None] * body.order + np.arange(body.order)).ravel()
        owned = [tip for tip in tips if np.any(tip.strength[here])]
        strength = np.array([tip.strength for tip in owned]).reshape(len(owned), len(body.u))
        weight = body.weight.real[here]
        found.append(
            PlateJump(
                points=body.points[here],
                normals=body.normal[here],
                arc=_distance(body.points[here], body.pieces[group[0]].start),
                weight=weight,
                radiation=part.radiation[:, here],
                diffraction=part.scattered[:, here],
                tip_places=np.array([tip.place for tip in owned]).reshape(len(owned), 2),
                tip_radiation=np.einsum("tn,wnm->wtm", strength, part.radiation),
                tip_diffraction=part.scattered @ strength.T,
            )
        )
    return tuple(found)


def _distance(points: Array, start: complex) -> Array:
    """Distance along a line of points from its start; chords between neighbours, close enough for drawings."""
    steps = np.diff(np.concatenate([[[start.real, start.imag]], points]), axis=0)
    return np.asarray(np.cumsum(np.hypot(steps[:, 0], steps[:, 1])))


@dataclass(frozen=True, eq=False)
class PlateWaves:
    """Thin plates in waves that travel along +x and along -x, per metre of structure."""

    #: Waves along +x, with the identities.
    solution: RadiationDiffraction
    #: Waves along -x: the mirrored plates in waves along +x.
    backward: RadiationDiffraction

    @property
    def omega(self) -> Array:
        """Frequencies [rad/s]."""
        return self.solution.omega

    @property
    def added_mass(self) -> Array:
        """Added mass (omega, radiating, influenced), per metre [kg/m, kg, kg m]."""
        return self.solution.added_mass

    @property
    def radiation_damping(self) -> Array:
        """Radiation damping (omega, radiating, influenced), per metre [kg/(m s), kg/s, kg m/s]."""
        return self.solution.radiation_damping

    @property
    def radiated_wave(self) -> ComplexArray:
        """Wave amplitude (omega, radiating, side) per unit velocity on the minus and the plus side [s, m s]."""
        return self.solution.radiated_wave

    @property
    def excitation_force(self) -> ComplexArray:
        """Excitation (omega, side, mode) per unit amplitude, from the minus and the plus side, per metre [N/m2, N/m].

        From minus by pressure; from plus by the Haskind relation, which the checks hold for the other side.
        """
        part = self.solution.normal
        flux = self.solution.water.density * self.solution.water.gravity * part.states.group_velocity
        plus = -2.0 * flux[:, None] * part.radiated_wave[:, :, 1]
        return np.stack([part.excitation_force, plus], axis=1)

    @property
    def reflection_coefficient(self) -> ComplexArray:
        """R (omega, side) of plates held fixed, waves from the minus and the plus side, phase at x = 0 [-]."""
        return self._of_both("reflection_coefficient")

    @property
    def transmission_coefficient(self) -> ComplexArray:
        """T (omega, side) of plates held fixed, waves from the minus and the plus side, phase at x = 0 [-]."""
        return self._of_both("transmission_coefficient")

    def _of_both(self, name: str) -> ComplexArray:
        return np.stack([getattr(part.normal, name) for part in (self.solution, self.backward)], axis=1)

    @property
    def jumps(self) -> tuple[PlateJump, ...]:
        """Jump of the potential over each plate."""
        return plate_jumps(self.solution)

    @property
    def checks(self) -> tuple[IdentityCheck, ...]:
        """Identities of the solve, and that waves of either side are transmitted alike."""
        minus, plus = self.transmission_coefficient.T
        apart = float(np.abs(minus - plus).max())
        tolerance = self.solution.checks[0].tolerance
        return (
            *self.solution.checks,
            IdentityCheck("transmission from either side", apart, tolerance, "T is the same from both sides"),
        )

    def drift_by_momentum(self, motions: ComplexArray | None = None) -> FarFieldDrift:
        """Return the mean force of waves along +x from the far field.

        Parameters
        ----------
        motions : ndarray of complex (omega, modes), optional
            Amplitudes of the modes per unit wave amplitude [-, rad/m]; the plate is held when left out.
        """
        return mean_drift_far_field(self.solution, motions)

    def drift_by_pressure(self, motions: ComplexArray | None = None) -> NearFieldDrift:
        """Return the mean force of waves along +x from pressure and edge suction; needs rigid modes.

        Parameters
        ----------
        motions : ndarray of complex (omega, 3), optional
            Amplitudes of the modes per unit wave amplitude [-, rad/m]; the plate is held when left out.
        """
        return mean_drift_near_field(self.solution, motions)


def solve_plate_waves(
    plates: Plate | PlateLine | tuple[Plate | PlateLine, ...],
    water: Water,
    omega: ArrayLike,
    *,
    modes: Modes | None = None,
    accuracy: float = 1e-4,
) -> PlateWaves:
    """Solve radiation and diffraction by thin plates alone, waves of either side [eq:plate-waves].

    Parameters
    ----------
    plates : Plate, PlateLine or a tuple of them
        Straight, circular or of several edges, in the frame of the site.
    water : Water
        Depth (may be infinite), density, gravity.
    omega : array_like
        [rad/s].
    modes : Modes, optional
        Rigid motions about the origin unless given; see :mod:`moyai.potential.skirt_modes` for those of a skirt.
    accuracy : float
        See :func:`moyai.potential.solver.solve`.

    Returns
    -------
    PlateWaves
        The solution for waves along +x and that for waves along -x (of the mirrored plates), per metre of structure.

    Raises
    ------
    InputError
        For what is no plate, and plates without length, that cross, or that are deeper than the water.

    Examples
    --------
    >>> from moyai.potential import Plate, solve_plate_waves
    >>> from moyai.sea import Water
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> found = solve_plate_waves(Plate(start=(0.0, 0.0), end=(0.0, -2.0)), water, [1.5])
    >>> round(float(abs(found.solution.transmission_coefficient[0, 0])), 2)   # of the plate held fixed [-]
    0.93
    """
    group = plates if isinstance(plates, tuple) else (plates,)
    for plate in group:
        check_kind(plate, (Plate, PlateLine), "plates", "give Plate(start, end)")
    section = plate_section(*group)
    motion = rigid_modes((0.0, 0.0)) if modes is None else modes
    solution = solve(section, water, omega, modes=motion, accuracy=accuracy)
    mirrored = [
        PlateLine(line.points * np.array([-1.0, 1.0]), None if line.bulges is None else -line.bulges)
        for line in section.plates
    ]
    backward = solve(plate_section(*mirrored), water, omega, modes=rigid_modes((0.0, 0.0)), accuracy=accuracy)
    return PlateWaves(solution, backward)


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
            parameter="draught",
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


def plate_memory(draught: float, water: Water, time: ArrayLike) -> tuple[Array, float]:
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
