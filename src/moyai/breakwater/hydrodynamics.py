"""Which frequencies a breakwater needs, and its hydrodynamic coefficients there."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from moyai.breakwater.assembly import FloatingUnit
from moyai.breakwater.model import BreakwaterProblem, IrregularSea, RegularSea
from moyai.core.progress import Progress, silent
from moyai.core.validity import IdentityCheck, Notice
from moyai.floating.coefficients import Hydrodynamics
from moyai.potential.modes import rigid_modes
from moyai.potential.solver import RadiationDiffraction, solve
from moyai.sea.dispersion import angular_frequency, wave_number

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]

CoefficientsOf = Callable[[FloatingUnit], "xr.Dataset"]
"""Gives planar coefficients of the whole unit from another program, for a unit at rest."""

SHORTEST_WAVE_OVER_BEAM = 1.0  # operators are drawn from L/B = 1, where a floating breakwater lets nothing pass,
LONGEST_WAVE_OVER_BEAM = 12.0  # to 12, where it stops nothing
OPERATOR_FREQUENCIES = 60
BAND_TOP = 16.0  # K d of the highest frequency: waves that reach a sixteenth of the draught down
BAND_COUNT = 110
OBLIQUE_FREQUENCIES = 48
ENERGY_LEFT_OUT = 1e-3  # share of a spectrum beyond the highest frequency of its analysis


@dataclass(frozen=True)
class UnitHydrodynamics:
    """Coefficients of the unit at one water level.

    Parameters
    ----------
    per_metre : xarray.Dataset
        In Capytaine's names, per metre of structure (or of the whole unit from a 3-D program, attribute ``length``).
    oblique_per_metre : xarray.Dataset or None
        The oblique headings of the case.
    unit : Hydrodynamics
        Of the whole unit in normal incidence, over the whole band.
    by_heading : tuple of Hydrodynamics
        The same, one heading each, with the radiation that belongs to that heading.
    solution : RadiationDiffraction or None
        Of the section; ``None`` with coefficients of another program.
    checks : tuple of IdentityCheck
    notices : tuple of Notice
    """

    per_metre: xr.Dataset
    oblique_per_metre: xr.Dataset | None
    unit: Hydrodynamics
    by_heading: tuple[Hydrodynamics, ...]
    solution: RadiationDiffraction | None
    checks: tuple[IdentityCheck, ...]
    notices: tuple[Notice, ...]

    def at(self, omega: Array, heading: float) -> Hydrodynamics:
        """Return the coefficients at other frequencies for one heading that was computed.

        In oblique waves the radiation is that of a long structure whose motion runs along it with the wave.
        """
        return self.by_heading[self._index(heading)].at(omega)

    def whole(self, heading: float) -> Hydrodynamics:
        """Return the coefficients of one heading at all frequencies that were computed for it."""
        return self.by_heading[self._index(heading)]

    def _index(self, heading: float) -> int:
        known = np.array([float(item.heading[0]) for item in self.by_heading])
        return int(np.argmin(np.abs(known - heading)))


def operator_frequencies(unit: FloatingUnit, problem: BreakwaterProblem) -> Array:
    """Return the frequencies [rad/s] at which response operators are drawn.

    The user's own, or waves of one to twelve beams, evenly in frequency.
    """
    given = problem.settings.angular_frequencies()
    if given is not None:
        return np.unique(given)
    beam, water = unit.breakwater.hull.beam, unit.water
    lengths = beam * np.array([SHORTEST_WAVE_OVER_BEAM, LONGEST_WAVE_OVER_BEAM])
    high, low = angular_frequency(2.0 * math.pi / lengths, water.depth, water.gravity)
    return np.linspace(float(low), float(high), OPERATOR_FREQUENCIES)


def sea_frequencies(problem: BreakwaterProblem) -> Array:
    """Return the frequencies of the sea states: regular waves exactly, spectra over their energy."""
    parts = [np.zeros(0)]
    for sea in problem.environment.sea_states:
        if isinstance(sea, RegularSea):
            parts.append(2.0 * math.pi / np.asarray(sea.periods))
        else:
            parts.append(spectrum_band(sea))
    return np.unique(np.concatenate(parts))


def spectrum_band(sea: IrregularSea, count: int = 80) -> Array:
    """Return frequencies [rad/s] over all but 1e-3 of the energy of a spectrum, half of them crowded by energy."""
    low, high = (float(item) for item in sea.spectrum.quantile(np.array([1e-5, 1.0 - ENERGY_LEFT_OUT])))
    by_energy = sea.spectrum.quantile(np.linspace(1e-5, 1.0 - ENERGY_LEFT_OUT, count // 2))
    grid = np.unique(np.concatenate([np.linspace(low, high, count // 2), np.asarray(by_energy, dtype=float)]))
    # Points closer than a thousandth of the band carry no information and spoil splines
    return np.asarray(grid[np.concatenate([[True], np.diff(grid) > 1e-3 * (high - low)])], dtype=float)


def headings_of(problem: BreakwaterProblem) -> Array:
    """Return the headings [rad] of all sea states, normal incidence first when it is there or there are no seas."""
    headings = [float(sea.heading) for sea in problem.environment.sea_states]
    for sea in problem.environment.sea_states:
        if isinstance(sea, IrregularSea) and sea.spreading is not None:
            headings.extend(spread_headings(sea, np.ones(1))[0])
    return np.unique(np.asarray(headings if headings else [0.0]))


def spread_headings(sea: IrregularSea, omega: Array, count: int = 11) -> tuple[Array, Array]:
    """Return headings [rad] of a spread sea that meet the breakwater, and the share of energy (n, h) of each.

    Gauss-Legendre points over the sector within 75 degrees of the normal; what travels outside of it meets the ends
    rather than the side and is left out: the shares sum to less than one by that part.
    """
    limit = math.radians(75.0)
    nodes, weights = np.polynomial.legendre.leggauss(count)
    heading = limit * nodes
    if sea.spreading is None:
        return np.array([sea.heading]), np.ones((len(omega), 1))
    share = limit * weights * np.asarray(sea.spreading.density((heading - sea.heading)[None, :], omega[:, None]))
    return heading, share


def solve_unit(
    unit: FloatingUnit,
    problem: BreakwaterProblem,
    *,
    coefficients: CoefficientsOf | None = None,
    progress: Progress = silent,
) -> UnitHydrodynamics:
    """Compute the coefficients of the unit for everything that the case asks for.

    Parameters
    ----------
    unit : FloatingUnit
    problem : BreakwaterProblem
    coefficients : callable or None
        Coefficients of a 3-D program in place of the section.
    progress : Progress
    """
    if coefficients is not None:
        data = coefficients(unit)
        whole = Hydrodynamics.from_dataset(data, length=unit.breakwater.length)
        return UnitHydrodynamics(data, None, whole, _headings_of(data, unit.breakwater.length), None, (), ())
    wanted = np.concatenate([operator_frequencies(unit, problem), sea_frequencies(problem)])
    modes, lid, length = rigid_modes(unit.centre), unit.breakwater.gap_damping_lid or None, unit.breakwater.length
    # One solve of the normal heading serves operators, seas, natural periods and memory: a frequency costs little
    normal = solve(
        unit.section,
        unit.water,
        distinct(np.concatenate([wanted, band(unit)])),
        modes=modes,
        lid=lid,
        progress=progress,
    )
    headings = headings_of(problem)
    oblique = headings[headings != 0.0]
    by_heading = [item.scaled_to(length) for item in _headings_of(normal.dataset, 1.0)]
    checks, notices, turned = list(normal.checks), list(normal.notices), None
    if len(oblique):
        # An oblique heading has matrices of its own at every frequency: only what the case asks for
        chosen = oblique_frequencies(problem, wanted)
        found = solve(unit.section, unit.water, chosen, modes=modes, heading=oblique, lid=lid, progress=progress)
        turned = found.dataset
        by_heading.extend(item.scaled_to(length) for item in _headings_of(turned, 1.0))
        checks.extend(replace(check, name=f"oblique waves: {check.name}") for check in found.checks)
        notices.extend(found.notices)
    if normal.status == "interrupted":
        raise KeyboardInterrupt
    return UnitHydrodynamics(
        per_metre=normal.dataset,
        oblique_per_metre=turned,
        unit=by_heading[0],
        by_heading=tuple(sorted(by_heading, key=lambda item: float(item.heading[0]))),
        solution=normal,
        checks=tuple(checks),
        notices=tuple(notices),
    )


def oblique_frequencies(problem: BreakwaterProblem, wanted: Array) -> Array:
    """Return frequencies [rad/s] of oblique headings: regular waves exactly, the rest of the band for splines."""
    regular = [
        2.0 * math.pi / np.asarray(sea.periods) for sea in problem.environment.sea_states if isinstance(sea, RegularSea)
    ]
    even = np.linspace(float(wanted.min()), float(wanted.max()), OBLIQUE_FREQUENCIES)
    return distinct(np.concatenate([*regular, even]))


def distinct(omega: Array) -> Array:
    """Return sorted frequencies; two that differ by rounding only are one."""
    omega = np.unique(omega)
    return np.asarray(omega[np.concatenate([[True], np.diff(omega) > 1e-9 * omega[-1]])], dtype=float)


def band(unit: FloatingUnit) -> Array:
    """Return the frequencies [rad/s] that the memory is made of: from long waves to a sixteenth of the draught."""
    gravity, draught = unit.water.gravity, -unit.section.bottom
    high = math.sqrt(gravity * BAND_TOP / draught)
    share = np.linspace(0.0, 1.0, BAND_COUNT + 1)[1:]
    # Denser towards long waves, where the damping of sway starts steeply
    return np.asarray(high * share * (0.35 + 0.65 * share), dtype=float)


def _headings_of(data: xr.Dataset, length: float) -> tuple[Hydrodynamics, ...]:
    """Take a dataset apart by heading, each with its own radiation where the dataset tells it."""
    out = []
    for index in range(data.sizes["wave_direction"]):
        one = data.isel(wave_direction=[index])
        if "oblique_added_mass" in data:
            own = one.isel(wave_direction=0)
            one = one.assign(
                added_mass=own.oblique_added_mass,
                radiation_damping=own.oblique_radiation_damping,
                radiated_wave=own.oblique_radiated_wave,
            )
        out.append(Hydrodynamics.from_dataset(one, length=length))
    return tuple(out)


def wavelengths(omega: Array, unit: FloatingUnit) -> Array:
    """Return wave lengths [m]."""
    return np.asarray(2.0 * math.pi / wave_number(omega, unit.water.depth, unit.water.gravity))
