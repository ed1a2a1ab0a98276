"""Radiation and diffraction of one wave heading over all frequencies, from the reduced blocks to the coefficients."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.progress import Progress
from moyai.potential.mesh import Layout
from moyai.potential.modes import Modes
from moyai.potential.panels import GAP, PLATE, Panels
from moyai.potential.system import SymmetryBlock
from moyai.potential.waves import depth_integral, far_field, incident_wave
from moyai.sea.water import Water


@dataclass(frozen=True, eq=False)
class WaveStates:
    """Frequencies at one heading: omega, K = omega^2/g, k, k cos(beta) [rad/s, 1/m] and the integral of Z^2 [m]."""

    omega: Array
    deep_wave_number: Array
    wave_number: Array
    along: Array
    profile: Array
    group_velocity: Array


def wave_states(omega: Array, wave_number: Array, heading: float, water: Water) -> WaveStates:
    """Collect what the frequencies need at a heading [rad]."""
    deep = omega**2 / water.gravity
    profile = depth_integral(wave_number, water.depth, deep)
    return WaveStates(
        omega=omega,
        deep_wave_number=deep,
        wave_number=wave_number,
        along=wave_number * math.cos(heading),
        profile=profile,
        # C_g = g k / omega times the integral of Z^2, whatever the depth
        group_velocity=water.gravity * wave_number * profile / omega,
    )


@dataclass(frozen=True, eq=False)
class HeadingSolution:
    """Coefficients and potentials of one heading, per metre of structure; frequencies first.

    Modes vary as exp(i k sin(beta) y) along the structure. Radiation is for unit velocity, diffraction for unit wave
    amplitude.
    """

    #: beta [rad].
    heading: float
    #: The frequencies.
    states: WaveStates
    #: Nodes of the whole wetted boundary, on which potentials are given.
    body: Panels
    #: Nodes of the free surface, on which potentials are given.
    surface: Panels
    #: [kg/m] for translations. Damping is that of the waves sent out (and of the lid), which is exact to a share of
    #: itself however small it is. Shape (omega, radiating, influenced).
    added_mass: Array
    #: [kg/m/s] for translations. Damping is that of the waves sent out (and of the lid), which is exact to a share of
    #: itself however small it is. Shape (omega, radiating, influenced).
    radiation_damping: Array
    #: The same by integration of the pressure, exact to a share of the added mass only; for the check; shape (omega,
    #: radiating, influenced).
    pressure_damping: Array
    #: Force of the undisturbed wave [N/m per m]; shape (omega, mode).
    froude_krylov_force: ComplexArray
    #: Force of the scattered wave [N/m per m]; shape (omega, mode).
    diffraction_force: ComplexArray
    #: Wave amplitude on the minus and the plus side per unit velocity [m per m/s]; shape (omega, mode, 2).
    radiated_wave: ComplexArray
    #: Reflection coefficient of the section held fixed, phase at x = 0; shape (omega,).
    reflection_coefficient: ComplexArray
    #: Transmission coefficient of the section held fixed, phase at x = 0; shape (omega,).
    transmission_coefficient: ComplexArray
    #: Share of the incident energy that the lid takes when the section is held fixed; shape (omega,).
    lid_loss: Array
    #: Part of the radiation damping that the lid takes; shape (omega, mode, mode).
    lid_damping: Array
    #: Potential on the nodes of the body [m2/s per m/s]; shape (omega, n, mode).
    radiation: ComplexArray
    #: Potential on the nodes of the free surface [m2/s per m/s]; shape (omega, n, mode).
    radiation_surface: ComplexArray
    #: The same of the scattered wave [m2/s per m]; shape (omega, n).
    scattered: ComplexArray
    #: The same of the scattered wave [m2/s per m]; shape (omega, n).
    scattered_surface: ComplexArray

    @property
    def excitation_force(self) -> ComplexArray:
        """Froude-Krylov plus diffraction force (omega, mode)."""
        return np.asarray(self.froude_krylov_force + self.diffraction_force)


def join(parts: Sequence[HeadingSolution]) -> HeadingSolution:
    """Put solutions at successive frequencies of one heading together."""
    if len(parts) == 1:
        return parts[0]
    states = WaveStates(
        **{
            item.name: np.concatenate([getattr(part.states, item.name) for part in parts])
            for item in fields(WaveStates)
        }
    )
    arrays: dict[str, Any] = {
        item.name: np.concatenate([getattr(part, item.name) for part in parts])
        for item in fields(HeadingSolution)
        if item.name not in ("heading", "states", "body", "surface")
    }
    return replace(parts[0], states=states, **arrays)


@dataclass(frozen=True, eq=False)
class Problem:
    """What stays the same over frequencies and headings: nodes of the whole boundary and what the modes do there."""

    layout: Layout
    water: Water
    lid: float
    body: Panels
    surface: Panels
    displacement: Array

    @classmethod
    def of(cls, layout: Layout, water: Water, lid: float, modes: Modes) -> Problem:
        """Evaluate the modes on the nodes of the whole boundary."""
        body = layout.whole_body
        displacement = modes.normal_displacement(body.points, body.normal, body.body.astype(np.intp))
        return cls(layout, water, lid, body, layout.whole_surface, displacement)

    def split(self, whole: ComplexArray, sign: int) -> ComplexArray:
        """Return the symmetric (1) or antisymmetric (-1) part (waves, half, problems) of values on the whole body."""
        if sign == 0:
            return whole
        half = whole.shape[1] // 2
        return np.asarray(0.5 * (whole[:, half:] + sign * whole[:, half - 1 :: -1][:, :half]))


def _whole(parts: dict[int, ComplexArray]) -> ComplexArray:
    """Join both symmetries to values on the whole boundary, mirrored half first and reversed."""
    if 0 in parts:
        return parts[0]
    right, left = parts[1] + parts[-1], parts[1] - parts[-1]
    return np.concatenate([left[:, ::-1], right], axis=1)


def solve_states(
    problem: Problem, blocks: Sequence[SymmetryBlock], states: WaveStates, heading: float
) -> HeadingSolution:
    """Solve radiation of all modes and diffraction at frequencies that share the same blocks."""
    water, body, surface = problem.water, problem.body, problem.surface
    count = len(problem.displacement)
    weight = body.weight.real
    wave, gradient = incident_wave(body.points, states.wave_number, states.along, water.depth)
    wave_flux = np.einsum("wnc,nc->wn", gradient, body.normal)
    flux = np.empty((len(states.omega), len(weight), count + 1), dtype=complex)
    flux[:, :, :count] = problem.displacement.T
    flux[:, :, count] = -wave_flux

    # The lid takes from the incident wave too: the scattered wave starts from there [eq:potential-lid]
    gap = np.flatnonzero(surface.kind == GAP) if problem.lid > 0.0 else np.empty(0, dtype=int)
    lid = problem.lid * states.deep_wave_number[:, None]
    gap_wave = incident_wave(surface.points[gap], states.wave_number, states.along, water.depth)[0]
    source = None
    if gap.size:
        source = np.zeros((len(states.omega), len(surface.u), count + 1), dtype=complex)
        source[:, gap, count] = 1j * lid * gap_wave / (1.0 + 1j * problem.lid)

    on_body: dict[int, ComplexArray] = {}
    on_surface: dict[int, ComplexArray] = {}
    for block in blocks:
        on_body[block.sign], on_surface[block.sign] = block.solve(
            states.deep_wave_number,
            problem.split(flux, block.sign),
            None if source is None else problem.split(source, block.sign),
        )
    potential, potential_surface = _whole(on_body), _whole(on_surface)

    omega, density, gravity = states.omega[:, None, None], water.density, water.gravity
    # Force -integral p n, p = i omega rho phi; radiation force = (i omega A - B) velocity [eq:potential-force]
    integral = np.einsum("mn,wnr->wrm", problem.displacement * weight, potential)
    force = -1j * omega * density * integral
    # On a plate the potential is a jump: the incident wave has none, nor has the flux
    closed = np.where(body.kind == PLATE, 0.0, 1.0)
    incident = np.einsum("mn,wn->wm", problem.displacement * weight * closed, wave)
    # An elevation of unit amplitude belongs to the potential -(i g / omega) phi_0
    unit = -1j * gravity / states.omega

    # Far field: minus side from exp(+i k x), plus side from exp(-i k x)
    scale = -1.0 / (2j * states.along * states.profile)
    sides = [
        far_field(potential, flux * closed[:, None], wave, wave_flux, weight),
        far_field(potential, flux * closed[:, None], wave.conj(), wave_flux.conj(), weight),
    ]
    lid_loss, lid_damping = np.zeros(len(states.omega)), np.zeros((len(states.omega), count, count))
    if gap.size:
        inside = potential_surface[:, gap].copy()
        inside[:, :, count] += gap_wave
        width = lid * surface.weight[gap].real
        for side, known in enumerate((gap_wave, gap_wave.conj())):
            sides[side] = sides[side] + 1j * np.einsum("wn,wnr->wr", width * known, inside)
        lid_loss = (width * np.abs(inside[:, :, count]) ** 2).sum(axis=1) / (states.along * states.profile)
        moved = inside[:, :, :count]
        lid_damping = density * omega * np.einsum("wn,wni,wnj->wij", width, moved, moved.conj()).real
    amplitude = np.stack([scale[:, None] * side for side in sides], axis=-1)

    radiated = 1j * omega / gravity * amplitude[:, :count]
    flux_of_wave = density * gravity * states.group_velocity * states.along / states.wave_number
    damping = np.einsum("wis,wjs->wij", radiated, radiated.conj()).real * flux_of_wave[:, None, None] + lid_damping

    return HeadingSolution(
        heading=heading,
        states=states,
        body=body,
        surface=surface,
        added_mass=force[:, :count].imag / omega,
        radiation_damping=damping,
        pressure_damping=-force[:, :count].real,
        froude_krylov_force=(-1j * states.omega * density * unit)[:, None] * incident,
        diffraction_force=unit[:, None] * force[:, count],
        radiated_wave=radiated,
        reflection_coefficient=amplitude[:, count, 0],
        transmission_coefficient=1.0 + amplitude[:, count, 1],
        lid_loss=lid_loss,
        lid_damping=lid_damping,
        radiation=potential[:, :, :count],
        radiation_surface=potential_surface[:, :, :count],
        scattered=unit[:, None] * potential[:, :, count],
        scattered_surface=unit[:, None] * potential_surface[:, :, count],
    )


def solve_in_chunks(
    prepare: Callable[[int], tuple[Problem, Sequence[SymmetryBlock]]],
    states: WaveStates,
    heading: float,
    chunk: int,
    progress: Progress,
) -> tuple[HeadingSolution, bool]:
    """Solve chunk by chunk; on KeyboardInterrupt return what is done (at least one chunk) and False.

    ``prepare`` gives problem and blocks for the chunk that starts at a frequency. Potentials on the free surface are
    kept only when all chunks share one set of panels.
    """
    parts: list[HeadingSolution] = []
    total = len(states.omega)
    finished = True
    try:
        for first in range(0, total, chunk):
            part = slice(first, first + chunk)
            chosen = WaveStates(**{item.name: getattr(states, item.name)[part] for item in fields(WaveStates)})
            parts.append(solve_states(*prepare(first), chosen, heading))
            progress("radiation and diffraction", min(first + chunk, total), total)
    except KeyboardInterrupt:
        if not parts:
            raise
        finished = False
    if len({part.scattered_surface.shape[1] for part in parts}) > 1:
        parts = [
            replace(
                part, radiation_surface=part.radiation_surface[:, :0], scattered_surface=part.scattered_surface[:, :0]
            )
            for part in parts
        ]
    return join(parts), finished
