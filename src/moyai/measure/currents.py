"""Currents: block means, profiles, the component normal to a structure, tidal constituents and ellipses."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.measure.record import FloatArray


def components(speed: ArrayLike, heading: ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Return velocities along x and y [m/s] of a speed and a direction of travel [rad]."""
    s, angle = np.asarray(speed, dtype=float), np.asarray(heading, dtype=float)
    return np.asarray(s * np.cos(angle)), np.asarray(s * np.sin(angle))


def heading_of_bearing(bearing: ArrayLike, x_axis_bearing: float, *, coming_from: bool) -> FloatArray:
    """Return headings [rad] of compass bearings [rad], clockwise from north.

    Parameters
    ----------
    bearing : array_like
        [rad].
    x_axis_bearing : float
        Bearing towards which +x points [rad].
    coming_from : bool
        Whether the bearing names where the waves or the wind come from (True) or where the current goes (False).
    """
    angle = x_axis_bearing - np.asarray(bearing, dtype=float) + (math.pi if coming_from else 0.0)
    return np.asarray((angle + math.pi) % (2.0 * math.pi) - math.pi)


@dataclass(frozen=True, eq=False)
class MeanCurrents:
    """Currents by block.

    Parameters
    ----------
    start : ndarray, shape (blocks,)
        [s].
    count : ndarray of int
        Samples in each.
    x, y : ndarray
        Vector means [m/s]; NaN in blocks with too few samples.
    scalar_speed : ndarray
        Mean of the speed [m/s].
    deviation : ndarray
        Root of the mean squared departure from the vector mean [m/s].
    """

    start: FloatArray
    count: FloatArray
    x: FloatArray
    y: FloatArray
    scalar_speed: FloatArray
    deviation: FloatArray

    @property
    def speed(self) -> FloatArray:
        """Speed of the vector mean [m/s]."""
        return np.hypot(self.x, self.y)

    @property
    def heading(self) -> FloatArray:
        """Direction of travel of the vector mean [rad]."""
        return np.arctan2(self.y, self.x)

    def normal(self, heading: float) -> FloatArray:
        """Return the component along ``heading`` [rad], for instance the normal of a structure [m/s]."""
        return np.asarray(self.x * math.cos(heading) + self.y * math.sin(heading))


def block_means(
    time: ArrayLike, x: ArrayLike, y: ArrayLike, *, length: float, origin: float | None = None, least: int = 1
) -> MeanCurrents:
    """Return vector means over blocks of equal length.

    Parameters
    ----------
    time : array_like
        Increasing instants [s].
    x, y : array_like
        Velocities [m/s]; NaN where missing.
    length : float
        Of a block [s].
    origin : float, optional
        Start of a block [s]; the first instant by default.
    least : int
        Blocks with fewer samples are NaN.
    """
    t = np.asarray(time, dtype=float)
    u, v = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if not length > 0.0 or t.size == 0:
        raise InputError(f"blocks of {length:g} s over {t.size} samples", path="length", allowed="greater than 0")
    start = float(t[0]) if origin is None else origin
    number = np.floor((t - start) / length + 1e-9).astype(np.int64)
    first = int(number[0])
    number -= first
    known = np.isfinite(u) & np.isfinite(v)
    size = int(number[-1]) + 1
    count = np.bincount(number[known], minlength=size).astype(float)
    enough = count >= max(least, 1)

    def mean(values: FloatArray) -> FloatArray:
        total = np.bincount(number[known], weights=values[known], minlength=size)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(enough, total / count, np.nan)

    mx, my = mean(u), mean(v)
    squares = mean(u**2 + v**2)
    deviation = np.sqrt(np.maximum(squares - mx**2 - my**2, 0.0))
    starts = np.asarray(start + (first + np.arange(size)) * length, dtype=np.float64)
    return MeanCurrents(starts, count, mx, my, mean(np.hypot(u, v)), deviation)


@dataclass(frozen=True)
class PrincipalAxis:
    """Axis along which a current varies most.

    Parameters
    ----------
    heading : float
        Of the axis, in (-pi/2, pi/2] [rad].
    major, minor : float
        Standard deviations along and across [m/s].
    """

    heading: float
    major: float
    minor: float


