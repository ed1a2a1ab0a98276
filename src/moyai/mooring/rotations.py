"""Exact finite rotations of a rigid body.

Order stated once for the package: ``R = Rz(yaw) @ Ry(pitch) @ Rx(roll)``, roll first about x, then pitch about y, then
yaw about z, all axes fixed to the site. ``R`` takes body coordinates to site coordinates. ``[eq:mooring-rotation]``
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array


def rotation_matrix(angles: ArrayLike) -> Array:
    """Return R (..., 3, 3) for roll, pitch, yaw [rad] (..., 3)."""
    angles = np.asarray(angles, dtype=float)
    cosine, sine = np.cos(angles), np.sin(angles)
    cr, cp, cy = cosine[..., 0], cosine[..., 1], cosine[..., 2]
    sr, sp, sy = sine[..., 0], sine[..., 1], sine[..., 2]
    out = np.empty((*angles.shape, 3))
    out[..., 0, 0], out[..., 0, 1], out[..., 0, 2] = cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr
    out[..., 1, 0], out[..., 1, 1], out[..., 1, 2] = sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr
    out[..., 2, 0], out[..., 2, 1], out[..., 2, 2] = -sp, cp * sr, cp * cr
    return out


def roll_pitch_yaw(rotation: ArrayLike) -> Array:
    """Return roll, pitch, yaw [rad] (..., 3) of R; pitch within a quarter turn."""
    r = np.asarray(rotation, dtype=float)
    pitch = np.arctan2(-r[..., 2, 0], np.hypot(r[..., 0, 0], r[..., 1, 0]))
    roll = np.arctan2(r[..., 2, 1], r[..., 2, 2])
    yaw = np.arctan2(r[..., 1, 0], r[..., 0, 0])
    return np.stack([roll, pitch, yaw], axis=-1)


def cross_matrix(vector: ArrayLike) -> Array:
    """Return S (..., 3, 3) with ``S @ b = vector x b``."""
    v = np.asarray(vector, dtype=float)
    out = np.zeros((*v.shape[:-1], 3, 3))
    out[..., 0, 1], out[..., 0, 2] = -v[..., 2], v[..., 1]
    out[..., 1, 0], out[..., 1, 2] = v[..., 2], -v[..., 0]
    out[..., 2, 0], out[..., 2, 1] = -v[..., 1], v[..., 0]
    return out


def rotation_from_vector(vector: ArrayLike) -> Array:
    """Return R (..., 3, 3) of a rotation by ``|vector|`` [rad] about ``vector`` (Rodrigues)."""
    v = np.asarray(vector, dtype=float)
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    s = cross_matrix(v)
    half = np.sinc(0.5 * angle / np.pi)
    values: Array = np.eye(3) + np.sinc(angle / np.pi) * s + 0.5 * half**2 * (s @ s)
    return values


def spin_of_angle_rates(angles: ArrayLike) -> Array:
    """Return B (..., 3, 3): a change d of (roll, pitch, yaw) turns the body by the vector ``B @ d``, site axes."""
    angles = np.asarray(angles, dtype=float)
    cp, cy = np.cos(angles[..., 1]), np.cos(angles[..., 2])
    sp, sy = np.sin(angles[..., 1]), np.sin(angles[..., 2])
    zero, one = np.zeros_like(cp), np.ones_like(cp)
    rows = ((cy * cp, -sy, zero), (sy * cp, cy, zero), (-sp, zero, one))
    return np.stack([np.stack(row, axis=-1) for row in rows], axis=-2)
