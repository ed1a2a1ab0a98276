"""Incident, reflected and transmitted waves of irregular tests: spectra, coefficients with errors, time series."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import InputError
from moyai.core.validity import Notice
from moyai.records.survey.reflection import LARGEST_CONDITION
from moyai.sea.dispersion import wave_number
from moyai.sea.water import Water
from moyai.series.spectra import WelchOptions, degrees_of_freedom, taper


@dataclass(frozen=True, eq=False)
class IrregularSeparation:
    """What the gauges on one side of a structure say about a sea; equation [eq:records-separation]."""

    #: [Hz].
    frequency: Array
    #: Spectrum of waves towards +x [m2/Hz]; NaN where the gauges are badly placed.
    incident: Array
    #: Spectrum of waves towards -x [m2/Hz]; NaN where the gauges are badly placed.
    reflected: Array
    #: Density of what two waves leave unexplained, per gauge [m2/Hz]; NaN with two gauges.
    noise: Array
    #: Condition number at each frequency.
    condition: Array
    #: Frequencies that enter the coefficients.
    used: NDArray[np.bool_]
    #: Root of the energy ratio over the band [-].
    reflection: float
    #: Its standard error over the segments [-].
    reflection_error: float
    #: Incident 4 sqrt(m0) over the band [m].
    incident_height: float
    #: Reflected 4 sqrt(m0) over the band [m].
    reflected_height: float
    degrees_of_freedom: float
    segments: int
    notices: tuple[Notice, ...]


def _design(k: Array, x: Array) -> tuple[ComplexArray, Array, Array]:
    """Return the inverse maps (frequencies, 2, gauges) to x = 0, condition numbers, and noise gains of an amplitude."""
    origin = x.mean()
    phase = np.exp(1j * k[:, None] * (x - origin))
    coupling = np.sum(phase**2, axis=1)
    count = x.size
    determinant = count**2 - np.abs(coupling) ** 2
    # Inverse of the normal matrix [[n, conj(s)], [s, n]] of unknowns (incident, reflected)
    with np.errstate(invalid="ignore", divide="ignore"):
        incident = (count * phase.conj() - coupling.conj()[:, None] * phase) / determinant[:, None]
        reflected = (count * phase - coupling[:, None] * phase.conj()) / determinant[:, None]
        condition = np.sqrt((count + np.abs(coupling)) / np.maximum(count - np.abs(coupling), 0.0))
        gain = count / determinant
    shift = np.exp(-1j * k * origin)[:, None]
    return np.stack([incident * shift, reflected / shift], axis=1), condition, gain


def separate_irregular(
    step: float,
    gauges: ArrayLike,
    positions: ArrayLike,
    water: Water,
    options: WelchOptions,
    *,
    lowest: float,
    highest: float,
    largest_condition: float = LARGEST_CONDITION,
    subtract_noise: bool = True,
    seed: int = 1,
) -> IrregularSeparation:
    """Separate the incident and reflected waves of an irregular sea by least squares at every frequency.

    With two gauges this is Goda and Suzuki's method, with three and more Mansard and Funke's with equal weights.

    Parameters
    ----------
    step : float
        Time step [s].
    gauges : array_like, shape (samples, gauges)
        Elevations [m], without gaps.
    positions : array_like, shape (gauges,)
        Along the direction of the incident waves [m].
    water : Water
    options : WelchOptions
    lowest, highest : float
        Band of the coefficients [Hz].
    largest_condition : float
        Frequencies with a larger condition number are left out.
    subtract_noise : bool
        Take the energy that noise lends to both waves off (three gauges and more).
    seed : int
        Of the resampling of segments behind the standard error.

    Returns
    -------
    IrregularSeparation

    Raises
    ------
    InputError
        Fewer than two gauges, gaps, or no frequency left.
    """
    x = np.asarray(positions, dtype=float)
    values = np.asarray(gauges, dtype=float)
    if x.ndim != 1 or np.unique(x).size < 2:
        raise InputError(f"{np.unique(x).size} gauge positions", parameter="positions", allowed="two or more different")
    if values.ndim != 2 or values.shape[1] != x.size:
        raise InputError(f"records of shape {values.shape} for {x.size} gauges", parameter="gauges")
    if not np.isfinite(values).all():
        row, column = np.argwhere(~np.isfinite(values))[0]
        raise InputError(
            f"gauge {column + 1} lacks sample {row + 1}", parameter="gauges", remedy="choose a sound stretch"
        )
    transforms, window, shift = _segments(step, values, options)
    size = window.size
    frequency = np.asarray(np.fft.rfftfreq(size, step), dtype=np.float64)
    inside = (frequency >= lowest) & (frequency <= highest) & (frequency > 0.0)
    if not inside.any():
        raise InputError(f"no frequency between {lowest:g} and {highest:g} Hz", parameter="lowest, highest")
    frequency = frequency[inside]
    k = np.asarray(wave_number(2.0 * math.pi * frequency, water.depth, water.gravity), dtype=float)
    inverse, condition, gain = _design(k, x)
    used = condition <= largest_condition
    if not used.any():
        raise InputError(
            f"at no frequency the gauges are well placed: the smallest condition number is {condition.min():.3g}",
            parameter="positions",
            allowed=f"at most {largest_condition:g}",
        )
    amplitudes = transforms[:, inside]
    waves = np.einsum("fwg,sfg->swf", np.where(used[:, None, None], inverse, 0.0), amplitudes)
    phase = np.exp(1j * k[:, None] * x)
    fitted = waves[:, 0, :, None] * phase + waves[:, 1, :, None] * phase.conj()
    scale = 2.0 * step / float(np.sum(window**2))
    power = np.abs(waves) ** 2 * scale
    noise = np.full((transforms.shape[0], frequency.size), np.nan)
    if x.size > 2:
        noise = np.sum(np.abs(amplitudes - fitted) ** 2, axis=2) * scale / (x.size - 2)
        if subtract_noise:
            power = power - (noise * gain)[:, None, :]
    df = float(frequency[1] - frequency[0]) if frequency.size > 1 else 1.0 / (size * step)
    energy = np.sum(power[:, :, used], axis=2) * df
    ratio = _ratio(energy.mean(axis=0))
    mean = power.mean(axis=0)
    mean[:, ~used] = np.nan
    notices = _condition_notices(frequency, condition, used, largest_condition)
    notices = (*notices, *_delay_notices(frequency[used], k[used], x, size * step))
    if energy[:, 0].mean() <= 0.0:
        message = "the incident energy is not above the noise of the gauges: there is no reflection coefficient"
        notices = (*notices, Notice("reflection-noise", message))
    elif energy[:, 1].mean() < 0.0:
        message = "the reflected energy is not above the noise of the gauges: reflection is shown as 0"
        notices = (*notices, Notice("reflection-noise", message, ratio, 0.0))
    return IrregularSeparation(
        frequency,
        mean[0],
        mean[1],
        np.where(used, noise.mean(axis=0), np.nan),
        condition,
        used,
        ratio,
        _segment_error(energy, size, shift, seed),
        4.0 * math.sqrt(max(float(energy[:, 0].mean()), 0.0)),
        4.0 * math.sqrt(max(float(energy[:, 1].mean()), 0.0)),
        degrees_of_freedom(window, shift, transforms.shape[0]),
        transforms.shape[0],
        notices,
    )


def _segments(step: float, values: Array, options: WelchOptions) -> tuple[ComplexArray, Array, int]:
    """Return the tapered transforms (segments, frequencies, gauges) as amplitudes of Re(X exp(-i omega t))."""
    size = values.shape[0] if math.isinf(options.segment) else round(options.segment / step)
    if not 8 <= size <= values.shape[0]:
        raise InputError(f"segments of {size} samples in a record of {values.shape[0]}", parameter="segment")
    shift = max(round(size * (1.0 - options.overlap)), 1)
    window = taper(options.window, size)
    ramp = np.arange(size) - 0.5 * (size - 1)
    out = []
    for start in range(0, values.shape[0] - size + 1, shift):
        part = values[start : start + size]
        part = part - part.mean(axis=0)
        part = part - ramp[:, None] * (ramp @ part / (ramp @ ramp))
        out.append(np.conj(np.fft.rfft(part * window[:, None], axis=0)))
    return np.asarray(out), window, shift


def _ratio(energy: Array) -> float:
    return math.sqrt(max(float(energy[1]), 0.0) / float(energy[0])) if energy[0] > 0.0 else math.nan


def _segment_error(energy: Array, size: int, shift: int, seed: int) -> float:
    """Return the standard error of the root of the energy ratio by resampling segments (NaN for fewer than four)."""
    count = energy.shape[0]
    if count < 4:
        return math.nan
    random = np.random.default_rng(seed)
    # Overlapping segments are not independent: whole runs of them are drawn
    run = max(math.ceil(size / shift), 1)
    starts = random.integers(0, count - run + 1, (400, math.ceil(count / run)))
    picks = (starts[:, :, None] + np.arange(run)).reshape(400, -1)[:, :count]
    drawn = np.array([energy[pick].mean(axis=0) for pick in picks])
    error = float(np.std([_ratio(draw) for draw in drawn]))
    # A reflection cut off at zero scatters too little: it may be as large as the scatter of its energy allows
    incident, reflected = energy.mean(axis=0)
    doubt = float(np.std(drawn[:, 1])) / float(incident) if incident > 0.0 else math.nan
    return max(error, math.sqrt(doubt)) if reflected < float(np.std(drawn[:, 1])) else error


LARGEST_DELAY = 0.05
"""Share of a segment that energy may take from the first to the last gauge."""


def _delay_notices(frequency: Array, k: Array, x: Array, length: float) -> tuple[Notice, ...]:
    """Return a notice where the energy takes so long past the gauges that they see different stretches of the sea."""
    if frequency.size < 2:
        return ()
    slowest = float(np.max(np.gradient(k, 2.0 * math.pi * frequency)))  # inverse of the group velocity
    delay = slowest * float(np.ptp(x))
    if delay <= LARGEST_DELAY * length:
        return ()
    message = (
        f"energy takes up to {delay:.3g} s past the gauges, {100.0 * delay / length:.2g} % of a segment: the "
        "waves they share are blurred, and small reflections come out too high"
    )
    return (Notice("gauge-delay", message, delay / length, LARGEST_DELAY, remedy="take longer segments"),)


def _condition_notices(frequency: Array, condition: Array, used: NDArray[np.bool_], limit: float) -> tuple[Notice, ...]:
    if used.all():
        return ()
    lost = frequency[~used]
    worst = float(np.max(np.where(np.isfinite(condition), condition, 0.0)))
    span = f"from {lost.min():.3g} to {lost.max():.3g} Hz" if lost.size > 1 else f"at {lost[0]:.3g} Hz"
    message = (
        f"{lost.size} of {frequency.size} frequencies {span} are left out: "
        "the spacing of the gauges is near a multiple of half a wavelength apart"
    )
    return (Notice("gauge-spacing", message, worst, limit, remedy="use other gauges or a narrower band"),)


def wave_series(
    step: float,
    gauges: ArrayLike,
    positions: ArrayLike,
    water: Water,
    *,
    lowest: float,
    highest: float,
    at: float = 0.0,
    largest_condition: float = LARGEST_CONDITION,
) -> tuple[Array, Array]:
    """Return the incident and the reflected wave at ``x = at`` over time [m], without other frequencies.

    One transform over the whole record: the first and last few periods hold the wrap-around of waves that had not
    reached, or had left, the other gauges.
    """
    x = np.asarray(positions, dtype=float)
    values = np.asarray(gauges, dtype=float)
    values = values - values.mean(axis=0)
    frequency = np.fft.rfftfreq(values.shape[0], step)
    inside = (frequency >= lowest) & (frequency <= highest) & (frequency > 0.0)
    k = np.asarray(wave_number(2.0 * math.pi * frequency[inside], water.depth, water.gravity), dtype=float)
    inverse, condition, _ = _design(k, x)
    inverse = np.where((condition <= largest_condition)[:, None, None], inverse, 0.0)
    amplitudes = np.conj(np.fft.rfft(values, axis=0))[inside]
    waves = np.einsum("fwg,fg->wf", inverse, amplitudes)
    shift = np.exp(1j * k * at)
    out = []
    for wave in (waves[0] * shift, waves[1] / shift):
        spectrum = np.zeros(frequency.size, dtype=complex)
        spectrum[inside] = np.conj(wave)
        out.append(np.asarray(np.fft.irfft(spectrum, values.shape[0])))
    return out[0], out[1]


@dataclass(frozen=True, eq=False)
class Transmission:
    """Transmission past a structure: root of the energy ratio, with its standard error."""

    coefficient: float
    error: float
    #: 4 sqrt(m0) of the transmitted waves [m].
    height: float
    #: Root of the ratio of the densities at each frequency [Hz].
    frequency: Array
    #: Root of the ratio of the densities at each frequency [-].
    ratio: Array
    #: Reflection from behind, NaN with one gauge there.
    beach_reflection: float


def transmission(
    step: float,
    front: IrregularSeparation,
    rear: ArrayLike,
    positions: Sequence[float],
    water: Water,
    options: WelchOptions,
    *,
    lowest: float,
    highest: float,
) -> Transmission:
    """Return the transmission from the separated waves in front and one or more gauges behind.

    With one gauge the beach is taken to reflect nothing; with two or more its reflection is taken off.

    Raises
    ------
    InputError
        The energy in front or behind is not above the noise of the gauges, as in a calm.
    """
    values = np.asarray(rear, dtype=float)
    values = values[:, None] if values.ndim == 1 else values
    if len(positions) == 1:
        from moyai.series.spectra import spectrum_of

        found = spectrum_of(step, values[:, 0], options)
        density = np.interp(front.frequency, found.frequency, found.density)
        beach, freedom = math.nan, found.degrees_of_freedom
        ok = front.used
    else:
        behind = separate_irregular(step, values, positions, water, options, lowest=lowest, highest=highest)
        density = np.interp(front.frequency, behind.frequency, behind.incident)
        beach, freedom = behind.reflection, behind.degrees_of_freedom
        ok = front.used & np.isfinite(density)
    df = float(front.frequency[1] - front.frequency[0])
    passed, came = float(np.sum(density[ok])) * df, float(np.sum(front.incident[ok])) * df
    for energy, place in ((came, "in front"), (passed, "behind")):
        if not energy > 0.0:  # noise that is taken off may exceed a calm sea
            raise InputError(
                f"the energy of the waves {place} is not above the noise of the gauges", parameter="gauges",
                remedy="leave calm blocks out, or widen the band",
            )  # fmt: skip
    coefficient = math.sqrt(passed / came)
    # Relative error of an energy from its effective number of degrees of freedom, in front and behind
    wide = [float(np.sum(s[ok]) ** 2 / np.sum(s[ok] ** 2)) for s in (density, front.incident)]
    relative = math.sqrt(2.0 / (freedom * wide[0]) + 2.0 / (front.degrees_of_freedom * wide[1]))
    with np.errstate(invalid="ignore", divide="ignore"):
        ratio = np.sqrt(density / front.incident)
    return Transmission(
        coefficient, 0.5 * coefficient * relative, 4.0 * math.sqrt(passed), front.frequency, ratio, beach
    )
