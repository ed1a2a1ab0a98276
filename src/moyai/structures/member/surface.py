"""What the free surface changes: inertia coefficient and radiation of a horizontal member by potential theory."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.morison.members import StraightMember
from moyai.morison.sections import MemberSection
from moyai.potential.modes import rigid_modes
from moyai.potential.sections import Hull, Outline
from moyai.potential.solver import solve
from moyai.sea.kinematics import depth_functions
from moyai.sea.water import Water

#: Change of the inertia coefficient or radiation above which the deep-submergence coefficients are warned about
SURFACE_LIMIT = 0.02
#: Steepest member that is taken for horizontal, and largest angle between its normal and the waves
LARGEST_INCLINATION = math.radians(5.0)
LARGEST_HEADING = math.radians(60.0)


@dataclass(frozen=True, eq=False)
class SurfaceEffect:
    """Inertia under the free surface against ideal fluid without one."""

    #: [s]; shape (periods,).
    period: Array
    #: |wave force| over rho A |acceleration| along both axes: inertia coefficient with surface and bed; shape (periods,
    #: 2).
    inertia: Array
    #: Its departure from the ideal one, relative; shape (periods, 2).
    change: Array
    #: Wave damping over omega rho A; shape (periods, 2).
    radiation: Array
    #: Of the potential solution.
    checks: tuple[IdentityCheck, ...]


def can_be_evaluated(member: StraightMember, heading: float) -> str:
    """Return why the two-dimensional theory is not for a member, empty where it does."""
    if member.inclination > LARGEST_INCLINATION:
        return "the member is not horizontal"
    if member.highest >= 0.0:
        return "the member is not wholly under water"
    if abs(relative_heading(member, heading)) > LARGEST_HEADING:
        return "the waves run along the member"
    return ""


def relative_heading(member: StraightMember, heading: float) -> float:
    """Return the angle between the waves and the first axis of the section [rad], folded to -pi/2..pi/2."""
    first = member.axes[0]
    angle = math.remainder(heading - math.atan2(first[1], first[0]), 2.0 * math.pi)
    return math.remainder(angle, math.pi)


def surface_effect(
    section: MemberSection,
    depth: float,
    water: Water,
    periods: Array,
    heading: float = 0.0,
    progress: Progress = silent,
) -> SurfaceEffect:
    """Solve radiation and diffraction of a submerged section and compare with ideal fluid [eq:morison-surface].

    Parameters
    ----------
    section : MemberSection
    depth : float
        Of the origin of the section below still water [m], positive.
    water : Water
    periods : ndarray
        Wave periods [s].
    heading : float
        Angle between the waves and the first axis [rad].
    """
    omega = 2.0 * math.pi / np.asarray(periods, dtype=float)
    hull = Hull((Outline(section.contour.vertices, section.contour.bulges),), name=section.name)
    placed = hull.immersed(depth)
    found = solve(placed, water, omega, modes=rigid_modes(centre=(0.0, -depth)), heading=[heading], progress=progress)
    data = found.dataset
    modes = ["sway", "heave"]
    wave = data["excitation_force"].isel(wave_direction=0).sel(influenced_dof=modes)
    force = np.abs(wave.transpose("omega", "influenced_dof").values)
    centroid_z = placed.centroid[1]
    horizontal, vertical, _ = depth_functions(data["wavenumber"].values, water.depth, centroid_z)
    solved = data["omega"].values
    # the vertical acceleration leads the horizontal one by a quarter of a period
    rate = solved[:, None] ** 2 * np.stack([-1j * horizontal * math.cos(heading), -vertical], axis=1)
    ideal = water.density * section.area * np.abs(rate @ section.inertia.tensor.T)
    change = force / ideal - 1.0
    inertia = np.diagonal(section.inertia.tensor) * (1.0 + change)
    damping = data["radiation_damping"].sel(influenced_dof=modes, radiating_dof=modes)
    diagonal = np.stack([damping.sel(influenced_dof=m, radiating_dof=m).values for m in modes], axis=1)
    radiation = diagonal.reshape(len(solved), 2) / (solved[:, None] * water.density * section.area)
    back = np.argsort(solved)[np.argsort(np.argsort(omega))]
    return SurfaceEffect(np.asarray(periods, dtype=float), inertia[back], change[back], radiation[back], found.checks)


def surface_notices(effect: SurfaceEffect, where: str) -> tuple[Notice, ...]:
    """Warn where inertia or radiation depart by more than two per cent."""
    notices = []
    for what, values, code in (
        ("changes the inertia coefficient by", effect.change, "near-surface-inertia"),
        ("adds a wave damping over omega rho A of", effect.radiation, "near-surface-radiation"),
    ):
        place = np.unravel_index(int(np.nanargmax(np.abs(values))), values.shape)
        worst = float(values[place])
        if abs(worst) > SURFACE_LIMIT:
            notices.append(
                Notice(
                    code,
                    f"{where}: the free surface {what} {100.0 * worst:+.2g} % at T = {effect.period[place[0]]:.3g} s "
                    f"along the {('first', 'second')[place[1]]} axis",
                    value=abs(worst),
                    limit=SURFACE_LIMIT,
                    remedy="use the coefficients of the group 'surface', or sink the member",
                    source="two-dimensional potential theory",
                )
            )
    return tuple(notices)
