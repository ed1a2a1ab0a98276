"""The water surface of an animation: the recorded incident wave, carried to every place by linear theory."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array

SAMPLES_PER_SHORTEST_PERIOD = 8
ENERGY_KEPT = 0.995  # the shortest ripples are below a pixel
MOST_NUMBERS = 1 << 18  # of the surface at several places that are held at a time


def travelling_surface(
    time: ArrayLike,
    elevation: ArrayLike,
    x: ArrayLike,
    moments: ArrayLike,
    *,
    omega: ArrayLike,
    wave_number: ArrayLike,
    reflection: ArrayLike | None = None,
    transmission: ArrayLike | None = None,
) -> Array:
    """Return the surface at places ``x`` and times ``moments`` from the incident wave recorded at x = 0.

    Up-wave of x = 0 stand the incident and the reflected wave, behind it the transmitted one: the far field of linear
    theory without the local disturbance at the body.

    Parameters
    ----------
    time, elevation : array_like, shape (samples,)
        Incident wave at x = 0 [s, m].
    x : array_like
        Places [m].
    moments : array_like
        Times within the record [s].
    omega, wave_number : array_like
        Wave number [1/m] over angular frequency [rad/s]; beyond the ends k grows with omega below and with its square
        above.
    reflection, transmission : array_like, optional
        Complex coefficients over ``omega`` with the phase at x = 0; real ones give moduli (no reflected wave is drawn
        then, since its phase is not known). Absent: the incident wave everywhere.

    Returns
    -------
    ndarray, shape (moments, x)
        Elevation [m].
    """
    times, record = np.asarray(time, dtype=float), np.asarray(elevation, dtype=float)
    places, wanted = np.asarray(x, dtype=float), np.asarray(moments, dtype=float)
    step = float(np.median(np.diff(times)))
    uniform = np.arange(times[0], times[-1] + 0.5 * step, step)
    samples = np.interp(uniform, times, np.nan_to_num(record))
    mean = samples.mean()
    joint = 0.5 - 0.5 * np.cos(np.linspace(0.0, np.pi, max(samples.size // 20, 2)))
    closed = np.concatenate([samples, samples[-1] + (samples[0] - samples[-1]) * joint]) - mean
    spectrum = np.fft.rfft(closed)
    frequency = 2.0 * np.pi * np.fft.rfftfreq(closed.size, step)
    energy = np.cumsum(np.abs(spectrum) ** 2)
    if not energy[-1] > 0.0:
        return np.full((wanted.size, places.size), mean)
    count = min(int(np.searchsorted(energy, ENERGY_KEPT * energy[-1])) + 2, spectrum.size)
    spectrum, frequency = spectrum[:count], frequency[:count]
    k, reflected, transmitted = _coefficients(frequency, omega, wave_number, reflection, transmission)
    length = 1 << math.ceil(math.log2(max(SAMPLES_PER_SHORTEST_PERIOD * count, 16)))  # powers of two transform fast
    place = (wanted - times[0]) * (length / (closed.size * step))
    before = np.floor(place).astype(np.int64)
    share = place - before
    first, second, scale = before % length, (before + 1) % length, length / closed.size
    out = np.empty((wanted.size, places.size))
    together = max(1, MOST_NUMBERS // max(length, wanted.size))
    for begin in range(0, places.size, together):
        at = places[begin : begin + together, None]
        # numpy's transform runs with exp(+i omega t); the convention of the package is its conjugate
        along = np.exp(-1j * at * k)
        there = np.where(at < 0.0, along + np.conj(reflected * along), np.conj(transmitted) * along)
        carried = np.fft.irfft(spectrum * there, n=length, axis=1)
        # the record repeats
        found = (1.0 - share) * carried[:, first] + share * carried[:, second]
        out[:, begin : begin + together] = scale * found.T + mean
    return out


def _coefficients(
    frequency: NDArray[Any],
    omega: ArrayLike,
    wave_number: ArrayLike,
    reflection: ArrayLike | None,
    transmission: ArrayLike | None,
) -> tuple[Array, NDArray[np.complex128], NDArray[np.complex128]]:
    """Interpolate wave number and coefficients to the frequencies of the record."""
    known = np.asarray(omega, dtype=float)
    order = np.argsort(known)
    known, numbers = known[order], np.asarray(wave_number, dtype=float)[order]
    good = (known > 0.0) & np.isfinite(known) & np.isfinite(numbers)
    low, high = known[good][0], known[good][-1]
    k = np.interp(frequency, known[good], numbers[good])
    k = np.where(frequency < low, numbers[good][0] * frequency / low, k)
    k = np.where(frequency > high, numbers[good][-1] * (frequency / high) ** 2, k)

    def along(values: ArrayLike | None, otherwise: float) -> NDArray[np.complex128]:
        if values is None:
            return np.full(frequency.size, otherwise, dtype=complex)
        entries = np.asarray(values)[order][good]
        entries = np.where(np.isfinite(entries), entries, otherwise)
        return np.asarray(
            np.interp(frequency, known[good], entries.real) + 1j * np.interp(frequency, known[good], entries.imag),
            dtype=complex,
        )

    reflected = along(reflection if reflection is not None and np.iscomplexobj(reflection) else None, 0.0)
    return k, reflected, along(transmission, 1.0)
