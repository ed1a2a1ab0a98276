"""Tidal constituents of a current or a water level: ellipses by least squares over a record with gaps."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

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
    #: Standard error of the major semi-axis, from the spectrum of the rest near the constituent [m/s].
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
    #: Constituents that the record does not separate from a larger neighbour or from the mean.
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


#: Larger losses of precision to gaps are reported, and constituents that cause still larger ones left out
_LARGE_LOSS, _WORST_LOSS = 2.0, 10.0


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
        Two constituents are distinguished when their frequencies differ by so many cycles over the record, as they
        are and as even samples show them.
    trend : bool
        Fit a trend as well.

    Returns
    -------
    TidalFit

    Raises
    ------
    InputError
        Unknown names, fewer samples than unknowns, or a record that separates no constituent.
    """
    names = [name.upper() for name in names or ()]
    unknown = [name for name in names if name not in CONSTITUENTS]
    if unknown:
        raise InputError(f"unknown constituent '{unknown[0]}'", parameter="names", allowed=", ".join(CONSTITUENTS))
    t = np.asarray(time, dtype=float)
    u = np.asarray(x, dtype=float)
    v = None if y is None else np.asarray(y, dtype=float)
    data = u[:, None] if v is None else np.column_stack([u, v])
    known = np.isfinite(data).all(axis=1)
    t, data = t[known], data[known]
    if t.size < 5:
        raise InputError(f"{t.size} samples", parameter="time", allowed="five or more")
    if not np.ptp(data, axis=0).any():
        raise InputError(f"all {t.size} samples are {data[0, 0]:.6g}", parameter="x", remedy="check the gauge")
    length = float(t.max() - t.min())
    reference = 0.5 * float(t.min() + t.max())
    chosen, left_out, notices = _separable(t, names or _ORDER, rayleigh, trend)
    omega = np.radians([CONSTITUENTS[name] for name in chosen]) / 3600.0
    design = _design(t, omega, trend)
    if design.shape[1] >= t.size:
        raise InputError(
            f"{t.size} samples for {design.shape[1]} unknowns", parameter="names", remedy="take fewer names"
        )
    inverse = np.asarray(np.linalg.inv(design.T @ design), dtype=np.float64)
    solution = inverse @ design.T @ data
    rest = data - design @ solution
    count = len(chosen)
    found = solution[1 : 1 + count] + 1j * solution[1 + count : 1 + 2 * count]
    amplitudes = np.column_stack([found, np.zeros(count)])[:, :2]
    levels = _levels(t, rest, omega, design, inverse)
    ellipses = []
    for place, (name, w) in enumerate(zip(chosen, omega)):
        ellipse = _ellipse(name, 2.0 * math.pi / w, amplitudes[place], math.nan)
        axis = np.array([math.cos(ellipse.heading), math.sin(ellipse.heading)])[: data.shape[1]]
        pair = [1 + place, 1 + count + place]
        along = found[place] @ axis
        towards = np.array([along.real, along.imag]) / max(abs(along), 1e-300)
        error = math.sqrt(float(axis @ levels[place] @ axis * (towards @ inverse[np.ix_(pair, pair)] @ towards)))
        ellipses.append(replace(ellipse, error=error))
    explained = 1.0 - float(np.var(rest, axis=0).sum()) / float(np.var(data, axis=0).sum())
    both = np.zeros((design.shape[1], 2))
    both[:, : data.shape[1]] = solution
    slope = (float(both[-1, 0]) / length, float(both[-1, 1]) / length) if trend else (0.0, 0.0)
    mean = (float(both[0, 0]), float(both[0, 1]))
    return TidalFit(tuple(ellipses), mean, slope, explained, reference, amplitudes, tuple(left_out), tuple(notices))


def _design(t: Array, omega: Array, trend: bool) -> Array:
    """Return the columns of mean, cosines, sines and trend about the middle of the record."""
    since = t - 0.5 * float(t.min() + t.max())
    angles = since[:, None] * omega
    columns = [np.ones((t.size, 1)), np.cos(angles), np.sin(angles)]
    if trend:
        columns.append((since / float(np.ptp(t)))[:, None])
    return np.hstack(columns)


