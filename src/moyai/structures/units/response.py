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
from moyai.structures.units.viscous import LinearEddies


@dataclass(frozen=True, eq=False)
class RowModel:
    """The row at one level with its coefficients, about one position of rest.

    Parameters
    ----------
    at : RowAtLevel
    hydro : RowHydrodynamics
    position : ndarray (m,)
        Mean position that lines and curves are taken at.
    """

    at: RowAtLevel
    hydro: RowHydrodynamics
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
class RowResponse:
    """Transfer functions at frequencies (n,) and headings (h,).

    Parameters
    ----------
    omega : ndarray (n,)
    motion : ndarray (n, h, m)
        Row axes, about the centres of gravity.
    relative : ndarray (n, h, joints, 6)
        Relative motion of every connector.
    load : ndarray (n, h, joints, 6)
        Load of every connector on the unit before it.
    tension : ndarray (n, h, lines)
        [N/m], linear about the mean position.
    dissipated : ndarray (n, h)
        Mean power that damping beyond waves takes [W/m2].
    """

    omega: Array
    motion: ComplexArray
    relative: ComplexArray
    load: ComplexArray
    tension: ComplexArray
    dissipated: Array


def respond(model: RowModel, omega: Array, curve_stiffness: Array, eddies: LinearEddies | None = None) -> RowResponse:
    """Solve the connected row in waves of unit amplitude.

    Parameters
    ----------
    model : RowModel
    omega : ndarray (n,)
        [rad/s], within the band of the coefficients.
    curve_stiffness : ndarray (joints,) or (n, h, joints)
        Linear stiffness [N/m] that stands for the curve of every connector; zero where it has none.
    eddies : LinearEddies or None
        Drag of the edges in the sea that is answered.
    """
    at = model.at
    k = np.array([float(wave_number(w, at.water.depth, at.water.gravity)) for w in omega])
    added, radiation, excitation = model.hydro.at(omega, k)
    joints, free = at.joints, at.free
    along = np.array([joint.along for joint in joints]).reshape(len(joints), at.size)
    restoring = at.hydrostatic + model.line_stiffness
    stiffness = restoring + at.springs[0]
    own = own_damping(at, added, restoring) + at.springs[1]
    carried: ComplexArray | float = 0.0
    if eddies is not None:
        own = own + eddies.damping
        carried = eddies.force(at, omega, model.hydro.headings)
        excitation = excitation + carried
    headings = excitation.shape[1]
    given = np.broadcast_to(np.asarray(curve_stiffness, dtype=float), (len(omega), headings, len(joints)))
    w = omega[:, None, None]
    base = -(w**2) * (at.inertia + added) - 1j * w * (radiation + own) + stiffness
    motion = np.empty(excitation.shape, dtype=complex)
    loads = np.zeros((len(omega), headings, len(at.constraint)), dtype=complex)
    # headings that curves meet alike share one factorisation
    alike = bool(np.all(given == given[:, :1]))
    for which in [slice(None)] if alike else [slice(h, h + 1) for h in range(headings)]:
        curves = np.einsum("jm,nj,jk->nmk", along, given[:, which][:, 0], along)
        matrix = base + curves
        force = excitation[:, which].swapaxes(1, 2)
        motion[:, which] = (free @ np.linalg.solve(free.T @ matrix @ free, free.T @ force)).swapaxes(1, 2)
        left = force - matrix @ motion[:, which].swapaxes(1, 2)
        loads[:, which] = held_load(at, left.swapaxes(1, 2))
    relative = _relative(at, motion)
    load = _joint_loads(at, omega, motion, relative, loads, given)
    tension = motion @ model.tension_gradient.T
    velocity = -1j * w * motion
    power = 0.5 * np.real(np.sum(velocity.conj() * (velocity @ own - carried), axis=2))
    return RowResponse(omega, motion, relative, load, np.asarray(tension), np.asarray(power, dtype=float))


