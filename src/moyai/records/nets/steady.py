"""Steady towing: the window that is steady, and its mean with an uncertainty that allows for correlated samples."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.series.intervals import student_quantile

#: Share of the plateau within which a speed counts as steady, and a force
_SPEED_BAND, _FORCE_BAND = 0.03, 0.15
#: Least length of a steady window over that of the record
_LEAST_SHARE = 0.1


@dataclass(frozen=True)
class Mean:
    """A mean and what is known of it."""

    #: The mean.
    value: float
    #: Its standard error.
    error: float
    #: Effective number of independent samples less one.
    freedom: float
    #: Of the interval at the confidence asked for.
    half_width: float


def correlated_mean(values: Array, confidence: float = 0.95) -> Mean:
    """Return the mean of correlated samples [eq:net-effective-samples].

    The variance of the mean is that of the samples over their effective number n / (2 tau), tau the integrated
    autocorrelation up to the first lag above five times itself.

    Parameters
    ----------
    values : ndarray, shape (samples,)
    confidence : float
        Of the interval.

    Raises
    ------
    InputError
        For fewer than 16 samples.
    """
    size = values.size
    if size < 16:
        raise InputError(f"{size} samples in the steady window", parameter="window", allowed="at least 16")
    centred = values - values.mean()
    variance = float(centred @ centred) / size
    if variance == 0.0:
        return Mean(float(values.mean()), 0.0, float(size - 1), 0.0)
    padded = np.fft.rfft(centred, 2 * size)
    correlation = np.fft.irfft(padded * padded.conj())[:size] / (size * variance)
    # less data meet at long lags; the mean taken off lowers the correlation by the variance of the mean itself
    running = 0.5 + np.cumsum(correlation[1:])
    lags = np.arange(1, running.size + 1)
    stop = np.flatnonzero(lags >= 5.0 * np.maximum(running, 0.5))
    last = int(stop[0]) if stop.size else running.size - 1
    tau = max(float(running[last]), 0.5 / size)
    window = float(lags[last])
    tau = tau / max(1.0 - 2.0 * tau * (1.0 - tau / size) / size - window / size, 0.2)
    effective = max(min(size / (2.0 * tau), 4.0 * size), 1.5)
    # the samples scatter about their own mean, which takes the share of one of them
    error = math.sqrt(variance / (effective - 1.0))
    # a variance found from so many lags of the record is itself known to so many degrees of freedom only
    freedom = max(min(effective - 1.0, size / window), 1.0)
    return Mean(float(values.mean()), error, freedom, student_quantile(confidence, freedom) * error)


def zero_error(noise: Array, samples: int) -> float:
    """Return the standard error of a reading at rest: that of means over so many samples of the same noise.

    Parameters
    ----------
    noise : ndarray
        What a fit or a mean leaves of a record.
    samples : int
        Length of the reading at rest; longer than a quarter of the noise counts as that.
    """
    length = max(1, min(samples, noise.size // 4))
    sums = np.cumsum(np.concatenate([[0.0], noise - noise.mean()]))
    means = (sums[length:] - sums[:-length]) / length
    return float(means.std())


def correlated_covariance(gain: Array, residual: Array, shortest: float) -> tuple[Array, float]:
    """Return the covariance of coefficients that are linear in a force with correlated errors [eq:net-sandwich].

    Its degrees of freedom come with it: 1.5 n over the lag that the autocorrelation is followed to.

    Parameters
    ----------
    gain : ndarray, shape (coefficients, samples)
        Matrix that takes the force to the coefficients.
    residual : ndarray, shape (samples,)
        What the fit leaves: its autocorrelation is that of the errors.
    shortest : float
        Least lag that is followed [samples]; more where the residual remembers longer.
    """
    size = residual.size
    padded = np.fft.rfft(residual, 2 * size)
    lags = np.arange(size)
    cover = np.fft.irfft(padded * padded.conj())[:size] / size
    if cover[0] <= 0.0:
        return np.zeros((len(gain), len(gain))), float(size)
    running = 0.5 + np.cumsum(cover[1:]) / cover[0]
    stop = np.flatnonzero(lags[1:] >= 6.0 * np.maximum(running, 0.5))
    last = int(stop[0]) if stop.size else running.size - 1
    reach = min(max(2.0 * (last + 1.0), shortest), 0.3 * size)
    # flat up to half of its reach: what a shorter memory holds counts in full
    window = np.clip(2.0 - 2.0 * lags / reach, 0.0, 1.0)
    # the fit took its own mean off the errors, the more of it the longer they remember
    tau = max(float(running[last]), 0.5)
    cover = cover / max(1.0 - (2.0 * tau + 0.5 * reach) / size, 0.4)
    cover = cover * window
    spectra = np.fft.rfft(gain, 2 * size, axis=1)
    errors = np.fft.rfft(np.concatenate([cover, [0.0], cover[:0:-1]])).real
    both = np.array([[np.fft.irfft(errors * one * two.conj(), 2 * size)[0] for two in spectra] for one in spectra])
    # a parameter a coefficient is lost
    scale = 0.5 * size / max(size - 2.0 * len(gain), 1.0)
    return np.asarray(scale * (both + both.T)), 1.5 * size / reach


def steady_window(time: Array, signal: Array, *, is_speed: bool) -> tuple[float, float]:
    """Return the longest stretch on the plateau of a speed or a low-passed force, its ends trimmed by a tenth.

    Parameters
    ----------
    time : ndarray
        [s].
    signal : ndarray
        Speed [m/s] or low-passed force [N].
    is_speed : bool
        A speed is held within 3 % of its plateau, a force within 15 %, or three times its own slow noise.

    Raises
    ------
    InputError
        When no stretch of a tenth of the record is steady.
    """
    size = np.abs(signal)
    top = float(np.quantile(size, 0.95))
    if top <= 0.0:
        raise InputError("the record does not move", parameter="window", remedy="give the window, or check the column")
    upper = size[size > 0.5 * top]
    plateau = float(np.median(upper))
    band = (_SPEED_BAND if is_speed else _FORCE_BAND) * plateau
    if not is_speed:
        # a small force swings about its plateau by its own slow noise
        band = max(band, 4.5 * float(np.median(np.abs(upper - plateau))))
    good = np.abs(size - plateau) <= band
    # single samples of noise do not end a stretch
    width = max(1, time.size // 100)
    share = np.convolve(good.astype(float), np.ones(width) / width, mode="same")
    good = share >= 0.5
    edges = np.flatnonzero(np.diff(np.concatenate([[0], good.astype(int), [0]])))
    starts, ends = edges[::2], edges[1::2]
    if starts.size == 0 or (ends - starts).max() < max(16, _LEAST_SHARE * time.size):
        raise InputError(
            "no steady stretch was found in the record", parameter="window", remedy="give the steady window of this run"
        )
    longest = int(np.argmax(ends - starts))
    first, last = float(time[starts[longest]]), float(time[ends[longest] - 1])
    trim = 0.1 * (last - first)
    # a record that is steady from its first to its last sample has no ramp to stay away from
    return (
        first + (trim if starts[longest] > 0 else 0.0),
        last - (trim if ends[longest] < time.size else 0.0),
    )