def _separable(
    t: Array, names: Sequence[str], rayleigh: float, trend: bool
) -> tuple[list[str], list[str], list[Notice]]:
    """Return the constituents that the record separates, those that it does not, and notices [eq:records-tide-error].

    Even samples show a constituent at the frequency that it is folded to: there it must stand ``rayleigh`` cycles over
    the record away from the others. Whatever gaps do on top is in the inverse of the normal matrix.
    """
    length = float(np.ptp(t))
    steps = np.diff(np.sort(t))
    step = float(np.median(steps))
    even = step > 0.0 and float(np.mean(np.abs(steps / step - np.rint(steps / step)) < 0.05)) > 0.95

    def seen(name: str) -> float:
        cycles = CONSTITUENTS[name] / 360.0 / 3600.0
        return abs(math.remainder(cycles, 1.0 / step)) if even else cycles

    wanted = sorted(dict.fromkeys(names), key=_ORDER.index)
    design = _design(t, np.radians([CONSTITUENTS[name] for name in wanted]) / 3600.0, trend)
    normal, extra = design.T @ design, [design.shape[1] - 1] if trend else []
    chosen: list[str] = []
    short, mixed, poor = [], [], {}
    for name in wanted:
        others = [0.0, *(CONSTITUENTS[other] / 1296000.0 for other in chosen)]
        folded = [0.0, *(seen(other) for other in chosen)]
        if min(abs(CONSTITUENTS[name] / 1296000.0 - other) for other in others) * length < rayleigh:
            short.append(name)
        elif min(abs(seen(name) - other) for other in folded) * length < rayleigh:
            mixed.append(name)
        else:
            places = [wanted.index(one) + 1 for one in (*chosen, name)]
            kept = [0, *places, *(len(wanted) + place for place in places), *extra]
            loss = _loss(normal[np.ix_(kept, kept)])
            if loss > _WORST_LOSS:
                mixed.append(name)
                continue
            chosen.append(name)
            if loss > _LARGE_LOSS:
                poor[name] = loss
    notices = []
    if short:
        message = f"the record is too short to separate {', '.join(short)} from larger neighbours"
        notices.append(Notice("tide-resolution", message, length / 86400.0, severity="information"))
    if mixed:
        message = (
            f"gaps, or the {step / 3600.0:.4g} h between samples, make {', '.join(mixed)} look like larger neighbours "
            "or like the mean: left out, and what there is of them is in those"
        )
        notices.append(Notice("tide-sampling", message, step / 3600.0, remedy="sample every hour, without gaps"))
    if poor:
        loss = max(poor.values())
        message = (
            f"gaps hardly separate {', '.join(poor)}: errors are up to {loss:.2g} times those of as many samples "
            "without gaps"
        )
        notices.append(Notice("tide-gaps", message, loss, _LARGE_LOSS, remedy="take fewer constituents"))
    if not chosen:
        message = notices[0].message if notices else "no constituent is asked for"
        raise InputError(
            f"a record of {length / 3600.0:.3g} h separates no constituents: {message}",
            parameter="time",
            remedy="check the unit of the time",
        )
    return chosen, [*short, *mixed], notices


def _loss(normal: Array) -> float:
    """Return how many times the largest error is that of columns without anything in common."""
    scale = np.sqrt(np.maximum(np.diag(normal), 1e-300))
    scaled = normal / np.outer(scale, scale)
    if np.linalg.cond(scaled) > 1e12:
        return math.inf
    return math.sqrt(float(np.max(np.diag(np.linalg.inv(scaled)))))


def _levels(t: Array, rest: Array, omega: Array, design: Array, inverse: Array) -> Array:
    """Return the variance of the noise next to each constituent, shape (constituents, columns, columns).

    The periodogram of the rest over what the fit leaves there of white noise [eq:records-tide-error]; its lines stand
    apart by one cycle over the time that holds samples.
    """
    steps = np.diff(np.sort(t))
    held = float(np.minimum(steps, 3.0 * np.median(steps)).sum())
    apart = np.arange(3.5, 9.0) * 2.0 * math.pi / held
    nearby = np.concatenate([-apart, apart])
    out = np.empty((omega.size, rest.shape[1], rest.shape[1]))
    for place, w in enumerate(omega):
        waves = np.exp(1j * np.abs(w + nearby)[:, None] * (t - t[0]))
        lines, taken = waves @ rest, waves @ design
        left = t.size - np.einsum("fi,ij,fj->f", taken.conj(), inverse, taken).real
        out[place] = (lines.conj().T @ lines).real / max(float(left.sum()), 1e-6 * t.size)
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
