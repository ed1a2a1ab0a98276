"""Parts of the synthesis of a sea: random numbers, the band, the bins of frequency."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.remembered import Remembered, key_of_objects
from moyai.sea.spectrum import Spectrum

Stream = Literal["phase", "amplitude", "heading", "frequency"]

_STREAMS: dict[str, int] = {"phase": 1, "amplitude": 2, "heading": 3, "frequency": 4}
#: Fraction of the energy of a formula that the default band leaves outside.
ENERGY_LEFT_OUT = 1e-3

_BANDS: Remembered[Array] = Remembered(32)


@checks_words
def uniform_numbers(seed: int, stream: Stream, count: int) -> Array:
    """Return ``count`` uniform numbers in [0, 1) of a named stream.

    The 53 upper bits of PCG64's raw output are used, since NumPy guarantees the raw stream of a bit generator across
    versions but not what its distributions make of it.
    """
    generator = np.random.PCG64(np.random.SeedSequence([seed, _STREAMS[stream]]))
    raw = np.asarray(generator.random_raw(count), dtype=np.uint64)
    return (raw >> np.uint64(11)).astype(np.float64) * 2.0**-53


def choose_band(spectrum: Spectrum, lower: float | None, upper: float | None) -> tuple[float, float]:
    """Return the band of synthesis [rad/s]; see :func:`moyai.sea.irregular.synthesise`."""
    if spectrum.shapes:
        ends = np.array([0.1 * ENERGY_LEFT_OUT, 1.0 - 0.9 * ENERGY_LEFT_OUT])
        known = _BANDS.of(key_of_objects(spectrum), lambda: spectrum.quantile(ends))
        low = float(known[0]) if lower is None else float(lower)
        high = float(known[1]) if upper is None else float(upper)
    else:
        low = max(float(spectrum.omega[0]), spectrum.lower) if lower is None else float(lower)
        high = min(float(spectrum.omega[-1]), spectrum.upper) if upper is None else float(upper)
    if not (0.0 <= low < high and math.isfinite(high)):
        raise InputError(
            f"band {low:g} to {high:g} rad/s", parameter="upper_omega", allowed="0 <= lower_omega < upper_omega"
        )
    if not spectrum.moment(0, low, high) > 0.0:
        raise InputError(
            f"the spectrum has no energy between {low:g} and {high:g} rad/s",
            parameter="upper_omega",
            remedy="widen the band",
        )
    return low, high


def fourier_bins(
    spectrum: Spectrum, low: float, high: float, duration: float, time_step: float | None
) -> tuple[Array, Array, float]:
    """Return frequencies, energies and step of a sea whose frequencies are multiples of 2 pi / duration."""
    from scipy.fft import next_fast_len

    if time_step is None:
        step = 2.0 * math.pi / duration
    else:
        if not (math.isfinite(time_step) and 0.0 < time_step < duration):
            raise InputError(
                f"time_step is {time_step:g} s", parameter="time_step", allowed=f"between 0 and {duration:g} s"
            )
        nyquist = math.pi / time_step
        if high >= nyquist:
            lost = 1.0 - spectrum.moment(0, low, nyquist) / spectrum.moment(0, low, high) if nyquist > low else 1.0
            if lost > 0.01:
                raise InputError(
                    f"time_step of {time_step:g} s cannot resolve {100.0 * lost:.3g} % of the wave energy",
                    parameter="time_step",
                    allowed=f"shorter than {math.pi / high:.4g} s",
                )
            high = nyquist * (1.0 - 1e-9)
        # an even, quickly factored number of steps, at least as long as asked
        steps = 2 * next_fast_len(math.ceil(0.5 * duration / time_step * (1.0 - 1e-12)), real=True)
        step = 2.0 * math.pi / (steps * time_step)
    first, last = max(1, math.ceil(low / step - 0.5)), math.floor(high / step)
    if last < first:
        raise InputError(
            f"a duration of {duration:g} s holds no frequency of the band {low:g} to {high:g} rad/s",
            parameter="duration",
            allowed=f"several times {2.0 * math.pi / high:.4g} s",
        )
    number = np.arange(first, last + 1)
    edges = np.clip((np.arange(first, last + 2) - 0.5) * step, low, high)
    edges[0], edges[-1] = low, high
    energy = np.diff(spectrum.energy_below(edges))
    keep = energy > 0.0
    return np.asarray(number[keep] * step, dtype=np.float64), energy[keep], step


def equal_energy_bins(spectrum: Spectrum, low: float, high: float, count: int, seed: int) -> tuple[Array, Array]:
    """Return frequencies and energies of ``count`` components of equal energy [eq:sea-equal-energy]."""
    band = spectrum.truncated(low, high)
    fractions = (np.arange(count) + uniform_numbers(seed, "frequency", count)) / count
    omega = band.quantile(fractions)
    return omega, np.full(count, band.variance / count)
