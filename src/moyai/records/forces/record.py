"""Records of force and velocity for the identification of coefficients: faults are refused, one message each."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.series.plateaus import find_plateaus

#: Departure from an even time step that is forgiven, in steps
_STEP_TOLERANCE = 0.02
#: Samples that a period needs so that u|u| is resolved
_LEAST_SAMPLES = 12
#: Waves in a segment of a spectrum, segments at least and at most, and how often chance alone may pass for coherence
_WAVES_OF_SEGMENT, _LEAST_SEGMENTS, _MOST_SEGMENTS, _CHANCE = 4.0, 5, 12, 1e-3
#: Order of the filter that cuts noise, and periods of its frequency for which it rings
_ORDER, _RING = 6, 4.0


@dataclass(frozen=True, eq=False)
class ForceRecord:
    """Force on a member and velocity of the water at its axis, component by component.

    Raises
    ------
    InputError
        For gaps, uneven steps, lengths that differ, clipped gauges.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.records import ForceRecord
    >>> time = np.arange(0.0, 20.0, 0.05)
    >>> record = ForceRecord(time, force=100.0 * np.sin(time)[:, None], velocity=0.5 * np.cos(time)[:, None])
    >>> round(record.step, 6), record.components                         # [s]
    (0.05, 1)
    """

    #: Evenly spaced [s]; shape (samples,).
    time: Array
    #: Per length of the member [N/m]; shape (samples,) or (samples, components).
    force: Array
    #: Undisturbed, relative to the member [m/s].
    velocity: Array
    #: [m/s2]; found from the velocity when absent.
    acceleration: Array | None = None

    def __post_init__(self) -> None:
        time = np.array(self.time, dtype=float)
        if time.ndim != 1 or time.size < _LEAST_SAMPLES:
            raise InputError(
                f"the record holds {time.size} samples", parameter="time", allowed=f"at least {_LEAST_SAMPLES}"
            )
        object.__setattr__(self, "time", time)
        for name in ("force", "velocity", "acceleration"):
            given = getattr(self, name)
            if given is None:
                continue
            values = np.array(given, dtype=float)
            values = values[:, None] if values.ndim == 1 else values
            if values.ndim != 2 or len(values) != time.size:
                raise InputError(
                    f"{name} has {len(values)} rows, time {time.size}", parameter=name, allowed="equal lengths"
                )
            object.__setattr__(self, name, values)
        for name in ("velocity", "acceleration"):
            values = getattr(self, name)
            if values is not None and values.shape != self.force.shape:
                raise InputError(
                    f"{name} has {values.shape[1]} components, force {self.force.shape[1]}",
                    parameter=name,
                    allowed="equal",
                )
        _refuse_gaps(self)
        _refuse_uneven(time)
        for column in range(self.force.shape[1]):
            if np.ptp(self.velocity[:, column]) == 0.0:
                raise InputError(
                    f"velocity {column + 1} does not change", parameter="velocity", remedy="check the column"
                )
            _refuse_clipped(self.force[:, column], f"force {column + 1}")
            _refuse_clipped(self.velocity[:, column], f"velocity {column + 1}")

    @property
    def step(self) -> float:
        """Time step [s]."""
        return float((self.time[-1] - self.time[0]) / (self.time.size - 1))

    @property
    def duration(self) -> float:
        """Length of the record [s], the last step included."""
        return self.step * self.time.size

    @property
    def components(self) -> int:
        """Number of components."""
        return int(self.force.shape[1])

    def part(self, first: int, last: int) -> ForceRecord:
        """Return the samples from ``first`` up to ``last`` (excluded).

        Parameters
        ----------
        first, last : int
            Rows, ``last`` excluded.
        """
        rows = slice(first, last)
        rate = None if self.acceleration is None else self.acceleration[rows]
        return ForceRecord(self.time[rows], self.force[rows], self.velocity[rows], rate)


def _refuse_gaps(record: ForceRecord) -> None:
    for name in ("time", "force", "velocity", "acceleration"):
        values = getattr(record, name)
        if values is None:
            continue
        good = np.isfinite(values) if values.ndim == 1 else np.isfinite(values).all(axis=1)
        if not good.all():
            rows = np.flatnonzero(~good)
            raise InputError(
                f"{name} is not a number in {rows.size} of {good.size} samples, first in sample {rows[0] + 1}",
                parameter=name,
                remedy="fill short gaps or choose a part of the record without any",
            )


def _refuse_uneven(time: Array) -> None:
    steps = np.diff(time)
    if (steps <= 0.0).any():
        row = int(np.argmax(steps <= 0.0)) + 2
        raise InputError(
            f"time does not rise at sample {row}", parameter="time", remedy="sort the record or cut it at the reset"
        )
    even = float(np.median(steps))
    off = np.abs(steps - even)
    if off.max() > _STEP_TOLERANCE * even:
        row = int(np.argmax(off)) + 2
        raise InputError(
            f"the record is not evenly sampled: the step to sample {row} is {steps[row - 2]:.6g} s, most are "
            f"{even:.6g} s",
            parameter="time",
            allowed="an even time step",
            remedy="interpolate the record to an even step, or choose a part without dropped samples",
        )


def _refuse_clipped(values: Array, name: str) -> None:
    """Refuse flat tops that a smooth record rounded to the resolution of its gauge would not show."""
    for plateau in find_plateaus(values):
        raise InputError(
            f"{name} is clipped: it stays at its {plateau.word} {plateau.level:.6g} for {plateau.longest} samples",
            parameter=name.split()[0],
            remedy="use a record within the range of the gauge",
        )


def acceleration_of(velocity: Array, step: float) -> Array:
    """Return the derivative of a velocity record by a spline of fifth order.

    Parameters
    ----------
    velocity : ndarray, shape (samples, components)
        [m/s].
    step : float
        [s].
    """
    from scipy.interpolate import make_interp_spline

    time = step * np.arange(len(velocity))
    return np.asarray(make_interp_spline(time, velocity, k=5).derivative()(time))


@dataclass(frozen=True)
class NoiseCut:
    """Where noise of a gauge takes over in the derivative of a velocity."""

    #: Frequency above which force and velocity have nothing in common [Hz].
    frequency: float
    #: Share of the variance of the derivative that noise makes, as recorded.
    share: float
    #: The same share below the cut.
    share_left: float


def noise_cut(velocity: Array, force: Array, step: float) -> NoiseCut | None:
    """Return where noise takes over in the derivative of a velocity (samples,) [eq:identification-noise].

    The force contains the waves and not the noise of the current meter: the derivative is cut where the part that is
    coherent with the force ends. ``None`` where the record is too short to show it.
    """
    from scipy.signal import csd, welch

    power = np.abs(np.fft.rfft(velocity - velocity.mean()))
    segments = min(int(np.argmax(power) / _WAVES_OF_SEGMENT), _MOST_SEGMENTS)
    if segments < _LEAST_SEGMENTS:
        return None
    count = len(velocity) // segments
    given = {"fs": 1.0 / step, "nperseg": count, "detrend": "constant"}
    frequency, density = welch(velocity, **given)
    crossed = np.abs(csd(velocity, force, **given)[1]) ** 2 / np.maximum(density * welch(force, **given)[1], 1e-300)
    # overlapping segments count as so many independent ones; what chance alone would show is none
    independent = 0.6 * (2.0 * len(velocity) / count - 1.0)
    known = np.where(crossed > 1.0 - _CHANCE ** (1.0 / (independent - 1.0)), crossed, 0.0)
    known = np.maximum((known * independent - 1.0) / (independent - 1.0), 0.0)
    rate = (2.0 * math.pi * frequency) ** 2
    common = np.cumsum(rate * density * known)
    if not common[-1] > 0.0:
        return None
    end = min(1.25 * float(frequency[np.searchsorted(common, 0.995 * common[-1])]), 0.98 * float(frequency[-1]))
    beyond = (frequency > end) & (frequency <= 2.0 * end)
    alone = float(np.median((density * (1.0 - known))[beyond])) if beyond.any() else 0.0
    passed = rate * _response(frequency, end) ** 2
    below, whole = frequency <= end, float(rate @ density)
    share = 1.0 - (float(rate[below] @ density[below]) - alone * float(rate[below].sum())) / whole
    return NoiseCut(end, share, alone * float(passed.sum()) / float(passed @ density))


def _response(frequency: Array, cut: float) -> Array:
    """Return the factor by which :func:`without_noise` lowers a frequency."""
    return 1.0 / (1.0 + (frequency / cut) ** (2 * _ORDER))


@checks_words
def without_noise(values: Array, step: float, frequency: float, *, ends: Literal["odd", "even"] = "odd") -> Array:
    """Return columns (samples, ...) without what lies above a frequency [Hz], without shifting what lies below.

    At its ends the record is led on ``odd``, turned about them, or ``even``, mirrored.
    """
    from scipy.signal import butter, sosfiltfilt

    length = min(len(values) - 1, math.ceil(_RING / (frequency * step)))
    low = butter(_ORDER, frequency, fs=1.0 / step, output="sos")
    return np.asarray(sosfiltfilt(low, values, axis=0, padtype=ends, padlen=length))


def period_of(time: Array, records: Array) -> float:
    """Return the period of regular records [s]: the one that mean and first harmonic fit best.

    Parameters
    ----------
    time : ndarray, shape (samples,)
        Evenly spaced [s].
    records : ndarray, shape (samples, channels)
        The channel that moves most decides.

    Raises
    ------
    InputError
        When the record holds less than two periods, so that it does not show it.
    """
    step = float((time[-1] - time[0]) / (time.size - 1))
    duration = step * time.size
    centred = records - records.mean(axis=0)
    values = centred[:, int(np.argmax(centred.std(axis=0)))]
    power = np.abs(np.fft.rfft(values * np.hanning(values.size), 8 * values.size))
    peak = int(np.argmax(power[1:])) + 1
    guess = 2.0 * math.pi * peak / (8 * values.size * step)
    if guess * duration < 4.0 * math.pi:
        raise InputError(
            f"the record of {duration:.4g} s shows less than two periods", parameter="period", remedy="give the period"
        )

    def residual(omega: float) -> float:
        angle = omega * (time - time.mean())
        design = np.column_stack([np.ones_like(angle), np.cos(angle), np.sin(angle)])
        fit, *_ = np.linalg.lstsq(design, values, rcond=None)
        return float(np.sum((values - design @ fit) ** 2))

    from scipy.optimize import minimize_scalar

    width = math.pi / duration
    found = minimize_scalar(residual, bounds=(guess - width, guess + width), method="bounded", options={"xatol": 1e-13})
    return 2.0 * math.pi / float(found.x)
