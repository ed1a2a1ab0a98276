"""Exact radiation and diffraction of a surface-piercing rectangle: the independent reference of the package.

Matched solution with the velocity in the gap below the corner as its only unknown. The basis carries the corner
singularities exactly and every coupling is integrated to rounding, so that some twenty unknowns give ten digits where
the usual matched eigenfunctions need hundreds of modes for three. See docs/theory/reference_solvers.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck
from moyai.potential.rectangle_basis import GapBasis
from moyai.potential.rectangle_fields import Fields, inner_region, solve_fields
from moyai.potential.rectangle_outer import outer_kernel
from moyai.sea.dispersion import group_velocity, wave_number
from moyai.sea.water import Water, check_water

if TYPE_CHECKING:
    import xarray as xr

_MODES = ("sway", "heave", "roll")
_SIDES = ("minus", "plus")
#: Sway and roll change sign when the picture is mirrored
_MIRROR = np.array([-1.0, 1.0, -1.0])
#: Waves closer than this to travelling along the structure have no appreciable reflection and transmission
_LEAST_COSINE = 1e-3
#: Sine of the heading below which waves count as travelling along x; the answer changes with its square
_LEAST_SINE = 1e-6
_ALMOST_ZERO = 1e-4  # kh at which the zero-frequency limit is taken; its error is of the order of the square


@dataclass(frozen=True)
class RectangleSolution:
    """Coefficients of a rectangle per metre, convention ``exp(-i omega t)``, phases at x = 0."""

    #: Beam B [m].
    beam: float
    #: Draught d [m].
    draught: float
    #: x, z [m] of the point that roll turns about.
    centre: tuple[float, float]
    #: Depth, density, gravity.
    water: Water
    #: Angular frequencies [rad/s]; shape (n,).
    omega: Array
    #: Directions of travel [rad]; shape (h,).
    heading: Array
    #: Added mass of motions equal along the structure [kg/m, kg, kg m]; shape (n, 3, 3).
    added_mass: Array
    #: Radiation damping of the same motions [kg/(m s), kg/s, kg m/s]; shape (n, 3, 3).
    radiation_damping: Array
    #: Added mass at infinite frequency; shape (3, 3).
    infinite_frequency_added_mass: Array
    #: Added mass at zero frequency; shape (3, 3).
    zero_frequency_added_mass: Array
    #: Wave amplitude per unit velocity towards -x and +x [s, m s]; shape (n, 3, 2).
    radiated_wave: ComplexArray
    #: Exciting force per unit wave amplitude [N/m2, N/m]; shape (n, h, 3).
    excitation_force: ComplexArray
    #: Part of the undisturbed wave in it [N/m2, N/m]; shape (n, h, 3).
    froude_krylov_force: ComplexArray
    #: Reflection coefficient of the body held fixed; shape (n, h).
    reflection_coefficient: ComplexArray
    #: Transmission coefficient of the body held fixed; shape (n, h).
    transmission_coefficient: ComplexArray
    #: Energy, Haskind, symmetry, far-field damping.
    checks: tuple[IdentityCheck, ...]

    @property
    def dataset(self) -> xr.Dataset:
        """The solution in Capytaine's names."""
        import xarray as xr

        matrix = ("radiating_dof", "influenced_dof")
        force = ("omega", "wave_direction", "influenced_dof")
        scatter = ("omega", "wave_direction")
        # [radiating, influenced] is the transpose of the matrices here; they are symmetric to rounding
        table: dict[str, tuple[tuple[str, ...], np.ndarray, str, str]] = {
            "added_mass": (("omega", *matrix), self.added_mass, "added mass per metre", "kg/m, kg, kg m"),
            "radiation_damping": (
                ("omega", *matrix),
                self.radiation_damping,
                "radiation damping per metre",
                "kg/(m s), kg/s, kg m/s",
            ),
            "infinite_frequency_added_mass": (
                matrix,
                self.infinite_frequency_added_mass,
                "added mass at infinite frequency",
                "kg/m, kg, kg m",
            ),
            "zero_frequency_added_mass": (
                matrix,
                self.zero_frequency_added_mass,
                "added mass at zero frequency",
                "kg/m, kg, kg m",
            ),
            "radiated_wave": (
                ("omega", "radiating_dof", "side"),
                self.radiated_wave,
                "radiated wave amplitude per unit velocity",
                "s, m s",
            ),
            "excitation_force": (force, self.excitation_force, "excitation per unit wave amplitude", "N/m2, N/m"),
            "Froude_Krylov_force": (force, self.froude_krylov_force, "force of the undisturbed wave", "N/m2, N/m"),
            "diffraction_force": (
                force,
                self.excitation_force - self.froude_krylov_force,
                "force of the scattered wave",
                "N/m2, N/m",
            ),
            "reflection_coefficient": (scatter, self.reflection_coefficient, "complex reflection, body held", "1"),
            "transmission_coefficient": (
                scatter,
                self.transmission_coefficient,
                "complex transmission, body held",
                "1",
            ),
        }
        return xr.Dataset(
            {
                name: (dims, data, {"long_name": text, "units": units})
                for name, (dims, data, text, units) in table.items()
            },
            coords={
                "omega": ("omega", self.omega, {"long_name": "angular frequency", "units": "rad/s"}),
                "wave_direction": (
                    "wave_direction",
                    self.heading,
                    {"long_name": "direction of travel", "units": "rad"},
                ),
                "radiating_dof": list(_MODES),
                "influenced_dof": list(_MODES),
                "side": list(_SIDES),
            },
            attrs={
                "time_convention": "exp(-i omega t)",
                "direction_convention": "0 = towards +x",
                "solver": "matched rectangle with exact corner singularities",
                "beam": self.beam,
                "draught": self.draught,
                "water_depth": self.water.depth,
                "density": self.water.density,
                "gravity": self.water.gravity,
            },
        )


