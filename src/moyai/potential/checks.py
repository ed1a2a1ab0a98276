"""Input checks, validity notices and identities of the radiation and diffraction solver."""

from __future__ import annotations

import itertools
import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import check_kind
from moyai.core.validity import IdentityCheck, Notice
from moyai.potential.edges import arc_slope, as_complex
from moyai.potential.heading import HeadingSolution
from moyai.potential.modes import Modes
from moyai.potential.plates import WettedPlate
from moyai.potential.sections import Hull, Section
from moyai.potential.solution import RadiationDiffraction
from moyai.sea.water import Water

# Between a plate and the still water [degrees]
_LEAST_ANGLE = 0.5


def check_frequencies(omega: ArrayLike) -> Array:
    """Return the frequencies as an array.

    Raises
    ------
    InputError
        When there is none, or one is not positive or not finite.
    """
    values = np.atleast_1d(np.asarray(omega, dtype=float))
    if values.ndim != 1 or values.size == 0:
        raise InputError("no frequency was given", parameter="omega", allowed="one or more, in rad/s")
    if not np.isfinite(values).all() or (values <= 0.0).any():
        bad = values[~(np.isfinite(values) & (values > 0.0))][0]
        raise InputError(
            f"omega contains {bad:g} rad/s",
            parameter="omega",
            allowed="finite and greater than 0",
            remedy="the limits at zero and infinity are in the dataset under separate names",
        )
    return values


def check_headings(heading: ArrayLike) -> Array:
    """Return the headings [rad] as an array.

    Raises
    ------
    InputError
        When one is not finite or not between -90 and 90 degrees.
    """
    values = np.atleast_1d(np.asarray(heading, dtype=float))
    if values.ndim != 1 or values.size == 0 or not np.isfinite(values).all():
        raise InputError("heading is not a list of finite angles", parameter="heading", allowed="radians")
    if (np.abs(values) > math.radians(89.5)).any():
        worst = float(values[np.argmax(np.abs(values))])
        raise InputError(
            f"heading contains {math.degrees(worst):g} degrees",
            parameter="heading",
            allowed="-89.5 to 89.5 degrees from +x",
            remedy="for waves from the other side mirror the section: reverse x",
        )
    return values


def check_arguments(section: object, modes: object) -> None:
    """Refuse a hull that is not set into the water, and motions that are no :class:`~moyai.potential.modes.Modes`.

    Raises
    ------
    InputError
        With what is to be given.
    """
    if isinstance(section, Hull):
        raise InputError(
            f"{section.name} is a hull in its own frame",
            parameter="section",
            allowed="a Section",
            remedy="set it into the water: hull.immersed(draught=...)",
        )
    check_kind(section, Section, "section", "shapes make hulls")
    check_kind(modes, Modes, "modes", "rigid_modes(centre) gives sway, heave and roll")


def check_solution(solution: object) -> None:
    """Refuse what is not the solution of a section.

    Raises
    ------
    InputError
        With what is to be given.
    """
    check_kind(solution, RadiationDiffraction, "solution", "solve the section first: moyai.potential.solve")


def check_section(section: Section, water: Water) -> None:
    """Refuse a section that touches the bed, and plates that go through it or leave the still water along itself.

    Raises
    ------
    InputError
        When the section is as deep as the water or deeper (a plate may stand on the bed with its end).
    """
    lines = [chain.edges for chain in section.chains]
    low = min((edges.bounds()[2] for edges in lines), default=0.0)
    for plate in section.wetted_plates:
        lowest = plate.edges.bounds()[2]
        ends = min(plate.edges.start[0, 1], plate.edges.end[-1, 1])
        stands = abs(water.depth + lowest) <= 1e-6 * -lowest and ends == lowest
        if not stands:
            low = min(low, lowest)
        _check_waterline(plate, section.name)
    clearance = water.depth + low
    if clearance <= 1e-6 * -low:
        raise InputError(
            f"{section.name} reaches down to z = {low:g} m in water {water.depth:g} m deep",
            parameter="section",
            allowed=f"clearance above the bed greater than 0 (found {clearance:g} m)",
            remedy="reduce the draught, shorten the plate or take a higher water level",
        )


def _check_waterline(plate: WettedPlate, name: str) -> None:
    """Refuse a plate that leaves the still water along itself: waves run up the wedge above it for ever."""
    ends = np.array([0.0, 1.0])
    edges = plate.edges
    for edge, place in ((0, 0), (len(edges) - 1, 1)):
        point = (edges.end if place else edges.start)[edge]
        if point[1] != 0.0:
            continue
        start, end = as_complex(edges.start[edge]), as_complex(edges.end[edge])
        slope = arc_slope(start, end, edges.bulge[edge], ends)[place]
        angle = math.degrees(math.asin(min(1.0, abs(slope.imag / slope))))
        if angle < _LEAST_ANGLE:
            raise InputError(
                f"a plate of {name} leaves the still water at {angle:.3g} degrees",
                parameter="section",
                allowed=f"{_LEAST_ANGLE:g} degrees or more at a finite frequency",
                remedy="waves never come back from so thin a wedge; take another arc, or the limit of infinite "
                "frequency (solve_plate_limit)",
            )


