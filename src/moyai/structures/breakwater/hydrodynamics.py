"""Which frequencies a breakwater needs, and its hydrodynamic coefficients there."""

from __future__ import annotations

import itertools
import json
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.core.remembered import Remembered, key_of_objects
from moyai.core.store import DatasetStore, key_of
from moyai.core.validity import IdentityCheck, Notice
from moyai.core.version import VERSION
from moyai.floating.coefficients import Hydrodynamics
from moyai.floating.statics import body_to_site
from moyai.potential.damping_model import Start
from moyai.potential.memory_plan import FrequencyPlan, recommend_frequencies, refine_frequencies
from moyai.potential.modes import rigid_modes
from moyai.potential.solution import RadiationDiffraction
from moyai.potential.solver import solve
from moyai.sea.dispersion import angular_frequency, wave_number
from moyai.structures.breakwater.assembly import FloatingUnit
from moyai.structures.breakwater.model import BreakwaterProblem, IrregularSea, RegularSea

if TYPE_CHECKING:
    import xarray as xr


CoefficientsOf = Callable[[FloatingUnit], "xr.Dataset"]
"""Gives planar coefficients per metre of the unit from another program, for a unit at rest."""

SHORTEST_WAVE_OVER_BEAM = 1.0  # operators are drawn from L/B = 1, where a floating breakwater lets nothing pass,
LONGEST_WAVE_OVER_BEAM = 12.0  # to 12, where it stops nothing
OPERATOR_FREQUENCIES = 60
SECTOR = math.radians(75.0)  # headings to either side of the normal that meet the side of the unit
MOST_REFINEMENTS = 6
MOST_SOLVED = 8  # solutions of the normal heading that are kept in memory
MOST_OBLIQUE = 64  # sets of oblique headings that are kept in memory
MOST_MODES = 15  # of the water in a gap, whose frequencies are looked at
AROUND_MODE, END_OVER_EVEN = np.array([0.97, 0.99, 1.0, 1.01, 1.03]), 0.25
UP_TO_END = np.array([0.95, 0.96, 0.97, 0.98, 0.99, 1.0])
MOST_FREQUENCIES = 1500
REFINEMENT_TOLERANCE = 1e-3  # error of interpolated damping over its largest value at which frequencies are added
OBLIQUE_FREQUENCIES = 64
HEADING_TOLERANCE = math.radians(0.5)  # within which a heading of a 3-D program counts as that of the case
DRAFT_STEPS = 0.01, math.radians(1.0)  # of draught over height and of heel, to which a draft takes coefficients
MOST_ALONG = 400
WAVE_NUMBER_STEP, END_STEP = 0.25, 1.1  # of wave number times half beam; ratio of frequencies
ENERGY_LEFT_OUT = 1e-3  # share of a spectrum beyond the highest frequency of its analysis


@dataclass(frozen=True)
class UnitHydrodynamics:
    """Coefficients of the unit at one water level."""

    #: In Capytaine's names, per metre of structure (or of the whole unit from a 3-D program, attribute ``length``).
    per_metre: xr.Dataset
    #: The oblique headings of the case.
    oblique_per_metre: xr.Dataset | None
    #: Of the whole unit in normal incidence, over the whole band.
    unit: Hydrodynamics
    #: The same, one heading each, with the radiation that belongs to that heading.
    by_heading: tuple[Hydrodynamics, ...]
    #: Of the section; ``None`` with coefficients of another program.
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
    """Return the frequencies [rad/s] of irregular seas over their energy; of regular ones too in a draft."""
    parts = [np.zeros(0)]
    for sea in problem.environment.sea_states:
        if isinstance(sea, IrregularSea):
            parts.append(spectrum_band(sea))
        elif problem.nominal:
            parts.append(2.0 * math.pi / np.asarray(sea.periods))
    return np.unique(np.concatenate(parts))


