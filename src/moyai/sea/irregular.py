"""Irregular seas: seeded synthesis of wave components from a spectrum, long-crested or directional.

The same seed gives the same sea, bit for bit: uniform numbers are taken from the raw stream of PCG64, one stream each
for phases, amplitudes, headings and frequencies, so that a short-crested sea has the phases of the long-crested one.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import check_kind, checks_words
from moyai.sea import dispersion
from moyai.sea.components import WaveComponents
from moyai.sea.directional import Spreading, wrapped
from moyai.sea.spectrum import Spectrum
from moyai.sea.states import IrregularSea
from moyai.sea.synthesis import choose_band, equal_energy_bins, fourier_bins, uniform_numbers
from moyai.sea.water import Water, check_water

__all__ = ["WaveComponents", "components_of_run", "realisation_seed", "synthesise"]


def realisation_seed(seed: int, number: int) -> int:
    """Return the seed of a realisation: the case's own first, then seeds that no neighbouring seed leads to."""
    if number == 0:
        return seed
    return int(np.random.SeedSequence([seed, number]).generate_state(1, np.uint32)[0])


@checks_words
def synthesise(
    spectrum: Spectrum,
    water: Water,
    *,
    duration: float,
    seed: int,
    method: Literal["fft", "equal_energy"] = "fft",
    count: int | None = None,
    heading: float = 0.0,
    spreading: Spreading | None = None,
    time_step: float | None = None,
    summation: Literal["single", "double"] = "single",
    heading_count: int = 31,
    amplitudes: Literal["deterministic", "rayleigh"] = "deterministic",
    lower_omega: float | None = None,
    upper_omega: float | None = None,
    current: tuple[float, float] = (0.0, 0.0),
) -> WaveComponents:
    """Make one realisation of a sea from its spectrum.

    Parameters
    ----------
    spectrum : Spectrum
        Frequency spectrum in the fixed frame.
    water : Water
        Depth, density, gravity.
    duration : float
        Length of the sea [s]: an ``"fft"`` sea repeats itself after this time or slightly later, an
        ``"equal_energy"`` sea never does.
    seed : int
        Seed, not negative; the same seed gives the same sea.
    method : {"fft", "equal_energy"}
        ``"fft"``: frequencies at whole multiples of 2 pi / duration, each with the energy of its bin.
        ``"equal_energy"``: ``count`` components of equal energy, each at a random frequency within its share of the
        energy (so every spectral moment is right on average), the spacing being irrational [eq:sea-equal-energy].
    count : int, optional
        Number of frequencies of ``"equal_energy"`` (500 when not given).
    heading : float
        Mean direction of travel [rad].
    spreading : Spreading, optional
        Directional spreading; none makes a long-crested sea.
    time_step : float, optional
        Step of the time grid on which an ``"fft"`` sea will be wanted [s]: the repeat period becomes a whole and
        quickly transformed number of steps.
    summation : {"single", "double"}
        ``"single"``: one heading for each frequency, so that the sea is ergodic (Jefferys 1987). ``"double"``:
        ``heading_count`` headings for each frequency, phase-locked and so not ergodic.
    heading_count : int
        Headings of the double summation.
    amplitudes : {"deterministic", "rayleigh"}
        Whether amplitudes are those of the spectrum or Rayleigh-distributed about them (a Gaussian sea also in the
        variance of a short record).
    lower_omega, upper_omega : float, optional
        Band [rad/s]. By default a formula is cut where 0.1 % of its energy lies outside, a table is used whole.
        Amplitudes are raised so that the variance of the whole spectrum is kept.
    current : tuple of float
        Depth-uniform current (x, y) [m/s] on which the waves ride; gives the Doppler shift.

    Returns
    -------
    WaveComponents
        Variance equal to m_0 to rounding for deterministic amplitudes.

    Raises
    ------
    InputError
        When an argument is out of range, the duration is too short for one component, the time step too long for the
        band, or the current blocks components.

    Examples
    --------
    >>> from moyai.sea import Water, spectra, synthesise
    >>> water = Water(depth=10.0, density=1025.0, gravity=9.81)
    >>> spectrum = spectra.jonswap(significant_height=2.0, peak_period=7.0, peak_enhancement=3.3)
    >>> sea = synthesise(spectrum, water, duration=600.0, seed=1)
    >>> sea.elevation([0.0, 1.0, 2.0], 0.0, 0.0).shape               # [m] at three instants at the origin
    (3,)
    """
    check_water(water)
    if spreading is not None:
        check_kind(spreading, Spreading, "spreading", "give one of moyai.sea.directional")
    _check_request(duration, seed, method, count, summation, heading_count, amplitudes)
    low, high = choose_band(spectrum, lower_omega, upper_omega)
    step: float | None
    if method == "fft":
        omega, energy, step = fourier_bins(spectrum, low, high, duration, time_step)
    else:
        omega, energy = equal_energy_bins(spectrum, low, high, count or 500, seed)
        step = None
    energy = energy * (spectrum.variance / energy.sum())
    offsets: Array = np.zeros_like(omega)
    if spreading is not None and summation == "double":
        shares = (np.arange(heading_count) + 0.5) / heading_count
        offsets = spreading.quantile(shares[None, :], omega[:, None]).reshape(-1)
        omega, energy = np.repeat(omega, heading_count), np.repeat(energy / heading_count, heading_count)
    elif spreading is not None:
        # fractions that step by the golden ratio: any run of neighbouring frequencies covers the headings evenly
        start = uniform_numbers(seed, "heading", 1)[0]
        fractions = np.remainder(start + np.arange(omega.size) * (0.5 * (math.sqrt(5.0) - 1.0)), 1.0)
        offsets = spreading.quantile(fractions, omega)
    phase = 2.0 * math.pi * uniform_numbers(seed, "phase", omega.size)
    if amplitudes == "rayleigh":
        energy = energy * -np.log1p(-uniform_numbers(seed, "amplitude", omega.size))
    directions = wrapped(heading + offsets)
    along = current[0] * np.cos(directions) + current[1] * np.sin(directions)
    wave_number = dispersion.wave_number_in_current(omega, water.depth, water.gravity, along)
    return WaveComponents(
        omega=omega,
        amplitude=np.sqrt(2.0 * energy),
        phase=phase,
        heading=directions,
        wave_number=wave_number,
        water=water,
        intrinsic_omega=omega - wave_number * along,
        frequency_step=step,
    )