def solve_rectangle(
    beam: float,
    draught: float,
    water: Water,
    omega: ArrayLike,
    *,
    centre: tuple[float, float],
    heading: ArrayLike = 0.0,
    pairs: int | None = None,
    progress: Progress = silent,
) -> RectangleSolution:
    """Solve radiation and diffraction of a surface-piercing rectangle in water of constant depth [eq:reference-system].

    Parameters
    ----------
    beam, draught : float
        B and d [m].
    water : Water
        Finite depth greater than the draught.
    omega : array_like
        Angular frequencies [rad/s], greater than 0.
    centre : (float, float)
        x, z [m] of the point that roll turns about; x = 0 is the middle, z = 0 the still water.
    heading : array_like
        Directions of travel of the waves [rad]; not along the structure.
    pairs : int, optional
        Functions of each corner family; by default chosen from the geometry for about ten digits.
    progress : Progress
        Listener.

    Returns
    -------
    RectangleSolution
        Coefficients and forces per metre of structure about ``centre``, modes in the order sway, heave, roll, with the
        checks of the identities.

    Raises
    ------
    InputError
        When the depth is infinite or not greater than the draught, or an argument is out of range.

    Notes
    -----
    Infinite depth is not covered, since the gap below the body is the unknown of the method; depths of hundreds of
    draughts are.

    Examples
    --------
    >>> from moyai.potential import solve_rectangle
    >>> from moyai.sea import Water
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> found = solve_rectangle(4.0, 1.0, water, [1.5], centre=(0.0, -0.2))
    >>> found.added_mass.shape, round(float(abs(found.transmission_coefficient[0, 0])), 4)   # [kg/m], [-]
    ((1, 3, 3), 0.7253)
    """
    check_water(water)
    frequencies, headings = _checked(beam, draught, water, omega, centre, heading)
    gap = water.depth - draught
    k = np.atleast_1d(np.asarray(wave_number(frequencies, water.depth, water.gravity), dtype=float))
    count = _pairs(beam, draught, gap, float(k.max())) if pairs is None else int(pairs)
    if count < 2:
        raise InputError(f"pairs is {count}", parameter="pairs", allowed="at least 2")
    shape = _Shape(GapBasis(count), 0.5 * beam / gap, water.depth / gap, draught / gap)
    surface = frequencies**2 / water.gravity * gap
    oblique = np.abs(np.sin(headings)) > _LEAST_SINE
    total = float(len(frequencies) * (1 + np.count_nonzero(oblique)))

    straight, limits = _along_x(shape, surface, k * gap, progress, total)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-centre[1], centre[0], 1.0]])
    size = np.array([1.0, 1.0, gap])
    lever = np.outer(size, size) * gap**2
    moments = turn @ (np.array([fields.potential_moment for fields in straight]) * lever) @ turn.T
    infinite, zero = (-water.density * turn @ (limit * lever) @ turn.T for limit in limits)
    lift = 1j * frequencies / water.gravity * gap * np.array([fields.surface for fields in straight])
    towards_plus = np.array([fields.radiated for fields in straight]) * size * lift[:, None]
    radiated = np.stack([(towards_plus * _MIRROR) @ turn.T, towards_plus @ turn.T], axis=-1)

    answers = [straight] * len(headings)
    done = float(len(frequencies))
    for index in np.flatnonzero(oblique):
        answers[index] = _oblique(shape, surface, k * gap, float(headings[index]))
        done += len(frequencies)
        progress("rectangle", done, total)
    unit = -water.density * water.gravity * gap * size

    def force(name: str) -> ComplexArray:
        columns = []
        for angle, fields_of_heading in zip(headings, answers, strict=True):
            values = np.array([getattr(fields, name) / fields.surface for fields in fields_of_heading])
            columns.append((values * unit * (_MIRROR if math.cos(angle) < 0.0 else 1.0)) @ turn.T)
        return np.stack(columns, axis=1)

    solution = RectangleSolution(
        beam=float(beam),
        draught=float(draught),
        centre=(float(centre[0]), float(centre[1])),
        water=water,
        omega=frequencies,
        heading=headings,
        added_mass=-water.density * moments.real,
        radiation_damping=-water.density * frequencies[:, None, None] * moments.imag,
        infinite_frequency_added_mass=infinite,
        zero_frequency_added_mass=zero,
        radiated_wave=radiated,
        excitation_force=force("exciting_moment"),
        froude_krylov_force=force("incident_moment"),
        reflection_coefficient=np.array([[fields.reflection_coefficient for fields in column] for column in answers]).T,
        transmission_coefficient=np.array(
            [[fields.transmission_coefficient for fields in column] for column in answers]
        ).T,
        checks=(),
    )
    return replace(solution, checks=_identities(solution))