def sea_ends(unit: FloatingUnit, problem: BreakwaterProblem) -> Array:
    """Return the ends [rad/s] of what the seas need; empty without seas to interpolate.

    In steps of :data:`END_STEP` of the frequency sqrt(g / beam), so that a model has those of its prototype. Regular
    waves are solved exactly but in a draft.
    """
    reached = sea_frequencies(problem)
    if not reached.size:
        return reached
    own = math.sqrt(unit.water.gravity / unit.breakwater.hull.beam)
    steps = np.log(reached[[0, -1]] / own) / math.log(END_STEP)
    return np.asarray(own * END_STEP ** np.array([math.floor(steps[0]), math.ceil(steps[1])]))


def _regular(problem: BreakwaterProblem) -> Array:
    """Return the frequencies [rad/s] of regular waves; none in a draft."""
    seas = () if problem.nominal else problem.environment.sea_states
    parts = [2.0 * math.pi / np.asarray(sea.periods) for sea in seas if isinstance(sea, RegularSea)]
    return np.concatenate([np.zeros(0), *parts])


def section_frequencies(unit: FloatingUnit, problem: BreakwaterProblem) -> Array:
    """Return the frequencies [rad/s] at which the section is solved in normal incidence.

    Those of operators, memory and regular waves, and steps of :data:`WAVE_NUMBER_STEP` up to the shortest wave of the
    seas, for splines to follow the phase of short waves along the section. Seas move the two ends alone: states of one
    study share coefficients. A section so wide that this takes more than :data:`MOST_ALONG` is solved at the
    frequencies of the seas themselves.
    """
    known = np.concatenate([operator_frequencies(unit, problem), wide_band(unit)])
    ends, water = sea_ends(unit, problem), unit.water
    if not ends.size:
        return distinct(np.concatenate([known, _regular(problem)]))
    step = 2.0 * WAVE_NUMBER_STEP / unit.breakwater.hull.beam
    count = math.ceil(float(wave_number(ends[1], water.depth, water.gravity)) / step)
    if count > MOST_ALONG:
        return distinct(np.concatenate([known, _regular(problem), sea_frequencies(problem)]))
    along = angular_frequency(step * np.arange(1, count + 1), water.depth, water.gravity)
    gaps = sloshing_frequencies(unit, float(along[-1]))
    return distinct(np.concatenate([known, _regular(problem), along, gaps, ends[ends < known.min()]]))


_BANDS: Remembered[Array] = Remembered(16)


def spectrum_band(sea: IrregularSea, count: int = 200) -> Array:
    """Return frequencies [rad/s] over all but 1e-3 of the energy of a spectrum, half of them crowded by energy."""
    return _BANDS.of(key_of_objects(sea.spectrum, count), lambda: _spectrum_band(sea, count)).copy()


