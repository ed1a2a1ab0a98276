"""The vibration of a towing carriage in force records: found in still-water runs, removed without shifting phases.

The line is found in the spectrum of the steady part. It is taken out by a stop band of the Fourier transform, which is
symmetric in time. Where the carriage's acceleration was measured, the inertia force of what it shakes is subtracted
instead.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.series.spectra import WelchOptions, spectrum_of

#: A line stands out of the spectrum about it by this factor at least
_LEAST_PROMINENCE = 6.0
#: Chance of calling the largest estimate of a smooth spectrum a line
_FALSE_ALARM = 1e-4
#: The band reaches to where the spectrum is so many times that about the line
_EDGE = 1.6
#: Widest half band over the frequency of the line
_WIDEST = 0.3


@dataclass(frozen=True)
class Vibration:
    """A line of the spectrum."""

    #: Of the line [Hz].
    frequency: float
    #: Lower end of the band that holds the line [Hz].
    low: float
    #: Upper end of the band that holds the line [Hz].
    high: float
    #: Root mean square of the force in the band, mean over the runs [N].
    amplitude: float = math.nan
    #: Spectral density of the line over that about it [-].
    prominence: float = math.nan

    def __post_init__(self) -> None:
        if not 0.0 < self.low < self.frequency < self.high < math.inf:
            raise InputError(
                f"a stop band from {self.low:g} to {self.high:g} Hz about {self.frequency:g} Hz",
                parameter="vibration",
                allowed="0 < low < line < high",
            )


@dataclass(frozen=True, eq=False)
class VibrationSearch:
    """What the search saw."""

    #: Frequencies of the spectrum [Hz].
    frequency: Array
    #: Mean spectral density of the runs, each over its own median [-].
    density: Array
    #: The smooth density about it [-].
    background: Array
    found: Vibration | None
    #: Prominence from which on an estimate is called a line [-].
    limit: float


def find_vibration(
    steps: Sequence[float], forces: Sequence[Array], *, lowest: float = 1.5, highest: float = 20.0
) -> VibrationSearch:
    """Find the strongest line in the spectra of steady records [eq:net-vibration-search].

    Parameters
    ----------
    steps : sequence of float
        Time steps [s].
    forces : sequence of ndarray
        Steady parts of still-water runs [N].
    lowest, highest : float
        Frequencies to search [Hz]; the highest is cut at 0.9 of the Nyquist frequency.

    Raises
    ------
    InputError
        Without runs, or when they are too short or too coarse for the range.
    """
    if not forces:
        raise InputError("there is no still-water run to find the vibration in", parameter="runs")
    highest = min(highest, 0.45 / max(steps))
    if not 0.0 < lowest < highest:
        raise InputError(
            f"no frequency to search between {lowest:g} and {highest:.4g} Hz",
            parameter="vibration.search",
            allowed="a range below 0.9 of the Nyquist frequency",
        )
    shortest = min(step * force.size for step, force in zip(steps, forces))
    # about eight cycles of the lowest frequency resolve a line; more segments steady the spectrum
    segment = min(max(16.0 / lowest, 0.2 * shortest), shortest)
    if segment * lowest < 4.0:
        raise InputError(
            f"a steady part of {shortest:.3g} s is too short to search from {lowest:g} Hz on",
            parameter="vibration.search",
            remedy="use longer runs, or give the band",
        )
    grid: Array | None = None
    mean = np.zeros(0)
    freedom, power = 0.0, []
    for step, force in zip(steps, forces):
        found = spectrum_of(step, force - force.mean(), WelchOptions(segment=segment, overlap=0.5))
        band = (found.frequency >= 0.5 * lowest) & (found.frequency <= highest * 1.1)
        if grid is None:
            grid = found.frequency[band]
            mean = np.zeros(grid.size)
        density = np.interp(grid, found.frequency, found.density)
        scale = float(np.median(density[grid >= lowest]))
        mean += density / max(scale, 1e-300)
        freedom += found.degrees_of_freedom
        power.append((found.frequency, found.density))
    assert grid is not None
    mean /= len(forces)
    background = _background(grid, mean)
    ratio = np.where(background > 0.0, mean / background, 0.0)
    limit = _limit(freedom, grid.size)
    inside = (grid >= lowest) & (grid <= highest)
    lines = inside & (ratio > limit)
    if not lines.any():
        return VibrationSearch(grid, mean, background, None, limit)
    peak = int(np.argmax(np.where(lines, mean, 0.0)))
    low, high = _edges(grid, ratio, peak)
    frequency = min(max(_refined(grid, mean, peak), low * (1.0 + 1e-9)), high * (1.0 - 1e-9))
    amplitude = math.sqrt(float(np.mean([_band_power(f, s, low, high) for f, s in power])))
    return VibrationSearch(
        grid, mean, background, Vibration(frequency, low, high, amplitude, float(ratio[peak])), limit
    )


def _background(grid: Array, density: Array) -> Array:
    """Return a running median about each frequency, over a range that a line fills less than half of."""
    out = np.empty_like(density)
    for k, frequency in enumerate(grid):
        near = np.abs(np.log(np.maximum(grid, 1e-9) / max(frequency, 1e-9))) < math.log(1.9)
        out[k] = np.median(density[near])
    return out


def _limit(freedom: float, count: int) -> float:
    from scipy.stats import chi2

    chance = float(chi2.ppf(1.0 - _FALSE_ALARM / max(count, 1), max(freedom, 2.0)) / max(freedom, 2.0))
    # compared with a median, which lies below the mean of so few degrees of freedom
    return max(_LEAST_PROMINENCE, chance * freedom / float(chi2.ppf(0.5, max(freedom, 2.0))))


def _edges(grid: Array, ratio: Array, peak: int) -> tuple[float, float]:
    widest = _WIDEST * grid[peak]
    first = last = peak
    while first > 0 and ratio[first - 1] > _EDGE and grid[peak] - grid[first - 1] < widest:
        first -= 1
    while last < grid.size - 1 and ratio[last + 1] > _EDGE and grid[last + 1] - grid[peak] < widest:
        last += 1
    resolution = float(grid[1] - grid[0])
    return float(grid[first]) - 1.5 * resolution, float(grid[last]) + 1.5 * resolution


def _refined(grid: Array, density: Array, peak: int) -> float:
    if not 0 < peak < grid.size - 1:
        return float(grid[peak])
    left, middle, right = np.log(density[peak - 1 : peak + 2])
    bend = left - 2.0 * middle + right
    shift = 0.0 if bend >= 0.0 else 0.5 * (left - right) / bend
    return float(grid[peak] + shift * (grid[1] - grid[0]))


def _band_power(frequency: Array, density: Array, low: float, high: float) -> float:
    band = (frequency >= low) & (frequency <= high)
    return float(np.sum(density[band]) * (frequency[1] - frequency[0]))


def low_pass(step: float, values: Array, cut: float) -> Array:
    """Return a record without what is faster than a frequency, phases unchanged [eq:net-filter].

    Parameters
    ----------
    step : float
        Time step [s].
    values : ndarray, shape (samples,)
    cut : float
        Frequency from which on the gain falls, to nothing at 1.3 times it [Hz].
    """
    return _filtered(step, values, lambda f: _fall(f, cut, 1.3 * cut))


def remove_band(step: float, values: Array, vibration: Vibration) -> Array:
    """Return a record without what lies in the band of a vibration, phases unchanged [eq:net-filter].

    Of a record in waves only what a model leaves unexplained belongs here: the filter takes the harmonics that lie in
    the band with it.

    Parameters
    ----------
    step : float
        Time step [s].
    values : ndarray, shape (samples,)
    vibration : Vibration
    """
    edge = 0.5 * min(vibration.frequency - vibration.low, vibration.high - vibration.frequency)

    def gain(f: Array) -> Array:
        inside = 1.0 - _fall(f, vibration.low, vibration.low + edge)
        return 1.0 - inside * _fall(f, vibration.high - edge, vibration.high)

    return _filtered(step, values, gain)


def _fall(frequency: Array, start: float, end: float) -> Array:
    """Return 1 below ``start``, 0 above ``end``, half a cosine between."""
    place = np.clip((frequency - start) / (end - start), 0.0, 1.0)
    return np.asarray(0.5 + 0.5 * np.cos(math.pi * place))


def _filtered(step: float, values: Array, gain: Callable[[Array], Array]) -> Array:
    """Filter by the Fourier transform of the record mirrored oddly at both ends, so that its ends do not ring."""
    size = values.size
    if size < 8:
        raise InputError(f"{size} samples are too few for a filter", parameter="values", allowed="at least 8")
    reach = size - 1
    before = 2.0 * values[0] - values[reach:0:-1]
    after = 2.0 * values[-1] - values[-2 : -2 - reach : -1]
    whole = np.concatenate([before, values, after])
    line = np.linspace(whole[0], whole[-1], whole.size)
    frequency: Array = np.asarray(np.fft.rfftfreq(whole.size, step), dtype=np.float64)
    spectrum = np.fft.rfft(whole - line) * gain(frequency)
    slow = float(gain(np.zeros(1))[0])
    return np.asarray((np.fft.irfft(spectrum, whole.size) + slow * line)[reach : reach + size])


@dataclass(frozen=True)
class ShakenMass:
    """Mass that the gauge carries, by the acceleration of the carriage in the band of the vibration."""

    #: Force per acceleration, in phase, sign of the gauge included [kg].
    mass: float
    #: Its standard error [kg].
    error: float
    #: Squared coherence of force and acceleration in the band [-].
    coherence: float


def shaken_mass(step: float, force: Array, acceleration: Array, vibration: Vibration) -> ShakenMass:
    """Return the mass whose inertia force best explains the vibration [eq:net-shaken-mass].

    Parameters
    ----------
    step : float
        Time step [s].
    force, acceleration : ndarray, shape (samples,)
        [N], of the carriage [m/s2].
    vibration : Vibration

    Raises
    ------
    InputError
        When the acceleration holds nothing in the band.
    """
    taper = np.hanning(force.size)
    frequency = np.fft.rfftfreq(force.size, step)
    band = (frequency >= vibration.low) & (frequency <= vibration.high)
    one = np.fft.rfft((force - force.mean()) * taper)[band]
    two = np.fft.rfft((acceleration - acceleration.mean()) * taper)[band]
    size = float(np.sum(np.abs(two) ** 2))
    if one.size < 3 or size <= 0.0:
        raise InputError(
            "the acceleration of the carriage shows nothing in the band of the vibration",
            parameter="columns.acceleration",
        )
    mass = float(np.sum((one * two.conj()).real)) / size
    both = float(np.sum(np.abs(one) ** 2))
    coherence = abs(complex(np.sum(one * two.conj()))) ** 2 / (size * both) if both > 0.0 else 0.0
    # neighbouring bins of the taper share their noise: about one and a half bins an independent one
    freedom = max(1.0, 2.0 * one.size / 1.5 - 1.0)
    error = math.sqrt(float(np.sum(np.abs(one - mass * two) ** 2)) / size / freedom)
    return ShakenMass(mass, error, coherence)