def principal_axis(x: ArrayLike, y: ArrayLike) -> PrincipalAxis:
    """Return the principal axis of a current record; NaN samples do not count."""
    u, v = np.asarray(x, dtype=float).reshape(-1), np.asarray(y, dtype=float).reshape(-1)
    known = np.isfinite(u) & np.isfinite(v)
    if np.count_nonzero(known) < 3:
        raise InputError(f"{np.count_nonzero(known)} samples", path="x", allowed="3 or more")
    values, vectors = np.linalg.eigh(np.cov(u[known], v[known]))
    heading = math.atan2(vectors[1, 1], vectors[0, 1])
    if heading <= -math.pi / 2.0:
        heading += math.pi
    elif heading > math.pi / 2.0:
        heading -= math.pi
    return PrincipalAxis(heading, math.sqrt(max(values[1], 0.0)), math.sqrt(max(values[0], 0.0)))


@dataclass(frozen=True, eq=False)
class Profile:
    """Mean profile of an acoustic profiler.

    Parameters
    ----------
    z : ndarray
        Heights of the bins above the bed or depths, as given [m].
    x, y : ndarray
        Mean velocities [m/s].
    share : ndarray
        Share of samples that were good in each bin.
    exponent, surface_speed, exponent_error : float
        Power law ``speed = surface_speed (z / top)^exponent`` fitted to the speed along the mean direction; NaN
        where the profile does not allow it.
    depth_mean : tuple of float
        Mean over the profiled height (x, y) [m/s].
    """

    z: FloatArray
    x: FloatArray
    y: FloatArray
    share: FloatArray
    exponent: float
    surface_speed: float
    exponent_error: float
    depth_mean: tuple[float, float]


def mean_profile(z: ArrayLike, x: ArrayLike, y: ArrayLike, *, top: float, least_share: float = 0.5) -> Profile:
    """Average profiles and fit a power law; equation [eq:records-power-law].

    Parameters
    ----------
    z : array_like, shape (bins,)
        Heights above the bed [m].
    x, y : array_like, shape (bins, profiles)
        Velocities [m/s]; NaN where bad.
    top : float
        Height of the surface above the bed [m]: bins above it are left out.
    least_share : float
        Bins with a smaller share of good samples are left out.
    """
    heights = np.asarray(z, dtype=float)
    u, v = np.atleast_2d(np.asarray(x, dtype=float)), np.atleast_2d(np.asarray(y, dtype=float))
    if u.shape != v.shape or u.shape[0] != heights.size:
        raise InputError(f"velocities of shape {u.shape} for {heights.size} bins", path="x")
    good = np.isfinite(u) & np.isfinite(v)
    share = good.mean(axis=1)
    kept = (share >= least_share) & (heights <= top) & (heights > 0.0)
    if not kept.any():
        raise InputError("no bin has enough good samples below the surface", path="least_share")
    with np.errstate(invalid="ignore", divide="ignore"):
        mx = np.where(kept, np.where(good, u, 0.0).sum(axis=1) / good.sum(axis=1), np.nan)
        my = np.where(kept, np.where(good, v, 0.0).sum(axis=1) / good.sum(axis=1), np.nan)
    depth_mean = (float(np.trapezoid(mx[kept], heights[kept])), float(np.trapezoid(my[kept], heights[kept])))
    span = float(heights[kept][-1] - heights[kept][0])
    depth_mean = (
        (depth_mean[0] / span, depth_mean[1] / span) if span > 0.0 else (float(mx[kept][0]), float(my[kept][0]))
    )
    along = mx * math.cos(a := math.atan2(depth_mean[1], depth_mean[0])) + my * math.sin(a)
    fit = kept & (along > 0.0)
    exponent = surface = error = math.nan
    if np.count_nonzero(fit) >= 3:
        design = np.column_stack([np.ones(np.count_nonzero(fit)), np.log(heights[fit] / top)])
        solution, *_ = np.linalg.lstsq(design, np.log(along[fit]), rcond=None)
        rest = np.log(along[fit]) - design @ solution
        variance = float(rest @ rest) / max(rest.size - 2, 1)
        error = math.sqrt(variance * float(np.linalg.inv(design.T @ design)[1, 1]))
        surface, exponent = math.exp(solution[0]), float(solution[1])
    return Profile(heights, mx, my, share, exponent, surface, error, depth_mean)


# ----------------------------------------------------------------------------------------------------- tides

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
    """Tidal ellipse of one constituent.

    Parameters
    ----------
    name : str
    period : float
        [s].
    major, minor : float
        Semi-axes [m/s]; a negative minor axis turns clockwise.
    heading : float
        Of the major axis, in (-pi/2, pi/2] [rad].
    phase : float
        Time of the largest current along that heading after ``reference``, as an angle [rad].
    error : float
        Standard error of the semi-axes from the spectrum of the rest near the constituent [m/s].
    """

    name: str
    period: float
    major: float
    minor: float
    heading: float
    phase: float
    error: float


