"""Validation of the planar frame for coefficients of other programs: exact forces and an exact body."""

from __future__ import annotations

import math

import numpy as np

from moyai.core.arrays import Array
from moyai.core.validation import ValidationCase
from moyai.interop.coefficients import DOFS, assemble
from moyai.interop.planar import move_reference_point, to_planar

_DENSITY, _GRAVITY = 1025.0, 9.81


def _box_in_beam_seas(degree: str) -> complex:
    """Return the planar Froude-Krylov force per metre of a box whose 3-D coefficients stand off every origin.

    Beam 4 m, draught 1.5 m, length 7 m, centred at (2, -3); moments about (1, 5, 0.8); deep water, 1.3 rad/s, 90 deg.
    The 3-D force is the closed integral of the undisturbed pressure over the five wetted faces.
    """
    omega = 1.3
    k = omega**2 / _GRAVITY
    beam, draught, length, centre, point = 4.0, 1.5, 7.0, np.array([2.0, -3.0]), np.array([1.0, 5.0, 0.8])
    fall = math.exp(-k * draught)
    # Integrals over depth of exp(kz) and z exp(kz), over breadth of exp(iks) and s exp(iks), s from the centre
    depth0 = (1.0 - fall) / k
    depth1 = -(1.0 - fall * (1.0 + k * draught)) / k**2
    half = 0.5 * k * beam
    across0 = 2.0 * math.sin(half) / k
    across1 = 2j * (math.sin(half) - half * math.cos(half)) / k**2
    scale = _DENSITY * _GRAVITY * length * np.exp(1j * k * centre[1])
    side = -2j * math.sin(half)
    sway = scale * depth0 * side
    heave = scale * fall * across0
    # Moments about the reference point: roll = y F_z - z F_y, pitch = z F_x - x F_z, yaw = x F_y - y F_x
    arm_x, arm_y = centre - point[:2]
    roll = scale * fall * (arm_y * across0 + across1) - scale * side * (depth1 - point[2] * depth0)
    force = np.array([0.0, sway, heave, roll, -arm_x * heave, arm_x * sway])
    dataset = assemble(
        program="closed form",
        source="box",
        dofs=DOFS,
        omega=np.array([omega]),
        added_mass=np.eye(6)[None],
        radiation_damping=np.zeros((1, 6, 6)),
        wave_direction=np.array([0.5 * math.pi]),
        forces={"excitation_force": force[None, None, :]},
        density=_DENSITY,
        gravity=_GRAVITY,
        water_depth=math.inf,
        reference_point=point.tolist(),
    )
    planar = to_planar(
        dataset, length=length, centre_of_gravity=(0.3, -0.6), sea="beam", origin=(float(centre[0]), float(centre[1]))
    )
    return complex(planar["excitation_force"].sel(influenced_dof=degree).values[0, 0])


def _sphere_about(height: float) -> Array:
    """Return the added-mass matrix of a deep sphere (radius 1 m) about a point ``height`` above its centre [kg]."""
    mass = 0.5 * _DENSITY * 4.0 / 3.0 * math.pi
    dataset = assemble(
        program="exact",
        source="sphere",
        dofs=DOFS,
        omega=np.array([1.0]),
        added_mass=np.diag([mass, mass, mass, 0.0, 0.0, 0.0])[None],
        radiation_damping=np.zeros((1, 6, 6)),
        wave_direction=np.array([0.0]),
        forces={"excitation_force": np.zeros((1, 1, 6), dtype=complex)},
        density=_DENSITY,
        gravity=_GRAVITY,
        water_depth=math.inf,
        reference_point=(0.0, 0.0, 0.0),
    )
    moved = move_reference_point(dataset, (0.0, 0.0, height))
    return np.asarray(moved["added_mass"].values[0])


# Planar references: line integrals of the undisturbed pressure over the section, Gauss quadrature with 200 points a
# side, about the planar centre of gravity (0.3, -0.6)
CASES: tuple[ValidationCase, ...] = (
    ValidationCase(
        name="interop: sway force of an off-origin box in beam seas",
        source="pressure integral over the planar section",
        compute=lambda: abs(_box_in_beam_seas("sway")),
        reference=8979.033359850275,
        tolerance=1e-9,
        note="rounding",
    ),
    ValidationCase(
        name="interop: roll force of an off-origin box in beam seas, real part",
        source="pressure integral over the planar section, moment (z - z_G) n_x - (x - x_G) n_z",
        compute=lambda: _box_in_beam_seas("roll").real,
        reference=9135.266850834494,
        tolerance=1e-9,
        note="rounding; the sign of roll turns in beam seas",
    ),
    ValidationCase(
        name="interop: roll force of an off-origin box in beam seas, imaginary part",
        source="pressure integral over the planar section, moment (z - z_G) n_x - (x - x_G) n_z",
        compute=lambda: _box_in_beam_seas("roll").imag,
        reference=-5993.341173579555,
        tolerance=1e-9,
        note="rounding; the sign of roll turns in beam seas",
    ),
    ValidationCase(
        name="interop: surge-pitch added mass of a sphere about a point 2 m above its centre",
        source="exact: -2 m times half the displaced mass; a fluid without friction cannot turn a sphere",
        compute=lambda: float(_sphere_about(2.0)[0, 4]),
        reference=-2.0 * 0.5 * _DENSITY * 4.0 / 3.0 * math.pi,
        tolerance=1e-12,
        note="rounding",
    ),
)
