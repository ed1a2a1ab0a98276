"""Sums of components over uniform time, and the slow forces that their products make."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from moyai.core.arrays import Array, ComplexArray
from moyai.core.compiled import njit
from moyai.sea.time_sum import sum_in_window, window_pays


def complex_sum(omega: Array, amplitude: ComplexArray, step: float, count: int) -> ComplexArray:
    """Return ``sum_i amplitude_i exp(-i omega_i t)`` at ``t = step * arange(count)``; shape (count, c).

    Parameters
    ----------
    omega : ndarray (k,)
        [rad/s].
    amplitude : ndarray (k, c)
    step : float
        [s].
    count : int

    Notes
    -----
    By one fast Fourier transform a column when all frequencies are whole multiples of 2 pi / (n step) for a whole n;
    else by a compiled sum whose phase factors are advanced by multiplication and renewed every 256 steps.
    """
    length = _transform_length(omega, step)
    if length == 0:
        return np.asarray(_direct_sum(omega, np.ascontiguousarray(amplitude), step, count))
    bins = _bins(omega, step, length)
    if window_pays(bins, count, length):
        return sum_in_window(bins, amplitude.T, count, length).T
    from scipy.fft import fft

    out = np.empty((count, amplitude.shape[1]), dtype=np.complex128)
    for number, column in enumerate(amplitude.T):
        out[:, number] = np.resize(fft(_in_bins(bins, column, length), overwrite_x=True), count)
    return out


def real_sum(
    omega: Array, amplitude: ComplexArray, step: float, count: int,
    products: tuple[ComplexArray, ComplexArray] | None = None,
) -> Array:  # fmt: skip
    """Return the real part of :func:`complex_sum`, and of products of two sums; shape (count, c).

    Parameters
    ----------
    omega, amplitude, step, count
        As there.
    products : tuple of ndarray (k, c), (k, 1 or c), optional
        Amplitudes p and q: the real part of the sum of p times the conjugate of the sum of q is added, which holds the
        differences of the frequencies [eq:floating-newman].

    Notes
    -----
    The spectrum of a product is as narrow as the band of the frequencies: it is found on a coarse grid that holds it
    exactly, and goes through the transform of the sum that it is added to.
    """
    length = _transform_length(omega, step)
    bins = _bins(omega, step, length) if length else np.zeros(0, dtype=np.int64)
    if length == 0 or window_pays(bins, count, length) or 2 * int(bins.max()) >= length:
        return _by_complex_sums(omega, amplitude, step, count, products)
    from scipy.fft import irfft

    slow = np.zeros((0, amplitude.shape[1]), dtype=np.complex128)
    if products is not None:
        slow = _difference_spectrum(bins - int(bins.min()), *products)
    out = np.empty((count, amplitude.shape[1]))
    for number, column in enumerate(amplitude.T):
        half = _in_bins(bins, 0.5 * column.conj(), length // 2 + 1)
        half[: len(slow)] += slow[:, number]
        out[:, number] = np.resize(irfft(half, n=length, norm="forward", overwrite_x=True), count)
    return out


def _by_complex_sums(
    omega: Array, amplitude: ComplexArray, step: float, count: int, products: tuple[ComplexArray, ComplexArray] | None
) -> Array:
    if products is None:
        return np.ascontiguousarray(complex_sum(omega, amplitude, step, count).real)
    together = complex_sum(omega, np.concatenate([amplitude, *products], axis=1), step, count)
    columns = amplitude.shape[1]
    out, first, second = together[:, :columns], together[:, columns : 2 * columns], together[:, 2 * columns :]
    return np.ascontiguousarray(out.real + (first * second.conj()).real)


def _difference_spectrum(place: Any, first: ComplexArray, second: ComplexArray) -> ComplexArray:
    """Return what the products add to the half spectrum, from differences of no bin on; shape (width, c)."""
    from scipy.fft import fft, next_fast_len, rfft

    width = int(place.max()) + 1
    size = next_fast_len(2 * width - 1)
    one, two = (
        np.stack([fft(_in_bins(place, column, size), overwrite_x=True) for column in part.T])
        for part in (first, second)
    )
    found: ComplexArray = rfft((one * two.conj()).real, axis=1)[:, :width].T / size
    return found


def _in_bins(bins: Any, values: ComplexArray, length: int) -> ComplexArray:
    spectrum = np.zeros(length, dtype=np.complex128)
    np.add.at(spectrum, bins, values)
    return spectrum


def _bins(omega: Array, step: float, length: int) -> Any:
    return np.rint(omega * step * length / (2.0 * math.pi)).astype(np.int64)


def _transform_length(omega: Array, step: float) -> int:
    """Return the transform length that holds all frequencies exactly, 0 when there is none of use."""
    unique = np.unique(omega)
    base = float(unique[0]) if len(unique) == 1 else float(np.min(np.diff(unique)))
    multiples = np.rint(omega / base)
    if np.max(multiples) > 5e7 or np.max(np.abs(omega / base - multiples)) > 1e-6:
        return 0
    base = float(np.sum(omega) / np.sum(multiples))
    length = round(2.0 * math.pi / (base * step))
    if length < 2 or length > 50_000_000 or np.max(multiples) >= length:
        return 0
    phase_error = np.max(np.abs(omega * step * length / (2.0 * math.pi) - multiples))
    return length if phase_error < 1e-6 else 0


@njit(cache=True, error_model="numpy")
def _direct_sum(omega: Array, amplitude: ComplexArray, step: float, count: int) -> ComplexArray:
    components, columns = amplitude.shape
    result = np.zeros((count, columns), dtype=np.complex128)
    factor = np.exp(-1j * omega * step)
    turning = np.empty(components, dtype=np.complex128)
    for start in range(0, count, 256):
        for i in range(components):
            turning[i] = np.exp(-1j * omega[i] * step * start)
        for n in range(start, min(start + 256, count)):
            for i in range(components):
                phase = turning[i]
                for c in range(columns):
                    result[n, c] += amplitude[i, c] * phase
                turning[i] = phase * factor[i]
    return result