def own_damping(at: RowAtLevel, added: Array, stiffness: Array) -> Array:
    """Return the damping (n, m, m) beyond waves and connectors [eq:units-critical]."""
    row = at.row
    turn = np.zeros((at.size, at.size))
    for number, place in enumerate(row.placements):
        part = slice(6 * number, 6 * number + 6)
        turn[part, part] = np.kron(np.eye(2), place.rotation.T)
    mass = np.sum((turn @ (at.inertia + added)) * turn, axis=2)
    spring = np.sum((turn @ stiffness) * turn, axis=1)
    fraction = np.tile(row.damping_fraction, row.count)
    critical = 2.0 * np.sqrt(np.maximum(mass, 0.0) * np.maximum(spring, 0.0))
    diagonal = fraction * critical + np.tile(row.linear_damping, row.count)
    return np.asarray((turn.T * diagonal[:, None, :]) @ turn)


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
            force = (curve[..., number] - 1j * omega[:, None] * connector.linear_damping) * elongation
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
    """Far waves of the moving row at frequencies of the coefficients.

    Parameters
    ----------
    amplitude : ndarray (f, h, directions)
        As of :class:`moyai.structures.units.bem.Solution`, motions included.
    forward : ndarray (f, h)
        The same in the direction of the incident wave.
    drift : ndarray (f, h, 3)
        Mean force along x, y [N/m2] and moment about z [N m/m2] per amplitude squared [eq:units-drift].
    balance : ndarray (f, h)
        Energy that the row takes by its far waves, less what its damping takes, over the incident flux on its length
        [eq:units-energy].
    """

    amplitude: ComplexArray
    forward: ComplexArray
    drift: Array
    balance: Array


def far_waves(model: RowModel, response: RowResponse) -> FarWaves:
    """Return far waves, mean drift and energy balance at the frequencies of the coefficients.

    Coefficients from a file have no far waves: drift is that of the file, the balance is not known.
    """
    hydro, at = model.hydro, model.at
    if hydro.panels is None:
        return _far_waves_of_file(hydro)
    scattered = np.array([item.scattered for item in hydro.solutions])
    radiated = np.array([item.radiated for item in hydro.solutions])
    total = scattered + np.einsum("fhm,fmd->fhd", response.motion, radiated)
    angle = directions()
    order = np.fft.fftfreq(len(angle), 1.0 / len(angle))
    series = np.fft.fft(total, axis=2) / len(angle)
    slope = np.fft.ifft(1j * order * series * len(angle), axis=2)
    at_heading = np.exp(1j * order[None, :] * hydro.headings[:, None])
    forward = np.einsum("fhd,hd->fh", series, at_heading)
    forward_slope = np.einsum("fhd,hd->fh", 1j * order * series, at_heading)
    k = hydro.wave_number[:, None]
    speed = np.array([float(group_velocity(w, at.water.depth, at.water.gravity)) for w in hydro.omega])[:, None]
    ratio = speed * k / hydro.omega[:, None]
    energy = 0.5 * at.water.density * at.water.gravity
    power = np.mean(np.abs(total) ** 2, axis=2)
    lost = -(4.0 / k) * (forward.real + power) * energy * speed
    mean_x = np.mean(np.abs(total) ** 2 * np.cos(angle), axis=2)
    mean_y = np.mean(np.abs(total) ** 2 * np.sin(angle), axis=2)
    turn = np.mean(np.imag(total.conj() * slope), axis=2)
    scale = -4.0 * energy * ratio / k
    drift = np.stack(
        [
            scale * (forward.real * np.cos(hydro.headings) + mean_x),
            scale * (forward.real * np.sin(hydro.headings) + mean_y),
            scale / k * (forward_slope.imag + turn),
        ],
        axis=2,
    )
    width = at.row.count * at.row.length
    balance = (lost - response.dissipated) / (energy * speed * width)
    return FarWaves(total, forward, drift, balance)


def _far_waves_of_file(hydro: RowHydrodynamics) -> FarWaves:
    shape = len(hydro.omega), len(hydro.headings)
    unknown = np.full(shape, np.nan)
    drift = np.full((*shape, 3), np.nan) if hydro.drift is None else hydro.drift
    return FarWaves(np.zeros((*shape, 0), dtype=complex), unknown.astype(complex), drift, unknown)
