"""Coefficients of all units together over a band of frequencies: solved, kept on disk one file a frequency, checked."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray, IntArray
from moyai.core.curves import Spline
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.core.store import DatasetStore, key_of
from moyai.core.validity import IdentityCheck
from moyai.core.version import VERSION
from moyai.sea.dispersion import group_velocity
from moyai.sea.water import Water
from moyai.structures.units.bem import (
    FADING,
    FEWEST_DIRECTIONS,
    MeshPanels,
    Solution,
    check_memory,
    in_directions,
    solve_frequency,
)

if TYPE_CHECKING:
    import xarray as xr

#: Accepted errors of the mesh, over the largest coefficient of the band
SYMMETRY, HASKIND, ENERGY = 0.1, 0.05, 0.05
#: Solutions that this process read last, oldest first, and their size
_RECENT: dict[str, Solution] = {}
RECENT_BYTES = 200_000_000
#: How coefficients are computed, a part of the key of what is kept: changes where numbers do
METHOD = "exact Green function, its logarithm over panels, far waves about the middle"


@dataclass(frozen=True, eq=False)
class RowHydrodynamics:
    """Coefficients of all units at one water level."""

    #: None of coefficients from a file.
    panels: MeshPanels | None
    water: Water
    #: Centres of gravity [m], row axes; motions are about them; shape (u, 3).
    centres: Array
    #: [rad]; shape (h,).
    headings: Array
    #: In rising frequency.
    solutions: tuple[Solution, ...]
    checks: tuple[IdentityCheck, ...]
    #: Mean drift of the whole row that a file holds [N/m2], [N m/m2]; shape (f, h, 3).
    drift: Array | None = None
    #: All frequencies of the file.
    band: RowHydrodynamics | None = None
    #: Program and file.
    source: str = ""

    @cached_property
    def omega(self) -> Array:
        """Frequencies [rad/s]."""
        return np.array([item.omega for item in self.solutions])

    @cached_property
    def wave_number(self) -> Array:
        """Wave numbers [1/m]."""
        return np.array([item.wave_number for item in self.solutions])

    @cached_property
    def added_mass(self) -> Array:
        """(f, m, m), the symmetric part."""
        values = np.array([item.added_mass for item in self.solutions])
        return np.asarray(0.5 * (values + values.transpose(0, 2, 1)))

    @cached_property
    def damping(self) -> Array:
        """(f, m, m), the symmetric part."""
        values = np.array([item.damping for item in self.solutions])
        return np.asarray(0.5 * (values + values.transpose(0, 2, 1)))

    @cached_property
    def excitation(self) -> ComplexArray:
        """(f, h, m)."""
        return np.array([item.excitation for item in self.solutions])

    @cached_property
    def far(self) -> tuple[ComplexArray, ComplexArray]:
        """Far waves of the row held (f, h, directions) and of its motions (f, m, directions)."""
        count = max(item.radiated.shape[1] for item in self.solutions)
        return (
            np.array([in_directions(item.scattered, count) for item in self.solutions]),
            np.array([in_directions(item.radiated, count) for item in self.solutions]),
        )

    def phase(self, k: Array) -> ComplexArray:
        """Return the phase of the incident waves at the centres (f, h, m) for wave numbers (f,) [1/m]."""
        along = (
            np.cos(self.headings)[:, None] * self.centres[:, 0] + np.sin(self.headings)[:, None] * self.centres[:, 1]
        )
        return np.repeat(np.exp(1j * k[:, None, None] * along), 6, axis=2)

    @property
    def reach(self) -> Array:
        """Distance in plan (u, u) [m] from unit to unit."""
        plan = self.centres[:, :2]
        return np.asarray(np.linalg.norm(plan[:, None] - plan[None, :], axis=2))

    def _travel(self, k: Array) -> ComplexArray:
        """Return the phase of a wave from unit to unit (f, m, m)."""
        turn = np.exp(1j * k[:, None, None] * self.reach)
        return np.repeat(np.repeat(turn, 6, axis=1), 6, axis=2)

    def at(self, omega: Array, k: Array) -> tuple[Array, Array, ComplexArray]:
        """Return added mass, damping (f, m, m) and excitation (f, h, m) at other frequencies, by splines.

        What turns fast with frequency is taken out before: the phase of the incident wave at each unit in the
        excitation, and in the coefficients of two units that of a wave from the one to the other
        [eq:units-interpolation].

        Raises
        ------
        InputError
            Outside of the band that was computed.
        """
        own = self.omega
        if omega.min() < own[0] * (1.0 - 1e-9) or omega.max() > own[-1] * (1.0 + 1e-9):
            raise InputError(
                f"{omega.min():.4g} to {omega.max():.4g} rad/s", parameter="settings.frequencies",
                allowed=f"{own[0]:.4g} to {own[-1]:.4g} rad/s, which was computed",
            )  # fmt: skip
        if len(own) == 1:
            shape = (len(omega), 1, 1)
            return np.tile(self.added_mass, shape), np.tile(self.damping, shape), np.tile(self.excitation, shape)
        if np.array_equal(own, omega):
            return self.added_mass, self.damping, self.excitation
        steady, answer = self._splines
        answers = answer(omega) * self._travel(k)
        return np.asarray(answers.real), np.asarray(answers.imag * omega[:, None, None]), steady(omega) * self.phase(k)

    @cached_property
    def _splines(self) -> tuple[Spline, Spline]:
        """Splines of excitation and of added mass with damping, without what turns fast."""
        own = self.omega
        answer = (self.added_mass + 1j * self.damping / own[:, None, None]) / self._travel(self.wave_number)
        return Spline(own, self.excitation / self.phase(self.wave_number)), Spline(own, answer)

    def among(self, columns: IntArray) -> RowHydrodynamics:
        """Return the coefficients of some of the headings; the seas of one set of headings share them."""
        kept: dict[tuple[int, ...], RowHydrodynamics] = self.__dict__.setdefault("_among", {})
        key = tuple(int(column) for column in columns)
        if key not in kept:
            drift = None if self.drift is None else self.drift[:, columns]
            solutions = tuple(item.among(columns) for item in self.solutions)
            kept[key] = replace(self, headings=self.headings[columns], solutions=solutions, drift=drift)
        return kept[key]


def solve_row(
    panels: MeshPanels,
    water: Water,
    centres: Array,
    omega: Array,
    headings: Array,
    *,
    store: DatasetStore | None = None,
    progress: Progress = silent,
) -> RowHydrodynamics:
    """Solve every frequency, or take it from the store.

    Parameters
    ----------
    panels : Panels
    water : Water
    centres : ndarray (u, 3)
        [m], row axes.
    omega, headings : ndarray
        [rad/s], [rad].
    store : DatasetStore or None
        Where each frequency is kept as soon as it is solved.
    progress : Progress
        Called after every frequency.

    Raises
    ------
    InputError
        When the machine has not the memory, before anything is solved.
    """
    check_memory(panels)
    solutions = []
    base = key_of(
        VERSION, METHOD, panels.mesh.corners, panels.mesh.part, centres, panels.gap_damping, panels.even,
        (water.depth, water.density, water.gravity), headings, FEWEST_DIRECTIONS, FADING,
    )  # fmt: skip
    for index, frequency in enumerate(omega):
        progress("coefficients of the row", index, len(omega))
        key = key_of(base, float(frequency))
        found = None if store is None else _at_hand(store, key)
        if found is None:
            found = solve_frequency(panels, water, float(frequency), headings)
            if store is not None:
                store.put(key, _to_dataset(found))
        solutions.append(found)
    progress("coefficients of the row", len(omega), len(omega))
    return RowHydrodynamics(
        panels, water, centres, headings, tuple(solutions), _checks(tuple(solutions), panels, water)
    )


def _at_hand(store: DatasetStore, key: str) -> Solution | None:
    """Return a solution out of memory or out of the store."""
    found = _RECENT.pop(key, None)
    if found is None:
        kept = store.get(key)
        found = None if kept is None else _from_dataset(kept)
    if found is not None:
        _RECENT[key] = found
        while sum(_size(item) for item in _RECENT.values()) > RECENT_BYTES and len(_RECENT) > 1:
            _RECENT.pop(next(iter(_RECENT)))
    return found


def _size(found: Solution) -> int:
    return found.radiation.nbytes + found.diffraction.nbytes


_FIELDS = {
    "added_mass": ("influenced", "radiating"),
    "damping": ("influenced", "radiating"),
    "excitation": ("heading", "influenced"),
    "radiation": ("panel", "radiating"),
    "diffraction": ("panel", "heading"),
    "radiated": ("radiating", "direction"),
    "scattered": ("heading", "direction"),
    "haskind": ("kind",),
}


def _to_dataset(found: Solution) -> xr.Dataset:
    import xarray as xr

    data = {name: (dims, getattr(found, name)) for name, dims in _FIELDS.items()}
    numbers = {name: getattr(found, name) for name in ("omega", "wave_number")}
    return xr.Dataset(data, attrs=numbers)


def _from_dataset(data: xr.Dataset) -> Solution | None:
    try:
        arrays: dict[str, Any] = {name: data[name].transpose(*dims).values for name, dims in _FIELDS.items()}
        numbers: dict[str, Any] = {name: float(data.attrs[name]) for name in ("omega", "wave_number")}
    except (KeyError, ValueError):
        return None
    return Solution(**numbers, **arrays)


def _checks(solutions: tuple[Solution, ...], panels: MeshPanels, water: Water) -> tuple[IdentityCheck, ...]:
    symmetry = max(asymmetry(item.added_mass, solutions, "added_mass") for item in solutions)
    symmetry = max(symmetry, max(asymmetry(item.damping, solutions, "damping") for item in solutions))
    size = np.max([np.abs(item.excitation).reshape(-1, 6).max(axis=0) for item in solutions], axis=0)
    apart = np.max([item.haskind for item in solutions], axis=0)
    checks = [
        IdentityCheck("coefficients of the row are symmetric", symmetry, SYMMETRY, "A_ij = A_ji, B_ij = B_ji"),
    ]
    haskind = float(np.max(apart / np.where(size > 1e-9 * size.max(), size, np.inf)))
    checks.append(
        IdentityCheck("excitation by Haskind's relation", haskind, HASKIND, "the same from the radiation alone")
    )
    if panels.gap_damping == 0.0:
        checks.append(
            IdentityCheck(
                "damping is the energy of the waves that go away", radiated_energy(solutions, water), ENERGY,
                "B_jj from the far field, over the largest B_jj of the band",
            )
        )  # fmt: skip
    return tuple(checks)


def _kinds(matrix: Array) -> Array:
    """Return the largest entry for every pair of kinds of motion (6, 6)."""
    units = len(matrix) // 6
    return np.asarray(np.abs(matrix).reshape(units, 6, units, 6).max(axis=(0, 2)))


def asymmetry(matrix: Array, solutions: tuple[Solution, ...], name: str) -> float:
    """Return the asymmetry over the geometric mean of the largest diagonal entries of the band."""
    diagonal = np.max([_kinds(getattr(item, name)).diagonal() for item in solutions], axis=0)
    scale = np.sqrt(np.outer(diagonal, diagonal))
    return float(np.max(_kinds(matrix - matrix.T) / np.where(scale > 0.0, scale, np.inf)))


def radiated_energy(solutions: tuple[Solution, ...], water: Water) -> float:
    """Return the largest departure of B_jj from the energy of its far waves [eq:units-radiated-energy]."""
    own = np.array([item.damping.diagonal() for item in solutions])
    far = np.array([far_damping(item, water).diagonal() for item in solutions])
    size = np.abs(own).reshape(len(own), -1, 6).max(axis=(0, 1))
    apart = np.abs(own - far).reshape(len(own), -1, 6).max(axis=(0, 1))
    return float(np.max(apart / np.where(size > 0.0, size, np.inf)))


def far_damping(found: Solution, water: Water) -> Array:
    """Return the damping (m, m) that the far waves carry away [eq:units-radiated-energy]."""
    speed = float(group_velocity(found.omega, water.depth, water.gravity))
    factor = 2.0 * water.density * water.gravity * speed / (math.pi * found.wave_number * found.omega**2)
    step = 2.0 * math.pi / found.radiated.shape[1]
    return np.asarray(factor * step * np.real(found.radiated @ found.radiated.conj().T))