@dataclass(frozen=True)
class _Shape:
    """Rectangle and depth in gap heights, with the functions of the velocity."""

    basis: GapBasis
    half_beam: float
    depth: float
    draught: float


def _checked(
    beam: float, draught: float, water: Water, omega: ArrayLike, centre: tuple[float, float], heading: ArrayLike
) -> tuple[Array, Array]:
    for name, value in (("beam", beam), ("draught", draught)):
        if not (math.isfinite(value) and value > 0.0):
            raise InputError(f"{name} is {value:g}", parameter=name, allowed="greater than 0")
    if math.isinf(water.depth):
        raise InputError(
            "the matched rectangle needs a bed",
            parameter="water.depth",
            allowed="finite",
            remedy="give a depth of many draughts and wave lengths, or use the boundary elements",
        )
    if draught >= water.depth:
        raise InputError(
            f"draught {draught:g} m reaches the bed at {water.depth:g} m",
            parameter="draught",
            allowed="less than the water depth",
        )
    if len(centre) != 2 or not all(math.isfinite(value) for value in centre):
        raise InputError(f"centre is {centre}", parameter="centre", allowed="two finite numbers")
    frequencies = np.atleast_1d(np.asarray(omega, dtype=float))
    if frequencies.ndim != 1 or not np.isfinite(frequencies).all() or (frequencies <= 0.0).any():
        raise InputError(
            "omega has entries that are not finite and positive", parameter="omega", allowed="greater than 0"
        )
    headings = np.atleast_1d(np.asarray(heading, dtype=float))
    if headings.ndim != 1 or not np.isfinite(headings).all() or (np.abs(np.cos(headings)) < _LEAST_COSINE).any():
        raise InputError(
            "a heading runs along the structure or is not finite", parameter="heading", allowed="cos(heading) not 0"
        )
    return frequencies, headings