@dataclass(frozen=True, eq=False)
class TidalFit:
    """Constituents of a current or, with ``y`` zero, of a water level; equation [eq:records-tide].

    Parameters
    ----------
    ellipses : tuple of Ellipse
    mean : tuple of float
        Residual current (x, y) [m/s].
    trend : tuple of float
        [m/s per s].
    explained : float
        Share of the variance that the constituents explain [-].
    reference : float
        Instant of phase zero [s].
    amplitudes : ndarray, shape (constituents, 2)
        Complex amplitudes ``Re(X exp(-i omega (t - reference)))`` along x and y.
    left_out : tuple of str
        Constituents that the record is too short to tell from a larger neighbour.
    notices : tuple of Notice
    """

    ellipses: tuple[Ellipse, ...]
    mean: tuple[float, float]
    trend: tuple[float, float]
    explained: float
    reference: float
    amplitudes: ArrayLike
    left_out: tuple[str, ...]
    notices: tuple[Notice, ...]

    def predict(self, time: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """Return the fitted velocities (x, y) [m/s]: mean and constituents, without the trend."""
        t = np.asarray(time, dtype=float)
        omega = np.array([2.0 * math.pi / ellipse.period for ellipse in self.ellipses])
        turns = np.exp(-1j * (t - self.reference)[..., None] * omega)
        both = np.real(turns @ np.asarray(self.amplitudes))
        return self.mean[0] + both[..., 0], self.mean[1] + both[..., 1]


# How large constituents usually are: of two that cannot be told apart the first listed stays
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
        Constituents; by default all that the record can tell apart.
    rayleigh : float
        Two constituents are told apart when their frequencies differ by so many cycles over the record.
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
        raise InputError(f"unknown constituent '{unknown[0]}'", path="names", allowed=", ".join(CONSTITUENTS))
    t = np.asarray(time, dtype=float)
    u = np.asarray(x, dtype=float)
    v = np.zeros_like(u) if y is None else np.asarray(y, dtype=float)
    known = np.isfinite(u) & np.isfinite(v)
    t, data = t[known], np.column_stack([u[known], v[known]])
    if t.size < 5:
        raise InputError(f"{t.size} samples", path="time", allowed="five or more")
    length = float(t.max() - t.min())
    wanted = sorted(names or _ORDER, key=lambda name: _ORDER.index(name))
    chosen: list[str] = []
    left_out: list[str] = []
    for name in wanted:
        speeds = [0.0, *(CONSTITUENTS[other] for other in chosen)]
        apart = min(abs(CONSTITUENTS[name] - speed) for speed in speeds) / 360.0 * length / 3600.0
        (chosen if apart >= rayleigh else left_out).append(name)
    if not chosen:
        raise InputError(f"a record of {length / 3600.0:.3g} h tells no constituent apart", path="time")
    reference = 0.5 * float(t.min() + t.max())
    omega = np.radians([CONSTITUENTS[name] for name in chosen]) / 3600.0
    angles = (t - reference)[:, None] * omega
    columns = [np.ones((t.size, 1)), np.cos(angles), np.sin(angles)]
    if trend:
        columns.append(((t - reference) / length)[:, None])
    design = np.hstack(columns)
    if design.shape[1] >= t.size:
        raise InputError(f"{t.size} samples for {design.shape[1]} unknowns", path="names", remedy="take fewer names")
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
        message = f"the record is too short to tell {', '.join(left_out)} from larger neighbours"
        notices = (Notice("tide-resolution", message, length / 86400.0, severity="information"),)
    mean = (float(solution[0, 0]), float(solution[0, 1]))
    return TidalFit(ellipses, mean, slope, explained, reference, amplitudes, tuple(left_out), notices)


def _line_errors(t: FloatArray, rest: FloatArray, omega: FloatArray, length: float) -> FloatArray:
    """Return the standard error of an amplitude: the level of the rest's periodogram beside each constituent."""
    out = np.empty(omega.size)
    step = 2.0 * math.pi / length
    for i, w in enumerate(omega):
        beside = np.array([w + m * step for m in (-6.5, -5.5, -4.5, -3.5, 3.5, 4.5, 5.5, 6.5)])
        beside = np.abs(beside)
        waves = np.exp(1j * beside[:, None] * (t - t[0]))
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