def components_of_run(sea: IrregularSea, water: Water, current: tuple[float, float], count: int) -> WaveComponents:
    """Return the components of an irregular sea that is run through its duration on a current.

    A sea of whole multiples of its lowest frequency has its significant height over its duration exactly; where that
    would take more than twice ``count``, so many of equal energy, whose height over the duration is a chance
    [eq:sea-equal-energy].

    Parameters
    ----------
    sea : IrregularSea
    water : Water
    current : (float, float)
        Averaged over the depth [m/s].
    count : int
        Components of equal energy.
    """
    parts = synthesise(
        sea.spectrum, water, duration=sea.duration, seed=sea.seed, heading=sea.heading, spreading=sea.spreading,
        current=current,
    )  # fmt: skip
    if parts.omega.size <= 2 * count:
        return parts
    return synthesise(
        sea.spectrum, water, duration=sea.duration, seed=sea.seed, heading=sea.heading, spreading=sea.spreading,
        method="equal_energy", count=count, current=current,
    )  # fmt: skip


def _check_request(
    duration: float, seed: int, method: str, count: int | None, summation: str, heading_count: int, amplitudes: str
) -> None:
    if not (math.isfinite(duration) and duration > 0.0):
        raise InputError(f"duration is {duration:g} s", parameter="duration", allowed="greater than 0 s")
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise InputError(f"seed is {seed!r}", parameter="seed", allowed="a whole number, at least 0")
    for name, value, allowed in (
        ("method", method, ("fft", "equal_energy")),
        ("summation", summation, ("single", "double")),
        ("amplitudes", amplitudes, ("deterministic", "rayleigh")),
    ):
        if value not in allowed:
            raise InputError(f"unknown {name} {value!r}", parameter=name, allowed=", ".join(allowed))
    if count is not None and method == "fft":
        raise InputError(
            "count has no meaning for the fft method", parameter="count", remedy="duration and band give the components"
        )
    if count is not None and count < 1:
        raise InputError(f"count is {count}", parameter="count", allowed="at least 1")
    if heading_count < 1:
        raise InputError(f"heading_count is {heading_count}", parameter="heading_count", allowed="at least 1")