def _pairs(beam: float, draught: float, gap: float, wave_number: float) -> int:
    """Functions of each family for about ten digits: polynomials resolve sizes of the gap over their degree squared."""
    slenderness = max(gap / draught, 2.0 * gap / beam, wave_number * gap)
    return min(8 + math.ceil(math.sqrt(slenderness)), 48)


def _along_x(
    shape: _Shape, surface: Array, k: Array, progress: Progress, total: float
) -> tuple[list[Fields], tuple[Array, Array]]:
    """Solve all frequencies for waves and motions that are equal along the structure, and the two limits."""
    inner = inner_region(shape.basis, shape.half_beam, 0.0)
    kernel = outer_kernel(shape.basis, shape.depth, shape.draught, 0.0, surface, k)
    fields = []
    for index, (number, wave) in enumerate(zip(surface, k, strict=True)):
        fields.append(solve_fields(inner, kernel, float(number), float(wave)))
        progress("rectangle", index + 1.0, total)
    infinite = solve_fields(inner, kernel, math.inf, math.nan)
    wave = _ALMOST_ZERO / shape.depth
    number = wave * math.tanh(_ALMOST_ZERO)
    slow = outer_kernel(shape.basis, shape.depth, shape.draught, 0.0, np.array([number]), np.array([wave]))
    zero = solve_fields(inner, slow, number, wave)
    return fields, (infinite.potential_moment.real, zero.potential_moment.real)


def _oblique(shape: _Shape, surface: Array, k: Array, angle: float) -> list[Fields]:
    """Solve all frequencies for waves at an angle; the wave number along the crest differs from one to the next."""
    out = []
    for number, wave in zip(surface, k, strict=True):
        along = float(wave) * abs(math.sin(angle))
        inner = inner_region(shape.basis, shape.half_beam, along)
        kernel = outer_kernel(shape.basis, shape.depth, shape.draught, along, np.array([number]), np.array([wave]))
        out.append(solve_fields(inner, kernel, float(number), float(wave)))
    return out


def _identities(solution: RectangleSolution) -> tuple[IdentityCheck, ...]:
    """Compare the solution with what every correct one obeys, [eq:reference-identities]."""
    water, omega = solution.water, solution.omega
    speed = np.atleast_1d(np.asarray(group_velocity(omega, water.depth, water.gravity), dtype=float))
    energy = np.max(
        np.abs(np.abs(solution.reflection_coefficient) ** 2 + np.abs(solution.transmission_coefficient) ** 2 - 1.0)
    )
    mass = solution.added_mass
    scale = np.sqrt(np.abs(np.einsum("nii,njj->nij", mass, mass)).max(axis=0))
    symmetry = np.max(np.abs(mass - np.swapaxes(mass, 1, 2)) / scale)
    r = solution.radiated_wave
    far = water.density * water.gravity * speed[:, None, None] * np.einsum("nis,njs->nij", r, r.conj()).real
    top = np.sqrt(np.einsum("ii,jj->ij", *(2 * (np.abs(far).max(axis=0),))))
    damping = np.max(np.abs(far - solution.radiation_damping) / top)
    checks = [
        IdentityCheck("energy of the fixed rectangle", float(energy), 1e-9, "|R|^2 + |T|^2 = 1"),
        IdentityCheck("symmetry of the added mass", float(symmetry), 1e-9, "a_ij = a_ji"),
        IdentityCheck("far-field damping", float(damping), 1e-8, "b_ij = rho g c_g (r-_i r-_j* + r+_i r+_j*)"),
    ]
    straight = [index for index, angle in enumerate(solution.heading) if abs(math.sin(angle)) <= _LEAST_SINE]
    if straight:
        worst = 0.0
        for index in straight:
            side = 0 if math.cos(solution.heading[index]) > 0.0 else 1
            expected = -2.0 * water.density * water.gravity * speed[:, None] * r[:, :, side]
            force = solution.excitation_force[:, index]
            worst = max(worst, float(np.max(np.abs(force - expected) / np.abs(expected).max(axis=0))))
        checks.append(IdentityCheck("Haskind relation", worst, 1e-9, "X_j = -2 rho g c_g r_j towards the wave"))
    return tuple(checks)