def _spectrum_band(sea: IrregularSea, count: int) -> Array:
    by_energy = np.asarray(sea.spectrum.quantile(np.linspace(1e-5, 1.0 - ENERGY_LEFT_OUT, count // 2)), dtype=float)
    low, high = float(by_energy[0]), float(by_energy[-1])
    grid = np.concatenate([np.linspace(low, high, count // 2), by_energy])
    # Seas that differ in height alone have the same frequencies to the last digit, and share their coefficients
    grid = np.unique([float(f"{frequency:.11g}") for frequency in grid])
    # Points closer than a thousandth of the band to the last one kept carry no information and spoil splines
    kept = [grid[0]]
    for frequency in grid[1:]:
        if frequency - kept[-1] > 1e-3 * (high - low):
            kept.append(frequency)
    return np.array(kept, dtype=float)


def headings_of(problem: BreakwaterProblem) -> Array:
    """Return the headings [rad] of all sea states, normal incidence first when it is there or there are no seas."""
    headings = [float(sea.heading) for sea in problem.environment.sea_states]
    for sea in problem.environment.sea_states:
        if isinstance(sea, IrregularSea) and sea.spreading is not None:
            headings.extend(spread_headings(sea, np.ones(1))[0])
    return np.unique(np.asarray(headings if headings else [0.0]))


def spread_headings(sea: IrregularSea, omega: Array, count: int = 15) -> tuple[Array, Array]:
    """Return headings [rad] of a spread sea that meet the breakwater, and the share of energy (n, h) of each.

    Even cells over the headings that carry all but 1e-3 of the energy, within 75 degrees of the normal. The share of a
    cell is the exact integral of the spreading over it, so that the energy is kept however narrow the sea. What travels
    outside of the sector meets the ends rather than the side and is left out: the shares sum to less than one by that.
    """
    if sea.spreading is None:
        return np.array([sea.heading]), np.ones((len(omega), 1))
    peaks = np.asarray(sea.spectrum.quantile(np.array([0.02, 0.5, 0.98])), dtype=float)
    ends = np.asarray(sea.spreading.quantile(np.array([[5e-4], [1.0 - 5e-4]]), peaks[None, :]))
    low = max(sea.heading + float(ends[0].min()), -SECTOR)
    high = min(sea.heading + float(ends[1].max()), SECTOR)
    if not low < high:
        raise InputError(
            f"{sea.name}: hardly any wave of this sea travels within 75 degrees of the normal of the unit",
            parameter="waves.heading",
            remedy="turn the sea towards the unit or leave it out",
        )
    edges = np.linspace(low, high, count + 1)
    below = np.asarray(sea.spreading.cumulative(np.clip(edges - sea.heading, -np.pi, np.pi)[None, :], omega[:, None]))
    share = np.diff(np.broadcast_to(below, (len(omega), count + 1)), axis=1)
    # Rounded, so that the middle of a sea straight on is normal incidence and mirrored headings share one solve
    return np.round(0.5 * (edges[1:] + edges[:-1]), 12), share


def solve_unit(
    unit: FloatingUnit,
    problem: BreakwaterProblem,
    *,
    coefficients: CoefficientsOf | None = None,
    store: DatasetStore | None = None,
    progress: Progress = silent,
) -> UnitHydrodynamics:
    """Compute the coefficients of the unit for everything that the case requires.

    Parameters
    ----------
    unit : FloatingUnit
    problem : BreakwaterProblem
    coefficients : callable or None
        Coefficients of a 3-D program in place of the section.
    store : DatasetStore or None
        Where coefficients that took long are kept and looked for.
    progress : Progress
    """
    if coefficients is not None:
        return _given(coefficients(unit), unit, problem)
    unit = _of_draft(unit) if problem.nominal else unit
    wanted = section_frequencies(unit, problem)
    length = unit.breakwater.length
    # One solve of the normal heading serves operators, seas, natural periods and memory: a frequency costs little
    normal, apart = _solve_band(unit, wanted, progress)
    headings = headings_of(problem)
    oblique = headings[headings != 0.0]
    by_heading = [item.scaled_to(length) for item in apart]
    checks, notices, turned = list(normal.checks), list(normal.notices), None
    if len(oblique):
        # An oblique heading has matrices of its own at every frequency: only what the case requires
        chosen = oblique_frequencies(unit, problem)
        turned, found_checks = _oblique(unit, chosen, oblique, store, progress)
        by_heading.extend(item.scaled_to(length) for item in Hydrodynamics.of_headings(turned))
        checks.extend(replace(check, name=f"oblique waves: {check.name}") for check in found_checks)
    return UnitHydrodynamics(
        per_metre=normal.dataset,
        oblique_per_metre=turned,
        unit=by_heading[0],
        by_heading=tuple(sorted(by_heading, key=lambda item: float(item.heading[0]))),
        solution=normal,
        checks=tuple(checks),
        notices=tuple(notices),
    )


def _of_draft(unit: FloatingUnit) -> FloatingUnit:
    """Return the unit at the nearest draught and heel of :data:`DRAFT_STEPS`, to keep its coefficients."""
    reference = unit.breakwater.draught or 0.0
    step = DRAFT_STEPS[0] * unit.breakwater.hull.height
    draught = reference + step * round((unit.draught - reference) / step)
    heel = DRAFT_STEPS[1] * round(unit.heel / DRAFT_STEPS[1])
    section = unit.breakwater.hull.immersed(draught, heel)
    centre = body_to_site(unit.breakwater.centre_of_gravity, draught, heel)
    return replace(unit, draught=draught, heel=heel, section=section, centre=centre)


def coefficients_in_calm(unit: FloatingUnit, problem: BreakwaterProblem) -> Hydrodynamics:
    """Return the coefficients of the normal heading of :func:`solve_unit`, whatever seas the case has."""
    omega = np.concatenate([operator_frequencies(unit, problem), wide_band(unit)])
    return Hydrodynamics.from_section(_solve_band(unit, omega, silent)[0]).scaled_to(unit.breakwater.length)


def _oblique(
    unit: FloatingUnit, omega: Array, headings: Array, store: DatasetStore | None, progress: Progress
) -> tuple[xr.Dataset, tuple[IdentityCheck, ...]]:
    """Solve oblique headings, or take them from the store: they cost a hundred times the normal one."""
    modes, lid = rigid_modes(unit.centre), unit.breakwater.gap_damping_lid or None
    key = _key(unit, omega, headings)

    def solved() -> xr.Dataset:
        held = None if store is None else store.get(key)
        if held is not None:
            return held
        found = solve(unit.section, unit.water, omega, modes=modes, heading=headings, lid=lid, progress=progress)
        if found.status == "interrupted":
            raise KeyboardInterrupt
        if store is not None:
            store.put(key, found.dataset)
        return found.dataset

    data = _OBLIQUE.of(key, solved)
    checks = tuple(
        IdentityCheck(
            item["name"],
            math.nan if item["value"] is None else float(item["value"]),
            float(item["tolerance"]),
            item.get("meaning", ""),
        )
        for item in json.loads(data.attrs["checks"])
    )
    return data, checks


def _key(unit: FloatingUnit, omega: Array, headings: Array) -> str:
    """Return the key of a solve: geometry, position, water, frequencies, headings, lid, version."""
    outlines = [part for outline in unit.section.outlines for part in (outline.vertices, outline.bulges)]
    outlines += [part for plate in unit.section.plates for part in (plate.points, plate.edges.bulge)]
    position = (unit.section.draught, unit.section.heel, unit.centre, unit.breakwater.gap_damping_lid)
    water = (unit.water.depth, unit.water.density, unit.water.gravity)
    return key_of(VERSION, *outlines, position, water, omega, headings)


def oblique_frequencies(unit: FloatingUnit, problem: BreakwaterProblem) -> Array:
    """Return frequencies [rad/s] of oblique headings: regular waves exactly, others for splines."""
    regular = _regular(problem)
    wanted = np.concatenate([operator_frequencies(unit, problem), sea_ends(unit, problem), regular])
    return distinct(np.concatenate([regular, np.linspace(wanted.min(), wanted.max(), OBLIQUE_FREQUENCIES)]))


def _given(data: xr.Dataset, unit: FloatingUnit, problem: BreakwaterProblem) -> UnitHydrodynamics:
    """Take planar coefficients of another program, per metre of the unit.

    Raises
    ------
    InputError
        When a heading of the case is not among them.
    """
    length = unit.breakwater.length
    by_heading = tuple(item.scaled_to(length) for item in Hydrodynamics.of_headings(data))
    known = np.array([float(item.heading[0]) for item in by_heading])
    for heading in headings_of(problem):
        if np.min(np.abs(known - heading)) > HEADING_TOLERANCE:
            raise InputError(
                f"the coefficients hold no heading of {math.degrees(heading):.4g} degrees to the normal of the unit",
                parameter="coefficients_file",
                allowed=", ".join(f"{math.degrees(value):.4g}" for value in np.sort(known)),
                remedy="compute that heading, or change that of the waves",
            )
    order = np.argsort(known)
    normal = by_heading[int(np.argmin(np.abs(known)))]
    return UnitHydrodynamics(data, None, normal, tuple(by_heading[index] for index in order), None, (), ())


def distinct(omega: Array) -> Array:
    """Return sorted frequencies; two that differ by rounding only are one."""
    omega = np.unique(omega)
    return np.asarray(omega[np.concatenate([[True], np.diff(omega) > 1e-9 * omega[-1]])], dtype=float)


def band(unit: FloatingUnit) -> FrequencyPlan:
    """Return the frequencies that the memory of the water is made of, and why these."""
    # A thin wetted side leaves the exact tail late; a hundredth of the beam bounds the effort
    height = max(-unit.section.keel, 0.01 * unit.breakwater.hull.beam)
    if not unit.section.surface_piercing:
        height = max(-unit.section.bounds[3], 0.05 * unit.breakwater.hull.beam)
    return recommend_frequencies(unit.water, breadth=unit.breakwater.hull.beam, wall_height=height)


def wide_band(unit: FloatingUnit) -> Array:
    """Return the frequencies [rad/s] of the memory, those round the resonances of water between hulls with them."""
    omega = band(unit).omega
    return np.concatenate([omega, sloshing_frequencies(unit, float(omega[-1]))])


def sloshing_frequencies(unit: FloatingUnit, top: float) -> Array:
    """Return frequencies [rad/s] round every mode of the water between hulls up to ``top``, and an end of the band.

    Waves of n half lengths in the gap: their peaks are too narrow to be found by chance, and one of sway (n odd) that
    is cut in two at the end of the band spoils the tail of the memory, which ends behind an even one. Without a lid
    they have hardly any width, and nothing is looked for.
    """
    sides = unit.section.waterlines if unit.breakwater.gap_damping_lid else ()
    found = [np.zeros(0)]
    for (_, left), (right, _) in itertools.pairwise(sides):
        if not right > left:
            continue
        half, water = math.pi / (right - left), unit.water
        most = math.floor(float(wave_number(top, water.depth, water.gravity)) / half)
        modes = half * np.arange(1, min(most, MOST_MODES) + 1)
        around = np.ravel(np.asarray(angular_frequency(modes, water.depth, water.gravity))[:, None] * AROUND_MODE)
        if most <= MOST_MODES:
            order = 2 * math.ceil(0.5 * most) + END_OVER_EVEN
            end = float(angular_frequency(order * half, water.depth, water.gravity))
            around = np.concatenate([around[around < end], end * UP_TO_END])
        found.append(around)
    return np.concatenate(found)


def damping_start(unit: FloatingUnit) -> Start:
    """Return how radiation damping starts at zero frequency: an even function in two dimensions and finite depth."""
    return "even" if math.isfinite(unit.water.depth) else "zero"


Solved = tuple[RadiationDiffraction, tuple[Hydrodynamics, ...]]
"""A solution and its coefficients, heading by heading."""
_SOLVED: Remembered[Solved] = Remembered(MOST_SOLVED)
_OBLIQUE: Remembered[xr.Dataset] = Remembered(MOST_OBLIQUE)


def _solve_band(unit: FloatingUnit, omega: Array, progress: Progress) -> Solved:
    """Solve the normal heading; the cases of a study often differ in what does not touch it."""
    grid = distinct(omega)
    return _SOLVED.of(_key(unit, grid, np.zeros(1)), lambda: _taken_apart(_refined(unit, grid, progress)))


def _taken_apart(solution: RadiationDiffraction) -> Solved:
    return solution, (Hydrodynamics.from_section(solution),)


def _refined(unit: FloatingUnit, grid: Array, progress: Progress) -> RadiationDiffraction:
    """Add frequencies where the damping turns sharply (water between twin hulls)."""
    modes, lid = rigid_modes(unit.centre), unit.breakwater.gap_damping_lid or None
    for _ in range(MOST_REFINEMENTS):
        found = solve(unit.section, unit.water, grid, modes=modes, lid=lid, progress=progress)
        if found.status == "interrupted":
            raise KeyboardInterrupt
        damping = found.normal.radiation_damping
        more = refine_frequencies(grid, damping, start=damping_start(unit), tolerance=REFINEMENT_TOLERANCE)
        if not len(more) or len(grid) > MOST_FREQUENCIES:
            break
        grid = distinct(np.concatenate([grid, more]))
    return found


def wavelengths(omega: Array, unit: FloatingUnit) -> Array:
    """Return wave lengths [m]."""
    return np.asarray(2.0 * math.pi / wave_number(omega, unit.water.depth, unit.water.gravity))
