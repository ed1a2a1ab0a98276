"""Spectra and cross spectra of records by Welch's method, with stated degrees of freedom.

Densities are one-sided over frequency [Hz], as instruments give them. Complex spectra follow ``Re(X exp(-i omega t))``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.validity import Notice

Window = Literal["hann", "rectangular", "cosine_tenth"]


@checks_words
@dataclass(frozen=True)
class WelchOptions:
    """How a record is cut into segments."""

    #: Length of a segment [s]; infinite takes the whole record.
    segment: float = math.inf
    #: Share of a segment that it has in common with the next, 0 to 0.9.
    overlap: float = 0.5
    #: Taper; ``cosine_tenth`` tapers a tenth at each end; one of "hann", "rectangular", "cosine_tenth".
    window: Window = "hann"
    #: What is taken off each segment.
    detrend: Literal["none", "mean", "linear"] = "linear"
    #: Neighbouring frequencies averaged after that.
    bands: int = 1

    def __post_init__(self) -> None:
        if not 0.0 <= self.overlap <= 0.9:
            raise InputError(f"overlap {self.overlap:g}", parameter="overlap", allowed="0 to 0.9")
        if self.bands < 1:
            raise InputError(f"{self.bands} bands", parameter="bands", allowed="1 or more")
        if not self.segment > 0.0:
            raise InputError(f"segment {self.segment:g} s", parameter="segment", allowed="greater than 0")


@checks_words
def taper(kind: Window, size: int) -> Array:
    """Return the window of ``size`` samples (periodic form)."""
    place = np.arange(size) / size
    if kind == "hann":
        return np.asarray(0.5 - 0.5 * np.cos(2.0 * math.pi * place))
    if kind == "cosine_tenth":
        edge = np.clip(np.minimum(place, 1.0 - place) / 0.1, 0.0, 1.0)
        return np.asarray(0.5 - 0.5 * np.cos(math.pi * edge))
    return np.ones(size)


@dataclass(frozen=True, eq=False)
class CrossSpectra:
    """Spectral matrix of some channels."""

    #: [Hz]; shape (frequencies,).
    frequency: Array
    #: One-sided cross spectra ``S_ij = 2 <X_i X_j*> / ...``: auto spectra on the diagonal [unit2/Hz]; shape
    #: (frequencies, channels, channels).
    matrix: ComplexArray
    #: Equivalent degrees of freedom of each estimate; equation [eq:records-freedom].
    degrees_of_freedom: float
    #: Segments used.
    segments: int
    #: Segments left out because a sample was missing.
    left_out: int
    #: Width of the frequency band that one estimate stands for [Hz].
    resolution: float
    notices: tuple[Notice, ...] = ()

    def auto(self, channel: int = 0) -> Array:
        """Return the spectrum of a channel [unit2/Hz]."""
        return np.asarray(self.matrix[:, channel, channel].real)

    def coherence(self, first: int, second: int) -> Array:
        """Return the squared coherence of two channels [-]; 0 where one has no energy."""
        power = self.auto(first) * self.auto(second)
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.where(power > 0.0, np.abs(self.matrix[:, first, second]) ** 2 / power, 0.0)

    def spectrum(self, channel: int = 0) -> MeasuredSpectrum:
        """Return the spectrum of a channel with its moments."""
        return MeasuredSpectrum(
            self.frequency,
            self.auto(channel),
            self.degrees_of_freedom,
            self.segments,
            self.left_out,
            self.resolution,
            self.notices,
        )


@dataclass(frozen=True, eq=False)
class MeasuredSpectrum:
    """Spectrum of one channel."""

    #: [Hz], evenly spaced.
    frequency: Array
    #: One-sided density [unit2/Hz].
    density: Array
    #: Equivalent degrees of freedom of each estimate.
    degrees_of_freedom: float
    #: Segments used.
    segments: int = 1
    #: Segments left out.
    left_out: int = 0
    #: [Hz].
    resolution: float = math.nan
    notices: tuple[Notice, ...] = ()

    def moment(self, order: float, lowest: float = 0.0, highest: float = math.inf) -> float:
        """Return the moment of ``order`` over a band [Hz]: sum of f^n S df [unit2 Hz^n]."""
        f = self.frequency
        chosen = (f >= lowest) & (f <= highest) & (f > 0.0)
        return float(np.sum(f[chosen] ** order * self.density[chosen]) * (f[1] - f[0]))

    def figures(self, lowest: float = 0.0, highest: float = math.inf) -> dict[str, float]:
        """Return heights and periods over a band [Hz]; equation [eq:records-moments].

        Returns
        -------
        dict
            ``spectral_height`` (4 sqrt m0), ``peak_period`` (of the parabola through the highest estimate),
            ``smooth_peak_period`` (from the centroid of S^4), ``period_m01``, ``period_m02``, ``period_energy``
            (m-1/m0), ``spectral_width``.
        """
        m0, m1, m2, m4 = (self.moment(order, lowest, highest) for order in (0, 1, 2, 4))
        below = self.moment(-1, lowest, highest)
        if not m0 > 0.0:
            return dict.fromkeys(FIGURES, math.nan)
        chosen = (self.frequency >= lowest) & (self.frequency <= highest) & (self.frequency > 0.0)
        f, s = self.frequency[chosen], self.density[chosen]
        weight = (s / s.max()) ** 4
        width = math.sqrt(max(1.0 - m2**2 / (m0 * m4), 0.0)) if m4 > 0.0 else math.nan
        figures = (
            4.0 * math.sqrt(m0),
            1.0 / _peak_frequency(f, s),
            float(np.sum(weight) / np.sum(weight * f)),
            m0 / m1,
            math.sqrt(m0 / m2),
            below / m0,
            width,
        )
        return dict(zip(FIGURES, figures))

    def interval(self, confidence: float = 0.95) -> tuple[float, float]:
        """Return the factors on the density that bound its true value by chi-square."""
        from scipy.stats import chi2

        nu, tail = self.degrees_of_freedom, 0.5 * (1.0 - confidence)
        return float(nu / chi2.ppf(1.0 - tail, nu)), float(nu / chi2.ppf(tail, nu))


FIGURES = (
    "spectral_height",
    "peak_period",
    "smooth_peak_period",
    "period_m01",
    "period_m02",
    "period_energy",
    "spectral_width",
)


def _peak_frequency(frequency: Array, density: Array) -> float:
    place = int(np.argmax(density))
    if 0 < place < frequency.size - 1:
        left, here, right = density[place - 1 : place + 2]
        bend = left - 2.0 * here + right
        if bend < 0.0:
            return float(frequency[place] + 0.5 * (left - right) / bend * (frequency[1] - frequency[0]))
    return float(frequency[place])


def cross_spectra(step: float, channels: ArrayLike, options: WelchOptions) -> CrossSpectra:
    """Return the spectral matrix of evenly stepped channels; equation [eq:records-welch].

    Segments with a missing sample in any channel are left out and counted.

    Parameters
    ----------
    step : float
        Time step [s].
    channels : array_like, shape (samples,) or (samples, channels)
        NaN where missing.
    options : WelchOptions

    Returns
    -------
    CrossSpectra

    Raises
    ------
    InputError
        When no whole segment is left, or the step is not positive.
    """
    values = np.asarray(channels, dtype=np.float64)
    values = values[:, None] if values.ndim == 1 else values
    if not (math.isfinite(step) and step > 0.0):
        raise InputError(f"time step {step:g} s", parameter="step", allowed="greater than 0")
    size = values.shape[0] if math.isinf(options.segment) else round(options.segment / step)
    if size < 8 or size > values.shape[0]:
        raise InputError(
            f"segments of {size} samples in a record of {values.shape[0]}",
            parameter="segment",
            allowed="8 samples to the whole record",
        )
    shift = max(round(size * (1.0 - options.overlap)), 1)
    starts = np.arange(0, values.shape[0] - size + 1, shift)
    window = taper(options.window, size)
    power = float(np.sum(window**2))
    total: ComplexArray = np.zeros((size // 2 + 1, values.shape[1], values.shape[1]), dtype=np.complex128)
    used = 0
    ramp = np.arange(size) - 0.5 * (size - 1)
    ramp_power = float(np.sum(ramp**2))
    for start in starts:
        part = values[start : start + size]
        if not np.isfinite(part).all():
            continue
        if options.detrend != "none":
            part = part - part.mean(axis=0)
        if options.detrend == "linear":
            part = part - ramp[:, None] * (ramp @ part / ramp_power)
        # numpy's transform has exp(-i omega t) inside: its conjugate is the amplitude of Re(X exp(-i omega t))
        transform = np.conj(np.fft.rfft(part * window[:, None], axis=0))
        total += transform[:, :, None] * np.conj(transform[:, None, :])
        used += 1
    if used == 0:
        raise InputError(
            f"every segment of {size} samples lacks a sample", parameter="segment", remedy="take shorter segments"
        )
    density = np.asarray(total * (2.0 * step / (power * used)), dtype=np.complex128)
    density[0] *= 0.5
    if size % 2 == 0:
        density[-1] *= 0.5
    frequency = np.asarray(np.fft.rfftfreq(size, step), dtype=np.float64)
    freedom = degrees_of_freedom(window, shift, used, options.bands)
    if options.bands >= frequency.size:
        raise InputError(
            f"{options.bands} bands of {frequency.size - 1} frequencies",
            parameter="bands",
            allowed=f"1 to {(frequency.size - 1) // 2}",
        )
    if options.bands > 1:
        # The mean value is no wave: bands begin above zero frequency
        count = (frequency.size - 1) // options.bands
        kept = slice(1, 1 + count * options.bands)
        density = np.asarray(density[kept].reshape(count, options.bands, *density.shape[1:]).mean(axis=1))
        frequency = np.asarray(frequency[kept].reshape(count, options.bands).mean(axis=1), dtype=np.float64)
    notices = []
    left_out = starts.size - used
    if left_out:
        message = f"{left_out} of {starts.size} segments lack a sample and are left out of the spectrum"
        notices.append(Notice("spectrum-segments", message, float(left_out), 0.0))
    width = power / float(np.sum(window)) ** 2 * size
    resolution = (width + options.bands - 1.0) / (size * step)
    return CrossSpectra(frequency, density, freedom, used, left_out, resolution, tuple(notices))


def spectrum_of(step: float, values: ArrayLike, options: WelchOptions) -> MeasuredSpectrum:
    """Return the spectrum of one channel; see :func:`cross_spectra`."""
    return cross_spectra(step, values, options).spectrum()


def degrees_of_freedom(window: Array, shift: int, segments: int, bands: int = 1) -> float:
    """Return the equivalent degrees of freedom of overlapping segments; equation [eq:records-freedom].

    Parameters
    ----------
    window : ndarray
        Taper of a segment.
    shift : int
        Samples from the start of one segment to that of the next.
    segments : int
        Number of segments.
    bands : int
        Neighbouring frequencies averaged. Under overlap neighbours of different segments go together too, so that their
        shares do not simply multiply.
    """
    size, power = window.size, float(np.sum(window**2))
    shares = 0.0
    for lag in range(segments):
        if lag * shift >= size:
            break
        product = np.zeros(size)
        product[: size - lag * shift] = window[lag * shift :] * window[: size - lag * shift]
        correlation = np.abs(np.fft.fft(product)[:bands] / power) ** 2
        together = float(correlation[0] + 2.0 * np.sum((1.0 - np.arange(1, bands) / bands) * correlation[1:]))
        shares += (1.0 if lag == 0 else 2.0) * (1.0 - lag / segments) * together
    return 2.0 * segments * bands / shares


def height_sampling_error(frequency: Array, density: Array, degrees_of_freedom: float, duration: float) -> float:
    """Return the standard error of Hm0 of one stretch of a sea, over Hm0; equation [eq:records-height-error].

    Parameters
    ----------
    frequency : ndarray
        Evenly spaced [Hz].
    density : ndarray
        One-sided density, an estimate with sampling errors of its own.
    degrees_of_freedom : float
        Of the estimate: it makes the mean of the squared density too large.
    duration : float
        Length of the stretch [s].

    Returns
    -------
    float
        Fraction; NaN without energy. A stationary Gaussian sea, for small fractions.
    """
    variance = float(np.trapezoid(density, frequency))
    squared = float(np.trapezoid(density**2, frequency)) / (1.0 + 2.0 / degrees_of_freedom)
    return 0.5 * math.sqrt(squared / duration) / variance if variance > 0.0 else math.nan
