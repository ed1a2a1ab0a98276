"""Motions of the connected row in waves, and what follows from them: loads in connectors, tensions, far waves, drift.

Time factor e^{-i omega t}; per unit wave amplitude. Constraints are taken out by the basis of the motions that they
leave [eq:units-motion]; their loads follow from what is left over [eq:units-held].
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.sea.dispersion import group_velocity, wave_number
from moyai.structures.units.assembly import RowAtLevel, held_load
from moyai.structures.units.bem import directions
from moyai.structures.units.hydrodynamics import RowHydrodynamics
from moyai.structures.units.model import Curve
from moyai.structures.units.viscous import Eddies, LinearEddies


@dataclass(frozen=True, eq=False)
class RowModel:
    """The row at one level with its coefficients, about one position of rest."""

    at: RowAtLevel
    hydro: RowHydrodynamics
    #: Mean position that lines and curves are taken at; shape (m,).
    position: Array

    @cached_property
    def tension_gradient(self) -> Array:
        """Derivative of the tensions (lines, m) by the motions [N/m], [N]."""
        return self.at.tension_gradient(self.position)

    @cached_property
    def line_stiffness(self) -> Array:
        """Of all lines (m, m)."""
        return self.at.line_stiffness(self.position)


@dataclass(frozen=True, eq=False)
class RowWaves:
    """What waves of given frequencies do to the row, wherever it comes to rest: the turns of a sea share it."""

    at: RowAtLevel
    #: [rad/s]; shape (n,).
    omega: Array
    #: Added mass of the waves that the units make; shape (n, m, m).
    added_mass: Array
    #: Damping of the waves that the units make; shape (n, m, m).
    damping: Array
    #: Per metre of amplitude; shape (n, h, m).
    excitation: ComplexArray
    #: Undisturbed wave in the measures of eddies; empty without them; shape (n, h, k).
    water: ComplexArray

    @classmethod
    def of(cls, at: RowAtLevel, hydro: RowHydrodynamics, omega: Array, eddies: Eddies | None = None) -> RowWaves:
        """Return what waves of frequencies within the band of the coefficients do."""
        k = np.asarray(wave_number(omega, at.water.depth, at.water.gravity), dtype=float)
        added, damping, excitation = hydro.at(omega, k)
        water: ComplexArray = np.zeros((*excitation.shape[:2], 0), dtype=complex)
        if eddies is not None:
            water = eddies.water_motion(omega[:, None], hydro.headings, at.water.depth, at.water.gravity)
        return cls(at, omega, added, damping, excitation, water)

    @cached_property
    def unit_masses(self) -> Array:
        """Mass and added mass (n, m) of every motion along the axes of its unit."""
        return masses_along_units(self.at, self.added_mass)

    @cached_property
    def left(self) -> tuple[Array, Array]:
        """Mass with added mass, and damping (n, r, r), of the motions that connectors leave."""
        free = self.at.free
        return free.T @ (self.at.inertia + self.added_mass) @ free, free.T @ self.damping @ free


@dataclass(frozen=True, eq=False)
class RowResponse:
    """Transfer functions at frequencies (n,) and headings (h,)."""

    #: Shape (n,).
    omega: Array
    #: Row axes, about the centres of gravity; shape (n, h, m).
    motion: ComplexArray
    #: Relative motion of every connector; shape (n, h, joints, 6).
    relative: ComplexArray
    #: Load of every connector on the unit before it; shape (n, h, joints, 6).
    load: ComplexArray
    #: [N/m], linear about the mean position; shape (n, h, lines).
    tension: ComplexArray
    #: Mean power that damping beyond waves takes [W/m2]; shape (n, h).
    dissipated: Array


def moved(model: RowModel, waves: RowWaves, curve_stiffness: Array, eddies: LinearEddies | None = None) -> ComplexArray:
    """Return the motions (n, h, m) of the connected row in waves of unit amplitude; see :func:`respond`."""
    at, free = model.at, model.at.free
    restoring, stiffness, damping, carried = _holds(model, waves, curve_stiffness, eddies)
    along = at.unit_axes @ free
    critical = critical_damping(at, waves.unit_masses, restoring)
    mass, radiation = waves.left
    own = (along.T * critical[:, None, :]) @ along + free.T @ damping @ free
    w = waves.omega[:, None, None]
    matrix = -(w**2) * mass - 1j * w * (radiation + own) + free.T @ stiffness @ free
    force = (waves.excitation + carried) @ free
    return np.asarray(np.linalg.solve(matrix, force.swapaxes(1, 2)).swapaxes(1, 2) @ free.T)


def _holds(
    model: RowModel, waves: RowWaves, curve_stiffness: Array, eddies: LinearEddies | None
) -> tuple[Array, Array, Array, ComplexArray | float]:
    """Return restoring without connectors and all stiffness, damping beyond waves and units, force on edges."""
    at = model.at
    along = np.array([joint.along for joint in at.joints]).reshape(len(at.joints), at.size)
    restoring = at.hydrostatic + model.line_stiffness
    stiffness = restoring + at.springs[0] + (along.T * np.asarray(curve_stiffness, dtype=float)) @ along
    if eddies is None:
        return restoring, stiffness, at.springs[1], 0.0
    return restoring, stiffness, at.springs[1] + eddies.damping, eddies.carried(waves.water)


def respond(
    model: RowModel,
    omega: Array,
    curve_stiffness: Array,
    eddies: LinearEddies | None = None,
    waves: RowWaves | None = None,
) -> RowResponse:
    """Solve the connected row in waves of unit amplitude.

    Parameters
    ----------
    model : RowModel
    omega : ndarray (n,)
        [rad/s], within the band of the coefficients.
    curve_stiffness : ndarray (joints,)
        Linear stiffness [N/m] that stands for the curve of every connector; zero where it has none.
    eddies : LinearEddies or None
        Drag of the edges in the sea that is answered.
    waves : RowWaves, optional
        Of these frequencies, where they are given.
    """
    at = model.at
    if waves is None:
        waves = RowWaves.of(at, model.hydro, omega, None if eddies is None else eddies.eddies)
    motion = moved(model, waves, curve_stiffness, eddies)
    restoring, stiffness, damping, carried = _holds(model, waves, curve_stiffness, eddies)
    critical, axes = critical_damping(at, waves.unit_masses, restoring)[:, None, :], at.unit_axes
    w = omega[:, None, None]
    velocity = -1j * w * motion
    damped = (velocity @ axes.T * critical) @ axes + velocity @ damping.T
    # added mass and damping are symmetric: motions stand in rows
    inert = (w**2) * (motion @ (at.inertia + waves.added_mass))
    held = waves.excitation + carried + inert - velocity @ waves.damping - damped - motion @ stiffness.T
    relative = _relative(at, motion)
    load = _joint_loads(at, omega, motion, relative, held_load(at, held), np.asarray(curve_stiffness, dtype=float))
    tension = motion @ model.tension_gradient.T
    power = 0.5 * np.real(np.sum(velocity.conj() * (damped - carried), axis=2))
    return RowResponse(omega, motion, relative, load, np.asarray(tension), np.asarray(power, dtype=float))


def masses_along_units(at: RowAtLevel, added_mass: Array) -> Array:
    """Return mass and added mass (n, m) of every motion along the axes of its unit, of added masses (n, m, m)."""
    count, every = at.row.count, np.arange(at.row.count)
    blocks = (at.inertia + added_mass).reshape(-1, count, 6, count, 6)[:, every, :, every]
    turns = at.unit_axes.reshape(count, 6, count, 6)[every, :, every]
    along = np.einsum("uab,unbc,uac->nua", turns, blocks, turns, optimize=True)
    return np.asarray(along.reshape(len(added_mass), at.size))


def critical_damping(at: RowAtLevel, masses: Array, stiffness: Array) -> Array:
    """Return the damping (n, m) along the axes of the units, from their masses (n, m) there [eq:units-critical]."""
    row, turn = at.row, at.unit_axes
    spring = np.sum((turn @ stiffness) * turn, axis=1)
    fraction = np.tile(row.damping_fraction, row.count)
    critical = 2.0 * np.sqrt(np.maximum(masses, 0.0) * np.maximum(spring, 0.0))
    return np.asarray(fraction * critical + np.tile(row.linear_damping, row.count))


def _relative(at: RowAtLevel, motion: ComplexArray) -> ComplexArray:
    if not at.joints:
        return np.zeros((*motion.shape[:-1], 0, 6), dtype=complex)
    every = np.array([joint.relative for joint in at.joints])
    return np.asarray(np.einsum("jcm,...m->...jc", every, motion))


def _joint_loads(
    at: RowAtLevel, omega: Array, motion: ComplexArray, relative: ComplexArray, held: ComplexArray, curve: Array
) -> ComplexArray:
    out = np.zeros_like(relative)
    first = 0
    rate = -1j * omega[:, None, None]
    for number, joint in enumerate(at.joints):
        connector = joint.connector
        if len(joint.held):
            out[..., number, :] += held[..., first : first + len(joint.held)] @ joint.held
            first += len(joint.held)
        if connector.stiffness is not None:
            out[..., number, :] += relative[..., number, :] @ connector.stiffness.T
        if connector.damping is not None:
            out[..., number, :] += (rate * relative[..., number, :]) @ connector.damping.T
        if connector.curve is not None:
            elongation = motion @ joint.along
            force = (curve[number] - 1j * omega[:, None] * connector.linear_damping) * elongation
            out[..., number, :3] += force[..., None] * joint.axis
    return out


def harmonic_stiffness(curve: Curve, mean: float, amplitude: float) -> float:
    """Return the linear stiffness [N/m] of a curve for a harmonic elongation [eq:units-harmonic]."""
    if amplitude <= 0.0:
        amplitude = 1e-9
    angle = (np.arange(400) + 0.5) * math.pi / 400
    force = curve.at(mean + amplitude * np.cos(angle))
    return float(2.0 / (400 * amplitude) * np.sum(force * np.cos(angle)))


def gaussian_stiffness(curve: Curve, mean: float, deviation: float) -> float:
    """Return the linear stiffness [N/m] of a curve for a Gaussian elongation [eq:units-gaussian]."""
    if deviation <= 0.0:
        deviation = 1e-9
    z = np.linspace(-6.0, 6.0, 2401)
    weight = np.exp(-0.5 * z**2)
    force = curve.at(mean + deviation * z)
    return float(np.sum(weight * force * z) / (deviation * np.sum(weight * z**2)))


@dataclass(frozen=True, eq=False)
class FarWaves:
    """Far waves of the moving row at frequencies of the coefficients."""

    #: As of :class:`moyai.structures.units.bem.Solution`, motions included, for incident waves whose phase is that at
    #: the middle of the hulls; shape (f, h, directions).
    amplitude: ComplexArray
    #: The same in the direction of the incident wave; shape (f, h).
    forward: ComplexArray
    #: Mean force along x, y [N/m2] and moment about z [N m/m2] per amplitude squared [eq:units-drift]; shape (f, h, 3).
    drift: Array
    #: Energy that the row takes by its far waves, less what its damping takes, over the incident flux on its length
    #: [eq:units-energy]; shape (f, h).
    balance: Array


def far_waves(model: RowModel, response: RowResponse) -> FarWaves:
    """Return far waves, mean drift and energy balance at the frequencies of the coefficients.

    Coefficients from a file have no far waves: drift is that of the file, the balance is not known.
    """
    hydro, at = model.hydro, model.at
    if hydro.panels is None:
        return _far_waves_of_file(hydro)
    total, forward, drift = _far_field(model, response.motion)
    energy, speed = 0.5 * at.water.density * at.water.gravity, _group_speed(model)
    power = np.mean(np.abs(total) ** 2, axis=2)
    lost = -(4.0 / hydro.wave_number[:, None]) * (forward.real + power) * energy * speed
    balance = (lost - response.dissipated) / (energy * speed * at.row.count * at.row.length)
    return FarWaves(total, forward, drift, balance)


def far_drift(model: RowModel, motion: ComplexArray) -> Array:
    """Return the mean drift alone (f, h, 3) of motions (f, h, m); see :class:`FarWaves`."""
    if model.hydro.panels is None:
        return _far_waves_of_file(model.hydro).drift
    return _far_field(model, motion)[2]


def _group_speed(model: RowModel) -> Array:
    water = model.at.water
    return np.asarray(group_velocity(model.hydro.omega, water.depth, water.gravity), dtype=float)[:, None]


def _far_field(model: RowModel, motion: ComplexArray) -> tuple[ComplexArray, ComplexArray, Array]:
    """Return far waves in all directions (f, h, d), in that of the incident wave (f, h), and drift (f, h, 3)."""
    hydro, water = model.hydro, model.at.water
    assert hydro.panels is not None
    scattered, radiated = hydro.far
    x, y = hydro.panels.middle
    # far waves lie about the middle of the hulls, incident waves about the origin
    ahead = hydro.wave_number[:, None] * (x * np.cos(hydro.headings) + y * np.sin(hydro.headings))
    total = (scattered + motion @ radiated) * np.exp(-1j * ahead)[..., None]
    angle = directions(total.shape[2])
    order = np.fft.fftfreq(len(angle), 1.0 / len(angle))
    series = np.fft.fft(total, axis=2) / len(angle)
    slope = np.fft.ifft(1j * order * series * len(angle), axis=2)
    at_heading = np.exp(1j * order[None, :] * hydro.headings[:, None])
    forward = np.einsum("fhd,hd->fh", series, at_heading)
    forward_slope = np.einsum("fhd,hd->fh", 1j * order * series, at_heading)
    k = hydro.wave_number[:, None]
    ratio = _group_speed(model) * k / hydro.omega[:, None]
    square = np.abs(total) ** 2
    turn = np.mean(np.imag(total.conj() * slope), axis=2)
    scale = -2.0 * water.density * water.gravity * ratio / k
    drift = np.stack(
        [
            scale * (forward.real * np.cos(hydro.headings) + np.mean(square * np.cos(angle), axis=2)),
            scale * (forward.real * np.sin(hydro.headings) + np.mean(square * np.sin(angle), axis=2)),
            scale / k * (forward_slope.imag + turn),
        ],
        axis=2,
    )
    drift[..., 2] += x * drift[..., 1] - y * drift[..., 0]
    return total, forward, drift


def _far_waves_of_file(hydro: RowHydrodynamics) -> FarWaves:
    shape = len(hydro.omega), len(hydro.headings)
    unknown = np.full(shape, np.nan)
    drift = np.full((*shape, 3), np.nan) if hydro.drift is None else hydro.drift
    return FarWaves(np.zeros((*shape, 0), dtype=complex), unknown.astype(complex), drift, unknown)
