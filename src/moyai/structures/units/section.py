"""The two-dimensional answer of the same section, to be compared with the row: an endless unit on its own lines."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.core.progress import Progress, silent
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.damping import LinearDamping
from moyai.floating.far_field import drift_force_per_amplitude_squared, far_field
from moyai.floating.frequency import solve_motions
from moyai.potential.modes import rigid_modes
from moyai.potential.solver import solve
from moyai.structures.units.assembly import RowAtLevel

LARGEST_HEADING = math.radians(75.0)
#: Motions of the section among those of a unit
PLANAR = (0, 2, 4)


@dataclass(frozen=True, eq=False)
class SectionAnswer:
    """The section at frequencies (n,) and headings (h,), per unit wave amplitude."""

    #: Absolute; shape (n, h).
    transmission: Array
    #: Sway, heave, roll; shape (n, h, 3).
    motion: ComplexArray
    #: Mean force across on the length of one unit [N/m2]; shape (n, h).
    drift: Array

    def placed(self, columns: IntArray, count: int) -> SectionAnswer:
        """Return it among ``count`` headings, at ``columns``; NaN elsewhere."""

        def among(values: Any) -> Any:
            out = np.full((len(values), count, *values.shape[2:]), np.nan, dtype=values.dtype)
            out[:, columns] = values
            return out

        return SectionAnswer(among(self.transmission), among(self.motion), among(self.drift))


def comparable(at: RowAtLevel, headings: Array) -> bool:
    """Whether a section stands for the row: all units lie along y and waves meet their side."""
    straight = all(abs(place.heading) < 1e-9 for place in at.row.placements)
    return straight and bool(np.all(np.abs(headings) <= LARGEST_HEADING))


def section_answer(at: RowAtLevel, omega: Array, headings: Array, progress: Progress = silent) -> SectionAnswer:
    """Return what the section alone gives.

    Parameters
    ----------
    at : RowAtLevel
    omega, headings : ndarray
        [rad/s], [rad] within 75 degrees of x.
    progress : Progress
    """
    centre = (0.0, float(at.centres[0, 2]))
    found = solve(
        at.section, at.water, omega, modes=rigid_modes(centre), heading=headings, progress=progress, accuracy=5e-3
    )
    row, middle = at.row, at.row.count // 2
    mass = float(at.masses[middle])
    inertia = np.diag([mass, mass, mass * row.gyradii[1] ** 2])
    pick = np.ix_(PLANAR, PLANAR)
    system = at.systems[middle]
    lines = system.stiffness(np.zeros(6))[pick] if system.lines else np.zeros((3, 3))
    stiffness = at.statics.stiffness + lines
    damping = LinearDamping.of_modes(
        linear=row.linear_damping[list(PLANAR)], critical_fraction=row.damping_fraction[list(PLANAR)]
    )
    transmission, drift = np.empty((len(omega), len(headings))), np.empty((len(omega), len(headings)))
    motion = np.empty((len(omega), len(headings), 3), dtype=complex)
    for index, one in enumerate(Hydrodynamics.of_headings(found.dataset)):
        hydro = one.scaled_to(row.length)
        solved = solve_motions(hydro, inertia, stiffness, damping=damping)
        far = far_field(hydro, solved.displacement)
        motion[:, index] = solved.displacement[:, 0]
        transmission[:, index] = np.abs(far.transmission_coefficient[:, 0])
        drift[:, index] = drift_force_per_amplitude_squared(far, hydro.omega, hydro.heading, at.water, row.length)[:, 0]
    return SectionAnswer(transmission, motion, drift)
