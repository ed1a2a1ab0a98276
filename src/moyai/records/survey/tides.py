"""Tidal constituents of a current or a water level: ellipses by least squares over a record with gaps."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.validity import Notice

CONSTITUENTS: Mapping[str, float] = {
    # degrees per hour, from the rates of Doodson's arguments
    "SSA": 0.0821373, "MM": 0.5443747, "MSF": 1.0158958, "MF": 1.0980331,
    "Q1": 13.3986609, "O1": 13.9430356, "P1": 14.9589314, "K1": 15.0410686, "J1": 15.5854433,
    "MU2": 27.9682084, "N2": 28.4397295, "NU2": 28.5125831, "M2": 28.9841042, "L2": 29.5284789,
    "T2": 29.9589333, "S2": 30.0, "K2": 30.0821373,
    "M3": 43.4761563, "MK3": 44.0251729, "MN4": 57.4238337, "M4": 57.9682084, "MS4": 58.9841042, "S4": 60.0,
    "M6": 86.9523127, "S6": 90.0, "M8": 115.9364169,
}  # fmt: skip
"""Speeds of tidal constituents [degrees per hour]."""


@dataclass(frozen=True)
class Ellipse:
    """Tidal ellipse of one constituent."""

    name: str
    #: [s].
    period: float
    #: Major semi-axis [m/s].
    major: float
    #: Minor semi-axis [m/s]; negative where the current turns clockwise.
    minor: float
    #: Of the major axis, in (-pi/2, pi/2] [rad].
    heading: float
    #: Time of the largest current along that heading after ``reference``, as an angle [rad].
    phase: float
    #: Standard error of the semi-axes from the spectrum of the rest near the constituent [m/s].
    error: float


@dataclass(frozen=True, eq=False)
class TidalFit:
    """Constituents of a current or, with ``y`` zero, of a water level; equation [eq:records-tide]."""

    ellipses: tuple[Ellipse, ...]
    #: Residual current (x, y) [m/s].
    mean: tuple[float, float]
    #: [m/s per s].
    trend: tuple[float, float]
    #: Share of the variance that the constituents explain [-].
    explained: float
    #: Instant of phase zero [s].
    reference: float
    #: Complex amplitudes ``Re(X exp(-i omega (t - reference)))`` along x and y; shape (constituents, 2).
    amplitudes: ArrayLike
    #: Constituents that the record is too short to separate from a larger neighbour.
    left_out: tuple[str, ...]
    notices: tuple[Notice, ...]

    def predict(self, time: ArrayLike) -> tuple[Array, Array]:
        """Return the fitted velocities (x, y) [m/s]: mean and constituents, without the trend."""
        t = np.asarray(time, dtype=float)
        omega = np.array([2.0 * math.pi / ellipse.period for ellipse in self.ellipses])
        turns = np.exp(-1j * (t - self.reference)[..., None] * omega)
        both = np.real(turns @ np.asarray(self.amplitudes))
        return self.mean[0] + both[..., 0], self.mean[1] + both[..., 1]


# How large constituents usually are: of two that cannot be distinguished the first listed stays
_ORDER = (
    "M2", "K1", "S2", "O1", "N2", "P1", "K2", "Q1", "M4", "MS4", "MF", "MM", "M6", "MN4", "MSF", "NU2", "MU2", "L2",
    "J1", "T2", "MK3", "M3", "S4", "SSA", "M8", "S6",
)  # fmt: skip


def fit_tide(
    time: ArrayLike,
    x: ArrayLike,
    y: ArrayLike | None = None,
    *,
    names: Sequence[str] | None = None,
    rayleigh: float = 1.0,
    trend: bool = False,
) -> TidalFit:
    """Fit tidal constituents by least squares over a record with gaps.

    No nodal corrections: over years amplitudes of the lunar constituents vary by 4 % (M2) to 19 % (O1) about these.

    Parameters
    ----------
    time : array_like
        Instants [s], any order, gaps allowed.
    x, y : array_like
        Velocities [m/s] or, without ``y``, a water level [m]; NaN where missing.
    names : sequence of str, optional
        Constituents; by default all that the record can separate.
    rayleigh : float
        Two constituents are distinguished when their frequencies differ by so many cycles over the record.
    trend : bool
        Fit a trend as well.

    Returns
    -------
    TidalFit

    Raises
    ------
    InputError
        Unknown names, or fewer samples than unknowns.
    """
    unknown = [name for name in names or () if name not in CONSTITUENTS]
    if unknown:
        raise InputError(f"unknown constituent '{unknown[0]}'", parameter="names", allowed=", ".join(CONSTITUENTS))
    t = np.asarray(time, dtype=float)
    u = np.asarray(x, dtype=float)
    v = np.zeros_like(u) if y is None else np.asarray(y, dtype=float)
    known = np.isfinite(u) & np.isfinite(v)
    t, data = t[known], np.column_stack([u[known], v[known]])
    if t.size < 5:
        raise InputError(f"{t.size} samples", parameter="time", allowed="five or more")
    length = float(t.max() - t.min())
    wanted = sorted(names or _ORDER, key=lambda name: _ORDER.index(name))
    chosen: list[str] = []
    left_out: list[str] = []
    for name in wanted:
        speeds = [0.0, *(CONSTITUENTS[other] for other in chosen)]
        apart = min(abs(CONSTITUENTS[name] - speed) for speed in speeds) / 360.0 * length / 3600.0
        (chosen if apart >= rayleigh else left_out).append(name)
    if not chosen:
        raise InputError(f"a record of {length / 3600.0:.3g} h separates no constituents", parameter="time")
    reference = 0.5 * float(t.min() + t.max())
    omega = np.radians([CONSTITUENTS[name] for name in chosen]) / 3600.0
    angles = (t - reference)[:, None] * omega
    columns = [np.ones((t.size, 1)), np.cos(angles), np.sin(angles)]
    if trend:
        columns.append(((t - reference) / length)[:, None])
    design = np.hstack(columns)
    if design.shape[1] >= t.size:
        raise InputError(
            f"{t.size} samples for {design.shape[1]} unknowns", parameter="names", remedy="take fewer names"
        )
    normal = design.T @ design
    solution = np.linalg.solve(normal, design.T @ data)
    rest = data - design @ solution
    count = len(chosen)
    amplitudes = solution[1 : 1 + count] + 1j * solution[1 + count : 1 + 2 * count]
    errors = _line_errors(t, rest, omega, length)
    ellipses = tuple(
        _ellipse(name, 2.0 * math.pi / w, amplitude, error)
        for name, w, amplitude, error in zip(chosen, omega, amplitudes, errors)
    )
    variance = float(np.var(data, axis=0).sum())
    explained = 1.0 - float(np.var(rest, axis=0).sum()) / variance if variance > 0.0 else math.nan
    slope = (float(solution[-1, 0]) / length, float(solution[-1, 1]) / length) if trend else (0.0, 0.0)
    notices: tuple[Notice, ...] = ()
    if left_out:
        message = f"the record is too short to separate {', '.join(left_out)} from larger neighbours"
        notices = (Notice("tide-resolution", message, length / 86400.0, severity="information"),)
    mean = (float(solution[0, 0]), float(solution[0, 1]))
    return TidalFit(ellipses, mean, slope, explained, reference, amplitudes, tuple(left_out), notices)


def _line_errors(t: Array, rest: Array, omega: Array, length: float) -> Array:
    """Return the standard error of an amplitude: the level of the rest's periodogram next to each constituent."""
    out = np.empty(omega.size)
    step = 2.0 * math.pi / length
    for i, w in enumerate(omega):
        nearby = np.array([w + m * step for m in (-6.5, -5.5, -4.5, -3.5, 3.5, 4.5, 5.5, 6.5)])
        nearby = np.abs(nearby)
        waves = np.exp(1j * nearby[:, None] * (t - t[0]))
        levels = np.abs(waves @ rest / t.size * 2.0) ** 2
        out[i] = math.sqrt(float(levels.sum(axis=1).mean()) / 4.0)
    return out


def _ellipse(name: str, period: float, amplitude: ArrayLike, error: float) -> Ellipse:
    """Return the ellipse of complex amplitudes along x and y."""
    ax, ay = np.asarray(amplitude)
    # Circular parts: one turns counter-clockwise, the other clockwise, in time
    left, right = 0.5 * (np.conj(ax) + 1j * np.conj(ay)), 0.5 * (ax + 1j * ay)
    major, minor = abs(left) + abs(right), abs(left) - abs(right)
    a, b = float(np.angle(left)), float(np.angle(right))
    heading, phase = 0.5 * (a + b), 0.5 * (b - a)
    turned = (heading + math.pi / 2.0) % math.pi - math.pi / 2.0
    if abs(math.remainder(turned - heading, 2.0 * math.pi)) > 1.0:
        phase += math.pi
    return Ellipse(name, period, float(major), float(minor), float(turned), math.remainder(phase, 2.0 * math.pi), error)
