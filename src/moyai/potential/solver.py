"""Radiation and diffraction of linear waves by sections in constant or infinite depth, by Green's identity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.progress import Progress, silent
from moyai.core.results import Status
from moyai.core.validity import IdentityCheck
from moyai.potential.checks import (
    check_arguments,
    check_frequencies,
    check_headings,
    check_section,
    gap_notices,
    identity_checks,
)
from moyai.potential.edges import Edges
from moyai.potential.heading import HeadingSolution, Problem, solve_in_chunks, wave_states
from moyai.potential.limits import limit_added_mass
from moyai.potential.mesh import Resolution, lay_out
from moyai.potential.modes import Modes
from moyai.potential.panels import gauss_rule
from moyai.potential.sections import Section
from moyai.potential.solution import RadiationDiffraction
from moyai.potential.system import SymmetryBlock, reduce_blocks
from moyai.sea.dispersion import wave_number as linear_wave_number
from moyai.sea.water import Water, check_water

# How often the panels are refined when an identity misses its tolerance
_ATTEMPTS = 4


def solve(
    section: Section,
    water: Water,
    omega: ArrayLike,
    *,
    modes: Modes,
    heading: ArrayLike = 0.0,
    lid: float | None = None,
    accuracy: float = 1e-3,
    progress: Progress = silent,
) -> RadiationDiffraction:
    """Solve radiation of all modes and diffraction of all headings [eq:potential-green].

    Parameters
    ----------
    section : Section
        Wetted boundary of any number of bodies, at still water or below it.
    water : Water
        Depth (may be infinite), density, gravity.
    omega : array_like
        Angular frequencies [rad/s].
    modes : Modes
        For instance :func:`moyai.potential.modes.rigid_modes`.
    heading : array_like
        Directions beta [rad] in which the incident waves travel, 0 along +x, within +-89.5 degrees. An oblique wave
        needs matrices of its own at every frequency: some 20 ms each, against 0.3 ms for a normal one.
    lid : float, optional
        Damping eps of the free surface enclosed between bodies, phi_z = K (1 + i eps) phi there; none by default.
    accuracy : float
        Target error relative to the largest value of a coefficient over the band. The identities are compared with it;
        where one misses it the panels are refined.
    progress : Progress
        Listener; a KeyboardInterrupt raised in it (or by the keyboard) hands back the frequencies that are done.

    Returns
    -------
    RadiationDiffraction
        Status ``converged``, ``not_converged`` when an identity still misses ``accuracy`` after the refinements, or
        ``interrupted``.

    Raises
    ------
    InputError
        For frequencies or headings out of range, a hull that is not set into the water, modes of another kind, or a
        section that touches the bed.

    Examples
    --------
    >>> from moyai.potential import rigid_modes, shapes, solve
    >>> from moyai.sea import Water
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> section = shapes.rectangle(beam=4.0, height=2.0).immersed(draught=1.0)
    >>> found = solve(section, water, [1.0, 1.5], modes=rigid_modes(centre=(0.0, -0.2)))
    >>> found.added_mass.shape                                       # frequency, mode, mode
    (2, 3, 3)
    >>> energy = abs(found.reflection_coefficient) ** 2 + abs(found.transmission_coefficient) ** 2
    >>> energy[:, 0].round(3).tolist()                               # of the section held fixed
    [1.0, 1.0]
    """
    check_water(water)
    check_arguments(section, modes)
    frequencies = check_frequencies(omega)
    headings = check_headings(heading)
    check_section(section, water)
    damping = 0.0 if lid is None else float(lid)
    if not (math.isfinite(damping) and damping >= 0.0):
        raise InputError(f"lid is {damping:g}", parameter="lid", allowed="0 or more (0.01 to 0.1 is usual)")
    if not 1e-9 <= accuracy <= 0.1:
        raise InputError(f"accuracy is {accuracy:g}", parameter="accuracy", allowed="1e-9 to 0.1")
    wave_number = np.atleast_1d(np.asarray(linear_wave_number(frequencies, water.depth, water.gravity)))

    resolution = Resolution.for_accuracy(accuracy)
    for attempt in range(_ATTEMPTS):
        found = _solve_once(
            section, water, frequencies, wave_number, modes, headings, damping, accuracy, resolution, progress
        )
        if found.status != "not_converged" or attempt == _ATTEMPTS - 1:
            break
        resolution = resolution.refined()
    return replace(found, notices=gap_notices(section, water, frequencies, damping))


def _solve_once(
    section: Section,
    water: Water,
    omega: Array,
    wave_number: Array,
    modes: Modes,
    headings: Array,
    lid: float,
    accuracy: float,
    resolution: Resolution,
    progress: Progress,
) -> RadiationDiffraction:
    """Solve with panels of one resolution and compare the result with the identities."""
    band = float(wave_number.min()), float(wave_number.max())
    layout = lay_out(section, water.depth, band, resolution)
    problem = Problem.of(layout, water, lid, modes)
    blocks = reduce_blocks(layout, water.depth, lid)
    normal, done = solve_in_chunks(
        lambda _: (problem, blocks), wave_states(omega, wave_number, 0.0, water), 0.0, blocks[0].chunk, progress
    )
    solutions: list[HeadingSolution] = [normal]
    problems = [problem]
    # What a wave does to the section depends on cos(beta) only
    for angle in sorted({float(value) for value in np.abs(headings)} - {0.0}):
        if not done:
            break
        oblique, oblique_problem, done = _solve_oblique(
            section, water, omega, wave_number, angle, modes, lid, resolution, progress
        )
        solutions.append(oblique)
        problems.append(oblique_problem)

    tails = max(_tail(solution, item) for solution, item in zip(solutions, problems))
    checks = identity_checks(solutions, water, accuracy, tails)
    limits = [
        limit_added_mass(problem, section.waterplane_breadth, infinite_frequency=which) for which in (True, False)
    ]
    if any(_blocks_the_water(plate.edges, water.depth) for plate in section.wetted_plates):
        # The water on either side of a wall from surface to bed has nowhere to go slowly
        limits[1] = np.full_like(limits[1], np.nan)
    status, message = _verdict(done, checks, len(normal.states.omega), len(omega))
    return RadiationDiffraction(
        section=section,
        water=water,
        modes=modes,
        heading=headings,
        lid=lid,
        normal=normal,
        oblique=tuple(solutions[1:]),
        infinite_frequency_added_mass=limits[0],
        zero_frequency_added_mass=limits[1],
        unknowns=len(layout.panels.u) * (1 if layout.axis is None else 2),
        status=status,
        message=message,
        checks=checks,
    )


def _blocks_the_water(plate: Edges, depth: float) -> bool:
    """Tell whether a plate runs from the still water to the bed."""
    ends = plate.start[0, 1], plate.end[-1, 1]
    return bool(max(ends) == 0.0 and min(ends) + depth < 1e-6 * depth)


def _solve_oblique(
    section: Section,
    water: Water,
    omega: Array,
    wave_number: Array,
    angle: float,
    modes: Modes,
    lid: float,
    resolution: Resolution,
    progress: Progress,
) -> tuple[HeadingSolution, Problem, bool]:
    """Solve one oblique heading; its kernel and the panels on the free surface change with the frequency."""
    states = wave_states(omega, wave_number, angle, water)
    crest = wave_number * math.sin(angle)
    widest = float(states.along.min()), float(wave_number.max())
    whole = lay_out(section, water.depth, widest, resolution, crest_wave_number=float(crest.max()))

    def prepare(number: int) -> tuple[Problem, list[SymmetryBlock]]:
        band = float(states.along[number]), float(wave_number[number])
        kappa = float(crest[number])
        layout = lay_out(section, water.depth, band, resolution, crest_wave_number=kappa, body=whole)
        return Problem.of(layout, water, lid, modes), reduce_blocks(layout, water.depth, lid, kappa)

    solution, done = solve_in_chunks(prepare, states, angle, 1, progress)
    return solution, Problem.of(whole, water, lid, modes), done


def _tail(solution: HeadingSolution, problem: Problem) -> float:
    """Largest share of the last two Legendre coefficients in a potential, weighted by the length of the panel."""
    body = problem.body
    rule = gauss_rule(body.order)
    potential = np.concatenate([solution.radiation, solution.scattered[:, :, None]], axis=2)
    shape = (len(potential), len(body.pieces), body.order, potential.shape[2])
    last = np.einsum("np,wjpr->wjnr", rule.projection[-2:], potential.reshape(shape))
    length = body.weight.real.reshape(len(body.pieces), body.order).sum(axis=1)
    share = np.sqrt(length / length.sum())
    largest = np.abs(potential).max(axis=(0, 1))
    largest = np.where(largest > 0.0, largest, np.inf)
    return float((np.abs(last) * share[None, :, None, None] / largest).max())


def _verdict(done: bool, checks: Sequence[IdentityCheck], count: int, wanted: int) -> tuple[Status, str]:
    if not done:
        return "interrupted", f"{count} of {wanted} frequencies done"
    missed = [check for check in checks if not check.passed]
    if missed:
        return "not_converged", "; ".join(f"{check.name} misses by {check.value:.2g}" for check in missed)
    return "converged", f"all identities within {checks[0].tolerance:g}"