def gap_notices(section: Section, water: Water, omega: Array, lid: float) -> tuple[Notice, ...]:
    """Warn of the piston resonance in every gap between waterlines [eq:potential-gap-resonance].

    The water in a gap of width w between sides of draught d swings like a piston with
    omega^2 = g / (d + (w / pi) (3/2 + ln(H / 2w))), H being the whole breadth; good to some five percent.
    """
    notices = []
    lines = section.waterlines
    whole = section.bounds[1] - section.bounds[0]
    for (_, left), (right, _) in itertools.pairwise(lines):
        width = right - left
        # The shallower of the two sides lets the water out
        draught = min(_side_depth(section, left), _side_depth(section, right))
        length = draught + width / math.pi * (1.5 + math.log(max(whole / (2.0 * width), math.exp(-1.5))))
        resonance = math.sqrt(water.gravity / length)
        inside = bool(omega.min() <= resonance <= omega.max())
        if inside:
            without = " without damping" if lid == 0.0 else f"; the damping lid of {lid:g} decides what stays of it"
            notices.append(
                Notice(
                    code="gap-resonance",
                    severity="warning" if lid == 0.0 else "information",
                    message=(
                        f"The water in the gap of {width:.3g} m at x = {left:.3g} to {right:.3g} m resonates near "
                        f"{resonance:.3g} rad/s (period {2.0 * math.pi / resonance:.3g} s){without}"
                    ),
                    value=resonance,
                    limit=float(omega.max()),
                    remedy="give lid, the damping of the enclosed surface as a fraction (0.01 to 0.1 is usual)"
                    if lid == 0.0
                    else "hold the lid against a measured gap elevation",
                    source="Molin (2001), J. Fluid Mech. 430, 27-50, piston mode of a moonpool",
                )
            )
    return tuple(notices)


def _side_depth(section: Section, x: float) -> float:
    """Depth of the first corner below the waterline point at x."""
    for chain in section.chains:
        if chain.closed:
            continue
        edges = chain.edges
        if math.isclose(edges.start[0, 0], x):
            return float(-edges.end[0, 1])
        if math.isclose(edges.end[-1, 0], x):
            return float(-edges.start[-1, 1])
    for plate in section.wetted_plates:
        for point in (plate.edges.start[0], plate.edges.end[-1]):
            if point[1] == 0.0 and math.isclose(point[0], x):
                return -plate.edges.bounds()[2]
    return -section.bottom


def identity_checks(
    solutions: Sequence[HeadingSolution], water: Water, accuracy: float, tails: float
) -> tuple[IdentityCheck, ...]:
    """Return the identities of all headings with the largest violation found."""

    def worst(values: list[float]) -> float:
        return max(values) if values else 0.0

    energy: list[float] = []
    symmetry: list[float] = []
    haskind: list[float] = []
    damping: list[float] = []
    for solution in solutions:
        states = solution.states
        flux = water.density * water.gravity * states.group_velocity * states.along / states.wave_number
        out = (
            np.abs(solution.reflection_coefficient) ** 2
            + np.abs(solution.transmission_coefficient) ** 2
            + solution.lid_loss
        )
        energy.append(float(np.abs(out - 1.0).max()))
        mass_scale = _pair_scale(solution.added_mass)
        inertia = _pair_scale(states.omega[:, None, None] * solution.added_mass)
        asymmetry = np.abs(solution.added_mass - np.swapaxes(solution.added_mass, 1, 2)).max(axis=0)
        symmetry.append(float((asymmetry / mass_scale).max()))
        by_pressure = np.abs(solution.pressure_damping - solution.radiation_damping).max(axis=0)
        damping.append(float((by_pressure / np.fmax(_pair_scale(solution.radiation_damping), 1e-3 * inertia)).max()))
        excitation = solution.excitation_force
        expected = -2.0 * flux[:, None] * solution.radiated_wave[:, :, 0]
        largest = np.abs(excitation).max(axis=0)
        scale_x = np.where(largest > 1e-9 * _force_scale(solution), largest, np.inf)
        haskind.append(float((np.abs(excitation - expected).max(axis=0) / scale_x).max()))
    return (
        IdentityCheck(
            "energy of the fixed section",
            worst(energy),
            accuracy,
            "|R|^2 + |T|^2 + loss in the lid = 1 [eq:potential-energy]",
        ),
        IdentityCheck(
            "symmetry of added mass",
            worst(symmetry),
            accuracy,
            "A_ij = A_ji, over the largest sqrt(A_ii A_jj) of the band",
        ),
        IdentityCheck(
            "Haskind relation",
            worst(haskind),
            accuracy,
            "X_j = -2 rho g C_g cos(beta) r_j on the minus side, over the largest |X_j| [eq:potential-haskind]",
        ),
        IdentityCheck(
            "damping by pressure and by waves",
            worst(damping),
            accuracy,
            "B_ij = rho g C_g cos(beta) sum of r_i r_j* + loss in the lid, over the largest sqrt(B_ii B_jj) of the "
            "band, or a thousandth of omega A where the section hardly makes waves [eq:potential-damping]",
        ),
        IdentityCheck(
            "resolution of the potentials",
            tails,
            accuracy,
            "last two Legendre coefficients on a panel, weighted by its length, over the largest potential",
        ),
    )


def _pair_scale(coefficient: Array) -> Array:
    """Largest sqrt(C_ii C_jj) of the band; infinite where a mode moves no water."""
    diagonal = np.abs(np.einsum("wii->wi", coefficient)).max(axis=0)
    diagonal = np.where(diagonal > 0.0, diagonal, np.inf)
    return np.asarray(np.sqrt(np.outer(diagonal, diagonal)))


def _force_scale(solution: HeadingSolution) -> Array:
    """Scale of the force on each mode from what its own motion costs, to find which excitation is zero."""
    states = solution.states
    inertia = states.omega[:, None] ** 2 * np.abs(np.einsum("wii->wi", solution.added_mass))
    return np.asarray(inertia.max(axis=0) + np.abs(solution.froude_krylov_force).max(axis=0))
